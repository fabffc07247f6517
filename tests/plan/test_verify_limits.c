#include "test_verify_fixture.h"

// Waypoints of the usual path: 0 rest, 1..6 lines, 7..10 arcs of curvature 0.5, 11..16 lines, 16 turns on the spot, 17
// turned, 18..23 lines, 23 the goal.
enum { ARC = 7, STRAIGHT = 13, TURN = 16, TURNED = 17, LAST = 23 };

static void usual_vehicle(void) {
    vehicle_box(0.5, 0.5, 0.7, 0.0);
    vehicle.v_max = 1.5;
    vehicle.alpha_max = 1.0;
}

static void usual_path(void) {
    path_begin(-5.0, -5.0, 0.3);
    for (int i = 0; i < 6; i++) {
        path_line(0.5);
    }
    for (int i = 0; i < 4; i++) {
        path_arc(0.5, 0.3);
    }
    for (int i = 0; i < 6; i++) {
        path_line(0.5);
    }
    path_turn(-2.0);
    for (int i = 0; i < 6; i++) {
        path_line(0.5);
    }
    path_end();
    path.waypoints[0].v = path.waypoints[TURN].v = path.waypoints[TURNED].v = 0.0F;
}

// v up to 0.8 m/s, at rest around the turn.
static void drive(double v) {
    path_drive(v);
    for (int i = 0; i <= LAST; i++) {
        int away = i < TURN ? TURN - i : i - TURNED; // pieces of 0.5 m to the turn
        double most = sqrt(2.0 * 0.5 * 0.5 * (i == TURN ? 0 : away));
        path.waypoints[i].v = (float)fmin((double)path.waypoints[i].v, most);
    }
    path_retime(v);
    path_seal();
}

static void assert_fault_at(aisle_verify_fault fault, uint32_t waypoint) {
    TEST_ASSERT_EQUAL(fault, verified());
    TEST_ASSERT_EQUAL_UINT32(waypoint, verify.fault_waypoint);
}

static void assert_fault(aisle_verify_fault fault) {
    TEST_ASSERT_EQUAL(fault, verified());
}

void setUp(void) {
    world_begin(-50.0, -50.0, 50.0, 50.0, 1.0F);
    world_build();
    usual_vehicle();
    usual_path();
    drive(0.8);
    TEST_ASSERT_EQUAL(AISLE_VERIFY_NONE, verified());
    TEST_ASSERT_EQUAL_INT16(LAST + 1, path.num_waypoints);
}
void tearDown(void) {}

// A limit may be overstepped by a thousandth, not by a hundredth.
static void assert_limit(double *limit, double used, aisle_verify_fault fault) {
    double was = *limit;
    *limit = used / 1.0005;
    assert_fault(AISLE_VERIFY_NONE);
    *limit = used / 1.01;
    assert_fault(fault);
    *limit = was;
}

static void test_speed_limit_holds(void) {
    assert_limit(&vehicle.v_max, 0.8, AISLE_VERIFY_SPEED);
}
static void test_lateral_limit_holds(void) {
    assert_limit(&vehicle.lateral_a_max, 0.32, AISLE_VERIFY_LATERAL);
    vehicle.lateral_a_max = 0.1;
    assert_fault_at(AISLE_VERIFY_LATERAL, ARC);
}
static void test_turn_rate_limit_holds_on_arcs(void) {
    vehicle.omega_max = 0.4 / 1.0005;
    path_retime(0.8); // for the turn on the spot
    path_seal();
    assert_fault(AISLE_VERIFY_NONE);
    vehicle.omega_max = 0.4 / 1.01;
    path_retime(0.8);
    path_seal();
    assert_fault_at(AISLE_VERIFY_TURN_RATE, ARC);
}
static void test_acceleration_limit_holds(void) {
    assert_limit(&vehicle.a_max, 0.5, AISLE_VERIFY_ACCELERATION);
}
static void test_braking_limit_holds(void) {
    assert_limit(&vehicle.d_max, 0.5, AISLE_VERIFY_ACCELERATION);
    vehicle.d_max = 0.4;
    TEST_ASSERT_EQUAL(AISLE_VERIFY_ACCELERATION, verified());
    TEST_ASSERT_GREATER_THAN_UINT32(ARC, verify.fault_waypoint);
}
static void test_turns_on_the_spot_keep_rate_and_angular_acceleration(void) {
    vehicle.omega_max = 0.99; // 2 rad were timed with 1 rad/s and 1 rad/s2: 3 s
    assert_fault_at(AISLE_VERIFY_TURN_RATE, TURNED);
    vehicle.omega_max = 1.0;
    vehicle.alpha_max = 0.98;
    assert_fault_at(AISLE_VERIFY_TURN_RATE, TURNED);
    vehicle.alpha_max = 0.9995;
    assert_fault(AISLE_VERIFY_NONE);
}

static void test_reverse_has_its_own_limit_and_heading(void) {
    path_begin(0.0, 0.0, 0.0);
    pen_flags = AISLE_WAYPOINT_REVERSE;
    path_line(0.5);
    path_arc(0.5, 0.4);
    path_end();
    path_drive(0.25);
    assert_fault(AISLE_VERIFY_NONE);
    assert_limit(&vehicle.v_reverse_max, 0.25, AISLE_VERIFY_SPEED);
    path.waypoints[1].flags = 0;
    path_seal();
    assert_fault_at(AISLE_VERIFY_HEADING, 1);
}

static void test_negative_speed_is_none(void) {
    path.waypoints[3].v = -0.1F;
    path_seal();
    assert_fault_at(AISLE_VERIFY_SPEED, 3);
}

static void test_acceleration_must_be_that_of_the_piece(void) {
    path.waypoints[2].a *= 1.01F;
    path_seal();
    assert_fault_at(AISLE_VERIFY_ACCELERATION, 2);
}

static void test_a_limited_curvature_holds_and_rules_turns_out(void) {
    vehicle.curvature_max = 0.5 / 1.0005;
    assert_fault_at(AISLE_VERIFY_CURVATURE, TURNED);
    vehicle.curvature_max = 0.5 / 1.01;
    assert_fault_at(AISLE_VERIFY_CURVATURE, ARC);
}

static void test_a_wait_is_no_turn(void) {
    path_begin(0.0, 0.0, 0.0);
    path_turn(0.0);
    path_line(1.0);
    path_end();
    vehicle.curvature_max = 0.5;
    assert_fault(AISLE_VERIFY_NONE);
    path.waypoints[1].t = 0.0F; // but takes time
    path_seal();
    assert_fault_at(AISLE_VERIFY_TIME, 1);
}

static void test_heading_follows_the_motion(void) {
    path.waypoints[STRAIGHT].theta += 1.9e-3;
    path_seal();
    assert_fault(AISLE_VERIFY_NONE);
    path.waypoints[STRAIGHT].theta += 0.2e-3;
    path_seal();
    assert_fault_at(AISLE_VERIFY_HEADING, STRAIGHT);
}

static void test_the_first_heading_counts_too(void) {
    path_begin(0.0, 0.0, 0.0);
    path_line(1.0);
    path_end();
    path.waypoints[0].theta = 3e-3;
    path_seal();
    assert_fault_at(AISLE_VERIFY_HEADING, 1);
}

static void test_a_corner_driven_through_is_a_heading_fault(void) {
    path_begin(0.0, 0.0, 0.0);
    path_line(1.0);
    pen_theta += 0.005L;
    path_line(1.0);
    path_end();
    assert_fault(AISLE_VERIFY_HEADING);
}

static void test_half_a_circle_with_the_heading_round_the_other_way_is_refused(void) {
    path_begin(0.0, 0.0, 0.0);
    path_arc(-1.0, AISLE_PI - 2e-4);
    path_end();
    assert_fault(AISLE_VERIFY_NONE);
    path.waypoints[1].theta = AISLE_PI - 1e-3; // within 2e-3 of the tangent, but reached by turning left
    path_goal.theta = path.waypoints[1].theta;
    path_seal();
    assert_fault_at(AISLE_VERIFY_HEADING, 1);
}

static void test_omni_heads_anywhere_but_takes_no_corner_at_speed(void) {
    vehicle.drive = AISLE_VEHICLE_OMNI;
    path.waypoints[STRAIGHT].theta += 0.05;
    path_seal();
    assert_fault(AISLE_VERIFY_NONE);
    path_begin(0.0, 0.0, 0.0);
    path_line(1.0);
    pen_theta += 0.5L;
    path_line(1.0);
    path_end();
    assert_fault(AISLE_VERIFY_NONE); // at rest in the corner
    path_drive(0.3);
    assert_fault_at(AISLE_VERIFY_HEADING, 2);
}

// ---- rest

static void test_motion_where_it_must_rest_is_a_fault(void) {
    const uint32_t places[4] = {0, TURN, TURNED, LAST};
    for (int i = 0; i < 4; i++) {
        usual_path();
        drive(0.8);
        path.waypoints[places[i]].v = 0.01F;
        path_retime(0.8);
        path_seal();
        assert_fault_at(AISLE_VERIFY_REST, places[i]);
    }
    usual_path();
    drive(0.8);
    path.waypoints[STRAIGHT].flags |= AISLE_WAYPOINT_STOP;
    path_seal();
    assert_fault_at(AISLE_VERIFY_REST, STRAIGHT);
}

static void test_going_back_needs_rest(void) {
    path_begin(0.0, 0.0, 0.0);
    path_line(1.0);
    pen_flags = AISLE_WAYPOINT_REVERSE;
    path_line(1.0);
    path_end();
    assert_fault(AISLE_VERIFY_NONE);
    path_drive(0.2);
    assert_fault_at(AISLE_VERIFY_REST, 2);
}

// ---- time

static void test_times_rise_strictly(void) {
    path.waypoints[5].t = path.waypoints[4].t;
    path_seal();
    assert_fault_at(AISLE_VERIFY_TIME, 5);
}

static void shift_times(int from, float by) {
    for (int i = from; i <= LAST; i++) {
        path.waypoints[i].t += by;
    }
    path.duration += by;
    path_seal();
}

static void test_times_fit_length_and_speeds(void) {
    float dt = path.waypoints[STRAIGHT].t - path.waypoints[STRAIGHT - 1].t;
    shift_times(STRAIGHT, -0.01F * dt);
    assert_fault_at(AISLE_VERIFY_TIME, STRAIGHT);
    shift_times(STRAIGHT, 0.01F * dt);
    assert_fault(AISLE_VERIFY_NONE);
    shift_times(STRAIGHT, 0.01F * dt);
    assert_fault_at(AISLE_VERIFY_TIME, STRAIGHT);
}

static void test_a_piece_from_rest_to_rest_takes_the_time_accelerations_need(void) {
    path_begin(0.0, 0.0, 0.0);
    path_line(1.0);
    path_end();
    path_retime(10.0); // triangle: 2 sqrt(L (1/2a + 1/2d))
    path_seal();
    TEST_ASSERT_FLOAT_WITHIN(1e-4F, 2.8284271F, path.duration);
    assert_fault(AISLE_VERIFY_NONE);
    path.waypoints[1].t *= 0.99F;
    path.duration *= 0.99F;
    path_seal();
    assert_fault_at(AISLE_VERIFY_TIME, 1);
}

static void test_the_peak_of_a_piece_from_rest_to_rest_keeps_the_limits(void) {
    path_begin(0.0, 0.0, 0.0);
    path_arc(0.5, 1.0);
    path_end();
    path_retime(0.6);
    path_seal();
    assert_fault(AISLE_VERIFY_NONE);
    assert_limit(&vehicle.v_max, 0.6, AISLE_VERIFY_SPEED);
    assert_limit(&vehicle.lateral_a_max, 0.18, AISLE_VERIFY_LATERAL);
    assert_limit(&vehicle.omega_max, 0.3, AISLE_VERIFY_TURN_RATE);
}

static void test_the_clock_starts_at_0(void) {
    path.waypoints[0].t = 0.01F;
    path_seal();
    assert_fault_at(AISLE_VERIFY_TIME, 0);
}

// ---- sums

static void test_s_is_the_length_so_far(void) {
    path.waypoints[STRAIGHT].s += 0.002F;
    path_seal();
    assert_fault_at(AISLE_VERIFY_SUMS, STRAIGHT);
    path.waypoints[STRAIGHT].s -= 0.002F;
    path.waypoints[0].s = 0.01F;
    path_seal();
    assert_fault_at(AISLE_VERIFY_SUMS, 0);
}

static void test_clearance_min_is_not_above_any_clearance(void) {
    path.waypoints[STRAIGHT].clearance = 0.999F;
    path_seal();
    assert_fault_at(AISLE_VERIFY_SUMS, STRAIGHT);
}

// ---- numbers that make no sense

static void test_places_and_angles_out_of_range_are_refused(void) {
    path.waypoints[STRAIGHT].x = 2e5;
    path_seal();
    assert_fault_at(AISLE_VERIFY_DECODE, STRAIGHT);
    path.waypoints[STRAIGHT] = path.waypoints[STRAIGHT - 1];
    path_seal();
    assert_fault_at(AISLE_VERIFY_DECODE, STRAIGHT); // no piece
    usual_path();
    drive(0.8);
    path.waypoints[2].theta += 2.0 * AISLE_PI;
    path_seal();
    assert_fault_at(AISLE_VERIFY_DECODE, 2);
    path.waypoints[2].theta -= 2.0 * AISLE_PI;
    path.waypoints[2].clearance = -0.1F;
    path_seal();
    assert_fault_at(AISLE_VERIFY_DECODE, 2);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_speed_limit_holds);
    RUN_TEST(test_lateral_limit_holds);
    RUN_TEST(test_turn_rate_limit_holds_on_arcs);
    RUN_TEST(test_acceleration_limit_holds);
    RUN_TEST(test_braking_limit_holds);
    RUN_TEST(test_turns_on_the_spot_keep_rate_and_angular_acceleration);
    RUN_TEST(test_reverse_has_its_own_limit_and_heading);
    RUN_TEST(test_negative_speed_is_none);
    RUN_TEST(test_acceleration_must_be_that_of_the_piece);
    RUN_TEST(test_a_limited_curvature_holds_and_rules_turns_out);
    RUN_TEST(test_a_wait_is_no_turn);
    RUN_TEST(test_heading_follows_the_motion);
    RUN_TEST(test_the_first_heading_counts_too);
    RUN_TEST(test_a_corner_driven_through_is_a_heading_fault);
    RUN_TEST(test_half_a_circle_with_the_heading_round_the_other_way_is_refused);
    RUN_TEST(test_omni_heads_anywhere_but_takes_no_corner_at_speed);
    RUN_TEST(test_motion_where_it_must_rest_is_a_fault);
    RUN_TEST(test_going_back_needs_rest);
    RUN_TEST(test_times_rise_strictly);
    RUN_TEST(test_times_fit_length_and_speeds);
    RUN_TEST(test_a_piece_from_rest_to_rest_takes_the_time_accelerations_need);
    RUN_TEST(test_the_peak_of_a_piece_from_rest_to_rest_keeps_the_limits);
    RUN_TEST(test_the_clock_starts_at_0);
    RUN_TEST(test_s_is_the_length_so_far);
    RUN_TEST(test_clearance_min_is_not_above_any_clearance);
    RUN_TEST(test_places_and_angles_out_of_range_are_refused);
    return UNITY_END();
}
