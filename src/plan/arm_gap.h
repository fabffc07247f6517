// arm_gap.h - how far the axis of a link is from a hull, as fast as can be. Level 4.
//
// What shape.h's gap is for any two shapes, for the one pair that arms ask about a million times: an axis on the far side of an edge of
// the hull is as far off as that edge's line, so most axes are known to be out of sight before any distance is measured; and only
// edges that an end of the axis is beyond are measured. Same answers, to AISLE_ARM_GAP_ERROR.
// Memory: none. Time: O(vertices).
#ifndef AISLE_PLAN_ARM_GAP_H
#define AISLE_PLAN_ARM_GAP_H

#include "world/shape.h"

#define AISLE_ARM_GAP_ERROR 4e-9 // m

// No edge shorter than a micron, and no vertex beyond another edge by more than a dent (shape.h): what the fast way needs. Radius
// is not looked at. O(n2).
bool aisle_arm_gap_is_plain(const aisle_convex *hull);

// Gap (m) between the axis from a to b and the hull without its radius; 0: they meet; cap (> 0): it is cap or more. plain: of
// aisle_arm_gap_is_plain(); false: by shape.h.
double aisle_arm_axis_gap(const aisle_convex *hull, bool plain, aisle_vec2 a, aisle_vec2 b, double cap);
#endif
