#include "plan/swarm.h"

#include "base/angle.h"
#include "base/check.h"
#include "plan/zones.h"

#include <math.h>

#define SPREAD 0.15F        // of the box, where the other particles start
#define VIA_SPACING 1.5     // m, wished between via-points
#define SAMPLE_SPACING 0.25 // m, wished between samples
#define SEED_DEFAULT 20180617U

void aisle_swarm_carve(aisle_swarm *self, aisle_arena *arena) {
    self->work = (float *)aisle_arena_take(arena, AISLE_PSO_WORK_LEN(2U * AISLE_SWARM_VIAS, AISLE_SWARM_PARTICLES),
                                           sizeof(float));
    self->spline = (aisle_spline *)aisle_arena_take(arena, 1U, sizeof(aisle_spline));
    self->sample = (aisle_spline_sample *)aisle_arena_take(arena, AISLE_SWARM_SAMPLES_MAX, sizeof(aisle_spline_sample));
}

// How far the footprint's margin is violated at a sample: 0 if kept. The field decides where it can.
static double shortfall(aisle_swarm *self, const aisle_spline_sample *at, double *clearance) {
    const aisle_space *space = self->space;
    const aisle_vehicle *vehicle = space->vehicle;
    *clearance = aisle_space_clearance_about(space, at->p);
    if (*clearance - space->grid->lattice.res >= space->keep + vehicle->outer_radius - vehicle->inner_radius) {
        return 0.0; // the interpolation errs by less than a cell (space.h)
    }
    double lower = aisle_grid_gap_lower(space->grid, at->p);
    if (lower - vehicle->outer_radius >= space->keep) {
        return 0.0;
    }
    if (aisle_grid_gap_upper(space->grid, at->p) - vehicle->inner_radius < 0.0) {
        return space->keep - aisle_min(*clearance, 0.0);
    }
    self->units += 1U;
    aisle_pose2 pose = {at->p.x, at->p.y, aisle_atan2(at->d1.y, at->d1.x)};
    double gap = aisle_space_gap(space, pose, space->keep, NULL);
    return gap >= space->keep ? 0.0 : space->keep - gap;
}

static void zones_between(const aisle_swarm *self, aisle_vec2 a, aisle_vec2 b, double *violation, double *value) {
    const aisle_layout *layout = self->space->layout;
    if (!aisle_zones_allow(layout, a, b, 0.0, NULL)) {
        *violation += aisle_vec2_distance(a, b);
    }
    *value += aisle_zones_toll(layout, self->objective, a, b);
}

static aisle_cost_pair score(aisle_swarm *self) {
    double violation = 0.0;
    double value = 0.0;
    double before = 0.0; // distance to the sample before
    double curvature_max = self->space->vehicle->curvature_max;
    for (uint32_t i = 0; i < self->samples; i++) {
        const aisle_spline_sample *at = &self->sample[i];
        double after = i + 1U < self->samples ? aisle_vec2_distance(at->p, self->sample[i + 1U].p) : 0.0;
        double ds = 0.5 * (before + after);
        before = after;
        double clearance;
        double curvature = aisle_spline_curvature(at);
        violation += ds * shortfall(self, at, &clearance);
        if (curvature_max > 0.0 && fabs(curvature) > curvature_max) {
            violation += ds * (fabs(curvature) - curvature_max) / curvature_max;
        }
        value += ds * aisle_objective_density(self->objective, clearance, curvature);
        if (i > 0U && self->heeds_zones) {
            zones_between(self, self->sample[i - 1U].p, at->p, &violation, &value);
        }
    }
    self->units += self->samples / AISLE_SWARM_SAMPLES_PER_UNIT;
    return (aisle_cost_pair){(float)violation, (float)value};
}

static uint32_t via_points(const aisle_swarm *self, const float *x, aisle_vec2 *points) {
    points[0] = self->start;
    for (uint32_t i = 0; i < self->vias; i++) {
        aisle_vec2 offset = {(double)x[2U * i], (double)x[2U * i + 1U]};
        points[i + 1U] = aisle_vec2_add(self->base[i], offset);
    }
    points[self->vias + 1U] = self->goal;
    return self->vias + 2U;
}

static aisle_cost_pair cost(void *ctx, const float *x) {
    aisle_swarm *self = (aisle_swarm *)ctx;
    aisle_vec2 points[AISLE_SWARM_VIAS + 2U];
    uint32_t n = via_points(self, x, points);
    if (aisle_spline_fit(self->spline, self->kind, points, n) != AISLE_OK) {
        return (aisle_cost_pair){INFINITY, INFINITY};
    }
    aisle_spline_spread(self->spline, self->samples, self->sample);
    aisle_cost_pair scored = score(self);
    if (self->pso.evals == 0U) { // the first particle stands at the seed
        self->seed_cost = scored;
    }
    return scored;
}

static double polyline_length(const aisle_vec2 *points, uint32_t count) {
    double length = 0.0;
    for (uint32_t i = 0; i + 1U < count; i++) {
        length += aisle_vec2_distance(points[i], points[i + 1U]);
    }
    return length;
}

// Via-points: every inner point of the polyline, and more in between until there are enough, by arc length.
static void place_vias(aisle_swarm *self, const aisle_vec2 *points, uint32_t count, double length) {
    uint32_t inner = count - 2U;
    double wished = aisle_clamp(floor(length / VIA_SPACING), 2.0, (double)AISLE_SWARM_VIAS);
    double spare = aisle_max(wished - (double)inner, 0.0);
    double given = 0.0;
    double s = 0.0;
    self->vias = 0;
    for (uint32_t i = 0; i + 1U < count; i++) {
        s += aisle_vec2_distance(points[i], points[i + 1U]);
        double extra = floor(spare * s / length + 0.5) - given; // length >= 0.2
        given += extra;
        for (double k = 1.0; k <= extra; k += 1.0) {
            self->base[self->vias++] = aisle_vec2_lerp(points[i], points[i + 1U], k / (extra + 1.0));
        }
        if (i + 2U < count) {
            self->base[self->vias++] = points[i + 1U];
        }
    }
    AISLE_ASSERT(self->vias >= 1U && self->vias <= AISLE_SWARM_VIAS);
}

static void configure(aisle_swarm *self, const aisle_options_msg *options, double length) {
    for (uint32_t i = 0; i < 2U * self->vias; i++) {
        self->lo[i] = -(float)AISLE_SWARM_REACH;
        self->hi[i] = (float)AISLE_SWARM_REACH;
        self->guess[i] = 0.0F;
    }
    double wished = options->num_samples > 0 ? (double)options->num_samples : floor(length / SAMPLE_SPACING) + 2.0;
    self->samples = (uint32_t)aisle_clamp(wished, 16.0, (double)AISLE_SWARM_SAMPLES_MAX);
    self->config = (aisle_pso_config){.cost = cost,
                                      .cost_ctx = self,
                                      .lo = self->lo,
                                      .hi = self->hi,
                                      .guess = self->guess,
                                      .spread = SPREAD,
                                      .inertia = AISLE_PSO_FALLING,
                                      .seed = options->seed != 0 ? (uint64_t)(uint32_t)options->seed : SEED_DEFAULT,
                                      .eval_max = AISLE_SWARM_EVALS,
                                      .stall_max = AISLE_SWARM_STALL,
                                      .value_goal = -INFINITY,
                                      .dim = (uint16_t)(2U * self->vias),
                                      .particles = AISLE_SWARM_PARTICLES};
}

aisle_status aisle_swarm_start(aisle_swarm *self, const aisle_space *space, const aisle_objective *objective,
                               const aisle_options_msg *options, const aisle_vec2 *points, uint32_t count) {
    double length = polyline_length(points, count);
    if (length < 0.2 || count > AISLE_SWARM_VIAS + 2U) {
        return AISLE_PARTIAL;
    }
    self->space = space;
    self->objective = objective;
    self->kind = options->interpolation == AISLE_OPTIONS_LINEAR ? AISLE_SPLINE_LINEAR : AISLE_SPLINE_CUBIC;
    self->start = points[0];
    self->goal = points[count - 1U];
    self->units = 0;
    self->heeds_zones = objective->has_tolls || aisle_zones_any_directed(space->layout);
    self->polishing = false;
    self->polish_evals = 0;
    place_vias(self, points, count, length);
    configure(self, options, length);
    aisle_status st = aisle_pso_start(&self->pso, &self->config, self->work,
                                      AISLE_PSO_WORK_LEN(2U * AISLE_SWARM_VIAS, AISLE_SWARM_PARTICLES));
    AISLE_ASSERT(st == AISLE_OK);
    return AISLE_OK;
}

// ---- polish

static void begin_polish(aisle_swarm *self) {
    const float *best = aisle_pso_best(&self->pso);
    self->polishing = best != NULL;
    self->polish_evals = self->at = 0;
    self->moved = false;
    self->step = AISLE_SWARM_POLISH_STEP;
    self->best_cost = self->pso.best_cost;
    for (uint32_t i = 0; best != NULL && i < 2U * self->vias; i++) {
        self->best[i] = best[i];
    }
}

// One component one step either way; a step that helps is tried again. A round that helps nowhere halves the step.
static aisle_status polish(aisle_swarm *self) {
    if (self->polish_evals >= AISLE_SWARM_POLISH_EVALS || self->step < AISLE_SWARM_POLISH_LAST) {
        return AISLE_OK;
    }
    uint32_t i = self->at / 2U;
    float before = self->best[i];
    self->best[i] = before + (self->at % 2U == 0U ? self->step : -self->step);
    bool is_within = self->best[i] >= self->lo[i] && self->best[i] <= self->hi[i];
    aisle_cost_pair there = is_within ? cost(self, self->best) : (aisle_cost_pair){INFINITY, INFINITY};
    self->polish_evals += is_within ? 1U : 0U;
    if (aisle_cost_pair_better(there, self->best_cost)) {
        self->best_cost = there;
        self->moved = true;
        return AISLE_BUSY;
    }
    self->best[i] = before;
    self->at++;
    if (self->at == 4U * self->vias) {
        self->at = 0;
        self->step *= self->moved ? 1.0F : 0.5F;
        self->moved = false;
    }
    return AISLE_BUSY;
}

aisle_status aisle_swarm_step(aisle_swarm *self, uint32_t units, uint32_t *spent) {
    aisle_status st = AISLE_BUSY;
    while (st == AISLE_BUSY && self->units < units) {
        if (self->polishing) {
            st = polish(self);
        } else if (aisle_pso_step(&self->pso, 1U) != AISLE_BUSY) {
            begin_polish(self);
            st = self->polishing ? AISLE_BUSY : AISLE_OK;
        }
    }
    *spent += self->units;
    self->units = 0;
    return st;
}

aisle_cost_pair aisle_swarm_best_cost(const aisle_swarm *self) {
    return self->polishing ? self->best_cost : self->pso.best_cost;
}

uint32_t aisle_swarm_best(const aisle_swarm *self, aisle_vec2 *points) {
    const float *best = self->polishing ? self->best : aisle_pso_best(&self->pso);
    if (best == NULL || aisle_swarm_best_cost(self).violation > 0.0F) {
        return 0;
    }
    return via_points(self, best, points);
}
