// cost_pair.h - what the population searches minimise: a pair, compared first by violation, then by value, never added up.
// Level 2.
//
// Feasibility first: Deb 2000, doi:10.1016/S0045-7825(99)00389-8. Time: O(1). Memory: none.
#ifndef AISLE_ALGO_COST_PAIR_H
#define AISLE_ALGO_COST_PAIR_H

#include <math.h>
#include <stdbool.h>

typedef struct aisle_cost_pair { // smaller is better: violation first, then value
    float violation;             // 0 (or below) = feasible; INFINITY = not allowed at all
    float value;                 // INFINITY = not allowed at all
} aisle_cost_pair;

// Cost of x[dim]. NaN in either part is counted and read as not allowed.
typedef aisle_cost_pair (*aisle_cost_pair_fn)(void *ctx, const float *x);

static inline aisle_cost_pair aisle_cost_pair_not_allowed(void) {
    return (aisle_cost_pair){INFINITY, INFINITY};
}

static inline bool aisle_cost_pair_is_allowed(aisle_cost_pair cost) {
    return cost.violation < INFINITY && cost.value < INFINITY;
}

static inline bool aisle_cost_pair_is_nan(aisle_cost_pair cost) {
    return isnan(cost.violation) || isnan(cost.value);
}

// An answer of a cost function as it is kept: NaN and INFINITY in either part as not allowed, violations below 0 as 0.
static inline aisle_cost_pair aisle_cost_pair_read(aisle_cost_pair cost) {
    const bool is_allowed = !aisle_cost_pair_is_nan(cost) && aisle_cost_pair_is_allowed(cost);
    cost.violation = cost.violation > 0.0F ? cost.violation : 0.0F;
    return is_allowed ? cost : aisle_cost_pair_not_allowed();
}

// True if a is better than b: feasibility first.
static inline bool aisle_cost_pair_better(aisle_cost_pair a, aisle_cost_pair b) {
    return a.violation < b.violation || (!(b.violation < a.violation) && a.value < b.value);
}
#endif
