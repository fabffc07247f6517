#include "robot/arm_motion.h"

#include "base/check.h"
#include "base/poly.h"

#include <string.h>

#define JOINT_SLACK 1e-9 // rad
#define GOLDEN 0.6180339887498949
#define GOLDEN_STEPS 28U // down to 1.4e-6 of two panels
#define DIP_DEPTH 2.0    // a dip that is so much above the lowest place is not looked into
#define ROOT_STEPS 200U

void aisle_arm_piece_of(uint32_t links, const double *from, const double *to, const double *bend,
                        aisle_arm_piece *out) {
    AISLE_ASSERT(links <= AISLE_ARM_LINKS);
    memset(out, 0, sizeof *out);
    out->links = links;
    for (uint32_t j = 0; j < links; j++) {
        const double d = to[j] - from[j];
        const double b1 = bend == NULL ? 0.0 : bend[2U * j + 1U];
        const double b0 = bend == NULL ? 0.0 : bend[2U * j] - 0.5 * b1; // of the bend as b0 + b1 r
        double *c = out->c[j];
        c[0] = from[j];
        c[3] = 10.0 * d + b0;
        c[4] = -15.0 * d - 3.0 * b0 + b1;
        c[5] = 6.0 * d + 3.0 * b0 - 3.0 * b1;
        c[6] = -b0 + 3.0 * b1;
        c[7] = -b1;
    }
}

void aisle_arm_bend_of_paper(double a6, double a7, double *bend) {
    bend[1] = -a7;
    bend[0] = -3.0 * a7 - a6 + 0.5 * bend[1];
}

// Coefficients of the derivative of this order of joint j; returns its degree.
static uint32_t derive(const aisle_arm_piece *self, uint32_t j, uint32_t order, double *c) {
    uint32_t degree = AISLE_ARM_DEGREE;
    memcpy(c, self->c[j], sizeof self->c[j]);
    for (uint32_t i = 0; i < order; i++) {
        degree = aisle_poly_derivative(c, degree, c);
    }
    return degree;
}

void aisle_arm_piece_at(const aisle_arm_piece *self, double r, uint32_t order, double *out) {
    static const double falling[4][AISLE_ARM_DEGREE + 1U] = {{1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0},
                                                             {0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0},
                                                             {0.0, 0.0, 2.0, 6.0, 12.0, 20.0, 30.0, 42.0},
                                                             {0.0, 0.0, 0.0, 6.0, 24.0, 60.0, 120.0, 210.0}};
    AISLE_ASSERT(order < 4U);
    const double *factor = falling[order]; // i (i - 1) ... of the derivative
    for (uint32_t j = 0; j < self->links; j++) {
        double value = self->c[j][AISLE_ARM_DEGREE] * factor[AISLE_ARM_DEGREE];
        for (uint32_t i = AISLE_ARM_DEGREE; i > order; i--) {
            value = value * r + self->c[j][i - 1U] * factor[i - 1U];
        }
        out[j] = value;
    }
}

void aisle_arm_piece_peaks(const aisle_arm_piece *self, uint32_t order, double *out) {
    for (uint32_t j = 0; j < self->links; j++) {
        double c[AISLE_ARM_DEGREE + 1U];
        const uint32_t degree = derive(self, j, order, c);
        out[j] = aisle_poly_peak(c, degree);
    }
}

void aisle_arm_piece_bounds(const aisle_arm_piece *self, uint32_t order, double *out) {
    for (uint32_t j = 0; j < self->links; j++) {
        double c[AISLE_ARM_DEGREE + 1U], lo[2], hi[2];
        const uint32_t degree = derive(self, j, order, c);
        aisle_poly_bounds(c, degree, 0.0, 0.5, &lo[0], &hi[0]);
        aisle_poly_bounds(c, degree, 0.5, 1.0, &lo[1], &hi[1]);
        out[j] = aisle_max(aisle_max(-lo[0], hi[0]), aisle_max(-lo[1], hi[1]));
    }
}

// ---- travel

double aisle_arm_piece_travel(const aisle_arm_piece *self) {
    double sum = 0.0;
    for (uint32_t j = 0; j < self->links; j++) {
        double c[AISLE_ARM_DEGREE + 1U];
        const uint32_t degree = derive(self, j, 1U, c);
        for (uint32_t i = 1; i < AISLE_ARM_SIMPSON; i++) { // both ends are 0
            const double weight = i % 2U == 1U ? 4.0 : 2.0;
            sum += weight * fabs(aisle_poly_value(c, degree, (double)i / (double)AISLE_ARM_SIMPSON));
        }
    }
    return sum / (3.0 * (double)AISLE_ARM_SIMPSON);
}

double aisle_arm_piece_travel_exact(const aisle_arm_piece *self) {
    double sum = 0.0;
    for (uint32_t j = 0; j < self->links; j++) {
        double c[AISLE_ARM_DEGREE + 1U], roots[AISLE_POLY_DEGREE_MAX];
        const uint32_t count = aisle_poly_roots(c, derive(self, j, 1U, c), roots);
        double last = aisle_poly_value(self->c[j], AISLE_ARM_DEGREE, 0.0);
        for (uint32_t i = 0; i <= count; i++) {
            const double next = aisle_poly_value(self->c[j], AISLE_ARM_DEGREE, i < count ? roots[i] : 1.0);
            sum += fabs(next - last);
            last = next;
        }
    }
    return sum;
}

uint32_t aisle_arm_piece_joint_out(const aisle_arm_piece *self, const aisle_arm *arm, double *out) {
    uint32_t first = 0;
    double sum = 0.0;
    for (uint32_t j = 0; j < self->links; j++) {
        double lo, hi;
        aisle_poly_bounds(self->c[j], AISLE_ARM_DEGREE, 0.0, 1.0, &lo, &hi);
        if (lo < arm->min[j] || hi > arm->max[j]) { // only then it takes a closer look
            aisle_poly_range(self->c[j], AISLE_ARM_DEGREE, &lo, &hi);
        }
        const double by = aisle_max(0.0, arm->min[j] - lo) + aisle_max(0.0, hi - arm->max[j]);
        if (by > JOINT_SLACK) {
            sum += by;
            first = first == 0U ? j + 1U : first;
        }
    }
    if (out != NULL) {
        *out = sum;
    }
    return first;
}

// ---- time

// Cube root of x >= 0 by Newton's rule from above: it falls on it and stays.
static double cube_root(double x) {
    double root = aisle_max(1.0, x);
    for (uint32_t i = 0; i < ROOT_STEPS; i++) {
        root = (2.0 * root + x / (root * root)) / 3.0; // root > 0: a fall by at most a third each time
    }
    return root;
}

static void take(aisle_arm_timing *out, double duration, aisle_arm_limit limit, uint32_t joint) {
    if (duration > out->duration) {
        *out = (aisle_arm_timing){.duration = duration, .limit = limit, .joint = joint};
    }
}

typedef struct torque_of { // along a piece
    const aisle_arm *arm;
    const aisle_arm_dynamics *dynamics;
    const aisle_arm_piece *piece;
} torque_of;

// The greatest 1/T^2 with which every torque at r is within limits; 0: none (gravity alone is too much).
static double open_at(const torque_of *self, double r, uint32_t *joint) {
    double q[AISLE_ARM_LINKS], rate[AISLE_ARM_LINKS], change[AISLE_ARM_LINKS];
    double inertia[AISLE_ARM_LINKS], gravity[AISLE_ARM_LINKS], least = (double)INFINITY;
    aisle_arm_piece_at(self->piece, r, 0U, q);
    aisle_arm_piece_at(self->piece, r, 1U, rate);
    aisle_arm_piece_at(self->piece, r, 2U, change);
    aisle_arm_torque(self->dynamics, q, rate, change, inertia, gravity);
    for (uint32_t j = 0; j < self->piece->links; j++) {
        const double room = self->arm->torque_max[j] - (inertia[j] > 0.0 ? gravity[j] : -gravity[j]);
        const bool is_held = fabs(gravity[j]) < self->arm->torque_max[j];
        const double most = is_held ? room / aisle_max(fabs(inertia[j]), 1e-300) : 0.0;
        if (most < least) {
            least = most;
            *joint = j;
        }
    }
    return least;
}

// Golden section between lo and hi, which hold one dip.
static double lowest(const torque_of *self, double lo, double hi, uint32_t *joint) {
    uint32_t at_a = 0, at_b = 0;
    double a = hi - GOLDEN * (hi - lo), b = lo + GOLDEN * (hi - lo);
    double open_a = open_at(self, a, &at_a), open_b = open_at(self, b, &at_b);
    for (uint32_t i = 0; i < GOLDEN_STEPS; i++) {
        if (open_a < open_b) {
            hi = b;
            b = a;
            open_b = open_a;
            at_b = at_a;
            a = hi - GOLDEN * (hi - lo);
            open_a = open_at(self, a, &at_a);
        } else {
            lo = a;
            a = b;
            open_a = open_b;
            at_a = at_b;
            b = lo + GOLDEN * (hi - lo);
            open_b = open_at(self, b, &at_b);
        }
    }
    *joint = open_a < open_b ? at_a : at_b;
    return aisle_min(open_a, open_b);
}

static void take_torque(const torque_of *self, uint32_t panels, aisle_arm_timing *out) {
    double open[AISLE_ARM_TIMING_PANELS + 1U], best = (double)INFINITY;
    const double step = 1.0 / (double)panels;
    uint32_t joint = 0, at_best = 0;
    for (uint32_t i = 0; i <= panels; i++) {
        open[i] = open_at(self, (double)i / (double)panels, &joint);
        if (open[i] < best) {
            best = open[i];
            at_best = joint;
        }
    }
    const double deep = DIP_DEPTH * best;
    for (uint32_t i = 0; i <= panels; i++) {
        const bool is_dip = (i == 0U || open[i] <= open[i - 1U]) && (i == panels || open[i] <= open[i + 1U]);
        if (is_dip && open[i] <= deep) {
            const double r = (double)i / (double)panels;
            const double dip = lowest(self, aisle_max(0.0, r - step), aisle_min(1.0, r + step), &joint);
            if (dip < best) {
                best = dip;
                at_best = joint;
            }
        }
    }
    take(out, best > 0.0 ? 1.0 / sqrt(best) : (double)INFINITY, AISLE_ARM_LIMIT_TORQUE, at_best);
}

void aisle_arm_least_duration(const aisle_arm *arm, const aisle_arm_dynamics *dynamics, const aisle_arm_piece *piece,
                              uint32_t panels, aisle_arm_timing *out) {
    double peaks[3][AISLE_ARM_LINKS];
    AISLE_ASSERT(panels >= 2U && panels <= AISLE_ARM_TIMING_PANELS && piece->links == arm->links);
    *out = (aisle_arm_timing){.duration = 0.0, .limit = AISLE_ARM_LIMIT_NONE, .joint = 0};
    for (uint32_t order = 0; order < 3U; order++) {
        aisle_arm_piece_peaks(piece, order + 1U, peaks[order]);
    }
    for (uint32_t j = 0; j < arm->links; j++) {
        take(out, peaks[0][j] / arm->v_max[j], AISLE_ARM_LIMIT_VELOCITY, j);
        take(out, sqrt(peaks[1][j] / arm->a_max[j]), AISLE_ARM_LIMIT_ACCELERATION, j);
        if (peaks[2][j] > 0.0) {
            take(out, cube_root(peaks[2][j] / arm->j_max[j]), AISLE_ARM_LIMIT_JERK, j);
        }
    }
    const torque_of self = {arm, dynamics, piece};
    take_torque(&self, panels, out);
}
