#include "robot/reeds_shepp.h"

#include "base/angle.h"
#include "base/check.h"

#include <math.h>
#include <string.h>

// All lengths in radii. Left turns first, forwards first: the other words are these ones mirrored in time, in space or
// in both. Names as in the paper: section 8, equations (8.1) to (8.11).
typedef struct aisle_reeds_shepp_target target;

typedef struct lengths { // of a word: t, u, v
    double t, u, v;
} lengths;

typedef enum formula { LSL, LSR, LRL, LRLR_EVEN, LRLR_ODD, LRSL, LRSR, LRSLR } formula;

typedef struct family {
    formula solve;
    const char *pieces;  // L, R: arcs, S: a line
    const char *lengths; // of each: t, u, v; U: -u; q: -pi / 2
    bool backwards;      // read from the end
} family;

static const family families[] = {
    {LSL, "LSL", "tuv", false},    {LSR, "LSR", "tuv", false},         {LRL, "LRL", "tuv", false},
    {LRL, "LRL", "tuv", true},     {LRLR_EVEN, "LRLR", "tuUv", false}, {LRLR_ODD, "LRLR", "tuuv", false},
    {LRSL, "LRSL", "tquv", false}, {LRSL, "LRSL", "tquv", true},       {LRSR, "LRSR", "tquv", false},
    {LRSR, "LRSR", "tquv", true},  {LRSLR, "LRSLR", "tquqv", false},
};
#define MIRRORS 4U
#define ROUNDING 1e-9 // rad: an arc of no length may come out on either side of none

static double distance(double x, double y) {
    return sqrt(x * x + y * y);
}

// Angle whose sine is given.
static double arc_sine(double s) {
    return aisle_atan2(s, sqrt(aisle_max(1.0 - s * s, 0.0)));
}

static double arc_cosine(double c) {
    return aisle_atan2(sqrt(aisle_max(1.0 - c * c, 0.0)), c);
}

// The centre of the last arc, seen from the first one's: both turn left, or the last one right.
static aisle_vec2 between_left(const target *q) {
    return aisle_vec2_of(q->x - q->sine, q->y - 1.0 + q->cosine);
}

static aisle_vec2 between_right(const target *q) {
    return aisle_vec2_of(q->x + q->sine, q->y - 1.0 - q->cosine);
}

// First and last arc of a word of four arcs whose middle ones are known.
static void outer_arcs(const target *q, aisle_vec2 way, double second, double third, lengths *out) {
    double delta = aisle_angle_wrap(second - third);
    double sine_u, cosine_u, sine_v, cosine_v, sine_d, cosine_d;
    aisle_sincos(second, &sine_u, &cosine_u);
    aisle_sincos(third, &sine_v, &cosine_v);
    aisle_sincos(delta, &sine_d, &cosine_d);
    double a = sine_u - sine_d;
    double b = cosine_u - cosine_d - 1.0;
    double t = aisle_atan2(way.y * a - way.x * b, way.x * a + way.y * b);
    double side = 2.0 * (cosine_d - cosine_v - cosine_u) + 3.0;
    out->t = aisle_angle_wrap(side < 0.0 ? t + AISLE_PI : t);
    out->v = aisle_angle_wrap(out->t - second + third - q->phi);
}

static bool solve_lsl(const target *q, lengths *out) {
    aisle_vec2 way = between_left(q);
    out->u = distance(way.x, way.y);
    out->t = aisle_atan2(way.y, way.x);
    out->v = aisle_angle_wrap(q->phi - out->t);
    return out->t >= -ROUNDING && out->v >= -ROUNDING;
}

static bool solve_lsr(const target *q, lengths *out) {
    aisle_vec2 way = between_right(q);
    double square = aisle_vec2_dot(way, way);
    if (square < 4.0 - ROUNDING) {
        return false;
    }
    out->u = sqrt(aisle_max(square - 4.0, 0.0));
    out->t = aisle_angle_wrap(aisle_atan2(way.y, way.x) + aisle_atan2(2.0, out->u));
    out->v = aisle_angle_wrap(out->t - q->phi);
    return out->t >= -ROUNDING && out->v >= -ROUNDING;
}

static bool solve_lrl(const target *q, lengths *out) {
    aisle_vec2 way = between_left(q);
    double far = distance(way.x, way.y);
    if (far > 4.0 + ROUNDING) {
        return false;
    }
    out->u = -2.0 * arc_sine(aisle_min(0.25 * far, 1.0));
    out->t = aisle_angle_wrap(aisle_atan2(way.y, way.x) + 0.5 * out->u + AISLE_PI);
    out->v = aisle_angle_wrap(q->phi - out->t + out->u);
    return out->t >= -ROUNDING;
}

static bool solve_lrlr_even(const target *q, lengths *out) {
    aisle_vec2 way = between_right(q);
    double rho = 0.25 * (2.0 + distance(way.x, way.y));
    if (rho > 1.0 + ROUNDING) {
        return false;
    }
    out->u = arc_cosine(aisle_min(rho, 1.0));
    outer_arcs(q, way, out->u, -out->u, out);
    return out->t >= -ROUNDING && out->v <= ROUNDING;
}

static bool solve_lrlr_odd(const target *q, lengths *out) {
    aisle_vec2 way = between_right(q);
    double rho = (20.0 - aisle_vec2_dot(way, way)) / 16.0;
    if (rho < 0.0 || rho > 1.0 + ROUNDING) {
        return false;
    }
    out->u = -arc_cosine(aisle_min(rho, 1.0));
    outer_arcs(q, way, out->u, out->u, out);
    return out->t >= -ROUNDING && out->v >= -ROUNDING;
}

static bool solve_lrsl(const target *q, lengths *out) {
    aisle_vec2 way = between_left(q);
    double rho = distance(way.x, way.y);
    if (rho < 2.0 - ROUNDING) {
        return false;
    }
    double r = sqrt(aisle_max(rho * rho - 4.0, 0.0));
    out->u = 2.0 - r;
    out->t = aisle_angle_wrap(aisle_atan2(way.y, way.x) + aisle_atan2(r, -2.0));
    out->v = aisle_angle_wrap(q->phi - 0.5 * AISLE_PI - out->t);
    return out->t >= -ROUNDING && out->u <= ROUNDING && out->v <= ROUNDING;
}

static bool solve_lrsr(const target *q, lengths *out) {
    aisle_vec2 way = between_right(q);
    double rho = distance(way.x, way.y);
    if (rho < 2.0 - ROUNDING) {
        return false;
    }
    out->u = 2.0 - rho;
    out->t = aisle_atan2(way.x, -way.y);
    out->v = aisle_angle_wrap(out->t + 0.5 * AISLE_PI - q->phi);
    return out->t >= -ROUNDING && out->u <= ROUNDING && out->v <= ROUNDING;
}

static bool solve_lrslr(const target *q, lengths *out) {
    aisle_vec2 way = between_right(q);
    double rho = distance(way.x, way.y);
    if (rho < 2.0 - ROUNDING) {
        return false;
    }
    double u = 4.0 - sqrt(aisle_max(rho * rho - 4.0, 0.0));
    out->u = u;
    out->t = aisle_atan2((4.0 - u) * way.x - 2.0 * way.y, -2.0 * way.x + (u - 4.0) * way.y);
    out->v = aisle_angle_wrap(out->t - q->phi);
    return u <= ROUNDING && out->t >= -ROUNDING && out->v >= -ROUNDING;
}

static bool solve(formula which, const target *q, lengths *out) {
    switch (which) {
    case LSL:
        return solve_lsl(q, out);
    case LSR:
        return solve_lsr(q, out);
    case LRL:
        return solve_lrl(q, out);
    case LRLR_EVEN:
        return solve_lrlr_even(q, out);
    case LRLR_ODD:
        return solve_lrlr_odd(q, out);
    case LRSL:
        return solve_lrsl(q, out);
    case LRSR:
        return solve_lrsr(q, out);
    default:
        return solve_lrslr(q, out);
    }
}

aisle_reeds_shepp aisle_reeds_shepp_between(aisle_pose2 from, aisle_pose2 to, double radius) {
    AISLE_ASSERT(radius > 0.0);
    target q = {.phi = aisle_angle_difference(from.theta, to.theta)};
    double sine, cosine;
    aisle_sincos(from.theta, &sine, &cosine);
    double dx = (to.x - from.x) / radius;
    double dy = (to.y - from.y) / radius;
    q.x = cosine * dx + sine * dy;
    q.y = cosine * dy - sine * dx;
    aisle_sincos(q.phi, &q.sine, &q.cosine);
    aisle_reeds_shepp self = {q, q, radius};
    self.back.x = q.x * q.cosine + q.y * q.sine; // from the end, everything driven the other way
    self.back.y = q.x * q.sine - q.y * q.cosine;
    return self;
}

static target mirrored(target q, bool in_time, bool in_space) {
    q.x = in_time ? -q.x : q.x;
    q.y = in_space ? -q.y : q.y;
    q.phi = in_time != in_space ? -q.phi : q.phi;
    q.sine = in_time != in_space ? -q.sine : q.sine;
    return q;
}

static double length_of(char which, const lengths *of) {
    switch (which) {
    case 't':
        return of->t;
    case 'u':
        return of->u;
    case 'U':
        return -of->u;
    case 'v':
        return of->v;
    default:
        return -0.5 * AISLE_PI;
    }
}

static void take(aisle_reeds_shepp_word *word, double length, double turn) {
    if (fabs(length) > 1e-9) {
        word->move[word->count++] = (aisle_move){length, turn};
    }
}

static void write_word(const family *f, const lengths *of, bool in_time, bool in_space, aisle_reeds_shepp_word *word) {
    uint32_t n = (uint32_t)strlen(f->pieces);
    word->count = 0;
    for (uint32_t i = 0; i < n; i++) {
        uint32_t at = f->backwards ? n - 1U - i : i;
        double length = length_of(f->lengths[at], of);
        double bend = f->pieces[at] == 'S' ? 0.0 : (f->pieces[at] == 'L' ? 1.0 : -1.0);
        length = in_time ? -length : length;
        bend = in_space ? -bend : bend;
        take(word, length, length * bend);
    }
}

static bool leads_there(const aisle_reeds_shepp_word *word, const target *q) {
    aisle_pose2 p = {0.0, 0.0, 0.0};
    double travel = 1.0;
    for (uint32_t i = 0; i < word->count; i++) {
        p = aisle_move_end(p, word->move[i]);
        travel += fabs(word->move[i].length);
    }
    return distance(p.x - q->x, p.y - q->y) <= AISLE_REEDS_SHEPP_OFF * travel &&
           fabs(aisle_angle_difference(p.theta, q->phi)) <= AISLE_REEDS_SHEPP_OFF * travel;
}

bool aisle_reeds_shepp_word_of(const aisle_reeds_shepp *self, uint32_t n, double longest,
                               aisle_reeds_shepp_word *word) {
    AISLE_ASSERT(n < AISLE_REEDS_SHEPP_WORDS);
    const family *f = &families[n / MIRRORS];
    bool in_time = n % 2U != 0U;
    bool in_space = n / 2U % 2U != 0U;
    const target q = mirrored(f->backwards ? self->back : self->forth, in_time, in_space);
    lengths of;
    if (!solve(f->solve, &q, &of)) {
        return false;
    }
    write_word(f, &of, in_time, in_space, word);
    double sum = 0.0;
    for (uint32_t i = 0; i < word->count; i++) {
        sum += fabs(word->move[i].length);
    }
    if (sum * self->radius > longest || !leads_there(word, &self->forth)) {
        return false;
    }
    for (uint32_t i = 0; i < word->count; i++) {
        word->move[i].length *= self->radius;
    }
    return true;
}
