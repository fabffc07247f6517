// shape.h - rounded convex shapes: the hull of points, grown by a radius. Level 1.
//
// A disc is one point and a radius, a capsule two points, a footprint its polygon (radius 0 or more).
// Metres. All functions are exact up to rounding (errors stated), O(vertices) or O(n * m).
#ifndef AISLE_WORLD_SHAPE_H
#define AISLE_WORLD_SHAPE_H

#include "base/vec.h"

#include <stdbool.h>
#include <stdint.h>

#define AISLE_SHAPE_VERTICES_MAX 16
#define AISLE_SHAPE_COORD_MAX 1e5 // m; beyond it nothing is accepted

// A view: the vertices belong to somebody else. Convex, counter-clockwise, n in [1, 32]; collinear and
// repeated vertices are allowed.
typedef struct aisle_convex {
    const aisle_vec2 *v;
    uint32_t n;
    double radius; // >= 0
} aisle_convex;

// True if finite, within AISLE_SHAPE_COORD_MAX, n in [3, max_n], max_n <= 32, counter-clockwise convex, wound once,
// with an area above 1e-8 m2. Tolerates collinear and repeated vertices, and dents: accepts what moving every vertex by
// AISLE_SHAPE_DENT could make convex, refuses vertices that stand 4 times as far inside. O(n2).
#define AISLE_SHAPE_DENT 1e-9 // m
bool aisle_convex_is_valid(const aisle_vec2 *v, uint32_t n, uint32_t max_n);

// Box around the shape, radius included.
aisle_aabb aisle_convex_aabb(const aisle_convex *shape);

// Gap between a point and the shape (0 inside or touching). Error below 1e-12 m per 1000 m of extent, and below 32
// dents where the shape has dents. O(n).
double aisle_convex_point_gap(const aisle_convex *shape, aisle_vec2 p);

// Gap between two shapes (0 if they touch or overlap), same error. The plain hulls are apart if an edge of one of them
// separates them; then vertex to edge is the shortest way (Ericson 2005, "Real-Time Collision Detection", ch. 5). O(n *
// m).
double aisle_convex_gap(const aisle_convex *a, const aisle_convex *b);

// Gap between two boxes (0 if they touch): a lower bound for what is inside them. O(1).
double aisle_aabb_gap(aisle_aabb a, aisle_aabb b);

// Does the straight way from a to b meet the box? O(1).
bool aisle_aabb_meets(aisle_aabb box, aisle_vec2 a, aisle_vec2 b);

// Gap between two plain segments; either may be a single point.
double aisle_segment_gap(aisle_vec2 a0, aisle_vec2 a1, aisle_vec2 b0, aisle_vec2 b1);

// Writes the points of `shape` (body frame) placed at pose to out[n]; out may be v.
void aisle_convex_place(const aisle_vec2 *v, uint32_t n, aisle_pose2 pose, aisle_vec2 *out);

// Convex hull (counter-clockwise from the least x, then y; no collinear points, no repeated ones) of n in [1, 64]
// finite points into out[n], which may be points; returns its size: 1 for a single place, 2 for a line. Andrew's
// monotone chain (1979, doi:10.1016/0020-0190(79)90072-3). O(n log n), 2 KiB of stack, no recursion.
#define AISLE_HULL_POINTS_MAX 64U
uint32_t aisle_convex_hull(const aisle_vec2 *points, uint32_t n, aisle_vec2 *out);
#endif
