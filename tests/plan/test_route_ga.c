#include "plan/route.h"

#include "door.h"
#include "hall_route.h"

static aisle_route route;
static aisle_request request;
static aisle_path_msg head;
static aisle_path_msg answer;

// A wall with one opening, `gap` wide.
static void wall_hall(double gap) {
    hall_begin(10.0, 6.0);
    hall_add(4.75, -0.5, 5.25, 4.2 - 0.5 * gap);
    hall_add(4.75, 4.2 + 0.5 * gap, 5.25, 6.5);
    hall_open_route(&route, &hall_limits, 8000000U);
}

static void plan(int8_t objective, uint32_t slice) {
    request = (aisle_request){.is_query = true, .query_id = 5, .map_id = 1, .num_goals = 1};
    request.options = (aisle_options_msg){.planner = AISLE_OPTIONS_GA, .objective = objective};
    request.start = (aisle_goal_msg){.x = 1.0, .y = 1.0, .tolerance_theta = 4.0F};
    request.goals[0] = (aisle_goal_msg){.id = 11, .x = 9.0, .y = 1.0, .tolerance_theta = 4.0F};
    head = (aisle_path_msg){.boot_id = 3, .path_revision = 8, .utime = 100, .t0_utime = 100};
    aisle_route_start(&route, &hall_layout, &hall_vehicle, &request, &head);
    route.forgetful = true;
    route.stage = AISLE_ROUTE_CHECK;
    while (aisle_route_step(&route, slice) != AISLE_OK) {
    }
}

static const aisle_proof *proof(void) {
    const aisle_proof *proof = aisle_route_answer(&route);
    TEST_ASSERT_NOT_NULL(proof);
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_msg_decode(AISLE_MSG_PATH, proof->bytes, proof->size, &answer, NULL));
    (void)door_judge(&answer);
    return proof;
}

void setUp(void) {
    hall_disc(0.3, 0.05F);
}
void tearDown(void) {}

static void test_every_objective_is_answered_with_a_proved_path_of_its_name(void) {
    wall_hall(1.2);
    for (int8_t objective = AISLE_OPTIONS_SAFEST; objective <= AISLE_OPTIONS_PAPER; objective++) {
        plan(objective, 1000);
        (void)proof();
        TEST_ASSERT_EQUAL_INT8(AISLE_OPTIONS_GA, answer.planner);
        TEST_ASSERT_TRUE(route.barrier.ga.evals > 0U);
    }
}

static void
test_bodies_with_a_heading_are_answered(void) { // from the seed alone where the turning disc does not fit along it
    hall_rectangle(1.0, 0.6, 0.05F);
    wall_hall(1.6);
    for (int8_t objective = AISLE_OPTIONS_SAFEST; objective <= AISLE_OPTIONS_LEAST_ENERGY; objective++) {
        plan(objective, 1000);
        (void)proof();
        TEST_ASSERT_TRUE(answer.planner == AISLE_OPTIONS_GA || answer.planner == AISLE_OPTIONS_ASTAR);
    }
}

static void test_any_slicing_gives_the_same_bytes(void) {
    static uint8_t first[AISLE_ROUTE_BYTES];
    wall_hall(1.2);
    for (uint32_t slice = 1000000; slice > 0U; slice /= 100U) {
        plan(AISLE_OPTIONS_SAFEST, slice);
        const aisle_proof *p = proof();
        if (slice == 1000000U) {
            memcpy(first, p->bytes, p->size);
        }
        TEST_ASSERT_EQUAL_MEMORY(first, p->bytes, p->size);
    }
}

static void test_no_way_is_told_with_its_proof(void) {
    wall_hall(0.5); // the disc needs 0.7
    plan(AISLE_OPTIONS_SHORTEST, 100000);
    TEST_ASSERT_NULL(aisle_route_answer(&route));
    TEST_ASSERT_EQUAL_INT16(AISLE_STATUS_TOO_NARROW, route.cause.cause);
    plan(AISLE_OPTIONS_PAPER, 100000);
    TEST_ASSERT_NULL(aisle_route_answer(&route));
    TEST_ASSERT_EQUAL_INT16(AISLE_STATUS_TOO_NARROW, route.cause.cause);
}

static void test_the_papers_form_that_finds_none_is_told_as_budget(void) {
    wall_hall(0.72); // its stations seldom lead through so little
    plan(AISLE_OPTIONS_PAPER, 100000);
    TEST_ASSERT_NULL(aisle_route_answer(&route));
    TEST_ASSERT_EQUAL_INT16(AISLE_STATUS_BUDGET, route.cause.cause);
    TEST_ASSERT_EQUAL_INT32(11, request.goals[route.named].id);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_every_objective_is_answered_with_a_proved_path_of_its_name);
    RUN_TEST(test_bodies_with_a_heading_are_answered);
    RUN_TEST(test_any_slicing_gives_the_same_bytes);
    RUN_TEST(test_no_way_is_told_with_its_proof);
    RUN_TEST(test_the_papers_form_that_finds_none_is_told_as_budget);
    return UNITY_END();
}
