#include "robot/curve.h"

#include "base/angle.h"
#include "base/rng.h"
#include "unity.h"

#include <math.h>
#include <string.h>

enum { CAPACITY = 64, SEEDS = 300 };

static aisle_waypoint_msg w[CAPACITY + 1];
static aisle_curve curve;

void setUp(void) {
    memset(w, 0, sizeof w);
    w[CAPACITY].goal_id = 4242; // canary
    curve = (aisle_curve){.w = w, .capacity = CAPACITY};
}

void tearDown(void) {
    TEST_ASSERT_EQUAL_INT32(4242, w[CAPACITY].goal_id);
}

static double uniform(aisle_rng *rng, double lo, double hi) {
    return lo + (hi - lo) * (double)aisle_rng_float(rng);
}

// Drawn in one order with every compiler.
static aisle_vec2 random_point(aisle_rng *rng, double x0, double x1, double y0, double y1) {
    double x = uniform(rng, x0, x1);
    double y = uniform(rng, y0, y1);
    return aisle_vec2_of(x, y);
}

// ---- an independent reading of a piece: direction of motion at its ends, by centre and radius in long double

typedef struct ends {
    long double first, last; // rad
    long double length;
} ends;

static ends directions(const aisle_waypoint_msg *a, const aisle_waypoint_msg *b) {
    long double dx = (long double)b->x - (long double)a->x;
    long double dy = (long double)b->y - (long double)a->y;
    long double chord = hypotl(dx, dy);
    long double course = atan2l(dy, dx);
    long double k = (long double)b->curvature;
    if (fabsl(k) <= 0.0L) {
        return (ends){course, course, chord};
    }
    long double half = asinl(k * chord / 2.0L);
    return (ends){course - half, course + half, 2.0L * half / k};
}

static void assert_same_angle(double tolerance, long double expected, long double actual) {
    long double off = remainderl(expected - actual, 2.0L * acosl(-1.0L));
    TEST_ASSERT_DOUBLE_WITHIN(tolerance, 0.0, (double)off);
}

// Heading is along the motion at both ends of every piece that moves.
static void assert_heading_follows_motion(double tolerance) {
    for (uint32_t i = 1; i < curve.n; i++) {
        if ((w[i - 1].flags & AISLE_WAYPOINT_TURN_IN_PLACE) != 0) {
            TEST_ASSERT_DOUBLE_WITHIN(0.0, w[i - 1].x, w[i].x);
            TEST_ASSERT_DOUBLE_WITHIN(0.0, w[i - 1].y, w[i].y);
            continue;
        }
        ends motion = directions(&w[i - 1], &w[i]);
        TEST_ASSERT_TRUE(motion.length > 0.0L);
        assert_same_angle(tolerance, motion.first, (long double)w[i - 1].theta);
        assert_same_angle(tolerance, motion.last, (long double)w[i].theta);
    }
}

// ---- begin, turns, lines, goals

static void test_begin_wraps_the_heading_and_clears_overflow(void) {
    curve.overflow = true;
    aisle_curve_begin(&curve, (aisle_pose2){1.0, 2.0, 3.0 * AISLE_PI});
    TEST_ASSERT_EQUAL_UINT32(1, curve.n);
    TEST_ASSERT_FALSE(curve.overflow);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, AISLE_PI, fabs(w[0].theta));
}

static void test_turn_below_tolerance_is_left_out_and_above_it_is_a_marked_stop(void) {
    aisle_curve_begin(&curve, (aisle_pose2){0.0, 0.0, 0.5});
    aisle_curve_turn_to(&curve, 0.5 + 0.9 * AISLE_CURVE_HEADING_TOLERANCE);
    TEST_ASSERT_EQUAL_UINT32(1, curve.n);
    TEST_ASSERT_EQUAL_INT16(0, w[0].flags);
    aisle_curve_turn_to(&curve, -0.5);
    TEST_ASSERT_EQUAL_UINT32(2, curve.n);
    TEST_ASSERT_EQUAL_INT16(AISLE_WAYPOINT_STOP | AISLE_WAYPOINT_TURN_IN_PLACE, w[0].flags);
    TEST_ASSERT_DOUBLE_WITHIN(1e-15, -0.5, w[1].theta);
}

static void test_a_line_shorter_than_a_micrometre_is_left_out(void) {
    aisle_curve_begin(&curve, (aisle_pose2){0.0, 0.0, 0.0});
    aisle_curve_line_to(&curve, aisle_vec2_of(5e-7, 0.0));
    TEST_ASSERT_EQUAL_UINT32(1, curve.n);
    aisle_curve_line_to(&curve, aisle_vec2_of(2e-6, 0.0));
    TEST_ASSERT_EQUAL_UINT32(2, curve.n);
}

static void test_two_goals_in_one_place_are_joined_by_a_turn_by_nothing(void) {
    aisle_curve_begin(&curve, (aisle_pose2){3.0, 4.0, 1.0});
    aisle_curve_goal(&curve, 11);
    aisle_curve_goal(&curve, 12);
    TEST_ASSERT_EQUAL_UINT32(2, curve.n);
    TEST_ASSERT_EQUAL_INT32(11, w[0].goal_id);
    TEST_ASSERT_EQUAL_INT32(12, w[1].goal_id);
    TEST_ASSERT_TRUE((w[0].flags & AISLE_WAYPOINT_TURN_IN_PLACE) != 0);
    TEST_ASSERT_EQUAL_INT16(AISLE_WAYPOINT_GOAL | AISLE_WAYPOINT_STOP, w[1].flags);
}

// ---- polylines

static const aisle_corner_rule wide = {.max_radius = 1.0, .sure_radius = 0.5, .min_radius = 0.05};

static void test_a_right_angle_becomes_line_arc_line_with_the_first_radius(void) {
    const aisle_vec2 points[] = {{0.0, 0.0}, {10.0, 0.0}, {10.0, 10.0}};
    aisle_curve_begin(&curve, (aisle_pose2){0.0, 0.0, 0.0});
    aisle_curve_polyline(&curve, points, 3, &wide);
    TEST_ASSERT_EQUAL_UINT32(4, curve.n);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 9.0, w[1].x);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 1.0, w[2].y);
    TEST_ASSERT_FLOAT_WITHIN(1e-6F, 1.0F, w[2].curvature);
    assert_heading_follows_motion(1e-6);
}

static bool only_below(void *ctx, const aisle_waypoint_msg *from, const aisle_waypoint_msg *to) {
    (void)from;
    return (double)to->curvature >= *(const double *)ctx;
}

static void test_the_first_free_radius_of_max_sure_and_halves_is_taken(void) {
    const aisle_vec2 points[] = {{0.0, 0.0}, {10.0, 0.0}, {10.0, 10.0}};
    const double least[] = {0.5, 1.5, 3.0, 7.0, 15.0};
    const double taken[] = {1.0, 0.5, 0.25, 0.125, 0.0625};
    for (int i = 0; i < 5; i++) {
        aisle_corner_rule rule = wide;
        rule.arc_free = only_below;
        rule.ctx = (void *)(uintptr_t)&least[i];
        aisle_curve_begin(&curve, (aisle_pose2){0.0, 0.0, 0.0});
        aisle_curve_polyline(&curve, points, 3, &rule);
        TEST_ASSERT_EQUAL_UINT32(4, curve.n);
        TEST_ASSERT_FLOAT_WITHIN(1e-4F, (float)(1.0 / taken[i]), w[2].curvature);
    }
}

static void test_no_free_radius_makes_a_stop_and_turn(void) {
    const aisle_vec2 points[] = {{0.0, 0.0}, {10.0, 0.0}, {10.0, 10.0}};
    double never = 1e9;
    aisle_corner_rule rule = wide;
    rule.arc_free = only_below;
    rule.ctx = &never;
    aisle_curve_begin(&curve, (aisle_pose2){0.0, 0.0, 0.0});
    aisle_curve_polyline(&curve, points, 3, &rule);
    TEST_ASSERT_EQUAL_UINT32(4, curve.n);
    TEST_ASSERT_EQUAL_INT16(AISLE_WAYPOINT_STOP | AISLE_WAYPOINT_TURN_IN_PLACE, w[1].flags);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 10.0, w[1].x);
    assert_heading_follows_motion(1e-6);
}

static void test_an_arc_takes_no_more_than_half_a_leg_and_no_more_than_the_zone(void) {
    const aisle_vec2 points[] = {{0.0, 0.0}, {1.0, 0.0}, {1.0, 10.0}};
    aisle_corner_rule rule = {.max_radius = 5.0, .sure_radius = 5.0, .min_radius = 0.05};
    aisle_curve_begin(&curve, (aisle_pose2){0.0, 0.0, 0.0});
    aisle_curve_polyline(&curve, points, 3, &rule);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 0.5, w[1].x);
    rule.zone = 0.2;
    aisle_curve_begin(&curve, (aisle_pose2){0.0, 0.0, 0.0});
    aisle_curve_polyline(&curve, points, 3, &rule);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 0.8, w[1].x);
}

static void test_a_reversal_stops_and_turns_right_round(void) {
    const aisle_vec2 points[] = {{0.0, 0.0}, {5.0, 0.0}, {1.0, 0.0}};
    aisle_curve_begin(&curve, (aisle_pose2){0.0, 0.0, 0.0});
    aisle_curve_polyline(&curve, points, 3, &wide);
    TEST_ASSERT_EQUAL_UINT32(4, curve.n);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, AISLE_PI, fabs(w[2].theta));
    assert_heading_follows_motion(1e-6);
}

// Random polylines: heading along the motion, ends met, arcs no nearer to a disc in the corner than the legs are.
static void test_random_polylines_keep_their_heading_for_every_seed(void) {
    for (uint64_t seed = 0; seed < SEEDS; seed++) {
        aisle_rng rng = aisle_rng_seed(seed);
        aisle_vec2 points[12];
        uint32_t n = 2U + aisle_rng_below(&rng, 11U);
        for (uint32_t i = 0; i < n; i++) {
            points[i] = random_point(&rng, -20.0, 20.0, -20.0, 20.0);
        }
        aisle_curve_begin(&curve, (aisle_pose2){points[0].x, points[0].y, uniform(&rng, -3.0, 3.0)});
        aisle_curve_polyline(&curve, points, n, &wide);
        TEST_ASSERT_FALSE(curve.overflow);
        TEST_ASSERT_DOUBLE_WITHIN(1e-12, points[n - 1].x, w[curve.n - 1].x);
        TEST_ASSERT_DOUBLE_WITHIN(1e-12, points[n - 1].y, w[curve.n - 1].y);
        assert_heading_follows_motion(2e-5);
    }
}

static double distance_to_segment(aisle_vec2 p, aisle_vec2 a, aisle_vec2 b) {
    aisle_vec2 ab = aisle_vec2_sub(b, a);
    double t = aisle_clamp(aisle_vec2_dot(aisle_vec2_sub(p, a), ab) / aisle_vec2_dot(ab, ab), 0.0, 1.0);
    return aisle_vec2_distance(p, aisle_vec2_lerp(a, b, t));
}

static void test_an_arc_no_wider_than_the_legs_distance_keeps_that_distance_for_every_seed(void) {
    for (uint64_t seed = 0; seed < SEEDS; seed++) {
        aisle_rng rng = aisle_rng_seed(seed);
        double keep = uniform(&rng, 0.1, 1.0);
        aisle_vec2 points[3] = {{0.0, 0.0}, {6.0, 0.0}, random_point(&rng, 1.0, 11.0, 2.0, 6.0)};
        aisle_corner_rule rule = {.max_radius = keep, .sure_radius = keep, .min_radius = 0.01};
        aisle_curve_begin(&curve, (aisle_pose2){0.0, 0.0, 0.0});
        aisle_curve_polyline(&curve, points, 3, &rule);
        for (int k = 0; k < 200; k++) { // obstacles that both legs keep away from
            aisle_vec2 p = random_point(&rng, -1.0, 8.0, -1.0, 7.0);
            if (distance_to_segment(p, points[0], points[1]) < keep ||
                distance_to_segment(p, points[1], points[2]) < keep) {
                continue;
            }
            for (uint32_t i = 1; i < curve.n; i++) {
                for (int f = 0; f <= 20; f++) {
                    aisle_pose2 at = aisle_piece_at(&w[i - 1], &w[i], f / 20.0);
                    TEST_ASSERT_TRUE(aisle_vec2_distance(p, aisle_vec2_of(at.x, at.y)) >= keep - 1e-6);
                }
            }
        }
    }
}

// ---- biarcs

static void test_biarcs_pass_through_their_ends_with_the_given_tangents_for_every_seed(void) {
    for (uint64_t seed = 0; seed < SEEDS; seed++) {
        aisle_rng rng = aisle_rng_seed(seed);
        double theta0 = uniform(&rng, -3.0, 3.0);
        double bend = uniform(&rng, -1.2, 1.2);
        double course = theta0 + 0.5 * bend + uniform(&rng, -0.3, 0.3);
        double away = uniform(&rng, 0.05, 2.0);
        aisle_vec2 p = {3.0 + away * cos(course), -2.0 + away * sin(course)};
        aisle_vec2 tangent = {cos(theta0 + bend), sin(theta0 + bend)};
        aisle_curve_begin(&curve, (aisle_pose2){3.0, -2.0, theta0});
        aisle_curve_biarc_to(&curve, p, tangent);
        TEST_ASSERT_TRUE(curve.n >= 2 && curve.n <= 3);
        TEST_ASSERT_DOUBLE_WITHIN(1e-12, p.x, w[curve.n - 1].x);
        TEST_ASSERT_DOUBLE_WITHIN(1e-12, p.y, w[curve.n - 1].y);
        assert_same_angle(3e-5, (long double)(theta0 + bend), (long double)w[curve.n - 1].theta);
        assert_heading_follows_motion(3e-5);
    }
}

static void test_a_biarc_on_a_circle_is_that_circle(void) {
    double angle = 0.8;
    double radius = 2.5;
    aisle_curve_begin(&curve, (aisle_pose2){radius, 0.0, AISLE_PI / 2.0});
    aisle_curve_biarc_to(&curve, aisle_vec2_of(radius * cos(angle), radius * sin(angle)),
                         aisle_vec2_of(-sin(angle), cos(angle)));
    for (uint32_t i = 1; i < curve.n; i++) {
        TEST_ASSERT_FLOAT_WITHIN(1e-5F, (float)(1.0 / radius), w[i].curvature);
    }
}

static void test_a_straight_biarc_is_straight(void) {
    aisle_curve_begin(&curve, (aisle_pose2){0.0, 0.0, 0.0});
    aisle_curve_biarc_to(&curve, aisle_vec2_of(4.0, 0.0), aisle_vec2_of(1.0, 0.0));
    for (uint32_t i = 1; i < curve.n; i++) {
        TEST_ASSERT_FLOAT_WITHIN(0.0F, 0.0F, w[i].curvature);
    }
}

// ---- points of pieces, capacity

static void test_points_of_a_piece_lie_on_its_arc_at_their_fraction_for_every_seed(void) {
    for (uint64_t seed = 0; seed < SEEDS; seed++) {
        aisle_rng rng = aisle_rng_seed(seed);
        long double radius = (long double)uniform(&rng, 0.3, 30.0);
        long double start = (long double)uniform(&rng, -3.0, 3.0);
        long double sweep = (long double)uniform(&rng, -3.0, 3.0); // within the half circle
        float k = (float)(sweep > 0.0L ? 1.0L / radius : -1.0L / radius);
        long double r = 1.0L / fabsl((long double)k);
        aisle_waypoint_msg a = {.x = (double)(r * cosl(start)), .y = (double)(r * sinl(start)), .theta = 0.3};
        aisle_waypoint_msg b = {.x = (double)(r * cosl(start + sweep)),
                                .y = (double)(r * sinl(start + sweep)),
                                .theta = -0.4,
                                .curvature = k};
        for (int f = 0; f <= 10; f++) {
            aisle_pose2 at = aisle_piece_at(&a, &b, f / 10.0);
            long double angle = start + sweep * (long double)f / 10.0L;
            TEST_ASSERT_DOUBLE_WITHIN(1e-5, (double)(r * cosl(angle)), at.x);
            TEST_ASSERT_DOUBLE_WITHIN(1e-5, (double)(r * sinl(angle)), at.y);
            TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0.3 - 0.07 * f, at.theta);
        }
    }
}

static void test_ready_pieces_are_taken_as_they_are_after_a_turn_to_their_heading(void) {
    const aisle_waypoint_msg ready[3] = {
        {.x = 1.0, .y = 2.0, .theta = 1.0, .flags = AISLE_WAYPOINT_STOP | AISLE_WAYPOINT_TURN_IN_PLACE},
        {.x = 1.0, .y = 2.0, .theta = 1.5},
        {.x = 1.0, .y = 1.0, .theta = 1.5, .curvature = 0.25F, .flags = AISLE_WAYPOINT_REVERSE}};
    aisle_curve_begin(&curve, (aisle_pose2){1.0, 2.0, 0.5});
    aisle_curve_pieces(&curve, ready, 3);
    TEST_ASSERT_EQUAL_UINT32(4U, curve.n);
    TEST_ASSERT_TRUE((w[0].flags & AISLE_WAYPOINT_TURN_IN_PLACE) != 0);
    TEST_ASSERT_EQUAL_INT16(ready[0].flags, w[1].flags);
    TEST_ASSERT_DOUBLE_WITHIN(0.0, 1.0, w[1].theta);
    TEST_ASSERT_EQUAL_MEMORY(&ready[1], &w[2], 2U * sizeof w[0]);
    curve.capacity = 5;
    aisle_curve_pieces(&curve, (const aisle_waypoint_msg[3]){ready[2], ready[1], ready[2]}, 3);
    TEST_ASSERT_TRUE(curve.overflow && curve.n == 5U);
    curve.capacity = CAPACITY;
}

static void test_a_full_array_is_told_and_not_overrun(void) {
    aisle_vec2 points[80];
    for (int i = 0; i < 80; i++) {
        points[i] = aisle_vec2_of((double)i, i % 2 == 0 ? 0.0 : 3.0);
    }
    aisle_curve_begin(&curve, (aisle_pose2){0.0, 0.0, 0.0});
    aisle_curve_polyline(&curve, points, 80, &wide);
    TEST_ASSERT_TRUE(curve.overflow);
    TEST_ASSERT_EQUAL_UINT32(CAPACITY, curve.n);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_begin_wraps_the_heading_and_clears_overflow);
    RUN_TEST(test_turn_below_tolerance_is_left_out_and_above_it_is_a_marked_stop);
    RUN_TEST(test_a_line_shorter_than_a_micrometre_is_left_out);
    RUN_TEST(test_two_goals_in_one_place_are_joined_by_a_turn_by_nothing);
    RUN_TEST(test_a_right_angle_becomes_line_arc_line_with_the_first_radius);
    RUN_TEST(test_the_first_free_radius_of_max_sure_and_halves_is_taken);
    RUN_TEST(test_no_free_radius_makes_a_stop_and_turn);
    RUN_TEST(test_an_arc_takes_no_more_than_half_a_leg_and_no_more_than_the_zone);
    RUN_TEST(test_a_reversal_stops_and_turns_right_round);
    RUN_TEST(test_random_polylines_keep_their_heading_for_every_seed);
    RUN_TEST(test_an_arc_no_wider_than_the_legs_distance_keeps_that_distance_for_every_seed);
    RUN_TEST(test_biarcs_pass_through_their_ends_with_the_given_tangents_for_every_seed);
    RUN_TEST(test_a_biarc_on_a_circle_is_that_circle);
    RUN_TEST(test_a_straight_biarc_is_straight);
    RUN_TEST(test_points_of_a_piece_lie_on_its_arc_at_their_fraction_for_every_seed);
    RUN_TEST(test_ready_pieces_are_taken_as_they_are_after_a_turn_to_their_heading);
    RUN_TEST(test_a_full_array_is_told_and_not_overrun);
    return UNITY_END();
}
