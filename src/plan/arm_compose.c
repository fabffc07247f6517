#include "plan/arm_compose.h"

#include "base/check.h"
#include "base/rounding.h"

#include <string.h>

bool aisle_arm_plan_time(aisle_arm_plan *self, const aisle_arm *arm, const aisle_arm_dynamics *dynamics,
                         uint32_t *joint) {
    for (uint32_t k = 0; k < self->count; k++) {
        aisle_arm_timing timing;
        aisle_arm_least_duration(arm, dynamics, &self->piece[k], AISLE_ARM_TIMING_PANELS, &timing);
        self->duration[k] = timing.duration;
        if (!(timing.duration < (double)INFINITY)) {
            *joint = timing.joint;
            return false;
        }
    }
    return true;
}

static bool is_straight(const aisle_arm_piece *piece) {
    double bend = 0.0;
    for (uint32_t j = 0; j < piece->links; j++) {
        bend = aisle_max(bend, fabs(piece->c[j][6]) + fabs(piece->c[j][7]));
    }
    return !(bend > 0.0);
}

// The motion at r of a piece that takes `duration` seconds; duration 0: at rest.
static void fill(const aisle_arm_world *world, const aisle_arm_dynamics *dynamics, const aisle_arm_piece *piece,
                 double r, double duration, aisle_arm_waypoint_msg *w) {
    double q[AISLE_ARM_LINKS], rate[AISLE_ARM_LINKS], change[AISLE_ARM_LINKS];
    double inertia[AISLE_ARM_LINKS], gravity[AISLE_ARM_LINKS];
    const double pace = duration > 0.0 ? 1.0 / duration : 0.0;
    aisle_arm_piece_at(piece, r, 0U, q);
    aisle_arm_piece_at(piece, r, 1U, rate);
    aisle_arm_piece_at(piece, r, 2U, change);
    const bool rests = r <= 0.0 || r >= 1.0; // exactly: what is left of a sum at r = 1 is rounding
    for (uint32_t j = 0; j < piece->links; j++) {
        rate[j] = rests ? 0.0 : rate[j] * pace;
        change[j] = rests ? 0.0 : change[j] * pace * pace;
    }
    aisle_arm_torque(dynamics, q, rate, change, inertia, gravity);
    for (uint32_t j = 0; j < piece->links; j++) {
        w->q[j] = (float)q[j];
        w->qd[j] = (float)rate[j];
        w->qdd[j] = (float)change[j];
        w->torque[j] = (float)(inertia[j] + gravity[j]);
        q[j] = (double)w->q[j];
    }
    w->clearance = aisle_float_below(aisle_arm_world_gap(world, q, AISLE_ARM_SIGHT, NULL, NULL));
}

static void begin(aisle_arm_path_msg *path) {
    path->num_waypoints = 0;
    path->duration = path->travel = 0.0F;
    path->clearance_min = (float)AISLE_ARM_SIGHT;
}

static aisle_arm_waypoint_msg *next(aisle_arm_path_msg *path) {
    aisle_arm_waypoint_msg *w = &path->waypoints[path->num_waypoints++];
    memset(w, 0, sizeof *w);
    return w;
}

static void note(aisle_arm_path_msg *path, const aisle_arm_waypoint_msg *w) {
    path->clearance_min = w->clearance < path->clearance_min ? w->clearance : path->clearance_min;
    path->duration = w->t;
}

aisle_status aisle_arm_compose(const aisle_arm_plan *plan, const aisle_arm_world *world,
                               const aisle_arm_dynamics *dynamics, const double *at, double stretch,
                               aisle_arm_path_msg *path) {
    aisle_arm_piece here;
    double travel = 0.0, from = 0.0;
    AISLE_ASSERT(stretch >= 1.0);
    aisle_arm_piece_of(world->arm->links, at, at, NULL, &here);
    begin(path);
    aisle_arm_waypoint_msg *w = next(path);
    fill(world, dynamics, plan->count > 0U ? &plan->piece[0] : &here, 0.0, 0.0, w);
    note(path, w);
    for (uint32_t k = 0; k < plan->count; k++) {
        const aisle_arm_piece *piece = &plan->piece[k];
        const uint32_t steps = is_straight(piece) ? AISLE_ARM_STEPS_STRAIGHT : AISLE_ARM_STEPS;
        const double to = (double)aisle_float_above(from + plan->duration[k] * stretch), duration = to - from;
        if ((uint32_t)path->num_waypoints + steps > (uint32_t)AISLE_ARM_PATH_MAX_WAYPOINTS) {
            return AISLE_ERR_CAPACITY;
        }
        for (uint32_t i = 1; i <= steps; i++) {
            w = next(path);
            w->t = i < steps ? (float)(from + duration * (double)i / (double)steps) : (float)to;
            fill(world, dynamics, piece, i < steps ? ((double)w->t - from) / duration : 1.0, duration, w);
            note(path, w);
        }
        travel += aisle_arm_piece_travel_exact(piece);
        from = to;
    }
    path->travel = (float)travel;
    return AISLE_OK;
}
