// World of occupied cells: everything outside the map is a wall.
#include "optimum_world.h"

#include <stdlib.h>
#include <string.h>

enum { FREE, CONTOUR, INNER };

// Lengths in this file are in cells, but for what the world shows.
typedef struct cells {
    uint32_t width, height; // with a rim of one occupied cell all round
    real resolution;
    uint8_t *kind;      // FREE, CONTOUR: occupied with a free one among the eight neighbours, INNER: other occupied
    uint16_t *to_right; // cells from here to the next contour cell in the row, 0: this is one; UINT16_MAX: none near
} cells;

typedef struct window {
    int side;       // offsets from -side to side - 1
    interval *cuts; // [quadrant][dy][dx]: what a cell so far from a corner blocks of the quadrant; from < 0: nothing
} window;

static bool is_occupied(const cells *c, const uint8_t *occupied, int64_t i, int64_t j) {
    bool rim = i <= 0 || j <= 0 || i >= (int64_t)c->width - 1 || j >= (int64_t)c->height - 1;
    return rim || occupied[(size_t)(j - 1) * (c->width - 2) + (size_t)(i - 1)] != 0;
}

static bool touches_free(const cells *c, const uint8_t *occupied, int64_t i, int64_t j) {
    for (int64_t y = j - 1; y <= j + 1; y++) {
        for (int64_t x = i - 1; x <= i + 1; x++) {
            if (!is_occupied(c, occupied, x, y)) {
                return true;
            }
        }
    }
    return false;
}

static void fill(cells *c, const uint8_t *occupied) {
    for (int64_t j = 0; j < c->height; j++) {
        uint16_t next = UINT16_MAX;
        for (int64_t i = (int64_t)c->width - 1; i >= 0; i--) {
            size_t at = (size_t)j * c->width + (size_t)i;
            bool is_contour = touches_free(c, occupied, i, j);
            c->kind[at] = !is_occupied(c, occupied, i, j) ? FREE : (is_contour ? CONTOUR : INNER);
            next = c->kind[at] == CONTOUR ? 0 : (uint16_t)(next < UINT16_MAX ? next + 1 : next);
            c->to_right[at] = next;
        }
    }
}

static void square_of(real x, real y, vec square[4]) {
    square[0] = vec_of(x, y);
    square[1] = vec_of(x + 1.0L, y);
    square[2] = vec_of(x + 1.0L, y + 1.0L);
    square[3] = vec_of(x, y + 1.0L);
}

static int64_t clamp_floor(real x, int64_t high) {
    real whole = floorl(x);
    return whole < 0.0L ? 0 : (whole > (real)high ? high : (int64_t)whole);
}

typedef struct strip {
    vec p, q;
    real reach;
} strip;

// Contour cells [from, to] of a row against the strip.
static bool row_free(const cells *c, int64_t j, int64_t from, int64_t to, const strip *s) {
    const uint16_t *to_right = &c->to_right[(size_t)j * c->width];
    vec pq = minus(s->q, s->p);
    real far = (s->reach + 0.7072L) * norm(pq);
    for (int64_t i = from; i <= to; i++) {
        if (to_right[i] > 0) {
            i += to_right[i] - 1;
            continue;
        }
        vec middle = vec_of((real)i + 0.5L, (real)j + 0.5L);
        if (fabsl(cross(pq, minus(middle, s->p))) > far) {
            continue;
        }
        vec square[4];
        square_of((real)i, (real)j, square);
        if (optimum_hits(square, 4, s->reach, s->p, s->q)) {
            return false;
        }
    }
    return true;
}

// A segment with free ends that is hit inside a region is hit by its contour first.
static bool segment_free(const optimum_world *world, vec p, vec q) {
    const cells *c = world->obstacles;
    real scale = 1.0L / c->resolution, reach = world->reach * scale;
    strip s = {plus(times(scale, p), vec_of(1.0L, 1.0L)), plus(times(scale, q), vec_of(1.0L, 1.0L)), reach};
    vec low = s.p.y <= s.q.y ? s.p : s.q, high = s.p.y <= s.q.y ? s.q : s.p;
    if (fminl(low.x, high.x) < 1.0L || fmaxl(low.x, high.x) > (real)c->width - 1.0L || low.y < 1.0L ||
        high.y > (real)c->height - 1.0L) {
        return false;
    }
    if (c->kind[(size_t)low.y * c->width + (size_t)low.x] != FREE) { // the rows below know the contour alone
        return false;
    }
    real slope = high.y > low.y ? (high.x - low.x) / (high.y - low.y) : 0.0L;
    int64_t last = clamp_floor(high.y + reach, (int64_t)c->height - 1);
    for (int64_t j = clamp_floor(low.y - reach, last); j <= last; j++) {
        real y0 = fmaxl((real)j - reach, low.y), y1 = fminl((real)j + 1.0L + reach, high.y);
        real x0 = y0 <= low.y ? low.x : low.x + slope * (y0 - low.y);
        real x1 = y1 >= high.y ? high.x : low.x + slope * (y1 - low.y);
        int64_t from = clamp_floor(fminl(x0, x1) - reach, (int64_t)c->width - 1);
        int64_t to = clamp_floor(fmaxl(x0, x1) + reach, (int64_t)c->width - 1);
        if (!row_free(c, j, from, to, &s)) {
            return false;
        }
    }
    return true;
}

static vec quadrant_lo(int quadrant) { // 0: up and right, on to the left
    static const vec lo[4] = {{1.0L, 0.0L}, {0.0L, 1.0L}, {-1.0L, 0.0L}, {0.0L, -1.0L}};
    return lo[quadrant];
}

static size_t cut_index(const window *w, int quadrant, int dx, int dy) {
    return ((size_t)quadrant * (size_t)(2 * w->side) + (size_t)(dy + w->side)) * (size_t)(2 * w->side) +
           (size_t)(dx + w->side);
}

// What a cell blocks of a circle depends on its offset alone. Of a quadrant it blocks one interval: a circle of radius R
// meets a shape grown by R in one piece.
static window make_window(real radius, real reach) {
    window w = {(int)ceill(2.0L * radius), NULL};
    w.cuts = malloc((size_t)(16 * w.side * w.side) * sizeof(interval));
    if (w.cuts == NULL) {
        abort();
    }
    intervals found = {0};
    real quarter = acosl(0.0L);
    for (int quadrant = 0; quadrant < 4; quadrant++) {
        for (int dy = -w.side; dy < w.side; dy++) {
            for (int dx = -w.side; dx < w.side; dx++) {
                vec square[4];
                square_of((real)dx, (real)dy, square);
                found.count = 0;
                optimum_block_arc(vec_of(0.0L, 0.0L), radius, quadrant_lo(quadrant), quarter, square, 4, reach, &found);
                interval *cut = &w.cuts[cut_index(&w, quadrant, dx, dy)];
                cut->from = found.count > 0 ? found.items[0].from : -1.0L;
                cut->to = found.count > 0 ? found.items[found.count - 1].to : -1.0L;
            }
        }
    }
    free(found.items);
    return w;
}

// Corner at the lattice point (i, j) of the cell on the other side of the quadrant.
static void add_corner(optimum_world *world, const window *w, int64_t i, int64_t j, int quadrant, intervals *blocked) {
    const cells *c = world->obstacles;
    real quarter = acosl(0.0L);
    blocked->count = 0;
    for (int dy = -w->side; dy < w->side; dy++) {
        int64_t y = j + dy;
        for (int dx = -w->side; dx < w->side && y >= 0 && y < c->height; dx++) {
            int64_t x = i + dx;
            if (x < 0 || x >= c->width || c->kind[(size_t)y * c->width + (size_t)x] != CONTOUR) {
                continue;
            }
            interval cut = w->cuts[cut_index(w, quadrant, dx, dy)];
            if (cut.from == 0.0L && cut.to == quarter) {
                return;
            }
            if (cut.from >= 0.0L) {
                optimum_add_interval(blocked, cut.from, cut.to);
            }
        }
    }
    vec center = vec_of((real)(i - 1) * c->resolution, (real)(j - 1) * c->resolution);
    optimum_add_arcs(world, center, quadrant_lo(quadrant), quarter, blocked);
}

static void add_corners(optimum_world *world, const uint8_t *occupied) {
    const cells *c = world->obstacles;
    static const int step[4][2] = {
        {0, 0}, {-1, 0}, {-1, -1}, {0, -1}}; // from a lattice point to the cell in quadrant q
    window w = make_window(world->radius / c->resolution, world->reach / c->resolution);
    intervals blocked = {0};
    for (int64_t j = 1; j < c->height; j++) {
        for (int64_t i = 1; i < c->width; i++) {
            int in = 0, opposite = 0;
            for (int q = 0; q < 4; q++) {
                if (is_occupied(c, occupied, i + step[q][0], j + step[q][1])) {
                    in++;
                    opposite = (q + 2) % 4;
                }
            }
            if (in == 1) { // where two cells meet in a corner, each blocks the other's
                add_corner(world, &w, i, j, opposite, &blocked);
            }
        }
    }
    free(blocked.items);
    free(w.cuts);
}

static void cells_free(void *obstacles) {
    cells *c = obstacles;
    free(c->kind);
    free(c->to_right);
    free(c);
}

optimum_world *optimum_grid(double radius, double resolution, uint32_t width, uint32_t height,
                            const uint8_t *occupied) {
    optimum_world *world = calloc(1, sizeof *world);
    cells *c = calloc(1, sizeof *c);
    if (world == NULL || c == NULL) {
        abort();
    }
    c->width = width + 2;
    c->height = height + 2;
    c->resolution = resolution;
    c->kind = calloc((size_t)c->width * c->height, 1);
    c->to_right = calloc((size_t)c->width * c->height, sizeof *c->to_right);
    if (c->kind == NULL || c->to_right == NULL) {
        abort();
    }
    fill(c, occupied);
    world->radius = radius;
    world->reach = (real)radius - (real)OPTIMUM_SLACK;
    world->obstacles = c;
    world->segment_free = segment_free;
    world->obstacles_free = cells_free;
    add_corners(world, occupied);
    return world;
}
