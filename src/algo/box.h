// box.h - where the population searches look: x[i] in [lo[i], hi[i]]. Level 2. Time: O(1), is_good O(dim). Memory: none.
#ifndef AISLE_ALGO_BOX_H
#define AISLE_ALGO_BOX_H

#include <stdbool.h>
#include <stdint.h>

#define AISLE_BOX_MAX 1e30F // of a side: differences and their small multiples stay finite

static inline float aisle_box_clamp(float x, float lo, float hi) {
    return x < lo ? lo : (x > hi ? hi : x);
}

// False for NaN.
static inline bool aisle_box_within(float x, float lo, float hi) {
    return x >= lo && x <= hi;
}

// lo[dim] < hi[dim], all finite and at most AISLE_BOX_MAX.
static inline bool aisle_box_is_good(const float *lo, const float *hi, uint32_t dim) {
    for (uint32_t i = 0; i < dim; i++) {
        if (!(aisle_box_within(lo[i], -AISLE_BOX_MAX, AISLE_BOX_MAX) &&
              aisle_box_within(hi[i], -AISLE_BOX_MAX, AISLE_BOX_MAX) && lo[i] < hi[i])) {
            return false;
        }
    }
    return true;
}
#endif
