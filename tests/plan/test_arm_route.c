#include "plan/arm_route.h" // first: proves that the header stands alone

#include "arm_hall.h"

enum { NODES = 2048, BUDGET = 2000000, FINE = 500 };

static aisle_arm_route route;
static aisle_arm_request request;

void setUp(void) {
    arm_hall_begin();
    memset(&request, 0, sizeof request);
    request.pose = arm_pose;
    request.goal = (aisle_arm_goal_msg){.arm_goal_id = 5, .kind = AISLE_ARM_GOAL_JOINTS};
    request.goal.q_start[0] = -0.9F;
    request.goal.q[0] = 0.9F;
}
void tearDown(void) {}

static void open_hall(void) {
    aisle_arena arena = arm_hall_open(64U);
    memset(&route, 0, sizeof route);
    aisle_arm_route_carve(&route, &arena, NODES);
    TEST_ASSERT_FALSE(arena.overflow);
    arm_vehicle.revision = 1;
}

// The head as the planner fills it; the answer is route's.
static void ask(uint32_t units) {
    memset(route.path, 0, sizeof *route.path);
    route.path->map_id = route.path->map_revision = route.path->vehicle_revision = 1;
    aisle_arm_route_start(&route, &hall_layout, &arm_vehicle, &arm_msg, &request, BUDGET);
    while (aisle_arm_route_step(&route, units) == AISLE_BUSY) {
    }
}

static void assert_cause(int16_t cause, int32_t id) {
    ask(100000);
    TEST_ASSERT_EQUAL_size_t(0, route.size);
    TEST_ASSERT_EQUAL_INT16(cause, route.cause.cause);
    TEST_ASSERT_EQUAL_INT32(id, route.cause.id);
}

// The answer moves from start to goal without touching anything, by the judge; returns its travel.
static double assert_motion(void) {
    static aisle_arm_path_msg path;
    double travel = 0.0;
    TEST_ASSERT_GREATER_THAN_size_t(0, route.size);
    TEST_ASSERT_EQUAL_UINT32(route.size, route.stamp.size);
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_msg_decode(AISLE_MSG_ARM_PATH, route.bytes, route.size, &path, NULL));
    for (int i = 1; i < path.num_waypoints; i++) {
        const aisle_arm_waypoint_msg *a = &path.waypoints[i - 1], *b = &path.waypoints[i];
        const double h = (double)b->t - (double)a->t;
        for (int k = 0; k <= 20; k++) {
            const double u = k / 20.0, w = 1.0 - u;
            double q[3];
            for (int j = 0; j < 3; j++) {
                q[j] = (double)a->q[j] * w * w * w * (1.0 + 3.0 * u + 6.0 * u * u) +
                       h * (double)a->qd[j] * w * w * w * u * (1.0 + 3.0 * u) +
                       0.5 * h * h * (double)a->qdd[j] * w * w * w * u * u +
                       (double)b->q[j] * u * u * u * (1.0 + 3.0 * w + 6.0 * w * w) -
                       h * (double)b->qd[j] * u * u * u * w * (1.0 + 3.0 * w) +
                       0.5 * h * h * (double)b->qdd[j] * u * u * u * w * w;
            }
            TEST_ASSERT_TRUE(arm_judged(q) > 0.0);
            TEST_ASSERT_EQUAL_UINT32(0, aisle_arm_joint_out(&arm, q, 1e-6));
        }
        for (int j = 0; j < 3; j++) {
            travel += fabs((double)b->q[j] - (double)a->q[j]);
        }
    }
    for (int j = 0; j < 3; j++) {
        TEST_ASSERT_FLOAT_WITHIN(1e-6F, request.goal.q_start[j], path.waypoints[0].q[j]);
        TEST_ASSERT_FLOAT_WITHIN(1e-6F, request.goal.q[j], path.waypoints[path.num_waypoints - 1].q[j]);
    }
    return travel;
}

static void test_a_straight_way_that_is_free_is_taken_as_it_is(void) {
    open_hall();
    request.goal.options.objective = AISLE_OPTIONS_SHORTEST;
    ask(100000);
    TEST_ASSERT_EQUAL_INT8(AISLE_OPTIONS_AUTO, route.path->planner);
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, 1.8, assert_motion());
}
static void test_round_an_obstacle_a_bent_piece_is_found(void) {
    hall_add(6.55, 4.95, 6.65, 5.05);
    open_hall();
    ask(100000);
    TEST_ASSERT_EQUAL_INT8(AISLE_OPTIONS_GA, route.path->planner);
    TEST_ASSERT_EQUAL_INT16(1 + (int)AISLE_ARM_STEPS, route.path->num_waypoints);
    TEST_ASSERT_TRUE(assert_motion() > 1.9);
}
static void test_every_planner_named_is_the_one_that_answers(void) {
    static const int8_t planners[] = {AISLE_OPTIONS_GA,       AISLE_OPTIONS_PSO,
                                      AISLE_OPTIONS_RRT,      AISLE_OPTIONS_RRT_ADAPTIVE,
                                      AISLE_OPTIONS_RRT_STAR, AISLE_OPTIONS_RRT_STAR_ADAPTIVE};
    hall_add(6.55, 4.95, 6.65, 5.05);
    open_hall();
    for (size_t i = 0; i < sizeof planners; i++) {
        request.goal.options.planner = planners[i];
        ask(100000);
        TEST_ASSERT_EQUAL_INT8(planners[i], route.path->planner);
        (void)assert_motion();
    }
}
static void test_where_no_bend_gets_by_the_tree_does(void) {
    hall_add(6.12, 4.9, 6.8, 4.98); // a shelf: links must be folded up to get by before it
    request.goal.q_start[0] = -0.55F;
    request.goal.q[0] = 0.4F;
    open_hall();
    ask(100000);
    TEST_ASSERT_EQUAL_INT8(AISLE_OPTIONS_RRT_STAR_ADAPTIVE, route.path->planner);
    TEST_ASSERT_EQUAL_INT(1, route.path->num_waypoints % (int)AISLE_ARM_STEPS_STRAIGHT);
    (void)assert_motion();
    request.goal.options.planner = AISLE_OPTIONS_GA; // alone it does not
    assert_cause(AISLE_STATUS_BUDGET, 5);
}
static void test_the_papers_search_sets_the_duration_too(void) {
    open_hall();
    request.goal.options.objective = AISLE_OPTIONS_PAPER;
    for (int32_t seed = 0; seed < 6; seed++) {
        request.goal.options.seed = seed;
        ask(100000);
        (void)assert_motion();
        TEST_ASSERT_EQUAL_INT8(AISLE_OPTIONS_GA, route.path->planner);
        TEST_ASSERT_GREATER_THAN_UINT32(19000U, route.time->ga.evals);
        aisle_arm_timing exact;
        aisle_arm_least_duration(&arm, &route.dynamics, &route.plan->piece[0], AISLE_ARM_TIMING_PANELS, &exact);
        TEST_ASSERT_DOUBLE_WITHIN(2e-3 * exact.duration, exact.duration, (double)route.path->duration);
        TEST_ASSERT_TRUE((double)route.path->duration >= exact.duration * (1.0 - 1e-6)); // it was proved
    }
    request.goal.options.planner = AISLE_OPTIONS_RRT; // of a tree's pieces as well
    hall_add(6.55, 4.95, 6.65, 5.05);
    open_hall();
    ask(100000);
    (void)assert_motion();
    TEST_ASSERT_GREATER_THAN_UINT32(1U, route.plan->count);
    TEST_ASSERT_EQUAL_UINT32(route.plan->count, route.timed);
}
static void test_a_budget_is_kept_and_told(void) {
    hall_add(6.12, 4.9, 6.8, 4.98);
    request.goal.q_start[0] = -0.55F;
    request.goal.q[0] = 0.4F;
    request.goal.options.work_units = 3000;
    open_hall();
    assert_cause(AISLE_STATUS_BUDGET, 5);
    TEST_ASSERT_TRUE(route.spent >= 3000U && route.spent < 3000U + 2000U);
}
static void test_of_several_configurations_one_that_is_free_is_taken(void) {
    static aisle_arm_path_msg path;
    request.goal.q_start[0] = 0.0F;
    request.goal.kind = AISLE_ARM_GOAL_POSE;
    request.goal.x = 6.2;
    request.goal.y = 5.0;
    hall_add(5.85, 5.12, 6.0, 5.4); // where one of the elbows would be
    open_hall();
    ask(100000);
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_msg_decode(AISLE_MSG_ARM_PATH, route.bytes, route.size, &path, NULL));
    const aisle_arm_waypoint_msg *last = &path.waypoints[path.num_waypoints - 1];
    TEST_ASSERT_TRUE(last->q[0] < 0.0F && last->q[1] > 0.0F); // the elbow is below
    hall_add(5.85, 4.6, 6.0, 4.88);                           // and the other one
    open_hall();
    assert_cause(AISLE_STATUS_GOAL_OCCUPIED, 2);
}
static void test_any_cut_of_the_work_gives_the_same_bytes(void) {
    static uint8_t whole[AISLE_ARM_PATH_BYTES];
    hall_add(6.12, 4.9, 6.8, 4.98);
    request.goal.q_start[0] = -0.55F;
    request.goal.q[0] = 0.4F;
    open_hall();
    ask(UINT32_MAX);
    const size_t size = route.size;
    memcpy(whole, route.bytes, size);
    ask(1);
    TEST_ASSERT_EQUAL_size_t(size, route.size);
    TEST_ASSERT_EQUAL_MEMORY(whole, route.bytes, size);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_a_straight_way_that_is_free_is_taken_as_it_is);
    RUN_TEST(test_round_an_obstacle_a_bent_piece_is_found);
    RUN_TEST(test_every_planner_named_is_the_one_that_answers);
    RUN_TEST(test_where_no_bend_gets_by_the_tree_does);
    RUN_TEST(test_the_papers_search_sets_the_duration_too);
    RUN_TEST(test_a_budget_is_kept_and_told);
    RUN_TEST(test_of_several_configurations_one_that_is_free_is_taken);
    RUN_TEST(test_any_cut_of_the_work_gives_the_same_bytes);
    return UNITY_END();
}
