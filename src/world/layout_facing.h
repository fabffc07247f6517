// layout_facing.h - which two obstacles form a gap, and how wide it is exactly. Level 1; part of layout.
//
// Pieces are convex: a polygon, the part of one row's run of occupied scan cells near a place, a side of the bounds.
// The narrowest place of a passage between convex pieces A and B lies on the shortest segment between them, and that
// segment's ends are the points of A and B nearest to its middle (were there a shorter one, the slab between the two
// lines across its ends would not be free of A and B).
// Memory: none. Time: O(zones and scan rows within cap), a pair O(vertices^2).
#ifndef AISLE_WORLD_LAYOUT_FACING_H
#define AISLE_WORLD_LAYOUT_FACING_H

#include "world/layout.h"

#define AISLE_FACING_COSINE 0.3 // a piece lies on a side of p if its nearest point does, to 72 degrees

typedef struct aisle_piece {
    aisle_vec2 v[AISLE_SHAPE_VERTICES_MAX];
    uint32_t n;
    int32_t id;         // a polygon's or AISLE_LAYOUT_ID_*
    aisle_vec2 nearest; // its point nearest to p
    double gap;         // m, from p to it
} aisle_piece;

// The piece nearest to p (within the bounds) of those within cap (m) whose nearest point lies on the given side of p (a
// unit vector; (0, 0): any side). False: none. Equal gaps: the least id.
bool aisle_layout_piece_near(const aisle_layout *self, aisle_vec2 p, double cap, aisle_vec2 side, aisle_piece *out);

// Gap between two pieces (exact, 0 if they touch) and the points that are so near; of several such pairs (parallel
// sides) the one nearest to p.
double aisle_piece_gap(const aisle_piece *a, const aisle_piece *b, aisle_vec2 p, aisle_vec2 *on_a, aisle_vec2 *on_b);
#endif
