// noise.h - errors of sensors and wheels, drawn from a seed. Level 5.
//
// All errors are bounded: draws beyond AISLE_SIM_SIGMAS standard deviations are drawn again, so that what a sensor
// tells of itself (its sigma) bounds what it does. Memory: none. Time: O(1) on average.
#ifndef AISLE_SIM_NOISE_H
#define AISLE_SIM_NOISE_H

#include "base/rng.h"
#include "base/vec.h"

#include <stdint.h>

#define AISLE_SIM_SIGMAS 3.0

// Uniform in [lo, hi).
double aisle_sim_uniform(aisle_rng *rng, double lo, double hi);

// Near normal with mean 0 and deviation 1 (sum of twelve uniforms less 6, Box's old rule), within
// +-AISLE_SIM_SIGMAS.
double aisle_sim_normal(aisle_rng *rng);

// Two of them times sigma, the length of the vector at most AISLE_SIM_SIGMAS * sigma.
aisle_vec2 aisle_sim_normal2(aisle_rng *rng, double sigma);

// An error that wanders: Ornstein and Uhlenbeck's process with this deviation and time constant, discretised exactly
// for small steps: value += -value * dt / tau + sigma sqrt(2 dt / tau) n, kept within AISLE_SIM_SIGMAS * sigma.
typedef struct aisle_sim_drift {
    double value, sigma, tau; // tau, s
} aisle_sim_drift;

// Starts somewhere in its own distribution.
aisle_sim_drift aisle_sim_drift_of(aisle_rng *rng, double sigma, double tau);
void aisle_sim_drift_step(aisle_sim_drift *self, aisle_rng *rng, double dt);

// A seed of its own for each use: unrelated streams for (seed, use).
aisle_rng aisle_sim_stream(uint64_t seed, uint64_t use);
#endif
