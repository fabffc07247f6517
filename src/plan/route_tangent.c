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

// Takes the way found, for the turning disc, as the leg's. False: it is not free with the search's slack.
static bool take_way(aisle_route *self) {
    aisle_leg *leg = &self->legs[self->leg];
    uint32_t count =
        aisle_tangent_points(&self->tangent, self->space.reach, self->points + leg->first, AISLE_SEED_POINTS_MAX);
    if (count == 0U) {
        return false;
    }
    leg->count = count;
    leg->is_tangent = true;
    self->point_count += count;
    return true;
}

static void after_bound(aisle_route *self, bool found) {
    self->legs[self->leg].bound = self->tangent.bound;
    if (!wants_shortest(self)) {
        aisle_route_begin_seed(self, 0);
        return;
    }
    if (found && aisle_vehicle_is_disc(self->vehicle) && take_way(self)) {
        aisle_route_next_leg(self);
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
    } else if (st == AISLE_OK && take_way(self)) {
        aisle_route_next_leg(self);
    } else {
        aisle_route_begin_seed(self, 0);
    }
    return AISLE_BUSY;
}
