#include "plan/drive.h"

#include "base/angle.h"
#include "base/check.h"
#include "robot/curve.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

#define RESTING 0.01 // rad/s: a slower turn is rest
#define STILL 0.05   // m/s, rad/s: faster a vehicle without a path is not sent off
#define BACK 0.3     // m, how far behind its last place the vehicle may be found
#define AHEAD 0.5    // m, and ahead of where it could have got to
#define AGE_MAX 0.3  // s, a pose is moved on by at most
#define JOINT 1e-6   // m, two ways that meet are apart by at most
#define APART 2e-3   // m, from a waypoint to where a path is left
#define SNAP 2e-6    // m, shorter stretches are none

static double lease_most(void) {
    return (double)AISLE_LEASE_US * 1e-6;
}

// ---- memory

static void carve_path(aisle_drive_path *path, aisle_arena *arena) {
    path->msg = (aisle_path_msg *)aisle_arena_take(arena, 1U, sizeof(aisle_path_msg));
    path->dwell = (float *)aisle_arena_take(arena, AISLE_PATH_MAX_WAYPOINTS, sizeof(float));
}

void aisle_drive_carve(aisle_drive *self, aisle_arena *arena) {
    aisle_drive_path path;
    memset(&path, 0, sizeof path);
    carve_path(self != NULL ? &self->plan : &path, arena);
    carve_path(self != NULL ? &self->out : &path, arena);
    carve_path(self != NULL ? &self->next : &path, arena);
    void *out = aisle_arena_take(arena, AISLE_ROUTE_BYTES, 1U);
    void *next = aisle_arena_take(arena, AISLE_ROUTE_BYTES, 1U);
    void *head = aisle_arena_take(arena, 1U, offsetof(aisle_path_msg, waypoints));
    aisle_pace_carve(self != NULL ? &self->pace : NULL, arena);
    void *decoded = aisle_arena_take(arena, 1U, sizeof(aisle_path_msg));
    void *known = aisle_arena_take(arena, AISLE_PATH_MAX_WAYPOINTS, sizeof(aisle_verify_known));
    if (self != NULL) {
        self->out.bytes = (uint8_t *)out;
        self->next.bytes = (uint8_t *)next;
        self->head = (aisle_path_msg *)head;
        self->decoded = (aisle_path_msg *)decoded;
        self->known = (aisle_verify_known *)known;
        self->shortest_lease = (double)AISLE_LEASE_SHORTEST;
    }
}

// ---- the plan

static uint32_t count_of(const aisle_drive_path *path) {
    return (uint32_t)(uint16_t)path->msg->num_waypoints;
}

static aisle_place first_place(uint32_t n) {
    return n > 1U ? (aisle_place){1U, 0.0} : (aisle_place){0U, 0.0};
}

static void put_dwell(const aisle_drive *self, aisle_drive_path *path) {
    aisle_goal_dwells(path->msg->waypoints, count_of(path), self->goals + self->passed, self->num_goals - self->passed,
                      path->dwell);
}

static void take_plan(aisle_drive *self, const aisle_waypoint_msg *w, uint32_t n, const aisle_goal_msg *goals,
                      uint32_t num_goals) {
    AISLE_ASSERT(num_goals <= AISLE_GOAL_LIST_MAX_GOALS && n >= 1U && n <= AISLE_PATH_MAX_WAYPOINTS);
    memcpy(self->plan.msg->waypoints, w, n * sizeof w[0]);
    self->plan.msg->num_waypoints = (int16_t)n;
    self->plan.at = first_place(n);
    memmove(self->goals, goals, num_goals * sizeof goals[0]);
    self->num_goals = num_goals;
    self->passed = 0;
    put_dwell(self, &self->plan);
    self->has_plan = true;
    self->must_change = true;
    self->is_fresh = self->is_unfit = false;
    self->plan_serial++;
    self->stage = AISLE_DRIVE_IDLE;
}

void aisle_drive_adopt(aisle_drive *self, const aisle_proof *proof, const aisle_goal_msg *goals, uint32_t num_goals) {
    aisle_drive_path *next = &self->next;
    aisle_status st = aisle_msg_decode(AISLE_MSG_PATH, proof->bytes, proof->size, next->msg, NULL);
    AISLE_ASSERT(st == AISLE_OK && !aisle_drive_moves(self));
    memcpy(self->plan.msg, next->msg, offsetof(aisle_path_msg, waypoints));
    take_plan(self, next->msg->waypoints, count_of(next), goals, num_goals);
    memcpy(next->bytes, proof->bytes, proof->size);
    next->size = proof->size;
    next->stamp = proof->stamp;
    next->at = self->plan.at;
    next->passed = 0;
    next->level = 0;
    put_dwell(self, next);
    self->is_fresh = true;
    self->has_out = false;
    self->is_off = false;
}

void aisle_drive_drop(aisle_drive *self) {
    self->has_plan = self->has_out = self->must_change = self->is_fresh = self->is_off = self->is_unfit = false;
    self->stage = AISLE_DRIVE_IDLE;
    self->why = (aisle_refusal){0, 0, 0.0F};
}

// ---- where the vehicle is

static bool is_beyond(aisle_place a, aisle_place b) {
    return a.piece > b.piece || (a.piece == b.piece && a.u > b.u);
}

bool aisle_drive_moves(const aisle_drive *self) {
    return self->has_out && !self->is_resting;
}

uint32_t aisle_drive_next_goal(const aisle_waypoint_msg *w, uint32_t n) {
    uint32_t i = n > 1U ? 1U : 0U;
    while (i + 1U < n && (w[i].flags & AISLE_WAYPOINT_GOAL) == 0) {
        i++;
    }
    return i;
}

static aisle_place next_goal(const aisle_drive_path *path) {
    const uint32_t i = aisle_drive_next_goal(path->msg->waypoints, count_of(path));
    return (aisle_place){i, i > 0U ? 1.0 : 0.0};
}

static aisle_place project(const aisle_drive_path *path, double ahead, aisle_pose2 pose, aisle_off *off) {
    return aisle_motion_project(path->msg->waypoints, count_of(path), path->at, BACK, ahead, pose, off);
}

static aisle_place held_back(const aisle_drive_path *path, aisle_place found) { // to the next goal, if it is beyond it
    const aisle_place goal = next_goal(path);
    return is_beyond(found, goal) ? goal : found;
}

// The place of `pose` on a path, no farther than the next goal.
static aisle_place find(const aisle_drive_path *path, double ahead, aisle_pose2 pose, aisle_off *off) {
    return held_back(path, project(path, ahead, pose, off));
}

// Has the vehicle, found at this place of what is out, gone on over the next goal, which is not counted as reached?
static bool has_gone_on(const aisle_drive *self, aisle_place found, aisle_pose2 here) {
    const aisle_drive_path *out = &self->out;
    const aisle_place goal = next_goal(out);
    if (self->passed >= self->num_goals || !is_beyond(found, goal)) {
        return false;
    }
    const aisle_pose2 there = aisle_motion_pose(out->msg->waypoints, count_of(out), goal);
    const double told = (double)self->goals[self->passed].tolerance_xy;
    const double room = (told > 0.0 ? told : AISLE_DRIVE_OFF) + AISLE_DRIVE_OFF;
    return aisle_vec2_distance(aisle_vec2_of(here.x, here.y), aisle_vec2_of(there.x, there.y)) > room ||
           fabs(aisle_angle_difference(here.theta, there.theta)) > AISLE_DRIVE_OFF_HEADING;
}

void aisle_drive_locate(aisle_drive *self, const aisle_vehicle *vehicle, const aisle_pose_msg *pose) {
    const aisle_pose2 here = {pose->x, pose->y, pose->theta};
    const double since = aisle_clamp((double)(pose->utime - self->at_us) * 1e-6, 0.0, 1.0);
    const double ahead = AHEAD + since * vehicle->v_max;
    AISLE_ASSERT(self->stage == AISLE_DRIVE_IDLE);
    self->v = aisle_vec2_length(aisle_vec2_of((double)pose->vx, (double)pose->vy));
    self->omega = fabs((double)pose->omega);
    self->is_resting = self->v < AISLE_PACE_RESTING && self->omega < RESTING;
    self->at_us = pose->utime;
    if (!self->has_plan) {
        return;
    }
    bool has_left_goal = false;
    if (self->has_out) { // and the same on the plan, though what is out may begin ahead of the pose
        const aisle_drive_path *out = &self->out;
        const aisle_place found = project(out, ahead, here, &self->off);
        has_left_goal = has_gone_on(self, found, here);
        self->out.at = held_back(out, found);
        const aisle_pose2 place = aisle_motion_pose(out->msg->waypoints, count_of(out), out->at);
        self->plan.at = find(&self->plan, ahead + AHEAD, place, NULL);
    } else {
        self->plan.at = find(&self->plan, ahead, here, &self->off);
    }
    self->is_off = has_left_goal || self->off.lateral > aisle_max(vehicle->margin, AISLE_DRIVE_OFF) ||
                   fabs(self->off.heading) > AISLE_DRIVE_OFF_HEADING;
}

// The next goal is told no more, and the vehicle is not before it.
static void pass(aisle_drive_path *path) {
    aisle_waypoint_msg *w = path->msg->waypoints;
    const bool is_first = (w[0].flags & AISLE_WAYPOINT_GOAL) != 0; // it begins where the vehicle dwells
    const aisle_place goal = is_first ? first_place(count_of(path)) : next_goal(path);
    const uint32_t i = is_first ? 0U : goal.piece;
    w[i].flags &= (int16_t)~AISLE_WAYPOINT_GOAL;
    path->dwell[i] = 0.0F;
    path->at = is_beyond(goal, path->at) ? goal : path->at;
}

void aisle_drive_pass_goal(aisle_drive *self) {
    AISLE_ASSERT(self->passed < self->num_goals && self->stage == AISLE_DRIVE_IDLE);
    pass(&self->plan);
    if (self->has_out) {
        pass(&self->out);
    }
    self->passed++;
    self->plan_serial++; // its goals are others now
}

// Where it is at now_us if it follows what is out, on both paths.
static void move_on(aisle_drive *self, int64_t now_us) {
    const double age = aisle_clamp((double)(now_us - self->at_us) * 1e-6, 0.0, AGE_MAX);
    const aisle_drive_path *out = &self->out;
    const uint32_t n = count_of(out);
    if (!self->has_out || self->is_resting || n < 2U || !(age > 0.0)) {
        return;
    }
    const aisle_vehicle *vehicle = self->world.vehicle;
    const aisle_waypoint_msg *w = out->msg->waypoints;
    const double t = aisle_motion_time(vehicle, w, n, out->dwell, out->at) + age;
    self->out.at = held_back(out, aisle_motion_at_time(vehicle, w, n, out->dwell, t));
    self->at_us = now_us;
    self->plan.at = find(&self->plan, AHEAD + age * vehicle->v_max, aisle_motion_pose(w, n, self->out.at), NULL);
}

// The place, moved on until no tiny piece lies between it and a waypoint; a turn is left at its end.
static aisle_place clear_of_waypoints(const aisle_waypoint_msg *w, aisle_place place) {
    if (place.piece == 0U) {
        return place;
    }
    const double length = aisle_piece_length(&w[place.piece - 1U], &w[place.piece]);
    const double u = place.u * length < APART ? APART / aisle_max(length, APART) : place.u;
    return (aisle_place){place.piece, (1.0 - u) * length < APART ? 1.0 : u};
}

aisle_place aisle_drive_rest(const aisle_drive *self, const aisle_vehicle *vehicle, double delay) {
    const aisle_drive_path *out = &self->out;
    AISLE_ASSERT(self->has_plan);
    if (!aisle_drive_moves(self)) {
        return self->plan.at;
    }
    const uint32_t n = count_of(out);
    const aisle_waypoint_msg *w = out->msg->waypoints;
    const aisle_place rest =
        aisle_motion_rest(vehicle, w, n, out->dwell, out->at, self->v, vehicle->reaction_time + delay);
    const double way = aisle_motion_length_to(w, n, rest) - aisle_motion_length_to(w, n, out->at);
    aisle_place place = find(&self->plan, way + BACK, aisle_motion_pose(w, n, rest), NULL);
    return clear_of_waypoints(self->plan.msg->waypoints, place);
}

// ---- another way from a place on

// Shortens cut[n], a path from `at` on, so that it ends at `to`, a place of the path w[of] it was cut from.
static uint32_t end_at(const aisle_waypoint_msg *w, uint32_t of, aisle_place at, aisle_place to,
                       aisle_waypoint_msg *cut, uint32_t n) {
    uint32_t end = n - (of - to.piece); // what waypoint to.piece is in cut: the last ones are the same
    if (!(to.u < 1.0)) {
        return end + 1U;
    }
    const double length = aisle_motion_length_to(w, of, to) - aisle_motion_length_to(w, of, at);
    while (end > 0U && (double)cut[end - 1U].s > length - SNAP) { // and no piece of no length
        end--;
    }
    if (end > 0U) {
        const aisle_pose2 pose = aisle_motion_pose(w, of, to);
        cut[end].x = pose.x;
        cut[end].y = pose.y;
        cut[end].theta = pose.theta;
        cut[end].flags &= AISLE_WAYPOINT_REVERSE;
    }
    return end + 1U;
}

// Joins tail to the `head` waypoints of path, which end where it begins: how it is left there is the tail's.
static bool join(aisle_path_msg *path, uint32_t head, const aisle_waypoint_msg *tail, uint32_t n) {
    aisle_waypoint_msg *last = &path->waypoints[head - 1U];
    const double turn = aisle_angle_difference(last->theta, tail[0].theta);
    const double apart = aisle_vec2_distance(aisle_vec2_of(last->x, last->y), aisle_vec2_of(tail[0].x, tail[0].y));
    if (head + n - 1U > AISLE_PATH_MAX_WAYPOINTS || fabs(turn) > AISLE_CURVE_HEADING_TOLERANCE || apart > JOINT) {
        return false;
    }
    last->flags |= (int16_t)(tail[0].flags & (AISLE_WAYPOINT_TURN_IN_PLACE | AISLE_WAYPOINT_GOAL));
    last->goal_id = (tail[0].flags & AISLE_WAYPOINT_GOAL) != 0 ? tail[0].goal_id : last->goal_id;
    memcpy(last + 1, tail + 1, (n - 1U) * sizeof tail[0]);
    path->num_waypoints = (int16_t)(head + n - 1U);
    return true;
}

// Speeds and times of a way that begins where the vehicle is, as fast as the ground allows.
static bool time_joined(aisle_drive *self, const aisle_drive_world *world, const aisle_goal_msg *goals,
                        uint32_t num_goals) {
    aisle_drive_path *joined = &self->next;
    aisle_waypoint_msg *w = joined->msg->waypoints;
    const uint32_t n = count_of(joined);
    const bool rests = n == 1U || (w[0].flags & (AISLE_WAYPOINT_STOP | AISLE_WAYPOINT_TURN_IN_PLACE)) != 0;
    const aisle_profile_start start = {.v = rests ? 0.0 : aisle_min(self->v, AISLE_VEHICLE_SPEED_MAX)};
    aisle_profile_sum sum;
    aisle_goal_dwells(w, n, goals, num_goals, joined->dwell);
    joined->dwell[0] = 0.0F; // whatever is left of it is the mission's
    aisle_profile_path way = {.w = w, .dwell = joined->dwell, .n = n, .capacity = AISLE_PATH_MAX_WAYPOINTS};
    const aisle_status st = aisle_profile_fill_ramps(world->vehicle, world->layout, &way, &start, &sum);
    joined->msg->num_waypoints = (int16_t)way.n;
    return st == AISLE_OK || st == AISLE_PARTIAL;
}

bool aisle_drive_splice(aisle_drive *self, const aisle_drive_world *world, aisle_place from, const aisle_path_msg *tail,
                        const aisle_goal_msg *goals, uint32_t num_goals) {
    const aisle_drive_path *plan = &self->plan;
    aisle_path_msg *joined = self->next.msg;
    if (is_beyond(aisle_drive_rest(self, world->vehicle, AISLE_PACE_LATENCY), from)) {
        return false;
    }
    const uint32_t cut = aisle_motion_cut(world->vehicle, plan->msg->waypoints, count_of(plan), plan->dwell, plan->at,
                                          joined->waypoints, AISLE_PATH_MAX_WAYPOINTS);
    if (cut == 0U) {
        return false;
    }
    const uint32_t head = end_at(plan->msg->waypoints, count_of(plan), plan->at, from, joined->waypoints, cut);
    if (!join(joined, head, tail->waypoints, (uint32_t)(uint16_t)tail->num_waypoints) ||
        !time_joined(self, world, goals, num_goals)) {
        return false;
    }
    self->plan.msg->goal_list_id = tail->goal_list_id;
    self->plan.msg->goal_list_revision = tail->goal_list_revision;
    self->plan.msg->planner = tail->planner;
    self->plan.msg->cached = tail->cached;
    self->plan.msg->work_units = tail->work_units;
    take_plan(self, joined->waypoints, (uint32_t)(uint16_t)joined->num_waypoints, goals, num_goals);
    return true;
}

// ---- the cycle

bool aisle_drive_is_stopping(const aisle_drive *self) {
    return self->has_out && self->out.msg->status == AISLE_PATH_STOP;
}

int64_t aisle_drive_lease_until(const aisle_drive *self) {
    AISLE_ASSERT(self->has_out);
    return aisle_drive_is_stopping(self) ? self->cycle_us + AISLE_LEASE_US : self->out.moving.until_us;
}

void aisle_drive_begin(aisle_drive *self, const aisle_drive_world *world, int64_t now_us, const aisle_path_msg *head,
                       const aisle_refusal *stop) {
    AISLE_ASSERT(self->has_plan && self->stage == AISLE_DRIVE_IDLE);
    self->world = *world;
    self->cycle_us = now_us;
    memcpy(self->head, head, offsetof(aisle_path_msg, waypoints));
    self->stops = stop != NULL;
    if (stop != NULL) {
        self->why = *stop;
    }
    self->brakes = false;
    self->lease = lease_most();
    self->stage = AISLE_DRIVE_CHECK;
    move_on(self, now_us);
}

static aisle_status end(aisle_drive *self, aisle_drive_verdict what, aisle_drive_verdict *verdict) {
    self->stage = AISLE_DRIVE_IDLE;
    *verdict = what;
    return AISLE_OK;
}

// What is next goes out.
static aisle_status change(aisle_drive *self, aisle_drive_verdict *verdict) {
    const aisle_drive_path swap = self->out;
    self->out = self->next;
    self->next = swap;
    self->has_out = true;
    self->is_fresh = self->must_change = false;
    self->changed_us = self->cycle_us;
    return end(self, AISLE_DRIVE_CHANGE, verdict);
}

// s. It may take the whole reaction time to obey; and what is left of a dwell may be over for it at once, or not: a
// controller counts it for itself, and one that is sent a path that begins on a goal may have done with it.
static double lateness(const aisle_drive *self) {
    return self->world.vehicle->reaction_time + self->rest;
}

static void begin_moving(aisle_drive *self, const aisle_drive_path *path, aisle_drive_stage stage) {
    const aisle_moving_request request = {.vehicle = self->world.vehicle,
                                          .movers = self->world.movers,
                                          .bytes = path->bytes,
                                          .size = path->size,
                                          .path = path->msg,
                                          .at_piece = path->at.piece,
                                          .at_u = path->at.u,
                                          .v = self->v,
                                          .omega = self->omega,
                                          .goals = self->goals + path->passed,
                                          .num_goals = self->num_goals - path->passed,
                                          .now_us = self->cycle_us,
                                          .lease = self->lease,
                                          .late = lateness(self)};
    aisle_verify_moving_start(&self->moving, &request);
    self->stage = stage;
}

// A level that what is out has, for those who ask for a faster one.
static uint32_t present_level(const aisle_drive *self) {
    return self->has_out && aisle_drive_moves(self) && !aisle_drive_is_stopping(self) ? self->out.level
                                                                                      : AISLE_PACE_STOP;
}

// Of what is out, from the vehicle's place to where it could be brought to rest.
static void take_base(aisle_drive *self) {
    const aisle_drive_path *out = &self->out;
    const aisle_vehicle *vehicle = self->world.vehicle;
    const uint32_t n = count_of(out);
    const aisle_waypoint_msg *w = out->msg->waypoints;
    const aisle_place rest =
        aisle_motion_rest(vehicle, w, n, out->dwell, out->at, self->v, vehicle->reaction_time + AISLE_PACE_LATENCY);
    const double reach = aisle_motion_length_to(w, n, rest) - aisle_motion_length_to(w, n, out->at);
    const bool in_turn = n > 1U && (w[out->at.piece - 1U].flags & AISLE_WAYPOINT_TURN_IN_PLACE) != 0;
    self->base = (aisle_verify_base){.w = w,
                                     .n = n,
                                     .dwell = out->dwell,
                                     .piece = out->at.piece,
                                     .u = out->at.u,
                                     .reach = aisle_max(reach, 0.0),
                                     .turn = in_turn && out->at.u > 0.0 && out->at.u < 1.0};
}

// From which level on speeds are no better than what is out, if that is fit to go on and better ones are looked for; 0: none.
static uint32_t enough(const aisle_drive *self, uint32_t level) {
    const bool goes_on =
        self->has_out && !self->must_change && !aisle_drive_is_stopping(self) && aisle_drive_moves(self);
    return goes_on && level < self->out.level ? self->out.level : 0U;
}

// Looks for speeds from `level` on.
static void begin_pace(aisle_drive *self, uint32_t level) {
    const aisle_drive_path *plan = &self->plan;
    const bool moves = aisle_drive_moves(self);
    if (moves) {
        take_base(self);
    }
    const aisle_pace_request request = {.layout = self->world.layout,
                                        .vehicle = self->world.vehicle,
                                        .movers = self->world.movers,
                                        .w = plan->msg->waypoints,
                                        .n = count_of(plan),
                                        .dwell = plan->dwell,
                                        .at = plan->at,
                                        .v = moves ? self->v : 0.0,
                                        .omega = moves ? self->omega : 0.0,
                                        .base = moves ? &self->base : NULL,
                                        .now_us = self->cycle_us,
                                        .late = lateness(self),
                                        .lease = self->shortest_lease *
                                                 (moves ? AISLE_DRIVE_PACE_LEASE : AISLE_DRIVE_START_LEASE),
                                        .first = level,
                                        .current = present_level(self),
                                        .enough = enough(self, level)};
    memcpy(self->next.msg, self->head, offsetof(aisle_path_msg, waypoints));
    aisle_pace_start(&self->pace, &request, self->next.msg);
    self->stage = AISLE_DRIVE_PACE;
}

static aisle_status step_check(aisle_drive *self, aisle_drive_verdict *verdict) {
    if (self->stops && (!aisle_drive_moves(self) || aisle_drive_is_stopping(self))) {
        return end(self, AISLE_DRIVE_KEEP, verdict); // it stands, or brakes already
    }
    if (!self->has_out && !(self->v < STILL && self->omega < STILL)) { // it brakes still, where no proof sees it
        return end(self, AISLE_DRIVE_KEEP, verdict);
    }
    if (self->stops) {
        self->brakes = true;
        begin_pace(self, AISLE_PACE_STOP);
    } else if (self->is_fresh && self->next.msg->path_revision == self->head->path_revision) {
        begin_moving(self, &self->next, AISLE_DRIVE_FRESH);
    } else if (self->must_change || !self->has_out || aisle_drive_is_stopping(self)) {
        begin_pace(self, 0);
    } else {
        begin_moving(self, &self->out, AISLE_DRIVE_CHECK_MOVING);
    }
    return AISLE_BUSY;
}

// The proof of a path for a lease; where it fails for half of it, and so on to the shortest. AISLE_ERR_DATA: for none.
static aisle_status prove_moving(aisle_drive *self, aisle_drive_path *path, uint32_t units) {
    const aisle_status st = aisle_verify_moving_step(&self->moving, units, &self->spent, &path->moving);
    if (st != AISLE_ERR_DATA) {
        return st;
    }
    if (self->lease <= self->shortest_lease) {
        self->why = (aisle_refusal){AISLE_STATUS_YIELDING, self->moving.blocker, 0.0F};
        return AISLE_ERR_DATA;
    }
    self->lease = aisle_max(0.5 * self->lease, self->shortest_lease);
    begin_moving(self, path, self->stage);
    return AISLE_BUSY;
}

static aisle_status step_fresh(aisle_drive *self, uint32_t units, aisle_drive_verdict *verdict) {
    const aisle_status st = prove_moving(self, &self->next, units);
    if (st == AISLE_OK) {
        self->why = (aisle_refusal){0, 0, 0.0F};
        return change(self, verdict);
    }
    if (st == AISLE_ERR_DATA) {
        self->is_fresh = false;
        begin_pace(self, 1);
    }
    return AISLE_BUSY;
}

// What is out may go on. Would a faster one do?
static aisle_status kept(aisle_drive *self, aisle_drive_verdict *verdict) {
    if (self->out.level == 0U) { // nothing slows it
        self->why = (aisle_refusal){0, 0, 0.0F};
    } else if (self->cycle_us - self->changed_us >= AISLE_DRIVE_SPEED_UP_US) {
        begin_pace(self, 0);
        return AISLE_BUSY;
    }
    return end(self, AISLE_DRIVE_KEEP, verdict);
}

static aisle_status step_check_moving(aisle_drive *self, uint32_t units, aisle_drive_verdict *verdict) {
    const aisle_status st = prove_moving(self, &self->out, units);
    if (st == AISLE_OK) {
        return kept(self, verdict);
    }
    if (st == AISLE_ERR_DATA) {
        begin_pace(self, self->out.level);
    }
    return AISLE_BUSY;
}

// ---- a path of other speeds

// Is what is next the plan as a whole?
static bool begins_at_start(const aisle_drive *self) {
    return self->next.level == 0U && self->plan.at.piece <= 1U && !(self->plan.at.u > 0.0) && !aisle_drive_moves(self);
}

static void fill_next(aisle_drive *self) {
    aisle_drive_path *next = &self->next;
    const aisle_path_msg *plan = self->plan.msg;
    aisle_path_msg *msg = next->msg;
    msg->status = (int8_t)(self->brakes                     ? AISLE_PATH_STOP
                           : next->level == AISLE_PACE_STOP ? AISLE_PATH_PARTIAL
                                                            : AISLE_PATH_OK);
    msg->cause = self->why.cause;
    msg->cause_id = self->why.id;
    msg->cause_value = self->why.value;
    msg->planner = plan->planner;
    msg->cached = plan->cached;
    msg->work_units = plan->work_units;
    if (begins_at_start(self)) {
        msg->length_bound = plan->length_bound;
        msg->risk = plan->risk; // by closer looks than the pieces' clearances
    } else {
        msg->length_bound = 0.0F; // it was one from elsewhere
    }
    msg->clearance_moving_min = msg->planning_time = 0.0F; // told with its lease; not told
    next->at = first_place(count_of(next));
    next->passed = self->passed;
    put_dwell(self, next);
}

static bool encode(aisle_drive *self) {
    aisle_drive_path *next = &self->next;
    return aisle_path_encode(next->msg, next->bytes, AISLE_ROUTE_BYTES, &next->size) == AISLE_OK;
}

static void begin_static(aisle_drive *self) {
    const aisle_drive_path *next = &self->next;
    const aisle_verify_request request = {
        .layout = self->world.layout,
        .vehicle = self->world.vehicle,
        .bytes = next->bytes,
        .size = next->size,
        .start = aisle_motion_pose(self->plan.msg->waypoints, count_of(&self->plan), self->plan.at),
        .v_start = (double)next->msg->waypoints[0].v,
        .base = aisle_drive_moves(self) ? &self->base : NULL,
        .goals = self->goals + self->passed,
        .num_goals = self->num_goals - self->passed,
        .known = self->known};
    aisle_verify_start(&self->verify, &request, self->decoded);
    self->stage = AISLE_DRIVE_STATIC;
}

// Nothing slower is left: braking if it moves, else it stands and waits.
static aisle_status give_up(aisle_drive *self, aisle_drive_verdict *verdict) {
    if (aisle_drive_moves(self) && aisle_drive_is_stopping(self) && !self->must_change) { // it brakes already
        return end(self, AISLE_DRIVE_KEEP, verdict);
    }
    if (!aisle_drive_moves(self) || self->brakes) {
        self->is_fresh = false;
        return end(self, AISLE_DRIVE_LOST, verdict);
    }
    self->brakes = true;
    begin_pace(self, AISLE_PACE_STOP);
    return AISLE_BUSY;
}

static aisle_status step_pace(aisle_drive *self, uint32_t units, aisle_drive_verdict *verdict) {
    const aisle_status st = aisle_pace_step(&self->pace, units, &self->spent);
    if (st == AISLE_BUSY) {
        return AISLE_BUSY;
    }
    if (st != AISLE_OK && st != AISLE_PARTIAL) {
        self->is_unfit = true;
        return give_up(self, verdict);
    }
    self->next.level = self->pace.level;
    if (!self->brakes && self->pace.limit.is_known) {
        self->why = (aisle_refusal){AISLE_STATUS_YIELDING, self->pace.limit.id, 0.0F};
    } else if (self->next.level == 0U) {
        self->why = (aisle_refusal){0, 0, 0.0F};
    }
    if (self->pace.request.enough > 0U && self->next.level >= self->pace.request.enough) {
        return end(self, AISLE_DRIVE_KEEP, verdict);
    }
    if (st == AISLE_PARTIAL && !aisle_drive_moves(self)) { // it would stay where it is
        return give_up(self, verdict);
    }
    fill_next(self);
    if (!encode(self)) {
        self->is_unfit = true;
        return give_up(self, verdict);
    }
    if (self->brakes) {
        begin_static(self);
    } else {
        self->lease = lease_most();
        begin_moving(self, &self->next, AISLE_DRIVE_MOVING);
    }
    return AISLE_BUSY;
}

static aisle_status step_moving(aisle_drive *self, uint32_t units, aisle_drive_verdict *verdict) {
    const aisle_status st = prove_moving(self, &self->next, units);
    if (st == AISLE_OK) {
        begin_static(self);
    } else if (st == AISLE_ERR_DATA && self->next.level < AISLE_PACE_STOP) {
        begin_pace(self, self->next.level + 1U);
    } else if (st == AISLE_ERR_DATA) {
        return give_up(self, verdict);
    }
    return AISLE_BUSY;
}

static aisle_status step_static(aisle_drive *self, uint32_t units, aisle_drive_verdict *verdict) {
    const aisle_status st = aisle_verify_step(&self->verify, units, &self->spent, &self->next.stamp);
    if (st == AISLE_OK) {
        return change(self, verdict);
    }
    if (st == AISLE_ERR_DATA) {
        self->is_unfit = true;
        self->why = (aisle_refusal){AISLE_STATUS_VERIFY_FAILED, self->verify.fault_id, (float)self->verify.fault};
        return give_up(self, verdict);
    }
    return AISLE_BUSY;
}

static aisle_status step_stage(aisle_drive *self, uint32_t units, aisle_drive_verdict *verdict) {
    switch (self->stage) {
    case AISLE_DRIVE_CHECK:
        return step_check(self, verdict);
    case AISLE_DRIVE_FRESH:
        return step_fresh(self, units, verdict);
    case AISLE_DRIVE_CHECK_MOVING:
        return step_check_moving(self, units, verdict);
    case AISLE_DRIVE_PACE:
        return step_pace(self, units, verdict);
    case AISLE_DRIVE_MOVING:
        return step_moving(self, units, verdict);
    case AISLE_DRIVE_STATIC:
        return step_static(self, units, verdict);
    case AISLE_DRIVE_IDLE:
        break;
    }
    return AISLE_OK;
}

aisle_status aisle_drive_step(aisle_drive *self, uint32_t units, aisle_drive_verdict *verdict) {
    const uint32_t from = self->spent;
    aisle_status st = AISLE_BUSY;
    AISLE_ASSERT(self->stage != AISLE_DRIVE_IDLE);
    while (st == AISLE_BUSY && self->spent - from < units) {
        st = step_stage(self, units - (self->spent - from), verdict);
    }
    return st;
}
