#include "plan/pace.h"

#include "base/angle.h"
#include "base/check.h"
#include "base/rounding.h"
#include "robot/curve.h"

#include <string.h>

#define BASE_END 0.5e-6 // m, rad, a waypoint less than that before its end need not be counted to the base
#define SNAP 2e-6       // m, waypoints are at least apart
#define SPACING 0.02    // m, of the band's places at least
#define PLACES 256.0    // of a band, about
#define AHEAD 0.1       // m, of the front beyond what can matter

void aisle_pace_carve(aisle_pace *self, aisle_arena *arena) {
    void *front = aisle_arena_take(arena, AISLE_PATH_MAX_WAYPOINTS, sizeof(aisle_waypoint_msg));
    void *dwell = aisle_arena_take(arena, AISLE_PATH_MAX_WAYPOINTS, sizeof(float));
    void *front_dwell = aisle_arena_take(arena, AISLE_PATH_MAX_WAYPOINTS, sizeof(float));
    void *most = aisle_arena_take(arena, AISLE_PATH_MAX_WAYPOINTS, sizeof(float));
    if (self != NULL) {
        self->front = (aisle_waypoint_msg *)front;
        self->dwell = (float *)dwell;
        self->front_dwell = (float *)front_dwell;
        self->most = (float *)most;
    }
}

double aisle_pace_cap(const aisle_vehicle *vehicle, uint32_t level) {
    static const double share[AISLE_PACE_LEVELS] = {1.0, 0.75, 0.5, 0.35, 0.25, 0.17, 0.1, 0.0};
    AISLE_ASSERT(level < AISLE_PACE_LEVELS);
    return level == 0 ? (double)INFINITY : share[level] * vehicle->v_max;
}

// ---- waypoints where speeds change

typedef struct knots {     // a path that they go into
    aisle_waypoint_msg *w; // [AISLE_PATH_MAX_WAYPOINTS]
    float *dwell;          // likewise
    uint32_t n;
    bool overflow;
} knots;

static bool is_turn(const aisle_waypoint_msg *from) {
    return (from->flags & AISLE_WAYPOINT_TURN_IN_PLACE) != 0;
}

// The piece that holds the place x m from the start, and what lies before it. 0: x is at a waypoint, or off the path.
static uint32_t piece_with(const knots *self, double x, double *before, double *length) {
    *before = 0.0;
    for (uint32_t i = 1; i < self->n && *before < x - SNAP; i++) {
        *length = aisle_piece_length(&self->w[i - 1], &self->w[i]);
        if (x < *before + *length - SNAP) {
            return i;
        }
        *before += *length;
    }
    return 0;
}

// Puts a waypoint x m from the start, unless there is one.
static void put_knot(knots *self, double x) {
    double before, length;
    const uint32_t i = piece_with(self, x, &before, &length);
    if (i == 0) {
        return;
    }
    if (self->n == AISLE_PATH_MAX_WAYPOINTS) {
        self->overflow = true;
        return;
    }
    const aisle_waypoint_msg knot = aisle_piece_part(&self->w[i], (x - before) / length);
    memmove(&self->w[i + 1U], &self->w[i], (self->n - i) * sizeof self->w[0]);
    memmove(&self->dwell[i + 1U], &self->dwell[i], (self->n - i) * sizeof self->dwell[0]);
    self->w[i] = knot;
    self->dwell[i] = 0.0F;
    self->n++;
}

// ---- the base

// Puts waypoints where the speed of what is under way bends, where it passes the present one, and where the base ends:
// between them its square is linear, and so is that of the new path.
static void put_base_knots(knots *self, const aisle_pace_request *request, double v) {
    const aisle_verify_base *base = request->base;
    double x = 0.0, behind = base->u; // of the piece in hand
    for (uint32_t i = base->piece; i >= 1 && i < base->n && x < base->reach; i++, behind = 0.0) {
        const aisle_motion_leg leg = aisle_motion_leg_of(request->vehicle, base->w, base->dwell, i);
        double from = -behind * leg.way; // of the phase, from where the vehicle is on the piece
        for (uint32_t k = 0; k < leg.parts && !leg.on_spot && x + from < base->reach; k++) {
            const aisle_motion_phase *part = &leg.part[k];
            const double gain = part->v1 * part->v1 - part->v0 * part->v0, wanted = v * v - part->v0 * part->v0;
            if (fabs(gain) > 0.0 && wanted / gain > 0.0 && wanted / gain < 1.0) {
                put_knot(self, aisle_min(x + from + part->way * wanted / gain, base->reach));
            }
            from += part->way;
            put_knot(self, aisle_min(x + from, base->reach));
        }
        x += leg.on_spot ? 0.0 : (1.0 - behind) * leg.way;
    }
}

// What the base allows s m from the start, m/s; INFINITY behind it.
static double base_allows(const aisle_pace_request *request, double s, double v) {
    const aisle_verify_base *base = request->base;
    if (base == NULL || s > base->reach + SNAP) {
        return (double)INFINITY;
    }
    const aisle_place from = {base->piece, base->u}, at = aisle_motion_advance(base->w, base->n, from, s);
    return aisle_max(aisle_motion_speed(request->vehicle, base->w, base->n, base->dwell, at), v);
}

// Does the first piece, a turn, end within what is left of the turn under way?
static bool turns_on_base(const aisle_verify_base *base, const aisle_waypoint_msg *w) {
    if (!base->turn || !is_turn(&w[0])) {
        return false;
    }
    const double left = (1.0 - base->u) * fabs(aisle_piece_turn(&base->w[base->piece - 1U], &base->w[base->piece]));
    return fabs(aisle_piece_turn(&w[0], &w[1])) <= left + BASE_END;
}

static uint32_t count_base(const aisle_pace_request *request, const aisle_waypoint_msg *w, uint32_t n) {
    const aisle_verify_base *base = request->base;
    if (base == NULL) {
        return 0;
    }
    uint32_t count = 1;
    double s = 0.0;
    for (uint32_t i = 1; i < n; i++) {
        s += aisle_piece_length(&w[i - 1], &w[i]);
        const bool is_on_base = s < base->reach - BASE_END || (i == 1 && turns_on_base(base, w));
        count = is_on_base ? i + 1U : count;
    }
    return count;
}

// ---- speeds

// Bounds of every waypoint: of the base, and `cap` on pieces that begin within `length` m. How many pieces begin on the base.
static uint32_t bound(aisle_pace *self, const knots *path, double cap, double length) {
    const aisle_verify_base *base = self->request.base;
    double s = 0.0;
    uint32_t on_base = 0;
    self->most[0] = cap < AISLE_VEHICLE_SPEED_MAX ? aisle_float_below(cap) : INFINITY;
    for (uint32_t i = 1; i < path->n; i++) {
        double most = s < length ? cap : (double)INFINITY;
        on_base = base != NULL && s < base->reach - BASE_END ? i : on_base;
        s += aisle_piece_length(&path->w[i - 1], &path->w[i]);
        most = aisle_min(most, base_allows(&self->request, s, self->v));
        self->most[i] = most < AISLE_VEHICLE_SPEED_MAX ? aisle_float_below(most) : INFINITY;
    }
    return on_base;
}

static aisle_status fill(aisle_pace *self, knots *path, double cap, double length, aisle_profile_sum *sum) {
    const double brakes = 0.5 * (self->v * self->v - cap * cap) / self->request.vehicle->d_max;
    if (brakes > 0.0) {
        put_knot(path, brakes);
    }
    if (path->overflow) {
        return AISLE_ERR_CAPACITY;
    }
    const uint32_t on_base = bound(self, path, cap, length);
    const aisle_profile_start start = {self->v, self->most};
    aisle_profile_path way = {
        .w = path->w, .dwell = path->dwell, .n = path->n, .capacity = AISLE_PATH_MAX_WAYPOINTS, .whole = on_base};
    const aisle_status st = aisle_profile_fill_ramps(self->request.vehicle, self->request.layout, &way, &start, sum);
    path->n = way.n;
    return st == AISLE_PARTIAL ? AISLE_OK : st; // too fast for what follows: braked hard, as the look at it will know
}

// m that can be driven within the lease and the braking after it, at most.
static double reach_of(const aisle_pace *self, double cap) {
    const aisle_vehicle *vehicle = self->request.vehicle;
    const double v = aisle_max(self->request.v, aisle_min(cap, aisle_max(vehicle->v_max, vehicle->v_reverse_max)));
    return v * (AISLE_PACE_HOLD * self->request.lease + vehicle->reaction_time) + 0.5 * v * v / vehicle->d_max;
}

static aisle_status finish(aisle_pace *self, knots *path, double cap, double length) {
    aisle_path_msg *out = self->path;
    aisle_profile_sum sum;
    const aisle_status st = fill(self, path, cap, length, &sum);
    if (st != AISLE_OK) {
        return st;
    }
    float least = path->w[0].clearance;
    for (uint32_t i = 1; i < path->n; i++) {
        least = path->w[i].clearance < least ? path->w[i].clearance : least;
    }
    out->num_waypoints = (int16_t)path->n;
    out->num_base = (int16_t)count_base(&self->request, path->w, path->n);
    out->clearance_min = least;
    out->length = (float)sum.length;
    out->duration = (float)sum.duration;
    out->energy = (float)sum.energy;
    out->risk = (float)sum.risk;
    return AISLE_OK;
}

static knots whole_path(aisle_pace *self) {
    return (knots){self->path->waypoints, self->dwell, self->n, false};
}

// ---- the stop

// The first waypoint that the path rests at, whatever its speeds.
static uint32_t first_rest(const knots *path) {
    uint32_t i = 1;
    for (; i + 1U < path->n; i++) {
        const int reverses = (path->w[i].flags ^ path->w[i + 1U].flags) & AISLE_WAYPOINT_REVERSE;
        if ((path->w[i].flags & AISLE_WAYPOINT_STOP) != 0 || is_turn(&path->w[i]) || is_turn(&path->w[i - 1]) ||
            reverses != 0) {
            break;
        }
    }
    return i;
}

static void end_with(knots *path, uint32_t last) {
    path->n = last + 1U;
    path->w[last].flags &= (int16_t)~AISLE_WAYPOINT_TURN_IN_PLACE;
    path->dwell[last] = 0.0F;
}

// A turn that is under way ends where its brakes end it.
static void stop_turn(aisle_pace *self, knots *path) {
    const aisle_pace_request *request = &self->request;
    const aisle_place rest = aisle_motion_rest(request->vehicle, request->w, request->n, request->dwell, request->at,
                                               0.0, AISLE_PACE_LATENCY);
    end_with(path, 1);
    if (rest.piece == request->at.piece && rest.u < 1.0) { // and not at the goal that may be its end
        path->w[1].theta = aisle_motion_pose(request->w, request->n, rest).theta;
        path->w[1].flags &= (int16_t)~AISLE_WAYPOINT_GOAL;
        path->w[1].goal_id = 0;
    }
    if (fabs(aisle_piece_turn(&path->w[0], &path->w[1])) < AISLE_CURVE_HEADING_TOLERANCE) {
        end_with(path, 0);
    }
}

static void stop_drive(aisle_pace *self, knots *path) {
    const double begins = self->v * AISLE_PACE_LATENCY;
    const double end = begins + 0.5 * self->v * self->v / self->request.vehicle->d_max;
    put_knot(path, begins);
    put_knot(path, end);
    const uint32_t rests = first_rest(path);
    uint32_t last = 0;
    for (double s = 0.0; last < rests && s < end - 2.0 * SNAP;) {
        last++;
        s += aisle_piece_length(&path->w[last - 1U], &path->w[last]);
    }
    end_with(path, last);
}

static aisle_status stop(aisle_pace *self) {
    knots path = whole_path(self);
    const aisle_place at = self->request.at;
    const bool turns = path.n > 1 && is_turn(&path.w[0]) && at.u > 0.0 && at.u < 1.0;
    if (turns) {
        stop_turn(self, &path);
    } else if (self->v > 0.0 && path.n > 1) {
        stop_drive(self, &path);
    } else {
        end_with(&path, 0);
    }
    const double cap = self->v > 0.0 ? self->v : self->request.vehicle->v_max;
    const aisle_status st = path.overflow ? AISLE_ERR_CAPACITY : finish(self, &path, cap, (double)INFINITY);
    return st == AISLE_OK ? AISLE_PARTIAL : st;
}

// ---- levels

// The part of the path that the level's band and all that bounds its speeds lie on: up to the first waypoint beyond the
// reach they are as on the whole path, for from there it could brake to the front's end.
static knots take_front(aisle_pace *self, double cap) {
    const aisle_vehicle *vehicle = self->request.vehicle;
    const double fastest = aisle_max(aisle_max(vehicle->v_max, vehicle->v_reverse_max), self->request.v);
    const double reach = reach_of(self, cap), brakes = 0.5 * fastest * fastest / vehicle->d_max;
    const aisle_waypoint_msg *w = self->path->waypoints;
    double s = 0.0, beyond = 0.0; // m; beyond: behind the first waypoint past the reach
    uint32_t n = 1;
    for (; n < self->n && !(s >= reach && beyond >= brakes + AHEAD); n++) {
        const double length = aisle_piece_length(&w[n - 1U], &w[n]);
        beyond += s >= reach ? length : 0.0;
        s += length;
    }
    memcpy(self->front, w, n * sizeof w[0]);
    memcpy(self->front_dwell, self->dwell, n * sizeof self->dwell[0]);
    return (knots){self->front, self->front_dwell, n, false};
}

static double lease_of(const aisle_pace *self) {
    return self->request.lease * (self->level < self->request.current ? AISLE_PACE_HOLD : 1.0);
}

// The level's speeds and band.
static aisle_status make_level(aisle_pace *self, uint32_t *spent) {
    const aisle_pace_request *request = &self->request;
    const double cap = aisle_pace_cap(request->vehicle, self->level), reach = reach_of(self, cap);
    aisle_profile_sum sum;
    knots front = take_front(self, cap);
    const aisle_status st = fill(self, &front, cap, reach, &sum);
    *spent += front.n / 8U;
    if (st != AISLE_OK) {
        return st;
    }
    const aisle_band_motion motion = {.vehicle = request->vehicle,
                                      .w = front.w,
                                      .n = front.n,
                                      .dwell = front.dwell,
                                      .at = {front.n > 1 ? 1U : 0U, 0.0},
                                      .v = request->v,
                                      .omega = request->omega,
                                      .cap = (double)INFINITY,
                                      .rested = (double)INFINITY,
                                      .lease = lease_of(self),
                                      .late = request->late,
                                      .spacing = aisle_max(SPACING, reach / PLACES)};
    aisle_band_make(&self->band, &motion);
    *spent += self->band.n / 8U;
    self->tried++;
    return AISLE_OK;
}

static void end(aisle_pace *self, aisle_status outcome) {
    self->outcome = outcome;
    self->phase = AISLE_PACE_DONE;
}

// The next slower one that is not the same: a cap above the peak changes nothing.
static void give_way(aisle_pace *self) {
    do {
        self->level++;
    } while (self->level < AISLE_PACE_STOP && aisle_pace_cap(self->request.vehicle, self->level) >= self->band.peak);
    self->phase = AISLE_PACE_LEVEL;
}

// With a level that is made, or cannot be. Then what is under way is stopped: there is no room for a path, or it comes to
// rest a bit further on and the speeds there, which none may pass, are so low that any path would take for ever.
static void conclude(aisle_pace *self, aisle_status st) {
    if (st != AISLE_OK && self->request.base != NULL) {
        self->level = AISLE_PACE_STOP;
        self->phase = AISLE_PACE_LEVEL;
    } else {
        end(self, st);
    }
}

static void step_level(aisle_pace *self, uint32_t *spent) {
    if (self->level == AISLE_PACE_STOP) {
        end(self, stop(self));
        return;
    }
    const aisle_status st = make_level(self, spent);
    self->mover = 0;
    self->phase = AISLE_PACE_MOVERS;
    if (st != AISLE_OK) {
        conclude(self, st);
    } else if (self->band.overflow) {
        give_way(self);
    }
}

static void blame(aisle_pace *self, const aisle_mover *mover, uint32_t where) {
    const aisle_band_place *at = &self->band.at[where];
    self->limit = (aisle_pace_limit){true, mover->id, mover->source, {at->pose.x, at->pose.y}, at->until};
}

static void step_mover(aisle_pace *self, uint32_t *spent) {
    const aisle_pace_request *request = &self->request;
    if (self->mover == request->movers->count) {
        if (request->enough > 0U && self->level >= request->enough) {
            end(self, AISLE_OK);
            return;
        }
        knots path = whole_path(self);
        const double cap = aisle_pace_cap(request->vehicle, self->level);
        *spent += self->n / 8U;
        conclude(self, finish(self, &path, cap, reach_of(self, cap)));
        return;
    }
    const aisle_mover *mover = &request->movers->mover[self->mover++];
    const aisle_band_disc disc = {mover->at, aisle_mover_reach(mover, request->now_us), mover->v_bound};
    uint32_t where;
    (*spent)++;
    if (!aisle_band_is_clear(&self->band, request->vehicle, &disc, request->vehicle->margin + AISLE_PACE_SPARE,
                             AISLE_PACE_LAG, &where, spent)) {
        blame(self, mover, where);
        give_way(self);
    }
}

// ---- the whole

void aisle_pace_start(aisle_pace *self, const aisle_pace_request *request, aisle_path_msg *path) {
    AISLE_ASSERT(request->n >= 1 && aisle_place_exists(request->n, request->at) && request->w != path->waypoints);
    AISLE_ASSERT(request->v >= 0.0 && request->lease > 0.0 && request->first < AISLE_PACE_LEVELS);
    self->request = *request;
    self->path = path;
    self->level = request->first;
    self->limit = (aisle_pace_limit){false, 0, 0, {0.0, 0.0}, 0.0};
    self->tried = 0;
    self->phase = AISLE_PACE_LEVEL;
    self->n = aisle_motion_cut(request->vehicle, request->w, request->n, request->dwell, request->at, path->waypoints,
                               AISLE_PATH_MAX_WAYPOINTS);
    if (self->n == 0) {
        end(self, AISLE_ERR_CAPACITY);
        return;
    }
    aisle_motion_cut_dwell(request->dwell, request->n, request->at, self->n, self->dwell);
    const aisle_waypoint_msg *first = &path->waypoints[0];
    const bool rests = self->n == 1 || (first->flags & (AISLE_WAYPOINT_STOP | AISLE_WAYPOINT_TURN_IN_PLACE)) != 0 ||
                       self->dwell[0] > 0.0F;
    self->v = rests || request->v < AISLE_PACE_RESTING ? 0.0 : aisle_min(request->v, AISLE_VEHICLE_SPEED_MAX);
    if (request->base != NULL) {
        knots whole = whole_path(self);
        put_base_knots(&whole, request, self->v);
        self->n = whole.n;
        if (whole.overflow) {
            end(self, AISLE_ERR_CAPACITY);
        }
    }
}

aisle_status aisle_pace_step(aisle_pace *self, uint32_t units, uint32_t *spent) {
    uint32_t used = 0;
    while (self->phase != AISLE_PACE_DONE && used < units) {
        if (self->phase == AISLE_PACE_LEVEL) {
            step_level(self, &used);
        } else {
            step_mover(self, &used);
        }
    }
    *spent += used;
    return self->phase == AISLE_PACE_DONE ? self->outcome : AISLE_BUSY;
}
