#include "sim/episode.h"

#include "base/angle.h"
#include "base/check.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#define DT (AISLE_SIM_TICK_US * 1e-6)
#define QUERY_US 250000   // after the set-up
#define GOALS_US 500000   // after the set-up
#define CONTROL_TICKS 2   // between two commands
#define TRUTH_TICKS 20    // between two rows
#define NOTICE_S 1.5      // until a mover that appears is minded: the longest lease, sensors, messages
#define SETTLE_S 5.0      // after the last goal, for the planner to say so
#define LIMIT_FACTOR 10.0 // of the way without movers
#define LIMIT_EXTRA 60.0  // s

aisle_sim_setup aisle_sim_setup_usual(uint64_t seed) {
    return (aisle_sim_setup){.seed = seed,
                             .room = 2.0,
                             .num_sources = 1,
                             .source = aisle_sim_source_usual(),
                             .pose = aisle_sim_pose_usual(),
                             .path_delay = {0.010, 0.020}};
}

void aisle_sim_episode_start(aisle_sim_episode *self, const aisle_sim_setup *setup, aisle_sim_host *host) {
    memset(self, 0, sizeof *self);
    self->setup = *setup;
    self->host = host;
    self->now_us = host->epoch_us;
    self->rng = aisle_sim_stream(setup->seed, 4);
    self->last_revision = -1;
    self->last_status = -1;
}

double aisle_sim_episode_seconds(const aisle_sim_episode *self) {
    return (double)self->tick * DT;
}

// ---- messages

static bool take_layout(aisle_sim_episode *self, aisle_channel channel, const void *message) {
    if (channel == AISLE_CHANNEL_LAYOUT) {
        return aisle_sim_scene_take_layout(&self->scene, message);
    }
    return channel == AISLE_CHANNEL_GRID ? aisle_sim_scene_take_tile(&self->scene, message)
                                         : aisle_sim_scene_take_patch(&self->scene, message);
}

static bool take_message(aisle_sim_episode *self, aisle_channel channel, const void *message) {
    aisle_refusal why;
    const aisle_pose_msg *pose = message;
    switch ((int)channel) {
    case AISLE_CHANNEL_VEHICLE:
        self->vehicle_msg = *(const aisle_vehicle_msg *)message;
        self->has_vehicle = aisle_vehicle_from_msg(&self->vehicle_msg, &self->vehicle, &why) == AISLE_OK;
        return self->has_vehicle;
    case AISLE_CHANNEL_POSE:
        self->start = (aisle_pose2){pose->x, pose->y, pose->theta};
        self->has_start = true;
        return true;
    case AISLE_CHANNEL_GOALS:
        self->goals = *(const aisle_goal_list_msg *)message;
        self->has_goals = self->goals.num_goals > 0;
        return true;
    case AISLE_CHANNEL_LAYOUT:
    case AISLE_CHANNEL_GRID:
    case AISLE_CHANNEL_LAYOUT_PATCH:
        return take_layout(self, channel, message);
    default:
        return true;
    }
}

static bool take_bytes(aisle_sim_episode *self, aisle_channel channel, const uint8_t *bytes, size_t size) {
    aisle_feed *feed = malloc(sizeof *feed);
    bool good = feed != NULL && aisle_feed_load(feed, channel, bytes, size) == AISLE_OK &&
                take_message(self, channel, &feed->message);
    free(feed);
    return good;
}

bool aisle_sim_episode_prepare(aisle_sim_episode *self, aisle_channel channel, const uint8_t *bytes, size_t size) {
    bool good = take_bytes(self, channel, bytes, size);
    bool is_sent = channel == AISLE_CHANNEL_LAYOUT || channel == AISLE_CHANNEL_GRID ||
                   channel == AISLE_CHANNEL_LAYOUT_PATCH || channel == AISLE_CHANNEL_VEHICLE;
    if (good && is_sent) {
        self->now_us += 1000;
        aisle_sim_host_send(self->host, self->now_us, channel, bytes, size);
    }
    return good;
}

bool aisle_sim_episode_is_held(const aisle_sim_episode *self) {
    return self->status.map_id == self->scene.map_id && self->status.map_revision == self->scene.map_revision &&
           self->status.vehicle_revision == self->vehicle_msg.vehicle_revision;
}

void aisle_sim_episode_wait(aisle_sim_episode *self, double seconds) {
    self->now_us += (int64_t)(seconds * 1e6);
    aisle_sim_host_advance(self->host, self->now_us);
}

void aisle_sim_episode_forget(aisle_sim_episode *self) {
    aisle_sim_scene_free(&self->scene);
    self->has_vehicle = self->has_start = self->has_goals = false;
}

// Encodes and sends at once.
static void send_now(aisle_sim_episode *self, aisle_channel channel, const void *message) {
    static uint8_t bytes[AISLE_MSG_DATAGRAM_MAX]; // one thread
    size_t size = 0;
    aisle_status status = aisle_msg_encode(aisle_channel_type(channel), message, bytes, sizeof bytes, &size);
    AISLE_ASSERT(status == AISLE_OK);
    aisle_sim_host_send(self->host, self->now_us, channel, bytes, size);
}

static void post(aisle_sim_episode *self, aisle_channel channel, const void *message, double delay) {
    static uint8_t bytes[AISLE_MSG_DATAGRAM_MAX];
    size_t size = 0;
    aisle_status status = aisle_msg_encode(aisle_channel_type(channel), message, bytes, sizeof bytes, &size);
    AISLE_ASSERT(status == AISLE_OK);
    int64_t due = self->now_us + (int64_t)(delay * 1e6);
    self->failed = !aisle_sim_post_send(&self->to_planner, due, channel, bytes, size) || self->failed;
}

static void send_query(aisle_sim_episode *self) {
    static aisle_query_msg query;
    query = (aisle_query_msg){.utime = self->now_us,
                              .query_id = AISLE_SIM_QUERY_ID,
                              .map_id = self->goals.map_id,
                              .start = {.x = self->start.x, .y = self->start.y, .theta = self->start.theta},
                              .ordering = self->goals.ordering,
                              .options = self->goals.options,
                              .num_goals = self->goals.num_goals};
    memcpy(query.goals, self->goals.goals, sizeof query.goals);
    send_now(self, AISLE_CHANNEL_QUERY, &query);
}

// At first, and once a second until the planner says that it has them.
static void send_goals(aisle_sim_episode *self, int64_t since_us) {
    bool held = self->status.goal_list_id == self->goals.goal_list_id &&
                self->status.goal_list_revision == self->goals.goal_list_revision;
    if (since_us < 0 || since_us % 1000000 != 0 || (since_us > 0 && held)) {
        return;
    }
    if (since_us == 0) {
        self->goals.utime = self->now_us;
        self->goals_at = aisle_sim_episode_seconds(self);
        self->goals_us = self->now_us;
    }
    send_now(self, AISLE_CHANNEL_GOALS, &self->goals);
}

// ---- what the planner says

static void count_cause(aisle_sim_episode *self, const aisle_path_msg *path) {
    uint32_t i = 0;
    while (i < self->num_causes && (self->cause[i].status != path->status || self->cause[i].cause != path->cause)) {
        i++;
    }
    if (i == self->num_causes && i < AISLE_SIM_CAUSES_MAX) {
        self->cause[self->num_causes++] = (aisle_sim_cause){.status = path->status, .cause = path->cause};
    }
    if (i < AISLE_SIM_CAUSES_MAX) {
        self->cause[i].paths++;
    }
}

static void hear_path(aisle_sim_episode *self, int64_t utime, const uint8_t *bytes, size_t size) {
    const aisle_path_msg *path = &self->heard;
    if (path->path_revision == self->last_revision && path->status == self->last_status) {
        self->renewals++;
    } else {
        self->revisions++;
        count_cause(self, path);
    }
    aisle_sim_faults_note_path(&self->setup.faults, aisle_sim_episode_seconds(self), path->status, path->cause);
    self->last_revision = path->path_revision;
    self->last_status = path->status;
    double delay = aisle_sim_uniform(&self->rng, self->setup.path_delay.least, self->setup.path_delay.most);
    delay = self->host->lcm == NULL ? delay : 0.0; // a bus has a delay of its own
    int64_t due = utime + (int64_t)(delay * 1e6);
    self->failed = !aisle_sim_post_send(&self->to_vehicle, due, AISLE_CHANNEL_PATH, bytes, size) || self->failed;
}

void aisle_sim_episode_hear(void *episode, aisle_channel channel, int64_t utime, const uint8_t *bytes, size_t size) {
    aisle_sim_episode *self = episode;
    if (channel == AISLE_CHANNEL_STATUS) {
        (void)aisle_msg_decode(AISLE_MSG_STATUS, bytes, size, &self->status, NULL);
        return;
    }
    if ((channel != AISLE_CHANNEL_PATH && channel != AISLE_CHANNEL_REPLY) ||
        aisle_msg_decode(AISLE_MSG_PATH, bytes, size, &self->heard, NULL) != AISLE_OK) {
        return;
    }
    if (channel == AISLE_CHANNEL_PATH) {
        hear_path(self, utime, bytes, size);
    } else if (self->heard.query_id == AISLE_SIM_QUERY_ID && self->heard.status == AISLE_PATH_OK) {
        self->optimum = (double)self->heard.duration;
    }
}

// ---- messages for later

bool aisle_sim_episode_script(aisle_sim_episode *self, double at, aisle_channel channel, const uint8_t *bytes,
                              size_t size) {
    bool may = channel == AISLE_CHANNEL_GOALS || channel == AISLE_CHANNEL_COMMAND || channel == AISLE_CHANNEL_LAYOUT ||
               channel == AISLE_CHANNEL_GRID || channel == AISLE_CHANNEL_LAYOUT_PATCH;
    return may && at >= 0.0 && at < 1e6 &&
           aisle_msg_check(aisle_channel_type(channel), bytes, size, NULL) == AISLE_OK &&
           aisle_sim_post_send(&self->script, (int64_t)(at * 1e6), channel, bytes, size);
}

// What is due changes the world and goes to the planner.
static void play_script(aisle_sim_episode *self) {
    aisle_sim_letter letter;
    int64_t since = self->now_us - self->goals_us;
    while (self->goals_us > 0 && aisle_sim_post_take(&self->script, since, &letter)) {
        self->failed = !take_bytes(self, letter.channel, letter.bytes, letter.size) || self->failed;
        if (letter.channel == AISLE_CHANNEL_GOALS) {
            aisle_sim_driver_take_goals(&self->driver, &self->goals);
            aisle_sim_judge_take_goals(&self->judge, &self->goals);
        }
        aisle_sim_host_send(self->host, self->now_us, letter.channel, letter.bytes, letter.size);
        free(letter.bytes);
    }
}

// ---- a tick

static aisle_sim_prey prey_of(const aisle_sim_episode *self) {
    const aisle_sim_chassis *c = &self->chassis;
    double v = fabs(c->v), late = NOTICE_S + self->vehicle.reaction_time;
    aisle_vec2 along;
    aisle_sincos(c->pose.theta, &along.y, &along.x);
    return (aisle_sim_prey){.at = {c->pose.x, c->pose.y},
                            .velocity = aisle_vec2_scale(along, c->v),
                            .reach = self->vehicle.outer_radius,
                            .stop_time = late + v / self->vehicle.d_max,
                            .stop_way = v * late + 0.5 * v * v / self->vehicle.d_max};
}

static bool is_on(const aisle_sim_episode *self, aisle_sim_fault_kind kind) {
    return aisle_sim_faults_active(&self->setup.faults, kind, aisle_sim_episode_seconds(self)) != NULL;
}

static void command(aisle_sim_episode *self, int8_t what) {
    aisle_command_msg msg = {.utime = self->now_us, .command_id = ++self->command_id, .command = what};
    send_now(self, AISLE_CHANNEL_COMMAND, &msg);
}

static void begin_fault(aisle_sim_episode *self, const aisle_sim_fault *f) {
    aisle_sim_chassis *c = &self->chassis;
    aisle_vec2 along;
    aisle_sincos(c->pose.theta, &along.y, &along.x);
    if (f->kind == AISLE_SIM_HOLD) {
        command(self, AISLE_COMMAND_HOLD);
    } else if (f->kind == AISLE_SIM_PUSH) {
        c->pose.x -= f->amount * along.y;
        c->pose.y += f->amount * along.x;
    } else if (f->kind == AISLE_SIM_POSE_JUMP) {
        self->localiser.off.x += f->amount;
    }
}

static void end_fault(aisle_sim_episode *self, const aisle_sim_fault *f) {
    if (f->kind == AISLE_SIM_HOLD) {
        command(self, AISLE_COMMAND_RESUME);
    } else if (f->kind == AISLE_SIM_POSE_JUMP) {
        self->localiser.off.x -= f->amount;
    }
}

static void go_wrong(aisle_sim_episode *self, double speed) {
    double now = aisle_sim_episode_seconds(self);
    for (uint32_t i = 0; i < self->setup.faults.count; i++) {
        aisle_sim_fault *f = &self->setup.faults.fault[i];
        if (!f->begun && now >= f->at) {
            f->begun = true;
            begin_fault(self, f);
        }
        if (!f->ended && now >= f->at + f->lasts) {
            f->ended = true;
            end_fault(self, f);
        }
    }
    if (speed <= AISLE_SIM_JUDGE_MOVING) {
        aisle_sim_faults_note_rest(&self->setup.faults, now);
    }
}

static void measure(aisle_sim_episode *self) {
    static aisle_obstacles_msg obstacles;
    aisle_pose_msg pose;
    double now = aisle_sim_episode_seconds(self);
    if (aisle_sim_localiser_step(&self->localiser, now, DT)) {
        double delay =
            aisle_sim_localiser_tell(&self->localiser, &self->chassis, self->now_us, self->scene.map_id, &pose);
        pose.localized = is_on(self, AISLE_SIM_UNLOCALIZED) ? 0 : 1;
        if (!is_on(self, AISLE_SIM_POSE_SILENT)) {
            post(self, AISLE_CHANNEL_POSE, &pose, delay);
        }
    }
    aisle_vec2 at = {self->chassis.pose.x, self->chassis.pose.y};
    for (int32_t i = 0; i < self->setup.num_sources; i++) {
        if (aisle_sim_source_step(&self->source[i], now)) {
            double delay = aisle_sim_source_tell(&self->source[i], &self->movers, at, self->now_us, self->scene.map_id,
                                                 &obstacles);
            if (delay >= 0.0 && !is_on(self, AISLE_SIM_OBSTACLES_SILENT)) {
                post(self, AISLE_CHANNEL_OBSTACLES, &obstacles, delay);
            }
        }
    }
}

static void deliver(aisle_sim_episode *self) {
    aisle_sim_letter letter;
    while (aisle_sim_post_take(&self->to_planner, self->now_us, &letter)) {
        aisle_sim_host_send(self->host, letter.due_us, letter.channel, letter.bytes, letter.size);
        free(letter.bytes);
    }
    aisle_sim_host_advance(self->host, self->now_us);
}

static void control(aisle_sim_episode *self) {
    aisle_sim_estimate at = aisle_sim_localiser_estimate(&self->localiser, &self->chassis);
    aisle_sim_letter letter;
    while (aisle_sim_post_take(&self->to_vehicle, self->now_us, &letter)) {
        if (!is_on(self, AISLE_SIM_PATHS_LOST) &&
            aisle_msg_decode(AISLE_MSG_PATH, letter.bytes, letter.size, &self->heard, NULL) == AISLE_OK) {
            aisle_sim_driver_take_path(&self->driver, &self->heard, &at);
        }
        free(letter.bytes);
    }
    if (self->tick % CONTROL_TICKS == 0) {
        const aisle_sim_fault *slow =
            aisle_sim_faults_active(&self->setup.faults, AISLE_SIM_SLOW, aisle_sim_episode_seconds(self));
        self->driver.share = slow != NULL ? slow->amount : 1.0;
        aisle_sim_command command = aisle_sim_driver_step(&self->driver, self->now_us, &at);
        aisle_sim_chassis_command(&self->chassis, &command);
    }
}

// Has the vehicle just come to rest where its path did not bring it?
static void count_stops(aisle_sim_episode *self, double speed) {
    const aisle_path_msg *path = &self->driver.path;
    bool moving = speed > AISLE_SIM_JUDGE_MOVING;
    if (self->was_moving && !moving && self->driver.has_path) {
        bool at_end = self->driver.piece >= (uint32_t)path->num_waypoints;
        bool at_goal = at_end && path->num_waypoints > 0 &&
                       (path->waypoints[path->num_waypoints - 1].flags & AISLE_WAYPOINT_GOAL) != 0;
        self->stops += (aisle_sim_driver_brakes(&self->driver, self->now_us) || at_end) && !at_goal ? 1 : 0;
    }
    self->was_moving = moving;
}

static void tell_truth(const aisle_sim_episode *self) {
    FILE *out = self->setup.truth;
    double now = aisle_sim_episode_seconds(self);
    if (out == NULL || self->tick % TRUTH_TICKS != 0) {
        return;
    }
    const aisle_sim_chassis *c = &self->chassis;
    (void)fprintf(out, "%.3f,0,vehicle,%.4f,%.4f,%.4f,%.3f,%.3f\n", now, c->pose.x, c->pose.y, c->pose.theta, c->v,
                  self->vehicle.outer_radius);
    for (uint32_t i = 0; i < self->movers.count; i++) {
        const aisle_sim_mover *m = &self->movers.mover[i];
        if (m->is_there) {
            (void)fprintf(out, "%.3f,%" PRId32 ",%s,%.4f,%.4f,%.4f,%.3f,%.3f\n", now, m->id,
                          aisle_sim_kind_name(m->kind), m->pose.x, m->pose.y, m->pose.theta,
                          aisle_vec2_length(m->velocity), m->reach);
        }
    }
}

static void tick(aisle_sim_episode *self) {
    self->tick++;
    self->now_us += AISLE_SIM_TICK_US;
    aisle_sim_prey prey = prey_of(self);
    aisle_sim_movers_step(&self->movers, DT, &prey);
    aisle_sim_chassis_step(&self->chassis, DT);
    double speed = aisle_sim_chassis_speed(&self->chassis, self->judge.reach);
    aisle_sim_judge_look(&self->judge, aisle_sim_episode_seconds(self), self->chassis.pose, self->chassis.v, speed,
                         &self->movers);
    count_stops(self, speed);
    go_wrong(self, speed);
    play_script(self);
    measure(self);
    deliver(self);
    control(self);
    tell_truth(self);
}

// ---- a whole drive

static bool lacks(const aisle_sim_episode *self, char *message) {
    const char *what =
        self->scene.map_revision == 0 && self->scene.count == 0 && !self->scene.has_scan &&
                !(self->scene.x_max > self->scene.x_min)
            ? "a layout"
            : (!self->has_vehicle ? "a vehicle"
                                  : (!self->has_start ? "a pose to start from" : (!self->has_goals ? "goals" : NULL)));
    if (what != NULL) {
        (void)snprintf(message, AISLE_SETTINGS_MESSAGE_LEN, "the set-up lacks %s", what);
    }
    return what != NULL;
}

static bool add_movers(aisle_sim_episode *self, char *message) {
    const aisle_sim_setup *setup = &self->setup;
    aisle_sim_prey prey = prey_of(self);
    aisle_sim_movers_start(&self->movers, &self->scene, setup->seed);
    for (uint32_t g = 0; g < setup->num_groups; g++) {
        for (uint32_t i = 0; i < setup->group[g].count; i++) {
            if (!aisle_sim_movers_add(&self->movers, setup->group[g].kind, setup->group[g].v_bound, &prey,
                                      setup->room) &&
                !setup->few_are_good) {
                (void)snprintf(message, AISLE_SETTINGS_MESSAGE_LEN, "no place for so many movers");
                return false;
            }
        }
    }
    if (setup->tracks != NULL && !aisle_sim_movers_add_tracks(&self->movers, setup->tracks)) {
        (void)snprintf(message, AISLE_SETTINGS_MESSAGE_LEN, "more than %d movers", AISLE_SIM_MOVERS_MAX);
        return false;
    }
    return true;
}

static void begin(aisle_sim_episode *self) {
    const aisle_sim_setup *setup = &self->setup;
    aisle_sim_chassis_traits traits = aisle_sim_chassis_usual(&self->vehicle);
    traits.latency = setup->latency > 0.0 ? setup->latency : traits.latency;
    traits.lag = setup->lag > 0.0 ? setup->lag : traits.lag;
    aisle_sim_chassis_start(&self->chassis, &traits, self->start, setup->seed);
    aisle_sim_driver_start(&self->driver, &self->vehicle, traits.latency + traits.lag);
    aisle_sim_driver_take_goals(&self->driver, &self->goals);
    aisle_sim_localiser_start(&self->localiser, &setup->pose, setup->seed);
    for (int32_t i = 0; i < setup->num_sources; i++) {
        aisle_sim_source_start(&self->source[i], &setup->source, i, setup->num_sources, setup->seed);
    }
    aisle_sim_judge_start(&self->judge, &self->scene, &self->vehicle_msg);
    aisle_sim_judge_take_goals(&self->judge, &self->goals);
    if (setup->truth != NULL) {
        (void)fprintf(setup->truth, "t,id,kind,x,y,theta,v,radius\n");
    }
}

static bool is_over(aisle_sim_episode *self) {
    double now = aisle_sim_episode_seconds(self), limit = self->setup.time_limit;
    if (self->judge.arrival >= 0.0 && self->script.count == 0) {
        self->arrived = self->status.state == AISLE_STATUS_IDLE;
        return self->arrived || now > self->judge.arrival + SETTLE_S;
    }
    if (self->status.state != AISLE_STATUS_IDLE || self->goals_at <= 0.0) {
        self->busy_at = now;
    }
    bool given_up = now > self->busy_at + SETTLE_S &&
                    self->script.count == 0; // the planner takes the goals for reached, the judge does not
    return given_up || now > (limit > 0.0 ? limit : LIMIT_FACTOR * self->optimum + LIMIT_EXTRA);
}

bool aisle_sim_episode_run(aisle_sim_episode *self, char *message) {
    if (lacks(self, message)) {
        return false;
    }
    begin(self);
    if (!add_movers(self, message)) {
        return false;
    }
    int64_t begin_us = self->now_us += 1000;
    while (!is_over(self) && !self->failed && !self->host->failed) {
        tick(self);
        if (self->now_us - begin_us == QUERY_US) {
            send_query(self);
        } else {
            send_goals(self, self->now_us - begin_us - GOALS_US);
        }
    }
    if (self->failed || self->host->failed) {
        (void)snprintf(message, AISLE_SETTINGS_MESSAGE_LEN, "memory, the disk or the bus gave out");
    }
    return !self->failed && !self->host->failed;
}

void aisle_sim_episode_end(aisle_sim_episode *self) {
    aisle_sim_post_free(&self->to_planner);
    aisle_sim_post_free(&self->to_vehicle);
    aisle_sim_post_free(&self->script);
    aisle_sim_scene_free(&self->scene);
}
