// grid.h - the planning grid: lattice, conservative occupancy, exact distance field. Level 1.
//
// Lattice: cell (ix, iy) is the square [x0 + ix res, x0 + (ix+1) res] x [y0 + iy res, ...]; index iy * w + ix.
// Occupancy is conservative: a cell is occupied if its closed square touches an obstacle, and everything outside the
// lattice is occupied. Distance field: squared Euclidean distance, in cells, between the centre of a
// cell and that of the nearest occupied cell, exact, saturating at AISLE_FIELD_SQ_MAX.
// What it says of a point p in a cell with field value q (c the cell's centre, res the cell size):
//     sqrt(q) res - |p - c| - res/sqrt(2)  <=  distance from p to the nearest obstacle
//     distance from p to the nearest obstacle  <=  sqrt(q) res + |p - c| + res/sqrt(2)   (if not saturated)
// both with AISLE_GRID_SLACK cells to spare.
// Method: two passes (columns, then rows), Meijster, Roerdink & Hesselink 2000, "A general algorithm for
// computing distance transforms in linear time", integers only. Ours: saturation, so that a parabola matters for 255
// columns to either side only: 32 bits do, and the scratch is one window whatever the width (grid_field.h).
// Memory: 2 bytes a cell and 12 KiB. Time: O(cells), in slices of rows.
#ifndef AISLE_WORLD_GRID_H
#define AISLE_WORLD_GRID_H

#include "aisle/status.h"
#include "base/arena.h"
#include "base/vec.h"
#include "world/shape.h"

#include <stdbool.h>
#include <stdint.h>

#define AISLE_FIELD_SQ_MAX 65535U
#define AISLE_GRID_SIDE_MAX 65535U // cells along one side
#define AISLE_GRID_SLACK 1e-6      // cells; marking may take in cells this near to a shape, never miss one that touches

typedef struct aisle_lattice {
    double x0, y0; // m, lower left corner of cell (0, 0)
    double res;    // m a cell
    uint32_t w, h; // cells
} aisle_lattice;

typedef struct aisle_cells { // [x0, x1) by [y0, y1)
    int32_t x0, y0, x1, y1;
} aisle_cells;

typedef struct aisle_parabola { // of the row pass: column `at` is the nearest one from column `from` on
    int32_t from, at, sq;       // sq: squared distance, in the column, to its nearest occupied cell
} aisle_parabola;

typedef struct aisle_grid {
    aisle_lattice lattice;
    uint16_t *field;         // [capacity] squared distance in cells; while building: marks, column distances
    aisle_parabola *scratch; // [AISLE_GRID_WINDOW] one row's parabolas that still matter
    uint32_t capacity;       // cells
    uint32_t next_row;       // build progress
    uint8_t phase;           // of the build
} aisle_grid;

#define AISLE_GRID_WINDOW 1024U

// Lattice over [lo, hi], which is finite with lo < hi, at `res` > 0; sides that are a multiple of res up to
// AISLE_GRID_SLACK cells stay that number, others are rounded up.
// False if a side exceeds AISLE_GRID_SIDE_MAX or the product exceeds UINT32_MAX, with w and h the sides needed, each at
// most UINT32_MAX; false with w = h = 0 if the arguments break the rules above.
bool aisle_lattice_over(aisle_vec2 lo, aisle_vec2 hi, double res, aisle_lattice *out);

// Cell that holds p: floor, clamped into the lattice; *inside (may be NULL) says whether p was in without clamping
// (the upper and right border count as in). NaN: not inside.
uint32_t aisle_lattice_cell(const aisle_lattice *lattice, aisle_vec2 p, bool *inside);
aisle_vec2 aisle_lattice_centre(const aisle_lattice *lattice, uint32_t cell);

aisle_cells aisle_lattice_cells(const aisle_lattice *lattice); // all of them

void aisle_grid_carve(aisle_grid *self, aisle_arena *arena, uint32_t cells);

// Starts a build: every cell free. AISLE_ERR_CAPACITY: w * h > capacity. AISLE_ERR_ARG: w or h 0 or above
// AISLE_GRID_SIDE_MAX, res not above 0. O(w * h), about 0.2 ns a cell.
aisle_status aisle_grid_begin(aisle_grid *self, const aisle_lattice *lattice);

// Between begin and the first build step. Marks every cell whose closed square the closed rounded shape touches, and at
// most those within 2 AISLE_GRID_SLACK cells of it: that is what the arithmetic needs for coordinates within
// AISLE_SHAPE_COORD_MAX and dents of a valid shape. O(rows * vertices + cells); what lies outside is clipped.
void aisle_grid_mark_convex(aisle_grid *self, const aisle_convex *shape);
// At any time: zeros in the field of those of these cells that lie in `in`, which lies in the lattice. O(rows * vertices).
void aisle_grid_mark_convex_in(aisle_grid *self, const aisle_convex *shape, aisle_cells in);
void aisle_grid_mark_cell(aisle_grid *self, uint32_t cell);
// Cells [ix0, end) of row iy; end is clipped to the row.
void aisle_grid_mark_run(aisle_grid *self, uint32_t iy, uint32_t ix0, uint32_t end);

// Turns marks into the distance field, `rows` rows at a time (three sweeps over all rows count). AISLE_BUSY, then
// AISLE_OK; further calls repeat AISLE_OK. The field is the same however the build was cut into steps.
aisle_status aisle_grid_build(aisle_grid *self, uint32_t rows);

uint32_t aisle_grid_rows_done(const aisle_grid *self); // by build() since begin

// After the build. Lower and upper bounds on the distance from p to the nearest obstacle, m; p
// outside: 0. The lower one may be negative: read as "not known to be free". A saturated cell gives
// the saturation distance as lower bound and INFINITY as upper bound.
double aisle_grid_gap_lower(const aisle_grid *self, aisle_vec2 p);
double aisle_grid_gap_upper(const aisle_grid *self, aisle_vec2 p);
static inline bool aisle_grid_is_occupied(const aisle_grid *self, uint32_t cell) {
    return self->field[cell] == 0;
}
#endif
