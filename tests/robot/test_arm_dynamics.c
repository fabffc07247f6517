#include "robot/arm_dynamics.h" // first: proves that the header stands alone

#include "arm_drawn.h"
#include "unity.h"

enum { SEEDS = 300 };

void setUp(void) {}
void tearDown(void) {}

static void test_torques_are_those_of_newton_and_euler(void) {
    for (uint64_t seed = 0; seed < SEEDS; seed++) {
        aisle_rng rng = aisle_rng_seed(seed);
        aisle_arm arm = drawn_arm(&rng, aisle_rng_below(&rng, 3U) + 1U);
        arm.gravity = seed % 2U == 0U ? 9.81 : 0.0;
        double q[3], qd[3], qdd[3], inertia[3], gravity[3];
        long double exact[3];
        aisle_arm_dynamics dynamics;
        const double theta = drawn_between(&rng, -3.0, 3.0);
        drawn_angles(&rng, arm.links, 3.0, q);
        drawn_angles(&rng, arm.links, 4.0, qd);
        drawn_angles(&rng, arm.links, 20.0, qdd);
        aisle_arm_dynamics_begin(&dynamics, &arm, theta);
        aisle_arm_torque(&dynamics, q, qd, qdd, inertia, gravity);
        drawn_torques(&arm, theta, q, qd, qdd, exact);
        for (uint32_t i = 0; i < arm.links; i++) {
            TEST_ASSERT_DOUBLE_WITHIN(1e-11, (double)exact[i], inertia[i] + gravity[i]);
        }
    }
}
static void test_time_scales_the_torque_beside_gravity_by_its_square(void) {
    aisle_rng rng = aisle_rng_seed(5);
    const aisle_arm arm = drawn_arm(&rng, 3U);
    double q[3], qd[3], qdd[3], slow[3], fast[3];
    aisle_arm_dynamics dynamics;
    aisle_arm_dynamics_begin(&dynamics, &arm, 0.3);
    drawn_angles(&rng, 3U, 3.0, q);
    drawn_angles(&rng, 3U, 2.0, qd);
    drawn_angles(&rng, 3U, 2.0, qdd);
    aisle_arm_torque(&dynamics, q, qd, qdd, slow, NULL);
    for (int i = 0; i < 3; i++) {
        qd[i] *= 3.0;
        qdd[i] *= 9.0;
    }
    aisle_arm_torque(&dynamics, q, qd, qdd, fast, NULL);
    for (int i = 0; i < 3; i++) {
        TEST_ASSERT_DOUBLE_WITHIN(1e-10, 9.0 * slow[i], fast[i]);
    }
}

// q(t) of a motion that never stops, and its derivatives.
static void swing(double t, double *q, double *qd, double *qdd) {
    for (int i = 0; i < 3; i++) {
        const double w = 1.0 + 0.7 * (double)i;
        q[i] = sin(w * t + (double)i);
        qd[i] = w * cos(w * t + (double)i);
        qdd[i] = -w * w * sin(w * t + (double)i);
    }
}
static void test_the_motors_work_is_the_energy_gained(void) {
    for (uint64_t seed = 0; seed < 20; seed++) {
        aisle_rng rng = aisle_rng_seed(seed);
        aisle_arm arm = drawn_arm(&rng, 3U);
        arm.gravity = 9.81;
        aisle_arm_dynamics dynamics;
        aisle_arm_dynamics_begin(&dynamics, &arm, 0.4);
        double q[3], qd[3], qdd[3], inertia[3], gravity[3], work = 0.0;
        enum { STEPS = 2000 };
        const double end = 2.0;
        swing(0.0, q, qd, qdd);
        const double before = aisle_arm_kinetic(&dynamics, q, qd) + aisle_arm_potential(&dynamics, q);
        for (int i = 0; i <= STEPS; i++) { // Simpson's rule
            const double weight = i == 0 || i == STEPS ? 1.0 : i % 2 == 1 ? 4.0 : 2.0;
            swing(end * i / STEPS, q, qd, qdd);
            aisle_arm_torque(&dynamics, q, qd, qdd, inertia, gravity);
            for (int j = 0; j < 3; j++) {
                work += weight * (inertia[j] + gravity[j]) * qd[j] * end / (3.0 * STEPS);
            }
        }
        const double after = aisle_arm_kinetic(&dynamics, q, qd) + aisle_arm_potential(&dynamics, q);
        TEST_ASSERT_DOUBLE_WITHIN(1e-8 * (1.0 + fabs(after)), after - before, work);
    }
}
static void test_one_rod_is_the_textbooks(void) {
    const aisle_arm arm = {.links = 1, .length = {2.0}, .radius = {0.2}, .mass = {3.0}, .gravity = 10.0};
    const double q[1] = {0.0}, qd[1] = {5.0}, qdd[1] = {2.0};
    double inertia[1], gravity[1];
    aisle_arm_dynamics dynamics;
    aisle_arm_dynamics_begin(&dynamics, &arm, 0.0);
    aisle_arm_torque(&dynamics, q, qd, qdd, inertia, gravity);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, (3.0 * 4.0 / 3.0 + 3.0 * 0.01) * 2.0, inertia[0]); // m l2 / 3 and m r2 / 4
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 3.0 * 10.0 * 1.0, gravity[0]);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_torques_are_those_of_newton_and_euler);
    RUN_TEST(test_time_scales_the_torque_beside_gravity_by_its_square);
    RUN_TEST(test_the_motors_work_is_the_energy_gained);
    RUN_TEST(test_one_rod_is_the_textbooks);
    return UNITY_END();
}
