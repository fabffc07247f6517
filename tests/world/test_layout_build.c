#include "layout_fixture.h"

static fix_scene scene;

void setUp(void) {
    fix_start();
}
void tearDown(void) {}

// Occupied by the judge: gap of at most 0 (or of at most the slack) to an obstacle's polygon, a scanned cell, or cut by
// the bounds.
static void check_cells(void) {
    const aisle_grid *grid = aisle_layout_grid(&fix_layout);
    const aisle_lattice *l = &grid->lattice;
    const aisle_aabb bounds = aisle_layout_bounds(&fix_layout);
    for (uint32_t cell = 0; cell < l->w * l->h; cell++) {
        const aisle_vec2 lo = {l->x0 + (cell % l->w) * l->res, l->y0 + (cell / l->w) * l->res};
        const aisle_vec2 hi = {lo.x + l->res, lo.y + l->res};
        aisle_vec2 square[4];
        gen_box(lo, hi, square);
        const double spare = 1e-9;
        const bool cut = lo.x < bounds.lo.x - spare || lo.y < bounds.lo.y - spare || hi.x > bounds.hi.x + spare ||
                         hi.y > bounds.hi.y + spare;
        bool occupied = cut || (scene.tiles > 0 && scene.occupied[cell]);
        bool near = occupied;
        for (uint32_t i = 0; i < scene.count && !occupied; i++) {
            aisle_vec2 v[16];
            const aisle_convex shape = fix_shape(&scene.polygons[i], v);
            if (scene.polygons[i].kind <= AISLE_POLYGON_KEEPOUT) {
                const long double gap = judge_gap(&shape, &(aisle_convex){square, 4, 0.0});
                occupied = gap <= 0.0L;
                near = near || gap <= 2e-6L * (long double)l->res;
            }
        }
        TEST_ASSERT_TRUE(aisle_grid_is_occupied(grid, cell) ? occupied || near : !occupied);
    }
}

static void test_grid_holds_obstacles_and_keepouts_and_nothing_else(void) {
    aisle_rng rng = aisle_rng_seed(161);
    for (uint32_t trial = 0; trial < 6U; trial++) {
        fix_start();
        fix_random_scene(&scene, &rng, 12, 1);
        scene.resolution = 0.1F;
        fix_load(&scene);
        TEST_ASSERT_EQUAL_UINT32(100, aisle_layout_grid(&fix_layout)->lattice.w);
        check_cells();
    }
}

static void test_grid_holds_scan_and_polygons(void) {
    aisle_rng rng = aisle_rng_seed(162);
    fix_random_scene(&scene, &rng, 6, 1);
    fix_random_scan(&scene, &rng, 61, 47, 9, 2);
    fix_load(&scene);
    check_cells();
}

static void test_cells_the_bounds_cut_are_occupied(void) {
    aisle_rng rng = aisle_rng_seed(163);
    fix_random_scene(&scene, &rng, 3, 1);
    scene.resolution = 0.1F;
    fix_set_bounds(&scene, 0, 0, 5.05, 4.01);
    fix_load(&scene);
    TEST_ASSERT_EQUAL_UINT32(51, aisle_layout_grid(&fix_layout)->lattice.w);
    check_cells();
    for (uint32_t side = 0; side < 4U; side++) { // a scan whose extent sticks out of the bounds on one side
        fix_start();
        fix_random_scene(&scene, &rng, 3, 1);
        fix_random_scan(&scene, &rng, 61, 47, 9, 2);
        fix_set_bounds(&scene, side == 0U ? 1.03 : 1.0, side == 1U ? 2.03 : 2.0, side == 2U ? 7.07 : 7.1,
                       side == 3U ? 6.67 : 6.7);
        fix_load(&scene);
        check_cells();
    }
}

static void test_bounds_of_the_field_hold_for_the_whole_layout(void) {
    aisle_rng rng = aisle_rng_seed(164);
    fix_random_scene(&scene, &rng, 8, 1);
    fix_random_scan(&scene, &rng, 61, 47, 200, 2);
    fix_set_bounds(&scene, 0.96, 2.03, 7.13, 6.66); // within half a cell of the scan's extent, wider and narrower
    fix_load(&scene);
    for (uint32_t i = 0; i < 5000U; i++) {
        const aisle_vec2 p = {gen_in(&rng, 0.96, 7.13), gen_in(&rng, 2.03, 6.66)};
        const double gap = aisle_layout_gap(&fix_layout, &(aisle_convex){&p, 1, 0.0}, 100.0, NULL);
        TEST_ASSERT_TRUE(aisle_grid_gap_lower(aisle_layout_grid(&fix_layout), p) <= gap);
        TEST_ASSERT_TRUE(aisle_grid_gap_upper(aisle_layout_grid(&fix_layout), p) >= gap);
    }
}

static void test_any_slicing_of_the_build_gives_the_same_grid(void) {
    static uint16_t whole[61 * 47];
    aisle_rng rng = aisle_rng_seed(165);
    fix_random_scene(&scene, &rng, 20, 1);
    fix_random_scan(&scene, &rng, 61, 47, 9, 2);
    for (uint32_t units = 1; units < 400U; units = units * 2U + 1U) {
        fix_start();
        fix_send(&scene);
        aisle_layout_commit(&fix_layout);
        uint32_t steps = 1;
        TEST_ASSERT_EQUAL(AISLE_BUSY, aisle_layout_build(&fix_layout, 0));
        while (aisle_layout_build(&fix_layout, units) == AISLE_BUSY) {
            TEST_ASSERT_FALSE(aisle_layout_is_in_force(&fix_layout));
            steps++;
        }
        const uint32_t items =
            47U + 4U + 20U + 47U + 1U + 3U * 47U; // rects, corners and indices and clear, zones, scan, border, field
        TEST_ASSERT_TRUE(steps >= items / units && steps <= items / units + 3U);
        TEST_ASSERT_EQUAL(AISLE_OK, aisle_layout_build(&fix_layout, units));
        if (units == 1U) {
            memcpy(whole, aisle_layout_grid(&fix_layout)->field, sizeof whole);
        }
        TEST_ASSERT_EQUAL_MEMORY(whole, aisle_layout_grid(&fix_layout)->field, sizeof whole);
    }
}

static void test_a_new_commit_in_the_middle_of_a_build_starts_it_over(void) {
    aisle_rng rng = aisle_rng_seed(166);
    for (uint32_t units = 1; units < 300U; units += units < 25U ? 1U : 23U) {
        fix_start();
        fix_random_scene(&scene, &rng, 20, 1);
        scene.resolution = 0.1F;
        fix_send(&scene);
        aisle_layout_commit(&fix_layout);
        (void)aisle_layout_build(&fix_layout, units);
        fix_random_scene(&scene, &rng, 9, 1);
        scene.map_revision = 2;
        scene.resolution = 0.2F;
        fix_load(&scene);
        for (uint32_t i = 0; i < scene.count; i++) { // grid and index are the new ones
            const aisle_zone *zone;
            aisle_layout_walk walk = aisle_layout_walk_over(&fix_layout, aisle_layout_zone(&fix_layout, i)->box);
            bool is_met = false;
            while (aisle_layout_walk_next(&walk, &zone)) {
                is_met = is_met || zone == aisle_layout_zone(&fix_layout, i);
            }
            TEST_ASSERT_TRUE(is_met);
        }
        check_cells();
    }
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_grid_holds_obstacles_and_keepouts_and_nothing_else);
    RUN_TEST(test_grid_holds_scan_and_polygons);
    RUN_TEST(test_cells_the_bounds_cut_are_occupied);
    RUN_TEST(test_bounds_of_the_field_hold_for_the_whole_layout);
    RUN_TEST(test_any_slicing_of_the_build_gives_the_same_grid);
    RUN_TEST(test_a_new_commit_in_the_middle_of_a_build_starts_it_over);
    return UNITY_END();
}
