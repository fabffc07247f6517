#include "algo/rrt.h" // first: proves that the header stands alone

#include "unity.h"

#include <string.h>

enum { CAPACITY = 4000, BLOCK = 1 << 20, SEEDS = 20 };

typedef struct wall {
    double x0, y0, x1, y1;
} wall;

static unsigned char block[BLOCK] __attribute__((aligned(64)));
static const wall slit[2] = {{0.45, -1.0, 0.55, 0.6}, {0.45, 0.64, 0.55, 2.0}}; // leaves 0.04
static const wall shut[1] = {{0.45, -1.0, 0.55, 2.0}};
static const wall *walls;
static uint32_t wall_count;
static aisle_cspace space;
static aisle_rrt tree;
static aisle_rrt_config cfg;
static uint32_t path[CAPACITY + 1];

static void sample(void *context, aisle_rng *rng, double *q) {
    (void)context;
    q[0] = (double)aisle_rng_float(rng);
    q[1] = (double)aisle_rng_float(rng);
}

static void steer(void *context, const double *a, const double *b, double part, double *q) {
    (void)context;
    q[0] = a[0] + part * (b[0] - a[0]);
    q[1] = a[1] + part * (b[1] - a[1]);
}

// Does the straight way from a to b meet the box? By clipping it to one slab after the other.
static bool meets(const wall *w, const double *a, const double *b) {
    const double lo[2] = {w->x0, w->y0}, hi[2] = {w->x1, w->y1};
    double from = 0.0, to = 1.0;
    for (int d = 0; d < 2; d++) {
        const double by = b[d] - a[d];
        if (fabs(by) < 1e-15) {
            if (a[d] < lo[d] || a[d] > hi[d]) {
                return false;
            }
            continue;
        }
        const double s = (lo[d] - a[d]) / by, t = (hi[d] - a[d]) / by;
        from = fmax(from, fmin(s, t));
        to = fmin(to, fmax(s, t));
    }
    return from <= to;
}

static bool is_free(void *context, const double *a, const double *b, uint32_t *units) {
    (void)context;
    *units += 1U;
    for (uint32_t i = 0; i < wall_count; i++) {
        if (meets(&walls[i], a, b)) {
            return false;
        }
    }
    return true;
}

static double twice_uphill(void *context, const double *a, const double *b) { // a cost that is no metric
    (void)context;
    return hypot(b[0] - a[0], b[1] - a[1]) + fmax(b[1] - a[1], 0.0);
}

static double beeline(void *context, const double *a, const double *b) {
    (void)context;
    return hypot(b[0] - a[0], b[1] - a[1]);
}

void setUp(void) {
    walls = slit;
    wall_count = 2;
    space = (aisle_cspace){
        .dim = 2, .hi = {1.0, 1.0}, .weight = {1.0, 1.0}, .sample = sample, .steer = steer, .is_free = is_free};
    cfg = (aisle_rrt_config){.space = &space,
                             .start = {0.1, 0.1},
                             .goal = {0.9, 0.1},
                             .step = 0.2,
                             .samples = 20000,
                             .more = 2000,
                             .goal_bias = 0.05,
                             .reach = (double)INFINITY,
                             .seed = 1};
    aisle_arena arena = aisle_arena_over(block, BLOCK);
    aisle_rrt_carve(&tree, &arena, CAPACITY, 2);
    TEST_ASSERT_FALSE(arena.overflow);
}
void tearDown(void) {}

static aisle_status grow(uint32_t slice) {
    uint32_t spent = 0;
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_rrt_start(&tree, &cfg));
    aisle_status st;
    do {
        st = aisle_rrt_step(&tree, slice, &spent);
    } while (st == AISLE_BUSY);
    TEST_ASSERT_TRUE(aisle_rrt_invariants_hold(&tree));
    return st;
}

// The path joins the ends by free motions, and costs what they cost.
static void judge_path(void) {
    const uint32_t count = aisle_rrt_path(&tree, path, CAPACITY + 1);
    double sum = 0.0;
    TEST_ASSERT_TRUE(count >= 2U);
    TEST_ASSERT_EQUAL_MEMORY(cfg.start, aisle_rrt_at(&tree, path[0]), 2 * sizeof(double));
    TEST_ASSERT_EQUAL_MEMORY(cfg.goal, aisle_rrt_at(&tree, path[count - 1U]), 2 * sizeof(double));
    for (uint32_t i = 1; i < count; i++) {
        const double *a = aisle_rrt_at(&tree, path[i - 1U]), *b = aisle_rrt_at(&tree, path[i]);
        for (uint32_t w = 0; w < wall_count; w++) {
            TEST_ASSERT_FALSE(meets(&walls[w], a, b));
        }
        sum += space.cost != NULL ? space.cost(NULL, a, b) : hypot(b[0] - a[0], b[1] - a[1]);
    }
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, sum, aisle_rrt_cost(&tree));
}

static void test_every_planner_finds_a_free_way_through_the_slit(void) {
    for (cfg.seed = 0; cfg.seed < SEEDS; cfg.seed++) { // 20 of 20 for each
        for (int kind = 0; kind < 4; kind++) {
            cfg.halvings = (kind & 1) != 0 ? 6U : 0U;
            cfg.star = cfg.informed = kind >= 2;
            cfg.shorten = cfg.seed % 2U == 0U;
            TEST_ASSERT_EQUAL(AISLE_OK, grow(UINT32_MAX));
            TEST_ASSERT_TRUE(tree.kept == 0U || cfg.halvings > 0U);
            judge_path();
        }
    }
}

static void test_a_star_comes_near_the_optimum_and_never_gets_worse(void) {
    // Round both lower corners of the slit.
    const double optimum = 2.0 * hypot(0.35, 0.5) + 0.1;
    cfg.star = cfg.informed = true;
    cfg.halvings = 6;
    for (cfg.seed = 0; cfg.seed < SEEDS; cfg.seed++) {
        uint32_t spent = 0;
        cfg.shorten = cfg.seed % 2U == 0U;
        double before = (double)INFINITY;
        TEST_ASSERT_EQUAL(AISLE_OK, aisle_rrt_start(&tree, &cfg));
        while (aisle_rrt_step(&tree, 200, &spent) == AISLE_BUSY) {
            TEST_ASSERT_TRUE(aisle_rrt_cost(&tree) <= before);
            before = aisle_rrt_cost(&tree);
        }
        judge_path();
        TEST_ASSERT_TRUE(tree.rewired > 0U);
        TEST_ASSERT_TRUE(aisle_rrt_cost(&tree) >= optimum);
        TEST_ASSERT_TRUE(aisle_rrt_cost(&tree) <= 1.02 * optimum);
        TEST_ASSERT_TRUE(aisle_rrt_cost(&tree) <= tree.first_cost);
    }
}

static void test_a_path_that_is_shortened_leaves_out_what_it_can(void) {
    double plain = 0.0, shorter = 0.0;
    for (cfg.seed = 0; cfg.seed < SEEDS; cfg.seed++) {
        cfg.shorten = false;
        TEST_ASSERT_EQUAL(AISLE_OK, grow(UINT32_MAX));
        const double cost = aisle_rrt_cost(&tree);
        const uint32_t first = tree.first_sample;
        cfg.shorten = true;
        TEST_ASSERT_EQUAL(AISLE_OK, grow(UINT32_MAX));
        judge_path();
        TEST_ASSERT_EQUAL_UINT32(first, tree.first_sample); // the same tree until then
        TEST_ASSERT_TRUE(aisle_rrt_cost(&tree) <= cost);
        plain += cost;
        shorter += aisle_rrt_cost(&tree);
    }
    TEST_ASSERT_TRUE(shorter < 0.9 * plain);
}

static void test_costs_may_differ_from_distances_and_by_direction(void) {
    space.cost = twice_uphill;
    space.bound = beeline;
    cfg.star = cfg.informed = true;
    cfg.halvings = 6;
    TEST_ASSERT_EQUAL(AISLE_OK, grow(UINT32_MAX));
    judge_path();
    TEST_ASSERT_TRUE(aisle_rrt_cost(&tree) >= 2.0 * hypot(0.35, 0.5) + 0.1 + 0.5);
    TEST_ASSERT_TRUE(aisle_rrt_cost(&tree) <= 1.03 * (2.0 * hypot(0.35, 0.5) + 0.1 + 0.5));
}

static void test_in_the_plain_form_a_long_fixed_step_fails_where_half_of_it_gets_through(void) {
    cfg.goal_bias = 0.0;
    cfg.reach = 0.0;
    cfg.step = 0.8;
    cfg.goal[1] = 0.9;
    cfg.samples = 6000;
    uint32_t fixed = 0, adaptive = 0;
    for (cfg.seed = 0; cfg.seed < SEEDS; cfg.seed++) {
        cfg.halvings = 0;
        cfg.whole_steps = true;
        fixed += grow(UINT32_MAX) == AISLE_OK ? 1U : 0U;
        cfg.halvings = 1;
        cfg.whole_steps = false;
        adaptive += grow(UINT32_MAX) == AISLE_OK ? 1U : 0U;
    }
    TEST_ASSERT_EQUAL_UINT32(0, fixed);
    TEST_ASSERT_EQUAL_UINT32(SEEDS, adaptive);
}

static void test_any_slicing_gives_the_same_tree(void) {
    static unsigned char whole[BLOCK];
    cfg.star = cfg.informed = true;
    cfg.halvings = 6;
    cfg.more = 500;
    (void)grow(UINT32_MAX);
    const uint32_t nodes = tree.near.count;
    memcpy(whole, block, BLOCK);
    for (uint32_t slice = 1; slice < 40U; slice += 7U) {
        (void)grow(slice);
        TEST_ASSERT_EQUAL_UINT32(nodes, tree.near.count);
        TEST_ASSERT_EQUAL_MEMORY(whole, block, BLOCK);
    }
}

static void test_without_a_way_it_ends_with_its_samples_or_its_nodes(void) {
    walls = shut;
    wall_count = 1;
    cfg.samples = 500;
    TEST_ASSERT_EQUAL(AISLE_PARTIAL, grow(UINT32_MAX));
    TEST_ASSERT_EQUAL_UINT32(500, tree.samples);
    TEST_ASSERT_EQUAL_UINT32(0, aisle_rrt_path(&tree, path, CAPACITY + 1));
    TEST_ASSERT_TRUE(tree.first_cost > 1e300);
    cfg.samples = 1000000;
    TEST_ASSERT_EQUAL(AISLE_PARTIAL, grow(UINT32_MAX));
    TEST_ASSERT_EQUAL_UINT32(CAPACITY, tree.near.count);
    uint32_t spent = 0;
    TEST_ASSERT_EQUAL(AISLE_PARTIAL, aisle_rrt_step(&tree, 10, &spent));
    TEST_ASSERT_EQUAL_UINT32(0, spent);
}

static void test_a_goal_in_sight_is_reached_at_once(void) {
    wall_count = 0;
    cfg.star = cfg.informed = true;
    TEST_ASSERT_EQUAL(AISLE_OK, grow(UINT32_MAX));
    TEST_ASSERT_EQUAL_UINT32(0, tree.samples);
    TEST_ASSERT_EQUAL_UINT32(2, aisle_rrt_path(&tree, path, 1)); // does not fit: nothing written
    judge_path();
}

static void test_a_config_that_breaks_a_rule_is_refused_and_changes_nothing(void) {
    (void)grow(UINT32_MAX);
    const uint32_t nodes = tree.near.count;
    const aisle_rrt_config good = cfg;
    for (int i = 0; i < 6; i++) {
        cfg = good;
        cfg.space = i == 0 ? NULL : cfg.space;
        cfg.step = i == 1 ? 0.0 : i == 2 ? (double)NAN : cfg.step;
        cfg.goal_bias = i == 3 ? 1.0 : cfg.goal_bias;
        cfg.reach = i == 4 ? -1.0 : cfg.reach;
        cfg.samples = i == 5 ? 0U : cfg.samples;
        TEST_ASSERT_EQUAL(AISLE_ERR_ARG, aisle_rrt_start(&tree, &cfg));
        TEST_ASSERT_EQUAL_UINT32(nodes, tree.near.count);
    }
}

static void test_spoilt_memory_is_noticed(void) {
    (void)grow(UINT32_MAX);
    tree.node[1].cost += 0.1;
    TEST_ASSERT_FALSE(aisle_rrt_invariants_hold(&tree));
    tree.node[1].cost -= 0.1;
    const uint32_t child = tree.node[0].child;
    tree.node[child].parent = 1U + child;
    TEST_ASSERT_FALSE(aisle_rrt_invariants_hold(&tree));
}

static uint32_t retracted;

static void retract(void *context, double *q) {
    (void)context;
    retracted++;
    if (q[0] > 0.4 && q[0] < 0.6) { // into the slit
        q[1] = 0.62;
    }
}

static void test_every_other_sample_is_retracted_if_that_is_asked_until_there_is_a_path(void) {
    uint32_t plain = 0, moved = 0;
    space.retract = retract;
    cfg.star = true;
    cfg.more = 200;
    cfg.goal_bias = 0.0;
    for (cfg.seed = 0; cfg.seed < SEEDS; cfg.seed++) {
        for (int asked = 0; asked < 2; asked++) {
            cfg.retract = asked != 0;
            retracted = 0;
            TEST_ASSERT_EQUAL(AISLE_OK, grow(UINT32_MAX));
            judge_path();
            TEST_ASSERT_EQUAL_UINT32(asked != 0 ? tree.first_sample / 2U : 0U, retracted);
            *(asked != 0 ? &moved : &plain) += tree.first_sample;
        }
    }
    TEST_ASSERT_TRUE(moved < plain);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_every_planner_finds_a_free_way_through_the_slit);
    RUN_TEST(test_a_star_comes_near_the_optimum_and_never_gets_worse);
    RUN_TEST(test_a_path_that_is_shortened_leaves_out_what_it_can);
    RUN_TEST(test_costs_may_differ_from_distances_and_by_direction);
    RUN_TEST(test_in_the_plain_form_a_long_fixed_step_fails_where_half_of_it_gets_through);
    RUN_TEST(test_any_slicing_gives_the_same_tree);
    RUN_TEST(test_without_a_way_it_ends_with_its_samples_or_its_nodes);
    RUN_TEST(test_a_goal_in_sight_is_reached_at_once);
    RUN_TEST(test_a_config_that_breaks_a_rule_is_refused_and_changes_nothing);
    RUN_TEST(test_spoilt_memory_is_noticed);
    RUN_TEST(test_every_other_sample_is_retracted_if_that_is_asked_until_there_is_a_path);
    return UNITY_END();
}
