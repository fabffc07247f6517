#include "plan/why.h"

#include "hall.h"

static aisle_space space;
static aisle_seed seed;
static aisle_why why;
static uint32_t spent;

static void open_hall(float resolution) {
    aisle_arena arena = hall_arena(24U << 20);
    memset(&space, 0, sizeof space);
    memset(&seed, 0, sizeof seed);
    aisle_space_carve(&space, &arena, hall_limits.cells);
    aisle_seed_carve(&seed, &arena, &hall_limits);
    hall_open(&arena, resolution);
}

void setUp(void) {
    hall_disc(0.35, 0.1F);
}
void tearDown(void) {}

static aisle_status run(aisle_vec2 start, aisle_vec2 goal, uint32_t stride, uint32_t slice) {
    int proofs = 0;
    aisle_status st;
    spent = 0;
    aisle_space_begin(&space, &hall_layout, &hall_vehicle, AISLE_SPACE_FREE_TURN);
    aisle_why_start(&why, &seed, &space, start, goal, stride);
    do {
        st = aisle_why_step(&why, slice, &spent);
        proofs += st == AISLE_PARTIAL;
    } while (st == AISLE_BUSY || st == AISLE_PARTIAL);
    TEST_ASSERT_EQUAL_INT(st == AISLE_OK ? 1 : proofs, proofs);
    return st;
}

// A wall across the hall, its door `width` wide from y = low: boxes 1 and 2.
static void wall_with_door(double x, double thickness, double low, double width) {
    hall_begin(8.0, 5.0);
    hall_add(x, 0.0, x + thickness, low);
    hall_add(x, low + width, x + thickness, 5.0);
}

static void sides_are(int32_t one, int32_t other) {
    TEST_ASSERT_EQUAL_UINT32(2, why.gap.sides);
    TEST_ASSERT_TRUE((why.gap.id[0] == one && why.gap.id[1] == other) ||
                     (why.gap.id[0] == other && why.gap.id[1] == one));
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, why.gap.width, aisle_vec2_distance(why.gap.side[0], why.gap.side[1]));
}

static const aisle_vec2 left = {1.5, 2.5};
static const aisle_vec2 right = {6.5, 2.5};

static void test_the_width_of_a_door_is_told_to_the_millimetre_with_both_its_walls(void) {
    static const double widths[] = {0.05, 0.12, 0.2, 0.33, 0.5, 0.61, 0.777, 0.8};
    static const double thick[] = {0.001, 0.3, 1.7};
    static const float resolutions[] = {0.05F, 0.1F};
    for (size_t i = 0; i < 8U * 3U * 2U * 2U; i++) {
        double width = widths[i % 8U];
        double thickness = thick[i / 8U % 3U];
        double low = 2.213 + 0.011 * (double)(i % 7U);
        float resolution = resolutions[i / 24U % 2U];
        if (width < 2.1 * (double)resolution) {
            continue; // below the grid's sight
        }
        wall_with_door(3.0 + 0.017 * (double)(i % 5U), thickness, low, width);
        open_hall(resolution);
        TEST_ASSERT_EQUAL(AISLE_OK, run(left, right, i < 48U ? 1U : 2U, 1000));
        TEST_ASSERT_TRUE(why.proved && why.connected);
        TEST_ASSERT_DOUBLE_WITHIN(1e-6, width, why.gap.width);
        sides_are(1, 2);
        TEST_ASSERT_TRUE(why.gap.place.y > low && why.gap.place.y < low + width);
        TEST_ASSERT_TRUE(why.gap.place.x > hall_boxes[0].x0 - 0.3 && why.gap.place.x < hall_boxes[0].x1 + 0.3);
    }
}

static void test_a_door_between_the_strides_is_told_all_the_same(void) {
    for (int k = 0; k < 8; k++) {
        wall_with_door(3.0, 1.0, 2.213 + 0.025 * k, 0.16);
        open_hall(0.05F);
        TEST_ASSERT_EQUAL(AISLE_OK, run(left, right, 8, 1000));
        TEST_ASSERT_TRUE(why.proved && why.connected);
        TEST_ASSERT_DOUBLE_WITHIN(1e-6, 0.16, why.gap.width);
    }
}

static void test_of_two_doors_the_wider_one_is_told(void) {
    hall_begin(8.0, 5.0);
    hall_add(3.0, 0.0, 3.2, 1.0);
    hall_add(3.0, 1.5, 3.2, 3.5); // doors of 0.5 and 0.62 m
    hall_add(3.0, 4.12, 3.2, 5.0);
    open_hall(0.05F);
    TEST_ASSERT_EQUAL(AISLE_OK, run(left, right, 1, 1000));
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, 0.62, why.gap.width);
    TEST_ASSERT_TRUE(why.gap.place.y > 3.5);
}

// Doors in a first and a second wall; the widest way leads through the wider one of each.
static void test_of_doors_that_differ_by_a_millimetre_the_right_one_is_told(void) {
    for (uint64_t s = 0; s < 40; s++) {
        aisle_rng rng = aisle_rng_seed(s);
        double widest[2];
        hall_begin(8.0, 6.0);
        for (int wall = 0; wall < 2; wall++) {
            double x = 3.0 + 1.5 * wall + uniform(&rng, -0.1, 0.1);
            double about = uniform(&rng, 0.25, 0.8);
            double y = 0.0;
            widest[wall] = 0.0;
            for (int k = 0; k < 3; k++) { // wider by 1 mm each, the order drawn
                double width = about + 0.001 * (double)((k + (int)s) % 3);
                double low = y + uniform(&rng, 0.6, 1.0);
                hall_add(x, y, x + uniform(&rng, 0.05, 0.5), low);
                y = low + width;
                widest[wall] = fmax(widest[wall], width);
            }
            hall_add(x, y, x + 0.3, 6.0);
        }
        open_hall(s % 2U == 0U ? 0.05F : 0.1F);
        TEST_ASSERT_EQUAL(AISLE_OK, run(left, right, s % 4U < 2U ? 1U : 2U, 1000));
        TEST_ASSERT_TRUE(why.proved && why.connected);
        TEST_ASSERT_DOUBLE_WITHIN(1e-6, fmin(widest[0], widest[1]), why.gap.width);
    }
}

static void test_a_gap_between_two_corners_is_told_across(void) {
    hall_begin(8.0, 5.0);
    hall_add(2.0, 0.0, 3.0, 2.4); // upper right corner (3.0, 2.4), lower left one of the other (3.4, 2.7)
    hall_add(3.4, 2.7, 4.4, 5.0);
    open_hall(0.05F);
    TEST_ASSERT_EQUAL(AISLE_OK, run(aisle_vec2_of(1.0, 4.0), aisle_vec2_of(6.0, 1.0), 1, 1000));
    TEST_ASSERT_TRUE(why.proved && why.connected);
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, 0.5, why.gap.width);
    TEST_ASSERT_DOUBLE_WITHIN(0.1, 3.2, why.gap.place.x);
    TEST_ASSERT_DOUBLE_WITHIN(0.1, 2.55, why.gap.place.y);
}

static void test_a_station_close_to_a_wall_is_not_taken_for_the_narrow_place(void) {
    wall_with_door(3.0, 0.2, 2.213, 0.88);
    open_hall(0.05F);
    for (int k = 0; k < 5; k++) {
        aisle_vec2 start = {0.452 + 0.01 * k, 1.0}; // the body stands with its margin
        TEST_ASSERT_EQUAL(AISLE_OK, run(start, right, 1, 1000));
        TEST_ASSERT_TRUE(why.proved && why.connected);
        TEST_ASSERT_DOUBLE_WITHIN(1e-6, 0.88, why.gap.width);
        sides_are(1, 2);
    }
}

static void test_the_proof_stands_just_where_the_inner_disc_does_not_fit(void) {
    hall_rectangle(1.0, 0.7, 0.1F); // inner disc and margin: 0.9 m
    static const double widths[] = {0.6, 0.88, 0.901, 1.0, 1.5};
    for (size_t i = 0; i < 5; i++) {
        wall_with_door(3.0, 0.3, 2.0, widths[i]);
        open_hall(0.05F);
        TEST_ASSERT_EQUAL(AISLE_OK, run(left, right, 1, 1000));
        TEST_ASSERT_EQUAL(widths[i] < 0.9, why.proved);
        TEST_ASSERT_TRUE(why.connected);
    }
}

static void test_a_closed_room_is_not_connected_and_that_is_proved(void) {
    for (uint32_t k = 0; k < 8U; k++) { // a stride must not leap over a wall one cell thick
        double x = 3.0 + 0.02 * (double)(k / 2U);
        hall_begin(8.0, 5.0);
        hall_add(x, 0.0, x + 0.001, 5.0);
        open_hall(0.05F);
        TEST_ASSERT_EQUAL(AISLE_OK, run(left, right, 1U + k % 2U, 1000));
        TEST_ASSERT_TRUE(why.proved);
        TEST_ASSERT_FALSE(why.connected);
    }
}

static void test_any_slicing_tells_the_same_for_the_same_units(void) {
    static const uint32_t slices[] = {1, 13, 5000};
    wall_with_door(3.0, 0.2, 2.213, 0.5);
    open_hall(0.05F);
    TEST_ASSERT_EQUAL(AISLE_OK, run(left, right, 2, UINT32_MAX));
    aisle_why whole = why;
    uint32_t units = spent;
    for (int i = 0; i < 3; i++) {
        TEST_ASSERT_EQUAL(AISLE_OK, run(left, right, 2, slices[i]));
        TEST_ASSERT_EQUAL_UINT32(units, spent);
        TEST_ASSERT_EQUAL_MEMORY(&whole, &why, sizeof why);
    }
}

static void test_a_full_open_list_is_told(void) {
    aisle_arena arena = hall_arena(24U << 20);
    aisle_limits limits = hall_limits;
    limits.open_nodes = 16;
    aisle_space_carve(&space, &arena, limits.cells);
    aisle_seed_carve(&seed, &arena, &limits);
    wall_with_door(3.0, 0.2, 2.213, 0.5);
    hall_open(&arena, 0.05F);
    TEST_ASSERT_EQUAL(AISLE_ERR_CAPACITY, run(left, right, 1, 1000));
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_the_width_of_a_door_is_told_to_the_millimetre_with_both_its_walls);
    RUN_TEST(test_a_door_between_the_strides_is_told_all_the_same);
    RUN_TEST(test_of_two_doors_the_wider_one_is_told);
    RUN_TEST(test_of_doors_that_differ_by_a_millimetre_the_right_one_is_told);
    RUN_TEST(test_a_gap_between_two_corners_is_told_across);
    RUN_TEST(test_a_station_close_to_a_wall_is_not_taken_for_the_narrow_place);
    RUN_TEST(test_the_proof_stands_just_where_the_inner_disc_does_not_fit);
    RUN_TEST(test_a_closed_room_is_not_connected_and_that_is_proved);
    RUN_TEST(test_any_slicing_tells_the_same_for_the_same_units);
    RUN_TEST(test_a_full_open_list_is_told);
    return UNITY_END();
}
