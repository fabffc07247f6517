// swarm.h - the particle swarm on one leg: via-points around the seed, interpolated, safety first. Level 4.
//
// Variables: offsets (m) of up to AISLE_SWARM_VIAS via-points from points spread along the seed polyline by arc length,
// each in a box of
// +- AISLE_SWARM_REACH. A particle is the spline (or polyline) through start, vias and goal. PAPERS 1: particle =
// via-points, linear or not-a-knot cubic interpolation; ours: samples from the very start, each weighed by the way to its
// neighbours. Cost pair:
// violation = metres of path whose clearance is short of the margin, by how much (sum of shortfall * ds), plus
// curvature above curvature_max; value = integral of the objective's density at clearance and curvature. Where the
// field leaves the margin in doubt the exact gap decides. The first particle is the seed itself; the verifier still
// judges the end. Polish: when the swarm has ended its best place is improved component by component, by steps that are
// halved when none helps: what a swarm finds near a ridge lies beside it.
// Memory: work floats from the arena. Time: evaluations * samples; one unit per
// AISLE_SWARM_SAMPLES_PER_UNIT samples and per exact gap.
#ifndef AISLE_PLAN_SWARM_H
#define AISLE_PLAN_SWARM_H

#include "algo/pso.h"
#include "plan/objective.h"
#include "plan/space.h"
#include "world/spline.h"

#define AISLE_SWARM_VIAS 24U
#define AISLE_SWARM_REACH 1.0 // m
#define AISLE_SWARM_PARTICLES 24U
#define AISLE_SWARM_EVALS 600U
#define AISLE_SWARM_STALL 144U
#define AISLE_SWARM_POLISH_EVALS 320U
#define AISLE_SWARM_POLISH_STEP 0.2F   // m, the first
#define AISLE_SWARM_POLISH_LAST 0.003F // m, a smaller one ends it
#define AISLE_SWARM_SAMPLES_MAX 512U
#define AISLE_SWARM_SAMPLES_PER_UNIT 4U

typedef struct aisle_swarm {
    const aisle_space *space;
    const aisle_objective *objective;
    aisle_spline_kind kind;
    aisle_vec2 start, goal;
    uint32_t vias;
    uint32_t samples; // per particle
    aisle_vec2 base[AISLE_SWARM_VIAS];
    float lo[2 * AISLE_SWARM_VIAS], hi[2 * AISLE_SWARM_VIAS], guess[2 * AISLE_SWARM_VIAS];
    aisle_pso_config config;
    aisle_pso pso;
    float *work; // [AISLE_PSO_WORK_LEN(2 * AISLE_SWARM_VIAS, AISLE_SWARM_PARTICLES)]
    aisle_spline *spline;
    aisle_spline_sample *sample;      // [AISLE_SWARM_SAMPLES_MAX]
    float best[2 * AISLE_SWARM_VIAS]; // polish: where it stands
    aisle_cost_pair best_cost;
    float step;  // m
    uint32_t at; // 2 * component, + 1 for the way back
    uint32_t polish_evals;
    bool heeds_zones;          // there are some that bar or cost
    bool polishing, moved;     // moved: in this round
    aisle_cost_pair seed_cost; // of the first particle, once it was scored: a counter for tests and tables
    uint32_t units;
} aisle_swarm;

void aisle_swarm_carve(aisle_swarm *self, aisle_arena *arena);

// Begins on a leg's polyline points[count]. AISLE_OK, or AISLE_PARTIAL: the leg is too short (below 0.2 m) or has too
// many corners for the via-points; nothing begun.
aisle_status aisle_swarm_start(aisle_swarm *self, const aisle_space *space, const aisle_objective *objective,
                               const aisle_options_msg *options, const aisle_vec2 *points, uint32_t count);

// AISLE_BUSY, then AISLE_OK.
aisle_status aisle_swarm_step(aisle_swarm *self, uint32_t units, uint32_t *spent);

// Cost of the best place so far, polish included; both INFINITY while there is none.
aisle_cost_pair aisle_swarm_best_cost(const aisle_swarm *self);

// Writes start, vias, goal of the best particle to points[AISLE_SWARM_VIAS + 2]; returns the count; 0 if nothing
// feasible was seen.
uint32_t aisle_swarm_best(const aisle_swarm *self, aisle_vec2 *points);
#endif
