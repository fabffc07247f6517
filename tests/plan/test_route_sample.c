#include "plan/route.h"

#include "asked_route.h"

enum { SEEDS = 5, PLANNERS = 4 };

static const int8_t planners[PLANNERS] = {AISLE_OPTIONS_RRT, AISLE_OPTIONS_RRT_ADAPTIVE, AISLE_OPTIONS_RRT_STAR,
                                          AISLE_OPTIONS_RRT_STAR_ADAPTIVE};

static void open_hall(void) {
    hall_open_route(&route, &hall_limits, 2000000U);
}

static void open_slit_hall(double gap) {
    slit_hall(gap);
    open_hall();
}

static void ask(int8_t planner) {
    route_ask(planner, 1.0, 1.0, 9.0, 1.0);
    request.options.objective = AISLE_OPTIONS_SHORTEST;
}

static void plan(uint32_t slice) {
    route_begin_anew();
    route_finish(slice);
}

static const aisle_proof *proof(int16_t cause) {
    const aisle_proof *proof = route_answer();
    TEST_ASSERT_EQUAL_INT16(cause, answer.cause);
    answer.cause = 0;
    (void)door_judge(&answer);
    TEST_ASSERT_EQUAL_INT8(request.options.planner, answer.planner);
    return proof;
}

void setUp(void) {
    hall_disc(0.3, 0.05F);
}
void tearDown(void) {}

static void test_each_planner_answers_with_a_proved_path_of_its_name(void) {
    open_slit_hall(0.8);
    for (int i = 0; i < PLANNERS; i++) {
        for (int8_t objective = AISLE_OPTIONS_SAFEST; objective <= AISLE_OPTIONS_LEAST_ENERGY; objective++) {
            ask(planners[i]);
            request.options.objective = objective;
            plan(1000);
            (void)proof(0);
            TEST_ASSERT_TRUE(route.nodes > 0);
        }
    }
}

static void test_an_adaptive_planner_gets_through_a_slit_with_any_step(void) { // 5 of 5 seeds for each
    open_slit_hall(0.73);
    for (int32_t seed = 1; seed <= SEEDS; seed++) {
        for (int i = 1; i < PLANNERS; i += 2) {
            ask(planners[i]);
            request.options.seed = seed;
            request.options.step = 4.0F;
            plan(100000);
            (void)proof(0);
        }
    }
}

static void test_in_the_papers_form_a_fixed_step_fails_and_the_adaptive_one_does_not(void) { // 0 and 5 of 5 seeds
    open_slit_hall(0.77);
    for (int32_t seed = 1; seed <= SEEDS; seed++) {
        for (int i = 0; i < 2; i++) {
            ask(planners[i]);
            request.options.objective = AISLE_OPTIONS_PAPER;
            request.options.seed = seed;
            request.options.step = 6.0F;
            plan(100000);
            if (i == 1) {
                (void)proof(0);
            } else {
                TEST_ASSERT_NULL(aisle_route_answer(&route));
                TEST_ASSERT_EQUAL_INT16(AISLE_STATUS_BUDGET, route.cause.cause);
                TEST_ASSERT_EQUAL_INT32(11, request.goals[route.named].id);
            }
        }
    }
}

static void test_bodies_with_a_heading_and_cars_are_driven_as_they_can(void) {
    for (int car = 0; car < 2; car++) {
        hall_rectangle(1.0, 0.6, 0.05F);
        hall_vehicle.curvature_max = car != 0 ? 1.0 : 0.0;
        open_slit_hall(1.4);
        for (int i = 0; i < PLANNERS; i++) {
            ask(planners[i]);
            request.start.tolerance_theta = request.goals[0].tolerance_theta = 0.1F;
            request.goals[0].theta = -1.5;
            plan(1000);
            (void)proof(0);
            TEST_ASSERT_DOUBLE_WITHIN(0.1, -1.5, answer.waypoints[answer.num_waypoints - 1].theta);
        }
    }
}

// A rack hall of which the search for a manoeuvre gives up: two stops close by what is there.
static void test_auto_asks_an_adaptive_tree_where_nothing_else_finds_a_way(void) {
    hall_rectangle(1.8, 0.9, 0.05F);
    hall_begin(20.0, 14.0);
    const double left[4] = {3.26, 7.62, 11.98, 16.34};
    for (int i = 0; i < 4; i++) {
        hall_add(left[i], 3.28, left[i] + 1.1, 10.72);
    }
    open_hall();
    ask(AISLE_OPTIONS_AUTO);
    request.start = (aisle_goal_msg){.x = 7.5, .y = 13.45, .theta = 3.141592653589793};
    request.goals[0] = (aisle_goal_msg){.id = 11, .x = 11.0, .y = 3.85, .theta = 1.5707963267948966};
    plan(1000);
    request.options.planner = AISLE_OPTIONS_RRT_ADAPTIVE; // as it is told
    (void)proof(0);
    request.options.planner = AISLE_OPTIONS_ASTAR; // asks none
    plan(1000);
    TEST_ASSERT_NULL(aisle_route_answer(&route));
    TEST_ASSERT_EQUAL_INT16(AISLE_STATUS_KINEMATIC, route.cause.cause);
}

static void test_several_goals_and_one_where_the_leg_begins(void) {
    open_slit_hall(0.8);
    for (int i = 0; i < PLANNERS; i++) {
        ask(planners[i]);
        request.num_goals = 3;
        request.goals[1] = request.goals[0];
        request.goals[1].id = 12;
        request.goals[2] = (aisle_goal_msg){.id = 13, .x = 1.0, .y = 5.0, .tolerance_theta = 4.0F};
        plan(1000);
        (void)proof(0);
    }
}

static void test_the_same_seed_gives_the_same_bytes_however_it_is_cut(void) {
    static uint8_t bytes[AISLE_ROUTE_BYTES];
    open_slit_hall(0.8);
    for (int i = 0; i < PLANNERS; i++) {
        ask(planners[i]);
        plan(UINT32_MAX / 2U);
        const aisle_proof *whole = proof(0);
        const size_t size = whole->size;
        memcpy(bytes, whole->bytes, size);
        plan(7);
        TEST_ASSERT_EQUAL_size_t(size, proof(0)->size);
        TEST_ASSERT_EQUAL_MEMORY(bytes, proof(0)->bytes, size);
        request.options.seed = 77;
        plan(1000);
        TEST_ASSERT_TRUE(proof(0)->size != size || memcmp(bytes, proof(0)->bytes, size) != 0);
    }
}

static void test_a_star_cut_short_by_the_budget_gives_the_best_path_so_far_and_says_so(void) {
    open_slit_hall(1.2);
    ask(AISLE_OPTIONS_RRT_STAR);
    request.options.work_units = 6000;
    plan(500);
    (void)proof(AISLE_STATUS_BUDGET);
    TEST_ASSERT_TRUE(route.spent <= 6000U);
}

static void test_a_closed_hall_is_refused_with_a_proof(void) {
    hall_begin(10.0, 6.0);
    hall_add(4.75, 0.0, 5.25, 6.0);
    open_hall();
    ask(AISLE_OPTIONS_RRT_ADAPTIVE);
    request.options.work_units = 400000;
    plan(10000);
    TEST_ASSERT_NULL(aisle_route_answer(&route));
    TEST_ASSERT_EQUAL_INT16(AISLE_STATUS_NO_PATH, route.cause.cause);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_each_planner_answers_with_a_proved_path_of_its_name);
    RUN_TEST(test_an_adaptive_planner_gets_through_a_slit_with_any_step);
    RUN_TEST(test_in_the_papers_form_a_fixed_step_fails_and_the_adaptive_one_does_not);
    RUN_TEST(test_bodies_with_a_heading_and_cars_are_driven_as_they_can);
    RUN_TEST(test_auto_asks_an_adaptive_tree_where_nothing_else_finds_a_way);
    RUN_TEST(test_several_goals_and_one_where_the_leg_begins);
    RUN_TEST(test_the_same_seed_gives_the_same_bytes_however_it_is_cut);
    RUN_TEST(test_a_star_cut_short_by_the_budget_gives_the_best_path_so_far_and_says_so);
    RUN_TEST(test_a_closed_hall_is_refused_with_a_proof);
    return UNITY_END();
}
