#include "robot/profile.h"

#include "base/angle.h"
#include "base/check.h"
#include "base/rounding.h"
#include "robot/curve.h"

#include <stddef.h>

#define GRAVITY 9.80665   // m/s2
#define CHORD_EXCESS 1e-6 // relative: curvature travels as float
#define OVERREACH 0.05    // m, see the header
#define CUTS_MAX 64.0
#define START_TOLERANCE 1e-6 // relative
#define TOUCH 1e-6           // m, more than all rounding of places and gaps together
#define RAMP_LEAST 5e-6      // m, of a part of a piece
#define TOUCH_BENT 2e-3      // m, the same where the body turns or bends: more than the verifier's own overreach

typedef struct piece { // between two waypoints
    const aisle_waypoint_msg *from, *to;
    double length; // m; 0 for a turn on the spot
    double turn;   // rad
} piece;

// ---- geometry of pieces

static bool has(const aisle_waypoint_msg *w, int flag) {
    return (w->flags & flag) != 0;
}

static double chord_of(const aisle_waypoint_msg *from, const aisle_waypoint_msg *to) {
    return aisle_vec2_distance(aisle_vec2_of(from->x, from->y), aisle_vec2_of(to->x, to->y));
}

double aisle_piece_length(const aisle_waypoint_msg *from, const aisle_waypoint_msg *to) {
    if (has(from, AISLE_WAYPOINT_TURN_IN_PLACE)) {
        return 0.0;
    }
    const double chord = chord_of(from, to);
    const double curvature = (double)to->curvature;
    const double sine = aisle_min(fabs(0.5 * curvature * chord), 1.0); // of half the arc's angle
    if (sine < 0.01) { // asin(s) / s; the next term is below 5e-14, and a curvature of 0 needs no case of its own
        const double s2 = sine * sine;
        return chord * (1.0 + s2 * (1.0 / 6.0 + s2 * (3.0 / 40.0)));
    }
    return 2.0 * aisle_atan2(sine, sqrt(1.0 - sine * sine)) / fabs(curvature);
}

double aisle_piece_turn(const aisle_waypoint_msg *from, const aisle_waypoint_msg *to) {
    return aisle_angle_difference(from->theta, to->theta);
}

static piece piece_at(const aisle_waypoint_msg *w, uint32_t i) {
    const aisle_waypoint_msg *from = &w[i - 1], *to = &w[i];
    return (piece){from, to, aisle_piece_length(from, to), aisle_piece_turn(from, to)};
}

static bool is_turn(const piece *p) {
    return has(p->from, AISLE_WAYPOINT_TURN_IN_PLACE);
}

// ---- what is fit to be worked on

static bool numbers_are_fit(const aisle_waypoint_msg *w, bool ends_a_piece) {
    return fabs(w->x) <= AISLE_SHAPE_COORD_MAX && fabs(w->y) <= AISLE_SHAPE_COORD_MAX &&
           fabs(w->theta) <= AISLE_ANGLE_MAX &&
           (!ends_a_piece || (isfinite(w->curvature) && isfinite(w->clearance) && w->clearance >= 0.0F));
}

static bool piece_is_fit(const aisle_waypoint_msg *from, const aisle_waypoint_msg *to) {
    const double chord = chord_of(from, to);
    if (has(from, AISLE_WAYPOINT_TURN_IN_PLACE)) {
        return chord < AISLE_PROFILE_PIECE_MIN;
    }
    return chord >= AISLE_PROFILE_PIECE_MIN && fabs(0.5 * (double)to->curvature * chord) <= 1.0 + CHORD_EXCESS;
}

// At the ends, at STOP, before and after a turn, and where the vehicle changes between forwards and backwards.
static bool rests_at(const aisle_waypoint_msg *w, uint32_t n, uint32_t i) {
    return i == 0 || i == n - 1 || has(&w[i], AISLE_WAYPOINT_STOP | AISLE_WAYPOINT_TURN_IN_PLACE) ||
           has(&w[i - 1], AISLE_WAYPOINT_TURN_IN_PLACE) ||
           has(&w[i], AISLE_WAYPOINT_REVERSE) != has(&w[i + 1], AISLE_WAYPOINT_REVERSE);
}

static bool path_is_fit(const aisle_waypoint_msg *w, uint32_t n, const float *dwell) {
    for (uint32_t i = 0; i < n; i++) {
        if (!numbers_are_fit(&w[i], i > 0) || (i > 0 && !piece_is_fit(&w[i - 1], &w[i]))) {
            return false;
        }
        if (dwell != NULL && (!isfinite(dwell[i]) || dwell[i] < 0.0F || (dwell[i] > 0.0F && !rests_at(w, n, i)))) {
            return false;
        }
    }
    return true;
}

// In motion it may begin only where nothing asks it to rest.
static bool start_is_fit(const aisle_waypoint_msg *w, uint32_t n, const float *dwell,
                         const aisle_profile_start *start) {
    for (uint32_t i = 0; start->most != NULL && i < n; i++) {
        if (!(start->most[i] >= 0.0F)) {
            return false;
        }
    }
    const bool rests =
        n == 1 || has(&w[0], AISLE_WAYPOINT_STOP | AISLE_WAYPOINT_TURN_IN_PLACE) || (dwell != NULL && dwell[0] > 0.0F);
    return start->v >= 0.0 && start->v <= (rests ? 0.0 : AISLE_VEHICLE_SPEED_MAX);
}

// ---- limits of pieces

// Farthest vertex from the origin: what a turn swings round. The rounding turns with its centre.
static double reach_of(const aisle_vehicle *vehicle) {
    return vehicle->outer_radius - vehicle->radius;
}

// How far a body point may stray from the straight way between its ends: sagittas of the origin's arc and of the
// rotation, |k| L^2 / 8 + r b^2 / 8 (a point's second derivative along the piece is at most |k| L^2 + r b^2).
static double stray_of(const aisle_vehicle *vehicle, const piece *p) {
    const double curvature = fabs((double)p->to->curvature);
    return (curvature * p->length * p->length + reach_of(vehicle) * p->turn * p->turn) / 8.0;
}

// Into how many parts the piece is cut so that hull and stray reach at most OVERREACH beyond the ground covered. A
// point of the hull is (1 - t) of body point p at the start and t of q at the end; the body point (1 - t) p + t q
// passes within t (1 - t) |b| |p - q| <= r |b| / 2 plus the stray of it, and the hull is grown by the stray once more.
static double cuts_of(const aisle_vehicle *vehicle, const piece *p, double stray) {
    const double by_turn = reach_of(vehicle) * fabs(p->turn) / OVERREACH; // r |b| / cuts / 2 is half of it
    const double by_stray = sqrt(4.0 * stray / OVERREACH);                // 2 stray / cuts^2 is the other
    return aisle_min(floor(aisle_max(by_turn, by_stray)) + 1.0, CUTS_MAX);
}

static aisle_aabb box_of(const aisle_vehicle *vehicle, const piece *p) {
    const double grow =
        vehicle->outer_radius + TOUCH_BENT + fabs((double)p->to->curvature) * p->length * p->length / 8.0;
    const aisle_aabb ends = {{aisle_min(p->from->x, p->to->x), aisle_min(p->from->y, p->to->y)},
                             {aisle_max(p->from->x, p->to->x), aisle_max(p->from->y, p->to->y)}};
    return aisle_aabb_grow(ends, grow);
}

static bool may_touch(const aisle_vehicle *vehicle, const piece *p, const aisle_convex *zone) {
    const double stray = stray_of(vehicle, p);
    const double cuts = cuts_of(vehicle, p, stray);
    const double touch = stray > 0.0 ? TOUCH_BENT : TOUCH;
    for (double cut = 0.0; cut < cuts; cut += 1.0) {
        aisle_vec2 places[2 * AISLE_SHAPE_VERTICES_MAX], hull[2 * AISLE_SHAPE_VERTICES_MAX];
        (void)aisle_vehicle_place(vehicle, aisle_piece_at(p->from, p->to, cut / cuts), 0.0, places);
        (void)aisle_vehicle_place(vehicle, aisle_piece_at(p->from, p->to, (cut + 1.0) / cuts), 0.0,
                                  places + vehicle->n);
        const uint32_t size = aisle_convex_hull(places, 2U * vehicle->n, hull);
        const aisle_convex swept = {hull, size, vehicle->radius + stray / (cuts * cuts) + touch};
        if (!(aisle_convex_gap(&swept, zone) > 0.0)) {
            return true;
        }
    }
    return false;
}

static double zone_limit(const aisle_vehicle *vehicle, const aisle_layout *layout, const piece *p, double limit) {
    const aisle_zone *zone;
    for (aisle_layout_walk walk = aisle_layout_walk_over(layout, box_of(vehicle, p));
         aisle_layout_walk_next(&walk, &zone);) {
        if (zone->kind == AISLE_POLYGON_SPEED_LIMIT && (double)zone->value < limit) {
            const aisle_convex shape = aisle_layout_zone_shape(layout, zone);
            AISLE_ASSERT(zone->value > 0.0F); // the layout takes no others
            limit = may_touch(vehicle, p, &shape) ? (double)zone->value : limit;
        }
    }
    return limit;
}

static double piece_limit(const aisle_vehicle *vehicle, const aisle_layout *layout, const piece *p) {
    if (is_turn(p)) {
        return 0.0;
    }
    const double curvature = fabs((double)p->to->curvature);
    const double turn = fabs(p->turn);
    double limit = has(p->to, AISLE_WAYPOINT_REVERSE) ? vehicle->v_reverse_max : vehicle->v_max;
    if (limit * limit * curvature > vehicle->lateral_a_max) {
        limit = sqrt(vehicle->lateral_a_max / curvature);
    }
    if (limit * turn > vehicle->omega_max * p->length) {
        limit = vehicle->omega_max * p->length / turn;
    }
    if ((double)p->to->clearance < vehicle->creep_clearance) {
        limit = aisle_min(limit, vehicle->creep_speed);
    }
    return layout == NULL || !aisle_layout_has_kind(layout, AISLE_POLYGON_SPEED_LIMIT)
               ? limit
               : zone_limit(vehicle, layout, p, limit);
}

// Until the last pass s holds the length and a the limit of the piece that ends here, both rounded down.
static void bound_pieces(const aisle_vehicle *vehicle, const aisle_layout *layout, aisle_waypoint_msg *w, uint32_t n) {
    for (uint32_t i = 1; i < n; i++) {
        const piece p = piece_at(w, i);
        w[i].s = aisle_float_below(p.length);
        w[i].a = aisle_float_below(piece_limit(vehicle, layout, &p));
    }
}

// ---- speeds

static void bound_waypoints(aisle_waypoint_msg *w, uint32_t n) {
    for (uint32_t i = 0; i < n; i++) {
        w[i].v = 0.0F;
        if (!rests_at(w, n, i)) {
            w[i].v = w[i].a < w[i + 1].a ? w[i].a : w[i + 1].a;
        }
    }
}

// Lowers v to what is reached from v0 with this acceleration over this length.
static void lower(float *v, float v0, double acceleration, float length) {
    const double reached = sqrt((double)v0 * (double)v0 + 2.0 * acceleration * (double)length);
    if (reached < (double)*v) {
        *v = aisle_float_below(reached);
    }
}

// `most`, or what braking at once leaves after s m: rounded up, so that the brakes suffice.
static float bound_or_braked(const aisle_vehicle *vehicle, double v, double s, float most) {
    const double v2 = v * v - 2.0 * vehicle->d_max * s;
    const double braked = v2 > 0.0 ? sqrt(v2) : 0.0;
    return braked > (double)most ? aisle_float_above(braked) : most;
}

static void bound_by_most(const aisle_vehicle *vehicle, const aisle_profile_start *start, aisle_waypoint_msg *w,
                          uint32_t n) {
    double s = 0.0;
    for (uint32_t i = 1; start->most != NULL && i < n; i++) {
        const float either = start->most[i - 1] > start->most[i] ? start->most[i - 1] : start->most[i];
        w[i].a = w[i].a < either ? w[i].a : either; // of a piece from rest to rest
        s += (double)w[i].s;
        const float most = bound_or_braked(vehicle, start->v, s, start->most[i]);
        w[i].v = w[i].v < most ? w[i].v : most;
    }
}

static void bound_accelerations(const aisle_vehicle *vehicle, aisle_waypoint_msg *w, uint32_t n) {
    for (uint32_t i = 1; i < n; i++) {
        lower(&w[i].v, w[i - 1].v, vehicle->a_max, w[i].s);
    }
    for (uint32_t i = n - 1; i > 1; i--) { // w[0] stands as it is
        lower(&w[i - 1].v, w[i].v, vehicle->d_max, w[i].s);
    }
}

// Lowers the first speed to what can be braked to what follows. False if by more than rounding.
static bool fit_start(const aisle_vehicle *vehicle, aisle_waypoint_msg *w, uint32_t n, float limit) {
    const float told = w[0].v;
    if (n > 1 && told > 0.0F) {
        w[0].v = told < limit ? told : limit;
        lower(&w[0].v, w[1].v, vehicle->d_max, w[1].s);
    }
    return (double)w[0].v >= (double)told * (1.0 - START_TOLERANCE);
}

// ---- times and sums

double aisle_rest_to_rest(double way, double most, double up, double down, double *peak) {
    const double triangle = sqrt(2.0 * way * up * down / (up + down));
    *peak = aisle_min(triangle, most);
    const double ramps = 0.5 * *peak * *peak * (1.0 / up + 1.0 / down); // way spent in them
    const double cruise = triangle > most ? (way - ramps) / most : 0.0;
    return *peak / up + *peak / down + cruise;
}

static aisle_piece_work work_of(const aisle_vehicle *vehicle, const piece *p, double peak) {
    const double v0 = (double)p->from->v, v1 = (double)p->to->v;
    const double drag = vehicle->mass * GRAVITY * vehicle->rolling_resistance;
    if (is_turn(p)) {
        return (aisle_piece_work){.turning = drag * vehicle->outer_radius * fabs(p->turn)};
    }
    const double gain = v0 + v1 > 0.0 ? aisle_max(0.0, v1 * v1 - v0 * v0) : peak * peak;
    return (aisle_piece_work){.rolling = drag * p->length, .acceleration = 0.5 * vehicle->mass * gain};
}

aisle_piece_work aisle_piece_work_of(const aisle_vehicle *vehicle, const aisle_waypoint_msg *from,
                                     const aisle_waypoint_msg *to, double peak) {
    const piece p = {from, to, aisle_piece_length(from, to), aisle_piece_turn(from, to)};
    return work_of(vehicle, &p, peak);
}

// Duration of piece p under `limit`; *work: what it takes at the wheels, J.
static double drive(const aisle_vehicle *vehicle, const piece *p, double limit, double *work) {
    const double v0 = (double)p->from->v, v1 = (double)p->to->v;
    double peak = 0.0, duration;
    if (is_turn(p)) {
        duration = aisle_rest_to_rest(fabs(p->turn), vehicle->omega_max, vehicle->alpha_max, vehicle->alpha_max, &peak);
    } else if (v0 + v1 > 0.0) {
        duration = 2.0 * p->length / (v0 + v1);
    } else {
        duration = aisle_rest_to_rest(p->length, limit, vehicle->a_max, vehicle->d_max, &peak);
    }
    const aisle_piece_work w = work_of(vehicle, p, peak);
    *work = w.rolling + w.acceleration + w.turning;
    return duration;
}

static double acceleration_of(const piece *p) {
    const double v0 = (double)p->from->v, v1 = (double)p->to->v;
    return is_turn(p) ? 0.0 : (v1 * v1 - v0 * v0) / (2.0 * p->length);
}

static double risk_of(const aisle_vehicle *vehicle, const aisle_waypoint_msg *to) {
    return aisle_max(1.0 - (double)to->clearance / vehicle->creep_clearance, 0.0);
}

static aisle_status lay_out(const aisle_vehicle *vehicle, aisle_waypoint_msg *w, uint32_t n, const float *dwell,
                            aisle_profile_sum *sum) {
    double length = 0.0, work_total = 0.0, risk = 0.0;
    w[0].s = w[0].t = w[0].a = 0.0F;
    for (uint32_t i = 1; i < n; i++) {
        const piece p = piece_at(w, i);
        double work;
        const double rest = dwell == NULL ? 0.0 : (double)dwell[i - 1];
        const double duration = rest + aisle_max(drive(vehicle, &p, (double)w[i].a, &work), AISLE_PROFILE_TIME_STEP);
        const double arrival = (double)w[i - 1].t + duration;
        if (!(arrival <= AISLE_PROFILE_DURATION_MAX)) { // a limit rounded down to 0 ends here, too
            return AISLE_ERR_CAPACITY;
        }
        length += p.length;
        work_total += work;
        risk += risk_of(vehicle, p.to) * p.length;
        w[i].s = (float)length;
        w[i].t = aisle_float_above(arrival);
        w[i].a = (float)acceleration_of(&p);
    }
    sum->length = length;
    sum->duration = (double)w[n - 1].t;
    sum->energy = work_total / vehicle->drive_efficiency + vehicle->idle_power * sum->duration;
    sum->risk = length > 0.0 ? risk / length : 0.0;
    return AISLE_OK;
}

// ---- ramps

typedef struct ramp { // of a piece driven faster than evenly
    double up, down;  // m, from its start to where it stops speeding up, and braking to its end
    double length;    // m
} ramp;

// What lies between the ends of piece i may be as fast as the faster of them: no bound bends there.
static bool is_bounded_evenly(const aisle_profile_start *start, uint32_t i) {
    return start->most == NULL || !isfinite(start->most[i]) || !(start->most[i - 1] != start->most[i]);
}

// Is piece i, its speeds, length and limit standing in w, worth being cut?
static bool find_ramp(const aisle_vehicle *vehicle, const aisle_profile_start *start, const aisle_waypoint_msg *w,
                      uint32_t i, ramp *out) {
    const double v0 = (double)w[i - 1].v, v1 = (double)w[i].v, length = (double)w[i].s;
    const double up = vehicle->a_max, down = vehicle->d_max;
    if (!(v0 + v1 > 0.0) || !is_bounded_evenly(start, i)) { // a turn, or from rest to rest: a trapezoid as it is
        return false;
    }
    const double limit = (double)w[i].a, ends = v0 + v1;
    if (length * (2.0 * limit - ends) <=
        AISLE_PROFILE_RAMP_GAIN * ends * limit) { // not even if it were at its limit at once
        return false;
    }
    const double highest = sqrt((2.0 * length * up * down + v0 * v0 * down + v1 * v1 * up) / (up + down));
    const double peak = aisle_min(highest, limit);
    if (peak < aisle_max(v0, v1)) {
        return false;
    }
    *out = (ramp){(peak * peak - v0 * v0) / (2.0 * up), (peak * peak - v1 * v1) / (2.0 * down), length};
    const double cruise = aisle_max(length - out->up - out->down, 0.0) / peak;
    return 2.0 * length / ends - ((peak - v0) / up + (peak - v1) / down + cruise) > AISLE_PROFILE_RAMP_GAIN;
}

// Where to cut it, m from its start: at[2], rising.
static uint32_t knots_of(const ramp *self, double at[2]) {
    uint32_t n = 0;
    if (self->up > RAMP_LEAST && self->up < self->length - RAMP_LEAST) {
        at[n++] = self->up;
    }
    const double begins = self->length - self->down; // to brake
    if (self->down > RAMP_LEAST && begins > (n > 0 ? at[0] : 0.0) + RAMP_LEAST) {
        at[n++] = begins;
    }
    return n;
}

// How many waypoints the pieces from `path->whole` on want that there is room for; *last: the last of these pieces.
static uint32_t count_knots(const aisle_vehicle *vehicle, const aisle_profile_start *start,
                            const aisle_profile_path *path, uint32_t *last) {
    uint32_t count = 0;
    *last = path->whole;
    for (uint32_t i = path->whole + 1U; i < path->n; i++) {
        ramp cut;
        double at[2];
        const uint32_t more = find_ramp(vehicle, start, path->w, i, &cut) ? knots_of(&cut, at) : 0;
        if (path->n + count + more > path->capacity) {
            break;
        }
        count += more;
        *last = i;
    }
    return count;
}

// Moves piece i, which ends at w[i], so that it ends at w[to], with `knots` waypoints before, at the piece's limit.
static void spread(const aisle_profile_path *path, uint32_t i, uint32_t to, const ramp *cut, const double *at,
                   uint32_t knots) {
    aisle_waypoint_msg *w = path->w;
    const aisle_waypoint_msg ends[2] = {w[i - 1], w[i]};
    const uint32_t first = to - knots;
    for (uint32_t k = 0; k < knots; k++) {
        w[first + k] = aisle_piece_part(&ends[1], at[k] / cut->length);
        w[first + k].v = w[first + k].a = ends[1].a;
    }
    w[to] = ends[1];
    for (uint32_t k = 0; k <= knots && knots > 0; k++) {
        const aisle_waypoint_msg *from = k > 0 ? &w[first + k - 1U] : &ends[0];
        w[first + k].s = aisle_float_below(aisle_piece_length(from, &w[first + k]));
    }
    if (path->dwell != NULL) {
        path->dwell[to] = path->dwell[i];
        for (uint32_t k = 0; k < knots; k++) {
            path->dwell[first + k] = 0.0F;
        }
    }
}

// False: none.
static bool put_ramps(const aisle_vehicle *vehicle, const aisle_profile_start *start, aisle_profile_path *path) {
    uint32_t last;
    uint32_t shift = count_knots(vehicle, start, path, &last);
    const uint32_t n = path->n + shift;
    const bool any = shift > 0;
    for (uint32_t i = path->n; i-- > 1 && shift > 0;) { // no shift is left at the first `whole`
        ramp cut = {0};
        double at[2] = {0.0, 0.0};
        const uint32_t knots = i <= last && find_ramp(vehicle, start, path->w, i, &cut) ? knots_of(&cut, at) : 0;
        spread(path, i, i + shift, &cut, at, knots);
        path->mark += path->mark == i ? shift : 0U; // not met again: what comes is before i
        shift -= knots;
    }
    path->n = n;
    return any;
}

// ---- the whole

static bool is_fit_to_fill(const aisle_vehicle *vehicle, const aisle_layout *layout, const aisle_waypoint_msg *w,
                           uint32_t n, const float *dwell, const aisle_profile_start *start) {
    return vehicle != NULL && w != NULL && start != NULL && n > 0 && path_is_fit(w, n, dwell) &&
           start_is_fit(w, n, dwell, start) && (layout == NULL || aisle_layout_is_in_force(layout));
}

// The limit of the first piece, whatever `most` says.
static float bound_speeds(const aisle_vehicle *vehicle, const aisle_layout *layout, const aisle_profile_start *start,
                          aisle_waypoint_msg *w, uint32_t n) {
    AISLE_ASSERT(vehicle->v_max > 0.0 && vehicle->v_reverse_max > 0.0 && vehicle->creep_speed > 0.0);
    AISLE_ASSERT(vehicle->a_max > 0.0 && vehicle->d_max > 0.0 && vehicle->omega_max > 0.0 && vehicle->alpha_max > 0.0);
    bound_pieces(vehicle, layout, w, n);
    const float limit = n > 1 ? w[1].a : 0.0F;
    bound_waypoints(w, n);
    bound_by_most(vehicle, start, w, n);
    w[0].v = aisle_float_below(start->v);
    bound_accelerations(vehicle, w, n);
    return limit;
}

static aisle_status finish(const aisle_vehicle *vehicle, aisle_waypoint_msg *w, uint32_t n, const float *dwell,
                           float limit, aisle_profile_sum *sum) {
    const bool is_fit = fit_start(vehicle, w, n, limit);
    const aisle_status st = lay_out(vehicle, w, n, dwell, sum);
    return st == AISLE_OK && !is_fit ? AISLE_PARTIAL : st;
}

aisle_status aisle_profile_fill(const aisle_vehicle *vehicle, const aisle_layout *layout, aisle_waypoint_msg *w,
                                uint32_t n, const float *dwell, aisle_profile_sum *sum) {
    static const aisle_profile_start at_rest = {0.0, NULL};
    return aisle_profile_fill_moving(vehicle, layout, w, n, dwell, &at_rest, sum);
}

aisle_status aisle_profile_fill_moving(const aisle_vehicle *vehicle, const aisle_layout *layout, aisle_waypoint_msg *w,
                                       uint32_t n, const float *dwell, const aisle_profile_start *start,
                                       aisle_profile_sum *sum) {
    if (sum == NULL || !is_fit_to_fill(vehicle, layout, w, n, dwell, start)) {
        return AISLE_ERR_ARG;
    }
    const float limit = bound_speeds(vehicle, layout, start, w, n);
    return finish(vehicle, w, n, dwell, limit, sum);
}

aisle_status aisle_profile_fill_ramps(const aisle_vehicle *vehicle, const aisle_layout *layout,
                                      aisle_profile_path *path, const aisle_profile_start *start,
                                      aisle_profile_sum *sum) {
    if (path == NULL || sum == NULL || path->capacity < path->n ||
        !is_fit_to_fill(vehicle, layout, path->w, path->n, path->dwell, start)) {
        return AISLE_ERR_ARG;
    }
    const float limit = bound_speeds(vehicle, layout, start, path->w, path->n);
    if (put_ramps(vehicle, start, path)) {
        bound_accelerations(vehicle, path->w, path->n);
    }
    return finish(vehicle, path->w, path->n, path->dwell, limit, sum);
}
