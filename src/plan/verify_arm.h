// verify_arm.h - proves an encoded arm_path_t before it may leave: the one gate between planning and sending. Level 4.
//
// Works on the bytes, in double, from the quintics their waypoints define (arm_path_t.lcm). Shares no code with the search: its own
// kinematics, obstacles straight from the layout's polygons, scan bits and bounds, contact by libccd (world/collide.h), torques by
// Newton and Euler's recursion (Craig 2005, ch. 6.5) where the search uses Lagrange's form. Common are the layout's lists, the
// trigonometry and the rule of what the first link may lie on (aisle_arm_mount()).
// Proved:
// - the header: layout's map and revision, vehicle's revision, status OK, no cause; times rise from 0, at most AISLE_VERIFY_ARM_TIME_MAX;
//   duration is the last time, clearance_min the least of the waypoints'; numbers of links there are none of are 0;
// - the motion begins at q_start (1e-6 rad) and ends at the goal, within its tolerances; it is at rest at both ends;
// - joint limits (1e-6 rad), velocity, acceleration and jerk of every joint, continuously: the derivatives of a quintic are
//   bounded by their Bernstein coefficients on halves of halves, down to 1/64 of a piece;
// - torques, continuously: over an interval of length h a torque is within (h / 2) * max |d tau / dt| of that at its middle, where
//   with c = sum of masses from the farther one of links k, j outwards * l_k * l_j (+ rotary inertia for k = j) and directions phi
//       |d tau_i / dt| <= sum over k >= i, j of c (|phid_k - phid_j| (|phidd_j| + phid_j^2) + |phiddd_j| + 2 |phid_j phidd_j|)
//                         + |gravity| * masses from k on * l_k |phid_k|,
//   all bounded on the interval; halved until it is proved or an interval's middle is above the limit;
// - contact: over an interval link i stays within sum over j <= i of |dq_j| reach(j, i) of where it is in the middle, |dq_j|
//   bounded by Bernstein coefficients: the capsule grown by that and AISLE_VERIFY_EPSILON touches nothing, or the interval is halved,
//   down to AISLE_VERIFY_ARM_STEP;
// - told torques, to 1e-3 of the limit.
// Not proved: clearances themselves, travel.
// Memory: the caller's struct and one arm_path_msg. Time: O(intervals * obstacles near), sliced. Units: 1 an interval, 1 a waypoint.
#ifndef AISLE_PLAN_VERIFY_ARM_H
#define AISLE_PLAN_VERIFY_ARM_H

#include "plan/verify.h"
#include "robot/arm.h"

#define AISLE_VERIFY_ARM_DEPTH 40U
#define AISLE_VERIFY_ARM_STEP 1e-5            // m, of growth: below it what touches is contact
#define AISLE_VERIFY_ARM_TIME_MAX 1e4         // s
#define AISLE_VERIFY_ARM_TOLERANCE 1e-3       // m, of a goal that names none
#define AISLE_VERIFY_ARM_TOLERANCE_THETA 1e-3 // rad, likewise, and of each joint with JOINTS and STOW
#define AISLE_ARM_PATH_BYTES ((size_t)AISLE_ARM_PATH_MAX_WAYPOINTS * 56U + 128U) // of an encoded arm_path_t

typedef struct aisle_verify_arm_request {
    const aisle_layout *layout;
    const aisle_vehicle *vehicle;
    const aisle_arm *arm;
    aisle_pose2 pose; // of the vehicle
    const aisle_arm_goal_msg *goal;
    const uint8_t *bytes; // encoded arm_path_t, stays put until the end
    size_t size;
} aisle_verify_arm_request;

typedef enum aisle_verify_arm_fault {
    AISLE_VERIFY_ARM_NONE,
    AISLE_VERIFY_ARM_DECODE, // not an arm_path_t, or a count, id, status or sum in it is wrong
    AISLE_VERIFY_ARM_START,
    AISLE_VERIFY_ARM_GOAL,
    AISLE_VERIFY_ARM_REST, // not at rest at an end
    AISLE_VERIFY_ARM_TIME,
    AISLE_VERIFY_ARM_JOINT, // out of its limits
    AISLE_VERIFY_ARM_VELOCITY,
    AISLE_VERIFY_ARM_ACCELERATION,
    AISLE_VERIFY_ARM_JERK,
    AISLE_VERIFY_ARM_TORQUE,
    AISLE_VERIFY_ARM_CONTACT
} aisle_verify_arm_fault;

typedef enum aisle_verify_arm_phase {
    AISLE_VERIFY_ARM_PHASE_HEADER,
    AISLE_VERIFY_ARM_PHASE_LIMITS,
    AISLE_VERIFY_ARM_PHASE_TORQUE,
    AISLE_VERIFY_ARM_PHASE_CONTACT,
    AISLE_VERIFY_ARM_PHASE_DONE
} aisle_verify_arm_phase;

typedef struct aisle_verify_arm {
    aisle_verify_arm_request request;
    aisle_arm_path_msg *path; // decoded copy; the caller's
    aisle_verify_arm_fault fault;
    uint32_t fault_waypoint; // later end of the piece
    uint32_t fault_joint;    // or link, from 0
    int32_t fault_id;        // of the obstacle
    uint32_t intervals;      // looked at
    aisle_collide_count collide;

    // The verifier's own.
    aisle_verify_arm_phase phase;
    uint32_t at;                  // piece in hand, by its later waypoint
    double c[AISLE_ARM_LINKS][6]; // its quintics in u in [0, 1]
    double dt;
    double lo, hi[AISLE_VERIFY_ARM_DEPTH]; // intervals not yet proved, the next on top
    uint32_t depth;
    aisle_pose2 base;
    aisle_vec2 outline[AISLE_SHAPE_VERTICES_MAX];
    uint32_t outline_count;
    double exempt;
    uint64_t digest;
} aisle_verify_arm;

// Begins; decoded, bytes and all that the request names stay in use until the end.
void aisle_verify_arm_start(aisle_verify_arm *self, const aisle_verify_arm_request *request,
                            aisle_arm_path_msg *decoded);

// About `units`, added to *spent. AISLE_BUSY; AISLE_OK: proved, *stamp written; AISLE_ERR_DATA: fault says why, *stamp zeroed.
aisle_status aisle_verify_arm_step(aisle_verify_arm *self, uint32_t units, uint32_t *spent, aisle_stamp *stamp);

// The only way out of an arm_path_t: fills *event for these bytes if the stamp proves just them, or if they are an arm_path_t of
// status NONE without waypoints. AISLE_ERR_ARG otherwise, *event untouched.
aisle_status aisle_release_arm(const uint8_t *bytes, size_t size, const aisle_stamp *stamp, aisle_event *event);

// Does q reach the goal, by its kind and tolerances? JOINTS and STOW: each joint. O(links).
bool aisle_verify_arm_reaches(const aisle_arm *arm, aisle_pose2 base, const aisle_arm_goal_msg *goal, const double *q);
#endif
