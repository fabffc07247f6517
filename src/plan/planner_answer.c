#include "plan/planner_state.h"

#include "base/check.h"

#include <string.h>

static void queue(aisle_planner *self, aisle_event_kind kind, const uint8_t *bytes, size_t size,
                  const aisle_stamp *stamp, const aisle_moving_stamp *moving) {
    self->out[kind] = (aisle_outgoing){.bytes = bytes, .size = size, .stamp = stamp, .moving = moving, .waiting = true};
}

void aisle_planner_fill_head(aisle_planner *self, const aisle_request *request) {
    aisle_path_msg *head = self->head;
    head->utime = self->now_us;
    head->boot_id = self->config.boot_id;
    head->path_revision = self->path_revision;
    head->query_id = request->query_id;
    head->goal_list_id = request->goal_list_id;
    head->goal_list_revision = request->goal_list_revision;
    head->map_id = aisle_layout_map_id(self->layout);
    head->map_revision = aisle_layout_map_revision(self->layout);
    head->vehicle_revision = self->has_vehicle ? self->vehicle.revision : 0;
    head->pose_utime = request->pose_utime;
    head->obstacles_utime = aisle_movers_utime(&self->movers);
    head->t0_utime = self->now_us;
    head->valid_until_utime = self->now_us;
}

void aisle_planner_refuse(aisle_planner *self, const aisle_request *request, const aisle_refusal *why,
                          const aisle_waypoint_msg *told, uint32_t told_count, uint32_t work_units) {
    aisle_event_kind kind = request->is_query ? AISLE_EVENT_REPLY : AISLE_EVENT_PATH;
    if (kind == AISLE_EVENT_PATH) {
        self->path_revision++;
        self->mission.cause = why->cause;
        self->mission.cause_id = why->id;
    }
    aisle_planner_fill_head(self, request);
    aisle_path_msg *head = self->head;
    head->status = AISLE_PATH_NONE;
    head->cause = why->cause;
    head->cause_id = why->id;
    head->cause_value = why->value;
    head->work_units = (int32_t)work_units;
    AISLE_ASSERT(told_count <= AISLE_ROUTE_TOLD_MAX);
    head->num_waypoints = (int16_t)told_count;
    for (uint32_t i = 0; i < told_count; i++) {
        head->waypoints[i] = told[i];
    }
    size_t size = 0;
    aisle_status st = aisle_path_encode(head, self->refusal[kind], AISLE_REFUSAL_BYTES, &size);
    AISLE_ASSERT(st == AISLE_OK);
    queue(self, kind, self->refusal[kind], size, NULL, NULL);
    self->counters[AISLE_COUNTER_NO_PATHS]++;
}

void aisle_planner_reply(aisle_planner *self, const aisle_proof *proof) {
    self->counters[AISLE_COUNTER_PATHS]++;
    aisle_msg_put_int32(proof->bytes + AISLE_PATH_AT_WORK_UNITS, (int32_t)self->route->spent); // since the proof, too
    queue(self, AISLE_EVENT_REPLY, proof->bytes, proof->size, &proof->stamp, NULL);
}

// Renewing the lease changes nothing else, so the proof of the bytes stays good.
void aisle_planner_send(aisle_planner *self) {
    const aisle_drive_path *out = &self->drive.out;
    self->withdrawn.cause = 0;
    const int64_t until = aisle_drive_lease_until(&self->drive);
    aisle_msg_put_int64(out->bytes + AISLE_PATH_AT_UTIME, self->now_us);
    aisle_msg_put_int64(out->bytes + AISLE_PATH_AT_VALID_UNTIL_UTIME, until);
    const float clearance = aisle_drive_is_stopping(&self->drive) ? 0.0F : out->moving.clearance;
    aisle_msg_put_float(out->bytes + AISLE_PATH_AT_CLEARANCE_MOVING, clearance);
    queue(self, AISLE_EVENT_PATH, out->bytes, out->size, &out->stamp, &out->moving);
    self->lease_due_us = self->now_us + (until - self->now_us) / 2;
}

void aisle_planner_withdraw(aisle_planner *self, const aisle_refusal *why) {
    aisle_mission *mission = &self->mission;
    // Of those that it yields to, now one is named and now another: status_t tells that.
    const bool is_told =
        self->withdrawn.cause == why->cause && (self->withdrawn.id == why->id || why->cause == AISLE_STATUS_YIELDING);
    const bool is_news = self->drive.has_out || !is_told;
    self->drive.has_out = false;
    self->withdrawn = *why;
    if (is_news) {
        aisle_planner_refuse(self, &mission->request, why, NULL, 0, 0);
    }
}

void aisle_planner_revoke(aisle_planner *self, int16_t cause, int32_t id) {
    if (self->drive.has_plan) {
        const aisle_refusal why = {cause, id, 0.0F};
        aisle_drive_drop(&self->drive);
        aisle_planner_refuse(self, &self->mission.request, &why, NULL, 0, 0);
    }
}

aisle_status aisle_path_decode(const void *bytes, size_t size, aisle_path_msg *path) {
    return aisle_msg_decode(AISLE_MSG_PATH, bytes, size, path, NULL);
}
