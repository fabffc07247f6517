#include "plan/objective.h"

#include "unity.h"

#include <math.h>

static aisle_vehicle vehicle;
static aisle_options_msg options;
static aisle_objective objective;

void setUp(void) {
    vehicle = (aisle_vehicle){.v_max = 1.5,
                              .omega_max = 1.0,
                              .lateral_a_max = 0.5,
                              .creep_clearance = 0.5,
                              .creep_speed = 0.3,
                              .mass = 500.0,
                              .rolling_resistance = 0.015,
                              .idle_power = 50.0,
                              .drive_efficiency = 0.8};
    options = (aisle_options_msg){0};
}
void tearDown(void) {}

static double density(int8_t kind, double clearance, double curvature) {
    options.objective = kind;
    TEST_ASSERT_TRUE(aisle_objective_of(&options, &vehicle, &objective));
    return aisle_objective_density(&objective, clearance, curvature);
}

static void test_shortest_costs_one_everywhere(void) {
    TEST_ASSERT_DOUBLE_WITHIN(0.0, 1.0, density(AISLE_OPTIONS_SHORTEST, 0.0, 30.0));
    TEST_ASSERT_TRUE(aisle_objective_is_length(&objective));
}

static void test_safest_falls_linearly_to_one_at_the_creep_clearance(void) {
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 16.0, density(AISLE_OPTIONS_SAFEST, 0.0, 0.0));
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 8.5, density(AISLE_OPTIONS_SAFEST, 0.25, 0.0));
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 1.0, density(AISLE_OPTIONS_SAFEST, 0.5, 0.0));
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 1.0, density(AISLE_OPTIONS_SAFEST, 7.0, 0.0));
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 16.0, density(AISLE_OPTIONS_SAFEST, -1.0, 0.0));
    TEST_ASSERT_FALSE(aisle_objective_is_length(&objective));
}

static void test_the_risk_weight_is_the_callers_up_to_the_ceiling(void) {
    options.risk_weight = 3.0F;
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 4.0, density(AISLE_OPTIONS_SAFEST, 0.0, 0.0));
    options.risk_weight = 1000.0F;
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, AISLE_OBJECTIVE_DENSITY_MAX, density(AISLE_OPTIONS_SAFEST, 0.0, 0.0));
}

static void test_fastest_is_the_ratio_of_speeds(void) {
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 1.0, density(AISLE_OPTIONS_FASTEST, 1.0, 0.0));
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 5.0, density(AISLE_OPTIONS_FASTEST, 0.2, 0.0));  // 1.5 / 0.3
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 3.0, density(AISLE_OPTIONS_FASTEST, 1.0, -2.0)); // lateral 0.5, turn rate 0.5
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 1.5 / sqrt(0.5), density(AISLE_OPTIONS_FASTEST, 1.0, 1.0)); // lateral binds
}

static void test_least_energy_is_rolling_plus_idle_over_speed(void) {
    double rolling = 500.0 * 9.81 * 0.015 / 0.8;
    double expected = (rolling + 50.0 / 0.3) / (rolling + 50.0 / 1.5);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, expected, density(AISLE_OPTIONS_LEAST_ENERGY, 0.2, 0.0));
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 1.0, density(AISLE_OPTIONS_LEAST_ENERGY, 1.0, 0.0));
}

static void test_every_density_lies_between_one_and_the_ceiling(void) {
    for (int8_t kind = AISLE_OPTIONS_SAFEST; kind <= AISLE_OPTIONS_LEAST_ENERGY; kind++) {
        for (int c = -5; c < 30; c++) {
            for (int k = -20; k <= 20; k++) {
                double d = density(kind, 0.1 * c, (double)(k * k * k) / 8.0);
                TEST_ASSERT_TRUE(d >= 1.0 && d <= AISLE_OBJECTIVE_DENSITY_MAX);
            }
        }
    }
}

static void test_a_vehicle_without_losses_or_creep_is_still_finite(void) {
    vehicle.rolling_resistance = 0.0;
    vehicle.idle_power = 0.0;
    vehicle.creep_clearance = 0.0;
    TEST_ASSERT_DOUBLE_WITHIN(0.0, 1.0, density(AISLE_OPTIONS_LEAST_ENERGY, 0.0, 0.0));
    TEST_ASSERT_DOUBLE_WITHIN(0.0, 1.0, density(AISLE_OPTIONS_SAFEST, 0.0, 0.0));
}

static void test_unknown_objectives_are_refused(void) {
    const int8_t kinds[] = {-1, AISLE_OPTIONS_PAPER, 5, 127, -128};
    for (unsigned i = 0; i < sizeof kinds; i++) {
        options.objective = kinds[i];
        TEST_ASSERT_FALSE(aisle_objective_of(&options, &vehicle, &objective));
    }
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_shortest_costs_one_everywhere);
    RUN_TEST(test_safest_falls_linearly_to_one_at_the_creep_clearance);
    RUN_TEST(test_the_risk_weight_is_the_callers_up_to_the_ceiling);
    RUN_TEST(test_fastest_is_the_ratio_of_speeds);
    RUN_TEST(test_least_energy_is_rolling_plus_idle_over_speed);
    RUN_TEST(test_every_density_lies_between_one_and_the_ceiling);
    RUN_TEST(test_a_vehicle_without_losses_or_creep_is_still_finite);
    RUN_TEST(test_unknown_objectives_are_refused);
    return UNITY_END();
}
