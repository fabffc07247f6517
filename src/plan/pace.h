// pace.h - how fast a given way may be driven among moving obstacles, and how long that will take. Level 4.
//
// Path-velocity decomposition (Kant and Zucker 1986, doi:10.1177/027836498600500304): the curve stands, its speeds are
// chosen. Ours, not theirs: not the one profile that dodges predicted obstacles, which nobody can promise, but the fastest
// of a few that is passively safe (Macek, Vasquez, Fraichard and Siegwart 2009, "Towards safe vehicle navigation in
// dynamic urban scenarios"): for whatever a mover does within its bound, the vehicle is at rest before it is touched.
//
// Safe for a lease L means: for every instant in [0, L] at which it is told to brake, the vehicle goes on by the path for
// reaction_time, then brakes along it with d_max (turns on the spot: alpha_max) to rest, and while it moves its footprint,
// grown by margin + AISLE_PACE_SPARE, is off the disc that each mover can have reached by then (world/movers.h), all that
// AISLE_PACE_LAG late. A real speed above the path's is braked down to it first. Looked at place by place: a disc grows
// with time only, so of all these motions the one counts that is at a place last (band.h). This is a planner's look, with
// more to spare than the proof (verify_moving.h), which shares no code with it.
//
// Levels: 0 is as fast as the ground allows; level k is at most aisle_pace_cap(k) over all that can be driven within the
// lease and the braking after it, and as fast as the ground allows behind; AISLE_PACE_STOP goes on for
// AISLE_PACE_LATENCY at its present speed, then brakes, and the path ends there. On the base of what is under way
// (verify.h) none is faster than that or the present speed. Tried from `first` on, the fastest safe one is taken, so
// that the same question has the same answer. A level faster than `current` must be safe for AISLE_PACE_HOLD times the
// lease, so that it is not taken back at once. Slower is not always safer: a vehicle that passes before a mover is safe
// by being fast. Levels that come out as the one before are passed over.
//
// Memory: carved, one path's waypoints and 12 KiB; the struct, 16 KiB; the caller's path. Time: sliced; a level is O(waypoints within reach,
// zones near them) and O(movers near * places of the band). Units: one for each mover looked at and each place measured, one for
// 8 waypoints. Objects share nothing.
#ifndef AISLE_PLAN_PACE_H
#define AISLE_PLAN_PACE_H

#include "aisle/messages.h"
#include "aisle/status.h"
#include "base/arena.h"
#include "plan/band.h"
#include "plan/verify.h" // aisle_verify_base, what is under way
#include "robot/motion.h"
#include "robot/profile.h"
#include "world/layout.h"
#include "world/movers.h"

#define AISLE_PACE_LEVELS 8U
#define AISLE_PACE_STOP (AISLE_PACE_LEVELS - 1U)
#define AISLE_PACE_SPARE 0.01   // m, beyond the margin
#define AISLE_PACE_LAG 0.12     // s, later than the path says: AISLE_DRIVE_LAG and some to spare
#define AISLE_PACE_LATENCY 0.1  // s, from a decision to the vehicle's doing
#define AISLE_PACE_HOLD 1.4     // of a lease, for going faster
#define AISLE_PACE_RESTING 0.01 // m/s; slower is at rest

typedef struct aisle_pace_request {
    const aisle_layout *layout; // for zones; NULL: none
    const aisle_vehicle *vehicle;
    const aisle_movers *movers;
    const aisle_waypoint_msg *w; // [n] the whole way; its speeds and times are not used but in turns
    uint32_t n;
    const float *dwell;            // [n] s of rest at each, as in profile.h; NULL: none
    aisle_place at;                // where the vehicle is on it
    double v;                      // m/s >= 0, and how fast
    double omega;                  // rad/s >= 0, and in a turn on the spot
    const aisle_verify_base *base; // of what is under way, its place being `at`, too; NULL: nothing is, or it rests
    int64_t now_us;
    double lease; // s > 0
    double late;  // s >= 0, that the vehicle may be later than its path says beyond AISLE_PACE_LAG, which says that it
                  // does not rest where it is
    uint32_t first;   // fastest level to be tried; AISLE_PACE_STOP: stop
    uint32_t current; // level of what is under way; AISLE_PACE_STOP if it rests or nothing is
    uint32_t enough;  // a level from here on is not wanted: it is found, but no path is made of it; 0: all are wanted
} aisle_pace_request;

typedef struct aisle_pace_limit { // what does not let the vehicle be faster
    bool is_known;
    int32_t id; // the mover's, and its source
    uint8_t source;
    aisle_vec2 place; // m, of the vehicle's origin where it may be touched
    double time;      // s from now
} aisle_pace_limit;

typedef enum aisle_pace_phase { AISLE_PACE_LEVEL, AISLE_PACE_MOVERS, AISLE_PACE_DONE } aisle_pace_phase;

typedef struct aisle_pace {
    aisle_pace_request request;
    aisle_path_msg *path; // the caller's
    uint32_t level;       // in hand; at the end the one taken
    aisle_pace_limit limit;
    uint32_t tried; // levels looked at

    // Its own.
    aisle_waypoint_msg *front;         // [AISLE_PATH_MAX_WAYPOINTS] the part of the path that a level is looked at on
    float *dwell, *front_dwell, *most; // [AISLE_PATH_MAX_WAYPOINTS] of path, of front, of either
    aisle_pace_phase phase;
    aisle_status outcome;
    uint32_t n, mover; // waypoints of the path without a level's; the next mover
    double v;          // m/s, of the first waypoint
    aisle_band band;
} aisle_pace;

// `self` may be NULL, to measure only.
void aisle_pace_carve(aisle_pace *self, aisle_arena *arena);

// m/s; INFINITY at level 0, 0 at AISLE_PACE_STOP.
double aisle_pace_cap(const aisle_vehicle *vehicle, uint32_t level);

// Begins. What the request points to stays put until the end. O(n).
void aisle_pace_start(aisle_pace *self, const aisle_pace_request *request, aisle_path_msg *path);

// Spends about `units` (at most 1 + AISLE_BAND_MAX, or a level's waypoints, more); adds to *spent. AISLE_BUSY, then, for ever:
// AISLE_OK      path->waypoints from `at` on, num_waypoints, num_base, length, duration, energy, risk (by pieces' clearances) and
//               clearance_min are written, for self->level, if that is wanted; the rest of *path is the caller's. limit: of
//               the next faster level that was tried, if one was
// AISLE_PARTIAL likewise for AISLE_PACE_STOP: the path ends where the vehicle comes to rest. It has not been looked at
//               whether that is safe: it is the least there is
// AISLE_ERR_CAPACITY  the path has no room for the waypoints where speeds change, or lasts too long; where something is under
//               way AISLE_PACE_STOP is taken instead
// However cut into steps, answer and units are the same.
aisle_status aisle_pace_step(aisle_pace *self, uint32_t units, uint32_t *spent);
#endif
