// Goals in any order, through the public door: which order, what is told, how a mission goes on.
#include "aisle/planner.h"

#include "door.h"

#include <stdio.h>

static aisle_pose_msg here;
static aisle_query_msg query;
static int32_t ids[AISLE_GOAL_LIST_MAX_GOALS];

// 12 x 8 m, a wall across the middle that is open at its left end, a disc of 0.3 m.
static void walled_hall(void) {
    hall_begin(12.0, 8.0);
    hall_add(1.5, 3.9, 12.0, 4.1);
}

static void goal(aisle_goal_msg *at, int32_t id, double x, double y) {
    *at = (aisle_goal_msg){.id = id, .x = x, .y = y, .tolerance_theta = 4.0F};
}

// From the lower right corner: by beelines 31 comes first, by true ways last.
static void ask_behind_the_wall(void) {
    query = door_query(1, 10.0, 3.0, 10.0, 5.0);
    query.options.objective = AISLE_OPTIONS_SHORTEST;
    query.ordering = AISLE_GOAL_LIST_ANY_ORDER;
    query.num_goals = 3;
    goal(&query.goals[0], 31, 10.0, 5.0);
    goal(&query.goals[1], 32, 3.0, 6.0);
    goal(&query.goals[2], 33, 6.0, 2.0);
}

static void use_disc(void) {
    hall_disc(0.3, 0.1F);
    door_config.vehicle = (aisle_vehicle_msg){.vehicle_revision = 1, .footprint_radius = 0.3F, .margin = 0.1F};
}

void setUp(void) {
    door_config = (aisle_config){.limits = {.cells = 65536U, .requests = 4U}, .boot_id = 77, .has_vehicle = true};
    use_disc();
    walled_hall();
    door_open(0);
    ask_behind_the_wall();
}
void tearDown(void) {}

static void take_hall(int32_t revision) {
    TEST_ASSERT_EQUAL(AISLE_OK, door_layout(revision));
    door_settle();
}

static int goals_passed(const aisle_path_msg *path) {
    int n = 0;
    for (int16_t i = 0; i < path->num_waypoints; i++) {
        if ((path->waypoints[i].flags & AISLE_WAYPOINT_GOAL) != 0) {
            TEST_ASSERT_LESS_THAN_INT(AISLE_GOAL_LIST_MAX_GOALS, n);
            ids[n++] = path->waypoints[i].goal_id;
        }
    }
    return n;
}

static void passed(const aisle_path_msg *path, int n, const int32_t *expected) {
    door_judge(path);
    TEST_ASSERT_EQUAL_INT(n, goals_passed(path));
    TEST_ASSERT_EQUAL_INT32_ARRAY(expected, ids, n);
}

static aisle_status_msg status_now(void) {
    aisle_status_msg status;
    aisle_planner_status(door, door_now, &status);
    return status;
}

// ---- missions from queries

static aisle_goal_list_msg list_of_query(int32_t revision) {
    aisle_goal_list_msg goals = door_goals(revision, 1.0, 1.0);
    goals.options = query.options;
    goals.ordering = query.ordering;
    goals.num_goals = query.num_goals;
    memcpy(goals.goals, query.goals, sizeof goals.goals);
    return goals;
}

static void go(const aisle_goal_list_msg *goals) {
    here = door_pose(10.0, 3.0, 0.0);
    TEST_ASSERT_EQUAL(AISLE_OK, door_submit(AISLE_INPUT_POSE, &here));
    TEST_ASSERT_EQUAL(AISLE_OK, door_submit(AISLE_INPUT_GOALS, goals));
    door_settle();
}

static void stand_at(double x, double y) {
    here.x = x;
    here.y = y;
    door_wait(50000, &here);
}

// ---- queries

static void test_the_order_goes_by_true_ways_where_beelines_mislead(void) {
    take_hall(1);
    passed(door_ask(&query), 3, (const int32_t[]){33, 32, 31});
    float best = door_reply.length;
    query.ordering = AISLE_GOAL_LIST_ORDERED; // as given, and by beelines: nearest first
    passed(door_ask(&query), 3, (const int32_t[]){31, 32, 33});
    TEST_ASSERT_TRUE(door_reply.length > best + 5.0F);
}

// Every order as an ORDERED query: none is shorter.
static void test_no_given_order_is_shorter(void) {
    static const int orders[24][4] = {
        {0, 1, 2, 3}, {0, 1, 3, 2}, {0, 2, 1, 3}, {0, 2, 3, 1}, {0, 3, 1, 2}, {0, 3, 2, 1}, {1, 0, 2, 3}, {1, 0, 3, 2},
        {1, 2, 0, 3}, {1, 2, 3, 0}, {1, 3, 0, 2}, {1, 3, 2, 0}, {2, 0, 1, 3}, {2, 0, 3, 1}, {2, 1, 0, 3}, {2, 1, 3, 0},
        {2, 3, 0, 1}, {2, 3, 1, 0}, {3, 0, 1, 2}, {3, 0, 2, 1}, {3, 1, 0, 2}, {3, 1, 2, 0}, {3, 2, 0, 1}, {3, 2, 1, 0}};
    hall_add(4.0, 1.0, 4.4, 2.9);
    hall_add(7.0, 5.0, 9.0, 7.5);
    take_hall(1);
    aisle_rng rng = aisle_rng_seed(12);
    for (int round = 0; round < 4; round++) {
        aisle_query_msg any = query;
        any.num_goals = 4;
        for (int i = 0; i < 4; i++) {
            aisle_vec2 p;
            do {
                p = uniform_point(&rng, aisle_vec2_of(0.5, 0.5), aisle_vec2_of(11.5, 7.5));
            } while (hall_disc_gap(p.x, p.y, 0.41) < 0.0L);
            goal(&any.goals[i], 40 + i, p.x, p.y);
        }
        float best = door_ask(&any)->length;
        door_judge(&door_reply);
        aisle_query_msg given = any;
        given.ordering = AISLE_GOAL_LIST_ORDERED;
        float least = INFINITY;
        for (int k = 0; k < 24; k++) {
            for (int i = 0; i < 4; i++) {
                given.goals[i] = any.goals[orders[k][i]];
            }
            least = fminf(least, door_ask(&given)->length);
        }
        TEST_ASSERT_FLOAT_WITHIN(2e-3F, least, best);
    }
}

static void test_the_searches_for_the_order_are_counted(void) {
    take_hall(1);
    const int64_t *counters = aisle_planner_counters(door);
    int64_t before = counters[AISLE_COUNTER_NODES];
    (void)door_ask(&query);
    const int64_t any = counters[AISLE_COUNTER_NODES] - before;
    TEST_ASSERT_EQUAL_INT(3, goals_passed(&door_reply));
    aisle_query_msg given = query;
    given.ordering = AISLE_GOAL_LIST_ORDERED;
    for (int i = 0; i < 3; i++) {
        given.goals[i] = query.goals[ids[i] - 31];
    }
    before = counters[AISLE_COUNTER_NODES];
    const float length = door_reply.length;
    TEST_ASSERT_EQUAL_FLOAT(length, door_ask(&given)->length); // the same legs
    TEST_ASSERT_TRUE(any > counters[AISLE_COUNTER_NODES] - before);
}

static void test_64_goals_are_all_passed_and_shorter_than_given(void) {
    take_hall(1);
    aisle_rng rng = aisle_rng_seed(2);
    query.num_goals = AISLE_GOAL_LIST_MAX_GOALS;
    for (int i = 0; i < AISLE_GOAL_LIST_MAX_GOALS; i++) {
        aisle_vec2 p;
        do {
            p = uniform_point(&rng, aisle_vec2_of(0.5, 0.5), aisle_vec2_of(11.5, 7.5));
        } while (hall_disc_gap(p.x, p.y, 0.41) < 0.0L);
        goal(&query.goals[i], 100 + i, p.x, p.y);
    }
    door_judge(door_ask(&query));
    TEST_ASSERT_EQUAL_INT(64, goals_passed(&door_reply));
    uint64_t seen = 0;
    for (int i = 0; i < 64; i++) {
        seen |= 1ULL << (ids[i] - 100);
    }
    TEST_ASSERT_EQUAL_UINT64(UINT64_MAX, seen);
    float best = door_reply.length;
    query.ordering = AISLE_GOAL_LIST_ORDERED;
    TEST_ASSERT_TRUE(door_ask(&query)->length > 3.0F * best);
}

static void test_goals_on_the_start_and_on_each_other_are_passed(void) {
    take_hall(1);
    query.num_goals = 4;
    goal(&query.goals[0], 31, 6.0, 2.0);
    goal(&query.goals[1], 32, 10.0, 3.0); // where it stands
    goal(&query.goals[2], 33, 3.0, 6.0);
    goal(&query.goals[3], 34, 6.0, 2.0);
    door_judge(door_ask(&query));
    TEST_ASSERT_EQUAL_INT(4, goals_passed(&door_reply));
    TEST_ASSERT_EQUAL_INT32(32, ids[0]);
    TEST_ASSERT_EQUAL_INT32(33, ids[3]);
}

static void test_any_slicing_gives_the_same_bytes(void) {
    take_hall(1);
    (void)door_ask(&query);
    static uint8_t whole[DOOR_LOG];
    size_t size = door_log_size;
    memcpy(whole, door_log, size);
    for (uint32_t slice = 1; slice < 3000; slice = slice * 9 + 4) {
        door_open(0);
        take_hall(1);
        door_units = slice;
        (void)door_ask(&query);
        TEST_ASSERT_EQUAL_size_t(size, door_log_size);
        TEST_ASSERT_EQUAL_MEMORY(whole, door_log, size);
    }
}

static void test_an_answer_remembered_passes_the_goals_in_its_order(void) {
    take_hall(1);
    passed(door_ask(&query), 3, (const int32_t[]){33, 32, 31});
    TEST_ASSERT_EQUAL(0, door_reply.cached);
    float length = door_reply.length;
    passed(door_ask(&query), 3, (const int32_t[]){33, 32, 31});
    TEST_ASSERT_EQUAL(1, door_reply.cached);
    TEST_ASSERT_EQUAL_FLOAT(length, door_reply.length);
    query.ordering = AISLE_GOAL_LIST_ORDERED; // another question
    passed(door_ask(&query), 3, (const int32_t[]){31, 32, 33});
    TEST_ASSERT_EQUAL(0, door_reply.cached);
}

static void test_a_mission_on_an_answer_remembered_goes_on_in_its_order(void) {
    take_hall(1);
    query.start.theta = 0.0;
    query.start.tolerance_theta = 0.0F; // as a pose starts
    passed(door_ask(&query), 3, (const int32_t[]){33, 32, 31});
    aisle_goal_list_msg goals = list_of_query(1);
    go(&goals);
    passed(&door_path, 3, (const int32_t[]){33, 32, 31});
    TEST_ASSERT_EQUAL(1, door_path.cached);
    TEST_ASSERT_EQUAL_INT32(33, status_now().goal_id);
    stand_at(6.0, 2.0);
    TEST_ASSERT_EQUAL_INT32(32, status_now().goal_id);
}

// ---- what cannot be

static void test_a_goal_that_no_way_leads_to_is_named_wherever_it_stands_in_the_list(void) {
    hall_add(8.0, 0.0, 8.2, 2.5); // a room about (10, 1)
    hall_add(8.0, 2.3, 12.0, 2.5);
    take_hall(1);
    int32_t units = 0;
    for (int at = 0; at < 3; at++) {
        ask_behind_the_wall();
        query.goals[at].x = 10.0;
        query.goals[at].y = 1.0;
        const aisle_path_msg *reply = door_ask(&query);
        TEST_ASSERT_EQUAL(AISLE_PATH_NONE, reply->status);
        TEST_ASSERT_EQUAL_INT16(AISLE_STATUS_NO_PATH, reply->cause);
        TEST_ASSERT_EQUAL_INT32(31 + at, reply->cause_id);
        TEST_ASSERT_EQUAL_INT32(31 + at, reply->waypoints[0].goal_id);
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, 10.0, reply->waypoints[0].x);
        units = at == 0 ? reply->work_units : units;
        TEST_ASSERT_INT32_WITHIN(units / 50, units, reply->work_units); // no other leg is planned before it
    }
}

static void test_a_goal_behind_a_gap_too_narrow_is_named_beside_the_gap(void) {
    hall_add(8.0, 0.0, 8.2, 3.3); // 0.6 m to the wall, 0.8 m are needed
    take_hall(1);
    goal(&query.start, 0, 4.0, 2.0);
    goal(&query.goals[0], 31, 2.0, 2.0);
    goal(&query.goals[1], 32, 10.0, 2.0);
    goal(&query.goals[2], 33, 6.0, 2.0);
    for (int ordering = AISLE_GOAL_LIST_ORDERED; ordering <= AISLE_GOAL_LIST_ANY_ORDER; ordering++) {
        query.ordering = (int8_t)ordering;
        const aisle_path_msg *reply = door_ask(&query);
        TEST_ASSERT_EQUAL_INT16(AISLE_STATUS_TOO_NARROW, reply->cause);
        TEST_ASSERT_EQUAL_INT32(32, reply->waypoints[0].goal_id);
        TEST_ASSERT_FLOAT_WITHIN(1e-3F, 0.6F, reply->cause_value);
    }
}

static void test_goals_occupied_or_outside_are_named(void) {
    take_hall(1);
    query.goals[1].x = 6.0;
    query.goals[1].y = 4.0; // in the wall
    TEST_ASSERT_EQUAL_INT16(AISLE_STATUS_GOAL_OCCUPIED, door_ask(&query)->cause);
    TEST_ASSERT_EQUAL_INT32(1, door_reply.cause_id);
    TEST_ASSERT_EQUAL_INT32(32, door_reply.waypoints[0].goal_id);
    query.goals[1].y = 9.0;
    TEST_ASSERT_EQUAL_INT16(AISLE_STATUS_GOAL_OUTSIDE, door_ask(&query)->cause);
    TEST_ASSERT_EQUAL_INT32(32, door_reply.cause_id);
    TEST_ASSERT_EQUAL_INT32(32, door_reply.waypoints[0].goal_id);
}

static void test_ids_that_nobody_could_tell_apart_are_refused(void) {
    take_hall(1);
    query.goals[2].id = query.goals[0].id;
    TEST_ASSERT_EQUAL(AISLE_PATH_NONE, door_ask(&query)->status);
    TEST_ASSERT_EQUAL_INT16(AISLE_STATUS_MALFORMED, door_reply.cause);
    TEST_ASSERT_EQUAL_INT32(31, door_reply.cause_id);
    query.ordering = AISLE_GOAL_LIST_ORDERED; // told apart by their order
    door_judge(door_ask(&query));
}

static void test_an_ordering_there_is_not_is_refused(void) {
    take_hall(1);
    for (int8_t ordering = -1; ordering <= 2; ordering = (int8_t)(ordering + 3)) {
        query.ordering = ordering;
        TEST_ASSERT_EQUAL_INT16(AISLE_STATUS_MALFORMED, door_ask(&query)->cause);
    }
}

static void test_a_budget_too_small_for_the_order_is_told_beside_the_path(void) {
    int flagged = 0;
    int whole = 0;
    take_hall(1);
    aisle_rng rng = aisle_rng_seed(8);
    query.num_goals = 20;
    for (int i = 0; i < 20; i++) {
        aisle_vec2 p;
        do {
            p = uniform_point(&rng, aisle_vec2_of(0.5, 0.5), aisle_vec2_of(11.5, 7.5));
        } while (hall_disc_gap(p.x, p.y, 0.41) < 0.0L);
        goal(&query.goals[i], 100 + i, p.x, p.y);
    }
    for (query.options.work_units = 1000; query.options.work_units < 1000000; query.options.work_units *= 2) {
        const aisle_path_msg *reply = door_ask(&query);
        TEST_ASSERT_LESS_OR_EQUAL_INT32(query.options.work_units + 4096, reply->work_units);
        if (reply->status == AISLE_PATH_OK) {
            bool is_flagged = reply->cause == AISLE_STATUS_BUDGET;
            TEST_ASSERT_TRUE(is_flagged ? (int32_t)reply->cause_value == query.options.work_units : reply->cause == 0);
            TEST_ASSERT_EQUAL_INT(20, goals_passed(reply));
            flagged += is_flagged ? 1 : 0;
            whole += is_flagged ? 0 : 1;
            TEST_ASSERT_TRUE(whole == 0 || !is_flagged); // more work never flags again
            door_reply.cause = 0;
            door_judge(&door_reply);
        } else {
            TEST_ASSERT_EQUAL_INT16(AISLE_STATUS_BUDGET, reply->cause);
        }
    }
    printf("budgets: %d orders cut, %d whole\n", flagged, whole);
    TEST_ASSERT_GREATER_THAN_INT(0, flagged);
    TEST_ASSERT_GREATER_THAN_INT(0, whole);
}

// ---- missions

static void test_a_mission_goes_on_by_goal_id_in_the_order_chosen(void) {
    take_hall(1);
    aisle_goal_list_msg goals = list_of_query(1);
    go(&goals);
    passed(&door_path, 3, (const int32_t[]){33, 32, 31});
    TEST_ASSERT_EQUAL_INT32(33, status_now().goal_id);
    stand_at(6.0, 2.0);
    TEST_ASSERT_EQUAL_INT32(32, status_now().goal_id);
    stand_at(3.0, 6.0);
    TEST_ASSERT_EQUAL_INT32(31, status_now().goal_id);
    stand_at(10.0, 5.0);
    TEST_ASSERT_EQUAL(AISLE_STATUS_IDLE, status_now().state);
    TEST_ASSERT_EQUAL(AISLE_OK, door_submit(AISLE_INPUT_GOALS, &goals)); // all of it was done: a duplicate
    TEST_ASSERT_EQUAL_INT64(1, aisle_planner_counters(door)[AISLE_COUNTER_DUPLICATES]);
    TEST_ASSERT_EQUAL(AISLE_STATUS_IDLE, status_now().state);
}

static void test_goals_reached_stay_reached_and_the_others_are_ordered_anew(void) {
    take_hall(1);
    aisle_goal_list_msg goals = list_of_query(1);
    go(&goals);
    stand_at(6.0, 2.0); // 33
    stand_at(10.0, 3.0);
    hall_begin(12.0, 8.0);
    hall_add(0.0, 3.9, 9.0, 4.1); // the wall is open at its right end now
    take_hall(2);
    passed(&door_path, 2, (const int32_t[]){31, 32});
    TEST_ASSERT_EQUAL_INT32(31, status_now().goal_id);
    TEST_ASSERT_EQUAL(AISLE_OK, door_submit(AISLE_INPUT_GOALS, &goals)); // as sent, still a duplicate
    TEST_ASSERT_EQUAL_INT64(1, aisle_planner_counters(door)[AISLE_COUNTER_DUPLICATES]);
    stand_at(10.0, 5.0);
    TEST_ASSERT_EQUAL_INT32(32, status_now().goal_id);
    stand_at(3.0, 6.0);
    TEST_ASSERT_EQUAL(AISLE_STATUS_IDLE, status_now().state);
}

static void test_a_list_with_equal_ids_is_refused_and_the_mission_goes_on(void) {
    take_hall(1);
    aisle_goal_list_msg goals = list_of_query(1);
    go(&goals);
    int before = door_paths;
    goals.goal_list_revision = 2;
    goals.goals[1].id = goals.goals[0].id;
    TEST_ASSERT_EQUAL(AISLE_ERR_DATA, door_submit(AISLE_INPUT_GOALS, &goals));
    door_settle();
    TEST_ASSERT_EQUAL_INT(before, door_paths);
    TEST_ASSERT_EQUAL(AISLE_STATUS_ACTIVE, status_now().state);
    TEST_ASSERT_EQUAL_INT16(AISLE_STATUS_MALFORMED, status_now().cause);
    TEST_ASSERT_EQUAL_INT32(31, status_now().cause_id);
    TEST_ASSERT_EQUAL_INT32(1, status_now().goal_list_revision);
    goals = list_of_query(2);
    goals.ordering = 7;
    TEST_ASSERT_EQUAL(AISLE_ERR_DATA, door_submit(AISLE_INPUT_GOALS, &goals));
    goals.num_goals = AISLE_GOAL_LIST_MAX_GOALS + 1;
    TEST_ASSERT_EQUAL(AISLE_ERR_DATA, door_submit(AISLE_INPUT_GOALS, &goals));
    TEST_ASSERT_EQUAL_INT16(AISLE_STATUS_LIMIT, status_now().cause);
    TEST_ASSERT_EQUAL(AISLE_STATUS_ACTIVE, status_now().state);
    goals.num_goals = 0; // to cancel, any ordering will do
    TEST_ASSERT_EQUAL(AISLE_OK, door_submit(AISLE_INPUT_GOALS, &goals));
    door_settle();
    TEST_ASSERT_EQUAL(AISLE_STATUS_IDLE, status_now().state);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_the_order_goes_by_true_ways_where_beelines_mislead);
    RUN_TEST(test_no_given_order_is_shorter);
    RUN_TEST(test_the_searches_for_the_order_are_counted);
    RUN_TEST(test_64_goals_are_all_passed_and_shorter_than_given);
    RUN_TEST(test_goals_on_the_start_and_on_each_other_are_passed);
    RUN_TEST(test_any_slicing_gives_the_same_bytes);
    RUN_TEST(test_an_answer_remembered_passes_the_goals_in_its_order);
    RUN_TEST(test_a_mission_on_an_answer_remembered_goes_on_in_its_order);
    RUN_TEST(test_a_goal_that_no_way_leads_to_is_named_wherever_it_stands_in_the_list);
    RUN_TEST(test_a_goal_behind_a_gap_too_narrow_is_named_beside_the_gap);
    RUN_TEST(test_goals_occupied_or_outside_are_named);
    RUN_TEST(test_ids_that_nobody_could_tell_apart_are_refused);
    RUN_TEST(test_an_ordering_there_is_not_is_refused);
    RUN_TEST(test_a_budget_too_small_for_the_order_is_told_beside_the_path);
    RUN_TEST(test_a_mission_goes_on_by_goal_id_in_the_order_chosen);
    RUN_TEST(test_goals_reached_stay_reached_and_the_others_are_ordered_anew);
    RUN_TEST(test_a_list_with_equal_ids_is_refused_and_the_mission_goes_on);
    return UNITY_END();
}
