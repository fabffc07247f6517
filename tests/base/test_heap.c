#include "base/heap.h" // first: proves that the header stands alone

#include "base/rng.h"
#include "unity.h"

#include <string.h>

enum { CAPACITY = 50, BYTES = 1024 };
static unsigned char room[BYTES + 64];
static aisle_heap heap;

static void carve(uint32_t capacity) {
    memset(room, 0xA5, sizeof room);
    const uintptr_t past = (uintptr_t)room % AISLE_ARENA_ALIGN;
    aisle_arena arena = aisle_arena_over(room + (past == 0 ? 0 : AISLE_ARENA_ALIGN - past), BYTES);
    aisle_heap_carve(&heap, &arena, capacity);
    TEST_ASSERT_FALSE(arena.overflow);
}

void setUp(void) {
    carve(CAPACITY);
}
void tearDown(void) {}

static void test_a_fresh_heap_is_empty(void) {
    TEST_ASSERT_EQUAL_UINT32(AISLE_HEAP_NONE, aisle_heap_pop(&heap));
    for (uint32_t item = 0; item < CAPACITY; item++) {
        TEST_ASSERT_FALSE(aisle_heap_contains(&heap, item));
    }
    TEST_ASSERT_TRUE(aisle_heap_invariants_hold(&heap));
}

static void test_measuring_counts_16_bytes_an_item(void) {
    aisle_arena arena = aisle_arena_measure();
    aisle_heap measured;
    aisle_heap_carve(&measured, &arena, 64);
    TEST_ASSERT_EQUAL_size_t(64 * 16, arena.used);
}

static void test_an_item_beyond_capacity_is_refused(void) {
    TEST_ASSERT_EQUAL(AISLE_ERR_ARG, aisle_heap_push(&heap, CAPACITY, 1));
    TEST_ASSERT_EQUAL(AISLE_ERR_ARG, aisle_heap_push(&heap, AISLE_HEAP_NONE, 1));
    TEST_ASSERT_EQUAL_UINT32(0, heap.count);
    TEST_ASSERT_FALSE(aisle_heap_contains(&heap, CAPACITY));
    TEST_ASSERT_FALSE(aisle_heap_contains(&heap, AISLE_HEAP_NONE));
}

static void test_equal_keys_leave_in_order_of_item(void) {
    for (uint32_t i = 0; i < CAPACITY; i++) {
        TEST_ASSERT_EQUAL(AISLE_OK, aisle_heap_push(&heap, i * 37U % CAPACITY, 5));
    }
    for (uint32_t i = 0; i < CAPACITY; i++) {
        TEST_ASSERT_EQUAL_UINT32(i, aisle_heap_pop(&heap));
    }
}

static void test_keys_use_all_64_bits(void) {
    (void)aisle_heap_push(&heap, 0, UINT64_MAX);
    (void)aisle_heap_push(&heap, 1, (uint64_t)1 << 32);
    (void)aisle_heap_push(&heap, 2, UINT32_MAX);
    TEST_ASSERT_EQUAL_UINT32(2, aisle_heap_pop(&heap));
    TEST_ASSERT_EQUAL_UINT32(1, aisle_heap_pop(&heap));
    TEST_ASSERT_EQUAL_UINT32(0, aisle_heap_pop(&heap));
}

static void test_a_lower_key_moves_an_item_forward_and_a_higher_one_nothing(void) {
    (void)aisle_heap_push(&heap, 1, 10);
    (void)aisle_heap_push(&heap, 2, 20);
    (void)aisle_heap_push(&heap, 2, 30);
    (void)aisle_heap_push(&heap, 1, 25);
    TEST_ASSERT_EQUAL_UINT32(2, heap.count);
    (void)aisle_heap_push(&heap, 2, 5);
    TEST_ASSERT_EQUAL_UINT32(2, aisle_heap_pop(&heap));
    TEST_ASSERT_EQUAL_UINT32(1, aisle_heap_pop(&heap));
}

static void test_a_popped_item_may_come_back_with_a_higher_key(void) {
    (void)aisle_heap_push(&heap, 1, 10);
    (void)aisle_heap_pop(&heap);
    TEST_ASSERT_FALSE(aisle_heap_contains(&heap, 1));
    (void)aisle_heap_push(&heap, 1, 99);
    (void)aisle_heap_push(&heap, 2, 50);
    TEST_ASSERT_EQUAL_UINT32(2, aisle_heap_pop(&heap));
    TEST_ASSERT_EQUAL_UINT32(1, aisle_heap_pop(&heap));
}

// The model: a plain array, searched from end to end.
static uint64_t model_key[CAPACITY];
static bool model_in[CAPACITY];

static uint32_t model_pop(void) {
    uint32_t least = AISLE_HEAP_NONE;
    for (uint32_t i = 0; i < CAPACITY; i++) {
        if (model_in[i] && (least == AISLE_HEAP_NONE || model_key[i] < model_key[least])) {
            least = i;
        }
    }
    if (least != AISLE_HEAP_NONE) {
        model_in[least] = false;
    }
    return least;
}

static void model_push(uint32_t item, uint64_t key) {
    model_key[item] = model_in[item] && model_key[item] < key ? model_key[item] : key;
    model_in[item] = true;
}

static void live_through(uint64_t seed) {
    memset(model_in, 0, sizeof model_in);
    aisle_heap_clear(&heap);
    aisle_rng rng = aisle_rng_seed(seed);
    for (int step = 0; step < 1000; step++) {
        if (aisle_rng_below(&rng, 10) < 3 + (uint32_t)(seed % 3)) {
            TEST_ASSERT_EQUAL_UINT32(model_pop(), aisle_heap_pop(&heap));
        } else {
            const uint32_t item = aisle_rng_below(&rng, CAPACITY);
            const uint64_t key = aisle_rng_below(&rng, seed % 2 == 0 ? 8 : 1000); // many ties, few ties
            model_push(item, key);
            TEST_ASSERT_EQUAL(AISLE_OK, aisle_heap_push(&heap, item, key));
        }
        TEST_ASSERT_TRUE(aisle_heap_invariants_hold(&heap));
        const uint32_t item = aisle_rng_below(&rng, CAPACITY);
        TEST_ASSERT_EQUAL(model_in[item], aisle_heap_contains(&heap, item));
    }
}

static void test_behaves_like_a_searched_array_for_60_of_60_seeds(void) {
    for (uint64_t seed = 0; seed < 60; seed++) {
        live_through(seed);
    }
}

static void test_clear_empties_it_and_keeps_the_high_water_mark(void) {
    for (uint32_t i = 0; i < 7; i++) {
        (void)aisle_heap_push(&heap, i, i);
    }
    (void)aisle_heap_pop(&heap);
    aisle_heap_clear(&heap);
    TEST_ASSERT_EQUAL_UINT32(7, heap.count_max);
    test_a_fresh_heap_is_empty();
}

static void test_a_forgotten_heap_works_whatever_its_arrays_hold(void) {
    memset(heap.key, 0xA5, CAPACITY * sizeof heap.key[0]);
    memset(heap.slot, 0x03, CAPACITY * sizeof heap.slot[0]);
    memset(heap.order, 0x5A, CAPACITY * sizeof heap.order[0]);
    aisle_heap_forget(&heap);
    TEST_ASSERT_EQUAL_UINT32(AISLE_HEAP_NONE, aisle_heap_pop(&heap));
    for (uint32_t item = 0; item < CAPACITY; item++) {
        TEST_ASSERT_EQUAL(AISLE_OK, aisle_heap_add(&heap, item, 1000U - 7U * item % 50U));
    }
    TEST_ASSERT_EQUAL(AISLE_ERR_ARG, aisle_heap_add(&heap, CAPACITY, 1));
    TEST_ASSERT_TRUE(aisle_heap_invariants_hold(&heap));
    uint64_t last = 0;
    for (uint32_t i = 0; i < CAPACITY; i++) {
        const uint32_t item = aisle_heap_pop(&heap);
        TEST_ASSERT_TRUE(heap.key[item] >= last);
        last = heap.key[item];
    }
    TEST_ASSERT_EQUAL_UINT32(AISLE_HEAP_NONE, aisle_heap_pop(&heap));
}

static void test_capacity_zero_takes_nothing(void) {
    carve(0);
    TEST_ASSERT_EQUAL(AISLE_ERR_ARG, aisle_heap_push(&heap, 0, 0));
    TEST_ASSERT_EQUAL_UINT32(AISLE_HEAP_NONE, aisle_heap_pop(&heap));
    TEST_ASSERT_TRUE(aisle_heap_invariants_hold(&heap));
}

static void test_invariants_notice_spoilt_fields(void) {
    for (uint32_t i = 0; i < 20; i++) {
        (void)aisle_heap_push(&heap, i, 100U - i);
    }
    TEST_ASSERT_TRUE(aisle_heap_invariants_hold(&heap));
#define SPOIL(field, value, back)                                                                                      \
    heap.field = (value);                                                                                              \
    TEST_ASSERT_FALSE_MESSAGE(aisle_heap_invariants_hold(&heap), #field " = " #value);                                 \
    heap.field = (back)
    SPOIL(count, 19, 20);
    SPOIL(count, CAPACITY + 1, 20);
    SPOIL(count_max, 19, 20);
    SPOIL(count_max, CAPACITY + 1, 20);
    SPOIL(slot[30], 4, AISLE_HEAP_NONE);
    const uint32_t leaf = heap.order[19];
    SPOIL(order[19], CAPACITY, leaf);
    SPOIL(order[19], heap.order[18], leaf);
    SPOIL(key[leaf], 0, 100U - leaf);
    SPOIL(slot[leaf], 2, 19);
    TEST_ASSERT_TRUE(aisle_heap_invariants_hold(&heap));
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_a_fresh_heap_is_empty);
    RUN_TEST(test_measuring_counts_16_bytes_an_item);
    RUN_TEST(test_an_item_beyond_capacity_is_refused);
    RUN_TEST(test_equal_keys_leave_in_order_of_item);
    RUN_TEST(test_keys_use_all_64_bits);
    RUN_TEST(test_a_lower_key_moves_an_item_forward_and_a_higher_one_nothing);
    RUN_TEST(test_a_popped_item_may_come_back_with_a_higher_key);
    RUN_TEST(test_behaves_like_a_searched_array_for_60_of_60_seeds);
    RUN_TEST(test_clear_empties_it_and_keeps_the_high_water_mark);
    RUN_TEST(test_a_forgotten_heap_works_whatever_its_arrays_hold);
    RUN_TEST(test_capacity_zero_takes_nothing);
    RUN_TEST(test_invariants_notice_spoilt_fields);
    return UNITY_END();
}
