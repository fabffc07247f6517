#include "plan/route_stages.h"

#define SHARE 2U // of the budget that ordering may take: half

void aisle_route_begin_order(aisle_route *self) {
    const aisle_request *request = &self->request;
    if (request->ordering != AISLE_GOAL_LIST_ANY_ORDER || request->num_goals < 2) {
        aisle_route_begin_ways(self);
        return;
    }
    aisle_vec2 places[AISLE_GOAL_LIST_MAX_GOALS];
    for (int16_t i = 0; i < request->num_goals; i++) {
        places[i] = aisle_route_place(&request->goals[i]);
    }
    aisle_tour_start(&self->tour, &self->tangent, self->layout, self->vehicle->inner_radius + self->vehicle->margin,
                     aisle_route_place(&request->start), places, (uint32_t)request->num_goals);
    self->stage = AISLE_ROUTE_ORDER;
}

static void put_in_order(aisle_route *self, const uint8_t *order) {
    for (int16_t i = 0; i < self->request.num_goals; i++) {
        self->request.goals[i] = self->asked[order[i]];
    }
}

// The goal that no way leads to first, so that its leg is the one of which is asked why.
static void put_first(aisle_route *self, uint32_t goal) {
    uint8_t order[AISLE_GOAL_LIST_MAX_GOALS] = {(uint8_t)goal};
    uint32_t count = 1;
    for (uint32_t i = 0; i < (uint32_t)self->request.num_goals; i++) {
        if (i != goal) {
            order[count++] = (uint8_t)i;
        }
    }
    put_in_order(self, order);
}

aisle_status aisle_route_step_order(aisle_route *self, uint32_t units) {
    const uint32_t share = self->budget / SHARE;
    const uint32_t left = self->spent < share ? share - self->spent : 0U;
    aisle_tour *tour = &self->tour;
    const uint32_t nodes = tour->nodes;
    aisle_status st = aisle_tour_step(tour, units < left ? units : left, &self->spent);
    self->nodes += (int64_t)tour->nodes - (int64_t)nodes;
    if (st == AISLE_BUSY && self->spent < share) {
        return AISLE_BUSY;
    }
    if (st == AISLE_PARTIAL) {
        put_first(self, tour->unreachable);
    } else {
        self->is_cut = st == AISLE_BUSY || tour->is_rough;
        put_in_order(self, tour->order);
    }
    aisle_route_begin_ways(self);
    return AISLE_BUSY;
}
