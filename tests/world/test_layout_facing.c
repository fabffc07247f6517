#include "world/layout_facing.h"

#include "layout_fixture.h"

static fix_scene scene;
static const aisle_vec2 any_side = {0.0, 0.0};

void setUp(void) {
    fix_start();
    memset(&scene, 0, sizeof scene);
    scene.parts = 1;
}
void tearDown(void) {}

static void check_point(aisle_vec2 p) {
    aisle_piece piece;
    int32_t id;
    double gap = aisle_layout_gap(&fix_layout, &(aisle_convex){&p, 1, 0.0}, 20.0, &id);
    TEST_ASSERT_TRUE(aisle_layout_piece_near(&fix_layout, p, 20.0, any_side, &piece));
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, gap, piece.gap);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, piece.gap, aisle_vec2_distance(p, piece.nearest));
    TEST_ASSERT_TRUE(piece.id == id || piece.gap <= gap + 1e-9);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, piece.gap,
                              (double)judge_gap(&(aisle_convex){&p, 1, 0.0}, &(aisle_convex){piece.v, piece.n, 0.0}));
    if (gap > 0.01) {
        TEST_ASSERT_FALSE(aisle_layout_piece_near(&fix_layout, p, gap - 0.001, any_side, &piece));
    }
}

static void test_the_nearest_piece_of_any_side_is_the_nearest_obstacle(void) {
    aisle_rng rng = aisle_rng_seed(61);
    for (uint32_t i = 0; i < 6U; i++) {
        fix_start();
        fix_random_scene(&scene, &rng, 10U * i, 1);
        if (i >= 3U) {
            fix_random_scan(&scene, &rng, 60, 50, 40, 2);
        }
        fix_load(&scene);
        for (uint32_t k = 0; k < 200U; k++) {
            double x = gen_in(&rng, scene.x_min, scene.x_max);
            double y = gen_in(&rng, scene.y_min, scene.y_max);
            check_point(aisle_vec2_of(x, y));
        }
    }
}

static void test_a_side_is_kept_to(void) {
    fix_set_bounds(&scene, 0, 0, 10, 8);
    fix_add_box(&scene, 1, 2, 3, 3, 5);
    fix_add_box(&scene, 2, 4.5, 3, 5, 5);
    fix_load(&scene);
    aisle_piece piece;
    const aisle_vec2 p = {3.5, 4.0};
    TEST_ASSERT_TRUE(aisle_layout_piece_near(&fix_layout, p, 5.0, any_side, &piece));
    TEST_ASSERT_EQUAL_INT32(1, piece.id);
    TEST_ASSERT_TRUE(aisle_layout_piece_near(&fix_layout, p, 5.0, aisle_vec2_of(1.0, 0.0), &piece));
    TEST_ASSERT_EQUAL_INT32(2, piece.id);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 4.5, piece.nearest.x);
    TEST_ASSERT_TRUE(aisle_layout_piece_near(&fix_layout, p, 5.0, aisle_vec2_of(0.0, 1.0), &piece));
    TEST_ASSERT_EQUAL_INT32(AISLE_LAYOUT_ID_BOUNDS, piece.id); // the upper side
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 8.0, piece.nearest.y);
    TEST_ASSERT_FALSE(aisle_layout_piece_near(&fix_layout, p, 0.9, aisle_vec2_of(1.0, 0.0), &piece));
}

static void test_the_gap_of_two_pieces_is_exact_and_its_ends_lie_on_them(void) {
    aisle_rng rng = aisle_rng_seed(62);
    for (uint32_t i = 0; i < 4000U; i++) {
        aisle_piece a = {.id = 1}, b = {.id = 2};
        a.n = 2U + aisle_rng_below(&rng, 7);
        b.n = 2U + aisle_rng_below(&rng, 7);
        gen_polygon(&rng, aisle_vec2_of(0.0, 0.0), gen_in(&rng, 0.1, 1.0), gen_in(&rng, 0.1, 1.0), a.n, a.v);
        gen_polygon(&rng, aisle_vec2_of(gen_in(&rng, -3.0, 3.0), 1.5), gen_in(&rng, 0.1, 1.0), gen_in(&rng, 0.1, 1.0),
                    b.n, b.v);
        const aisle_convex sa = {a.v, a.n, 0.0}, sb = {b.v, b.n, 0.0};
        aisle_vec2 on_a, on_b;
        double gap = aisle_piece_gap(&a, &b, aisle_vec2_of(0.0, 1.0), &on_a, &on_b);
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, (double)judge_gap(&sa, &sb), gap);
        if (gap > 0.0) {
            TEST_ASSERT_DOUBLE_WITHIN(1e-9, gap, aisle_vec2_distance(on_a, on_b));
            TEST_ASSERT_DOUBLE_WITHIN(1e-9, 0.0, (double)judge_gap(&sa, &(aisle_convex){&on_a, 1, 0.0}));
            TEST_ASSERT_DOUBLE_WITHIN(1e-9, 0.0, (double)judge_gap(&sb, &(aisle_convex){&on_b, 1, 0.0}));
        }
    }
}

static void test_of_parallel_sides_the_pair_next_to_the_place_is_taken(void) {
    const aisle_piece a = {.v = {{0, 0}, {1, 0}, {1, 5}, {0, 5}}, .n = 4U};
    const aisle_piece b = {.v = {{2, 0}, {3, 0}, {3, 5}, {2, 5}}, .n = 4U};
    aisle_vec2 on_a, on_b;
    TEST_ASSERT_EQUAL_DOUBLE(1.0, aisle_piece_gap(&a, &b, aisle_vec2_of(1.4, 3.3), &on_a, &on_b));
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 3.3, on_a.y);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 3.3, on_b.y);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_the_nearest_piece_of_any_side_is_the_nearest_obstacle);
    RUN_TEST(test_a_side_is_kept_to);
    RUN_TEST(test_the_gap_of_two_pieces_is_exact_and_its_ends_lie_on_them);
    RUN_TEST(test_of_parallel_sides_the_pair_next_to_the_place_is_taken);
    return UNITY_END();
}
