// outline.h - rounded convex outlines and the gap between them, on their own: the judge's geometry. Level 5.
//
// Shares nothing with the core's shapes (world/shape.h): what is judged here is what the core proves there.
// Metres, double. Memory: the caller's. Time: O(n * m).
#ifndef AISLE_SIM_OUTLINE_H
#define AISLE_SIM_OUTLINE_H

#include "base/vec.h"

#include <stdint.h>

#define AISLE_SIM_OUTLINE_MAX 16

// The hull of n points, grown by radius; one point is a disc. Convex, counter-clockwise.
typedef struct aisle_sim_outline {
    uint32_t n; // 1..AISLE_SIM_OUTLINE_MAX
    aisle_vec2 v[AISLE_SIM_OUTLINE_MAX];
    double radius; // >= 0
} aisle_sim_outline;

aisle_sim_outline aisle_sim_disc(aisle_vec2 centre, double radius);
aisle_sim_outline aisle_sim_box(double x0, double y0, double x1, double y1);

// Turned by theta about the body's origin, then moved to (x, y). libm's sine and cosine.
aisle_sim_outline aisle_sim_outline_at(const aisle_sim_outline *body, aisle_pose2 pose);

// Greatest distance of a body point from the body's origin.
double aisle_sim_outline_reach(const aisle_sim_outline *body);

// Gap between two outlines; 0 if they touch or overlap.
double aisle_sim_gap(const aisle_sim_outline *a, const aisle_sim_outline *b);

// Gap between an outline and a point.
double aisle_sim_gap_to(const aisle_sim_outline *a, aisle_vec2 p);
#endif
