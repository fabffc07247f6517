#include "daemon/inbox.h" // first: proves that the header stands alone

#include "messages.h"
#include "unity.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { RING = 2 * 65000 + 8, CANARY = 64 };
static uint64_t ring_words[(RING + CANARY) / 8 + 1];
static uint8_t *const ring = (uint8_t *)ring_words;
static aisle_inbox inbox;

void setUp(void) {
    memset(ring_words, 0xA5, sizeof ring_words);
    aisle_inbox_init(&inbox, ring, RING);
}
void tearDown(void) {
    TEST_ASSERT_TRUE(aisle_inbox_invariants_hold(&inbox));
    for (int i = 0; i < CANARY; i++) {
        TEST_ASSERT_EQUAL_HEX8(0xA5, ring[RING + i]);
    }
}

static void put_text(aisle_channel channel, const char *text) {
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_inbox_put(&inbox, channel, 0, text, strlen(text)));
    TEST_ASSERT_TRUE(aisle_inbox_invariants_hold(&inbox));
}
static void expect_text(aisle_channel channel, const char *text) {
    aisle_inbox_message m;
    TEST_ASSERT_TRUE_MESSAGE(aisle_inbox_peek(&inbox, &m), text);
    TEST_ASSERT_EQUAL_MESSAGE(strlen(text), m.size, text);
    TEST_ASSERT_EQUAL_STRING_LEN(text, (const char *)m.bytes, m.size);
    TEST_ASSERT_EQUAL(channel, m.channel);
    aisle_inbox_pop(&inbox, &m);
    TEST_ASSERT_TRUE(aisle_inbox_invariants_hold(&inbox));
}
static void expect_empty(void) {
    aisle_inbox_message m;
    TEST_ASSERT_FALSE(aisle_inbox_peek(&inbox, &m));
    TEST_ASSERT_FALSE(aisle_inbox_peek_overtaking(&inbox, &m));
}

static void test_ordered_messages_come_out_as_they_went_in(void) {
    put_text(AISLE_CHANNEL_LAYOUT, "one");
    put_text(AISLE_CHANNEL_QUERY, "");
    put_text(AISLE_CHANNEL_GRID, "three");
    expect_text(AISLE_CHANNEL_LAYOUT, "one");
    expect_text(AISLE_CHANNEL_QUERY, "");
    put_text(AISLE_CHANNEL_LAYOUT_PATCH, "four");
    expect_text(AISLE_CHANNEL_GRID, "three");
    expect_text(AISLE_CHANNEL_LAYOUT_PATCH, "four");
    expect_empty();
}
static void test_a_snapshot_tells_when_it_came_until_it_is_pinned(void) {
    aisle_inbox_message m;
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_inbox_put(&inbox, AISLE_CHANNEL_POSE, 1000, "old", 3));
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_inbox_put(&inbox, AISLE_CHANNEL_POSE, 2000, "new", 3));
    TEST_ASSERT_TRUE(aisle_inbox_peek(&inbox, &m));
    TEST_ASSERT_EQUAL_INT64(2000, m.at_us);
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_inbox_put(&inbox, AISLE_CHANNEL_GOALS, 3000, "goals", 5));
    TEST_ASSERT_TRUE(aisle_inbox_peek(&inbox, &m));
    TEST_ASSERT_EQUAL(AISLE_CHANNEL_POSE, m.channel);
    TEST_ASSERT_EQUAL_INT64(0, m.at_us);
    expect_text(AISLE_CHANNEL_POSE, "new");
    TEST_ASSERT_TRUE(aisle_inbox_peek(&inbox, &m));
    TEST_ASSERT_EQUAL_INT64(0, m.at_us);
}
static void test_newest_snapshot_replaces_the_older_one(void) {
    put_text(AISLE_CHANNEL_POSE, "old");
    put_text(AISLE_CHANNEL_VEHICLE, "v");
    put_text(AISLE_CHANNEL_POSE, "new");
    expect_text(AISLE_CHANNEL_VEHICLE, "v");
    expect_text(AISLE_CHANNEL_POSE, "new");
    expect_empty();
    TEST_ASSERT_EQUAL_INT64(1, inbox.replaced);
    TEST_ASSERT_EQUAL_INT64(3, inbox.received);
}
static void test_goals_pin_the_snapshots_in_front_of_them(void) {
    put_text(AISLE_CHANNEL_POSE, "p1");
    put_text(AISLE_CHANNEL_VEHICLE, "v1");
    put_text(AISLE_CHANNEL_GOALS, "g1");
    put_text(AISLE_CHANNEL_POSE, "p2");
    put_text(AISLE_CHANNEL_POSE, "p3");
    put_text(AISLE_CHANNEL_GOALS, "g2");
    expect_text(AISLE_CHANNEL_POSE, "p1");
    expect_text(AISLE_CHANNEL_VEHICLE, "v1");
    expect_text(AISLE_CHANNEL_GOALS, "g1");
    expect_text(AISLE_CHANNEL_POSE, "p3");
    expect_text(AISLE_CHANNEL_GOALS, "g2");
    expect_empty();
}
static void test_query_pins_the_vehicle_but_not_the_pose(void) {
    put_text(AISLE_CHANNEL_POSE, "p1");
    put_text(AISLE_CHANNEL_VEHICLE, "v1");
    put_text(AISLE_CHANNEL_QUERY, "q1");
    put_text(AISLE_CHANNEL_VEHICLE, "v2");
    put_text(AISLE_CHANNEL_POSE, "p2");
    expect_text(AISLE_CHANNEL_VEHICLE, "v1");
    expect_text(AISLE_CHANNEL_QUERY, "q1");
    expect_text(AISLE_CHANNEL_VEHICLE, "v2");
    expect_text(AISLE_CHANNEL_POSE, "p2");
    expect_empty();
}
static void test_each_obstacle_source_has_a_slot_of_its_own(void) {
    for (int32_t round = 0; round < 2; round++) {
        for (int32_t source = 0; source < 4; source++) {
            const test_message *m = make_obstacles(source, 10 * source + round);
            TEST_ASSERT_EQUAL(AISLE_OK, aisle_inbox_put(&inbox, AISLE_CHANNEL_OBSTACLES, 0, m->bytes, m->size));
        }
    }
    for (int32_t source = 0; source < 4; source++) {
        aisle_inbox_message got;
        const test_message *m = make_obstacles(source, 10 * source + 1);
        TEST_ASSERT_TRUE(aisle_inbox_peek(&inbox, &got));
        TEST_ASSERT_EQUAL(m->size, got.size);
        TEST_ASSERT_EQUAL_MEMORY(m->bytes, got.bytes, got.size);
        aisle_inbox_pop(&inbox, &got);
    }
    expect_empty();
}
static void test_hostile_obstacles_never_touch_the_slot_of_a_real_source(void) {
    const test_message *good = make_obstacles(3, 5);
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_inbox_put(&inbox, AISLE_CHANNEL_OBSTACLES, 0, good->bytes, good->size));
    put_text(AISLE_CHANNEL_OBSTACLES, "");
    put_text(AISLE_CHANNEL_OBSTACLES, "short");
    static const int32_t sources[] = {4, -1, 256, 0x0103, 0x00010003, 0x01000003, INT32_MIN};
    for (size_t i = 0; i < sizeof sources / sizeof sources[0]; i++) {
        const test_message *m = make_obstacles(sources[i], 1);
        TEST_ASSERT_EQUAL(AISLE_OK, aisle_inbox_put(&inbox, AISLE_CHANNEL_OBSTACLES, 0, m->bytes, m->size));
    }
    good = make_obstacles(3, 5);
    aisle_inbox_message got;
    TEST_ASSERT_TRUE(aisle_inbox_peek(&inbox, &got));
    TEST_ASSERT_EQUAL_MEMORY(good->bytes, got.bytes, good->size);
    aisle_inbox_pop(&inbox, &got);
    TEST_ASSERT_TRUE(aisle_inbox_peek(&inbox, &got));
    aisle_inbox_pop(&inbox, &got);
    expect_empty();
}
static void test_pose_and_obstacles_may_overtake_all_but_goals(void) {
    aisle_inbox_message m;
    put_text(AISLE_CHANNEL_QUERY, "q1");
    put_text(AISLE_CHANNEL_LAYOUT, "l1");
    TEST_ASSERT_FALSE(aisle_inbox_peek_overtaking(&inbox, &m));
    put_text(AISLE_CHANNEL_VEHICLE, "v");
    TEST_ASSERT_FALSE(aisle_inbox_peek_overtaking(&inbox, &m));
    put_text(AISLE_CHANNEL_POSE, "p");
    TEST_ASSERT_TRUE(aisle_inbox_peek_overtaking(&inbox, &m));
    TEST_ASSERT_EQUAL(AISLE_CHANNEL_POSE, m.channel);
    aisle_inbox_pop(&inbox, &m);
    put_text(AISLE_CHANNEL_GOALS, "g");
    put_text(AISLE_CHANNEL_POSE, "p2");
    TEST_ASSERT_FALSE(aisle_inbox_peek_overtaking(&inbox, &m));
    expect_text(AISLE_CHANNEL_QUERY, "q1");
    expect_text(AISLE_CHANNEL_LAYOUT, "l1");
    expect_text(AISLE_CHANNEL_VEHICLE, "v");
    expect_text(AISLE_CHANNEL_GOALS, "g");
    TEST_ASSERT_TRUE(aisle_inbox_peek_overtaking(&inbox, &m));
    expect_text(AISLE_CHANNEL_POSE, "p2");
    expect_empty();
}
static void test_commands_overtake_all_but_the_goals_before_them(void) {
    put_text(AISLE_CHANNEL_QUERY, "q1");
    put_text(AISLE_CHANNEL_COMMAND, "c1");
    put_text(AISLE_CHANNEL_COMMAND, "c2");
    expect_text(AISLE_CHANNEL_COMMAND, "c1");
    put_text(AISLE_CHANNEL_GOALS, "g1");
    put_text(AISLE_CHANNEL_COMMAND, "c3");
    expect_text(AISLE_CHANNEL_COMMAND, "c2");
    expect_text(AISLE_CHANNEL_QUERY, "q1");
    expect_text(AISLE_CHANNEL_GOALS, "g1");
    put_text(AISLE_CHANNEL_COMMAND, "c4");
    expect_text(AISLE_CHANNEL_COMMAND, "c3"); // never one command before another
    expect_text(AISLE_CHANNEL_COMMAND, "c4");
    expect_empty();
}
static void test_many_or_long_commands_go_into_the_ring_and_none_is_lost(void) {
    char text[AISLE_INBOX_COMMAND_SIZE + 2];
    for (int i = 0; i < 3 * AISLE_INBOX_COMMANDS; i++) {
        (void)snprintf(text, sizeof text, "c%d", i);
        put_text(AISLE_CHANNEL_COMMAND, text);
    }
    for (int i = 0; i < 3 * AISLE_INBOX_COMMANDS; i++) {
        (void)snprintf(text, sizeof text, "c%d", i);
        expect_text(AISLE_CHANNEL_COMMAND, text);
    }
    memset(text, 'x', sizeof text - 1);
    text[sizeof text - 1] = '\0';
    put_text(AISLE_CHANNEL_COMMAND, text);
    expect_text(AISLE_CHANNEL_COMMAND, text);
    expect_empty();
}
static void test_full_ring_refuses_counts_and_keeps_what_it_has(void) {
    static uint8_t big[40000];
    uint32_t taken = 0;
    memset(big, 7, sizeof big);
    while (aisle_inbox_put(&inbox, AISLE_CHANNEL_GRID, 0, big, sizeof big) == AISLE_OK) {
        taken++;
    }
    TEST_ASSERT_EQUAL_UINT32(3, taken);
    TEST_ASSERT_EQUAL_INT64(1, inbox.dropped[AISLE_CHANNEL_GRID]);
    TEST_ASSERT_EQUAL(AISLE_OK,
                      aisle_inbox_put(&inbox, AISLE_CHANNEL_POSE, 0, big, 100)); // snapshots have their own place
    for (uint32_t i = 0; i < taken; i++) {
        aisle_inbox_message m;
        TEST_ASSERT_TRUE(aisle_inbox_peek(&inbox, &m));
        TEST_ASSERT_EQUAL(AISLE_CHANNEL_GRID, m.channel);
        TEST_ASSERT_EQUAL_MEMORY(big, m.bytes, sizeof big);
        aisle_inbox_pop(&inbox, &m);
    }
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_inbox_put(&inbox, AISLE_CHANNEL_GRID, 0, big, sizeof big));
    TEST_ASSERT_TRUE(inbox.used_max >= 3 * sizeof big && inbox.used_max <= RING);
}
static void test_message_a_few_bytes_too_long_for_the_rings_end_goes_to_its_start(void) {
    static uint8_t big[64992]; // 65000 with what stands in front of it: two leave 8 bytes
    for (uint32_t size = 1; size < 40; size++) {
        aisle_inbox_message m;
        TEST_ASSERT_EQUAL(AISLE_OK, aisle_inbox_put(&inbox, AISLE_CHANNEL_GRID, 0, big, sizeof big));
        TEST_ASSERT_EQUAL(AISLE_OK, aisle_inbox_put(&inbox, AISLE_CHANNEL_GRID, 0, big, sizeof big - size / 2U));
        TEST_ASSERT_TRUE(aisle_inbox_peek(&inbox, &m));
        aisle_inbox_pop(&inbox, &m);
        TEST_ASSERT_EQUAL(AISLE_OK, aisle_inbox_put(&inbox, AISLE_CHANNEL_QUERY, 0,
                                                    "0123456789012345678901234567890123456789", size));
        TEST_ASSERT_TRUE(aisle_inbox_invariants_hold(&inbox));
        for (int i = 0; i < 2; i++) {
            TEST_ASSERT_TRUE(aisle_inbox_peek(&inbox, &m));
            aisle_inbox_pop(&inbox, &m);
        }
        TEST_ASSERT_EQUAL_STRING_LEN("0123456789012345678901234567890123456789", (const char *)m.bytes, size);
        TEST_ASSERT_EQUAL_HEX8(0xA5, ring[RING]);
        expect_empty();
    }
}
static void test_snapshot_that_finds_no_place_to_be_pinned_is_counted(void) {
    static uint8_t big[64990];
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_inbox_put(&inbox, AISLE_CHANNEL_GRID, 0, big, sizeof big));
    put_text(AISLE_CHANNEL_QUERY, "q");
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_inbox_put(&inbox, AISLE_CHANNEL_VEHICLE, 0, big, sizeof big));
    put_text(AISLE_CHANNEL_QUERY, "r");
    TEST_ASSERT_EQUAL_INT64(1, inbox.dropped[AISLE_CHANNEL_VEHICLE]);
}
static void test_sizes_no_message_has_are_refused_unread(void) {
    TEST_ASSERT_EQUAL(AISLE_ERR_DATA, aisle_inbox_put(&inbox, AISLE_CHANNEL_QUERY, 0, NULL, 4294967285U));
    TEST_ASSERT_EQUAL(AISLE_ERR_DATA,
                      aisle_inbox_put(&inbox, AISLE_CHANNEL_POSE, 0, NULL, AISLE_MSG_DATAGRAM_MAX + 1U));
    TEST_ASSERT_EQUAL_INT64(2, inbox.oversize);
    expect_empty();
}
// A plain queue of numbers beside it, over many wraps of the ring.
static void test_ten_thousand_random_puts_and_takes_keep_order_and_content(void) {
    static uint8_t bytes[30000];
    uint32_t in = 0, out = 0, seed = 1, refused = 0;
    for (uint32_t i = 0; i < 10000; i++) {
        seed = seed * 1664525U + 1013904223U;
        if ((seed >> 16) % 2U == 0U || in == out) {
            uint32_t size = 4U + (seed >> 8) % (sizeof bytes - 4U);
            memset(bytes, (int)(in & 0xFFU), size);
            memcpy(bytes, &in, sizeof in);
            if (aisle_inbox_put(&inbox, AISLE_CHANNEL_LAYOUT, 0, bytes, size) == AISLE_OK) {
                in++;
            } else {
                refused++;
            }
        } else {
            aisle_inbox_message m;
            TEST_ASSERT_TRUE(aisle_inbox_peek(&inbox, &m));
            TEST_ASSERT_EQUAL_MEMORY(&out, m.bytes, sizeof out);
            TEST_ASSERT_TRUE(m.size == 4U || m.bytes[m.size - 1] == (uint8_t)(out & 0xFFU));
            aisle_inbox_pop(&inbox, &m);
            out++;
        }
        TEST_ASSERT_EQUAL_UINT32(in - out, inbox.waiting);
        TEST_ASSERT_TRUE(aisle_inbox_invariants_hold(&inbox));
    }
    TEST_ASSERT_TRUE(out > 3000 && refused > 10);
    TEST_ASSERT_EQUAL_INT64(refused, inbox.dropped[AISLE_CHANNEL_LAYOUT]);
}
static void test_invariants_notice_spoilt_bookkeeping(void) {
    put_text(AISLE_CHANNEL_QUERY, "q");
    inbox.used += 8;
    TEST_ASSERT_FALSE(aisle_inbox_invariants_hold(&inbox));
    inbox.used -= 8;
    inbox.waiting_firm = 1;
    TEST_ASSERT_FALSE(aisle_inbox_invariants_hold(&inbox));
    inbox.waiting_firm = 0;
    ring[inbox.head + 4] = 99; // the channel of the entry
    TEST_ASSERT_FALSE(aisle_inbox_invariants_hold(&inbox));
    ring[inbox.head + 4] = AISLE_CHANNEL_QUERY;
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_ordered_messages_come_out_as_they_went_in);
    RUN_TEST(test_a_snapshot_tells_when_it_came_until_it_is_pinned);
    RUN_TEST(test_newest_snapshot_replaces_the_older_one);
    RUN_TEST(test_goals_pin_the_snapshots_in_front_of_them);
    RUN_TEST(test_query_pins_the_vehicle_but_not_the_pose);
    RUN_TEST(test_each_obstacle_source_has_a_slot_of_its_own);
    RUN_TEST(test_hostile_obstacles_never_touch_the_slot_of_a_real_source);
    RUN_TEST(test_pose_and_obstacles_may_overtake_all_but_goals);
    RUN_TEST(test_commands_overtake_all_but_the_goals_before_them);
    RUN_TEST(test_many_or_long_commands_go_into_the_ring_and_none_is_lost);
    RUN_TEST(test_full_ring_refuses_counts_and_keeps_what_it_has);
    RUN_TEST(test_message_a_few_bytes_too_long_for_the_rings_end_goes_to_its_start);
    RUN_TEST(test_snapshot_that_finds_no_place_to_be_pinned_is_counted);
    RUN_TEST(test_sizes_no_message_has_are_refused_unread);
    RUN_TEST(test_ten_thousand_random_puts_and_takes_keep_order_and_content);
    RUN_TEST(test_invariants_notice_spoilt_bookkeeping);
    return UNITY_END();
}
