#include "world/grid.h"

#include "cases.h"
#include "gen.h"
#include "unity.h"

#include <stdio.h>
#include <string.h>

enum { CELLS = 1 << 17, BLOCK = CELLS * 2 + AISLE_GRID_WINDOW * 12 + 256 };
static unsigned char *block;
static aisle_grid grid;
static bool marked[CELLS]; // the test's own occupancy

void setUp(void) {
    aisle_arena arena = aisle_arena_over(block, BLOCK);
    aisle_grid_carve(&grid, &arena, CELLS);
    TEST_ASSERT_FALSE(arena.overflow);
    memset(marked, 0, sizeof marked);
}
void tearDown(void) {}

static void begin(uint32_t w, uint32_t h) {
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_grid_begin(&grid, &(aisle_lattice){0.0, 0.0, 1.0, w, h}));
    memset(marked, 0, sizeof marked);
}

static void mark_at_random(aisle_rng *rng, uint32_t per_mille) {
    for (uint32_t i = 0; i < grid.lattice.w * grid.lattice.h; i++) {
        if (aisle_rng_below(rng, 1000) < per_mille) {
            aisle_grid_mark_cell(&grid, i);
            marked[i] = true;
        }
    }
}

// ---- lattice

static void test_sides_that_are_a_multiple_stay_it_and_others_round_up(void) {
    aisle_lattice l;
    TEST_ASSERT_TRUE(aisle_lattice_over(aisle_vec2_of(-1, 2), aisle_vec2_of(1, 12.3), 0.1, &l));
    TEST_ASSERT_EQUAL_UINT32(20, l.w);
    TEST_ASSERT_EQUAL_UINT32(103, l.h);
    TEST_ASSERT_TRUE(aisle_lattice_over(aisle_vec2_of(0, 0), aisle_vec2_of(1.01, 1e-9), 0.1, &l));
    TEST_ASSERT_EQUAL_UINT32(11, l.w);
    TEST_ASSERT_EQUAL_UINT32(1, l.h);
}

static void test_a_lattice_too_long_is_refused_with_the_sides_needed(void) {
    aisle_lattice l;
    TEST_ASSERT_TRUE(aisle_lattice_over(aisle_vec2_of(0, 0), aisle_vec2_of(65535, 65535), 1.0, &l));
    TEST_ASSERT_FALSE(aisle_lattice_over(aisle_vec2_of(0, 0), aisle_vec2_of(65536, 10), 1.0, &l));
    TEST_ASSERT_EQUAL_UINT32(65536, l.w);
    TEST_ASSERT_EQUAL_UINT32(10, l.h);
    TEST_ASSERT_FALSE(aisle_lattice_over(aisle_vec2_of(0, 0), aisle_vec2_of(10, 1e300), 1e-9, &l));
    TEST_ASSERT_EQUAL_UINT32(UINT32_MAX, l.h);
}

static void test_a_lattice_over_nonsense_is_refused_as_empty(void) {
    const aisle_vec2 zero = {0, 0};
    const aisle_vec2 one = {1, 1};
    aisle_lattice l;
    TEST_ASSERT_FALSE(aisle_lattice_over(one, zero, 1.0, &l));
    TEST_ASSERT_FALSE(aisle_lattice_over(zero, aisle_vec2_of((double)NAN, 1), 1.0, &l));
    TEST_ASSERT_FALSE(aisle_lattice_over(zero, aisle_vec2_of(1, (double)INFINITY), 1.0, &l));
    TEST_ASSERT_FALSE(aisle_lattice_over(zero, one, 0.0, &l));
    TEST_ASSERT_FALSE(aisle_lattice_over(zero, one, (double)NAN, &l));
    TEST_ASSERT_EQUAL_UINT32(0, l.w);
    TEST_ASSERT_EQUAL_UINT32(0, l.h);
}

static void test_cell_and_centre_are_inverse_and_outside_is_clamped(void) {
    const aisle_lattice l = {-3.0, 7.0, 0.05, 40, 30};
    bool inside;
    for (uint32_t cell = 0; cell < 1200U; cell++) {
        TEST_ASSERT_EQUAL_UINT32(cell, aisle_lattice_cell(&l, aisle_lattice_centre(&l, cell), &inside));
        TEST_ASSERT_TRUE(inside);
    }
    TEST_ASSERT_EQUAL_UINT32(1199, aisle_lattice_cell(&l, aisle_vec2_of(-1.0, 8.5), &inside)); // upper right border
    TEST_ASSERT_TRUE(inside);
    TEST_ASSERT_EQUAL_UINT32(1199, aisle_lattice_cell(&l, aisle_vec2_of(1e300, (double)INFINITY), &inside));
    TEST_ASSERT_FALSE(inside);
    TEST_ASSERT_EQUAL_UINT32(39, aisle_lattice_cell(&l, aisle_vec2_of(50.0, -9.0), &inside));
    TEST_ASSERT_FALSE(inside);
    (void)aisle_lattice_cell(&l, aisle_vec2_of((double)NAN, 8.0), &inside);
    TEST_ASSERT_FALSE(inside);
    TEST_ASSERT_EQUAL_UINT32(0, aisle_lattice_cell(&l, aisle_vec2_of(-9.0, (double)NAN), NULL));
}

static void test_begin_refuses_more_cells_than_carved_and_empty_lattices(void) {
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_grid_begin(&grid, &(aisle_lattice){0, 0, 1, CELLS / 4, 4}));
    TEST_ASSERT_EQUAL(AISLE_ERR_CAPACITY, aisle_grid_begin(&grid, &(aisle_lattice){0, 0, 1, CELLS / 4 + 1, 4}));
    TEST_ASSERT_EQUAL(AISLE_ERR_CAPACITY, aisle_grid_begin(&grid, &(aisle_lattice){0, 0, 1, 65535, 65535}));
    TEST_ASSERT_EQUAL(AISLE_ERR_ARG, aisle_grid_begin(&grid, &(aisle_lattice){0, 0, 1, 65536, 1}));
    TEST_ASSERT_EQUAL(AISLE_ERR_ARG, aisle_grid_begin(&grid, &(aisle_lattice){0, 0, 1, 0, 5}));
    TEST_ASSERT_EQUAL(AISLE_ERR_ARG, aisle_grid_begin(&grid, &(aisle_lattice){0, 0, (double)NAN, 5, 5}));
}

// ---- distance field

// Squared distance to the nearest occupied cell by looking at all of them; a frame of one cell around counts as such.
static uint32_t judge_field(uint32_t w, uint32_t h, uint32_t cell) {
    const int64_t cx = cell % w;
    const int64_t cy = cell / w;
    int64_t best = INT64_MAX;
    for (int64_t y = -1; y <= (int64_t)h; y++) {
        const int64_t dy = (y - cy) * (y - cy);
        for (int64_t x = -1; x <= (int64_t)w && dy < best; x++) {
            const bool frame = x < 0 || y < 0 || x == (int64_t)w || y == (int64_t)h;
            const int64_t sq = dy + (x - cx) * (x - cx);
            best = sq < best && (frame || marked[y * (int64_t)w + x]) ? sq : best;
        }
    }
    return best > 65535 ? 65535U : (uint32_t)best;
}

static void check_field(void) {
    const uint32_t w = grid.lattice.w;
    const uint32_t h = grid.lattice.h;
    for (uint32_t cell = 0; cell < w * h; cell++) {
        if (judge_field(w, h, cell) != grid.field[cell]) {
            char text[100];
            (void)snprintf(text, sizeof text, "%u x %u, cell (%u, %u)", w, h, cell % w, cell / w);
            TEST_ASSERT_EQUAL_UINT32_MESSAGE(judge_field(w, h, cell), grid.field[cell], text);
        }
    }
}

static void test_field_of_random_grids_is_the_brute_force_one(void) {
    static const uint32_t per_mille[] = {0, 1, 5, 30, 100, 300, 700, 1000};
    aisle_rng rng = aisle_rng_seed(21);
    for (uint32_t trial = 0; trial < 120U; trial++) {
        begin(1U + aisle_rng_below(&rng, 60), 1U + aisle_rng_below(&rng, 60));
        mark_at_random(&rng, per_mille[trial % 8U]);
        TEST_ASSERT_EQUAL(AISLE_OK, aisle_grid_build(&grid, UINT32_MAX));
        check_field();
    }
}

static void test_field_of_long_thin_grids_is_the_brute_force_one(void) {
    static const uint32_t sides[][2] = {{700, 5}, {5, 700}, {1200, 1}, {1, 1200}, {512, 2}, {257, 3}};
    aisle_rng rng = aisle_rng_seed(22);
    for (uint32_t i = 0; i < 6U; i++) {
        begin(sides[i][0], sides[i][1]);
        mark_at_random(&rng, 2);
        TEST_ASSERT_EQUAL(AISLE_OK, aisle_grid_build(&grid, UINT32_MAX));
        check_field();
    }
}

// Large and nearly empty: distances on both sides of saturation, in rows, columns and diagonals. Judged at sampled
// cells.
static void test_field_saturates_at_65535_and_is_exact_below(void) {
    aisle_rng rng = aisle_rng_seed(23);
    for (uint32_t trial = 0; trial < 12U; trial++) {
        begin(trial == 0U ? 233U : 362U, trial == 0U ? 562U : 362U);
        const uint32_t cells = grid.lattice.w * grid.lattice.h;
        for (uint32_t i = 0; i < trial; i++) {
            const uint32_t cell = aisle_rng_below(&rng, cells);
            aisle_grid_mark_cell(&grid, cell);
            marked[cell] = true;
        }
        TEST_ASSERT_EQUAL(AISLE_OK, aisle_grid_build(&grid, UINT32_MAX));
        for (uint32_t i = 0; i < 300U; i++) {
            const uint32_t cell = aisle_rng_below(&rng, cells);
            TEST_ASSERT_EQUAL_UINT32(judge_field(grid.lattice.w, grid.lattice.h, cell), grid.field[cell]);
        }
    }
}

// Wider than the carved grid of the other tests would need for saturation in both directions: rows of 511..1023 free
// columns between two walls, seen through one row 600 cells from the frame above and below.
static void test_row_pass_is_exact_around_saturation_whatever_the_gap_and_column_distances(void) {
    static unsigned char tall[2 * 1300 * 520 + AISLE_GRID_WINDOW * 12 + 256];
    unsigned char *aligned = tall + (64U - (uintptr_t)tall % 64U) % 64U;
    aisle_arena arena = aisle_arena_over(aligned, sizeof tall - 64U);
    aisle_grid big;
    aisle_grid_carve(&big, &arena, 1300U * 515U);
    TEST_ASSERT_FALSE(arena.overflow);
    aisle_rng rng = aisle_rng_seed(24);
    for (uint32_t trial = 0; trial < 6U; trial++) {
        TEST_ASSERT_EQUAL(AISLE_OK, aisle_grid_begin(&big, &(aisle_lattice){0, 0, 1, 1300, 515}));
        uint32_t occupied[40];
        const uint32_t n = trial * 8U;
        for (uint32_t i = 0; i < n; i++) {
            occupied[i] = aisle_rng_below(&rng, 1300U * 515U);
            aisle_grid_mark_cell(&big, occupied[i]);
        }
        TEST_ASSERT_EQUAL(AISLE_OK, aisle_grid_build(&big, UINT32_MAX));
        for (uint32_t y = 200; y < 315U; y += 3U) {
            for (uint32_t x = 0; x < 1300U; x++) {
                const uint32_t edge_x = (x < 1299U - x ? x : 1299U - x) + 1U;
                const uint32_t edge_y = (y < 514U - y ? y : 514U - y) + 1U;
                uint32_t best = edge_x < edge_y ? edge_x * edge_x : edge_y * edge_y;
                for (uint32_t i = 0; i < n; i++) {
                    const int32_t dx = (int32_t)x - (int32_t)(occupied[i] % 1300U);
                    const int32_t dy = (int32_t)y - (int32_t)(occupied[i] / 1300U);
                    const uint32_t sq = (uint32_t)(dx * dx + dy * dy);
                    best = sq < best ? sq : best;
                }
                best = best > 65535U ? 65535U : best;
                TEST_ASSERT_EQUAL_UINT32(best, big.field[y * 1300U + x]);
            }
        }
    }
}

static void test_any_slicing_of_the_build_gives_the_same_field(void) {
    static uint16_t whole[70 * 50];
    for (uint32_t slice = 1; slice < 160U; slice += (slice < 20U ? 1U : 13U)) {
        aisle_rng rng = aisle_rng_seed(25);
        begin(70, 50);
        mark_at_random(&rng, 20);
        uint32_t steps = 1;
        while (aisle_grid_build(&grid, slice) == AISLE_BUSY) {
            steps++;
        }
        TEST_ASSERT_EQUAL_UINT32((3U * 50U + slice - 1U) / slice, steps);
        TEST_ASSERT_EQUAL(AISLE_OK, aisle_grid_build(&grid, slice));
        if (slice == 1U) {
            memcpy(whole, grid.field, sizeof whole);
        }
        TEST_ASSERT_EQUAL_MEMORY(whole, grid.field, sizeof whole);
    }
}

// ---- rasterisation

// Gap, in cells, between a closed cell and the shape, by the judge; cells in the lattice of `grid`.
static long double judge_cell_gap(const aisle_convex *shape, uint32_t ix, uint32_t iy) {
    const aisle_lattice *l = &grid.lattice;
    aisle_vec2 cell[4];
    gen_box(aisle_vec2_of(l->x0 + ix * l->res, l->y0 + iy * l->res),
            aisle_vec2_of(l->x0 + (ix + 1U) * l->res, l->y0 + (iy + 1U) * l->res), cell);
    const aisle_convex square = {cell, 4, 0.0};
    return judge_gap(shape, &square) / (long double)l->res;
}

static void check_marks(const aisle_convex *shape) {
    for (uint32_t iy = 0; iy < grid.lattice.h; iy++) {
        for (uint32_t ix = 0; ix < grid.lattice.w; ix++) {
            const long double gap = judge_cell_gap(shape, ix, iy);
            const bool is_marked = grid.field[iy * grid.lattice.w + ix] == 0;
            if (is_marked ? gap > 2.0L * (long double)AISLE_GRID_SLACK : gap <= 0.0L) {
                char text[120];
                (void)snprintf(text, sizeof text, "cell (%u, %u) at %Lg cells: marked %d", ix, iy, gap, is_marked);
                TEST_FAIL_MESSAGE(text);
            }
        }
    }
}

static void test_marked_cells_are_those_the_closed_rounded_shape_touches(void) {
    aisle_rng rng = aisle_rng_seed(31);
    for (uint32_t trial = 0; trial < CASES(600U); trial++) {
        const double far = trial % 5U == 0U ? 9.9e4 : 0.0; // some far from the origin
        const aisle_lattice l = {far - 1.0, -2.0, 0.05, 1U + aisle_rng_below(&rng, 30), 1U + aisle_rng_below(&rng, 30)};
        TEST_ASSERT_EQUAL(AISLE_OK, aisle_grid_begin(&grid, &l));
        aisle_vec2 v[16];
        const uint32_t n = 1U + aisle_rng_below(&rng, 16);
        const aisle_vec2 centre = {gen_in(&rng, far - 1.5, far + 1.0), gen_in(&rng, -2.5, 0.0)};
        gen_polygon(&rng, centre, gen_in(&rng, 0.001, 1.0), gen_in(&rng, 0.001, 0.5), n, v);
        const double radius = trial % 3U == 0U ? 0.0 : gen_in(&rng, 0.0, 0.4);
        const aisle_convex shape = {v, n, radius};
        aisle_grid_mark_convex(&grid, &shape);
        check_marks(&shape);
    }
}

static void test_shapes_on_cell_borders_and_corners_mark_all_they_touch(void) {
    aisle_rng rng = aisle_rng_seed(32);
    for (uint32_t trial = 0; trial < CASES(2000U); trial++) {
        // whole and half cells; touching a border is touching both cells
        begin(12, 12);
        aisle_vec2 v[4];
        const double x = 0.5 * aisle_rng_below(&rng, 24);
        const double y = 0.5 * aisle_rng_below(&rng, 24);
        gen_box(aisle_vec2_of(x, y),
                aisle_vec2_of(x + 0.5 * aisle_rng_below(&rng, 5), y + 0.5 * aisle_rng_below(&rng, 5)), v);
        if (trial % 2U == 1U) { // a lozenge
            v[1] = aisle_vec2_of(x + 1.0, y - 1.0);
            v[2] = aisle_vec2_of(x + 2.0, y);
            v[3] = aisle_vec2_of(x + 1.0, y + 1.0);
        }
        const aisle_convex shape = {v, 1U + aisle_rng_below(&rng, 4) / 2U * 3U, 0.5 * aisle_rng_below(&rng, 3)};
        aisle_grid_mark_convex(&grid, &shape);
        check_marks(&shape);
    }
}

// Independent of any gap: clip the polygon to the cell (Sutherland-Hodgman) and see whether anything is left.
static uint32_t clip(const aisle_vec2 *in, uint32_t n, aisle_vec2 normal, double limit, aisle_vec2 *out) {
    uint32_t size = 0;
    for (uint32_t i = 0; i < n; i++) {
        const aisle_vec2 a = in[i];
        const aisle_vec2 b = in[(i + 1U) % n];
        const double da = aisle_vec2_dot(a, normal) - limit;
        const double db = aisle_vec2_dot(b, normal) - limit;
        if (da <= 0.0) {
            out[size++] = a;
        }
        if ((da < 0.0 && db > 0.0) || (da > 0.0 && db < 0.0)) {
            out[size++] = aisle_vec2_lerp(a, b, da / (da - db));
        }
    }
    return size;
}

static void test_marks_agree_with_clipping_the_polygon_to_every_cell(void) {
    aisle_rng rng = aisle_rng_seed(33);
    uint32_t marks = 0;
    for (uint32_t trial = 0; trial < CASES(1000U); trial++) {
        begin(25, 20);
        aisle_vec2 v[10];
        gen_polygon(&rng, aisle_vec2_of(gen_in(&rng, -3, 28), gen_in(&rng, -3, 23)), gen_in(&rng, 0.1, 12),
                    gen_in(&rng, 0.1, 9), 10, v);
        aisle_grid_mark_convex(&grid, &(aisle_convex){v, 10, 0.0});
        for (uint32_t cell = 0; cell < 500U; cell++) {
            const double x = cell % 25U;
            const double y = cell / 25U;
            aisle_vec2 a[20];
            aisle_vec2 b[20];
            uint32_t n = clip(v, 10, aisle_vec2_of(1, 0), x + 1.0, a);
            n = clip(a, n, aisle_vec2_of(-1, 0), -x, b);
            n = clip(b, n, aisle_vec2_of(0, 1), y + 1.0, a);
            n = clip(a, n, aisle_vec2_of(0, -1), -y, b);
            TEST_ASSERT_EQUAL(n > 0U, grid.field[cell] == 0); // random: nothing closer than the slack
            marks += n > 0U ? 1U : 0U;
        }
    }
    TEST_ASSERT_TRUE(marks > 10000U);
}

static void test_runs_are_clipped_to_the_row(void) {
    begin(10, 3);
    aisle_grid_mark_run(&grid, 1, 7, UINT32_MAX);
    aisle_grid_mark_run(&grid, 1, 4, 4);
    aisle_grid_mark_run(&grid, 1, 12, 20);
    for (uint32_t cell = 0; cell < 30U; cell++) {
        TEST_ASSERT_EQUAL(cell >= 17U && cell < 20U, grid.field[cell] == 0);
    }
}

// ---- bounds

static void test_bounds_hold_the_exact_gap_to_shapes_and_frame(void) {
    aisle_rng rng = aisle_rng_seed(41);
    for (uint32_t trial = 0; trial < 40U; trial++) {
        const aisle_lattice l = {-4.0, 3.0, 0.05, 150, 110};
        TEST_ASSERT_EQUAL(AISLE_OK, aisle_grid_begin(&grid, &l));
        aisle_vec2 v[3][6];
        aisle_convex shapes[3];
        for (uint32_t i = 0; i < 3U; i++) {
            gen_polygon(&rng, aisle_vec2_of(gen_in(&rng, -4, 3.5), gen_in(&rng, 3, 8.5)), 0.8, 0.3, 6, v[i]);
            shapes[i] = (aisle_convex){v[i], 6, 0.1 * i};
            aisle_grid_mark_convex(&grid, &shapes[i]);
        }
        TEST_ASSERT_EQUAL(AISLE_OK, aisle_grid_build(&grid, UINT32_MAX));
        for (uint32_t k = 0; k < 2000U; k++) {
            const aisle_vec2 p = {gen_in(&rng, -4, 3.5), gen_in(&rng, 3, 8.5)};
            const aisle_convex point = {&p, 1, 0.0};
            long double gap = fminl(fminl((long double)p.x + 4.0L, 3.5L - (long double)p.x),
                                    fminl((long double)p.y - 3.0L, 8.5L - (long double)p.y));
            for (uint32_t i = 0; i < 3U; i++) {
                gap = fminl(gap, judge_gap(&shapes[i], &point));
            }
            TEST_ASSERT_TRUE((long double)aisle_grid_gap_lower(&grid, p) <= gap);
            TEST_ASSERT_TRUE((long double)aisle_grid_gap_upper(&grid, p) >= gap);
            TEST_ASSERT_TRUE(aisle_grid_gap_upper(&grid, p) - aisle_grid_gap_lower(&grid, p) <= 4.0 * 0.0354);
        }
    }
}

static void test_outside_has_no_gap_and_a_saturated_cell_no_upper_bound(void) {
    static unsigned char memory[2 * 520 * 520 + AISLE_GRID_WINDOW * 12 + 256];
    unsigned char *aligned = memory + (64U - (uintptr_t)memory % 64U) % 64U;
    aisle_arena arena = aisle_arena_over(aligned, sizeof memory - 64U);
    aisle_grid big;
    aisle_grid_carve(&big, &arena, 520U * 520U);
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_grid_begin(&big, &(aisle_lattice){0, 0, 0.1, 520, 520}));
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_grid_build(&big, UINT32_MAX));
    const aisle_vec2 middle = {26.05, 26.05};
    TEST_ASSERT_TRUE(isinf(aisle_grid_gap_upper(&big, middle)));
    TEST_ASSERT_DOUBLE_WITHIN(0.08, 25.6, aisle_grid_gap_lower(&big, middle));
    const aisle_vec2 outside[] = {{-0.01, 5}, {5, -0.01}, {52.01, 5}, {5, 52.01}, {(double)NAN, 5}};
    for (uint32_t i = 0; i < 5U; i++) {
        TEST_ASSERT_EQUAL_DOUBLE(0.0, aisle_grid_gap_lower(&big, outside[i]));
        TEST_ASSERT_EQUAL_DOUBLE(0.0, aisle_grid_gap_upper(&big, outside[i]));
    }
}

static void test_carve_takes_two_bytes_a_cell_and_the_window(void) {
    aisle_arena measure = aisle_arena_measure();
    aisle_grid measured;
    aisle_grid_carve(&measured, &measure, 4194304);
    TEST_ASSERT_EQUAL_UINT64(2U * 4194304U + 12U * AISLE_GRID_WINDOW, measure.used);
}

int main(void) {
    static unsigned char memory[BLOCK + 64];
    block = memory + (64U - (uintptr_t)memory % 64U) % 64U;
    UNITY_BEGIN();
    RUN_TEST(test_sides_that_are_a_multiple_stay_it_and_others_round_up);
    RUN_TEST(test_a_lattice_too_long_is_refused_with_the_sides_needed);
    RUN_TEST(test_a_lattice_over_nonsense_is_refused_as_empty);
    RUN_TEST(test_cell_and_centre_are_inverse_and_outside_is_clamped);
    RUN_TEST(test_begin_refuses_more_cells_than_carved_and_empty_lattices);
    RUN_TEST(test_field_of_random_grids_is_the_brute_force_one);
    RUN_TEST(test_field_of_long_thin_grids_is_the_brute_force_one);
    RUN_TEST(test_field_saturates_at_65535_and_is_exact_below);
    RUN_TEST(test_row_pass_is_exact_around_saturation_whatever_the_gap_and_column_distances);
    RUN_TEST(test_any_slicing_of_the_build_gives_the_same_field);
    RUN_TEST(test_marked_cells_are_those_the_closed_rounded_shape_touches);
    RUN_TEST(test_shapes_on_cell_borders_and_corners_mark_all_they_touch);
    RUN_TEST(test_marks_agree_with_clipping_the_polygon_to_every_cell);
    RUN_TEST(test_runs_are_clipped_to_the_row);
    RUN_TEST(test_bounds_hold_the_exact_gap_to_shapes_and_frame);
    RUN_TEST(test_outside_has_no_gap_and_a_saturated_cell_no_upper_bound);
    RUN_TEST(test_carve_takes_two_bytes_a_cell_and_the_window);
    return UNITY_END();
}
