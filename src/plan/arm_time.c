#include "plan/arm_time.h"

#include "base/check.h"

#define GENERATIONS 1000U
#define MUTATION 0.3F
#define CANDIDATES 10U // of AISLE_ARM_TIME_UNITS

aisle_ga_config aisle_arm_paper_ga(uint32_t generations) {
    return (aisle_ga_config){.coding = AISLE_GA_REAL,
                             .crossover = AISLE_GA_BLEND,
                             .mutation = AISLE_GA_EACH,
                             .redraw = true,
                             .pc = 1.0F,
                             .pm = MUTATION,
                             .generation_max = generations,
                             .value_goal = -INFINITY,
                             .population = AISLE_ARM_TIME_POPULATION,
                             .elite = 1U,
                             .parents = AISLE_ARM_TIME_POPULATION / 2U};
}

void aisle_arm_time_carve(aisle_arm_time *self, aisle_arena *arena) {
    aisle_ga_carve(self != NULL ? &self->ga : NULL, arena, 1U, AISLE_ARM_TIME_POPULATION);
    void *place = aisle_arena_take(arena, AISLE_ARM_TIME_PLACES, sizeof(aisle_arm_time_place));
    if (self != NULL) {
        self->place = (aisle_arm_time_place *)place;
    }
}

static void fill(const aisle_arm *arm, const aisle_arm_dynamics *dynamics, const aisle_arm_piece *piece, double r,
                 aisle_arm_time_place *out) {
    double at[4][AISLE_ARM_LINKS];
    for (uint32_t order = 0; order < 4U; order++) {
        aisle_arm_piece_at(piece, r, order, at[order]);
    }
    *out = (aisle_arm_time_place){.velocity = 0.0};
    aisle_arm_torque(dynamics, at[0], at[1], at[2], out->inertia, out->gravity);
    for (uint32_t j = 0; j < arm->links; j++) {
        out->velocity = aisle_max(out->velocity, fabs(at[1][j]) / arm->v_max[j]);
        out->acceleration = aisle_max(out->acceleration, fabs(at[2][j]) / arm->a_max[j]);
        out->jerk = aisle_max(out->jerk, fabs(at[3][j]) / arm->j_max[j]);
        out->inertia[j] /= arm->torque_max[j];
        out->gravity[j] /= arm->torque_max[j];
    }
}

static bool is_held(const aisle_arm_time_place *place, uint32_t links, double duration) {
    const double square = duration * duration;
    bool is_within = place->velocity <= duration && place->acceleration <= square && place->jerk <= square * duration;
    for (uint32_t j = 0; j < links; j++) { // torque times T^2
        is_within = is_within && fabs(place->gravity[j] * square + place->inertia[j]) <= square;
    }
    return is_within;
}

static aisle_cost_pair cost(void *context, const float *x) {
    const aisle_arm_time *self = (const aisle_arm_time *)context;
    bool is_within = true;
    for (uint32_t i = 0; i < AISLE_ARM_TIME_PLACES && is_within; i++) {
        is_within = is_held(&self->place[i], self->links, (double)x[0]);
    }
    return (aisle_cost_pair){.violation = is_within ? 0.0F : INFINITY, .value = x[0]};
}

void aisle_arm_time_start(aisle_arm_time *self, const aisle_arm *arm, const aisle_arm_dynamics *dynamics,
                          const aisle_arm_piece *piece, uint64_t seed) {
    for (uint32_t i = 0; i < AISLE_ARM_TIME_PLACES; i++) {
        fill(arm, dynamics, piece, (double)i / (double)(AISLE_ARM_TIME_PLACES - 1U), &self->place[i]);
    }
    self->links = arm->links;
    self->lo = 0.0F;
    self->hi = (float)AISLE_ARM_TIME_MOST;
    aisle_ga_config cfg = aisle_arm_paper_ga(GENERATIONS);
    cfg.cost = cost;
    cfg.cost_ctx = self;
    cfg.lo = &self->lo;
    cfg.hi = &self->hi;
    cfg.genes = 1U;
    cfg.redraw = false;
    cfg.seed = seed;
    const aisle_status st = aisle_ga_start(&self->ga, &cfg);
    AISLE_ASSERT(st == AISLE_OK);
}

aisle_status aisle_arm_time_step(aisle_arm_time *self, uint32_t units, uint32_t *spent, double *duration) {
    aisle_status st = AISLE_BUSY;
    for (uint32_t used = 0; st == AISLE_BUSY && used < units; used += AISLE_ARM_TIME_UNITS) {
        st = aisle_ga_step(&self->ga, CANDIDATES);
        *spent += AISLE_ARM_TIME_UNITS;
    }
    if (st == AISLE_BUSY) {
        return AISLE_BUSY;
    }
    const float *best = aisle_ga_best(&self->ga);
    if (best == NULL) {
        return AISLE_PARTIAL;
    }
    *duration = (double)best[0];
    return AISLE_OK;
}
