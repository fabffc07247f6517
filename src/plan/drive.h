// drive.h - keeps the path that is out fit to be driven on: where the vehicle is on it, and what to send next. Level 4.
//
// Two paths. The plan: the whole way to the goals left, as fast as the ground allows. What is out: the bytes the vehicle
// follows, a part of the plan from where the vehicle was when they were sent, as fast as moving obstacles allow. Every
// change of what is out begins at the vehicle's place, follows the base of what was out (verify.h) and carries two
// proofs, of the bytes on the layout (verify.h) and of its lease among moving obstacles (verify_moving.h).
//
// A cycle, for each new pose or obstacle snapshot, asks in this order:
//     FRESH   a plan that begins where the vehicle stands, as it was proved: may it be leased? (Not if another revision was
//             sent since it was begun: then its bytes are made anew.)
//     CHECK   may what is out go on, for AISLE_LEASE_US, half of that and so on to the shortest lease? If it was slowed: would
//             a faster one do?
//     PACE    the plan from here on at the fastest level that is safe (pace.h), the last one a stop
//     MOVING, STATIC  its proofs. A level that fails gives way to the next slower one; braking needs the static one alone
// and ends with a verdict. Hysteresis: what may go on is not touched but for the better, and then at most every
// AISLE_DRIVE_SPEED_UP_US.
//
// Nothing is sent to a vehicle that has no path while it is faster than 0.05 m/s or rad/s: it brakes, where no proof sees it.
//
// Where the vehicle is: the pose, projected onto the path within a window about where it was, moved on by what the path
// does in the pose's age. It is off the path if the nearest place there is farther than the margin (at least
// AISLE_DRIVE_OFF) or its heading more than AISLE_DRIVE_OFF_HEADING away. It passes no goal that is not counted as
// reached (mission.h), so that a path under way names it still; one that has gone on over it all the same, farther than its
// tolerance and AISLE_DRIVE_OFF, is off the path, too, for no proof sees it where it is.
//
// Memory: carved, four decoded paths, two encoded ones, pace.h's and 16 KiB of pieces known (0.5 MiB). Time: sliced; a cycle
// is at most AISLE_PACE_LEVELS times pace and moving proof, and two static proofs.
#ifndef AISLE_PLAN_DRIVE_H
#define AISLE_PLAN_DRIVE_H

#include "base/arena.h"
#include "plan/pace.h"
#include "plan/route.h"
#include "plan/verify_moving.h"
#include "robot/motion.h"
#include "world/movers.h"

#define AISLE_DRIVE_SPEED_UP_US 150000
#define AISLE_DRIVE_PACE_LEASE 1.6  // shortest leases; new speeds are safe for so long, to stay so for a while
#define AISLE_DRIVE_START_LEASE 2.5 // the same of a vehicle at rest: no creeping up to what it waits for
#define AISLE_DRIVE_OFF 0.05        // m
#define AISLE_DRIVE_OFF_HEADING 0.2 // rad

typedef struct aisle_drive_world { // what a cycle goes by; stays put until it ends
    const aisle_layout *layout;
    const aisle_vehicle *vehicle;
    const aisle_movers *movers;
} aisle_drive_world;

typedef struct aisle_drive_path {
    aisle_path_msg *msg; // decoded
    float *dwell;        // [AISLE_PATH_MAX_WAYPOINTS]
    aisle_place at;      // where the vehicle is on it
    uint32_t passed;     // goals of the plan that were passed when it was made
    uint32_t level;      // of its speeds, pace.h; 0: as fast as the ground allows

    uint8_t *bytes; // [AISLE_ROUTE_BYTES]; of the plan none
    size_t size;
    aisle_stamp stamp;
    aisle_moving_stamp moving;
} aisle_drive_path;

typedef enum aisle_drive_stage {
    AISLE_DRIVE_IDLE,
    AISLE_DRIVE_CHECK,
    AISLE_DRIVE_FRESH,
    AISLE_DRIVE_CHECK_MOVING,
    AISLE_DRIVE_PACE,
    AISLE_DRIVE_MOVING,
    AISLE_DRIVE_STATIC
} aisle_drive_stage;

typedef enum aisle_drive_verdict {
    AISLE_DRIVE_KEEP,   // what is out may go on until its moving stamp ends
    AISLE_DRIVE_CHANGE, // what is out is new
    AISLE_DRIVE_LOST    // nothing can be proved: what was out must be revoked
} aisle_drive_verdict;

typedef struct aisle_drive {
    aisle_drive_path plan, out, next;
    aisle_goal_msg goals[AISLE_GOAL_LIST_MAX_GOALS]; // of the plan, in its order
    uint32_t num_goals, passed; // passed: counted as reached, the vehicle's place is not before them
    uint32_t plan_serial;       // rises when the plan becomes another one
    bool has_plan, has_out;     // has_out: `out` was sent and not revoked
    bool is_fresh;              // next holds the plan as it was proved, not sent yet
    bool must_change;           // the plan, or what it rests on, is new
    bool is_unfit;              // the plan does not prove any more on what it rests on
    double v, omega;            // m/s, the vehicle's along its path; rad/s
    double rest;                // s, left of the dwell where it stands
    int64_t at_us;              // when it was at `at`
    aisle_off off;              // from the path, by the last pose
    bool is_off, is_resting;    // by the last pose
    aisle_refusal why;          // what slows what is out or stops it; cause 0: nothing
    double shortest_lease;      // s, a path is sent for no less; AISLE_LEASE_SHORTEST after carve()

    // of the cycle
    aisle_drive_stage stage;
    aisle_drive_world world;
    aisle_path_msg *head; // of the next path
    bool stops;           // the vehicle is to be stopped
    bool brakes;          // what is tried is the last resort: braking, whatever moves
    int64_t cycle_us, changed_us;
    double lease;              // s, under proof
    aisle_path_msg *decoded;   // the static proof's,
    aisle_verify_known *known; // and the pieces it need not look at again
    aisle_verify verify;
    aisle_verify_moving moving;
    aisle_verify_base base;
    aisle_pace pace;
    uint32_t spent; // work units, since they were last taken
} aisle_drive;

// `self` may be NULL, to measure only, as in route.h.
void aisle_drive_carve(aisle_drive *self, aisle_arena *arena);

// The plan becomes a path proved from where the vehicle stands; nothing of it is out until a cycle says so. goals: of its
// request, copied. O(waypoints).
void aisle_drive_adopt(aisle_drive *self, const aisle_proof *proof, const aisle_goal_msg *goals, uint32_t num_goals);

// The plan goes on from `from` (a place on it ahead of the vehicle) by the tail, which begins there, for these goals. The
// present plan is kept up to there. False, the plan is unchanged: the vehicle can no longer stop before `from`, the tail does
// not begin there, or there are too many waypoints. O(waypoints).
bool aisle_drive_splice(aisle_drive *self, const aisle_drive_world *world, aisle_place from, const aisle_path_msg *tail,
                        const aisle_goal_msg *goals, uint32_t num_goals);

// Forgets the plan and what is out, and ends a cycle.
void aisle_drive_drop(aisle_drive *self);

// A new pose. Not during a cycle. O(waypoints of the window).
void aisle_drive_locate(aisle_drive *self, const aisle_vehicle *vehicle, const aisle_pose_msg *pose);

// The first goal not passed is counted as reached. Not during a cycle.
void aisle_drive_pass_goal(aisle_drive *self);

// Index of the first goal of w[n] after the first waypoint; the last one if there is none. O(n).
uint32_t aisle_drive_next_goal(const aisle_waypoint_msg *w, uint32_t n);

// Where it rests if it goes on for reaction time and `delay` s and then brakes, on the plan; in a turn its end.
aisle_place aisle_drive_rest(const aisle_drive *self, const aisle_vehicle *vehicle, double delay);

// Is the vehicle in motion, by the last pose, while something is out?
bool aisle_drive_moves(const aisle_drive *self);

// Is what is out a path that only brakes?
bool aisle_drive_is_stopping(const aisle_drive *self);

// Until when what is out may be driven, us.
int64_t aisle_drive_lease_until(const aisle_drive *self);

// Begins a cycle at now_us. head: all of the next path but its waypoints and figures. stop: why the vehicle must be
// stopped, its cause may be 0; NULL: it need not.
void aisle_drive_begin(aisle_drive *self, const aisle_drive_world *world, int64_t now_us, const aisle_path_msg *head,
                       const aisle_refusal *stop);

// Spends about `units`. AISLE_BUSY, then AISLE_OK: *verdict.
aisle_status aisle_drive_step(aisle_drive *self, uint32_t units, aisle_drive_verdict *verdict);
#endif
