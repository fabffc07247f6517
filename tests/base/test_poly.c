#include "base/poly.h" // first: proves that the header stands alone

#include "base/rng.h"
#include "unity.h"

#include <math.h>
#include <string.h>

enum { SEEDS = 200, FINE = 20000 };

void setUp(void) {}
void tearDown(void) {}

static void draw(aisle_rng *rng, uint32_t degree, double *c) {
    for (uint32_t i = 0; i <= degree; i++) {
        c[i] = 2.0 * (double)aisle_rng_float(rng) - 1.0;
    }
}

static long double exact(const double *c, uint32_t degree, long double r) {
    long double value = 0.0L, power = 1.0L;
    for (uint32_t i = 0; i <= degree; i++) {
        value += (long double)c[i] * power;
        power *= r;
    }
    return value;
}

static void test_values_and_derivatives_are_those_of_the_sum(void) {
    for (uint64_t seed = 0; seed < SEEDS; seed++) {
        aisle_rng rng = aisle_rng_seed(seed);
        double c[AISLE_POLY_DEGREE_MAX + 1U], d[AISLE_POLY_DEGREE_MAX + 1U];
        const uint32_t degree = aisle_rng_below(&rng, AISLE_POLY_DEGREE_MAX) + 1U;
        draw(&rng, degree, c);
        const double r = (double)aisle_rng_float(&rng);
        TEST_ASSERT_DOUBLE_WITHIN(1e-14, (double)exact(c, degree, (long double)r), aisle_poly_value(c, degree, r));
        TEST_ASSERT_EQUAL_UINT32(degree - 1U, aisle_poly_derivative(c, degree, d));
        const long double h = 1e-6L;
        const long double slope =
            (exact(c, degree, (long double)r + h) - exact(c, degree, (long double)r - h)) / (2.0L * h);
        TEST_ASSERT_DOUBLE_WITHIN(1e-8, (double)slope, aisle_poly_value(d, degree - 1U, r));
    }
    double constant[1] = {3.0};
    TEST_ASSERT_EQUAL_UINT32(0, aisle_poly_derivative(constant, 0, constant));
    TEST_ASSERT_EQUAL_DOUBLE(0.0, constant[0]);
}

static void multiply(double *c, uint32_t *degree, double root) {
    c[*degree + 1U] = 0.0;
    for (uint32_t i = *degree + 1U; i > 0U; i--) {
        c[i] = c[i - 1U] - root * c[i];
    }
    c[0] *= -root;
    (*degree)++;
}

static void test_every_root_of_a_product_of_factors_is_found(void) {
    for (uint64_t seed = 0; seed < SEEDS; seed++) {
        aisle_rng rng = aisle_rng_seed(seed);
        const uint32_t most = aisle_rng_below(&rng, 7U) + 1U;
        double c[AISLE_POLY_DEGREE_MAX + 1U] = {1.0}, roots[AISLE_POLY_DEGREE_MAX], known[7];
        uint32_t degree = 0;
        for (uint32_t i = 0; i < most; i++) { // apart by 1/14 at least
            known[i] = ((double)i + 0.25 + 0.5 * (double)aisle_rng_float(&rng)) / 7.0;
            multiply(c, &degree, known[i]);
        }
        multiply(c, &degree, 1.5); // outside
        TEST_ASSERT_EQUAL_UINT32(most, aisle_poly_roots(c, degree, roots));
        for (uint32_t i = 0; i < most; i++) {
            TEST_ASSERT_DOUBLE_WITHIN(1e-9, known[i], roots[i]);
        }
    }
}
static void test_every_change_of_sign_is_a_root_and_every_root_is_one(void) {
    uint32_t sum = 0;
    for (uint64_t seed = 0; seed < 10U * SEEDS; seed++) {
        aisle_rng rng = aisle_rng_seed(seed);
        double c[AISLE_POLY_DEGREE_MAX + 1U], roots[AISLE_POLY_DEGREE_MAX];
        const uint32_t degree = aisle_rng_below(&rng, AISLE_POLY_DEGREE_MAX) + 1U;
        draw(&rng, degree, c);
        for (uint32_t i = 1; i <= degree; i++) { // steeper and steeper: many of them have a root or more
            c[i] *= (double)(1U << (2U * i));
        }
        const uint32_t count = aisle_poly_roots(c, degree, roots);
        uint32_t changes = 0;
        for (int i = 0; i < 500; i++) {
            changes += exact(c, degree, i / 500.0L) * exact(c, degree, (i + 1) / 500.0L) < 0.0L ? 1U : 0U;
        }
        TEST_ASSERT_TRUE(count >= changes && (count - changes) % 2U == 0U); // two within a step may be
        for (uint32_t i = 0; i < count; i++) {
            const long double r = (long double)roots[i], by = 1e-10L;
            TEST_ASSERT_TRUE(exact(c, degree, r - by) * exact(c, degree, r + by) < 0.0L);
            TEST_ASSERT_TRUE(i == 0U || roots[i] > roots[i - 1U]);
        }
        sum += count;
    }
    TEST_ASSERT_GREATER_THAN_UINT32(5U * SEEDS, sum);
}
static void test_a_zero_that_is_only_touched_is_told_once_at_most(void) {
    const double square[3] = {0.25, -1.0, 1.0}; // (r - 1/2)^2
    double roots[AISLE_POLY_DEGREE_MAX];
    TEST_ASSERT_TRUE(aisle_poly_roots(square, 2, roots) <= 1U);
}
static void test_ranges_and_peaks_are_those_of_a_fine_walk(void) {
    for (uint64_t seed = 0; seed < SEEDS; seed++) {
        aisle_rng rng = aisle_rng_seed(seed);
        double c[AISLE_POLY_DEGREE_MAX + 1U], lo, hi;
        const uint32_t degree = aisle_rng_below(&rng, AISLE_POLY_DEGREE_MAX + 1U);
        draw(&rng, degree, c);
        long double least = exact(c, degree, 0.0L), most = least;
        for (int i = 1; i <= FINE / 20; i++) {
            const long double value = exact(c, degree, (long double)i / (FINE / 20));
            least = value < least ? value : least;
            most = value > most ? value : most;
        }
        aisle_poly_range(c, degree, &lo, &hi);
        TEST_ASSERT_TRUE((long double)lo <= least + 1e-14L && (long double)hi >= most - 1e-14L);
        TEST_ASSERT_DOUBLE_WITHIN(1e-4, (double)least, lo);
        TEST_ASSERT_DOUBLE_WITHIN(1e-4, (double)most, hi);
        TEST_ASSERT_EQUAL_DOUBLE(fmax(-lo, hi), aisle_poly_peak(c, degree));
    }
}
static void test_bounds_hold_on_every_part_and_close_in_on_the_range(void) {
    for (uint64_t seed = 0; seed < SEEDS; seed++) {
        aisle_rng rng = aisle_rng_seed(seed);
        double c[AISLE_POLY_DEGREE_MAX + 1U], lo, hi;
        const uint32_t degree = aisle_rng_below(&rng, AISLE_POLY_DEGREE_MAX + 1U);
        draw(&rng, degree, c);
        const double a = 0.9 * (double)aisle_rng_float(&rng), b = a + 0.1 * (double)aisle_rng_float(&rng);
        aisle_poly_bounds(c, degree, a, b, &lo, &hi);
        double least = INFINITY, most = -INFINITY;
        for (int i = 0; i <= 200; i++) {
            const double value = (double)exact(c, degree, (long double)a + (long double)(b - a) * i / 200);
            TEST_ASSERT_TRUE(value >= lo - 1e-13 && value <= hi + 1e-13);
            least = fmin(least, value);
            most = fmax(most, value);
        }
        TEST_ASSERT_TRUE(least - lo < 0.6 * (b - a) * (b - a) * 81.0 + 1e-9 &&
                         hi - most < 0.6 * (b - a) * (b - a) * 81.0 + 1e-9);
    }
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_values_and_derivatives_are_those_of_the_sum);
    RUN_TEST(test_every_root_of_a_product_of_factors_is_found);
    RUN_TEST(test_every_change_of_sign_is_a_root_and_every_root_is_one);
    RUN_TEST(test_a_zero_that_is_only_touched_is_told_once_at_most);
    RUN_TEST(test_ranges_and_peaks_are_those_of_a_fine_walk);
    RUN_TEST(test_bounds_hold_on_every_part_and_close_in_on_the_range);
    return UNITY_END();
}
