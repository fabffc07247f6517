// manoeuvre_parts.h - what the files of manoeuvre share with each other and with nobody else. Level 4.
#ifndef AISLE_PLAN_MANOEUVRE_PARTS_H
#define AISLE_PLAN_MANOEUVRE_PARTS_H

#include "plan/manoeuvre.h"

static inline aisle_vec2 aisle_pose_place(aisle_pose2 pose) {
    return aisle_vec2_of(pose.x, pose.y);
}

// Does the body keep what it needs at this configuration; all along these moves from it on? Exact, a unit a gap.
bool aisle_manoeuvre_pose_free(aisle_manoeuvre *self, aisle_pose2 pose);
bool aisle_manoeuvre_moves_free(aisle_manoeuvre *self, aisle_pose2 from, const aisle_move *moves, uint32_t count);

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
