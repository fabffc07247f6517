#include "plan/togo.h"

#include "hall.h"

enum { CELLS = 65536 };

static aisle_togo togo;

static void open_hall(void) {
    aisle_arena arena = hall_arena(HALL_BLOCK);
    aisle_togo_carve(&togo, &arena, hall_limits.cells);
    hall_open(&arena, 0.05F);
}

static aisle_status search(double reach, aisle_vec2 start, aisle_vec2 goal, uint32_t slice, uint32_t *spent) {
    aisle_status st;
    *spent = 0;
    aisle_togo_start(&togo, aisle_layout_grid(&hall_layout), reach, start, goal);
    while ((st = aisle_togo_step(&togo, slice, spent)) == AISLE_BUSY) {
    }
    return st;
}

void setUp(void) {
    hall_begin(20.0, 12.0);
    hall_add(9.5, 0.0, 10.5, 10.0); // a wall, the way about its end at y = 10
    open_hall();
}
void tearDown(void) {}

// Through (10, 10 + reach) about: the exact way about two corners, by hand.
static double about_the_wall(aisle_vec2 p, aisle_vec2 q) {
    return hypot(9.5 - p.x, 10.0 - p.y) + 1.0 + hypot(q.x - 10.5, q.y - 10.0);
}

static void test_it_is_the_way_within_a_tenth_and_two_cells(void) {
    uint32_t spent;
    const aisle_vec2 start = {2.0, 2.0}, goal = {18.0, 3.0};
    TEST_ASSERT_EQUAL(AISLE_OK, search(0.5, start, goal, 1000, &spent));
    for (uint64_t s = 0; s < 300; s++) {
        aisle_rng rng = aisle_rng_seed(s);
        aisle_vec2 p = uniform_point(&rng, aisle_vec2_of(1.0, 1.0), aisle_vec2_of(19.0, 9.0));
        double way = p.x > 11.5 ? aisle_vec2_distance(p, goal) : about_the_wall(p, goal);
        if (p.x < 8.5 || p.x > 11.5) {
            double told = aisle_togo_at(&togo, p);
            TEST_ASSERT_TRUE(told >= way - 0.6 && told <= 1.09 * way + 1.5); // the disc keeps 0.5 m off the corners
        }
    }
    TEST_ASSERT_TRUE(aisle_togo_at(&togo, start) > aisle_togo_at(&togo, aisle_vec2_of(5.0, 8.0)));
}

static void test_ending_at_the_start_it_knows_all_that_is_no_farther_and_little_more(void) {
    static double all[120][200];
    const aisle_vec2 start = {11.5, 8.0}, goal = {18.0, 3.0};
    uint32_t whole, spent = 0;
    TEST_ASSERT_EQUAL(AISLE_OK, search(0.5, start, goal, 1000, &whole));
    const double far = aisle_togo_at(&togo, start);
    for (int iy = 0; iy < 120; iy++) {
        for (int ix = 0; ix < 200; ix++) {
            all[iy][ix] = aisle_togo_at(&togo, aisle_vec2_of(0.1 * ix + 0.05, 0.1 * iy + 0.05));
        }
    }
    aisle_togo_start(&togo, aisle_layout_grid(&hall_layout), 0.5, start, goal);
    aisle_togo_end_at_start(&togo);
    while (aisle_togo_step(&togo, 7, &spent) == AISLE_BUSY) {
    }
    for (int iy = 0; iy < 120; iy++) {
        for (int ix = 0; ix < 200; ix++) {
            const double told = aisle_togo_at(&togo, aisle_vec2_of(0.1 * ix + 0.05, 0.1 * iy + 0.05));
            TEST_ASSERT_TRUE(all[iy][ix] > far + 1e-9 || !(fabs(told - all[iy][ix]) > 0.0));
        }
    }
    TEST_ASSERT_TRUE(4U * spent < 3U * whole);
}

static void test_what_the_disc_cannot_reach_is_infinite(void) {
    uint32_t spent;
    hall_begin(20.0, 12.0);
    hall_add(9.5, 0.0, 10.5, 11.4); // leaves 0.6 m
    open_hall();
    TEST_ASSERT_EQUAL(AISLE_PARTIAL, search(0.5, aisle_vec2_of(2.0, 2.0), aisle_vec2_of(18.0, 3.0), 1000, &spent));
    TEST_ASSERT_FALSE(aisle_togo_at(&togo, aisle_vec2_of(2.0, 2.0)) < (double)INFINITY);
    TEST_ASSERT_EQUAL(AISLE_OK, search(0.28, aisle_vec2_of(2.0, 2.0), aisle_vec2_of(18.0, 3.0), 1000, &spent));
}

static void test_slices_change_nothing(void) {
    static uint16_t whole[CELLS];
    uint32_t spent, sliced;
    const aisle_vec2 start = {2.0, 2.0}, goal = {18.0, 3.0};
    TEST_ASSERT_EQUAL(AISLE_OK, search(0.5, start, goal, UINT32_MAX, &spent));
    uint32_t cells = togo.w * togo.h;
    TEST_ASSERT_TRUE(cells <= CELLS);
    memcpy(whole, togo.cost, cells * sizeof whole[0]);
    TEST_ASSERT_EQUAL(AISLE_OK, search(0.5, start, goal, 1, &sliced));
    TEST_ASSERT_EQUAL_UINT32(spent, sliced);
    TEST_ASSERT_EQUAL_MEMORY(whole, togo.cost, cells * sizeof whole[0]);
}

static void test_a_map_of_more_cells_than_it_holds_is_seen_coarser(void) {
    uint32_t spent;
    aisle_arena arena = hall_arena(HALL_BLOCK);
    aisle_togo_carve(&togo, &arena, 4096U); // 512 cells of its own
    hall_open(&arena, 0.05F);
    TEST_ASSERT_EQUAL(AISLE_OK, search(0.5, aisle_vec2_of(2.0, 2.0), aisle_vec2_of(18.0, 3.0), 100, &spent));
    TEST_ASSERT_TRUE(togo.w * togo.h <= togo.capacity && togo.size > AISLE_TOGO_SIDE);
    double way = about_the_wall(aisle_vec2_of(2.0, 2.0), aisle_vec2_of(18.0, 3.0));
    TEST_ASSERT_DOUBLE_WITHIN(0.15 * way, way, aisle_togo_at(&togo, aisle_vec2_of(2.0, 2.0)));
}

// Boxes on both sides leave a lane of 1.6 m along y = 6; the way above them is longer and clear.
static void test_dear_steps_are_gone_round_where_that_is_cheaper(void) {
    static const uint32_t dears[4] = {1, 2, 5, AISLE_TOGO_DEAR_MAX};
    static const double radius = 0.5, clear = 1.2, lane = 10.0;
    const aisle_vec2 start = {2.0, 6.0}, goal = {18.0, 6.0};
    hall_begin(20.0, 20.0);
    hall_add(5.0, 2.0, 5.0 + lane, 5.2);
    hall_add(5.0, 6.8, 5.0 + lane, 8.0);
    open_hall();
    for (int i = 0; i < 4; i++) {
        const double through = 16.0 + (dears[i] - 1.0) * lane, round = 2.0 * hypot(3.0, 3.2) + lane;
        uint32_t spent = 0;
        aisle_status st;
        aisle_togo_start(&togo, aisle_layout_grid(&hall_layout), radius, start, goal);
        aisle_togo_keep_clear(&togo, clear, dears[i]);
        while ((st = aisle_togo_step(&togo, 1000, &spent)) == AISLE_BUSY) {
        }
        TEST_ASSERT_EQUAL(AISLE_OK, st);
        const double told = aisle_togo_at(&togo, start), best = aisle_min(through, round);
        TEST_ASSERT_TRUE(told >= best - 0.6 && told <= 1.09 * best + 2.0);
        if (dears[i] < AISLE_TOGO_DEAR_MAX) { // the search came there: half the lane, whichever way is best
            const double inside = aisle_togo_at(&togo, aisle_vec2_of(10.0, 6.0));
            TEST_ASSERT_DOUBLE_WITHIN(1.0 + 0.5 * dears[i], 5.0 * dears[i] + 3.0, inside);
        }
    }
}

static aisle_status search_closed(aisle_vec2 a, aisle_vec2 b, double radius) {
    const aisle_vec2 start = {2.0, 2.0}, goal = {18.0, 3.0};
    aisle_status st;
    uint32_t spent = 0;
    aisle_togo_start(&togo, aisle_layout_grid(&hall_layout), 0.5, start, goal);
    aisle_togo_close(&togo, a, b, radius);
    while ((st = aisle_togo_step(&togo, 1000, &spent)) == AISLE_BUSY) {
    }
    return st;
}

static void test_places_closed_are_gone_round(void) {
    const aisle_vec2 start = {2.0, 2.0};
    TEST_ASSERT_EQUAL(AISLE_OK, search_closed(aisle_vec2_of(19.5, 11.5), aisle_vec2_of(19.5, 11.5), 0.1));
    const double open = aisle_togo_at(&togo, start);
    TEST_ASSERT_EQUAL(AISLE_OK, search_closed(aisle_vec2_of(6.0, 0.0), aisle_vec2_of(6.0, 9.0), 1.0));
    TEST_ASSERT_TRUE(aisle_togo_at(&togo, start) > open + 0.5);
    TEST_ASSERT_FALSE(aisle_togo_at(&togo, aisle_vec2_of(6.0, 5.0)) < (double)INFINITY);
    aisle_vec2 p = start, last = start;
    for (int i = 0; i < 400 && aisle_togo_next(&togo, p, &p); i++, last = p) {
        TEST_ASSERT_TRUE(aisle_togo_at(&togo, p) < aisle_togo_at(&togo, last));
        TEST_ASSERT_TRUE(hall_point_segment(p, aisle_vec2_of(6.0, 0.0), aisle_vec2_of(6.0, 9.0)) >= 1.0);
    }
    TEST_ASSERT_TRUE(aisle_togo_at(&togo, p) <= 0.0); // it came to the goal's cell
}

static void test_a_shut_way_and_a_shut_goal_are_not_reached(void) {
    TEST_ASSERT_EQUAL(AISLE_PARTIAL, search_closed(aisle_vec2_of(10.0, 9.0), aisle_vec2_of(10.0, 12.0), 1.0));
    TEST_ASSERT_EQUAL(AISLE_PARTIAL, search_closed(aisle_vec2_of(18.0, 3.0), aisle_vec2_of(18.0, 3.0), 0.4));
    TEST_ASSERT_FALSE(aisle_togo_at(&togo, aisle_vec2_of(18.0, 3.0)) < (double)INFINITY);
    TEST_ASSERT_EQUAL(AISLE_OK,
                      search_closed(aisle_vec2_of(2.0, 2.0), aisle_vec2_of(2.0, 2.0), 0.1)); // the start's own
}

typedef struct closure {
    aisle_vec2 a, b;
    double radius;
} closure;

// Closes places before the first step, or one by one after each search.
static aisle_status search_with(aisle_vec2 start, aisle_vec2 goal, bool ends, const closure *c, uint32_t n,
                                bool by_and_by, uint32_t *spent) {
    aisle_status st = AISLE_OK;
    *spent = 0;
    aisle_togo_start(&togo, aisle_layout_grid(&hall_layout), 0.5, start, goal);
    if (ends) {
        aisle_togo_end_at_start(&togo);
    }
    for (uint32_t i = 0; i < n; i++) {
        while (by_and_by && (st = aisle_togo_step(&togo, 3, spent)) == AISLE_BUSY) {
        }
        aisle_togo_close(&togo, c[i].a, c[i].b, c[i].radius);
    }
    while ((st = aisle_togo_step(&togo, 1000, spent)) == AISLE_BUSY) {
    }
    return st;
}

static void test_what_is_closed_by_and_by_is_as_if_it_had_been_closed_at_once(void) {
    static uint16_t once[CELLS];
    uint32_t unreached = 0, spent_once = 0, spent_by_and_by = 0;
    for (uint64_t s = 0; s < 300; s++) {
        aisle_rng rng = aisle_rng_seed(s);
        const aisle_vec2 start = uniform_point(&rng, aisle_vec2_of(1.0, 1.0), aisle_vec2_of(8.5, 11.0));
        const aisle_vec2 goal = uniform_point(&rng, aisle_vec2_of(11.5, 1.0), aisle_vec2_of(19.0, 11.0));
        const bool ends = s % 3 > 0;
        closure c[4];
        for (int i = 0; i < 4; i++) {
            const aisle_vec2 at = uniform_point(&rng, aisle_vec2_of(0.0, 0.0), aisle_vec2_of(20.0, 12.0));
            const aisle_vec2 by = uniform_point(&rng, aisle_vec2_of(-2.0, -2.0), aisle_vec2_of(2.0, 2.0));
            c[i] = (closure){at, aisle_vec2_add(at, by), uniform(&rng, 0.1, 0.9)};
        }
        uint32_t spent;
        const aisle_status st = search_with(start, goal, ends, c, 4, false, &spent);
        const uint32_t cells = togo.w * togo.h;
        const double far = aisle_togo_at(&togo, start);
        const uint32_t known = ends && st == AISLE_OK ? (uint32_t)(far / togo.size * 5.0 + 0.5) : AISLE_TOGO_NONE - 1U;
        TEST_ASSERT_TRUE(cells <= CELLS);
        memcpy(once, togo.cost, cells * sizeof once[0]);
        spent_once += spent;
        TEST_ASSERT_EQUAL(st, search_with(start, goal, ends, c, 4, true, &spent));
        spent_by_and_by += spent;
        for (uint32_t i = 0; i < cells; i++) {
            // 0, not reached or closed: none can be entered
            const uint16_t was = once[i] == AISLE_TOGO_NONE ? 0 : once[i];
            const uint16_t is = togo.cost[i] == AISLE_TOGO_NONE ? 0 : togo.cost[i];
            TEST_ASSERT_TRUE(was == is || (was > known && (is > known || is == 0)) || (was == 0 && is > known));
        }
        unreached += st == AISLE_PARTIAL ? 1U : 0U;
    }
    TEST_ASSERT_TRUE(unreached > 10U && unreached < 200U);
    TEST_ASSERT_TRUE(spent_by_and_by < 4U * spent_once); // and not five times
}

static aisle_status search_insisting(double reach, aisle_vec2 start, aisle_vec2 goal) {
    aisle_status st;
    uint32_t spent = 0;
    aisle_togo_start(&togo, aisle_layout_grid(&hall_layout), reach, start, goal);
    aisle_togo_insist(&togo, reach);
    while ((st = aisle_togo_step(&togo, 1000, &spent)) == AISLE_BUSY) {
    }
    return st;
}

static void test_insisting_every_step_between_centres_has_the_room(void) {
    for (int i = 0; i < 8; i++) {
        hall_add(1.5 + 2.1 * i, 4.0 + 0.31 * i, 2.6 + 2.1 * i, 6.0 + 0.27 * i);
    }
    open_hall();
    for (uint64_t s = 0; s < 60; s++) {
        aisle_rng rng = aisle_rng_seed(s);
        const double reach = uniform(&rng, 0.001, 0.6);
        const aisle_vec2 start = uniform_point(&rng, aisle_vec2_of(0.7, 0.7), aisle_vec2_of(8.8, 3.3));
        aisle_vec2 p, q;
        TEST_ASSERT_EQUAL(AISLE_OK, search_insisting(reach, start, aisle_vec2_of(18.0, 11.0)));
        bool more = aisle_togo_next(&togo, start, &p);
        TEST_ASSERT_TRUE(more);
        for (int i = 0; i < 400 && (more = aisle_togo_next(&togo, p, &q)); i++, p = q) {
            for (double f = 0.0; f <= 1.0; f += 0.05) {
                const aisle_vec2 at = aisle_vec2_lerp(p, q, f);
                const bool at_goal = aisle_togo_at(&togo, q) <= 0.0;
                TEST_ASSERT_TRUE(at_goal || hall_disc_gap(at.x, at.y, reach) >= 0.0L);
            }
        }
        TEST_ASSERT_TRUE(aisle_togo_at(&togo, p) <= 0.0);
    }
}

static void test_insisting_a_passage_of_just_the_width_is_not_seen(void) {
    const aisle_vec2 start = {2.0, 2.0}, goal = {18.0, 3.0}; // 2 m above the wall
    TEST_ASSERT_EQUAL(AISLE_OK, search_insisting(0.8, start, goal));
    TEST_ASSERT_EQUAL(AISLE_PARTIAL, search_insisting(0.99, start, goal));
    uint32_t spent;
    TEST_ASSERT_EQUAL(AISLE_OK, search(0.99, start, goal, 1000, &spent));
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_it_is_the_way_within_a_tenth_and_two_cells);
    RUN_TEST(test_ending_at_the_start_it_knows_all_that_is_no_farther_and_little_more);
    RUN_TEST(test_what_the_disc_cannot_reach_is_infinite);
    RUN_TEST(test_slices_change_nothing);
    RUN_TEST(test_a_map_of_more_cells_than_it_holds_is_seen_coarser);
    RUN_TEST(test_dear_steps_are_gone_round_where_that_is_cheaper);
    RUN_TEST(test_places_closed_are_gone_round);
    RUN_TEST(test_a_shut_way_and_a_shut_goal_are_not_reached);
    RUN_TEST(test_what_is_closed_by_and_by_is_as_if_it_had_been_closed_at_once);
    RUN_TEST(test_insisting_every_step_between_centres_has_the_room);
    RUN_TEST(test_insisting_a_passage_of_just_the_width_is_not_seen);
    return UNITY_END();
}
