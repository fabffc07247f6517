#include "world/grid_raster.h"

#include "base/check.h"

#include <float.h>

static void take_in(aisle_span *s, double lo, double hi) {
    s->lo = aisle_min(s->lo, lo);
    s->hi = aisle_max(s->hi, hi);
}

static aisle_raster_side side_between(aisle_vec2 a, aisle_vec2 b, double radius) {
    const aisle_vec2 edge = aisle_vec2_sub(b, a);
    const double length = aisle_vec2_length(edge);
    const double k = length > 0.0 ? radius / length : 0.0;
    const aisle_vec2 outwards = aisle_vec2_of(edge.y * k, -edge.x * k);
    const aisle_vec2 to = aisle_vec2_add(b, outwards);
    aisle_raster_side s = {.corner = a, .from = aisle_vec2_add(a, outwards)};
    s.x = (aisle_span){aisle_min(s.from.x, to.x), aisle_max(s.from.x, to.x)};
    s.y = (aisle_span){aisle_min(s.from.y, to.y), aisle_max(s.from.y, to.y)};
    s.is_level = fabs(edge.y) <= AISLE_GRID_SLACK;
    s.x_per_y = s.is_level ? 0.0 : edge.x / edge.y;
    return s;
}

// Takes in the part of a side, and of the disc at its corner, with y in the given span.
static void take_in_side(const aisle_raster_side *s, double radius, aisle_span y, aisle_span *x) {
    const double off = aisle_max(0.0, aisle_max(y.lo - s->corner.y, s->corner.y - y.hi));
    if (off <= radius) {
        const double half = sqrt(radius * radius - off * off);
        take_in(x, s->corner.x - half, s->corner.x + half);
    }
    if (s->y.lo > y.hi || s->y.hi < y.lo) {
        return;
    }
    if (s->is_level) {
        take_in(x, s->x.lo, s->x.hi);
        return;
    }
    const double at_lo = s->from.x + (aisle_max(y.lo, s->y.lo) - s->from.y) * s->x_per_y;
    const double at_hi = s->from.x + (aisle_min(y.hi, s->y.hi) - s->from.y) * s->x_per_y;
    take_in(x, aisle_clamp(aisle_min(at_lo, at_hi), s->x.lo, s->x.hi),
            aisle_clamp(aisle_max(at_lo, at_hi), s->x.lo, s->x.hi));
}

// First and one past the last index of the cells along a side of n that [lo, hi] touches, slack included.
static void touched(double lo, double hi, uint32_t n, uint32_t *first, uint32_t *end) {
    const double limit = (double)n;
    *first = (uint32_t)aisle_clamp(floor(lo - AISLE_GRID_SLACK), 0.0, limit);
    *end = (uint32_t)aisle_clamp(floor(hi + AISLE_GRID_SLACK) + 1.0, 0.0, limit);
}

void aisle_raster_of(aisle_raster *self, const aisle_lattice *lattice, const aisle_convex *shape) {
    AISLE_ASSERT(shape->n >= 1U && shape->n <= AISLE_RASTER_SIDES_MAX);
    self->n = shape->n;
    self->w = lattice->w;
    self->radius = shape->radius / lattice->res;
    aisle_span all = {DBL_MAX, -DBL_MAX};
    for (uint32_t i = 0; i < shape->n; i++) {
        const aisle_vec2 corner = {lattice->x0, lattice->y0};
        const aisle_vec2 a = aisle_vec2_scale(aisle_vec2_sub(shape->v[i], corner), 1.0 / lattice->res);
        const aisle_vec2 v = shape->v[i + 1U < shape->n ? i + 1U : 0U];
        const aisle_vec2 b = aisle_vec2_scale(aisle_vec2_sub(v, corner), 1.0 / lattice->res);
        self->sides[i] = side_between(a, b, self->radius);
        take_in(&all, a.y - self->radius, a.y + self->radius);
    }
    touched(all.lo, all.hi, lattice->h, &self->first_row, &self->end_row);
}

void aisle_raster_row(const aisle_raster *self, uint32_t row, uint32_t *first, uint32_t *end) {
    const aisle_span y = {(double)row - AISLE_GRID_SLACK, (double)row + 1.0 + AISLE_GRID_SLACK};
    aisle_span x = {DBL_MAX, -DBL_MAX};
    for (uint32_t i = 0; i < self->n; i++) {
        take_in_side(&self->sides[i], self->radius, y, &x);
    }
    touched(x.lo, x.hi, self->w, first, end);
}
