// planner_state.h - what lies behind planner.h; for planner*.c alone. Level 4.
//
// planner.c: memory, step, events. planner_inputs.c: what each message does. planner_hindrance.c: what keeps a request or
// a lease from going on. planner_drive.c: the cycle of a mission under way. planner_answer.c: paths and reasons out.
// planner_arm.c: goals of the arm. planner_status.c: the heartbeat, names of causes.
#ifndef AISLE_PLAN_PLANNER_STATE_H
#define AISLE_PLAN_PLANNER_STATE_H

#include "aisle/planner.h"
#include "plan/arm_route.h"
#include "plan/drive.h"
#include "plan/mission.h"
#include "plan/pace_predict.h"
#include "plan/route.h"
#include "world/movers.h"

#define AISLE_REFUSAL_BYTES 1024U // of an encoded path_t with at most AISLE_ROUTE_TOLD_MAX waypoints
#define AISLE_MEMORY_ROWS 10U
#define AISLE_ARM_REFUSAL_BYTES 256U // of an encoded arm_path_t without waypoints

typedef struct aisle_outgoing { // a path_t waiting to be pulled
    const uint8_t *bytes;
    size_t size;
    const aisle_stamp *stamp;         // NULL: a refusal, nothing to drive
    const aisle_moving_stamp *moving; // of a path to drive
    bool waiting;
} aisle_outgoing;

typedef struct aisle_planner_arm {
    aisle_arm_route route;
    bool planning;
    int32_t revision; // of the last arm_path_t
    uint8_t refusal[AISLE_ARM_REFUSAL_BYTES];
    const uint8_t *bytes; // waiting to be pulled
    size_t size;
    const aisle_stamp *stamp; // NULL: a refusal
    bool waiting;
} aisle_planner_arm;

typedef struct aisle_leaving { // where a plan made under way leaves the one before
    bool under_way;            // else it begins where the vehicle stands
    bool round;                // wanted: a way round moving obstacles. That there is none is no reason to stop
    bool goes_round;           // the request under way is for such
    aisle_place from;          // on the plan of this serial
    uint32_t serial;
    double delay;   // s, that planning may take; more after each time it took longer
    uint32_t tries; // that failed
} aisle_leaving;

typedef enum aisle_weighing { AISLE_WEIGHING_NOTHING, AISLE_WEIGHING_WAIT, AISLE_WEIGHING_ROUND } aisle_weighing;

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
    aisle_movers movers;
    aisle_drive drive;     // the mission's plan and what is out of it
    aisle_leaving leaving; // of the mission's request under way
    bool cycle_wanted;     // something that a cycle goes by is new
    aisle_refusal
        withdrawn;        // why the vehicle at rest was told to wait, until something is out again; cause 0: it was not
    aisle_refusal failed; // the mission cannot be planned, and the vehicle is still to be stopped; cause 0: it can
    aisle_weighing weighing;    // how long is what? Movers do not change meanwhile
    aisle_pace_predict predict; // it
    double wait_s;              // to the next goal by the plan, as weighed last
    int64_t looked_us;          // when that was begun
    int64_t look_us;            // how long until it may be again
    int64_t hindered_us;        // when it was last slow for what moves, or slowed for what stands
    int64_t swift_us;           // when it had last not been so for a while
    int32_t command_id;
    aisle_request *queue; // [limits.requests] ring
    uint32_t queue_head, queue_count;
    aisle_route *route;
    bool planning;
    aisle_planner_arm *arm;
    aisle_mission mission;
    int32_t path_revision;
    aisle_path_msg *head;  // of answers; waypoints unused but those of a refusal
    uint8_t *refusal[2];   // [AISLE_REFUSAL_BYTES] for PATH and REPLY
    aisle_outgoing out[2]; // by aisle_event_kind
    int64_t lease_due_us;  // when what is out is to be sent again
    int16_t cause;         // of the last refused input, until one of its kind is taken
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
// Why the vehicle must not drive on at now_us, whatever the path; 0: it may. *id: what is meant.
int16_t aisle_planner_lease_hindrance(const aisle_planner *self, int64_t now_us, int32_t *id);

// planner_answer.c

// Queues a path_t of status NONE with the places told; told_count at most AISLE_ROUTE_TOLD_MAX.
void aisle_planner_refuse(aisle_planner *self, const aisle_request *request, const aisle_refusal *why,
                          const aisle_waypoint_msg *told, uint32_t told_count, uint32_t work_units);
// Queues a proved path that answers a query, from where it lies.
void aisle_planner_reply(aisle_planner *self, const aisle_proof *proof);
// Queues what is out (drive.h), leased from now on.
void aisle_planner_send(aisle_planner *self);
// Tells that there is nothing to drive for now, unless that was told already; the plan stays.
void aisle_planner_withdraw(aisle_planner *self, const aisle_refusal *why);
// Tells that there is nothing to drive, if there is a plan, and forgets it.
void aisle_planner_revoke(aisle_planner *self, int16_t cause, int32_t id);
// ids and times of a path of this request as of now.
void aisle_planner_fill_head(aisle_planner *self, const aisle_request *request);

// planner_drive.c

// The mission's request just started is to go round the movers.
void aisle_planner_go_round(aisle_planner *self);
// Goes on weighing whether to wait or to go round.
void aisle_planner_step_weighing(aisle_planner *self, uint32_t units);
// Is a cycle under way or due?
bool aisle_planner_cycle_is_due(const aisle_planner *self);
// Spends about `units` on it.
void aisle_planner_step_cycle(aisle_planner *self, uint32_t units);
// When one is due by itself; INT64_MAX: never.
int64_t aisle_planner_cycle_deadline(const aisle_planner *self);
// Where the mission's next plan starts: the vehicle's place, or one ahead of it while it moves.
void aisle_planner_leave_from(aisle_planner *self, aisle_request *request);
// A path for the mission was found: it becomes the plan, or the end of it; or it is too late for that, and asked for anew.
void aisle_planner_take_plan(aisle_planner *self, const aisle_request *request, const aisle_proof *proof);
// None was found: said at once to a vehicle at rest, else when it has been stopped.
void aisle_planner_take_failure(aisle_planner *self, const aisle_request *request, const aisle_refusal *why,
                                const aisle_waypoint_msg *told, uint32_t told_count, uint32_t work_units);

// planner_arm.c

// Bytes that it needs of the searches' memory; its own memory and that. arm NULL: to measure only.
size_t aisle_planner_arm_lent(const aisle_limits *limits);
void aisle_planner_arm_carve(aisle_planner_arm *arm, aisle_arena *lent, const aisle_limits *limits);
// Notes where the vehicle is, or why the arm may not move from there.
void aisle_planner_arm_note_pose(const aisle_planner *self, aisle_request *request);
// Begins with a request that is_arm, or refuses it.
void aisle_planner_arm_begin(aisle_planner *self, const aisle_request *request);
// Goes on with it.
void aisle_planner_arm_step(aisle_planner *self, uint32_t units);
// Pulls the answer that waits; false: none.
bool aisle_planner_arm_event(aisle_planner *self, aisle_event *event);

// planner_inputs.c

// Has the mission planned again, if there is one.
void aisle_planner_replan(aisle_planner *self);
// The mission's request as it is now: the goals left, from the present pose.
aisle_request *aisle_planner_renew_request(aisle_planner *self);
// AISLE_ERR_DATA, with the cause kept for status().
aisle_status aisle_planner_reject(aisle_planner *self, int16_t cause, int32_t id);
#endif
