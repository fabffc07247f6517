// zones.h - what zones that are no obstacles ask of a way: one-way ground and ground that is dear. Level 4.
//
// DIRECTED: where the origin is inside, it must not move against the zone's direction, by more than a right angle and
// AISLE_ZONES_AGAINST. PENALTY: a metre of the origin's way inside costs AISLE_PENALTY_WEIGHT * value more than it would
// outside. SPEED_LIMIT: for FASTEST and LEAST_ENERGY a metre inside costs what the slower drive costs (the speed itself
// is held by profile.h, by the footprint). Tolls of zones that overlap add up. So the cost of a way is
//     integral of the objective's density + sum over zones of toll * length inside,
// the second part exact on straight ways, by chords of AISLE_ZONES_CHORD on arcs. The verifier shares none of this.
// Memory: none. Time: O(zones near * vertices).
#ifndef AISLE_PLAN_ZONES_H
#define AISLE_PLAN_ZONES_H

#include "plan/objective.h"
#include "world/layout.h"

#define AISLE_ZONES_AGAINST 1e-3 // rad, beyond a right angle: less than the verifier allows
#define AISLE_ZONES_CHORD 0.05   // m
#define AISLE_ZONES_ROOM 0.1 // m, that ways keep off zones they are against, so that their corners have room for arcs

// Is there a zone of a kind that asks something of a way? O(1).
bool aisle_zones_any_directed(const aisle_layout *layout);
bool aisle_zones_any_toll(const aisle_layout *layout, int8_t objective);

// Is the straight way from a to b, driven that way round, against no DIRECTED zone, these thought wider by `room` (m, may be
// 0)? If it is, *id (may be NULL) is one it is against.
bool aisle_zones_allow(const aisle_layout *layout, aisle_vec2 a, aisle_vec2 b, double room, int32_t *id);

// The same of a line, arc or turn on the spot between two waypoints, room 0: by chords, each grown by its sagitta, so
// "yes" is sure.
bool aisle_zones_allow_piece(const aisle_layout *layout, const aisle_waypoint_msg *from, const aisle_waypoint_msg *to,
                             int32_t *id);

// Is p within `room` of a DIRECTED zone, edge by edge, or inside one?
bool aisle_zones_is_near_directed(const aisle_layout *layout, aisle_vec2 p, double room);

// What the zones add to the cost of the straight way from a to b, in the objective's metres; of a piece. 0 without such
// zones.
double aisle_zones_toll(const aisle_layout *layout, const aisle_objective *objective, aisle_vec2 a, aisle_vec2 b);
double aisle_zones_toll_piece(const aisle_layout *layout, const aisle_objective *objective,
                              const aisle_waypoint_msg *from, const aisle_waypoint_msg *to);

// What PENALTY zones alone add to a piece: sum of AISLE_PENALTY_WEIGHT * value * length inside, m.
double aisle_zones_penalty_piece(const aisle_layout *layout, const aisle_waypoint_msg *from,
                                 const aisle_waypoint_msg *to);

// Toll of a metre at p.
double aisle_zones_toll_at(const aisle_layout *layout, const aisle_objective *objective, aisle_vec2 p);

// The part of the straight way from a to b that lies inside a convex outline grown by `room` (edges moved outwards), as
// [*from, *to] of it. False: none.
bool aisle_zones_clip(const aisle_convex *outline, double room, aisle_vec2 a, aisle_vec2 b, double *from, double *to);
#endif
