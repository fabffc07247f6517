// cspace.h - a space of configurations as sampling planners see it. Level 2: knows no robots, maps or units.
//
// A configuration is `dim` numbers. A coordinate may be an angle, or anything else that comes round: then `period` says
// after how much, and it is kept in [lo, lo + period). Contract of the functions; none may be NULL but as said:
//     sample    uniform in the bounds, not necessarily free
//     sample_between  uniform among those of them with bound(a, q) + bound(q, b) <= most. NULL: sample() until one is so
//     retract   moves a q that is not free to one near it that may be; a free one stays. NULL: all stay
//     distance  a metric: what is near. NULL: the weighted Euclidean one below, which is then exact
//     cost      of the motion from a to b, at least bound(); what an optimum is measured by. NULL: the distance
//     bound     no motion from a to b costs less. NULL: the distance
//     steer     q = the configuration at `part` in [0, 1] of the motion from a to b: at 0 it is a, at 1 b
//     is_free   is the whole motion from a to b free, ends included? Exact and continuous, not by samples. Adds what it
//               cost to *units, at least 1
// All answer the same for the same arguments for as long as a tree or roadmap lives.
// Whatever the metric, distance(a, b)^2 >= sum over d of (weight[d] * |a[d] - b[d]|)^2, differences the short way round,
// so that an index may rule places out by their coordinates alone; a weight may be 0.
// Memory: none of its own. Time: the functions'. Sampling planners: algo/near.h, algo/rrt.h.
#ifndef AISLE_ALGO_CSPACE_H
#define AISLE_ALGO_CSPACE_H

#include "base/rng.h"

#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define AISLE_CSPACE_DIM_MAX 4U

typedef struct aisle_cspace {
    uint32_t dim;                        // [1, AISLE_CSPACE_DIM_MAX]
    double lo[AISLE_CSPACE_DIM_MAX];     // bounds, finite, lo < hi
    double hi[AISLE_CSPACE_DIM_MAX];     // of what comes round: lo + period
    double weight[AISLE_CSPACE_DIM_MAX]; // >= 0, see above
    double period[AISLE_CSPACE_DIM_MAX]; // 0: does not come round
    void *context;                       // passed to the functions
    void (*sample)(void *context, aisle_rng *rng, double *q);
    void (*sample_between)(void *context, aisle_rng *rng, const double *a, const double *b, double most, double *q);
    void (*retract)(void *context, double *q);
    double (*distance)(void *context, const double *a, const double *b);
    double (*cost)(void *context, const double *a, const double *b);
    double (*bound)(void *context, const double *a, const double *b);
    void (*steer)(void *context, const double *a, const double *b, double part, double *q);
    bool (*is_free)(void *context, const double *a, const double *b, uint32_t *units);
} aisle_cspace;

// The short way round from a to b, in [-period / 2, period / 2]; b - a where period is 0. |b - a| <= period.
static inline double aisle_cspace_difference(double a, double b, double period) {
    const double d = b - a;
    if (period > 0.0 && d > 0.5 * period) {
        return d - period;
    }
    return period > 0.0 && d < -0.5 * period ? d + period : d;
}

// sum over d of (weight[d] * difference)^2: never above the distance squared.
static inline double aisle_cspace_least_squared(const aisle_cspace *self, const double *a, const double *b) {
    double sum = 0.0;
    for (uint32_t d = 0; d < self->dim; d++) {
        const double difference = self->weight[d] * aisle_cspace_difference(a[d], b[d], self->period[d]);
        sum += difference * difference;
    }
    return sum;
}

static inline double aisle_cspace_distance(const aisle_cspace *self, const double *a, const double *b) {
    return self->distance != NULL ? self->distance(self->context, a, b) : sqrt(aisle_cspace_least_squared(self, a, b));
}

static inline double aisle_cspace_cost(const aisle_cspace *self, const double *a, const double *b) {
    return self->cost != NULL ? self->cost(self->context, a, b) : aisle_cspace_distance(self, a, b);
}

static inline double aisle_cspace_bound(const aisle_cspace *self, const double *a, const double *b) {
    return self->bound != NULL ? self->bound(self->context, a, b) : aisle_cspace_distance(self, a, b);
}
#endif
