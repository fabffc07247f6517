#include "spacetime_oracle.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define PI 3.14159265358979323846
#define TURN (2.0 * PI / SPACETIME_DIRS)
#define STEP_LEAST 0.5 // s
#define STEP_MOST 1.0  // s
#define STEP_WAY 0.6   // m at full speed, roughly
#define LOOK 0.2       // s between looks in a step
#define CREEP_CELLS 3.0
#define SWEEP 0.08        // m between places looked at on a step
#define BRAKE 0.08        // m between places looked at on a brake path
#define ROUNDING 1.42     // cells: mover and vehicle each by half a diagonal
#define SIDEWAYS 1.0      // what a cell to the side of its direction costs a step, cells
#define CLEARANCE_CAP 3.0 // m

typedef struct spacetime_step {
    int dx, dy; // cells; 0, 0: there is none
    spacetime_bits from;
} spacetime_step;

typedef struct spacetime_template { // cells that a mover in cell (0, 0) rules out: rows lo..lo + count - 1
    int lo, count;
    int *span; // [2 * count], first and last cell; first > last: none
} spacetime_template;

// ---- geometry

static double to_segment(double x, double y, const double *a, const double *b) {
    double dx = b[0] - a[0], dy = b[1] - a[1], square = dx * dx + dy * dy;
    double t = square > 0.0 ? fmin(fmax(((x - a[0]) * dx + (y - a[1]) * dy) / square, 0.0), 1.0) : 0.0;
    return hypot(x - a[0] - t * dx, y - a[1] - t * dy);
}

static double to_polygon(const spacetime_polygon *p, double x, double y) {
    double least = HUGE_VAL;
    bool inside = true;
    for (int i = 0; i < p->n; i++) {
        const double *a = p->v[i], *b = p->v[(i + 1) % p->n];
        inside = inside && (b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0]) >= 0.0;
        least = fmin(least, to_segment(x, y, a, b));
    }
    return inside ? 0.0 : least;
}

static void box_of(const spacetime_polygon *p, double box[4]) {
    box[0] = box[1] = HUGE_VAL;
    box[2] = box[3] = -HUGE_VAL;
    for (int i = 0; i < p->n; i++) {
        for (int k = 0; k < 2; k++) {
            box[k] = fmin(box[k], p->v[i][k]);
            box[2 + k] = fmax(box[2 + k], p->v[i][k]);
        }
    }
}

bool spacetime_mover_at(const spacetime_mover *mover, double t, double *x, double *y) {
    int lo = 0, hi = mover->count - 1;
    if (hi < 0 || t < mover->sample[0][0] || t > mover->sample[hi][0]) {
        return false;
    }
    while (hi - lo > 1) {
        int middle = (lo + hi) / 2;
        lo = mover->sample[middle][0] <= t ? middle : lo;
        hi = mover->sample[middle][0] <= t ? hi : middle;
    }
    const double *a = mover->sample[lo], *b = mover->sample[hi];
    double share = b[0] > a[0] ? (t - a[0]) / (b[0] - a[0]) : 0.0;
    *x = a[1] + share * (b[1] - a[1]);
    *y = a[2] + share * (b[2] - a[2]);
    return true;
}

// ---- what the vehicle can do in a step

double spacetime_gone(const spacetime_oracle *self, int from, int to, double tau, double *speed) {
    const spacetime_vehicle *v = &self->problem->vehicle;
    double v0 = self->speed[from], v1 = self->speed[to];
    if (v1 >= v0) { // gains speed at once
        double ramp = fmin((v1 - v0) / v->a_max, tau);
        *speed = fmin(v0 + v->a_max * tau, v1);
        return v0 * ramp + 0.5 * v->a_max * ramp * ramp + v1 * (tau - ramp);
    }
    double late = fmax(tau - (self->dt - (v0 - v1) / v->d_max), 0.0); // brakes at the end
    *speed = v0 - v->d_max * late;
    return v0 * tau - 0.5 * v->d_max * late * late;
}

void spacetime_move(const spacetime_oracle *self, int dir, int from, int to, int *dx, int *dy) {
    double change = self->speed[to] - self->speed[from], unused, best = 0.5;
    const spacetime_vehicle *v = &self->problem->vehicle;
    *dx = *dy = 0;
    if (change > v->a_max * self->dt + 1e-9 || -change > v->d_max * self->dt + 1e-9) {
        return;
    }
    double reach = spacetime_gone(self, from, to, self->dt, &unused) / self->h * (1.0 + 1e-9);
    double ux = cos(TURN * dir), uy = sin(TURN * dir);
    for (int y = (int)-reach; y <= (int)reach; y++) {
        for (int x = (int)-reach; x <= (int)reach; x++) {
            double along = x * ux + y * uy - SIDEWAYS * fabs(x * uy - y * ux);
            if (hypot(x, y) <= reach && along > best + 1e-9) {
                best = along;
                *dx = x;
                *dy = y;
            }
        }
    }
}

static void choose_lattice(spacetime_oracle *self) {
    const spacetime_vehicle *v = &self->problem->vehicle;
    double creep = fmin(v->creep_speed, v->v_max), step = fmin(fmax(STEP_WAY / v->v_max, STEP_LEAST), STEP_MOST);
    double change = fmin(v->a_max, v->d_max); // between neighbouring levels within a step, up and down
    step = fmax(fmax(step, creep / change), TURN / v->omega_max);
    step = fmax(step, (v->v_max - creep) / (change * (SPACETIME_LEVELS - 2)));
    int more = (int)ceil((v->v_max - creep) / (change * step) - 1e-9);
    more = more == 1 && v->v_max > 2.0 * creep ? 2 : more; // a choice
    self->dt = step;
    self->levels = 2 + more;
    self->speed[0] = 0.0;
    for (int i = 0; i <= more; i++) {
        self->speed[1 + i] = creep + (more > 0 ? (v->v_max - creep) * i / more : 0.0);
    }
    self->subs = (int)ceil(step / LOOK - 1e-9);
    self->h = creep * step / CREEP_CELLS;
}

static void cover_body(spacetime_oracle *self) {
    const spacetime_vehicle *v = &self->problem->vehicle;
    double box[4] = {0.0, 0.0, 0.0, 0.0}, half;
    self->outer = 0.0;
    if (v->body.n > 0) {
        box_of(&v->body, box);
    }
    for (int i = 0; i < v->body.n; i++) {
        self->outer = fmax(self->outer, hypot(v->body.v[i][0], v->body.v[i][1]));
    }
    self->outer += v->radius;
    half = fmax(fabs(box[1]), fabs(box[3]));
    double length = box[2] - box[0];
    self->discs = half > 0.0 ? (int)fmin(ceil(length / (0.7 * half)), SPACETIME_DISCS) : 1;
    double each = length / self->discs;
    for (int i = 0; i < self->discs; i++) {
        self->disc[i] = box[0] + (i + 0.5) * each;
    }
    self->disc_radius = hypot(half, 0.5 * each) + v->radius;
}

// ---- what stands still

static void measure_polygon(spacetime_oracle *self, const spacetime_polygon *p) {
    const spacetime_problem *problem = self->problem;
    double box[4];
    box_of(p, box);
    for (int y = 0; y < self->ny; y++) {
        double py = problem->start[1] + (y + self->y0) * self->h;
        double dy = fmax(fmax(box[1] - py, py - box[3]), 0.0);
        for (int x = 0; x < self->nx && dy < CLEARANCE_CAP; x++) {
            double px = problem->start[0] + (x + self->x0) * self->h;
            double dx = fmax(fmax(box[0] - px, px - box[2]), 0.0), *out = &self->clearance[y * self->nx + x];
            if (fmax(dx, dy) < *out) {
                *out = fmin(*out, to_polygon(p, px, py));
            }
        }
    }
}

static bool measure_clearance(spacetime_oracle *self) {
    const spacetime_problem *problem = self->problem;
    self->clearance = malloc((size_t)self->nx * (size_t)self->ny * sizeof *self->clearance);
    if (self->clearance == NULL) {
        return false;
    }
    for (int y = 0; y < self->ny; y++) {
        double py = problem->start[1] + (y + self->y0) * self->h;
        double dy = fmin(py - problem->y_min, problem->y_max - py);
        for (int x = 0; x < self->nx; x++) {
            double px = problem->start[0] + (x + self->x0) * self->h;
            double dx = fmin(px - problem->x_min, problem->x_max - px);
            self->clearance[y * self->nx + x] = fmin(fmin(dx, dy), CLEARANCE_CAP);
        }
    }
    for (int i = 0; i < problem->polygons; i++) {
        measure_polygon(self, &problem->polygon[i]);
    }
    return true;
}

static void fill_free(const spacetime_oracle *self, double least, spacetime_bits *out) {
    spacetime_bits_clear(out);
    for (int y = 0; y < self->ny; y++) {
        for (int x = 0; x < self->nx; x++) {
            if (self->clearance[y * self->nx + x] >= least) {
                spacetime_bits_put(out, x, y);
            }
        }
    }
}

// Keeps the cells from which the body, driven along a step, stays in `free`.
static void keep_step(const spacetime_oracle *self, int dir, spacetime_step *step, const spacetime_bits *free) {
    int samples = 1 + (int)ceil(hypot(step->dx, step->dy) * self->h / SWEEP);
    double ux = cos(TURN * dir) / self->h, uy = sin(TURN * dir) / self->h;
    for (int s = 0; s <= samples; s++) {
        double share = (double)s / samples;
        for (int i = 0; i < self->discs; i++) {
            int dx = (int)lround(share * step->dx + self->disc[i] * ux);
            int dy = (int)lround(share * step->dy + self->disc[i] * uy);
            spacetime_bits_and_at(&step->from, free, dx, dy);
        }
    }
}

static spacetime_step *step_of(const spacetime_oracle *self, int dir, int from, int to) {
    return &self->step[(dir * self->levels + from) * self->levels + to];
}

static bool make_steps(spacetime_oracle *self) {
    const spacetime_vehicle *v = &self->problem->vehicle;
    spacetime_bits slow, fast;
    bool good = spacetime_bits_begin(&slow, self->nx, self->ny) && spacetime_bits_begin(&fast, self->nx, self->ny);
    self->step = calloc((size_t)(SPACETIME_DIRS * self->levels * self->levels), sizeof *self->step);
    good = good && self->step != NULL;
    if (good) {
        fill_free(self, self->disc_radius + v->margin + 0.5 * ROUNDING * self->h, &slow);
        fill_free(self, self->disc_radius + fmax(v->margin, v->creep_clearance), &fast);
        spacetime_bits_and(&fast, &slow);
    }
    for (int i = 0; i < SPACETIME_DIRS * self->levels * self->levels && good; i++) {
        int dir = i / (self->levels * self->levels), from = i / self->levels % self->levels, to = i % self->levels;
        spacetime_step *step = step_of(self, dir, from, to);
        spacetime_move(self, dir, from, to, &step->dx, &step->dy);
        good = spacetime_bits_begin(&step->from, self->nx, self->ny);
        if (good && (step->dx != 0 || step->dy != 0)) {
            fill_free(self, -HUGE_VAL, &step->from); // all cells, then those from which the body has room
            keep_step(self, dir, step, from <= 1 && to <= 1 ? &slow : &fast);
        }
    }
    spacetime_bits_end(&slow);
    spacetime_bits_end(&fast);
    return good;
}

// ---- movers: what they rule out

// Adds the cells within `radius` of (x, y), in cells.
static void add_disc(spacetime_template *out, double x, double y, double radius) {
    for (int i = 0; i < out->count; i++) {
        double dy = out->lo + i - y, square = radius * radius - dy * dy;
        if (square > 0.0) {
            int first = (int)ceil(x - sqrt(square)), last = (int)floor(x + sqrt(square));
            out->span[2 * i] = first < out->span[2 * i] ? first : out->span[2 * i];
            out->span[2 * i + 1] = last > out->span[2 * i + 1] ? last : out->span[2 * i + 1];
        }
    }
}

static bool begin_template(spacetime_template *out, double reach) {
    out->lo = (int)floor(-reach);
    out->count = 2 * -out->lo + 1;
    out->span = malloc(2 * (size_t)out->count * sizeof *out->span);
    for (int i = 0; i < out->count && out->span != NULL; i++) {
        out->span[2 * i] = 1 << 20;
        out->span[2 * i + 1] = -(1 << 20);
    }
    return out->span != NULL;
}

// Cells from which a vehicle at speed `v` in direction `dir` cannot be at rest in time, for a mover in cell (0, 0).
static bool make_braking(const spacetime_oracle *self, const spacetime_mover *m, int dir, double v,
                         spacetime_template *out) {
    const spacetime_vehicle *car = &self->problem->vehicle;
    double rest = car->reaction_time + v / car->d_max, way = v * car->reaction_time + 0.5 * v * v / car->d_max;
    double ux = cos(TURN * dir), uy = sin(TURN * dir), body = self->disc_radius + car->margin + m->radius;
    double most = body + m->v_bound * rest + ROUNDING * self->h;
    int looks = 1 + (int)ceil(fmax(way / BRAKE, rest / 0.05));
    if (!begin_template(out, (most + way + self->outer) / self->h + 1.0)) {
        return false;
    }
    for (int k = 0; k <= looks; k++) {
        double tau = rest * k / looks, late = fmax(tau - car->reaction_time, 0.0);
        double s = v * tau - 0.5 * car->d_max * late * late;
        double radius = (body + m->v_bound * tau + ROUNDING * self->h) / self->h;
        for (int i = 0; i < self->discs; i++) {
            add_disc(out, -(s + self->disc[i]) * ux / self->h, -(s + self->disc[i]) * uy / self->h, radius);
        }
    }
    return true;
}

static bool make_turning(const spacetime_oracle *self, const spacetime_mover *m, spacetime_template *out) {
    const spacetime_vehicle *car = &self->problem->vehicle;
    double rest = car->reaction_time + fmin(car->omega_max, sqrt(car->alpha_max * TURN)) / car->alpha_max;
    double radius = self->outer + car->margin + m->radius + m->v_bound * rest + ROUNDING * self->h;
    bool good = begin_template(out, radius / self->h + 1.0);
    if (good) {
        add_disc(out, 0.0, 0.0, radius / self->h);
    }
    return good;
}

// The template of a mover for a direction and a level, `levels` meaning turns on the spot. Movers alike share one.
static const spacetime_template *template_of(spacetime_oracle *self, int mover, int dir, int level) {
    const spacetime_mover *m = &self->problem->mover[mover];
    int first = 0;
    while (self->problem->mover[first].radius != m->radius || self->problem->mover[first].v_bound != m->v_bound) {
        first++;
    }
    dir = level == self->levels ? 0 : dir;
    spacetime_template *out = &self->shadow[(first * SPACETIME_DIRS + dir) * (self->levels + 1) + level];
    if (out->span == NULL) {
        bool good =
            level == self->levels ? make_turning(self, m, out) : make_braking(self, m, dir, self->speed[level], out);
        if (!good) {
            abort(); // a tool for tests: no memory ends it
        }
    }
    return out;
}

// Takes out of `cells` those that are not safe at time t for a vehicle (dx, dy) cells from there.
static void take_out_unsafe(spacetime_oracle *self, spacetime_bits *cells, int dir, int level, double t, int dx,
                            int dy) {
    const spacetime_problem *problem = self->problem;
    double x, y;
    for (int i = 0; i < problem->movers && !self->blind; i++) {
        if (!spacetime_mover_at(&problem->mover[i], t, &x, &y)) {
            continue;
        }
        const spacetime_template *shadow = template_of(self, i, dir, level);
        int cx = (int)lround((x - problem->start[0]) / self->h) - self->x0 - dx;
        int cy = (int)lround((y - problem->start[1]) / self->h) - self->y0 - dy;
        for (int k = 0; k < shadow->count; k++) {
            spacetime_bits_take_out(cells, cy + shadow->lo + k, cx + shadow->span[2 * k], cx + shadow->span[2 * k + 1]);
        }
    }
}

// ---- the search

static spacetime_bits *plane(spacetime_bits *layer, const spacetime_oracle *self, int dir, int level) {
    return &layer[((dir + SPACETIME_DIRS) % SPACETIME_DIRS) * self->levels + level];
}

static int level_for(const spacetime_oracle *self, double speed) {
    int level = 0;
    while (level + 1 < self->levels && self->speed[level] < speed - 1e-9) {
        level++;
    }
    return level;
}

// Cells of `layer` (at time t) from which a vehicle sets out in direction `dir` at a level, after a change of heading.
static void set_out(spacetime_oracle *self, spacetime_bits *layer, double t, int dir, int level) {
    spacetime_bits_copy(&self->from, plane(layer, self, dir, level));
    if (level > 0) {
        spacetime_bits_or(&self->from, plane(layer, self, dir - 1, level));
        spacetime_bits_or(&self->from, plane(layer, self, dir + 1, level));
    }
    take_out_unsafe(self, &self->from, dir, level, t, 0, 0);
}

// Of those, into step_from, the ones that can go on to level `to`. False: none.
static bool go_on(spacetime_oracle *self, double t, int dir, int from, int to) {
    const spacetime_step *step = step_of(self, dir, from, to);
    double speed, whole = spacetime_gone(self, from, to, self->dt, &speed);
    if (step->dx == 0 && step->dy == 0) {
        return false;
    }
    spacetime_bits_copy(&self->step_from, &self->from);
    spacetime_bits_and(&self->step_from, &step->from);
    for (int i = 1; i < self->subs; i++) {
        double tau = self->dt * i / self->subs, share = spacetime_gone(self, from, to, tau, &speed) / whole;
        take_out_unsafe(self, &self->step_from, dir, level_for(self, speed), t + tau, (int)lround(share * step->dx),
                        (int)lround(share * step->dy));
    }
    return true;
}

// Cells from which a turn to the next heading is possible, into step_from.
static void turn_on(spacetime_oracle *self, spacetime_bits *layer, double t, int dir) {
    spacetime_bits_copy(&self->step_from, plane(layer, self, dir, 0));
    spacetime_bits_and(&self->step_from, &self->free_to_turn);
    for (int i = 0; i < self->subs; i++) {
        take_out_unsafe(self, &self->step_from, dir, self->levels, t + self->dt * i / self->subs, 0, 0);
    }
}

static void advance_dir(spacetime_oracle *self, double t, int dir) {
    for (int from = 0; from < self->levels; from++) {
        set_out(self, self->now, t, dir, from);
        if (spacetime_bits_is_empty(&self->from)) {
            continue;
        }
        for (int to = 0; to < self->levels; to++) {
            const spacetime_step *step = step_of(self, dir, from, to);
            if (go_on(self, t, dir, from, to)) {
                spacetime_bits_or_moved(plane(self->next, self, dir, to), &self->step_from, step->dx, step->dy);
            }
        }
    }
    turn_on(self, self->now, t, dir);
    spacetime_bits_or(plane(self->next, self, dir - 1, 0), &self->step_from);
    spacetime_bits_or(plane(self->next, self, dir + 1, 0), &self->step_from);
    spacetime_bits_or(plane(self->next, self, dir, 0), plane(self->now, self, dir, 0)); // waits
}

static void advance(spacetime_oracle *self, double t) {
    for (int i = 0; i < SPACETIME_DIRS * self->levels; i++) {
        spacetime_bits_clear(&self->next[i]);
    }
    for (int dir = 0; dir < SPACETIME_DIRS; dir++) {
        advance_dir(self, t, dir);
    }
    for (int dir = 0; dir < SPACETIME_DIRS; dir++) {
        for (int level = 1; level < self->levels; level++) {
            take_out_unsafe(self, plane(self->next, self, dir, level), dir, level, t + self->dt, 0, 0);
        }
    }
    spacetime_bits *last = self->now;
    self->now = self->next;
    self->next = last;
}

static bool keep_layer(spacetime_oracle *self) {
    int planes = SPACETIME_DIRS * self->levels;
    if (!self->keep) {
        return true;
    }
    if (self->layers == self->layers_capacity) {
        int capacity = 2 * self->layers_capacity + 16;
        spacetime_bits *more = realloc(self->layer, (size_t)(capacity * planes) * sizeof *more);
        if (more == NULL) {
            return false;
        }
        self->layer = more;
        self->layers_capacity = capacity;
    }
    for (int i = 0; i < planes; i++) {
        spacetime_bits *out = &self->layer[self->layers * planes + i];
        if (!spacetime_bits_begin(out, self->nx, self->ny)) {
            return false;
        }
        spacetime_bits_copy(out, &self->now[i]);
    }
    self->layers++;
    return true;
}

static void forget_layers(spacetime_oracle *self) {
    for (int i = 0; i < self->layers * SPACETIME_DIRS * self->levels; i++) {
        spacetime_bits_end(&self->layer[i]);
    }
    self->layers = 0;
}

static bool heading_fits(const spacetime_goal *goal, int dir) {
    double off = fabs(remainder(TURN * dir - goal->theta, 2.0 * PI));
    return goal->tolerance_theta >= PI || off <= fmax(goal->tolerance_theta, 0.5 * TURN) + 1e-9;
}

// The cells at a goal.
static void mark_goal(spacetime_oracle *self, const spacetime_goal *goal) {
    double x = (goal->x - self->problem->start[0]) / self->h - self->x0;
    double y = (goal->y - self->problem->start[1]) / self->h - self->y0, r = fmax(goal->tolerance / self->h, 0.71);
    spacetime_bits_clear(&self->goal);
    for (int cy = (int)ceil(y - r); cy <= (int)floor(y + r); cy++) {
        for (int cx = (int)ceil(x - r); cx <= (int)floor(x + r); cx++) {
            if (hypot(cx - x, cy - y) <= r && cx >= 0 && cy >= 0 && cx < self->nx && cy < self->ny) {
                spacetime_bits_put(&self->goal, cx, cy);
            }
        }
    }
}

static bool is_there(spacetime_oracle *self, const spacetime_goal *goal) {
    for (int dir = 0; dir < SPACETIME_DIRS; dir++) {
        if (heading_fits(goal, dir) && spacetime_bits_meet(plane(self->now, self, dir, 0), &self->goal)) {
            return true;
        }
    }
    return false;
}

// Leaves only what rests at the goal, to go on from.
static void rest_at(spacetime_oracle *self, const spacetime_goal *goal) {
    for (int i = 0; i < SPACETIME_DIRS * self->levels; i++) {
        if (i % self->levels == 0 && heading_fits(goal, i / self->levels)) {
            spacetime_bits_and(&self->now[i], &self->goal);
        } else {
            spacetime_bits_clear(&self->now[i]);
        }
    }
}

spacetime_verdict spacetime_run(spacetime_oracle *self, double *done, double *arrival) {
    const spacetime_problem *problem = self->problem;
    double t = problem->t_start;
    for (int i = 0; i < SPACETIME_DIRS * self->levels; i++) {
        spacetime_bits_clear(&self->now[i]);
    }
    forget_layers(self);
    if (self->clearance[-self->y0 * self->nx - self->x0] < self->disc_radius + problem->vehicle.margin) {
        return SPACETIME_NOT_DECIDED;
    }
    int dir = (int)lround(problem->start[2] / TURN);
    spacetime_bits_put(plane(self->now, self, (dir % SPACETIME_DIRS) + SPACETIME_DIRS, 0), -self->x0, -self->y0);
    for (int i = 0; i < problem->goals; i++) {
        const spacetime_goal *goal = &problem->goal[i];
        mark_goal(self, goal);
        bool kept = keep_layer(self);
        while (!is_there(self, goal) && t < problem->t_end && kept) {
            advance(self, t);
            t += self->dt;
            kept = keep_layer(self);
        }
        if (!kept || !is_there(self, goal) || t + goal->dwell > problem->t_end) {
            return kept ? SPACETIME_NONE : SPACETIME_NOT_DECIDED;
        }
        rest_at(self, goal);
        t += goal->dwell;
        if (arrival != NULL) {
            arrival[i] = t;
        }
    }
    *done = t;
    return SPACETIME_FOUND;
}

// ---- tracing a way back

static bool came_by_step(spacetime_oracle *self, spacetime_bits *layer, double t, const spacetime_state *to,
                         spacetime_state *from) {
    for (int level = self->levels - 1; level >= 0; level--) {
        const spacetime_step *step = step_of(self, to->dir, level, to->level);
        set_out(self, layer, t, to->dir, level);
        if (!go_on(self, t, to->dir, level, to->level) ||
            !spacetime_bits_has(&self->step_from, to->x - step->dx, to->y - step->dy)) {
            continue;
        }
        *from = (spacetime_state){to->x - step->dx, to->y - step->dy, to->dir, level};
        for (int turn = -1; turn <= 1; turn++) {
            if (spacetime_bits_has(plane(layer, self, to->dir + turn, level), from->x, from->y)) {
                from->dir = (to->dir + turn + SPACETIME_DIRS) % SPACETIME_DIRS;
                return true;
            }
        }
    }
    return false;
}

static bool came_by_turn(spacetime_oracle *self, spacetime_bits *layer, double t, const spacetime_state *to,
                         spacetime_state *from) {
    for (int turn = -1; turn <= 1 && to->level == 0; turn += 2) {
        turn_on(self, layer, t, to->dir + turn);
        if (spacetime_bits_has(&self->step_from, to->x, to->y)) {
            *from = *to;
            from->dir = (to->dir + turn + SPACETIME_DIRS) % SPACETIME_DIRS;
            return true;
        }
    }
    return false;
}

static bool find_end(spacetime_oracle *self, spacetime_state *end) {
    spacetime_bits *layer = &self->layer[(self->layers - 1) * SPACETIME_DIRS * self->levels];
    for (int dir = 0; dir < SPACETIME_DIRS; dir++) {
        for (int y = self->goal.lo; y < self->goal.hi && heading_fits(&self->problem->goal[0], dir); y++) {
            for (int x = 0; x < self->nx; x++) {
                if (spacetime_bits_has(&self->goal, x, y) && spacetime_bits_has(plane(layer, self, dir, 0), x, y)) {
                    *end = (spacetime_state){x, y, dir, 0};
                    return true;
                }
            }
        }
    }
    return false;
}

int spacetime_trace(spacetime_oracle *self, spacetime_state *way, int capacity) {
    int count = self->layers;
    if (count == 0 || count > capacity || !find_end(self, &way[count - 1])) {
        return 0;
    }
    for (int k = count - 2; k >= 0; k--) {
        spacetime_bits *layer = &self->layer[k * SPACETIME_DIRS * self->levels];
        double t = self->problem->t_start + k * self->dt;
        const spacetime_state *to = &way[k + 1];
        if (to->level == 0 && spacetime_bits_has(plane(layer, self, to->dir, 0), to->x, to->y)) {
            way[k] = *to;
        } else if (!came_by_step(self, layer, t, to, &way[k]) && !came_by_turn(self, layer, t, to, &way[k])) {
            return 0;
        }
    }
    return count;
}

// ---- beginning and end

static bool begin_planes(spacetime_oracle *self) {
    int planes = SPACETIME_DIRS * self->levels, shadows = self->problem->movers * SPACETIME_DIRS * (self->levels + 1);
    self->now = calloc((size_t)planes, sizeof *self->now);
    self->next = calloc((size_t)planes, sizeof *self->next);
    self->shadow = calloc((size_t)(shadows > 0 ? shadows : 1), sizeof *self->shadow);
    bool good = self->now != NULL && self->next != NULL && self->shadow != NULL;
    for (int i = 0; i < planes && good; i++) {
        good = spacetime_bits_begin(&self->now[i], self->nx, self->ny) &&
               spacetime_bits_begin(&self->next[i], self->nx, self->ny);
    }
    return good && spacetime_bits_begin(&self->from, self->nx, self->ny) &&
           spacetime_bits_begin(&self->step_from, self->nx, self->ny) &&
           spacetime_bits_begin(&self->goal, self->nx, self->ny) &&
           spacetime_bits_begin(&self->free_to_turn, self->nx, self->ny);
}

bool spacetime_begin(spacetime_oracle *self, const spacetime_problem *problem) {
    memset(self, 0, sizeof *self);
    self->problem = problem;
    choose_lattice(self);
    cover_body(self);
    self->x0 = (int)ceil((problem->x_min - problem->start[0]) / self->h);
    self->y0 = (int)ceil((problem->y_min - problem->start[1]) / self->h);
    self->nx = (int)floor((problem->x_max - problem->start[0]) / self->h) - self->x0 + 1;
    self->ny = (int)floor((problem->y_max - problem->start[1]) / self->h) - self->y0 + 1;
    if (self->x0 > 0 || self->y0 > 0 || self->nx <= -self->x0 || self->ny <= -self->y0) {
        return false;
    }
    bool good = begin_planes(self) && measure_clearance(self) && make_steps(self);
    if (good) {
        fill_free(self, self->outer + problem->vehicle.margin, &self->free_to_turn);
    }
    return good;
}

void spacetime_end(spacetime_oracle *self) {
    int planes = SPACETIME_DIRS * self->levels;
    forget_layers(self);
    for (int i = 0; i < planes && self->now != NULL && self->next != NULL; i++) {
        spacetime_bits_end(&self->now[i]);
        spacetime_bits_end(&self->next[i]);
    }
    for (int i = 0; i < planes * self->levels && self->step != NULL; i++) {
        spacetime_bits_end(&self->step[i].from);
    }
    for (int i = 0; i < self->problem->movers * SPACETIME_DIRS * (self->levels + 1) && self->shadow != NULL; i++) {
        free(self->shadow[i].span);
    }
    spacetime_bits_end(&self->from);
    spacetime_bits_end(&self->step_from);
    spacetime_bits_end(&self->goal);
    spacetime_bits_end(&self->free_to_turn);
    free(self->clearance);
    free(self->step);
    free(self->shadow);
    free(self->now);
    free(self->next);
    free(self->layer);
    memset(self, 0, sizeof *self);
}
