#include "plan/arm_join.h"

#include "base/check.h"

#include <string.h>

#define HALVINGS 40U // of [0, 1], where a via-point lies
#define R_MIN 0.05   // a via-point nearer to an end would need bends that nothing is gained by

void aisle_arm_join_carve(aisle_arm_join *self, aisle_arena *arena) {
    void *point = aisle_arena_take(arena, AISLE_ARM_PIECES + 1U, sizeof(double[AISLE_ARM_LINKS]));
    void *value = aisle_arena_take(arena, AISLE_ARM_PIECES, sizeof(double));
    void *least = aisle_arena_take(arena, AISLE_ARM_PIECES + 1U, sizeof(double));
    void *span = aisle_arena_take(arena, AISLE_ARM_PIECES + 1U, sizeof(uint8_t));
    if (self != NULL) {
        self->point = (double(*)[AISLE_ARM_LINKS])point;
        self->value = (double *)value;
        self->least = (double *)least;
        self->span = (uint8_t *)span;
    }
}

void aisle_arm_join_start(aisle_arm_join *self, const aisle_arm_world *world, const aisle_arm_dynamics *dynamics,
                          aisle_arm_search *search, aisle_arm_plan *plan, uint32_t *spent) {
    const uint32_t before = search->units;
    self->world = world;
    self->dynamics = dynamics;
    self->search = search;
    self->plan = plan;
    self->count = plan->count;
    self->least[0] = 0.0;
    for (uint32_t k = 0; k < plan->count; k++) {
        const aisle_arm_piece *piece = &plan->piece[k];
        aisle_arm_piece_at(piece, 0.0, 0U, self->point[k]);
        aisle_arm_piece_at(piece, 1.0, 0U, self->point[k + 1U]);
        self->value[k] = (double)aisle_arm_search_cost(search, piece).value;
        self->least[k + 1U] = self->least[k] + plan->duration[k];
        self->span[k + 1U] = 1U;
    }
    *spent += search->units - before;
    self->at = 2;
    self->from = 2;
}

// ---- a piece through via-points

static double leg(const aisle_arm_join *self, uint32_t k) { // rad, from point k to the next
    double sum = 0.0;
    for (uint32_t j = 0; j < self->world->arm->links; j++) {
        const double d = self->point[k + 1U][j] - self->point[k][j];
        sum += d * d;
    }
    return sqrt(sum);
}

static double smooth_step(double r) {
    return r * r * r * (10.0 - r * (15.0 - 6.0 * r));
}

static double place_of(double share) { // r with that smooth step
    double lo = 0.0, hi = 1.0;
    for (uint32_t i = 0; i < HALVINGS; i++) {
        const double middle = 0.5 * (lo + hi);
        if (smooth_step(middle) < share) {
            lo = middle;
        } else {
            hi = middle;
        }
    }
    return 0.5 * (lo + hi);
}

// From point `first` through the ones between to first + span. False: a via-point lies too near to an end or to the other one.
static bool bend_through(const aisle_arm_join *self, uint32_t first, uint32_t span, aisle_arm_piece *out) {
    const double *from = self->point[first], *to = self->point[first + span];
    double r[AISLE_ARM_JOIN_SPAN] = {0.0, 0.0, 0.0}, behind = 0.0, all = 0.0, bend[2U * AISLE_ARM_LINKS];
    for (uint32_t k = 0; k < span; k++) {
        all += leg(self, first + k);
    }
    for (uint32_t k = 0; k + 1U < span; k++) {
        const double before = k > 0U ? r[k - 1U] : 0.0;
        behind += leg(self, first + k);
        r[k] = place_of(behind / all);
        if (!(r[k] >= before + R_MIN && r[k] <= 1.0 - R_MIN)) {
            return false;
        }
    }
    for (uint32_t j = 0; j < self->world->arm->links; j++) {
        double want[AISLE_ARM_JOIN_SPAN] = {0.0, 0.0, 0.0};
        for (uint32_t k = 0; k + 1U < span; k++) {
            const double hump = r[k] * (1.0 - r[k]), straight = from[j] + (to[j] - from[j]) * smooth_step(r[k]);
            want[k] = (self->point[first + k + 1U][j] - straight) / (hump * hump * hump);
        }
        bend[2U * j + 1U] = span > 2U ? (want[1] - want[0]) / (r[1] - r[0]) : 0.0;
        bend[2U * j] = want[0] - bend[2U * j + 1U] * (r[0] - 0.5);
    }
    aisle_arm_piece_of(self->world->arm->links, from, to, bend, out);
    return true;
}

// ---- candidates

static void try_candidate(aisle_arm_join *self) {
    const uint32_t first = self->at - self->from;
    aisle_arm_piece piece;
    aisle_arm_timing timing;
    double value = 0.0;
    if (!bend_through(self, first, self->from, &piece)) {
        return;
    }
    aisle_arm_least_duration(self->world->arm, self->dynamics, &piece, AISLE_ARM_TIMING_PANELS, &timing);
    if (!(self->least[first] + timing.duration < self->least[self->at])) {
        return;
    }
    for (uint32_t k = first; k < self->at; k++) {
        value += self->value[k];
    }
    const aisle_cost_pair cost = aisle_arm_search_cost(self->search, &piece);
    if (cost.violation <= 0.0F && (double)cost.value <= value * (1.0 + AISLE_ARM_JOIN_SLACK)) {
        self->least[self->at] = self->least[first] + timing.duration;
        self->span[self->at] = (uint8_t)self->from;
    }
}

// The next candidate; a point whose candidates are through passes its duration on. False: there is none.
static bool next(aisle_arm_join *self) {
    if (self->from < AISLE_ARM_JOIN_SPAN && self->from < self->at) {
        self->from++;
        return true;
    }
    self->at++;
    self->from = 2;
    if (self->at <= self->count) {
        const double straight = self->least[self->at - 1U] + self->plan->duration[self->at - 1U];
        self->least[self->at] = straight;
    }
    return self->at <= self->count;
}

// ---- the plan

static bool fits(const aisle_arm_join *self) {
    uint32_t waypoints = 1;
    for (uint32_t i = self->count; i > 0U; i -= self->span[i]) {
        waypoints += self->span[i] > 1U ? AISLE_ARM_STEPS : AISLE_ARM_STEPS_STRAIGHT;
    }
    return waypoints <= (uint32_t)AISLE_ARM_PATH_MAX_WAYPOINTS;
}

static void cover(aisle_arm_join *self) {
    uint8_t forward[AISLE_ARM_PIECES]; // spans from a point on
    uint32_t written = 0;
    for (uint32_t i = self->count; i > 0U; i -= self->span[i]) {
        forward[i - self->span[i]] = self->span[i];
    }
    for (uint32_t i = 0; i < self->count; i += forward[i]) {
        aisle_arm_piece *piece = &self->plan->piece[written];
        const double *from = self->point[i], *to = self->point[i + forward[i]];
        if (forward[i] == 1U) {
            aisle_arm_piece_of(self->world->arm->links, from, to, NULL, piece);
        } else {
            (void)bend_through(self, i, forward[i], piece);
        }
        self->plan->duration[written++] = self->least[i + forward[i]] - self->least[i];
    }
    self->plan->count = written;
}

aisle_status aisle_arm_join_step(aisle_arm_join *self, uint32_t units, uint32_t *spent) {
    const uint32_t from = *spent;
    bool is_left = self->at <= self->count;
    while (is_left && *spent - from < units) {
        const uint32_t before = self->search->units;
        try_candidate(self);
        *spent += AISLE_ARM_UNITS + (self->search->units - before);
        is_left = next(self);
    }
    if (is_left) {
        return AISLE_BUSY;
    }
    if (fits(self)) {
        cover(self);
    }
    return AISLE_OK;
}
