// ga.h - genetic minimiser over a box. Level 2: knows no robots, maps, units or time.
//
// Method (Holland 1975, Goldberg 1989): from a population of points the next one is bred: two parents, each the better
// of two drawn at random (tournament), have a pair of children; crossed with probability pc, then mutated with pm; the
// best `elite` points live on as they are.
// BINARY coding (Chiu 2010, "Numerical assessment of path planning ... using a genetic algorithm", eq. 3 and 4b): a gene
// is a whole number of `bit` bits, 0 at lo, 2^bit - 1 at hi. Uniform crossover: the children swap each bit with
// probability 1/2. A mutated bit flips.
// REAL coding: UNIFORM swaps each gene with probability 1/2; BLEND is BLX-0.5 (Eshelman & Schaffer 1993): each child's
// gene is drawn from the parents' span, widened by half of it on both sides. A mutated gene moves by +- reach * (hi - lo)
// * r * 2^-k, r uniform in [0, 1), k one of 0..15 (the spread of sizes of the breeder's algorithm, Muehlenbein &
// Schlierkamp-Voosen 1993), or with `redraw` is drawn anew from the box.
// Costs are pairs (cost_pair.h). Points stay in the box by clamping. Until an allowed point has been seen each population is
// drawn anew. Seeds are the first points of the first population, so the result is never worse than any of them.
// Only ranks are compared, so no cost can be too small or too large for selection.
//
// Memory: from the arena, 16 bytes a gene and 18 bytes a point, for the numbers given there; cfg is copied, lo, hi and
// seeds are the caller's until the run ends. Time: step() O(evals * genes), a generation's ranking O(population^2) at most,
// plus `evals` calls of cost(); start() O(population * genes). No recursion. Objects share nothing.
// Determinism: same cfg and seed give the same bits, however the run is cut into steps.
// Hits of seeds (tests/algo/test_ga.c), aisle_ga_modern(): bowl with its minimum on the wall, 150 generations to 1e-6, 200 of
// 200; Rosenbrock in 2 dimensions, 1000 generations to 1e-4, 100 of 100; Rastrigin in 3 dimensions, 400 generations to 1e-3,
// 50 of 50. Binary with one bit of a chromosome mutated on the average: the bowl, 300 generations of 80 to 1e-4, 100 of 100.
#ifndef AISLE_ALGO_GA_H
#define AISLE_ALGO_GA_H

#include "aisle/status.h"
#include "algo/cost_pair.h"
#include "base/arena.h"
#include "base/rng.h"

#include <stdbool.h>
#include <stdint.h>

#define AISLE_GA_GENES_MAX 1024U
#define AISLE_GA_POPULATION_MAX 256U
#define AISLE_GA_GENERATIONS_MAX 10000000U
#define AISLE_GA_BIT_MAX 63U

typedef enum aisle_ga_coding { AISLE_GA_REAL, AISLE_GA_BINARY } aisle_ga_coding;
typedef enum aisle_ga_crossover { AISLE_GA_UNIFORM, AISLE_GA_BLEND } aisle_ga_crossover; // BLEND: REAL only

typedef enum aisle_ga_mutation {
    AISLE_GA_EACH, // each gene (BINARY: each bit) mutates with probability pm
    AISLE_GA_ONE   // with probability pm one gene (BINARY: one bit) of a child does
} aisle_ga_mutation;

typedef struct aisle_ga_config {
    aisle_cost_pair_fn cost; // must not call back into the same aisle_ga
    void *cost_ctx;          // passed through, may be NULL
    const float *lo, *hi;    // [genes] box, unit of x[i]; -1e30 <= lo[i] < hi[i] <= 1e30
    const float *seeds;      // [seed_count * genes] points of the first population, finite, clamped; NULL: none
    float spread; // its others lie within +- spread * (hi - lo) of the seeds in turn; 0 or no seeds = whole box
    aisle_ga_coding coding;
    aisle_ga_crossover crossover;
    aisle_ga_mutation mutation;
    bool redraw;             // REAL: a mutated gene is drawn anew
    float pc, pm;            // [0, 1]
    float reach;             // REAL, not redraw: of a mutation, in parts of hi - lo; [0, 1], 0 = 0.1
    uint64_t seed;           // any value
    uint32_t generation_max; // bred after the first population, <= AISLE_GA_GENERATIONS_MAX
    uint32_t stall_max;      // end when the best has not improved for so many evaluations; 0 = never
    float value_goal;        // stop when feasible at or below it; -INFINITY = use up generation_max
    uint16_t genes;          // [1, the arena's]
    uint16_t population;     // [2, the arena's]
    uint16_t elite;          // < population: the best, which live on
    uint16_t parents;        // only so many of the best breed, <= population; 0 = all
    uint16_t seed_count;     // <= population
    uint16_t bit;            // BINARY: [1, AISLE_GA_BIT_MAX]
} aisle_ga_config;

typedef union aisle_ga_gene {
    uint64_t code; // BINARY
    float x;       // REAL
} aisle_ga_gene;

// Public so that it can be a static variable. Read the counters; write nothing.
typedef struct aisle_ga {
    aisle_ga_config cfg;
    aisle_ga_gene *parent, *child;             // [population * genes]
    aisle_cost_pair *parent_cost, *child_cost; // [population]
    uint16_t *order;                           // [population] of the parents, best first, equal ones by index
    float *x, *best;                           // [genes] point asked about; the best so far
    uint16_t genes_capacity, population_capacity;
    aisle_rng rng;
    uint32_t evals, nan_costs, best_updates; // counters since start()
    uint32_t generation;                     // the children's; 0: the first population
    uint32_t last_improvement;               // evals at that time
    aisle_cost_pair best_cost;               // both INFINITY until an allowed point was seen
    uint16_t next;                           // child to evaluate next
    aisle_status ended;                      // AISLE_BUSY while running
} aisle_ga;

// Takes its memory, for so many genes and points at most. `self` may be NULL, to measure only.
void aisle_ga_carve(aisle_ga *self, aisle_arena *arena, uint16_t genes, uint16_t population);

// The paper's parameters: 80 points of 40 bits a gene, pc 0.8, pm 0.9, the best pair kept; and ours: 40 points,
// BLEND, pc 0.9, one mutation a child on the average, the best pair kept. Cost, box, genes and seed are left to set.
aisle_ga_config aisle_ga_paper(uint32_t generations);
aisle_ga_config aisle_ga_modern(uint16_t genes, uint32_t generations);

// Checks everything, draws the first population, calls no cost. AISLE_ERR_ARG: cfg breaks a rule above;
// AISLE_ERR_CAPACITY: more genes or points than carved for. On error self is unchanged.
aisle_status aisle_ga_start(aisle_ga *self, const aisle_ga_config *cfg);

// Spends at most `evals` calls of cost(). AISLE_BUSY: call again. AISLE_OK: goal met. AISLE_PARTIAL: generation_max bred
// or stalled; best() is still the best seen. Further calls repeat the answer and cost nothing.
// AISLE_ERR_ARG: never started.
aisle_status aisle_ga_step(aisle_ga *self, uint32_t evals);

// Best point so far, [genes], inside the box; NULL while nothing allowed was seen. Valid until start().
const float *aisle_ga_best(const aisle_ga *self);

// Calls of cost() in a whole run that is not ended early.
uint32_t aisle_ga_evals_max(const aisle_ga_config *cfg);

// O(population * genes): true unless memory was overwritten. For asserts and tests.
bool aisle_ga_invariants_hold(const aisle_ga *self);
#endif
