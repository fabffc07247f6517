// Orders against all permutations, or a table in long double, of lengths by the exact oracle of tests/support/optimum.h.
#include "plan/tour.h" // first: proves that the header stands alone

#include "hall.h"
#include "optimum.h"

#include <stdio.h>

enum { MOST = 14, CELLS = 262144 };

static const double R = 0.35; // m
static aisle_tour tour;
static aisle_tangent tangent;
static aisle_vec2 start, goals[AISLE_ORDER_MAX];
static uint32_t count;
static uint32_t units;
static long double truth[MOST + 1][MOST]; // row count: from the start

void setUp(void) {
    hall_begin(12.0, 8.0);
}
void tearDown(void) {}

static void open_hall(void) {
    const aisle_limits limits = {.cells = CELLS, .polygons = 256U, .vertices = 2048U};
    aisle_arena arena = hall_arena(24U << 20);
    memset(&tour, 0, sizeof tour);
    memset(&tangent, 0, sizeof tangent);
    aisle_arena shared = arena;
    aisle_tangent_carve(&tangent, &arena, &limits);
    aisle_tour_carve_shared(&tour, &shared);
    arena.used = arena.used > shared.used ? arena.used : shared.used;
    aisle_tour_carve(&tour, &arena);
    TEST_ASSERT_FALSE(arena.overflow || shared.overflow);
    hall_open(&arena, 0.05F);
}

static void random_hall(aisle_rng *rng) {
    hall_begin(12.0, 8.0);
    for (int i = 0; i < 9; i++) {
        aisle_vec2 p = uniform_point(rng, aisle_vec2_of(0.5, 0.5), aisle_vec2_of(10.0, 6.0));
        aisle_vec2 q = uniform_point(rng, aisle_vec2_of(0.3, 0.3), aisle_vec2_of(2.2, 2.2));
        hall_add(p.x, p.y, p.x + q.x, fmin(p.y + q.y, 7.8));
    }
    open_hall();
}

static aisle_vec2 free_place(aisle_rng *rng) {
    aisle_vec2 p;
    do {
        p = uniform_point(rng, aisle_vec2_of(0.4, 0.4), aisle_vec2_of(11.6, 7.6));
    } while (hall_disc_gap(p.x, p.y, R) < 0.001L);
    return p;
}

static void draw_stops(aisle_rng *rng, uint32_t n) {
    count = n;
    start = free_place(rng);
    for (uint32_t i = 0; i < n; i++) {
        goals[i] = free_place(rng);
    }
}

static aisle_status run(uint32_t slice) {
    units = 0;
    aisle_tour_start(&tour, &tangent, &hall_layout, R, start, goals, count);
    aisle_status st;
    do {
        uint32_t before = units;
        st = aisle_tour_step(&tour, slice, &units);
        TEST_ASSERT_TRUE(slice > UINT32_MAX / 2U || units - before < slice + 2000U);
    } while (st == AISLE_BUSY);
    return st;
}

// ---- judge

static optimum_world *oracle(void) {
    static optimum_point corners[HALL_BOXES_MAX][4];
    static optimum_polygon boxes[HALL_BOXES_MAX];
    const double bounds[4] = {R, R, hall_width - R, hall_height - R};
    for (int i = 0; i < hall_count; i++) {
        const hall_box *b = &hall_boxes[i];
        const optimum_point p[4] = {{b->x0, b->y0}, {b->x1, b->y0}, {b->x1, b->y1}, {b->x0, b->y1}};
        memcpy(corners[i], p, sizeof p);
        boxes[i] = (optimum_polygon){corners[i], 4};
    }
    return optimum_polygons(R, bounds, boxes, (size_t)hall_count);
}

static void learn_truth(void) {
    optimum_world *world = oracle();
    for (uint32_t i = 0; i <= count; i++) {
        for (uint32_t j = 0; j < count; j++) {
            aisle_vec2 p = i == count ? start : goals[i];
            optimum_path path = optimum_shortest(world, (optimum_point){p.x, p.y},
                                                 (optimum_point){goals[j].x, goals[j].y}, (double)INFINITY);
            truth[i][j] = (long double)path.length;
            optimum_path_free(&path);
        }
    }
    optimum_free(world);
}

static long double length_of(const uint8_t *order) {
    long double sum = 0.0L;
    uint32_t from = count;
    uint32_t seen = 0;
    for (uint32_t i = 0; i < count; i++) {
        TEST_ASSERT_TRUE(order[i] < count && (seen >> order[i] & 1U) == 0U);
        seen |= 1U << order[i];
        sum += truth[from][order[i]];
        from = order[i];
    }
    return sum;
}

static long double shortest_of_all(void) { // of ways over all of a set, backwards from the end
    static long double table[MOST + 1][1U << MOST];
    for (uint32_t set = 0; set < 1U << count; set++) {
        for (uint32_t at = 0; at <= count; at++) {
            table[at][set] = set == 0U ? 0.0L : (long double)INFINITY;
            for (uint32_t next = 0; next < count; next++) {
                if ((set >> next & 1U) != 0U && next != at) {
                    table[at][set] = fminl(table[at][set], truth[at][next] + table[next][set & ~(1U << next)]);
                }
            }
        }
    }
    return table[count][(1U << count) - 1U];
}

static bool all_connected(void) {
    for (uint32_t j = 0; j < count; j++) {
        if (isinf(truth[count][j])) {
            return false;
        }
    }
    return true;
}

// ---- tests

static void test_the_order_is_the_shortest_by_the_oracles_ways(void) {
    int judged = 0;
    int spared = 0;
    int pairs = 0;
    for (uint64_t seed = 0; seed < 60; seed++) {
        aisle_rng rng = aisle_rng_seed(seed);
        random_hall(&rng);
        draw_stops(&rng, 1U + aisle_rng_below(&rng, 12U));
        learn_truth();
        aisle_status st = run(UINT32_MAX);
        TEST_ASSERT_EQUAL(all_connected() ? AISLE_OK : AISLE_PARTIAL, st);
        if (st == AISLE_OK) {
            TEST_ASSERT_TRUE(fabsl(length_of(tour.order) - shortest_of_all()) < 1e-6L);
            TEST_ASSERT_FALSE(tour.is_rough);
            judged++;
            pairs += (int)(count * (count + 1U) / 2U);
            spared += (int)(count * (count + 1U) / 2U - tour.searches);
        } else {
            TEST_ASSERT_TRUE(isinf(truth[count][tour.unreachable]));
        }
    }
    printf("%d orders, %d of %d pairs not searched\n", judged, spared, pairs);
    TEST_ASSERT_GREATER_THAN_INT(40, judged);
    TEST_ASSERT_GREATER_THAN_INT(pairs / 4, spared);
}

static void test_a_wall_makes_the_order_another_one_than_by_beelines(void) {
    hall_add(1.0, 3.9, 12.0, 4.1); // open at the left end only
    open_hall();
    start = aisle_vec2_of(10.0, 3.0);
    goals[0] = aisle_vec2_of(10.0, 5.0); // 2 m away, behind the wall
    goals[1] = aisle_vec2_of(6.0, 2.0);
    goals[2] = aisle_vec2_of(3.0, 6.0);
    count = 3;
    TEST_ASSERT_EQUAL(AISLE_OK, run(UINT32_MAX));
    const uint8_t expected[] = {1, 2, 0};
    TEST_ASSERT_EQUAL_MEMORY(expected, tour.order, 3);
}

static void test_a_goal_that_no_way_leads_to_is_found_whichever_pair_is_asked_first(void) {
    hall_add(8.0, 0.0, 8.2, 4.0); // a room without a door
    hall_add(8.0, 4.0, 12.0, 4.2);
    open_hall();
    aisle_rng rng = aisle_rng_seed(3);
    for (uint32_t n = 2; n <= 14; n++) {
        for (uint32_t closed = 0; closed < n; closed++) {
            count = n;
            for (uint32_t i = 0; i <= n; i++) {
                aisle_vec2 p = uniform_point(&rng, aisle_vec2_of(0.5, 0.5), aisle_vec2_of(7.0, 7.0));
                *(i == n ? &start : &goals[i]) = p;
            }
            goals[closed] = aisle_vec2_of(10.0, 2.0);
            TEST_ASSERT_EQUAL(AISLE_PARTIAL, run(UINT32_MAX));
            TEST_ASSERT_EQUAL_UINT32(closed, tour.unreachable);
        }
    }
}

static void test_fourteen_goals_come_close_to_the_shortest(void) {
    double worst = 1.0;
    for (uint64_t seed = 0; seed < 6; seed++) {
        aisle_rng rng = aisle_rng_seed(500 + seed);
        random_hall(&rng);
        draw_stops(&rng, 14);
        learn_truth();
        if (!all_connected()) {
            continue;
        }
        TEST_ASSERT_EQUAL(AISLE_OK, run(UINT32_MAX));
        worst = fmax(worst, (double)(length_of(tour.order) / shortest_of_all()));
    }
    printf("14 goals: worst %.4f of the shortest\n", worst);
    TEST_ASSERT_TRUE(worst < 1.01);
}

static void test_what_it_counts_with_is_what_the_oracle_measures(void) {
    aisle_rng rng = aisle_rng_seed(77);
    random_hall(&rng);
    draw_stops(&rng, 13);
    learn_truth();
    TEST_ASSERT_EQUAL(AISLE_OK, run(UINT32_MAX));
    for (uint32_t i = 0; i <= count; i++) {
        for (uint32_t j = 0; j < count; j++) {
            long double cost = (long double)tour.cost[i * count + j];
            bool known = (tour.known[i] >> j & 1U) != 0U;
            TEST_ASSERT_TRUE(i == j || cost <= truth[i][j] + 1e-6L); // a lower bound
            TEST_ASSERT_TRUE(!known || fabsl(cost - truth[i][j]) < 1e-6L);
        }
    }
    TEST_ASSERT_TRUE(fabsl((long double)tour.search.value - length_of(tour.order)) < 1e-6L); // all its ways are known
}

static void test_any_slicing_gives_the_same_order_and_units(void) {
    static const uint32_t sizes[] = {2, 9, 12, 20};
    for (int i = 0; i < 4; i++) {
        aisle_rng rng = aisle_rng_seed(900);
        random_hall(&rng);
        draw_stops(&rng, sizes[i]);
        aisle_status st = run(UINT32_MAX);
        uint32_t whole = units;
        uint8_t order[AISLE_ORDER_MAX];
        memcpy(order, tour.order, sizeof order);
        for (uint32_t slice = 1; slice < 3000; slice = slice * 7 + 2) {
            TEST_ASSERT_EQUAL(st, run(slice));
            TEST_ASSERT_EQUAL_UINT32(whole, units);
            TEST_ASSERT_EQUAL_MEMORY(order, tour.order, sizes[i]);
        }
    }
}

static void test_goals_on_the_start_and_on_each_other_cost_nothing(void) {
    open_hall();
    start = aisle_vec2_of(2.0, 2.0);
    goals[0] = aisle_vec2_of(9.0, 2.0);
    goals[1] = start;
    goals[2] = aisle_vec2_of(5.0, 2.0);
    goals[3] = goals[2];
    count = 4;
    TEST_ASSERT_EQUAL(AISLE_OK, run(UINT32_MAX));
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 7.0, tour.search.value);
    TEST_ASSERT_EQUAL_UINT8(1, tour.order[0]);
    TEST_ASSERT_EQUAL_UINT8(0, tour.order[3]);
}

static void test_left_early_the_order_is_a_permutation_and_at_first_the_given_one(void) {
    aisle_rng rng = aisle_rng_seed(31);
    random_hall(&rng);
    draw_stops(&rng, 12);
    aisle_tour_start(&tour, &tangent, &hall_layout, R, start, goals, count);
    for (uint8_t i = 0; i < 12; i++) {
        TEST_ASSERT_EQUAL_UINT8(i, tour.order[i]);
    }
    units = 0;
    while (aisle_tour_step(&tour, 1, &units) == AISLE_BUSY) {
        uint32_t seen = 0;
        for (uint32_t i = 0; i < 12; i++) {
            seen |= 1U << tour.order[i];
        }
        TEST_ASSERT_EQUAL_UINT32(0xFFFU, seen);
    }
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_the_order_is_the_shortest_by_the_oracles_ways);
    RUN_TEST(test_a_wall_makes_the_order_another_one_than_by_beelines);
    RUN_TEST(test_a_goal_that_no_way_leads_to_is_found_whichever_pair_is_asked_first);
    RUN_TEST(test_fourteen_goals_come_close_to_the_shortest);
    RUN_TEST(test_what_it_counts_with_is_what_the_oracle_measures);
    RUN_TEST(test_any_slicing_gives_the_same_order_and_units);
    RUN_TEST(test_goals_on_the_start_and_on_each_other_cost_nothing);
    RUN_TEST(test_left_early_the_order_is_a_permutation_and_at_first_the_given_one);
    return UNITY_END();
}
