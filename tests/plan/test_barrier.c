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

// A wall across with an opening about y = 6.
static void draw_wall(double gap) {
    hall_begin(10.0, 8.0);
    hall_add(4.8, -0.5, 5.2, 6.0 - 0.5 * gap);
    hall_add(4.8, 6.0 + 0.5 * gap, 5.2, 8.5);
}

static void open_as(aisle_space_mode mode) {
    aisle_arena arena = hall_arena(24U << 20);
    memset(&space, 0, sizeof space);
    memset(&barrier, 0, sizeof barrier);
    aisle_space_carve(&space, &arena, hall_limits.cells);
    aisle_barrier_carve(&barrier, &arena);
    hall_open(&arena, 0.05F);
    aisle_space_begin(&space, &hall_layout, &hall_vehicle, mode);
    options = (aisle_options_msg){.planner = AISLE_OPTIONS_GA, .objective = AISLE_OPTIONS_SAFEST};
    TEST_ASSERT_TRUE(aisle_objective_of(&options, &hall_vehicle, &objective));
}

static void open_hall(double gap) {
    draw_wall(gap);
    open_as(AISLE_SPACE_FREE_TURN);
}

void setUp(void) {
    hall_disc(0.3, 0.1F);
    open_hall(2.0);
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

static aisle_vec2 unit_between(aisle_vec2 a, aisle_vec2 b) {
    const double norm = hypot(b.x - a.x, b.y - a.y);
    return (aisle_vec2){(b.x - a.x) / norm, (b.y - a.y) / norm};
}

static void test_stations_of_a_seed_are_its_corners_and_no_farther_apart_than_the_step(void) {
    const float steps[3] = {0.0F, 0.5F, 2.0F};
    for (int i = 0; i < 3; i++) {
        options.step = steps[i];
        TEST_ASSERT_EQUAL(AISLE_OK, aisle_barrier_start(&barrier, &space, &objective, &options, seed, 4));
        const double step = steps[i] > 0.0F ? (double)steps[i] : AISLE_BARRIER_STEP;
        uint32_t corners = 0, needed = 1;
        for (int k = 0; k < 3; k++) {
            needed += (uint32_t)ceil(hypot(seed[k + 1].x - seed[k].x, seed[k + 1].y - seed[k].y) / step);
        }
        TEST_ASSERT_EQUAL_UINT32(needed, barrier.count);
        for (uint32_t k = 1; k + 1U < barrier.count; k++) {
            const aisle_vec2 in = unit_between(barrier.base[k - 1U], barrier.base[k]);
            const aisle_vec2 out = unit_between(barrier.base[k], barrier.base[k + 1U]);
            const aisle_vec2 across = barrier.across[k];
            TEST_ASSERT_TRUE(aisle_vec2_distance(barrier.base[k], barrier.base[k - 1U]) <= step + 1e-9);
            TEST_ASSERT_DOUBLE_WITHIN(1e-9, 1.0, aisle_vec2_length(across));
            TEST_ASSERT_DOUBLE_WITHIN(1e-9, 0.0, aisle_vec2_dot(across, in) + aisle_vec2_dot(across, out));
            corners += memcmp(&barrier.base[k], &seed[1], sizeof seed[1]) == 0 ||
                               memcmp(&barrier.base[k], &seed[2], sizeof seed[2]) == 0
                           ? 1U
                           : 0U;
            TEST_ASSERT_EQUAL_FLOAT(AISLE_BARRIER_REACH, barrier.hi[k - 1U]);
            TEST_ASSERT_EQUAL_FLOAT(-AISLE_BARRIER_REACH, barrier.lo[k - 1U]);
        }
        TEST_ASSERT_EQUAL_UINT32(2, corners);
    }
}

// Each of a station's two pieces may halve its offset, in each of the halvings.
static void test_repair_halves_offsets_a_few_times_and_then_drops_them(void) {
    uint32_t halved = 0, dropped = 0;
    open_hall(0.803); // 1.5 mm to either side
    for (options.seed = 1; options.seed <= SEEDS; options.seed++) {
        TEST_ASSERT_EQUAL(AISLE_OK, aisle_barrier_start(&barrier, &space, &objective, &options, seed, 4));
        for (aisle_status st = AISLE_BUSY; st == AISLE_BUSY;) {
            st = aisle_barrier_step(&barrier, 1, &spent); // one evaluation
            for (uint32_t k = 1; k + 1U < barrier.count; k++) {
                const double gene = (double)barrier.ga.x[k - 1U], share = barrier.offset[k] / gene;
                bool is_power = gene == 0.0 || barrier.offset[k] == 0.0;
                for (int h = 0; h <= 2 * (int)AISLE_BARRIER_HALVINGS; h++) {
                    is_power = is_power || share == ldexp(1.0, -h);
                }
                TEST_ASSERT_TRUE(is_power);
                dropped += gene != 0.0 && barrier.offset[k] == 0.0 ? 1U : 0U;
                halved += gene != 0.0 && barrier.offset[k] != 0.0 && share < 1.0 ? 1U : 0U;
            }
            for (uint32_t k = 0; options.seed == 1 && k + 1U < barrier.count; k++) {
                TEST_ASSERT_TRUE(piece_is_free(barrier.way[k], barrier.way[k + 1U]));
            }
        }
    }
    TEST_ASSERT_GREATER_THAN_UINT32(100, halved);
    TEST_ASSERT_GREATER_THAN_UINT32(100, dropped);
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

static void expect_free_and_never_worse(double gap, double share) {
    double value = 0.0;
    open_hall(gap);
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
    TEST_ASSERT_TRUE((double)barrier.ga.best_cost.value < share * value);
}

static void test_what_is_bred_of_a_seed_is_free_and_better_for_20_of_20_seeds(void) {
    expect_free_and_never_worse(2.0, 0.995);
    expect_free_and_never_worse(0.9, 1.0);
}

// Thin posts beside the seed, so that what was free may no longer be once it is drawn nearer: by the search's own sweeps.
static void test_every_way_looked_at_is_free_among_posts(void) {
    const aisle_vec2 straight[] = {{1.0, 4.0}, {9.0, 4.0}};
    uint32_t ways = 0, units = 0;
    hall_disc(0.03, 0.01F);
    for (options.seed = 1; options.seed <= SEEDS; options.seed++) {
        const int32_t at = options.seed;
        aisle_rng rng = aisle_rng_seed((uint64_t)at);
        hall_begin(10.0, 8.0);
        for (int k = 0; k < 60; k++) {
            const double x = uniform(&rng, 1.2, 8.8), off = uniform(&rng, 0.06, 0.5) * (k % 2 == 0 ? 1.0 : -1.0);
            hall_add(x, 4.0 + off - 0.005, x + 0.01, 4.0 + off + 0.005);
        }
        open_as(AISLE_SPACE_FREE_TURN);
        options.seed = at;
        TEST_ASSERT_EQUAL(AISLE_OK, aisle_barrier_start(&barrier, &space, &objective, &options, straight, 2));
        while (aisle_barrier_step(&barrier, 1, &spent) == AISLE_BUSY) {
            for (uint32_t k = 0; k + 1U < barrier.count; k++) {
                TEST_ASSERT_TRUE(aisle_space_sweep_free(&space, barrier.way[k], barrier.way[k + 1U], &units));
            }
            ways++;
        }
        TEST_ASSERT_TRUE(barrier.ga.evals - barrier.ga.last_improvement <= AISLE_BARRIER_STALL);
    }
    TEST_ASSERT_GREATER_THAN_UINT32(1000, ways);
}

static void test_a_body_held_along_its_way_is_bent_only_where_it_can_turn(void) {
    const aisle_vec2 straight[] = {{1.5, 6.0}, {8.5, 6.0}};
    uint32_t bent = 0;
    hall_rectangle(1.2, 0.6, 0.1F);
    draw_wall(1.2);
    open_as(AISLE_SPACE_ALONG);
    for (options.seed = 1; options.seed <= SEEDS; options.seed++) {
        TEST_ASSERT_EQUAL(AISLE_OK, aisle_barrier_start(&barrier, &space, &objective, &options, straight, 2));
        while (aisle_barrier_step(&barrier, 1, &spent) == AISLE_BUSY) {
            for (uint32_t k = 1; k + 1U < barrier.count; k++) {
                const aisle_vec2 p = barrier.way[k];
                const bool is_bent = fabs(barrier.offset[k]) > 0.0;
                TEST_ASSERT_TRUE(!is_bent || (double)hall_disc_gap(p.x, p.y, hall_vehicle.outer_radius) >= 0.1);
                bent += is_bent ? 1U : 0U;
            }
        }
    }
    TEST_ASSERT_GREATER_THAN_UINT32(1000, bent);
}

static void test_seeds_of_any_length_fit_the_stations_and_those_of_too_many_points_are_not_begun(void) {
    static aisle_vec2 zigzag[AISLE_BARRIER_POINTS];
    hall_begin(10.0, 8.0);
    open_as(AISLE_SPACE_FREE_TURN);
    for (uint32_t i = 0; i < AISLE_BARRIER_POINTS; i++) {
        zigzag[i] = aisle_vec2_of(0.6 + 0.13 * i, i % 2U == 0U ? 0.8 : 7.2);
    }
    const aisle_vec2 brief[] = {{1.0, 1.0}, {1.3, 1.0}};
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_barrier_start(&barrier, &space, &objective, &options, brief, 2));
    TEST_ASSERT_EQUAL_UINT32(3, barrier.count);
    for (uint32_t n = 2; n <= AISLE_BARRIER_STATIONS / 2U; n++) { // up to 200 m
        TEST_ASSERT_EQUAL(AISLE_OK, aisle_barrier_start(&barrier, &space, &objective, &options, zigzag, n));
        TEST_ASSERT_TRUE(barrier.count > n && barrier.count <= AISLE_BARRIER_POINTS);
        (void)aisle_barrier_step(&barrier, 1, &spent);
    }
    for (uint32_t n = AISLE_BARRIER_STATIONS / 2U + 1U; n <= AISLE_BARRIER_POINTS; n++) {
        TEST_ASSERT_EQUAL(AISLE_PARTIAL, aisle_barrier_start(&barrier, &space, &objective, &options, zigzag, n));
    }
}

// What asking costs is not counted, and a seed of its own gives a way of its own.
static void test_asking_changes_nothing_and_seeds_differ(void) {
    aisle_vec2 first[AISLE_BARRIER_POINTS];
    uint32_t work[2];
    for (int asks = 0; asks < 2; asks++) {
        TEST_ASSERT_EQUAL(AISLE_OK, aisle_barrier_start(&barrier, &space, &objective, &options, seed, 4));
        aisle_barrier_figures figures;
        spent = 0;
        while (aisle_barrier_step(&barrier, 50, &spent) == AISLE_BUSY) {
            TEST_ASSERT_TRUE(asks == 0 || aisle_barrier_figures_of(&barrier, &figures));
        }
        work[asks] = spent;
        TEST_ASSERT_TRUE(aisle_barrier_best(&barrier, first) > 0U);
    }
    TEST_ASSERT_EQUAL_UINT32(work[0], work[1]);
    options.seed = 7;
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_barrier_start(&barrier, &space, &objective, &options, seed, 4));
    finish(1000);
    TEST_ASSERT_TRUE(aisle_barrier_best(&barrier, way) > 0U);
    TEST_ASSERT_TRUE(memcmp(first, way, 4 * sizeof way[0]) != 0);
}

// Work is cut where it is told to be: an evaluation more at most.
static void test_a_step_spends_about_what_it_is_given(void) {
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_barrier_start(&barrier, &space, &objective, &options, seed, 4));
    for (aisle_status st = AISLE_BUSY; st == AISLE_BUSY;) {
        spent = 0;
        st = aisle_barrier_step(&barrier, 10, &spent);
        TEST_ASSERT_TRUE(st == AISLE_OK || spent >= 10U);
        TEST_ASSERT_LESS_THAN_UINT32(1000, spent);
    }
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
    RUN_TEST(test_stations_of_a_seed_are_its_corners_and_no_farther_apart_than_the_step);
    RUN_TEST(test_repair_halves_offsets_a_few_times_and_then_drops_them);
    RUN_TEST(test_papers_objective_is_length_and_a_thousand_for_each_piece_that_crosses);
    RUN_TEST(test_what_is_bred_of_a_seed_is_free_and_better_for_20_of_20_seeds);
    RUN_TEST(test_every_way_looked_at_is_free_among_posts);
    RUN_TEST(test_a_body_held_along_its_way_is_bent_only_where_it_can_turn);
    RUN_TEST(test_seeds_of_any_length_fit_the_stations_and_those_of_too_many_points_are_not_begun);
    RUN_TEST(test_asking_changes_nothing_and_seeds_differ);
    RUN_TEST(test_a_step_spends_about_what_it_is_given);
    RUN_TEST(test_any_slicing_gives_the_same_way);
    RUN_TEST(test_a_seed_that_is_not_free_or_too_short_is_not_begun);
    return UNITY_END();
}
