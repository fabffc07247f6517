// poly.h - polynomials of one variable on [0, 1], of low degree. Level 0.
//
// A polynomial is its coefficients c[degree + 1], lowest power first; degree in [0, AISLE_POLY_DEGREE_MAX]. Memory: stack
// only, a few hundred bytes. No recursion. Time: stated with each, d the degree.
#ifndef AISLE_BASE_POLY_H
#define AISLE_BASE_POLY_H

#include <stdint.h>

#define AISLE_POLY_DEGREE_MAX 9U

// Value at r by Horner's rule. O(d).
double aisle_poly_value(const double *c, uint32_t degree, double r);

// Coefficients of the derivative to out[degree] (out[1] = {0} for a constant); out may be c. Returns its degree. O(d).
uint32_t aisle_poly_derivative(const double *c, uint32_t degree, double *out);

// Places in [0, 1] where the polynomial changes its sign, rising, to roots[degree]; returns how many. Between the zeros of
// the derivative it is monotone, so each sign change there is found by Newton's steps held in by bisection (Press et al. 2007,
// "Numerical Recipes", ch. 9.4): from the linear derivative upwards, no start values, no failure. Each to within 1e-15; a zero that
// is only touched may be told, too. O(d^2) roots of 120 steps at most, about 6 on the average.
uint32_t aisle_poly_roots(const double *c, uint32_t degree, double *roots);

// Greatest |value| on [0, 1]: at an end or where the derivative changes its sign. Relative error 1e-12 but for
// cancellation among the coefficients. As roots().
double aisle_poly_peak(const double *c, uint32_t degree);

// Least and greatest value on [0, 1], as peak().
void aisle_poly_range(const double *c, uint32_t degree, double *lo, double *hi);

// Bounds that hold whatever the roots: the least and the greatest Bernstein coefficient on [a, b] (Farouki 2012,
// doi:10.1016/j.cagd.2012.03.001); lo <= value <= hi for every r in [a, b], up to rounding. 0 <= a <= b <= 1. The gap to
// the true range falls with (b - a)^2. O(d^2).
void aisle_poly_bounds(const double *c, uint32_t degree, double a, double b, double *lo, double *hi);
#endif
