#include "plan/vehicle_space.h" // first: proves that the header stands alone

#include "base/angle.h"
#include "hall.h"

enum { DRAWS = 400 };

static aisle_space space;
static aisle_vehicle_space configurations;

static void open_hall(aisle_vehicle_space_kind kind) {
    hall_begin(12.0, 8.0);
    hall_add(5.0, 3.0, 7.0, 5.0);
    aisle_arena arena = hall_arena(24U << 20);
    aisle_space_carve(&space, &arena, hall_limits.cells);
    hall_open(&arena, 0.05F);
    aisle_space_begin(&space, &hall_layout, &hall_vehicle,
                      kind == AISLE_VEHICLE_SPACE_PLACE ? AISLE_SPACE_FREE_TURN : AISLE_SPACE_ALONG);
    aisle_vehicle_space_begin(&configurations, &space, kind);
}

void setUp(void) {}
void tearDown(void) {}

// Steering goes from a to b, in bounds, and never farther than the metric's weights say.
static void judge_steering(uint64_t seed) {
    const aisle_cspace *c = &configurations.cspace;
    aisle_rng rng = aisle_rng_seed(seed);
    double a[3], b[3], q[3];
    for (int i = 0; i < DRAWS; i++) {
        c->sample(c->context, &rng, a);
        c->sample(c->context, &rng, b);
        TEST_ASSERT_TRUE(aisle_cspace_cost(c, a, b) >= aisle_cspace_bound(c, a, b) - 1e-9);
        aisle_move moves[AISLE_REEDS_SHEPP_MOVES];
        double length = 0.0;
        for (uint32_t n = c->dim == 3U ? aisle_vehicle_space_moves(&configurations, a, b, moves) : 0U; n > 0U; n--) {
            length += fabs(moves[n - 1U].length);
        }
        const double apart = hypot(b[0] - a[0], b[1] - a[1]);
        TEST_ASSERT_TRUE(length <= aisle_vehicle_space_longest(&configurations, apart));
        for (int part = 0; part <= 4; part++) {
            c->steer(c->context, a, b, 0.25 * part, q);
            const double *end = part == 0 ? a : b;
            if (part == 0 || part == 4) {
                TEST_ASSERT_TRUE(aisle_cspace_distance(c, q, end) < 1e-7);
            }
            TEST_ASSERT_TRUE(c->dim == 2U || (q[2] >= -AISLE_PI && q[2] < AISLE_PI));
        }
    }
}

static void test_steering_joins_any_two_configurations(void) {
    hall_disc(0.3, 0.05F);
    open_hall(AISLE_VEHICLE_SPACE_PLACE);
    judge_steering(1);
    hall_rectangle(1.0, 0.6, 0.05F);
    open_hall(AISLE_VEHICLE_SPACE_POSE);
    judge_steering(2);
    hall_vehicle.curvature_max = 1.0;
    aisle_vehicle_space_begin(&configurations, &space, AISLE_VEHICLE_SPACE_POSE);
    judge_steering(3);
}

// Every configuration on a motion that is called free keeps the margin; and motions are called so.
static void judge_motions(uint64_t seed) {
    const aisle_cspace *c = &configurations.cspace;
    aisle_rng rng = aisle_rng_seed(seed);
    double a[3], b[3], q[3];
    int yes = 0, no = 0;
    for (int i = 0; i < DRAWS; i++) {
        uint32_t units = 0;
        c->sample(c->context, &rng, a);
        c->sample(c->context, &rng, b);
        if (!c->is_free(c->context, a, b, &units)) {
            no++;
            continue;
        }
        yes++;
        for (int k = 0; k <= 60; k++) {
            c->steer(c->context, a, b, k / 60.0, q);
            const aisle_pose2 pose = aisle_vehicle_space_pose(&configurations, q);
            const double gap = aisle_vehicle_is_disc(&hall_vehicle)
                                   ? (double)hall_disc_gap(q[0], q[1], hall_vehicle.outer_radius)
                                   : hall_body_gap(pose);
            TEST_ASSERT_TRUE(gap >= hall_vehicle.margin - 1e-6);
        }
        TEST_ASSERT_TRUE(units >= 1U);
    }
    TEST_ASSERT_TRUE(yes > DRAWS / 20 && no > DRAWS / 20);
}

static void test_no_configuration_on_a_free_motion_is_nearer_than_the_margin(void) {
    hall_disc(0.3, 0.05F);
    open_hall(AISLE_VEHICLE_SPACE_PLACE);
    judge_motions(4);
    hall_rectangle(1.0, 0.6, 0.05F);
    open_hall(AISLE_VEHICLE_SPACE_POSE);
    judge_motions(5);
}

static void test_samples_between_are_those_a_cheaper_way_may_run_through(void) {
    hall_disc(0.3, 0.05F);
    open_hall(AISLE_VEHICLE_SPACE_PLACE);
    const aisle_cspace *c = &configurations.cspace;
    const double a[2] = {2.0, 2.0}, b[2] = {9.0, 5.0}, most = 8.0;
    aisle_rng rng = aisle_rng_seed(6);
    int left = 0, above = 0;
    for (int i = 0; i < DRAWS; i++) {
        double q[2];
        c->sample_between(c->context, &rng, a, b, most, q);
        const double sum = hypot(q[0] - a[0], q[1] - a[1]) + hypot(q[0] - b[0], q[1] - b[1]);
        TEST_ASSERT_TRUE(sum <= most + 1e-9);
        left += (q[0] - 5.5) * 7.0 + (q[1] - 3.5) * 3.0 < 0.0 ? 1 : 0;
        above += (q[1] - 3.5) * 7.0 - (q[0] - 5.5) * 3.0 > 0.0 ? 1 : 0;
    }
    TEST_ASSERT_INT_WITHIN(DRAWS / 8, DRAWS / 2, left); // even over both axes of the ellipse
    TEST_ASSERT_INT_WITHIN(DRAWS / 8, DRAWS / 2, above);
}

// A motion of a disc that is refused comes nearer than what is kept, the field's first looks and the exact test alike.
static void test_a_motion_that_is_refused_comes_too_near_somewhere(void) {
    hall_disc(0.3, 0.05F);
    open_hall(AISLE_VEHICLE_SPACE_PLACE);
    const aisle_cspace *c = &configurations.cspace;
    aisle_rng rng = aisle_rng_seed(6);
    double a[2], b[2], q[2];
    int refused = 0;
    for (int i = 0; i < DRAWS; i++) {
        uint32_t units = 0;
        c->sample(c->context, &rng, a);
        c->sample(c->context, &rng, b);
        if (c->is_free(c->context, a, b, &units)) {
            continue;
        }
        double least = 1.0;
        for (int k = 0; k <= 2000; k++) {
            c->steer(c->context, a, b, k / 2000.0, q);
            least = fmin(least, (double)hall_disc_gap(q[0], q[1], hall_vehicle.outer_radius));
        }
        TEST_ASSERT_TRUE(least < hall_vehicle.margin + AISLE_SPACE_SLACK + 1e-4);
        refused++;
    }
    TEST_ASSERT_TRUE(refused > DRAWS / 10);
}

static void judge_retracting(uint64_t seed) {
    const aisle_cspace *c = &configurations.cspace;
    aisle_rng rng = aisle_rng_seed(seed);
    double p[3], q[3];
    int stuck = 0, freed = 0;
    for (int i = 0; i < 4 * DRAWS; i++) {
        c->sample(c->context, &rng, p);
        memcpy(q, p, sizeof q);
        c->retract(c->context, q);
        const double before = (double)hall_disc_gap(p[0], p[1], 0.0) - space.reach;
        const double after = (double)hall_disc_gap(q[0], q[1], 0.0) - space.reach;
        TEST_ASSERT_TRUE(q[0] >= c->lo[0] && q[0] <= c->hi[0] && q[1] >= c->lo[1] && q[1] <= c->hi[1]);
        TEST_ASSERT_TRUE(c->dim == 2U || !(p[2] < q[2] || p[2] > q[2]));
        if (before >= 0.0) {
            TEST_ASSERT_EQUAL_MEMORY(p, q, c->dim * sizeof *p);
        } else {
            stuck += after < 0.0 ? 1 : 0;
            freed += after >= 0.0 ? 1 : 0;
        }
    }
    TEST_ASSERT_TRUE(freed > 0 && freed > stuck / 4);
}

static void test_samples_beside_obstacles_are_moved_off_them_and_free_ones_stay(void) {
    hall_disc(0.3, 0.05F);
    open_hall(AISLE_VEHICLE_SPACE_PLACE);
    judge_retracting(7);
    hall_rectangle(1.0, 0.6, 0.05F);
    open_hall(AISLE_VEHICLE_SPACE_POSE);
    judge_retracting(8);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_steering_joins_any_two_configurations);
    RUN_TEST(test_no_configuration_on_a_free_motion_is_nearer_than_the_margin);
    RUN_TEST(test_samples_between_are_those_a_cheaper_way_may_run_through);
    RUN_TEST(test_a_motion_that_is_refused_comes_too_near_somewhere);
    RUN_TEST(test_samples_beside_obstacles_are_moved_off_them_and_free_ones_stay);
    return UNITY_END();
}
