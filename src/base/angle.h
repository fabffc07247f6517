// angle.h - sine, cosine, arc tangent and exponential that give the same bits on every board. Level 0.
//
// Only + - * /, fabs and floor are used, in a fixed order, compiled with -ffp-contract=off; libm's own
// functions differ between C libraries. Stated errors are tested against long double.
// Method: reduction by Cody & Waite (1980, "Software Manual for the Elementary Functions"), polynomials of
// our own fit. Ours, not theirs: three parts of pi/2 and nothing for huge angles, which are refused.
// Memory: none. Time: O(1), no loop; 10 to 20 ns each on a 3 GHz x86-64. Reentrant.
#ifndef AISLE_BASE_ANGLE_H
#define AISLE_BASE_ANGLE_H

#define AISLE_PI 3.14159265358979323846
#define AISLE_ANGLE_MAX 1e5 // |angle| the reduction is good for, rad
#define AISLE_EXP_MAX 700.0 // |x| whose exponential is computed

// Sine and cosine; absolute error at most 2e-16 for |angle| <= AISLE_ANGLE_MAX, both in [-1, 1]. Odd and
// even to the bit: sin(-a) = -sin a, cos(-a) = cos a. NaN for NaN and for angles beyond AISLE_ANGLE_MAX.
void aisle_sincos(double angle, double *sine, double *cosine);

// Angle of (x, y) in (-pi, pi]; absolute error at most 1e-15 (4e-16 for x >= 0); 0 for (0, 0), either sign
// of zero being plain zero: -0 beside a negative x gives pi. Directions closer to -pi than the last double
// above it count as pi. |x|, |y| up to 1e300; NaN in, NaN out.
double aisle_atan2(double y, double x);

// exp(x) for |x| <= AISLE_EXP_MAX; relative error at most 5e-16; exp(0) is 1. Beyond: 0 or INFINITY. NaN in,
// NaN out.
double aisle_exp(double x);

// The same direction in (-pi, pi]; an angle already in it comes back unchanged, others with an absolute
// error of at most 1e-15. NaN for NaN and for angles beyond AISLE_ANGLE_MAX.
double aisle_angle_wrap(double angle);

// The short way round from one angle to the other, in (-pi, pi]: wrap(to - from).
double aisle_angle_difference(double from, double to);
#endif
