#include "sim/outline.h" // first: proves that the header stands alone

#include "base/rng.h"
#include "unity.h"

#define PI 3.14159265358979323846

void setUp(void) {}
void tearDown(void) {}

static void test_discs_are_apart_by_their_centres_less_radii(void) {
    aisle_sim_outline a = aisle_sim_disc(aisle_vec2_of(0.0, 0.0), 1.0),
                      b = aisle_sim_disc(aisle_vec2_of(3.0, 4.0), 1.5);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 2.5, aisle_sim_gap(&a, &b));
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 4.0, aisle_sim_gap_to(&a, aisle_vec2_of(0.0, -5.0)));
}

static void test_boxes_side_by_side_corner_to_corner_and_crossed(void) {
    aisle_sim_outline a = aisle_sim_box(0.0, 0.0, 2.0, 1.0), beside = aisle_sim_box(2.25, -3.0, 4.0, 5.0);
    aisle_sim_outline corner = aisle_sim_box(5.0, 5.0, 6.0, 6.0), cross = aisle_sim_box(0.9, -3.0, 1.1, 4.0);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0.25, aisle_sim_gap(&a, &beside));
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 5.0, aisle_sim_gap(&a, &corner));
    TEST_ASSERT_EQUAL_DOUBLE(0.0, aisle_sim_gap(&a, &cross)); // no corner of one is inside the other
    TEST_ASSERT_EQUAL_DOUBLE(0.0, aisle_sim_gap(&cross, &a));
}

static void test_a_body_inside_another_touches_it(void) {
    aisle_sim_outline a = aisle_sim_box(-5.0, -5.0, 5.0, 5.0), inner = aisle_sim_box(-1.0, -1.0, 1.0, 1.0);
    aisle_sim_outline dot = aisle_sim_disc(aisle_vec2_of(1.0, 2.0), 0.1);
    TEST_ASSERT_EQUAL_DOUBLE(0.0, aisle_sim_gap(&a, &inner));
    TEST_ASSERT_EQUAL_DOUBLE(0.0, aisle_sim_gap(&inner, &a));
    TEST_ASSERT_EQUAL_DOUBLE(0.0, aisle_sim_gap(&dot, &a));
    TEST_ASSERT_EQUAL_DOUBLE(0.0, aisle_sim_gap_to(&a, aisle_vec2_of(4.9, -4.9)));
}

static void test_placing_turns_about_the_origin_then_moves(void) {
    aisle_sim_outline body = aisle_sim_box(1.0, 0.0, 2.0, 0.5);
    aisle_sim_outline at = aisle_sim_outline_at(&body, (aisle_pose2){10.0, 20.0, 0.5 * PI});
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 10.0, at.v[0].x); // (1, 0) -> (0, 1)
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 21.0, at.v[0].y);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 9.5, at.v[2].x); // (2, 0.5) -> (-0.5, 2)
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 22.0, at.v[2].y);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, sqrt(4.25), aisle_sim_outline_reach(&body));
}

// Points sampled all over both boxes: never nearer than the gap, and near it somewhere.
static double sampled_gap(const aisle_sim_outline *a, const aisle_sim_outline *b) {
    double least = 1e9;
    for (int i = 0; i <= 40; i++) {
        for (int side = 0; side < 4; side++) {
            aisle_vec2 p = aisle_vec2_lerp(a->v[side], a->v[(side + 1) % 4], i / 40.0);
            least = fmin(least, aisle_sim_gap_to(b, p));
            aisle_vec2 q = aisle_vec2_lerp(b->v[side], b->v[(side + 1) % 4], i / 40.0);
            least = fmin(least, aisle_sim_gap_to(a, q));
        }
    }
    return least;
}

static void test_gap_is_that_of_sampled_outlines_for_200_of_200_seeds(void) {
    for (uint64_t seed = 0; seed < 200; seed++) {
        aisle_rng rng = aisle_rng_seed(seed);
        aisle_sim_outline box = aisle_sim_box(-0.6, -0.4, 0.6, 0.4), placed[2];
        for (int i = 0; i < 2; i++) {
            double x = 3.0 * (double)aisle_rng_float(&rng), y = 3.0 * (double)aisle_rng_float(&rng);
            placed[i] = aisle_sim_outline_at(&box, (aisle_pose2){x, y, 2.0 * PI * (double)aisle_rng_float(&rng)});
        }
        double gap = aisle_sim_gap(&placed[0], &placed[1]), sampled = sampled_gap(&placed[0], &placed[1]);
        TEST_ASSERT_TRUE(gap <= sampled + 1e-12);
        TEST_ASSERT_DOUBLE_WITHIN(0.02, sampled, gap);
        TEST_ASSERT_EQUAL_DOUBLE(gap, aisle_sim_gap(&placed[1], &placed[0]));
    }
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_discs_are_apart_by_their_centres_less_radii);
    RUN_TEST(test_boxes_side_by_side_corner_to_corner_and_crossed);
    RUN_TEST(test_a_body_inside_another_touches_it);
    RUN_TEST(test_placing_turns_about_the_origin_then_moves);
    RUN_TEST(test_gap_is_that_of_sampled_outlines_for_200_of_200_seeds);
    return UNITY_END();
}
