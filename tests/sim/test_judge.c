#include "sim/judge.h" // first: proves that the header stands alone

#include "hall.h"

#define PI 3.14159265358979323846

static aisle_sim_scene scene;
static aisle_sim_movers movers;
static aisle_sim_judge judge;
static aisle_vehicle_msg disc = {.footprint_radius = 0.5F, .v_max = 1.0F, .d_max = 0.5F, .reaction_time = 0.3F};
static const double dt = 0.005;

void setUp(void) {
    hall_begin(20.0, 15.0);
    hall_add(10.0, 0.0, 11.0, 5.0);
    hall_open(&scene);
    aisle_sim_movers_start(&movers, &scene, 1);
    aisle_sim_judge_start(&judge, &scene, &disc);
}
void tearDown(void) {
    aisle_sim_scene_free(&scene);
}

// The vehicle drives from a to b in `seconds` at an even speed, movers as they are; the first look is at a.
static void drive(double t0, double seconds, aisle_pose2 a, aisle_pose2 b) {
    int count = (int)(seconds / dt + 0.5);
    double v = hypot(b.x - a.x, b.y - a.y) / seconds, speed = v + fabs(b.theta - a.theta) / seconds * judge.reach;
    aisle_sim_prey prey = {.at = {a.x, a.y}};
    for (int i = 0; i <= count; i++) {
        double f = (double)i / count;
        aisle_pose2 at = {a.x + f * (b.x - a.x), a.y + f * (b.y - a.y), a.theta + f * (b.theta - a.theta)};
        if (i > 0) {
            aisle_sim_movers_step(&movers, dt, &prey);
        }
        aisle_sim_judge_look(&judge, t0 + i * dt, at, v, speed, &movers);
    }
}

static void rest(double t0, double seconds, aisle_pose2 at) {
    drive(t0, seconds, at, at);
}

static void test_passing_by_tells_the_least_gap(void) {
    (void)aisle_sim_movers_place(&movers, aisle_vec2_of(5.0, 8.0), aisle_vec2_of(0.0, 0.0), 0.25);
    drive(0.0, 6.0, (aisle_pose2){2.0, 7.0, 0.0}, (aisle_pose2){8.0, 7.0, 0.0});
    TEST_ASSERT_DOUBLE_WITHIN(1e-4, 0.25, judge.separation);
    TEST_ASSERT_DOUBLE_WITHIN(1e-4, 0.25, judge.separation_moving);
    TEST_ASSERT_EQUAL_INT64(0, judge.collisions + judge.contacts_at_rest);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 6.0, judge.way);
}

static void test_grazing_by_a_millimetre_is_a_collision_once(void) {
    (void)aisle_sim_movers_place(&movers, aisle_vec2_of(5.0, 7.749), aisle_vec2_of(0.0, 0.0), 0.25);
    drive(0.0, 3.0, (aisle_pose2){2.0, 7.0, 0.0}, (aisle_pose2){8.0, 7.0, 0.0});
    TEST_ASSERT_EQUAL_INT64(1, judge.collisions);
    TEST_ASSERT_EQUAL_INT64(0, judge.contacts_at_rest);
    TEST_ASSERT_EQUAL_UINT32(1, judge.num_contacts);
    TEST_ASSERT_TRUE(judge.contact[0].moving && !judge.contact[0].is_static);
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, 2.0, judge.contact[0].speed);
    // |5 - x| = sqrt(0.75^2 - 0.749^2) = 0.0387 at the first touch
    TEST_ASSERT_DOUBLE_WITHIN(0.012, (3.0 - 0.0387) / 2.0, judge.contact[0].t);
}

static void test_a_bullet_between_two_ticks_is_seen(void) {
    // At 400 m/s the mover crosses the vehicle's whole body within a tick.
    aisle_sim_mover *m = aisle_sim_movers_place(&movers, aisle_vec2_of(3.0, 7.01), aisle_vec2_of(0.0, 0.0), 0.05);
    aisle_sim_judge_look(&judge, 0.0, (aisle_pose2){4.0, 7.0, 0.0}, 0.5, 0.5, &movers);
    m->pose.x = 5.0;
    aisle_sim_judge_look(&judge, dt, (aisle_pose2){4.0, 7.0, 0.0}, 0.5, 0.5, &movers);
    TEST_ASSERT_EQUAL_INT64(1, judge.collisions);
}

static void test_being_run_into_at_rest_is_no_collision(void) {
    (void)aisle_sim_movers_place(&movers, aisle_vec2_of(3.0, 7.0), aisle_vec2_of(1.0, 0.0), 0.25);
    rest(0.0, 4.0, (aisle_pose2){5.0, 7.0, 0.0});
    TEST_ASSERT_EQUAL_INT64(0, judge.collisions);
    TEST_ASSERT_EQUAL_INT64(1, judge.contacts_at_rest);
    TEST_ASSERT_DOUBLE_WITHIN(0.006, 1.25, judge.contact[0].t);
    TEST_ASSERT_EQUAL_DOUBLE(0.0, judge.separation);
    TEST_ASSERT_FALSE(isfinite(judge.separation_moving)); // it never moved
}

static void test_moving_off_while_touched_is_a_collision(void) {
    (void)aisle_sim_movers_place(&movers, aisle_vec2_of(4.3, 7.0), aisle_vec2_of(0.0, 0.0), 0.25);
    rest(0.0, 1.0, (aisle_pose2){5.0, 7.0, 0.0});
    TEST_ASSERT_EQUAL_INT64(1, judge.contacts_at_rest);
    drive(1.0, 1.0, (aisle_pose2){5.0, 7.0, 0.0}, (aisle_pose2){5.1, 7.0, 0.0});
    TEST_ASSERT_EQUAL_INT64(0, judge.contacts_at_rest);
    TEST_ASSERT_EQUAL_INT64(1, judge.collisions);
    TEST_ASSERT_EQUAL_UINT32(1, judge.num_contacts);
}

static void test_two_touches_of_one_mover_count_twice(void) {
    aisle_sim_mover *m = aisle_sim_movers_place(&movers, aisle_vec2_of(4.3, 7.0), aisle_vec2_of(0.0, 0.0), 0.25);
    rest(0.0, 0.5, (aisle_pose2){5.0, 7.0, 0.0});
    m->velocity.x = -1.0;
    rest(0.5, 1.0, (aisle_pose2){5.0, 7.0, 0.0});
    m->velocity.x = 1.0;
    rest(1.5, 1.0, (aisle_pose2){5.0, 7.0, 0.0});
    TEST_ASSERT_EQUAL_INT64(2, judge.contacts_at_rest);
}

static void test_a_collision_is_shown_after_any_number_of_contacts_at_rest(void) {
    aisle_sim_mover *m = aisle_sim_movers_place(&movers, aisle_vec2_of(3.0, 7.0), aisle_vec2_of(0.0, 0.0), 0.25);
    aisle_pose2 at = {5.0, 7.0, 0.0};
    for (int i = 0; i < AISLE_SIM_JUDGE_SHOWN + 5; i++) {
        m->pose.x = 4.3; // there at once, to and fro
        aisle_sim_judge_look(&judge, i, at, 0.0, 0.0, &movers);
        m->pose.x = 3.0;
        aisle_sim_judge_look(&judge, i + 0.5, at, 0.0, 0.0, &movers);
        aisle_sim_judge_look(&judge, i + 0.7, at, 0.0, 0.0, &movers);
    }
    TEST_ASSERT_EQUAL_INT64(AISLE_SIM_JUDGE_SHOWN + 5, judge.contacts_at_rest);
    drive(101.0, 1.0, at, (aisle_pose2){3.5, 7.0, 0.0});
    TEST_ASSERT_EQUAL_INT64(1, judge.collisions);
    const aisle_sim_contact *last = &judge.contact[AISLE_SIM_JUDGE_SHOWN - 1];
    TEST_ASSERT_TRUE(last->moving && last->t > 101.0 && last->id == m->id);
}

static void test_creeping_below_the_threshold_counts_as_rest(void) {
    (void)aisle_sim_movers_place(&movers, aisle_vec2_of(5.76, 7.0), aisle_vec2_of(0.0, 0.0), 0.25);
    drive(0.0, 10.0, (aisle_pose2){5.0, 7.0, 0.0}, (aisle_pose2){5.09, 7.0, 0.0}); // 9 mm/s
    TEST_ASSERT_EQUAL_INT64(0, judge.collisions);
    TEST_ASSERT_EQUAL_INT64(1, judge.contacts_at_rest);
}

static void test_turning_on_the_spot_is_moving(void) {
    aisle_vehicle_msg bar = {.num_vertices = 4, .footprint = {{-0.1, -0.1}, {1.0, -0.1}, {1.0, 0.1}, {-0.1, 0.1}}};
    aisle_sim_judge_start(&judge, &scene, &bar);
    (void)aisle_sim_movers_place(&movers, aisle_vec2_of(5.0, 8.0), aisle_vec2_of(0.0, 0.0), 0.25);
    drive(0.0, 2.0, (aisle_pose2){5.0, 7.0, 0.0}, (aisle_pose2){5.0, 7.0, 0.5 * PI});
    TEST_ASSERT_EQUAL_INT64(1, judge.collisions);
}

static void test_the_hall_is_watched_too(void) {
    drive(0.0, 4.0, (aisle_pose2){8.0, 3.0, 0.0}, (aisle_pose2){9.4, 3.0, 0.0});
    TEST_ASSERT_EQUAL_INT64(0, judge.static_collisions);
    TEST_ASSERT_DOUBLE_WITHIN(1e-3, 0.1, judge.static_gap);
    drive(4.0, 1.0, (aisle_pose2){9.4, 3.0, 0.0}, (aisle_pose2){9.6, 3.0, 0.0});
    TEST_ASSERT_EQUAL_INT64(1, judge.static_collisions);
    TEST_ASSERT_TRUE(judge.contact[0].is_static);
    TEST_ASSERT_EQUAL_INT32(1, judge.contact[0].id);
    TEST_ASSERT_EQUAL_INT64(0, judge.collisions);
}

static void test_an_encounter_is_a_reach_that_meets_the_way_to_rest(void) {
    // From v_max = 1 it stops in 0.4 + 2 s over 0.4 + 1 m; the mover's reach by then is 0.25 + 2 * 2.4 m.
    double reach = 0.5 + 0.25 + 2.0 * 2.4;
    aisle_sim_mover *m =
        aisle_sim_movers_place(&movers, aisle_vec2_of(3.0 + 1.4, 7.0 + reach + 0.01), aisle_vec2_of(0.0, 0.0), 0.25);
    aisle_sim_judge_look(&judge, 0.0, (aisle_pose2){3.0, 7.0, 0.0}, 0.2, 0.2, &movers);
    TEST_ASSERT_EQUAL_INT64(0, judge.encounters);
    m->pose.y -= 0.02;
    aisle_sim_judge_look(&judge, 0.1, (aisle_pose2){3.0, 7.0, 0.0}, 0.2, 0.2, &movers); // however slow it is now
    aisle_sim_judge_look(&judge, 2.0, (aisle_pose2){3.0, 7.0, 0.0}, 1.0, 1.0, &movers);
    TEST_ASSERT_EQUAL_INT64(1, judge.encounters); // still the same one
    aisle_sim_judge_look(&judge, 5.1, (aisle_pose2){3.0, 7.0, 0.0}, 1.0, 1.0, &movers);
    TEST_ASSERT_EQUAL_INT64(2, judge.encounters);
    aisle_sim_judge_look(&judge, 9.0, (aisle_pose2){3.0, 7.0, 0.0}, -0.2, 0.2, &movers); // backwards it goes away
    TEST_ASSERT_EQUAL_INT64(2, judge.encounters);
}

static void test_a_vehicle_that_stands_meets_nobody(void) {
    (void)aisle_sim_movers_place(&movers, aisle_vec2_of(4.0, 7.0), aisle_vec2_of(0.0, 0.0), 0.25);
    rest(0.0, 1.0, (aisle_pose2){3.0, 7.0, 0.0});
    TEST_ASSERT_EQUAL_INT64(0, judge.encounters);
}

static void test_goals_count_in_order_after_rest_and_dwell(void) {
    aisle_goal_list_msg list = {.num_goals = 2,
                                .goals = {{.id = 1, .x = 5.0, .y = 8.0, .tolerance_theta = 4.0F, .dwell = 1.0F},
                                          {.id = 2, .x = 8.0, .y = 8.0, .theta = 1.0}}};
    aisle_sim_judge_take_goals(&judge, &list);
    rest(0.0, 1.0, (aisle_pose2){8.0, 8.0, 1.0}); // the second one first: does not count
    TEST_ASSERT_EQUAL_INT16(0, judge.num_visited);
    drive(1.0, 2.0, (aisle_pose2){8.0, 8.0, 0.0}, (aisle_pose2){5.0, 8.0, 0.0});
    rest(3.0, 0.9, (aisle_pose2){5.0, 8.05, 0.0});
    TEST_ASSERT_EQUAL_INT16(0, judge.num_visited); // not stayed long enough
    rest(3.9, 0.2, (aisle_pose2){5.0, 8.05, 0.0});
    TEST_ASSERT_EQUAL_INT16(1, judge.num_visited);
    rest(4.2, 0.5, (aisle_pose2){8.0, 8.0, 1.2}); // heading too far off
    TEST_ASSERT_EQUAL_INT16(1, judge.num_visited);
    rest(4.7, 0.5, (aisle_pose2){8.0, 8.0, 1.05});
    TEST_ASSERT_EQUAL_INT16(2, judge.num_visited);
    TEST_ASSERT_DOUBLE_WITHIN(0.006, 4.7, judge.arrival);
}

static void test_goals_in_any_order_count_as_they_come(void) {
    aisle_goal_list_msg list = {.num_goals = 2,
                                .ordering = AISLE_GOAL_LIST_ANY_ORDER,
                                .goals = {{.id = 1, .x = 5.0, .y = 8.0}, {.id = 2, .x = 8.0, .y = 8.0}}};
    aisle_sim_judge_take_goals(&judge, &list);
    rest(0.0, 0.1, (aisle_pose2){8.0, 8.0, 0.0});
    rest(0.1, 0.1, (aisle_pose2){8.0, 8.0, 0.0}); // counts once
    TEST_ASSERT_EQUAL_INT16(1, judge.num_visited);
    rest(0.2, 0.1, (aisle_pose2){5.0, 8.0, 0.0});
    TEST_ASSERT_TRUE(judge.arrival >= 0.0);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_passing_by_tells_the_least_gap);
    RUN_TEST(test_grazing_by_a_millimetre_is_a_collision_once);
    RUN_TEST(test_a_bullet_between_two_ticks_is_seen);
    RUN_TEST(test_being_run_into_at_rest_is_no_collision);
    RUN_TEST(test_moving_off_while_touched_is_a_collision);
    RUN_TEST(test_two_touches_of_one_mover_count_twice);
    RUN_TEST(test_a_collision_is_shown_after_any_number_of_contacts_at_rest);
    RUN_TEST(test_creeping_below_the_threshold_counts_as_rest);
    RUN_TEST(test_turning_on_the_spot_is_moving);
    RUN_TEST(test_the_hall_is_watched_too);
    RUN_TEST(test_an_encounter_is_a_reach_that_meets_the_way_to_rest);
    RUN_TEST(test_a_vehicle_that_stands_meets_nobody);
    RUN_TEST(test_goals_count_in_order_after_rest_and_dwell);
    RUN_TEST(test_goals_in_any_order_count_as_they_come);
    return UNITY_END();
}
