#include "plan/mission.h"

#include "base/check.h"
#include "base/crc32.h"
#include "wire/codec.h"

#include <math.h>
#include <string.h>

#define TOLERANCE_XY 0.05 // m, where a goal names none
#define RESTING 0.01      // m/s, rad/s: slower is at rest

// ---- lists

bool aisle_mission_order_is_bad(int8_t ordering, const aisle_goal_msg *goals, int16_t count, int32_t *id) {
    *id = 0;
    for (int16_t i = 0; i < count && ordering == AISLE_GOAL_LIST_ANY_ORDER; i++) {
        for (int16_t k = 0; k < i; k++) {
            if (goals[k].id == goals[i].id) {
                *id = goals[i].id;
                return true;
            }
        }
    }
    return ordering != AISLE_GOAL_LIST_ORDERED && ordering != AISLE_GOAL_LIST_ANY_ORDER;
}

static uint32_t digest_part(uint32_t crc, aisle_msg_type type, const void *part) {
    uint8_t bytes[128];
    size_t size = 0;
    aisle_status st = aisle_msg_encode_body(type, part, bytes, sizeof bytes, &size);
    return st == AISLE_OK ? aisle_crc32(crc, bytes, size) : ~crc; // not finite: refused when its turn comes
}

static uint32_t digest_of(const aisle_goal_list_msg *list) {
    uint32_t crc = digest_part(0, AISLE_MSG_OPTIONS, &list->options);
    for (int16_t i = 0; i < list->num_goals; i++) {
        crc = digest_part(crc, AISLE_MSG_GOAL, &list->goals[i]);
    }
    const uint8_t rest[] = {(uint8_t)list->num_goals, (uint8_t)list->ordering};
    crc = aisle_crc32(crc, rest, sizeof rest);
    return crc ^ (uint32_t)list->map_id;
}

static aisle_status refuse(aisle_refusal *why, int16_t cause, int32_t id) {
    *why = (aisle_refusal){cause, id, 0.0F};
    return AISLE_ERR_DATA;
}

aisle_status aisle_mission_judge(const aisle_mission *self, const aisle_goal_list_msg *list, aisle_refusal *why) {
    int32_t id;
    if (list->num_goals < 0 || list->num_goals > AISLE_GOAL_LIST_MAX_GOALS) {
        return refuse(why, AISLE_STATUS_LIMIT, list->num_goals);
    }
    if (list->num_goals > 0 && aisle_mission_order_is_bad(list->ordering, list->goals, list->num_goals, &id)) {
        return refuse(why, AISLE_STATUS_MALFORMED, id);
    }
    if (!self->known || self->list_id != list->goal_list_id || list->goal_list_revision > self->list_revision) {
        return AISLE_OK;
    }
    if (list->goal_list_revision < self->list_revision) {
        return refuse(why, AISLE_STATUS_OUTDATED, list->goal_list_revision);
    }
    return digest_of(list) == self->digest ? AISLE_PARTIAL
                                           : refuse(why, AISLE_STATUS_CONFLICT, list->goal_list_revision);
}

void aisle_mission_cancel(aisle_mission *self) {
    self->wanted = false;
    self->has_path = false;
    self->replan = false;
}

static void begin(aisle_mission *self, const aisle_goal_list_msg *list) {
    self->request = (aisle_request){.goal_list_id = list->goal_list_id,
                                    .goal_list_revision = list->goal_list_revision,
                                    .map_id = list->map_id,
                                    .options = list->options,
                                    .ordering = list->ordering,
                                    .num_goals = list->num_goals};
    memcpy(self->request.goals, list->goals, (size_t)list->num_goals * sizeof list->goals[0]);
    self->wanted = true;
    self->replan = false;
    self->reached = 0;
    self->cause = 0;
}

void aisle_mission_take(aisle_mission *self, const aisle_goal_list_msg *list) {
    if (list->num_goals == 0) {
        aisle_mission_cancel(self);
    } else {
        begin(self, list);
    }
    self->known = true;
    self->list_id = list->goal_list_id;
    self->list_revision = list->goal_list_revision;
    self->digest = digest_of(list);
}

// ---- progress

// Is the path in hand the one for the goals in hand?
static bool drives_to_its_goals(const aisle_mission *self) {
    return self->wanted && self->has_path && self->path->goal_list_id == self->list_id &&
           self->path->goal_list_revision == self->list_revision;
}

static bool rests_at(const aisle_pose_msg *pose, const aisle_goal_msg *goal) {
    double away = aisle_vec2_distance(aisle_vec2_of(pose->x, pose->y), aisle_vec2_of(goal->x, goal->y));
    double tolerance = goal->tolerance_xy > 0.0F ? (double)goal->tolerance_xy : TOLERANCE_XY;
    bool rests = fabs((double)pose->vx) < RESTING && fabs((double)pose->omega) < RESTING;
    return rests && away <= tolerance;
}

void aisle_mission_note_pose(aisle_mission *self, const aisle_pose_msg *pose) {
    const uint32_t count = (uint32_t)(uint16_t)self->request.num_goals;
    while (drives_to_its_goals(self) && rests_at(pose, &self->request.goals[self->reached])) {
        self->reached++;
        if (self->reached == count) {
            self->wanted = false;
            self->has_path = false;
        }
    }
}

const aisle_request *aisle_mission_ask(aisle_mission *self, const aisle_pose_msg *pose) {
    aisle_request *request = &self->request;
    uint32_t left = (uint32_t)(uint16_t)request->num_goals - self->reached;
    memmove(request->goals, request->goals + self->reached, left * sizeof request->goals[0]);
    request->num_goals = (int16_t)left;
    request->start =
        pose != NULL ? (aisle_goal_msg){.x = pose->x, .y = pose->y, .theta = pose->theta} : (aisle_goal_msg){.x = 0.0};
    request->pose_utime = pose != NULL ? pose->utime : 0;
    self->reached = 0;
    return request;
}

void aisle_mission_take_order(aisle_mission *self, const aisle_request *request) {
    AISLE_ASSERT(self->request.num_goals == request->num_goals);
    memcpy(self->request.goals, request->goals, sizeof request->goals);
}

const aisle_goal_msg *aisle_mission_goal(const aisle_mission *self) {
    return self->wanted ? &self->request.goals[self->reached] : NULL;
}
