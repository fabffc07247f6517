// grid_raster.h - which cells of a lattice a rounded convex shape touches, row by row. Level 1; part of grid.
//
// The outline of a rounded convex shape is its moved edges and the arcs of its corner discs, and the shape's part in a
// row of cells reaches left and right as far as the outline's part in it does. Slack as aisle_grid_mark_convex() says.
// Memory: the caller's. Time: O(vertices) to begin, O(vertices) a row.
#ifndef AISLE_WORLD_GRID_RASTER_H
#define AISLE_WORLD_GRID_RASTER_H

#include "world/grid.h"

#define AISLE_RASTER_SIDES_MAX 32U

typedef struct aisle_span {
    double lo, hi;
} aisle_span;

// A side of the rounded shape: an edge moved outwards by the radius, in cells from the lattice's corner.
typedef struct aisle_raster_side {
    aisle_vec2 corner; // the first end of the edge itself
    aisle_vec2 from;   // and of the moved one
    aisle_span x, y;   // box around the moved edge
    double x_per_y;
    bool is_level; // so flat that crossings are not worth computing
} aisle_raster_side;

typedef struct aisle_raster {
    aisle_raster_side sides[AISLE_RASTER_SIDES_MAX];
    uint32_t n, w;
    double radius;
    uint32_t first_row, end_row; // rows it touches, clipped to the lattice
} aisle_raster;

// shape: 1 to 32 points.
void aisle_raster_of(aisle_raster *self, const aisle_lattice *lattice, const aisle_convex *shape);
// Cells [*first, *end) of a row, clipped to the lattice.
void aisle_raster_row(const aisle_raster *self, uint32_t row, uint32_t *first, uint32_t *end);
#endif
