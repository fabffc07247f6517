#include "sim/driver.h" // first: proves that the header stands alone

#include "base/angle.h"
#include "robot/curve.h"
#include "robot/profile.h"
#include "unity.h"

#include <string.h>

static aisle_vehicle vehicle;
static aisle_sim_driver driver;
static aisle_sim_chassis chassis;
static aisle_path_msg path;
static aisle_curve curve;
static int64_t now;
static const double dt = 0.005;

static void start_at(aisle_pose2 pose) {
    aisle_sim_chassis_traits traits = aisle_sim_chassis_usual(&vehicle);
    traits.slip_sigma = traits.steer_sigma = 0.0;
    aisle_sim_chassis_start(&chassis, &traits, pose, 1);
    aisle_sim_driver_start(&driver, &vehicle, traits.latency + traits.lag);
    memset(&path, 0, sizeof path);
    curve = (aisle_curve){.w = path.waypoints, .capacity = AISLE_PATH_MAX_WAYPOINTS};
    aisle_curve_begin(&curve, pose);
    now = 1000000;
}

void setUp(void) {
    aisle_vehicle_msg msg = {.vehicle_revision = 1, .v_max = 1.0F};
    aisle_refusal why;
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_vehicle_from_msg(&msg, &vehicle, &why));
    start_at((aisle_pose2){0.0, 0.0, 0.0});
}
void tearDown(void) {}

static aisle_sim_estimate estimate(void) {
    return (aisle_sim_estimate){chassis.pose, chassis.v, aisle_sim_chassis_omega(&chassis)};
}

static void give(int32_t revision, int8_t status, double lease) {
    path.path_revision = revision;
    path.status = status;
    path.valid_until_utime = now + (int64_t)(lease * 1e6);
    aisle_sim_estimate at = estimate();
    aisle_sim_driver_take_path(&driver, &path, &at);
}

// Speeds for the curve as it stands, without clearance to mind.
static void finish(const float *dwell) {
    aisle_profile_sum sum;
    for (uint32_t i = 0; i < curve.n; i++) {
        path.waypoints[i].clearance = 10.0F;
    }
    path.num_waypoints = (int16_t)curve.n;
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_profile_fill(&vehicle, NULL, path.waypoints, curve.n, dwell, &sum));
}

static double worst_lateral;

static void run(double seconds) {
    for (int i = 0; i < (int)(seconds / dt + 0.5); i++) {
        now += 5000;
        aisle_sim_chassis_step(&chassis, dt);
        if (i % 2 == 0) {
            aisle_sim_estimate at = estimate();
            aisle_sim_command c = aisle_sim_driver_step(&driver, now, &at);
            aisle_sim_chassis_command(&chassis, &c);
            worst_lateral = fmax(worst_lateral, fabs(driver.lateral));
        }
    }
}

static void expect_at(double x, double y, double within) {
    TEST_ASSERT_DOUBLE_WITHIN(within, x, chassis.pose.x);
    TEST_ASSERT_DOUBLE_WITHIN(within, y, chassis.pose.y);
}

static void line_path(void) {
    for (int i = 1; i <= 20; i++) {
        aisle_curve_line_to(&curve, aisle_vec2_of(0.5 * i, 0.0));
    }
    finish(NULL);
}

static void test_a_line_is_driven_to_its_end_on_time(void) {
    line_path();
    give(1, AISLE_PATH_OK, 100.0);
    double duration = (double)path.waypoints[path.num_waypoints - 1].t;
    run(duration + 1.0);
    expect_at(10.0, 0.0, 0.01);
    TEST_ASSERT_EQUAL_DOUBLE(0.0, chassis.v);
    TEST_ASSERT_EQUAL_UINT32((uint32_t)path.num_waypoints, driver.piece);
}

static void test_it_is_never_faster_than_the_path_at_its_place(void) {
    line_path();
    give(1, AISLE_PATH_OK, 100.0);
    for (int i = 0; i < 300; i++) {
        run(0.05);
        double s = chassis.pose.x, a = vehicle.a_max, d = vehicle.d_max;
        double allowed = fmin(1.0, fmin(sqrt(2.0 * a * fmax(s, 0.0)), sqrt(2.0 * d * fmax(10.0 - s, 0.0))));
        TEST_ASSERT_TRUE(chassis.v <= allowed + 0.05);
    }
}

static void test_without_a_lease_it_stops_within_the_way_braking_takes(void) {
    line_path();
    give(1, AISLE_PATH_OK, 4.0);
    run(4.0);
    double v = chassis.v, x = chassis.pose.x;
    TEST_ASSERT_TRUE(v > 0.9);
    run(6.0);
    TEST_ASSERT_EQUAL_DOUBLE(0.0, chassis.v);
    double latest = vehicle.reaction_time; // s, allowed until it brakes
    TEST_ASSERT_TRUE(chassis.pose.x - x <= v * latest + v * v / (2.0 * vehicle.d_max));
    TEST_ASSERT_TRUE(chassis.pose.x - x >= v * v / (2.0 * vehicle.d_max));
    give(1, AISLE_PATH_OK, 100.0); // renewed: it goes on
    TEST_ASSERT_EQUAL_INT64(1, driver.renewed);
    TEST_ASSERT_EQUAL_INT64(1, driver.lapses);
    run(20.0);
    expect_at(10.0, 0.0, 0.01);
}

static void test_none_and_stop_brake_at_once(void) {
    for (int i = 0; i < 2; i++) {
        start_at((aisle_pose2){0.0, 0.0, 0.0});
        line_path();
        give(1, AISLE_PATH_OK, 100.0);
        run(4.0);
        double v = chassis.v, x = chassis.pose.x;
        give(2, i == 0 ? AISLE_PATH_NONE : AISLE_PATH_STOP, 100.0);
        run(8.0);
        TEST_ASSERT_EQUAL_DOUBLE(0.0, chassis.v);
        TEST_ASSERT_TRUE(chassis.pose.x - x <= v * vehicle.reaction_time + v * v / (2.0 * vehicle.d_max));
        TEST_ASSERT_TRUE(aisle_sim_driver_brakes(&driver, now));
    }
}

static void test_an_older_path_is_ignored_and_another_boot_is_not(void) {
    line_path();
    give(5, AISLE_PATH_OK, 100.0);
    give(4, AISLE_PATH_NONE, 100.0);
    TEST_ASSERT_EQUAL_INT64(1, driver.ignored);
    TEST_ASSERT_FALSE(aisle_sim_driver_brakes(&driver, now));
    path.boot_id = 77;
    give(1, AISLE_PATH_OK, 100.0);
    TEST_ASSERT_EQUAL_INT64(2, driver.adopted);
}

static void test_after_none_only_a_newer_path_drives(void) {
    line_path();
    give(1, AISLE_PATH_OK, 100.0);
    give(2, AISLE_PATH_NONE, 100.0);
    give(1, AISLE_PATH_OK, 100.0); // late on the way
    TEST_ASSERT_TRUE(aisle_sim_driver_brakes(&driver, now));
    give(3, AISLE_PATH_OK, 100.0);
    TEST_ASSERT_FALSE(aisle_sim_driver_brakes(&driver, now));
}

static void test_corners_arcs_and_turns_are_kept_to(void) {
    const aisle_vec2 points[] = {{0.0, 0.0}, {5.0, 0.0}, {5.0, 5.0}, {0.0, 6.0}};
    const aisle_corner_rule rule = {.max_radius = 1.0, .sure_radius = 1.0, .min_radius = 0.2};
    aisle_curve_polyline(&curve, points, 4, &rule);
    aisle_curve_turn_to(&curve, 1.5);
    finish(NULL);
    give(1, AISLE_PATH_OK, 100.0);
    worst_lateral = 0.0;
    run((double)path.waypoints[curve.n - 1].t + 2.0);
    expect_at(0.0, 6.0, 0.02);
    TEST_ASSERT_DOUBLE_WITHIN(0.02, 1.5, chassis.pose.theta);
    TEST_ASSERT_TRUE(worst_lateral < 0.03);
}

static void test_it_turns_the_way_the_path_does_even_beyond_pi(void) {
    start_at((aisle_pose2){0.0, 0.0, 2.5});
    aisle_curve_turn_to(&curve, -2.5);
    finish(NULL);
    give(1, AISLE_PATH_OK, 100.0);
    run(5.0);
    TEST_ASSERT_DOUBLE_WITHIN(0.01, -2.5, chassis.pose.theta);
    expect_at(0.0, 0.0, 1e-9);
}

static void test_backwards_and_forwards_with_a_cusp(void) {
    aisle_curve_line_to(&curve, aisle_vec2_of(2.0, 0.0));
    path.waypoints[curve.n] = path.waypoints[curve.n - 1];
    path.waypoints[curve.n].x = -1.0;
    path.waypoints[curve.n].flags = AISLE_WAYPOINT_REVERSE;
    curve.n++;
    finish(NULL);
    give(1, AISLE_PATH_OK, 100.0);
    double most = 0.0;
    for (int i = 0; i < 500; i++) {
        run(0.05);
        most = fmax(most, chassis.pose.x);
    }
    TEST_ASSERT_DOUBLE_WITHIN(0.01, 2.0, most);
    expect_at(-1.0, 0.0, 0.01);
    TEST_ASSERT_DOUBLE_WITHIN(0.01, 0.0, chassis.pose.theta);
}

static void test_a_backward_arc_is_kept_to(void) {
    path.waypoints[1] = path.waypoints[0]; // from (0, 0, 0) backwards, turning left as seen along the motion
    path.waypoints[1].x = -1.5;
    path.waypoints[1].y = -1.5;
    path.waypoints[1].theta = 0.5 * AISLE_PI;
    path.waypoints[1].curvature = (float)(1.0 / 1.5);
    path.waypoints[1].flags = AISLE_WAYPOINT_REVERSE;
    curve.n = 2;
    finish(NULL);
    give(1, AISLE_PATH_OK, 100.0);
    worst_lateral = 0.0;
    run(20.0);
    expect_at(-1.5, -1.5, 0.03);
    TEST_ASSERT_DOUBLE_WITHIN(0.05, 0.5 * AISLE_PI, chassis.pose.theta);
    TEST_ASSERT_TRUE(worst_lateral < 0.03);
}

static void test_it_stays_at_a_goal_for_its_dwell(void) {
    aisle_goal_list_msg list = {.num_goals = 1, .goals = {{.id = 7, .dwell = 3.0F}}};
    aisle_sim_driver_take_goals(&driver, &list);
    aisle_curve_line_to(&curve, aisle_vec2_of(2.0, 0.0));
    aisle_curve_goal(&curve, 7);
    aisle_curve_line_to(&curve, aisle_vec2_of(4.0, 0.0));
    const float dwell[] = {0.0F, 3.0F, 0.0F};
    TEST_ASSERT_EQUAL_UINT32(3, curve.n);
    finish(dwell);
    give(1, AISLE_PATH_OK, 100.0);
    int resting = 0;
    for (int i = 0; i < 2000; i++) {
        run(0.01);
        resting += fabs(chassis.pose.x - 2.0) < 0.02 && chassis.v == 0.0 ? 1 : 0;
    }
    TEST_ASSERT_TRUE(resting > 290 && resting < 345);
    expect_at(4.0, 0.0, 0.01);
}

// ---- dwells among paths that come meanwhile: told by (2, 0), on to (4, 0)

static void take_orders(void) {
    const aisle_goal_list_msg list = {.num_goals = 2, .goals = {{.id = 7, .dwell = 3.0F}, {.id = 8, .dwell = 2.0F}}};
    aisle_sim_driver_take_goals(&driver, &list);
}

// From (x, 0) to the goal `id` at (2, 0), if it is not there, and on.
static void make_path(double x, int32_t id) {
    const float dwell[] = {id == 7 ? 3.0F : 2.0F, 0.0F, 0.0F};
    memset(&path, 0, sizeof path);
    curve.n = 0;
    aisle_curve_begin(&curve, (aisle_pose2){x, 0.0, 0.0});
    aisle_curve_line_to(&curve, aisle_vec2_of(2.0, 0.0));
    aisle_curve_goal(&curve, id);
    const uint32_t before = curve.n - 1U;
    aisle_curve_line_to(&curve, aisle_vec2_of(4.0, 0.0));
    TEST_ASSERT_EQUAL_UINT32(before + 2U, curve.n);
    TEST_ASSERT_TRUE((path.waypoints[before].flags & AISLE_WAYPOINT_GOAL) != 0);
    const float on_the_way[] = {0.0F, dwell[0], 0.0F};
    finish(before == 0U ? dwell : on_the_way);
}

// Drives until the wheels stand on the goal.
static void come_to_the_goal(void) {
    take_orders();
    make_path(0.0, 7);
    give(1, AISLE_PATH_OK, 100.0);
    for (int i = 0; i < 1000 && !(chassis.pose.x > 1.98 && chassis.v <= 0.0); i++) {
        run(0.01);
    }
    expect_at(2.0, 0.0, 0.02);
}

// Seconds until the wheels turn again, at most 6.
static double until_it_leaves(void) {
    double seconds = 0.0;
    while (seconds < 6.0 && chassis.v <= 0.0) {
        run(0.01);
        seconds += 0.01;
    }
    return seconds;
}

static const double soon =
    0.15; // s, from a command to wheels that turn, and from wheels that stand to the estimate's count

static void test_a_path_that_begins_on_the_goal_is_left_when_the_dwell_is_over(void) {
    for (int i = 1; i < 4; i++) { // after 0.7, 1.4 and 2.1 s of it
        start_at((aisle_pose2){0.0, 0.0, 0.0});
        come_to_the_goal();
        run(0.7 * i);
        make_path(2.0, 7);
        give(2, AISLE_PATH_OK, 100.0);
        TEST_ASSERT_DOUBLE_WITHIN(soon, 3.0 - 0.7 * i, until_it_leaves());
        run(12.0);
        expect_at(4.0, 0.0, 0.01);
    }
}

static void test_one_that_comes_when_the_dwell_is_over_is_left_at_once(void) {
    come_to_the_goal();
    run(1.0);
    give(2, AISLE_PATH_NONE, 100.0);
    run(4.0);
    TEST_ASSERT_EQUAL_DOUBLE(0.0, chassis.v);
    make_path(2.0, 7);
    give(3, AISLE_PATH_OK, 100.0);
    TEST_ASSERT_DOUBLE_WITHIN(soon, 0.0, until_it_leaves());
}

static void test_many_paths_and_none_do_not_begin_a_dwell_anew(void) {
    come_to_the_goal();
    for (int32_t revision = 2; revision <= 22; revision += 2) { // 2.2 s
        give(revision, AISLE_PATH_NONE, 100.0);
        run(0.1);
        make_path(2.0, 7);
        give(revision + 1, AISLE_PATH_OK, 0.5);
        run(0.05);
        give(revision + 1, AISLE_PATH_OK, 100.0); // renewed
        run(0.05);
    }
    TEST_ASSERT_EQUAL_INT64(11, driver.renewed);
    TEST_ASSERT_DOUBLE_WITHIN(soon, 0.8, until_it_leaves());
}

static void test_a_dwell_goes_on_on_a_path_that_does_not_quite_begin_on_the_goal(void) {
    for (int i = -3; i <= 3; i++) { // the goal is so many mm ahead of where it stands, or behind
        start_at((aisle_pose2){0.0, 0.0, 0.0});
        come_to_the_goal();
        run(1.0);
        chassis.pose.x = 2.0 - 1e-3 * i;
        make_path(1.997, 7);
        give(2, AISLE_PATH_OK, 100.0);
        TEST_ASSERT_DOUBLE_WITHIN(soon, 2.0, until_it_leaves());
    }
}

static void test_one_that_starts_on_a_goal_stays_there_for_its_dwell(void) {
    start_at((aisle_pose2){2.0, 0.0, 0.0});
    take_orders();
    make_path(2.0, 7);
    give(1, AISLE_PATH_OK, 100.0);
    TEST_ASSERT_DOUBLE_WITHIN(soon, 3.0, until_it_leaves());
    run(12.0);
    expect_at(4.0, 0.0, 0.01);
}

static void test_another_goal_at_the_same_place_has_its_own_dwell(void) {
    come_to_the_goal();
    run(2.0);
    make_path(2.0, 8);
    give(2, AISLE_PATH_OK, 100.0);
    TEST_ASSERT_DOUBLE_WITHIN(soon, 2.0, until_it_leaves());
}

static void test_a_goal_that_was_left_and_come_back_to_is_stayed_on_anew(void) {
    come_to_the_goal();
    run(1.0);
    chassis.v = 0.2; // pushed
    run(0.5);
    give(2, AISLE_PATH_NONE, 100.0);
    run(1.0);
    chassis.pose.x = 2.0;
    make_path(2.0, 7);
    give(3, AISLE_PATH_OK, 100.0);
    TEST_ASSERT_DOUBLE_WITHIN(soon, 3.0, until_it_leaves());
}

static void test_a_path_without_the_goal_is_left_at_once_though_the_dwell_is_not_over(void) {
    come_to_the_goal();
    run(1.0);
    make_path(2.0, 7);
    path.waypoints[0].flags = 0; // the planner has counted it as reached, or was told to skip it
    finish(NULL);
    give(2, AISLE_PATH_OK, 100.0);
    TEST_ASSERT_DOUBLE_WITHIN(soon, 0.0, until_it_leaves());
}

static void test_a_new_path_from_the_present_place_is_taken_up_in_motion(void) {
    line_path();
    give(1, AISLE_PATH_OK, 100.0);
    run(4.0);
    double v = chassis.v, x = chassis.pose.x;
    memset(&path, 0, sizeof path);
    curve.n = 0;
    aisle_curve_begin(&curve, (aisle_pose2){x - 0.05, 0.0, 0.0}); // the planner's place of 50 ms ago
    aisle_curve_line_to(&curve, aisle_vec2_of(x + 5.0, 0.0));
    path.num_waypoints = 2;
    path.waypoints[0].v = (float)v;
    path.waypoints[1].v = 0.0F;
    give(2, AISLE_PATH_OK, 100.0);
    TEST_ASSERT_DOUBLE_WITHIN(0.01, 0.05, driver.done);
    run(0.2);
    TEST_ASSERT_TRUE(chassis.v > 0.9 * v);
    run(20.0);
    expect_at(x + 5.0, 0.0, 0.01);
}

static void test_without_any_path_it_stands(void) {
    run(2.0);
    expect_at(0.0, 0.0, 0.0);
    TEST_ASSERT_TRUE(aisle_sim_driver_brakes(&driver, now));
}

static void test_an_offset_is_steered_away_without_swinging(void) {
    line_path();
    give(1, AISLE_PATH_OK, 100.0);
    chassis.pose.y = 0.1;
    double lowest = 1.0;
    for (int i = 0; i < 240; i++) {
        run(0.05);
        lowest = fmin(lowest, chassis.pose.y);
    }
    TEST_ASSERT_DOUBLE_WITHIN(5e-3, 0.0, chassis.pose.y);
    TEST_ASSERT_TRUE(lowest > -0.02);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_a_line_is_driven_to_its_end_on_time);
    RUN_TEST(test_it_is_never_faster_than_the_path_at_its_place);
    RUN_TEST(test_without_a_lease_it_stops_within_the_way_braking_takes);
    RUN_TEST(test_none_and_stop_brake_at_once);
    RUN_TEST(test_an_older_path_is_ignored_and_another_boot_is_not);
    RUN_TEST(test_after_none_only_a_newer_path_drives);
    RUN_TEST(test_corners_arcs_and_turns_are_kept_to);
    RUN_TEST(test_it_turns_the_way_the_path_does_even_beyond_pi);
    RUN_TEST(test_backwards_and_forwards_with_a_cusp);
    RUN_TEST(test_a_backward_arc_is_kept_to);
    RUN_TEST(test_it_stays_at_a_goal_for_its_dwell);
    RUN_TEST(test_a_path_that_begins_on_the_goal_is_left_when_the_dwell_is_over);
    RUN_TEST(test_one_that_comes_when_the_dwell_is_over_is_left_at_once);
    RUN_TEST(test_many_paths_and_none_do_not_begin_a_dwell_anew);
    RUN_TEST(test_a_dwell_goes_on_on_a_path_that_does_not_quite_begin_on_the_goal);
    RUN_TEST(test_one_that_starts_on_a_goal_stays_there_for_its_dwell);
    RUN_TEST(test_another_goal_at_the_same_place_has_its_own_dwell);
    RUN_TEST(test_a_goal_that_was_left_and_come_back_to_is_stayed_on_anew);
    RUN_TEST(test_a_path_without_the_goal_is_left_at_once_though_the_dwell_is_not_over);
    RUN_TEST(test_a_new_path_from_the_present_place_is_taken_up_in_motion);
    RUN_TEST(test_without_any_path_it_stands);
    RUN_TEST(test_an_offset_is_steered_away_without_swinging);
    return UNITY_END();
}
