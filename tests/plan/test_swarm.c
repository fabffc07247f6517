#include "plan/swarm.h"

#include "hall.h"

static aisle_space space;
static aisle_swarm swarm;
static aisle_objective objective;
static aisle_options_msg options;
static uint32_t spent;

static void open_hall(void) {
    aisle_arena arena = hall_arena(24U << 20);
    memset(&space, 0, sizeof space);
    memset(&swarm, 0, sizeof swarm);
    aisle_space_carve(&space, &arena, hall_limits.cells);
    aisle_swarm_carve(&swarm, &arena);
    hall_open(&arena, 0.05F);
    aisle_space_begin(&space, &hall_layout, &hall_vehicle, AISLE_SPACE_FREE_TURN);
}

// The straight way at y = 4 passes the pillar with 0.2 m to spare beyond the footprint.
static void pillar_hall(void) {
    hall_begin(10.0, 8.0);
    hall_add(4.2, 1.5, 5.8, 3.5);
    open_hall();
}

static void wish(int8_t kind, int8_t interpolation) {
    options = (aisle_options_msg){.objective = kind, .interpolation = interpolation};
    TEST_ASSERT_TRUE(aisle_objective_of(&options, &hall_vehicle, &objective));
}

void setUp(void) {
    hall_disc(0.3, 0.1F);
    pillar_hall();
    wish(AISLE_OPTIONS_SAFEST, AISLE_OPTIONS_SPLINE);
}
void tearDown(void) {}

static const aisle_vec2 straight[] = {{1.0, 4.0}, {9.0, 4.0}};

static aisle_status run(const aisle_vec2 *points, uint32_t count, uint32_t slice) {
    spent = 0;
    aisle_status st = aisle_swarm_start(&swarm, &space, &objective, &options, points, count);
    if (st != AISLE_OK) {
        return st;
    }
    do {
        uint32_t before = spent;
        st = aisle_swarm_step(&swarm, slice, &spent);
        TEST_ASSERT_TRUE(slice > UINT32_MAX - 4096U || spent - before <= slice + 4096U);
        TEST_ASSERT_TRUE(aisle_pso_invariants_hold(&swarm.pso));
    } while (st == AISLE_BUSY);
    return st;
}

static double best_value(void) {
    return (double)aisle_swarm_best_cost(&swarm).value;
}

static aisle_vec2 random_place(aisle_rng *rng) {
    aisle_vec2 p;
    do {
        p = uniform_point(rng, aisle_vec2_of(0.5, 0.5), aisle_vec2_of(9.5, 7.5));
    } while ((double)hall_disc_gap(p.x, p.y, hall_vehicle.outer_radius) < hall_vehicle.margin + 0.01);
    return p;
}

// ---- judge: the samples of a way as the header describes it

static aisle_spline_sample samples[AISLE_SWARM_SAMPLES_MAX];

static void sample_best(void) {
    static aisle_spline spline;
    aisle_vec2 points[AISLE_SWARM_VIAS + 2U];
    uint32_t n = aisle_swarm_best(&swarm, points);
    TEST_ASSERT_EQUAL_UINT32(swarm.vias + 2U, n);
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_spline_fit(&spline, swarm.kind, points, n));
    aisle_spline_spread(&spline, swarm.samples, samples);
}

// Least gap of the footprint at the samples, heading along the way.
static double sampled_gap(void) {
    double least = 1e9;
    for (uint32_t i = 0; i < swarm.samples; i++) {
        aisle_pose2 pose = {samples[i].p.x, samples[i].p.y, atan2(samples[i].d1.y, samples[i].d1.x)};
        least = fmin(least, hall_body_gap(pose));
    }
    return least;
}

// The objective's integral over the samples by trapezia, clearances from the boxes.
static double sampled_value(void) {
    double sum = 0.0;
    for (uint32_t i = 0; i + 1U < swarm.samples; i++) {
        double density = 0.0;
        for (uint32_t k = i; k <= i + 1U; k++) {
            double clearance = (double)hall_disc_gap(samples[k].p.x, samples[k].p.y, hall_vehicle.inner_radius);
            density += 0.5 * aisle_objective_density(&objective, clearance, aisle_spline_curvature(&samples[k]));
        }
        sum += density * aisle_vec2_distance(samples[i].p, samples[i + 1U].p);
    }
    return sum;
}

// ---- tests

static void test_the_best_is_never_worse_than_the_seed_and_keeps_the_margin_if_feasible(void) {
    int feasible = 0;
    for (uint64_t s = 0; s < 12; s++) {
        aisle_rng rng = aisle_rng_seed(s);
        for (int8_t kind = 0; kind < 4; kind++) {
            wish(kind, s % 2U == 0U ? AISLE_OPTIONS_SPLINE : AISLE_OPTIONS_LINEAR);
            options.seed = (int32_t)s + 1;
            aisle_vec2 leg[3];
            for (int i = 0; i < 3; i++) {
                leg[i] = random_place(&rng);
            }
            TEST_ASSERT_EQUAL(AISLE_OK, run(leg, 3, 5000));
            TEST_ASSERT_FALSE(aisle_cost_pair_better(swarm.seed_cost, aisle_swarm_best_cost(&swarm)));
            aisle_vec2 points[AISLE_SWARM_VIAS + 2U];
            if (aisle_swarm_best(&swarm, points) == 0) {
                TEST_ASSERT_TRUE(aisle_swarm_best_cost(&swarm).violation > 0.0F);
                continue;
            }
            TEST_ASSERT_EQUAL_MEMORY(&leg[0], &points[0], sizeof leg[0]);
            TEST_ASSERT_EQUAL_MEMORY(&leg[2], &points[swarm.vias + 1U], sizeof leg[0]);
            sample_best();
            TEST_ASSERT_TRUE(sampled_gap() >= hall_vehicle.margin - 1e-6);
            TEST_ASSERT_DOUBLE_WITHIN(0.15 * best_value(), best_value(), sampled_value());
            feasible += 1;
        }
    }
    TEST_ASSERT_GREATER_THAN_INT(30, feasible);
}

static void test_safest_beats_a_seed_past_a_pillar_by_5_percent_for_20_of_20_seeds(void) {
    for (int8_t interpolation = 0; interpolation < 2; interpolation++) {
        wish(AISLE_OPTIONS_SAFEST, interpolation);
        for (options.seed = 1; options.seed <= 20; options.seed++) {
            TEST_ASSERT_EQUAL(AISLE_OK, run(straight, 2, 5000));
            TEST_ASSERT_FALSE(swarm.seed_cost.violation > 0.0F);
            TEST_ASSERT_TRUE(best_value() < 0.95 * (double)swarm.seed_cost.value);
        }
    }
}

static void test_a_seed_that_violates_the_margin_is_led_out_of_it(void) {
    aisle_vec2 through[] = {{1.0, 3.3}, {9.0, 3.3}};
    int hits = 0;
    for (options.seed = 1; options.seed <= 20; options.seed++) {
        TEST_ASSERT_EQUAL(AISLE_OK, run(through, 2, 5000));
        TEST_ASSERT_TRUE(swarm.seed_cost.violation > 0.0F);
        hits += aisle_swarm_best_cost(&swarm).violation <= 0.0F;
    }
    TEST_ASSERT_EQUAL_INT(20, hits);
}

static void test_nothing_feasible_is_told_by_0_points(void) {
    hall_begin(10.0, 8.0);
    hall_add(4.8, 0.0, 5.2, 8.0);
    open_hall();
    aisle_vec2 points[AISLE_SWARM_VIAS + 2U];
    TEST_ASSERT_EQUAL(AISLE_OK, run(straight, 2, 5000));
    TEST_ASSERT_EQUAL_UINT32(0, aisle_swarm_best(&swarm, points));
}

static void test_the_same_seed_gives_the_same_bits_however_sliced_and_another_one_others(void) {
    static const uint32_t slices[] = {UINT32_MAX, 1, 37, 5000};
    aisle_vec2 whole[AISLE_SWARM_VIAS + 2U], points[AISLE_SWARM_VIAS + 2U];
    uint32_t units = 0;
    uint32_t n = 0;
    for (int i = 0; i < 4; i++) {
        TEST_ASSERT_EQUAL(AISLE_OK, run(straight, 2, slices[i]));
        if (i == 0) {
            n = aisle_swarm_best(&swarm, whole);
            units = spent;
        }
        TEST_ASSERT_EQUAL_UINT32(units, spent);
        TEST_ASSERT_EQUAL_UINT32(n, aisle_swarm_best(&swarm, points));
        TEST_ASSERT_EQUAL_MEMORY(whole, points, n * sizeof points[0]);
    }
    options.seed = 12345;
    TEST_ASSERT_EQUAL(AISLE_OK, run(straight, 2, 5000));
    (void)aisle_swarm_best(&swarm, points);
    TEST_ASSERT_TRUE(memcmp(whole, points, n * sizeof points[0]) != 0);
}

static void test_curvature_above_the_vehicles_is_a_violation(void) {
    hall_vehicle.curvature_max = 0.5;
    aisle_vec2 sharp[] = {{1.0, 1.0}, {3.0, 6.5}, {8.5, 6.0}};
    TEST_ASSERT_EQUAL(AISLE_OK, run(sharp, 3, 5000));
    TEST_ASSERT_TRUE(swarm.seed_cost.violation > 0.0F);
    TEST_ASSERT_FALSE(aisle_swarm_best_cost(&swarm).violation > 0.0F);
    sample_best();
    for (uint32_t i = 0; i < swarm.samples; i++) {
        TEST_ASSERT_TRUE(fabs(aisle_spline_curvature(&samples[i])) <= 0.5 + 1e-6);
    }
}

static void test_legs_too_short_or_with_too_many_corners_are_left_alone(void) {
    aisle_vec2 points[AISLE_SWARM_VIAS + 3U];
    for (uint32_t i = 0; i < AISLE_SWARM_VIAS + 3U; i++) {
        points[i] = aisle_vec2_of(1.0 + 0.3 * i, 5.5 + (i % 2U == 0U ? 0.1 : 0.0));
    }
    TEST_ASSERT_EQUAL(AISLE_PARTIAL, run(points, AISLE_SWARM_VIAS + 3U, 1000));
    TEST_ASSERT_EQUAL(AISLE_OK, run(points, AISLE_SWARM_VIAS + 2U, 1000));
    TEST_ASSERT_EQUAL_UINT32(AISLE_SWARM_VIAS, swarm.vias);
    aisle_vec2 brief[] = {{1.0, 1.0}, {1.19, 1.0}};
    TEST_ASSERT_EQUAL(AISLE_PARTIAL, run(brief, 2, 1000));
    brief[1].x = 1.21;
    TEST_ASSERT_EQUAL(AISLE_OK, run(brief, 2, 1000));
}

static void test_vias_lie_within_their_reach_of_the_seed_spread_by_length(void) {
    aisle_vec2 bent[] = {{1.0, 4.2}, {1.0, 6.5}, {9.0, 6.5}, {9.0, 1.0}};
    TEST_ASSERT_EQUAL(AISLE_OK, run(bent, 4, 5000));
    TEST_ASSERT_TRUE(swarm.vias >= 8 && swarm.vias <= 12);
    aisle_vec2 points[AISLE_SWARM_VIAS + 2U];
    uint32_t n = aisle_swarm_best(&swarm, points);
    for (uint32_t i = 1; i + 1U < n; i++) {
        double least = 1e9;
        for (int k = 0; k < 3; k++) {
            least = fmin(least, hall_point_segment(points[i], bent[k], bent[k + 1]));
        }
        TEST_ASSERT_TRUE(least <= sqrt(2.0) * AISLE_SWARM_REACH + 1e-6);
        double apart = aisle_vec2_distance(swarm.base[i - 1U], i + 2U < n ? swarm.base[i] : bent[3]);
        TEST_ASSERT_TRUE(apart > 0.5 && apart < 2.2);
    }
}

static void test_the_number_of_samples_is_the_wished_one_or_follows_the_length(void) {
    static const int16_t wished[] = {0, 1, 16, 100, 512, 32767};
    static const uint32_t taken[] = {34, 16, 16, 100, 512, 512};
    for (int i = 0; i < 6; i++) {
        options.num_samples = wished[i];
        TEST_ASSERT_EQUAL(AISLE_OK, aisle_swarm_start(&swarm, &space, &objective, &options, straight, 2));
        TEST_ASSERT_EQUAL_UINT32(taken[i], swarm.samples);
    }
}

static uint32_t evals(void) {
    return swarm.pso.evals + swarm.polish_evals;
}

static void test_units_are_a_quarter_of_the_samples_and_one_each_exact_gap(void) {
    hall_begin(10.0, 8.0); // all open: nothing is in doubt
    open_hall();
    options.num_samples = 200;
    TEST_ASSERT_EQUAL(AISLE_OK, run(straight, 2, 5000));
    TEST_ASSERT_TRUE(spent >= evals() * 50U);
    TEST_ASSERT_TRUE(spent <= evals() * 52U);
    uint32_t open = spent / evals();
    pillar_hall();
    TEST_ASSERT_EQUAL(AISLE_OK, run(straight, 2, 5000));
    TEST_ASSERT_TRUE(spent / evals() >= open);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_the_best_is_never_worse_than_the_seed_and_keeps_the_margin_if_feasible);
    RUN_TEST(test_safest_beats_a_seed_past_a_pillar_by_5_percent_for_20_of_20_seeds);
    RUN_TEST(test_a_seed_that_violates_the_margin_is_led_out_of_it);
    RUN_TEST(test_nothing_feasible_is_told_by_0_points);
    RUN_TEST(test_the_same_seed_gives_the_same_bits_however_sliced_and_another_one_others);
    RUN_TEST(test_curvature_above_the_vehicles_is_a_violation);
    RUN_TEST(test_legs_too_short_or_with_too_many_corners_are_left_alone);
    RUN_TEST(test_vias_lie_within_their_reach_of_the_seed_spread_by_length);
    RUN_TEST(test_the_number_of_samples_is_the_wished_one_or_follows_the_length);
    RUN_TEST(test_units_are_a_quarter_of_the_samples_and_one_each_exact_gap);
    return UNITY_END();
}
