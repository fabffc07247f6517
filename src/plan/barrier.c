#include "plan/barrier.h"

#include "base/check.h"
#include "plan/cost.h"

#include <math.h>

#define SEED_DEFAULT 20100501U
#define SHORTEST_SEED 0.2 // m
#define SPREAD 0.1F       // of the box, about the seed

void aisle_barrier_carve(aisle_barrier *self, aisle_arena *arena) {
    aisle_ga_carve(self != NULL ? &self->ga : NULL, arena, AISLE_BARRIER_STATIONS, AISLE_BARRIER_POPULATION);
}

// ---- a way

static void lay(aisle_barrier *self, const float *genes) {
    self->offset[0] = self->offset[self->count - 1U] = 0.0;
    self->way[0] = self->base[0];
    self->way[self->count - 1U] = self->base[self->count - 1U];
    for (uint32_t i = 1; i + 1U < self->count; i++) {
        self->offset[i] = (double)genes[i - 1U];
        self->way[i] = aisle_vec2_add(self->base[i], aisle_vec2_scale(self->across[i], self->offset[i]));
    }
}

static bool piece_free(aisle_barrier *self, uint32_t i) {
    return aisle_space_sweep_free(self->space, self->way[i], self->way[i + 1U], &self->units);
}

// A body held along its motion must be able to turn at a corner.
static bool station_free(aisle_barrier *self, uint32_t i) {
    return self->space->mode == AISLE_SPACE_FREE_TURN || self->offset[i] == 0.0 ||
           aisle_space_turn_free(self->space, self->way[i], &self->units);
}

// Pieces at a station that moves are to be looked at again.
static void shrink(aisle_barrier *self, uint32_t i, double by, bool *is_free) {
    if (self->offset[i] != 0.0) {
        self->offset[i] *= by;
        self->way[i] = aisle_vec2_add(self->base[i], aisle_vec2_scale(self->across[i], self->offset[i]));
        is_free[i - 1U] = is_free[i] = false;
    }
}

// Once through: offsets of pieces that are not free times `by`. True: there was none.
static bool repair_once(aisle_barrier *self, double by, bool *is_free) {
    bool all = true;
    for (uint32_t i = 0; i + 1U < self->count; i++) {
        if (is_free[i] || (self->offset[i] == 0.0 && self->offset[i + 1U] == 0.0)) {
            continue; // as it lies on the seed
        }
        is_free[i] = station_free(self, i) && station_free(self, i + 1U) && piece_free(self, i);
        if (!is_free[i]) {
            shrink(self, i, by, is_free);
            shrink(self, i + 1U, by, is_free);
            all = false;
        }
    }
    return all;
}

// Ends: each round after the halvings sets an offset to 0 that was not, or is the last.
static void repair(aisle_barrier *self) {
    bool is_free[AISLE_BARRIER_POINTS] = {false}; // piece by piece: looked at as it lies
    for (uint32_t round = 0; round < AISLE_BARRIER_HALVINGS + AISLE_BARRIER_POINTS; round++) {
        if (repair_once(self, round < AISLE_BARRIER_HALVINGS ? 0.5 : 0.0, is_free)) {
            return;
        }
    }
    AISLE_ASSERT(false);
}

static double length_of(const aisle_barrier *self) {
    double sum = 0.0;
    for (uint32_t i = 0; i + 1U < self->count; i++) {
        sum += aisle_vec2_distance(self->way[i], self->way[i + 1U]);
    }
    return sum;
}

static uint32_t crossing_of(aisle_barrier *self) {
    uint32_t k = 0;
    for (uint32_t i = 0; i + 1U < self->count; i++) {
        k += piece_free(self, i) ? 0U : 1U;
    }
    return k;
}

static aisle_cost_pair paper_cost(void *ctx, const float *x) {
    aisle_barrier *self = (aisle_barrier *)ctx;
    lay(self, x);
    self->units++;
    return (aisle_cost_pair){0.0F, (float)(length_of(self) + AISLE_BARRIER_PENALTY * (double)crossing_of(self))};
}

static aisle_cost_pair cost(void *ctx, const float *x) {
    aisle_barrier *self = (aisle_barrier *)ctx;
    double value = 0.0;
    lay(self, x);
    repair(self);
    self->units++;
    for (uint32_t i = 0; i + 1U < self->count; i++) {
        value += aisle_leg_cost(self->space, self->objective, self->way[i], self->way[i + 1U], &self->units);
    }
    return (aisle_cost_pair){0.0F, (float)value};
}

// ---- stations

static double spacing_of(const aisle_options_msg *options) {
    return options->step > 0.0F ? (double)options->step : AISLE_BARRIER_STEP;
}

// Evenly along one axis, the genes being the other coordinate.
static void divide_axis(aisle_barrier *self, double spacing, aisle_vec2 start, aisle_vec2 goal) {
    const bool along_x = fabs(goal.x - start.x) >= fabs(goal.y - start.y);
    const double from = along_x ? start.x : start.y, to = along_x ? goal.x : goal.y;
    const double most = (double)(AISLE_BARRIER_STATIONS + 1U);
    const double pieces = aisle_clamp(floor(fabs(to - from) / spacing + 0.5), 2.0, most);
    self->count = (uint32_t)pieces + 1U;
    for (uint32_t i = 0; i < self->count; i++) {
        const double at = from + (to - from) * (double)i / pieces;
        self->base[i] = along_x ? aisle_vec2_of(at, 0.0) : aisle_vec2_of(0.0, at);
        self->across[i] = along_x ? aisle_vec2_of(0.0, 1.0) : aisle_vec2_of(1.0, 0.0);
    }
    self->base[0] = start;
    self->base[self->count - 1U] = goal;
    const aisle_aabb bounds = aisle_layout_bounds(self->space->layout);
    for (uint32_t i = 0; i + 2U < self->count; i++) {
        self->lo[i] = (float)(along_x ? bounds.lo.y : bounds.lo.x);
        self->hi[i] = (float)(along_x ? bounds.hi.y : bounds.hi.x);
    }
}

static void add_station(aisle_barrier *self, aisle_vec2 base, aisle_vec2 along) {
    const double norm = aisle_vec2_length(along);
    self->base[self->count] = base;
    self->across[self->count] = norm > 1e-9 ? aisle_vec2_of(-along.y / norm, along.x / norm) : aisle_vec2_of(0.0, 0.0);
    self->count++;
}

static aisle_vec2 unit_of(aisle_vec2 v) {
    const double norm = aisle_vec2_length(v);
    return norm > 1e-9 ? aisle_vec2_scale(v, 1.0 / norm) : aisle_vec2_of(0.0, 0.0);
}

// Every inner point of the seed, and others evenly between; at a corner across its bisector.
static void divide_seed(aisle_barrier *self, double spacing, const aisle_vec2 *points, uint32_t count) {
    self->count = 0;
    add_station(self, points[0], aisle_vec2_of(0.0, 0.0));
    for (uint32_t i = 0; i + 1U < count; i++) {
        const aisle_vec2 along = aisle_vec2_sub(points[i + 1U], points[i]);
        const double pieces = aisle_max(-floor(-aisle_vec2_length(along) / spacing), 1.0);
        for (double k = 1.0; k < pieces; k += 1.0) {
            add_station(self, aisle_vec2_lerp(points[i], points[i + 1U], k / pieces), along);
        }
        const bool is_last = i + 2U == count;
        const aisle_vec2 next = is_last ? aisle_vec2_of(0.0, 0.0) : aisle_vec2_sub(points[i + 2U], points[i + 1U]);
        add_station(self, points[i + 1U],
                    is_last ? aisle_vec2_of(0.0, 0.0) : aisle_vec2_add(unit_of(along), unit_of(next)));
    }
    AISLE_ASSERT(self->count <= AISLE_BARRIER_POINTS);
    for (uint32_t i = 0; i + 2U < self->count; i++) {
        self->lo[i] = -AISLE_BARRIER_REACH;
        self->hi[i] = AISLE_BARRIER_REACH;
        self->seed[i] = 0.0F;
    }
}

// ---- runs

static void run(aisle_barrier *self, aisle_ga_config config, const aisle_options_msg *options) {
    config.cost_ctx = self;
    config.lo = self->lo;
    config.hi = self->hi;
    config.genes = (uint16_t)(self->count - 2U);
    config.seed = options->seed != 0 ? (uint64_t)(uint32_t)options->seed : SEED_DEFAULT;
    self->units = 0;
    const aisle_status st = aisle_ga_start(&self->ga, &config);
    AISLE_ASSERT(st == AISLE_OK);
}

aisle_status aisle_barrier_start_paper(aisle_barrier *self, const aisle_space *space, const aisle_options_msg *options,
                                       aisle_vec2 start, aisle_vec2 goal) {
    if (!(aisle_vec2_distance(start, goal) >= 1e-6)) {
        return AISLE_ERR_ARG;
    }
    self->space = space;
    self->objective = NULL;
    divide_axis(self, spacing_of(options), start, goal);
    aisle_ga_config config =
        aisle_ga_paper(options->num_samples > 0 ? (uint32_t)options->num_samples : AISLE_BARRIER_GENERATIONS_PAPER);
    config.cost = paper_cost;
    run(self, config, options);
    return AISLE_OK;
}

// Are all pieces between the stations free as they lie on the seed?
static bool seed_is_free(aisle_barrier *self) {
    lay(self, self->seed);
    return crossing_of(self) == 0U;
}

aisle_status aisle_barrier_start(aisle_barrier *self, const aisle_space *space, const aisle_objective *objective,
                                 const aisle_options_msg *options, const aisle_vec2 *points, uint32_t count) {
    double length = 0.0;
    for (uint32_t i = 0; i + 1U < count; i++) {
        length += aisle_vec2_distance(points[i], points[i + 1U]);
    }
    if (length < SHORTEST_SEED || count > AISLE_BARRIER_STATIONS / 2U) {
        return AISLE_PARTIAL;
    }
    const double room = (double)(AISLE_BARRIER_STATIONS - count);
    self->space = space;
    self->objective = objective;
    divide_seed(self, aisle_max(aisle_min(spacing_of(options), 0.5 * length), length / room), points, count);
    if (!seed_is_free(self)) {
        return AISLE_PARTIAL;
    }
    aisle_ga_config config = aisle_ga_modern((uint16_t)(self->count - 2U), AISLE_BARRIER_GENERATIONS);
    config.cost = cost;
    config.population = AISLE_BARRIER_OURS;
    config.stall_max = AISLE_BARRIER_STALL;
    config.seeds = self->seed;
    config.seed_count = 1;
    config.spread = SPREAD;
    run(self, config, options);
    return AISLE_OK;
}

aisle_status aisle_barrier_step(aisle_barrier *self, uint32_t units, uint32_t *spent) {
    aisle_status st = AISLE_BUSY;
    while (st == AISLE_BUSY && self->units < units) {
        st = aisle_ga_step(&self->ga, 1U);
    }
    *spent += self->units;
    self->units = 0;
    return st == AISLE_BUSY ? AISLE_BUSY : AISLE_OK;
}

// Lays the best way again, repaired as it was.
static bool lay_best(aisle_barrier *self) {
    const float *best = aisle_ga_best(&self->ga);
    if (best == NULL) {
        return false;
    }
    lay(self, best);
    if (self->objective != NULL) {
        repair(self);
    }
    return true;
}

bool aisle_barrier_figures_of(aisle_barrier *self, aisle_barrier_figures *out) {
    const uint32_t units = self->units;
    if (!lay_best(self)) {
        return false;
    }
    *out = (aisle_barrier_figures){length_of(self), crossing_of(self)};
    self->units = units; // asking is not work of the run
    return true;
}

uint32_t aisle_barrier_best(aisle_barrier *self, aisle_vec2 *points) {
    aisle_barrier_figures figures;
    if (!aisle_barrier_figures_of(self, &figures) || figures.crossing > 0U) {
        return 0;
    }
    for (uint32_t i = 0; i < self->count; i++) {
        points[i] = self->way[i];
    }
    return self->count;
}
