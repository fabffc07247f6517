// taut.h - pulls a free polyline taut: shorter (or less costly), never less free. Level 4.
//
// Local moves on one point b between a and c, each tested by straight free sweeps and kept only if the cost falls:
//     remove b;  shift b, or the leg b-c as a whole, across the way (other densities than length);  slide b towards a (then b-c must be free);  slide b towards c;  cut the corner at b by two points.
// ALONG: points go only where the turning disc fits, since the body must turn there.
// Cost: the objective's density along the legs, less what a corner arc of radius `arc_radius` saves at each point (2 T
// - R phi with T the tangent length), so that points already on one arc are not split for nothing. For pure length the
// slides go as far as they may (halving down to 0.5 mm): a point that cannot move has both legs touching the same round
// obstacle, which is the local optimum there. For other densities slides by 1/2, 1/4, 1/8 of the leg. Ends when a whole
// pass gains less than AISLE_TAUT_GAIN of the length (2e-4 of another cost), or after AISLE_TAUT_PASSES; then, for other densities, shifts once
// more by exact gaps, since the field tells the middle of an aisle to half a cell only.
// Where the layout has DIRECTED zones, whose corners are sharp, two points that ended within 5 cm become one if that is free.
// Memory: the caller's points, and 5 KiB of costs of legs, each asked for several times. Time: a pass is O(points *
// sweeps); sliced by point.
#ifndef AISLE_PLAN_TAUT_H
#define AISLE_PLAN_TAUT_H

#include "plan/objective.h"
#include "plan/space.h"

#define AISLE_TAUT_PASSES 16U
#define AISLE_TAUT_GAIN 1e-5
#define AISLE_TAUT_KNOWN 128U // costs of legs kept, each in the place its ends' bits name

typedef struct aisle_taut_known {
    aisle_vec2 a, b;
    double cost; // from a to b
} aisle_taut_known;

typedef struct aisle_taut {
    const aisle_space *space;
    const aisle_objective *objective;
    aisle_vec2 *points; // [capacity], the first and last stay
    uint32_t count, capacity;
    uint32_t at, pass;
    bool exact;        // costs by exact gaps, the last passes' way
    double arc_radius; // m
    double cost;       // of the whole polyline when the pass began
    uint32_t units;    // since the last step
    aisle_taut_known known[AISLE_TAUT_KNOWN];
} aisle_taut;

// Begins on points[count], count >= 2, every leg free.
void aisle_taut_start(aisle_taut *self, const aisle_space *space, const aisle_objective *objective, double arc_radius,
                      aisle_vec2 *points, uint32_t count, uint32_t capacity);

// AISLE_BUSY, then AISLE_OK; count is then the number of points.
aisle_status aisle_taut_step(aisle_taut *self, uint32_t units, uint32_t *spent);
#endif
