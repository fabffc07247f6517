#include "robot/curve.h"

#include "base/angle.h"
#include "base/check.h"

#include <math.h>
#include <stddef.h>

static aisle_vec2 position(const aisle_waypoint_msg *w) {
    return aisle_vec2_of(w->x, w->y);
}

static aisle_waypoint_msg *last(aisle_curve *self) {
    AISLE_ASSERT(self->n > 0);
    return &self->w[self->n - 1U];
}

static void append(aisle_curve *self, aisle_vec2 p, double theta, double curvature) {
    if (self->n >= self->capacity) {
        self->overflow = true;
        return;
    }
    self->w[self->n++] = (aisle_waypoint_msg){.x = p.x, .y = p.y, .theta = theta, .curvature = (float)curvature};
}

void aisle_curve_begin(aisle_curve *self, aisle_pose2 start) {
    self->n = 0;
    self->overflow = false;
    append(self, aisle_vec2_of(start.x, start.y), aisle_angle_wrap(start.theta), 0.0);
}

void aisle_curve_turn_to(aisle_curve *self, double theta) {
    aisle_waypoint_msg *from = last(self);
    if (fabs(aisle_angle_difference(from->theta, theta)) <= AISLE_CURVE_HEADING_TOLERANCE) {
        return;
    }
    from->flags |= AISLE_WAYPOINT_STOP | AISLE_WAYPOINT_TURN_IN_PLACE;
    append(self, position(from), aisle_angle_wrap(theta), 0.0);
}

void aisle_curve_line_to(aisle_curve *self, aisle_vec2 p) {
    const aisle_waypoint_msg *from = last(self);
    if (aisle_vec2_distance(position(from), p) >= 1e-6) {
        append(self, p, from->theta, 0.0);
    }
}

// Arc from where the curve stands, starting along `tangent`, to p; a line where it would hardly bend.
static void arc_to(aisle_curve *self, aisle_vec2 tangent, aisle_vec2 p) {
    aisle_vec2 chord = aisle_vec2_sub(p, position(last(self)));
    double square = aisle_vec2_dot(chord, chord);
    if (square < 1e-12) {
        return;
    }
    double sine = aisle_vec2_cross(tangent, chord); // of the half angle, times the chord
    double cosine = aisle_vec2_dot(tangent, chord);
    double curvature = 2.0 * sine / square;
    if (curvature * curvature * square < 1e-10) { // bends by less than 1e-5 rad
        append(self, p, aisle_atan2(chord.y, chord.x), 0.0);
        return;
    }
    double theta = last(self)->theta + 2.0 * aisle_atan2(sine, cosine);
    append(self, p, aisle_angle_wrap(theta), curvature);
}

typedef struct corner_geometry {
    aisle_vec2 at, u, v; // the corner, unit directions in and out
    double leg_in, leg_out;
    double tan_half; // of half the angle it turns by
    double theta_out;
} corner_geometry;

// How far before the corner an arc of this radius begins, within what the legs and the zone give; 0: no such arc.
static double corner_cut(const corner_geometry *corner, const aisle_corner_rule *rule, double radius) {
    double cut = aisle_min(radius * corner->tan_half, 0.5 * aisle_min(corner->leg_in, corner->leg_out));
    if (rule->zone > 0.0) {
        cut = aisle_min(cut, rule->zone);
    }
    return cut < rule->min_radius * corner->tan_half || cut < 1e-6 ? 0.0 : cut;
}

// Line and arc, if the arc is free; else nothing is appended.
static bool try_arc(aisle_curve *self, const corner_geometry *corner, const aisle_corner_rule *rule, double cut) {
    uint32_t n = self->n;
    aisle_curve_line_to(self, aisle_vec2_sub(corner->at, aisle_vec2_scale(corner->u, cut)));
    arc_to(self, corner->u, aisle_vec2_add(corner->at, aisle_vec2_scale(corner->v, cut)));
    if (self->overflow) {
        return true; // nothing more fits, whatever is tried
    }
    aisle_waypoint_msg *to = last(self);
    to->theta = corner->theta_out;
    if (rule->arc_free == NULL || rule->arc_free(rule->ctx, to - 1, to)) {
        return true;
    }
    self->n = n;
    return false;
}

static bool round_corner(aisle_curve *self, const corner_geometry *corner, const aisle_corner_rule *rule) {
    double tried = -1.0;
    double radius = rule->max_radius;
    while (radius > 0.0 && radius >= rule->min_radius) {
        double cut = corner_cut(corner, rule, radius);
        if (cut <= 0.0) {
            return false;
        }
        if (tried < 0.0 || cut < tried - 1e-9) {
            if (try_arc(self, corner, rule, cut)) {
                return true;
            }
            tried = cut;
        }
        radius = radius > rule->sure_radius ? rule->sure_radius : 0.5 * radius;
    }
    return false;
}

static void pass_corner(aisle_curve *self, const aisle_vec2 *p, const aisle_corner_rule *rule) {
    aisle_vec2 in = aisle_vec2_sub(p[1], p[0]);
    aisle_vec2 out = aisle_vec2_sub(p[2], p[1]);
    corner_geometry corner = {.at = p[1], .leg_in = aisle_vec2_length(in), .leg_out = aisle_vec2_length(out)};
    corner.u = aisle_vec2_scale(in, 1.0 / corner.leg_in);
    corner.v = aisle_vec2_scale(out, 1.0 / corner.leg_out);
    corner.theta_out = aisle_atan2(out.y, out.x);
    double cosine = aisle_vec2_dot(corner.u, corner.v);
    if (cosine > -0.999) { // a reversal has no arc
        corner.tan_half = fabs(aisle_vec2_cross(corner.u, corner.v)) / (1.0 + cosine);
        if (round_corner(self, &corner, rule)) {
            return;
        }
    }
    aisle_curve_line_to(self, p[1]);
    aisle_curve_turn_to(self, corner.theta_out);
    last(self)->theta = corner.theta_out;
}

void aisle_curve_polyline(aisle_curve *self, const aisle_vec2 *points, uint32_t n, const aisle_corner_rule *rule) {
    AISLE_ASSERT(n >= 2);
    aisle_vec2 first = aisle_vec2_sub(points[1], points[0]);
    aisle_curve_turn_to(self, aisle_atan2(first.y, first.x));
    last(self)->theta = aisle_atan2(first.y, first.x);
    for (uint32_t i = 1; i + 1U < n && !self->overflow; i++) {
        pass_corner(self, &points[i - 1U], rule);
    }
    aisle_curve_line_to(self, points[n - 1U]);
}

void aisle_curve_biarc_to(aisle_curve *self, aisle_vec2 p, aisle_vec2 tangent) {
    const aisle_waypoint_msg *from = last(self);
    aisle_vec2 p0 = position(from);
    aisle_vec2 chord = aisle_vec2_sub(p, p0);
    aisle_vec2 t0;
    aisle_sincos(from->theta, &t0.y, &t0.x);
    aisle_vec2 sum = aisle_vec2_add(t0, tangent);
    double square = aisle_vec2_dot(chord, chord);
    if (square < 1e-12) {
        return;
    }
    // Tangent length d from 2 (1 - t0.t1) d^2 + 2 (chord.sum) d - chord.chord = 0, in the form without cancellation.
    double a = 2.0 * (1.0 - aisle_vec2_dot(t0, tangent));
    double b = 2.0 * aisle_vec2_dot(chord, sum);
    double root = sqrt(b * b + 4.0 * a * square); // a >= 0
    double divisor = b + root;
    if (divisor < 1e-9 * root) { // turns right back: the caller's points are too far apart
        arc_to(self, t0, p);
        return;
    }
    double d = 2.0 * square / divisor;
    aisle_vec2 c0 = aisle_vec2_add(p0, aisle_vec2_scale(t0, d));
    aisle_vec2 c1 = aisle_vec2_sub(p, aisle_vec2_scale(tangent, d));
    aisle_vec2 middle = aisle_vec2_lerp(c0, c1, 0.5);
    arc_to(self, t0, middle);
    aisle_sincos(last(self)->theta, &t0.y, &t0.x);
    arc_to(self, t0, p);
}

void aisle_curve_pieces(aisle_curve *self, const aisle_waypoint_msg *w, uint32_t n) {
    aisle_curve_turn_to(self, w[0].theta);
    last(self)->theta = w[0].theta;
    last(self)->flags |= w[0].flags;
    for (uint32_t i = 1; i < n; i++) {
        if (self->n >= self->capacity) {
            self->overflow = true;
            return;
        }
        self->w[self->n++] = w[i];
    }
}

void aisle_curve_goal(aisle_curve *self, int32_t id) {
    aisle_waypoint_msg *at = last(self);
    if ((at->flags & AISLE_WAYPOINT_GOAL) != 0) { // a second goal at this place: a turn by nothing
        at->flags |= AISLE_WAYPOINT_TURN_IN_PLACE;
        append(self, position(at), at->theta, 0.0);
        at = last(self);
    }
    at->flags |= AISLE_WAYPOINT_GOAL | AISLE_WAYPOINT_STOP;
    at->goal_id = id;
}

aisle_pose2 aisle_piece_at(const aisle_waypoint_msg *from, const aisle_waypoint_msg *to, double f) {
    aisle_vec2 p0 = position(from);
    aisle_vec2 p1 = position(to);
    double theta = from->theta + f * aisle_angle_difference(from->theta, to->theta);
    double k = (double)to->curvature;
    aisle_vec2 chord = aisle_vec2_sub(p1, p0);
    double half = 0.5 * k * aisle_vec2_length(chord); // sine of half the arc's angle, signed
    if (fabs(half) < 1e-9) {
        aisle_vec2 p = aisle_vec2_lerp(p0, p1, f);
        return (aisle_pose2){p.x, p.y, theta};
    }
    half = aisle_clamp(half, -1.0, 1.0);
    double alpha = aisle_atan2(half, sqrt(1.0 - half * half)); // half the arc's angle
    // A point of the arc at fraction f lies, seen from p0, at angle -(1 - f) alpha to the chord, 2 sin(f alpha) / k
    // away.
    double sine, cosine, far_sine, far_cosine;
    aisle_sincos(-(1.0 - f) * alpha, &sine, &cosine);
    aisle_sincos(f * alpha, &far_sine, &far_cosine);
    double stretch = far_sine / half; // of the chord
    return (aisle_pose2){p0.x + stretch * (cosine * chord.x - sine * chord.y),
                         p0.y + stretch * (sine * chord.x + cosine * chord.y), theta};
}

aisle_waypoint_msg aisle_piece_part(const aisle_waypoint_msg *to, double f) {
    const aisle_pose2 p = aisle_piece_at(to - 1, to, f);
    return (aisle_waypoint_msg){.x = p.x,
                                .y = p.y,
                                .theta = aisle_angle_wrap(p.theta),
                                .curvature = to->curvature,
                                .clearance = to->clearance,
                                .flags = (int16_t)(to->flags & AISLE_WAYPOINT_REVERSE)};
}
