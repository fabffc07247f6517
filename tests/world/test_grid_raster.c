#include "world/grid_raster.h"

#include "gen.h"
#include "unity.h"

static aisle_raster raster;
static const aisle_lattice lattice = {-1.0, 2.0, 0.1, 60, 50};

void setUp(void) {}
void tearDown(void) {}

static void expect_cells(const aisle_convex *shape) {
    aisle_raster_of(&raster, &lattice, shape);
    for (uint32_t y = 0; y < lattice.h; y++) {
        uint32_t first = 0;
        uint32_t end = 0;
        if (y >= raster.first_row && y < raster.end_row) {
            aisle_raster_row(&raster, y, &first, &end);
        }
        for (uint32_t x = 0; x < lattice.w; x++) {
            aisle_vec2 square[4];
            const aisle_vec2 lo = {lattice.x0 + x * lattice.res, lattice.y0 + y * lattice.res};
            gen_box(lo, aisle_vec2_of(lo.x + lattice.res, lo.y + lattice.res), square);
            const long double gap = judge_gap(shape, &(aisle_convex){square, 4, 0.0});
            const bool is_in = x >= first && x < end;
            TEST_ASSERT_TRUE(is_in ? gap <= 2e-6L * 0.1L + 1e-12L : gap > 0.0L);
        }
    }
}

static void test_rows_hold_the_cells_the_shape_touches(void) {
    aisle_rng rng = aisle_rng_seed(481);
    for (uint32_t trial = 0; trial < 60U; trial++) {
        aisle_vec2 v[8];
        const uint32_t n = 3U + aisle_rng_below(&rng, 6);
        const aisle_vec2 centre = {gen_in(&rng, -1.5, 5.5), gen_in(&rng, 1.5, 7.5)}; // some reach over the lattice
        gen_polygon(&rng, centre, gen_in(&rng, 0.01, 2.0), gen_in(&rng, 0.01, 0.6), n, v);
        expect_cells(&(aisle_convex){v, n, trial % 2U == 0U ? 0.0 : gen_in(&rng, 0.0, 0.4)});
    }
}

static void test_a_shape_beside_the_lattice_has_no_rows_or_empty_ones(void) {
    const aisle_vec2 p = {100.0, 4.0};
    aisle_raster_of(&raster, &lattice, &(aisle_convex){&p, 1, 0.3});
    for (uint32_t y = raster.first_row; y < raster.end_row; y++) {
        uint32_t first;
        uint32_t end;
        aisle_raster_row(&raster, y, &first, &end);
        TEST_ASSERT_TRUE(first >= end);
    }
    const aisle_vec2 above = {0.0, 100.0};
    aisle_raster_of(&raster, &lattice, &(aisle_convex){&above, 1, 0.3});
    TEST_ASSERT_TRUE(raster.first_row >= raster.end_row);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_rows_hold_the_cells_the_shape_touches);
    RUN_TEST(test_a_shape_beside_the_lattice_has_no_rows_or_empty_ones);
    return UNITY_END();
}
