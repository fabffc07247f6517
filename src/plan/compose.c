#include "plan/compose.h"

#include "base/angle.h"
#include "base/check.h"
#include "plan/zones.h"
#include "robot/profile.h"

#include <math.h>

#define RISK_SPACING 0.25      // m, between places looked at for the risk
#define CORNER_RADIUS 1.0      // m, wished where it is free
#define CORNER_RADIUS_MIN 0.05 // m
#define SPLINE_SPACING 0.4     // m, between samples

void aisle_compose_carve(aisle_compose *self, aisle_arena *arena) {
    self->raw = (aisle_waypoint_msg *)aisle_arena_take(arena, AISLE_PATH_MAX_WAYPOINTS, sizeof(aisle_waypoint_msg));
    self->dwell = (float *)aisle_arena_take(arena, AISLE_PATH_MAX_WAYPOINTS, sizeof(float));
    self->spline = (aisle_spline *)aisle_arena_take(arena, 1U, sizeof(aisle_spline));
    self->sample = (aisle_spline_sample *)aisle_arena_take(arena, AISLE_SWARM_SAMPLES_MAX, sizeof(aisle_spline_sample));
}

bool aisle_goal_heading_is_free(const aisle_goal_msg *goal) {
    return (double)goal->tolerance_theta >= 3.14159;
}

bool aisle_goal_wants_turn(const aisle_goal_msg *goal, double theta) {
    double tolerance = goal->tolerance_theta > 0.0F ? (double)goal->tolerance_theta : 0.05;
    return !aisle_goal_heading_is_free(goal) && fabs(aisle_angle_difference(theta, goal->theta)) > 0.5 * tolerance;
}

// An arc no wider than what the seed's legs keep from everything is free by construction (curve.h); the verifier will
// not take that for granted.
static bool arc_is_sure(const aisle_compose *self, const aisle_waypoint_msg *to) {
    const aisle_vehicle *vehicle = self->request.space->vehicle;
    const double sure = vehicle->outer_radius + vehicle->margin;
    return aisle_vehicle_is_disc(vehicle) && !self->request.legs[self->leg].use_swarm &&
           fabs((double)to->curvature) * sure >= 1.0 - 1e-6;
}

static bool arc_free(void *ctx, const aisle_waypoint_msg *from, const aisle_waypoint_msg *to) {
    aisle_compose *self = (aisle_compose *)ctx;
    const aisle_space *space = self->request.space;
    const double need = space->vehicle->margin + 0.5 * AISLE_SPACE_SLACK;
    return aisle_zones_allow_piece(space->layout, from, to, NULL) &&
           (arc_is_sure(self, to) || aisle_space_piece_free(space, from, to, need, &self->units));
}

static aisle_corner_rule corner_rule(aisle_compose *self, const aisle_leg *leg) {
    const aisle_vehicle *vehicle = self->request.space->vehicle;
    double zone = (double)self->request.options->zone;
    double sure = vehicle->outer_radius + vehicle->margin;
    aisle_corner_rule rule = {.max_radius = aisle_max(sure, CORNER_RADIUS),
                              .sure_radius = sure,
                              .min_radius = CORNER_RADIUS_MIN,
                              .zone = zone,
                              .arc_free = arc_free,
                              .ctx = self};
    if (leg->tangent_radius > 0.0 && !leg->use_swarm) { // found free before it became the leg's
        rule.max_radius = rule.sure_radius = leg->tangent_radius;
        rule.arc_free = NULL;
    }
    if (vehicle->curvature_max > 0.0) {
        rule.min_radius = 1.0 / vehicle->curvature_max;
        rule.max_radius = aisle_max(rule.max_radius, rule.min_radius);
    }
    if (zone < 0.0 || self->request.stops) {
        rule.max_radius = 0.0;
        rule.zone = 0.0;
    }
    return rule;
}

static void lay_spline(aisle_compose *self, aisle_curve *curve, const aisle_leg *leg) {
    aisle_status st = aisle_spline_fit(self->spline, AISLE_SPLINE_CUBIC, leg->via, leg->via_count);
    AISLE_ASSERT(st == AISLE_OK);
    double wished = floor(aisle_spline_length(self->spline) / SPLINE_SPACING) + 2.0;
    double share = (double)AISLE_COMPOSE_PIECES / (2.0 * (double)self->request.leg_count);
    uint32_t count = (uint32_t)aisle_clamp(wished, 3.0, aisle_max(share, 16.0));
    aisle_spline_resample(self->spline, count, self->sample);
    aisle_vec2 d = self->sample[0].d1;
    double theta = aisle_atan2(d.y, d.x);
    aisle_curve_turn_to(curve, theta);
    curve->w[curve->n - 1U].theta = theta;
    for (uint32_t i = 1; i < count; i++) {
        double norm = aisle_vec2_length(self->sample[i].d1);
        if (norm > 1e-9) {
            aisle_curve_biarc_to(curve, self->sample[i].p, aisle_vec2_scale(self->sample[i].d1, 1.0 / norm));
        }
    }
}

static void lay_way(aisle_compose *self, aisle_curve *curve, const aisle_leg *leg) {
    const aisle_compose_request *request = &self->request;
    aisle_corner_rule rule = corner_rule(self, leg);
    if (!leg->use_swarm) {
        aisle_curve_polyline(curve, request->points + leg->first, leg->count, &rule);
    } else if (request->options->interpolation == AISLE_OPTIONS_LINEAR) {
        aisle_curve_polyline(curve, leg->via, leg->via_count, &rule);
    } else {
        lay_spline(self, curve, leg);
    }
}

static void lay_leg(aisle_compose *self, aisle_curve *curve, uint32_t i) {
    const aisle_leg *leg = &self->request.legs[i];
    const aisle_goal_msg *goal = &self->request.goals[i];
    if (leg->piece_count > 0U) {
        aisle_curve_pieces(curve, self->request.pieces + leg->piece_first, leg->piece_count);
    } else if (leg->count >= 2U) { // else the goal is where the leg begins: only the heading may be left to do
        lay_way(self, curve, leg);
    }
    if (aisle_goal_wants_turn(goal, curve->w[curve->n - 1U].theta)) {
        aisle_curve_turn_to(curve, goal->theta);
    }
    aisle_curve_goal(curve, goal->id);
}

// Lays leg i alone, from its seed.
static aisle_curve lay_seed(aisle_compose *self, const aisle_compose_request *request, uint32_t i) {
    self->request = *request;
    const aisle_leg *leg = &request->legs[i];
    const aisle_vec2 *p = request->points + leg->first;
    aisle_corner_rule rule = corner_rule(self, leg);
    aisle_curve curve = {.w = self->raw, .capacity = AISLE_PATH_MAX_WAYPOINTS};
    aisle_curve_begin(&curve, (aisle_pose2){p[0].x, p[0].y, aisle_atan2(p[1].y - p[0].y, p[1].x - p[0].x)});
    aisle_curve_polyline(&curve, p, leg->count, &rule);
    return curve;
}

uint32_t aisle_compose_way_opposed(aisle_compose *self, const aisle_compose_request *request, uint32_t i,
                                   aisle_opposed *out) {
    const aisle_curve curve = lay_seed(self, request, i);
    uint32_t zones = 0;
    for (uint32_t k = 1; k < curve.n; k++) {
        const aisle_waypoint_msg *to = &curve.w[k];
        int32_t id = 0;
        if (aisle_zones_allow_piece(request->space->layout, to - 1, to, &id) || (zones > 0U && id == out->id)) {
            continue;
        }
        zones++;
        if (zones == 1U) {
            const aisle_pose2 middle = aisle_piece_at(to - 1, to, 0.5);
            *out = (aisle_opposed){.id = id, .place = aisle_vec2_of(middle.x, middle.y)};
        }
    }
    return zones;
}

bool aisle_compose_way_free(aisle_compose *self, const aisle_compose_request *request, uint32_t i, double need,
                            uint32_t *units) {
    const aisle_curve curve = lay_seed(self, request, i);
    bool free = !curve.overflow;
    for (uint32_t k = 1; free && k < curve.n; k++) {
        free = aisle_space_piece_free(request->space, &curve.w[k - 1U], &curve.w[k], need, units);
    }
    return free;
}

// Heading with which the first leg leaves.
static double first_heading(aisle_compose *self) {
    const aisle_leg *leg = &self->request.legs[0];
    if (leg->piece_count > 0U) {
        return self->request.pieces[leg->piece_first].theta;
    }
    if (leg->count < 2U) {
        return self->request.start->theta;
    }
    if (leg->use_swarm && self->request.options->interpolation != AISLE_OPTIONS_LINEAR) {
        aisle_status st = aisle_spline_fit(self->spline, AISLE_SPLINE_CUBIC, leg->via, leg->via_count);
        AISLE_ASSERT(st == AISLE_OK);
        aisle_vec2 d = aisle_spline_at(self->spline, 0.0).d1;
        return aisle_atan2(d.y, d.x);
    }
    const aisle_vec2 *p = leg->use_swarm ? leg->via : self->request.points + leg->first;
    return aisle_atan2(p[1].y - p[0].y, p[1].x - p[0].x);
}

static bool is_turn(const aisle_waypoint_msg *from) {
    return (from->flags & AISLE_WAYPOINT_TURN_IN_PLACE) != 0;
}

static double raw_length(const aisle_compose *self) {
    double length = 0.0;
    for (uint32_t i = 1; i < self->raw_count; i++) {
        length += aisle_piece_length(&self->raw[i - 1U], &self->raw[i]);
    }
    return length;
}

// May waypoint b between a and c go, its two pieces being one straight piece of one speed class?
static bool may_join(const aisle_compose *self, const aisle_waypoint_msg *a, const aisle_waypoint_msg *b,
                     const aisle_waypoint_msg *c) {
    double creep = self->request.space->vehicle->creep_clearance;
    bool straight = fabs((double)b->curvature) + fabs((double)c->curvature) <= 0.0 &&
                    fabs(b->theta - c->theta) < 1e-12 && fabs(a->theta - b->theta) < 1e-9;
    bool same_class = ((double)b->clearance < creep) == ((double)c->clearance < creep);
    double longest = (double)b->clearance < creep ? 0.5 * AISLE_COMPOSE_JOIN : AISLE_COMPOSE_JOIN;
    return straight && same_class && b->flags == 0 && !is_turn(a) && aisle_piece_length(a, c) <= longest;
}

// Mean of density and risk over a piece that is near something, by exact gaps on it: its clearance is the least on it.
static void sample_piece(aisle_compose *self, const aisle_waypoint_msg *from, const aisle_waypoint_msg *to,
                         double length, double *density, double *risk) {
    const aisle_compose_request *request = &self->request;
    double creep = request->space->vehicle->creep_clearance;
    double samples = floor(length / RISK_SPACING) + 1.0;
    double costs = 0.0;
    double risks = 0.0;
    for (double i = 0.5; i < samples; i += 1.0) {
        double gap = aisle_space_gap(request->space, aisle_piece_at(from, to, i / samples), creep, NULL);
        costs += aisle_objective_density(request->objective, gap, (double)to->curvature);
        risks += 1.0 - gap / creep; // creep > 0, gap <= creep
        self->units++;
    }
    *density = costs / samples;
    *risk = risks / samples;
}

// Adds up risk and each leg's measured cost, by the pieces before they are joined: what seed and swarm are compared by.
static void value_piece(aisle_compose *self, const aisle_waypoint_msg *from, const aisle_waypoint_msg *to) {
    double length = aisle_piece_length(from, to);
    double density = aisle_objective_density(self->request.objective, (double)to->clearance, (double)to->curvature);
    double risk = 0.0;
    if (length > 0.0 && (double)to->clearance < self->request.space->vehicle->creep_clearance) {
        sample_piece(self, from, to, length, &density, &risk);
    }
    self->value +=
        length * density + aisle_zones_toll_piece(self->request.space->layout, self->request.objective, from, to);
    self->penalty += aisle_zones_penalty_piece(self->request.space->layout, from, to);
    self->risk += length * risk;
    if ((to->flags & AISLE_WAYPOINT_GOAL) != 0 && self->leg < self->request.leg_count) {
        aisle_leg *leg = &self->request.legs[self->leg++];
        *(leg->use_swarm ? &leg->swarm_value : &leg->seed_value) = self->value;
        self->value = 0.0;
    }
}

// Largest float not above x: a clearance is told rather too small.
static float float_below(double x) {
    float f = (float)(x * (1.0 - 1e-7));
    return f > 0.0F ? f : 0.0F;
}

// ---- pieces in hand

static void take_piece(aisle_compose *self, uint32_t at) {
    self->at = at;
    self->done = 0.0;
    self->ends[0] = 1.0;
    self->depth = 1;
}

// Is there a waypoint to spare for a cut, every end in sight being counted?
static bool has_room(const aisle_compose *self) {
    uint32_t wanted = (uint32_t)self->path->num_waypoints + self->depth + (self->raw_count - self->at);
    return wanted < AISLE_PATH_MAX_WAYPOINTS && self->depth < AISLE_COMPOSE_DEPTH;
}

// The part of the piece in hand that ends at f.
static aisle_waypoint_msg part_end(const aisle_compose *self, double f) {
    const aisle_waypoint_msg *to = &self->raw[self->at];
    return f >= 1.0 ? *to : aisle_piece_part(to, f);
}

static void append(aisle_compose *self, const aisle_waypoint_msg *to) {
    aisle_path_msg *path = self->path;
    uint32_t n = (uint32_t)path->num_waypoints;
    aisle_waypoint_msg *last = &path->waypoints[n - 1U];
    value_piece(self, last, to);
    if (n > 1U && may_join(self, last - 1, last, to)) {
        float clearance = last->clearance < to->clearance ? last->clearance : to->clearance;
        *last = *to;
        last->clearance = clearance;
        return;
    }
    AISLE_ASSERT(n < AISLE_PATH_MAX_WAYPOINTS);
    path->waypoints[n] = *to;
    path->num_waypoints = (int16_t)(n + 1U);
}

typedef enum cut_rule { CUT, CUT_IF_NEAR, KEEP } cut_rule;

// Does the field say that at f of the piece in hand the body is too near to something to be fast?
static bool creeps_at(const aisle_compose *self, double f) {
    const aisle_space *space = self->request.space;
    const aisle_vehicle *vehicle = space->vehicle;
    aisle_pose2 p = aisle_piece_at(&self->raw[self->at - 1U], &self->raw[self->at], f);
    return aisle_grid_gap_upper(space->grid, aisle_vec2_of(p.x, p.y)) <
           vehicle->creep_clearance + vehicle->inner_radius;
}

// What is known of a part of `length` that ends at f before its clearance is measured. What keeps the creep clearance is
// of one kind all along and stays whole up to the length that straight pieces are joined to; so does what does not keep
// it anywhere, unless the objective asks by how much.
static cut_rule rule_of(const aisle_compose *self, double f, double length) {
    bool straight = fabs((double)self->raw[self->at].curvature) <= 0.0;
    if (length <= self->longest || !has_room(self)) {
        return KEEP;
    }
    if (!straight || length > aisle_max(AISLE_COMPOSE_JOIN, self->longest)) {
        return CUT;
    }
    bool first = creeps_at(self, self->done + 0.25 * (f - self->done));
    bool second = creeps_at(self, self->done + 0.75 * (f - self->done));
    if ((first || second) && length > aisle_max(0.5 * AISLE_COMPOSE_JOIN, self->longest)) {
        return CUT;
    }
    return first && second && self->request.objective->kind != AISLE_OPTIONS_SAFEST ? KEEP : CUT_IF_NEAR;
}

// Cuts the part in front or appends it.
static void step_part(aisle_compose *self) {
    const aisle_space *space = self->request.space;
    const aisle_waypoint_msg *to = &self->raw[self->at], *last = &self->path->waypoints[self->path->num_waypoints - 1];
    double f = self->ends[self->depth - 1U];
    double length = aisle_piece_length(to - 1, to) * (f - self->done); // 0 of a turn
    cut_rule rule = rule_of(self, f, length);
    bool rough = self->request.objective->kind != AISLE_OPTIONS_SAFEST;
    if (rule != CUT) {
        aisle_waypoint_msg end = part_end(self, f);
        double clearance = aisle_space_piece_clearance(space, last, &end, rough, &self->units);
        end.clearance = float_below(aisle_max(clearance, space->vehicle->margin)); // which the verifier will prove
        bool near = (double)end.clearance < space->vehicle->creep_clearance;
        if (rule == KEEP || !near) {
            append(self, &end);
            self->done = f;
            self->depth--;
        } else {
            rule = CUT;
        }
    }
    if (rule == CUT) {
        self->ends[self->depth++] = 0.5 * (self->done + f);
    }
    if (self->depth == 0U) {
        take_piece(self, self->at + 1U);
    }
}

aisle_status aisle_compose_start(aisle_compose *self, const aisle_compose_request *request, aisle_path_msg *path) {
    self->request = *request;
    self->path = path;
    self->units = 0;
    aisle_curve curve = {.w = self->raw, .capacity = AISLE_PATH_MAX_WAYPOINTS};
    const aisle_goal_msg *start = request->start;
    double theta = aisle_goal_heading_is_free(start) ? first_heading(self) : start->theta;
    aisle_curve_begin(&curve, (aisle_pose2){start->x, start->y, theta});
    for (uint32_t i = 0; i < request->leg_count; i++) {
        self->leg = i;
        lay_leg(self, &curve, i);
    }
    self->raw_count = curve.n;
    if (curve.overflow) {
        return AISLE_ERR_CAPACITY;
    }
    self->longest = aisle_max(AISLE_COMPOSE_PIECE, raw_length(self) / (double)AISLE_COMPOSE_PIECES);
    self->leg = 0;
    self->value = self->risk = self->penalty = 0.0;
    self->path->waypoints[0] = self->raw[0];
    self->path->num_waypoints = 1;
    take_piece(self, 1);
    return AISLE_OK;
}

void aisle_goal_dwells(const aisle_waypoint_msg *w, uint32_t n, const aisle_goal_msg *goals, uint32_t num_goals,
                       float *dwell) {
    uint32_t goal = 0;
    for (uint32_t i = 0; i < n; i++) {
        bool reached = (w[i].flags & AISLE_WAYPOINT_GOAL) != 0 && goal < num_goals;
        dwell[i] = reached ? goals[goal].dwell : 0.0F;
        goal += reached ? 1U : 0U;
    }
}

static aisle_status finish(aisle_compose *self) {
    aisle_path_msg *path = self->path;
    const aisle_space *space = self->request.space;
    aisle_goal_dwells(path->waypoints, (uint32_t)path->num_waypoints, self->request.goals, self->request.leg_count,
                      self->dwell);
    aisle_profile_path way = {.w = path->waypoints,
                              .dwell = self->dwell,
                              .n = (uint32_t)path->num_waypoints,
                              .capacity = AISLE_PATH_MAX_WAYPOINTS};
    static const aisle_profile_start at_rest = {0.0, NULL};
    aisle_profile_sum sum;
    aisle_status st = aisle_profile_fill_ramps(space->vehicle, space->layout, &way, &at_rest, &sum);
    if (st != AISLE_OK) {
        return st;
    }
    path->num_waypoints = (int16_t)way.n;
    float least = (float)AISLE_CLEARANCE_CAP;
    for (int16_t i = 0; i < path->num_waypoints; i++) {
        least = path->waypoints[i].clearance < least ? path->waypoints[i].clearance : least;
    }
    path->clearance_min = least;
    path->length = (float)sum.length;
    path->duration = (float)sum.duration;
    path->energy = (float)sum.energy;
    path->risk = sum.length > 0.0 ? (float)(self->risk / sum.length) : 0.0F;
    self->units += (uint32_t)(uint16_t)path->num_waypoints;
    return AISLE_OK;
}

aisle_status aisle_compose_step(aisle_compose *self, uint32_t units, uint32_t *spent) {
    aisle_status st = AISLE_BUSY;
    while (self->at < self->raw_count && self->units < units) {
        step_part(self);
    }
    if (self->at >= self->raw_count) {
        aisle_waypoint_msg *w = self->path->waypoints;
        aisle_pose2 start = {w[0].x, w[0].y, w[0].theta};
        w[0].clearance = float_below(aisle_space_gap(self->request.space, start, AISLE_CLEARANCE_CAP, NULL));
        st = finish(self);
    }
    *spent += self->units;
    self->units = 0;
    return st;
}
