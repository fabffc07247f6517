#include "plan/verify_arm.h"

#include "base/angle.h"
#include "base/check.h"
#include "base/digest.h"
#include "base/poly.h"
#include "plan/arm_world.h" // ids of body and arm, and the rule of the mount
#include "wire/codec.h"

#include <string.h>

#define SAME_ANGLE 1e-6      // rad
#define LIMIT_SLACK 1e-9     // relative, of limits: rounding of the bounds
#define PARTS_MAX 64U        // of a piece
#define TORQUE_TOLD 1e-3     // of the limit
#define TORQUE_STEP_MIN 1e-6 // of a piece

typedef aisle_verify_arm_fault fault;

static uint32_t links_of(const aisle_verify_arm *self) {
    return self->request.arm->links;
}

// ---- header

// Numbers of joints that the arm does not have.
static bool has_ghosts(const aisle_verify_arm *self, const aisle_arm_waypoint_msg *w) {
    double sum = 0.0;
    for (uint32_t j = links_of(self); j < AISLE_ARM_LINKS; j++) {
        sum += fabs((double)w->q[j]) + fabs((double)w->qd[j]) + fabs((double)w->qdd[j]) + fabs((double)w->torque[j]);
    }
    return sum > 0.0;
}

static bool rests(const aisle_verify_arm *self, const aisle_arm_waypoint_msg *w) {
    double sum = 0.0;
    for (uint32_t j = 0; j < links_of(self); j++) {
        sum += fabs((double)w->qd[j]) + fabs((double)w->qdd[j]);
    }
    return !(sum > 0.0);
}

static bool starts_right(const aisle_verify_arm *self, const aisle_arm_waypoint_msg *w) {
    for (uint32_t j = 0; j < links_of(self); j++) {
        if (!(fabs((double)w->q[j] - (double)self->request.goal->q_start[j]) <= SAME_ANGLE)) {
            return false;
        }
    }
    return true;
}

static double tolerance_of(float told, double usual) {
    return told > 0.0F ? (double)told : usual;
}

static void place(const aisle_arm *arm, aisle_pose2 base, const double *q, aisle_vec2 *points) {
    double angle = base.theta;
    points[0] = aisle_vec2_of(base.x, base.y);
    for (uint32_t i = 0; i < arm->links; i++) {
        double s, c;
        angle += q[i];
        aisle_sincos(angle, &s, &c);
        points[i + 1U] = aisle_vec2_of(points[i].x + arm->length[i] * c, points[i].y + arm->length[i] * s);
    }
}

bool aisle_verify_arm_reaches(const aisle_arm *arm, aisle_pose2 base, const aisle_arm_goal_msg *goal, const double *q) {
    const double turn = tolerance_of(goal->tolerance_theta, AISLE_VERIFY_ARM_TOLERANCE_THETA);
    if (goal->kind == AISLE_ARM_GOAL_JOINTS || goal->kind == AISLE_ARM_GOAL_STOW) {
        double stow[AISLE_ARM_LINKS];
        aisle_arm_stow(arm, stow);
        for (uint32_t j = 0; j < arm->links; j++) {
            const double want = goal->kind == AISLE_ARM_GOAL_JOINTS ? (double)goal->q[j] : stow[j];
            if (!(fabs(q[j] - want) <= turn)) {
                return false;
            }
        }
        return true;
    }
    aisle_vec2 points[AISLE_ARM_LINKS + 1U];
    double angle = base.theta;
    place(arm, base, q, points);
    for (uint32_t j = 0; j < arm->links; j++) {
        angle += q[j];
    }
    const double off = aisle_vec2_distance(points[arm->links], aisle_vec2_of(goal->x, goal->y));
    return off <= tolerance_of(goal->tolerance_xy, AISLE_VERIFY_ARM_TOLERANCE) &&
           (goal->kind == AISLE_ARM_GOAL_POINT || fabs(aisle_angle_difference(angle, goal->theta)) <= turn);
}

static fault check_ids(const aisle_verify_arm *self) {
    const aisle_arm_path_msg *path = self->path;
    const aisle_verify_arm_request *r = &self->request;
    const bool fits =
        path->status == AISLE_PATH_OK && path->cause == 0 && path->cause_id == 0 && path->num_waypoints >= 1 &&
        path->arm_goal_id == r->goal->arm_goal_id && path->map_id == aisle_layout_map_id(r->layout) &&
        path->map_revision == aisle_layout_map_revision(r->layout) && path->vehicle_revision == r->vehicle->revision;
    return fits ? AISLE_VERIFY_ARM_NONE : AISLE_VERIFY_ARM_DECODE;
}

static fault check_header(aisle_verify_arm *self) {
    const aisle_arm_path_msg *path = self->path;
    if (aisle_msg_decode(AISLE_MSG_ARM_PATH, self->request.bytes, self->request.size, self->path, NULL) != AISLE_OK ||
        check_ids(self) != AISLE_VERIFY_ARM_NONE) {
        return AISLE_VERIFY_ARM_DECODE;
    }
    const aisle_arm_waypoint_msg *first = &path->waypoints[0], *last = &path->waypoints[path->num_waypoints - 1];
    float least = first->clearance;
    for (int16_t i = 0; i < path->num_waypoints; i++) {
        const aisle_arm_waypoint_msg *w = &path->waypoints[i];
        least = w->clearance < least ? w->clearance : least;
        if (has_ghosts(self, w)) {
            return AISLE_VERIFY_ARM_DECODE;
        }
    }
    double q[AISLE_ARM_LINKS];
    for (uint32_t j = 0; j < links_of(self); j++) {
        q[j] = (double)last->q[j];
    }
    if (path->duration < last->t || path->duration > last->t || path->clearance_min < least ||
        path->clearance_min > least) {
        return AISLE_VERIFY_ARM_DECODE;
    }
    if (first->t < 0.0F || first->t > 0.0F || (double)last->t > AISLE_VERIFY_ARM_TIME_MAX) {
        return AISLE_VERIFY_ARM_TIME;
    }
    if (!starts_right(self, first)) {
        return AISLE_VERIFY_ARM_START;
    }
    if (!rests(self, first) || !rests(self, last)) {
        return AISLE_VERIFY_ARM_REST;
    }
    return aisle_verify_arm_reaches(self->request.arm, self->base, self->request.goal, q) ? AISLE_VERIFY_ARM_NONE
                                                                                          : AISLE_VERIFY_ARM_GOAL;
}

// ---- pieces

// Quintic in u that has these values, rates and accelerations (times in dt) at both ends.
static void quintic(double q0, double v0, double a0, double q1, double v1, double a1, double *c) {
    const double d = q1 - q0;
    c[0] = q0;
    c[1] = v0;
    c[2] = 0.5 * a0;
    c[3] = 10.0 * d - 6.0 * v0 - 4.0 * v1 - 1.5 * a0 + 0.5 * a1;
    c[4] = -15.0 * d + 8.0 * v0 + 7.0 * v1 + 1.5 * a0 - a1;
    c[5] = 6.0 * d - 3.0 * (v0 + v1) + 0.5 * (a1 - a0);
}

static bool take_piece(aisle_verify_arm *self) {
    const aisle_arm_waypoint_msg *a = &self->path->waypoints[self->at - 1U], *b = &self->path->waypoints[self->at];
    const double dt = (double)b->t - (double)a->t;
    self->dt = dt;
    for (uint32_t j = 0; j < links_of(self); j++) {
        quintic((double)a->q[j], (double)a->qd[j] * dt, (double)a->qdd[j] * dt * dt, (double)b->q[j],
                (double)b->qd[j] * dt, (double)b->qdd[j] * dt * dt, self->c[j]);
    }
    self->lo = 0.0;
    self->hi[0] = 1.0;
    self->depth = 1;
    return dt > 0.0;
}

// Is the polynomial within [lo, hi] on [0, 1]?
static bool is_within(const double *c, uint32_t degree, double lo, double hi) {
    for (uint32_t parts = 1; parts <= PARTS_MAX; parts *= 2U) {
        bool is_proved = true;
        for (uint32_t i = 0; i < parts && is_proved; i++) {
            double least, most;
            aisle_poly_bounds(c, degree, (double)i / (double)parts, (double)(i + 1U) / (double)parts, &least, &most);
            is_proved = least >= lo && most <= hi;
        }
        if (is_proved) {
            return true;
        }
    }
    return false;
}

static fault check_limits(aisle_verify_arm *self) {
    const aisle_arm *arm = self->request.arm;
    const double slack = 1.0 + LIMIT_SLACK, dt = self->dt;
    for (uint32_t j = 0; j < links_of(self); j++) {
        double c[6];
        const double v = arm->v_max[j] * slack * dt, a = arm->a_max[j] * slack * dt * dt;
        const double jerk = arm->j_max[j] * slack * dt * dt * dt;
        self->fault_joint = j;
        memcpy(c, self->c[j], sizeof c);
        if (!is_within(c, 5U, arm->min[j] - SAME_ANGLE, arm->max[j] + SAME_ANGLE)) {
            return AISLE_VERIFY_ARM_JOINT;
        }
        if (!is_within(c, aisle_poly_derivative(c, 5U, c), -v, v)) {
            return AISLE_VERIFY_ARM_VELOCITY;
        }
        if (!is_within(c, aisle_poly_derivative(c, 4U, c), -a, a)) {
            return AISLE_VERIFY_ARM_ACCELERATION;
        }
        if (!is_within(c, aisle_poly_derivative(c, 3U, c), -jerk, jerk)) {
            return AISLE_VERIFY_ARM_JERK;
        }
    }
    return AISLE_VERIFY_ARM_NONE;
}

// ---- torque

typedef struct motion { // of all joints at a place
    double q[AISLE_ARM_LINKS], rate[AISLE_ARM_LINKS], change[AISLE_ARM_LINKS];
} motion;

static void motion_at(const aisle_verify_arm *self, double u, motion *out) {
    for (uint32_t j = 0; j < links_of(self); j++) {
        double c[6];
        out->q[j] = aisle_poly_value(self->c[j], 5U, u);
        (void)aisle_poly_derivative(self->c[j], 5U, c);
        out->rate[j] = aisle_poly_value(c, 4U, u) / self->dt;
        (void)aisle_poly_derivative(c, 4U, c);
        out->change[j] = aisle_poly_value(c, 3U, u) / (self->dt * self->dt);
    }
}

// Newton and Euler: accelerations outwards, then forces and torques inwards.
static void newton_euler(const aisle_arm *arm, double base_theta, const motion *m, double *torque) {
    aisle_vec2 axis[AISLE_ARM_LINKS], pull[AISLE_ARM_LINKS]; // along a link; mass times its centre's acceleration
    double spin[AISLE_ARM_LINKS];                            // of a link
    aisle_vec2 joint = {0.0, arm->gravity};                  // a base that rises stands for weight
    double angle = base_theta, omega = 0.0, alpha = 0.0;
    for (uint32_t i = 0; i < arm->links; i++) {
        double s, c;
        angle += m->q[i];
        omega += m->rate[i];
        alpha += m->change[i];
        aisle_sincos(angle, &s, &c);
        axis[i] = aisle_vec2_of(arm->length[i] * c, arm->length[i] * s);
        const aisle_vec2 end = {-alpha * axis[i].y - omega * omega * axis[i].x,
                                alpha * axis[i].x - omega * omega * axis[i].y};
        pull[i] = aisle_vec2_scale(aisle_vec2_add(joint, aisle_vec2_scale(end, 0.5)), arm->mass[i]);
        joint = aisle_vec2_add(joint, end);
        spin[i] = alpha;
    }
    aisle_vec2 force = {0.0, 0.0};
    double moment = 0.0;
    for (uint32_t i = arm->links; i-- > 0U;) {
        const double l = arm->length[i], r = arm->radius[i];
        moment += arm->mass[i] * (l * l / 12.0 + r * r / 4.0) * spin[i] +
                  aisle_vec2_cross(aisle_vec2_scale(axis[i], 0.5), pull[i]) + aisle_vec2_cross(axis[i], force);
        force = aisle_vec2_add(force, pull[i]);
        torque[i] = moment;
    }
}

static double mass_from(const aisle_arm *arm, uint32_t link) {
    double sum = 0.0;
    for (uint32_t i = link; i < arm->links; i++) {
        sum += arm->mass[i];
    }
    return sum;
}

// Bounds of the sums of derivatives of q up to joint k on [a, b]: |phid|, |phidd|, |phiddd|.
static void sum_bounds(const aisle_verify_arm *self, double a, double b, double most[3][AISLE_ARM_LINKS]) {
    double c[6] = {0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
    for (uint32_t k = 0; k < links_of(self); k++) {
        double d[6], scale = 1.0;
        for (uint32_t i = 0; i < 6U; i++) {
            c[i] += self->c[k][i];
        }
        memcpy(d, c, sizeof d);
        for (uint32_t order = 0; order < 3U; order++) {
            double lo, hi;
            (void)aisle_poly_derivative(d, 5U - order, d);
            scale /= self->dt;
            aisle_poly_bounds(d, 4U - order, a, b, &lo, &hi);
            most[order][k] = aisle_max(-lo, hi) * scale;
        }
    }
}

// Bound of |d tau_i / dt| on [a, b], by the header's sum.
static void torque_slopes(const aisle_verify_arm *self, double a, double b, double *slope) {
    const aisle_arm *arm = self->request.arm;
    double most[3][AISLE_ARM_LINKS], sum = 0.0;
    sum_bounds(self, a, b, most);
    for (uint32_t k = arm->links; k-- > 0U;) {
        for (uint32_t j = 0; j < arm->links; j++) {
            double inertia = mass_from(arm, j > k ? j : k) * arm->length[k] * arm->length[j];
            const double apart = j == k ? 0.0 : most[0][k] + most[0][j], r = arm->radius[k], l = arm->length[k];
            inertia += j == k ? arm->mass[k] * (l * l / 12.0 + r * r / 4.0) : 0.0;
            sum += inertia * (apart * (most[1][j] + most[0][j] * most[0][j]) + most[2][j] +
                              (j == k ? 0.0 : 2.0 * most[0][j] * most[1][j]));
        }
        sum += fabs(arm->gravity) * mass_from(arm, k) * arm->length[k] * most[0][k];
        slope[k] = sum;
    }
}

static void halve(aisle_verify_arm *self) {
    const double middle = 0.5 * (self->lo + self->hi[self->depth - 1U]);
    AISLE_ASSERT(self->depth < AISLE_VERIFY_ARM_DEPTH);
    self->hi[self->depth++] = middle;
}

static void pass(aisle_verify_arm *self) {
    self->lo = self->hi[--self->depth];
}

static fault look_at_torque(aisle_verify_arm *self) {
    const aisle_arm *arm = self->request.arm;
    const double a = self->lo, b = self->hi[self->depth - 1U], half = 0.5 * (b - a) * self->dt;
    double torque[AISLE_ARM_LINKS], slope[AISLE_ARM_LINKS];
    motion m;
    motion_at(self, 0.5 * (a + b), &m);
    newton_euler(arm, self->base.theta, &m, torque);
    torque_slopes(self, a, b, slope);
    bool is_proved = true;
    for (uint32_t j = 0; j < arm->links; j++) {
        const double most = arm->torque_max[j] * (1.0 + LIMIT_SLACK);
        if (!(fabs(torque[j]) <= most)) {
            self->fault_joint = j;
            return AISLE_VERIFY_ARM_TORQUE;
        }
        is_proved = is_proved && fabs(torque[j]) + half * slope[j] <= most;
        self->fault_joint = j;
    }
    if (is_proved) {
        pass(self);
    } else if (b - a < TORQUE_STEP_MIN) {
        return AISLE_VERIFY_ARM_TORQUE;
    } else {
        halve(self);
    }
    return AISLE_VERIFY_ARM_NONE;
}

static fault check_told_torques(aisle_verify_arm *self, uint32_t i) {
    const aisle_arm *arm = self->request.arm;
    const aisle_arm_waypoint_msg *w = &self->path->waypoints[i];
    double torque[AISLE_ARM_LINKS];
    motion m;
    for (uint32_t j = 0; j < arm->links; j++) {
        m.q[j] = (double)w->q[j];
        m.rate[j] = (double)w->qd[j];
        m.change[j] = (double)w->qdd[j];
    }
    newton_euler(arm, self->base.theta, &m, torque);
    for (uint32_t j = 0; j < arm->links; j++) {
        if (!(fabs(torque[j] - (double)w->torque[j]) <= TORQUE_TOLD * arm->torque_max[j])) {
            self->fault_joint = j;
            return AISLE_VERIFY_ARM_TORQUE;
        }
    }
    return AISLE_VERIFY_ARM_NONE;
}

// ---- contact

typedef struct swept { // a link in the middle of an interval, grown by what it moves in it
    aisle_vec2 axis[2];
    double radius;
} swept;

static bool touches(aisle_verify_arm *self, const swept *s, const aisle_vec2 *v, uint32_t n, double radius) {
    const aisle_collide_body link = {s->axis, NULL, 2U, s->radius}, other = {v, NULL, n, radius};
    return aisle_collide(&link, &other, &self->collide);
}

static aisle_aabb box_of(const swept *s) {
    const aisle_vec2 a = s->axis[0], b = s->axis[1];
    const aisle_aabb box = {{aisle_min(a.x, b.x), aisle_min(a.y, b.y)}, {aisle_max(a.x, b.x), aisle_max(a.y, b.y)}};
    return aisle_aabb_grow(box, s->radius);
}

static bool touches_zones(aisle_verify_arm *self, const swept *s) {
    const aisle_layout *layout = self->request.layout;
    const aisle_zone *zone;
    for (aisle_layout_walk walk = aisle_layout_walk_over(layout, box_of(s)); aisle_layout_walk_next(&walk, &zone);) {
        const aisle_convex shape = aisle_layout_zone_shape(layout, zone);
        if (aisle_zone_is_obstacle(zone) && touches(self, s, shape.v, shape.n, shape.radius)) {
            self->fault_id = zone->id;
            return true;
        }
    }
    return false;
}

static bool touches_scan(aisle_verify_arm *self, const swept *s) {
    const aisle_layout *layout = self->request.layout;
    const aisle_lattice *lattice = &aisle_layout_grid(layout)->lattice;
    const aisle_aabb box = aisle_aabb_grow(box_of(s), AISLE_VERIFY_EPSILON);
    const uint32_t lo = aisle_lattice_cell(lattice, box.lo, NULL), hi = aisle_lattice_cell(lattice, box.hi, NULL);
    self->fault_id = AISLE_LAYOUT_ID_SCAN;
    for (uint32_t iy = lo / lattice->w; iy <= hi / lattice->w; iy++) {
        uint32_t end;
        for (uint32_t ix = lo % lattice->w; aisle_layout_scan_run(layout, iy, &ix, hi % lattice->w + 1U, &end);
             ix = end) {
            const double x0 = lattice->x0 + lattice->res * (double)ix, x1 = lattice->x0 + lattice->res * (double)end;
            const double y0 = lattice->y0 + lattice->res * (double)iy, y1 = y0 + lattice->res;
            const aisle_vec2 cells[4] = {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}};
            if (touches(self, s, cells, 4U, AISLE_VERIFY_EPSILON)) {
                return true;
            }
        }
    }
    return false;
}

static bool leaves_bounds(aisle_verify_arm *self, const swept *s) {
    const aisle_aabb in = aisle_layout_bounds(self->request.layout), box = box_of(s);
    self->fault_id = AISLE_LAYOUT_ID_BOUNDS;
    return !(box.lo.x > in.lo.x && box.lo.y > in.lo.y && box.hi.x < in.hi.x && box.hi.y < in.hi.y);
}

static bool touches_body(aisle_verify_arm *self, const swept *s, uint32_t i) {
    swept own = *s;
    const double share = i > 0U ? 0.0 : self->exempt / self->request.arm->length[0];
    if (share >= 1.0) {
        return false;
    }
    own.axis[0] = aisle_vec2_lerp(s->axis[0], s->axis[1], share);
    self->fault_id = AISLE_ARM_ID_BODY;
    return touches(self, &own, self->outline, self->outline_count, self->request.vehicle->radius);
}

static bool touches_arm(aisle_verify_arm *self, const swept *s, const swept *first, double moved) {
    const swept own = {{s->axis[0], s->axis[1]}, self->request.arm->radius[2] + moved + AISLE_VERIFY_EPSILON};
    self->fault_id = AISLE_ARM_ID_ARM;
    return touches(self, &own, first->axis, 2U, self->request.arm->radius[0]);
}

static bool link_touches(aisle_verify_arm *self, const swept *s, uint32_t i) {
    return leaves_bounds(self, s) || touches_body(self, s, i) || touches_zones(self, s) ||
           (aisle_layout_has_scan(self->request.layout) && touches_scan(self, s));
}

// How far joints turn off the middle of [a, b]: moved[j].
static void joint_bounds(const aisle_verify_arm *self, double a, double b, const double *q, double *moved) {
    for (uint32_t j = 0; j < links_of(self); j++) {
        double lo, hi;
        aisle_poly_bounds(self->c[j], 5U, a, b, &lo, &hi);
        moved[j] = aisle_max(q[j] - lo, hi - q[j]);
    }
}

// Farthest that a point of link i can move, joints before `from` held.
static double moved_by(const aisle_arm *arm, uint32_t from, uint32_t i, const double *moved) {
    double sum = 0.0;
    for (uint32_t j = from; j <= i; j++) {
        double reach = 0.0;
        for (uint32_t k = j; k <= i; k++) {
            reach += arm->length[k];
        }
        sum += moved[j] * reach;
    }
    return sum;
}

static fault look_at_contact(aisle_verify_arm *self) {
    const aisle_arm *arm = self->request.arm;
    const double a = self->lo, b = self->hi[self->depth - 1U];
    double moved[AISLE_ARM_LINKS] = {0.0, 0.0, 0.0}, most = 0.0;
    aisle_vec2 points[AISLE_ARM_LINKS + 1U];
    swept s[AISLE_ARM_LINKS];
    motion m;
    motion_at(self, 0.5 * (a + b), &m);
    place(arm, self->base, m.q, points);
    joint_bounds(self, a, b, m.q, moved);
    bool is_free = true;
    for (uint32_t i = 0; i < arm->links && is_free; i++) {
        const double growth = moved_by(arm, 0U, i, moved);
        s[i] = (swept){{points[i], points[i + 1U]}, arm->radius[i] + growth + AISLE_VERIFY_EPSILON};
        most = aisle_max(most, growth);
        self->fault_joint = i;
        is_free =
            !link_touches(self, &s[i], i) && (i < 2U || !touches_arm(self, &s[2], &s[0], moved_by(arm, 1U, 2U, moved)));
    }
    if (is_free) {
        pass(self);
    } else if (most < AISLE_VERIFY_ARM_STEP || self->depth + 1U >= AISLE_VERIFY_ARM_DEPTH) {
        return AISLE_VERIFY_ARM_CONTACT;
    } else {
        halve(self);
    }
    return AISLE_VERIFY_ARM_NONE;
}

// ---- order of it all

void aisle_verify_arm_start(aisle_verify_arm *self, const aisle_verify_arm_request *request,
                            aisle_arm_path_msg *decoded) {
    memset(self, 0, sizeof *self);
    AISLE_ASSERT(request->arm->links >= 1U && request->arm->links <= AISLE_ARM_LINKS);
    self->request = *request;
    self->path = decoded;
    self->base = aisle_arm_base(request->arm, request->pose);
    self->outline_count = request->vehicle->n;
    (void)aisle_vehicle_place(request->vehicle, request->pose, 0.0, self->outline);
    self->exempt = aisle_arm_mount(request->arm, request->vehicle);
    self->digest = aisle_digest(0, request->bytes, request->size);
}

// Takes the first piece of a phase in hand; of one waypoint alone, a piece that stands still.
static void begin_phase(aisle_verify_arm *self, aisle_verify_arm_phase phase) {
    self->phase = phase;
    self->at = 0;
    self->depth = 0;
}

// The next piece, when the one in hand is done. False: there is none.
static bool next_piece(aisle_verify_arm *self) {
    if (self->at + 1U >= (uint32_t)self->path->num_waypoints) {
        return false;
    }
    self->at++;
    (void)take_piece(self);
    return true;
}

static void stand_still(aisle_verify_arm *self) {
    memset(self->c, 0, sizeof self->c);
    for (uint32_t j = 0; j < links_of(self); j++) {
        self->c[j][0] = (double)self->path->waypoints[0].q[j];
    }
    self->dt = 1.0;
    self->lo = 0.0;
    self->hi[0] = 1.0;
    self->depth = 1;
}

static fault step_limits(aisle_verify_arm *self) {
    fault found = check_told_torques(self, self->at);
    if (found == AISLE_VERIFY_ARM_NONE && self->at > 0U) {
        found = take_piece(self) ? check_limits(self) : AISLE_VERIFY_ARM_TIME;
    } else if (found == AISLE_VERIFY_ARM_NONE) {
        stand_still(self);
        found = check_limits(self);
    }
    self->at++;
    if (found == AISLE_VERIFY_ARM_NONE && self->at >= (uint32_t)self->path->num_waypoints) {
        begin_phase(self, AISLE_VERIFY_ARM_PHASE_TORQUE);
        stand_still(self);
    }
    return found;
}

static fault step_intervals(aisle_verify_arm *self) {
    const bool is_torque = self->phase == AISLE_VERIFY_ARM_PHASE_TORQUE;
    if (self->depth > 0U) {
        self->intervals++;
        return is_torque ? look_at_torque(self) : look_at_contact(self);
    }
    if (!next_piece(self)) {
        begin_phase(self, is_torque ? AISLE_VERIFY_ARM_PHASE_CONTACT : AISLE_VERIFY_ARM_PHASE_DONE);
        if (is_torque) {
            stand_still(self);
        }
    }
    return AISLE_VERIFY_ARM_NONE;
}

static fault step(aisle_verify_arm *self) {
    fault found = AISLE_VERIFY_ARM_NONE;
    switch (self->phase) {
    case AISLE_VERIFY_ARM_PHASE_HEADER:
        found = check_header(self);
        begin_phase(self, AISLE_VERIFY_ARM_PHASE_LIMITS);
        break;
    case AISLE_VERIFY_ARM_PHASE_LIMITS:
        found = step_limits(self);
        break;
    default:
        found = step_intervals(self);
        break;
    }
    return found;
}

aisle_status aisle_verify_arm_step(aisle_verify_arm *self, uint32_t units, uint32_t *spent, aisle_stamp *stamp) {
    *stamp = (aisle_stamp){0, 0};
    for (uint32_t i = 0; i < units && self->phase != AISLE_VERIFY_ARM_PHASE_DONE; i++) {
        *spent += 1U;
        self->fault = step(self);
        if (self->fault != AISLE_VERIFY_ARM_NONE) {
            self->fault_waypoint = self->at;
            self->phase = AISLE_VERIFY_ARM_PHASE_DONE;
        }
    }
    if (self->phase != AISLE_VERIFY_ARM_PHASE_DONE) {
        return AISLE_BUSY;
    }
    if (self->fault == AISLE_VERIFY_ARM_NONE &&
        aisle_digest(0, self->request.bytes, self->request.size) != self->digest) {
        self->fault = AISLE_VERIFY_ARM_DECODE; // the bytes changed meanwhile
    }
    if (self->fault != AISLE_VERIFY_ARM_NONE) {
        return AISLE_ERR_DATA;
    }
    *stamp = (aisle_stamp){.digest = self->digest, .size = (uint32_t)self->request.size};
    return AISLE_OK;
}
