// planner_state.h - what lies behind planner.h; for planner*.c alone. Level 4.
//
// planner.c: memory, step, events. planner_inputs.c: what each message does. planner_hindrance.c: what keeps a
// request or a
// lease from going on. planner_answer.c: paths and reasons out. planner_status.c: the heartbeat, names of causes.
#ifndef AISLE_PLAN_PLANNER_STATE_H
#define AISLE_PLAN_PLANNER_STATE_H

#include "aisle/planner.h"
#include "plan/mission.h"

#define AISLE_REFUSAL_BYTES 1024U // of an encoded path_t with at most AISLE_ROUTE_TOLD_MAX waypoints
#define AISLE_MEMORY_ROWS 8U

typedef struct aisle_outgoing { // a path_t waiting to be pulled
    const uint8_t *bytes;
    size_t size;
    const aisle_stamp *stamp; // NULL: a refusal, nothing to drive
    bool waiting;
} aisle_outgoing;

struct aisle_planner {
    aisle_config config; // limits resolved
    int64_t now_us;
    aisle_layout *layout;
    bool building; // a committed layout is not in force yet
    aisle_vehicle vehicle;
    aisle_vehicle_msg *vehicle_msg; // as taken, to tell a duplicate from a conflict
    bool has_vehicle;
    bool vehicle_sent; // by a message; the settings' one gives way to any
    aisle_pose_msg pose;
    int64_t pose_at_us; // when it was submitted
    bool has_pose;
    bool held;
    int32_t obstacle_id[AISLE_OBSTACLES_MAX_SOURCES]; // a moving obstacle some source reports; 0 = none
    int32_t command_id;
    aisle_request *queue; // [limits.requests] ring
    uint32_t queue_head, queue_count;
    aisle_route *route;
    bool planning;
    aisle_mission mission;
    int32_t path_revision;
    aisle_path_msg *head;  // of answers; waypoints unused but those of a refusal
    uint8_t *refusal[2];   // [AISLE_REFUSAL_BYTES] for PATH and REPLY
    aisle_outgoing out[2]; // by aisle_event_kind
    int64_t lease_due_us;
    int16_t cause; // of the last refused input, until one of its kind is taken
    aisle_input_kind cause_kind;
    int32_t cause_id;
    int64_t counters[AISLE_COUNTER_COUNT];
    aisle_memory_row rows[AISLE_MEMORY_ROWS];
    uint32_t row_count;
};

// planner_hindrance.c

bool aisle_planner_is_busy(const aisle_planner *self); // a request is waiting or under way, or a layout is being built
// Why a request cannot even begin; cause 0: it can.
aisle_refusal aisle_planner_hindrance(const aisle_planner *self, const aisle_request *request);
// What keeps anyone from driving by the pose at hand, its age left out; cause 0: nothing.
aisle_refusal aisle_planner_pose_hindrance(const aisle_planner *self);
// Why the mission's path must not be driven at now_us; 0: it may. *id: what is meant.
int16_t aisle_planner_lease_hindrance(const aisle_planner *self, int64_t now_us, int32_t *id);

// planner_answer.c

// Queues a path_t of status NONE with the places told; told_count at most AISLE_ROUTE_TOLD_MAX.
void aisle_planner_refuse(aisle_planner *self, const aisle_request *request, const aisle_refusal *why,
                          const aisle_waypoint_msg *told, uint32_t told_count, uint32_t work_units);
// Queues a proved path: as REPLY from where it lies, as PATH after copying it to the mission, whose goals take its
// order; one that must not be
// driven now is kept back until its lease may begin.
void aisle_planner_publish(aisle_planner *self, const aisle_request *request, const aisle_proof *proof);
// Queues the mission's path once more with its lease renewed.
void aisle_planner_renew(aisle_planner *self);
// The vehicle's revision has changed and nothing else: the mission's path goes on under the new one, as the next path
// revision, on the strength of its proof. False: that does not stand, nothing may be sent.
bool aisle_planner_reprove(aisle_planner *self);
// Ends the mission's path, if it has one.
void aisle_planner_revoke(aisle_planner *self, int16_t cause, int32_t id);

// planner_inputs.c

// Has the mission planned again, if there is one.
void aisle_planner_replan(aisle_planner *self);
// The mission's request as it is now: the goals left, from the present pose.
const aisle_request *aisle_planner_renew_request(aisle_planner *self);
// AISLE_ERR_DATA, with the cause kept for status().
aisle_status aisle_planner_reject(aisle_planner *self, int16_t cause, int32_t id);
#endif
