#include "base/rng.h" // first: proves that the header stands alone

#include "base/check.h"
#include "unity.h"

#include <setjmp.h>

static jmp_buf refused;

void aisle_assert_failed(const char *file, int line, const char *condition) {
    (void)file;
    (void)line;
    (void)condition;
    longjmp(refused, 1);
}

void setUp(void) {}
void tearDown(void) {}

// PCG-XSH-RR written down a second time, straight from the paper's figure.
static uint32_t paper_pcg(uint64_t *state) {
    const uint64_t old = *state;
    *state = old * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    uint32_t word = (uint32_t)((old ^ (old >> 18U)) >> 27U);
    for (uint64_t turns = old >> 59U; turns > 0; turns--) {
        word = (word >> 1) | ((word & 1U) << 31);
    }
    return word;
}

static void test_stream_is_the_papers(void) {
    for (uint64_t seed = 0; seed < 1000; seed++) {
        aisle_rng rng = aisle_rng_seed(seed);
        uint64_t state = rng.state;
        for (int i = 0; i < 100; i++) {
            TEST_ASSERT_EQUAL_HEX32(paper_pcg(&state), aisle_rng_next(&rng));
        }
    }
}

static void test_seed_is_the_first_word_of_splitmix64(void) { // known answers of seeds 0 and 1234567
    TEST_ASSERT_EQUAL_HEX64(UINT64_C(0xE220A8397B1DCDAF), aisle_rng_seed(0).state);
    TEST_ASSERT_EQUAL_HEX64(UINT64_C(6457827717110365317), aisle_rng_seed(1234567).state);
}

static void test_copy_forks_the_stream(void) {
    aisle_rng a = aisle_rng_seed(5);
    (void)aisle_rng_next(&a);
    aisle_rng b = a;
    for (int i = 0; i < 100; i++) {
        TEST_ASSERT_EQUAL_HEX32(aisle_rng_next(&a), aisle_rng_next(&b));
    }
}

static int bits_of(uint32_t word) {
    int count = 0;
    for (; word != 0; word &= word - 1U) {
        count++;
    }
    return count;
}

static void test_neighbouring_seeds_give_unrelated_streams(void) {
    int differing = 0; // of 64000 bits, half are expected; six sigma are 759
    for (uint64_t seed = 0; seed < 100; seed++) {
        aisle_rng a = aisle_rng_seed(seed);
        aisle_rng b = aisle_rng_seed(seed + 1);
        for (int i = 0; i < 20; i++) {
            differing += bits_of(aisle_rng_next(&a) ^ aisle_rng_next(&b));
        }
    }
    TEST_ASSERT_INT_WITHIN(759, 32000, differing);
}

static void test_every_bit_is_fair(void) { // six sigma of 100000 draws are 949
    aisle_rng rng = aisle_rng_seed(7);
    int ones[32] = {0};
    for (int i = 0; i < 100000; i++) {
        const uint32_t word = aisle_rng_next(&rng);
        for (int bit = 0; bit < 32; bit++) {
            ones[bit] += (int)(word >> bit & 1U);
        }
    }
    for (int bit = 0; bit < 32; bit++) {
        TEST_ASSERT_INT_WITHIN(949, 50000, ones[bit]);
    }
}

static void test_float_lies_in_zero_to_one_without_one(void) {
    aisle_rng rng = aisle_rng_seed(9);
    double sum = 0.0;
    float least = 1.0F;
    float most = 0.0F;
    for (int i = 0; i < 1000000; i++) {
        const float r = aisle_rng_float(&rng);
        TEST_ASSERT_TRUE(r >= 0.0F && r < 1.0F);
        least = r < least ? r : least;
        most = r > most ? r : most;
        sum += (double)r;
    }
    TEST_ASSERT_DOUBLE_WITHIN(6.0 * 0.29e-3, 0.5, sum / 1e6);
    TEST_ASSERT_TRUE(least < 1e-5F && most > 1.0F - 1e-5F);
}

static void test_float_of_the_greatest_word_is_below_one(void) {
    TEST_ASSERT_TRUE((float)(UINT32_MAX >> 8) * (1.0F / 16777216.0F) < 1.0F);
}

static void test_below_is_fair_for_small_and_awkward_ranges(void) {
    const uint32_t ranges[] = {1, 2, 3, 7, 10};
    for (size_t k = 0; k < sizeof ranges / sizeof ranges[0]; k++) {
        aisle_rng rng = aisle_rng_seed(k);
        int count[10] = {0};
        for (uint32_t i = 0; i < 10000U * ranges[k]; i++) {
            const uint32_t r = aisle_rng_below(&rng, ranges[k]);
            TEST_ASSERT_TRUE(r < ranges[k]);
            count[r]++;
        }
        for (uint32_t r = 0; r < ranges[k]; r++) {
            TEST_ASSERT_INT_WITHIN(600, 10000, count[r]);
        }
    }
}

static void test_below_is_fair_where_a_plain_modulo_is_not(void) {
    // n = 3 * 2^30: word % n would fall below 2^30 with probability 1/2 instead of 1/3.
    aisle_rng rng = aisle_rng_seed(11);
    int low = 0;
    for (int i = 0; i < 30000; i++) {
        low += aisle_rng_below(&rng, 3U << 30) < 1U << 30;
    }
    TEST_ASSERT_INT_WITHIN(490, 10000, low);
}

static void test_below_draws_unfair_words_again(void) {
    // n = 2^31 + 1: words whose product has a low half below 2^32 mod n = 2^31 - 1 are drawn again, about half of them.
    aisle_rng rng = aisle_rng_seed(13);
    aisle_rng plain = rng;
    const uint32_t n = (1U << 31) + 1U;
    uint32_t again = 0;
    for (int i = 0; i < 10000; i++) {
        const uint32_t got = aisle_rng_below(&rng, n);
        uint64_t product = (uint64_t)aisle_rng_next(&plain) * n;
        while ((product & UINT32_MAX) < (1U << 31) - 1U) {
            again++;
            product = (uint64_t)aisle_rng_next(&plain) * n;
        }
        TEST_ASSERT_EQUAL_UINT32((uint32_t)(product >> 32), got);
    }
    TEST_ASSERT_TRUE(again > 9000 && again < 11000);
}

static void test_below_zero_is_a_broken_invariant(void) {
    aisle_rng rng = aisle_rng_seed(1);
    if (setjmp(refused) == 0) {
        (void)aisle_rng_below(&rng, 0);
        TEST_FAIL_MESSAGE("an empty range was accepted");
    }
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_stream_is_the_papers);
    RUN_TEST(test_seed_is_the_first_word_of_splitmix64);
    RUN_TEST(test_copy_forks_the_stream);
    RUN_TEST(test_neighbouring_seeds_give_unrelated_streams);
    RUN_TEST(test_every_bit_is_fair);
    RUN_TEST(test_float_lies_in_zero_to_one_without_one);
    RUN_TEST(test_float_of_the_greatest_word_is_below_one);
    RUN_TEST(test_below_is_fair_for_small_and_awkward_ranges);
    RUN_TEST(test_below_is_fair_where_a_plain_modulo_is_not);
    RUN_TEST(test_below_draws_unfair_words_again);
    RUN_TEST(test_below_zero_is_a_broken_invariant);
    return UNITY_END();
}
