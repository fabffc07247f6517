#include "plan/route.h"

#include "asked_route.h"

static void wall_hall(double gap) {
    slit_hall(gap);
    hall_open_route(&route, &hall_limits, 8000000U);
}

static void begin(int8_t objective) {
    route_ask(AISLE_OPTIONS_GA, 1.0, 1.0, 9.0, 1.0);
    request.options.objective = objective;
    route_begin_anew();
}

static void plan(int8_t objective, uint32_t slice) {
    begin(objective);
    route_finish(slice);
}

void setUp(void) {
    hall_disc(0.3, 0.05F);
}
void tearDown(void) {}

static void test_every_objective_is_answered_with_a_proved_path_of_its_name(void) {
    wall_hall(1.2);
    for (int8_t objective = AISLE_OPTIONS_SAFEST; objective <= AISLE_OPTIONS_PAPER; objective++) {
        plan(objective, 1000);
        (void)route_proof();
        TEST_ASSERT_EQUAL_INT8(AISLE_OPTIONS_GA, answer.planner);
        TEST_ASSERT_TRUE(route.barrier.ga.evals > 0U);
        TEST_ASSERT_EQUAL_DOUBLE(0.0, route.legs[0].tangent_radius); // no arcs but those of the way itself
    }
}

static void
test_bodies_with_a_heading_are_answered(void) { // from the seed alone where the turning disc does not fit along it
    hall_rectangle(1.0, 0.6, 0.05F);
    wall_hall(1.6);
    for (int8_t objective = AISLE_OPTIONS_SAFEST; objective <= AISLE_OPTIONS_LEAST_ENERGY; objective++) {
        plan(objective, 1000);
        (void)route_proof();
        TEST_ASSERT_TRUE(answer.planner == AISLE_OPTIONS_GA || answer.planner == AISLE_OPTIONS_ASTAR);
    }
}

static void test_any_slicing_gives_the_same_bytes(void) {
    static uint8_t first[AISLE_ROUTE_BYTES];
    wall_hall(1.2);
    for (uint32_t slice = 1000000; slice > 0U; slice /= 100U) {
        plan(AISLE_OPTIONS_SAFEST, slice);
        const aisle_proof *p = route_proof();
        if (slice == 1000000U) {
            memcpy(first, p->bytes, p->size);
        }
        TEST_ASSERT_EQUAL_MEMORY(first, p->bytes, p->size);
    }
}

static void test_no_way_is_told_with_its_proof(void) {
    wall_hall(0.5); // the disc needs 0.7
    plan(AISLE_OPTIONS_SHORTEST, 100000);
    route_refused(AISLE_STATUS_TOO_NARROW);
    plan(AISLE_OPTIONS_PAPER, 100000);
    route_refused(AISLE_STATUS_TOO_NARROW);
}

static void test_the_papers_form_that_finds_none_is_told_as_budget(void) {
    wall_hall(0.72); // its stations seldom lead through so little
    plan(AISLE_OPTIONS_PAPER, 100000);
    route_refused(AISLE_STATUS_BUDGET);
    TEST_ASSERT_EQUAL_INT32(11, request.goals[route.named].id);
}

// A bred way that cannot be proved, spoiled here while it is being proved: its seed's is the answer.
static void test_a_bred_way_that_is_disproved_gives_way_to_its_seed(void) {
    wall_hall(1.2);
    int spoiled = 0;
    begin(AISLE_OPTIONS_SHORTEST);
    while (aisle_route_step(&route, 1) != AISLE_OK) {
        if (route.stage == AISLE_ROUTE_VERIFY && route.legs[0].is_bred && spoiled == 0 &&
            route.verify.phase == AISLE_VERIFY_PHASE_MOTION) {
            aisle_waypoint_msg *w = &route.decoded->waypoints[route.decoded->num_waypoints - 2];
            w->x = 5.0, w->y = 1.0; // in the wall
            spoiled++;
        }
    }
    TEST_ASSERT_EQUAL_INT(1, spoiled);
    (void)route_proof();
    TEST_ASSERT_EQUAL_INT8(AISLE_OPTIONS_ASTAR, answer.planner);
    TEST_ASSERT_TRUE(route.is_unbred);
    const float length = answer.length;
    plan(AISLE_OPTIONS_SHORTEST, 1000);
    (void)route_proof();
    TEST_ASSERT_EQUAL_INT8(AISLE_OPTIONS_GA, answer.planner);
    TEST_ASSERT_FLOAT_WITHIN(1e-2F, length, answer.length);
}

static void test_the_papers_generations_are_num_samples(void) {
    const int16_t samples[] = {0, 7, 40};
    const uint32_t generations[] = {AISLE_BARRIER_GENERATIONS_PAPER, 7, 40};
    wall_hall(1.2);
    for (int i = 0; i < 3; i++) {
        begin(AISLE_OPTIONS_PAPER);
        route.request.options.num_samples = samples[i];
        while (aisle_route_step(&route, 1000) != AISLE_OK) {
        }
        TEST_ASSERT_EQUAL_UINT32(80U + generations[i] * 78U, route.barrier.ga.evals); // the best pair lives on
        TEST_ASSERT_EQUAL_UINT32(route.barrier.ga.evals, route.swarm_evals);
    }
}

// Where the budget ends in the breeding, the best so far is the way, and the answer says that it was cut.
static void test_breeding_leaves_enough_of_a_budget_to_prove_its_best(void) {
    wall_hall(1.2);
    plan(AISLE_OPTIONS_SAFEST, 1000);
    const uint32_t all = route.spent;
    uint32_t cut = 0;
    for (uint32_t budget = all / 16U; budget < all; budget += all / 16U) {
        route_ask(AISLE_OPTIONS_GA, 1.0, 1.0, 9.0, 1.0);
        request.options.work_units = (int32_t)budget;
        route_begin_anew();
        route_finish(1000);
        TEST_ASSERT_TRUE(route.spent <= budget + 4096U);
        if (aisle_route_answer(&route) == NULL) {
            TEST_ASSERT_EQUAL_INT16(AISLE_STATUS_BUDGET, route.cause.cause);
            continue;
        }
        (void)route_answer();
        cut += answer.planner == AISLE_OPTIONS_GA && answer.cause == AISLE_STATUS_BUDGET ? 1U : 0U;
        answer.cause = 0;
        (void)door_judge(&answer);
    }
    TEST_ASSERT_GREATER_THAN_UINT32(0, cut);
}

// The paper's form knows no proved bound but the beeline, and no headings but those asked for.
static void test_the_papers_way_keeps_the_headings_asked_for(void) {
    hall_rectangle(0.6, 0.4, 0.05F);
    wall_hall(1.6);
    for (int k = 0; k < 4; k++) {
        route_ask(AISLE_OPTIONS_GA, 1.0, 1.0, 9.0, 1.0);
        request.options.objective = AISLE_OPTIONS_PAPER;
        request.start.theta = 1.5 * k - 2.0;
        request.goals[0].theta = 2.0 - 1.5 * k;
        request.start.tolerance_theta = request.goals[0].tolerance_theta = 0.01F;
        route_begin_anew();
        route_finish(1000);
        (void)route_proof();
        TEST_ASSERT_EQUAL_INT8(AISLE_OPTIONS_GA, answer.planner);
        TEST_ASSERT_DOUBLE_WITHIN(1e-2, request.start.theta, answer.waypoints[0].theta);
        TEST_ASSERT_DOUBLE_WITHIN(1e-2, request.goals[0].theta, answer.waypoints[answer.num_waypoints - 1].theta);
        TEST_ASSERT_FLOAT_WITHIN(1e-3F, 8.0F, answer.length_bound);
    }
}

// Through places where it is already, the last among them.
static void test_the_papers_way_visits_several_goals(void) {
    const double places[5][2] = {{1.0, 1.0}, {9.0, 1.0}, {9.0, 1.0}, {1.0, 5.0}, {1.0, 5.0}};
    wall_hall(1.6);
    route_ask(AISLE_OPTIONS_GA, 1.0, 1.0, 9.0, 1.0);
    request.options.objective = AISLE_OPTIONS_PAPER;
    request.options.num_samples = 200;
    request.num_goals = 5;
    for (int k = 0; k < 5; k++) {
        request.goals[k] =
            (aisle_goal_msg){.id = 11 + k, .x = places[k][0], .y = places[k][1], .tolerance_theta = 4.0F};
    }
    route_begin_anew();
    route_finish(1000);
    (void)route_proof();
    int passed = 0;
    for (int16_t i = 0; i < answer.num_waypoints; i++) {
        const aisle_waypoint_msg *w = &answer.waypoints[i];
        if ((w->flags & AISLE_WAYPOINT_GOAL) != 0) {
            TEST_ASSERT_EQUAL_INT32(11 + passed, w->goal_id);
            TEST_ASSERT_DOUBLE_WITHIN(1e-6, places[passed][0], w->x);
            TEST_ASSERT_DOUBLE_WITHIN(1e-6, places[passed][1], w->y);
            passed++;
        }
    }
    TEST_ASSERT_EQUAL_INT(5, passed);
}

// An opening that the body passes along its way, but the disc in which it turns does not: what the grid finds is bred all
// the same, by the body's own sweeps.
static void test_a_body_s_way_is_bred_where_it_cannot_turn(void) {
    uint32_t bred = 0;
    hall_rectangle(1.0, 0.6, 0.05F);
    hall_begin(10.0, 6.0);
    hall_add(4.75, -0.5, 5.25, 2.5);
    hall_add(4.75, 3.5, 5.25, 6.5);
    hall_open_route(&route, &hall_limits, 8000000U);
    route_ask(AISLE_OPTIONS_GA, 1.0, 2.0, 9.0, 2.0);
    request.options.objective = AISLE_OPTIONS_SAFEST;
    route_begin_anew();
    while (aisle_route_step(&route, 1) != AISLE_OK) {
        bred += route.stage == AISLE_ROUTE_GA && route.space.mode == AISLE_SPACE_ALONG ? 1U : 0U;
    }
    (void)route_proof();
    TEST_ASSERT_EQUAL_INT8(AISLE_OPTIONS_GA, answer.planner);
    TEST_ASSERT_GREATER_THAN_UINT32(10, bred);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_every_objective_is_answered_with_a_proved_path_of_its_name);
    RUN_TEST(test_bodies_with_a_heading_are_answered);
    RUN_TEST(test_any_slicing_gives_the_same_bytes);
    RUN_TEST(test_no_way_is_told_with_its_proof);
    RUN_TEST(test_the_papers_form_that_finds_none_is_told_as_budget);
    RUN_TEST(test_a_bred_way_that_is_disproved_gives_way_to_its_seed);
    RUN_TEST(test_the_papers_generations_are_num_samples);
    RUN_TEST(test_breeding_leaves_enough_of_a_budget_to_prove_its_best);
    RUN_TEST(test_the_papers_way_keeps_the_headings_asked_for);
    RUN_TEST(test_the_papers_way_visits_several_goals);
    RUN_TEST(test_a_body_s_way_is_bred_where_it_cannot_turn);
    return UNITY_END();
}
