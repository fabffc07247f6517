#include "replay/replay.h" // first: proves that the header stands alone

#include "fake_planner.h"
#include "messages.h"
#include "unity.h"

#include <string.h>

static aisle_replay replay;
static aisle_planner *planner;
static uint64_t block[FAKE_MEMSIZE / 8];
static struct {
    aisle_channel channel;
    int64_t utime;
    int32_t query_id;
    bool renewal;
} outputs[64];
static int num_outputs;

static void on_output(void *ctx, const aisle_replay_output *output) {
    TEST_ASSERT_EQUAL_PTR(&outputs, ctx);
    TEST_ASSERT_TRUE(num_outputs < 64);
    outputs[num_outputs].channel = output->channel;
    outputs[num_outputs].utime = output->utime;
    outputs[num_outputs].renewal = output->renewal;
    outputs[num_outputs].query_id = aisle_path_int32(output->bytes, "query_id");
    num_outputs++;
}
void setUp(void) {
    fake_reset();
    num_outputs = 0;
    aisle_config config = {.boot_id = 1};
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_planner_init(block, sizeof block, &config, &planner));
    aisle_replay_init(&replay, planner, on_output, &outputs);
}
void tearDown(void) {}

static void input(int64_t utime, aisle_channel channel, int32_t id) {
    const test_message *m = make_message(channel, id);
    aisle_replay_input(&replay, utime, channel, m->bytes, m->size);
}

static void test_each_request_is_answered_before_the_next_input(void) {
    fake.units_per_request = 1000000; // several steps
    input(1000, AISLE_CHANNEL_QUERY, 5);
    TEST_ASSERT_EQUAL(1, num_outputs);
    input(2000, AISLE_CHANNEL_QUERY, 6);
    TEST_ASSERT_EQUAL(2, num_outputs);
    TEST_ASSERT_EQUAL(AISLE_CHANNEL_REPLY, outputs[1].channel);
    TEST_ASSERT_EQUAL_INT64(2000, outputs[1].utime);
    TEST_ASSERT_EQUAL_INT32(6, outputs[1].query_id);
}
static void test_leases_are_renewed_in_log_time(void) {
    fake.lease_us = 500000;
    input(1000000, AISLE_CHANNEL_GOALS, 1);
    input(2700000, AISLE_CHANNEL_POSE, 1);
    TEST_ASSERT_EQUAL(4, num_outputs);
    TEST_ASSERT_FALSE(outputs[0].renewal);
    for (int i = 1; i < 4; i++) {
        TEST_ASSERT_TRUE(outputs[i].renewal);
        TEST_ASSERT_EQUAL_INT64(1000000 + 500000 * i, outputs[i].utime);
        TEST_ASSERT_EQUAL(AISLE_CHANNEL_PATH, outputs[i].channel);
    }
    TEST_ASSERT_EQUAL_INT64(2700000, fake.taken[1].now_us);
}
static void test_time_never_runs_backwards(void) {
    input(5000, AISLE_CHANNEL_POSE, 1);
    input(4000, AISLE_CHANNEL_POSE, 2);
    TEST_ASSERT_EQUAL_INT64(5000, fake.taken[1].now_us);
}
static void test_refused_messages_are_counted_by_who_refused_them(void) {
    aisle_replay_input(&replay, 1, AISLE_CHANNEL_QUERY, "junk", 4);
    fake.refuse_all = true;
    input(2, AISLE_CHANNEL_QUERY, 1);
    fake.refuse_all = false;
    fake.busy_always = true; // a planner that breaks its promise does not hang us
    input(3, AISLE_CHANNEL_QUERY, 1);
    TEST_ASSERT_EQUAL_INT64(3, replay.inputs);
    TEST_ASSERT_EQUAL_INT64(1, replay.malformed);
    TEST_ASSERT_EQUAL_INT64(2, replay.refused);
    TEST_ASSERT_EQUAL(0, num_outputs);
}
static void test_a_log_that_tells_its_steps_is_planned_in_them_alone(void) {
    fake.units_per_request = 30;
    fake.lease_us = 500000;
    aisle_replay_step(&replay, 100, 0);
    TEST_ASSERT_EQUAL_UINT32(0, fake.steps); // says what the log is, no step
    input(1000, AISLE_CHANNEL_GOALS, 5);
    aisle_replay_step(&replay, 1001, 20);
    TEST_ASSERT_EQUAL(0, num_outputs);
    aisle_replay_step(&replay, 1002, 20);
    TEST_ASSERT_EQUAL(1, num_outputs);
    TEST_ASSERT_EQUAL_INT64(1002, outputs[0].utime);
    aisle_replay_advance(&replay, 9000000); // its leases are steps, too
    input(9000001, AISLE_CHANNEL_POSE, 1);
    TEST_ASSERT_EQUAL(1, num_outputs);
    TEST_ASSERT_EQUAL_UINT32(2, fake.steps);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_each_request_is_answered_before_the_next_input);
    RUN_TEST(test_leases_are_renewed_in_log_time);
    RUN_TEST(test_time_never_runs_backwards);
    RUN_TEST(test_a_log_that_tells_its_steps_is_planned_in_them_alone);
    RUN_TEST(test_refused_messages_are_counted_by_who_refused_them);
    return UNITY_END();
}
