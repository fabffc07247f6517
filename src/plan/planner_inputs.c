#include "plan/planner_state.h"

#include "base/check.h"
#include "base/crc32.h"

#include <math.h>
#include <string.h>

#define RATE_MAX 100.0 // m/s, rad/s, of a pose; a faster vehicle is none

aisle_status aisle_planner_reject(aisle_planner *self, int16_t cause, int32_t id) {
    self->counters[AISLE_COUNTER_REJECTED]++;
    self->cause = cause;
    self->cause_id = id;
    return AISLE_ERR_DATA;
}

static aisle_status duplicate(aisle_planner *self) {
    self->counters[AISLE_COUNTER_DUPLICATES]++;
    return AISLE_OK;
}

static bool queue_is_full(const aisle_planner *self) {
    return self->queue_count >= self->config.limits.requests;
}

static aisle_status enqueue(aisle_planner *self, const aisle_request *request) {
    if (queue_is_full(self)) {
        return AISLE_BUSY;
    }
    uint32_t at = (self->queue_head + self->queue_count) % self->config.limits.requests;
    self->queue[at] = *request;
    self->queue_count++;
    return AISLE_OK;
}

// ---- layout

static aisle_status take_layout(aisle_planner *self, const aisle_input *input) {
    if (aisle_planner_is_busy(self)) {
        return AISLE_BUSY;
    }
    aisle_refusal why = {0, 0, 0.0F};
    aisle_status st;
    if (input->kind == AISLE_INPUT_LAYOUT) {
        st = aisle_layout_take_part(self->layout, input->as.layout, &why);
    } else if (input->kind == AISLE_INPUT_GRID) {
        st = aisle_layout_take_tile(self->layout, input->as.grid, &why);
    } else {
        st = aisle_layout_take_patch(self->layout, input->as.layout_patch, &why);
    }
    if (st == AISLE_ERR_DATA) {
        return aisle_planner_reject(self, why.cause, why.id);
    }
    if (aisle_layout_is_staged(self->layout)) {
        aisle_layout_commit(self->layout);
        self->building = true;
        if (!aisle_drive_moves(&self->drive)) {
            aisle_planner_revoke(self, AISLE_STATUS_MAP_MISMATCH, aisle_layout_map_revision(self->layout));
        }
    } else if (st == AISLE_OK) {
        return duplicate(self);
    }
    return st;
}

// ---- vehicle

// Same body and limits, whatever the time it was sent at? Compared as encoded: structs have padding.
static bool same_vehicle(const aisle_vehicle_msg *a, const aisle_vehicle_msg *b) {
    uint8_t bytes[2][1024];
    size_t size[2] = {0, 0};
    if (aisle_msg_encode(AISLE_MSG_VEHICLE, a, bytes[0], sizeof bytes[0], &size[0]) != AISLE_OK ||
        aisle_msg_encode(AISLE_MSG_VEHICLE, b, bytes[1], sizeof bytes[1], &size[1]) != AISLE_OK) {
        return false;
    }
    size_t utime = AISLE_MSG_FINGERPRINT_SIZE + 8U; // skip the fingerprint and utime
    return size[0] == size[1] && memcmp(bytes[0] + utime, bytes[1] + utime, size[0] - utime) == 0;
}

// Same body and limits by what they mean, whatever the revision?
static bool is_same_body(const aisle_vehicle *a, const aisle_vehicle *b) {
    uint8_t bytes[2][AISLE_VEHICLE_CONTENT_BYTES];
    const size_t size = aisle_vehicle_content(a, bytes[0]);
    return size == aisle_vehicle_content(b, bytes[1]) && memcmp(bytes[0], bytes[1], size) == 0;
}

// The plan is proved again for the vehicle as it is now; one that is at rest and has another body plans anew.
static void change_vehicle_under_way(aisle_planner *self, bool is_same) {
    const bool goes_on = self->drive.has_plan && (is_same || aisle_drive_moves(&self->drive));
    if (goes_on) {
        self->drive.must_change = true;
        self->cycle_wanted = true;
    } else {
        aisle_planner_revoke(self, AISLE_STATUS_CONFLICT, self->vehicle.revision);
    }
    if (!goes_on || !is_same) {
        aisle_mission_reconsider(&self->mission);
        aisle_planner_replan(self);
    }
}

static aisle_status take_vehicle(aisle_planner *self, const aisle_vehicle_msg *msg) {
    if (aisle_planner_is_busy(self)) {
        return AISLE_BUSY;
    }
    if (self->vehicle_sent && msg->vehicle_revision < self->vehicle.revision) {
        return aisle_planner_reject(self, AISLE_STATUS_OUTDATED, msg->vehicle_revision);
    }
    if (self->vehicle_sent && msg->vehicle_revision == self->vehicle.revision) {
        return same_vehicle(msg, self->vehicle_msg)
                   ? duplicate(self)
                   : aisle_planner_reject(self, AISLE_STATUS_CONFLICT, msg->vehicle_revision);
    }
    aisle_refusal why = {0, 0, 0.0F};
    const aisle_vehicle before = self->vehicle;
    if (aisle_vehicle_from_msg(msg, &self->vehicle, &why) != AISLE_OK) {
        return aisle_planner_reject(self, why.cause, why.id);
    }
    const bool is_same = self->has_vehicle && is_same_body(&before, &self->vehicle);
    *self->vehicle_msg = *msg;
    self->has_vehicle = true;
    self->vehicle_sent = true;
    change_vehicle_under_way(self, is_same);
    return AISLE_OK;
}

// ---- pose

static void note_progress(aisle_planner *self) {
    const bool is_known = aisle_planner_pose_hindrance(self).cause == 0;
    uint32_t reached = aisle_mission_note_pose(&self->mission, &self->vehicle, is_known ? &self->pose : NULL);
    for (; reached > 0U && self->drive.has_plan; reached--) {
        aisle_drive_pass_goal(&self->drive);
    }
}

// A mission refused for want of a pose is planned when there is one.
static void try_refused_mission(aisle_planner *self) {
    const aisle_mission *mission = &self->mission;
    bool by_pose = mission->cause == AISLE_STATUS_NO_POSE || mission->cause == AISLE_STATUS_NOT_LOCALIZED ||
                   mission->cause == AISLE_STATUS_MAP_MISMATCH;
    if (!mission->wanted || self->drive.has_plan || !by_pose || mission->replan) {
        return;
    }
    const aisle_request *request = aisle_planner_renew_request(self);
    if (aisle_planner_hindrance(self, request).cause != mission->cause) {
        aisle_planner_replan(self);
    }
}

// What a cycle goes by came while there is a plan: the next one answers it.
static void count_cycle_input(aisle_planner *self) {
    self->counters[AISLE_COUNTER_CYCLE_INPUTS] += self->drive.has_plan ? 1 : 0;
}

static aisle_status take_pose(aisle_planner *self, const aisle_pose_msg *msg) {
    if (self->drive.stage != AISLE_DRIVE_IDLE) {
        return AISLE_BUSY;
    }
    const bool is_place =
        fabs(msg->x) <= AISLE_SHAPE_COORD_MAX && fabs(msg->y) <= AISLE_SHAPE_COORD_MAX && fabs(msg->theta) <= 1e4;
    const bool is_slow =
        fabs((double)msg->vx) <= RATE_MAX && fabs((double)msg->vy) <= RATE_MAX && fabs((double)msg->omega) <= RATE_MAX;
    if (!is_place || !is_slow) {
        return aisle_planner_reject(self, AISLE_STATUS_MALFORMED, msg->seq);
    }
    if (self->has_pose && msg->utime < self->pose.utime) {
        return aisle_planner_reject(self, AISLE_STATUS_OUTDATED, msg->seq);
    }
    if (self->has_pose && msg->utime == self->pose.utime && msg->seq == self->pose.seq) {
        return duplicate(self);
    }
    self->pose = *msg;
    self->pose_at_us = self->now_us;
    self->has_pose = true;
    self->cycle_wanted = true;
    note_progress(self);
    if (self->has_vehicle) {
        aisle_drive_locate(&self->drive, &self->vehicle, msg);
    }
    if (!self->mission.wanted && aisle_drive_is_stopping(&self->drive) && !aisle_drive_moves(&self->drive)) {
        aisle_planner_revoke(self, 0, 0);
    } else if (!self->mission.wanted && !aisle_drive_moves(&self->drive)) { // all is done
        aisle_drive_drop(&self->drive);
    }
    try_refused_mission(self);
    count_cycle_input(self);
    return AISLE_OK;
}

// ---- requests

static bool count_is_bad(int16_t num_goals) {
    return num_goals < 0 || num_goals > AISLE_GOAL_LIST_MAX_GOALS;
}

static aisle_status take_query(aisle_planner *self, const aisle_query_msg *msg) {
    if (count_is_bad(msg->num_goals)) {
        return aisle_planner_reject(self, AISLE_STATUS_LIMIT, msg->num_goals);
    }
    aisle_request request = {.is_query = true,
                             .query_id = msg->query_id,
                             .map_id = msg->map_id,
                             .start = msg->start,
                             .options = msg->options,
                             .ordering = msg->ordering,
                             .num_goals = msg->num_goals};
    memcpy(request.goals, msg->goals, (size_t)msg->num_goals * sizeof msg->goals[0]);
    return enqueue(self, &request);
}

static aisle_status take_arm_goal(aisle_planner *self, const aisle_arm_goal_msg *msg) {
    aisle_request request = {.is_arm = true, .arm_goal = *msg};
    aisle_planner_arm_note_pose(self, &request);
    return enqueue(self, &request);
}

// Nothing is left to do: a vehicle that moves is stopped by the next cycle.
static void end_mission(aisle_planner *self) {
    self->cycle_wanted = true;
    if (!aisle_drive_moves(&self->drive)) {
        aisle_planner_revoke(self, 0, 0);
    }
}

static void cancel_mission(aisle_planner *self) {
    end_mission(self);
    aisle_mission_cancel(&self->mission);
}

// Gives up one goal; the last one ends the mission.
static aisle_status skip_goal(aisle_planner *self, int32_t id) {
    if (!aisle_mission_skip(&self->mission, id)) {
        return aisle_planner_reject(self, AISLE_STATUS_MALFORMED, id);
    }
    if (!self->mission.wanted) {
        end_mission(self);
    }
    return AISLE_OK;
}

static aisle_status take_goals(aisle_planner *self, const aisle_goal_list_msg *msg) {
    aisle_mission *mission = &self->mission;
    aisle_refusal why;
    const aisle_status st = aisle_mission_judge(mission, msg, &why);
    if (st == AISLE_ERR_DATA) {
        return aisle_planner_reject(self, why.cause, why.id);
    }
    if (st == AISLE_PARTIAL) {
        return duplicate(self);
    }
    if (msg->num_goals > 0 && queue_is_full(self)) {
        return AISLE_BUSY;
    }
    aisle_mission_take(mission, msg);
    if (!mission->wanted) { // cancelled, or all of it was reached before
        end_mission(self);
        return AISLE_OK;
    }
    return enqueue(self, aisle_planner_renew_request(self));
}

void aisle_planner_replan(aisle_planner *self) {
    self->mission.replan = self->mission.wanted;
    self->leaving.round = false;
}

aisle_request *aisle_planner_renew_request(aisle_planner *self) {
    return aisle_mission_ask(&self->mission, self->has_pose ? &self->pose : NULL);
}

// ---- obstacles and commands

static aisle_status take_obstacles(aisle_planner *self, const aisle_obstacles_msg *msg) {
    aisle_refusal why;
    if (self->drive.stage != AISLE_DRIVE_IDLE || self->weighing != AISLE_WEIGHING_NOTHING) {
        return AISLE_BUSY;
    }
    const aisle_status st =
        aisle_movers_take(&self->movers, msg, self->now_us, aisle_layout_map_id(self->layout), &why);
    if (st == AISLE_ERR_DATA) {
        return aisle_planner_reject(self, why.cause, why.id);
    }
    if (st == AISLE_PARTIAL) {
        return duplicate(self);
    }
    self->cycle_wanted = true;
    count_cycle_input(self);
    return AISLE_OK;
}

static aisle_status take_command(aisle_planner *self, const aisle_command_msg *msg) {
    aisle_status st = AISLE_OK;
    switch (msg->command) {
    case AISLE_COMMAND_HOLD:
        self->held = true;
        self->cycle_wanted = true;
        break;
    case AISLE_COMMAND_RESUME:
        self->held = false;
        self->lease_due_us = self->now_us;
        self->cycle_wanted = true;
        break;
    case AISLE_COMMAND_CANCEL:
        if (msg->arg != 0) {
            st = skip_goal(self, msg->arg);
        } else {
            cancel_mission(self);
        }
        break;
    case AISLE_COMMAND_RESEND:
        self->lease_due_us = self->now_us;
        break;
    default:
        return aisle_planner_reject(self, AISLE_STATUS_MALFORMED, msg->command);
    }
    if (st == AISLE_OK) {
        self->command_id = msg->command_id;
    }
    return st;
}

static aisle_status dispatch(aisle_planner *self, const aisle_input *input) {
    switch (input->kind) {
    case AISLE_INPUT_LAYOUT:
    case AISLE_INPUT_LAYOUT_PATCH:
    case AISLE_INPUT_GRID:
        return take_layout(self, input);
    case AISLE_INPUT_VEHICLE:
        return take_vehicle(self, input->as.vehicle);
    case AISLE_INPUT_POSE:
        return take_pose(self, input->as.pose);
    case AISLE_INPUT_GOALS:
        return take_goals(self, input->as.goals);
    case AISLE_INPUT_QUERY:
        return take_query(self, input->as.query);
    case AISLE_INPUT_OBSTACLES:
        return take_obstacles(self, input->as.obstacles);
    case AISLE_INPUT_COMMAND:
        return take_command(self, input->as.command);
    case AISLE_INPUT_ARM_GOAL:
        return take_arm_goal(self, input->as.arm_goal);
    default:
        return AISLE_ERR_ARG;
    }
}

aisle_status aisle_planner_submit(aisle_planner *self, int64_t now_us, const aisle_input *input) {
    if (input == NULL || input->as.layout == NULL) {
        return AISLE_ERR_ARG;
    }
    if (now_us > self->now_us) {
        self->now_us = now_us;
    }
    aisle_status st = dispatch(self, input);
    if (st == AISLE_ERR_DATA) {
        self->cause_kind = input->kind;
    } else if (st == AISLE_OK || st == AISLE_PARTIAL) {
        self->counters[AISLE_COUNTER_INPUTS]++;
        self->cause = self->cause_kind == input->kind ? 0 : self->cause;
    }
    return st;
}

uint32_t aisle_layout_crc32(uint32_t crc, const aisle_layout_msg *part) {
    AISLE_ASSERT(part->num_polygons >= 0 && part->num_polygons <= AISLE_LAYOUT_MAX_POLYGONS);
    for (int16_t i = 0; i < part->num_polygons; i++) {
        uint8_t bytes[512]; // a polygon of 16 vertices takes 271
        size_t size = 0;
        if (aisle_msg_encode_body(AISLE_MSG_POLYGON, &part->polygons[i], bytes, sizeof bytes, &size) == AISLE_OK) {
            crc = aisle_crc32(crc, bytes, size);
        }
    }
    return crc;
}
