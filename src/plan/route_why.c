#include "plan/route_stages.h"

void aisle_route_begin_why(aisle_route *self, uint32_t stride) {
    aisle_why_start(&self->why, &self->seed, &self->space, aisle_route_place(aisle_route_leg_start(self, self->leg)),
                    aisle_route_place(&self->request.goals[self->leg]), stride);
    self->stage = AISLE_ROUTE_WHY;
}

static aisle_status refuse_too_narrow(aisle_route *self) {
    const aisle_why *why = &self->why;
    (void)aisle_route_refuse_at(self, AISLE_STATUS_TOO_NARROW, why->id[0], why->width, why->place);
    for (uint32_t i = 0; i < why->sides; i++) {
        aisle_route_tell(self, why->side[i], why->id[i], 0);
    }
    return AISLE_OK;
}

aisle_status aisle_route_step_why(aisle_route *self, uint32_t units) {
    aisle_status st = aisle_why_step(&self->why, units, &self->spent);
    const aisle_why *why = &self->why;
    if (st == AISLE_PARTIAL && !why->proved && self->legs[self->leg].attempt < AISLE_ROUTE_ATTEMPTS_CHEAP) {
        aisle_route_begin_seed(self, AISLE_ROUTE_ATTEMPTS_CHEAP);
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
        return refuse_too_narrow(self);
    }
    int16_t cause = aisle_vehicle_is_disc(self->vehicle) ? AISLE_STATUS_BUDGET : AISLE_STATUS_KINEMATIC;
    return aisle_route_refuse_at(self, cause, why->id[0], why->width, why->place);
}
