#include "base/angle.h"
#include "base/check.h"
#include "plan/route_stages.h"
#include "robot/profile.h"

#include <math.h>
#include <string.h>

// A remembered answer that a new obstacle stands on: the waypoints of each leg as a polyline about its arcs, what is blocked
// of it replaced by the shortest way of a disc between free places before and behind; of a tree's answer by the way that a
// tree of the same kind finds between them.

#define SHARE 4U      // a quarter of the budget at most: what is left can still plan
#define TURN_MAX 1.05 // rad, of one corner that stands for arcs
#define STRAIGHT 1e-9 // sine of an angle between pieces that are one line
#define BACK_OFF 2.0  // outer radii and creep clearances, that the way round leaves the path before what is blocked
#define TRIES 2U      // with the creep clearance to spare, and with the margin alone
#define BOUND_SPARE 1.01e-3 // m, by which freed ground may have bettered each leg unseen (cache.c)
#define TOLD 7e-3           // m
#define CREEP_SPARE 2e-3    // m, as in route_ways.c
#define MORE_SHARE 8U       // of the samples that a star draws after its first path, for a piece of one

// Plans from nothing, as if nothing had been remembered.
static aisle_status give_up(aisle_route *self) {
    return aisle_route_plan_anew(self);
}

// ---- the remembered path

static const aisle_waypoint_msg *waypoints(const aisle_route *self) {
    return self->decoded->waypoints;
}

// Are there only ways forwards and turns on the spot? Others are manoeuvres, which no polyline tells.
static bool can_be_polylines(const aisle_route *self) {
    const aisle_path_msg *path = self->decoded;
    for (int16_t i = 0; i < path->num_waypoints; i++) {
        if ((path->waypoints[i].flags & AISLE_WAYPOINT_REVERSE) != 0) {
            return false;
        }
    }
    return path->num_waypoints > 1;
}

// Of the trees, whose places are those of a disc. A roadmap is repaired itself (roadmap_keep.h).
static bool is_by_tree(const aisle_route *self) {
    return aisle_route_is_sampling(self) && self->request.options.planner != AISLE_OPTIONS_PRM;
}

// A disc's shortest way is planned with less work than a repair takes.
static bool is_wanted(const aisle_route *self) {
    const aisle_options_msg *options = &self->request.options;
    if (is_by_tree(self)) {
        return options->objective != AISLE_OPTIONS_PAPER && !aisle_route_has_heading(self);
    }
    const bool planner = options->planner == AISLE_OPTIONS_AUTO || options->planner == AISLE_OPTIONS_ASTAR;
    const bool is_quick = options->objective == AISLE_OPTIONS_SHORTEST && aisle_vehicle_is_disc(self->vehicle);
    return planner && !is_quick && !(self->vehicle->curvature_max > 0.0) && aisle_layout_has_blocks(self->layout);
}

bool aisle_route_begin_repair(aisle_route *self, const aisle_cache_question *question) {
    aisle_cache_found found;
    aisle_route_repair *repair = &self->repair;
    if (!is_wanted(self) ||
        aisle_cache_find_repairable(&self->cache, question, self->spare.bytes, &found) == AISLE_CACHE_NONE ||
        aisle_msg_decode(AISLE_MSG_PATH, self->spare.bytes, found.size, self->decoded, NULL) != AISLE_OK ||
        !can_be_polylines(self)) {
        return false;
    }
    for (int16_t i = 0; i < self->request.num_goals; i++) {
        self->request.goals[i] = self->asked[found.order[i]];
    }
    const double spare = BOUND_SPARE * (double)self->request.num_goals;
    const double bound = aisle_min((double)self->decoded->length_bound, (double)self->decoded->length - spare);
    *repair = (aisle_route_repair){.worth = found.worth, .bound = aisle_max(bound, 0.0), .at = 1U};
    self->leg = 0;
    self->point_count = 0;
    aisle_route_begin_repair_way(self);
    return true;
}

// ---- a leg's pieces

static aisle_vec2 place_of(const aisle_waypoint_msg *w) {
    return aisle_vec2_of(w->x, w->y);
}

static bool push(aisle_route *self, aisle_vec2 p) {
    aisle_leg *leg = &self->legs[self->leg];
    aisle_vec2 *points = self->points + leg->first;
    if (leg->count > 0U && aisle_vec2_distance(points[leg->count - 1U], p) < 1e-6) {
        return true;
    }
    if (leg->count > 1U) { // no point within a straight line
        const aisle_vec2 last = aisle_vec2_sub(points[leg->count - 1U], points[leg->count - 2U]);
        const aisle_vec2 next = aisle_vec2_sub(p, points[leg->count - 1U]);
        const double across = aisle_vec2_cross(last, next), along = aisle_vec2_dot(last, next);
        leg->count -= along > 0.0 && fabs(across) <= STRAIGHT * along ? 1U : 0U;
    }
    if (leg->count == AISLE_SEED_POINTS_MAX) {
        return false;
    }
    points[leg->count++] = p;
    return true;
}

static bool is_arc(const aisle_waypoint_msg *to) {
    return fabs((double)to->curvature) > 0.0;
}

// From waypoint `from` on, pieces of one arc, as many as turn by TURN_MAX at most but no further than `end`: the waypoint
// they end at. *corner: where the tangents at both ends meet.
static uint32_t take_arc(const aisle_route *self, uint32_t from, uint32_t end, aisle_vec2 *corner) {
    const aisle_waypoint_msg *w = waypoints(self);
    const float curvature = w[from + 1U].curvature;
    uint32_t to = from;
    double turn = 0.0;
    aisle_vec2 unit;
    do {
        turn += aisle_piece_turn(&w[to], &w[to + 1U]);
        to++;
    } while (to < end && is_arc(&w[to + 1U]) && memcmp(&w[to + 1U].curvature, &curvature, sizeof curvature) == 0 &&
             fabs(turn + aisle_piece_turn(&w[to], &w[to + 1U])) <= TURN_MAX);
    double sine, cosine;
    aisle_sincos(w[from].theta, &unit.y, &unit.x);
    aisle_sincos(0.5 * fabs(turn), &sine, &cosine);
    const double ahead = sine / (aisle_max(cosine, 0.1) * fabs((double)curvature));
    *corner = aisle_vec2_add(place_of(&w[from]), aisle_vec2_scale(unit, ahead));
    return to;
}

// Appends the way from waypoint `from` to waypoint `to`.
static bool push_pieces(aisle_route *self, uint32_t from, uint32_t to) {
    const aisle_waypoint_msg *w = waypoints(self);
    bool fits = push(self, place_of(&w[from]));
    for (uint32_t at = from; at < to && fits;) {
        aisle_vec2 corner;
        if (is_arc(&w[at + 1U])) {
            at = take_arc(self, at, to, &corner);
            fits = push(self, corner);
        } else {
            at++;
        }
        const bool bends_next = at < to && is_arc(&w[at + 1U]);
        fits = fits && (bends_next || push(self, place_of(&w[at])));
    }
    return fits;
}

// ---- what is blocked

// m, that the piece is to keep: but for SHORTEST, what it kept of the creep clearance, told and tested to 6 mm.
static double need_of(const aisle_route *self, const aisle_waypoint_msg *to) {
    const double least = self->vehicle->margin + 0.5 * AISLE_SPACE_SLACK;
    const double kept = aisle_min((double)to->clearance, self->vehicle->creep_clearance) - TOLD;
    return self->request.options.objective == AISLE_OPTIONS_SHORTEST ? least : aisle_max(kept, least);
}

// The next piece of the leg under way. True: the leg ends there.
static bool look_at_piece(aisle_route *self) {
    aisle_route_repair *repair = &self->repair;
    const aisle_waypoint_msg *w = waypoints(self);
    const uint32_t at = repair->at++;
    if (!aisle_space_piece_free(&self->space, &w[at - 1U], &w[at], need_of(self, &w[at]), &self->spent)) {
        repair->first = repair->last > 0U ? repair->first : at - 1U;
        repair->last = at;
    }
    return (w[at].flags & AISLE_WAYPOINT_GOAL) != 0 || repair->at == (uint32_t)self->decoded->num_waypoints;
}

// The waypoint `metres` or more from waypoint `from` along the way, not beyond `end`; step: 1 or -1.
static uint32_t away_from(const aisle_route *self, uint32_t from, uint32_t end, double metres, int step) {
    const aisle_waypoint_msg *w = waypoints(self);
    uint32_t at = from;
    while (at != end && fabs((double)w[at].s - (double)w[from].s) < metres) {
        at = (uint32_t)((int32_t)at + step);
    }
    return at;
}

// A tree from the free place before what is blocked to the one behind it.
static void begin_tree(aisle_route *self) {
    aisle_route_repair *repair = &self->repair;
    const aisle_waypoint_msg *from = &waypoints(self)[repair->first], *to = &waypoints(self)[repair->last];
    aisle_vehicle_space_begin(&self->sample.configurations, &self->space, AISLE_VEHICLE_SPACE_PLACE);
    aisle_rrt_config cfg = aisle_route_tree_config(self);
    cfg.more /= MORE_SHARE;
    cfg.start[0] = from->x;
    cfg.start[1] = from->y;
    cfg.goal[0] = to->x;
    cfg.goal[1] = to->y;
    const aisle_status st = aisle_rrt_start(&self->sample.tree, &cfg);
    AISLE_ASSERT(st == AISLE_OK);
    repair->phase = AISLE_ROUTE_REPAIR_TREE;
}

static bool begin_search(aisle_route *self) {
    if (is_by_tree(self)) {
        begin_tree(self);
        return true;
    }
    aisle_route_repair *repair = &self->repair;
    const aisle_vehicle *vehicle = self->vehicle;
    const double keep = vehicle->margin + AISLE_SPACE_SLACK;
    const double creep = aisle_max(vehicle->creep_clearance + CREEP_SPARE, keep);
    const bool is_short = self->request.options.objective == AISLE_OPTIONS_SHORTEST;
    repair->tries += is_short && repair->tries == 0U ? 1U : 0U;
    if (repair->tries >= TRIES) {
        return false;
    }
    repair->radius = vehicle->outer_radius + (repair->tries++ == 0U ? creep : keep);
    repair->phase = AISLE_ROUTE_REPAIR_SEARCH;
    aisle_tangent_start(&self->tangent, self->layout, repair->radius, place_of(&waypoints(self)[repair->first]),
                        place_of(&waypoints(self)[repair->last]));
    return true;
}

static aisle_status end_leg(aisle_route *self) {
    self->repair.leg_start = self->repair.leg_end;
    self->point_count += self->legs[self->leg].count;
    aisle_route_next_leg(self);
    return AISLE_BUSY;
}

// All of the leg was looked at.
static aisle_status take_leg(aisle_route *self) {
    aisle_route_repair *repair = &self->repair;
    const double room = BACK_OFF * (self->vehicle->outer_radius + self->vehicle->creep_clearance);
    repair->leg_end = repair->at - 1U;
    if (repair->last == 0U) {
        return push_pieces(self, repair->leg_start, repair->leg_end) ? end_leg(self) : give_up(self);
    }
    repair->first = away_from(self, repair->first, repair->leg_start, room, -1);
    repair->last = away_from(self, repair->last, repair->leg_end, room, 1);
    repair->tries = 0;
    return push_pieces(self, repair->leg_start, repair->first) && begin_search(self) ? AISLE_BUSY : give_up(self);
}

static aisle_status search(aisle_route *self, uint32_t units) {
    aisle_route_repair *repair = &self->repair;
    aisle_leg *leg = &self->legs[self->leg];
    const aisle_status st = aisle_tangent_step(&self->tangent, units, &self->spent);
    if (st == AISLE_BUSY) {
        return AISLE_BUSY;
    }
    if (st != AISLE_OK) {
        return begin_search(self) ? AISLE_BUSY : give_up(self);
    }
    const uint32_t kept = leg->count - 1U; // its last point is the first one of the way found
    const uint32_t n = aisle_tangent_points(&self->tangent, repair->radius, self->points + leg->first + kept,
                                            AISLE_SEED_POINTS_MAX - kept);
    if (n == 0U) {
        return give_up(self);
    }
    leg->count = kept + n;
    return push_pieces(self, repair->last, repair->leg_end) ? end_leg(self) : give_up(self);
}

static aisle_status grow(aisle_route *self, uint32_t units) {
    const aisle_route_repair *repair = &self->repair;
    aisle_route_sample *sample = &self->sample;
    const aisle_status st = aisle_rrt_step(&sample->tree, units, &self->spent);
    if (st == AISLE_BUSY) {
        return AISLE_BUSY;
    }
    const uint32_t most = sample->tree.capacity + 1U;
    const uint32_t count = st == AISLE_OK ? aisle_rrt_path(&sample->tree, sample->path, most) : 0U;
    bool fits = count > 0U;
    for (uint32_t i = 1; i < count && fits; i++) {
        const double *q = aisle_rrt_at(&sample->tree, sample->path[i]);
        fits = push(self, aisle_vec2_of(q[0], q[1]));
    }
    return fits && push_pieces(self, repair->last, repair->leg_end) ? end_leg(self) : give_up(self);
}

// ---- all together

void aisle_route_begin_repair_leg(aisle_route *self) {
    aisle_route_repair *repair = &self->repair;
    const bool is_disc = aisle_vehicle_is_disc(self->vehicle);
    self->legs[self->leg] = (aisle_leg){.first = self->point_count,
                                        .seed_value = -1.0,
                                        .swarm_value = -1.0,
                                        .mode = is_disc ? AISLE_SPACE_FREE_TURN : AISLE_SPACE_ALONG,
                                        .bound = self->leg == 0U ? repair->bound : 0.0,
                                        .is_sampled = is_by_tree(self)};
    aisle_space_begin(&self->space, self->layout, self->vehicle, self->legs[self->leg].mode);
    aisle_route_begin_zones(self);
    aisle_route_take_heading(self);
    repair->first = repair->last = 0;
    repair->phase = AISLE_ROUTE_REPAIR_LOOK;
    self->stage = AISLE_ROUTE_REPAIR;
}

aisle_status aisle_route_step_repair(aisle_route *self, uint32_t units) {
    aisle_route_repair *repair = &self->repair;
    if (self->spent > self->budget / SHARE) {
        return give_up(self);
    }
    if (repair->phase == AISLE_ROUTE_REPAIR_SEARCH) {
        return search(self, units);
    }
    if (repair->phase == AISLE_ROUTE_REPAIR_TREE) {
        return grow(self, units);
    }
    if (repair->at >= (uint32_t)self->decoded->num_waypoints ||
        AISLE_ROUTE_POINTS - self->point_count < AISLE_SEED_POINTS_MAX) {
        return give_up(self);
    }
    return look_at_piece(self) ? take_leg(self) : AISLE_BUSY;
}

aisle_status aisle_route_end_repair(aisle_route *self, bool is_proved) {
    const bool is_short = self->request.options.objective == AISLE_OPTIONS_SHORTEST;
    const bool is_tree = is_by_tree(self);
    const double best = is_short && !is_tree ? self->repair.bound : self->repair.worth;
    const double slack = is_tree ? AISLE_CACHE_REPAIR_TREE : AISLE_CACHE_REPAIR;
    if (!is_proved || !(aisle_route_measure(self) <= best * (1.0 + slack))) {
        return give_up(self);
    }
    aisle_route_judge(self, false);
    self->repair.is_done = true;
    self->cache.repaired++;
    self->stage = AISLE_ROUTE_END;
    return AISLE_OK;
}
