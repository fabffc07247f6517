#include "plan/barrier.h"

#include "hall.h"
#include "plan/cost.h"

enum { SEEDS = 20 };

static aisle_space space;
static aisle_barrier barrier;
static aisle_objective objective;
static aisle_options_msg options;
static aisle_vec2 way[AISLE_BARRIER_POINTS];
static uint32_t spent;
static const aisle_vec2 start = {0.8, 1.0}, goal = {9.2, 7.0};
static const aisle_vec2 seed[] = {{0.8, 1.0}, {3.0, 6.0}, {7.0, 6.0}, {9.2, 7.0}};

// A wall across with an opening from y = 5 to 7.
void setUp(void) {
    hall_disc(0.3, 0.1F);
    hall_begin(10.0, 8.0);
    hall_add(4.8, -0.5, 5.2, 5.0);
    hall_add(4.8, 7.0, 5.2, 8.5);
    aisle_arena arena = hall_arena(24U << 20);
    memset(&space, 0, sizeof space);
    memset(&barrier, 0, sizeof barrier);
    aisle_space_carve(&space, &arena, hall_limits.cells);
    aisle_barrier_carve(&barrier, &arena);
    hall_open(&arena, 0.05F);
    aisle_space_begin(&space, &hall_layout, &hall_vehicle, AISLE_SPACE_FREE_TURN);
    options = (aisle_options_msg){.planner = AISLE_OPTIONS_GA, .objective = AISLE_OPTIONS_SAFEST};
    TEST_ASSERT_TRUE(aisle_objective_of(&options, &hall_vehicle, &objective));
}
void tearDown(void) {}

static void finish(uint32_t slice) {
    spent = 0;
    while (aisle_barrier_step(&barrier, slice, &spent) == AISLE_BUSY) {
        TEST_ASSERT_TRUE(aisle_ga_invariants_hold(&barrier.ga));
    }
}

static bool piece_is_free(aisle_vec2 a, aisle_vec2 b) { // by samples, 1 mm of doubt
    for (int k = 0; k <= 400; k++) {
        const aisle_vec2 p = aisle_vec2_lerp(a, b, k / 400.0);
        if ((double)hall_disc_gap(p.x, p.y, hall_vehicle.outer_radius) < hall_vehicle.margin) {
            return false;
        }
    }
    return true;
}

static void test_papers_stations_divide_the_longer_axis_evenly(void) {
    const float steps[3] = {0.0F, 0.5F, 3.0F};
    const uint32_t pieces[3] = {8, 17, 3}; // of 8.4 m
    for (int i = 0; i < 3; i++) {
        options.step = steps[i];
        TEST_ASSERT_EQUAL(AISLE_OK, aisle_barrier_start_paper(&barrier, &space, &options, start, goal));
        TEST_ASSERT_EQUAL_UINT32(pieces[i] + 1U, barrier.count);
        for (uint32_t k = 1; k + 1U < barrier.count; k++) {
            TEST_ASSERT_DOUBLE_WITHIN(1e-9, 0.8 + 8.4 * k / pieces[i], barrier.base[k].x);
        }
    }
    options.step = 0.0F;
    const aisle_vec2 up = {1.5, 7.5};
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_barrier_start_paper(&barrier, &space, &options, start, up)); // along y here
    TEST_ASSERT_EQUAL_UINT32(8, barrier.count);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 1.0 + 6.5 / 7.0, barrier.base[1].y);
    TEST_ASSERT_EQUAL_FLOAT((float)aisle_layout_bounds(&hall_layout).hi.x, barrier.hi[0]);
    TEST_ASSERT_EQUAL(AISLE_ERR_ARG, aisle_barrier_start_paper(&barrier, &space, &options, start, start));
}

static void test_papers_objective_is_length_and_a_thousand_for_each_piece_that_crosses(void) {
    for (options.seed = 1; options.seed <= SEEDS; options.seed++) {
        options.num_samples = 3; // generations: early bests cross
        TEST_ASSERT_EQUAL(AISLE_OK, aisle_barrier_start_paper(&barrier, &space, &options, start, goal));
        finish(50);
        TEST_ASSERT_EQUAL_UINT32(80 + 3 * 78, barrier.ga.evals);
        aisle_barrier_figures f;
        TEST_ASSERT_TRUE(aisle_barrier_figures_of(&barrier, &f));
        double length = 0.0;
        uint32_t crossing = 0;
        for (uint32_t k = 0; k + 1U < barrier.count; k++) {
            length += hypot(barrier.way[k + 1U].x - barrier.way[k].x, barrier.way[k + 1U].y - barrier.way[k].y);
            crossing += piece_is_free(barrier.way[k], barrier.way[k + 1U]) ? 0U : 1U;
        }
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, length, f.length);
        TEST_ASSERT_EQUAL_UINT32(crossing, f.crossing);
        TEST_ASSERT_FLOAT_WITHIN(1e-2F, (float)(length + 1000.0 * crossing), barrier.ga.best_cost.value);
        TEST_ASSERT_EQUAL_UINT32(crossing == 0U ? barrier.count : 0U, aisle_barrier_best(&barrier, way));
    }
}

static void test_what_is_bred_of_a_seed_is_free_and_never_worse_for_20_of_20_seeds(void) {
    double value = 0.0;
    for (int k = 0; k < 3; k++) {
        value += aisle_leg_cost(&space, &objective, seed[k], seed[k + 1], &spent);
    }
    for (options.seed = 1; options.seed <= SEEDS; options.seed++) {
        TEST_ASSERT_EQUAL(AISLE_OK, aisle_barrier_start(&barrier, &space, &objective, &options, seed, 4));
        finish(500);
        const uint32_t n = aisle_barrier_best(&barrier, way);
        TEST_ASSERT_TRUE(n >= 4U && n == barrier.count);
        TEST_ASSERT_EQUAL_MEMORY(&seed[0], &way[0], sizeof way[0]);
        TEST_ASSERT_EQUAL_MEMORY(&seed[3], &way[n - 1U], sizeof way[0]);
        for (uint32_t k = 0; k + 1U < n; k++) {
            TEST_ASSERT_TRUE(piece_is_free(way[k], way[k + 1U]));
        }
        TEST_ASSERT_TRUE((double)barrier.ga.best_cost.value <= value * 1.001);
    }
    TEST_ASSERT_TRUE((double)barrier.ga.best_cost.value < 0.995 * value); // and better here
}

static void test_any_slicing_gives_the_same_way(void) {
    aisle_vec2 whole[AISLE_BARRIER_POINTS];
    for (uint32_t slice = 100000; slice > 0U; slice /= 10U) {
        TEST_ASSERT_EQUAL(AISLE_OK, aisle_barrier_start(&barrier, &space, &objective, &options, seed, 4));
        finish(slice);
        const uint32_t n = aisle_barrier_best(&barrier, slice == 100000U ? whole : way);
        TEST_ASSERT_TRUE(slice == 100000U || memcmp(whole, way, n * sizeof way[0]) == 0);
    }
}

static void test_a_seed_that_is_not_free_or_too_short_is_not_begun(void) {
    const aisle_vec2 through[] = {{0.8, 1.0}, {9.2, 1.0}}, near[] = {{0.8, 1.0}, {0.9, 1.0}};
    TEST_ASSERT_EQUAL(AISLE_PARTIAL, aisle_barrier_start(&barrier, &space, &objective, &options, through, 2));
    TEST_ASSERT_EQUAL(AISLE_PARTIAL, aisle_barrier_start(&barrier, &space, &objective, &options, near, 2));
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_papers_stations_divide_the_longer_axis_evenly);
    RUN_TEST(test_papers_objective_is_length_and_a_thousand_for_each_piece_that_crosses);
    RUN_TEST(test_what_is_bred_of_a_seed_is_free_and_never_worse_for_20_of_20_seeds);
    RUN_TEST(test_any_slicing_gives_the_same_way);
    RUN_TEST(test_a_seed_that_is_not_free_or_too_short_is_not_begun);
    return UNITY_END();
}
