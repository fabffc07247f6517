#include "plan/pace_predict.h"

#include "base/check.h"

#include <string.h>

#define SPACING 0.08 // m, of the band's places at least
#define PLACES 100.0 // of a band, about
#define STILL 1e-3   // m/s, a slower mover does not move

void aisle_pace_predict_carve(aisle_pace_predict *self, aisle_arena *arena) {
    void *w = aisle_arena_take(arena, AISLE_PATH_MAX_WAYPOINTS, sizeof(aisle_waypoint_msg));
    void *dwell = aisle_arena_take(arena, AISLE_PATH_MAX_WAYPOINTS, sizeof(float));
    if (self != NULL) {
        self->w = (aisle_waypoint_msg *)w;
        self->dwell = (float *)dwell;
    }
}

// ---- the way

static bool any_moves(const aisle_movers *movers) {
    for (uint32_t i = 0; i < movers->count; i++) {
        if (aisle_vec2_length(movers->mover[i].velocity) > STILL) {
            return true;
        }
    }
    return false;
}

static void take_way(aisle_pace_predict *self) {
    const aisle_pace_predict_request *request = &self->request;
    self->n = aisle_motion_cut(request->vehicle, request->w, request->n, request->dwell, request->at, self->w,
                               AISLE_PATH_MAX_WAYPOINTS);
    if (self->n == 0) {
        self->outcome = AISLE_ERR_CAPACITY;
        return;
    }
    aisle_motion_cut_dwell(request->dwell, request->n, request->at, self->n, self->dwell);
    self->until = self->n - (request->n - request->until); // the last ones are the same
    const bool rests = self->n == 1 || (self->w[0].flags & (AISLE_WAYPOINT_STOP | AISLE_WAYPOINT_TURN_IN_PLACE)) != 0 ||
                       self->dwell[0] > 0.0F;
    self->v = rests || request->v < AISLE_PACE_RESTING ? 0.0 : aisle_min(request->v, AISLE_VEHICLE_SPEED_MAX);
    const aisle_profile_start start = {self->v, NULL};
    aisle_profile_path way = {
        .w = self->w, .dwell = self->dwell, .n = self->n, .capacity = AISLE_PATH_MAX_WAYPOINTS, .mark = self->until};
    aisle_profile_sum sum;
    const aisle_status st = aisle_profile_fill_ramps(request->vehicle, request->layout, &way, &start, &sum);
    self->until = way.mark;
    self->n = way.n;
    if (st != AISLE_OK && st != AISLE_PARTIAL) {
        self->outcome = st;
    }
}

void aisle_pace_predict_start(aisle_pace_predict *self, const aisle_pace_predict_request *request) {
    AISLE_ASSERT(request->n >= 1 && aisle_place_exists(request->n, request->at) && request->v >= 0.0);
    AISLE_ASSERT(request->lease > 0.0 && request->until < request->n && request->until >= request->at.piece);
    self->request = *request;
    self->seconds = self->waited = self->rested = self->stood = self->gained = 0.0;
    self->slowest = (double)INFINITY;
    self->steps = self->level = 0;
    self->outcome = AISLE_BUSY;
    self->movers_move = any_moves(request->movers);
    take_way(self);
    self->at = (aisle_place){self->n > 1 ? 1U : 0U, 0.0};
    if (self->outcome == AISLE_BUSY && self->until == 0) { // it is there
        self->outcome = AISLE_OK;
    }
}

// ---- levels

static aisle_band_motion motion_of(const aisle_pace_predict *self, double cap) {
    const aisle_vehicle *vehicle = self->request.vehicle;
    const double v = aisle_max(self->v, aisle_min(cap, vehicle->v_max));
    const double reach = v * (self->request.lease + vehicle->reaction_time) + 0.5 * v * v / vehicle->d_max;
    return (aisle_band_motion){.vehicle = vehicle,
                               .w = self->w,
                               .n = self->n,
                               .dwell = self->dwell,
                               .at = self->at,
                               .v = self->v,
                               .cap = cap,
                               .rested = self->rested,
                               .lease = self->request.lease,
                               .late = self->request.late,
                               .spacing = aisle_max(SPACING, reach / PLACES)};
}

static bool is_clear(const aisle_pace_predict *self, uint32_t *spent) {
    const aisle_pace_predict_request *request = &self->request;
    const int64_t then = request->now_us + (int64_t)(self->seconds * 1e6);
    const double growth = request->vehicle->margin + AISLE_PACE_SPARE;
    for (uint32_t i = 0; i < request->movers->count; i++) {
        const aisle_mover *mover = &request->movers->mover[i];
        const double reach = mover->radius + AISLE_MOVERS_SIGMAS * mover->sigma + mover->v_bound * AISLE_PREDICT_AGE;
        const aisle_band_disc disc = {aisle_mover_predicted(mover, then, NULL), reach, mover->v_bound};
        uint32_t where;
        if (!aisle_band_is_clear(&self->band, request->vehicle, &disc, growth, AISLE_PACE_LAG, &where, spent)) {
            return false;
        }
    }
    return true;
}

static bool is_safe(aisle_pace_predict *self, uint32_t level, uint32_t *spent) {
    const aisle_band_motion motion = motion_of(self, aisle_pace_cap(self->request.vehicle, level));
    aisle_band_make(&self->band, &motion);
    *spent += self->band.n / 8U + self->request.movers->count / 8U;
    return !self->band.overflow && is_clear(self, spent);
}

// The fastest level that is safe now, faster than the last one by one at most; from rest none is if the slowest is not.
static uint32_t choose(aisle_pace_predict *self, uint32_t *spent) {
    if (!(self->v > 0.0) && !is_safe(self, AISLE_PACE_STOP - 1U, spent)) {
        return AISLE_PACE_STOP;
    }
    for (uint32_t level = self->level > 0 ? self->level - 1U : 0U; level < AISLE_PACE_STOP;) {
        if (is_safe(self, level, spent)) {
            return level;
        }
        do {
            level++;
        } while (level < AISLE_PACE_STOP && aisle_pace_cap(self->request.vehicle, level) >= self->band.peak);
    }
    return AISLE_PACE_STOP;
}

// ---- driving on

typedef struct leap { // of one step
    double time;      // s it is to take; less if it gets there
    double made;      // m or rad
    bool arrives;
    bool rests; // as the way says
} leap;

static bool is_there(const aisle_pace_predict *self, const aisle_band_walk *walk) {
    return walk->piece >= self->until;
}

// The run has ended within the step: the next one, or rest before it. False: the step is over.
static bool leave_run(aisle_pace_predict *self, aisle_band_walk *walk, leap *it) {
    const uint32_t piece = walk->piece;
    const double ended = walk->t;
    self->v = 0.0;
    self->rested = 0.0;
    if (ended >= it->time) { // of a wait
        self->at = (aisle_place){piece, aisle_clamp(1.0 - (ended - it->time) / walk->leg.time, 0.0, 1.0)};
        return false;
    }
    if (is_there(self, walk)) {
        it->time = ended;
        it->arrives = true;
        return false;
    }
    self->at = (aisle_place){piece, 1.0};
    if (!aisle_band_walk_run(walk)) {
        return false;
    }
    self->rested = it->time - ended;
    return walk->t < it->time;
}

// Drives on for it->time at a cap: 0 brakes.
static void drive_on(aisle_pace_predict *self, double cap, leap *it) {
    const aisle_band_motion motion = motion_of(self, cap);
    aisle_band_walk walk;
    aisle_band_part part;
    if (!aisle_band_walk_begin(&walk, &motion)) {
        it->time = 0.0;
        it->arrives = true;
        return;
    }
    if (walk.t >= it->time) {
        self->rested += it->time;
        it->rests = true;
        return;
    }
    for (;;) {
        const bool moves = aisle_band_walk_next(&walk, &part);
        if (moves && walk.piece > self->until) { // it went over the waypoint in passing
            it->time = part.t0;
            it->arrives = true;
            return;
        }
        if (moves && part.t1 >= it->time) {
            const double x = aisle_band_part_at(&part, it->time);
            self->at = aisle_band_walk_place(&walk, &part, x);
            self->v = walk.leg.on_spot ? 0.0 : sqrt(aisle_max(aisle_band_part_square(&part, x), 0.0));
            self->rested = 0.0;
            it->made += x - part.x0;
            return;
        }
        it->made += moves ? part.x1 - part.x0 : 0.0;
        if (walk.stands) {
            self->at = aisle_band_walk_place(&walk, &part, part.x0);
            self->v = 0.0;
            return;
        }
        if (!moves && !leave_run(self, &walk, it)) {
            return;
        }
    }
}

// Brakes, or stands: where no mover moves nothing will change.
static void hold(aisle_pace_predict *self, leap *it) {
    self->slowest = 0.0;
    if (self->v > 0.0) {
        drive_on(self, 0.0, it);
        return;
    }
    if (!self->movers_move) {
        it->time = AISLE_PREDICT_STAND - self->stood;
    }
    self->rested += it->time;
    self->waited += it->time;
}

// Counts how long it has hardly got on.
static void count_standing(aisle_pace_predict *self, const leap *it) {
    self->stood += it->time;
    self->gained += it->made;
    if (it->rests || self->gained > AISLE_PREDICT_GAIN) {
        self->stood = self->gained = 0.0;
    }
}

static double time_left(const aisle_pace_predict *self) {
    const aisle_place end = {self->until, 1.0};
    const aisle_vehicle *vehicle = self->request.vehicle;
    return aisle_motion_time(vehicle, self->w, self->n, self->dwell, end) -
           aisle_motion_time(vehicle, self->w, self->n, self->dwell, self->at);
}

static void step(aisle_pace_predict *self, uint32_t *spent) {
    if (self->steps++ == AISLE_PREDICT_STEPS) {
        self->seconds += time_left(self);
        self->outcome = AISLE_OK;
        return;
    }
    const uint32_t level = self->level = choose(self, spent);
    const double cap = aisle_pace_cap(self->request.vehicle, level);
    leap it = {.time = AISLE_PREDICT_STEP};
    if (level == AISLE_PACE_STOP) {
        hold(self, &it);
    } else {
        self->slowest = aisle_min(self->slowest, cap);
        drive_on(self, cap, &it);
    }
    self->seconds += it.time;
    count_standing(self, &it);
    if (it.arrives) {
        self->outcome = AISLE_OK;
    } else if (self->stood >= AISLE_PREDICT_STAND) {
        self->outcome = AISLE_PARTIAL;
    }
}

aisle_status aisle_pace_predict_step(aisle_pace_predict *self, uint32_t units, uint32_t *spent) {
    uint32_t used = 0;
    while (self->outcome == AISLE_BUSY && used < units) {
        used++;
        step(self, &used);
    }
    *spent += used;
    return self->outcome;
}
