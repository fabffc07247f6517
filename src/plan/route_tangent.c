#include "plan/route_stages.h"

#define SHARE 4U // of the budget that these searches may take: a quarter, all legs together

static uint32_t left_for_tangent(const aisle_route *self) {
    uint32_t share = self->budget / SHARE;
    return self->tangent_units < share ? share - self->tangent_units : 0U;
}

// Radii that the search is made for, as parts of what lies between the discs inside and around the body: the bound's
// first, the body's own turning disc last. In between for long bodies: a way that is too tight for them at one place is
// another one a little wider.
static const double searched[] = {0.0, 0.1, 0.4, 1.0};
#define SEARCHES (sizeof searched / sizeof searched[0])
#define BOUND 0U
#define TURNING (SEARCHES - 1U)
#define GUIDE 0.02 // of the same: about which circles a way is pulled that only leads a search

static double radius_at(const aisle_route *self, double part) {
    const aisle_vehicle *vehicle = self->vehicle;
    double room = self->legs[self->leg].is_slit ? self->space.keep : self->room;
    return vehicle->inner_radius + room + part * (vehicle->outer_radius - vehicle->inner_radius);
}

static void search(aisle_route *self, uint32_t n) {
    const aisle_vehicle *vehicle = self->vehicle;
    bool for_bound = n == BOUND && self->way_index == 0U;
    double radius = for_bound ? vehicle->inner_radius + vehicle->margin : radius_at(self, searched[n]);
    self->tangent_search = n;
    self->stage = AISLE_ROUTE_TANGENT;
    aisle_tangent_start(&self->tangent, self->layout, radius, aisle_route_place(aisle_route_leg_start(self, self->leg)),
                        aisle_route_place(&self->request.goals[self->leg]));
}

void aisle_route_begin_tangent(aisle_route *self) {
    aisle_leg *leg = &self->legs[self->leg];
    leg->mode = AISLE_SPACE_FREE_TURN;
    aisle_space_begin(&self->space, self->layout, self->vehicle, leg->mode);
    if (self->way->kind == AISLE_WAY_GRID && self->way_index > 0U) { // the bound is known
        aisle_route_begin_seed(self, 0);
    } else {
        search(self, BOUND);
    }
}

void aisle_route_begin_slit(aisle_route *self) {
    self->legs[self->leg].is_slit = true;
    search(self, TURNING);
}

// Takes the way found, pulled about circles of this radius, as the leg's. False: it is not free for such a disc.
static bool take_way(aisle_route *self, double radius) {
    aisle_leg *leg = &self->legs[self->leg];
    leg->count = aisle_tangent_points(&self->tangent, radius, self->points + leg->first, AISLE_SEED_POINTS_MAX);
    leg->tangent_radius = leg->count > 0U ? radius : 0.0;
    return leg->count > 0U;
}

// A long body may follow a way that is too tight for the disc in which it turns, its heading along the way, in arcs as
// narrow as it can drive. False: none of those tried is free.
static bool take_tight_way(aisle_route *self) {
    static const double tried[] = {0.02, 0.12, 0.25, 0.42, 0.7}; // as `searched`
    const aisle_vehicle *vehicle = self->vehicle;
    aisle_compose_request request = aisle_route_build_request(self);
    for (uint32_t i = 0; i < sizeof tried / sizeof tried[0]; i++) {
        double radius = radius_at(self, tried[i]);
        bool may_bend = vehicle->curvature_max <= 0.0 || radius * vehicle->curvature_max >= 1.0;
        if (may_bend && tried[i] > searched[self->tangent_search] && take_way(self, radius) &&
            aisle_compose_way_free(&self->compose, &request, self->leg, self->room - 0.5 * AISLE_SPACE_SLACK,
                                   &self->spent) &&
            aisle_route_way_obeys(self)) {
            return true;
        }
    }
    self->legs[self->leg].tangent_radius = 0.0;
    return false;
}

// The turning disc's way is one for every body that turns on the spot.
static bool take_wide_way(aisle_route *self) {
    double radius = radius_at(self, 1.0);
    return take_way(self, radius) &&
           radius * self->vehicle->curvature_max >= (self->vehicle->curvature_max > 0.0 ? 1.0 : 0.0) &&
           aisle_route_way_obeys(self);
}

// Takes the way found if it is one for the body, else it may lead a search for one.
static bool take(aisle_route *self) {
    bool wide = self->tangent_search == TURNING || aisle_vehicle_is_disc(self->vehicle);
    double radius = radius_at(self, wide ? 1.0 : aisle_max(GUIDE, searched[self->tangent_search]));
    bool may_drive = wide ? take_wide_way(self) : !self->is_wide && take_tight_way(self);
    if (may_drive && aisle_route_ends_free(self)) {
        return true;
    }
    if (self->legs[self->leg].is_slit) {
        return may_drive;
    }
    if (take_way(self, radius)) {
        aisle_route_keep_guide(self, radius, self->tangent.radius);
    }
    self->legs[self->leg].tangent_radius = 0.0;
    return false;
}

// None of the ways is one for the body as it is. Where zones forbid one, the grid knows of ways round; the search for a
// manoeuvre would be led along the forbidden one.
static void end_searches(aisle_route *self) {
    if (self->opposed_zones > 0U || !aisle_route_begin_manoeuvre(self)) {
        aisle_route_begin_seed(self, 0);
    }
}

void aisle_route_begin_eased(aisle_route *self) {
    aisle_leg *leg = &self->legs[self->leg];
    leg->is_eased = true;
    self->stage = AISLE_ROUTE_TANGENT;
    aisle_space_begin(&self->space, self->layout, self->vehicle, leg->mode);
    aisle_tangent_start(&self->tangent, self->layout, self->vehicle->inner_radius + self->space.keep,
                        aisle_route_place(aisle_route_leg_start(self, self->leg)),
                        aisle_route_place(&self->request.goals[self->leg]));
}

// What was found leads the search for a manoeuvre that keeps clear.
static void lead(aisle_route *self, bool found) {
    aisle_leg *leg = &self->legs[self->leg];
    if (found && take_way(self, self->tangent.radius)) {
        aisle_route_keep_guide(self, self->tangent.radius, self->tangent.radius);
    }
    leg->count = 0;
    leg->tangent_radius = 0.0;
    aisle_route_ease_manoeuvre(self);
}

static void go_on(aisle_route *self, bool found) {
    aisle_leg *leg = &self->legs[self->leg];
    if (self->way->kind == AISLE_WAY_GRID && !leg->is_slit) {
        if (found && take_way(self, radius_at(self, GUIDE))) {
            aisle_route_keep_guide(self, leg->tangent_radius, self->tangent.radius);
            leg->tangent_radius = 0.0;
        }
        aisle_route_begin_seed(self, 0);
    } else if (found && take(self)) {
        leg->is_clear = self->way->kind == AISLE_WAY_CLEAR && !leg->is_slit;
        if (leg->is_slit) { // only a seed: to be pulled by the way's own density
            leg->tangent_radius = 0.0;
            aisle_route_begin_taut(self, leg->count);
            return;
        }
        if (aisle_route_begin_ga(self)) {
            return;
        }
        self->point_count += leg->count;
        aisle_route_next_leg(self);
    } else if (leg->is_slit) {
        self->stage = AISLE_ROUTE_DROP;
    } else if (self->tangent_search < TURNING) {
        bool straight_on = aisle_vehicle_is_disc(self->vehicle) || self->is_wide;
        search(self, straight_on ? TURNING : self->tangent_search + 1U);
    } else {
        end_searches(self);
    }
}

aisle_status aisle_route_step_tangent(aisle_route *self, uint32_t units) {
    uint32_t left = left_for_tangent(self);
    uint32_t before = self->spent;
    uint32_t expanded = self->tangent.expansions;
    aisle_status st = aisle_tangent_step(&self->tangent, units < left ? units : left, &self->spent);
    self->tangent_units += self->spent - before;
    self->nodes += (int64_t)self->tangent.expansions - (int64_t)expanded;
    if (st == AISLE_BUSY && left_for_tangent(self) > 0U) {
        return AISLE_BUSY;
    }
    if (self->legs[self->leg].is_eased) {
        lead(self, st == AISLE_OK);
        return AISLE_BUSY;
    }
    bool is_bound = self->tangent_search == BOUND && self->way_index == 0U;
    if (is_bound && st != AISLE_PARTIAL) {
        self->legs[self->leg].bound = self->tangent.bound;
    }
    if (st == AISLE_PARTIAL && is_bound) {
        self->no_way = true;
        aisle_route_end_attempts(self);
    } else if (st == AISLE_PARTIAL && !self->legs[self->leg].is_slit) { // nor is there one for anything wider
        end_searches(self);
    } else {
        go_on(self, st == AISLE_OK);
    }
    return AISLE_BUSY;
}
