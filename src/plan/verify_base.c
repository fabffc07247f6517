#include "plan/verify_parts.h"

#include "base/angle.h"
#include "base/check.h"
#include "base/digest.h"

#define APART 1e-6        // m, rad, both curves may be
#define SNAP 1e-7         // m, rad, left of a piece that count as nothing
#define START_SNAP 2.1e-6 // likewise, where the new path begins
#define PARTS 4U          // of a step, at whose ends both curves are compared

// ---- the walkers

static double size_of(const aisle_verify_piece *piece) {
    return piece->on_spot ? fabs(piece->turn) : piece->length;
}

static double left_of(const aisle_verify_piece *piece, double done) {
    return size_of(piece) - done;
}

static aisle_pose2 pose_at(const aisle_verify_piece *piece, double done) {
    const double size = size_of(piece), u = size > 0.0 ? aisle_min(done / size, 1.0) : 0.0;
    const aisle_vec2 at = aisle_verify_piece_origin(piece, u);
    return (aisle_pose2){at.x, at.y, piece->theta + u * piece->turn};
}

static bool are_together(const aisle_verify *self, double further) {
    const aisle_verify_walk *walk = &self->walk;
    const aisle_pose2 then = pose_at(&walk->piece, walk->done + further);
    const aisle_pose2 now = pose_at(&self->piece, walk->done_new + further);
    const double apart = aisle_vec2_distance(aisle_vec2_of(then.x, then.y), aisle_vec2_of(now.x, now.y));
    return apart <= APART && fabs(aisle_angle_difference(then.theta, now.theta)) <= APART;
}

// Takes the piece of the path that is out in hand; past its end it stands there. False: there is no such piece.
static bool take_out_piece(aisle_verify *self, uint32_t at) {
    const aisle_verify_base *base = self->request.base;
    aisle_verify_walk *walk = &self->walk;
    walk->at = at;
    walk->done = 0.0;
    if (at == 0 || at >= base->n) {
        walk->at = base->n;
        walk->piece = aisle_verify_piece_standing(&base->w[base->n - 1U]);
        return true;
    }
    const double dwell = base->dwell == NULL ? 0.0 : (double)base->dwell[at - 1U];
    if (!aisle_verify_piece_between(&base->w[at - 1U], &base->w[at], &walk->piece)) {
        return false;
    }
    aisle_verify_time_piece(self->request.vehicle, &base->w[at - 1U], &base->w[at], dwell, true, &walk->piece);
    return true;
}

void aisle_verify_base_begin(aisle_verify *self) {
    const aisle_verify_base *base = self->request.base;
    aisle_verify_walk *walk = &self->walk;
    AISLE_ASSERT(base->w != NULL && base->n >= 1U && base->reach >= 0.0 && base->u >= 0.0 && base->u <= 1.0);
    AISLE_ASSERT(base->n == 1U ? base->piece == 0U : base->piece >= 1U && base->piece < base->n);
    walk->left = base->reach;
    walk->done_new = 0.0;
    walk->counted = 1U;
    const bool taken = take_out_piece(self, base->piece);
    AISLE_ASSERT(taken); // a path that was proved
    walk->done = base->u * size_of(&walk->piece);
    if (left_of(&walk->piece, walk->done) <= START_SNAP && !are_together(self, 0.0)) {
        walk->done = size_of(&walk->piece);
    }
    walk->in_turn = base->turn && walk->piece.on_spot;
}

// ---- speeds

static aisle_verify_speeds speeds_out(const aisle_verify *self) {
    const aisle_waypoint_msg *to = &self->request.base->w[self->walk.at];
    return aisle_verify_speeds_of(self->request.vehicle, to - 1, to, &self->walk.piece);
}

static aisle_verify_speeds speeds_new(const aisle_verify *self) {
    const aisle_waypoint_msg *to = &self->path->waypoints[self->at];
    return aisle_verify_speeds_of(self->request.vehicle, to - 1, to, &self->piece);
}

// No faster than it was or than v_start lets it, both APART off each other at worst.
static bool is_slow_enough(const aisle_verify *self, double further) {
    const aisle_vehicle *vehicle = self->request.vehicle;
    const aisle_verify_speeds out = speeds_out(self), now = speeds_new(self);
    const double v_start = self->request.v_start, more = 1.0 + VERIFY_TOLERANCE;
    const double limit = aisle_max(aisle_verify_speed_square(&out, self->walk.done + further), v_start * v_start);
    const double slack = 2.0 * APART * aisle_max(vehicle->a_max, vehicle->d_max);
    return aisle_verify_speed_square(&now, self->walk.done_new + further) <= limit * more * more + slack;
}

// How far on both squares are linear, and the old one on one side of v_start's.
static double step_length(const aisle_verify *self) {
    const aisle_verify_walk *walk = &self->walk;
    const aisle_verify_speeds out = speeds_out(self), now = speeds_new(self);
    double step = aisle_verify_speed_bend(&out, walk->done + SNAP) - walk->done;
    step = aisle_min(step, aisle_verify_speed_bend(&now, walk->done_new + SNAP) - walk->done_new);
    step = aisle_min(step, walk->left);
    const double square = self->request.v_start * self->request.v_start;
    const double here = aisle_verify_speed_square(&out, walk->done) - square;
    const double there = aisle_verify_speed_square(&out, walk->done + step) - square;
    if ((here < 0.0 && there > 0.0) || (here > 0.0 && there < 0.0)) {
        const double crossing = step * (here / (here - there));
        step = crossing > SNAP ? crossing : step;
    }
    AISLE_ASSERT(step > 0.0);
    return step;
}

// ---- steps

static aisle_status blame(aisle_verify *self) {
    const aisle_pose2 at = pose_at(&self->piece, self->walk.done_new);
    self->fault_at = aisle_vec2_of(at.x, at.y);
    return AISLE_ERR_DATA;
}

static bool has_ended(const aisle_verify *self) {
    const aisle_verify_walk *walk = &self->walk;
    return walk->at >= self->request.base->n || (walk->left <= SNAP && !walk->in_turn);
}

// `passed` waypoints of the new path are not behind the base's end.
static aisle_status finish(aisle_verify *self, uint32_t passed) {
    const aisle_verify_walk *walk = &self->walk;
    const uint32_t told = (uint32_t)self->path->num_base;
    AISLE_ASSERT(walk->counted <= passed && told <= (uint32_t)self->path->num_waypoints);
    return told >= walk->counted && told <= passed ? AISLE_OK : blame(self);
}

// Is there more than APART left of the base, or a turn?
static bool is_well_before_the_end(const aisle_verify *self) {
    const aisle_verify_walk *walk = &self->walk;
    const bool is_last = walk->at + 1U >= self->request.base->n; // piece of the path that is out, or it has ended
    return walk->in_turn || (walk->left > APART && !(is_last && left_of(&walk->piece, walk->done) <= APART));
}

// The new path's waypoint self->at is reached.
static aisle_status pass_waypoint(aisle_verify *self) {
    aisle_verify_walk *walk = &self->walk;
    const uint32_t passed = self->at + 1U;
    walk->counted = is_well_before_the_end(self) ? passed : walk->counted;
    if (passed >= (uint32_t)self->path->num_waypoints) {
        return finish(self, passed);
    }
    aisle_verify_next_piece(self);
    walk->done_new = 0.0;
    return AISLE_BUSY;
}

static aisle_status turn_along(aisle_verify *self) {
    aisle_verify_walk *walk = &self->walk;
    if ((walk->piece.turn > 0.0) != (self->piece.turn > 0.0)) {
        return blame(self);
    }
    const double step =
        aisle_min(left_of(&walk->piece, walk->done), left_of(&self->piece, walk->done_new)); // both above SNAP
    walk->done += step;
    walk->done_new += step;
    return AISLE_BUSY;
}

static aisle_status move_along(aisle_verify *self) {
    aisle_verify_walk *walk = &self->walk;
    const double step = step_length(self);
    for (uint32_t i = 1; i <= PARTS; i++) {
        if (!are_together(self, step * i / PARTS)) {
            return blame(self);
        }
    }
    if (!is_slow_enough(self,
                        step)) { // at its beginning by the step before, at the first by v_start: speeds do not jump
        return blame(self);
    }
    walk->done += step;
    walk->done_new += step;
    walk->left -= step;
    return AISLE_BUSY;
}

aisle_status aisle_verify_base_step(aisle_verify *self) {
    aisle_verify_walk *walk = &self->walk;
    if (!are_together(self, 0.0)) {
        return blame(self);
    }
    if (left_of(&self->piece, walk->done_new) <= SNAP) {
        return pass_waypoint(self);
    }
    if (!has_ended(self) && left_of(&walk->piece, walk->done) <= SNAP) {
        walk->in_turn = false;
        return take_out_piece(self, walk->at + 1U) ? AISLE_BUSY : blame(self);
    }
    if (has_ended(self)) {
        const bool is_near = !self->piece.on_spot && left_of(&self->piece, walk->done_new) <= APART;
        return finish(self, self->at + (is_near ? 1U : 0U));
    }
    if (self->piece.on_spot != walk->piece.on_spot) {
        return blame(self);
    }
    return self->piece.on_spot ? turn_along(self) : move_along(self);
}

// ---- what it is

uint64_t aisle_verify_base_digest(uint64_t digest, const aisle_verify_base *base) {
    const double place[4] = {(double)base->piece, base->u, base->reach, base->turn ? 1.0 : 0.0};
    const uint32_t first = base->piece > 0U ? base->piece - 1U : 0U;
    double behind = 0.0; // m of chords since the place's piece: what lies behind the reach does not count
    digest = aisle_digest(digest, place, sizeof place);
    for (uint32_t i = first; i < base->n && behind <= base->reach; i++) {
        const aisle_waypoint_msg *w = &base->w[i];
        const double pose[3] = {w->x, w->y, w->theta};
        const float rest[4] = {w->curvature, w->v, w->t, base->dwell == NULL ? 0.0F : base->dwell[i]};
        digest = aisle_digest(digest, pose, sizeof pose);
        digest = aisle_digest(digest, rest, sizeof rest);
        digest = aisle_digest(digest, &w->flags, sizeof w->flags);
        behind +=
            i > base->piece ? aisle_vec2_distance(aisle_vec2_of(w->x, w->y), aisle_vec2_of(w[-1].x, w[-1].y)) : 0.0;
    }
    return digest;
}
