#include "base/arena.h" // first: proves that the header stands alone

#include "base/check.h"
#include "unity.h"

#include <setjmp.h>
#include <string.h>

enum { SIZE = 1024 };
static unsigned char room[SIZE + 2 * AISLE_ARENA_ALIGN];
static unsigned char *block; // SIZE bytes in room, aligned; a canary behind it
static jmp_buf refused;

void aisle_assert_failed(const char *file, int line, const char *condition) {
    (void)file;
    (void)line;
    (void)condition;
    longjmp(refused, 1);
}

void setUp(void) {
    memset(room, 0xA5, sizeof room);
    const uintptr_t past = (uintptr_t)room % AISLE_ARENA_ALIGN;
    block = room + (past == 0 ? 0 : AISLE_ARENA_ALIGN - past);
}

void tearDown(void) {
    for (size_t i = 0; i < AISLE_ARENA_ALIGN; i++) {
        TEST_ASSERT_EQUAL_HEX8(0xA5, block[SIZE + i]);
    }
}

static void test_memory_is_zeroed_to_its_last_byte(void) {
    (void)aisle_arena_over(block, SIZE);
    for (size_t i = 0; i < SIZE; i++) {
        TEST_ASSERT_EQUAL_HEX8(0, block[i]);
    }
}

static void test_pieces_are_aligned_apart_and_inside(void) {
    aisle_arena arena = aisle_arena_over(block, SIZE);
    unsigned char *end = block;
    const size_t sizes[] = {1, 63, 64, 65, 100, 3};
    for (size_t i = 0; i < sizeof sizes / sizeof sizes[0]; i++) {
        unsigned char *piece = aisle_arena_take(&arena, sizes[i], 1);
        TEST_ASSERT_NOT_NULL(piece);
        TEST_ASSERT_EQUAL_size_t(0, (uintptr_t)piece % AISLE_ARENA_ALIGN);
        TEST_ASSERT_TRUE(piece >= end);
        end = piece + sizes[i];
        TEST_ASSERT_TRUE(end <= block + SIZE);
        memset(piece, 0xFF, sizes[i]);
    }
    TEST_ASSERT_EQUAL_size_t(64 + 64 + 64 + 128 + 128 + 64, arena.used);
    TEST_ASSERT_FALSE(arena.overflow);
}

static void take_some(aisle_arena *arena, unsigned seed) {
    for (int i = 0; i < 20; i++) {
        seed = seed * 1103515245U + 12345U;
        (void)aisle_arena_take(arena, seed >> 28, (seed >> 25) & 7U);
    }
}

static void test_measure_and_carve_agree_for_200_of_200_walks(void) {
    for (unsigned seed = 0; seed < 200; seed++) {
        aisle_arena counted = aisle_arena_measure();
        take_some(&counted, seed);
        TEST_ASSERT_TRUE(counted.used <= SIZE * 4U);
        if (counted.used > SIZE) {
            continue; // twenty pieces of at most 105 bytes: some walks do not fit, see below
        }
        aisle_arena carved = aisle_arena_over(block, counted.used);
        take_some(&carved, seed);
        TEST_ASSERT_FALSE(carved.overflow);
        TEST_ASSERT_EQUAL_size_t(counted.used, carved.used);
        if (counted.used >= AISLE_ARENA_ALIGN) {
            carved = aisle_arena_over(block, counted.used - 1);
            take_some(&carved, seed);
            TEST_ASSERT_TRUE(carved.overflow);
        }
    }
}

static void test_measuring_answers_null_and_counts_padding(void) {
    aisle_arena arena = aisle_arena_measure();
    TEST_ASSERT_NULL(aisle_arena_take(&arena, 3, 7));
    TEST_ASSERT_EQUAL_size_t(64, arena.used);
    TEST_ASSERT_FALSE(arena.overflow);
}

static void test_nothing_is_taken_for_a_count_or_size_of_zero(void) {
    aisle_arena arena = aisle_arena_over(block, SIZE);
    TEST_ASSERT_NULL(aisle_arena_take(&arena, 0, 8));
    TEST_ASSERT_NULL(aisle_arena_take(&arena, 8, 0));
    TEST_ASSERT_EQUAL_size_t(0, arena.used);
    TEST_ASSERT_FALSE(arena.overflow);
}

static void test_a_piece_that_does_not_fit_overflows_and_stays_so(void) {
    aisle_arena arena = aisle_arena_over(block, SIZE);
    TEST_ASSERT_NOT_NULL(aisle_arena_take(&arena, SIZE - 64, 1));
    TEST_ASSERT_NULL(aisle_arena_take(&arena, 65, 1));
    TEST_ASSERT_TRUE(arena.overflow);
    TEST_ASSERT_EQUAL_size_t(SIZE - 64, arena.used);
    TEST_ASSERT_NULL(aisle_arena_take(&arena, 1, 1)); // would fit
    TEST_ASSERT_TRUE(arena.overflow);
}

static void test_the_last_byte_can_be_taken(void) {
    aisle_arena arena = aisle_arena_over(block, SIZE);
    unsigned char *all = aisle_arena_take(&arena, SIZE / 8, 8);
    TEST_ASSERT_EQUAL_PTR(block, all);
    all[SIZE - 1] = 1;
    TEST_ASSERT_NULL(aisle_arena_take(&arena, 1, 1));
}

static void test_sizes_that_cannot_be_represented_overflow(void) {
    const size_t huge[][2] = {{SIZE_MAX, 2}, {2, SIZE_MAX}, {SIZE_MAX, 1}, {SIZE_MAX / 8 + 1, 8}, {SIZE_MAX - 62, 1}};
    for (size_t i = 0; i < sizeof huge / sizeof huge[0]; i++) {
        aisle_arena arena = aisle_arena_measure();
        TEST_ASSERT_NULL(aisle_arena_take(&arena, huge[i][0], huge[i][1]));
        TEST_ASSERT_TRUE(arena.overflow);
        TEST_ASSERT_EQUAL_size_t(0, arena.used);
    }
}

static void test_a_sum_that_cannot_be_represented_overflows(void) {
    aisle_arena arena = aisle_arena_measure();
    (void)aisle_arena_take(&arena, SIZE_MAX / 2, 1);
    TEST_ASSERT_FALSE(arena.overflow);
    (void)aisle_arena_take(&arena, SIZE_MAX / 2, 1);
    TEST_ASSERT_TRUE(arena.overflow);
}

static void test_unaligned_memory_is_a_broken_invariant(void) {
    if (setjmp(refused) == 0) {
        (void)aisle_arena_over(block + 8, 64);
        TEST_FAIL_MESSAGE("unaligned memory was accepted");
    }
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_memory_is_zeroed_to_its_last_byte);
    RUN_TEST(test_pieces_are_aligned_apart_and_inside);
    RUN_TEST(test_measure_and_carve_agree_for_200_of_200_walks);
    RUN_TEST(test_measuring_answers_null_and_counts_padding);
    RUN_TEST(test_nothing_is_taken_for_a_count_or_size_of_zero);
    RUN_TEST(test_a_piece_that_does_not_fit_overflows_and_stays_so);
    RUN_TEST(test_the_last_byte_can_be_taken);
    RUN_TEST(test_sizes_that_cannot_be_represented_overflow);
    RUN_TEST(test_a_sum_that_cannot_be_represented_overflows);
    RUN_TEST(test_unaligned_memory_is_a_broken_invariant);
    return UNITY_END();
}
