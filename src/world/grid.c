#include "world/grid.h"

#include "base/check.h"

#include <float.h>
#include <string.h>

enum { PHASE_DOWN, PHASE_UP, PHASE_ROWS, PHASE_DONE };

#define HALF_DIAGONAL 0.70710678118654752440 // of a cell, in cells
#define COLUMN_MAX 256U                      // column distances saturate here: 256^2 > AISLE_FIELD_SQ_MAX
#define REACH 255                            // columns a parabola matters to either side: 256^2 > AISLE_FIELD_SQ_MAX
#define CHUNK 256                            // columns taken between two emissions

// ---- lattice

static uint32_t cells_along(double length, double res) {
    const double exact = length / res;
    const double nearest = floor(exact + 0.5);
    const double count = aisle_max(1.0, fabs(exact - nearest) <= AISLE_GRID_SLACK ? nearest : floor(exact) + 1.0);
    return count < (double)UINT32_MAX ? (uint32_t)count : UINT32_MAX;
}

bool aisle_lattice_over(aisle_vec2 lo, aisle_vec2 hi, double res, aisle_lattice *out) {
    *out = (aisle_lattice){lo.x, lo.y, res, 0, 0};
    const double dx = hi.x - lo.x;
    const double dy = hi.y - lo.y;
    if (!(dx > 0.0 && dx <= DBL_MAX && dy > 0.0 && dy <= DBL_MAX && res > 0.0 && res <= DBL_MAX)) {
        return false;
    }
    out->w = cells_along(dx, res);
    out->h = cells_along(dy, res);
    return out->w <= AISLE_GRID_SIDE_MAX && out->h <= AISLE_GRID_SIDE_MAX; // SIDE_MAX^2 < UINT32_MAX
}

// Index along one side of n cells, and whether `at` (in cells) lies in it; NaN does not.
static uint32_t clamp_index(double at, uint32_t n, bool *inside) {
    if (!(at >= 0.0)) {
        *inside = false;
        return 0;
    }
    if (at >= (double)n) {
        *inside = *inside && at <= (double)n;
        return n - 1U;
    }
    return (uint32_t)at;
}

uint32_t aisle_lattice_cell(const aisle_lattice *lattice, aisle_vec2 p, bool *inside) {
    bool in = true;
    const uint32_t ix = clamp_index((p.x - lattice->x0) / lattice->res, lattice->w, &in);
    const uint32_t iy = clamp_index((p.y - lattice->y0) / lattice->res, lattice->h, &in);
    if (inside != NULL) {
        *inside = in;
    }
    return iy * lattice->w + ix;
}

aisle_vec2 aisle_lattice_centre(const aisle_lattice *lattice, uint32_t cell) {
    const uint32_t ix = cell % lattice->w;
    const uint32_t iy = cell / lattice->w;
    return aisle_vec2_of(lattice->x0 + ((double)ix + 0.5) * lattice->res,
                         lattice->y0 + ((double)iy + 0.5) * lattice->res);
}

// ---- marking

void aisle_grid_carve(aisle_grid *self, aisle_arena *arena, uint32_t cells) {
    *self = (aisle_grid){.capacity = cells, .phase = PHASE_DONE};
    self->field = aisle_arena_take(arena, cells, sizeof *self->field);
    self->scratch = aisle_arena_take(arena, AISLE_GRID_WINDOW, sizeof *self->scratch);
}

aisle_status aisle_grid_begin(aisle_grid *self, const aisle_lattice *lattice) {
    const uint32_t side_max = lattice->w > lattice->h ? lattice->w : lattice->h;
    if (lattice->w == 0 || lattice->h == 0 || side_max > AISLE_GRID_SIDE_MAX || !(lattice->res > 0.0)) {
        return AISLE_ERR_ARG;
    }
    const uint32_t cells = lattice->w * lattice->h;
    if (cells > self->capacity) {
        return AISLE_ERR_CAPACITY;
    }
    self->lattice = *lattice;
    for (uint32_t i = 0; i < cells; i++) { // free: further than any column distance that counts
        self->field[i] = COLUMN_MAX;
    }
    self->next_row = 0;
    self->phase = PHASE_DOWN;
    return AISLE_OK;
}

void aisle_grid_mark_cell(aisle_grid *self, uint32_t cell) {
    AISLE_ASSERT(cell < self->lattice.w * self->lattice.h);
    self->field[cell] = 0;
}

void aisle_grid_mark_run(aisle_grid *self, uint32_t iy, uint32_t ix0, uint32_t end) {
    AISLE_ASSERT(iy < self->lattice.h);
    const uint32_t stop = end < self->lattice.w ? end : self->lattice.w;
    if (ix0 < stop) {
        memset(&self->field[iy * self->lattice.w + ix0], 0, (stop - ix0) * sizeof *self->field);
    }
}

typedef struct span {
    double lo, hi;
} span;

// A side of the rounded shape: an edge moved outwards by the radius, in cells from the lattice's corner.
typedef struct side {
    aisle_vec2 corner; // the first end of the edge itself
    aisle_vec2 from;   // and of the moved one
    span x, y;         // box around the moved edge
    double x_per_y;
    bool is_level; // so flat that crossings are not worth computing
} side;

static void take_in(span *s, double lo, double hi) {
    s->lo = aisle_min(s->lo, lo);
    s->hi = aisle_max(s->hi, hi);
}

static side side_between(aisle_vec2 a, aisle_vec2 b, double radius) {
    const aisle_vec2 edge = aisle_vec2_sub(b, a);
    const double length = aisle_vec2_length(edge);
    const double k = length > 0.0 ? radius / length : 0.0;
    const aisle_vec2 outwards = aisle_vec2_of(edge.y * k, -edge.x * k);
    const aisle_vec2 to = aisle_vec2_add(b, outwards);
    side s = {.corner = a, .from = aisle_vec2_add(a, outwards)};
    s.x = (span){aisle_min(s.from.x, to.x), aisle_max(s.from.x, to.x)};
    s.y = (span){aisle_min(s.from.y, to.y), aisle_max(s.from.y, to.y)};
    s.is_level = fabs(edge.y) <= AISLE_GRID_SLACK;
    s.x_per_y = s.is_level ? 0.0 : edge.x / edge.y;
    return s;
}

// Takes in the part of a side, and of the disc at its corner, with y in the given span.
static void take_in_side(const side *s, double radius, span y, span *x) {
    const double off = aisle_max(0.0, aisle_max(y.lo - s->corner.y, s->corner.y - y.hi));
    if (off <= radius) {
        const double half = sqrt(radius * radius - off * off);
        take_in(x, s->corner.x - half, s->corner.x + half);
    }
    if (s->y.lo > y.hi || s->y.hi < y.lo) {
        return;
    }
    if (s->is_level) {
        take_in(x, s->x.lo, s->x.hi);
        return;
    }
    const double at_lo = s->from.x + (aisle_max(y.lo, s->y.lo) - s->from.y) * s->x_per_y;
    const double at_hi = s->from.x + (aisle_min(y.hi, s->y.hi) - s->from.y) * s->x_per_y;
    take_in(x, aisle_clamp(aisle_min(at_lo, at_hi), s->x.lo, s->x.hi),
            aisle_clamp(aisle_max(at_lo, at_hi), s->x.lo, s->x.hi));
}

// First and one past the last index of the cells along a side of n that [lo, hi] touches, slack included.
static void touched(double lo, double hi, uint32_t n, uint32_t *first, uint32_t *end) {
    const double limit = (double)n;
    *first = (uint32_t)aisle_clamp(floor(lo - AISLE_GRID_SLACK), 0.0, limit);
    *end = (uint32_t)aisle_clamp(floor(hi + AISLE_GRID_SLACK) + 1.0, 0.0, limit);
}

// The outline of a rounded convex shape is its moved edges and the arcs of its corner discs, and the shape's part
// in a row of cells reaches left and right as far as the outline's part in it does.
void aisle_grid_mark_convex(aisle_grid *self, const aisle_convex *shape) {
    enum { SIDES_MAX = 32 };
    AISLE_ASSERT(shape->n >= 1U && shape->n <= SIDES_MAX && self->phase == PHASE_DOWN && self->next_row == 0);
    const aisle_lattice *lattice = &self->lattice;
    const double radius = shape->radius / lattice->res;
    side sides[SIDES_MAX];
    span all = {DBL_MAX, -DBL_MAX};
    for (uint32_t i = 0; i < shape->n; i++) {
        const aisle_vec2 corner = {lattice->x0, lattice->y0};
        const aisle_vec2 a = aisle_vec2_scale(aisle_vec2_sub(shape->v[i], corner), 1.0 / lattice->res);
        const aisle_vec2 v = shape->v[i + 1U < shape->n ? i + 1U : 0U];
        const aisle_vec2 b = aisle_vec2_scale(aisle_vec2_sub(v, corner), 1.0 / lattice->res);
        sides[i] = side_between(a, b, radius);
        take_in(&all, a.y - radius, a.y + radius);
    }
    uint32_t row;
    uint32_t row_end;
    touched(all.lo, all.hi, lattice->h, &row, &row_end);
    for (; row < row_end; row++) {
        const span y = {(double)row - AISLE_GRID_SLACK, (double)row + 1.0 + AISLE_GRID_SLACK};
        span x = {DBL_MAX, -DBL_MAX};
        for (uint32_t i = 0; i < shape->n; i++) {
            take_in_side(&sides[i], radius, y, &x);
        }
        uint32_t first;
        uint32_t end;
        touched(x.lo, x.hi, lattice->w, &first, &end);
        aisle_grid_mark_run(self, row, first, end);
    }
}

// ---- distance field

static void lower_by_neighbours(uint16_t *restrict row, const uint16_t *restrict neighbours, uint32_t w) {
    for (uint32_t x = 0; x < w; x++) { // no branch, so that it becomes vector code
        const uint16_t by = (uint16_t)(neighbours[x] + 1U);
        row[x] = by < row[x] ? by : row[x];
    }
}

static void lower_to_one(uint16_t *row, uint32_t w) { // beside the outside, which is occupied
    for (uint32_t x = 0; x < w; x++) {
        row[x] = row[x] < 1U ? row[x] : 1U;
    }
}

static void sweep_row(aisle_grid *self, uint32_t row) {
    const uint32_t w = self->lattice.w;
    const uint32_t last = self->lattice.h - 1U;
    const bool down = self->phase == PHASE_DOWN;
    const uint32_t y = down ? row : last - row;
    uint16_t *cells = &self->field[y * w];
    if (row == 0) {
        lower_to_one(cells, w);
    } else {
        lower_by_neighbours(cells, down ? cells - w : cells + w, w);
    }
}

// A row's parabolas that still matter: p[0..n), by rising `from` and `at`.
typedef struct envelope {
    aisle_parabola *p;
    uint32_t n;
} envelope;

// First column where the parabola at `at` lies below q (never before at - REACH, where it is saturated anyway).
// With d = at - q->at: floor((d^2 + sq - q->sq) / 2d) + 1 from q->at, written from at - REACH so that nothing is
// negative. For d > 2 REACH no column is in reach of both.
static int32_t overtakes(const aisle_parabola *q, int32_t at, int32_t sq) {
    const int32_t d = at - q->at;
    if (d > 2 * REACH) {
        return at - REACH;
    }
    const int32_t above = d * (2 * REACH - d) + sq - q->sq;
    return above < 0 ? at - REACH : at - REACH + (int32_t)((uint32_t)above / (uint32_t)(2 * d)) + 1;
}

static void envelope_add(envelope *e, int32_t at, int32_t sq) {
    int32_t from = at - REACH;
    while (e->n > 0) {
        from = overtakes(&e->p[e->n - 1U], at, sq);
        if (from > e->p[e->n - 1U].from) {
            break;
        }
        e->n--;
        from = at - REACH;
    }
    if (from <= at + REACH) {
        AISLE_ASSERT(e->n < AISLE_GRID_WINDOW);
        e->p[e->n] = (aisle_parabola){from, at, sq};
        e->n++;
    }
}

static uint16_t parabola_at(const aisle_parabola *p, int32_t x) {
    const int32_t d = x > p->at ? x - p->at : p->at - x;
    const int32_t sq = d > REACH ? (int32_t)AISLE_FIELD_SQ_MAX : d * d + p->sq;
    return (uint16_t)(sq < (int32_t)AISLE_FIELD_SQ_MAX ? sq : (int32_t)AISLE_FIELD_SQ_MAX);
}

// Writes columns [x, end) and drops the parabolas that end before `end`.
static void envelope_emit(envelope *e, uint16_t *row, int32_t x, int32_t end) {
    AISLE_ASSERT(e->n > 0);
    uint32_t at = 0;
    for (; x < end; at++) {
        const int32_t next = at + 1U < e->n ? e->p[at + 1U].from : INT32_MAX;
        const int32_t stop = next < end ? next : end;
        for (; x < stop; x++) {
            row[x] = parabola_at(&e->p[at], x);
        }
        if (next > end) {
            break;
        }
    }
    e->n -= at;
    memmove(e->p, &e->p[at], e->n * sizeof *e->p);
}

// Exact below saturation and saturated above, though column distances stop at 256 and parabolas at REACH columns: a
// column whose nearest occupied cell is 256 or more away, or that is 256 or more columns off, is at 256^2 = 65536 or
// more, so leaving it out changes no value up to 65535; where nothing else is nearer the result must saturate, and
// does. In place: a column is written when every column up to REACH further on has been read. Window: parabolas lie in
// rising `at` with `from` within REACH of it, so between emissions at most 1 + 2 REACH + 1 + CHUNK of them matter.
static void transform_row(aisle_grid *self, uint32_t y) {
    const int32_t w = (int32_t)self->lattice.w;
    uint16_t *row = &self->field[y * self->lattice.w];
    envelope e = {self->scratch, 0};
    int32_t written = 0;
    envelope_add(&e, -1, 0);
    for (int32_t x = 0; x < w;) {
        const int32_t stop = w - x < CHUNK ? w : x + CHUNK;
        for (; x < stop; x++) {
            if (row[x] < COLUMN_MAX) {
                envelope_add(&e, x, row[x] * row[x]);
            }
        }
        if (x < w && x - REACH > written) {
            envelope_emit(&e, row, written, x - REACH);
            written = x - REACH;
        }
    }
    envelope_add(&e, w, 0);
    envelope_emit(&e, row, written, w);
}

aisle_status aisle_grid_build(aisle_grid *self, uint32_t rows) {
    while (rows > 0 && self->phase != PHASE_DONE) {
        if (self->phase == PHASE_ROWS) {
            transform_row(self, self->next_row);
        } else {
            sweep_row(self, self->next_row);
        }
        rows--;
        self->next_row++;
        if (self->next_row == self->lattice.h) {
            self->next_row = 0;
            self->phase++;
        }
    }
    return self->phase == PHASE_DONE ? AISLE_OK : AISLE_BUSY;
}

// ---- bounds

// Distance between cell centres, m, and how much a point and an obstacle may each be off theirs. Not inside: *q is 0.
static double centre_gap(const aisle_grid *self, aisle_vec2 p, bool *inside, uint32_t *q, double *off) {
    AISLE_ASSERT(self->phase == PHASE_DONE);
    const uint32_t cell = aisle_lattice_cell(&self->lattice, p, inside);
    *q = *inside ? self->field[cell] : 0U;
    const double res = self->lattice.res;
    *off =
        aisle_vec2_distance(p, aisle_lattice_centre(&self->lattice, cell)) + (HALF_DIAGONAL + AISLE_GRID_SLACK) * res;
    return sqrt((double)*q) * res;
}

double aisle_grid_gap_lower(const aisle_grid *self, aisle_vec2 p) {
    bool inside;
    uint32_t q;
    double off;
    const double gap = centre_gap(self, p, &inside, &q, &off);
    return inside ? gap - off : 0.0;
}

double aisle_grid_gap_upper(const aisle_grid *self, aisle_vec2 p) {
    bool inside;
    uint32_t q;
    double off;
    const double gap = centre_gap(self, p, &inside, &q, &off);
    if (!inside) {
        return 0.0;
    }
    return q == AISLE_FIELD_SQ_MAX ? (double)INFINITY : gap + off;
}
