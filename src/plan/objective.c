#include "plan/objective.h"

#include "base/check.h"

#include <math.h>

bool aisle_objective_of(const aisle_options_msg *options, const aisle_vehicle *vehicle, aisle_objective *out) {
    if (options->objective < AISLE_OPTIONS_SAFEST || options->objective > AISLE_OPTIONS_LEAST_ENERGY) {
        return false;
    }
    double weight = options->risk_weight > 0.0F ? (double)options->risk_weight : AISLE_OBJECTIVE_RISK_WEIGHT;
    double rolling = vehicle->mass * AISLE_GRAVITY * vehicle->rolling_resistance / vehicle->drive_efficiency;
    double idle = vehicle->idle_power;
    double least = rolling + idle / vehicle->v_max;
    *out = (aisle_objective){.kind = options->objective,
                             .risk_weight = aisle_min(weight, AISLE_OBJECTIVE_DENSITY_MAX - 1.0),
                             .creep_clearance = vehicle->creep_clearance,
                             .creep_speed = vehicle->creep_speed,
                             .v_max = vehicle->v_max,
                             .omega_max = vehicle->omega_max,
                             .lateral_a_max = vehicle->lateral_a_max,
                             .rolling = least > 0.0 ? rolling / least : 1.0,
                             .idle = least > 0.0 ? idle / least : 0.0};
    return true;
}

static double risk(const aisle_objective *self, double clearance) {
    if (self->creep_clearance <= 0.0 || clearance >= self->creep_clearance) {
        return 0.0;
    }
    return 1.0 - aisle_max(clearance, 0.0) / self->creep_clearance;
}

static double speed_limit(const aisle_objective *self, double clearance, double curvature) {
    double v = clearance < self->creep_clearance ? aisle_min(self->creep_speed, self->v_max) : self->v_max;
    double k = fabs(curvature);
    if (k > 1e-9) { // below it neither limit can bind at v_max <= 20 m/s
        v = aisle_min(v, aisle_min(sqrt(self->lateral_a_max / k), self->omega_max / k));
    }
    return v;
}

double aisle_objective_density(const aisle_objective *self, double clearance, double curvature) {
    double density = 1.0;
    switch (self->kind) {
    case AISLE_OPTIONS_SAFEST:
        density = 1.0 + self->risk_weight * risk(self, clearance);
        break;
    case AISLE_OPTIONS_FASTEST:
        density = self->v_max / speed_limit(self, clearance, curvature);
        break;
    case AISLE_OPTIONS_LEAST_ENERGY:
        density = self->rolling + self->idle / speed_limit(self, clearance, curvature);
        break;
    default:
        AISLE_ASSERT(self->kind == AISLE_OPTIONS_SHORTEST);
        break;
    }
    return aisle_clamp(density, 1.0, AISLE_OBJECTIVE_DENSITY_MAX);
}

bool aisle_objective_is_length(const aisle_objective *self) {
    return self->kind == AISLE_OPTIONS_SHORTEST && !self->has_tolls;
}
