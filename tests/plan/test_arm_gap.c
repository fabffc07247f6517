#include "plan/arm_gap.h" // first: proves that the header stands alone

#include "base/rng.h"
#include "unity.h"

#include <math.h>

enum { SEEDS = 20000 };

void setUp(void) {}
void tearDown(void) {}

static double between(aisle_rng *rng, double lo, double hi) {
    return lo + (hi - lo) * (double)aisle_rng_float(rng);
}

// ---- the judge: every edge against the axis, in long double

static long double point_segment(aisle_vec2 p, aisle_vec2 a, aisle_vec2 b) {
    const long double dx = (long double)b.x - (long double)a.x, dy = (long double)b.y - (long double)a.y;
    const long double px = (long double)p.x - (long double)a.x, py = (long double)p.y - (long double)a.y;
    const long double sq = dx * dx + dy * dy;
    const long double t = sq > 0.0L ? fminl(1.0L, fmaxl(0.0L, (px * dx + py * dy) / sq)) : 0.0L;
    return hypotl(px - t * dx, py - t * dy);
}

static long double side(aisle_vec2 a, aisle_vec2 b, aisle_vec2 p) {
    return ((long double)b.x - (long double)a.x) * ((long double)p.y - (long double)a.y) -
           ((long double)b.y - (long double)a.y) * ((long double)p.x - (long double)a.x);
}

static bool is_inside(const aisle_vec2 *v, uint32_t n, aisle_vec2 p) {
    for (uint32_t i = 0; i < n; i++) {
        if (side(v[i], v[(i + 1U) % n], p) < 0.0L) {
            return false;
        }
    }
    return n > 2U;
}

static double judged(const aisle_vec2 *v, uint32_t n, aisle_vec2 a, aisle_vec2 b) {
    long double least = 1e9L;
    if (is_inside(v, n, a) || is_inside(v, n, b)) {
        return 0.0;
    }
    for (uint32_t i = 0; i < n; i++) {
        const aisle_vec2 c = v[i], d = v[(i + 1U) % n];
        if (side(a, b, c) * side(a, b, d) < 0.0L && side(c, d, a) * side(c, d, b) < 0.0L) {
            return 0.0;
        }
        least = fminl(least, fminl(point_segment(a, c, d), point_segment(b, c, d)));
        least = fminl(least, fminl(point_segment(c, a, b), point_segment(d, a, b)));
    }
    return (double)least;
}

// On an ellipse in the order of its angle, turned and moved.
static uint32_t draw_hull(aisle_rng *rng, aisle_vec2 *v) {
    const uint32_t n = aisle_rng_below(rng, 14U) + 3U;
    const double w = between(rng, 0.05, 1.0), h = between(rng, 0.05, 1.0), turn = between(rng, 0.0, 6.3);
    double angle = between(rng, 0.0, 0.3);
    for (uint32_t i = 0; i < n; i++) {
        const double x = w * cos(angle), y = h * sin(angle);
        v[i] = aisle_vec2_of(cos(turn) * x - sin(turn) * y, sin(turn) * x + cos(turn) * y);
        angle += 6.28 / (double)n * between(rng, 0.6, 1.0);
    }
    return n;
}

static void test_the_gap_is_the_judges_up_to_the_cap(void) {
    int meet = 0, capped = 0;
    for (uint64_t seed = 0; seed < SEEDS; seed++) {
        aisle_rng rng = aisle_rng_seed(seed);
        aisle_vec2 v[16];
        const aisle_convex hull = {v, draw_hull(&rng, v), 0.7}; // a radius that is not looked at
        const aisle_vec2 a = {between(&rng, -1.5, 1.5), between(&rng, -1.5, 1.5)};
        const double length = seed % 50U == 0U ? 0.0 : between(&rng, 0.0, 1.0), angle = between(&rng, 0.0, 6.3);
        const aisle_vec2 b = {a.x + length * cos(angle), a.y + length * sin(angle)};
        const double cap = between(&rng, 0.001, 1.0), want = judged(v, hull.n, a, b);
        TEST_ASSERT_TRUE(aisle_arm_gap_is_plain(&hull));
        const double gap = aisle_arm_axis_gap(&hull, true, a, b, cap);
        TEST_ASSERT_DOUBLE_WITHIN(AISLE_ARM_GAP_ERROR, fmin(cap, want), gap);
        TEST_ASSERT_DOUBLE_WITHIN(AISLE_ARM_GAP_ERROR, gap, aisle_arm_axis_gap(&hull, false, a, b, cap));
        meet += want > 0.0 ? 0 : 1;
        capped += want > cap ? 1 : 0;
    }
    TEST_ASSERT_TRUE(meet > SEEDS / 10 && capped > SEEDS / 10);
}
static void test_points_and_lines_are_hulls_too(void) {
    const aisle_vec2 v[2] = {{1.0, 0.0}, {1.0, 1.0}}, a = {0.0, 0.5}, b = {0.5, 0.5};
    const aisle_convex disc = {v, 1U, 0.3}, capsule = {v, 2U, 0.3};
    TEST_ASSERT_FALSE(aisle_arm_gap_is_plain(&disc));
    TEST_ASSERT_FALSE(aisle_arm_gap_is_plain(&capsule));
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, sqrt(0.5), aisle_arm_axis_gap(&disc, false, a, b, 9.0));
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0.5, aisle_arm_axis_gap(&capsule, false, a, b, 9.0));
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0.2, aisle_arm_axis_gap(&capsule, false, a, b, 0.2));
}
static void test_short_edges_and_dents_are_not_plain(void) {
    const aisle_vec2 twice[5] = {{0.0, 0.0}, {1.0, 0.0}, {1.0, 0.0}, {1.0, 1.0}, {0.0, 1.0}};
    const aisle_vec2 dented[5] = {{0.0, 0.0}, {0.5, 1e-8}, {1.0, 0.0}, {1.0, 1.0}, {0.0, 1.0}};
    const aisle_vec2 straight[5] = {{0.0, 0.0}, {0.5, 0.0}, {1.0, 0.0}, {1.0, 1.0}, {0.0, 1.0}};
    TEST_ASSERT_FALSE(aisle_arm_gap_is_plain(&(aisle_convex){twice, 5U, 0.0}));
    TEST_ASSERT_FALSE(aisle_arm_gap_is_plain(&(aisle_convex){dented, 5U, 0.0}));
    TEST_ASSERT_TRUE(aisle_arm_gap_is_plain(&(aisle_convex){straight, 5U, 0.0}));
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_the_gap_is_the_judges_up_to_the_cap);
    RUN_TEST(test_points_and_lines_are_hulls_too);
    RUN_TEST(test_short_edges_and_dents_are_not_plain);
    return UNITY_END();
}
