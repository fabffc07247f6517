#include "plan/verify_moving_parts.h"

#include "base/check.h"
#include "wire/codec.h"

#include <string.h>

#define DONE 1e-9           // m or rad left of a piece that count as nothing
#define WAYPOINT_BYTES 64U  // above what one takes
#define GOAL_TOLERANCE 0.05 // m, where a goal says 0
#define STANDS 0.02         // m/s; slower is taken to stand

static const aisle_waypoint_msg *waypoint(const aisle_verify_moving *self, uint32_t i) {
    return &self->request.path->waypoints[i];
}

static bool is_goal(const aisle_verify_moving *self, uint32_t i) {
    return (waypoint(self, i)->flags & AISLE_WAYPOINT_GOAL) != 0;
}

// ---- pieces

static bool is_as_encoded(const aisle_verify_moving *self, uint32_t i) {
    uint8_t bytes[WAYPOINT_BYTES];
    size_t size = 0;
    if (aisle_msg_encode_body(AISLE_MSG_WAYPOINT, waypoint(self, i), bytes, sizeof bytes, &size) != AISLE_OK) {
        return false;
    }
    const size_t at = AISLE_PATH_AT_WAYPOINTS + size * i;
    return at + size <= self->request.size && memcmp(self->request.bytes + at, bytes, size) == 0;
}

bool aisle_moving_piece(const aisle_verify_moving *self, uint32_t i, aisle_verify_piece *out) {
    AISLE_ASSERT(i >= 1U && i < (uint32_t)self->request.path->num_waypoints);
    return is_as_encoded(self, i - 1U) && is_as_encoded(self, i) &&
           aisle_verify_piece_between(waypoint(self, i - 1U), waypoint(self, i), out);
}

double aisle_moving_size(const aisle_verify_piece *piece) {
    return piece->on_spot ? fabs(piece->turn) : piece->length;
}

bool aisle_moving_waits(const aisle_verify_piece *piece) {
    return piece->on_spot && fabs(piece->turn) <= MOVING_WAIT;
}

// ---- rest before a piece

// Dwell (s) at waypoint i if it is a goal; *begun: the part of it that may be over.
static double dwell_at(aisle_verify_moving *self, uint32_t i, double *begun) {
    aisle_moving_motion *motion = &self->motion;
    *begun = 0.0;
    if (!is_goal(self, i) || motion->goals == 0U || motion->goals > self->request.num_goals) {
        return 0.0;
    }
    const aisle_goal_msg *goal = &self->request.goals[motion->goals - 1U]; // counted when the piece is taken
    const double dwell = aisle_max((double)goal->dwell, 0.0);
    const double near = goal->tolerance_xy > 0.0F ? (double)goal->tolerance_xy : GOAL_TOLERANCE;
    const bool is_there = motion->way <= DONE || (motion->way <= near && self->request.v <= STANDS);
    *begun = motion->spares_dwell && is_there ? dwell : 0.0;
    motion->spares_dwell = false;
    return dwell;
}

// Fills speeds, rest and late for the piece that begins at rest or in motion; false if it cannot be driven.
static bool take_times(aisle_verify_moving *self, uint32_t i, aisle_verify_piece *piece, bool is_first) {
    aisle_moving_motion *motion = &self->motion;
    const aisle_waypoint_msg *from = waypoint(self, i - 1U), *to = waypoint(self, i);
    double begun;
    const double dwell = dwell_at(self, i - 1U, &begun);
    aisle_verify_time_piece(self->request.vehicle, from, to, dwell, false, piece);
    motion->speeds = aisle_verify_speeds_of(self->request.vehicle, from, to, piece);
    motion->turns = piece->on_spot;
    if (!(motion->speeds.v0 >= 0.0 && motion->speeds.v1 >= 0.0)) {
        return false;
    }
    const double slot = aisle_max(piece->time + dwell, 0.0);
    if (aisle_moving_waits(piece)) {
        motion->speeds.length = 0.0;
        motion->rest = is_first ? piece->time * (1.0 - self->request.at_u) : slot - begun;
    } else {
        const double left = aisle_max(slot - aisle_verify_speed_time(&motion->speeds), 0.0); // dwell included
        const bool starts = motion->speeds.rests || motion->speeds.v0 <= VERIFY_REST;
        motion->rest = starts && !is_first ? left - begun : 0.0;
        motion->late += starts ? 0.0 : left;
    }
    motion->rest = aisle_max(motion->rest, 0.0);
    return true;
}

// A turn that is faster than told began earlier, by so much that it is as fast here.
static void take_rate(aisle_verify_moving *self) {
    aisle_moving_motion *motion = &self->motion;
    const double rate = self->request.omega;
    if (motion->turns && motion->speeds.length > 0.0) {
        motion->extra = aisle_max(0.5 * rate * rate / motion->speeds.up - motion->done, 0.0);
        motion->speeds.length += motion->extra;
        motion->done += motion->extra;
    }
}

static bool take(aisle_verify_moving *self, uint32_t i, bool is_first) {
    aisle_moving_motion *motion = &self->motion;
    aisle_verify_piece piece;
    if (!aisle_moving_piece(self, i, &piece)) {
        return false;
    }
    motion->piece = i;
    motion->done = motion->extra = 0.0;
    motion->goals += !is_first && is_goal(self, i - 1U) ? 1U : 0U;
    return take_times(self, i, &piece, is_first);
}

// ---- where it begins

static void count_goals(aisle_verify_moving *self) {
    for (uint32_t i = 0; i < self->request.at_piece; i++) {
        self->motion.goals += is_goal(self, i) ? 1U : 0U;
    }
}

// Which speed counts: the path's, or in the second pass or where it is more the real one. What rests sets out from rest.
static void take_speed(aisle_verify_moving *self) {
    aisle_moving_motion *motion = &self->motion;
    const double told = aisle_verify_speed_square(&motion->speeds, motion->done);
    const double v = motion->turns ? self->request.omega : self->request.v, real = v * v;
    motion->square = told;
    if (motion->rest > 0.0) {
        motion->square = 0.0;
        motion->pull = 1;
    } else {
        motion->square = self->is_second_pass || real > told ? real : told;
        motion->pull = real > told ? -1 : (self->is_second_pass ? 1 : 0);
        self->has_second_pass = !motion->turns && sqrt(told) - v > self->request.vehicle->a_max * AISLE_DRIVE_LAG;
    }
}

bool aisle_moving_motion_begin(aisle_verify_moving *self) {
    aisle_moving_motion *motion = &self->motion;
    memset(motion, 0, sizeof *motion);
    count_goals(self);
    motion->spares_dwell = true;
    if (!take(self, self->request.at_piece, true)) {
        return false;
    }
    motion->done = self->request.at_u * motion->speeds.length;
    take_rate(self);
    motion->run = motion->done;
    motion->leaves_rest = true;
    take_speed(self);
    return true;
}

// ---- and goes on

static aisle_moving_move next_piece(aisle_verify_moving *self) {
    aisle_moving_motion *motion = &self->motion;
    const bool was_wait = !(motion->speeds.length > 0.0);
    const bool rests = was_wait || motion->speeds.rests || motion->speeds.v1 <= VERIFY_REST;
    if (motion->piece + 1U >= (uint32_t)self->request.path->num_waypoints) {
        return AISLE_MOVING_END;
    }
    if (!take(self, motion->piece + 1U, false)) {
        return AISLE_MOVING_STRANGE;
    }
    if (rests) {
        motion->leaves_rest = true;
        motion->run = 0.0;
        motion->square = 0.0;
        motion->pull = 0;
    }
    return AISLE_MOVING_PIECE;
}

// Where the real speed, pulled towards the path's, meets it: way behind the phase's beginning; beyond `length`: not in it.
static double meeting(const aisle_moving_motion *motion, double told, double a, double *pulled) {
    const aisle_verify_speeds *speeds = &motion->speeds;
    *pulled = motion->pull > 0 ? speeds->up : -speeds->down;
    const double closing = 2.0 * (*pulled - a) * motion->pull, apart = (told - motion->square) * motion->pull;
    if (apart <= 0.0) {
        return 0.0;
    }
    return closing > 0.0 ? apart / closing : DBL_MAX;
}

// Ends the phase at `until`.
static void end_at(aisle_moving_phase *phase, double until) {
    const double time = until - phase->begins;
    phase->v1 = aisle_max(phase->v0 + phase->a * time, 0.0);
    phase->to = aisle_min(phase->to, phase->from + 0.5 * (phase->v0 + phase->v1) * time);
}

static void move_by(aisle_moving_motion *motion, double gone) {
    motion->done += gone;
    motion->run += gone;
    motion->way += motion->turns ? 0.0 : gone;
}

static aisle_moving_move go_on(aisle_verify_moving *self, double until, aisle_moving_phase *phase) {
    aisle_moving_motion *motion = &self->motion;
    const aisle_verify_speeds *speeds = &motion->speeds;
    const double end = aisle_verify_speed_bend(speeds, motion->done + DONE); // beyond that: more is left
    const double told = aisle_verify_speed_square(speeds, motion->done);
    double length = end - motion->done;
    bool meets = false;
    double a = (aisle_verify_speed_square(speeds, end) - told) / (2.0 * length); // length > 0
    if (motion->pull != 0) {
        double pulled;
        const double way = meeting(motion, told, a, &pulled);
        meets = way <= length;
        a = way > 0.0 ? pulled : a;
        motion->square = way > 0.0 ? motion->square : told;
        length = way > 0.0 ? aisle_min(length, way) : length;
    } else {
        motion->square = told;
    }
    const double v0 = sqrt(motion->square), v1 = sqrt(aisle_max(motion->square + 2.0 * a * length, 0.0));
    if (!(v0 + v1 > 0.0)) {
        return AISLE_MOVING_STRANGE;
    }
    *phase = (aisle_moving_phase){motion->run, motion->run + length, v0, v1, a, motion->clock, motion->late};
    const double time = 2.0 * length / (v0 + v1);
    if (motion->clock + time > until) {
        end_at(phase, until);
    } else if (meets) {
        motion->pull = 0;
    }
    move_by(motion, phase->to - phase->from);
    motion->clock = aisle_min(motion->clock + time, until);
    motion->square = phase->v1 * phase->v1;
    return AISLE_MOVING_PHASE;
}

aisle_moving_move aisle_moving_motion_next(aisle_verify_moving *self, double until, aisle_moving_phase *phase) {
    aisle_moving_motion *motion = &self->motion;
    const double wait = aisle_min(motion->rest, until - motion->clock);
    if (!(motion->clock < until)) {
        return AISLE_MOVING_DUE;
    }
    motion->clock += wait;
    motion->rest -= wait;
    if (motion->speeds.length - motion->done <= DONE && !(motion->rest > 0.0)) {
        return next_piece(self);
    }
    return motion->clock < until ? go_on(self, until, phase) : AISLE_MOVING_DUE;
}
