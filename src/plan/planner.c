#include "plan/planner_state.h"

#include "base/check.h"

#include <stddef.h>
#include <string.h>

#if AISLE_PLANNER_ALIGN != AISLE_ARENA_ALIGN
#error "the planner's block is an arena"
#endif

#define LAYOUT_ROW 8U // work units of a step that a layout's row or polygon stands for: it takes about so much longer

// ---- memory

static bool resolve(uint32_t *value, uint32_t standard, uint32_t lo, uint32_t hi) {
    if (*value == 0U) {
        *value = standard;
    }
    return *value >= lo && *value <= hi;
}

static bool resolve_limits(aisle_limits *limits) {
    return resolve(&limits->cells, AISLE_LIMITS_CELLS_DEFAULT, 4096U, AISLE_LIMITS_CELLS_MAX) &&
           resolve(&limits->polygons, AISLE_LIMITS_POLYGONS_DEFAULT, 1U, 4096U) &&
           resolve(&limits->vertices, AISLE_LIMITS_VERTICES_DEFAULT, 3U, 65536U) &&
           resolve(&limits->open_nodes, AISLE_LIMITS_OPEN_NODES_DEFAULT, 1024U, 4194304U) &&
           resolve(&limits->requests, AISLE_LIMITS_REQUESTS_DEFAULT, 1U, 64U) &&
           resolve(&limits->cached_paths, AISLE_LIMITS_CACHED_PATHS_DEFAULT, 1U, 1024U);
}

// Closes a row of the memory table: everything taken since the last one.
static void row(aisle_planner *self, const aisle_arena *arena, size_t *from, const char *name) {
    if (self != NULL) {
        AISLE_ASSERT(self->row_count < AISLE_MEMORY_ROWS);
        self->rows[self->row_count++] = (aisle_memory_row){.name = name, .bytes = arena->used - *from};
    }
    *from = arena->used;
}

static void carve_answers(aisle_planner *self, aisle_arena *arena) {
    void *vehicle_msg = aisle_arena_take(arena, 1U, sizeof(aisle_vehicle_msg));
    void *head = aisle_arena_take(arena, 1U, sizeof(aisle_path_msg));
    void *first = aisle_arena_take(arena, AISLE_REFUSAL_BYTES, 1U);
    void *second = aisle_arena_take(arena, AISLE_REFUSAL_BYTES, 1U);
    if (self != NULL) {
        self->vehicle_msg = (aisle_vehicle_msg *)vehicle_msg;
        self->head = (aisle_path_msg *)head;
        self->refusal[0] = (uint8_t *)first;
        self->refusal[1] = (uint8_t *)second;
    }
}

// One walk for measuring and carving. While measuring there is no planner (NULL), and what is small stands in for its
// parts: the whole would be too large for the stack.
static aisle_planner *carve(aisle_arena *arena, const aisle_limits *limits) {
    size_t from = 0;
    aisle_layout layout_instead;
    aisle_movers movers_instead;
    memset(&layout_instead, 0, sizeof layout_instead);
    memset(&movers_instead, 0, sizeof movers_instead);
    aisle_planner *self = (aisle_planner *)aisle_arena_take(arena, 1U, sizeof(aisle_planner));
    aisle_layout *layout = (aisle_layout *)aisle_arena_take(arena, 1U, sizeof(aisle_layout));
    aisle_route *route = (aisle_route *)aisle_arena_take(arena, 1U, sizeof(aisle_route));
    row(self, arena, &from, "planner");
    aisle_layout_carve(layout != NULL ? layout : &layout_instead, arena, limits);
    row(self, arena, &from, "layout and grid");
    aisle_arena lent;
    aisle_route_carve_lending(route, arena, limits, aisle_planner_arm_lent(limits), &lent);
    row(self, arena, &from, "search and paths");
    aisle_planner_arm *arm = (aisle_planner_arm *)aisle_arena_take(arena, 1U, sizeof(aisle_planner_arm));
    aisle_planner_arm_carve(arm, &lent, limits);
    row(self, arena, &from, "arm, beside the searches'");
    aisle_route_carve_cache(route, arena, limits);
    row(self, arena, &from, "remembered paths");
    aisle_route_carve_roadmap(route, arena, limits);
    row(self, arena, &from, "roadmap");
    void *queue = aisle_arena_take(arena, limits->requests, sizeof(aisle_request));
    row(self, arena, &from, "requests");
    carve_answers(self, arena);
    row(self, arena, &from, "answers");
    aisle_movers_carve(self != NULL ? &self->movers : &movers_instead, arena);
    row(self, arena, &from, "moving obstacles");
    aisle_drive_carve(self != NULL ? &self->drive : NULL, arena);
    aisle_pace_predict_carve(self != NULL ? &self->predict : NULL, arena);
    row(self, arena, &from, "path under way");
    if (self != NULL) {
        self->layout = layout;
        self->route = route;
        self->route->known = self->drive.known;
        self->arm = arm;
        self->queue = (aisle_request *)queue;
    }
    return self;
}

size_t aisle_planner_memsize(const aisle_limits *limits) {
    if (limits == NULL) {
        return 0;
    }
    aisle_limits resolved = *limits;
    if (!resolve_limits(&resolved)) {
        return 0;
    }
    aisle_arena arena = aisle_arena_measure();
    (void)carve(&arena, &resolved);
    return arena.overflow ? 0 : arena.used;
}

aisle_status aisle_planner_init(void *memory, size_t size, const aisle_config *config, aisle_planner **planner) {
    if (memory == NULL || config == NULL || planner == NULL || (uintptr_t)memory % AISLE_ARENA_ALIGN != 0U) {
        return AISLE_ERR_ARG;
    }
    size_t need = aisle_planner_memsize(&config->limits);
    aisle_vehicle vehicle = {0};
    aisle_refusal why;
    const float lease = config->shortest_lease;
    const bool has_lease = lease >= 0.05F && lease <= 1.0F, has_default = lease >= 0.0F && lease <= 0.0F;
    if (need == 0U || config->work_units < 0 || !(has_lease || has_default) ||
        (config->has_vehicle && aisle_vehicle_from_msg(&config->vehicle, &vehicle, &why) != AISLE_OK)) {
        return AISLE_ERR_ARG;
    }
    if (size < need) {
        return AISLE_ERR_CAPACITY;
    }
    aisle_limits limits = config->limits;
    bool in_range = resolve_limits(&limits);
    aisle_arena arena = aisle_arena_over(memory, need);
    aisle_planner *self = carve(&arena, &limits);
    AISLE_ASSERT(in_range && !arena.overflow && arena.used == need);
    self->config = *config;
    self->config.limits = limits;
    self->has_vehicle = config->has_vehicle;
    self->vehicle = vehicle;
    *self->vehicle_msg = config->vehicle;
    self->route->forgetful = config->forgetful;
    self->drive.shortest_lease = (double)(has_lease ? lease : AISLE_LEASE_SHORTEST);
    self->route->budget_default = config->work_units > 0 ? (uint32_t)config->work_units : AISLE_WORK_UNITS_DEFAULT;
    *planner = self;
    return AISLE_OK;
}

size_t aisle_planner_memory(const aisle_planner *self, aisle_memory_row *rows, size_t capacity) {
    for (uint32_t i = 0; i < self->row_count && i < capacity; i++) {
        rows[i] = self->rows[i];
    }
    return self->row_count;
}

// ---- requests in turn

static bool is_stale(const aisle_planner *self, const aisle_request *request) {
    return !request->is_query && aisle_mission_is_stale(&self->mission, request);
}

static void begin(aisle_planner *self, aisle_request *request) {
    if (!request->is_query) {
        self->mission.replan = false;
        self->mission.cause = 0;
        aisle_planner_leave_from(self, request);
    }
    aisle_refusal why = aisle_planner_hindrance(self, request);
    if (why.cause != 0) {
        if (request->is_query) {
            aisle_planner_refuse(self, request, &why, NULL, 0, 0);
        } else {
            aisle_planner_take_failure(self, request, &why, NULL, 0, 0);
        }
        self->counters[request->is_query ? AISLE_COUNTER_QUERIES : AISLE_COUNTER_GOAL_LISTS]++;
        return;
    }
    aisle_planner_fill_head(self, request);
    aisle_path_msg *head = self->head;
    head->path_revision = self->path_revision + 1;
    head->valid_until_utime = self->now_us + AISLE_LEASE_US;
    self->leaving.goes_round = self->leaving.round && !request->is_query;
    aisle_route_start(self->route, self->layout, &self->vehicle, request, head);
    if (self->leaving.goes_round) {
        aisle_planner_go_round(self);
    }
    self->planning = true;
}

static void begin_next(aisle_planner *self) {
    if (self->queue_count == 0U) {
        begin(self, aisle_planner_renew_request(self));
        return;
    }
    aisle_request *request = &self->queue[self->queue_head];
    self->queue_head = (self->queue_head + 1U) % self->config.limits.requests;
    self->queue_count--;
    if (request->is_arm) {
        aisle_planner_arm_begin(self, request);
    } else if (!is_stale(self, request)) { // else cancelled or overtaken by a newer goal list
        begin(self, request);
    }
}

static void count_cache(aisle_planner *self) {
    const aisle_cache *cache = &self->route->cache;
    int64_t *counters = self->counters;
    counters[AISLE_COUNTER_CACHE_HITS] = cache->hits;
    counters[AISLE_COUNTER_CACHE_MISSES] = cache->misses;
    counters[AISLE_COUNTER_CACHE_KEPT] = cache->kept;
    counters[AISLE_COUNTER_CACHE_DROPPED] = cache->dropped;
    counters[AISLE_COUNTER_CACHE_SPOILED] = cache->spoiled;
    counters[AISLE_COUNTER_CACHE_REPAIRED] = cache->repaired;
}

static void count_route(aisle_planner *self) {
    const aisle_route *route = self->route;
    int64_t *counters = self->counters;
    counters[AISLE_COUNTER_NODES] += route->nodes;
    counters[AISLE_COUNTER_SWARM_EVALS] += route->swarm_evals;
    counters[AISLE_COUNTER_VERIFY_FAILED] += route->verify_failed;
    counters[AISLE_COUNTER_VERIFY_INTERVALS] += route->intervals;
    counters[AISLE_COUNTER_OPEN_NODES_MAX] = route->seed.search.open_used_max;
    counters[AISLE_COUNTER_ROADMAPS] = route->keep.begun + route->sample.copy.begun;
    counters[AISLE_COUNTER_ROADMAP_REPAIRS] = route->keep.repairs + route->sample.copy.repairs;
    count_cache(self);
    counters[AISLE_COUNTER_CCD_CALLS] += route->collide.calls;
    if (route->collide.support_max > counters[AISLE_COUNTER_CCD_SUPPORT_MAX]) {
        counters[AISLE_COUNTER_CCD_SUPPORT_MAX] = route->collide.support_max;
    }
    counters[route->request.is_query ? AISLE_COUNTER_QUERIES : AISLE_COUNTER_GOAL_LISTS]++;
}

// The mission's goal just refused is proved to be out of reach: the others are asked for, if that is wished. A vehicle that
// moves is stopped first: only one at rest was told which goal it is, and it will be when it has asked again.
static void skip_unreachable(aisle_planner *self) {
    const aisle_route *route = self->route;
    if (self->config.skip_unreachable && self->failed.cause == 0 && route->named != AISLE_ROUTE_NONE &&
        aisle_mission_is_out_of_reach(route->cause.cause)) {
        (void)aisle_mission_set_aside(&self->mission, &route->request, route->named);
    }
}

static void end_route(aisle_planner *self) {
    aisle_route *route = self->route;
    self->planning = false;
    count_route(self);
    const aisle_proof *answer = aisle_route_answer(route);
    if (route->request.is_query && answer != NULL) {
        aisle_planner_reply(self, answer);
    } else if (route->request.is_query) {
        aisle_planner_refuse(self, &route->request, &route->cause, route->told, route->told_count, route->spent);
    } else if (answer == NULL) {
        aisle_planner_take_failure(self, &route->request, &route->cause, route->told, route->told_count, route->spent);
        skip_unreachable(self);
    } else if (!answer->told) {
        aisle_planner_take_plan(self, &route->request, answer);
    }
}

static void step_route(aisle_planner *self, uint32_t units) {
    if (is_stale(self, &self->route->request)) {
        self->planning = false;
        count_route(self);
        return;
    }
    const uint32_t before = self->route->spent;
    aisle_status st = aisle_route_step(self->route, units);
    self->counters[AISLE_COUNTER_WORK_UNITS] += self->route->spent - before;
    if (st == AISLE_OK) {
        end_route(self);
    } else if (st == AISLE_PARTIAL && !self->route->request.is_query && !self->leaving.under_way) {
        aisle_planner_take_plan(self, &self->route->request, &self->route->best);
    }
}

// Builds the layout, then holds the answers remembered against it.
static void step_layout(aisle_planner *self, uint32_t units) {
    if (!aisle_layout_is_in_force(self->layout)) {
        if (aisle_layout_build(self->layout, units / LAYOUT_ROW + 1U) == AISLE_OK) {
            aisle_route_layout_changed(self->route, self->layout);
        }
    } else if (aisle_route_step_change(self->route, units) == AISLE_OK) {
        count_cache(self);
        self->building = false;
        self->counters[AISLE_COUNTER_LAYOUTS]++;
        self->counters[AISLE_COUNTER_LAYOUT_WORK] += aisle_layout_work(self->layout);
        self->drive.must_change = true; // what goes on is proved on this layout
        self->cycle_wanted = true;
        aisle_mission_reconsider(&self->mission);
        aisle_planner_replan(self);
    }
}

// ---- public

static bool events_wait(const aisle_planner *self) {
    return self->out[0].waiting || self->out[1].waiting || self->arm->waiting;
}

aisle_status aisle_planner_step(aisle_planner *self, int64_t now_us, uint32_t work_units) {
    if (now_us > self->now_us) {
        self->now_us = now_us;
    }
    if (events_wait(self)) {
        return AISLE_BUSY;
    }
    if (self->building) {
        step_layout(self, work_units);
    } else if (aisle_planner_cycle_is_due(self)) {
        aisle_planner_step_cycle(self, work_units);
    } else if (self->weighing != AISLE_WEIGHING_NOTHING) {
        aisle_planner_step_weighing(self, work_units);
    } else if (self->planning) {
        step_route(self, work_units);
    } else if (self->arm->planning) {
        aisle_planner_arm_step(self, work_units);
    } else if (self->queue_count > 0U || self->mission.replan) {
        begin_next(self);
    }
    const bool busy = aisle_planner_is_busy(self) || aisle_planner_cycle_is_due(self) || events_wait(self);
    return busy ? AISLE_BUSY : AISLE_OK;
}

bool aisle_planner_next_event(aisle_planner *self, aisle_event *event) {
    for (int kind = 0; kind < 2; kind++) {
        aisle_outgoing *out = &self->out[kind];
        if (out->waiting) {
            out->waiting = false;
            aisle_status st =
                aisle_release((aisle_event_kind)kind, out->bytes, out->size, out->stamp, out->moving, event);
            AISLE_ASSERT(st == AISLE_OK);
            return true;
        }
    }
    return aisle_planner_arm_event(self, event);
}

int64_t aisle_planner_next_deadline(const aisle_planner *self) {
    return self->building ? INT64_MAX : aisle_planner_cycle_deadline(self);
}

const int64_t *aisle_planner_counters(const aisle_planner *self) {
    return self->counters;
}
