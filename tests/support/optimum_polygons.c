// World of convex polygons inside a rectangle that holds the disc's centre.
#include "optimum_world.h"

#include <stdlib.h>

typedef struct hulls {
    vec *points;
    size_t *first;      // [count + 1] into points
    vec *lower, *upper; // [count] boxes
    size_t count;
    vec bounds[2];
} hulls;

static bool inside_bounds(const hulls *h, vec p) {
    return p.x >= h->bounds[0].x - (real)OPTIMUM_SLACK && p.x <= h->bounds[1].x + (real)OPTIMUM_SLACK &&
           p.y >= h->bounds[0].y - (real)OPTIMUM_SLACK && p.y <= h->bounds[1].y + (real)OPTIMUM_SLACK;
}

// A point robot: does p..q come deeper than the slack into the polygon?
static bool enters(const vec *hull, size_t count, vec p, vec q) {
    real from = 0.0L, to = 1.0L;
    for (size_t i = 0; i < count; i++) {
        vec edge = minus(hull[i + 1 < count ? i + 1 : 0], hull[i]);
        real length = norm(edge);
        real at_p = cross(edge, minus(p, hull[i])) / length - (real)OPTIMUM_SLACK;
        real at_q = cross(edge, minus(q, hull[i])) / length - (real)OPTIMUM_SLACK;
        if (at_p <= 0.0L && at_q <= 0.0L) {
            return false;
        }
        if (at_p < 0.0L) {
            from = fmaxl(from, at_p / (at_p - at_q));
        }
        if (at_q < 0.0L) {
            to = fminl(to, at_p / (at_p - at_q));
        }
    }
    return count > 2 && from < to;
}

static bool segment_free(const optimum_world *world, vec p, vec q) {
    const hulls *h = world->obstacles;
    if (!inside_bounds(h, p) || !inside_bounds(h, q)) {
        return false;
    }
    vec lower = vec_of(fminl(p.x, q.x) - world->radius, fminl(p.y, q.y) - world->radius);
    vec upper = vec_of(fmaxl(p.x, q.x) + world->radius, fmaxl(p.y, q.y) + world->radius);
    for (size_t i = 0; i < h->count; i++) {
        if (h->upper[i].x < lower.x || h->lower[i].x > upper.x || h->upper[i].y < lower.y || h->lower[i].y > upper.y) {
            continue;
        }
        const vec *hull = &h->points[h->first[i]];
        size_t n = h->first[i + 1] - h->first[i];
        if (world->radius > 0.0L ? optimum_hits(hull, n, world->reach, p, q) : enters(hull, n, p, q)) {
            return false;
        }
    }
    return true;
}

static void block_by_all(const optimum_world *world, size_t own, vec center, vec lo, real span, intervals *blocked) {
    const hulls *h = world->obstacles;
    real radius = world->radius, slack = (real)OPTIMUM_SLACK, far = 2.0L * radius;
    for (size_t i = 0; i < h->count; i++) {
        if (i != own && h->upper[i].x > center.x - far && h->lower[i].x < center.x + far &&
            h->upper[i].y > center.y - far && h->lower[i].y < center.y + far) {
            optimum_block_arc(center, radius, lo, span, &h->points[h->first[i]], h->first[i + 1] - h->first[i],
                              world->reach, blocked);
        }
    }
    optimum_block_beyond(center, radius, lo, span, vec_of(1.0L, 0.0L), h->bounds[1].x + slack, blocked);
    optimum_block_beyond(center, radius, lo, span, vec_of(-1.0L, 0.0L), slack - h->bounds[0].x, blocked);
    optimum_block_beyond(center, radius, lo, span, vec_of(0.0L, 1.0L), h->bounds[1].y + slack, blocked);
    optimum_block_beyond(center, radius, lo, span, vec_of(0.0L, -1.0L), slack - h->bounds[0].y, blocked);
}

// The vertex's normal cone in pieces of at most a quarter.
static void add_vertex(optimum_world *world, size_t own, vec center, vec lo, real span, bool closed) {
    if (world->radius == 0.0L && !segment_free(world, center, center)) {
        return;
    }
    size_t first = world->arc_count;
    int pieces = (int)ceill(span / acosl(0.0L) - 1e-9L);
    pieces = pieces < 1 ? 1 : pieces;
    intervals blocked = {0};
    for (int i = 0; i < pieces; i++) {
        vec from = turned(lo, span * (real)i / (real)pieces);
        blocked.count = 0;
        if (world->radius > 0.0L) {
            block_by_all(world, own, center, from, span / (real)pieces, &blocked);
        }
        optimum_add_arcs(world, center, from, span / (real)pieces, &blocked);
    }
    free(blocked.items);
    optimum_link_arcs(world, first, closed);
}

static vec normal_of(vec a, vec b) {
    vec edge = minus(b, a);
    return times(-1.0L / norm(edge), left_of(edge));
}

static void add_hull(optimum_world *world, size_t own) {
    const hulls *h = world->obstacles;
    const vec *hull = &h->points[h->first[own]];
    size_t n = h->first[own + 1] - h->first[own];
    if (n < 3 && world->radius == 0.0L) {
        return;
    }
    if (n == 1) {
        add_vertex(world, own, hull[0], vec_of(1.0L, 0.0L), 2.0L * acosl(-1.0L), true);
        return;
    }
    for (size_t i = 0; i < n; i++) {
        vec lo = normal_of(hull[(i + n - 1) % n], hull[i]), hi = normal_of(hull[i], hull[(i + 1) % n]);
        real span = n == 2 ? acosl(-1.0L) : atan2l(cross(lo, hi), dot(lo, hi));
        add_vertex(world, own, hull[i], lo, span, false);
    }
}

static void hulls_free(void *obstacles) {
    hulls *h = obstacles;
    free(h->points);
    free(h->first);
    free(h->lower);
    free(h->upper);
    free(h);
}

static void set_box(hulls *h, size_t i) {
    vec lower = h->points[h->first[i]], upper = lower;
    for (size_t k = h->first[i]; k < h->first[i + 1]; k++) {
        lower = vec_of(fminl(lower.x, h->points[k].x), fminl(lower.y, h->points[k].y));
        upper = vec_of(fmaxl(upper.x, h->points[k].x), fmaxl(upper.y, h->points[k].y));
    }
    h->lower[i] = lower;
    h->upper[i] = upper;
}

static hulls *make_hulls(const double bounds[4], const optimum_polygon *polygons, size_t count) {
    size_t total = 1;
    for (size_t i = 0; i < count; i++) {
        total += polygons[i].count;
    }
    hulls *h = calloc(1, sizeof *h);
    if (h == NULL) {
        abort();
    }
    h->points = malloc(total * sizeof(vec));
    h->first = calloc(count + 1, sizeof(size_t));
    h->lower = calloc(count + 1, sizeof(vec));
    h->upper = calloc(count + 1, sizeof(vec));
    if (h->points == NULL || h->first == NULL || h->lower == NULL || h->upper == NULL) {
        abort();
    }
    h->count = count;
    h->bounds[0] = vec_of(bounds[0], bounds[1]);
    h->bounds[1] = vec_of(bounds[2], bounds[3]);
    for (size_t i = 0; i < count; i++) {
        h->first[i + 1] = h->first[i] + optimum_hull(polygons[i].points, polygons[i].count, &h->points[h->first[i]]);
        set_box(h, i);
    }
    return h;
}

optimum_world *optimum_polygons(double radius, const double bounds[4], const optimum_polygon *polygons, size_t count) {
    optimum_world *world = calloc(1, sizeof *world);
    if (world == NULL) {
        abort();
    }
    world->radius = radius;
    world->reach = (real)radius - (real)OPTIMUM_SLACK;
    world->obstacles = make_hulls(bounds, polygons, count);
    world->segment_free = segment_free;
    world->obstacles_free = hulls_free;
    for (size_t i = 0; i < count; i++) {
        add_hull(world, i);
    }
    return world;
}
