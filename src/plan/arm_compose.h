// arm_compose.h - a whole arm_path_t from proved pieces: times, waypoints, sums. Level 4.
//
// A piece runs in its least duration (arm_motion.h) times a stretch. Its ends lie on times that a float holds, and so do the waypoints
// on it, evenly spread: AISLE_ARM_STEPS of a bent piece, AISLE_ARM_STEPS_STRAIGHT of one without a bend, which the quintic between
// two waypoints (arm_path_t.lcm) is exactly. The quintics through a bent piece are off it by less than 1e-6 rad.
// clearance: the gap at a waypoint (arm_world.h), at most AISLE_ARM_SIGHT, rounded down.
// Memory: the caller's structs. Time: O(waypoints * obstacles near).
#ifndef AISLE_PLAN_ARM_COMPOSE_H
#define AISLE_PLAN_ARM_COMPOSE_H

#include "plan/arm_world.h"

#define AISLE_ARM_PIECES 60U
#define AISLE_ARM_STEPS 32U
#define AISLE_ARM_STEPS_STRAIGHT 8U

typedef struct aisle_arm_plan { // one piece after the other, from rest to rest
    aisle_arm_piece piece[AISLE_ARM_PIECES];
    double duration[AISLE_ARM_PIECES]; // s, the least
    uint32_t count;                    // 0: the arm is where it is to be
} aisle_arm_plan;

// Fills the durations. False: gravity alone is more than a motor holds; *joint: whose, from 0.
bool aisle_arm_plan_time(aisle_arm_plan *self, const aisle_arm *arm, const aisle_arm_dynamics *dynamics,
                         uint32_t *joint);

// Waypoints, duration, travel, clearance_min; the rest of *path is the caller's. at[links]: where the arm is if count is 0.
// AISLE_ERR_CAPACITY: more waypoints than the message holds.
aisle_status aisle_arm_compose(const aisle_arm_plan *plan, const aisle_arm_world *world,
                               const aisle_arm_dynamics *dynamics, const double *at, double stretch,
                               aisle_arm_path_msg *path);
#endif
