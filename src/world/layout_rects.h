// layout_rects.h - the scanned cells as rectangles: few convex blocks instead of many cells. Level 1; part of layout.
//
// Runs of occupied cells of one row, joined with the row below where the run there is the same. Together they cover
// exactly the occupied cells; they do not overlap. A corner is real where the occupied ground is convex: both cells
// beside it, across the rectangle's sides, are free. Only real corners can turn a shortest way.
// Memory: 9 bytes a rectangle, 2 a column. Time: O(rows + runs).
#ifndef AISLE_WORLD_LAYOUT_RECTS_H
#define AISLE_WORLD_LAYOUT_RECTS_H

#include "base/arena.h"
#include "world/layout_store.h"

#define AISLE_LAYOUT_RECTS_MAX 16384U

typedef struct aisle_layout_rect { // cells [x0, x1) by [y0, y1)
    uint16_t x0, y0, x1, y1;
} aisle_layout_rect;

typedef struct aisle_layout_rects {
    aisle_layout_rect *rect; // [capacity]
    uint8_t *real;           // [capacity] bit i: corner i is real; from (x0, y0) counter-clockwise
    uint16_t *open;          // [columns] the rectangle that began in this column, in the row before
    uint32_t count, capacity;
    bool overflow; // there are more: the list is worth nothing
} aisle_layout_rects;

// cells: of the scan at most; capacity cells / 64 up to AISLE_LAYOUT_RECTS_MAX.
void aisle_layout_rects_carve(aisle_layout_rects *self, aisle_arena *arena, uint32_t cells);

void aisle_layout_rects_clear(aisle_layout_rects *self);
// Rows in rising order, each once.
void aisle_layout_rects_add_row(aisle_layout_rects *self, const aisle_layout_store *store, uint32_t iy);
// After the last row.
void aisle_layout_rects_find_corners(aisle_layout_rects *self, const aisle_layout_store *store);
#endif
