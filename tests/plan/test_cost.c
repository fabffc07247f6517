#include "plan/cost.h"

#include "hall.h"

static aisle_space space;
static aisle_objective objective;
static uint32_t units;

static void open_hall(float resolution) {
    aisle_arena arena = hall_arena(24U << 20);
    memset(&space, 0, sizeof space);
    aisle_space_carve(&space, &arena, hall_limits.cells);
    hall_open(&arena, resolution);
    aisle_space_begin(&space, &hall_layout, &hall_vehicle, AISLE_SPACE_FREE_TURN);
    units = 0;
}

void setUp(void) {
    hall_disc(0.3, 0.1F);
    hall_begin(12.0, 9.0);
    hall_add(3.0, 2.0, 5.0, 4.0);
    hall_add(6.0, 4.6, 9.0, 7.0);
    open_hall(0.05F);
}
void tearDown(void) {}

static double cost(int8_t kind, aisle_vec2 a, aisle_vec2 b) {
    aisle_options_msg options = {.objective = kind};
    TEST_ASSERT_TRUE(aisle_objective_of(&options, &hall_vehicle, &objective));
    return aisle_leg_cost(&space, &objective, a, b, &units);
}

static void test_shortest_is_the_plain_length_and_costs_no_units(void) {
    TEST_ASSERT_DOUBLE_WITHIN(1e-15, 5.0,
                              cost(AISLE_OPTIONS_SHORTEST, aisle_vec2_of(1.0, 1.0), aisle_vec2_of(4.0, 5.0)));
    TEST_ASSERT_EQUAL_UINT32(0, units);
}

static void test_a_leg_of_no_length_costs_nothing(void) {
    for (int8_t kind = 0; kind < 4; kind++) {
        TEST_ASSERT_DOUBLE_WITHIN(0.0, 0.0, cost(kind, aisle_vec2_of(1.0, 1.0), aisle_vec2_of(1.0, 1.0)));
    }
}

// The same integral from the boxes themselves, every millimetre.
static double integral(aisle_vec2 a, aisle_vec2 b) {
    int steps = (int)(aisle_vec2_distance(a, b) * 1000.0);
    double sum = 0.0;
    for (int i = 0; i < steps; i++) {
        aisle_vec2 p = aisle_vec2_lerp(a, b, (i + 0.5) / steps);
        sum += aisle_objective_density(&objective, (double)hall_disc_gap(p.x, p.y, hall_vehicle.inner_radius), 0.0);
    }
    return sum * aisle_vec2_distance(a, b) / steps;
}

static void test_the_others_integrate_their_density_over_the_clearance(void) {
    static const aisle_vec2 legs[][2] = {{{1.0, 1.0}, {11.0, 1.0}},
                                         {{5.4, 1.0}, {5.4, 8.0}},
                                         {{2.5, 4.35}, {11.0, 4.1}},
                                         {{1.0, 8.0}, {11.0, 8.5}},
                                         {{5.5, 3.0}, {5.8, 3.3}}};
    open_hall(0.02F);
    for (size_t i = 0; i < sizeof legs / sizeof legs[0]; i++) {
        double length = aisle_vec2_distance(legs[i][0], legs[i][1]);
        for (int8_t kind = 0; kind < 4; kind++) {
            double told = cost(kind, legs[i][0], legs[i][1]);
            double truth = kind == AISLE_OPTIONS_SHORTEST ? length : integral(legs[i][0], legs[i][1]);
            TEST_ASSERT_DOUBLE_WITHIN(0.12 * truth, truth, told);
            TEST_ASSERT_TRUE(told >= length - 1e-9 && told <= AISLE_OBJECTIVE_DENSITY_MAX * length);
        }
    }
}

static void test_the_way_back_costs_the_same(void) {
    aisle_vec2 a = {2.5, 4.4};
    aisle_vec2 b = {10.0, 4.1};
    double there = cost(AISLE_OPTIONS_SAFEST, a, b);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, there, cost(AISLE_OPTIONS_SAFEST, b, a));
    TEST_ASSERT_TRUE(there > 9.0); // it passes the boxes
}

static void test_units_follow_the_length(void) {
    (void)cost(AISLE_OPTIONS_SAFEST, aisle_vec2_of(1.0, 1.0), aisle_vec2_of(1.01, 1.0));
    TEST_ASSERT_EQUAL_UINT32(1, units);
    units = 0;
    (void)cost(AISLE_OPTIONS_SAFEST, aisle_vec2_of(1.0, 1.0), aisle_vec2_of(11.02, 1.0));
    TEST_ASSERT_EQUAL_UINT32((101 + 3) / 4, units);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_shortest_is_the_plain_length_and_costs_no_units);
    RUN_TEST(test_a_leg_of_no_length_costs_nothing);
    RUN_TEST(test_the_others_integrate_their_density_over_the_clearance);
    RUN_TEST(test_the_way_back_costs_the_same);
    RUN_TEST(test_units_follow_the_length);
    return UNITY_END();
}
