#include "plan/paper_swarm.h"

#include "cases.h"
#include "hall.h"

enum { SEEDS = CASES(12) };

static aisle_space space;
static aisle_paper_swarm swarm;
static aisle_options_msg options;
static uint32_t spent;
static const aisle_vec2 start = {1.0, 4.0};
static const aisle_vec2 goal = {9.0, 4.0};

static void open_hall(void) {
    aisle_arena arena = hall_arena(24U << 20);
    memset(&space, 0, sizeof space);
    memset(&swarm, 0, sizeof swarm);
    aisle_space_carve(&space, &arena, hall_limits.cells);
    aisle_paper_swarm_carve(&swarm, &arena);
    hall_open(&arena, 0.05F);
    aisle_space_begin(&space, &hall_layout, &hall_vehicle, AISLE_SPACE_FREE_TURN);
}

// Two shelves in the straight way.
void setUp(void) {
    hall_rectangle(0.6, 0.8, 0.1F);
    hall_begin(10.0, 8.0);
    hall_add(3.0, 3.0, 4.0, 5.2);
    hall_add(6.0, 2.0, 7.5, 4.5);
    open_hall();
    options = (aisle_options_msg){.planner = AISLE_OPTIONS_PSO, .objective = AISLE_OPTIONS_PAPER};
}
void tearDown(void) {}

static aisle_status begin(void) {
    spent = 0;
    return aisle_paper_swarm_start(&swarm, &space, &options, start, goal);
}

static void finish(uint32_t slice) {
    while (aisle_paper_swarm_step(&swarm, slice, &spent) == AISLE_BUSY) {
        TEST_ASSERT_TRUE(aisle_pso_invariants_hold(&swarm.pso));
    }
}

static bool run(uint32_t seed) {
    options.seed = (int32_t)seed;
    TEST_ASSERT_EQUAL(AISLE_OK, begin());
    finish(20000);
    aisle_vec2 points[AISLE_PAPER_VIAS + 2U];
    return aisle_paper_swarm_best(&swarm, points) > 0U;
}

// ---- judge: the equations of the paper in long double, over the boxes

typedef struct verdict {
    long double length, oa, violation;
} verdict;

static long double oa_at(aisle_vec2 p) {
    long double r = sqrtl(0.6L * 0.6L + 0.8L * 0.8L) / 2.0L;
    long double most = 0.0L;
    for (int i = 0; i < hall_count; i++) {
        const hall_box *b = &hall_boxes[i];
        long double w = (long double)b->x1 - (long double)b->x0;
        long double l = (long double)b->y1 - (long double)b->y0;
        long double big_r = sqrtl(w * w / 4.0L + l * l / 4.0L);
        long double d = hypotl((long double)p.x - ((long double)b->x0 + w / 2.0L),
                               (long double)p.y - ((long double)b->y0 + l / 2.0L));
        most = fmaxl(most, 1.0L - 1.05L * d / (big_r + r));
    }
    return most;
}

// Asks for the figures and judges the places they were taken at.
static verdict judged(aisle_paper_figures *f) {
    TEST_ASSERT_TRUE(aisle_paper_swarm_figures(&swarm, f));
    verdict v = {0.0L, 0.0L, 0.0L};
    long double keep = 0.1L + (long double)AISLE_SPACE_SLACK;
    for (uint32_t i = 0; i < swarm.samples; i++) {
        aisle_vec2 p = swarm.sample[i].p;
        v.oa += oa_at(p) / (long double)swarm.samples;
        v.violation = fmaxl(v.violation, keep - hall_disc_gap(p.x, p.y, 0.5));
        if (i > 0) {
            aisle_vec2 q = swarm.sample[i - 1U].p;
            v.length += hypotl((long double)p.x - (long double)q.x, (long double)p.y - (long double)q.y);
        }
    }
    return v;
}

// ---- tests

static void test_the_figures_are_those_of_the_equations(void) {
    for (uint32_t s = 1; s <= SEEDS; s++) {
        options.interpolation = s % 2U == 0U ? AISLE_OPTIONS_SPLINE : AISLE_OPTIONS_LINEAR;
        options.num_samples = s % 3U == 0U ? 200 : 100;
        options.risk_weight = s % 4U == 0U ? 5.0F : 0.0F;
        double beta = s % 4U == 0U ? 5.0 : 2.0;
        options.seed = (int32_t)s;
        TEST_ASSERT_EQUAL(AISLE_OK, begin());
        for (int cut = 0; cut < 4; cut++) { // early ones collide
            (void)aisle_paper_swarm_step(&swarm, 20000, &spent);
            aisle_paper_figures f;
            verdict v = judged(&f);
            TEST_ASSERT_EQUAL_UINT32(s % 3U == 0U ? 200U : 100U, swarm.samples);
            TEST_ASSERT_DOUBLE_WITHIN(1e-9, (double)v.length, f.length);
            TEST_ASSERT_DOUBLE_WITHIN(1e-9, (double)v.oa, f.oa);
            TEST_ASSERT_DOUBLE_WITHIN(1e-9, f.length * (1.0 + beta * f.oa), f.fitness);
            TEST_ASSERT_EQUAL(v.violation > 1e-6L, f.violation > 1e-6);
            TEST_ASSERT_EQUAL_FLOAT((float)f.fitness, swarm.pso.best_cost.value);
        }
    }
}

static void test_the_best_way_runs_from_start_to_goal_through_the_bounds(void) {
    TEST_ASSERT_TRUE(run(1));
    aisle_vec2 points[AISLE_PAPER_VIAS + 2U];
    uint32_t n = aisle_paper_swarm_best(&swarm, points);
    TEST_ASSERT_EQUAL_UINT32(AISLE_PAPER_VIAS + 2U, n);
    TEST_ASSERT_TRUE(points[0].x == start.x && points[0].y == start.y);
    TEST_ASSERT_TRUE(points[n - 1U].x == goal.x && points[n - 1U].y == goal.y);
    for (uint32_t i = 0; i < n; i++) {
        TEST_ASSERT_TRUE(points[i].x >= 0.0 && points[i].x <= 10.0 && points[i].y >= 0.0 && points[i].y <= 8.0);
    }
    aisle_paper_figures f;
    verdict v = judged(&f);
    TEST_ASSERT_TRUE(v.violation <= 1e-6L && f.violation == 0.0);
}

// Seen: 24 of 24.
static void test_most_seeds_find_a_way_between_two_shelves(void) {
    int hits = 0;
    for (uint32_t s = 1; s <= SEEDS; s++) {
        for (int8_t kind = AISLE_OPTIONS_SPLINE; kind <= AISLE_OPTIONS_LINEAR; kind++) {
            options.interpolation = kind;
            hits += run(s) ? 1 : 0;
        }
    }
    TEST_ASSERT_GREATER_OR_EQUAL_INT(2 * SEEDS * 11 / 12, hits);
}

static void test_a_larger_beta_buys_a_lower_oa_with_length(void) {
    hall_begin(10.0, 8.0);
    hall_add(3.2, 4.2, 6.8, 4.6); // long and thin: its circle reaches far
    open_hall();
    double oa[2] = {0.0, 0.0};
    double length[2] = {0.0, 0.0};
    for (uint32_t s = 1; s <= SEEDS; s++) {
        for (int safe = 0; safe < 2; safe++) {
            options.risk_weight = safe == 1 ? 20.0F : 1e-6F;
            (void)run(s);
            aisle_paper_figures f;
            TEST_ASSERT_TRUE(aisle_paper_swarm_figures(&swarm, &f));
            oa[safe] += f.oa;
            length[safe] += f.length;
        }
    }
    TEST_ASSERT_TRUE(oa[1] < 0.5 * oa[0]);
    TEST_ASSERT_TRUE(length[1] > length[0]);
}

static void test_the_same_seed_gives_the_same_bits_however_the_run_is_cut(void) {
    const uint32_t slices[] = {1, 777, UINT32_MAX};
    aisle_vec2 first[AISLE_PAPER_VIAS + 2U];
    uint32_t units = 0;
    for (int i = 0; i < 3; i++) {
        TEST_ASSERT_EQUAL(AISLE_OK, begin());
        aisle_paper_figures f;
        finish(slices[i]);
        (void)aisle_paper_swarm_figures(&swarm, &f); // asking changes nothing
        aisle_vec2 points[AISLE_PAPER_VIAS + 2U];
        TEST_ASSERT_EQUAL_UINT32(AISLE_PAPER_VIAS + 2U, aisle_paper_swarm_best(&swarm, points));
        if (i == 0) {
            memcpy(first, points, sizeof first);
            units = spent;
        }
        TEST_ASSERT_EQUAL_MEMORY(first, points, sizeof first);
        TEST_ASSERT_EQUAL_UINT32(units, spent);
    }
    TEST_ASSERT_EQUAL_UINT32(AISLE_PAPER_PARTICLES * AISLE_PAPER_ITERATIONS, swarm.pso.evals);
}

static void test_samples_begin_at_the_start_unless_the_flaw_is_asked_for(void) {
    aisle_paper_figures f;
    TEST_ASSERT_EQUAL(AISLE_OK, begin());
    (void)aisle_paper_swarm_step(&swarm, 3000, &spent);
    TEST_ASSERT_TRUE(aisle_paper_swarm_figures(&swarm, &f));
    TEST_ASSERT_TRUE(aisle_vec2_distance(swarm.sample[0].p, start) == 0.0);
    double whole = f.length;
    swarm.skip_first = true;
    TEST_ASSERT_TRUE(aisle_paper_swarm_figures(&swarm, &f));
    TEST_ASSERT_TRUE(aisle_vec2_distance(swarm.sample[0].p, start) > 0.01);
    TEST_ASSERT_TRUE(aisle_vec2_distance(swarm.sample[swarm.samples - 1U].p, goal) < 1e-9);
    TEST_ASSERT_TRUE(f.length < whole);
}

static void test_a_shut_hall_yields_no_way(void) {
    hall_add(5.0, 0.0, 5.5, 8.0);
    open_hall();
    TEST_ASSERT_FALSE(run(1));
    aisle_paper_figures f;
    TEST_ASSERT_TRUE(aisle_paper_swarm_figures(&swarm, &f));
    TEST_ASSERT_TRUE(f.violation > 0.0);
}

static void test_walls_have_no_circle(void) {
    hall_add(0.5, 0.1, 9.5, 0.3);
    hall_add(0.1, 0.5, 0.3, 4.52); // R is 2.012, a quarter of the shorter side 2
    open_hall();
    TEST_ASSERT_EQUAL(AISLE_OK, begin());
    TEST_ASSERT_EQUAL_UINT32(2, swarm.circles);
}

static void test_odd_options_are_brought_into_range_and_no_way_at_all_is_refused(void) {
    options.num_samples = 1;
    options.risk_weight = INFINITY;
    TEST_ASSERT_EQUAL(AISLE_OK, begin());
    TEST_ASSERT_EQUAL_UINT32(AISLE_PAPER_SAMPLES_MIN, swarm.samples);
    TEST_ASSERT_TRUE(swarm.beta == AISLE_PAPER_BETA_MAX);
    options.num_samples = 32767;
    TEST_ASSERT_EQUAL(AISLE_OK, begin());
    TEST_ASSERT_EQUAL_UINT32(AISLE_PAPER_SAMPLES_MAX, swarm.samples);
    TEST_ASSERT_EQUAL(AISLE_ERR_ARG, aisle_paper_swarm_start(&swarm, &space, &options, start, start));
    aisle_vec2 nowhere = {(double)NAN, 0.0};
    TEST_ASSERT_EQUAL(AISLE_ERR_ARG, aisle_paper_swarm_start(&swarm, &space, &options, start, nowhere));
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_the_figures_are_those_of_the_equations);
    RUN_TEST(test_the_best_way_runs_from_start_to_goal_through_the_bounds);
    RUN_TEST(test_most_seeds_find_a_way_between_two_shelves);
    RUN_TEST(test_a_larger_beta_buys_a_lower_oa_with_length);
    RUN_TEST(test_the_same_seed_gives_the_same_bits_however_the_run_is_cut);
    RUN_TEST(test_samples_begin_at_the_start_unless_the_flaw_is_asked_for);
    RUN_TEST(test_a_shut_hall_yields_no_way);
    RUN_TEST(test_walls_have_no_circle);
    RUN_TEST(test_odd_options_are_brought_into_range_and_no_way_at_all_is_refused);
    return UNITY_END();
}
