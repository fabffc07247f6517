// barrier.h - a genetic search for a way past walls: stations along a line, across it one gene each. Level 4.
//
// The paper's form (Chiu 2010): the axis along which start and goal are farther apart is divided evenly by options.step (0:
// 1 m), the genes are the other coordinate of the stations, anywhere in the layout's bounds; OBJ = length + 1000 k, k the
// pieces that cross an obstacle (eq. 1 and 2). Its parameters are aisle_ga_paper()'s; generations: options.num_samples, 0
// = 500. A piece crosses if the vehicle's turning disc, margin included, is not free along it.
// Ours: stations along a seed, a way that is free, at its inner points and every options.step (0: 1 m) between; a gene is
// the offset across the seed, +- AISLE_BARRIER_REACH. Repair: of a piece that is not free the offsets of both ends are
// halved, AISLE_BARRIER_HALVINGS times, then 0: so every point of the search stands for a free way, since the
// seed is one. Value: the objective's, summed over the pieces. The seed is in the first population, so the result is never
// worse. What comes out is to be pulled taut (taut.h), the local refinement.
//
// Memory: ga.h's for AISLE_BARRIER_STATIONS genes and AISLE_BARRIER_POPULATION points, from the arena. Time: evaluations *
// stations * sweeps; units: one an evaluation and what sweeps add.
// Determinism: same layout, ends and options, same way, however cut into steps.
#ifndef AISLE_PLAN_BARRIER_H
#define AISLE_PLAN_BARRIER_H

#include "algo/ga.h"
#include "plan/objective.h"
#include "plan/space.h"

#define AISLE_BARRIER_STATIONS 64U
#define AISLE_BARRIER_POINTS (AISLE_BARRIER_STATIONS + 2U)
#define AISLE_BARRIER_POPULATION 80U
#define AISLE_BARRIER_STEP 1.0   // m
#define AISLE_BARRIER_REACH 1.0F // m
#define AISLE_BARRIER_HALVINGS 3U
#define AISLE_BARRIER_GENERATIONS_PAPER 500U
#define AISLE_BARRIER_GENERATIONS 12U
#define AISLE_BARRIER_OURS 20U  // points of a population
#define AISLE_BARRIER_STALL 60U // evaluations without a gain
#define AISLE_BARRIER_PENALTY 1000.0

typedef struct aisle_barrier {
    const aisle_space *space;
    const aisle_objective *objective;        // NULL: the paper's form
    aisle_vec2 base[AISLE_BARRIER_POINTS];   // of the stations, where their gene is 0; start first, goal last
    aisle_vec2 across[AISLE_BARRIER_POINTS]; // unit vector a gene goes along; of the ends 0
    uint32_t count;                          // stations and both ends
    float lo[AISLE_BARRIER_STATIONS], hi[AISLE_BARRIER_STATIONS], seed[AISLE_BARRIER_STATIONS];
    aisle_ga ga;
    double offset[AISLE_BARRIER_POINTS]; // of the way looked at, repaired
    aisle_vec2 way[AISLE_BARRIER_POINTS];
    uint32_t units;
} aisle_barrier;

typedef struct aisle_barrier_figures { // of the best way so far
    double length;                     // m
    uint32_t crossing;                 // pieces that are not free
} aisle_barrier_figures;

void aisle_barrier_carve(aisle_barrier *self, aisle_arena *arena);

// Begins with the paper's form; reads step, num_samples and seed. AISLE_ERR_ARG: start and goal are less than 1e-6 m apart;
// nothing begun then.
aisle_status aisle_barrier_start_paper(aisle_barrier *self, const aisle_space *space, const aisle_options_msg *options,
                                       aisle_vec2 start, aisle_vec2 goal);

// Begins with ours, on a seed points[count]. AISLE_PARTIAL: it is shorter than 0.2 m, has too many points for the stations,
// or is not free; nothing begun then.
aisle_status aisle_barrier_start(aisle_barrier *self, const aisle_space *space, const aisle_objective *objective,
                                 const aisle_options_msg *options, const aisle_vec2 *points, uint32_t count);

// Spends about `units`, adds what it took to *spent. AISLE_BUSY, then AISLE_OK.
aisle_status aisle_barrier_step(aisle_barrier *self, uint32_t units, uint32_t *spent);

// Writes the best way to points[AISLE_BARRIER_POINTS], ends included; returns the count; 0 if none that is free was seen.
uint32_t aisle_barrier_best(aisle_barrier *self, aisle_vec2 *points);

// False if none was seen. O(stations), changes nothing but scratch.
bool aisle_barrier_figures_of(aisle_barrier *self, aisle_barrier_figures *out);
#endif
