// rng.h - seeded random numbers, the same on every board. Level 0.
//
// Method: SplitMix64 to spread the seed, then PCG-XSH-RR 64/32 (O'Neill 2014, "PCG: A Family of Simple
// Fast Space-Efficient Statistically Good Algorithms"). State is one word: copy it to fork a stream.
// Time: O(1); below() draws again with probability < n / 2^32. Memory: none.
#ifndef AISLE_BASE_RNG_H
#define AISLE_BASE_RNG_H

#include <stdint.h>

typedef struct aisle_rng {
    uint64_t state;
} aisle_rng;

// Any seed is good, 0 too; different seeds give unrelated streams.
aisle_rng aisle_rng_seed(uint64_t seed);

// Uniform 32 bits.
uint32_t aisle_rng_next(aisle_rng *self);

// Uniform in [0, 1), 24 bits.
float aisle_rng_float(aisle_rng *self);

// Uniform integer in [0, n), unbiased, n >= 1.
uint32_t aisle_rng_below(aisle_rng *self, uint32_t n);
#endif
