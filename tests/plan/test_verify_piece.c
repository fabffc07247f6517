#include "plan/verify_parts.h"
#include "test_verify_fixture.h"

// Checks the last piece drawn against the judge's geometry at 33 points.
static void assert_follows_the_judge(double within) {
    aisle_verify_piece piece;
    const stretch s = stretch_at(1);
    TEST_ASSERT_TRUE(aisle_verify_piece_between(&path.waypoints[0], &path.waypoints[1], &piece));
    for (int i = 0; i <= 32; i++) {
        long double pose[3];
        stretch_pose(&s, (long double)i / 32.0L, pose);
        aisle_vec2 p = aisle_verify_piece_origin(&piece, i / 32.0);
        TEST_ASSERT_DOUBLE_WITHIN(within, (double)pose[0], p.x);
        TEST_ASSERT_DOUBLE_WITHIN(within, (double)pose[1], p.y);
    }
    TEST_ASSERT_DOUBLE_WITHIN(within * 2.0, (double)s.length, piece.length);
}

static void test_origin_and_length_match_the_arc_by_its_centre(void) {
    dice = aisle_rng_seed(1);
    for (int i = 0; i < 5000; i++) {
        path_begin(uniform(-100.0, 100.0), uniform(-100.0, 100.0), uniform(-3.1, 3.1));
        double k = pow(10.0, uniform(-3.0, 1.0));
        path_arc(below(2) == 0 ? k : -k, pow(10.0, uniform(-4.0, 0.45)));
        assert_follows_the_judge(1e-10);
    }
}

static void test_hardly_bent_arcs_lose_nothing(void) { // 1 km of radius and more: sagitta c^2 k / 8
    for (double k = 1e-3; k > 1e-12; k *= 0.1) {
        aisle_verify_piece piece;
        path_begin(0.0, 0.0, 0.0);
        path_line(10.0);
        path.waypoints[1].curvature = (float)k;
        TEST_ASSERT_TRUE(aisle_verify_piece_between(&path.waypoints[0], &path.waypoints[1], &piece));
        aisle_vec2 p = aisle_verify_piece_origin(&piece, 0.5);
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, 5.0, p.x);
        TEST_ASSERT_DOUBLE_WITHIN(1e-5 * k * 12.5, -12.5 * (double)(float)k, p.y);
    }
}

static void test_directions_are_the_tangents(void) {
    aisle_verify_piece piece;
    path_begin(1.0, 2.0, 0.4);
    path_arc(-0.8, 1.1);
    TEST_ASSERT_TRUE(aisle_verify_piece_between(&path.waypoints[0], &path.waypoints[1], &piece));
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0.4, aisle_verify_piece_direction(&piece, false));
    TEST_ASSERT_DOUBLE_WITHIN(1e-7, 0.4 - 1.1, aisle_verify_piece_direction(&piece, true));
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, -1.1, piece.turn);
}

static void test_a_chord_a_hair_longer_than_the_diameter_is_half_a_circle(void) {
    aisle_verify_piece piece;
    path_begin(0.0, 0.0, 0.0);
    path_line(2.0 * (1.0 + 5e-7));
    path.waypoints[1].curvature = 1.0F;
    TEST_ASSERT_TRUE(aisle_verify_piece_between(&path.waypoints[0], &path.waypoints[1], &piece));
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 0.5 * AISLE_PI, piece.phi);
    TEST_ASSERT_DOUBLE_WITHIN(1e-5, AISLE_PI, piece.length);
    aisle_vec2 p = aisle_verify_piece_origin(&piece, 0.5);
    TEST_ASSERT_DOUBLE_WITHIN(1e-5, -1.0, p.y);
    path.waypoints[1].x = 2.0 * (1.0 + 2e-6);
    TEST_ASSERT_FALSE(aisle_verify_piece_between(&path.waypoints[0], &path.waypoints[1], &piece));
}

static void test_turns_go_the_short_way_and_ties_both_ways(void) {
    TEST_ASSERT_DOUBLE_WITHIN(1e-15, 0.5, aisle_verify_turn(-0.25, 0.25));
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0.2, aisle_verify_turn(AISLE_PI - 0.1, -AISLE_PI + 0.1));
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, -0.2, aisle_verify_turn(-AISLE_PI + 0.1, AISLE_PI - 0.1));
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, AISLE_PI, aisle_verify_turn(0.0, AISLE_PI));
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, AISLE_PI, aisle_verify_turn(AISLE_PI, 0.0));
    const double turns[3] = {AISLE_PI, AISLE_PI - 5e-7, AISLE_PI - 2e-6};
    for (int i = 0; i < 3; i++) {
        aisle_verify_piece piece;
        path_begin(0.0, 0.0, -1.0);
        path_turn(turns[i]);
        TEST_ASSERT_TRUE(aisle_verify_piece_between(&path.waypoints[0], &path.waypoints[1], &piece));
        double between = i < 2 ? 2.0 * AISLE_PI : 0.0;
        TEST_ASSERT_DOUBLE_WITHIN(1e-12, between, fabs(piece.turn - piece.turn_other));
    }
}

static void test_what_is_no_piece_is_refused(void) {
    aisle_verify_piece piece;
    path_begin(0.0, 0.0, 0.0);
    path_line(5e-10);
    TEST_ASSERT_FALSE(aisle_verify_piece_between(&path.waypoints[0], &path.waypoints[1], &piece));
    path.waypoints[0].flags = AISLE_WAYPOINT_TURN_IN_PLACE;
    TEST_ASSERT_TRUE(aisle_verify_piece_between(&path.waypoints[0], &path.waypoints[1], &piece));
    TEST_ASSERT_TRUE(piece.on_spot);
    path.waypoints[1].curvature = 0.1F;
    TEST_ASSERT_FALSE(aisle_verify_piece_between(&path.waypoints[0], &path.waypoints[1], &piece));
    path.waypoints[1].curvature = 0.0F;
    path.waypoints[1].x = 2e-9;
    TEST_ASSERT_FALSE(aisle_verify_piece_between(&path.waypoints[0], &path.waypoints[1], &piece));
}

void setUp(void) {}
void tearDown(void) {}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_origin_and_length_match_the_arc_by_its_centre);
    RUN_TEST(test_hardly_bent_arcs_lose_nothing);
    RUN_TEST(test_directions_are_the_tangents);
    RUN_TEST(test_a_chord_a_hair_longer_than_the_diameter_is_half_a_circle);
    RUN_TEST(test_turns_go_the_short_way_and_ties_both_ways);
    RUN_TEST(test_what_is_no_piece_is_refused);
    return UNITY_END();
}
