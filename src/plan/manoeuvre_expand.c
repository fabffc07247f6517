#include "plan/manoeuvre_parts.h"

#include "base/angle.h"

#include <math.h>

#define STEP_OPEN 2.0      // m, longest step
#define LINK_FAR 12.0      // m
#define LINKS_EACH 3U      // ways of steer.h that are pushed for a target
#define LINKS_PATIENCE 60U // links that fail, for each of which one more node goes without
#define LINKS_PAUSE_MAX 10U
#define LEVELS 4

// ---- steps

static double cost_of(const aisle_manoeuvre *self, int8_t before, const aisle_move *moves, uint32_t count,
                      int8_t *after) {
    double cost = aisle_steer_cost(&self->rule, moves, count);
    *after = before;
    for (uint32_t i = 0, first = 1; i < count; i++) {
        if (fabs(moves[i].length) > 0.0) {
            *after = moves[i].length < 0.0 ? -1 : 1;
            cost += first != 0U && before * *after < 0 ? self->rule.cusp : 0.0;
            first = 0;
        }
    }
    return cost;
}

// A step's end is tested here, its motion when it comes up.
static void push_step(aisle_manoeuvre *self, uint32_t parent, double length, double turn) {
    const aisle_manoeuvre_node *from = &self->node[parent];
    aisle_manoeuvre_node node = {
        .length = (float)length, .turn = (float)turn, .parent = parent, .target = AISLE_MANOEUVRE_TARGETS};
    const aisle_move move = {(double)node.length, (double)node.turn};
    const aisle_move driven = {self->side * move.length, self->side * move.turn};
    double cost = cost_of(self, from->direction, &driven, 1, &node.direction);
    if (fabs(length) <= 0.0 && from->target == AISLE_MANOEUVRE_TARGETS && fabs((double)from->length) <= 0.0 &&
        from->parent != AISLE_HEAP_NONE) {
        cost -= self->rule.turn_start; // it goes on turning
    }
    node.cost = from->cost + (float)cost;
    node.pose = aisle_move_end(from->pose, move);
    node.pose.theta = aisle_angle_wrap(node.pose.theta);
    if (aisle_manoeuvre_pose_free(self, node.pose)) {
        node.cost += (float)aisle_manoeuvre_surcharge(self, from->pose, &move, 1);
        aisle_manoeuvre_push(self, &node);
    }
}

// ---- links

static void push_links(aisle_manoeuvre *self, uint32_t parent, uint32_t to) {
    const aisle_manoeuvre_target *target = &self->target[to];
    const aisle_manoeuvre_node *from = &self->node[parent];
    aisle_steer_way ways[AISLE_STEER_WAYS];
    uint32_t count = aisle_steer(&self->rule, from->pose, target->pose, ways);
    double beeline = aisle_vec2_distance(aisle_pose_place(from->pose), aisle_pose_place(target->pose));
    for (uint32_t i = 0; i < count && i < LINKS_EACH; i++) {
        if (ways[i].cost > 4.0 * beeline + 8.0) { // a step or two will find something better
            break;
        }
        aisle_manoeuvre_node node = {.pose = target->pose, .parent = parent, .target = (uint16_t)to, .way = (uint8_t)i};
        double cost = cost_of(self, from->direction, ways[i].move, ways[i].count, &node.direction);
        node.cost = from->cost + (float)cost;
        aisle_manoeuvre_push(self, &node);
    }
}

// A goal of any heading is taken as one comes to it, forwards or backwards.
static void push_free_goal(aisle_manoeuvre *self, uint32_t parent, uint32_t to) {
    aisle_manoeuvre_target *target = &self->target[to];
    if (self->request.goal_is_free && !(self->rule.radius_min > 0.0)) {
        const aisle_pose2 *from = &self->node[parent].pose;
        double course = aisle_atan2(target->pose.y - from->y, target->pose.x - from->x);
        target->pose.theta = to % 2U == 0U ? course : aisle_angle_wrap(course + AISLE_PI);
        if (!aisle_manoeuvre_pose_free(self, target->pose)) {
            return;
        }
    }
    push_links(self, parent, to);
}

// Of the tree's nodes within reach the nearest, half a metre for a radian, and one in turn.
static void push_tree(aisle_manoeuvre *self, uint32_t parent) {
    const aisle_pose2 *p = &self->node[parent].pose;
    uint32_t nearest = AISLE_MANOEUVRE_TARGETS;
    double least = LINK_FAR;
    uint32_t count = self->target_count - self->tree_target;
    for (uint32_t i = self->tree_target; i < self->target_count; i++) {
        const aisle_pose2 *q = &self->target[i].pose;
        double turn = fabs(aisle_angle_difference(p->theta, q->theta));
        double distance = aisle_vec2_distance(aisle_pose_place(*p), aisle_pose_place(*q)) + 0.5 * turn;
        if (!self->target[i].closed && distance < least) {
            least = distance;
            nearest = i;
        }
    }
    uint32_t turn = self->tree_target + (count > 0U ? self->expanded * 7U % count : 0U);
    if (nearest < AISLE_MANOEUVRE_TARGETS) {
        push_links(self, parent, nearest);
        if (turn != nearest && !self->target[turn].closed) {
            push_links(self, parent, turn);
        }
    }
}

// Of the targets within reach the one nearest to the goal at each of a few distances, and one in turn, so that none that
// always fails is asked for ever.
static void push_targets(aisle_manoeuvre *self, uint32_t parent) {
    static const double level[LEVELS] = {1.5, 3.0, 6.0, LINK_FAR};
    const aisle_vec2 p = aisle_pose_place(self->node[parent].pose);
    double ahead = aisle_togo_at(&self->togo, p) - 0.2;
    uint32_t best[LEVELS + 1] = {AISLE_MANOEUVRE_TARGETS, AISLE_MANOEUVRE_TARGETS, AISLE_MANOEUVRE_TARGETS,
                                 AISLE_MANOEUVRE_TARGETS, AISLE_MANOEUVRE_TARGETS};
    uint32_t turn = self->expanded % (self->tree_target > 0U ? self->tree_target : 1U);
    for (uint32_t i = 0; i < self->tree_target; i++) {
        const aisle_manoeuvre_target *target = &self->target[i];
        double distance = aisle_vec2_distance(p, aisle_pose_place(target->pose));
        if (distance > LINK_FAR || target->closed) {
            continue;
        }
        if (aisle_manoeuvre_is_goal(target)) {
            push_free_goal(self, parent, i);
        } else if (target->togo < ahead) {
            best[LEVELS] = best[LEVELS] == AISLE_MANOEUVRE_TARGETS || i <= turn ? i : best[LEVELS];
            for (int k = 0; k < LEVELS; k++) {
                bool nearer = best[k] == AISLE_MANOEUVRE_TARGETS || target->togo < self->target[best[k]].togo;
                best[k] = distance <= level[k] && nearer ? i : best[k];
            }
        }
    }
    for (int k = 0; k <= LEVELS; k++) {
        bool seen = best[k] == AISLE_MANOEUVRE_TARGETS;
        for (int j = 0; j < k; j++) {
            seen = seen || best[j] == best[k];
        }
        if (!seen) {
            push_links(self, parent, best[k]);
        }
    }
}

// ---- all of a node's successors

static void push_arcs(aisle_manoeuvre *self, uint32_t n, double length, double curvature) {
    push_step(self, n, length, curvature * length);
    push_step(self, n, length, -curvature * length);
    push_step(self, n, -length, curvature * length);
    push_step(self, n, -length, -curvature * length);
}

static void push_turns(aisle_manoeuvre *self, uint32_t n) {
    double sector = 2.0 * AISLE_PI / (double)self->headings;
    double at = self->node[n].pose.theta / sector;
    double left = floor(at + 1e-3) + 1.0; // its own heading may be one of them, but for rounding
    double right = -(floor(-at + 1e-3) + 1.0);
    push_step(self, n, 0.0, (left - at) * sector);
    push_step(self, n, 0.0, (right - at) * sector);
}

void aisle_manoeuvre_expand(aisle_manoeuvre *self, uint32_t n) {
    const aisle_space *space = self->request.space;
    double around = aisle_grid_gap_lower(space->grid, aisle_pose_place(self->node[n].pose));
    double open = around - space->vehicle->outer_radius - self->need;
    double step = aisle_clamp(open, self->step, STEP_OPEN);
    double sector = 2.0 * AISLE_PI / (double)self->headings;
    self->expanded++;
    push_step(self, n, step, 0.0);
    push_step(self, n, -step, 0.0);
    if (space->vehicle->curvature_max > 0.0) {
        double radius = self->rule.radius_min;
        double arc = aisle_max(self->step, sector * radius);
        push_arcs(self, n, arc, 1.0 / radius);
        push_arcs(self, n, arc, 0.5 / radius);
    } else {
        push_arcs(self, n, self->step, sector / self->step);
        push_turns(self, n);
    }
    if (self->side > 0.0 && self->expanded >= self->link_next) {
        uint32_t pause = self->link_fails / LINKS_PATIENCE;
        self->link_next = self->expanded + (pause < LINKS_PAUSE_MAX ? pause : LINKS_PAUSE_MAX);
        push_targets(self, n);
        push_tree(self, n);
    }
}

void aisle_manoeuvre_push_root(aisle_manoeuvre *self, aisle_pose2 at, double theta) {
    aisle_manoeuvre_node root = {.pose = at, .parent = AISLE_HEAP_NONE, .target = AISLE_MANOEUVRE_TARGETS};
    root.pose.theta = aisle_angle_wrap(theta);
    if (aisle_manoeuvre_pose_free(self, root.pose)) {
        aisle_manoeuvre_push(self, &root);
    }
}

void aisle_manoeuvre_push_roots(aisle_manoeuvre *self, aisle_pose2 at, bool any_heading) {
    if (!any_heading) {
        aisle_manoeuvre_push_root(self, at, at.theta);
        return;
    }
    for (uint32_t i = 0; i < self->headings; i++) {
        aisle_manoeuvre_push_root(self, at, 2.0 * AISLE_PI * (double)i / (double)self->headings);
    }
}
