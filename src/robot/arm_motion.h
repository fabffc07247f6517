// arm_motion.h - joint angles as polynomials of the 7th degree from rest to rest, and how fast they may be run. Level 3.
//
// A piece is q_j(r), r = t / T in [0, 1], with q' = q'' = 0 at both ends (Machmudah, Parman & Zainuddin 2012, "Polynomial joint
// angle arm robot motion planning in complex geometrical obstacles": each joint keeps two free coefficients, a6 and a7). Ours, not
// theirs: the two free numbers are those of a bend,
//     q(r) = q0 + (q1 - q0) (10 r^3 - 15 r^4 + 6 r^5) + r^3 (1 - r)^3 (b0 + b1 (r - 1/2)),
// which keeps the ends whatever they are: a6 = 3.5 b1 - b0, a7 = -b1. b0 = 64 bends the middle by 1 rad.
// Time: run in T seconds, velocities fall with 1/T, accelerations with 1/T^2, jerks with 1/T^3, and a torque is
//     tau(r) = gravity(r) + inertia(r) / T^2
// (arm_dynamics.h), so the least T of a piece is the greatest of four closed forms over r.
// Memory: the caller's structs. Objects share nothing.
#ifndef AISLE_ROBOT_ARM_MOTION_H
#define AISLE_ROBOT_ARM_MOTION_H

#include "robot/arm_dynamics.h"

#define AISLE_ARM_DEGREE 7U

typedef struct aisle_arm_piece {
    uint32_t links;
    double c[AISLE_ARM_LINKS][AISLE_ARM_DEGREE + 1U]; // q_j(r), lowest power first, rad
} aisle_arm_piece;

// From one configuration to another; bend[2 * links]: b0 and b1 of each joint, NULL: all 0, the motion along the straight line
// of joint angles. O(links).
void aisle_arm_piece_of(uint32_t links, const double *from, const double *to, const double *bend, aisle_arm_piece *out);

// b0 and b1 of the paper's coefficients of a joint.
void aisle_arm_bend_of_paper(double a6, double a7, double *bend);

// The derivative of this order (0 to 3) by r at r: out[links].
void aisle_arm_piece_at(const aisle_arm_piece *self, double r, uint32_t order, double *out);

// Greatest |derivative| of this order of each joint over [0, 1]: out[links]. By roots, as poly.h says.
void aisle_arm_piece_peaks(const aisle_arm_piece *self, uint32_t order, double *out);

// The same, bounded from above by Bernstein coefficients (poly.h): up to four times as much, for a tenth of the work.
void aisle_arm_piece_bounds(const aisle_arm_piece *self, uint32_t order, double *out);

// Joint angle travelled, rad, sum over joints: the integral of |q'| by Simpson's rule, as in the paper, on AISLE_ARM_SIMPSON
// panels (within 1e-3 of the exact one on the bends that planners try); and exactly, between the places where q' changes its sign.
#define AISLE_ARM_SIMPSON 32U
double aisle_arm_piece_travel(const aisle_arm_piece *self);
double aisle_arm_piece_travel_exact(const aisle_arm_piece *self);

// First joint (from 1) that leaves its limits by more than 1e-9 rad somewhere; 0: none. *out (may be NULL): by how much, rad,
// all joints together. By roots.
uint32_t aisle_arm_piece_joint_out(const aisle_arm_piece *self, const aisle_arm *arm, double *out);

typedef enum aisle_arm_limit {
    AISLE_ARM_LIMIT_NONE,
    AISLE_ARM_LIMIT_VELOCITY,
    AISLE_ARM_LIMIT_ACCELERATION,
    AISLE_ARM_LIMIT_JERK,
    AISLE_ARM_LIMIT_TORQUE
} aisle_arm_limit;

typedef struct aisle_arm_timing {
    double duration;       // s, the least; INFINITY: gravity alone is more than a motor holds. 0: nothing moves
    aisle_arm_limit limit; // that sets it
    uint32_t joint;        // whose, from 0
} aisle_arm_timing;

// Velocity, acceleration and jerk exactly (by roots). Torque: the least 1/T^2 that any joint leaves open, over r: at panels + 1
// places, and refined by golden section about every one that is lower than its neighbours and at most twice the lowest; exact where no
// dip is narrower than two panels. panels in [2, AISLE_ARM_TIMING_PANELS]. O(panels * links^2), 1 KiB of stack.
#define AISLE_ARM_TIMING_PANELS 128U
void aisle_arm_least_duration(const aisle_arm *arm, const aisle_arm_dynamics *dynamics, const aisle_arm_piece *piece,
                              uint32_t panels, aisle_arm_timing *out);
#endif
