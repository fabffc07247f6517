#include "world/id_map.h"

#include "base/rng.h"
#include "unity.h"

#include <string.h>

static unsigned char memory[65536 + 64];
static aisle_id_map map;

static void carve(uint32_t entries) {
    aisle_arena arena = aisle_arena_over(memory + (64U - (uintptr_t)memory % 64U) % 64U, 65536);
    aisle_id_map_carve(&map, &arena, entries);
    TEST_ASSERT_FALSE(arena.overflow);
}
void setUp(void) {
    carve(1000);
}
void tearDown(void) {}

static void test_what_was_added_is_found_and_nothing_else(void) {
    aisle_rng rng = aisle_rng_seed(91);
    static int32_t ids[1000];
    for (uint32_t i = 0; i < 1000U; i++) { // runs, multiples of the table's size, random ones: all distinct
        ids[i] = i < 300U ? (int32_t)(i + 1U)
                          : (i < 600U ? (int32_t)(i * 2048U)
                                      : (int32_t)(INT32_MAX - (int32_t)(i * 1000U + aisle_rng_below(&rng, 900))));
        TEST_ASSERT_NULL(aisle_id_map_find(&map, ids[i]));
        TEST_ASSERT_TRUE(aisle_id_map_add(&map, ids[i], i));
    }
    for (uint32_t i = 0; i < 1000U; i++) {
        TEST_ASSERT_EQUAL_UINT32(i, *aisle_id_map_find(&map, ids[i]));
        TEST_ASSERT_FALSE(aisle_id_map_add(&map, ids[i], 5000));
        TEST_ASSERT_EQUAL_UINT32(i, *aisle_id_map_find(&map, ids[i]));
    }
    TEST_ASSERT_NULL(aisle_id_map_find(&map, 301));
}

static void test_a_full_map_refuses_and_clear_empties_it(void) {
    carve(3);
    TEST_ASSERT_TRUE(aisle_id_map_add(&map, 5, 1));
    TEST_ASSERT_TRUE(aisle_id_map_add(&map, 6, 2));
    TEST_ASSERT_TRUE(aisle_id_map_add(&map, INT32_MAX, 3));
    TEST_ASSERT_FALSE(aisle_id_map_add(&map, 7, 4));
    TEST_ASSERT_NULL(aisle_id_map_find(&map, 7)); // ends though the map is full
    aisle_id_map_clear(&map);
    TEST_ASSERT_NULL(aisle_id_map_find(&map, 5));
    TEST_ASSERT_TRUE(aisle_id_map_add(&map, 7, 4));
}

static void test_values_can_be_changed_in_place(void) {
    TEST_ASSERT_TRUE(aisle_id_map_add(&map, 42, 1));
    *aisle_id_map_find(&map, 42) = 9;
    TEST_ASSERT_EQUAL_UINT32(9, *aisle_id_map_find(&map, 42));
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_what_was_added_is_found_and_nothing_else);
    RUN_TEST(test_a_full_map_refuses_and_clear_empties_it);
    RUN_TEST(test_values_can_be_changed_in_place);
    return UNITY_END();
}
