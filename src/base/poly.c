#include "base/poly.h"

#include "base/check.h"
#include "base/vec.h"

#include <stdbool.h>
#include <string.h>

#define ROOT_STEPS 120U // Newton's halve the step before them at least, others the interval
#define ROOT_STEP_MIN 1e-16

double aisle_poly_value(const double *c, uint32_t degree, double r) {
    AISLE_ASSERT(degree <= AISLE_POLY_DEGREE_MAX);
    double value = c[degree];
    for (uint32_t i = degree; i > 0U; i--) {
        value = value * r + c[i - 1U];
    }
    return value;
}

uint32_t aisle_poly_derivative(const double *c, uint32_t degree, double *out) {
    AISLE_ASSERT(degree <= AISLE_POLY_DEGREE_MAX);
    if (degree == 0U) {
        out[0] = 0.0;
        return 0U;
    }
    for (uint32_t i = 1; i <= degree; i++) {
        out[i - 1U] = (double)i * c[i];
    }
    return degree - 1U;
}

// ---- roots

// Value and derivative at x by one Horner's rule.
static double value_and_slope(const double *c, uint32_t degree, double x, double *slope) {
    double value = c[degree];
    *slope = 0.0;
    for (uint32_t i = degree; i > 0U; i--) {
        *slope = *slope * x + value;
        value = value * x + c[i - 1U];
    }
    return value;
}

// The value at `lo` has the sign of `at_lo`; at `hi` it has not.
static double root_between(const double *c, uint32_t degree, double lo, double hi, double at_lo) {
    double x = 0.5 * (lo + hi), step = hi - lo;
    for (uint32_t i = 0; i < ROOT_STEPS && step > ROOT_STEP_MIN; i++) {
        double slope;
        const double value = value_and_slope(c, degree, x, &slope);
        if ((value < 0.0) == (at_lo < 0.0)) {
            lo = x;
        } else {
            hi = x;
        }
        const double by = value / slope; // slope 0: no number that passes below
        const bool is_newton = fabs(by) < 0.5 * step && x - by >= lo && x - by <= hi;
        const double next = is_newton ? x - by : 0.5 * (lo + hi);
        step = fabs(next - x);
        x = next;
    }
    return x;
}

// Sign changes of c between neighbours of 0, stop[count], 1; c is monotone there.
static uint32_t roots_between(const double *c, uint32_t degree, const double *stop, uint32_t count, double *roots) {
    uint32_t found = 0;
    double from = 0.0, at_from = aisle_poly_value(c, degree, 0.0);
    for (uint32_t i = 0; i <= count; i++) {
        const double to = i < count ? stop[i] : 1.0, at_to = aisle_poly_value(c, degree, to);
        if ((at_from < 0.0 && at_to >= 0.0) || (at_from > 0.0 && at_to <= 0.0)) {
            roots[found++] = root_between(c, degree, from, to, at_from);
        }
        from = to;
        at_from = at_to;
    }
    return found;
}

uint32_t aisle_poly_roots(const double *c, uint32_t degree, double *roots) {
    double chain[AISLE_POLY_DEGREE_MAX + 1U][AISLE_POLY_DEGREE_MAX + 1U]; // [k]: the k-th derivative
    double stop[AISLE_POLY_DEGREE_MAX];
    AISLE_ASSERT(degree <= AISLE_POLY_DEGREE_MAX);
    memcpy(chain[0], c, (degree + 1U) * sizeof *c);
    for (uint32_t k = 1; k < degree; k++) {
        (void)aisle_poly_derivative(chain[k - 1U], degree + 1U - k, chain[k]);
    }
    uint32_t count = 0;
    for (uint32_t k = degree; k-- > 0U;) {
        count = roots_between(chain[k], degree - k, stop, count, roots);
        memcpy(stop, roots, count * sizeof *roots);
    }
    return count;
}

// ---- ranges

void aisle_poly_range(const double *c, uint32_t degree, double *lo, double *hi) {
    double slope[AISLE_POLY_DEGREE_MAX + 1U], roots[AISLE_POLY_DEGREE_MAX];
    const uint32_t below = aisle_poly_derivative(c, degree, slope);
    const uint32_t count = aisle_poly_roots(slope, below, roots);
    const double first = aisle_poly_value(c, degree, 0.0), last = aisle_poly_value(c, degree, 1.0);
    *lo = aisle_min(first, last);
    *hi = aisle_max(first, last);
    for (uint32_t i = 0; i < count; i++) {
        const double value = aisle_poly_value(c, degree, roots[i]);
        *lo = aisle_min(*lo, value);
        *hi = aisle_max(*hi, value);
    }
}

double aisle_poly_peak(const double *c, uint32_t degree) {
    double lo, hi;
    aisle_poly_range(c, degree, &lo, &hi);
    return aisle_max(-lo, hi);
}

// The polynomial in u, r = a + (b - a) u: synthetic division by (r - a) again and again, then scaled.
static void move_to(const double *c, uint32_t degree, double a, double b, double *out) {
    double scale = 1.0;
    for (uint32_t i = 0; i <= degree; i++) {
        out[i] = c[i];
    }
    for (uint32_t k = 0; k < degree; k++) {
        for (uint32_t i = degree; i > k; i--) {
            out[i - 1U] += a * out[i];
        }
    }
    for (uint32_t i = 0; i <= degree; i++) {
        out[i] *= scale;
        scale *= b - a;
    }
}

// Coefficients to Bernstein coefficients in place: c[j] / C(degree, j), then each sum of C(i, j) times that as a row of sums
// of neighbours (Pascal's rule).
static void to_bernstein(double *c, uint32_t degree) {
    double choose = 1.0;
    for (uint32_t j = 0; j <= degree; j++) {
        c[j] /= choose;
        choose = choose * (double)(degree - j) / (double)(j + 1U);
    }
    for (uint32_t k = 1; k <= degree; k++) {
        for (uint32_t i = degree; i >= k; i--) {
            c[i] += c[i - 1U];
        }
    }
}

void aisle_poly_bounds(const double *c, uint32_t degree, double a, double b, double *lo, double *hi) {
    double moved[AISLE_POLY_DEGREE_MAX + 1U];
    AISLE_ASSERT(degree <= AISLE_POLY_DEGREE_MAX);
    move_to(c, degree, a, b, moved);
    to_bernstein(moved, degree);
    *lo = *hi = moved[0];
    for (uint32_t i = 1; i <= degree; i++) {
        *lo = aisle_min(*lo, moved[i]);
        *hi = aisle_max(*hi, moved[i]);
    }
}
