#include "arm_door.h"

void setUp(void) {
    door_prepare();
}
void tearDown(void) {}

static void test_a_goal_of_a_place_is_answered_with_a_motion_to_it(void) {
    door_open();
    door_ask(100000);
    TEST_ASSERT_EQUAL_INT8(AISLE_PATH_OK, door_path.status);
    TEST_ASSERT_EQUAL_INT32(1, door_path.path_revision);
    TEST_ASSERT_EQUAL_INT32(1, door_path.map_revision);
    TEST_ASSERT_EQUAL_INT32(1, door_path.vehicle_revision);
    TEST_ASSERT_EQUAL_INT64(door_now, door_path.t0_utime);
    TEST_ASSERT_EQUAL_INT64(door_now + AISLE_LEASE_US, door_path.valid_until_utime);
    TEST_ASSERT_GREATER_THAN_INT16(1, door_path.num_waypoints);
    TEST_ASSERT_EQUAL_INT64(1, aisle_planner_counters(door)[AISLE_COUNTER_ARM_PATHS]);
}
static void test_any_cut_of_the_work_gives_the_same_bytes(void) {
    static uint8_t whole[65000];
    door_box(6.2, 4.9, 6.4, 5.05); // something to search round
    door_goal.kind = AISLE_ARM_GOAL_JOINTS;
    door_goal.q[0] = 0.8F;
    door_open();
    door_ask(UINT32_MAX);
    const size_t size = door_size;
    memcpy(whole, door_bytes, size);
    TEST_ASSERT_EQUAL_INT8(AISLE_PATH_OK, door_path.status);
    static const uint32_t units[] = {1, 97, 4096};
    for (int i = 0; i < 3; i++) {
        door_open(); // a planner anew: the revision counts
        door_ask(units[i]);
        TEST_ASSERT_EQUAL_size_t(size, door_size);
        TEST_ASSERT_EQUAL_MEMORY(whole, door_bytes, size);
    }
}
static void test_every_refusal_has_its_cause(void) {
    door_box(6.2, 4.9, 6.4, 5.1);
    door_open();
    door_goal.x = 8.0;
    door_assert_cause(AISLE_STATUS_OUT_OF_REACH, 0);
    door_goal.x = 6.3;
    door_goal.y = 5.0;
    door_assert_cause(AISLE_STATUS_GOAL_OCCUPIED, 1);
    door_goal.q_start[0] = 0.0F;
    door_assert_cause(AISLE_STATUS_START_OCCUPIED, 1);
    door_goal.q_start[0] = 1.1F;
    door_assert_cause(AISLE_STATUS_JOINT_LIMIT, 1);
    door_goal.q_start[0] = -0.8F;
    door_goal.kind = AISLE_ARM_GOAL_JOINTS;
    door_goal.q[2] = 2.9F;
    door_assert_cause(AISLE_STATUS_JOINT_LIMIT, 3);
    door_goal.q[2] = 0.0F;
    door_goal.q[0] = 1.0F;
    door_goal.q[1] = 2.8F; // back over the body
    door_assert_cause(AISLE_STATUS_GOAL_OCCUPIED, -3);
    door_goal.kind = 9;
    door_assert_cause(AISLE_STATUS_MALFORMED, door_goal.arm_goal_id);
}
static void test_a_vehicle_that_moves_or_is_not_known_to_rest_keeps_its_arm_still(void) {
    door_pose.vx = 0.02F;
    door_open();
    door_assert_cause(AISLE_STATUS_VEHICLE_MOVES, 0);
    door_pose = (aisle_pose_msg){.utime = 2, .seq = 2, .map_id = 1, .x = 5.0, .y = 5.0, .localized = 0};
    door_submit(&(aisle_input){.kind = AISLE_INPUT_POSE, .as.pose = &door_pose});
    door_assert_cause(AISLE_STATUS_NOT_LOCALIZED, 2);
    door_pose.seq = 3;
    door_pose.utime = 3;
    door_pose.localized = 1;
    door_submit(&(aisle_input){.kind = AISLE_INPUT_POSE, .as.pose = &door_pose});
    door_now += 199000;
    door_ask(100000);
    TEST_ASSERT_EQUAL_INT8(AISLE_PATH_OK, door_path.status);
    door_now += 2000; // pose_timeout is 0.2 s
    door_assert_cause(AISLE_STATUS_POSE_STALE, 0);
}
static void test_the_pose_is_that_of_the_time_of_asking(void) {
    door_open();
    door_submit(&(aisle_input){.kind = AISLE_INPUT_ARM_GOAL, .as.arm_goal = &door_goal});
    door_pose.utime = door_pose.seq = 2;
    door_pose.vx = 1.0F; // it drives off, but that was later
    door_submit(&(aisle_input){.kind = AISLE_INPUT_POSE, .as.pose = &door_pose});
    aisle_event event;
    while (!aisle_planner_next_event(door, &event)) {
        (void)aisle_planner_step(door, door_now, 100000);
    }
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_msg_decode(AISLE_MSG_ARM_PATH, event.bytes, event.size, &door_path, NULL));
    TEST_ASSERT_EQUAL_INT8(AISLE_PATH_OK, door_path.status);
}
static void test_no_arm_and_a_malformed_one_are_told(void) {
    door_vehicle.num_links = 0;
    door_open();
    door_assert_cause(AISLE_STATUS_NO_ARM, 0);
    door_vehicle.num_links = 3;
    door_vehicle.link_radius[1] = -1.0F;
    door_open();
    door_assert_cause(AISLE_STATUS_MALFORMED, 27);
}
static void test_queries_before_and_after_are_answered_as_if_there_were_no_arm(void) {
    static aisle_query_msg query;
    static uint8_t first[65000], second[65000];
    size_t size[2] = {0, 0};
    query = (aisle_query_msg){.query_id = 3, .map_id = 1, .num_goals = 1};
    query.start = (aisle_goal_msg){.x = 2.0, .y = 2.0};
    query.goals[0] = (aisle_goal_msg){.id = 1, .x = 8.0, .y = 8.0};
    door_box(4.0, 6.0, 4.5, 6.5);
    for (int i = 0; i < 2; i++) {
        door_open();
        if (i == 1) {
            door_ask(100000);
        }
        door_submit(&(aisle_input){.kind = AISLE_INPUT_QUERY, .as.query = &query});
        aisle_event event;
        while (!aisle_planner_next_event(door, &event)) {
            (void)aisle_planner_step(door, door_now, 100000);
        }
        TEST_ASSERT_EQUAL(AISLE_EVENT_REPLY, event.kind);
        memcpy(i == 0 ? first : second, event.bytes, event.size);
        size[i] = event.size;
    }
    TEST_ASSERT_EQUAL_size_t(size[0], size[1]);
    TEST_ASSERT_EQUAL_MEMORY(first, second, size[0]);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_a_goal_of_a_place_is_answered_with_a_motion_to_it);
    RUN_TEST(test_any_cut_of_the_work_gives_the_same_bytes);
    RUN_TEST(test_every_refusal_has_its_cause);
    RUN_TEST(test_a_vehicle_that_moves_or_is_not_known_to_rest_keeps_its_arm_still);
    RUN_TEST(test_the_pose_is_that_of_the_time_of_asking);
    RUN_TEST(test_no_arm_and_a_malformed_one_are_told);
    RUN_TEST(test_queries_before_and_after_are_answered_as_if_there_were_no_arm);
    return UNITY_END();
}
