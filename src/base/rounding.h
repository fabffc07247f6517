// rounding.h - double to float in a chosen direction. Level 0. Memory: none. Time: O(1).
#ifndef AISLE_BASE_ROUNDING_H
#define AISLE_BASE_ROUNDING_H

#include <stdint.h>
#include <string.h>

// The next float after x in direction of step (1 or -1); x > 0 and finite, or x = 0 and step 1.
static inline float aisle_float_next(float x, int step) {
    uint32_t bits;
    memcpy(&bits, &x, sizeof bits);
    bits = step > 0 ? bits + 1U : bits - 1U; // floats of one sign are ordered as their bits
    memcpy(&x, &bits, sizeof x);
    return x;
}

// The greatest float not above x, the least one not below x; x >= 0, far below FLT_MAX.
static inline float aisle_float_below(double x) {
    const float nearest = (float)x;
    return (double)nearest > x ? aisle_float_next(nearest, -1) : nearest;
}
static inline float aisle_float_above(double x) {
    const float nearest = (float)x;
    return (double)nearest < x ? aisle_float_next(nearest, 1) : nearest;
}
#endif
