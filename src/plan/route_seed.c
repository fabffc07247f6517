#include "plan/route_stages.h"

#include "base/check.h"

#include <math.h>

#define ATTEMPTS_CHEAP 2U // at a seed, see route.h
#define ATTEMPTS 5U

// ---- CHECK

static bool options_are_known(const aisle_options_msg *options) {
    bool planner = options->planner == AISLE_OPTIONS_AUTO || options->planner == AISLE_OPTIONS_PSO ||
                   options->planner == AISLE_OPTIONS_ASTAR;
    bool interpolation =
        options->interpolation == AISLE_OPTIONS_SPLINE || options->interpolation == AISLE_OPTIONS_LINEAR;
    return planner && interpolation && options->risk_weight >= 0.0F && options->work_units >= 0 &&
           options->num_samples >= 0;
}

// Clearances and speeds of the paper's path are measured as of any other; what it minimises is its own.
static bool take_objective(aisle_route *self) {
    aisle_options_msg options = self->request.options;
    options.objective = aisle_route_is_paper(&options) ? AISLE_OPTIONS_SHORTEST : options.objective;
    return aisle_objective_of(&options, self->vehicle, &self->objective);
}

static bool in_bounds(const aisle_route *self, aisle_vec2 p) {
    aisle_aabb bounds = aisle_layout_bounds(self->layout);
    return p.x >= bounds.lo.x && p.x <= bounds.hi.x && p.y >= bounds.lo.y && p.y <= bounds.hi.y;
}

// Gap of the body at a stop: of the footprint, or of the disc it holds where the heading is free.
static double stop_gap(const aisle_route *self, const aisle_goal_msg *stop, int32_t *id) {
    double cap = self->vehicle->margin + 1.0;
    if (!aisle_goal_heading_is_free(stop)) {
        return aisle_space_gap(&self->space, (aisle_pose2){stop->x, stop->y, stop->theta}, cap, id);
    }
    aisle_vec2 p = aisle_route_place(stop);
    aisle_convex disc = {&p, 1U, self->vehicle->inner_radius};
    return aisle_layout_gap(self->layout, &disc, cap, id);
}

static aisle_status check_stop(aisle_route *self, const aisle_goal_msg *stop, bool is_start) {
    aisle_vec2 p = aisle_route_place(stop);
    if (!in_bounds(self, p)) {
        int16_t outside = is_start ? AISLE_STATUS_POSE_OUTSIDE : AISLE_STATUS_GOAL_OUTSIDE;
        return aisle_route_refuse_at(self, outside, stop->id, 0.0, p);
    }
    int32_t id = 0;
    double gap = stop_gap(self, stop, &id);
    self->spent += 1U;
    if (gap < self->vehicle->margin + AISLE_SPACE_SLACK) {
        int16_t occupied = is_start ? AISLE_STATUS_START_OCCUPIED : AISLE_STATUS_GOAL_OCCUPIED;
        return aisle_route_refuse_at(self, occupied, id, self->vehicle->margin + AISLE_SPACE_SLACK - gap, p);
    }
    return AISLE_BUSY;
}

static void begin_leg(aisle_route *self, uint32_t attempt);

aisle_status aisle_route_check(aisle_route *self) {
    const aisle_request *request = &self->request;
    if (!options_are_known(&request->options) || !take_objective(self)) {
        return aisle_route_refuse(self, AISLE_STATUS_MALFORMED, request->options.planner,
                                  (double)request->options.objective);
    }
    aisle_space_begin(&self->space, self->layout, self->vehicle, AISLE_SPACE_FREE_TURN);
    aisle_status st = check_stop(self, &request->start, true);
    for (int16_t i = 0; i < request->num_goals && st == AISLE_BUSY; i++) {
        st = check_stop(self, &request->goals[i], false);
    }
    if (st != AISLE_BUSY) {
        return st;
    }
    if (aisle_route_is_paper(&request->options)) {
        return aisle_route_begin_paper(self);
    }
    begin_leg(self, 0);
    return AISLE_BUSY;
}

// ---- SEED, TAUT

static uint32_t coarse_stride(const aisle_route *self) {
    const aisle_lattice *lattice = &aisle_layout_grid(self->layout)->lattice;
    double cells = floor(AISLE_ROUTE_STRIDE / lattice->res + 1e-6);
    double side = (double)(lattice->w < lattice->h ? lattice->w : lattice->h);
    return (uint32_t)aisle_clamp(cells, 1.0, side);
}

// Why there is no seed for this leg.
static void begin_why(aisle_route *self) {
    aisle_why_start(&self->why, &self->seed, &self->space, aisle_route_place(aisle_route_leg_start(self, self->leg)),
                    aisle_route_place(&self->request.goals[self->leg]), coarse_stride(self));
    self->stage = AISLE_ROUTE_WHY;
}

// The n-th attempt at a seed. False: it is not for this vehicle, or would only repeat another one.
static bool attempt_of(const aisle_route *self, uint32_t n, aisle_space_mode *mode, uint32_t *stride) {
    static const struct {
        aisle_space_mode mode;
        bool coarse, roomiest, for_discs, for_bodies;
    } attempts[ATTEMPTS] = {{AISLE_SPACE_FREE_TURN, true, false, true, true},
                            {AISLE_SPACE_FREE_TURN, false, false, true, true},
                            {AISLE_SPACE_FREE_TURN, false, true, true, false},
                            {AISLE_SPACE_ALONG, true, false, false, true},
                            {AISLE_SPACE_ALONG, false, false, false, true}};
    bool fine_first = n == 0U && aisle_objective_is_length(&self->objective);
    *mode = attempts[n].mode;
    *stride = attempts[n].coarse ? coarse_stride(self) : 1U;
    if (attempts[n].coarse && (*stride == 1U || fine_first)) {
        return false;
    }
    *stride = attempts[n].roomiest ? AISLE_SEED_ROOMIEST : *stride;
    return aisle_vehicle_is_disc(self->vehicle) ? attempts[n].for_discs : attempts[n].for_bodies;
}

// Starts the seed of the leg under way with the first attempt from n on that finds its ends; none does: WHY.
static void begin_leg(aisle_route *self, uint32_t n) {
    aisle_leg *leg = &self->legs[self->leg];
    *leg = (aisle_leg){.first = self->point_count, .attempt = n, .seed_value = -1.0, .swarm_value = -1.0};
    aisle_vec2 from = aisle_route_place(aisle_route_leg_start(self, self->leg));
    aisle_vec2 to = aisle_route_place(&self->request.goals[self->leg]);
    self->stage = AISLE_ROUTE_SEED;
    if (aisle_vec2_distance(from, to) < 1e-6) {
        leg->count = 1;
        self->points[self->point_count++] = from;
        self->seed.phase = AISLE_SEED_DONE;
        return;
    }
    // Before the dear attempts the proof is asked whether there can be a way at all.
    uint32_t end = n < ATTEMPTS_CHEAP ? ATTEMPTS_CHEAP : ATTEMPTS;
    for (; n < end; n++) {
        uint32_t stride;
        leg->attempt = n;
        if (!attempt_of(self, n, &leg->mode, &stride)) {
            continue;
        }
        aisle_space_begin(&self->space, self->layout, self->vehicle, leg->mode);
        if (aisle_seed_start(&self->seed, &self->space, &self->objective, stride, from, to,
                             self->points + leg->first) == AISLE_OK) {
            return;
        }
    }
    begin_why(self);
}

static void next_leg(aisle_route *self) {
    self->leg++;
    if (self->leg < (uint32_t)self->request.num_goals) {
        begin_leg(self, 0);
    } else {
        aisle_route_begin_build(self, &self->first);
    }
}

aisle_status aisle_route_step_seed(aisle_route *self, uint32_t units) {
    aisle_leg *leg = &self->legs[self->leg];
    if (self->seed.phase == AISLE_SEED_DONE) { // start = goal
        next_leg(self);
        return AISLE_BUSY;
    }
    if (AISLE_ROUTE_POINTS - self->point_count < AISLE_SEED_POINTS_MAX) {
        return aisle_route_refuse(self, AISLE_STATUS_LIMIT, 0, (double)self->point_count);
    }
    uint32_t before = self->seed.search.expanded;
    aisle_status st = aisle_seed_step(&self->seed, units, &self->spent);
    self->nodes += (int64_t)self->seed.search.expanded - (int64_t)before;
    if (st == AISLE_ERR_CAPACITY) {
        return aisle_route_refuse(self, AISLE_STATUS_LIMIT, 0, (double)self->seed.search.open_capacity);
    }
    if (st == AISLE_PARTIAL) {
        if (leg->attempt + 1U == ATTEMPTS_CHEAP) {
            begin_why(self); // it goes on with the other attempts if there can be a way
        } else {
            begin_leg(self, leg->attempt + 1U);
        }
    } else if (st == AISLE_OK) {
        double arc = self->vehicle->outer_radius + self->vehicle->margin;
        aisle_taut_start(&self->taut, &self->space, &self->objective, arc, self->points + leg->first,
                         self->seed.point_count, AISLE_SEED_POINTS_MAX);
        self->stage = AISLE_ROUTE_TAUT;
    }
    return AISLE_BUSY;
}

aisle_status aisle_route_step_taut(aisle_route *self, uint32_t units) {
    if (aisle_taut_step(&self->taut, units, &self->spent) == AISLE_OK) {
        self->legs[self->leg].count = self->taut.count;
        self->point_count += self->taut.count;
        next_leg(self);
    }
    return AISLE_BUSY;
}

// ---- WHY

aisle_status aisle_route_step_why(aisle_route *self, uint32_t units) {
    aisle_status st = aisle_why_step(&self->why, units, &self->spent);
    const aisle_why *why = &self->why;
    if (st == AISLE_PARTIAL && !why->proved && self->legs[self->leg].attempt < ATTEMPTS_CHEAP) {
        begin_leg(self, ATTEMPTS_CHEAP);
        return AISLE_BUSY;
    }
    if (st == AISLE_BUSY || st == AISLE_PARTIAL) {
        return AISLE_BUSY;
    }
    if (st != AISLE_OK) {
        return aisle_route_refuse(self, AISLE_STATUS_LIMIT, 0, (double)self->seed.search.open_capacity);
    }
    if (!why->connected) {
        int16_t cause = why->proved ? AISLE_STATUS_NO_PATH : AISLE_STATUS_BUDGET;
        return aisle_route_refuse_at(self, cause, self->request.goals[self->leg].id, 0.0, why->goal);
    }
    if (why->proved) {
        return aisle_route_refuse_at(self, AISLE_STATUS_TOO_NARROW, why->id, why->width, why->place);
    }
    int16_t cause = aisle_vehicle_is_disc(self->vehicle) ? AISLE_STATUS_BUDGET : AISLE_STATUS_KINEMATIC;
    return aisle_route_refuse_at(self, cause, why->id, why->width, why->place);
}
