#include "plan/verify_moving_parts.h"

#include "base/angle.h"
#include "base/check.h"

// ---- where the footprint is

static aisle_vec2 place(const aisle_verify_moving *self, double u, aisle_vec2 *out) {
    const aisle_vehicle *vehicle = self->request.vehicle;
    const aisle_vec2 origin = aisle_verify_piece_origin(&self->curve, u);
    double sine = 0.0, cosine = 1.0;
    if (self->lever > 0.0) { // else every point is the origin
        aisle_sincos(self->curve.theta + u * self->turn, &sine, &cosine);
    }
    for (uint32_t i = 0; i < vehicle->n; i++) {
        const aisle_vec2 v = vehicle->footprint[i];
        out[i] = aisle_vec2_of(origin.x + cosine * v.x - sine * v.y, origin.y + sine * v.x + cosine * v.y);
    }
    return origin;
}

void aisle_moving_sweep_over(const aisle_verify_moving *self, double lo, double hi, aisle_moving_sweep *out) {
    const double arc = self->curve.phi * self->curve.length / 4.0,
                 rotation = self->lever * self->turn * self->turn / 8.0;
    const double part = hi - lo;
    AISLE_ASSERT(part >= 0.0);
    out->origin_a = place(self, lo, out->a);
    out->origin_b = place(self, hi, out->b);
    out->sagitta = (arc + rotation) * part * part;
    out->travel = (self->curve.length + self->lever * fabs(self->turn)) * part;
}

// ---- how far from it a point is

// The least of points[n] along the axis towards p, over the axis's length: p is at least so far from their hull. No
// length: nothing is known.
static double gap_along(const aisle_vec2 *points, uint32_t n, aisle_vec2 p, aisle_vec2 axis) {
    const double length = aisle_vec2_length(axis);
    double gap = DBL_MAX;
    if (!(length > 1e-150)) {
        return -DBL_MAX;
    }
    for (uint32_t i = 0; i < n; i++) {
        gap = aisle_min(gap, aisle_vec2_dot(aisle_vec2_sub(p, points[i]), axis));
    }
    return gap / length;
}

static aisle_vec2 way_from_nearest(const aisle_vec2 *points, uint32_t n, aisle_vec2 p) {
    aisle_vec2 best = aisle_vec2_sub(p, points[0]);
    for (uint32_t i = 1; i < n; i++) {
        const aisle_vec2 way = aisle_vec2_sub(p, points[i]);
        best = aisle_vec2_dot(way, way) < aisle_vec2_dot(best, best) ? way : best;
    }
    return best;
}

// The axes across the edges of of[n], outwards of a counter-clockwise outline.
static double gap_across_edges(const aisle_vec2 *points, uint32_t count, aisle_vec2 p, const aisle_vec2 *of,
                               uint32_t n) {
    double gap = -DBL_MAX;
    for (uint32_t i = 0; n > 1U && i < n; i++) {
        const aisle_vec2 edge = aisle_vec2_sub(of[i + 1U < n ? i + 1U : 0U], of[i]);
        gap = aisle_max(gap, gap_along(points, count, p, aisle_vec2_of(edge.y, -edge.x)));
    }
    return gap;
}

static double segment_gap(aisle_vec2 a, aisle_vec2 b, aisle_vec2 p) {
    const aisle_vec2 way = aisle_vec2_sub(b, a), to = aisle_vec2_sub(p, a);
    const double square = aisle_vec2_dot(way, way), along = aisle_vec2_dot(to, way);
    const double t = square > 0.0 ? aisle_clamp(along / square, 0.0, 1.0) : 0.0;
    return aisle_vec2_length(aisle_vec2_sub(to, aisle_vec2_scale(way, t)));
}

// Whatever the axes are, none of them tells too much. For a body that does not turn on a straight piece these are all
// there are.
double aisle_moving_gap(const aisle_verify_moving *self, aisle_vec2 p, double enough) {
    const aisle_moving_sweep *sweep = &self->sweep;
    const aisle_vehicle *vehicle = self->request.vehicle;
    const uint32_t n = vehicle->n;
    const double less = vehicle->radius + sweep->sagitta + AISLE_VERIFY_EPSILON;
    const double discs = segment_gap(sweep->origin_a, sweep->origin_b, p) - self->lever - less;
    if (discs >= enough || n == 1U) {
        return discs;
    }
    aisle_vec2 points[2 * AISLE_SHAPE_VERTICES_MAX];
    for (uint32_t i = 0; i < n; i++) {
        points[i] = sweep->a[i];
        points[n + i] = sweep->b[i];
    }
    const aisle_vec2 way = aisle_vec2_sub(sweep->origin_b, sweep->origin_a);
    double gap = gap_along(points, 2U * n, p, way_from_nearest(points, 2U * n, p));
    gap = aisle_max(gap, gap_along(points, 2U * n, p, aisle_vec2_of(way.y, -way.x)));
    gap = aisle_max(gap, gap_along(points, 2U * n, p, aisle_vec2_of(-way.y, way.x)));
    gap = aisle_max(gap, gap_across_edges(points, 2U * n, p, sweep->a, n));
    gap = aisle_max(gap, gap_across_edges(points, 2U * n, p, sweep->b, n));
    return aisle_max(gap - less, discs);
}

double aisle_moving_end_gap(const aisle_verify_moving *self, aisle_vec2 p) {
    const aisle_vec2 *b = self->sweep.b;
    const uint32_t n = self->request.vehicle->n;
    const double gap = aisle_max(gap_along(b, n, p, way_from_nearest(b, n, p)), gap_across_edges(b, n, p, b, n));
    return gap - self->request.vehicle->radius;
}
