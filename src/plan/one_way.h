// one_way.h - a proof that DIRECTED zones leave no way between two places. Level 4.
//
// Let t be the place along a zone's direction, m. A way that obeys the zone never loses t while it is inside, so all of its
// points there are at or beyond the least t at which it came in. The grid is flooded from the start, over cells that may
// hold the disc of `reach` (as in the proof of why.h); a cell that lies in a zone as a whole is shut while its greatest t
// is below the least t of the cells that are reached and have a part of the zone's border, where alone it can be come into
// (or of the start, if that lies inside). Since cells reached later may come in lower, the flood is repeated until no least
// t falls. Every way there is passes by cells that are open then: if the goal is not reached, there is none. Right angles
// are meant, without the verifier's tolerance. Zones shorter than about three cells shut nothing.
// Memory: the struct; the grid search's cells (seed.h). Time: floods * O(cells reached * zones); at most
// AISLE_ONE_WAY_FLOODS; sliced.
#ifndef AISLE_PLAN_ONE_WAY_H
#define AISLE_PLAN_ONE_WAY_H

#include "plan/seed.h"

#define AISLE_ONE_WAY_ZONES 64U // regarded, the first ones of the layout
#define AISLE_ONE_WAY_FLOODS 16U

typedef struct aisle_one_way_zone {
    uint32_t index;    // in the layout
    aisle_vec2 along;  // unit vector
    double least;      // m, t where it can be come into, by the floods so far
    double least_next; // and by the one under way
} aisle_one_way_zone;

typedef struct aisle_one_way {
    aisle_seed *seed;
    aisle_space *space;
    double reach;         // m
    uint32_t start, goal; // cells
    uint32_t count, floods;
    aisle_one_way_zone zone[AISLE_ONE_WAY_ZONES];
} aisle_one_way;

// Begins; uses the seed's search and the space's notes until the end. space is of the layout, start and goal within its
// grid. reach: m, of the disc.
void aisle_one_way_start(aisle_one_way *self, aisle_seed *seed, aisle_space *space, aisle_vec2 start, aisle_vec2 goal,
                         double reach);

// AISLE_BUSY; AISLE_OK: there is no way, proved; AISLE_PARTIAL: not proved.
aisle_status aisle_one_way_step(aisle_one_way *self, uint32_t units, uint32_t *spent);
#endif
