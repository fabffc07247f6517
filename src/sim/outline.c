#include "sim/outline.h"

#include <stdbool.h>

aisle_sim_outline aisle_sim_disc(aisle_vec2 centre, double radius) {
    return (aisle_sim_outline){.n = 1, .v = {centre}, .radius = radius};
}

aisle_sim_outline aisle_sim_box(double x0, double y0, double x1, double y1) {
    return (aisle_sim_outline){.n = 4, .v = {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}}};
}

aisle_sim_outline aisle_sim_outline_at(const aisle_sim_outline *body, aisle_pose2 pose) {
    aisle_sim_outline out = {.n = body->n, .radius = body->radius};
    double c = cos(pose.theta), s = sin(pose.theta);
    for (uint32_t i = 0; i < body->n; i++) {
        out.v[i].x = pose.x + c * body->v[i].x - s * body->v[i].y;
        out.v[i].y = pose.y + s * body->v[i].x + c * body->v[i].y;
    }
    return out;
}

double aisle_sim_outline_reach(const aisle_sim_outline *body) {
    double most = 0.0;
    for (uint32_t i = 0; i < body->n; i++) {
        most = fmax(most, aisle_vec2_length(aisle_vec2_of(body->v[i].x, body->v[i].y)));
    }
    return most + body->radius;
}

static double to_segment(aisle_vec2 p, aisle_vec2 a, aisle_vec2 b) {
    double dx = b.x - a.x, dy = b.y - a.y, length2 = dx * dx + dy * dy;
    double t = length2 > 0.0 ? ((p.x - a.x) * dx + (p.y - a.y) * dy) / length2 : 0.0;
    t = fmin(fmax(t, 0.0), 1.0);
    return aisle_vec2_length(aisle_vec2_of(p.x - a.x - t * dx, p.y - a.y - t * dy));
}

// Twice the area of the triangle a, b, p: above 0 if p is to the left of a -> b.
static double side(aisle_vec2 a, aisle_vec2 b, aisle_vec2 p) {
    return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
}

static bool is_inside(aisle_vec2 p, const aisle_sim_outline *o) {
    for (uint32_t i = 0; i < o->n; i++) {
        if (side(o->v[i], o->v[(i + 1) % o->n], p) < 0.0) {
            return false;
        }
    }
    return o->n >= 3;
}

static double corner_to_hull(aisle_vec2 p, const aisle_sim_outline *o) {
    if (is_inside(p, o)) {
        return 0.0;
    }
    double least = (double)INFINITY;
    for (uint32_t i = 0; i < o->n; i++) {
        least = fmin(least, to_segment(p, o->v[i], o->v[(i + 1) % o->n]));
    }
    return least;
}

static bool segments_cross(aisle_vec2 a, aisle_vec2 b, aisle_vec2 c, aisle_vec2 d) {
    return side(a, b, c) * side(a, b, d) < 0.0 && side(c, d, a) * side(c, d, b) < 0.0;
}

static bool edges_cross(const aisle_sim_outline *a, const aisle_sim_outline *b) {
    for (uint32_t i = 0; i < a->n; i++) {
        for (uint32_t k = 0; k < b->n; k++) {
            if (segments_cross(a->v[i], a->v[(i + 1) % a->n], b->v[k], b->v[(k + 1) % b->n])) {
                return true;
            }
        }
    }
    return false;
}

// Hulls that share no point are nearest at a corner of one of them; hulls that do have a corner inside the other or
// edges that cross.
static double hull_gap(const aisle_sim_outline *a, const aisle_sim_outline *b) {
    double least = (double)INFINITY;
    for (uint32_t i = 0; i < a->n; i++) {
        least = fmin(least, corner_to_hull(a->v[i], b));
    }
    for (uint32_t k = 0; k < b->n; k++) {
        least = fmin(least, corner_to_hull(b->v[k], a));
    }
    return least > 0.0 && a->n > 1 && b->n > 1 && edges_cross(a, b) ? 0.0 : least;
}

double aisle_sim_gap(const aisle_sim_outline *a, const aisle_sim_outline *b) {
    return fmax(hull_gap(a, b) - a->radius - b->radius, 0.0);
}

double aisle_sim_gap_to(const aisle_sim_outline *a, aisle_vec2 p) {
    return fmax(corner_to_hull(p, a) - a->radius, 0.0);
}
