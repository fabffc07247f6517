#include "daemon/feed.h" // first: proves that the header stands alone

#include "fake_planner.h"
#include "messages.h"
#include "unity.h"

#include <string.h>

static aisle_feed feed;
static aisle_planner *planner;
static uint64_t block[FAKE_MEMSIZE / 8];

void setUp(void) {
    fake_reset();
    memset(&feed, 0, sizeof feed);
    aisle_config config = {.boot_id = 1};
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_planner_init(block, sizeof block, &config, &planner));
}
void tearDown(void) {}

static void test_every_input_channel_reaches_the_planner_as_its_kind(void) {
    for (int i = 0; i < AISLE_CHANNEL_INPUTS; i++) {
        const test_message *m = make_message((aisle_channel)i, 40 + i);
        TEST_ASSERT_EQUAL(AISLE_OK, aisle_feed_load(&feed, (aisle_channel)i, m->bytes, m->size));
        TEST_ASSERT_TRUE(feed.full);
        TEST_ASSERT_EQUAL(AISLE_OK, aisle_feed_submit(&feed, planner, 1000 + i));
        TEST_ASSERT_FALSE(feed.full);
        TEST_ASSERT_EQUAL(i, fake.taken[i].kind);
        TEST_ASSERT_EQUAL_INT32(40 + i, fake.taken[i].id);
        TEST_ASSERT_EQUAL_INT64(1000 + i, fake.taken[i].now_us);
    }
}
static void test_message_that_does_not_decode_is_refused_with_its_fault_and_not_held(void) {
    const test_message *m = make_message(AISLE_CHANNEL_QUERY, 7);
    TEST_ASSERT_EQUAL(AISLE_ERR_DATA, aisle_feed_load(&feed, AISLE_CHANNEL_QUERY, m->bytes, m->size - 1));
    TEST_ASSERT_FALSE(feed.full);
    TEST_ASSERT_EQUAL(AISLE_MSG_FAULT_TRUNCATED, feed.fault.kind);
    TEST_ASSERT_EQUAL(AISLE_ERR_DATA, aisle_feed_load(&feed, AISLE_CHANNEL_POSE, m->bytes, m->size));
    TEST_ASSERT_EQUAL(AISLE_MSG_FAULT_FINGERPRINT, feed.fault.kind);
    TEST_ASSERT_EQUAL(AISLE_ERR_DATA, aisle_feed_load(&feed, AISLE_CHANNEL_POSE, m->bytes, 0));
}
static void test_busy_planner_leaves_the_message_held(void) {
    const test_message *m = make_message(AISLE_CHANNEL_QUERY, 7);
    fake.busy_always = true;
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_feed_load(&feed, AISLE_CHANNEL_QUERY, m->bytes, m->size));
    TEST_ASSERT_EQUAL(AISLE_BUSY, aisle_feed_submit(&feed, planner, 1));
    TEST_ASSERT_TRUE(feed.full);
    fake.busy_always = false;
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_feed_submit(&feed, planner, 2));
    TEST_ASSERT_EQUAL_INT32(7, fake.taken[0].id);
}
static void test_refusal_of_the_planner_is_handed_on(void) {
    const test_message *m = make_message(AISLE_CHANNEL_POSE, 7);
    fake.refuse_all = true;
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_feed_load(&feed, AISLE_CHANNEL_POSE, m->bytes, m->size));
    TEST_ASSERT_EQUAL(AISLE_ERR_DATA, aisle_feed_submit(&feed, planner, 1));
    TEST_ASSERT_FALSE(feed.full);
    TEST_ASSERT_EQUAL(AISLE_MSG_FAULT_NONE, feed.fault.kind);
}
static void test_what_requests_rest_on_waits_for_idle(void) {
    for (int i = 0; i < AISLE_CHANNEL_INPUTS; i++) {
        bool waits = i == AISLE_CHANNEL_LAYOUT || i == AISLE_CHANNEL_LAYOUT_PATCH || i == AISLE_CHANNEL_GRID ||
                     i == AISLE_CHANNEL_VEHICLE;
        TEST_ASSERT_EQUAL(waits, aisle_feed_waits_for_idle((aisle_channel)i));
    }
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_every_input_channel_reaches_the_planner_as_its_kind);
    RUN_TEST(test_message_that_does_not_decode_is_refused_with_its_fault_and_not_held);
    RUN_TEST(test_busy_planner_leaves_the_message_held);
    RUN_TEST(test_refusal_of_the_planner_is_handed_on);
    RUN_TEST(test_what_requests_rest_on_waits_for_idle);
    return UNITY_END();
}
