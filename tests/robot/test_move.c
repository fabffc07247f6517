#include "robot/move.h"

#include "base/angle.h"
#include "base/rng.h"
#include "unity.h"

#include <math.h>

enum { SEEDS = 120 };

void setUp(void) {}
void tearDown(void) {}

static double uniform(aisle_rng *rng, double lo, double hi) {
    return lo + (hi - lo) * (double)aisle_rng_float(rng);
}

// Independent: the heading's integral, step by step, in long double.
static void integrate(aisle_pose2 from, aisle_move move, long double out[3]) {
    enum { STEPS = 20000 };
    long double x = (long double)from.x, y = (long double)from.y;
    long double step = (long double)move.length / STEPS;
    for (int i = 0; i < STEPS; i++) {
        long double theta = (long double)from.theta + (long double)move.turn * ((long double)i + 0.5L) / STEPS;
        x += step * cosl(theta);
        y += step * sinl(theta);
    }
    out[0] = x;
    out[1] = y;
    out[2] = (long double)from.theta + (long double)move.turn;
}

static aisle_move random_move(aisle_rng *rng, uint64_t s) {
    double length = uniform(rng, -4.0, 4.0);
    double turn = uniform(rng, -3.0, 3.0);
    switch (s % 4U) {
    case 0:
        return (aisle_move){length, 0.0};
    case 1:
        return (aisle_move){0.0, turn};
    default:
        return (aisle_move){length, turn};
    }
}

static aisle_pose2 random_pose(aisle_rng *rng) {
    aisle_pose2 p;
    p.x = uniform(rng, -50.0, 50.0);
    p.y = uniform(rng, -50.0, 50.0);
    p.theta = uniform(rng, -3.1, 3.1);
    return p;
}

static void test_a_move_ends_where_its_heading_s_integral_does(void) {
    for (uint64_t s = 0; s < SEEDS; s++) {
        aisle_rng rng = aisle_rng_seed(s);
        aisle_pose2 from = random_pose(&rng);
        aisle_move move = random_move(&rng, s);
        aisle_pose2 to = aisle_move_end(from, move);
        long double expected[3];
        integrate(from, move, expected);
        TEST_ASSERT_DOUBLE_WITHIN(1e-7, (double)expected[0], to.x);
        TEST_ASSERT_DOUBLE_WITHIN(1e-7, (double)expected[1], to.y);
        TEST_ASSERT_DOUBLE_WITHIN(1e-12, (double)expected[2], to.theta);
    }
}

static void test_parts_lie_on_the_move(void) {
    aisle_pose2 from = {1.0, 2.0, 0.5};
    aisle_move move = {3.0, -1.8};
    aisle_pose2 middle = aisle_move_end(from, aisle_move_part(move, 0.4));
    aisle_pose2 end = aisle_move_end(middle, aisle_move_part(move, 0.6));
    aisle_pose2 whole = aisle_move_end(from, move);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, whole.x, end.x);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, whole.y, end.y);
}

static void test_laid_pieces_are_the_move_s_and_turn_by_a_third_at_most(void) {
    for (uint64_t s = 0; s < SEEDS; s++) {
        aisle_rng rng = aisle_rng_seed(s);
        aisle_pose2 from = random_pose(&rng);
        aisle_move move = random_move(&rng, s);
        aisle_waypoint_msg w[AISLE_MOVE_WAYPOINTS + 1U] = {{.x = from.x, .y = from.y, .theta = from.theta}};
        uint32_t n = aisle_move_lay(move, w);
        TEST_ASSERT_TRUE(n >= 1U && n <= AISLE_MOVE_WAYPOINTS);
        long double expected[3];
        integrate(from, move, expected);
        TEST_ASSERT_DOUBLE_WITHIN(1e-7, (double)expected[0], w[n].x);
        TEST_ASSERT_DOUBLE_WITHIN(1e-7, (double)expected[1], w[n].y);
        for (uint32_t i = 1; i <= n; i++) {
            TEST_ASSERT_TRUE(fabs(aisle_angle_difference(w[i - 1U].theta, w[i].theta)) <= 2.0944);
            TEST_ASSERT_EQUAL(move.length < 0.0, (w[i].flags & AISLE_WAYPOINT_REVERSE) != 0);
            TEST_ASSERT_EQUAL(s % 4U == 1U, (w[i - 1U].flags & AISLE_WAYPOINT_TURN_IN_PLACE) != 0);
            double bend = s % 4U < 2U ? 0.0 : move.turn / fabs(move.length);
            TEST_ASSERT_DOUBLE_WITHIN(1e-5 * fabs(bend), bend, (double)w[i].curvature);
        }
    }
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_a_move_ends_where_its_heading_s_integral_does);
    RUN_TEST(test_parts_lie_on_the_move);
    RUN_TEST(test_laid_pieces_are_the_move_s_and_turn_by_a_third_at_most);
    return UNITY_END();
}
