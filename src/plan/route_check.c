#include "plan/route_stages.h"

static bool options_are_known(const aisle_options_msg *options, bool is_sampling) {
    bool planner = options->planner == AISLE_OPTIONS_AUTO || options->planner == AISLE_OPTIONS_PSO ||
                   options->planner == AISLE_OPTIONS_ASTAR || options->planner == AISLE_OPTIONS_PSO_LOCAL ||
                   options->planner == AISLE_OPTIONS_GA || is_sampling;
    bool interpolation =
        options->interpolation == AISLE_OPTIONS_SPLINE || options->interpolation == AISLE_OPTIONS_LINEAR;
    bool is_paper = options->objective == AISLE_OPTIONS_PAPER &&
                    (options->planner == AISLE_OPTIONS_PSO || options->planner == AISLE_OPTIONS_GA || is_sampling);
    bool objective =
        is_paper || (options->objective >= AISLE_OPTIONS_SAFEST && options->objective <= AISLE_OPTIONS_LEAST_ENERGY);
    return planner && objective && interpolation && options->risk_weight >= 0.0F && options->work_units >= 0 &&
           options->num_samples >= 0 && options->step >= 0.0F;
}

static bool in_bounds(const aisle_route *self, aisle_vec2 p) {
    aisle_aabb bounds = aisle_layout_bounds(self->layout);
    return p.x >= bounds.lo.x && p.x <= bounds.hi.x && p.y >= bounds.lo.y && p.y <= bounds.hi.y;
}

// Gap of the body at a stop: of the footprint, or of the disc it holds where the heading is free.
static double stop_gap(const aisle_route *self, const aisle_goal_msg *stop, int32_t *id) {
    double cap = self->vehicle->margin + 1.0;
    if (!aisle_goal_heading_is_free(stop)) {
        return aisle_space_gap(&self->space, (aisle_pose2){stop->x, stop->y, stop->theta}, cap, id);
    }
    aisle_vec2 p = aisle_route_place(stop);
    aisle_convex disc = {&p, 1U, self->vehicle->inner_radius};
    return aisle_layout_gap(self->layout, &disc, cap, id);
}

static void name_stop(aisle_route *self, const aisle_goal_msg *stop) {
    if (stop != &self->request.start) {
        aisle_route_name_goal(self, stop);
    }
}

// AISLE_BUSY: free; AISLE_PARTIAL: occupied, NEAREST goes on; AISLE_OK: refused.
static aisle_status check_stop(aisle_route *self, const aisle_goal_msg *stop) {
    const bool is_start = stop == &self->request.start;
    aisle_vec2 p = aisle_route_place(stop);
    if (!in_bounds(self, p)) {
        int16_t outside = is_start ? AISLE_STATUS_POSE_OUTSIDE : AISLE_STATUS_GOAL_OUTSIDE;
        (void)aisle_route_refuse_at(self, outside, stop->id, 0.0, p);
        name_stop(self, stop);
        return AISLE_OK;
    }
    int32_t id = 0;
    double gap = stop_gap(self, stop, &id);
    self->spent += 1U;
    if (gap < self->vehicle->margin + AISLE_SPACE_SLACK) {
        int16_t occupied = is_start ? AISLE_STATUS_START_OCCUPIED : AISLE_STATUS_GOAL_OCCUPIED;
        (void)aisle_route_refuse_at(self, occupied, id, 0.0, p);
        name_stop(self, stop);
        aisle_nearest_start(&self->nearest, &self->space, (aisle_pose2){stop->x, stop->y, stop->theta},
                            aisle_goal_heading_is_free(stop));
        self->stage = AISLE_ROUTE_NEAREST;
        return AISLE_PARTIAL;
    }
    return AISLE_BUSY;
}

aisle_status aisle_route_check(aisle_route *self) {
    const aisle_request *request = &self->request;
    if (!options_are_known(&request->options, aisle_route_is_sampling(self))) {
        return aisle_route_refuse(self, AISLE_STATUS_MALFORMED, request->options.planner,
                                  (double)request->options.objective);
    }
    aisle_space_begin(&self->space, self->layout, self->vehicle, AISLE_SPACE_FREE_TURN);
    aisle_status st = check_stop(self, &request->start);
    for (int16_t i = 0; i < request->num_goals && st == AISLE_BUSY; i++) {
        st = check_stop(self, &request->goals[i]);
    }
    if (st == AISLE_BUSY) {
        aisle_route_begin_order(self);
    }
    return st == AISLE_PARTIAL ? AISLE_BUSY : st;
}

// The distance as told: never below the true one.
static double rounded_up(double distance) {
    float told = (float)distance;
    return (double)told < distance ? distance * (1.0 + 1.2e-7) : distance;
}

aisle_status aisle_route_step_nearest(aisle_route *self, uint32_t units) {
    aisle_status st = aisle_nearest_step(&self->nearest, units, &self->spent);
    if (st == AISLE_BUSY) {
        return AISLE_BUSY;
    }
    if (st == AISLE_OK) {
        self->cause.value = (float)rounded_up(self->nearest.distance);
        aisle_route_tell(self, self->nearest.place, 0, 0);
    }
    self->stage = AISLE_ROUTE_END;
    return AISLE_OK;
}
