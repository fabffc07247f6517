#include "cases.h"
#include "robot/motion.h"
#include "test_verify_fixture.h"

static aisle_path_msg out; // the path under way
static aisle_verify_base base;
static double v_start;
static aisle_proof_basis basis;

static void empty_world(void) {
    world_begin(-60.0, -60.0, 60.0, 60.0, 1.0F);
    world_build();
}

static void end_gently(double v) {
    path_end();
    path_drive_gently(v);
}

// The path is out; a base begins at the place and ends `reach` m later.
static void goes_out(uint32_t piece, double u, double reach) {
    TEST_ASSERT_EQUAL(AISLE_VERIFY_NONE, verified());
    out = path;
    base = (aisle_verify_base){
        .w = out.waypoints, .n = (uint32_t)out.num_waypoints, .piece = piece, .u = u, .reach = reach};
}

// The path becomes what is left of the one under way, with all its waypoints, and starts at its speed.
static void take_the_rest(void) {
    const aisle_place at = {base.piece, base.u};
    path.num_waypoints = (int16_t)aisle_motion_cut(&vehicle, out.waypoints, base.n, base.dwell, at, path.waypoints,
                                                   AISLE_PATH_MAX_WAYPOINTS);
    TEST_ASSERT_GREATER_THAN(0, path.num_waypoints);
    path.num_base = 1;
    v_start = (double)path.waypoints[0].v;
    path_retime(0.2);
    path_seal();
}

static aisle_verify_fault verified_in_motion(const aisle_verify_base *of) {
    aisle_verify_request request = usual_request();
    request.v_start = v_start;
    request.base = of;
    (void)verify_request(&request, UINT32_MAX);
    return verify.fault;
}

static void assert_with_base(aisle_verify_fault fault) {
    path_seal();
    TEST_ASSERT_EQUAL(AISLE_VERIFY_NONE, verified_in_motion(NULL)); // it is the base alone that is tested
    TEST_ASSERT_EQUAL(fault, verified_in_motion(&base));
}

static void assert_counts(int from, int to) {
    const int was = path.num_base;
    for (int i = 0; i <= path.num_waypoints; i++) {
        path.num_base = (int16_t)i;
        assert_with_base(i >= from && i <= to ? AISLE_VERIFY_NONE : AISLE_VERIFY_BASE);
    }
    path.num_base = (int16_t)was;
    path_seal();
}

// Four lines of 1 m, an arc of 2 m and two lines more, at 0.8 m/s in the middle.
static void usual_path(void) {
    path_begin(-5.0, -5.0, 0.3);
    for (int i = 0; i < 4; i++) {
        path_line(1.0);
    }
    path_arc(0.4, 0.8);
    path_line(1.0);
    path_line(1.0);
    end_gently(0.8);
}

void setUp(void) {
    static bool built;
    if (!built) {
        empty_world();
        built = true;
    }
    vehicle_box(0.5, 0.5, 0.7, 0.0);
    v_start = 0.0;
    usual_path();
}
void tearDown(void) {}

// ---- a start in motion

static void test_a_path_may_begin_as_fast_as_v_start_and_no_faster(void) {
    goes_out(3, 0.5, 0.0);
    take_the_rest();
    TEST_ASSERT_GREATER_THAN(700, (int)(v_start * 1000.0));
    TEST_ASSERT_EQUAL(AISLE_VERIFY_NONE, verified_in_motion(NULL));
    v_start *= 1.1;
    TEST_ASSERT_EQUAL(AISLE_VERIFY_NONE, verified_in_motion(NULL));
    v_start *= 0.9;
    TEST_ASSERT_EQUAL(AISLE_VERIFY_REST, verified_in_motion(NULL));
    TEST_ASSERT_EQUAL_UINT32(0, verify.fault_waypoint);
    v_start = 0.0;
    TEST_ASSERT_EQUAL(AISLE_VERIFY_REST, verified_in_motion(NULL));
}

static void test_a_stop_a_turn_or_a_lone_waypoint_does_not_begin_in_motion(void) {
    goes_out(3, 0.5, 0.0);
    take_the_rest();
    path.waypoints[0].flags |= AISLE_WAYPOINT_STOP;
    path_seal();
    TEST_ASSERT_EQUAL(AISLE_VERIFY_REST, verified_in_motion(NULL));
    path_begin(0.0, 0.0, 0.0);
    path_turn(1.0);
    path_end();
    path.waypoints[0].v = 0.1F;
    path_seal();
    v_start = 1.0;
    TEST_ASSERT_EQUAL(AISLE_VERIFY_REST, verified_in_motion(NULL));
    path_begin(0.0, 0.0, 0.0);
    path_end();
    path.waypoints[0].v = 0.1F;
    path_seal();
    TEST_ASSERT_EQUAL(AISLE_VERIFY_REST, verified_in_motion(NULL));
}

static void test_a_start_in_motion_is_held_to_every_limit(void) {
    goes_out(3, 0.5, 0.0);
    take_the_rest();
    v_start = 5.0;
    path.waypoints[0].v = 1.6F; // above v_max, and more than braking allows
    path_retime(0.2);
    path_seal();
    TEST_ASSERT_EQUAL(AISLE_VERIFY_ACCELERATION, verified_in_motion(NULL));
    path.waypoints[0].v = 0.8F;
    path.waypoints[0].theta += 0.1;
    path_seal();
    TEST_ASSERT_EQUAL(AISLE_VERIFY_HEADING, verified_in_motion(NULL));
}

static void test_an_omni_vehicle_may_begin_in_motion_to_any_side(void) {
    vehicle.drive = AISLE_VEHICLE_OMNI;
    goes_out(3, 0.5, 0.0);
    take_the_rest();
    for (int i = 0; i < path.num_waypoints; i++) {
        path.waypoints[i].theta = wrapped((long double)path.waypoints[i].theta + 2.0L);
    }
    path_goal.theta = path.waypoints[path.num_waypoints - 1].theta;
    path_seal();
    TEST_ASSERT_EQUAL(AISLE_VERIFY_NONE, verified_in_motion(NULL));
}

// ---- status STOP

// From 0.8 m/s on for `on` s, then down to rest.
static void stopping_path(double v, double on) {
    path_begin(0.0, 0.0, 0.0);
    if (on > 0.0) {
        path_line(v * on);
    }
    path_line(0.5 * v * v / vehicle.d_max);
    path_end();
    path.waypoints[0].v = (float)v;
    path.waypoints[path.num_waypoints - 2].v = (float)v;
    path.status = AISLE_PATH_STOP;
    path.num_base = path.num_waypoints;
    v_start = (double)(float)v;
    path_retime(0.2);
    path_seal();
}

static void assert_stop(aisle_verify_fault fault) {
    path_seal();
    path.status = AISLE_PATH_PARTIAL;
    path_seal();
    TEST_ASSERT_EQUAL(AISLE_VERIFY_NONE, verified_in_motion(NULL));
    path.status = AISLE_PATH_STOP;
    path_seal();
    TEST_ASSERT_EQUAL(fault, verified_in_motion(NULL));
}

static void test_a_stop_brakes_within_half_a_second(void) {
    stopping_path(0.8, 0.0);
    assert_stop(AISLE_VERIFY_NONE);
    stopping_path(0.8, 0.1);
    assert_stop(AISLE_VERIFY_NONE);
    stopping_path(0.8, 0.499);
    assert_stop(AISLE_VERIFY_NONE);
    stopping_path(0.8, 0.51);
    assert_stop(AISLE_VERIFY_STOP);
    TEST_ASSERT_EQUAL_UINT32(2, verify.fault_waypoint);
}

static void test_a_stop_never_gets_faster(void) {
    stopping_path(0.8, 0.4);
    path.waypoints[0].v = 0.78F;
    path_retime(0.2);
    assert_stop(AISLE_VERIFY_STOP);
    path_begin(0.0, 0.0, 0.0); // sets out from rest
    path_line(0.01);
    path_end();
    v_start = 0.0;
    assert_stop(AISLE_VERIFY_STOP);
    path_begin(0.0, 0.0, 0.0); // stands
    path_end();
    assert_stop(AISLE_VERIFY_NONE);
}

static void test_a_stop_in_a_turn_is_that_turn_s_rest(void) {
    const double most = 0.5 + 0.5 / vehicle.alpha_max; // omega_max is 1 rad/s
    path_begin(0.0, 0.0, 0.0);
    path_turn(most);
    path_end();
    assert_stop(AISLE_VERIFY_NONE);
    path_begin(0.0, 0.0, 0.0);
    path_turn(-most - 0.01);
    path_end();
    assert_stop(AISLE_VERIFY_STOP);
    path_begin(0.0, 0.0, 0.0);
    path_turn(0.1);
    path_turn(0.1);
    path_end();
    assert_stop(AISLE_VERIFY_STOP);
}

// ---- the curve

static void test_what_is_left_of_the_path_under_way_keeps_its_base(void) {
    for (int i = 0; i < 40; i++) {
        usual_path();
        goes_out(1U + (uint32_t)i % 7U, 0.025 * i, 0.1 * i);
        take_the_rest();
        int on_base = 1;
        double way = 0.0;
        for (; on_base < path.num_waypoints; on_base++) {
            way += (double)stretch_at(on_base).length;
            if (way > base.reach) {
                break;
            }
        }
        path.num_base = (int16_t)on_base;
        assert_with_base(AISLE_VERIFY_NONE);
    }
}

static void test_a_micrometre_aside_on_the_base_is_seen(void) {
    for (int i = 0; i < 6; i++) {
        const double aside = i % 2 == 0 ? 1.5e-6 : 0.7e-6;
        usual_path();
        goes_out(2, 0.25, 1.8);
        take_the_rest();
        path.num_base = 3;
        aisle_waypoint_msg *w = &path.waypoints[1 + i / 2]; // 0.75, 1.75 and 2.75 m on
        w->x -= aside * sin(0.3);
        w->y += aside * cos(0.3);
        path_retime(0.2);
        assert_with_base(i % 2 == 0 && i < 4 ? AISLE_VERIFY_BASE : AISLE_VERIFY_NONE);
        if (verify.fault != AISLE_VERIFY_NONE) {
            TEST_ASSERT_EQUAL_UINT32(1 + i / 2, verify.fault_waypoint);
            TEST_ASSERT_DOUBLE_WITHIN(1.1, w->x, verify.fault_at.x);
        }
    }
}

static void test_another_way_beyond_the_base_is_free(void) {
    goes_out(2, 0.0, 1.0);
    path_begin(out.waypoints[1].x, out.waypoints[1].y, out.waypoints[1].theta);
    path_line(1.0);
    path_arc(-1.0, 0.7);
    path_line(3.0);
    end_gently(0.4);
    path.num_base = 2;
    assert_with_base(AISLE_VERIFY_NONE);
    base.reach = 1.1;
    assert_with_base(AISLE_VERIFY_BASE);
    TEST_ASSERT_EQUAL_UINT32(2, verify.fault_waypoint);
}

// Both ends and the heading fit, the curve between them does not.
static void test_a_bulge_between_the_waypoints_is_seen(void) {
    vehicle.drive = AISLE_VEHICLE_OMNI;
    for (int i = 0; i < 2; i++) {
        path_begin(0.0, 0.0, 1.0);
        path_line(4.0);
        path_line(1.0);
        end_gently(0.4);
        goes_out(1, 0.0, 3.5);
        path.num_base = 1;
        path.waypoints[1].curvature = i == 0 ? 1e-6F : 0.3e-6F; // a sagitta of 2 and 0.6 micrometres
        path_retime(0.2);
        assert_with_base(i == 0 ? AISLE_VERIFY_BASE : AISLE_VERIFY_NONE);
    }
}

static void test_an_arc_the_other_way_or_a_line_for_an_arc_is_seen(void) {
    vehicle.drive = AISLE_VEHICLE_OMNI;
    for (int i = 0; i < 3; i++) {
        path_begin(0.0, 0.0, 0.0);
        path_arc(0.5, 1.0);
        end_gently(0.4);
        goes_out(1, 0.0, 1.9);
        path.num_base = 1;
        path.waypoints[1].curvature = i == 0 ? 0.5F : (i == 1 ? -0.5F : 0.0F);
        path_retime(0.2);
        assert_with_base(i == 0 ? AISLE_VERIFY_NONE : AISLE_VERIFY_BASE);
    }
}

static void test_another_heading_on_the_way_is_seen(void) {
    vehicle.drive = AISLE_VEHICLE_OMNI;
    for (int i = 0; i < 2; i++) {
        usual_path();
        goes_out(2, 0.0, 2.5);
        take_the_rest();
        path.num_base = 3;
        path.waypoints[2].theta += i == 0 ? 1.5e-6 : 0.7e-6;
        assert_with_base(i == 0 ? AISLE_VERIFY_BASE : AISLE_VERIFY_NONE);
    }
}

static void test_the_new_path_begins_where_the_base_does(void) {
    goes_out(2, 0.5, 0.0);
    take_the_rest();
    assert_with_base(AISLE_VERIFY_NONE);
    base.u += 3e-6;
    assert_with_base(AISLE_VERIFY_BASE);
    TEST_ASSERT_EQUAL_UINT32(1, verify.fault_waypoint);
    base.u -= 6e-6;
    assert_with_base(AISLE_VERIFY_BASE);
}

static void test_a_path_may_begin_at_the_end_of_a_piece_just_before_it(void) {
    for (int i = 0; i < 2; i++) {
        usual_path();
        goes_out(2, 1.0 - (i == 0 ? 1.9e-6 : 2.5e-6), 1.5);
        path_begin(out.waypoints[2].x, out.waypoints[2].y, out.waypoints[2].theta);
        path_line(1.0);
        path_line(1.0);
        end_gently(0.4);
        path.num_base = 2;
        assert_with_base(i == 0 ? AISLE_VERIFY_NONE : AISLE_VERIFY_BASE);
        path.waypoints[0].x -= 1.9e-6 * cos(0.3); // or just there
        path.waypoints[0].y -= 1.9e-6 * sin(0.3);
        assert_with_base(AISLE_VERIFY_NONE);
    }
}

static void test_driving_back_on_the_base_is_seen(void) {
    goes_out(1, 0.0, 2.0);
    path_begin(-5.0, -5.0, 0.3);
    path_line(1.0);
    pen_flags = AISLE_WAYPOINT_REVERSE;
    path_line(0.5);
    end_gently(0.2);
    path.num_base = 2;
    v_start = 0.2; // so that speeds are free
    assert_with_base(AISLE_VERIFY_BASE);
    base.reach = 1.0;
    assert_with_base(AISLE_VERIFY_NONE);
}

static void test_a_path_that_ends_on_the_base_keeps_it(void) {
    goes_out(1, 0.0, 3.5);
    path_begin(-5.0, -5.0, 0.3);
    path_line(1.0);
    path_line(0.7);
    end_gently(0.5);
    path.status = AISLE_PATH_PARTIAL;
    path.num_base = 3;
    assert_with_base(AISLE_VERIFY_NONE);
    assert_counts(3, 3);
}

static void test_after_the_end_of_the_path_under_way_all_is_free(void) {
    path_begin(0.0, 0.0, 0.0);
    path_line(2.0);
    end_gently(0.5);
    goes_out(1, 0.0, 9.0);
    path_begin(0.0, 0.0, 0.0);
    path_line(2.0);
    path_turn(1.0);
    path_line(1.0);
    end_gently(0.5);
    path.num_base = 2;
    assert_with_base(AISLE_VERIFY_NONE);
}

static void test_a_vehicle_that_stands_is_bound_to_its_place_alone(void) {
    path_begin(1.0, 2.0, 0.5);
    path_end();
    goes_out(0, 0.0, 5.0);
    path_begin(1.0, 2.0, 0.5);
    path_turn(-1.0);
    path_line(1.0);
    end_gently(0.5);
    path.num_base = 1;
    assert_with_base(AISLE_VERIFY_NONE);
    path_begin(1.0 + 2e-6, 2.0, 0.5);
    path_line(1.0);
    end_gently(0.5);
    path.num_base = 1;
    assert_with_base(AISLE_VERIFY_BASE);
}

// ---- waypoints of the base

static void test_num_base_counts_the_waypoints_of_the_base(void) {
    goes_out(2, 0.25, 0.7);
    take_the_rest(); // waypoints 0, 0.75, 1.75, 2.75, 4.75, ... m on
    assert_counts(1, 1);
    base.reach = 0.75; // rounding decides
    assert_counts(1, 2);
    base.reach = 0.75 - 0.7e-6;
    assert_counts(1, 2);
    base.reach = 0.75 - 1.5e-6;
    assert_counts(1, 1);
    base.reach = 0.75001;
    assert_counts(2, 2);
    base.turn = true; // there is none
    assert_counts(2, 2);
    base.reach = 0.4;
    assert_counts(1, 1);
    base.reach = 4.0;
    assert_counts(4, 4);
    base.reach = 100.0; // to the end of the path under way: again
    assert_counts(path.num_waypoints - 1, path.num_waypoints);
}

static void test_without_a_base_num_base_is_only_within_the_path(void) {
    for (int i = 0; i <= path.num_waypoints + 1; i++) {
        path.num_base = (int16_t)i;
        path_seal();
        TEST_ASSERT_EQUAL(i <= path.num_waypoints ? AISLE_VERIFY_NONE : AISLE_VERIFY_DECODE, verified_in_motion(NULL));
    }
}

// ---- turns on the spot, waits

static void turning_path(double angle) {
    path_begin(0.0, 0.0, 0.0);
    path_line(1.0);
    path_turn(angle);
    path_line(1.0);
    end_gently(0.4);
}

// What is left of the turn by 1.5 after 0.5 and on.
static void turn_by(double angle) {
    path_begin(1.0, 0.0, 0.5);
    path_turn(angle);
    path_line(1.0);
    end_gently(0.4);
    path.num_base = 2;
}

static void test_a_turn_under_way_is_finished_if_it_is_of_the_base(void) {
    turning_path(1.5);
    goes_out(2, 1.0 / 3.0, 0.0);
    base.turn = true;
    turn_by(1.0);
    assert_with_base(AISLE_VERIFY_NONE);
    assert_counts(2, 2);
    turn_by(1.2); // round and on
    path.num_base = 1;
    assert_with_base(AISLE_VERIFY_NONE);
    turn_by(-0.5);
    assert_with_base(AISLE_VERIFY_BASE);
    turn_by(0.9);
    assert_with_base(AISLE_VERIFY_BASE);
    base.turn = false;
    path.num_base = 1;
    assert_with_base(AISLE_VERIFY_NONE);
    turn_by(-0.5);
    path.num_base = 1;
    assert_with_base(AISLE_VERIFY_NONE);
}

static void test_half_a_turn_goes_on_the_way_round_it_went(void) {
    for (int i = 0; i < 2; i++) {
        turning_path(3.1415926);
        goes_out(2, 0.0, 0.0);
        base.turn = true;
        path_begin(1.0, 0.0, 0.0);
        path_turn(i == 0 ? 3.1415926 : -3.1415926);
        path_line(1.0);
        end_gently(0.4);
        path.num_base = 2;
        assert_with_base(i == 0 ? AISLE_VERIFY_NONE : AISLE_VERIFY_BASE);
    }
}

static void test_a_turn_may_come_to_rest_before_its_end(void) {
    turning_path(1.5);
    goes_out(2, 1.0 / 3.0, 0.0);
    base.turn = true;
    path_begin(1.0, 0.0, 0.5);
    path_turn(0.3);
    path_end();
    path.status = AISLE_PATH_PARTIAL;
    path.num_base = 2;
    assert_with_base(AISLE_VERIFY_NONE);
    assert_counts(2, 2);
}

static void test_a_turn_before_the_base_ends_belongs_to_it(void) {
    for (int i = 0; i < 3; i++) {
        turning_path(1.5);
        goes_out(1, 0.5, i == 2 ? 0.5 : 1.0); // 0.5 m to the turn
        take_the_rest();
        path.num_base = i == 2 ? 3 : 4; // one where it begins to brake
        assert_with_base(AISLE_VERIFY_NONE);
        path_begin(0.5, 0.0, 0.0);
        path_line(0.5);
        path_turn(i == 0 ? -1.5 : 1.499);
        path_line(1.0);
        end_gently(0.2);
        v_start = 0.2;
        path.num_base = i == 1 ? 3 : 2;
        assert_with_base(i == 2 ? AISLE_VERIFY_NONE : AISLE_VERIFY_BASE);
    }
}

static void test_a_wait_more_or_less_on_the_base_changes_nothing(void) {
    path_begin(0.0, 0.0, 0.0);
    path_line(1.0);
    path_turn(0.0);
    path_line(1.0);
    end_gently(0.4);
    goes_out(1, 0.0, 1.5);
    path_begin(0.0, 0.0, 0.0);
    path_turn(0.0);
    path_line(0.5);
    path_turn(0.0);
    path_line(1.5);
    end_gently(0.2);
    path.num_base = 4;
    v_start = 0.2;
    assert_with_base(AISLE_VERIFY_NONE);
    assert_counts(4, 4);
}

// ---- speeds

static void test_slower_on_the_base_is_free_and_faster_is_not(void) {
    const float factors[4] = {0.8F, 1.0F, 1.0004F, 1.003F};
    for (int i = 0; i < 4; i++) {
        usual_path();
        goes_out(3, 0.5, 1.2);
        take_the_rest();
        v_start *= 0.9; // not what allows it
        path.waypoints[0].v *= 0.9F;
        path.num_base = 2;
        path.waypoints[1].v *= factors[i];
        path_retime(0.2);
        assert_with_base(i < 3 ? AISLE_VERIFY_NONE : AISLE_VERIFY_BASE);
    }
}

static void test_faster_beyond_the_base_is_free(void) {
    usual_path();
    goes_out(2, 0.5, 1.2);
    take_the_rest();
    path.num_base = 2;
    path.waypoints[3].v *= 1.05F;
    path_retime(0.2);
    assert_with_base(AISLE_VERIFY_NONE);
    base.reach = 1.6; // its piece begins after 1.5 m
    assert_with_base(AISLE_VERIFY_BASE);
    TEST_ASSERT_EQUAL_UINT32(3, verify.fault_waypoint);
}

// A vehicle found faster than its path may come down to it on the way.
static void test_up_to_v_start_is_as_good_as_the_old_speed(void) {
    usual_path();
    goes_out(3, 0.5, 1.2);
    take_the_rest();
    v_start *= 1.1;
    path.num_base = 2;
    path.waypoints[0].v *= 1.1F;
    path.waypoints[1].v *= 1.09F;
    path_retime(0.2);
    assert_with_base(AISLE_VERIFY_NONE);
    path.waypoints[1].v = (float)(v_start * 1.01);
    path_retime(0.2);
    assert_with_base(AISLE_VERIFY_BASE);
}

// The old speed falls below v_start within one piece; a straight line over that bend is faster than both.
static void test_the_bend_where_the_old_speed_falls_below_v_start_is_seen(void) {
    for (int i = 0; i < 2; i++) {
        path_begin(0.0, 0.0, 0.0);
        path_line(4.0);
        path_line(4.0);
        path_line(4.0);
        end_gently(1.0);
        path.waypoints[2].v = 0.1F;
        path_retime(0.2);
        path_seal();
        goes_out(1, 0.5, 6.0); // at 0.71 m/s, 1 m/s after 2 m
        take_the_rest();
        v_start = 0.7;
        path.waypoints[0].v = 0.7F;
        path.waypoints[2].v = i == 0 ? 0.7F : 0.1F;
        path.num_base = 2;
        path_retime(0.2);
        assert_with_base(i == 0 ? AISLE_VERIFY_BASE : AISLE_VERIFY_NONE);
    }
}

// 3 m from rest to rest: as they stand, driven by v at places 0.05 m from the ends and in the middle.
static void old_speeds(double first, double middle, double last) {
    path_begin(0.0, 0.0, 0.0);
    path_line(0.05);
    path_line(1.45);
    path_line(1.45);
    path_line(0.05);
    end_gently(0.4);
    path.waypoints[1].v = (float)first;
    path.waypoints[2].v = (float)middle;
    path.waypoints[3].v = (float)last;
    path_retime(0.2);
    path_seal();
    goes_out(1, 0.0, 4.0);
    path_begin(0.0, 0.0, 0.0);
    path_line(3.0);
    end_gently(0.4); // a trapezoid of 0.2 m/s that bends 0.04 m from its ends
    path.num_base = 2;
}

static void test_a_trapezoid_is_compared_where_it_bends(void) {
    old_speeds(0.2236, 0.2, 0.2236);
    assert_with_base(AISLE_VERIFY_NONE);
    old_speeds(0.2, 0.2, 0.2236);
    assert_with_base(AISLE_VERIFY_BASE);
    old_speeds(0.2236, 0.2, 0.2);
    assert_with_base(AISLE_VERIFY_BASE);
    old_speeds(0.2236, 0.19, 0.2236);
    assert_with_base(AISLE_VERIFY_BASE);
    old_speeds(0.2236, 0.4, 0.2236);
    assert_with_base(AISLE_VERIFY_NONE);
}

// Where it brakes to rest, a micrometre is a millimetre a second.
static void test_speeds_a_micrometre_off_each_other_are_the_same(void) {
    for (int i = 0; i < 2; i++) {
        old_speeds(0.2236, 0.2, 0.2236);
        path = out;
        path.waypoints[0].x -= i == 0 ? 0.9e-6 : -0.9e-6;
        path.num_base = 5;
        assert_with_base(AISLE_VERIFY_NONE);
    }
}

// A piece at rest at both ends is a trapezoid by its time: what is cut from it is, too.
static void test_a_trapezoid_cut_in_motion_keeps_the_base(void) {
    for (int i = 0; i < 19; i++) {
        path_begin(0.0, 0.0, 0.0);
        path_turn(1.0);
        path_line(3.0);
        end_gently(0.4);
        goes_out(2, 0.05 + 0.05 * i, 1.0);
        take_the_rest();
        path.num_base = 1;
        for (int k = 1; k < path.num_waypoints; k++) {
            path.num_base =
                (int16_t)(path.num_base + ((double)path.waypoints[k].s <= 1.0 || (double)path.length < 1.0 ? 1 : 0));
        }
        assert_with_base(AISLE_VERIFY_NONE);
        if (i >= 3 && i <= 9) { // at its peak of 0.2 m/s: braking earlier, from more
            path.waypoints[1].x -= 0.01 * cos(1.0);
            path.waypoints[1].y -= 0.01 * sin(1.0);
            path.waypoints[1].v *= 1.01F;
            path_retime(0.2);
            assert_with_base(AISLE_VERIFY_BASE);
        }
    }
}

static void test_a_trapezoid_may_be_driven_with_less_time_by_rounding_alone(void) {
    const double peaks[3] = {0.18, 0.2, 0.21};
    for (int i = 0; i < 3; i++) {
        path_begin(0.0, 0.0, 0.0);
        path_line(3.0);
        end_gently(0.4);
        for (int k = 0; k < 2; k++) {
            out.waypoints[k] = path.waypoints[k];
        }
        goes_out(1, 0.0, 1.0);
        path.num_base = 1;
        path_retime(peaks[i]);
        assert_with_base(i < 2 ? AISLE_VERIFY_NONE : AISLE_VERIFY_BASE);
    }
}

// Long after the start of a path its times are coarse.
static void test_times_as_floats_make_no_trapezoid_faster(void) {
    for (int i = 0; i < 40; i++) {
        path_begin(0.0, 0.0, 0.0);
        path_turn(0.0);
        path_line(0.08 + 0.002 * i);
        end_gently(0.4);
        const double lasts = (double)path.waypoints[2].t - (double)path.waypoints[1].t;
        path.waypoints[1].t = 4000.0F + 0.1F * (float)i;
        path.waypoints[2].t = nextafterf((float)((double)path.waypoints[1].t + lasts), 1e6F);
        path.duration = path.waypoints[2].t;
        path_seal();
        goes_out(2, 0.0, 1.0);
        path_begin(0.0, 0.0, 0.0);
        path_line(0.08 + 0.002 * i);
        end_gently(0.4);
        path.num_base = 2;
        assert_with_base(AISLE_VERIFY_NONE);
    }
}

static void test_a_rest_before_the_piece_is_not_of_its_trapezoid(void) {
    float dwell[2] = {20.0F, 0.0F};
    path_begin(0.0, 0.0, 0.0);
    path_line(3.0);
    end_gently(0.4);
    goes_out(1, 0.0, 1.0);
    out.waypoints[1].t += 20.0F;
    path.num_base = 1;
    assert_with_base(AISLE_VERIFY_BASE); // as if driven in all of the time
    base.dwell = dwell;
    assert_with_base(AISLE_VERIFY_NONE);
}

// ---- against a judge of its own

static void random_path(void) {
    const int pieces = 2 + below(5);
    path_begin(uniform(-2.0, 2.0), uniform(-2.0, 2.0), uniform(-3.1, 3.1));
    for (int i = 0; i < pieces; i++) {
        pen_flags = below(6) == 0 ? (int16_t)(pen_flags ^ AISLE_WAYPOINT_REVERSE) : pen_flags;
        if (below(2) == 0) {
            path_line(uniform(0.1, 3.0));
        } else {
            path_arc(below(2) == 0 ? uniform(0.1, 0.7) : -uniform(0.1, 0.7), uniform(0.1, 1.5));
        }
    }
    end_gently(uniform(0.1, 0.7));
}

// Pose and square of the speed `way` m behind the place (piece, done m of it behind).
static bool judge_at(const aisle_waypoint_msg *w, int n, int piece, long double done, long double way,
                     long double *pose) {
    stretch s = stretch_between(&w[piece - 1], &w[piece]);
    for (way += done; way > s.length; s = stretch_between(&w[piece - 1], &w[piece])) {
        way -= s.length;
        if (++piece >= n) {
            return false;
        }
    }
    const long double v0 = (long double)w[piece - 1].v, v1 = (long double)w[piece].v;
    stretch_pose(&s, way / s.length, pose);
    pose[3] = v0 * v0 + (v1 * v1 - v0 * v0) * way / s.length;
    if (!(v0 > 0.0L) && !(v1 > 0.0L)) { // 0.5 m/s2 up and down, in the time between them
        const long double time = (long double)w[piece].t - (long double)w[piece - 1].t;
        const long double root = sqrtl(fmaxl(0.0L, time * time - 8.0L * s.length)), peak = 0.25L * (time - root);
        pose[3] = fminl(peak * peak, fminl(way, s.length - way));
    }
    return true;
}

typedef struct verdict {
    long double apart, faster; // m or rad; m2/s2 above what is allowed
    int waypoints;
} verdict;

static verdict judge(void) {
    verdict v = {0.0L, -1.0L, 1};
    const stretch first = stretch_between(&out.waypoints[base.piece - 1], &out.waypoints[base.piece]);
    const long double done = (long double)base.u * first.length, reach = (long double)base.reach;
    for (int i = 0; i <= 4000; i++) {
        long double then[4], now[4], way = reach * i / 4000.0L;
        if (!judge_at(out.waypoints, out.num_waypoints, (int)base.piece, done, way, then) ||
            !judge_at(path.waypoints, path.num_waypoints, 1, 0.0L, way, now)) {
            break;
        }
        const long double turn = fabsl(remainderl(now[2] - then[2], 2.0L * acosl(-1.0L)));
        v.apart = fmaxl(v.apart, fmaxl(turn, hypotl(now[0] - then[0], now[1] - then[1])));
        const long double limit = fmaxl(then[3], (long double)v_start * (long double)v_start);
        v.faster = fmaxl(v.faster, now[3] - 1.002001L * limit);
    }
    long double way = 0.0L, end = first.length - done;
    for (int i = (int)base.piece + 1; i < out.num_waypoints; i++) {
        end += stretch_between(&out.waypoints[i - 1], &out.waypoints[i]).length;
    }
    for (int i = 1; i < path.num_waypoints; i++) {
        way += stretch_at(i).length;
        v.waypoints += way <= fminl(reach, end) + 1e-9L ? 1 : 0;
    }
    return v;
}

// Spoils one waypoint behind the first by something between nothing and far too much.
static void spoil(void) {
    aisle_waypoint_msg *w = &path.waypoints[1 + below(path.num_waypoints - 1)];
    const double by = pow(10.0, uniform(-7.5, -4.5));
    const int kind = below(6);
    if (kind == 0) {
        w->x += by;
    } else if (kind == 1) {
        w->theta = wrapped((long double)w->theta + (long double)by);
    } else if (kind == 2) {
        w->curvature *= (float)(1.0 + 30.0 * by);
    } else if (kind == 3 && w < last_waypoint()) {
        w->v *= (float)(1.0 + uniform(-0.01, 0.01));
    } else if (kind == 4) {
        base.u = fmin(1.0, base.u + by);
    }
    path_goal.x = last_waypoint()->x;
    path_goal.theta = last_waypoint()->theta;
    path_retime(0.2);
}

static void test_random_paths_keep_their_base_where_a_judge_says_so(void) {
    int kept = 0, left = 0, fast = 0, close = 0;
    for (uint64_t seed = 0; seed < CASES(2000); seed++) {
        char why[100];
        dice = aisle_rng_seed(seed);
        v_start = 0.0;
        random_path();
        goes_out(1U + (uint32_t)below(path.num_waypoints - 1), uniform(0.0, 0.999), uniform(0.0, 6.0));
        take_the_rest();
        spoil();
        path_seal();
        if (verified_in_motion(NULL) != AISLE_VERIFY_NONE) {
            continue;
        }
        const verdict v = judge();
        path.num_base = (int16_t)v.waypoints;
        path_seal();
        const aisle_verify_fault fault = verified_in_motion(&base);
        (void)snprintf(why, sizeof why, "seed %d, %.3g apart, %.3g faster", (int)seed, (double)v.apart,
                       (double)v.faster);
        if ((v.apart > 0.9e-6L && v.apart < 1.05e-6L) || (v.faster > -1e-7L && v.faster < 3e-6L)) {
            close++; // too close to call by samples
        } else if (v.apart > 1e-6L || v.faster > 0.0L) {
            TEST_ASSERT_EQUAL_MESSAGE(AISLE_VERIFY_BASE, fault, why);
            left += v.apart > 1e-6L ? 1 : 0;
            fast += v.apart > 1e-6L ? 0 : 1;
        } else {
            TEST_ASSERT_EQUAL_MESSAGE(AISLE_VERIFY_NONE, fault, why);
            kept++;
        }
    }
    char text[80];
    (void)snprintf(text, sizeof text, "%d kept, %d left, %d too fast, %d too close", kept, left, fast, close);
    TEST_MESSAGE(text);
    TEST_ASSERT_GREATER_THAN(CASES(700), kept);
    TEST_ASSERT_GREATER_THAN(CASES(200), left);
    TEST_ASSERT_GREATER_THAN(CASES(20), fast);
}

// ---- what was proved once

static void assert_proved_anew(const aisle_verify_request *request) {
    (void)verify_request(request, UINT32_MAX);
    TEST_ASSERT_TRUE(verify.fault != AISLE_VERIFY_NONE || verify.intervals > 0);
}

static void test_another_base_or_v_start_is_proved_anew(void) {
    goes_out(3, 0.5, 1.6);
    take_the_rest();
    path.num_base = 3;
    path_seal();
    aisle_verify_request request = usual_request();
    request.v_start = v_start;
    request.base = &base;
    TEST_ASSERT_EQUAL(AISLE_OK, verify_request(&request, UINT32_MAX));
    basis = *aisle_verify_basis(&verify);
    request.basis = &basis;
    const aisle_verify_base right = base;
    for (int i = 0; i < 13; i++) {
        base = right;
        aisle_waypoint_msg *w = &out.waypoints[4];
        const aisle_waypoint_msg was = *w;
        float dwell[16] = {0.0F};
        request.v_start = v_start + (i == 0 ? 1e-6 : 0.0);
        base.u += i == 1 ? 1e-9 : 0.0;
        base.reach += i == 2 ? 1e-9 : 0.0;
        base.turn = i == 3;
        base.piece += i == 4 ? 1U : 0U;
        w->x += i == 5 ? 1e-9 : 0.0;
        w->y += i == 6 ? 1e-9 : 0.0;
        w->theta += i == 7 ? 1e-9 : 0.0;
        w->curvature += i == 8 ? 1e-9F : 0.0F;
        w->v += i == 9 ? 1e-6F : 0.0F;
        w->t += i == 10 ? 1e-3F : 0.0F;
        w->flags ^= i == 11 ? AISLE_WAYPOINT_REVERSE : 0;
        dwell[3] = 1.0F;
        base.dwell = i == 12 ? dwell : NULL;
        assert_proved_anew(&request);
        *w = was;
    }
    base = right;
    request.v_start = v_start;
    TEST_ASSERT_EQUAL(AISLE_OK, verify_request(&request, UINT32_MAX));
    TEST_ASSERT_EQUAL_UINT32(0, verify.intervals);
    out.waypoints[7].x += 1.0; // behind its reach
    TEST_ASSERT_EQUAL(AISLE_OK, verify_request(&request, UINT32_MAX));
    TEST_ASSERT_EQUAL_UINT32(0, verify.intervals);
    request.base = NULL;
    assert_proved_anew(&request);
}

static void test_the_answer_does_not_depend_on_the_steps(void) {
    for (int i = 0; i < 2; i++) {
        usual_path();
        goes_out(3, 0.5, 2.6);
        take_the_rest();
        path.num_base = (int16_t)(i == 0 ? 4 : 1);
        path_seal();
        const aisle_verify_fault whole = verified_in_motion(&base);
        const uint32_t work = spent;
        aisle_verify_request request = usual_request();
        request.v_start = v_start;
        request.base = &base;
        (void)verify_request(&request, 1U);
        TEST_ASSERT_EQUAL(whole, verify.fault);
        TEST_ASSERT_EQUAL_UINT32(work, spent);
    }
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_a_path_may_begin_as_fast_as_v_start_and_no_faster);
    RUN_TEST(test_a_stop_a_turn_or_a_lone_waypoint_does_not_begin_in_motion);
    RUN_TEST(test_a_start_in_motion_is_held_to_every_limit);
    RUN_TEST(test_an_omni_vehicle_may_begin_in_motion_to_any_side);
    RUN_TEST(test_a_stop_brakes_within_half_a_second);
    RUN_TEST(test_a_stop_never_gets_faster);
    RUN_TEST(test_a_stop_in_a_turn_is_that_turn_s_rest);
    RUN_TEST(test_what_is_left_of_the_path_under_way_keeps_its_base);
    RUN_TEST(test_a_micrometre_aside_on_the_base_is_seen);
    RUN_TEST(test_another_way_beyond_the_base_is_free);
    RUN_TEST(test_a_bulge_between_the_waypoints_is_seen);
    RUN_TEST(test_an_arc_the_other_way_or_a_line_for_an_arc_is_seen);
    RUN_TEST(test_another_heading_on_the_way_is_seen);
    RUN_TEST(test_the_new_path_begins_where_the_base_does);
    RUN_TEST(test_a_path_may_begin_at_the_end_of_a_piece_just_before_it);
    RUN_TEST(test_driving_back_on_the_base_is_seen);
    RUN_TEST(test_a_path_that_ends_on_the_base_keeps_it);
    RUN_TEST(test_after_the_end_of_the_path_under_way_all_is_free);
    RUN_TEST(test_a_vehicle_that_stands_is_bound_to_its_place_alone);
    RUN_TEST(test_num_base_counts_the_waypoints_of_the_base);
    RUN_TEST(test_without_a_base_num_base_is_only_within_the_path);
    RUN_TEST(test_a_turn_under_way_is_finished_if_it_is_of_the_base);
    RUN_TEST(test_half_a_turn_goes_on_the_way_round_it_went);
    RUN_TEST(test_a_turn_may_come_to_rest_before_its_end);
    RUN_TEST(test_a_turn_before_the_base_ends_belongs_to_it);
    RUN_TEST(test_a_wait_more_or_less_on_the_base_changes_nothing);
    RUN_TEST(test_slower_on_the_base_is_free_and_faster_is_not);
    RUN_TEST(test_faster_beyond_the_base_is_free);
    RUN_TEST(test_up_to_v_start_is_as_good_as_the_old_speed);
    RUN_TEST(test_the_bend_where_the_old_speed_falls_below_v_start_is_seen);
    RUN_TEST(test_a_trapezoid_is_compared_where_it_bends);
    RUN_TEST(test_speeds_a_micrometre_off_each_other_are_the_same);
    RUN_TEST(test_a_trapezoid_cut_in_motion_keeps_the_base);
    RUN_TEST(test_a_trapezoid_may_be_driven_with_less_time_by_rounding_alone);
    RUN_TEST(test_times_as_floats_make_no_trapezoid_faster);
    RUN_TEST(test_a_rest_before_the_piece_is_not_of_its_trapezoid);
    RUN_TEST(test_random_paths_keep_their_base_where_a_judge_says_so);
    RUN_TEST(test_another_base_or_v_start_is_proved_anew);
    RUN_TEST(test_the_answer_does_not_depend_on_the_steps);
    return UNITY_END();
}
