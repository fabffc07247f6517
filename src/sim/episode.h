// episode.h - one simulated drive from set-up to arrival, contact or the end of its time. Level 5.
//
// Ties the parts together: true world (scene, movers, chassis), what is measured of it (sensors), messages under way
// (post), the planner (host), the vehicle's controller (driver) and the judge. Everything is drawn from one seed.
//
// Time runs in ticks of AISLE_SIM_TICK_US from the host's epoch. In each the world moves, the judge looks, sensors
// measure, what has arrived is handed to the planner at its own time of arrival, paths that have arrived to the vehicle,
// which commands its drives every other tick. Set-up messages come first, 1 ms apart, then a query for the way without
// movers (its duration is the yardstick), then the goals when the sensors have spoken.
//
// The epoch and all draws are fixed, so with a core host the same set-up and seed give the same bytes everywhere.
// Memory: the struct (about 1 MB) and what its parts take; aisle_sim_episode_end() frees it.
#ifndef AISLE_SIM_EPISODE_H
#define AISLE_SIM_EPISODE_H

#include "sim/driver.h"
#include "sim/faults.h"
#include "sim/host.h"
#include "sim/judge.h"
#include "sim/post.h"
#include "sim/sensors.h"

#define AISLE_SIM_TICK_US 5000
#define AISLE_SIM_GROUPS_MAX 8
#define AISLE_SIM_CAUSES_MAX 16
#define AISLE_SIM_QUERY_ID 1

typedef struct aisle_sim_group {
    aisle_sim_kind kind;
    uint32_t count;
    double v_bound; // m/s; 0: the kind's own
} aisle_sim_group;

typedef struct aisle_sim_setup {
    uint64_t seed;
    double time_limit; // s; 0: ten times the way without movers, and a minute
    double room;       // m between movers and vehicle at first
    aisle_sim_group group[AISLE_SIM_GROUPS_MAX];
    uint32_t num_groups;
    bool few_are_good;              // movers that find no place are left out; else that is an error
    const aisle_sim_tracks *tracks; // may be NULL
    int32_t num_sources;            // 1..4 share the movers; 0: none tells of them
    aisle_sim_source_traits source;
    aisle_sim_pose_traits pose;
    aisle_sim_delay path_delay; // s, from planner to vehicle
    double latency, lag;        // s, of the chassis; 0: as usual
    aisle_sim_faults faults;    // what goes wrong; what came of them is in the episode's copy
    FILE *truth;                // CSV of where everything truly was, 10 rows a second each; may be NULL
} aisle_sim_setup;

// One source as usual, no movers, 2 m of room, paths 10 to 20 ms under way.
aisle_sim_setup aisle_sim_setup_usual(uint64_t seed);

typedef struct aisle_sim_cause {
    int8_t status;
    int16_t cause;
    int64_t paths;
} aisle_sim_cause;

typedef struct aisle_sim_episode {
    aisle_sim_setup setup;
    aisle_sim_host *host;
    aisle_sim_scene scene;
    aisle_sim_movers movers;
    aisle_sim_chassis chassis;
    aisle_sim_driver driver;
    aisle_sim_localiser localiser;
    aisle_sim_source source[AISLE_OBSTACLES_MAX_SOURCES];
    aisle_sim_judge judge;
    aisle_sim_post to_planner, to_vehicle;
    aisle_sim_post script; // due in us from the goals on
    aisle_rng rng;         // of delays
    aisle_vehicle_msg vehicle_msg;
    aisle_vehicle vehicle;
    bool has_vehicle, has_start, has_goals;
    aisle_pose2 start;
    aisle_goal_list_msg goals;
    int64_t now_us, goals_us, tick; // goals_us: when they were sent; 0: not yet
    double goals_at;                // s, when the goals were sent
    aisle_status_msg status;        // the last heartbeat
    aisle_path_msg heard;           // scratch
    double optimum;                 // s, the way without movers; 0: not known
    int64_t revisions, renewals, last_revision;
    int8_t last_status;
    aisle_sim_cause cause[AISLE_SIM_CAUSES_MAX]; // new paths by status and cause
    uint32_t num_causes;
    int64_t stops; // rests that the path driven first did not have: braked, or at the end of a partial path
    bool was_moving;
    double busy_at;     // s, when the planner last had something to do
    bool arrived;       // all goals visited and the planner says so
    int32_t command_id; // of the last command sent
    bool failed;        // no memory
} aisle_sim_episode;

// host: started, its `heard` aisle_sim_episode_hear() and its ctx this episode.
void aisle_sim_episode_start(aisle_sim_episode *self, const aisle_sim_setup *setup, aisle_sim_host *host);
void aisle_sim_episode_hear(void *episode, aisle_channel channel, int64_t utime, const uint8_t *bytes, size_t size);

// One message of the set-up: layouts, tiles, patches and vehicles are sent on; of a pose the place is where the drive
// begins; goals are sent when it does; anything else is left out. False: not a message, or no memory.
bool aisle_sim_episode_prepare(aisle_sim_episode *self, aisle_channel channel, const uint8_t *bytes, size_t size);

// One message for later, `at` seconds after the goals: another goal list, a command, a patch or layout, which change the
// order, the vehicle's knowledge of it and the hall, too. False: not such a message, or no memory.
bool aisle_sim_episode_script(aisle_sim_episode *self, double at, aisle_channel channel, const uint8_t *bytes,
                              size_t size);

// Does the planner say that it holds the layout and the vehicle? (Buses lose messages; send again what is not held.)
bool aisle_sim_episode_is_held(const aisle_sim_episode *self);

// Forgets the set-up, to prepare again, and lets `seconds` pass.
void aisle_sim_episode_wait(aisle_sim_episode *self, double seconds);
void aisle_sim_episode_forget(aisle_sim_episode *self);

// Runs to the end. False: message[AISLE_SETTINGS_MESSAGE_LEN] says what the set-up lacks.
bool aisle_sim_episode_run(aisle_sim_episode *self, char *message);

// Seconds of its own time so far.
double aisle_sim_episode_seconds(const aisle_sim_episode *self);

void aisle_sim_episode_end(aisle_sim_episode *self);
#endif
