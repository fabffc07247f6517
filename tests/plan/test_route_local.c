#include "plan/route.h"

#include "asked_route.h"

enum { SEEDS = 12 };

static aisle_movers movers;
static aisle_mover mover[8];
static int64_t from_us;
static bool with_movers, in_motion;

static void open_hall(void) {
    hall_open_route(&route, &hall_limits, 1000000U);
}

static void add_mover(int32_t id, double x, double y, double vx, double radius) {
    mover[movers.count++] = (aisle_mover){.id = id,
                                          .at = {x, y},
                                          .velocity = {vx, 0.0},
                                          .radius = radius,
                                          .sigma = 0.02,
                                          .v_bound = 2.0,
                                          .utime = from_us};
    with_movers = true;
}

static void ask(double x0, double y0, double x1, double y1) {
    route_ask(AISLE_OPTIONS_PSO_LOCAL, x0, y0, x1, y1);
}

static void plan(uint32_t slice) {
    route_begin();
    if (with_movers) {
        aisle_route_go_round(&route, &movers, from_us, in_motion);
    }
    route_finish(slice);
}

static const aisle_proof *proof(void) {
    const aisle_proof *proof = route_proof();
    TEST_ASSERT_EQUAL_INT8(AISLE_OPTIONS_PSO_LOCAL, answer.planner);
    return proof;
}

static void refused_with(int16_t cause, int32_t id) {
    route_refused(cause);
    TEST_ASSERT_EQUAL_INT32(id, route.cause.id);
}

// Least distance of the path's origin from a place, sampled every centimetre.
static double nearest(double x, double y) {
    double least = 1e9;
    for (int16_t i = 1; i < answer.num_waypoints; i++) {
        const door_piece piece = door_piece_of(&answer.waypoints[i - 1], &answer.waypoints[i]);
        const int steps = 1 + (int)(piece.length / 0.01);
        for (int k = 0; k <= steps; k++) {
            const aisle_pose2 at = door_piece_at(&piece, (double)k / steps);
            least = fmin(least, hypot(at.x - x, at.y - y));
        }
    }
    return least;
}

void setUp(void) {
    memset(&movers, 0, sizeof movers);
    movers.mover = mover;
    from_us = 5000000;
    with_movers = in_motion = false;
    hall_disc(0.3, 0.1F);
    hall_begin(20.0, 12.0);
}
void tearDown(void) {}

// Two aisles of 5 m beside a shelf.
static void two_aisles(void) {
    hall_begin(20.0, 12.0);
    hall_add(4.0, 5.8, 16.0, 6.2);
    open_hall();
}

// ---- tests

static void test_a_query_leaves_a_pocket_by_the_local_swarm_in_all_seeds(void) {
    hall_add(8.0, 3.0, 12.0, 3.3);
    hall_add(8.0, 8.7, 12.0, 9.0);
    hall_add(12.0, 3.0, 12.3, 9.0);
    open_hall();
    for (int32_t seed = 1; seed <= SEEDS; seed++) {
        ask(10.0, 6.0, 18.0, 6.0);
        request.options.seed = seed;
        plan(1000);
        (void)proof();
        TEST_ASSERT_TRUE(answer.length > 12.0F && answer.length < 16.0F);
    }
}

static void test_what_stands_in_an_aisle_is_given_the_other_one_with_room_for_it_to_walk(void) {
    two_aisles();
    ask(2.0, 8.0, 18.0, 8.0);
    plan(1000);
    (void)proof();
    TEST_ASSERT_TRUE(answer.length < 16.01F); // nothing is there: straight on
    add_mover(77, 10.0, 9.0, 0.0, 0.3);
    for (int32_t seed = 1; seed <= SEEDS; seed++) {
        request.options.seed = seed;
        plan(1000);
        (void)proof();
        TEST_ASSERT_TRUE(nearest(10.0, 3.0) < 3.0); // through the other aisle
        TEST_ASSERT_TRUE(nearest(10.0, 9.0) >= 0.3 + 0.3 + 0.06 + 0.1 + 1.6);
    }
}

static void test_where_there_is_less_room_less_is_kept(void) {
    hall_add(9.0, 5.0, 11.0, 12.0);
    open_hall();
    add_mover(77, 10.0, 3.2, 0.0, 0.3);
    ask(2.0, 6.0, 18.0, 6.0);
    plan(1000);
    (void)proof();
    const double kept = nearest(10.0, 3.2) - (0.3 + 0.3 + 0.06 + 0.1);
    TEST_ASSERT_TRUE(kept >= 1.9 - 1e-6 && kept < 2.4);
}

static void test_a_range_beyond_all_is_no_other_than_the_longest(void) {
    two_aisles();
    ask(2.0, 8.0, 18.0, 3.0);
    request.options.step = 1e6F;
    plan(1000);
    (void)proof();
    TEST_ASSERT_TRUE(answer.length > 16.5F && answer.length < 18.0F);
}

static void test_any_heading_and_any_speed_are_borne(void) {
    static const double theta[] = {0.0, 99999.0, 1e5, 1e7, -1e15};
    two_aisles();
    for (int i = 0; i < 10; i++) {
        ask(2.0, 8.0, 18.0, 8.0);
        request.start.theta = theta[i % 5];
        request.start.tolerance_theta = i < 5 ? 4.0F : 0.0F;
        hall_vehicle.v_max = i % 2 == 0 ? 1e-4 : 1.5;
        plan(1000);
        TEST_ASSERT_TRUE(aisle_route_answer(&route) != NULL || route.cause.cause != 0);
    }
}

static void test_movers_are_seen_where_they_are_when_the_vehicle_is_at_the_start(void) {
    open_hall();
    add_mover(77, 8.0, 6.0, -1.0, 0.3); // on the way, and off it by then
    mover[0].utime = from_us - 7000000;
    ask(5.0, 6.0, 18.0, 6.0);
    plan(1000);
    (void)proof();
    TEST_ASSERT_DOUBLE_WITHIN(1e-4, 13.0, (double)answer.length);
    mover[0].at.x = 15.0; // on it by then
    plan(1000);
    TEST_ASSERT_TRUE(aisle_route_answer(&route) == NULL || proof()->value > 13.05);
}

static void test_movers_in_both_aisles_are_named(void) {
    two_aisles();
    add_mover(77, 10.0, 9.0, 0.0, 1.0);
    add_mover(78, 10.0, 3.0, 0.0, 1.0);
    ask(2.0, 8.0, 18.0, 8.0);
    plan(1000);
    TEST_ASSERT_NULL(aisle_route_answer(&route));
    TEST_ASSERT_EQUAL_INT16(AISLE_STATUS_BLOCKED_BY, route.cause.cause);
    TEST_ASSERT_TRUE(route.cause.id == 77 || route.cause.id == 78);
    movers.count = 1; // one leaves
    plan(1000);
    (void)proof();
}

static void test_that_none_was_found_among_what_is_built_is_called_no_proof(void) {
    hall_add(10.0, 0.0, 10.3, 12.0);
    open_hall();
    ask(2.0, 6.0, 18.0, 6.0);
    plan(1000);
    refused_with(AISLE_STATUS_BUDGET, 0);
}

static void test_a_vehicle_in_motion_goes_straight_on_before_it_bends(void) {
    open_hall();
    add_mover(77, 8.0, 6.0, 0.0, 0.4);
    in_motion = true;
    ask(3.0, 6.0, 18.0, 6.0);
    request.start.tolerance_theta = 0.0F;
    plan(1000);
    (void)proof();
    const aisle_waypoint_msg *w = answer.waypoints;
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 0.0, w[0].theta);
    for (int16_t i = 0; i < answer.num_waypoints; i++) {
        TEST_ASSERT_EQUAL_INT16(0, w[i].flags & AISLE_WAYPOINT_TURN_IN_PLACE);
    }
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 6.0, w[1].y); // the first piece is straight
    TEST_ASSERT_TRUE(w[1].x > 3.1 && fabs((double)w[1].curvature) <= 0.0);
}

static void test_a_goal_straight_ahead_is_not_passed_in_order_to_go_straight_on(void) {
    static const double away[] = {0.1, 0.25, 0.5, 0.7, 1.0, 1.0 + 1e-7, 2.0};
    open_hall();
    add_mover(77, 15.0, 2.0, 0.0, 0.4);
    in_motion = true;
    for (int i = 0; i < 7; i++) {
        ask(3.0, 6.0, 3.0 + away[i], 6.0);
        request.start.tolerance_theta = 0.0F;
        plan(1000);
        (void)proof();
        TEST_ASSERT_DOUBLE_WITHIN(1e-6, 3.0 + away[i], answer.waypoints[answer.num_waypoints - 1].x);
        TEST_ASSERT_DOUBLE_WITHIN(1e-5, away[i], (double)answer.length);
    }
}

static void test_what_is_behind_is_turned_to_where_the_vehicle_is_not_driven_on_first(void) {
    open_hall();
    add_mover(77, 15.0, 2.0, 0.0, 0.4);
    in_motion = true;
    ask(10.0, 6.0, 3.0, 6.0); // it looks the other way
    request.start.tolerance_theta = 0.0F;
    plan(1000);
    (void)proof();
    TEST_ASSERT_TRUE((answer.waypoints[0].flags & AISLE_WAYPOINT_TURN_IN_PLACE) != 0);
    TEST_ASSERT_TRUE(answer.length < 7.01F);
}

static void test_goals_are_visited_in_order_one_that_it_stands_at_included(void) {
    two_aisles();
    ask(2.0, 8.0, 2.0, 8.0);
    request.num_goals = 3;
    request.goals[1] = (aisle_goal_msg){.id = 12, .x = 18.0, .y = 3.0, .tolerance_theta = 4.0F};
    request.goals[2] = (aisle_goal_msg){.id = 13, .x = 18.0, .y = 9.0, .tolerance_theta = 4.0F};
    plan(1000);
    (void)proof();
    int32_t seen = 11;
    for (int16_t i = 0; i < answer.num_waypoints; i++) {
        if ((answer.waypoints[i].flags & AISLE_WAYPOINT_GOAL) != 0) {
            TEST_ASSERT_EQUAL_INT32(seen, answer.waypoints[i].goal_id);
            seen++;
        }
    }
    TEST_ASSERT_EQUAL_INT32(14, seen);
}

// Points lie only where the body can turn: sight must reach from end to end.
static void test_a_long_body_takes_an_aisle_its_disc_does_not_fit_if_its_sight_reaches_through(void) {
    static const double ends[2][2] = {{8.5, 11.5}, {6.0, 14.0}};
    hall_rectangle(1.6, 0.5, 0.05F);
    for (int i = 0; i < 2; i++) {
        hall_begin(20.0, 12.0);
        hall_add(ends[i][0], 0.0, ends[i][1], 5.6); // 0.8 m wide; the diagonal is 1.68 m
        hall_add(ends[i][0], 6.4, ends[i][1], 12.0);
        open_hall();
        ask(2.0, 6.0, 18.0, 6.0);
        plan(1000);
        if (i == 1) {
            refused_with(AISLE_STATUS_BUDGET, 0);
            request.options.step = 12.0F;
            plan(1000);
        }
        (void)proof();
        TEST_ASSERT_TRUE(answer.length < 16.5F);
    }
}

static void test_any_slicing_gives_the_same_bytes_and_units(void) {
    static uint8_t whole[AISLE_ROUTE_BYTES];
    static const uint32_t slices[] = {1, 33, 2500};
    two_aisles();
    add_mover(77, 10.0, 9.0, -0.5, 0.3);
    ask(2.0, 8.0, 18.0, 8.0);
    plan(UINT32_MAX);
    const size_t size = proof()->size;
    const uint32_t units = route.spent;
    memcpy(whole, aisle_route_answer(&route)->bytes, size);
    for (int i = 0; i < 3; i++) {
        plan(slices[i]);
        TEST_ASSERT_EQUAL_size_t(size, proof()->size);
        TEST_ASSERT_EQUAL_MEMORY(whole, aisle_route_answer(&route)->bytes, size);
        TEST_ASSERT_EQUAL_UINT32(units, route.spent);
    }
}

static void test_a_way_round_has_its_own_budget_or_the_requests_if_that_is_less(void) {
    ask(1.0, 1.0, 9.0, 1.0);
    for (int i = 0; i < 2; i++) {
        request.options.work_units = i == 0 ? 1000000 : 500;
        aisle_route_start(&route, &hall_layout, &hall_vehicle, &request, &head);
        aisle_route_go_round(&route, &movers, from_us, false);
        TEST_ASSERT_EQUAL_UINT32(i == 0 ? AISLE_ROUTE_ROUND_UNITS : 500U, route.budget);
    }
}

static void test_movers_are_forgotten_by_the_next_request(void) {
    two_aisles();
    add_mover(77, 10.0, 9.0, 0.0, 0.3);
    ask(2.0, 8.0, 18.0, 8.0);
    plan(1000);
    (void)proof();
    TEST_ASSERT_TRUE(answer.length > 16.5F);
    with_movers = false;
    plan(1000);
    (void)proof();
    TEST_ASSERT_TRUE(answer.length < 16.01F);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_a_query_leaves_a_pocket_by_the_local_swarm_in_all_seeds);
    RUN_TEST(test_what_stands_in_an_aisle_is_given_the_other_one_with_room_for_it_to_walk);
    RUN_TEST(test_where_there_is_less_room_less_is_kept);
    RUN_TEST(test_a_range_beyond_all_is_no_other_than_the_longest);
    RUN_TEST(test_any_heading_and_any_speed_are_borne);
    RUN_TEST(test_movers_are_seen_where_they_are_when_the_vehicle_is_at_the_start);
    RUN_TEST(test_movers_in_both_aisles_are_named);
    RUN_TEST(test_that_none_was_found_among_what_is_built_is_called_no_proof);
    RUN_TEST(test_a_vehicle_in_motion_goes_straight_on_before_it_bends);
    RUN_TEST(test_a_goal_straight_ahead_is_not_passed_in_order_to_go_straight_on);
    RUN_TEST(test_what_is_behind_is_turned_to_where_the_vehicle_is_not_driven_on_first);
    RUN_TEST(test_goals_are_visited_in_order_one_that_it_stands_at_included);
    RUN_TEST(test_a_long_body_takes_an_aisle_its_disc_does_not_fit_if_its_sight_reaches_through);
    RUN_TEST(test_any_slicing_gives_the_same_bytes_and_units);
    RUN_TEST(test_a_way_round_has_its_own_budget_or_the_requests_if_that_is_less);
    RUN_TEST(test_movers_are_forgotten_by_the_next_request);
    return UNITY_END();
}
