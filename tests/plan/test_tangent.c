// The shortest way, its bound and its proofs against the brute-force oracle of tests/support/optimum.h.
#include "plan/tangent.h" // first: proves that the header stands alone

#include "../world/layout_fixture.h"
#include "cases.h"
#include "optimum.h"

#include <float.h>
#include <math.h>

enum { POINTS = 256, BLOCK = 8 << 20 };
#define AGREE 1e-6 // m, between our length and the oracle's
#define DOUBT 1e-7 // m, a way this narrow may be judged either way

static fix_scene scene;
static aisle_tangent tangent;
static unsigned char memory[BLOCK + AISLE_ARENA_ALIGN];
static aisle_vec2 points[POINTS];
static optimum_point corners[FIX_POLYGONS * 16 + FIX_CELLS * 4];
static optimum_polygon shapes[FIX_POLYGONS + FIX_CELLS];

static void carve(uint32_t cells) {
    size_t off = (AISLE_ARENA_ALIGN - (uintptr_t)memory % AISLE_ARENA_ALIGN) % AISLE_ARENA_ALIGN;
    aisle_arena arena = aisle_arena_over(memory + off, BLOCK);
    const aisle_limits limits = {.cells = cells, .polygons = FIX_POLYGONS, .vertices = FIX_VERTICES};
    memset(&tangent, 0, sizeof tangent);
    aisle_tangent_carve(&tangent, &arena, &limits);
    TEST_ASSERT_FALSE(arena.overflow);
}

void setUp(void) {
    carve(1048576U);
    memset(&scene, 0, sizeof scene);
}
void tearDown(void) {}

static void load(void) {
    fix_start();
    fix_load(&scene);
}

static aisle_status run_in_steps_of(uint32_t units, double radius, aisle_vec2 start, aisle_vec2 goal) {
    uint32_t spent = 0;
    aisle_tangent_start(&tangent, &fix_layout, radius, start, goal);
    aisle_status st;
    double bound = 0.0;
    do {
        st = aisle_tangent_step(&tangent, units, &spent);
        TEST_ASSERT_TRUE(tangent.bound >= bound); // it only rises
        bound = tangent.bound;
    } while (st == AISLE_BUSY);
    return st;
}

static aisle_status run(double radius, aisle_vec2 start, aisle_vec2 goal) {
    return run_in_steps_of(UINT32_MAX, radius, start, goal);
}

// ---- the oracle on the scene

static optimum_world *oracle_of(double radius) {
    size_t n = 0;
    size_t used = 0;
    for (uint32_t i = 0; i < scene.count; i++) {
        const aisle_polygon_msg *p = &scene.polygons[i];
        if (p->kind != AISLE_POLYGON_OBSTACLE && p->kind != AISLE_POLYGON_KEEPOUT) {
            continue;
        }
        shapes[n++] = (optimum_polygon){&corners[used], (size_t)p->num_vertices};
        for (int k = 0; k < p->num_vertices; k++) {
            corners[used++] = (optimum_point){p->vertices[k][0], p->vertices[k][1]};
        }
    }
    for (uint32_t i = 0; i < scene.w * scene.h; i++) {
        if (scene.occupied[i]) {
            double x = scene.origin_x + 0.1 * (i % scene.w);
            double y = scene.origin_y + 0.1 * (double)(i / scene.w);
            shapes[n++] = (optimum_polygon){&corners[used], 4};
            corners[used++] = (optimum_point){x, y};
            corners[used++] = (optimum_point){x + 0.1, y};
            corners[used++] = (optimum_point){x + 0.1, y + 0.1};
            corners[used++] = (optimum_point){x, y + 0.1};
        }
    }
    const double bounds[4] = {scene.x_min + radius, scene.y_min + radius, scene.x_max - radius, scene.y_max - radius};
    return optimum_polygons(radius, bounds, shapes, n);
}

typedef struct tally {
    int found, none, doubtful;
} tally;

// Is the oracle of two minds about this query: another answer for a disc a trifle larger or smaller?
static bool is_doubtful(double radius, aisle_vec2 start, aisle_vec2 goal) {
    double length[2];
    for (int i = 0; i < 2; i++) {
        optimum_world *world = oracle_of(fmax(radius + (i == 0 ? DOUBT : -DOUBT), 0.0));
        optimum_path path =
            optimum_shortest(world, (optimum_point){start.x, start.y}, (optimum_point){goal.x, goal.y}, INFINITY);
        length[i] = path.length;
        optimum_path_free(&path);
        optimum_free(world);
    }
    return isinf(length[0]) != isinf(length[1]) || fabs(length[0] - length[1]) > 1e-4;
}

static void compare(const optimum_world *world, double radius, aisle_vec2 start, aisle_vec2 goal, tally *t) {
    optimum_path path =
        optimum_shortest(world, (optimum_point){start.x, start.y}, (optimum_point){goal.x, goal.y}, INFINITY);
    aisle_status st = run(radius, start, goal);
    bool agree = path.result == OPTIMUM_FOUND
                     ? st == AISLE_OK && fabs(tangent.bound - path.length) < AGREE * (1.0 + path.length)
                     : st == AISLE_PARTIAL;
    if (!agree && is_doubtful(radius, start, goal)) {
        t->doubtful++;
    } else {
        char text[160];
        (void)snprintf(text, sizeof text, "radius %g from (%.9g, %.9g) to (%.9g, %.9g): %d %.9g, oracle %.9g", radius,
                       start.x, start.y, goal.x, goal.y, (int)st, tangent.bound, path.length);
        TEST_ASSERT_TRUE_MESSAGE(agree, text);
        *(st == AISLE_OK ? &t->found : &t->none) += 1;
    }
    optimum_path_free(&path);
}

static aisle_vec2 anywhere(aisle_rng *rng) {
    double x = gen_in(rng, scene.x_min, scene.x_max);
    double y = gen_in(rng, scene.y_min, scene.y_max);
    return aisle_vec2_of(x, y);
}

static void compare_some(aisle_rng *rng, double radius, int queries, tally *t) {
    optimum_world *world = oracle_of(radius);
    for (int i = 0; i < queries; i++) {
        aisle_vec2 start = anywhere(rng);
        aisle_vec2 goal = anywhere(rng);
        compare(world, radius, start, goal, t);
    }
    optimum_free(world);
}

// ---- tests

static void test_random_polygons_give_the_oracles_length_or_its_proof(void) {
    tally t = {0};
    for (uint32_t seed = 0; seed < CASES(60U); seed++) {
        aisle_rng rng = aisle_rng_seed(7000U + seed);
        fix_random_scene(&scene, &rng, 6U + seed, 1);
        load();
        static const double radii[4] = {0.0, 0.08, 0.2, 0.35};
        compare_some(&rng, radii[seed % 4U], 8, &t);
    }
    printf("polygons: %d ways, %d proofs, %d in doubt\n", t.found, t.none, t.doubtful);
    TEST_ASSERT_TRUE(t.found > LEAST(150) && t.none > LEAST(50) && t.doubtful < CASES(5));
}

static void test_random_scans_give_the_oracles_length_or_its_proof(void) {
    tally t = {0};
    for (uint32_t seed = 0; seed < CASES(24U); seed++) {
        aisle_rng rng = aisle_rng_seed(7100U + seed);
        fix_random_scene(&scene, &rng, 0, 1);
        fix_random_scan(&scene, &rng, 40, 30, 12U + 8U * (seed % 4U), 1);
        load();
        compare_some(&rng, 0.05 + 0.05 * (seed % 3U), 5, &t);
    }
    printf("scans: %d ways, %d proofs, %d in doubt\n", t.found, t.none, t.doubtful);
    TEST_ASSERT_TRUE(t.found > LEAST(30) && t.none > LEAST(20) && t.doubtful < CASES(5));
}

static void test_polygons_on_a_scan_count_together(void) {
    tally t = {0};
    for (uint32_t seed = 0; seed < CASES(12U); seed++) {
        aisle_rng rng = aisle_rng_seed(7200U + seed);
        fix_random_scene(&scene, &rng, 6, 1);
        fix_random_scan(&scene, &rng, 40, 30, 60, 2);
        load();
        compare_some(&rng, 0.12, 6, &t);
    }
    TEST_ASSERT_TRUE(t.found > LEAST(20) && t.doubtful < CASES(3));
}

// Boxes on a lattice: everything is aligned, touches or repeats.
static void test_aligned_touching_and_repeated_boxes_give_the_oracles_length(void) {
    tally t = {0};
    for (uint32_t seed = 0; seed < CASES(40U); seed++) {
        aisle_rng rng = aisle_rng_seed(7300U + seed);
        memset(&scene, 0, sizeof scene);
        scene.map_id = 7;
        scene.map_revision = 1;
        scene.parts = 1;
        fix_set_bounds(&scene, 0.0, 0.0, 10.0, 8.0);
        for (int32_t i = 0; i < 14; i++) {
            double x = 0.5 * (double)aisle_rng_below(&rng, 20);
            double y = 0.5 * (double)aisle_rng_below(&rng, 16);
            double w = 0.5 * (1.0 + (double)aisle_rng_below(&rng, 4));
            double h = 0.5 * (1.0 + (double)aisle_rng_below(&rng, 4));
            fix_add_box(&scene, i + 1, x, y, x + w, y + h);
        }
        scene.polygons[13] = scene.polygons[0]; // the very same again
        scene.polygons[13].id = 99;
        load();
        compare_some(&rng, 0.1 * (double)(1U + seed % 4U), 6, &t);
    }
    printf("boxes: %d ways, %d proofs, %d in doubt\n", t.found, t.none, t.doubtful);
    TEST_ASSERT_TRUE(t.found > LEAST(60) && t.doubtful < CASES(10));
}

static void test_a_slit_a_hair_wider_than_the_disc_is_found_and_one_a_hair_narrower_is_a_proof(void) {
    scene.map_id = scene.map_revision = scene.parts = 1;
    fix_set_bounds(&scene, 0.0, 0.0, 10.0, 6.0);
    fix_add_box(&scene, 1, 4.7, -1.0, 5.3, 3.0);
    fix_add_box(&scene, 2, 4.7, 3.6, 5.3, 7.0);
    load();
    TEST_ASSERT_EQUAL(AISLE_OK, run(0.3 - 1e-8, aisle_vec2_of(1, 1), aisle_vec2_of(9, 1)));
    TEST_ASSERT_EQUAL(AISLE_PARTIAL, run(0.3 + 1e-8, aisle_vec2_of(1, 1), aisle_vec2_of(9, 1)));
}

// Every polygon left out in turn: the answer is the oracle's for the scene without it.
static void test_what_is_left_out_is_as_if_it_were_not_there(void) {
    int other = 0;
    for (uint32_t seed = 0; seed < CASES(10U); seed++) {
        aisle_rng rng = aisle_rng_seed(7700U + seed);
        fix_random_scene(&scene, &rng, 40, 1);
        load();
        aisle_vec2 start, goal;
        do {
            start = anywhere(&rng);
            goal = anywhere(&rng);
        } while (run(0.12, start, goal) != AISLE_OK);
        double whole = tangent.bound;
        for (uint32_t i = 0; i < 40U; i++) {
            const aisle_layout_without without = {.id = {scene.polygons[i].id}, .count = 1};
            int8_t kind = scene.polygons[i].kind;
            scene.polygons[i].kind = AISLE_POLYGON_PENALTY; // no obstacle to the oracle
            optimum_world *world = oracle_of(0.12);
            scene.polygons[i].kind = kind;
            optimum_path path =
                optimum_shortest(world, (optimum_point){start.x, start.y}, (optimum_point){goal.x, goal.y}, INFINITY);
            uint32_t spent = 0;
            aisle_tangent_start(&tangent, &fix_layout, 0.12, start, goal);
            aisle_tangent_leave_out(&tangent, &without);
            aisle_status st = aisle_tangent_step(&tangent, UINT32_MAX, &spent);
            bool same = st == AISLE_OK ? fabs(tangent.bound - path.length) < AGREE : isinf(path.length);
            // Stops on what is left out are still occupied.
            TEST_ASSERT_TRUE(same || (st == AISLE_PARTIAL && tangent.expansions == 0U));
            other += st == AISLE_OK && fabs(tangent.bound - whole) > 1e-3 ? 1 : 0;
            optimum_path_free(&path);
            optimum_free(world);
        }
    }
    TEST_ASSERT_TRUE(other >= LEAST(6));
}

static void test_any_slicing_gives_the_same_way_and_bound(void) {
    aisle_rng rng = aisle_rng_seed(7400U);
    fix_random_scene(&scene, &rng, 60, 1);
    load();
    aisle_vec2 whole[POINTS];
    const aisle_vec2 start = {0.3, 0.3};
    const aisle_vec2 goal = {9.6, 7.6};
    TEST_ASSERT_EQUAL(AISLE_OK, run(0.08, start, goal));
    double bound = tangent.bound;
    uint32_t n = aisle_tangent_points(&tangent, 0.0801, whole, POINTS);
    TEST_ASSERT_TRUE(n >= 2U);
    for (uint32_t units = 1; units < 300U; units = units * 2U + 1U) {
        TEST_ASSERT_EQUAL(AISLE_OK, run_in_steps_of(units, 0.08, start, goal));
        TEST_ASSERT_EQUAL_MEMORY(&bound, &tangent.bound, sizeof bound);
        TEST_ASSERT_EQUAL_UINT32(n, aisle_tangent_points(&tangent, 0.0801, points, POINTS));
        TEST_ASSERT_EQUAL_MEMORY(whole, points, n * sizeof whole[0]);
    }
}

static void test_out_of_nodes_keeps_a_bound_that_holds(void) {
    int capacity = 0;
    for (uint32_t seed = 0; seed < CASES(10U); seed++) {
        aisle_rng rng = aisle_rng_seed(7500U + seed);
        carve(1U); // 1024 nodes
        fix_random_scene(&scene, &rng, 200, 1);
        for (uint32_t i = 0; i < scene.count; i++) { // small ones: hundreds of corners in sight
            aisle_vec2 v[4];
            aisle_vec2 c = anywhere(&rng);
            gen_box(c, aisle_vec2_of(c.x + 0.02, c.y + 0.02), v);
            fix_set_polygon(&scene.polygons[i], (int32_t)i + 1, AISLE_POLYGON_OBSTACLE, v, 4);
        }
        aisle_vec2 wall[4];
        gen_box(aisle_vec2_of(4.9, -1.0), aisle_vec2_of(5.1, 7.8), wall);
        fix_set_polygon(&scene.polygons[0], 1, AISLE_POLYGON_OBSTACLE, wall, 4);
        load();
        optimum_world *world = oracle_of(0.002);
        const aisle_vec2 start = {4.5, 0.3}; // to the other side of a wall: everything is worth a look
        const aisle_vec2 goal = {5.5, 0.3};
        optimum_path path =
            optimum_shortest(world, (optimum_point){start.x, start.y}, (optimum_point){goal.x, goal.y}, INFINITY);
        aisle_status st = run(0.002, start, goal);
        capacity += st == AISLE_ERR_CAPACITY ? 1 : 0;
        TEST_ASSERT_TRUE(tangent.bound <= path.length + AGREE);
        TEST_ASSERT_TRUE(st != AISLE_PARTIAL || isinf(path.length));
        optimum_path_free(&path);
        optimum_free(world);
    }
    TEST_ASSERT_TRUE(capacity > 0);
}

static double polyline_length(uint32_t n) {
    double sum = 0.0;
    for (uint32_t i = 0; i + 1U < n; i++) {
        sum += aisle_vec2_distance(points[i], points[i + 1U]);
    }
    return sum;
}

// Length with every corner rounded at radius r: each tip saves 2 r tan(phi / 2) - r phi.
static double rounded_length(uint32_t n, double r) {
    double sum = polyline_length(n);
    for (uint32_t i = 1; i + 1U < n; i++) {
        aisle_vec2 u = aisle_vec2_sub(points[i], points[i - 1U]);
        aisle_vec2 v = aisle_vec2_sub(points[i + 1U], points[i]);
        double phi = fabs(atan2(aisle_vec2_cross(u, v), aisle_vec2_dot(u, v)));
        TEST_ASSERT_TRUE(phi < 1.06); // two thirds of a right angle
        sum -= 2.0 * r * tan(0.5 * phi) - r * phi;
    }
    return sum;
}

static void test_the_polyline_is_the_way_of_the_wider_disc_with_room_for_its_arcs(void) {
    int told = 0;
    for (uint32_t seed = 0; seed < CASES(30U); seed++) {
        aisle_rng rng = aisle_rng_seed(7600U + seed);
        fix_random_scene(&scene, &rng, 40, 1);
        load();
        aisle_vec2 start = anywhere(&rng);
        aisle_vec2 goal = anywhere(&rng);
        if (run(0.1, start, goal) != AISLE_OK) {
            continue;
        }
        uint32_t n = aisle_tangent_points(&tangent, 0.1005, points, POINTS);
        if (n == 0U) {
            continue; // not free at that radius, or no shortest way there
        }
        told++;
        TEST_ASSERT_EQUAL_MEMORY(&start, &points[0], sizeof start);
        TEST_ASSERT_EQUAL_MEMORY(&goal, &points[n - 1U], sizeof goal);
        double length = rounded_length(n, 0.1005);
        TEST_ASSERT_TRUE(length >= tangent.bound - AGREE && length < tangent.bound * 1.02);
        for (uint32_t i = 0; i + 1U < n; i++) { // each leg keeps its distance, seen point by point
            for (int k = 0; k <= 100; k++) {
                aisle_vec2 p = aisle_vec2_lerp(points[i], points[i + 1U], 0.01 * k);
                aisle_convex dot = {&p, 1U, 0.0};
                TEST_ASSERT_TRUE(aisle_layout_gap(&fix_layout, &dot, 1.0, NULL) > 0.1005 - 1e-6);
            }
        }
    }
    TEST_ASSERT_TRUE(told > LEAST(10));
}

static void test_a_polyline_that_does_not_fit_is_not_told(void) {
    aisle_rng rng = aisle_rng_seed(7400U);
    fix_random_scene(&scene, &rng, 60, 1);
    load();
    TEST_ASSERT_EQUAL(AISLE_OK, run(0.08, aisle_vec2_of(0.3, 0.3), aisle_vec2_of(9.6, 7.6)));
    uint32_t n = aisle_tangent_points(&tangent, 0.08, points, POINTS);
    TEST_ASSERT_TRUE(n > 2U);
    points[n - 1U] = aisle_vec2_of(-1.0, -1.0);
    TEST_ASSERT_EQUAL_UINT32(0, aisle_tangent_points(&tangent, 0.08, points, n - 1U));
    TEST_ASSERT_EQUAL_DOUBLE(-1.0, points[n - 1U].x);                                 // nothing is written beyond
    TEST_ASSERT_EQUAL_UINT32(0, aisle_tangent_points(&tangent, 2.0, points, POINTS)); // nor free for a wide disc
}

static void test_occupied_or_outside_ends_have_no_way(void) {
    scene.map_id = scene.map_revision = scene.parts = 1;
    fix_set_bounds(&scene, 0.0, 0.0, 10.0, 6.0);
    fix_add_box(&scene, 1, 4.0, 2.0, 6.0, 4.0);
    load();
    const aisle_vec2 free = {1.0, 1.0};
    TEST_ASSERT_EQUAL(AISLE_PARTIAL, run(0.3, aisle_vec2_of(5, 3), free));
    TEST_ASSERT_EQUAL(AISLE_PARTIAL, run(0.3, free, aisle_vec2_of(3.8, 3)));
    TEST_ASSERT_EQUAL(AISLE_PARTIAL, run(0.3, free, aisle_vec2_of(9.8, 3)));
    TEST_ASSERT_EQUAL(AISLE_PARTIAL, run(0.3, free, aisle_vec2_of(20, 3)));
    TEST_ASSERT_EQUAL(AISLE_OK, run(0.3, free, aisle_vec2_of(9.7, 3))); // touching the wall
    TEST_ASSERT_EQUAL(AISLE_OK, run(0.3, free, free));
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0.0, tangent.bound);
    TEST_ASSERT_EQUAL_UINT32(2, aisle_tangent_points(&tangent, 0.3, points, POINTS));
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_random_polygons_give_the_oracles_length_or_its_proof);
    RUN_TEST(test_random_scans_give_the_oracles_length_or_its_proof);
    RUN_TEST(test_polygons_on_a_scan_count_together);
    RUN_TEST(test_aligned_touching_and_repeated_boxes_give_the_oracles_length);
    RUN_TEST(test_a_slit_a_hair_wider_than_the_disc_is_found_and_one_a_hair_narrower_is_a_proof);
    RUN_TEST(test_what_is_left_out_is_as_if_it_were_not_there);
    RUN_TEST(test_any_slicing_gives_the_same_way_and_bound);
    RUN_TEST(test_out_of_nodes_keeps_a_bound_that_holds);
    RUN_TEST(test_the_polyline_is_the_way_of_the_wider_disc_with_room_for_its_arcs);
    RUN_TEST(test_a_polyline_that_does_not_fit_is_not_told);
    RUN_TEST(test_occupied_or_outside_ends_have_no_way);
    return UNITY_END();
}
