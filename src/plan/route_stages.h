// route_stages.h - what the files of route share with each other and with nobody else. Level 4.
//
// route.c: memory, budget, the order of stages. route_seed.c: CHECK, SEED, TAUT, WHY. route_proof.c: BUILD, VERIFY,
// SWARM. route_paper.c: PAPER.
// Steps spend about `units`; AISLE_BUSY: go on, AISLE_PARTIAL: the first proof is ready, AISLE_OK: the request has
// ended.
#ifndef AISLE_PLAN_ROUTE_STAGES_H
#define AISLE_PLAN_ROUTE_STAGES_H

#include "plan/route.h"

// Where a stop is; where a leg begins.
static inline aisle_vec2 aisle_route_place(const aisle_goal_msg *goal) {
    return aisle_vec2_of(goal->x, goal->y);
}

static inline const aisle_goal_msg *aisle_route_leg_start(const aisle_route *self, uint32_t leg) {
    return leg == 0U ? &self->request.start : &self->request.goals[leg - 1U];
}

// End the request with a cause, with or without its place.
static inline aisle_status aisle_route_refuse(aisle_route *self, int16_t cause, int32_t id, double value) {
    self->cause = (aisle_refusal){cause, id, (float)value};
    self->stage = AISLE_ROUTE_END;
    return AISLE_OK;
}

static inline aisle_status aisle_route_refuse_at(aisle_route *self, int16_t cause, int32_t id, double value,
                                                 aisle_vec2 place) {
    self->place = place;
    self->has_place = true;
    return aisle_route_refuse(self, cause, id, value);
}

// route_seed.c
aisle_status aisle_route_check(aisle_route *self);
aisle_status aisle_route_step_seed(aisle_route *self, uint32_t units);
aisle_status aisle_route_step_taut(aisle_route *self, uint32_t units);
aisle_status aisle_route_step_why(aisle_route *self, uint32_t units);

// route_paper.c: the paper's own swarm in place of everything before BUILD.
bool aisle_route_is_paper(const aisle_options_msg *options);
aisle_status aisle_route_begin_paper(aisle_route *self);
aisle_status aisle_route_step_paper(aisle_route *self, uint32_t units);

// route_proof.c
void aisle_route_begin_build(aisle_route *self, aisle_proof *trial);
aisle_status aisle_route_step_build(aisle_route *self, uint32_t units);
aisle_status aisle_route_step_verify(aisle_route *self, uint32_t units);
aisle_status aisle_route_step_swarm(aisle_route *self, uint32_t units);
#endif
