#include "plan/planner_state.h"

#include <stddef.h>

static int8_t state_of(const aisle_planner *self, int64_t now_us, int16_t *cause, int32_t *cause_id) {
    const aisle_mission *mission = &self->mission;
    *cause = self->cause;
    *cause_id = self->cause != 0 ? self->cause_id : 0;
    if (!aisle_layout_is_in_force(self->layout) || !self->has_vehicle) {
        if (*cause == 0) {
            *cause = self->has_vehicle ? AISLE_STATUS_NO_LAYOUT : AISLE_STATUS_NO_VEHICLE;
        }
        return AISLE_STATUS_WAITING;
    }
    if (self->held) {
        return AISLE_STATUS_HELD;
    }
    if (aisle_planner_is_busy(self) && !self->drive.has_plan) {
        return AISLE_STATUS_PLANNING;
    }
    if (!mission->wanted) {
        return AISLE_STATUS_IDLE;
    }
    const aisle_drive *drive = &self->drive;
    int32_t id = 0;
    int16_t stopped = drive->has_plan ? aisle_planner_lease_hindrance(self, now_us, &id) : mission->cause;
    if (stopped != 0 || !drive->has_plan) {
        *cause = stopped;
        *cause_id = drive->has_plan ? id : mission->cause_id;
        return AISLE_STATUS_BLOCKED;
    }
    if (drive->why.cause != 0) { // slowed or stopped
        *cause = drive->why.cause;
        *cause_id = drive->why.id;
    }
    return drive->has_out && drive->out.level < AISLE_PACE_STOP ? AISLE_STATUS_ACTIVE : AISLE_STATUS_BLOCKED;
}

// Distance and time left of the plan, as fast as the ground allows.
static void remaining(const aisle_planner *self, aisle_status_msg *status) {
    const aisle_drive_path *plan = &self->drive.plan;
    if (!self->drive.has_plan) {
        return;
    }
    const uint32_t n = (uint32_t)(uint16_t)plan->msg->num_waypoints;
    const aisle_waypoint_msg *w = plan->msg->waypoints;
    status->distance_remaining = w[n - 1U].s - (float)aisle_motion_length_to(w, n, plan->at);
    status->time_remaining = w[n - 1U].t - (float)aisle_motion_time(&self->vehicle, w, n, plan->dwell, plan->at);
}

static float age(bool known, int64_t now_us, int64_t since_us) {
    return known ? (float)((double)(now_us - since_us) * 1e-6) : -1.0F;
}

void aisle_planner_status(const aisle_planner *self, int64_t now_us, aisle_status_msg *status) {
    const aisle_mission *mission = &self->mission;
    int64_t now = now_us > self->now_us ? now_us : self->now_us;
    *status = (aisle_status_msg){
        .utime = now_us,
        .boot_id = self->config.boot_id,
        .protocol = AISLE_PROTOCOL,
        .map_id = aisle_layout_map_id(self->layout),
        .map_revision = aisle_layout_map_revision(self->layout),
        .vehicle_revision = self->has_vehicle ? self->vehicle.revision : 0,
        .path_revision = self->path_revision,
        .command_id = self->command_id,
        .pose_age = age(self->has_pose, now, self->pose_at_us),
        .obstacles_age = age(aisle_movers_utime(&self->movers) != 0, now, aisle_movers_utime(&self->movers)),
        .num_rejected = (int32_t)self->counters[AISLE_COUNTER_REJECTED]};
    status->state = state_of(self, now, &status->cause, &status->cause_id);
    if (mission->known && !mission->cancelled) {
        status->goal_list_id = mission->list_id;
        status->goal_list_revision = mission->list_revision;
        status->goal_id = mission->wanted ? aisle_mission_goal(mission)->id : 0;
    }
    remaining(self, status);
}

const char *aisle_cause_name(int16_t cause) {
    static const struct {
        int16_t cause;
        const char *name;
    } names[] = {{0, "NONE"},
                 {AISLE_STATUS_NO_LAYOUT, "NO_LAYOUT"},
                 {AISLE_STATUS_NO_VEHICLE, "NO_VEHICLE"},
                 {AISLE_STATUS_NO_POSE, "NO_POSE"},
                 {AISLE_STATUS_POSE_STALE, "POSE_STALE"},
                 {AISLE_STATUS_NOT_LOCALIZED, "NOT_LOCALIZED"},
                 {AISLE_STATUS_POSE_OUTSIDE, "POSE_OUTSIDE"},
                 {AISLE_STATUS_OBSTACLES_STALE, "OBSTACLES_STALE"},
                 {AISLE_STATUS_MAP_MISMATCH, "MAP_MISMATCH"},
                 {AISLE_STATUS_REVISION_GAP, "REVISION_GAP"},
                 {AISLE_STATUS_OUTDATED, "OUTDATED"},
                 {AISLE_STATUS_CONFLICT, "CONFLICT"},
                 {AISLE_STATUS_MALFORMED, "MALFORMED"},
                 {AISLE_STATUS_CLOCK_JUMP, "CLOCK_JUMP"},
                 {AISLE_STATUS_NO_ARM, "NO_ARM"},
                 {AISLE_STATUS_VEHICLE_MOVES, "VEHICLE_MOVES"},
                 {AISLE_STATUS_START_OCCUPIED, "START_OCCUPIED"},
                 {AISLE_STATUS_GOAL_OCCUPIED, "GOAL_OCCUPIED"},
                 {AISLE_STATUS_GOAL_OUTSIDE, "GOAL_OUTSIDE"},
                 {AISLE_STATUS_NO_PATH, "NO_PATH"},
                 {AISLE_STATUS_BLOCKED_BY, "BLOCKED_BY"},
                 {AISLE_STATUS_TOO_NARROW, "TOO_NARROW"},
                 {AISLE_STATUS_KINEMATIC, "KINEMATIC"},
                 {AISLE_STATUS_OUT_OF_REACH, "OUT_OF_REACH"},
                 {AISLE_STATUS_JOINT_LIMIT, "JOINT_LIMIT"},
                 {AISLE_STATUS_BUDGET, "BUDGET"},
                 {AISLE_STATUS_YIELDING, "YIELDING"},
                 {AISLE_STATUS_OFF_PATH, "OFF_PATH"},
                 {AISLE_STATUS_LIMIT, "LIMIT"},
                 {AISLE_STATUS_VERIFY_FAILED, "VERIFY_FAILED"},
                 {AISLE_STATUS_WATCHDOG, "WATCHDOG"},
                 {AISLE_STATUS_INTERNAL, "INTERNAL"}};
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        if (names[i].cause == cause) {
            return names[i].name;
        }
    }
    return "?";
}
