#include "plan/planner_state.h"

#include "base/check.h"

#include <string.h>

static void queue(aisle_planner *self, aisle_event_kind kind, const uint8_t *bytes, size_t size,
                  const aisle_stamp *stamp) {
    self->out[kind] = (aisle_outgoing){.bytes = bytes, .size = size, .stamp = stamp, .waiting = true};
}

static void fill_head(aisle_planner *self, const aisle_request *request) {
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
    head->t0_utime = self->now_us;
    head->valid_until_utime = self->now_us;
}

void aisle_planner_refuse(aisle_planner *self, const aisle_request *request, const aisle_refusal *why,
                          const aisle_waypoint_msg *told, uint32_t told_count, uint32_t work_units) {
    aisle_event_kind kind = request->is_query ? AISLE_EVENT_REPLY : AISLE_EVENT_PATH;
    if (kind == AISLE_EVENT_PATH) {
        self->path_revision++;
        self->mission.has_path = false;
        self->mission.cause = why->cause;
        self->mission.cause_id = why->id;
    }
    fill_head(self, request);
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
    queue(self, kind, self->refusal[kind], size, NULL);
    self->counters[AISLE_COUNTER_NO_PATHS]++;
}

// Renewing the lease changes nothing else, so the proof of the bytes stays good.
static void put_lease(aisle_planner *self, aisle_proof *proof) {
    aisle_msg_put_int64(proof->bytes + AISLE_PATH_AT_UTIME, self->now_us);
    aisle_msg_put_int64(proof->bytes + AISLE_PATH_AT_VALID_UNTIL_UTIME, self->now_us + AISLE_LEASE_US);
}

// Work is spent after the proof, too: the answer tells all of it.
static void put_work_units(const aisle_proof *proof, uint32_t spent) {
    aisle_msg_put_int32(proof->bytes + AISLE_PATH_AT_WORK_UNITS, (int32_t)spent);
}

// The mission's new path leaves, or is kept back until it may be driven.
static void send_or_hold(aisle_planner *self) {
    int32_t id;
    if (self->held || aisle_planner_lease_hindrance(self, self->now_us, &id) != 0) {
        self->lease_due_us = self->now_us;
    } else {
        aisle_planner_renew(self);
    }
}

void aisle_planner_publish(aisle_planner *self, const aisle_request *request, const aisle_proof *proof) {
    self->counters[AISLE_COUNTER_PATHS]++;
    put_work_units(proof, self->route->spent);
    if (request->is_query) {
        queue(self, AISLE_EVENT_REPLY, proof->bytes, proof->size, &proof->stamp);
        return;
    }
    aisle_mission *mission = &self->mission;
    uint32_t passed;
    if (!aisle_mission_take_order(mission, request, &passed)) {
        aisle_planner_replan(self);
        return;
    }
    memcpy(mission->current.bytes, proof->bytes, proof->size);
    mission->current.size = proof->size;
    mission->current.stamp = proof->stamp;
    mission->current.basis = proof->basis;
    mission->has_path = true;
    mission->replan = false;
    aisle_status st = aisle_msg_decode(AISLE_MSG_PATH, proof->bytes, proof->size, mission->path, NULL);
    AISLE_ASSERT(st == AISLE_OK);
    self->path_revision = mission->path->path_revision;
    send_or_hold(self);
}

void aisle_planner_renew(aisle_planner *self) {
    aisle_mission *mission = &self->mission;
    put_lease(self, &mission->current);
    queue(self, AISLE_EVENT_PATH, mission->current.bytes, mission->current.size, &mission->current.stamp);
    self->lease_due_us = self->now_us + AISLE_LEASE_RESEND_US;
}

// The verifier's answer to the mission's path as it lies there, by its earlier proof alone.
static bool is_proved_still(aisle_planner *self) {
    aisle_mission *mission = &self->mission;
    aisle_route *route = self->route; // idle: its verifier is free
    const aisle_goal_msg *start = &mission->request.start;
    const aisle_verify_request request = {.layout = self->layout,
                                          .vehicle = &self->vehicle,
                                          .bytes = mission->current.bytes,
                                          .size = mission->current.size,
                                          .start = {start->x, start->y, start->theta},
                                          .goals = mission->request.goals,
                                          .num_goals = (uint32_t)mission->request.num_goals,
                                          .basis = &mission->current.basis};
    uint32_t spent = 0;
    aisle_verify_start(&route->verify, &request, route->decoded);
    return aisle_verify_step(&route->verify, 1U, &spent, &mission->current.stamp) == AISLE_OK;
}

bool aisle_planner_reprove(aisle_planner *self) {
    aisle_mission *mission = &self->mission;
    AISLE_ASSERT(mission->has_path && !aisle_planner_is_busy(self));
    aisle_path_msg *path = mission->path;
    path->path_revision = self->path_revision + 1;
    path->vehicle_revision = self->vehicle.revision;
    aisle_path_rehead(mission->current.bytes, path, mission->current.basis.waypoints);
    if (!is_proved_still(self)) {
        return false;
    }
    self->path_revision = path->path_revision;
    send_or_hold(self);
    return true;
}

void aisle_planner_revoke(aisle_planner *self, int16_t cause, int32_t id) {
    if (self->mission.has_path) {
        aisle_refusal why = {cause, id, 0.0F};
        aisle_planner_refuse(self, &self->mission.request, &why, NULL, 0, 0);
    }
}

aisle_status aisle_path_decode(const void *bytes, size_t size, aisle_path_msg *path) {
    return aisle_msg_decode(AISLE_MSG_PATH, bytes, size, path, NULL);
}
