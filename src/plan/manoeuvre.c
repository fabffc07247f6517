#include "plan/manoeuvre.h"

#include "base/angle.h"
#include "base/check.h"
#include "plan/manoeuvre_parts.h"
#include "plan/zones.h"

#include <math.h>
#include <string.h>

#define CUSP 1.0           // m, cost of a change between forwards and backwards
#define TURN_START 0.3     // m, of a turn on the spot
#define TURN_RATE 0.3      // m a rad, and of each rad of it
#define STEP_OPEN 2.0      // m, longest step
#define OPEN_IN_CELL 2U    // nodes waiting in one cell, more only if they are cheaper
#define LINK_FAR 12.0      // m
#define LINKS_EACH 3U      // ways of steer.h that are pushed for a target
#define LINKS_PATIENCE 60U // links that fail, for each of which one more node goes without
#define LINKS_PAUSE_MAX 10U
#define KEY_SCALE 4096.0 // of f, to a heap's key
#define LEVELS 4
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
    self->move = (aisle_move *)aisle_arena_take(arena, AISLE_MANOEUVRE_CHAIN, sizeof(aisle_move));
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

static double curvature_max(const aisle_manoeuvre *self) {
    return self->request.space->vehicle->curvature_max;
}

void aisle_manoeuvre_start(aisle_manoeuvre *self, const aisle_manoeuvre_request *request) {
    const aisle_vehicle *vehicle = request->space->vehicle;
    self->request = *request;
    // Not the tightest arc: the verifier reads the curvature as a float.
    double radius = vehicle->curvature_max > 0.0 ? (1.0 + 1e-6) / vehicle->curvature_max : 0.0;
    self->rule = (aisle_steer_rule){.radius_min = radius,
                                    .reverse = AISLE_MANOEUVRE_REVERSE,
                                    .cusp = CUSP,
                                    .turn_start = TURN_START,
                                    .turn_rate = TURN_RATE};
    self->need = vehicle->margin + 0.5 * AISLE_SPACE_SLACK;
    self->moves = 0;
    self->spent = self->units = 0;
    self->side = 1.0;
    aisle_togo_start(&self->togo, request->space->grid, request->reach, aisle_pose_place(request->start),
                     aisle_pose_place(request->goal));
    self->phase = AISLE_MANOEUVRE_FIELD;
}

// ---- tests

bool aisle_manoeuvre_pose_free(aisle_manoeuvre *self, aisle_pose2 pose) {
    const aisle_space *space = self->request.space;
    self->units += 1U;
    double around = aisle_grid_gap_lower(space->grid, aisle_pose_place(pose));
    return around - space->vehicle->outer_radius >= self->need ||
           aisle_space_gap(space, pose, self->need, NULL) >= self->need;
}

// Is it against no DIRECTED zone? What is made from the goal is driven the other way.
static bool obeys(const aisle_manoeuvre *self, const aisle_waypoint_msg *from, const aisle_waypoint_msg *to) {
    const aisle_layout *layout = self->request.space->layout;
    if (self->side > 0.0 || !aisle_zones_any_directed(layout)) {
        return aisle_zones_allow_piece(layout, from, to, NULL);
    }
    aisle_waypoint_msg last = *from;
    last.curvature = -to->curvature;
    return aisle_zones_allow_piece(layout, to, &last, NULL);
}

bool aisle_manoeuvre_moves_free(aisle_manoeuvre *self, aisle_pose2 from, const aisle_move *moves, uint32_t count) {
    aisle_waypoint_msg w[AISLE_MOVE_WAYPOINTS + 1U];
    w[0] = (aisle_waypoint_msg){.x = from.x, .y = from.y, .theta = from.theta};
    for (uint32_t i = 0; i < count; i++) {
        uint32_t n = aisle_move_lay(moves[i], w);
        for (uint32_t k = 1; k <= n; k++) {
            if (!aisle_space_piece_free(self->request.space, &w[k - 1U], &w[k], self->need, &self->units) ||
                !obeys(self, &w[k - 1U], &w[k])) {
                return false;
            }
        }
        w[0] = w[n];
        w[0].flags = 0;
    }
    return true;
}

// ---- cells of configurations

static uint64_t key_of(const aisle_manoeuvre *self, aisle_pose2 pose, int direction) {
    const aisle_lattice *lattice = &self->request.space->grid->lattice;
    double ix = floor((pose.x - lattice->x0) / self->cell);
    double iy = floor((pose.y - lattice->y0) / self->cell);
    double bin = floor(pose.theta * (double)self->headings / (2.0 * AISLE_PI) + 0.5);
    uint64_t heading = (uint64_t)(int64_t)(bin + (double)self->headings) % self->headings; // theta in [-pi, pi]
    uint64_t x = (uint64_t)aisle_clamp(ix, 0.0, 1048575.0), y = (uint64_t)aisle_clamp(iy, 0.0, 1048575.0);
    return (x << 40U | y << 20U | heading << 4U | (uint64_t)(direction + 1) << 1U) + 1U;
}

// The slot of a key, taken if it is new; NULL: the table is full.
static aisle_manoeuvre_slot *slot_of(aisle_manoeuvre *self, uint64_t key) {
    uint32_t mask = self->slot_capacity - 1U;
    uint32_t at = (uint32_t)((key * 0x9E3779B97F4A7C15ULL) >> 40U) & mask;
    while (self->slot[at].key != key) {
        if (self->slot[at].key == 0U) {
            if (self->slots >= self->slot_capacity / 4U * 3U) {
                return NULL;
            }
            self->slots++;
            self->slot[at] = (aisle_manoeuvre_slot){.key = key};
            return &self->slot[at];
        }
        at = (at + 1U) & mask;
    }
    return &self->slot[at];
}

// ---- the open list

static uint32_t take_node(aisle_manoeuvre *self) {
    if (self->spare_count > 0U) {
        return self->spare[--self->spare_count];
    }
    return self->node_count < self->node_capacity ? self->node_count++ : AISLE_HEAP_NONE;
}

static void give_back(aisle_manoeuvre *self, uint32_t n) {
    self->spare[self->spare_count++] = n;
}

static void push(aisle_manoeuvre *self, const aisle_manoeuvre_node *node) {
    double togo = aisle_togo_at(&self->togo, aisle_pose_place(node->pose));
    if (!(togo < (double)INFINITY)) {
        return;
    }
    bool is_step = node->target == AISLE_MANOEUVRE_TARGETS;
    if (is_step) {
        aisle_manoeuvre_slot *slot = slot_of(self, key_of(self, node->pose, node->direction));
        if (slot == NULL || slot->closed || (slot->open >= OPEN_IN_CELL && node->cost >= slot->least)) {
            return;
        }
        slot->least = slot->open == 0U || node->cost < slot->least ? node->cost : slot->least;
        slot->open = slot->open < UINT8_MAX ? (uint8_t)(slot->open + 1U) : UINT8_MAX;
    } else {
        togo = self->target[node->target].togo;
    }
    uint32_t n = take_node(self);
    if (n == AISLE_HEAP_NONE) {
        self->full = true;
        return; // the cheapest are in: it goes on with those
    }
    self->node[n] = *node;
    bool known = !is_step && self->target[node->target].node != AISLE_HEAP_NONE;
    double weight = self->side < 0.0 ? 0.0 : (known ? 1.0 : AISLE_MANOEUVRE_WEIGHT);
    double f = (double)node->cost + weight * togo;
    aisle_status st = aisle_heap_add(&self->open, n, (uint64_t)(f * KEY_SCALE));
    AISLE_ASSERT(st == AISLE_OK);
}

static double cost_of(const aisle_manoeuvre *self, int8_t before, const aisle_move *moves, uint32_t count,
                      int8_t *after) {
    double cost = aisle_steer_cost(&self->rule, moves, count);
    *after = before;
    for (uint32_t i = 0, first = 1; i < count; i++) {
        if (fabs(moves[i].length) > 0.0) {
            *after = moves[i].length < 0.0 ? -1 : 1;
            cost += first != 0U && before * *after < 0 ? CUSP : 0.0;
            first = 0;
        }
    }
    return cost;
}

// A step's end is tested here, its motion when it comes up.
static void push_step(aisle_manoeuvre *self, uint32_t parent, double length, double turn) {
    const aisle_manoeuvre_node *from = &self->node[parent];
    aisle_manoeuvre_node node = {
        .length = (float)length, .turn = (float)turn, .parent = parent, .target = AISLE_MANOEUVRE_TARGETS};
    const aisle_move move = {(double)node.length, (double)node.turn};
    const aisle_move driven = {self->side * move.length, self->side * move.turn};
    double cost = cost_of(self, from->direction, &driven, 1, &node.direction);
    if (fabs(length) <= 0.0 && from->target == AISLE_MANOEUVRE_TARGETS && fabs((double)from->length) <= 0.0 &&
        from->parent != AISLE_HEAP_NONE) {
        cost -= TURN_START; // it goes on turning
    }
    node.cost = from->cost + (float)cost;
    node.pose = aisle_move_end(from->pose, move);
    node.pose.theta = aisle_angle_wrap(node.pose.theta);
    if (aisle_manoeuvre_pose_free(self, node.pose)) {
        push(self, &node);
    }
}

// ---- links

static void push_links(aisle_manoeuvre *self, uint32_t parent, uint32_t to) {
    const aisle_manoeuvre_target *target = &self->target[to];
    const aisle_manoeuvre_node *from = &self->node[parent];
    aisle_steer_way ways[AISLE_STEER_WAYS];
    uint32_t count = aisle_steer(&self->rule, from->pose, target->pose, ways);
    double beeline = aisle_vec2_distance(aisle_pose_place(from->pose), aisle_pose_place(target->pose));
    for (uint32_t i = 0; i < count && i < LINKS_EACH; i++) {
        if (ways[i].cost > 4.0 * beeline + 8.0) { // a step or two will find something better
            break;
        }
        aisle_manoeuvre_node node = {.pose = target->pose, .parent = parent, .target = (uint16_t)to, .way = (uint8_t)i};
        double cost = cost_of(self, from->direction, ways[i].move, ways[i].count, &node.direction);
        node.cost = from->cost + (float)cost;
        push(self, &node);
    }
}

// A goal of any heading is taken as one comes to it, forwards or backwards.
static void push_free_goal(aisle_manoeuvre *self, uint32_t parent, uint32_t to) {
    aisle_manoeuvre_target *target = &self->target[to];
    if (self->request.goal_is_free && !(self->rule.radius_min > 0.0)) {
        const aisle_pose2 *from = &self->node[parent].pose;
        double course = aisle_atan2(target->pose.y - from->y, target->pose.x - from->x);
        target->pose.theta = to % 2U == 0U ? course : aisle_angle_wrap(course + AISLE_PI);
        if (!aisle_manoeuvre_pose_free(self, target->pose)) {
            return;
        }
    }
    push_links(self, parent, to);
}

// Of the tree's nodes within reach the nearest, half a metre for a radian, and one in turn.
static void push_tree(aisle_manoeuvre *self, uint32_t parent) {
    const aisle_pose2 *p = &self->node[parent].pose;
    uint32_t nearest = AISLE_MANOEUVRE_TARGETS;
    double least = LINK_FAR;
    uint32_t count = self->target_count - self->tree_target;
    for (uint32_t i = self->tree_target; i < self->target_count; i++) {
        const aisle_pose2 *q = &self->target[i].pose;
        double turn = fabs(aisle_angle_difference(p->theta, q->theta));
        double distance = aisle_vec2_distance(aisle_pose_place(*p), aisle_pose_place(*q)) + 0.5 * turn;
        if (!self->target[i].closed && distance < least) {
            least = distance;
            nearest = i;
        }
    }
    uint32_t turn = self->tree_target + (count > 0U ? self->expanded * 7U % count : 0U);
    if (nearest < AISLE_MANOEUVRE_TARGETS) {
        push_links(self, parent, nearest);
        if (turn != nearest && !self->target[turn].closed) {
            push_links(self, parent, turn);
        }
    }
}

// Of the targets within reach the one nearest to the goal at each of a few distances, and one in turn, so that none that
// always fails is asked for ever.
static void push_targets(aisle_manoeuvre *self, uint32_t parent) {
    static const double level[LEVELS] = {1.5, 3.0, 6.0, LINK_FAR};
    const aisle_vec2 p = aisle_pose_place(self->node[parent].pose);
    double ahead = aisle_togo_at(&self->togo, p) - 0.2;
    uint32_t best[LEVELS + 1] = {AISLE_MANOEUVRE_TARGETS, AISLE_MANOEUVRE_TARGETS, AISLE_MANOEUVRE_TARGETS,
                                 AISLE_MANOEUVRE_TARGETS, AISLE_MANOEUVRE_TARGETS};
    uint32_t turn = self->expanded % (self->tree_target > 0U ? self->tree_target : 1U);
    for (uint32_t i = 0; i < self->tree_target; i++) {
        const aisle_manoeuvre_target *target = &self->target[i];
        double distance = aisle_vec2_distance(p, aisle_pose_place(target->pose));
        if (distance > LINK_FAR || target->closed) {
            continue;
        }
        if (aisle_manoeuvre_is_goal(target)) {
            push_free_goal(self, parent, i);
        } else if (target->togo < ahead) {
            best[LEVELS] = best[LEVELS] == AISLE_MANOEUVRE_TARGETS || i <= turn ? i : best[LEVELS];
            for (int k = 0; k < LEVELS; k++) {
                bool nearer = best[k] == AISLE_MANOEUVRE_TARGETS || target->togo < self->target[best[k]].togo;
                best[k] = distance <= level[k] && nearer ? i : best[k];
            }
        }
    }
    for (int k = 0; k <= LEVELS; k++) {
        bool seen = best[k] == AISLE_MANOEUVRE_TARGETS;
        for (int j = 0; j < k; j++) {
            seen = seen || best[j] == best[k];
        }
        if (!seen) {
            push_links(self, parent, best[k]);
        }
    }
}

// ---- expansion

static void push_arcs(aisle_manoeuvre *self, uint32_t n, double length, double curvature) {
    push_step(self, n, length, curvature * length);
    push_step(self, n, length, -curvature * length);
    push_step(self, n, -length, curvature * length);
    push_step(self, n, -length, -curvature * length);
}

static void push_turns(aisle_manoeuvre *self, uint32_t n) {
    double sector = 2.0 * AISLE_PI / (double)self->headings;
    double at = self->node[n].pose.theta / sector;
    double left = floor(at + 1e-3) + 1.0; // its own heading may be one of them, but for rounding
    double right = -(floor(-at + 1e-3) + 1.0);
    push_step(self, n, 0.0, (left - at) * sector);
    push_step(self, n, 0.0, (right - at) * sector);
}

static void expand(aisle_manoeuvre *self, uint32_t n) {
    const aisle_space *space = self->request.space;
    double around = aisle_grid_gap_lower(space->grid, aisle_pose_place(self->node[n].pose));
    double open = around - space->vehicle->outer_radius - self->need;
    double step = aisle_clamp(open, self->step, STEP_OPEN);
    double sector = 2.0 * AISLE_PI / (double)self->headings;
    self->expanded++;
    push_step(self, n, step, 0.0);
    push_step(self, n, -step, 0.0);
    if (curvature_max(self) > 0.0) {
        double radius = self->rule.radius_min;
        double arc = aisle_max(self->step, sector * radius);
        push_arcs(self, n, arc, 1.0 / radius);
        push_arcs(self, n, arc, 0.5 / radius);
    } else {
        push_arcs(self, n, self->step, sector / self->step);
        push_turns(self, n);
    }
    if (self->side > 0.0 && self->expanded >= self->link_next) {
        uint32_t pause = self->link_fails / LINKS_PATIENCE;
        self->link_next = self->expanded + (pause < LINKS_PAUSE_MAX ? pause : LINKS_PAUSE_MAX);
        push_targets(self, n);
        push_tree(self, n);
    }
}

static void push_root(aisle_manoeuvre *self, aisle_pose2 at, double theta) {
    aisle_manoeuvre_node root = {.pose = at, .parent = AISLE_HEAP_NONE, .target = AISLE_MANOEUVRE_TARGETS};
    root.pose.theta = aisle_angle_wrap(theta);
    if (aisle_manoeuvre_pose_free(self, root.pose)) {
        push(self, &root);
    }
}

static void push_roots(aisle_manoeuvre *self, aisle_pose2 at, bool any_heading) {
    if (!any_heading) {
        push_root(self, at, at.theta);
        return;
    }
    for (uint32_t i = 0; i < self->headings; i++) {
        push_root(self, at, 2.0 * AISLE_PI * (double)i / (double)self->headings);
    }
}

static void begin_open(aisle_manoeuvre *self, double side) {
    self->side = side;
    self->expanded = 0;
    self->link_next = self->link_fails = 0;
    self->slots = 0;
    self->spare_count = 0;
    memset(self->slot, 0, self->slot_capacity * sizeof(aisle_manoeuvre_slot));
    aisle_heap_forget(&self->open);
}

static void begin_search(aisle_manoeuvre *self) {
    const aisle_manoeuvre_request *request = &self->request;
    self->phase = AISLE_MANOEUVRE_SEARCH;
    begin_open(self, 1.0);
    self->node_count = self->tree_count;
    for (uint32_t i = 0; i < self->target_count; i++) {
        self->target[i].closed = false;
    }
    push_roots(self, request->start, request->start_is_free);
    if (request->start_is_free && request->way_count >= 2U) {
        const aisle_vec2 *p = request->way;
        push_root(self, request->start, aisle_atan2(p[1].y - p[0].y, p[1].x - p[0].x));
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
    begin_open(self, -1.0);
    push_roots(self, self->request.goal, self->request.goal_is_free);
}

// ---- what comes up

// The moves from a node's parent to it.
static uint32_t moves_to(const aisle_manoeuvre *self, uint32_t n, aisle_move *moves) {
    const aisle_manoeuvre_node *node = &self->node[n];
    if (node->target == AISLE_MANOEUVRE_TARGETS) {
        moves[0] = (aisle_move){(double)node->length, (double)node->turn};
        return node->parent == AISLE_HEAP_NONE ? 0U : 1U;
    }
    aisle_steer_way ways[AISLE_STEER_WAYS];
    uint32_t count = aisle_steer(&self->rule, self->node[node->parent].pose, node->pose, ways);
    AISLE_ASSERT(node->way < count);
    memcpy(moves, ways[node->way].move, ways[node->way].count * sizeof(aisle_move));
    return ways[node->way].count;
}

static uint32_t depth_of(const aisle_manoeuvre *self, uint32_t n) {
    uint32_t depth = 0;
    while (self->node[n].parent != AISLE_HEAP_NONE) {
        n = self->node[n].parent;
        depth++;
    }
    return depth;
}

// From a node of the tree to the goal: its steps driven the other way, to the end of the chain. Where they begin.
static uint32_t take_tree(aisle_manoeuvre *self, uint32_t n) {
    uint32_t at = AISLE_MANOEUVRE_CHAIN - depth_of(self, n);
    uint32_t first = at;
    self->junction[at] = self->node[n].pose;
    while (self->node[n].parent != AISLE_HEAP_NONE) {
        self->move[at++] = (aisle_move){-(double)self->node[n].length, -(double)self->node[n].turn};
        n = self->node[n].parent;
        self->junction[at] = self->node[n].pose;
    }
    return first;
}

// Takes the chain that ends at n. False: it is too long.
static bool take_chain(aisle_manoeuvre *self, uint32_t n) {
    aisle_move moves[AISLE_REEDS_SHEPP_MOVES];
    uint32_t tree = self->target[self->node[n].target].node;
    if (tree != AISLE_HEAP_NONE && depth_of(self, tree) >= AISLE_MANOEUVRE_CHAIN) {
        return false;
    }
    uint32_t at = AISLE_MANOEUVRE_CHAIN;
    if (tree != AISLE_HEAP_NONE) {
        at = take_tree(self, tree);
    } else {
        self->junction[at] = self->node[n].pose;
    }
    for (; self->node[n].parent != AISLE_HEAP_NONE; n = self->node[n].parent) {
        uint32_t count = moves_to(self, n, moves);
        if (at < count) {
            return false;
        }
        at -= count;
        memcpy(self->move + at, moves, count * sizeof(aisle_move));
        aisle_pose2 p = self->node[self->node[n].parent].pose;
        for (uint32_t i = 0; i < count; i++) { // the last one's end is there already, exactly
            self->junction[at + i] = p;
            p = aisle_move_end(p, moves[i]);
            p.theta = aisle_angle_wrap(p.theta);
        }
    }
    self->moves = AISLE_MANOEUVRE_CHAIN - at;
    memmove(self->move, self->move + at, self->moves * sizeof(aisle_move));
    memmove(self->junction, self->junction + at, (self->moves + 1U) * sizeof(aisle_pose2));
    return true;
}

// Was its cell or target closed by another one; else it is closed by this one if its motion is free.
static bool closes(aisle_manoeuvre *self, uint32_t n) {
    const aisle_manoeuvre_node *node = &self->node[n];
    aisle_move moves[AISLE_REEDS_SHEPP_MOVES];
    bool *closed = NULL;
    if (node->target == AISLE_MANOEUVRE_TARGETS) {
        aisle_manoeuvre_slot *slot = slot_of(self, key_of(self, node->pose, node->direction));
        if (slot == NULL) {
            return false;
        }
        slot->open = slot->open > 0U ? (uint8_t)(slot->open - 1U) : 0U;
        closed = &slot->closed;
    } else {
        closed = &self->target[node->target].closed;
    }
    if (*closed) {
        return false;
    }
    uint32_t count = moves_to(self, n, moves);
    *closed = count == 0U || aisle_manoeuvre_moves_free(self, self->node[node->parent].pose, moves, count);
    if (node->target < AISLE_MANOEUVRE_TARGETS) {
        self->link_fails = *closed ? 0U : self->link_fails + 1U;
    }
    return *closed;
}

// The next node to expand; AISLE_HEAP_NONE: there is none, or this one came to nothing (*ended tells which).
static uint32_t next_node(aisle_manoeuvre *self, uint32_t most, bool *ended) {
    uint32_t n = self->expanded < most ? aisle_heap_pop(&self->open) : AISLE_HEAP_NONE;
    *ended = n == AISLE_HEAP_NONE;
    if (!*ended && !closes(self, n)) {
        give_back(self, n);
        return AISLE_HEAP_NONE;
    }
    return n;
}

// The tree is as large as it may be: what was expanded becomes targets. Its nodes are the first ones of the pool.
static void end_tree(aisle_manoeuvre *self) {
    self->trapped = self->expanded < attempts[self->attempt].tree;
    self->tree_count = self->node_count;
    begin_search(self);
}

static void grow_tree(aisle_manoeuvre *self) {
    bool ended;
    uint32_t n = next_node(self, attempts[self->attempt].tree, &ended);
    if (ended) {
        end_tree(self);
    } else if (n != AISLE_HEAP_NONE) {
        aisle_manoeuvre_add_target(self, self->node[n].pose, (double)self->node[n].cost, n);
        expand(self, n);
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
    uint32_t n = next_node(self, self->trapped && !last ? TRAPPED_MOST : attempts[self->attempt].most, &ended);
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
        self->phase = take_chain(self, n) ? AISLE_MANOEUVRE_SHORTEN : AISLE_MANOEUVRE_FAILED;
        aisle_manoeuvre_begin_shorten(self);
        return;
    }
    expand(self, n);
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
            self->spent + self->units > AISLE_MANOEUVRE_UNITS) {
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

uint32_t aisle_manoeuvre_lay(const aisle_manoeuvre *self, aisle_waypoint_msg *w, uint32_t capacity) {
    aisle_pose2 p = self->junction[0];
    uint32_t n = 1;
    w[0] = (aisle_waypoint_msg){.x = p.x, .y = p.y, .theta = p.theta};
    for (uint32_t i = 0; i < self->moves; i++) {
        if (n + AISLE_MOVE_WAYPOINTS > capacity) {
            return 0;
        }
        aisle_waypoint_msg *from = &w[n - 1U];
        if (i > 0U && self->move[i].length * self->move[i - 1U].length < 0.0) {
            from->flags |= AISLE_WAYPOINT_STOP;
        }
        n += aisle_move_lay(self->move[i], from);
        aisle_pose2 end = self->junction[i + 1U]; // as tested, without what rounding adds up to
        w[n - 1U].x = end.x;
        w[n - 1U].y = end.y;
        w[n - 1U].theta = end.theta;
    }
    return n;
}
