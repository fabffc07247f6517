#include "plan/vehicle_space.h"

#include "base/angle.h"
#include "base/check.h"

#include <string.h>

#define REVERSE 2.0      // of a metre backwards, of one forwards
#define CUSP 1.0         // m, cost of a change between forwards and backwards
#define TURN_START 0.3   // m, of a turn on the spot
#define TURN_RATE 0.3    // m a rad, and of each rad of it
#define TRIES 1000U      // to draw within bounds
#define SAMPLES 4000000U // of a tree until there is a path
#define MORE 6000U       // of a star, after that
#define PLAIN 100000U    // samples of the paper's form
#define HALVINGS 2U      // of a motion that is not free, but in the paper's form
#define GOAL_BIAS 0.05
#define STEP_SHARE 0.2 // of the bounds' diagonal: the step where none is asked for
#define TINY 1e-9      // m
#define ROOM 1.5       // cells, beyond the reach, that a place moved off an obstacle has if there is room
#define CLIMB 64U      // cells that it is moved, at most
#define PROBES 64U     // parts of a motion that are looked at in the field first, at most

aisle_steer_rule aisle_vehicle_space_rule(const aisle_vehicle *vehicle) {
    // Not the tightest arc: the verifier reads the curvature as a float.
    const double radius = vehicle->curvature_max > 0.0 ? (1.0 + 1e-6) / vehicle->curvature_max : 0.0;
    return (aisle_steer_rule){
        .radius_min = radius, .reverse = REVERSE, .cusp = CUSP, .turn_start = TURN_START, .turn_rate = TURN_RATE};
}

// ---- both kinds

static double draw_between(aisle_rng *rng, double lo, double hi) {
    return lo + (hi - lo) * (double)aisle_rng_float(rng);
}

static void draw_anywhere(void *context, aisle_rng *rng, double *q) {
    const aisle_cspace *space = &((const aisle_vehicle_space *)context)->cspace;
    for (uint32_t d = 0; d < space->dim; d++) {
        q[d] = draw_between(rng, space->lo[d], space->hi[d]);
    }
}

static bool is_inside(const aisle_cspace *space, aisle_vec2 p) {
    return p.x >= space->lo[0] && p.x <= space->hi[0] && p.y >= space->lo[1] && p.y <= space->hi[1];
}

// Places of the ellipse with foci a and b whose points are `most` from both together; any heading.
static void draw_in_ellipse(void *context, aisle_rng *rng, const double *a, const double *b, double most, double *q) {
    const aisle_cspace *space = &((const aisle_vehicle_space *)context)->cspace;
    const aisle_vec2 from = {a[0], a[1]}, to = {b[0], b[1]};
    const double apart = aisle_vec2_distance(from, to);
    const aisle_vec2 along =
        apart > TINY ? aisle_vec2_scale(aisle_vec2_sub(to, from), 1.0 / apart) : aisle_vec2_of(1.0, 0.0);
    const double half_long = 0.5 * aisle_max(most, apart);
    const double half_wide = sqrt(aisle_max(half_long * half_long - 0.25 * apart * apart, 0.0));
    draw_anywhere(context, rng, q);
    for (uint32_t i = 0; i < TRIES; i++) {
        const double u = draw_between(rng, -1.0, 1.0), v = draw_between(rng, -1.0, 1.0);
        const aisle_vec2 off = {u * half_long * along.x - v * half_wide * along.y,
                                u * half_long * along.y + v * half_wide * along.x};
        const aisle_vec2 p = aisle_vec2_add(aisle_vec2_lerp(from, to, 0.5), off);
        if (u * u + v * v <= 1.0 && is_inside(space, p)) {
            q[0] = p.x;
            q[1] = p.y;
            return;
        }
    }
}

// Uphill in the field from a place that is too near to an obstacle, cell by cell, until the disc fits or on a ridge. What is
// within an obstacle stays: nothing is uphill there.
static void move_off(void *context, double *q) {
    const aisle_space *space = ((const aisle_vehicle_space *)context)->space;
    const aisle_lattice *lattice = &space->grid->lattice;
    const uint16_t *field = space->grid->field;
    const double enough = space->reach / lattice->res + ROOM, squared = enough * enough;
    if (!aisle_space_is_covered(space, aisle_vec2_of(q[0], q[1]))) {
        return;
    }
    uint32_t at = aisle_lattice_cell(lattice, aisle_vec2_of(q[0], q[1]), NULL);
    for (uint32_t steps = 0; steps < CLIMB && (double)field[at] < squared; steps++) {
        const uint32_t x = at % lattice->w, y = at / lattice->w;
        uint32_t best = at;
        for (uint32_t iy = y > 0U ? y - 1U : 0U; iy <= y + 1U && iy < lattice->h; iy++) {
            for (uint32_t ix = x > 0U ? x - 1U : 0U; ix <= x + 1U && ix < lattice->w; ix++) {
                best = field[iy * lattice->w + ix] > field[best] ? iy * lattice->w + ix : best;
            }
        }
        if (best == at) {
            return;
        }
        q[0] += lattice->res * ((double)(best % lattice->w) - (double)x);
        q[1] += lattice->res * ((double)(best / lattice->w) - (double)y);
        at = best;
    }
}

static double length_between(void *context, const double *a, const double *b) {
    (void)context;
    return aisle_vec2_distance(aisle_vec2_of(a[0], a[1]), aisle_vec2_of(b[0], b[1]));
}

// ---- PLACE

static void go_straight(void *context, const double *a, const double *b, double part, double *q) {
    (void)context;
    const aisle_vec2 p = aisle_vec2_lerp(aisle_vec2_of(a[0], a[1]), aisle_vec2_of(b[0], b[1]), part);
    q[0] = part < 1.0 ? p.x : b[0];
    q[1] = part < 1.0 ? p.y : b[1];
}

// Does one look at the field each say that the end, or a place between, is covered? The ways halved, quartered and so on,
// until places lie nearer together than what covers them is wide.
static bool is_surely_blocked(const aisle_vehicle_space *self, aisle_vec2 a, aisle_vec2 b) {
    if (self->space->covered_until == 0U) { // so small a body covers no cell
        return false;
    }
    if (aisle_space_is_covered(self->space, b)) {
        return true;
    }
    const double most = aisle_vec2_distance(a, b) / (2.0 * self->space->reach);
    for (uint32_t parts = 2; parts <= PROBES && (double)parts < 2.0 * most; parts *= 2U) {
        for (uint32_t i = 1; i < parts; i += 2U) {
            if (aisle_space_is_covered(self->space, aisle_vec2_lerp(a, b, (double)i / parts))) {
                return true;
            }
        }
    }
    return false;
}

static bool is_straight_free(void *context, const double *a, const double *b, uint32_t *units) {
    const aisle_vehicle_space *self = (const aisle_vehicle_space *)context;
    const aisle_vec2 from = aisle_vec2_of(a[0], a[1]), to = aisle_vec2_of(b[0], b[1]);
    *units += 1U;
    return !is_surely_blocked(self, from, to) && aisle_space_sweep_free(self->space, from, to, units);
}

// ---- POSE

void aisle_vehicle_space_of_pose(const aisle_vehicle_space *self, aisle_pose2 pose, double *q) {
    q[0] = pose.x;
    q[1] = pose.y;
    if (self->kind == AISLE_VEHICLE_SPACE_POSE) {
        const double theta = aisle_angle_wrap(pose.theta);
        q[2] = theta >= AISLE_PI ? -AISLE_PI : theta;
    }
}

aisle_pose2 aisle_vehicle_space_pose(const aisle_vehicle_space *self, const double *q) {
    return (aisle_pose2){q[0], q[1], self->kind == AISLE_VEHICLE_SPACE_POSE ? q[2] : 0.0};
}

static uint32_t cheapest(const aisle_vehicle_space *self, const double *a, const double *b, aisle_steer_way *way) {
    aisle_steer_way ways[AISLE_STEER_WAYS];
    const uint32_t count =
        aisle_steer(&self->rule, aisle_vehicle_space_pose(self, a), aisle_vehicle_space_pose(self, b), ways);
    if (count > 0U) {
        *way = ways[0];
    }
    return count;
}

uint32_t aisle_vehicle_space_moves(const aisle_vehicle_space *self, const double *a, const double *b,
                                   aisle_move *moves) {
    aisle_steer_way way;
    if (cheapest(self, a, b, &way) == 0U) {
        return 0;
    }
    memcpy(moves, way.move, way.count * sizeof *moves);
    return way.count;
}

static double cost_between(void *context, const double *a, const double *b) {
    aisle_steer_way way;
    return cheapest((const aisle_vehicle_space *)context, a, b, &way) > 0U ? way.cost : 0.0;
}

// How much of a way a move is: metres, and of turns on the spot what they count in distances.
static double share_of(aisle_move move) {
    return fabs(move.length) > 0.0 ? fabs(move.length) : AISLE_VEHICLE_SPACE_TURN * fabs(move.turn);
}

static void drive(void *context, const double *a, const double *b, double part, double *q) {
    const aisle_vehicle_space *self = (const aisle_vehicle_space *)context;
    aisle_steer_way way;
    if (part >= 1.0 || cheapest(self, a, b, &way) == 0U) {
        memcpy(q, b, 3U * sizeof *q);
        return;
    }
    double left = 0.0;
    for (uint32_t i = 0; i < way.count; i++) {
        left += part * share_of(way.move[i]);
    }
    aisle_pose2 pose = aisle_vehicle_space_pose(self, a);
    for (uint32_t i = 0; i < way.count; i++) {
        const double share = share_of(way.move[i]);
        if (left < share) {
            pose = aisle_move_end(pose, aisle_move_part(way.move[i], left / share));
            break;
        }
        pose = aisle_move_end(pose, way.move[i]);
        left -= share;
    }
    aisle_vehicle_space_of_pose(self, pose, q);
}

static bool is_way_free(void *context, const double *a, const double *b, uint32_t *units) {
    const aisle_vehicle_space *self = (const aisle_vehicle_space *)context;
    const aisle_pose2 from = aisle_vehicle_space_pose(self, a);
    aisle_steer_way way;
    *units += 1U;
    if (cheapest(self, a, b, &way) == 0U) {
        return aisle_space_gap(self->space, from, self->need, NULL) >= self->need;
    }
    return aisle_space_moves_free(self->space, from, way.move, way.count, self->need, false, units);
}

double aisle_vehicle_space_longest(const aisle_vehicle_space *self, double distance) {
    const double radius = self->rule.radius_min;
    if (self->kind == AISLE_VEHICLE_SPACE_PLACE) {
        return distance;
    }
    return radius > 0.0 ? REVERSE * (distance + 4.0 * AISLE_PI * radius) + (AISLE_REEDS_SHEPP_MOVES - 1U) * CUSP
                        : distance + 2.0 * (TURN_START + AISLE_PI * TURN_RATE);
}

// ---- all together

aisle_rrt_config aisle_vehicle_space_rrt(const aisle_vehicle_space *self, bool star, bool adaptive, bool plain,
                                         double step) {
    const aisle_aabb bounds = aisle_layout_bounds(self->space->layout);
    aisle_rrt_config cfg = {.space = &self->cspace,
                            .step = step > 0.0 ? step : STEP_SHARE * aisle_vec2_distance(bounds.lo, bounds.hi),
                            .whole_steps = plain && !adaptive,
                            .star = star,
                            .samples = plain ? PLAIN : SAMPLES,
                            .more = plain ? PLAIN : MORE};
    cfg.halvings = !adaptive ? 0U : plain ? 1U : HALVINGS;
    if (!plain) {
        cfg.informed = star;
        cfg.retract = true;
        cfg.shorten = true;
        cfg.goal_bias = GOAL_BIAS;
        cfg.reach = (double)INFINITY;
    }
    return cfg;
}

void aisle_vehicle_space_begin(aisle_vehicle_space *self, const aisle_space *space, aisle_vehicle_space_kind kind) {
    AISLE_ASSERT(kind == AISLE_VEHICLE_SPACE_POSE || space->mode == AISLE_SPACE_FREE_TURN);
    const aisle_aabb bounds = aisle_layout_bounds(space->layout);
    const double rim = kind == AISLE_VEHICLE_SPACE_PLACE ? space->reach : space->vehicle->inner_radius + space->keep;
    const bool is_pose = kind == AISLE_VEHICLE_SPACE_POSE;
    *self = (aisle_vehicle_space){.kind = kind, .space = space};
    self->rule = aisle_vehicle_space_rule(space->vehicle);
    self->need = space->vehicle->margin + 0.5 * AISLE_SPACE_SLACK;
    self->cspace = (aisle_cspace){.dim = is_pose ? 3U : 2U,
                                  .lo = {bounds.lo.x + rim, bounds.lo.y + rim, -AISLE_PI},
                                  .hi = {bounds.hi.x - rim, bounds.hi.y - rim, AISLE_PI},
                                  .weight = {1.0, 1.0, AISLE_VEHICLE_SPACE_TURN},
                                  .period = {0.0, 0.0, 2.0 * AISLE_PI},
                                  .context = self,
                                  .sample = draw_anywhere,
                                  .sample_between = draw_in_ellipse,
                                  .retract = move_off,
                                  .cost = is_pose ? cost_between : NULL,
                                  .bound = is_pose ? length_between : NULL,
                                  .steer = is_pose ? drive : go_straight,
                                  .is_free = is_pose ? is_way_free : is_straight_free};
    for (uint32_t d = 0; d < 2U; d++) { // too small a hall holds nothing, wherever it is drawn
        self->cspace.hi[d] = aisle_max(self->cspace.hi[d], self->cspace.lo[d] + TINY);
    }
}
