// hall.h - test fixture: a hall with boxes or a scanned map, a vehicle, and an independent judge of gaps.
//
// The judge is brute force in long double over the boxes' corners and edges, sharing nothing with src/.
#ifndef AISLE_TESTS_HALL_H
#define AISLE_TESTS_HALL_H

#include "base/arena.h"
#include "base/crc32.h"
#include "base/rng.h"
#include "robot/vehicle.h"
#include "unity.h"
#include "wire/codec.h"
#include "world/layout.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

#define HALL_UNUSED __attribute__((unused)) static
#define HALL_BOXES_MAX 64
#define HALL_ONE_WAYS_MAX 8
#define HALL_BLOCK (32U << 20)

typedef struct hall_box {
    double x0, y0, x1, y1;
} hall_box;

static hall_box hall_boxes[HALL_BOXES_MAX];
static int hall_count;
static hall_box hall_one_ways[HALL_ONE_WAYS_MAX]; // DIRECTED zones, behind the boxes in the message
static double hall_directions[HALL_ONE_WAYS_MAX];
static int hall_one_way_count;
static double hall_width, hall_height;
static aisle_layout hall_layout;
static aisle_layout_msg hall_msg;
static aisle_vehicle hall_vehicle;
static const aisle_limits hall_limits = {
    .cells = 1048576U, .polygons = 256U, .vertices = 2048U, .open_nodes = 131072U, .requests = 4U};

// One block for everything a test carves, zeroed by the arena; the next call takes it over.
HALL_UNUSED aisle_arena hall_arena(size_t bytes) {
    static unsigned char block[HALL_BLOCK + AISLE_ARENA_ALIGN];
    TEST_ASSERT_TRUE(bytes <= HALL_BLOCK);
    size_t off = (AISLE_ARENA_ALIGN - (uintptr_t)block % AISLE_ARENA_ALIGN) % AISLE_ARENA_ALIGN;
    return aisle_arena_over(block + off, bytes);
}

HALL_UNUSED void hall_begin(double width, double height) {
    hall_count = hall_one_way_count = 0;
    hall_width = width;
    hall_height = height;
}

HALL_UNUSED void hall_add(double x0, double y0, double x1, double y1) {
    TEST_ASSERT_LESS_THAN(HALL_BOXES_MAX, hall_count);
    hall_boxes[hall_count++] = (hall_box){x0, y0, x1, y1};
}

HALL_UNUSED void hall_one_way(double direction, double x0, double y0, double x1, double y1) {
    TEST_ASSERT_LESS_THAN(HALL_ONE_WAYS_MAX, hall_one_way_count);
    hall_directions[hall_one_way_count] = direction;
    hall_one_ways[hall_one_way_count++] = (hall_box){x0, y0, x1, y1};
}

// The hall as a message: box i has id i + 1.
HALL_UNUSED const aisle_layout_msg *hall_message(int32_t revision, float resolution);

// Puts a layout of one part in force; carves hall_layout from the arena first.
HALL_UNUSED void hall_open_message(aisle_arena *arena, const aisle_layout_msg *msg) {
    memset(&hall_layout, 0, sizeof hall_layout);
    aisle_layout_carve(&hall_layout, arena, &hall_limits);
    TEST_ASSERT_FALSE(arena->overflow);
    aisle_refusal why;
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_layout_take_part(&hall_layout, msg, &why));
    aisle_layout_commit(&hall_layout);
    while (aisle_layout_build(&hall_layout, 1000) == AISLE_BUSY) {
    }
    TEST_ASSERT_TRUE(aisle_layout_is_in_force(&hall_layout));
}

// Puts the boxes in force.
HALL_UNUSED void hall_open(aisle_arena *arena, float resolution) {
    hall_open_message(arena, hall_message(1, resolution));
}

HALL_UNUSED void hall_disc(double radius, float margin) {
    aisle_vehicle_msg msg = {.vehicle_revision = 1, .footprint_radius = (float)radius, .margin = margin};
    aisle_refusal why;
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_vehicle_from_msg(&msg, &hall_vehicle, &why));
}

HALL_UNUSED void hall_rectangle(double length, double width, float margin) {
    aisle_vehicle_msg msg = {.vehicle_revision = 1, .num_vertices = 4, .margin = margin};
    const double v[4][2] = {
        {-length / 2, -width / 2}, {length / 2, -width / 2}, {length / 2, width / 2}, {-length / 2, width / 2}};
    memcpy(msg.footprint, v, sizeof v);
    aisle_refusal why;
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_vehicle_from_msg(&msg, &hall_vehicle, &why));
}

// ---- draws

HALL_UNUSED double uniform(aisle_rng *rng, double lo, double hi) {
    return lo + (hi - lo) * (double)aisle_rng_float(rng);
}

// x before y: the order in which a call's arguments are computed is the compiler's.
HALL_UNUSED aisle_vec2 uniform_point(aisle_rng *rng, aisle_vec2 lo, aisle_vec2 hi) {
    double x = uniform(rng, lo.x, hi.x);
    double y = uniform(rng, lo.y, hi.y);
    return aisle_vec2_of(x, y);
}

// ---- judge

static long double hall_point_box(long double x, long double y, const hall_box *b) {
    long double dx = fmaxl(fmaxl((long double)b->x0 - x, x - (long double)b->x1), 0.0L);
    long double dy = fmaxl(fmaxl((long double)b->y0 - y, y - (long double)b->y1), 0.0L);
    return hypotl(dx, dy);
}

// Gap of a disc (negative: overlap) to the nearest box or wall.
HALL_UNUSED long double hall_disc_gap(double x, double y, double radius) {
    long double lx = (long double)x;
    long double ly = (long double)y;
    long double gap = fminl(fminl(lx, ly), fminl((long double)hall_width - lx, (long double)hall_height - ly));
    for (int i = 0; i < hall_count; i++) {
        gap = fminl(gap, hall_point_box(lx, ly, &hall_boxes[i]));
    }
    return gap - (long double)radius;
}

static double hall_point_segment(aisle_vec2 p, aisle_vec2 a, aisle_vec2 b) {
    double dx = b.x - a.x;
    double dy = b.y - a.y;
    double square = dx * dx + dy * dy;
    double t = square > 0.0 ? ((p.x - a.x) * dx + (p.y - a.y) * dy) / square : 0.0;
    t = t < 0.0 ? 0.0 : (t > 1.0 ? 1.0 : t);
    return hypot(p.x - a.x - t * dx, p.y - a.y - t * dy);
}

static bool hall_crosses(aisle_vec2 a, aisle_vec2 b, aisle_vec2 c, aisle_vec2 d) {
    double s1 = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
    double s2 = (b.x - a.x) * (d.y - a.y) - (b.y - a.y) * (d.x - a.x);
    double s3 = (d.x - c.x) * (a.y - c.y) - (d.y - c.y) * (a.x - c.x);
    double s4 = (d.x - c.x) * (b.y - c.y) - (d.y - c.y) * (b.x - c.x);
    return s1 * s2 < 0.0 && s3 * s4 < 0.0;
}

// Gap of one edge of the footprint to a box's edges; negative where they cross or the edge lies inside.
static double hall_edge_box(aisle_vec2 a, aisle_vec2 b, const hall_box *box) {
    const aisle_vec2 corner[4] = {{box->x0, box->y0}, {box->x1, box->y0}, {box->x1, box->y1}, {box->x0, box->y1}};
    if (a.x > box->x0 && a.x < box->x1 && a.y > box->y0 && a.y < box->y1) {
        return -1.0;
    }
    double least = 1e9;
    for (int i = 0; i < 4; i++) {
        aisle_vec2 c = corner[i];
        aisle_vec2 d = corner[(i + 1) % 4];
        if (hall_crosses(a, b, c, d)) {
            return -1.0;
        }
        least = fmin(least, fmin(hall_point_segment(a, c, d), hall_point_segment(b, c, d)));
        least = fmin(least, fmin(hall_point_segment(c, a, b), hall_point_segment(d, a, b)));
    }
    return least;
}

// Gap of the vehicle's footprint to the nearest box or wall, edge by edge. A box wholly inside the footprint is not
// seen; the tests' boxes are too large for that.
HALL_UNUSED double hall_body_gap(aisle_pose2 pose) {
    const aisle_vehicle *v = &hall_vehicle;
    double c = cos(pose.theta);
    double s = sin(pose.theta);
    double least = 1e9;
    for (uint32_t i = 0; i < v->n; i++) {
        aisle_vec2 p = v->footprint[i];
        aisle_vec2 q = v->footprint[(i + 1U) % v->n];
        aisle_vec2 a = {pose.x + c * p.x - s * p.y, pose.y + s * p.x + c * p.y};
        aisle_vec2 b = {pose.x + c * q.x - s * q.y, pose.y + s * q.x + c * q.y};
        least = fmin(least, fmin(fmin(a.x, a.y), fmin(hall_width - a.x, hall_height - a.y)));
        for (int k = 0; k < hall_count; k++) {
            least = fmin(least, hall_edge_box(a, b, &hall_boxes[k]));
        }
    }
    return least - v->radius;
}

// Does a short step of the origin from a to b obey the zones, by its middle?
HALL_UNUSED bool hall_step_obeys(double ax, double ay, double bx, double by) {
    const double x = 0.5 * (ax + bx), y = 0.5 * (ay + by), step = hypot(bx - ax, by - ay);
    for (int i = 0; i < hall_one_way_count; i++) {
        const hall_box *z = &hall_one_ways[i];
        const double along = (bx - ax) * cos(hall_directions[i]) + (by - ay) * sin(hall_directions[i]);
        if (x > z->x0 && x < z->x1 && y > z->y0 && y < z->y1 && along < -2e-3 * step) {
            return false;
        }
    }
    return true;
}

// Count and checksum of a layout of one part whose polygons were changed.
HALL_UNUSED void hall_seal(aisle_layout_msg *msg) {
    uint32_t crc = 0;
    msg->total_polygons = msg->num_polygons;
    for (int16_t i = 0; i < msg->num_polygons; i++) {
        uint8_t bytes[512];
        size_t size = 0;
        TEST_ASSERT_EQUAL(AISLE_OK,
                          aisle_msg_encode_body(AISLE_MSG_POLYGON, &msg->polygons[i], bytes, sizeof bytes, &size));
        crc = aisle_crc32(crc, bytes, size);
    }
    msg->crc32 = (int32_t)crc;
}

HALL_UNUSED const aisle_layout_msg *hall_message(int32_t revision, float resolution) {
    memset(&hall_msg, 0, sizeof hall_msg);
    hall_msg.map_id = 1;
    hall_msg.map_revision = revision;
    hall_msg.num_parts = 1;
    hall_msg.x_max = hall_width;
    hall_msg.y_max = hall_height;
    hall_msg.resolution = resolution;
    hall_msg.num_polygons = (int16_t)(hall_count + hall_one_way_count);
    for (int i = 0; i < hall_msg.num_polygons; i++) {
        const hall_box *b = i < hall_count ? &hall_boxes[i] : &hall_one_ways[i - hall_count];
        const double v[4][2] = {{b->x0, b->y0}, {b->x1, b->y0}, {b->x1, b->y1}, {b->x0, b->y1}};
        aisle_polygon_msg *polygon = &hall_msg.polygons[i];
        polygon->id = i + 1;
        polygon->num_vertices = 4;
        memcpy(polygon->vertices, v, sizeof v);
        if (i >= hall_count) {
            polygon->kind = AISLE_POLYGON_DIRECTED;
            polygon->direction = (float)hall_directions[i - hall_count];
        }
    }
    hall_seal(&hall_msg);
    return &hall_msg;
}
#endif
