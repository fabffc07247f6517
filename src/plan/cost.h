// cost.h - what a straight leg costs under an objective, by samples of the distance field. Level 4.
#ifndef AISLE_PLAN_COST_H
#define AISLE_PLAN_COST_H

#include "plan/objective.h"
#include "plan/space.h"

// Integral of the density from a to b (m), by samples about two cells apart at about the clearance there, and the zones'
// tolls; the plain length for SHORTEST without tolls. O(length / cell). Says nothing about whether the leg is free.
double aisle_leg_cost(const aisle_space *space, const aisle_objective *objective, aisle_vec2 a, aisle_vec2 b,
                      uint32_t *units);
#endif
