// arm_usual.h - test fixture: the arm that tests of motions are asked of.
#ifndef AISLE_TESTS_ARM_USUAL_H
#define AISLE_TESTS_ARM_USUAL_H

#include "aisle/messages.h"

#include <string.h>

// A vehicle of 1.0 x 0.7 m, its other figures the usual ones, with an arm of 0.5, 0.4 and 0.3 m at the middle of its front.
__attribute__((unused)) static void arm_usual(aisle_vehicle_msg *out) {
    memset(out, 0, sizeof *out);
    out->num_links = 3;
    out->arm_base[0] = 0.5;
    for (int i = 0; i < 3; i++) {
        out->link_length[i] = 0.5F - 0.1F * (float)i;
        out->link_radius[i] = 0.03F;
        out->joint_min[i] = i == 0 ? -1.0F : -2.8F;
        out->joint_max[i] = -out->joint_min[i];
    }
}
#endif
