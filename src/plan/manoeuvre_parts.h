// manoeuvre_parts.h - what the files of manoeuvre share with each other and with nobody else. Level 4.
#ifndef AISLE_PLAN_MANOEUVRE_PARTS_H
#define AISLE_PLAN_MANOEUVRE_PARTS_H

#include "plan/manoeuvre.h"

static inline aisle_vec2 aisle_pose_place(aisle_pose2 pose) {
    return aisle_vec2_of(pose.x, pose.y);
}

// manoeuvre_free.c: does the body keep what it needs at this configuration; all along these moves from it on? Exact, a unit a gap.
bool aisle_manoeuvre_pose_free(aisle_manoeuvre *self, aisle_pose2 pose);
bool aisle_manoeuvre_moves_free(aisle_manoeuvre *self, aisle_pose2 from, const aisle_move *moves, uint32_t count);
// What moves from a configuration on cost beyond steer.h's, m, because they come near to something.
double aisle_manoeuvre_surcharge(aisle_manoeuvre *self, aisle_pose2 from, const aisle_move *moves, uint32_t count);

// manoeuvre_open.c: the open list and the cells of configurations.
//
// Forgets both; side as in aisle_manoeuvre.
void aisle_manoeuvre_begin_open(aisle_manoeuvre *self, double side);
// Puts a node in, unless its cell is closed or holds enough, or nothing leads on from there.
void aisle_manoeuvre_push(aisle_manoeuvre *self, const aisle_manoeuvre_node *node);
// The next node to expand; AISLE_HEAP_NONE: there is none, or this one came to nothing (*ended tells which).
uint32_t aisle_manoeuvre_next(aisle_manoeuvre *self, uint32_t most, bool *ended);

// manoeuvre_expand.c: puts in what a node leads to, or where all begins.
void aisle_manoeuvre_expand(aisle_manoeuvre *self, uint32_t n);
void aisle_manoeuvre_push_root(aisle_manoeuvre *self, aisle_pose2 at, double theta);
void aisle_manoeuvre_push_roots(aisle_manoeuvre *self, aisle_pose2 at, bool any_heading);

// manoeuvre_chain.c
//
// The moves from a node's parent to it: moves[AISLE_REEDS_SHEPP_MOVES]; how many, 0: it is a root.
uint32_t aisle_manoeuvre_moves_to(const aisle_manoeuvre *self, uint32_t n, aisle_move *moves);
// Takes the chain that ends at n, and the tree's from there on, as the way. False: it is too long.
bool aisle_manoeuvre_take_chain(aisle_manoeuvre *self, uint32_t n);

static inline bool aisle_manoeuvre_is_goal(const aisle_manoeuvre_target *target) {
    return target->togo <= 0.0;
}

// One more target, if there is room for it and the goal is reached from there: togo as known, of a tree's node.
void aisle_manoeuvre_add_target(aisle_manoeuvre *self, aisle_pose2 pose, double togo, uint32_t node);

// manoeuvre_targets.c: makes the targets, some at a time. False: all are made.
void aisle_manoeuvre_begin_targets(aisle_manoeuvre *self);
bool aisle_manoeuvre_make_target(aisle_manoeuvre *self);

// manoeuvre_shorten.c: shortens the chain by one junction's worth of trials. False: nothing is left to do.
void aisle_manoeuvre_begin_shorten(aisle_manoeuvre *self);
bool aisle_manoeuvre_shorten(aisle_manoeuvre *self);
#endif
