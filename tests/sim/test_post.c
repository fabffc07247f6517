#include "sim/post.h" // first: proves that the header stands alone

#include "unity.h"

#include <stdlib.h>

static aisle_sim_post box;

void setUp(void) {}
void tearDown(void) {
    aisle_sim_post_free(&box);
}

static void send(int64_t due, uint8_t mark) {
    TEST_ASSERT_TRUE(aisle_sim_post_send(&box, due, AISLE_CHANNEL_POSE, &mark, 1));
}

static void expect(int64_t now, int mark) {
    aisle_sim_letter letter;
    if (mark < 0) {
        TEST_ASSERT_FALSE(aisle_sim_post_take(&box, now, &letter));
        return;
    }
    TEST_ASSERT_TRUE(aisle_sim_post_take(&box, now, &letter));
    TEST_ASSERT_EQUAL_INT(mark, letter.bytes[0]);
    TEST_ASSERT_EQUAL_size_t(1, letter.size);
    TEST_ASSERT_EQUAL(AISLE_CHANNEL_POSE, letter.channel);
    free(letter.bytes);
}

static void test_letters_come_out_by_time_then_by_order(void) {
    send(30, 1);
    send(10, 2);
    send(10, 3);
    send(20, 4);
    expect(9, -1);
    expect(10, 2);
    expect(10, 3);
    expect(10, -1);
    expect(100, 4);
    expect(100, 1);
    expect(100, -1);
}

static void test_a_full_box_refuses_and_keeps_what_it_has(void) {
    for (int i = 0; i < AISLE_SIM_POST_MAX; i++) {
        send(i, (uint8_t)(i & 0xFF));
    }
    uint8_t mark = 7;
    TEST_ASSERT_FALSE(aisle_sim_post_send(&box, 0, AISLE_CHANNEL_POSE, &mark, 1));
    for (int i = 0; i < AISLE_SIM_POST_MAX; i++) {
        expect(AISLE_SIM_POST_MAX, i & 0xFF);
    }
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_letters_come_out_by_time_then_by_order);
    RUN_TEST(test_a_full_box_refuses_and_keeps_what_it_has);
    return UNITY_END();
}
