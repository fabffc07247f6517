// gen.h - random shapes for the tests of level 1, and slow, plain judges in long double that share nothing with src.
#ifndef AISLE_TESTS_WORLD_GEN_H
#define AISLE_TESTS_WORLD_GEN_H

#include "base/rng.h"
#include "base/vec.h"
#include "world/shape.h"

#include <math.h>
#include <stdbool.h>
#include <stdint.h>

static inline double gen_in(aisle_rng *rng, double lo, double hi) {
    return lo + (hi - lo) * ((double)aisle_rng_next(rng) / 4294967296.0);
}

// Vertices on an ellipse turned at random, counter-clockwise: convex whatever the angles. Always holds its centre.
static inline void gen_polygon(aisle_rng *rng, aisle_vec2 centre, double rx, double ry, uint32_t n, aisle_vec2 *out) {
    const double turn = gen_in(rng, 0.0, 6.28);
    for (uint32_t i = 0; i < n; i++) {
        const double angle = 6.283185307179586 * ((double)i + gen_in(rng, 0.0, 0.7)) / (double)n;
        const double x = rx * cos(angle);
        const double y = ry * sin(angle);
        out[i] = aisle_vec2_of(centre.x + x * cos(turn) - y * sin(turn), centre.y + x * sin(turn) + y * cos(turn));
    }
}

static inline void gen_box(aisle_vec2 lo, aisle_vec2 hi, aisle_vec2 out[4]) {
    out[0] = lo;
    out[1] = aisle_vec2_of(hi.x, lo.y);
    out[2] = hi;
    out[3] = aisle_vec2_of(lo.x, hi.y);
}

typedef struct judge_point {
    long double x, y;
} judge_point;

static inline judge_point judge_of(aisle_vec2 v) {
    return (judge_point){(long double)v.x, (long double)v.y};
}
static inline long double judge_turn(judge_point a, judge_point b, judge_point c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

static inline long double judge_point_to_segment(judge_point p, judge_point a, judge_point b) {
    const long double ex = b.x - a.x;
    const long double ey = b.y - a.y;
    const long double sq = ex * ex + ey * ey;
    long double t = sq > 0.0L ? ((p.x - a.x) * ex + (p.y - a.y) * ey) / sq : 0.0L;
    t = t < 0.0L ? 0.0L : (t > 1.0L ? 1.0L : t);
    const long double dx = p.x - (a.x + t * ex);
    const long double dy = p.y - (a.y + t * ey);
    return sqrtl(dx * dx + dy * dy);
}

static inline bool judge_segments_cross(judge_point a, judge_point b, judge_point c, judge_point d) {
    return judge_turn(a, b, c) * judge_turn(a, b, d) < 0.0L && judge_turn(c, d, a) * judge_turn(c, d, b) < 0.0L;
}

static inline bool judge_is_inside(const aisle_vec2 *v, uint32_t n, judge_point p) { // crossing number
    bool inside = false;
    for (uint32_t i = 0; i < n; i++) {
        const judge_point a = judge_of(v[i]);
        const judge_point b = judge_of(v[(i + 1U) % n]);
        if ((a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x)) {
            inside = !inside;
        }
    }
    return n >= 3U && inside;
}

// Gap of two rounded polygons, segments or points: every edge against every edge.
static inline long double judge_gap(const aisle_convex *a, const aisle_convex *b) {
    if (judge_is_inside(a->v, a->n, judge_of(b->v[0])) || judge_is_inside(b->v, b->n, judge_of(a->v[0]))) {
        return 0.0L;
    }
    long double best = (long double)INFINITY;
    for (uint32_t i = 0; i < a->n; i++) {
        const judge_point p = judge_of(a->v[i]);
        const judge_point q = judge_of(a->v[(i + 1U) % a->n]);
        for (uint32_t k = 0; k < b->n; k++) {
            const judge_point r = judge_of(b->v[k]);
            const judge_point s = judge_of(b->v[(k + 1U) % b->n]);
            if (judge_segments_cross(p, q, r, s)) {
                return 0.0L;
            }
            best = fminl(best, fminl(judge_point_to_segment(p, r, s), judge_point_to_segment(q, r, s)));
            best = fminl(best, fminl(judge_point_to_segment(r, p, q), judge_point_to_segment(s, p, q)));
        }
    }
    best -= (long double)a->radius + (long double)b->radius;
    return best > 0.0L ? best : 0.0L;
}
#endif
