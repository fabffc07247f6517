#include "plan/route_stages.h"

#define SHARE 4U // of the budget that these searches may take: a quarter, all legs together

static uint32_t left_for_tangent(const aisle_route *self) {
    uint32_t share = self->budget / SHARE;
    return self->tangent_units < share ? share - self->tangent_units : 0U;
}

static bool wants_shortest(const aisle_route *self) {
    return aisle_objective_is_length(&self->objective) && self->request.options.planner != AISLE_OPTIONS_PSO;
}

static void search(aisle_route *self, aisle_route_tangent_aim aim) {
    const aisle_vehicle *vehicle = self->vehicle;
    double radius = aim == AISLE_ROUTE_BOUND ? vehicle->inner_radius + vehicle->margin : self->space.reach;
    self->tangent_aim = aim;
    self->stage = AISLE_ROUTE_TANGENT;
    aisle_tangent_start(&self->tangent, self->layout, radius, aisle_route_place(aisle_route_leg_start(self, self->leg)),
                        aisle_route_place(&self->request.goals[self->leg]));
}

void aisle_route_begin_tangent(aisle_route *self) {
    aisle_leg *leg = &self->legs[self->leg];
    leg->mode = AISLE_SPACE_FREE_TURN;
    aisle_space_begin(&self->space, self->layout, self->vehicle, leg->mode);
    search(self, AISLE_ROUTE_BOUND);
}

// Takes the way found, pulled about circles of this radius, as the leg's. False: it is not free for such a disc.
static bool take_way(aisle_route *self, double radius) {
    aisle_leg *leg = &self->legs[self->leg];
    leg->count = aisle_tangent_points(&self->tangent, radius, self->points + leg->first, AISLE_SEED_POINTS_MAX);
    leg->tangent_radius = leg->count > 0U ? radius : 0.0;
    return leg->count > 0U;
}

static void keep_way(aisle_route *self) {
    self->point_count += self->legs[self->leg].count;
    aisle_route_next_leg(self);
}

// A long body may follow a way that is too tight for the disc in which it turns, its heading along the way: the way of
// the disc inside it, in arcs as narrow as the body can drive. False: none of those tried is free.
static bool take_tight_way(aisle_route *self) {
    static const double parts[] = {0.02, 0.1, 0.25, 0.5, 0.75}; // of what lies between the inner and the outer radius
    const aisle_vehicle *vehicle = self->vehicle;
    double between = vehicle->outer_radius - vehicle->inner_radius;
    aisle_compose_request request = aisle_route_build_request(self);
    for (uint32_t i = 0; i < sizeof parts / sizeof parts[0]; i++) {
        double radius = vehicle->inner_radius + self->space.keep + parts[i] * between;
        bool may_bend = vehicle->curvature_max <= 0.0 || radius * vehicle->curvature_max >= 1.0;
        if (may_bend && take_way(self, radius) &&
            aisle_compose_way_free(&self->compose, &request, self->leg, &self->spent)) {
            return true;
        }
    }
    self->legs[self->leg].tangent_radius = 0.0;
    return false;
}

static void after_bound(aisle_route *self, bool found) {
    self->legs[self->leg].bound = self->tangent.bound;
    if (!wants_shortest(self)) {
        aisle_route_begin_seed(self, 0);
        return;
    }
    bool is_disc = aisle_vehicle_is_disc(self->vehicle);
    if (found && (is_disc ? take_way(self, self->space.reach) : !self->is_wide && take_tight_way(self))) {
        keep_way(self);
        return;
    }
    search(self, AISLE_ROUTE_WAY);
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
    if (self->tangent_aim == AISLE_ROUTE_BOUND && st != AISLE_PARTIAL) {
        after_bound(self, st == AISLE_OK);
    } else if (st == AISLE_OK && take_way(self, self->space.reach)) {
        keep_way(self);
    } else {
        aisle_route_begin_seed(self, 0);
    }
    return AISLE_BUSY;
}
