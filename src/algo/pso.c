#include "algo/pso.h"

#include "algo/box.h"
#include "base/check.h"

#include <math.h>

#define CONSTRICTION_W 0.729844F
#define CONSTRICTION_C 1.49618F

// The pieces of the work array: x, v and best point of every particle, best costs, best point of the swarm.
static float *x_of(const aisle_pso *self, uint32_t particle) {
    return self->work + (size_t)particle * self->cfg->dim;
}

static float *v_of(const aisle_pso *self, uint32_t particle) {
    return x_of(self, (uint32_t)self->cfg->particles + particle);
}

static float *p_of(const aisle_pso *self, uint32_t particle) {
    return x_of(self, 2U * self->cfg->particles + particle);
}

static float *p_cost_of(const aisle_pso *self, uint32_t particle) {
    return x_of(self, 3U * self->cfg->particles) + 2U * (size_t)particle;
}

static float *g_of(const aisle_pso *self) {
    return p_cost_of(self, self->cfg->particles);
}

static bool box_is_good(const aisle_pso_config *cfg) {
    for (uint32_t i = 0; i < cfg->dim; i++) {
        if (cfg->guess != NULL && !isfinite(cfg->guess[i])) {
            return false;
        }
    }
    return aisle_box_is_good(cfg->lo, cfg->hi, cfg->dim);
}

static bool weights_are_good(const aisle_pso_config *cfg) {
    return (cfg->inertia == AISLE_PSO_FALLING || cfg->inertia == AISLE_PSO_CONSTRICTION) &&
           aisle_box_within(cfg->w_start, 0.0F, 1.0F) && aisle_box_within(cfg->w_end, 0.0F, 1.0F) &&
           aisle_box_within(cfg->c1, 0.0F, 4.0F) && aisle_box_within(cfg->c2, 0.0F, 4.0F);
}

static bool config_is_good(const aisle_pso_config *cfg) {
    return cfg->cost != NULL && cfg->lo != NULL && cfg->hi != NULL && cfg->dim >= 1 && cfg->dim <= AISLE_PSO_DIM_MAX &&
           cfg->particles >= 2 && cfg->particles <= AISLE_PSO_PARTICLES_MAX && cfg->eval_max >= cfg->particles &&
           !isnan(cfg->value_goal) && cfg->spread >= 0.0F && cfg->spread <= AISLE_BOX_MAX && weights_are_good(cfg) &&
           box_is_good(cfg);
}

// A point at rest: within the spread of the guess, or anywhere in the box.
static void draw(aisle_pso *self, uint32_t particle) {
    const aisle_pso_config *cfg = self->cfg;
    const bool near = cfg->guess != NULL && cfg->spread > 0.0F;
    float *x = x_of(self, particle);
    float *v = v_of(self, particle);
    for (uint32_t i = 0; i < cfg->dim; i++) {
        const float lo = cfg->lo[i];
        const float hi = cfg->hi[i];
        const float r = aisle_rng_float(&self->rng);
        const float at = near ? cfg->guess[i] + (2.0F * r - 1.0F) * cfg->spread * (hi - lo) : lo + r * (hi - lo);
        x[i] = aisle_box_clamp(at, lo, hi);
        v[i] = 0.0F;
    }
}

static void place(aisle_pso *self, uint32_t particle) {
    const aisle_pso_config *cfg = self->cfg;
    draw(self, particle);
    float *x = x_of(self, particle);
    float *p = p_of(self, particle);
    for (uint32_t i = 0; i < cfg->dim; i++) {
        if (particle == 0 && cfg->guess != NULL) {
            x[i] = aisle_box_clamp(cfg->guess[i], cfg->lo[i], cfg->hi[i]);
        }
        p[i] = x[i];
    }
    p_cost_of(self, particle)[0] = INFINITY;
    p_cost_of(self, particle)[1] = INFINITY;
}

aisle_status aisle_pso_start(aisle_pso *self, const aisle_pso_config *cfg, float *work, size_t work_len) {
    if (cfg == NULL || work == NULL || !config_is_good(cfg)) {
        return AISLE_ERR_ARG;
    }
    if (work_len < AISLE_PSO_WORK_LEN(cfg->dim, cfg->particles)) {
        return AISLE_ERR_CAPACITY;
    }
    *self = (aisle_pso){.cfg = cfg,
                        .work = work,
                        .rng = aisle_rng_seed(cfg->seed),
                        .best_cost = aisle_cost_pair_not_allowed(),
                        .ended = AISLE_BUSY};
    for (uint32_t particle = 0; particle < cfg->particles; particle++) {
        place(self, particle);
    }
    for (uint32_t i = 0; i < cfg->dim; i++) {
        g_of(self)[i] = x_of(self, 0)[i];
    }
    return AISLE_OK;
}

static aisle_cost_pair ask(aisle_pso *self, const float *x) {
    const aisle_cost_pair cost = self->cfg->cost(self->cfg->cost_ctx, x);
    self->evals++;
    self->nan_costs += aisle_cost_pair_is_nan(cost) ? 1U : 0U;
    return aisle_cost_pair_read(cost);
}

// Remembers a point that is the particle's or the swarm's best.
static void learn(aisle_pso *self, uint32_t particle, aisle_cost_pair cost) {
    const float *x = x_of(self, particle);
    float *p = p_of(self, particle);
    float *p_cost = p_cost_of(self, particle);
    if (aisle_cost_pair_better(cost, (aisle_cost_pair){p_cost[0], p_cost[1]})) {
        p_cost[0] = cost.violation;
        p_cost[1] = cost.value;
        for (uint32_t i = 0; i < self->cfg->dim; i++) {
            p[i] = x[i];
        }
    }
    if (aisle_cost_pair_better(cost, self->best_cost)) {
        self->best_cost = cost;
        self->best_updates++;
        self->last_improvement = self->evals;
        for (uint32_t i = 0; i < self->cfg->dim; i++) {
            g_of(self)[i] = x[i];
        }
    }
}

typedef struct weights {
    float w, c1, c2;
} weights;

static weights weights_now(const aisle_pso *self) {
    const aisle_pso_config *cfg = self->cfg;
    if (cfg->inertia == AISLE_PSO_CONSTRICTION) {
        return (weights){CONSTRICTION_W, CONSTRICTION_C, CONSTRICTION_C};
    }
    const bool given = cfg->w_start > 0.0F || cfg->w_end > 0.0F;
    const float from = given ? cfg->w_start : 0.9F;
    const float to = given ? cfg->w_end : 0.4F;
    const float spent = (float)self->evals / (float)cfg->eval_max; // eval_max >= particles > 0
    return (weights){from + (to - from) * spent, cfg->c1 > 0.0F ? cfg->c1 : 2.0F, cfg->c2 > 0.0F ? cfg->c2 : 2.0F};
}

static void move(aisle_pso *self, uint32_t particle) {
    const aisle_pso_config *cfg = self->cfg;
    const weights k = weights_now(self);
    const float *p = p_of(self, particle); // its starting point while it has seen nothing allowed
    const float *g = g_of(self);
    float *x = x_of(self, particle);
    float *v = v_of(self, particle);
    for (uint32_t i = 0; i < cfg->dim; i++) {
        const float lo = cfg->lo[i];
        const float hi = cfg->hi[i];
        const float v_max = 0.5F * (hi - lo);
        const float r1 = aisle_rng_float(&self->rng);
        const float r2 = aisle_rng_float(&self->rng);
        v[i] = aisle_box_clamp(k.w * v[i] + k.c1 * r1 * (p[i] - x[i]) + k.c2 * r2 * (g[i] - x[i]), -v_max, v_max);
        const float to = x[i] + v[i];
        x[i] = aisle_box_clamp(to, lo, hi);
        v[i] = aisle_box_within(to, lo, hi) ? v[i] : 0.0F;
    }
}

// Where the particle goes after it was looked at; true: it is looked at again at once.
static bool go_on(aisle_pso *self, uint32_t particle, bool allowed) {
    const bool again = !allowed && self->tries < self->cfg->relocate;
    if (again || !aisle_cost_pair_is_allowed(self->best_cost)) {
        draw(self, particle);
    } else {
        move(self, particle);
    }
    self->tries = again ? (uint16_t)(self->tries + 1U) : 0U;
    self->relocations += again ? 1U : 0U;
    return again;
}

static aisle_status verdict(const aisle_pso *self) {
    const aisle_pso_config *cfg = self->cfg;
    if (aisle_cost_pair_is_allowed(self->best_cost) && self->best_cost.violation <= 0.0F &&
        self->best_cost.value <= cfg->value_goal) {
        return AISLE_OK;
    }
    const bool stalled = cfg->stall_max > 0 && self->evals - self->last_improvement >= cfg->stall_max;
    return self->evals >= cfg->eval_max || stalled ? AISLE_PARTIAL : AISLE_BUSY;
}

aisle_status aisle_pso_step(aisle_pso *self, uint32_t evals) {
    if (self->cfg == NULL) {
        return AISLE_ERR_ARG;
    }
    for (uint32_t spent = 0; spent < evals && self->ended == AISLE_BUSY; spent++) {
        const uint32_t particle = self->next;
        AISLE_ASSERT(particle < self->cfg->particles);
        const aisle_cost_pair cost = ask(self, x_of(self, particle));
        learn(self, particle, cost);
        if (!go_on(self, particle, aisle_cost_pair_is_allowed(cost))) {
            self->next = (uint16_t)((particle + 1U) % self->cfg->particles);
        }
        self->ended = verdict(self);
    }
    return self->ended;
}

const float *aisle_pso_best(const aisle_pso *self) {
    return self->cfg != NULL && aisle_cost_pair_is_allowed(self->best_cost) ? g_of(self) : NULL;
}

static bool particle_holds(const aisle_pso *self, uint32_t particle) {
    const aisle_pso_config *cfg = self->cfg;
    const float *p_cost = p_cost_of(self, particle);
    for (uint32_t i = 0; i < cfg->dim; i++) {
        const float v_max = 0.5F * (cfg->hi[i] - cfg->lo[i]);
        if (!aisle_box_within(x_of(self, particle)[i], cfg->lo[i], cfg->hi[i]) ||
            !aisle_box_within(p_of(self, particle)[i], cfg->lo[i], cfg->hi[i]) ||
            !aisle_box_within(v_of(self, particle)[i], -v_max, v_max)) {
            return false;
        }
    }
    return p_cost[0] >= 0.0F && !isnan(p_cost[1]) &&
           !aisle_cost_pair_better((aisle_cost_pair){p_cost[0], p_cost[1]}, self->best_cost);
}

bool aisle_pso_invariants_hold(const aisle_pso *self) {
    if (self->cfg == NULL) {
        return true; // never started
    }
    const aisle_pso_config *cfg = self->cfg;
    if (self->next >= cfg->particles || self->evals > cfg->eval_max || self->nan_costs > self->evals ||
        self->best_updates > self->evals || self->last_improvement > self->evals || self->relocations > self->evals ||
        self->tries > cfg->relocate || aisle_cost_pair_is_allowed(self->best_cost) != (self->best_updates > 0) ||
        self->ended != verdict(self)) {
        return false;
    }
    for (uint32_t i = 0; i < cfg->dim; i++) {
        if (!aisle_box_within(g_of(self)[i], cfg->lo[i], cfg->hi[i])) {
            return false;
        }
    }
    for (uint32_t particle = 0; particle < cfg->particles; particle++) {
        if (!particle_holds(self, particle)) {
            return false;
        }
    }
    return true;
}
