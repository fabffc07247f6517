#include "world/grid_field.h"

#include "base/rng.h"
#include "unity.h"

enum { BESIDE = 256, W_MAX = 900, ALL = W_MAX + 2 * BESIDE };
static aisle_parabola scratch[AISLE_GRID_WINDOW];
static uint16_t columns[ALL];
static uint16_t row[W_MAX];

void setUp(void) {}
void tearDown(void) {}

static uint32_t brute(int32_t x, int32_t first, int32_t end) { // of columns[first, end)
    uint32_t best = AISLE_FIELD_SQ_MAX;
    for (int32_t c = first; c < end; c++) {
        const uint32_t g = columns[c];
        const uint32_t sq = (uint32_t)((x - c) * (x - c)) + g * g;
        best = g < AISLE_FIELD_COLUMN_MAX && sq < best ? sq : best;
    }
    return best;
}

static void check(uint32_t left, uint32_t w, uint32_t right) {
    const uint32_t first = BESIDE - left;
    for (uint32_t i = 0; i < w; i++) {
        row[i] = columns[BESIDE + i];
    }
    aisle_field_transform(scratch, row, (int32_t)w, (aisle_field_beside){&columns[first], left},
                          (aisle_field_beside){&columns[BESIDE + w], right});
    for (uint32_t i = 0; i < w; i++) {
        TEST_ASSERT_EQUAL_UINT32(brute((int32_t)(BESIDE + i), (int32_t)first, (int32_t)(BESIDE + w + right)), row[i]);
    }
}

static void test_a_row_takes_in_the_columns_beside_and_nothing_else(void) {
    aisle_rng rng = aisle_rng_seed(471);
    for (uint32_t trial = 0; trial < 300U; trial++) {
        const uint32_t rare = 1U + aisle_rng_below(&rng, trial % 2U == 0U ? 3 : 500); // few or many columns count
        for (uint32_t i = 0; i < ALL; i++) {
            columns[i] = aisle_rng_below(&rng, rare) == 0U ? (uint16_t)aisle_rng_below(&rng, 257) : 256U;
        }
        check(aisle_rng_below(&rng, 257), 1U + aisle_rng_below(&rng, W_MAX), aisle_rng_below(&rng, 257));
    }
}

static void test_a_row_with_nothing_in_reach_saturates(void) {
    for (uint32_t i = 0; i < ALL; i++) {
        columns[i] = AISLE_FIELD_COLUMN_MAX;
    }
    check(0, W_MAX, 0);
    check(256, W_MAX, 256);
    columns[0] = 0; // 256 columns from the row's first
    check(256, 3, 0);
    columns[1] = 0;
    check(256, 3, 0);
}

static void test_rows_are_lowered_by_their_neighbours_and_the_outside(void) {
    const uint16_t neighbours[5] = {0, 3, 255, 256, 7};
    uint16_t cells[5] = {256, 2, 256, 256, 9};
    aisle_field_lower(cells, neighbours, 5);
    const uint16_t want[5] = {1, 2, 256, 256, 8};
    TEST_ASSERT_EQUAL_UINT16_ARRAY(want, cells, 5);
    aisle_field_lower_to_one(cells, 5);
    const uint16_t ones[5] = {1, 1, 1, 1, 1};
    TEST_ASSERT_EQUAL_UINT16_ARRAY(ones, cells, 5);
    cells[2] = 0;
    aisle_field_lower_to_one(cells, 5);
    TEST_ASSERT_EQUAL_UINT16(0, cells[2]);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_a_row_takes_in_the_columns_beside_and_nothing_else);
    RUN_TEST(test_a_row_with_nothing_in_reach_saturates);
    RUN_TEST(test_rows_are_lowered_by_their_neighbours_and_the_outside);
    return UNITY_END();
}
