// planner.h - the whole planner behind one door: messages in, proved paths and reasons out. Level: public.
//
// Use: size a block, init, submit messages as they arrive, step with a work budget, pull events.
//
//     size_t size = aisle_planner_memsize(&config.limits);
//     aisle_planner *planner;
//     aisle_planner_init(block, size, &config, &planner);
//     aisle_planner_submit(planner, now_us, &(aisle_input){.kind = AISLE_INPUT_QUERY, .as.query = &query});
//     while (aisle_planner_step(planner, now_us, 1000) == AISLE_BUSY) {
//         aisle_event event;
//         while (aisle_planner_next_event(planner, &event)) { send(event.channel, event.bytes, event.size); }
//     }
//
// Memory: the caller's one block, nothing else; no allocation, clock, file, socket, thread or recursion.
// Time: now_us is the caller's clock, microseconds since the epoch (the unit of every utime); a call
// with an earlier time than the last is read as the last. Nothing but lease and age depends on it: the
// paths depend on the inputs and their order alone, however the work is cut into steps.
// Order: inputs take effect in the order of submit(). A request (goal list, query) is planned on the
// layout and vehicle in force when its turn comes; while one waits or is planned, layouts and vehicles are
// not taken (AISLE_BUSY).
// Missions: the newest goal list is the mission. Its path is leased for as long as passive safety is proved among the moving
// obstacles, at most AISLE_LEASE_US, and sent again at half of that, while the pose is fresh, localized and on the layout's
// map, every source of obstacles that spoke keeps speaking and no HOLD is on. What follows the vehicle (plan/drive.h): each
// pose and snapshot of obstacles is a cycle that keeps, slows or brakes what is out; a changed path is the next revision,
// begins at the vehicle's place (v > 0 there) and keeps the base (num_base). Where the vehicle must be stopped while it moves
// the path says STOP and why; at rest NONE. A list refused for want of a pose is planned again when there is one, every list
// for another layout or vehicle: a vehicle at rest has its path withdrawn before (MAP_MISMATCH, CONFLICT with the vehicle's
// revision), one that moves drives on what is proved anew; a vehicle that is the same by all but its revision goes on. What
// names a list stays known when it is finished or cancelled: sent again it is a duplicate and moves nobody.
// Goals (plan/mission.h has all the rules): one counts as reached when the vehicle has rested within its tolerances for its
// dwell, by the poses' own time, as the goal being driven to (status_msg.goal_id). What is reached stays reached, through
// other layouts and vehicles, and in a higher revision of the same list for every goal that is in it unchanged: so a list
// may be extended or changed under way, and only what is new or changed is driven to. Another list id begins anew.
// A list in any order is ordered when it is planned; from then on its goals count as reached in that order, by their ids.
// What is left is ordered anew for another layout or vehicle (the path's GOAL waypoints and status_msg.goal_id tell the new
// order), and behind the goal being driven to when the list is changed or a goal skipped; else the order stays. A list
// whose goals share an id, or of an ordering there is not, is refused whole and the mission goes on.
// A goal that cannot be reached is named (path_msg, status NONE) and the list waits for another layout, vehicle or revision.
// It is skipped only when told to: by CANCEL with its id as arg, or, if it is proved to be out of reach, by
// aisle_config.skip_unreachable: after it was named the others are planned. If none can be reached none is skipped. A
// vehicle under way is stopped first: status NONE revokes what it drives by.
// Memory of answers: what a query was answered is remembered by what it asked (start, goals, options, vehicle, layout; no
// ids or times of messages), and a query or goal list that asks the same gets it, path_msg.cached set, after a proof on
// the layout in force. A changed layout keeps what it does not touch (plan/cache.h says by what rule, and what that
// promises of its length).
// Arms: an arm goal is planned in its turn like a query, from the pose that was in force when it was submitted, and answered by one
// arm_path_t: a proved motion or its cause. It moves while the vehicle rests: a pose that is missing, stale (the vehicle's pose_timeout)
// or not at rest then is the answer's cause. arm_goal_t.lcm and arm_path_t.lcm say what is proved. A library built without the arm
// (AISLE_ARM=OFF) answers NO_ARM.
// Threads: one planner, one thread at a time. Planners share nothing.
#ifndef AISLE_PLANNER_H
#define AISLE_PLANNER_H

#include "aisle/limits.h"
#include "aisle/messages.h"
#include "aisle/status.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define AISLE_PROTOCOL 1                           // status_msg.protocol
#define AISLE_LEASE_US 1000000                     // a path is valid so long after each sending at most
#define AISLE_LEASE_RESEND_US (AISLE_LEASE_US / 2) // and sent again so often; sooner where the lease is shorter
#define AISLE_LEASE_SHORTEST 0.0625F               // s, a path that is safe for less is not sent
#define AISLE_WORK_UNITS_DEFAULT 5000000
#define AISLE_PLANNER_ALIGN 64 // bytes, of the block

typedef struct aisle_planner aisle_planner; // lies inside the caller's block

// Zeroed = the documented defaults.
typedef struct aisle_config {
    aisle_limits limits;
    int64_t boot_id;           // told to receivers; anything that differs from boot to boot
    int32_t work_units;        // budget of a request that names none; 0 = AISLE_WORK_UNITS_DEFAULT
    aisle_vehicle_msg vehicle; // the vehicle until a message brings one; used if has_vehicle
    bool has_vehicle;
    bool skip_unreachable; // goals of a list that are proved to be out of reach (NO_PATH, TOO_NARROW, GOAL_OCCUPIED,
                           // GOAL_OUTSIDE), if others are not
    // s, [0.05, 1]; 0 = AISLE_LEASE_SHORTEST. A shorter one lets the vehicle drive nearer to what moves, but one that hears
    // of a renewal later than after half of it brakes in between.
    float shortest_lease;
    bool
        forgetful; // remember no answers: every request is planned anew (for benches; the memory is there all the same)
} aisle_config;

typedef enum aisle_input_kind {
    AISLE_INPUT_LAYOUT,
    AISLE_INPUT_LAYOUT_PATCH,
    AISLE_INPUT_GRID,
    AISLE_INPUT_VEHICLE,
    AISLE_INPUT_POSE,
    AISLE_INPUT_GOALS,
    AISLE_INPUT_QUERY,
    AISLE_INPUT_OBSTACLES,
    AISLE_INPUT_COMMAND,
    AISLE_INPUT_ARM_GOAL
} aisle_input_kind;

// One decoded message; only the pointer named by kind is read, and only during submit().
typedef struct aisle_input {
    aisle_input_kind kind;
    union {
        const aisle_layout_msg *layout;
        const aisle_layout_patch_msg *layout_patch;
        const aisle_grid_chunk_msg *grid;
        const aisle_vehicle_msg *vehicle;
        const aisle_pose_msg *pose;
        const aisle_goal_list_msg *goals;
        const aisle_query_msg *query;
        const aisle_obstacles_msg *obstacles;
        const aisle_command_msg *command;
        const aisle_arm_goal_msg *arm_goal;
    } as;
} aisle_input;

typedef enum aisle_event_kind {
    AISLE_EVENT_PATH,    // for _PATH: a new path, the same one with its lease renewed, or a revocation
    AISLE_EVENT_REPLY,   // for _REPLY: the answer to a query
    AISLE_EVENT_ARM_PATH // for _ARM_PATH: the answer to an arm's goal, an arm_path_t
} aisle_event_kind;

// An encoded path_t (arm_path_t with ARM_PATH), proved by the verifier or with status NONE. Bytes stay valid until the next
// call that takes a non-const planner.
typedef struct aisle_event {
    aisle_event_kind kind;
    const uint8_t *bytes;
    size_t size;
} aisle_event;

// Counters since init; but for the two figures of what was weighed they never decrease. Index into aisle_planner_counters().
typedef enum aisle_counter {
    AISLE_COUNTER_INPUTS,           // submit() calls that were taken
    AISLE_COUNTER_REJECTED,         // messages refused, whatever the cause
    AISLE_COUNTER_DUPLICATES,       // messages already held, ignored
    AISLE_COUNTER_LAYOUTS,          // layouts that took effect
    AISLE_COUNTER_QUERIES,          // queries answered
    AISLE_COUNTER_GOAL_LISTS,       // goal lists answered
    AISLE_COUNTER_PATHS,            // proved paths handed out, lease renewals not counted
    AISLE_COUNTER_NO_PATHS,         // answers without a path
    AISLE_COUNTER_VERIFY_FAILED,    // candidates the verifier turned down
    AISLE_COUNTER_NODES,            // nodes expanded, of the grid and of the tangent graph
    AISLE_COUNTER_SWARM_EVALS,      // candidate paths scored by the swarm
    AISLE_COUNTER_VERIFY_INTERVALS, // intervals of motion the verifier looked at
    AISLE_COUNTER_WORK_UNITS,       // work units spent by now, a layout's left out
    AISLE_COUNTER_OPEN_NODES_MAX,   // high-water mark of the grid search's open list
    AISLE_COUNTER_CCD_CALLS,        // narrow-phase tests that separating axes left to libccd
    AISLE_COUNTER_CCD_SUPPORT_MAX,  // most support calls of one of them
    AISLE_COUNTER_CACHE_HITS,       // answers that were remembered and proved again
    AISLE_COUNTER_CACHE_MISSES,     // requests planned since no answer was remembered, or a spoiled one
    AISLE_COUNTER_CACHE_KEPT,       // answers remembered that a changed layout does not touch
    AISLE_COUNTER_CACHE_DROPPED,    // and that it does, or may
    AISLE_COUNTER_CACHE_SPOILED,    // answers remembered whose bytes had changed or whose proof failed
    AISLE_COUNTER_LAYOUT_WORK,      // rows and polygons gone through when layouts and patches were built
    AISLE_COUNTER_ROUNDS,           // ways round moving obstacles taken
    AISLE_COUNTER_WAIT_MS,          // of the last one weighed: ms to the next goal by waiting or slowing down,
    AISLE_COUNTER_ROUND_MS,         // and by going round
    AISLE_COUNTER_CACHE_REPAIRED,   // among the misses: made of the free pieces of an answer that was remembered
    AISLE_COUNTER_ROADMAPS,         // roadmaps of PRM begun from nothing
    AISLE_COUNTER_ROADMAP_REPAIRS,  // and repaired where a layout had changed
    AISLE_COUNTER_ARM_GOALS,        // arm goals answered
    AISLE_COUNTER_ARM_PATHS,        // with a proved motion
    AISLE_COUNTER_CYCLE_INPUTS,     // poses and obstacles taken that a cycle of the mission is to answer
    AISLE_COUNTER_CYCLES, // cycles done, whatever asked for them; one answers every such input taken before it
    AISLE_COUNTER_COUNT
} aisle_counter;

typedef struct aisle_memory_row { // one line of aisled --memory
    const char *name;             // of the pool
    size_t bytes;
    size_t used_max; // high-water mark, bytes; 0 where the pool is used whole
} aisle_memory_row;

// Bytes of the block for these limits; 0 if a limit is out of its range. O(1).
size_t aisle_planner_memsize(const aisle_limits *limits);

// Carves `memory` (aligned to AISLE_PLANNER_ALIGN; size >= memsize) and zeroes it. *planner points into it.
// AISLE_ERR_ARG: NULL, misaligned, a limit or the vehicle is out of range. AISLE_ERR_CAPACITY: too small.
aisle_status aisle_planner_init(void *memory, size_t size, const aisle_config *config, aisle_planner **planner);

// Takes one message. AISLE_OK: taken, or a duplicate. AISLE_PARTIAL: taken, more parts are wanted.
// AISLE_BUSY: cannot be taken now, nothing changed: step() and submit it again. AISLE_ERR_DATA: refused
// whole, nothing changed but the counters and status().cause. A request that cannot be planned is
// taken and answered by an event with its cause. O(message).
aisle_status aisle_planner_submit(aisle_planner *self, int64_t now_us, const aisle_input *input);

// Spends about `work_units`: at most one indivisible piece above it, below 4096 units where straight stretches of a path
// stay below 100 m, in proportion to the longest one beyond.
// AISLE_BUSY: more to do, or events wait to be pulled. AISLE_OK: idle until the next submit() or deadline.
aisle_status aisle_planner_step(aisle_planner *self, int64_t now_us, uint32_t work_units);

// Pulls the next event. false: none.
bool aisle_planner_next_event(aisle_planner *self, aisle_event *event);

// When step() next has something to do by itself (lease, pose timeout); INT64_MAX: never.
int64_t aisle_planner_next_deadline(const aisle_planner *self);

// The heartbeat as it stands at now_us; seq is the caller's to set. cause: why the state is what it is (BLOCKED,
// WAITING),
// else that of the last refused input, until one of its kind is taken. goal_list_id and goal_list_revision: of the newest
// list, also when it is finished (goal_id 0, IDLE); 0 if it was cancelled. O(waypoints).
void aisle_planner_status(const aisle_planner *self, int64_t now_us, aisle_status_msg *status);

// [AISLE_COUNTER_COUNT]; valid as long as the planner.
const int64_t *aisle_planner_counters(const aisle_planner *self);

// Rows of the memory table, largest pools by name; their bytes sum up to memsize(). Returns the count.
size_t aisle_planner_memory(const aisle_planner *self, aisle_memory_row *rows, size_t capacity);

// Reads an event's bytes. AISLE_ERR_DATA: not a path_t (never for bytes of an event). O(waypoints).
aisle_status aisle_path_decode(const void *bytes, size_t size, aisle_path_msg *path);

// Goes on with the crc32 a layout_t carries, over the polygons of one part after those of the parts before (crc, at
// first 0).
uint32_t aisle_layout_crc32(uint32_t crc, const aisle_layout_msg *part);

// Text of a cause of status_msg/path_msg ("NO_PATH"); "?" for an unknown one. O(1).
const char *aisle_cause_name(int16_t cause);

#ifdef __cplusplus
}
#endif
#endif
