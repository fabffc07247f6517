// grid.h - the planning grid: lattice, conservative occupancy, exact distance field. Level 1.
//
// Lattice: cell (ix, iy) is the square [x0 + ix res, x0 + (ix+1) res] x [y0 + iy res, ...]; index iy * w + ix.
// Occupancy is conservative: a cell is occupied if its closed square touches an obstacle, and everything outside the
// lattice is occupied. Distance field: squared Euclidean distance, in cells, between the centre of a
// cell and that of the nearest occupied cell, exact, saturating at AISLE_FIELD_SQ_MAX.
// What it says of a point p in a cell with field value q (c the cell's centre, res the cell size):
//     sqrt(q) res - |p - c| - res/sqrt(2)  <=  distance from p to the nearest obstacle
//     distance from p to the nearest obstacle  <=  sqrt(q) res + |p - c| + res/sqrt(2)   (if not saturated)
// Method: two passes (columns, then rows), Meijster, Roerdink & Hesselink 2000, "A general algorithm for
// computing distance transforms in linear time", integers only. Ours: saturation, so that a row's
// parabolas never need more than 32 bits. Memory: 2 bytes a cell. Time: O(cells), in slices of rows.
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

typedef struct aisle_lattice {
    double x0, y0; // m, lower left corner of cell (0, 0)
    double res;    // m a cell
    uint32_t w, h; // cells
} aisle_lattice;

typedef struct aisle_grid {
    aisle_lattice lattice;
    uint16_t *field;    // [capacity] squared distance in cells; while building: occupancy, column distances
    uint32_t *scratch;  // [4 * AISLE_GRID_SIDE_MAX] one row's parabolas
    uint32_t capacity;  // cells
    uint32_t next_row;  // build progress
    uint8_t phase;      // of the build
} aisle_grid;

// Lattice over [lo, hi] at `res`; sides that are a multiple of res up to 1e-6 cells stay that number.
// False if a side exceeds AISLE_GRID_SIDE_MAX or the product exceeds UINT32_MAX, with w and h saturated.
bool aisle_lattice_over(aisle_vec2 lo, aisle_vec2 hi, double res, aisle_lattice *out);

// Cell that holds p: floor, clamped into the lattice; *inside says whether it had to be clamped.
uint32_t aisle_lattice_cell(const aisle_lattice *lattice, aisle_vec2 p, bool *inside);
aisle_vec2 aisle_lattice_centre(const aisle_lattice *lattice, uint32_t cell);

void aisle_grid_carve(aisle_grid *self, aisle_arena *arena, uint32_t cells);

// Starts a build: every cell free. AISLE_ERR_CAPACITY: w * h > capacity. O(w * h).
aisle_status aisle_grid_begin(aisle_grid *self, const aisle_lattice *lattice);

// Between begin and the first build step. Marks what the closed shape touches. O(rows + cells touched);
// a shape partly or wholly outside is clipped.
void aisle_grid_mark_convex(aisle_grid *self, const aisle_convex *shape);
void aisle_grid_mark_cell(aisle_grid *self, uint32_t cell);

// Turns marks into the distance field, about `rows` rows at a time (both passes count). AISLE_BUSY, then AISLE_OK.
aisle_status aisle_grid_build(aisle_grid *self, uint32_t rows);

// After the build. Lower and upper bounds on the distance from p to the nearest obstacle, m; p
// outside: 0. The lower one may be negative: read as "not known to be free". A saturated cell gives
// the saturation distance as lower bound and INFINITY as upper bound.
double aisle_grid_gap_lower(const aisle_grid *self, aisle_vec2 p);
double aisle_grid_gap_upper(const aisle_grid *self, aisle_vec2 p);
static inline bool aisle_grid_is_occupied(const aisle_grid *self, uint32_t cell) { return self->field[cell] == 0; }
#endif
