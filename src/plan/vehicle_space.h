// vehicle_space.h - the configurations of a vehicle, as sampling planners (algo/rrt.h and others) want them. Level 4.
//
// PLACE: (x, y) for a body whose heading does not matter, or for the disc in which it turns: straight motions, tested by
// the space's own sweep (aisle_space_sweep_free(), mode FREE_TURN): by steps of the distance field where obstacles are far,
// by exact shapes where they are near. Before that the field is looked at, at the end first and then at halves, quarters and so
// on: most motions that are not free are refused by one or two looks. Cost: length.
// POSE: (x, y, theta) for all others. The motion between two configurations is the cheapest way of steer.h: lines, arcs and
// turns on the spot, a car's words; the exact body is tested along every move (aisle_space_moves_free()). Cost: steer.h's,
// so that a metre backwards, a cusp and a turn are dearer. Nearest by the Euclidean distance of (x, y,
// AISLE_VEHICLE_SPACE_TURN * theta).
// retract(), both: uphill in the distance field, cell by cell, until the disc about the origin (PLACE: the whole body's, POSE:
// the one inside it) has a cell and a half to spare, or on a ridge; headings stay, and what lies within an obstacle, too.
// Both keep off DIRECTED zones they are against.
// Memory: none. Time: a motion is O(1) in the open, O(metres near obstacles * obstacles near) else; POSE as many times as its
// way has moves.
#ifndef AISLE_PLAN_VEHICLE_SPACE_H
#define AISLE_PLAN_VEHICLE_SPACE_H

#include "algo/rrt.h"
#include "plan/space.h"
#include "robot/steer.h"

#define AISLE_VEHICLE_SPACE_TURN 0.3 // m a rad, in distances

typedef enum aisle_vehicle_space_kind { AISLE_VEHICLE_SPACE_PLACE, AISLE_VEHICLE_SPACE_POSE } aisle_vehicle_space_kind;

typedef struct aisle_vehicle_space {
    aisle_cspace cspace; // its context is this struct, which must stay where it is
    aisle_vehicle_space_kind kind;
    const aisle_space *space;
    aisle_steer_rule rule; // POSE
    double need;           // m, that the body keeps, POSE
} aisle_vehicle_space;

// Turns to a space begun with its layout and vehicle (PLACE: in mode FREE_TURN); it stays the caller's. Samples lie where
// the disc inside the body is within bounds.
void aisle_vehicle_space_begin(aisle_vehicle_space *self, const aisle_space *space, aisle_vehicle_space_kind kind);

// A pose as a configuration, theta brought into bounds; PLACE takes no theta.
void aisle_vehicle_space_of_pose(const aisle_vehicle_space *self, aisle_pose2 pose, double *q);
aisle_pose2 aisle_vehicle_space_pose(const aisle_vehicle_space *self, const double *q); // PLACE: theta 0

// POSE: the moves from a to b that is_free() tests: moves[AISLE_REEDS_SHEPP_MOVES]; how many, 0: a and b are the same.
uint32_t aisle_vehicle_space_moves(const aisle_vehicle_space *self, const double *a, const double *b,
                                   aisle_move *moves);

// m, that no motion between configurations whose places are `distance` (m) apart is longer than. POSE: of the cheapest way,
// by one that always is there: turn, line, turn; a car's shortest is no longer than distance + 4 pi least radii, a cusp after
// every move and all of it backwards.
double aisle_vehicle_space_longest(const aisle_vehicle_space *self, double distance);

// What the planners RRT to RRT_STAR_ADAPTIVE are: all of a config but its ends and seed. plain: the paper's form. step in m; 0:
// chosen by the hall.
aisle_rrt_config aisle_vehicle_space_rrt(const aisle_vehicle_space *self, bool star, bool adaptive, bool plain,
                                         double step);

// The prices of steer.h that searches over configurations go by. radius_min by the vehicle.
aisle_steer_rule aisle_vehicle_space_rule(const aisle_vehicle *vehicle);
#endif
