#include "sim/movers.h"

#include "base/angle.h"
#include "base/check.h"

#include <string.h>

#define DRAWS 1000
#define LANE_STEP 0.25    // m
#define LANE_MAX 15.0     // m to each side
#define LANE_MIN 4.0      // m
#define GOAL_NEAR 2.0     // m
#define GOAL_FAR 15.0     // m
#define MEETING 0.5       // m between an adversary and the vehicle
#define AFTER_MEETING 1.5 // s until it lets go
#define PATIENCE 15.0     // s, and when it has met nobody
#define HIDE_NEAR 4.0     // m from the vehicle where it waits for its next turn
#define HIDE_FAR 9.0      // m
#define HIDING 8.0        // s at most on the way there
#define FEINT_NEAR 2.0    // m from the vehicle where a feint turns away
#define FEINT_AWAY 0.8    // s for which it does

static const char *const names[AISLE_SIM_KIND_COUNT] = {"constant", "jumps", "agv", "person", "adversarial", "track"};

aisle_sim_kind aisle_sim_kind_of(const char *name) {
    for (int i = 0; i < (int)AISLE_SIM_KIND_COUNT; i++) {
        if (strcmp(name, names[i]) == 0) {
            return (aisle_sim_kind)i;
        }
    }
    return AISLE_SIM_KIND_COUNT;
}

const char *aisle_sim_kind_name(aisle_sim_kind kind) {
    return names[kind];
}

void aisle_sim_movers_start(aisle_sim_movers *self, const aisle_sim_scene *scene, uint64_t seed) {
    memset(self, 0, sizeof *self);
    self->scene = scene;
    self->rng = aisle_sim_stream(seed, 2);
    self->next_id = 1;
}

// ---- helpers

static aisle_vec2 at_of(const aisle_sim_mover *m) {
    return aisle_vec2_of(m->pose.x, m->pose.y);
}

static aisle_vec2 direction(double angle) {
    aisle_vec2 d;
    aisle_sincos(angle, &d.y, &d.x);
    return d;
}

static double draw(aisle_sim_movers *self, double lo, double hi) {
    return aisle_sim_uniform(&self->rng, lo, hi);
}

static aisle_vec2 draw_place(aisle_sim_movers *self) {
    const aisle_sim_scene *s = self->scene;
    double x = draw(self, s->x_min, s->x_max);
    return aisle_vec2_of(x, draw(self, s->y_min, s->y_max));
}

// Velocity that leads to `to` at this speed, no farther than there in dt.
static aisle_vec2 towards(aisle_vec2 from, aisle_vec2 to, double speed, double dt) {
    aisle_vec2 d = aisle_vec2_sub(to, from);
    double length = aisle_vec2_length(d);
    return length > 0.0 ? aisle_vec2_scale(d, aisle_min(speed, length / dt) / length) : aisle_vec2_of(0.0, 0.0);
}

static void go(aisle_sim_mover *m, aisle_vec2 velocity, double dt) {
    m->velocity = velocity;
    m->pose.x += velocity.x * dt;
    m->pose.y += velocity.y * dt;
}

static bool is_there(const aisle_sim_mover *m) {
    return aisle_vec2_distance(at_of(m), m->to) < 1e-9;
}

static void give_id(aisle_sim_movers *self, aisle_sim_mover *m) {
    m->id = self->next_id++;
}

// ---- beginnings

static void begin_lane(aisle_sim_movers *self, aisle_sim_mover *m) {
    aisle_vec2 along = direction(m->pose.theta), end[2];
    for (int side = 0; side < 2; side++) {
        aisle_vec2 step = aisle_vec2_scale(along, side == 0 ? -LANE_STEP : LANE_STEP);
        end[side] = at_of(m);
        aisle_vec2 next = aisle_vec2_add(end[side], step);
        while (aisle_vec2_distance(at_of(m), next) <= LANE_MAX &&
               aisle_sim_scene_has_room(self->scene, next, m->reach)) {
            end[side] = next;
            next = aisle_vec2_add(next, step);
        }
    }
    m->from = end[0];
    m->to = end[1];
}

static bool draw_goal(aisle_sim_movers *self, aisle_sim_mover *m) {
    for (int i = 0; i < 50; i++) {
        aisle_vec2 to = draw_place(self);
        double way = aisle_vec2_distance(at_of(m), to);
        if (way >= GOAL_NEAR && way <= GOAL_FAR && aisle_sim_scene_sees(self->scene, at_of(m), to, m->reach)) {
            m->to = to;
            return true;
        }
    }
    return false;
}

// Where an adversary waits for its next turn: away from the vehicle, or beside its way.
static aisle_vec2 draw_hide(aisle_sim_movers *self, const aisle_sim_prey *prey) {
    const aisle_sim_scene *hall = self->scene;
    double speed = aisle_vec2_length(prey->velocity), angle = draw(self, -AISLE_PI, AISLE_PI);
    aisle_vec2 off = aisle_vec2_scale(direction(angle), draw(self, HIDE_NEAR, HIDE_FAR));
    if (speed > 0.1 && aisle_rng_below(&self->rng, 2) == 0) {
        aisle_vec2 ahead = aisle_vec2_scale(prey->velocity, 1.0 / speed), beside = aisle_vec2_of(-ahead.y, ahead.x);
        double across = draw(self, -2.5, 2.5);
        off =
            aisle_vec2_add(aisle_vec2_scale(ahead, draw(self, HIDE_NEAR, HIDE_FAR)), aisle_vec2_scale(beside, across));
    }
    aisle_vec2 at = aisle_vec2_add(prey->at, off);
    return aisle_vec2_of(aisle_clamp(at.x, hall->x_min, hall->x_max), aisle_clamp(at.y, hall->y_min, hall->y_max));
}

static void draw_tactic(aisle_sim_movers *self, aisle_sim_mover *m) {
    m->tactic = (aisle_sim_tactic)aisle_rng_below(&self->rng, AISLE_SIM_TACTIC_COUNT);
    m->hides = m->is_set_off = m->has_met = false;
    m->until = self->now + PATIENCE;
    m->trigger = m->tactic == AISLE_SIM_AMBUSH ? draw(self, 0.5, 4.0) : FEINT_NEAR;
}

static void begin(aisle_sim_movers *self, aisle_sim_mover *m) {
    m->speed = draw(self, 0.3 * m->v_bound, m->v_bound);
    m->to = at_of(m);
    if (m->kind == AISLE_SIM_CONSTANT) {
        m->velocity = aisle_vec2_scale(direction(draw(self, -AISLE_PI, AISLE_PI)), m->speed);
    } else if (m->kind == AISLE_SIM_AGV) {
        begin_lane(self, m);
    } else if (m->kind == AISLE_SIM_ADVERSARIAL) {
        draw_tactic(self, m);
    }
}

static aisle_sim_mover *append(aisle_sim_movers *self, aisle_sim_kind kind) {
    AISLE_ASSERT(self->count < AISLE_SIM_MOVERS_MAX);
    aisle_sim_mover *m = &self->mover[self->count++];
    memset(m, 0, sizeof *m);
    m->kind = kind;
    m->is_there = true;
    give_id(self, m);
    return m;
}

static double usual_bound(int8_t told_kind) {
    return told_kind == AISLE_OBSTACLE_PERSON ? 1.6 : 2.0;
}

static void give_body(aisle_sim_movers *self, aisle_sim_mover *m, double v_bound) {
    m->told_kind = AISLE_OBSTACLE_UNKNOWN;
    m->body = aisle_sim_disc(aisle_vec2_of(0.0, 0.0), draw(self, 0.2, 0.45));
    if (m->kind == AISLE_SIM_AGV) {
        m->told_kind = AISLE_OBSTACLE_VEHICLE;
        m->body = aisle_sim_box(-0.6, -0.4, 0.6, 0.4);
        m->pose.theta = 0.5 * AISLE_PI * (double)aisle_rng_below(&self->rng, 2);
    } else if (m->kind == AISLE_SIM_PERSON) {
        m->told_kind = AISLE_OBSTACLE_PERSON;
    }
    m->reach = aisle_sim_outline_reach(&m->body);
    bool by_kind = v_bound <= 0.0 && (m->kind == AISLE_SIM_PERSON || aisle_rng_below(&self->rng, 2) == 0);
    m->v_bound = v_bound > 0.0 ? v_bound : (by_kind ? usual_bound(m->told_kind) : draw(self, 0.5, 2.0));
    m->told_v_bound = (float)m->v_bound;
    m->v_bound = (double)m->told_v_bound; // what is told is what is kept
    if (by_kind) {
        m->v_bound = usual_bound(m->told_kind);
        m->told_v_bound = 0.0F;
    }
}

bool aisle_sim_movers_add(aisle_sim_movers *self, aisle_sim_kind kind, double v_bound, const aisle_sim_prey *prey,
                          double room) {
    if (self->count >= AISLE_SIM_MOVERS_MAX || kind >= AISLE_SIM_TRACK) {
        return false;
    }
    aisle_sim_mover *m = append(self, kind);
    give_body(self, m, v_bound);
    for (int i = 0; i < DRAWS; i++) {
        aisle_vec2 at = draw_place(self);
        if (aisle_vec2_distance(at, prey->at) < room + m->reach + prey->reach ||
            !aisle_sim_scene_has_room(self->scene, at, m->reach)) {
            continue;
        }
        m->pose = (aisle_pose2){at.x, at.y, m->pose.theta};
        begin(self, m);
        if (kind != AISLE_SIM_AGV || aisle_vec2_distance(m->from, m->to) >= LANE_MIN) {
            return true;
        }
    }
    self->count--;
    return false;
}

aisle_sim_mover *aisle_sim_movers_place(aisle_sim_movers *self, aisle_vec2 at, aisle_vec2 velocity, double radius) {
    aisle_sim_mover *m = append(self, AISLE_SIM_CONSTANT);
    m->body = aisle_sim_disc(aisle_vec2_of(0.0, 0.0), radius);
    m->reach = radius;
    m->pose = (aisle_pose2){at.x, at.y, 0.0};
    m->velocity = velocity;
    m->v_bound = 2.0;
    return m;
}

bool aisle_sim_movers_add_tracks(aisle_sim_movers *self, const aisle_sim_tracks *tracks) {
    self->tracks = tracks;
    for (uint32_t i = 0; i < tracks->num_tracks; i++) {
        if (self->count >= AISLE_SIM_MOVERS_MAX) {
            return false;
        }
        aisle_sim_mover *m = append(self, AISLE_SIM_TRACK);
        m->track = i;
        m->told_kind = tracks->track[i].is_vehicle ? AISLE_OBSTACLE_VEHICLE : AISLE_OBSTACLE_PERSON;
        m->reach = tracks->track[i].is_vehicle ? 1.25 : 0.25;
        m->body = aisle_sim_disc(aisle_vec2_of(0.0, 0.0), m->reach);
        m->v_bound = aisle_max(usual_bound(m->told_kind), tracks->track[i].v_max);
        m->told_v_bound = (float)(m->v_bound * (1.0 + 1e-6)); // no less after rounding
        m->is_there = false;
    }
    return true;
}

// ---- steps

static void bounce(aisle_sim_movers *self, aisle_sim_mover *m, double dt) {
    static const double flip[4][2] = {{1.0, 1.0}, {-1.0, 1.0}, {1.0, -1.0}, {-1.0, -1.0}};
    for (int i = 0; i < 4; i++) {
        aisle_vec2 v = {flip[i][0] * m->velocity.x, flip[i][1] * m->velocity.y};
        if (aisle_sim_scene_has_room(self->scene, aisle_vec2_add(at_of(m), aisle_vec2_scale(v, dt)), m->reach)) {
            go(m, v, dt);
            return;
        }
    }
    m->velocity =
        aisle_vec2_scale(direction(draw(self, -AISLE_PI, AISLE_PI)), m->speed); // in a nook: looks for a way out
}

static void jump(aisle_sim_movers *self, aisle_sim_mover *m, double dt) {
    if (self->now > m->until) {
        double turn = sqrt(2.0) / m->v_bound;
        m->until = self->now + turn;
        for (int i = 0; i < 10; i++) {
            double dx = draw(self, -1.0, 1.0);
            aisle_vec2 to = aisle_vec2_add(at_of(m), aisle_vec2_of(dx, draw(self, -1.0, 1.0)));
            if (aisle_sim_scene_sees(self->scene, at_of(m), to, m->reach)) {
                m->to = to;
                m->speed = aisle_vec2_distance(at_of(m), to) / turn;
                break;
            }
        }
    }
    go(m, towards(at_of(m), m->to, m->speed, dt), dt);
}

static void shuttle(aisle_sim_movers *self, aisle_sim_mover *m, double dt) {
    if (self->now < m->until) {
        m->velocity = aisle_vec2_of(0.0, 0.0);
        return;
    }
    go(m, towards(at_of(m), m->to, m->speed, dt), dt);
    if (is_there(m)) {
        aisle_vec2 from = m->from;
        m->from = m->to;
        m->to = from;
        m->until = self->now + draw(self, 0.0, 3.0);
    }
}

static void walk(aisle_sim_movers *self, aisle_sim_mover *m, double dt) {
    m->velocity = aisle_vec2_of(0.0, 0.0);
    if (self->now < m->until) {
        return;
    }
    if (is_there(m)) {
        m->until = self->now + draw(self, 0.0, 2.0);
        m->speed = draw(self, 0.4 * m->v_bound, m->v_bound);
        (void)draw_goal(self, m);
        return;
    }
    go(m, towards(at_of(m), m->to, m->speed, dt), dt);
}

// Where the vehicle and a mover of this speed meet at the soonest if the vehicle goes on as it does; its place if never.
static aisle_vec2 meeting_point(aisle_vec2 from, double speed, const aisle_sim_prey *prey) {
    aisle_vec2 d = aisle_vec2_sub(prey->at, from);
    double a = aisle_vec2_dot(prey->velocity, prey->velocity) - speed * speed;
    double b = 2.0 * aisle_vec2_dot(d, prey->velocity), c = aisle_vec2_dot(d, d), root = b * b - 4.0 * a * c;
    if (fabs(a) < 1e-9 || root < 0.0) {
        return prey->at;
    }
    double t1 = (-b - sqrt(root)) / (2.0 * a), t2 = (-b + sqrt(root)) / (2.0 * a);
    double t = aisle_min(t1, t2) > 0.0 ? aisle_min(t1, t2) : aisle_max(t1, t2);
    return t > 0.0 && t < 10.0 ? aisle_vec2_add(prey->at, aisle_vec2_scale(prey->velocity, t)) : prey->at;
}

// Velocity of an adversary now.
static aisle_vec2 hunt(aisle_sim_movers *self, aisle_sim_mover *m, double distance, double dt,
                       const aisle_sim_prey *prey) {
    aisle_vec2 meet = towards(at_of(m), meeting_point(at_of(m), m->v_bound, prey), m->v_bound, dt);
    if (!m->is_set_off && distance < m->trigger) {
        m->is_set_off = true;
        m->away_until = self->now + FEINT_AWAY;
    }
    switch (m->tactic) {
    case AISLE_SIM_CHASE:
        return towards(at_of(m), prey->at, m->v_bound, dt);
    case AISLE_SIM_AMBUSH:
        return m->is_set_off ? meet : aisle_vec2_of(0.0, 0.0);
    case AISLE_SIM_FEINT:
        return m->is_set_off && self->now < m->away_until ? aisle_vec2_scale(meet, -1.0) : meet;
    case AISLE_SIM_INTERCEPT:
    case AISLE_SIM_TACTIC_COUNT:
    default:
        return meet;
    }
}

static void attack(aisle_sim_movers *self, aisle_sim_mover *m, double dt, const aisle_sim_prey *prey) {
    double distance = aisle_vec2_distance(at_of(m), prey->at) - m->reach - prey->reach;
    if (!m->hides && !m->has_met && distance < MEETING) {
        m->has_met = true;
        m->until = self->now + AFTER_MEETING;
    }
    if (!m->hides && self->now > m->until) {
        m->hides = true;
        m->to = draw_hide(self, prey);
        m->until = self->now + HIDING;
    }
    if (m->hides && (self->now > m->until || is_there(m))) {
        draw_tactic(self, m);
    }
    go(m, m->hides ? towards(at_of(m), m->to, m->v_bound, dt) : hunt(self, m, distance, dt, prey), dt);
}

static void replay(aisle_sim_movers *self, aisle_sim_mover *m, const aisle_sim_prey *prey) {
    aisle_vec2 at, velocity;
    bool recorded = aisle_sim_tracks_at(self->tracks, m->track, self->now, &at, &velocity);
    if (recorded && !m->is_there) { // people do not come out of nothing, but recordings do
        double near = m->reach + prey->reach + m->v_bound * prey->stop_time + prey->stop_way;
        recorded = aisle_vec2_distance(at, prey->at) > near;
    }
    m->is_there = recorded;
    if (recorded) {
        m->velocity = velocity;
        m->pose = (aisle_pose2){at.x, at.y, 0.0};
    }
}

void aisle_sim_movers_step(aisle_sim_movers *self, double dt, const aisle_sim_prey *prey) {
    self->now += dt;
    for (uint32_t i = 0; i < self->count; i++) {
        aisle_sim_mover *m = &self->mover[i];
        switch (m->kind) {
        case AISLE_SIM_CONSTANT:
            bounce(self, m, dt);
            break;
        case AISLE_SIM_JUMPS:
            jump(self, m, dt);
            break;
        case AISLE_SIM_AGV:
            shuttle(self, m, dt);
            break;
        case AISLE_SIM_PERSON:
            walk(self, m, dt);
            break;
        case AISLE_SIM_ADVERSARIAL:
            attack(self, m, dt, prey);
            break;
        case AISLE_SIM_TRACK:
        case AISLE_SIM_KIND_COUNT:
        default:
            replay(self, m, prey);
            break;
        }
    }
}
