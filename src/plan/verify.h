// verify.h - proves an encoded path before it may leave: the one gate between planning and sending. Level 4.
//
// Works on the bytes of a path_t, in double, from the primitive curve its waypoints define, and shares no code with the
// search: its own geometry of pieces, obstacles straight from the layout's polygons, scan bits and bounds (not the
// distance field), narrow phase by libccd (world/collide.h).
//
// Motion. Between waypoints i-1 and i: a turn on the spot if waypoint i-1 carries TURN_IN_PLACE (x, y equal), else a straight line
// if curvature of i is 0, else the minor arc. theta changes linearly, the short way. For an interval of a piece with origin travel L,
// curvature k, turn b: every body point at distance r from the origin stays within
//     d = |k| L^2 / 8 + r b^2 / 8
// of the straight way between its end positions (sagittas of the origin's arc and of the rotation), so the hull of the
// footprint at both end poses, grown by margin + d + AISLE_VERIFY_EPSILON, covers the whole interval. If that hull is free the
// interval is proved; else it is halved; at an interval below 1 mm of travel of every body point it is a collision.
// Straight pieces without turn have d = 0: one exact test (cut to at most 1 m so that the boxes stay small).
// Where the piece is driven faster than creep_speed (either end), the same is proved with creep_clearance instead of the margin.
//
// Also: status OK or PARTIAL; n >= 1; finite, in bounds; first waypoint at the stated start pose, goals reached in order within
// tolerance (the caller gives them); s and t consistent, t strictly rising; speeds, accelerations, lateral
// acceleration, turn rates, curvature within the vehicle's limits (relative tolerance 1e-3 + float rounding); rest at first and last
// waypoint, STOP and turns; a turn on the spot only if curvature_max is 0; heading along the motion (2e-3 rad; backwards with REVERSE) unless OMNI;
// length and duration equal the waypoints' sums; length_bound <= length; clearance_min not above any piece's; certificate right.
// Memory: the caller's struct, stack of intervals of fixed depth. Time: O(intervals * obstacles near), sliced.
#ifndef AISLE_PLAN_VERIFY_H
#define AISLE_PLAN_VERIFY_H

#include "aisle/messages.h"
#include "aisle/planner.h"
#include "robot/vehicle.h"
#include "world/collide.h"
#include "world/layout.h"

#define AISLE_VERIFY_EPSILON 1e-6 // m, for rounding
#define AISLE_VERIFY_DEPTH 64     // of the interval stack

typedef struct aisle_verify_request {
    const aisle_layout *layout;
    const aisle_vehicle *vehicle;
    const uint8_t *bytes; // encoded path_t, stays put until the end
    size_t size;
    aisle_pose2 start;              // where the motion must begin, within 1e-6
    const aisle_goal_msg *goals;    // [num_goals] to be reached in this order, flags GOAL with their ids
    uint32_t num_goals;
} aisle_verify_request;

typedef enum aisle_verify_fault {
    AISLE_VERIFY_NONE,      // no fault
    AISLE_VERIFY_DECODE,    // not a path_t, or a count, status or number in it is wrong
    AISLE_VERIFY_START,     // does not begin at the start
    AISLE_VERIFY_GOAL,      // misses a goal
    AISLE_VERIFY_COLLISION, // footprint + margin not free on a piece
    AISLE_VERIFY_CREEP,     // too fast for the clearance
    AISLE_VERIFY_TIME,      // times do not rise or do not fit the speeds
    AISLE_VERIFY_SPEED, AISLE_VERIFY_ACCELERATION, AISLE_VERIFY_LATERAL, AISLE_VERIFY_TURN_RATE,
    AISLE_VERIFY_CURVATURE, AISLE_VERIFY_HEADING, AISLE_VERIFY_REST,
    AISLE_VERIFY_SUMS,        // length, duration, bound or clearance_min do not fit the waypoints
    AISLE_VERIFY_CERTIFICATE  // not the crc of these waypoints and revisions
} aisle_verify_fault;

// What a proof leaves behind. Only verify.c writes one; release() checks it.
typedef struct aisle_stamp {
    uint32_t crc;  // of the proved bytes, the lease's two times taken as 0
    uint32_t size; // of them; 0: nothing proved
} aisle_stamp;

typedef struct aisle_verify {
    aisle_verify_request request;
    aisle_path_msg *path;    // decoded copy; the caller's
    aisle_verify_fault fault;
    uint32_t fault_waypoint; // index the fault is at
    int32_t fault_id;        // COLLISION, CREEP: the obstacle's id or AISLE_LAYOUT_ID_*
    aisle_vec2 fault_at;     // and the origin's position there
    uint32_t intervals;      // looked at
    aisle_collide_count collide;
    // (the rest: the implementer's)
} aisle_verify;

// Begins. `decoded` (one aisle_path_msg of scratch) stays in use until the end.
void aisle_verify_start(aisle_verify *self, const aisle_verify_request *request, aisle_path_msg *decoded);

// Looks at no more than `units` intervals (one unit each; fixed checks count 1 a waypoint). AISLE_BUSY; AISLE_OK: proved, *stamp
// written; AISLE_ERR_DATA: fault says why, *stamp zeroed. *spent is added to.
aisle_status aisle_verify_step(aisle_verify *self, uint32_t units, uint32_t *spent, aisle_stamp *stamp);

// The only way out: fills *event for these bytes if the stamp proves just them, or if they are a decodable path_t of status NONE with no
// waypoints (nothing to drive). utime and valid_until_utime may have changed since the proof (lease). AISLE_ERR_ARG otherwise, *event untouched.
aisle_status aisle_release(aisle_event_kind kind, const uint8_t *bytes, size_t size, const aisle_stamp *stamp, aisle_event *event);

// crc32 over the waypoints as encoded (in order), then over path_revision, query_id, goal_list_id, goal_list_revision, map_id, map_revision,
// vehicle_revision as 4 big-endian bytes each. The path's `certificate`.
uint32_t aisle_path_certificate(const aisle_path_msg *path);
#endif
