// The tangent graph between arcs and A* over it.
#include "optimum_world.h"

#include <stdlib.h>
#include <string.h>

#define SINE_SLACK 1e-9L  // of a tangent's contact at an arc's end
#define ANGLE_SLACK 1e-8L // rad, of one contact before another
enum { NONE = -1, START = -2, GOAL = -3 };

// A directed tangent: leaves arc `from` turning to side `leave`, meets arc `to` turning to side `meet` (1 left, -1
// right, 0 at start and goal).
typedef struct tangent {
    int32_t from, to, parent;
    int8_t leave, meet;
    bool settled;
    real left_at, met_at; // rad from the arcs' lo
    real length, togo;    // togo: beeline from its end to the goal
    real cost;            // least known from the start to its end
} tangent;

typedef struct entry {
    real bound;
    size_t index;
} entry;

typedef struct search {
    const optimum_world *world;
    vec start, goal;
    real upper;
    tangent *tangents;
    size_t count, capacity;
    size_t (*lists)[2]; // per arc and side: its tangents [from, to); from = to = SIZE_MAX: not made yet
    int32_t *near;      // arcs that a path no longer than upper may touch
    size_t near_count;
    entry *heap;
    size_t heap_count, heap_capacity;
} search;

static void push(search *s, real bound, size_t index) {
    s->heap = optimum_grow(s->heap, &s->heap_capacity, s->heap_count + 1, sizeof(entry));
    size_t i = s->heap_count++;
    while (i > 0 && s->heap[(i - 1) / 2].bound > bound) {
        s->heap[i] = s->heap[(i - 1) / 2];
        i = (i - 1) / 2;
    }
    s->heap[i].bound = bound;
    s->heap[i].index = index;
}

static size_t pop(search *s) {
    size_t index = s->heap[0].index, i = 0;
    entry last = s->heap[--s->heap_count];
    for (;;) {
        size_t child = 2 * i + 1;
        if (child >= s->heap_count) {
            break;
        }
        if (child + 1 < s->heap_count && s->heap[child + 1].bound < s->heap[child].bound) {
            child++;
        }
        if (s->heap[child].bound >= last.bound) {
            break;
        }
        s->heap[i] = s->heap[child];
        i = child;
    }
    s->heap[i] = last;
    return index;
}

static vec center_of(const search *s, int32_t which) {
    if (which == START) {
        return s->start;
    }
    return which == GOAL ? s->goal : s->world->arcs[which].center;
}

// Angle of u from the arc's lo, clamped to it; false if u is none of its normals.
static bool contact(const search *s, int32_t which, vec u, real *angle) {
    *angle = 0.0L;
    if (which < 0) {
        return true;
    }
    const arc *a = &s->world->arcs[which];
    if (cross(a->lo, u) < -SINE_SLACK || cross(u, a->hi) < -SINE_SLACK || dot(plus(a->lo, a->hi), u) <= 0.0L) {
        return false;
    }
    *angle = fminl(fmaxl(atan2l(cross(a->lo, u), dot(a->lo, u)), 0.0L), a->span);
    return true;
}

// With h the heading, L the length, J the turn to the left: a circle of which the path turns to side m = +-1 is touched
// at c - m R J h. Touching both, b - a = L h + R (meet - leave) J h, so h = (L - k J)(b - a) / |b - a|^2.
static bool make_tangent(const search *s, tangent *t) {
    real radius = s->world->radius, k = radius * (real)(t->meet - t->leave);
    vec a = center_of(s, t->from), b = center_of(s, t->to), d = minus(b, a);
    real square = dot(d, d);
    if (square == 0.0L || square < k * k - 2.0L * fabsl(k) * (real)OPTIMUM_SLACK) {
        return false;
    }
    t->length = sqrtl(fmaxl(square - k * k, 0.0L));
    vec h = minus(times(t->length, d), times(k, left_of(d)));
    h = times(1.0L / norm(h), h);
    vec u = times((real)-t->leave, left_of(h)), v = times((real)-t->meet, left_of(h));
    if (!contact(s, t->from, u, &t->left_at) || !contact(s, t->to, v, &t->met_at)) {
        return false;
    }
    vec p = plus(a, times(radius, u)), q = plus(b, times(radius, v));
    t->togo = norm(minus(s->goal, q));
    return s->world->segment_free(s->world, p, q);
}

static void keep(search *s, tangent t) {
    s->tangents = optimum_grow(s->tangents, &s->capacity, s->count + 1, sizeof(tangent));
    t.parent = NONE;
    t.settled = false;
    t.cost = INFINITY;
    s->tangents[s->count++] = t;
}

// The way on along the same circle, into the next quarter.
static void keep_link(search *s, int32_t from, int8_t side) {
    const arc *a = &s->world->arcs[from];
    int32_t to = side > 0 ? a->after : a->before;
    if (to < 0) {
        return;
    }
    tangent t = {.from = from, .to = to, .leave = side, .meet = side};
    t.left_at = side > 0 ? a->span : 0.0L;
    t.met_at = side > 0 ? 0.0L : s->world->arcs[to].span;
    vec end = plus(a->center, times(s->world->radius, side > 0 ? a->hi : a->lo));
    t.togo = norm(minus(s->goal, end));
    keep(s, t);
}

static void make_list(search *s, int32_t from, int8_t side, size_t *list) {
    list[0] = s->count;
    tangent t = {.from = from, .to = GOAL, .leave = side, .meet = 0};
    if (make_tangent(s, &t)) {
        keep(s, t);
    }
    for (size_t i = 0; i < s->near_count; i++) {
        t.to = s->near[i];
        for (t.meet = -1; t.meet <= 1 && t.to != from; t.meet = (int8_t)(t.meet + 2)) {
            if (make_tangent(s, &t)) {
                keep(s, t);
            }
        }
    }
    if (from >= 0) {
        keep_link(s, from, side);
    }
    list[1] = s->count;
}

static void relax(search *s, int32_t parent, size_t index, real cost) {
    tangent *t = &s->tangents[index];
    if (cost < t->cost && cost + t->togo <= s->upper) {
        t->cost = cost;
        t->parent = parent;
        push(s, cost + t->togo, index);
    }
}

static void expand(search *s, size_t index) {
    tangent at = s->tangents[index];
    size_t *list = s->lists[2 * at.to + (at.meet > 0)];
    if (list[0] == SIZE_MAX) {
        make_list(s, at.to, at.meet, list);
    }
    for (size_t i = list[0]; i < list[1]; i++) {
        real turn = (real)at.meet * (s->tangents[i].left_at - at.met_at);
        if (turn >= -ANGLE_SLACK) {
            relax(s, (int32_t)index, i, at.cost + s->world->radius * fmaxl(turn, 0.0L) + s->tangents[i].length);
        }
    }
}

// Index of the tangent that reaches the goal, or NONE.
static int32_t run(search *s) {
    size_t list[2];
    make_list(s, START, 0, list);
    for (size_t i = list[0]; i < list[1]; i++) {
        relax(s, NONE, i, s->tangents[i].length);
    }
    while (s->heap_count > 0) {
        size_t index = pop(s);
        if (s->tangents[index].settled) {
            continue;
        }
        s->tangents[index].settled = true;
        if (s->tangents[index].to == GOAL) {
            return (int32_t)index;
        }
        expand(s, index);
    }
    return NONE;
}

static void begin(search *s) {
    size_t n = s->world->arc_count;
    s->lists = malloc((2 * n + 1) * sizeof *s->lists);
    s->near = malloc((n + 1) * sizeof *s->near);
    if (s->lists == NULL || s->near == NULL) {
        abort();
    }
    memset(s->lists, 0xFF, (2 * n + 1) * sizeof *s->lists);
    for (size_t i = 0; i < n; i++) {
        vec c = s->world->arcs[i].center;
        if (norm(minus(c, s->start)) + norm(minus(s->goal, c)) - 2.0L * s->world->radius <= s->upper) {
            s->near[s->near_count++] = (int32_t)i;
        }
    }
}

static void add_step(optimum_path *path, const search *s, int32_t which, real angle, real curvature) {
    vec p = center_of(s, which);
    if (which >= 0) {
        p = plus(p, times(s->world->radius, turned(s->world->arcs[which].lo, angle)));
    }
    optimum_step *last = path->count > 0 ? &path->steps[path->count - 1] : NULL;
    if (last != NULL && hypotl(p.x - last->x, p.y - last->y) < 1e-12L) {
        return;
    }
    optimum_step step = {(double)p.x, (double)p.y, (double)curvature};
    path->steps[path->count++] = step;
}

static void trace(optimum_path *path, const search *s, int32_t last) {
    size_t n = 0;
    for (int32_t i = last; i != NONE; i = s->tangents[i].parent) {
        n++;
    }
    int32_t *chain = malloc(n * sizeof *chain);
    path->steps = malloc((2 * n + 2) * sizeof *path->steps);
    if (chain == NULL || path->steps == NULL) {
        abort();
    }
    size_t k = n;
    for (int32_t i = last; i != NONE; i = s->tangents[i].parent) {
        chain[--k] = i;
    }
    real bend = s->world->radius > 0.0L ? 1.0L / s->world->radius : 0.0L;
    for (size_t i = 0; i < n; i++) {
        const tangent *t = &s->tangents[chain[i]];
        add_step(path, s, t->from, t->left_at, (real)t->leave * bend);
        add_step(path, s, t->to, t->met_at, 0.0L);
    }
    path->length = (double)s->tangents[last].cost;
    free(chain);
}

optimum_path optimum_shortest(const optimum_world *world, optimum_point start, optimum_point goal, double upper) {
    optimum_path path = {.result = OPTIMUM_END_OCCUPIED, .length = INFINITY};
    search s = {.world = world, .upper = upper, .start = {start.x, start.y}, .goal = {goal.x, goal.y}};
    if (!world->segment_free(world, s.start, s.start) || !world->segment_free(world, s.goal, s.goal)) {
        return path;
    }
    if (start.x == goal.x && start.y == goal.y) {
        path.steps = calloc(1, sizeof *path.steps);
        if (path.steps == NULL) {
            abort();
        }
        path.steps[path.count].x = start.x;
        path.steps[path.count++].y = start.y;
        path.result = OPTIMUM_FOUND;
        path.length = 0.0;
        return path;
    }
    begin(&s);
    int32_t last = run(&s);
    path.result = last != NONE ? OPTIMUM_FOUND : OPTIMUM_NONE;
    path.tangents = s.count;
    if (last != NONE) {
        trace(&path, &s, last);
    }
    free(s.tangents);
    free(s.lists);
    free(s.near);
    free(s.heap);
    return path;
}

void optimum_path_free(optimum_path *path) {
    free(path->steps);
    path->steps = NULL;
    path->count = 0;
}

size_t optimum_arcs(const optimum_world *world) {
    return world->arc_count;
}

void optimum_free(optimum_world *world) {
    if (world != NULL) {
        world->obstacles_free(world->obstacles);
        free(world->arcs);
        free(world);
    }
}
