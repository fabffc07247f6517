#include "algo/astar.h"

#include "base/check.h"

#include <string.h>

#define RING_MASK (AISLE_ASTAR_RING - 1U)
#define RING_WORDS (AISLE_ASTAR_RING / 64U)
#define DIR_SHIFT 11U
#define STATE_SHIFT 14U
#define CLOSED_SHIFT 15U                      // this bit tells closed and barred from untouched and open
#define COLLECT_LEAST (2U * AISLE_ASTAR_RING) // pushes before the ring is cleaned up

enum { UNTOUCHED = 0, OPEN = 1, CLOSED = 2, BARRED = 3 }; // of a cell, two bits

// Directions E N W S NE NW SW SE.
static const int32_t STEP_X[8] = {1, 0, -1, 0, 1, -1, -1, 1};
static const int32_t STEP_Y[8] = {0, 1, 0, -1, 1, 1, -1, -1};
static const uint32_t STEP_COST[8] = {AISLE_ASTAR_STRAIGHT, AISLE_ASTAR_STRAIGHT, AISLE_ASTAR_STRAIGHT,
                                      AISLE_ASTAR_STRAIGHT, AISLE_ASTAR_DIAGONAL, AISLE_ASTAR_DIAGONAL,
                                      AISLE_ASTAR_DIAGONAL, AISLE_ASTAR_DIAGONAL};
// Directions that leave the grid at a border, one bit each.
enum { LEAVES_EAST = 0x91, LEAVES_NORTH = 0x32, LEAVES_WEST = 0x64, LEAVES_SOUTH = 0xC8 };

static int32_t octile(int32_t dx, int32_t dy) {
    const int32_t a = dx < 0 ? -dx : dx;
    const int32_t b = dy < 0 ? -dy : dy;
    return 29 * (a + b) + 41 * (a > b ? a : b); // 70 max + 29 min
}

static uint32_t state_of(uint16_t word) {
    return (uint32_t)word >> STATE_SHIFT;
}

static uint16_t word_of(uint32_t state, uint32_t dir, uint32_t f_low) {
    return (uint16_t)(state << STATE_SHIFT | dir << DIR_SHIFT | f_low);
}

// Number of the lowest bit that is set, by de Bruijn's sequence (Leiserson, Prokop, Randall 1998).
static uint32_t lowest_bit(uint64_t word) {
    static const uint8_t PLACE[64] = {0,  1,  2,  53, 3,  7,  54, 27, 4,  38, 41, 8,  34, 55, 48, 28,
                                      62, 5,  39, 46, 44, 42, 22, 9,  24, 35, 59, 56, 49, 18, 29, 11,
                                      63, 52, 6,  26, 37, 40, 33, 47, 61, 45, 43, 21, 23, 58, 17, 10,
                                      51, 25, 36, 32, 60, 20, 57, 16, 50, 31, 19, 15, 30, 14, 13, 12};
    return PLACE[((word & (0U - word)) * 0x022FDD63CC95386DU) >> 58];
}

void aisle_astar_carve(aisle_astar *self, aisle_arena *arena, uint32_t cells, uint32_t open_nodes) {
    AISLE_ASSERT(cells >= 1 && cells <= AISLE_ASTAR_CELLS_MAX);
    AISLE_ASSERT(open_nodes >= 1 && open_nodes < AISLE_ASTAR_NONE);
    *self = (aisle_astar){.capacity = cells, .open_capacity = open_nodes, .ended = AISLE_ERR_ARG};
    self->cell = aisle_arena_take(arena, cells, sizeof *self->cell);
    self->open = aisle_arena_take(arena, open_nodes, sizeof *self->open);
    self->bucket = aisle_arena_take(arena, AISLE_ASTAR_RING, sizeof *self->bucket);
}

// Is this entry of the bucket its cell's newest one? Older ones of a cell lie in buckets of larger f.
static bool is_current(const aisle_astar *self, uint32_t cell, uint32_t bucket) {
    return ((uint32_t)self->cell[cell] & ~(7U << DIR_SHIFT)) == word_of(OPEN, 0, bucket);
}

// Throws the stale entries of one bucket away; the others keep their order.
static void collect_bucket(aisle_astar *self, uint32_t bucket) {
    uint32_t *link = &self->bucket[bucket];
    while (*link != AISLE_ASTAR_NONE) {
        const uint32_t at = *link;
        aisle_astar_node *node = &self->open[at];
        if (is_current(self, node->cell, bucket)) {
            link = &node->next;
        } else {
            *link = node->next;
            node->next = self->free_head;
            self->free_head = at;
            self->open_used--;
        }
    }
    if (self->bucket[bucket] == AISLE_ASTAR_NONE) {
        self->filled[bucket / 64U] &= ~((uint64_t)1 << (bucket % 64U));
    }
}

// Called when the list has grown to collect_at: throws the stale entries away and sets the next mark. False: that
// would give less than an eighth of the list. So a push pays for O(1) entries looked at.
static bool collect(aisle_astar *self) {
    const uint32_t stale = self->open_used - self->live;
    if (self->open_used == self->open_capacity && stale < self->open_capacity / 8U + 1U) {
        return false;
    }
    for (uint32_t bucket = 0; bucket < AISLE_ASTAR_RING; bucket++) {
        collect_bucket(self, bucket);
    }
    AISLE_ASSERT(self->open_used == self->live);
    self->collected++;
    const uint32_t room = self->open_capacity - self->live;
    self->collect_at = self->live + (room < self->live + COLLECT_LEAST ? room : self->live + COLLECT_LEAST);
    return true;
}

static bool push(aisle_astar *self, uint32_t cell, uint32_t bucket) {
    if (self->open_used == self->collect_at && !collect(self)) {
        return false;
    }
    uint32_t at = self->free_head;
    if (at != AISLE_ASTAR_NONE) {
        self->free_head = self->open[at].next;
    } else {
        AISLE_ASSERT(self->untouched < self->open_capacity);
        at = self->untouched++;
    }
    self->open[at] = (aisle_astar_node){cell, self->bucket[bucket]};
    self->bucket[bucket] = at;
    self->filled[bucket / 64U] |= (uint64_t)1 << (bucket % 64U);
    self->open_used++;
    self->open_used_max = self->open_used > self->open_used_max ? self->open_used : self->open_used_max;
    return true;
}

// Moves f forward to the next filled bucket; the ring must not be empty.
static void advance(aisle_astar *self) {
    const uint32_t from = (uint32_t)self->f & RING_MASK;
    uint32_t word = from / 64U;
    uint64_t bits = self->filled[word] & (UINT64_MAX << (from % 64U));
    for (uint32_t tries = 0; bits == 0; tries++) {
        AISLE_ASSERT(tries < RING_WORDS);
        word = (word + 1U) % RING_WORDS;
        bits = self->filled[word];
    }
    self->f += (word * 64U + lowest_bit(bits) - from) & RING_MASK;
}

// Takes the newest entry of least f; AISLE_ASTAR_NONE when there is none.
static uint32_t pop(aisle_astar *self) {
    if (self->open_used == 0) {
        return AISLE_ASTAR_NONE;
    }
    advance(self);
    const uint32_t bucket = (uint32_t)self->f & RING_MASK;
    const uint32_t at = self->bucket[bucket];
    AISLE_ASSERT(at < self->untouched);
    aisle_astar_node *node = &self->open[at];
    self->bucket[bucket] = node->next;
    if (node->next == AISLE_ASTAR_NONE) {
        self->filled[bucket / 64U] &= ~((uint64_t)1 << (bucket % 64U));
    }
    node->next = self->free_head;
    self->free_head = at;
    self->open_used--;
    return node->cell;
}

static aisle_status refusal(const aisle_astar *self, const aisle_astar_config *cfg) {
    const uint64_t cells = (uint64_t)cfg->w * cfg->h;
    if (cfg->enter == NULL || cells == 0 || cfg->start >= cells || cfg->goal >= cells) {
        return AISLE_ERR_ARG;
    }
    return cells > self->capacity ? AISLE_ERR_CAPACITY : AISLE_OK;
}

aisle_status aisle_astar_start(aisle_astar *self, const aisle_astar_config *cfg) {
    const aisle_status refused = refusal(self, cfg);
    if (refused != AISLE_OK) {
        return refused;
    }
    self->cfg = *cfg;
    memset(self->cell, 0, (size_t)cfg->w * cfg->h * sizeof *self->cell);
    memset(self->filled, 0, sizeof self->filled);
    for (uint32_t b = 0; b < AISLE_ASTAR_RING; b++) {
        self->bucket[b] = AISLE_ASTAR_NONE;
    }
    for (uint32_t dir = 0; dir < 8; dir++) {
        self->offset[dir] = STEP_Y[dir] * (int32_t)cfg->w + STEP_X[dir];
    }
    self->free_head = AISLE_ASTAR_NONE;
    self->collect_at = self->open_capacity < COLLECT_LEAST ? self->open_capacity : COLLECT_LEAST;
    self->untouched = self->open_used = self->live = 0;
    self->expanded = self->asked = self->collected = 0;
    self->goal_x = (int32_t)(cfg->goal % cfg->w);
    self->goal_y = (int32_t)(cfg->goal / cfg->w);
    self->f =
        (uint64_t)octile((int32_t)(cfg->start % cfg->w) - self->goal_x, (int32_t)(cfg->start / cfg->w) - self->goal_y);
    self->ended = AISLE_BUSY;
    const uint32_t f_low = (uint32_t)self->f & RING_MASK;
    self->cell[cfg->start] = word_of(OPEN, 0, f_low);
    const bool pushed = push(self, cfg->start, f_low);
    AISLE_ASSERT(pushed);
    self->live = 1;
    return AISLE_OK;
}

// Asks about one move and opens the cell if it is the best one so far. h_change: how much h grows over it. False: the
// open list is full.
static bool relax(aisle_astar *self, uint32_t from, uint32_t to, uint32_t dir, int32_t h_change) {
    // f relative to the current one: what the cell has, what the move gives at least, what it gives.
    const uint16_t word = self->cell[to];
    const uint32_t f_low = (uint32_t)self->f;
    const uint32_t has = word == 0 ? AISLE_ASTAR_RING : (word - f_low) & RING_MASK;
    if ((uint32_t)((int32_t)STEP_COST[dir] + h_change) >= has) {
        return true;
    }
    self->asked++;
    const uint32_t factor = self->cfg.enter(self->cfg.ctx, from, to, (uint8_t)dir);
    if (factor == AISLE_ASTAR_BARRED_CELL) {
        AISLE_ASSERT(word == 0); // nobody may have entered it before
        self->cell[to] = word_of(BARRED, 0, 0);
        return true;
    }
    if (factor == AISLE_ASTAR_BARRED) {
        return true;
    }
    AISLE_ASSERT(factor >= AISLE_ASTAR_FACTOR_ONE && factor <= AISLE_ASTAR_FACTOR_MAX);
    const uint32_t gives = (uint32_t)((int32_t)(STEP_COST[dir] * factor / AISLE_ASTAR_FACTOR_ONE) + h_change);
    if (gives >= has) {
        return true;
    }
    const uint32_t bucket = (f_low + gives) & RING_MASK;
    if (!push(self, to, bucket)) {
        return false;
    }
    self->cell[to] = word_of(OPEN, dir, bucket);
    self->live += word == 0;
    return true;
}

// Directions that lead out of the grid from (x, y), one bit each.
static uint32_t leaving(const aisle_astar *self, uint32_t x, uint32_t y) {
    return (x + 1U == self->cfg.w ? (uint32_t)LEAVES_EAST : 0U) | (x == 0 ? (uint32_t)LEAVES_WEST : 0U) |
           (y + 1U == self->cfg.h ? (uint32_t)LEAVES_NORTH : 0U) | (y == 0 ? (uint32_t)LEAVES_SOUTH : 0U);
}

static bool expand(aisle_astar *self, uint32_t cell) {
    const uint32_t y = cell / self->cfg.w;
    const uint32_t x = cell - y * self->cfg.w;
    const uint32_t leaves = leaving(self, x, y);
    const int32_t dx = (int32_t)x - self->goal_x;
    const int32_t dy = (int32_t)y - self->goal_y;
    const int32_t h = octile(dx, dy);
// Unrolled, each direction has branches of its own for the processor to foresee: an eighth faster.
#pragma GCC unroll 8
    for (uint32_t dir = 0; dir < 8; dir++) {
        if ((leaves >> dir & 1U) != 0U) {
            continue;
        }
        const uint32_t to = (uint32_t)((int32_t)cell + self->offset[dir]);
        if (state_of(self->cell[to]) < CLOSED &&
            !relax(self, cell, to, dir, octile(dx + STEP_X[dir], dy + STEP_Y[dir]) - h)) {
            return false;
        }
    }
    return true;
}

// Takes one entry; AISLE_BUSY unless that ended the search.
static aisle_status take_one(aisle_astar *self) {
    const uint32_t cell = pop(self);
    if (cell == AISLE_ASTAR_NONE) {
        return AISLE_PARTIAL;
    }
    const uint16_t word = self->cell[cell];
    if (state_of(word) == CLOSED) { // it came up before with a smaller f
        return AISLE_BUSY;
    }
    AISLE_ASSERT(state_of(word) == OPEN && ((word ^ (uint32_t)self->f) & RING_MASK) == 0);
    self->cell[cell] = (uint16_t)(word + (1U << STATE_SHIFT)); // OPEN becomes CLOSED
    self->expanded++;
    self->live--;
    if (cell == self->cfg.goal) {
        return AISLE_OK;
    }
    return expand(self, cell) ? AISLE_BUSY : AISLE_ERR_CAPACITY;
}

aisle_status aisle_astar_step(aisle_astar *self, uint32_t nodes) {
    for (uint32_t taken = 0; taken < nodes && self->ended == AISLE_BUSY; taken++) {
        self->ended = take_one(self);
    }
    return self->ended;
}

uint64_t aisle_astar_cost(const aisle_astar *self) {
    return self->ended == AISLE_OK ? self->f : UINT64_MAX; // h is 0 at the goal
}

static uint32_t parent_of(const aisle_astar *self, uint32_t cell) {
    const uint32_t dir = (uint32_t)self->cell[cell] >> DIR_SHIFT & 7U;
    return (uint32_t)((int32_t)cell - self->offset[dir]);
}

aisle_status aisle_astar_path(const aisle_astar *self, uint32_t *cells, uint32_t capacity, uint32_t *count) {
    if (self->ended != AISLE_OK) {
        return AISLE_ERR_ARG;
    }
    uint32_t length = 1;
    for (uint32_t at = self->cfg.goal; at != self->cfg.start; at = parent_of(self, at)) {
        AISLE_ASSERT(length < self->expanded);
        length++;
    }
    *count = length;
    if (length > capacity) {
        return AISLE_ERR_CAPACITY;
    }
    uint32_t at = self->cfg.goal;
    for (uint32_t left = length; left > 1; left--) {
        cells[left - 1] = at;
        at = parent_of(self, at);
    }
    cells[0] = at;
    return AISLE_OK;
}

bool aisle_astar_reached(const aisle_astar *self, uint32_t cell) {
    return self->ended != AISLE_ERR_ARG && cell < self->cfg.w * self->cfg.h && state_of(self->cell[cell]) == CLOSED;
}

// Entries of one bucket: in range, and each either its cell's present f or stale. Adds to the counts.
static bool chain_holds(const aisle_astar *self, uint32_t bucket, uint32_t *entries, uint32_t *current) {
    for (uint32_t at = self->bucket[bucket]; at != AISLE_ASTAR_NONE; at = self->open[at].next) {
        if (at >= self->untouched || ++*entries > self->open_used) {
            return false;
        }
        const uint32_t cell = self->open[at].cell;
        if (cell >= self->cfg.w * self->cfg.h) {
            return false;
        }
        const uint32_t state = state_of(self->cell[cell]);
        if (state != OPEN && state != CLOSED) {
            return false;
        }
        *current += is_current(self, cell, bucket);
    }
    return true;
}

static bool free_chain_holds(const aisle_astar *self) {
    const uint32_t want = self->untouched - self->open_used;
    uint32_t chained = 0;
    for (uint32_t at = self->free_head; at != AISLE_ASTAR_NONE; at = self->open[at].next) {
        if (at >= self->untouched || ++chained > want) {
            return false;
        }
    }
    return chained == want;
}

// Are there as many cells in each state as the counters and the ring say?
static bool cells_hold(const aisle_astar *self, uint32_t current) {
    uint32_t count[4] = {0};
    for (uint32_t cell = 0; cell < self->cfg.w * self->cfg.h; cell++) {
        const uint16_t word = self->cell[cell];
        count[state_of(word)]++;
        if (state_of(word) == UNTOUCHED && word != 0) {
            return false;
        }
    }
    return count[OPEN] == current && current == self->live && count[CLOSED] == self->expanded;
}

bool aisle_astar_invariants_hold(const aisle_astar *self) {
    if (self->ended == AISLE_ERR_ARG) {
        return true; // never started
    }
    if (self->untouched > self->open_capacity || self->open_used > self->untouched ||
        self->open_used > self->open_used_max || self->open_used_max > self->open_capacity ||
        (uint64_t)self->cfg.w * self->cfg.h > self->capacity) {
        return false;
    }
    uint32_t entries = 0;
    uint32_t current = 0;
    for (uint32_t b = 0; b < AISLE_ASTAR_RING; b++) {
        const bool filled = (self->filled[b / 64U] >> (b % 64U) & 1U) != 0U;
        if (filled != (self->bucket[b] != AISLE_ASTAR_NONE) || !chain_holds(self, b, &entries, &current)) {
            return false;
        }
    }
    return entries == self->open_used && free_chain_holds(self) && cells_hold(self, current);
}
