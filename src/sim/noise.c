#include "sim/noise.h"

double aisle_sim_uniform(aisle_rng *rng, double lo, double hi) {
    return lo + (hi - lo) * (double)aisle_rng_float(rng);
}

double aisle_sim_normal(aisle_rng *rng) {
    for (;;) { // ends: one draw in 370 is beyond
        double sum = -6.0;
        for (int i = 0; i < 12; i++) {
            sum += (double)aisle_rng_float(rng);
        }
        if (fabs(sum) <= AISLE_SIM_SIGMAS) {
            return sum;
        }
    }
}

aisle_vec2 aisle_sim_normal2(aisle_rng *rng, double sigma) {
    for (;;) {
        aisle_vec2 v = {aisle_sim_normal(rng), aisle_sim_normal(rng)};
        if (aisle_vec2_length(v) <= AISLE_SIM_SIGMAS) {
            return aisle_vec2_scale(v, sigma);
        }
    }
}

aisle_sim_drift aisle_sim_drift_of(aisle_rng *rng, double sigma, double tau) {
    return (aisle_sim_drift){.value = sigma * aisle_sim_normal(rng), .sigma = sigma, .tau = tau};
}

void aisle_sim_drift_step(aisle_sim_drift *self, aisle_rng *rng, double dt) {
    double share = dt / self->tau;
    double next = self->value * (1.0 - share) + self->sigma * sqrt(2.0 * share) * aisle_sim_normal(rng);
    double most = AISLE_SIM_SIGMAS * self->sigma;
    self->value = aisle_clamp(next, -most, most);
}

aisle_rng aisle_sim_stream(uint64_t seed, uint64_t use) {
    aisle_rng mixed = aisle_rng_seed(seed * 0x9E3779B97F4A7C15U + use);
    uint64_t high = aisle_rng_next(&mixed);
    return aisle_rng_seed(high << 32U | aisle_rng_next(&mixed));
}
