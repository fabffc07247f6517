#include "daemon/bus.h" // first: proves that the header stands alone

#include "messages.h"
#include "unity.h"

#include <lcm/lcm.h>
#include <poll.h>
#include <stdio.h>
#include <string.h>

static uint64_t ring[300000 / 8];
static aisle_inbox inbox;
static aisle_bus bus;

void setUp(void) {
    aisle_inbox_init(&inbox, ring, sizeof ring);
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_bus_open(&bus, "memq://", "T", &inbox));
}
void tearDown(void) {
    aisle_bus_close(&bus);
}

static void send_to(const char *channel, const void *bytes, size_t size) {
    TEST_ASSERT_EQUAL(0, lcm_publish(bus.lcm, channel, bytes, (unsigned int)size));
}
static void send_text(const char *channel, const char *text) {
    send_to(channel, text, strlen(text));
}
static void drain_all(void) {
    int n;
    do {
        n = aisle_bus_drain(&bus);
        TEST_ASSERT_TRUE(n >= 0);
    } while (n > 0);
}
static void expect_next(aisle_channel channel, const char *text) {
    aisle_inbox_message m;
    TEST_ASSERT_TRUE_MESSAGE(aisle_inbox_peek(&inbox, &m), text);
    TEST_ASSERT_EQUAL_MESSAGE(channel, m.channel, text);
    TEST_ASSERT_EQUAL(strlen(text), m.size);
    TEST_ASSERT_EQUAL_STRING_LEN(text, (const char *)m.bytes, m.size);
    aisle_inbox_pop(&inbox, &m);
}
static void expect_empty(void) {
    aisle_inbox_message m;
    TEST_ASSERT_FALSE(aisle_inbox_peek(&inbox, &m));
}

static void test_order_over_all_channels_is_kept(void) {
    send_text("T_LAYOUT", "a");
    send_text("T_GRID", "b");
    send_text("T_GOALS", "c");
    send_text("T_QUERY", "d");
    send_text("T_LAYOUT", "e");
    send_text("T_LAYOUT_PATCH", "f");
    send_text("T_COMMAND", "g");
    drain_all();
    expect_next(AISLE_CHANNEL_LAYOUT, "a");
    expect_next(AISLE_CHANNEL_GRID, "b");
    expect_next(AISLE_CHANNEL_GOALS, "c");
    expect_next(AISLE_CHANNEL_QUERY, "d");
    expect_next(AISLE_CHANNEL_LAYOUT, "e");
    expect_next(AISLE_CHANNEL_LAYOUT_PATCH, "f");
    expect_next(AISLE_CHANNEL_COMMAND, "g");
    expect_empty();
}
static void test_other_prefixes_and_outputs_are_not_heard(void) {
    send_text("T_QUERY2", "x");
    send_text("TT_QUERY", "x");
    send_text("AISLE_QUERY", "x");
    send_text("T_PATH", "x");
    send_text("T_STATUS", "x");
    drain_all();
    expect_empty();
    TEST_ASSERT_EQUAL_INT64(0, inbox.received);
}
static void test_newest_pose_is_kept_and_no_goal_is_lost(void) {
    for (int i = 0; i < 40; i++) { // more than liblcm's own 30
        char text[16];
        (void)snprintf(text, sizeof text, "p%d", i);
        send_text("T_POSE", text);
    }
    for (int i = 0; i < 100; i++) {
        send_text("T_GOALS", "goal");
    }
    drain_all();
    expect_next(AISLE_CHANNEL_POSE, "p39");
    for (int i = 0; i < 100; i++) {
        expect_next(AISLE_CHANNEL_GOALS, "goal");
    }
    expect_empty();
    TEST_ASSERT_EQUAL_INT64(0, bus.fault_count);
}
static void test_full_queue_is_told_with_its_channel(void) {
    static uint8_t big[60000];
    for (int i = 0; i < 8; i++) {
        send_to("T_GRID", big, sizeof big);
    }
    drain_all();
    TEST_ASSERT_TRUE(inbox.dropped[AISLE_CHANNEL_GRID] > 0);
    TEST_ASSERT_EQUAL_INT64(inbox.dropped[AISLE_CHANNEL_GRID], bus.fault_count);
    TEST_ASSERT_EQUAL(AISLE_BUS_FULL, bus.fault);
    TEST_ASSERT_EQUAL(AISLE_CHANNEL_GRID, bus.fault_channel);
    TEST_ASSERT_EQUAL_INT64(8, inbox.waiting + inbox.dropped[AISLE_CHANNEL_GRID]);
}
static void test_sizes_no_message_has_are_refused_and_told(void) {
    static uint8_t huge[AISLE_MSG_DATAGRAM_MAX + 1U];
    send_to("T_QUERY", huge, sizeof huge);
    send_to("T_POSE", huge, sizeof huge);
    send_to("T_OBSTACLES", huge, 0);
    drain_all();
    TEST_ASSERT_EQUAL_INT64(2, inbox.oversize);
    TEST_ASSERT_EQUAL_INT64(2, bus.fault_count);
    TEST_ASSERT_EQUAL(AISLE_BUS_OVERSIZE, bus.fault);
    TEST_ASSERT_EQUAL(AISLE_CHANNEL_POSE, bus.fault_channel);
}
static void test_flood_that_may_have_overrun_liblcm_is_told_once(void) {
    for (int i = 0; i < AISLE_BUS_QUEUE + 100; i++) {
        send_text("T_QUERY", "q");
    }
    drain_all();
    TEST_ASSERT_EQUAL_INT64(1, bus.flooded);
    TEST_ASSERT_EQUAL(AISLE_BUS_FLOODED, bus.fault);
    for (int round = 0; round < 5; round++) { // no flood: found empty in between
        for (int i = 0; i < AISLE_BUS_QUEUE - 1; i++) {
            send_text("T_POSE", "p");
        }
        drain_all();
    }
    TEST_ASSERT_EQUAL_INT64(1, bus.flooded);
}
static void test_one_drain_is_bounded(void) {
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 400; j++) {
            send_text(i == 0 ? "T_POSE" : i == 1 ? "T_VEHICLE" : "T_OBSTACLES", "s");
        }
    }
    TEST_ASSERT_EQUAL(AISLE_BUS_DRAIN_MAX, aisle_bus_drain(&bus));
    TEST_ASSERT_EQUAL(1200 - AISLE_BUS_DRAIN_MAX, aisle_bus_drain(&bus));
    TEST_ASSERT_EQUAL(0, aisle_bus_drain(&bus));
}
static void test_file_descriptor_wakes_poll_only_when_messages_wait(void) {
    struct pollfd p = {.fd = aisle_bus_fd(&bus), .events = POLLIN, .revents = 0};
    TEST_ASSERT_EQUAL(0, poll(&p, 1, 0));
    send_text("T_POSE", "p");
    TEST_ASSERT_EQUAL(1, poll(&p, 1, 0));
    drain_all();
    TEST_ASSERT_EQUAL(0, poll(&p, 1, 0));
}

static char heard[64];
static void on_output(const lcm_recv_buf_t *received, const char *channel, void *user) {
    (void)user;
    (void)snprintf(heard, sizeof heard, "%s=%.*s", channel, (int)received->data_size, (const char *)received->data);
}
static void test_outputs_are_published_on_their_channels(void) {
    TEST_ASSERT_NOT_NULL(lcm_subscribe(bus.lcm, "T_(PATH|REPLY|ARM_PATH|STATUS|DIAG)", on_output, NULL));
    static const char *const want[] = {"T_PATH=x", "T_REPLY=x", "T_ARM_PATH=x", "T_STATUS=x", "T_DIAG=x"};
    for (int i = 0; i < 5; i++) {
        TEST_ASSERT_EQUAL(AISLE_OK, aisle_bus_publish(&bus, (aisle_channel)(AISLE_CHANNEL_PATH + i), "x", 1));
        drain_all();
        TEST_ASSERT_EQUAL_STRING(want[i], heard);
    }
    TEST_ASSERT_EQUAL_INT64(5, bus.published);
    TEST_ASSERT_EQUAL_INT64(0, bus.failed);
}
static void test_bus_that_does_not_exist_is_refused(void) {
    aisle_bus other;
    TEST_ASSERT_EQUAL(AISLE_ERR_ARG, aisle_bus_open(&other, "nonsense://", "T", &inbox));
    aisle_bus_close(&other); // harmless
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_order_over_all_channels_is_kept);
    RUN_TEST(test_other_prefixes_and_outputs_are_not_heard);
    RUN_TEST(test_newest_pose_is_kept_and_no_goal_is_lost);
    RUN_TEST(test_full_queue_is_told_with_its_channel);
    RUN_TEST(test_sizes_no_message_has_are_refused_and_told);
    RUN_TEST(test_flood_that_may_have_overrun_liblcm_is_told_once);
    RUN_TEST(test_one_drain_is_bounded);
    RUN_TEST(test_file_descriptor_wakes_poll_only_when_messages_wait);
    RUN_TEST(test_outputs_are_published_on_their_channels);
    RUN_TEST(test_bus_that_does_not_exist_is_refused);
    return UNITY_END();
}
