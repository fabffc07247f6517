#include "algo/near.h"

#include "base/check.h"

#include <string.h>

#define SLACK (1.0 + 1e-9) // of squares that are compared: what rounding may have taken off a distance
#define LEAN_NUMERATOR 7U  // a child with more than 7 / 10 of what its parent holds: out of balance
#define LEAN_DENOMINATOR 10U
#define LEAST (AISLE_NEAR_BUCKET / 2U) // configurations in a leaf that was split off

_Static_assert(AISLE_NEAR_BUCKET >= 4U, "leaves that are split hold something");

static uint32_t nodes_for(uint32_t capacity) {
    return 2U * (capacity / LEAST) + 1U;
}

void aisle_near_carve(aisle_near *self, aisle_arena *arena, uint32_t capacity, uint32_t dim) {
    AISLE_ASSERT(capacity >= 1U && capacity <= AISLE_NEAR_CAPACITY_MAX && dim <= AISLE_CSPACE_DIM_MAX);
    self->capacity = capacity;
    self->node_capacity = nodes_for(capacity);
    self->q = (double *)aisle_arena_take(arena, (size_t)capacity * dim, sizeof(double));
    self->next = (uint32_t *)aisle_arena_take(arena, capacity, sizeof(uint32_t));
    self->work = (uint32_t *)aisle_arena_take(arena, capacity, sizeof(uint32_t));
    self->node = (aisle_near_node *)aisle_arena_take(arena, self->node_capacity, sizeof(aisle_near_node));
    self->box = (double *)aisle_arena_take(arena, (size_t)self->node_capacity * 2U * dim, sizeof(double));
}

// ---- nodes

static double *box_of(const aisle_near *self, uint32_t n) {
    return self->box + (size_t)n * 2U * self->space->dim;
}

static bool is_leaf(const aisle_near_node *node) {
    return node->second == AISLE_NEAR_NONE;
}

static uint32_t take_node(aisle_near *self) {
    uint32_t n = self->spare;
    if (n != AISLE_NEAR_NONE) {
        self->spare = self->node[n].first;
    } else {
        AISLE_ASSERT(self->nodes < self->node_capacity); // leaves hold LEAST or more
        n = self->nodes++;
    }
    return n;
}

static void give_node(aisle_near *self, uint32_t n) {
    self->node[n].first = self->spare;
    self->spare = n;
}

static void empty_leaf(aisle_near *self, uint32_t n) {
    double *box = box_of(self, n);
    self->node[n] = (aisle_near_node){.first = AISLE_NEAR_NONE, .second = AISLE_NEAR_NONE};
    for (uint32_t d = 0; d < self->space->dim; d++) {
        box[2U * d] = (double)INFINITY;
        box[2U * d + 1U] = -(double)INFINITY;
    }
}

void aisle_near_begin(aisle_near *self, const aisle_cspace *space) {
    AISLE_ASSERT(space->dim >= 1U && space->dim <= AISLE_CSPACE_DIM_MAX);
    self->space = space;
    self->count = 0;
    self->nodes = 1;
    self->spare = AISLE_NEAR_NONE;
    self->rebuilt = self->depth = 0;
    empty_leaf(self, 0);
}

static void widen(const aisle_near *self, uint32_t n, const double *q) {
    double *box = box_of(self, n);
    for (uint32_t d = 0; d < self->space->dim; d++) {
        box[2U * d] = q[d] < box[2U * d] ? q[d] : box[2U * d];
        box[2U * d + 1U] = q[d] > box[2U * d + 1U] ? q[d] : box[2U * d + 1U];
    }
}

static void hang(aisle_near *self, uint32_t n, uint32_t index) {
    self->next[index] = self->node[n].first;
    self->node[n].first = index;
    self->node[n].count++;
    widen(self, n, aisle_near_at(self, index));
}

// The coordinate in which a box is widest, by the metric's weights; a box without any width: dim.
static uint32_t widest(const aisle_near *self, uint32_t n) {
    const double *box = box_of(self, n);
    uint32_t axis = self->space->dim;
    double most = 0.0;
    for (uint32_t d = 0; d < self->space->dim; d++) {
        const double width = (box[2U * d + 1U] - box[2U * d]) * (self->space->weight[d] + 1e-12);
        if (width > most) {
            most = width;
            axis = d;
        }
    }
    return axis;
}

// ---- building anew

// Order of configurations along an axis: no two are alike.
static bool comes_before(const aisle_near *self, uint32_t axis, uint32_t a, uint32_t b) {
    const double qa = aisle_near_at(self, a)[axis], qb = aisle_near_at(self, b)[axis];
    return qa < qb || (!(qb < qa) && a < b);
}

static void swap(uint32_t *a, uint32_t *b) {
    const uint32_t kept = *a;
    *a = *b;
    *b = kept;
}

// Puts the middle one of three first.
static void pivot_first(const aisle_near *self, uint32_t axis, uint32_t *w, uint32_t n) {
    uint32_t *a = &w[0], *b = &w[n / 2U], *c = &w[n - 1U];
    if (comes_before(self, axis, *b, *a)) {
        swap(a, b);
    }
    if (comes_before(self, axis, *c, *b)) {
        swap(b, c);
    }
    if (comes_before(self, axis, *b, *a)) {
        swap(a, b);
    }
    swap(a, b);
}

// Quickselect (Hoare 1961): the first `middle` of w[0..n) come before all others.
static void halve(const aisle_near *self, uint32_t axis, uint32_t *w, uint32_t n, uint32_t middle) {
    while (n > 1U) {
        uint32_t less = 0;
        pivot_first(self, axis, w, n);
        for (uint32_t i = 1; i < n; i++) {
            if (comes_before(self, axis, w[i], w[0])) {
                swap(&w[++less], &w[i]);
            }
        }
        swap(&w[0], &w[less]);
        if (middle == less || middle == less + 1U) {
            return;
        }
        if (middle < less) {
            n = less;
        } else {
            w += less + 1U;
            n -= less + 1U;
            middle -= less + 1U;
        }
    }
}

typedef struct part { // configurations work[from..end) that become the tree below a node
    uint32_t node, from, end;
} part;

static uint32_t log2_of(uint32_t n) {
    uint32_t log = 0;
    while (n > 1U) {
        n /= 2U;
        log++;
    }
    return log;
}

// Makes one node of its part. True: an inner one, whose children's parts are out[2].
static bool make_node(aisle_near *self, part p, part *out) {
    empty_leaf(self, p.node);
    for (uint32_t i = p.from; i < p.end; i++) {
        widen(self, p.node, aisle_near_at(self, self->work[i]));
    }
    const uint32_t n = p.end - p.from;
    const uint32_t axis = widest(self, p.node);
    if (n <= AISLE_NEAR_BUCKET || axis == self->space->dim) {
        for (uint32_t i = p.from; i < p.end; i++) {
            hang(self, p.node, self->work[i]);
        }
        return false;
    }
    halve(self, axis, self->work + p.from, n, n / 2U);
    double split =
        -(double)INFINITY; // the greatest of the lower half; what is put in later and as great goes there, too
    for (uint32_t i = p.from; i < p.from + n / 2U; i++) {
        const double at = aisle_near_at(self, self->work[i])[axis];
        split = at > split ? at : split;
    }
    aisle_near_node *node = &self->node[p.node];
    *node = (aisle_near_node){.count = n, .split = (float)split, .axis = axis};
    node->first = take_node(self);
    node->second = take_node(self);
    out[0] = (part){node->first, p.from, p.from + n / 2U};
    out[1] = (part){node->second, p.from + n / 2U, p.end};
    return true;
}

// Builds the tree below a node anew of the configurations in work[0..n).
static void build(aisle_near *self, uint32_t root, uint32_t n) {
    part open[AISLE_NEAR_DEPTH_MAX];
    uint32_t count = 1;
    open[0] = (part){root, 0, n};
    while (count > 0U) {
        part children[2];
        count--;
        if (make_node(self, open[count], children)) {
            AISLE_ASSERT(count + 2U <= AISLE_NEAR_DEPTH_MAX);
            open[count++] = children[0];
            open[count++] = children[1];
        }
    }
}

// All below a node to work[]; the nodes below it are given back.
static uint32_t gather(aisle_near *self, uint32_t root) {
    uint32_t open[AISLE_NEAR_DEPTH_MAX + 1U];
    uint32_t count = 1, n = 0;
    open[0] = root;
    while (count > 0U) {
        const uint32_t at = open[--count];
        const aisle_near_node node = self->node[at];
        if (at != root) {
            give_node(self, at);
        }
        if (is_leaf(&node)) {
            for (uint32_t i = node.first; i != AISLE_NEAR_NONE; i = self->next[i]) {
                self->work[n++] = i;
            }
        } else {
            AISLE_ASSERT(count + 2U <= AISLE_NEAR_DEPTH_MAX + 1U);
            open[count++] = node.first;
            open[count++] = node.second;
        }
    }
    return n;
}

static void rebuild(aisle_near *self, uint32_t root) {
    const uint32_t n = gather(self, root);
    self->rebuilt += n;
    build(self, root, n);
}

// ---- putting in

// A leaf at the end of path[0..depth] became too full. Split, or, where that makes the tree too deep, the lowest node
// above that leans is built anew.
static void split_leaf(aisle_near *self, const uint32_t *path, uint32_t depth) {
    const uint32_t leaf = path[depth];
    if (depth + 1U <= 2U * log2_of(self->count) + 1U) {
        self->depth = depth + 1U > self->depth ? depth + 1U : self->depth;
        build(self, leaf, gather(self, leaf));
        return;
    }
    for (uint32_t i = depth; i-- > 0U;) {
        const uint64_t below = self->node[path[i + 1U]].count;
        if (below * LEAN_DENOMINATOR > (uint64_t)self->node[path[i]].count * LEAN_NUMERATOR) {
            rebuild(self, path[i]);
            return;
        }
    }
    AISLE_ASSERT(false); // a tree in which none leans is not as deep
}

uint32_t aisle_near_add(aisle_near *self, const double *q) {
    uint32_t path[AISLE_NEAR_DEPTH_MAX];
    if (self->count >= self->capacity) {
        return AISLE_NEAR_NONE;
    }
    const uint32_t index = self->count++;
    memcpy(self->q + (size_t)index * self->space->dim, q, self->space->dim * sizeof *q);
    uint32_t n = 0, depth = 0;
    path[0] = 0;
    while (!is_leaf(&self->node[n])) {
        aisle_near_node *node = &self->node[n];
        node->count++;
        widen(self, n, q);
        n = q[node->axis] <= (double)node->split ? node->first : node->second;
        depth++;
        AISLE_ASSERT(depth < AISLE_NEAR_DEPTH_MAX);
        path[depth] = n;
    }
    hang(self, n, index);
    if (self->node[n].count > AISLE_NEAR_BUCKET && widest(self, n) < self->space->dim) {
        split_leaf(self, path, depth);
    }
    return index;
}

// ---- finding

typedef struct query {
    const aisle_near *self;
    const double *q;
    uint32_t k, count;
    uint32_t *found;
    double *distance;
    double worst, worst_squared; // no farther one is wanted
} query;

// Never above the squared distance to anything in the box.
static double box_squared(const aisle_near *self, uint32_t n, const double *q) {
    const aisle_cspace *space = self->space;
    const double *box = box_of(self, n);
    double sum = 0.0;
    for (uint32_t d = 0; d < space->dim; d++) {
        const double low = box[2U * d], high = box[2U * d + 1U], period = space->period[d];
        double off = 0.0;
        if (q[d] < low) {
            off = low - q[d];
            off = period > 0.0 && q[d] + period - high < off ? q[d] + period - high : off;
        } else if (q[d] > high) {
            off = q[d] - high;
            off = period > 0.0 && low + period - q[d] < off ? low + period - q[d] : off;
        }
        off *= space->weight[d];
        sum += off * off;
    }
    return sum;
}

static void offer(query *self, uint32_t index, double distance) {
    uint32_t at = self->count < self->k ? self->count++ : self->k - 1U;
    while (at > 0U && (distance < self->distance[at - 1U] ||
                       (!(distance > self->distance[at - 1U]) && index < self->found[at - 1U]))) {
        self->distance[at] = self->distance[at - 1U];
        self->found[at] = self->found[at - 1U];
        at--;
    }
    self->distance[at] = distance;
    self->found[at] = index;
    if (self->count == self->k) {
        self->worst = self->distance[self->k - 1U];
        self->worst_squared = self->worst * self->worst * SLACK;
    }
}

static bool is_wanted(const query *self, uint32_t index, double distance) {
    if (distance > self->worst) {
        return false;
    }
    return self->count < self->k || distance < self->worst || index < self->found[self->k - 1U];
}

static void look_through(query *self, uint32_t leaf) {
    const aisle_near *near = self->self;
    for (uint32_t i = near->node[leaf].first; i != AISLE_NEAR_NONE; i = near->next[i]) {
        const double *p = aisle_near_at(near, i);
        const double least = aisle_cspace_least_squared(near->space, p, self->q);
        if (least > self->worst_squared) {
            continue;
        }
        const double distance =
            near->space->distance != NULL ? near->space->distance(near->space->context, p, self->q) : sqrt(least);
        if (is_wanted(self, i, distance)) {
            offer(self, i, distance);
        }
    }
}

// Depth first, the nearer child first.
static void search(query *self) {
    const aisle_near *near = self->self;
    struct {
        uint32_t node;
        double squared;
    } open[AISLE_NEAR_DEPTH_MAX + 1U];
    uint32_t count = 1;
    open[0].node = 0;
    open[0].squared = 0.0;
    while (count > 0U) {
        count--;
        const uint32_t at = open[count].node;
        if (open[count].squared > self->worst_squared) {
            continue;
        }
        const aisle_near_node *node = &near->node[at];
        if (is_leaf(node)) {
            look_through(self, at);
            continue;
        }
        const double first = box_squared(near, node->first, self->q), second = box_squared(near, node->second, self->q);
        const bool nearer = first <= second;
        AISLE_ASSERT(count + 2U <= AISLE_NEAR_DEPTH_MAX + 1U);
        open[count].node = nearer ? node->second : node->first;
        open[count++].squared = nearer ? second : first;
        open[count].node = nearer ? node->first : node->second;
        open[count++].squared = nearer ? first : second;
    }
}

uint32_t aisle_near_find(const aisle_near *self, const double *q, uint32_t k, double radius, uint32_t *found,
                         double *distance) {
    AISLE_ASSERT(k >= 1U);
    query wanted = {.self = self, .q = q, .k = k, .found = found, .distance = distance, .worst = radius};
    wanted.worst_squared = radius * radius * SLACK;
    search(&wanted);
    return wanted.count;
}

uint32_t aisle_near_nearest(const aisle_near *self, const double *q, double *distance) {
    uint32_t found;
    double how_far;
    if (aisle_near_find(self, q, 1U, (double)INFINITY, &found, &how_far) == 0U) {
        return AISLE_NEAR_NONE;
    }
    if (distance != NULL) {
        *distance = how_far;
    }
    return found;
}

// ---- invariants

static bool is_inside(const aisle_near *self, uint32_t n, const double *q) {
    const double *box = box_of(self, n);
    for (uint32_t d = 0; d < self->space->dim; d++) {
        if (!(box[2U * d] <= q[d] && q[d] <= box[2U * d + 1U])) {
            return false;
        }
    }
    return true;
}

// Configurations of a leaf, if they are in its box; else more than there are.
static uint32_t count_leaf(const aisle_near *self, uint32_t n) {
    uint32_t count = 0;
    for (uint32_t i = self->node[n].first; i != AISLE_NEAR_NONE && count <= self->count; i = self->next[i]) {
        if (i >= self->count || !is_inside(self, n, aisle_near_at(self, i))) {
            return self->count + 1U;
        }
        count++;
    }
    return count;
}

static bool holds_child(const aisle_near *self, uint32_t n, uint32_t child) {
    const double *box = box_of(self, child);
    double corner[AISLE_CSPACE_DIM_MAX];
    for (uint32_t side = 0; side < 2U; side++) {
        for (uint32_t d = 0; d < self->space->dim; d++) {
            corner[d] = box[2U * d + side];
        }
        if (!is_inside(self, n, corner)) {
            return false;
        }
    }
    return true;
}

bool aisle_near_invariants_hold(const aisle_near *self) {
    uint32_t open[AISLE_NEAR_DEPTH_MAX + 1U];
    uint32_t count = 1, sum = 0;
    open[0] = 0;
    while (count > 0U) {
        const uint32_t n = open[--count];
        const aisle_near_node *node = &self->node[n];
        if (is_leaf(node)) {
            if (count_leaf(self, n) != node->count) {
                return false;
            }
            sum += node->count;
            continue;
        }
        if (node->first >= self->nodes || node->second >= self->nodes || count + 2U > AISLE_NEAR_DEPTH_MAX + 1U ||
            self->node[node->first].count + self->node[node->second].count != node->count ||
            !holds_child(self, n, node->first) || !holds_child(self, n, node->second)) {
            return false;
        }
        open[count++] = node->first;
        open[count++] = node->second;
    }
    return sum == self->count;
}
