#include "plan/verify_moving_parts.h"

#include "base/angle.h"
#include "base/check.h"
#include "base/rounding.h"
#include "wire/codec.h"

#include <string.h>

#define TRAVEL_MIN 1e-3   // m of every body point, below which no interval is halved
#define MOVERS_A_UNIT 16U // against an interval
#define BOXES_A_UNIT 64U  // against the box of all ground
#define LEASE_MAX 60.0    // s

// ---- ends

static aisle_status end(aisle_verify_moving *self, aisle_status answer) {
    self->stage = AISLE_MOVING_DONE;
    self->answer = answer;
    return answer;
}

static aisle_status refuse_unfit(aisle_verify_moving *self) {
    self->is_unfit = true;
    return end(self, AISLE_ERR_DATA);
}

static aisle_status finish(aisle_verify_moving *self) {
    uint64_t digest = self->digest;
    const aisle_moving_request *request = &self->request;
    if (!self->unbroken &&
        (!aisle_release_digest(request->bytes, request->size, &digest, NULL) || digest != self->digest)) {
        return refuse_unfit(self);
    }
    return end(self, AISLE_OK);
}

// ---- the ground that can be covered, the movers that can come near it

static double fastest(const aisle_verify_moving *self) {
    return aisle_max(aisle_max(self->request.vehicle->v_max, self->request.vehicle->v_reverse_max), self->request.v) *
           (1.0 + VERIFY_TOLERANCE);
}

// More than the sweep can take in time and length.
static void set_bounds(aisle_verify_moving *self) {
    const aisle_vehicle *vehicle = self->request.vehicle;
    const double driven = vehicle->reaction_time + self->request.lease, v = fastest(self);
    const double omega = aisle_max(vehicle->omega_max, self->request.omega) * (1.0 + VERIFY_TOLERANCE);
    self->window = v * driven + 0.5 * v * v / vehicle->d_max;
    self->last =
        driven + aisle_max(v / vehicle->d_max, omega / vehicle->alpha_max) + AISLE_DRIVE_LAG + self->request.late;
    self->box = (aisle_aabb){{DBL_MAX, DBL_MAX}, {-DBL_MAX, -DBL_MAX}};
}

static bool is_path_of_the_bytes(const aisle_moving_request *request) {
    const uint8_t *count = request->bytes + AISLE_PATH_AT_NUM_WAYPOINTS;
    return (int32_t)(((uint32_t)count[0] << 8) | count[1]) == (int32_t)request->path->num_waypoints;
}

static aisle_status step_start(aisle_verify_moving *self) {
    const aisle_moving_request *request = &self->request;
    self->unbroken = true;
    if (!aisle_release_digest(request->bytes, request->size, &self->digest, NULL) || !is_path_of_the_bytes(request)) {
        return refuse_unfit(self);
    }
    if (request->movers->count == 0U || request->path->num_waypoints == 1) {
        return finish(self);
    }
    set_bounds(self);
    self->piece = request->at_piece;
    self->stage = AISLE_MOVING_WINDOW;
    return AISLE_BUSY;
}

static void cover(aisle_aabb *box, aisle_vec2 p, double by) {
    box->lo = aisle_vec2_of(aisle_min(box->lo.x, p.x - by), aisle_min(box->lo.y, p.y - by));
    box->hi = aisle_vec2_of(aisle_max(box->hi.x, p.x + by), aisle_max(box->hi.y, p.y + by));
}

// The whole of the piece counts.
static aisle_status step_window(aisle_verify_moving *self) {
    const bool is_first = self->piece == self->request.at_piece;
    aisle_verify_piece piece;
    if (!aisle_moving_piece(self, self->piece, &piece)) {
        return refuse_unfit(self);
    }
    const double by = self->lever + self->request.vehicle->radius + piece.phi * piece.length / 4.0;
    cover(&self->box, aisle_verify_piece_origin(&piece, 0.0), by);
    cover(&self->box, aisle_verify_piece_origin(&piece, 1.0), by);
    self->window -= is_first ? piece.length * (1.0 - self->request.at_u) : piece.length;
    self->last += 0.002 + VERIFY_TOLERANCE * (1.0 + self->last); // what times may be late by, see verify.h
    self->piece++;
    if (!(self->window > 0.0) || self->piece >= (uint32_t)self->request.path->num_waypoints) {
        self->stage = AISLE_MOVING_NEAR;
    }
    return AISLE_BUSY;
}

static double box_gap(aisle_aabb box, aisle_vec2 p) {
    const double x = aisle_max(aisle_max(box.lo.x - p.x, p.x - box.hi.x), 0.0);
    const double y = aisle_max(aisle_max(box.lo.y - p.y, p.y - box.hi.y), 0.0);
    return aisle_vec2_length(aisle_vec2_of(x, y));
}

// The instant, rounded up.
static int64_t at_us(const aisle_verify_moving *self, double after) {
    return self->request.now_us + (int64_t)(after * 1e6) + 1;
}

static aisle_status begin_pass(aisle_verify_moving *self) {
    if (!aisle_moving_motion_begin(self)) {
        return refuse_unfit(self);
    }
    self->behind = 0.0;
    self->stretch = (aisle_moving_stretch){.from = 0.0, .to = 0.0};
    self->swept = 0.0;
    self->stage = AISLE_MOVING_FOLLOW;
    return AISLE_BUSY;
}

static aisle_status step_near(aisle_verify_moving *self) {
    const aisle_movers *movers = self->request.movers;
    const double keep = aisle_max(self->request.vehicle->margin, AISLE_MOVING_CLEARANCE_MAX) + 1e-3;
    for (uint32_t i = 0; i < BOXES_A_UNIT && self->scanned < movers->count; i++) {
        const aisle_mover *mover = &movers->mover[self->scanned];
        if (box_gap(self->box, mover->at) < aisle_mover_reach(mover, at_us(self, self->last)) + keep) {
            self->near[self->near_count++] = (uint16_t)self->scanned;
        }
        self->scanned++;
    }
    if (self->scanned < movers->count) {
        return AISLE_BUSY;
    }
    return self->near_count == 0U ? finish(self) : begin_pass(self);
}

// ---- stretches

// *braked: when the motion that is at q last began to brake, or is there if it has not.
static double theta_at(const aisle_moving_stretch *stretch, double q, double *braked) {
    const aisle_moving_phase *phase = &stretch->phase;
    double square = phase->v0 * phase->v0 + 2.0 * phase->a * (q - phase->from), s = q, brake = 0.0;
    if (stretch->down > 0.0) {
        square *= stretch->down / (phase->a + stretch->down); // > 0: see add_places_of_rest()
        s = q - 0.5 * aisle_max(square, 0.0) / stretch->down;
        brake = sqrt(aisle_max(square, 0.0)) / stretch->down;
    }
    const double v = sqrt(aisle_max(square, 0.0)), way = aisle_max(s - phase->from, 0.0);
    const double time = phase->v0 + v > 0.0 ? 2.0 * way / (phase->v0 + v) : 0.0;
    *braked = phase->begins + time + phase->late;
    return *braked + brake;
}

// Where the sweep is when a run begins.
static aisle_status begin_run(aisle_verify_moving *self, const aisle_moving_phase *phase) {
    aisle_moving_motion *motion = &self->motion;
    motion->leaves_rest = false;
    self->piece = motion->piece;
    self->origin = motion->run - (motion->done - motion->extra);
    self->swept = phase->from;
    self->behind = motion->way - (motion->turns ? 0.0 : phase->to);
    if (!aisle_moving_piece(self, self->piece, &self->curve)) {
        return refuse_unfit(self);
    }
    self->turn = self->curve.turn;
    return AISLE_BUSY;
}

static void add_phase(aisle_verify_moving *self, const aisle_moving_phase *phase) {
    self->stretch = (aisle_moving_stretch){.from = phase->from, .to = phase->to, .phase = *phase, .down = 0.0};
}

// None where the path brakes as hard as can be: all of these motions rest at one place then, at one time.
static void add_places_of_rest(aisle_verify_moving *self, const aisle_moving_phase *phase) {
    const double down = self->motion.speeds.down;
    if (phase->a + down > 1e-9 * down) {
        self->stretch = (aisle_moving_stretch){.from = phase->from + 0.5 * phase->v0 * phase->v0 / down,
                                               .to = phase->to + 0.5 * phase->v1 * phase->v1 / down,
                                               .phase = *phase,
                                               .down = down};
    }
}

static aisle_status next_pass(aisle_verify_moving *self) {
    if (self->is_second_pass || !self->has_second_pass) {
        return finish(self);
    }
    self->is_second_pass = true;
    return begin_pass(self);
}

static aisle_status step_motion(aisle_verify_moving *self) {
    const bool follows = self->stage == AISLE_MOVING_FOLLOW;
    const double follow = self->request.vehicle->reaction_time;
    aisle_moving_phase phase;
    switch (aisle_moving_motion_next(self, follows ? follow : follow + self->request.lease, &phase)) {
    case AISLE_MOVING_PIECE:
        return AISLE_BUSY;
    case AISLE_MOVING_STRANGE:
        return refuse_unfit(self);
    case AISLE_MOVING_END:
        return next_pass(self);
    case AISLE_MOVING_DUE:
        if (!follows) {
            return next_pass(self);
        }
        self->stage = AISLE_MOVING_BRAKE;
        return AISLE_BUSY;
    case AISLE_MOVING_PHASE:
        break;
    }
    if (follows) {
        add_phase(self, &phase);
    } else {
        add_places_of_rest(self, &phase);
    }
    return self->motion.leaves_rest ? begin_run(self, &phase) : AISLE_BUSY;
}

static aisle_status step_brake(aisle_verify_moving *self) {
    const aisle_moving_motion *motion = &self->motion;
    self->stage = AISLE_MOVING_REST;
    if (motion->square > 0.0) {
        const double down = motion->speeds.down;
        const aisle_moving_phase phase = {.from = motion->run,
                                          .to = motion->run + 0.5 * motion->square / down,
                                          .v0 = sqrt(motion->square),
                                          .a = -down,
                                          .begins = motion->clock,
                                          .late = motion->late};
        add_phase(self, &phase);
    }
    return AISLE_BUSY;
}

// ---- intervals

// The next part of the stretch that lies on one piece; false: there is none, or the piece is behind.
static bool take_part(aisle_verify_moving *self) {
    const double size = aisle_moving_size(&self->curve), to = aisle_min(self->stretch.to, self->origin + size);
    if (!(to > self->swept)) {
        return false;
    }
    self->lo = aisle_clamp((self->swept - self->origin) / size, 0.0, 1.0);
    self->hi[0] = aisle_clamp((to - self->origin) / size, self->lo, 1.0);
    self->count[0] = self->near_count;
    self->depth = 1U;
    self->next = self->kept = 0U;
    self->portion = to;
    return true;
}

static bool run_goes_on(const aisle_verify_moving *self) {
    const aisle_path_msg *path = self->request.path;
    return !self->curve.on_spot && self->piece + 1U < (uint32_t)path->num_waypoints &&
           (double)path->waypoints[self->piece].v > VERIFY_REST;
}

// A part of the stretch, or the next piece of the run; beyond its end no motion goes.
static aisle_status step_stretch(aisle_verify_moving *self) {
    const double size = aisle_moving_size(&self->curve);
    if (take_part(self)) {
        return AISLE_BUSY;
    }
    if (self->stretch.to > self->origin + size && run_goes_on(self)) {
        self->origin += size;
        self->piece++;
        if (!aisle_moving_piece(self, self->piece, &self->curve) || self->curve.on_spot) {
            return refuse_unfit(self);
        }
        self->turn = self->curve.turn;
        return AISLE_BUSY;
    }
    self->stretch.to = self->stretch.from; // done with
    return AISLE_BUSY;
}

static double run_at(const aisle_verify_moving *self, double u) {
    return self->origin + u * aisle_moving_size(&self->curve);
}

// No motion is at a place of [lo, hi] later than that, s from now. Who is late begins to brake late, but no later than the last
// one does; this grows from hi to lo where the rest of it grows from lo to hi.
static double later_at(const aisle_verify_moving *self, double lo, double hi) {
    const aisle_moving_request *request = &self->request;
    double braked;
    (void)theta_at(&self->stretch, run_at(self, lo), &braked);
    const double left = request->lease + request->vehicle->reaction_time - braked;
    const double theta = theta_at(&self->stretch, run_at(self, hi), &braked);
    return theta + AISLE_DRIVE_LAG + aisle_clamp(left, 0.0, request->late);
}

static bool take_interval(aisle_verify_moving *self) {
    const double hi = self->hi[self->depth - 1U], last = later_at(self, self->lo, hi);
    aisle_moving_sweep_over(self, self->lo, hi, &self->sweep);
    self->sweep.at_us = at_us(self, last);
    self->intervals++;
    return last <= self->last; // else this is no path of verify.h
}

static void put_in_front(aisle_verify_moving *self, uint32_t i) {
    const uint16_t mover = self->near[i];
    self->near[i] = self->near[self->kept];
    self->near[self->kept++] = mover;
}

static aisle_status refuse(aisle_verify_moving *self, const aisle_mover *blocker) {
    const double hi = self->hi[self->depth - 1U];
    const aisle_vec2 at = self->sweep.origin_b;
    self->blocker = blocker->id;
    self->blocker_source = blocker->source;
    self->blocked_at = (aisle_pose2){at.x, at.y, aisle_angle_wrap(self->curve.theta + hi * self->turn)};
    self->blocked_way = self->behind + (self->curve.on_spot ? 0.0 : run_at(self, hi));
    self->blocked_us = self->sweep.at_us;
    return end(self, AISLE_ERR_DATA);
}

// One mover against the interval in hand. AISLE_OK: proved off; AISLE_BUSY: not so far.
static aisle_status look(aisle_verify_moving *self, const aisle_mover *mover) {
    const double reach = aisle_mover_reach(mover, self->sweep.at_us),
                 margin = aisle_max(self->request.vehicle->margin, 0.0);
    const double wanted = aisle_max(margin, self->least - AISLE_MOVING_CLEARANCE_OFF);
    const double gap = aisle_moving_gap(self, mover->at, reach + wanted) - reach;
    if (gap < self->least) {
        self->least = aisle_min(self->least, aisle_moving_end_gap(self, mover->at) - reach);
    }
    const bool is_fine = self->sweep.travel < TRAVEL_MIN; // the end of it is a place and time of the sweep
    if (gap >= wanted || (gap >= margin && is_fine)) {
        self->clearance = aisle_min(self->clearance, gap);
        return AISLE_OK;
    }
    return is_fine || self->depth == AISLE_VERIFY_DEPTH ? AISLE_ERR_DATA : AISLE_BUSY;
}

// All movers were looked at: on to the next interval, or into halves of this one.
static void advance(aisle_verify_moving *self) {
    const double hi = self->hi[self->depth - 1U];
    if (self->kept > 0U) {
        self->hi[self->depth] = 0.5 * (self->lo + hi);
        self->count[self->depth++] = self->kept;
    } else {
        self->lo = hi;
        self->depth--;
    }
    self->next = self->kept = 0U;
    if (self->depth > 0U) {
        return;
    }
    if (fabs(self->turn - self->curve.turn_other) <= 1.0) { // the two ways differ by 2 pi
        self->swept = self->portion;
        self->turn = self->curve.turn;
    } else {
        self->turn = self->curve.turn_other; // the same part the other way round
    }
}

static aisle_status step_interval(aisle_verify_moving *self) {
    const uint32_t count = self->count[self->depth - 1U];
    if (self->next == 0U && !take_interval(self)) {
        return refuse_unfit(self);
    }
    const uint32_t stop = count - self->next > MOVERS_A_UNIT ? self->next + MOVERS_A_UNIT : count;
    for (; self->next < stop; self->next++) {
        const aisle_mover *mover = &self->request.movers->mover[self->near[self->next]];
        const aisle_status status = look(self, mover);
        if (status == AISLE_ERR_DATA) {
            return refuse(self, mover);
        }
        if (status == AISLE_BUSY) {
            put_in_front(self, self->next);
        }
    }
    if (self->next == count) {
        advance(self);
    }
    return AISLE_BUSY;
}

// ---- steps

static aisle_status step_sweep(aisle_verify_moving *self) {
    if (self->depth > 0U) {
        return step_interval(self);
    }
    if (self->stretch.to > self->stretch.from) {
        return step_stretch(self);
    }
    return self->stage == AISLE_MOVING_BRAKE ? step_brake(self) : step_motion(self);
}

static aisle_status step_once(aisle_verify_moving *self) {
    switch (self->stage) {
    case AISLE_MOVING_START:
        return step_start(self);
    case AISLE_MOVING_WINDOW:
        return step_window(self);
    case AISLE_MOVING_NEAR:
        return step_near(self);
    case AISLE_MOVING_FOLLOW:
    case AISLE_MOVING_BRAKE:
    case AISLE_MOVING_REST:
        return step_sweep(self);
    case AISLE_MOVING_DONE:
        break;
    }
    return self->answer;
}

void aisle_verify_moving_start(aisle_verify_moving *self, const aisle_moving_request *request) {
    const aisle_vehicle *vehicle = request->vehicle;
    const uint32_t n = (uint32_t)request->path->num_waypoints;
    AISLE_ASSERT(vehicle != NULL && request->movers != NULL && request->bytes != NULL);
    AISLE_ASSERT(n >= 1U && n <= AISLE_PATH_MAX_WAYPOINTS && request->at_u >= 0.0 && request->at_u <= 1.0);
    AISLE_ASSERT(n == 1U ? request->at_piece == 0U : request->at_piece >= 1U && request->at_piece < n);
    AISLE_ASSERT(request->v >= 0.0 && request->v <= 1e3 && request->omega >= 0.0 && request->omega <= 1e3);
    AISLE_ASSERT(request->lease >= 0.0 && request->lease <= LEASE_MAX);
    memset(self, 0, sizeof *self);
    self->request = *request;
    self->movers_revision = request->movers->revision;
    self->clearance = self->least = AISLE_MOVING_CLEARANCE_MAX;
    for (uint32_t i = 0; i < vehicle->n; i++) {
        self->lever = aisle_max(self->lever, aisle_vec2_length(vehicle->footprint[i]));
    }
}

aisle_status aisle_verify_moving_step(aisle_verify_moving *self, uint32_t units, uint32_t *spent,
                                      aisle_moving_stamp *stamp) {
    const aisle_moving_request *request = &self->request;
    aisle_status status = AISLE_BUSY;
    *stamp = (aisle_moving_stamp){0, 0, 0, 0.0F};
    self->unbroken = false;
    if (self->stage == AISLE_MOVING_DONE) {
        status = self->answer;
    } else if (self->movers_revision != request->movers->revision) {
        status = refuse_unfit(self);
    }
    for (uint32_t left = units; status == AISLE_BUSY && left > 0; left--) {
        status = step_once(self);
        *spent += 1;
    }
    if (status == AISLE_OK) {
        const int64_t until = request->now_us + (int64_t)(request->lease * 1e6);
        const bool told = self->clearance < AISLE_MOVING_CLEARANCE_MAX;
        *stamp = (aisle_moving_stamp){.digest = self->digest,
                                      .size = (uint32_t)request->size,
                                      .until_us = until,
                                      .clearance = told ? aisle_float_below(self->clearance) : 0.0F};
    }
    return status;
}
