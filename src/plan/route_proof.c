#include "plan/route_stages.h"

#include "base/check.h"

#define RESERVE_QUARTERS 3U // of all that the first proof took: kept back for building and proving the swarm's path

#define WORTH_A_SWARM 0.01 // of the length, what the swarm must be able to gain

// ---- BUILD, VERIFY

void aisle_route_begin_build(aisle_route *self) {
    self->path->path_revision = self->revision + (self->announced ? 1 : 0);
    self->leg = 0;
    self->stage = AISLE_ROUTE_BUILD;
    self->compose.path = NULL; // not begun
}

static bool any_swarm_leg(const aisle_route *self) {
    for (uint32_t i = 0; i < (uint32_t)self->request.num_goals; i++) {
        if (self->legs[i].use_swarm) {
            return true;
        }
    }
    return false;
}

static bool any_bred_leg(const aisle_route *self) {
    for (uint32_t i = 0; i < (uint32_t)self->request.num_goals; i++) {
        if (self->legs[i].is_bred) {
            return true;
        }
    }
    return false;
}

// The planner that is told: of a way, the one that found it; AUTO's sampler has a name, too.
static int8_t planner_of(const aisle_route *self) {
    if (self->way->kind == AISLE_WAY_LOCAL) {
        return AISLE_OPTIONS_PSO_LOCAL;
    }
    for (uint32_t i = 0; i < (uint32_t)self->request.num_goals; i++) {
        if (self->legs[i].is_sampled) {
            return aisle_route_is_sampling(self) ? self->request.options.planner : AISLE_OPTIONS_RRT_ADAPTIVE;
        }
    }
    if (any_bred_leg(self)) {
        return AISLE_OPTIONS_GA;
    }
    return any_swarm_leg(self) ? AISLE_OPTIONS_PSO : AISLE_OPTIONS_ASTAR;
}

static double length_bound(const aisle_route *self) {
    double sum = 0.0;
    for (uint32_t i = 0; i < (uint32_t)self->request.num_goals; i++) {
        sum += self->legs[i].bound;
    }
    return sum;
}

static void seal(aisle_route *self) {
    aisle_path_msg *path = self->path;
    path->planner = planner_of(self);
    path->work_units = (int32_t)self->spent;
    path->cause = self->is_cut ? AISLE_STATUS_BUDGET : 0;
    path->cause_value = self->is_cut ? (float)self->budget : 0.0F;
    float bound = (float)(length_bound(self) * (1.0 - 1e-6));
    path->length_bound = bound < path->length ? bound : path->length;
    aisle_status st = aisle_path_encode(path, self->spare.bytes, AISLE_ROUTE_BYTES, &self->spare.size);
    AISLE_ASSERT(st == AISLE_OK);
}

aisle_verify_request aisle_route_verify_request(const aisle_route *self, double first_theta) {
    const aisle_goal_msg *start = &self->request.start;
    bool any = aisle_goal_heading_is_free(start);
    return (aisle_verify_request){.layout = self->layout,
                                  .vehicle = self->vehicle,
                                  .bytes = self->spare.bytes,
                                  .size = self->spare.size,
                                  .start = {start->x, start->y, any ? first_theta : start->theta},
                                  .goals = self->request.goals,
                                  .num_goals = (uint32_t)self->request.num_goals};
}

static void begin_verify(aisle_route *self) {
    seal(self);
    aisle_verify_request request = aisle_route_verify_request(self, self->path->waypoints[0].theta);
    request.known = self->request.is_query ? NULL : self->known;
    request.looks_anew = true; // what a request costs hangs on it alone
    aisle_verify_start(&self->verify, &request, self->decoded);
    self->stage = AISLE_ROUTE_VERIFY;
}

// The way built could not be proved or does not fit: what next?
static aisle_status fall_back(aisle_route *self, int16_t cause, int32_t id, aisle_vec2 place) {
    if (self->way->kind == AISLE_WAY_REPAIR) {
        return aisle_route_end_repair(self, false);
    }
    if (self->way->kind == AISLE_WAY_PAPER) { // the paper's way or none
        return aisle_route_give_way_up(self, cause, id, 0.0, place);
    }
    if (any_bred_leg(self) && self->way->kind != AISLE_WAY_GA_PAPER) { // again, from the seeds alone
        self->is_unbred = true;
        aisle_route_begin_legs(self);
        return AISLE_BUSY;
    }
    bool tight = self->way->kind <= AISLE_WAY_CLEAR && !self->is_wide && !aisle_vehicle_is_disc(self->vehicle);
    if (any_swarm_leg(self)) { // the way without it was proved before
        return aisle_route_next_way(self);
    }
    if (tight) { // tight ways did not work out: again, for the disc in which the body turns
        self->is_wide = true;
        aisle_route_begin_legs(self);
        return AISLE_BUSY;
    }
    if (!self->stops && self->vehicle->curvature_max <= 0.0 && aisle_route_answer(self) == NULL) {
        self->stops = true;
        aisle_route_begin_build(self);
        return AISLE_BUSY;
    }
    return aisle_route_give_way_up(self, cause, id, 0.0, place);
}

aisle_compose_request aisle_route_build_request(aisle_route *self) {
    return (aisle_compose_request){.space = &self->space,
                                   .objective = &self->objective,
                                   .options = &self->request.options,
                                   .points = self->points,
                                   .pieces = self->pieces,
                                   .legs = self->legs,
                                   .leg_count = (uint32_t)self->request.num_goals,
                                   .start = &self->request.start,
                                   .goals = self->request.goals,
                                   .stops = self->stops};
}

aisle_status aisle_route_step_build(aisle_route *self, uint32_t units) {
    aisle_status st = AISLE_BUSY;
    if (self->compose.path == NULL) {
        aisle_compose_request request = aisle_route_build_request(self);
        st = aisle_compose_start(&self->compose, &request, self->path);
        if (st != AISLE_OK) {
            return fall_back(self, AISLE_STATUS_LIMIT, 0, aisle_route_place(&self->request.start));
        }
        return AISLE_BUSY;
    }
    st = aisle_compose_step(&self->compose, units, &self->spent);
    if (st == AISLE_OK) {
        begin_verify(self);
    } else if (st != AISLE_BUSY) { // too long for a path's clock, where limits or zones are that slow
        int16_t cause = st == AISLE_ERR_CAPACITY ? AISLE_STATUS_LIMIT : AISLE_STATUS_INTERNAL;
        return fall_back(self, cause, 0, aisle_route_place(&self->request.start));
    }
    return AISLE_BUSY;
}

static void begin_swarm_leg(aisle_route *self);

// Is there nothing on this way that a swarm could improve?
static bool is_settled(const aisle_route *self) {
    if (self->request.options.planner == AISLE_OPTIONS_ASTAR || self->way->kind == AISLE_WAY_LOCAL ||
        self->way->kind == AISLE_WAY_SAMPLE || self->request.options.planner == AISLE_OPTIONS_GA || self->stops) {
        return true;
    }
    if (self->request.options.planner == AISLE_OPTIONS_PSO) {
        return false;
    }
    if (self->objective.kind == AISLE_OPTIONS_SHORTEST) { // a disc's taut string cannot be beaten on length
        return self->request.options.objective != AISLE_OPTIONS_SHORTEST || aisle_vehicle_is_disc(self->vehicle) ||
               (double)self->path->length <= length_bound(self) * (1.0 + WORTH_A_SWARM);
    }
    for (uint32_t i = 0; i < (uint32_t)self->request.num_goals; i++) {
        if (!self->legs[i].is_clear) {
            return false;
        }
    }
    return true;
}

// The seeds of a way are proved: the swarm's turn, or the next way's.
static aisle_status after_seed_proof(aisle_route *self) {
    self->proof_units = self->proof_units > 0U ? self->proof_units : self->spent;
    if (is_settled(self)) {
        return aisle_route_next_way(self);
    }
    self->leg = 0;
    begin_swarm_leg(self);
    return self->stage == AISLE_ROUTE_SWARM ? aisle_route_announce(self) : AISLE_BUSY;
}

// Leg the waypoint belongs to, by the goals passed before it.
static uint32_t leg_of_waypoint(const aisle_route *self, uint32_t waypoint) {
    uint32_t leg = 0;
    for (uint32_t i = 0; i < waypoint && leg + 1U < (uint32_t)self->request.num_goals; i++) {
        leg += (self->path->waypoints[i].flags & AISLE_WAYPOINT_GOAL) != 0 ? 1U : 0U;
    }
    return leg;
}

// Builds the swarm's path again, or goes on if no leg is left to it.
static aisle_status rebuild(aisle_route *self) {
    if (!any_swarm_leg(self)) {
        return aisle_route_next_way(self);
    }
    aisle_route_begin_build(self);
    return AISLE_BUSY;
}

static aisle_status disproved(aisle_route *self) {
    self->verify_failed++;
    const aisle_verify *verify = &self->verify;
    aisle_leg *leg = &self->legs[leg_of_waypoint(self, verify->fault_waypoint)];
    if (leg->use_swarm && self->way->kind != AISLE_WAY_PAPER) {
        leg->use_swarm = false;
        return rebuild(self);
    }
    bool body = verify->fault == AISLE_VERIFY_COLLISION || verify->fault == AISLE_VERIFY_CURVATURE ||
                verify->fault == AISLE_VERIFY_HEADING || verify->fault == AISLE_VERIFY_DIRECTION ||
                verify->fault == AISLE_VERIFY_START || verify->fault == AISLE_VERIFY_GOAL;
    int16_t cause = body ? AISLE_STATUS_KINEMATIC : AISLE_STATUS_VERIFY_FAILED;
    const aisle_waypoint_msg *at = &self->path->waypoints[verify->fault_waypoint];
    bool placed = verify->fault == AISLE_VERIFY_COLLISION || verify->fault == AISLE_VERIFY_CREEP;
    return fall_back(self, cause, body ? verify->fault_id : (int32_t)verify->fault,
                     placed ? verify->fault_at : aisle_vec2_of(at->x, at->y));
}

// The swarm's path is proved; legs that came out worse than their seeds go back to them, once.
static aisle_status after_swarm_proof(aisle_route *self) {
    bool worse = false;
    bool by_name = self->request.options.planner == AISLE_OPTIONS_PSO;
    aisle_route_judge(self, by_name);
    for (uint32_t i = 0; i < (uint32_t)self->request.num_goals; i++) {
        aisle_leg *leg = &self->legs[i];
        if (leg->use_swarm && !by_name && leg->swarm_value > leg->seed_value) {
            leg->use_swarm = false;
            worse = true;
        }
    }
    return worse ? rebuild(self) : aisle_route_next_way(self);
}

void aisle_route_count_verify(aisle_route *self) {
    self->intervals += self->verify.intervals;
    self->collide.calls += self->verify.collide.calls;
    if (self->verify.collide.support_max > self->collide.support_max) {
        self->collide.support_max = self->verify.collide.support_max;
    }
}

aisle_status aisle_route_step_verify(aisle_route *self, uint32_t units) {
    aisle_status st = aisle_verify_step(&self->verify, units, &self->spent, &self->spare.stamp);
    if (st == AISLE_BUSY) {
        return AISLE_BUSY;
    }
    aisle_route_count_verify(self);
    if (st != AISLE_OK) {
        return disproved(self);
    }
    self->spare.basis = *aisle_verify_basis(&self->verify);
    if (self->way->kind == AISLE_WAY_REPAIR) {
        return aisle_route_end_repair(self, true);
    }
    if (any_swarm_leg(self)) {
        return after_swarm_proof(self);
    }
    aisle_route_judge(self, false);
    return after_seed_proof(self);
}

// ---- SWARM

// What the swarm may still spend.
static uint32_t left_for_swarm(const aisle_route *self) {
    uint64_t kept = (uint64_t)self->spent + (uint64_t)RESERVE_QUARTERS * self->proof_units / 4U;
    return kept < self->budget ? self->budget - (uint32_t)kept : 0U;
}

// Starts the swarm on the leg under way or a later one; goes on to build when there is none left.
static void begin_swarm_leg(aisle_route *self) {
    self->stage = AISLE_ROUTE_SWARM;
    for (; self->leg < (uint32_t)self->request.num_goals; self->leg++) {
        aisle_leg *leg = &self->legs[self->leg];
        aisle_space_begin(&self->space, self->layout, self->vehicle, leg->mode);
        if (leg->piece_count == 0U && leg->count >= 2U && !leg->is_clear && left_for_swarm(self) > 0U &&
            aisle_swarm_start(&self->swarm, &self->space, &self->objective, &self->request.options,
                              self->points + leg->first, leg->count) == AISLE_OK) {
            return;
        }
    }
    if (any_swarm_leg(self)) {
        aisle_route_begin_build(self);
    } else {
        self->stage = AISLE_ROUTE_NEXT;
    }
}

aisle_status aisle_route_step_swarm(aisle_route *self, uint32_t units) {
    uint32_t left = left_for_swarm(self);
    aisle_status st = aisle_swarm_step(&self->swarm, units < left ? units : left, &self->spent);
    if (st == AISLE_BUSY && left_for_swarm(self) > 0U) {
        return AISLE_BUSY;
    }
    aisle_leg *leg = &self->legs[self->leg];
    self->swarm_evals += self->swarm.pso.evals + self->swarm.polish_evals;
    leg->via_count = aisle_swarm_best(&self->swarm, leg->via);
    leg->use_swarm = leg->via_count > 0U;
    self->leg++;
    begin_swarm_leg(self);
    return AISLE_BUSY;
}
