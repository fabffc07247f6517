#include "world/grid_window.h"

#include "base/rng.h"
#include "cases.h"
#include "unity.h"

#include <stdlib.h>
#include <string.h>

enum { CELLS = 1 << 20, BLOCK = 2 * (CELLS * 2 + (int)(AISLE_GRID_WINDOW * sizeof(aisle_parabola))) + (1 << 17) };
static unsigned char *block;
static aisle_grid grid;  // kept exact by windows
static aisle_grid fresh; // built anew
static aisle_grid_window window;
static bool occupied[CELLS]; // the test's own
static bool is_freed;        // some cell since the last settle()

void setUp(void) {
    aisle_arena arena = aisle_arena_over(block, BLOCK);
    aisle_grid_carve(&grid, &arena, CELLS);
    aisle_grid_carve(&fresh, &arena, CELLS);
    aisle_grid_window_carve(&window, &arena);
    TEST_ASSERT_FALSE(arena.overflow);
}
void tearDown(void) {}

static void build(aisle_grid *self, uint32_t w, uint32_t h) {
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_grid_begin(self, &(aisle_lattice){0.0, 0.0, 1.0, w, h}));
    for (uint32_t i = 0; i < w * h; i++) {
        if (occupied[i]) {
            aisle_grid_mark_cell(self, i);
        }
    }
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_grid_build(self, UINT32_MAX));
}

static void begin(aisle_rng *rng, uint32_t w, uint32_t h, uint32_t per_million) {
    for (uint32_t i = 0; i < w * h; i++) {
        occupied[i] = aisle_rng_below(rng, 1000000) < per_million;
    }
    build(&grid, w, h);
}

static void set_cell(uint32_t i, bool is_occupied) {
    is_freed = is_freed || !is_occupied;
    occupied[i] = is_occupied;
    grid.field[i] = is_occupied ? 0U : AISLE_WINDOW_FREED;
}

static void settle(aisle_cells changed, uint32_t rows) {
    aisle_grid_window_find(&window, &grid, changed, is_freed);
    is_freed = false;
    uint32_t left = rows;
    while (aisle_grid_window_step(&window, &grid, &left) == AISLE_BUSY) {
        TEST_ASSERT_EQUAL_UINT32(0, left);
        left = rows;
    }
}

static void expect_fresh(void) {
    build(&fresh, grid.lattice.w, grid.lattice.h);
    TEST_ASSERT_EQUAL_MEMORY(fresh.field, grid.field, grid.lattice.w * grid.lattice.h * sizeof *grid.field);
}

// All cells of a rectangle become occupied, free, or one or the other at random.
static void change(aisle_rng *rng, aisle_cells c, uint32_t how) {
    for (int32_t y = c.y0; y < c.y1; y++) {
        for (int32_t x = c.x0; x < c.x1; x++) {
            const bool to = how < 2U ? how == 1U : aisle_rng_below(rng, 2) == 1U;
            const uint32_t i = (uint32_t)y * grid.lattice.w + (uint32_t)x;
            if (to != occupied[i]) {
                set_cell(i, to);
            }
        }
    }
}

static aisle_cells random_cells(aisle_rng *rng, uint32_t most) {
    const uint32_t w = grid.lattice.w;
    const uint32_t h = grid.lattice.h;
    const uint32_t cw = 1U + aisle_rng_below(rng, most < w ? most : w);
    const uint32_t ch = 1U + aisle_rng_below(rng, most < h ? most : h);
    const int32_t x0 = (int32_t)aisle_rng_below(rng, w - cw + 1U);
    const int32_t y0 = (int32_t)aisle_rng_below(rng, h - ch + 1U);
    return (aisle_cells){x0, y0, x0 + (int32_t)cw, y0 + (int32_t)ch};
}

static void check_edits(uint64_t seed, uint32_t w, uint32_t h, uint32_t per_million, uint32_t edits) {
    aisle_rng rng = aisle_rng_seed(seed);
    begin(&rng, w, h, per_million);
    for (uint32_t i = 0; i < edits; i++) {
        const aisle_cells c = random_cells(&rng, i % 3U == 0U ? 4U : 40U);
        change(&rng, c, aisle_rng_below(&rng, 3));
        settle(c, UINT32_MAX);
        expect_fresh();
    }
}

static void test_any_edit_of_small_lattices_gives_the_field_of_a_fresh_build(void) {
    aisle_rng rng = aisle_rng_seed(401);
    for (uint32_t trial = 0; trial < CASES(300U); trial++) {
        const uint32_t w = 1U + aisle_rng_below(&rng, 70);
        const uint32_t h = 1U + aisle_rng_below(&rng, 70);
        check_edits(402U + trial, w, h, trial % 4U == 0U ? 0U : 20000U, 20);
    }
}

static void test_any_edit_of_wide_open_lattices_does(void) {
    check_edits(410, 700, 900, 0, CASES(25U));
    check_edits(411, 1000, 700, 3, CASES(25U));
    check_edits(412, 1000, 1000, 30, CASES(25U));
    check_edits(413, 900, 1000, 1000, CASES(25U));
    check_edits(414, 3000, 300, 20, CASES(25U));
    check_edits(415, 300, 3000, 20, CASES(25U));
}

static void test_pieces_of_the_greatest_size_do(void) {
    aisle_rng rng = aisle_rng_seed(420);
    begin(&rng, 1000, 1000, 2);
    for (uint32_t i = 0; i < 12U; i++) {
        const int32_t x = (int32_t)aisle_rng_below(&rng, 489);
        const int32_t y = (int32_t)aisle_rng_below(&rng, 489);
        const aisle_cells c = {x, y, x + 512, y + 512};
        change(&rng, c, i % 2U);
        settle(c, UINT32_MAX);
        expect_fresh();
    }
}

static void test_any_slicing_gives_the_same_field(void) {
    for (uint32_t rows = 1; rows < 2000U; rows = rows * 3U + 1U) {
        aisle_rng rng = aisle_rng_seed(430);
        begin(&rng, 500, 400, 50);
        for (uint32_t i = 0; i < 6U; i++) {
            const aisle_cells c = random_cells(&rng, 30);
            change(&rng, c, i % 3U);
            settle(c, rows);
        }
        expect_fresh();
    }
}

static void test_rows_of_work_are_told_before(void) {
    aisle_rng rng = aisle_rng_seed(440);
    begin(&rng, 500, 400, 50);
    for (uint32_t how = 2; how-- > 0U;) {
        const aisle_cells c = {100, 100, 110, 120};
        change(&rng, c, how);
        aisle_grid_window_find(&window, &grid, c, how == 0U);
        const uint32_t height = (uint32_t)(window.box.y1 - window.box.y0);
        uint32_t left = aisle_grid_window_rows(&window);
        TEST_ASSERT_TRUE(how == 1U ? left == height : left >= 4U * height && left < 4U * height + 520U);
        left--;
        TEST_ASSERT_EQUAL(AISLE_BUSY, aisle_grid_window_step(&window, &grid, &left));
        TEST_ASSERT_EQUAL_UINT32(0, left);
        TEST_ASSERT_EQUAL(AISLE_BUSY, aisle_grid_window_step(&window, &grid, &left));
        left = 5;
        TEST_ASSERT_EQUAL(AISLE_OK, aisle_grid_window_step(&window, &grid, &left));
        TEST_ASSERT_EQUAL_UINT32(4, left);
        TEST_ASSERT_EQUAL(AISLE_OK, aisle_grid_window_step(&window, &grid, &left));
        TEST_ASSERT_EQUAL_UINT32(4, left);
        expect_fresh();
    }
}

// The cells nearest to (0, 0) end to the right in a tip so thin that column 11 has none of them, yet (12, 5) is one: it
// is 13 from (0, 0) and no nearer to the others. A window grown only while its frame changes would miss it.
static void test_cells_cut_off_from_what_changed_are_found(void) {
    static const int32_t others[][2] = {{1, -2}, {-1, 4}, {-2, -2}, {-2, -1}, {-2, 0}, {-2, 1}, {-2, 2}};
    for (uint32_t turn = 0; turn < 8U; turn++) {
        for (uint32_t how = 0; how < 2U; how++) { // it leaves, or it comes
            memset(occupied, 0, sizeof occupied);
            for (uint32_t i = 0; i < sizeof others / sizeof others[0]; i++) {
                const int32_t x = turn % 2U == 0U ? others[i][0] : -others[i][0];
                const int32_t y = turn / 2U % 2U == 0U ? others[i][1] : -others[i][1];
                occupied[(30 + (turn < 4U ? y : x)) * 60 + 30 + (turn < 4U ? x : y)] = true;
            }
            occupied[30 * 60 + 30] = how == 0U;
            build(&grid, 60, 60);
            set_cell(30 * 60 + 30, how == 1U);
            settle((aisle_cells){30, 30, 31, 31}, UINT32_MAX);
            expect_fresh();
        }
    }
}

// Among obstacles 20 cells apart nothing 30 cells off can change, whatever the lattice's size.
static void test_the_window_is_as_large_as_the_change_and_its_surroundings(void) {
    memset(occupied, 0, sizeof occupied);
    for (uint32_t i = 0; i < 1000U * 1000U; i++) {
        occupied[i] = i % 20U == 0U && i / 1000U % 20U == 0U;
    }
    build(&grid, 1000, 1000);
    const aisle_cells c = {507, 503, 509, 505};
    aisle_rng rng = aisle_rng_seed(450);
    for (uint32_t how = 2; how-- > 0U;) {
        change(&rng, c, how);
        settle(c, UINT32_MAX);
        expect_fresh();
        TEST_ASSERT_TRUE(window.box.x0 > c.x0 - 30 && window.box.x1 < c.x1 + 30 && window.box.y0 > c.y0 - 30 &&
                         window.box.y1 < c.y1 + 30);
        TEST_ASSERT_TRUE(aisle_grid_window_width(&window) < 120U);
    }
}

int main(void) {
    unsigned char *memory = malloc(BLOCK + 64);
    block = memory + (64U - (uintptr_t)memory % 64U) % 64U;
    UNITY_BEGIN();
    RUN_TEST(test_any_edit_of_small_lattices_gives_the_field_of_a_fresh_build);
    RUN_TEST(test_any_edit_of_wide_open_lattices_does);
    RUN_TEST(test_pieces_of_the_greatest_size_do);
    RUN_TEST(test_any_slicing_gives_the_same_field);
    RUN_TEST(test_rows_of_work_are_told_before);
    RUN_TEST(test_cells_cut_off_from_what_changed_are_found);
    RUN_TEST(test_the_window_is_as_large_as_the_change_and_its_surroundings);
    const int failures = UNITY_END();
    free(memory);
    return failures;
}
