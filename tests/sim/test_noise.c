#include "sim/noise.h" // first: proves that the header stands alone

#include "unity.h"

void setUp(void) {}
void tearDown(void) {}

static void test_normal_has_mean_0_deviation_1_and_is_bounded(void) {
    aisle_rng rng = aisle_rng_seed(1);
    double sum = 0.0, squares = 0.0;
    for (int i = 0; i < 100000; i++) {
        double x = aisle_sim_normal(&rng);
        TEST_ASSERT_TRUE(fabs(x) <= AISLE_SIM_SIGMAS);
        sum += x;
        squares += x * x;
    }
    TEST_ASSERT_DOUBLE_WITHIN(0.015, 0.0, sum / 1e5);
    TEST_ASSERT_DOUBLE_WITHIN(0.03, 0.98, squares / 1e5); // cut off at 3
}

static void test_pairs_never_leave_their_disc(void) {
    aisle_rng rng = aisle_rng_seed(2);
    double most = 0.0;
    for (int i = 0; i < 50000; i++) {
        most = fmax(most, aisle_vec2_length(aisle_sim_normal2(&rng, 0.1)));
    }
    TEST_ASSERT_TRUE(most <= 0.3 && most > 0.25);
}

static void test_drift_keeps_its_deviation_and_its_time(void) {
    aisle_rng rng = aisle_rng_seed(3);
    aisle_sim_drift d = aisle_sim_drift_of(&rng, 0.5, 2.0);
    double squares = 0.0, lagged = 0.0, before[400] = {0};
    const int n = 400000;
    for (int i = 0; i < n; i++) {
        aisle_sim_drift_step(&d, &rng, 0.005);
        TEST_ASSERT_TRUE(fabs(d.value) <= 1.5);
        squares += d.value * d.value;
        lagged += d.value * before[i % 400]; // 2 s ago
        before[i % 400] = d.value;
    }
    TEST_ASSERT_DOUBLE_WITHIN(0.05, 0.25, squares / n);
    TEST_ASSERT_DOUBLE_WITHIN(0.08, 0.368, lagged / squares); // exp(-1)
}

static void test_streams_differ_by_seed_and_by_use(void) {
    aisle_rng a = aisle_sim_stream(1, 1), b = aisle_sim_stream(1, 2), c = aisle_sim_stream(2, 1),
              d = aisle_sim_stream(1, 1);
    uint32_t first = aisle_rng_next(&a);
    TEST_ASSERT_TRUE(first != aisle_rng_next(&b) && first != aisle_rng_next(&c));
    TEST_ASSERT_EQUAL_UINT32(first, aisle_rng_next(&d));
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_normal_has_mean_0_deviation_1_and_is_bounded);
    RUN_TEST(test_pairs_never_leave_their_disc);
    RUN_TEST(test_drift_keeps_its_deviation_and_its_time);
    RUN_TEST(test_streams_differ_by_seed_and_by_use);
    return UNITY_END();
}
