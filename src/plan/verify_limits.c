#include "plan/verify_parts.h"

#include "base/angle.h"
#include "base/check.h"

static bool is_finite(double x) {
    return fabs(x) <= DBL_MAX;
} // false for NaN

static bool is_within(double x, double limit) {
    return x <= limit * (1.0 + VERIFY_TOLERANCE);
}

// What two neighbouring times or lengths lose as floats.
static double rounding(float x) {
    return 2.0 * (double)FLT_EPSILON * fabs((double)x);
}

static bool is_at_rest(const aisle_waypoint_msg *w) {
    return (double)w->v <= VERIFY_REST;
}

static bool has(const aisle_waypoint_msg *w, int16_t flag) {
    return (w->flags & flag) != 0;
}

// ---- times

// Least time (s) for a way from rest to rest under accelerations up and down, speed limit v: trapezoid, or triangle
// if v is not reached. The way of getting up to v and down again is v^2 q with q = 1/(2 up) + 1/(2 down).
static double trapezoid_time(double way, double v, double up, double down) {
    double q = 0.5 / up + 0.5 / down;
    return v * v * q >= way ? 2.0 * sqrt(way * q) : way / v + v * q;
}

// Peak of the trapezoid that fills `time`: q v^2 - time v + way = 0, the slower root, which needs no difference.
static double trapezoid_peak(double way, double time, double up, double down) {
    double q = 0.5 / up + 0.5 / down;
    double root = time * time - 4.0 * q * way;
    return 2.0 * way / (time + sqrt(aisle_max(root, 0.0)));
}

void aisle_verify_time_piece(const aisle_vehicle *vehicle, const aisle_waypoint_msg *from, const aisle_waypoint_msg *to,
                             double dwell, bool most, aisle_verify_piece *piece) {
    piece->time = (double)to->t - (double)from->t - dwell;
    piece->peak = aisle_max((double)from->v, (double)to->v);
    if (!piece->on_spot && is_at_rest(from) && is_at_rest(to)) {
        double time = most ? piece->time - rounding(to->t) : aisle_max(piece->time, 0.0) + rounding(to->t);
        piece->peak = time > 0.0 ? trapezoid_peak(piece->length, time, vehicle->a_max, vehicle->d_max) : DBL_MAX;
    }
}

aisle_verify_speeds aisle_verify_speeds_of(const aisle_vehicle *vehicle, const aisle_waypoint_msg *from,
                                           const aisle_waypoint_msg *to, const aisle_verify_piece *piece) {
    if (piece->on_spot) {
        const double up = vehicle->alpha_max;
        return (aisle_verify_speeds){fabs(piece->turn), 0.0, 0.0, vehicle->omega_max, up, up, true};
    }
    return (aisle_verify_speeds){.length = piece->length,
                                 .v0 = (double)from->v,
                                 .v1 = (double)to->v,
                                 .peak = piece->peak,
                                 .up = vehicle->a_max,
                                 .down = vehicle->d_max,
                                 .rests = is_at_rest(from) && is_at_rest(to)};
}

double aisle_verify_speed_square(const aisle_verify_speeds *speeds, double way) {
    const double left = aisle_max(speeds->length - way, 0.0), v0 = speeds->v0, v1 = speeds->v1;
    AISLE_ASSERT(way >= 0.0);
    if (!speeds->rests) {
        return v0 * v0 + (v1 * v1 - v0 * v0) * aisle_min(way / speeds->length, 1.0); // length > VERIFY_SAME_PLACE
    }
    const double ramps = 2.0 * aisle_min(speeds->up * way, speeds->down * left);
    return speeds->peak < sqrt(ramps) ? speeds->peak * speeds->peak : ramps;
}

double aisle_verify_speed_bend(const aisle_verify_speeds *speeds, double way) {
    if (!speeds->rests) {
        return speeds->length;
    }
    const double up = speeds->up, down = speeds->down, middle = speeds->length * down / (up + down);
    const double square = 2.0 * up * middle; // that of the triangle
    const double peak = speeds->peak < sqrt(square) ? speeds->peak * speeds->peak : square;
    const double first = 0.5 * peak / up, second = speeds->length - 0.5 * peak / down;
    return way < first ? first : (way < second ? second : speeds->length);
}

double aisle_verify_speed_time(const aisle_verify_speeds *speeds) {
    if (speeds->rests) {
        return trapezoid_time(speeds->length, speeds->peak, speeds->up, speeds->down);
    }
    return 2.0 * speeds->length / (speeds->v0 + speeds->v1); // one of them above VERIFY_REST
}

static bool turn_time_fits(const aisle_vehicle *vehicle, const aisle_verify_piece *piece, double slack) {
    double turn = aisle_max(fabs(piece->turn), fabs(piece->turn_other));
    double least = trapezoid_time(turn, vehicle->omega_max, vehicle->alpha_max, vehicle->alpha_max);
    return piece->time >= least * (1.0 - VERIFY_TOLERANCE) - slack;
}

static bool time_fits(const aisle_verify *self, uint32_t i, double slack) {
    const aisle_waypoint_msg *from = &self->path->waypoints[i - 1], *to = &self->path->waypoints[i];
    const aisle_verify_piece *piece = &self->piece;
    const aisle_vehicle *vehicle = self->request.vehicle;
    if (is_at_rest(from) && is_at_rest(to)) {
        double least = trapezoid_time(piece->length, DBL_MAX, vehicle->a_max, vehicle->d_max);
        return piece->time >= least * (1.0 - VERIFY_TOLERANCE) - slack;
    }
    double time = 2.0 * piece->length / ((double)from->v + (double)to->v); // one of them above VERIFY_REST
    return piece->time >= time * (1.0 - VERIFY_TOLERANCE) - slack &&
           piece->time <= time * (1.0 + VERIFY_TOLERANCE) + slack + VERIFY_TIME_STEP_MAX;
}

static aisle_verify_fault time_fault(const aisle_verify *self, uint32_t i) {
    const aisle_waypoint_msg *from = &self->path->waypoints[i - 1], *to = &self->path->waypoints[i];
    double slack = rounding(to->t);
    if (!(to->t > from->t)) {
        return AISLE_VERIFY_TIME;
    }
    if (self->piece.on_spot) {
        return turn_time_fits(self->request.vehicle, &self->piece, slack) ? AISLE_VERIFY_NONE : AISLE_VERIFY_TURN_RATE;
    }
    return time_fits(self, i, slack) ? AISLE_VERIFY_NONE : AISLE_VERIFY_TIME;
}

// ---- rest

static aisle_verify_fault rest_fault(const aisle_verify *self, uint32_t i) {
    const aisle_waypoint_msg *w = self->path->waypoints;
    bool turns = has(&w[i - 1], AISLE_WAYPOINT_TURN_IN_PLACE);
    bool reverses = i >= 2 && has(&w[i - 1], AISLE_WAYPOINT_REVERSE) != has(&w[i], AISLE_WAYPOINT_REVERSE);
    bool from_rests = turns || reverses, to_rests = turns;
    bool ok = (!from_rests || is_at_rest(&w[i - 1])) && (!to_rests || is_at_rest(&w[i]));
    return ok ? AISLE_VERIFY_NONE : AISLE_VERIFY_REST;
}

// ---- speeds

static aisle_verify_fault speed_fault(const aisle_vehicle *vehicle, const aisle_verify_piece *piece, double curvature) {
    double v = piece->peak;
    if (!is_within(v, piece->reverse ? vehicle->v_reverse_max : vehicle->v_max)) {
        return AISLE_VERIFY_SPEED;
    }
    if (piece->phi > 0.0 && !is_within(v * v * fabs(curvature), vehicle->lateral_a_max)) {
        return AISLE_VERIFY_LATERAL;
    }
    double turn = aisle_max(fabs(piece->turn), fabs(piece->turn_other));
    if (!piece->on_spot && !is_within(v * turn, vehicle->omega_max * piece->length)) {
        return AISLE_VERIFY_TURN_RATE;
    }
    return AISLE_VERIFY_NONE;
}

static aisle_verify_fault acceleration_fault(const aisle_verify *self, uint32_t i) {
    const aisle_vehicle *vehicle = self->request.vehicle;
    const aisle_waypoint_msg *from = &self->path->waypoints[i - 1], *to = &self->path->waypoints[i];
    double way = 2.0 * self->piece.length, peak = self->piece.peak;
    double gain = (double)to->v * (double)to->v - (double)from->v * (double)from->v;
    double slack = 4.0 * (double)FLT_EPSILON * peak * peak;
    bool ok = is_within(gain - slack, vehicle->a_max * way) && is_within(-gain - slack, vehicle->d_max * way);
    ok = ok && fabs((double)to->a * way - gain) <= VERIFY_TOLERANCE * fabs(gain) + slack;
    ok = ok && is_within((double)to->a, vehicle->a_max) && is_within(-(double)to->a, vehicle->d_max);
    return ok ? AISLE_VERIFY_NONE : AISLE_VERIFY_ACCELERATION;
}

// ---- shape

static aisle_verify_fault curvature_fault(const aisle_vehicle *vehicle, const aisle_verify_piece *piece,
                                          double curvature) {
    bool limited = vehicle->curvature_max > 0.0;
    bool turns = piece->on_spot && fabs(piece->turn) > VERIFY_TIE;
    bool ok = !limited || (!turns && is_within(fabs(curvature), vehicle->curvature_max));
    return ok ? AISLE_VERIFY_NONE : AISLE_VERIFY_CURVATURE;
}

static bool is_near(double a, double b, double within) {
    return fabs(aisle_angle_wrap(b - a)) <= within;
}

// Heading along the motion at both ends, and round with it: half a turn the wrong way has the right ends, too.
static bool heads_along(const aisle_verify_piece *piece) {
    double back = piece->reverse ? AISLE_PI : 0.0, round = 2.0 * piece->side * piece->phi;
    bool with =
        fabs(piece->turn - round) <= 2.0 * VERIFY_HEADING || fabs(piece->turn_other - round) <= 2.0 * VERIFY_HEADING;
    return with && is_near(aisle_verify_piece_direction(piece, false), piece->theta + back, VERIFY_HEADING) &&
           is_near(aisle_verify_piece_direction(piece, true), piece->theta + piece->turn + back, VERIFY_HEADING);
}

static aisle_verify_fault heading_fault(const aisle_verify *self, uint32_t i) {
    const aisle_verify_piece *piece = &self->piece;
    if (piece->on_spot) {
        return AISLE_VERIFY_NONE; // theta alone moves
    }
    if (self->request.vehicle->drive != AISLE_VEHICLE_OMNI) {
        return heads_along(piece) ? AISLE_VERIFY_NONE : AISLE_VERIFY_HEADING;
    }
    bool ok = i == 1 || is_at_rest(&self->path->waypoints[i - 1]) || // where it begins in motion the base tells
              is_near(self->along, aisle_verify_piece_direction(piece, false), 2.0 * VERIFY_HEADING);
    return ok ? AISLE_VERIFY_NONE : AISLE_VERIFY_HEADING;
}

// ---- the whole

static aisle_verify_fault sum_fault(const aisle_verify *self, uint32_t i) {
    double s = self->s + self->piece.length;
    bool ok = fabs((double)self->path->waypoints[i].s - s) <= 1e-4 + 3e-5 * s;
    return ok ? AISLE_VERIFY_NONE : AISLE_VERIFY_SUMS;
}

static aisle_verify_fault first_of(aisle_verify_fault a, aisle_verify_fault b) {
    return a != AISLE_VERIFY_NONE ? a : b;
}

aisle_verify_fault aisle_verify_piece_fault(const aisle_verify *self, uint32_t i) {
    const aisle_vehicle *vehicle = self->request.vehicle;
    double curvature = (double)self->path->waypoints[i].curvature;
    AISLE_ASSERT(i >= 1);
    aisle_verify_fault fault = curvature_fault(vehicle, &self->piece, curvature);
    fault = first_of(fault, heading_fault(self, i));
    fault = first_of(fault, rest_fault(self, i));
    fault = first_of(fault, acceleration_fault(self, i));
    fault = first_of(fault, time_fault(self, i));
    fault = first_of(fault, speed_fault(vehicle, &self->piece, curvature));
    return first_of(fault, sum_fault(self, i));
}

static bool numbers_are_fit(const aisle_waypoint_msg *w) {
    return fabs(w->x) <= AISLE_SHAPE_COORD_MAX && fabs(w->y) <= AISLE_SHAPE_COORD_MAX &&
           fabs(w->theta) <= AISLE_PI + 1e-9 && is_finite((double)w->s) && is_finite((double)w->t) &&
           is_finite((double)w->curvature) && is_finite((double)w->v) && is_finite((double)w->a) &&
           is_finite((double)w->clearance) && w->clearance >= 0.0F;
}

static bool must_rest(const aisle_verify *self, uint32_t i) {
    const aisle_waypoint_msg *w = &self->path->waypoints[i];
    bool fast_start = i == 0 && (double)w->v > self->request.v_start * (1.0 + (double)FLT_EPSILON);
    bool end = i + 1 == (uint32_t)self->path->num_waypoints;
    return fast_start || end || has(w, AISLE_WAYPOINT_STOP) || has(w, AISLE_WAYPOINT_TURN_IN_PLACE);
}

aisle_verify_fault aisle_verify_waypoint_fault(const aisle_verify *self, uint32_t i) {
    const aisle_waypoint_msg *w = &self->path->waypoints[i];
    if (!numbers_are_fit(w)) {
        return AISLE_VERIFY_DECODE;
    }
    if (w->v < 0.0F) {
        return AISLE_VERIFY_SPEED;
    }
    if (must_rest(self, i) && !is_at_rest(w)) {
        return AISLE_VERIFY_REST;
    }
    if (!(self->path->clearance_min <= w->clearance)) {
        return AISLE_VERIFY_SUMS;
    }
    return AISLE_VERIFY_NONE;
}
