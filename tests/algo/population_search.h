// population_search.h - test fixture of pso.h and ga.h: functions whose minima are known, runs, and the tests that hold for
// both. Included behind `cfg` and the search itself; before it:
//   #define SEARCH(word) aisle_pso_##word    the functions
//   #define SELF pso                         the search
//   #define DIMENSIONS dim                   the field of cfg
#ifndef AISLE_TESTS_POPULATION_SEARCH_H
#define AISLE_TESTS_POPULATION_SEARCH_H

#include "base/angle.h"
#include "base/crc32.h"
#include "unity.h"

#include <math.h>
#include <string.h>

enum { DIM = 3, WIDE_MAX = 14 };

static const float lo[DIM] = {-1.0F, -2.0F, 0.0F}, hi[DIM] = {1.0F, 2.0F, 5.0F};
static const float peak[DIM] = {0.25F, -1.5F, 5.0F}; // the last one lies on the wall of the box
static float wide_lo[WIDE_MAX], wide_hi[WIDE_MAX];
static uint32_t calls;

// The test's own: begins a run of cfg; makes it one of few evaluations; tells how many a whole one has; expects that cfg is
// refused as AISLE_ERR_ARG with nothing changed.
static aisle_status start(void);
static void use_few_evaluations(void);
static uint32_t evaluations_in_all(void);
static void expect_bad(const char *what);

// ---- functions; each checks that it is asked about points of the box only

static void expect_in_box(const float *x) {
    calls++;
    for (int i = 0; i < cfg.DIMENSIONS; i++) {
        TEST_ASSERT_TRUE(x[i] >= cfg.lo[i] && x[i] <= cfg.hi[i]);
    }
}

static float bowl_value(const float *x) {
    float sum = 0.0F;
    for (int i = 0; i < DIM; i++) {
        sum += (x[i] - peak[i]) * (x[i] - peak[i]);
    }
    return sum;
}

static aisle_cost_pair bowl(void *ctx, const float *x) {
    (void)ctx;
    expect_in_box(x);
    return (aisle_cost_pair){0.0F, bowl_value(x)};
}

static aisle_cost_pair bowl_with_a_nan_rim(void *above, const float *x) {
    const aisle_cost_pair cost = bowl(NULL, x);
    return cost.value > *(const float *)above ? (aisle_cost_pair){0.0F, NAN} : cost;
}

// Only x[0] >= 0.5 is feasible, and that is dearer: value alone would go the other way.
static aisle_cost_pair walled_bowl(void *ctx, const float *x) {
    const aisle_cost_pair cost = bowl(ctx, x);
    return (aisle_cost_pair){x[0] < 0.5F ? 0.5F - x[0] : 0.0F, cost.value};
}

static aisle_cost_pair never_feasible(void *ctx, const float *x) {
    const aisle_cost_pair cost = bowl(ctx, x);
    return (aisle_cost_pair){1.0F + cost.value, -1000.0F};
}

static aisle_cost_pair rosenbrock(void *ctx, const float *x) {
    (void)ctx;
    expect_in_box(x);
    float sum = 0.0F;
    for (int i = 0; i + 1 < cfg.DIMENSIONS; i++) {
        const float a = x[i + 1] - x[i] * x[i];
        const float b = 1.0F - x[i];
        sum += 100.0F * a * a + b * b;
    }
    return (aisle_cost_pair){0.0F, sum};
}

static aisle_cost_pair rastrigin(void *ctx, const float *x) {
    (void)ctx;
    expect_in_box(x);
    double sum = 0.0;
    for (int i = 0; i < cfg.DIMENSIONS; i++) {
        double sine;
        double cosine;
        aisle_sincos(2.0 * AISLE_PI * (double)x[i], &sine, &cosine); // the same hits on every board
        sum += (double)(x[i] * x[i]) + 10.0 - 10.0 * cosine;
    }
    return (aisle_cost_pair){0.0F, (float)sum};
}

static aisle_cost_pair answer;

static aisle_cost_pair always(void *ctx, const float *x) {
    (void)ctx;
    expect_in_box(x);
    return answer;
}

// ---- runs

static const float *best(void) {
    return SEARCH(best)(&SELF);
}

// Runs to the end and checks the budget of every step.
static aisle_status run_in_steps_of(uint32_t slice) {
    TEST_ASSERT_EQUAL(AISLE_OK, start());
    aisle_status st = AISLE_BUSY;
    while (st == AISLE_BUSY) {
        calls = 0;
        st = SEARCH(step)(&SELF, slice);
        TEST_ASSERT_TRUE(st == AISLE_BUSY ? calls == slice : calls <= slice);
    }
    TEST_ASSERT_TRUE(SEARCH(invariants_hold)(&SELF));
    return st;
}

// How many of the seeds 0 .. seeds-1 meet the goal.
static uint32_t hits_of(uint64_t seeds) {
    uint32_t hits = 0;
    for (cfg.seed = 0; cfg.seed < seeds; cfg.seed++) {
        hits += run_in_steps_of(UINT32_MAX) == AISLE_OK;
    }
    return hits;
}

static void use_wide_box(uint16_t dimensions, float half) {
    for (int i = 0; i < WIDE_MAX; i++) {
        wide_lo[i] = -half;
        wide_hi[i] = half;
    }
    cfg.DIMENSIONS = dimensions;
    cfg.lo = wide_lo;
    cfg.hi = wide_hi;
}

// Every slicing of cfg ends with the best point and the evaluations that one step does.
static void expect_same_bits_in_slices(void) {
    float whole[DIM];
    (void)run_in_steps_of(UINT32_MAX);
    memcpy(whole, best(), sizeof whole);
    const uint32_t evals = SELF.evals;
    for (uint32_t slice = 1; slice < 40; slice++) {
        (void)run_in_steps_of(slice);
        TEST_ASSERT_EQUAL_UINT32(evals, SELF.evals);
        TEST_ASSERT_EQUAL_MEMORY(whole, best(), sizeof whole);
    }
}

static void expect_invariants_after_every_evaluation(void) {
    TEST_ASSERT_EQUAL(AISLE_OK, start());
    do {
        TEST_ASSERT_TRUE(SEARCH(invariants_hold)(&SELF));
    } while (SEARCH(step)(&SELF, 1) == AISLE_BUSY);
    TEST_ASSERT_TRUE(SEARCH(invariants_hold)(&SELF));
}

static uint32_t crc_with_best(uint32_t crc) {
    for (int i = 0; i < DIM; i++) {
        uint32_t bits;
        memcpy(&bits, &best()[i], sizeof bits);
        const uint8_t bytes[4] = {(uint8_t)bits, (uint8_t)(bits >> 8), (uint8_t)(bits >> 16), (uint8_t)(bits >> 24)};
        crc = aisle_crc32(crc, bytes, sizeof bytes);
    }
    return crc;
}

// ---- tests of both

static void test_minimum_on_the_wall_is_found_for_200_of_200_seeds(void) {
    TEST_ASSERT_EQUAL_UINT32(200, hits_of(200));
    for (int i = 0; i < DIM; i++) {
        TEST_ASSERT_FLOAT_WITHIN(1e-3F, peak[i], best()[i]); // sqrt(value_goal)
    }
}

static void test_seeds_differ(void) {
    float first[DIM];
    cfg.value_goal = -INFINITY;
    use_few_evaluations();
    (void)run_in_steps_of(9);
    memcpy(first, best(), sizeof first);
    cfg.seed = 2;
    (void)run_in_steps_of(9);
    TEST_ASSERT_TRUE(memcmp(first, best(), sizeof first) != 0);
}

static void test_violation_comes_first_for_100_of_100_seeds(void) {
    cfg.cost = walled_bowl;
    cfg.value_goal = -INFINITY;
    for (cfg.seed = 0; cfg.seed < 100; cfg.seed++) {
        TEST_ASSERT_EQUAL(AISLE_PARTIAL, run_in_steps_of(100));
        TEST_ASSERT_TRUE(best()[0] >= 0.5F);
        TEST_ASSERT_FLOAT_WITHIN(2e-3F, 0.0625F, SELF.best_cost.value); // (0.5 - 0.25)^2: at the wall
        TEST_ASSERT_TRUE(SELF.best_cost.violation <= 0.0F);
    }
}

static void test_goal_is_not_met_by_a_point_that_violates(void) {
    cfg.cost = never_feasible;
    TEST_ASSERT_EQUAL(AISLE_PARTIAL, run_in_steps_of(64));
    TEST_ASSERT_EQUAL_UINT32(evaluations_in_all(), SELF.evals);
    TEST_ASSERT_FLOAT_WITHIN(1e-4F, 1.0F, SELF.best_cost.violation); // but the least violation is found
}

static void test_nan_everywhere_ends_partial_with_no_best(void) {
    float nowhere = -1.0F;
    cfg.cost = bowl_with_a_nan_rim;
    cfg.cost_ctx = &nowhere;
    TEST_ASSERT_EQUAL(AISLE_PARTIAL, run_in_steps_of(7));
    TEST_ASSERT_NULL(best());
    TEST_ASSERT_EQUAL_UINT32(evaluations_in_all(), SELF.nan_costs);
    TEST_ASSERT_EQUAL_UINT32(0, SELF.best_updates);
    TEST_ASSERT_TRUE(isinf(SELF.best_cost.violation) && isinf(SELF.best_cost.value));
}

static void expect_no_best_for(float violation, float value) {
    answer = (aisle_cost_pair){violation, value};
    TEST_ASSERT_EQUAL(AISLE_PARTIAL, run_in_steps_of(11));
    TEST_ASSERT_NULL(best());
}

static void test_infinity_or_nan_in_either_part_is_not_allowed(void) {
    cfg.cost = always;
    cfg.value_goal = INFINITY;
    use_few_evaluations();
    expect_no_best_for(INFINITY, 0.0F);
    TEST_ASSERT_EQUAL_UINT32(0, SELF.nan_costs);
    expect_no_best_for(0.0F, INFINITY);
    expect_no_best_for(NAN, 0.0F);
    TEST_ASSERT_EQUAL_UINT32(evaluations_in_all(), SELF.nan_costs);
    expect_no_best_for(0.0F, NAN);
    TEST_ASSERT_EQUAL_UINT32(evaluations_in_all(), SELF.nan_costs);
}

static void test_negative_violation_is_read_as_feasible(void) {
    cfg.cost = always;
    answer = (aisle_cost_pair){-3.0F, 0.0F};
    TEST_ASSERT_EQUAL(AISLE_OK, run_in_steps_of(11));
    TEST_ASSERT_EQUAL_FLOAT(0.0F, SELF.best_cost.violation);
    TEST_ASSERT_EQUAL_UINT32(1, SELF.evals);
}

static void test_stall_ends_the_run_that_many_evaluations_after_the_last_gain(void) {
    cfg.cost = always;
    answer = (aisle_cost_pair){0.0F, 5.0F};
    cfg.stall_max = 77;
    TEST_ASSERT_EQUAL(AISLE_PARTIAL, run_in_steps_of(10));
    TEST_ASSERT_EQUAL_UINT32(1, SELF.last_improvement);
    TEST_ASSERT_EQUAL_UINT32(78, SELF.evals);
    cfg.cost = bowl;
    cfg.value_goal = -INFINITY;
    TEST_ASSERT_EQUAL(AISLE_PARTIAL, run_in_steps_of(10));
    TEST_ASSERT_TRUE(SELF.evals - SELF.last_improvement == 77 || SELF.evals == evaluations_in_all());
}

static void test_further_steps_repeat_the_answer_and_cost_nothing(void) {
    TEST_ASSERT_EQUAL(AISLE_OK, run_in_steps_of(50));
    const uint32_t evals = SELF.evals;
    calls = 0;
    TEST_ASSERT_EQUAL(AISLE_OK, SEARCH(step)(&SELF, 50));
    TEST_ASSERT_TRUE(calls == 0 && SELF.evals == evals);
}

static void test_start_and_a_step_of_nothing_ask_nothing(void) {
    calls = 0;
    TEST_ASSERT_EQUAL(AISLE_OK, start());
    TEST_ASSERT_EQUAL_UINT32(0, calls);
    TEST_ASSERT_EQUAL(AISLE_BUSY, SEARCH(step)(&SELF, 0));
    TEST_ASSERT_EQUAL_UINT32(0, calls);
    TEST_ASSERT_NULL(best());
}

static void test_start_refuses_every_bad_box(void) {
    const float bad[6][2] = {{1.0F, 1.0F}, {2.0F, 1.0F}, {NAN, 1.0F}, {0.0F, NAN}, {-INFINITY, 0.0F}, {0.0F, 2e30F}};
    for (int i = 0; i < 6; i++) {
        for (int at = 0; at < DIM; at++) {
            use_wide_box(DIM, 1.0F);
            wide_lo[at] = bad[i][0];
            wide_hi[at] = bad[i][1];
            expect_bad("box");
        }
    }
}

static void test_never_started_answers_so(void) {
    TEST_ASSERT_EQUAL(AISLE_ERR_ARG, SEARCH(step)(&SELF, 1));
    TEST_ASSERT_NULL(best());
    TEST_ASSERT_TRUE(SEARCH(invariants_hold)(&SELF));
}

static void run_tests_of_both(void) {
    RUN_TEST(test_minimum_on_the_wall_is_found_for_200_of_200_seeds);
    RUN_TEST(test_seeds_differ);
    RUN_TEST(test_violation_comes_first_for_100_of_100_seeds);
    RUN_TEST(test_goal_is_not_met_by_a_point_that_violates);
    RUN_TEST(test_nan_everywhere_ends_partial_with_no_best);
    RUN_TEST(test_infinity_or_nan_in_either_part_is_not_allowed);
    RUN_TEST(test_negative_violation_is_read_as_feasible);
    RUN_TEST(test_stall_ends_the_run_that_many_evaluations_after_the_last_gain);
    RUN_TEST(test_further_steps_repeat_the_answer_and_cost_nothing);
    RUN_TEST(test_start_and_a_step_of_nothing_ask_nothing);
    RUN_TEST(test_start_refuses_every_bad_box);
    RUN_TEST(test_never_started_answers_so);
}
#endif
