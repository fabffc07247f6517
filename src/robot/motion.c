#include "robot/motion.h"

#include "base/angle.h"
#include "base/check.h"
#include "base/rounding.h"
#include "robot/curve.h"
#include "robot/profile.h"

#include <stddef.h>

#define BACK_COST 3.0     // of a metre back, in a projection
#define BARRIER_SHARE 0.5 // of a barrier's height, that a place behind it must be better by

typedef aisle_motion_phase phase;
typedef aisle_motion_leg leg;

static bool has(const aisle_waypoint_msg *w, int flag) {
    return (w->flags & flag) != 0;
}

static bool is_at_rest(double v) {
    return v <= AISLE_MOTION_REST;
}

bool aisle_place_exists(uint32_t n, aisle_place place) {
    if (n < 2) {
        return n == 1 && place.piece == 0 && !(place.u < 0.0 || place.u > 0.0);
    }
    return place.piece >= 1 && place.piece < n && place.u >= 0.0 && place.u <= 1.0;
}

// ---- pieces

static bool is_on_spot(const aisle_waypoint_msg *from) {
    return has(from, AISLE_WAYPOINT_TURN_IN_PLACE);
}

static bool is_wait(const aisle_waypoint_msg *from, const aisle_waypoint_msg *to) {
    return is_on_spot(from) && fabs(aisle_piece_turn(from, to)) < AISLE_CURVE_HEADING_TOLERANCE;
}

static double phase_time(const phase *p) {
    return p->way > 0.0 ? 2.0 * p->way / (p->v0 + p->v1) : 0.0;
}

static void add_phase(leg *self, double way, double v0, double v1) {
    if (way > 0.0) {
        self->part[self->parts++] = (phase){way, v0, v1};
    }
}

// From rest to rest in self->time: the trapezoid with these accelerations whose peak is v of way = v time - q v^2, the
// slower root; greater ones where even the triangle would take longer.
static void fill_trapezoid(leg *self, double up, double down) {
    const double q = 0.5 / up + 0.5 / down, time = self->time;
    const double root = aisle_max(time * time - 4.0 * q * self->way, 0.0);
    const double peak = 2.0 * self->way / (time + sqrt(root)); // time > 0: pieces are at least 1 ms apart
    const double harder = aisle_max(4.0 * q * self->way / (time * time), 1.0);
    const double rise = 0.5 * peak * peak / (up * harder), fall = 0.5 * peak * peak / (down * harder);
    add_phase(self, rise, 0.0, peak);
    add_phase(self, self->way - rise - fall, peak, peak);
    add_phase(self, self->way - rise < fall ? self->way - rise : fall, peak, 0.0);
}

// Least time of the motion.
static double least_time(const aisle_vehicle *vehicle, const leg *self) {
    const double v0 = (double)self->from->v, v1 = (double)self->to->v;
    double peak;
    if (self->on_spot) {
        return aisle_rest_to_rest(self->way, vehicle->omega_max, vehicle->alpha_max, vehicle->alpha_max, &peak);
    }
    if (is_at_rest(v0) && is_at_rest(v1)) {
        return aisle_rest_to_rest(self->way, AISLE_VEHICLE_SPEED_MAX, vehicle->a_max, vehicle->d_max, &peak);
    }
    return 2.0 * self->way / (v0 + v1);
}

aisle_motion_leg aisle_motion_leg_of(const aisle_vehicle *vehicle, const aisle_waypoint_msg *w, const float *dwell,
                                     uint32_t i) {
    AISLE_ASSERT(i >= 1);
    const aisle_waypoint_msg *from = &w[i - 1], *to = &w[i];
    leg self = {.from = from, .to = to, .on_spot = is_on_spot(from)};
    const double v0 = (double)from->v, v1 = (double)to->v, span = (double)to->t - (double)from->t;
    const double told = dwell == NULL ? 0.0 : (double)dwell[i - 1];
    self.way = self.on_spot ? fabs(aisle_piece_turn(from, to)) : aisle_piece_length(from, to);
    if (is_wait(from, to)) {
        self.way = 0.0;
    }
    const double least = least_time(vehicle, &self), spare = aisle_max(span - least, 0.0);
    const bool tells_itself = self.way > 0.0 && (self.on_spot || (is_at_rest(v0) && !is_at_rest(v1)));
    const bool may_rest = self.on_spot || is_at_rest(v0);
    self.rest = tells_itself ? spare : (may_rest ? aisle_min(told, spare) : 0.0);
    self.time = span - self.rest;
    if (self.on_spot) {
        if (self.way > 0.0) {
            fill_trapezoid(&self, vehicle->alpha_max, vehicle->alpha_max);
        }
    } else if (is_at_rest(v0) && is_at_rest(v1)) {
        fill_trapezoid(&self, vehicle->a_max, vehicle->d_max);
    } else {
        add_phase(&self, self.way, v0, v1);
    }
    return self;
}

// ---- along a leg

static double phase_speed(const phase *p, double way) {
    return sqrt(aisle_max(p->v0 * p->v0 + (p->v1 * p->v1 - p->v0 * p->v0) * (way / p->way), 0.0));
}

// Where in a leg its part u begins: the phase, and the way behind in it.
static uint32_t find_phase(const leg *self, double u, double *way) {
    *way = u * self->way;
    uint32_t k = 0;
    while (k + 1U < self->parts && *way >= self->part[k].way) {
        *way -= self->part[k++].way;
    }
    *way = self->parts > 0 ? aisle_min(*way, self->part[k].way) : 0.0;
    return k;
}

static double leg_speed(const leg *self, double u) {
    if (self->parts == 0) {
        return 0.0;
    }
    double way;
    const uint32_t k = find_phase(self, u, &way);
    return phase_speed(&self->part[k], way);
}

static double natural_time(const leg *self) {
    double time = 0.0;
    for (uint32_t k = 0; k < self->parts; k++) {
        time += phase_time(&self->part[k]);
    }
    return time;
}

// Time from when the motion begins to its part u.
static double leg_time(const leg *self, double u) {
    if (self->parts == 0) {
        return u * self->time;
    }
    double way, before = 0.0;
    const uint32_t k = find_phase(self, u, &way);
    for (uint32_t i = 0; i < k; i++) {
        before += phase_time(&self->part[i]);
    }
    const double v = phase_speed(&self->part[k], way);
    before += way > 0.0 ? 2.0 * way / (self->part[k].v0 + v) : 0.0;
    return aisle_min(before * (self->time / natural_time(self)), self->time);
}

// Way made in a phase after `time`: v0 t + a t^2 / 2 with a = (v1^2 - v0^2) / (2 way).
static double phase_way(const phase *p, double time) {
    const double a = (p->v1 * p->v1 - p->v0 * p->v0) / (2.0 * p->way);
    return aisle_clamp(time * (p->v0 + 0.5 * a * time), 0.0, p->way);
}

// The part of it behind after `time` of its motion.
static double leg_at(const leg *self, double time) {
    if (time >= self->time) {
        return 1.0;
    }
    if (self->parts == 0) {
        return time / self->time;
    }
    double left = time * (natural_time(self) / self->time), way = 0.0;
    uint32_t k = 0;
    for (; k + 1U < self->parts && left >= phase_time(&self->part[k]); k++) {
        left -= phase_time(&self->part[k]);
        way += self->part[k].way;
    }
    return aisle_clamp((way + phase_way(&self->part[k], left)) / self->way, 0.0, 1.0);
}

// ---- places

static double length_of(const aisle_waypoint_msg *w, uint32_t i) {
    return aisle_piece_length(&w[i - 1], &w[i]);
}

double aisle_motion_length_to(const aisle_waypoint_msg *w, uint32_t n, aisle_place place) {
    AISLE_ASSERT(aisle_place_exists(n, place));
    double length = 0.0;
    for (uint32_t i = 1; i < place.piece; i++) {
        length += length_of(w, i);
    }
    return n > 1 ? length + place.u * length_of(w, place.piece) : 0.0;
}

aisle_pose2 aisle_motion_pose(const aisle_waypoint_msg *w, uint32_t n, aisle_place place) {
    AISLE_ASSERT(aisle_place_exists(n, place));
    if (n == 1 || place.u >= 1.0) { // the waypoint itself, to the bit
        const aisle_waypoint_msg *at = &w[place.piece];
        return (aisle_pose2){at->x, at->y, aisle_angle_wrap(at->theta)};
    }
    aisle_pose2 pose = aisle_piece_at(&w[place.piece - 1], &w[place.piece], place.u);
    pose.theta = aisle_angle_wrap(pose.theta);
    return pose;
}

static aisle_place advance_back(const aisle_waypoint_msg *w, aisle_place place, double metres) {
    for (;;) {
        const double length = length_of(w, place.piece), behind = place.u * length;
        if (metres < behind) {
            return (aisle_place){place.piece, aisle_clamp(place.u - metres / length, 0.0, 1.0)};
        }
        metres -= behind;
        place.u = 0.0;
        if (place.piece == 1 || metres <= 0.0) {
            return place;
        }
        place = (aisle_place){place.piece - 1U, 1.0};
    }
}

aisle_place aisle_motion_advance(const aisle_waypoint_msg *w, uint32_t n, aisle_place place, double metres) {
    AISLE_ASSERT(aisle_place_exists(n, place));
    if (n == 1 || !(metres > 0.0 || metres < 0.0)) {
        return place;
    }
    if (metres < 0.0) {
        return advance_back(w, place, -metres);
    }
    for (;;) {
        const double length = length_of(w, place.piece), ahead = (1.0 - place.u) * length;
        if (metres < ahead) {
            return (aisle_place){place.piece, aisle_clamp(place.u + metres / length, 0.0, 1.0)};
        }
        metres -= ahead;
        place.u = 1.0;
        if (place.piece + 1U == n || metres <= 0.0) {
            return place;
        }
        place = (aisle_place){place.piece + 1U, 0.0};
    }
}

double aisle_motion_speed(const aisle_vehicle *vehicle, const aisle_waypoint_msg *w, uint32_t n, const float *dwell,
                          aisle_place place) {
    AISLE_ASSERT(aisle_place_exists(n, place));
    if (n == 1) {
        return 0.0;
    }
    const leg it = aisle_motion_leg_of(vehicle, w, dwell, place.piece);
    return it.on_spot ? 0.0 : leg_speed(&it, place.u);
}

double aisle_motion_time(const aisle_vehicle *vehicle, const aisle_waypoint_msg *w, uint32_t n, const float *dwell,
                         aisle_place place) {
    AISLE_ASSERT(aisle_place_exists(n, place));
    if (n == 1 || place.u >= 1.0) {
        return (double)w[place.piece].t;
    }
    const leg it = aisle_motion_leg_of(vehicle, w, dwell, place.piece);
    return (double)it.from->t + it.rest + leg_time(&it, place.u);
}

aisle_place aisle_motion_at_time(const aisle_vehicle *vehicle, const aisle_waypoint_msg *w, uint32_t n,
                                 const float *dwell, double t) {
    AISLE_ASSERT(n >= 1);
    if (n == 1) {
        return (aisle_place){0, 0.0};
    }
    uint32_t low = 0, high = n - 1; // waypoint low is reached by t, if any is; the one behind high is not
    while (low < high) {
        const uint32_t middle = low + (high - low + 1U) / 2U;
        if ((double)w[middle].t <= t) {
            low = middle;
        } else {
            high = middle - 1U;
        }
    }
    if (low + 1U == n) {
        return (aisle_place){low, 1.0};
    }
    const leg it = aisle_motion_leg_of(vehicle, w, dwell, low + 1U);
    const double moving = t - (double)it.from->t - it.rest;
    if (moving < 0.0) {
        return low == 0 ? (aisle_place){1, 0.0} : (aisle_place){low, 1.0};
    }
    return (aisle_place){low + 1U, leg_at(&it, moving)};
}

// ---- projection

typedef struct found { // a place that may be the nearest
    aisle_place place;
    double off;  // m, heading weighed in
    double back; // m that it lies before `from`, turns weighed in
} found;

static double off_of(const aisle_waypoint_msg *w, uint32_t n, aisle_place place, aisle_pose2 pose) {
    const aisle_pose2 at = aisle_motion_pose(w, n, place);
    const double heading = AISLE_MOTION_LEVER * aisle_angle_difference(at.theta, pose.theta);
    return aisle_vec2_length(
        aisle_vec2_of(aisle_vec2_distance(aisle_vec2_of(at.x, at.y), aisle_vec2_of(pose.x, pose.y)), heading));
}

// The part of a line or arc where it is nearest to p, in [0, 1]. Of an arc by the angle seen from its centre between its
// middle m and p: tan = x |k| / (1 - y k) with x along and y left of the tangent at m, good for whatever k.
static double nearest_part(const aisle_waypoint_msg *from, const aisle_waypoint_msg *to, aisle_vec2 p) {
    const aisle_pose2 middle = aisle_piece_at(from, to, 0.5);
    const aisle_vec2 chord = aisle_vec2_of(to->x - from->x, to->y - from->y);
    const double size = aisle_vec2_length(chord), k = (double)to->curvature, length = aisle_piece_length(from, to);
    const aisle_vec2 along = aisle_vec2_scale(chord, 1.0 / size), q = aisle_vec2_of(p.x - middle.x, p.y - middle.y);
    const double x = aisle_vec2_dot(q, along), y = aisle_vec2_cross(along, q);
    const double way = fabs(k) > 0.0 ? aisle_atan2(x * fabs(k), 1.0 - y * k) / fabs(k) : x;
    return aisle_clamp(0.5 + way / length, 0.0, 1.0);
}

// The part of a turn where its heading is nearest to theta: the middle's is within half a turn of all of it.
static double nearest_turn(const aisle_waypoint_msg *from, const aisle_waypoint_msg *to, double theta) {
    const double turn = aisle_piece_turn(from, to);
    return aisle_clamp(0.5 + aisle_angle_difference(from->theta + 0.5 * turn, theta) / turn, 0.0, 1.0);
}

// The nearest place of piece i within [lo, hi] of it.
static found nearest_in(const aisle_waypoint_msg *w, uint32_t n, uint32_t i, double lo, double hi, aisle_pose2 pose) {
    double u = lo; // of a wait
    if (!is_on_spot(&w[i - 1])) {
        u = nearest_part(&w[i - 1], &w[i], aisle_vec2_of(pose.x, pose.y));
    } else if (!is_wait(&w[i - 1], &w[i])) {
        u = nearest_turn(&w[i - 1], &w[i], pose.theta);
    }
    const aisle_place place = {i, aisle_clamp(u, lo, hi)};
    return (found){place, off_of(w, n, place, pose), 0.0};
}

// m of a piece, radians of a turn weighed in.
static double extent_of(const aisle_waypoint_msg *w, uint32_t i) {
    return is_on_spot(&w[i - 1]) ? AISLE_MOTION_LEVER * fabs(aisle_piece_turn(&w[i - 1], &w[i])) : length_of(w, i);
}

typedef struct search {
    const aisle_waypoint_msg *w;
    uint32_t n;
    aisle_place from;
    aisle_pose2 pose;
    found best;
    double barrier; // how far off the path gets since best, on the way in hand
} search;

// Passes waypoint `at`; false: the barrier is too high.
static bool pass(search *self, uint32_t at) {
    const aisle_place place = at == 0 ? (aisle_place){1, 0.0} : (aisle_place){at, 1.0};
    self->barrier = aisle_max(self->barrier, off_of(self->w, self->n, place, self->pose));
    return self->barrier <= self->best.off + AISLE_MOTION_BARRIER;
}

// Where no barrier lies before it, the nearer one of the two is in the same valley.
static bool is_better(const search *self, const found *it) {
    const double height = self->barrier - self->best.off, wanted = BARRIER_SHARE * height;
    if (!(height > 0.0)) {
        return it->off < self->best.off;
    }
    return it->off <= self->best.off + wanted &&
           it->off + BACK_COST * it->back + wanted < self->best.off + BACK_COST * self->best.back;
}

static void consider(search *self, found it) {
    if (is_better(self, &it)) {
        self->best = it;
        self->barrier = it.off;
    }
}

static void search_ahead(search *self, double ahead) {
    self->barrier = self->best.off;
    ahead -= (1.0 - self->from.u) * length_of(self->w, self->from.piece);
    for (uint32_t i = self->from.piece + 1U; i < self->n && ahead >= 0.0 && pass(self, i - 1U); i++) {
        const double length = length_of(self->w, i);
        const double hi = ahead < length ? ahead / length : 1.0;
        consider(self, nearest_in(self->w, self->n, i, 0.0, hi, self->pose));
        ahead -= length;
    }
}

static void search_back(search *self, double back) {
    double passed = self->from.u * extent_of(self->w, self->from.piece);
    self->barrier = self->best.off;
    back -= self->from.u * length_of(self->w, self->from.piece);
    for (uint32_t i = self->from.piece - 1U; i >= 1 && back >= 0.0 && pass(self, i); i--) {
        const double length = length_of(self->w, i), extent = extent_of(self->w, i);
        const double lo = back < length ? 1.0 - back / length : 0.0;
        found it = nearest_in(self->w, self->n, i, lo, 1.0, self->pose);
        it.back = passed + (1.0 - it.place.u) * extent;
        consider(self, it);
        passed += extent;
        back -= length;
    }
}

static found search_here(const search *self, double back, double ahead) {
    const aisle_place from = self->from;
    if (is_wait(&self->w[from.piece - 1], &self->w[from.piece])) {
        return (found){from, off_of(self->w, self->n, from, self->pose), 0.0};
    }
    const double length = length_of(self->w, from.piece);
    const double lo = from.u * length > back ? from.u - back / length : 0.0;
    const double hi = (1.0 - from.u) * length > ahead ? from.u + ahead / length : 1.0;
    found it = nearest_in(self->w, self->n, from.piece, aisle_clamp(lo, 0.0, from.u), aisle_clamp(hi, from.u, 1.0),
                          self->pose);
    it.back = aisle_max(from.u - it.place.u, 0.0) * extent_of(self->w, from.piece);
    return it;
}

aisle_place aisle_motion_project(const aisle_waypoint_msg *w, uint32_t n, aisle_place from, double back, double ahead,
                                 aisle_pose2 pose, aisle_off *off) {
    AISLE_ASSERT(aisle_place_exists(n, from) && back >= 0.0 && ahead >= 0.0);
    AISLE_ASSERT(isfinite(pose.x) && isfinite(pose.y) && fabs(pose.theta) <= AISLE_ANGLE_MAX);
    search it = {.w = w, .n = n, .from = from, .pose = pose, .best = {from, 0.0, 0.0}};
    if (n > 1) {
        it.best = search_here(&it, back, ahead);
        search behind = it;
        search_ahead(&it, ahead);
        search_back(&behind, back);
        const bool found_ahead = it.best.place.piece != from.piece;
        if (!found_ahead || behind.best.off + BACK_COST * behind.best.back < it.best.off) {
            it = behind;
        }
    }
    if (off != NULL) {
        const aisle_pose2 at = aisle_motion_pose(w, n, it.best.place);
        off->lateral = aisle_vec2_distance(aisle_vec2_of(at.x, at.y), aisle_vec2_of(pose.x, pose.y));
        off->heading = aisle_angle_difference(at.theta, pose.theta);
    }
    return it.best.place;
}

// ---- cutting

typedef struct cutting {
    aisle_waypoint_msg *out;
    uint32_t n, capacity;
    double s; // m, in double
    bool overflow;
} cutting;

static void append(cutting *self, aisle_waypoint_msg w, double length, double t) {
    if (self->n >= self->capacity) {
        self->overflow = true;
        return;
    }
    self->s += length;
    w.s = (float)self->s;
    w.t = aisle_float_above(t);
    if (self->n > 0 && !(w.t > self->out[self->n - 1U].t)) {
        w.t = aisle_float_next(self->out[self->n - 1U].t, 1);
    }
    self->out[self->n++] = w;
}

// What is left of the piece counts as nothing?
static bool is_spent(const leg *it, double u) {
    const double left = (1.0 - u) * (it->parts > 0 ? it->way : it->time);
    return left < (it->parts > 0 ? AISLE_MOTION_SNAP : AISLE_PROFILE_TIME_STEP);
}

static int16_t reverse_of(const aisle_waypoint_msg *w) {
    return (int16_t)(w->flags & AISLE_WAYPOINT_REVERSE);
}

// The first waypoint where the cut is at waypoint i; left: it is behind, and its goal with it.
static aisle_waypoint_msg first_at(const aisle_waypoint_msg *w, uint32_t n, uint32_t i, bool left) {
    aisle_waypoint_msg first = w[i];
    const bool last = i + 1U == n;
    int flags = first.flags & (AISLE_WAYPOINT_STOP | AISLE_WAYPOINT_TURN_IN_PLACE | AISLE_WAYPOINT_GOAL);
    if (left) {
        flags = has(&first, AISLE_WAYPOINT_TURN_IN_PLACE) ? AISLE_WAYPOINT_STOP | AISLE_WAYPOINT_TURN_IN_PLACE : 0;
        first.goal_id = 0;
    }
    first.flags = (int16_t)(flags | (last ? 0 : reverse_of(&w[i + 1U])));
    if (!last) {
        first.clearance = w[i + 1U].clearance;
    }
    first.s = first.t = first.a = first.curvature = 0.0F;
    return first;
}

static aisle_waypoint_msg between(const leg *it, double u, double v) {
    aisle_waypoint_msg part = aisle_piece_part(it->to, u);
    part.v = aisle_float_below(v);
    return part;
}

// Appends the end of a part of a trapezoid, `length` m behind the last waypoint.
static void append_part(cutting *self, const aisle_vehicle *vehicle, aisle_waypoint_msg end, double length, double t) {
    const double v0 = self->n > 0 ? (double)self->out[self->n - 1U].v : 0.0, v1 = (double)end.v;
    end.a = (float)aisle_clamp((v1 * v1 - v0 * v0) / (2.0 * length), -vehicle->d_max, vehicle->a_max);
    append(self, end, length, t);
}

// The rest of a driven piece from u on.
static void cut_drive(cutting *self, const aisle_vehicle *vehicle, const leg *it, double u) {
    const double v = leg_speed(it, u), t0 = leg_time(it, u);
    aisle_waypoint_msg first = between(it, u, v);
    first.curvature = 0.0F;
    append(self, first, 0.0, 0.0);
    if (it->parts == 1 || is_at_rest(v)) {
        append(self, *it->to, (1.0 - u) * it->way, it->time - t0);
        return;
    }
    double way, at = u;
    uint32_t k = find_phase(it, u, &way);
    double next = u + (it->part[k].way - way) / it->way;
    while (k + 1U < it->parts) {
        if ((next - at) * it->way >= AISLE_MOTION_SNAP && (1.0 - next) * it->way >= AISLE_MOTION_SNAP) {
            append_part(self, vehicle, between(it, next, it->part[k].v1), (next - at) * it->way,
                        leg_time(it, next) - t0);
            at = next;
        }
        next += it->part[++k].way / it->way;
    }
    append_part(self, vehicle, *it->to, (1.0 - at) * it->way, it->time - t0);
}

// The rest of a turn or wait from u on; returns how much longer it takes than it would have.
static double cut_turn(cutting *self, const aisle_vehicle *vehicle, const leg *it, double u) {
    aisle_waypoint_msg first = between(it, u, 0.0);
    first.curvature = 0.0F;
    first.flags = AISLE_WAYPOINT_STOP | AISLE_WAYPOINT_TURN_IN_PLACE;
    const double left = it->time - leg_time(it, u);
    double anew = left, peak;
    if (it->parts > 0) {
        const double way = (1.0 - u) * it->way;
        anew = aisle_rest_to_rest(way, vehicle->omega_max, vehicle->alpha_max, vehicle->alpha_max, &peak);
        anew = aisle_max(anew, AISLE_PROFILE_TIME_STEP);
    }
    append(self, first, 0.0, 0.0);
    append(self, *it->to, 0.0, anew);
    return anew - left;
}

uint32_t aisle_motion_cut(const aisle_vehicle *vehicle, const aisle_waypoint_msg *w, uint32_t n, const float *dwell,
                          aisle_place place, aisle_waypoint_msg *out, uint32_t capacity) {
    AISLE_ASSERT(aisle_place_exists(n, place) && w != out);
    cutting cut = {.out = out, .capacity = capacity};
    double t0 = (double)w[place.piece].t; // in w, what is 0 in out
    if (n > 1) {
        const leg it = aisle_motion_leg_of(vehicle, w, dwell, place.piece);
        const bool leaves = place.u <= 0.0;
        if (leaves || is_spent(&it, place.u)) {
            const uint32_t i = leaves ? place.piece - 1U : place.piece;
            t0 = leaves ? (double)it.from->t + it.rest : t0;
            append(&cut, first_at(w, n, i, leaves), 0.0, 0.0);
            place.piece = i;
        } else {
            t0 = (double)it.from->t + it.rest + leg_time(&it, place.u);
            if (it.on_spot) {
                t0 -= cut_turn(&cut, vehicle, &it, place.u);
            } else {
                cut_drive(&cut, vehicle, &it, place.u);
            }
        }
    } else {
        append(&cut, first_at(w, n, 0, false), 0.0, 0.0);
    }
    for (uint32_t i = place.piece + 1U; i < n && !cut.overflow; i++) {
        append(&cut, w[i], length_of(w, i), (double)w[i].t - t0);
    }
    return cut.overflow ? 0 : cut.n;
}

void aisle_motion_cut_dwell(const float *dwell, uint32_t n, aisle_place place, uint32_t left, float *out) {
    AISLE_ASSERT(aisle_place_exists(n, place));
    for (uint32_t i = 0; i < left; i++) { // counted from the end: the last ones are the same
        const bool is_old = left - i <= n - place.piece;
        out[i] = is_old && dwell != NULL ? dwell[n - (left - i)] : 0.0F;
    }
}

// ---- braking

typedef struct driving { // a vehicle on its way to rest
    aisle_place place;
    double v;    // m/s
    double left; // s until it brakes
} driving;

// Drives one phase, `way` of which is behind, at its own speed or, while that is more, braking. True: to its end.
static bool drive_phase(driving *self, const phase *p, double way, double brake, double *made) {
    const double ahead = p->way - way, path = phase_speed(p, way), v2 = self->v * self->v;
    const double slope = (p->v1 * p->v1 - p->v0 * p->v0) / p->way; // of the path's v^2
    double meets = 0.0;                                            // m, where it has braked down to the path's speed
    if (self->v > path) {
        const double closing = slope + 2.0 * brake;
        meets = closing > 0.0 ? aisle_min((v2 - path * path) / closing, ahead) : ahead;
    }
    const phase braking = {meets, self->v, sqrt(aisle_max(v2 - 2.0 * brake * meets, 0.0))};
    const double first = phase_time(&braking);
    if (self->left < first) {
        *made = phase_way(&braking, self->left);
        self->v -= brake * self->left;
        return false;
    }
    self->left -= first;
    const double from = meets > 0.0 ? phase_speed(p, way + meets) : path;
    const phase along = {ahead - meets, from, p->v1};
    const double second = phase_time(&along);
    if (self->left < second) {
        *made = meets + phase_way(&along, self->left);
        self->v = phase_speed(p, aisle_min(way + *made, p->way));
        self->left = 0.0;
        return false;
    }
    self->left -= second;
    self->v = ahead > meets ? p->v1 : aisle_max(p->v1, braking.v1);
    return true;
}

static double drive_leg_way(driving *self, const leg *it, double brake) {
    double way, total = self->place.u * it->way;
    uint32_t k = find_phase(it, self->place.u, &way);
    for (; k < it->parts; k++) {
        double made = it->part[k].way - way;
        const bool to_end = drive_phase(self, &it->part[k], way, brake, &made);
        total += made;
        if (!to_end) {
            self->left = 0.0;
            return aisle_min(total / it->way, 1.0);
        }
        way = 0.0;
    }
    return 1.0;
}

// A turn or wait: rests when the brakes of the turn have worked.
static double turn_leg_way(driving *self, const leg *it, double brake) {
    const double begun = leg_time(it, self->place.u);
    if (self->left >= it->time - begun) {
        self->left -= it->time - begun;
        return 1.0;
    }
    const double u = leg_at(it, begun + self->left);
    const double rate = leg_speed(it, u);
    self->left = 0.0;
    return it->parts == 0 ? u : aisle_min(u + 0.5 * rate * rate / (brake * it->way), 1.0);
}

// Must it rest at waypoint i?
static bool rests_at(const aisle_waypoint_msg *w, uint32_t n, uint32_t i) {
    return i + 1U >= n || is_at_rest((double)w[i].v);
}

static aisle_place brake_along(const aisle_waypoint_msg *w, uint32_t n, driving it, double brake) {
    double metres = 0.5 * it.v * it.v / brake;
    for (;;) {
        const double length = length_of(w, it.place.piece), ahead = (1.0 - it.place.u) * length;
        if (metres < ahead) {
            return (aisle_place){it.place.piece, aisle_min(it.place.u + metres / length, 1.0)};
        }
        metres -= ahead;
        it.place.u = 1.0;
        if (metres <= 0.0 || rests_at(w, n, it.place.piece)) {
            return it.place;
        }
        it.place = (aisle_place){it.place.piece + 1U, 0.0};
    }
}

aisle_place aisle_motion_rest(const aisle_vehicle *vehicle, const aisle_waypoint_msg *w, uint32_t n, const float *dwell,
                              aisle_place place, double v, double delay) {
    AISLE_ASSERT(aisle_place_exists(n, place) && v >= 0.0 && delay >= 0.0);
    if (n == 1) {
        return place;
    }
    driving it = {place, aisle_max(v, aisle_motion_speed(vehicle, w, n, dwell, place)), delay};
    bool arrived = place.u >= 1.0;
    for (;;) {
        if (arrived && it.place.piece + 1U == n) {
            return it.place;
        }
        if (arrived && (it.left > 0.0)) {
            const leg next = aisle_motion_leg_of(vehicle, w, dwell, it.place.piece + 1U);
            if (it.left < next.rest) {
                return it.place;
            }
            it.left -= next.rest;
            it.place = (aisle_place){it.place.piece + 1U, 0.0};
        }
        const leg here = aisle_motion_leg_of(vehicle, w, dwell, it.place.piece);
        const double brake = here.on_spot ? vehicle->alpha_max : vehicle->d_max;
        it.place.u = here.on_spot ? turn_leg_way(&it, &here, brake) : drive_leg_way(&it, &here, brake);
        arrived = it.place.u >= 1.0;
        if (arrived && rests_at(w, n, it.place.piece)) {
            it.v = 0.0;
        }
        if (!(it.left > 0.0)) {
            return here.on_spot ? it.place : brake_along(w, n, it, vehicle->d_max);
        }
    }
}
