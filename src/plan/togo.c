#include "plan/togo.h"

#include "base/check.h"

#include <math.h>
#include <string.h>

#define STRAIGHT 5U
#define DIAGONAL 7U
#define COST_MAX (AISLE_TOGO_NONE - DIAGONAL * AISLE_TOGO_DEAR_MAX) // from which on no step is made
#define CELLS_A_UNIT 32U
#define WORTH_SHARE 1.5 // of the start's cost, how far the search goes on where more than the way there is wanted
#define WORTH_MORE 10.0 // m, and beyond

static const int DX[8] = {1, 0, -1, 0, 1, -1, -1, 1}, DY[8] = {0, 1, 0, -1, 1, 1, -1, -1}; // straight ones first

void aisle_togo_carve(aisle_togo *self, aisle_arena *arena, uint32_t cells) {
    self->capacity = cells / AISLE_TOGO_SHARE + 256U;
    self->cost = (uint16_t *)aisle_arena_take(arena, self->capacity, sizeof(uint16_t));
    self->room = self->capacity < AISLE_TOGO_QUEUE ? self->capacity : AISLE_TOGO_QUEUE;
    self->queue = (uint32_t *)aisle_arena_take(arena, (size_t)AISLE_TOGO_RING * self->room, sizeof(uint32_t));
}

static uint32_t cell_of(const aisle_togo *self, aisle_vec2 p) {
    uint32_t fine = aisle_lattice_cell(&self->grid->lattice, p, NULL);
    uint32_t ix = fine % self->grid->lattice.w / self->stride;
    uint32_t iy = fine / self->grid->lattice.w / self->stride;
    return iy * self->w + ix;
}

// One that finds no room in its bucket is left out: it is a guide only, and its neighbours come to it again.
static void reach(aisle_togo *self, uint32_t cell, uint32_t cost) {
    uint32_t bucket = cost % AISLE_TOGO_RING;
    if (cost < self->cost[cell] && self->count[bucket] < self->room) {
        self->cost[cell] = (uint16_t)cost;
        self->queue[bucket * self->room + self->count[bucket]++] = cell;
    }
}

static void lay_cells(aisle_togo *self) {
    const aisle_lattice *lattice = &self->grid->lattice;
    uint32_t stride = (uint32_t)aisle_max(1.0, floor(AISLE_TOGO_SIDE / lattice->res + 0.5));
    do {
        self->w = (lattice->w + stride - 1U) / stride;
        self->h = (lattice->h + stride - 1U) / stride;
        self->stride = stride++;
    } while ((uint64_t)self->w * self->h > self->capacity);
    self->size = (double)self->stride * lattice->res;
    memset(self->cost, 0xFF, (size_t)self->w * self->h * sizeof(uint16_t));
}

// The least field value of a cell in which a disc may find room: a point of it may be half a diagonal from its centre, and so
// may the obstacle's from its own.
static uint32_t field_for(const aisle_grid *grid, double radius) {
    double least = aisle_max(radius / grid->lattice.res - 1.4143, 0.5);
    return (uint32_t)aisle_min(least * least, (double)AISLE_FIELD_SQ_MAX);
}

void aisle_togo_start(aisle_togo *self, const aisle_grid *grid, double reach_of, aisle_vec2 start, aisle_vec2 goal) {
    self->grid = grid;
    lay_cells(self);
    self->open_from = field_for(grid, reach_of);
    self->clear_from = 0;
    self->dear = 1;
    self->insists = self->ends_at_start = false;
    memset(self->count, 0, sizeof self->count);
    self->at = self->cells = 0;
    self->limit = COST_MAX;
    self->since = AISLE_TOGO_NONE;
    self->start = cell_of(self, start);
    self->goal = cell_of(self, goal);
    reach(self, self->goal, 0);
}

void aisle_togo_keep_clear(aisle_togo *self, double clear, uint32_t dear) {
    AISLE_ASSERT(dear >= 1U && dear <= AISLE_TOGO_DEAR_MAX);
    self->clear_from = field_for(self->grid, clear);
    self->dear = dear;
}

void aisle_togo_end_at_start(aisle_togo *self) {
    self->ends_at_start = true;
}

// Room at both ends of a diagonal step for all of it (space.h), half a diagonal for the centre's place in its planning
// cell and another for the obstacle's.
void aisle_togo_insist(aisle_togo *self, double reach_of) {
    const double need = sqrt(reach_of * reach_of + 0.5 * self->size * self->size);
    const double cells = need / self->grid->lattice.res + 1.4143;
    self->open_from = (uint32_t)aisle_min(cells * cells + 1.0, (double)AISLE_FIELD_SQ_MAX);
    self->insists = true;
}

// Closed ones are not.
static bool may_be_entered(const aisle_togo *self, uint32_t cell) {
    return self->cost[cell] != 0U || cell == self->goal;
}

static aisle_vec2 centre_of(const aisle_togo *self, uint32_t ix, uint32_t iy) {
    const aisle_lattice *lattice = &self->grid->lattice;
    return aisle_vec2_of(lattice->x0 + ((double)ix + 0.5) * self->size, lattice->y0 + ((double)iy + 0.5) * self->size);
}

static void close_cell(aisle_togo *self, uint32_t cell) {
    if (cell == self->start || !may_be_entered(self, cell)) {
        return;
    }
    if (cell == self->goal) {
        memset(self->count, 0, sizeof self->count);
        self->goal = UINT32_MAX;
    }
    self->since = self->cost[cell] < self->since ? self->cost[cell] : self->since;
    self->cost[cell] = 0; // nothing is nearer: never entered
}

void aisle_togo_close(aisle_togo *self, aisle_vec2 a, aisle_vec2 b, double radius) {
    const aisle_aabb box = {{aisle_min(a.x, b.x) - radius, aisle_min(a.y, b.y) - radius},
                            {aisle_max(a.x, b.x) + radius, aisle_max(a.y, b.y) + radius}};
    const bool is_disc = aisle_vec2_distance(a, b) <= 0.0;
    const uint32_t lo = cell_of(self, box.lo), hi = cell_of(self, box.hi);
    for (uint32_t iy = lo / self->w; iy <= hi / self->w; iy++) {
        for (uint32_t ix = lo % self->w; ix <= hi % self->w; ix++) {
            const aisle_vec2 c = centre_of(self, ix, iy);
            const aisle_vec2 off = aisle_vec2_sub(c, a);
            if (aisle_vec2_dot(off, off) < radius * radius || (!is_disc && aisle_segment_gap(a, b, c, c) < radius)) {
                close_cell(self, iy * self->w + ix);
            }
        }
    }
}

// Of its planning cells the middle one, on an even stride that behind the middle.
static bool holds_centre(const aisle_togo *self, uint32_t ix, uint32_t iy) {
    const aisle_lattice *lattice = &self->grid->lattice;
    const uint32_t mx = ix * self->stride + self->stride / 2U, my = iy * self->stride + self->stride / 2U;
    const uint32_t x = mx < lattice->w ? mx : lattice->w - 1U, y = my < lattice->h ? my : lattice->h - 1U;
    return self->grid->field[(size_t)y * lattice->w + x] >= self->open_from || iy * self->w + ix == self->start;
}

// Does any of its planning cells have this field value or more?
static bool holds(const aisle_togo *self, uint32_t ix, uint32_t iy, uint32_t least) {
    const aisle_lattice *lattice = &self->grid->lattice;
    uint32_t x0 = ix * self->stride, x1 = x0 + self->stride < lattice->w ? x0 + self->stride : lattice->w;
    uint32_t y0 = iy * self->stride, y1 = y0 + self->stride < lattice->h ? y0 + self->stride : lattice->h;
    for (uint32_t y = y0; y < y1; y++) {
        const uint16_t *row = self->grid->field + (size_t)y * lattice->w;
        for (uint32_t x = x0; x < x1; x++) {
            if (row[x] >= least) {
                return true;
            }
        }
    }
    return false;
}

static bool is_open(const aisle_togo *self, uint32_t ix, uint32_t iy) {
    return self->insists ? holds_centre(self, ix, iy) : holds(self, ix, iy, self->open_from);
}

// Of a step to the cell.
static uint32_t price(const aisle_togo *self, uint32_t ix, uint32_t iy, uint32_t step) {
    return self->dear == 1U || holds(self, ix, iy, self->clear_from) ? step : step * self->dear;
}

static void enter(aisle_togo *self, uint32_t ix, uint32_t iy, uint32_t step) {
    const uint32_t cell = iy * self->w + ix;
    if (self->cost[cell] != AISLE_TOGO_NONE || is_open(self, ix, iy)) { // one that was reached is open
        reach(self, cell, self->at + price(self, ix, iy, step));
    } else {
        self->cost[cell] = 0; // closed: not looked at again
    }
}

// Which neighbours could be nearer by this cell, a bit each: most are near enough already.
static uint32_t nearer_by(const aisle_togo *self, uint32_t cell, uint32_t ix, uint32_t iy) {
    const uint32_t w = self->w, side = self->at + STRAIGHT, across = self->at + DIAGONAL;
    uint32_t bits = 0;
    if (ix > 0U && iy > 0U && ix + 1U < w && iy + 1U < self->h) {
        const uint16_t *row = self->cost + cell, *above = row + w, *below = row - w;
        return (uint32_t)(side < row[1]) | (uint32_t)(side < above[0]) << 1 | (uint32_t)(side < row[-1]) << 2 |
               (uint32_t)(side < below[0]) << 3 | (uint32_t)(across < above[1]) << 4 |
               (uint32_t)(across < above[-1]) << 5 | (uint32_t)(across < below[-1]) << 6 |
               (uint32_t)(across < below[1]) << 7;
    }
    for (uint32_t k = 0; k < 8U; k++) {
        const uint32_t nx = ix + (uint32_t)DX[k], ny = iy + (uint32_t)DY[k]; // below 0 wraps to beyond w
        const bool is_there = nx < w && ny < self->h;
        bits |= (uint32_t)(is_there && (k < 4U ? side : across) < self->cost[ny * w + nx]) << k;
    }
    return bits;
}

static void expand(aisle_togo *self, uint32_t cell) {
    const uint32_t ix = cell % self->w, iy = cell / self->w;
    uint32_t bits = nearer_by(self, cell, ix, iy);
    for (uint32_t k = 0; bits != 0U; k++, bits >>= 1) {
        if ((bits & 1U) != 0U) {
            enter(self, ix + (uint32_t)DX[k], iy + (uint32_t)DY[k], k < 4U ? STRAIGHT : DIAGONAL);
        }
    }
}

static bool is_reached(const aisle_togo *self, uint32_t cell) {
    return self->cost[cell] != AISLE_TOGO_NONE && may_be_entered(self, cell);
}

// The next bucket that holds something; false: none does, or the limit is reached.
static bool next_bucket(aisle_togo *self) {
    for (uint32_t i = 0; i < AISLE_TOGO_RING && self->at < self->limit; i++, self->at++) {
        if (self->count[self->at % AISLE_TOGO_RING] > 0U) {
            return true;
        }
    }
    return false;
}

// Goes back to where the first cell was closed: forgets what is no nearer and puts the cells before into their buckets again,
// as far as a step reaches.
static void go_back(aisle_togo *self) {
    const uint32_t reach_back = DIAGONAL * self->dear, first = self->since > reach_back ? self->since - reach_back : 0U;
    memset(self->count, 0, sizeof self->count);
    for (uint32_t cell = 0; cell < self->w * self->h; cell++) {
        const uint32_t cost = self->cost[cell];
        if (is_reached(self, cell) && cost >= first) {
            self->cost[cell] = AISLE_TOGO_NONE;
            if (cost < self->since) {
                reach(self, cell, cost);
            }
        }
    }
    self->at = first;
    self->limit = COST_MAX;
}

aisle_status aisle_togo_step(aisle_togo *self, uint32_t units, uint32_t *spent) {
    uint32_t before = self->cells / CELLS_A_UNIT;
    if (self->since <= self->at) { // what lies beyond the end of the search hangs on nothing
        go_back(self);
    }
    self->since = AISLE_TOGO_NONE;
    bool more = next_bucket(self);
    while (more && self->cells / CELLS_A_UNIT - before < units) {
        uint32_t bucket = self->at % AISLE_TOGO_RING;
        uint32_t cell = self->queue[bucket * self->room + --self->count[bucket]];
        self->cells++;
        if (self->cost[cell] == self->at) {
            expand(self, cell);
            if (cell == self->start && self->limit == COST_MAX) {
                double beyond = WORTH_SHARE * (double)self->at + STRAIGHT * WORTH_MORE / self->size;
                beyond = self->ends_at_start ? (double)self->at : beyond;
                self->limit = (uint32_t)aisle_min(beyond, (double)self->limit);
            }
        }
        more = next_bucket(self);
    }
    *spent += self->cells / CELLS_A_UNIT - before;
    if (more) {
        return AISLE_BUSY;
    }
    return is_reached(self, self->start) ? AISLE_OK : AISLE_PARTIAL;
}

double aisle_togo_at(const aisle_togo *self, aisle_vec2 p) {
    const uint32_t cell = cell_of(self, p);
    return is_reached(self, cell) ? (double)self->cost[cell] * self->size / STRAIGHT : (double)INFINITY;
}

bool aisle_togo_next(const aisle_togo *self, aisle_vec2 p, aisle_vec2 *next) {
    const uint32_t cell = cell_of(self, p), ix = cell % self->w, iy = cell / self->w;
    uint32_t least = self->cost[cell]; // NONE is the largest
    bool found = false;
    for (uint32_t k = 0; k < 8U; k++) {
        const uint32_t nx = ix + (uint32_t)DX[k], ny = iy + (uint32_t)DY[k]; // below 0 wraps to beyond w
        const uint32_t at = nx < self->w && ny < self->h ? ny * self->w + nx : cell;
        if (is_reached(self, at) && self->cost[at] < least) {
            least = self->cost[at];
            *next = centre_of(self, nx, ny);
            found = true;
        }
    }
    return found;
}
