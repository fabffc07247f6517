// optimum.h - the exact shortest path of a disc, as an oracle for tests and benches. Test support, no part of libaisle.
//
// A disc of radius R moves among closed obstacles; its centre may touch what is R away from them (closed free space).
// Every shortest path is a chain of straight pieces and arcs of radius R around convex obstacle vertices, each piece
// tangent to the arcs at its ends (Chew 1985, doi:10.1145/323233.323261; Liu & Arimoto 1992,
// doi:10.1177/027836499201100104). So: all arcs of the boundary of the free space; all tangents between them that are
// free, judged by the exact distance to the obstacles themselves; A* with the beeline as bound. Brute force on purpose,
// in long double; it shares no line with src/.
//
// Tolerance: what is free at R - OPTIMUM_SLACK counts as free, the tangents are those of R. So a path reported may be
// 2 * OPTIMUM_SLACK too wide for its narrowest gap and its length is right to about 1e-8 m, never longer than the
// optimum by more; and NONE is a proof that no way exists for R, of whatever kind.
//
// Memory: malloc, aborts when there is none. Time: O(n^2) tangents times the cost of a free test for n arcs, fewer where
// A* does not come; 20 obstacles take a millisecond, 306 or a scanned map of a million cells a tenth of a second. No
// recursion, no globals.
// Determinism: the same input gives the same bits in the same build.
#ifndef OPTIMUM_H
#define OPTIMUM_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define OPTIMUM_SLACK 1e-9 // m

typedef struct optimum_point {
    double x, y; // m
} optimum_point;

typedef struct optimum_polygon {
    const optimum_point *points; // their convex hull is the obstacle; any order, any repetition
    size_t count;                // >= 1; a point and a line are obstacles for R > 0 and none for R = 0
} optimum_polygon;

typedef enum optimum_result {
    OPTIMUM_FOUND,
    OPTIMUM_NONE,         // proved: no way
    OPTIMUM_END_OCCUPIED, // start or goal is closer than R to an obstacle or outside
} optimum_result;

typedef struct optimum_step {
    double x, y;      // m
    double curvature; // of the piece that ends here: 0 = straight, 1/R = arc to the left, -1/R = to the right
} optimum_step;

typedef struct optimum_path {
    optimum_result result;
    double length;       // m; INFINITY unless found
    optimum_step *steps; // from start to goal, both included; owned by the path
    size_t count;
    size_t tangents; // free ones looked at, a measure of work
} optimum_path;

typedef struct optimum_world optimum_world;

// Obstacles are convex polygons, which may overlap, touch and repeat. bounds: x_min, y_min, x_max, y_max of the CENTRE,
// both ends allowed. radius: 0, or >= 1e-6 m. A point (radius 0) may pass between polygons that only touch.
optimum_world *optimum_polygons(double radius, const double bounds[4], const optimum_polygon *polygons, size_t count);

// Obstacles are the closed square cells that are not 0, and all outside the map. Cell (i, j) covers
// [i, i+1] x [j, j+1] times resolution and is occupied[j * width + i]; coordinates count from the map's corner.
// radius >= 1e-6 m. Only corners that stick out of the occupied region can turn a path.
optimum_world *optimum_grid(double radius, double resolution, uint32_t width, uint32_t height, const uint8_t *occupied);

void optimum_free(optimum_world *world);

// Arcs of the free space's boundary, a measure of size.
size_t optimum_arcs(const optimum_world *world);

// upper: a length that is known to suffice, e.g. of any path (what is longer is not looked at; if it was wrong the
// answer is NONE), or INFINITY.
optimum_path optimum_shortest(const optimum_world *world, optimum_point start, optimum_point goal, double upper);
void optimum_path_free(optimum_path *path);
#endif
