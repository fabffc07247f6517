#include "plan/route_stages.h"

_Static_assert(AISLE_BARRIER_POINTS <= AISLE_SEED_POINTS_MAX, "a leg holds the way");

static bool is_papers(const aisle_route *self) {
    return self->way->kind == AISLE_WAY_GA_PAPER;
}

static void begin(aisle_route *self) {
    self->breed_limit = aisle_route_share(self);
    self->stage = AISLE_ROUTE_GA;
}

// ---- the paper's form, in place of all searches

void aisle_route_begin_ga_paper_leg(aisle_route *self) {
    const aisle_vec2 from = aisle_route_place(aisle_route_leg_start(self, self->leg));
    const aisle_vec2 to = aisle_route_place(&self->request.goals[self->leg]);
    aisle_leg *leg = aisle_route_take_leg(self);
    leg->count = 1;
    leg->mode = AISLE_SPACE_FREE_TURN;
    aisle_route_begin_zones(self);
    aisle_space_begin(&self->space, self->layout, self->vehicle, leg->mode);
    begin(self);
    if (aisle_barrier_start_paper(&self->barrier, &self->space, &self->request.options, from, to) != AISLE_OK) {
        self->points[self->point_count++] = from; // there already
        self->seed.phase = AISLE_SEED_DONE;
        self->stage = AISLE_ROUTE_SEED;
    }
}

void aisle_route_begin_ga_paper(aisle_route *self) {
    self->leg = 0;
    self->point_count = 0;
    self->piece_count = 0;
    aisle_route_begin_ga_paper_leg(self);
}

// ---- ours, on a seed

bool aisle_route_begin_ga(aisle_route *self) {
    const aisle_leg *leg = &self->legs[self->leg];
    if (self->request.options.planner != AISLE_OPTIONS_GA || leg->is_bred || self->is_unbred ||
        AISLE_ROUTE_POINTS - leg->first < AISLE_SEED_POINTS_MAX) {
        return false;
    }
    aisle_space_begin(&self->space, self->layout, self->vehicle, leg->mode);
    if (aisle_barrier_start(&self->barrier, &self->space, &self->objective, &self->request.options,
                            self->points + leg->first, leg->count) != AISLE_OK) {
        return false;
    }
    begin(self);
    return true;
}

aisle_status aisle_route_step_ga(aisle_route *self, uint32_t units) {
    aisle_leg *leg = &self->legs[self->leg];
    const uint32_t left = self->breed_limit > self->spent ? self->breed_limit - self->spent : 0U;
    const aisle_status st =
        left > 0U ? aisle_barrier_step(&self->barrier, units < left ? units : left, &self->spent) : AISLE_BUSY;
    if (st == AISLE_BUSY && self->spent < self->breed_limit) {
        return AISLE_BUSY;
    }
    const uint32_t count = aisle_barrier_best(&self->barrier, self->points + leg->first);
    self->swarm_evals += self->barrier.ga.evals;
    if (count == 0U && is_papers(self)) {
        return aisle_route_refuse_unproved(self);
    }
    self->is_cut = self->is_cut || st == AISLE_BUSY;
    if (count > 0U) { // else the budget was spent before the first: the seed stands
        leg->count = count;
        leg->is_bred = true;
        leg->tangent_radius = 0.0;
    }
    if (leg->is_bred && !is_papers(self)) {
        aisle_route_begin_taut(self, count);
    } else {
        self->point_count += leg->count;
        aisle_route_next_leg(self);
    }
    return AISLE_BUSY;
}
