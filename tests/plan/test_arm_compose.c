#include "plan/arm_compose.h" // first: proves that the header stands alone

#include "../robot/arm_drawn.h"
#include "arm_hall.h"

enum { SEEDS = 30, FINE = 400 };

static aisle_arm_plan plan;
static aisle_arm_path_msg path;
static aisle_arm_dynamics dynamics;
static const double start[3] = {0.1, 0.2, 0.3};

void setUp(void) {
    arm_hall_begin();
    hall_add(6.1, 5.1, 6.3, 5.3);
    (void)arm_hall_open(64U);
    aisle_arm_dynamics_begin(&dynamics, &arm, world.base.theta);
}
void tearDown(void) {}

// So many pieces one after the other; each other one without a bend.
static void draw_plan(uint64_t seed, uint32_t count) {
    aisle_rng rng = aisle_rng_seed(seed);
    double q[2][3], bend[6];
    arm_draw(&rng, q[0]);
    plan.count = count;
    for (uint32_t k = 0; k < count; k++) {
        arm_draw(&rng, q[1]);
        for (int i = 0; i < 6; i++) {
            bend[i] = uniform(&rng, -30.0, 30.0);
        }
        aisle_arm_piece_of(3U, q[0], q[1], k % 2U == 0U ? bend : NULL, &plan.piece[k]);
        memcpy(q[0], q[1], sizeof q[0]);
    }
}

static long double piece_value(const aisle_arm_piece *piece, int joint, long double r) {
    long double value = 0.0L;
    for (int i = 7; i >= 0; i--) {
        value = value * r + (long double)piece->c[joint][i];
    }
    return value;
}

// The quintic between two waypoints as the message has it: by Hermite's conditions, solved in the basis of both ends.
static long double quintic(const aisle_arm_waypoint_msg *a, const aisle_arm_waypoint_msg *b, int j, long double t) {
    const long double h = (long double)b->t - (long double)a->t, u = (t - (long double)a->t) / h, w = 1.0L - u;
    const long double from = (long double)a->q[j] * w * w * w * (1.0L + 3.0L * u + 6.0L * u * u) +
                             h * (long double)a->qd[j] * w * w * w * u * (1.0L + 3.0L * u) +
                             0.5L * h * h * (long double)a->qdd[j] * w * w * w * u * u;
    const long double to = (long double)b->q[j] * u * u * u * (1.0L + 3.0L * w + 6.0L * w * w) -
                           h * (long double)b->qd[j] * u * u * u * w * (1.0L + 3.0L * w) +
                           0.5L * h * h * (long double)b->qdd[j] * u * u * u * w * w;
    return from + to;
}

static void test_the_quintics_between_waypoints_follow_the_pieces(void) {
    uint32_t joint;
    for (uint64_t seed = 0; seed < SEEDS; seed++) {
        draw_plan(seed, 3U);
        TEST_ASSERT_TRUE(aisle_arm_plan_time(&plan, &arm, &dynamics, &joint));
        const double stretch = seed % 2U == 0U ? 1.0 : 1.01;
        TEST_ASSERT_EQUAL(AISLE_OK, aisle_arm_compose(&plan, &world, &dynamics, start, stretch, &path));
        const uint32_t steps[3] = {AISLE_ARM_STEPS, AISLE_ARM_STEPS_STRAIGHT, AISLE_ARM_STEPS};
        int first = 0;
        for (int k = 0; k < 3; k++) {
            const int last = first + (int)steps[k];
            const long double from = (long double)path.waypoints[first].t, to = (long double)path.waypoints[last].t;
            const double took = (double)(to - from), least = plan.duration[k] * stretch;
            TEST_ASSERT_TRUE(took >= least - 1e-6 && took <= least + 3e-6); // times are floats
            for (int i = 0; i < FINE; i++) {
                const long double t = from + (to - from) * i / FINE;
                int w = first;
                while (w + 1 < last && (long double)path.waypoints[w + 1].t <= t) {
                    w++;
                }
                for (int j = 0; j < 3; j++) {
                    const long double want = piece_value(&plan.piece[k], j, (t - from) / (to - from));
                    TEST_ASSERT_DOUBLE_WITHIN(1e-6, (double)want,
                                              (double)quintic(&path.waypoints[w], &path.waypoints[w + 1], j, t));
                }
            }
            first = last;
        }
        TEST_ASSERT_EQUAL_INT16(first + 1, path.num_waypoints);
    }
}
static void test_waypoints_tell_rest_torque_and_clearance(void) {
    uint32_t joint;
    for (uint64_t seed = 0; seed < SEEDS; seed++) {
        draw_plan(seed, 2U);
        TEST_ASSERT_TRUE(aisle_arm_plan_time(&plan, &arm, &dynamics, &joint));
        TEST_ASSERT_EQUAL(AISLE_OK, aisle_arm_compose(&plan, &world, &dynamics, start, 1.0, &path));
        double least = INFINITY;
        for (int i = 0; i < path.num_waypoints; i++) {
            const aisle_arm_waypoint_msg *w = &path.waypoints[i];
            double q[3], v[3], a[3], moves = 0.0;
            long double torque[3];
            for (int j = 0; j < 3; j++) {
                q[j] = (double)w->q[j];
                v[j] = (double)w->qd[j];
                a[j] = (double)w->qdd[j];
                moves += fabs(v[j]) + fabs(a[j]);
            }
            drawn_torques(&arm, world.base.theta, q, v, a, torque);
            for (int j = 0; j < 3; j++) {
                TEST_ASSERT_DOUBLE_WITHIN(1e-4, (double)torque[j], (double)w->torque[j]);
            }
            const bool is_end = i == 0 || i == (int)AISLE_ARM_STEPS || i == path.num_waypoints - 1;
            TEST_ASSERT_EQUAL(is_end, !(moves > 0.0)); // exactly
            const double gap = fmin(arm_judged(q), AISLE_ARM_SIGHT);
            TEST_ASSERT_TRUE((double)w->clearance <= gap + 1e-8 && (double)w->clearance >= gap - 1e-6);
            least = fmin(least, (double)w->clearance);
            TEST_ASSERT_TRUE(i == 0 ? !(w->t > 0.0F) : w->t > path.waypoints[i - 1].t);
        }
        TEST_ASSERT_EQUAL_DOUBLE(least, (double)path.clearance_min);
        TEST_ASSERT_EQUAL_FLOAT(path.waypoints[path.num_waypoints - 1].t, path.duration);
    }
}
static void test_travel_is_the_angle_that_joints_turn_by(void) {
    uint32_t joint;
    for (uint64_t seed = 0; seed < SEEDS; seed++) {
        long double sum = 0.0L;
        draw_plan(seed, 2U);
        TEST_ASSERT_TRUE(aisle_arm_plan_time(&plan, &arm, &dynamics, &joint));
        TEST_ASSERT_EQUAL(AISLE_OK, aisle_arm_compose(&plan, &world, &dynamics, start, 1.0, &path));
        for (int k = 0; k < 2; k++) {
            for (int j = 0; j < 3; j++) {
                for (int i = 0; i < 10 * FINE; i++) {
                    sum += fabsl(piece_value(&plan.piece[k], j, (i + 1.0L) / (10.0L * FINE)) -
                                 piece_value(&plan.piece[k], j, i / (10.0L * FINE)));
                }
            }
        }
        TEST_ASSERT_DOUBLE_WITHIN(1e-4, (double)sum, (double)path.travel);
    }
}
static void test_an_arm_that_is_there_has_one_waypoint(void) {
    plan.count = 0;
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_arm_compose(&plan, &world, &dynamics, start, 1.0, &path));
    TEST_ASSERT_EQUAL_INT16(1, path.num_waypoints);
    for (int j = 0; j < 3; j++) {
        TEST_ASSERT_EQUAL_FLOAT((float)start[j], path.waypoints[0].q[j]);
        TEST_ASSERT_EQUAL_FLOAT(0.0F, path.waypoints[0].qd[j]);
    }
    TEST_ASSERT_EQUAL_FLOAT(0.0F, path.duration);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, path.travel);
}
static void test_more_waypoints_than_the_message_holds_are_told(void) {
    uint32_t joint;
    draw_plan(0, 26U); // 13 * (32 + 8) + 1
    TEST_ASSERT_TRUE(aisle_arm_plan_time(&plan, &arm, &dynamics, &joint));
    TEST_ASSERT_EQUAL(AISLE_ERR_CAPACITY, aisle_arm_compose(&plan, &world, &dynamics, start, 1.0, &path));
    plan.count = 25U; // 8 less
    TEST_ASSERT_EQUAL(AISLE_ERR_CAPACITY, aisle_arm_compose(&plan, &world, &dynamics, start, 1.0, &path));
    plan.count = 24U;
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_arm_compose(&plan, &world, &dynamics, start, 1.0, &path));
    TEST_ASSERT_EQUAL_INT16(481, path.num_waypoints);
}
static void test_a_motor_that_does_not_hold_the_arm_is_told(void) {
    uint32_t joint = 9;
    draw_plan(0, 2U);
    arm.gravity = 9.81;
    arm.torque_max[1] = 0.1;
    aisle_arm_dynamics_begin(&dynamics, &arm, world.base.theta);
    TEST_ASSERT_FALSE(aisle_arm_plan_time(&plan, &arm, &dynamics, &joint));
    TEST_ASSERT_EQUAL_UINT32(1, joint);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_the_quintics_between_waypoints_follow_the_pieces);
    RUN_TEST(test_waypoints_tell_rest_torque_and_clearance);
    RUN_TEST(test_travel_is_the_angle_that_joints_turn_by);
    RUN_TEST(test_an_arm_that_is_there_has_one_waypoint);
    RUN_TEST(test_more_waypoints_than_the_message_holds_are_told);
    RUN_TEST(test_a_motor_that_does_not_hold_the_arm_is_told);
    return UNITY_END();
}
