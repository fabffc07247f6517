#include "base/angle.h"
#include "base/check.h"
#include "plan/route_stages.h"

#include <math.h>
#include <string.h>

#define AHEAD 1.0        // m, that a vehicle in motion goes straight on before it bends
#define AHEAD_LEAST 0.25 // m
#define TINY 1e-3        // m
#define SPEED_LEAST 0.01 // m/s
#define BEND_MAX 1.3     // rad, by which a way may leave its heading without a stop

// m, kept off movers beside the margin: what a person can do before a vehicle at creep speed rests, with ease and at the
// least.
static const double safety[] = {2.4, 1.9, 1.6};
#define SAFETIES ((uint32_t)(sizeof safety / sizeof safety[0]))

void aisle_route_go_round(aisle_route *self, const aisle_movers *movers, int64_t from_us, bool in_motion) {
    self->request.options.planner = AISLE_OPTIONS_PSO_LOCAL;
    self->movers = movers;
    self->movers_us = from_us;
    self->in_motion = in_motion;
    self->budget = self->budget < AISLE_ROUTE_ROUND_UNITS ? self->budget : AISLE_ROUTE_ROUND_UNITS;
    self->stage = AISLE_ROUTE_CHECK; // what is remembered knows no movers
}

// The place from which the leg's way may bend; a vehicle in motion goes straight on for a bit.
static aisle_vec2 bends_from(aisle_route *self) {
    const aisle_vec2 from = aisle_route_place(aisle_route_leg_start(self, self->leg));
    aisle_vec2 unit;
    if (self->leg > 0U || !self->in_motion) {
        return from;
    }
    aisle_sincos(self->request.start.theta, &unit.y, &unit.x);
    for (double ahead = AHEAD; ahead >= AHEAD_LEAST; ahead *= 0.5) {
        const aisle_vec2 to = aisle_vec2_add(from, aisle_vec2_scale(unit, ahead));
        const bool is_before_goal = ahead + TINY < self->legs[self->leg].bound;
        if (is_before_goal && aisle_space_sweep_free(&self->space, from, to, &self->spent)) {
            return to;
        }
    }
    return from;
}

static void begin_search(aisle_route *self) {
    aisle_leg *leg = &self->legs[self->leg];
    const aisle_options_msg *options = &self->request.options;
    leg->mode = leg->attempt < SAFETIES ? AISLE_SPACE_FREE_TURN : AISLE_SPACE_ALONG;
    aisle_space_begin(&self->space, self->layout, self->vehicle, leg->mode);
    self->bend = bends_from(self);
    const aisle_local_request request = {.space = &self->space,
                                         .movers = self->movers,
                                         .from_us = self->movers_us,
                                         .from = self->bend,
                                         .heading = fabs(leg->heading) <= AISLE_ANGLE_MAX ? leg->heading : 0.0,
                                         .goal = aisle_route_place(&self->request.goals[self->leg]),
                                         .speed = aisle_max(0.5 * self->vehicle->v_max, SPEED_LEAST),
                                         .range = aisle_min((double)options->step, AISLE_LOCAL_RANGE_MAX),
                                         .safety = safety[leg->attempt % SAFETIES],
                                         .seed = (uint64_t)(uint32_t)options->seed};
    const aisle_status st = aisle_local_start(&self->local, &request);
    AISLE_ASSERT(st == AISLE_OK); // its ends are apart, all else was checked
}

static void begin_leg(aisle_route *self) {
    aisle_leg *leg = aisle_route_take_leg(self);
    self->stage = AISLE_ROUTE_LOCAL;
    self->local_is_there = false;
    if (leg->bound < 1e-6) {
        leg->count = 1;
        self->points[self->point_count++] = aisle_route_place(aisle_route_leg_start(self, self->leg));
        self->local_is_there = true;
    } else {
        begin_search(self);
    }
}

void aisle_route_begin_local(aisle_route *self) {
    self->leg = 0;
    self->point_count = 0;
    begin_leg(self);
}

// The polyline found becomes the leg's, what lies straight ahead in front of it.
static void take_points(aisle_route *self) {
    aisle_leg *leg = &self->legs[self->leg];
    const aisle_local *local = &self->local;
    const aisle_vec2 from = aisle_route_place(aisle_route_leg_start(self, self->leg));
    aisle_vec2 *points = self->points + leg->first;
    uint32_t n = 0;
    if (aisle_vec2_distance(from, self->bend) > 0.0 && local->count > 1U) {
        const aisle_vec2 out = aisle_vec2_sub(local->points[1], local->points[0]);
        const double bend = aisle_angle_difference(self->request.start.theta, aisle_atan2(out.y, out.x));
        points[n++] = from;
        if (fabs(bend) > BEND_MAX) { // it has to stop and turn all the same
            self->bend = from;
        }
    }
    for (uint32_t i = n > 0U && aisle_vec2_distance(from, self->bend) <= 0.0 ? 1U : 0U; i < local->count; i++) {
        points[n++] = local->points[i];
    }
    leg->count = n;
    self->point_count += n;
}

// With less room for movers, then with the body's heading along its way; a car's turns are not looked at.
static bool try_again(aisle_route *self) {
    aisle_leg *leg = &self->legs[self->leg];
    const uint32_t all = aisle_vehicle_is_disc(self->vehicle) ? SAFETIES : 2U * SAFETIES;
    leg->attempt += self->movers != NULL ? 1U : SAFETIES;
    if (leg->attempt >= all) {
        return false;
    }
    begin_search(self);
    return true;
}

static aisle_status no_way(aisle_route *self) {
    const aisle_local *local = &self->local;
    if (try_again(self)) {
        return AISLE_BUSY;
    }
    return aisle_route_refuse_at(self, local->blocker != 0 ? AISLE_STATUS_BLOCKED_BY : AISLE_STATUS_BUDGET,
                                 local->blocker, (double)self->spent, self->bend);
}

aisle_status aisle_route_step_local(aisle_route *self, uint32_t units) {
    aisle_local *local = &self->local;
    if (!self->local_is_there) {
        const aisle_status st = aisle_local_step(local, units, &self->spent);
        if (st == AISLE_BUSY) {
            return AISLE_BUSY;
        }
        if (st != AISLE_OK || AISLE_ROUTE_POINTS - self->point_count < local->count + 1U) {
            return no_way(self);
        }
        take_points(self);
    }
    self->leg++;
    if (self->leg < (uint32_t)self->request.num_goals) {
        begin_leg(self);
    } else {
        aisle_route_begin_build(self);
    }
    return AISLE_BUSY;
}
