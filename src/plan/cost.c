#include "plan/cost.h"

#include "plan/zones.h"

double aisle_leg_cost(const aisle_space *space, const aisle_objective *objective, aisle_vec2 a, aisle_vec2 b,
                      uint32_t *units) {
    double length = aisle_vec2_distance(a, b);
    if (aisle_objective_is_length(objective)) {
        return length;
    }
    uint32_t steps = (uint32_t)(length / (2.0 * space->grid->lattice.res)) + 1U;
    double sum = 0.0;
    for (uint32_t i = 0; i < steps; i++) {
        aisle_vec2 p = aisle_vec2_lerp(a, b, ((double)i + 0.5) / (double)steps);
        sum += aisle_objective_density(objective, aisle_space_clearance_about(space, p), 0.0);
    }
    *units += (steps + 3U) / 4U; // a sample costs about a quarter of a grid node
    return sum * length / (double)steps + aisle_zones_toll(space->layout, objective, a, b);
}
