// pso.h - particle swarm minimiser over a box. Level 2: knows no robots, maps, units or time.
//
// Method: global-best swarm,
//     v <- w * v + c1*r1*(p - x) + c2*r2*(g - x),   x <- x + v
// r1, r2 uniform in [0,1) per component; p the particle's best point, g the swarm's best.
// FALLING (Shi & Eberhart 1998): w falls linearly from w_start to w_end over the run, c1 = c2 = 2 by default.
// CONSTRICTION (Clerc & Kennedy 2002, doi:10.1109/4235.985692): w = 0.729844, c1 = c2 = 1.49618.
// Ours, not theirs: x is clamped to the box and the clamped component of v is zeroed; |v| is limited to half the box
// in each component; particles start at rest (Engelbrecht 2012) and follow one another (g is renewed after each
// evaluation, not after each round); until the swarm has seen an allowed point its particles are drawn anew;
// costs are pairs (cost_pair.h).
// The first particle starts at the caller's guess, so the result is never worse than the guess.
// Relocation (Islam et al. 2013): with cfg->relocate a particle that came to a place not allowed is drawn anew, at rest,
// and looked at again at once, so that none is lost; so many times in a row at most, each an evaluation.
//
// Memory: none allocated. The caller owns self, cfg, lo, hi, guess and work until the run ends.
// Time: start() O(particles * dim); step() O(evals * dim) plus `evals` calls of cost(). No recursion. Objects share
// nothing.
// Determinism: same cfg and seed give the same bits, however the run is cut into steps.
// Hits of seeds (tests/algo/test_pso.c), CONSTRICTION / FALLING: bowl with its minimum on the wall, 24 particles, 200 /
// 200 of 200; Rosenbrock in 2 dimensions, 24 particles, 8000 evaluations to 1e-4, 100 / 99 of 100; Rastrigin in 3
// dimensions, 40 particles, 12000 evaluations, 49 / 50 of 50.
#ifndef AISLE_ALGO_PSO_H
#define AISLE_ALGO_PSO_H

#include "aisle/status.h"
#include "algo/cost_pair.h"
#include "base/rng.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifndef AISLE_PSO_DIM_MAX
#define AISLE_PSO_DIM_MAX 64
#endif
#if (AISLE_PSO_DIM_MAX < 1) || (AISLE_PSO_DIM_MAX > 1024)
#error "AISLE_PSO_DIM_MAX must be in [1, 1024]"
#endif
#define AISLE_PSO_PARTICLES_MAX 256

// Floats of scratch for one run: x, v, best x and best cost (2) of every particle, and the global best.
#define AISLE_PSO_WORK_LEN(dim, particles) ((size_t)(particles) * (3U * (size_t)(dim) + 2U) + (size_t)(dim))

typedef enum aisle_pso_inertia { AISLE_PSO_FALLING, AISLE_PSO_CONSTRICTION } aisle_pso_inertia;

typedef struct aisle_pso_config {
    aisle_cost_pair_fn cost; // must not call back into the same aisle_pso
    void *cost_ctx;          // passed through, may be NULL
    const float *lo, *hi;    // [dim] box, unit of x[i]; -1e30 <= lo[i] < hi[i] <= 1e30
    const float *guess;      // [dim] where the first particle starts, finite, clamped to the box; NULL = random
    float spread; // the other particles start within +- spread * (hi - lo) of the guess; 0 or no guess = whole box
    aisle_pso_inertia inertia;
    float w_start, w_end; // FALLING only; 0 and 0 = 0.9 and 0.4
    float c1, c2;         // FALLING only; 0 = 2
    uint64_t seed;        // any value
    uint32_t eval_max;    // calls of cost() in the whole run, >= particles
    uint32_t stall_max;   // end when the best has not improved for so many evaluations; 0 = never
    float value_goal;     // stop when feasible at or below it; -INFINITY = use up eval_max
    uint16_t dim;         // [1, AISLE_PSO_DIM_MAX]
    uint16_t particles;   // [2, AISLE_PSO_PARTICLES_MAX]
    uint16_t relocate;    // times a particle not allowed where it is is drawn anew before it flies on; 0 = never
} aisle_pso_config;

// Public so that it can be a static variable. Read the counters; write nothing.
typedef struct aisle_pso {
    const aisle_pso_config *cfg;
    float *work;
    aisle_rng rng;
    uint32_t evals, nan_costs, best_updates; // counters since start()
    uint32_t relocations;                    // likewise
    uint32_t last_improvement;               // evals at that time
    aisle_cost_pair best_cost;               // both INFINITY until an allowed point was seen
    uint16_t next;                           // particle to evaluate next
    uint16_t tries;                          // times it has been relocated in a row
    aisle_status ended;                      // AISLE_BUSY while running
} aisle_pso;

// Checks everything, writes self and work, calls no cost. AISLE_ERR_ARG: cfg breaks a rule above;
// AISLE_ERR_CAPACITY: work_len < AISLE_PSO_WORK_LEN(dim, particles). On error self is unchanged.
aisle_status aisle_pso_start(aisle_pso *self, const aisle_pso_config *cfg, float *work, size_t work_len);

// Spends at most `evals` calls of cost(). AISLE_BUSY: call again. AISLE_OK: goal met. AISLE_PARTIAL:
// eval_max spent or stalled; best() is still the best seen. Further calls repeat the answer and cost nothing.
// AISLE_ERR_ARG: never started (self all zero).
aisle_status aisle_pso_step(aisle_pso *self, uint32_t evals);

// Best point so far, [dim], inside the box; NULL while nothing allowed was seen. Valid until start().
const float *aisle_pso_best(const aisle_pso *self);

// O(particles * dim): true unless memory was overwritten. For asserts and tests.
bool aisle_pso_invariants_hold(const aisle_pso *self);
#endif
