#include "plan/planner_state.h"

#include "base/check.h"
#include "wire/codec.h"

#include <string.h>

#define CELLS_A_NODE 128U // of the planning grid, for a node of the tree
#define NODES_MIN 1024U
#define REST_SPEED 0.01 // m/s, rad/s; slower is at rest

// ---- memory

static uint32_t nodes_of(const aisle_limits *limits) {
    const uint32_t share = limits->cells / CELLS_A_NODE;
    return share < NODES_MIN ? NODES_MIN : share > AISLE_ARM_NODES ? AISLE_ARM_NODES : share;
}

size_t aisle_planner_arm_lent(const aisle_limits *limits) {
    aisle_arena arena = aisle_arena_measure();
    aisle_planner_arm_carve(NULL, &arena, limits);
    return arena.used;
}

void aisle_planner_arm_carve(aisle_planner_arm *arm, aisle_arena *lent, const aisle_limits *limits) {
    aisle_arm_route_carve(arm != NULL ? &arm->route : NULL, lent, nodes_of(limits));
}

// ---- goals

static void queue(aisle_planner_arm *arm, const uint8_t *bytes, size_t size, const aisle_stamp *stamp) {
    arm->bytes = bytes;
    arm->size = size;
    arm->stamp = stamp;
    arm->waiting = true;
}

static void fill_head(aisle_planner *self, int32_t arm_goal_id) {
    aisle_arm_path_msg *head = self->arm->route.path;
    memset(head, 0, sizeof *head);
    head->utime = self->now_us;
    head->boot_id = self->config.boot_id;
    head->path_revision = ++self->arm->revision;
    head->arm_goal_id = arm_goal_id;
    head->map_id = aisle_layout_map_id(self->layout);
    head->map_revision = aisle_layout_map_revision(self->layout);
    head->vehicle_revision = self->has_vehicle ? self->vehicle.revision : 0;
    head->t0_utime = self->now_us;
    head->valid_until_utime = self->now_us + AISLE_LEASE_US;
}

// The head is filled; whatever waypoints it had are none.
static void refuse(aisle_planner *self, const aisle_refusal *why, uint32_t spent) {
    aisle_planner_arm *arm = self->arm;
    aisle_arm_path_msg *head = arm->route.path;
    size_t size = 0;
    head->status = AISLE_PATH_NONE;
    head->cause = why->cause;
    head->cause_id = why->id;
    head->planner = 0;
    head->work_units = (int32_t)spent;
    head->clearance_min = head->duration = head->travel = 0.0F;
    head->num_waypoints = 0;
    head->valid_until_utime = head->t0_utime;
    const aisle_status st = aisle_msg_encode(AISLE_MSG_ARM_PATH, head, arm->refusal, sizeof arm->refusal, &size);
    AISLE_ASSERT(st == AISLE_OK);
    queue(arm, arm->refusal, size, NULL);
    self->counters[AISLE_COUNTER_ARM_GOALS]++;
}

static bool is_at_rest(const aisle_planner *self) {
    const aisle_pose_msg *pose = &self->pose;
    const double speed = aisle_vec2_length(aisle_vec2_of((double)pose->vx, (double)pose->vy));
    return speed <= REST_SPEED && fabs((double)pose->omega) <= REST_SPEED && !aisle_drive_moves(&self->drive);
}

void aisle_planner_arm_note_pose(const aisle_planner *self, aisle_request *request) {
    const double timeout = self->has_vehicle ? self->vehicle.pose_timeout : 0.0;
    const aisle_refusal why = aisle_planner_pose_hindrance(self);
    request->arm_cause = why.cause;
    request->arm_cause_id = why.id;
    if (why.cause != 0) {
        return;
    }
    request->pose_utime = self->pose.utime;
    request->arm_pose = (aisle_pose2){self->pose.x, self->pose.y, self->pose.theta};
    if (self->has_vehicle && (double)(self->now_us - self->pose_at_us) > timeout * 1e6) {
        request->arm_cause = AISLE_STATUS_POSE_STALE;
    } else if (!is_at_rest(self)) {
        request->arm_cause = AISLE_STATUS_VEHICLE_MOVES;
    }
}

static aisle_refusal hindrance(const aisle_planner *self, const aisle_request *request) {
    if (!aisle_layout_is_in_force(self->layout)) {
        return (aisle_refusal){AISLE_STATUS_NO_LAYOUT, 0, 0.0F};
    }
    if (!self->has_vehicle) {
        return (aisle_refusal){AISLE_STATUS_NO_VEHICLE, 0, 0.0F};
    }
    return (aisle_refusal){request->arm_cause, request->arm_cause_id, 0.0F};
}

void aisle_planner_arm_begin(aisle_planner *self, const aisle_request *request) {
    const aisle_refusal why = hindrance(self, request);
    fill_head(self, request->arm_goal.arm_goal_id);
    if (why.cause != 0) {
        refuse(self, &why, 0);
        return;
    }
    const aisle_arm_request asked = {.goal = request->arm_goal, .pose = request->arm_pose};
    aisle_arm_route_start(&self->arm->route, self->layout, &self->vehicle, self->vehicle_msg, &asked,
                          self->route->budget_default);
    self->arm->planning = true;
}

static void count(aisle_planner *self) {
    const aisle_arm_route *route = &self->arm->route;
    int64_t *counters = self->counters;
    counters[AISLE_COUNTER_VERIFY_FAILED] += route->verify_failed;
    counters[AISLE_COUNTER_VERIFY_INTERVALS] += route->intervals;
    counters[AISLE_COUNTER_CCD_CALLS] += route->collide.calls;
    if (route->collide.support_max > counters[AISLE_COUNTER_CCD_SUPPORT_MAX]) {
        counters[AISLE_COUNTER_CCD_SUPPORT_MAX] = route->collide.support_max;
    }
}

void aisle_planner_arm_step(aisle_planner *self, uint32_t units) {
    aisle_planner_arm *arm = self->arm;
    const uint32_t before = arm->route.spent;
    const aisle_status st = aisle_arm_route_step(&arm->route, units);
    self->counters[AISLE_COUNTER_WORK_UNITS] += arm->route.spent - before;
    if (st == AISLE_BUSY) {
        return;
    }
    arm->planning = false;
    count(self);
    if (arm->route.size == 0U) {
        refuse(self, &arm->route.cause, arm->route.spent);
        return;
    }
    queue(arm, arm->route.bytes, arm->route.size, &arm->route.stamp);
    self->counters[AISLE_COUNTER_ARM_GOALS]++;
    self->counters[AISLE_COUNTER_ARM_PATHS]++;
}

bool aisle_planner_arm_event(aisle_planner *self, aisle_event *event) {
    aisle_planner_arm *arm = self->arm;
    if (!arm->waiting) {
        return false;
    }
    arm->waiting = false;
    const aisle_status st = aisle_release_arm(arm->bytes, arm->size, arm->stamp, event);
    AISLE_ASSERT(st == AISLE_OK);
    return true;
}
