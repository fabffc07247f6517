#include "algo/near.h" // first: proves that the header stands alone

#include "unity.h"

#include <stdlib.h>
#include <string.h>

enum { CAPACITY = 3000, BLOCK = 1 << 20, K = 40 };

static unsigned char block[BLOCK] __attribute__((aligned(64)));
static aisle_near near_set;
static aisle_cspace space;
static aisle_rng rng;

// A metric that is not the weighted Euclidean one: way plus a share of the turn.
static double way_and_turn(void *context, const double *a, const double *b) {
    (void)context;
    const double turn = aisle_cspace_difference(a[2], b[2], 6.0);
    return sqrt((a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1])) + 0.5 * fabs(turn);
}

static void begin(uint32_t dim, bool comes_round) {
    space = (aisle_cspace){.dim = dim};
    for (uint32_t d = 0; d < dim; d++) {
        space.lo[d] = -3.0;
        space.hi[d] = 3.0;
        space.weight[d] = d == 1U ? 0.25 : 1.0;
        space.period[d] = comes_round && d + 1U == dim ? 6.0 : 0.0;
    }
    aisle_arena arena = aisle_arena_over(block, BLOCK);
    aisle_near_carve(&near_set, &arena, CAPACITY, dim);
    TEST_ASSERT_FALSE(arena.overflow);
    aisle_near_begin(&near_set, &space);
}

static void draw(double *q) {
    for (uint32_t d = 0; d < space.dim; d++) {
        q[d] = space.lo[d] + 6.0 * (double)aisle_rng_float(&rng);
    }
}

// On a coarse lattice, so that many distances are alike.
static void draw_coarse(double *q) {
    for (uint32_t d = 0; d < space.dim; d++) {
        q[d] = -3.0 + 0.5 * (double)aisle_rng_below(&rng, 12U);
    }
}

// ---- the judge: every configuration, sorted

typedef struct candidate {
    double distance;
    uint32_t index;
} candidate;

static int by_distance(const void *a, const void *b) {
    const candidate *x = (const candidate *)a, *y = (const candidate *)b;
    if (x->distance < y->distance || x->distance > y->distance) {
        return x->distance < y->distance ? -1 : 1;
    }
    return x->index < y->index ? -1 : 1;
}

static uint32_t judge(const double *q, double radius, candidate *all) {
    uint32_t n = 0;
    for (uint32_t i = 0; i < near_set.count; i++) {
        const double distance = aisle_cspace_distance(&space, aisle_near_at(&near_set, i), q);
        if (distance <= radius) {
            all[n++] = (candidate){distance, i};
        }
    }
    qsort(all, n, sizeof *all, by_distance);
    return n;
}

static void expect_as_judged(const double *q, uint32_t k, double radius) {
    static candidate all[CAPACITY];
    uint32_t found[K];
    double distance[K];
    const uint32_t there = judge(q, radius, all);
    const uint32_t n = aisle_near_find(&near_set, q, k, radius, found, distance);
    TEST_ASSERT_EQUAL_UINT32(there < k ? there : k, n);
    for (uint32_t i = 0; i < n; i++) {
        TEST_ASSERT_EQUAL_UINT32(all[i].index, found[i]);
        TEST_ASSERT_EQUAL_DOUBLE(all[i].distance, distance[i]);
    }
}

static void put_in_and_compare(void (*next)(double *q), uint32_t count) {
    double q[AISLE_CSPACE_DIM_MAX];
    for (uint32_t i = 0; i < count; i++) {
        next(q);
        TEST_ASSERT_EQUAL_UINT32(i, aisle_near_add(&near_set, q));
        if (i % 37U != 0U && i > 20U) {
            continue;
        }
        next(q);
        expect_as_judged(q, 1, (double)INFINITY);
        expect_as_judged(q, 1U + aisle_rng_below(&rng, K), (double)INFINITY);
        expect_as_judged(q, K, 3.0 * (double)aisle_rng_float(&rng));
    }
    TEST_ASSERT_TRUE(aisle_near_invariants_hold(&near_set));
}

void setUp(void) {
    rng = aisle_rng_seed(5);
}
void tearDown(void) {}

static void test_answers_are_those_of_looking_at_every_configuration(void) {
    for (uint32_t dim = 1; dim <= AISLE_CSPACE_DIM_MAX; dim++) {
        for (int round = 0; round < 2; round++) {
            begin(dim, round != 0);
            put_in_and_compare(draw, 1200);
        }
    }
}

static void test_of_equal_distances_the_first_put_in_comes_first(void) {
    for (uint32_t dim = 1; dim <= 3U; dim++) {
        begin(dim, dim == 2U);
        put_in_and_compare(draw_coarse, 700);
    }
}

static void test_any_metric_above_the_weighted_one_will_do(void) {
    begin(3, true);
    space.weight[1] = 1.0;
    space.weight[2] = 0.5;
    space.distance = way_and_turn;
    put_in_and_compare(draw, 1200);
    begin(3, true); // a coordinate without weight rules nothing out
    space.weight[2] = 0.0;
    space.distance = way_and_turn;
    put_in_and_compare(draw, 600);
}

static double walked;

static void walk(double *q) { // on and on in one direction, as a tree grows
    walked += 1.0 / CAPACITY;
    q[0] = -3.0 + 6.0 * walked;
    q[1] = q[0] * q[0] / 3.0;
}

static void test_a_tree_that_grows_one_way_stays_shallow(void) {
    begin(2, false);
    walked = 0.0;
    double q[2];
    for (uint32_t i = 0; i < CAPACITY; i++) {
        walk(q);
        TEST_ASSERT_EQUAL_UINT32(i, aisle_near_add(&near_set, q));
    }
    TEST_ASSERT_TRUE(near_set.depth <= 23U);             // 2 * log2(3000) + 1
    TEST_ASSERT_TRUE(near_set.rebuilt > 0U);             // so it was built anew,
    TEST_ASSERT_TRUE(near_set.rebuilt < 30U * CAPACITY); // each configuration about log n times at most
    TEST_ASSERT_TRUE(aisle_near_invariants_hold(&near_set));
    walked = 0.31;
    for (int i = 0; i < 50; i++) {
        draw(q);
        expect_as_judged(q, K, (double)INFINITY);
    }
}

static void test_configurations_all_the_same_are_all_found(void) {
    begin(2, false);
    const double q[2] = {1.0, 2.0}, other[2] = {1.5, 2.0};
    for (uint32_t i = 0; i < 300U; i++) {
        TEST_ASSERT_EQUAL_UINT32(i, aisle_near_add(&near_set, q));
    }
    expect_as_judged(q, K, 0.0);
    TEST_ASSERT_EQUAL_UINT32(300, aisle_near_add(&near_set, other));
    for (uint32_t i = 301; i < 600U; i++) {
        (void)aisle_near_add(&near_set, q);
    }
    TEST_ASSERT_EQUAL_UINT32(300, aisle_near_nearest(&near_set, other, NULL));
    expect_as_judged(other, K, (double)INFINITY);
    TEST_ASSERT_TRUE(aisle_near_invariants_hold(&near_set));
}

static void test_empty_it_finds_nothing_and_full_it_takes_nothing(void) {
    begin(2, false);
    double q[2] = {0.0, 0.0}, distance = 7.0;
    TEST_ASSERT_EQUAL_UINT32(AISLE_NEAR_NONE, aisle_near_nearest(&near_set, q, &distance));
    TEST_ASSERT_EQUAL_DOUBLE(7.0, distance);
    for (uint32_t i = 0; i < CAPACITY; i++) {
        draw(q);
        (void)aisle_near_add(&near_set, q);
    }
    TEST_ASSERT_EQUAL_UINT32(AISLE_NEAR_NONE, aisle_near_add(&near_set, q));
    TEST_ASSERT_EQUAL_UINT32(CAPACITY, near_set.count);
    aisle_near_begin(&near_set, &space);
    TEST_ASSERT_EQUAL_UINT32(AISLE_NEAR_NONE, aisle_near_nearest(&near_set, q, NULL));
}

static void test_it_takes_the_bytes_that_its_header_states(void) {
    for (uint32_t dim = 1; dim <= AISLE_CSPACE_DIM_MAX; dim++) {
        aisle_arena arena = aisle_arena_measure();
        aisle_near measured;
        aisle_near_carve(&measured, &arena, 100000, dim);
        TEST_ASSERT_TRUE(arena.used <= (16U * dim + 18U) * 100000U + 6U * AISLE_ARENA_ALIGN + 64U);
    }
}

static void test_spoilt_memory_is_noticed(void) {
    begin(2, false);
    double q[2];
    for (uint32_t i = 0; i < 200U; i++) {
        draw(q);
        (void)aisle_near_add(&near_set, q);
    }
    TEST_ASSERT_TRUE(aisle_near_invariants_hold(&near_set));
    near_set.q[2U * 77U] += 10.0;
    TEST_ASSERT_FALSE(aisle_near_invariants_hold(&near_set));
    near_set.q[2U * 77U] -= 10.0;
    near_set.node[0].count++;
    TEST_ASSERT_FALSE(aisle_near_invariants_hold(&near_set));
    near_set.node[0].count--;
    near_set.box[0] += 1.0;
    TEST_ASSERT_FALSE(aisle_near_invariants_hold(&near_set));
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_answers_are_those_of_looking_at_every_configuration);
    RUN_TEST(test_of_equal_distances_the_first_put_in_comes_first);
    RUN_TEST(test_any_metric_above_the_weighted_one_will_do);
    RUN_TEST(test_a_tree_that_grows_one_way_stays_shallow);
    RUN_TEST(test_configurations_all_the_same_are_all_found);
    RUN_TEST(test_empty_it_finds_nothing_and_full_it_takes_nothing);
    RUN_TEST(test_it_takes_the_bytes_that_its_header_states);
    RUN_TEST(test_spoilt_memory_is_noticed);
    return UNITY_END();
}
