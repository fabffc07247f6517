#include "robot/arm_motion.h" // first: proves that the header stands alone

#include "arm_drawn.h"
#include "unity.h"

enum { SEEDS = 100, FINE = 10000 };

static aisle_arm arm;
static aisle_arm_dynamics dynamics;
static aisle_arm_piece piece;

void setUp(void) {}
void tearDown(void) {}

static void draw(uint64_t seed, double torque, double gravity) {
    aisle_rng rng = aisle_rng_seed(seed);
    double from[3], to[3], bend[6];
    arm = drawn_arm(&rng, aisle_rng_below(&rng, 3U) + 1U);
    arm.gravity = gravity;
    for (uint32_t j = 0; j < arm.links; j++) {
        arm.torque_max[j] = torque > 0.0 ? torque * drawn_between(&rng, 0.5, 2.0) : arm.torque_max[j];
    }
    drawn_angles(&rng, 3U, 2.0, from);
    drawn_angles(&rng, 3U, 2.0, to);
    drawn_angles(&rng, 6U, 60.0, bend);
    aisle_arm_piece_of(arm.links, from, to, bend, &piece);
    aisle_arm_dynamics_begin(&dynamics, &arm, 0.2);
    for (uint32_t order = 0; order < 3U; order++) { // the ends are kept, at rest
        double at[2][3];
        aisle_arm_piece_at(&piece, 0.0, order, at[0]);
        aisle_arm_piece_at(&piece, 1.0, order, at[1]);
        for (uint32_t j = 0; j < arm.links; j++) {
            TEST_ASSERT_DOUBLE_WITHIN(1e-11, order == 0U ? from[j] : 0.0, at[0][j]);
            TEST_ASSERT_DOUBLE_WITHIN(1e-11, order == 0U ? to[j] : 0.0, at[1][j]);
        }
    }
}

static void test_ends_are_kept_at_rest_whatever_the_bend(void) {
    for (uint64_t seed = 0; seed < SEEDS; seed++) {
        draw(seed, 0.0, 0.0);
    }
}
static void test_the_papers_coefficients_are_a6_and_a7(void) {
    const double from[1] = {0.3}, to[1] = {1.0};
    double bend[2];
    aisle_arm_bend_of_paper(17.0, -5.0, bend);
    aisle_arm_piece_of(1, from, to, bend, &piece);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 17.0, piece.c[0][6]);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, -5.0, piece.c[0][7]);
}
static void test_a_bend_of_64_moves_the_middle_by_a_radian(void) {
    const double from[1] = {0.0}, to[1] = {0.0}, bend[2] = {64.0, 0.0};
    double q[1];
    aisle_arm_piece_of(1, from, to, bend, &piece);
    aisle_arm_piece_at(&piece, 0.5, 0, q);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 1.0, q[0]);
}

// The greatest shares of the limits at FINE + 1 places, when run in so many seconds.
static drawn_share worst_share(double duration) {
    drawn_share worst = {0.0, 0.0};
    for (int i = 0; i <= FINE; i++) {
        const drawn_share share = drawn_shares(&arm, 0.2, &piece, (double)i / FINE, duration);
        worst.motion = fmax(worst.motion, share.motion);
        worst.torque = fmax(worst.torque, share.torque);
    }
    return worst;
}

static void test_in_the_least_duration_some_limit_is_reached_and_none_passed(void) {
    int by_torque = 0;
    for (uint64_t seed = 0; seed < SEEDS; seed++) {
        aisle_arm_timing timing;
        draw(seed, seed % 2U == 0U ? 4.0 : 0.0, 0.0);
        aisle_arm_least_duration(&arm, &dynamics, &piece, AISLE_ARM_TIMING_PANELS, &timing);
        const drawn_share worst = worst_share(timing.duration);
        TEST_ASSERT_DOUBLE_WITHIN(1e-5, 1.0, fmax(worst.motion, worst.torque));
        TEST_ASSERT_EQUAL(worst.torque > worst.motion, timing.limit == AISLE_ARM_LIMIT_TORQUE);
        by_torque += timing.limit == AISLE_ARM_LIMIT_TORQUE ? 1 : 0;
    }
    TEST_ASSERT_INT_WITHIN(45, 50, by_torque); // both kinds are drawn
}
static void test_against_gravity_the_torque_limit_is_met_by_the_same_law(void) {
    int held = 0;
    for (uint64_t seed = 0; seed < SEEDS; seed++) {
        aisle_arm_timing timing;
        draw(seed, 60.0, 9.81);
        aisle_arm_least_duration(&arm, &dynamics, &piece, AISLE_ARM_TIMING_PANELS, &timing);
        if (!(timing.duration < (double)INFINITY)) { // too heavy somewhere, however slow
            TEST_ASSERT_TRUE(worst_share(1e6).torque > 1.0 - 1e-6);
            continue;
        }
        const drawn_share shares = worst_share(timing.duration);
        const double worst = fmax(shares.motion, shares.torque);
        TEST_ASSERT_TRUE(worst <= 1.0 + 1e-8 && worst >= 1.0 - 1e-5);
        held++;
    }
    TEST_ASSERT_TRUE(held > 20);
}
static void test_travel_is_the_integral_of_the_rates(void) {
    for (uint64_t seed = 0; seed < SEEDS; seed++) {
        draw(seed, 0.0, 0.0);
        double sum = 0.0;
        for (int i = 0; i < FINE; i++) {
            double v[3];
            aisle_arm_piece_at(&piece, ((double)i + 0.5) / FINE, 1, v);
            for (uint32_t j = 0; j < arm.links; j++) {
                sum += fabs(v[j]) / FINE;
            }
        }
        TEST_ASSERT_DOUBLE_WITHIN(1e-6, sum, aisle_arm_piece_travel_exact(&piece));
        TEST_ASSERT_DOUBLE_WITHIN(1e-2, sum, aisle_arm_piece_travel(&piece));
    }
}
static void test_joints_out_of_limits_anywhere_are_noticed(void) {
    for (uint64_t seed = 0; seed < SEEDS; seed++) {
        draw(seed, 0.0, 0.0);
        uint32_t first = 0;
        double bounds[3], peaks[3];
        for (uint32_t j = arm.links; j-- > 0U;) {
            for (int i = 0; i <= FINE; i++) {
                double q[3];
                aisle_arm_piece_at(&piece, (double)i / FINE, 0, q);
                first = q[j] < arm.min[j] - 1e-7 || q[j] > arm.max[j] + 1e-7 ? j + 1U : first;
            }
        }
        double out;
        TEST_ASSERT_EQUAL_UINT32(first, aisle_arm_piece_joint_out(&piece, &arm, &out));
        TEST_ASSERT_EQUAL(first > 0U, out > 0.0);
        aisle_arm_piece_peaks(&piece, 2, peaks);
        aisle_arm_piece_bounds(&piece, 2, bounds);
        for (uint32_t j = 0; j < arm.links; j++) {
            TEST_ASSERT_TRUE(bounds[j] >= peaks[j] * (1.0 - 1e-12));
            TEST_ASSERT_TRUE(bounds[j] <= 4.0 * peaks[j]);
        }
    }
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_ends_are_kept_at_rest_whatever_the_bend);
    RUN_TEST(test_the_papers_coefficients_are_a6_and_a7);
    RUN_TEST(test_a_bend_of_64_moves_the_middle_by_a_radian);
    RUN_TEST(test_in_the_least_duration_some_limit_is_reached_and_none_passed);
    RUN_TEST(test_against_gravity_the_torque_limit_is_met_by_the_same_law);
    RUN_TEST(test_travel_is_the_integral_of_the_rates);
    RUN_TEST(test_joints_out_of_limits_anywhere_are_noticed);
    return UNITY_END();
}
