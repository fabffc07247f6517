// grid_window.h - the distance field after some cells became occupied or free, without building it all. Level 1; part of
// grid.
//
// The field is exact; then all cells that change within one piece of it are marked or freed; the window makes it exact
// again. Pieces one after another: each stands on the field the one before left.
// Which cells can change: c does if its nearest occupied cell is among those that left, or one that came is nearer. The
// window is the least rectangle around the changed cells, grown side by side, such that no cell c' of the frame around
// it (one cell wide) is within
//     distance(c', changed cells) <= distance by the field(c') + 1.
// Then no cell beyond changes: let c outside change by the changed cell s. The segment from c to s meets the frame in a
// point p, at most half a cell from a frame cell c'. No other occupied cell t is nearer to p than s, since |p - t| >=
// |c - t| - |c - p| >= |c - s| - |c - p| = |p - s|. So distance by the field(c') >= |p - s| - 1/2 and |c' - s| <= |p - s|
// + 1/2: c' is within. The distance to the rectangle of the changed cells stands for that to the cells: no greater.
// Nothing further than 255 cells changes, as the field saturates.
// What is outside is exact, so it tells how far outside the window what matters inside can lie. Let b be the frame's cell
// in the row of a cell c of the window and s an occupied cell further out than b by more columns than b's distance is:
// then |c - s| >= |c - b| + (columns from b to s) > |c - b| + distance(b) >= distance(c), so s is not nearest to c. The
// same holds of rows. Inside, the transform of the whole build runs (grid_field.h): the field is the same bit for bit.
// Column distances beside are counted row by row; those to what is below need a sweep from below first, of which every
// 32nd row is kept.
// Where cells became occupied only, the field is lowered to the distances from these: one sweep, and nothing beside
// matters.
// Memory: 79 KiB. Time: O(cells of the window and of the columns beside that matter) for a piece.
#ifndef AISLE_WORLD_GRID_WINDOW_H
#define AISLE_WORLD_GRID_WINDOW_H

#include "world/grid.h"

#define AISLE_WINDOW_PIECE 512U // cells along a side of a piece, at most
#define AISLE_WINDOW_SIDE (AISLE_WINDOW_PIECE + 2U * 255U)
#define AISLE_WINDOW_FREED 3U // in the field of a cell that became free; no squared distance between cells

typedef struct aisle_window_column { // of the changed cells, at the row in hand
    int32_t above, below;            // rows of the nearest occupied ones at or above it and at or below it, or far off
} aisle_window_column;

typedef struct aisle_grid_window {
    aisle_cells box, changed;
    uint32_t left, right;         // columns beside that matter; one may be the outside
    int32_t rows0, rows1;         // rows [rows0, rows1) hold all that matters
    aisle_window_column *nearest; // [AISLE_WINDOW_PIECE]
    uint16_t *above, *below;      // [AISLE_WINDOW_SIDE + 512] column distances, from the first column beside on
    uint16_t *saved;              // [33 blocks of rows][512] of columns beside, to what is below the block
    uint16_t *ahead;              // [32 rows of a block][512] the same in each row of the block in hand
    int32_t next_row;
    uint8_t phase;
} aisle_grid_window;

void aisle_grid_window_carve(aisle_grid_window *self, aisle_arena *arena);

// The window for the cells that changed, all within `changed`, at most AISLE_WINDOW_PIECE a side and not empty: the
// grid is built but that these hold 0 or AISLE_WINDOW_FREED already; has_freed: some of them the latter. The grid is not
// written. O(cells of the window).
void aisle_grid_window_find(aisle_grid_window *self, const aisle_grid *grid, aisle_cells changed, bool has_freed);
// Rows of work step() will do.
uint32_t aisle_grid_window_rows(const aisle_grid_window *self);
// Cells along a row that matter to the window's part of it, the window's own among them.
uint32_t aisle_grid_window_width(const aisle_grid_window *self);

// After find(); at most *rows rows of work, takes off what was done. AISLE_BUSY,
// then AISLE_OK. The grid is not exact between.
aisle_status aisle_grid_window_step(aisle_grid_window *self, aisle_grid *grid, uint32_t *rows);
#endif
