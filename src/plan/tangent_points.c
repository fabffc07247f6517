#include "plan/tangent_parts.h"

#include "base/angle.h"
#include "base/check.h"

#include <math.h>

#define CORNER_TURN_MAX 1.05 // rad, a corner turns by at most so much: its tip stays near the arc
#define TURN_MIN 1e-7        // rad, a smaller one needs no corner

typedef struct pull { // the way found, pulled about circles of another radius
    aisle_tangent *self;
    double radius;
    aisle_vec2 *points;
    uint32_t count, capacity;
} pull;

static bool put(pull *p, aisle_vec2 at) {
    if (p->count >= p->capacity) {
        return false;
    }
    p->points[p->count++] = at;
    return true;
}

// Corners about the node's circle, from one direction to the other.
static bool put_corners(pull *p, const aisle_tangent_node *node, aisle_vec2 from, aisle_vec2 to) {
    double side = aisle_node_side(node);
    aisle_circle about = {node->centre, side * p->radius};
    double angle = aisle_atan2(side * aisle_vec2_cross(from, to), aisle_vec2_dot(from, to));
    if (angle < -TURN_MIN) {
        return false; // at this radius the way turns the other way: it is another one
    }
    if (angle < TURN_MIN) {
        return true;
    }
    uint32_t parts = (uint32_t)(angle / CORNER_TURN_MAX) + 1U;
    double part = angle / (double)parts;
    double sine, cosine;
    aisle_sincos(0.5 * part, &sine, &cosine);
    double ahead = p->radius * sine / cosine; // part <= CORNER_TURN_MAX: the cosine is above 0.8
    for (uint32_t i = parts; i-- > 0U;) {     // the whole is put from the goal back
        double s, c;
        aisle_sincos(side * part * (double)i, &s, &c);
        aisle_vec2 d = aisle_vec2_add(aisle_vec2_scale(from, c), aisle_vec2_scale(aisle_turned_left(from), s));
        if (!put(p, aisle_vec2_add(aisle_contact(about, d), aisle_vec2_scale(d, ahead)))) {
            return false;
        }
    }
    return true;
}

static aisle_circle circle_at(const pull *p, const aisle_tangent_node *node) {
    double rho = node->corner == AISLE_TANGENT_NONE ? 0.0 : aisle_node_side(node) * p->radius;
    return (aisle_circle){node->centre, rho};
}

// From the goal back: a line, then the arc at its beginning, to the start. Points come out in reverse.
static bool pull_back(pull *p) {
    const aisle_tangent *self = p->self;
    const aisle_tangent_node *to = &self->nodes[self->found];
    aisle_vec2 d_after = {0.0, 0.0};
    while (to->parent != AISLE_TANGENT_NONE) {
        const aisle_tangent_node *from = &self->nodes[to->parent];
        aisle_tangent_line line;
        aisle_circle a = circle_at(p, from);
        aisle_circle b = circle_at(p, to);
        if (!aisle_tangent_between(a, b, &line) ||
            !aisle_tangent_line_free(p->self, p->radius, aisle_contact(a, line.d), aisle_contact(b, line.d))) {
            return false;
        }
        if (to->corner != AISLE_TANGENT_NONE && (!aisle_tangent_arc_free(p->self, p->radius, to, line.d, d_after) ||
                                                 !put_corners(p, to, line.d, d_after))) {
            return false;
        }
        d_after = line.d;
        to = from;
    }
    return put(p, to->centre);
}

static void reverse(aisle_vec2 *points, uint32_t count) {
    for (uint32_t i = 0; i < count / 2U; i++) {
        aisle_vec2 swap = points[i];
        points[i] = points[count - 1U - i];
        points[count - 1U - i] = swap;
    }
}

uint32_t aisle_tangent_points(aisle_tangent *self, double radius, aisle_vec2 *points, uint32_t capacity) {
    AISLE_ASSERT(self->found != AISLE_TANGENT_NONE && radius >= self->radius);
    pull p = {.self = self, .radius = radius, .points = points, .capacity = capacity};
    if (!put(&p, self->goal) || !pull_back(&p)) {
        return 0U;
    }
    reverse(points, p.count);
    return p.count;
}
