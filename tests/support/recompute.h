// recompute.h - every figure of a path anew, from its waypoints alone: an oracle in long double that shares nothing with
// src/ but the message structs, and knows no more than the contract (lcmtypes/) says.
//
// Pieces as waypoint_t tells them, arcs by their centre, libm. Gaps between the body and polygons by brute force over
// vertices and edges; the least one on a line by golden section, since it is convex there; on arcs and turns that the body
// makes as one from the arcs of corners, exactly; on any other piece by halving it until what a body point can move in the rest of a part leaves no doubt beyond RECOMPUTE_WITHIN.
#ifndef AISLE_TESTS_RECOMPUTE_H
#define AISLE_TESTS_RECOMPUTE_H

#include "aisle/messages.h"

#include <stdbool.h>

#define RECOMPUTE_WITHIN 5e-5L // m, a gap may be told too large by so much
#define RECOMPUTE_POINTS AISLE_PATH_MAX_WAYPOINTS

typedef struct recompute_world {
    double x_min, y_min, x_max, y_max;
    const aisle_polygon_msg *polygons;
    int count;
} recompute_world;

typedef struct recompute_energy { // J, taken from the battery
    long double rolling, acceleration, turning, idle;
} recompute_energy;

// What can be wrong, and by how much: above 0 by more than rounding is a fault.
typedef enum recompute_rule {
    RECOMPUTE_MARGIN,       // m: margin less the least gap of the body
    RECOMPUTE_CLEARANCE,    // m: clearance told less the gap found
    RECOMPUTE_CREEP,        // share: speed over creep_speed where the gap is below creep_clearance
    RECOMPUTE_SPEED,        // share: over v_max or v_reverse_max
    RECOMPUTE_ACCELERATION, // share: over a_max
    RECOMPUTE_BRAKING,      // share: over d_max
    RECOMPUTE_LATERAL,      // share: over lateral_a_max
    RECOMPUTE_TURN_RATE,    // share: over omega_max
    RECOMPUTE_CURVATURE,    // share: over curvature_max, where there is one; a turn on the spot there is 1
    RECOMPUTE_HEADING, // rad: heading off the motion at either end of a piece (OMNI: motion not steady where it moves)
    RECOMPUTE_REST,    // m/s: where it must rest
    RECOMPUTE_ZONE_SPEED, // share: over a SPEED_LIMIT zone's value where the body touches it
    RECOMPUTE_DIRECTION,  // m: how deep in a DIRECTED zone the origin moves against it by more than 2 mrad
    RECOMPUTE_S,          // m: s told off the length so far
    RECOMPUTE_T,          // s: t told off the time recomputed piece by piece from the told t before it
    RECOMPUTE_LENGTH,     // share: of the path's sums off those found
    RECOMPUTE_DURATION,
    RECOMPUTE_ENERGY,
    RECOMPUTE_RULES
} recompute_rule;

typedef struct recompute_finding {
    long double excess;
    int waypoint; // the end of the piece
} recompute_finding;

typedef struct recompute_report {
    recompute_finding worst[RECOMPUTE_RULES];
    long double length, duration, clearance;
    recompute_energy energy;                 // of the whole
    recompute_energy each[RECOMPUTE_POINTS]; // of the piece that ends there
    long double gap[RECOMPUTE_POINTS];       // m, least on the piece that ends there
    long double time[RECOMPUTE_POINTS];      // s, of that piece, dwell before it included
    long double penalty;                     // m, sum over PENALTY zones of 15 value * origin's length inside
} recompute_report;

// goals[num_goals]: for their dwell.
void recompute(const aisle_path_msg *path, const aisle_vehicle_msg *vehicle, const recompute_world *world,
               const aisle_goal_msg *goals, int num_goals, recompute_report *out);

long double recompute_sum(const recompute_energy *energy);
const char *recompute_name(recompute_rule rule);

// Is every excess within what floats and the contract's tolerances leave? If not, *rule is the first one.
bool recompute_is_fine(const recompute_report *report, recompute_rule *rule);
#endif
