#include "cases.h"
#include "test_verify_fixture.h"

static aisle_verify_fault fault_with_margin(double margin) {
    vehicle.margin = margin;
    return verified();
}

static void assert_collision(int32_t id, uint32_t waypoint) {
    TEST_ASSERT_EQUAL(AISLE_VERIFY_COLLISION, verify.fault);
    TEST_ASSERT_EQUAL_INT32(id, verify.fault_id);
    TEST_ASSERT_EQUAL_UINT32(waypoint, verify.fault_waypoint);
    TEST_ASSERT_TRUE(id == AISLE_LAYOUT_ID_BOUNDS || verify.collide.calls > 0); // axes part, but libccd condemns
}

// ---- random worlds, vehicles, paths

static void random_polygon(double x, double y, double size) {
    double v[8][2], turn = uniform(0.0, 6.28), flat = uniform(0.05, 1.0);
    int n = 3 + below(6);
    for (int i = 0; i < n; i++) {
        double a = (i + uniform(0.1, 0.9)) * 2.0 * AISLE_PI / n, c = size * cos(a), s = flat * size * sin(a);
        v[i][0] = x + c * cos(turn) - s * sin(turn);
        v[i][1] = y + c * sin(turn) + s * cos(turn);
    }
    (void)world_polygon(below(4) == 0 ? AISLE_POLYGON_KEEPOUT : AISLE_POLYGON_OBSTACLE, n, v);
}

static void random_wall(double x, double y, double length) { // 1 mm thin
    if (below(2) == 0) {
        (void)world_box(AISLE_POLYGON_OBSTACLE, x, y, x + 1e-3, y + length);
    } else {
        (void)world_box(AISLE_POLYGON_OBSTACLE, x, y, x + length, y + 1e-3);
    }
}

static void random_polygons(void) {
    int n = 3 + below(8);
    for (int i = 0; i < n; i++) {
        double x = uniform(-4.0, 4.0), y = uniform(-4.0, 4.0);
        if (below(4) == 0) {
            random_wall(x, y, uniform(0.05, 2.0));
        } else {
            random_polygon(x, y, uniform(0.05, 0.8));
        }
    }
}

static void random_scan(void) {
    world_scan(64, 64); // cells of 1/8 m
    int blobs = 4 + below(12);
    for (int i = 0; i < blobs; i++) {
        uint32_t x = (uint32_t)below(56), y = (uint32_t)below(56);
        uint32_t w = below(2) == 0 ? 1U : 1U + (uint32_t)below(8), h = below(2) == 0 ? 1U : 1U + (uint32_t)below(8);
        world_cells(x, y, w, h);
    }
}

static void random_world(bool scan, bool polygons) {
    world_begin(-4.0, -4.0, 4.0, 4.0, scan ? 0.0F : 0.25F);
    if (polygons) {
        random_polygons();
    }
    if (scan) {
        random_scan();
    }
    world_build();
}

static void random_vehicle(void) {
    static aisle_vehicle_msg msg;
    int kind = below(4);
    if (kind == 0) {
        vehicle_disc(uniform(0.05, 0.4));
    } else if (kind == 1) {
        vehicle_box(uniform(0.05, 0.9), uniform(0.05, 0.9), uniform(0.1, 0.6), 0.0);
    } else if (kind == 2) {
        vehicle_box(-0.1, uniform(0.2, 0.8), uniform(0.1, 0.6), uniform(0.01, 0.1)); // the origin outside
    } else {
        memset(&msg, 0, sizeof msg);
        msg.num_vertices = (int16_t)(3 + below(14));
        for (int i = 0; i < msg.num_vertices; i++) {
            double a = 2.0 * AISLE_PI * i / msg.num_vertices;
            msg.footprint[i][0] = 0.4 * cos(a) + 0.1;
            msg.footprint[i][1] = 0.25 * sin(a);
        }
        vehicle_from(&msg);
    }
}

enum { LINES = 1, ARCS = 2, TURNS = 4 };

static void random_piece(int kinds) {
    for (;;) {
        int kind = 1 << below(3);
        if ((kind & kinds) == 0) {
            continue;
        }
        if (kind == LINES) {
            path_line(uniform(0.05, 2.0));
        } else if (kind == ARCS) {
            double k = uniform(0.2, 2.5);
            path_arc(below(2) == 0 ? k : -k, uniform(0.05, 2.9));
        } else {
            path_turn(uniform(-3.1, 3.1));
        }
        return;
    }
}

static void random_path(int kinds) {
    int pieces = 1 + below(3);
    path_begin(uniform(-2.0, 2.0), uniform(-2.0, 2.0), uniform(-3.1, 3.1));
    for (int i = 0; i < pieces; i++) {
        pen_flags = below(4) == 0 ? AISLE_WAYPOINT_REVERSE : 0;
        random_piece(kinds);
    }
    path_end();
}

typedef struct tally {
    int near, hit; // paths judged at their very gap; paths through something
} tally;

// A path whose least sampled gap is g: with a margin a hair above g it must be refused, with one below g by `slack`
// proved.
static void judge_random_path(int kinds, double slack, uint64_t seed, tally *out) {
    char why[120];
    random_path(kinds);
    double gap = judge_gap(2e-4);
    (void)snprintf(why, sizeof why, "seed %llu, sampled gap %.9f", (unsigned long long)seed, gap);
    TEST_ASSERT_EQUAL_MESSAGE(AISLE_VERIFY_COLLISION, fault_with_margin(fmax(gap + 1e-7, 0.0)), why);
    if (gap < 1e-7) {
        out->hit++;
        return;
    }
    if (gap > slack) {
        out->near++;
        TEST_ASSERT_EQUAL_MESSAGE(AISLE_VERIFY_NONE, fault_with_margin(gap - slack), why);
    }
}

static void judge_random_paths(bool scan, bool polygons, int kinds, double slack, uint64_t seeds, int near) {
    tally out = {0, 0};
    for (uint64_t seed = 0; seed < CASES(seeds); seed++) {
        dice = aisle_rng_seed(seed * 64U + (uint64_t)kinds * 2U + (scan ? 1U : 0U));
        random_world(scan, polygons);
        random_vehicle();
        for (int i = 0; i < 8; i++) {
            judge_random_path(kinds, slack, seed, &out);
        }
    }
    char text[80];
    (void)snprintf(text, sizeof text, "%d near, %d hit", out.near, out.hit);
    TEST_MESSAGE(text);
    TEST_ASSERT_GREATER_OR_EQUAL_MESSAGE(CASES(near), out.near, "paths that were free");
    TEST_ASSERT_GREATER_OR_EQUAL_MESSAGE(CASES(near) / 2, out.hit, "paths that were not");
}

static void test_straight_paths_among_polygons_are_judged_to_the_sampling(void) {
    judge_random_paths(false, true, LINES, 2.1e-4, 60, 100);
}
static void test_arcs_among_polygons_are_judged_to_a_millimetre(void) {
    judge_random_paths(false, true, ARCS, 7e-4, 60, 100);
}
static void test_turns_among_polygons_are_judged_to_a_millimetre(void) {
    judge_random_paths(false, true, TURNS, 7e-4, 60, 100);
}
static void test_straight_paths_on_a_scan_are_judged_to_the_sampling(void) {
    judge_random_paths(true, false, LINES, 2.1e-4, 40, 50);
}
static void test_mixed_paths_on_a_scan_are_judged_to_a_millimetre(void) {
    judge_random_paths(true, false, LINES | ARCS | TURNS, 7e-4, 60, 60);
}
static void test_mixed_paths_on_a_scan_with_polygons_are_judged_to_a_millimetre(void) {
    judge_random_paths(true, true, LINES | ARCS | TURNS, 7e-4, 60, 60);
}

// ---- by hand

static void test_an_obstacle_at_the_middle_of_an_arc_alone_is_found(void) {
    vehicle_disc(0.2);
    world_begin(-5.0, -5.0, 5.0, 5.0, 0.25F);
    int32_t id =
        world_box(AISLE_POLYGON_OBSTACLE, 1.25, -0.01, 1.27, 0.01); // half a circle of radius 1 bulges to (1, 0)
    world_build();
    path_begin(0.0, -1.0, 0.0);
    path_arc(1.0, 3.0);
    path_end();
    TEST_ASSERT_EQUAL(AISLE_VERIFY_NONE, fault_with_margin(0.049));
    (void)fault_with_margin(0.0502);
    assert_collision(id, 1);
    TEST_ASSERT_DOUBLE_WITHIN(0.15, 1.0, verify.fault_at.x);
    TEST_ASSERT_DOUBLE_WITHIN(0.15, 0.0, verify.fault_at.y);
}

static void test_the_same_arc_to_the_right_bulges_to_the_left(void) {
    vehicle_disc(0.2);
    world_begin(-5.0, -5.0, 5.0, 5.0, 0.25F);
    int32_t id = world_box(AISLE_POLYGON_OBSTACLE, 1.25, -0.01, 1.27, 0.01);
    world_build();
    path_begin(0.0, 1.0, 0.0);
    path_arc(-1.0, 3.0);
    path_end();
    TEST_ASSERT_EQUAL(AISLE_VERIFY_NONE, fault_with_margin(0.049));
    (void)fault_with_margin(0.0502);
    assert_collision(id, 1);
}

static void test_a_wall_of_1_mm_across_a_long_straight_piece_is_found_and_placed(void) {
    vehicle_box(0.5, 0.5, 0.7, 0.0);
    world_begin(-10.0, -50.0, 200.0, 50.0, 1.0F);
    int32_t id = world_box(AISLE_POLYGON_OBSTACLE, 137.0, 0.3, 137.001, 0.36);
    world_build();
    path_begin(0.0, 0.0, 0.0);
    path_line(190.0);
    path_end();
    (void)fault_with_margin(0.0);
    assert_collision(id, 1);
    TEST_ASSERT_DOUBLE_WITHIN(2e-3, 136.5, verify.fault_at.x); // the front touches first
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, 0.0, verify.fault_at.y);
}

static void test_a_corner_clipped_during_a_turn_alone_is_found(void) {
    vehicle_box(0.5, 0.5, 0.7, 0.0); // half diagonal 0.6103
    world_begin(-5.0, -5.0, 5.0, 5.0, 0.25F);
    int32_t id = world_box(AISLE_POLYGON_OBSTACLE, 0.60, -0.01, 0.70, 0.01); // free at 0 and 90 degrees: 0.5, 0.35
    world_build();
    path_begin(0.0, 0.0, 0.0);
    path_turn(0.5 * AISLE_PI);
    path_end();
    (void)fault_with_margin(0.0);
    assert_collision(id, 1);
}

static void test_a_long_footprint_sweeps_with_its_far_end(void) {
    vehicle_box(0.1, 2.0, 0.1, 0.0);
    world_begin(-5.0, -5.0, 5.0, 5.0, 0.25F);
    int32_t id = world_box(AISLE_POLYGON_OBSTACLE, 1.40, 1.40, 1.41, 1.41); // 1.98 m away, at 45 degrees
    world_build();
    path_begin(0.0, 0.0, 0.0);
    path_turn(0.5 * AISLE_PI);
    path_end();
    (void)fault_with_margin(0.0);
    assert_collision(id, 1);
    path_begin(0.0, 0.0, 0.0); // the other way round it is free
    path_turn(-0.5 * AISLE_PI);
    path_end();
    TEST_ASSERT_EQUAL(AISLE_VERIFY_NONE, fault_with_margin(0.1));
}

static void test_half_a_turn_is_proved_both_ways_round(void) {
    vehicle_box(0.1, 1.0, 0.1, 0.0);
    for (int side = -1; side <= 1; side++) {
        world_begin(-5.0, -5.0, 5.0, 5.0, 0.25F);
        int32_t id = side == 0 ? 0 : world_box(AISLE_POLYGON_OBSTACLE, -0.1, 0.8 * side - 0.1, 0.1, 0.8 * side + 0.1);
        world_build();
        path_begin(0.0, 0.0, 0.0);
        path_turn(AISLE_PI);
        path_end();
        (void)fault_with_margin(0.0);
        if (side == 0) {
            TEST_ASSERT_EQUAL(AISLE_VERIFY_NONE, verify.fault);
        } else {
            assert_collision(id, 1);
        }
    }
}

// Of the speed limit 0.2 m/s is asked, and DIRECTED has direction 0.
static void test_a_keepout_stops_and_zones_do_not_bar_a_slow_way_along_them(void) {
    for (int8_t kind = AISLE_POLYGON_OBSTACLE; kind <= AISLE_POLYGON_DIRECTED; kind++) {
        vehicle_disc(0.3);
        world_begin(-5.0, -5.0, 5.0, 5.0, 0.25F);
        int32_t id = world_box(kind, 0.0, 0.0, 1.0, 1.0);
        world_build();
        path_begin(-2.0, 0.5, 0.0);
        path_line(4.0);
        path_end();
        path_retime(0.2);
        path_seal();
        (void)fault_with_margin(0.1);
        if (kind == AISLE_POLYGON_OBSTACLE || kind == AISLE_POLYGON_KEEPOUT) {
            assert_collision(id, 1);
        } else {
            TEST_ASSERT_EQUAL(AISLE_VERIFY_NONE, verify.fault);
        }
    }
}

static void test_the_margin_is_kept_to_each_of_the_four_bounds(void) {
    vehicle_box(0.5, 0.5, 0.7, 0.0);
    world_begin(-5.0, -3.0, 5.0, 3.0, 0.25F);
    world_build();
    const double ways[4][4] = {{0, 0, 0.0, 4.4}, {0, 0, 0.5, 2.4}, {0, 0, 1.0, 4.4}, {0, 0, 1.5, 2.4}};
    for (int i = 0; i < 4; i++) {
        path_begin(ways[i][0], ways[i][1], ways[i][2] * AISLE_PI);
        path_line(ways[i][3]);
        path_end();
        TEST_ASSERT_EQUAL(AISLE_VERIFY_NONE, fault_with_margin(0.0999));
        (void)fault_with_margin(0.1001);
        assert_collision(AISLE_LAYOUT_ID_BOUNDS, 1);
    }
}

static void test_a_single_occupied_cell_stops(void) {
    vehicle_disc(0.3);
    world_begin(0.0, 0.0, 10.0, 8.0, 0.0F);
    world_scan(100, 80);
    world_cells(50, 40, 1, 1); // [5.0, 5.1] x [4.0, 4.1]
    world_build();
    for (int side = 0; side < 2; side++) {
        double y = side == 0 ? 4.1 + 0.4 : 4.0 - 0.4;
        path_begin(1.0, y, 0.0);
        path_line(8.0);
        path_end();
        TEST_ASSERT_EQUAL(AISLE_VERIFY_NONE, fault_with_margin(0.0999));
        (void)fault_with_margin(0.1001);
        assert_collision(AISLE_LAYOUT_ID_SCAN, 1);
        TEST_ASSERT_DOUBLE_WITHIN(0.2, 5.05, verify.fault_at.x);
    }
}

static void test_a_straight_path_may_be_as_close_as_2_micrometres_above_the_margin(void) {
    vehicle_disc(0.25);
    world_begin(-5.0, -5.0, 5.0, 5.0, 0.25F);
    int32_t id = world_box(AISLE_POLYGON_OBSTACLE, -1.0, 0.5, 1.0, 0.75);
    world_build();
    path_begin(-4.0, 0.0, 0.0);
    path_line(8.0);
    path_end();
    TEST_ASSERT_EQUAL(AISLE_VERIFY_NONE, fault_with_margin(0.25 - 2e-6));
    (void)fault_with_margin(0.25);
    assert_collision(id, 1);
}

static void test_what_lies_off_the_scan_is_out_of_bounds(void) {
    vehicle_disc(0.3);
    vehicle.margin = 0.0;
    world_begin(0.0, 0.0, 10.04, 8.04, 0.0F); // 100 x 80 cells of 0.1 m: the bounds reach 0.04 m farther
    world_scan(100, 80);
    world_res = 0.1;
    world_build();
    const double ends[4][3] = {{9.69, 4.0, AISLE_VERIFY_NONE},
                               {9.71, 4.0, AISLE_VERIFY_COLLISION},
                               {5.0, 7.69, AISLE_VERIFY_NONE},
                               {5.0, 7.71, AISLE_VERIFY_COLLISION}};
    for (int i = 0; i < 4; i++) {
        path_begin(5.0, 4.0, i < 2 ? 0.0 : 0.5 * AISLE_PI);
        path_line(i < 2 ? ends[i][0] - 5.0 : ends[i][1] - 4.0);
        path_end();
        TEST_ASSERT_EQUAL((int)ends[i][2], verified());
        TEST_ASSERT_EQUAL_INT32(i % 2 == 0 ? 0 : AISLE_LAYOUT_ID_BOUNDS, verify.fault_id);
    }
}

static void test_a_diagonal_past_cells_looks_at_what_it_can_reach_only(void) {
    vehicle_disc(0.2);
    world_begin(0.0, 0.0, 8.0, 8.0, 0.0F);
    world_scan(64, 64);
    for (uint32_t i = 8; i < 56; i++) { // both sides of the diagonal, 4 cells off: corner 3 / sqrt(2) cells away
        world_cells(i + 4, i, 1, 1);
        world_cells(i, i + 4, 1, 1);
    }
    world_build();
    path_begin(1.5, 1.5, 0.25 * AISLE_PI);
    path_line(5.0 * 1.4142135);
    path_end();
    double gap = 3.0 / sqrt(2.0) / 8.0 - 0.2;
    TEST_ASSERT_EQUAL(AISLE_VERIFY_NONE, fault_with_margin(gap - 1e-4));
    (void)fault_with_margin(gap + 1e-4);
    assert_collision(AISLE_LAYOUT_ID_SCAN, 1);
}

static void test_a_place_to_stand_is_proved_too(void) {
    vehicle_box(0.5, 0.5, 0.7, 0.0);
    world_begin(-5.0, -5.0, 5.0, 5.0, 0.25F);
    int32_t id = world_box(AISLE_POLYGON_OBSTACLE, 0.6, -1.0, 0.7, 1.0);
    world_build();
    path_begin(0.0, 0.0, 0.0);
    path_end();
    TEST_ASSERT_EQUAL(AISLE_VERIFY_NONE, fault_with_margin(0.0999));
    (void)fault_with_margin(0.1001);
    assert_collision(id, 0);
}

static void test_the_last_pose_of_the_last_piece_counts(void) {
    vehicle_disc(0.2);
    world_begin(-5.0, -5.0, 5.0, 5.0, 0.25F);
    int32_t id = world_box(AISLE_POLYGON_OBSTACLE, 3.3, -1.0, 3.4, 1.0);
    world_build();
    path_begin(0.0, 0.0, 0.0);
    path_line(1.0);
    path_line(1.0);
    path_line(1.0);
    path_end();
    TEST_ASSERT_EQUAL(AISLE_VERIFY_NONE, fault_with_margin(0.0999));
    (void)fault_with_margin(0.1001);
    assert_collision(id, 3);
}

// ---- creep

static void narrow_way(void) { // 0.3 m free on both sides of a disc from x = 0 to 2
    world_begin(-6.0, -3.0, 6.0, 3.0, 0.25F);
    (void)world_box(AISLE_POLYGON_OBSTACLE, 0.0, 0.6, 2.0, 0.7);
    (void)world_box(AISLE_POLYGON_OBSTACLE, 0.0, -0.7, 2.0, -0.6);
    world_build();
    vehicle_disc(0.3);
}

static void test_fast_past_narrow_places_is_a_creep_fault_and_slow_is_not(void) {
    narrow_way();
    path_begin(-4.0, 0.0, 0.0);
    for (int i = 0; i < 16; i++) {
        path_line(0.5);
    }
    path_end();
    path_drive(0.3);
    TEST_ASSERT_EQUAL(AISLE_VERIFY_NONE, verified());
    path_drive(0.302);
    TEST_ASSERT_EQUAL(AISLE_VERIFY_CREEP, verified());
    TEST_ASSERT_EQUAL_INT32(101, verify.fault_id < 102 ? 101 : verify.fault_id - 1);
    TEST_ASSERT_DOUBLE_WITHIN(0.05, -sqrt(0.7995 * 0.7995 - 0.36), verify.fault_at.x);
    vehicle.creep_clearance = 0.299;
    TEST_ASSERT_EQUAL(AISLE_VERIFY_NONE, verified());
}

static void test_too_close_at_any_speed_is_a_collision_even_when_fast(void) {
    narrow_way();
    path_begin(0.5, 0.0, 0.0);
    path_line(0.5);
    path_line(0.5);
    path_end();
    path_drive(0.5);
    TEST_ASSERT_EQUAL(AISLE_VERIFY_CREEP, verified());
    vehicle.margin = 0.35;
    TEST_ASSERT_EQUAL(AISLE_VERIFY_COLLISION, verified());
}

// Past a post at x = 0 the first piece or the second is fast at its far end alone, where the post is far away.
static void test_a_piece_counts_with_the_faster_of_its_ends(void) {
    for (int fast = 1; fast <= 2; fast++) {
        world_begin(-6.0, -3.0, 6.0, 3.0, 0.25F);
        int32_t id = world_box(AISLE_POLYGON_OBSTACLE, -0.01, 0.6, 0.01, 0.62);
        world_build();
        vehicle_disc(0.3);
        path_begin(-2.0, 0.0, 0.0);
        path_line(1.0);
        path_line(1.0);
        path_line(1.0);
        path_line(1.0);
        path_end();
        path.waypoints[1].v = fast == 1 ? 0.5F : 0.3F;
        path.waypoints[2].v = 0.3F;
        path.waypoints[3].v = fast == 2 ? 0.5F : 0.3F;
        path_retime(0.3);
        path_seal();
        TEST_ASSERT_EQUAL(AISLE_VERIFY_CREEP, verified());
        TEST_ASSERT_EQUAL_UINT32(fast == 1 ? 2 : 3, verify.fault_waypoint);
        TEST_ASSERT_EQUAL_INT32(id, verify.fault_id);
    }
}

static void test_a_piece_from_rest_to_rest_counts_with_the_peak_its_time_gives(void) {
    narrow_way();
    path_begin(-1.0, 0.0, 0.0);
    path_line(4.0);
    path_end(); // trapezoid at creep speed
    TEST_ASSERT_EQUAL(AISLE_VERIFY_NONE, verified());
    path_retime(0.32);
    path_seal();
    TEST_ASSERT_EQUAL(AISLE_VERIFY_CREEP, verified());
}

static void test_waiting_at_a_goal_does_not_slow_the_piece_behind_it(void) {
    static aisle_goal_msg goals[2];
    narrow_way();
    path_begin(-1.0, 0.0, 0.0);
    path_line(0.1);
    aisle_waypoint_msg *w = &path.waypoints[1];
    w->flags |= AISLE_WAYPOINT_GOAL | AISLE_WAYPOINT_STOP;
    w->goal_id = 5;
    path_line(4.0);
    path_end();
    goals[0] = (aisle_goal_msg){.id = 5, .x = w->x, .y = w->y, .theta = w->theta, .dwell = 3.0F};
    goals[1] = path_goal;
    for (int i = 2; i < path.num_waypoints; i++) {
        path.waypoints[i].t += 3.0F;
    }
    path.duration += 3.0F;
    path_seal();
    aisle_verify_request request = usual_request();
    request.goals = goals;
    request.num_goals = 2;
    TEST_ASSERT_EQUAL(AISLE_OK, verify_request(&request, UINT32_MAX));
    path.waypoints[2].t -= 1.5F; // 0.33 m/s, hidden by the wait
    path.duration -= 1.5F;
    path_seal();
    request.size = path_size;
    TEST_ASSERT_EQUAL(AISLE_ERR_DATA, verify_request(&request, UINT32_MAX));
    TEST_ASSERT_EQUAL(AISLE_VERIFY_CREEP, verify.fault);
}

// ---- work

static void test_a_free_straight_metre_takes_one_interval_and_bends_few(void) {
    vehicle_disc(0.3);
    world_begin(-50.0, -50.0, 50.0, 50.0, 1.0F);
    world_build();
    path_begin(0.0, 0.0, 0.0);
    path_line(1.0);
    path_arc(1.0, 1.0);
    path_end();
    TEST_ASSERT_EQUAL(AISLE_VERIFY_NONE, verified());
    TEST_ASSERT_LESS_OR_EQUAL_UINT32(4, verify.intervals);
    TEST_ASSERT_EQUAL_UINT32(1U + 3U + verify.intervals, spent);
}

void setUp(void) {}
void tearDown(void) {}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_an_obstacle_at_the_middle_of_an_arc_alone_is_found);
    RUN_TEST(test_the_same_arc_to_the_right_bulges_to_the_left);
    RUN_TEST(test_a_wall_of_1_mm_across_a_long_straight_piece_is_found_and_placed);
    RUN_TEST(test_a_corner_clipped_during_a_turn_alone_is_found);
    RUN_TEST(test_a_long_footprint_sweeps_with_its_far_end);
    RUN_TEST(test_half_a_turn_is_proved_both_ways_round);
    RUN_TEST(test_a_keepout_stops_and_zones_do_not_bar_a_slow_way_along_them);
    RUN_TEST(test_the_margin_is_kept_to_each_of_the_four_bounds);
    RUN_TEST(test_a_single_occupied_cell_stops);
    RUN_TEST(test_a_straight_path_may_be_as_close_as_2_micrometres_above_the_margin);
    RUN_TEST(test_what_lies_off_the_scan_is_out_of_bounds);
    RUN_TEST(test_a_diagonal_past_cells_looks_at_what_it_can_reach_only);
    RUN_TEST(test_a_place_to_stand_is_proved_too);
    RUN_TEST(test_the_last_pose_of_the_last_piece_counts);
    RUN_TEST(test_fast_past_narrow_places_is_a_creep_fault_and_slow_is_not);
    RUN_TEST(test_too_close_at_any_speed_is_a_collision_even_when_fast);
    RUN_TEST(test_a_piece_counts_with_the_faster_of_its_ends);
    RUN_TEST(test_a_piece_from_rest_to_rest_counts_with_the_peak_its_time_gives);
    RUN_TEST(test_waiting_at_a_goal_does_not_slow_the_piece_behind_it);
    RUN_TEST(test_a_free_straight_metre_takes_one_interval_and_bends_few);
    RUN_TEST(test_straight_paths_among_polygons_are_judged_to_the_sampling);
    RUN_TEST(test_arcs_among_polygons_are_judged_to_a_millimetre);
    RUN_TEST(test_turns_among_polygons_are_judged_to_a_millimetre);
    RUN_TEST(test_straight_paths_on_a_scan_are_judged_to_the_sampling);
    RUN_TEST(test_mixed_paths_on_a_scan_are_judged_to_a_millimetre);
    RUN_TEST(test_mixed_paths_on_a_scan_with_polygons_are_judged_to_a_millimetre);
    return UNITY_END();
}
