#include "plan/planner_state.h"

#include "base/check.h"

#include <string.h>

#define PLANNING_DELAY 0.2          // s, that planning under way may take at first
#define PLANNING_DELAY_MAX 3.2      // s
#define TRIES_MAX 4U                // at leaving the path under way, before the vehicle is stopped for it
#define PATIENCE_US 4000000         // of a vehicle that hardly gets on, before it looks for a way round
#define PATIENCE_STANDING_US 500000 // the same of what stands
#define SWIFT_US 1000000            // without a hindrance, after which it counts as over
#define NO_END 240.0                // s, counted for a wait without an end in sight
#define LOOK_ROUND_US 500000        // between two looks whether going round is worth it
#define LOOK_ROUND_MAX_US 8000000   // after looks that were in vain, each twice as long as the one before
#define DELAY_WORTH 5.0             // s, of waiting, before going round is looked for
#define GAIN_WORTH 5.0              // s, that going round must save

// ---- where plans begin

void aisle_planner_leave_from(aisle_planner *self, aisle_request *request) {
    aisle_leaving *leaving = &self->leaving;
    const aisle_drive *drive = &self->drive;
    leaving->under_way = drive->has_plan && aisle_drive_moves(drive) && !drive->is_off;
    if (!leaving->under_way) {
        return;
    }
    const aisle_drive_path *plan = &drive->plan;
    leaving->from = aisle_drive_rest(drive, &self->vehicle, AISLE_PACE_LATENCY + leaving->delay);
    leaving->serial = drive->plan_serial;
    const aisle_pose2 pose =
        aisle_motion_pose(plan->msg->waypoints, (uint32_t)(uint16_t)plan->msg->num_waypoints, leaving->from);
    request->start = (aisle_goal_msg){.x = pose.x, .y = pose.y, .theta = pose.theta};
}

void aisle_planner_go_round(aisle_planner *self) {
    const aisle_drive_path *plan = &self->drive.plan;
    const aisle_leaving *leaving = &self->leaving;
    double way = 0.0;
    if (leaving->under_way) {
        const uint32_t n = (uint32_t)(uint16_t)plan->msg->num_waypoints;
        way = aisle_motion_length_to(plan->msg->waypoints, n, leaving->from) -
              aisle_motion_length_to(plan->msg->waypoints, n, plan->at);
    }
    const double time = way / aisle_max(self->drive.v, self->vehicle.creep_speed);
    aisle_route_go_round(self->route, &self->movers, self->now_us + (int64_t)(time * 1e6), leaving->under_way);
}

static int64_t look_after(int64_t pause_us) {
    return pause_us < LOOK_ROUND_US ? LOOK_ROUND_US : pause_us > LOOK_ROUND_MAX_US ? LOOK_ROUND_MAX_US : pause_us;
}

// There is no way round, or none that is worth it.
static void stay_on(aisle_planner *self) {
    self->leaving.round = self->leaving.goes_round = false;
    self->look_us = look_after(2 * self->look_us);
}

// Planned once more, from farther ahead; at last from where the vehicle stands.
static void try_again(aisle_planner *self) {
    aisle_leaving *leaving = &self->leaving;
    if (leaving->goes_round) { // it will be weighed again
        leaving->round = leaving->goes_round = false;
        return;
    }
    if (++leaving->tries > TRIES_MAX) {
        leaving->tries = 0;
        self->failed = (aisle_refusal){AISLE_STATUS_BUDGET, 0, 0.0F};
        self->cycle_wanted = true;
        return;
    }
    leaving->delay = leaving->delay > 0.0 ? aisle_min(2.0 * leaving->delay, PLANNING_DELAY_MAX) : PLANNING_DELAY;
    aisle_planner_replan(self);
}

static bool take_under_way(aisle_planner *self, const aisle_request *request, const aisle_proof *proof) {
    const aisle_leaving *leaving = &self->leaving;
    aisle_drive *drive = &self->drive;
    const aisle_drive_world world = {self->layout, &self->vehicle, &self->movers};
    if (!drive->has_plan || drive->plan_serial != leaving->serial) {
        return false;
    }
    aisle_path_msg *path = self->route->decoded; // the verifier's, which is done
    aisle_status st = aisle_msg_decode(AISLE_MSG_PATH, proof->bytes, proof->size, path, NULL);
    AISLE_ASSERT(st == AISLE_OK);
    return aisle_drive_splice(drive, &world, leaving->from, path, request->goals,
                              (uint32_t)(uint16_t)request->num_goals);
}

// Goals of it that were reached meanwhile are behind.
static void pass_goals(aisle_planner *self, uint32_t passed) {
    for (; passed > 0U; passed--) {
        aisle_drive_pass_goal(&self->drive);
    }
}

static void take_plan(aisle_planner *self, const aisle_request *request, const aisle_proof *proof) {
    if (!self->leaving.under_way && aisle_drive_moves(&self->drive)) { // a better path from where it has left
        return;
    }
    if (!aisle_mission_fits(&self->mission, request) ||
        (self->leaving.under_way && !take_under_way(self, request, proof))) {
        try_again(self);
        return;
    }
    if (!self->leaving.under_way) {
        aisle_drive_adopt(&self->drive, proof, request->goals, (uint32_t)(uint16_t)request->num_goals);
    }
    pass_goals(self, aisle_mission_take_order(&self->mission, request));
    self->leaving.delay = 0.0;
    self->leaving.tries = 0;
    self->failed.cause = 0;
    self->cycle_wanted = true;
}

void aisle_planner_take_failure(aisle_planner *self, const aisle_request *request, const aisle_refusal *why,
                                const aisle_waypoint_msg *told, uint32_t told_count, uint32_t work_units) {
    if (self->leaving.goes_round) { // it waits on
        stay_on(self);
        return;
    }
    if (aisle_drive_moves(&self->drive)) {
        self->failed = *why;
        self->cycle_wanted = true;
        return;
    }
    aisle_drive_drop(&self->drive);
    aisle_planner_refuse(self, request, why, told, told_count, work_units);
}

// ---- the cycle

// Must the vehicle be stopped, or not leave?
static bool must_stop(const aisle_planner *self, aisle_refusal *why) {
    *why = (aisle_refusal){0, 0, 0.0F};
    why->cause = aisle_planner_lease_hindrance(self, self->now_us, &why->id);
    if (why->cause != 0) {
        return true;
    }
    if (self->drive.is_off) {
        *why = (aisle_refusal){AISLE_STATUS_OFF_PATH, self->pose.seq, (float)self->drive.off.lateral};
        return true;
    }
    if (self->drive.is_unfit) {
        *why = (aisle_refusal){AISLE_STATUS_MAP_MISMATCH, aisle_layout_map_revision(self->layout), 0.0F};
        return true;
    }
    if (self->failed.cause != 0) {
        *why = self->failed;
        return true;
    }
    return self->held || !self->mission.wanted;
}

// When what the vehicle is driven by turns stale.
static int64_t stale_at(const aisle_planner *self) {
    const int64_t pose = self->pose_at_us + (int64_t)(self->vehicle.pose_timeout * 1e6) + 1;
    const int64_t movers = aisle_movers_stale_at(&self->movers, self->vehicle.obstacles_timeout);
    return movers < pose ? movers + 1 : pose;
}

int64_t aisle_planner_cycle_deadline(const aisle_planner *self) {
    const aisle_drive *drive = &self->drive;
    aisle_refusal why;
    if (!drive->has_plan || !drive->has_out) {
        return INT64_MAX;
    }
    if (must_stop(self, &why)) { // at once, if that is still to be done
        return aisle_drive_moves(drive) && !aisle_drive_is_stopping(drive) ? self->now_us : INT64_MAX;
    }
    const int64_t stale = aisle_drive_moves(drive) ? stale_at(self) : INT64_MAX;
    return self->lease_due_us < stale ? self->lease_due_us : stale;
}

bool aisle_planner_cycle_is_due(const aisle_planner *self) {
    return self->drive.stage != AISLE_DRIVE_IDLE ||
           (self->drive.has_plan && (self->cycle_wanted || self->now_us >= aisle_planner_cycle_deadline(self)));
}

static void begin_cycle(aisle_planner *self) {
    const aisle_drive_world world = {self->layout, &self->vehicle, &self->movers};
    aisle_refusal why;
    const bool stops = must_stop(self, &why);
    self->drive.rest = aisle_mission_rest(&self->mission);
    self->cycle_wanted = false;
    aisle_planner_fill_head(self, &self->mission.request);
    aisle_path_msg *head = self->head;
    head->path_revision = self->path_revision + 1;
    head->pose_utime = self->pose.utime;
    head->goal_list_id = self->drive.plan.msg->goal_list_id; // another list may be waiting for its plan
    head->goal_list_revision = self->drive.plan.msg->goal_list_revision;
    head->valid_until_utime = self->now_us + AISLE_LEASE_US;
    aisle_drive_begin(&self->drive, &world, self->now_us, head, stops ? &why : NULL);
}

// A stopped vehicle, at rest: what is to follow.
static void after_stop(aisle_planner *self) {
    aisle_drive *drive = &self->drive;
    if (aisle_drive_moves(drive)) {
        return;
    }
    if (!self->mission.wanted) {
        aisle_planner_revoke(self, 0, 0);
    } else if (drive->is_off || drive->is_unfit || self->failed.cause != 0) {
        aisle_planner_revoke(self, drive->why.cause, drive->why.id);
        self->failed.cause = 0;
        aisle_planner_replan(self);
    }
}

// ---- wait, or go round?

static void begin_weighing(aisle_planner *self, aisle_weighing what, const aisle_waypoint_msg *w, uint32_t n,
                           const float *dwell, aisle_place at) {
    const aisle_pace_predict_request request = {.layout = self->layout,
                                                .vehicle = &self->vehicle,
                                                .movers = &self->movers,
                                                .w = w,
                                                .n = n,
                                                .dwell = dwell,
                                                .at = at,
                                                .v = what == AISLE_WEIGHING_WAIT ? self->drive.v : 0.0,
                                                .until = aisle_drive_next_goal(w, n),
                                                .now_us = self->now_us,
                                                .late = self->vehicle.reaction_time,
                                                .lease = AISLE_DRIVE_PACE_LEASE * self->drive.shortest_lease};
    aisle_pace_predict_start(&self->predict, &request);
    self->weighing = what;
}

// Does the mover of this id stand? Then it is no use to come near first.
static bool stands(const aisle_planner *self, int32_t id) {
    for (uint32_t i = 0; i < self->movers.count; i++) {
        const aisle_mover *mover = &self->movers.mover[i];
        if (mover->id == id && aisle_vec2_length(mover->velocity) < AISLE_LOCAL_STANDING) {
            return true;
        }
    }
    return false;
}

// What slows the vehicle may be worth going round: how long will it take to go on?
static void weigh_waiting(aisle_planner *self) {
    const aisle_drive *drive = &self->drive;
    const bool yields = drive->why.cause == AISLE_STATUS_YIELDING;
    if (yields && (drive->v <= 0.5 * self->vehicle.creep_speed || stands(self, drive->why.id))) {
        self->hindered_us = self->now_us;
    } else if (self->now_us - self->hindered_us >= SWIFT_US) {
        self->swift_us = self->now_us;
        self->look_us = LOOK_ROUND_US;
    }
    const int64_t patience = stands(self, drive->why.id) ? PATIENCE_STANDING_US : PATIENCE_US;
    if (!yields || self->now_us - self->swift_us < patience || aisle_planner_is_busy(self) ||
        self->now_us - self->looked_us < look_after(self->look_us)) {
        return;
    }
    const aisle_drive_path *plan = &drive->plan;
    self->looked_us = self->now_us;
    begin_weighing(self, AISLE_WEIGHING_WAIT, plan->msg->waypoints, (uint32_t)(uint16_t)plan->msg->num_waypoints,
                   plan->dwell, plan->at);
}

// s to the next goal if nothing moved.
static double free_time(const aisle_planner *self) {
    const aisle_drive_path *plan = &self->drive.plan;
    const uint32_t n = (uint32_t)(uint16_t)plan->msg->num_waypoints;
    const aisle_waypoint_msg *w = plan->msg->waypoints;
    return (double)w[aisle_drive_next_goal(w, n)].t - aisle_motion_time(&self->vehicle, w, n, plan->dwell, plan->at);
}

// The way round is worth it if the vehicle is there sooner, what it still drives of the old way counted.
static void take_round(aisle_planner *self, double seconds) {
    const aisle_route *route = self->route;
    self->counters[AISLE_COUNTER_WAIT_MS] = (int64_t)(self->wait_s * 1e3);
    self->counters[AISLE_COUNTER_ROUND_MS] = (int64_t)(seconds * 1e3);
    if (seconds + GAIN_WORTH < self->wait_s && !aisle_mission_is_stale(&self->mission, &route->request)) {
        self->counters[AISLE_COUNTER_ROUNDS]++;
        take_plan(self, &route->request, aisle_route_answer(route));
        self->leaving.round = self->leaving.goes_round = false;
    } else {
        stay_on(self);
    }
}

void aisle_planner_step_weighing(aisle_planner *self, uint32_t units) {
    uint32_t spent = 0;
    const aisle_status st = aisle_pace_predict_step(&self->predict, units, &spent);
    self->counters[AISLE_COUNTER_WORK_UNITS] += spent;
    if (st == AISLE_BUSY) {
        return;
    }
    const aisle_weighing what = self->weighing;
    const double seconds = st == AISLE_OK ? self->predict.seconds : self->predict.seconds + NO_END;
    self->weighing = AISLE_WEIGHING_NOTHING;
    if (what == AISLE_WEIGHING_ROUND) {
        take_round(self, seconds);
    } else if (self->drive.has_plan && self->mission.wanted) {
        // Whoever has hindered it for so long will hardly be gone sooner, wherever it seems to go.
        const double waited = (double)(self->now_us - self->swift_us) * 1e-6;
        self->wait_s = aisle_max(seconds, free_time(self) + waited);
        self->leaving.round = self->wait_s - free_time(self) > DELAY_WORTH;
        self->mission.replan = self->mission.replan || self->leaving.round;
    }
}

void aisle_planner_take_plan(aisle_planner *self, const aisle_request *request, const aisle_proof *proof) {
    if (!self->leaving.goes_round) {
        take_plan(self, request, proof);
        return;
    }
    aisle_path_msg *path = self->route->decoded; // the verifier's, which is done
    aisle_status st = aisle_msg_decode(AISLE_MSG_PATH, proof->bytes, proof->size, path, NULL);
    AISLE_ASSERT(st == AISLE_OK);
    const uint32_t n = (uint32_t)(uint16_t)path->num_waypoints;
    begin_weighing(self, AISLE_WEIGHING_ROUND, path->waypoints, n, NULL,
                   n > 1U ? (aisle_place){1U, 0.0} : (aisle_place){0U, 0.0});
}

static void tell_verdict(aisle_planner *self, aisle_drive_verdict verdict) {
    aisle_drive *drive = &self->drive;
    switch (verdict) {
    case AISLE_DRIVE_CHANGE:
        self->path_revision = drive->out.msg->path_revision;
        self->counters[AISLE_COUNTER_PATHS]++;
        aisle_planner_send(self);
        break;
    case AISLE_DRIVE_KEEP:
        if (drive->has_out && !drive->stops && self->now_us >= self->lease_due_us) {
            aisle_planner_send(self);
        }
        break;
    case AISLE_DRIVE_LOST:
        aisle_planner_withdraw(self, &drive->why);
        break;
    }
}

void aisle_planner_step_cycle(aisle_planner *self, uint32_t units) {
    aisle_drive *drive = &self->drive;
    aisle_drive_verdict verdict;
    if (drive->stage == AISLE_DRIVE_IDLE) {
        begin_cycle(self);
    }
    const aisle_status st = aisle_drive_step(drive, units, &verdict);
    self->counters[AISLE_COUNTER_WORK_UNITS] += drive->spent;
    drive->spent = 0;
    if (st != AISLE_OK) {
        return;
    }
    self->counters[AISLE_COUNTER_CYCLES]++;
    tell_verdict(self, verdict);
    if (drive->stops || drive->is_unfit) {
        after_stop(self);
    } else {
        weigh_waiting(self);
    }
}
