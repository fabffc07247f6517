#include "base/angle.h" // first: proves that the header stands alone

#include "base/crc32.h"
#include "base/rng.h"
#include "unity.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

// Half a unit of the oracle itself, where long double is no better than double.
static const double ORACLE = LDBL_MANT_DIG > DBL_MANT_DIG ? 0.0 : 1.2e-16;
// 2 pi in a part with 36 bits, whose small multiples are exact, and the rest.
static const long double TURN_HI = 0x1.921fb5444p+2L, TURN_LO = 0x1.68c234c4c6628b8p-37L;

static aisle_rng rng;

void setUp(void) {
    rng = aisle_rng_seed(2026);
}
void tearDown(void) {}

static double uniform(double lo, double hi) {
    const double high = (double)aisle_rng_next(&rng);
    const double low = (double)aisle_rng_next(&rng) * 0x1p-32;
    return lo + (hi - lo) * ((high + low) * 0x1p-32);
}

static long double turns_of(long double angle) {
    return floorl(angle / (TURN_HI + TURN_LO) + 0.5L);
}

// How far a direction is from another one, given as an angle in one turn.
static long double apart(long double angle, long double other) {
    const long double k = turns_of(angle - other);
    return ((angle - k * TURN_HI) - other) - k * TURN_LO;
}

static void check_sincos(double angle) {
    double s;
    double c;
    aisle_sincos(angle, &s, &c);
    const double es = (double)fabsl((long double)s - sinl((long double)angle));
    const double ec = (double)fabsl((long double)c - cosl((long double)angle));
    if (!(es <= 2e-16 + ORACLE && ec <= 2e-16 + ORACLE && fabs(s) <= 1.0 && fabs(c) <= 1.0)) {
        char text[96];
        (void)snprintf(text, sizeof text, "angle %.17g: errors %g %g", angle, es, ec);
        TEST_FAIL_MESSAGE(text);
    }
}

static void test_sincos_is_within_2e_16_on_a_dense_grid_of_two_turns(void) {
    for (int i = -200000; i <= 200000; i++) {
        check_sincos((double)i * 6.4e-5);
    }
}

static void test_sincos_is_within_2e_16_up_to_the_largest_angle(void) {
    for (int i = 0; i < 300000; i++) {
        check_sincos(uniform(-AISLE_ANGLE_MAX, AISLE_ANGLE_MAX));
    }
    check_sincos(AISLE_ANGLE_MAX);
    check_sincos(-AISLE_ANGLE_MAX);
}

static void test_sincos_is_within_2e_16_on_both_sides_of_every_eighth_turn(void) {
    for (int k = -127000; k <= 127000; k++) { // edges of the quadrants, and where the polynomials meet
        const double edge = (double)k * (AISLE_PI / 4.0);
        check_sincos(edge);
        check_sincos(nextafter(edge, -1e9));
        check_sincos(nextafter(edge, 1e9));
    }
}

static void test_sincos_of_tiny_angles_keeps_all_digits(void) {
    for (double angle = 1e-300; angle < 1e-9; angle *= 7.0) {
        double s;
        double c;
        aisle_sincos(angle, &s, &c);
        TEST_ASSERT_TRUE(fabs(s - angle) <= 1e-16 * angle);
        TEST_ASSERT_TRUE(c > 0.999999999999999);
    }
}

static void test_sine_is_odd_and_cosine_even_to_the_bit(void) {
    for (int i = 0; i < 200000; i++) {
        const double angle = i < 1000 ? (double)(i + 1) * (AISLE_PI / 8.0) : uniform(0.0, i % 2 == 0 ? 10.0 : 1e5);
        double s[2];
        double c[2];
        aisle_sincos(angle, &s[0], &c[0]);
        aisle_sincos(-angle, &s[1], &c[1]);
        s[1] = -s[1];
        TEST_ASSERT_EQUAL_MEMORY(&s[0], &s[1], sizeof s[0]);
        TEST_ASSERT_EQUAL_MEMORY(&c[0], &c[1], sizeof c[0]);
    }
}

static void test_sincos_of_zero_is_exact(void) {
    double s;
    double c;
    aisle_sincos(0.0, &s, &c);
    TEST_ASSERT_TRUE(s <= 0.0 && s >= 0.0 && c <= 1.0 && c >= 1.0);
}

static void test_sincos_of_nan_infinity_and_too_large_angles_is_nan(void) {
    const double bad[] = {(double)NAN, (double)INFINITY, -(double)INFINITY, nextafter(AISLE_ANGLE_MAX, 1e9), -1e300};
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        double s = 0.0;
        double c = 0.0;
        aisle_sincos(bad[i], &s, &c);
        TEST_ASSERT_TRUE(isnan(s) && isnan(c));
    }
}

static void check_atan2(double y, double x) {
    const double got = aisle_atan2(y, x);
    const long double off =
        apart((long double)got, atan2l((long double)y, (long double)x)); // as directions: the cut is no error
    const double bound = (x >= 0.0 ? 4e-16 : 1e-15) + 2.0 * ORACLE;
    if (!((double)fabsl(off) <= bound && got > -AISLE_PI && got <= AISLE_PI)) {
        char text[128];
        (void)snprintf(text, sizeof text, "atan2(%.17g, %.17g) = %.17g, error %g", y, x, got, (double)off);
        TEST_FAIL_MESSAGE(text);
    }
}

static void test_atan2_is_within_its_bound_all_round(void) {
    for (int i = 0; i < 400000; i++) {
        const double turn = (double)i * (2.0 * AISLE_PI / 400000.0);
        check_atan2(sin(turn), cos(turn));
    }
}

static void test_atan2_is_within_its_bound_for_any_lengths(void) {
    for (int i = 0; i < 300000; i++) {
        const double y = uniform(-1.0, 1.0) * pow(10.0, uniform(-300.0, 300.0));
        check_atan2(y, y * uniform(-3.0, 3.0) * pow(10.0, (double)(i % 7 - 3)));
        const double side = uniform(-50.0, 50.0);
        check_atan2(side, uniform(-50.0, 50.0));
    }
}

static void test_atan2_is_within_its_bound_where_its_polynomial_changes_centre(void) {
    const double edges[] = {0.155, 0.512, 1.0, 0.3125, 0.75};
    for (size_t i = 0; i < sizeof edges / sizeof edges[0]; i++) {
        double y = edges[i];
        for (int back = 0; back < 100; back++) {
            y = nextafter(y, 0.0);
        }
        for (int step = 0; step < 200; step++, y = nextafter(y, 2.0)) {
            check_atan2(y, 1.0);
            check_atan2(1.0, y);
            check_atan2(-y, -1.0);
            check_atan2(1.0, -y);
        }
    }
}

static void expect_bits(double want, double got) {
    if (memcmp(&want, &got, sizeof want) != 0) {
        char text[64];
        (void)snprintf(text, sizeof text, "expected %a, got %a", want, got);
        TEST_FAIL_MESSAGE(text);
    }
}

static void test_atan2_on_the_axes_is_exact(void) {
    expect_bits(0.0, aisle_atan2(0.0, 1.0));
    expect_bits(AISLE_PI / 2.0, aisle_atan2(3.0, 0.0));
    expect_bits(AISLE_PI, aisle_atan2(0.0, -0.1));
    expect_bits(-AISLE_PI / 2.0, aisle_atan2(-7.0, 0.0));
    expect_bits(0.0, aisle_atan2(0.0, 0.0));
}

static void test_atan2_reads_minus_zero_as_zero(void) {
    expect_bits(AISLE_PI, aisle_atan2(-0.0, -1.0));
    expect_bits(AISLE_PI / 2.0, aisle_atan2(1.0, -0.0));
    expect_bits(0.0, aisle_atan2(-0.0, -0.0));
    TEST_ASSERT_TRUE(fabs(aisle_atan2(-0.0, 1.0)) <= 0.0);
}

static void test_atan2_just_below_the_cut_never_gives_minus_pi(void) {
    expect_bits(AISLE_PI, aisle_atan2(-1e-300, -1.0));
    expect_bits(AISLE_PI, aisle_atan2(-1e-17, -1.0));
    TEST_ASSERT_TRUE(aisle_atan2(-1e-15, -1.0) < -3.14);
}

static void test_atan2_mirrors_to_the_bit(void) {
    for (int i = 0; i < 100000; i++) {
        const double x = uniform(-9.0, 9.0);
        const double y = uniform(1e-9, 9.0);
        expect_bits(aisle_atan2(y, x), -aisle_atan2(-y, x));
        expect_bits(aisle_atan2(y, x), aisle_atan2(1024.0 * y, 1024.0 * x));
    }
}

static void test_atan2_undoes_sincos(void) {
    for (int i = 0; i < 100000; i++) {
        const double angle = uniform(-AISLE_PI, AISLE_PI);
        double s;
        double c;
        aisle_sincos(angle, &s, &c);
        TEST_ASSERT_TRUE(fabs(aisle_angle_difference(angle, aisle_atan2(s, c))) <= 2e-15);
    }
}

static void test_atan2_of_nan_is_nan(void) {
    TEST_ASSERT_TRUE(isnan(aisle_atan2((double)NAN, 1.0)));
    TEST_ASSERT_TRUE(isnan(aisle_atan2(1.0, (double)NAN)));
    TEST_ASSERT_TRUE(isnan(aisle_atan2((double)NAN, 0.0)));
    TEST_ASSERT_TRUE(isnan(aisle_atan2((double)NAN, (double)NAN)));
}

static void test_exp_is_within_5e_16_of_itself(void) {
    for (int i = -350000; i <= 350000; i++) {
        const double x = i % 2 == 0 ? (double)i * 0.002 : uniform(-2.0, 2.0);
        const double off = (double)fabsl((long double)aisle_exp(x) / expl((long double)x) - 1.0L);
        TEST_ASSERT_TRUE(off <= 5e-16 + ORACLE);
    }
}

static void test_exp_of_zero_is_one_and_ends_are_stated(void) {
    expect_bits(1.0, aisle_exp(0.0));
    expect_bits(1.0, aisle_exp(-0.0));
    TEST_ASSERT_TRUE(aisle_exp(AISLE_EXP_MAX) > 1e304 && isfinite(aisle_exp(AISLE_EXP_MAX)));
    TEST_ASSERT_TRUE(aisle_exp(-AISLE_EXP_MAX) > 0.0 && aisle_exp(-AISLE_EXP_MAX) < 1e-303);
    TEST_ASSERT_TRUE(isinf(aisle_exp(700.1)) && isinf(aisle_exp((double)INFINITY)));
    expect_bits(0.0, aisle_exp(-700.1));
    expect_bits(0.0, aisle_exp(-(double)INFINITY));
    TEST_ASSERT_TRUE(isnan(aisle_exp((double)NAN)));
}

static void test_wrap_leaves_angles_in_range_alone(void) {
    expect_bits(AISLE_PI, aisle_angle_wrap(AISLE_PI));
    const double least = nextafter(-AISLE_PI, 0.0);
    expect_bits(least, aisle_angle_wrap(least));
    for (int i = 0; i < 100000; i++) {
        const double angle = uniform(least, AISLE_PI);
        expect_bits(angle, aisle_angle_wrap(angle));
    }
}

static void test_wrap_gives_the_same_direction_within_1e_15(void) {
    for (int i = 0; i < 300000; i++) {
        const double angle = uniform(-1.0, 1.0) * (i % 2 == 0 ? 20.0 : AISLE_ANGLE_MAX);
        const double got = aisle_angle_wrap(angle);
        TEST_ASSERT_TRUE(got > -AISLE_PI && got <= AISLE_PI);
        TEST_ASSERT_TRUE(fabsl(apart((long double)angle, (long double)got)) <= 1e-15L);
    }
}

static void test_wrap_at_odd_multiples_of_pi_stays_in_range(void) {
    for (int k = -31831; k <= 31831; k += 2) {
        const double edge = (double)k * AISLE_PI;
        if (fabs(edge) < AISLE_ANGLE_MAX) {
            const double around[3] = {edge, nextafter(edge, 1e9), nextafter(edge, -1e9)};
            for (int i = 0; i < 3; i++) {
                const double got = aisle_angle_wrap(around[i]);
                TEST_ASSERT_TRUE(got > -AISLE_PI && got <= AISLE_PI && fabs(got) > 3.14159265);
            }
        }
    }
    expect_bits(AISLE_PI, aisle_angle_wrap(-AISLE_PI));
}

static void test_wrap_of_nan_infinity_and_too_large_angles_is_nan(void) {
    TEST_ASSERT_TRUE(isnan(aisle_angle_wrap((double)NAN)));
    TEST_ASSERT_TRUE(isnan(aisle_angle_wrap(-(double)INFINITY)));
    TEST_ASSERT_TRUE(isnan(aisle_angle_wrap(1.1e5)));
}

static void test_difference_goes_the_short_way_round(void) {
    TEST_ASSERT_DOUBLE_WITHIN(1e-15, 0.2, aisle_angle_difference(AISLE_PI - 0.1, -AISLE_PI + 0.1));
    TEST_ASSERT_DOUBLE_WITHIN(1e-15, -0.2, aisle_angle_difference(-AISLE_PI + 0.1, AISLE_PI - 0.1));
    TEST_ASSERT_DOUBLE_WITHIN(1e-15, 1.5, aisle_angle_difference(-1.0, 0.5));
    expect_bits(AISLE_PI, aisle_angle_difference(0.0, -AISLE_PI)); // half a turn is counter-clockwise
}

// Recorded once: any other compiler, option or board must give the same bits.
static void test_bits_are_those_of_every_other_board(void) {
    uint32_t crc = 0;
    for (int i = 0; i < 20000; i++) {
        const double angle = uniform(-1.0, 1.0) * (i % 2 == 0 ? 8.0 : AISLE_ANGLE_MAX);
        const double x = uniform(-5.0, 5.0);
        const double y = uniform(-5.0, 5.0);
        double all[5];
        aisle_sincos(angle, &all[0], &all[1]);
        all[2] = aisle_atan2(y, x);
        all[3] = aisle_exp(uniform(-AISLE_EXP_MAX, AISLE_EXP_MAX));
        all[4] = aisle_angle_wrap(angle);
        for (int k = 0; k < 5; k++) {
            uint64_t bits;
            uint8_t bytes[8];
            memcpy(&bits, &all[k], sizeof bits);
            for (int b = 0; b < 8; b++) {
                bytes[b] = (uint8_t)(bits >> (8 * b));
            }
            crc = aisle_crc32(crc, bytes, sizeof bytes);
        }
    }
    TEST_ASSERT_EQUAL_HEX32(0xE6D0D44F, crc);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_sincos_is_within_2e_16_on_a_dense_grid_of_two_turns);
    RUN_TEST(test_sincos_is_within_2e_16_up_to_the_largest_angle);
    RUN_TEST(test_sincos_is_within_2e_16_on_both_sides_of_every_eighth_turn);
    RUN_TEST(test_sincos_of_tiny_angles_keeps_all_digits);
    RUN_TEST(test_sine_is_odd_and_cosine_even_to_the_bit);
    RUN_TEST(test_sincos_of_zero_is_exact);
    RUN_TEST(test_sincos_of_nan_infinity_and_too_large_angles_is_nan);
    RUN_TEST(test_atan2_is_within_its_bound_all_round);
    RUN_TEST(test_atan2_is_within_its_bound_for_any_lengths);
    RUN_TEST(test_atan2_is_within_its_bound_where_its_polynomial_changes_centre);
    RUN_TEST(test_atan2_on_the_axes_is_exact);
    RUN_TEST(test_atan2_reads_minus_zero_as_zero);
    RUN_TEST(test_atan2_just_below_the_cut_never_gives_minus_pi);
    RUN_TEST(test_atan2_mirrors_to_the_bit);
    RUN_TEST(test_atan2_undoes_sincos);
    RUN_TEST(test_atan2_of_nan_is_nan);
    RUN_TEST(test_exp_is_within_5e_16_of_itself);
    RUN_TEST(test_exp_of_zero_is_one_and_ends_are_stated);
    RUN_TEST(test_wrap_leaves_angles_in_range_alone);
    RUN_TEST(test_wrap_gives_the_same_direction_within_1e_15);
    RUN_TEST(test_wrap_at_odd_multiples_of_pi_stays_in_range);
    RUN_TEST(test_wrap_of_nan_infinity_and_too_large_angles_is_nan);
    RUN_TEST(test_difference_goes_the_short_way_round);
    RUN_TEST(test_bits_are_those_of_every_other_board);
    return UNITY_END();
}
