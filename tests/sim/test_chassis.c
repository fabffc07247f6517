#include "sim/chassis.h" // first: proves that the header stands alone

#include "base/angle.h"
#include "unity.h"

static const aisle_sim_chassis_traits plain = {
    .latency = 0.1, .lag = 0.08, .a = 0.5, .d = 0.8, .alpha = 1.0, .wander = 2.0}; // no slip
static aisle_sim_chassis chassis;

void setUp(void) {
    aisle_sim_chassis_start(&chassis, &plain, (aisle_pose2){0.0, 0.0, 0.0}, 1);
}
void tearDown(void) {}

static void run(double seconds, double dt) {
    for (int i = 0; i < (int)(seconds / dt + 0.5); i++) {
        aisle_sim_chassis_step(&chassis, dt);
    }
}

static void test_a_command_acts_after_the_latency(void) {
    aisle_sim_chassis_command(&chassis, &(aisle_sim_command){.v = 1.0});
    run(0.095, 0.005);
    TEST_ASSERT_EQUAL_DOUBLE(0.0, chassis.v);
    run(0.005, 0.005);
    TEST_ASSERT_TRUE(chassis.v > 0.0);
}

static void test_speed_grows_with_a_max_and_ends_with_the_lag(void) {
    aisle_sim_chassis_command(&chassis, &(aisle_sim_command){.v = 1.0});
    run(1.1, 0.001); // 1 s of acceleration
    TEST_ASSERT_DOUBLE_WITHIN(2e-3, 0.5, chassis.v);
    TEST_ASSERT_DOUBLE_WITHIN(2e-3, 0.25, chassis.pose.x);
    run(5.0, 0.001);
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, 1.0, chassis.v);
}

static void test_braking_takes_d_max_and_the_way_physics_tells(void) {
    chassis.v = 1.0;
    chassis.active = (aisle_sim_command){.v = 1.0};
    aisle_sim_chassis_command(&chassis, &(aisle_sim_command){.v = 0.0});
    run(4.0, 0.001);
    TEST_ASSERT_EQUAL_DOUBLE(0.0, chassis.v);
    double latency = 0.1;
    TEST_ASSERT_DOUBLE_WITHIN(2e-3, latency + 1.0 / (2.0 * 0.8), chassis.pose.x);
    TEST_ASSERT_EQUAL_DOUBLE(0.0, chassis.pose.y);
}

static void test_reverse_passes_through_rest(void) {
    chassis.v = 0.4;
    aisle_sim_chassis_command(&chassis, &(aisle_sim_command){.v = -0.3});
    bool rested = false;
    for (int i = 0; i < 4000; i++) {
        double before = chassis.v;
        aisle_sim_chassis_step(&chassis, 0.001);
        rested = rested || chassis.v == 0.0;
        TEST_ASSERT_FALSE(before * chassis.v < 0.0);
    }
    TEST_ASSERT_TRUE(rested);
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, -0.3, chassis.v);
}

static void test_constant_curvature_drives_a_circle(void) {
    chassis.v = 1.0;
    chassis.curvature = 0.5;
    chassis.active = (aisle_sim_command){.v = 1.0, .curvature = 0.5};
    run(2.0 * AISLE_PI, 0.001); // half of a circle of 2 m
    TEST_ASSERT_DOUBLE_WITHIN(5e-3, 0.0, chassis.pose.x);
    TEST_ASSERT_DOUBLE_WITHIN(5e-3, 4.0, chassis.pose.y);
}

static void test_backwards_a_left_curvature_still_turns_the_heading_left(void) {
    chassis.v = -1.0;
    chassis.curvature = 0.5;
    chassis.active = (aisle_sim_command){.v = -1.0, .curvature = 0.5};
    run(1.0, 0.001);
    TEST_ASSERT_DOUBLE_WITHIN(1e-3, 0.5, chassis.pose.theta);
    TEST_ASSERT_TRUE(chassis.pose.x < 0.0);
}

static void test_a_turn_on_the_spot_waits_for_rest_and_keeps_the_place(void) {
    chassis.v = 0.2;
    aisle_sim_chassis_command(&chassis, &(aisle_sim_command){.spins = true, .spin = 0.5});
    run(0.1, 0.005);
    while (chassis.v > 0.0) {
        TEST_ASSERT_EQUAL_DOUBLE(0.0, chassis.spin);
        aisle_sim_chassis_step(&chassis, 0.005);
    }
    aisle_pose2 at = chassis.pose;
    run(1.0, 0.001);
    TEST_ASSERT_EQUAL_DOUBLE(at.x, chassis.pose.x);
    TEST_ASSERT_EQUAL_DOUBLE(at.y, chassis.pose.y);
    TEST_ASSERT_DOUBLE_WITHIN(5e-3, 0.5, chassis.spin);
    TEST_ASSERT_DOUBLE_WITHIN(0.05, 0.375 - 0.04,
                              chassis.pose.theta); // 0.5 s up to 0.5 rad/s, then 0.5 s, less the lag
}

static void test_slip_stays_within_three_deviations(void) {
    aisle_sim_chassis_traits slippery = plain;
    slippery.slip_sigma = 0.01;
    slippery.steer_sigma = 0.02;
    for (uint64_t seed = 0; seed < 20; seed++) {
        aisle_sim_chassis_start(&chassis, &slippery, (aisle_pose2){0.0, 0.0, 0.0}, seed);
        chassis.v = 1.0;
        chassis.active = (aisle_sim_command){.v = 1.0};
        aisle_pose2 before = chassis.pose;
        for (int i = 0; i < 2000; i++) {
            aisle_sim_chassis_step(&chassis, 0.005);
            double moved = hypot(chassis.pose.x - before.x, chassis.pose.y - before.y);
            TEST_ASSERT_TRUE(moved >= 0.97 * 0.005 - 1e-12 && moved <= 1.03 * 0.005 + 1e-12);
            TEST_ASSERT_TRUE(moved <= aisle_sim_chassis_speed(&chassis, 0.5) * 0.005 + 1e-12);
            before = chassis.pose;
        }
    }
}

static void test_commands_beyond_the_queue_drop_the_oldest(void) {
    for (int i = 0; i < AISLE_SIM_COMMANDS_MAX + 5; i++) {
        aisle_sim_chassis_command(&chassis, &(aisle_sim_command){.v = 0.01 * i});
    }
    TEST_ASSERT_EQUAL_UINT32(AISLE_SIM_COMMANDS_MAX, chassis.count);
    run(0.2, 0.005);
    TEST_ASSERT_EQUAL_DOUBLE(0.01 * (AISLE_SIM_COMMANDS_MAX + 4), chassis.active.v);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_a_command_acts_after_the_latency);
    RUN_TEST(test_speed_grows_with_a_max_and_ends_with_the_lag);
    RUN_TEST(test_braking_takes_d_max_and_the_way_physics_tells);
    RUN_TEST(test_reverse_passes_through_rest);
    RUN_TEST(test_constant_curvature_drives_a_circle);
    RUN_TEST(test_backwards_a_left_curvature_still_turns_the_heading_left);
    RUN_TEST(test_a_turn_on_the_spot_waits_for_rest_and_keeps_the_place);
    RUN_TEST(test_slip_stays_within_three_deviations);
    RUN_TEST(test_commands_beyond_the_queue_drop_the_oldest);
    return UNITY_END();
}
