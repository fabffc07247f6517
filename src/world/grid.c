#include "world/grid.h"

#include "base/check.h"
#include "world/grid_field.h"
#include "world/grid_raster.h"

#include <float.h>
#include <string.h>

enum { PHASE_DOWN, PHASE_UP, PHASE_ROWS, PHASE_DONE };

#define HALF_DIAGONAL 0.70710678118654752440 // of a cell, in cells

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

typedef struct spot { // a cell by column and row
    uint32_t ix, iy;
} spot;

static spot spot_of(const aisle_lattice *lattice, aisle_vec2 p, bool *inside) {
    *inside = true;
    return (spot){clamp_index((p.x - lattice->x0) / lattice->res, lattice->w, inside),
                  clamp_index((p.y - lattice->y0) / lattice->res, lattice->h, inside)};
}

static aisle_vec2 centre_of(const aisle_lattice *lattice, spot at) {
    return aisle_vec2_of(lattice->x0 + ((double)at.ix + 0.5) * lattice->res,
                         lattice->y0 + ((double)at.iy + 0.5) * lattice->res);
}

uint32_t aisle_lattice_cell(const aisle_lattice *lattice, aisle_vec2 p, bool *inside) {
    bool in;
    const spot at = spot_of(lattice, p, &in);
    if (inside != NULL) {
        *inside = in;
    }
    return at.iy * lattice->w + at.ix;
}

aisle_vec2 aisle_lattice_centre(const aisle_lattice *lattice, uint32_t cell) {
    return centre_of(lattice, (spot){cell % lattice->w, cell / lattice->w});
}

aisle_cells aisle_lattice_cells(const aisle_lattice *lattice) {
    return (aisle_cells){0, 0, (int32_t)lattice->w, (int32_t)lattice->h};
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
        self->field[i] = AISLE_FIELD_COLUMN_MAX;
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

static uint32_t most(uint32_t a, uint32_t b) {
    return a > b ? a : b;
}
static uint32_t least(uint32_t a, uint32_t b) {
    return a < b ? a : b;
}

void aisle_grid_mark_convex_in(aisle_grid *self, const aisle_convex *shape, aisle_cells in) {
    aisle_raster raster;
    aisle_raster_of(&raster, &self->lattice, shape);
    const uint32_t end_row = least(raster.end_row, (uint32_t)in.y1);
    for (uint32_t row = most(raster.first_row, (uint32_t)in.y0); row < end_row; row++) {
        uint32_t first;
        uint32_t end;
        aisle_raster_row(&raster, row, &first, &end);
        aisle_grid_mark_run(self, row, most(first, (uint32_t)in.x0), least(end, (uint32_t)in.x1));
    }
}

void aisle_grid_mark_convex(aisle_grid *self, const aisle_convex *shape) {
    AISLE_ASSERT(self->phase == PHASE_DOWN && self->next_row == 0);
    aisle_grid_mark_convex_in(self, shape, aisle_lattice_cells(&self->lattice));
}

// ---- distance field

static void sweep_row(aisle_grid *self, uint32_t row) {
    const uint32_t w = self->lattice.w;
    const uint32_t last = self->lattice.h - 1U;
    const bool down = self->phase == PHASE_DOWN;
    const uint32_t y = down ? row : last - row;
    uint16_t *cells = &self->field[y * w];
    if (row == 0) {
        aisle_field_lower_to_one(cells, w);
    } else {
        aisle_field_lower(cells, down ? cells - w : cells + w, w);
    }
}

static void transform_row(aisle_grid *self, uint32_t y) {
    static const uint16_t outside[1] = {0}; // occupied
    const aisle_field_beside beside = {outside, 1};
    uint16_t *row = &self->field[y * self->lattice.w];
    aisle_field_transform(self->scratch, row, (int32_t)self->lattice.w, beside, beside);
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

uint32_t aisle_grid_rows_done(const aisle_grid *self) {
    return self->phase * self->lattice.h + self->next_row;
}

// ---- bounds

// Distance between cell centres, m, and how much a point and an obstacle may each be off theirs. Not inside: *q is 0.
static double centre_gap(const aisle_grid *self, aisle_vec2 p, bool *inside, uint32_t *q, double *off) {
    AISLE_ASSERT(self->phase == PHASE_DONE);
    const aisle_lattice *lattice = &self->lattice;
    const double res = lattice->res;
    const spot at = spot_of(lattice, p, inside);
    *q = *inside ? self->field[at.iy * lattice->w + at.ix] : 0U;
    *off = aisle_vec2_distance(p, centre_of(lattice, at)) + (HALF_DIAGONAL + AISLE_GRID_SLACK) * res;
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
