// angle.h - sine, cosine and arc tangent that give the same bits on every board. Level 0.
//
// Only + - * / and sqrt are used, in a fixed order, compiled with -ffp-contract=off; libm's own
// functions differ between C libraries. Stated errors are tested against long double.
// Time: O(1). Memory: none.
#ifndef AISLE_BASE_ANGLE_H
#define AISLE_BASE_ANGLE_H

#define AISLE_PI 3.14159265358979323846
#define AISLE_ANGLE_MAX 1e5 // |angle| the reduction is good for, rad

// Sine and cosine; absolute error at most 1e-15 for |angle| <= AISLE_ANGLE_MAX. NaN in, NaN out.
void aisle_sincos(double angle, double *sine, double *cosine);

// Angle of (x, y) in (-pi, pi]; absolute error at most 1e-15; 0 for (0, 0).
double aisle_atan2(double y, double x);

// exp(x) for x in [-700, 700]; relative error at most 1e-14.
double aisle_exp(double x);

// The same direction in (-pi, pi].
double aisle_angle_wrap(double angle);

// The short way round from a to b, in (-pi, pi].
double aisle_angle_difference(double from, double to);
#endif
