#include "test_verify_fixture.h"

// Zones: a path across a directed or slow area, and a judge that samples it densely in long double.

enum { SEEDS = 160, SAMPLES = 1000 };

static double zone_v[8][2];
static int zone_n;

static void a_world(void) {
    world_begin(-50.0, -50.0, 50.0, 50.0, 1.0F);
}

static int32_t zone(int8_t kind, float value, float direction, int n, double (*v)[2]) {
    int32_t id = world_polygon(kind, n, v);
    aisle_polygon_msg *p = &world_msg.polygons[world_msg.num_polygons - 1];
    p->value = value;
    p->direction = direction;
    memcpy(zone_v, v, sizeof(double[2]) * (size_t)n);
    zone_n = n;
    return id;
}

static int32_t box_zone(int8_t kind, float value, float direction, double x0, double y0, double x1, double y1) {
    double v[4][2] = {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}};
    return zone(kind, value, direction, 4, v);
}

static int32_t directed(float direction) {
    return box_zone(AISLE_POLYGON_DIRECTED, 0.0F, direction, -2.0, -1.0, 2.0, 1.0);
}

static void across(double from_x, double y, double theta, double length) {
    path_begin(from_x, y, theta);
    path_line(length);
    path_end();
}

void setUp(void) {
    vehicle_box(0.5, 0.5, 0.6, 0.0);
    a_world();
}
void tearDown(void) {}

// ---- directed

static void test_along_the_direction_and_up_to_a_right_angle_is_driven(void) {
    (void)directed(0.0F);
    world_build();
    across(-5.0, 0.0, 0.0, 10.0);
    TEST_ASSERT_EQUAL(AISLE_VERIFY_NONE, verified());
    across(0.0, -5.0, 0.5 * (double)acosl(-1.0L), 10.0); // across it
    TEST_ASSERT_EQUAL(AISLE_VERIFY_NONE, verified());
    across(0.0, -5.0, 0.5 * (double)acosl(-1.0L) + 1.5e-3, 10.0); // within the tolerance
    TEST_ASSERT_EQUAL(AISLE_VERIFY_NONE, verified());
    across(0.0, -5.0, 0.5 * (double)acosl(-1.0L) + 3e-3, 10.0);
    TEST_ASSERT_EQUAL(AISLE_VERIFY_DIRECTION, verified());
}

static void test_against_it_is_a_fault_that_names_the_zone_and_the_place(void) {
    int32_t id = directed(3.0F);
    world_build();
    across(-5.0, 0.3, 0.0, 10.0);
    TEST_ASSERT_EQUAL(AISLE_VERIFY_DIRECTION, verified());
    TEST_ASSERT_EQUAL_INT32(id, verify.fault_id);
    TEST_ASSERT_EQUAL_UINT32(1, verify.fault_waypoint);
    TEST_ASSERT_TRUE(fabs(verify.fault_at.y - 0.3) < 1e-9 && fabs(verify.fault_at.x) <= 5.0);
}

static void test_the_motion_counts_and_not_the_heading(void) {
    (void)directed(0.0F);
    world_build();
    path_begin(5.0, 0.0, 0.0); // backwards through it, heading along the zone
    pen_flags = AISLE_WAYPOINT_REVERSE;
    path_line(10.0);
    path_end();
    TEST_ASSERT_EQUAL(AISLE_VERIFY_DIRECTION, verified());
    path_begin(-5.0, 0.0, (double)acosl(-1.0L)); // backwards along it, heading against
    pen_flags = AISLE_WAYPOINT_REVERSE;
    path_line(10.0);
    path_end();
    TEST_ASSERT_EQUAL(AISLE_VERIFY_NONE, verified());
}

static void test_the_origin_counts_and_not_the_body(void) {
    (void)directed(3.0F);
    world_build();
    across(-5.0, 1.0, 0.0, 10.0); // on the border
    TEST_ASSERT_EQUAL(AISLE_VERIFY_NONE, verified());
    across(-5.0, 1.0 - 3e-6, 0.0, 10.0);
    TEST_ASSERT_EQUAL(AISLE_VERIFY_DIRECTION, verified());
}

static void test_standing_and_turning_on_the_spot_inside_is_no_motion(void) {
    (void)directed(0.0F);
    world_build();
    path_begin(0.0, 0.0, 3.0);
    path_turn(-3.0);
    path_line(5.0);
    path_end();
    TEST_ASSERT_EQUAL(AISLE_VERIFY_NONE, verified());
}

static void test_every_zone_is_asked(void) {
    (void)directed(0.0F);
    world_build();
    across(-5.0, 0.0, 0.0, 10.0);
    TEST_ASSERT_EQUAL(AISLE_VERIFY_NONE, verified());
    a_world();
    (void)directed(0.0F);
    int32_t id = directed(3.1F); // two that contradict each other
    world_build();
    TEST_ASSERT_EQUAL(AISLE_VERIFY_DIRECTION, verified());
    TEST_ASSERT_EQUAL_INT32(id, verify.fault_id);
}

// How deep the path gets into the zone where it moves more than `beyond` off a right angle against `direction`; negative:
// never inside.
static long double depth_against(long double direction, long double beyond) {
    long double deepest = -1e9L;
    for (int i = 1; i < path.num_waypoints; i++) {
        const stretch s = stretch_at(i);
        for (int k = 0; k <= SAMPLES; k++) {
            long double u = (long double)k / SAMPLES, pose[3], dx = s.dx, dy = s.dy, depth = 1e9L;
            stretch_pose(&s, u, pose);
            if (s.r > 0.0L) {
                long double at = s.from + u * s.sweep, side = s.sweep > 0.0L ? 1.0L : -1.0L;
                dx = -side * sinl(at);
                dy = side * cosl(at);
            }
            long double cosine = (dx * cosl(direction) + dy * sinl(direction)) / hypotl(dx, dy);
            for (int e = 0; e < zone_n; e++) {
                const double *a = zone_v[e], *b = zone_v[(e + 1) % zone_n];
                long double ex = (long double)b[0] - (long double)a[0], ey = (long double)b[1] - (long double)a[1];
                long double at = (ex * (pose[1] - (long double)a[1]) - ey * (pose[0] - (long double)a[0]));
                depth = fminl(depth, at / hypotl(ex, ey));
            }
            if (cosine < -sinl(beyond)) {
                deepest = fmaxl(deepest, depth);
            }
        }
    }
    return deepest;
}

static void random_zone(float direction) {
    double v[8][2], r = uniform(0.5, 2.5);
    int n = 3 + below(5);
    for (int i = 0; i < n; i++) {
        double a = 6.283185 * i / n + 0.3;
        v[i][0] = uniform(-0.5, 0.5) * 0.1 + r * cos(a);
        v[i][1] = r * 0.6 * sin(a);
    }
    (void)zone(AISLE_POLYGON_DIRECTED, 0.0F, direction, n, v);
}

static void random_arcs(void) {
    double heading = uniform(-3.1, 3.1);
    double aside = uniform(-1.5, 1.5), ahead = uniform(-1.5, 1.5);
    path_begin(-2.5 * cos(heading) + aside, -2.5 * sin(heading) + ahead, heading);
    pen_flags = below(4) == 0 ? AISLE_WAYPOINT_REVERSE : 0;
    for (int i = 0; i < 3; i++) {
        double k = (below(2) == 0 ? 1.0 : -1.0) * uniform(0.1, 1.5);
        path_arc(k, fmin(uniform(0.1, 3.0), 1.8 * fabs(k)));
    }
    path_end();
}

static void test_random_arcs_are_faults_just_where_samples_say_so_for_every_seed(void) {
    int faults = 0, fine = 0;
    for (uint64_t seed = 0; seed < SEEDS; seed++) {
        dice = aisle_rng_seed(seed);
        float direction = (float)uniform(-3.1, 3.1);
        a_world();
        random_zone(direction);
        world_build();
        random_arcs();
        aisle_verify_fault fault = verified();
        long double sure = depth_against((long double)direction, 2e-3L),
                    near = depth_against((long double)direction, 1.9e-3L);
        if (sure > 2e-6L) {
            TEST_ASSERT_EQUAL(AISLE_VERIFY_DIRECTION, fault);
            faults++;
        } else if (near < -3e-3L) { // samples are up to 3 mm apart
            TEST_ASSERT_EQUAL(AISLE_VERIFY_NONE, fault);
            fine++;
        }
    }
    TEST_ASSERT_GREATER_THAN(SEEDS / 8, faults);
    TEST_ASSERT_GREATER_THAN(SEEDS / 8, fine);
}

// ---- speed limits

static int32_t slow_box(float value) {
    return box_zone(AISLE_POLYGON_SPEED_LIMIT, value, 0.0F, -2.0, -1.0, 2.0, 1.0);
}

static void fast_line(double y) { // past the zone at 1 m/s
    path_begin(-8.0, y, 0.0);
    for (int i = 0; i < 16; i++) {
        path_line(1.0);
    }
    path_end();
    path_drive(1.0);
}

static void test_faster_than_a_zone_is_a_fault_that_names_it(void) {
    int32_t id = slow_box(0.6F);
    world_build();
    fast_line(0.0);
    TEST_ASSERT_EQUAL(AISLE_VERIFY_ZONE_SPEED, verified());
    TEST_ASSERT_EQUAL_INT32(id, verify.fault_id);
    TEST_ASSERT_TRUE(fabs(verify.fault_at.x) <= 2.5 + 1e-3);
}

static void test_as_fast_as_the_zone_lets_it_is_fine(void) {
    (void)slow_box(1.0F);
    world_build();
    fast_line(0.0);
    TEST_ASSERT_EQUAL(AISLE_VERIFY_NONE, verified());
    a_world();
    (void)slow_box(0.998F); // 2e-3 faster, 1e-3 is given
    world_build();
    fast_line(0.0);
    TEST_ASSERT_EQUAL(AISLE_VERIFY_ZONE_SPEED, verified());
}

static void test_the_footprint_counts_without_its_margin(void) {
    (void)slow_box(0.6F);
    world_build();
    fast_line(1.3 + 1e-5); // 0.6 m wide
    TEST_ASSERT_EQUAL(AISLE_VERIFY_NONE, verified());
    fast_line(1.3 - 1e-5);
    TEST_ASSERT_EQUAL(AISLE_VERIFY_ZONE_SPEED, verified());
}

static void test_the_slowest_of_zones_that_overlap_holds(void) {
    (void)slow_box(2.0F);
    int32_t id = slow_box(0.9F);
    (void)slow_box(1.2F);
    world_build();
    fast_line(0.0);
    TEST_ASSERT_EQUAL(AISLE_VERIFY_ZONE_SPEED, verified());
    TEST_ASSERT_EQUAL_INT32(id, verify.fault_id);
}

static void test_an_obstacle_beside_a_zone_keeps_its_own_faults(void) {
    (void)slow_box(0.6F);
    int32_t wall = world_box(AISLE_POLYGON_OBSTACLE, -2.0, 0.7, 2.0, 1.0);
    world_build();
    fast_line(0.0); // 0.4 m from the wall: too fast for that
    TEST_ASSERT_EQUAL(AISLE_VERIFY_CREEP, verified());
    TEST_ASSERT_EQUAL_INT32(wall, verify.fault_id);
    across(-1.0, 0.38, 0.0, 2.0); // 0.02 m
    TEST_ASSERT_EQUAL(AISLE_VERIFY_COLLISION, verified());
    TEST_ASSERT_EQUAL_INT32(wall, verify.fault_id);
}

static void test_from_rest_to_rest_the_peak_counts(void) {
    (void)slow_box(0.3F);
    world_build();
    path_begin(-1.0, 0.0, 0.0);
    path_line(2.0);
    path_end();
    path_retime(0.3);
    path_seal();
    TEST_ASSERT_EQUAL(AISLE_VERIFY_NONE, verified());
    path_retime(0.4);
    path_seal();
    TEST_ASSERT_EQUAL(AISLE_VERIFY_ZONE_SPEED, verified());
}

static void test_random_arcs_past_a_slow_zone_are_faults_just_where_the_body_touches_it_for_every_seed(void) {
    int faults = 0, fine = 0;
    for (uint64_t seed = 0; seed < SEEDS / 2; seed++) {
        dice = aisle_rng_seed(seed + 1000);
        a_world();
        (void)slow_box(0.05F);
        world_build();
        random_arcs();
        aisle_verify_fault fault = verified();
        world_count = 0; // the judge's turn: the zone as if it were an obstacle
        judge_learns(zone_n, zone_v);
        double gap = judge_gap(1e-4);
        if (gap <= 0.0) {
            TEST_ASSERT_EQUAL(AISLE_VERIFY_ZONE_SPEED, fault);
            faults++;
        } else if (gap > 1.2e-3) {
            TEST_ASSERT_EQUAL(AISLE_VERIFY_NONE, fault);
            fine++;
        }
    }
    TEST_ASSERT_GREATER_THAN(10, faults);
    TEST_ASSERT_GREATER_THAN(5, fine);
}

static void test_penalties_bind_nobody(void) {
    (void)box_zone(AISLE_POLYGON_PENALTY, 1.0F, 3.0F, -2.0, -1.0, 2.0, 1.0);
    world_build();
    fast_line(0.0);
    TEST_ASSERT_EQUAL(AISLE_VERIFY_NONE, verified());
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_along_the_direction_and_up_to_a_right_angle_is_driven);
    RUN_TEST(test_against_it_is_a_fault_that_names_the_zone_and_the_place);
    RUN_TEST(test_the_motion_counts_and_not_the_heading);
    RUN_TEST(test_the_origin_counts_and_not_the_body);
    RUN_TEST(test_standing_and_turning_on_the_spot_inside_is_no_motion);
    RUN_TEST(test_every_zone_is_asked);
    RUN_TEST(test_random_arcs_are_faults_just_where_samples_say_so_for_every_seed);
    RUN_TEST(test_faster_than_a_zone_is_a_fault_that_names_it);
    RUN_TEST(test_as_fast_as_the_zone_lets_it_is_fine);
    RUN_TEST(test_the_footprint_counts_without_its_margin);
    RUN_TEST(test_the_slowest_of_zones_that_overlap_holds);
    RUN_TEST(test_an_obstacle_beside_a_zone_keeps_its_own_faults);
    RUN_TEST(test_from_rest_to_rest_the_peak_counts);
    RUN_TEST(test_random_arcs_past_a_slow_zone_are_faults_just_where_the_body_touches_it_for_every_seed);
    RUN_TEST(test_penalties_bind_nobody);
    return UNITY_END();
}
