// grid_field.h - the distance transform, a row at a time: what the whole build and the window have in common. Level 1;
// part of grid.
//
// Two passes after Meijster et al. 2000 (grid.h). First column distances, by lowering every row by its neighbour's
// plus one, from both ends; then along each row the lower envelope of the parabolas (x - column)^2 + distance^2.
// Exact below saturation and saturated above, though column distances stop at 256 and parabolas at 255 columns: a
// column whose nearest occupied cell is 256 or more away, or that is 256 or more columns off, is at 256^2 = 65536 or
// more, so leaving it out changes no value up to 65535; where nothing else is nearer the result must saturate, and does.
// Memory: the caller's. Time: O(cells).
#ifndef AISLE_WORLD_GRID_FIELD_H
#define AISLE_WORLD_GRID_FIELD_H

#include "world/grid.h"

#define AISLE_FIELD_COLUMN_MAX 256U // column distances saturate here: 256^2 > AISLE_FIELD_SQ_MAX
#define AISLE_FIELD_REACH 255       // columns a parabola matters to either side: 256^2 > AISLE_FIELD_SQ_MAX

// row[x] = min(row[x], neighbours[x] + 1) and min(row[x], 1); column distances up to AISLE_FIELD_COLUMN_MAX.
void aisle_field_lower(uint16_t *restrict row, const uint16_t *restrict neighbours, uint32_t w);
void aisle_field_lower_to_one(uint16_t *row, uint32_t w); // beside the outside, which is occupied

// Column distances of the n columns beside a row, from left to right; n at most AISLE_FIELD_REACH + 1.
typedef struct aisle_field_beside {
    const uint16_t *at;
    uint32_t n;
} aisle_field_beside;

// Column distances in row[0, w) become squared distances, in place. What lies further than the columns beside is taken
// as free. scratch: AISLE_GRID_WINDOW.
void aisle_field_transform(aisle_parabola *scratch, uint16_t *row, int32_t w, aisle_field_beside left,
                           aisle_field_beside right);
#endif
