// random_path.h - waypoints to give speeds to: built by hand, or at random of every kind of piece. For tests/robot.
#ifndef AISLE_TESTS_RANDOM_PATH_H
#define AISLE_TESTS_RANDOM_PATH_H

#include "base/angle.h"
#include "base/rng.h"
#include "robot/vehicle.h"
#include "unity.h"

#include <math.h>

enum { CAPACITY = 1024 };

static aisle_vehicle vehicle;
static aisle_waypoint_msg path[CAPACITY + 1]; // one canary behind
static float dwell[CAPACITY];
static uint32_t count;

static inline void set_vehicle(const aisle_vehicle_msg *msg) {
    aisle_refusal why;
    TEST_ASSERT_EQUAL_INT(AISLE_OK, aisle_vehicle_from_msg(msg, &vehicle, &why));
}

// ---- by hand

static inline aisle_waypoint_msg *add(double x, double y, double theta) {
    TEST_ASSERT_LESS_THAN_UINT32(CAPACITY, count);
    aisle_waypoint_msg *w = &path[count];
    w->x = x;
    w->y = y;
    w->theta = theta;
    w->curvature = 0.0F;
    w->clearance = 10.0F;
    w->flags = 0;
    w->goal_id = 0;
    count++;
    return w;
}

// A straight line along x from the last waypoint in pieces of `step`.
static inline void add_line(double length, double step) {
    const double x = path[count - 1].x;
    for (int i = 1; i * step < length + 0.5 * step; i++) {
        (void)add(x + i * step, path[count - 1].y, path[count - 1].theta);
    }
}

static inline void set_flag(aisle_waypoint_msg *w, int flag) {
    w->flags = (int16_t)(w->flags | flag);
}

// ---- at random

typedef struct style { // what a random path is made of
    double piece_max, radius_min;
    bool free_heading; // theta turns by itself along lines, as OMNI may
    bool tight;        // clearances around creep_clearance
} style;

static inline double uniform(aisle_rng *rng, double lo, double hi) {
    return lo + (hi - lo) * (double)aisle_rng_float(rng);
}

// One more piece from the last waypoint in its heading (or against it); dir: of motion.
static inline void add_piece(aisle_rng *rng, const style *how, bool back) {
    const aisle_waypoint_msg from = path[count - 1];
    const double dir = from.theta + (back ? AISLE_PI : 0.0);
    const double length = aisle_rng_below(rng, 8) == 0 ? uniform(rng, 1e-6, 1e-3) : uniform(rng, 1e-3, how->piece_max);
    aisle_waypoint_msg *w;
    if (aisle_rng_below(rng, 2) == 0) {
        const double spin = how->free_heading ? uniform(rng, -3.0, 3.0) * fmin(length, 1.0) : 0.0;
        w = add(from.x + length * cos(dir), from.y + length * sin(dir), aisle_angle_wrap(from.theta + spin));
    } else {
        const double radius = uniform(rng, how->radius_min, 8.0), side = aisle_rng_below(rng, 2) == 0 ? 1.0 : -1.0;
        const double bend = side * fmin(length / radius, 3.1), chord = 2.0 * radius * sin(0.5 * fabs(bend));
        w = add(from.x + chord * cos(dir + 0.5 * bend), from.y + chord * sin(dir + 0.5 * bend),
                aisle_angle_wrap(from.theta + bend));
        w->curvature = (float)(side / radius);
    }
    w->flags = back ? AISLE_WAYPOINT_REVERSE : 0;
    w->clearance = how->tight ? (float)uniform(rng, 0.0, 1.0) : 3.0F;
}

static inline void add_turn(aisle_rng *rng) {
    aisle_waypoint_msg *from = &path[count - 1];
    set_flag(from, AISLE_WAYPOINT_TURN_IN_PLACE | (aisle_rng_below(rng, 2) == 0 ? AISLE_WAYPOINT_STOP : 0));
    const double b = aisle_rng_below(rng, 6) == 0 ? 0.0 : uniform(rng, -3.1, 3.1);
    (void)add(from->x, from->y, aisle_angle_wrap(from->theta + b));
}

static inline void random_path(uint64_t seed, uint32_t n) {
    aisle_rng rng = aisle_rng_seed(seed);
    const style how = {.piece_max = seed % 4 == 0 ? 3.0 : 0.3,
                       .radius_min = 0.3,
                       .free_heading = seed % 5 == 0,
                       .tight = seed % 3 == 0};
    count = 0;
    bool back = false;
    (void)add(uniform(&rng, -50.0, 50.0), uniform(&rng, -50.0, 50.0), uniform(&rng, -3.0, 3.0));
    while (count < n) {
        const uint32_t what = aisle_rng_below(&rng, 40);
        back = what == 0 ? !back : back;
        if (what == 1) {
            add_turn(&rng);
        } else {
            add_piece(&rng, &how, back);
        }
        if (what == 2) {
            set_flag(&path[count - 1], AISLE_WAYPOINT_STOP);
            dwell[count - 1] = (float)uniform(&rng, 0.0, 20.0);
        }
    }
}

static inline void random_vehicle(uint64_t seed) {
    aisle_rng rng = aisle_rng_seed(seed ^ 0x5eedU);
    const aisle_vehicle_msg msg = {.v_max = (float)uniform(&rng, 0.5, 3.0),
                                   .v_reverse_max = (float)uniform(&rng, 0.1, 1.0),
                                   .a_max = (float)uniform(&rng, 0.2, 2.0),
                                   .d_max = (float)uniform(&rng, 0.2, 2.0),
                                   .omega_max = (float)uniform(&rng, 0.3, 2.0),
                                   .alpha_max = (float)uniform(&rng, 0.3, 3.0),
                                   .lateral_a_max = (float)uniform(&rng, 0.1, 2.0)};
    set_vehicle(&msg);
}
#endif
