#include "robot/steer.h"

#include "base/rng.h"
#include "unity.h"

#include <math.h>

enum { SEEDS = 3000 };

static aisle_steer_way ways[AISLE_STEER_WAYS];
static const aisle_steer_rule on_spot = {
    .radius_min = 0.0, .reverse = 2.0, .cusp = 1.0, .turn_start = 0.3, .turn_rate = 0.25};
static const aisle_steer_rule car = {
    .radius_min = 1.5, .reverse = 2.0, .cusp = 1.0, .turn_start = 0.3, .turn_rate = 0.25};

void setUp(void) {}
void tearDown(void) {}

static double uniform(aisle_rng *rng, double lo, double hi) {
    return lo + (hi - lo) * (double)aisle_rng_float(rng);
}

static aisle_pose2 random_pose(aisle_rng *rng) {
    aisle_pose2 p;
    p.x = uniform(rng, -6.0, 6.0);
    p.y = uniform(rng, -6.0, 6.0);
    p.theta = uniform(rng, -3.1, 3.1);
    return p;
}

static long double cost_of(const aisle_steer_way *way) {
    long double cost = 0.0L;
    int before = 0;
    for (uint32_t i = 0; i < way->count; i++) {
        long double length = (long double)way->move[i].length, turn = (long double)way->move[i].turn;
        int now = (length > 0.0L) - (length < 0.0L);
        cost += now == 0 ? 0.3L + 0.25L * fabsl(turn) : (now > 0 ? length : -2.0L * length);
        cost += now * before < 0 ? 1.0L : 0.0L;
        before = now != 0 ? now : before;
    }
    return cost;
}

// The way leads there, in long double, with moves the vehicle can make.
static void judge(const aisle_steer_way *way, aisle_pose2 from, aisle_pose2 to, double radius_min) {
    long double x = (long double)from.x, y = (long double)from.y, theta = (long double)from.theta;
    for (uint32_t i = 0; i < way->count; i++) {
        long double length = (long double)way->move[i].length, turn = (long double)way->move[i].turn;
        long double half = turn / 2.0L;
        long double chord = fabsl(half) > 0.0L ? length * sinl(half) / half : length;
        x += chord * cosl(theta + half);
        y += chord * sinl(theta + half);
        theta += turn;
        TEST_ASSERT_TRUE((double)fabsl(length) >= radius_min * (double)fabsl(turn) * (1.0 - 1e-9));
    }
    TEST_ASSERT_DOUBLE_WITHIN(1e-8, to.x, (double)x);
    TEST_ASSERT_DOUBLE_WITHIN(1e-8, to.y, (double)y);
    TEST_ASSERT_DOUBLE_WITHIN(1e-8, 0.0, (double)remainderl((long double)to.theta - theta, 2.0L * acosl(-1.0L)));
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, (double)cost_of(way), way->cost);
}

static void judge_all(const aisle_steer_rule *rule) {
    for (uint64_t s = 0; s < SEEDS; s++) {
        aisle_rng rng = aisle_rng_seed(s);
        aisle_pose2 from = random_pose(&rng), to = random_pose(&rng);
        uint32_t count = aisle_steer(rule, from, to, ways);
        TEST_ASSERT_TRUE(count >= 2U && count <= AISLE_STEER_WAYS);
        for (uint32_t i = 0; i < count; i++) {
            judge(&ways[i], from, to, rule->radius_min);
            TEST_ASSERT_TRUE(i == 0U || ways[i].cost >= ways[i - 1U].cost);
        }
    }
}

static void test_ways_of_a_vehicle_that_turns_on_the_spot_lead_there_cheapest_first(void) {
    judge_all(&on_spot);
}

static void test_a_car_s_ways_lead_there_within_its_radius(void) {
    judge_all(&car);
}

static void test_in_line_it_is_one_straight_move(void) {
    const aisle_pose2 from = {1.0, 1.0, 0.25};
    for (int back = 0; back < 2; back++) {
        aisle_pose2 to = aisle_move_end(from, (aisle_move){back != 0 ? -2.0 : 2.0, 0.0});
        TEST_ASSERT_TRUE(aisle_steer(&on_spot, from, to, ways) > 0U);
        TEST_ASSERT_EQUAL_UINT32(1U, ways[0].count);
        TEST_ASSERT_TRUE(aisle_steer(&car, from, to, ways) > 0U);
        TEST_ASSERT_EQUAL_UINT32(1U, ways[0].count);
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, back != 0 ? -2.0 : 2.0, ways[0].move[0].length);
    }
}

static void test_a_right_angle_is_an_arc_between_two_lines(void) {
    const aisle_pose2 from = {0.0, 0.0, 0.0}, to = {5.0, 4.0, 1.57079632679489662};
    aisle_steer_rule rolling = on_spot;
    rolling.turn_start = 5.0; // turns are dear
    TEST_ASSERT_TRUE(aisle_steer(&rolling, from, to, ways) > 0U);
    TEST_ASSERT_EQUAL_UINT32(3U, ways[0].count);
    const double radius = AISLE_STEER_RADIUS; // the widest that is tried
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 5.0 - radius, ways[0].move[0].length);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 4.0 - radius, ways[0].move[2].length);
}

static void test_the_same_place_is_a_turn_and_the_same_configuration_nothing(void) {
    const aisle_pose2 from = {2.0, 3.0, 0.5}, to = {2.0, 3.0, -2.0};
    TEST_ASSERT_EQUAL_UINT32(1U, aisle_steer(&on_spot, from, to, ways));
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, -2.5, ways[0].move[0].turn);
    TEST_ASSERT_EQUAL_UINT32(0U, aisle_steer(&on_spot, from, from, ways));
    TEST_ASSERT_EQUAL_UINT32(0U, aisle_steer(&car, from, from, ways)); // no loop
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_ways_of_a_vehicle_that_turns_on_the_spot_lead_there_cheapest_first);
    RUN_TEST(test_a_car_s_ways_lead_there_within_its_radius);
    RUN_TEST(test_in_line_it_is_one_straight_move);
    RUN_TEST(test_a_right_angle_is_an_arc_between_two_lines);
    RUN_TEST(test_the_same_place_is_a_turn_and_the_same_configuration_nothing);
    return UNITY_END();
}
