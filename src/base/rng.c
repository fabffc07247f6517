#include "base/rng.h"

#include "base/check.h"

#define PCG_MULTIPLIER 6364136223846793005U
#define PCG_INCREMENT 1442695040888963407U // any odd number

aisle_rng aisle_rng_seed(uint64_t seed) {
    // SplitMix64's finaliser (Steele, Lea, Flood 2014): neighbouring seeds start far apart.
    uint64_t z = seed + 0x9E3779B97F4A7C15U;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9U;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBU;
    return (aisle_rng){z ^ (z >> 31)};
}

uint32_t aisle_rng_next(aisle_rng *self) {
    const uint64_t old = self->state;
    self->state = old * PCG_MULTIPLIER + PCG_INCREMENT;
    const uint32_t mixed = (uint32_t)(((old >> 18) ^ old) >> 27);
    const uint32_t turn = (uint32_t)(old >> 59);
    return (mixed >> turn) | (mixed << ((32U - turn) & 31U));
}

float aisle_rng_float(aisle_rng *self) {
    return (float)(aisle_rng_next(self) >> 8) * (1.0F / 16777216.0F); // both exact
}

uint32_t aisle_rng_below(aisle_rng *self, uint32_t n) {
    AISLE_ASSERT(n >= 1);
    // Lemire 2019, "Fast Random Integer Generation in an Interval": the upper word of a product is the
    // answer; the few lower words that would favour some answers are drawn again.
    uint64_t product = (uint64_t)aisle_rng_next(self) * n;
    if ((uint32_t)product < n) {
        const uint32_t unfair = (0U - n) % n; // 2^32 mod n
        while ((uint32_t)product < unfair) {
            product = (uint64_t)aisle_rng_next(self) * n;
        }
    }
    return (uint32_t)(product >> 32);
}
