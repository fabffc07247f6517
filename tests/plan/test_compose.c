#include "plan/compose.h"

#include "door.h"

enum { POINTS = 2048 };

static aisle_space space;
static aisle_objective objective;
static aisle_options_msg options;
static aisle_compose compose;
static aisle_path_msg path;
static aisle_vec2 points[POINTS];
static uint32_t point_count;
static aisle_leg legs[AISLE_GOAL_LIST_MAX_GOALS];
static aisle_goal_msg start, goals[AISLE_GOAL_LIST_MAX_GOALS];
static uint32_t leg_count;
static uint32_t spent;
static bool stops;

static void open_hall(void) {
    aisle_arena arena = hall_arena(24U << 20);
    memset(&space, 0, sizeof space);
    memset(&compose, 0, sizeof compose);
    aisle_space_carve(&space, &arena, hall_limits.cells);
    aisle_compose_carve(&compose, &arena);
    hall_open(&arena, 0.05F);
    aisle_space_begin(&space, &hall_layout, &hall_vehicle, AISLE_SPACE_FREE_TURN);
}

void setUp(void) {
    hall_rectangle(1.0, 0.7, 0.1F);
    hall_begin(20.0, 16.0);
    hall_add(7.0, 5.0, 9.0, 7.0);
    open_hall();
    options = (aisle_options_msg){.objective = AISLE_OPTIONS_SAFEST};
    point_count = leg_count = 0;
    stops = false;
    memset(legs, 0, sizeof legs);
    start = (aisle_goal_msg){.tolerance_theta = 4.0F};
}
void tearDown(void) {}

// One more leg along these points, the first being where the last leg ended; its goal takes any heading.
static void leg(const aisle_vec2 *p, uint32_t n) {
    legs[leg_count] = (aisle_leg){.first = point_count, .count = n, .seed_value = -1.0, .swarm_value = -1.0};
    memcpy(points + point_count, p, n * sizeof *p);
    if (leg_count == 0) {
        start.x = p[0].x;
        start.y = p[0].y;
    }
    goals[leg_count] =
        (aisle_goal_msg){.id = 30 + (int32_t)leg_count, .x = p[n - 1U].x, .y = p[n - 1U].y, .tolerance_theta = 4.0F};
    point_count += n;
    leg_count += 1;
}

// Lets the first leg's way go by its points as the swarm's.
static void by_swarm(void) {
    memcpy(legs[0].via, points + legs[0].first, legs[0].count * sizeof points[0]);
    legs[0].via_count = legs[0].count;
    legs[0].use_swarm = true;
}

static aisle_status build(uint32_t slice) {
    TEST_ASSERT_TRUE(aisle_objective_of(&options, &hall_vehicle, &objective));
    aisle_compose_request request = {.space = &space,
                                     .objective = &objective,
                                     .options = &options,
                                     .points = points,
                                     .legs = legs,
                                     .leg_count = leg_count,
                                     .start = &start,
                                     .goals = goals,
                                     .stops = stops};
    memset(&path, 0, sizeof path);
    spent = 0;
    aisle_status st = aisle_compose_start(&compose, &request, &path);
    if (st != AISLE_OK) {
        return st;
    }
    do {
        st = aisle_compose_step(&compose, slice, &spent);
    } while (st == AISLE_BUSY);
    return st;
}

static void build_well(void) {
    TEST_ASSERT_EQUAL(AISLE_OK, build(100));
    door_judge(&path);
}

static int count_flags(int16_t flag) {
    int n = 0;
    for (int16_t i = 0; i < path.num_waypoints; i++) {
        n += (path.waypoints[i].flags & flag) != 0;
    }
    return n;
}

static int arcs(double *most) {
    int n = 0;
    *most = 0.0;
    for (int16_t i = 1; i < path.num_waypoints; i++) {
        double k = fabs((double)path.waypoints[i].curvature);
        n += k > 0.0;
        *most = fmax(*most, k);
    }
    return n;
}

static const aisle_vec2 round_the_box[] = {{2.0, 2.0}, {2.0, 10.0}, {12.0, 10.0}, {13.0, 3.0}, {18.0, 3.0}};

// ---- tests

static void test_corners_of_a_seed_become_arcs_that_keep_the_margin(void) {
    double most;
    leg(round_the_box, 5);
    build_well();
    TEST_ASSERT_TRUE(arcs(&most) >= 3);
    TEST_ASSERT_TRUE(most <= 1.0 + 1e-6); // a metre wide where there is room
    TEST_ASSERT_EQUAL_INT(0, count_flags(AISLE_WAYPOINT_TURN_IN_PLACE));
    TEST_ASSERT_EQUAL_INT(1, count_flags(AISLE_WAYPOINT_GOAL));
    TEST_ASSERT_EQUAL_INT32(30, path.waypoints[path.num_waypoints - 1].goal_id);
    TEST_ASSERT_TRUE(path.length > 28.0F && path.length < 30.0F);
}

static bool path_obeys(void) {
    for (int16_t i = 1; i < path.num_waypoints; i++) {
        const door_piece piece = door_piece_of(&path.waypoints[i - 1], &path.waypoints[i]);
        for (int k = 0; k < 200; k++) {
            const aisle_pose2 a = door_piece_at(&piece, k / 200.0), b = door_piece_at(&piece, (k + 1) / 200.0);
            if (piece.length > 0.0 && !hall_step_obeys(a.x, a.y, b.x, b.y)) {
                return false;
            }
        }
    }
    return true;
}

// Inside the corner, off both legs.
static void test_arcs_shrink_where_wide_ones_would_be_against_a_zone(void) {
    const aisle_vec2 bend[] = {{2.0, 2.0}, {2.0, 10.0}, {12.0, 10.0}};
    for (int against = 0; against < 2; against++) {
        double most;
        setUp();
        hall_one_way(against != 0 ? -2.0 : 0.8, 2.05, 8.0, 4.0, 9.95);
        open_hall();
        leg(bend, 3);
        build_well();
        TEST_ASSERT_TRUE(path_obeys());
        TEST_ASSERT_EQUAL_INT(1, arcs(&most) > 0);
        TEST_ASSERT_TRUE(against != 0 ? most > 1.0 / 0.2 && most < 1.0 / 0.05 : most <= 1.0 + 1e-6);
    }
}

static void test_arcs_shrink_where_wide_ones_do_not_fit(void) {
    aisle_vec2 tight[] = {{6.5, 2.0}, {6.5, 7.5}, {12.0, 7.5}}; // a metre wide they would graze the box's corner
    double most;
    leg(tight, 3);
    build_well();
    TEST_ASSERT_TRUE(arcs(&most) >= 1);
    TEST_ASSERT_TRUE(most > 1.2 && most < 1.0 / 0.05);
    TEST_ASSERT_EQUAL_INT(0, count_flags(AISLE_WAYPOINT_TURN_IN_PLACE));
}

static void test_stops_turn_on_the_spot_in_every_corner(void) {
    double most;
    leg(round_the_box, 5);
    stops = true;
    build_well();
    TEST_ASSERT_EQUAL_INT(0, arcs(&most));
    TEST_ASSERT_EQUAL_INT(3, count_flags(AISLE_WAYPOINT_TURN_IN_PLACE));
}

static void test_a_negative_zone_means_stops_and_a_positive_one_where_arcs_may_begin(void) {
    double most;
    leg(round_the_box, 5);
    options.zone = -1.0F;
    build_well();
    TEST_ASSERT_EQUAL_INT(0, arcs(&most));
    options.zone = 0.25F;
    build_well();
    TEST_ASSERT_TRUE(arcs(&most) >= 3);
    for (int16_t i = 1; i < path.num_waypoints; i++) {
        const aisle_waypoint_msg *w = &path.waypoints[i];
        if (fabs((double)w->curvature) > 0.0) {
            double away = 1e9;
            for (int k = 1; k < 4; k++) {
                away = fmin(away, hypot(w->x - round_the_box[k].x, w->y - round_the_box[k].y));
            }
            TEST_ASSERT_TRUE(away <= 0.25 + 1e-6);
        }
    }
}

static void test_arcs_are_no_sharper_than_the_vehicle_drives(void) {
    double most;
    hall_vehicle.curvature_max = 0.7;
    leg(round_the_box, 5);
    TEST_ASSERT_EQUAL(AISLE_OK, build(100));
    TEST_ASSERT_TRUE(arcs(&most) >= 3);
    TEST_ASSERT_TRUE(most <= 0.7 + 1e-6);
    TEST_ASSERT_EQUAL_INT(0, count_flags(AISLE_WAYPOINT_TURN_IN_PLACE));
}

static void test_fixed_headings_are_turned_to_on_the_spot(void) {
    aisle_vec2 line[] = {{2.0, 2.0}, {10.0, 2.0}};
    leg(line, 2);
    start.tolerance_theta = 0.0F;
    start.theta = 1.2;
    goals[0].tolerance_theta = 0.0F;
    goals[0].theta = -2.0;
    build_well();
    TEST_ASSERT_EQUAL_INT(2, count_flags(AISLE_WAYPOINT_TURN_IN_PLACE));
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 1.2, path.waypoints[0].theta);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, -2.0, path.waypoints[path.num_waypoints - 1].theta);
    goals[0].theta = 0.02; // within half the tolerance: no turn
    build_well();
    TEST_ASSERT_EQUAL_INT(1, count_flags(AISLE_WAYPOINT_TURN_IN_PLACE));
    goals[0].tolerance_theta = 0.01F;
    build_well();
    TEST_ASSERT_EQUAL_INT(2, count_flags(AISLE_WAYPOINT_TURN_IN_PLACE));
}

static void test_goals_are_flagged_in_order_with_a_stop_and_their_dwell(void) {
    aisle_vec2 a[] = {{2.0, 2.0}, {5.0, 2.0}};
    aisle_vec2 b[] = {{5.0, 2.0}};
    aisle_vec2 c[] = {{5.0, 2.0}, {10.0, 2.0}};
    leg(a, 2);
    leg(b, 1);
    leg(c, 2);
    build_well();
    float plain = path.duration;
    int32_t next = 30;
    for (int16_t i = 0; i < path.num_waypoints; i++) {
        const aisle_waypoint_msg *w = &path.waypoints[i];
        if ((w->flags & AISLE_WAYPOINT_GOAL) != 0) {
            TEST_ASSERT_EQUAL_INT32(next++, w->goal_id);
            TEST_ASSERT_TRUE((w->flags & AISLE_WAYPOINT_STOP) != 0 && fabs((double)w->v) < 1e-9);
        }
    }
    TEST_ASSERT_EQUAL_INT32(33, next);
    goals[0].dwell = 3.0F;
    goals[1].dwell = 4.0F;
    goals[2].dwell = 5.0F; // nothing comes after it
    build_well();
    TEST_ASSERT_FLOAT_WITHIN(0.01F, plain + 7.0F, path.duration);
}

static void test_pieces_are_no_longer_than_stated(void) {
    aisle_vec2 line[] = {{1.0, 3.9}, {19.0, 3.9}}; // past the box at 0.65 m, below the creep clearance
    leg(line, 2);
    build_well();
    int slow = 0;
    for (int16_t i = 1; i < path.num_waypoints; i++) {
        const aisle_waypoint_msg *w = &path.waypoints[i];
        double length = hypot(w->x - (w - 1)->x, w->y - (w - 1)->y);
        bool creeps = (double)w->clearance < hall_vehicle.creep_clearance;
        TEST_ASSERT_TRUE(length <= (creeps ? 0.5 : 1.0) * AISLE_COMPOSE_JOIN + 1e-9);
        slow += creeps;
    }
    TEST_ASSERT_TRUE(slow >= 2);
    TEST_ASSERT_TRUE(path.num_waypoints >= 10 && path.num_waypoints < 20); // joined where nothing changes
}

// Least gap of the body over the piece that ends at w, sampled.
static double sampled_gap(const aisle_waypoint_msg *w) {
    door_piece piece = door_piece_of(w - 1, w);
    return door_piece_gap(&piece);
}

static void test_pieces_are_slow_just_where_the_body_is_too_near_for_every_objective(void) {
    int slow = 0, fast = 0;
    for (int8_t objective_kind = AISLE_OPTIONS_SAFEST; objective_kind <= AISLE_OPTIONS_LEAST_ENERGY; objective_kind++) {
        for (int k = 0; k < 12; k++) {
            point_count = leg_count = 0;
            aisle_vec2 line[] = {{1.0, 3.6 + 0.05 * k}, {12.0, 4.5 - 0.05 * k}, {13.0, 12.0}, {6.0, 8.1 + 0.05 * k}};
            leg(line, 4);
            options.objective = objective_kind;
            build_well();
            for (int16_t i = 1; i < path.num_waypoints; i++) {
                const aisle_waypoint_msg *w = &path.waypoints[i];
                bool creeps = (double)w->clearance < hall_vehicle.creep_clearance;
                double gap = sampled_gap(w);
                while (i + 1 < path.num_waypoints && !(w[1].clearance != w->clearance)) { // cut for its speeds' sake
                    gap = fmin(gap, sampled_gap(++w));
                    i++;
                }
                TEST_ASSERT_TRUE(creeps ? gap < hall_vehicle.creep_clearance + 7e-3
                                        : gap >= hall_vehicle.creep_clearance - 1e-6);
                slow += creeps;
                fast += !creeps;
            }
        }
    }
    TEST_ASSERT_GREATER_THAN_INT(60, slow);
    TEST_ASSERT_GREATER_THAN_INT(60, fast);
}

static void test_a_disc_rounds_a_corner_as_wide_as_its_legs_are_free(void) {
    double most;
    hall_disc(0.3, 0.05F);
    open_hall();
    double keep = hall_vehicle.outer_radius + hall_vehicle.margin, off = keep + AISLE_SPACE_SLACK;
    aisle_vec2 around[] = {{11.0, 5.0 - off}, {7.0 - off, 5.0 - off}, {7.0 - off, 10.0}};
    leg(around, 3);
    build_well();
    TEST_ASSERT_EQUAL_INT(0, count_flags(AISLE_WAYPOINT_TURN_IN_PLACE));
    TEST_ASSERT_TRUE(arcs(&most) >= 1);
    TEST_ASSERT_DOUBLE_WITHIN(1e-4, 1.0 / keep, most);
    by_swarm(); // whose legs are not known to be free: the arc is tried
    options.interpolation = AISLE_OPTIONS_LINEAR;
    build_well();
    TEST_ASSERT_TRUE(arcs(&most) >= 1 && most >= 1.0 / keep - 1e-4);
}

static void test_a_spline_passes_its_vias_smoothly_and_free(void) {
    aisle_vec2 bow[] = {{2.0, 3.0}, {5.0, 8.5}, {9.0, 9.5}, {14.0, 4.0}, {18.0, 4.0}};
    leg(bow, 5);
    by_swarm();
    build_well();
    TEST_ASSERT_TRUE(legs[0].swarm_value > 0.0 && legs[0].seed_value < 0.0);
    TEST_ASSERT_EQUAL_INT(0, count_flags(AISLE_WAYPOINT_TURN_IN_PLACE));
    for (int k = 1; k < 4; k++) {
        double away = 1e9;
        for (int16_t i = 1; i < path.num_waypoints; i++) {
            door_piece piece = door_piece_of(&path.waypoints[i - 1], &path.waypoints[i]);
            for (int s = 0; s <= 20; s++) {
                aisle_pose2 pose = door_piece_at(&piece, s / 20.0);
                away = fmin(away, hypot(pose.x - bow[k].x, pose.y - bow[k].y));
            }
        }
        TEST_ASSERT_TRUE(away < 0.05); // sampled, and pieced together by arcs
    }
}

static void test_the_swarms_polyline_is_driven_where_lines_are_wished(void) {
    aisle_vec2 bow[] = {{2.0, 3.0}, {5.0, 8.5}, {9.0, 9.5}, {14.0, 4.0}, {18.0, 4.0}};
    double most;
    leg(bow, 5);
    by_swarm();
    options.interpolation = AISLE_OPTIONS_LINEAR;
    build_well();
    TEST_ASSERT_TRUE(arcs(&most) >= 3);
    TEST_ASSERT_TRUE(fabs(path.waypoints[0].theta - atan2(5.5, 3.0)) < 1e-9);
}

static void test_values_are_the_objectives_integral(void) {
    aisle_vec2 line[] = {{1.0, 3.9}, {19.0, 3.9}};
    leg(line, 2);
    options.objective = AISLE_OPTIONS_SHORTEST;
    build_well();
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, 18.0, legs[0].seed_value);
    options.objective = AISLE_OPTIONS_SAFEST;
    build_well();
    double truth = 0.0;
    for (int i = 0; i < 18000; i++) {
        aisle_pose2 pose = {1.0 + (i + 0.5) * 1e-3, 3.9, 0.0};
        truth += 1e-3 * aisle_objective_density(&objective, hall_body_gap(pose), 0.0);
    }
    TEST_ASSERT_TRUE(legs[0].seed_value >= truth - 1e-6); // each piece at its least clearance
    TEST_ASSERT_TRUE(legs[0].seed_value < truth + 0.1 * truth);
    TEST_ASSERT_TRUE(legs[0].swarm_value < 0.0);
}

static void test_any_slicing_gives_the_same_path_for_the_same_units(void) {
    static aisle_path_msg whole;
    static const uint32_t slices[] = {1, 7, 1000};
    leg(round_the_box, 5);
    TEST_ASSERT_EQUAL(AISLE_OK, build(UINT32_MAX));
    whole = path;
    uint32_t units = spent;
    TEST_ASSERT_TRUE(units > (uint32_t)path.num_waypoints);
    for (int i = 0; i < 3; i++) {
        TEST_ASSERT_EQUAL(AISLE_OK, build(slices[i]));
        TEST_ASSERT_EQUAL_UINT32(units, spent);
        TEST_ASSERT_EQUAL_MEMORY(&whole, &path, sizeof path);
    }
}

static void test_long_paths_are_cut_coarser_and_too_many_corners_are_told(void) {
    aisle_vec2 zigzag[251];
    for (int i = 0; i < 251; i++) {
        zigzag[i] = aisle_vec2_of(1.0 + 0.07 * i, i % 2 == 0 ? 10.0 : 14.0);
    }
    leg(zigzag, 251); // 1000 m
    stops = true;
    build_well();
    TEST_ASSERT_TRUE(path.num_waypoints > 500 && path.num_waypoints <= 1024);
    for (int k = 0; k < 6; k++) {
        aisle_vec2 back = points[point_count - 1U];
        for (int i = 0; i < 251; i++) {
            zigzag[i].y = i == 0 ? back.y : (i % 2 == 0 ? 10.0 : 14.0);
            zigzag[i].x = i == 0 ? back.x : 1.0 + 0.07 * (k % 2 == 0 ? 250 - i : i);
        }
        leg(zigzag, 251);
    }
    TEST_ASSERT_EQUAL(AISLE_ERR_CAPACITY, build(1000));
}

static void test_a_free_heading_is_one_of_pi_or_more(void) {
    aisle_goal_msg goal = {.tolerance_theta = 3.1415927F};
    TEST_ASSERT_TRUE(aisle_goal_heading_is_free(&goal));
    goal.tolerance_theta = 3.14F;
    TEST_ASSERT_FALSE(aisle_goal_heading_is_free(&goal));
    goal.tolerance_theta = 0.0F;
    TEST_ASSERT_FALSE(aisle_goal_heading_is_free(&goal));
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_corners_of_a_seed_become_arcs_that_keep_the_margin);
    RUN_TEST(test_arcs_shrink_where_wide_ones_would_be_against_a_zone);
    RUN_TEST(test_arcs_shrink_where_wide_ones_do_not_fit);
    RUN_TEST(test_stops_turn_on_the_spot_in_every_corner);
    RUN_TEST(test_a_negative_zone_means_stops_and_a_positive_one_where_arcs_may_begin);
    RUN_TEST(test_arcs_are_no_sharper_than_the_vehicle_drives);
    RUN_TEST(test_fixed_headings_are_turned_to_on_the_spot);
    RUN_TEST(test_goals_are_flagged_in_order_with_a_stop_and_their_dwell);
    RUN_TEST(test_pieces_are_no_longer_than_stated);
    RUN_TEST(test_pieces_are_slow_just_where_the_body_is_too_near_for_every_objective);
    RUN_TEST(test_a_disc_rounds_a_corner_as_wide_as_its_legs_are_free);
    RUN_TEST(test_a_spline_passes_its_vias_smoothly_and_free);
    RUN_TEST(test_the_swarms_polyline_is_driven_where_lines_are_wished);
    RUN_TEST(test_values_are_the_objectives_integral);
    RUN_TEST(test_any_slicing_gives_the_same_path_for_the_same_units);
    RUN_TEST(test_long_paths_are_cut_coarser_and_too_many_corners_are_told);
    RUN_TEST(test_a_free_heading_is_one_of_pi_or_more);
    return UNITY_END();
}
