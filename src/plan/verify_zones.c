#include "plan/verify_parts.h"

#include "base/angle.h"
#include "base/check.h"

#define DEPTH 1e-6       // m inside a zone
#define SAGITTA_MIN 4e-7 // m, below which no interval is halved

// Does the way from a to b have a part that lies deeper than `depth` inside the convex outline? Negative: outside by
// less. Edge by edge the part left is clipped.
static bool runs_inside(aisle_vec2 a, aisle_vec2 b, const aisle_convex *outline, double depth) {
    double from = 0.0, to = 1.0;
    for (uint32_t i = 0; i < outline->n; i++) {
        aisle_vec2 v = outline->v[i], edge = aisle_vec2_sub(outline->v[i + 1 < outline->n ? i + 1 : 0], v);
        double length = aisle_vec2_length(edge);
        if (!(length > 0.0)) {
            continue;
        }
        double at_a = aisle_vec2_cross(edge, aisle_vec2_sub(a, v)) / length - depth; // > 0 inside: counter-clockwise
        double at_b = aisle_vec2_cross(edge, aisle_vec2_sub(b, v)) / length - depth;
        if (at_a <= 0.0 && at_b <= 0.0) {
            return false;
        }
        if (at_a < 0.0) {
            from = aisle_max(from, at_a / (at_a - at_b));
        } else if (at_b < 0.0) {
            to = aisle_min(to, at_a / (at_a - at_b));
        }
    }
    return from < to;
}

// Does the part [lo, hi] of the piece run inside? Depth first, the next on top.
static bool enters(aisle_verify *self, const aisle_convex *outline, double lo, double hi) {
    const aisle_verify_piece *piece = &self->piece;
    double end[AISLE_VERIFY_DEPTH];
    uint32_t depth = 1;
    end[0] = hi;
    while (depth > 0) {
        double to = end[depth - 1], part = to - lo;
        double sagitta = piece->phi * piece->length / 4.0 * part * part;
        aisle_vec2 a = aisle_verify_piece_origin(piece, lo), b = aisle_verify_piece_origin(piece, to);
        self->intervals++;
        if (!runs_inside(a, b, outline, DEPTH - sagitta)) {
            lo = to;
            depth--;
        } else if (sagitta <= SAGITTA_MIN || depth == AISLE_VERIFY_DEPTH) {
            self->fault_at = aisle_vec2_lerp(a, b, 0.5);
            return true;
        } else {
            end[depth++] = lo + 0.5 * part;
        }
    }
    return false;
}

// The part of the piece whose direction is against the zone's, round `turns` times: course + side phi (2 u - 1) within
// (90, 270) degrees of it. False: none.
static bool against(const aisle_verify_piece *piece, double direction, double turns, double *lo, double *hi) {
    double least = 0.5 * AISLE_PI + AISLE_VERIFY_AGAINST + 2.0 * AISLE_PI * turns;
    double most = 1.5 * AISLE_PI - AISLE_VERIFY_AGAINST + 2.0 * AISLE_PI * turns;
    double first = aisle_angle_wrap(aisle_verify_piece_direction(piece, false) - direction);
    double turn = 2.0 * piece->side * piece->phi;
    if (!(fabs(turn) > 0.0)) {
        *lo = 0.0;
        *hi = 1.0;
        return first > least && first < most;
    }
    double a = (least - first) / turn, b = (most - first) / turn;
    *lo = aisle_max(aisle_min(a, b), 0.0);
    *hi = aisle_min(aisle_max(a, b), 1.0);
    return *lo < *hi;
}

static bool goes_against(aisle_verify *self, const aisle_zone *zone) {
    const aisle_convex outline = aisle_layout_zone_shape(self->request.layout, zone);
    double lo, hi;
    for (int turns = -1; turns <= 0;
         turns++) { // the course is within half a turn of the zone's, and turns by half a one
        if (against(&self->piece, (double)zone->direction, turns, &lo, &hi) && enters(self, &outline, lo, hi)) {
            return true;
        }
    }
    return false;
}

aisle_verify_fault aisle_verify_direction_fault(aisle_verify *self) {
    const aisle_layout *layout = self->request.layout;
    const aisle_verify_piece *piece = &self->piece;
    if (piece->on_spot || !aisle_layout_has_kind(layout, AISLE_POLYGON_DIRECTED)) {
        return AISLE_VERIFY_NONE;
    }
    aisle_vec2 a = aisle_verify_piece_origin(piece, 0.0), b = aisle_verify_piece_origin(piece, 1.0);
    aisle_aabb box = {{aisle_min(a.x, b.x), aisle_min(a.y, b.y)}, {aisle_max(a.x, b.x), aisle_max(a.y, b.y)}};
    box = aisle_aabb_grow(box, piece->phi * piece->length / 4.0 + AISLE_VERIFY_EPSILON);
    const aisle_zone *zone;
    for (aisle_layout_walk walk = aisle_layout_walk_over(layout, box); aisle_layout_walk_next(&walk, &zone);) {
        if (zone->kind == AISLE_POLYGON_DIRECTED && goes_against(self, zone)) {
            self->fault_id = zone->id;
            return AISLE_VERIFY_DIRECTION;
        }
    }
    return AISLE_VERIFY_NONE;
}
