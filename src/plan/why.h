// why.h - why the grid found no way: the narrowest gap on the widest way, or no way at all. Level 4.
//
// 1. Proof: does an optimistic grid (seed.h, PROOF) for the disc that the footprint holds plus the margin still
// connect? If not, no way
//    exists at any heading. Roughly first, since most gaps are far too narrow or far too wide. If it does, nothing is
// proved: the way may pass below the grid's resolution, or need
//    manoeuvres.
// 2. The widest way: bisection over the field's values for the largest one whose cells still connect, to half a cell,
//    on every k-th cell first, on all if those do not connect at all; 1 fails too: walled in.
//    The way itself then keeps off that least clearance wherever there is room.
// 3. Its narrowest place: the path's cells of least field value, each moved across the path to where the exact gap is
//    largest. The obstacle nearest there and the one across the place form the gap, and its width is their exact
//    distance (layout_facing.h) if nothing else comes nearer to its middle; else, and only then, the width is twice the
//    gap measured (5 mm at a grid of 0.05 m).
// Memory: none of its own. Time: about ten grid searches, sliced.
#ifndef AISLE_PLAN_WHY_H
#define AISLE_PLAN_WHY_H

#include "plan/seed.h"

typedef enum aisle_why_stage {
    AISLE_WHY_ROUGH,  // does the optimistic grid connect at the margin, to a cell?
    AISLE_WHY_PROVE,  // and to 2^-AISLE_SPACE_DEPTH_MAX of a cell?
    AISLE_WHY_ANY,    // does anything connect?
    AISLE_WHY_BISECT, // how wide at most?
    AISLE_WHY_WIDEST  // the widest way itself
} aisle_why_stage;

typedef struct aisle_why {
    aisle_seed *seed;
    aisle_space *space;
    aisle_vec2 start, goal;
    aisle_why_stage stage;
    double reach;    // m, of the disc the footprint holds, margin included
    uint32_t stride; // cells between neighbours of the searches for width
    uint32_t lo, hi; // field values: lo connects, hi does not
    bool proved;     // there is no way at this margin
    uint32_t depth;  // halvings of a cell that the proof took
    bool connected;  // for something narrower there is
    double width;    // m, of the narrowest place of the widest way, if connected
    aisle_vec2 place;
    uint32_t sides;     // obstacles that form the gap: 2, or 1 if the other one was not made out
    int32_t id[2];      // of them
    aisle_vec2 side[2]; // their points nearest to the gap's middle
} aisle_why;

// stride: cells, >= 1, for step 2.
void aisle_why_start(aisle_why *self, aisle_seed *seed, aisle_space *space, aisle_vec2 start, aisle_vec2 goal,
                     uint32_t stride);

// AISLE_BUSY; AISLE_PARTIAL: step 1 has just ended, `proved` stands (once; call again for the rest); AISLE_OK:
// answered;
// AISLE_ERR_CAPACITY: the open list is full.
aisle_status aisle_why_step(aisle_why *self, uint32_t units, uint32_t *spent);
#endif
