// arm.h - a planar arm of up to three links on the vehicle: what it is, where it stands, how it gets to a place. Level 3.
//
// A chain: joint 1 sits at the base, link i's frame is carried by link i-1, so link i points in the direction
// base.theta + q_1 + ... + q_i. A link is a capsule of `length` and `radius` between its joints. Units: m, rad, s, kg, N m.
// Memory: the caller's structs. Time: O(links^2) but as said. Objects share nothing.
#ifndef AISLE_ROBOT_ARM_H
#define AISLE_ROBOT_ARM_H

#include "aisle/messages.h"
#include "aisle/status.h"
#include "base/vec.h"
#include "world/layout.h" // aisle_refusal

#include <stdbool.h>
#include <stdint.h>

#define AISLE_ARM_LINKS ((uint32_t)AISLE_VEHICLE_MAX_LINKS)
#define AISLE_ARM_ANGLE_MAX 100.0   // rad, of joint limits
#define AISLE_ARM_LENGTH_MAX 20.0   // m, of links and of the base's place on the vehicle
#define AISLE_ARM_VALUE_MAX 1e6     // of every other number, in its unit
#define AISLE_ARM_SOLUTIONS_MAX 64U // of inverse kinematics

typedef struct aisle_arm {
    uint32_t links;                                        // [0, 3]; 0: there is no arm
    aisle_pose2 base;                                      // in the vehicle frame
    double length[AISLE_ARM_LINKS];                        // > 0
    double radius[AISLE_ARM_LINKS], mass[AISLE_ARM_LINKS]; // > 0
    double min[AISLE_ARM_LINKS], max[AISLE_ARM_LINKS];     // joint limits, min < max
    double v_max[AISLE_ARM_LINKS], a_max[AISLE_ARM_LINKS], j_max[AISLE_ARM_LINKS], torque_max[AISLE_ARM_LINKS]; // > 0
    double
        gravity; // m/s2 along -y of the frame that the base's pose is in: 0 in the layout's plane; else a vertical plane
} aisle_arm;

// Takes the arm of a vehicle_t. A value of 0 means its default:
//
//     link_length  0.4 m     link_radius  0.04 m      link_mass   2 kg
//     joint_min, joint_max   -pi and pi, if both are 0
//     joint_v_max  1.5 rad/s joint_a_max  3 rad/s2    joint_j_max 30 rad/s3    joint_torque_max  100 N m
//
// num_links 0: no arm, nothing else is looked at. AISLE_ERR_DATA, *out unchanged: *why has cause MALFORMED, the place of
// the first member at fault in vehicle_t as its id (utime is 0; num_links 24, arm_base 25, link_length 26, ... joint_torque_max
// 34) and the value found. At fault is a number that is not finite, too large, or negative where it must not be; num_links not in
// [0, 3]; joint_max (30) not above joint_min.
aisle_status aisle_arm_from_msg(const aisle_vehicle_msg *msg, aisle_arm *out, aisle_refusal *why);

// The base where the vehicle stands at `vehicle`.
aisle_pose2 aisle_arm_base(const aisle_arm *self, aisle_pose2 vehicle);

// Joints and tip in the frame of `base`: points[links + 1], link i from points[i-1] to points[i]. |q| <= AISLE_ANGLE_MAX / 4.
// Returns the tip's direction, base.theta + sum of q.
double aisle_arm_place(const aisle_arm *self, aisle_pose2 base, const double *q, aisle_vec2 *points);

// d tip / d q: jacobian[j] = (dx/dq_j, dy/dq_j), the tip less joint j turned by a right angle; dtheta/dq_j is 1.
void aisle_arm_jacobian(const aisle_arm *self, aisle_pose2 base, const double *q, aisle_vec2 *jacobian);

// Farthest that a point of link `link` (axis, from 0) can be from joint `joint` <= link: the sum of lengths between.
double aisle_arm_reach(const aisle_arm *self, uint32_t joint, uint32_t link);

// First joint whose angle is out of its limits by more than `slack`, from 1; 0: none is. NaN is out.
uint32_t aisle_arm_joint_out(const aisle_arm *self, const double *q, double slack);

// Where the arm is stowed: every joint at 0, or at its limit nearest to 0.
void aisle_arm_stow(const aisle_arm *self, double *q);

typedef struct aisle_arm_target {
    aisle_vec2 at;          // where the tip goes, in the frame of the base's pose
    bool has_theta;         // and in what direction it points
    double theta;           // rad
    double tolerance_xy;    // m, > 0
    double tolerance_theta; // rad, > 0
} aisle_arm_target;

typedef struct aisle_arm_solutions {
    double q[AISLE_ARM_SOLUTIONS_MAX][AISLE_ARM_LINKS];
    uint32_t count;
    double miss; // m, with count 0: how far the target is beyond (or within) what the links reach; 0: they do reach it,
    uint32_t joint; // and this joint's limits (from 1) are in the way, of the way that is out by least; 0: none
} aisle_arm_solutions;

// Configurations within the joint limits that bring the tip to the target, nearest to `from` first by the sum over joints of
// the angles between (ties: order of making). Of two links in the plane both elbows; of three with a direction both, with
// none both for each of 48 directions of the tip; each joint by as many turns as its limits leave, those nearest to `from`
// first. A target that the links miss by less than its tolerance is taken where they come nearest. One link has one way.
// Closed form: law of cosines (Craig 2005, "Introduction to Robotics", ch. 4.4). Tip error 1e-12 m a metre of reach.
void aisle_arm_solve(const aisle_arm *self, aisle_pose2 base, const aisle_arm_target *target, const double *from,
                     aisle_arm_solutions *out);
#endif
