// vec.h - points and vectors of the plane, in double. Level 0. Units are the caller's (m, mostly).
#ifndef AISLE_BASE_VEC_H
#define AISLE_BASE_VEC_H

#include <math.h>
#include <stdbool.h>

typedef struct aisle_vec2 {
    double x, y;
} aisle_vec2;

typedef struct aisle_pose2 { // a configuration: position (m) and heading (rad, counter-clockwise from x)
    double x, y, theta;
} aisle_pose2;

typedef struct aisle_aabb { // axis-aligned box; empty if lo > hi in a component
    aisle_vec2 lo, hi;
} aisle_aabb;

static inline aisle_vec2 aisle_vec2_of(double x, double y) {
    return (aisle_vec2){x, y};
}
static inline aisle_vec2 aisle_vec2_add(aisle_vec2 a, aisle_vec2 b) {
    return (aisle_vec2){a.x + b.x, a.y + b.y};
}
static inline aisle_vec2 aisle_vec2_sub(aisle_vec2 a, aisle_vec2 b) {
    return (aisle_vec2){a.x - b.x, a.y - b.y};
}
static inline aisle_vec2 aisle_vec2_scale(aisle_vec2 a, double k) {
    return (aisle_vec2){a.x * k, a.y * k};
}
static inline double aisle_vec2_dot(aisle_vec2 a, aisle_vec2 b) {
    return a.x * b.x + a.y * b.y;
}
// z of the cross product: positive if b is counter-clockwise of a.
static inline double aisle_vec2_cross(aisle_vec2 a, aisle_vec2 b) {
    return a.x * b.y - a.y * b.x;
}
static inline double aisle_vec2_length(aisle_vec2 a) {
    return sqrt(a.x * a.x + a.y * a.y);
}
static inline double aisle_vec2_distance(aisle_vec2 a, aisle_vec2 b) {
    return aisle_vec2_length(aisle_vec2_sub(a, b));
}
// a + t (b - a)
static inline aisle_vec2 aisle_vec2_lerp(aisle_vec2 a, aisle_vec2 b, double t) {
    return (aisle_vec2){a.x + t * (b.x - a.x), a.y + t * (b.y - a.y)};
}
static inline double aisle_min(double a, double b) {
    return a < b ? a : b;
}
static inline double aisle_max(double a, double b) {
    return a > b ? a : b;
}
static inline double aisle_clamp(double x, double lo, double hi) {
    return x < lo ? lo : (x > hi ? hi : x);
}

// Do they share a point? Touching is sharing. Both are taken to be not empty.
static inline bool aisle_aabb_overlap(aisle_aabb a, aisle_aabb b) {
    return a.lo.x <= b.hi.x && b.lo.x <= a.hi.x && a.lo.y <= b.hi.y && b.lo.y <= a.hi.y;
}
// Every side moved outwards.
static inline aisle_aabb aisle_aabb_grow(aisle_aabb a, double by) {
    return (aisle_aabb){{a.lo.x - by, a.lo.y - by}, {a.hi.x + by, a.hi.y + by}};
}
#endif
