// What lines may meet, rejoining the old way, and tidying up.
#include "base/angle.h"
#include "base/check.h"
#include "plan/local_parts.h"

#include <math.h>

#define WAY_STEP 0.5  // m, between places of the old way looked at
#define TRIES_MAX 4U  // rejoining places whose rest is looked at
#define PASSES_MAX 6U // of tidying up
#define SPARE 1e-9    // m

static const aisle_vehicle *vehicle_of(const aisle_local *self) {
    return self->request.space->vehicle;
}

// The body at p with its heading towards `ahead`, as the lines take it.
static aisle_convex body_at(const aisle_local *self, aisle_vec2 p, double theta, aisle_vec2 *v) {
    const aisle_vehicle *vehicle = vehicle_of(self);
    if (self->request.space->mode == AISLE_SPACE_ALONG) {
        return aisle_vehicle_place(vehicle, (aisle_pose2){p.x, p.y, theta}, 0.0, v);
    }
    v[0] = p;
    return (aisle_convex){v, 1U, vehicle->outer_radius};
}

void aisle_local_take_movers(aisle_local *self) {
    const aisle_local_request *r = &self->request;
    const double drift = r->drift > 0.0 ? r->drift : AISLE_LOCAL_DRIFT;
    aisle_vec2 v[AISLE_SHAPE_VERTICES_MAX];
    const aisle_convex body = body_at(self, r->from, r->heading, v);
    self->movers = 0;
    self->believed = 0.0;
    for (uint32_t i = 0; r->movers != NULL && i < r->movers->count; i++) {
        const aisle_mover *m = &r->movers->mover[i];
        const double speed = aisle_vec2_length(m->velocity);
        const double keep = m->radius + AISLE_MOVERS_SIGMAS * m->sigma + r->space->keep + r->safety;
        const aisle_vec2 at = aisle_mover_predicted(m, r->from_us, NULL);
        const double now = aisle_max(aisle_convex_point_gap(&body, at) - SPARE, 0.0);
        const bool stands = speed < AISLE_LOCAL_STANDING;
        self->mover[self->movers++] = (aisle_local_mover){.at = at,
                                                          .velocity = stands ? (aisle_vec2){0.0, 0.0} : m->velocity,
                                                          .keep = aisle_min(keep, now),
                                                          .until = stands ? (double)INFINITY : drift / speed,
                                                          .id = m->id,
                                                          .closed = stands};
        self->believed = stands ? self->believed : aisle_max(self->believed, drift / speed);
    }
}

void aisle_local_list_near(aisle_local *self, aisle_vec2 p, double when) {
    const double range = (double)self->hi[0];
    const double reach = range + vehicle_of(self)->outer_radius, lasts = range / self->request.speed;
    self->nears = 0;
    for (uint32_t i = 0; i < self->movers; i++) {
        const aisle_local_mover *m = &self->mover[i];
        const aisle_vec2 at = aisle_vec2_add(m->at, aisle_vec2_scale(m->velocity, when));
        const double moves = aisle_vec2_length(m->velocity) * lasts;
        if (when <= m->until && aisle_vec2_distance(at, p) <= reach + m->keep + moves) {
            self->near[self->nears++] = (uint16_t)i;
        }
    }
}

// Is p less than `radius` from the segment from a along `way`? As aisle_segment_gap tells, without its root.
static bool segment_is_near(aisle_vec2 p, aisle_vec2 a, aisle_vec2 way, double radius) {
    const aisle_vec2 to = aisle_vec2_sub(p, a);
    const double square = aisle_vec2_dot(way, way);
    const double t = square > 0.0 ? aisle_clamp(aisle_vec2_dot(to, way) / square, 0.0, 1.0) : 0.0;
    const aisle_vec2 off = aisle_vec2_sub(to, aisle_vec2_scale(way, t));
    return aisle_vec2_dot(off, off) < radius * radius;
}

// In the frame that moves with the body the mover goes along a segment.
static bool meets(const aisle_local *self, const aisle_local_mover *m, const aisle_convex *body, aisle_vec2 way,
                  double when) {
    const double length = aisle_vec2_length(way), lasts = length / self->request.speed;
    if (when > m->until) {
        return false;
    }
    const double share = when + lasts > m->until ? (m->until - when) / lasts : 1.0;
    const aisle_vec2 from = aisle_vec2_add(m->at, aisle_vec2_scale(m->velocity, when));
    const aisle_vec2 moved = aisle_vec2_sub(aisle_vec2_scale(m->velocity, lasts), way);
    const aisle_vec2 ends[2] = {from, aisle_vec2_add(from, aisle_vec2_scale(moved, share))};
    if (body->n == 1U) {
        return segment_is_near(body->v[0], from, aisle_vec2_scale(moved, share), m->keep + body->radius);
    }
    const aisle_convex segment = {ends, 2U, 0.0};
    return aisle_convex_gap(body, &segment) < m->keep;
}

uint32_t aisle_local_meets(const aisle_local *self, aisle_vec2 a, aisle_vec2 b, double when, bool listed) {
    const aisle_vec2 way = aisle_vec2_sub(b, a);
    const uint32_t n = listed ? self->nears : self->movers;
    aisle_vec2 v[AISLE_SHAPE_VERTICES_MAX];
    if (n == 0U) {
        return AISLE_LOCAL_NOBODY;
    }
    const aisle_convex body = body_at(self, a, aisle_atan2(way.y, way.x), v);
    for (uint32_t i = 0; i < n; i++) {
        const uint32_t k = listed ? self->near[i] : i;
        if (meets(self, &self->mover[k], &body, way, when)) {
            return k;
        }
    }
    return AISLE_LOCAL_NOBODY;
}

// ALONG: the body turns at the points.
static bool may_turn(aisle_local *self, aisle_vec2 a, aisle_vec2 b) {
    const aisle_local_request *r = &self->request;
    if (r->space->mode != AISLE_SPACE_ALONG) {
        return true;
    }
    if (aisle_vec2_distance(a, r->from) > 0.0) {
        return aisle_space_turn_free(r->space, a, &self->units);
    }
    const double off = aisle_angle_wrap(aisle_atan2(b.y - a.y, b.x - a.x) - r->heading);
    return self->turns_at_from || fabs(off) <= AISLE_LOCAL_STRAIGHT;
}

bool aisle_local_line_free(aisle_local *self, aisle_vec2 a, aisle_vec2 b, double when, bool listed) {
    self->units += 1U;
    self->lines++;
    return aisle_local_meets(self, a, b, when, listed) == AISLE_LOCAL_NOBODY && may_turn(self, a, b) &&
           aisle_space_sweep_free(self->request.space, a, b, &self->units);
}

// ---- the old way

uint32_t aisle_local_way_meets(const aisle_local *self, aisle_vec2 c, uint32_t first, double when) {
    const aisle_local_request *r = &self->request;
    for (uint32_t i = first; i < r->way_count; i++) {
        const double length = aisle_vec2_distance(c, r->way[i]);
        if (length > 0.0 && aisle_local_meets(self, c, r->way[i], when, false) != AISLE_LOCAL_NOBODY) {
            return i;
        }
        when += length / r->speed;
        c = r->way[i];
    }
    return r->way_count;
}

// Farthest place on way[i - 1] way[i], looked at from its end, in range and in sight of p.
static bool sees_piece(aisle_local *self, aisle_vec2 p, double when, uint32_t i, aisle_vec2 *at) {
    const aisle_vec2 a = self->request.way[i - 1U], b = self->request.way[i];
    const double range = (double)self->hi[0], length = aisle_vec2_distance(a, b);
    if (aisle_segment_gap(a, b, p, p) > range) {
        return false;
    }
    for (double s = length; s >= 0.0; s -= WAY_STEP) {
        *at = length > 0.0 ? aisle_vec2_lerp(a, b, s / length) : b;
        const double far = aisle_vec2_distance(p, *at);
        if (far <= range && far > 1e-6 && aisle_local_line_free(self, p, *at, when, true)) {
            return true;
        }
    }
    return false;
}

bool aisle_local_find_rejoin(aisle_local *self, aisle_vec2 p, double when, aisle_vec2 *at, uint32_t *first) {
    const aisle_local_request *r = &self->request;
    uint32_t tries = 0, past = 1; // pieces before `past` are known to lead into a mover
    for (uint32_t i = r->way_count; i-- > past && tries < TRIES_MAX;) {
        if (!sees_piece(self, p, when, i, at)) {
            continue;
        }
        tries++;
        *first = i;
        const uint32_t met = aisle_local_way_meets(self, *at, i, when + aisle_vec2_distance(p, *at) / r->speed);
        self->units += r->way_count - i;
        if (met == r->way_count) {
            return true;
        }
        past = met; // what lies before that leads into it as well
    }
    return false;
}

// ---- tidying up

static double time_at(const aisle_local *self, uint32_t i) {
    double s = 0.0;
    for (uint32_t k = 1; k <= i; k++) {
        s += aisle_vec2_distance(self->points[k - 1U], self->points[k]);
    }
    return s / self->request.speed;
}

// From points[i] on, now passed at other times: do moving movers stay off?
static bool rest_keeps(aisle_local *self, uint32_t i) {
    double when = time_at(self, i);
    for (; i + 1U < self->count && when <= self->believed; i++) {
        self->units += 1U;
        if (aisle_local_meets(self, self->points[i], self->points[i + 1U], when, false) != AISLE_LOCAL_NOBODY) {
            return false;
        }
        when += aisle_vec2_distance(self->points[i], self->points[i + 1U]) / self->request.speed;
    }
    return true;
}

static void remove_point(aisle_local *self, uint32_t i) {
    for (uint32_t k = i; k + 1U < self->count; k++) {
        self->points[k] = self->points[k + 1U];
    }
    self->count--;
    self->fresh--;
}

static void insert_point(aisle_local *self, uint32_t i, aisle_vec2 p) {
    for (uint32_t k = self->count; k > i; k--) {
        self->points[k] = self->points[k - 1U];
    }
    self->points[i] = p;
    self->count++;
    self->fresh++;
}

static bool leave_out(aisle_local *self, uint32_t i) {
    const aisle_vec2 p = self->points[i];
    if (!aisle_local_line_free(self, self->points[i - 1U], self->points[i + 1U], time_at(self, i - 1U), false)) {
        return false;
    }
    remove_point(self, i);
    if (rest_keeps(self, i)) {
        return true;
    }
    insert_point(self, i, p);
    return false;
}

static bool move_point(aisle_local *self, uint32_t i, aisle_vec2 to) {
    const aisle_vec2 p = self->points[i], a = self->points[i - 1U], c = self->points[i + 1U];
    const double gain =
        aisle_vec2_distance(a, p) + aisle_vec2_distance(p, c) - aisle_vec2_distance(a, to) - aisle_vec2_distance(to, c);
    const double when = time_at(self, i - 1U);
    if (gain < 1e-4 || !aisle_local_line_free(self, a, to, when, false) ||
        !aisle_local_line_free(self, to, c, when + aisle_vec2_distance(a, to) / self->request.speed, false)) {
        return false;
    }
    self->points[i] = to;
    if (rest_keeps(self, i + 1U)) {
        return true;
    }
    self->points[i] = p;
    return false;
}

// Towards the chord of its neighbours, and along both lines.
static bool pull_in(aisle_local *self, uint32_t i) {
    bool moved = false;
    for (double f = 0.75; f > 0.01; f *= 0.5) {
        const aisle_vec2 p = self->points[i], a = self->points[i - 1U], c = self->points[i + 1U];
        moved = move_point(self, i, aisle_vec2_lerp(p, aisle_vec2_lerp(a, c, 0.5), f)) || moved;
        moved = move_point(self, i, aisle_vec2_lerp(self->points[i], a, f)) || moved;
        moved = move_point(self, i, aisle_vec2_lerp(self->points[i], c, f)) || moved;
    }
    return moved;
}

bool aisle_local_tidy(aisle_local *self) {
    if (self->at + 1U >= self->fresh) {
        self->pass = self->changed ? self->pass + 1U : PASSES_MAX;
        self->at = 1U;
        self->changed = false;
    }
    if (self->pass >= PASSES_MAX || self->fresh < 3U) {
        return false;
    }
    if (leave_out(self, self->at)) {
        self->changed = true;
        return true;
    }
    if (self->request.lattice <= 0.0 && pull_in(self, self->at)) {
        self->changed = true;
    }
    self->at++;
    return true;
}
