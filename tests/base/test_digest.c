#include "base/digest.h" // first: proves that the header stands alone

#include "base/rng.h"
#include "unity.h"

#include <string.h>

enum { LONGEST = 200 };

static uint8_t bytes[LONGEST + 8];

void setUp(void) {
    aisle_rng rng = aisle_rng_seed(5);
    for (size_t i = 0; i < sizeof bytes; i++) {
        bytes[i] = (uint8_t)aisle_rng_next(&rng);
    }
}
void tearDown(void) {}

static void test_any_bit_changed_changes_it(void) {
    for (size_t size = 1; size <= LONGEST; size++) {
        uint64_t right = aisle_digest(0, bytes, size);
        for (size_t bit = 0; bit < 8U * size; bit++) {
            bytes[bit / 8U] ^= (uint8_t)(1U << (bit % 8U));
            TEST_ASSERT_TRUE(right != aisle_digest(0, bytes, size));
            bytes[bit / 8U] ^= (uint8_t)(1U << (bit % 8U));
        }
        TEST_ASSERT_TRUE(right == aisle_digest(0, bytes, size));
    }
}

// Two bits at a time: no pair undoes itself.
static void test_no_two_changed_bits_cancel_out(void) {
    enum { BITS = 8 * 72 };
    uint64_t right = aisle_digest(0, bytes, BITS / 8);
    for (size_t a = 0; a < BITS; a++) {
        for (size_t b = 0; b < a; b++) {
            bytes[a / 8U] ^= (uint8_t)(1U << (a % 8U));
            bytes[b / 8U] ^= (uint8_t)(1U << (b % 8U));
            TEST_ASSERT_TRUE(right != aisle_digest(0, bytes, BITS / 8));
            bytes[a / 8U] ^= (uint8_t)(1U << (a % 8U));
            bytes[b / 8U] ^= (uint8_t)(1U << (b % 8U));
        }
    }
}

static void test_lengths_of_zeros_differ(void) {
    static const uint8_t zeros[LONGEST] = {0};
    uint64_t seen[LONGEST];
    for (size_t i = 0; i < LONGEST; i++) {
        seen[i] = aisle_digest(0, zeros, i);
        for (size_t k = 0; k < i; k++) {
            TEST_ASSERT_TRUE(seen[k] != seen[i]);
        }
    }
}

static void test_what_went_before_counts(void) {
    TEST_ASSERT_TRUE(aisle_digest(1, bytes, 20) != aisle_digest(2, bytes, 20));
    TEST_ASSERT_TRUE(aisle_digest(0, bytes, 16) != aisle_digest(aisle_digest(0, bytes, 8), bytes + 8, 8));
    TEST_ASSERT_TRUE(aisle_digest(aisle_digest(0, bytes, 8), bytes + 8, 8) !=
                     aisle_digest(aisle_digest(0, bytes + 8, 8), bytes, 8));
    (void)aisle_digest(0, NULL, 0);
}

static void test_alignment_does_not_matter(void) {
    uint8_t moved[LONGEST + 8];
    uint64_t right = aisle_digest(0, bytes, LONGEST);
    for (size_t off = 0; off < 8; off++) {
        memcpy(moved + off, bytes, LONGEST);
        TEST_ASSERT_TRUE(right == aisle_digest(0, moved + off, LONGEST));
    }
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_any_bit_changed_changes_it);
    RUN_TEST(test_no_two_changed_bits_cancel_out);
    RUN_TEST(test_lengths_of_zeros_differ);
    RUN_TEST(test_what_went_before_counts);
    RUN_TEST(test_alignment_does_not_matter);
    return UNITY_END();
}
