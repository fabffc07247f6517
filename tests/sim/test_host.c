#include "sim/host.h" // first: proves that the header stands alone

#include "hall.h"
#include "replay/check.h"

#include <stdlib.h>
#include <unistd.h>

static aisle_settings settings;
static aisle_sim_host host;
static char message[AISLE_SETTINGS_MESSAGE_LEN];
static struct {
    aisle_channel channel;
    int64_t utime;
    int32_t query_id;
} heard[256];
static int num_heard, num_status;

void setUp(void) {
    aisle_settings_defaults(&settings);
    hall_begin(12.0, 10.0);
    hall_add(5.0, 0.0, 6.0, 6.0);
    hall_layout.crc32 = (int32_t)aisle_layout_crc32(0, &hall_layout);
    num_heard = num_status = 0;
}
void tearDown(void) {
    aisle_sim_host_stop(&host);
}

static void on_heard(void *ctx, aisle_channel channel, int64_t utime, const uint8_t *bytes, size_t size) {
    TEST_ASSERT_EQUAL_PTR(&host, ctx);
    if (channel == AISLE_CHANNEL_STATUS) {
        num_status++;
        return;
    }
    TEST_ASSERT_TRUE(num_heard < 256 && size > 0);
    heard[num_heard].channel = channel;
    heard[num_heard].utime = utime;
    heard[num_heard++].query_id = aisle_path_int32(bytes, "query_id");
}

static void start(FILE *log) {
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_sim_host_start_core(&host, &settings, log, on_heard, &host, message));
}

static void send(int64_t at_us, aisle_channel channel, const void *msg) {
    static uint8_t bytes[AISLE_MSG_DATAGRAM_MAX];
    size_t size = 0;
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_msg_encode(aisle_channel_type(channel), msg, bytes, sizeof bytes, &size));
    aisle_sim_host_send(&host, host.epoch_us + at_us, channel, bytes, size);
}

static void ask(int64_t at_us, int32_t id) {
    static aisle_query_msg query;
    query = (aisle_query_msg){.query_id = id,
                              .map_id = 1,
                              .start = {.x = 2.0, .y = 2.0, .tolerance_theta = 4.0F},
                              .num_goals = 1,
                              .goals = {{.id = 1, .x = 8.0 + 0.1 * id, .y = 2.0, .tolerance_theta = 4.0F}}};
    send(at_us, AISLE_CHANNEL_QUERY, &query);
}

static void test_at_once_answers_come_at_the_time_of_the_question(void) {
    start(NULL);
    send(1000, AISLE_CHANNEL_LAYOUT, &hall_layout);
    ask(5000, 3);
    TEST_ASSERT_EQUAL_INT(1, num_heard);
    TEST_ASSERT_EQUAL(AISLE_CHANNEL_REPLY, heard[0].channel);
    TEST_ASSERT_EQUAL_INT64(host.epoch_us + 5000, heard[0].utime);
    TEST_ASSERT_EQUAL_INT32(3, heard[0].query_id);
}

static void test_the_heartbeat_comes_five_times_a_second(void) {
    start(NULL);
    for (int i = 0; i <= 1000; i++) {
        aisle_sim_host_advance(&host, host.epoch_us + i * 5000);
    }
    TEST_ASSERT_INT_WITHIN(1, 25, num_status);
}

static int64_t answered_at(uint32_t units) {
    num_heard = 0;
    start(NULL);
    TEST_ASSERT_TRUE(aisle_sim_host_slice(&host, units, NULL));
    send(1000, AISLE_CHANNEL_LAYOUT, &hall_layout);
    aisle_sim_host_advance(&host, host.epoch_us + 5000000);
    ask(5000000, 1);
    aisle_sim_host_advance(&host, host.epoch_us + 60000000);
    TEST_ASSERT_EQUAL_INT(1, num_heard);
    int64_t took = heard[0].utime - host.epoch_us - 5000000;
    aisle_sim_host_stop(&host);
    return took;
}

static void test_a_slower_planner_answers_later(void) {
    int64_t fast = answered_at(10000), slow = answered_at(100), slower = answered_at(10);
    TEST_ASSERT_TRUE(fast >= 500 && fast < slow && slow * 4 < slower);
}

static void test_what_comes_meanwhile_waits_in_order(void) {
    start(NULL);
    TEST_ASSERT_TRUE(aisle_sim_host_slice(&host, 50, NULL));
    send(1000, AISLE_CHANNEL_LAYOUT, &hall_layout);
    for (int32_t i = 1; i <= 30; i++) {
        ask(1000 + i, i);
    }
    aisle_sim_host_advance(&host, host.epoch_us + 300000);
    TEST_ASSERT_TRUE(num_heard < 30); // still at it
    aisle_sim_host_advance(&host, host.epoch_us + 600000000);
    TEST_ASSERT_EQUAL_INT(30, num_heard);
    for (int i = 0; i < 30; i++) {
        TEST_ASSERT_EQUAL_INT32(i + 1, heard[i].query_id);
        TEST_ASSERT_TRUE(i == 0 || heard[i].utime >= heard[i - 1].utime);
    }
    TEST_ASSERT_EQUAL_UINT32(0, host.waiting.count);
}

// ---- the record of a slow planner replays

static aisle_check check;

static void on_replayed(void *ctx, const aisle_replay_output *output) {
    (void)ctx;
    TEST_ASSERT_TRUE(output->renewal || aisle_check_made(&check, output->channel, output->bytes, output->size));
}

static void replay_event(aisle_replay *replay, const aisle_log_event *event) {
    uint32_t units;
    if (aisle_record_is_step(settings.prefix, event->channel, event->channel_length, event->bytes, event->size,
                             &units)) {
        aisle_replay_step(replay, event->utime, units);
        return;
    }
    aisle_channel channel = aisle_channel_find(settings.prefix, event->channel, event->channel_length);
    if ((int)channel < AISLE_CHANNEL_INPUTS) {
        aisle_replay_input(replay, event->utime, channel, event->bytes, event->size);
    } else {
        aisle_check_recorded(&check, channel, event->bytes, event->size);
    }
}

static void test_the_record_of_a_slow_planner_replays(void) {
    static aisle_replay replay;
    static aisle_log_reader reader;
    char name[] = "/tmp/aisle_host_XXXXXX";
    (void)close(mkstemp(name));
    start(NULL);
    TEST_ASSERT_TRUE(aisle_sim_host_slice(&host, 100, name));
    send(1000, AISLE_CHANNEL_LAYOUT, &hall_layout);
    for (int32_t i = 1; i <= 10; i++) {
        ask(1000 + i * 3000, i);
    }
    aisle_sim_host_advance(&host, host.epoch_us + 600000000);
    TEST_ASSERT_EQUAL_INT(10, num_heard);
    aisle_sim_host_stop(&host);
    aisle_engine engine;
    aisle_log_event event;
    FILE *file = fopen(name, "rb");
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_engine_start(&engine, &settings, 2, 0, message));
    aisle_replay_init(&replay, engine.planner, on_replayed, NULL);
    aisle_check_init(&check, stdout);
    TEST_ASSERT_TRUE(aisle_log_open(&reader, file));
    while (aisle_log_next(&reader, &event)) {
        replay_event(&replay, &event);
    }
    TEST_ASSERT_TRUE(aisle_check_finish(&check));
    TEST_ASSERT_EQUAL_INT64(10, check.equal);
    aisle_engine_stop(&engine);
    (void)fclose(file);
    (void)unlink(name);
}

static void test_a_record_that_cannot_be_written_is_told(void) {
    start(NULL);
    TEST_ASSERT_FALSE(aisle_sim_host_slice(&host, 100, "/nonexistent/record.log"));
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_at_once_answers_come_at_the_time_of_the_question);
    RUN_TEST(test_the_heartbeat_comes_five_times_a_second);
    RUN_TEST(test_a_slower_planner_answers_later);
    RUN_TEST(test_what_comes_meanwhile_waits_in_order);
    RUN_TEST(test_the_record_of_a_slow_planner_replays);
    RUN_TEST(test_a_record_that_cannot_be_written_is_told);
    return UNITY_END();
}
