// spline.h - interpolation of points of the plane by arc length: linear, and cubic with not-a-knot ends. Level 1.
//
// The parameter is the cumulated chord length u through the n given points. LINEAR joins them by segments. CUBIC fits
// x(u) and y(u) by the C2 cubic spline whose third derivative is continuous at the second and last but one point
// (de Boor 1978, ch. IV, "not-a-knot"): exact for cubics; with 3 points it is the parabola, with 2 the segment.
// Memory: the caller's arrays. Time: fit O(n), no recursion; at O(log n); a walk over increasing u O(n) in all.
#ifndef AISLE_WORLD_SPLINE_H
#define AISLE_WORLD_SPLINE_H

#include "aisle/status.h"
#include "base/vec.h"

#include <stdint.h>

#define AISLE_SPLINE_POINTS_MAX 128U

typedef enum aisle_spline_kind { AISLE_SPLINE_LINEAR, AISLE_SPLINE_CUBIC } aisle_spline_kind;

typedef struct aisle_spline {
    aisle_spline_kind kind;
    uint32_t n;
    double u[AISLE_SPLINE_POINTS_MAX];     // chord length at each point, strictly increasing
    aisle_vec2 p[AISLE_SPLINE_POINTS_MAX]; // the points
    aisle_vec2 m[AISLE_SPLINE_POINTS_MAX]; // second derivatives by u (CUBIC)
} aisle_spline;

typedef struct aisle_spline_sample {
    aisle_vec2 p;  // m
    aisle_vec2 d1; // first derivative by u
    aisle_vec2 d2; // second
} aisle_spline_sample;

// Points closer than 1e-6 m to the one before are merged (the last point is kept exactly). AISLE_ERR_ARG: n < 2, not
// finite, or all the same point. AISLE_ERR_CAPACITY: n > AISLE_SPLINE_POINTS_MAX.
aisle_status aisle_spline_fit(aisle_spline *self, aisle_spline_kind kind, const aisle_vec2 *points, uint32_t n);

// At u, clamped to [0, u[n-1]].
aisle_spline_sample aisle_spline_at(const aisle_spline *self, double u);

// Signed curvature (1/m) of a sample; 0 where |d1| < 1e-9.
double aisle_spline_curvature(const aisle_spline_sample *sample);

// Arc length from u = 0 to the end, exact for LINEAR, else 5-point Gauss-Legendre on each AISLE_SPLINE_GAUSS_CUTS-th of
// a span; relative error below 1e-6 where |d1| stays above a third of its mean, below 1e-3 for any spline.
#define AISLE_SPLINE_GAUSS_CUTS 8U
double aisle_spline_length(const aisle_spline *self);

// Fills out[count] with samples equally spaced by arc length: each within 1 % of the spacing of its place where |d1|
// stays above a tenth of its mean; first and last point exact; count >= 2. O(16 n + count): spans are cut in 16, within
// a cut the speed is taken to change evenly.
void aisle_spline_resample(const aisle_spline *self, uint32_t count, aisle_spline_sample *out);

// Fills out[count] with samples equally spaced in the parameter, which is about the arc length: for sums along the way
// that weigh each sample by the distance to its neighbours. First and last point exact; count >= 2. O(n + count).
void aisle_spline_spread(const aisle_spline *self, uint32_t count, aisle_spline_sample *out);
#endif
