#include "plan/verify_parts.h"

#include "base/angle.h"
#include "base/check.h"

double aisle_verify_turn(double a, double b) {
    double turn = b - a;
    if (turn > AISLE_PI) {
        turn -= 2.0 * AISLE_PI;
    } else if (turn <= -AISLE_PI) {
        turn += 2.0 * AISLE_PI;
    }
    return turn;
}

// sin(x) / x, relative error below 1e-13: aisle_sincos is good to 1e-15 absolute, so small x take the series.
static double sinc(double x) {
    double sine, cosine;
    if (fabs(x) < 0.05) {
        double q = x * x;
        return 1.0 - q / 6.0 * (1.0 - q / 20.0 * (1.0 - q / 42.0 * (1.0 - q / 72.0)));
    }
    aisle_sincos(x, &sine, &cosine);
    return sine / x;
}

// Headings of the piece; near half a turn both ways.
static void set_headings(double from, double to, aisle_verify_piece *out) {
    out->theta = from;
    out->turn = aisle_verify_turn(from, to);
    out->turn_other = out->turn;
    if (fabs(out->turn) > AISLE_PI - VERIFY_TIE) {
        out->turn_other += out->turn > 0.0 ? -2.0 * AISLE_PI : 2.0 * AISLE_PI;
    }
}

aisle_verify_piece aisle_verify_piece_standing(const aisle_waypoint_msg *w) {
    aisle_verify_piece piece = {.from = {w->x, w->y}, .unit = {1.0, 0.0}, .side = 1.0, .on_spot = true};
    set_headings(w->theta, w->theta, &piece);
    return piece;
}

// Half the angle of the minor arc: sin(phi) = |k| chord / 2.
static bool set_arc(double k, aisle_verify_piece *out) {
    if (!(fabs(k) > 0.0)) {
        out->length = out->chord;
        return true;
    }
    double sine = fabs(k) * out->chord * 0.5;
    if (!(sine <= 1.0 + 1e-6)) {
        return false;
    }
    sine = aisle_min(sine, 1.0);
    out->phi = aisle_atan2(sine, sqrt((1.0 - sine) * (1.0 + sine)));
    out->side = k < 0.0 ? -1.0 : 1.0;
    out->length = out->chord / sinc(out->phi); // phi <= pi/2: sinc >= 2/pi
    return true;
}

bool aisle_verify_piece_between(const aisle_waypoint_msg *from, const aisle_waypoint_msg *to, aisle_verify_piece *out) {
    aisle_vec2 way = aisle_vec2_of(to->x - from->x, to->y - from->y);
    double chord = aisle_vec2_length(way);
    *out = aisle_verify_piece_standing(from);
    set_headings(from->theta, to->theta, out);
    out->reverse = (to->flags & AISLE_WAYPOINT_REVERSE) != 0;
    if ((from->flags & AISLE_WAYPOINT_TURN_IN_PLACE) != 0) {
        out->from = aisle_vec2_of(to->x, to->y); // the later one: the same but for 1e-9
        return chord <= VERIFY_SAME_PLACE && fabs((double)to->curvature) <= 0.0;
    }
    if (!(chord > VERIFY_SAME_PLACE)) {
        return false;
    }
    out->on_spot = false;
    out->chord = chord;
    out->unit = aisle_vec2_scale(way, 1.0 / chord);
    out->course = aisle_atan2(way.y, way.x);
    return set_arc((double)to->curvature, out);
}

// In the frame of the chord, with psi = u phi the half angle turned so far and R = chord / (2 sin phi):
//     along = 2 R sin(psi) cos(phi - psi),  aside = -side 2 R sin(psi) sin(phi - psi)
// and 2 R sin(psi) = chord u sinc(psi) / sinc(phi), which has no division by a small angle.
aisle_vec2 aisle_verify_piece_origin(const aisle_verify_piece *piece, double u) {
    double sine, cosine, reach = piece->chord * u;
    AISLE_ASSERT(u >= 0.0 && u <= 1.0);
    if (!(piece->phi > 0.0)) {
        return aisle_vec2_add(piece->from, aisle_vec2_scale(piece->unit, reach));
    }
    reach *= sinc(u * piece->phi) / sinc(piece->phi);
    aisle_sincos((1.0 - u) * piece->phi, &sine, &cosine);
    double along = reach * cosine, aside = -piece->side * reach * sine;
    return aisle_vec2_of(piece->from.x + along * piece->unit.x - aside * piece->unit.y,
                         piece->from.y + along * piece->unit.y + aside * piece->unit.x);
}

double aisle_verify_piece_direction(const aisle_verify_piece *piece, bool end) {
    return piece->course + (end ? piece->side : -piece->side) * piece->phi;
}
