#include "plan/verify.h"

#include "base/angle.h"
#include "base/check.h"
#include "base/crc32.h"
#include "base/digest.h"
#include "plan/verify_parts.h"
#include "wire/codec.h"

#include <string.h>

#define START_TOLERANCE 1e-6                                   // m, rad
#define GOAL_TOLERANCE 0.05                                    // m, rad, where a goal says 0
#define CLOSE(a, b) (fabs((a) - (b)) <= 1e-4 + 3e-5 * fabs(b)) // sums as floats

static aisle_status fail(aisle_verify *self, aisle_verify_fault fault, uint32_t waypoint) {
    AISLE_ASSERT(fault != AISLE_VERIFY_NONE);
    self->fault = fault;
    self->fault_waypoint = waypoint;
    self->phase = AISLE_VERIFY_PHASE_DONE;
    return AISLE_ERR_DATA;
}

static uint32_t waypoints(const aisle_verify *self) {
    return (uint32_t)self->path->num_waypoints;
}

static bool has_flag(const aisle_waypoint_msg *w, int16_t flag) {
    return (w->flags & flag) != 0;
}

// ---- the header

static bool is_at_least_zero(float x) {
    return x >= 0.0F && x <= FLT_MAX;
} // false for NaN

static bool layout_stands(const aisle_verify *self) {
    const aisle_layout *layout = self->request.layout;
    return aisle_layout_is_in_force(layout) && aisle_layout_map_id(layout) == self->basis.map_id &&
           aisle_layout_map_revision(layout) == self->basis.map_revision;
}

static bool counts_are_fit(const aisle_path_msg *path) {
    bool status =
        path->status == AISLE_PATH_OK || path->status == AISLE_PATH_PARTIAL || path->status == AISLE_PATH_STOP;
    bool count = path->num_waypoints >= 1 && path->num_waypoints <= AISLE_PATH_MAX_WAYPOINTS;
    return status && count && path->num_base >= 0 && path->num_base <= path->num_waypoints;
}

static bool numbers_are_fit(const aisle_path_msg *path) {
    return is_at_least_zero(path->length) && is_at_least_zero(path->length_bound) && is_at_least_zero(path->duration) &&
           is_at_least_zero(path->energy) && is_at_least_zero(path->risk) && path->risk <= 1.001F &&
           is_at_least_zero(path->clearance_min) && is_at_least_zero(path->clearance_moving_min) &&
           is_at_least_zero(path->planning_time);
}

static bool is_number(const uint8_t *at, int32_t value) {
    uint8_t bytes[4];
    aisle_msg_put_int32(bytes, value);
    return memcmp(at, bytes, sizeof bytes) == 0;
}

// By the bytes as they stand.
static bool certificate_is_right(const aisle_verify *self, uint32_t waypoints) {
    const uint8_t *bytes = self->request.bytes;
    return is_number(bytes + AISLE_PATH_AT_MAP_ID, self->basis.map_id) &&
           is_number(bytes + AISLE_PATH_AT_MAP_ID + 4, self->basis.map_revision) &&
           is_number(bytes + AISLE_PATH_AT_MAP_ID + 8, self->request.vehicle->revision) &&
           is_number(bytes + AISLE_PATH_AT_CERTIFICATE, (int32_t)aisle_release_certificate(waypoints, bytes));
}

static aisle_verify_fault header_fault(aisle_verify *self) {
    const aisle_verify_request *request = &self->request;
    if (aisle_msg_decode(AISLE_MSG_PATH, request->bytes, request->size, self->path, NULL) != AISLE_OK ||
        !counts_are_fit(self->path) || !numbers_are_fit(self->path)) {
        return AISLE_VERIFY_DECODE;
    }
    const size_t head = AISLE_PATH_AT_WAYPOINTS;
    self->basis.waypoints = aisle_crc32(0, request->bytes + head, request->size - head);
    return certificate_is_right(self, self->basis.waypoints) ? AISLE_VERIFY_NONE : AISLE_VERIFY_CERTIFICATE;
}

// ---- the basis of the proof

static uint64_t digest_of_vehicle(const aisle_verify_request *request) {
    uint8_t vehicle[AISLE_VEHICLE_CONTENT_BYTES];
    return aisle_digest(0, vehicle, aisle_vehicle_content(request->vehicle, vehicle));
}

static uint64_t digest_of_given(const aisle_verify_request *request, uint64_t vehicle) {
    const double start[4] = {request->start.x, request->start.y, request->start.theta, request->v_start};
    uint64_t digest = aisle_digest(vehicle, start, sizeof start);
    if (request->base != NULL) {
        digest = aisle_verify_base_digest(digest, request->base);
    }
    for (uint32_t i = 0; i < request->num_goals; i++) {
        const aisle_goal_msg *goal = &request->goals[i];
        const double place[3] = {goal->x, goal->y, goal->theta};
        const float rest[3] = {goal->tolerance_xy, goal->tolerance_theta, goal->dwell};
        digest = aisle_digest(digest, &goal->id, sizeof goal->id);
        digest = aisle_digest(digest, place, sizeof place);
        digest = aisle_digest(digest, rest, sizeof rest);
    }
    return digest;
}

// False: the bytes are too short for a path.
static bool take_basis(aisle_verify *self) {
    const aisle_verify_request *request = &self->request;
    aisle_proof_basis *basis = &self->basis;
    if (!aisle_release_digest(request->bytes, request->size, &self->digest, &basis->path)) {
        return false;
    }
    const uint64_t vehicle = digest_of_vehicle(request);
    basis->given = digest_of_given(request, vehicle);
    basis->layout = aisle_layout_content(request->layout);
    self->ground = aisle_digest(vehicle, &basis->layout, sizeof basis->layout);
    basis->size = (uint32_t)request->size;
    return true;
}

static bool is_proved_already(aisle_verify *self) {
    const aisle_proof_basis *then = self->request.basis, *now = &self->basis;
    if (then == NULL || then->path != now->path || then->given != now->given || then->layout != now->layout ||
        then->map_id != now->map_id || then->map_revision != now->map_revision || then->size != now->size) {
        return false;
    }
    self->basis.waypoints = then->waypoints;
    return self->request.bytes[AISLE_PATH_AT_CACHED] <= 1U && certificate_is_right(self, then->waypoints);
}

const aisle_proof_basis *aisle_verify_basis(const aisle_verify *self) {
    AISLE_ASSERT(self->phase == AISLE_VERIFY_PHASE_DONE && self->fault == AISLE_VERIFY_NONE);
    return &self->basis;
}

// ---- start and goals

static bool starts_where_it_must(const aisle_verify *self) {
    const aisle_waypoint_msg *w = &self->path->waypoints[0];
    const aisle_pose2 *start = &self->request.start;
    return fabs(w->x - start->x) <= START_TOLERANCE && fabs(w->y - start->y) <= START_TOLERANCE &&
           fabs(aisle_angle_difference(start->theta, w->theta)) <= START_TOLERANCE;
}

static double tolerance_of(float wanted) {
    return wanted > 0.0F ? (double)wanted : GOAL_TOLERANCE;
}

static bool reaches(const aisle_waypoint_msg *w, const aisle_goal_msg *goal) {
    double distance = aisle_vec2_distance(aisle_vec2_of(w->x, w->y), aisle_vec2_of(goal->x, goal->y));
    double turn = fabs(aisle_angle_difference(goal->theta, w->theta));
    bool any_heading = (double)goal->tolerance_theta >= AISLE_PI - 1e-6; // pi as float
    return distance <= tolerance_of(goal->tolerance_xy) + 1e-9 &&
           (any_heading || turn <= tolerance_of(goal->tolerance_theta) + 1e-9);
}

static aisle_verify_fault goal_fault(const aisle_verify *self, uint32_t i) {
    const aisle_waypoint_msg *w = &self->path->waypoints[i];
    if (!has_flag(w, AISLE_WAYPOINT_GOAL)) {
        return AISLE_VERIFY_NONE;
    }
    if (self->goals >= self->request.num_goals) {
        return AISLE_VERIFY_GOAL;
    }
    const aisle_goal_msg *goal = &self->request.goals[self->goals];
    if (w->goal_id != goal->id || !reaches(w, goal)) {
        return AISLE_VERIFY_GOAL;
    }
    return goal->dwell > 0.0F && (double)w->v > VERIFY_REST ? AISLE_VERIFY_REST : AISLE_VERIFY_NONE;
}

static bool has_arrived(const aisle_verify *self) {
    if (self->path->status != AISLE_PATH_OK) {
        return true;
    }
    return self->goals == self->request.num_goals &&
           has_flag(&self->path->waypoints[waypoints(self) - 1], AISLE_WAYPOINT_GOAL);
}

// ---- waypoint by waypoint

// Takes in hand the piece that ends at waypoint i; waypoint 0: standing there. False: there is no such piece.
static bool take_piece(aisle_verify *self, uint32_t i) {
    const aisle_waypoint_msg *w = self->path->waypoints;
    double dwell = 0.0;
    if (i == 0) {
        self->piece = aisle_verify_piece_standing(&w[0]);
        return true;
    }
    if (!aisle_verify_piece_between(&w[i - 1], &w[i], &self->piece)) {
        return false;
    }
    if (has_flag(&w[i - 1], AISLE_WAYPOINT_GOAL)) { // the one counted last
        AISLE_ASSERT(self->goals >= 1 && self->goals <= self->request.num_goals);
        dwell = (double)self->request.goals[self->goals - 1].dwell;
    }
    aisle_verify_time_piece(self->request.vehicle, &w[i - 1], &w[i], aisle_max(dwell, 0.0), false, &self->piece);
    return true;
}

static aisle_verify_fault first_waypoint_fault(const aisle_verify *self) {
    const aisle_waypoint_msg *w = &self->path->waypoints[0];
    if (!starts_where_it_must(self)) {
        return AISLE_VERIFY_START;
    }
    if (fabs((double)w->t) > 1e-6) {
        return AISLE_VERIFY_TIME;
    }
    return fabs((double)w->s) > 1e-6 ? AISLE_VERIFY_SUMS : AISLE_VERIFY_NONE;
}

static aisle_verify_fault waypoint_fault(aisle_verify *self, uint32_t i) {
    aisle_verify_fault fault = aisle_verify_waypoint_fault(self, i);
    if (fault != AISLE_VERIFY_NONE) {
        return fault;
    }
    if (!take_piece(self, i)) {
        return AISLE_VERIFY_DECODE;
    }
    fault = i == 0 ? first_waypoint_fault(self) : aisle_verify_piece_fault(self, i);
    if (fault == AISLE_VERIFY_NONE) {
        fault = aisle_verify_direction_fault(self);
    }
    if (fault != AISLE_VERIFY_NONE) {
        return fault;
    }
    self->s += self->piece.length;
    self->along = aisle_verify_piece_direction(&self->piece, true);
    return goal_fault(self, i);
}

// Way to rest from v, braking with `down` after AISLE_VERIFY_STOP_TIME.
static double way_to_rest(double v, double down) {
    return v * AISLE_VERIFY_STOP_TIME + 0.5 * v * v / down * (1.0 + VERIFY_TOLERANCE) + 1e-3;
}

// self->piece: the last one.
static bool only_brakes(const aisle_verify *self) {
    const aisle_waypoint_msg *w = self->path->waypoints;
    const aisle_vehicle *vehicle = self->request.vehicle;
    const double v0 = (double)w[0].v;
    for (uint32_t i = 1; i < waypoints(self); i++) {
        const bool turns = has_flag(&w[i - 1], AISLE_WAYPOINT_TURN_IN_PLACE);
        if ((double)w[i].v > v0 * (1.0 + VERIFY_TOLERANCE) + VERIFY_REST || (turns && waypoints(self) > 2)) {
            return false;
        }
    }
    const bool turns = self->piece.on_spot && waypoints(self) > 1;
    return self->s <= way_to_rest(v0, vehicle->d_max) &&
           (!turns || fabs(self->piece.turn) <= way_to_rest(vehicle->omega_max, vehicle->alpha_max));
}

static aisle_verify_fault sums_fault(const aisle_verify *self) {
    const aisle_path_msg *path = self->path;
    if (!has_arrived(self)) {
        return AISLE_VERIFY_GOAL;
    }
    double length = (double)path->length, end = (double)path->waypoints[waypoints(self) - 1].t;
    bool ok = CLOSE(length, self->s) && CLOSE((double)path->duration, end) &&
              (double)path->length_bound <= length * (1.0 + 1e-6);
    return ok ? AISLE_VERIFY_NONE : AISLE_VERIFY_SUMS;
}

// ---- pieces known

// Of the piece in hand; NULL: they are not kept. Of a path that ends elsewhere they would be other ones.
static aisle_verify_known *known_place(const aisle_verify *self) {
    aisle_verify_known *known = self->request.known;
    return known != NULL && self->path->status == AISLE_PATH_OK ? &known[waypoints(self) - 1U - self->at] : NULL;
}

static aisle_verify_known known_of(const aisle_verify *self) {
    const aisle_waypoint_msg *to = &self->path->waypoints[self->at], *from = self->at > 0 ? to - 1 : to;
    const double words[] = {from->x, from->y,   from->theta,           to->x,
                            to->y,   to->theta, (double)to->curvature, self->piece.on_spot ? 1.0 : 0.0};
    return (aisle_verify_known){aisle_digest(self->ground, words, sizeof words), self->piece.peak};
}

// Marks the piece in hand if it is known.
static void look_up(aisle_verify *self) {
    const aisle_verify_known *known = known_place(self);
    if (known == NULL || self->request.looks_anew) {
        return;
    }
    const aisle_verify_known now = known_of(self);
    if (known->digest == now.digest && now.peak <= known->peak) {
        self->is_known[self->at / 8U] |= (uint8_t)(1U << (self->at % 8U));
    }
}

static bool is_known(const aisle_verify *self) {
    return (self->is_known[self->at / 8U] >> (self->at % 8U) & 1U) != 0U;
}

static void keep_known(const aisle_verify *self) {
    aisle_verify_known *known = known_place(self);
    if (known != NULL) {
        *known = known_of(self);
    }
}

// ---- steps

static aisle_status step_header(aisle_verify *self) {
    self->unbroken = true;
    if (!take_basis(self)) {
        return fail(self, AISLE_VERIFY_DECODE, 0);
    }
    if (is_proved_already(self)) {
        self->phase = AISLE_VERIFY_PHASE_DONE;
        return AISLE_OK;
    }
    aisle_verify_fault fault = header_fault(self);
    if (fault != AISLE_VERIFY_NONE) {
        return fail(self, fault, 0);
    }
    self->phase = AISLE_VERIFY_PHASE_WAYPOINTS;
    return AISLE_BUSY;
}

static void count_goal(aisle_verify *self, uint32_t i) {
    self->goals += has_flag(&self->path->waypoints[i], AISLE_WAYPOINT_GOAL) ? 1U : 0U;
}

// All proved; the bytes must still be the ones that were read, if anyone could have changed them.
static aisle_status finish(aisle_verify *self) {
    uint64_t digest = self->digest;
    if (!self->unbroken &&
        (!aisle_release_digest(self->request.bytes, self->request.size, &digest, NULL) || digest != self->digest)) {
        return fail(self, AISLE_VERIFY_DECODE, 0);
    }
    self->phase = AISLE_VERIFY_PHASE_DONE;
    return AISLE_OK;
}

// Takes the first piece in hand, for the base or the motion; a lone waypoint is a place to stand.
static void go_to_first_piece(aisle_verify *self) {
    self->goals = 0;
    self->at = waypoints(self) == 1 ? 0 : 1;
    if (self->at == 1) {
        count_goal(self, 0);
    }
    bool taken = take_piece(self, self->at);
    AISLE_ASSERT(taken);
}

void aisle_verify_next_piece(aisle_verify *self) {
    count_goal(self, self->at++);
    bool taken = take_piece(self, self->at);
    AISLE_ASSERT(taken); // looked at before
}

// ---- motion

// The motion of the piece in hand; AISLE_OK: all of it is proved.
static aisle_status step_piece(aisle_verify *self) {
    if (is_known(self)) {
        return AISLE_OK;
    }
    const aisle_status status = aisle_verify_motion_step(self);
    if (status == AISLE_OK) {
        keep_known(self);
    }
    return status;
}

static void next_motion(aisle_verify *self) {
    count_goal(self, self->at++);
    if (!is_known(self)) {
        const bool taken = take_piece(self, self->at);
        AISLE_ASSERT(taken); // looked at before
        aisle_verify_motion_begin(self);
    }
}

static void begin_motion(aisle_verify *self) {
    self->phase = AISLE_VERIFY_PHASE_MOTION;
    go_to_first_piece(self);
    aisle_verify_motion_begin(self);
}

static aisle_status step_waypoint(aisle_verify *self) {
    aisle_verify_fault fault = waypoint_fault(self, self->at);
    if (fault != AISLE_VERIFY_NONE) {
        return fail(self, fault, self->at);
    }
    if (self->at > 0 || waypoints(self) == 1) {
        look_up(self);
    }
    count_goal(self, self->at);
    if (++self->at < waypoints(self)) {
        return AISLE_BUSY;
    }
    fault = sums_fault(self);
    if (fault == AISLE_VERIFY_NONE && self->path->status == AISLE_PATH_STOP && !only_brakes(self)) {
        fault = AISLE_VERIFY_STOP;
    }
    if (fault != AISLE_VERIFY_NONE) {
        return fail(self, fault, waypoints(self) - 1);
    }
    if (self->request.base == NULL) {
        begin_motion(self);
        return AISLE_BUSY;
    }
    self->phase = AISLE_VERIFY_PHASE_BASE;
    go_to_first_piece(self);
    aisle_verify_base_begin(self);
    return AISLE_BUSY;
}

static aisle_status step_base(aisle_verify *self) {
    aisle_status status = aisle_verify_base_step(self);
    if (status == AISLE_ERR_DATA) {
        return fail(self, AISLE_VERIFY_BASE, self->at);
    }
    if (status == AISLE_OK) {
        begin_motion(self);
    }
    return AISLE_BUSY;
}

static aisle_status step_motion(aisle_verify *self) {
    aisle_status status = step_piece(self);
    if (status == AISLE_ERR_DATA) {
        return fail(self, self->fault, self->at);
    }
    if (status == AISLE_BUSY) {
        return AISLE_BUSY;
    }
    if (self->at + 1U >= waypoints(self)) {
        return finish(self);
    }
    next_motion(self);
    return AISLE_BUSY;
}

static aisle_status step_once(aisle_verify *self) {
    switch (self->phase) {
    case AISLE_VERIFY_PHASE_HEADER:
        return step_header(self);
    case AISLE_VERIFY_PHASE_WAYPOINTS:
        return step_waypoint(self);
    case AISLE_VERIFY_PHASE_BASE:
        return step_base(self);
    case AISLE_VERIFY_PHASE_MOTION:
        return step_motion(self);
    case AISLE_VERIFY_PHASE_DONE:
        break;
    }
    return self->fault == AISLE_VERIFY_NONE ? AISLE_OK : AISLE_ERR_DATA;
}

void aisle_verify_start(aisle_verify *self, const aisle_verify_request *request, aisle_path_msg *decoded) {
    const aisle_vehicle *vehicle = request->vehicle;
    AISLE_ASSERT(request->layout != NULL && vehicle != NULL && request->bytes != NULL && decoded != NULL);
    AISLE_ASSERT(vehicle->n >= 1 && vehicle->n <= AISLE_SHAPE_VERTICES_MAX);
    AISLE_ASSERT(request->num_goals == 0 || request->goals != NULL);
    AISLE_ASSERT(request->v_start >= 0.0 && request->v_start <= DBL_MAX);
    memset(self, 0, sizeof *self);
    self->request = *request;
    self->path = decoded;
    self->basis.map_id = aisle_layout_map_id(request->layout);
    self->basis.map_revision = aisle_layout_map_revision(request->layout);
    for (uint32_t i = 0; i < vehicle->n; i++) {
        self->lever = aisle_max(self->lever, aisle_vec2_length(vehicle->footprint[i]));
    }
}

aisle_status aisle_verify_step(aisle_verify *self, uint32_t units, uint32_t *spent, aisle_stamp *stamp) {
    aisle_status status = AISLE_BUSY;
    *stamp = (aisle_stamp){0, 0};
    self->unbroken = false;
    if (self->phase != AISLE_VERIFY_PHASE_DONE && !layout_stands(self)) {
        status = fail(self, AISLE_VERIFY_CERTIFICATE, self->at);
    }
    if (self->phase == AISLE_VERIFY_PHASE_DONE) {
        status = step_once(self); // repeats the answer
    }
    for (uint32_t left = units; status == AISLE_BUSY && left > 0; left--) {
        status = step_once(self);
        *spent += 1;
    }
    if (status == AISLE_OK) {
        *stamp = (aisle_stamp){.digest = self->digest, .size = (uint32_t)self->request.size};
    }
    return status;
}
