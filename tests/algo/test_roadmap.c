// Lists against all distances, ways against Bellman and Ford over edges tested by the test itself, repairs against roadmaps
// built anew. Spaces of two dimensions among boxes, the same with one-way boxes, and three dimensions with an angle.
#include "algo/roadmap.h" // first: proves that the header stands alone

#include "cases.h"
#include "unity.h"

#include <math.h>
#include <string.h>

enum { DRAWS = 400, K = 8, BOXES = 12, ARENA = 1 << 20 };

typedef struct world {
    double box[BOXES][4]; // x0, y0, x1, y1
    bool is_there[BOXES];
    bool one_way[BOXES]; // closed to motions to the left alone
    uint32_t asked;
} world;

static unsigned char block[3][ARENA + 64];
static world hall;
static aisle_cspace space;
static aisle_roadmap map, other;
static aisle_roadmap_search search;
static uint64_t draws;

static double draw(void) {
    draws = draws * 6364136223846793005ULL + 1442695040888963407ULL;
    return (double)(draws >> 40) / 16777216.0;
}

// Does the segment meet the box? By clipping (Liang and Barsky).
static bool meets(const double *box, const double *a, const double *b) {
    double t0 = 0.0;
    double t1 = 1.0;
    for (int d = 0; d < 2; d++) {
        const double step = b[d] - a[d];
        if (fabs(step) < 1e-300) {
            if (a[d] < box[d] || a[d] > box[2 + d]) {
                return false;
            }
            continue;
        }
        const double u = (box[d] - a[d]) / step, v = (box[2 + d] - a[d]) / step;
        t0 = fmax(t0, fmin(u, v));
        t1 = fmin(t1, fmax(u, v));
    }
    return t0 <= t1;
}

static bool is_free_in(const world *w, const double *a, const double *b) {
    for (int i = 0; i < BOXES; i++) {
        if (w->is_there[i] && !(w->one_way[i] && b[0] >= a[0]) && meets(w->box[i], a, b)) {
            return false;
        }
    }
    return true;
}

static bool is_free(void *context, const double *a, const double *b, uint32_t *units) {
    world *w = (world *)context;
    w->asked++;
    *units += 1U;
    return is_free_in(w, a, b);
}

static void sample(void *context, aisle_rng *rng, double *q) {
    (void)context;
    for (uint32_t d = 0; d < space.dim; d++) {
        q[d] = space.lo[d] + (space.hi[d] - space.lo[d]) * (double)aisle_rng_float(rng);
    }
}

static void steer(void *context, const double *a, const double *b, double part, double *q) {
    (void)context;
    for (uint32_t d = 0; d < space.dim; d++) {
        q[d] = a[d] + part * aisle_cspace_difference(a[d], b[d], space.period[d]);
    }
}

static void make_box(int i) {
    const double x = 10.0 * draw(), y = 10.0 * draw(), w = 0.3 + 1.7 * draw(), h = 0.3 + 1.7 * draw();
    const double box[4] = {x - w, y - h, x + w, y + h};
    memcpy(hall.box[i], box, sizeof box);
    hall.is_there[i] = true;
}

static void make_hall(uint32_t dim, uint64_t seed) {
    draws = 2U * seed + 1U;
    memset(&hall, 0, sizeof hall);
    space = (aisle_cspace){.dim = dim,
                           .lo = {0.0, 0.0, -3.0},
                           .hi = {10.0, 10.0, 3.0},
                           .weight = {1.0, 1.0, 0.5},
                           .period = {0.0, 0.0, 6.0},
                           .context = &hall,
                           .sample = sample,
                           .steer = steer,
                           .is_free = is_free};
    for (int i = 0; i < BOXES; i++) {
        make_box(i);
        hall.is_there[i] = i < BOXES - 4;
    }
}

static void carve(aisle_roadmap *self, int which, uint32_t dim) {
    aisle_arena arena = aisle_arena_over(block[which] + (64U - (uintptr_t)block[which] % 64U) % 64U, ARENA);
    aisle_roadmap_carve(self, &arena, dim, DRAWS, K);
    TEST_ASSERT_FALSE(arena.overflow);
}

static void finish_in(aisle_roadmap *self, uint32_t slice) {
    uint32_t spent = 0;
    for (long steps = 0; aisle_roadmap_step(self, slice, &spent) == AISLE_BUSY; steps++) {
        TEST_ASSERT_LESS_THAN_INT64(1000000, steps);
    }
    TEST_ASSERT_EQUAL(AISLE_ROADMAP_READY, self->phase);
    TEST_ASSERT_TRUE(aisle_roadmap_invariants_hold(self));
}

static void build(aisle_roadmap *self, int which, aisle_roadmap_config config) {
    carve(self, which, space.dim);
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_roadmap_start(self, &space, &config));
    finish_in(self, UINT32_MAX);
}

void setUp(void) {
    aisle_arena arena = aisle_arena_over(block[2] + (64U - (uintptr_t)block[2] % 64U) % 64U, ARENA);
    aisle_roadmap_search_carve(&search, &arena, DRAWS);
    TEST_ASSERT_FALSE(arena.overflow);
}

void tearDown(void) {}

static const aisle_roadmap_config lazy = {.samples = DRAWS, .seed = 5};
static const aisle_roadmap_config eager = {.samples = DRAWS, .seed = 5, .eager = true};

static aisle_status ask_in(aisle_roadmap *self, aisle_roadmap_search_kind kind, const double *a, const double *b,
                           uint32_t slice) {
    uint32_t spent = 0;
    aisle_roadmap_ask(&search, self, kind, a, b, &spent);
    aisle_status st;
    while ((st = aisle_roadmap_search_step(&search, slice, &spent)) == AISLE_BUSY) {
        TEST_ASSERT_LESS_THAN_UINT32(1000000, spent);
    }
    return st;
}

// ---- oracles

static const double *at(const aisle_roadmap *self, uint32_t i) {
    return self->q + (size_t)i * self->dim;
}

static double apart(const double *a, const double *b) {
    double sum = 0.0;
    for (uint32_t d = 0; d < space.dim; d++) {
        double gap = fabs(b[d] - a[d]);
        gap = space.period[d] > 0.0 ? fmin(gap, space.period[d] - gap) : gap;
        sum += space.weight[d] * space.weight[d] * gap * gap;
    }
    return sqrt(sum);
}

// How many nodes are nearer to q than its neighbour at `distance`, leaving `self_node` out.
static uint32_t nearer(const aisle_roadmap *self, const double *q, double distance, uint32_t self_node) {
    uint32_t n = 0;
    for (uint32_t i = 0; i < self->count; i++) {
        n +=
            i != self_node && is_free_in(&hall, at(self, i), at(self, i)) && apart(q, at(self, i)) < distance ? 1U : 0U;
    }
    return n;
}

static bool is_listed(const aisle_roadmap *self, uint32_t a, uint32_t b) {
    for (uint32_t i = 0; i < self->degree[a]; i++) {
        if (self->list[a * self->k + i] == b) {
            return true;
        }
    }
    return false;
}

// The least cost from q to r over the lists and the K nearest nodes of either end, by rounds over all edges until
// nothing changes.
static double best_way(const aisle_roadmap *self, const double *q, const double *r) {
    static double cost[DRAWS];
    double best = is_free_in(&hall, q, r) ? apart(q, r) : (double)INFINITY;
    for (uint32_t i = 0; i < self->count; i++) {
        const bool is_near = nearer(self, q, apart(q, at(self, i)), UINT32_MAX) < self->k;
        const bool joins = aisle_roadmap_is_node(self, i) && is_near && is_free_in(&hall, q, at(self, i));
        cost[i] = joins ? apart(q, at(self, i)) : (double)INFINITY;
    }
    for (bool again = true; again;) {
        again = false;
        for (uint32_t a = 0; a < self->count; a++) {
            for (uint32_t b = 0; b < self->count && cost[a] < (double)INFINITY; b++) {
                const double by = cost[a] + apart(at(self, a), at(self, b));
                if (by < cost[b] && (is_listed(self, a, b) || is_listed(self, b, a)) &&
                    is_free_in(&hall, at(self, a), at(self, b))) {
                    cost[b] = by;
                    again = true;
                }
            }
        }
    }
    for (uint32_t i = 0; i < self->count; i++) {
        if (cost[i] < (double)INFINITY && nearer(self, r, apart(r, at(self, i)), UINT32_MAX) < self->k &&
            is_free_in(&hall, at(self, i), r)) {
            best = fmin(best, cost[i] + apart(at(self, i), r));
        }
    }
    return best;
}

static void draw_free(double *q) {
    do {
        for (uint32_t d = 0; d < space.dim; d++) {
            q[d] = space.lo[d] + (space.hi[d] - space.lo[d]) * draw();
        }
    } while (!is_free_in(&hall, q, q));
}

static bool is_same_map(const aisle_roadmap *a, const aisle_roadmap *b) {
    bool same = a->count == b->count && a->free_count == b->free_count;
    for (uint32_t row = 0; same && row < a->count; row++) {
        same = aisle_roadmap_is_node(a, row) == aisle_roadmap_is_node(b, row) && a->degree[row] == b->degree[row] &&
               memcmp(a->list + row * K, b->list + row * K, a->degree[row] * sizeof a->list[0]) == 0 &&
               memcmp(a->known + row * K, b->known + row * K, a->degree[row]) == 0;
    }
    return same;
}

// ---- tests

static const uint32_t blocks[3] = {50, 180, DRAWS}; // ends

static void build_grown(aisle_roadmap *self, int which, aisle_roadmap_config config, uint32_t slice) {
    config.samples = blocks[0];
    build(self, which, config);
    for (int i = 1; i < 3; i++) {
        TEST_ASSERT_EQUAL(AISLE_OK, aisle_roadmap_grow(self, blocks[i]));
        finish_in(self, slice);
    }
}

static void test_what_is_grown_is_joined_to_all_so_far_and_old_lists_stay(void) {
    make_hall(2, 21);
    for (int i = 0; i < 2; i++) {
        const aisle_roadmap_config config = i == 0 ? lazy : eager;
        build_grown(&map, 0, config, i == 0 ? 17U : 1U);
        build(&other, 1, config);
        TEST_ASSERT_EQUAL_MEMORY(other.q, map.q, DRAWS * 2U * sizeof *map.q);
        TEST_ASSERT_EQUAL_UINT32(other.free_count, map.free_count);
        for (uint32_t row = 0; row < map.count; row++) {
            aisle_roadmap until = map; // the draws that were there then
            until.count = row < blocks[0] ? blocks[0] : row < blocks[1] ? blocks[1] : blocks[2];
            TEST_ASSERT_EQUAL_UINT32(aisle_roadmap_is_node(&map, row) ? K : 0U, map.degree[row]);
            for (uint32_t k = 0; k < map.degree[row]; k++) {
                const double distance = apart(at(&map, row), at(&map, map.list[row * K + k]));
                TEST_ASSERT_TRUE(map.list[row * K + k] < until.count);
                TEST_ASSERT_EQUAL_UINT32(k, nearer(&until, at(&map, row), distance, row));
            }
        }
    }
    TEST_ASSERT_EQUAL(AISLE_ERR_ARG, aisle_roadmap_grow(&map, DRAWS));
    TEST_ASSERT_EQUAL(AISLE_ERR_ARG, aisle_roadmap_grow(&map, DRAWS + 1));
}

static void test_blocks_that_it_begins_with_are_as_if_it_had_grown(void) {
    make_hall(2, 22);
    aisle_roadmap_config config = eager;
    config.samples = 50;
    build(&map, 0, config);
    while (map.count < DRAWS) {
        TEST_ASSERT_EQUAL(AISLE_OK, aisle_roadmap_grow(&map, 2U * map.count < DRAWS ? 2U * map.count : DRAWS));
        finish_in(&map, 1000);
    }
    config = eager;
    config.first = 50;
    build(&other, 1, config);
    TEST_ASSERT_TRUE(is_same_map(&map, &other));
    TEST_ASSERT_GREATER_THAN_UINT32(2, other.blocks);
    config.first = 1; // more blocks than there may be: the last one takes the rest
    config.samples = DRAWS;
    build(&other, 1, config);
    TEST_ASSERT_EQUAL_UINT32(DRAWS, other.end[other.blocks - 1U]);
    config.first = DRAWS + 1;
    build(&other, 1, config);
    TEST_ASSERT_EQUAL_UINT32(1, other.blocks);
}

static void test_it_grows_no_more_often_than_it_has_blocks(void) {
    make_hall(2, 21);
    aisle_roadmap_config config = lazy;
    config.samples = 10;
    build(&map, 0, config);
    for (uint32_t i = 1; i < AISLE_ROADMAP_BLOCKS; i++) {
        TEST_ASSERT_EQUAL(AISLE_OK, aisle_roadmap_grow(&map, 10U + i));
        finish_in(&map, 1000);
    }
    TEST_ASSERT_EQUAL(AISLE_ERR_ARG, aisle_roadmap_grow(&map, DRAWS));
}

static void to_the_left(void *context, double *q) {
    (void)context;
    q[0] = space.lo[0];
}

static void test_draws_beyond_the_uniform_ones_are_retracted(void) {
    make_hall(2, 23);
    build(&other, 1, lazy);
    space.retract = to_the_left;
    build(&map, 0, lazy);
    TEST_ASSERT_EQUAL_MEMORY(other.q, map.q, DRAWS * 2U * sizeof *map.q);
    aisle_roadmap_config config = lazy;
    config.uniform = 101;
    build(&map, 0, config);
    space.retract = NULL;
    for (uint32_t row = 0; row < DRAWS; row++) {
        const bool is_moved = row >= 101U;
        TEST_ASSERT_TRUE(at(&map, row)[0] <= (is_moved ? space.lo[0] : at(&other, row)[0]));
        TEST_ASSERT_TRUE(at(&map, row)[0] >= (is_moved ? space.lo[0] : at(&other, row)[0]));
        TEST_ASSERT_EQUAL_MEMORY(at(&other, row) + 1, at(&map, row) + 1, sizeof(double));
    }
}

static void test_lists_hold_the_k_nearest_free_draws(void) {
    for (uint32_t dim = 2; dim <= 3; dim++) {
        make_hall(dim, 11 + dim);
        build(&map, 0, lazy);
        TEST_ASSERT_GREATER_THAN_UINT32(DRAWS / 4, map.free_count);
        TEST_ASSERT_LESS_THAN_UINT32(DRAWS, map.free_count);
        for (uint32_t row = 0; row < map.count; row++) {
            TEST_ASSERT_EQUAL(is_free_in(&hall, at(&map, row), at(&map, row)), aisle_roadmap_is_node(&map, row));
            TEST_ASSERT_EQUAL_UINT32(aisle_roadmap_is_node(&map, row) ? K : 0U, map.degree[row]);
            for (uint32_t i = 0; i < map.degree[row]; i++) {
                const double distance = apart(at(&map, row), at(&map, map.list[row * K + i]));
                TEST_ASSERT_EQUAL_UINT32(i, nearer(&map, at(&map, row), distance, row));
            }
        }
    }
}

static void test_ways_are_the_best_of_the_roadmap_by_either_search_lazy_or_not(void) {
    int found = 0, none = 0;
    for (uint64_t seed = 0; seed < 12; seed++) {
        make_hall(2U + (uint32_t)(seed % 2U), seed);
        for (int i = 0; i < BOXES; i++) {
            hall.one_way[i] = seed % 3U == 1U && i % 3 == 0;
        }
        aisle_roadmap_config config = seed % 2U == 0U ? lazy : eager;
        config.one_way = seed % 3U == 1U;
        config.samples = seed % 4U == 3U ? 60U : 250U;
        build(&map, 0, config);
        for (int n = 0; n < 8; n++) {
            double a[3], b[3];
            draw_free(a);
            draw_free(b);
            const double best = best_way(&map, a, b);
            const aisle_status st = ask_in(&map, n % 2 == 0 ? AISLE_ROADMAP_ASTAR : AISLE_ROADMAP_DIJKSTRA, a, b, 7);
            TEST_ASSERT_EQUAL(best < (double)INFINITY ? AISLE_OK : AISLE_PARTIAL, st);
            if (st == AISLE_OK) {
                TEST_ASSERT_DOUBLE_WITHIN(1e-9, best, aisle_roadmap_cost(&search));
                found++;
            }
            none += st == AISLE_OK ? 0 : 1;
        }
        TEST_ASSERT_TRUE(aisle_roadmap_invariants_hold(&map));
    }
    TEST_ASSERT_GREATER_THAN_INT(50, found);
    TEST_ASSERT_GREATER_THAN_INT(0, none);
}

static void test_a_way_is_a_chain_of_free_motions_whose_costs_add_up(void) {
    static double way[(DRAWS + 2) * 3];
    make_hall(3, 4);
    build(&map, 0, lazy);
    for (int n = 0; n < 20; n++) {
        double a[3], b[3], sum = 0.0;
        draw_free(a);
        draw_free(b);
        if (ask_in(&map, AISLE_ROADMAP_ASTAR, a, b, UINT32_MAX) != AISLE_OK) {
            TEST_ASSERT_EQUAL_UINT32(0, aisle_roadmap_way(&search, way, DRAWS + 2));
            continue;
        }
        const uint32_t count = aisle_roadmap_way(&search, way, DRAWS + 2);
        TEST_ASSERT_GREATER_THAN_UINT32(1, count);
        TEST_ASSERT_EQUAL_UINT32(0, aisle_roadmap_way(&search, way, count - 1U));
        TEST_ASSERT_EQUAL_MEMORY(a, way, sizeof a);
        TEST_ASSERT_EQUAL_MEMORY(b, way + (size_t)(count - 1U) * 3U, sizeof b);
        for (uint32_t i = 1; i < count; i++) {
            TEST_ASSERT_TRUE(is_free_in(&hall, way + (size_t)(i - 1U) * 3U, way + (size_t)i * 3U));
            sum += apart(way + (size_t)(i - 1U) * 3U, way + (size_t)i * 3U);
        }
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, sum, aisle_roadmap_cost(&search));
    }
}

static uint32_t edges_of(const aisle_roadmap *self) {
    uint32_t n = 0;
    for (uint32_t a = 0; a < self->count; a++) {
        for (uint32_t b = 0; b < a; b++) {
            n += is_listed(self, a, b) || is_listed(self, b, a) ? 1U : 0U;
        }
    }
    return n;
}

static void test_a_lazy_roadmap_tests_few_edges_and_none_twice(void) {
    double a[2], b[2];
    make_hall(2, 3);
    build(&other, 1, eager);
    build(&map, 0, lazy);
    TEST_ASSERT_EQUAL_UINT32(0, map.edge_tests);
    for (int n = 0; n < 10; n++) {
        draw_free(a);
        draw_free(b);
        const aisle_status st = ask_in(&map, AISLE_ROADMAP_ASTAR, a, b, UINT32_MAX);
        const double cost = aisle_roadmap_cost(&search);
        const uint32_t before = map.edge_tests;
        TEST_ASSERT_EQUAL(st, ask_in(&map, AISLE_ROADMAP_ASTAR, a, b, UINT32_MAX));
        TEST_ASSERT_EQUAL_UINT32(before, map.edge_tests);
        TEST_ASSERT_EQUAL(st, ask_in(&other, AISLE_ROADMAP_DIJKSTRA, a, b, UINT32_MAX));
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, st == AISLE_OK ? cost : 0.0,
                                  st == AISLE_OK ? aisle_roadmap_cost(&search) : 0.0);
    }
    TEST_ASSERT_EQUAL_UINT32(edges_of(&other), other.edge_tests);
    TEST_ASSERT_LESS_THAN_UINT32(other.edge_tests, map.edge_tests);
    TEST_ASSERT_GREATER_THAN_UINT32(0, map.edge_tests);
    const uint32_t all = other.edge_tests;
    TEST_ASSERT_EQUAL(AISLE_OK, ask_in(&other, AISLE_ROADMAP_ASTAR, a, b, UINT32_MAX));
    TEST_ASSERT_EQUAL_UINT32(all, other.edge_tests);
}

static bool box_matters(void *context, const double *a, const double *b) {
    return meets((const double *)context, a, b);
}

static void test_a_repaired_roadmap_is_one_built_anew(void) {
    int by_few = 0;
    for (uint64_t seed = 0; seed < 10; seed++) {
        make_hall(2U + (uint32_t)(seed % 2U), 100 + seed);
        aisle_roadmap_config config = eager;
        config.one_way = seed % 3U == 2U;
        for (int i = 0; i < BOXES; i++) {
            hall.one_way[i] = config.one_way && i % 4 != 0;
        }
        const bool is_grown = seed % 2U == 1U;
        is_grown ? build_grown(&map, 0, config, 1000) : build(&map, 0, config);
        for (int change = 0; change < 8; change++) {
            const int i = (int)(draw() * BOXES);
            const uint32_t before = map.edge_tests;
            hall.is_there[i] = !hall.is_there[i];
            hall.one_way[i] = config.one_way && change % 2 == 0;
            aisle_roadmap_repair(&map, box_matters, hall.box[i]);
            finish_in(&map, 1U + (uint32_t)change * 13U);
            is_grown ? build_grown(&other, 1, config, 1000) : build(&other, 1, config);
            TEST_ASSERT_TRUE(is_same_map(&map, &other));
            by_few += map.edge_tests - before < other.edge_tests / 2U ? 1 : 0;
        }
    }
    TEST_ASSERT_GREATER_THAN_INT(70, by_few);
}

static void test_a_lazy_repair_leaves_nothing_known_that_is_not_so(void) {
    make_hall(2, 77);
    build(&map, 0, lazy);
    for (int change = 0; change < CASES(20); change++) {
        double a[2], b[2];
        const int i = (int)(draw() * BOXES);
        hall.is_there[i] = !hall.is_there[i];
        aisle_roadmap_repair(&map, box_matters, hall.box[i]);
        finish_in(&map, 100);
        for (int n = 0; n < 3; n++) {
            draw_free(a);
            draw_free(b);
            const double best = best_way(&map, a, b);
            TEST_ASSERT_EQUAL(best < (double)INFINITY ? AISLE_OK : AISLE_PARTIAL,
                              ask_in(&map, AISLE_ROADMAP_ASTAR, a, b, UINT32_MAX));
            TEST_ASSERT_TRUE(!(best < (double)INFINITY) || fabs(best - aisle_roadmap_cost(&search)) < 1e-9);
        }
        for (uint32_t row = 0; row < map.count; row++) {
            for (uint32_t n = 0; n < map.degree[row]; n++) {
                const aisle_roadmap_known known = aisle_roadmap_edge(&map, row, map.list[row * K + n]);
                const bool truth = is_free_in(&hall, at(&map, row), at(&map, map.list[row * K + n]));
                TEST_ASSERT_TRUE(known == AISLE_ROADMAP_UNKNOWN || (known == AISLE_ROADMAP_FREE) == truth);
            }
        }
    }
}

static void test_what_is_far_from_a_change_is_not_tested_again(void) {
    make_hall(2, 9);
    build(&map, 0, eager);
    const double corner[4] = {9.5, 9.5, 9.9, 9.9};
    memcpy(hall.box[BOXES - 1], corner, sizeof corner);
    hall.is_there[BOXES - 1] = true;
    const uint32_t edges = map.edge_tests;
    aisle_roadmap_repair(&map, box_matters, hall.box[BOXES - 1]);
    hall.asked = 0;
    finish_in(&map, UINT32_MAX);
    TEST_ASSERT_LESS_THAN_UINT32(edges / 20U, hall.asked);
    TEST_ASSERT_GREATER_THAN_UINT32(0, hall.asked);
}

static void test_a_copy_answers_alike_and_leaves_the_other_alone(void) {
    double a[2], b[2];
    make_hall(2, 31);
    build(&map, 0, lazy);
    carve(&other, 1, 2);
    for (int n = 0; n < 10; n++) {
        draw_free(a);
        draw_free(b);
        aisle_roadmap_copy(&other, &map, &space);
        finish_in(&other, 40);
        TEST_ASSERT_TRUE(is_same_map(&map, &other));
        const aisle_status st = ask_in(&other, AISLE_ROADMAP_ASTAR, a, b, UINT32_MAX);
        const double cost = aisle_roadmap_cost(&search);
        const uint32_t tests = map.edge_tests;
        TEST_ASSERT_EQUAL(st, ask_in(&map, AISLE_ROADMAP_ASTAR, a, b, UINT32_MAX));
        TEST_ASSERT_TRUE(st != AISLE_OK || fabs(cost - aisle_roadmap_cost(&search)) < 1e-12);
        TEST_ASSERT_EQUAL_UINT32(map.edge_tests - tests, other.edge_tests);
    }
}

static void test_any_slicing_gives_the_same_bits(void) {
    static double way[2][(DRAWS + 2) * 2];
    double a[2], b[2];
    make_hall(2, 41);
    draw_free(a);
    draw_free(b);
    build(&map, 0, lazy);
    TEST_ASSERT_EQUAL(AISLE_OK, ask_in(&map, AISLE_ROADMAP_ASTAR, a, b, UINT32_MAX));
    const uint32_t count = aisle_roadmap_way(&search, way[0], DRAWS + 2);
    for (uint32_t slice = 1; slice < 30; slice += 7) {
        carve(&other, 1, 2);
        TEST_ASSERT_EQUAL(AISLE_OK, aisle_roadmap_start(&other, &space, &lazy));
        finish_in(&other, slice);
        TEST_ASSERT_EQUAL(AISLE_OK, ask_in(&other, AISLE_ROADMAP_ASTAR, a, b, slice));
        TEST_ASSERT_EQUAL_UINT32(count, aisle_roadmap_way(&search, way[1], DRAWS + 2));
        TEST_ASSERT_EQUAL_MEMORY(way[0], way[1], count * 2U * sizeof way[0][0]);
        TEST_ASSERT_TRUE(is_same_map(&map, &other));
    }
}

static void test_bad_configs_are_refused_and_change_nothing(void) {
    make_hall(3, 51);
    carve(&map, 0, 2);
    uint32_t spent = 0;
    aisle_roadmap_config config = lazy;
    TEST_ASSERT_EQUAL(AISLE_ERR_ARG, aisle_roadmap_step(&map, 1, &spent));
    TEST_ASSERT_EQUAL(AISLE_ERR_ARG, aisle_roadmap_start(&map, &space, &config));
    make_hall(2, 51);
    config.samples = 0;
    TEST_ASSERT_EQUAL(AISLE_ERR_ARG, aisle_roadmap_start(&map, &space, &config));
    config.samples = DRAWS + 1;
    TEST_ASSERT_EQUAL(AISLE_ERR_ARG, aisle_roadmap_start(&map, &space, &config));
    TEST_ASSERT_EQUAL(AISLE_ROADMAP_EMPTY, map.phase);
    TEST_ASSERT_EQUAL(AISLE_ERR_ARG, aisle_roadmap_grow(&map, 1));
}

static void test_where_nothing_is_free_there_is_no_node_and_no_way(void) {
    make_hall(2, 61);
    const double all[4] = {-1.0, -1.0, 11.0, 11.0};
    memcpy(hall.box[0], all, sizeof all);
    build(&map, 0, eager);
    TEST_ASSERT_EQUAL_UINT32(0, map.free_count);
    const double a[2] = {1.0, 1.0}, b[2] = {9.0, 9.0};
    TEST_ASSERT_EQUAL(AISLE_PARTIAL, ask_in(&map, AISLE_ROADMAP_DIJKSTRA, a, b, 1));
    TEST_ASSERT_TRUE(aisle_roadmap_cost(&search) >= (double)INFINITY);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_lists_hold_the_k_nearest_free_draws);
    RUN_TEST(test_ways_are_the_best_of_the_roadmap_by_either_search_lazy_or_not);
    RUN_TEST(test_a_way_is_a_chain_of_free_motions_whose_costs_add_up);
    RUN_TEST(test_a_lazy_roadmap_tests_few_edges_and_none_twice);
    RUN_TEST(test_a_repaired_roadmap_is_one_built_anew);
    RUN_TEST(test_a_lazy_repair_leaves_nothing_known_that_is_not_so);
    RUN_TEST(test_what_is_far_from_a_change_is_not_tested_again);
    RUN_TEST(test_what_is_grown_is_joined_to_all_so_far_and_old_lists_stay);
    RUN_TEST(test_blocks_that_it_begins_with_are_as_if_it_had_grown);
    RUN_TEST(test_it_grows_no_more_often_than_it_has_blocks);
    RUN_TEST(test_draws_beyond_the_uniform_ones_are_retracted);
    RUN_TEST(test_a_copy_answers_alike_and_leaves_the_other_alone);
    RUN_TEST(test_any_slicing_gives_the_same_bits);
    RUN_TEST(test_bad_configs_are_refused_and_change_nothing);
    RUN_TEST(test_where_nothing_is_free_there_is_no_node_and_no_way);
    return UNITY_END();
}
