// objective.h - what a metre of path costs, by its clearance and curvature. Level 4.
//
// Every objective is an integral of a density over the length, so the grid search, the taut string, the swarm and the
// final comparison all mean the same thing by "better":
//     SHORTEST      1
//     SAFEST        1 + risk_weight * max(1 - clearance / creep_clearance, 0)
//     FASTEST       v_max / v,        v = the speed limit there (v_max, creep_speed, lateral acceleration, turn rate)
//     LEAST_ENERGY  (m g c / eff + idle_power / v) / (m g c / eff + idle_power / v_max)
// Densities are at least 1 (an integer grid can use them) and at most AISLE_OBJECTIVE_DENSITY_MAX. Keeping the margin
// is never part of it: a path that does not is not compared at all (feasibility first). SAFEST's risk_weight 0 means
// AISLE_OBJECTIVE_RISK_WEIGHT: a metre at the margin may be avoided by a detour of so many metres with full clearance.
// Ours: PAPERS 1 multiplies length by (1 + beta OA), the same integral with circles for shapes.
#ifndef AISLE_PLAN_OBJECTIVE_H
#define AISLE_PLAN_OBJECTIVE_H

#include "aisle/messages.h"
#include "robot/vehicle.h"

#define AISLE_OBJECTIVE_RISK_WEIGHT 15.0
#define AISLE_OBJECTIVE_DENSITY_MAX 16.0
#define AISLE_PENALTY_WEIGHT 15.0 // of a PENALTY zone's value: a metre at value 1 is as bad as one at the margin
#define AISLE_GRAVITY 9.81        // m/s2

typedef struct aisle_objective {
    int8_t kind;        // AISLE_OPTIONS_SAFEST, ...
    double risk_weight; // [0, 15]
    double creep_clearance, creep_speed, v_max, omega_max, lateral_a_max;
    double rolling, idle; // N, W, both divided by what they give at v_max
    bool has_tolls;       // zones add to it (zones.h): whoever knows the layout sets it; false at first
} aisle_objective;

// False: the options name no objective of this kind.
bool aisle_objective_of(const aisle_options_msg *options, const aisle_vehicle *vehicle, aisle_objective *out);

// Cost per metre, in [1, AISLE_OBJECTIVE_DENSITY_MAX]; clearance m (negative reads as 0), curvature 1/m of either sign.
double aisle_objective_density(const aisle_objective *self, double clearance, double curvature);

// True if the cost does not depend on the place: only the length counts.
bool aisle_objective_is_length(const aisle_objective *self);
#endif
