#include "plan/manoeuvre.h"

#include "base/angle.h"
#include "plan/manoeuvre_parts.h"
#include "plan/vehicle_space.h"

#define CELLS_A_NODE 64U // of the planning grid, by which the nodes are counted
#define NODES_MIN 1024U

void aisle_manoeuvre_carve(aisle_manoeuvre *self, aisle_arena *arena, const aisle_limits *limits) {
    uint32_t nodes = limits->cells / CELLS_A_NODE;
    nodes = nodes < NODES_MIN ? NODES_MIN : nodes;
    self->node_capacity = nodes > AISLE_MANOEUVRE_NODES ? AISLE_MANOEUVRE_NODES : nodes;
    for (self->slot_capacity = 1; self->slot_capacity < self->node_capacity;) {
        self->slot_capacity *= 2U;
    }
    self->slot_capacity *= 2U;
    aisle_togo_carve(&self->togo, arena, limits->cells);
    self->node = (aisle_manoeuvre_node *)aisle_arena_take(arena, self->node_capacity, sizeof(aisle_manoeuvre_node));
    self->spare = (uint32_t *)aisle_arena_take(arena, self->node_capacity, sizeof(uint32_t));
    aisle_heap_carve(&self->open, arena, self->node_capacity);
    self->slot = (aisle_manoeuvre_slot *)aisle_arena_take(arena, self->slot_capacity, sizeof(aisle_manoeuvre_slot));
    self->target =
        (aisle_manoeuvre_target *)aisle_arena_take(arena, AISLE_MANOEUVRE_TARGETS, sizeof(aisle_manoeuvre_target));
}

void aisle_manoeuvre_carve_way(aisle_manoeuvre *self, aisle_arena *arena) {
    self->move = (aisle_move *)aisle_arena_take(arena, AISLE_MANOEUVRE_CHAIN, sizeof(aisle_move));
    self->near = (float *)aisle_arena_take(arena, AISLE_MANOEUVRE_CHAIN, sizeof(float));
    self->junction = (aisle_pose2 *)aisle_arena_take(arena, AISLE_MANOEUVRE_CHAIN + 1U, sizeof(aisle_pose2));
}

// What is tried, in order.
static const struct attempt {
    double cell;       // m
    uint32_t headings; // in a full turn
    uint32_t most;     // nodes expanded
    uint32_t tree;     // nodes expanded from the goal before; 0: no tree
} attempts[] = {{0.35, 16, 150, 0},
                {0.35, 16, 16000, 256},
                {0.25, 16, 16000, 256},
                {0.1, 32, UINT32_MAX, 256},
                {0.05, 64, UINT32_MAX, 256}};
#define ATTEMPTS (sizeof attempts / sizeof attempts[0])
#define STEP_CELLS 1.5    // length of a step
#define TRAPPED_MOST 300U // nodes expanded where the tree ended by itself: a finer one may come out

static void begin(aisle_manoeuvre *self, const aisle_manoeuvre_request *request) {
    const aisle_vehicle *vehicle = request->space->vehicle;
    self->request = *request;
    self->request.units = request->units > 0U ? request->units : AISLE_MANOEUVRE_UNITS;
    self->rule = aisle_vehicle_space_rule(vehicle);
    self->need = vehicle->margin + 0.5 * AISLE_SPACE_SLACK;
    self->moves = 0;
    self->spent = self->units = 0;
    self->side = 1.0;
}

void aisle_manoeuvre_start(aisle_manoeuvre *self, const aisle_manoeuvre_request *request) {
    begin(self, request);
    aisle_togo_start(&self->togo, request->space->grid, request->reach, aisle_pose_place(request->start),
                     aisle_pose_place(request->goal));
    if (request->dear > 1U) {
        aisle_togo_keep_clear(&self->togo, request->space->vehicle->inner_radius + request->clear, request->dear);
    }
    self->phase = AISLE_MANOEUVRE_FIELD;
}

void aisle_manoeuvre_begin_way(aisle_manoeuvre *self, const aisle_manoeuvre_request *request) {
    begin(self, request);
    self->junction[0] = request->start;
    self->expanded = 0;
    self->phase = AISLE_MANOEUVRE_FOUND;
}

// ---- attempts

static void begin_search(aisle_manoeuvre *self) {
    const aisle_manoeuvre_request *request = &self->request;
    self->phase = AISLE_MANOEUVRE_SEARCH;
    aisle_manoeuvre_begin_open(self, 1.0);
    self->node_count = self->tree_count;
    for (uint32_t i = 0; i < self->target_count; i++) {
        self->target[i].closed = false;
    }
    aisle_manoeuvre_push_roots(self, request->start, request->start_is_free);
    if (request->start_is_free && request->way_count >= 2U) {
        const aisle_vec2 *p = request->way;
        aisle_manoeuvre_push_root(self, request->start, aisle_atan2(p[1].y - p[0].y, p[1].x - p[0].x));
    }
}

static void begin_attempt(aisle_manoeuvre *self, uint32_t attempt) {
    self->attempt = attempt;
    self->cell = attempts[attempt].cell;
    self->step = self->cell * STEP_CELLS;
    self->headings = attempts[attempt].headings;
    self->tree_count = self->node_count = 0;
    self->target_count = self->tree_target;
    self->trapped = self->full = false;
    if (attempts[attempt].tree == 0U) {
        begin_search(self);
        return;
    }
    self->phase = AISLE_MANOEUVRE_TREE;
    aisle_manoeuvre_begin_open(self, -1.0);
    aisle_manoeuvre_push_roots(self, self->request.goal, self->request.goal_is_free);
}

// The tree is as large as it may be: what was expanded becomes targets. Its nodes are the first ones of the pool.
static void end_tree(aisle_manoeuvre *self) {
    self->trapped = self->expanded < attempts[self->attempt].tree;
    self->tree_count = self->node_count;
    begin_search(self);
}

static void grow_tree(aisle_manoeuvre *self) {
    bool ended;
    uint32_t n = aisle_manoeuvre_next(self, attempts[self->attempt].tree, &ended);
    if (ended) {
        end_tree(self);
    } else if (n != AISLE_HEAP_NONE) {
        aisle_manoeuvre_add_target(self, self->node[n].pose, (double)self->node[n].cost, n);
        aisle_manoeuvre_expand(self, n);
    }
}

static void end_attempt(aisle_manoeuvre *self) {
    if (self->attempt + 1U < ATTEMPTS && !(self->full && self->attempt > 2U)) {
        begin_attempt(self, self->attempt + 1U);
    } else {
        self->phase = AISLE_MANOEUVRE_FAILED;
    }
}

static void search_once(aisle_manoeuvre *self) {
    bool last = self->attempt + 1U == ATTEMPTS;
    bool ended;
    uint32_t n =
        aisle_manoeuvre_next(self, self->trapped && !last ? TRAPPED_MOST : attempts[self->attempt].most, &ended);
    if (ended) {
        end_attempt(self);
        return;
    }
    if (n == AISLE_HEAP_NONE) {
        return;
    }
    uint32_t to = self->node[n].target;
    if (to < AISLE_MANOEUVRE_TARGETS &&
        (aisle_manoeuvre_is_goal(&self->target[to]) || self->target[to].node != AISLE_HEAP_NONE)) {
        self->phase = aisle_manoeuvre_take_chain(self, n) ? AISLE_MANOEUVRE_SHORTEN : AISLE_MANOEUVRE_FAILED;
        aisle_manoeuvre_begin_shorten(self);
        return;
    }
    aisle_manoeuvre_expand(self, n);
}

// ---- all together

static void step_phase(aisle_manoeuvre *self, uint32_t units) {
    switch (self->phase) {
    case AISLE_MANOEUVRE_FIELD: {
        aisle_status st = aisle_togo_step(&self->togo, units, &self->units);
        if (st == AISLE_OK) {
            aisle_manoeuvre_begin_targets(self);
            self->phase = AISLE_MANOEUVRE_TARGET;
        } else if (st == AISLE_PARTIAL) {
            self->phase = AISLE_MANOEUVRE_FAILED;
        }
        break;
    }
    case AISLE_MANOEUVRE_TARGET:
        if (!aisle_manoeuvre_make_target(self)) {
            self->tree_target = self->target_count;
            begin_attempt(self, 0);
        }
        break;
    case AISLE_MANOEUVRE_TREE:
        grow_tree(self);
        break;
    case AISLE_MANOEUVRE_SEARCH:
        search_once(self);
        break;
    case AISLE_MANOEUVRE_FOUND:
        aisle_manoeuvre_begin_shorten(self);
        self->phase = AISLE_MANOEUVRE_SHORTEN;
        break;
    default:
        if (!aisle_manoeuvre_shorten(self)) {
            self->phase = AISLE_MANOEUVRE_DONE;
        }
        break;
    }
}

aisle_status aisle_manoeuvre_step(aisle_manoeuvre *self, uint32_t units, uint32_t *spent) {
    self->units = 0;
    while (self->phase < AISLE_MANOEUVRE_DONE && self->units < units) {
        self->units += self->phase == AISLE_MANOEUVRE_FIELD ? 0U : 1U;
        step_phase(self, units - self->units);
        if (self->phase >= AISLE_MANOEUVRE_TREE && self->phase <= AISLE_MANOEUVRE_SEARCH &&
            self->spent + self->units > self->request.units) {
            self->phase = AISLE_MANOEUVRE_FAILED;
        }
    }
    self->spent += self->units;
    *spent += self->units;
    if (self->phase < AISLE_MANOEUVRE_DONE) {
        return AISLE_BUSY;
    }
    return self->phase == AISLE_MANOEUVRE_DONE ? AISLE_OK : AISLE_PARTIAL;
}
