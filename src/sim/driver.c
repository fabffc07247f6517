#include "sim/driver.h"

#include "base/angle.h"
#include "robot/curve.h"
#include "robot/profile.h"

#include <string.h>

#define SEARCH 3.0          // m of a new path on which the vehicle looks for itself
#define HEADING_WEIGHT 0.3  // m a rad, when it does
#define CURVATURE_SPARE 0.3 // 1/m of steering beyond the sharpest arc of the path, for corrections

void aisle_sim_driver_start(aisle_sim_driver *self, const aisle_vehicle *vehicle, double ahead) {
    memset(self, 0, sizeof *self);
    self->vehicle = vehicle;
    self->ahead = ahead;
    self->share = 1.0;
}

void aisle_sim_driver_take_goals(aisle_sim_driver *self, const aisle_goal_list_msg *list) {
    self->num_goals = list->num_goals;
    memcpy(self->goals, list->goals, (size_t)list->num_goals * sizeof list->goals[0]);
}

// ---- reading the path

static uint32_t count_of(const aisle_sim_driver *self) {
    return (uint32_t)self->path.num_waypoints;
}

static bool is_turn(const aisle_sim_driver *self, uint32_t piece) {
    return (self->path.waypoints[piece - 1].flags & AISLE_WAYPOINT_TURN_IN_PLACE) != 0;
}

static bool is_reverse(const aisle_sim_driver *self, uint32_t piece) {
    return (self->path.waypoints[piece].flags & AISLE_WAYPOINT_REVERSE) != 0;
}

// m, or rad of a turn on the spot.
static double extent_of(const aisle_sim_driver *self, uint32_t piece) {
    const aisle_waypoint_msg *to = &self->path.waypoints[piece], *from = to - 1;
    return is_turn(self, piece) ? fabs(aisle_piece_turn(from, to)) : aisle_piece_length(from, to);
}

static bool rests_at(const aisle_sim_driver *self, uint32_t waypoint) {
    return waypoint + 1 >= count_of(self) || self->path.waypoints[waypoint].v <= 1e-6F;
}

static double dwell_at(const aisle_sim_driver *self, uint32_t waypoint) {
    const aisle_waypoint_msg *w = &self->path.waypoints[waypoint];
    for (int16_t i = 0; (w->flags & AISLE_WAYPOINT_GOAL) != 0 && i < self->num_goals; i++) {
        if (self->goals[i].id == w->goal_id) {
            return (double)self->goals[i].dwell;
        }
    }
    return 0.0;
}

// Peak of the trapezoid of this length that takes this time: T p = p^2 (1/a + 1/d) / 2 + L.
static double peak_of(double time, double length, double a, double d) {
    double k = 1.0 / a + 1.0 / d, root = time * time - 2.0 * k * length;
    return root > 0.0 ? (time - sqrt(root)) / k : time / k;
}

// The path's speed `s` metres into a piece that is no turn.
static double speed_at(const aisle_sim_driver *self, uint32_t piece, double s) {
    const aisle_waypoint_msg *to = &self->path.waypoints[piece], *from = to - 1;
    double length = extent_of(self, piece), v0 = (double)from->v, v1 = (double)to->v;
    double share = length > 0.0 ? aisle_clamp(s / length, 0.0, 1.0) : 1.0;
    if (v0 + v1 > 0.0) {
        return sqrt(v0 * v0 + share * (v1 * v1 - v0 * v0));
    }
    double a = self->vehicle->a_max, d = self->vehicle->d_max;
    double time = (double)to->t - (double)from->t - dwell_at(self, piece - 1);
    double ramps = aisle_min(sqrt(2.0 * a * share * length), sqrt(2.0 * d * (1.0 - share) * length));
    return aisle_min(ramps, peak_of(aisle_max(time, 0.0), length, a, d));
}

// Speed and curvature of the path `way` metres ahead of the place; at most up to the next rest, whose speed is 0.
static double speed_ahead(const aisle_sim_driver *self, double way, double *curvature) {
    uint32_t piece = self->piece;
    double s = self->done + way;
    while (s > extent_of(self, piece) && !rests_at(self, piece)) {
        s -= extent_of(self, piece++);
    }
    *curvature = (double)self->path.waypoints[piece].curvature;
    return speed_at(self, piece, s);
}

// Metres to the next rest.
static double to_rest(const aisle_sim_driver *self) {
    uint32_t piece = self->piece;
    double way = extent_of(self, piece) - self->done;
    while (!rests_at(self, piece)) {
        way += extent_of(self, ++piece);
    }
    return way;
}

static aisle_pose2 pose_at(const aisle_sim_driver *self, uint32_t piece, double done) {
    const aisle_waypoint_msg *to = &self->path.waypoints[piece];
    double extent = extent_of(self, piece);
    return aisle_piece_at(to - 1, to, extent > 0.0 ? done / extent : 1.0);
}

static double motion_sign(const aisle_sim_driver *self, uint32_t piece) {
    return is_reverse(self, piece) ? -1.0 : 1.0;
}

// The place on a driven piece nearest to p, searched from `done` on by Newton's method, within the piece.
static double project(const aisle_sim_driver *self, uint32_t piece, double done, aisle_pose2 p) {
    double extent = extent_of(self, piece);
    for (int i = 0; i < 4; i++) {
        aisle_pose2 r = pose_at(self, piece, done);
        double sine, cosine, sign = motion_sign(self, piece);
        aisle_sincos(r.theta, &sine, &cosine);
        done = aisle_clamp(done + sign * ((p.x - r.x) * cosine + (p.y - r.y) * sine), 0.0, extent);
    }
    return done;
}

// ---- a new path

// rad turned already, of a turn on the spot.
static double turned(const aisle_sim_driver *self, uint32_t piece, double heading) {
    const aisle_waypoint_msg *to = &self->path.waypoints[piece], *from = to - 1;
    double way = aisle_piece_turn(from, to), sign = way < 0.0 ? -1.0 : 1.0;
    return aisle_clamp(sign * aisle_angle_difference(from->theta, heading), 0.0, fabs(way));
}

// How far the estimate is off the nearest place of the piece; *done: that place.
static double misfit(const aisle_sim_driver *self, uint32_t piece, aisle_pose2 p, double *done) {
    *done = is_turn(self, piece) ? turned(self, piece, p.theta) : project(self, piece, 0.5 * extent_of(self, piece), p);
    aisle_pose2 r = pose_at(self, piece, *done);
    return aisle_vec2_length(aisle_vec2_of(p.x - r.x, p.y - r.y)) +
           HEADING_WEIGHT * fabs(aisle_angle_difference(r.theta, p.theta));
}

static void locate(aisle_sim_driver *self, aisle_pose2 p) {
    double best = (double)INFINITY, way = 0.0, done;
    self->piece = 1;
    self->done = 0.0;
    for (uint32_t piece = 1; piece < count_of(self) && way <= SEARCH; piece++) {
        double off = misfit(self, piece, p, &done);
        if (off < best - 1e-9) {
            best = off;
            self->piece = piece;
            self->done = done;
        }
        way += is_turn(self, piece) ? 0.0 : extent_of(self, piece);
    }
}

static bool is_older(const aisle_sim_driver *self, const aisle_path_msg *path) {
    return self->has_path && path->boot_id == self->path.boot_id && path->path_revision < self->path.path_revision;
}

void aisle_sim_driver_take_path(aisle_sim_driver *self, const aisle_path_msg *path, const aisle_sim_estimate *at) {
    if (is_older(self, path)) {
        self->ignored++;
        return;
    }
    if (path->status == AISLE_PATH_NONE || path->num_waypoints < 1) {
        self->revoked = true;
        self->path.path_revision = path->path_revision;
        self->path.boot_id = path->boot_id;
        self->path.status = AISLE_PATH_NONE;
        return;
    }
    bool same = self->has_path && path->boot_id == self->path.boot_id &&
                path->path_revision == self->path.path_revision && path->status == self->path.status;
    self->valid_until_us = path->valid_until_utime;
    if (same) {
        self->renewed++;
        return;
    }
    self->adopted++;
    self->path = *path;
    self->has_path = true;
    self->revoked = path->status == AISLE_PATH_STOP;
    self->arriving = false;
    self->is_fresh = true;
    self->heading = at->pose.theta;
    locate(self, at->pose);
}

// ---- driving

bool aisle_sim_driver_brakes(const aisle_sim_driver *self, int64_t now_us) {
    return !self->has_path || self->revoked || now_us > self->valid_until_us;
}

static bool stands(const aisle_sim_estimate *at) {
    return fabs(at->v) < 5e-3 && fabs(at->omega) < 1e-2;
}

// It stands on this waypoint, and stays there for the rest of its dwell.
static void stay(aisle_sim_driver *self, uint32_t waypoint, int64_t now_us) {
    const aisle_waypoint_msg *w = &self->path.waypoints[waypoint];
    if ((w->flags & AISLE_WAYPOINT_GOAL) == 0) {
        return;
    }
    if (!self->dwells || self->dwells_on != w->goal_id) {
        self->dwells = true;
        self->dwells_on = w->goal_id;
        self->dwells_since_us = now_us;
    }
    self->rest_until_us = self->dwells_since_us + (int64_t)(dwell_at(self, waypoint) * 1e6);
}

// Begins the piece ahead.
static void enter(aisle_sim_driver *self, aisle_pose2 at) {
    self->heading = at.theta;
    self->done = is_turn(self, self->piece) ? turned(self, self->piece, at.theta) : project(self, self->piece, 0.0, at);
}

// Passes pieces that lie behind; at a rest only when the wheels stand and the dwell is over.
static void advance(aisle_sim_driver *self, int64_t now_us, const aisle_sim_estimate *at) {
    while (self->piece < count_of(self)) {
        double left = extent_of(self, self->piece) - self->done;
        if (!rests_at(self, self->piece) && !is_turn(self, self->piece)) {
            if (left > 0.0) {
                return;
            }
        } else {
            self->arriving = self->arriving || left <= AISLE_SIM_DRIVER_REACHED;
            if (!self->arriving || !stands(at)) {
                return;
            }
            stay(self, self->piece, now_us);
        }
        self->arriving = false;
        self->piece++;
        if (self->piece < count_of(self)) {
            enter(self, at->pose);
        }
    }
}

static void follow(aisle_sim_driver *self, const aisle_sim_estimate *at) {
    if (is_turn(self, self->piece)) {
        const aisle_waypoint_msg *to = &self->path.waypoints[self->piece];
        double sign = aisle_piece_turn(to - 1, to) < 0.0 ? -1.0 : 1.0;
        self->done += sign * aisle_angle_difference(self->heading, at->pose.theta);
    } else {
        self->done = project(self, self->piece, self->done, at->pose);
    }
    self->heading = at->pose.theta;
}

static aisle_sim_command spin(const aisle_sim_driver *self, const aisle_sim_estimate *at, bool brake) {
    aisle_sim_command out = {.spins = fabs(at->v) < 5e-3};
    const aisle_waypoint_msg *to = &self->path.waypoints[self->piece];
    double way = aisle_piece_turn(to - 1, to), left = fabs(way) - self->done;
    if (!brake && !self->arriving && left > AISLE_SIM_DRIVER_REACHED) {
        double room = aisle_max(left - fabs(at->omega) * self->ahead, 0.0);
        double rate = aisle_min(self->vehicle->omega_max, sqrt(2.0 * self->vehicle->alpha_max * room));
        out.spin = (way < 0.0 ? -1.0 : 1.0) * aisle_max(rate, AISLE_SIM_DRIVER_CRAWL);
    }
    return out;
}

// Curvature that leads back to the path.
static double steer(aisle_sim_driver *self, const aisle_sim_estimate *at, double ahead_curvature) {
    aisle_pose2 r = pose_at(self, self->piece, self->done);
    double sine, cosine, sign = motion_sign(self, self->piece);
    aisle_sincos(r.theta, &sine, &cosine);
    self->lateral = sign * ((at->pose.y - r.y) * cosine - (at->pose.x - r.x) * sine);
    double heading = aisle_angle_difference(r.theta, at->pose.theta), n = AISLE_SIM_DRIVER_GAIN;
    double most = aisle_max(fabs(ahead_curvature), self->vehicle->curvature_max) + CURVATURE_SPARE;
    return aisle_clamp(ahead_curvature - n * n * self->lateral - 2.0 * n * heading, -most, most);
}

static aisle_sim_command drive(aisle_sim_driver *self, const aisle_sim_estimate *at, bool brake) {
    aisle_sim_command out = {0};
    double curvature, here, speed = fabs(at->v);
    here = speed_ahead(self, 0.01, &curvature);
    double then = speed_ahead(self, aisle_max(speed * self->ahead, 0.01), &curvature);
    out.curvature = steer(self, at, curvature);
    if (!brake && !self->arriving) {
        double v = self->share * aisle_min(here, then);
        v = to_rest(self) > AISLE_SIM_DRIVER_REACHED ? aisle_max(v, AISLE_SIM_DRIVER_CRAWL) : v;
        out.v = motion_sign(self, self->piece) * v;
    }
    return out;
}

static void count_lapse(aisle_sim_driver *self, int64_t now_us, const aisle_sim_estimate *at) {
    const bool is_over = self->has_path && !self->revoked && now_us > self->valid_until_us && !stands(at);
    self->lapses += is_over && !self->has_lapsed ? 1 : 0;
    self->has_lapsed = is_over;
}

aisle_sim_command aisle_sim_driver_step(aisle_sim_driver *self, int64_t now_us, const aisle_sim_estimate *at) {
    self->dwells = self->dwells && stands(at);
    count_lapse(self, now_us, at);
    if (self->has_path && self->is_fresh) {
        self->is_fresh = false;
        self->rest_until_us = now_us;
        if (stands(at) && (self->piece == 1U || self->dwells)) { // by its own estimate the goal may be a little behind
            stay(self, self->piece - 1U, now_us);
        }
    }
    if (!self->has_path || self->piece >= count_of(self)) {
        return (aisle_sim_command){0};
    }
    follow(self, at);
    advance(self, now_us, at);
    if (self->piece >= count_of(self)) {
        return (aisle_sim_command){0};
    }
    bool brake = aisle_sim_driver_brakes(self, now_us) || now_us < self->rest_until_us;
    return is_turn(self, self->piece) ? spin(self, at, brake) : drive(self, at, brake);
}
