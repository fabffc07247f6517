// rrt.h - a tree of free motions that grows from a start until it reaches a goal, and then gets better. Level 2: knows no
// robots, maps or units.
//
// RRT (LaValle 1998; LaValle & Kuffner 2001, doi:10.1177/02783640122067453): a configuration is drawn, the tree's nearest
// one goes a step towards it, and where that motion is free its end joins the tree. RRT* (Karaman & Frazzoli 2011,
// doi:10.1177/0278364911406761, the k-nearest form): the new one is hung on the neighbour through which it is cheapest, and
// neighbours that are cheaper through it are hung on it; k = e (1 + 1 / dim) ln n. Adaptive RRT and adaptive RRT* (Ramasamy,
// Eriksson, Danielsson & Ericsson 2023, doi:10.3390/app132212114, algorithms 2 and 6): where the motion is not free, its
// first half is tried and kept if it is. Informed sampling (Gammell, Srinivasa & Barfoot 2014, doi:10.1109/IROS.2014.6942976):
// once a path is known, only configurations are drawn that a cheaper one could run through. Shortened paths (of RRT*-Smart: Islam,
// Nasir, Malik, Ayaz & Hasan 2012, doi:10.1109/ICMA.2012.6284384): each node of a path that was found is hung on the earliest one
// before it that sees it.
// The paper's fixed planners know steps of one size alone (whole_steps), its adaptive ones adapt theirs. Its plain form is a config with only start, goal, step, halvings (0 or 1), whole_steps and star: nothing else is then done but
// what its algorithms say. Ours, by config: `halvings` above 1 halves again and again; `goal_bias`; `reach` lets any new
// node try the goal that is that near; `informed`; `retract`: until there is a path, every other sample that touches something is moved
// off it, so that places beside obstacles and in slits, where few samples are free, are drawn as often as the room about them
// (as Wilmarth, Amato & Stiller 1999, doi:10.1109/ROBOT.1999.772448, retract all samples onto the middle of the free room).
// The goal is a node of the tree without children: best parent and rewiring are its, too.
//
// Memory: the caller's arena; 32 bytes a node and near.h's, 82 in two dimensions, 98 in three; 2 KiB. No recursion. Time: a
// sample about log n, for a star k log n, and the motions tested. Units: 1 a sample and what is_free() adds.
// Determinism: same config, same tree, however the run is cut into steps.
#ifndef AISLE_ALGO_RRT_H
#define AISLE_ALGO_RRT_H

#include "aisle/status.h"
#include "algo/near.h"

#define AISLE_RRT_NONE UINT32_MAX
#define AISLE_RRT_NEIGHBOURS 64U // that a new node of a star looks at, at most

typedef struct aisle_rrt_config {
    const aisle_cspace *space;                                      // stays as it is until the run ends
    double start[AISLE_CSPACE_DIM_MAX], goal[AISLE_CSPACE_DIM_MAX]; // free
    double step;       // > 0, longest distance from a node to the one that a sample makes of it
    uint32_t halvings; // of a motion that is not free: 0 fixed, 1 the paper's midpoint rule
    bool whole_steps;  // a new node is a whole step away, or what halving leaves of one: nearer samples are dropped
    bool star;         // best parent and rewiring; the run goes on after the first path
    bool informed;     // of a star: sample where a cheaper path may run
    bool retract; // until there is a path, every other sample is moved off what it touches, if the space can do that
    bool shorten; // each path that is found leaves out those of its nodes that it can, from the goal back
    double goal_bias; // [0, 1), share of samples that are the goal itself
    double reach;     // >= 0, distance from which a new node tries the goal; 0: step. INFINITY: from everywhere
    uint32_t samples; // drawn at most until there is a path, >= 1
    uint32_t more;    // of a star: and after that
    uint64_t seed;    // any value
} aisle_rrt_config;

typedef struct aisle_rrt_node {
    double cost;                             // from the start
    double edge;                             // from the parent
    uint32_t parent;                         // AISLE_RRT_NONE: the start, or not reached
    uint32_t child, sibling, sibling_before; // AISLE_RRT_NONE: none
} aisle_rrt_node;

// Public so that its parts can be looked at. Read the tree and the counters; write nothing.
typedef struct aisle_rrt {
    aisle_rrt_config cfg;
    aisle_near near;      // the nodes' configurations, but the goal's
    aisle_rrt_node *node; // [capacity + 1] the start first, the goal at [capacity]
    uint32_t capacity;
    aisle_rng rng;
    uint32_t samples;      // drawn so far
    uint32_t first_sample; // that brought the first path; AISLE_RRT_NONE: there is none yet
    uint32_t kept;         // halves of motions that were kept
    uint32_t rewired;      // nodes that were hung on another one
    double first_cost;     // of the first path
    uint32_t units;        // spent in this step
    uint32_t found[AISLE_RRT_NEIGHBOURS];
    double distance[AISLE_RRT_NEIGHBOURS], through[AISLE_RRT_NEIGHBOURS];
} aisle_rrt;

// Takes what a tree of `capacity` nodes needs, of configurations of up to dim numbers. self NULL: to measure only.
void aisle_rrt_carve(aisle_rrt *self, aisle_arena *arena, uint32_t capacity, uint32_t dim);

// Begins; tries the goal from the start if it is in reach. AISLE_ERR_ARG, nothing changed: cfg breaks a rule above.
aisle_status aisle_rrt_start(aisle_rrt *self, const aisle_rrt_config *cfg);

// Draws samples until about `units` are spent, adds them to *spent. AISLE_BUSY: go on. AISLE_OK: ended with a path: of a
// plain tree the first one; of a star `more` samples are drawn, the nodes used up, or nothing can be cheaper. AISLE_PARTIAL:
// ended without. Further calls repeat the answer.
aisle_status aisle_rrt_step(aisle_rrt *self, uint32_t units, uint32_t *spent);

// Cost of the best path so far; INFINITY: there is none.
static inline double aisle_rrt_cost(const aisle_rrt *self) {
    return self->node[self->capacity].cost;
}

// A node's configuration; node `capacity` is the goal.
static inline const double *aisle_rrt_at(const aisle_rrt *self, uint32_t n) {
    return n == self->capacity ? self->cfg.goal : aisle_near_at(&self->near, n);
}

// The best path so far, from the start to the goal: nodes[most]. How many there are, 0: there is no path; above `most`:
// they do not fit, nothing is written. O(nodes on it).
uint32_t aisle_rrt_path(const aisle_rrt *self, uint32_t *nodes, uint32_t most);

// O(n): true unless memory was overwritten: parents and children agree, costs are sums of edges.
bool aisle_rrt_invariants_hold(const aisle_rrt *self);
#endif
