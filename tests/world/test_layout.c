#include "layout_fixture.h"

static fix_scene scene;

void setUp(void) {
    fix_start();
}
void tearDown(void) {}

static void test_a_walk_meets_every_overlapping_zone_once_and_no_other(void) {
    static const uint32_t counts[] = {0, 1, 40, 200};
    aisle_rng rng = aisle_rng_seed(141);
    for (uint32_t c = 0; c < 4U; c++) {
        fix_start();
        fix_random_scene(&scene, &rng, counts[c], 1);
        fix_load(&scene);
        for (uint32_t trial = 0; trial < 3000U; trial++) {
            const aisle_vec2 lo = {gen_in(&rng, -3, 12), gen_in(&rng, -3, 10)};
            const double size = trial % 4U == 0U ? 0.0 : (trial % 4U == 1U ? 20.0 : 1.5);
            const aisle_aabb box = {lo, {lo.x + gen_in(&rng, 0, size), lo.y + gen_in(&rng, 0, size)}};
            uint32_t met[FIX_POLYGONS] = {0};
            const aisle_zone *zone;
            for (aisle_layout_walk w = aisle_layout_walk_over(&fix_layout, box); aisle_layout_walk_next(&w, &zone);) {
                met[zone - aisle_layout_zone(&fix_layout, 0)]++;
            }
            for (uint32_t i = 0; i < counts[c]; i++) {
                aisle_vec2 v[16];
                const aisle_convex shape = fix_shape(&scene.polygons[i], v);
                const aisle_aabb other = aisle_convex_aabb(&shape);
                const bool apart =
                    other.hi.x < box.lo.x || other.lo.x > box.hi.x || other.hi.y < box.lo.y || other.lo.y > box.hi.y;
                TEST_ASSERT_EQUAL_UINT32(apart ? 0 : 1, met[i]);
            }
        }
    }
}

static void test_a_walk_over_nothing_or_an_empty_box_ends_at_once(void) {
    const aisle_zone *zone;
    aisle_layout_walk w = aisle_layout_walk_over(&fix_layout, (aisle_aabb){{0, 0}, {5, 5}});
    TEST_ASSERT_FALSE(aisle_layout_walk_next(&w, &zone));
    aisle_rng rng = aisle_rng_seed(142);
    fix_random_scene(&scene, &rng, 100, 1);
    fix_load(&scene);
    w = aisle_layout_walk_over(&fix_layout, (aisle_aabb){{5, 5}, {0, 9}});
    TEST_ASSERT_FALSE(aisle_layout_walk_next(&w, &zone));
    TEST_ASSERT_FALSE(aisle_layout_walk_next(&w, &zone));
}

static void test_zone_shapes_are_the_polygons_sent(void) {
    aisle_rng rng = aisle_rng_seed(143);
    fix_random_scene(&scene, &rng, 50, 3);
    fix_load(&scene);
    for (uint32_t i = 0; i < 50U; i++) {
        const aisle_zone *zone = aisle_layout_zone(&fix_layout, i);
        const aisle_convex shape = aisle_layout_zone_shape(&fix_layout, zone);
        TEST_ASSERT_EQUAL_INT32(scene.polygons[i].id, zone->id);
        TEST_ASSERT_EQUAL_UINT32((uint32_t)scene.polygons[i].num_vertices, shape.n);
        TEST_ASSERT_EQUAL_MEMORY(scene.polygons[i].vertices, shape.v, shape.n * sizeof *shape.v);
        TEST_ASSERT_EQUAL_DOUBLE(0.0, shape.radius);
        TEST_ASSERT_EQUAL(scene.polygons[i].kind <= AISLE_POLYGON_KEEPOUT, aisle_zone_is_obstacle(zone));
    }
}

static void test_without_a_scan_the_bounds_are_those_sent(void) {
    aisle_rng rng = aisle_rng_seed(144);
    fix_random_scene(&scene, &rng, 5, 1);
    fix_set_bounds(&scene, -0.123, 0.456, 7.891, 9.012);
    fix_load(&scene);
    const aisle_aabb box = aisle_layout_bounds(&fix_layout);
    TEST_ASSERT_EQUAL_MEMORY((&(aisle_aabb){{-0.123, 0.456}, {7.891, 9.012}}), &box, sizeof box);
    TEST_ASSERT_FALSE(aisle_layout_has_scan(&fix_layout));
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_a_walk_meets_every_overlapping_zone_once_and_no_other);
    RUN_TEST(test_a_walk_over_nothing_or_an_empty_box_ends_at_once);
    RUN_TEST(test_zone_shapes_are_the_polygons_sent);
    RUN_TEST(test_without_a_scan_the_bounds_are_those_sent);
    return UNITY_END();
}
