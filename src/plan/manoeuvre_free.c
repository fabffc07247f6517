#include "plan/manoeuvre_parts.h"

bool aisle_manoeuvre_pose_free(aisle_manoeuvre *self, aisle_pose2 pose) {
    const aisle_space *space = self->request.space;
    self->units += 1U;
    double around = aisle_grid_gap_lower(space->grid, aisle_pose_place(pose));
    return around - space->vehicle->outer_radius >= self->need ||
           aisle_space_gap(space, pose, self->need, NULL) >= self->need;
}

bool aisle_manoeuvre_moves_free(aisle_manoeuvre *self, aisle_pose2 from, const aisle_move *moves, uint32_t count) {
    // What is made from the goal is driven the other way.
    return aisle_space_moves_free(self->request.space, from, moves, count, self->need, self->side < 0.0, &self->units);
}
