#include "daemon/histogram.h" // first: proves that the header stands alone

#include "unity.h"

#include <stdlib.h>
#include <string.h>

static aisle_histogram self;

void setUp(void) {
    memset(&self, 0, sizeof self);
}
void tearDown(void) {}

static int compare(const void *a, const void *b) {
    const int64_t *x = a, *y = b;
    return (*x > *y) - (*x < *y);
}

static void test_without_durations_all_is_zero(void) {
    TEST_ASSERT_EQUAL_INT64(0, aisle_histogram_percentile(&self, 0.5));
    TEST_ASSERT_EQUAL_INT64(0, self.max_us);
}
static void test_small_durations_are_exact(void) {
    for (int64_t us = 0; us < 16; us++) {
        setUp();
        aisle_histogram_add(&self, us);
        TEST_ASSERT_EQUAL_INT64(us, aisle_histogram_percentile(&self, 0.99));
    }
}
static void test_percentiles_are_never_low_and_at_most_an_eighth_high(void) {
    enum { N = 5000 };
    static int64_t sample[N];
    uint64_t seed = 1;
    for (int i = 0; i < N; i++) {
        seed = seed * 6364136223846793005U + 1442695040888963407U;
        sample[i] = (int64_t)((seed >> 40) >> ((seed >> 35) % 24U)); // over all octaves up to 16 s
        aisle_histogram_add(&self, sample[i]);
    }
    qsort(sample, N, sizeof sample[0], compare);
    for (int percent = 1; percent <= 100; percent++) {
        int64_t exact = sample[(N * percent + 99) / 100 - 1];
        int64_t told = aisle_histogram_percentile(&self, (double)percent / 100.0);
        TEST_ASSERT_TRUE(told >= exact);
        TEST_ASSERT_TRUE((double)told <= (double)exact * 1.125 + 1.0);
    }
    TEST_ASSERT_EQUAL_INT64(sample[N - 1], aisle_histogram_percentile(&self, 1.0));
    TEST_ASSERT_EQUAL_INT64(N, self.count);
}
static void test_absurd_durations_stay_within_the_table(void) {
    aisle_histogram_add(&self, INT64_MAX);
    aisle_histogram_add(&self, INT64_MIN);
    TEST_ASSERT_EQUAL_INT64(2, self.count);
    TEST_ASSERT_EQUAL_INT64(0, aisle_histogram_percentile(&self, 0.5));
    TEST_ASSERT_EQUAL_INT64(INT64_MAX, self.max_us);
    TEST_ASSERT_TRUE(aisle_histogram_percentile(&self, 1.0) > (int64_t)1 << 39);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_without_durations_all_is_zero);
    RUN_TEST(test_small_durations_are_exact);
    RUN_TEST(test_percentiles_are_never_low_and_at_most_an_eighth_high);
    RUN_TEST(test_absurd_durations_stay_within_the_table);
    return UNITY_END();
}
