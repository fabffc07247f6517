// mission.h - the goal list in hand: which list it is, which goals are reached, which one is next. Level 4.
//
// It knows lists and poses, no layout, no vehicle and no path: the planner says when a plan for its goals stands.
// The newest list is the mission. A list is known by id and revision: the same one again is a duplicate (whatever its
// utime), with other content a conflict, an older revision outdated; another id or a higher revision takes over. What
// names a list stays known when it is reached or cancelled.
// A goal counts as reached when the vehicle rests within its tolerance while a path drives to it. A list in any order
// takes the order of its plan.
//
// Memory: the struct, no more. Time: O(goals) each.
#ifndef AISLE_PLAN_MISSION_H
#define AISLE_PLAN_MISSION_H

#include "plan/route.h"

typedef struct aisle_mission {
    aisle_request request;          // with the goals not yet reached when it was planned last
    bool known;                     // a list has come; what names it stays when it is reached or cancelled
    int32_t list_id, list_revision; // of the newest
    uint32_t digest;                // of all in it but its utime: a duplicate or a conflict?
    bool wanted;                    // neither reached nor cancelled yet
    bool replan;                    // to be planned again from the present pose, after what waits
    bool has_path;                  // current holds its proved path
    aisle_proof current;
    aisle_path_msg *path; // current, decoded
    uint32_t reached;     // goals
    int16_t cause;        // why the last plan gave no path, or the path was revoked; 0: being planned
    int32_t cause_id;
} aisle_mission;

// No such ordering, or goals in any order that share an id (*id; else 0): nobody could tell which one is reached.
bool aisle_mission_order_is_bad(int8_t ordering, const aisle_goal_msg *goals, int16_t count, int32_t *id);

// What a list means to the mission in hand; changes nothing. AISLE_OK: it takes over; AISLE_PARTIAL: a duplicate;
// AISLE_ERR_DATA: refused, *why.
aisle_status aisle_mission_judge(const aisle_mission *self, const aisle_goal_list_msg *list, aisle_refusal *why);

// Takes a list that was judged AISLE_OK. With 0 goals it cancels.
void aisle_mission_take(aisle_mission *self, const aisle_goal_list_msg *list);

// Ends it without reaching what is left.
void aisle_mission_cancel(aisle_mission *self);

// A pose; counts goals as reached, the mission ends with the last one.
void aisle_mission_note_pose(aisle_mission *self, const aisle_pose_msg *pose);

// The request as it is now: the goals left, from this pose (NULL: there is none). Valid until the mission changes.
const aisle_request *aisle_mission_ask(aisle_mission *self, const aisle_pose_msg *pose);

// A path for these goals, those of the request in the order planned, stands.
void aisle_mission_take_order(aisle_mission *self, const aisle_request *request);

// The goal being driven to; NULL: none.
const aisle_goal_msg *aisle_mission_goal(const aisle_mission *self);
#endif
