// collide.h - the verifier's narrow phase: do two rounded convex shapes touch? Level 1; the one user of libccd.
//
// ccdMPRIntersect on prisms 1 m high over the shapes (DESIGN.md "libccd"): tolerance 9e-10 m, centres skewed in height
// (flat prisms with level centres raise false alarms up to 9 cm away), support points grown by the radius. Coordinates
// are shifted to the first shape, checked for finiteness and range; more than AISLE_COLLIDE_SUPPORT_MAX support calls,
// or anything unfit, is answered "they touch". Shares no code with shape.h's gap functions. Errors: none on the unsafe
// side: shapes that touch or overlap are always found; shapes up to AISLE_COLLIDE_SPARE apart may be called touching.
// (MPR stops short by up to its tolerance where outlines are round, so every shape is grown by as much.) Hull of two
// placements: a body moving straight without turning sweeps the hull of its end placements; its support point is the
// better of both, so the sweep is one exact query. Memory: stack only (libccd's MPR does not allocate; ccd_t is filled
// by hand, CCD_INIT would pull in malloc). Time: O(n) a support call, at most 28 calls seen in 7 million pairs.
#ifndef AISLE_WORLD_COLLIDE_H
#define AISLE_WORLD_COLLIDE_H

#include "base/vec.h"

#include <stdbool.h>
#include <stdint.h>

#ifndef AISLE_COLLIDE_SUPPORT_MAX
#define AISLE_COLLIDE_SUPPORT_MAX 200U
#endif
#define AISLE_COLLIDE_POINTS_MAX 32U
#define AISLE_COLLIDE_COORD_MAX 1e5 // m, of points and radius
#define AISLE_COLLIDE_SPARE 1.1e-9  // m

typedef struct aisle_collide_body { // hull of the points of a and of b, grown by radius
    const aisle_vec2 *a;
    const aisle_vec2 *b; // NULL: a alone
    uint32_t n;          // points in each, [1, 32]
    double radius;       // m, >= 0
} aisle_collide_body;

typedef struct aisle_collide_count { // add up over queries; start with zeros
    int64_t calls;                   // queries
    int64_t unfit;                   // answered "they touch" without proof: not finite, out of range, no end in sight
    uint32_t support_max;            // most support calls of one query
} aisle_collide_count;

// True if the shapes touch, overlap, or cannot be judged. count may be NULL.
bool aisle_collide(const aisle_collide_body *first, const aisle_collide_body *second, aisle_collide_count *count);
#endif
