#include "plan/route_stages.h"

#define SHARE 2U // of the budget that ordering may take: half

void aisle_route_begin_order(aisle_route *self) {
    const aisle_request *request = &self->request;
    if (!aisle_route_is_to_order(self)) {
        aisle_route_begin_ways(self);
        return;
    }
    const uint32_t kept = (uint32_t)(uint16_t)request->kept, count = (uint32_t)(uint16_t)request->num_goals - kept;
    aisle_vec2 places[AISLE_GOAL_LIST_MAX_GOALS];
    for (uint32_t i = 0; i < count; i++) {
        places[i] = aisle_route_place(&request->goals[kept + i]);
    }
    aisle_tour_start(&self->tour, &self->tangent, self->layout, self->vehicle->inner_radius + self->vehicle->margin,
                     aisle_route_place(aisle_route_leg_start(self, kept)), places, count);
    self->stage = AISLE_ROUTE_ORDER;
}

// The order is one of those behind the goals kept.
static void put_in_order(aisle_route *self, const uint8_t *order) {
    for (int16_t i = self->request.kept; i < self->request.num_goals; i++) {
        self->request.goals[i] = self->asked[self->request.kept + order[i - self->request.kept]];
    }
}

// The goal that no way leads to first, so that its leg is the one of which is asked why.
static void put_first(aisle_route *self, uint32_t goal) {
    uint8_t order[AISLE_GOAL_LIST_MAX_GOALS] = {(uint8_t)goal};
    uint32_t count = 1;
    for (uint32_t i = 0; i < self->tour.count; i++) {
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
