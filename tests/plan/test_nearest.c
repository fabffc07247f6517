#include "plan/nearest.h"

#include "cases.h"
#include "hall.h"

// The judge walks a fine polar grid about the stop with hall.h's own gaps.

static aisle_space space;
static aisle_nearest nearest;
static uint32_t spent;

static void open_hall(float resolution) {
    aisle_arena arena = hall_arena(24U << 20);
    memset(&space, 0, sizeof space);
    aisle_space_carve(&space, &arena, hall_limits.cells);
    hall_open(&arena, resolution);
}

static aisle_status run(aisle_pose2 stop, bool any_heading, uint32_t slice) {
    aisle_status st;
    spent = 0;
    aisle_space_begin(&space, &hall_layout, &hall_vehicle, AISLE_SPACE_FREE_TURN);
    aisle_nearest_start(&nearest, &space, stop, any_heading);
    do {
        uint32_t before = spent;
        st = aisle_nearest_step(&nearest, slice, &spent);
        TEST_ASSERT_TRUE(slice > 1000000U || spent - before <= slice + 3U);
    } while (st == AISLE_BUSY);
    return st;
}

static double gap_at(aisle_pose2 pose, bool any_heading) {
    return any_heading ? (double)hall_disc_gap(pose.x, pose.y, hall_vehicle.inner_radius) : hall_body_gap(pose);
}

// Least distance at which some direction out of 240 has room for margin, slack and spare; 2 mm steps.
static double brute(aisle_pose2 stop, bool any_heading, double need, double until) {
    for (double d = 0.0; d <= until; d += 2e-3) {
        for (int k = 0; k < 240; k++) {
            double angle = k * 3.14159265358979 / 120.0;
            aisle_pose2 pose = {stop.x + d * cos(angle), stop.y + d * sin(angle), stop.theta};
            if (gap_at(pose, any_heading) >= need) {
                return d;
            }
        }
    }
    return INFINITY;
}

static double keep(void) {
    return hall_vehicle.margin + AISLE_SPACE_SLACK;
}

static void check_place(aisle_pose2 stop, bool any_heading) {
    double need = keep() + AISLE_NEAREST_SPARE;
    aisle_pose2 there = {nearest.place.x, nearest.place.y, stop.theta};
    TEST_ASSERT_TRUE(gap_at(there, any_heading) >= need - 1e-9);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, hypot(there.x - stop.x, there.y - stop.y), nearest.distance);
    // Rounded to the millimetre it still stands free.
    aisle_pose2 rounded = {floor(there.x * 1e3 + 0.5) / 1e3, floor(there.y * 1e3 + 0.5) / 1e3, stop.theta};
    TEST_ASSERT_TRUE(gap_at(rounded, any_heading) >= keep());
}

void setUp(void) {
    hall_disc(0.35, 0.1F);
}
void tearDown(void) {}

static void test_beside_a_wall_the_way_is_straight_off_it(void) {
    hall_begin(8.0, 5.0);
    hall_add(3.0, 1.0, 5.0, 4.0);
    open_hall(0.05F);
    const double need = 0.35 + keep() + AISLE_NEAREST_SPARE;
    static const double inside[] = {-0.3, -0.1, 0.0, 0.05, 0.3, 0.8}; // m from the wall; below 0 outside
    for (int i = 0; i < 6; i++) {
        aisle_pose2 stop = {3.0 + inside[i], 2.5, 0.0};
        TEST_ASSERT_EQUAL(AISLE_OK, run(stop, true, 100));
        TEST_ASSERT_DOUBLE_WITHIN(5e-4, need + inside[i], nearest.distance);
        TEST_ASSERT_TRUE(nearest.distance >= need + inside[i] - 1e-9);
        check_place(stop, true);
    }
}

static void test_in_random_halls_no_nearer_place_is_found_by_brute_force(void) {
    uint32_t units = 0;
    int found = 0;
    for (uint64_t s = 0; s < CASES(40); s++) {
        aisle_rng rng = aisle_rng_seed(s);
        hall_begin(5.0, 4.0);
        for (int i = 0; i < 7; i++) { // they overlap
            aisle_vec2 at = uniform_point(&rng, aisle_vec2_of(0.0, 0.0), aisle_vec2_of(4.0, 3.0));
            aisle_vec2 size = uniform_point(&rng, aisle_vec2_of(0.05, 0.05), aisle_vec2_of(1.0, 1.0));
            hall_add(at.x, at.y, at.x + size.x, at.y + size.y);
        }
        open_hall(s % 2U == 0U ? 0.05F : 0.1F);
        bool any_heading = s % 4U < 2U;
        hall_disc(0.2, 0.05F);
        if (!any_heading) {
            hall_rectangle(0.6, 0.3, 0.05F);
        }
        aisle_vec2 p = uniform_point(&rng, aisle_vec2_of(0.0, 0.0), aisle_vec2_of(5.0, 4.0));
        aisle_pose2 stop = {p.x, p.y, uniform(&rng, -3.0, 3.0)};
        double need = keep() + AISLE_NEAREST_SPARE;
        double truth = brute(stop, any_heading, need, 1.0);
        aisle_status st = run(stop, any_heading, 100);
        TEST_ASSERT_TRUE(st == AISLE_OK || truth > 4.0);
        if (st == AISLE_OK) {
            check_place(stop, any_heading);
            TEST_ASSERT_TRUE(nearest.distance <= truth + 6e-4);
            found += truth < 1.0;
        }
        units = spent > units ? spent : units;
    }
    TEST_ASSERT_TRUE(found >= LEAST(25));
    TEST_ASSERT_LESS_THAN_UINT32(20000, units);
}

static void test_on_corners_and_in_corners_of_the_hall_it_is_exact(void) {
    const double r = 0.35 + keep() + AISLE_NEAREST_SPARE;
    hall_begin(8.0, 5.0);
    hall_add(4.0, 2.0, 5.0, 3.0);
    open_hall(0.05F);
    TEST_ASSERT_EQUAL(AISLE_OK, run((aisle_pose2){0.0, 0.0, 0.0}, true, 100)); // on the boundary's corner
    TEST_ASSERT_DOUBLE_WITHIN(6e-4, r * sqrt(2.0), nearest.distance);
    check_place((aisle_pose2){0.0, 0.0, 0.0}, true);
    TEST_ASSERT_EQUAL(AISLE_OK, run((aisle_pose2){0.21, 0.033, 0.0}, true, 100)); // the same place, off its diagonal
    TEST_ASSERT_DOUBLE_WITHIN(6e-4, hypot(r - 0.21, r - 0.033), nearest.distance);
    TEST_ASSERT_EQUAL(AISLE_OK, run((aisle_pose2){8.0, 5.0, 0.0}, true, 100));
    TEST_ASSERT_DOUBLE_WITHIN(6e-4, r * sqrt(2.0), nearest.distance);
    TEST_ASSERT_EQUAL(AISLE_OK, run((aisle_pose2){4.0, 2.0, 0.0}, true, 100)); // every place of an arc is as near
    TEST_ASSERT_DOUBLE_WITHIN(6e-4, r, nearest.distance);
}

static void test_a_body_that_does_not_hold_its_origin_moves_too(void) {
    aisle_vehicle_msg msg = {.vehicle_revision = 1, .num_vertices = 4, .margin = 0.05F};
    const double v[4][2] = {{1.0, -0.2}, {1.6, -0.2}, {1.6, 0.2}, {1.0, 0.2}};
    memcpy(msg.footprint, v, sizeof v);
    aisle_refusal why;
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_vehicle_from_msg(&msg, &hall_vehicle, &why));
    hall_begin(8.0, 5.0);
    hall_add(4.0, 1.0, 4.4, 4.0);
    open_hall(0.05F);
    aisle_pose2 stop = {2.9, 2.5, 0.0}; // the body lies in the box, the origin does not
    TEST_ASSERT_EQUAL(AISLE_OK, run(stop, false, 100));
    TEST_ASSERT_DOUBLE_WITHIN(6e-4, 0.5 + keep() + AISLE_NEAREST_SPARE, nearest.distance);
    check_place(stop, false);
    stop.x = 4.2; // and now the other way round: the body is free
    TEST_ASSERT_EQUAL(AISLE_OK, run(stop, false, 100));
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 0.0, nearest.distance);
}

static void test_where_nothing_is_free_within_5_m_none_is_told(void) {
    hall_begin(24.0, 24.0);
    hall_add(0.0, 0.0, 24.0, 16.0);
    open_hall(0.05F);
    TEST_ASSERT_EQUAL(AISLE_PARTIAL, run((aisle_pose2){12.0, 11.0, 0.0}, true, 100));
    TEST_ASSERT_EQUAL(AISLE_OK, run((aisle_pose2){12.0, 12.0, 0.0}, true, 100));
    TEST_ASSERT_DOUBLE_WITHIN(6e-4, 4.0 + 0.35 + keep() + AISLE_NEAREST_SPARE, nearest.distance);
    hall_disc(12.0, 0.1F);
    TEST_ASSERT_EQUAL(AISLE_PARTIAL, run((aisle_pose2){12.0, 20.0, 0.0}, true, 100));
}

static void test_any_slicing_tells_the_same_for_the_same_units(void) {
    static const uint32_t slices[] = {1, 7, 1000};
    hall_begin(8.0, 5.0);
    hall_add(3.0, 1.0, 5.0, 4.0);
    open_hall(0.05F);
    TEST_ASSERT_EQUAL(AISLE_OK, run((aisle_pose2){3.7, 2.2, 0.0}, true, UINT32_MAX));
    aisle_nearest whole = nearest;
    uint32_t units = spent;
    for (int i = 0; i < 3; i++) {
        TEST_ASSERT_EQUAL(AISLE_OK, run((aisle_pose2){3.7, 2.2, 0.0}, true, slices[i]));
        TEST_ASSERT_EQUAL_UINT32(units, spent);
        TEST_ASSERT_EQUAL_MEMORY(&whole, &nearest, sizeof nearest);
    }
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_beside_a_wall_the_way_is_straight_off_it);
    RUN_TEST(test_in_random_halls_no_nearer_place_is_found_by_brute_force);
    RUN_TEST(test_on_corners_and_in_corners_of_the_hall_it_is_exact);
    RUN_TEST(test_a_body_that_does_not_hold_its_origin_moves_too);
    RUN_TEST(test_where_nothing_is_free_within_5_m_none_is_told);
    RUN_TEST(test_any_slicing_tells_the_same_for_the_same_units);
    return UNITY_END();
}
