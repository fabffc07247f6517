// motion.h - a path as a motion: where, when and how fast on it, and the path from a place on. Level 3.
//
// Reads a path as waypoint_t says: pieces as in profile.h, their speeds and times as aisle_profile_fill() writes them. A
// place on it is a piece (the index of its later waypoint, 1 .. n-1) and the part u in [0, 1] of it that lies behind; of a
// turn on the spot u is the part of the turn, of a wait (a turn by less than AISLE_CURVE_HEADING_TOLERANCE) the part of
// its time. (i, 1) and (i + 1, 0) are the same pose: the vehicle arrives at waypoint i and leaves it. A path of one
// waypoint has the one place (0, 0).
//
// Speeds. On a piece that moves at one end at least, v^2 is linear in the length. On one at rest (at most
// AISLE_MOTION_REST) at both ends it is the trapezoid under a_max and d_max that fills its time, likewise the rate of a
// turn under alpha_max. Times. dwell[n] (s, NULL: none): rest at waypoint i before going on, as in profile.h; what is left
// of the time between two waypoints is the motion's. A piece that starts at rest and ends in motion, and a turn, tell by
// themselves how long they take (2 L / v; the fastest turn): of these all that is left is spent at rest before them,
// whether dwell says so or not, so only pieces at rest at both ends need it. Where floats of t leave a motion a little
// too little or too much time, it is stretched to fit.
//
// Every function wants n >= 1 waypoints that aisle_profile_fill() would take and a place that exists (asserted). w, dwell
// and vehicle are only read. Memory: none. Time: as stated; a piece is O(1). Objects share nothing.
#ifndef AISLE_ROBOT_MOTION_H
#define AISLE_ROBOT_MOTION_H

#include "aisle/messages.h"
#include "base/vec.h"
#include "robot/vehicle.h"

#include <stdbool.h>
#include <stdint.h>

#define AISLE_MOTION_REST 1e-6    // m/s; slower is at rest
#define AISLE_MOTION_SNAP 1e-7    // m or rad; what is left of a piece below it counts as nothing when a path is cut
#define AISLE_MOTION_LEVER 0.5    // m a radian of heading weighs in a projection
#define AISLE_MOTION_BARRIER 0.3  // m, see aisle_motion_project()
#define AISLE_MOTION_CUT_EXTRA 3U // waypoints a cut may have more than its path from the place's piece on

typedef struct aisle_place {
    uint32_t piece;
    double u;
} aisle_place;

// A piece as a motion: rest, then phases in which the square of the speed (m/s; rad/s of a turn) is linear in the way.
typedef struct aisle_motion_phase {
    double way, v0, v1; // way > 0
} aisle_motion_phase;
typedef struct aisle_motion_leg {
    const aisle_waypoint_msg *from, *to;
    double way;  // m, or rad of a turn on the spot; 0: a wait
    double rest; // s at rest before it begins
    double time; // s it then takes; the phases by themselves may take a little less or more
    aisle_motion_phase part[3];
    uint32_t parts; // 0: a wait
    bool on_spot;
} aisle_motion_leg;

// Piece i >= 1 of a path, that ends at w[i]. O(1).
aisle_motion_leg aisle_motion_leg_of(const aisle_vehicle *vehicle, const aisle_waypoint_msg *w, const float *dwell,
                                     uint32_t i);

// Is it a place of a path of n waypoints?
bool aisle_place_exists(uint32_t n, aisle_place place);

// Length (m) of the path up to the place, relative error 1e-12. O(pieces before it).
double aisle_motion_length_to(const aisle_waypoint_msg *w, uint32_t n, aisle_place place);

// Pose there, theta in (-pi, pi]. O(1).
aisle_pose2 aisle_motion_pose(const aisle_waypoint_msg *w, uint32_t n, aisle_place place);

// The place `metres` further on (back if negative), no farther than the ends. Turns on the way are passed, those at its end
// are not: 0 m give the place itself. O(pieces between).
aisle_place aisle_motion_advance(const aisle_waypoint_msg *w, uint32_t n, aisle_place place, double metres);

// Speed there, m/s, >= 0; 0 in turns. O(1).
double aisle_motion_speed(const aisle_vehicle *vehicle, const aisle_waypoint_msg *w, uint32_t n, const float *dwell,
                          aisle_place place);

// Time there, s from t = 0 of the path; of (i, 0) the time it leaves waypoint i - 1. Grows along the path. O(1).
double aisle_motion_time(const aisle_vehicle *vehicle, const aisle_waypoint_msg *w, uint32_t n, const float *dwell,
                         aisle_place place);

// Where it is at time t: the inverse, (i, 1) while it rests at waypoint i, the ends before and after. O(log n).
aisle_place aisle_motion_at_time(const aisle_vehicle *vehicle, const aisle_waypoint_msg *w, uint32_t n,
                                 const float *dwell, double t);

// How far a pose is off its place on the path.
typedef struct aisle_off {
    double lateral; // m >= 0, distance of the origins (where the path ends or the window does it is not just sideways)
    double heading; // rad, from the path's to the pose's, in (-pi, pi]
} aisle_off;

// The place nearest to `pose` (finite) among those from `back` before to `ahead` (m >= 0) behind `from`, which is to be
// the farthest place the vehicle has been at; turns at the window's ends belong to it. On a piece it is the nearest point,
// in a turn the nearest heading; among pieces the least hypot(lateral, AISLE_MOTION_LEVER * heading) counts as long as
// each is nearer than the one before. A place behind a barrier, where the path leads away from the pose (by h more than
// the best place so far is off) before it comes back, is another branch: it is taken only if it is not worse by more than
// h / 2 and better by h / 2 when every metre before `from` counts 3, for a vehicle does not go back. Beyond a barrier above
// AISLE_MOTION_BARRIER nothing is looked at. So a path that crosses or follows itself, or reverses over its own track, is
// not left for another branch, and a vehicle that changes direction somewhat too early is found on the way back as soon
// as it goes back. Waits are not told from their ends: a wait is where `from` is, or passed.
// *off (may be NULL) is told for the place found. O(pieces of the window).
aisle_place aisle_motion_project(const aisle_waypoint_msg *w, uint32_t n, aisle_place from, double back, double ahead,
                                 aisle_pose2 pose, aisle_off *off);

// The path from the place on, into out[capacity] (not w), complete with s, t, v and a; returns its number of waypoints,
// 0 if there is no room: n - piece + AISLE_MOTION_CUT_EXTRA always suffice. Curve and speeds are those of w; a piece at
// rest at both ends that is cut in motion is continued in pieces along its trapezoid. The first waypoint has s = t = a = 0,
// no curvature, the speed at the place (rounded down), the piece's clearance, REVERSE as the piece that follows, and STOP
// only where it rests for a turn or a goal. Of (i, 1), and if less than AISLE_MOTION_SNAP of piece i is left, it is
// waypoint i with its goal; of (i, 0) the goal at waypoint i - 1 is behind and told no more, nor any dwell there: what is
// left of a rest at the first waypoint is the caller's to add. A turn that is cut begins anew, at rest, and lasts as long
// as the fastest turn by what is left, at least AISLE_PROFILE_TIME_STEP; of a wait what is left is left. O(n - piece).
uint32_t aisle_motion_cut(const aisle_vehicle *vehicle, const aisle_waypoint_msg *w, uint32_t n, const float *dwell,
                          aisle_place place, aisle_waypoint_msg *out, uint32_t capacity);

// The dwell of a cut path: what belongs to each of its `left` waypoints (all that aisle_motion_cut() returned), into
// out[left]. dwell may be NULL. O(left).
void aisle_motion_cut_dwell(const float *dwell, uint32_t n, aisle_place place, uint32_t left, float *out);

// Where it rests if it goes on for `delay` s (>= 0) and then brakes along the path, with d_max, in a turn with alpha_max.
// v (m/s) is its real speed: where that is more than the path's it brakes with d_max down to the path's at once; where it
// is less, the path's counts. Never beyond where the path rests next when it brakes. O(pieces between).
aisle_place aisle_motion_rest(const aisle_vehicle *vehicle, const aisle_waypoint_msg *w, uint32_t n, const float *dwell,
                              aisle_place place, double v, double delay);
#endif
