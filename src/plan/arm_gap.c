#include "plan/arm_gap.h"

#define EDGE_MIN 1e-6 // m
#define AXIS_SQ_MIN 1e-30

static aisle_vec2 edge_of(const aisle_convex *hull, uint32_t i) {
    return aisle_vec2_sub(hull->v[i + 1U < hull->n ? i + 1U : 0U], hull->v[i]);
}

bool aisle_arm_gap_is_plain(const aisle_convex *hull) {
    for (uint32_t i = 0; i < hull->n; i++) {
        const aisle_vec2 edge = edge_of(hull, i);
        const double length = aisle_vec2_length(edge);
        if (!(length >= EDGE_MIN)) {
            return false;
        }
        for (uint32_t k = 0; k < hull->n; k++) {
            if (aisle_vec2_cross(edge, aisle_vec2_sub(hull->v[k], hull->v[i])) < -AISLE_SHAPE_DENT * length) {
                return false;
            }
        }
    }
    return hull->n > 2U;
}

// Squared distance from the tip of `to` to the segment from 0 to `edge`.
static double segment_sq(aisle_vec2 to, aisle_vec2 edge, double inverse_sq) {
    const double t = aisle_clamp(aisle_vec2_dot(to, edge) * inverse_sq, 0.0, 1.0);
    const aisle_vec2 d = aisle_vec2_sub(to, aisle_vec2_scale(edge, t));
    return aisle_vec2_dot(d, d);
}

// From the ends to the edges they are beyond. True: an edge has both beyond it; *best_sq falls to the least squared distance, or to
// -1 where that edge's line alone is as far off as the cap was.
static bool measure_ends(const aisle_convex *hull, aisle_vec2 a, aisle_vec2 b, double *best_sq) {
    const double cap_sq = *best_sq;
    bool apart = false;
    for (uint32_t i = 0; i < hull->n; i++) {
        const aisle_vec2 edge = edge_of(hull, i);
        const aisle_vec2 to_a = aisle_vec2_sub(a, hull->v[i]), to_b = aisle_vec2_sub(b, hull->v[i]);
        const double at_a = aisle_vec2_cross(edge, to_a), at_b = aisle_vec2_cross(edge, to_b); // < 0: beyond
        if (at_a >= 0.0 && at_b >= 0.0) {
            continue;
        }
        const double length_sq = aisle_vec2_dot(edge, edge), nearer = aisle_max(at_a, at_b);
        if (nearer < 0.0) {
            apart = true;
            if (nearer * nearer >= cap_sq * length_sq) {
                *best_sq = -1.0;
                return true;
            }
        }
        const double inverse_sq = 1.0 / length_sq;
        if (at_a < 0.0) {
            *best_sq = aisle_min(*best_sq, segment_sq(to_a, edge, inverse_sq));
        }
        if (at_b < 0.0) {
            *best_sq = aisle_min(*best_sq, segment_sq(to_b, edge, inverse_sq));
        }
    }
    return apart;
}

// From the vertices to the axis. True: all are on one side of it.
static bool measure_vertices(const aisle_convex *hull, aisle_vec2 a, aisle_vec2 b, double *best_sq) {
    const aisle_vec2 axis = aisle_vec2_sub(b, a);
    const double length_sq = aisle_vec2_dot(axis, axis);
    const double inverse_sq = length_sq > AXIS_SQ_MIN ? 1.0 / length_sq : 0.0;
    bool left = false, right = false;
    for (uint32_t k = 0; k < hull->n; k++) {
        const aisle_vec2 to = aisle_vec2_sub(hull->v[k], a);
        const double side = aisle_vec2_cross(axis, to);
        left = left || side >= 0.0;
        right = right || side <= 0.0;
        *best_sq = aisle_min(*best_sq, segment_sq(to, axis, inverse_sq));
    }
    return !(left && right);
}

double aisle_arm_axis_gap(const aisle_convex *hull, bool plain, aisle_vec2 a, aisle_vec2 b, double cap) {
    if (!plain) {
        const aisle_vec2 ends[2] = {a, b};
        const aisle_convex axis = {ends, 2U, 0.0}, bare = {hull->v, hull->n, 0.0};
        return aisle_min(cap, aisle_convex_gap(&axis, &bare));
    }
    double best_sq = cap * cap;
    const bool by_edge = measure_ends(hull, a, b, &best_sq);
    if (best_sq < 0.0) {
        return cap;
    }
    const bool by_axis = measure_vertices(hull, a, b, &best_sq);
    return by_edge || by_axis ? aisle_min(cap, sqrt(best_sq)) : 0.0;
}
