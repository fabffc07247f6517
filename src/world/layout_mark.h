// layout_mark.h - what a layout occupies of its grid: the one place that says so. Level 1; part of layout.
//
// Zeros go into the field of the active store's cells that are occupied, within a rectangle of the lattice's cells:
// polygons of kind OBSTACLE and KEEPOUT, scanned cells, cells the bounds cut. A whole build marks by these in a grid
// that was cleared, an update in the cells it freed; so both agree. Memory: none but the grid.
#ifndef AISLE_WORLD_LAYOUT_MARK_H
#define AISLE_WORLD_LAYOUT_MARK_H

#include "world/layout.h"

// Nothing if the zone is no obstacle. O(rows * vertices).
void aisle_layout_mark_zone(aisle_layout *self, const aisle_zone *zone, aisle_cells in);
// Nothing without a scan. O(runs).
void aisle_layout_mark_scan(aisle_layout *self, aisle_cells in);
// O(rows).
void aisle_layout_mark_border(aisle_layout *self, aisle_cells in);
// All three; the zones by the index. O(rows * vertices) for each zone that overlaps.
void aisle_layout_mark_all(aisle_layout *self, aisle_cells in);
#endif
