// paper_swarm.h - the particle swarm as its paper has it: via-points from nowhere, obstacles as circles. Level 4.
//
// Method (Praserttaweelap, Kaitwanidvilai, Aoyama 2018): a particle is AISLE_PAPER_VIAS points anywhere in the layout's
// bounds; the way through start, them and target is linear or a not-a-knot cubic spline, sampled at 100 (default) or
// more places. At each sample and obstacle
//     R = half diagonal of the obstacle's box, r = radius of the circle about the vehicle,  d = distance of the centres
//     d_r = d - R - r                                             (eq. 4)
//     OA = max(1 - alpha d / (R + r), 0), alpha in (1, 2)         (eq. 5)
// a sample's OA is the largest of any obstacle, a way's the mean over its samples; L is the sum of the distances between
// samples (eq. 13); F = L (1 + beta OA), beta = options.risk_weight. Eq. 14 of the paper is lost, F is our reading.
// Collision comes first: violation = metres of way whose vehicle circle is short of the margin, times by how much,
// against the obstacles' true shapes (gaps narrower than the circles of the shelves are used in the paper, so its
// circles cannot be what collides). 200 iterations, w falling linearly from 0.9 to 0.4, c1 = c2 = 2.
// Where the paper is silent, ours: the number of via-points (it says only that the spline needs at least 4 points),
// 50 particles, alpha 1.05 (table 1 has OA 0 at d = R + r: near 1), beta 2 (its three pairs of paths need beta above
// 1.7 for the safe one to have the lesser F).
// Obstacles with R above a quarter of the bounds' shorter side (walls) have no circle: it would cover the hall. Scans
// have none either; both still collide.
// Samples are even by arc length from the very start. The paper's left the first leg out with 100 samples: `skip_first`
// brings that back, for comparison only; options cannot.
// Memory: 256 circles, the swarm's floats, from the arena. Time: evaluations * samples * obstacles; units: one per
// AISLE_PAPER_SAMPLES_PER_UNIT samples, per AISLE_PAPER_CIRCLES_PER_UNIT circles looked at and per exact gap.
// Hits of 30 seeds: `aisle paper 1`. The verifier still judges what comes out.
#ifndef AISLE_PLAN_PAPER_SWARM_H
#define AISLE_PLAN_PAPER_SWARM_H

#include "algo/pso.h"
#include "plan/space.h"
#include "world/spline.h"

#define AISLE_PAPER_VIAS 5U
#define AISLE_PAPER_PARTICLES 50U
#define AISLE_PAPER_ITERATIONS 200U
#define AISLE_PAPER_SAMPLES 100U
#define AISLE_PAPER_SAMPLES_MIN 16U
#define AISLE_PAPER_SAMPLES_MAX 512U
#define AISLE_PAPER_OBSTACLES_MAX 256U
#define AISLE_PAPER_ALPHA 1.05
#define AISLE_PAPER_BETA 2.0
#define AISLE_PAPER_WALL 0.25 // of the shorter side
#define AISLE_PAPER_BETA_MAX 1e6
#define AISLE_PAPER_SAMPLES_PER_UNIT 4U
#define AISLE_PAPER_CIRCLES_PER_UNIT 64U

typedef struct aisle_paper_circle {
    aisle_vec2 centre;
    double sum; // R + r, m
} aisle_paper_circle;

typedef struct aisle_paper_figures { // of one way
    double length, oa, fitness;      // L (m), OA, F (m)
    double violation;                // m2; 0 = no collision
} aisle_paper_figures;

typedef struct aisle_paper_swarm {
    const aisle_space *space;
    aisle_spline_kind kind;
    aisle_vec2 start, goal, origin; // variables count from the origin
    uint32_t samples;
    double beta;
    bool skip_first;            // leave the first leg unsampled; set after start()
    aisle_paper_circle *circle; // [AISLE_PAPER_OBSTACLES_MAX]
    uint32_t circles;
    float lo[2 * AISLE_PAPER_VIAS], hi[2 * AISLE_PAPER_VIAS];
    aisle_pso_config config;
    aisle_pso pso;
    float *work; // [AISLE_PSO_WORK_LEN(2 * AISLE_PAPER_VIAS, AISLE_PAPER_PARTICLES)]
    aisle_spline *spline;
    aisle_spline_sample *sample; // [AISLE_PAPER_SAMPLES_MAX]
    uint32_t units;
} aisle_paper_swarm;

void aisle_paper_swarm_carve(aisle_paper_swarm *self, aisle_arena *arena);

// Begins on one leg; reads interpolation, num_samples, seed and risk_weight. AISLE_ERR_CAPACITY: more than
// AISLE_PAPER_OBSTACLES_MAX obstacles; AISLE_ERR_ARG: start and goal are less than 1e-6 m apart. Nothing begun then.
aisle_status aisle_paper_swarm_start(aisle_paper_swarm *self, const aisle_space *space,
                                     const aisle_options_msg *options, aisle_vec2 start, aisle_vec2 goal);

// Spends about `units`, adds what it took to *spent. AISLE_BUSY, then AISLE_OK.
aisle_status aisle_paper_swarm_step(aisle_paper_swarm *self, uint32_t units, uint32_t *spent);

// Writes start, vias, goal of the best particle to points[AISLE_PAPER_VIAS + 2]; returns the count; 0 if no way without
// collision was seen.
uint32_t aisle_paper_swarm_best(const aisle_paper_swarm *self, aisle_vec2 *points);

// Figures of the best particle so far, feasible or not; false if none was seen. O(samples * obstacles), changes nothing
// but scratch.
bool aisle_paper_swarm_figures(aisle_paper_swarm *self, aisle_paper_figures *out);
#endif
