#include "sim/judge.h"

#include <string.h>

#define PI 3.14159265358979323846
#define DRIVES 0.05       // m/s
#define SHOWN_GAP 1.0     // m: static gaps beyond are not measured
#define LAG 0.1           // s, see the header
#define SAMPLES_MAX 256.0 // looks between two ticks

void aisle_sim_judge_start(aisle_sim_judge *self, const aisle_sim_scene *scene, const aisle_vehicle_msg *vehicle) {
    memset(self, 0, sizeof *self);
    self->scene = scene;
    self->body.n = vehicle->num_vertices > 0 ? (uint32_t)vehicle->num_vertices : 1;
    self->body.radius = (double)vehicle->footprint_radius;
    for (uint32_t i = 0; i < (uint32_t)vehicle->num_vertices; i++) {
        self->body.v[i] = (aisle_vec2){vehicle->footprint[i][0], vehicle->footprint[i][1]};
    }
    if (vehicle->num_vertices == 0 && !(vehicle->footprint_radius > 0.0F)) {
        self->body = aisle_sim_box(-0.5, -0.35, 0.5, 0.35);
    }
    self->reach = aisle_sim_outline_reach(&self->body);
    self->v_max = vehicle->v_max > 0.0F ? (double)vehicle->v_max : 1.5;
    self->v_back = vehicle->v_reverse_max > 0.0F ? (double)vehicle->v_reverse_max : 0.3;
    self->d_max = vehicle->d_max > 0.0F ? (double)vehicle->d_max : 0.5;
    self->stop_delay = LAG + (vehicle->reaction_time > 0.0F ? (double)vehicle->reaction_time : 0.3);
    self->separation = self->separation_moving = (double)INFINITY;
    self->static_gap = SHOWN_GAP;
    self->t = self->arrival = self->rests_since = -1.0;
    for (uint32_t i = 0; i < AISLE_SIM_MOVERS_MAX; i++) {
        self->watch[i].near_until = -1.0;
    }
}

void aisle_sim_judge_take_goals(aisle_sim_judge *self, const aisle_goal_list_msg *goals) {
    self->goals = *goals;
    memset(self->visited, 0, sizeof self->visited);
    self->num_visited = 0;
    self->rests_since = self->arrival = -1.0;
}

// ---- contacts

static double turn_between(double from, double to) {
    return remainder(to - from, 2.0 * PI);
}

static aisle_pose2 between(aisle_pose2 a, aisle_pose2 b, double f) {
    return (aisle_pose2){a.x + f * (b.x - a.x), a.y + f * (b.y - a.y), a.theta + f * turn_between(a.theta, b.theta)};
}

// Metres that any body point moves at most between two poses.
static double travel(aisle_pose2 a, aisle_pose2 b, double reach) {
    return aisle_vec2_length(aisle_vec2_of(b.x - a.x, b.y - a.y)) + fabs(turn_between(a.theta, b.theta)) * reach;
}

static void begin_contact(aisle_sim_judge *self, aisle_sim_watch *w, double t, int32_t id, bool is_static) {
    w->touches = true;
    w->counted_moving = false;
    w->contact = self->num_contacts;
    if (self->num_contacts < AISLE_SIM_JUDGE_SHOWN) {
        self->contact[self->num_contacts++] =
            (aisle_sim_contact){.t = t, .id = id, .is_static = is_static, .pose = self->pose};
    }
    if (!is_static) {
        self->contacts_at_rest++;
    }
}

// A collision is shown even if the list is full of contacts at rest: in place of the last of these.
static void show_collision(aisle_sim_judge *self, aisle_sim_watch *w, double t, int32_t id, bool is_static) {
    uint32_t i = self->num_contacts;
    while (w->contact >= self->num_contacts && i-- > 0) {
        if (!self->contact[i].moving) {
            w->contact = i;
            self->contact[i] = (aisle_sim_contact){.t = t, .id = id, .is_static = is_static, .pose = self->pose};
        }
    }
}

// Counts what lasts; a contact at rest becomes a collision once the vehicle moves in it.
static void note_contact(aisle_sim_judge *self, aisle_sim_watch *w, bool touches, double t, int32_t id, bool is_static,
                         double speed) {
    if (!touches) {
        w->touches = false;
        return;
    }
    if (!w->touches) {
        begin_contact(self, w, t, id, is_static);
    }
    bool moving = speed > AISLE_SIM_JUDGE_MOVING;
    if (moving && !w->counted_moving) {
        w->counted_moving = true;
        self->static_collisions += is_static ? 1 : 0;
        self->collisions += is_static ? 0 : 1;
        self->contacts_at_rest -= is_static ? 0 : 1;
        show_collision(self, w, t, id, is_static);
    }
    if (w->contact < self->num_contacts) {
        aisle_sim_contact *c = &self->contact[w->contact];
        c->moving = c->moving || moving;
        c->speed = fmax(c->speed, speed);
    }
}

// The least gap to the mover since the last tick; infinite if it is above what is known to be the least.
static double gap_since(const aisle_sim_judge *self, const aisle_sim_watch *w, aisle_pose2 pose,
                        const aisle_sim_mover *m, double known) {
    double near = aisle_vec2_length(aisle_vec2_of(pose.x - m->pose.x, pose.y - m->pose.y)) - self->reach - m->reach;
    double moved = travel(self->pose, pose, self->reach) + travel(w->pose, m->pose, m->reach);
    if (near - moved > known) {
        return (double)INFINITY;
    }
    double least = (double)INFINITY;
    double count = near - moved > 0.5 ? 1.0 : fmin(ceil(moved / AISLE_SIM_JUDGE_STEP) + 1.0, SAMPLES_MAX);
    for (double i = 1.0; i <= count && least > 0.0; i += 1.0) {
        aisle_sim_outline ours = aisle_sim_outline_at(&self->body, between(self->pose, pose, i / count));
        aisle_sim_outline theirs = aisle_sim_outline_at(&m->body, between(w->pose, m->pose, i / count));
        least = fmin(least, aisle_sim_gap(&ours, &theirs));
    }
    return least;
}

static bool meets(const aisle_sim_judge *self, aisle_pose2 pose, double v, const aisle_sim_mover *m) {
    double full = v > 0.0 ? self->v_max : -self->v_back;
    double stop = self->stop_delay + fabs(full) / self->d_max;
    double way = full * self->stop_delay + full * fabs(full) / (2.0 * self->d_max);
    aisle_sim_outline swept = {
        .n = 2, .v = {{pose.x, pose.y}, {pose.x + way * cos(pose.theta), pose.y + way * sin(pose.theta)}}};
    return aisle_sim_gap_to(&swept, (aisle_vec2){m->pose.x, m->pose.y}) <= self->reach + m->reach + m->v_bound * stop;
}

static void look_at(aisle_sim_judge *self, uint32_t i, double t, aisle_pose2 pose, double v, double speed,
                    const aisle_sim_mover *m) {
    aisle_sim_watch *w = &self->watch[i];
    if (!m->is_there) {
        w->was_there = w->touches = false;
        return;
    }
    if (!w->was_there) {
        w->pose = m->pose;
    }
    bool moving = speed > AISLE_SIM_JUDGE_MOVING;
    double gap = gap_since(self, w, pose, m, moving ? self->separation_moving : self->separation);
    self->separation = fmin(self->separation, gap);
    if (moving) {
        self->separation_moving = fmin(self->separation_moving, gap);
    }
    note_contact(self, w, gap <= 0.0, t, m->id, false, speed);
    if (fabs(v) > DRIVES && meets(self, pose, v, m)) {
        self->encounters += w->near_until < t ? 1 : 0;
        w->near_until = t + AISLE_SIM_JUDGE_APART;
    }
    w->was_there = true;
    w->pose = m->pose;
}

static void look_at_hall(aisle_sim_judge *self, double t, aisle_pose2 pose, double speed) {
    double moved = travel(self->pose, pose, self->reach), least = SHOWN_GAP;
    double count = 1.0;
    int32_t id = 0;
    for (double i = 1.0; i <= count && least > 0.0; i += 1.0) {
        aisle_sim_outline ours = aisle_sim_outline_at(&self->body, between(self->pose, pose, i / count));
        int32_t nearest;
        double gap = aisle_sim_scene_gap(self->scene, &ours, SHOWN_GAP, &nearest);
        if (i == 1.0 && gap < moved + 0.01) {
            count = fmin(ceil(moved / AISLE_SIM_JUDGE_STEP) + 1.0, SAMPLES_MAX);
        }
        id = gap < least ? nearest : id;
        least = fmin(least, gap);
    }
    self->static_gap = fmin(self->static_gap, least);
    note_contact(self, &self->still, least <= 0.0, t, id, true, speed);
}

// ---- goals

static bool is_at(const aisle_goal_msg *goal, aisle_pose2 pose) {
    double xy = goal->tolerance_xy > 0.0F ? (double)goal->tolerance_xy : 0.05;
    double theta = goal->tolerance_theta > 0.0F ? (double)goal->tolerance_theta : 0.05;
    return aisle_vec2_length(aisle_vec2_of(goal->x - pose.x, goal->y - pose.y)) <= xy + AISLE_SIM_JUDGE_SLACK &&
           (theta >= PI || fabs(turn_between(goal->theta, pose.theta)) <= theta + AISLE_SIM_JUDGE_SLACK_TH);
}

// The goal to be visited next at this place; -1: none.
static int16_t goal_here(const aisle_sim_judge *self, aisle_pose2 pose) {
    for (int16_t i = 0; i < self->goals.num_goals; i++) {
        if (self->visited[i]) {
            continue;
        }
        if (is_at(&self->goals.goals[i], pose)) {
            return i;
        }
        if (self->goals.ordering == AISLE_GOAL_LIST_ORDERED) {
            return -1;
        }
    }
    return -1;
}

static void look_for_goals(aisle_sim_judge *self, double t, aisle_pose2 pose, double speed) {
    int16_t goal = speed > AISLE_SIM_JUDGE_MOVING ? -1 : goal_here(self, pose);
    if (goal < 0) {
        self->rests_since = -1.0;
        return;
    }
    self->rests_since = self->rests_since < 0.0 ? t : self->rests_since;
    if (t - self->rests_since >= (double)self->goals.goals[goal].dwell - 0.02) {
        self->visited[goal] = true;
        self->num_visited++;
        self->rests_since = -1.0;
        self->arrival = self->num_visited == self->goals.num_goals ? t : -1.0;
    }
}

void aisle_sim_judge_look(aisle_sim_judge *self, double t, aisle_pose2 pose, double v, double speed,
                          const aisle_sim_movers *movers) {
    if (self->t < 0.0) {
        self->pose = pose;
        self->t = t;
    }
    for (uint32_t i = 0; i < movers->count; i++) {
        look_at(self, i, t, pose, v, speed, &movers->mover[i]);
    }
    look_at_hall(self, t, pose, speed);
    look_for_goals(self, t, pose, speed);
    self->way += aisle_vec2_length(aisle_vec2_of(pose.x - self->pose.x, pose.y - self->pose.y));
    self->moving_time += speed > AISLE_SIM_JUDGE_MOVING ? t - self->t : 0.0;
    self->pose = pose;
    self->t = t;
}
