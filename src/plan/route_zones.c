#include "plan/route_stages.h"

bool aisle_route_way_obeys(aisle_route *self) {
    if (!aisle_zones_any_directed(self->layout)) {
        return true;
    }
    const aisle_compose_request request = aisle_route_build_request(self);
    aisle_opposed opposed;
    const uint32_t zones = aisle_compose_way_opposed(&self->compose, &request, self->leg, &opposed);
    if (zones > 0U && self->opposed_zones == 0U) {
        self->opposed = opposed;
        self->opposed_zones = zones;
    }
    return zones == 0U;
}

void aisle_route_begin_zones(aisle_route *self) {
    const aisle_vec2 from = aisle_route_place(aisle_route_leg_start(self, self->leg));
    const aisle_vec2 to = aisle_route_place(&self->request.goals[self->leg]);
    const bool is_near = aisle_zones_is_near_directed(self->layout, from, AISLE_ZONES_ROOM) ||
                         aisle_zones_is_near_directed(self->layout, to, AISLE_ZONES_ROOM);
    self->space.zone_room = is_near ? 0.0 : AISLE_ZONES_ROOM;
    self->opposed_zones = 0;
    self->is_one_way_asked = false;
}

bool aisle_route_begin_one_way(aisle_route *self) {
    if (self->is_one_way_asked || self->no_way || !aisle_zones_any_directed(self->layout)) {
        return false;
    }
    self->is_one_way_asked = true;
    aisle_one_way_start(
        &self->one_way, &self->seed, &self->space, aisle_route_place(aisle_route_leg_start(self, self->leg)),
        aisle_route_place(&self->request.goals[self->leg]), self->vehicle->inner_radius + self->vehicle->margin);
    self->stage = AISLE_ROUTE_ONE_WAY;
    return true;
}

// Proved. A way that disobeys was found before: without the zones it is against it would do.
static aisle_status refuse(aisle_route *self) {
    const aisle_goal_msg *goal = &self->request.goals[self->leg];
    if (self->opposed_zones == 0U) {
        (void)aisle_route_refuse_at(self, AISLE_STATUS_NO_PATH, goal->id, 0.0, aisle_route_place(goal));
    } else {
        (void)aisle_route_refuse_at(self, AISLE_STATUS_NO_PATH, self->opposed.id, 0.0, self->opposed.place);
    }
    aisle_route_name_goal(self, goal);
    for (uint32_t i = 0; self->opposed_zones == 1U && i < aisle_layout_zone_count(self->layout); i++) {
        const aisle_zone *zone = aisle_layout_zone(self->layout, i);
        if (zone->id == self->opposed.id) {
            aisle_route_tell_zone(self, zone);
        }
    }
    return AISLE_OK;
}

aisle_status aisle_route_step_one_way(aisle_route *self, uint32_t units) {
    const aisle_status st = aisle_one_way_step(&self->one_way, units, &self->spent);
    if (st == AISLE_BUSY) {
        return AISLE_BUSY;
    }
    if (st == AISLE_OK) {
        return refuse(self);
    }
    if (self->space.zone_room > 0.0) { // perhaps nearer to the zones there is one
        self->space.zone_room = 0.0;
        aisle_route_begin_seed(self, 0);
    } else {
        aisle_route_end_attempts(self);
    }
    return AISLE_BUSY;
}
