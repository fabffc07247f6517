#include "plan/tangent_parts.h"

#include "base/check.h"

#include <math.h>

#define ANGLE_TOUCH 1e-9 // relative: a line along an edge counts as tangent to both of its corners

#define ASIDE_TOUCH 1e-6 // m, what the view's rim touches within the circles is not aside

typedef struct view { // from the node under way
    aisle_tangent *self;
    uint32_t from;
    aisle_circle circle;
    bool all_round; // the start: every direction
    double side;    // +1: directions turn left from `first` to `last`, -1: right
    aisle_vec2 first, last;
    aisle_vec2 first_at, last_at; // contacts of the two
    uint32_t stamp;
    uint32_t open_bin; // not hidden when last looked at
    aisle_status st;
} view;

// Bin of a direction: monotone in its angle, from x to the left.
static uint32_t bin_of(aisle_vec2 d) {
    double r = d.y / (fabs(d.x) + fabs(d.y)); // never (0, 0): a direction, of any length
    double quarter = d.x < 0.0 ? 2.0 - r : (d.y < 0.0 ? 4.0 + r : r);
    uint32_t bin = (uint32_t)(quarter * (double)(AISLE_TANGENT_BINS / 4U));
    return bin < AISLE_TANGENT_BINS ? bin : AISLE_TANGENT_BINS - 1U;
}

// Is d between a and b, turning by side from a to b (by less than half a turn)?
static bool is_between(aisle_vec2 a, aisle_vec2 b, aisle_vec2 d, double side) {
    double tolerance_a = ANGLE_TOUCH * (fabs(a.x) + fabs(a.y));
    double tolerance_b = ANGLE_TOUCH * (fabs(b.x) + fabs(b.y));
    return side * aisle_vec2_cross(a, d) >= -tolerance_a && side * aisle_vec2_cross(d, b) >= -tolerance_b &&
           (aisle_vec2_dot(a, d) > 0.0 || aisle_vec2_dot(b, d) > 0.0);
}

static void hide(float *depth, uint32_t bin, float beyond) {
    depth[bin] = depth[bin] < beyond ? depth[bin] : beyond;
}

// An obstacle hides what lies strictly between its right and its left tangent, from `beyond` on.
static void hide_between(view *v, aisle_vec2 right, aisle_vec2 left, double beyond) {
    if (aisle_vec2_cross(right, left) <= 0.0) {
        return;
    }
    uint32_t last = bin_of(left);
    for (uint32_t bin = (bin_of(right) + 1U) % AISLE_TANGENT_BINS;
         bin != last && bin != (last + 1U) % AISLE_TANGENT_BINS; bin = (bin + 1U) % AISLE_TANGENT_BINS) {
        hide(v->self->depth, bin, (float)beyond);
    }
}

static void reset_depth(view *v) {
    float *depth = v->self->depth;
    for (uint32_t i = 0; i < AISLE_TANGENT_BINS; i++) {
        depth[i] = v->all_round ? INFINITY : 0.0F;
    }
    if (v->all_round) {
        return;
    }
    uint32_t right = bin_of(v->side > 0.0 ? v->first : v->last);
    uint32_t left = bin_of(v->side > 0.0 ? v->last : v->first);
    for (uint32_t bin = right;; bin = (bin + 1U) % AISLE_TANGENT_BINS) {
        depth[bin] = INFINITY;
        if (bin == left) {
            break;
        }
    }
}

// Looks first where it found a direction open the last time.
static bool is_all_hidden(view *v, double distance) {
    for (uint32_t i = 0; i < AISLE_TANGENT_BINS; i++) {
        uint32_t bin = (v->open_bin + i) % AISLE_TANGENT_BINS;
        if ((double)v->self->depth[bin] >= distance) {
            v->open_bin = bin;
            return false;
        }
    }
    return true;
}

static void offer(view *v, const aisle_tangent_node *to, const aisle_tangent_line *line) {
    if (!v->all_round && !is_between(v->first, v->last, line->d, v->side)) {
        return;
    }
    if ((double)v->self->depth[bin_of(line->d)] < line->length || v->st != AISLE_OK) {
        return;
    }
    v->st = aisle_tangent_push(v->self, v->from, to, line->length);
}

typedef struct box { // of an obstacle
    aisle_vec2 centre, half;
} box;

static double reach_along(const box *b, aisle_vec2 d) {
    return b->half.x * fabs(d.x) + b->half.y * fabs(d.y);
}

// Does the box lie beside all that lines of the view sweep?
static bool is_aside(const view *v, const box *b) {
    const double radius = v->self->radius + ASIDE_TOUCH;
    return !v->all_round && (v->side * aisle_vec2_cross(v->first, aisle_vec2_sub(b->centre, v->first_at)) <
                                 -radius - reach_along(b, aisle_turned_left(v->first)) ||
                             v->side * aisle_vec2_cross(v->last, aisle_vec2_sub(b->centre, v->last_at)) >
                                 radius + reach_along(b, aisle_turned_left(v->last)));
}

// Is every direction to the box hidden nearer than the box begins? Lines begin and end up to a radius aside.
static bool is_hidden(const view *v, const box *b) {
    aisle_vec2 to = aisle_vec2_sub(b->centre, v->circle.centre);
    double away = aisle_vec2_length(to);
    aisle_vec2 d = away > 0.0 ? aisle_vec2_scale(to, 1.0 / away) : aisle_vec2_of(1.0, 0.0);
    aisle_vec2 n = aisle_turned_left(d);
    double near = away - reach_along(b, d) - 2.0 * v->self->radius;
    double wide = reach_along(b, n) + 2.0 * v->self->radius;
    if (near <= 0.0) {
        return false;
    }
    uint32_t bin = bin_of(aisle_vec2_sub(aisle_vec2_scale(d, near), aisle_vec2_scale(n, wide)));
    uint32_t last = bin_of(aisle_vec2_add(aisle_vec2_scale(d, near), aisle_vec2_scale(n, wide)));
    while ((double)v->self->depth[bin] < near && bin != last) {
        bin = (bin + 1U) % AISLE_TANGENT_BINS;
    }
    return (double)v->self->depth[bin] < near;
}

typedef struct sight { // of one obstacle
    aisle_tangent_line right, left;
    uint32_t rights, lefts;
} sight;

// The lines to both sides of vertex i of the block.
static void look_at_corner(view *v, uint32_t index, const aisle_layout_block *block, uint32_t i, sight *s) {
    const aisle_convex *shape = &block->shape;
    aisle_vec2 w = shape->v[i];
    aisle_vec2 in = aisle_vec2_sub(w, shape->v[i > 0U ? i - 1U : shape->n - 1U]);
    aisle_vec2 out = aisle_vec2_sub(shape->v[i + 1U < shape->n ? i + 1U : 0U], w);
    for (uint32_t k = 0; k < 2U; k++) {
        double side = k == 0U ? 1.0 : -1.0;
        aisle_tangent_node to = {.centre = w,
                                 .rho = side * v->self->radius,
                                 .corner = 2U * (block->corner + i) + k,
                                 .block = index,
                                 .at = i};
        aisle_tangent_line line;
        bool touches = aisle_tangent_between(v->circle, aisle_node_circle(&to), &line) &&
                       (k == 0U ? is_between(in, out, line.d, 1.0)
                                : is_between(aisle_vec2_scale(out, -1.0), aisle_vec2_scale(in, -1.0), line.d, -1.0));
        if (!touches) {
            continue;
        }
        *(k == 0U ? &s->right : &s->left) = line;
        *(k == 0U ? &s->rights : &s->lefts) += 1U;
        to.d = line.d;
        if ((block->real >> i & 1U) != 0U) {
            offer(v, &to, &line);
        }
    }
}

static void look_at_block(view *v, uint32_t index) {
    v->self->quarters++;
    const aisle_aabb bounds = aisle_layout_block_box(v->self->layout, index);
    const box around = {aisle_vec2_lerp(bounds.lo, bounds.hi, 0.5),
                        aisle_vec2_scale(aisle_vec2_sub(bounds.hi, bounds.lo), 0.5)};
    if (is_aside(v, &around) || is_hidden(v, &around)) {
        return;
    }
    aisle_layout_block block;
    aisle_layout_block_at(v->self->layout, index, &block);
    if (!aisle_tangent_counts(v->self, index, &block)) {
        return;
    }
    sight s = {.rights = 0};
    for (uint32_t i = 0; i < block.shape.n; i++) {
        look_at_corner(v, index, &block, i, &s);
    }
    // One tangent on either side: it is seen from outside as a convex thing is.
    if (s.rights == 1U && s.lefts == 1U && v->self->nodes[v->from].block != index) {
        double beyond = aisle_max(s.right.length, s.left.length) + 2.0 * v->self->radius;
        hide_between(v, s.right.d, s.left.d, beyond);
    }
    v->self->quarters += 7U;
}

static void look_at_bucket(view *v, uint32_t bx, uint32_t by) {
    const aisle_layout_index *wide = aisle_layout_wide(v->self->layout);
    uint32_t bucket = by * wide->nx + bx;
    const box around = {aisle_vec2_of(wide->lo.x + (bx + 0.5) * wide->side, wide->lo.y + (by + 0.5) * wide->side),
                        aisle_vec2_of(0.5 * wide->side, 0.5 * wide->side)};
    bool is_rim = bx == 0U || by == 0U || bx + 1U == wide->nx || by + 1U == wide->ny; // lists what lies outside, too
    if (!is_rim && is_aside(v, &around)) {
        return;
    }
    for (uint32_t at = wide->starts[bucket]; at < wide->starts[bucket + 1U]; at++) {
        uint32_t index = wide->entries[at];
        if (v->self->seen[index] != v->stamp) {
            v->self->seen[index] = v->stamp;
            look_at_block(v, index);
        }
    }
}

// Buckets of the ring `r` about bucket (cx, cy), those that there are. False: none.
static bool look_at_ring(view *v, int64_t cx, int64_t cy, int64_t r) {
    const aisle_layout_index *wide = aisle_layout_wide(v->self->layout);
    int64_t nx = wide->nx;
    int64_t ny = wide->ny;
    bool any = false;
    for (int64_t y = cy - r > 0 ? cy - r : 0; y <= cy + r && y < ny; y++) {
        bool whole_row = y == cy - r || y == cy + r;
        int64_t step = whole_row || r == 0 ? 1 : 2 * r;
        for (int64_t x = cx - r; x <= cx + r; x += step) {
            if (x >= 0 && x < nx) {
                any = true;
                look_at_bucket(v, (uint32_t)x, (uint32_t)y);
            }
        }
    }
    return any;
}

static void look_around(view *v) {
    const aisle_layout_index *wide = aisle_layout_wide(v->self->layout);
    aisle_bucket_range at = aisle_layout_index_range(wide, (aisle_aabb){v->circle.centre, v->circle.centre});
    for (int64_t r = 0; look_at_ring(v, at.x0, at.y0, r); r++) {
        // What the next ring brings first is at least r buckets away, less what the circles take.
        if (is_all_hidden(v, (double)r * wide->side - 2.0 * v->self->radius)) {
            break;
        }
    }
}

static void look_at_goal(view *v) {
    aisle_tangent_line line;
    aisle_circle goal = {v->self->goal, 0.0};
    if (aisle_tangent_between(v->circle, goal, &line)) {
        aisle_tangent_node to = {
            .centre = goal.centre, .d = line.d, .corner = AISLE_TANGENT_NONE, .block = AISLE_TANGENT_NONE};
        offer(v, &to, &line);
    }
}

aisle_status aisle_tangent_see(aisle_tangent *self, uint32_t from) {
    const aisle_tangent_node *node = &self->nodes[from];
    view v = {.self = self,
              .from = from,
              .circle = aisle_node_circle(node),
              .all_round = node->corner == AISLE_TANGENT_NONE,
              .side = aisle_node_side(node),
              .first = node->d,
              .stamp = aisle_tangent_stamp(self),
              .st = AISLE_OK};
    if (!v.all_round) {
        aisle_layout_block block;
        aisle_layout_block_at(self->layout, node->block, &block);
        const aisle_convex shape = block.shape;
        uint32_t i = node->at;
        uint32_t after = v.side > 0.0 ? (i + 1U < shape.n ? i + 1U : 0U) : (i > 0U ? i - 1U : shape.n - 1U);
        aisle_vec2 edge = aisle_vec2_sub(shape.v[after], shape.v[i]);
        double length = aisle_vec2_length(edge);
        v.last = length > 0.0 ? aisle_vec2_scale(edge, 1.0 / length) : node->d;
        v.first_at = aisle_contact(v.circle, v.first);
        v.last_at = aisle_contact(v.circle, v.last);
    }
    reset_depth(&v);
    bool is_straight = v.all_round && aisle_tangent_line_free(self, self->radius, v.circle.centre, self->goal);
    if (!is_straight) { // else nothing can be shorter than the line to the goal
        look_around(&v);
    }
    look_at_goal(&v);
    return v.st;
}
