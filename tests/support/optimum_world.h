// optimum_world.h - between the search for the optimum (optimum.c) and its two kinds of world. Private to these.
#ifndef OPTIMUM_WORLD_H
#define OPTIMUM_WORLD_H

#include "optimum.h"

#include <math.h>

typedef long double real;

typedef struct vec {
    real x, y;
} vec;

static inline vec vec_of(real x, real y) {
    vec v = {x, y};
    return v;
}
static inline vec plus(vec a, vec b) {
    return vec_of(a.x + b.x, a.y + b.y);
}
static inline vec minus(vec a, vec b) {
    return vec_of(a.x - b.x, a.y - b.y);
}
static inline vec times(real f, vec a) {
    return vec_of(f * a.x, f * a.y);
}
static inline vec left_of(vec a) { // turned by 90 degrees to the left
    return vec_of(-a.y, a.x);
}
static inline real dot(vec a, vec b) {
    return a.x * b.x + a.y * b.y;
}
static inline real cross(vec a, vec b) {
    return a.x * b.y - a.y * b.x;
}
static inline real norm(vec a) {
    return sqrtl(dot(a, a));
}
static inline vec turned(vec a, real angle) {
    return plus(times(cosl(angle), a), times(sinl(angle), left_of(a)));
}

// Points center + R * u with u between lo and hi, counter-clockwise: a piece of the free space's boundary, at most a
// quarter of the circle so that sines and signs tell all.
typedef struct arc {
    vec center, lo, hi; // unit vectors
    real span;          // rad from lo to hi
    int32_t after;      // the arc that goes on at hi, or -1
    int32_t before;     // the arc that goes on at lo, or -1
} arc;

typedef struct interval {
    real from, to;
} interval;

typedef struct intervals {
    interval *items;
    size_t count, capacity;
} intervals;

struct optimum_world {
    real radius, reach; // reach = radius - OPTIMUM_SLACK: what is closer is hit
    arc *arcs;
    size_t arc_count, arc_capacity;
    void *obstacles;
    bool (*segment_free)(const optimum_world *world, vec p, vec q); // p = q: a point
    void (*obstacles_free)(void *obstacles);
};

void *optimum_grow(void *block, size_t *capacity, size_t need, size_t size); // realloc to at least need items
void optimum_add_interval(intervals *list, real from, real to);

// Hull of points into hull[count], counter-clockwise, without repeated and collinear ones. Its size.
size_t optimum_hull(const optimum_point *points, size_t count, vec *hull);

// Is any point of p..q closer than reach to the convex polygon (hull of count points)? reach > 0.
bool optimum_hits(const vec *hull, size_t count, real reach, vec p, vec q);

// Adds the angles t in [0, span] for which center + radius * turned(lo, t) is closer than reach to the polygon.
void optimum_block_arc(vec center, real radius, vec lo, real span, const vec *hull, size_t count, real reach,
                       intervals *blocked);

// The same where normal . x > limit: outside a half-plane.
void optimum_block_beyond(vec center, real radius, vec lo, real span, vec normal, real limit, intervals *blocked);

// Adds what the blocked intervals (sorted here) leave of the arc from lo over span, at most a quarter of a circle.
void optimum_add_arcs(optimum_world *world, vec center, vec lo, real span, intervals *blocked);

// Links arcs [first, arc_count) that go on into each other; closed: the last into the first.
void optimum_link_arcs(optimum_world *world, size_t first, bool closed);
#endif
