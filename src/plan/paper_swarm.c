#include "plan/paper_swarm.h"

#include "base/check.h"

#include <math.h>

#define SEED_DEFAULT 20180617U
#define WORK_LEN AISLE_PSO_WORK_LEN(2U * AISLE_PAPER_VIAS, AISLE_PAPER_PARTICLES)

void aisle_paper_swarm_carve(aisle_paper_swarm *self, aisle_arena *arena) {
    self->circle = (aisle_paper_circle *)aisle_arena_take(arena, AISLE_PAPER_OBSTACLES_MAX, sizeof(aisle_paper_circle));
    self->work = (float *)aisle_arena_take(arena, WORK_LEN, sizeof(float));
    self->spline = (aisle_spline *)aisle_arena_take(arena, 1U, sizeof(aisle_spline));
    self->sample = (aisle_spline_sample *)aisle_arena_take(arena, AISLE_PAPER_SAMPLES_MAX, sizeof(aisle_spline_sample));
}

// How far the margin of the vehicle's circle is violated at p; 0 if kept. The field decides where it can.
static double shortfall(aisle_paper_swarm *self, aisle_vec2 p) {
    const aisle_space *space = self->space;
    double radius = space->vehicle->outer_radius;
    aisle_aabb bounds = aisle_layout_bounds(space->layout);
    double inside =
        aisle_min(aisle_min(p.x - bounds.lo.x, bounds.hi.x - p.x), aisle_min(p.y - bounds.lo.y, bounds.hi.y - p.y));
    if (inside <= 0.0) { // a spline may leave the hall
        return space->keep + radius - inside;
    }
    if (aisle_grid_gap_lower(space->grid, p) - radius >= space->keep) {
        return 0.0;
    }
    double upper = aisle_grid_gap_upper(space->grid, p);
    if (upper < radius) { // in collision; by how much is told well enough by the field
        return space->keep + radius - aisle_max(upper, 0.0);
    }
    self->units += 1U;
    aisle_convex disc = {&p, 1U, radius};
    double gap = aisle_layout_gap(space->layout, &disc, space->keep, NULL);
    return gap >= space->keep ? 0.0 : space->keep - gap;
}

static double avoidance(const aisle_paper_swarm *self, aisle_vec2 p) {
    double most = 0.0;
    for (uint32_t i = 0; i < self->circles; i++) {
        const aisle_paper_circle *c = &self->circle[i];
        most = aisle_max(most, 1.0 - AISLE_PAPER_ALPHA * aisle_vec2_distance(p, c->centre) / c->sum);
    }
    return most;
}

static aisle_paper_figures judge(aisle_paper_swarm *self) {
    aisle_paper_figures f = {0};
    for (uint32_t i = 0; i < self->samples; i++) {
        aisle_vec2 p = self->sample[i].p;
        double before = i > 0U ? aisle_vec2_distance(p, self->sample[i - 1U].p) : 0.0;
        double after = i + 1U < self->samples ? aisle_vec2_distance(p, self->sample[i + 1U].p) : 0.0;
        f.length += before;
        f.oa += avoidance(self, p) / (double)self->samples;
        f.violation += 0.5 * (before + after) * shortfall(self, p);
    }
    f.fitness = f.length * (1.0 + self->beta * f.oa);
    self->units +=
        self->samples / AISLE_PAPER_SAMPLES_PER_UNIT + self->samples * self->circles / AISLE_PAPER_CIRCLES_PER_UNIT;
    return f;
}

static void via_points(const aisle_paper_swarm *self, const float *x, aisle_vec2 *points) {
    points[0] = self->start;
    for (uint32_t i = 0; i < AISLE_PAPER_VIAS; i++) {
        aisle_vec2 offset = {(double)x[2U * i], (double)x[2U * i + 1U]};
        points[i + 1U] = aisle_vec2_add(self->origin, offset);
    }
    points[AISLE_PAPER_VIAS + 1U] = self->goal;
}

// The paper's flaw: evenly by the spline's parameter, from the first via-point on.
static void sample_without_first(aisle_paper_swarm *self) {
    const aisle_spline *s = self->spline;
    double from = s->u[1];
    double to = s->u[s->n - 1U];
    for (uint32_t i = 0; i < self->samples; i++) {
        self->sample[i] = aisle_spline_at(s, from + (to - from) * (double)i / (double)(self->samples - 1U));
    }
}

static bool sample_way(aisle_paper_swarm *self, const float *x) {
    aisle_vec2 points[AISLE_PAPER_VIAS + 2U];
    via_points(self, x, points);
    if (aisle_spline_fit(self->spline, self->kind, points, AISLE_PAPER_VIAS + 2U) != AISLE_OK) {
        return false;
    }
    if (self->skip_first && self->spline->n > 2U) {
        sample_without_first(self);
    } else {
        aisle_spline_resample(self->spline, self->samples, self->sample);
    }
    return true;
}

static aisle_cost_pair cost(void *ctx, const float *x) {
    aisle_paper_swarm *self = (aisle_paper_swarm *)ctx;
    if (!sample_way(self, x)) {
        self->units += 1U;
        return (aisle_cost_pair){INFINITY, INFINITY};
    }
    aisle_paper_figures f = judge(self);
    return (aisle_cost_pair){(float)f.violation, (float)f.fitness};
}

// False: too many.
static bool draw_circles(aisle_paper_swarm *self) {
    const aisle_layout *layout = self->space->layout;
    aisle_aabb bounds = aisle_layout_bounds(layout);
    double wall = AISLE_PAPER_WALL * aisle_min(bounds.hi.x - bounds.lo.x, bounds.hi.y - bounds.lo.y);
    self->circles = 0;
    for (uint32_t i = 0; i < aisle_layout_zone_count(layout); i++) {
        const aisle_zone *zone = aisle_layout_zone(layout, i);
        aisle_convex shape = aisle_layout_zone_shape(layout, zone);
        aisle_aabb box = aisle_convex_aabb(&shape);
        double half = 0.5 * aisle_vec2_distance(box.lo, box.hi);
        if (!aisle_zone_is_obstacle(zone) || half > wall) {
            continue;
        }
        if (self->circles == AISLE_PAPER_OBSTACLES_MAX) {
            return false;
        }
        self->circle[self->circles++] =
            (aisle_paper_circle){aisle_vec2_lerp(box.lo, box.hi, 0.5), half + self->space->vehicle->outer_radius};
    }
    return true;
}

static void configure(aisle_paper_swarm *self, const aisle_options_msg *options) {
    aisle_aabb bounds = aisle_layout_bounds(self->space->layout);
    self->origin = bounds.lo;
    for (uint32_t i = 0; i < AISLE_PAPER_VIAS; i++) {
        self->lo[2U * i] = self->lo[2U * i + 1U] = 0.0F;
        self->hi[2U * i] = (float)(bounds.hi.x - bounds.lo.x);
        self->hi[2U * i + 1U] = (float)(bounds.hi.y - bounds.lo.y);
    }
    double samples = options->num_samples > 0 ? (double)options->num_samples : (double)AISLE_PAPER_SAMPLES;
    self->samples = (uint32_t)aisle_clamp(samples, (double)AISLE_PAPER_SAMPLES_MIN, (double)AISLE_PAPER_SAMPLES_MAX);
    self->beta =
        options->risk_weight > 0.0F ? aisle_min((double)options->risk_weight, AISLE_PAPER_BETA_MAX) : AISLE_PAPER_BETA;
    self->config = (aisle_pso_config){.cost = cost,
                                      .cost_ctx = self,
                                      .lo = self->lo,
                                      .hi = self->hi,
                                      .inertia = AISLE_PSO_FALLING,
                                      .seed = options->seed != 0 ? (uint64_t)(uint32_t)options->seed : SEED_DEFAULT,
                                      .eval_max = AISLE_PAPER_PARTICLES * AISLE_PAPER_ITERATIONS,
                                      .value_goal = -INFINITY,
                                      .dim = (uint16_t)(2U * AISLE_PAPER_VIAS),
                                      .particles = AISLE_PAPER_PARTICLES};
}

aisle_status aisle_paper_swarm_start(aisle_paper_swarm *self, const aisle_space *space,
                                     const aisle_options_msg *options, aisle_vec2 start, aisle_vec2 goal) {
    if (!(aisle_vec2_distance(start, goal) >= 1e-6)) {
        return AISLE_ERR_ARG;
    }
    self->space = space;
    if (!draw_circles(self)) {
        return AISLE_ERR_CAPACITY;
    }
    self->kind = options->interpolation == AISLE_OPTIONS_LINEAR ? AISLE_SPLINE_LINEAR : AISLE_SPLINE_CUBIC;
    self->start = start;
    self->goal = goal;
    self->units = 0;
    self->skip_first = false;
    configure(self, options);
    aisle_status st = aisle_pso_start(&self->pso, &self->config, self->work, WORK_LEN);
    AISLE_ASSERT(st == AISLE_OK);
    return st;
}

aisle_status aisle_paper_swarm_step(aisle_paper_swarm *self, uint32_t units, uint32_t *spent) {
    aisle_status st = AISLE_BUSY;
    while (st == AISLE_BUSY && self->units < units) {
        st = aisle_pso_step(&self->pso, 1U);
    }
    *spent += self->units;
    self->units = 0;
    return st == AISLE_BUSY ? AISLE_BUSY : AISLE_OK;
}

uint32_t aisle_paper_swarm_best(const aisle_paper_swarm *self, aisle_vec2 *points) {
    const float *best = aisle_pso_best(&self->pso);
    if (best == NULL || self->pso.best_cost.violation > 0.0F) {
        return 0;
    }
    via_points(self, best, points);
    return AISLE_PAPER_VIAS + 2U;
}

bool aisle_paper_swarm_figures(aisle_paper_swarm *self, aisle_paper_figures *out) {
    const float *best = aisle_pso_best(&self->pso);
    if (best == NULL || !sample_way(self, best)) {
        return false;
    }
    uint32_t units = self->units;
    *out = judge(self);
    self->units = units; // asking is not work of the run
    return true;
}
