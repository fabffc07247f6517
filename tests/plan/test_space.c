#include "plan/space.h"

#include "cases.h"
#include "hall.h"

#include "robot/curve.h"

enum { SEEDS = CASES(16) };

static aisle_space space;
static uint32_t units;

static void random_hall(aisle_rng *rng) {
    hall_begin(12.0, 9.0);
    for (int i = 0; i < 8; i++) {
        double x = uniform(rng, 0.5, 10.0);
        double y = uniform(rng, 0.5, 7.5);
        double w = uniform(rng, 0.2, 2.0);
        double h = uniform(rng, 0.2, 1.5);
        hall_add(x, y, x + w, y + h);
    }
}

static void open_space(aisle_space_mode mode) {
    aisle_arena arena = hall_arena(24U << 20);
    memset(&space, 0, sizeof space);
    aisle_space_carve(&space, &arena, hall_limits.cells);
    hall_open(&arena, 0.05F);
    aisle_space_begin(&space, &hall_layout, &hall_vehicle, mode);
    units = 0;
}

void setUp(void) {
    hall_disc(0.3, 0.1F);
}
void tearDown(void) {}

// Least gap of the vehicle along a straight way, heading along it, sampled every 5 mm.
static double sampled_sweep_gap(aisle_vec2 a, aisle_vec2 b) {
    double theta = atan2(b.y - a.y, b.x - a.x);
    int steps = 1 + (int)(aisle_vec2_distance(a, b) / 0.005);
    double least = 1e9;
    for (int i = 0; i <= steps; i++) {
        aisle_vec2 p = aisle_vec2_lerp(a, b, (double)i / steps);
        least = fmin(least, hall_body_gap((aisle_pose2){p.x, p.y, theta}));
    }
    return least;
}

static void test_a_cell_is_free_just_where_the_disc_has_its_margin_and_the_steps_slack(void) {
    int free_cells = 0;
    for (uint64_t seed = 0; seed < 6; seed++) {
        aisle_rng rng = aisle_rng_seed(seed);
        random_hall(&rng);
        open_space(AISLE_SPACE_FREE_TURN);
        const aisle_lattice *lattice = &space.grid->lattice;
        double need = sqrt(space.reach * space.reach + 0.5 * lattice->res * lattice->res);
        for (uint32_t cell = 0; cell < lattice->w * lattice->h; cell++) {
            aisle_vec2 c = aisle_lattice_centre(lattice, cell);
            double gap = (double)hall_disc_gap(c.x, c.y, 0.0);
            bool free = aisle_space_cell_free(&space, cell, lattice->res, &units);
            TEST_ASSERT_EQUAL(free, aisle_space_cell_free(&space, cell, lattice->res, &units)); // remembered
            TEST_ASSERT_FALSE(free && gap < need - 1e-9);
            TEST_ASSERT_FALSE(!free && gap > need + 1e-9);
            free_cells += free;
        }
    }
    TEST_ASSERT_GREATER_THAN(6 * 5000, free_cells);
}

static void sweeps_agree_with_dense_sampling(aisle_space_mode mode, int least_free) {
    int free_ways = 0;
    for (uint64_t seed = 0; seed < SEEDS; seed++) {
        aisle_rng rng = aisle_rng_seed(seed);
        random_hall(&rng);
        open_space(mode);
        for (int k = 0; k < 25; k++) {
            aisle_vec2 a = uniform_point(&rng, aisle_vec2_of(0.0, 0.0), aisle_vec2_of(12.0, 9.0));
            aisle_vec2 way = uniform_point(&rng, aisle_vec2_of(-2.0, -2.0), aisle_vec2_of(2.0, 2.0));
            aisle_vec2 b = aisle_vec2_add(a, way);
            bool free = aisle_space_sweep_free(&space, a, b, &units);
            double gap = sampled_sweep_gap(a, b);
            TEST_ASSERT_FALSE(free && gap < hall_vehicle.margin + AISLE_SPACE_SLACK - 1e-6);
            TEST_ASSERT_FALSE(!free && gap > hall_vehicle.margin + AISLE_SPACE_SLACK + 2e-3);
            free_ways += free;
        }
    }
    TEST_ASSERT_GREATER_THAN(CASES(least_free), free_ways);
}

static void test_a_disc_sweep_is_free_just_where_dense_samples_keep_the_margin(void) {
    sweeps_agree_with_dense_sampling(AISLE_SPACE_FREE_TURN, 60);
}

static void test_a_body_sweep_is_free_just_where_dense_samples_keep_the_margin(void) {
    hall_rectangle(1.2, 0.5, 0.05F);
    sweeps_agree_with_dense_sampling(AISLE_SPACE_ALONG, 60);
}

static void test_free_turn_stands_for_every_heading(void) {
    hall_rectangle(1.2, 0.5, 0.05F);
    for (uint64_t seed = 0; seed < SEEDS; seed++) {
        aisle_rng rng = aisle_rng_seed(seed);
        random_hall(&rng);
        open_space(AISLE_SPACE_FREE_TURN);
        for (int k = 0; k < 20; k++) {
            aisle_vec2 p = uniform_point(&rng, aisle_vec2_of(0.0, 0.0), aisle_vec2_of(12.0, 9.0));
            if (!aisle_space_sweep_free(&space, p, p, &units)) {
                continue;
            }
            for (int h = 0; h < 36; h++) {
                TEST_ASSERT_TRUE(hall_body_gap((aisle_pose2){p.x, p.y, 0.1745 * h}) >=
                                 (long double)hall_vehicle.margin);
            }
        }
    }
}

static void test_turn_free_is_told_just_where_the_turning_disc_keeps_the_margin(void) {
    int free_places = 0;
    hall_rectangle(1.2, 0.5, 0.05F);
    for (uint64_t seed = 0; seed < SEEDS; seed++) {
        aisle_rng rng = aisle_rng_seed(seed);
        random_hall(&rng);
        open_space(AISLE_SPACE_ALONG);
        for (int k = 0; k < 200; k++) {
            aisle_vec2 p = uniform_point(&rng, aisle_vec2_of(0.0, 0.0), aisle_vec2_of(12.0, 9.0));
            double gap = (double)hall_disc_gap(p.x, p.y, hall_vehicle.outer_radius) - space.keep;
            bool free = aisle_space_turn_free(&space, p, &units);
            TEST_ASSERT_FALSE(free && gap < -1e-9);
            TEST_ASSERT_FALSE(!free && gap > 1e-9);
            free_places += free;
        }
    }
    TEST_ASSERT_GREATER_THAN(CASES(100), free_places);
}

static void test_a_wall_thinner_than_a_cell_stops_a_point_sized_robot(void) {
    hall_begin(4.0, 4.0);
    hall_add(2.0, 0.0, 2.001, 4.0);
    hall_disc(0.001, -1.0F);
    open_space(AISLE_SPACE_FREE_TURN);
    TEST_ASSERT_FALSE(aisle_space_sweep_free(&space, aisle_vec2_of(1.0, 1.0), aisle_vec2_of(3.0, 1.3), &units));
    TEST_ASSERT_TRUE(aisle_space_sweep_free(&space, aisle_vec2_of(1.0, 1.0), aisle_vec2_of(1.99, 3.0), &units));
}

static void test_every_test_adds_its_units(void) {
    hall_begin(4.0, 4.0);
    open_space(AISLE_SPACE_FREE_TURN);
    TEST_ASSERT_TRUE(aisle_space_sweep_free(&space, aisle_vec2_of(1.0, 1.0), aisle_vec2_of(3.0, 3.0), &units));
    TEST_ASSERT_GREATER_THAN_UINT32(0, units);
}

// Sampled least gap over a piece of motion.
static double sampled_piece_gap(const aisle_waypoint_msg *a, const aisle_waypoint_msg *b) {
    double least = 1e9;
    for (int i = 0; i <= 250; i++) {
        least = fmin(least, hall_body_gap(aisle_piece_at(a, b, i / 250.0)));
    }
    return fmax(least, 0.0);
}

// A line or an arc with its heading along it, up to 1 m.
static void random_piece(aisle_rng *rng, bool straight, aisle_waypoint_msg *a, aisle_waypoint_msg *b) {
    double theta = uniform(rng, -3.0, 3.0);
    double curvature = straight ? 0.0 : uniform(rng, -1.5, 1.5);
    double length = uniform(rng, 0.01, 1.0);
    aisle_vec2 at = uniform_point(rng, aisle_vec2_of(0.5, 0.5), aisle_vec2_of(11.5, 8.5));
    double half = 0.5 * curvature * length;
    double chord = fabs(half) > 1e-9 ? length * sin(half) / half : length;
    *a = (aisle_waypoint_msg){.x = at.x, .y = at.y, .theta = theta};
    *b = (aisle_waypoint_msg){.x = at.x + chord * cos(theta + half),
                              .y = at.y + chord * sin(theta + half),
                              .theta = remainder(theta + 2.0 * half, 2.0 * acos(-1.0)),
                              .curvature = (float)curvature};
}

static void test_piece_clearance_is_a_lower_bound_within_its_stated_error_for_every_seed(void) {
    hall_rectangle(0.9, 0.5, 0.05F);
    for (uint64_t seed = 0; seed < SEEDS; seed++) {
        aisle_rng rng = aisle_rng_seed(seed);
        random_hall(&rng);
        open_space(AISLE_SPACE_FREE_TURN);
        for (int k = 0; k < 60; k++) {
            aisle_waypoint_msg a, b;
            random_piece(&rng, k % 2 == 0, &a, &b);
            bool rough = k % 4 >= 2;
            double told = aisle_space_piece_clearance(&space, &a, &b, rough, &units);
            double truth = fmin(sampled_piece_gap(&a, &b), AISLE_CLEARANCE_CAP);
            TEST_ASSERT_TRUE(told <= truth + 1e-6);
            double spare = k % 2 == 0 ? 2e-3 : 6e-3;
            double creep = hall_vehicle.creep_clearance;
            spare = rough && truth < creep ? 25e-3 + 1e-3 : spare; // the truth is sampled
            TEST_ASSERT_TRUE(told >= truth - spare || (told >= creep && told >= truth * 15.0 / 16.0 - spare));
            TEST_ASSERT_TRUE(told < creep || truth >= creep - 1e-6);
            TEST_ASSERT_TRUE(told >= creep || truth < creep + 6e-3);
        }
    }
}

static void test_a_piece_is_free_just_where_its_sampled_gap_is_enough_for_every_seed(void) {
    for (int disc = 0; disc < 2; disc++) {
        int free = 0, doubts = 0, asked = 0;
        if (disc != 0) {
            hall_disc(0.3, 0.05F);
        } else {
            hall_rectangle(0.9, 0.5, 0.05F);
        }
        for (uint64_t seed = 0; seed < SEEDS; seed++) {
            aisle_rng rng = aisle_rng_seed(seed);
            random_hall(&rng);
            open_space(AISLE_SPACE_FREE_TURN);
            for (int k = 0; k < 24; k++) {
                aisle_waypoint_msg a, b;
                random_piece(&rng, k % 2 == 0, &a, &b);
                double need = uniform(&rng, 0.01, 0.4), truth = sampled_piece_gap(&a, &b);
                bool told = aisle_space_piece_free(&space, &a, &b, need, &units);
                if (told) {
                    TEST_ASSERT_TRUE(truth >= need - 1e-9);
                } else {
                    TEST_ASSERT_TRUE(truth < need + (disc != 0 || k % 2 == 0 ? 2e-4 : 5e-3));
                }
                free += told;
                doubts += !told && truth >= need;
                asked++;
            }
        }
        TEST_ASSERT_TRUE(free > asked / 10 && free < asked && doubts < asked / 20);
    }
}

static void test_clearance_about_follows_the_field_within_a_cell(void) {
    aisle_rng rng = aisle_rng_seed(7);
    random_hall(&rng);
    open_space(AISLE_SPACE_FREE_TURN);
    for (int k = 0; k < 2000; k++) {
        aisle_vec2 p = uniform_point(&rng, aisle_vec2_of(0.3, 0.3), aisle_vec2_of(11.7, 8.7));
        double truth = (double)hall_disc_gap(p.x, p.y, hall_vehicle.inner_radius);
        double told = aisle_space_clearance_about(&space, p);
        if (aisle_space_is_far(&space, p)) {
            TEST_ASSERT_TRUE(truth >= space.far_clearance && told >= hall_vehicle.creep_clearance);
        } else if (truth > 0.0) {
            TEST_ASSERT_DOUBLE_WITHIN(0.06, truth, told);
        }
    }
}

static void test_what_is_told_covered_is_what_the_field_proves(void) {
    const double radius[4] = {0.002, 0.06, 0.3, 1.2}; // the first two cover no cell of 5 cm, with the margin a few
    int covered = 0, near = 0;
    for (int r = 0; r < 4; r++) {
        aisle_rng rng = aisle_rng_seed(8);
        random_hall(&rng);
        hall_disc(radius[r], r == 0 ? -1.0F : 0.02F);
        open_space(AISLE_SPACE_FREE_TURN);
        for (int i = 0; i < 4000; i++) {
            const aisle_vec2 p = uniform_point(&rng, aisle_vec2_of(-0.1, -0.1), aisle_vec2_of(12.1, 9.1));
            const bool is_out = p.x < 0.0 || p.y < 0.0 || p.x > 12.0 || p.y > 9.0;
            const double gap = (double)hall_disc_gap(p.x, p.y, 0.0) - space.reach;
            const bool is_covered = aisle_space_is_covered(&space, p);
            near += !is_out && gap < -0.25 ? 1 : 0;
            covered += is_covered ? 1 : 0;
            TEST_ASSERT_FALSE(is_covered && (is_out || gap >= 0.0));
            TEST_ASSERT_EQUAL(!is_out && aisle_grid_gap_upper(space.grid, p) < space.reach, is_covered);
        }
    }
    TEST_ASSERT_TRUE(covered >= near && near > 0);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_a_cell_is_free_just_where_the_disc_has_its_margin_and_the_steps_slack);
    RUN_TEST(test_a_disc_sweep_is_free_just_where_dense_samples_keep_the_margin);
    RUN_TEST(test_a_body_sweep_is_free_just_where_dense_samples_keep_the_margin);
    RUN_TEST(test_free_turn_stands_for_every_heading);
    RUN_TEST(test_turn_free_is_told_just_where_the_turning_disc_keeps_the_margin);
    RUN_TEST(test_a_wall_thinner_than_a_cell_stops_a_point_sized_robot);
    RUN_TEST(test_every_test_adds_its_units);
    RUN_TEST(test_piece_clearance_is_a_lower_bound_within_its_stated_error_for_every_seed);
    RUN_TEST(test_a_piece_is_free_just_where_its_sampled_gap_is_enough_for_every_seed);
    RUN_TEST(test_clearance_about_follows_the_field_within_a_cell);
    RUN_TEST(test_what_is_told_covered_is_what_the_field_proves);
    return UNITY_END();
}
