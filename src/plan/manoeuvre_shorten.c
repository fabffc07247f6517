#include "base/angle.h"
#include "base/check.h"
#include "plan/manoeuvre_parts.h"

#include <math.h>
#include <string.h>

#define PIECE 0.6  // m, the chain is cut into moves no longer than this to start from
#define GAIN 0.01  // m, a saving below it is none
#define OFFSETS 6U // junctions ahead: 64, 32, ... 2
#define PASSES 3U
#define TRIED_EACH 3U // ways of steer.h
#define SAME 1e-9     // of curvatures

static double weigh(aisle_manoeuvre *self, uint32_t i) {
    return aisle_manoeuvre_surcharge(self, self->junction[i], &self->move[i], 1);
}

// Takes a move out of the chain and puts others in its place; what they cost beyond is not known yet. False: there is no room.
static bool splice(aisle_manoeuvre *self, uint32_t first, uint32_t removed, const aisle_move *moves, uint32_t count) {
    if (self->moves - removed + count > AISLE_MANOEUVRE_CHAIN) {
        return false;
    }
    uint32_t behind = self->moves - first - removed;
    memmove(self->move + first + count, self->move + first + removed, behind * sizeof(aisle_move));
    // The junction after what was removed stays as it was, exactly.
    memmove(self->junction + first + count, self->junction + first + removed, (behind + 1U) * sizeof(aisle_pose2));
    memmove(self->near + first + count, self->near + first + removed, behind * sizeof(float));
    memcpy(self->move + first, moves, count * sizeof(aisle_move));
    for (uint32_t i = 0; i + 1U < count; i++) {
        aisle_pose2 p = aisle_move_end(self->junction[first + i], moves[i]);
        p.theta = aisle_angle_wrap(p.theta);
        self->junction[first + i + 1U] = p;
    }
    self->moves = self->moves - removed + count;
    return true;
}

static void cut(aisle_manoeuvre *self) {
    for (uint32_t i = 0; i < self->moves; i++) {
        aisle_move move = self->move[i];
        if (fabs(move.length) > PIECE) {
            double parts = floor(fabs(move.length) / PIECE) + 1.0;
            aisle_move both[2] = {aisle_move_part(move, 1.0 / parts), aisle_move_part(move, 1.0 - 1.0 / parts)};
            if (!splice(self, i, 1, both, 2)) {
                return;
            }
            self->near[i] = (float)weigh(self, i);
            self->near[i + 1U] = (float)weigh(self, i + 1U);
        }
    }
}

static bool may_merge(aisle_move a, aisle_move b) {
    bool spot_a = fabs(a.length) <= 0.0, spot_b = fabs(b.length) <= 0.0;
    if (spot_a || spot_b) {
        return spot_a && spot_b && fabs(a.turn + b.turn) < AISLE_PI;
    }
    return a.length * b.length > 0.0 && fabs(a.turn / a.length - b.turn / b.length) < SAME &&
           fabs(a.turn + b.turn) < AISLE_PI;
}

static void merge(aisle_manoeuvre *self) {
    for (uint32_t i = 0; i + 1U < self->moves;) {
        aisle_move a = self->move[i], b = self->move[i + 1U];
        if (may_merge(a, b)) {
            aisle_move sum = {a.length + b.length, a.turn + b.turn};
            float near = self->near[i] + self->near[i + 1U];
            (void)splice(self, i, 2, &sum, 1);
            self->near[i] = near;
        } else {
            i++;
        }
    }
}

void aisle_manoeuvre_begin_shorten(aisle_manoeuvre *self) {
    for (uint32_t i = 0; i < self->moves; i++) {
        self->near[i] = (float)weigh(self, i);
    }
    merge(self);
    cut(self);
    self->at = 0;
    self->pass = 0;
}

// Cost of the chain from move `first` on, `count` moves, with its neighbours: cusps lie between moves.
static double cost_between(const aisle_manoeuvre *self, uint32_t first, uint32_t count) {
    uint32_t from = first > 0U ? first - 1U : first;
    uint32_t to = first + count < self->moves ? first + count + 1U : first + count;
    double near = 0.0;
    for (uint32_t i = first; i < first + count; i++) {
        near += (double)self->near[i];
    }
    return aisle_steer_cost(&self->rule, self->move + from, to - from) + near;
}

// The same with other moves there.
static double cost_instead(const aisle_manoeuvre *self, uint32_t first, uint32_t count, const aisle_steer_way *way) {
    aisle_move moves[AISLE_REEDS_SHEPP_MOVES + 2U];
    uint32_t n = 0;
    if (first > 0U) {
        moves[n++] = self->move[first - 1U];
    }
    memcpy(moves + n, way->move, way->count * sizeof(aisle_move));
    n += way->count;
    if (first + count < self->moves) {
        moves[n++] = self->move[first + count];
    }
    return aisle_steer_cost(&self->rule, moves, n);
}

static bool put(aisle_manoeuvre *self, uint32_t first, uint32_t removed, const aisle_steer_way *way) {
    if (!splice(self, first, removed, way->move, way->count)) {
        return false;
    }
    for (uint32_t i = first; i < first + way->count; i++) {
        self->near[i] = (float)weigh(self, i);
    }
    return true;
}

static bool try_between(aisle_manoeuvre *self, uint32_t i, uint32_t j) {
    aisle_steer_way ways[AISLE_STEER_WAYS];
    uint32_t count = aisle_steer(&self->rule, self->junction[i], self->junction[j], ways);
    double now = cost_between(self, i, j - i);
    self->units += 1U;
    for (uint32_t k = 0; k < count && k < TRIED_EACH; k++) {
        double cost = cost_instead(self, i, j - i, &ways[k]);
        if (cost > now - GAIN || !aisle_manoeuvre_moves_free(self, self->junction[i], ways[k].move, ways[k].count)) {
            continue;
        }
        cost += aisle_manoeuvre_surcharge(self, self->junction[i], ways[k].move, ways[k].count);
        if (!(cost > now - GAIN)) {
            return put(self, i, j - i, &ways[k]);
        }
    }
    return false;
}

bool aisle_manoeuvre_shorten(aisle_manoeuvre *self) {
    uint32_t i = self->at;
    bool shorter = false;
    for (uint32_t offset = 1U << OFFSETS; offset > 1U && !shorter; offset /= 2U) {
        uint32_t j = i + offset < self->moves ? i + offset : self->moves;
        if (j > i + 1U) {
            shorter = try_between(self, i, j);
        }
    }
    self->at++;
    if (self->at + 1U >= self->moves) {
        self->at = 0;
        self->pass++;
        merge(self);
        if (self->pass < PASSES) {
            cut(self);
        }
    }
    return self->pass < PASSES;
}
