// nearest.h - how far an occupied stop has to move: the nearest place where the body keeps its margin. Level 4.
//
// The body stands at the stop with its heading fixed, or, where any heading will do, as the disc about the origin
// that it holds. Told is the place nearest to the stop where its gap is at least margin + AISLE_SPACE_SLACK +
// AISLE_NEAREST_SPARE: the spare lets place and distance be rounded to the millimetre and the body still stands free.
// Method: the gap changes by no more than the body moves, so a square with gap g in its middle and half diagonal h
// holds no such place if g + h is too little, and none but such places if g - h is enough. Rings of grid cells about
// the stop, most of them judged by the distance field alone; the rest are halved, nearest quarter first, down to
// AISLE_NEAREST_GRAIN (branch and bound). Ours.
// Result: the place is exact (free, judged by the exact gap); its distance is at most two grains above the least one,
// room of less than a grain left out. None: nothing within AISLE_NEAREST_FAR, or AISLE_NEAREST_UNITS were spent.
// Memory: the struct, 1 KiB. Time: one unit an exact gap and one for 16 cells; a few hundred typically. Deterministic,
// however the run is cut into steps.
#ifndef AISLE_PLAN_NEAREST_H
#define AISLE_PLAN_NEAREST_H

#include "plan/space.h"

#define AISLE_NEAREST_SPARE 1e-3    // m
#define AISLE_NEAREST_GRAIN 2.5e-4  // m
#define AISLE_NEAREST_FAR 5.0       // m
#define AISLE_NEAREST_UNITS 100000U // work units
#define AISLE_NEAREST_DEPTH 13U     // halvings of a cell of 1 m down to a grain, and one to spare

typedef struct aisle_nearest_square {
    aisle_vec2 centre;
    double half; // m, of its side
} aisle_nearest_square;

typedef struct aisle_nearest {
    const aisle_space *space;
    aisle_pose2 stop;
    bool any_heading;
    double need;          // m, gap of the body at a place that will do
    aisle_vec2 middle;    // from the stop to the middle of a disc the body holds
    double middle_radius; // m, of that disc
    int32_t ring, rings;  // cells about the stop's, under way and in all
    int32_t at;           // cell of the ring
    uint32_t open_count, units;
    bool found;
    aisle_vec2 place; // the nearest so far, if found
    double distance;  // m, to it
    aisle_nearest_square open[3U * AISLE_NEAREST_DEPTH + 1U];
} aisle_nearest;

// The stop lies within the bounds; space has begun.
void aisle_nearest_start(aisle_nearest *self, const aisle_space *space, aisle_pose2 stop, bool any_heading);

// Spends about `units`, at most 3 more, adds what it spent to *spent. AISLE_BUSY; AISLE_OK: place and distance stand;
// AISLE_PARTIAL: there is none, see above.
aisle_status aisle_nearest_step(aisle_nearest *self, uint32_t units, uint32_t *spent);
#endif
