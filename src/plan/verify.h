// verify.h - proves an encoded path before it may leave: the one gate between planning and sending. Level 4.
//
// Works on the bytes of a path_t, in double, from the primitive curve its waypoints define, and shares no code with the
// search: its own geometry of pieces, obstacles straight from the layout's polygons, scan bits and bounds (not the
// distance field), narrow phase by separating axes, and by libccd (world/collide.h) for all they do not part. Files: verify_piece.c (curve), verify_limits.c (what the
// vehicle can do), verify_zones.c (directed zones), verify_motion.c (collision proof, speed limits of zones),
// verify_base.c (what is under way stays), verify.c (order of it all), release.c (the way out).
//
// Motion. Between waypoints i-1 and i: a turn on the spot if waypoint i-1 carries TURN_IN_PLACE (x, y equal within
// 1e-9 m,
// curvature 0), else a straight line if curvature k of i is 0, else the minor arc; |k| * chord / 2 <= 1 + 1e-6, above 1
// read as the half circle. Equal places without TURN_IN_PLACE are no piece. theta changes linearly, the short way;
// within
// 1e-6 of half a turn both ways are proved, since rounding decides which one a receiver takes.
// For an interval of a piece with origin travel L, curvature k, turn b, every body point at distance r from the origin
// stays within
//     d = |k| L^2 / 8 + r b^2 / 8
// of the straight way between its end positions (|f - chord| <= max|f''| / 8 for the origin's arc and the rotation), so
// the hull of the footprint at both end poses, grown by margin + d + AISLE_VERIFY_EPSILON, covers the whole interval.
// If that
// hull is free the interval is proved; else it is halved; below 1 mm of travel of every body point it is a collision.
// Straight pieces without turn have d = 0: one exact test. Intervals above 2 m are halved unseen so that boxes stay
// small, and bent ones above what was proved last, twice as much every few proofs, since they would mostly be looked at
// in vain.
// So a path is refused only if the footprint comes closer than margin + 2e-6 m, or, where it turns, margin + 0.6 mm:
// a hull
// over 1 mm of travel reaches at most 0.5 mm beyond the nearer of its ends.
// Free means: clear of every OBSTACLE and KEEPOUT polygon and occupied scan cell, and inside the bounds and the scan.
// Where a piece may be driven faster than creep_speed, creep_clearance * (1 - 1e-3) is proved instead of the margin, if
// more. The moving speed of a piece is the larger of its ends'; if both ends are at rest, the peak of the trapezoid
// with
// a_max and d_max that fills the time between them (a reached goal's dwell taken off).
//
// Also checked, with relative tolerance 1e-3 + float rounding where not said otherwise:
// - status OK, PARTIAL or STOP (read as PARTIAL), 1..1024 waypoints, numbers finite, places within 1e5 m, theta in
// [-pi, pi],
//   base within the path, energy >= 0, risk in [0, 1], clearances >= 0;
// - first waypoint within 1e-6 of the start; GOAL waypoints are the caller's goals in order, within their tolerance;
// OK: all of
//   them, the last one at the last waypoint. A goal with dwell is a stop;
// - s and t start at 0; s is the sum of lengths (1e-4 m + 3e-5 s); t strictly rising and fits length and speeds: 2 L
// / (v0 + v1) each
//   piece (at most 1.1 ms longer: times are 1 ms apart), both ends at rest: no shorter than the trapezoid;
// - speeds in [0, v_max or v_reverse_max], |v1^2 - v0^2| <= 2 L a_max or d_max, `a` = that / 2 L on the piece that
// ends there,
//   v^2 |k| <= lateral_a_max, v |turn| / L <= omega_max, turns on the spot no faster than omega_max and alpha_max let
// them;
// - |k| <= curvature_max if that is not 0; a turn on the spot (but for a mere wait) only if it is 0;
// - heading within 2e-3 rad of the direction of motion at both ends of a piece (backwards with REVERSE) and turning
// as the
//   curve does, unless OMNI; OMNI: direction of motion steady within 4e-3 rad where it moves;
// - rest (below 1e-6 m/s) at last waypoint, STOP, both ends of turns, and where REVERSE changes; no faster than v_start at
//   the first one (which way an OMNI vehicle then moves there only a base tells);
// - length, duration equal the waypoints' sums; 0 <= length_bound <= length; clearance_min not above any piece's;
// - STOP only brakes, for it may be sent without a proof among moving obstacles: no waypoint is faster than the first one, a
//   turn is the whole path, and there is no more way than AISLE_VERIFY_STOP_TIME at the first speed and braking from it with
//   d_max, in a turn likewise from omega_max with alpha_max (1e-3 m or rad more);
// - map and vehicle revisions are those proved against; certificate right.
// Zones, by the motion, not by the heading (REVERSE changes nothing):
// - SPEED_LIMIT: where a piece may be driven faster than a zone's value (1 + 1e-3), the footprint without its margin is
//   proved off that zone like off an obstacle, so a body that comes nearer than 2e-6 m (0.6 mm where it turns) to a zone
//   keeps to its limit on the whole piece. Turns on the spot have no speed;
// - DIRECTED: where the origin is inside, deeper than 1e-6 m, its direction of motion is at most a right angle and
//   AISLE_VERIFY_AGAINST off the zone's. The part of an arc that is against it is halved like any interval until its
//   chord, grown by the sagitta, is outside; at a sagitta of 0.4e-6 m it is inside. At most 5000 looks for a zone and a
//   piece of 20 m; all of a piece count as one unit.
// PENALTY zones bind nobody: nothing to prove.
// Base (request.base), where a path takes over from one under way (verify_base.c): both curves are walked by the same metres
// and, in turns on the spot, radians, waits left out, until the base or the new path ends. At the knots of either (waypoints,
// where a trapezoid's speed bends, where the old speed passes v_start) and at three places between two of them
// - the origins are at most 1e-6 m apart and the headings 1e-6 rad, turns go the same way round;
// - the new path is at most as fast as the old one or v_start, whichever is more (both 1e-6 m off each other at worst, and
//   what float times leave open in the trapezoid of a piece at rest at both ends counted in favour). Between knots both
//   squares are linear in the way, so the knots suffice. Rates of turns are not compared: turn times prove themselves.
// num_base counts the new path's waypoints on the base: the first one, those more than 1e-6 m before its end, none more than
//   that behind; where turns are at its end, those before the turn, or with base.turn those after it.
// Not proved: the waypoints' clearances, energy, risk and length_bound themselves.
// Again. What was proved once and is shown with the basis of that proof is not looked at again if nothing of the basis
// has changed, for the verdict would be the same: only the digests are made anew (one pass over the bytes), and ids,
// revisions and certificate are checked. A basis that does not fit changes nothing.
// Pieces known. A path that takes over from another one has most of its pieces. Each piece whose motion was proved can be
// kept (aisle_verify_known): the digest of its curve, the vehicle and the ground, with the fastest speed it was proved for.
// Where the same piece comes again as far from the path's end and no faster, on the same ground and for the same vehicle, its
// motion is not looked at again; all other checks are made. The verdict is the same, the intervals and units are fewer.
// Memory: the caller's struct, stack of intervals of fixed depth. Time: O(intervals * obstacles near), sliced.
#ifndef AISLE_PLAN_VERIFY_H
#define AISLE_PLAN_VERIFY_H

#include "aisle/messages.h"
#include "aisle/planner.h"
#include "robot/vehicle.h"
#include "world/collide.h"
#include "world/layout.h"

#define AISLE_VERIFY_EPSILON 1e-6  // m, for rounding
#define AISLE_VERIFY_AGAINST 2e-3  // rad beyond a right angle to a DIRECTED zone's direction
#define AISLE_VERIFY_STOP_TIME 0.5 // s, before a path of status STOP begins to brake
#define AISLE_VERIFY_DEPTH 64      // of the interval stack; 29 halvings reach 1 mm from the longest arc

// All that a proof's verdict is a function of, as digests. Only verify.c writes one. A path that is given a new head
// (aisle_path_rehead()) and shown with the basis of its proof is proved by it if every part is the same.
typedef struct aisle_proof_basis {
    uint64_t path;   // digest of the waypoints and of the members from status on before them, as encoded; cached,
                     // work_units and certificate taken as 0
    uint64_t given;  // digest of start, v_start, base, goals and aisle_vehicle_content()
    uint64_t layout; // aisle_layout_content()
    int32_t map_id, map_revision;
    uint32_t waypoints; // crc32 of them as encoded, for certificates
    uint32_t size;      // bytes of the path; 0: nothing proved
} aisle_proof_basis;

// The part of a path under way that a later one must not change.
typedef struct aisle_verify_base {
    const aisle_waypoint_msg *w; // [n >= 1] of the path that is out, proved once for this vehicle
    uint32_t n;
    const float *dwell; // [n] s, rest at each before going on, as in profile.h; NULL: none
    uint32_t piece;     // where on it the new path begins: index of the piece's later waypoint, [1, n-1] (n = 1: 0),
    double u;     // and the part of the piece behind, [0, 1]; of the turn in a turn on the spot. Where at most 2e-6 m
                  // or rad of the piece are left, its end will do, too
    double reach; // m of travel from there after which the base ends, >= 0
    bool turn;    // what is left of the turn on the spot that the place is in belongs to it even if reach is 0
} aisle_verify_base;

// A piece whose motion was proved. Only verify.c writes one; zeroed: none.
typedef struct aisle_verify_known {
    uint64_t digest; // of the layout's and the vehicle's content, both ends, curvature and TURN_IN_PLACE
    double peak;     // m/s, for which it was proved
} aisle_verify_known;

typedef struct aisle_verify_request {
    const aisle_layout *layout;
    const aisle_vehicle *vehicle;
    const uint8_t *bytes; // encoded path_t, stays put until the end
    size_t size;
    aisle_pose2 start;             // where the motion must begin, within 1e-6
    double v_start;                // m/s >= 0, allowed at the first waypoint; 0: begins at rest
    const aisle_verify_base *base; // stays put until the end; NULL: nothing is under way
    const aisle_goal_msg *goals;   // [num_goals] to be reached in this order, flags GOAL with their ids
    uint32_t num_goals;
    const aisle_proof_basis *basis; // of an earlier proof of the same path; NULL: none
    aisle_verify_known
        *known;      // [AISLE_PATH_MAX_WAYPOINTS] by pieces from the end of the path, of the paths of status OK
                     // proved with it; NULL: none
    bool looks_anew; // known is written, but not read: units do not depend on what was proved before
} aisle_verify_request;

typedef enum aisle_verify_fault {
    AISLE_VERIFY_NONE,      // no fault
    AISLE_VERIFY_DECODE,    // not a path_t, or a count, status or number in it is wrong
    AISLE_VERIFY_START,     // does not begin at the start
    AISLE_VERIFY_GOAL,      // misses a goal
    AISLE_VERIFY_COLLISION, // footprint + margin not free on a piece
    AISLE_VERIFY_CREEP,     // too fast for the clearance
    AISLE_VERIFY_TIME,      // times do not rise or do not fit the speeds
    AISLE_VERIFY_SPEED,
    AISLE_VERIFY_ACCELERATION,
    AISLE_VERIFY_LATERAL,
    AISLE_VERIFY_TURN_RATE,
    AISLE_VERIFY_CURVATURE,
    AISLE_VERIFY_HEADING,
    AISLE_VERIFY_REST,
    AISLE_VERIFY_SUMS,        // length, duration, bound or clearance_min do not fit the waypoints
    AISLE_VERIFY_CERTIFICATE, // not the crc of these waypoints and revisions
    AISLE_VERIFY_ZONE_SPEED,  // too fast in a SPEED_LIMIT zone
    AISLE_VERIFY_DIRECTION,   // against a DIRECTED zone's direction
    AISLE_VERIFY_STOP,        // status STOP, but does more than to brake
    AISLE_VERIFY_BASE         // leaves the base, is faster on it, or num_base does not count its waypoints
} aisle_verify_fault;

// What a proof leaves behind. Only verify.c writes one; release() checks it.
typedef struct aisle_stamp {
    uint64_t digest; // of the proved bytes, the lease's two times, clearance_moving_min and work_units taken as 0
    uint32_t size;   // of them; 0: nothing proved
} aisle_stamp;

// What the proof of a lease leaves behind. Only verify_moving.c writes one; release() checks it.
typedef struct aisle_moving_stamp {
    uint64_t digest;  // of the bytes, as aisle_stamp has it
    uint32_t size;    // of them; 0: nothing proved
    int64_t until_us; // end of the lease proved
    float clearance; // m, kept off every mover's reach, body to reach; 0: not told (AISLE_MOVING_CLEARANCE_MAX or more)
} aisle_moving_stamp;

typedef struct aisle_verify_piece { // from waypoint i-1 to i; verify_piece.c
    aisle_vec2 from, unit;          // first end; direction of the chord
    double chord;                   // m, >= 0
    double phi;                     // half the angle the course turns by, rad, [0, pi/2]; 0: straight
    double side;                    // 1: to the left, -1: to the right
    double length;                  // m
    double course;                  // direction of the chord, rad; 0 without one
    double theta, turn;             // heading at the first end and its change, rad
    double turn_other;              // the other way round if rounding decides between them; else = turn
    double time;                    // s, dwell taken off
    double peak;                    // m/s, fastest on it
    bool on_spot, reverse;
} aisle_verify_piece;

// How fast a piece is driven: the square of the speed is linear in the way between both ends, or where it rests at both,
// up to the peak and down again. In m, of a turn in rad; verify_limits.c.
typedef struct aisle_verify_speeds {
    double length;
    double v0, v1; // 1/s
    double peak, up, down;
    bool rests; // at both ends
} aisle_verify_speeds;

typedef struct aisle_verify_motion { // intervals of the piece in hand; verify_motion.c
    double lo;                       // where the interval in front begins, [0, 1] of the piece
    double hi[AISLE_VERIFY_DEPTH];   // where those not yet proved end, the next on top
    uint32_t depth;                  // entries in hi
    double turn;                     // way round in hand
    double limit;                    // m of travel: longer bent intervals are halved unseen; 0: none yet
    uint32_t proved;                 // bent intervals since the limit was set
    double margin, growth;           // m: always kept; to be proved on this piece (>= margin)
    bool heeds_limits;               // SPEED_LIMIT zones slower than the piece are kept off
} aisle_verify_motion;

typedef struct aisle_verify_walk { // along the base; the new path's piece is the one in hand; verify_base.c
    uint32_t at;                   // piece of the path that is out, n: past its end
    aisle_verify_piece piece;      // it
    double done, done_new;         // m, or rad of a turn, behind: of this piece and of the one in hand
    double left;                   // m of the base
    bool in_turn;                  // the turn that it begins in is not over
    uint32_t counted;              // waypoints of the new path that are on it for certain
} aisle_verify_walk;

typedef enum aisle_verify_phase {
    AISLE_VERIFY_PHASE_HEADER,    // decode, check what is not a waypoint
    AISLE_VERIFY_PHASE_WAYPOINTS, // limits, goals
    AISLE_VERIFY_PHASE_BASE,
    AISLE_VERIFY_PHASE_MOTION, // collisions
    AISLE_VERIFY_PHASE_DONE
} aisle_verify_phase;

typedef struct aisle_verify {
    aisle_verify_request request;
    aisle_path_msg *path; // decoded copy; the caller's
    aisle_verify_fault fault;
    uint32_t fault_waypoint; // index the fault is at: the later end of a piece
    int32_t fault_id;    // COLLISION, CREEP: the obstacle's id or AISLE_LAYOUT_ID_*; ZONE_SPEED, DIRECTION: the zone's
    aisle_vec2 fault_at; // and the origin's position there, within 1 mm
    uint32_t intervals;  // looked at
    aisle_collide_count collide;

    // The verifier's own.
    aisle_verify_phase phase;
    uint32_t at;                                    // waypoint or piece in hand
    uint32_t goals;                                 // reached before it
    uint64_t digest;                                // of the bytes at the start
    bool unbroken;                                  // and no step has ended since
    aisle_proof_basis basis;                        // of what is being proved
    uint64_t ground;                                // digest of layout and vehicle
    uint8_t is_known[AISLE_PATH_MAX_WAYPOINTS / 8]; // bits: pieces that need no look
    double lever;                                   // m, farthest footprint point from the origin
    double s;                                       // m, sum of lengths so far
    double along;                                   // rad, direction of motion at the end of the last piece
    aisle_verify_piece piece;
    aisle_verify_walk walk;
    aisle_verify_motion motion;
} aisle_verify;

// Begins. `decoded` (one aisle_path_msg of scratch), bytes, goals and vehicle stay in use until the end; a layout that
// changes meanwhile is a CERTIFICATE fault, bytes that do are a DECODE fault. O(1).
void aisle_verify_start(aisle_verify *self, const aisle_verify_request *request, aisle_path_msg *decoded);

// Looks at no more than `units` intervals (one unit each; fixed checks count 1 a waypoint, 1 a step along the base and 1 for the
// rest).
// AISLE_BUSY;
// AISLE_OK: proved, *stamp written; AISLE_ERR_DATA: fault says why, *stamp zeroed (as with AISLE_BUSY). *spent is
// added to.
// Further calls repeat the answer and cost nothing. However cut into steps, answer and counts are the same.
aisle_status aisle_verify_step(aisle_verify *self, uint32_t units, uint32_t *spent, aisle_stamp *stamp);

// After AISLE_OK: to be shown when the same path is to be proved again.
const aisle_proof_basis *aisle_verify_basis(const aisle_verify *self);

#define AISLE_RELEASE_TOLD_MAX 8 // waypoints of a refusal

// The only way out: fills *event for these bytes if the stamp proves just them, or if they are a decodable path_t of
// status NONE with at most AISLE_RELEASE_TOLD_MAX waypoints (nothing to drive: they tell the reason). utime and
// valid_until_utime (the lease), clearance_moving_min (its proof's) and work_units (spent after the proof, too) may have
// changed since. A PATH to drive, that is of any other status but STOP, needs the moving stamp of the same bytes, too, a lease
// that ends when this one does or before, and tells no more clearance than it. STOP may always be braked along (it does nothing
// else, see above), and a REPLY gives no lease: neither tells any such clearance. Stamps that are not needed may be NULL.
// AISLE_ERR_ARG otherwise, *event untouched.
aisle_status aisle_release(aisle_event_kind kind, const uint8_t *bytes, size_t size, const aisle_stamp *stamp,
                           const aisle_moving_stamp *moving, aisle_event *event);

// crc32 over the waypoints as encoded (in order), then over path_revision, query_id, goal_list_id,
// goal_list_revision, map_id, map_revision,
// vehicle_revision as 4 big-endian bytes each. The path's `certificate`.
uint32_t aisle_path_certificate(const aisle_path_msg *path);

// Encodes a path_t with its certificate, which is written to *path, too. Answers as aisle_msg_encode().
aisle_status aisle_path_encode(aisle_path_msg *path, uint8_t *bytes, size_t capacity, size_t *size);

// Places in an encoded path_t.
enum {
    AISLE_PATH_AT_UTIME = 8,
    AISLE_PATH_AT_REVISION = 24, // the seven ids and revisions follow one another
    AISLE_PATH_AT_MAP_ID = 40,
    AISLE_PATH_AT_POSE_UTIME = 52,
    AISLE_PATH_AT_VALID_UNTIL_UTIME = 76,
    AISLE_PATH_AT_STATUS = 84,
    AISLE_PATH_AT_CACHED = 96,
    AISLE_PATH_AT_WORK_UNITS = 97,
    AISLE_PATH_AT_CLEARANCE_MOVING = 127,
    AISLE_PATH_AT_CERTIFICATE = 135,
    AISLE_PATH_AT_NUM_WAYPOINTS = 139,
    AISLE_PATH_AT_WAYPOINTS = 141
};

// Makes encoded bytes of a path_t the answer to another request: every member before status, cached and work_units
// become head's, and the certificate is made for waypoints with this crc32. O(1).
void aisle_path_rehead(uint8_t *bytes, const aisle_path_msg *head, uint32_t waypoints);
#endif
