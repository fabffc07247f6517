#include "world/spline.h"

#include "gen.h"
#include "unity.h"

#include <string.h>

void setUp(void) {}
void tearDown(void) {}

static aisle_spline spline;
static aisle_vec2 points[AISLE_SPLINE_POINTS_MAX + 1U];

static void fit(aisle_spline_kind kind, uint32_t n) {
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_spline_fit(&spline, kind, points, n));
}

// A way with bends as a planner's: steps of uneven length, direction turned by up to `turn` at each.
static void gen_way(aisle_rng *rng, uint32_t n, double turn) {
    double heading = gen_in(rng, -3.0, 3.0);
    points[0] = aisle_vec2_of(gen_in(rng, -50, 50), gen_in(rng, -50, 50));
    for (uint32_t i = 1; i < n; i++) {
        const double step = gen_in(rng, 0.5, 2.0);
        points[i] = aisle_vec2_add(points[i - 1U], aisle_vec2_of(step * cos(heading), step * sin(heading)));
        heading += gen_in(rng, -turn, turn);
    }
}

// ---- fit

static void test_too_few_too_many_equal_and_not_finite_points_are_refused(void) {
    for (uint32_t i = 0; i <= AISLE_SPLINE_POINTS_MAX; i++) {
        points[i] = aisle_vec2_of(i, 0);
    }
    TEST_ASSERT_EQUAL(AISLE_ERR_CAPACITY,
                      aisle_spline_fit(&spline, AISLE_SPLINE_CUBIC, points, AISLE_SPLINE_POINTS_MAX + 1U));
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_spline_fit(&spline, AISLE_SPLINE_CUBIC, points, AISLE_SPLINE_POINTS_MAX));
    TEST_ASSERT_EQUAL(AISLE_ERR_ARG, aisle_spline_fit(&spline, AISLE_SPLINE_CUBIC, points, 1));
    points[3].y = (double)NAN;
    TEST_ASSERT_EQUAL(AISLE_ERR_ARG, aisle_spline_fit(&spline, AISLE_SPLINE_LINEAR, points, 5));
    points[3].y = (double)INFINITY;
    TEST_ASSERT_EQUAL(AISLE_ERR_ARG, aisle_spline_fit(&spline, AISLE_SPLINE_LINEAR, points, 5));
    const aisle_vec2 same[3] = {{1, 1}, {1, 1}, {1, 1 + 5e-7}};
    TEST_ASSERT_EQUAL(AISLE_ERR_ARG, aisle_spline_fit(&spline, AISLE_SPLINE_LINEAR, same, 3));
}

static void test_near_points_merge_and_the_last_one_is_kept_exactly(void) {
    const aisle_vec2 near[6] = {{0, 0}, {1, 0}, {1, 5e-7}, {2, 0}, {3, 0}, {3, 9e-7}};
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_spline_fit(&spline, AISLE_SPLINE_CUBIC, near, 6));
    TEST_ASSERT_EQUAL_UINT32(4, spline.n);
    TEST_ASSERT_EQUAL_MEMORY(&near[1], &spline.p[1], sizeof near[1]);
    TEST_ASSERT_EQUAL_MEMORY(&near[5], &spline.p[3], sizeof near[5]);
    const aisle_vec2 back[4] = {
        {0, 0}, {1, 0}, {1.0000015, 0}, {1.0000006, 0}}; // the last one moves onto the one before
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_spline_fit(&spline, AISLE_SPLINE_CUBIC, back, 4));
    TEST_ASSERT_EQUAL_UINT32(2, spline.n);
    TEST_ASSERT_EQUAL_MEMORY(&back[3], &spline.p[1], sizeof back[3]);
}

static void test_parameter_is_the_cumulated_chord_length(void) {
    aisle_rng rng = aisle_rng_seed(81);
    gen_way(&rng, 40, 1.0);
    fit(AISLE_SPLINE_CUBIC, 40);
    long double sum = 0.0L;
    for (uint32_t i = 0; i < 40U; i++) {
        sum += i == 0U ? 0.0L
                       : hypotl((long double)points[i].x - (long double)points[i - 1U].x,
                                (long double)points[i].y - (long double)points[i - 1U].y);
        TEST_ASSERT_DOUBLE_WITHIN(1e-12, (double)sum, spline.u[i]);
    }
}

// ---- interpolation

static void test_spline_goes_through_its_points_and_is_clamped_to_its_ends(void) {
    aisle_rng rng = aisle_rng_seed(82);
    for (uint32_t n = 2; n <= AISLE_SPLINE_POINTS_MAX; n++) {
        gen_way(&rng, n, 2.0);
        fit(n % 2U == 0U ? AISLE_SPLINE_CUBIC : AISLE_SPLINE_LINEAR, n);
        for (uint32_t i = 0; i < n; i++) {
            const aisle_vec2 p = aisle_spline_at(&spline, spline.u[i]).p;
            TEST_ASSERT_DOUBLE_WITHIN(1e-12, points[i].x, p.x);
            TEST_ASSERT_DOUBLE_WITHIN(1e-12, points[i].y, p.y);
        }
        const aisle_vec2 before = aisle_spline_at(&spline, -5.0).p;
        const aisle_vec2 after = aisle_spline_at(&spline, 1e9).p;
        TEST_ASSERT_EQUAL_MEMORY(&points[0], &before, sizeof before);
        TEST_ASSERT_EQUAL_MEMORY(&points[n - 1U], &after, sizeof after);
    }
}

static double cubic(const double c[4], double u) {
    return c[0] + u * (c[1] + u * (c[2] + u * c[3]));
}

// Cubics of the chord length, judged on nearly straight ways, where it is the abscissa up to the square of the
// ordinates.
static void test_cubics_are_reproduced_for_four_points_and_more(void) {
    aisle_rng rng = aisle_rng_seed(83);
    for (uint32_t trial = 0; trial < 300U; trial++) {
        const double scale = 1e-7; // ordinates: chord and abscissa differ by 1e-14
        const double c[4] = {gen_in(&rng, -1, 1), gen_in(&rng, -1, 1), gen_in(&rng, -1, 1), gen_in(&rng, -1, 1)};
        const uint32_t n = 4U + aisle_rng_below(&rng, 12);
        double x = 0.0;
        for (uint32_t i = 0; i < n; i++) {
            points[i] = aisle_vec2_of(x, scale * cubic(c, x));
            x += gen_in(&rng, 0.02, 0.3);
        }
        fit(AISLE_SPLINE_CUBIC, n);
        for (uint32_t k = 0; k <= 200U; k++) {
            const aisle_spline_sample s = aisle_spline_at(&spline, spline.u[n - 1U] * k / 200.0);
            TEST_ASSERT_DOUBLE_WITHIN(1e-10, cubic(c, s.p.x), s.p.y / scale);
            TEST_ASSERT_DOUBLE_WITHIN(1e-8, c[1] + s.p.x * (2.0 * c[2] + 3.0 * s.p.x * c[3]), s.d1.y / scale);
            TEST_ASSERT_DOUBLE_WITHIN(1e-5, 2.0 * c[2] + 6.0 * s.p.x * c[3], s.d2.y / scale);
        }
    }
}

static void test_three_points_give_the_parabola_and_two_the_segment(void) {
    points[0] = aisle_vec2_of(0, 0);
    points[1] = aisle_vec2_of(3, 4);
    points[2] = aisle_vec2_of(3, 14);
    fit(AISLE_SPLINE_CUBIC, 3);
    for (uint32_t k = 0; k <= 30U; k++) { // Lagrange through (0, p0) (5, p1) (15, p2)
        const double u = k * 0.5;
        const double l1 = u * (u - 15.0) / (5.0 * -10.0);
        const double l2 = u * (u - 5.0) / (15.0 * 10.0);
        const aisle_vec2 p = aisle_spline_at(&spline, u).p;
        TEST_ASSERT_DOUBLE_WITHIN(1e-13, 3.0 * l1 + 3.0 * l2, p.x);
        TEST_ASSERT_DOUBLE_WITHIN(1e-13, 4.0 * l1 + 14.0 * l2, p.y);
    }
    fit(AISLE_SPLINE_CUBIC, 2);
    const aisle_spline_sample s = aisle_spline_at(&spline, 2.5);
    TEST_ASSERT_DOUBLE_WITHIN(1e-15, 1.5, s.p.x);
    TEST_ASSERT_DOUBLE_WITHIN(1e-15, 0.6, s.d1.x);
    TEST_ASSERT_DOUBLE_WITHIN(1e-15, 0.0, s.d2.y);
}

// Value, slope and second derivative do not jump at the knots, and the third one not at the two next to the ends: what
// "not a knot" means, and with the interpolation it fixes the spline.
static void test_cubic_is_c2_everywhere_and_c3_next_to_the_ends(void) {
    aisle_rng rng = aisle_rng_seed(84);
    for (uint32_t trial = 0; trial < 300U; trial++) {
        const uint32_t n = 4U + aisle_rng_below(&rng, 60);
        gen_way(&rng, n, 2.5);
        fit(AISLE_SPLINE_CUBIC, n);
        for (uint32_t i = 1; i + 1U < n; i++) {
            const double step = 1e-9;
            const aisle_spline_sample a = aisle_spline_at(&spline, spline.u[i] - step);
            const aisle_spline_sample b = aisle_spline_at(&spline, spline.u[i] + step);
            TEST_ASSERT_DOUBLE_WITHIN(1e-7, 0.0, aisle_vec2_distance(a.p, b.p));
            TEST_ASSERT_DOUBLE_WITHIN(1e-6, 0.0, aisle_vec2_distance(a.d1, b.d1));
            TEST_ASSERT_DOUBLE_WITHIN(1e-5, 0.0, aisle_vec2_distance(a.d2, b.d2));
        }
        const uint32_t next_to_end[2] = {1, n - 2U};
        for (uint32_t k = 0; k < 2U; k++) {
            const uint32_t i = next_to_end[k];
            const double before = (spline.m[i].x - spline.m[i - 1U].x) / (spline.u[i] - spline.u[i - 1U]);
            const double after = (spline.m[i + 1U].x - spline.m[i].x) / (spline.u[i + 1U] - spline.u[i]);
            TEST_ASSERT_DOUBLE_WITHIN(1e-9, before, after);
        }
    }
}

static void test_derivatives_are_those_of_the_position(void) {
    aisle_rng rng = aisle_rng_seed(85);
    gen_way(&rng, 12, 1.5);
    fit(AISLE_SPLINE_CUBIC, 12);
    for (uint32_t k = 1; k < 500U; k++) {
        const double u = spline.u[11] * k / 500.0;
        const double h = 1e-5;
        const aisle_spline_sample s = aisle_spline_at(&spline, u);
        const aisle_spline_sample a = aisle_spline_at(&spline, u - h);
        const aisle_spline_sample b = aisle_spline_at(&spline, u + h);
        TEST_ASSERT_DOUBLE_WITHIN(1e-7, (b.p.x - a.p.x) / (2.0 * h), s.d1.x);
        TEST_ASSERT_DOUBLE_WITHIN(1e-7, (b.p.y - a.p.y) / (2.0 * h), s.d1.y);
        TEST_ASSERT_DOUBLE_WITHIN(1e-4, (b.d1.x - a.d1.x) / (2.0 * h), s.d2.x);
        TEST_ASSERT_DOUBLE_WITHIN(1e-4, (b.d1.y - a.d1.y) / (2.0 * h), s.d2.y);
    }
}

static void test_linear_is_the_segments_with_unit_speed(void) {
    aisle_rng rng = aisle_rng_seed(86);
    gen_way(&rng, 30, 2.0);
    fit(AISLE_SPLINE_LINEAR, 30);
    for (uint32_t i = 0; i + 1U < 30U; i++) {
        const double share = gen_in(&rng, 0.01, 0.99);
        const aisle_spline_sample s = aisle_spline_at(&spline, spline.u[i] + share * (spline.u[i + 1U] - spline.u[i]));
        const aisle_vec2 want = aisle_vec2_lerp(points[i], points[i + 1U], share);
        TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0.0, aisle_vec2_distance(want, s.p));
        TEST_ASSERT_DOUBLE_WITHIN(1e-12, 1.0, aisle_vec2_length(s.d1));
        TEST_ASSERT_DOUBLE_WITHIN(1e-15, 0.0, aisle_vec2_length(s.d2));
        TEST_ASSERT_DOUBLE_WITHIN(1e-15, 0.0, aisle_spline_curvature(&s));
    }
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, spline.u[29], aisle_spline_length(&spline));
}

static void test_curvature_of_points_on_a_circle_is_its_inverse_radius_signed(void) {
    for (int32_t side = -1; side <= 1; side += 2) {
        for (uint32_t i = 0; i < 60U; i++) {
            const double angle = 0.05 * i;
            points[i] = aisle_vec2_of(4.0 * cos(angle), side * 4.0 * sin(angle));
        }
        fit(AISLE_SPLINE_CUBIC, 60);
        for (uint32_t k = 0; k <= 300U; k++) {
            const aisle_spline_sample s = aisle_spline_at(&spline, spline.u[59] * k / 300.0);
            TEST_ASSERT_DOUBLE_WITHIN(1e-3, side * 0.25, aisle_spline_curvature(&s));
        }
    }
    const aisle_spline_sample still = {{0, 0}, {1e-10, 0}, {0, 5}};
    TEST_ASSERT_EQUAL_DOUBLE(0.0, aisle_spline_curvature(&still));
}

// ---- length

static long double judge_length_between(double from, double to, uint32_t steps) { // midpoint rule, long double
    long double sum = 0.0L;
    for (uint32_t i = 0; i < steps; i++) {
        const aisle_spline_sample s = aisle_spline_at(&spline, from + (to - from) * (i + 0.5) / steps);
        sum += hypotl((long double)s.d1.x, (long double)s.d1.y);
    }
    return sum * ((long double)to - (long double)from) / steps;
}

static double slowest(void) { // least speed over the mean one, which is about 1
    double least = (double)INFINITY;
    for (uint32_t k = 0; k <= 2000U; k++) {
        const aisle_spline_sample s = aisle_spline_at(&spline, spline.u[spline.n - 1U] * k / 2000.0);
        least = fmin(least, hypot(s.d1.x, s.d1.y));
    }
    return least * spline.u[spline.n - 1U] / aisle_spline_length(&spline);
}

static void test_length_is_right_to_1e_6_where_the_speed_does_not_vanish_and_to_1e_3_always(void) {
    aisle_rng rng = aisle_rng_seed(87);
    uint32_t smooth = 0;
    for (uint32_t trial = 0; trial < 60U; trial++) {
        const uint32_t n = 3U + aisle_rng_below(&rng, 8);
        gen_way(&rng, n, trial % 2U == 0U ? 1.2 : 3.1);
        fit(AISLE_SPLINE_CUBIC, n);
        long double want = 0.0L;
        for (uint32_t i = 0; i + 1U < n; i++) {
            want += judge_length_between(spline.u[i], spline.u[i + 1U], 4000);
        }
        const double error = fabs(aisle_spline_length(&spline) / (double)want - 1.0);
        const bool is_smooth = slowest() > 0.34;
        smooth += is_smooth ? 1U : 0U;
        TEST_ASSERT_TRUE(error < (is_smooth ? 1e-6 : 1e-3));
    }
    TEST_ASSERT_TRUE(smooth > 30U && smooth < 60U);
}

// ---- resampling

static aisle_spline_sample samples[1000];

static void check_resampling(uint32_t count, double tolerance) {
    aisle_spline_resample(&spline, count, samples);
    TEST_ASSERT_EQUAL_MEMORY(&spline.p[0], &samples[0].p, sizeof samples[0].p);
    TEST_ASSERT_EQUAL_MEMORY(&spline.p[spline.n - 1U], &samples[count - 1U].p, sizeof samples[0].p);
    const uint32_t steps = 40000;
    const double end = spline.u[spline.n - 1U];
    const double spacing = aisle_spline_length(&spline) / (count - 1U);
    uint32_t next = 1;
    double length = 0.0;
    for (uint32_t i = 0; i < steps && next < count; i++) { // walk finely; samples must lie on the way, evenly
        const aisle_spline_sample a = aisle_spline_at(&spline, end * i / steps);
        const aisle_spline_sample b = aisle_spline_at(&spline, end * (i + 1U) / steps);
        const double step = hypot(b.p.x - a.p.x, b.p.y - a.p.y);
        while (next < count && length + step >= next * spacing - 1e-9) {
            const double share = step > 0.0 ? (next * spacing - length) / step : 0.0;
            const aisle_vec2 want = aisle_vec2_lerp(a.p, b.p, share);
            TEST_ASSERT_DOUBLE_WITHIN(tolerance * spacing + 1e-6, 0.0, aisle_vec2_distance(want, samples[next].p));
            next++;
        }
        length += step;
    }
}

static void test_samples_are_equally_spaced_by_arc_length_within_one_percent(void) {
    static const uint32_t counts[] = {2, 3, 10, 57, 200};
    aisle_rng rng = aisle_rng_seed(88);
    for (uint32_t trial = 0; trial < 50U; trial++) {
        const uint32_t n = 2U + aisle_rng_below(&rng, 8);
        gen_way(&rng, n, 1.2);
        fit(trial % 5U == 0U ? AISLE_SPLINE_LINEAR : AISLE_SPLINE_CUBIC, n);
        if (slowest() > 0.1) {
            check_resampling(counts[trial % 5U], 0.01);
        }
    }
}

static void test_samples_carry_the_derivatives_of_their_place(void) {
    aisle_rng rng = aisle_rng_seed(89);
    gen_way(&rng, 6, 1.0);
    fit(AISLE_SPLINE_CUBIC, 6);
    aisle_spline_resample(&spline, 100, samples);
    for (uint32_t i = 1; i + 1U < 100U; i++) { // find its u by looking everywhere
        double low = 0.0;
        double best = (double)INFINITY;
        for (uint32_t k = 0; k <= 20000U; k++) {
            const double u = spline.u[5] * k / 20000.0;
            const double d = aisle_vec2_distance(aisle_spline_at(&spline, u).p, samples[i].p);
            low = d < best ? u : low;
            best = fmin(best, d);
        }
        const aisle_spline_sample s = aisle_spline_at(&spline, low);
        TEST_ASSERT_DOUBLE_WITHIN(3e-3, 0.0, aisle_vec2_distance(s.d1, samples[i].d1));
        TEST_ASSERT_DOUBLE_WITHIN(3e-2, 0.0, aisle_vec2_distance(s.d2, samples[i].d2));
    }
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_too_few_too_many_equal_and_not_finite_points_are_refused);
    RUN_TEST(test_near_points_merge_and_the_last_one_is_kept_exactly);
    RUN_TEST(test_parameter_is_the_cumulated_chord_length);
    RUN_TEST(test_spline_goes_through_its_points_and_is_clamped_to_its_ends);
    RUN_TEST(test_cubics_are_reproduced_for_four_points_and_more);
    RUN_TEST(test_three_points_give_the_parabola_and_two_the_segment);
    RUN_TEST(test_cubic_is_c2_everywhere_and_c3_next_to_the_ends);
    RUN_TEST(test_derivatives_are_those_of_the_position);
    RUN_TEST(test_linear_is_the_segments_with_unit_speed);
    RUN_TEST(test_curvature_of_points_on_a_circle_is_its_inverse_radius_signed);
    RUN_TEST(test_length_is_right_to_1e_6_where_the_speed_does_not_vanish_and_to_1e_3_always);
    RUN_TEST(test_samples_are_equally_spaced_by_arc_length_within_one_percent);
    RUN_TEST(test_samples_carry_the_derivatives_of_their_place);
    return UNITY_END();
}
