#include "sim/chassis.h"

#include "base/angle.h"
#include "base/check.h"

#include <string.h>

aisle_sim_chassis_traits aisle_sim_chassis_usual(const aisle_vehicle *vehicle) {
    return (aisle_sim_chassis_traits){.latency = 0.05,
                                      .lag = 0.08,
                                      .slip_sigma = 0.01,
                                      .steer_sigma = 0.02,
                                      .a = vehicle->a_max,
                                      .d = vehicle->d_max,
                                      .alpha = vehicle->alpha_max,
                                      .wander = 2.0};
}

void aisle_sim_chassis_start(aisle_sim_chassis *self, const aisle_sim_chassis_traits *traits, aisle_pose2 pose,
                             uint64_t seed) {
    memset(self, 0, sizeof *self);
    self->traits = *traits;
    self->pose = pose;
    self->rng = aisle_sim_stream(seed, 1);
    self->slip = aisle_sim_drift_of(&self->rng, traits->slip_sigma, traits->wander);
    self->steer = aisle_sim_drift_of(&self->rng, traits->steer_sigma, traits->wander);
}

void aisle_sim_chassis_command(aisle_sim_chassis *self, const aisle_sim_command *command) {
    if (self->count == AISLE_SIM_COMMANDS_MAX) {
        self->head = (self->head + 1) % AISLE_SIM_COMMANDS_MAX;
        self->count--;
    }
    uint32_t at = (self->head + self->count++) % AISLE_SIM_COMMANDS_MAX;
    self->queue[at].at = self->now + self->traits.latency;
    self->queue[at].command = *command;
}

static void take_due(aisle_sim_chassis *self) {
    while (self->count > 0 && self->queue[self->head].at <= self->now + 1e-9) {
        self->active = self->queue[self->head].command;
        self->head = (self->head + 1) % AISLE_SIM_COMMANDS_MAX;
        self->count--;
    }
}

// One step towards the target: first order lag, the rate within [-down, up] where up is away from 0; a target of 0 is
// braked to with `down` until rest.
static double towards(double value, double target, double lag, double up, double down, double dt) {
    bool gains = fabs(target) > fabs(value) && value * target >= 0.0;
    double most = gains ? up : down, wish = target == 0.0 ? dt : lag;
    double next = value + aisle_clamp((target - value) / wish, -most, most) * dt;
    return value * next < 0.0 ? 0.0 : next; // through 0 only by standing
}

void aisle_sim_chassis_step(aisle_sim_chassis *self, double dt) {
    const aisle_sim_chassis_traits *t = &self->traits;
    AISLE_ASSERT(dt > 0.0 && dt <= t->lag);
    self->now += dt;
    take_due(self);
    const aisle_sim_command *c = &self->active;
    aisle_sim_drift_step(&self->slip, &self->rng, dt);
    aisle_sim_drift_step(&self->steer, &self->rng, dt);
    self->v = towards(self->v, c->spins ? 0.0 : c->v, t->lag, t->a, t->d, dt);
    self->spin = towards(self->spin, c->spins && self->v == 0.0 ? c->spin : 0.0, t->lag, t->alpha, t->alpha, dt);
    if (!c->spins) {
        self->curvature += (c->curvature - self->curvature) / t->lag * dt;
    }
    double turn = aisle_sim_chassis_omega(self) * dt, sine, cosine;
    aisle_sincos(self->pose.theta + 0.5 * turn, &sine, &cosine);
    double way = self->v * (1.0 + self->slip.value) * dt;
    self->pose.x += way * cosine;
    self->pose.y += way * sine;
    self->pose.theta = aisle_angle_wrap(self->pose.theta + turn);
}

double aisle_sim_chassis_omega(const aisle_sim_chassis *self) {
    return fabs(self->v) * (self->curvature + self->steer.value) + self->spin;
}

double aisle_sim_chassis_speed(const aisle_sim_chassis *self, double reach) {
    return fabs(self->v) * (1.0 + fabs(self->slip.value)) + fabs(aisle_sim_chassis_omega(self)) * reach;
}
