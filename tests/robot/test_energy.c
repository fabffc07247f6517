#include "aisle/energy.h"

#include "unity.h"

#include <math.h>
#include <string.h>

static aisle_path_msg path;
static aisle_vehicle_msg vehicle;
static aisle_energy each[AISLE_PATH_MAX_WAYPOINTS], sum;

static aisle_waypoint_msg *add(double x, double theta, float v, float t) {
    aisle_waypoint_msg *w = &path.waypoints[path.num_waypoints++];
    *w = (aisle_waypoint_msg){.x = x, .theta = theta, .v = v, .t = t};
    return w;
}

static aisle_status split(void) {
    return aisle_path_energy(&path, &vehicle, NULL, 0, each, &sum);
}

void setUp(void) {
    memset(&path, 0, sizeof path);
    memset(each, 0, sizeof each);
    vehicle = (aisle_vehicle_msg){.footprint_radius = 0.5F,
                                  .mass = 100.0F,
                                  .rolling_resistance = 0.02F,
                                  .idle_power = 40.0F,
                                  .drive_efficiency = 0.5F,
                                  .a_max = 0.5F,
                                  .d_max = 0.5F};
}
void tearDown(void) {}

static const double DRAG = 100.0 * 9.80665 * 0.02 / 0.5; // N, at the battery

static void test_each_cause_is_told_for_each_piece(void) {
    (void)add(0.0, 0.0, 0.0F, 0.0F);
    (void)add(1.0, 0.0, 1.0F, 2.0F);                                 // faster
    (void)add(3.0, 0.0, 1.0F, 4.0F);                                 // steady
    add(4.0, 0.0, 0.0F, 6.0F)->flags = AISLE_WAYPOINT_TURN_IN_PLACE; // slower
    (void)add(4.0, 1.5, 0.0F, 9.0F);                                 // a turn
    TEST_ASSERT_EQUAL(AISLE_OK, split());
    TEST_ASSERT_DOUBLE_WITHIN(1e-4, DRAG, (double)each[1].rolling);
    TEST_ASSERT_DOUBLE_WITHIN(1e-4, 0.5 * 100.0 / 0.5, (double)each[1].acceleration);
    TEST_ASSERT_DOUBLE_WITHIN(1e-4, 80.0, (double)each[1].idle);
    TEST_ASSERT_DOUBLE_WITHIN(1e-4, 2.0 * DRAG, (double)each[2].rolling);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 0.0, (double)each[2].acceleration);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 0.0, (double)each[3].acceleration); // braking gives nothing back
    TEST_ASSERT_DOUBLE_WITHIN(1e-4, DRAG * 0.5 * 1.5, (double)each[4].turning);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 0.0, (double)each[4].rolling);
    TEST_ASSERT_DOUBLE_WITHIN(1e-4, 120.0, (double)each[4].idle);
    TEST_ASSERT_DOUBLE_WITHIN(1e-3, 4.0 * DRAG, (double)sum.rolling);
    TEST_ASSERT_DOUBLE_WITHIN(1e-3, 360.0, (double)sum.idle);
}

static void test_from_rest_to_rest_the_peak_is_found_by_the_time_without_the_dwell(void) {
    // 1 m with 0.5 m/s2 up and down and 0.5 m/s between: 1 s, 1 s, 1 s
    aisle_goal_msg goal = {.id = 3, .dwell = 7.0F};
    (void)add(0.0, 0.0, 0.0F, 0.0F);
    aisle_waypoint_msg *w = add(1.0, 0.0, 0.0F, 3.0F);
    w->flags = AISLE_WAYPOINT_GOAL;
    w->goal_id = 3;
    (void)add(2.0, 0.0, 0.0F, 13.0F);
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_path_energy(&path, &vehicle, &goal, 1, each, &sum));
    for (int i = 1; i < 3; i++) {
        TEST_ASSERT_DOUBLE_WITHIN(1e-3, 0.5 * 100.0 * 0.25 / 0.5, (double)each[i].acceleration);
    }
    TEST_ASSERT_DOUBLE_WITHIN(1e-3, 400.0, (double)each[2].idle); // dwell included
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_path_energy(&path, &vehicle, &goal, 1, NULL, &sum));
    TEST_ASSERT_DOUBLE_WITHIN(1e-3, 520.0, (double)sum.idle);
}

static void test_what_is_no_path_or_vehicle_is_refused_and_nothing_written(void) {
    (void)add(0.0, 0.0, 0.0F, 0.0F);
    (void)add(1.0, 0.0, 0.0F, 3.0F);
    sum.idle = 5.0F;
    TEST_ASSERT_EQUAL(AISLE_ERR_ARG, aisle_path_energy(NULL, &vehicle, NULL, 0, each, &sum));
    TEST_ASSERT_EQUAL(AISLE_ERR_ARG, aisle_path_energy(&path, NULL, NULL, 0, each, &sum));
    TEST_ASSERT_EQUAL(AISLE_ERR_ARG, aisle_path_energy(&path, &vehicle, NULL, 0, each, NULL));
    path.waypoints[1].x = (double)NAN;
    TEST_ASSERT_EQUAL(AISLE_ERR_ARG, split());
    path.waypoints[1].x = 1.0;
    path.waypoints[1].t = -1.0F;
    TEST_ASSERT_EQUAL(AISLE_ERR_ARG, split());
    path.waypoints[1].t = 3.0F;
    path.num_waypoints = 0;
    TEST_ASSERT_EQUAL(AISLE_ERR_ARG, split());
    path.num_waypoints = AISLE_PATH_MAX_WAYPOINTS + 1;
    TEST_ASSERT_EQUAL(AISLE_ERR_ARG, split());
    path.num_waypoints = 2;
    vehicle.mass = -1.0F;
    TEST_ASSERT_EQUAL(AISLE_ERR_DATA, split());
    TEST_ASSERT_TRUE(sum.idle >= 5.0F && sum.idle <= 5.0F);
}

static void test_one_waypoint_takes_nothing(void) {
    (void)add(0.0, 0.0, 0.0F, 0.0F);
    TEST_ASSERT_EQUAL(AISLE_OK, split());
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 0.0, (double)(sum.rolling + sum.acceleration + sum.turning + sum.idle));
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_each_cause_is_told_for_each_piece);
    RUN_TEST(test_from_rest_to_rest_the_peak_is_found_by_the_time_without_the_dwell);
    RUN_TEST(test_what_is_no_path_or_vehicle_is_refused_and_nothing_written);
    RUN_TEST(test_one_waypoint_takes_nothing);
    return UNITY_END();
}
