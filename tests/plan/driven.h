// driven.h - fixture for tests of speeds among movers: short random ways, and every braking motion of a lease by small steps.
//
// The judge shares nothing with src/ but the structs: motion_oracle.h drives, gaps are measured by brute force.
#ifndef AISLE_TESTS_DRIVEN_H
#define AISLE_TESTS_DRIVEN_H

#include "../robot/motion_oracle.h"
#include "robot/profile.h"

#include <string.h>

enum { SAMPLES = 400000 };

typedef struct sample { // the vehicle moving
    real x, y, theta, t;
    uint32_t piece;
} sample;

static sample samples[SAMPLES];
static uint32_t sampled;

static inline void note(const driver *it, real t) {
    real pose[3];
    TEST_ASSERT_LESS_THAN_UINT32(SAMPLES, sampled);
    oracle_pose(it->w, driver_place(it), pose);
    samples[sampled++] = (sample){pose[0], pose[1], pose[2], t, it->piece};
}

// Is it moving, or turning?
static inline bool driver_moves(const driver *it) {
    return !it->ended && it->v > 0.0L && it->u < 1.0L;
}

// All places where a vehicle that drives on from p at v may be moving, told to brake at any of the instants of the lease.
static inline void drive_all(const aisle_waypoint_msg *w, uint32_t n, const float *rests, aisle_place p, real v,
                             real lease, real dt, uint32_t every) {
    const real reaction = wide(vehicle.reaction_time);
    driver ahead = driver_at(w, n, rests, p, v);
    sampled = 0;
    uint32_t step = 0;
    for (real t = 0.0L; t <= reaction + lease + 0.5L * dt; t += dt, step++) {
        if (driver_moves(&ahead)) {
            note(&ahead, t);
        }
        const bool last = t + dt > reaction + lease + 0.5L * dt;
        if (t >= reaction - 0.5L * dt && (step % every == 0 || last)) {
            driver braking = ahead;
            for (real later = t + dt; driver_brake(&braking, dt); later += dt) {
                note(&braking, later);
            }
        }
        driver_follow(&ahead, dt);
    }
}

// ---- gaps

static inline real edge_gap(real px, real py, real ax, real ay, real bx, real by) {
    const real ex = bx - ax, ey = by - ay, square = ex * ex + ey * ey;
    const real f = square > 0.0L ? fminl(fmaxl(((px - ax) * ex + (py - ay) * ey) / square, 0.0L), 1.0L) : 0.0L;
    return hypotl(px - ax - f * ex, py - ay - f * ey);
}

// From a point to the body at a pose; 0 inside.
static inline real body_gap(const sample *at, real px, real py) {
    const real c = cosl(at->theta), s = sinl(at->theta), dx = px - at->x, dy = py - at->y;
    const real x = c * dx + s * dy, y = c * dy - s * dx; // the point as the vehicle sees it
    real least = 1e9L;
    bool inside = vehicle.n > 2;
    for (uint32_t i = 0; i < vehicle.n; i++) {
        const aisle_vec2 a = vehicle.footprint[i], b = vehicle.footprint[(i + 1) % vehicle.n];
        least = fminl(least, edge_gap(x, y, wide(a.x), wide(a.y), wide(b.x), wide(b.y)));
        inside =
            inside && (wide(b.x) - wide(a.x)) * (y - wide(a.y)) - (wide(b.y) - wide(a.y)) * (x - wide(a.x)) >= 0.0L;
    }
    return inside ? 0.0L : fmaxl(least - wide(vehicle.radius), 0.0L);
}

// How much the body keeps off a growing disc, at the worst of all samples, `lag` late.
static inline real worst_slack(real px, real py, real reach, real bound, real lag) {
    real worst = 1e9L;
    for (uint32_t i = 0; i < sampled; i++) {
        const real radius = reach + bound * (samples[i].t + lag);
        const real coarse = hypotl(px - samples[i].x, py - samples[i].y) - wide(vehicle.outer_radius) - radius;
        if (coarse < worst) {
            worst = fminl(worst, body_gap(&samples[i], px, py) - radius);
        }
    }
    return worst;
}

// ---- ways

static aisle_profile_sum way_sum;
static double way_piece_max = 3.0; // m

static inline void fill_way(void) {
    TEST_ASSERT_EQUAL_INT(AISLE_OK, aisle_profile_fill(&vehicle, NULL, path, count, dwell, &way_sum));
}

// Lines and arcs of up to way_piece_max, stops with and without dwell, turns, changes of direction if asked for.
static inline void random_way(uint64_t seed, uint32_t pieces, bool reverses) {
    aisle_rng rng = aisle_rng_seed(seed ^ 0xd01eU);
    const style how = {.piece_max = seed % 3 == 0 ? 0.6 : way_piece_max, .radius_min = 0.5};
    bool back = false;
    count = 0;
    memset(dwell, 0, sizeof dwell);
    (void)add(uniform(&rng, -5.0, 5.0), uniform(&rng, -5.0, 5.0), uniform(&rng, -3.0, 3.0));
    while (count < pieces) {
        const uint32_t what = aisle_rng_below(&rng, 12);
        back = what == 0 && reverses ? !back : back;
        if (what == 1 && count > 1) {
            add_turn(&rng);
            path[count - 1].clearance = 3.0F;
        } else {
            add_piece(&rng, &how, back);
        }
        path[count - 1].clearance = aisle_rng_below(&rng, 6) == 0 ? 0.2F : 3.0F;
        if (what == 2) {
            set_flag(&path[count - 1], AISLE_WAYPOINT_STOP);
            dwell[count - 1] = aisle_rng_below(&rng, 2) == 0 ? 0.0F : (float)uniform(&rng, 0.0, 1.0);
        }
    }
    fill_way();
}

// With the rest before the piece ahead: a waypoint is arrived at.
static inline aisle_place random_place(aisle_rng *rng) {
    const uint32_t piece = 1 + aisle_rng_below(rng, count - 1), what = aisle_rng_below(rng, 4);
    return (aisle_place){piece, what == 0 ? 1.0 : uniform(rng, 1e-3, 1.0)};
}

// Every third a disc, every third with limits of its own.
static inline void some_vehicle(uint64_t seed) {
    aisle_rng rng = aisle_rng_seed(seed ^ 0xca7U);
    aisle_vehicle_msg msg = {0};
    if (seed % 3 == 1) {
        msg.footprint_radius = (float)uniform(&rng, 0.2, 0.6);
    }
    if (seed % 3 == 2) {
        msg.v_max = (float)uniform(&rng, 0.5, 2.5);
        msg.a_max = (float)uniform(&rng, 0.3, 1.5);
        msg.d_max = (float)uniform(&rng, 0.3, 1.5);
        msg.alpha_max = (float)uniform(&rng, 0.5, 3.0);
        msg.reaction_time = (float)uniform(&rng, 0.05, 0.6);
    }
    set_vehicle(&msg);
}
#endif
