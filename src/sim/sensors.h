// sensors.h - what the vehicle and the hall's eyes tell: late, noisy, now and then nothing. Level 5.
//
// Pose: the vehicle's localiser. Its estimate is the truth and an error that wanders and a white one, new with each fix;
// between fixes dead reckoning carries both along. The vehicle's own controller uses the same estimate (sim/driver.h).
// Obstacles: each source tells at its rate what it sees: the true place and velocity with white errors, of which it
// tells the deviations. Errors never exceed AISLE_SIM_SIGMAS deviations (noise.h), so what the planner takes for certain
// is. A snapshot may be lost as a whole.
// Memory: the structs. Time: O(movers) a snapshot.
#ifndef AISLE_SIM_SENSORS_H
#define AISLE_SIM_SENSORS_H

#include "sim/driver.h"
#include "sim/movers.h"

typedef struct aisle_sim_delay { // s; each message draws its own
    double least, most;
} aisle_sim_delay;

typedef struct aisle_sim_pose_traits {
    double period;                  // s
    aisle_sim_delay delay;          // from measurement to arrival at the planner
    double wander_xy, wander_theta; // m, rad; deviations of the error that wanders
    double white_xy, white_theta;   // of that of each fix
    double speed;                   // m/s, of the speed told
} aisle_sim_pose_traits;

typedef struct aisle_sim_source_traits {
    double period; // s
    aisle_sim_delay delay;
    double sigma, sigma_v; // m, m/s
    double lost;           // share of the snapshots
    double range;          // m from the vehicle; 0 = sees all
} aisle_sim_source_traits;

aisle_sim_pose_traits aisle_sim_pose_usual(void);     // 20 Hz, 10 to 40 ms, 1 cm and 3 mm, 3 and 1 mrad
aisle_sim_source_traits aisle_sim_source_usual(void); // 15 Hz, 30 to 80 ms, 3 cm, 0.1 m/s, 2 % lost, sees all

typedef struct aisle_sim_localiser {
    aisle_sim_pose_traits traits;
    aisle_rng rng;
    aisle_sim_drift x, y, theta;
    aisle_vec2 white, off;    // off: a fault, 0 else
    double white_theta, next; // rad; s
    int32_t seq;
} aisle_sim_localiser;

void aisle_sim_localiser_start(aisle_sim_localiser *self, const aisle_sim_pose_traits *traits, uint64_t seed);

// Lets the errors wander; true: a fix is due at `now` (s).
bool aisle_sim_localiser_step(aisle_sim_localiser *self, double now, double dt);

aisle_sim_estimate aisle_sim_localiser_estimate(const aisle_sim_localiser *self, const aisle_sim_chassis *truth);

// The message of a fix, and how long it takes to arrive, s.
double aisle_sim_localiser_tell(aisle_sim_localiser *self, const aisle_sim_chassis *truth, int64_t utime,
                                int32_t map_id, aisle_pose_msg *out);

typedef struct aisle_sim_source {
    aisle_sim_source_traits traits;
    aisle_rng rng;
    int32_t number; // 0..3
    int32_t of;     // sources share the movers: this one sees every `of`-th from `number` on
    int32_t seq;
    double next; // s
} aisle_sim_source;

void aisle_sim_source_start(aisle_sim_source *self, const aisle_sim_source_traits *traits, int32_t number, int32_t of,
                            uint64_t seed);

// True: a snapshot is due at `now` (s).
bool aisle_sim_source_step(aisle_sim_source *self, double now);

// The message, and how long it takes to arrive, s; below 0: it is lost.
double aisle_sim_source_tell(aisle_sim_source *self, const aisle_sim_movers *movers, aisle_vec2 vehicle, int64_t utime,
                             int32_t map_id, aisle_obstacles_msg *out);
#endif
