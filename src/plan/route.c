#include "plan/route.h"

#include "base/check.h"
#include "robot/profile.h"

#include <math.h>

#define ATTEMPTS_DISC 2U // at a seed, see route.h; the others are the body's
#define ATTEMPTS 4U
#define RESERVE 3U // proofs' worth of work units kept back when the swarm starts

void aisle_route_carve(aisle_route *self, aisle_arena *arena, const aisle_limits *limits) {
    aisle_space_carve(&self->space, arena, limits->cells);
    aisle_seed_carve(&self->seed, arena, limits);
    aisle_swarm_carve(&self->swarm, arena);
    aisle_compose_carve(&self->compose, arena);
    self->points = (aisle_vec2 *)aisle_arena_take(arena, AISLE_ROUTE_POINTS, sizeof(aisle_vec2));
    self->legs = (aisle_leg *)aisle_arena_take(arena, AISLE_GOAL_LIST_MAX_GOALS, sizeof(aisle_leg));
    self->path = (aisle_path_msg *)aisle_arena_take(arena, 1U, sizeof(aisle_path_msg));
    self->decoded = (aisle_path_msg *)aisle_arena_take(arena, 1U, sizeof(aisle_path_msg));
    self->first.bytes = (uint8_t *)aisle_arena_take(arena, AISLE_ROUTE_BYTES, 1U);
    self->better.bytes = (uint8_t *)aisle_arena_take(arena, AISLE_ROUTE_BYTES, 1U);
}

static aisle_vec2 place_of(const aisle_goal_msg *goal) {
    return aisle_vec2_of(goal->x, goal->y);
}

static const aisle_goal_msg *leg_start(const aisle_route *self, uint32_t leg) {
    return leg == 0U ? &self->request.start : &self->request.goals[leg - 1U];
}

// Header of the answer: everything but waypoints and sums.
static void copy_head(aisle_route *self, const aisle_path_msg *head) {
    aisle_path_msg *path = self->path;
    const aisle_request *request = &self->request;
    path->utime = head->utime;
    path->boot_id = head->boot_id;
    path->path_revision = head->path_revision;
    path->t0_utime = head->t0_utime;
    path->valid_until_utime = head->valid_until_utime;
    path->obstacles_utime = head->obstacles_utime;
    path->query_id = request->query_id;
    path->goal_list_id = request->goal_list_id;
    path->goal_list_revision = request->goal_list_revision;
    path->pose_utime = request->pose_utime;
    path->map_id = aisle_layout_map_id(self->layout);
    path->map_revision = aisle_layout_map_revision(self->layout);
    path->vehicle_revision = self->vehicle->revision;
    path->status = AISLE_PATH_OK;
    path->cause = 0;
    path->cause_id = 0;
    path->cause_value = 0.0F;
    path->cached = 0;
    path->num_base = 0;
    path->clearance_moving_min = 0.0F;
    path->planning_time = 0.0F;
}

void aisle_route_start(aisle_route *self, const aisle_layout *layout, const aisle_vehicle *vehicle,
                       const aisle_request *request, const aisle_path_msg *head) {
    self->layout = layout;
    self->vehicle = vehicle;
    self->request = *request;
    self->stage = AISLE_ROUTE_CHECK;
    self->leg = 0;
    self->point_count = 0;
    self->first.ready = false;
    self->better.ready = false;
    self->stops = false;
    self->swarm_done = false;
    self->announced = false;
    self->has_place = false;
    self->spent = 0;
    self->proof_units = 0;
    self->swarm_evals = self->nodes = self->verify_failed = self->intervals = 0;
    self->collide = (aisle_collide_count){0};
    self->cause = (aisle_refusal){0, 0, 0.0F};
    self->budget = request->options.work_units > 0 ? (uint32_t)request->options.work_units : self->budget_default;
    copy_head(self, head);
}

static aisle_status refuse(aisle_route *self, int16_t cause, int32_t id, double value) {
    self->cause = (aisle_refusal){cause, id, (float)value};
    self->stage = AISLE_ROUTE_END;
    return AISLE_OK;
}

static aisle_status refuse_at(aisle_route *self, int16_t cause, int32_t id, double value, aisle_vec2 place) {
    self->place = place;
    self->has_place = true;
    return refuse(self, cause, id, value);
}

// ---- CHECK

static bool options_are_known(const aisle_options_msg *options) {
    bool planner = options->planner == AISLE_OPTIONS_AUTO || options->planner == AISLE_OPTIONS_PSO ||
                   options->planner == AISLE_OPTIONS_ASTAR;
    bool interpolation =
        options->interpolation == AISLE_OPTIONS_SPLINE || options->interpolation == AISLE_OPTIONS_LINEAR;
    return planner && interpolation && options->risk_weight >= 0.0F && options->work_units >= 0 &&
           options->num_samples >= 0;
}

static bool in_bounds(const aisle_route *self, aisle_vec2 p) {
    aisle_aabb bounds = aisle_layout_bounds(self->layout);
    return p.x >= bounds.lo.x && p.x <= bounds.hi.x && p.y >= bounds.lo.y && p.y <= bounds.hi.y;
}

// Gap of the body at a stop: of the footprint, or of the disc it holds where the heading is free.
static double stop_gap(const aisle_route *self, const aisle_goal_msg *stop, int32_t *id) {
    double cap = self->vehicle->margin + 1.0;
    if (!aisle_goal_heading_is_free(stop)) {
        return aisle_space_gap(&self->space, (aisle_pose2){stop->x, stop->y, stop->theta}, cap, id);
    }
    aisle_vec2 p = place_of(stop);
    aisle_convex disc = {&p, 1U, self->vehicle->inner_radius};
    return aisle_layout_gap(self->layout, &disc, cap, id);
}

static aisle_status check_stop(aisle_route *self, const aisle_goal_msg *stop, bool is_start) {
    aisle_vec2 p = place_of(stop);
    if (!in_bounds(self, p)) {
        int16_t outside = is_start ? AISLE_STATUS_POSE_OUTSIDE : AISLE_STATUS_GOAL_OUTSIDE;
        return refuse_at(self, outside, stop->id, 0.0, p);
    }
    int32_t id = 0;
    double gap = stop_gap(self, stop, &id);
    self->spent += 1U;
    if (gap < self->vehicle->margin + AISLE_SPACE_SLACK) {
        int16_t occupied = is_start ? AISLE_STATUS_START_OCCUPIED : AISLE_STATUS_GOAL_OCCUPIED;
        return refuse_at(self, occupied, id, self->vehicle->margin + AISLE_SPACE_SLACK - gap, p);
    }
    return AISLE_BUSY;
}

static void begin_leg(aisle_route *self, uint32_t attempt);

static aisle_status check(aisle_route *self) {
    const aisle_request *request = &self->request;
    if (!options_are_known(&request->options) ||
        !aisle_objective_of(&request->options, self->vehicle, &self->objective)) {
        return refuse(self, AISLE_STATUS_MALFORMED, request->options.planner, (double)request->options.objective);
    }
    aisle_space_begin(&self->space, self->layout, self->vehicle, AISLE_SPACE_FREE_TURN);
    aisle_status st = check_stop(self, &request->start, true);
    for (int16_t i = 0; i < request->num_goals && st == AISLE_BUSY; i++) {
        st = check_stop(self, &request->goals[i], false);
    }
    if (st == AISLE_BUSY) {
        begin_leg(self, 0);
    }
    return st;
}

// ---- SEED, TAUT

static uint32_t coarse_stride(const aisle_route *self) {
    const aisle_lattice *lattice = &aisle_layout_grid(self->layout)->lattice;
    double cells = floor(AISLE_ROUTE_STRIDE / lattice->res + 1e-6);
    double side = (double)(lattice->w < lattice->h ? lattice->w : lattice->h);
    return (uint32_t)aisle_clamp(cells, 1.0, side);
}

// Why there is no seed for this leg.
static void begin_why(aisle_route *self) {
    aisle_why_start(&self->why, &self->seed, &self->space, place_of(leg_start(self, self->leg)),
                    place_of(&self->request.goals[self->leg]), coarse_stride(self));
    self->stage = AISLE_ROUTE_WHY;
}

// What the n-th attempt at a seed searches with.
static uint32_t attempt_of(const aisle_route *self, uint32_t n, aisle_space_mode *mode) {
    *mode = n < ATTEMPTS_DISC ? AISLE_SPACE_FREE_TURN : AISLE_SPACE_ALONG;
    return n % 2U == 0U ? coarse_stride(self) : 1U;
}

// Would the attempt only repeat another one?
static bool attempt_is_idle(const aisle_route *self, uint32_t n, uint32_t stride) {
    bool fine_first = n == 0U && aisle_objective_is_length(&self->objective);
    return n % 2U == 0U && (stride == 1U || fine_first);
}

// Starts the seed of the leg under way with the first attempt from n on that finds its ends; none does: WHY.
static void begin_leg(aisle_route *self, uint32_t n) {
    aisle_leg *leg = &self->legs[self->leg];
    *leg = (aisle_leg){.first = self->point_count, .attempt = n, .seed_value = -1.0, .swarm_value = -1.0};
    aisle_vec2 from = place_of(leg_start(self, self->leg));
    aisle_vec2 to = place_of(&self->request.goals[self->leg]);
    self->stage = AISLE_ROUTE_SEED;
    if (aisle_vec2_distance(from, to) < 1e-6) {
        leg->count = 1;
        self->points[self->point_count++] = from;
        self->seed.phase = AISLE_SEED_DONE;
        return;
    }
    // Before the body's attempts the proof is asked whether there can be a way at all.
    uint32_t end = n < ATTEMPTS_DISC || aisle_vehicle_is_disc(self->vehicle) ? ATTEMPTS_DISC : ATTEMPTS;
    for (; n < end; n++) {
        uint32_t stride = attempt_of(self, n, &leg->mode);
        leg->attempt = n;
        if (attempt_is_idle(self, n, stride)) {
            continue;
        }
        aisle_space_begin(&self->space, self->layout, self->vehicle, leg->mode);
        if (aisle_seed_start(&self->seed, &self->space, &self->objective, stride, from, to,
                             self->points + leg->first) == AISLE_OK) {
            return;
        }
    }
    begin_why(self);
}

static void begin_build(aisle_route *self, aisle_proof *trial) {
    self->trial = trial;
    self->leg = 0;
    self->stage = AISLE_ROUTE_BUILD;
    self->compose.path = NULL; // not begun
}

static void next_leg(aisle_route *self) {
    self->leg++;
    if (self->leg < (uint32_t)self->request.num_goals) {
        begin_leg(self, 0);
    } else {
        begin_build(self, &self->first);
    }
}

static aisle_status step_seed(aisle_route *self, uint32_t units) {
    aisle_leg *leg = &self->legs[self->leg];
    if (self->seed.phase == AISLE_SEED_DONE) { // start = goal
        next_leg(self);
        return AISLE_BUSY;
    }
    if (AISLE_ROUTE_POINTS - self->point_count < AISLE_SEED_POINTS_MAX) {
        return refuse(self, AISLE_STATUS_LIMIT, 0, (double)self->point_count);
    }
    uint32_t before = self->seed.search.expanded;
    aisle_status st = aisle_seed_step(&self->seed, units, &self->spent);
    self->nodes += (int64_t)self->seed.search.expanded - (int64_t)before;
    if (st == AISLE_ERR_CAPACITY) {
        return refuse(self, AISLE_STATUS_LIMIT, 0, (double)self->seed.search.open_capacity);
    }
    if (st == AISLE_PARTIAL) {
        if (leg->attempt + 1U == ATTEMPTS_DISC) {
            begin_why(self); // it goes on with the body's attempts if there can be a way
        } else {
            begin_leg(self, leg->attempt + 1U);
        }
    } else if (st == AISLE_OK) {
        double arc = self->vehicle->outer_radius + self->vehicle->margin;
        aisle_taut_start(&self->taut, &self->space, &self->objective, arc, self->points + leg->first,
                         self->seed.point_count, AISLE_SEED_POINTS_MAX);
        self->stage = AISLE_ROUTE_TAUT;
    }
    return AISLE_BUSY;
}

static aisle_status step_taut(aisle_route *self, uint32_t units) {
    if (aisle_taut_step(&self->taut, units, &self->spent) == AISLE_OK) {
        self->legs[self->leg].count = self->taut.count;
        self->point_count += self->taut.count;
        next_leg(self);
    }
    return AISLE_BUSY;
}

// ---- WHY

static aisle_status step_why(aisle_route *self, uint32_t units) {
    aisle_status st = aisle_why_step(&self->why, units, &self->spent);
    const aisle_why *why = &self->why;
    if (st == AISLE_PARTIAL && !why->proved && self->legs[self->leg].attempt < ATTEMPTS_DISC) {
        begin_leg(self, ATTEMPTS_DISC); // the body along the motion may still pass; nothing for a disc
        return AISLE_BUSY;
    }
    if (st == AISLE_BUSY || st == AISLE_PARTIAL) {
        return AISLE_BUSY;
    }
    if (st != AISLE_OK) {
        return refuse(self, AISLE_STATUS_LIMIT, 0, (double)self->seed.search.open_capacity);
    }
    if (!why->connected) {
        int16_t cause = why->proved ? AISLE_STATUS_NO_PATH : AISLE_STATUS_BUDGET;
        return refuse_at(self, cause, self->request.goals[self->leg].id, 0.0, why->goal);
    }
    if (why->proved) {
        return refuse_at(self, AISLE_STATUS_TOO_NARROW, why->id, why->width, why->place);
    }
    int16_t cause = aisle_vehicle_is_disc(self->vehicle) ? AISLE_STATUS_BUDGET : AISLE_STATUS_KINEMATIC;
    return refuse_at(self, cause, why->id, why->width, why->place);
}

// ---- BUILD, VERIFY

static double beeline(const aisle_route *self) {
    double sum = 0.0;
    for (uint32_t i = 0; i < (uint32_t)self->request.num_goals; i++) {
        sum += aisle_vec2_distance(place_of(leg_start(self, i)), place_of(&self->request.goals[i]));
    }
    return sum;
}

static void seal(aisle_route *self) {
    aisle_path_msg *path = self->path;
    bool swarm = self->trial == &self->better;
    path->planner = swarm ? AISLE_OPTIONS_PSO : AISLE_OPTIONS_ASTAR;
    path->work_units = (int32_t)self->spent;
    float bound = (float)(beeline(self) * (1.0 - 1e-6));
    path->length_bound = bound < path->length ? bound : path->length;
    path->certificate = (int32_t)aisle_path_certificate(path);
    aisle_status st = aisle_msg_encode(AISLE_MSG_PATH, path, self->trial->bytes, AISLE_ROUTE_BYTES, &self->trial->size);
    AISLE_ASSERT(st == AISLE_OK);
}

static void begin_verify(aisle_route *self) {
    seal(self);
    aisle_waypoint_msg *w = self->path->waypoints;
    const aisle_goal_msg *start = &self->request.start;
    bool any = aisle_goal_heading_is_free(start);
    aisle_verify_request request = {.layout = self->layout,
                                    .vehicle = self->vehicle,
                                    .bytes = self->trial->bytes,
                                    .size = self->trial->size,
                                    .start = {start->x, start->y, any ? w[0].theta : start->theta},
                                    .goals = self->request.goals,
                                    .num_goals = (uint32_t)self->request.num_goals};
    aisle_verify_start(&self->verify, &request, self->decoded);
    self->stage = AISLE_ROUTE_VERIFY;
}

// The way built could not be proved or does not fit: what next?
static aisle_status fall_back(aisle_route *self, int16_t cause, int32_t id, aisle_vec2 place) {
    if (self->trial == &self->better) {
        self->stage = AISLE_ROUTE_END; // the first path stays
        return AISLE_OK;
    }
    if (!self->stops && self->vehicle->curvature_max <= 0.0) {
        self->stops = true;
        begin_build(self, &self->first);
        return AISLE_BUSY;
    }
    return refuse_at(self, cause, id, 0.0, place);
}

static aisle_compose_request build_request(aisle_route *self) {
    return (aisle_compose_request){.space = &self->space,
                                   .objective = &self->objective,
                                   .options = &self->request.options,
                                   .points = self->points,
                                   .legs = self->legs,
                                   .leg_count = (uint32_t)self->request.num_goals,
                                   .start = &self->request.start,
                                   .goals = self->request.goals,
                                   .stops = self->stops && self->trial == &self->first};
}

static aisle_status step_build(aisle_route *self, uint32_t units) {
    aisle_status st = AISLE_BUSY;
    if (self->compose.path == NULL) {
        aisle_compose_request request = build_request(self);
        st = aisle_compose_start(&self->compose, &request, self->path);
        if (st != AISLE_OK) {
            return fall_back(self, AISLE_STATUS_LIMIT, 0, place_of(&self->request.start));
        }
        return AISLE_BUSY;
    }
    st = aisle_compose_step(&self->compose, units, &self->spent);
    if (st == AISLE_OK) {
        begin_verify(self);
    } else if (st != AISLE_BUSY) {
        return fall_back(self, AISLE_STATUS_INTERNAL, 0, place_of(&self->request.start));
    }
    return AISLE_BUSY;
}

// What the path built is worth: what the objective means in full, stops and acceleration included, where the path's sums tell.
static double path_value(const aisle_route *self) {
    switch (self->objective.kind) {
    case AISLE_OPTIONS_FASTEST:
        return (double)self->path->duration;
    case AISLE_OPTIONS_LEAST_ENERGY:
        return (double)self->path->energy;
    default:
        break;
    }
    double value = 0.0;
    for (uint32_t i = 0; i < (uint32_t)self->request.num_goals; i++) {
        const aisle_leg *leg = &self->legs[i];
        value += leg->use_swarm ? leg->swarm_value : leg->seed_value;
    }
    return value;
}

static void begin_swarm_leg(aisle_route *self);

static aisle_status after_first_proof(aisle_route *self) {
    self->proof_units = self->spent;
    // A disc's taut string cannot be beaten on length: AUTO leaves the swarm to other bodies (which it held to the
    // turning disc) and other objectives.
    bool taut_is_best = self->request.options.planner == AISLE_OPTIONS_AUTO &&
                        aisle_objective_is_length(&self->objective) && aisle_vehicle_is_disc(self->vehicle);
    if (self->request.options.planner == AISLE_OPTIONS_ASTAR || taut_is_best || self->stops) {
        self->stage = AISLE_ROUTE_END;
        return AISLE_OK;
    }
    self->leg = 0;
    begin_swarm_leg(self);
    if (!self->announced) {
        self->announced = true;
        return AISLE_PARTIAL;
    }
    return AISLE_BUSY;
}

// Leg the waypoint belongs to, by the goals passed before it.
static uint32_t leg_of_waypoint(const aisle_route *self, uint32_t waypoint) {
    uint32_t leg = 0;
    for (uint32_t i = 0; i < waypoint && leg + 1U < (uint32_t)self->request.num_goals; i++) {
        leg += (self->path->waypoints[i].flags & AISLE_WAYPOINT_GOAL) != 0 ? 1U : 0U;
    }
    return leg;
}

static bool any_swarm_leg(const aisle_route *self) {
    for (uint32_t i = 0; i < (uint32_t)self->request.num_goals; i++) {
        if (self->legs[i].use_swarm) {
            return true;
        }
    }
    return false;
}

// Builds the better path again, or ends if no leg is left to the swarm.
static aisle_status rebuild_better(aisle_route *self) {
    if (!any_swarm_leg(self)) {
        self->stage = AISLE_ROUTE_END;
        return AISLE_OK;
    }
    begin_build(self, &self->better);
    return AISLE_BUSY;
}

static aisle_status disproved(aisle_route *self) {
    self->verify_failed++;
    const aisle_verify *verify = &self->verify;
    if (self->trial == &self->better) {
        aisle_leg *leg = &self->legs[leg_of_waypoint(self, verify->fault_waypoint)];
        if (leg->use_swarm) {
            leg->use_swarm = false;
            return rebuild_better(self);
        }
    }
    bool body = verify->fault == AISLE_VERIFY_COLLISION || verify->fault == AISLE_VERIFY_CURVATURE ||
                verify->fault == AISLE_VERIFY_HEADING || verify->fault == AISLE_VERIFY_START ||
                verify->fault == AISLE_VERIFY_GOAL;
    int16_t cause = body ? AISLE_STATUS_KINEMATIC : AISLE_STATUS_VERIFY_FAILED;
    return fall_back(self, cause, body ? verify->fault_id : (int32_t)verify->fault, verify->fault_at);
}

// The better path is proved; legs that came out worse than their seeds go back to them, once.
static aisle_status after_better_proof(aisle_route *self) {
    bool worse = false;
    bool by_name = self->request.options.planner == AISLE_OPTIONS_PSO;
    for (uint32_t i = 0; i < (uint32_t)self->request.num_goals; i++) {
        aisle_leg *leg = &self->legs[i];
        if (leg->use_swarm && !by_name && leg->swarm_value > leg->seed_value) {
            leg->use_swarm = false;
            worse = true;
        }
    }
    if (worse) {
        return rebuild_better(self);
    }
    self->better.ready = by_name || self->better.value <= self->first.value;
    self->stage = AISLE_ROUTE_END;
    return AISLE_OK;
}

static aisle_status step_verify(aisle_route *self, uint32_t units) {
    aisle_status st = aisle_verify_step(&self->verify, units, &self->spent, &self->trial->stamp);
    if (st == AISLE_BUSY) {
        return AISLE_BUSY;
    }
    self->intervals += self->verify.intervals;
    self->collide.calls += self->verify.collide.calls;
    if (self->verify.collide.support_max > self->collide.support_max) {
        self->collide.support_max = self->verify.collide.support_max;
    }
    if (st != AISLE_OK) {
        return disproved(self);
    }
    self->trial->value = path_value(self);
    if (self->trial == &self->better) {
        return after_better_proof(self);
    }
    self->first.ready = true;
    return after_first_proof(self);
}

// ---- SWARM

// What the swarm may still spend.
static uint32_t left_for_swarm(const aisle_route *self) {
    uint64_t kept = (uint64_t)self->spent + (uint64_t)RESERVE * self->proof_units / 4U;
    return kept < self->budget ? self->budget - (uint32_t)kept : 0U;
}

// Starts the swarm on the leg under way or a later one; goes on to build when there is none left.
static void begin_swarm_leg(aisle_route *self) {
    self->stage = AISLE_ROUTE_SWARM;
    for (; self->leg < (uint32_t)self->request.num_goals; self->leg++) {
        aisle_leg *leg = &self->legs[self->leg];
        aisle_space_begin(&self->space, self->layout, self->vehicle, leg->mode);
        if (leg->count >= 2U && left_for_swarm(self) > 0U &&
            aisle_swarm_start(&self->swarm, &self->space, &self->objective, &self->request.options,
                              self->points + leg->first, leg->count) == AISLE_OK) {
            return;
        }
    }
    if (!any_swarm_leg(self)) {
        self->stage = AISLE_ROUTE_END;
        return;
    }
    self->path->path_revision++;
    begin_build(self, &self->better);
}

static aisle_status step_swarm(aisle_route *self, uint32_t units) {
    uint32_t left = left_for_swarm(self);
    aisle_status st = aisle_swarm_step(&self->swarm, units < left ? units : left, &self->spent);
    if (st == AISLE_BUSY && left_for_swarm(self) > 0U) {
        return AISLE_BUSY;
    }
    aisle_leg *leg = &self->legs[self->leg];
    self->swarm_evals += self->swarm.pso.evals;
    leg->via_count = aisle_swarm_best(&self->swarm, leg->via);
    leg->use_swarm = leg->via_count > 0U;
    self->leg++;
    begin_swarm_leg(self);
    return self->stage == AISLE_ROUTE_END ? AISLE_OK : AISLE_BUSY;
}

// ---- all together

static aisle_status step_stage(aisle_route *self, uint32_t units) {
    switch (self->stage) {
    case AISLE_ROUTE_CHECK:
        return check(self);
    case AISLE_ROUTE_SEED:
        return step_seed(self, units);
    case AISLE_ROUTE_TAUT:
        return step_taut(self, units);
    case AISLE_ROUTE_BUILD:
        return step_build(self, units);
    case AISLE_ROUTE_VERIFY:
        return step_verify(self, units);
    case AISLE_ROUTE_SWARM:
        return step_swarm(self, units);
    case AISLE_ROUTE_WHY:
        return step_why(self, units);
    default:
        return AISLE_OK;
    }
}

aisle_status aisle_route_step(aisle_route *self, uint32_t units) {
    aisle_status st = AISLE_BUSY;
    uint32_t until = units < UINT32_MAX - self->spent ? self->spent + units : UINT32_MAX;
    while (st == AISLE_BUSY && self->spent < until) {
        if (self->spent >= self->budget) {
            self->stage = AISLE_ROUTE_END;
            st = self->first.ready ? AISLE_OK : refuse(self, AISLE_STATUS_BUDGET, 0, (double)self->budget);
            break;
        }
        uint32_t left =
            self->budget - self->spent < until - self->spent ? self->budget - self->spent : until - self->spent;
        st = step_stage(self, left);
    }
    return st;
}

const aisle_proof *aisle_route_answer(const aisle_route *self) {
    if (self->better.ready) {
        return &self->better;
    }
    return self->first.ready ? &self->first : NULL;
}
