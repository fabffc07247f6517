// chassis.h - how the simulated vehicle really moves: commands late, drives that lag, wheels that slip. Level 5.
//
// A command acts `latency` seconds after it was given. Then, in steps of dt:
//     v'         = (v_command - v) / lag, at most a_max when gaining speed, d_max when losing it; a command of 0 is
//                  braking, with d_max until rest
//     curvature' = (curvature_command - curvature) / lag
//     spin'      = (spin_command - spin) / lag, at most alpha_max; 0 brakes likewise
// and the place follows from v (1 + slip) and theta' = |v| (curvature + steer error), or spin when turning on the spot;
// slip and steer error wander (aisle_sim_drift). Curvature is the turn of the heading for each metre moved, whichever
// way: positive turns left seen from above. Every heading is driven along or against (no sideways motion): what the
// planner gives OMNI vehicles, too.
// Memory: the struct. Time: O(1) a step. Uses the core's own sine, so runs give the same bits everywhere.
#ifndef AISLE_SIM_CHASSIS_H
#define AISLE_SIM_CHASSIS_H

#include "robot/vehicle.h"
#include "sim/noise.h"

#define AISLE_SIM_COMMANDS_MAX 64 // under way at once

typedef struct aisle_sim_command {
    bool spins;       // turn on the spot at `spin`; else drive
    double v;         // m/s, below 0 backwards
    double curvature; // 1/m
    double spin;      // rad/s
} aisle_sim_command;

typedef struct aisle_sim_chassis_traits {
    double latency;     // s, of commands
    double lag;         // s, of drives and steering
    double slip_sigma;  // 1, of the way
    double steer_sigma; // 1/m, of the curvature
    double a, d, alpha; // m/s2, m/s2, rad/s2: what the drives do at most
    double wander;      // s, time constant of both errors
} aisle_sim_chassis_traits;

// Latency 0.05 s, lag 0.08 s, slip 1 %, 0.02 / m, the vehicle's own limits.
aisle_sim_chassis_traits aisle_sim_chassis_usual(const aisle_vehicle *vehicle);

typedef struct aisle_sim_chassis {
    aisle_sim_chassis_traits traits;
    aisle_pose2 pose; // the truth
    double v;         // m/s, of the wheels, below 0 backwards
    double curvature; // 1/m
    double spin;      // rad/s
    aisle_sim_drift slip, steer;
    aisle_rng rng;
    aisle_sim_command active;
    struct {
        double at; // s, when it begins to act
        aisle_sim_command command;
    } queue[AISLE_SIM_COMMANDS_MAX];
    uint32_t head, count;
    double now; // s
} aisle_sim_chassis;

void aisle_sim_chassis_start(aisle_sim_chassis *self, const aisle_sim_chassis_traits *traits, aisle_pose2 pose,
                             uint64_t seed);

// Gives a command now. The oldest one waiting is dropped when too many wait.
void aisle_sim_chassis_command(aisle_sim_chassis *self, const aisle_sim_command *command);

// dt at most lag (s).
void aisle_sim_chassis_step(aisle_sim_chassis *self, double dt);

// Speed of the fastest body point, m/s: |v| + |turn rate| * reach.
double aisle_sim_chassis_speed(const aisle_sim_chassis *self, double reach);

// Turn rate, rad/s.
double aisle_sim_chassis_omega(const aisle_sim_chassis *self);
#endif
