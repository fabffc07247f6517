#include "base/angle.h"
#include "plan/route_stages.h"

#include <string.h>

#define OTHER_WAY 0.02     // of its length, by which a longer way is another one
#define EASE_UNITS 300000U // of the search for a manoeuvre that keeps clear

bool aisle_route_has_heading(const aisle_route *self) {
    return !aisle_vehicle_is_disc(self->vehicle) || self->vehicle->curvature_max > 0.0;
}

// ---- headings

static double direction(const aisle_vec2 *p) {
    return aisle_atan2(p[1].y - p[0].y, p[1].x - p[0].x);
}

// The heading with which a leg that is planned ends; false: any.
static bool heading_after(const aisle_route *self, uint32_t i, double *theta) {
    const aisle_leg *leg = &self->legs[i];
    const aisle_goal_msg *goal = &self->request.goals[i];
    bool known = true;
    if (leg->piece_count > 0U) {
        *theta = self->pieces[leg->piece_first + leg->piece_count - 1U].theta;
    } else if (leg->count >= 2U) {
        *theta = direction(self->points + leg->first + leg->count - 2U);
    } else {
        *theta = leg->heading;
        known = !leg->heading_is_free;
    }
    if (!known ? !aisle_goal_heading_is_free(goal) : aisle_goal_wants_turn(goal, *theta)) {
        *theta = goal->theta;
        known = true;
    }
    return known;
}

void aisle_route_take_heading(aisle_route *self) {
    aisle_leg *leg = &self->legs[self->leg];
    if (self->leg == 0U) {
        leg->heading = self->request.start.theta;
        leg->heading_is_free = aisle_goal_heading_is_free(&self->request.start);
    } else {
        leg->heading_is_free = !heading_after(self, self->leg - 1U, &leg->heading);
    }
}

// ---- turns at the ends of a way

static bool may_turn(aisle_route *self, aisle_vec2 p, double from, double to) {
    double turn = aisle_angle_difference(from, to);
    if (turn > -AISLE_CURVE_HEADING_TOLERANCE && turn < AISLE_CURVE_HEADING_TOLERANCE) {
        return true;
    }
    aisle_waypoint_msg w[2] = {{.x = p.x, .y = p.y, .theta = from, .flags = AISLE_WAYPOINT_TURN_IN_PLACE},
                               {.x = p.x, .y = p.y, .theta = to}};
    double need = self->vehicle->margin + 0.5 * AISLE_SPACE_SLACK;
    return self->vehicle->curvature_max <= 0.0 &&
           aisle_space_piece_free(&self->space, &w[0], &w[1], need, &self->spent);
}

bool aisle_route_ends_free(aisle_route *self) {
    const aisle_leg *leg = &self->legs[self->leg];
    const aisle_goal_msg *goal = &self->request.goals[self->leg];
    if (!aisle_route_has_heading(self)) {
        return true;
    }
    const aisle_vec2 *p = self->points + leg->first;
    double theta = leg->heading;
    bool known = !leg->heading_is_free;
    if (leg->count >= 2U) {
        double first = direction(p);
        if (known && !may_turn(self, p[0], theta, first)) {
            return false;
        }
        theta = direction(p + leg->count - 2U);
        known = true;
    }
    return !known || !aisle_goal_wants_turn(goal, theta) || may_turn(self, p[leg->count - 1U], theta, goal->theta);
}

// ---- MANOEUVRE

void aisle_route_keep_guide(aisle_route *self, double radius, double reach) {
    const aisle_leg *leg = &self->legs[self->leg];
    aisle_route_guide *guide = &self->guide[self->guide[0].count == 0U ? 0 : 1];
    memcpy(guide->points, self->points + leg->first, leg->count * sizeof(aisle_vec2));
    guide->count = leg->count;
    guide->radius = radius;
    guide->reach = reach;
}

static double length_of(const aisle_route_guide *guide) {
    double length = 0.0;
    for (uint32_t i = 1; i < guide->count; i++) {
        length += aisle_vec2_distance(guide->points[i - 1U], guide->points[i]);
    }
    return length;
}

// Is the widest way another one than the tightest, so that it may lead where that does not?
static bool has_other_guide(const aisle_route *self) {
    return self->guide[1].count > 0U && length_of(&self->guide[1]) > (1.0 + OTHER_WAY) * length_of(&self->guide[0]);
}

static void search(aisle_route *self, const aisle_route_guide *guide) {
    const aisle_leg *leg = &self->legs[self->leg];
    const aisle_goal_msg *goal = &self->request.goals[self->leg];
    const aisle_goal_msg *start = aisle_route_leg_start(self, self->leg);
    const aisle_vehicle *vehicle = self->vehicle;
    aisle_space_begin(&self->space, self->layout, vehicle, AISLE_SPACE_ALONG);
    const bool eases = leg->is_eased;
    double theta = goal->theta;
    if (eases) { // the next leg goes on from there
        theta = self->pieces[leg->piece_first + leg->piece_count - 1U].theta;
    }
    const double dear = floor(vehicle->v_max / vehicle->creep_speed + 0.5);
    const aisle_manoeuvre_request request = {.space = &self->space,
                                             .start = {start->x, start->y, aisle_angle_wrap(leg->heading)},
                                             .goal = {goal->x, goal->y, aisle_angle_wrap(theta)},
                                             .start_is_free = leg->heading_is_free,
                                             .goal_is_free = !eases && aisle_goal_heading_is_free(goal),
                                             .way = guide->points,
                                             .way_count = guide->count,
                                             .way_radius = guide->radius,
                                             .reach = guide == &self->guide[0] ? vehicle->inner_radius + vehicle->margin
                                                                               : guide->reach,
                                             .clear = vehicle->creep_clearance + AISLE_ROUTE_CREEP_SPARE,
                                             .dear = eases ? (uint32_t)aisle_clamp(dear, 2.0, AISLE_TOGO_DEAR_MAX) : 1U,
                                             .units = eases ? EASE_UNITS : 0U};
    aisle_manoeuvre_start(&self->manoeuvre, &request);
    self->other_guide = guide != &self->guide[0];
    self->stage = AISLE_ROUTE_MANOEUVRE;
}

bool aisle_route_begin_manoeuvre(aisle_route *self) {
    aisle_leg *leg = &self->legs[self->leg];
    if (self->way_index > 0U || leg->searched || !aisle_route_has_heading(self)) {
        return false;
    }
    leg->searched = true;
    search(self, &self->guide[0]);
    return true;
}

void aisle_route_ease_manoeuvre(aisle_route *self) {
    search(self, &self->guide[0]);
}

// The way found as the leg's. False: the pieces of all legs do not fit.
static bool take_pieces(aisle_route *self) {
    aisle_leg *leg = &self->legs[self->leg];
    uint32_t room = AISLE_ROUTE_PIECES - self->piece_count;
    uint32_t count = aisle_manoeuvre_lay(&self->manoeuvre, self->pieces + self->piece_count, room);
    if (count == 0U) {
        return false;
    }
    leg->piece_first = self->piece_count;
    leg->piece_count = count;
    leg->count = 0;
    leg->mode = AISLE_SPACE_ALONG;
    self->piece_count += leg->piece_count;
    return true;
}

aisle_status aisle_route_step_manoeuvre(aisle_route *self, uint32_t units) {
    aisle_status st = aisle_manoeuvre_step(&self->manoeuvre, units, &self->spent);
    if (st == AISLE_BUSY) {
        return AISLE_BUSY;
    }
    self->nodes += (int64_t)self->manoeuvre.expanded;
    const bool taken = st == AISLE_OK && take_pieces(self);
    if (taken || self->legs[self->leg].is_eased) {
        aisle_route_next_leg(self);
    } else if (!self->other_guide && has_other_guide(self)) {
        search(self, &self->guide[1]);
    } else {
        aisle_route_begin_seed(self, 0);
    }
    return AISLE_BUSY;
}
