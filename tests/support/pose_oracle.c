#include "pose_oracle.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define PI 3.14159265358979323846
#define FREE_TO 0.005 // m, intervals that move less are not cut any more
#define NONE UINT32_MAX

static const int vectors[9][2] = {{1, 0}, {5, 1}, {5, 2}, {3, 2}, {1, 1}, {2, 3}, {2, 5}, {1, 5}, {0, 1}};

void pose_oracle_begin(pose_oracle *self, double width, double height) {
    memset(self, 0, sizeof *self);
    self->width = width;
    self->height = height;
}

static void take(pose_polygon *out, const double (*v)[2], int n) {
    memcpy(out->v, v, (size_t)n * sizeof v[0]);
    out->n = n;
    out->box[0] = out->box[1] = HUGE_VAL;
    out->box[2] = out->box[3] = -HUGE_VAL;
    for (int i = 0; i < n; i++) {
        for (int k = 0; k < 2; k++) {
            out->box[k] = fmin(out->box[k], v[i][k]);
            out->box[2 + k] = fmax(out->box[2 + k], v[i][k]);
        }
    }
}

void pose_oracle_add(pose_oracle *self, const double (*v)[2], int n) {
    if (self->polygons < POSE_ORACLE_POLYGONS && n >= 3 && n <= POSE_ORACLE_VERTICES) {
        take(&self->polygon[self->polygons++], v, n);
    }
}

void pose_oracle_body(pose_oracle *self, const double (*v)[2], int n, double margin, double radius_min) {
    take(&self->body, v, n);
    self->margin = margin;
    self->radius_min = radius_min;
}

// ---- distances

static void place(const pose_polygon *body, double x, double y, double theta, pose_polygon *out) {
    double c = cos(theta), s = sin(theta);
    double v[POSE_ORACLE_VERTICES][2];
    for (int i = 0; i < body->n; i++) {
        v[i][0] = x + c * body->v[i][0] - s * body->v[i][1];
        v[i][1] = y + s * body->v[i][0] + c * body->v[i][1];
    }
    take(out, (const double(*)[2])v, body->n);
}

static double squared_gap(const double *p, const double *a, const double *b) { // of a point and a segment
    double dx = b[0] - a[0], dy = b[1] - a[1];
    double square = dx * dx + dy * dy;
    double t = square > 0.0 ? ((p[0] - a[0]) * dx + (p[1] - a[1]) * dy) / square : 0.0;
    t = fmin(fmax(t, 0.0), 1.0);
    double x = p[0] - a[0] - t * dx, y = p[1] - a[1] - t * dy;
    return x * x + y * y;
}

// Is there an edge of p beyond which all of q lies?
static bool parted_by(const pose_polygon *p, const pose_polygon *q) {
    for (int i = 0; i < p->n; i++) {
        const double *a = p->v[i], *b = p->v[(i + 1) % p->n];
        bool all = true;
        for (int k = 0; k < q->n && all; k++) {
            all = (b[0] - a[0]) * (q->v[k][1] - a[1]) - (b[1] - a[1]) * (q->v[k][0] - a[0]) <= 0.0;
        }
        if (all) {
            return true;
        }
    }
    return false;
}

static double polygons_gap(const pose_polygon *p, const pose_polygon *q) {
    if (!parted_by(p, q) && !parted_by(q, p)) {
        return -1.0;
    }
    double least = HUGE_VAL;
    for (int i = 0; i < p->n; i++) {
        for (int k = 0; k < q->n; k++) {
            least = fmin(least, squared_gap(p->v[i], q->v[k], q->v[(k + 1) % q->n]));
            least = fmin(least, squared_gap(q->v[k], p->v[i], p->v[(i + 1) % p->n]));
        }
    }
    return sqrt(least);
}

static double gap_within(const pose_oracle *self, const pose_polygon *body, double cap) {
    double least =
        fmin(fmin(body->box[0], body->box[1]), fmin(self->width - body->box[2], self->height - body->box[3]));
    least = fmin(least, cap);
    for (int i = 0; i < self->polygons && least >= 0.0; i++) {
        const pose_polygon *p = &self->polygon[i];
        double dx = fmax(fmax(p->box[0] - body->box[2], body->box[0] - p->box[2]), 0.0);
        double dy = fmax(fmax(p->box[1] - body->box[3], body->box[1] - p->box[3]), 0.0);
        if (dx < least && dy < least) {
            least = fmin(least, polygons_gap(body, p));
        }
    }
    return least;
}

double pose_oracle_gap(const pose_oracle *self, double x, double y, double theta) {
    pose_polygon body;
    place(&self->body, x, y, theta, &body);
    return gap_within(self, &body, HUGE_VAL);
}

// ---- motions

typedef struct motion { // line of length a along theta, arc of turn and radius, line of length b
    double x, y, theta, a, radius, turn, b;
} motion;

static double lever(const pose_oracle *self) {
    double most = 0.0;
    for (int i = 0; i < self->body.n; i++) {
        most = fmax(most, hypot(self->body.v[i][0], self->body.v[i][1]));
    }
    return most;
}

static double arc_length(const motion *m) {
    return m->radius * fabs(m->turn);
}

// Shares f of the whole: by travel of the body's farthest point.
static void placed_at(const motion *m, double far, double f, double out[3]) {
    double turning = arc_length(m) + far * fabs(m->turn);
    double s = f * (m->a + turning + m->b);
    double a = fmin(s, m->a);
    double t = turning > 0.0 ? fmin(fmax((s - m->a) / turning, 0.0), 1.0) : 0.0;
    double b = fmax(s - m->a - turning, 0.0);
    double theta = m->theta + t * m->turn;
    double side = m->turn < 0.0 ? -1.0 : 1.0;
    double cx = m->x + m->a * cos(m->theta) - side * m->radius * sin(m->theta);
    double cy = m->y + m->a * sin(m->theta) + side * m->radius * cos(m->theta);
    out[0] = cx + side * m->radius * sin(theta) + (a - m->a) * cos(m->theta) + b * cos(theta);
    out[1] = cy - side * m->radius * cos(theta) + (a - m->a) * sin(m->theta) + b * sin(theta);
    out[2] = theta;
}

static bool motion_free(const pose_oracle *self, const motion *m) {
    double far = lever(self);
    double travel = m->a + arc_length(m) + far * fabs(m->turn) + m->b;
    double from = 0.0, ends[24];
    int depth = 1;
    ends[0] = 1.0;
    while (depth > 0) {
        double p[3], half = 0.5 * (ends[depth - 1] - from) * travel;
        pose_polygon body;
        placed_at(m, far, 0.5 * (from + ends[depth - 1]), p);
        place(&self->body, p[0], p[1], p[2], &body);
        double gap = gap_within(self, &body, self->margin + half + 1e-3);
        if (gap >= self->margin + half) {
            from = ends[--depth];
        } else if (gap < self->margin || 2.0 * half < FREE_TO || depth == 24) {
            return false;
        } else {
            ends[depth] = 0.5 * (from + ends[depth - 1]);
            depth++;
        }
    }
    return true;
}

// ---- the lattice

static uint32_t index_of(const pose_oracle *self, int ix, int iy, int k) {
    return ((uint32_t)k * (uint32_t)self->ny + (uint32_t)iy) * (uint32_t)self->nx + (uint32_t)ix;
}

static uint32_t root_of(const pose_oracle *self, uint32_t i) {
    while (self->parent[i] != i) {
        self->parent[i] = self->parent[self->parent[i]];
        i = self->parent[i];
    }
    return i;
}

static void join(pose_oracle *self, uint32_t a, uint32_t b) {
    a = root_of(self, a);
    b = root_of(self, b);
    self->parent[a > b ? a : b] = a > b ? b : a;
}

static void vector_of(int k, int out[2]) {
    k = ((k % POSE_ORACLE_HEADINGS) + POSE_ORACLE_HEADINGS) % POSE_ORACLE_HEADINGS;
    int quarter = k / 8;
    int x = vectors[k % 8][0], y = vectors[k % 8][1];
    for (; quarter > 0; quarter--) {
        int turned = -y;
        y = x;
        x = turned;
    }
    out[0] = x;
    out[1] = y;
}

double pose_oracle_heading(int k) {
    int v[2];
    vector_of(k, v);
    return atan2(v[1], v[0]);
}

static double heading_at(const pose_oracle *self, int k) {
    return self->headings == POSE_ORACLE_HEADINGS ? pose_oracle_heading(k) : 2.0 * PI * k / self->headings;
}

static bool begin_lattice(pose_oracle *self, int headings) {
    self->nx = (int)floor(self->width / POSE_ORACLE_STEP + 1e-6) + 1;
    self->ny = (int)floor(self->height / POSE_ORACLE_STEP + 1e-6) + 1;
    self->headings = headings;
    self->parent = (uint32_t *)malloc((size_t)self->nx * (size_t)self->ny * (size_t)headings * sizeof(uint32_t));
    return self->parent != NULL;
}

// m, of the largest disc about the origin inside the shape, and of the least around it.
static void discs(const pose_polygon *shape, double *inner, double *outer) {
    const double origin[2] = {0.0, 0.0};
    *inner = HUGE_VAL;
    *outer = 0.0;
    for (int i = 0; i < shape->n; i++) {
        *inner = fmin(*inner, sqrt(squared_gap(origin, shape->v[i], shape->v[(i + 1) % shape->n])));
        *outer = fmax(*outer, hypot(shape->v[i][0], shape->v[i][1]));
    }
}

static void open_headings(pose_oracle *self, const pose_polygon *shape, double margin, int ix, int iy) {
    for (int k = 0; k < self->headings; k++) {
        pose_polygon body;
        uint32_t i = index_of(self, ix, iy, k);
        place(shape, ix * POSE_ORACLE_STEP, iy * POSE_ORACLE_STEP, heading_at(self, k), &body);
        self->parent[i] = gap_within(self, &body, margin + 1e-3) >= margin ? i : NONE;
    }
}

// Every configuration whose body, this one, keeps `margin`. What the discs around and inside it decide is not looked at
// heading by heading.
static void open_places(pose_oracle *self, const pose_polygon *shape, double margin) {
    double inner, outer;
    discs(shape, &inner, &outer);
    for (int iy = 0; iy < self->ny; iy++) {
        for (int ix = 0; ix < self->nx; ix++) {
            pose_polygon point = {.v = {{ix * POSE_ORACLE_STEP, iy * POSE_ORACLE_STEP}}, .n = 1};
            point.box[0] = point.box[2] = point.v[0][0];
            point.box[1] = point.box[3] = point.v[0][1];
            double gap = gap_within(self, &point, outer + margin + 1e-3);
            if (gap >= inner + margin && gap < outer + margin) {
                open_headings(self, shape, margin, ix, iy);
                continue;
            }
            for (int k = 0; k < self->headings; k++) {
                uint32_t i = index_of(self, ix, iy, k);
                self->parent[i] = gap >= outer + margin ? i : NONE;
            }
        }
    }
}

static void try_motion(pose_oracle *self, uint32_t from, int ix, int iy, int k, const motion *m) {
    if (ix < 0 || iy < 0 || ix >= self->nx || iy >= self->ny) {
        return;
    }
    uint32_t to = index_of(self, ix, iy, ((k % self->headings) + self->headings) % self->headings);
    if (self->parent[to] == NONE || root_of(self, from) == root_of(self, to)) {
        return;
    }
    double end[3]; // a motion that does not end where it should would prove nothing
    placed_at(m, lever(self), 1.0, end);
    bool there = fabs(end[0] - ix * POSE_ORACLE_STEP) + fabs(end[1] - iy * POSE_ORACLE_STEP) < 1e-9;
    if (there && motion_free(self, m)) {
        join(self, from, to);
    }
}

static void try_straight(pose_oracle *self, int ix, int iy, int k) {
    int v[2];
    vector_of(k, v);
    motion m = {ix * POSE_ORACLE_STEP,
                iy * POSE_ORACLE_STEP,
                heading_at(self, k),
                hypot(v[0], v[1]) * POSE_ORACLE_STEP,
                0.0,
                0.0,
                0.0};
    try_motion(self, index_of(self, ix, iy, k), ix + v[0], iy + v[1], k, &m);
}

static void try_turn(pose_oracle *self, int ix, int iy, int k) {
    motion m = {ix * POSE_ORACLE_STEP,
                iy * POSE_ORACLE_STEP,
                heading_at(self, k),
                0.0,
                0.0,
                remainder(heading_at(self, k + 1) - heading_at(self, k), 2.0 * PI),
                0.0};
    try_motion(self, index_of(self, ix, iy, k), ix, iy, k + 1, &m);
}

// Line - arc - line to another heading, by the least lattice lengths that leave the arc its radius.
static void try_arc(pose_oracle *self, int ix, int iy, int k, int to) {
    int u[2], v[2];
    vector_of(k, u);
    vector_of(to, v);
    double turn = remainder(pose_oracle_heading(to) - pose_oracle_heading(k), 2.0 * PI);
    double cut = self->radius_min * tan(0.5 * fabs(turn));
    double step_u = hypot(u[0], u[1]) * POSE_ORACLE_STEP, step_v = hypot(v[0], v[1]) * POSE_ORACLE_STEP;
    int a = (int)ceil(cut / step_u), b = (int)ceil(cut / step_v);
    motion m = {ix * POSE_ORACLE_STEP, iy * POSE_ORACLE_STEP, pose_oracle_heading(k),
                a * step_u - cut,      self->radius_min,      turn,
                b * step_v - cut};
    try_motion(self, index_of(self, ix, iy, k), ix + a * u[0] + b * v[0], iy + a * u[1] + b * v[1], to, &m);
}

bool pose_oracle_connect(pose_oracle *self) {
    if (!begin_lattice(self, POSE_ORACLE_HEADINGS)) {
        return false;
    }
    open_places(self, &self->body, self->margin);
    for (int k = 0; k < self->headings; k++) {
        for (int iy = 0; iy < self->ny; iy++) {
            for (int ix = 0; ix < self->nx; ix++) {
                if (self->parent[index_of(self, ix, iy, k)] == NONE) {
                    continue;
                }
                try_straight(self, ix, iy, k);
                if (self->radius_min <= 0.0) {
                    try_turn(self, ix, iy, k);
                } else {
                    for (int d = -2; d <= 2; d++) {
                        if (d != 0) {
                            try_arc(self, ix, iy, k, k + d);
                        }
                    }
                }
            }
        }
    }
    return true;
}

// The body less a rim of this width: the sides moved inwards. Right for rectangles and other shapes whose sides stay.
static void shrink(const pose_polygon *body, double rim, pose_polygon *out) {
    double v[POSE_ORACLE_VERTICES][2];
    for (int i = 0; i < body->n; i++) { // corner i: between the side before it and the one after
        const double *p = body->v[(i + body->n - 1) % body->n], *q = body->v[i], *r = body->v[(i + 1) % body->n];
        double ux = q[0] - p[0], uy = q[1] - p[1], wx = r[0] - q[0], wy = r[1] - q[1];
        double lu = hypot(ux, uy), lw = hypot(wx, wy);
        double sine = (ux * wy - uy * wx) / (lu * lw), cosine = (ux * wx + uy * wy) / (lu * lw);
        double along = rim * (1.0 + cosine) / sine; // back along the side before, then inwards
        v[i][0] = q[0] - along * ux / lu - rim * uy / lu;
        v[i][1] = q[1] - along * uy / lu + rim * ux / lu;
    }
    take(out, (const double(*)[2])v, body->n);
}

bool pose_oracle_enclose(pose_oracle *self) {
    if (!begin_lattice(self, 4 * POSE_ORACLE_HEADINGS)) {
        return false;
    }
    double off = POSE_ORACLE_STEP * sqrt(0.5) + lever(self) * PI / self->headings + 1e-6;
    pose_polygon shape = self->body;
    if (off > self->margin) {
        shrink(&self->body, off - self->margin, &shape);
    }
    open_places(self, &shape, fmax(self->margin - off, 0.0));
    for (int k = 0; k < self->headings; k++) {
        for (int iy = 0; iy < self->ny; iy++) {
            for (int ix = 0; ix < self->nx; ix++) {
                uint32_t i = index_of(self, ix, iy, k);
                for (int d = 0; d < 18 && self->parent[i] != NONE; d++) { // the half of the neighbours that is behind
                    int x = ix + d % 3 - 1, y = iy + d / 3 % 3 - 1, at = d < 9 ? k : (k + 1) % self->headings;
                    if (x >= 0 && y >= 0 && x < self->nx && y < self->ny &&
                        self->parent[index_of(self, x, y, at)] != NONE) {
                        join(self, i, index_of(self, x, y, at));
                    }
                }
            }
        }
    }
    return true;
}

void pose_oracle_end(pose_oracle *self) {
    free(self->parent);
    self->parent = NULL;
}

static int heading_index(const pose_oracle *self, double theta) {
    int best = 0;
    for (int k = 1; k < self->headings; k++) {
        double off = fabs(remainder(theta - heading_at(self, k), 2.0 * PI));
        best = off < fabs(remainder(theta - heading_at(self, best), 2.0 * PI)) ? k : best;
    }
    return best;
}

// Root of the configuration, at its heading or at the k-th; NONE: not free.
static uint32_t group_of(const pose_oracle *self, const double p[3], int k) {
    int ix = (int)floor(p[0] / POSE_ORACLE_STEP + 0.5), iy = (int)floor(p[1] / POSE_ORACLE_STEP + 0.5);
    if (ix < 0 || iy < 0 || ix >= self->nx || iy >= self->ny) {
        return NONE;
    }
    uint32_t i = index_of(self, ix, iy, isnan(p[2]) ? k : heading_index(self, p[2]));
    return self->parent[i] == NONE ? NONE : root_of(self, i);
}

bool pose_oracle_joined(const pose_oracle *self, const double from[3], const double to[3]) {
    int many = isnan(from[2]) ? self->headings : 1, more = isnan(to[2]) ? self->headings : 1;
    for (int i = 0; i < many; i++) {
        uint32_t group = group_of(self, from, i);
        for (int k = 0; k < more && group != NONE; k++) {
            if (group_of(self, to, k) == group) {
                return true;
            }
        }
    }
    return false;
}
