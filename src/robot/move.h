// move.h - what a vehicle does between two configurations: a line, an arc, or a turn on the spot. Level 3.
//
// A move turns evenly over its length: curvature turn / length along the heading. Memory: none. Time: O(1).
#ifndef AISLE_ROBOT_MOVE_H
#define AISLE_ROBOT_MOVE_H

#include "aisle/messages.h"
#include "base/vec.h"

#include <stdint.h>

#define AISLE_MOVE_WAYPOINTS 4U // that a move of up to four thirds of a full turn takes

typedef struct aisle_move {
    double length; // m along the heading, negative: backwards; 0: on the spot
    double turn;   // rad, of the heading
} aisle_move;

// Where it ends. The chord of an arc of length s and turn t is s sin(t / 2) / (t / 2), at half the turn to the first
// heading. Theta is not wrapped.
aisle_pose2 aisle_move_end(aisle_pose2 from, aisle_move move);

// The part of a move up to a share f in [0, 1].
static inline aisle_move aisle_move_part(aisle_move move, double f) {
    return (aisle_move){f * move.length, f * move.turn};
}

// Writes the pieces of a move as waypoint_t has them to w[1..n], w[0] being where it begins (x, y and theta are read;
// its flags are added to for a turn on the spot), and answers n, at most AISLE_MOVE_WAYPOINTS: an arc or a turn is cut
// so that no piece turns by more than a third of a full turn. Curvature is signed along the motion.
uint32_t aisle_move_lay(aisle_move move, aisle_waypoint_msg *w);
#endif
