#include "plan/arm_space.h" // first: proves that the header stands alone

#include "arm_hall.h"

enum { SEEDS = 200, NODES = 2000, FINE = 1000 };

static aisle_arm_space space;
static aisle_rrt tree;
static uint32_t way[NODES + 1];

void setUp(void) {
    arm_hall_begin();
}
void tearDown(void) {}

static void open_hall(void) {
    hall_add(6.1, 4.95, 6.4, 5.05);
    aisle_arena arena = arm_hall_open(64U);
    aisle_rrt_carve(&tree, &arena, NODES, AISLE_ARM_LINKS);
    TEST_ASSERT_FALSE(arena.overflow);
    aisle_arm_space_begin(&space, &world);
}

static void test_samples_fill_the_joint_limits(void) {
    double lo[3] = {9.0, 9.0, 9.0}, hi[3] = {-9.0, -9.0, -9.0};
    open_hall();
    TEST_ASSERT_EQUAL_UINT32(3, space.cspace.dim);
    aisle_rng rng = aisle_rng_seed(1);
    for (int i = 0; i < 2000; i++) {
        double q[3];
        space.cspace.sample(space.cspace.context, &rng, q);
        for (uint32_t j = 0; j < 3U; j++) {
            lo[j] = fmin(lo[j], q[j]);
            hi[j] = fmax(hi[j], q[j]);
        }
    }
    for (uint32_t j = 0; j < 3U; j++) {
        TEST_ASSERT_TRUE(lo[j] >= arm.min[j] && hi[j] <= arm.max[j]);
        TEST_ASSERT_TRUE(hi[j] - lo[j] > 0.99 * (arm.max[j] - arm.min[j]));
    }
}
static void test_steps_are_parts_of_the_straight_line_and_the_last_one_ends_on_its_end(void) {
    open_hall();
    for (uint64_t seed = 0; seed < SEEDS; seed++) {
        aisle_rng rng = aisle_rng_seed(seed);
        double a[3], b[3], q[3];
        arm_draw(&rng, a);
        arm_draw(&rng, b);
        const double part = uniform(&rng, 0.0, 1.0);
        space.cspace.steer(space.cspace.context, a, b, part, q);
        for (uint32_t j = 0; j < 3U; j++) {
            TEST_ASSERT_DOUBLE_WITHIN(1e-12, (1.0 - part) * a[j] + part * b[j], q[j]);
        }
        space.cspace.steer(space.cspace.context, a, b, 1.0, q);
        TEST_ASSERT_EQUAL_MEMORY(b, q, sizeof q);
        TEST_ASSERT_DOUBLE_WITHIN(
            1e-12, sqrt((a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]) + (a[2] - b[2]) * (a[2] - b[2])),
            aisle_cspace_distance(&space.cspace, a, b));
    }
}

static bool is_line_free(const double *a, const double *b) { // by the judge
    for (int i = 0; i <= FINE; i++) {
        double q[3];
        for (uint32_t j = 0; j < 3U; j++) {
            q[j] = a[j] + (b[j] - a[j]) * (double)i / (FINE);
        }
        if (!(arm_judged(q) > 0.0)) {
            return false;
        }
    }
    return true;
}

static void test_every_planners_path_is_free_from_end_to_end_and_costs_its_length(void) {
    static const double from[3] = {-0.8, 0.0, 0.0}, to[3] = {0.8, 0.0, 0.0};
    open_hall();
    for (int kind = 0; kind < 4; kind++) {
        uint32_t spent = 0;
        aisle_rrt_config cfg = aisle_arm_space_rrt(&space, kind % 2 == 1, kind >= 2, kind == 0 ? 0.3 : 0.0);
        TEST_ASSERT_EQUAL_DOUBLE(kind == 0 ? 0.3 : 0.5, cfg.step);
        TEST_ASSERT_EQUAL(kind % 2 == 1, cfg.star);
        TEST_ASSERT_EQUAL(kind >= 2, cfg.halvings > 0U);
        memcpy(cfg.start, from, sizeof from);
        memcpy(cfg.goal, to, sizeof to);
        TEST_ASSERT_EQUAL(AISLE_OK, aisle_rrt_start(&tree, &cfg));
        while (aisle_rrt_step(&tree, 10000, &spent) == AISLE_BUSY) {
        }
        const uint32_t count = aisle_rrt_path(&tree, way, NODES + 1U);
        TEST_ASSERT_GREATER_THAN_UINT32(2U, count); // the straight line is blocked
        double length = 0.0;
        for (uint32_t i = 1; i < count; i++) {
            const double *a = aisle_rrt_at(&tree, way[i - 1U]), *b = aisle_rrt_at(&tree, way[i]);
            TEST_ASSERT_TRUE(is_line_free(a, b));
            length += hypot(hypot(a[0] - b[0], a[1] - b[1]), a[2] - b[2]);
        }
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, aisle_rrt_cost(&tree), length);
        TEST_ASSERT_FALSE(is_line_free(from, to));
    }
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_samples_fill_the_joint_limits);
    RUN_TEST(test_steps_are_parts_of_the_straight_line_and_the_last_one_ends_on_its_end);
    RUN_TEST(test_every_planners_path_is_free_from_end_to_end_and_costs_its_length);
    return UNITY_END();
}
