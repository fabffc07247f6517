#include "plan/mission.h"

#include "base/angle.h"
#include "base/check.h"
#include "base/crc32.h"
#include "wire/codec.h"

#include <math.h>
#include <string.h>

#define TOLERANCE 0.05 // m and rad, where a goal names none
#define RESTING 0.01   // m/s and rad/s: slower is at rest
#define LEVER 0.5      // m, that a radian of heading counts
#define GONE 0.008     // m farther off than it was, more than a pose's noise

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

// ---- what is left

static void break_rest(aisle_mission *self) {
    self->rest = (aisle_goal_rest){.is_on = false};
}

// The goals left in the order they came, and none of them is sent for.
static void line_up(aisle_mission *self) {
    self->left = 0;
    for (uint32_t i = 0; i < self->count; i++) {
        if (self->fate[i] == AISLE_GOAL_LEFT) {
            self->order[self->left++] = (uint8_t)i;
        }
    }
    self->kept = self->sent = 0;
    break_rest(self);
}

static uint32_t least(uint32_t a, uint32_t b) {
    return a < b ? a : b;
}

// Takes the goal at this place of `order` out of it.
static void take_out(aisle_mission *self, uint32_t at, aisle_goal_fate fate) {
    AISLE_ASSERT(at < self->left);
    self->fate[self->order[at]] = (uint8_t)fate;
    memmove(self->order + at, self->order + at + 1U, self->left - at - 1U);
    self->left--;
    self->kept -= at < self->kept ? 1U : 0U;
    if (fate == AISLE_GOAL_REACHED) {
        self->sent--;
    } else {
        self->sent = least(self->sent, at);
    }
    if (at == 0U) { // another one is driven to
        break_rest(self);
    }
}

// Position in `order` of the first goal with this id; `left` if there is none.
static uint32_t find_left(const aisle_mission *self, int32_t id) {
    uint32_t at = 0;
    while (at < self->left && self->list[self->order[at]].id != id) {
        at++;
    }
    return at;
}

static void end(aisle_mission *self) {
    self->wanted = false;
    self->replan = false;
}

void aisle_mission_cancel(aisle_mission *self) {
    end(self);
    self->cancelled = true;
    self->count = self->left = self->done_count = self->kept = self->sent = 0;
    break_rest(self);
    self->serial++;
}

// ---- a list

static bool same_real(double a, double b) {
    return a <= b && a >= b;
}

static bool same_goal(const aisle_goal_msg *a, const aisle_goal_msg *b) {
    return a->id == b->id && same_real(a->x, b->x) && same_real(a->y, b->y) && same_real(a->theta, b->theta) &&
           same_real((double)a->tolerance_xy, (double)b->tolerance_xy) &&
           same_real((double)a->tolerance_theta, (double)b->tolerance_theta) &&
           same_real((double)a->dwell, (double)b->dwell);
}

// The first goal of the list that is left and equal to this one; its count if there is none.
static uint32_t find_equal(const aisle_goal_list_msg *list, const uint8_t *fate, const aisle_goal_msg *goal) {
    const uint32_t count = (uint32_t)(uint16_t)list->num_goals;
    uint32_t i = 0;
    while (i < count && (fate[i] != AISLE_GOAL_LEFT || !same_goal(&list->goals[i], goal))) {
        i++;
    }
    return i;
}

// What was reached of the list before, or skipped on command, is so in this one.
static void keep_progress(aisle_mission *self, const aisle_goal_list_msg *list) {
    uint8_t fate[AISLE_GOAL_LIST_MAX_GOALS] = {AISLE_GOAL_LEFT};
    uint32_t done_count = 0;
    for (uint32_t k = 0; k < self->done_count; k++) {
        const uint32_t i = find_equal(list, fate, &self->list[self->done[k]]);
        if (i < (uint32_t)(uint16_t)list->num_goals) {
            fate[i] = AISLE_GOAL_REACHED;
            self->done[done_count++] = (uint8_t)i; // those read yet lie behind
        }
    }
    for (uint32_t k = 0; k < self->count; k++) {
        const uint32_t i =
            self->fate[k] == AISLE_GOAL_SKIPPED ? find_equal(list, fate, &self->list[k]) : AISLE_GOAL_LIST_MAX_GOALS;
        if (i < (uint32_t)(uint16_t)list->num_goals) {
            fate[i] = AISLE_GOAL_SKIPPED;
        }
    }
    memcpy(self->fate, fate, sizeof fate);
    self->done_count = done_count;
}

static void forget_progress(aisle_mission *self) {
    memset(self->fate, AISLE_GOAL_LEFT, sizeof self->fate);
    self->done_count = 0;
}

// The goal driven to before stays the first, if it is left and unchanged: at once in an ordered list, if it is its turn.
static void keep_first(aisle_mission *self, const aisle_goal_msg *before, const aisle_goal_rest *rest) {
    uint32_t at = 0;
    while (at < self->left && !same_goal(&self->list[self->order[at]], before)) {
        at++;
    }
    if (at == self->left || (at > 0U && self->request.ordering == AISLE_GOAL_LIST_ORDERED)) {
        return;
    }
    const uint8_t first = self->order[at];
    memmove(self->order + 1, self->order, at);
    self->order[0] = first;
    self->kept = self->sent = 1;
    self->rest = *rest;
}

static void take_goals(aisle_mission *self, const aisle_goal_list_msg *list) {
    const bool goes_on = self->list_id == list->goal_list_id; // nothing does of none, or of one that was cancelled
    const bool is_sent = goes_on && self->wanted && self->sent > 0U;
    const aisle_goal_rest rest = self->rest;
    const aisle_goal_msg before = is_sent ? self->list[self->order[0]] : (aisle_goal_msg){.id = 0};
    if (goes_on) {
        keep_progress(self, list);
    } else {
        forget_progress(self);
    }
    memcpy(self->list, list->goals, sizeof self->list);
    self->count = (uint32_t)(uint16_t)list->num_goals;
    line_up(self);
    if (is_sent) {
        keep_first(self, &before, &rest);
    }
}

void aisle_mission_take(aisle_mission *self, const aisle_goal_list_msg *list) {
    self->request = (aisle_request){.goal_list_id = list->goal_list_id,
                                    .goal_list_revision = list->goal_list_revision,
                                    .map_id = list->map_id,
                                    .options = list->options,
                                    .ordering = list->ordering};
    if (list->num_goals == 0) {
        aisle_mission_cancel(self);
    } else {
        take_goals(self, list);
        self->cancelled = false;
        self->wanted = self->left > 0U;
        self->replan = false;
        self->cause = 0;
        self->serial++;
    }
    self->known = true;
    self->list_id = list->goal_list_id;
    self->list_revision = list->goal_list_revision;
    self->digest = digest_of(list);
}

// ---- skipping

// Those set aside are left again, behind the others or, in an ordered list, in their places.
static bool bring_back(aisle_mission *self) {
    const uint32_t before = self->left;
    const bool is_sent = self->sent > 0U;
    const aisle_goal_rest rest = self->rest;
    const aisle_goal_msg first = is_sent ? self->list[self->order[0]] : (aisle_goal_msg){.id = 0};
    for (uint32_t i = 0; i < self->count; i++) {
        if (self->fate[i] == AISLE_GOAL_ASIDE) {
            self->fate[i] = AISLE_GOAL_LEFT;
            self->order[self->left++] = (uint8_t)i;
        }
    }
    if (self->left == before) {
        return false;
    }
    self->serial++;
    if (self->request.ordering == AISLE_GOAL_LIST_ORDERED || before == 0U) {
        line_up(self);
        if (is_sent) {
            keep_first(self, &first, &rest);
        }
    }
    return true;
}

// Goals were given up, or all are reached: by another plan, if anything is left.
static void go_on(aisle_mission *self) {
    if (self->left > 0U || bring_back(self)) {
        self->replan = true;
    } else {
        end(self);
    }
}

bool aisle_mission_skip(aisle_mission *self, int32_t id) {
    const uint32_t at = find_left(self, id);
    if (!self->wanted || at == self->left) {
        return false;
    }
    take_out(self, at, AISLE_GOAL_SKIPPED);
    self->kept = least(self->kept, at > 0U ? 1U : 0U);
    self->serial++;
    go_on(self);
    return true;
}

bool aisle_mission_is_out_of_reach(int16_t cause) {
    return cause == AISLE_STATUS_NO_PATH || cause == AISLE_STATUS_TOO_NARROW || cause == AISLE_STATUS_GOAL_OCCUPIED ||
           cause == AISLE_STATUS_GOAL_OUTSIDE;
}

// Of the goals of a request those reached meanwhile are the first ones of an ordered list; in any order ids are unique.
bool aisle_mission_set_aside(aisle_mission *self, const aisle_request *request, uint32_t goal) {
    const uint32_t count = (uint32_t)(uint16_t)request->num_goals, first = count - self->left;
    AISLE_ASSERT(!aisle_mission_is_stale(self, request) && goal < count && count >= self->left);
    const bool is_ordered = request->ordering == AISLE_GOAL_LIST_ORDERED;
    const uint32_t at = is_ordered && goal >= first ? goal - first
                        : is_ordered                ? self->left
                                                    : find_left(self, request->goals[goal].id);
    if (at == self->left) { // it was reached after all
        self->replan = true;
        return true;
    }
    take_out(self, at, AISLE_GOAL_ASIDE);
    self->serial++;
    self->replan = self->left > 0U;
    if (!self->replan) {
        (void)bring_back(self);
    }
    return self->replan;
}

void aisle_mission_reconsider(aisle_mission *self) {
    (void)bring_back(self);
    self->kept = 0;
}

// ---- progress

static double tolerance_of(float told) {
    return told > 0.0F ? (double)told : TOLERANCE;
}

typedef struct arrival { // a pose by a goal
    double off;          // m from it, heading included where that matters
    double speed;        // m/s, turning included
    bool is_within;      // its tolerances
    bool rests;          // on it
    bool stops;          // over it: no faster than who brakes to rest on it may be so near
} arrival;

// Up to this speed who comes to rest within `room` by braking at `rate` may still be in motion there.
static double braking(double rate, double room) {
    return sqrt(2.0 * rate * room);
}

static arrival look(const aisle_vehicle *vehicle, const aisle_pose_msg *pose, const aisle_goal_msg *goal) {
    const double away = aisle_vec2_distance(aisle_vec2_of(pose->x, pose->y), aisle_vec2_of(goal->x, goal->y));
    const double speed = aisle_vec2_length(aisle_vec2_of((double)pose->vx, (double)pose->vy));
    const double rate = fabs((double)pose->omega);
    const double xy = tolerance_of(goal->tolerance_xy), theta = tolerance_of(goal->tolerance_theta);
    const bool is_free = aisle_goal_heading_is_free(goal);
    const double turned = is_free ? 0.0 : fabs(aisle_angle_difference(pose->theta, goal->theta));
    const bool is_within = away <= xy && turned <= theta;
    return (arrival){.off = away + LEVER * turned,
                     .speed = speed + LEVER * rate,
                     .is_within = is_within,
                     .rests = is_within && speed < RESTING && rate < RESTING,
                     .stops = is_within && speed <= aisle_max(braking(vehicle->d_max, xy), RESTING) &&
                              (is_free || rate <= aisle_max(braking(vehicle->alpha_max, theta), RESTING))};
}

// s from one time to a later one, any two of them.
static double seconds(int64_t from_us, int64_t to_us) {
    return (double)((uint64_t)to_us - (uint64_t)from_us) * 1e-6;
}

static void reach(aisle_mission *self) {
    self->done[self->done_count++] = self->order[0];
    take_out(self, 0, AISLE_GOAL_REACHED);
    if (self->left == 0U) {
        go_on(self);
    }
}

// Does it leave a goal on which it may have stayed for its dwell, if poses and brakes are given the benefit of the doubt?
static bool leaves(const aisle_goal_rest *rest, const arrival *it, const aisle_goal_msg *goal, int64_t now_us) {
    const bool has_stayed = rest->is_sure && (float)seconds(rest->from_us, now_us) >= goal->dwell;
    const bool goes_off = goal->dwell <= 0.0F && it->off > rest->nearest + GONE && it->speed >= rest->slowest;
    return rest->stops && !it->rests && (has_stayed || goes_off);
}

// The row of poses goes on with this one; before_us: of the pose before.
static void go_on_resting(aisle_goal_rest *rest, const arrival *it, int64_t before_us, int64_t now_us) {
    if (!it->stops) {
        *rest = (aisle_goal_rest){.is_on = false};
        return;
    }
    rest->nearest = rest->stops ? aisle_min(rest->nearest, it->off) : it->off;
    rest->slowest = rest->stops ? aisle_min(rest->slowest, it->speed) : it->speed;
    rest->from_us = rest->stops ? rest->from_us : before_us;
    rest->since_us = rest->is_on ? rest->since_us : now_us;
    rest->stops = true;
    rest->is_on = it->rests;
    rest->is_sure = rest->is_sure || it->rests;
}

// Is the goal being driven to reached by this pose?
static bool is_reached(aisle_mission *self, const aisle_vehicle *vehicle, const aisle_pose_msg *pose,
                       int64_t before_us) {
    const aisle_goal_msg *goal = &self->list[self->order[0]];
    const arrival it = look(vehicle, pose, goal);
    aisle_goal_rest *rest = &self->rest;
    const bool has_left = self->left > 1U && leaves(rest, &it, goal, pose->utime);
    go_on_resting(rest, &it, before_us, pose->utime);
    return has_left || (rest->is_on && (float)seconds(rest->since_us, pose->utime) >= goal->dwell);
}

uint32_t aisle_mission_note_pose(aisle_mission *self, const aisle_vehicle *vehicle, const aisle_pose_msg *pose) {
    uint32_t reached = 0;
    const double apart = aisle_max(vehicle->pose_timeout, AISLE_MISSION_APART);
    const bool is_row = pose != NULL && self->has_pose && seconds(self->pose_us, pose->utime) <= apart;
    int64_t before_us = is_row ? self->pose_us : 0;
    if (!is_row) {
        break_rest(self);
    }
    self->has_pose = pose != NULL;
    if (pose == NULL) {
        return 0;
    }
    before_us = is_row ? before_us : pose->utime;
    self->pose_us = pose->utime;
    while (self->wanted && self->sent > 0U && is_reached(self, vehicle, pose, before_us)) {
        reach(self);
        reached++;
        before_us = pose->utime; // the next one's row begins now
    }
    return reached;
}

double aisle_mission_rest(const aisle_mission *self) {
    if (!self->wanted || !self->rest.is_on) {
        return 0.0;
    }
    const double dwell = (double)self->list[self->order[0]].dwell;
    return aisle_max(dwell - seconds(self->rest.since_us, self->pose_us), 0.0);
}

const aisle_goal_msg *aisle_mission_goal(const aisle_mission *self) {
    return self->wanted ? &self->list[self->order[0]] : NULL;
}

// ---- requests

aisle_request *aisle_mission_ask(aisle_mission *self, const aisle_pose_msg *pose) {
    aisle_request *request = &self->request;
    AISLE_ASSERT(self->wanted && self->left > 0U);
    for (uint32_t i = 0; i < self->left; i++) {
        request->goals[i] = self->list[self->order[i]];
    }
    if (self->rest.is_on) {
        const double dwell = (double)request->goals[0].dwell - seconds(self->rest.since_us, self->pose_us);
        request->goals[0].dwell = dwell > 0.0 ? (float)dwell : 0.0F;
    }
    request->num_goals = (int16_t)self->left;
    request->kept = (int16_t)self->kept;
    request->serial = self->serial;
    request->start = (aisle_goal_msg){.id = 0};
    request->pose_utime = 0;
    if (pose != NULL) {
        request->start = (aisle_goal_msg){.x = pose->x, .y = pose->y, .theta = pose->theta};
        request->pose_utime = pose->utime;
    }
    return request;
}

bool aisle_mission_is_stale(const aisle_mission *self, const aisle_request *request) {
    return !self->wanted || request->serial != self->serial;
}

// Those behind the first ones, which were reached, are what is left: by index in `list`, in the order they are in. False:
// they are not.
static bool order_of(const aisle_mission *self, const aisle_request *request, uint8_t *order) {
    const uint32_t count = (uint32_t)(uint16_t)request->num_goals, first = count - self->left;
    AISLE_ASSERT(!aisle_mission_is_stale(self, request) && count >= self->left);
    for (uint32_t i = 0; i < self->left; i++) {
        const int32_t id = request->goals[first + i].id;
        const bool is_ordered = request->ordering == AISLE_GOAL_LIST_ORDERED;
        const uint32_t at = is_ordered ? i : find_left(self, id); // ids may be shared in an ordered list
        if (at == self->left) {
            return false;
        }
        AISLE_ASSERT(self->list[self->order[at]].id == id);
        order[i] = self->order[at];
    }
    return true;
}

bool aisle_mission_fits(const aisle_mission *self, const aisle_request *request) {
    uint8_t order[AISLE_GOAL_LIST_MAX_GOALS];
    return order_of(self, request, order);
}

uint32_t aisle_mission_take_order(aisle_mission *self, const aisle_request *request) {
    uint8_t order[AISLE_GOAL_LIST_MAX_GOALS];
    const bool fits = order_of(self, request, order);
    AISLE_ASSERT(fits);
    if (order[0] != self->order[0]) {
        break_rest(self);
    }
    memcpy(self->order, order, self->left);
    memmove(self->request.goals, request->goals, sizeof request->goals); // it may be ours
    for (uint32_t i = 0; i < self->count; i++) {
        if (self->fate[i] == AISLE_GOAL_ASIDE) {
            self->fate[i] = AISLE_GOAL_UNREACHABLE;
        }
    }
    self->kept = self->sent = self->left;
    self->cause = 0;
    return (uint32_t)(uint16_t)request->num_goals - self->left;
}
