#include "plan/arm_world.h" // first: proves that the header stands alone

#include "hall.h"
#include "plan/arm_search.h"
#include "plan/arm_space.h"

enum { SEEDS = 200, FINE = 4000 };

static aisle_vehicle_msg msg;
static aisle_vehicle vehicle;
static aisle_arm arm;
static aisle_arm_world world;
static aisle_arm_search search;
static const aisle_pose2 pose = {5.0, 5.0, 0.0};

static void begin(void) {
    aisle_arena arena = hall_arena(HALL_BLOCK);
    aisle_refusal why;
    hall_open(&arena, 0.0F);
    aisle_arm_world_carve(&world, &arena, 64U);
    aisle_arm_search_carve(&search, &arena);
    TEST_ASSERT_FALSE(arena.overflow);
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_vehicle_from_msg(&msg, &vehicle, &why));
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_arm_from_msg(&msg, &arm, &why));
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_arm_world_begin(&world, &hall_layout, &vehicle, &arm, pose));
}

void setUp(void) {
    memset(&msg, 0, sizeof msg);
    msg.num_links = 3;
    msg.arm_base[0] = 0.5;
    for (int i = 0; i < 3; i++) {
        msg.link_length[i] = 0.5F - 0.1F * (float)i;
        msg.link_radius[i] = 0.03F;
        msg.joint_min[i] = i == 0 ? -1.0F : -2.8F;
        msg.joint_max[i] = -msg.joint_min[i];
    }
    hall_begin(10.0, 10.0);
}
void tearDown(void) {}

// ---- the judge: in long double, points along the axes

static long double point_box(long double x, long double y, long double x0, long double y0, long double x1,
                             long double y1) {
    const long double dx = fmaxl(fmaxl(x0 - x, 0.0L), x - x1), dy = fmaxl(fmaxl(y0 - y, 0.0L), y - y1);
    return sqrtl(dx * dx + dy * dy);
}

// Least gap over points 1 mm apart on the links; true to half a millimetre.
static double judged(const double *q) {
    long double x = 5.5L, y = 5.0L, phi = 0.0L, least = 1.0L, first_x[501], first_y[501];
    int firsts = 0;
    for (uint32_t i = 0; i < 3U; i++) {
        phi += (long double)q[i];
        const int steps = (int)(arm.length[i] * 1000.0 + 0.5);
        for (int k = 0; k <= steps; k++) {
            const long double at = (long double)arm.length[i] * k / steps;
            const long double px = x + at * cosl(phi), py = y + at * sinl(phi), r = (long double)arm.radius[i];
            for (int b = 0; b < hall_count; b++) {
                least = fminl(
                    least,
                    point_box(px, py, hall_boxes[b].x0, hall_boxes[b].y0, hall_boxes[b].x1, hall_boxes[b].y1) - r);
            }
            least = i > 0U || (double)at >= world.exempt ? fminl(least, point_box(px, py, 4.5L, 4.65L, 5.5L, 5.35L) - r)
                                                         : least;
            if (i == 0U) {
                first_x[firsts] = px;
                first_y[firsts++] = py;
            }
            for (int f = 0; i == 2U && f < firsts; f += 5) {
                least = fminl(least, hypotl(px - first_x[f], py - first_y[f]) - r - (long double)arm.radius[0]);
            }
        }
        x += (long double)arm.length[i] * cosl(phi);
        y += (long double)arm.length[i] * sinl(phi);
    }
    return (double)fmaxl(least, 0.0L);
}

static void draw(aisle_rng *rng, double *q) {
    for (uint32_t j = 0; j < 3U; j++) {
        q[j] = arm.min[j] + (arm.max[j] - arm.min[j]) * (double)aisle_rng_float(rng);
    }
}

static void test_gaps_are_the_judges(void) {
    int in_contact = 0;
    hall_add(6.1, 5.1, 6.3, 5.3);
    hall_add(5.9, 4.4, 6.2, 4.6);
    begin();
    TEST_ASSERT_DOUBLE_WITHIN(1e-7, 0.06, world.exempt); // the base lies on the rim
    for (uint64_t seed = 0; seed < SEEDS; seed++) {
        aisle_rng rng = aisle_rng_seed(seed);
        double q[3], gaps[3];
        int32_t id;
        draw(&rng, q);
        const double gap = aisle_arm_world_gap(&world, q, 0.3, gaps, &id), want = fmin(judged(q), 0.3);
        TEST_ASSERT_DOUBLE_WITHIN(3e-3, want, gap);
        TEST_ASSERT_EQUAL_DOUBLE(gap, fmin(gaps[0], fmin(gaps[1], gaps[2])));
        TEST_ASSERT_EQUAL(gap < 0.3, id != 0);
        TEST_ASSERT_EQUAL(gap<AISLE_ARM_KEEP, aisle_arm_world_depth(&world, q)> 0.0);
        in_contact += gap > 0.0 ? 0 : 1;
    }
    TEST_ASSERT_TRUE(in_contact > 20 && in_contact < 180);
}
static void test_depth_falls_steadily_on_the_way_out(void) {
    hall_add(6.1, 4.9, 6.5, 5.1);
    begin();
    double before = INFINITY;
    for (int i = 0; i <= 50; i++) { // the stretched arm turns out of the box
        const double q[3] = {0.02 * i, 0.0, 0.0}, depth = aisle_arm_world_depth(&world, q);
        TEST_ASSERT_TRUE(depth <= before + 5e-3); // aslant the way through it is a little longer
        before = depth;
    }
    TEST_ASSERT_EQUAL_DOUBLE(0.0, before);
}
static void test_ids_of_body_arm_and_bounds_are_told(void) {
    int32_t id;
    hall_begin(10.0, 5.5);
    begin();
    const double back[3] = {1.0, 2.8, 0.0}, folded[3] = {0.0, 2.75, 2.3}, up[3] = {1.0, 0.0, 0.0};
    (void)aisle_arm_world_gap(&world, back, 0.3, NULL, &id);
    TEST_ASSERT_EQUAL_INT32(AISLE_ARM_ID_BODY, id);
    (void)aisle_arm_world_gap(&world, folded, 0.3, NULL, &id);
    TEST_ASSERT_EQUAL_INT32(AISLE_ARM_ID_ARM, id);
    (void)aisle_arm_world_gap(&world, up, 0.3, NULL, &id);
    TEST_ASSERT_EQUAL_INT32(AISLE_LAYOUT_ID_BOUNDS, id);
}
static void test_more_obstacles_than_fit_are_told(void) {
    aisle_arena arena = hall_arena(HALL_BLOCK);
    hall_add(6.1, 4.9, 6.5, 5.1);
    hall_add(6.1, 5.2, 6.5, 5.3);
    begin();
    aisle_arm_world_carve(&world, &arena, 1U);
    TEST_ASSERT_EQUAL(AISLE_ERR_CAPACITY, aisle_arm_world_begin(&world, &hall_layout, &vehicle, &arm, pose));
}
static void test_a_motion_called_free_keeps_its_distance_everywhere_and_others_touch(void) {
    int free_ones = 0, blocked = 0;
    hall_add(6.1, 5.1, 6.3, 5.3);
    hall_add(5.9, 4.4, 6.2, 4.6);
    begin();
    for (uint64_t seed = 0; seed < SEEDS; seed++) {
        aisle_rng rng = aisle_rng_seed(seed);
        double from[3], to[3], bend[6], until, least = INFINITY, q[3];
        aisle_arm_piece piece;
        uint32_t units = 0;
        draw(&rng, from);
        draw(&rng, to);
        for (int i = 0; i < 6; i++) {
            bend[i] = 40.0 * ((double)aisle_rng_float(&rng) - 0.5);
        }
        aisle_arm_piece_of(3U, from, to, bend, &piece);
        const bool is_free = aisle_arm_world_free(&world, &piece, &units, &until);
        for (int i = 0; i <= FINE; i++) {
            aisle_arm_piece_at(&piece, (double)i / FINE, 0, q);
            const double gap = aisle_arm_world_gap(&world, q, 0.3, NULL, NULL);
            TEST_ASSERT_TRUE(gap >= 0.5 * AISLE_ARM_KEEP || (double)i / FINE > until - 1e-9);
            least = fmin(least, gap);
        }
        TEST_ASSERT_TRUE(is_free ? least >= 0.5 * AISLE_ARM_KEEP : least < 1.1 * AISLE_ARM_KEEP);
        free_ones += is_free ? 1 : 0;
        blocked += is_free ? 0 : 1;
    }
    TEST_ASSERT_TRUE(free_ones > 5 && blocked > 5);
}

// ---- the spaces and searches over it

static void test_the_joint_space_agrees_with_the_world(void) {
    aisle_arm_space space;
    hall_add(6.1, 5.1, 6.3, 5.3);
    begin();
    aisle_arm_space_begin(&space, &world);
    TEST_ASSERT_EQUAL_UINT32(3, space.cspace.dim);
    for (uint64_t seed = 0; seed < SEEDS; seed++) {
        aisle_rng rng = aisle_rng_seed(seed);
        double a[3], b[3], q[3];
        uint32_t units = 0;
        aisle_arm_piece piece;
        space.cspace.sample(space.cspace.context, &rng, a);
        space.cspace.sample(space.cspace.context, &rng, b);
        TEST_ASSERT_EQUAL_UINT32(0, aisle_arm_joint_out(&arm, a, 0.0));
        aisle_arm_piece_of(3U, a, b, NULL, &piece);
        TEST_ASSERT_EQUAL(aisle_arm_world_free(&world, &piece, &units, NULL),
                          space.cspace.is_free(space.cspace.context, a, b, &units));
        space.cspace.steer(space.cspace.context, a, b, 1.0, q);
        TEST_ASSERT_EQUAL_MEMORY(b, q, sizeof q);
        space.cspace.steer(space.cspace.context, a, b, 0.25, q);
        TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0.75 * a[1] + 0.25 * b[1], q[1]);
    }
}
static int escapes(int8_t objective, int8_t planner, int seeds) {
    static const double from[3] = {-0.9, 0.0, 0.0}, to[3] = {0.9, 0.0, 0.0};
    int found = 0;
    for (int seed = 0; seed < seeds; seed++) {
        aisle_options_msg options = {.objective = objective, .planner = planner, .seed = seed};
        aisle_arm_piece piece;
        uint32_t spent = 0;
        aisle_status st;
        aisle_arm_search_start(&search, &world, from, to, &options);
        do {
            st = aisle_arm_search_step(&search, 1000, &spent);
        } while (st == AISLE_BUSY);
        TEST_ASSERT_EQUAL(st == AISLE_OK, aisle_arm_search_best(&search, &piece));
        if (st == AISLE_OK) { // and what it found is free
            TEST_ASSERT_TRUE(aisle_arm_world_free(&world, &piece, &spent, NULL));
            TEST_ASSERT_EQUAL_UINT32(0, aisle_arm_piece_joint_out(&piece, &arm, NULL));
            found++;
        }
    }
    return found;
}
static void test_graded_depth_escapes_where_the_death_penalty_seldom_does(void) {
    hall_add(6.35, 4.95, 6.6, 5.05);
    begin();
    const int graded = escapes(AISLE_OPTIONS_SHORTEST, AISLE_OPTIONS_GA, 20);
    const int swarm = escapes(AISLE_OPTIONS_SHORTEST, AISLE_OPTIONS_PSO, 20);
    const int paper = escapes(AISLE_OPTIONS_PAPER, AISLE_OPTIONS_GA, 20);
    TEST_ASSERT_EQUAL_INT(20, graded);
    TEST_ASSERT_GREATER_OR_EQUAL_INT(18, swarm);
    TEST_ASSERT_LESS_THAN_INT(graded, paper);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_gaps_are_the_judges);
    RUN_TEST(test_depth_falls_steadily_on_the_way_out);
    RUN_TEST(test_ids_of_body_arm_and_bounds_are_told);
    RUN_TEST(test_more_obstacles_than_fit_are_told);
    RUN_TEST(test_a_motion_called_free_keeps_its_distance_everywhere_and_others_touch);
    RUN_TEST(test_the_joint_space_agrees_with_the_world);
    RUN_TEST(test_graded_depth_escapes_where_the_death_penalty_seldom_does);
    return UNITY_END();
}
