// What nobody in his right mind would send, through the public door: every answer is a path that is judged clear of
// every polygon, or a cause; and what came before it still stands.
#include "cases.h"
#include "door.h"

enum { POLYGONS = 16 };

static aisle_layout_msg layout;
static double radius; // of the disc under test
static aisle_query_msg query;

// ---- a world of any polygons, and a judge for discs in it

static void world(double width, double height) {
    static int32_t revision;
    memset(&layout, 0, sizeof layout);
    layout =
        (aisle_layout_msg){.map_id = 1, .map_revision = ++revision, .num_parts = 1, .x_max = width, .y_max = height};
    hall_begin(width, height); // of the hall's judge the walls alone
}

// v: n pairs of x and y.
static aisle_polygon_msg *polygon(int n, const double *v) {
    TEST_ASSERT_LESS_THAN(POLYGONS, layout.num_polygons);
    aisle_polygon_msg *p = &layout.polygons[layout.num_polygons++];
    p->id = layout.num_polygons;
    p->num_vertices = (int16_t)n;
    memcpy(p->vertices, v, 2U * (size_t)n * sizeof *v);
    return p;
}

static void box(double x0, double y0, double x1, double y1) {
    const double v[4][2] = {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}};
    (void)polygon(4, v[0]);
}

static aisle_status send_world(void) {
    layout.total_polygons = layout.num_polygons;
    layout.crc32 = (int32_t)aisle_layout_crc32(0, &layout);
    aisle_status st = door_submit(AISLE_INPUT_LAYOUT, &layout);
    door_settle();
    return st;
}

static void open_world(void) {
    TEST_ASSERT_EQUAL(AISLE_OK, send_world());
}

static long double point_gap(long double x, long double y, const aisle_polygon_msg *p) {
    long double least = 1e9L;
    bool inside = true;
    for (int i = 0; i < p->num_vertices; i++) {
        const double *a = p->vertices[i], *b = p->vertices[(i + 1) % p->num_vertices];
        long double ex = (long double)b[0] - (long double)a[0], ey = (long double)b[1] - (long double)a[1];
        long double dx = x - (long double)a[0], dy = y - (long double)a[1];
        long double square = ex * ex + ey * ey;
        long double t = square > 0.0L ? (dx * ex + dy * ey) / square : 0.0L;
        t = fminl(fmaxl(t, 0.0L), 1.0L);
        least = fminl(least, hypotl(dx - t * ex, dy - t * ey));
        inside = inside && ex * dy - ey * dx >= 0.0L;
    }
    return inside ? 0.0L : least;
}

static double disc_gap(aisle_pose2 pose) {
    long double gap = 1e9L;
    for (int i = 0; i < layout.num_polygons; i++) {
        gap = fminl(gap, point_gap((long double)pose.x, (long double)pose.y, &layout.polygons[i]));
    }
    return (double)(gap - (long double)radius);
}

static void judge_clear(const aisle_path_msg *path) {
    (void)door_judge(path);
    for (int16_t i = 1; i < path->num_waypoints; i++) {
        door_piece piece = door_piece_of(&path->waypoints[i - 1], &path->waypoints[i]);
        int steps = 1 + (int)(piece.length / 0.005);
        for (int k = 0; k <= steps; k++) {
            TEST_ASSERT_TRUE(disc_gap(door_piece_at(&piece, (double)k / steps)) >= hall_vehicle.margin - 1e-6);
        }
    }
}

static void judge_goals(const aisle_path_msg *path) {
    int16_t reached = 0;
    for (int16_t i = 0; i < path->num_waypoints; i++) {
        const aisle_waypoint_msg *w = &path->waypoints[i];
        if ((w->flags & AISLE_WAYPOINT_GOAL) != 0) {
            TEST_ASSERT_LESS_THAN(query.num_goals, reached);
            const aisle_goal_msg *goal = &query.goals[reached++];
            double tolerance = goal->tolerance_xy > 0.0F ? (double)goal->tolerance_xy : 0.05;
            TEST_ASSERT_EQUAL_INT32(goal->id, w->goal_id);
            TEST_ASSERT_TRUE(hypot(w->x - goal->x, w->y - goal->y) <= tolerance + 1e-9);
            if (goal->tolerance_theta < 3.1F) {
                double within = goal->tolerance_theta > 0.0F ? (double)goal->tolerance_theta : 0.05;
                TEST_ASSERT_TRUE(fabs(remainder(w->theta - goal->theta, 2.0 * DOOR_PI)) <= within + 1e-9);
            }
        }
    }
    TEST_ASSERT_EQUAL_INT16(query.num_goals, reached);
}

// ---- queries

static void ask_for_path(double x0, double y0, double x1, double y1) {
    query = door_query(5, x0, y0, x1, y1);
    query.options.objective = AISLE_OPTIONS_SHORTEST;
}

static void expect_path(void) {
    const aisle_path_msg *path = door_ask(&query);
    TEST_ASSERT_EQUAL_INT16(0, path->cause);
    judge_clear(path);
    judge_goals(path);
}

static void expect_cause(int16_t cause, int32_t id) {
    const aisle_path_msg *path = door_ask(&query);
    TEST_ASSERT_EQUAL(AISLE_PATH_NONE, path->status);
    TEST_ASSERT_EQUAL_INT16(cause, path->cause);
    TEST_ASSERT_EQUAL_INT32(id, path->cause_id);
    TEST_ASSERT_TRUE(path->num_waypoints <= 8); // as path_t says
}

// An answer of either kind; a path must be right.
static void expect_sense(void) {
    const aisle_path_msg *path = door_ask(&query);
    if (path->status == AISLE_PATH_OK) {
        judge_clear(path);
        judge_goals(path);
    } else {
        TEST_ASSERT_EQUAL(AISLE_PATH_NONE, path->status);
        TEST_ASSERT_NOT_EQUAL(0, path->cause);
        TEST_ASSERT_NOT_EQUAL(AISLE_STATUS_INTERNAL, path->cause);
        TEST_ASSERT_NOT_EQUAL(AISLE_STATUS_VERIFY_FAILED, path->cause);
    }
}

static void drive_disc(double r, float margin) {
    aisle_vehicle_msg msg = {.vehicle_revision = 1, .footprint_radius = (float)r, .margin = margin};
    hall_disc(r, margin);
    radius = (double)msg.footprint_radius;
    door_config = (aisle_config){.limits = {.requests = 2U}, .has_vehicle = true, .vehicle = msg};
    door_open(0);
}

void setUp(void) {
    drive_disc(0.3, 0.05F);
    world(12.0, 8.0);
}
void tearDown(void) {}

static aisle_status_msg status_now(void) {
    aisle_status_msg status;
    aisle_planner_status(door, door_now, &status);
    return status;
}

// ---- polygons

static void test_polygons_that_are_none_are_refused_by_name_and_change_nothing(void) {
    const double nan = (double)NAN, huge = 2e5;
    const struct {
        int n;
        double v[5][2];
    } bad[] = {{2, {{1, 1}, {2, 2}}},
               {3, {{1, 1}, {2, 2}, {3, 3}}},                         // no area
               {4, {{1, 1}, {1, 1}, {1, 1}, {1, 1}}},                 // a point
               {4, {{1, 1}, {1, 2}, {2, 2}, {2, 1}}},                 // clockwise
               {4, {{1, 1}, {3, 1}, {2, 1.2}, {2, 3}}},               // a dent
               {4, {{1, 1}, {3, 3}, {3, 1}, {1, 3}}},                 // a bow tie
               {5, {{2, 1}, {2.6, 3}, {1, 1.8}, {3, 1.8}, {1.4, 3}}}, // a star, wound twice
               {3, {{1, 1}, {1 + 1e-5, 1}, {1, 1 + 1e-5}}},           // below what has an area
               {3, {{1, 1}, {nan, 1}, {2, 2}}},
               {3, {{1, 1}, {huge, 1}, {2, 2}}}};
    box(5.0, 3.0, 7.0, 5.0);
    open_world();
    const aisle_layout_msg good = layout;
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        world(12.0, 8.0);
        polygon(bad[i].n, bad[i].v[0])->id = 40;
        TEST_ASSERT_EQUAL(AISLE_ERR_DATA, send_world());
        TEST_ASSERT_EQUAL_INT16(AISLE_STATUS_MALFORMED, status_now().cause);
        TEST_ASSERT_EQUAL_INT32(40, status_now().cause_id);
        layout = good;
        ask_for_path(1.0, 4.0, 11.0, 4.0);
        expect_path();
    }
}

static void test_bounds_that_are_none_are_refused(void) {
    const double bad[][4] = {{0, 0, 0, 8},    {0, 0, 12, 0},           {5, 0, 4, 8},         {0, 0, 1e300, 8},
                             {0, 0, 2e5, 10}, {0, 0, (double)NAN, 10}, {0, 0, INFINITY, 10}, {1e9, 0, 1e9 + 10, 10}};
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        world(12.0, 8.0);
        layout.x_min = bad[i][0];
        layout.y_min = bad[i][1];
        layout.x_max = bad[i][2];
        layout.y_max = bad[i][3];
        TEST_ASSERT_EQUAL(AISLE_ERR_DATA, send_world());
        TEST_ASSERT_NOT_EQUAL(0, status_now().cause);
    }
    ask_for_path(1.0, 4.0, 11.0, 4.0);
    expect_cause(AISLE_STATUS_NO_LAYOUT, 0);
}

static void test_collinear_and_repeated_vertices_change_no_path(void) {
    const double v[12][2] = {{5, 3}, {5, 3}, {5.5, 3}, {6, 3},   {7, 3}, {7, 3},
                             {7, 4}, {7, 5}, {6.9, 5}, {6.1, 5}, {5, 5}, {5, 4}};
    box(5.0, 3.0, 7.0, 5.0);
    open_world();
    ask_for_path(1.0, 4.0, 11.0, 4.0);
    expect_path();
    float plain = door_reply.length;
    world(12.0, 8.0);
    (void)polygon(12, v[0]);
    open_world();
    expect_path();
    TEST_ASSERT_FLOAT_WITHIN(1e-4F, plain, door_reply.length);
}

static void test_duplicated_and_overlapping_polygons_are_as_good_as_their_union(void) {
    box(5.0, 3.0, 7.0, 5.0);
    open_world();
    ask_for_path(1.0, 4.0, 11.0, 4.0);
    expect_path();
    float plain = door_reply.length;
    world(12.0, 8.0);
    box(5.0, 3.0, 7.0, 5.0);
    box(5.0, 3.0, 7.0, 5.0);
    box(5.0, 3.0, 6.5, 5.0);
    box(5.5, 3.0, 7.0, 5.0);
    box(5.9, 3.9, 6.1, 4.1);
    open_world();
    expect_path();
    TEST_ASSERT_FLOAT_WITHIN(1e-4F, plain, door_reply.length);
}

static void test_polygons_that_touch_leave_no_way_between_them(void) {
    box(5.0, 0.0, 6.0, 4.0); // an edge in common
    box(5.0, 4.0, 6.0, 8.0);
    open_world();
    ask_for_path(1.0, 4.0, 11.0, 4.0);
    expect_cause(AISLE_STATUS_NO_PATH, 11);
    world(12.0, 8.0);
    box(4.0, 0.0, 5.0, 4.0); // a corner in common
    box(5.0, 4.0, 6.0, 8.0);
    open_world();
    const aisle_path_msg *path = door_ask(&query);
    TEST_ASSERT_EQUAL(AISLE_PATH_NONE, path->status);
    TEST_ASSERT_TRUE(path->cause == AISLE_STATUS_NO_PATH ||
                     (path->cause == AISLE_STATUS_TOO_NARROW && path->cause_value < 1e-3F));
}

static void test_polygons_across_and_beyond_the_bounds_count_as_far_as_they_reach(void) {
    box(-5.0, 3.0, 9.0, 5.0);
    box(20.0, 20.0, 30.0, 30.0);
    open_world();
    ask_for_path(1.0, 1.5, 1.0, 6.5);
    expect_path();
    TEST_ASSERT_TRUE(door_reply.length > 16.0F);
    world(12.0, 8.0);
    box(-5.0, -5.0, 50.0, 50.0); // everything
    open_world();
    expect_cause(AISLE_STATUS_START_OCCUPIED, 1);
}

static void test_slivers_of_a_tenth_of_a_millimetre_are_walls(void) {
    box(5.0, 0.0, 5.0001, 7.0);
    const double needle[3][2] = {{8.0, 8.0}, {8.00005, 1.0}, {8.0001, 8.0}};
    (void)polygon(3, needle[0]);
    open_world();
    ask_for_path(1.0, 4.0, 11.0, 4.0);
    expect_path();
    TEST_ASSERT_TRUE(door_reply.length > 14.0F);
}

// ---- bodies

static void test_discs_from_a_millimetre_up_pass_and_smaller_ones_make_sense(void) {
    const double radii[] = {1e-3, 1e-4, 1e-6, 1e-12, 1e-38};
    for (size_t i = 0; i < sizeof radii / sizeof radii[0]; i++) {
        drive_disc(radii[i], i % 2 == 0 ? -1.0F : 0.01F);
        world(12.0, 8.0);
        box(5.0, 3.0, 7.0, 5.0);
        box(8.0, 0.0, 8.5, 3.99);
        box(8.0, 4.03, 8.5, 8.0); // a slit of 4 cm
        open_world();
        for (int8_t objective = AISLE_OPTIONS_SAFEST; objective <= AISLE_OPTIONS_LEAST_ENERGY; objective++) {
            ask_for_path(1.0, 4.0, 11.0, 4.0);
            query.options.objective = objective;
            query.options.planner = objective == AISLE_OPTIONS_SHORTEST ? AISLE_OPTIONS_AUTO : AISLE_OPTIONS_ASTAR;
            if (i == 0) {
                expect_path();
            } else {
                expect_sense();
            }
        }
    }
}

static void test_footprints_without_an_area_are_refused(void) {
    const double flat[][4][2] = {{{0, 0}, {0, 0}, {0, 0}, {0, 0}},
                                 {{-0.5, 0}, {0.5, 0}, {0.5, 0}, {-0.5, 0}},
                                 {{-1e-5, -1e-5}, {1e-5, -1e-5}, {1e-5, 1e-5}, {-1e-5, 1e-5}}};
    for (size_t i = 0; i < sizeof flat / sizeof flat[0]; i++) {
        aisle_vehicle_msg msg = {.vehicle_revision = 2 + (int32_t)i, .num_vertices = 4};
        memcpy(msg.footprint, flat[i], sizeof flat[i]);
        TEST_ASSERT_EQUAL(AISLE_ERR_DATA, door_submit(AISLE_INPUT_VEHICLE, &msg));
        TEST_ASSERT_EQUAL_INT16(AISLE_STATUS_MALFORMED, status_now().cause);
    }
    open_world();
    ask_for_path(1.0, 4.0, 11.0, 4.0);
    expect_path(); // with the body it had
}

// ---- stops

static void test_a_stop_on_an_obstacles_boundary_or_the_bounds_is_occupied(void) {
    const float margins[] = {0.05F, -1.0F};
    for (int m = 0; m < 2; m++) {
        drive_disc(0.3, margins[m]);
        world(12.0, 8.0);
        box(5.0, 3.0, 7.0, 5.0);
        open_world();
        const struct {
            double x, y;
            int32_t id;
        } at[] = {{5.0, 4.0, 1},  {5.0, 3.0, 1},   {7.0, 5.0, 1}, {6.0, 4.0, 1},
                  {0.0, 4.0, -2}, {12.0, 8.0, -2}, {0.0, 0.0, -2}};
        for (size_t i = 0; i < sizeof at / sizeof at[0]; i++) {
            ask_for_path(1.0, 1.0, at[i].x, at[i].y);
            expect_cause(AISLE_STATUS_GOAL_OCCUPIED, at[i].id);
            TEST_ASSERT_TRUE(door_reply.cause_value > 0.299F); // how far to move
            ask_for_path(at[i].x, at[i].y, 1.0, 1.0);
            expect_cause(AISLE_STATUS_START_OCCUPIED, at[i].id);
        }
    }
}

static void test_a_stop_outside_is_told_as_such(void) {
    open_world();
    const double out[][2] = {{-1e-9, 4.0}, {12.1, 4.0}, {4.0, -3.0}, {1e300, 4.0}, {4.0, -1e300}};
    for (size_t i = 0; i < sizeof out / sizeof out[0]; i++) {
        ask_for_path(1.0, 1.0, out[i][0], out[i][1]);
        expect_cause(AISLE_STATUS_GOAL_OUTSIDE, 11);
        ask_for_path(out[i][0], out[i][1], 1.0, 1.0);
        expect_cause(AISLE_STATUS_POSE_OUTSIDE, 0);
    }
}

static void test_numbers_of_a_stop_that_are_none_are_malformed(void) {
    open_world();
    const double bad[] = {(double)NAN, INFINITY, -INFINITY};
    for (int i = 0; i < 3; i++) {
        for (int member = 0; member < 6; member++) {
            ask_for_path(1.0, 1.0, 6.0, 6.0);
            aisle_goal_msg *goal = &query.goals[0];
            *(member == 0 ? &goal->x : (member == 1 ? &goal->y : &goal->theta)) = member < 3 ? bad[i] : 0.0;
            if (member >= 3) {
                goal->x = goal->y = 6.0;
                *(member == 3 ? &goal->tolerance_xy : (member == 4 ? &goal->tolerance_theta : &goal->dwell)) =
                    (float)bad[i];
            }
            expect_cause(AISLE_STATUS_MALFORMED, 11);
        }
    }
}

static void test_start_and_goal_in_one_place_need_at_most_a_turn(void) {
    open_world();
    ask_for_path(4.0, 4.0, 4.0, 4.0);
    expect_path();
    TEST_ASSERT_EQUAL_FLOAT(0.0F, door_reply.length);
    query.start.tolerance_theta = 0.05F;
    query.start.theta = 0.5;
    query.goals[0].tolerance_theta = 0.05F;
    const double headings[] = {0.5, 0.500001, 2.0, -2.5, 0.5 + 3.14159265358979, 9000.0};
    for (size_t i = 0; i < sizeof headings / sizeof headings[0]; i++) {
        query.goals[0].theta = headings[i];
        expect_path();
        TEST_ASSERT_EQUAL_FLOAT(0.0F, door_reply.length);
    }
    query.goals[0].x += 1e-7; // nearer than any piece is long
    expect_path();
    query.goals[0].x += 1e-4;
    expect_path();
}

static void test_equal_goals_in_a_row_are_all_reached(void) {
    box(5.0, 3.0, 7.0, 5.0);
    open_world();
    for (int fixed = 0; fixed < 2; fixed++) {
        ask_for_path(1.0, 4.0, 11.0, 4.0);
        for (int16_t i = 1; i < 6; i++) {
            query.goals[i] = query.goals[0];
            query.goals[i].id = i < 3 ? 11 : 12; // the same name twice, too
            query.goals[i].theta = 0.7 * i * fixed;
            query.goals[i].tolerance_theta = fixed != 0 ? 0.02F : 4.0F;
            query.goals[i].dwell = i == 4 ? 3.0F : 0.0F;
        }
        query.num_goals = 6;
        expect_path();
    }
}

static void test_64_goals_are_reached_in_order_or_the_budget_ends_it(void) {
    box(5.0, 3.0, 7.0, 5.0);
    open_world();
    aisle_rng rng = aisle_rng_seed(64);
    ask_for_path(1.0, 4.0, 1.0, 1.0);
    for (int16_t i = 0; i < AISLE_GOAL_LIST_MAX_GOALS; i++) {
        aisle_vec2 p;
        do {
            p = uniform_point(&rng, aisle_vec2_of(0.4, 0.4), aisle_vec2_of(11.6, 7.6));
        } while (disc_gap((aisle_pose2){p.x, p.y, 0.0}) < 0.06);
        query.goals[i] = (aisle_goal_msg){.id = 100 + i, .x = p.x, .y = p.y, .tolerance_theta = 4.0F};
    }
    query.num_goals = AISLE_GOAL_LIST_MAX_GOALS;
    expect_path();
    query.options.work_units = 1000;
    expect_cause(AISLE_STATUS_BUDGET, 0);
    query.options.work_units = 0;
    query.ordering = AISLE_GOAL_LIST_ANY_ORDER;
    TEST_ASSERT_EQUAL(AISLE_PATH_OK, door_ask(&query)->status);
    judge_clear(&door_reply);
}

static void test_counts_of_goals_out_of_range_are_refused(void) {
    open_world();
    ask_for_path(1.0, 4.0, 1.0, 1.0);
    const int16_t counts[] = {-1, INT16_MIN, AISLE_GOAL_LIST_MAX_GOALS + 1, INT16_MAX};
    for (int i = 0; i < 4; i++) {
        query.num_goals = counts[i];
        TEST_ASSERT_EQUAL(AISLE_ERR_DATA, door_submit(AISLE_INPUT_QUERY, &query));
        TEST_ASSERT_EQUAL_INT16(AISLE_STATUS_LIMIT, status_now().cause);
    }
    query.num_goals = 0;
    expect_cause(AISLE_STATUS_MALFORMED, 0);
}

// ---- options

static void test_options_of_any_value_give_a_right_path_or_a_cause(void) {
    const float floats[] = {(float)NAN, INFINITY, -INFINITY, 1e30F, -1e30F, 1e-30F, -0.0F};
    box(5.0, 3.0, 7.0, 5.0);
    open_world();
    for (size_t i = 0; i < sizeof floats / sizeof floats[0]; i++) {
        for (int member = 0; member < 3; member++) {
            for (int8_t objective = AISLE_OPTIONS_SAFEST; objective <= AISLE_OPTIONS_SHORTEST; objective++) {
                ask_for_path(1.0, 4.0, 11.0, 4.0);
                query.options.objective = objective;
                *(member == 0 ? &query.options.risk_weight
                              : (member == 1 ? &query.options.step : &query.options.zone)) = floats[i];
                expect_sense();
            }
        }
    }
    for (int planner = INT8_MIN; planner <= INT8_MAX; planner += 3) {
        ask_for_path(1.0, 4.0, 11.0, 4.0);
        query.options.planner = (int8_t)planner;
        query.options.objective = (int8_t)(planner / 7);
        query.options.interpolation = (int8_t)(planner / 5);
        query.ordering = (int8_t)planner;
        query.options.seed = INT32_MIN;
        query.options.num_samples = planner % 2 == 0 ? INT16_MAX : INT16_MIN;
        query.options.work_units = planner % 4 == 0 ? INT32_MAX : (planner % 4 == 1 ? INT32_MIN : 1);
        expect_sense();
    }
    ask_for_path(1.0, 4.0, 11.0, 4.0);
    expect_path();
}

// ---- size

static void test_a_map_of_a_kilometre_is_planned_on_coarser_cells(void) {
    world(1000.0, 1000.0);
    box(400.0, 0.0, 420.0, 900.0);
    box(600.0, 100.0, 620.0, 1000.0);
    box(500.0, 480.0, 510.0, 490.0);
    open_world();
    ask_for_path(10.0, 10.0, 990.0, 990.0);
    expect_path();
    TEST_ASSERT_TRUE(door_reply.length > 2770.0F && door_reply.length < 2830.0F);
    query.options.planner = AISLE_OPTIONS_AUTO;
    query.options.objective = AISLE_OPTIONS_SAFEST;
    expect_path();
    query.goals[0].x = 410.0;
    query.goals[0].y = 500.0;
    expect_cause(AISLE_STATUS_GOAL_OCCUPIED, 1);
}

// ---- everything at once

static aisle_rng rng;

// A triangle or a fan of a circle's points, often on a lattice of half metres so that shapes touch, sometimes a sliver.
static void draw_polygon(void) {
    double v[8][2];
    aisle_vec2 c = uniform_point(&rng, aisle_vec2_of(-1.0, -1.0), aisle_vec2_of(13.0, 9.0));
    double size = uniform(&rng, 0.05, 1.5), flat = aisle_rng_below(&rng, 3U) == 0 ? 1e-3 : 1.0;
    int n = 3 + (int)aisle_rng_below(&rng, 6U);
    if (aisle_rng_below(&rng, 2U) == 0) {
        double x = floor(2.0 * c.x) / 2.0, y = floor(2.0 * c.y) / 2.0;
        box(x, y, x + 0.5 + 0.5 * (double)aisle_rng_below(&rng, 4U), y + 0.5 + 0.5 * (double)aisle_rng_below(&rng, 3U));
        return;
    }
    for (int i = 0; i < n; i++) {
        double a = 2.0 * DOOR_PI * i / n;
        v[i][0] = c.x + size * cos(a);
        v[i][1] = c.y + flat * size * sin(a);
    }
    (void)polygon(n, v[0]);
}

// Anywhere, on a vertex, on an edge, or on the bounds.
static aisle_goal_msg draw_stop(int32_t id) {
    aisle_vec2 p = uniform_point(&rng, aisle_vec2_of(0.0, 0.0), aisle_vec2_of(12.0, 8.0));
    uint32_t kind = aisle_rng_below(&rng, 8U);
    if (kind < 2U) {
        const aisle_polygon_msg *of = &layout.polygons[aisle_rng_below(&rng, (uint32_t)layout.num_polygons)];
        const double *a = of->vertices[0], *b = of->vertices[kind];
        p = aisle_vec2_of(0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1]));
    } else if (kind == 2U) {
        p.x = 12.0;
    }
    bool fixed = aisle_rng_below(&rng, 3U) == 0;
    return (aisle_goal_msg){
        .id = id, .x = p.x, .y = p.y, .theta = uniform(&rng, -4.0, 4.0), .tolerance_theta = fixed ? 0.0F : 4.0F};
}

static void test_random_polygons_and_stops_of_any_kind_give_right_paths_or_causes(void) {
    static const double radii[] = {1e-3, 0.05, 0.3};
    int paths = 0;
    for (uint64_t seed = 0; seed < CASES(120); seed++) {
        rng = aisle_rng_seed(seed);
        drive_disc(radii[seed % 3U], seed % 2U == 0 ? -1.0F : 0.05F);
        world(12.0, 8.0);
        for (uint32_t n = 1U + aisle_rng_below(&rng, POLYGONS - 1U); n > 0; n--) {
            draw_polygon();
        }
        open_world();
        for (int k = 0; k < 4; k++) {
            ask_for_path(0.0, 0.0, 0.0, 0.0);
            query.start = draw_stop(0);
            query.goals[0] = draw_stop(1);
            query.goals[1] = draw_stop(2);
            query.num_goals = (int16_t)(1U + aisle_rng_below(&rng, 2U));
            query.options.objective = (int8_t)aisle_rng_below(&rng, 4U);
            query.options.planner = aisle_rng_below(&rng, 2U) == 0 ? AISLE_OPTIONS_AUTO : AISLE_OPTIONS_ASTAR;
            query.options.work_units = 200000;
            expect_sense();
            paths += door_reply.status == AISLE_PATH_OK;
        }
    }
    TEST_ASSERT_GREATER_THAN_INT(CASES(100), paths);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_polygons_that_are_none_are_refused_by_name_and_change_nothing);
    RUN_TEST(test_bounds_that_are_none_are_refused);
    RUN_TEST(test_collinear_and_repeated_vertices_change_no_path);
    RUN_TEST(test_duplicated_and_overlapping_polygons_are_as_good_as_their_union);
    RUN_TEST(test_polygons_that_touch_leave_no_way_between_them);
    RUN_TEST(test_polygons_across_and_beyond_the_bounds_count_as_far_as_they_reach);
    RUN_TEST(test_slivers_of_a_tenth_of_a_millimetre_are_walls);
    RUN_TEST(test_discs_from_a_millimetre_up_pass_and_smaller_ones_make_sense);
    RUN_TEST(test_footprints_without_an_area_are_refused);
    RUN_TEST(test_a_stop_on_an_obstacles_boundary_or_the_bounds_is_occupied);
    RUN_TEST(test_a_stop_outside_is_told_as_such);
    RUN_TEST(test_numbers_of_a_stop_that_are_none_are_malformed);
    RUN_TEST(test_start_and_goal_in_one_place_need_at_most_a_turn);
    RUN_TEST(test_equal_goals_in_a_row_are_all_reached);
    RUN_TEST(test_64_goals_are_reached_in_order_or_the_budget_ends_it);
    RUN_TEST(test_counts_of_goals_out_of_range_are_refused);
    RUN_TEST(test_options_of_any_value_give_a_right_path_or_a_cause);
    RUN_TEST(test_a_map_of_a_kilometre_is_planned_on_coarser_cells);
    RUN_TEST(test_random_polygons_and_stops_of_any_kind_give_right_paths_or_causes);
    return UNITY_END();
}
