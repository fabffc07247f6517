#include "sim/sensors.h"

#include "base/angle.h"

#include <string.h>

aisle_sim_pose_traits aisle_sim_pose_usual(void) {
    return (aisle_sim_pose_traits){.period = 0.05,
                                   .delay = {0.010, 0.040},
                                   .wander_xy = 0.010,
                                   .wander_theta = 0.003,
                                   .white_xy = 0.003,
                                   .white_theta = 0.001,
                                   .speed = 0.01};
}

aisle_sim_source_traits aisle_sim_source_usual(void) {
    return (aisle_sim_source_traits){
        .period = 1.0 / 15.0, .delay = {0.030, 0.080}, .sigma = 0.03, .sigma_v = 0.1, .lost = 0.02};
}

static double draw_delay(const aisle_sim_delay *delay, aisle_rng *rng) {
    return aisle_sim_uniform(rng, delay->least, delay->most);
}

// True once a period; the first time at once.
static bool due(double *next, double now, double period) {
    if (now + 1e-9 < *next) {
        return false;
    }
    *next += period;
    return true;
}

// ---- pose

void aisle_sim_localiser_start(aisle_sim_localiser *self, const aisle_sim_pose_traits *traits, uint64_t seed) {
    memset(self, 0, sizeof *self);
    self->traits = *traits;
    self->rng = aisle_sim_stream(seed, 3);
    self->x = aisle_sim_drift_of(&self->rng, traits->wander_xy, 5.0);
    self->y = aisle_sim_drift_of(&self->rng, traits->wander_xy, 5.0);
    self->theta = aisle_sim_drift_of(&self->rng, traits->wander_theta, 5.0);
}

bool aisle_sim_localiser_step(aisle_sim_localiser *self, double now, double dt) {
    aisle_sim_drift_step(&self->x, &self->rng, dt);
    aisle_sim_drift_step(&self->y, &self->rng, dt);
    aisle_sim_drift_step(&self->theta, &self->rng, dt);
    if (!due(&self->next, now, self->traits.period)) {
        return false;
    }
    self->white = aisle_sim_normal2(&self->rng, self->traits.white_xy);
    self->white_theta = self->traits.white_theta * aisle_sim_normal(&self->rng);
    return true;
}

aisle_sim_estimate aisle_sim_localiser_estimate(const aisle_sim_localiser *self, const aisle_sim_chassis *truth) {
    return (aisle_sim_estimate){.pose = {truth->pose.x + self->x.value + self->white.x + self->off.x,
                                         truth->pose.y + self->y.value + self->white.y + self->off.y,
                                         aisle_angle_wrap(truth->pose.theta + self->theta.value + self->white_theta)},
                                .v = truth->v,
                                .omega = aisle_sim_chassis_omega(truth)};
}

double aisle_sim_localiser_tell(aisle_sim_localiser *self, const aisle_sim_chassis *truth, int64_t utime,
                                int32_t map_id, aisle_pose_msg *out) {
    const aisle_sim_pose_traits *t = &self->traits;
    aisle_sim_estimate e = aisle_sim_localiser_estimate(self, truth);
    double noise = truth->v != 0.0 ? t->speed * aisle_sim_normal(&self->rng) : 0.0; // wheels that stand are known to
    float xy = (float)(t->wander_xy * t->wander_xy + t->white_xy * t->white_xy);
    float tt = (float)(t->wander_theta * t->wander_theta + t->white_theta * t->white_theta);
    *out = (aisle_pose_msg){.utime = utime,
                            .seq = ++self->seq,
                            .map_id = map_id,
                            .x = e.pose.x,
                            .y = e.pose.y,
                            .theta = e.pose.theta,
                            .vx = (float)(e.v + noise),
                            .omega = (float)e.omega,
                            .cov = {xy, 0.0F, 0.0F, xy, 0.0F, tt},
                            .localized = 1};
    return draw_delay(&t->delay, &self->rng);
}

// ---- obstacles

void aisle_sim_source_start(aisle_sim_source *self, const aisle_sim_source_traits *traits, int32_t number, int32_t of,
                            uint64_t seed) {
    memset(self, 0, sizeof *self);
    self->traits = *traits;
    self->number = number;
    self->of = of;
    self->rng = aisle_sim_stream(seed, 16 + (uint64_t)number);
    self->next = aisle_sim_uniform(&self->rng, 0.0, traits->period);
}

bool aisle_sim_source_step(aisle_sim_source *self, double now) {
    return due(&self->next, now, self->traits.period);
}

static void tell_one(aisle_sim_source *self, const aisle_sim_mover *m, aisle_obstacle_msg *out) {
    const aisle_sim_source_traits *t = &self->traits;
    aisle_vec2 off = aisle_sim_normal2(&self->rng, t->sigma), wrong = aisle_sim_normal2(&self->rng, t->sigma_v);
    memset(out, 0, sizeof *out);
    out->id = m->id;
    out->kind = m->told_kind;
    out->x = m->pose.x + off.x;
    out->y = m->pose.y + off.y;
    out->theta = (float)m->pose.theta;
    out->vx = (float)(m->velocity.x + wrong.x);
    out->vy = (float)(m->velocity.y + wrong.y);
    out->cov_xy[0] = out->cov_xy[2] = (float)(t->sigma * t->sigma);
    out->sigma_v = (float)t->sigma_v;
    out->v_bound = m->told_v_bound;
    out->radius = (float)m->body.radius;
    out->num_vertices = m->body.n > 1 ? (int16_t)m->body.n : 0;
    for (int16_t i = 0; i < out->num_vertices; i++) {
        out->vertices[i][0] = (float)m->body.v[i].x;
        out->vertices[i][1] = (float)m->body.v[i].y;
    }
}

double aisle_sim_source_tell(aisle_sim_source *self, const aisle_sim_movers *movers, aisle_vec2 vehicle, int64_t utime,
                             int32_t map_id, aisle_obstacles_msg *out) {
    out->utime = utime;
    out->seq = ++self->seq;
    out->source = self->number;
    out->map_id = map_id;
    out->num_obstacles = 0;
    for (uint32_t i = (uint32_t)self->number; i < movers->count; i += (uint32_t)self->of) {
        const aisle_sim_mover *m = &movers->mover[i];
        bool seen = self->traits.range <= 0.0 ||
                    aisle_vec2_distance(aisle_vec2_of(m->pose.x, m->pose.y), vehicle) < self->traits.range;
        if (m->is_there && seen && out->num_obstacles < AISLE_OBSTACLES_MAX_OBSTACLES) {
            tell_one(self, m, &out->obstacles[out->num_obstacles++]);
        }
    }
    bool lost = self->seq > 1 && aisle_sim_uniform(&self->rng, 0.0, 1.0) < self->traits.lost;
    double delay = draw_delay(&self->traits.delay, &self->rng);
    return lost ? -1.0 : delay;
}
