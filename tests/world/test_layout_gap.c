#include "layout_fixture.h"

void setUp(void) {
    fix_start();
}
void tearDown(void) {}

static fix_scene scene;
static aisle_layout_without without; // what the judge leaves out

typedef struct nearest {
    long double gap;
    int32_t id;
} nearest;

static void offer(nearest *best, long double gap, int32_t id) {
    if (gap < best->gap || (gap <= best->gap && id < best->id)) {
        *best = (nearest){gap, id};
    }
}

static bool is_left_out(int32_t id) {
    return (without.count > 0U && without.id[0] == id) || (without.count > 1U && without.id[1] == id);
}

// All polygons, all cells, all four sides.
static nearest judge_nearest(const aisle_convex *body) {
    const aisle_aabb box = aisle_convex_aabb(body);
    long double inside =
        fminl((long double)box.lo.x - (long double)scene.x_min, (long double)scene.x_max - (long double)box.hi.x);
    inside = fminl(inside, fminl((long double)box.lo.y - (long double)scene.y_min,
                                 (long double)scene.y_max - (long double)box.hi.y));
    nearest best = {inside > 0.0L ? inside : 0.0L, AISLE_LAYOUT_ID_BOUNDS};
    for (uint32_t i = 0; i < scene.count; i++) {
        aisle_vec2 v[16];
        const aisle_convex shape = fix_shape(&scene.polygons[i], v);
        if (is_left_out(scene.polygons[i].id)) {
            continue;
        }
        if (scene.polygons[i].kind == AISLE_POLYGON_OBSTACLE || scene.polygons[i].kind == AISLE_POLYGON_KEEPOUT) {
            offer(&best, judge_gap(body, &shape), scene.polygons[i].id);
        }
    }
    for (uint32_t i = 0; i < scene.w * scene.h; i++) {
        if (scene.occupied[i]) {
            const aisle_vec2 lo = {scene.origin_x + 0.1 * (i % scene.w), scene.origin_y + 0.1 * (i / scene.w)};
            aisle_vec2 v[4];
            gen_box(lo, aisle_vec2_of(lo.x + 0.1, lo.y + 0.1), v);
            offer(&best, judge_gap(body, &(aisle_convex){v, 4, 0.0}), AISLE_LAYOUT_ID_SCAN);
        }
    }
    return best;
}

// The nearest one left out, and some other.
static void check_without(aisle_rng *rng, const aisle_convex *body, double cap, int32_t nearest_id) {
    without = (aisle_layout_without){{nearest_id, 123456}, 1U + aisle_rng_below(rng, 2)};
    if (scene.count > 0U) {
        without.id[1] = scene.polygons[aisle_rng_below(rng, scene.count)].id;
    }
    const nearest want = judge_nearest(body);
    int32_t id;
    const double gap = aisle_layout_gap_without(&fix_layout, &without, body, cap, &id);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, fmin((double)want.gap, cap), gap);
    TEST_ASSERT_EQUAL_INT32(want.gap <= (long double)cap ? want.id : 0, id);
    without.count = 0;
}

static void check_random_bodies(aisle_rng *rng, uint32_t trials) {
    for (uint32_t k = 0; k < trials; k++) {
        aisle_vec2 v[8];
        const uint32_t n = 1U + aisle_rng_below(rng, 8);
        const aisle_vec2 centre = {gen_in(rng, scene.x_min - 0.2, scene.x_max + 0.2),
                                   gen_in(rng, scene.y_min - 0.2, scene.y_max + 0.2)};
        gen_polygon(rng, centre, gen_in(rng, 0.01, 0.7), gen_in(rng, 0.01, 0.4), n, v);
        const aisle_convex body = {v, n, k % 2U == 0U ? 0.0 : gen_in(rng, 0.0, 0.3)};
        const double cap = k % 5U == 0U ? 100.0 : gen_in(rng, 0.0, 1.0);
        without.count = 0;
        const nearest want = judge_nearest(&body);
        int32_t id;
        const double gap = aisle_layout_gap(&fix_layout, &body, cap, &id);
        TEST_ASSERT_DOUBLE_WITHIN(1e-12, fmin((double)want.gap, cap), gap);
        TEST_ASSERT_EQUAL_INT32(want.gap <= (long double)cap ? want.id : 0, id);
        TEST_ASSERT_EQUAL_DOUBLE(gap, aisle_layout_gap(&fix_layout, &body, cap, NULL));
        check_without(rng, &body, cap, want.id);
    }
}

static void test_gap_and_id_are_those_of_all_polygons_and_the_bounds(void) {
    static const uint32_t counts[] = {0, 1, 5, 20, 60, 150};
    aisle_rng rng = aisle_rng_seed(51);
    for (uint32_t i = 0; i < 6U; i++) {
        fix_start();
        fix_random_scene(&scene, &rng, counts[i], 1);
        fix_load(&scene);
        check_random_bodies(&rng, 600);
    }
}

static void test_gap_and_id_are_those_of_all_cells_polygons_and_the_bounds(void) {
    static const uint32_t one_in[] = {2, 30, 400, 100000};
    aisle_rng rng = aisle_rng_seed(52);
    for (uint32_t i = 0; i < 4U; i++) {
        fix_start();
        fix_random_scene(&scene, &rng, i * 4U, 1);
        fix_random_scan(&scene, &rng, 60, 50, one_in[i], 2);
        fix_load(&scene);
        check_random_bodies(&rng, 150);
    }
}

static void test_equal_gaps_answer_the_least_id(void) {
    memset(&scene, 0, sizeof scene);
    scene.parts = 1;
    fix_set_bounds(&scene, 0, 0, 10, 10);
    fix_add_box(&scene, 9, 2, 4, 3, 6); // 1 m left of the body
    fix_add_box(&scene, 4, 5, 4, 6, 6); // 1 m right of it
    fix_add_box(&scene, 6, 2, 7, 6, 8); // 2 m above
    fix_load(&scene);
    const aisle_vec2 v[1] = {{4, 5}};
    int32_t id;
    TEST_ASSERT_EQUAL_DOUBLE(1.0, aisle_layout_gap(&fix_layout, &(aisle_convex){v, 1, 0.0}, 3.0, &id));
    TEST_ASSERT_EQUAL_INT32(4, id);
    TEST_ASSERT_EQUAL_DOUBLE(0.0, aisle_layout_gap(&fix_layout, &(aisle_convex){v, 1, 2.0}, 3.0, &id));
    TEST_ASSERT_EQUAL_INT32(4, id); // touches all three
    TEST_ASSERT_EQUAL_DOUBLE(0.0, aisle_layout_gap(&fix_layout, &(aisle_convex){v, 1, 4.0}, 3.0, &id));
    TEST_ASSERT_EQUAL_INT32(AISLE_LAYOUT_ID_BOUNDS, id);
    TEST_ASSERT_EQUAL_DOUBLE(0.5, aisle_layout_gap(&fix_layout, &(aisle_convex){v, 1, 0.0}, 0.5, &id));
    TEST_ASSERT_EQUAL_INT32(0, id);
}

static void test_the_outermost_rows_and_columns_of_a_scan_are_seen(void) {
    for (uint32_t side = 0; side < 4U; side++) {
        fix_start();
        memset(&scene, 0, sizeof scene);
        scene.parts = 1;
        aisle_rng rng = aisle_rng_seed(53);
        fix_random_scan(&scene, &rng, 60, 50, 1000000, 1);
        memset(scene.occupied, 0, sizeof scene.occupied);
        static const uint32_t cells[4] = {30, 49 * 60 + 30, 25 * 60, 25 * 60 + 59}; // below, above, left, right
        scene.occupied[cells[side]] = true;
        fix_load(&scene);
        aisle_vec2 v[4]; // 0.03 beside the cell along the border, 0.05 off the border
        const aisle_vec2 lo[4] = {{4.13, 2.05}, {4.13, 5.95}, {1.05, 4.63}, {5.95, 4.63}};
        gen_box(lo[side], aisle_vec2_of(lo[side].x + 1.0, lo[side].y + 1.0), v);
        int32_t id;
        TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0.03, aisle_layout_gap(&fix_layout, &(aisle_convex){v, 4, 0.0}, 1.0, &id));
        TEST_ASSERT_EQUAL_INT32(AISLE_LAYOUT_ID_SCAN, id);
    }
}

static void test_a_body_that_is_not_finite_is_in_contact(void) {
    memset(&scene, 0, sizeof scene);
    scene.parts = 1;
    fix_set_bounds(&scene, 0, 0, 10, 10);
    fix_load(&scene);
    const double bad[] = {(double)NAN, (double)INFINITY, -(double)INFINITY};
    for (uint32_t i = 0; i < 6U; i++) {
        aisle_vec2 v[2] = {{5, 5}, {6, 5}};
        *(i % 2U == 0U ? &v[i / 3U].x : &v[i / 3U].y) = bad[i % 3U];
        int32_t id = 0;
        TEST_ASSERT_EQUAL_DOUBLE(0.0, aisle_layout_gap(&fix_layout, &(aisle_convex){v, 2, 0.0}, 1.0, &id));
        TEST_ASSERT_EQUAL_INT32(AISLE_LAYOUT_ID_BOUNDS, id);
    }
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_gap_and_id_are_those_of_all_polygons_and_the_bounds);
    RUN_TEST(test_gap_and_id_are_those_of_all_cells_polygons_and_the_bounds);
    RUN_TEST(test_equal_gaps_answer_the_least_id);
    RUN_TEST(test_the_outermost_rows_and_columns_of_a_scan_are_seen);
    RUN_TEST(test_a_body_that_is_not_finite_is_in_contact);
    return UNITY_END();
}
