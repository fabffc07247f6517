// tangent.h - the exact shortest way of a disc through a layout: a lazy tangent graph. Level 4.
//
// The shortest way of a disc of radius R is a chain of straight lines and of arcs of radius R about corners of
// obstacles, each line tangent to the arcs at its ends (Chew 1985, doi:10.1145/323233.323261; Liu & Arimoto 1992,
// doi:10.1177/027836499201100404). A corner is passed with the obstacle on the left (side +1) or on the right (-1); a
// line from circle v to circle w with signed radii a, b (positive: centre on the left) has direction
//     d = (l u + (a - b) n) / L,   u = (w - v) / L,  n = u turned left,  L = |w - v|,  l = sqrt(L^2 - (a - b)^2),
// and can be part of a shortest way only if d lies between the directions of both edges at v, and at w.
// Search: A* over the directed lines (node: arrival at a corner with a direction), h the straight distance to the goal.
// Ours: nothing is built before the query. A node's lines are made when it is expanded, obstacles nearest first (rings
// of the layout's wide index), and a line is pushed untested: it is tested for contact, with the arc before it, when it
// comes up. An obstacle seen from a node hides an interval of directions beyond its farther tangent point; hidden
// lines are not pushed, and the rings end where every direction is hidden (256 bins).
// Exact: touching counts as free, to 1e-9 m. So the first line to reach the goal ends the shortest way of all, the
// f value of the node under way is a lower bound on its length at any time, and an empty open list proves that no way
// of that width exists. Scanned cells are looked at as the rectangles that cover them, of which only the corners where
// the occupied ground is convex can turn a way.
//
// Memory: 88 bytes a node, 8 a corner, 4 a block (layout.h), all of it free for others between searches. Time: about 3 us an expansion (20 to 40 obstacles
// seen), 0.3 us a tested line; one work unit stands for an obstacle measured
// or four passed over. Sliced by node.
#ifndef AISLE_PLAN_TANGENT_H
#define AISLE_PLAN_TANGENT_H

#include "aisle/limits.h"
#include "base/heap.h"
#include "world/layout.h"

#define AISLE_TANGENT_BINS 256U // of directions
#define AISLE_TANGENT_NODES_MAX 65536U
#define AISLE_TANGENT_NONE UINT32_MAX

typedef struct aisle_tangent_node { // arrival at a circle
    double g;                       // m, cost up to the point of contact
    aisle_vec2 d;                   // unit direction of arrival
    aisle_vec2 centre;
    double rho;      // m, signed radius: positive with the centre on the left; 0 start and goal
    uint32_t corner; // 2 * corner of the layout, + 1 for side -1; AISLE_TANGENT_NONE for start and goal
    uint32_t block;  // the corner is its; AISLE_TANGENT_NONE for start and goal
    uint32_t at;     // which of the block's vertices
    uint32_t parent;
    uint32_t next; // expanded earlier at the same corner
} aisle_tangent_node;

typedef struct aisle_tangent {
    const aisle_layout *layout;
    aisle_layout_without without; // polygons that do not count
    double radius;                // m
    aisle_aabb allowed;           // where the centre may be
    aisle_vec2 goal;
    aisle_tangent_node *nodes; // [capacity]
    aisle_heap open;           // of nodes, by f
    uint32_t *expanded;        // [2 * corners] newest expanded node at a corner
    uint32_t *seen;            // [blocks] stamp of the last visit
    uint32_t capacity, corners, blocks, count, stamp;
    float depth[AISLE_TANGENT_BINS]; // m, beyond which a direction is hidden from the node under way
    double bound;                    // m, no way is shorter
    uint32_t found;                  // the goal's node
    uint32_t expansions, tests;      // counters since start
    uint32_t quarters;               // of work units, since the last step
} aisle_tangent;

// What it carves others may use between the end of a search and the next start.
void aisle_tangent_carve(aisle_tangent *self, aisle_arena *arena, const aisle_limits *limits);

// Begins the search of a disc's way; radius >= 0; the layout has_blocks(). Start and goal may be anywhere: what is not free for the disc has no
// way.
void aisle_tangent_start(aisle_tangent *self, const aisle_layout *layout, double radius, aisle_vec2 start,
                         aisle_vec2 goal);

// Between start() and the first step(): as if these polygons were not there.
void aisle_tangent_leave_out(aisle_tangent *self, const aisle_layout_without *without);

// AISLE_BUSY; AISLE_OK: found, bound is its length; AISLE_PARTIAL: proved, there is no way; AISLE_ERR_CAPACITY: out of
// nodes, bound still holds.
aisle_status aisle_tangent_step(aisle_tangent *self, uint32_t units, uint32_t *spent);

// After AISLE_OK: the polyline about the found way, for a disc of `radius` >= that of the search along the same corners:
// legs tangent to the circles, an arc cut into corners of at most a right angle's two thirds, so that arcs of that
// radius fit into every corner. Returns the number of points[capacity]; 0: the way is not free at this radius, or does
// not fit.
uint32_t aisle_tangent_points(aisle_tangent *self, double radius, aisle_vec2 *points, uint32_t capacity);
#endif
