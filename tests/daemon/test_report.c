#include "daemon/report.h" // first: proves that the header stands alone

#include "fake_planner.h"
#include "unity.h"

#include <string.h>

static uint64_t block[FAKE_MEMSIZE / 8];
static aisle_settings settings;
static aisle_inbox inbox;
static aisle_bus bus; // never opened: its counters are read alone
static aisle_clock test_clock;
static aisle_notify notify;
static aisle_loop loop;
static aisle_status_msg status;

static int64_t read_time(void *ctx) {
    return *(const int64_t *)ctx;
}
static int64_t time_us = 1000;

void setUp(void) {
    fake_reset();
    memset(&bus, 0, sizeof bus);
    memset(&inbox, 0, sizeof inbox);
    bus.inbox = &inbox;
    aisle_settings_defaults(&settings);
    aisle_planner *planner;
    aisle_config config = {.boot_id = 7};
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_planner_init(block, sizeof block, &config, &planner));
    aisle_clock_start(&test_clock, (aisle_clock_source){read_time, read_time, read_time, &time_us});
    aisle_loop_init(&loop, &(aisle_loop_parts){.settings = &settings,
                                               .planner = planner,
                                               .bus = &bus,
                                               .clock = &test_clock,
                                               .notify = &notify,
                                               .stop_fd = -1});
}
void tearDown(void) {}

static void test_refusals_of_every_kind_add_up_to_num_rejected(void) {
    fake.status.num_rejected = 1;
    loop.malformed = 10;
    loop.over_limit = 100;
    loop.stuck = 1000;
    inbox.oversize = 10000;
    inbox.dropped[0] = 100000;
    inbox.dropped[AISLE_CHANNEL_INPUTS - 1] = 1000000;
    aisle_report_status(&loop, 1000, &status);
    TEST_ASSERT_EQUAL_INT32(1111111, status.num_rejected);
    inbox.oversize = INT64_MAX / 2;
    aisle_report_status(&loop, 1000, &status);
    TEST_ASSERT_EQUAL_INT32(INT32_MAX, status.num_rejected);
}
static void test_fault_goes_before_the_planners_cause_for_its_time_alone(void) {
    fake.status.cause = AISLE_STATUS_NO_POSE;
    fake.status.cause_id = 3;
    loop.fault_cause = AISLE_STATUS_LIMIT;
    loop.fault_id = AISLE_CAUSE_ID_QUEUE;
    loop.fault_us = 5000;
    aisle_report_status(&loop, 5000 + AISLE_LOOP_FAULT_US - 1, &status);
    TEST_ASSERT_EQUAL_INT16(AISLE_STATUS_LIMIT, status.cause);
    TEST_ASSERT_EQUAL_INT32(AISLE_CAUSE_ID_QUEUE, status.cause_id);
    aisle_report_status(&loop, 5000 + AISLE_LOOP_FAULT_US, &status);
    TEST_ASSERT_EQUAL_INT16(AISLE_STATUS_NO_POSE, status.cause);
    TEST_ASSERT_EQUAL_INT32(3, status.cause_id);
}
static void test_departed_clock_shows_only_where_there_is_no_other_cause(void) {
    test_clock.departure = 5000000;
    aisle_report_status(&loop, 1000, &status);
    TEST_ASSERT_EQUAL_INT16(AISLE_STATUS_CLOCK_JUMP, status.cause);
    fake.status.cause = AISLE_STATUS_NO_POSE;
    aisle_report_status(&loop, 1000, &status);
    TEST_ASSERT_EQUAL_INT16(AISLE_STATUS_NO_POSE, status.cause);
}
static void test_ages_and_counters_alone_are_no_change_worth_a_message(void) {
    aisle_status_msg a = {0}, b = {0};
    b.utime = 5;
    b.seq = 6;
    b.uptime = 7;
    b.pose_age = 8.0F;
    b.distance_remaining = 9.0F;
    b.num_rejected = 10;
    TEST_ASSERT_FALSE(aisle_report_status_differs(&a, &b));
    int32_t *const members[] = {&b.cause_id,         &b.map_id,        &b.map_revision,
                                &b.vehicle_revision, &b.goal_list_id,  &b.goal_list_revision,
                                &b.goal_id,          &b.path_revision, &b.command_id};
    for (size_t i = 0; i < sizeof members / sizeof members[0]; i++) {
        *members[i] = 1;
        TEST_ASSERT_TRUE(aisle_report_status_differs(&a, &b));
        *members[i] = 0;
    }
    b.state = AISLE_STATUS_HELD;
    TEST_ASSERT_TRUE(aisle_report_status_differs(&a, &b));
}
static void test_resident_set_grows_with_memory_in_use(void) {
    static volatile unsigned char big[16 << 20];
    int64_t before = aisle_report_rss();
    for (size_t i = 0; i < sizeof big; i += 4096) {
        big[i] = 1;
    }
    int64_t grown = aisle_report_rss() - before;
    TEST_ASSERT_TRUE(grown > 12 << 20 && grown < 32 << 20);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_refusals_of_every_kind_add_up_to_num_rejected);
    RUN_TEST(test_fault_goes_before_the_planners_cause_for_its_time_alone);
    RUN_TEST(test_departed_clock_shows_only_where_there_is_no_other_cause);
    RUN_TEST(test_ages_and_counters_alone_are_no_change_worth_a_message);
    RUN_TEST(test_resident_set_grows_with_memory_in_use);
    return UNITY_END();
}
