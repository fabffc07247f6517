// layout_content.h - what a layout says as one number, whatever its revision and the order it came in. Level 1; part of
// layout.
//
// A zone is hashed word by word through SplitMix64's finaliser (Steele, Lea, Flood 2014, "Fast splittable pseudorandom
// number generators"); zones and runs of scanned cells are summed modulo 2^64, so that the order leaves no trace and
// one that leaves is taken off again. Not meant against forgery: equal numbers are equal layouts but for chance.
// Memory: none. Time: O(vertices) a zone, O(1) a run.
#ifndef AISLE_WORLD_LAYOUT_CONTENT_H
#define AISLE_WORLD_LAYOUT_CONTENT_H

#include "world/grid.h"

// Of a polygon, bit for bit: id, kind, value, direction, vertices.
uint64_t aisle_content_of_polygon(int32_t id, int8_t kind, float value, float direction, const aisle_vec2 *v,
                                  uint32_t n);
// Of occupied cells [x0, end) of row iy.
uint64_t aisle_content_of_run(uint32_t iy, uint32_t x0, uint32_t end);
// Of the area, the cells it is cut into and whether they are a scan's.
uint64_t aisle_content_of_area(aisle_aabb bounds, const aisle_lattice *lattice, bool has_scan);
#endif
