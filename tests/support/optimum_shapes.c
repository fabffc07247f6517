// Geometry of the oracle of shortest paths: hulls, distances, what is left of an arc.
#include "optimum_world.h"

#include <stdlib.h>
#include <string.h>

#define ANGLE_MIN 1e-13L // rad: shorter pieces of an arc are no pieces

void *optimum_grow(void *block, size_t *capacity, size_t need, size_t size) {
    if (need <= *capacity) {
        return block;
    }
    while (*capacity < need) {
        *capacity = *capacity < 16 ? 16 : 2 * *capacity;
    }
    void *grown = realloc(block, *capacity * size);
    if (grown == NULL) {
        abort();
    }
    return grown;
}

void optimum_add_interval(intervals *list, real from, real to) {
    list->items = optimum_grow(list->items, &list->capacity, list->count + 1, sizeof(interval));
    list->items[list->count].from = from;
    list->items[list->count].to = to;
    list->count++;
}

static int by_x_then_y(const void *a, const void *b) {
    const vec *p = a, *q = b;
    if (p->x != q->x) {
        return p->x < q->x ? -1 : 1;
    }
    return (p->y > q->y) - (p->y < q->y);
}

static bool turns_left(vec a, vec b, vec c) {
    vec ab = minus(b, a), bc = minus(c, b);
    return cross(ab, bc) > 1e-15L * norm(ab) * norm(bc);
}

// Andrew's monotone chain (1979, doi:10.1016/0020-0190(79)90072-3).
size_t optimum_hull(const optimum_point *points, size_t count, vec *hull) {
    vec *sorted = malloc(count * sizeof(vec)), *chain = malloc((2 * count + 1) * sizeof(vec));
    if (sorted == NULL || chain == NULL) {
        abort();
    }
    for (size_t i = 0; i < count; i++) {
        sorted[i] = vec_of(points[i].x, points[i].y);
    }
    qsort(sorted, count, sizeof(vec), by_x_then_y);
    size_t n = 0, base = 0;
    for (size_t i = 0; i < 2 * count; i++) {
        if (i == count) {
            base = n - 1;
        }
        vec p = sorted[i < count ? i : 2 * count - 1 - i];
        if (n > 0 && p.x == chain[n - 1].x && p.y == chain[n - 1].y) {
            continue;
        }
        while (n >= base + 2 && !turns_left(chain[n - 2], chain[n - 1], p)) {
            n--;
        }
        chain[n++] = p;
    }
    n = n > 1 ? n - 1 : 1; // the first point again
    memcpy(hull, chain, n * sizeof(vec));
    free(sorted);
    free(chain);
    return n;
}

static real square_to_segment(vec x, vec a, vec b) {
    vec ab = minus(b, a), ax = minus(x, a);
    real square = dot(ab, ab), along = dot(ab, ax);
    if (along <= 0.0L || square == 0.0L) {
        return dot(ax, ax);
    }
    if (along >= square) {
        vec bx = minus(x, b);
        return dot(bx, bx);
    }
    real off = cross(ab, ax);
    return off * off / square;
}

static bool crosses(vec a, vec b, vec p, vec q) {
    vec ab = minus(b, a), pq = minus(q, p);
    real a_off = cross(pq, minus(a, p)), b_off = cross(pq, minus(b, p));
    real p_off = cross(ab, minus(p, a)), q_off = cross(ab, minus(q, a));
    return ((a_off < 0.0L) != (b_off < 0.0L)) && ((p_off < 0.0L) != (q_off < 0.0L));
}

bool optimum_hits(const vec *hull, size_t count, real reach, vec p, vec q) {
    real square = reach * reach;
    bool inside = true; // of no point or line: there some product is never above 0
    for (size_t i = 0; i < count; i++) {
        vec a = hull[i], b = hull[i + 1 < count ? i + 1 : 0];
        if (square_to_segment(a, p, q) < square || square_to_segment(p, a, b) < square ||
            square_to_segment(q, a, b) < square || crosses(a, b, p, q)) {
            return true;
        }
        inside = inside && cross(minus(b, a), minus(p, a)) > 0.0L;
    }
    return inside;
}

// Angles from lo at which the circle's normal u has u . axis = cosine; adds those in (0, span).
static size_t add_angles(vec lo, real span, vec axis, real cosine, real *angles, size_t n) {
    if (cosine < -1.0L || cosine > 1.0L) {
        return n;
    }
    real middle = atan2l(cross(lo, axis), dot(lo, axis)), half = acosl(cosine);
    for (int turn = -1; turn <= 1; turn++) {
        for (int side = -1; side <= 1; side += 2) {
            real t = middle + (real)side * half + (real)turn * 2.0L * acosl(-1.0L);
            if (t > 0.0L && t < span) {
                angles[n++] = t;
            }
        }
    }
    return n;
}

static int by_value(const void *a, const void *b) {
    real x = *(const real *)a, y = *(const real *)b;
    return (x > y) - (x < y);
}

void optimum_block_arc(vec center, real radius, vec lo, real span, const vec *hull, size_t count, real reach,
                       intervals *blocked) {
    real *angles = malloc((12 * count + 2) * sizeof(real));
    if (angles == NULL) {
        abort();
    }
    size_t n = 0;
    angles[n++] = 0.0L;
    angles[n++] = span;
    for (size_t i = 0; i < count; i++) {
        vec to = minus(hull[i], center), edge = minus(hull[i + 1 < count ? i + 1 : 0], hull[i]);
        real far = norm(to), length = norm(edge);
        if (far > 0.0L) {
            real cosine = (radius * radius + far * far - reach * reach) / (2.0L * radius * far);
            n = add_angles(lo, span, times(1.0L / far, to), cosine, angles, n);
        }
        if (length > 0.0L) {
            vec normal = times(-1.0L / length, left_of(edge));
            n = add_angles(lo, span, normal, (reach + dot(normal, to)) / radius, angles, n);
        }
    }
    qsort(angles, n, sizeof(real), by_value);
    for (size_t i = 1; i < n; i++) {
        if (angles[i] - angles[i - 1] > ANGLE_MIN) {
            vec middle = plus(center, times(radius, turned(lo, 0.5L * (angles[i] + angles[i - 1]))));
            if (optimum_hits(hull, count, reach, middle, middle)) {
                optimum_add_interval(blocked, angles[i - 1], angles[i]);
            }
        }
    }
    free(angles);
}

void optimum_block_beyond(vec center, real radius, vec lo, real span, vec normal, real limit, intervals *blocked) {
    real angles[10] = {0.0L, span}, room = limit - dot(normal, center);
    size_t n = add_angles(lo, span, normal, room / radius, angles, 2);
    qsort(angles, n, sizeof(real), by_value);
    for (size_t i = 1; i < n; i++) {
        vec u = turned(lo, 0.5L * (angles[i] + angles[i - 1]));
        if (angles[i] - angles[i - 1] > ANGLE_MIN && radius * dot(normal, u) > room) {
            optimum_add_interval(blocked, angles[i - 1], angles[i]);
        }
    }
}

static int by_from(const void *a, const void *b) {
    const interval *x = a, *y = b;
    return (x->from > y->from) - (x->from < y->from);
}

static void add_arc(optimum_world *world, vec center, vec lo, real from, real to) {
    world->arcs = optimum_grow(world->arcs, &world->arc_capacity, world->arc_count + 1, sizeof(arc));
    arc *made = &world->arcs[world->arc_count++];
    made->center = center;
    made->lo = turned(lo, from);
    made->hi = turned(lo, to);
    made->span = to - from;
    made->after = made->before = -1;
}

void optimum_add_arcs(optimum_world *world, vec center, vec lo, real span, intervals *blocked) {
    if (blocked->count == 0) { // of whatever length: a corner as flat as can be is one
        add_arc(world, center, lo, 0.0L, span);
        return;
    }
    qsort(blocked->items, blocked->count, sizeof(interval), by_from);
    real from = 0.0L;
    for (size_t i = 0; i < blocked->count; i++) {
        if (blocked->items[i].from > from + ANGLE_MIN) {
            add_arc(world, center, lo, from, blocked->items[i].from);
        }
        from = fmaxl(from, blocked->items[i].to);
    }
    if (span > from + ANGLE_MIN) {
        add_arc(world, center, lo, from, span);
    }
}

static void link_pair(optimum_world *world, size_t first, size_t second) {
    arc *a = &world->arcs[first], *b = &world->arcs[second];
    if (norm(minus(a->hi, b->lo)) < 1e-12L) {
        a->after = (int32_t)second;
        b->before = (int32_t)first;
    }
}

void optimum_link_arcs(optimum_world *world, size_t first, bool closed) {
    for (size_t i = first + 1; i < world->arc_count; i++) {
        link_pair(world, i - 1, i);
    }
    if (closed && world->arc_count > first + 1) {
        link_pair(world, world->arc_count - 1, first);
    }
}
