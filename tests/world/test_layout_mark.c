#include "layout_fixture.h"
#include "world/layout_mark.h"

static fix_scene scene;
static uint16_t before[FIX_CELLS];

void setUp(void) {
    fix_start();
}
void tearDown(void) {}

// In a rectangle of a free grid the marks are what the whole build has there; outside nothing is written.
static void check(aisle_rng *rng) {
    aisle_grid *grid = &fix_layout.grid;
    const uint32_t w = grid->lattice.w;
    const uint32_t cells = w * grid->lattice.h;
    memcpy(before, grid->field, cells * sizeof *before);
    for (uint32_t trial = 0; trial < 40U; trial++) {
        const int32_t x0 = (int32_t)aisle_rng_below(rng, w);
        const int32_t y0 = (int32_t)aisle_rng_below(rng, grid->lattice.h);
        const int32_t x1 = x0 + 1 + (int32_t)aisle_rng_below(rng, w - (uint32_t)x0);
        const int32_t y1 = y0 + 1 + (int32_t)aisle_rng_below(rng, grid->lattice.h - (uint32_t)y0);
        for (uint32_t i = 0; i < cells; i++) {
            grid->field[i] = 7;
        }
        aisle_layout_mark_all(&fix_layout, (aisle_cells){x0, y0, x1, y1});
        for (uint32_t i = 0; i < cells; i++) {
            const int32_t x = (int32_t)(i % w);
            const int32_t y = (int32_t)(i / w);
            const bool is_in = x >= x0 && x < x1 && y >= y0 && y < y1;
            TEST_ASSERT_EQUAL_UINT16(is_in && before[i] == 0 ? 0 : 7, grid->field[i]);
        }
    }
    memcpy(grid->field, before, cells * sizeof *before);
}

static void test_polygons_are_marked_within_the_rectangle(void) {
    aisle_rng rng = aisle_rng_seed(491);
    fix_random_scene(&scene, &rng, 40, 1);
    scene.resolution = 0.1F;
    fix_set_bounds(&scene, 0, 0, 9.95, 7.93);
    fix_load(&scene);
    check(&rng);
}

static void test_scans_and_what_the_bounds_cut_are_too(void) {
    aisle_rng rng = aisle_rng_seed(492);
    for (uint32_t side = 0; side < 4U; side++) {
        fix_start();
        fix_random_scene(&scene, &rng, 3, 1);
        fix_random_scan(&scene, &rng, 61, 47, 9, 2);
        fix_set_bounds(&scene, side == 0U ? 1.03 : 1.0, side == 1U ? 2.03 : 2.0, side == 2U ? 7.07 : 7.1,
                       side == 3U ? 6.67 : 6.7);
        fix_load(&scene);
        check(&rng);
    }
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_polygons_are_marked_within_the_rectangle);
    RUN_TEST(test_scans_and_what_the_bounds_cut_are_too);
    return UNITY_END();
}
