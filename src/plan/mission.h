// mission.h - the goal list in hand: which list it is, what is reached, which goal is next. Level 4.
//
// It knows lists and poses, but no layout, vehicle or path: the planner asks it for a request, tells it what became of
// that, and hands it every pose.
//
// LISTS. The newest list is the mission. It is known by id and revision: the same one again is a duplicate (whatever its
// utime), the same with other content a conflict, a lower revision of the same id outdated; another id or a higher
// revision takes over. What names a list stays known when it is finished or cancelled, so that sent again it moves nobody.
//     Another id begins anew. A higher revision of the same id keeps what was reached: each goal reached (or skipped on
// command) in the older revision stays so if the newer one has a goal equal to it in id and everything else; of several
// equal ones as many as were reached. So a list may be extended, shortened or changed under way, even after its last goal
// was reached. If nothing is left it is finished at once. A cancelled list is forgotten: its next revision begins anew.
//
// GOALS. A goal counts as reached when the vehicle has rested on it for its dwell. It rests on it by a pose that is within
// tolerance_xy (0: 0.05 m) and tolerance_theta (0: 0.05 rad; pi or more: any heading) and slower than 0.01 m/s and
// 0.01 rad/s. Time is the poses' own: dwell is over at the first pose at least `dwell` after the first one of an unbroken
// row of resting poses; two poses more than AISLE_MISSION_APART (or pose_timeout, if that is more) apart, or one that cannot
// be trusted, break the row. Only the goal being driven to counts, and only once a plan has stood that drives there next.
//     A goal that others follow is left when its dwell is over, to the millisecond; poses are further apart than that, and
// whoever lags behind its path comes to rest late, but leaves in time, or never rests quite where there is no dwell. So
// when a pose shows that it has left, the benefit of the doubt is the vehicle's. It stops over the goal while it is within
// the tolerances and no faster than one may be there that brakes to rest on it: sqrt(2 d_max tolerance_xy), and
// sqrt(2 alpha_max tolerance_theta) if a heading is given. The goal counts, too, when the vehicle has rested on it by one
// pose and moves again by another, if from the pose before the first one that stops over it until now its dwell went by;
// and one without dwell when poses show it stopping over the goal, then at least 8 mm farther off and no slower than it was:
// one that still brakes has not left.
//     Of several goals within reach of one place each has its dwell in turn. A goal that is reached stays reached, whatever
// becomes of path, layout or vehicle.
//     The goal being driven to (status_t.goal_id) is the first one left. An ordered list is driven as it came. One in any
// order takes the order of its plan and keeps it when it is planned again, unless there is a reason to think again
// (aisle_mission_reconsider(): the layout or the vehicle is another one): then all that is left is ordered anew. A newer
// revision, or a goal skipped, orders anew all but the goal being driven to, if that is still in it unchanged.
//
// SKIPPING. On command a goal that is left is given up; the last one given up ends the mission. By itself
// (aisle_mission_set_aside()) a goal proved to be out of reach is set aside; when a plan for what remains stands it is
// given up until a newer revision of the list comes. If no goal left can be reached none is given up, for then it may well
// be the vehicle that is shut in: all are back, and the list waits for another layout or vehicle.
//
// Memory: the struct, 12 KiB. Time: O(goals) each, aisle_mission_take() and aisle_mission_order_is_bad() O(goals^2).
#ifndef AISLE_PLAN_MISSION_H
#define AISLE_PLAN_MISSION_H

#include "plan/route.h"

typedef enum aisle_goal_fate {
    AISLE_GOAL_LEFT,
    AISLE_GOAL_REACHED,
    AISLE_GOAL_SKIPPED,    // on command
    AISLE_GOAL_ASIDE,      // proved to be out of reach; given up if others can be reached
    AISLE_GOAL_UNREACHABLE // given up by itself
} aisle_goal_fate;

#define AISLE_MISSION_APART 1.0 // s, see above

typedef struct aisle_goal_rest { // on the goal being driven to, by an unbroken row of poses
    bool is_on;                  // the vehicle rests on it, and has
    int64_t since_us;            // since then
    bool stops;                  // it stops over it, and may have rested on it
    int64_t from_us;             // since then
    bool is_sure;                // it did rest on it meanwhile
    double nearest, slowest;     // m, m/s, least of the row
} aisle_goal_rest;

typedef struct aisle_mission {
    bool known;                     // a list has come
    int32_t list_id, list_revision; // of the newest
    uint32_t digest;                // of all in it but its utime: a duplicate or a conflict?
    bool wanted;                    // goals are left
    bool cancelled;                 // the newest list was
    bool replan;                    // to be planned again, after what waits; the planner clears it
    int16_t cause;                  // the planner's: why there is no path; 0: being planned
    int32_t cause_id;

    aisle_goal_msg list[AISLE_GOAL_LIST_MAX_GOALS]; // the newest list's goals as sent
    uint8_t fate[AISLE_GOAL_LIST_MAX_GOALS];        // aisle_goal_fate of each
    uint32_t count;
    uint8_t order[AISLE_GOAL_LIST_MAX_GOALS]; // those left, by index in list, as driven to
    uint32_t left;
    uint8_t done[AISLE_GOAL_LIST_MAX_GOALS]; // those reached, in the order they were
    uint32_t done_count;
    uint32_t kept;         // of those left: so many keep their place when planned next
    uint32_t sent;         // of those left: a plan has stood that drives to the first so many, in this order
    aisle_goal_rest rest;  // on the first one
    bool has_pose;         // the newest pose can be trusted; it is of
    int64_t pose_us;       // then
    uint32_t serial;       // changes when what is asked does, other than by reaching goals in turn
    aisle_request request; // as asked last, its goals as planned last
} aisle_mission;

// No such ordering, or goals in any order that share an id (*id; else 0): nobody could tell which one is reached.
bool aisle_mission_order_is_bad(int8_t ordering, const aisle_goal_msg *goals, int16_t count, int32_t *id);

// What a list means to the mission in hand; changes nothing. AISLE_OK: it takes over; AISLE_PARTIAL: a duplicate;
// AISLE_ERR_DATA: refused, *why: LIMIT, MALFORMED, OUTDATED, CONFLICT.
aisle_status aisle_mission_judge(const aisle_mission *self, const aisle_goal_list_msg *list, aisle_refusal *why);

// Takes a list that was judged AISLE_OK; with 0 goals it cancels. `wanted` says whether anything is left to do.
void aisle_mission_take(aisle_mission *self, const aisle_goal_list_msg *list);

// Ends the mission without reaching what is left.
void aisle_mission_cancel(aisle_mission *self);

// Gives up the first goal left with this id; `replan` is set if others are left. False, nothing changed: there is none.
bool aisle_mission_skip(aisle_mission *self, int32_t id);

// Is this cause of a refusal a proof that a goal cannot be reached, whatever the budget?
bool aisle_mission_is_out_of_reach(int16_t cause);

// Goal `goal` of this request, not stale, is proved to be out of reach. True: it is set aside, `replan` is set to ask for
// the others. False: no other remains, all that were set aside are back.
bool aisle_mission_set_aside(aisle_mission *self, const aisle_request *request, uint32_t goal);

// Layout or vehicle are other ones: what is left is to be ordered anew, what was set aside may be in reach.
void aisle_mission_reconsider(aisle_mission *self);

// The newest pose, not older than those before (NULL: where the vehicle is cannot be trusted). Of the vehicle pose_timeout,
// d_max and alpha_max are read. Returns how many goals it counts as reached; the mission ends with the last one.
uint32_t aisle_mission_note_pose(aisle_mission *self, const aisle_vehicle *vehicle, const aisle_pose_msg *pose);

// The request as it is now: the goals left, what is left of the first one's dwell, from this pose (NULL: there is none).
// Wants goals left. Valid until asked again.
aisle_request *aisle_mission_ask(aisle_mission *self, const aisle_pose_msg *pose);

// Is this request of the mission (maybe a copy) out of date, so that its plan would be for nothing?
bool aisle_mission_is_stale(const aisle_mission *self, const aisle_request *request);

// May a plan for this request, not stale, stand, its goals in the order planned? Not if one was reached meanwhile that is
// not among its first ones: ask again.
bool aisle_mission_fits(const aisle_mission *self, const aisle_request *request);

// Such a plan, which fits, stands. Returns how many of its goals, its first ones, were reached meanwhile.
uint32_t aisle_mission_take_order(aisle_mission *self, const aisle_request *request);

// What is left (s) of the dwell on the goal it rests on by the newest pose; 0 if it rests on none.
double aisle_mission_rest(const aisle_mission *self);

// The goal being driven to; NULL: none.
const aisle_goal_msg *aisle_mission_goal(const aisle_mission *self);
#endif
