#include "layout_fixture.h"
#include "world/layout_content.h"

static fix_scene scene;

void setUp(void) {
    fix_start();
    aisle_rng rng = aisle_rng_seed(171);
    fix_random_scene(&scene, &rng, 30, 2);
}
void tearDown(void) {}

static uint64_t content_of_scene(void) {
    fix_start();
    fix_load(&scene);
    return aisle_layout_content(&fix_layout);
}

static void test_revision_parts_map_and_order_leave_no_trace(void) {
    const uint64_t content = content_of_scene();
    scene.map_revision = 9;
    scene.map_id = 8;
    scene.parts = 5;
    TEST_ASSERT_EQUAL_HEX64(content, content_of_scene());
    aisle_rng rng = aisle_rng_seed(172);
    for (uint32_t i = scene.count - 1U; i > 0U; i--) {
        const uint32_t k = aisle_rng_below(&rng, i + 1U);
        const aisle_polygon_msg swap = scene.polygons[i];
        scene.polygons[i] = scene.polygons[k];
        scene.polygons[k] = swap;
    }
    TEST_ASSERT_EQUAL_HEX64(content, content_of_scene());
}

static void test_tiles_leave_no_trace_but_every_cell_does(void) {
    aisle_rng rng = aisle_rng_seed(173);
    const uint64_t without = content_of_scene();
    fix_random_scan(&scene, &rng, 61, 47, 5, 1);
    const uint64_t content = content_of_scene();
    TEST_ASSERT_TRUE(content != without);
    scene.tiles = 9;
    TEST_ASSERT_EQUAL_HEX64(content, content_of_scene());
    for (uint32_t i = 0; i < 50U; i++) {
        const uint32_t cell = aisle_rng_below(&rng, 61U * 47U);
        scene.occupied[cell] = !scene.occupied[cell];
        TEST_ASSERT_TRUE(content_of_scene() != content);
        scene.occupied[cell] = !scene.occupied[cell];
    }
}

static void test_what_was_held_before_leaves_no_trace(void) {
    aisle_rng rng = aisle_rng_seed(174);
    fix_random_scan(&scene, &rng, 61, 47, 5, 2);
    const uint64_t content = content_of_scene();
    for (uint32_t i = 0; i < 4U; i++) { // either store again and again
        scene.map_revision++;
        fix_load(&scene);
        TEST_ASSERT_EQUAL_HEX64(content, aisle_layout_content(&fix_layout));
    }
}

static void expect_other(uint64_t content) {
    TEST_ASSERT_TRUE(content_of_scene() != content);
}

static void test_every_word_of_a_polygon_counts(void) {
    const uint64_t content = content_of_scene();
    const fix_scene was = scene;
    aisle_polygon_msg *p = &scene.polygons[4];
    p->id = 77;
    expect_other(content);
    scene = was;
    p->kind = p->kind == AISLE_POLYGON_KEEPOUT ? AISLE_POLYGON_OBSTACLE : AISLE_POLYGON_KEEPOUT;
    expect_other(content);
    scene = was;
    p->value = 0.25F;
    expect_other(content);
    scene = was;
    p->direction = 0.5F;
    expect_other(content);
    for (int32_t i = 0; i < 2 * was.polygons[4].num_vertices; i++) {
        scene = was;
        p->vertices[i / 2][i % 2] += 1e-12;
        expect_other(content);
    }
    scene = was;
    scene.count--;
    expect_other(content);
    scene = was;
    scene.x_max += 0.01;
    expect_other(content);
    scene = was;
    scene.resolution = 0.1F;
    expect_other(content);
}

static void test_polygons_that_swap_their_words_are_told_apart(void) {
    const aisle_vec2 v[3] = {{0, 0}, {1, 0}, {0, 1}};
    const aisle_vec2 swapped[3] = {{0, 1}, {1, 0}, {0, 0}};
    const aisle_vec2 mirrored[3] = {{0, 0}, {0, 1}, {1, 0}};
    const uint64_t one = aisle_content_of_polygon(1, 2, 0.5F, 0.25F, v, 3);
    TEST_ASSERT_TRUE(one != aisle_content_of_polygon(2, 1, 0.5F, 0.25F, v, 3));
    TEST_ASSERT_TRUE(one != aisle_content_of_polygon(1, 2, 0.25F, 0.5F, v, 3));
    TEST_ASSERT_TRUE(one != aisle_content_of_polygon(1, 2, 0.5F, 0.25F, swapped, 3));
    TEST_ASSERT_TRUE(one != aisle_content_of_polygon(1, 2, 0.5F, 0.25F, mirrored, 3));
    TEST_ASSERT_TRUE(aisle_content_of_run(1, 2, 3) != aisle_content_of_run(2, 1, 3));
    TEST_ASSERT_TRUE(aisle_content_of_run(1, 2, 4) != aisle_content_of_run(1, 2, 3) + aisle_content_of_run(1, 3, 4));
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_revision_parts_map_and_order_leave_no_trace);
    RUN_TEST(test_tiles_leave_no_trace_but_every_cell_does);
    RUN_TEST(test_what_was_held_before_leaves_no_trace);
    RUN_TEST(test_every_word_of_a_polygon_counts);
    RUN_TEST(test_polygons_that_swap_their_words_are_told_apart);
    return UNITY_END();
}
