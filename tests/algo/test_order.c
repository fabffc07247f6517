// Exact orders against all permutations and against a table in long double; the local search against such tables and
// against a lower bound by 1-trees. None of it shares code with src/.
#include "algo/order.h" // first: proves that the header stands alone

#include "cases.h"
#include "unity.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

enum { MOST = 64, TABLE_MOST = 14, WORK = 12 * 4096 };

typedef enum kind { PLANE, UNEVEN, HOLES, CLUSTERS, ALIKE, KINDS } kind;

static const double NO_WAY = (double)INFINITY;
static double cost[(MOST + 1) * MOST];
static double work[WORK + 1]; // one canary behind it
static aisle_order_config cfg;
static aisle_order order;
static uint64_t draws;

void setUp(void) {
    memset(&order, 0, sizeof order);
    cfg = (aisle_order_config){.n = 5, .cost = cost, .kicks = 800};
    work[WORK] = 42.0;
    draws = 1;
}

void tearDown(void) {
    TEST_ASSERT_TRUE(work[WORK] == 42.0);
    TEST_ASSERT_TRUE(aisle_order_invariants_hold(&order));
}

// ---- instances

static double draw(void) { // in [0, 1)
    draws = draws * 6364136223846793005ULL + 1442695040888963407ULL;
    return (double)(draws >> 40) / 16777216.0;
}

static double place_x[MOST + 1], place_y[MOST + 1];

static void draw_places(uint32_t n, kind what) {
    double x = 0.0;
    double y = 0.0;
    for (uint32_t i = 0; i <= n; i++) {
        bool is_near = what == CLUSTERS && i % 6U != 0U;
        place_x[i] = is_near ? x + 4.0 * draw() : 100.0 * draw();
        place_y[i] = is_near ? y + 4.0 * draw() : 60.0 * draw();
        x = is_near ? x : place_x[i];
        y = is_near ? y : place_y[i];
    }
}

static void make(uint32_t n, kind what, uint64_t seed) {
    draws = seed * 2U + 1U;
    cfg.n = n;
    draw_places(n, what);
    for (uint32_t i = 0; i <= n; i++) {
        for (uint32_t j = 0; j < n; j++) {
            double c = hypot(place_x[i] - place_x[j], place_y[i] - place_y[j]);
            c = what == UNEVEN ? c * (0.3 + 2.0 * draw()) : c;
            c = what == HOLES ? (draw() < 0.4 ? NO_WAY : 100.0 * draw()) : c;
            c = what == ALIKE ? floor(3.0 * draw()) : c;
            cost[i * n + j] = i == j ? (double)NAN : c; // the diagonal is not read
        }
    }
}

static aisle_status run(uint32_t slice) {
    aisle_status st = aisle_order_start(&order, &cfg, work, WORK);
    TEST_ASSERT_EQUAL(AISLE_OK, st);
    do {
        uint32_t before = order.evals;
        st = aisle_order_step(&order, slice);
        TEST_ASSERT_TRUE(slice > UINT32_MAX / 2U || order.evals - before < slice + 2U * cfg.n * cfg.n);
        TEST_ASSERT_TRUE(aisle_order_invariants_hold(&order));
    } while (st == AISLE_BUSY);
    return st;
}

// ---- judges

static long double sum_of(const uint8_t *places) {
    long double sum = 0.0L;
    uint32_t from = cfg.n;
    uint64_t seen = 0;
    for (uint32_t i = 0; i < cfg.n; i++) {
        TEST_ASSERT_TRUE(places[i] < cfg.n && (seen >> places[i] & 1U) == 0U);
        seen |= 1ULL << places[i];
        sum += (long double)cost[from * cfg.n + places[i]];
        from = places[i];
    }
    return sum;
}

// Every permutation, by exchanges (Heap's method without recursion).
static long double least_of_all(void) {
    uint8_t places[8];
    uint32_t turn[8] = {0};
    for (uint32_t i = 0; i < cfg.n; i++) {
        places[i] = (uint8_t)i;
    }
    long double least = sum_of(places);
    for (uint32_t i = 0; i < cfg.n;) {
        if (turn[i] < i) {
            uint32_t with = i % 2U == 0U ? 0U : turn[i];
            uint8_t swap = places[with];
            places[with] = places[i];
            places[i] = swap;
            least = fminl(least, sum_of(places));
            turn[i]++;
            i = 0;
        } else {
            turn[i++] = 0;
        }
    }
    return least;
}

// From the end backwards: the cheapest way from a place over all of a set still to be visited.
static long double least_by_table(void) {
    static long double table[TABLE_MOST + 1][1U << TABLE_MOST];
    const uint32_t n = cfg.n;
    for (uint32_t set = 0; set < 1U << n; set++) {
        for (uint32_t at = 0; at <= n; at++) {
            table[at][set] = set == 0U ? 0.0L : (long double)INFINITY;
            for (uint32_t next = 0; next < n; next++) {
                if ((set >> next & 1U) != 0U && next != at) {
                    long double c = (long double)cost[at * n + next] + table[next][set & ~(1U << next)];
                    table[at][set] = fminl(table[at][set], c);
                }
            }
        }
    }
    return table[n][(1U << n) - 1U];
}

// Lower bound for symmetric costs by 1-trees (Held & Karp 1970): a tree over the start and all places, whose best end is
// free, with penalties at the nodes that drive the degrees to those of a path.
static double tree_with(const double *penalty, int32_t *degree) {
    const uint32_t n = cfg.n;
    double near[MOST + 1];
    uint32_t from[MOST + 1];
    bool in[MOST + 1] = {false};
    double sum = 0.0;
    in[n] = true;
    memset(degree, 0, (n + 1U) * sizeof *degree);
    for (uint32_t j = 0; j < n; j++) {
        near[j] = cost[n * n + j] + penalty[n] + penalty[j];
        from[j] = n;
    }
    for (uint32_t k = 0; k < n; k++) {
        uint32_t next = n;
        for (uint32_t j = 0; j < n; j++) {
            next = !in[j] && (next == n || near[j] < near[next]) ? j : next;
        }
        in[next] = true;
        sum += near[next];
        degree[next]++;
        degree[from[next]]++;
        for (uint32_t j = 0; j < n; j++) {
            if (!in[j] && cost[next * n + j] + penalty[next] + penalty[j] < near[j]) {
                near[j] = cost[next * n + j] + penalty[next] + penalty[j];
                from[j] = next;
            }
        }
    }
    return sum;
}

// Every path is such a tree with degree 1 at the start, 2 on the way and 1 at its last place.
static double bound_by_trees(double known) {
    const uint32_t n = cfg.n;
    double penalty[MOST + 1] = {0.0};
    int32_t degree[MOST + 1];
    double best = 0.0;
    double pace = 1.0;
    for (int round = 0; round < 400; round++) {
        double least = tree_with(penalty, degree) - penalty[n];
        uint32_t last = 0; // where a path may end: charged once less
        for (uint32_t j = 0; j < n; j++) {
            least -= 2.0 * penalty[j];
            last = penalty[j] < penalty[last] ? j : last;
        }
        least += penalty[last];
        best = fmax(best, least);
        double square = 0.0;
        for (uint32_t j = 0; j <= n; j++) {
            int32_t off = degree[j] - (j == n || j == last ? 1 : 2);
            square += (double)(off * off);
        }
        if (square < 0.5) {
            break;
        }
        pace *= 0.99;
        for (uint32_t j = 0; j <= n; j++) {
            penalty[j] += pace * (known - least) / square * (double)(degree[j] - (j == n || j == last ? 1 : 2));
        }
    }
    return best;
}

// ---- exact

static void test_up_to_eight_places_no_permutation_is_cheaper(void) {
    for (uint32_t n = 1; n <= 8; n++) {
        for (int what = 0; what < KINDS; what++) {
            for (uint64_t seed = 0; seed < CASES(n < 8 ? 12U : 3U); seed++) {
                make(n, (kind)what, seed);
                aisle_status st = run(UINT32_MAX);
                long double least = least_of_all();
                TEST_ASSERT_EQUAL(isinf(least) ? AISLE_PARTIAL : AISLE_OK, st);
                if (st == AISLE_OK) {
                    TEST_ASSERT_TRUE(fabsl(least - sum_of(order.order)) < 1e-9L);
                    TEST_ASSERT_TRUE(fabs(order.value - (double)least) < 1e-9);
                }
            }
        }
    }
}

static void test_nine_to_twelve_places_are_as_cheap_as_by_a_table_in_long_double(void) {
    for (uint32_t n = 9; n <= 12; n++) {
        for (int what = 0; what < KINDS; what++) {
            for (uint64_t seed = 0; seed < 2; seed++) {
                make(n, (kind)what, seed);
                TEST_ASSERT_EQUAL(AISLE_OK, run(UINT32_MAX));
                TEST_ASSERT_TRUE(fabsl(least_by_table() - sum_of(order.order)) < 1e-9L);
            }
        }
    }
}

static void test_what_cannot_be_gone_is_told_and_leaves_the_order_as_given(void) {
    make(6, PLANE, 3);
    for (uint32_t i = 0; i <= 6; i++) {
        cost[i * 6 + 4] = INFINITY; // nothing leads there
    }
    TEST_ASSERT_EQUAL(AISLE_PARTIAL, run(UINT32_MAX));
    TEST_ASSERT_TRUE(isinf(order.value));
    for (uint8_t i = 0; i < 6; i++) {
        TEST_ASSERT_EQUAL_UINT8(i, order.order[i]);
    }
    TEST_ASSERT_EQUAL(AISLE_PARTIAL, aisle_order_step(&order, 1000)); // again
}

static void test_a_place_that_nothing_leaves_comes_last(void) {
    make(9, PLANE, 5);
    for (uint32_t j = 0; j < 9; j++) {
        cost[2 * 9 + j] = INFINITY;
    }
    TEST_ASSERT_EQUAL(AISLE_OK, run(UINT32_MAX));
    TEST_ASSERT_EQUAL_UINT8(2, order.order[8]);
    TEST_ASSERT_TRUE(fabsl(least_by_table() - sum_of(order.order)) < 1e-9L);
}

static void test_ties_go_to_the_lowest_index(void) {
    for (uint32_t i = 0; i < 7U * 6U; i++) {
        cost[i] = 1.0;
    }
    cfg.n = 6;
    TEST_ASSERT_EQUAL(AISLE_OK, run(UINT32_MAX));
    const uint8_t expected[] = {5, 4, 3, 2, 1, 0}; // last place first, then the ones before it
    TEST_ASSERT_EQUAL_MEMORY(expected, order.order, 6);
}

// ---- local search

static void test_thirteen_and_fourteen_places_come_out_exact_on_nearly_all_seeds(void) {
    int runs = 0;
    int hits = 0;
    double worst = 1.0;
    for (uint32_t n = 13; n <= 14; n++) {
        for (int what = 0; what < KINDS; what++) {
            for (uint64_t seed = 0; seed < (n < 14 ? 2U : 1U); seed++) {
                make(n, (kind)what, seed);
                TEST_ASSERT_EQUAL(AISLE_OK, run(UINT32_MAX));
                long double ratio = sum_of(order.order) / fmaxl(least_by_table(), 1e-9L);
                runs++;
                hits += ratio < 1.0L + 1e-9L ? 1 : 0;
                worst = fmax(worst, (double)ratio);
            }
        }
    }
    printf("13 and 14 places: %d of %d exact, worst %.4f\n", hits, runs, worst);
    TEST_ASSERT_TRUE(hits >= runs - 1);
    TEST_ASSERT_TRUE(worst < 1.04);
}

static void test_up_to_64_places_come_within_a_few_hundredths_of_a_lower_bound(void) {
    static const uint32_t sizes[] = {20, 32, 48, 64};
    double sum = 0.0;
    double worst = 1.0;
    for (int i = 0; i < 16; i++) {
        make(sizes[i % 4], i % 8 < 4 ? PLANE : CLUSTERS, 100U + (uint64_t)i);
        TEST_ASSERT_EQUAL(AISLE_OK, run(UINT32_MAX));
        double ratio = (double)sum_of(order.order) / bound_by_trees((double)sum_of(order.order));
        TEST_ASSERT_TRUE(ratio >= 1.0 - 1e-9);
        sum += ratio;
        worst = fmax(worst, ratio);
    }
    printf("20 to 64 places: %.4f of the bound in the mean, worst %.4f\n", sum / 16.0, worst);
    TEST_ASSERT_TRUE(worst < 1.03);
    TEST_ASSERT_TRUE(sum / 16.0 < 1.0085);
}

static void test_48_places_with_uneven_costs_come_close_to_the_best_known(void) {
    // of make(48, UNEVEN, 1000 + i): the least of three runs of 4000 kicks
    static const double known[] = {318.88, 332.78, 309.66, 277.42, 374.59, 385.51, 341.29, 287.59,
                                   321.08, 330.32, 354.24, 277.08, 352.87, 337.62, 334.73, 345.71};
    double sum = 0.0;
    double worst = 1.0;
    for (uint64_t i = 0; i < 16; i++) {
        make(48, UNEVEN, 1000U + i);
        TEST_ASSERT_EQUAL(AISLE_OK, run(UINT32_MAX));
        double ratio = (double)sum_of(order.order) / known[i];
        sum += ratio;
        worst = fmax(worst, ratio);
    }
    printf("48 uneven places: %.4f of the best known in the mean, worst %.4f\n", sum / 16.0, worst);
    TEST_ASSERT_TRUE(worst < 1.03);
    TEST_ASSERT_TRUE(sum / 16.0 < 1.008);
}

static void test_an_order_without_a_way_somewhere_is_taken_only_if_there_is_no_other(void) {
    make(40, HOLES, 9);
    TEST_ASSERT_EQUAL(AISLE_OK, run(UINT32_MAX)); // two of five pairs have no way
    TEST_ASSERT_TRUE(isfinite(sum_of(order.order)));
    for (uint32_t i = 0; i <= 40; i++) {
        cost[i * 40 + 7] = INFINITY;
    }
    TEST_ASSERT_EQUAL(AISLE_PARTIAL, run(UINT32_MAX));
    TEST_ASSERT_TRUE(isinf(sum_of(order.order)));
}

static void turn(uint8_t *from, uint8_t *to) {
    for (to--; from < to; from++, to--) {
        uint8_t swap = *from;
        *from = *to;
        *to = swap;
    }
}

// Of all orders one move away: the cheapest. A move: [i, j) turned, or [i, j) and [j, k) exchanged, either of these turned
// round, if it is no longer than AISLE_ORDER_SEGMENT.
static long double cheapest_neighbour(void) {
    long double least = (long double)INFINITY;
    const uint32_t n = cfg.n;
    for (uint32_t i = 0; i < n; i++) {
        for (uint32_t j = i + 1U; j <= n; j++) {
            uint8_t turned[MOST];
            memcpy(turned, order.order, n);
            turn(turned + i, turned + j);
            least = fminl(least, sum_of(turned));
            for (uint32_t k = j + 1U; k <= n; k++) {
                uint8_t moved[MOST];
                uint32_t middle = i + k - j;
                memcpy(moved, order.order, n);
                memcpy(moved + i, order.order + j, k - j);
                memcpy(moved + middle, order.order + i, j - i);
                least = fminl(least, sum_of(moved));
                if (j - i <= AISLE_ORDER_SEGMENT) {
                    turn(moved + middle, moved + k);
                    least = fminl(least, sum_of(moved));
                    turn(moved + middle, moved + k);
                }
                if (k - j <= AISLE_ORDER_SEGMENT) {
                    turn(moved + i, moved + middle);
                    least = fminl(least, sum_of(moved));
                }
            }
        }
    }
    return least;
}

static void test_no_move_gains_on_the_order_found_if_costs_are_even(void) {
    for (uint64_t seed = 0; seed < CASES(12); seed++) {
        make(seed % 2U == 0U ? 20 : 33, seed % 3U == 0U ? CLUSTERS : PLANE, 300U + seed);
        cfg.kicks = seed < 6U ? 0U : 60U;
        TEST_ASSERT_EQUAL(AISLE_OK, run(UINT32_MAX));
        TEST_ASSERT_TRUE(cheapest_neighbour() >= sum_of(order.order) - 1e-8L);
    }
}

static void test_a_good_guess_is_never_made_worse(void) {
    uint8_t guess[50];
    make(50, PLANE, 77);
    cfg.kicks = 2000;
    (void)run(UINT32_MAX);
    memcpy(guess, order.order, sizeof guess);
    long double before = sum_of(guess);
    cfg.guess = guess;
    cfg.kicks = 0;
    TEST_ASSERT_EQUAL(AISLE_OK, run(UINT32_MAX));
    TEST_ASSERT_EQUAL_MEMORY(guess, order.order, sizeof guess);
    cfg.kicks = 300;
    cfg.seed = 5;
    (void)run(UINT32_MAX);
    TEST_ASSERT_TRUE(sum_of(order.order) <= before + 1e-9L);
}

static void test_kicks_never_make_it_dearer(void) {
    make(64, UNEVEN, 4);
    cfg.kicks = 0;
    (void)run(UINT32_MAX);
    long double without = sum_of(order.order);
    for (cfg.kicks = 50; cfg.kicks < 600; cfg.kicks += 150) {
        (void)run(UINT32_MAX);
        TEST_ASSERT_EQUAL_UINT32(cfg.kicks, order.kicks);
        TEST_ASSERT_TRUE(sum_of(order.order) <= without + 1e-9L);
    }
    TEST_ASSERT_TRUE(sum_of(order.order) < 0.99L * without);
}

// ---- slices, rules

static void test_any_slicing_gives_the_same_order_and_counts(void) {
    static const uint32_t sizes[] = {3, 10, 12, 13, 30, 64};
    for (int i = 0; i < 6; i++) {
        make(sizes[i], UNEVEN, 21);
        cfg.kicks = 40;
        aisle_status st = run(UINT32_MAX);
        aisle_order whole = order;
        for (uint32_t slice = 1; slice < 4000; slice = slice * 5 + 1) {
            TEST_ASSERT_EQUAL(st, run(slice));
            TEST_ASSERT_EQUAL_MEMORY(whole.order, order.order, sizes[i]);
            TEST_ASSERT_EQUAL_UINT32(whole.evals, order.evals);
            TEST_ASSERT_EQUAL_UINT32(whole.kicks, order.kicks);
        }
    }
}

static void test_the_best_so_far_is_there_at_any_time(void) {
    static const uint32_t sizes[] = {11, 40};
    for (int i = 0; i < 2; i++) {
        make(sizes[i], PLANE, 8);
        TEST_ASSERT_EQUAL(AISLE_OK, aisle_order_start(&order, &cfg, work, WORK));
        double last = INFINITY;
        do {
            TEST_ASSERT_TRUE(fabsl(sum_of(order.order) - (long double)order.value) < 1e-9L);
            TEST_ASSERT_TRUE(order.value <= last + 1e-9 || order.phase == AISLE_ORDER_INSERT);
            last = order.phase == AISLE_ORDER_INSERT ? NO_WAY : order.value;
        } while (aisle_order_step(&order, 1) == AISLE_BUSY);
    }
}

static void test_start_refuses_what_breaks_a_rule_and_leaves_self_alone(void) {
    make(13, PLANE, 1);
    uint8_t guess[13] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 11};
    aisle_order_config bad[7] = {cfg, cfg, cfg, cfg, cfg, cfg, cfg};
    bad[0].n = 0;
    bad[1].n = 65;
    bad[2].cost = NULL;
    bad[3].guess = guess;
    static const double no_costs[] = {-1.0, NAN, 1e13};
    static double spoiled[3][14 * 13];
    for (int i = 0; i < 3; i++) {
        memcpy(spoiled[i], cost, sizeof spoiled[i]);
        spoiled[i][13 * 13 + 4] = no_costs[i];
        bad[4 + i].cost = spoiled[i];
    }
    for (int i = 0; i < 7; i++) {
        order.evals = 77;
        TEST_ASSERT_EQUAL(AISLE_ERR_ARG, aisle_order_start(&order, &bad[i], work, WORK));
        TEST_ASSERT_EQUAL_UINT32(77, order.evals);
    }
    TEST_ASSERT_EQUAL(AISLE_ERR_ARG, aisle_order_start(&order, NULL, work, WORK));
    make(10, PLANE, 1);
    TEST_ASSERT_EQUAL(AISLE_ERR_CAPACITY, aisle_order_start(&order, &cfg, work, AISLE_ORDER_WORK_LEN(10) - 1U));
    TEST_ASSERT_EQUAL_UINT32(77, order.evals);
    memset(&order, 0, sizeof order);
    TEST_ASSERT_EQUAL(AISLE_ERR_ARG, aisle_order_step(&order, 10)); // never started
}

static void test_spoiled_fields_are_noticed(void) {
    make(20, PLANE, 2);
    (void)run(UINT32_MAX);
    order.order[3] = order.order[4];
    TEST_ASSERT_FALSE(aisle_order_invariants_hold(&order));
    (void)run(UINT32_MAX);
    order.value += 1.0;
    TEST_ASSERT_FALSE(aisle_order_invariants_hold(&order));
    (void)run(UINT32_MAX);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_up_to_eight_places_no_permutation_is_cheaper);
    RUN_TEST(test_nine_to_twelve_places_are_as_cheap_as_by_a_table_in_long_double);
    RUN_TEST(test_what_cannot_be_gone_is_told_and_leaves_the_order_as_given);
    RUN_TEST(test_a_place_that_nothing_leaves_comes_last);
    RUN_TEST(test_ties_go_to_the_lowest_index);
    RUN_TEST(test_thirteen_and_fourteen_places_come_out_exact_on_nearly_all_seeds);
    RUN_TEST(test_up_to_64_places_come_within_a_few_hundredths_of_a_lower_bound);
    RUN_TEST(test_48_places_with_uneven_costs_come_close_to_the_best_known);
    RUN_TEST(test_an_order_without_a_way_somewhere_is_taken_only_if_there_is_no_other);
    RUN_TEST(test_no_move_gains_on_the_order_found_if_costs_are_even);
    RUN_TEST(test_a_good_guess_is_never_made_worse);
    RUN_TEST(test_kicks_never_make_it_dearer);
    RUN_TEST(test_any_slicing_gives_the_same_order_and_counts);
    RUN_TEST(test_the_best_so_far_is_there_at_any_time);
    RUN_TEST(test_start_refuses_what_breaks_a_rule_and_leaves_self_alone);
    RUN_TEST(test_spoiled_fields_are_noticed);
    return UNITY_END();
}
