#include "plan/arm_time.h" // first: proves that the header stands alone

#include "../robot/arm_drawn.h"
#include "unity.h"

enum { SEEDS = 24, FINE = 2000 };

static unsigned char block[1 << 16] __attribute__((aligned(AISLE_ARENA_ALIGN)));
static aisle_arm_time search;
static aisle_arm arm;
static aisle_arm_piece piece;
static aisle_arm_dynamics dynamics;

void setUp(void) {
    aisle_arena arena = aisle_arena_over(block, sizeof block);
    aisle_arm_time_carve(&search, &arena);
    TEST_ASSERT_FALSE(arena.overflow);
}
void tearDown(void) {}

// Weak enough to count, strong enough to hold the arm's weight all along.
static void draw_motors(aisle_rng *rng) {
    static const double rest[3] = {0.0, 0.0, 0.0};
    for (uint32_t j = 0; j < arm.links; j++) {
        arm.torque_max[j] = drawn_between(rng, 0.5, 3.0);
    }
    for (int i = 0; i <= FINE && arm.gravity > 0.0; i++) {
        double q[3];
        long double torque[3];
        aisle_arm_piece_at(&piece, (double)i / FINE, 0, q);
        drawn_torques(&arm, 0.2, q, rest, rest, torque);
        for (uint32_t j = 0; j < arm.links; j++) {
            arm.torque_max[j] = fmax(arm.torque_max[j], 1.08 * (double)fabsl(torque[j]));
        }
    }
}

static void draw(uint64_t seed) {
    aisle_rng rng = aisle_rng_seed(seed);
    double from[3], to[3], bend[6];
    arm = drawn_arm(&rng, aisle_rng_below(&rng, 3U) + 1U);
    arm.gravity = seed % 2U == 0U ? 0.0 : 9.81;
    drawn_angles(&rng, 3U, 2.0, from);
    drawn_angles(&rng, 3U, 2.0, to);
    drawn_angles(&rng, 6U, 40.0, bend);
    aisle_arm_piece_of(arm.links, from, to, bend, &piece);
    if (seed % 4U != 3U) { // else strong ones
        draw_motors(&rng);
    }
    aisle_arm_dynamics_begin(&dynamics, &arm, 0.2);
}

static aisle_status run(uint64_t seed, uint32_t units, uint32_t *spent, double *duration) {
    aisle_status st;
    aisle_arm_time_start(&search, &arm, &dynamics, &piece, seed);
    do {
        st = aisle_arm_time_step(&search, units, spent, duration);
    } while (st == AISLE_BUSY);
    return st;
}

// Are all limits held at FINE + 1 places when run in so many seconds?
static bool is_held(double duration) {
    for (int i = 0; i <= FINE; i++) {
        const drawn_share share = drawn_shares(&arm, 0.2, &piece, (double)i / FINE, duration);
        if (share.motion > 1.0 || share.torque > 1.0) {
            return false;
        }
    }
    return true;
}

static void test_it_comes_to_the_least_duration_within_a_thousandth(void) {
    int by_torque = 0;
    for (uint64_t seed = 0; seed < SEEDS; seed++) {
        aisle_arm_timing exact;
        uint32_t spent = 0;
        double duration = 0.0;
        draw(seed);
        TEST_ASSERT_EQUAL(AISLE_OK, run(seed, 1000, &spent, &duration));
        TEST_ASSERT_TRUE(is_held(1.001 * duration));
        TEST_ASSERT_FALSE(is_held(0.999 * duration));
        aisle_arm_least_duration(&arm, &dynamics, &piece, AISLE_ARM_TIMING_PANELS, &exact);
        TEST_ASSERT_DOUBLE_WITHIN(1e-3 * exact.duration, exact.duration, duration);
        by_torque += exact.limit == AISLE_ARM_LIMIT_TORQUE ? 1 : 0;
    }
    TEST_ASSERT_TRUE(by_torque > 3 && by_torque < SEEDS - 3); // both kinds were there
}
static void test_it_is_the_papers_number_of_candidates_however_it_is_cut(void) {
    uint32_t spent[2] = {0, 0};
    double duration[2] = {0.0, 0.0};
    draw(1);
    (void)run(7, 1, &spent[0], &duration[0]);
    TEST_ASSERT_EQUAL_UINT32(20U * 1001U - 1000U,
                             search.ga.evals); // the elite of a generation is not asked about again
    (void)run(7, UINT32_MAX, &spent[1], &duration[1]);
    TEST_ASSERT_EQUAL_UINT32(spent[0], spent[1]);
    TEST_ASSERT_EQUAL_MEMORY(&duration[0], &duration[1], sizeof duration[0]);
}
static void test_a_motion_that_takes_more_than_100_s_is_not_found(void) {
    uint32_t spent = 0;
    double duration = 3.0;
    draw(0);
    arm.v_max[0] = 1e-3;
    TEST_ASSERT_EQUAL(AISLE_PARTIAL, run(0, 1000, &spent, &duration));
    TEST_ASSERT_EQUAL_DOUBLE(3.0, duration);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_it_comes_to_the_least_duration_within_a_thousandth);
    RUN_TEST(test_it_is_the_papers_number_of_candidates_however_it_is_cut);
    RUN_TEST(test_a_motion_that_takes_more_than_100_s_is_not_found);
    return UNITY_END();
}
