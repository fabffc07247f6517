#include "base/angle.h"

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <string.h>

// Coefficients: interpolation at Chebyshev nodes in 60-digit arithmetic, rounded to double; the error
// beside each is the polynomial's own, without rounding.

// Whole turns in three parts (Cody & Waite 1980): the first two have 33 bits, so that their product with a
// count of up to 20 bits is exact.
#define QUARTER_HI 0x1.921fb544p+0
#define QUARTER_MID 0x1.0b4611a6p-34
#define QUARTER_LO 0x1.3198a2e037073p-69
#define QUARTERS_PER_RAD 0.6366197723675814
#define TURNS_PER_RAD 0.15915494309189535

// sin r on |r| <= pi/4; error 1.4e-17.
static double sine_near(double r, double z) {
    const double z2 = z * z;
    const double low = -0x1.5555555555555p-3 + z * 0x1.1111111110bb2p-7;
    const double mid = -0x1.a01a019e83aaep-13 + z * 0x1.71de37968a100p-19;
    const double high = -0x1.ae600b02b6262p-26 + z * 0x1.5e0b19f8b1451p-33;
    return r + (r * z) * (low + z2 * (mid + z2 * high));
}

// cos r on |r| <= pi/4; error 9e-19. 1 - z/2 is rounded; what it lost is added back.
static double cosine_near(double z) {
    const double z2 = z * z;
    const double half = 0.5 * z;
    const double head = 1.0 - half;
    const double low = 0x1.5555555555555p-5 + z * -0x1.6c16c16c16967p-10;
    const double mid = 0x1.a01a019f4eb01p-16 + z * -0x1.27e4fa17da09ep-22;
    const double high = 0x1.1eeb68e93b64cp-29 + z * -0x1.907da367a37cbp-37;
    return head + (((1.0 - head) - half) + z2 * (low + z2 * (mid + z2 * high)));
}

void aisle_sincos(double angle, double *sine, double *cosine) {
    if (!(fabs(angle) <= AISLE_ANGLE_MAX)) { // NaN too
        *sine = *cosine = (double)NAN;
        return;
    }
    const double x = fabs(angle); // so that both signs take the same way
    const double quarters = floor(x * QUARTERS_PER_RAD + 0.5);
    const double r = ((x - quarters * QUARTER_HI) - quarters * QUARTER_MID) - quarters * QUARTER_LO;
    const double z = r * r;
    const double s = sine_near(r, z);
    const double c = cosine_near(z);
    const uint32_t quadrant = (uint32_t)quarters & 3U;
    const bool swapped = (quadrant & 1U) != 0;
    const double a = swapped ? c : s;
    const double b = swapped ? s : c;
    *sine = (quadrant >= 2) != (angle < 0.0) ? -a : a;
    *cosine = quadrant == 1 || quadrant == 2 ? -b : b;
}

// atan t on |t| <= 0.1732; error 8e-19.
static double atan_near(double t) {
    const double z = t * t;
    const double z2 = z * z;
    const double low = -0x1.5555555555553p-2 + z * 0x1.99999999957cbp-3;
    const double mid = -0x1.2492491bfda43p-3 + z * 0x1.c71c645542543p-4;
    const double high = -0x1.74581082c19c8p-4 + z * (0x1.3a1bc22835244p-4 + z * -0x1.f24ba4a627b3ap-5);
    return t + (t * z) * (low + z2 * (mid + z2 * high));
}

// atan(n / d) for 0 <= n <= d, d > 0, from the nearest of three angles: atan c + atan((n - c d) / (d + c n)).
static double atan_ratio(double n, double d) {
    const bool beyond_first = n > 0.155 * d;
    const bool beyond_second = n > 0.512 * d;
    const double c = beyond_second ? 0.75 : (beyond_first ? 0.3125 : 0.0);
    const double base = beyond_second ? 0x1.4978fa3269ee1p-1 : (beyond_first ? 0x1.362773707ebccp-2 : 0.0);
    return base + atan_near((n - c * d) / (d + c * n));
}

double aisle_atan2(double y, double x) {
    const double ax = fabs(x);
    const double ay = fabs(y);
    if (!(ax > 0.0 || ay > 0.0)) {
        return ax + ay; // 0, or NaN
    }
    const bool steep = ay > ax;
    double angle = atan_ratio(steep ? ax : ay, steep ? ay : ax);
    angle = steep ? 0.5 * AISLE_PI - angle : angle;
    angle = x < 0.0 ? AISLE_PI - angle : angle;
    return y < 0.0 && angle < AISLE_PI ? -angle : angle;
}

// 2^k for -1022 <= k <= 1023, from the bits of a double.
static double power_of_two(int32_t k) {
    const uint64_t bits = (uint64_t)(k + 1023) << 52;
    double power;
    memcpy(&power, &bits, sizeof power);
    return power;
}

double aisle_exp(double x) {
    if (!(fabs(x) <= AISLE_EXP_MAX)) {
        if (x > 0.0) {
            return (double)INFINITY;
        }
        return x < 0.0 ? 0.0 : x; // NaN stays
    }
    const double k = floor(x * 0x1.71547652b82fep+0 + 0.5);
    const double r = (x - k * 0x1.62e42fefp-1) - k * 0x1.473de6af278edp-34; // ln 2 in 33 + 53 bits
    const double z = r * r;
    const double z2 = z * z;
    // (e^r - 1 - r) / r^2 on |r| <= ln 2 / 2; error 1.3e-17
    const double a = 0x1.0000000000001p-1 + r * 0x1.5555555555556p-3;
    const double b = 0x1.5555555553d68p-5 + r * 0x1.11111111109b5p-7;
    const double c = 0x1.6c16c17889ef1p-10 + r * 0x1.a01a01a7c2efep-13;
    const double d = 0x1.a019b9149a41cp-16 + r * 0x1.71de0db2f6b19p-19;
    const double e = 0x1.28917c89a43a7p-22 + r * 0x1.af389ecfc4b9cp-26;
    const double tail = (a + z * b) + z2 * ((c + z * d) + z2 * e);
    return (1.0 + (r + z * tail)) * power_of_two((int32_t)k);
}

double aisle_angle_wrap(double angle) {
    if (angle > -AISLE_PI && angle <= AISLE_PI) {
        return angle;
    }
    if (!(fabs(angle) <= AISLE_ANGLE_MAX)) {
        return (double)NAN;
    }
    const double turns = floor(angle * TURNS_PER_RAD + 0.5);
    const double rest =
        ((angle - turns * (4.0 * QUARTER_HI)) - turns * (4.0 * QUARTER_MID)) - turns * (4.0 * QUARTER_LO);
    // Rounding may leave it on or one unit beyond the cut: that is the cut itself.
    return rest > -AISLE_PI && rest <= AISLE_PI ? rest : AISLE_PI;
}

double aisle_angle_difference(double from, double to) {
    return aisle_angle_wrap(to - from);
}
