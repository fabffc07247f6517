#include "plan/manoeuvre_parts.h"

#include "plan/zones.h"

bool aisle_manoeuvre_pose_free(aisle_manoeuvre *self, aisle_pose2 pose) {
    const aisle_space *space = self->request.space;
    self->units += 1U;
    double around = aisle_grid_gap_lower(space->grid, aisle_pose_place(pose));
    return around - space->vehicle->outer_radius >= self->need ||
           aisle_space_gap(space, pose, self->need, NULL) >= self->need;
}

// Is it against no DIRECTED zone? What is made from the goal is driven the other way.
static bool obeys(const aisle_manoeuvre *self, const aisle_waypoint_msg *from, const aisle_waypoint_msg *to) {
    const aisle_layout *layout = self->request.space->layout;
    if (self->side > 0.0 || !aisle_zones_any_directed(layout)) {
        return aisle_zones_allow_piece(layout, from, to, NULL);
    }
    aisle_waypoint_msg last = *from;
    last.curvature = -to->curvature;
    return aisle_zones_allow_piece(layout, to, &last, NULL);
}

bool aisle_manoeuvre_moves_free(aisle_manoeuvre *self, aisle_pose2 from, const aisle_move *moves, uint32_t count) {
    aisle_waypoint_msg w[AISLE_MOVE_WAYPOINTS + 1U];
    w[0] = (aisle_waypoint_msg){.x = from.x, .y = from.y, .theta = from.theta};
    for (uint32_t i = 0; i < count; i++) {
        uint32_t n = aisle_move_lay(moves[i], w);
        for (uint32_t k = 1; k <= n; k++) {
            if (!aisle_space_piece_free(self->request.space, &w[k - 1U], &w[k], self->need, &self->units) ||
                !obeys(self, &w[k - 1U], &w[k])) {
                return false;
            }
        }
        w[0] = w[n];
        w[0].flags = 0;
    }
    return true;
}
