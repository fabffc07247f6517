#include "base/rounding.h" // first: proves that the header stands alone

#include "base/rng.h"
#include "unity.h"

#include <math.h>

void setUp(void) {}
void tearDown(void) {}

static void test_neighbours_are_the_next_floats(void) {
    const float x[] = {1.0F, 0.1F, 3.5e-39F, 1e30F, 16384.0F};
    for (int i = 0; i < 5; i++) {
        TEST_ASSERT_TRUE(!(aisle_float_next(x[i], 1) < nextafterf(x[i], 1e38F)));
        TEST_ASSERT_TRUE(!(aisle_float_next(x[i], 1) > nextafterf(x[i], 1e38F)));
        TEST_ASSERT_TRUE(!(aisle_float_next(x[i], -1) < nextafterf(x[i], 0.0F)));
        TEST_ASSERT_TRUE(!(aisle_float_next(x[i], -1) > nextafterf(x[i], 0.0F)));
    }
    TEST_ASSERT_TRUE(aisle_float_next(0.0F, 1) > 0.0F);
}

static void test_below_and_above_enclose_and_are_neighbours_or_the_number_itself(void) {
    aisle_rng rng = aisle_rng_seed(1);
    for (int i = 0; i < 20000; i++) {
        const double x = exp(40.0 * (double)aisle_rng_float(&rng) - 20.0) * (1.0 + 1e-9 * i);
        const float below = aisle_float_below(x), above = aisle_float_above(x);
        TEST_ASSERT_TRUE((double)below <= x && (double)above >= x);
        TEST_ASSERT_TRUE((double)nextafterf(below, 1e38F) > x && (double)nextafterf(above, 0.0F) < x);
        TEST_ASSERT_TRUE((double)aisle_float_below((double)below) >= (double)below);
        TEST_ASSERT_TRUE((double)aisle_float_above((double)below) <= (double)below);
    }
    TEST_ASSERT_TRUE(aisle_float_below(0.0) <= 0.0F && aisle_float_above(0.0) <= 0.0F);
}

typedef struct pair {
    double a, b;
} pair;

static float kept[2];

static pair rounded(double a, double b) {
    kept[0] = (float)a;
    kept[1] = (float)b;
    return (pair){(double)kept[0], (double)kept[1]};
}

// Some compilers' vectors forget it, see cmake/AisleWarnings.cmake.
static void test_the_compiler_rounds_two_neighbours_to_float(void) {
    pair (*volatile call)(double, double) = rounded;
    const pair p = call(0.1, 0.7);
    const volatile float a = 0.1F, b = 0.7F;
    TEST_ASSERT_TRUE(!(p.a < (double)a) && !(p.a > (double)a));
    TEST_ASSERT_TRUE(!(p.b < (double)b) && !(p.b > (double)b));
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_neighbours_are_the_next_floats);
    RUN_TEST(test_the_compiler_rounds_two_neighbours_to_float);
    RUN_TEST(test_below_and_above_enclose_and_are_neighbours_or_the_number_itself);
    return UNITY_END();
}
