#include "base/pool.h" // first: proves that the header stands alone

#include "base/check.h"
#include "base/rng.h"
#include "unity.h"

#include <setjmp.h>
#include <string.h>

enum { CAPACITY = 37, STRIDE = 12, BYTES = 448 + 64 };
static unsigned char room[BYTES + 64];
static aisle_pool pool;
static jmp_buf refused;

void aisle_assert_failed(const char *file, int line, const char *condition) {
    (void)file;
    (void)line;
    (void)condition;
    longjmp(refused, 1);
}

static void carve(uint32_t capacity) {
    const uintptr_t past = (uintptr_t)room % AISLE_ARENA_ALIGN;
    aisle_arena arena = aisle_arena_over(room + (past == 0 ? 0 : AISLE_ARENA_ALIGN - past), 448);
    aisle_pool_carve(&pool, &arena, capacity, STRIDE);
    TEST_ASSERT_FALSE(arena.overflow);
}

void setUp(void) {
    carve(CAPACITY);
}
void tearDown(void) {}

static void test_takes_capacity_records_and_then_none(void) {
    for (uint32_t i = 0; i < CAPACITY; i++) {
        TEST_ASSERT_TRUE(aisle_pool_take(&pool) < CAPACITY);
    }
    TEST_ASSERT_EQUAL_UINT32(AISLE_POOL_NONE, aisle_pool_take(&pool));
    TEST_ASSERT_EQUAL_UINT32(CAPACITY, pool.used);
    TEST_ASSERT_TRUE(aisle_pool_invariants_hold(&pool));
}

static void test_measuring_counts_the_records(void) {
    aisle_arena arena = aisle_arena_measure();
    aisle_pool measured;
    aisle_pool_carve(&measured, &arena, CAPACITY, STRIDE);
    TEST_ASSERT_EQUAL_size_t((CAPACITY * STRIDE + 63) / 64 * 64, arena.used);
}

static void test_a_record_given_back_is_the_next_one_taken(void) {
    const uint32_t a = aisle_pool_take(&pool);
    const uint32_t b = aisle_pool_take(&pool);
    TEST_ASSERT_TRUE(a != b);
    aisle_pool_give(&pool, a);
    TEST_ASSERT_EQUAL_UINT32(a, aisle_pool_take(&pool));
    aisle_pool_give(&pool, a);
    aisle_pool_give(&pool, b);
    TEST_ASSERT_EQUAL_UINT32(b, aisle_pool_take(&pool));
    TEST_ASSERT_EQUAL_UINT32(a, aisle_pool_take(&pool));
}

// A model beside the pool: which records are out, and what was written into each.
static void live_through(uint64_t seed) {
    static bool out[CAPACITY];
    static unsigned char content[CAPACITY][STRIDE];
    memset(out, 0, sizeof out);
    uint32_t count = 0;
    uint32_t most = 0;
    aisle_rng rng = aisle_rng_seed(seed);
    carve(CAPACITY);
    for (int step = 0; step < 2000; step++) {
        const uint32_t at = aisle_rng_below(&rng, CAPACITY);
        if (out[at] && aisle_rng_below(&rng, 100) < 45U + (uint32_t)(seed % 10)) {
            TEST_ASSERT_EQUAL_MEMORY(content[at], aisle_pool_at(&pool, at), STRIDE);
            aisle_pool_give(&pool, at);
            out[at] = false;
            count--;
        } else {
            const uint32_t got = aisle_pool_take(&pool);
            TEST_ASSERT_EQUAL(count == CAPACITY, got == AISLE_POOL_NONE);
            if (got != AISLE_POOL_NONE) {
                TEST_ASSERT_TRUE(got < CAPACITY && !out[got]);
                out[got] = true;
                memset(content[got], (int)(step & 0xFF), STRIDE);
                memcpy(aisle_pool_at(&pool, got), content[got], STRIDE);
                count++;
            }
        }
        most = count > most ? count : most;
        TEST_ASSERT_TRUE(pool.used == count && pool.used_max == most && aisle_pool_invariants_hold(&pool));
    }
}

static void test_behaves_like_a_set_of_records_for_50_of_50_seeds(void) {
    for (uint64_t seed = 0; seed < 50; seed++) {
        live_through(seed);
    }
}

static void test_clear_empties_it_and_keeps_the_high_water_mark(void) {
    for (int i = 0; i < 9; i++) {
        (void)aisle_pool_take(&pool);
    }
    aisle_pool_give(&pool, 3);
    aisle_pool_clear(&pool);
    TEST_ASSERT_EQUAL_UINT32(0, pool.used);
    TEST_ASSERT_EQUAL_UINT32(9, pool.used_max);
    TEST_ASSERT_TRUE(aisle_pool_invariants_hold(&pool));
    test_takes_capacity_records_and_then_none();
}

static void test_works_when_its_records_were_moved(void) {
    static unsigned char elsewhere[CAPACITY * STRIDE];
    const uint32_t a = aisle_pool_take(&pool);
    const uint32_t b = aisle_pool_take(&pool);
    memset(aisle_pool_at(&pool, b), 0x5A, STRIDE);
    aisle_pool_give(&pool, a);
    memcpy(elsewhere, pool.records, sizeof elsewhere);
    pool.records = elsewhere;
    TEST_ASSERT_EQUAL_HEX8(0x5A, *(unsigned char *)aisle_pool_at(&pool, b));
    TEST_ASSERT_EQUAL_UINT32(a, aisle_pool_take(&pool));
}

static void test_capacity_zero_is_always_full(void) {
    carve(0);
    TEST_ASSERT_EQUAL_UINT32(AISLE_POOL_NONE, aisle_pool_take(&pool));
    TEST_ASSERT_TRUE(aisle_pool_invariants_hold(&pool));
}

static void test_invariants_notice_a_record_given_twice(void) {
    const uint32_t a = aisle_pool_take(&pool);
    (void)aisle_pool_take(&pool);
    aisle_pool_give(&pool, a);
    aisle_pool_give(&pool, a);
    TEST_ASSERT_FALSE(aisle_pool_invariants_hold(&pool));
}

static void test_invariants_notice_spoilt_fields(void) {
    for (int i = 0; i < 9; i++) {
        (void)aisle_pool_take(&pool);
    }
    for (uint32_t i = 0; i < 4; i++) {
        aisle_pool_give(&pool, i);
    }
    const aisle_pool good = pool;
    TEST_ASSERT_TRUE(aisle_pool_invariants_hold(&pool));
#define SPOIL(field, value)                                                                                            \
    pool = good;                                                                                                       \
    pool.field = (value);                                                                                              \
    TEST_ASSERT_FALSE_MESSAGE(aisle_pool_invariants_hold(&pool), #field " = " #value)
    SPOIL(stride, 3);
    SPOIL(used, 4);
    SPOIL(used, 6);
    SPOIL(used, CAPACITY + 1);
    SPOIL(used_max, 4);
    SPOIL(used_max, CAPACITY + 1);
    SPOIL(untouched, 3);
    SPOIL(untouched, CAPACITY + 1);
    SPOIL(free_head, AISLE_POOL_NONE);
    SPOIL(free_head, 9);
    SPOIL(capacity, 8);
    pool = good;
    const uint32_t loop = 3; // 3 -> 3 -> ...
    memcpy(pool.records + 3 * STRIDE, &loop, sizeof loop);
    TEST_ASSERT_FALSE(aisle_pool_invariants_hold(&pool));
}

static void test_a_record_never_taken_is_a_broken_invariant(void) {
    (void)aisle_pool_take(&pool);
    if (setjmp(refused) == 0) {
        (void)aisle_pool_at(&pool, 1);
        TEST_FAIL_MESSAGE("a record that was never taken was handed out");
    }
    if (setjmp(refused) == 0) {
        aisle_pool_give(&pool, 1);
        TEST_FAIL_MESSAGE("a record that was never taken was taken back");
    }
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_takes_capacity_records_and_then_none);
    RUN_TEST(test_measuring_counts_the_records);
    RUN_TEST(test_a_record_given_back_is_the_next_one_taken);
    RUN_TEST(test_behaves_like_a_set_of_records_for_50_of_50_seeds);
    RUN_TEST(test_clear_empties_it_and_keeps_the_high_water_mark);
    RUN_TEST(test_works_when_its_records_were_moved);
    RUN_TEST(test_capacity_zero_is_always_full);
    RUN_TEST(test_invariants_notice_a_record_given_twice);
    RUN_TEST(test_invariants_notice_spoilt_fields);
    RUN_TEST(test_a_record_never_taken_is_a_broken_invariant);
    return UNITY_END();
}
