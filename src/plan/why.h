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
// 3. Its narrowest place: from the way's cells of small field values, the obstacle nearest and the one across form a
//    gap if nothing comes nearer to its middle (layout_facing.h); its width is their exact distance. If none is made
//    out so, cells are moved across the path to where the exact gap is largest, and the width is twice that (5 mm at a
//    grid of 0.05 m).
// 4. Since the field tells widths to a cell or two only, gaps measured are barred and a way past them is searched among
//    those that may be wider. The widest of the ways' narrowest gaps is told: a wider way would have been among them
//    (a bar on it was the narrowest gap of a way, and no narrower than this one), up to AISLE_WHY_WAYS ways.
// Memory: none of its own. Time: about ten grid searches, then one a way measured; sliced.
#ifndef AISLE_PLAN_WHY_H
#define AISLE_PLAN_WHY_H

#include "plan/seed.h"

#define AISLE_WHY_WAYS 8U // measured at most

typedef enum aisle_why_stage {
    AISLE_WHY_ROUGH,  // does the optimistic grid connect at the margin, to a cell?
    AISLE_WHY_PROVE,  // and to 2^-AISLE_SPACE_DEPTH_MAX of a cell?
    AISLE_WHY_ANY,    // does anything connect?
    AISLE_WHY_BISECT, // how wide at most?
    AISLE_WHY_WIDEST, // a way as wide, past the gaps measured
    AISLE_WHY_MEASURE // the gaps on it
} aisle_why_stage;

typedef struct aisle_gap { // a narrow place
    double width;          // m
    aisle_vec2 place;      // its middle
    uint32_t sides;        // obstacles that form it: 2, or 1 if the other one was not made out; 0: none
    int32_t id[2];         // of them
    aisle_vec2 side[2];    // their points nearest to each other
} aisle_gap;

typedef struct aisle_why {
    aisle_seed *seed;
    aisle_space *space;
    aisle_vec2 start, goal;
    aisle_why_stage stage;
    double reach;                       // m, of the disc the footprint holds, margin included
    uint32_t stride;                    // cells between neighbours of the searches for width
    uint32_t lo, hi;                    // field values: lo connects, hi does not
    bool proved;                        // there is no way at this margin
    uint32_t depth;                     // halvings of a cell that the proof took
    bool connected;                     // for something narrower there is
    aisle_gap gap;                      // the narrowest one of the widest way, if connected
    aisle_gap way;                      // the same of the way being measured
    uint32_t at;                        // cell of it
    uint32_t narrow_to;                 // cells of a field value above it lie next to no narrowest gap
    aisle_vec2 bars[AISLE_WHY_WAYS][2]; // gaps measured, by their sides
    uint32_t bar_count;
} aisle_why;

// stride: cells, >= 1, for step 2.
void aisle_why_start(aisle_why *self, aisle_seed *seed, aisle_space *space, aisle_vec2 start, aisle_vec2 goal,
                     uint32_t stride);

// AISLE_BUSY; AISLE_PARTIAL: step 1 has just ended, `proved` stands (once; call again for the rest); AISLE_OK:
// answered;
// AISLE_ERR_CAPACITY: the open list is full.
aisle_status aisle_why_step(aisle_why *self, uint32_t units, uint32_t *spent);
#endif
