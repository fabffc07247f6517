#include "plan/arm_route.h"

#include "base/check.h"
#include "wire/codec.h"

#include <float.h>
#include <string.h>

#define SAME_ANGLE 1e-6 // rad: what a start or goal may be out of joint limits by rounding
#define NUMBER_MAX 1e6  // of a goal, in its unit
#define SEARCH_SHARE 2U // of the budget, for SEARCH
#define LIMIT_BLOCKS 1  // ids of AISLE_STATUS_LIMIT
#define LIMIT_WAYPOINTS 2

void aisle_arm_route_carve(aisle_arm_route *self, aisle_arena *arena, uint32_t nodes) {
    aisle_rrt_carve(self != NULL ? &self->tree : NULL, arena, nodes, AISLE_ARM_LINKS);
    aisle_arm_world_carve(self != NULL ? &self->world : NULL, arena, AISLE_ARM_BLOCKS);
    aisle_arm_search_carve(self != NULL ? &self->search : NULL, arena);
    void *time = aisle_arena_take(arena, 1U, sizeof(aisle_arm_time));
    aisle_arm_time_carve(self != NULL ? (aisle_arm_time *)time : NULL, arena);
    void *join = aisle_arena_take(arena, 1U, sizeof(aisle_arm_join));
    aisle_arm_join_carve(self != NULL ? (aisle_arm_join *)join : NULL, arena);
    void *goals = aisle_arena_take(arena, 1U, sizeof(aisle_arm_solutions));
    void *plan = aisle_arena_take(arena, 1U, sizeof(aisle_arm_plan));
    void *path = aisle_arena_take(arena, 1U, sizeof(aisle_arm_path_msg));
    void *decoded = aisle_arena_take(arena, 1U, sizeof(aisle_arm_path_msg));
    void *way = aisle_arena_take(arena, (size_t)nodes + 1U, sizeof(uint32_t));
    void *bytes = aisle_arena_take(arena, AISLE_ARM_PATH_BYTES, 1U);
    if (self != NULL) {
        self->time = (aisle_arm_time *)time;
        self->join = (aisle_arm_join *)join;
        self->goals = (aisle_arm_solutions *)goals;
        self->plan = (aisle_arm_plan *)plan;
        self->path = (aisle_arm_path_msg *)path;
        self->decoded = (aisle_arm_path_msg *)decoded;
        self->nodes = (uint32_t *)way;
        self->bytes = (uint8_t *)bytes;
    }
}

static aisle_status end(aisle_arm_route *self, int16_t cause, int32_t id, double value) {
    self->cause = (aisle_refusal){cause, id, (float)value};
    self->size = 0;
    self->stage = AISLE_ARM_STAGE_END;
    return AISLE_OK;
}

void aisle_arm_route_start(aisle_arm_route *self, const aisle_layout *layout, const aisle_vehicle *vehicle,
                           const aisle_vehicle_msg *vehicle_msg, const aisle_arm_request *request, uint32_t budget) {
    const int32_t asked = request->goal.options.work_units;
    self->layout = layout;
    self->vehicle = vehicle;
    self->request = *request;
    self->path->arm_goal_id = request->goal.arm_goal_id;
    self->stage = AISLE_ARM_STAGE_CHECK;
    self->size = 0;
    self->stamp = (aisle_stamp){0, 0};
    self->at = 0;
    self->stretch = 1.0;
    self->stretches = self->spent = 0;
    self->budget = asked > 0 ? (uint32_t)asked : budget;
    self->has_direct = false;
    self->cause = (aisle_refusal){0, 0, 0.0F};
    self->verify_failed = self->intervals = 0;
    self->collide = (aisle_collide_count){0, 0, 0};
    if (aisle_arm_from_msg(vehicle_msg, &self->arm, &self->cause) != AISLE_OK) {
        self->stage = AISLE_ARM_STAGE_END;
    } else if (self->arm.links == 0U) {
        (void)end(self, AISLE_STATUS_NO_ARM, 0, 0.0);
    }
}

static const aisle_options_msg *options_of(const aisle_arm_route *self) {
    return &self->request.goal.options;
}

static bool is_tree_named(const aisle_arm_route *self) {
    const int8_t planner = options_of(self)->planner;
    return planner >= AISLE_OPTIONS_RRT && planner <= AISLE_OPTIONS_RRT_STAR_ADAPTIVE;
}

static bool is_search_named(const aisle_arm_route *self) {
    const aisle_options_msg *options = options_of(self);
    return options->planner == AISLE_OPTIONS_GA || options->planner == AISLE_OPTIONS_PSO ||
           options->objective == AISLE_OPTIONS_PAPER;
}

// ---- check

static bool is_number(double x) { // false for NaN
    return x >= -NUMBER_MAX && x <= NUMBER_MAX;
}

static bool is_malformed(const aisle_arm_goal_msg *goal) {
    bool fits = goal->kind >= AISLE_ARM_GOAL_POINT && goal->kind <= AISLE_ARM_GOAL_STOW && is_number(goal->x) &&
                is_number(goal->y) && fabs(goal->theta) <= 1e4 && goal->tolerance_xy >= 0.0F &&
                is_number((double)goal->tolerance_xy) && goal->tolerance_theta >= 0.0F &&
                is_number((double)goal->tolerance_theta) && is_number((double)goal->options.step) &&
                is_number((double)goal->options.risk_weight) && goal->options.objective >= AISLE_OPTIONS_SAFEST &&
                goal->options.objective <= AISLE_OPTIONS_PAPER && goal->options.work_units >= 0;
    for (uint32_t j = 0; j < AISLE_ARM_LINKS; j++) {
        fits = fits && is_number((double)goal->q_start[j]) && is_number((double)goal->q[j]);
    }
    return !fits;
}

// Angles as sent, what rounding put beyond a limit moved back. Joint out of its limits, from 1; 0: none.
static uint32_t take_angles(const aisle_arm *arm, const float *sent, double *q) {
    for (uint32_t j = 0; j < arm->links; j++) {
        q[j] = (double)sent[j];
    }
    const uint32_t out = aisle_arm_joint_out(arm, q, SAME_ANGLE);
    for (uint32_t j = 0; j < arm->links; j++) {
        q[j] = aisle_clamp(q[j], arm->min[j], arm->max[j]);
    }
    return out;
}

static void solve(aisle_arm_route *self) {
    const aisle_arm_goal_msg *goal = &self->request.goal;
    const bool has_xy = goal->tolerance_xy > 0.0F, has_theta = goal->tolerance_theta > 0.0F;
    // A part of the tolerance is left for what the message rounds.
    const aisle_arm_target target = {
        .at = {goal->x, goal->y},
        .has_theta = goal->kind == AISLE_ARM_GOAL_POSE,
        .theta = goal->theta,
        .tolerance_xy = 0.9 * (has_xy ? (double)goal->tolerance_xy : AISLE_VERIFY_ARM_TOLERANCE),
        .tolerance_theta = 0.9 * (has_theta ? (double)goal->tolerance_theta : AISLE_VERIFY_ARM_TOLERANCE_THETA)};
    aisle_arm_solve(&self->arm, self->world.base, &target, self->start, self->goals);
}

// Configurations of the goal; those that are not free are left out. False: there is none, cause says why.
static bool find_goals(aisle_arm_route *self) {
    const aisle_arm_goal_msg *goal = &self->request.goal;
    aisle_arm_solutions *goals = self->goals;
    goals->count = 1;
    goals->miss = 0.0;
    goals->joint = 0;
    if (goal->kind == AISLE_ARM_GOAL_JOINTS) {
        goals->joint = take_angles(&self->arm, goal->q, goals->q[0]);
        goals->count = goals->joint == 0U ? 1U : 0U;
    } else if (goal->kind == AISLE_ARM_GOAL_STOW) {
        aisle_arm_stow(&self->arm, goals->q[0]);
    } else {
        solve(self);
    }
    if (goals->count == 0U) {
        const bool is_far = goals->miss > 0.0;
        (void)end(self, is_far ? AISLE_STATUS_OUT_OF_REACH : AISLE_STATUS_JOINT_LIMIT,
                  is_far ? 0 : (int32_t)goals->joint, goals->miss);
        return false;
    }
    uint32_t kept = 0;
    int32_t in_the_way = 0;
    for (uint32_t i = 0; i < goals->count; i++) {
        int32_t id = 0;
        self->spent += AISLE_ARM_UNITS;
        if (aisle_arm_world_gap(&self->world, goals->q[i], AISLE_ARM_SIGHT, NULL, &id) >= AISLE_ARM_KEEP) {
            memmove(goals->q[kept++], goals->q[i], sizeof goals->q[0]);
        } else if (in_the_way == 0) {
            in_the_way = id;
        }
    }
    goals->count = kept;
    if (kept == 0U) {
        (void)end(self, AISLE_STATUS_GOAL_OCCUPIED, in_the_way, 0.0);
    }
    return kept > 0U;
}

static aisle_status check(aisle_arm_route *self) {
    const aisle_arm_goal_msg *goal = &self->request.goal;
    int32_t id = 0;
    if (is_malformed(goal)) {
        return end(self, AISLE_STATUS_MALFORMED, goal->arm_goal_id, 0.0);
    }
    const uint32_t out = take_angles(&self->arm, goal->q_start, self->start);
    if (out != 0U) {
        return end(self, AISLE_STATUS_JOINT_LIMIT, (int32_t)out, 0.0);
    }
    if (aisle_arm_world_begin(&self->world, self->layout, self->vehicle, &self->arm, self->request.pose) != AISLE_OK) {
        return end(self, AISLE_STATUS_LIMIT, LIMIT_BLOCKS, (double)AISLE_ARM_BLOCKS);
    }
    aisle_arm_dynamics_begin(&self->dynamics, &self->arm, self->world.base.theta);
    self->spent += AISLE_ARM_UNITS;
    if (aisle_arm_world_gap(&self->world, self->start, AISLE_ARM_SIGHT, NULL, &id) < AISLE_ARM_KEEP) {
        return end(self, AISLE_STATUS_START_OCCUPIED, id, 0.0);
    }
    if (!find_goals(self)) {
        return AISLE_OK;
    }
    self->stage = AISLE_ARM_STAGE_DIRECT;
    return AISLE_BUSY;
}

// ---- ways

static void begin_time(aisle_arm_route *self, int8_t planner) {
    self->path->planner = planner;
    self->timed = 0;
    self->stage = AISLE_ARM_STAGE_TIME;
}

static void begin_search(aisle_arm_route *self) {
    aisle_arm_search_start(&self->search, &self->world, self->start, self->goals->q[self->at], options_of(self));
    self->stage = AISLE_ARM_STAGE_SEARCH;
}

static void begin_tree(aisle_arm_route *self) {
    const aisle_options_msg *options = options_of(self);
    const int8_t kind = is_tree_named(self) ? options->planner : AISLE_OPTIONS_RRT_STAR_ADAPTIVE;
    const bool star = kind == AISLE_OPTIONS_RRT_STAR || kind == AISLE_OPTIONS_RRT_STAR_ADAPTIVE;
    const bool adaptive = kind == AISLE_OPTIONS_RRT_ADAPTIVE || kind == AISLE_OPTIONS_RRT_STAR_ADAPTIVE;
    aisle_arm_space_begin(&self->space, &self->world);
    aisle_rrt_config cfg = aisle_arm_space_rrt(&self->space, star, adaptive, (double)options->step);
    memcpy(cfg.start, self->start, sizeof self->start);
    memcpy(cfg.goal, self->goals->q[self->at], sizeof self->start);
    cfg.seed = (uint64_t)(int64_t)options->seed;
    const aisle_status st = aisle_rrt_start(&self->tree, &cfg);
    AISLE_ASSERT(st == AISLE_OK);
    self->path->planner = kind;
    self->stage = AISLE_ARM_STAGE_TREE;
}

static bool is_same(const aisle_arm_route *self, const double *q) {
    double apart = 0.0;
    for (uint32_t j = 0; j < self->arm.links; j++) {
        apart = aisle_max(apart, fabs(q[j] - self->start[j]));
    }
    return !(apart > 0.0);
}

// Is the straight motion good enough for the objective?
static bool is_done_with(aisle_arm_route *self, const aisle_arm_piece *piece) {
    const int8_t objective = options_of(self)->objective;
    if (is_search_named(self)) {
        return false;
    }
    if (objective == AISLE_OPTIONS_SHORTEST) {
        return true;
    }
    double least = (double)INFINITY, q[AISLE_ARM_LINKS];
    for (uint32_t i = 0; i <= AISLE_ARM_SAMPLES; i++) {
        aisle_arm_piece_at(piece, (double)i / (double)AISLE_ARM_SAMPLES, 0U, q);
        least = aisle_min(least, aisle_arm_world_gap(&self->world, q, AISLE_ARM_CREEP, NULL, NULL));
        self->spent += AISLE_ARM_UNITS;
    }
    return objective == AISLE_OPTIONS_SAFEST && least >= AISLE_ARM_CREEP;
}

static aisle_status direct(aisle_arm_route *self) {
    const double *to = self->goals->q[self->at];
    self->plan->count = 0;
    if (is_same(self, to)) {
        begin_time(self, AISLE_OPTIONS_AUTO);
        return AISLE_BUSY;
    }
    aisle_arm_piece *piece = &self->plan->piece[0];
    aisle_arm_piece_of(self->arm.links, self->start, to, NULL, piece);
    const bool is_skipped = is_tree_named(self) || options_of(self)->objective == AISLE_OPTIONS_PAPER;
    if (!is_skipped && aisle_arm_free_line(&self->world, self->start, to, &self->spent)) {
        self->plan->count = 1;
        self->has_direct = true;
        if (is_done_with(self, piece)) {
            begin_time(self, AISLE_OPTIONS_AUTO);
        } else {
            begin_search(self);
        }
        return AISLE_BUSY;
    }
    self->at++;
    if (self->at == self->goals->count || is_skipped) {
        self->at = 0;
        if (is_tree_named(self)) {
            begin_tree(self);
        } else {
            begin_search(self);
        }
    }
    return AISLE_BUSY;
}

// The next goal's turn, at most AISLE_ARM_TRIES; false: all had theirs.
static bool next_goal(aisle_arm_route *self) {
    self->at++;
    return self->at < self->goals->count && self->at < AISLE_ARM_TRIES;
}

static aisle_status give_up(aisle_arm_route *self) {
    return end(self, AISLE_STATUS_BUDGET, self->request.goal.arm_goal_id, (double)self->spent);
}

static aisle_status search(aisle_arm_route *self, uint32_t units) {
    const uint32_t limit = is_search_named(self) ? self->budget : self->budget / SEARCH_SHARE;
    aisle_status st = AISLE_PARTIAL;
    if (self->spent < limit) {
        const uint32_t left = limit - self->spent;
        st = aisle_arm_search_step(&self->search, units < left ? units : left, &self->spent);
    }
    if (st == AISLE_BUSY && self->spent < limit) {
        return AISLE_BUSY;
    }
    if (aisle_arm_search_best(&self->search, &self->plan->piece[0])) {
        self->plan->count = 1;
        begin_time(self, self->search.swarm ? AISLE_OPTIONS_PSO : AISLE_OPTIONS_GA);
    } else if (self->has_direct) { // ended before it had looked at it
        self->plan->count = 1;
        aisle_arm_piece_of(self->arm.links, self->start, self->goals->q[self->at], NULL, &self->plan->piece[0]);
        begin_time(self, AISLE_OPTIONS_AUTO);
    } else if (self->spent < limit && next_goal(self)) {
        begin_search(self);
    } else if (is_search_named(self)) {
        return give_up(self);
    } else {
        self->at = 0;
        begin_tree(self);
    }
    return AISLE_BUSY;
}

static aisle_status tree(aisle_arm_route *self, uint32_t units) {
    aisle_status st = AISLE_BUSY;
    if (self->spent < self->budget) {
        const uint32_t left = self->budget - self->spent;
        st = aisle_rrt_step(&self->tree, units < left ? units : left, &self->spent);
    }
    if (st == AISLE_BUSY && self->spent < self->budget) {
        return AISLE_BUSY;
    }
    if (!(aisle_rrt_cost(&self->tree) < (double)INFINITY)) {
        if (self->spent < self->budget && next_goal(self)) {
            begin_tree(self);
            return AISLE_BUSY;
        }
        return give_up(self);
    }
    self->node_count = aisle_rrt_path(&self->tree, self->nodes, self->tree.capacity + 1U);
    AISLE_ASSERT(self->node_count >= 2U && self->node_count <= self->tree.capacity + 1U);
    self->node_at = 0;
    self->node_to = self->node_count - 1U;
    self->plan->count = 0;
    self->stage = AISLE_ARM_STAGE_PULL;
    return AISLE_BUSY;
}

// From each via-point straight to the last one of the tree's path that is free.
static aisle_status pull(aisle_arm_route *self) {
    const double *from = aisle_rrt_at(&self->tree, self->nodes[self->node_at]);
    const double *to = aisle_rrt_at(&self->tree, self->nodes[self->node_to]);
    if (self->plan->count == AISLE_ARM_PIECES) {
        return end(self, AISLE_STATUS_LIMIT, LIMIT_WAYPOINTS, (double)AISLE_ARM_PATH_MAX_WAYPOINTS);
    }
    aisle_arm_piece *piece = &self->plan->piece[self->plan->count];
    aisle_arm_piece_of(self->arm.links, from, to, NULL, piece);
    if (self->node_to > self->node_at + 1U && !aisle_arm_free_line(&self->world, from, to, &self->spent)) {
        self->node_to--;
        return AISLE_BUSY;
    }
    self->plan->count++;
    self->node_at = self->node_to;
    self->node_to = self->node_count - 1U;
    if (self->node_at == self->node_to) {
        begin_time(self, self->path->planner);
    }
    return AISLE_BUSY;
}

// ---- time

// What comes once durations are known: PAPER searches its own, piece by piece; a path of several pieces is joined.
static void go_on(aisle_arm_route *self) {
    const aisle_options_msg *options = options_of(self);
    const bool is_paper = options->objective == AISLE_OPTIONS_PAPER;
    self->stage = AISLE_ARM_STAGE_BUILD;
    if (is_paper && self->timed < self->plan->count) {
        aisle_arm_time_start(self->time, &self->arm, &self->dynamics, &self->plan->piece[self->timed],
                             (uint64_t)(int64_t)options->seed);
        self->timed++;
        self->stage = AISLE_ARM_STAGE_TIME;
    } else if (!is_paper && self->plan->count > 1U) {
        aisle_arm_search_start(&self->search, &self->world, self->start, self->goals->q[self->at], options);
        aisle_arm_join_start(self->join, &self->world, &self->dynamics, &self->search, self->plan, &self->spent);
        self->stage = AISLE_ARM_STAGE_JOIN;
    }
}

static aisle_status time(aisle_arm_route *self, uint32_t units) {
    uint32_t joint = 0;
    if (self->timed == 0U) {
        if (!aisle_arm_plan_time(self->plan, &self->arm, &self->dynamics, &joint)) {
            return end(self, AISLE_STATUS_KINEMATIC, (int32_t)joint + 1, 0.0);
        }
        self->spent += AISLE_ARM_UNITS * self->plan->count;
        go_on(self);
    } else if (aisle_arm_time_step(self->time, units, &self->spent, &self->plan->duration[self->timed - 1U]) !=
               AISLE_BUSY) {
        go_on(self);
    }
    return AISLE_BUSY;
}

static aisle_status join(aisle_arm_route *self, uint32_t units) {
    if (aisle_arm_join_step(self->join, units, &self->spent) == AISLE_OK) {
        self->stage = AISLE_ARM_STAGE_BUILD;
    }
    return AISLE_BUSY;
}

// ---- build and proof

static aisle_status build(aisle_arm_route *self) {
    if (aisle_arm_compose(self->plan, &self->world, &self->dynamics, self->start, self->stretch, self->path) !=
        AISLE_OK) {
        return end(self, AISLE_STATUS_LIMIT, LIMIT_WAYPOINTS, (double)AISLE_ARM_PATH_MAX_WAYPOINTS);
    }
    self->spent += AISLE_ARM_UNITS * (uint32_t)(uint16_t)self->path->num_waypoints;
    self->path->status = AISLE_PATH_OK;
    self->path->cause = 0;
    self->path->cause_id = 0;
    self->path->work_units = (int32_t)self->spent;
    if (aisle_msg_encode(AISLE_MSG_ARM_PATH, self->path, self->bytes, AISLE_ARM_PATH_BYTES, &self->size) != AISLE_OK) {
        return end(self, AISLE_STATUS_INTERNAL, 0, 0.0);
    }
    const aisle_verify_arm_request request = {.layout = self->layout,
                                              .vehicle = self->vehicle,
                                              .arm = &self->arm,
                                              .pose = self->request.pose,
                                              .goal = &self->request.goal,
                                              .bytes = self->bytes,
                                              .size = self->size};
    aisle_verify_arm_start(&self->verify, &request, self->decoded);
    self->stage = AISLE_ARM_STAGE_VERIFY;
    return AISLE_BUSY;
}

static bool is_too_fast(aisle_verify_arm_fault fault) {
    return fault >= AISLE_VERIFY_ARM_VELOCITY && fault <= AISLE_VERIFY_ARM_TORQUE;
}

static aisle_status verify(aisle_arm_route *self, uint32_t units) {
    const aisle_status st = aisle_verify_arm_step(&self->verify, units, &self->spent, &self->stamp);
    if (st == AISLE_BUSY) {
        return AISLE_BUSY;
    }
    self->intervals += self->verify.intervals;
    self->collide.calls += self->verify.collide.calls;
    self->collide.unfit += self->verify.collide.unfit;
    if (self->verify.collide.support_max > self->collide.support_max) {
        self->collide.support_max = self->verify.collide.support_max;
    }
    if (st == AISLE_OK) {
        self->stage = AISLE_ARM_STAGE_END;
        return AISLE_OK;
    }
    self->verify_failed++;
    if (is_too_fast(self->verify.fault) && self->stretches < AISLE_ARM_STRETCHES) {
        self->stretch *= AISLE_ARM_STRETCH;
        self->stretches++;
        self->stage = AISLE_ARM_STAGE_BUILD;
        return AISLE_BUSY;
    }
    return end(self, AISLE_STATUS_VERIFY_FAILED, (int32_t)self->verify.fault, 0.0);
}

static aisle_status step(aisle_arm_route *self, uint32_t units) {
    switch (self->stage) {
    case AISLE_ARM_STAGE_CHECK:
        return check(self);
    case AISLE_ARM_STAGE_DIRECT:
        return direct(self);
    case AISLE_ARM_STAGE_SEARCH:
        return search(self, units);
    case AISLE_ARM_STAGE_TREE:
        return tree(self, units);
    case AISLE_ARM_STAGE_PULL:
        return pull(self);
    case AISLE_ARM_STAGE_TIME:
        return time(self, units);
    case AISLE_ARM_STAGE_JOIN:
        return join(self, units);
    case AISLE_ARM_STAGE_BUILD:
        return build(self);
    case AISLE_ARM_STAGE_VERIFY:
        return verify(self, units);
    default:
        return AISLE_OK;
    }
}

aisle_status aisle_arm_route_step(aisle_arm_route *self, uint32_t units) {
    const uint32_t from = self->spent;
    aisle_status st = AISLE_BUSY;
    AISLE_ASSERT(self->stage != AISLE_ARM_STAGE_IDLE);
    while (st == AISLE_BUSY && self->spent - from < units) {
        st = step(self, units - (self->spent - from));
    }
    return st;
}
