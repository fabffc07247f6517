#include "plan/manoeuvre_parts.h"

#include "base/angle.h"
#include "base/check.h"

#include <math.h>
#include <string.h>

uint32_t aisle_manoeuvre_moves_to(const aisle_manoeuvre *self, uint32_t n, aisle_move *moves) {
    const aisle_manoeuvre_node *node = &self->node[n];
    if (node->target == AISLE_MANOEUVRE_TARGETS) {
        moves[0] = (aisle_move){(double)node->length, (double)node->turn};
        return node->parent == AISLE_HEAP_NONE ? 0U : 1U;
    }
    aisle_steer_way ways[AISLE_STEER_WAYS];
    uint32_t count = aisle_steer(&self->rule, self->node[node->parent].pose, node->pose, ways);
    AISLE_ASSERT(node->way < count);
    memcpy(moves, ways[node->way].move, ways[node->way].count * sizeof(aisle_move));
    return ways[node->way].count;
}

static uint32_t depth_of(const aisle_manoeuvre *self, uint32_t n) {
    uint32_t depth = 0;
    while (self->node[n].parent != AISLE_HEAP_NONE) {
        n = self->node[n].parent;
        depth++;
    }
    return depth;
}

// From a node of the tree to the goal: its steps driven the other way, to the end of the chain. Where they begin.
static uint32_t take_tree(aisle_manoeuvre *self, uint32_t n) {
    uint32_t at = AISLE_MANOEUVRE_CHAIN - depth_of(self, n);
    uint32_t first = at;
    self->junction[at] = self->node[n].pose;
    while (self->node[n].parent != AISLE_HEAP_NONE) {
        self->move[at++] = (aisle_move){-(double)self->node[n].length, -(double)self->node[n].turn};
        n = self->node[n].parent;
        self->junction[at] = self->node[n].pose;
    }
    return first;
}

bool aisle_manoeuvre_take_chain(aisle_manoeuvre *self, uint32_t n) {
    aisle_move moves[AISLE_REEDS_SHEPP_MOVES];
    uint32_t tree = self->target[self->node[n].target].node;
    if (tree != AISLE_HEAP_NONE && depth_of(self, tree) >= AISLE_MANOEUVRE_CHAIN) {
        return false;
    }
    uint32_t at = AISLE_MANOEUVRE_CHAIN;
    if (tree != AISLE_HEAP_NONE) {
        at = take_tree(self, tree);
    } else {
        self->junction[at] = self->node[n].pose;
    }
    for (; self->node[n].parent != AISLE_HEAP_NONE; n = self->node[n].parent) {
        uint32_t count = aisle_manoeuvre_moves_to(self, n, moves);
        if (at < count) {
            return false;
        }
        at -= count;
        memcpy(self->move + at, moves, count * sizeof(aisle_move));
        aisle_pose2 p = self->node[self->node[n].parent].pose;
        for (uint32_t i = 0; i < count; i++) { // the last one's end is there already, exactly
            self->junction[at + i] = p;
            p = aisle_move_end(p, moves[i]);
            p.theta = aisle_angle_wrap(p.theta);
        }
    }
    self->moves = AISLE_MANOEUVRE_CHAIN - at;
    memmove(self->move, self->move + at, self->moves * sizeof(aisle_move));
    memmove(self->junction, self->junction + at, (self->moves + 1U) * sizeof(aisle_pose2));
    return true;
}

bool aisle_manoeuvre_add(aisle_manoeuvre *self, const aisle_move *moves, uint32_t count, aisle_pose2 to) {
    if (self->moves + count > AISLE_MANOEUVRE_CHAIN) {
        return false;
    }
    for (uint32_t i = 0; i < count; i++) {
        aisle_pose2 p = aisle_move_end(self->junction[self->moves], moves[i]);
        p.theta = aisle_angle_wrap(p.theta);
        self->move[self->moves++] = moves[i];
        self->junction[self->moves] = i + 1U < count ? p : to;
    }
    return true;
}

uint32_t aisle_manoeuvre_lay(const aisle_manoeuvre *self, aisle_waypoint_msg *w, uint32_t capacity) {
    aisle_pose2 p = self->junction[0];
    uint32_t n = 1;
    w[0] = (aisle_waypoint_msg){.x = p.x, .y = p.y, .theta = p.theta};
    for (uint32_t i = 0; i < self->moves; i++) {
        if (n + AISLE_MOVE_WAYPOINTS > capacity) {
            return 0;
        }
        aisle_waypoint_msg *from = &w[n - 1U];
        if (i > 0U && self->move[i].length * self->move[i - 1U].length < 0.0) {
            from->flags |= AISLE_WAYPOINT_STOP;
        }
        n += aisle_move_lay(self->move[i], from);
        aisle_pose2 end = self->junction[i + 1U]; // as tested, without what rounding adds up to
        w[n - 1U].x = end.x;
        w[n - 1U].y = end.y;
        w[n - 1U].theta = end.theta;
    }
    return n;
}
