#include "plan/taut.h"

#include "base/angle.h"
#include "base/check.h"
#include "plan/cost.h"
#include "plan/zones.h"

#include <math.h>
#include <string.h>

#define RESOLUTION 5e-4   // m, of a slide
#define EXACT_SPACING 0.4 // m
#define EXACT_PASSES 3U
#define SHIFT 0.16       // m, the first of a shift's steps, which are halved; the field tells no finer ones than
#define SHIFT_FIELD 0.03 // m, than this; by exact gaps they begin and end at
#define SHIFT_EXACT 0.04 // m
#define SHIFT_LAST 0.004 // m
#define SETTLED 2e-4     // of the cost, where it is not the length: a pass that gains less is the last
#define POINT_MOVES_UNITS 8U
#define MERGE 0.05 // m, see merge_near()

void aisle_taut_start(aisle_taut *self, const aisle_space *space, const aisle_objective *objective, double arc_radius,
                      aisle_vec2 *points, uint32_t count, uint32_t capacity) {
    AISLE_ASSERT(count >= 2 && count <= capacity);
    *self = (aisle_taut){.space = space,
                         .objective = objective,
                         .points = points,
                         .count = count,
                         .capacity = capacity,
                         .at = 1,
                         .arc_radius = arc_radius,
                         .cost = -1.0};
}

// The leg's cost by exact gaps of the body, every EXACT_SPACING; or what shows that it is above `most`, since no metre
// costs less than one.
static double exact_leg_cost(aisle_taut *self, aisle_vec2 a, aisle_vec2 b, double most) {
    const aisle_vehicle *vehicle = self->space->vehicle;
    double cap = aisle_max(vehicle->creep_clearance, self->space->keep); // no objective cares for more
    double length = aisle_vec2_distance(a, b);
    double samples = floor(length / EXACT_SPACING) + 2.0;
    double toll = aisle_zones_toll(self->space->layout, self->objective, a, b);
    most -= toll;
    double theta = aisle_atan2(b.y - a.y, b.x - a.x);
    double sum = samples;                                                    // each at least 1
    double enough = most * (1.0 + 1e-9) * samples / aisle_max(length, 1e-9); // 1e-9: more than rounding
    for (double i = 0.5; i < samples && sum <= enough; i += 1.0) {
        aisle_vec2 p = aisle_vec2_lerp(a, b, i / samples);
        double clearance = cap;
        if (aisle_grid_gap_lower(self->space->grid, p) - vehicle->outer_radius < cap) {
            clearance = aisle_space_gap(self->space, (aisle_pose2){p.x, p.y, theta}, cap, NULL);
            self->units++;
        }
        sum += aisle_objective_density(self->objective, clearance, 0.0) - 1.0;
    }
    return sum * length / samples + toll;
}

static uint32_t slot_of(aisle_vec2 a, aisle_vec2 b) {
    const double key[4] = {a.x, a.y, b.x, b.y};
    uint64_t hash = 0;
    for (uint32_t i = 0; i < 4U; i++) {
        uint64_t bits;
        memcpy(&bits, &key[i], sizeof bits);
        hash = (hash ^ bits) * 0x9E3779B97F4A7C15ULL;
        hash ^= hash >> 29U;
    }
    return (uint32_t)(hash >> 16U) % AISLE_TAUT_KNOWN;
}

// The cost of the leg if it is at most `most`, else something above that. The same legs are asked for again and again.
static double leg_cost_within(aisle_taut *self, aisle_vec2 a, aisle_vec2 b, double most) {
    if (aisle_objective_is_length(self->objective)) {
        return aisle_vec2_distance(a, b);
    }
    aisle_taut_known *known = &self->known[slot_of(a, b)]; // all zero is true too
    if (known->a.x == a.x && known->a.y == a.y && known->b.x == b.x && known->b.y == b.y) {
        return known->cost;
    }
    double cost = self->exact ? exact_leg_cost(self, a, b, most)
                              : aisle_leg_cost(self->space, self->objective, a, b, &self->units);
    if (cost <= most) {
        *known = (aisle_taut_known){a, b, cost};
    }
    return cost;
}

static double leg_cost(aisle_taut *self, aisle_vec2 a, aisle_vec2 b) {
    return leg_cost_within(self, a, b, (double)INFINITY);
}

// Length an arc saves at the corner a-b-c.
static double arc_saving(const aisle_taut *self, aisle_vec2 a, aisle_vec2 b, aisle_vec2 c) {
    aisle_vec2 u = aisle_vec2_sub(b, a);
    aisle_vec2 v = aisle_vec2_sub(c, b);
    double lu = aisle_vec2_length(u);
    double lv = aisle_vec2_length(v);
    double turn = fabs(aisle_atan2(aisle_vec2_cross(u, v), aisle_vec2_dot(u, v)));
    if (turn < 1e-6 || turn > 3.0) {
        return 0.0;
    }
    double sine, cosine;
    aisle_sincos(0.5 * turn, &sine, &cosine);
    double tan_half = sine / cosine; // turn <= 3.0: cosine >= 0.07
    double cut = aisle_min(self->arc_radius * tan_half, 0.5 * aisle_min(lu, lv));
    return cut * (2.0 - turn / tan_half);
}

static double point_saving(const aisle_taut *self, uint32_t i) {
    if (i == 0 || i + 1U >= self->count) {
        return 0.0;
    }
    return arc_saving(self, self->points[i - 1U], self->points[i], self->points[i + 1U]);
}

// Cost of everything that depends on the points first..last: the legs between them and the corners at and between them.
static double span_cost(aisle_taut *self, uint32_t first, uint32_t last) {
    double sum = 0.0;
    for (uint32_t i = first; i < last; i++) {
        sum += leg_cost(self, self->points[i], self->points[i + 1U]);
    }
    for (uint32_t i = first; i <= last; i++) {
        sum -= point_saving(self, i);
    }
    return sum;
}

static bool free_between(aisle_taut *self, aisle_vec2 a, aisle_vec2 b) {
    return aisle_space_sweep_free(self->space, a, b, &self->units);
}

// May a corner be put at p? A body held along its motion must be able to turn there.
static bool may_turn(aisle_taut *self, aisle_vec2 p) {
    return self->space->mode == AISLE_SPACE_FREE_TURN || aisle_space_turn_free(self->space, p, &self->units);
}

static void delete_point(aisle_taut *self, uint32_t i) {
    for (uint32_t k = i; k + 1U < self->count; k++) {
        self->points[k] = self->points[k + 1U];
    }
    self->count--;
}

static void insert_point(aisle_taut *self, uint32_t i, aisle_vec2 p) {
    AISLE_ASSERT(self->count < self->capacity);
    for (uint32_t k = self->count; k > i; k--) {
        self->points[k] = self->points[k - 1U];
    }
    self->points[i] = p;
    self->count++;
}

static bool try_remove(aisle_taut *self, uint32_t i) {
    aisle_vec2 a = self->points[i - 1U];
    aisle_vec2 b = self->points[i];
    aisle_vec2 c = self->points[i + 1U];
    if (!aisle_objective_is_length(self->objective) &&
        leg_cost(self, a, c) > leg_cost(self, a, b) + leg_cost(self, b, c) - arc_saving(self, a, b, c)) {
        return false;
    }
    if (!free_between(self, a, c)) {
        return false;
    }
    delete_point(self, i);
    return true;
}

// Farthest fraction of the way from b to `anchor` at which the leg to `other` stays free.
static double slide_limit(aisle_taut *self, aisle_vec2 b, aisle_vec2 anchor, aisle_vec2 other, bool outbound) {
    double good = 0.0;
    double bad = 1.0;
    double stop = RESOLUTION / aisle_max(aisle_vec2_distance(b, anchor), RESOLUTION);
    while (bad - good > stop) {
        double t = 0.5 * (good + bad);
        aisle_vec2 p = aisle_vec2_lerp(b, anchor, t);
        if (may_turn(self, p) && (outbound ? free_between(self, p, other) : free_between(self, other, p))) {
            good = t;
        } else {
            bad = t;
        }
    }
    return good;
}

// Length only: slides point i towards neighbour `to` as far as the leg to the other neighbour allows.
static void slide_far(aisle_taut *self, uint32_t i, uint32_t to, uint32_t other) {
    aisle_vec2 b = self->points[i];
    double t = slide_limit(self, b, self->points[to], self->points[other], to < i);
    self->points[i] = aisle_vec2_lerp(b, self->points[to], t);
}

// Other densities: slides by a half, quarter, eighth, if that costs less.
static void slide_some(aisle_taut *self, uint32_t i, uint32_t to, uint32_t other) {
    aisle_vec2 b = self->points[i];
    double before = leg_cost(self, b, self->points[to]) + leg_cost(self, b, self->points[other]);
    for (double t = 0.5; t > 0.1; t *= 0.5) {
        aisle_vec2 p = aisle_vec2_lerp(b, self->points[to], t);
        double after = leg_cost_within(self, p, self->points[to], before);
        after += after < before ? leg_cost_within(self, p, self->points[other], before - after) : 0.0;
        bool outbound = to < i;
        if (after < before * (1.0 - AISLE_TAUT_GAIN) && may_turn(self, p) &&
            (outbound ? free_between(self, p, self->points[other]) : free_between(self, self->points[other], p))) {
            self->points[i] = p;
            return;
        }
    }
}

// Cost of the legs that points first..last have a part in, as leg_cost_within().
static double cost_about(aisle_taut *self, uint32_t first, uint32_t last, double most) {
    double sum = 0.0;
    for (uint32_t i = first - 1U; i <= last && sum <= most; i++) {
        sum += leg_cost_within(self, self->points[i], self->points[i + 1U], most - sum);
    }
    return sum;
}

static bool are_free_about(aisle_taut *self, uint32_t first, uint32_t last) {
    bool free = true;
    for (uint32_t i = first; free && i <= last; i++) {
        free = may_turn(self, self->points[i]);
    }
    for (uint32_t i = first - 1U; free && i <= last; i++) {
        free = free_between(self, self->points[i], self->points[i + 1U]);
    }
    return free;
}

// Other densities: moves points first..last together by `by`, if that costs less.
static bool try_shift(aisle_taut *self, uint32_t first, uint32_t last, aisle_vec2 by, double *cost) {
    for (uint32_t i = first; i <= last; i++) {
        self->points[i] = aisle_vec2_add(self->points[i], by);
    }
    double after = cost_about(self, first, last, *cost);
    if (after < *cost * (1.0 - AISLE_TAUT_GAIN) && are_free_about(self, first, last)) {
        *cost = after;
        return true;
    }
    for (uint32_t i = first; i <= last; i++) {
        self->points[i] = aisle_vec2_sub(self->points[i], by);
    }
    return false;
}

// Shifts across the way, to the middle between obstacles: a leg as a whole, or one corner.
static void shift_across(aisle_taut *self, uint32_t first, uint32_t last) {
    aisle_vec2 along = aisle_vec2_sub(self->points[last + 1U], self->points[first - 1U]);
    if (last > first) {
        along = aisle_vec2_sub(self->points[last], self->points[first]);
    }
    double length = aisle_vec2_length(along);
    if (length < 1e-6) {
        return;
    }
    aisle_vec2 across = aisle_vec2_of(-along.y / length, along.x / length);
    double cost = cost_about(self, first, last, (double)INFINITY);
    double last_step = self->exact ? SHIFT_LAST : SHIFT_FIELD;
    for (double step = self->exact ? SHIFT_EXACT : SHIFT; step > last_step; step *= 0.5) {
        if (!try_shift(self, first, last, aisle_vec2_scale(across, step), &cost)) {
            (void)try_shift(self, first, last, aisle_vec2_scale(across, -step), &cost);
        }
    }
}

// Replaces b by two points at the same fraction of both legs, as far out as the straight way between them is free.
static bool try_cut(aisle_taut *self, uint32_t i) {
    if (self->count >= self->capacity) {
        return false;
    }
    aisle_vec2 a = self->points[i - 1U];
    aisle_vec2 b = self->points[i];
    aisle_vec2 c = self->points[i + 1U];
    uint32_t from = i >= 2U ? i - 2U : 0U; // the neighbours' arcs change too
    double before = span_cost(self, from, i + 2U < self->count ? i + 2U : i + 1U);
    double good = 0.0;
    double bad = 1.0;
    for (int k = 0; k < 10; k++) {
        double t = 0.5 * (good + bad);
        aisle_vec2 p = aisle_vec2_lerp(b, a, t);
        aisle_vec2 q = aisle_vec2_lerp(b, c, t);
        if (may_turn(self, p) && may_turn(self, q) && free_between(self, p, q)) {
            good = t;
        } else {
            bad = t;
        }
    }
    if (good <= 0.0) {
        return false;
    }
    self->points[i] = aisle_vec2_lerp(b, a, good);
    insert_point(self, i + 1U, aisle_vec2_lerp(b, c, good));
    double after = span_cost(self, from, i + 3U < self->count ? i + 3U : i + 2U);
    if (after < before - aisle_max(1e-4, before * AISLE_TAUT_GAIN)) {
        return true;
    }
    delete_point(self, i + 1U);
    self->points[i] = b;
    return false;
}

static void shift_about(aisle_taut *self, uint32_t i) {
    shift_across(self, i, i);
    if (i + 2U < self->count) {
        shift_across(self, i, i + 1U);
    }
}

static void improve_point(aisle_taut *self, uint32_t i) {
    if (self->exact) {
        shift_about(self, i);
        self->at++;
        return;
    }
    if (try_remove(self, i)) {
        return;
    }
    if (aisle_objective_is_length(self->objective)) {
        slide_far(self, i, i - 1U, i + 1U);
        slide_far(self, i, i + 1U, i - 1U);
    } else {
        slide_some(self, i, i - 1U, i + 1U);
        slide_some(self, i, i + 1U, i - 1U);
        shift_about(self, i);
    }
    if (try_cut(self, i)) {
        self->at++;
    }
    self->at++;
}

// Where the lines a-b and d-c meet. False: nowhere near b.
static bool meeting_of(const aisle_vec2 *p, aisle_vec2 *out) {
    const aisle_vec2 u = aisle_vec2_sub(p[1], p[0]);
    const aisle_vec2 v = aisle_vec2_sub(p[2], p[3]);
    const double turn = aisle_vec2_cross(u, v);
    if (fabs(turn) < 1e-3 * aisle_vec2_length(u) * aisle_vec2_length(v)) {
        return false;
    }
    *out = aisle_vec2_add(p[0], aisle_vec2_scale(u, aisle_vec2_cross(aisle_vec2_sub(p[3], p[0]), v) / turn));
    return aisle_vec2_distance(*out, p[1]) <= MERGE;
}

// Slides end half a millimetre before a sharp corner, from either side: of two points there, too near to each other for
// arcs, one is made where their legs meet, if that is free.
static void merge_near(aisle_taut *self) {
    for (uint32_t i = 1; i + 2U < self->count; i++) {
        aisle_vec2 *p = &self->points[i - 1U];
        aisle_vec2 at;
        if (aisle_vec2_distance(p[1], p[2]) <= MERGE && meeting_of(p, &at) && may_turn(self, at) &&
            free_between(self, p[0], at) && free_between(self, at, p[3])) {
            p[1] = at;
            delete_point(self, i + 1U);
        }
    }
}

static aisle_status end(aisle_taut *self) {
    if (aisle_zones_any_directed(
            self->space->layout)) { // round obstacles a corner is an arc's, and two points are right
        merge_near(self);
    }
    return AISLE_OK;
}

// A pass has ended: another one, by exact gaps at last, or the end.
static aisle_status next_pass(aisle_taut *self) {
    double cost = span_cost(self, 0, self->count - 1U);
    double gain = aisle_objective_is_length(self->objective) ? AISLE_TAUT_GAIN : SETTLED;
    bool settled = self->cost >= 0.0 && self->cost - cost <= gain * cost;
    uint32_t most = self->exact ? EXACT_PASSES : AISLE_TAUT_PASSES;
    self->cost = cost;
    self->at = 1;
    self->pass++;
    if (!settled && self->pass < most && self->count > 2U) {
        return AISLE_BUSY;
    }
    if (self->exact || aisle_objective_is_length(self->objective) || self->count <= 2U) {
        return end(self);
    }
    self->exact = true;
    memset(self->known, 0, sizeof self->known); // by the field
    self->cost = -1.0;
    self->pass = 0;
    return AISLE_BUSY;
}

aisle_status aisle_taut_step(aisle_taut *self, uint32_t units, uint32_t *spent) {
    aisle_status st = AISLE_BUSY;
    while (st == AISLE_BUSY && self->units < units) {
        if (self->at + 1U < self->count) {
            improve_point(self, self->at);
            self->units += POINT_MOVES_UNITS;
        } else {
            st = next_pass(self);
        }
    }
    *spent += self->units;
    self->units = 0;
    return st;
}
