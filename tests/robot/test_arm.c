#include "robot/arm.h" // first: proves that the header stands alone

#include "arm_drawn.h"
#include "base/angle.h"
#include "unity.h"

enum { SEEDS = 300 };

static aisle_vehicle_msg msg;
static aisle_arm arm;
static aisle_refusal why;
static aisle_arm_solutions found;

void setUp(void) {
    memset(&msg, 0, sizeof msg);
    memset(&arm, 0, sizeof arm);
    why = (aisle_refusal){0, 0, 0.0F};
    msg.num_links = 3;
}
void tearDown(void) {}

// ---- the message

static void test_zeros_are_the_documented_defaults(void) {
    msg.arm_base[0] = 0.4;
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_arm_from_msg(&msg, &arm, &why));
    TEST_ASSERT_EQUAL_UINT32(3, arm.links);
    TEST_ASSERT_EQUAL_DOUBLE(0.4, arm.base.x);
    for (int i = 0; i < 3; i++) {
        TEST_ASSERT_EQUAL_DOUBLE((double)0.4F, arm.length[i]);
        TEST_ASSERT_EQUAL_DOUBLE((double)0.04F, arm.radius[i]);
        TEST_ASSERT_EQUAL_DOUBLE(2.0, arm.mass[i]);
        TEST_ASSERT_EQUAL_DOUBLE(-AISLE_PI, arm.min[i]);
        TEST_ASSERT_EQUAL_DOUBLE(AISLE_PI, arm.max[i]);
        TEST_ASSERT_EQUAL_DOUBLE(1.5, arm.v_max[i]);
        TEST_ASSERT_EQUAL_DOUBLE(3.0, arm.a_max[i]);
        TEST_ASSERT_EQUAL_DOUBLE(30.0, arm.j_max[i]);
        TEST_ASSERT_EQUAL_DOUBLE(100.0, arm.torque_max[i]);
    }
    TEST_ASSERT_EQUAL_DOUBLE(0.0, arm.gravity);
}
static void assert_refused(int32_t member) {
    aisle_arm before;
    memset(&before, 0x5A, sizeof before);
    memcpy(&arm, &before, sizeof before);
    TEST_ASSERT_EQUAL(AISLE_ERR_DATA, aisle_arm_from_msg(&msg, &arm, &why));
    TEST_ASSERT_EQUAL_MEMORY(&before, &arm, sizeof before);
    TEST_ASSERT_EQUAL_INT16(AISLE_STATUS_MALFORMED, why.cause);
    TEST_ASSERT_EQUAL_INT32(member, why.id);
}
static void test_each_member_at_fault_is_named(void) {
    float *const numbers[] = {msg.link_length, msg.link_radius, msg.link_mass,       msg.joint_v_max,
                              msg.joint_a_max, msg.joint_j_max, msg.joint_torque_max};
    static const int32_t members[] = {26, 27, 28, 31, 32, 33, 34};
    static const float bad[] = {-1.0F, 2e6F, INFINITY, NAN};
    for (int i = 0; i < 7; i++) {
        for (int k = 0; k < 4; k++) {
            numbers[i][2] = bad[k];
            assert_refused(members[i]);
            numbers[i][2] = 0.0F;
        }
    }
    msg.joint_min[1] = NAN;
    assert_refused(29);
    msg.joint_min[1] = 0.5F;
    msg.joint_max[1] = 0.5F;
    assert_refused(30);
    msg.joint_max[1] = 1.0F;
    msg.arm_base[2] = 1e9;
    assert_refused(25);
    msg.num_links = 4;
    assert_refused(24);
    msg.num_links = -1;
    assert_refused(24);
}
static void test_without_links_nothing_else_is_looked_at(void) {
    msg.num_links = 0;
    msg.arm_base[0] = (double)NAN;
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_arm_from_msg(&msg, &arm, &why));
    TEST_ASSERT_EQUAL_UINT32(0, arm.links);
}

// ---- places

static void test_places_are_sums_of_turned_links(void) {
    for (uint64_t seed = 0; seed < SEEDS; seed++) {
        aisle_rng rng = aisle_rng_seed(seed);
        const aisle_arm a = drawn_arm(&rng, aisle_rng_below(&rng, 3U) + 1U);
        const aisle_pose2 vehicle = {drawn_between(&rng, -9.0, 9.0), drawn_between(&rng, -9.0, 9.0),
                                     drawn_between(&rng, -3.0, 3.0)};
        const aisle_pose2 base = aisle_arm_base(&a, vehicle);
        double q[3];
        aisle_vec2 points[4];
        drawn_angles(&rng, a.links, 3.0, q);
        const double tip = aisle_arm_place(&a, base, q, points);
        long double t = (long double)vehicle.theta;
        long double x = (long double)vehicle.x + cosl(t) * (long double)a.base.x - sinl(t) * (long double)a.base.y;
        long double y = (long double)vehicle.y + sinl(t) * (long double)a.base.x + cosl(t) * (long double)a.base.y;
        t += (long double)a.base.theta;
        for (uint32_t i = 0; i <= a.links; i++) {
            TEST_ASSERT_DOUBLE_WITHIN(1e-13, (double)x, points[i].x);
            TEST_ASSERT_DOUBLE_WITHIN(1e-13, (double)y, points[i].y);
            if (i < a.links) {
                t += (long double)q[i];
                x += (long double)a.length[i] * cosl(t);
                y += (long double)a.length[i] * sinl(t);
            }
        }
        TEST_ASSERT_DOUBLE_WITHIN(1e-13, (double)t, tip);
    }
}
static void test_the_jacobian_is_that_of_differences(void) {
    for (uint64_t seed = 0; seed < SEEDS; seed++) {
        aisle_rng rng = aisle_rng_seed(seed);
        const aisle_arm a = drawn_arm(&rng, aisle_rng_below(&rng, 3U) + 1U);
        double q[3];
        aisle_vec2 jacobian[3], less[4], more[4];
        drawn_angles(&rng, a.links, 3.0, q);
        aisle_arm_jacobian(&a, a.base, q, jacobian);
        for (uint32_t j = 0; j < a.links; j++) {
            const double kept = q[j], h = 1e-6;
            q[j] = kept - h;
            (void)aisle_arm_place(&a, a.base, q, less);
            q[j] = kept + h;
            (void)aisle_arm_place(&a, a.base, q, more);
            q[j] = kept;
            TEST_ASSERT_DOUBLE_WITHIN(1e-8, (more[a.links].x - less[a.links].x) / (2.0 * h), jacobian[j].x);
            TEST_ASSERT_DOUBLE_WITHIN(1e-8, (more[a.links].y - less[a.links].y) / (2.0 * h), jacobian[j].y);
        }
    }
}

// ---- inverse kinematics

static bool is_among(const double *q, uint32_t links) {
    for (uint32_t k = 0; k < found.count; k++) {
        double apart = 0.0;
        for (uint32_t j = 0; j < links; j++) {
            apart = fmax(apart, fabs(found.q[k][j] - q[j]));
        }
        if (apart < 1e-6) {
            return true;
        }
    }
    return false;
}

static void assert_solved(const aisle_arm *a, aisle_vec2 tip, bool has_theta, double theta, const double *from) {
    double before = 0.0;
    for (uint32_t k = 0; k < found.count; k++) {
        aisle_vec2 points[4];
        double travel = 0.0;
        const double angle = aisle_arm_place(a, a->base, found.q[k], points);
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, 0.0, aisle_vec2_distance(points[a->links], tip));
        TEST_ASSERT_TRUE(!has_theta || fabs(aisle_angle_difference(angle, theta)) < 1e-9);
        TEST_ASSERT_EQUAL_UINT32(0, aisle_arm_joint_out(a, found.q[k], 0.0));
        for (uint32_t j = 0; j < a->links; j++) {
            travel += fabs(found.q[k][j] - from[j]);
        }
        TEST_ASSERT_TRUE(travel >= before);
        before = travel;
    }
}

static void test_every_solution_reaches_and_the_one_it_was_made_from_is_among_them(void) {
    int hits = 0;
    for (uint64_t seed = 0; seed < SEEDS; seed++) {
        aisle_rng rng = aisle_rng_seed(seed);
        const uint32_t links = aisle_rng_below(&rng, 3U) + 1U;
        const aisle_arm a = drawn_arm(&rng, links);
        double q[3], from[3];
        aisle_vec2 points[4];
        drawn_angles(&rng, links, 1.9, q);
        drawn_angles(&rng, links, 1.9, from);
        const double theta = aisle_arm_place(&a, a.base, q, points);
        const aisle_arm_target target = {
            .at = points[links], .has_theta = true, .theta = theta, .tolerance_xy = 1e-9, .tolerance_theta = 1e-6};
        aisle_arm_solve(&a, a.base, &target, from, &found);
        assert_solved(&a, points[links], true, theta, from);
        hits += is_among(q, links) ? 1 : 0;
    }
    TEST_ASSERT_EQUAL_INT(SEEDS, hits);
}
static void test_both_elbows_are_found(void) {
    arm = (aisle_arm){.links = 2, .length = {0.5, 0.5}, .min = {-3.0, -3.0}, .max = {3.0, 3.0}};
    const double from[3] = {0.0, 0.1, 0.0};
    const aisle_arm_target target = {.at = {0.6, 0.2}, .tolerance_xy = 1e-6, .tolerance_theta = 1e-6};
    aisle_arm_solve(&arm, (aisle_pose2){0.0, 0.0, 0.0}, &target, from, &found);
    TEST_ASSERT_EQUAL_UINT32(2, found.count);
    TEST_ASSERT_TRUE(found.q[0][1] * found.q[1][1] < 0.0);
}
static void test_a_place_in_any_direction_has_many_ways(void) {
    for (uint64_t seed = 0; seed < SEEDS; seed++) {
        aisle_rng rng = aisle_rng_seed(seed);
        const aisle_arm a = drawn_arm(&rng, 3U);
        double q[3];
        aisle_vec2 points[4];
        drawn_angles(&rng, 3U, 1.9, q);
        (void)aisle_arm_place(&a, a.base, q, points);
        const aisle_arm_target target = {.at = points[3], .tolerance_xy = 1e-6, .tolerance_theta = 1e-6};
        aisle_arm_solve(&a, a.base, &target, q, &found);
        assert_solved(&a, points[3], false, 0.0, q);
        TEST_ASSERT_TRUE(found.count >= 4U && is_among(q, 3U)); // it is there already
    }
}
static void test_out_of_reach_is_told_by_how_much_and_a_tolerance_reaches_further(void) {
    arm = (aisle_arm){.links = 3, .length = {0.5, 0.4, 0.3}, .min = {-3.0, -3.0, -3.0}, .max = {3.0, 3.0, 3.0}};
    const double from[3] = {0.0, 0.0, 0.0};
    aisle_arm_target target = {.at = {1.25, 0.0}, .tolerance_xy = 0.01, .tolerance_theta = 0.01};
    aisle_arm_solve(&arm, (aisle_pose2){0.0, 0.0, 0.0}, &target, from, &found);
    TEST_ASSERT_EQUAL_UINT32(0, found.count);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0.05, found.miss);
    target.tolerance_xy = 0.051;
    aisle_arm_solve(&arm, (aisle_pose2){0.0, 0.0, 0.0}, &target, from, &found);
    TEST_ASSERT_TRUE(found.count >= 1U);
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, 0.0, found.q[0][1]);
}
static void test_joint_limits_in_the_way_are_named(void) {
    arm = (aisle_arm){.links = 1, .length = {0.5}, .min = {-1.0}, .max = {1.0}};
    const double from[3] = {0.0, 0.0, 0.0};
    const aisle_arm_target target = {.at = {-0.5, 0.0}, .tolerance_xy = 0.01, .tolerance_theta = 0.01};
    aisle_arm_solve(&arm, (aisle_pose2){0.0, 0.0, 0.0}, &target, from, &found);
    TEST_ASSERT_EQUAL_UINT32(0, found.count);
    TEST_ASSERT_EQUAL_DOUBLE(0.0, found.miss);
    TEST_ASSERT_EQUAL_UINT32(1, found.joint);
}
static void test_a_joint_with_more_than_a_turn_takes_the_nearest(void) {
    arm = (aisle_arm){.links = 1, .length = {0.5}, .min = {-9.0}, .max = {9.0}};
    const double from[3] = {6.0, 0.0, 0.0};
    const aisle_arm_target target = {.at = {0.5, 0.0}, .tolerance_xy = 0.01, .tolerance_theta = 0.01};
    aisle_arm_solve(&arm, (aisle_pose2){0.0, 0.0, 0.0}, &target, from, &found);
    TEST_ASSERT_EQUAL_UINT32(2, found.count);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 2.0 * AISLE_PI, found.q[0][0]);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0.0, found.q[1][0]);
}
static void test_stowed_is_zero_or_the_limit_next_to_it(void) {
    arm = (aisle_arm){.links = 3, .min = {-1.0, 0.5, -2.0}, .max = {1.0, 1.0, -0.25}};
    double q[3];
    aisle_arm_stow(&arm, q);
    TEST_ASSERT_EQUAL_DOUBLE(0.0, q[0]);
    TEST_ASSERT_EQUAL_DOUBLE(0.5, q[1]);
    TEST_ASSERT_EQUAL_DOUBLE(-0.25, q[2]);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_zeros_are_the_documented_defaults);
    RUN_TEST(test_each_member_at_fault_is_named);
    RUN_TEST(test_without_links_nothing_else_is_looked_at);
    RUN_TEST(test_places_are_sums_of_turned_links);
    RUN_TEST(test_the_jacobian_is_that_of_differences);
    RUN_TEST(test_every_solution_reaches_and_the_one_it_was_made_from_is_among_them);
    RUN_TEST(test_both_elbows_are_found);
    RUN_TEST(test_a_place_in_any_direction_has_many_ways);
    RUN_TEST(test_out_of_reach_is_told_by_how_much_and_a_tolerance_reaches_further);
    RUN_TEST(test_joint_limits_in_the_way_are_named);
    RUN_TEST(test_a_joint_with_more_than_a_turn_takes_the_nearest);
    RUN_TEST(test_stowed_is_zero_or_the_limit_next_to_it);
    return UNITY_END();
}
