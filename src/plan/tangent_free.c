#include "plan/tangent_parts.h"

#include "base/angle.h"
#include "base/check.h"

#include <math.h>

#define BUCKET_TOUCH 1e-6 // m, what rounding may add to a bucket's side
#define TURN_MIN 1e-3     // rad, of a step along an arc that touches something

typedef struct straight { // the way of a disc from p on
    aisle_vec2 p, q, d;
    double length, radius; // radius: nearer than this is contact
} straight;

// Exact: the way against one convex polygon.
static bool is_clear_of(const straight *way, const aisle_convex *shape) {
    double left = (double)INFINITY; // least distance to the left of the way's line, and least to its right
    double right = (double)INFINITY;
    double ahead = -(double)INFINITY;
    double behind = (double)INFINITY;
    for (uint32_t i = 0; i < shape->n; i++) {
        aisle_vec2 to = aisle_vec2_sub(shape->v[i], way->p);
        double off = aisle_vec2_cross(way->d, to);
        double along = aisle_vec2_dot(way->d, to);
        left = aisle_min(left, off);
        right = aisle_min(right, -off);
        ahead = aisle_max(ahead, along);
        behind = aisle_min(behind, along);
    }
    if (left >= way->radius || right >= way->radius || ahead <= -way->radius || behind >= way->length + way->radius) {
        return true;
    }
    aisle_vec2 ends[2] = {way->p, way->q};
    aisle_convex segment = {ends, 2U, 0.0};
    double gap = aisle_convex_gap(&segment, shape);
    return gap > 0.0 && gap >= way->radius; // a way through a polygon has no gap
}

static bool is_block_clear(aisle_tangent *self, const straight *way, uint32_t index) {
    self->quarters++;
    const aisle_aabb box = aisle_layout_block_box(self->layout, index);
    aisle_vec2 centre = aisle_vec2_lerp(box.lo, box.hi, 0.5);
    double aside = fabs(aisle_vec2_cross(way->d, aisle_vec2_sub(centre, way->p)));
    double half = 0.5 * ((box.hi.x - box.lo.x) * fabs(way->d.y) + (box.hi.y - box.lo.y) * fabs(way->d.x));
    if (aside > half + way->radius) {
        return true;
    }
    aisle_layout_block block;
    aisle_layout_block_at(self->layout, index, &block);
    self->quarters += 3U;
    return !aisle_tangent_counts(self, index, &block) || is_clear_of(way, &block.shape);
}

// Every block of a bucket that was not looked at under this stamp.
static bool is_bucket_clear(aisle_tangent *self, const straight *way, uint32_t bucket, uint32_t stamp) {
    const aisle_layout_index *wide = aisle_layout_wide(self->layout);
    for (uint32_t at = wide->starts[bucket]; at < wide->starts[bucket + 1U]; at++) {
        uint32_t index = wide->entries[at];
        if (self->seen[index] != stamp) {
            self->seen[index] = stamp;
            if (!is_block_clear(self, way, index)) {
                return false;
            }
        }
    }
    return true;
}

// Bucket columns in the order of the motion; in each the rows that the disc meets there.
bool aisle_tangent_line_free(aisle_tangent *self, double radius, aisle_vec2 p, aisle_vec2 q) {
    const aisle_layout_index *wide = aisle_layout_wide(self->layout);
    straight way = {.p = p, .q = q, .d = {1.0, 0.0}, .length = aisle_vec2_distance(p, q)};
    way.radius = radius - AISLE_TANGENT_TOUCH; // below 0 for a point: its line may dip in by so much
    if (way.length > 0.0) {
        way.d = aisle_vec2_scale(aisle_vec2_sub(q, p), 1.0 / way.length);
    }
    double reach = radius + BUCKET_TOUCH;
    uint32_t stamp = aisle_tangent_stamp(self);
    aisle_aabb box = {{aisle_min(p.x, q.x), aisle_min(p.y, q.y)}, {aisle_max(p.x, q.x), aisle_max(p.y, q.y)}};
    aisle_bucket_range all = aisle_layout_index_range(wide, aisle_aabb_grow(box, reach));
    double slope = fabs(way.d.x) > 1e-9 ? way.d.y / way.d.x : 0.0;
    bool steep = fabs(way.d.x) <= 1e-9;
    for (uint32_t k = all.x0; k <= all.x1; k++) {
        uint32_t x = way.d.x >= 0.0 ? k : all.x0 + all.x1 - k;
        double x0 = aisle_clamp(wide->lo.x + x * wide->side - reach, box.lo.x, box.hi.x);
        double x1 = aisle_clamp(wide->lo.x + (x + 1U) * wide->side + reach, box.lo.x, box.hi.x);
        double y0 = steep ? box.lo.y : p.y + (x0 - p.x) * slope;
        double y1 = steep ? box.hi.y : p.y + (x1 - p.x) * slope;
        aisle_aabb part = {{x0, aisle_min(y0, y1) - reach}, {x1, aisle_max(y0, y1) + reach}};
        aisle_bucket_range rows = aisle_layout_index_range(wide, part);
        for (uint32_t y = rows.y0; y <= rows.y1; y++) {
            if (!is_bucket_clear(self, &way, y * wide->nx + x, stamp)) {
                return false;
            }
        }
    }
    return true;
}

// ---- arcs

typedef struct bend {
    aisle_circle about;
    aisle_vec2 from, to;
    double angle; // turned by, rad
    double side;
} bend;

// Does the arc leave the allowed box between its ends? It bulges there only where its motion is along a side of the box.
static bool is_within(const aisle_tangent *self, double radius, const bend *arc) {
    static const aisle_vec2 along[4] = {{1.0, 0.0}, {0.0, 1.0}, {-1.0, 0.0}, {0.0, -1.0}};
    aisle_aabb allowed = aisle_aabb_grow(aisle_layout_bounds(self->layout), AISLE_TANGENT_TOUCH - radius);
    for (int i = 0; i < 4; i++) {
        bool passes = arc->side * aisle_vec2_cross(arc->from, along[i]) > 0.0 &&
                      arc->side * aisle_vec2_cross(along[i], arc->to) > 0.0;
        aisle_vec2 p = aisle_contact(arc->about, along[i]);
        if (passes && (p.x < allowed.lo.x || p.x > allowed.hi.x || p.y < allowed.lo.y || p.y > allowed.hi.y)) {
            return false;
        }
    }
    return true;
}

// Steps along the arc as far as the gap at hand allows.
static bool is_arc_clear_of(const bend *arc, double radius, const aisle_convex *shape) {
    double keep = aisle_max(radius - AISLE_TANGENT_TOUCH, 0.0);
    double turned = 0.0;
    while (turned < arc->angle) {
        double sine, cosine;
        aisle_sincos(arc->side * turned, &sine, &cosine);
        aisle_vec2 d =
            aisle_vec2_add(aisle_vec2_scale(arc->from, cosine), aisle_vec2_scale(aisle_turned_left(arc->from), sine));
        double gap = aisle_convex_point_gap(shape, aisle_contact(arc->about, d));
        if (gap < keep) {
            return false;
        }
        turned += aisle_max((gap - keep) / radius, TURN_MIN);
    }
    return true;
}

static bool is_arc_clear_in(aisle_tangent *self, double radius, const bend *arc, uint32_t bucket, uint32_t stamp) {
    const aisle_layout_index *wide = aisle_layout_wide(self->layout);
    aisle_aabb near = aisle_aabb_grow((aisle_aabb){arc->about.centre, arc->about.centre}, 2.0 * radius);
    for (uint32_t at = wide->starts[bucket]; at < wide->starts[bucket + 1U]; at++) {
        uint32_t index = wide->entries[at];
        if (self->seen[index] == stamp || !aisle_aabb_overlap(near, aisle_layout_block_box(self->layout, index))) {
            continue;
        }
        self->seen[index] = stamp;
        aisle_layout_block block;
        aisle_layout_block_at(self->layout, index, &block);
        self->quarters += 4U;
        if (aisle_tangent_counts(self, index, &block) &&
            aisle_convex_point_gap(&block.shape, arc->about.centre) < 2.0 * radius &&
            !is_arc_clear_of(arc, radius, &block.shape)) {
            return false;
        }
    }
    return true;
}

bool aisle_tangent_arc_free(aisle_tangent *self, double radius, const aisle_tangent_node *node, aisle_vec2 from,
                            aisle_vec2 to) {
    double side = aisle_node_side(node);
    bend arc = {.about = {node->centre, side * radius}, .from = from, .to = to, .side = side};
    if (radius <= 0.0) {
        return true;
    }
    arc.angle = aisle_arc_length(arc.about, from, to) / radius;
    if (!is_within(self, radius, &arc)) {
        return false;
    }
    const aisle_layout_index *wide = aisle_layout_wide(self->layout);
    aisle_aabb near = aisle_aabb_grow((aisle_aabb){node->centre, node->centre}, 2.0 * radius);
    aisle_bucket_range r = aisle_layout_index_range(wide, near);
    uint32_t stamp = aisle_tangent_stamp(self);
    self->seen[node->block] = stamp; // the corner's own block lies behind the arc all along
    for (uint32_t y = r.y0; y <= r.y1; y++) {
        for (uint32_t x = r.x0; x <= r.x1; x++) {
            if (!is_arc_clear_in(self, radius, &arc, y * wide->nx + x, stamp)) {
                return false;
            }
        }
    }
    return true;
}
