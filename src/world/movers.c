#include "world/movers.h"

#include "base/angle.h"
#include "base/check.h"

#include <float.h>
#include <math.h>
#include <string.h>

void aisle_movers_carve(aisle_movers *self, aisle_arena *arena) {
    self->mover = (aisle_mover *)aisle_arena_take(arena, AISLE_MOVERS_MAX, sizeof(aisle_mover));
}

// ---- one obstacle

static bool is_within(double x, double lo, double hi) {
    return x >= lo && x <= hi; // false for NaN
}

static double bound_of(const aisle_obstacle_msg *msg) {
    static const double by_kind[] = {[AISLE_OBSTACLE_UNKNOWN] = 2.0,
                                     [AISLE_OBSTACLE_PERSON] = 1.6,
                                     [AISLE_OBSTACLE_VEHICLE] = 2.0,
                                     [AISLE_OBSTACLE_STATIC] = 0.0};
    const double told = msg->v_bound > 0.0F ? (double)msg->v_bound : by_kind[msg->kind];
    const double vx = (double)msg->vx, vy = (double)msg->vy;
    return aisle_max(told, sqrt(vx * vx + vy * vy));
}

// Root of the larger eigenvalue of the covariance (xx, xy, yy).
static double sigma_of(const float cov[3]) {
    const double xx = (double)cov[0], xy = (double)cov[1], yy = (double)cov[2];
    const double half = 0.5 * (xx - yy);
    const double larger = 0.5 * (xx + yy) + sqrt(half * half + xy * xy);
    return larger > 0.0 ? sqrt(larger) : AISLE_MOVERS_SIGMA;
}

static bool has_fit_outline(const aisle_obstacle_msg *msg) {
    aisle_vec2 v[AISLE_OBSTACLE_MAX_VERTICES];
    if (msg->num_vertices == 0) {
        return msg->radius > 0.0F;
    }
    if (msg->num_vertices < 3 || msg->num_vertices > AISLE_OBSTACLE_MAX_VERTICES) {
        return false;
    }
    for (int16_t i = 0; i < msg->num_vertices; i++) {
        v[i] = aisle_vec2_of((double)msg->vertices[i][0], (double)msg->vertices[i][1]);
    }
    return aisle_convex_is_valid(v, (uint32_t)msg->num_vertices, AISLE_OBSTACLE_MAX_VERTICES);
}

static double radius_of(const aisle_obstacle_msg *msg) {
    double farthest = 0.0;
    for (int16_t i = 0; i < msg->num_vertices; i++) {
        const aisle_vec2 v = aisle_vec2_of((double)msg->vertices[i][0], (double)msg->vertices[i][1]);
        farthest = aisle_max(farthest, aisle_vec2_length(v));
    }
    return farthest + (double)msg->radius;
}

static bool is_fit(const aisle_obstacle_msg *msg) {
    const double variance = AISLE_MOVERS_RADIUS_MAX * AISLE_MOVERS_RADIUS_MAX;
    return is_within(msg->x, -AISLE_SHAPE_COORD_MAX, AISLE_SHAPE_COORD_MAX) &&
           is_within(msg->y, -AISLE_SHAPE_COORD_MAX, AISLE_SHAPE_COORD_MAX) &&
           is_within((double)msg->theta, -AISLE_ANGLE_MAX, AISLE_ANGLE_MAX) &&
           is_within((double)msg->vx, -AISLE_MOVERS_SPEED_MAX, AISLE_MOVERS_SPEED_MAX) &&
           is_within((double)msg->vy, -AISLE_MOVERS_SPEED_MAX, AISLE_MOVERS_SPEED_MAX) &&
           is_within((double)msg->omega, -AISLE_ANGLE_MAX, AISLE_ANGLE_MAX) &&
           is_within((double)msg->cov_xy[0], 0.0, variance) && is_within((double)msg->cov_xy[2], 0.0, variance) &&
           is_within((double)msg->cov_xy[1], -variance, variance) &&
           is_within((double)msg->sigma_v, 0.0, AISLE_MOVERS_SPEED_MAX) &&
           is_within((double)msg->v_bound, 0.0, AISLE_MOVERS_SPEED_MAX) &&
           is_within((double)msg->radius, 0.0, AISLE_MOVERS_RADIUS_MAX) && msg->kind >= AISLE_OBSTACLE_UNKNOWN &&
           msg->kind <= AISLE_OBSTACLE_STATIC && has_fit_outline(msg) && radius_of(msg) <= AISLE_MOVERS_RADIUS_MAX;
}

static aisle_mover mover_of(const aisle_obstacle_msg *msg, const aisle_obstacles_msg *of) {
    return (aisle_mover){.id = msg->id,
                         .source = (uint8_t)of->source,
                         .kind = msg->kind,
                         .at = {msg->x, msg->y},
                         .velocity = {(double)msg->vx, (double)msg->vy},
                         .radius = radius_of(msg),
                         .sigma = sigma_of(msg->cov_xy),
                         .sigma_v = msg->sigma_v > 0.0F ? (double)msg->sigma_v : AISLE_MOVERS_SIGMA_V,
                         .v_bound = bound_of(msg),
                         .utime = of->utime};
}

// ---- a message

// to - from where that is not negative; differences of any two times fit.
static uint64_t us_between(int64_t from, int64_t to) {
    AISLE_ASSERT(from <= to);
    return (uint64_t)to - (uint64_t)from;
}

static bool refuse(aisle_refusal *why, int16_t cause, int32_t id) {
    *why = (aisle_refusal){cause, id, 0.0F};
    return false;
}

static bool head_is_fit(const aisle_movers *self, const aisle_obstacles_msg *msg, int64_t now_us, int32_t map_id,
                        aisle_refusal *why) {
    if (msg->source < 0 || msg->source >= AISLE_OBSTACLES_MAX_SOURCES) {
        return refuse(why, AISLE_STATUS_LIMIT, msg->source);
    }
    if (msg->num_obstacles > AISLE_OBSTACLES_MAX_OBSTACLES) {
        return refuse(why, AISLE_STATUS_LIMIT, msg->num_obstacles);
    }
    if (msg->num_obstacles < 0) {
        return refuse(why, AISLE_STATUS_MALFORMED, 0);
    }
    if (msg->map_id != 0 && map_id != 0 && msg->map_id != map_id) {
        return refuse(why, AISLE_STATUS_MAP_MISMATCH, msg->map_id);
    }
    if (msg->utime > now_us && us_between(now_us, msg->utime) > AISLE_MOVERS_AHEAD_US) {
        return refuse(why, AISLE_STATUS_CLOCK_JUMP, msg->source);
    }
    const aisle_movers_source *held = &self->source[msg->source];
    if (held->known && (msg->utime < held->utime || (msg->utime == held->utime && msg->seq < held->seq))) {
        return refuse(why, AISLE_STATUS_OUTDATED, msg->seq);
    }
    return true;
}

static bool holds(const int32_t *ids, int16_t count, int32_t id) {
    for (int16_t k = 0; k < count; k++) {
        if (ids[k] == id) {
            return true;
        }
    }
    return false;
}

static bool obstacles_are_fit(const aisle_obstacles_msg *msg, aisle_refusal *why) {
    int32_t ids[AISLE_OBSTACLES_MAX_OBSTACLES];
    for (int16_t i = 0; i < msg->num_obstacles; i++) {
        if (!is_fit(&msg->obstacles[i])) {
            return refuse(why, AISLE_STATUS_MALFORMED, msg->obstacles[i].id);
        }
        if (holds(ids, i, msg->obstacles[i].id)) {
            return refuse(why, AISLE_STATUS_CONFLICT, msg->obstacles[i].id);
        }
        ids[i] = msg->obstacles[i].id;
    }
    return true;
}

// Makes place for `count` movers of a source; those of the sources behind it move along.
static aisle_mover *make_room(aisle_movers *self, uint32_t source, uint32_t count) {
    aisle_movers_source *of = &self->source[source];
    const uint32_t behind = of->first + of->count, left = self->count - behind;
    memmove(self->mover + of->first + count, self->mover + behind, left * sizeof self->mover[0]);
    self->count = of->first + count + left;
    for (uint32_t i = source + 1U; i < AISLE_MOVERS_SOURCES; i++) {
        self->source[i].first += count - of->count; // modulo 2^32
    }
    of->count = count;
    AISLE_ASSERT(self->count <= AISLE_MOVERS_MAX);
    return self->mover + of->first;
}

aisle_status aisle_movers_take(aisle_movers *self, const aisle_obstacles_msg *msg, int64_t now_us, int32_t map_id,
                               aisle_refusal *why) {
    *why = (aisle_refusal){0, 0, 0.0F};
    if (!head_is_fit(self, msg, now_us, map_id, why)) {
        return AISLE_ERR_DATA;
    }
    aisle_movers_source *of = &self->source[msg->source];
    if (of->known && msg->utime == of->utime && msg->seq == of->seq) {
        return AISLE_PARTIAL;
    }
    if (!obstacles_are_fit(msg, why)) {
        return AISLE_ERR_DATA;
    }
    aisle_mover *to = make_room(self, (uint32_t)msg->source, (uint32_t)msg->num_obstacles);
    for (int16_t i = 0; i < msg->num_obstacles; i++) {
        to[i] = mover_of(&msg->obstacles[i], msg);
    }
    of->known = true;
    of->utime = msg->utime;
    of->taken_us = now_us;
    of->seq = msg->seq;
    self->revision++;
    return AISLE_OK;
}

// ---- questions

static double seconds_since(const aisle_mover *self, int64_t at_us) {
    return at_us > self->utime ? (double)us_between(self->utime, at_us) * 1e-6 : 0.0;
}

double aisle_mover_reach(const aisle_mover *self, int64_t at_us) {
    return self->radius + AISLE_MOVERS_SIGMAS * self->sigma + self->v_bound * seconds_since(self, at_us);
}

aisle_vec2 aisle_mover_predicted(const aisle_mover *self, int64_t at_us, double *sigma) {
    const double t = seconds_since(self, at_us);
    if (sigma != NULL) {
        const double grown = self->sigma_v * t;
        *sigma = sqrt(self->sigma * self->sigma + grown * grown);
    }
    return aisle_vec2_add(self->at, aisle_vec2_scale(self->velocity, t));
}

static int64_t fresh_until(const aisle_movers_source *source, double timeout_s) {
    const int64_t from = source->utime < source->taken_us ? source->utime : source->taken_us;
    const int64_t timeout = (int64_t)(timeout_s * 1e6);
    return from <= INT64_MAX - timeout ? from + timeout : INT64_MAX;
}

bool aisle_movers_stale(const aisle_movers *self, int64_t now_us, double timeout_s, int32_t *source) {
    for (int32_t i = 0; i < AISLE_OBSTACLES_MAX_SOURCES; i++) {
        if (self->source[i].known && now_us > fresh_until(&self->source[i], timeout_s)) {
            *source = i;
            return true;
        }
    }
    return false;
}

int64_t aisle_movers_stale_at(const aisle_movers *self, double timeout_s) {
    int64_t first = INT64_MAX;
    for (uint32_t i = 0; i < AISLE_MOVERS_SOURCES; i++) {
        const aisle_movers_source *source = &self->source[i];
        if (source->known && fresh_until(source, timeout_s) < first) {
            first = fresh_until(source, timeout_s);
        }
    }
    return first;
}

int64_t aisle_movers_utime(const aisle_movers *self) {
    int64_t newest = 0;
    for (uint32_t i = 0; i < AISLE_MOVERS_SOURCES; i++) {
        const aisle_movers_source *source = &self->source[i];
        newest = source->known && source->utime > newest ? source->utime : newest;
    }
    return newest;
}
