// tour.h - in which order to visit goals, by the true lengths of the ways between them. Level 4.
//
// The cost of a pair is the length of the exact shortest way (tangent.h) of a disc, in either direction the same. Not
// all pairs are searched: what is not known yet is taken for its lower bound,
//     max(|p_i - p_j|, |d(i, k) - d(k, j)| for all k whose ways to both are known),
// the best order by these costs (order.h) is found, the pairs it uses are searched, and again until it uses none but
// known ones. So an exact order by the costs as they stand is exact by the true ones: no order could cost less even by
// its lower bounds (the optimism of A*, over orders; lazy evaluation as in LazySP, Dellin & Srinivasa 2016).
// One goal that no way leads to, in whatever order, is proved by the search from the start: for a disc, what can be
// reached from one goal can be reached from all that can be reached from it.
// Tried against it: a field of costs from each goal over the grid. It is dearer (2.5 million cells of factory_big take
// 78 ms, its legs 1.3 ms in the median), has a cell's error and would not prove that there is no way.
//
// Memory: 33 KiB; the exact order's table (384 KiB) only between searches, where their memory lies. Time: searches; one
// unit for AISLE_TOUR_EVALS costs or moves weighed. Sliced.
#ifndef AISLE_PLAN_TOUR_H
#define AISLE_PLAN_TOUR_H

#include "algo/order.h"
#include "plan/tangent.h"

#define AISLE_TOUR_EVALS 64U  // costs or moves weighed, to a work unit
#define AISLE_TOUR_KICKS 800U // of a local search that nothing is known before, and of the last one
#define AISLE_TOUR_KICKS_BETWEEN 100U

typedef enum aisle_tour_phase {
    AISLE_TOUR_ORDER, // by the costs as they stand
    AISLE_TOUR_SEARCH // of a pair
} aisle_tour_phase;

typedef struct aisle_tour {
    aisle_tangent *tangent;
    const aisle_layout *layout;
    double radius; // m
    uint32_t count;
    aisle_vec2 place[AISLE_ORDER_MAX + 1U]; // [count] goals, the start behind them
    double *cost;                           // [(count + 1) * count] as order.h wants it, m
    double *table;                          // for the exact order; shares its place with the searches
    uint64_t known[AISLE_ORDER_MAX + 1U];   // bit j: the way to goal j was searched
    aisle_order search;                     // of the order
    aisle_tour_phase phase;
    uint8_t order[AISLE_ORDER_MAX]; // the best known; as given until there is one
    bool ordered;                   // one was found
    bool last;                      // the local search under way is a long one
    uint32_t at;                    // position in it whose way is looked at
    uint32_t from, to;              // pair under way; count: the start
    uint32_t unreachable;           // after AISLE_PARTIAL: no way leads to this goal
    uint32_t suspect;               // a pair without a way is two goals, one of which cannot be reached; count: none
    bool is_rough;                  // a search gave up: its pair counts with a lower bound
    uint32_t searches, rounds;      // since start
    uint32_t nodes;                 // expanded by the searches, since start
    uint32_t evals;                 // not yet paid for in units
} aisle_tour;

void aisle_tour_carve(aisle_tour *self, aisle_arena *arena);
// Of an arena over memory that the searches of `tangent` lie in.
void aisle_tour_carve_shared(aisle_tour *self, aisle_arena *shared);

// count in [1, AISLE_ORDER_MAX]; radius as aisle_tangent_start() wants it.
void aisle_tour_start(aisle_tour *self, aisle_tangent *tangent, const aisle_layout *layout, double radius,
                      aisle_vec2 start, const aisle_vec2 *goals, uint32_t count);

// AISLE_BUSY; AISLE_OK: `order` is the shortest (for more than AISLE_ORDER_EXACT_MAX goals: a good) one; AISLE_PARTIAL:
// proved, no way leads to goal `unreachable`. May be left at any time with `order` as it stands.
aisle_status aisle_tour_step(aisle_tour *self, uint32_t units, uint32_t *spent);
#endif
