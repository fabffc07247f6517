#include "plan/arm_free.h"

#include "base/check.h"

#define DEPTH 64U // halves of halves down to AISLE_ARM_STEP_MIN

typedef struct interval {
    double lo, hi;
} interval;

typedef struct left { // not yet looked at, the next on top
    interval part[DEPTH];
    uint32_t count;
} left;

static void push(left *self, double lo, double hi) {
    if (hi > lo) {
        AISLE_ASSERT(self->count < DEPTH);
        self->part[self->count++] = (interval){lo, hi};
    }
}

// What the look at the middle, which is free h to either side, leaves of the interval on top, the part before it next. False: no
// end in sight.
static bool pass(left *self, double h) {
    const interval top = self->part[--self->count];
    const double middle = 0.5 * (top.lo + top.hi);
    if (h < 0.5 * (top.hi - top.lo)) {
        push(self, middle + h, top.hi);
        push(self, top.lo, middle - h);
        return h >= AISLE_ARM_STEP_MIN;
    }
    return true;
}

// Joint angles' rates to those of links.
static void fill_slope(const aisle_arm *arm, const double *rate, aisle_arm_pace *pace) {
    double turn = 0.0, moved = 0.0, seen = 0.0;
    for (uint32_t k = 0; k < arm->links; k++) {
        turn += rate[k];
        moved += arm->length[k] * fabs(turn);
        seen += k > 0U ? arm->length[k] * fabs(turn - rate[0]) : 0.0;
        pace->slope[k] = moved;
    }
    pace->slope[AISLE_ARM_LINKS] = seen;
}

// ---- pieces

// Sums of the joints' polynomials from `first` on: bend[k] = half of length_k * max |phi_k''|, added up.
static double bend_from(const aisle_arm *arm, const aisle_arm_piece *piece, uint32_t first, double *bend) {
    aisle_arm_piece sums = *piece;
    double most[AISLE_ARM_LINKS], sum = 0.0;
    for (uint32_t k = first + 1U; k < piece->links; k++) {
        for (uint32_t i = 0; i <= AISLE_ARM_DEGREE; i++) {
            sums.c[k][i] += sums.c[k - 1U][i];
        }
    }
    aisle_arm_piece_bounds(&sums, 2U, most);
    for (uint32_t k = first; k < piece->links; k++) {
        sum += 0.5 * arm->length[k] * most[k];
        if (bend != NULL) {
            bend[k] = sum;
        }
    }
    return sum;
}

bool aisle_arm_free_piece(const aisle_arm_world *world, const aisle_arm_piece *piece, uint32_t *units, double *until) {
    const aisle_arm *arm = world->arm;
    left open = {.count = 0};
    aisle_arm_pace pace;
    (void)bend_from(arm, piece, 0U, pace.bend);
    pace.bend[AISLE_ARM_LINKS] = arm->links > 1U ? bend_from(arm, piece, 1U, NULL) : 0.0;
    push(&open, 0.0, 1.0);
    while (open.count > 0U) {
        const interval top = open.part[open.count - 1U];
        double q[AISLE_ARM_LINKS], rate[AISLE_ARM_LINKS], h = 0.5 * (top.hi - top.lo);
        const double middle = 0.5 * (top.lo + top.hi);
        aisle_arm_piece_at(piece, middle, 0U, q);
        aisle_arm_piece_at(piece, middle, 1U, rate);
        fill_slope(arm, rate, &pace);
        *units += AISLE_ARM_UNITS;
        if (!aisle_arm_world_room(world, q, &pace, &h) || !pass(&open, h)) {
            if (until != NULL) {
                *until = top.lo;
            }
            return false;
        }
    }
    if (until != NULL) {
        *until = 1.0;
    }
    return true;
}

// ---- lines

bool aisle_arm_free_line(const aisle_arm_world *world, const double *from, const double *to, uint32_t *units) {
    const aisle_arm *arm = world->arm;
    double way[AISLE_ARM_LINKS], q[AISLE_ARM_LINKS];
    left open = {.count = 0};
    aisle_arm_pace pace = {{0.0}, {0.0}};
    for (uint32_t j = 0; j < arm->links; j++) {
        way[j] = to[j] - from[j];
    }
    fill_slope(arm, way, &pace);
    push(&open, 0.0, 1.0);
    while (open.count > 0U) {
        const interval top = open.part[open.count - 1U];
        const double middle = 0.5 * (top.lo + top.hi);
        double h = 0.5 * (top.hi - top.lo);
        for (uint32_t j = 0; j < arm->links; j++) {
            q[j] = from[j] + middle * way[j];
        }
        *units += AISLE_ARM_UNITS;
        if (!aisle_arm_world_room(world, q, &pace, &h) || !pass(&open, h)) {
            return false;
        }
    }
    return true;
}
