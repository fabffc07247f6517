#include "algo/order.h"

#include "base/check.h"

#include <math.h>
#include <string.h>

#define COST_MAX 1e12
#define NEAR 30U    // places that a kick's cuts lie within, at most
#define DEARER 0.03 // than the best, as a part of it, that is gone on from at first

// ---- start

static bool costs_are_good(const aisle_order_config *cfg) {
    for (uint32_t i = 0; i <= cfg->n; i++) {
        for (uint32_t j = 0; j < cfg->n; j++) {
            double cost = cfg->cost[i * cfg->n + j];
            if (i != j && !(cost >= 0.0 && (cost <= COST_MAX || isinf(cost)))) {
                return false;
            }
        }
    }
    return true;
}

static bool is_permutation(const uint8_t *order, uint32_t n) {
    uint64_t seen = 0;
    for (uint32_t i = 0; i < n; i++) {
        if (order[i] >= n || (seen >> order[i] & 1U) != 0U) {
            return false;
        }
        seen |= UINT64_C(1) << order[i];
    }
    return true;
}

double aisle_order_value(const aisle_order_config *cfg, const uint8_t *order) {
    double sum = 0.0;
    uint32_t from = cfg->n;
    for (uint32_t i = 0; i < cfg->n; i++) {
        sum += cfg->cost[from * cfg->n + order[i]];
        from = order[i];
    }
    return sum;
}

// Dearer than any order of finite costs: one above the sum of every row's largest.
static double bar_above(const aisle_order_config *cfg) {
    double bar = 1.0;
    for (uint32_t i = 0; i <= cfg->n; i++) {
        double most = 0.0;
        for (uint32_t j = 0; j < cfg->n; j++) {
            double cost = cfg->cost[i * cfg->n + j];
            most = i != j && cost <= COST_MAX && cost > most ? cost : most;
        }
        bar += most;
    }
    return bar;
}

static void adopt(aisle_order *self, const uint8_t *order) {
    memcpy(self->order, order, self->cfg.n);
    self->value = aisle_order_value(&self->cfg, order);
}

// ---- the order in hand

// Between places; n is the start's row, and n as the target the end, which costs nothing.
static double cost_of(const aisle_order *self, uint32_t from, uint32_t to) {
    if (to == self->cfg.n) {
        return 0.0;
    }
    double cost = self->cfg.cost[from * self->cfg.n + to];
    return cost <= COST_MAX ? cost : self->bar;
}

// The place before a position, or the start; at it, or the end.
static uint32_t before(const aisle_order *self, uint32_t at) {
    return at == 0U ? self->cfg.n : self->now[at - 1U];
}

static uint32_t place_at(const aisle_order *self, uint32_t at) {
    return at == self->count ? self->cfg.n : self->now[at];
}

static void sum_up(aisle_order *self) {
    self->ahead[0] = self->back[0] = 0.0;
    for (uint32_t i = 1; i < self->count; i++) {
        self->ahead[i] = self->ahead[i - 1U] + cost_of(self, self->now[i - 1U], self->now[i]);
        self->back[i] = self->back[i - 1U] + cost_of(self, self->now[i], self->now[i - 1U]);
    }
    self->now_value = self->ahead[self->count - 1U] + cost_of(self, self->cfg.n, self->now[0]);
    self->evals += self->count;
}

static void mark(aisle_order *self, uint32_t place) {
    if (place < self->cfg.n) {
        self->dirty |= UINT64_C(1) << place;
    }
}

static void begin_descent(aisle_order *self) {
    self->phase = AISLE_ORDER_DESCEND;
    self->count = self->cfg.n;
    self->dirty = self->cfg.n == 64U ? UINT64_MAX : (UINT64_C(1) << self->cfg.n) - 1U;
    sum_up(self);
    self->best_value = self->now_value;
    adopt(self, self->now);
}

aisle_status aisle_order_start(aisle_order *self, const aisle_order_config *cfg, double *work, size_t work_len) {
    if (cfg == NULL || cfg->n < 1U || cfg->n > AISLE_ORDER_MAX || cfg->cost == NULL || !costs_are_good(cfg) ||
        (cfg->guess != NULL && !is_permutation(cfg->guess, cfg->n))) {
        return AISLE_ERR_ARG;
    }
    if (work_len < AISLE_ORDER_WORK_LEN(cfg->n) || (work == NULL && AISLE_ORDER_WORK_LEN(cfg->n) > 0U)) {
        return AISLE_ERR_CAPACITY;
    }
    memset(self, 0, sizeof *self);
    self->cfg = *cfg;
    self->table = work;
    self->ended = AISLE_BUSY;
    self->bar = bar_above(cfg);
    self->least_gain = 1e-12 * self->bar;
    self->rng = aisle_rng_seed(cfg->seed);
    for (uint32_t i = 0; i < cfg->n; i++) {
        self->now[i] = cfg->guess != NULL ? cfg->guess[i] : (uint8_t)i;
    }
    adopt(self, self->now);
    if (cfg->n <= AISLE_ORDER_EXACT_MAX) {
        self->phase = AISLE_ORDER_TABLE;
        self->set = 1U;
    } else if (cfg->guess != NULL) {
        begin_descent(self);
    } else {
        self->phase = AISLE_ORDER_INSERT;
    }
    return AISLE_OK;
}

static aisle_status end(aisle_order *self) {
    self->phase = AISLE_ORDER_ENDED;
    return isinf(self->value) ? AISLE_PARTIAL : AISLE_OK;
}

// ---- exact

// The places of a set, rising.
static uint32_t list_members(uint32_t set, uint8_t *members) {
    uint32_t count = 0;
    for (uint32_t place = 0; set >> place != 0U; place++) {
        members[count] = (uint8_t)place;
        count += set >> place & 1U;
    }
    return count;
}

// The cheapest way over all of a set that ends at `last`, by the place before: the lowest one of the least cost.
static double best_before(aisle_order *self, uint32_t set, const uint8_t *members, uint32_t count, uint32_t last,
                          uint32_t *from) {
    const uint32_t n = self->cfg.n;
    const double *rest = &self->table[(set & ~(1U << last)) * n];
    double least = count == 1U ? self->cfg.cost[n * n + last] : (double)INFINITY;
    *from = n;
    for (uint32_t k = 0; k < count; k++) {
        uint32_t i = members[k];
        if (i != last) {
            double sum = rest[i] + self->cfg.cost[i * n + last];
            *from = sum < least ? i : *from;
            least = sum < least ? sum : least;
        }
    }
    self->evals += count;
    return least;
}

// From the last place to the first.
static void read_table(aisle_order *self) {
    const uint32_t n = self->cfg.n;
    uint32_t set = (1U << n) - 1U;
    uint32_t last = n;
    double least = (double)INFINITY;
    for (uint32_t j = 0; j < n; j++) {
        double cost = self->table[set * n + j];
        last = cost < least ? j : last;
        least = cost < least ? cost : least;
    }
    if (last == n) { // there is none
        return;
    }
    uint8_t order[AISLE_ORDER_MAX];
    uint8_t members[AISLE_ORDER_EXACT_MAX];
    for (uint32_t i = n; i-- > 0U;) {
        AISLE_ASSERT(last < n);
        uint32_t from;
        uint32_t count = list_members(set, members);
        (void)best_before(self, set, members, count, last, &from);
        order[i] = (uint8_t)last;
        set &= ~(1U << last);
        last = from;
    }
    adopt(self, order);
}

static aisle_status step_table(aisle_order *self) {
    const uint32_t n = self->cfg.n;
    uint8_t members[AISLE_ORDER_EXACT_MAX];
    const uint32_t count = list_members(self->set, members);
    for (uint32_t k = 0; k < count; k++) {
        uint32_t from;
        self->table[self->set * n + members[k]] = best_before(self, self->set, members, count, members[k], &from);
    }
    self->set++;
    if (self->set < 1U << n) {
        return AISLE_BUSY;
    }
    read_table(self);
    return end(self);
}

// ---- a first order: where the next place costs least

static void insert(aisle_order *self, uint32_t at, uint32_t from) {
    uint8_t place = self->now[from];
    memmove(self->now + at + 1U, self->now + at, from - at);
    self->now[at] = place;
}

// The places in are now[0 .. count), those not in behind them.
static void step_insert(aisle_order *self) {
    uint32_t best_at = 0;
    uint32_t best = self->count;
    double least = (double)INFINITY;
    for (uint32_t k = self->count; k < self->cfg.n; k++) {
        for (uint32_t at = 0; at <= self->count; at++) {
            uint32_t a = before(self, at);
            uint32_t b = place_at(self, at);
            uint32_t in = self->now[k];
            double more = cost_of(self, a, in) + cost_of(self, in, b) - cost_of(self, a, b);
            if (more < least) {
                least = more;
                best = k;
                best_at = at;
            }
        }
    }
    self->evals += (self->cfg.n - self->count) * (self->count + 1U);
    insert(self, best_at, best);
    self->count++;
    if (self->count == self->cfg.n) {
        begin_descent(self);
    }
}

// ---- moves. Positions: a stretch [i, j) goes to before position k outside it, perhaps turned round; k = i: where it is.

typedef struct move {
    uint32_t i, j, k;
    bool turned;
    double gain;
} move;

static void reverse(uint8_t *from, uint8_t *to) {
    while (from < to) {
        to--;
        uint8_t swap = *from;
        *from = *to;
        *to = swap;
        from++;
    }
}

// Exchanges the neighbours [i, j) and [j, k).
static void exchange(aisle_order *self, uint32_t i, uint32_t j, uint32_t k) {
    reverse(self->now + i, self->now + j);
    reverse(self->now + j, self->now + k);
    reverse(self->now + i, self->now + k);
}

static double weigh_turn(const aisle_order *self, uint32_t i, uint32_t j) {
    uint32_t a = before(self, i);
    uint32_t b = place_at(self, j);
    double old =
        cost_of(self, a, self->now[i]) + cost_of(self, self->now[j - 1U], b) + self->ahead[j - 1U] - self->ahead[i];
    double turned =
        cost_of(self, a, self->now[j - 1U]) + cost_of(self, self->now[i], b) + self->back[j - 1U] - self->back[i];
    return old - turned;
}

// Offers [i, j) before k, both ways round.
static void weigh_shift(const aisle_order *self, uint32_t i, uint32_t j, uint32_t k, move *best) {
    uint32_t first = self->now[i];
    uint32_t last = self->now[j - 1U];
    uint32_t a = before(self, i);
    uint32_t b = place_at(self, j);
    uint32_t c = before(self, k);
    uint32_t d = place_at(self, k);
    double left = cost_of(self, a, first) + cost_of(self, last, b) - cost_of(self, a, b) + cost_of(self, c, d);
    double straight = left - cost_of(self, c, first) - cost_of(self, last, d);
    double inner = self->ahead[j - 1U] - self->ahead[i] - self->back[j - 1U] + self->back[i];
    double turned = left + inner - cost_of(self, c, last) - cost_of(self, first, d);
    if (straight > best->gain) {
        *best = (move){i, j, k, false, straight};
    }
    if (turned > best->gain) {
        *best = (move){i, j, k, true, turned};
    }
}

// Offers the exchange of [i, j) and [j, k).
static void weigh_exchange(const aisle_order *self, uint32_t i, uint32_t j, uint32_t k, move *best) {
    uint32_t a = before(self, i);
    uint32_t b = self->now[j - 1U];
    uint32_t c = self->now[k - 1U];
    double old = cost_of(self, a, self->now[i]) + cost_of(self, b, self->now[j]) + cost_of(self, c, place_at(self, k));
    double now = cost_of(self, a, self->now[j]) + cost_of(self, c, self->now[i]) + cost_of(self, b, place_at(self, k));
    if (old - now > best->gain) {
        *best = (move){i, j, k, false, old - now};
    }
}

// All exchanges after which the place before position p is followed by that at q instead.
static void weigh_exchanges(aisle_order *self, uint32_t p, uint32_t q, move *best) {
    const uint32_t n = self->count;
    for (uint32_t k = q + 1U; p < q && q < n && k <= n; k++) {
        weigh_exchange(self, p, q, k, best);
    }
    for (uint32_t i = 0; p < q && i < p; i++) {
        weigh_exchange(self, i, p, q, best);
    }
    for (uint32_t j = q + 1U; q < p && j < p; j++) {
        weigh_exchange(self, q, j, p, best);
    }
    self->evals += n;
}

static move best_move(aisle_order *self, uint32_t i) {
    const uint32_t n = self->count;
    move best = {i, i, i, false, self->least_gain};
    const uint32_t a = before(self, i);
    const double now = cost_of(self, a, self->now[i]);
    for (uint32_t q = 0; q <= n; q++) {
        if (q != i && place_at(self, q) != a && cost_of(self, a, place_at(self, q)) < now) {
            weigh_exchanges(self, i, q, &best);
        }
    }
    for (uint32_t j = 0; j < n; j++) { // turn the stretch between the two
        uint32_t lo = i < j ? i : j;
        uint32_t hi = i < j ? j : i;
        double gain = lo < hi ? weigh_turn(self, lo, hi + 1U) : 0.0;
        if (gain > best.gain) {
            best = (move){lo, hi + 1U, lo, true, gain};
        }
    }
    for (uint32_t j = i + 1U; j <= i + AISLE_ORDER_SEGMENT && j <= n; j++) {
        for (uint32_t k = 0; k <= n; k++) {
            if (k < i || k > j) {
                weigh_shift(self, i, j, k, &best);
            }
        }
    }
    self->evals += n + 2U * AISLE_ORDER_SEGMENT * n;
    return best;
}

static void make(aisle_order *self, const move *m) {
    const double promised = self->now_value - m->gain;
    mark(self, before(self, m->i));
    mark(self, self->now[m->i]);
    mark(self, self->now[m->j - 1U]);
    mark(self, place_at(self, m->j));
    mark(self, before(self, m->k));
    mark(self, place_at(self, m->k));
    if (m->turned) {
        reverse(self->now + m->i, self->now + m->j);
    }
    if (m->k < m->i) {
        exchange(self, m->k, m->i, m->j);
    } else if (m->k > m->j) {
        exchange(self, m->i, m->j, m->k);
    }
    sum_up(self);
    AISLE_ASSERT(fabs(self->now_value - promised) <= 100.0 * self->least_gain);
}

// ---- local search

static void kick(aisle_order *self) {
    const uint32_t n = self->count;
    uint32_t first = aisle_rng_below(&self->rng, n - 2U);
    uint32_t room = n - first < NEAR ? n - first : NEAR;
    uint32_t one = 1U + aisle_rng_below(&self->rng, room - 1U);
    uint32_t two = 1U + aisle_rng_below(&self->rng, room - one);
    uint32_t i = first;
    uint32_t j = first + one;
    uint32_t k = first + one + two;
    const uint32_t cuts[3] = {i, j, k};
    for (uint32_t c = 0; c < 3U; c++) {
        mark(self, before(self, cuts[c]));
        mark(self, place_at(self, cuts[c]));
    }
    exchange(self, i, j, k);
    sum_up(self);
    self->kicks++;
}

// At a local optimum: gone on from, if it is not much dearer than the best.
static aisle_status settle(aisle_order *self) {
    const double gain = self->best_value - self->now_value;
    const double done = (double)self->kicks / ((double)self->cfg.kicks + 1.0);
    if (gain > self->least_gain) {
        self->best_value = self->now_value;
        adopt(self, self->now);
    } else if (gain < -DEARER * (1.0 - done) * self->best_value - self->least_gain) {
        memcpy(self->now, self->order, self->count);
        sum_up(self);
    }
    if (self->kicks >= self->cfg.kicks) {
        return end(self);
    }
    kick(self);
    return AISLE_BUSY;
}

static uint32_t position_of(const aisle_order *self, uint32_t place) {
    uint32_t at = 0;
    while (self->now[at] != place) {
        at++;
        AISLE_ASSERT(at < self->count);
    }
    return at;
}

static aisle_status step_descent(aisle_order *self) {
    if (self->dirty == 0U) {
        return settle(self);
    }
    uint32_t place = 0;
    while ((self->dirty >> place & 1U) == 0U) {
        place++;
    }
    move best = best_move(self, position_of(self, place));
    if (best.j > best.i) {
        make(self, &best);
    } else {
        self->dirty &= ~(UINT64_C(1) << place);
    }
    return AISLE_BUSY;
}

// ---- all together

aisle_status aisle_order_step(aisle_order *self, uint32_t evals) {
    const uint32_t from = self->evals;
    if (self->phase == AISLE_ORDER_IDLE) {
        return AISLE_ERR_ARG;
    }
    while (self->ended == AISLE_BUSY && self->evals - from < evals) {
        switch (self->phase) {
        case AISLE_ORDER_TABLE:
            self->ended = step_table(self);
            break;
        case AISLE_ORDER_INSERT:
            step_insert(self);
            break;
        default:
            self->ended = step_descent(self);
            break;
        }
    }
    return self->ended;
}

bool aisle_order_invariants_hold(const aisle_order *self) {
    const uint32_t n = self->cfg.n;
    if (self->phase == AISLE_ORDER_IDLE) {
        return true;
    }
    if (n < 1U || n > AISLE_ORDER_MAX || !is_permutation(self->order, n) || !is_permutation(self->now, n)) {
        return false;
    }
    double value = aisle_order_value(&self->cfg, self->order);
    return self->count <= n && (value == self->value || (isinf(value) && isinf(self->value)));
}
