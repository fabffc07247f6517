#include "plan/tour.h"

#include "base/check.h"

#include <math.h>
#include <string.h>

#define WORK AISLE_ORDER_WORK_LEN(AISLE_ORDER_EXACT_MAX)

void aisle_tour_carve(aisle_tour *self, aisle_arena *arena) {
    self->cost = (double *)aisle_arena_take(arena, (AISLE_ORDER_MAX + 1U) * AISLE_ORDER_MAX, sizeof(double));
}

void aisle_tour_carve_shared(aisle_tour *self, aisle_arena *shared) {
    self->table = (double *)aisle_arena_take(shared, WORK, sizeof(double));
}

// ---- what is known of the pairs

static double *cost_of(aisle_tour *self, uint32_t from, uint32_t to) {
    return &self->cost[from * self->count + to];
}

static bool is_known(const aisle_tour *self, uint32_t i, uint32_t j) {
    return j < self->count ? (self->known[i] >> j & 1U) != 0U : (self->known[j] >> i & 1U) != 0U;
}

// The cost between two places, either of which may be the start.
static double between(const aisle_tour *self, uint32_t i, uint32_t j) {
    return j < self->count ? self->cost[i * self->count + j] : self->cost[j * self->count + i];
}

static void set_pair(aisle_tour *self, uint32_t i, uint32_t j, double cost) {
    if (j < self->count) {
        *cost_of(self, i, j) = cost;
    }
    if (i < self->count) {
        *cost_of(self, j, i) = cost;
    }
}

// By the triangle i, j, k, of which i to j has just come to be known.
static void tighten(aisle_tour *self, uint32_t i, uint32_t j, uint32_t k) {
    if (is_known(self, i, k) && !is_known(self, j, k)) {
        double least = fabs(between(self, i, j) - between(self, i, k));
        if (least > between(self, j, k)) {
            set_pair(self, j, k, least);
        }
    }
}

static void learn(aisle_tour *self, uint32_t i, uint32_t j, double cost) {
    set_pair(self, i, j, cost);
    if (j < self->count) {
        self->known[i] |= UINT64_C(1) << j;
    }
    if (i < self->count) {
        self->known[j] |= UINT64_C(1) << i;
    }
    for (uint32_t k = 0; k <= self->count && cost < (double)INFINITY; k++) {
        if (k != i && k != j) {
            tighten(self, i, j, k);
            tighten(self, j, i, k);
        }
    }
}

// ---- the order by the costs as they stand

static void begin_order(aisle_tour *self, bool last) {
    const aisle_order_config cfg = {.n = self->count,
                                    .cost = self->cost,
                                    .guess = self->ordered ? self->order : NULL,
                                    .kicks = last ? AISLE_TOUR_KICKS : AISLE_TOUR_KICKS_BETWEEN,
                                    .seed = self->rounds};
    aisle_status st = aisle_order_start(&self->search, &cfg, self->table, WORK);
    AISLE_ASSERT(st == AISLE_OK);
    self->last = last;
    self->phase = AISLE_TOUR_ORDER;
    self->rounds++;
}

void aisle_tour_start(aisle_tour *self, aisle_tangent *tangent, const aisle_layout *layout, double radius,
                      aisle_vec2 start, const aisle_vec2 *goals, uint32_t count) {
    AISLE_ASSERT(count >= 1U && count <= AISLE_ORDER_MAX);
    self->tangent = tangent;
    self->layout = layout;
    self->radius = radius;
    self->count = count;
    memcpy(self->place, goals, count * sizeof *goals);
    self->place[count] = start;
    for (uint32_t i = 0; i <= count; i++) {
        self->known[i] = 0;
        for (uint32_t j = 0; j < count; j++) {
            *cost_of(self, i, j) = aisle_vec2_distance(self->place[i], self->place[j]);
        }
    }
    for (uint32_t i = 0; i < count; i++) {
        self->order[i] = (uint8_t)i;
    }
    self->ordered = self->is_rough = false;
    self->unreachable = self->suspect = count;
    self->searches = self->rounds = self->nodes = self->evals = 0U;
    begin_order(self, true);
}

static uint32_t pay(aisle_tour *self) {
    uint32_t units = self->evals / AISLE_TOUR_EVALS;
    self->evals %= AISLE_TOUR_EVALS; // so that the sum does not depend on the slices
    return units;
}

static void search_pair(aisle_tour *self, uint32_t from, uint32_t to) {
    self->from = from;
    self->to = to;
    self->phase = AISLE_TOUR_SEARCH;
    self->searches++;
    self->evals += AISLE_TOUR_EVALS;
    aisle_tangent_start(self->tangent, self->layout, self->radius, self->place[from], self->place[to]);
}

// Searches the next way of the order that is not known. False: all are.
static bool search_next(aisle_tour *self) {
    for (; self->at < self->count; self->at++) {
        uint32_t from = self->at == 0U ? self->count : self->order[self->at - 1U];
        uint32_t to = self->order[self->at];
        if (!is_known(self, from, to)) {
            search_pair(self, from, to);
            return true;
        }
    }
    return false;
}

static aisle_status step_order(aisle_tour *self, uint32_t units) {
    uint32_t before = self->search.evals;
    aisle_status st =
        aisle_order_step(&self->search, units < UINT32_MAX / AISLE_TOUR_EVALS ? units * AISLE_TOUR_EVALS : UINT32_MAX);
    self->evals += self->search.evals - before;
    if (st == AISLE_BUSY) {
        return AISLE_BUSY;
    }
    memcpy(self->order, self->search.order, self->count);
    self->ordered = true;
    self->at = 0U;
    if (search_next(self)) {
        return AISLE_BUSY;
    }
    if (self->last || self->count <= AISLE_ORDER_EXACT_MAX) {
        return AISLE_OK;
    }
    begin_order(self, true);
    return AISLE_BUSY;
}

// ---- a pair

// No way between two goals: one of them cannot be reached from the start either.
static aisle_status ask_start(aisle_tour *self) {
    uint32_t n = self->count;
    if (self->from == n) {
        self->unreachable = self->to;
        return AISLE_PARTIAL;
    }
    self->suspect = self->to;
    search_pair(self, n, is_known(self, n, self->from) ? self->to : self->from);
    return AISLE_BUSY;
}

static aisle_status step_search(aisle_tour *self, uint32_t units, uint32_t *spent) {
    uint32_t expanded = self->tangent->expansions;
    aisle_status st = aisle_tangent_step(self->tangent, units, spent);
    self->nodes += self->tangent->expansions - expanded;
    if (st == AISLE_BUSY) {
        return AISLE_BUSY;
    }
    self->is_rough = self->is_rough || st == AISLE_ERR_CAPACITY;
    learn(self, self->from, self->to, st == AISLE_PARTIAL ? (double)INFINITY : self->tangent->bound);
    if (st == AISLE_PARTIAL) {
        return ask_start(self);
    }
    if (self->suspect < self->count && self->suspect != self->to && !is_known(self, self->count, self->suspect)) {
        search_pair(self, self->count, self->suspect);
        return AISLE_BUSY;
    }
    self->suspect = self->count; // both can be reached, to a rounding: so be it
    if (!search_next(self)) {
        begin_order(self, false);
    }
    return AISLE_BUSY;
}

aisle_status aisle_tour_step(aisle_tour *self, uint32_t units, uint32_t *spent) {
    const uint32_t from = *spent;
    aisle_status st = AISLE_BUSY;
    while (st == AISLE_BUSY && *spent - from < units) {
        uint32_t left = units - (*spent - from);
        st = self->phase == AISLE_TOUR_ORDER ? step_order(self, left) : step_search(self, left, spent);
        *spent += pay(self);
    }
    return st;
}
