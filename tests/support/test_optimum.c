#include "cases.h"
#include "optimum.h"

#include "unity.h"

#include <math.h>
#include <string.h>

// The judge here is double and sampled; it shares nothing with optimum*.c.

enum { SEEDS = CASES(40), POLYGONS = 16, CORNERS = 6, RING = 24 };

static const double pi = 3.14159265358979323846;
static optimum_point corners[POLYGONS][CORNERS + 1];
static optimum_polygon polygons[POLYGONS];
static size_t polygon_count;
static double bounds[4];

void setUp(void) {
    static const double wide[4] = {0.0, 0.0, 10.0, 10.0};
    memcpy(bounds, wide, sizeof wide);
    polygon_count = 0;
}
void tearDown(void) {}

static void add(const double *xy, size_t count) {
    TEST_ASSERT_TRUE(polygon_count < POLYGONS && count <= CORNERS + 1);
    for (size_t i = 0; i < count; i++) {
        corners[polygon_count][i].x = xy[2 * i];
        corners[polygon_count][i].y = xy[2 * i + 1];
    }
    polygons[polygon_count].points = corners[polygon_count];
    polygons[polygon_count++].count = count;
}

static void add_box(double x0, double y0, double x1, double y1) {
    double xy[8] = {x0, y0, x1, y0, x1, y1, x0, y1};
    add(xy, 4);
}

static optimum_path solve(double radius, double sx, double sy, double gx, double gy) {
    optimum_world *world = optimum_polygons(radius, bounds, polygons, polygon_count);
    optimum_point start = {sx, sy}, goal = {gx, gy};
    optimum_path path = optimum_shortest(world, start, goal, INFINITY);
    optimum_free(world);
    return path;
}

static double length(double radius, double sx, double sy, double gx, double gy) {
    optimum_path path = solve(radius, sx, sy, gx, gy);
    optimum_path_free(&path);
    return path.length;
}

static void expect(double wanted, double radius, double sx, double sy, double gx, double gy) {
    TEST_ASSERT_DOUBLE_WITHIN(1e-8, wanted, length(radius, sx, sy, gx, gy));
    TEST_ASSERT_DOUBLE_WITHIN(1e-8, wanted, length(radius, gx, gy, sx, sy));
}

static void expect_result(optimum_result wanted, double radius, double sx, double sy, double gx, double gy) {
    optimum_path path = solve(radius, sx, sy, gx, gy);
    TEST_ASSERT_EQUAL(wanted, path.result);
    TEST_ASSERT_EQUAL(wanted == OPTIMUM_FOUND, isfinite(path.length));
    optimum_path_free(&path);
}

static void an_empty_room_is_crossed_straight(void) {
    expect(5.0, 0.3, 1.0, 1.0, 4.0, 5.0);
    expect(0.0, 0.3, 1.0, 1.0, 1.0, 1.0);
}

// Both ends a from the centre of the circle of radius r, the centre h off their line.
static double round_circle(double a, double h, double r) {
    double far = sqrt(a * a + h * h);
    double angle = 2.0 * (atan2(a, h) - acos(r / far)); // between the tangent points; h > 0: the near side
    return 2.0 * sqrt(far * far - r * r) + r * angle;
}

static void a_point_obstacle_is_a_circle(void) {
    double xy[2] = {5.0, 5.0};
    add(xy, 1);
    expect(round_circle(3.0, 0.0, 1.0), 1.0, 2.0, 5.0, 8.0, 5.0);
    expect(round_circle(3.0, 0.4, 1.0), 1.0, 2.0, 5.4, 8.0, 5.4);
    expect(6.0, 1.0, 2.0, 6.0, 8.0, 6.0); // touches
    expect(6.0, 0.0, 2.0, 5.0, 8.0, 5.0); // a point robot passes a point
}

static void a_half_turn_round_a_circle_runs_over_all_quarters(void) {
    double xy[2] = {5.0, 5.0};
    add(xy, 1);
    add_box(5.0, -1.0, 5.0, 11.0); // a wall through the centre, to be passed nowhere
    expect_result(OPTIMUM_NONE, 1.0, 2.0, 5.0, 8.0, 5.0);
    polygon_count = 1;
    add_box(-1.0, 5.0, 5.0, 5.0); // a wall that ends there
    expect(2.0 * 3.0 + pi, 1.0, 2.0, 4.0, 2.0, 6.0);
    expect(2.0, 0.0, 2.0, 4.0, 2.0, 6.0); // no obstacle to a point
}

static void a_line_obstacle_turns_a_disc_alone(void) {
    double xy[4] = {5.0, 3.0, 5.0, 7.0};
    add(xy, 2);
    expect(6.0, 0.0, 2.0, 5.0, 8.0, 5.0);
    double far = hypot(3.0, 2.0), angle = pi / 2.0 + atan2(2.0, 3.0) - acos(0.5 / far);
    expect(2.0 * (sqrt(far * far - 0.25) + 0.5 * angle), 0.5, 2.0, 5.0, 8.0, 5.0);
}

static void a_point_goes_round_a_square_by_its_corners(void) {
    add_box(4.0, 4.0, 6.0, 6.0);
    expect(2.0 * hypot(2.0, 1.0) + 2.0, 0.0, 2.0, 5.0, 8.0, 5.0);
    expect(2.0 * hypot(1.0, 3.0), 0.0, 3.0, 3.0, 7.0, 7.0);
    expect(2.0, 0.0, 4.0, 4.0, 6.0, 4.0); // along its side
}

static void a_disc_goes_round_a_square_by_arcs(void) {
    add_box(4.0, 4.0, 6.0, 6.0);
    double far = hypot(2.0, 1.0); // from the end to the corner
    double leg = sqrt(far * far - 0.25), angle = pi / 2.0 + atan2(1.0, 2.0) - acos(0.5 / far);
    expect(2.0 * (leg + 0.5 * angle) + 2.0, 0.5, 2.0, 5.0, 8.0, 5.0);
}

static void a_slit_just_wide_enough_is_a_way_and_a_narrower_one_is_none(void) {
    add_box(4.0, -1.0, 6.0, 5.0);
    add_box(4.0, 6.0, 6.0, 11.0);
    expect(6.0, 0.5, 2.0, 5.5, 8.0, 5.5);
    expect(6.0, 0.499, 2.0, 5.5, 8.0, 5.5);
    expect_result(OPTIMUM_FOUND, 0.5, 1.0, 1.0, 9.0, 1.0);
    expect_result(OPTIMUM_NONE, 0.5 + 1e-6, 2.0, 5.5, 8.0, 5.5);
}

static void two_circles_that_touch_let_a_disc_through(void) {
    double low[2] = {5.0, 4.5}, high[2] = {5.0, 5.5};
    add(low, 1);
    add(high, 1);
    add_box(5.0, -1.0, 5.0, 4.0);
    add_box(5.0, 6.0, 5.0, 11.0);
    expect(6.0, 0.5, 2.0, 5.0, 8.0, 5.0);
    double far = hypot(3.0, 2.0); // from above: round the upper point, down to the gap
    double angle = 1.5 * pi - atan2(2.0, -3.0) - acos(0.5 / far);
    expect(sqrt(far * far - 0.25) + 0.5 * angle, 0.5, 2.0, 7.5, 5.0, 5.0);
}

static void an_obstacle_near_an_arc_closes_it(void) {
    double point[2] = {5.0, 5.0};
    add(point, 1);
    expect(round_circle(3.0, 0.4, 1.0), 1.0, 2.0, 5.4, 8.0, 5.4);
    add_box(4.9, 6.9, 5.1, 11.0); // leaves 1.9 above the point
    expect(round_circle(3.0, -0.4, 1.0), 1.0, 2.0, 5.4, 8.0, 5.4);
    polygon_count = 1;
    add_box(4.9, 7.0, 5.1, 11.0);
    expect(round_circle(3.0, 0.4, 1.0), 1.0, 2.0, 5.4, 8.0, 5.4);
    polygon_count = 1;
    double tip[6] = {5.0, 6.9, 5.1, 11.0, 4.9, 11.0}; // a corner instead of a side
    add(tip, 3);
    expect(round_circle(3.0, -0.4, 1.0), 1.0, 2.0, 5.4, 8.0, 5.4);
}

static void an_arc_is_used_up_to_where_it_is_closed(void) {
    double point[2] = {5.0, 5.0}, tip[6] = {3.9, 6.3, 4.0, 11.0, 3.8, 11.0}; // closes from 98.6 to 161.8 degrees
    double gx = -0.965, gy = 0.29, far = hypot(gx, gy);                      // left at 169 degrees
    double turn = 1.5 * pi - acos(1.0 / 3.0) - atan2(gy, gx) - acos(1.0 / far);
    add(point, 1);
    add_box(-1.0, 6.3, 11.0, 11.0); // closes up to 162.5 degrees
    expect(sqrt(8.0) + turn + sqrt(far * far - 1.0), 1.0, 5.0, 2.0, 5.0 + gx, 5.0 + gy);
    polygon_count = 1;
    add(tip, 3);
    expect(sqrt(8.0) + turn + sqrt(far * far - 1.0), 1.0, 5.0, 2.0, 5.0 + gx, 5.0 + gy);
}

static void each_side_of_the_bounds_stops_an_arc(void) {
    for (int side = 0; side < 4; side++) {
        double dx = side == 1 ? 1.0 : (side == 3 ? -1.0 : 0.0), dy = side == 0 ? 1.0 : (side == 2 ? -1.0 : 0.0);
        double point[2] = {5.0, 5.0},
               wall[4] = {5.0, 5.0, 5.0 - 9.0 * dx, 5.0 - 9.0 * dy}; // the way leads over (dx, dy)
        polygon_count = 0;
        add(point, 1);
        add(wall, 2);
        double sx = 5.0 - 3.0 * dy, sy = 5.0 - 3.0 * dx, gx = 5.0 + 3.0 * dy, gy = 5.0 + 3.0 * dx;
        double room[4] = {0.0, 0.0, 10.0, 10.0};
        room[side == 0 ? 3 : (side == 1 ? 2 : (side == 2 ? 1 : 0))] = side < 2 ? 6.0 : 4.0;
        memcpy(bounds, room, sizeof room);
        expect(round_circle(3.0, 0.0, 1.0), 1.0, sx, sy, gx, gy);
        expect_result(OPTIMUM_NONE, 1.0001, sx, sy, gx, gy);
    }
}

static void the_bounds_stop_an_arc(void) {
    add_box(4.0, 2.0, 6.0, 11.0); // leaves 2 below
    expect_result(OPTIMUM_FOUND, 2.0, 1.0, 5.0, 9.0, 5.0);
    expect_result(OPTIMUM_NONE, 2.001, 1.0, 5.0, 9.0, 5.0);
    bounds[1] = 1.6;
    expect_result(OPTIMUM_FOUND, 0.4, 1.0, 5.0, 9.0, 5.0);
    expect_result(OPTIMUM_NONE, 0.41, 1.0, 5.0, 9.0, 5.0);
}

static void an_end_too_near_an_obstacle_or_outside_is_told(void) {
    add_box(4.0, 4.0, 6.0, 6.0);
    expect_result(OPTIMUM_END_OCCUPIED, 0.5, 3.6, 5.0, 9.0, 5.0);
    expect_result(OPTIMUM_END_OCCUPIED, 0.0, 1.0, 5.0, 5.0, 5.0);
    expect_result(OPTIMUM_END_OCCUPIED, 0.5, 1.0, 5.0, 5.0, 5.0); // deeper inside than the radius
    expect_result(OPTIMUM_END_OCCUPIED, 0.5, 1.0, 5.0, 10.1, 5.0);
    expect_result(OPTIMUM_FOUND, 0.5, 3.5, 5.0, 9.0, 5.0);
    expect_result(OPTIMUM_FOUND, 0.0, 4.0, 5.0, 10.0, 5.0);
}

// --- random worlds ---

static uint64_t state;

static double uniform(double low, double high) {
    state = state * 6364136223846793005U + 1442695040888963407U;
    return low + (high - low) * (double)(state >> 11) / 9007199254740992.0;
}

static void add_random(void) {
    double x = uniform(1.0, 9.0), y = uniform(1.0, 9.0), size = uniform(0.4, 1.8), turn = uniform(0.0, 2.0 * pi);
    size_t n = (size_t)uniform(3.0, (double)CORNERS + 0.999);
    double xy[2 * CORNERS];
    for (size_t i = 0; i < n; i++) {
        double angle = turn + 2.0 * pi * ((double)i + uniform(0.0, 0.8)) / (double)n;
        xy[2 * i] = x + size * cos(angle);
        xy[2 * i + 1] = y + size * sin(angle);
    }
    add(xy, n);
}

static void random_world(uint64_t seed, size_t most) {
    state = seed;
    polygon_count = 0;
    size_t n = (size_t)uniform(3.0, (double)most + 0.999);
    while (polygon_count < n) {
        add_random();
    }
}

static double to_segment(optimum_point p, optimum_point a, optimum_point b) {
    double dx = b.x - a.x, dy = b.y - a.y, square = dx * dx + dy * dy;
    double f = square > 0.0 ? fmin(fmax(((p.x - a.x) * dx + (p.y - a.y) * dy) / square, 0.0), 1.0) : 0.0;
    return hypot(p.x - a.x - f * dx, p.y - a.y - f * dy);
}

// Negative inside.
static double to_polygon(optimum_point p, const optimum_polygon *polygon) {
    double nearest = INFINITY;
    bool inside = true;
    for (size_t i = 0; i < polygon->count; i++) {
        optimum_point a = polygon->points[i], b = polygon->points[(i + 1) % polygon->count];
        nearest = fmin(nearest, to_segment(p, a, b));
        inside = inside && (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x) > 0.0;
    }
    return inside ? -nearest : nearest;
}

static double clearance(optimum_point p) {
    double nearest = INFINITY;
    for (size_t i = 0; i < polygon_count; i++) {
        nearest = fmin(nearest, to_polygon(p, &polygons[i]));
    }
    return nearest;
}

static bool is_inside(optimum_point p, double slack) {
    return p.x >= bounds[0] - slack && p.x <= bounds[2] + slack && p.y >= bounds[1] - slack && p.y <= bounds[3] + slack;
}

static bool is_clear(optimum_point p, double radius) {
    return is_inside(p, 1e-8) && clearance(p) >= radius - 1e-8;
}

// The piece from a to b by samples; its length.
static double walk(optimum_point a, optimum_step b, double radius) {
    double chord = hypot(b.x - a.x, b.y - a.y), k = b.curvature,
           half = k != 0.0 ? asin(fmin(0.5 * chord * fabs(k), 1.0)) : 0.0;
    double heading = atan2(b.y - a.y, b.x - a.x) - (k > 0.0 ? half : -half);
    double whole = k != 0.0 ? 2.0 * half / fabs(k) : chord;
    for (int i = 0; i <= 200; i++) {
        double s = whole * i / 200.0, along = k != 0.0 ? 2.0 * sin(0.5 * k * s) / k : s;
        optimum_point p = {a.x + along * cos(heading + 0.5 * k * s), a.y + along * sin(heading + 0.5 * k * s)};
        TEST_ASSERT_TRUE_MESSAGE(is_clear(p, radius), "the path is not free");
    }
    return whole;
}

static void path_is_free_and_as_long_as_told(const optimum_path *path, double radius) {
    double sum = 0.0;
    for (size_t i = 1; i < path->count; i++) {
        optimum_point a = {path->steps[i - 1].x, path->steps[i - 1].y};
        sum += walk(a, path->steps[i], radius);
    }
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, path->length, sum);
}

static void every_random_path_is_free_and_as_long_as_told(void) {
    unsigned found = 0;
    for (uint64_t seed = 1; seed <= 10 * SEEDS; seed++) {
        random_world(seed, POLYGONS);
        double radius = seed % 4 == 0 ? 0.0 : uniform(0.1, 1.0);
        optimum_path path = solve(radius, 0.2, 0.3, 9.7, 9.8);
        if (path.result == OPTIMUM_FOUND) {
            path_is_free_and_as_long_as_told(&path, radius);
            found++;
        }
        optimum_path_free(&path);
    }
    TEST_ASSERT_TRUE(found >= 5 * SEEDS);
}

// An upper bound by another road: points on rings just outside the circles round all corners, joined where a sampled
// straight line is free.
typedef struct sampled {
    optimum_point points[7 * CORNERS * RING + 2];
    double cost[7 * CORNERS * RING + 2];
    bool done[7 * CORNERS * RING + 2];
    size_t count;
} sampled;
static sampled graph;

static void add_rings(double radius) {
    graph.count = 2;
    double ring = (radius + 1e-7) / cos(pi / RING);
    for (size_t i = 0; i < polygon_count; i++) {
        for (size_t k = 0; k < polygons[i].count * RING; k++) {
            optimum_point c = polygons[i].points[k / RING], p = c;
            p.x += ring * cos(2.0 * pi * (double)(k % RING) / RING);
            p.y += ring * sin(2.0 * pi * (double)(k % RING) / RING);
            if (is_inside(p, 0.0) && clearance(p) >= radius) {
                graph.points[graph.count++] = p;
            }
        }
    }
}

// Whether the clearance, which changes by at most a metre a metre, stays above the radius from a to b.
static bool is_line_free(optimum_point a, optimum_point b, double radius) {
    double whole = hypot(b.x - a.x, b.y - a.y);
    for (double s = 0.0; s < whole;) {
        optimum_point p = {a.x + (b.x - a.x) * s / whole, a.y + (b.y - a.y) * s / whole};
        double room = clearance(p) - radius;
        if (room < 0.0) {
            return false;
        }
        s += fmax(room, 1e-3); // a dip between two of these is below 2.5e-6 deep per metre of radius and more
    }
    return true;
}

static double sampled_length(double radius) {
    for (size_t i = 0; i < graph.count; i++) {
        graph.cost[i] = i == 0 ? 0.0 : HUGE_VAL;
        graph.done[i] = false;
    }
    for (;;) {
        size_t at = graph.count;
        for (size_t i = 0; i < graph.count; i++) {
            if (!graph.done[i] && isfinite(graph.cost[i]) && (at == graph.count || graph.cost[i] < graph.cost[at])) {
                at = i;
            }
        }
        if (at == graph.count || at == 1) {
            return graph.cost[1];
        }
        graph.done[at] = true;
        for (size_t i = 0; i < graph.count; i++) {
            double cost =
                graph.cost[at] + hypot(graph.points[i].x - graph.points[at].x, graph.points[i].y - graph.points[at].y);
            if (!graph.done[i] && cost < graph.cost[i] && is_line_free(graph.points[at], graph.points[i], radius)) {
                graph.cost[i] = cost;
            }
        }
    }
}

static void no_sampled_path_is_shorter(void) {
    unsigned found = 0, none = 0;
    for (uint64_t seed = 101; seed < 101 + SEEDS; seed++) {
        random_world(seed, 7);
        double radius = seed % 3 == 0 ? uniform(1.0, 2.0) : uniform(0.1, 0.7);
        graph.points[0].x = 0.2;
        graph.points[0].y = 0.3;
        graph.points[1].x = 9.7;
        graph.points[1].y = 9.8;
        add_rings(radius);
        double best = length(radius, 0.2, 0.3, 9.7, 9.8), rough = sampled_length(radius);
        TEST_ASSERT_TRUE_MESSAGE(best <= rough + 1e-4, "a sampled path is shorter than the optimum");
        TEST_ASSERT_TRUE_MESSAGE(!isfinite(best) || !isfinite(rough) || rough <= 1.01 * best,
                                 "far above any sampled path");
        found += isfinite(best) && isfinite(rough);
        none += isfinite(best) ? 0U : 1U;
    }
    TEST_ASSERT_TRUE(found >= SEEDS / 4);
    TEST_ASSERT_TRUE(none >= 1);
}

static void there_and_back_are_as_long(void) {
    for (uint64_t seed = 201; seed < 201 + SEEDS; seed++) {
        random_world(seed, 7);
        double radius = uniform(0.0, 0.6), there = length(radius, 0.2, 0.3, 9.7, 9.8);
        double back = length(radius, 9.7, 9.8, 0.2, 0.3);
        TEST_ASSERT_TRUE(there == back || fabs(there - back) < 1e-9);
    }
}

static void a_wider_disc_has_no_shorter_way(void) {
    for (uint64_t seed = 301; seed < 301 + SEEDS; seed++) {
        random_world(seed, 7);
        double before = 0.0;
        for (int i = 0; i < 8; i++) {
            double now = length(0.1 * i, 0.2, 0.3, 9.7, 9.8);
            TEST_ASSERT_TRUE(now >= before - 1e-7);
            before = now;
        }
    }
}

static void one_obstacle_more_makes_no_way_shorter(void) {
    for (uint64_t seed = 401; seed < 401 + SEEDS; seed++) {
        random_world(seed, 7);
        double with = length(0.3, 0.2, 0.3, 9.7, 9.8);
        polygon_count--;
        TEST_ASSERT_TRUE(length(0.3, 0.2, 0.3, 9.7, 9.8) <= with + 1e-7);
    }
}

// The same obstacles told otherwise: twice, backwards, with a vertex on a side, in two halves.
static void the_way_of_telling_an_obstacle_does_not_matter(void) {
    static const double other[][14] = {{6.0, 6.5, 6.0, 3.0, 4.0, 3.0, 4.0, 6.5},
                                       {4.0, 3.0, 5.0, 3.0, 6.0, 3.0, 6.0, 6.5, 6.0, 6.5, 4.0, 6.5, 4.0, 4.0}};
    add_box(4.0, 3.0, 6.0, 6.5);
    double wanted[2] = {length(0.4, 2.0, 5.0, 8.0, 5.0), length(0.0, 2.0, 5.0, 8.0, 5.0)};
    TEST_ASSERT_TRUE(wanted[0] > wanted[1] && wanted[1] > 6.1);
    add_box(4.0, 3.0, 6.0, 6.5);
    expect(wanted[0], 0.4, 2.0, 5.0, 8.0, 5.0);
    expect(wanted[1], 0.0, 2.0, 5.0, 8.0, 5.0);
    for (size_t i = 0; i < 2; i++) {
        polygon_count = 0;
        add(other[i], i == 0 ? 4 : 7);
        expect(wanted[0], 0.4, 2.0, 5.0, 8.0, 5.0);
        expect(wanted[1], 0.0, 2.0, 5.0, 8.0, 5.0);
    }
    for (int overlap = 0; overlap < 2; overlap++) {
        polygon_count = 0;
        add_box(4.0, 3.0, 6.0, 5.5);
        add_box(4.0, overlap ? 4.5 : 5.5, 6.0, 6.5);
        expect(wanted[0], 0.4, 2.0, 5.0, 8.0, 5.0);
    }
    expect(wanted[1], 0.0, 2.0, 5.0, 8.0, 5.0); // the overlap leaves no seam
}

static void a_point_passes_between_polygons_that_touch(void) {
    add_box(4.0, -1.0, 6.0, 5.0);
    add_box(4.0, 5.0, 6.0, 11.0);
    expect(6.0, 0.0, 2.0, 5.0, 8.0, 5.0);
    expect_result(OPTIMUM_NONE, 0.001, 2.0, 5.0, 8.0, 5.0);
}

static void an_upper_bound_changes_nothing_unless_it_is_wrong(void) {
    random_world(7, 7);
    optimum_world *world = optimum_polygons(0.2, bounds, polygons, polygon_count);
    optimum_point start = {0.2, 0.3}, goal = {9.7, 9.8};
    optimum_path free_run = optimum_shortest(world, start, goal, INFINITY);
    TEST_ASSERT_EQUAL(OPTIMUM_FOUND, free_run.result);
    optimum_path bound = optimum_shortest(world, start, goal, free_run.length + 1e-6);
    TEST_ASSERT_EQUAL_DOUBLE(free_run.length, bound.length);
    optimum_path wrong = optimum_shortest(world, start, goal, free_run.length - 1e-6);
    TEST_ASSERT_EQUAL(OPTIMUM_NONE, wrong.result);
    optimum_path_free(&free_run);
    optimum_path_free(&bound);
    optimum_path_free(&wrong);
    optimum_free(world);
}

// Boxes and triangles on whole numbers: sides in line, shared corners, repeated shapes, gaps of just 2 radii.
static void lattice_world(uint64_t seed) {
    state = seed;
    polygon_count = 0;
    while (polygon_count < POLYGONS) {
        double x = floor(uniform(1.0, 9.0)), y = floor(uniform(1.0, 9.0));
        double w = floor(uniform(1.0, 3.0)), h = floor(uniform(1.0, 3.0));
        double xy[8] = {x, y, x + w, y, x + w, y + h, x, y + h};
        add(xy, uniform(0.0, 1.0) < 0.3 ? 3 : 4);
    }
}

static void mirror(void) { // at the diagonal, obstacles in the other order
    for (size_t i = 0; i < polygon_count; i++) {
        for (size_t k = 0; k < polygons[i].count; k++) {
            optimum_point p = corners[i][k];
            corners[i][k].x = p.y;
            corners[i][k].y = p.x;
        }
    }
    for (size_t i = 0; i < polygon_count / 2; i++) {
        optimum_polygon swapped = polygons[i];
        polygons[i] = polygons[polygon_count - 1 - i];
        polygons[polygon_count - 1 - i] = swapped;
    }
}

static void lattice_worlds_give_the_same_from_every_side(void) {
    static const double radii[] = {0.0, 0.5, 1.0};
    unsigned found = 0, none = 0;
    for (uint64_t seed = 601; seed < 601 + 5 * SEEDS; seed++) {
        double radius = radii[seed % 3];
        lattice_world(seed);
        optimum_path path = solve(radius, 0.0, 0.0, 10.0, 9.5);
        if (path.result == OPTIMUM_FOUND) {
            path_is_free_and_as_long_as_told(&path, radius);
        }
        found += path.result == OPTIMUM_FOUND;
        none += path.result == OPTIMUM_NONE;
        double there = path.length, back = length(radius, 10.0, 9.5, 0.0, 0.0);
        mirror();
        double mirrored = length(radius, 0.0, 0.0, 9.5, 10.0);
        TEST_ASSERT_TRUE(there == back || fabs(there - back) < 1e-9);
        TEST_ASSERT_TRUE(there == mirrored || fabs(there - mirrored) < 1e-9);
        optimum_path_free(&path);
    }
    TEST_ASSERT_TRUE(found >= SEEDS);
    TEST_ASSERT_TRUE(none >= 1);
}

// The free space is closed: what just fits is the limit of what fits easily.
static void what_just_fits_is_as_long_as_what_nearly_does(void) {
    for (uint64_t seed = 801; seed < 801 + 5 * SEEDS; seed++) {
        lattice_world(seed);
        double just = length(0.5, 0.0, 0.0, 10.0, 9.5), nearly = length(0.5 - 1e-7, 0.0, 0.0, 10.0, 9.5);
        TEST_ASSERT_TRUE(just == nearly || (nearly <= just && just < nearly + 1e-3));
    }
}

// --- cells ---

enum { WIDTH = 26, HEIGHT = 20 };
static uint8_t occupied[WIDTH * HEIGHT];
static optimum_point squares[WIDTH * HEIGHT][4];
static optimum_polygon cells[WIDTH * HEIGHT];
static const double resolution = 0.25;

static void random_cells(uint64_t seed) {
    state = seed;
    double density = uniform(0.01, 0.12);
    for (size_t i = 0; i < WIDTH * HEIGHT; i++) {
        occupied[i] = uniform(0.0, 1.0) < density;
    }
    occupied[WIDTH + 1] = 0;
    occupied[(HEIGHT - 2) * WIDTH + WIDTH - 2] = 0;
}

static size_t cells_as_polygons(void) {
    size_t n = 0;
    for (size_t i = 0; i < WIDTH * HEIGHT; i++) {
        if (occupied[i]) {
            for (size_t k = 0; k < 4; k++) {
                squares[n][k].x = resolution * ((double)(i % WIDTH) + (k == 1 || k == 2));
                squares[n][k].y = resolution * ((double)(i / WIDTH) + (k >= 2));
            }
            cells[n].points = squares[n];
            cells[n++].count = 4;
        }
    }
    return n;
}

static void cells_and_squares_have_the_same_optimum(void) {
    unsigned found = 0, none = 0;
    for (uint64_t seed = 501; seed < 501 + 10 * SEEDS; seed++) {
        random_cells(seed);
        double radius = uniform(0.5, 3.0) * resolution;
        double shrunk[4] = {radius, radius, WIDTH * resolution - radius, HEIGHT * resolution - radius};
        optimum_world *grid = optimum_grid(radius, resolution, WIDTH, HEIGHT, occupied);
        optimum_world *boxes = optimum_polygons(radius, shrunk, cells, cells_as_polygons());
        optimum_point start = {uniform(0.6, 2.0), uniform(0.6, 2.0)}, goal = {uniform(4.5, 5.9), uniform(3.0, 4.4)};
        optimum_path a = optimum_shortest(grid, start, goal, INFINITY);
        optimum_path b = optimum_shortest(boxes, start, goal, INFINITY);
        TEST_ASSERT_EQUAL(b.result, a.result);
        TEST_ASSERT_TRUE(a.length == b.length || fabs(a.length - b.length) < 1e-8);
        found += a.result == OPTIMUM_FOUND && a.count > 2;
        none += a.result == OPTIMUM_NONE;
        optimum_path_free(&a);
        optimum_path_free(&b);
        optimum_free(grid);
        optimum_free(boxes);
    }
    TEST_ASSERT_TRUE(found >= SEEDS / 4);
    TEST_ASSERT_TRUE(none >= LEAST(1));
}

static optimum_result result_in_cells(double radius, double sx, double sy, double gx, double gy) {
    optimum_world *grid = optimum_grid(radius, resolution, WIDTH, HEIGHT, occupied);
    optimum_point start = {sx, sy}, goal = {gx, gy};
    optimum_path path = optimum_shortest(grid, start, goal, INFINITY);
    optimum_free(grid);
    optimum_path_free(&path);
    return path.result;
}

static void cells_know_walls_insides_and_the_rim(void) {
    memset(occupied, 0, sizeof occupied);
    TEST_ASSERT_EQUAL(OPTIMUM_FOUND, result_in_cells(0.5, 0.5, 0.5, 6.0, 4.5));
    TEST_ASSERT_EQUAL(OPTIMUM_END_OCCUPIED, result_in_cells(0.5, 0.49, 0.5, 6.0, 4.5));
    TEST_ASSERT_EQUAL(OPTIMUM_END_OCCUPIED, result_in_cells(0.5, 0.5, 0.5, 60.0, 4.5));
    for (size_t j = 0; j < HEIGHT - 4; j++) {
        memset(&occupied[j * WIDTH + 8], 1, 9); // x from 2 to 4.25, leaves a metre on top
    }
    TEST_ASSERT_EQUAL(OPTIMUM_END_OCCUPIED, result_in_cells(0.1, 3.125, 1.125, 6.0, 4.5));
    TEST_ASSERT_EQUAL(OPTIMUM_FOUND, result_in_cells(0.5, 1.0, 1.0, 5.9, 1.0));
    TEST_ASSERT_EQUAL(OPTIMUM_NONE, result_in_cells(0.5001, 1.0, 1.0, 5.9, 1.0));
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(an_empty_room_is_crossed_straight);
    RUN_TEST(a_point_obstacle_is_a_circle);
    RUN_TEST(a_half_turn_round_a_circle_runs_over_all_quarters);
    RUN_TEST(a_line_obstacle_turns_a_disc_alone);
    RUN_TEST(a_point_goes_round_a_square_by_its_corners);
    RUN_TEST(a_disc_goes_round_a_square_by_arcs);
    RUN_TEST(a_slit_just_wide_enough_is_a_way_and_a_narrower_one_is_none);
    RUN_TEST(two_circles_that_touch_let_a_disc_through);
    RUN_TEST(an_obstacle_near_an_arc_closes_it);
    RUN_TEST(an_arc_is_used_up_to_where_it_is_closed);
    RUN_TEST(each_side_of_the_bounds_stops_an_arc);
    RUN_TEST(the_bounds_stop_an_arc);
    RUN_TEST(an_end_too_near_an_obstacle_or_outside_is_told);
    RUN_TEST(every_random_path_is_free_and_as_long_as_told);
    RUN_TEST(no_sampled_path_is_shorter);
    RUN_TEST(there_and_back_are_as_long);
    RUN_TEST(a_wider_disc_has_no_shorter_way);
    RUN_TEST(one_obstacle_more_makes_no_way_shorter);
    RUN_TEST(the_way_of_telling_an_obstacle_does_not_matter);
    RUN_TEST(a_point_passes_between_polygons_that_touch);
    RUN_TEST(an_upper_bound_changes_nothing_unless_it_is_wrong);
    RUN_TEST(lattice_worlds_give_the_same_from_every_side);
    RUN_TEST(what_just_fits_is_as_long_as_what_nearly_does);
    RUN_TEST(cells_and_squares_have_the_same_optimum);
    RUN_TEST(cells_know_walls_insides_and_the_rim);
    return UNITY_END();
}
