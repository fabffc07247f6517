// arm_hall.h - test fixture: a vehicle with an arm in a hall of boxes, and a judge of gaps of its own.
#ifndef AISLE_TESTS_ARM_HALL_H
#define AISLE_TESTS_ARM_HALL_H

#include "arm_usual.h"
#include "hall.h"
#include "plan/arm_free.h"

static aisle_vehicle_msg arm_msg;
static aisle_vehicle arm_vehicle;
static aisle_arm arm;
static aisle_arm_world world;
static const aisle_pose2 arm_pose = {5.0, 5.0, 0.0};

// The usual arm; its vehicle at (5, 5) looking along x in an empty hall of 10 x 10 m.
HALL_UNUSED void arm_hall_begin(void) {
    arm_usual(&arm_msg);
    hall_begin(10.0, 10.0);
}

// Puts hall and arm in force; what is left of the arena is the caller's.
HALL_UNUSED aisle_arena arm_hall_open(uint32_t blocks) {
    aisle_arena arena = hall_arena(HALL_BLOCK);
    aisle_refusal why;
    hall_open(&arena, 0.0F);
    aisle_arm_world_carve(&world, &arena, blocks);
    TEST_ASSERT_FALSE(arena.overflow);
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_vehicle_from_msg(&arm_msg, &arm_vehicle, &why));
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_arm_from_msg(&arm_msg, &arm, &why));
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_arm_world_begin(&world, &hall_layout, &arm_vehicle, &arm, arm_pose));
    return arena;
}

// ---- the judge: ends and corners to edges and axes, in long double

typedef struct arm_axis {
    long double x[2], y[2];
} arm_axis;

static long double arm_point_axis(long double x, long double y, const arm_axis *s) {
    const long double dx = s->x[1] - s->x[0], dy = s->y[1] - s->y[0], sq = dx * dx + dy * dy;
    const long double t = sq > 0.0L ? ((x - s->x[0]) * dx + (y - s->y[0]) * dy) / sq : 0.0L;
    const long double at = fminl(1.0L, fmaxl(0.0L, t));
    return hypotl(x - s->x[0] - at * dx, y - s->y[0] - at * dy);
}

static long double arm_side(const arm_axis *s, long double x, long double y) {
    return (s->x[1] - s->x[0]) * (y - s->y[0]) - (s->y[1] - s->y[0]) * (x - s->x[0]);
}

static long double arm_axes_gap(const arm_axis *a, const arm_axis *b) {
    if (arm_side(a, b->x[0], b->y[0]) * arm_side(a, b->x[1], b->y[1]) < 0.0L &&
        arm_side(b, a->x[0], a->y[0]) * arm_side(b, a->x[1], a->y[1]) < 0.0L) {
        return 0.0L;
    }
    return fminl(fminl(arm_point_axis(a->x[0], a->y[0], b), arm_point_axis(a->x[1], a->y[1], b)),
                 fminl(arm_point_axis(b->x[0], b->y[0], a), arm_point_axis(b->x[1], b->y[1], a)));
}

static long double arm_axis_box(const arm_axis *a, const hall_box *box) {
    const long double x[2] = {(long double)box->x0, (long double)box->x1},
                      y[2] = {(long double)box->y0, (long double)box->y1};
    if (a->x[0] > x[0] && a->x[0] < x[1] && a->y[0] > y[0] && a->y[0] < y[1]) {
        return 0.0L;
    }
    long double least = 1e9L;
    for (int k = 0; k < 2; k++) {
        const arm_axis upright = {{x[k], x[k]}, {y[0], y[1]}}, level = {{x[0], x[1]}, {y[k], y[k]}};
        least = fminl(least, fminl(arm_axes_gap(a, &upright), arm_axes_gap(a, &level)));
    }
    return least;
}

// Least gap of three links to boxes, body and first link, 0 in contact. Walls are far.
HALL_UNUSED double arm_judged(const double *q) {
    static const hall_box body = {4.5, 4.65, 5.5, 5.35};
    long double x = 5.5L, y = 5.0L, phi = 0.0L, least = 1.0L;
    arm_axis link[3];
    for (uint32_t i = 0; i < 3U; i++) {
        const long double length = (long double)arm.length[i], r = (long double)arm.radius[i];
        phi += (long double)q[i];
        const long double c = cosl(phi), s = sinl(phi), from = i == 0U ? (long double)world.exempt : 0.0L;
        link[i] = (arm_axis){{x, x + length * c}, {y, y + length * s}};
        for (int b = 0; b < hall_count; b++) {
            least = fminl(least, arm_axis_box(&link[i], &hall_boxes[b]) - r);
        }
        const arm_axis own = {{x + from * c, x + length * c}, {y + from * s, y + length * s}};
        least = fminl(least, arm_axis_box(&own, &body) - r);
        x += length * c;
        y += length * s;
    }
    least = fminl(least, arm_axes_gap(&link[0], &link[2]) - (long double)arm.radius[0] - (long double)arm.radius[2]);
    return (double)fmaxl(least, 0.0L);
}

HALL_UNUSED void arm_draw(aisle_rng *rng, double *q) {
    for (uint32_t j = 0; j < 3U; j++) {
        q[j] = arm.min[j] + (arm.max[j] - arm.min[j]) * (double)aisle_rng_float(rng);
    }
}
#endif
