// arm_dynamics.h - torques of the planar arm by Lagrange and Euler. Level 3.
//
//     tau = M(q) qdd + h(q, qd) + g(q)
// (Angeles 2002, "Fundamentals of Robotic Mechanical Systems", as the arm paper has it; Craig 2005, ch. 6). A link is a capsule of
// even density, so a rod whose ends are round: mass m, centre in the middle of its axis, and about it the inertia
//     I = m (l2 / 12 + r2 / 4)     (a cylinder of length l and radius r; ours: the caps' extra length is left out).
// Written in directions phi_i = base.theta + q_1 + ... + q_i instead of joint angles: there the kinetic energy is
//     1/2 sum_ij A_ij cos(phi_i - phi_j) phid_i phid_j,
// A_ij constant, and torques follow by adding the forces of all links beyond a joint. Units: kg m2, N m, rad, s.
// Memory: the caller's structs. Time: O(links^2), at most 3 sincos of differences. Objects share nothing.
#ifndef AISLE_ROBOT_ARM_DYNAMICS_H
#define AISLE_ROBOT_ARM_DYNAMICS_H

#include "robot/arm.h"

typedef struct aisle_arm_dynamics {
    uint32_t links;
    double a[AISLE_ARM_LINKS][AISLE_ARM_LINKS]; // A_ij above, symmetric, rotary inertia on the diagonal
    double weight[AISLE_ARM_LINKS];             // N m: gravity times what link i's direction lifts
    double base_theta;
} aisle_arm_dynamics;

// Of an arm whose base points to base_theta in the frame that gravity acts along -y of.
void aisle_arm_dynamics_begin(aisle_arm_dynamics *self, const aisle_arm *arm, double base_theta);

// Torques torque[links] that move the arm so; all parts of them are linear in what scales time: with q' and q'' by r = t / T
// in place of qd and qdd, *inertia is T^2 times the torque's part beside *gravity. Either may be NULL.
void aisle_arm_torque(const aisle_arm_dynamics *self, const double *q, const double *qd, const double *qdd,
                      double *inertia, double *gravity);

// Kinetic and potential energy, J; potential 0 with the links at the base's height.
double aisle_arm_kinetic(const aisle_arm_dynamics *self, const double *q, const double *qd);
double aisle_arm_potential(const aisle_arm_dynamics *self, const double *q);
#endif
