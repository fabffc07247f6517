#include "world/collide.h"

#include "cases.h"
#include "gen.h"
#include "unity.h"

void setUp(void) {}
void tearDown(void) {}

static aisle_collide_count count;

typedef enum kind { RANDOM, BOXES, THIN } kind;

static void gen_kind(aisle_rng *rng, kind k, uint32_t n, aisle_vec2 *out) {
    if (k == BOXES) {
        gen_box(aisle_vec2_of(0, 0), aisle_vec2_of(gen_in(rng, 0.1, 3), gen_in(rng, 0.1, 3)), out);
    } else {
        gen_polygon(rng, aisle_vec2_of(0, 0), gen_in(rng, 0.1, 3), k == THIN ? 0.001 : gen_in(rng, 0.1, 2), n, out);
    }
}

// Moves b so that the rounded shapes are `off` apart (negative: overlap) where b's foremost vertex meets an edge of a.
static void bring_near(aisle_rng *rng, const aisle_convex *a, aisle_vec2 *b, uint32_t nb, double rb, double off) {
    const uint32_t i = aisle_rng_below(rng, a->n);
    const aisle_vec2 from = a->v[i];
    const aisle_vec2 to = a->v[(i + 1U) % a->n];
    const aisle_vec2 edge = aisle_vec2_sub(to, from);
    const aisle_vec2 outwards = aisle_vec2_scale(aisle_vec2_of(edge.y, -edge.x), 1.0 / aisle_vec2_length(edge));
    uint32_t foremost = 0;
    for (uint32_t k = 1; k < nb; k++) {
        foremost = aisle_vec2_dot(b[k], outwards) < aisle_vec2_dot(b[foremost], outwards) ? k : foremost;
    }
    const aisle_vec2 at = aisle_vec2_lerp(from, to, gen_in(rng, 0.0, 1.0));
    const aisle_vec2 target = aisle_vec2_add(at, aisle_vec2_scale(outwards, off + a->radius + rb));
    const aisle_vec2 move = aisle_vec2_sub(target, b[foremost]);
    for (uint32_t k = 0; k < nb; k++) {
        b[k] = aisle_vec2_add(b[k], move);
    }
}

// Near contact, offsets from 1e-12 to 0.1 m on both sides: what the judge sees touching must be found, and what is
// further apart than the spare must not.
static void check_pairs(uint64_t seed, kind k, bool is_rounded, uint32_t named) {
    const uint32_t pairs = CASES(named);
    aisle_rng rng = aisle_rng_seed(seed);
    uint32_t touching = 0;
    uint32_t apart = 0;
    for (uint32_t i = 0; i < pairs; i++) {
        aisle_vec2 va[10];
        aisle_vec2 vb[10];
        const uint32_t na = k == BOXES ? 4U : 3U + aisle_rng_below(&rng, 8);
        uint32_t nb = k == BOXES ? 4U : 3U + aisle_rng_below(&rng, 8);
        gen_kind(&rng, k, na, va);
        gen_kind(&rng, k == THIN && i % 2U == 0U ? RANDOM : k, nb, vb);
        nb = is_rounded && i % 5U == 0U ? 1U + i % 2U : nb; // discs and capsules
        const double far = i % 3U == 0U ? gen_in(&rng, -9e4, 9e4) : gen_in(&rng, -5.0, 5.0);
        for (uint32_t n = 0; n < na; n++) {
            va[n] = aisle_vec2_add(va[n], aisle_vec2_of(far, -far));
        }
        const aisle_convex a = {va, na, is_rounded && i % 2U == 0U ? gen_in(&rng, 0.0, 0.6) : 0.0};
        const double rb = is_rounded ? gen_in(&rng, 0.0, 0.3) : 0.0;
        const double off = pow(10.0, gen_in(&rng, -12.0, -1.0)) * (i % 2U == 0U ? 1.0 : -1.0);
        bring_near(&rng, &a, vb, nb, rb, off);
        const aisle_convex b = {vb, nb, rb};
        const long double gap = judge_gap(&a, &b);
        const aisle_collide_body first = {va, NULL, na, a.radius};
        const aisle_collide_body second = {vb, NULL, nb, rb};
        const bool hit = aisle_collide(&first, &second, &count);
        TEST_ASSERT_TRUE(gap <= 0.0L ? hit : (!hit || gap <= (long double)AISLE_COLLIDE_SPARE));
        touching += gap <= 0.0L ? 1U : 0U;
        apart += gap > (long double)AISLE_COLLIDE_SPARE ? 1U : 0U;
    }
    TEST_ASSERT_TRUE(touching > pairs / 4U && apart > pairs / 5U);
}

static void test_no_touching_pair_of_polygons_is_missed_and_none_apart_is_alarmed(void) {
    count = (aisle_collide_count){0};
    check_pairs(71, RANDOM, false, 50000);
    check_pairs(72, BOXES, false, 30000);
    check_pairs(73, THIN, false, 50000);
    TEST_ASSERT_EQUAL_INT64(CASES(130000), count.calls);
    TEST_ASSERT_EQUAL_INT64(0, count.unfit);
    TEST_ASSERT_TRUE(count.support_max <= 60U);
}

static void test_no_touching_pair_of_rounded_shapes_is_missed_and_none_apart_is_alarmed(void) {
    count = (aisle_collide_count){0};
    check_pairs(74, RANDOM, true, 30000);
    check_pairs(75, BOXES, true, 20000);
    check_pairs(76, THIN, true, 30000);
    TEST_ASSERT_EQUAL_INT64(0, count.unfit);
    TEST_ASSERT_TRUE(count.support_max <= 120U);
}

static void test_shapes_inside_each_other_identical_or_single_points_touch(void) {
    const aisle_vec2 big[4] = {{0, 0}, {9, 0}, {9, 9}, {0, 9}};
    const aisle_vec2 small[3] = {{7, 8}, {8, 8}, {7.5, 8.5}};
    const aisle_vec2 point[1] = {{3, 3}};
    const aisle_collide_body a = {big, NULL, 4, 0.0};
    const aisle_collide_body b = {small, NULL, 3, 0.0};
    const aisle_collide_body p = {point, NULL, 1, 0.0};
    TEST_ASSERT_TRUE(aisle_collide(&a, &b, NULL));
    TEST_ASSERT_TRUE(aisle_collide(&b, &a, NULL));
    TEST_ASSERT_TRUE(aisle_collide(&a, &a, NULL));
    TEST_ASSERT_TRUE(aisle_collide(&a, &p, NULL));
    TEST_ASSERT_TRUE(aisle_collide(&p, &p, NULL));
    TEST_ASSERT_FALSE(aisle_collide(&b, &p, NULL));
}

static void test_touching_corners_and_edges_touch(void) {
    const aisle_vec2 a[4] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    const aisle_vec2 corner[4] = {{1, 1}, {2, 1}, {2, 2}, {1, 2}};
    const aisle_vec2 edge[4] = {{1, 0}, {2, 0}, {2, 1}, {1, 1}};
    const aisle_vec2 disc[1] = {{3, 0.5}};
    const aisle_collide_body first = {a, NULL, 4, 0.0};
    TEST_ASSERT_TRUE(aisle_collide(&first, &(aisle_collide_body){corner, NULL, 4, 0.0}, NULL));
    TEST_ASSERT_TRUE(aisle_collide(&first, &(aisle_collide_body){edge, NULL, 4, 0.0}, NULL));
    TEST_ASSERT_TRUE(aisle_collide(&first, &(aisle_collide_body){disc, NULL, 1, 2.0}, NULL));
    TEST_ASSERT_FALSE(aisle_collide(&first, &(aisle_collide_body){disc, NULL, 1, 2.0 - 2e-9}, NULL));
}

// The sweep of a straight move is judged by 400 placements between its ends and by the hull's outline.
static void test_hull_of_two_placements_is_what_the_body_sweeps(void) {
    enum { SAMPLES = 400 };
    aisle_rng rng = aisle_rng_seed(77);
    uint32_t hits = 0;
    for (uint32_t trial = 0; trial < CASES(1500U); trial++) {
        aisle_vec2 start[6];
        aisle_vec2 end[6];
        aisle_vec2 other[5];
        const double radius = trial % 2U == 0U ? 0.0 : 0.1;
        const aisle_vec2 move = {gen_in(&rng, -3, 3), gen_in(&rng, -3, 3)};
        gen_polygon(&rng, aisle_vec2_of(0, 0), 0.6, 0.4, 6, start);
        gen_polygon(&rng, aisle_vec2_of(gen_in(&rng, -3, 3), gen_in(&rng, -3, 3)), 0.5, 0.05, 5, other);
        for (uint32_t i = 0; i < 6U; i++) {
            end[i] = aisle_vec2_add(start[i], move);
        }
        const aisle_convex obstacle = {other, 5, 0.0};
        long double nearest = (long double)INFINITY;
        for (uint32_t k = 0; k <= SAMPLES; k++) {
            aisle_vec2 v[6];
            for (uint32_t i = 0; i < 6U; i++) {
                v[i] = aisle_vec2_lerp(start[i], end[i], k / (double)SAMPLES);
            }
            nearest = fminl(nearest, judge_gap(&(aisle_convex){v, 6, radius}, &obstacle));
        }
        const bool hit = aisle_collide(&(aisle_collide_body){start, end, 6, radius},
                                       &(aisle_collide_body){other, NULL, 5, 0.0}, NULL);
        TEST_ASSERT_TRUE(hit || nearest > 0.0L);
        TEST_ASSERT_TRUE(!hit || nearest <= 0.006L); // half a sample's step
        hits += hit ? 1U : 0U;
    }
    TEST_ASSERT_TRUE(hits > LEAST(150U) && hits < LEAST(1200U));
}

static void test_what_is_not_finite_or_too_far_or_too_many_touches_and_is_counted(void) {
    const double bad[] = {(double)NAN, (double)INFINITY, -(double)INFINITY, 1.1e5, -1e300};
    count = (aisle_collide_count){0};
    const aisle_vec2 far_off[1] = {{500, 500}};
    const aisle_collide_body other = {far_off, NULL, 1, 0.0};
    for (uint32_t i = 0; i < 20U; i++) {
        aisle_vec2 a[2] = {{0, 0}, {1, 0}};
        aisle_vec2 b[2] = {{0, 1}, {1, 1}};
        aisle_vec2 *set = i % 2U == 0U ? a : b;
        *(i / 2U % 2U == 0U ? &set[1].x : &set[0].y) = bad[i / 4U];
        const aisle_collide_body body = {a, b, 2, 0.0};
        TEST_ASSERT_TRUE(aisle_collide(&body, &other, &count));
        TEST_ASSERT_TRUE(aisle_collide(&other, &body, &count));
    }
    TEST_ASSERT_EQUAL_INT64(40, count.unfit);
    const double radii[] = {(double)NAN, -1.0, (double)INFINITY, 2e5};
    for (uint32_t i = 0; i < 4U; i++) {
        const aisle_vec2 a[1] = {{0, 0}};
        TEST_ASSERT_TRUE(aisle_collide(&(aisle_collide_body){a, NULL, 1, radii[i]}, &other, &count));
    }
    const aisle_vec2 many[33] = {{0, 0}};
    TEST_ASSERT_TRUE(aisle_collide(&(aisle_collide_body){many, NULL, 33, 0.0}, &other, &count));
    TEST_ASSERT_TRUE(aisle_collide(&(aisle_collide_body){many, NULL, 0, 0.0}, &other, &count));
    TEST_ASSERT_EQUAL_INT64(46, count.unfit);
    TEST_ASSERT_EQUAL_INT64(46, count.calls);
    TEST_ASSERT_FALSE(aisle_collide(&(aisle_collide_body){many, NULL, 32, 0.0}, &other, &count));
    TEST_ASSERT_EQUAL_INT64(46, count.unfit);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_no_touching_pair_of_polygons_is_missed_and_none_apart_is_alarmed);
    RUN_TEST(test_no_touching_pair_of_rounded_shapes_is_missed_and_none_apart_is_alarmed);
    RUN_TEST(test_shapes_inside_each_other_identical_or_single_points_touch);
    RUN_TEST(test_touching_corners_and_edges_touch);
    RUN_TEST(test_hull_of_two_placements_is_what_the_body_sweeps);
    RUN_TEST(test_what_is_not_finite_or_too_far_or_too_many_touches_and_is_counted);
    return UNITY_END();
}
