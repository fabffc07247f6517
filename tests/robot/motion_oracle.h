// motion_oracle.h - a path as a motion by the words of the contract, in long double: arcs by their centre, times by
// bisection, a vehicle on it in small steps. Shares nothing with src/ but the structs. For tests/robot and tests/plan.
#ifndef AISLE_TESTS_MOTION_ORACLE_H
#define AISLE_TESTS_MOTION_ORACLE_H

#include "random_path.h"
#include "robot/motion.h"

typedef long double real;

static inline real wide(double x) {
    return (real)x;
}

static inline bool spot(const aisle_waypoint_msg *w, uint32_t i) { // piece i is a turn
    return (w[i - 1].flags & AISLE_WAYPOINT_TURN_IN_PLACE) != 0;
}

static inline real turn_of(const aisle_waypoint_msg *w, uint32_t i) {
    return remainderl(wide(w[i].theta) - wide(w[i - 1].theta), 2.0L * acosl(-1.0L));
}

static inline bool waits(const aisle_waypoint_msg *w, uint32_t i) {
    return spot(w, i) && fabsl(turn_of(w, i)) < 5e-7L;
}

static inline real length_of(const aisle_waypoint_msg *w, uint32_t i) {
    const real chord = hypotl(wide(w[i].x) - wide(w[i - 1].x), wide(w[i].y) - wide(w[i - 1].y));
    const real k = fabsl((real)w[i].curvature);
    if (spot(w, i)) {
        return 0.0L;
    }
    return k * chord < 1e-7L ? chord * (1.0L + k * k * chord * chord / 24.0L)
                             : 2.0L * asinl(fminl(1.0L, 0.5L * k * chord)) / k;
}

static inline real way_of(const aisle_waypoint_msg *w, uint32_t i) {
    return waits(w, i) ? 0.0L : (spot(w, i) ? fabsl(turn_of(w, i)) : length_of(w, i));
}

static inline real oracle_length(const aisle_waypoint_msg *w, aisle_place p) {
    real length = 0.0L;
    for (uint32_t i = 1; i < p.piece; i++) {
        length += length_of(w, i);
    }
    return length + wide(p.u) * length_of(w, p.piece);
}

static inline void oracle_pose(const aisle_waypoint_msg *w, aisle_place p, real *pose) {
    const aisle_waypoint_msg *a = &w[p.piece - 1], *b = &w[p.piece];
    const real dx = wide(b->x) - wide(a->x), dy = wide(b->y) - wide(a->y), chord = hypotl(dx, dy), u = wide(p.u);
    const real k = (real)b->curvature;
    pose[0] = wide(a->x) + u * dx;
    pose[1] = wide(a->y) + u * dy;
    pose[2] = wide(a->theta) + u * turn_of(w, p.piece);
    if (!spot(w, p.piece) && fabsl(k) * chord > 1e-7L) {
        const real r = fmaxl(1.0L / fabsl(k), 0.5L * chord), side = k > 0.0L ? 1.0L : -1.0L;
        const real height = sqrtl(fmaxl(r * r - 0.25L * chord * chord, 0.0L));
        const real cx = wide(a->x) + 0.5L * dx - side * height * dy / chord;
        const real cy = wide(a->y) + 0.5L * dy + side * height * dx / chord;
        const real from = atan2l(wide(a->y) - cy, wide(a->x) - cx);
        const real sweep = side * 2.0L * asinl(fminl(1.0L, 0.5L * chord / r));
        pose[0] = cx + r * cosl(from + u * sweep);
        pose[1] = cy + r * sinl(from + u * sweep);
    }
}

static inline real trapezoid_time(real way, real most, real up, real down) {
    const real peak = fminl(most, sqrtl(2.0L * way / (1.0L / up + 1.0L / down)));
    const real ramps = 0.5L * peak * peak * (1.0L / up + 1.0L / down);
    return way > 0.0L ? peak / up + peak / down + fmaxl(way - ramps, 0.0L) / peak : 0.0L;
}

// The peak with which the trapezoid takes this time, by bisection.
static inline real trapezoid_peak(real way, real time, real up, real down) {
    real low = 1e-12L, high = sqrtl(2.0L * way / (1.0L / up + 1.0L / down));
    for (int i = 0; i < 200; i++) {
        const real middle = 0.5L * (low + high);
        *(trapezoid_time(way, middle, up, down) > time ? &low : &high) = middle;
    }
    return high;
}

// Rest before piece i begins to move, and how long it then moves.
static inline real oracle_rest(const aisle_waypoint_msg *w, const float *rests, uint32_t i, real *time) {
    const real v0 = (real)w[i - 1].v, v1 = (real)w[i].v, span = (real)w[i].t - (real)w[i - 1].t;
    real moves = span - (rests == NULL ? 0.0L : (real)rests[i - 1]);
    if (spot(w, i) && !waits(w, i)) {
        moves = trapezoid_time(way_of(w, i), wide(vehicle.omega_max), wide(vehicle.alpha_max), wide(vehicle.alpha_max));
    } else if (!spot(w, i) && v0 <= 1e-6L && v1 > 1e-6L) {
        moves = 2.0L * length_of(w, i) / (v0 + v1);
    } else if (v0 > 1e-6L) {
        moves = span;
    }
    *time = moves;
    return span - moves;
}

// Speed (rate in turns) at part u of piece i.
static inline real oracle_speed(const aisle_waypoint_msg *w, const float *rests, uint32_t i, real u) {
    const real v0 = (real)w[i - 1].v, v1 = (real)w[i].v, way = way_of(w, i);
    if (!spot(w, i) && (v0 > 1e-6L || v1 > 1e-6L)) {
        return sqrtl(v0 * v0 + u * (v1 * v1 - v0 * v0));
    }
    if (waits(w, i)) {
        return 0.0L;
    }
    real time;
    (void)oracle_rest(w, rests, i, &time);
    const real up = wide(spot(w, i) ? vehicle.alpha_max : vehicle.a_max);
    const real down = wide(spot(w, i) ? vehicle.alpha_max : vehicle.d_max);
    const real peak = trapezoid_peak(way, time, up, down);
    return fminl(peak, fminl(sqrtl(2.0L * up * u * way), sqrtl(2.0L * down * (1.0L - u) * way)));
}

// ---- driving in small steps

typedef struct driver {
    const aisle_waypoint_msg *w;
    const float *rests; // dwell
    uint32_t n, piece;
    real u, v;   // v: m/s, in a turn rad/s
    real waited; // of the rest before the next piece
    bool ended;
} driver;

static inline driver driver_at(const aisle_waypoint_msg *w, uint32_t n, const float *rests, aisle_place p, real v) {
    return (driver){.w = w, .rests = rests, .n = n, .piece = p.piece, .u = wide(p.u), .v = v, .ended = n < 2};
}

static inline bool driver_must_rest(const driver *it) {
    return it->w[it->piece].v <= 1e-6F;
}

// To the next piece where this one has ended; false: it rests still, for dt of it.
static inline bool driver_turns_over(driver *it, real dt) {
    real moves;
    if (it->u < 1.0L) {
        return true;
    }
    it->v = driver_must_rest(it) ? 0.0L : it->v;
    it->ended = it->piece + 1 >= it->n;
    if (it->ended) {
        return false;
    }
    if (it->waited < oracle_rest(it->w, it->rests, it->piece + 1, &moves)) {
        it->waited += dt;
        return false;
    }
    it->waited = 0.0L;
    it->piece++;
    it->u = 0.0L;
    return true;
}

// Goes on by the path for dt; a speed above the path's is braked down first.
static inline void driver_follow(driver *it, real dt) {
    real moves;
    if (it->ended || !driver_turns_over(it, dt)) {
        return;
    }
    if (waits(it->w, it->piece)) {
        (void)oracle_rest(it->w, it->rests, it->piece, &moves);
        it->u += dt / moves;
        return;
    }
    const real path_v = oracle_speed(it->w, it->rests, it->piece, fmaxl(it->u, 1e-12L));
    it->v = spot(it->w, it->piece) ? path_v : fmaxl(path_v, it->v - wide(vehicle.d_max) * dt);
    it->u += it->v * dt / way_of(it->w, it->piece);
}

// Brakes for dt; false: it is at rest.
static inline bool driver_brake(driver *it, real dt) {
    if (it->ended) {
        return false;
    }
    if (it->u >= 1.0L) {
        if (driver_must_rest(it) || it->piece + 1 >= it->n) {
            return false;
        }
        it->piece++;
        it->u = 0.0L;
    }
    const bool turns = spot(it->w, it->piece);
    it->v -= (turns ? wide(vehicle.alpha_max) : wide(vehicle.d_max)) * dt;
    if (it->v <= 0.0L || waits(it->w, it->piece)) {
        return false;
    }
    it->u += it->v * dt / way_of(it->w, it->piece);
    return true;
}

static inline aisle_place driver_place(const driver *it) {
    return (aisle_place){it->piece, (double)fminl(it->u, 1.0L)};
}
#endif
