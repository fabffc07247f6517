#include "base/vec.h" // first: proves that the header stands alone

#include "unity.h"

void setUp(void) {}
void tearDown(void) {}

static void expect(double x, double y, aisle_vec2 got) {
    TEST_ASSERT_DOUBLE_WITHIN(0.0, x, got.x);
    TEST_ASSERT_DOUBLE_WITHIN(0.0, y, got.y);
}

static void test_sums_and_multiples_are_by_component(void) {
    const aisle_vec2 a = aisle_vec2_of(1.0, -2.0);
    const aisle_vec2 b = {0.5, 8.0};
    expect(1.5, 6.0, aisle_vec2_add(a, b));
    expect(0.5, -10.0, aisle_vec2_sub(a, b));
    expect(-3.0, 6.0, aisle_vec2_scale(a, -3.0));
    expect(0.75, 3.0, aisle_vec2_lerp(a, b, 0.5));
    expect(1.0, -2.0, aisle_vec2_lerp(a, b, 0.0));
}

static void test_cross_is_positive_counter_clockwise(void) {
    const aisle_vec2 east = {1.0, 0.0};
    const aisle_vec2 north = {0.0, 1.0};
    TEST_ASSERT_DOUBLE_WITHIN(0.0, 1.0, aisle_vec2_cross(east, north));
    TEST_ASSERT_DOUBLE_WITHIN(0.0, -1.0, aisle_vec2_cross(north, east));
    TEST_ASSERT_DOUBLE_WITHIN(0.0, 0.0, aisle_vec2_dot(east, north));
    TEST_ASSERT_DOUBLE_WITHIN(0.0, 11.0, aisle_vec2_dot(aisle_vec2_of(1.0, 2.0), aisle_vec2_of(3.0, 4.0)));
}

static void test_length_and_distance_of_whole_triangles_are_exact(void) {
    TEST_ASSERT_DOUBLE_WITHIN(0.0, 5.0, aisle_vec2_length(aisle_vec2_of(-3.0, 4.0)));
    TEST_ASSERT_DOUBLE_WITHIN(0.0, 13.0, aisle_vec2_distance(aisle_vec2_of(1.0, 1.0), aisle_vec2_of(6.0, 13.0)));
}

static void test_clamp_keeps_to_its_ends(void) {
    TEST_ASSERT_DOUBLE_WITHIN(0.0, 1.0, aisle_clamp(0.0, 1.0, 2.0));
    TEST_ASSERT_DOUBLE_WITHIN(0.0, 2.0, aisle_clamp(3.0, 1.0, 2.0));
    TEST_ASSERT_DOUBLE_WITHIN(0.0, 1.5, aisle_clamp(1.5, 1.0, 2.0));
    TEST_ASSERT_DOUBLE_WITHIN(0.0, 1.0, aisle_min(1.0, 2.0));
    TEST_ASSERT_DOUBLE_WITHIN(0.0, 2.0, aisle_max(1.0, 2.0));
}

static void test_boxes_that_touch_overlap(void) {
    const aisle_aabb unit = {{0.0, 0.0}, {1.0, 1.0}};
    const aisle_aabb beside = {{1.0, 0.0}, {2.0, 1.0}};
    const aisle_aabb corner = {{1.0, 1.0}, {2.0, 2.0}};
    const aisle_aabb above = {{0.0, 1.001}, {1.0, 2.0}};
    const aisle_aabb inside = {{0.4, 0.4}, {0.6, 0.6}};
    TEST_ASSERT_TRUE(aisle_aabb_overlap(unit, beside) && aisle_aabb_overlap(beside, unit));
    TEST_ASSERT_TRUE(aisle_aabb_overlap(unit, corner) && aisle_aabb_overlap(unit, inside));
    TEST_ASSERT_FALSE(aisle_aabb_overlap(unit, above) || aisle_aabb_overlap(above, unit));
    TEST_ASSERT_TRUE(aisle_aabb_overlap(aisle_aabb_grow(unit, 0.001), above));
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_sums_and_multiples_are_by_component);
    RUN_TEST(test_cross_is_positive_counter_clockwise);
    RUN_TEST(test_length_and_distance_of_whole_triangles_are_exact);
    RUN_TEST(test_clamp_keeps_to_its_ends);
    RUN_TEST(test_boxes_that_touch_overlap);
    return UNITY_END();
}
