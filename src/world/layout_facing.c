#include "world/layout_facing.h"

#include "base/check.h"

#define SAME 1e-9 // m; gaps that differ by less are one

typedef struct facing {
    const aisle_layout *layout;
    aisle_vec2 p, side;
    double cap;
    aisle_piece *out;
    bool found;
} facing;

static aisle_vec2 nearest_on_segment(aisle_vec2 a, aisle_vec2 b, aisle_vec2 p) {
    aisle_vec2 edge = aisle_vec2_sub(b, a);
    double square = aisle_vec2_dot(edge, edge);
    double t = square > 0.0 ? aisle_vec2_dot(aisle_vec2_sub(p, a), edge) / square : 0.0;
    return t >= 1.0 ? b : aisle_vec2_lerp(a, b, aisle_max(t, 0.0));
}

static aisle_vec2 nearest_on_piece(const aisle_vec2 *v, uint32_t n, aisle_vec2 p) {
    if (n >= 3U && aisle_convex_point_gap(&(aisle_convex){v, n, 0.0}, p) <= 0.0) {
        return p;
    }
    aisle_vec2 best = v[0];
    for (uint32_t i = 0; i < n; i++) {
        aisle_vec2 q = nearest_on_segment(v[i], v[(i + 1U) % n], p);
        best = aisle_vec2_distance(p, q) < aisle_vec2_distance(p, best) ? q : best;
    }
    return best;
}

static void consider(facing *f, const aisle_vec2 *v, uint32_t n, int32_t id) {
    aisle_vec2 nearest = nearest_on_piece(v, n, f->p);
    aisle_vec2 way = aisle_vec2_sub(nearest, f->p);
    double gap = aisle_vec2_length(way);
    bool any = f->side.x == 0.0 && f->side.y == 0.0; // given as such
    if (gap > f->cap || (!any && aisle_vec2_dot(way, f->side) < AISLE_FACING_COSINE * gap)) {
        return;
    }
    aisle_piece *out = f->out;
    if (f->found && (gap > out->gap || (gap >= out->gap && id >= out->id))) {
        return;
    }
    f->found = true;
    *out = (aisle_piece){.n = n, .id = id, .nearest = nearest, .gap = gap};
    for (uint32_t i = 0; i < n; i++) {
        out->v[i] = v[i];
    }
}

static void consider_bounds(facing *f) {
    const aisle_aabb b = aisle_layout_bounds(f->layout);
    const aisle_vec2 corner[5] = {b.lo, {b.hi.x, b.lo.y}, b.hi, {b.lo.x, b.hi.y}, b.lo};
    for (int i = 0; i < 4; i++) {
        consider(f, &corner[i], 2U, AISLE_LAYOUT_ID_BOUNDS);
    }
}

static void consider_zones(facing *f) {
    const aisle_zone *zone;
    aisle_layout_walk walk = aisle_layout_walk_over(f->layout, aisle_aabb_grow((aisle_aabb){f->p, f->p}, f->cap));
    while (aisle_layout_walk_next(&walk, &zone)) {
        if (aisle_zone_is_obstacle(zone)) {
            const aisle_convex shape = aisle_layout_zone_shape(f->layout, zone);
            consider(f, shape.v, shape.n, zone->id);
        }
    }
}

static uint32_t cell_at(double at, uint32_t n) {
    return (uint32_t)aisle_clamp(at, 0.0, (double)n);
}

static void consider_scan(facing *f) {
    const aisle_lattice *l = &aisle_layout_grid(f->layout)->lattice;
    const uint32_t x0 = cell_at((f->p.x - f->cap - l->x0) / l->res - 1.0, l->w);
    const uint32_t x1 = cell_at((f->p.x + f->cap - l->x0) / l->res + 2.0, l->w);
    const uint32_t y0 = cell_at((f->p.y - f->cap - l->y0) / l->res - 1.0, l->h);
    const uint32_t y1 = cell_at((f->p.y + f->cap - l->y0) / l->res + 2.0, l->h);
    for (uint32_t iy = y0; iy < y1; iy++) {
        uint32_t end;
        for (uint32_t ix = x0; aisle_layout_scan_run(f->layout, iy, &ix, x1, &end); ix = end) {
            const aisle_vec2 lo = {l->x0 + (double)ix * l->res, l->y0 + (double)iy * l->res};
            const aisle_vec2 hi = {l->x0 + (double)end * l->res, l->y0 + (double)(iy + 1U) * l->res};
            const aisle_vec2 corners[4] = {lo, {hi.x, lo.y}, hi, {lo.x, hi.y}};
            consider(f, corners, 4U, AISLE_LAYOUT_ID_SCAN);
        }
    }
}

bool aisle_layout_piece_near(const aisle_layout *self, aisle_vec2 p, double cap, aisle_vec2 side, aisle_piece *out) {
    AISLE_ASSERT(aisle_layout_is_in_force(self) && cap >= 0.0);
    facing f = {.layout = self, .p = p, .side = side, .cap = cap, .out = out};
    consider_bounds(&f);
    consider_zones(&f);
    if (aisle_layout_has_scan(self)) {
        consider_scan(&f);
    }
    return f.found;
}

typedef struct pair {
    aisle_vec2 on_a, on_b;
    double gap, off; // m: between them; from the middle to p
} pair;

static void take_pair(pair *best, aisle_vec2 on_a, aisle_vec2 on_b, aisle_vec2 p) {
    double gap = aisle_vec2_distance(on_a, on_b);
    double off = aisle_vec2_distance(aisle_vec2_lerp(on_a, on_b, 0.5), p);
    if (gap < best->gap - SAME || (gap < best->gap + SAME && off < best->off)) {
        *best = (pair){on_a, on_b, gap, off};
    }
}

double aisle_piece_gap(const aisle_piece *a, const aisle_piece *b, aisle_vec2 p, aisle_vec2 *on_a, aisle_vec2 *on_b) {
    pair best = {.gap = (double)INFINITY, .off = (double)INFINITY};
    for (uint32_t i = 0; i < a->n; i++) {
        take_pair(&best, a->v[i], nearest_on_piece(b->v, b->n, a->v[i]), p);
    }
    for (uint32_t i = 0; i < b->n; i++) {
        take_pair(&best, nearest_on_piece(a->v, a->n, b->v[i]), b->v[i], p);
    }
    // Between parallel sides the pair next to p is as near as any.
    aisle_vec2 from = nearest_on_piece(a->v, a->n, p);
    take_pair(&best, from, nearest_on_piece(b->v, b->n, from), p);
    from = nearest_on_piece(b->v, b->n, p);
    take_pair(&best, nearest_on_piece(a->v, a->n, from), from, p);
    *on_a = best.on_a;
    *on_b = best.on_b;
    bool touch = aisle_convex_gap(&(aisle_convex){a->v, a->n, 0.0}, &(aisle_convex){b->v, b->n, 0.0}) <= 0.0;
    return touch ? 0.0 : best.gap;
}
