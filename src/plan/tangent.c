#include "plan/tangent_parts.h"

#include "base/angle.h"
#include "base/check.h"

#include <math.h>
#include <string.h>

#define NODE_QUARTERS 4U       // of a work unit, for a node that comes up
#define EXPANSION_QUARTERS 16U // for one that is expanded, beside what it looks at

static uint32_t or_default(uint32_t value, uint32_t fallback) {
    return value == 0U ? fallback : value;
}

void aisle_tangent_carve(aisle_tangent *self, aisle_arena *arena, const aisle_limits *limits) {
    uint32_t cells = or_default(limits->cells, AISLE_LIMITS_CELLS_DEFAULT);
    uint32_t rects = cells / 64U < AISLE_LAYOUT_RECTS_MAX ? cells / 64U : AISLE_LAYOUT_RECTS_MAX;
    self->blocks = or_default(limits->polygons, AISLE_LIMITS_POLYGONS_DEFAULT) + rects;
    self->corners = or_default(limits->vertices, AISLE_LIMITS_VERTICES_DEFAULT) + 4U * rects;
    self->capacity = (uint32_t)aisle_clamp((double)cells / 64.0, 1024.0, (double)AISLE_TANGENT_NODES_MAX);
    self->nodes = (aisle_tangent_node *)aisle_arena_take(arena, self->capacity, sizeof(aisle_tangent_node));
    self->expanded = (uint32_t *)aisle_arena_take(arena, 2U * (size_t)self->corners, sizeof(uint32_t));
    self->seen = (uint32_t *)aisle_arena_take(arena, self->blocks, sizeof(uint32_t));
    aisle_heap_carve(&self->open, arena, self->capacity);
}

// ---- geometry

double aisle_arc_length(aisle_circle about, aisle_vec2 from, aisle_vec2 to) {
    double sine = aisle_vec2_cross(from, to);
    double side = about.rho >= 0.0 ? 1.0 : -1.0;
    double angle = aisle_atan2(side * sine, aisle_vec2_dot(from, to));
    return angle > 0.0 ? fabs(about.rho) * angle : 0.0; // below it: rounding, a turn the other way is never asked for
}

uint32_t aisle_tangent_stamp(aisle_tangent *self) {
    return ++self->stamp;
}

// ---- nodes

static uint64_t key_of(double f) { // non-negative doubles are ordered as their bits
    uint64_t key;
    memcpy(&key, &f, sizeof key);
    return key;
}

static double f_of(uint64_t key) {
    double f;
    memcpy(&f, &key, sizeof f);
    return f;
}

// Is there a way to this arrival that is no longer and can do all that this one can?
static bool is_dominated(const aisle_tangent *self, const aisle_tangent_node *node) {
    if (node->corner == AISLE_TANGENT_NONE) {
        return false;
    }
    double side = aisle_node_side(node);
    for (uint32_t i = self->expanded[node->corner]; i != AISLE_TANGENT_NONE; i = self->nodes[i].next) {
        const aisle_tangent_node *other = &self->nodes[i];
        bool is_before = side * aisle_vec2_cross(other->d, node->d) >= -1e-12;
        if (is_before &&
            other->g + aisle_arc_length(aisle_node_circle(node), other->d, node->d) <= node->g + AISLE_TANGENT_TOUCH) {
            return true;
        }
    }
    return false;
}

static bool may_stand(const aisle_tangent *self, aisle_vec2 p) {
    const double touch = AISLE_TANGENT_TOUCH;
    return p.x >= self->allowed.lo.x - touch && p.x <= self->allowed.hi.x + touch &&
           p.y >= self->allowed.lo.y - touch && p.y <= self->allowed.hi.y + touch;
}

// Does the distance field know of contact there? Most corners of a scan lie within reach of others.
static bool is_blocked(const aisle_tangent *self, aisle_vec2 p) {
    return self->without.count == 0U && aisle_grid_gap_upper(aisle_layout_grid(self->layout), p) < self->radius;
}

static void add(aisle_tangent *self, const aisle_tangent_node *node, double f) {
    self->nodes[self->count] = *node;
    aisle_status st = aisle_heap_add(&self->open, self->count, key_of(f));
    AISLE_ASSERT(st == AISLE_OK);
    self->count++;
}

aisle_status aisle_tangent_push(aisle_tangent *self, uint32_t from, const aisle_tangent_node *to, double length) {
    const aisle_tangent_node *parent = &self->nodes[from];
    aisle_vec2 p = aisle_contact(aisle_node_circle(to), to->d);
    if (!may_stand(self, p) || is_blocked(self, p)) {
        return AISLE_OK;
    }
    aisle_tangent_node node = *to;
    node.parent = from;
    node.next = AISLE_TANGENT_NONE;
    node.g = parent->g + length;
    if (parent->corner != AISLE_TANGENT_NONE) {
        node.g += aisle_arc_length(aisle_node_circle(parent), parent->d, to->d);
    }
    if (is_dominated(self, &node)) {
        return AISLE_OK;
    }
    if (self->count == self->capacity) {
        return AISLE_ERR_CAPACITY;
    }
    add(self, &node, node.g + aisle_vec2_distance(p, self->goal));
    return AISLE_OK;
}

// ---- search

static void forget(aisle_tangent *self) {
    uint32_t corners = aisle_layout_corner_count(self->layout);
    uint32_t blocks = aisle_layout_block_count(self->layout);
    AISLE_ASSERT(corners <= self->corners && blocks <= self->blocks);
    memset(self->seen, 0, blocks * sizeof(uint32_t));
    memset(self->expanded, 0xFF, 2U * (size_t)corners * sizeof(uint32_t));
    aisle_heap_forget(&self->open);
    self->stamp = 1U;
}

void aisle_tangent_start(aisle_tangent *self, const aisle_layout *layout, double radius, aisle_vec2 start,
                         aisle_vec2 goal) {
    AISLE_ASSERT(radius >= 0.0 && aisle_layout_has_blocks(layout));
    self->layout = layout;
    self->without.count = 0;
    self->radius = radius;
    self->allowed = aisle_aabb_grow(aisle_layout_bounds(layout), -radius);
    self->goal = goal;
    self->count = self->expansions = self->tests = self->quarters = 0U;
    self->found = AISLE_TANGENT_NONE;
    forget(self);
    self->bound = aisle_vec2_distance(start, goal);
    bool ends_free = may_stand(self, start) && may_stand(self, goal) &&
                     aisle_tangent_line_free(self, radius, start, start) &&
                     aisle_tangent_line_free(self, radius, goal, goal);
    if (ends_free) {
        aisle_tangent_node node = {.centre = start,
                                   .corner = AISLE_TANGENT_NONE,
                                   .block = AISLE_TANGENT_NONE,
                                   .parent = AISLE_TANGENT_NONE,
                                   .next = AISLE_TANGENT_NONE};
        add(self, &node, self->bound);
    }
}

void aisle_tangent_leave_out(aisle_tangent *self, const aisle_layout_without *without) {
    AISLE_ASSERT(self->expansions == 0U);
    self->without = *without;
}

bool aisle_tangent_counts(const aisle_tangent *self, uint32_t index, const aisle_layout_block *block) {
    bool is_zone = index < aisle_layout_zone_count(self->layout);
    for (uint32_t i = 0; is_zone && i < self->without.count; i++) {
        if (aisle_layout_zone(self->layout, index)->id == self->without.id[i]) {
            return false;
        }
    }
    return block->is_obstacle;
}

// The line that leads to a node, and the arc before it.
static bool is_way_free(aisle_tangent *self, const aisle_tangent_node *node) {
    if (node->parent == AISLE_TANGENT_NONE) {
        return true;
    }
    const aisle_tangent_node *parent = &self->nodes[node->parent];
    aisle_circle about = aisle_node_circle(parent);
    aisle_vec2 p = aisle_contact(about, node->d);
    aisle_vec2 q = aisle_contact(aisle_node_circle(node), node->d);
    self->tests++;
    return !is_blocked(self, aisle_vec2_lerp(p, q, 0.5)) && aisle_tangent_line_free(self, self->radius, p, q) &&
           (parent->corner == AISLE_TANGENT_NONE ||
            aisle_tangent_arc_free(self, self->radius, parent, parent->d, node->d));
}

static aisle_status settle(aisle_tangent *self, uint32_t item) {
    aisle_tangent_node *node = &self->nodes[item];
    self->quarters += NODE_QUARTERS;
    if (is_dominated(self, node) || !is_way_free(self, node)) {
        return AISLE_BUSY;
    }
    bool is_there = node->corner == AISLE_TANGENT_NONE && aisle_vec2_distance(node->centre, self->goal) < 1e-9;
    if (is_there) { // the goal, or a start that is one
        self->found = item;
        return AISLE_OK;
    }
    if (node->corner != AISLE_TANGENT_NONE) {
        node->next = self->expanded[node->corner];
        self->expanded[node->corner] = item;
    }
    self->expansions++;
    self->quarters += EXPANSION_QUARTERS;
    return aisle_tangent_see(self, item) == AISLE_OK ? AISLE_BUSY : AISLE_ERR_CAPACITY;
}

aisle_status aisle_tangent_step(aisle_tangent *self, uint32_t units, uint32_t *spent) {
    aisle_status st = AISLE_BUSY;
    uint32_t until = units < UINT32_MAX / 8U ? 4U * units : UINT32_MAX / 2U;
    while (st == AISLE_BUSY && self->quarters < until) {
        uint32_t item = aisle_heap_pop(&self->open);
        if (item == AISLE_HEAP_NONE) {
            st = AISLE_PARTIAL;
            break;
        }
        self->bound = aisle_max(self->bound, f_of(self->open.key[item]));
        st = settle(self, item);
    }
    *spent += self->quarters / 4U;
    self->quarters %= 4U; // so that the sum does not depend on the slices
    return st;
}
