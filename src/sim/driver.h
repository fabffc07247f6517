// driver.h - the simulated vehicle's own controller: follows the newest valid path by place. Level 5.
//
// What it knows: the path_t it was sent, its own estimate of place and speeds, its limits, its clock, the goals' dwells.
// Nothing of the true world, and nothing of the planner's insides: it reads waypoint_t as the message type says.
//
//     path OK, PARTIAL   drive by place: the speeds its waypoints have, steering towards it
//     path STOP          brake along these points
//     path NONE          brake at once, along what was driven last
//     lease run out      the same, until it is renewed
//
// It stays on a goal for its dwell, counted by its own clock from when it stood there, whatever paths come meanwhile; one that
// begins on the goal is left when that time is over.
// Braking means a speed command of 0, which the drives meet with d_max. Of two paths of one boot the one of the higher
// revision is newer; the same revision again renews its lease.
// Speed: the lesser of the path's at the place and a look ahead of latency and lag; from rest to rest the trapezoid that
// fills the time told. Steering: curvature ahead plus feedback of the lateral and heading error, critically damped
// (gains n^2 and 2 n per metre with n = AISLE_SIM_DRIVER_GAIN; Samson 1992, "Path following and time-varying feedback
// stabilization of a wheeled mobile robot", ICARCV, linearised on the path).
// Memory: the struct (the path, about 80 kB). Time: O(1) a step, O(waypoints) for a new path.
#ifndef AISLE_SIM_DRIVER_H
#define AISLE_SIM_DRIVER_H

#include "aisle/messages.h"
#include "robot/vehicle.h"
#include "sim/chassis.h"

#define AISLE_SIM_DRIVER_GAIN 1.5     // 1/m
#define AISLE_SIM_DRIVER_REACHED 4e-3 // m, rad: so near a rest it counts as there
#define AISLE_SIM_DRIVER_CRAWL 0.03   // m/s, rad/s: the least speed until then

typedef struct aisle_sim_estimate { // what the vehicle believes of itself
    aisle_pose2 pose;
    double v, omega; // m/s (below 0 backwards), rad/s
} aisle_sim_estimate;

typedef struct aisle_sim_driver {
    const aisle_vehicle *vehicle;
    double share; // of the speeds told that it drives, 1 but for a fault
    double ahead; // s, latency and lag of the drives, as their maker says
    aisle_path_msg path;
    bool has_path;
    bool revoked; // by NONE or STOP: brakes
    int64_t valid_until_us, rest_until_us;
    uint32_t piece; // index of the waypoint ahead; num_waypoints: at the end
    double done;    // m or rad of the piece that are behind
    double heading; // rad, of the last estimate, to count turns
    bool arriving;  // at a rest, waiting for the wheels to stand
    bool is_fresh;  // the path was taken since the last step
    bool dwells;    // it has stood on the goal of this id since then
    int32_t dwells_on;
    int64_t dwells_since_us;
    double lateral; // m, error at the last step, left of the path
    aisle_goal_msg goals[AISLE_GOAL_LIST_MAX_GOALS];
    int16_t num_goals;
    int64_t adopted, renewed, ignored; // paths
    int64_t lapses;                    // of a lease, while it moved: it braked until it heard more
    bool has_lapsed;
} aisle_sim_driver;

// vehicle: as long as the driver.
void aisle_sim_driver_start(aisle_sim_driver *self, const aisle_vehicle *vehicle, double ahead);

// The order the vehicle carries out: it knows how long to stay at each goal.
void aisle_sim_driver_take_goals(aisle_sim_driver *self, const aisle_goal_list_msg *list);

void aisle_sim_driver_take_path(aisle_sim_driver *self, const aisle_path_msg *path, const aisle_sim_estimate *at);

// What to do now.
aisle_sim_command aisle_sim_driver_step(aisle_sim_driver *self, int64_t now_us, const aisle_sim_estimate *at);

// Does it brake for want of a path or lease?
bool aisle_sim_driver_brakes(const aisle_sim_driver *self, int64_t now_us);
#endif
