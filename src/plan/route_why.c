#include "plan/route_stages.h"

void aisle_route_begin_why(aisle_route *self, uint32_t stride) {
    if (aisle_route_begin_one_way(self)) {
        return;
    }
    aisle_why_start(&self->why, &self->seed, &self->space, aisle_route_place(aisle_route_leg_start(self, self->leg)),
                    aisle_route_place(&self->request.goals[self->leg]), stride);
    self->stage = AISLE_ROUTE_WHY;
}

aisle_status aisle_route_refuse_unproved(aisle_route *self) {
    const aisle_goal_msg *goal = &self->request.goals[self->leg];
    (void)aisle_route_refuse_at(self, AISLE_STATUS_BUDGET, goal->id, (double)self->spent, aisle_route_place(goal));
    aisle_route_name_goal(self, goal);
    if (aisle_zones_any_directed(self->layout) || !aisle_layout_has_blocks(self->layout)) {
        return AISLE_OK;
    }
    self->legs[self->leg].attempt = AISLE_ROUTE_ATTEMPTS_CHEAP; // no seed is tried after the proof
    self->no_way = false;
    aisle_route_begin_why(self, 1U);
    return AISLE_BUSY;
}

static aisle_status refuse_no_path(aisle_route *self) {
    const aisle_goal_msg *goal = &self->request.goals[self->leg];
    (void)aisle_route_refuse_at(self, AISLE_STATUS_NO_PATH, goal->id, 0.0, aisle_route_place(goal));
    aisle_route_name_goal(self, goal);
    return AISLE_OK;
}

static aisle_status refuse_too_narrow(aisle_route *self) {
    const aisle_why *why = &self->why;
    (void)aisle_route_refuse_at(self, AISLE_STATUS_TOO_NARROW, why->gap.id[0], why->gap.width, why->gap.place);
    aisle_route_name_goal(self, &self->request.goals[self->leg]);
    for (uint32_t i = 0; i < why->gap.sides; i++) {
        aisle_route_tell(self, why->gap.side[i], why->gap.id[i], 0);
    }
    return AISLE_OK;
}

// There is no way, and that is proved: which obstacles would have to go?
static aisle_status begin_opening(aisle_route *self) {
    const aisle_why *why = &self->why;
    bool narrow = why->connected && why->gap.width < 2.0 * why->reach;
    (void)(narrow ? refuse_too_narrow(self) : refuse_no_path(self));
    uint32_t left = self->spent < self->budget ? self->budget - self->spent : 0U;
    aisle_opening_start(&self->opening, &self->seed, &self->space, why->start, why->goal, why->depth,
                        left < AISLE_OPENING_UNITS ? left : AISLE_OPENING_UNITS);
    self->stage = AISLE_ROUTE_OPENING;
    return AISLE_BUSY;
}

static aisle_vec2 centre_of(const aisle_convex *shape) {
    aisle_vec2 sum = {0.0, 0.0};
    for (uint32_t i = 0; i < shape->n; i++) {
        sum = aisle_vec2_add(sum, aisle_vec2_scale(shape->v[i], 1.0 / shape->n));
    }
    return sum;
}

void aisle_route_tell_zone(aisle_route *self, const aisle_zone *zone) {
    aisle_convex shape = aisle_layout_zone_shape(self->layout, zone);
    aisle_route_tell(self, centre_of(&shape), zone->id, AISLE_WAYPOINT_GOAL);
}

// Leaves out the gap's sides from n on, one after the other. Polygons alone can go.
static aisle_status try_side(aisle_route *self, uint32_t n) {
    const aisle_why *why = &self->why;
    for (self->side = n; self->side < why->gap.sides; self->side++) {
        if (why->gap.id[self->side] > 0) {
            const aisle_layout_without without = {.id = {why->gap.id[self->side]}, .count = 1};
            aisle_tangent_start(&self->tangent, self->layout, why->reach, why->start, why->goal);
            aisle_tangent_leave_out(&self->tangent, &without);
            self->stage = AISLE_ROUTE_SIDES;
            return AISLE_BUSY;
        }
    }
    self->stage = AISLE_ROUTE_END;
    return AISLE_OK;
}

// The grid sees a way where there is none, so it cannot tell what would open one: each side of the gap is tried exactly.
static aisle_status begin_sides(aisle_route *self) {
    (void)refuse_too_narrow(self);
    return try_side(self, 0);
}

aisle_status aisle_route_step_sides(aisle_route *self, uint32_t units) {
    aisle_status st = aisle_tangent_step(&self->tangent, units, &self->spent);
    if (st == AISLE_BUSY) {
        return AISLE_BUSY;
    }
    if (st != AISLE_OK) {
        return try_side(self, self->side + 1U);
    }
    for (uint32_t i = 0; i < aisle_layout_zone_count(self->layout); i++) {
        const aisle_zone *zone = aisle_layout_zone(self->layout, i);
        if (zone->id == self->why.gap.id[self->side]) {
            aisle_route_tell_zone(self, zone);
        }
    }
    self->stage = AISLE_ROUTE_END;
    return AISLE_OK;
}

static aisle_status end_why(aisle_route *self) {
    const aisle_why *why = &self->why;
    if (why->proved) {
        return begin_opening(self);
    }
    if (self->no_way) { // too little is wanting for the grid to see it
        bool narrow = why->connected && why->gap.width < 2.0 * why->reach;
        return narrow ? begin_sides(self) : refuse_no_path(self);
    }
    int16_t cause =
        aisle_vehicle_is_disc(self->vehicle) || !why->connected ? AISLE_STATUS_BUDGET : AISLE_STATUS_KINEMATIC;
    const aisle_goal_msg *goal = &self->request.goals[self->leg];
    if (!why->connected || why->gap.sides == 0U) { // by what can be seen on the grid, which is no proof
        (void)aisle_route_refuse_at(self, cause, goal->id, 0.0, why->goal);
    } else {
        (void)aisle_route_refuse_at(self, cause, why->gap.id[0], why->gap.width, why->gap.place);
    }
    aisle_route_name_goal(self, goal);
    return aisle_route_begin_spare(self) ? AISLE_BUSY : AISLE_OK;
}

aisle_status aisle_route_step_why(aisle_route *self, uint32_t units) {
    aisle_status st = aisle_why_step(&self->why, units, &self->spent);
    const aisle_why *why = &self->why;
    if (st == AISLE_PARTIAL && why->proved) {
        (void)refuse_no_path(self); // told if the budget ends before more is known
        self->stage = AISLE_ROUTE_WHY;
        return AISLE_BUSY;
    }
    if (st == AISLE_PARTIAL && self->legs[self->leg].attempt < AISLE_ROUTE_ATTEMPTS_CHEAP) {
        aisle_route_begin_seed(self, AISLE_ROUTE_ATTEMPTS_CHEAP);
        return AISLE_BUSY;
    }
    if (st == AISLE_BUSY || st == AISLE_PARTIAL) {
        return AISLE_BUSY;
    }
    if (st == AISLE_OK) {
        return end_why(self);
    }
    if (why->proved) { // that much is known
        self->stage = AISLE_ROUTE_END;
        return AISLE_OK;
    }
    return aisle_route_refuse(self, AISLE_STATUS_LIMIT, 0, (double)self->seed.search.open_capacity);
}

aisle_status aisle_route_step_opening(aisle_route *self, uint32_t units) {
    const aisle_opening *opening = &self->opening;
    aisle_status st = aisle_opening_step(&self->opening, units, &self->spent);
    if (st == AISLE_BUSY) {
        return AISLE_BUSY;
    }
    const uint32_t zones[AISLE_LAYOUT_WITHOUT_MAX] = {opening->first, opening->second};
    for (uint32_t i = 0; st == AISLE_OK && i < opening->without.count; i++) {
        aisle_route_tell_zone(self, aisle_layout_zone(self->layout, zones[i]));
    }
    self->stage = AISLE_ROUTE_END;
    return AISLE_OK;
}
