#include "plan/verify_parts.h"

#include "base/angle.h"
#include "base/check.h"

#define TRAVEL_MIN 1e-3  // m of every body point, below which no interval is halved
#define TRAVEL_FINE 0.02 // m, above which a bent interval is not worth libccd
#define PROOFS_MIN 4U    // of bent intervals, before longer ones are tried
#define LENGTH_MAX 2.0   // m of an interval looked at
#define APART_SPARE 1e-9 // m, and axes shorter than 1e-150 part nothing since their squares are 0

typedef struct sweep { // the footprint at both ends of an interval, and how far the body is to be thought around their
                       // hull
    aisle_vec2 a[AISLE_SHAPE_VERTICES_MAX], b[AISLE_SHAPE_VERTICES_MAX];
    uint32_t n;
    double reach;    // m: rounding, growth, sagittas, epsilon
    double growth;   // m
    bool is_coarse;  // it will be halved if it is not proved at once
    aisle_aabb core; // around a and b
    aisle_aabb box;  // around the body
    aisle_vec2 hull[2 * AISLE_SHAPE_VERTICES_MAX];
    uint32_t hull_n; // 0: not yet made
} sweep;

// ---- building a sweep

static void place(const aisle_verify *self, double u, aisle_vec2 *out, aisle_aabb *core) {
    const aisle_vehicle *vehicle = self->request.vehicle;
    aisle_vec2 origin = aisle_verify_piece_origin(&self->piece, u);
    double sine = 0.0, cosine = 1.0;
    if (self->lever > 0.0) { // else every point is the origin
        aisle_sincos(self->piece.theta + u * self->motion.turn, &sine, &cosine);
    }
    for (uint32_t i = 0; i < vehicle->n; i++) {
        aisle_vec2 v = vehicle->footprint[i];
        out[i] = aisle_vec2_of(origin.x + cosine * v.x - sine * v.y, origin.y + sine * v.x + cosine * v.y);
        core->lo = aisle_vec2_of(aisle_min(core->lo.x, out[i].x), aisle_min(core->lo.y, out[i].y));
        core->hi = aisle_vec2_of(aisle_max(core->hi.x, out[i].x), aisle_max(core->hi.y, out[i].y));
    }
}

// Sagittas of an interval that is the part `du` of the piece: |k| L = 2 phi du on the arc.
static double sagitta(const aisle_verify *self, double du) {
    double arc = self->piece.phi * self->piece.length / 4.0;
    double rotation = self->lever * self->motion.turn * self->motion.turn / 8.0;
    return (arc + rotation) * du * du;
}

static void sweep_over(const aisle_verify *self, double lo, double hi, double growth, sweep *out) {
    out->n = self->request.vehicle->n;
    out->hull_n = 0;
    out->growth = growth;
    out->reach = self->request.vehicle->radius + growth + sagitta(self, hi - lo) + AISLE_VERIFY_EPSILON;
    out->is_coarse = false;
    out->core = (aisle_aabb){{DBL_MAX, DBL_MAX}, {-DBL_MAX, -DBL_MAX}};
    place(self, lo, out->a, &out->core);
    place(self, hi, out->b, &out->core);
    out->box = aisle_aabb_grow(out->core, out->reach);
}

// ---- its hull, wanted only where scan cells are near

static bool is_before(aisle_vec2 a, aisle_vec2 b) {
    return a.x < b.x || (!(a.x > b.x) && a.y < b.y);
}

static void sort(aisle_vec2 *points, uint32_t n) {
    for (uint32_t i = 1; i < n; i++) {
        aisle_vec2 p = points[i];
        uint32_t at = i;
        for (; at > 0 && is_before(p, points[at - 1]); at--) {
            points[at] = points[at - 1];
        }
        points[at] = p;
    }
}

// One chain of the hull behind hull[base]: drops what the way to p leaves on its right or on the line.
static uint32_t chain(aisle_vec2 *hull, uint32_t base, uint32_t n, aisle_vec2 p) {
    while (n > base + 1 &&
           aisle_vec2_cross(aisle_vec2_sub(hull[n - 1], hull[n - 2]), aisle_vec2_sub(p, hull[n - 1])) <= 0.0) {
        n--;
    }
    hull[n] = p;
    return n + 1;
}

// Andrew's monotone chains, lower then upper.
static void make_hull(sweep *self) {
    aisle_vec2 points[2 * AISLE_SHAPE_VERTICES_MAX], hull[2 * AISLE_SHAPE_VERTICES_MAX + 1];
    uint32_t count = 2 * self->n, n = 0;
    for (uint32_t i = 0; i < self->n; i++) {
        points[i] = self->a[i];
        points[self->n + i] = self->b[i];
    }
    sort(points, count);
    for (uint32_t i = 0; i < count; i++) {
        n = chain(hull, 0, n, points[i]);
    }
    uint32_t base = n - 1;
    for (uint32_t i = count - 1; i-- > 0;) {
        n = chain(hull, base, n, points[i]);
    }
    self->hull_n = n > 1 ? n - 1 : 1; // the last is the first again
    AISLE_ASSERT(self->hull_n <= count);
    for (uint32_t i = 0; i < self->hull_n; i++) {
        self->hull[i] = hull[i];
    }
}

// ---- obstacles

typedef struct extent { // along an axis, times the axis's length
    double lo, hi;
} extent;

static extent extent_of(const aisle_vec2 *v, uint32_t n, aisle_vec2 origin, aisle_vec2 axis) {
    extent e = {DBL_MAX, -DBL_MAX};
    for (uint32_t i = 0; i < n; i++) {
        double at = aisle_vec2_dot(aisle_vec2_sub(v[i], origin), axis);
        e.lo = aisle_min(e.lo, at);
        e.hi = aisle_max(e.hi, at);
    }
    return e;
}

// Does a strip across `axis`, wider than the body's reach, lie between the body's points and the obstacle's? Then so it
// does between their hulls. Both are measured, so it does not matter where the axis comes from; APART_SPARE is more than
// what the products round at coordinates within AISLE_SHAPE_COORD_MAX. An axis of no length parts nothing.
static bool is_apart_along(const sweep *s, const aisle_vec2 *v, uint32_t n, aisle_vec2 axis) {
    extent a = extent_of(s->a, s->n, s->a[0], axis), b = extent_of(s->b, s->n, s->a[0], axis);
    extent obstacle = extent_of(v, n, s->a[0], axis);
    double gap = aisle_max(obstacle.lo - aisle_max(a.hi, b.hi), aisle_min(a.lo, b.lo) - obstacle.hi);
    double wanted = s->reach + APART_SPARE;
    return gap > 0.0 && gap * gap > wanted * wanted * aisle_vec2_dot(axis, axis);
}

// From the body's point to the obstacle's that is nearest to it, among their given points.
static aisle_vec2 nearest_way(const sweep *s, const aisle_vec2 *v, uint32_t n) {
    aisle_vec2 best = {0.0, 0.0};
    double least = DBL_MAX;
    for (uint32_t i = 0; i < 2 * s->n; i++) {
        aisle_vec2 p = i < s->n ? s->a[i] : s->b[i - s->n];
        for (uint32_t k = 0; k < n; k++) {
            aisle_vec2 way = aisle_vec2_sub(v[k], p);
            double square = aisle_vec2_dot(way, way);
            best = square < least ? way : best;
            least = aisle_min(square, least);
        }
    }
    return best;
}

static bool is_apart_across_edges(const sweep *s, const aisle_vec2 *v, uint32_t n, const aisle_vec2 *of,
                                  uint32_t count) {
    for (uint32_t i = 0; count > 1 && i < count; i++) {
        aisle_vec2 edge = aisle_vec2_sub(of[i + 1 < count ? i + 1 : 0], of[i]);
        if (is_apart_along(s, v, n, aisle_vec2_of(edge.y, -edge.x))) {
            return true;
        }
    }
    return false;
}

// A cheap proof that they do not touch, for most that do not: across the way driven, along the way between the nearest
// points, across the edges of either. For a disc these are all the axes there are.
static bool is_apart(const sweep *s, const aisle_vec2 *v, uint32_t n) {
    aisle_vec2 way = aisle_vec2_sub(s->b[0], s->a[0]);
    return is_apart_along(s, v, n, aisle_vec2_of(-way.y, way.x)) || is_apart_across_edges(s, v, n, s->a, s->n) ||
           is_apart_across_edges(s, v, n, s->b, s->n) || is_apart_along(s, v, n, nearest_way(s, v, n)) ||
           is_apart_across_edges(s, v, n, v, n);
}

static bool touches(aisle_verify *self, const sweep *s, const aisle_vec2 *v, uint32_t n) {
    if (is_apart(s, v, n)) {
        return false;
    }
    if (s->is_coarse) {
        return true; // or so near that the halves will tell more than a judge of the whole
    }
    aisle_collide_body body = {.a = s->a, .b = s->b, .n = s->n, .radius = s->reach};
    aisle_collide_body obstacle = {.a = v, .b = NULL, .n = n, .radius = 0.0};
    return aisle_collide(&body, &obstacle, &self->collide);
}

static bool touches_box(aisle_verify *self, const sweep *s, aisle_aabb box) {
    aisle_vec2 v[4] = {{box.lo.x, box.lo.y}, {box.hi.x, box.lo.y}, {box.hi.x, box.hi.y}, {box.lo.x, box.hi.y}};
    return touches(self, s, v, 4);
}

static bool is_inside(aisle_aabb a, aisle_aabb b) {
    return a.lo.x >= b.lo.x && a.lo.y >= b.lo.y && a.hi.x <= b.hi.x && a.hi.y <= b.hi.y;
}

static aisle_aabb lattice_box(const aisle_lattice *lattice) {
    return (aisle_aabb){{lattice->x0, lattice->y0},
                        {lattice->x0 + lattice->res * lattice->w, lattice->y0 + lattice->res * lattice->h}};
}

// The bounds are a box, so the body is inside if its box is. Where there is a scan, what lies off it is unknown.
static bool leaves_bounds(const aisle_verify *self, const sweep *s) {
    const aisle_layout *layout = self->request.layout;
    if (!is_inside(s->box, aisle_layout_bounds(layout))) {
        return true;
    }
    return aisle_layout_has_scan(layout) && !is_inside(s->box, lattice_box(&aisle_layout_grid(layout)->lattice));
}

// Off a zone that is slower than the piece the footprint alone is to be kept.
static bool touches_slow_zone(aisle_verify *self, sweep *s, const aisle_zone *zone, const aisle_convex *shape) {
    if (!self->motion.heeds_limits || self->piece.peak <= (double)zone->value * (1.0 + VERIFY_TOLERANCE)) {
        return false;
    }
    const double reach = s->reach;
    s->reach = reach - s->growth;
    const bool touching = touches(self, s, shape->v, shape->n);
    s->reach = reach;
    return touching;
}

static bool touches_polygon(aisle_verify *self, sweep *s, int32_t *id) {
    const aisle_layout *layout = self->request.layout;
    const aisle_zone *zone;
    for (aisle_layout_walk walk = aisle_layout_walk_over(layout, s->box); aisle_layout_walk_next(&walk, &zone);) {
        const bool is_solid = zone->kind == AISLE_POLYGON_OBSTACLE || zone->kind == AISLE_POLYGON_KEEPOUT;
        if ((!is_solid && zone->kind != AISLE_POLYGON_SPEED_LIMIT) || !aisle_aabb_overlap(zone->box, s->box)) {
            continue;
        }
        aisle_convex shape = aisle_layout_zone_shape(layout, zone);
        if (is_solid ? touches(self, s, shape.v, shape.n) : touches_slow_zone(self, s, zone, &shape)) {
            *id = zone->id;
            return true;
        }
    }
    return false;
}

// ---- scan

typedef struct span { // of numbers or cells [lo, hi]; empty if lo > hi
    double lo, hi;
} span;

static void widen(span *x, double by) {
    x->lo = aisle_min(x->lo, by);
    x->hi = aisle_max(x->hi, by);
}

// Where edge p-q runs within the band of y, in x.
static void clip_edge(aisle_vec2 p, aisle_vec2 q, span y, span *x) {
    if ((p.y < y.lo && q.y < y.lo) || (p.y > y.hi && q.y > y.hi)) {
        return;
    }
    double rise = q.y - p.y, run = q.x - p.x;
    double p_to = aisle_clamp(p.y, y.lo, y.hi), q_to = aisle_clamp(q.y, y.lo, y.hi);
    bool p_in = !(p.y < y.lo || p.y > y.hi), q_in = !(q.y < y.lo || q.y > y.hi);
    widen(x, p_in ? p.x : p.x + run * ((p_to - p.y) / rise)); // an end outside: the edge crosses, rise is not 0
    widen(x, q_in ? q.x : p.x + run * ((q_to - p.y) / rise));
}

// Where in x the body can be within the row [y.lo, y.hi]: the hull within the row grown by the reach, grown by the
// reach.
static span row_span(sweep *s, span y) {
    span band = {y.lo - s->reach, y.hi + s->reach}, x = {DBL_MAX, -DBL_MAX};
    if (s->hull_n == 0) {
        make_hull(s);
    }
    for (uint32_t i = 0; i < s->hull_n; i++) {
        clip_edge(s->hull[i], s->hull[i + 1 < s->hull_n ? i + 1 : 0], band, &x);
    }
    return (span){x.lo - s->reach, x.hi + s->reach};
}

// Cell of a coordinate on one axis, clamped.
static uint32_t cell_at(double at, double origin, double res, uint32_t count) {
    double cell = floor((at - origin) / res);
    if (!(cell > 0.0)) {
        return 0;
    }
    return cell < (double)(count - 1) ? (uint32_t)cell : count - 1;
}

// Cells [from, end) of row iy are occupied; what the body cannot reach of them is cut away.
static bool touches_run(aisle_verify *self, sweep *s, uint32_t iy, uint32_t from, uint32_t end) {
    const aisle_lattice *lattice = &aisle_layout_grid(self->request.layout)->lattice;
    double res = lattice->res;
    span y = {lattice->y0 + res * iy, lattice->y0 + res * (iy + 1.0)}, x = row_span(s, y);
    span run = {lattice->x0 + res * from, lattice->x0 + res * end};
    if (x.lo > x.hi || run.hi < x.lo || run.lo > x.hi) {
        return false;
    }
    // Cut at cell borders: a short box is as good as a long one and keeps the narrow phase well conditioned.
    uint32_t first = cell_at(x.lo, lattice->x0, res, lattice->w), last = cell_at(x.hi, lattice->x0, res, lattice->w);
    run.lo = aisle_max(run.lo, lattice->x0 + res * first);
    run.hi = aisle_min(run.hi, lattice->x0 + res * (last + 1.0));
    return touches_box(self, s, (aisle_aabb){{run.lo, y.lo}, {run.hi, y.hi}});
}

static bool touches_row(aisle_verify *self, sweep *s, uint32_t iy, uint32_t from, uint32_t to) {
    uint32_t end;
    for (uint32_t ix = from; aisle_layout_scan_run(self->request.layout, iy, &ix, to, &end); ix = end) {
        AISLE_ASSERT(ix >= from && ix < end && end <= to);
        if (touches_run(self, s, iy, ix, end)) {
            return true;
        }
    }
    return false;
}

static bool touches_scan(aisle_verify *self, sweep *s) {
    const aisle_lattice *lattice = &aisle_layout_grid(self->request.layout)->lattice;
    if (!aisle_layout_has_scan(self->request.layout)) {
        return false;
    }
    uint32_t x0 = cell_at(s->box.lo.x, lattice->x0, lattice->res, lattice->w);
    uint32_t x1 = cell_at(s->box.hi.x, lattice->x0, lattice->res, lattice->w);
    uint32_t y1 = cell_at(s->box.hi.y, lattice->y0, lattice->res, lattice->h);
    for (uint32_t iy = cell_at(s->box.lo.y, lattice->y0, lattice->res, lattice->h); iy <= y1; iy++) {
        if (touches_row(self, s, iy, x0, x1 + 1)) {
            return true;
        }
    }
    return false;
}

static bool is_free(aisle_verify *self, sweep *s, int32_t *id) {
    if (leaves_bounds(self, s)) {
        *id = AISLE_LAYOUT_ID_BOUNDS;
        return false;
    }
    if (touches_polygon(self, s, id)) {
        return false;
    }
    *id = AISLE_LAYOUT_ID_SCAN;
    return !touches_scan(self, s);
}

// ---- intervals

void aisle_verify_motion_begin(aisle_verify *self) {
    const aisle_vehicle *vehicle = self->request.vehicle;
    aisle_verify_motion *motion = &self->motion;
    bool fast = self->piece.peak > vehicle->creep_speed * (1.0 + VERIFY_TOLERANCE);
    motion->margin = aisle_max(vehicle->margin, 0.0);
    motion->growth = motion->margin;
    if (fast) {
        motion->growth = aisle_max(motion->margin, vehicle->creep_clearance * (1.0 - VERIFY_TOLERANCE));
    }
    motion->heeds_limits = aisle_layout_has_kind(self->request.layout, AISLE_POLYGON_SPEED_LIMIT);
    motion->turn = self->piece.turn;
    motion->lo = 0.0;
    motion->hi[0] = 1.0;
    motion->depth = 1;
}

static void halve(aisle_verify_motion *motion, double hi) {
    AISLE_ASSERT(motion->depth < AISLE_VERIFY_DEPTH);
    motion->hi[motion->depth++] = 0.5 * (motion->lo + hi);
}

// The interval in front is proved: the next one, or the piece the other way round.
static aisle_status advance(aisle_verify *self) {
    aisle_verify_motion *motion = &self->motion;
    motion->lo = motion->hi[--motion->depth];
    if (motion->depth > 0) {
        return AISLE_BUSY;
    }
    if (fabs(motion->turn - self->piece.turn_other) <= 1.0) { // the two ways differ by 2 pi
        return AISLE_OK;
    }
    motion->turn = self->piece.turn_other;
    motion->lo = 0.0;
    motion->hi[0] = 1.0;
    motion->depth = 1;
    return AISLE_BUSY;
}

// Too close at any speed, too fast for what is near, or for a zone?
static aisle_status blame(aisle_verify *self, double lo, double hi, int32_t id) {
    aisle_verify_motion *motion = &self->motion;
    sweep s;
    self->fault = AISLE_VERIFY_COLLISION;
    self->fault_at = aisle_verify_piece_origin(&self->piece, 0.5 * (lo + hi));
    motion->heeds_limits = false;
    sweep_over(self, lo, hi, motion->margin, &s);
    if (is_free(self, &s, &self->fault_id)) {
        sweep_over(self, lo, hi, motion->growth, &s);
        self->fault = AISLE_VERIFY_CREEP;
        if (is_free(self, &s, &self->fault_id)) {
            self->fault = AISLE_VERIFY_ZONE_SPEED;
            self->fault_id = id;
        }
    }
    return AISLE_ERR_DATA;
}

// What a look at a bent interval taught of how long the next ones may be. Any limit proves the same.
static void learn(aisle_verify_motion *motion, double travel, bool was_proved) {
    if (!was_proved) {
        motion->limit = aisle_max(0.75 * travel, TRAVEL_FINE);
        motion->proved = 0;
    } else if (++motion->proved == PROOFS_MIN) {
        motion->limit *= 2.0;
        motion->proved = 0;
    }
}

aisle_status aisle_verify_motion_step(aisle_verify *self) {
    aisle_verify_motion *motion = &self->motion;
    AISLE_ASSERT(motion->depth > 0);
    double lo = motion->lo, hi = motion->hi[motion->depth - 1];
    double length = self->piece.length * (hi - lo);
    double travel = length + self->lever * fabs(motion->turn) * (hi - lo);
    int32_t id = 0;
    sweep s;
    self->intervals++;
    bool bent = sagitta(self, hi - lo) > 0.0;
    if (length > LENGTH_MAX || (bent && motion->limit > 0.0 && travel > motion->limit)) {
        halve(motion, hi);
        return AISLE_BUSY;
    }
    sweep_over(self, lo, hi, motion->growth, &s);
    s.is_coarse = travel > TRAVEL_FINE && bent;
    bool is_clear = is_free(self, &s, &id);
    if (bent) {
        learn(motion, travel, is_clear);
    }
    if (is_clear) {
        return advance(self);
    }
    if (travel < TRAVEL_MIN) {
        return blame(self, lo, hi, id);
    }
    halve(motion, hi);
    return AISLE_BUSY;
}
