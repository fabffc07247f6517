// test_verify_fixture.h - worlds, paths and an independent judge for the verifier's tests.
//
// The judge shares nothing with the verifier: long double, libm, arcs by their centre, gaps by brute force over
// segments, dense sampling. Every program that includes this owns one world and one path.
#ifndef AISLE_TEST_VERIFY_FIXTURE_H
#define AISLE_TEST_VERIFY_FIXTURE_H

#include "plan/verify.h"

#include "base/angle.h"
#include "base/crc32.h"
#include "base/rng.h"
#include "unity.h"
#include "wire/codec.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define UNUSED_OK __attribute__((unused)) static
#define GOAL_ID 7
#define SPOTS 20000

// ---- world

typedef struct area { // an obstacle as the judge knows it
    long double v[16][2], box[4];
    int n;
} area;

static aisle_layout world;
static unsigned char world_block[40U << 20];
static aisle_layout_msg world_msg;
static aisle_grid_chunk_msg world_chunk;
static area world_areas[SPOTS];
static int world_count;
static double world_bounds[4]; // x_min, y_min, x_max, y_max
static uint8_t *world_bits;    // one byte a cell; NULL: no scan
static uint32_t world_w, world_h;
static double world_res;

UNUSED_OK void world_begin(double x_min, double y_min, double x_max, double y_max, float resolution) {
    memset(&world_msg, 0, sizeof world_msg);
    world_msg.map_id = 3;
    world_msg.map_revision = 5;
    world_msg.num_parts = 1;
    world_msg.x_min = x_min;
    world_msg.y_min = y_min;
    world_msg.x_max = x_max;
    world_msg.y_max = y_max;
    world_msg.resolution = resolution;
    double bounds[4] = {x_min, y_min, x_max, y_max};
    memcpy(world_bounds, bounds, sizeof bounds);
    world_count = 0;
    free(world_bits);
    world_bits = NULL;
}

static void limits_of(long double (*v)[2], int n, long double *box) {
    box[0] = box[2] = v[0][0];
    box[1] = box[3] = v[0][1];
    for (int i = 1; i < n; i++) {
        box[0] = fminl(box[0], v[i][0]);
        box[1] = fminl(box[1], v[i][1]);
        box[2] = fmaxl(box[2], v[i][0]);
        box[3] = fmaxl(box[3], v[i][1]);
    }
}

static void judge_learns(int n, double (*v)[2]) {
    TEST_ASSERT_LESS_THAN(SPOTS, world_count);
    area *a = &world_areas[world_count++];
    a->n = n;
    for (int i = 0; i < n; i++) {
        a->v[i][0] = (long double)v[i][0];
        a->v[i][1] = (long double)v[i][1];
    }
    limits_of(a->v, n, a->box);
}

// Adds a polygon and returns its id.
UNUSED_OK int32_t world_polygon(int8_t kind, int n, double (*v)[2]) {
    aisle_polygon_msg *p = &world_msg.polygons[world_msg.num_polygons++];
    memset(p, 0, sizeof *p);
    p->id = 100 + world_msg.num_polygons;
    p->kind = kind;
    p->num_vertices = (int16_t)n;
    p->value = kind == AISLE_POLYGON_SPEED_LIMIT ? 0.2F : 0.0F;
    memcpy(p->vertices, v, sizeof(double[2]) * (size_t)n);
    if (kind == AISLE_POLYGON_OBSTACLE || kind == AISLE_POLYGON_KEEPOUT) {
        judge_learns(n, v);
    }
    return p->id;
}

UNUSED_OK int32_t world_box(int8_t kind, double x0, double y0, double x1, double y1) {
    double v[4][2] = {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}};
    return world_polygon(kind, 4, v);
}

// A scan over the whole bounds, all free so far.
UNUSED_OK void world_scan(uint32_t w, uint32_t h) {
    world_w = w;
    world_h = h;
    world_res = (double)(float)((world_bounds[2] - world_bounds[0]) / w);
    world_bits = calloc((size_t)w * h, 1);
}

// Occupies w x h cells.
UNUSED_OK void world_cells(uint32_t ix, uint32_t iy, uint32_t w, uint32_t h) {
    TEST_ASSERT_TRUE(world_bits != NULL && ix + w <= world_w && iy + h <= world_h);
    for (uint32_t i = 0; i < w * h; i++) {
        world_bits[(iy + i / w) * world_w + ix + i % w] = 1;
    }
    double x0 = world_bounds[0] + world_res * ix, x1 = world_bounds[0] + world_res * (ix + w);
    double y0 = world_bounds[1] + world_res * iy, y1 = world_bounds[1] + world_res * (iy + h);
    double v[4][2] = {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}};
    judge_learns(4, v);
}

static void send_tile(uint32_t y0, uint32_t rows, int16_t part, int16_t parts) {
    aisle_refusal why = {0};
    size_t stride = (world_w + 7U) / 8U;
    memset(&world_chunk, 0, sizeof world_chunk);
    world_chunk.map_id = world_msg.map_id;
    world_chunk.map_revision = world_msg.map_revision;
    world_chunk.part = part;
    world_chunk.num_parts = parts;
    world_chunk.origin_x = world_bounds[0];
    world_chunk.origin_y = world_bounds[1];
    world_chunk.resolution = (float)world_res;
    world_chunk.y0 = (int32_t)y0;
    world_chunk.width = (int32_t)world_w;
    world_chunk.height = (int32_t)rows;
    world_chunk.encoding = AISLE_GRID_CHUNK_BITS;
    world_chunk.num_bytes = (int32_t)(stride * rows);
    for (uint32_t y = 0; y < rows; y++) {
        for (uint32_t x = 0; x < world_w; x++) {
            if (world_bits[(y0 + y) * world_w + x] != 0) {
                world_chunk.data[y * stride + x / 8U] |= (uint8_t)(1U << (x % 8U));
            }
        }
    }
    aisle_status status = aisle_layout_take_tile(&world, &world_chunk, &why);
    TEST_ASSERT_TRUE_MESSAGE(status == AISLE_OK || status == AISLE_PARTIAL, "tile refused");
}

static void send_scan(void) {
    uint32_t rows = AISLE_GRID_CHUNK_MAX_BYTES / ((world_w + 7U) / 8U), parts = (world_h + rows - 1) / rows;
    for (uint32_t part = 0; part < parts; part++) {
        uint32_t y0 = part * rows;
        send_tile(y0, world_h - y0 < rows ? world_h - y0 : rows, (int16_t)part, (int16_t)parts);
    }
}

static uint32_t polygons_crc(void) {
    static uint8_t bytes[512];
    uint32_t crc = 0;
    for (int i = 0; i < world_msg.num_polygons; i++) {
        size_t size = 0;
        TEST_ASSERT_EQUAL(AISLE_OK,
                          aisle_msg_encode_body(AISLE_MSG_POLYGON, &world_msg.polygons[i], bytes, sizeof bytes, &size));
        crc = aisle_crc32(crc, bytes, size);
    }
    return crc;
}

UNUSED_OK void world_build(void) {
    aisle_refusal why = {0};
    aisle_limits limits = {.polygons = 828, .vertices = 16384, .open_nodes = 1024, .requests = 1};
    uintptr_t start = ((uintptr_t)world_block + 63U) & ~(uintptr_t)63U;
    double side = world_msg.resolution > 0.0F ? (double)world_msg.resolution : 1.0;
    double cells =
        ((world_bounds[2] - world_bounds[0]) / side + 1.0) * ((world_bounds[3] - world_bounds[1]) / side + 1.0);
    limits.cells = cells > 4096.0 ? (uint32_t)cells : 4096U;
    if (world_bits != NULL) {
        uint32_t rows = AISLE_GRID_CHUNK_MAX_BYTES / ((world_w + 7U) / 8U);
        world_msg.num_grid_chunks = (int16_t)((world_h + rows - 1) / rows);
        limits.cells = world_w * world_h > limits.cells ? world_w * world_h : limits.cells;
    }
    world_msg.total_polygons = world_msg.num_polygons;
    world_msg.crc32 = (int32_t)polygons_crc();
    memset(&world, 0, sizeof world);
    aisle_arena arena = aisle_arena_over((void *)start, sizeof world_block - 64U);
    aisle_layout_carve(&world, &arena, &limits);
    TEST_ASSERT_FALSE(arena.overflow);
    aisle_status status = aisle_layout_take_part(&world, &world_msg, &why);
    TEST_ASSERT_TRUE_MESSAGE(status == AISLE_OK || status == AISLE_PARTIAL, "layout refused");
    if (world_bits != NULL) {
        send_scan();
    }
    TEST_ASSERT_TRUE(aisle_layout_is_staged(&world));
    aisle_layout_commit(&world);
    while (aisle_layout_build(&world, 100000) == AISLE_BUSY) {
    }
    TEST_ASSERT_TRUE(aisle_layout_is_in_force(&world));
}

// ---- vehicle

static aisle_vehicle vehicle;

UNUSED_OK void vehicle_from(aisle_vehicle_msg *msg) {
    aisle_refusal why = {0};
    msg->vehicle_revision = 11;
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_vehicle_from_msg(msg, &vehicle, &why));
}

UNUSED_OK void vehicle_disc(double radius) {
    static aisle_vehicle_msg msg;
    memset(&msg, 0, sizeof msg);
    msg.footprint_radius = (float)radius;
    vehicle_from(&msg);
}

// Box from -back to front and half the width to both sides, rounded.
UNUSED_OK void vehicle_box(double back, double front, double width, double radius) {
    static aisle_vehicle_msg msg;
    memset(&msg, 0, sizeof msg);
    double v[4][2] = {{-back, -0.5 * width}, {front, -0.5 * width}, {front, 0.5 * width}, {-back, 0.5 * width}};
    memcpy(msg.footprint, v, sizeof v);
    msg.num_vertices = 4;
    msg.footprint_radius = (float)radius;
    vehicle_from(&msg);
}

// ---- path

static aisle_path_msg path;
static uint8_t path_bytes[AISLE_MSG_DATAGRAM_MAX];
static size_t path_size;
static aisle_goal_msg path_goal;
static long double pen_x, pen_y, pen_theta;
static int16_t pen_flags; // of pieces drawn from now on, e.g. REVERSE

static double wrapped(long double a) {
    return aisle_angle_wrap((double)remainderl(a, 2.0L * acosl(-1.0L)));
}

static aisle_waypoint_msg *last_waypoint(void) {
    return &path.waypoints[path.num_waypoints - 1];
}

static void drop_waypoint(float curvature, int16_t flags) {
    aisle_waypoint_msg *w = &path.waypoints[path.num_waypoints++];
    memset(w, 0, sizeof *w);
    w->x = (double)pen_x;
    w->y = (double)pen_y;
    w->theta = wrapped(pen_theta);
    w->curvature = curvature;
    w->clearance = 1.0F;
    w->flags = flags;
}

UNUSED_OK void path_begin(double x, double y, double theta) {
    memset(&path, 0, sizeof path);
    pen_x = (long double)x;
    pen_y = (long double)y;
    pen_theta = (long double)theta;
    pen_flags = 0;
    drop_waypoint(0.0F, 0);
}

static long double course(void) {
    return (pen_flags & AISLE_WAYPOINT_REVERSE) != 0 ? pen_theta + acosl(-1.0L) : pen_theta;
}

UNUSED_OK void path_line(double length) {
    pen_x += (long double)length * cosl(course());
    pen_y += (long double)length * sinl(course());
    drop_waypoint(0.0F, pen_flags);
}

// Arc of curvature k (signed) that turns by `angle` > 0.
UNUSED_OK void path_arc(double k, double angle) {
    long double kf = (long double)(float)k, turn = k < 0.0 ? -(long double)angle : (long double)angle;
    pen_x += (sinl(course() + turn) - sinl(course())) / kf;
    pen_y -= (cosl(course() + turn) - cosl(course())) / kf;
    pen_theta += turn;
    drop_waypoint((float)kf, pen_flags);
}

UNUSED_OK void path_turn(double angle) {
    last_waypoint()->flags |= AISLE_WAYPOINT_TURN_IN_PLACE;
    pen_theta += (long double)angle;
    drop_waypoint(0.0F, 0);
}

// A piece as the judge sees it.
typedef struct stretch {
    long double x, y, theta, turn; // first end
    long double cx, cy, r, from;   // centre, radius, polar angle of the first end; r = 0: line
    long double dx, dy, sweep;     // to the last end; signed angle on the arc
    long double length;
} stretch;

static stretch stretch_between(const aisle_waypoint_msg *a, const aisle_waypoint_msg *b) {
    const long double pi = acosl(-1.0L), k = (long double)b->curvature;
    stretch s = {.x = (long double)a->x, .y = (long double)a->y, .theta = (long double)a->theta};
    s.turn = remainderl((long double)b->theta - (long double)a->theta, 2.0L * pi);
    s.dx = (long double)b->x - s.x;
    s.dy = (long double)b->y - s.y;
    long double chord = hypotl(s.dx, s.dy);
    s.length = chord;
    if ((a->flags & AISLE_WAYPOINT_TURN_IN_PLACE) != 0 || !(fabsl(k) > 0.0L)) {
        return s;
    }
    long double radius = fmaxl(1.0L / fabsl(k), 0.5L * chord), side = k > 0.0L ? 1.0L : -1.0L;
    long double height = sqrtl(fmaxl(radius * radius - 0.25L * chord * chord, 0.0L));
    s.r = radius;
    s.cx = s.x + 0.5L * s.dx - side * height * s.dy / chord;
    s.cy = s.y + 0.5L * s.dy + side * height * s.dx / chord;
    s.from = atan2l(s.y - s.cy, s.x - s.cx);
    s.sweep = side * 2.0L * asinl(fminl(1.0L, 0.5L * chord / radius));
    s.length = radius * fabsl(s.sweep);
    return s;
}

static stretch stretch_at(int i) {
    return stretch_between(&path.waypoints[i - 1], &path.waypoints[i]);
}

static void stretch_pose(const stretch *s, long double u, long double *pose) {
    pose[0] = s->r > 0.0L ? s->cx + s->r * cosl(s->from + u * s->sweep) : s->x + u * s->dx;
    pose[1] = s->r > 0.0L ? s->cy + s->r * sinl(s->from + u * s->sweep) : s->y + u * s->dy;
    pose[2] = s->theta + u * s->turn;
}

static double trapezoid_seconds(double way, double v, double up, double down) {
    double ramps = v * v / (2.0 * up) + v * v / (2.0 * down);
    if (ramps >= way) {
        double peak = sqrt(2.0 * way * up * down / (up + down));
        return peak / up + peak / down;
    }
    return (way - ramps) / v + v / up + v / down;
}

// Fills s, t, a and the sums for the v that stand; both ends at rest: trapezoid with this peak.
UNUSED_OK void path_retime(double peak) {
    double s = 0.0, t = 0.0, dwell = 0.0;
    float clearance = 1e6F;
    for (int i = 0; i < path.num_waypoints; i++) {
        aisle_waypoint_msg *w = &path.waypoints[i];
        if (i > 0) {
            const stretch piece = stretch_at(i);
            double v0 = (double)w[-1].v, v1 = (double)w->v, length = (double)piece.length;
            bool turn = (w[-1].flags & AISLE_WAYPOINT_TURN_IN_PLACE) != 0;
            double dt = turn ? trapezoid_seconds(fabs((double)piece.turn), vehicle.omega_max, vehicle.alpha_max,
                                                 vehicle.alpha_max)
                             : (v0 + v1 > 0.0 ? 2.0 * length / (v0 + v1)
                                              : trapezoid_seconds(length, peak, vehicle.a_max, vehicle.d_max));
            w->a = turn || !(v0 + v1 > 0.0) ? 0.0F : (float)((v1 * v1 - v0 * v0) / (2.0 * length));
            s += turn ? 0.0 : length;
            t += (dt > 1e-3 ? dt : 1e-3) + dwell;
        }
        w->s = (float)s;
        w->t = (float)t;
        dwell = (w->flags & AISLE_WAYPOINT_GOAL) != 0 && w->goal_id == path_goal.id ? (double)path_goal.dwell : 0.0;
        clearance = w->clearance < clearance ? w->clearance : clearance;
    }
    path.length = (float)s;
    path.duration = (float)t;
    path.clearance_min = clearance;
}

// Numbers of the header and encoding; the certificate as the contract words it.
UNUSED_OK void path_seal(void) {
    path.utime = 1000;
    path.valid_until_utime = 2000;
    path.path_revision = 21;
    path.query_id = 22;
    path.goal_list_id = 23;
    path.goal_list_revision = 24;
    path.map_id = world_msg.map_id;
    path.map_revision = world_msg.map_revision;
    path.vehicle_revision = vehicle.revision;
    path.certificate = (int32_t)aisle_path_certificate(&path);
    path_size = 0;
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_msg_encode(AISLE_MSG_PATH, &path, path_bytes, sizeof path_bytes, &path_size));
}

// Ends at the goal, every piece from rest to rest with a peak of at most the creep speed.
UNUSED_OK void path_end(void) {
    aisle_waypoint_msg *w = last_waypoint();
    w->flags |= AISLE_WAYPOINT_GOAL | AISLE_WAYPOINT_STOP;
    w->goal_id = GOAL_ID;
    path_goal = (aisle_goal_msg){.id = GOAL_ID, .x = w->x, .y = w->y, .theta = w->theta};
    double peak = vehicle.creep_speed;
    for (int i = 1; i < path.num_waypoints; i++) {
        double k = fabs((double)path.waypoints[i].curvature);
        peak = k > 0.0 ? fmin(peak, fmin(sqrt(vehicle.lateral_a_max / k), vehicle.omega_max / k)) : peak;
        peak = (path.waypoints[i].flags & AISLE_WAYPOINT_REVERSE) != 0 ? fmin(peak, vehicle.v_reverse_max) : peak;
    }
    path_retime(peak);
    path_seal();
}

// Speeds up to v, as fast as the accelerations let it; then seals.
UNUSED_OK void path_drive(double v) {
    int n = path.num_waypoints;
    for (int i = 0; i < n; i++) {
        path.waypoints[i].v = (float)v;
    }
    path.waypoints[0].v = 0.0F;
    path.waypoints[n - 1].v = 0.0F;
    for (int i = 1; i < n; i++) {
        double v0 = (double)path.waypoints[i - 1].v,
               most = sqrt(v0 * v0 + vehicle.a_max * 2.0 * (double)stretch_at(i).length);
        path.waypoints[i].v = (float)fmin((double)path.waypoints[i].v, most);
    }
    for (int i = n - 1; i > 0; i--) {
        double v1 = (double)path.waypoints[i].v,
               most = sqrt(v1 * v1 + vehicle.d_max * 2.0 * (double)stretch_at(i).length);
        path.waypoints[i - 1].v = (float)fmin((double)path.waypoints[i - 1].v, most);
    }
    path_retime(v);
    path_seal();
}

static bool turns_at(int i) {
    return (path.waypoints[i].flags & AISLE_WAYPOINT_TURN_IN_PLACE) != 0;
}

static bool reverses_at(int i) {
    return i > 0 && i + 1 < path.num_waypoints &&
           ((path.waypoints[i].flags ^ path.waypoints[i + 1].flags) & AISLE_WAYPOINT_REVERSE) != 0;
}

// Speeds well below every limit, so that others may be tried: at most v (backwards 0.2), 0.7 of the accelerations. What is
// at rest at both ends is driven with all of them, to 0.2 m/s.
UNUSED_OK void path_drive_gently(double v) {
    const int n = path.num_waypoints;
    for (int i = 0; i < n; i++) {
        const bool rests = i == 0 || i + 1 == n || turns_at(i) || turns_at(i - 1) || reverses_at(i);
        const bool back =
            ((path.waypoints[i].flags | path.waypoints[i + 1 < n ? i + 1 : i].flags) & AISLE_WAYPOINT_REVERSE) != 0;
        path.waypoints[i].v = rests ? 0.0F : (float)(back ? fmin(v, 0.2) : v);
    }
    for (int i = 1; i < n; i++) {
        const double v0 = (double)path.waypoints[i - 1].v, most = sqrt(v0 * v0 + 0.7 * (double)stretch_at(i).length);
        path.waypoints[i].v = (float)fmin((double)path.waypoints[i].v, most);
    }
    for (int i = n - 1; i > 0; i--) {
        const double v1 = (double)path.waypoints[i].v, most = sqrt(v1 * v1 + 0.7 * (double)stretch_at(i).length);
        path.waypoints[i - 1].v = (float)fmin((double)path.waypoints[i - 1].v, most);
    }
    path_retime(0.2);
    path_seal();
}

// ---- running the verifier

static aisle_verify verify;
static aisle_path_msg verify_scratch;
static aisle_stamp stamp;
static uint32_t spent;

UNUSED_OK aisle_verify_request usual_request(void) {
    const aisle_waypoint_msg *w = &path.waypoints[0];
    return (aisle_verify_request){.layout = &world,
                                  .vehicle = &vehicle,
                                  .bytes = path_bytes,
                                  .size = path_size,
                                  .start = {w->x, w->y, w->theta},
                                  .goals = &path_goal,
                                  .num_goals = 1};
}

UNUSED_OK aisle_status verify_request(const aisle_verify_request *request, uint32_t units) {
    aisle_status status;
    spent = 0;
    aisle_verify_start(&verify, request, &verify_scratch);
    do {
        uint32_t before = spent;
        stamp = (aisle_stamp){1, 1};
        status = aisle_verify_step(&verify, units, &spent, &stamp);
        TEST_ASSERT_TRUE(status == AISLE_BUSY ? spent - before == units : spent - before <= units);
        TEST_ASSERT_TRUE(status == AISLE_OK ? stamp.size > 0 : stamp.size == 0 && stamp.digest == 0);
    } while (status == AISLE_BUSY);
    TEST_ASSERT_TRUE(status == AISLE_OK ? verify.fault == AISLE_VERIFY_NONE
                                        : status == AISLE_ERR_DATA && verify.fault != AISLE_VERIFY_NONE);
    return status;
}

UNUSED_OK aisle_verify_fault verified(void) {
    aisle_verify_request request = usual_request();
    (void)verify_request(&request, UINT32_MAX);
    return verify.fault;
}

// ---- the judge

static long double point_to_segment(const long double *p, const long double *a, const long double *b) { // squared
    long double dx = b[0] - a[0], dy = b[1] - a[1], px = p[0] - a[0], py = p[1] - a[1];
    long double square = dx * dx + dy * dy, t = px * dx + py * dy;
    if (t <= 0.0L || !(square > 0.0L)) {
        return px * px + py * py;
    }
    t = t < square ? t / square : 1.0L;
    return (px - t * dx) * (px - t * dx) + (py - t * dy) * (py - t * dy);
}

static long double side_of(const long double *a, const long double *b, const long double *p) {
    return (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]);
}

static bool holds_point(long double (*v)[2], int n, const long double *p) {
    for (int i = 0; n > 2 && i < n; i++) {
        if (side_of(v[i], v[(i + 1) % n], p) < 0.0L) {
            return false;
        }
    }
    return n > 2;
}

static bool segments_cross(const long double *a, const long double *b, const long double *c, const long double *d) {
    return side_of(a, b, c) * side_of(a, b, d) < 0.0L && side_of(c, d, a) * side_of(c, d, b) < 0.0L;
}

static long double areas_gap(long double (*v)[2], int n, long double (*w)[2], int m) {
    if (holds_point(w, m, v[0]) || holds_point(v, n, w[0])) {
        return 0.0L;
    }
    long double gap = 1e9L;
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < m; j++) {
            const long double *a = v[i], *b = v[(i + 1) % n], *c = w[j], *d = w[(j + 1) % m];
            if (segments_cross(a, b, c, d)) {
                return 0.0L;
            }
            long double square = fminl(point_to_segment(a, c, d), point_to_segment(c, a, b));
            gap = square < gap ? square : gap;
        }
    }
    return sqrtl(gap);
}

static int nearest_area; // of the pose before: looked at first, so that the boxes of the others are mostly too far away

static bool boxes_are_within(const long double *a, const long double *b, long double gap) {
    long double dx = a[0] > b[2] ? a[0] - b[2] : (b[0] > a[2] ? b[0] - a[2] : 0.0L);
    long double dy = a[1] > b[3] ? a[1] - b[3] : (b[1] > a[3] ? b[1] - a[3] : 0.0L);
    return dx * dx + dy * dy < gap * gap;
}

// Gap between the footprint at a pose and everything that stands; negative: that deep out of the bounds.
static long double pose_gap(const long double *pose) {
    long double v[16][2] = {{0.0L}}, box[4], c = cosl(pose[2]), s = sinl(pose[2]);
    int n = (int)vehicle.n, first = nearest_area < world_count ? nearest_area : 0;
    for (int i = 0; i < n; i++) {
        long double x = (long double)vehicle.footprint[i].x, y = (long double)vehicle.footprint[i].y;
        v[i][0] = pose[0] + c * x - s * y;
        v[i][1] = pose[1] + s * x + c * y;
    }
    limits_of(v, n, box);
    long double gap = fminl(fminl(box[0] - (long double)world_bounds[0], box[1] - (long double)world_bounds[1]),
                            fminl((long double)world_bounds[2] - box[2], (long double)world_bounds[3] - box[3]));
    for (int i = 0; i < world_count; i++) {
        int at = i == 0 ? first : (i <= first ? i - 1 : i); // the first one, then the rest
        area *a = &world_areas[at];
        if (gap > 0.0L && boxes_are_within(box, a->box, gap)) {
            long double other = areas_gap(v, n, a->v, a->n);
            nearest_area = other < gap ? at : nearest_area;
            gap = fminl(gap, other);
        }
    }
    return gap - (long double)vehicle.radius;
}

static long double lever_arm(void) {
    long double lever = 0.0L;
    for (uint32_t i = 0; i < vehicle.n; i++) {
        lever = fmaxl(lever, hypotl((long double)vehicle.footprint[i].x, (long double)vehicle.footprint[i].y));
    }
    return lever;
}

// Lowers *least to the least gap on the piece, at most `within` (m) above the true one: halves intervals until half of
// what any body point moves in one cannot take the gap at its middle below *least by more.
static void judge_stretch(const stretch *s, long double within, long double *least) {
    long double from[64], to[64], pose[3], rate = s->length + lever_arm() * fabsl(s->turn);
    int n = 1;
    from[0] = 0.0L;
    to[0] = 1.0L;
    while (n > 0 && *least > 0.0L) {
        long double lo = from[--n], hi = to[n], middle = 0.5L * (lo + hi);
        stretch_pose(s, middle, pose);
        long double gap = pose_gap(pose);
        *least = fminl(*least, gap);
        if (gap - 0.5L * (hi - lo) * rate < *least - within) {
            TEST_ASSERT_LESS_THAN(62, n);
            from[n] = lo;
            to[n++] = middle;
            from[n] = middle;
            to[n++] = hi;
        }
    }
}

// Least gap (m) along the whole path, at most `within` above the true one; 0 or less as soon as something is hit.
UNUSED_OK double judge_gap(double within) {
    const aisle_waypoint_msg *w = &path.waypoints[0];
    long double pose[3] = {(long double)w->x, (long double)w->y, (long double)w->theta};
    long double least = pose_gap(pose);
    for (int i = 1; i < path.num_waypoints && least > 0.0L; i++) {
        const stretch s = stretch_at(i);
        for (int at = 0; at <= 32 && least > 0.0L; at++) { // a good first guess leaves little to search
            stretch_pose(&s, (long double)at / 32.0L, pose);
            least = fminl(least, pose_gap(pose));
        }
        judge_stretch(&s, (long double)within, &least);
    }
    return (double)least;
}

// ---- random numbers

static aisle_rng dice;

UNUSED_OK double uniform(double lo, double hi) {
    return lo + (hi - lo) * (double)aisle_rng_float(&dice);
}
UNUSED_OK int below(int n) {
    return (int)aisle_rng_below(&dice, (uint32_t)n);
}
#endif
