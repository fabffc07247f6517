// In place of arm_route.c and all behind it in a library without the arm: every goal is answered NO_ARM.
#include "plan/arm_route.h"

void aisle_arm_route_carve(aisle_arm_route *self, aisle_arena *arena, uint32_t nodes) {
    (void)nodes;
    void *path = aisle_arena_take(arena, 1U, sizeof(aisle_arm_path_msg));
    if (self != NULL) {
        self->path = (aisle_arm_path_msg *)path;
    }
}

void aisle_arm_route_start(aisle_arm_route *self, const aisle_layout *layout, const aisle_vehicle *vehicle,
                           const aisle_vehicle_msg *vehicle_msg, const aisle_arm_request *request, uint32_t budget) {
    (void)layout;
    (void)vehicle;
    (void)vehicle_msg;
    (void)budget;
    self->path->arm_goal_id = request->goal.arm_goal_id;
    self->cause = (aisle_refusal){AISLE_STATUS_NO_ARM, 0, 0.0F};
    self->spent = 0;
    self->size = 0;
}

aisle_status aisle_arm_route_step(aisle_arm_route *self, uint32_t units) {
    (void)self;
    (void)units;
    return AISLE_OK;
}
