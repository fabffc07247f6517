#include "aisle/energy.h"

#include "base/angle.h"
#include "robot/profile.h"

#include <float.h>
#include <math.h>

#define REST 1e-6 // m/s; slower is at rest

static bool is_fit(const aisle_waypoint_msg *w) {
    return fabs(w->x) <= AISLE_SHAPE_COORD_MAX && fabs(w->y) <= AISLE_SHAPE_COORD_MAX &&
           fabs(w->theta) <= AISLE_ANGLE_MAX && fabs((double)w->curvature) <= (double)FLT_MAX && w->v >= 0.0F &&
           (double)w->v <= 1e3 && w->t >= 0.0F && (double)w->t <= (double)FLT_MAX;
}

static bool path_is_fit(const aisle_path_msg *path) {
    if (path->num_waypoints < 1 || path->num_waypoints > AISLE_PATH_MAX_WAYPOINTS) {
        return false;
    }
    for (int16_t i = 0; i < path->num_waypoints; i++) {
        if (!is_fit(&path->waypoints[i]) || (i > 0 && path->waypoints[i].t < path->waypoints[i - 1].t)) {
            return false;
        }
    }
    return true;
}

// Peak of the trapezoid that fills the time: q v^2 - time v + way = 0, the slower root.
static double peak_of(const aisle_vehicle *vehicle, double way, double time) {
    const double q = 0.5 / vehicle->a_max + 0.5 / vehicle->d_max;
    const double root = aisle_max(time * time - 4.0 * q * way, 0.0);
    return time > 0.0 ? 2.0 * way / (time + sqrt(root)) : 0.0;
}

static aisle_energy piece_energy(const aisle_vehicle *vehicle, const aisle_waypoint_msg *from,
                                 const aisle_waypoint_msg *to, double dwell) {
    const double time = (double)to->t - (double)from->t;
    const double length = aisle_piece_length(from, to);
    double peak = 0.0;
    if ((double)from->v <= REST && (double)to->v <= REST) {
        peak = peak_of(vehicle, length, time - dwell);
    }
    const aisle_piece_work work = aisle_piece_work_of(vehicle, from, to, peak);
    return (aisle_energy){.rolling = (float)(work.rolling / vehicle->drive_efficiency),
                          .acceleration = (float)(work.acceleration / vehicle->drive_efficiency),
                          .turning = (float)(work.turning / vehicle->drive_efficiency),
                          .idle = (float)(vehicle->idle_power * time)};
}

aisle_status aisle_path_energy(const aisle_path_msg *path, const aisle_vehicle_msg *vehicle,
                               const aisle_goal_msg *goals, uint32_t num_goals, aisle_energy *each, aisle_energy *sum) {
    aisle_vehicle body;
    aisle_refusal why;
    if (path == NULL || vehicle == NULL || sum == NULL || !path_is_fit(path)) {
        return AISLE_ERR_ARG;
    }
    const aisle_status st = aisle_vehicle_from_msg(vehicle, &body, &why);
    if (st != AISLE_OK) {
        return st;
    }
    double total[4] = {0.0, 0.0, 0.0, 0.0};
    uint32_t reached = 0;
    for (int16_t i = 0; i < path->num_waypoints; i++) {
        const aisle_waypoint_msg *to = &path->waypoints[i];
        aisle_energy e = {0.0F, 0.0F, 0.0F, 0.0F};
        if (i > 0) {
            const bool stood = ((to - 1)->flags & AISLE_WAYPOINT_GOAL) != 0 && goals != NULL && reached <= num_goals;
            e = piece_energy(&body, to - 1, to, stood ? aisle_max((double)goals[reached - 1U].dwell, 0.0) : 0.0);
        }
        reached += (to->flags & AISLE_WAYPOINT_GOAL) != 0 ? 1U : 0U;
        total[0] += (double)e.rolling;
        total[1] += (double)e.acceleration;
        total[2] += (double)e.turning;
        total[3] += (double)e.idle;
        if (each != NULL) {
            each[i] = e;
        }
    }
    *sum = (aisle_energy){(float)total[0], (float)total[1], (float)total[2], (float)total[3]};
    return AISLE_OK;
}
