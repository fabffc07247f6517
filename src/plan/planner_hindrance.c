#include "plan/planner_state.h"

#include "robot/profile.h"

#include <float.h>

#define HEADING_MAX 1e4 // rad of a stop's heading; also of its tolerances, in their units
bool aisle_planner_is_busy(const aisle_planner *self) {
    return self->planning || self->arm->planning || self->building || self->queue_count > 0 || self->mission.replan ||
           self->drive.stage != AISLE_DRIVE_IDLE || self->weighing != AISLE_WEIGHING_NOTHING;
}

// ---- requests

// Is x in [lo, hi]? Not if it is no number.
static bool within(double x, double lo, double hi) {
    return x >= lo && x <= hi;
}

static bool stop_is_bad(const aisle_goal_msg *stop) {
    return !within(stop->theta, -HEADING_MAX, HEADING_MAX) || !within((double)stop->tolerance_xy, 0.0, HEADING_MAX) ||
           !within((double)stop->tolerance_theta, 0.0, HEADING_MAX) ||
           !within((double)stop->dwell, 0.0, AISLE_PROFILE_DURATION_MAX) || !within(stop->x, -DBL_MAX, DBL_MAX) ||
           !within(stop->y, -DBL_MAX, DBL_MAX);
}

// Numbers no vehicle can mean: the goal's id, 0 for the start or their count.
static bool is_malformed(const aisle_request *request, int32_t *id) {
    *id = 0;
    if (request->num_goals < 1 || stop_is_bad(&request->start)) {
        return true;
    }
    for (int16_t i = 0; i < request->num_goals; i++) {
        if (stop_is_bad(&request->goals[i])) {
            *id = request->goals[i].id;
            return true;
        }
    }
    return aisle_mission_order_is_bad(request->ordering, request->goals, request->num_goals, id);
}

aisle_refusal aisle_planner_pose_hindrance(const aisle_planner *self) {
    if (!self->has_pose) {
        return (aisle_refusal){AISLE_STATUS_NO_POSE, 0, 0.0F};
    }
    if (self->pose.localized == 0) {
        return (aisle_refusal){AISLE_STATUS_NOT_LOCALIZED, self->pose.seq, 0.0F};
    }
    if (self->pose.map_id != 0 && self->pose.map_id != aisle_layout_map_id(self->layout)) {
        return (aisle_refusal){AISLE_STATUS_MAP_MISMATCH, self->pose.map_id, 0.0F};
    }
    return (aisle_refusal){0, 0, 0.0F};
}

aisle_refusal aisle_planner_hindrance(const aisle_planner *self, const aisle_request *request) {
    int32_t id = 0;
    if (!aisle_layout_is_in_force(self->layout)) {
        return (aisle_refusal){AISLE_STATUS_NO_LAYOUT, 0, 0.0F};
    }
    if (!self->has_vehicle) {
        return (aisle_refusal){AISLE_STATUS_NO_VEHICLE, 0, 0.0F};
    }
    if (request->map_id != 0 && request->map_id != aisle_layout_map_id(self->layout)) {
        return (aisle_refusal){AISLE_STATUS_MAP_MISMATCH, aisle_layout_map_id(self->layout), 0.0F};
    }
    if (is_malformed(request, &id)) {
        return (aisle_refusal){AISLE_STATUS_MALFORMED, id, (float)request->num_goals};
    }
    if (request->is_query) {
        return (aisle_refusal){0, 0, 0.0F};
    }
    if (request->pose_utime == 0) {
        return (aisle_refusal){AISLE_STATUS_NO_POSE, 0, 0.0F};
    }
    return aisle_planner_pose_hindrance(self);
}

// ---- lease

int16_t aisle_planner_lease_hindrance(const aisle_planner *self, int64_t now_us, int32_t *id) {
    *id = 0;
    double timeout = self->has_vehicle ? self->vehicle.pose_timeout : 0.2;
    if (!self->has_pose || (double)(now_us - self->pose_at_us) > timeout * 1e6) {
        return AISLE_STATUS_POSE_STALE;
    }
    aisle_refusal why = aisle_planner_pose_hindrance(self);
    *id = why.id;
    if (why.cause == 0 && self->has_vehicle &&
        aisle_movers_stale(&self->movers, now_us, self->vehicle.obstacles_timeout, id)) {
        return AISLE_STATUS_OBSTACLES_STALE;
    }
    return why.cause;
}
