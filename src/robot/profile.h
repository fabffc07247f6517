// profile.h - speeds, times and energy along a path whose geometry stands. Level 3.
//
// Pieces as waypoint_t says: piece i joins waypoint i-1 to i and is a straight line, an arc (curvature of waypoint i), or, if
// waypoint i-1 carries TURN_IN_PLACE, a turn on the spot. REVERSE on waypoint i: piece i is driven backwards.
// Speed limit of a piece: v_max (v_reverse_max if REVERSE); sqrt(lateral_a_max / |curvature|); omega_max * length / |turn|;
// creep_speed if its clearance (waypoint i) is below creep_clearance; SPEED_LIMIT zones the footprint touches on it. Speed at a
// waypoint: at most the limit of both pieces, 0 at the first and last, at STOP, and on both ends of a turn; then a forward and a backward
// pass with a_max and d_max (v1^2 <= v0^2 + 2 a length). Between waypoints the acceleration is constant: a = (v1^2 - v0^2) / (2 length).
// A piece between two stops gets through because speed may peak at its middle only if it is split: the caller splits long pieces; a
// piece whose both ends are at rest is given as "v = 0 at both ends" with duration of the triangular (trapezoidal) profile under its limit, and a = 0.
// Turn on the spot by angle b: trapezoid under omega_max and alpha_max. dwell: added after STOP at a goal by the caller through `dwell`.
// Energy (J): rolling m g c L / eff + gain of kinetic energy m (v1^2 - v0^2) / 2 / eff where positive + idle power * time
// (+ turn on the spot: rolling over outer_radius * |turn|). Ours; PAPERS' third and fourth give trends only.
// Memory: none. Time: O(n), zones O(n * zones near).
#ifndef AISLE_ROBOT_PROFILE_H
#define AISLE_ROBOT_PROFILE_H

#include "robot/vehicle.h"
#include "world/layout.h"

typedef struct aisle_profile_sum {
    double length;   // m
    double duration; // s
    double energy;   // J
    double risk;     // mean of max(1 - clearance / creep_clearance, 0) over the length, by pieces
} aisle_profile_sum;

// Reads x, y, theta, curvature, clearance, flags; writes s, t, v, a of w[n], n >= 1. dwell[n] (s, may be NULL): rest after reaching
// waypoint i before going on. layout may be NULL: no zones. All times strictly rising (at least 1 ms apart, as float too).
// A short piece between equal positions without TURN_IN_PLACE is a fault of the caller: AISLE_ERR_ARG.
aisle_status aisle_profile_fill(const aisle_vehicle *vehicle, const aisle_layout *layout, aisle_waypoint_msg *w, uint32_t n,
                                const float *dwell, aisle_profile_sum *sum);

// Geometry of piece i in [1, n): length (m) of line or arc; signed turn (rad) of theta, the short way.
double aisle_piece_length(const aisle_waypoint_msg *from, const aisle_waypoint_msg *to);
double aisle_piece_turn(const aisle_waypoint_msg *from, const aisle_waypoint_msg *to);
#endif
