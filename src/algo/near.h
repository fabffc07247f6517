// near.h - which of the configurations put in so far are the nearest ones. Level 2: knows no robots, maps or units.
//
// A k-d tree (Bentley 1975, doi:10.1145/361002.361007) of buckets: each node keeps the tight box of what it holds, so a
// box that is farther off than what is known already is left out; boxes come round where coordinates do. Configurations
// are put in one by one and never taken out. Where a tree that grew from one place outwards is deeper than twice the
// depth of an even one, the smallest part of it that is out of balance is built anew by medians (scapegoat trees: Galperin
// & Rivest 1993; of k-d trees: Andersson 1989, doi:10.1007/3-540-51542-9_33).
// Answers are exact and do not depend on the tree's shape: nearest first, of equal distances the one put in first.
//
// Memory: the caller's arena; a configuration takes 16 * dim + 18 bytes (50 of two dimensions, 66 of three), half of it
// the nodes'. No recursion. Time: find() about log n + k boxes and their buckets (a microsecond for the
// nearest of 10,000); add() log n, amortised: one that builds anew takes n log n at worst.
#ifndef AISLE_ALGO_NEAR_H
#define AISLE_ALGO_NEAR_H

#include "algo/cspace.h"
#include "base/arena.h"

#define AISLE_NEAR_NONE UINT32_MAX
#define AISLE_NEAR_BUCKET 8U     // configurations that a leaf holds, more only where they are all the same
#define AISLE_NEAR_DEPTH_MAX 64U // of the tree
#define AISLE_NEAR_CAPACITY_MAX (1U << 24)

typedef struct aisle_near_node {
    uint32_t first, second; // children; of a leaf: its first configuration and AISLE_NEAR_NONE
    uint32_t count;         // configurations below
    float split;            // what is below it in coordinate `axis` was put into the first child
    uint32_t axis;
} aisle_near_node;

typedef struct aisle_near {
    const aisle_cspace *space;
    double *q;             // [capacity * dim] the configurations, by index
    uint32_t *next;        // [capacity] in the same leaf; AISLE_NEAR_NONE: the last one
    aisle_near_node *node; // [node_capacity] the root first
    double *box;           // [node_capacity * 2 * dim] least and greatest coordinates below a node
    uint32_t capacity, node_capacity;
    uint32_t *work; // [capacity] scratch, of what is built anew
    uint32_t count, nodes;
    uint32_t spare;   // nodes given back, chained by `first`; AISLE_NEAR_NONE: none
    uint32_t rebuilt; // configurations that were sorted anew, since begin()
    uint32_t depth;   // of the deepest leaf made since begin()
} aisle_near;

// Takes what `capacity` configurations of up to `dim` numbers need; capacity in [1, AISLE_NEAR_CAPACITY_MAX].
void aisle_near_carve(aisle_near *self, aisle_arena *arena, uint32_t capacity, uint32_t dim);

// Empties it. The space is the caller's and stays as it is while this is used; its dim is at most carve()'s.
void aisle_near_begin(aisle_near *self, const aisle_cspace *space);

// Puts q[dim] in, within the space's bounds where it comes round. Answers its index: 0, 1, 2, ...; AISLE_NEAR_NONE: full.
uint32_t aisle_near_add(aisle_near *self, const double *q);

static inline const double *aisle_near_at(const aisle_near *self, uint32_t index) {
    return self->q + (size_t)index * self->space->dim;
}

// The nearest one; AISLE_NEAR_NONE: it is empty. *distance (may be NULL): to it.
uint32_t aisle_near_nearest(const aisle_near *self, const double *q, double *distance);

// The k nearest ones that are no farther than radius (INFINITY: wherever they are), nearest first: found[k] and
// distance[k]. How many there are, k at most. k >= 1. O(k) a configuration found.
uint32_t aisle_near_find(const aisle_near *self, const double *q, uint32_t k, double radius, uint32_t *found,
                         double *distance);

// O(n): true unless memory was overwritten. For asserts and tests.
bool aisle_near_invariants_hold(const aisle_near *self);
#endif
