// curve.h - from points to the pieces a controller follows: lines, arcs, turns on the spot. Level 3.
//
// Appends to a caller's array of waypoints; fills x, y, theta, curvature, flags and goal_id, nothing else (speeds come
// from profile.h). Heading is continuous and along the motion, so two curves join only by equal headings or a turn on
// the spot. Corner arcs: an arc of radius R tangent to both legs of a corner that turns by phi begins R tan(phi / 2)
// before it. Of the wishes (max_radius, zone) the smaller holds; never more than half of a neighbouring leg (the
// papers' corner zones, PAPERS 4). Arcs keep what the legs keep: if both legs keep a distance D from a convex corner
// inside, an arc with R <= D keeps it too. Biarcs: two arcs with a common tangent through (p0, t0) and (p1, t1); equal
// tangent lengths (Bolton 1975). So a sampled spline becomes a curve with continuous heading that passes through every
// sample.
// Memory: the caller's. Time: O(points).
#ifndef AISLE_ROBOT_CURVE_H
#define AISLE_ROBOT_CURVE_H

#include "aisle/messages.h"
#include "aisle/status.h"
#include "base/vec.h"

#include <stdbool.h>
#include <stdint.h>

#define AISLE_CURVE_HEADING_TOLERANCE 5e-7 // rad, below it a turn is left out: less than the verifier sees

typedef struct aisle_curve {
    aisle_waypoint_msg *w; // [capacity]
    uint32_t n, capacity;
    bool overflow; // a waypoint did not fit; nothing more is appended
} aisle_curve;

// May the arc that ends at `to` be driven? NULL in the rule: always.
typedef bool (*aisle_arc_free_fn)(void *ctx, const aisle_waypoint_msg *from, const aisle_waypoint_msg *to);

typedef struct aisle_corner_rule {
    double max_radius;  // m, tried first; 0 = no arcs, stop and turn in every corner
    double sure_radius; // m, tried next, then its halves
    double min_radius;  // m, below it a corner is a stop with a turn on the spot
    double zone;        // m, the arc begins at most so far before the corner; 0 = no such limit
    aisle_arc_free_fn arc_free;
    void *ctx;
} aisle_corner_rule;

// First waypoint.
void aisle_curve_begin(aisle_curve *self, aisle_pose2 start);

// Turns on the spot to theta, if it differs by more than AISLE_CURVE_HEADING_TOLERANCE; marks the stop.
void aisle_curve_turn_to(aisle_curve *self, double theta);

// Straight line to p along the present heading (the caller has turned there); points nearer than 1e-6 m are left out.
void aisle_curve_line_to(aisle_curve *self, aisle_vec2 p);

// Joins points[n] (the first one is where the curve stands) by lines with corners by rule; turns to the first leg's
// direction before.
void aisle_curve_polyline(aisle_curve *self, const aisle_vec2 *points, uint32_t n, const aisle_corner_rule *rule);

// Appends biarcs to p with tangent direction (unit length) there; the curve's present heading is the first tangent.
void aisle_curve_biarc_to(aisle_curve *self, aisle_vec2 p, aisle_vec2 tangent);

// Appends ready pieces: w[0] is where they begin, the curve's present place; turns to its heading before.
void aisle_curve_pieces(aisle_curve *self, const aisle_waypoint_msg *w, uint32_t n);

// Marks the last waypoint as goal `id` and as a stop; if it is a goal already, a turn on the spot by nothing goes in
// between.
void aisle_curve_goal(aisle_curve *self, int32_t id);

// Point of the piece from -> to at fraction f in [0, 1]: position on the line or arc, theta by fraction.
aisle_pose2 aisle_piece_at(const aisle_waypoint_msg *from, const aisle_waypoint_msg *to, double f);

// A waypoint there, f in (0, 1), of the piece from to - 1: with to's curvature, clearance and REVERSE, all else 0.
aisle_waypoint_msg aisle_piece_part(const aisle_waypoint_msg *to, double f);
#endif
