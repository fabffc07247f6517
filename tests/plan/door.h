// door.h - test fixture: one planner behind its public door, everything that came out of it, and a judge of paths.
//
// The judge walks the waypoints by waypoint_t's convention (arcs by their centre, libm) in steps of at most 1 cm and
// half a degree and measures the footprint with hall.h's brute force: nothing of src/ but the codec takes part.
#ifndef AISLE_TESTS_DOOR_H
#define AISLE_TESTS_DOOR_H

#include "aisle/planner.h"
#include "hall.h"

#define DOOR_LOG (4U << 20)

static unsigned char door_block[2][(40U << 20) + 64U]; // two planners side by side
static aisle_config door_config;
static aisle_planner *door;
static int64_t door_now;
static uint32_t door_units; // of one step
static bool door_pull;      // pull events after each step

static uint8_t door_log[DOOR_LOG]; // every event's bytes, one behind the other
static size_t door_log_size;
static aisle_path_msg door_path, door_reply; // the last ones
static uint8_t door_path_bytes[65536], door_path_before[65536];
static size_t door_path_size, door_path_before_size;
static int door_paths, door_replies; // events

static const double DOOR_PI = 3.14159265358979323846;

HALL_UNUSED void door_forget(void) {
    door_log_size = 0;
    door_paths = door_replies = 0;
    memset(&door_path, 0, sizeof door_path);
    memset(&door_reply, 0, sizeof door_reply);
}

// A planner in block 0 or 1; config as it stands.
HALL_UNUSED void door_open(int which) {
    unsigned char *at = door_block[which] + (AISLE_PLANNER_ALIGN - (uintptr_t)door_block[which] % AISLE_PLANNER_ALIGN) %
                                                AISLE_PLANNER_ALIGN;
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_planner_init(at, 40U << 20, &door_config, &door));
    door_now = 1000000;
    door_units = 20000;
    door_pull = true;
    door_forget();
}

static void door_pull_events(void) {
    aisle_event event;
    while (aisle_planner_next_event(door, &event)) {
        bool reply = event.kind == AISLE_EVENT_REPLY;
        aisle_path_msg *path = reply ? &door_reply : &door_path;
        TEST_ASSERT_EQUAL(AISLE_OK, aisle_msg_decode(AISLE_MSG_PATH, event.bytes, event.size, path, NULL));
        TEST_ASSERT_TRUE(door_log_size + event.size <= DOOR_LOG);
        memcpy(door_log + door_log_size, event.bytes, event.size);
        door_log_size += event.size;
        *(reply ? &door_replies : &door_paths) += 1;
        if (!reply) {
            memcpy(door_path_before, door_path_bytes, door_path_size);
            door_path_before_size = door_path_size;
            memcpy(door_path_bytes, event.bytes, event.size);
            door_path_size = event.size;
        }
    }
}

// Steps until the planner is idle; the time stands still.
HALL_UNUSED void door_settle(void) {
    long steps = 0;
    while (aisle_planner_step(door, door_now, door_units) == AISLE_BUSY) {
        if (door_pull) {
            door_pull_events();
        }
        TEST_ASSERT_LESS_THAN_INT(20000000, ++steps);
    }
}

HALL_UNUSED aisle_status door_submit(aisle_input_kind kind, const void *msg) {
    aisle_input input = {.kind = kind, .as.layout = (const aisle_layout_msg *)msg};
    return aisle_planner_submit(door, door_now, &input);
}

// Lets time pass in steps of 50 ms, with a fresh pose each if there is one to repeat.
HALL_UNUSED void door_wait(int64_t us, aisle_pose_msg *pose) {
    for (int64_t end = door_now + us; door_now < end;) {
        door_now += 50000;
        if (pose != NULL) {
            pose->utime = door_now;
            pose->seq++;
            TEST_ASSERT_EQUAL(AISLE_OK, door_submit(AISLE_INPUT_POSE, pose));
        }
        door_settle();
    }
}

HALL_UNUSED aisle_status door_layout(int32_t revision) {
    return door_submit(AISLE_INPUT_LAYOUT, hall_message(revision, 0.05F));
}

HALL_UNUSED aisle_pose_msg door_pose(double x, double y, double theta) {
    return (aisle_pose_msg){.utime = door_now, .map_id = 1, .x = x, .y = y, .theta = theta, .localized = 1};
}

HALL_UNUSED aisle_query_msg door_query(int32_t id, double x0, double y0, double x1, double y1) {
    aisle_query_msg query = {.query_id = id, .map_id = 1, .num_goals = 1};
    query.options.planner = AISLE_OPTIONS_ASTAR;
    query.start = (aisle_goal_msg){.x = x0, .y = y0, .tolerance_theta = 4.0F};
    query.goals[0] = (aisle_goal_msg){.id = 11, .x = x1, .y = y1, .tolerance_theta = 4.0F};
    return query;
}

HALL_UNUSED aisle_goal_list_msg door_goals(int32_t revision, double x, double y) {
    aisle_goal_list_msg goals = {.goal_list_id = 4, .goal_list_revision = revision, .map_id = 1, .num_goals = 1};
    goals.options.planner = AISLE_OPTIONS_ASTAR;
    goals.goals[0] = (aisle_goal_msg){.id = 11, .x = x, .y = y, .tolerance_theta = 4.0F};
    return goals;
}

// Submits, plans, expects one more reply.
HALL_UNUSED const aisle_path_msg *door_ask(const aisle_query_msg *query) {
    int before = door_replies;
    TEST_ASSERT_EQUAL(AISLE_OK, door_submit(AISLE_INPUT_QUERY, query));
    door_settle();
    TEST_ASSERT_EQUAL_INT(before + 1, door_replies);
    TEST_ASSERT_EQUAL_INT32(query->query_id, door_reply.query_id);
    return &door_reply;
}

// ---- judge

typedef struct door_piece {
    aisle_vec2 a, b, centre;
    double radius, from, sweep, length; // arcs: start angle about the centre and signed angle swept
    double theta, turn;
} door_piece;

static door_piece door_piece_of(const aisle_waypoint_msg *a, const aisle_waypoint_msg *b) {
    door_piece p = {.a = {a->x, a->y}, .b = {b->x, b->y}, .theta = a->theta};
    p.turn = remainder(b->theta - a->theta, 2.0 * DOOR_PI);
    double dx = b->x - a->x;
    double dy = b->y - a->y;
    double chord = hypot(dx, dy);
    double k = (double)b->curvature;
    p.length = chord;
    if ((a->flags & AISLE_WAYPOINT_TURN_IN_PLACE) != 0) {
        TEST_ASSERT_TRUE(chord < 1e-9);
        p.length = 0.0;
    } else if (fabs(k) > 0.0) {
        p.radius = 1.0 / fabs(k);
        double half = chord / 2.0;
        double up = sqrt(fmax(p.radius * p.radius - half * half, 0.0)) * (k > 0.0 ? 1.0 : -1.0);
        p.centre = aisle_vec2_of((a->x + b->x) / 2.0 - up * dy / chord, (a->y + b->y) / 2.0 + up * dx / chord);
        p.from = atan2(a->y - p.centre.y, a->x - p.centre.x);
        p.sweep = 2.0 * asin(fmin(half / p.radius, 1.0)) * (k > 0.0 ? 1.0 : -1.0);
        p.length = fabs(p.sweep) * p.radius;
    }
    return p;
}

static aisle_pose2 door_piece_at(const door_piece *p, double f) {
    aisle_pose2 pose = {p->a.x + f * (p->b.x - p->a.x), p->a.y + f * (p->b.y - p->a.y), p->theta + f * p->turn};
    if (p->radius > 0.0) {
        pose.x = p->centre.x + p->radius * cos(p->from + f * p->sweep);
        pose.y = p->centre.y + p->radius * sin(p->from + f * p->sweep);
    }
    return pose;
}

static double door_piece_gap(const door_piece *p) {
    int steps = 1 + (int)fmax(p->length / 0.01, fabs(p->turn) / 0.0087);
    double least = 1e9;
    for (int i = 0; i <= steps; i++) {
        least = fmin(least, hall_body_gap(door_piece_at(p, (double)i / steps)));
    }
    return least;
}

// Least gap of the footprint along the whole path. Checks on the way what every path promises: clear of the margin,
// clearances lower bounds, rising s and t, rest at the end.
HALL_UNUSED double door_judge(const aisle_path_msg *path) {
    double least = 1e9;
    double length = 0.0;
    TEST_ASSERT_EQUAL(AISLE_PATH_OK, path->status);
    TEST_ASSERT_EQUAL_INT16(0, path->cause);
    for (int16_t i = 1; i < path->num_waypoints; i++) {
        const aisle_waypoint_msg *b = &path->waypoints[i];
        door_piece piece = door_piece_of(b - 1, b);
        double gap = door_piece_gap(&piece);
        length += piece.length;
        TEST_ASSERT_TRUE(gap >= hall_vehicle.margin - 1e-6);
        TEST_ASSERT_TRUE((double)b->clearance <= gap + 1e-6);
        TEST_ASSERT_TRUE(path->clearance_min <= b->clearance);
        TEST_ASSERT_TRUE(b->t > (b - 1)->t);
        TEST_ASSERT_DOUBLE_WITHIN(1e-3, length, (double)b->s);
        least = fmin(least, gap);
    }
    TEST_ASSERT_TRUE(fabs((double)path->waypoints[path->num_waypoints - 1].v) < 1e-6);
    TEST_ASSERT_DOUBLE_WITHIN(1e-3, length, (double)path->length);
    TEST_ASSERT_TRUE(path->length_bound <= path->length);
    return least;
}
#endif
