#include "plan/manoeuvre_parts.h"

#include <math.h>

#define PART 0.5 // m, of a move

static bool keeps(aisle_manoeuvre *self, aisle_pose2 pose, double need) {
    const aisle_space *space = self->request.space;
    self->units += 1U;
    double around = aisle_grid_gap_lower(space->grid, aisle_pose_place(pose));
    return around - space->vehicle->outer_radius >= need || aisle_space_gap(space, pose, need, NULL) >= need;
}

bool aisle_manoeuvre_pose_free(aisle_manoeuvre *self, aisle_pose2 pose) {
    return keeps(self, pose, self->need);
}

double aisle_manoeuvre_surcharge(aisle_manoeuvre *self, aisle_pose2 from, const aisle_move *moves, uint32_t count) {
    double near = 0.0;
    if (self->request.dear <= 1U) {
        return near;
    }
    for (uint32_t i = 0; i < count; i++) {
        const double metres = fabs(moves[i].length);
        const double parts = metres > 0.0 ? floor(metres / PART) + 1.0 : 0.0; // no turn on the spot is dearer
        for (double k = 1.0; k <= parts; k += 1.0) {
            const aisle_pose2 at = aisle_move_end(from, aisle_move_part(moves[i], k / parts));
            near += keeps(self, at, self->request.clear) ? 0.0 : metres / parts;
        }
        from = aisle_move_end(from, moves[i]);
    }
    return near * (double)(self->request.dear - 1U);
}

bool aisle_manoeuvre_moves_free(aisle_manoeuvre *self, aisle_pose2 from, const aisle_move *moves, uint32_t count) {
    // What is made from the goal is driven the other way.
    return aisle_space_moves_free(self->request.space, from, moves, count, self->need, self->side < 0.0, &self->units);
}
