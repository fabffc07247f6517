#include "base/crc32.h" // first: proves that the header stands alone

#include "base/rng.h"
#include "unity.h"

#include <string.h>

static uint8_t bytes[5000];

void setUp(void) {
    aisle_rng rng = aisle_rng_seed(3);
    for (size_t i = 0; i < sizeof bytes; i++) {
        bytes[i] = (uint8_t)aisle_rng_next(&rng);
    }
}
void tearDown(void) {}

// Bit by bit, as the polynomial is defined.
static uint32_t slow_crc32(const uint8_t *at, size_t size) {
    uint32_t crc = UINT32_MAX;
    for (size_t i = 0; i < size; i++) {
        crc ^= at[i];
        for (int bit = 0; bit < 8; bit++) {
            crc = (crc & 1U) != 0 ? crc >> 1 ^ 0xEDB88320U : crc >> 1;
        }
    }
    return ~crc;
}

static void test_known_answers(void) {
    TEST_ASSERT_EQUAL_HEX32(0xCBF43926U, aisle_crc32(0, "123456789", 9));
    TEST_ASSERT_EQUAL_HEX32(0xE8B7BE43U, aisle_crc32(0, "a", 1));
    TEST_ASSERT_EQUAL_HEX32(0x414FA339U, aisle_crc32(0, "The quick brown fox jumps over the lazy dog", 43));
}

static void test_nothing_changes_nothing(void) {
    TEST_ASSERT_EQUAL_HEX32(0, aisle_crc32(0, NULL, 0));
    TEST_ASSERT_EQUAL_HEX32(0x12345678U, aisle_crc32(0x12345678U, bytes, 0));
}

static void test_every_length_and_alignment_agrees_with_the_definition(void) {
    for (size_t from = 0; from < 8; from++) {
        for (size_t size = 0; size < 300; size++) {
            TEST_ASSERT_EQUAL_HEX32(slow_crc32(bytes + from, size), aisle_crc32(0, bytes + from, size));
        }
    }
    TEST_ASSERT_EQUAL_HEX32(slow_crc32(bytes, sizeof bytes), aisle_crc32(0, bytes, sizeof bytes));
}

static void test_every_entry_of_every_table_is_right(void) { // eight bytes reach all eight tables
    for (uint32_t byte = 0; byte < 256; byte++) {
        for (size_t place = 0; place < 8; place++) {
            uint8_t word[8] = {0};
            word[place] = (uint8_t)byte;
            TEST_ASSERT_EQUAL_HEX32(slow_crc32(word, 8), aisle_crc32(0, word, 8));
        }
    }
}

static void test_pieces_give_the_crc_of_the_whole(void) {
    const uint32_t whole = aisle_crc32(0, bytes, sizeof bytes);
    for (size_t cut = 0; cut <= sizeof bytes; cut += 7) {
        TEST_ASSERT_EQUAL_HEX32(whole, aisle_crc32(aisle_crc32(0, bytes, cut), bytes + cut, sizeof bytes - cut));
    }
}

static void test_every_single_flipped_bit_is_noticed(void) {
    const uint32_t whole = aisle_crc32(0, bytes, 200);
    for (size_t bit = 0; bit < 1600; bit++) {
        bytes[bit / 8] ^= (uint8_t)(1U << (bit % 8));
        TEST_ASSERT_TRUE(aisle_crc32(0, bytes, 200) != whole);
        bytes[bit / 8] ^= (uint8_t)(1U << (bit % 8));
    }
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_known_answers);
    RUN_TEST(test_nothing_changes_nothing);
    RUN_TEST(test_every_length_and_alignment_agrees_with_the_definition);
    RUN_TEST(test_every_entry_of_every_table_is_right);
    RUN_TEST(test_pieces_give_the_crc_of_the_whole);
    RUN_TEST(test_every_single_flipped_bit_is_noticed);
    return UNITY_END();
}
