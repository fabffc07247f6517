#include "algo/rrt.h"

#include "base/check.h"

#define E 2.718281828459045
#define SAME 1e-9      // a new node nearer than that to another is none
#define REJECTED 1000U // samples drawn again at most, by rejection
#define DRIFT 1e-9     // of a cost, that sums may be off

void aisle_rrt_carve(aisle_rrt *self, aisle_arena *arena, uint32_t capacity, uint32_t dim) {
    aisle_near measured;
    aisle_near_carve(self != NULL ? &self->near : &measured, arena, capacity, dim);
    void *node = aisle_arena_take(arena, (size_t)capacity + 1U, sizeof(aisle_rrt_node));
    if (self != NULL) {
        self->capacity = capacity;
        self->node = (aisle_rrt_node *)node;
    }
}

// ---- the tree

static void unhang(aisle_rrt *self, uint32_t n) {
    aisle_rrt_node *node = &self->node[n];
    if (node->parent == AISLE_RRT_NONE) {
        return;
    }
    if (node->sibling_before != AISLE_RRT_NONE) {
        self->node[node->sibling_before].sibling = node->sibling;
    } else {
        self->node[node->parent].child = node->sibling;
    }
    if (node->sibling != AISLE_RRT_NONE) {
        self->node[node->sibling].sibling_before = node->sibling_before;
    }
}

static void hang(aisle_rrt *self, uint32_t n, uint32_t parent, double edge) {
    aisle_rrt_node *node = &self->node[n];
    unhang(self, n);
    node->parent = parent;
    node->edge = edge;
    node->cost = self->node[parent].cost + edge;
    node->sibling_before = AISLE_RRT_NONE;
    node->sibling = self->node[parent].child;
    if (node->sibling != AISLE_RRT_NONE) {
        self->node[node->sibling].sibling_before = n;
    }
    self->node[parent].child = n;
}

// The node after n of those below root, parents before their children; AISLE_RRT_NONE: there is none.
static uint32_t next_below(const aisle_rrt *self, uint32_t root, uint32_t n) {
    if (self->node[n].child != AISLE_RRT_NONE) {
        return self->node[n].child;
    }
    while (n != root && self->node[n].sibling == AISLE_RRT_NONE) {
        n = self->node[n].parent;
    }
    return n == root ? AISLE_RRT_NONE : self->node[n].sibling;
}

// What hangs below a node costs what it costs now.
static void pass_cost_on(aisle_rrt *self, uint32_t root) {
    for (uint32_t n = next_below(self, root, root); n != AISLE_RRT_NONE; n = next_below(self, root, n)) {
        self->node[n].cost = self->node[self->node[n].parent].cost + self->node[n].edge;
    }
}

static uint32_t goal_of(const aisle_rrt *self) {
    return self->capacity;
}

static bool is_reached(const aisle_rrt *self) {
    return self->node[goal_of(self)].parent != AISLE_RRT_NONE;
}

static bool is_free(aisle_rrt *self, const double *a, const double *b) {
    const aisle_cspace *space = self->cfg.space;
    return space->is_free(space->context, a, b, &self->units);
}

// Hangs a node on the earliest one before it from which, and from all between, the motion is free; if that is cheaper.
static void cut_short(aisle_rrt *self, uint32_t n) {
    const aisle_cspace *space = self->cfg.space;
    const double *q = aisle_rrt_at(self, n);
    uint32_t best = AISLE_RRT_NONE;
    double cost = self->node[n].cost * (1.0 - DRIFT), edge = 0.0;
    for (uint32_t p = self->node[self->node[n].parent].parent; p != AISLE_RRT_NONE; p = self->node[p].parent) {
        const double direct = aisle_cspace_cost(space, aisle_rrt_at(self, p), q);
        if (!is_free(self, aisle_rrt_at(self, p), q)) {
            break;
        }
        if (self->node[p].cost + direct < cost) {
            best = p;
            edge = direct;
            cost = self->node[p].cost + direct;
        }
    }
    if (best != AISLE_RRT_NONE) {
        hang(self, n, best, edge);
        pass_cost_on(self, n);
        self->rewired++;
    }
}

// The path, from the goal back.
static void shorten(aisle_rrt *self) {
    for (uint32_t n = goal_of(self); self->node[n].parent != AISLE_RRT_NONE; n = self->node[n].parent) {
        cut_short(self, n);
    }
}

// Hangs the goal on a node through which it is cheaper, if it is near enough.
static void try_goal(aisle_rrt *self, uint32_t n) {
    const aisle_cspace *space = self->cfg.space;
    const double *q = aisle_rrt_at(self, n), *goal = self->cfg.goal;
    const uint32_t g = goal_of(self);
    if (self->node[n].cost + aisle_cspace_bound(space, q, goal) >= self->node[g].cost ||
        aisle_cspace_distance(space, q, goal) > self->cfg.reach) {
        return;
    }
    const double edge = aisle_cspace_cost(space, q, goal);
    if (self->node[n].cost + edge < self->node[g].cost && is_free(self, q, goal)) {
        self->rewired += is_reached(self) ? 1U : 0U;
        hang(self, g, n, edge);
        if (self->cfg.shorten) {
            shorten(self);
        }
        if (self->first_sample == AISLE_RRT_NONE) {
            self->first_sample = self->samples;
            self->first_cost = self->node[g].cost;
        }
    }
}

static bool cfg_is_good(const aisle_rrt_config *cfg) {
    const bool numbers = cfg->step > 0.0 && cfg->goal_bias >= 0.0 && cfg->goal_bias < 1.0 && cfg->reach >= 0.0;
    return cfg->space != NULL && cfg->space->dim >= 1U && cfg->space->dim <= AISLE_CSPACE_DIM_MAX && numbers &&
           cfg->samples >= 1U;
}

aisle_status aisle_rrt_start(aisle_rrt *self, const aisle_rrt_config *cfg) {
    const aisle_rrt_node alone = {0.0, 0.0, AISLE_RRT_NONE, AISLE_RRT_NONE, AISLE_RRT_NONE, AISLE_RRT_NONE};
    if (!cfg_is_good(cfg)) {
        return AISLE_ERR_ARG;
    }
    self->cfg = *cfg;
    self->cfg.reach = cfg->reach > 0.0 ? cfg->reach : cfg->step;
    self->rng = aisle_rng_seed(cfg->seed);
    self->samples = self->kept = self->rewired = self->units = 0;
    self->first_sample = AISLE_RRT_NONE;
    self->first_cost = (double)INFINITY;
    aisle_near_begin(&self->near, cfg->space);
    self->node[0] = self->node[goal_of(self)] = alone;
    self->node[goal_of(self)].cost = (double)INFINITY;
    (void)aisle_near_add(&self->near, cfg->start);
    try_goal(self, 0);
    return AISLE_OK;
}

// ---- a sample

static bool may_run_through(const aisle_rrt *self, const double *q) {
    const aisle_cspace *space = self->cfg.space;
    return aisle_cspace_bound(space, self->cfg.start, q) + aisle_cspace_bound(space, q, self->cfg.goal) <
           aisle_rrt_cost(self);
}

static void draw_any(aisle_rrt *self, double *q) {
    const aisle_cspace *space = self->cfg.space;
    const bool informed = self->cfg.informed && is_reached(self);
    if (informed && space->sample_between != NULL) {
        space->sample_between(space->context, &self->rng, self->cfg.start, self->cfg.goal, aisle_rrt_cost(self), q);
        return;
    }
    uint32_t tries = 0;
    do {
        space->sample(space->context, &self->rng, q);
    } while (informed && !may_run_through(self, q) && ++tries < REJECTED);
}

static void draw(aisle_rrt *self, double *q) {
    const aisle_cspace *space = self->cfg.space;
    if (self->cfg.goal_bias > 0.0 && !is_reached(self) && (double)aisle_rng_float(&self->rng) < self->cfg.goal_bias) {
        for (uint32_t d = 0; d < space->dim; d++) {
            q[d] = self->cfg.goal[d];
        }
        return;
    }
    draw_any(self, q);
    if (self->cfg.retract && space->retract != NULL && self->samples % 2U == 0U && !is_reached(self)) {
        space->retract(space->context, q);
    }
}

// A step from a node towards `to`: q, if the motion there, or what is left of it after halving, is free.
static bool extend(aisle_rrt *self, const double *from, const double *to, double distance, double *q) {
    const aisle_cspace *space = self->cfg.space;
    double part = distance > self->cfg.step ? self->cfg.step / distance : 1.0;
    for (uint32_t halved = 0; halved <= self->cfg.halvings && part * distance > SAME; halved++) {
        space->steer(space->context, from, to, part, q);
        if (is_free(self, from, q)) {
            self->kept += halved > 0U ? 1U : 0U;
            return true;
        }
        part *= 0.5;
    }
    return false;
}

static double logarithm(uint32_t n) { // natural, to a hundredth: it counts neighbours
    double log = 0.0, rest = (double)n;
    for (; rest >= 2.0; rest *= 0.5) {
        log += 0.6931471805599453;
    }
    const double y = (rest - 1.0) / (rest + 1.0); // ln x = 2 (y + y^3 / 3 + ...)
    return log + 2.0 * y * (1.0 + y * y / 3.0);
}

static uint32_t neighbours_of(const aisle_rrt *self) {
    const double k = floor(E * (1.0 + 1.0 / self->cfg.space->dim) * logarithm(self->near.count + 1U)) + 1.0;
    return k < (double)AISLE_RRT_NEIGHBOURS ? (uint32_t)k : AISLE_RRT_NEIGHBOURS;
}

// The neighbour through which q is cheapest of those from which the motion is free; `nearest` is one of them. Its motion's
// cost is *edge.
static uint32_t best_parent(aisle_rrt *self, const double *q, uint32_t count, uint32_t nearest, double *edge) {
    const aisle_cspace *space = self->cfg.space;
    uint32_t parent = nearest;
    *edge = aisle_cspace_cost(space, aisle_rrt_at(self, nearest), q);
    double least = self->node[nearest].cost + *edge;
    for (uint32_t i = 0; i < count; i++) {
        self->through[i] =
            self->node[self->found[i]].cost +
            (space->cost != NULL ? aisle_cspace_cost(space, aisle_rrt_at(self, self->found[i]), q) : self->distance[i]);
    }
    for (;;) { // cheapest first, until one is free
        uint32_t best = count;
        for (uint32_t i = 0; i < count; i++) {
            best = self->through[i] < (best < count ? self->through[best] : least) ? i : best;
        }
        if (best == count) {
            return parent;
        }
        const uint32_t n = self->found[best];
        if (is_free(self, aisle_rrt_at(self, n), q)) {
            *edge = self->through[best] - self->node[n].cost;
            return n;
        }
        self->through[best] = (double)INFINITY;
    }
}

// Neighbours that are cheaper through n are hung on it.
static void rewire(aisle_rrt *self, uint32_t n, uint32_t count) {
    const aisle_cspace *space = self->cfg.space;
    const double *q = aisle_rrt_at(self, n);
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t to = self->found[i];
        const double known = space->cost != NULL ? 0.0 : self->distance[i];
        if (self->node[n].cost + known >= self->node[to].cost) {
            continue;
        }
        const double edge = space->cost != NULL ? aisle_cspace_cost(space, q, aisle_rrt_at(self, to)) : known;
        if (self->node[n].cost + edge < self->node[to].cost * (1.0 - DRIFT) &&
            is_free(self, q, aisle_rrt_at(self, to))) {
            hang(self, to, n, edge);
            pass_cost_on(self, to);
            self->rewired++;
        }
    }
}

static void add(aisle_rrt *self, const double *q, uint32_t parent, double edge) {
    const uint32_t n = aisle_near_add(&self->near, q);
    AISLE_ASSERT(n != AISLE_NEAR_NONE && n < self->capacity); // step() looks before
    self->node[n].parent = AISLE_RRT_NONE;
    self->node[n].child = AISLE_RRT_NONE;
    hang(self, n, parent, edge);
}

static void add_to_star(aisle_rrt *self, const double *q, uint32_t nearest) {
    const aisle_cspace *space = self->cfg.space;
    const uint32_t count =
        aisle_near_find(&self->near, q, neighbours_of(self), (double)INFINITY, self->found, self->distance);
    double edge;
    if (count > 0U && self->distance[0] <= SAME) {
        return;
    }
    const uint32_t parent = best_parent(self, q, count, nearest, &edge);
    if (self->cfg.informed &&
        self->node[parent].cost + edge + aisle_cspace_bound(space, q, self->cfg.goal) >= aisle_rrt_cost(self)) {
        return; // no cheaper path runs through it
    }
    const uint32_t n = self->near.count;
    add(self, q, parent, edge);
    rewire(self, n, count);
    try_goal(self, n);
}

static void sample(aisle_rrt *self) {
    double drawn[AISLE_CSPACE_DIM_MAX], q[AISLE_CSPACE_DIM_MAX], distance;
    self->samples++;
    self->units++;
    draw(self, drawn);
    const uint32_t nearest = aisle_near_nearest(&self->near, drawn, &distance);
    if (distance <= SAME || (self->cfg.whole_steps && distance < self->cfg.step) ||
        !extend(self, aisle_rrt_at(self, nearest), drawn, distance, q)) {
        return;
    }
    if (self->cfg.star) {
        add_to_star(self, q, nearest);
    } else {
        const uint32_t n = self->near.count;
        add(self, q, nearest, aisle_cspace_cost(self->cfg.space, aisle_rrt_at(self, nearest), q));
        try_goal(self, n);
    }
}

// ---- all together

static bool has_ended(const aisle_rrt *self) {
    const aisle_rrt_config *cfg = &self->cfg;
    if (is_reached(self) &&
        (!cfg->star || aisle_rrt_cost(self) <= aisle_cspace_bound(cfg->space, cfg->start, cfg->goal) * (1.0 + DRIFT))) {
        return true;
    }
    const bool drawn =
        is_reached(self) ? self->samples - self->first_sample >= cfg->more : self->samples >= cfg->samples;
    return drawn || self->near.count >= self->capacity;
}

aisle_status aisle_rrt_step(aisle_rrt *self, uint32_t units, uint32_t *spent) {
    while (!has_ended(self) && self->units < units) {
        sample(self);
    }
    *spent += self->units;
    self->units = 0;
    if (!has_ended(self)) {
        return AISLE_BUSY;
    }
    return is_reached(self) ? AISLE_OK : AISLE_PARTIAL;
}

uint32_t aisle_rrt_path(const aisle_rrt *self, uint32_t *nodes, uint32_t most) {
    uint32_t count = 0;
    if (!is_reached(self)) {
        return 0;
    }
    for (uint32_t n = goal_of(self); n != AISLE_RRT_NONE; n = self->node[n].parent) {
        count++;
    }
    uint32_t at = count;
    for (uint32_t n = goal_of(self); count <= most && n != AISLE_RRT_NONE; n = self->node[n].parent) {
        nodes[--at] = n;
    }
    return count;
}

// Do its children know it as their parent, and cost what it costs and their motions?
static bool children_agree(const aisle_rrt *self, uint32_t n, uint32_t *seen) {
    uint32_t before = AISLE_RRT_NONE;
    for (uint32_t c = self->node[n].child; c != AISLE_RRT_NONE; c = self->node[c].sibling) {
        const aisle_rrt_node *child = &self->node[c];
        const double cost = self->node[n].cost + child->edge;
        const bool known = c < self->near.count || c == goal_of(self);
        if (!known || *seen > self->near.count + 1U || child->parent != n || child->sibling_before != before ||
            fabs(child->cost - cost) > DRIFT * cost) {
            return false;
        }
        before = c;
        *seen += 1U;
    }
    return true;
}

bool aisle_rrt_invariants_hold(const aisle_rrt *self) {
    uint32_t seen = 1;
    for (uint32_t n = 0; n < self->near.count; n++) {
        if (!children_agree(self, n, &seen)) {
            return false;
        }
    }
    return seen == self->near.count + (is_reached(self) ? 1U : 0U) &&
           self->node[goal_of(self)].child == AISLE_RRT_NONE && aisle_near_invariants_hold(&self->near);
}
