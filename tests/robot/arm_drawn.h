// arm_drawn.h - test fixture: arms drawn from a seed, their torques by Newton and Euler in long double, and how much of
// its limits a piece takes.
#ifndef AISLE_TESTS_ARM_DRAWN_H
#define AISLE_TESTS_ARM_DRAWN_H

#include "base/rng.h"
#include "robot/arm_motion.h"

#include <math.h>
#include <string.h>

#define DRAWN_UNUSED __attribute__((unused)) static

DRAWN_UNUSED double drawn_between(aisle_rng *rng, double lo, double hi) {
    return lo + (hi - lo) * (double)aisle_rng_float(rng);
}

DRAWN_UNUSED aisle_arm drawn_arm(aisle_rng *rng, uint32_t links) {
    aisle_arm arm;
    memset(&arm, 0, sizeof arm);
    arm.links = links;
    arm.base =
        (aisle_pose2){drawn_between(rng, -0.5, 0.5), drawn_between(rng, -0.5, 0.5), drawn_between(rng, -3.0, 3.0)};
    for (uint32_t i = 0; i < links; i++) {
        arm.length[i] = drawn_between(rng, 0.2, 1.0);
        arm.radius[i] = drawn_between(rng, 0.02, 0.1);
        arm.mass[i] = drawn_between(rng, 0.5, 5.0);
        arm.min[i] = drawn_between(rng, -4.0, -2.0);
        arm.max[i] = drawn_between(rng, 2.0, 4.0);
        arm.v_max[i] = drawn_between(rng, 0.5, 3.0);
        arm.a_max[i] = drawn_between(rng, 1.0, 10.0);
        arm.j_max[i] = drawn_between(rng, 10.0, 100.0);
        arm.torque_max[i] = drawn_between(rng, 50.0, 200.0);
    }
    return arm;
}

DRAWN_UNUSED void drawn_angles(aisle_rng *rng, uint32_t links, double most, double *out) {
    for (uint32_t i = 0; i < links; i++) {
        out[i] = drawn_between(rng, -most, most);
    }
}

// Outwards the accelerations of joints and centres, inwards the forces; a base that rises with g in place of weight.
DRAWN_UNUSED void drawn_torques(const aisle_arm *arm, double theta, const double *q, const double *qd,
                                const double *qdd, long double *torque) {
    long double ax[3], ay[3], fx[3], fy[3], spin[3], x = 0.0L, y = (long double)arm->gravity;
    long double phi = (long double)theta, w = 0.0L, dw = 0.0L;
    for (uint32_t i = 0; i < arm->links; i++) {
        phi += (long double)q[i];
        w += (long double)qd[i];
        dw += (long double)qdd[i];
        ax[i] = (long double)arm->length[i] * cosl(phi);
        ay[i] = (long double)arm->length[i] * sinl(phi);
        const long double ex = -dw * ay[i] - w * w * ax[i], ey = dw * ax[i] - w * w * ay[i];
        fx[i] = (long double)arm->mass[i] * (x + ex / 2.0L);
        fy[i] = (long double)arm->mass[i] * (y + ey / 2.0L);
        x += ex;
        y += ey;
        spin[i] = dw;
    }
    long double sum_x = 0.0L, sum_y = 0.0L, moment = 0.0L;
    for (uint32_t i = arm->links; i-- > 0U;) {
        const long double l = (long double)arm->length[i], r = (long double)arm->radius[i];
        moment += (long double)arm->mass[i] * (l * l / 12.0L + r * r / 4.0L) * spin[i];
        moment += (ax[i] * fy[i] - ay[i] * fx[i]) / 2.0L + ax[i] * sum_y - ay[i] * sum_x;
        sum_x += fx[i];
        sum_y += fy[i];
        torque[i] = moment;
    }
}

typedef struct drawn_share { // of the joints' limits, the greatest; 1: reached
    double motion, torque;   // of rate, acceleration and jerk
} drawn_share;

// At place r of a piece that is run in so many seconds, by an arm whose vehicle looks along theta.
DRAWN_UNUSED drawn_share drawn_shares(const aisle_arm *arm, double theta, const aisle_arm_piece *piece, double r,
                                      double duration) {
    drawn_share share = {0.0, 0.0};
    double q[3], v[3], a[3], jerk[3];
    long double torque[3];
    aisle_arm_piece_at(piece, r, 0, q);
    aisle_arm_piece_at(piece, r, 1, v);
    aisle_arm_piece_at(piece, r, 2, a);
    aisle_arm_piece_at(piece, r, 3, jerk);
    for (uint32_t j = 0; j < arm->links; j++) {
        v[j] /= duration;
        a[j] /= duration * duration;
        jerk[j] /= duration * duration * duration;
        share.motion = fmax(share.motion, fmax(fabs(v[j]) / arm->v_max[j], fabs(a[j]) / arm->a_max[j]));
        share.motion = fmax(share.motion, fabs(jerk[j]) / arm->j_max[j]);
    }
    drawn_torques(arm, theta, q, v, a, torque);
    for (uint32_t j = 0; j < arm->links; j++) {
        share.torque = fmax(share.torque, fabs((double)torque[j]) / arm->torque_max[j]);
    }
    return share;
}
#endif
