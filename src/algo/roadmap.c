#include "algo/roadmap.h"

#include "base/check.h"

#include <string.h>

#define KIND 3U    // bits of kind[]
#define CAME 4U    // the repair under way made it a node
#define LEFT 8U    // or none
#define STALE 16U  // its list is to be made anew
#define MUTUAL 16U // bit of known[]: the neighbour has the node in its list, too
#define FOUND_MAX (AISLE_ROADMAP_K_MAX + 1U)

_Static_assert(AISLE_ROADMAP_SAMPLES_MAX + 2U <= UINT16_MAX, "nodes are numbered in 16 bits");

void aisle_roadmap_carve(aisle_roadmap *self, aisle_arena *arena, uint32_t dim, uint32_t samples, uint32_t k) {
    AISLE_ASSERT(dim >= 1U && dim <= AISLE_CSPACE_DIM_MAX && samples >= 1U && samples <= AISLE_ROADMAP_SAMPLES_MAX &&
                 k >= 1U && k <= AISLE_ROADMAP_K_MAX);
    *self = (aisle_roadmap){.capacity = samples, .k = k, .dim = dim, .dim_max = dim};
    const size_t rows = (size_t)samples + 2U;
    self->q = (double *)aisle_arena_take(arena, rows * dim, sizeof *self->q);
    self->kind = (uint8_t *)aisle_arena_take(arena, samples, sizeof *self->kind);
    self->degree = (uint8_t *)aisle_arena_take(arena, rows, sizeof *self->degree);
    self->list = (uint16_t *)aisle_arena_take(arena, rows * k, sizeof *self->list);
    self->known = (uint8_t *)aisle_arena_take(arena, rows * k, sizeof *self->known);
    self->from = (uint32_t *)aisle_arena_take(arena, (size_t)samples + 1U, sizeof *self->from);
    self->back = (uint32_t *)aisle_arena_take(arena, (size_t)samples * k, sizeof *self->back);
    self->node_of = (uint16_t *)aisle_arena_take(arena, samples, sizeof *self->node_of);
    aisle_near_carve(&self->near, arena, samples, dim);
}

// ---- nodes, lists, what is known of edges

static double *config_at(const aisle_roadmap *self, uint32_t draw) {
    return self->q + (size_t)draw * self->dim;
}

bool aisle_roadmap_is_node(const aisle_roadmap *self, uint32_t draw) {
    return draw < self->count && (self->kind[draw] & KIND) == (uint8_t)AISLE_ROADMAP_FREE;
}

// Place of b in a's list; AISLE_ROADMAP_NONE: it is not there.
static uint32_t place_of(const aisle_roadmap *self, uint32_t a, uint32_t b) {
    for (uint32_t i = 0; i < self->degree[a]; i++) {
        if (self->list[a * self->k + i] == b) {
            return a * self->k + i;
        }
    }
    return AISLE_ROADMAP_NONE;
}

// A link is a place in list[] and a direction: 2 * place, + 1 against the list, from the neighbour to the list's node.
static uint32_t tail_of(const aisle_roadmap *self, uint32_t link) {
    return (link & 1U) != 0U ? self->list[link / 2U] : link / 2U / self->k;
}

static uint32_t head_of(const aisle_roadmap *self, uint32_t link) {
    return tail_of(self, link ^ 1U);
}

static aisle_roadmap_known known_of(const aisle_roadmap *self, uint32_t link) {
    return (aisle_roadmap_known)(self->known[link / 2U] >> (2U * (link & 1U)) & 3U);
}

// The same as seen from the other end.
static uint32_t turned(uint32_t known) {
    return (known & 3U) << 2U | (known >> 2U & 3U);
}

static void note(aisle_roadmap *self, uint32_t link, aisle_roadmap_known known) {
    const uint32_t shift = 2U * (link & 1U);
    const uint32_t others = self->known[link / 2U] & ~(3U << shift);
    self->known[link / 2U] = (uint8_t)(others | (uint32_t)known << shift);
}

// What was found of a motion, wherever it is kept: by both of its ends, and for both directions if they are alike.
static void note_all(aisle_roadmap *self, uint32_t link, aisle_roadmap_known known) {
    const uint32_t row = link / 2U / self->k, other = self->list[link / 2U];
    const uint32_t mate = row < self->capacity ? place_of(self, other, row) : AISLE_ROADMAP_NONE;
    note(self, link, known);
    if (!self->config.one_way) {
        note(self, link ^ 1U, known);
    }
    if (mate != AISLE_ROADMAP_NONE) {
        self->known[mate] = (uint8_t)(turned(self->known[link / 2U]) | (self->known[mate] & MUTUAL));
    }
}

static bool test(aisle_roadmap *self, uint32_t link, uint32_t *spent) {
    const bool is_free = self->space->is_free(self->space->context, config_at(self, tail_of(self, link)),
                                              config_at(self, head_of(self, link)), spent);
    note_all(self, link, is_free ? AISLE_ROADMAP_FREE : AISLE_ROADMAP_BLOCKED);
    return is_free;
}

aisle_roadmap_known aisle_roadmap_edge(const aisle_roadmap *self, uint32_t a, uint32_t b) {
    uint32_t place = place_of(self, a, b);
    if (place != AISLE_ROADMAP_NONE) {
        return known_of(self, 2U * place);
    }
    place = place_of(self, b, a);
    return place != AISLE_ROADMAP_NONE ? known_of(self, 2U * place + 1U) : AISLE_ROADMAP_BLOCKED;
}

// ---- building

// The last one takes what the others leave, or what there are too few blocks for.
static void cut_blocks(aisle_roadmap *self) {
    const uint32_t samples = self->config.samples;
    uint32_t end = self->config.first > 0U ? self->config.first : samples;
    self->block = self->blocks = 0;
    while (end < samples && self->blocks + 1U < AISLE_ROADMAP_BLOCKS) {
        self->end[self->blocks++] = end;
        end *= 2U;
    }
    self->end[self->blocks++] = samples;
}

aisle_status aisle_roadmap_start(aisle_roadmap *self, const aisle_cspace *space, const aisle_roadmap_config *config) {
    if (config->samples < 1U || config->samples > self->capacity || space->dim > self->dim_max) {
        return AISLE_ERR_ARG;
    }
    self->space = space;
    self->config = *config;
    self->dim = space->dim;
    self->count = self->free_count = 0;
    self->came = self->left = 0;
    self->work = AISLE_ROADMAP_BUILDS;
    self->rng = aisle_rng_seed(config->seed);
    self->edge_tests = self->retested = self->lists_renewed = 0;
    self->phase = AISLE_ROADMAP_DRAW;
    self->at = 0;
    cut_blocks(self);
    return AISLE_OK;
}

aisle_status aisle_roadmap_grow(aisle_roadmap *self, uint32_t samples) {
    if (self->phase != AISLE_ROADMAP_READY || samples <= self->count || samples > self->capacity ||
        self->blocks == AISLE_ROADMAP_BLOCKS) {
        return AISLE_ERR_ARG;
    }
    self->block = self->blocks;
    self->end[self->blocks++] = samples;
    self->config.samples = samples;
    self->work = AISLE_ROADMAP_BUILDS;
    self->phase = AISLE_ROADMAP_DRAW;
    self->at = self->count;
    return AISLE_OK;
}

void aisle_roadmap_repair(aisle_roadmap *self, aisle_roadmap_touch_fn touches, void *context) {
    AISLE_ASSERT(self->phase == AISLE_ROADMAP_READY);
    self->touches = touches;
    self->touch_context = context;
    self->came = self->left = 0;
    self->work = AISLE_ROADMAP_REPAIRS;
    self->phase = AISLE_ROADMAP_TOUCH;
    self->at = 0;
}

static void look_at_draw(aisle_roadmap *self, uint32_t draw, uint32_t *spent) {
    const double *q = config_at(self, draw);
    const bool is_free = self->space->is_free(self->space->context, q, q, spent);
    self->kind[draw] = (uint8_t)(is_free ? AISLE_ROADMAP_FREE : AISLE_ROADMAP_BLOCKED);
    self->free_count += is_free ? 1U : 0U;
}

static void draw_one(aisle_roadmap *self, uint32_t *spent) {
    const aisle_cspace *space = self->space;
    space->sample(space->context, &self->rng, config_at(self, self->at));
    if (self->config.uniform > 0U && self->at >= self->config.uniform && space->retract != NULL) {
        space->retract(space->context, config_at(self, self->at));
    }
    self->degree[self->at] = 0;
    look_at_draw(self, self->at, spent);
    self->count = ++self->at;
}

// Has the draw come or left? Which ones came is listed: nodes near them get other neighbours.
static void touch_draw(aisle_roadmap *self, uint32_t *spent) {
    const uint32_t draw = self->at++;
    const double *q = config_at(self, draw);
    *spent += 1U;
    if (!self->touches(self->touch_context, q, q)) {
        return;
    }
    const bool was_node = aisle_roadmap_is_node(self, draw);
    self->free_count -= was_node ? 1U : 0U;
    self->retested++;
    look_at_draw(self, draw, spent);
    const bool is_node = aisle_roadmap_is_node(self, draw);
    if (is_node && !was_node) {
        self->kind[draw] |= CAME;
        self->node_of[self->came++] = (uint16_t)draw;
    } else if (was_node && !is_node) {
        self->kind[draw] |= LEFT;
        self->left++;
    }
}

static uint32_t end_of_block(const aisle_roadmap *self, uint32_t draw) {
    uint32_t block = 0;
    while (self->end[block] <= draw) {
        block++;
    }
    return self->end[block];
}

// Do draws that came or left change this node's list? Only asked in repairs.
static bool is_list_stale(const aisle_roadmap *self, uint32_t node, uint32_t *spent) {
    const uint16_t *list = self->list + node * self->k;
    const uint32_t degree = self->degree[node];
    if ((self->kind[node] & CAME) != 0U) {
        return true;
    }
    for (uint32_t i = 0; i < degree; i++) {
        if ((self->kind[list[i]] & LEFT) != 0U) {
            return true;
        }
    }
    const double *q = config_at(self, node);
    const double last =
        degree == self->k ? aisle_cspace_distance(self->space, q, config_at(self, list[degree - 1U])) : 0.0;
    const uint32_t end = end_of_block(self, node); // later ones are not in its list
    *spent += self->came / 8U;
    for (uint32_t i = 0; i < self->came && self->node_of[i] < end; i++) { // they came in order
        if (degree < self->k || aisle_cspace_distance(self->space, q, config_at(self, self->node_of[i])) <= last) {
            return true;
        }
    }
    return false;
}

static void judge_list(aisle_roadmap *self, uint32_t *spent) {
    const uint32_t node = self->at++;
    if (aisle_roadmap_is_node(self, node) && is_list_stale(self, node, spent)) {
        self->kind[node] |= STALE;
    }
}

static void index_one(aisle_roadmap *self) {
    const uint32_t draw = self->at++;
    if (draw == 0U) {
        aisle_near_begin(&self->near, self->space);
    }
    if (aisle_roadmap_is_node(self, draw)) {
        const uint32_t index = aisle_near_add(&self->near, config_at(self, draw));
        AISLE_ASSERT(index != AISLE_NEAR_NONE);
        self->node_of[index] = (uint16_t)draw;
    }
}

typedef struct old_list { // a node's list before it was made anew
    uint16_t list[AISLE_ROADMAP_K_MAX];
    uint8_t known[AISLE_ROADMAP_K_MAX];
    uint32_t degree;
} old_list;

// What is known of the edge from node to neighbour, by the node's old list or the neighbour's.
static uint32_t known_before(const aisle_roadmap *self, const old_list *old, uint32_t node, uint32_t neighbour) {
    for (uint32_t i = 0; i < old->degree; i++) {
        if (old->list[i] == neighbour) {
            return old->known[i] & 15U;
        }
    }
    const uint32_t place = neighbour < self->capacity ? place_of(self, neighbour, node) : AISLE_ROADMAP_NONE;
    return place != AISLE_ROADMAP_NONE ? turned(self->known[place]) : 0U;
}

// The k nearest nodes to q but for itself become the list of `node`.
static void make_list(aisle_roadmap *self, uint32_t node, const old_list *old) {
    uint32_t found[FOUND_MAX];
    double distance[FOUND_MAX];
    const uint32_t most = self->k + 1U;
    const uint32_t n = aisle_near_find(&self->near, config_at(self, node), most, (double)INFINITY, found, distance);
    uint32_t degree = 0;
    for (uint32_t i = 0; i < n && degree < self->k; i++) {
        const uint32_t neighbour = self->node_of[found[i]];
        if (neighbour != node) {
            self->list[node * self->k + degree] = (uint16_t)neighbour;
            self->known[node * self->k + degree] = (uint8_t)known_before(self, old, node, neighbour);
            degree++;
        }
    }
    self->degree[node] = (uint8_t)degree;
}

static void connect_one(aisle_roadmap *self, uint32_t *spent) {
    const uint32_t node = self->at++;
    const bool is_node = aisle_roadmap_is_node(self, node);
    if (!is_node) {
        self->degree[node] = 0;
    }
    if (is_node && (self->work == AISLE_ROADMAP_BUILDS || (self->kind[node] & STALE) != 0U)) {
        old_list old = {.degree = self->degree[node]};
        memcpy(old.list, self->list + node * self->k, old.degree * sizeof old.list[0]);
        memcpy(old.known, self->known + node * self->k, old.degree);
        make_list(self, node, &old);
        self->lists_renewed += self->work == AISLE_ROADMAP_REPAIRS ? 1U : 0U;
        *spent += 1U;
    }
}

// Two passes over the lists: how often each node is named by others alone, and where.
static void reverse_row(aisle_roadmap *self, uint32_t row, bool is_count) {
    for (uint32_t place = row * self->k; place < row * self->k + self->degree[row]; place++) {
        const uint32_t named = self->list[place];
        if (is_count) {
            const bool is_mutual = place_of(self, named, row) != AISLE_ROADMAP_NONE;
            self->known[place] = (uint8_t)((self->known[place] & 15U) | (is_mutual ? MUTUAL : 0U));
        }
        if ((self->known[place] & MUTUAL) != 0U) {
            continue;
        }
        if (is_count) {
            self->from[named + 1U]++;
        } else {
            self->back[self->from[named]++] = place;
        }
    }
}

// The cursors have moved to where the next node's entries begin, so they move up by one at the end.
static void reverse_one(aisle_roadmap *self) {
    const uint32_t n = self->count, at = self->at++;
    if (at == 0U) {
        memset(self->from, 0, ((size_t)n + 1U) * sizeof *self->from);
    }
    if (at < n) {
        reverse_row(self, at, true);
        self->kind[at] &= (uint8_t)KIND;
        return;
    }
    if (at == n) {
        for (uint32_t i = 0; i < n; i++) {
            self->from[i + 1U] += self->from[i];
        }
    }
    reverse_row(self, at - n, false);
    if (at + 1U == 2U * n) {
        memmove(self->from + 1, self->from, n * sizeof *self->from);
        self->from[0] = 0;
    }
}

// What is known of edges that the change may touch is forgotten.
static void doubt_row(aisle_roadmap *self, uint32_t *spent) {
    const uint32_t row = self->at++;
    *spent += 1U + self->degree[row] / 8U;
    for (uint32_t place = row * self->k; place < row * self->k + self->degree[row]; place++) {
        if ((self->known[place] & 15U) != 0U &&
            self->touches(self->touch_context, config_at(self, row), config_at(self, self->list[place]))) {
            note_all(self, 2U * place, AISLE_ROADMAP_UNKNOWN);
            note_all(self, 2U * place + 1U, AISLE_ROADMAP_UNKNOWN);
            self->retested++;
        }
    }
}

static void test_row(aisle_roadmap *self, uint32_t *spent) {
    const uint32_t row = self->at++;
    const uint32_t first = 2U * row * self->k;
    for (uint32_t link = first; link < first + 2U * self->degree[row]; link++) {
        if (known_of(self, link) == AISLE_ROADMAP_UNKNOWN) {
            (void)test(self, link, spent);
            self->edge_tests++;
        }
    }
}

// After the last block of an index or of lists.
static aisle_roadmap_phase phase_after_blocks(const aisle_roadmap *self) {
    return self->work == AISLE_ROADMAP_COPIES ? AISLE_ROADMAP_READY : AISLE_ROADMAP_REVERSE;
}

// What comes after the phase that is done. Each block is indexed, then joined to what is indexed by then.
static aisle_roadmap_phase phase_after(aisle_roadmap *self) {
    switch (self->phase) {
    case AISLE_ROADMAP_TOUCH:
        return self->came + self->left > 0U ? AISLE_ROADMAP_JUDGE : AISLE_ROADMAP_DOUBT;
    case AISLE_ROADMAP_INDEX:
        if (self->work != AISLE_ROADMAP_COPIES) {
            return AISLE_ROADMAP_CONNECT;
        }
        self->block++;
        return self->block < self->blocks ? AISLE_ROADMAP_INDEX : phase_after_blocks(self);
    case AISLE_ROADMAP_CONNECT:
        self->block++;
        return self->block < self->blocks ? AISLE_ROADMAP_INDEX : phase_after_blocks(self);
    case AISLE_ROADMAP_REVERSE:
        return self->work == AISLE_ROADMAP_REPAIRS ? AISLE_ROADMAP_DOUBT
                                                   : (self->config.eager ? AISLE_ROADMAP_TEST : AISLE_ROADMAP_READY);
    case AISLE_ROADMAP_DOUBT:
        return self->config.eager ? AISLE_ROADMAP_TEST : AISLE_ROADMAP_READY;
    case AISLE_ROADMAP_JUDGE:
        self->block = 0;
        return AISLE_ROADMAP_INDEX;
    case AISLE_ROADMAP_DRAW:
        return AISLE_ROADMAP_INDEX;
    default:
        return AISLE_ROADMAP_READY;
    }
}

static bool is_by_block(const aisle_roadmap *self) {
    return self->phase == AISLE_ROADMAP_INDEX || self->phase == AISLE_ROADMAP_CONNECT;
}

static uint32_t begin_of_phase(const aisle_roadmap *self) {
    return is_by_block(self) && self->block > 0U ? self->end[self->block - 1U] : 0U;
}

static uint32_t end_of_phase(const aisle_roadmap *self) {
    if (is_by_block(self)) {
        return self->end[self->block];
    }
    switch (self->phase) {
    case AISLE_ROADMAP_DRAW:
        return self->config.samples;
    case AISLE_ROADMAP_REVERSE:
        return 2U * self->count;
    default:
        return self->count;
    }
}

#define ROWS_A_UNIT 8U // that cost next to nothing

static void step_one(aisle_roadmap *self, uint32_t *spent) {
    *spent += self->at % ROWS_A_UNIT == 0U ? 1U : 0U;
    switch (self->phase) {
    case AISLE_ROADMAP_DRAW:
        draw_one(self, spent);
        break;
    case AISLE_ROADMAP_TOUCH:
        touch_draw(self, spent);
        break;
    case AISLE_ROADMAP_JUDGE:
        judge_list(self, spent);
        break;
    case AISLE_ROADMAP_INDEX:
        index_one(self);
        break;
    case AISLE_ROADMAP_CONNECT:
        connect_one(self, spent);
        break;
    case AISLE_ROADMAP_REVERSE:
        reverse_one(self);
        break;
    case AISLE_ROADMAP_DOUBT:
        doubt_row(self, spent);
        break;
    default:
        test_row(self, spent);
        break;
    }
}

aisle_status aisle_roadmap_step(aisle_roadmap *self, uint32_t units, uint32_t *spent) {
    const uint32_t until = units < UINT32_MAX - *spent ? *spent + units : UINT32_MAX;
    if (self->phase == AISLE_ROADMAP_EMPTY) {
        return AISLE_ERR_ARG;
    }
    while (self->phase != AISLE_ROADMAP_READY && *spent < until) {
        step_one(self, spent);
        if (self->at >= end_of_phase(self)) {
            self->phase = phase_after(self);
            self->at = begin_of_phase(self);
        }
    }
    return self->phase == AISLE_ROADMAP_READY ? AISLE_OK : AISLE_BUSY;
}

void aisle_roadmap_copy(aisle_roadmap *self, const aisle_roadmap *other, const aisle_cspace *space) {
    AISLE_ASSERT(other->phase == AISLE_ROADMAP_READY && self->capacity == other->capacity && self->k == other->k &&
                 self->dim_max >= other->dim && space->dim == other->dim);
    const size_t n = other->count, places = n * other->k;
    self->space = space;
    self->config = other->config;
    self->dim = other->dim;
    self->count = other->count;
    self->free_count = other->free_count;
    self->rng = other->rng;
    self->edge_tests = self->retested = self->lists_renewed = 0;
    memcpy(self->q, other->q, n * self->dim * sizeof *self->q);
    memcpy(self->kind, other->kind, n);
    memcpy(self->degree, other->degree, n);
    memcpy(self->list, other->list, places * sizeof *self->list);
    memcpy(self->known, other->known, places);
    memcpy(self->from, other->from, (n + 1U) * sizeof *self->from);
    memcpy(self->back, other->back, (size_t)other->from[n] * sizeof *self->back);
    memcpy(self->end, other->end, sizeof self->end);
    self->blocks = other->blocks;
    self->block = 0;
    self->work = AISLE_ROADMAP_COPIES;
    self->phase = AISLE_ROADMAP_INDEX;
    self->at = 0;
}

// ---- the query phase

void aisle_roadmap_search_carve(aisle_roadmap_search *self, aisle_arena *arena, uint32_t samples) {
    const uint32_t nodes = samples + 2U;
    *self = (aisle_roadmap_search){.capacity = samples, .ended = AISLE_ERR_ARG};
    aisle_heap_carve(&self->open, arena, nodes);
    self->cost = (double *)aisle_arena_take(arena, nodes, sizeof *self->cost);
    self->parent = (uint32_t *)aisle_arena_take(arena, nodes, sizeof *self->parent);
    self->is_done = (uint8_t *)aisle_arena_take(arena, nodes, 1U);
    self->end_place = (uint8_t *)aisle_arena_take(arena, (size_t)samples * 2U, 1U);
}

static uint32_t start_of(const aisle_roadmap *self) {
    return self->capacity;
}

static uint32_t goal_of(const aisle_roadmap *self) {
    return self->capacity + 1U;
}

// The list of an end of the query, and at its nodes the way back to it.
static void join_end(aisle_roadmap_search *self, uint32_t end, const double *q) {
    aisle_roadmap *roadmap = self->roadmap;
    const old_list none = {.degree = 0};
    uint8_t *place = self->end_place + (end == start_of(roadmap) ? 0U : self->capacity);
    memcpy(config_at(roadmap, end), q, roadmap->dim * sizeof *q);
    memset(place, 0, roadmap->count);
    make_list(roadmap, end, &none);
    for (uint32_t i = 0; i < roadmap->degree[end]; i++) {
        place[roadmap->list[end * roadmap->k + i]] = (uint8_t)(i + 1U);
    }
}

// The i-th link that leaves the node, or arrives there; AISLE_ROADMAP_NONE: there are no more.
static uint32_t link_at(const aisle_roadmap_search *self, uint32_t node, uint32_t i, bool leaves) {
    const aisle_roadmap *roadmap = self->roadmap;
    const uint32_t out = leaves ? 0U : 1U;
    if (i < roadmap->degree[node]) {
        return 2U * (node * roadmap->k + i) + out;
    }
    i -= roadmap->degree[node];
    if (node >= roadmap->capacity) {
        return AISLE_ROADMAP_NONE;
    }
    if (i < roadmap->from[node + 1U] - roadmap->from[node]) {
        return 2U * roadmap->back[roadmap->from[node] + i] + (out ^ 1U);
    }
    i -= roadmap->from[node + 1U] - roadmap->from[node];
    const uint32_t place = self->end_place[node + (leaves ? self->capacity : 0U)];
    const uint32_t end = leaves ? goal_of(roadmap) : start_of(roadmap);
    return i == 0U && place > 0U ? 2U * (end * roadmap->k + place - 1U) + (out ^ 1U) : AISLE_ROADMAP_NONE;
}

static double cost_of_link(const aisle_roadmap *self, uint32_t link) {
    return aisle_cspace_cost(self->space, config_at(self, tail_of(self, link)), config_at(self, head_of(self, link)));
}

// The bits of a number that is not negative are in its order.
static uint64_t key_of(double f) {
    uint64_t key;
    memcpy(&key, &f, sizeof key);
    return key;
}

static void open_node(aisle_roadmap_search *self, uint32_t node, uint32_t link, double cost) {
    const aisle_roadmap *roadmap = self->roadmap;
    const double *goal = config_at(roadmap, goal_of(roadmap));
    const double left =
        self->kind == AISLE_ROADMAP_ASTAR ? aisle_cspace_bound(roadmap->space, config_at(roadmap, node), goal) : 0.0;
    self->cost[node] = cost;
    self->parent[node] = link;
    const aisle_status st = aisle_heap_push(&self->open, node, key_of(cost + left));
    AISLE_ASSERT(st == AISLE_OK);
}

void aisle_roadmap_ask(aisle_roadmap_search *self, aisle_roadmap *roadmap, aisle_roadmap_search_kind kind,
                       const double *from, const double *to, uint32_t *spent) {
    AISLE_ASSERT(roadmap->phase == AISLE_ROADMAP_READY && roadmap->capacity <= self->capacity);
    self->roadmap = roadmap;
    self->kind = kind;
    self->expanded = 0;
    self->tests = 1;
    for (uint32_t i = 0; i < roadmap->count; i++) {
        self->cost[i] = (double)INFINITY;
    }
    memset(self->is_done, 0, roadmap->count);
    for (uint32_t end = start_of(roadmap); end <= goal_of(roadmap); end++) {
        self->cost[end] = (double)INFINITY;
        self->is_done[end] = 0;
    }
    aisle_heap_clear(&self->open);
    join_end(self, start_of(roadmap), from);
    join_end(self, goal_of(roadmap), to);
    *spent += 2U;
    self->ended = AISLE_BUSY;
    if (roadmap->space->is_free(roadmap->space->context, from, to, spent)) {
        self->cost[goal_of(roadmap)] = aisle_cspace_cost(roadmap->space, from, to);
        self->parent[goal_of(roadmap)] = AISLE_ROADMAP_NONE;
        self->ended = AISLE_OK;
    } else {
        open_node(self, start_of(roadmap), AISLE_ROADMAP_NONE, 0.0);
    }
}

// Is the motion free by which the node is reached?
static bool confirm(aisle_roadmap_search *self, uint32_t node, uint32_t *spent) {
    const uint32_t link = self->parent[node];
    if (link == AISLE_ROADMAP_NONE || known_of(self->roadmap, link) == AISLE_ROADMAP_FREE) {
        return true;
    }
    self->tests++;
    self->roadmap->edge_tests += link / 2U / self->roadmap->k < self->roadmap->capacity ? 1U : 0U;
    return test(self->roadmap, link, spent);
}

// The way by which the node was to be reached is blocked: the next best one from a node that is done with.
static void reopen(aisle_roadmap_search *self, uint32_t node) {
    const aisle_roadmap *roadmap = self->roadmap;
    uint32_t best = AISLE_ROADMAP_NONE;
    double least = (double)INFINITY;
    for (uint32_t i = 0, link; (link = link_at(self, node, i, false)) != AISLE_ROADMAP_NONE; i++) {
        const uint32_t tail = tail_of(roadmap, link);
        if (self->is_done[tail] != 0U && known_of(roadmap, link) != AISLE_ROADMAP_BLOCKED) {
            const double cost = self->cost[tail] + cost_of_link(roadmap, link);
            best = cost < least ? link : best;
            least = cost < least ? cost : least;
        }
    }
    self->cost[node] = (double)INFINITY;
    if (best != AISLE_ROADMAP_NONE) {
        open_node(self, node, best, least);
    }
}

static void expand(aisle_roadmap_search *self, uint32_t node, uint32_t *spent) {
    const aisle_roadmap *roadmap = self->roadmap;
    self->is_done[node] = 1U;
    self->expanded++;
    uint32_t i = 0;
    for (uint32_t link; (link = link_at(self, node, i, true)) != AISLE_ROADMAP_NONE; i++) {
        const uint32_t head = head_of(roadmap, link);
        if (self->is_done[head] == 0U && known_of(roadmap, link) != AISLE_ROADMAP_BLOCKED) {
            const double cost = self->cost[node] + cost_of_link(roadmap, link);
            if (cost < self->cost[head]) {
                open_node(self, head, link, cost);
            }
        }
    }
    *spent += i / 8U;
}

aisle_status aisle_roadmap_search_step(aisle_roadmap_search *self, uint32_t units, uint32_t *spent) {
    const uint32_t until = units < UINT32_MAX - *spent ? *spent + units : UINT32_MAX;
    while (self->ended == AISLE_BUSY && *spent < until) {
        const uint32_t node = aisle_heap_pop(&self->open);
        *spent += 1U;
        if (node == AISLE_HEAP_NONE) {
            self->ended = AISLE_PARTIAL;
        } else if (!confirm(self, node, spent)) {
            reopen(self, node);
        } else if (node == goal_of(self->roadmap)) {
            self->ended = AISLE_OK;
        } else {
            expand(self, node, spent);
        }
    }
    return self->ended;
}

double aisle_roadmap_cost(const aisle_roadmap_search *self) {
    return self->ended == AISLE_OK ? self->cost[goal_of(self->roadmap)] : (double)INFINITY;
}

// The node before this one on the way.
static uint32_t before(const aisle_roadmap_search *self, uint32_t node) {
    const uint32_t link = self->parent[node];
    return link == AISLE_ROADMAP_NONE ? start_of(self->roadmap) : tail_of(self->roadmap, link);
}

uint32_t aisle_roadmap_way(const aisle_roadmap_search *self, double *q, uint32_t capacity) {
    const aisle_roadmap *roadmap = self->roadmap;
    uint32_t n = 1;
    if (self->ended != AISLE_OK) {
        return 0;
    }
    for (uint32_t node = goal_of(roadmap); node != start_of(roadmap); node = before(self, node)) {
        n++;
    }
    if (n > capacity) {
        return 0;
    }
    uint32_t node = goal_of(roadmap);
    for (uint32_t i = n; i > 0U; i--) {
        memcpy(q + (size_t)(i - 1U) * roadmap->dim, config_at(roadmap, node), roadmap->dim * sizeof *q);
        node = i > 1U ? before(self, node) : node;
    }
    return n;
}

// ---- for tests

static bool row_holds(const aisle_roadmap *self, uint32_t row) {
    double last = 0.0;
    if (!aisle_roadmap_is_node(self, row)) {
        return self->degree[row] == 0U;
    }
    for (uint32_t i = 0; i < self->degree[row]; i++) {
        const uint32_t place = row * self->k + i, other = self->list[place];
        const uint32_t mate = place_of(self, other, row);
        const double distance = aisle_cspace_distance(self->space, config_at(self, row), config_at(self, other));
        const bool is_mutual = (self->known[place] & MUTUAL) != 0U;
        if (!aisle_roadmap_is_node(self, other) || other == row || distance < last ||
            is_mutual != (mate != AISLE_ROADMAP_NONE) ||
            (is_mutual && turned(self->known[mate]) != (self->known[place] & 15U))) {
            return false;
        }
        last = distance;
    }
    return true;
}

bool aisle_roadmap_invariants_hold(const aisle_roadmap *self) {
    uint32_t named = 0, nodes = 0, alone = 0;
    for (uint32_t row = 0; row < self->count; row++) {
        if (!row_holds(self, row) || (self->kind[row] & ~KIND) != 0U) {
            return false;
        }
        nodes += aisle_roadmap_is_node(self, row) ? 1U : 0U;
        for (uint32_t i = 0; i < self->degree[row]; i++) {
            alone += (self->known[row * self->k + i] & MUTUAL) == 0U ? 1U : 0U;
        }
        for (uint32_t at = self->from[row]; at < self->from[row + 1U]; at++, named++) {
            if (self->list[self->back[at]] != row || (self->known[self->back[at]] & MUTUAL) != 0U) {
                return false;
            }
        }
    }
    return named == alone && nodes == self->free_count && nodes == self->near.count &&
           aisle_near_invariants_hold(&self->near);
}
