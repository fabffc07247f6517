#include "base/check.h"
#include "world/layout_internal.h"

#include <float.h>

#define PRUNE_SPARE 1e-12 // m; boxes and shapes round differently, and equal gaps must all be seen
#define SIDE_SPARE 1e-9   // m; more than distances from a line round at coordinates within AISLE_SHAPE_COORD_MAX

typedef struct search {
    const aisle_layout *layout;
    const aisle_convex *shape;
    aisle_aabb box;                      // of the shape
    aisle_vec2 aside;                    // unit normal of a shape that is a line, else 0
    double best;                         // m; no obstacle further than this is of interest
    int32_t id;                          // of the nearest so far; 0: none
    const aisle_layout_without *without; // NULL: all obstacles count
} search;

static void consider(search *s, double gap, int32_t id) {
    if (gap < s->best || (gap <= s->best && (s->id == 0 || id < s->id))) {
        s->best = gap;
        s->id = id;
    }
}

static bool is_too_far(const search *s, aisle_aabb box) {
    return aisle_aabb_gap(s->box, box) > s->best + PRUNE_SPARE;
}

static aisle_vec2 normal_of(const aisle_convex *shape) {
    if (shape->n != 2U) {
        return aisle_vec2_of(0.0, 0.0);
    }
    const aisle_vec2 way = aisle_vec2_sub(shape->v[1], shape->v[0]);
    const double length = aisle_vec2_length(way);
    return length > 0.0 ? aisle_vec2_of(-way.y / length, way.x / length) : aisle_vec2_of(0.0, 0.0);
}

// Do all of v lie too far on one side of the line the shape is? Boxes of oblique lines tell little.
static bool is_beside(const search *s, const aisle_vec2 *v, uint32_t n) {
    double lo = DBL_MAX, hi = -DBL_MAX;
    if (s->shape->n != 2U) {
        return false;
    }
    for (uint32_t i = 0; i < n; i++) {
        const double at = aisle_vec2_dot(aisle_vec2_sub(v[i], s->shape->v[0]), s->aside);
        lo = aisle_min(lo, at);
        hi = aisle_max(hi, at);
    }
    return aisle_max(lo, -hi) > s->best + s->shape->radius + SIDE_SPARE;
}

static bool is_finite(const aisle_convex *shape) {
    double sum = shape->radius;
    for (uint32_t i = 0; i < shape->n; i++) {
        sum += fabs(shape->v[i].x) + fabs(shape->v[i].y);
    }
    return sum <= DBL_MAX;
}

static void search_bounds(search *s) {
    const aisle_aabb b = aisle_layout_bounds(s->layout);
    const double x = aisle_min(s->box.lo.x - b.lo.x, b.hi.x - s->box.hi.x);
    const double y = aisle_min(s->box.lo.y - b.lo.y, b.hi.y - s->box.hi.y);
    const double gap = is_finite(s->shape) ? aisle_max(0.0, aisle_min(x, y)) : 0.0;
    consider(s, gap, AISLE_LAYOUT_ID_BOUNDS);
}

// Something lies as near to a point of the shape as the distance field says; which, the search will tell.
static void lower_by_field(search *s, aisle_vec2 p) {
    const double upper = aisle_max(aisle_grid_gap_upper(&s->layout->grid, p) - s->shape->radius, 0.0);
    if (upper < s->best) {
        s->best = upper;
        s->id = 0;
    }
}

// Lowers what is of interest by what the distance field knows of one point of the shape. False: nothing is near.
static bool search_field(search *s) {
    const aisle_convex *shape = s->shape;
    aisle_vec2 middle = {0.0, 0.0};
    for (uint32_t i = 0; i < shape->n; i++) {
        middle = aisle_vec2_add(middle, aisle_vec2_scale(shape->v[i], 1.0 / shape->n));
    }
    double reach = 0.0;
    for (uint32_t i = 0; i < shape->n; i++) {
        reach = aisle_max(reach, aisle_vec2_distance(middle, shape->v[i]));
    }
    if (aisle_grid_gap_lower(&s->layout->grid, middle) - reach - shape->radius > s->best) {
        return false;
    }
    if (s->without != NULL) { // what is that near may be what does not count
        return true;
    }
    lower_by_field(s, middle);
    const bool is_wide = s->best > 4.0 * s->layout->grid.lattice.res; // a smaller bound saves rows of scanned cells
    if (is_wide && shape->n == 2U && aisle_layout_has_scan(s->layout)) {
        lower_by_field(s, shape->v[0]);
        lower_by_field(s, shape->v[1]);
    }
    return true;
}

static bool counts(const search *s, const aisle_zone *zone) {
    for (uint32_t i = 0; s->without != NULL && i < s->without->count; i++) {
        if (s->without->id[i] == zone->id) {
            return false;
        }
    }
    return aisle_zone_is_obstacle(zone);
}

static void search_zones(search *s) {
    const aisle_zone *zone;
    aisle_layout_walk walk = aisle_layout_walk_over(s->layout, aisle_aabb_grow(s->box, s->best + PRUNE_SPARE));
    while (aisle_layout_walk_next(&walk, &zone)) {
        if (counts(s, zone) && !is_too_far(s, zone->box)) {
            const aisle_convex shape = aisle_layout_zone_shape(s->layout, zone);
            if (!is_beside(s, shape.v, shape.n)) {
                consider(s, aisle_convex_gap(s->shape, &shape), zone->id);
            }
        }
    }
}

// Cells along one side from `at`, clamped to [0, n].
static uint32_t clamped(double at, uint32_t n) {
    if (!(at > 0.0)) {
        return 0;
    }
    return at < (double)n ? (uint32_t)at : n;
}

// Every run of occupied cells of one row, as one rectangle. False: the row is too far.
static bool search_row(search *s, uint32_t iy) {
    const aisle_lattice *l = &s->layout->grid.lattice;
    const double y0 = l->y0 + (double)iy * l->res;
    const double y1 = l->y0 + (double)(iy + 1U) * l->res;
    if (is_too_far(s, (aisle_aabb){{s->box.lo.x, y0}, {s->box.hi.x, y1}})) {
        return false;
    }
    const double reach = s->best + PRUNE_SPARE;
    const uint32_t first = clamped((s->box.lo.x - reach - l->x0) / l->res - 1.0, l->w);
    const uint32_t last = clamped((s->box.hi.x + reach - l->x0) / l->res + 2.0, l->w);
    uint32_t end;
    for (uint32_t ix = first; aisle_layout_scan_run(s->layout, iy, &ix, last, &end); ix = end) {
        const double x0 = l->x0 + (double)ix * l->res;
        const double x1 = l->x0 + (double)end * l->res;
        const aisle_vec2 corners[4] = {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}};
        if (!is_too_far(s, (aisle_aabb){corners[0], corners[2]}) && !is_beside(s, corners, 4)) {
            consider(s, aisle_convex_gap(s->shape, &(aisle_convex){corners, 4, 0.0}), AISLE_LAYOUT_ID_SCAN);
        }
    }
    return true;
}

// From the row of the shape's middle outwards, so that the far rows meet a small `best`.
static void search_scan(search *s) {
    const aisle_lattice *l = &s->layout->grid.lattice;
    const uint32_t middle = clamped((0.5 * (s->box.lo.y + s->box.hi.y) - l->y0) / l->res, l->h - 1U);
    for (uint32_t iy = middle; iy < l->h && search_row(s, iy); iy++) {
    }
    for (uint32_t iy = middle; iy > 0U && search_row(s, iy - 1U); iy--) {
    }
}

double aisle_layout_gap_without(const aisle_layout *self, const aisle_layout_without *without,
                                const aisle_convex *shape, double cap, int32_t *id) {
    AISLE_ASSERT(aisle_layout_is_in_force(self) && cap >= 0.0);
    search s = {.layout = self,
                .shape = shape,
                .box = aisle_convex_aabb(shape),
                .aside = normal_of(shape),
                .best = cap,
                .without = without};
    search_bounds(&s);
    const bool is_clear = s.id != 0 && s.best <= 0.0;
    if (!is_clear && search_field(&s)) {
        search_zones(&s);
        if (aisle_layout_has_scan(self)) {
            search_scan(&s);
        }
    }
    if (id != NULL) {
        *id = s.id;
    }
    return s.best;
}

double aisle_layout_gap(const aisle_layout *self, const aisle_convex *shape, double cap, int32_t *id) {
    return aisle_layout_gap_without(self, NULL, shape, cap, id);
}
