#include "robot/steer.h"

#include "base/angle.h"

#include <math.h>

#define NOTHING 1e-9    // m and rad, a move below it is none
#define ALIGNED 1e-6    // sine below which two headings' lines do not meet
#define RADIUS_MIN 0.05 // m, an arc tighter than this is a turn on the spot

typedef struct list { // the cheapest ways so far, in order
    const aisle_steer_rule *rule;
    aisle_steer_way *ways;
    uint32_t count;
} list;

double aisle_steer_cost(const aisle_steer_rule *rule, const aisle_move *moves, uint32_t count) {
    double cost = 0.0;
    double before = 0.0; // direction of the last move that has a length
    for (uint32_t i = 0; i < count; i++) {
        double length = moves[i].length;
        if (fabs(length) <= 0.0) {
            cost += rule->turn_start + rule->turn_rate * fabs(moves[i].turn);
            continue;
        }
        cost += length < 0.0 ? -length * rule->reverse : length;
        cost += before * length < 0.0 ? rule->cusp : 0.0;
        before = length;
    }
    return cost;
}

static void offer(list *self, const aisle_move *moves, uint32_t count) {
    aisle_steer_way way = {.count = 0};
    for (uint32_t i = 0; i < count; i++) {
        if (fabs(moves[i].length) > NOTHING || fabs(moves[i].turn) > NOTHING) {
            way.move[way.count++] = moves[i];
        }
    }
    way.cost = aisle_steer_cost(self->rule, way.move, way.count);
    if (way.count == 0U) {
        return;
    }
    uint32_t at = self->count < AISLE_STEER_WAYS ? self->count++ : AISLE_STEER_WAYS;
    while (at > 0U && self->ways[at - 1U].cost > way.cost) {
        if (at < AISLE_STEER_WAYS) {
            self->ways[at] = self->ways[at - 1U];
        }
        at--;
    }
    if (at < AISLE_STEER_WAYS) {
        self->ways[at] = way;
    }
}

// Where both headings' lines meet: s along the first one, then r along the second.
typedef struct corner {
    double s, r, turn, tan_half;
} corner;

static bool corner_between(aisle_pose2 from, aisle_pose2 to, corner *out) {
    aisle_vec2 u, v;
    aisle_sincos(from.theta, &u.y, &u.x);
    aisle_sincos(to.theta, &v.y, &v.x);
    double sine = aisle_vec2_cross(u, v);
    aisle_vec2 way = aisle_vec2_of(to.x - from.x, to.y - from.y);
    if (fabs(sine) < ALIGNED) {
        return false;
    }
    out->s = aisle_vec2_cross(way, v) / sine;
    out->r = aisle_vec2_cross(u, way) / sine;
    out->turn = aisle_angle_difference(from.theta, to.theta);
    out->tan_half = fabs(sine) / (1.0 + aisle_vec2_dot(u, v)); // large where it turns back
    return fabs(out->s) <= AISLE_STEER_FAR && fabs(out->r) <= AISLE_STEER_FAR;
}

static void offer_arc(list *self, const corner *c, double radius) {
    double cut = radius * c->tan_half;
    double way = c->s + c->r < 0.0 ? -1.0 : 1.0;
    aisle_move moves[3] = {{c->s - way * cut, 0.0}, {way * radius * fabs(c->turn), c->turn}, {c->r - way * cut, 0.0}};
    offer(self, moves, 3);
}

static void offer_corner(list *self, aisle_pose2 from, aisle_pose2 to) {
    corner c;
    if (!corner_between(from, to, &c)) {
        return;
    }
    double least = self->rule->radius_min;
    if (least <= 0.0 && fabs(c.s) + fabs(c.r) > NOTHING) {
        aisle_move turned[3] = {{c.s, 0.0}, {0.0, c.turn}, {c.r, 0.0}};
        offer(self, turned, 3);
    }
    least = aisle_max(least, RADIUS_MIN);
    double radius = aisle_min(fabs(c.s), fabs(c.r)) / c.tan_half;
    radius = aisle_min(radius, aisle_max(AISLE_STEER_RADIUS, 2.0 * self->rule->radius_min));
    if (c.s * c.r > 0.0 && radius >= least) {
        offer_arc(self, &c, radius);
        if (0.5 * radius >= least) {
            offer_arc(self, &c, 0.5 * radius);
        }
    }
}

static void offer_turns(list *self, aisle_pose2 from, aisle_pose2 to) {
    aisle_vec2 way = aisle_vec2_of(to.x - from.x, to.y - from.y);
    double length = aisle_vec2_length(way);
    if (length <= NOTHING) {
        aisle_move turn = {0.0, aisle_angle_difference(from.theta, to.theta)};
        offer(self, &turn, 1);
        return;
    }
    double course = aisle_atan2(way.y, way.x);
    for (int back = 0; back < 2; back++) {
        double heading = back != 0 ? course + AISLE_PI : course;
        aisle_move moves[3] = {{0.0, aisle_angle_difference(from.theta, heading)},
                               {back != 0 ? -length : length, 0.0},
                               {0.0, aisle_angle_difference(heading, to.theta)}};
        offer(self, moves, 3);
    }
}

static void offer_words(list *self, aisle_pose2 from, aisle_pose2 to) {
    const aisle_reeds_shepp between = aisle_reeds_shepp_between(from, to, self->rule->radius_min);
    aisle_reeds_shepp_word word;
    for (uint32_t n = 0; n < AISLE_REEDS_SHEPP_WORDS; n++) {
        bool full = self->count == AISLE_STEER_WAYS; // no longer one can be cheaper than the dearest
        double longest = full ? self->ways[AISLE_STEER_WAYS - 1U].cost : (double)INFINITY;
        if (aisle_reeds_shepp_word_of(&between, n, longest, &word)) {
            offer(self, word.move, word.count);
        }
    }
}

static bool are_same(aisle_pose2 from, aisle_pose2 to) {
    return fabs(to.x - from.x) <= NOTHING && fabs(to.y - from.y) <= NOTHING &&
           fabs(aisle_angle_difference(from.theta, to.theta)) <= NOTHING;
}

uint32_t aisle_steer(const aisle_steer_rule *rule, aisle_pose2 from, aisle_pose2 to, aisle_steer_way *ways) {
    list found = {rule, ways, 0};
    if (are_same(from, to)) { // else a car would be offered a loop
        return 0;
    }
    offer_corner(&found, from, to);
    if (rule->radius_min > 0.0) {
        offer_words(&found, from, to);
    } else {
        offer_turns(&found, from, to);
    }
    return found.count;
}
