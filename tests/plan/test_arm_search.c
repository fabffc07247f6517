#include "plan/arm_search.h" // first: proves that the header stands alone

#include "../robot/arm_drawn.h"
#include "arm_hall.h"

enum { SEEDS = 24, FINE = 2000 };

static aisle_arm_search search;
static float risk_weight; // 0: as usual
static const double from[3] = {-0.9, 0.0, 0.0}, to[3] = {0.9, 0.0, 0.0};

void setUp(void) {
    arm_hall_begin();
    risk_weight = 0.0F;
}
void tearDown(void) {}

static void open_hall(void) {
    aisle_arena arena = arm_hall_open(64U);
    aisle_arm_search_carve(&search, &arena);
    TEST_ASSERT_FALSE(arena.overflow);
}

static void begin(int8_t objective, int8_t planner, int32_t seed) {
    const aisle_options_msg options = {
        .objective = objective, .planner = planner, .seed = seed, .risk_weight = risk_weight};
    aisle_arm_search_start(&search, &world, from, to, &options);
}

static aisle_status run(uint32_t units, uint32_t *spent) {
    aisle_status st;
    do {
        st = aisle_arm_search_step(&search, units, spent);
    } while (st == AISLE_BUSY);
    return st;
}

// ---- costs

static double draw_piece(uint64_t seed, aisle_arm_piece *piece) { // least gap at many places, by the world's gap
    aisle_rng rng = aisle_rng_seed(seed);
    double a[3], b[3], bend[6], q[3], least = INFINITY;
    arm_draw(&rng, a);
    arm_draw(&rng, b);
    for (int i = 0; i < 6; i++) {
        bend[i] = uniform(&rng, -20.0, 20.0);
    }
    for (uint32_t j = 0; j < 3U; j++) { // a short way, else most of them touch
        a[j] *= 0.4;
        b[j] *= 0.4;
    }
    aisle_arm_piece_of(3U, a, b, bend, piece);
    for (int i = 0; i <= FINE; i++) {
        aisle_arm_piece_at(piece, (double)i / FINE, 0, q);
        least = fmin(least, aisle_arm_world_gap(&world, q, 0.3, NULL, NULL));
        least = aisle_arm_joint_out(&arm, q, 1e-6) == 0U ? least : 0.0;
    }
    return least;
}

static double travelled(const aisle_arm_piece *piece, double *risk) { // by steps; mean of risk at as many places
    double sum = 0.0, before[3], q[3];
    *risk = 0.0;
    aisle_arm_piece_at(piece, 0.0, 0, before);
    for (int i = 1; i <= FINE; i++) {
        aisle_arm_piece_at(piece, (double)i / FINE, 0, q);
        sum += fabs(q[0] - before[0]) + fabs(q[1] - before[1]) + fabs(q[2] - before[2]);
        memcpy(before, q, sizeof q);
        *risk += fmax(0.0, 1.0 - aisle_arm_world_gap(&world, q, 0.3, NULL, NULL) / AISLE_ARM_CREEP) / FINE;
    }
    return sum;
}

// The motors' work when run in `duration`, by torques in long double.
static double worked(const aisle_arm_piece *piece, double duration) {
    double sum = 0.0;
    for (int i = 0; i < FINE; i++) {
        double q[3], v[3], a[3];
        long double torque[3];
        aisle_arm_piece_at(piece, (i + 0.5) / FINE, 0, q);
        aisle_arm_piece_at(piece, (i + 0.5) / FINE, 1, v);
        aisle_arm_piece_at(piece, (i + 0.5) / FINE, 2, a);
        for (int j = 0; j < 3; j++) {
            v[j] /= duration;
            a[j] /= duration * duration;
        }
        drawn_torques(&arm, world.base.theta, q, v, a, torque);
        for (int j = 0; j < 3; j++) {
            sum += (double)fabsl(torque[j] * (long double)v[j]) * duration / FINE;
        }
    }
    return sum;
}

static void test_violation_is_0_for_motions_that_are_free_alone_and_deeper_ones_have_more(void) {
    int free_ones = 0;
    hall_add(6.1, 5.1, 6.3, 5.3);
    hall_add(5.9, 4.4, 6.2, 4.6);
    open_hall();
    begin(AISLE_OPTIONS_SHORTEST, AISLE_OPTIONS_GA, 0);
    for (uint64_t seed = 0; seed < 6U * SEEDS; seed++) {
        aisle_arm_piece piece;
        const double least = draw_piece(seed, &piece);
        const aisle_cost_pair cost = aisle_arm_search_cost(&search, &piece);
        TEST_ASSERT_TRUE(cost.violation > 0.0F ? least < 1.1 * AISLE_ARM_KEEP : least >= 0.5 * AISLE_ARM_KEEP);
        free_ones += cost.violation > 0.0F ? 0 : 1;
    }
    TEST_ASSERT_TRUE(free_ones > 5 && free_ones < 3 * SEEDS);
}
static void test_what_is_hit_between_two_samples_is_found_and_told_from_depth(void) {
    aisle_arm_piece piece;
    hall_add(6.689, 5.083, 6.691, 5.085); // 2 mm; the tip jumps over it from the 12th sample to the 13th
    open_hall();
    begin(AISLE_OPTIONS_SHORTEST, AISLE_OPTIONS_GA, 0);
    aisle_arm_piece_of(3U, from, to, NULL, &piece);
    const aisle_cost_pair cost = aisle_arm_search_cost(&search, &piece);
    TEST_ASSERT_TRUE(cost.violation > 0.0F && cost.violation <= 1e-3F);
}
static void test_values_are_what_each_objective_says(void) {
    int measured = 0;
    hall_add(6.1, 5.1, 6.3, 5.3);
    open_hall();
    for (uint64_t seed = 0; seed < SEEDS; seed++) {
        aisle_arm_piece piece;
        aisle_cost_pair cost[4];
        aisle_arm_timing timing;
        double risk;
        if (!(draw_piece(seed, &piece) > 0.0)) {
            continue;
        }
        const double travel = travelled(&piece, &risk);
        for (int8_t o = AISLE_OPTIONS_SAFEST; o <= AISLE_OPTIONS_LEAST_ENERGY; o++) {
            begin(o, AISLE_OPTIONS_GA, 0);
            cost[o] = aisle_arm_search_cost(&search, &piece);
        }
        aisle_arm_least_duration(&arm, &search.dynamics, &piece, AISLE_ARM_TIMING_PANELS, &timing);
        TEST_ASSERT_DOUBLE_WITHIN(2e-3 * travel, travel, (double)cost[AISLE_OPTIONS_SHORTEST].value);
        TEST_ASSERT_DOUBLE_WITHIN(0.05 * travel, travel * (1.0 + risk), (double)cost[AISLE_OPTIONS_SAFEST].value);
        TEST_ASSERT_DOUBLE_WITHIN(2e-3 * timing.duration, timing.duration, (double)cost[AISLE_OPTIONS_FASTEST].value);
        const double work = worked(&piece, timing.duration);
        TEST_ASSERT_DOUBLE_WITHIN(0.02 * work, work, (double)cost[AISLE_OPTIONS_LEAST_ENERGY].value);
        measured++;
    }
    TEST_ASSERT_GREATER_THAN_INT(SEEDS / 4, measured);
}

// ---- runs

static int escapes(int8_t objective, int8_t planner, int seeds) {
    int found = 0;
    for (int seed = 0; seed < seeds; seed++) {
        aisle_arm_piece piece;
        uint32_t spent = 0, units = 0;
        double q[3];
        begin(objective, planner, seed);
        const aisle_status st = run(1000, &spent);
        TEST_ASSERT_EQUAL(st == AISLE_OK, aisle_arm_search_best(&search, &piece));
        for (int i = 0; st == AISLE_OK && i <= 200; i++) { // and what it found is free, by the judge
            aisle_arm_piece_at(&piece, i / 200.0, 0, q);
            TEST_ASSERT_TRUE(arm_judged(q) > 0.0);
            TEST_ASSERT_EQUAL_UINT32(0, aisle_arm_joint_out(&arm, q, 1e-6));
            TEST_ASSERT_TRUE(i > 0 || aisle_arm_free_piece(&world, &piece, &units, NULL));
        }
        found += st == AISLE_OK ? 1 : 0;
    }
    return found;
}
static void test_graded_depth_escapes_where_the_death_penalty_seldom_does(void) {
    hall_add(6.35, 4.95, 6.6, 5.05);
    open_hall();
    const int graded = escapes(AISLE_OPTIONS_SHORTEST, AISLE_OPTIONS_GA, 8);
    const int swarm = escapes(AISLE_OPTIONS_SHORTEST, AISLE_OPTIONS_PSO, 8);
    const int paper = escapes(AISLE_OPTIONS_PAPER, AISLE_OPTIONS_GA, 8);
    TEST_ASSERT_EQUAL_INT(8, graded);
    TEST_ASSERT_GREATER_OR_EQUAL_INT(7, swarm);
    TEST_ASSERT_LESS_THAN_INT(graded, paper);
}
static void test_a_straight_motion_that_is_free_is_never_made_worse(void) {
    arm_msg.arm_base[0] = 0.6;     // clear of the body
    hall_add(6.84, 4.8, 7.0, 5.2); // near the tip's way
    risk_weight = 30.0F;
    open_hall();
    for (int8_t o = AISLE_OPTIONS_SAFEST; o <= AISLE_OPTIONS_LEAST_ENERGY; o++) {
        aisle_arm_piece straight, best;
        uint32_t spent = 0;
        begin(o, AISLE_OPTIONS_GA, 5);
        aisle_arm_piece_of(3U, from, to, NULL, &straight);
        const float before = aisle_arm_search_cost(&search, &straight).value;
        TEST_ASSERT_EQUAL_FLOAT(0.0F, aisle_arm_search_cost(&search, &straight).violation);
        TEST_ASSERT_EQUAL(AISLE_OK, run(1000, &spent));
        TEST_ASSERT_TRUE(aisle_arm_search_best(&search, &best));
        const float after = aisle_arm_search_cost(&search, &best).value;
        TEST_ASSERT_TRUE(after <= before);
        TEST_ASSERT_TRUE(o == AISLE_OPTIONS_SHORTEST || after < 0.99F * before); // and else there is something to gain
    }
}
static void test_the_papers_coefficients_stay_in_its_box(void) {
    hall_add(6.62, 4.97, 6.68, 5.03);
    open_hall();
    for (int seed = 0; seed < 4; seed++) {
        aisle_arm_piece best;
        uint32_t spent = 0;
        begin(AISLE_OPTIONS_PAPER, AISLE_OPTIONS_PSO, seed); // PAPER is GA whatever is named
        if (run(1000, &spent) == AISLE_OK && aisle_arm_search_best(&search, &best)) {
            for (int j = 0; j < 3; j++) {
                TEST_ASSERT_TRUE(fabs(best.c[j][6]) <= 100.0 + 1e-6 && fabs(best.c[j][7]) <= 100.0 + 1e-6);
            }
        }
        TEST_ASSERT_FALSE(search.swarm);
        TEST_ASSERT_EQUAL_UINT16(20U, search.ga.cfg.population);
        TEST_ASSERT_EQUAL_UINT32(100U, search.ga.cfg.generation_max);
    }
}
static void test_any_cut_of_the_work_finds_the_same(void) {
    static const int8_t planners[2] = {AISLE_OPTIONS_GA, AISLE_OPTIONS_PSO};
    hall_add(6.35, 4.95, 6.6, 5.05);
    open_hall();
    for (int p = 0; p < 2; p++) {
        aisle_arm_piece best[2];
        uint32_t spent[2] = {0, 0};
        for (int i = 0; i < 2; i++) {
            begin(AISLE_OPTIONS_SAFEST, planners[p], 3);
            TEST_ASSERT_EQUAL(AISLE_OK, run(i == 0 ? 1U : UINT32_MAX, &spent[i]));
            TEST_ASSERT_TRUE(aisle_arm_search_best(&search, &best[i]));
        }
        TEST_ASSERT_EQUAL_UINT32(spent[0], spent[1]);
        TEST_ASSERT_EQUAL_MEMORY(best[0].c, best[1].c, sizeof best[0].c);
    }
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_violation_is_0_for_motions_that_are_free_alone_and_deeper_ones_have_more);
    RUN_TEST(test_what_is_hit_between_two_samples_is_found_and_told_from_depth);
    RUN_TEST(test_values_are_what_each_objective_says);
    RUN_TEST(test_graded_depth_escapes_where_the_death_penalty_seldom_does);
    RUN_TEST(test_a_straight_motion_that_is_free_is_never_made_worse);
    RUN_TEST(test_the_papers_coefficients_stay_in_its_box);
    RUN_TEST(test_any_cut_of_the_work_finds_the_same);
    return UNITY_END();
}
