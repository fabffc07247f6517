#include "world/spline.h"

#include "base/check.h"

#include <float.h>

#define MERGE_DISTANCE 1e-6 // m
#define CURVATURE_SPEED_MIN 1e-9

// ---- fitting

static bool all_finite(const aisle_vec2 *points, uint32_t n) {
    double sum = 0.0;
    for (uint32_t i = 0; i < n; i++) {
        sum += fabs(points[i].x) + fabs(points[i].y);
    }
    return sum <= DBL_MAX; // NaN is not
}

// Copies the points that are far enough from the one kept before; the last one always, in place of a near one.
static uint32_t merge(const aisle_vec2 *points, uint32_t n, aisle_vec2 *out) {
    uint32_t kept = 1;
    out[0] = points[0];
    for (uint32_t i = 1; i < n; i++) {
        const bool is_far = aisle_vec2_distance(out[kept - 1U], points[i]) >= MERGE_DISTANCE;
        if (is_far) {
            out[kept] = points[i];
            kept++;
        } else if (i + 1U == n && kept > 1U) {
            out[kept - 1U] = points[i];
        }
    }
    while (kept >= 2U && aisle_vec2_distance(out[kept - 2U], out[kept - 1U]) < MERGE_DISTANCE) {
        out[kept - 2U] = out[kept - 1U]; // the last one came back onto the one before
        kept--;
    }
    return kept;
}

// Interior equations of the C2 spline, h[i-1] m[i-1] + 2 (h[i-1] + h[i]) m[i] + h[i] m[i+1] = 6 (slope[i] -
// slope[i-1]), with m[0] and m[n-1] replaced by what "not a knot" says of them: m[0] = m[1] - (h[0] / h[1]) (m[2] -
// m[1]), and alike at the end. What remains is tridiagonal and diagonally dominant, so it is solved without pivoting
// (Thomas).
static void solve_not_a_knot(aisle_spline *self) {
    double upper[AISLE_SPLINE_POINTS_MAX];
    const uint32_t last = self->n - 1U;
    for (uint32_t i = 1; i < last; i++) {
        const double h0 = self->u[i] - self->u[i - 1U];
        const double h1 = self->u[i + 1U] - self->u[i];
        double below = h0;
        double diagonal = 2.0 * (h0 + h1);
        double above = h1;
        if (i == 1U) {
            diagonal += h0 * (1.0 + h0 / h1);
            above -= h0 * (h0 / h1);
            below = 0.0;
        }
        if (i == last - 1U) {
            diagonal += h1 * (1.0 + h1 / h0);
            below -= h1 * (h1 / h0);
            above = 0.0;
        }
        const aisle_vec2 slope0 = aisle_vec2_scale(aisle_vec2_sub(self->p[i], self->p[i - 1U]), 1.0 / h0);
        const aisle_vec2 slope1 = aisle_vec2_scale(aisle_vec2_sub(self->p[i + 1U], self->p[i]), 1.0 / h1);
        aisle_vec2 right = aisle_vec2_scale(aisle_vec2_sub(slope1, slope0), 6.0);
        if (i > 1U) {
            diagonal -= below * upper[i - 1U];
            right = aisle_vec2_sub(right, aisle_vec2_scale(self->m[i - 1U], below));
        }
        AISLE_ASSERT(diagonal > 0.0);
        upper[i] = above / diagonal;
        self->m[i] = aisle_vec2_scale(right, 1.0 / diagonal);
    }
    for (uint32_t i = last - 1U; i-- > 1U;) {
        self->m[i] = aisle_vec2_sub(self->m[i], aisle_vec2_scale(self->m[i + 1U], upper[i]));
    }
    const double r0 = (self->u[1] - self->u[0]) / (self->u[2] - self->u[1]);
    const double r1 = (self->u[last] - self->u[last - 1U]) / (self->u[last - 1U] - self->u[last - 2U]);
    self->m[0] = aisle_vec2_lerp(self->m[1], self->m[2], -r0);
    self->m[last] = aisle_vec2_lerp(self->m[last - 1U], self->m[last - 2U], -r1);
}

static void fit_cubic(aisle_spline *self) {
    if (self->n > 3U) {
        solve_not_a_knot(self);
    } else if (self->n == 3U) { // the parabola: one second derivative for all
        const double h0 = self->u[1] - self->u[0];
        const double h1 = self->u[2] - self->u[1];
        const aisle_vec2 slope0 = aisle_vec2_scale(aisle_vec2_sub(self->p[1], self->p[0]), 1.0 / h0);
        const aisle_vec2 slope1 = aisle_vec2_scale(aisle_vec2_sub(self->p[2], self->p[1]), 1.0 / h1);
        const aisle_vec2 m = aisle_vec2_scale(aisle_vec2_sub(slope1, slope0), 2.0 / (h0 + h1));
        self->m[0] = self->m[1] = self->m[2] = m;
    }
}

aisle_status aisle_spline_fit(aisle_spline *self, aisle_spline_kind kind, const aisle_vec2 *points, uint32_t n) {
    if (n > AISLE_SPLINE_POINTS_MAX) {
        return AISLE_ERR_CAPACITY;
    }
    if (n < 2U || !all_finite(points, n)) {
        return AISLE_ERR_ARG;
    }
    aisle_vec2 kept[AISLE_SPLINE_POINTS_MAX];
    const uint32_t count = merge(points, n, kept);
    if (count < 2U) {
        return AISLE_ERR_ARG;
    }
    self->kind = kind;
    self->n = count;
    self->u[0] = 0.0;
    for (uint32_t i = 0; i < count; i++) {
        self->p[i] = kept[i];
        self->m[i] = aisle_vec2_of(0.0, 0.0);
        self->u[i] = i == 0U ? 0.0 : self->u[i - 1U] + aisle_vec2_distance(kept[i - 1U], kept[i]);
    }
    if (kind == AISLE_SPLINE_CUBIC) {
        fit_cubic(self);
    }
    return AISLE_OK;
}

// ---- evaluation

// One span as polynomials of t = u - u[span]: p + t (b + t (c + t d)).
typedef struct piece {
    aisle_vec2 p, b, c, d;
    double h; // length in u
} piece;

static piece piece_of(const aisle_spline *self, uint32_t span) {
    const double h = self->u[span + 1U] - self->u[span];
    const aisle_vec2 slope = aisle_vec2_scale(aisle_vec2_sub(self->p[span + 1U], self->p[span]), 1.0 / h);
    const aisle_vec2 m0 = self->m[span];
    const aisle_vec2 m1 = self->m[span + 1U];
    const aisle_vec2 twice = aisle_vec2_add(aisle_vec2_scale(m0, 2.0), m1);
    return (piece){self->p[span], aisle_vec2_sub(slope, aisle_vec2_scale(twice, h / 6.0)), aisle_vec2_scale(m0, 0.5),
                   aisle_vec2_scale(aisle_vec2_sub(m1, m0), 1.0 / (6.0 * h)), h};
}

static aisle_spline_sample sample_of(const piece *s, double t) {
    aisle_spline_sample out;
    out.p.x = s->p.x + t * (s->b.x + t * (s->c.x + t * s->d.x));
    out.p.y = s->p.y + t * (s->b.y + t * (s->c.y + t * s->d.y));
    out.d1.x = s->b.x + t * (2.0 * s->c.x + t * 3.0 * s->d.x);
    out.d1.y = s->b.y + t * (2.0 * s->c.y + t * 3.0 * s->d.y);
    out.d2.x = 2.0 * s->c.x + t * 6.0 * s->d.x;
    out.d2.y = 2.0 * s->c.y + t * 6.0 * s->d.y;
    return out;
}

static double speed_of(const piece *s, double t) {
    const double x = s->b.x + t * (2.0 * s->c.x + t * 3.0 * s->d.x);
    const double y = s->b.y + t * (2.0 * s->c.y + t * 3.0 * s->d.y);
    return sqrt(x * x + y * y);
}

static uint32_t span_of(const aisle_spline *self, double u) { // the last one that begins at or before u
    uint32_t low = 0;
    uint32_t high = self->n - 1U;
    while (high - low > 1U) {
        const uint32_t middle = (low + high) / 2U;
        if (self->u[middle] <= u) {
            low = middle;
        } else {
            high = middle;
        }
    }
    return low;
}

aisle_spline_sample aisle_spline_at(const aisle_spline *self, double u) {
    AISLE_ASSERT(self->n >= 2U);
    const double end = self->u[self->n - 1U];
    const double at = u > 0.0 ? aisle_min(u, end) : 0.0; // NaN is the start
    const uint32_t span = span_of(self, at);
    const piece s = piece_of(self, span);
    aisle_spline_sample sample = sample_of(&s, at - self->u[span]);
    if (at >= end) { // exactly the last point, whatever the polynomial's rounding
        sample.p = self->p[self->n - 1U];
    }
    return sample;
}

double aisle_spline_curvature(const aisle_spline_sample *sample) {
    const double speed = aisle_vec2_length(sample->d1);
    if (speed < CURVATURE_SPEED_MIN) {
        return 0.0;
    }
    return aisle_vec2_cross(sample->d1, sample->d2) / (speed * speed * speed);
}

// ---- arc length

// Length of a piece from t to t + h by 5-point Gauss-Legendre.
static double gauss5(const piece *s, double t, double h) {
    static const double node[2] = {0.53846931010568309104, 0.90617984593866399280};
    static const double weight[3] = {0.56888888888888888889, 0.47862867049936646804, 0.23692688505618908751};
    const double middle = t + 0.5 * h;
    double sum = weight[0] * speed_of(s, middle);
    for (uint32_t i = 0; i < 2U; i++) {
        const double off = 0.5 * h * node[i];
        sum += weight[i + 1U] * (speed_of(s, middle - off) + speed_of(s, middle + off));
    }
    return 0.5 * h * sum;
}

double aisle_spline_length(const aisle_spline *self) {
    double sum = 0.0;
    for (uint32_t span = 0; span + 1U < self->n; span++) {
        const piece s = piece_of(self, span);
        if (self->kind == AISLE_SPLINE_LINEAR) {
            sum += s.h;
            continue;
        }
        for (uint32_t i = 0; i < AISLE_SPLINE_GAUSS_CUTS; i++) {
            const double h = s.h / AISLE_SPLINE_GAUSS_CUTS;
            sum += gauss5(&s, (double)i * h, h);
        }
    }
    return sum;
}

// ---- resampling

enum { CUTS = 16 }; // of a span: within one the speed is taken to change evenly

// Length of a cut by Simpson's rule.
static double cut_length(const piece *s, double t, double h) {
    return h / 6.0 * (speed_of(s, t) + 4.0 * speed_of(s, t + 0.5 * h) + speed_of(s, t + h));
}

static double length_by_cuts(const aisle_spline *self) {
    double sum = 0.0;
    for (uint32_t span = 0; span + 1U < self->n; span++) {
        const piece s = piece_of(self, span);
        for (uint32_t i = 0; i < CUTS; i++) {
            sum += cut_length(&s, (double)i * (s.h / CUTS), s.h / CUTS);
        }
    }
    return sum;
}

// Where in a cut of length `whole` the length `part` is reached, as a share of its h. With speeds v0, v1 at its ends
// and an even change between: v0 x + (v1 - v0) x^2 / 2 = part / whole * (v0 + v1) / 2, by the root that does not
// cancel.
static double share_of(double v0, double v1, double part, double whole) {
    const double target = whole > 0.0 ? part / whole * 0.5 * (v0 + v1) : 0.0;
    const double root = v0 + sqrt(aisle_max(0.0, v0 * v0 + 2.0 * (v1 - v0) * target));
    return root > 0.0 ? aisle_clamp(2.0 * target / root, 0.0, 1.0) : 0.0;
}

// A walk along the spline by arc length: the cut it is in and where that begins.
typedef struct walk {
    const aisle_spline *spline;
    piece s;
    uint32_t span, cut;
    double length; // of the cut
    double before; // length up to it
} walk;

static void enter_cut(walk *w) {
    if (w->cut == CUTS) {
        w->cut = 0;
        w->span++;
    }
    if (w->cut == 0) {
        w->s = piece_of(w->spline, w->span);
    }
    const double h = w->s.h / CUTS;
    w->length = cut_length(&w->s, (double)w->cut * h, h);
}

static aisle_spline_sample walk_to(walk *w, double target) {
    const uint32_t last_span = w->spline->n - 2U;
    while (w->before + w->length < target && !(w->span == last_span && w->cut == CUTS - 1)) {
        w->before += w->length;
        w->cut++;
        enter_cut(w);
    }
    const double h = w->s.h / CUTS;
    const double t = (double)w->cut * h;
    const double share = share_of(speed_of(&w->s, t), speed_of(&w->s, t + h), target - w->before, w->length);
    return sample_of(&w->s, t + share * h);
}

void aisle_spline_resample(const aisle_spline *self, uint32_t count, aisle_spline_sample *out) {
    AISLE_ASSERT(count >= 2U);
    const double spacing = length_by_cuts(self) / (double)(count - 1U);
    walk w = {.spline = self};
    enter_cut(&w);
    out[0] = aisle_spline_at(self, 0.0);
    for (uint32_t i = 1; i + 1U < count; i++) {
        out[i] = walk_to(&w, (double)i * spacing);
    }
    out[count - 1U] = aisle_spline_at(self, self->u[self->n - 1U]);
}

void aisle_spline_spread(const aisle_spline *self, uint32_t count, aisle_spline_sample *out) {
    AISLE_ASSERT(count >= 2U);
    const double end = self->u[self->n - 1U];
    const double spacing = end / (double)(count - 1U);
    uint32_t i = 0;
    for (uint32_t span = 0; span + 1U < self->n; span++) {
        const piece s = piece_of(self, span);
        const double until = span + 2U < self->n ? self->u[span + 1U] : (double)INFINITY;
        for (; i < count && (double)i * spacing < until; i++) {
            out[i] = sample_of(&s, (double)i * spacing - self->u[span]);
        }
    }
    out[count - 1U].p = self->p[self->n - 1U]; // whatever the polynomial's rounding
}
