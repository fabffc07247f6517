#include "plan/arm_world.h" // first: proves that the header stands alone

#include "arm_hall.h"

enum { SEEDS = 200 };

void setUp(void) {
    arm_hall_begin();
}
void tearDown(void) {}

static void test_gaps_are_the_judges(void) {
    int in_contact = 0;
    hall_add(6.1, 5.1, 6.3, 5.3);
    hall_add(5.9, 4.4, 6.2, 4.6);
    (void)arm_hall_open(64U);
    TEST_ASSERT_DOUBLE_WITHIN(1e-7, 0.06, world.exempt); // the base lies on the rim
    for (uint64_t seed = 0; seed < SEEDS; seed++) {
        aisle_rng rng = aisle_rng_seed(seed);
        double q[3], gaps[3];
        int32_t id;
        arm_draw(&rng, q);
        const double gap = aisle_arm_world_gap(&world, q, 0.3, gaps, &id), want = fmin(arm_judged(q), 0.3);
        TEST_ASSERT_DOUBLE_WITHIN(1e-8, want, gap);
        TEST_ASSERT_EQUAL_DOUBLE(gap, fmin(gaps[0], fmin(gaps[1], gaps[2])));
        TEST_ASSERT_EQUAL(gap < 0.3, id != 0);
        TEST_ASSERT_EQUAL(gap<AISLE_ARM_KEEP, aisle_arm_world_depth(&world, q)> 0.0);
        in_contact += gap > 0.0 ? 0 : 1;
    }
    TEST_ASSERT_TRUE(in_contact > 20 && in_contact < 180);
}
static void test_depth_falls_steadily_on_the_way_out(void) {
    hall_add(6.1, 4.9, 6.5, 5.1);
    (void)arm_hall_open(64U);
    double before = INFINITY;
    for (int i = 0; i <= 50; i++) { // the stretched arm turns out of the box
        const double q[3] = {0.02 * i, 0.0, 0.0}, depth = aisle_arm_world_depth(&world, q);
        TEST_ASSERT_TRUE(depth <= before + 5e-3); // aslant the way through it is a little longer
        before = depth;
    }
    TEST_ASSERT_EQUAL_DOUBLE(0.0, before);
}
static void test_ids_of_body_arm_and_bounds_are_told(void) {
    int32_t id;
    arm_hall_begin();
    hall_begin(10.0, 5.5);
    (void)arm_hall_open(64U);
    const double back[3] = {1.0, 2.8, 0.0}, folded[3] = {0.0, 2.75, 2.3}, up[3] = {1.0, 0.0, 0.0};
    (void)aisle_arm_world_gap(&world, back, 0.3, NULL, &id);
    TEST_ASSERT_EQUAL_INT32(AISLE_ARM_ID_BODY, id);
    (void)aisle_arm_world_gap(&world, folded, 0.3, NULL, &id);
    TEST_ASSERT_EQUAL_INT32(AISLE_ARM_ID_ARM, id);
    (void)aisle_arm_world_gap(&world, up, 0.3, NULL, &id);
    TEST_ASSERT_EQUAL_INT32(AISLE_LAYOUT_ID_BOUNDS, id);
}
static void test_more_obstacles_than_fit_are_told(void) {
    hall_add(6.1, 4.9, 6.5, 5.1);
    hall_add(6.1, 5.2, 6.5, 5.3);
    aisle_arena arena = arm_hall_open(64U);
    aisle_arm_world_carve(&world, &arena, 1U);
    TEST_ASSERT_EQUAL(AISLE_ERR_CAPACITY, aisle_arm_world_begin(&world, &hall_layout, &arm_vehicle, &arm, arm_pose));
}
static void test_half_of_keep_is_reserve_for_motions_alone(void) {
    static const double q[3] = {0.0, 0.0, 0.0};
    for (int i = 0; i < 2; i++) { // a box above the last link, 0.9 and 1.1 of keep away
        const aisle_arm_pace still = {.slope = {0.0}, .bend = {0.0}};
        const double keep = (i == 0 ? 0.9 : 1.1) * AISLE_ARM_KEEP, y = 5.0 + (double)0.03F + keep;
        double h = 1.0;
        arm_hall_begin();
        hall_add(6.45, y, 6.6, y + 0.2);
        (void)arm_hall_open(64U);
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, keep, aisle_arm_world_gap(&world, q, 0.3, NULL, NULL));
        TEST_ASSERT_EQUAL(i == 1, aisle_arm_world_room(&world, q, &still, &h));
        TEST_ASSERT_EQUAL_DOUBLE(1.0, h);
        TEST_ASSERT_EQUAL(i == 0, aisle_arm_world_depth(&world, q) > 0.0);
    }
}
static void test_room_about_a_configuration_is_what_the_gap_leaves(void) {
    hall_add(6.1, 5.1, 6.3, 5.3);
    (void)arm_hall_open(64U);
    int asked = 0;
    for (uint64_t seed = 0; seed < SEEDS; seed++) {
        aisle_rng rng = aisle_rng_seed(seed);
        aisle_arm_pace pace;
        double q[3], gaps[3], want = uniform(&rng, 0.01, 1.0), h = want;
        for (int i = 0; i < 4; i++) {
            pace.slope[i] = uniform(&rng, 0.0, 1.0);
            pace.bend[i] = uniform(&rng, 0.0, 1.0);
        }
        pace.slope[3] = pace.slope[2]; // so that one gap of the last link counts for both
        pace.bend[3] = pace.bend[2];
        arm_draw(&rng, q);
        const bool is_free = aisle_arm_world_gap(&world, q, 5.0, gaps, NULL) >= AISLE_ARM_KEEP;
        TEST_ASSERT_EQUAL(is_free, aisle_arm_world_room(&world, q, &pace, &h));
        for (int i = 0; is_free && i < 3; i++) { // the root of slope h + bend h^2 = gap - half of keep
            const double room = gaps[i] - 0.5 * AISLE_ARM_KEEP, s = pace.slope[i], c = pace.bend[i];
            want = fmin(want, (sqrt(s * s + 4.0 * c * room) - s) / (2.0 * c));
        }
        TEST_ASSERT_TRUE(!is_free || fabs(want - h) < 1e-9);
        asked += is_free ? 1 : 0;
    }
    TEST_ASSERT_GREATER_THAN_INT(20, asked);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_gaps_are_the_judges);
    RUN_TEST(test_depth_falls_steadily_on_the_way_out);
    RUN_TEST(test_ids_of_body_arm_and_bounds_are_told);
    RUN_TEST(test_more_obstacles_than_fit_are_told);
    RUN_TEST(test_half_of_keep_is_reserve_for_motions_alone);
    RUN_TEST(test_room_about_a_configuration_is_what_the_gap_leaves);
    return UNITY_END();
}
