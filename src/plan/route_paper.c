#include "plan/route_stages.h"

#include "base/check.h"

_Static_assert(AISLE_PAPER_VIAS <= AISLE_SWARM_VIAS, "a leg holds the paper's way");

// Starts the swarm on the leg under way or a later one; goes on to build when there is none left.
static aisle_status next_leg(aisle_route *self) {
    for (; self->leg < (uint32_t)self->request.num_goals; self->leg++) {
        aisle_leg *leg = &self->legs[self->leg];
        aisle_vec2 from = aisle_route_place(aisle_route_leg_start(self, self->leg));
        aisle_vec2 to = aisle_route_place(&self->request.goals[self->leg]);
        *leg = (aisle_leg){.first = self->point_count,
                           .count = 1,
                           .seed_value = -1.0,
                           .swarm_value = -1.0,
                           .bound = aisle_vec2_distance(from, to)};
        self->points[self->point_count++] = from;
        aisle_status st = aisle_paper_swarm_start(&self->paper, &self->space, &self->request.options, from, to);
        if (st == AISLE_OK) {
            self->points[self->point_count++] = to; // only its ends: the way is the swarm's
            leg->count = 2;
            return AISLE_BUSY;
        }
        if (st == AISLE_ERR_CAPACITY) {
            return aisle_route_refuse(self, AISLE_STATUS_LIMIT, 0, (double)AISLE_PAPER_OBSTACLES_MAX);
        }
    }
    aisle_route_begin_build(self);
    return AISLE_BUSY;
}

void aisle_route_begin_paper(aisle_route *self) {
    self->leg = 0;
    self->point_count = 0;
    self->stage = AISLE_ROUTE_PAPER;
    (void)next_leg(self);
}

aisle_status aisle_route_step_paper(aisle_route *self, uint32_t units) {
    if (aisle_paper_swarm_step(&self->paper, units, &self->spent) == AISLE_BUSY) {
        return AISLE_BUSY;
    }
    aisle_leg *leg = &self->legs[self->leg];
    self->swarm_evals += self->paper.pso.evals;
    leg->via_count = aisle_paper_swarm_best(&self->paper, leg->via);
    if (leg->via_count == 0U) { // all iterations spent: no proof that there is none
        return aisle_route_refuse(self, AISLE_STATUS_BUDGET, 0, (double)self->spent);
    }
    leg->use_swarm = true;
    self->leg++;
    return next_leg(self);
}
