#include "recompute.h"

#include <math.h>
#include <string.h>

typedef long double real;

enum { VERTICES = 16, DEPTH = 64, SAMPLES = 64 };

typedef struct body { // vehicle_t with its defaults, as vehicle.h words them
    real v[VERTICES][2], radius, reach, outer;
    int n, drive;
    real v_max, v_back, a_max, d_max, omega, alpha, lateral, curvature, margin, creep_gap, creep, mass, rolling, idle,
        efficiency;
} body;

typedef struct piece {
    real x, y, theta, turn;      // first end
    real dx, dy;                 // to the last one
    real cx, cy, r, from, sweep; // centre, radius, polar angle of the first end, signed angle; r = 0: line
    real length, v0, v1, dt, k;
    bool spot, back;
    int end; // waypoint
} piece;

typedef struct job {
    const aisle_path_msg *path;
    const recompute_world *world;
    const aisle_goal_msg *goals;
    int num_goals, goal;
    body body;
    recompute_report *out;
    const aisle_polygon_msg *near[AISLE_LAYOUT_MAX_POLYGONS]; // of the part of a piece looked at
    int nears;
} job;

static const real PI = 3.14159265358979323846264338327950288L;
static const real GRAVITY = 9.80665L;

// ---- the vehicle

static real or_else(float told, double otherwise) {
    return told > 0.0F ? (real)told : (real)(float)otherwise;
}

static void outline_of(const aisle_vehicle_msg *m, body *b) {
    static const real usual[4][2] = {{-0.5L, -0.35L}, {0.5L, -0.35L}, {0.5L, 0.35L}, {-0.5L, 0.35L}};
    b->radius = (real)m->footprint_radius;
    b->n = m->num_vertices;
    for (int i = 0; i < b->n; i++) {
        b->v[i][0] = (real)m->footprint[i][0];
        b->v[i][1] = (real)m->footprint[i][1];
    }
    if (b->n == 0 && b->radius > 0.0L) {
        b->n = 1;
    } else if (b->n == 0) {
        b->n = 4;
        memcpy(b->v, usual, sizeof usual);
    }
    for (int i = 0; i < b->n; i++) {
        b->reach = fmaxl(b->reach, hypotl(b->v[i][0], b->v[i][1]));
    }
    b->outer = b->reach + b->radius;
}

static body body_of(const aisle_vehicle_msg *m) {
    body b = {.drive = m->drive};
    outline_of(m, &b);
    b.v_max = or_else(m->v_max, 1.5);
    b.v_back = m->v_reverse_max > 0.0F ? (real)m->v_reverse_max : fminl((real)0.3F, b.v_max);
    b.a_max = or_else(m->a_max, 0.5);
    b.d_max = or_else(m->d_max, 0.5);
    b.omega = or_else(m->omega_max, 1.0);
    b.alpha = or_else(m->alpha_max, 1.0);
    b.lateral = or_else(m->lateral_a_max, 0.5);
    b.curvature = (real)m->curvature_max;
    b.margin = m->margin < 0.0F ? 0.0L : or_else(m->margin, 0.10);
    b.creep_gap = or_else(m->creep_clearance, 0.5);
    b.creep = fminl(or_else(m->creep_speed, 0.3), b.v_max);
    b.mass = or_else(m->mass, 500.0);
    b.rolling = or_else(m->rolling_resistance, 0.015);
    b.idle = or_else(m->idle_power, 50.0);
    b.efficiency = or_else(m->drive_efficiency, 0.8);
    return b;
}

// ---- pieces

static bool has(const aisle_waypoint_msg *w, int flag) {
    return (w->flags & flag) != 0;
}

static piece piece_of(const aisle_path_msg *path, int i) {
    const aisle_waypoint_msg *a = &path->waypoints[i - 1], *b = &path->waypoints[i];
    piece p = {.x = (real)a->x, .y = (real)a->y, .theta = (real)a->theta, .end = i};
    p.turn = remainderl((real)b->theta - p.theta, 2.0L * PI);
    p.v0 = (real)a->v;
    p.v1 = (real)b->v;
    p.dt = (real)b->t - (real)a->t;
    p.spot = has(a, AISLE_WAYPOINT_TURN_IN_PLACE);
    p.back = has(b, AISLE_WAYPOINT_REVERSE);
    p.dx = (real)b->x - p.x;
    p.dy = (real)b->y - p.y;
    p.k = (real)b->curvature;
    const real chord = hypotl(p.dx, p.dy);
    p.length = p.spot ? 0.0L : chord;
    if (p.spot || !(fabsl(p.k) > 0.0L)) {
        return p;
    }
    const real side = p.k > 0.0L ? 1.0L : -1.0L;
    p.r = fmaxl(1.0L / fabsl(p.k), 0.5L * chord);
    const real height = sqrtl(fmaxl(p.r * p.r - 0.25L * chord * chord, 0.0L));
    p.cx = p.x + 0.5L * p.dx - side * height * p.dy / chord;
    p.cy = p.y + 0.5L * p.dy + side * height * p.dx / chord;
    p.from = atan2l(p.y - p.cy, p.x - p.cx);
    p.sweep = side * 2.0L * asinl(fminl(1.0L, 0.5L * chord / p.r));
    p.length = p.r * fabsl(p.sweep);
    return p;
}

static void pose_at(const piece *p, real u, real *pose) {
    pose[0] = p->r > 0.0L ? p->cx + p->r * cosl(p->from + u * p->sweep) : p->x + u * p->dx;
    pose[1] = p->r > 0.0L ? p->cy + p->r * sinl(p->from + u * p->sweep) : p->y + u * p->dy;
    pose[2] = p->theta + u * p->turn;
}

static real course_at(const piece *p, real u) {
    if (p->r > 0.0L) {
        return p->from + u * p->sweep + (p->sweep > 0.0L ? 0.5L : -0.5L) * PI;
    }
    return atan2l(p->dy, p->dx);
}

static real speed_at(const piece *p, real u) {
    return sqrtl(fmaxl(p->v0 * p->v0 + u * (p->v1 * p->v1 - p->v0 * p->v0), 0.0L));
}

// ---- gaps

// fminl() and fmaxl() are calls.
static real less(real a, real b) {
    return b < a ? b : a;
}

static real more(real a, real b) {
    return b > a ? b : a;
}

static real square_to_edge(const real *p, const real *a, const real *b) {
    const real ex = b[0] - a[0], ey = b[1] - a[1], square = ex * ex + ey * ey;
    real t = square > 0.0L ? ((p[0] - a[0]) * ex + (p[1] - a[1]) * ey) / square : 0.0L;
    t = less(more(t, 0.0L), 1.0L);
    const real dx = p[0] - a[0] - t * ex, dy = p[1] - a[1] - t * ey;
    return dx * dx + dy * dy;
}

static real side(const real *a, const real *b, const real *p) {
    return (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]);
}

static bool holds(real (*v)[2], int n, const real *p) {
    for (int i = 0; i < n; i++) {
        if (side(v[i], v[(i + 1) % n], p) < 0.0L) {
            return false;
        }
    }
    return n > 2;
}

static bool cross(const real *a, const real *b, const real *c, const real *d) {
    return side(a, b, c) * side(a, b, d) < 0.0L && side(c, d, a) * side(c, d, b) < 0.0L;
}

static real outlines_gap(real (*v)[2], int n, real (*w)[2], int m) {
    if (holds(w, m, v[0]) || holds(v, n, w[0])) {
        return 0.0L;
    }
    real square = 1e18L;
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < m; j++) {
            const real *a = v[i], *b = v[(i + 1) % n], *c = w[j], *d = w[(j + 1) % m];
            if (n > 1 && cross(a, b, c, d)) {
                return 0.0L;
            }
            square = less(square, square_to_edge(a, c, d));
            square = n > 1 ? less(square, square_to_edge(c, a, b)) : square;
        }
    }
    return sqrtl(square);
}

static void take_polygon(const aisle_polygon_msg *polygon, real (*out)[2]) {
    for (int i = 0; i < polygon->num_vertices; i++) {
        out[i][0] = (real)polygon->vertices[i][0];
        out[i][1] = (real)polygon->vertices[i][1];
    }
}

static void place(const body *b, const real *pose, real (*out)[2]) {
    const real c = cosl(pose[2]), s = sinl(pose[2]);
    for (int i = 0; i < b->n; i++) {
        out[i][0] = pose[0] + c * b->v[i][0] - s * b->v[i][1];
        out[i][1] = pose[1] + s * b->v[i][0] + c * b->v[i][1];
    }
}

// Distance from a point to a polygon's box: no body about it is nearer.
static real box_distance(const aisle_polygon_msg *polygon, const real *p) {
    real lo[2] = {1e9L, 1e9L}, hi[2] = {-1e9L, -1e9L};
    for (int i = 0; i < polygon->num_vertices; i++) {
        for (int k = 0; k < 2; k++) {
            lo[k] = less(lo[k], (real)polygon->vertices[i][k]);
            hi[k] = more(hi[k], (real)polygon->vertices[i][k]);
        }
    }
    const real dx = more(more(lo[0] - p[0], p[0] - hi[0]), 0.0L), dy = more(more(lo[1] - p[1], p[1] - hi[1]), 0.0L);
    return sqrtl(dx * dx + dy * dy);
}

static bool is_solid(const aisle_polygon_msg *p) {
    return p->kind == AISLE_POLYGON_OBSTACLE || p->kind == AISLE_POLYGON_KEEPOUT;
}

static real point_to_walls(const job *j, const real *p) {
    const recompute_world *world = j->world;
    const real x = less(p[0] - (real)world->x_min, (real)world->x_max - p[0]);
    const real y = less(p[1] - (real)world->y_min, (real)world->y_max - p[1]);
    return less(x, y) - j->body.radius;
}

static real walls_gap(const job *j, real (*v)[2]) {
    real gap = 1e9L;
    for (int i = 0; i < j->body.n; i++) {
        gap = less(gap, point_to_walls(j, v[i]));
    }
    return gap;
}

static real polygon_gap(const job *j, real (*v)[2], const aisle_polygon_msg *polygon) {
    real w[VERTICES][2];
    take_polygon(polygon, w);
    return outlines_gap(v, j->body.n, w, polygon->num_vertices) - j->body.radius;
}

static bool counts(const aisle_polygon_msg *polygon, const aisle_polygon_msg *only) {
    return only == NULL ? is_solid(polygon) : polygon == only;
}

// Keeps what the body can come nearer to than `cap` on the part [lo, hi] of the piece: `only`, or all that is solid.
static void gather(job *j, const piece *p, real lo, real hi, const aisle_polygon_msg *only, real cap) {
    const real reach = j->body.outer + 0.5L * (hi - lo) * p->length + cap;
    real middle[3];
    pose_at(p, 0.5L * (lo + hi), middle);
    j->nears = 0;
    for (int i = 0; i < j->world->count; i++) {
        const aisle_polygon_msg *polygon = &j->world->polygons[i];
        if (counts(polygon, only) && box_distance(polygon, middle) < reach) {
            j->near[j->nears++] = polygon;
        }
    }
}

// Gap of the body at a pose to what was gathered and, if it is all that is solid, to the bounds; at most cap.
static real pose_gap(const job *j, const real *pose, const aisle_polygon_msg *only, real cap) {
    real v[VERTICES][2], gap = cap;
    place(&j->body, pose, v);
    gap = only == NULL ? less(gap, walls_gap(j, v)) : gap;
    for (int i = 0; i < j->nears; i++) {
        if (box_distance(j->near[i], pose) - j->body.outer < gap) {
            gap = less(gap, polygon_gap(j, v, j->near[i]));
        }
    }
    return gap;
}

static real gap_at(const job *j, const piece *p, real u, const aisle_polygon_msg *polygon) {
    real pose[3], v[VERTICES][2];
    pose_at(p, u, pose);
    place(&j->body, pose, v);
    return polygon_gap(j, v, polygon);
}

// The same on the part [lo, hi] of a line to one polygon. The distance of convex bodies is convex in how far one of them
// is moved, so golden section finds the least.
static real line_gap(const job *j, const piece *p, real lo, real hi, const aisle_polygon_msg *polygon) {
    static const real GOLDEN = 0.61803398874989484820458683436563812L;
    real a = hi - GOLDEN * (hi - lo), b = lo + GOLDEN * (hi - lo);
    real at_a = gap_at(j, p, a, polygon), at_b = gap_at(j, p, b, polygon), least = less(at_a, at_b);
    while ((hi - lo) * p->length > 0.1L * RECOMPUTE_WITHIN) {
        if (at_a < at_b) {
            hi = b, b = a, at_b = at_a;
            a = hi - GOLDEN * (hi - lo);
            at_a = gap_at(j, p, a, polygon);
        } else {
            lo = a, a = b, at_a = at_b;
            b = lo + GOLDEN * (hi - lo);
            at_b = gap_at(j, p, b, polygon);
        }
        least = less(least, less(at_a, at_b));
    }
    return less(least, less(gap_at(j, p, lo, polygon), gap_at(j, p, hi, polygon)));
}

// The least gap on the part [lo, hi] of a line to what was gathered; at most `least`, that at its ends, where the bounds are
// nearest.
static real line_part_gap(const job *j, const piece *p, real lo, real hi, real least) {
    for (int i = 0; i < j->nears; i++) {
        least = less(least, line_gap(j, p, lo, hi, j->near[i]));
    }
    return least;
}

// ---- gaps of what turns about a centre as one: arcs and turns on the spot

typedef struct orbit { // of a point: an arc about c
    real c[2], radius, from, sweep;
} orbit;

static orbit orbit_of(const real *c, const real *q, real sweep) {
    const real x = q[0] - c[0], y = q[1] - c[1];
    return (orbit){{c[0], c[1]}, sqrtl(x * x + y * y), atan2l(y, x), sweep};
}

static bool is_on(const orbit *o, real angle) {
    real ahead = fmodl(o->sweep < 0.0L ? o->from - angle : angle - o->from, 2.0L * PI);
    ahead += ahead < 0.0L ? 2.0L * PI : 0.0L;
    return ahead <= fabsl(o->sweep);
}

static void orbit_at(const orbit *o, real angle, real *p) {
    p[0] = o->c[0] + o->radius * cosl(angle);
    p[1] = o->c[1] + o->radius * sinl(angle);
}

static bool orbit_crosses(const orbit *o, const real *a, const real *b) {
    const real ex = b[0] - a[0], ey = b[1] - a[1], square = ex * ex + ey * ey;
    const real foot = ((o->c[0] - a[0]) * ex + (o->c[1] - a[1]) * ey) / square;
    const real x = a[0] + foot * ex - o->c[0], y = a[1] + foot * ey - o->c[1];
    const real left = o->radius * o->radius - x * x - y * y;
    for (int k = -1; left >= 0.0L && k <= 1; k += 2) {
        const real t = foot + k * sqrtl(left / square);
        if (t >= 0.0L && t <= 1.0L && is_on(o, atan2l(a[1] + t * ey - o->c[1], a[0] + t * ex - o->c[0]))) {
            return true;
        }
    }
    return false;
}

// Square of the distance between an orbit and an edge: at the orbit's ends, the edge's, where they are parallel, or 0.
static real orbit_to_edge(const orbit *o, const real *a, const real *b) {
    const real *ends[2] = {a, b};
    real p[2], square = 1e18L;
    if (orbit_crosses(o, a, b)) {
        return 0.0L;
    }
    for (int k = 0; k < 2; k++) {
        orbit_at(o, o->from + k * o->sweep, p);
        square = less(square, square_to_edge(p, a, b));
        const real across = atan2l(a[0] - b[0], b[1] - a[1]) + k * PI;
        orbit_at(o, across, p);
        square = is_on(o, across) ? less(square, square_to_edge(p, a, b)) : square;
        const real x = ends[k][0] - o->c[0], y = ends[k][1] - o->c[1], off = sqrtl(x * x + y * y) - o->radius;
        square = is_on(o, atan2l(y, x)) ? less(square, off * off) : square;
    }
    return square;
}

// v: the body where it begins. Corners of the body against the polygon's edges, and the other way round.
static real turning_gap(const job *j, const real *c, real sweep, real (*v)[2], const aisle_polygon_msg *polygon) {
    const int n = j->body.n, m = polygon->num_vertices;
    real w[VERTICES][2], square = 1e18L;
    take_polygon(polygon, w);
    for (int i = 0; i < n; i++) {
        const orbit o = orbit_of(c, v[i], sweep);
        for (int k = 0; k < m; k++) {
            square = less(square, orbit_to_edge(&o, w[k], w[(k + 1) % m]));
        }
    }
    for (int k = 0; n > 1 && k < m; k++) {
        const orbit o = orbit_of(c, w[k], -sweep);
        for (int i = 0; i < n; i++) {
            square = less(square, orbit_to_edge(&o, v[i], v[(i + 1) % n]));
        }
    }
    return sqrtl(square) - j->body.radius;
}

static real turning_walls_gap(const job *j, const real *c, real sweep, real (*v)[2]) {
    real p[2], gap = 1e9L;
    for (int i = 0; i < j->body.n; i++) {
        const orbit o = orbit_of(c, v[i], sweep);
        for (int k = 0; k < 4; k++) {
            orbit_at(&o, 0.5L * PI * k, p);
            gap = is_on(&o, 0.5L * PI * k) ? less(gap, point_to_walls(j, p)) : gap;
        }
    }
    return gap;
}

// The least gap on the part [lo, hi] of an arc or turn; at most `least`, that at its ends.
static real turning_part_gap(const job *j, const piece *p, real lo, real hi, const aisle_polygon_msg *only,
                             real least) {
    const real c[2] = {p->r != 0.0L ? p->cx : p->x, p->r != 0.0L ? p->cy : p->y};
    const real sweep = (hi - lo) * p->turn;
    real pose[3], v[VERTICES][2];
    pose_at(p, lo, pose);
    place(&j->body, pose, v);
    least = only == NULL ? less(least, turning_walls_gap(j, c, sweep, v)) : least;
    for (int i = 0; i < j->nears; i++) {
        least = less(least, turning_gap(j, c, sweep, v, j->near[i]));
    }
    return least;
}

// The least gap on the part [lo, hi] of the piece, at most cap.
static real part_gap(job *j, const piece *p, real lo, real hi, const aisle_polygon_msg *only, real cap) {
    const real rate = p->length + j->body.reach * fabsl(p->turn);
    real from[DEPTH], to[DEPTH], pose[3], least = cap;
    gather(j, p, lo, hi, only, cap);
    for (int i = 0; i < 3; i++) { // a first bound leaves fewer to look at
        pose_at(p, lo + 0.5L * i * (hi - lo), pose);
        least = pose_gap(j, pose, only, least);
    }
    gather(j, p, lo, hi, only, least);
    if (p->r == 0.0L && fabsl(p->turn) * j->body.reach < 0.1L * RECOMPUTE_WITHIN) {
        return line_part_gap(j, p, lo, hi, least);
    }
    if (p->spot || (p->r != 0.0L && fabsl(p->turn - p->sweep) * (p->r + j->body.reach) < 0.1L * RECOMPUTE_WITHIN)) {
        return turning_part_gap(j, p, lo, hi, only, least);
    }
    int n = 1;
    from[0] = lo;
    to[0] = hi;
    while (n > 0 && least > -1e-3L) {
        n--;
        const real a = from[n], b = to[n], middle = 0.5L * (a + b), half = 0.5L * (b - a) * rate;
        pose_at(p, middle, pose);
        const real gap = pose_gap(j, pose, only, least + half);
        least = less(least, gap);
        if (gap - half < least - RECOMPUTE_WITHIN && n + 2 <= DEPTH) {
            from[n] = middle;
            to[n++] = b;
            from[n] = a;
            to[n++] = middle;
        }
    }
    return least;
}

// ---- findings

static void find(job *j, recompute_rule rule, int waypoint, real excess) {
    recompute_finding *worst = &j->out->worst[rule];
    if (!(excess <= worst->excess)) { // NaN is a finding
        *worst = (recompute_finding){excess, waypoint};
    }
}

static real over(real value, real limit) {
    return value / limit - 1.0L;
}

// ---- times

// From rest to rest over `way` at most at `most`; *peak: fastest.
static real trapezoid(real way, real most, real up, real down, real *peak) {
    *peak = fminl(most, sqrtl(2.0L * way * up * down / (up + down)));
    const real ramps = 0.5L * *peak * *peak * (1.0L / up + 1.0L / down);
    return *peak * (1.0L / up + 1.0L / down) + fmaxl(way - ramps, 0.0L) / *peak;
}

static real dwell_before(const job *j, int i) {
    if (i == 0 || !has(&j->path->waypoints[i - 1], AISLE_WAYPOINT_GOAL) || j->goal == 0 || j->goal > j->num_goals) {
        return 0.0L;
    }
    return fmaxl((real)j->goals[j->goal - 1].dwell, 0.0L);
}

// The speed that the piece's own figures allow, for pieces from rest to rest: what else limits it is looked at elsewhere.
static real allowed(const job *j, const piece *p) {
    const body *b = &j->body;
    real v = p->back ? b->v_back : b->v_max;
    if (fabsl(p->k) > 0.0L) {
        v = fminl(v, sqrtl(b->lateral / fabsl(p->k)));
    }
    if (fabsl(p->turn) > 0.0L) {
        v = fminl(v, b->omega * p->length / fabsl(p->turn));
    }
    return (real)j->path->waypoints[p->end].clearance < b->creep_gap ? fminl(v, b->creep) : v;
}

static real slowest_zone(job *j, const piece *p) {
    real v = 1e9L;
    for (int i = 0; i < j->world->count; i++) {
        const aisle_polygon_msg *zone = &j->world->polygons[i];
        if (zone->kind == AISLE_POLYGON_SPEED_LIMIT && (real)zone->value < v &&
            part_gap(j, p, 0.0L, 1.0L, zone, 0.06L) < 0.06L) { // nearer than what a planner may take for contact
            v = (real)zone->value;
        }
    }
    return v;
}

// Time of the piece from its speeds alone, and the peak if it begins and ends at rest.
static real piece_time(job *j, const piece *p, real *peak) {
    const body *b = &j->body;
    *peak = fmaxl(p->v0, p->v1);
    if (p->spot) {
        real rate;
        return trapezoid(fabsl(p->turn), b->omega, b->alpha, b->alpha, &rate);
    }
    if (*peak > 1e-6L) {
        return 2.0L * p->length / (p->v0 + p->v1);
    }
    return trapezoid(p->length, fminl(allowed(j, p), slowest_zone(j, p)), b->a_max, b->d_max, peak);
}

// ---- rules of a piece

static void look_at_speeds(job *j, const piece *p, real peak) {
    const body *b = &j->body;
    const real gain = p->v1 * p->v1 - p->v0 * p->v0;
    find(j, RECOMPUTE_SPEED, p->end, over(peak, p->back ? b->v_back : b->v_max));
    if (p->spot) {
        return;
    }
    find(j, RECOMPUTE_ACCELERATION, p->end, over(gain / (2.0L * p->length), b->a_max));
    find(j, RECOMPUTE_BRAKING, p->end, over(-gain / (2.0L * p->length), b->d_max));
    find(j, RECOMPUTE_LATERAL, p->end, over(peak * peak * fabsl(p->k), b->lateral));
    find(j, RECOMPUTE_TURN_RATE, p->end, over(peak * fabsl(p->turn) / p->length, b->omega));
}

static void look_at_shape(job *j, const piece *p) {
    const body *b = &j->body;
    if (b->curvature > 0.0L) {
        const real bent = p->spot && fabsl(p->turn) > 1e-6L ? 1.0L : over(fabsl(p->k), b->curvature);
        find(j, RECOMPUTE_CURVATURE, p->end, bent);
    }
    if (p->spot) {
        find(j, RECOMPUTE_HEADING, p->end, hypotl(p->dx, p->dy));
        return;
    }
    if (b->drive != AISLE_VEHICLE_OMNI) {
        const real back = p->back ? PI : 0.0L;
        const real first = remainderl(course_at(p, 0.0L) + back - p->theta, 2.0L * PI);
        const real last = remainderl(course_at(p, 1.0L) + back - p->theta - p->turn, 2.0L * PI);
        find(j, RECOMPUTE_HEADING, p->end, fmaxl(fabsl(first), fabsl(last)));
        find(j, RECOMPUTE_HEADING, p->end, fabsl(p->turn - p->sweep)); // and round with it
    } else if (p->end > 1 && p->v0 > 1e-6L) {
        const piece before = piece_of(j->path, p->end - 1);
        const real break_ = remainderl(course_at(p, 0.0L) - course_at(&before, 1.0L), 2.0L * PI);
        find(j, RECOMPUTE_HEADING, p->end, fabsl(break_));
    }
}

static void look_at_rest(job *j, int i) {
    const aisle_waypoint_msg *w = j->path->waypoints;
    const int n = j->path->num_waypoints;
    bool rests = i == 0 || i == n - 1 || has(&w[i], AISLE_WAYPOINT_STOP | AISLE_WAYPOINT_TURN_IN_PLACE);
    rests = rests || has(&w[i - 1], AISLE_WAYPOINT_TURN_IN_PLACE);
    rests = rests || (i > 0 && has(&w[i], AISLE_WAYPOINT_REVERSE) != has(&w[i + 1], AISLE_WAYPOINT_REVERSE));
    find(j, RECOMPUTE_REST, i, rests ? fabsl((real)w[i].v) : 0.0L);
}

static void look_at_gaps(job *j, const piece *p, real peak) {
    const body *b = &j->body;
    const real told = (real)j->path->waypoints[p->end].clearance;
    const real gap = part_gap(j, p, 0.0L, 1.0L, NULL, 2.0L);
    j->out->gap[p->end] = gap;
    j->out->clearance = fminl(j->out->clearance, gap);
    find(j, RECOMPUTE_MARGIN, p->end, b->margin - gap);
    find(j, RECOMPUTE_CLEARANCE, p->end, told - gap);
    if (!(gap < b->creep_gap) || !(peak > b->creep)) {
        return;
    }
    for (int k = 0; k < SAMPLES; k++) { // where on the piece is it that near, and how fast there?
        const real lo = (real)k / SAMPLES, hi = (k + 1.0L) / SAMPLES;
        const bool rest = p->v0 + p->v1 <= 1e-6L;
        const real v = rest ? peak : fminl(speed_at(p, lo), speed_at(p, hi));
        if (v > b->creep && part_gap(j, p, lo, hi, NULL, b->creep_gap) < b->creep_gap * (1.0L - 1e-3L)) {
            find(j, RECOMPUTE_CREEP, p->end, over(v, b->creep));
        }
    }
}

// How deep a point is inside a polygon; negative: outside.
static real depth(const aisle_polygon_msg *polygon, const real *p) {
    real v[VERTICES][2], least = 1e9L;
    take_polygon(polygon, v);
    for (int i = 0; i < polygon->num_vertices; i++) {
        const real *a = v[i], *b = v[(i + 1) % polygon->num_vertices];
        least = fminl(least, side(a, b, p) / hypotl(b[0] - a[0], b[1] - a[1]));
    }
    return least;
}

static void look_at_zone(job *j, const piece *p, const aisle_polygon_msg *zone, real peak) {
    if (zone->kind == AISLE_POLYGON_SPEED_LIMIT && peak > (real)zone->value) {
        if (part_gap(j, p, 0.0L, 1.0L, zone, 1e-3L) <= 0.0L) {
            find(j, RECOMPUTE_ZONE_SPEED, p->end, over(peak, (real)zone->value));
        }
        return;
    }
    if (p->spot || (zone->kind != AISLE_POLYGON_DIRECTED && zone->kind != AISLE_POLYGON_PENALTY)) {
        return;
    }
    const int steps = 8 + (int)(p->length / 0.002L);
    for (int k = 0; k < steps; k++) {
        real pose[3];
        const real u = (k + 0.5L) / steps;
        pose_at(p, u, pose);
        const real in = depth(zone, pose), off = remainderl(course_at(p, u) - (real)zone->direction, 2.0L * PI);
        if (zone->kind == AISLE_POLYGON_PENALTY) {
            j->out->penalty += in > 0.0L ? 15.0L * (real)zone->value * p->length / steps : 0.0L;
        } else if (fabsl(off) > 0.5L * PI + 2e-3L) {
            find(j, RECOMPUTE_DIRECTION, p->end, in);
        }
    }
}

static void look_at_zones(job *j, const piece *p, real peak) {
    for (int i = 0; i < j->world->count; i++) {
        const aisle_polygon_msg *zone = &j->world->polygons[i];
        real middle[3];
        pose_at(p, 0.5L, middle);
        if (!is_solid(zone) && box_distance(zone, middle) <= 0.5L * p->length + j->body.outer) {
            look_at_zone(j, p, zone, peak);
        }
    }
}

// ---- times and energy

static recompute_energy energy_of(const job *j, const piece *p, real peak, real time) {
    const body *b = &j->body;
    const real drag = b->mass * GRAVITY * b->rolling;
    const bool rest = p->v0 + p->v1 <= 1e-6L;
    const real gain = rest ? peak * peak : fmaxl(p->v1 * p->v1 - p->v0 * p->v0, 0.0L);
    recompute_energy e = {.idle = b->idle * time};
    if (p->spot) {
        e.turning = drag * b->outer * fabsl(p->turn) / b->efficiency;
    } else {
        e.rolling = drag * p->length / b->efficiency;
        e.acceleration = 0.5L * b->mass * gain / b->efficiency;
    }
    return e;
}

static void add(recompute_energy *to, const recompute_energy *e) {
    to->rolling += e->rolling;
    to->acceleration += e->acceleration;
    to->turning += e->turning;
    to->idle += e->idle;
}

static void look_at_piece(job *j, int i) {
    const piece p = piece_of(j->path, i);
    recompute_report *out = j->out;
    real peak;
    const real dwell = dwell_before(j, i), time = fmaxl(piece_time(j, &p, &peak), 1e-3L) + dwell;
    out->length += p.length;
    out->duration += time;
    out->time[i] = time;
    out->each[i] = energy_of(j, &p, peak, time);
    add(&out->energy, &out->each[i]);
    find(j, RECOMPUTE_S, i, fabsl((real)j->path->waypoints[i].s - out->length));
    find(j, RECOMPUTE_T, i, fabsl(p.dt - time));
    look_at_speeds(j, &p, peak);
    look_at_shape(j, &p);
    look_at_gaps(j, &p, peak);
    look_at_zones(j, &p, peak);
}

long double recompute_sum(const recompute_energy *e) {
    return e->rolling + e->acceleration + e->turning + e->idle;
}

static real share(float told, real found) {
    return fabsl((real)told - found) / fmaxl(fabsl(found), 1e-3L);
}

void recompute(const aisle_path_msg *path, const aisle_vehicle_msg *vehicle, const recompute_world *world,
               const aisle_goal_msg *goals, int num_goals, recompute_report *out) {
    job j = {
        .path = path, .world = world, .goals = goals, .num_goals = num_goals, .body = body_of(vehicle), .out = out};
    memset(out, 0, sizeof *out);
    for (int r = 0; r < RECOMPUTE_RULES; r++) {
        out->worst[r].excess = -1e9L;
    }
    const aisle_waypoint_msg *w = path->waypoints;
    const real pose[3] = {(real)w[0].x, (real)w[0].y, (real)w[0].theta};
    out->clearance = out->gap[0] = pose_gap(&j, pose, NULL, 2.0L);
    find(&j, RECOMPUTE_MARGIN, 0, j.body.margin - out->clearance);
    for (int i = 0; i < path->num_waypoints; i++) {
        look_at_rest(&j, i);
        if (i > 0) {
            look_at_piece(&j, i);
        }
        j.goal += has(&w[i], AISLE_WAYPOINT_GOAL) ? 1 : 0;
    }
    const int last = path->num_waypoints - 1;
    find(&j, RECOMPUTE_LENGTH, last, share(path->length, out->length));
    find(&j, RECOMPUTE_DURATION, last, share(path->duration, out->duration));
    find(&j, RECOMPUTE_ENERGY, last, share(path->energy, recompute_sum(&out->energy)));
    find(&j, RECOMPUTE_CLEARANCE, last, (real)path->clearance_min - out->clearance);
}

// What rounding to float and the contract leave: clearance, margin 1e-4 (RECOMPUTE_WITHIN and slack), limits 1e-3, ...
static const struct {
    const char *name;
    long double most;
} rules[RECOMPUTE_RULES] = {
    [RECOMPUTE_MARGIN] = {"margin", 2e-6L},
    [RECOMPUTE_CLEARANCE] = {"clearance told", 2e-6L},
    [RECOMPUTE_CREEP] = {"creep speed", 1e-3L},
    [RECOMPUTE_SPEED] = {"speed", 1e-6L},
    [RECOMPUTE_ACCELERATION] = {"acceleration", 1e-5L},
    [RECOMPUTE_BRAKING] = {"braking", 1e-5L},
    [RECOMPUTE_LATERAL] = {"lateral acceleration", 1e-5L},
    [RECOMPUTE_TURN_RATE] = {"turn rate", 1e-5L},
    [RECOMPUTE_CURVATURE] = {"curvature", 1e-3L},
    [RECOMPUTE_HEADING] = {"heading", 2e-3L},
    [RECOMPUTE_REST] = {"rest", 1e-6L},
    [RECOMPUTE_ZONE_SPEED] = {"speed in a zone", 1e-3L},
    [RECOMPUTE_DIRECTION] = {"direction of a zone", 2e-6L},
    [RECOMPUTE_S] = {"s", 1e-3L},
    [RECOMPUTE_T] = {"t", 2e-3L},
    [RECOMPUTE_LENGTH] = {"length", 1e-6L},
    [RECOMPUTE_DURATION] = {"duration", 1e-4L},
    [RECOMPUTE_ENERGY] = {"energy", 1e-4L},
};

const char *recompute_name(recompute_rule rule) {
    return rules[rule].name;
}

bool recompute_is_fine(const recompute_report *report, recompute_rule *rule) {
    for (int r = 0; r < RECOMPUTE_RULES; r++) {
        if (!(report->worst[r].excess <= rules[r].most)) {
            *rule = (recompute_rule)r;
            return false;
        }
    }
    return true;
}
