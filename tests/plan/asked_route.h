// asked_route.h - test fixture: one route over hall.h's hall, a question to it, its answer judged by door.h.
#ifndef AISLE_TESTS_ASKED_ROUTE_H
#define AISLE_TESTS_ASKED_ROUTE_H

#include "door.h"
#include "hall_route.h"

static aisle_route route;
static aisle_request request;
static aisle_path_msg head, answer;

// 10 x 6 m, a wall across it with one slit, `gap` wide, about y = 4.2; not open yet.
HALL_UNUSED void slit_hall(double gap) {
    hall_begin(10.0, 6.0);
    hall_add(4.75, -0.5, 5.25, 4.2 - 0.5 * gap);
    hall_add(4.75, 4.2 + 0.5 * gap, 5.25, 6.5);
}

// One goal, id 11, headings free; all options but the planner are 0.
HALL_UNUSED void route_ask(int8_t planner, double x0, double y0, double x1, double y1) {
    request = (aisle_request){.is_query = true, .query_id = 5, .map_id = 1, .num_goals = 1};
    request.options.planner = planner;
    request.start = (aisle_goal_msg){.x = x0, .y = y0, .tolerance_theta = 4.0F};
    request.goals[0] = (aisle_goal_msg){.id = 11, .x = x1, .y = y1, .tolerance_theta = 4.0F};
}

// Takes the request up.
HALL_UNUSED void route_begin(void) {
    head = (aisle_path_msg){.boot_id = 3, .path_revision = 8, .utime = 100, .t0_utime = 100};
    aisle_route_start(&route, &hall_layout, &hall_vehicle, &request, &head);
}

// Takes it up past the memory of answers.
HALL_UNUSED void route_begin_anew(void) {
    route_begin();
    route.forgetful = true;
    route.stage = AISLE_ROUTE_CHECK;
}

HALL_UNUSED void route_finish(uint32_t slice) {
    while (aisle_route_step(&route, slice) != AISLE_OK) {
    }
}

// The answer, decoded; fails where there is none.
HALL_UNUSED const aisle_proof *route_answer(void) {
    const aisle_proof *proof = aisle_route_answer(&route);
    TEST_ASSERT_NOT_NULL(proof);
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_msg_decode(AISLE_MSG_PATH, proof->bytes, proof->size, &answer, NULL));
    return proof;
}

// And judged.
HALL_UNUSED const aisle_proof *route_proof(void) {
    const aisle_proof *proof = route_answer();
    (void)door_judge(&answer);
    return proof;
}

HALL_UNUSED void route_refused(int16_t cause) {
    TEST_ASSERT_NULL(aisle_route_answer(&route));
    TEST_ASSERT_EQUAL_INT16(cause, route.cause.cause);
}
#endif
