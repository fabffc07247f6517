#include "plan/band.h"

#include "base/angle.h"
#include "base/check.h"
#include "robot/curve.h"
#include "robot/profile.h"
#include "world/shape.h"

#include <float.h>

#define CROSSING_LEAST 1e-9 // m, a shorter part is none

// ---- walking

typedef struct line { // value and slope of a square of the speed over the way
    double at, slope;
} line;

static double line_at(line l, double z) {
    return l.at + l.slope * z;
}

static void enter(aisle_band_walk *self, uint32_t piece, double u) {
    const aisle_band_motion *motion = &self->motion;
    self->piece = piece;
    self->leg = aisle_motion_leg_of(motion->vehicle, motion->w, motion->dwell, piece);
    self->phase = 0;
    self->way = u * self->leg.way;
    while (self->phase + 1U < self->leg.parts && self->way >= self->leg.part[self->phase].way) {
        self->way -= self->leg.part[self->phase++].way;
    }
    self->natural = 0.0;
    for (uint32_t k = 0; k < self->leg.parts; k++) {
        const aisle_motion_phase *part = &self->leg.part[k];
        self->natural += 2.0 * part->way / (part->v0 + part->v1);
    }
}

// Of the path, where it is.
static double speed_here(const aisle_band_walk *self) {
    if (self->leg.parts == 0) {
        return 0.0;
    }
    const aisle_motion_phase *part = &self->leg.part[self->phase];
    const double p0 = part->v0 * part->v0, p1 = part->v1 * part->v1;
    return sqrt(aisle_max(p0 + (p1 - p0) * (self->way / part->way), 0.0));
}

bool aisle_band_walk_begin(aisle_band_walk *self, const aisle_band_motion *motion) {
    AISLE_ASSERT(aisle_place_exists(motion->n, motion->at) && motion->v >= 0.0 && motion->cap >= 0.0);
    *self = (aisle_band_walk){.motion = *motion};
    aisle_place at = motion->at;
    if (at.u >= 1.0 || motion->n == 1) { // arrived: what is next?
        at = (aisle_place){at.piece + 1U, 0.0};
    }
    if (at.piece >= motion->n) {
        return false;
    }
    enter(self, at.piece, at.u);
    if (!(at.u > 0.0)) {
        self->t = aisle_max(self->leg.rest - motion->rested, 0.0);
    }
    if (self->leg.parts == 0) { // of a wait what is left passes at once
        self->way = at.u;
    }
    self->from_square = motion->v * motion->v;
    if (self->leg.on_spot) {
        const double rate = aisle_max(motion->omega, speed_here(self));
        self->from_square = rate * rate;
    }
    return true;
}

bool aisle_band_walk_run(aisle_band_walk *self) {
    if (self->piece + 1U >= self->motion.n || self->stands) {
        return false;
    }
    enter(self, self->piece + 1U, 0.0);
    self->t += self->leg.rest;
    self->x = self->from_square = 0.0;
    return true;
}

// How far the least of path, cap and acceleration, or what braking leaves, stays one line: up to where any two cross.
static double straight_part(const line *l, uint32_t n, double end) {
    for (uint32_t i = 0; i < n; i++) {
        for (uint32_t k = i + 1; k < n; k++) {
            const double closing = l[i].slope - l[k].slope, z = (l[k].at - l[i].at) / closing;
            if (fabs(closing) > 0.0 && z > CROSSING_LEAST && z < end) {
                end = z;
            }
        }
    }
    return end;
}

static double least_at(const line *l, double z) {
    return aisle_max(aisle_min(line_at(l[0], z), aisle_min(line_at(l[1], z), line_at(l[2], z))), 0.0);
}

static double square_at(const line *l, double z) {
    return aisle_max(line_at(l[3], z), least_at(l, z));
}

// m or rad to the end of the piece in hand.
static double left_of_leg(const aisle_band_walk *self) {
    double left = self->leg.way - self->way;
    for (uint32_t k = 0; k < self->phase; k++) {
        left -= self->leg.part[k].way;
    }
    return aisle_max(left, 0.0);
}

// The part of the phase in hand from here on.
static aisle_band_part next_part(const aisle_band_walk *self) {
    const aisle_motion_phase *phase = &self->leg.part[self->phase];
    const double p0 = phase->v0 * phase->v0, slope = (phase->v1 * phase->v1 - p0) / phase->way;
    const line path = {p0 + slope * self->way, slope};
    const double left = phase->way - self->way;
    aisle_band_part part = {.x0 = self->x, .t0 = self->t};
    const aisle_vehicle *vehicle = self->motion.vehicle;
    if (self->leg.on_spot) {
        const double gain = 2.0 * vehicle->alpha_max;
        const line rates[3] = {{vehicle->omega_max * vehicle->omega_max, 0.0},
                               {self->from_square + gain * self->x, gain},
                               {gain * left_of_leg(self), -gain}};
        const double end = straight_part(rates, 3, left);
        part.x1 = self->x + end;
        part.q0 = least_at(rates, 0.0);
        part.q1 = least_at(rates, end);
        return part;
    }
    const double up = 2.0 * vehicle->a_max, down = 2.0 * vehicle->d_max, cap = self->motion.cap;
    const line lines[4] = {
        path,
        {cap < AISLE_VEHICLE_SPEED_MAX ? cap * cap : 4.0 * AISLE_VEHICLE_SPEED_MAX * AISLE_VEHICLE_SPEED_MAX, 0.0},
        {self->from_square + up * self->x, up},
        {self->from_square - down * self->x, -down}};
    const double end = straight_part(lines, 4, left);
    part.x1 = self->x + end;
    part.q0 = square_at(lines, 0.0);
    part.q1 = square_at(lines, end);
    return part;
}

// The run goes on over the next piece?
static bool goes_on(const aisle_band_walk *self) {
    const aisle_motion_leg *leg = &self->leg;
    return !leg->on_spot && leg->parts > 0 && leg->part[leg->parts - 1U].v1 > AISLE_MOTION_REST &&
           self->piece + 1U < self->motion.n;
}

bool aisle_band_walk_next(aisle_band_walk *self, aisle_band_part *part) {
    if (self->leg.parts == 0) {
        self->t += (1.0 - self->way) * self->leg.time;
        return false;
    }
    while (self->phase >= self->leg.parts || self->leg.part[self->phase].way - self->way <= 0.0) {
        if (self->phase + 1U < self->leg.parts) {
            self->phase++;
        } else if (goes_on(self)) {
            enter(self, self->piece + 1U, 0.0);
        } else {
            return false;
        }
        self->way = 0.0;
    }
    *part = next_part(self);
    const double sum = sqrt(part->q0) + sqrt(part->q1);
    if (!(sum > 0.0)) { // capped to a stand
        self->stands = true;
        part->x1 = part->x0;
        return false;
    }
    const double made = part->x1 - part->x0, stretch = aisle_max(self->leg.time / self->natural, 1.0);
    part->t1 = part->t0 + stretch * 2.0 * made / sum;
    self->x = part->x1;
    self->t = part->t1;
    self->way += made;
    if (self->leg.part[self->phase].way - self->way <= CROSSING_LEAST) {
        self->phase++;
        self->way = 0.0;
    }
    return true;
}

// ---- along a part

double aisle_band_part_square(const aisle_band_part *part, double x) {
    return part->q0 + (part->q1 - part->q0) * ((x - part->x0) / (part->x1 - part->x0));
}

double aisle_band_part_time(const aisle_band_part *part, double x) {
    const double v0 = sqrt(part->q0), v1 = sqrt(part->q1), v = sqrt(aisle_max(aisle_band_part_square(part, x), 0.0));
    const double share = (x - part->x0) / (part->x1 - part->x0);
    return x > part->x0 ? part->t0 + (part->t1 - part->t0) * share * (v0 + v1) / (v0 + v) : part->t0;
}

double aisle_band_part_at(const aisle_band_part *part, double t) {
    const double v0 = sqrt(part->q0), v1 = sqrt(part->q1), made = part->x1 - part->x0;
    const double natural = 2.0 * made / (v0 + v1), time = natural * (t - part->t0) / (part->t1 - part->t0);
    const double a = (part->q1 - part->q0) / (2.0 * made);
    return aisle_clamp(part->x0 + time * (v0 + 0.5 * a * time), part->x0, part->x1);
}

aisle_place aisle_band_walk_place(const aisle_band_walk *self, const aisle_band_part *part, double x) {
    double end = self->way; // of the part, on the piece
    for (uint32_t k = 0; k < self->phase; k++) {
        end += self->leg.part[k].way;
    }
    return (aisle_place){self->piece, aisle_clamp((end - (part->x1 - x)) / self->leg.way, 0.0, 1.0)};
}

// ---- the band

typedef enum law_kind { FOLLOWS, BRAKES, RESTS } law_kind;

typedef struct law { // until when it may be moving at a place of the run
    law_kind kind;
    const aisle_band_part
        *part;           // FOLLOWS: passes it then. RESTS: there the motion begins to brake that rests at the place
    double lo, hi;       // RESTS: within part
    double x, square, t; // BRAKES: from there, this fast, then
    double decel;
} law;

static double until_of(const law *self, double x) {
    if (self->kind == FOLLOWS) {
        return aisle_band_part_time(self->part, x);
    }
    if (self->kind == BRAKES) {
        const double left = aisle_max(self->square - 2.0 * self->decel * (x - self->x), 0.0);
        return self->t + (sqrt(self->square) - sqrt(left)) / self->decel;
    }
    const aisle_band_part *part = self->part;
    const double slope = (part->q1 - part->q0) / (part->x1 - part->x0);
    const double gain = 1.0 + 0.5 * slope / self->decel; // of the place of rest, for each m the braking begins later
    double b = self->lo;
    if (gain > 1e-6) { // else the path brakes as hard itself, and all rest at the same place
        b = (x - 0.5 * (part->q0 - slope * part->x0) / self->decel) / gain;
    }
    b = aisle_clamp(b, self->lo, self->hi);
    return aisle_band_part_time(part, b) + sqrt(aisle_max(aisle_band_part_square(part, b), 0.0)) / self->decel;
}

typedef struct sweep {
    aisle_band *band;
    aisle_band_walk walk;
    double lever;             // m, farthest vertex from the origin
    double first, last;       // s, when it begins to brake at the earliest and at the latest
    double decel, spacing;    // of the run, m or rad
    double next;              // place of the run
    uint32_t piece;           // that it is on, or before
    double begins;            // where in the run that piece begins
    double way, turn, turned; // of that piece; rad turned by in the run before it
    double was, was_turned;   // at the last place put down
    bool begun;               // a braking motion has
    uint32_t first_place;     // of the run
} sweep;

static void take_piece(sweep *self, uint32_t piece) {
    const aisle_waypoint_msg *w = self->walk.motion.w;
    self->piece = piece;
    self->turn = fabs(aisle_piece_turn(&w[piece - 1], &w[piece]));
    self->way = self->walk.leg.on_spot ? self->turn : aisle_piece_length(&w[piece - 1], &w[piece]);
}

static void begin_run(sweep *self, double u) {
    const bool on_spot = self->walk.leg.on_spot;
    take_piece(self, self->walk.piece);
    self->begins = -u * self->way;
    self->turned = self->next = self->was = 0.0;
    self->was_turned = u * self->turn;
    self->decel = on_spot ? self->walk.motion.vehicle->alpha_max : self->walk.motion.vehicle->d_max;
    self->spacing = self->walk.motion.spacing;
    if (on_spot) {
        self->spacing = self->lever * AISLE_PI > self->spacing ? self->spacing / self->lever : AISLE_PI;
    }
    self->begun = false;
    self->first_place = self->band->n;
}

static void widen(aisle_aabb *box, aisle_pose2 p, bool first) {
    const aisle_aabb at = {{p.x, p.y}, {p.x, p.y}};
    box->lo = first ? at.lo : aisle_vec2_of(aisle_min(box->lo.x, p.x), aisle_min(box->lo.y, p.y));
    box->hi = first ? at.hi : aisle_vec2_of(aisle_max(box->hi.x, p.x), aisle_max(box->hi.y, p.y));
}

static void put(sweep *self, double x, double until) {
    aisle_band *band = self->band;
    const aisle_band_motion *motion = &self->walk.motion;
    if (band->n == AISLE_BAND_MAX) {
        band->overflow = true;
        return;
    }
    while (x > self->begins + self->way && (double)motion->w[self->piece].v > AISLE_MOTION_REST) { // within the run
        self->begins += self->way;
        self->turned += self->turn;
        take_piece(self, self->piece + 1U);
    }
    const double u = aisle_clamp((x - self->begins) / self->way, 0.0, 1.0), turned = self->turned + u * self->turn;
    const aisle_pose2 pose = aisle_piece_at(&motion->w[self->piece - 1], &motion->w[self->piece], u);
    const double made = self->walk.leg.on_spot ? 0.0 : x - self->was;
    const double travel = band->n > self->first_place ? made + self->lever * (turned - self->was_turned) : 0.0;
    widen(&band->box, pose, band->n == 0);
    band->widest = aisle_max(band->widest, travel);
    band->at[band->n++] = (aisle_band_place){pose, until, travel};
    self->was = x;
    self->was_turned = turned;
}

// Puts down the places up to x.
static void put_up_to(sweep *self, const law *by, double x) {
    while (self->next <= x && !self->band->overflow) {
        put(self, self->next, until_of(by, self->next));
        self->next += self->spacing;
    }
}

// The first braking motion begins within the part: places before it and of it.
static double begin_braking(sweep *self, const aisle_band_part *part) {
    const double t = aisle_max(part->t0, self->first);
    const double b = part->t0 < self->first ? aisle_band_part_at(part, self->first) : part->x0;
    const double square = aisle_max(aisle_band_part_square(part, b), 0.0);
    const law follow = {.kind = FOLLOWS, .part = part};
    const law brake = {.kind = BRAKES, .x = b, .square = square, .t = t, .decel = self->decel};
    put_up_to(self, &follow, b);
    put_up_to(self, &brake, b + 0.5 * square / self->decel);
    self->begun = true;
    return b;
}

// False: no more braking motions begin.
static bool sweep_part(sweep *self, const aisle_band_part *part, double *end, double *until) {
    if (!self->begun && part->t1 <= self->first) {
        const law follow = {.kind = FOLLOWS, .part = part};
        put_up_to(self, &follow, part->x1);
        *end = part->x1;
        *until = part->t1;
        return true;
    }
    const double from = self->begun ? part->x0 : begin_braking(self, part);
    const bool is_last = part->t1 >= self->last;
    const double to = aisle_max(is_last ? aisle_band_part_at(part, self->last) : part->x1, from);
    const law rest = {.kind = RESTS, .part = part, .lo = from, .hi = to, .decel = self->decel};
    *end = to + 0.5 * aisle_max(aisle_band_part_square(part, to), 0.0) / self->decel;
    *until = aisle_band_part_time(part, to) + sqrt(aisle_max(aisle_band_part_square(part, to), 0.0)) / self->decel;
    put_up_to(self, &rest, *end);
    return !is_last;
}

// False: the lease has ended.
static bool sweep_run(sweep *self) {
    aisle_band_part part;
    double end = 0.0, until = self->walk.t;
    bool goes_on = true, moves = false;
    while (goes_on && aisle_band_walk_next(&self->walk, &part)) {
        if (!self->walk.leg.on_spot) {
            self->band->peak = aisle_max(self->band->peak, sqrt(aisle_max(part.q0, part.q1)));
        }
        goes_on = sweep_part(self, &part, &end, &until);
        moves = true;
    }
    if (moves && end > self->was) {
        put(self, end, until);
    }
    return goes_on;
}

// Who is late is everywhere later, but none brakes after the last one, so none is at rest later than it.
static void be_late(aisle_band *self, double late) {
    const double last = self->n > 0U ? self->at[self->n - 1U].until : 0.0;
    for (uint32_t k = 0; k < self->n; k++) {
        aisle_band_place *at = &self->at[k];
        at->until = aisle_max(at->until, aisle_min(at->until + late, last));
    }
}

void aisle_band_make(aisle_band *self, const aisle_band_motion *motion) {
    const aisle_vehicle *vehicle = motion->vehicle;
    AISLE_ASSERT(motion->lease > 0.0 && motion->spacing > 0.0 && motion->cap > 0.0);
    self->n = 0;
    self->overflow = false;
    self->peak = self->widest = 0.0;
    self->box = (aisle_aabb){{0.0, 0.0}, {0.0, 0.0}};
    sweep it = {.band = self, .lever = vehicle->outer_radius - vehicle->radius};
    it.first = vehicle->reaction_time;
    it.last = vehicle->reaction_time + motion->lease;
    if (!aisle_band_walk_begin(&it.walk, motion)) {
        return;
    }
    begin_run(&it, motion->at.u >= 1.0 ? 0.0 : motion->at.u);
    while (it.walk.t < it.last && sweep_run(&it) && !self->overflow && aisle_band_walk_run(&it.walk)) {
        begin_run(&it, 0.0);
    }
    be_late(self, motion->late);
}

// ---- discs

static double radius_at(const aisle_band_disc *disc, double t) {
    return disc->reach + disc->bound * t;
}

// How far off the disc's centre the grown body must be at place k, for itself and for half the way to its neighbours.
static double needed_at(const aisle_band *self, const aisle_band_disc *disc, uint32_t k, double growth, double lag) {
    const aisle_band_place *at = &self->at[k];
    double needed = radius_at(disc, at->until + lag) + 0.5 * at->travel;
    if (k + 1U < self->n && at[1].travel > 0.0) {
        needed = aisle_max(needed, radius_at(disc, at[1].until + lag) + 0.5 * at[1].travel);
    }
    return needed + growth;
}

// A lower bound of the body's gap to the centre that is exact where it is below `needed`.
static double gap_at(const aisle_vehicle *vehicle, aisle_pose2 pose, aisle_vec2 centre, double needed) {
    const double coarse = aisle_vec2_distance(aisle_vec2_of(pose.x, pose.y), centre) - vehicle->outer_radius;
    if (coarse >= needed || aisle_vehicle_is_disc(vehicle)) {
        return aisle_max(coarse, 0.0);
    }
    aisle_vec2 v[AISLE_SHAPE_VERTICES_MAX];
    const aisle_convex body = aisle_vehicle_place(vehicle, pose, 0.0, v);
    return aisle_convex_point_gap(&body, centre);
}

bool aisle_band_is_clear(const aisle_band *self, const aisle_vehicle *vehicle, const aisle_band_disc *disc,
                         double growth, double lag, uint32_t *where, uint32_t *looked) {
    if (self->n == 0) {
        return true;
    }
    const aisle_aabb point = {disc->centre, disc->centre};
    const double most = radius_at(disc, self->at[self->n - 1U].until + lag) + growth + vehicle->outer_radius;
    if (aisle_aabb_gap(self->box, point) > most + self->widest) {
        return true;
    }
    double sure = 0.0; // m that the gap is at least
    for (uint32_t k = 0; k < self->n; k++) {
        const double needed = needed_at(self, disc, k, growth, lag);
        sure -= self->at[k].travel;
        if (sure >= needed) {
            continue;
        }
        (*looked)++;
        sure = gap_at(vehicle, self->at[k].pose, disc->centre, needed);
        if (!(sure >= needed)) {
            *where = k;
            return false;
        }
    }
    return true;
}
