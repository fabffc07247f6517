#include "daemon/channel.h" // first: proves that the header stands alone

#include "unity.h"

#include <string.h>

void setUp(void) {}
void tearDown(void) {}

static void test_every_name_is_found_again_and_only_with_its_prefix(void) {
    for (int i = 0; i < (int)AISLE_CHANNEL_COUNT; i++) {
        char name[AISLE_CHANNEL_NAME_LEN];
        aisle_channel_name("V7", (aisle_channel)i, name);
        TEST_ASSERT_EQUAL(i, aisle_channel_find("V7", name, strlen(name)));
        TEST_ASSERT_EQUAL(AISLE_CHANNEL_COUNT, aisle_channel_find("V", name, strlen(name)));
        TEST_ASSERT_EQUAL(AISLE_CHANNEL_COUNT, aisle_channel_find("V7_", name, strlen(name)));
        TEST_ASSERT_EQUAL(AISLE_CHANNEL_COUNT, aisle_channel_find("V7", name, strlen(name) - 1));
    }
}
static void test_names_are_those_of_the_documents(void) {
    static const char *const names[] = {"AISLE_LAYOUT",   "AISLE_LAYOUT_PATCH", "AISLE_GRID",  "AISLE_VEHICLE",
                                        "AISLE_POSE",     "AISLE_GOALS",        "AISLE_QUERY", "AISLE_OBSTACLES",
                                        "AISLE_COMMAND",  "AISLE_ARM_GOAL",     "AISLE_PATH",  "AISLE_REPLY",
                                        "AISLE_ARM_PATH", "AISLE_STATUS",       "AISLE_DIAG"};
    for (int i = 0; i < (int)AISLE_CHANNEL_COUNT; i++) {
        TEST_ASSERT_EQUAL(i, aisle_channel_find("AISLE", names[i], strlen(names[i])));
    }
    TEST_ASSERT_EQUAL(AISLE_CHANNEL_COUNT, aisle_channel_find("AISLE", "AISLE_QUERY2", 12));
    TEST_ASSERT_EQUAL(AISLE_CHANNEL_COUNT, aisle_channel_find("AISLE", "AISLE-QUERY", 11));
    TEST_ASSERT_EQUAL(AISLE_CHANNEL_COUNT, aisle_channel_find("AISLE", "AISLE_", 6));
    TEST_ASSERT_EQUAL(AISLE_CHANNEL_COUNT, aisle_channel_find("AISLE", "", 0));
}
static void test_each_channel_carries_its_type(void) {
    TEST_ASSERT_EQUAL(AISLE_MSG_GOAL_LIST, aisle_channel_type(AISLE_CHANNEL_GOALS));
    TEST_ASSERT_EQUAL(AISLE_MSG_GRID_CHUNK, aisle_channel_type(AISLE_CHANNEL_GRID));
    TEST_ASSERT_EQUAL(AISLE_MSG_PATH, aisle_channel_type(AISLE_CHANNEL_PATH));
    TEST_ASSERT_EQUAL(AISLE_MSG_PATH, aisle_channel_type(AISLE_CHANNEL_REPLY));
    TEST_ASSERT_EQUAL(AISLE_MSG_ARM_GOAL, aisle_channel_type(AISLE_CHANNEL_ARM_GOAL));
    TEST_ASSERT_EQUAL(AISLE_MSG_ARM_PATH, aisle_channel_type(AISLE_CHANNEL_ARM_PATH));
    TEST_ASSERT_EQUAL(AISLE_CHANNEL_PATH, aisle_channel_of_event(AISLE_EVENT_PATH));
    TEST_ASSERT_EQUAL(AISLE_CHANNEL_REPLY, aisle_channel_of_event(AISLE_EVENT_REPLY));
    TEST_ASSERT_EQUAL(AISLE_CHANNEL_ARM_PATH, aisle_channel_of_event(AISLE_EVENT_ARM_PATH));
}
static void test_pose_vehicle_and_obstacles_alone_are_snapshots(void) {
    for (int i = 0; i < (int)AISLE_CHANNEL_COUNT; i++) {
        bool snapshot = i == AISLE_CHANNEL_POSE || i == AISLE_CHANNEL_VEHICLE || i == AISLE_CHANNEL_OBSTACLES;
        TEST_ASSERT_EQUAL(snapshot, aisle_channel_is_snapshot((aisle_channel)i));
    }
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_every_name_is_found_again_and_only_with_its_prefix);
    RUN_TEST(test_names_are_those_of_the_documents);
    RUN_TEST(test_each_channel_carries_its_type);
    RUN_TEST(test_pose_vehicle_and_obstacles_alone_are_snapshots);
    return UNITY_END();
}
