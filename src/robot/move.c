#include "robot/move.h"

#include "base/angle.h"
#include "base/check.h"

#include <math.h>

#define TURN_MAX (2.0 * AISLE_PI / 3.0) // rad, of a piece: well below the half circle that ends the minor arc
#define STRAIGHT 1e-9                   // rad, a turn below it is none

aisle_pose2 aisle_move_end(aisle_pose2 from, aisle_move move) {
    double half = 0.5 * move.turn;
    double sine, cosine, along_x, along_y;
    aisle_sincos(half, &sine, &cosine);
    aisle_sincos(from.theta + half, &along_y, &along_x);
    double chord = fabs(half) < STRAIGHT ? move.length : move.length * sine / half;
    return (aisle_pose2){from.x + chord * along_x, from.y + chord * along_y, from.theta + move.turn};
}

uint32_t aisle_move_lay(aisle_move move, aisle_waypoint_msg *w) {
    double parts = floor(fabs(move.turn) / TURN_MAX) + 1.0;
    uint32_t n = (uint32_t)parts;
    AISLE_ASSERT(n <= AISLE_MOVE_WAYPOINTS);
    bool on_spot = fabs(move.length) <= 0.0;
    bool bent = !on_spot && fabs(move.turn) >= STRAIGHT;
    aisle_pose2 from = {w[0].x, w[0].y, w[0].theta};
    for (uint32_t i = 1; i <= n; i++) {
        aisle_pose2 p = aisle_move_end(from, aisle_move_part(move, (double)i / parts));
        w[i] = (aisle_waypoint_msg){.x = on_spot ? from.x : p.x,
                                    .y = on_spot ? from.y : p.y,
                                    .theta = aisle_angle_wrap(p.theta),
                                    .curvature = bent ? (float)(move.turn / fabs(move.length)) : 0.0F,
                                    .flags = move.length < 0.0 ? AISLE_WAYPOINT_REVERSE : 0};
        if (on_spot) {
            w[i - 1U].flags |= AISLE_WAYPOINT_STOP | AISLE_WAYPOINT_TURN_IN_PLACE;
        }
    }
    return n;
}
