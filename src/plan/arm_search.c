#include "plan/arm_search.h"

#include "aisle/messages.h"
#include "base/check.h"
#include "plan/arm_time.h"

#include <string.h>

#define GENERATIONS 25U    // of a try
#define TRIES 8U           // of a search asked for by name; others come after one
#define STALL 200U         // candidates without a better one, once one was free
#define BEND_MIDDLE 128.0F // b0: 2 rad
#define BEND_SKEW 512.0F   // b1: 0.95 rad
#define SPREAD 0.5F
#define TIMING_PANELS 24U
#define HIDDEN 1e-3 // violation of a motion that is free at all samples only

#define PAPER_GENERATIONS 100U
#define PAPER_RANGE 100.0F // of a6 and a7

static const double never = (double)INFINITY;

void aisle_arm_search_carve(aisle_arm_search *self, aisle_arena *arena) {
    const size_t length = AISLE_PSO_WORK_LEN(AISLE_ARM_GENES, AISLE_ARM_POPULATION);
    aisle_ga_carve(self != NULL ? &self->ga : NULL, arena, AISLE_ARM_GENES, AISLE_ARM_POPULATION);
    void *work = aisle_arena_take(arena, length, sizeof(float));
    if (self != NULL) {
        self->pso_work = (float *)work;
    }
}

// ---- cost

static double joints_out(const aisle_arm *arm, const double *q) {
    double sum = 0.0;
    for (uint32_t j = 0; j < arm->links; j++) {
        sum += aisle_max(0.0, arm->min[j] - q[j]) + aisle_max(0.0, q[j] - arm->max[j]);
    }
    return sum;
}

static double sampled_depth(aisle_arm_search *self, const aisle_arm_piece *piece) {
    double sum = 0.0, q[AISLE_ARM_LINKS];
    for (uint32_t i = 1; i < AISLE_ARM_SAMPLES; i++) {
        aisle_arm_piece_at(piece, (double)i / (double)AISLE_ARM_SAMPLES, 0U, q);
        sum += aisle_arm_world_depth(self->world, q) + joints_out(self->world->arm, q);
        self->units += AISLE_ARM_UNITS;
        if (self->paper && sum > 0.0) {
            return never;
        }
    }
    return sum / (double)(AISLE_ARM_SAMPLES - 1U);
}

static double violation_of(aisle_arm_search *self, const aisle_arm_piece *piece) {
    const double depth = sampled_depth(self, piece);
    if (depth > 0.0) {
        return HIDDEN + depth;
    }
    double until, out;
    if (aisle_arm_piece_joint_out(piece, self->world->arm, &out) != 0U) {
        return self->paper ? never : HIDDEN * aisle_min(1.0, 0.5 + out);
    }
    if (!aisle_arm_free_piece(self->world, piece, &self->units, &until)) {
        return self->paper ? never : HIDDEN * (1.0 - 0.5 * until);
    }
    return 0.0;
}

static double risk_of(aisle_arm_search *self, const aisle_arm_piece *piece) {
    double sum = 0.0, q[AISLE_ARM_LINKS];
    for (uint32_t i = 0; i <= AISLE_ARM_SAMPLES; i++) {
        aisle_arm_piece_at(piece, (double)i / (double)AISLE_ARM_SAMPLES, 0U, q);
        sum += 1.0 - aisle_arm_world_gap(self->world, q, AISLE_ARM_CREEP, NULL, NULL) / AISLE_ARM_CREEP;
        self->units += AISLE_ARM_UNITS;
    }
    return sum / (double)(AISLE_ARM_SAMPLES + 1U);
}

static double work_of(const aisle_arm_search *self, const aisle_arm_piece *piece, double duration) {
    double sum = 0.0, q[AISLE_ARM_LINKS], rate[AISLE_ARM_LINKS], change[AISLE_ARM_LINKS];
    double inertia[AISLE_ARM_LINKS], gravity[AISLE_ARM_LINKS];
    for (uint32_t i = 1; i < AISLE_ARM_SAMPLES; i++) { // at rest at both ends
        const double r = (double)i / (double)AISLE_ARM_SAMPLES;
        aisle_arm_piece_at(piece, r, 0U, q);
        aisle_arm_piece_at(piece, r, 1U, rate);
        aisle_arm_piece_at(piece, r, 2U, change);
        aisle_arm_torque(&self->dynamics, q, rate, change, inertia, gravity);
        for (uint32_t j = 0; j < piece->links; j++) {
            const double torque = gravity[j] + inertia[j] / (duration * duration); // duration > 0
            sum += fabs(torque * rate[j]);
        }
    }
    return sum / (double)AISLE_ARM_SAMPLES;
}

static double value_of(aisle_arm_search *self, const aisle_arm_piece *piece) {
    aisle_arm_timing timing;
    switch (self->objective) {
    case AISLE_OPTIONS_SAFEST:
        return aisle_arm_piece_travel(piece) * (1.0 + self->risk_weight * risk_of(self, piece));
    case AISLE_OPTIONS_FASTEST:
    case AISLE_OPTIONS_LEAST_ENERGY:
        aisle_arm_least_duration(self->world->arm, &self->dynamics, piece, TIMING_PANELS, &timing);
        return self->objective == AISLE_OPTIONS_FASTEST || !(timing.duration > 0.0)
                   ? timing.duration
                   : work_of(self, piece, timing.duration);
    default:
        return aisle_arm_piece_travel(piece);
    }
}

aisle_cost_pair aisle_arm_search_cost(aisle_arm_search *self, const aisle_arm_piece *piece) {
    const double violation = violation_of(self, piece);
    // What collides is told apart by how deep alone; its value costs as much to find and counts for little.
    const double value = violation > 0.0 ? aisle_arm_piece_travel(piece) : value_of(self, piece);
    return (aisle_cost_pair){.violation = (float)violation, .value = (float)value};
}

static void piece_of(const aisle_arm_search *self, const float *x, aisle_arm_piece *out) {
    double bend[AISLE_ARM_GENES];
    for (uint32_t j = 0; j < self->world->arm->links; j++) {
        if (self->paper) {
            aisle_arm_bend_of_paper((double)x[2U * j], (double)x[2U * j + 1U], &bend[2U * j]);
        } else {
            bend[2U * j] = (double)x[2U * j];
            bend[2U * j + 1U] = (double)x[2U * j + 1U];
        }
    }
    aisle_arm_piece_of(self->world->arm->links, self->from, self->to, bend, out);
}

static aisle_cost_pair cost(void *context, const float *x) {
    aisle_arm_search *self = (aisle_arm_search *)context;
    aisle_arm_piece piece;
    piece_of(self, x, &piece);
    const aisle_cost_pair cost = aisle_arm_search_cost(self, &piece);
    self->evals++;
    if (self->first == 0U && cost.violation <= 0.0F) {
        self->first = self->evals;
    }
    return cost;
}

// ---- the run

static void start_ga(aisle_arm_search *self, uint16_t genes, uint64_t seed, bool is_again) {
    aisle_ga_config cfg = aisle_ga_modern(genes, GENERATIONS);
    cfg.population = AISLE_ARM_POPULATION;
    cfg.seeds = is_again ? NULL : self->guess;
    cfg.seed_count = (uint16_t)(is_again ? 0 : 1);
    cfg.spread = SPREAD;
    if (self->paper) {
        cfg = aisle_arm_paper_ga(PAPER_GENERATIONS);
    }
    cfg.cost = cost;
    cfg.cost_ctx = self;
    cfg.lo = self->lo;
    cfg.hi = self->hi;
    cfg.genes = genes;
    cfg.seed = seed;
    const aisle_status st = aisle_ga_start(&self->ga, &cfg);
    AISLE_ASSERT(st == AISLE_OK);
}

static void start_pso(aisle_arm_search *self, uint16_t genes, uint64_t seed, bool is_again) {
    self->pso_config = (aisle_pso_config){.cost = cost,
                                          .cost_ctx = self,
                                          .lo = self->lo,
                                          .hi = self->hi,
                                          .guess = is_again ? NULL : self->guess,
                                          .spread = SPREAD,
                                          .inertia = AISLE_PSO_CONSTRICTION,
                                          .seed = seed,
                                          .eval_max = AISLE_ARM_POPULATION * (GENERATIONS + 1U),
                                          .value_goal = -INFINITY,
                                          .dim = genes,
                                          .particles = AISLE_ARM_POPULATION};
    const aisle_status st = aisle_pso_start(&self->pso, &self->pso_config, self->pso_work,
                                            AISLE_PSO_WORK_LEN(AISLE_ARM_GENES, AISLE_ARM_POPULATION));
    AISLE_ASSERT(st == AISLE_OK);
}

// A try anew forgets the motion without a bend and looks everywhere.
static void begin_try(aisle_arm_search *self, bool is_again) {
    const uint16_t genes = (uint16_t)(2U * self->world->arm->links);
    self->tries--;
    if (self->swarm) {
        start_pso(self, genes, self->seed++, is_again);
    } else {
        start_ga(self, genes, self->seed++, is_again);
    }
}

void aisle_arm_search_start(aisle_arm_search *self, const aisle_arm_world *world, const double *from, const double *to,
                            const aisle_options_msg *options) {
    const uint32_t links = world->arm->links;
    const uint64_t seed = (uint64_t)(int64_t)options->seed;
    self->world = world;
    aisle_arm_dynamics_begin(&self->dynamics, world->arm, world->base.theta);
    memcpy(self->from, from, links * sizeof *from);
    memcpy(self->to, to, links * sizeof *to);
    self->objective = options->objective;
    self->paper = options->objective == AISLE_OPTIONS_PAPER;
    self->swarm = options->planner == AISLE_OPTIONS_PSO && !self->paper;
    self->risk_weight = options->risk_weight > 0.0F ? (double)options->risk_weight : 1.0;
    const bool is_named = options->planner == AISLE_OPTIONS_GA || options->planner == AISLE_OPTIONS_PSO;
    self->tries = is_named && !self->paper ? TRIES : 1U;
    self->seed = seed;
    self->units = self->evals = self->first = 0;
    for (uint32_t g = 0; g < 2U * links; g++) {
        self->hi[g] = self->paper ? PAPER_RANGE : g % 2U == 0U ? BEND_MIDDLE : BEND_SKEW;
        self->lo[g] = -self->hi[g];
        self->guess[g] = 0.0F;
    }
    begin_try(self, false);
}

// Ours but for PAPER, which has its generations.
static bool has_stalled(const aisle_arm_search *self) {
    const uint32_t last = self->swarm ? self->pso.last_improvement : self->ga.last_improvement;
    return !self->paper && self->first > 0U && (self->swarm ? self->pso.evals : self->ga.evals) - last >= STALL;
}

aisle_status aisle_arm_search_step(aisle_arm_search *self, uint32_t units, uint32_t *spent) {
    aisle_status st = AISLE_BUSY;
    self->units = 0;
    while (st == AISLE_BUSY && self->units < units && !has_stalled(self)) {
        st = self->swarm ? aisle_pso_step(&self->pso, 1U) : aisle_ga_step(&self->ga, 1U);
    }
    *spent += self->units;
    if (st != AISLE_BUSY && self->first == 0U && self->tries > 0U) {
        begin_try(self, true);
        return AISLE_BUSY;
    }
    if (st == AISLE_BUSY && !has_stalled(self)) {
        return AISLE_BUSY;
    }
    return self->first > 0U ? AISLE_OK : AISLE_PARTIAL;
}

bool aisle_arm_search_best(const aisle_arm_search *self, aisle_arm_piece *out) {
    const float *best = self->swarm ? aisle_pso_best(&self->pso) : aisle_ga_best(&self->ga);
    if (self->first == 0U || best == NULL) {
        return false;
    }
    piece_of(self, best, out);
    return true;
}
