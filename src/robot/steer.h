// steer.h - ways from one configuration to another for a kind of vehicle, no obstacle in sight. Level 3.
//
// A vehicle that turns on the spot: line, arc, line about the corner in which both headings' lines meet (two radii);
// line, turn, line over the same corner; turn, line, turn, forwards and backwards. A car: the words of reeds_shepp.h,
// and line, arc, line where the corner leaves more than the least radius.
// Memory: the caller's. Time: O(1), 0.3 us on the spot, 4 us for a car. Reentrant.
#ifndef AISLE_ROBOT_STEER_H
#define AISLE_ROBOT_STEER_H

#include "robot/reeds_shepp.h"

#define AISLE_STEER_WAYS 6U    // that are given for a pair, the cheapest
#define AISLE_STEER_FAR 40.0   // m, no move of a line-corner-line way is longer
#define AISLE_STEER_RADIUS 1.5 // m, arcs in corners are no wider, but for cars that need it

typedef struct aisle_steer_rule {
    double radius_min; // m, of a car, > 0; 0: turns on the spot
    double reverse;    // >= 1, cost of a metre backwards, of one forwards
    double cusp;       // m, cost of a change between forwards and backwards
    double turn_start; // m, cost of a turn on the spot
    double turn_rate;  // m a rad, and of each rad of it
} aisle_steer_rule;

typedef struct aisle_steer_way {
    aisle_move move[AISLE_REEDS_SHEPP_MOVES];
    uint32_t count;
    double cost; // m
} aisle_steer_way;

// Cost of moves driven one after the other, m.
double aisle_steer_cost(const aisle_steer_rule *rule, const aisle_move *moves, uint32_t count);

// Writes the cheapest ways found, cheapest first, to ways[AISLE_STEER_WAYS] and answers how many; equal costs in the
// order above. 0: the configurations are the same, or more than AISLE_STEER_FAR apart where nothing else was found.
// Each leads to `to` within 1e-8 m and rad.
uint32_t aisle_steer(const aisle_steer_rule *rule, aisle_pose2 from, aisle_pose2 to, aisle_steer_way *ways);
#endif
