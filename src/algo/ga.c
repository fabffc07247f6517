#include "algo/ga.h"

#include "algo/box.h"
#include "base/check.h"

#include <math.h>

#define REACH 0.1F
#define BLEND 0.5 // alpha of BLX
#define SIZES 16U // of a mutation

void aisle_ga_carve(aisle_ga *self, aisle_arena *arena, uint16_t genes, uint16_t population) {
    const size_t all = (size_t)genes * population;
    void *parent = aisle_arena_take(arena, all, sizeof(aisle_ga_gene));
    void *child = aisle_arena_take(arena, all, sizeof(aisle_ga_gene));
    void *parent_cost = aisle_arena_take(arena, population, sizeof(aisle_cost_pair));
    void *child_cost = aisle_arena_take(arena, population, sizeof(aisle_cost_pair));
    void *order = aisle_arena_take(arena, population, sizeof(uint16_t));
    void *x = aisle_arena_take(arena, genes, sizeof(float));
    void *best = aisle_arena_take(arena, genes, sizeof(float));
    if (self == NULL) {
        return;
    }
    *self = (aisle_ga){.parent = (aisle_ga_gene *)parent,
                       .child = (aisle_ga_gene *)child,
                       .parent_cost = (aisle_cost_pair *)parent_cost,
                       .child_cost = (aisle_cost_pair *)child_cost,
                       .order = (uint16_t *)order,
                       .x = (float *)x,
                       .best = (float *)best,
                       .genes_capacity = genes,
                       .population_capacity = population};
}

aisle_ga_config aisle_ga_paper(uint32_t generations) {
    return (aisle_ga_config){.coding = AISLE_GA_BINARY,
                             .crossover = AISLE_GA_UNIFORM,
                             .mutation = AISLE_GA_EACH,
                             .pc = 0.8F,
                             .pm = 0.9F,
                             .generation_max = generations,
                             .value_goal = -INFINITY,
                             .population = 80,
                             .elite = 2,
                             .bit = 40};
}

aisle_ga_config aisle_ga_modern(uint16_t genes, uint32_t generations) {
    return (aisle_ga_config){.coding = AISLE_GA_REAL,
                             .crossover = AISLE_GA_BLEND,
                             .mutation = AISLE_GA_EACH,
                             .pc = 0.9F,
                             .pm = genes > 0U ? 1.0F / (float)genes : 0.0F,
                             .generation_max = generations,
                             .value_goal = -INFINITY,
                             .genes = genes,
                             .population = 40,
                             .elite = 2};
}

// ---- coding

static uint64_t code_max(const aisle_ga_config *cfg) {
    return ((uint64_t)1 << cfg->bit) - 1U;
}

// Eq. 3 of the paper, and 4b.
static uint64_t encode(const aisle_ga_config *cfg, uint32_t i, float x) {
    const double lo = (double)cfg->lo[i], hi = (double)cfg->hi[i];
    const uint64_t most = code_max(cfg);
    const double code = ((double)x - lo) / (hi - lo) * (double)most; // lo < hi
    return code >= (double)most ? most : (uint64_t)code;
}

static float decode(const aisle_ga_config *cfg, uint32_t i, uint64_t code) {
    const double lo = (double)cfg->lo[i], hi = (double)cfg->hi[i];
    return aisle_box_clamp((float)((double)code * (hi - lo) / (double)code_max(cfg) + lo), cfg->lo[i], cfg->hi[i]);
}

static float value_of(const aisle_ga_config *cfg, uint32_t i, aisle_ga_gene gene) {
    return cfg->coding == AISLE_GA_BINARY ? decode(cfg, i, gene.code) : gene.x;
}

static aisle_ga_gene gene_of(const aisle_ga_config *cfg, uint32_t i, float x) {
    aisle_ga_gene gene = {.code = 0};
    if (cfg->coding == AISLE_GA_BINARY) {
        gene.code = encode(cfg, i, x);
    } else {
        gene.x = x;
    }
    return gene;
}

static aisle_ga_gene *point_of(const aisle_ga *self, aisle_ga_gene *genes, uint32_t point) {
    return genes + (size_t)point * self->cfg.genes;
}

// ---- start

static bool box_is_good(const aisle_ga_config *cfg) {
    for (uint32_t i = 0; cfg->seeds != NULL && i < (uint32_t)cfg->seed_count * cfg->genes; i++) {
        if (!isfinite(cfg->seeds[i])) {
            return false;
        }
    }
    return aisle_box_is_good(cfg->lo, cfg->hi, cfg->genes);
}

static bool rates_are_good(const aisle_ga_config *cfg) {
    return aisle_box_within(cfg->pc, 0.0F, 1.0F) && aisle_box_within(cfg->pm, 0.0F, 1.0F) &&
           aisle_box_within(cfg->reach, 0.0F, 1.0F) && aisle_box_within(cfg->spread, 0.0F, AISLE_BOX_MAX) &&
           !isnan(cfg->value_goal);
}

static bool ways_are_good(const aisle_ga_config *cfg) {
    const bool is_real = cfg->coding == AISLE_GA_REAL;
    return (is_real || (cfg->coding == AISLE_GA_BINARY && cfg->bit >= 1U && cfg->bit <= AISLE_GA_BIT_MAX)) &&
           (cfg->crossover == AISLE_GA_UNIFORM || (is_real && cfg->crossover == AISLE_GA_BLEND)) &&
           (cfg->mutation == AISLE_GA_EACH || cfg->mutation == AISLE_GA_ONE);
}

static bool config_is_good(const aisle_ga_config *cfg) {
    return cfg->cost != NULL && cfg->lo != NULL && cfg->hi != NULL && cfg->genes >= 1U &&
           cfg->genes <= AISLE_GA_GENES_MAX && cfg->population >= 2U && cfg->population <= AISLE_GA_POPULATION_MAX &&
           cfg->generation_max <= AISLE_GA_GENERATIONS_MAX && cfg->elite < cfg->population &&
           cfg->parents <= cfg->population && cfg->seed_count <= cfg->population &&
           (cfg->seeds != NULL || cfg->seed_count == 0U) && rates_are_good(cfg) && ways_are_good(cfg) &&
           box_is_good(cfg);
}

static double random_of(aisle_ga *self) {
    return (double)aisle_rng_float(&self->rng);
}

static bool chance(aisle_ga *self, float p) {
    return aisle_rng_float(&self->rng) < p;
}

static uint64_t bits_of(aisle_ga *self) {
    const uint64_t high = aisle_rng_next(&self->rng);
    return high << 32U | aisle_rng_next(&self->rng);
}

static aisle_ga_gene draw(aisle_ga *self, uint32_t i) {
    const aisle_ga_config *cfg = &self->cfg;
    const double lo = (double)cfg->lo[i], hi = (double)cfg->hi[i];
    aisle_ga_gene gene = {.code = 0};
    if (cfg->coding == AISLE_GA_BINARY) {
        gene.code = bits_of(self) & code_max(cfg);
    } else {
        gene.x = aisle_box_clamp((float)(lo + random_of(self) * (hi - lo)), cfg->lo[i], cfg->hi[i]);
    }
    return gene;
}

// A seed, a point near one, or one from anywhere.
static void place(aisle_ga *self, uint32_t point) {
    const aisle_ga_config *cfg = &self->cfg;
    aisle_ga_gene *genes = point_of(self, self->child, point);
    const bool is_seed = point < cfg->seed_count;
    const bool is_near = !is_seed && cfg->seed_count > 0U && cfg->spread > 0.0F;
    const float *seed = is_seed || is_near ? cfg->seeds + (size_t)(point % cfg->seed_count) * cfg->genes : NULL;
    for (uint32_t i = 0; i < cfg->genes; i++) {
        if (seed == NULL) {
            genes[i] = draw(self, i);
            continue;
        }
        const double span = (double)cfg->hi[i] - (double)cfg->lo[i];
        const double off = is_near ? (2.0 * random_of(self) - 1.0) * (double)cfg->spread * span : 0.0;
        const double at = (double)seed[i] + off;
        const double lo = (double)cfg->lo[i], hi = (double)cfg->hi[i];
        genes[i] = gene_of(cfg, i, (float)(at < lo ? lo : (at > hi ? hi : at)));
    }
}

aisle_status aisle_ga_start(aisle_ga *self, const aisle_ga_config *cfg) {
    if (cfg == NULL || !config_is_good(cfg)) {
        return AISLE_ERR_ARG;
    }
    if (cfg->genes > self->genes_capacity || cfg->population > self->population_capacity) {
        return AISLE_ERR_CAPACITY;
    }
    self->cfg = *cfg;
    self->rng = aisle_rng_seed(cfg->seed);
    self->evals = self->nan_costs = self->best_updates = 0;
    self->generation = self->last_improvement = 0;
    self->best_cost = aisle_cost_pair_not_allowed();
    self->next = 0;
    self->ended = AISLE_BUSY;
    for (uint32_t point = 0; point < cfg->population; point++) {
        place(self, point);
    }
    return AISLE_OK;
}

// ---- breeding

static const aisle_ga_gene *select_parent(aisle_ga *self) {
    const uint32_t parents = self->cfg.parents > 0U ? self->cfg.parents : self->cfg.population;
    const uint32_t a = aisle_rng_below(&self->rng, parents), b = aisle_rng_below(&self->rng, parents);
    return point_of(self, self->parent, self->order[a < b ? a : b]); // the better one comes first
}

static void swap_bits(aisle_ga *self, aisle_ga_gene *a, aisle_ga_gene *b) {
    const uint64_t differ = (a->code ^ b->code) & bits_of(self);
    a->code ^= differ;
    b->code ^= differ;
}

static float blend(aisle_ga *self, uint32_t i, float a, float b) {
    const double least = (double)(a < b ? a : b), most = (double)(a < b ? b : a);
    const double at = least + (random_of(self) * (1.0 + 2.0 * BLEND) - BLEND) * (most - least);
    return aisle_box_clamp((float)at, self->cfg.lo[i], self->cfg.hi[i]);
}

static void cross(aisle_ga *self, uint32_t i, aisle_ga_gene *a, aisle_ga_gene *b) {
    const aisle_ga_gene first = *a, second = *b;
    if (self->cfg.coding == AISLE_GA_BINARY) {
        swap_bits(self, a, b);
    } else if (self->cfg.crossover == AISLE_GA_BLEND) {
        a->x = blend(self, i, first.x, second.x);
        b->x = blend(self, i, first.x, second.x);
    } else if (chance(self, 0.5F)) {
        *a = second;
        *b = first;
    }
}

static void mutate_real(aisle_ga *self, uint32_t i, aisle_ga_gene *gene) {
    const aisle_ga_config *cfg = &self->cfg;
    if (cfg->redraw) {
        *gene = draw(self, i);
        return;
    }
    const double reach = (double)(cfg->reach > 0.0F ? cfg->reach : REACH);
    const double span = (double)cfg->hi[i] - (double)cfg->lo[i];
    const double shrink = (double)(1U << aisle_rng_below(&self->rng, SIZES));
    const double move = (2.0 * random_of(self) - 1.0) * reach * span / shrink;
    gene->x = aisle_box_clamp((float)((double)gene->x + move), cfg->lo[i], cfg->hi[i]);
}

static void mutate_each(aisle_ga *self, aisle_ga_gene *genes) {
    const aisle_ga_config *cfg = &self->cfg;
    for (uint32_t i = 0; i < cfg->genes; i++) {
        if (cfg->coding == AISLE_GA_REAL) {
            if (chance(self, cfg->pm)) {
                mutate_real(self, i, &genes[i]);
            }
            continue;
        }
        for (uint32_t k = 0; k < cfg->bit; k++) {
            genes[i].code ^= (uint64_t)(chance(self, cfg->pm) ? 1U : 0U) << k;
        }
    }
}

static void mutate(aisle_ga *self, aisle_ga_gene *genes) {
    const aisle_ga_config *cfg = &self->cfg;
    if (cfg->mutation == AISLE_GA_EACH) {
        mutate_each(self, genes);
    } else if (chance(self, cfg->pm)) {
        const uint32_t i = aisle_rng_below(&self->rng, cfg->genes);
        if (cfg->coding == AISLE_GA_REAL) {
            mutate_real(self, i, &genes[i]);
        } else {
            genes[i].code ^= (uint64_t)1 << aisle_rng_below(&self->rng, cfg->bit);
        }
    }
}

// A pair of children, from `point` on; of the last one the second may have no place.
static void breed(aisle_ga *self, uint32_t point) {
    const aisle_ga_config *cfg = &self->cfg;
    const bool is_pair = point + 1U < cfg->population;
    const aisle_ga_gene *parent[2];
    parent[0] = select_parent(self);
    parent[1] = select_parent(self);
    const bool crossed = chance(self, cfg->pc);
    aisle_ga_gene *first = point_of(self, self->child, point);
    aisle_ga_gene *second = is_pair ? point_of(self, self->child, point + 1U) : NULL;
    for (uint32_t i = 0; i < cfg->genes; i++) {
        aisle_ga_gene a = parent[0][i], b = parent[1][i];
        if (crossed) {
            cross(self, i, &a, &b);
        }
        first[i] = a;
        if (is_pair) {
            second[i] = b;
        }
    }
    mutate(self, first);
    if (is_pair) {
        mutate(self, second);
    }
}

// ---- generations

// Insertion: the order of the generation before is no help, but a population is small.
static void rank(aisle_ga *self) {
    for (uint32_t i = 0; i < self->cfg.population; i++) {
        uint32_t at = i;
        while (at > 0U && aisle_cost_pair_better(self->parent_cost[i], self->parent_cost[self->order[at - 1U]])) {
            self->order[at] = self->order[at - 1U];
            at--;
        }
        self->order[at] = (uint16_t)i;
    }
}

static void next_generation(aisle_ga *self) {
    const aisle_ga_config *cfg = &self->cfg;
    aisle_ga_gene *genes = self->parent;
    aisle_cost_pair *cost = self->parent_cost;
    self->parent = self->child;
    self->parent_cost = self->child_cost;
    self->child = genes;
    self->child_cost = cost;
    self->generation++;
    rank(self);
    for (uint32_t k = 0; k < cfg->elite; k++) {
        const aisle_ga_gene *from = point_of(self, self->parent, self->order[k]);
        aisle_ga_gene *to = point_of(self, self->child, k);
        for (uint32_t i = 0; i < cfg->genes; i++) {
            to[i] = from[i];
        }
        self->child_cost[k] = self->parent_cost[self->order[k]];
    }
    self->next = cfg->elite;
}

// The child to ask about is made, with its twin, when its turn comes.
static void make(aisle_ga *self) {
    if (self->generation == 0U) {
        return;
    }
    if (!aisle_cost_pair_is_allowed(self->best_cost)) {
        for (uint32_t i = 0; i < self->cfg.genes; i++) {
            point_of(self, self->child, self->next)[i] = draw(self, i);
        }
    } else if ((self->next - self->cfg.elite) % 2 == 0) {
        breed(self, self->next);
    }
}

static void learn(aisle_ga *self, aisle_cost_pair cost) {
    self->child_cost[self->next] = cost;
    if (!aisle_cost_pair_better(cost, self->best_cost)) {
        return;
    }
    self->best_cost = cost;
    self->best_updates++;
    self->last_improvement = self->evals;
    for (uint32_t i = 0; i < self->cfg.genes; i++) {
        self->best[i] = self->x[i];
    }
}

static aisle_cost_pair ask(aisle_ga *self) {
    const aisle_ga_config *cfg = &self->cfg;
    const aisle_ga_gene *genes = point_of(self, self->child, self->next);
    for (uint32_t i = 0; i < cfg->genes; i++) {
        self->x[i] = value_of(cfg, i, genes[i]);
    }
    const aisle_cost_pair cost = cfg->cost(cfg->cost_ctx, self->x);
    self->evals++;
    self->nan_costs += aisle_cost_pair_is_nan(cost) ? 1U : 0U;
    return aisle_cost_pair_read(cost);
}

uint32_t aisle_ga_evals_max(const aisle_ga_config *cfg) {
    return cfg->population + cfg->generation_max * (uint32_t)(cfg->population - cfg->elite);
}

static aisle_status verdict(const aisle_ga *self) {
    const aisle_ga_config *cfg = &self->cfg;
    if (aisle_cost_pair_is_allowed(self->best_cost) && self->best_cost.violation <= 0.0F &&
        self->best_cost.value <= cfg->value_goal) {
        return AISLE_OK;
    }
    const bool stalled = cfg->stall_max > 0U && self->evals - self->last_improvement >= cfg->stall_max;
    return self->evals >= aisle_ga_evals_max(cfg) || stalled ? AISLE_PARTIAL : AISLE_BUSY;
}

aisle_status aisle_ga_step(aisle_ga *self, uint32_t evals) {
    if (self->cfg.cost == NULL) {
        return AISLE_ERR_ARG;
    }
    for (uint32_t spent = 0; spent < evals && self->ended == AISLE_BUSY; spent++) {
        if (self->next == self->cfg.population) {
            next_generation(self);
        }
        AISLE_ASSERT(self->next < self->cfg.population);
        make(self);
        learn(self, ask(self));
        self->next++;
        self->ended = verdict(self);
    }
    return self->ended;
}

const float *aisle_ga_best(const aisle_ga *self) {
    return self->cfg.cost != NULL && aisle_cost_pair_is_allowed(self->best_cost) ? self->best : NULL;
}

// ---- invariants

static bool point_holds(const aisle_ga *self, const aisle_ga_gene *genes) {
    const aisle_ga_config *cfg = &self->cfg;
    for (uint32_t i = 0; i < cfg->genes; i++) {
        const bool is_good = cfg->coding == AISLE_GA_BINARY ? genes[i].code <= code_max(cfg)
                                                            : aisle_box_within(genes[i].x, cfg->lo[i], cfg->hi[i]);
        if (!is_good) {
            return false;
        }
    }
    return true;
}

static bool cost_holds(const aisle_ga *self, aisle_cost_pair cost) {
    return cost.violation >= 0.0F && !aisle_cost_pair_is_nan(cost) && !aisle_cost_pair_better(cost, self->best_cost);
}

static bool parents_hold(const aisle_ga *self) {
    const aisle_ga_config *cfg = &self->cfg;
    for (uint32_t k = 0; self->generation > 0U && k < cfg->population; k++) {
        if (self->order[k] >= cfg->population || !cost_holds(self, self->parent_cost[k]) ||
            !point_holds(self, point_of(self, self->parent, k))) {
            return false;
        }
        if (k > 0U &&
            aisle_cost_pair_better(self->parent_cost[self->order[k]], self->parent_cost[self->order[k - 1U]])) {
            return false;
        }
    }
    return true;
}

bool aisle_ga_invariants_hold(const aisle_ga *self) {
    const aisle_ga_config *cfg = &self->cfg;
    if (cfg->cost == NULL) {
        return true; // never started
    }
    if (self->next > cfg->population || self->generation > cfg->generation_max ||
        self->evals > aisle_ga_evals_max(cfg) || self->nan_costs > self->evals || self->best_updates > self->evals ||
        self->last_improvement > self->evals ||
        aisle_cost_pair_is_allowed(self->best_cost) != (self->best_updates > 0U) || self->ended != verdict(self)) {
        return false;
    }
    for (uint32_t k = 0; k < self->next; k++) {
        if (!cost_holds(self, self->child_cost[k]) || !point_holds(self, point_of(self, self->child, k))) {
            return false;
        }
    }
    for (uint32_t i = 0; self->best_updates > 0U && i < cfg->genes; i++) {
        if (!aisle_box_within(self->best[i], cfg->lo[i], cfg->hi[i])) {
            return false;
        }
    }
    return parents_hold(self);
}
