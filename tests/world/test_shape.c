#include "world/shape.h"

#include "base/angle.h"
#include "gen.h"
#include "unity.h"

#include <string.h>

void setUp(void) {}
void tearDown(void) {}

static const aisle_vec2 square[4] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};

// ---- is_valid

static void test_a_square_is_valid_in_one_direction_only(void) {
    const aisle_vec2 clockwise[4] = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
    TEST_ASSERT_TRUE(aisle_convex_is_valid(square, 4, 16));
    TEST_ASSERT_FALSE(aisle_convex_is_valid(clockwise, 4, 16));
}

static void test_too_few_and_too_many_vertices_are_refused(void) {
    aisle_vec2 many[17];
    aisle_rng rng = aisle_rng_seed(3);
    gen_polygon(&rng, aisle_vec2_of(0, 0), 1, 1, 17, many);
    TEST_ASSERT_FALSE(aisle_convex_is_valid(square, 2, 16));
    TEST_ASSERT_FALSE(aisle_convex_is_valid(many, 17, 16));
    TEST_ASSERT_TRUE(aisle_convex_is_valid(many, 17, 17));
}

static void test_not_finite_and_far_coordinates_are_refused_in_every_place(void) {
    const double bad[] = {(double)NAN, (double)INFINITY, -(double)INFINITY, 1.0000001e5, -1.0000001e5};
    for (uint32_t b = 0; b < 5U; b++) {
        for (uint32_t i = 0; i < 8U; i++) {
            aisle_vec2 v[4];
            memcpy(v, square, sizeof v);
            *(i % 2U == 0U ? &v[i / 2U].x : &v[i / 2U].y) = bad[b];
            TEST_ASSERT_FALSE(aisle_convex_is_valid(v, 4, 16));
        }
    }
    const aisle_vec2 far_corner[4] = {{99999, 99999}, {1e5, 99999}, {1e5, 1e5}, {99999, 1e5}};
    TEST_ASSERT_TRUE(aisle_convex_is_valid(far_corner, 4, 16));
}

static void test_area_limit_is_1e_8(void) {
    const aisle_vec2 thin[4] = {{0, 0}, {1, 0}, {1, 0.9e-8}, {0, 0.9e-8}};
    const aisle_vec2 enough[4] = {{0, 0}, {1, 0}, {1, 1.1e-8}, {0, 1.1e-8}};
    TEST_ASSERT_FALSE(aisle_convex_is_valid(thin, 4, 16));
    TEST_ASSERT_TRUE(aisle_convex_is_valid(enough, 4, 16));
}

static void test_collinear_and_repeated_vertices_are_tolerated(void) {
    const aisle_vec2 v[8] = {{0, 0}, {0, 0}, {0.5, 0}, {1, 0}, {1, 1}, {1, 1}, {1, 1}, {0, 1}};
    TEST_ASSERT_TRUE(aisle_convex_is_valid(v, 8, 16));
}

static void test_dents_up_to_the_limit_are_tolerated_and_four_times_it_refused(void) {
    aisle_rng rng = aisle_rng_seed(11);
    for (uint32_t trial = 0; trial < 1000U; trial++) {
        const double theta = gen_in(&rng, -3.0, 3.0);
        const double at = gen_in(&rng, 0.001, 0.999);
        const double length = gen_in(&rng, 0.01, 100.0);
        aisle_vec2 v[5] = {{0, 0}, {at * length, 0.99e-9}, {length, 0}, {length, length}, {0, length}};
        aisle_convex_place(v, 5, (aisle_pose2){3.0, -7.0, theta}, v);
        TEST_ASSERT_TRUE(aisle_convex_is_valid(v, 5, 16));
        aisle_vec2 w[5] = {{0, 0}, {at * length, 4e-9}, {length, 0}, {length, length}, {0, length}};
        aisle_convex_place(w, 5, (aisle_pose2){3.0, -7.0, theta}, w);
        TEST_ASSERT_FALSE(aisle_convex_is_valid(w, 5, 16));
    }
}

static void test_star_spike_double_winding_and_hourglass_are_refused(void) {
    aisle_vec2 star[5];
    aisle_vec2 twice[8];
    for (uint32_t i = 0; i < 5U; i++) { // every turn to the left, wound twice
        star[i] = aisle_vec2_of(cos(4.0 * AISLE_PI * i / 5.0), sin(4.0 * AISLE_PI * i / 5.0));
    }
    for (uint32_t i = 0; i < 8U; i++) {
        twice[i] = square[i % 4U];
    }
    const aisle_vec2 spike[5] = {{0, 0}, {2, 0}, {1, 0}, {1, 1}, {0, 1}};
    const aisle_vec2 hourglass[4] = {{0, 0}, {1, 1}, {1, 0}, {0, 3}};
    TEST_ASSERT_FALSE(aisle_convex_is_valid(star, 5, 16));
    TEST_ASSERT_FALSE(aisle_convex_is_valid(twice, 8, 16));
    TEST_ASSERT_FALSE(aisle_convex_is_valid(spike, 5, 16));
    TEST_ASSERT_FALSE(aisle_convex_is_valid(hourglass, 4, 16));
}

static void test_random_convex_polygons_are_valid_and_a_pushed_in_vertex_is_not(void) {
    aisle_rng rng = aisle_rng_seed(4);
    for (uint32_t trial = 0; trial < 2000U; trial++) {
        const uint32_t n = 4U + aisle_rng_below(&rng, 13);
        const aisle_vec2 centre = aisle_vec2_of(gen_in(&rng, -9e4, 9e4), gen_in(&rng, -9e4, 9e4));
        aisle_vec2 v[16];
        gen_polygon(&rng, centre, gen_in(&rng, 0.5, 50.0), gen_in(&rng, 0.5, 50.0), n, v);
        TEST_ASSERT_TRUE(aisle_convex_is_valid(v, n, 16));
        const uint32_t k = aisle_rng_below(&rng, n); // to the other side of the chord of its neighbours
        const aisle_vec2 chord = aisle_vec2_lerp(v[(k + 1U) % n], v[(k + n - 1U) % n], 0.5);
        v[k] = aisle_vec2_lerp(chord, v[k], -0.2);
        TEST_ASSERT_FALSE(aisle_convex_is_valid(v, n, 16));
    }
}

// ---- boxes, gaps

static void test_aabb_holds_the_shape_and_touches_it_on_all_sides(void) {
    const aisle_vec2 v[3] = {{1, 2}, {4, 3}, {2, 7}};
    const aisle_aabb box = aisle_convex_aabb(&(aisle_convex){v, 3, 0.5});
    TEST_ASSERT_EQUAL_DOUBLE(0.5, box.lo.x);
    TEST_ASSERT_EQUAL_DOUBLE(1.5, box.lo.y);
    TEST_ASSERT_EQUAL_DOUBLE(4.5, box.hi.x);
    TEST_ASSERT_EQUAL_DOUBLE(7.5, box.hi.y);
}

static void test_gaps_of_boxes_known_by_hand(void) {
    const aisle_aabb a = {{0, 0}, {1, 1}};
    TEST_ASSERT_EQUAL_DOUBLE(0.0, aisle_aabb_gap(a, (aisle_aabb){{1, 1}, {2, 2}}));
    TEST_ASSERT_EQUAL_DOUBLE(5.0, aisle_aabb_gap(a, (aisle_aabb){{4, -9}, {9, -4}}));
    TEST_ASSERT_EQUAL_DOUBLE(3.0, aisle_aabb_gap(a, (aisle_aabb){{-5, 0.2}, {-3, 0.4}}));
    TEST_ASSERT_EQUAL_DOUBLE(0.0, aisle_aabb_gap(a, (aisle_aabb){{0.2, 0.2}, {0.4, 0.4}}));
}

static void test_gaps_known_by_hand(void) {
    const aisle_vec2 other[4] = {{4, 5}, {6, 5}, {6, 8}, {4, 8}};
    const aisle_vec2 inner[3] = {{0.4, 0.4}, {0.6, 0.4}, {0.5, 0.6}};
    const aisle_convex a = {square, 4, 0.0};
    TEST_ASSERT_EQUAL_DOUBLE(5.0, aisle_convex_gap(&a, &(aisle_convex){other, 4, 0.0}));
    TEST_ASSERT_EQUAL_DOUBLE(3.5, aisle_convex_gap(&a, &(aisle_convex){other, 4, 1.5}));
    TEST_ASSERT_EQUAL_DOUBLE(0.0, aisle_convex_gap(&a, &(aisle_convex){other, 4, 5.5}));
    TEST_ASSERT_EQUAL_DOUBLE(0.0, aisle_convex_gap(&a, &(aisle_convex){inner, 3, 0.0}));
    TEST_ASSERT_EQUAL_DOUBLE(0.0, aisle_convex_gap(&(aisle_convex){inner, 3, 0.0}, &a));
    TEST_ASSERT_EQUAL_DOUBLE(0.0, aisle_convex_point_gap(&a, aisle_vec2_of(1.0, 0.5)));
    TEST_ASSERT_EQUAL_DOUBLE(2.0, aisle_convex_point_gap(&a, aisle_vec2_of(3.0, 0.5)));
    TEST_ASSERT_EQUAL_DOUBLE(0.0, aisle_segment_gap(square[0], square[2], square[1], square[3]));
    TEST_ASSERT_EQUAL_DOUBLE(1.0, aisle_segment_gap(square[0], square[0], square[1], square[1]));
    TEST_ASSERT_EQUAL_DOUBLE(0.5, aisle_segment_gap(square[0], square[1], (aisle_vec2){1.5, 0}, (aisle_vec2){2, 0}));
}

static aisle_convex random_shape(aisle_rng *rng, aisle_vec2 *v, double spread) {
    static const double radii[] = {0.0, 0.0, 0.05, 0.7};
    const aisle_vec2 centre = aisle_vec2_of(gen_in(rng, -spread, spread), gen_in(rng, -spread, spread));
    const uint32_t n = 1U + aisle_rng_below(rng, 16);
    const double thin = aisle_rng_below(rng, 3) == 0U ? 0.001 : 1.0;
    gen_polygon(rng, centre, gen_in(rng, 0.1, 3.0), thin * gen_in(rng, 0.1, 3.0), n, v);
    return (aisle_convex){v, n, radii[aisle_rng_below(rng, 4)]};
}

static void test_convex_gap_agrees_with_every_edge_against_every_edge_in_long_double(void) {
    aisle_rng rng = aisle_rng_seed(1);
    uint32_t touching = 0;
    for (uint32_t trial = 0; trial < 60000U; trial++) {
        aisle_vec2 va[16];
        aisle_vec2 vb[16];
        const aisle_convex a = random_shape(&rng, va, 2.0);
        const aisle_convex b = random_shape(&rng, vb, 2.0);
        const double gap = aisle_convex_gap(&a, &b);
        TEST_ASSERT_DOUBLE_WITHIN(2e-14, (double)judge_gap(&a, &b), gap);
        TEST_ASSERT_DOUBLE_WITHIN(1e-15, gap, aisle_convex_gap(&b, &a));
        touching += gap <= 0.0 ? 1U : 0U;
        const aisle_convex point = {vb, 1, 0.0};
        TEST_ASSERT_DOUBLE_WITHIN(2e-14, (double)judge_gap(&a, &point), aisle_convex_point_gap(&a, vb[0]));
    }
    TEST_ASSERT_TRUE(touching > 10000U && touching < 50000U); // both sides were tried
}

static void test_gap_keeps_its_digits_far_from_the_origin(void) {
    aisle_rng rng = aisle_rng_seed(2);
    for (uint32_t trial = 0; trial < 5000U; trial++) {
        aisle_vec2 va[16];
        aisle_vec2 vb[16];
        const aisle_vec2 centre = aisle_vec2_of(99000.0, -98000.0);
        gen_polygon(&rng, centre, 500.0, 300.0, 7, va);
        gen_polygon(&rng, aisle_vec2_add(centre, aisle_vec2_of(gen_in(&rng, -900, 900), 500.0)), 5, 90, 5, vb);
        const aisle_convex a = {va, 7, 0.0};
        const aisle_convex b = {vb, 5, 0.0};
        TEST_ASSERT_DOUBLE_WITHIN(1e-12, (double)judge_gap(&a, &b), aisle_convex_gap(&a, &b));
    }
}

static void test_gap_is_what_dense_sampling_of_both_outlines_sees(void) {
    enum { STEPS = 60 };
    aisle_rng rng = aisle_rng_seed(5);
    for (uint32_t trial = 0; trial < 60U; trial++) {
        aisle_vec2 va[5];
        aisle_vec2 vb[5];
        gen_polygon(&rng, aisle_vec2_of(0, 0), 1, 0.6, 5, va);
        gen_polygon(&rng, aisle_vec2_of(gen_in(&rng, 2.5, 4.0), gen_in(&rng, -2.0, 2.0)), 1, 0.3, 5, vb);
        const double gap = aisle_convex_gap(&(aisle_convex){va, 5, 0.0}, &(aisle_convex){vb, 5, 0.0});
        double seen = (double)INFINITY;
        for (uint32_t i = 0; i < 5U * STEPS; i++) {
            const aisle_vec2 p = aisle_vec2_lerp(va[i / STEPS], va[(i / STEPS + 1U) % 5U], (i % STEPS) / (double)STEPS);
            for (uint32_t k = 0; k < 5U * STEPS; k++) {
                const aisle_vec2 q =
                    aisle_vec2_lerp(vb[k / STEPS], vb[(k / STEPS + 1U) % 5U], (k % STEPS) / (double)STEPS);
                seen = fmin(seen, hypot(p.x - q.x, p.y - q.y));
            }
        }
        TEST_ASSERT_TRUE(seen >= gap - 1e-12 && seen <= gap + 0.04); // samples at most 0.034 apart
    }
}

static void test_a_dent_never_hides_an_overlap_and_shifts_a_gap_by_little(void) {
    aisle_rng rng = aisle_rng_seed(6);
    for (uint32_t trial = 0; trial < 3000U; trial++) { // extra vertices pushed in by up to a dent, some a dent apart
        aisle_vec2 v[9];
        for (uint32_t i = 0; i < 8U; i++) {
            const aisle_vec2 on =
                aisle_vec2_lerp(square[i / 2U], square[(i / 2U + 1U) % 4U],
                                (i % 2U) == 0U ? 0.0 : (trial % 2U == 0U ? 1e-9 : gen_in(&rng, 0, 1)));
            v[i] = aisle_vec2_lerp(on, aisle_vec2_of(0.5, 0.5), gen_in(&rng, 0.0, 1e-9));
        }
        const aisle_convex dented = {v, 8, 0.0};
        TEST_ASSERT_TRUE(aisle_convex_is_valid(v, 8, 16));
        const aisle_vec2 inside = aisle_vec2_of(gen_in(&rng, 1e-6, 1.0 - 1e-6), gen_in(&rng, 1e-6, 1.0 - 1e-6));
        TEST_ASSERT_EQUAL_DOUBLE(0.0, aisle_convex_point_gap(&dented, inside));
        const aisle_vec2 outside = aisle_vec2_of(gen_in(&rng, -2.0, 3.0), gen_in(&rng, 1.0 + 1e-7, 3.0));
        const double dx = fmax(0.0, fmax(-outside.x, outside.x - 1.0));
        TEST_ASSERT_DOUBLE_WITHIN(32e-9, hypot(dx, outside.y - 1.0), aisle_convex_point_gap(&dented, outside));
    }
}

static void test_segment_gap_agrees_with_the_judge_points_and_parallels_included(void) {
    aisle_rng rng = aisle_rng_seed(7);
    for (uint32_t trial = 0; trial < 50000U; trial++) {
        aisle_vec2 p[4];
        for (uint32_t i = 0; i < 4U; i++) { // a coarse lattice: many are collinear, parallel, touching or single points
            p[i] = aisle_vec2_of(aisle_rng_below(&rng, 5), aisle_rng_below(&rng, 5));
        }
        const aisle_convex a = {p, 2, 0.0};
        const aisle_convex b = {p + 2, 2, 0.0};
        TEST_ASSERT_DOUBLE_WITHIN(1e-15, (double)judge_gap(&a, &b), aisle_segment_gap(p[0], p[1], p[2], p[3]));
        TEST_ASSERT_DOUBLE_WITHIN(1e-15, (double)judge_gap(&a, &b), aisle_convex_gap(&a, &b));
    }
}

// ---- placing, hull

static void test_place_turns_then_moves_also_in_place(void) {
    aisle_vec2 v[2] = {{1, 0}, {0, 2}};
    aisle_convex_place(v, 2, (aisle_pose2){10, 20, AISLE_PI / 2.0}, v);
    TEST_ASSERT_DOUBLE_WITHIN(1e-14, 10.0, v[0].x);
    TEST_ASSERT_DOUBLE_WITHIN(1e-14, 21.0, v[0].y);
    TEST_ASSERT_DOUBLE_WITHIN(1e-14, 8.0, v[1].x);
    TEST_ASSERT_DOUBLE_WITHIN(1e-14, 20.0, v[1].y);
}

static bool is_among(const aisle_vec2 *points, uint32_t n, aisle_vec2 p) {
    for (uint32_t i = 0; i < n; i++) {
        if (memcmp(&points[i], &p, sizeof p) == 0) {
            return true;
        }
    }
    return false;
}

static void test_hull_is_strictly_convex_made_of_its_points_and_holds_all_of_them(void) {
    aisle_rng rng = aisle_rng_seed(8);
    for (uint32_t trial = 0; trial < 20000U; trial++) {
        const uint32_t n = 1U + aisle_rng_below(&rng, 64);
        const uint32_t side = 1U + aisle_rng_below(&rng, 9); // few places: many repeated and collinear
        aisle_vec2 points[64];
        aisle_vec2 hull[64];
        for (uint32_t i = 0; i < n; i++) {
            points[i] = aisle_vec2_of(aisle_rng_below(&rng, side), aisle_rng_below(&rng, side));
        }
        const uint32_t size = aisle_convex_hull(points, n, hull);
        TEST_ASSERT_TRUE(size >= 1U && size <= n);
        for (uint32_t i = 0; i < size; i++) {
            const judge_point a = judge_of(hull[i]);
            const judge_point b = judge_of(hull[(i + 1U) % size]);
            TEST_ASSERT_TRUE(is_among(points, n, hull[i]));
            TEST_ASSERT_TRUE(size < 3U || judge_turn(a, b, judge_of(hull[(i + 2U) % size])) > 0.0L);
            for (uint32_t k = 0; k < n; k++) {
                TEST_ASSERT_TRUE(judge_turn(a, b, judge_of(points[k])) >= 0.0L);
            }
        }
        for (uint32_t k = 0; k < n && size < 3U; k++) { // a point or a line: all on it
            TEST_ASSERT_TRUE(
                judge_point_to_segment(judge_of(points[k]), judge_of(hull[0]), judge_of(hull[size - 1U])) <= 1e-15L);
        }
    }
}

static void test_hull_may_write_over_its_points(void) {
    aisle_vec2 points[5] = {{1, 1}, {0, 0}, {0.5, 0.5}, {1, 0}, {0, 1}};
    TEST_ASSERT_EQUAL_UINT32(4, aisle_convex_hull(points, 5, points));
    TEST_ASSERT_EQUAL_MEMORY(square, points, sizeof square);
}

// Against clipping the way to the box (Liang and Barsky 1984); ways along edges and through corners among them.
static bool clips(aisle_aabb box, aisle_vec2 a, aisle_vec2 b) {
    const double from[2] = {a.x, a.y}, to[2] = {b.x, b.y};
    const double lo[2] = {box.lo.x, box.lo.y}, hi[2] = {box.hi.x, box.hi.y};
    long double t0 = 0.0L, t1 = 1.0L;
    for (int d = 0; d < 2; d++) {
        const long double step = (long double)to[d] - (long double)from[d];
        if (fabsl(step) <= 0.0L) {
            if (from[d] < lo[d] || from[d] > hi[d]) {
                return false;
            }
            continue;
        }
        const long double u = ((long double)lo[d] - (long double)from[d]) / step;
        const long double v = ((long double)hi[d] - (long double)from[d]) / step;
        t0 = fmaxl(t0, fminl(u, v));
        t1 = fminl(t1, fmaxl(u, v));
    }
    return t0 <= t1;
}

static void test_a_way_meets_a_box_as_clipping_says(void) {
    aisle_rng rng = aisle_rng_seed(31);
    int yes = 0;
    for (int i = 0; i < 20000; i++) {
        double c[8];
        for (int k = 0; k < 8; k++) { // eighths of small numbers, so that much is exactly on an edge
            c[k] = (double)(int)(32.0 * (double)aisle_rng_float(&rng)) / 8.0;
        }
        const aisle_aabb box = {{aisle_min(c[0], c[1]), aisle_min(c[2], c[3])},
                                {aisle_max(c[0], c[1]), aisle_max(c[2], c[3])}};
        const aisle_vec2 a = {c[4], c[5]}, b = {c[6], c[7]};
        TEST_ASSERT_EQUAL_INT(clips(box, a, b), aisle_aabb_meets(box, a, b));
        yes += aisle_aabb_meets(box, a, b) ? 1 : 0;
    }
    TEST_ASSERT_TRUE(yes > 2000 && yes < 18000);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_a_square_is_valid_in_one_direction_only);
    RUN_TEST(test_too_few_and_too_many_vertices_are_refused);
    RUN_TEST(test_not_finite_and_far_coordinates_are_refused_in_every_place);
    RUN_TEST(test_area_limit_is_1e_8);
    RUN_TEST(test_collinear_and_repeated_vertices_are_tolerated);
    RUN_TEST(test_dents_up_to_the_limit_are_tolerated_and_four_times_it_refused);
    RUN_TEST(test_star_spike_double_winding_and_hourglass_are_refused);
    RUN_TEST(test_random_convex_polygons_are_valid_and_a_pushed_in_vertex_is_not);
    RUN_TEST(test_aabb_holds_the_shape_and_touches_it_on_all_sides);
    RUN_TEST(test_gaps_of_boxes_known_by_hand);
    RUN_TEST(test_gaps_known_by_hand);
    RUN_TEST(test_convex_gap_agrees_with_every_edge_against_every_edge_in_long_double);
    RUN_TEST(test_gap_keeps_its_digits_far_from_the_origin);
    RUN_TEST(test_gap_is_what_dense_sampling_of_both_outlines_sees);
    RUN_TEST(test_a_dent_never_hides_an_overlap_and_shifts_a_gap_by_little);
    RUN_TEST(test_segment_gap_agrees_with_the_judge_points_and_parallels_included);
    RUN_TEST(test_place_turns_then_moves_also_in_place);
    RUN_TEST(test_hull_is_strictly_convex_made_of_its_points_and_holds_all_of_them);
    RUN_TEST(test_hull_may_write_over_its_points);
    RUN_TEST(test_a_way_meets_a_box_as_clipping_says);
    return UNITY_END();
}
