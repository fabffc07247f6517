#include "daemon/clock.h" // first: proves that the header stands alone

#include "unity.h"

#include <stddef.h>

static int64_t monotonic, real;
static aisle_clock self;

static int64_t read_monotonic(void *ctx) {
    (void)ctx;
    return monotonic;
}
static int64_t read_real(void *ctx) {
    (void)ctx;
    return real;
}
static int64_t read_processor(void *ctx) {
    (void)ctx;
    return 77;
}
void setUp(void) {
    monotonic = 5000;
    real = 1700000000000000;
    aisle_clock_start(&self, (aisle_clock_source){read_monotonic, read_real, read_processor, NULL});
}
void tearDown(void) {}

static void pass(int64_t us) {
    monotonic += us;
    real += us;
}

static void test_utime_is_real_time_at_start_plus_monotonic_progress(void) {
    pass(123456);
    TEST_ASSERT_EQUAL_INT64(1700000000123456, aisle_clock_utime(&self, aisle_clock_monotonic(&self)));
    real -= 60000000; // somebody sets the clock back
    TEST_ASSERT_EQUAL_INT64(1700000000123456, aisle_clock_utime(&self, aisle_clock_monotonic(&self)));
}
static void test_a_moment_of_real_time_is_as_long_ago_by_the_monotonic_clock(void) {
    pass(20000000);
    const int64_t at = aisle_clock_monotonic(&self);
    TEST_ASSERT_EQUAL_INT64(at, aisle_clock_monotonic_of(&self, real));
    TEST_ASSERT_EQUAL_INT64(at - 3000, aisle_clock_monotonic_of(&self, real - 3000));
    TEST_ASSERT_EQUAL_INT64(at - AISLE_CLOCK_PAST_US, aisle_clock_monotonic_of(&self, real - AISLE_CLOCK_PAST_US));
    TEST_ASSERT_EQUAL_INT64(at, aisle_clock_monotonic_of(&self, real - AISLE_CLOCK_PAST_US - 1)); // set ahead since
    TEST_ASSERT_EQUAL_INT64(at, aisle_clock_monotonic_of(&self, real + 1));                       // set back
    TEST_ASSERT_EQUAL_INT64(77, aisle_clock_processor(&self));
}
static void test_small_departures_are_no_jumps(void) {
    real += 1000000;
    TEST_ASSERT_FALSE(aisle_clock_check(&self));
    real -= 2000000;
    TEST_ASSERT_FALSE(aisle_clock_check(&self));
    TEST_ASSERT_FALSE(aisle_clock_departed(&self));
    TEST_ASSERT_EQUAL_INT64(0, self.jumps);
}
static void test_jump_is_counted_once_and_stays_visible_until_it_is_undone(void) {
    real += 1000001;
    TEST_ASSERT_TRUE(aisle_clock_check(&self));
    TEST_ASSERT_TRUE(aisle_clock_departed(&self));
    for (int i = 0; i < 10; i++) {
        pass(200000);
        TEST_ASSERT_FALSE(aisle_clock_check(&self));
    }
    TEST_ASSERT_TRUE(aisle_clock_departed(&self));
    real -= 1000001;
    TEST_ASSERT_TRUE(aisle_clock_check(&self));
    TEST_ASSERT_FALSE(aisle_clock_departed(&self));
    TEST_ASSERT_EQUAL_INT64(2, self.jumps);
}
static void test_clock_that_creeps_away_is_noticed(void) {
    bool noticed = false;
    for (int i = 0; i < 1100; i++) {
        pass(200000);
        real -= 1000;
        noticed = aisle_clock_check(&self) || noticed;
    }
    TEST_ASSERT_TRUE(noticed);
    TEST_ASSERT_EQUAL_INT64(1, self.jumps);
}
static void test_clock_of_the_host_runs(void) {
    aisle_clock host;
    aisle_clock_start(&host, aisle_clock_of_host());
    int64_t first = aisle_clock_monotonic(&host), second = aisle_clock_monotonic(&host);
    TEST_ASSERT_TRUE(second >= first && second - first < 1000000);
    TEST_ASSERT_TRUE(aisle_clock_utime(&host, second) > 1600000000000000);
    TEST_ASSERT_FALSE(aisle_clock_check(&host));
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_utime_is_real_time_at_start_plus_monotonic_progress);
    RUN_TEST(test_a_moment_of_real_time_is_as_long_ago_by_the_monotonic_clock);
    RUN_TEST(test_small_departures_are_no_jumps);
    RUN_TEST(test_jump_is_counted_once_and_stays_visible_until_it_is_undone);
    RUN_TEST(test_clock_that_creeps_away_is_noticed);
    RUN_TEST(test_clock_of_the_host_runs);
    return UNITY_END();
}
