// tangent_parts.h - what the files of tangent share with each other and with nobody else. Level 4.
//
// tangent.c: the search. tangent_seen.c: the lines from a node to what is seen from it. tangent_free.c: contact.
// tangent_points.c: from the way found to a polyline.
#ifndef AISLE_PLAN_TANGENT_PARTS_H
#define AISLE_PLAN_TANGENT_PARTS_H

#include "plan/tangent.h"

#define AISLE_TANGENT_TOUCH 1e-9 // m, nearer by this is still free

typedef struct aisle_circle { // of signed radius: positive with the centre on the left of the motion
    aisle_vec2 centre;
    double rho;
} aisle_circle;

typedef struct aisle_tangent_line {
    aisle_vec2 d; // unit direction
    double length;
} aisle_tangent_line;

static inline aisle_vec2 aisle_turned_left(aisle_vec2 a) {
    return aisle_vec2_of(-a.y, a.x);
}

// Where a motion in direction d touches the circle.
static inline aisle_vec2 aisle_contact(aisle_circle c, aisle_vec2 d) {
    return aisle_vec2_sub(c.centre, aisle_vec2_scale(aisle_turned_left(d), c.rho));
}

// +1: passed with the obstacle on the left, -1: on the right.
static inline double aisle_node_side(const aisle_tangent_node *node) {
    return node->corner % 2U == 0U ? 1.0 : -1.0;
}

static inline aisle_circle aisle_node_circle(const aisle_tangent_node *node) {
    return (aisle_circle){node->centre, node->rho};
}

// The line tangent to both circles; false: none, or no length.
static inline bool aisle_tangent_between(aisle_circle from, aisle_circle to, aisle_tangent_line *line) {
    aisle_vec2 way = aisle_vec2_sub(to.centre, from.centre);
    double k = from.rho - to.rho;
    double square = aisle_vec2_dot(way, way);
    double rest = square - k * k;
    if (square < 1e-18 || rest < 0.0) {
        return false;
    }
    line->length = sqrt(rest);
    double along = line->length / square; // square >= 1e-18
    double aside = k / square;
    line->d = aisle_vec2_of(along * way.x - aside * way.y, along * way.y + aside * way.x);
    return true;
}

// Length of the arc about a circle from one direction of motion to another, the way its side turns.
double aisle_arc_length(aisle_circle about, aisle_vec2 from, aisle_vec2 to);

// Stamps what is visited once in the walk that follows.
uint32_t aisle_tangent_stamp(aisle_tangent *self);

// Does the block stand in the way: an obstacle that is not left out?
bool aisle_tangent_counts(const aisle_tangent *self, uint32_t index, const aisle_layout_block *block);

// Pushes the node of an untested line from the node under way.
aisle_status aisle_tangent_push(aisle_tangent *self, uint32_t from, const aisle_tangent_node *to, double length);

// Pushes every line from an expanded node to what may be seen from it. AISLE_ERR_CAPACITY: out of nodes.
aisle_status aisle_tangent_see(aisle_tangent *self, uint32_t from);

// May the disc of this radius move straight from p to q; along the arc about a node's corner, as far as other obstacles
// than the corner's own go? Exact, touching is free.
bool aisle_tangent_line_free(aisle_tangent *self, double radius, aisle_vec2 p, aisle_vec2 q);
bool aisle_tangent_arc_free(aisle_tangent *self, double radius, const aisle_tangent_node *node, aisle_vec2 from,
                            aisle_vec2 to);
#endif
