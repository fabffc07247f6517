// profile.h - speeds, times and energy along a path whose geometry stands. Level 3.
//
// Pieces as waypoint_t says: piece i joins waypoint i-1 to i and is a straight line, an arc (curvature of waypoint i),
// or, if waypoint i-1 carries TURN_IN_PLACE, a turn on the spot. REVERSE on waypoint i: piece i is driven backwards.
//
// Limit of a piece, the least of: v_max (v_reverse_max if REVERSE); sqrt(lateral_a_max / |curvature|); omega_max *
// length / |turn|; creep_speed if its clearance (waypoint i) is below creep_clearance; the value of every SPEED_LIMIT
// zone it may touch. "May touch": the piece is cut, and at each cut the hull of the footprint at both ends, grown by
// how far a body point may stray from the straight way between them, is tested. A zone that is touched always holds;
// one farther than 0.05 m from the ground covered does not, unless that would take more than 64 cuts (64 are made
// then). Straight pieces without a turn are exact to 1e-6 m. Other kinds of polygons, and turns on the spot, are not
// looked at.
//
// Speed at a waypoint: at most the limits of both pieces; 0 at the first and last, at STOP, at both ends of a turn, and
// where REVERSE begins or ends; then the greatest speeds with v1^2 <= v0^2 + 2 a_max L and v0^2 <= v1^2 + 2 d_max L on
// every piece (one pass forwards, one backwards; the two-pass method of Bobrow, Dubowsky and Gibson 1985,
// doi:10.1177/027836498500400301, with constant limits on each piece). Between waypoints the acceleration is constant:
// with v0, v1 of the two waypoints
//     a = (v1^2 - v0^2) / (2 L),  dt = 2 L / (v0 + v1).
// Waypoint i holds v at it and a of the piece that ends there (0 at the first).
// A piece at rest at both ends is driven as a trapezoid (triangle) under its limit with a_max and d_max; it is written
// as v = 0 at both ends and a = 0, dt the duration of the trapezoid. Any other piece is driven at the mean of the
// speeds at its ends, a long one with a slow end slowly: aisle_profile_fill_ramps() cuts it. Turn on the spot by angle
// b: trapezoid (triangle) under omega_max and alpha_max, v = 0 at both ends, a = 0. alpha_max is not asked elsewhere:
// arcs meet lines with a jump of curvature, as all line-and-arc paths do.
//
// Energy (J): (rolling m g c L + gain of kinetic energy m (v1^2 - v0^2) / 2 where positive, m vp^2 / 2 with the peak vp
// where both ends are at rest) / efficiency + idle power * duration; a turn: rolling over outer_radius * |turn|. g
// = 9.80665 m/s2. Ours; PAPERS' third and fourth give trends only.
//
// Rounding: all sums are double; s and a are the nearest floats. v is rounded down before it is used further, so the
// rules on v and a above hold for the floats as they stand (to 1e-12 relative). t is rounded up, each from the float
// before it, so that dt >= 2 L / (v0 + v1) holds for the floats and dt exceeds it by at most one step of float at t
// (0.98 ms at most, since longer than AISLE_PROFILE_DURATION_MAX is refused), or is 1 ms where that is more.
//
// Memory: none (s and a of the waypoints serve as scratch). Time: O(n), with zones O(n * zones near * cuts); 64 * 64 a
// gap at most.
#ifndef AISLE_ROBOT_PROFILE_H
#define AISLE_ROBOT_PROFILE_H

#include "robot/vehicle.h"
#include "world/layout.h"

#include <stdint.h>

#define AISLE_PROFILE_DURATION_MAX 16384.0 // s (4.5 h): float tells milliseconds apart up to here
#define AISLE_PROFILE_PIECE_MIN 1e-9       // m; a shorter piece is none
#define AISLE_PROFILE_TIME_STEP 1e-3       // s, least time between waypoints
#define AISLE_PROFILE_RAMP_GAIN 0.02       // s, that a piece is cut for

typedef struct aisle_profile_sum {
    double length;   // m
    double duration; // s, = t of the last waypoint
    double energy;   // J
    double risk; // mean of max(1 - clearance / creep_clearance, 0) over the length, by pieces; 0 if there is no length
} aisle_profile_sum;

// Reads x, y, theta, curvature, clearance, flags; writes s, t, v, a of w[n], n >= 1. dwell[n] (s, may be NULL): rest
// after reaching waypoint i before going on; t is the time of arrival, so it delays the waypoints behind, and on the
// last one counts for nothing. layout may be NULL: no zones. All times strictly rising (at least 1 ms apart, as float
// too).
//
// AISLE_ERR_ARG, nothing changed: NULL, n = 0, a layout not in force; a number read that is not finite, |x| or |y|
// above AISLE_SHAPE_COORD_MAX, |theta| above AISLE_ANGLE_MAX, a negative clearance (curvature and clearance of w[0] are
// not read); a piece shorter than AISLE_PROFILE_PIECE_MIN without TURN_IN_PLACE, or one not shorter with it; an arc
// whose chord is longer than its diameter (by more than 1e-6 relative); a dwell that is negative, not finite, or not 0
// at a waypoint where the vehicle does not rest. AISLE_ERR_CAPACITY: lasts longer than AISLE_PROFILE_DURATION_MAX; s,
// t, v, a are undefined then, all else is unchanged.
aisle_status aisle_profile_fill(const aisle_vehicle *vehicle, const aisle_layout *layout, aisle_waypoint_msg *w,
                                uint32_t n, const float *dwell, aisle_profile_sum *sum);

// How a path begins that is under way already, and how fast it is to be.
typedef struct aisle_profile_start {
    double v;          // m/s, of the first waypoint, in [0, AISLE_VEHICLE_SPEED_MAX]
    const float *most; // [n] m/s >= 0, may be INFINITY; NULL: no such bounds
} aisle_profile_start;

// The same for a path whose first waypoint is in motion (start->v > 0) or that is not to be as fast as it could. Each
// waypoint but the first is at most at its `most` or, where braking at once from start->v leaves no choice, at the
// speed it leaves, sqrt(v^2 - 2 d_max s). A piece from rest to rest keeps to the greater `most` of its ends. For
// braking to end where it can, the caller cuts a piece where that speed is `most`. The first waypoint's REVERSE is not
// looked at; its v is start->v rounded down, or less by a relative 1e-6 where rounding lets the brakes not quite
// suffice.
//
// Beside the answers of aisle_profile_fill(): AISLE_ERR_ARG, nothing changed: start NULL or out of range; in motion,
// but the first waypoint carries STOP or TURN_IN_PLACE, has a dwell or is the only one. AISLE_PARTIAL: all is filled,
// but start->v is too fast for what follows even if it brakes with d_max: the first v is as much as is not.
aisle_status aisle_profile_fill_moving(const aisle_vehicle *vehicle, const aisle_layout *layout, aisle_waypoint_msg *w,
                                       uint32_t n, const float *dwell, const aisle_profile_start *start,
                                       aisle_profile_sum *sum);

// A path that waypoints may be put into.
typedef struct aisle_profile_path {
    aisle_waypoint_msg *w; // [capacity]
    float *dwell;          // [capacity] s; NULL: none
    uint32_t n, capacity;
    uint32_t mark;  // of a waypoint that the caller wants to find again: moves with it
    uint32_t whole; // pieces, the first ones, that are not to be cut
} aisle_profile_path;

// The same again, as fast as the limits of whole pieces allow. A piece that would take more than
// AISLE_PROFILE_RAMP_GAIN less if it sped up with a_max to its limit, or to where it has to brake, and braked with
// d_max, is cut there: into up to three parts. Waypoints put in are on the piece, with its curvature, clearance and
// REVERSE, no dwell and no other flag. Pieces from rest to rest, turns, the first path->whole pieces and those on which
// `most` falls or rises to a finite bound are left whole; so are those behind the first one for which there is no room.
// The first speed and those of the waypoints there were are the same, but for rounding. start->most: [n], of the path
// as it comes. Beside the answers above AISLE_ERR_ARG: capacity < n.
aisle_status aisle_profile_fill_ramps(const aisle_vehicle *vehicle, const aisle_layout *layout,
                                      aisle_profile_path *path, const aisle_profile_start *start,
                                      aisle_profile_sum *sum);

// Length (m) of the line or the minor arc from `from` to `to`, 0 if `from` carries TURN_IN_PLACE. A chord longer than
// the diameter is taken as the diameter. Relative error at most 1e-12. O(1).
double aisle_piece_length(const aisle_waypoint_msg *from, const aisle_waypoint_msg *to);

// What a piece takes at the wheels, J, by the rules above; peak: m/s, of a piece at rest at both ends. O(1).
typedef struct aisle_piece_work {
    double rolling, acceleration, turning;
} aisle_piece_work;
aisle_piece_work aisle_piece_work_of(const aisle_vehicle *vehicle, const aisle_waypoint_msg *from,
                                     const aisle_waypoint_msg *to, double peak);

// Least time (s) from rest to rest over `way` (m or rad, >= 0), never faster than `most` (> 0), up with `up`, down with
// `down` (> 0): a trapezoid or triangle. *peak: the greatest speed. O(1).
double aisle_rest_to_rest(double way, double most, double up, double down, double *peak);

// Signed turn (rad) of theta, the short way, in (-pi, pi]. O(1).
double aisle_piece_turn(const aisle_waypoint_msg *from, const aisle_waypoint_msg *to);
#endif
