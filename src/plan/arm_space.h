// arm_space.h - the joint angles of an arm, as sampling planners (algo/rrt.h) want them. Level 4.
//
// A configuration is an angle for each joint, within its limits; nothing comes round. The motion between two is the straight line
// of joint angles, run as arm_motion.h's piece without a bend, and tested as a whole (arm_free.h). Distance and cost: Euclidean,
// rad. Memory: none. Time: a motion is O(1) in the open, O(travel / gap * obstacles near) else.
#ifndef AISLE_PLAN_ARM_SPACE_H
#define AISLE_PLAN_ARM_SPACE_H

#include "algo/rrt.h"
#include "plan/arm_free.h"

typedef struct aisle_arm_space {
    aisle_cspace cspace; // its context is this struct, which must stay where it is
    const aisle_arm_world *world;
} aisle_arm_space;

// Turns to a world that was begun; it stays the caller's.
void aisle_arm_space_begin(aisle_arm_space *self, const aisle_arm_world *world);

// What the planners RRT to RRT_STAR_ADAPTIVE are, all of a config but its ends and seed. step in rad; 0: 0.5.
aisle_rrt_config aisle_arm_space_rrt(const aisle_arm_space *self, bool star, bool adaptive, double step);
#endif
