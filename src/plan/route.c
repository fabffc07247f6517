#include "plan/route.h"

#include "plan/route_stages.h"

#include <string.h>

// While measuring there is no route: its parts are carved one after the other into this.
typedef union part {
    aisle_local local;
    aisle_space space;
    aisle_tangent tangent;
    aisle_manoeuvre manoeuvre;
    aisle_tour tour;
    aisle_seed seed;
    aisle_swarm swarm;
    aisle_paper_swarm paper;
    aisle_compose compose;
    aisle_roadmap_keep keep;
    aisle_roadmap_search ask;
} part;

#define PART(self, instead, name) ((self) != NULL ? &(self)->name : &(instead)->name)

static void carve_sample(aisle_route *self, aisle_arena *arena, const aisle_limits *limits) {
    const uint32_t share = limits->cells / AISLE_ROUTE_SAMPLE_CELLS;
    const uint32_t nodes = share > AISLE_ROUTE_SAMPLE_NODES ? AISLE_ROUTE_SAMPLE_NODES : share;
    aisle_rrt_carve(self != NULL ? &self->sample.tree : NULL, arena, nodes, AISLE_ROUTE_SAMPLE_DIM);
    void *path = aisle_arena_take(arena, (size_t)nodes + 1U, sizeof(uint32_t));
    if (self != NULL) {
        self->sample.path = (uint32_t *)path;
    }
}

static uint32_t roadmap_draws(const aisle_limits *limits) {
    const uint32_t share = limits->cells / AISLE_ROUTE_SAMPLE_CELLS;
    return share > AISLE_ROUTE_ROADMAP_DRAWS ? AISLE_ROUTE_ROADMAP_DRAWS : share;
}

// What a question to a roadmap takes, and a goal list's copy of it.
static void carve_ask(aisle_route *self, part *instead, aisle_arena *arena, const aisle_limits *limits) {
    const uint32_t draws = roadmap_draws(limits);
    aisle_roadmap_keep_carve(self != NULL ? &self->sample.copy : &instead->keep, arena, draws);
    aisle_roadmap_search_carve(self != NULL ? &self->sample.ask : &instead->ask, arena, draws);
    void *way = aisle_arena_take(arena, ((size_t)draws + 2U) * AISLE_ROADMAP_KEEP_DIM, sizeof(double));
    if (self != NULL) {
        self->sample.way = (double *)way;
    }
}

// No leg is searched two ways at a time: the other searches lie where the grid search does. Nor
// is anything searched while an order is computed.
static void carve_searches(aisle_route *self, part *instead, aisle_arena *arena, const aisle_limits *limits,
                           size_t lend) {
    const size_t lent_end = arena->used + lend;
    aisle_arena shared[7] = {*arena, *arena, *arena, *arena, *arena, *arena, *arena};
    aisle_tangent_carve(PART(self, instead, tangent), &shared[0], limits);
    aisle_manoeuvre_carve(PART(self, instead, manoeuvre), &shared[1], limits);
    aisle_tour_carve_shared(PART(self, instead, tour), &shared[2]);
    aisle_local_carve(PART(self, instead, local), &shared[3], limits->cells);
    carve_sample(self, &shared[4], limits);
    carve_ask(self, instead, &shared[5], limits);
    aisle_barrier_carve(self != NULL ? &self->barrier : NULL, &shared[6]);
    aisle_seed_carve(PART(self, instead, seed), arena, limits);
    for (uint32_t i = 0; i < 7U; i++) {
        arena->overflow = arena->overflow || shared[i].overflow;
        arena->used = arena->used > shared[i].used ? arena->used : shared[i].used;
    }
    arena->overflow = arena->overflow || lent_end > arena->size;
    arena->used = arena->used > lent_end ? arena->used : lent_end;
}

static void carve_buffers(aisle_route *self, aisle_arena *arena) {
    void *points = // and one for each leg that begins at its goal
        aisle_arena_take(arena, AISLE_ROUTE_POINTS + AISLE_GOAL_LIST_MAX_GOALS, sizeof(aisle_vec2));
    void *guide[2];
    guide[0] = aisle_arena_take(arena, AISLE_SEED_POINTS_MAX, sizeof(aisle_vec2));
    guide[1] = aisle_arena_take(arena, AISLE_SEED_POINTS_MAX, sizeof(aisle_vec2));
    void *pieces = aisle_arena_take(arena, AISLE_ROUTE_PIECES, sizeof(aisle_waypoint_msg));
    void *legs = aisle_arena_take(arena, AISLE_GOAL_LIST_MAX_GOALS, sizeof(aisle_leg));
    void *path = aisle_arena_take(arena, 1U, sizeof(aisle_path_msg));
    void *decoded = aisle_arena_take(arena, 1U, sizeof(aisle_path_msg));
    void *best = aisle_arena_take(arena, AISLE_ROUTE_BYTES, 1U);
    void *spare = aisle_arena_take(arena, AISLE_ROUTE_BYTES, 1U);
    if (self == NULL) {
        return;
    }
    self->points = (aisle_vec2 *)points;
    self->guide[0].points = (aisle_vec2 *)guide[0];
    self->guide[1].points = (aisle_vec2 *)guide[1];
    self->pieces = (aisle_waypoint_msg *)pieces;
    self->legs = (aisle_leg *)legs;
    self->path = (aisle_path_msg *)path;
    self->decoded = (aisle_path_msg *)decoded;
    self->best.bytes = (uint8_t *)best;
    self->spare.bytes = (uint8_t *)spare;
}

void aisle_route_carve(aisle_route *self, aisle_arena *arena, const aisle_limits *limits) {
    aisle_route_carve_lending(self, arena, limits, 0, NULL);
}

void aisle_route_carve_lending(aisle_route *self, aisle_arena *arena, const aisle_limits *limits, size_t bytes,
                               aisle_arena *lent) {
    part measured;
    memset(&measured, 0, sizeof measured);
    part *instead = &measured;
    aisle_space_carve(PART(self, instead, space), arena, limits->cells);
    if (lent != NULL) {
        *lent = *arena;
    }
    carve_searches(self, instead, arena, limits, bytes);
    aisle_manoeuvre_carve_way(PART(self, instead, manoeuvre), arena);
    aisle_tour_carve(PART(self, instead, tour), arena);
    aisle_swarm_carve(PART(self, instead, swarm), arena);
    aisle_paper_swarm_carve(PART(self, instead, paper), arena);
    aisle_compose_carve(PART(self, instead, compose), arena);
    carve_buffers(self, arena);
}

void aisle_route_carve_cache(aisle_route *self, aisle_arena *arena, const aisle_limits *limits) {
    aisle_cache measured = {0};
    aisle_cache_carve(self != NULL ? &self->cache : &measured, arena, limits);
}

void aisle_route_carve_roadmap(aisle_route *self, aisle_arena *arena, const aisle_limits *limits) {
    aisle_roadmap_keep measured;
    aisle_roadmap_keep_carve(self != NULL ? &self->keep : &measured, arena, roadmap_draws(limits));
}

// Header of the answer: everything but waypoints and sums.
static void copy_head(aisle_route *self, const aisle_path_msg *head) {
    aisle_path_msg *path = self->path;
    const aisle_request *request = &self->request;
    path->utime = head->utime;
    path->boot_id = head->boot_id;
    self->revision = head->path_revision;
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
    memcpy(self->asked, request->goals, sizeof self->asked);
    self->stage = AISLE_ROUTE_RECALL;
    self->recalled = AISLE_CACHE_NONE;
    self->repair.is_done = false;
    self->is_cut = false;
    self->leg = 0;
    self->point_count = 0;
    self->piece_count = 0;
    self->best.ready = self->best.told = false;
    self->spare.ready = self->spare.told = false;
    self->stops = false;
    self->is_wide = false;
    self->is_unbred = false;
    self->announced = false;
    self->movers = NULL;
    self->in_motion = false;
    self->told_count = 0;
    self->named = AISLE_ROUTE_NONE;
    self->spent = 0;
    self->tangent_units = 0;
    self->proof_units = 0;
    self->swarm_evals = self->nodes = self->verify_failed = self->intervals = 0;
    self->collide = (aisle_collide_count){0};
    self->cause = (aisle_refusal){0, 0, 0.0F};
    self->budget = request->options.work_units > 0 ? (uint32_t)request->options.work_units : self->budget_default;
    copy_head(self, head);
}

// ---- all together

static aisle_status step_stage(aisle_route *self, uint32_t units) {
    switch (self->stage) {
    case AISLE_ROUTE_RECALL:
        return aisle_route_recall(self);
    case AISLE_ROUTE_REPROVE:
        return aisle_route_step_reprove(self, units);
    case AISLE_ROUTE_REPAIR:
        return aisle_route_step_repair(self, units);
    case AISLE_ROUTE_CHECK:
        return aisle_route_check(self);
    case AISLE_ROUTE_ORDER:
        return aisle_route_step_order(self, units);
    case AISLE_ROUTE_TANGENT:
        return aisle_route_step_tangent(self, units);
    case AISLE_ROUTE_MANOEUVRE:
        return aisle_route_step_manoeuvre(self, units);
    case AISLE_ROUTE_NEAREST:
        return aisle_route_step_nearest(self, units);
    case AISLE_ROUTE_SEED:
        return aisle_route_step_seed(self, units);
    case AISLE_ROUTE_TAUT:
        return aisle_route_step_taut(self, units);
    case AISLE_ROUTE_BUILD:
        return aisle_route_step_build(self, units);
    case AISLE_ROUTE_VERIFY:
        return aisle_route_step_verify(self, units);
    case AISLE_ROUTE_SWARM:
        return aisle_route_step_swarm(self, units);
    case AISLE_ROUTE_PAPER:
        return aisle_route_step_paper(self, units);
    case AISLE_ROUTE_LOCAL:
        return aisle_route_step_local(self, units);
    case AISLE_ROUTE_SAMPLE:
        return aisle_route_step_sample(self, units);
    case AISLE_ROUTE_GA:
        return aisle_route_step_ga(self, units);
    case AISLE_ROUTE_ONE_WAY:
        return aisle_route_step_one_way(self, units);
    case AISLE_ROUTE_WHY:
        return aisle_route_step_why(self, units);
    case AISLE_ROUTE_NEXT:
        return aisle_route_next_way(self);
    case AISLE_ROUTE_DROP:
        return aisle_route_give_way_up(self, AISLE_STATUS_KINEMATIC, 0, 0.0,
                                       aisle_route_place(&self->request.goals[self->leg]));
    case AISLE_ROUTE_OPENING:
        return aisle_route_step_opening(self, units);
    case AISLE_ROUTE_SIDES:
        return aisle_route_step_sides(self, units);
    default:
        return AISLE_OK;
    }
}

// What is known by now is told: the first path, a cause already found, or that the budget was too small.
static aisle_status out_of_budget(aisle_route *self) {
    self->stage = AISLE_ROUTE_END;
    if (self->best.ready || self->cause.cause != 0) {
        return AISLE_OK;
    }
    return aisle_route_refuse(self, AISLE_STATUS_BUDGET, 0, (double)self->budget);
}

aisle_status aisle_route_step(aisle_route *self, uint32_t units) {
    aisle_status st = AISLE_BUSY;
    uint32_t until = units < UINT32_MAX - self->spent ? self->spent + units : UINT32_MAX;
    while (st == AISLE_BUSY && self->spent < until) {
        if (self->spent >= self->budget) {
            st = out_of_budget(self);
            break;
        }
        uint32_t left =
            self->budget - self->spent < until - self->spent ? self->budget - self->spent : until - self->spent;
        st = step_stage(self, left);
    }
    if (st == AISLE_OK) {
        aisle_route_remember(self);
    }
    return st;
}

const aisle_proof *aisle_route_answer(const aisle_route *self) {
    return self->best.ready ? &self->best : NULL;
}
