#include "plan/route_stages.h"

#include "base/check.h"

#include <math.h>

#define ATTEMPTS 5U // at a seed, see route.h

static uint32_t coarse_stride(const aisle_route *self) {
    const aisle_lattice *lattice = &aisle_layout_grid(self->layout)->lattice;
    double cells = floor(AISLE_ROUTE_STRIDE / lattice->res + 1e-6);
    double side = (double)(lattice->w < lattice->h ? lattice->w : lattice->h);
    return (uint32_t)aisle_clamp(cells, 1.0, side);
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

void aisle_route_end_attempts(aisle_route *self) {
    if (!self->no_way && aisle_route_begin_manoeuvre(self)) {
        return;
    }
    if (self->way_index == 0U) {
        aisle_route_begin_why(self, coarse_stride(self));
    } else {
        self->stage = AISLE_ROUTE_DROP;
    }
}

void aisle_route_begin_seed(aisle_route *self, uint32_t n) {
    aisle_leg *leg = &self->legs[self->leg];
    self->stage = AISLE_ROUTE_SEED;
    // Before the dear attempts the proof is asked whether there can be a way at all.
    uint32_t end = self->way_index == 0U && n < AISLE_ROUTE_ATTEMPTS_CHEAP ? AISLE_ROUTE_ATTEMPTS_CHEAP : ATTEMPTS;
    for (; n < end; n++) {
        uint32_t stride;
        leg->attempt = n;
        if (!attempt_of(self, n, &leg->mode, &stride)) {
            continue;
        }
        aisle_space_begin(&self->space, self->layout, self->vehicle, leg->mode);
        if (aisle_seed_start(&self->seed, &self->space, &self->objective, stride,
                             aisle_route_place(aisle_route_leg_start(self, self->leg)),
                             aisle_route_place(&self->request.goals[self->leg]),
                             self->points + leg->first) == AISLE_OK) {
            return;
        }
    }
    aisle_route_end_attempts(self);
}

// At a goal where the leg begins: can the body turn as it must?
static bool turns_there(aisle_route *self) {
    aisle_leg *leg = &self->legs[self->leg];
    self->points[leg->first] = aisle_route_place(&self->request.goals[self->leg]);
    leg->count = 1;
    return aisle_route_ends_free(self);
}

static void begin_leg(aisle_route *self) {
    aisle_leg *leg = &self->legs[self->leg];
    aisle_vec2 from = aisle_route_place(aisle_route_leg_start(self, self->leg));
    aisle_vec2 to = aisle_route_place(&self->request.goals[self->leg]);
    double beeline = aisle_vec2_distance(from, to);
    self->no_way = false;
    aisle_route_begin_zones(self);
    double bound = self->way_index == 0U ? beeline : leg->bound; // the first way's search has raised it
    uint32_t pieces = self->way_index == 0U && !self->is_wide ? 0U : leg->piece_count;
    *leg = (aisle_leg){.first = self->point_count,
                       .seed_value = -1.0,
                       .swarm_value = -1.0,
                       .bound = bound,
                       .piece_first = leg->piece_first,
                       .piece_count = pieces,
                       .searched = pieces > 0U,
                       .mode = pieces > 0U ? AISLE_SPACE_ALONG : AISLE_SPACE_FREE_TURN};
    self->guide[0].count = self->guide[1].count = 0;
    aisle_route_take_heading(self);
    if (pieces > 0U && self->way->kind == AISLE_WAY_CLEAR && aisle_layout_has_blocks(self->layout)) {
        aisle_route_begin_eased(self);
    } else if (pieces > 0U) { // no way for the body but this manoeuvre was found: it serves every objective
        self->stage = AISLE_ROUTE_SEED;
        self->seed.phase = AISLE_SEED_DONE;
    } else if (beeline < 1e-6 && !turns_there(self) && aisle_route_begin_manoeuvre(self)) {
        return;
    } else if (beeline < 1e-6) { // there already
        self->stage = AISLE_ROUTE_SEED;
        leg->count = 1;
        self->points[self->point_count++] = from;
        self->seed.phase = AISLE_SEED_DONE;
    } else if (AISLE_ROUTE_POINTS - self->point_count < AISLE_SEED_POINTS_MAX ||
               !aisle_layout_has_blocks(self->layout)) {
        aisle_route_begin_seed(self, 0);
    } else {
        aisle_route_begin_tangent(self);
    }
}

aisle_leg *aisle_route_take_leg(aisle_route *self) {
    aisle_leg *leg = &self->legs[self->leg];
    const aisle_vec2 from = aisle_route_place(aisle_route_leg_start(self, self->leg));
    const aisle_vec2 to = aisle_route_place(&self->request.goals[self->leg]);
    *leg = (aisle_leg){.first = self->point_count,
                       .seed_value = -1.0,
                       .swarm_value = -1.0,
                       .bound = aisle_vec2_distance(from, to),
                       .piece_first = self->piece_count};
    aisle_route_take_heading(self);
    return leg;
}

void aisle_route_begin_legs(aisle_route *self) {
    self->leg = 0;
    self->point_count = 0;
    begin_leg(self);
}

void aisle_route_next_leg(aisle_route *self) {
    self->leg++;
    if (self->leg < (uint32_t)self->request.num_goals && self->way->kind == AISLE_WAY_REPAIR) {
        aisle_route_begin_repair_leg(self);
    } else if (self->leg < (uint32_t)self->request.num_goals && self->way->kind == AISLE_WAY_SAMPLE) {
        aisle_route_begin_sample_leg(self);
    } else if (self->leg < (uint32_t)self->request.num_goals && self->way->kind == AISLE_WAY_GA_PAPER) {
        aisle_route_begin_ga_paper_leg(self);
    } else if (self->leg < (uint32_t)self->request.num_goals) {
        begin_leg(self);
    } else {
        aisle_route_begin_build(self);
    }
}

void aisle_route_begin_taut(aisle_route *self, uint32_t count) {
    double arc = self->vehicle->outer_radius + self->vehicle->margin;
    aisle_taut_start(&self->taut, &self->space, &self->objective, arc, self->points + self->legs[self->leg].first,
                     count, AISLE_SEED_POINTS_MAX);
    self->stage = AISLE_ROUTE_TAUT;
}

static aisle_status give_up(aisle_route *self, double needed) {
    return aisle_route_give_way_up(self, AISLE_STATUS_LIMIT, 0, needed,
                                   aisle_route_place(&self->request.goals[self->leg]));
}

aisle_status aisle_route_step_seed(aisle_route *self, uint32_t units) {
    aisle_leg *leg = &self->legs[self->leg];
    if (self->seed.phase == AISLE_SEED_DONE) { // start = goal, or the way is known
        aisle_route_next_leg(self);
        return AISLE_BUSY;
    }
    if (AISLE_ROUTE_POINTS - self->point_count < AISLE_SEED_POINTS_MAX) {
        return give_up(self, (double)self->point_count);
    }
    uint32_t before = self->seed.search.expanded;
    aisle_status st = aisle_seed_step(&self->seed, units, &self->spent);
    self->nodes += (int64_t)self->seed.search.expanded - (int64_t)before;
    if (st == AISLE_ERR_CAPACITY) {
        return give_up(self, (double)self->seed.search.open_capacity);
    }
    if (st == AISLE_PARTIAL) {
        bool cheap_ones_failed = leg->attempt + 1U == AISLE_ROUTE_ATTEMPTS_CHEAP;
        if (cheap_ones_failed && self->way_index > 0U && aisle_vehicle_is_disc(self->vehicle) &&
            aisle_layout_has_blocks(self->layout)) {
            aisle_route_begin_slit(self);
        } else if (cheap_ones_failed && self->way_index == 0U) {
            aisle_route_begin_why(self, coarse_stride(self)); // it goes on with the others if there can be a way
        } else {
            aisle_route_begin_seed(self, leg->attempt + 1U);
        }
    } else if (st == AISLE_OK) {
        aisle_route_begin_taut(self, self->seed.point_count);
    }
    return AISLE_BUSY;
}

aisle_status aisle_route_step_taut(aisle_route *self, uint32_t units) {
    if (aisle_taut_step(&self->taut, units, &self->spent) == AISLE_OK) {
        self->legs[self->leg].count = self->taut.count;
        if (aisle_route_begin_ga(self)) {
            return AISLE_BUSY;
        }
        self->point_count += self->taut.count;
        aisle_route_next_leg(self);
    }
    return AISLE_BUSY;
}
