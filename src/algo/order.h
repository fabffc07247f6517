// order.h - the cheapest order in which to visit some places, from a start and with no way back. Level 2: knows no
// robots, maps or units.
//
// Costs may differ by direction and may be INFINITY (no way). Up to AISLE_ORDER_EXACT_MAX places exactly, by dynamic
// programming over subsets (Held & Karp 1962, doi:10.1137/0110015; Bellman 1962, doi:10.1145/321105.321111):
//     D(S, j) = min over i in S \ j of D(S \ j, i) + cost(i, j),   D({j}, j) = cost(start, j),   least: min over j of D(all, j).
// More places by iterated local search (Lourenco, Martin & Stuetzle 2003, doi:10.1007/0-306-48056-5_11): cheapest
// insertion or the caller's guess, then for one place after the other the best of all moves that begin at it:
//     2-opt: the stretch from it to any other one is turned round;
//     Or-opt (Or 1976): up to AISLE_ORDER_SEGMENT places from it are put elsewhere, either way round;
//     3-opt without turning: two neighbouring stretches change places, if of the three new neighbours the one at its
//     place is nearer than the old one (Lin & Kernighan 1973, doi:10.1287/opre.21.2.498: some place has such a gain),
// until none gains; then two neighbouring stretches, cut at random, change places (a double bridge) and the places
// about the cuts are looked at again. What comes out dearer than the best by more than a share, 3 % at first and
// falling to none, is taken back (threshold accepting, Dueck & Scheuer 1990, doi:10.1016/0021-9991(90)90201-B). Sums of
// costs along the order, both ways, are kept, so that a move is weighed in O(1) for uneven costs, too. No way counts as
// dearer than any whole order, so an order with fewer of them always wins.
// Gap to the optimum: tests/algo/test_order.c and DESIGN.md.
//
// Memory: none allocated; the caller owns self, cost and work until the run ends. Time: exact 2^(n-1) n (n - 1) / 2
// sums (0.15 million for 12 places); else about n^3 / 6 for the insertion and 120 n a kick
// (4 ns each; 6.5 million for 64 places and 800 kicks). No recursion.
// Determinism: same cfg, same order, however the run is cut into steps. Ties: the move, place or predecessor of the
// lowest index.
#ifndef AISLE_ALGO_ORDER_H
#define AISLE_ALGO_ORDER_H

#include "aisle/status.h"
#include "base/rng.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define AISLE_ORDER_MAX 64U
#define AISLE_ORDER_EXACT_MAX 12U
#define AISLE_ORDER_SEGMENT 3U // places that Or-opt moves together

// Doubles of scratch for a run with n places.
#define AISLE_ORDER_WORK_LEN(n) ((n) <= AISLE_ORDER_EXACT_MAX ? ((size_t)1U << (n)) * (n) : (size_t)0)

typedef struct aisle_order_config {
    uint32_t n;         // places, [1, AISLE_ORDER_MAX]
    const double *cost; // [(n + 1) * n] cost[i * n + j] from place i to j, row n from the start; >= 0 or INFINITY, the
                        // finite ones below 1e12; [i * n + i] is not read
    const uint8_t *guess; // [n] a permutation to begin with; NULL: none. Not read for exact runs
    uint32_t kicks;       // for more than AISLE_ORDER_EXACT_MAX places
    uint64_t seed;        // any value
} aisle_order_config;

typedef enum aisle_order_phase {
    AISLE_ORDER_IDLE,
    AISLE_ORDER_TABLE,   // exact
    AISLE_ORDER_INSERT,  // a first order
    AISLE_ORDER_DESCEND, // to a local optimum
    AISLE_ORDER_ENDED
} aisle_order_phase;

// Public so that it can be a static variable. Read order, value and the counters; write nothing.
typedef struct aisle_order {
    aisle_order_config cfg;
    uint8_t order[AISLE_ORDER_MAX]; // a permutation, the best known; at first the guess or as given
    double value;                   // its cost, INFINITY: not all of it can be gone
    uint32_t evals, kicks;          // costs or moves weighed, kicks; since start
    aisle_order_phase phase;
    aisle_status ended;
    double *table;                                                  // [2^n * n]
    uint32_t set, last;                                             // entry of the table in hand
    double bar;                                                     // stands for INFINITY, above any order's cost
    double least_gain;                                              // below it is rounding
    uint8_t now[AISLE_ORDER_MAX];                                   // order in hand
    double now_value, best_value;                                   // with bars
    uint32_t count;                                                 // places in it
    uint64_t dirty;                                                 // places still to be looked at
    double ahead[AISLE_ORDER_MAX + 1U], back[AISLE_ORDER_MAX + 1U]; // sums along it from the first place on, both ways
    aisle_rng rng;
} aisle_order;

// Checks cfg and copies it, but for cost and guess. AISLE_ERR_ARG: n out of range, NULL, a cost negative, NaN or too
// large, or guess no permutation; AISLE_ERR_CAPACITY: work_len < AISLE_ORDER_WORK_LEN(n). On error self is unchanged.
// O(n^2).
aisle_status aisle_order_start(aisle_order *self, const aisle_order_config *cfg, double *work, size_t work_len);

// Weighs about `evals` costs or moves: at most one indivisible piece (below 2 n^2) above it. AISLE_BUSY: call again.
// AISLE_OK: `order` is the cheapest one, or what the kicks came to. AISLE_PARTIAL: no order was found that has a way
// everywhere; for exact runs that is a proof. Further calls repeat the answer and cost nothing.
// AISLE_ERR_ARG: never started (self all zero).
aisle_status aisle_order_step(aisle_order *self, uint32_t evals);

// Cost of any permutation of the places; INFINITY: somewhere there is no way. O(n).
double aisle_order_value(const aisle_order_config *cfg, const uint8_t *order);

// O(n): true unless memory was overwritten. For asserts and tests.
bool aisle_order_invariants_hold(const aisle_order *self);
#endif
