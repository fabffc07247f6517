#include "robot/arm_dynamics.h"

#include "base/angle.h"

#include <string.h>

void aisle_arm_dynamics_begin(aisle_arm_dynamics *self, const aisle_arm *arm, double base_theta) {
    memset(self, 0, sizeof *self);
    self->links = arm->links;
    self->base_theta = base_theta;
    double beyond = 0.0; // mass carried by the end of link i
    for (uint32_t i = arm->links; i-- > 0U;) {
        const double l = arm->length[i], m = arm->mass[i], r = arm->radius[i];
        const double first = 0.5 * m + beyond; // of mass along link i, times its length
        self->a[i][i] = m * (l * l / 12.0 + r * r / 4.0) + 0.25 * m * l * l + beyond * l * l;
        self->weight[i] = arm->gravity * first * l;
        for (uint32_t j = 0; j < i; j++) {
            self->a[i][j] = self->a[j][i] = first * l * arm->length[j];
        }
        beyond += m;
    }
}

static void sum_up(const aisle_arm_dynamics *self, const double *v, double *sums, double first) {
    for (uint32_t i = 0; i < self->links; i++) {
        first += v[i];
        sums[i] = first;
    }
}

// The force that turns link i's direction, d/dt dL/dphid_i - dL/dphi_i, without gravity.
static double turning(const aisle_arm_dynamics *self, uint32_t i, const double *phi, const double *rate,
                      const double *change) {
    double force = self->a[i][i] * change[i];
    for (uint32_t j = 0; j < self->links; j++) {
        if (j != i) {
            double s, c;
            aisle_sincos(phi[i] - phi[j], &s, &c);
            force += self->a[i][j] * (c * change[j] + s * rate[j] * rate[j]);
        }
    }
    return force;
}

void aisle_arm_torque(const aisle_arm_dynamics *self, const double *q, const double *qd, const double *qdd,
                      double *inertia, double *gravity) {
    double phi[AISLE_ARM_LINKS], rate[AISLE_ARM_LINKS], change[AISLE_ARM_LINKS];
    sum_up(self, q, phi, self->base_theta);
    sum_up(self, qd, rate, 0.0);
    sum_up(self, qdd, change, 0.0);
    double moved = 0.0, lifted = 0.0; // joint j carries every direction from j on
    for (uint32_t i = self->links; i-- > 0U;) {
        if (inertia != NULL) {
            moved += turning(self, i, phi, rate, change);
            inertia[i] = moved;
        }
        if (gravity != NULL) {
            double s, c;
            aisle_sincos(phi[i], &s, &c);
            lifted += self->weight[i] * c;
            gravity[i] = lifted;
        }
    }
}

double aisle_arm_kinetic(const aisle_arm_dynamics *self, const double *q, const double *qd) {
    double phi[AISLE_ARM_LINKS], rate[AISLE_ARM_LINKS], sum = 0.0;
    sum_up(self, q, phi, self->base_theta);
    sum_up(self, qd, rate, 0.0);
    for (uint32_t i = 0; i < self->links; i++) {
        for (uint32_t j = 0; j < self->links; j++) {
            double s, c;
            aisle_sincos(phi[i] - phi[j], &s, &c);
            sum += 0.5 * self->a[i][j] * c * rate[i] * rate[j];
        }
    }
    return sum;
}

double aisle_arm_potential(const aisle_arm_dynamics *self, const double *q) {
    double phi[AISLE_ARM_LINKS], sum = 0.0;
    sum_up(self, q, phi, self->base_theta);
    for (uint32_t i = 0; i < self->links; i++) {
        double s, c;
        aisle_sincos(phi[i], &s, &c);
        sum += self->weight[i] * s;
    }
    return sum;
}
