// vehicle.h - the vehicle's body and limits, checked and with every default filled in. Level 3.
//
// Units: m, s, rad, kg, W. Memory: the caller's struct. Time: O(vertices).
#ifndef AISLE_ROBOT_VEHICLE_H
#define AISLE_ROBOT_VEHICLE_H

#include "aisle/messages.h"
#include "aisle/status.h"
#include "base/vec.h"
#include "world/layout.h" // aisle_refusal
#include "world/shape.h"

typedef struct aisle_vehicle {
    int32_t revision;
    int8_t drive; // AISLE_VEHICLE_DIFFERENTIAL, ...
    aisle_vec2 footprint[AISLE_SHAPE_VERTICES_MAX]; // vehicle frame, counter-clockwise; a disc is the one point (0, 0)
    uint32_t n;                                     // 1 or 3..16
    double radius;                                  // rounds the footprint
    double inner_radius; // of the largest disc about the origin inside the rounded footprint; 0 if the origin is outside
    double outer_radius; // of the least disc about the origin around it
    double v_max, v_reverse_max, a_max, d_max, omega_max, alpha_max, lateral_a_max;
    double curvature_max; // 1/m; 0 = turns on the spot
    double reaction_time, margin, creep_clearance, creep_speed, pose_timeout, obstacles_timeout;
    double mass, rolling_resistance, idle_power, drive_efficiency;
} aisle_vehicle;

// Defaults for zeros: footprint 1.00 x 0.70 m about the origin (if no vertices and no radius); v 1.5, reverse 0.3 m/s; a = d =
// 0.5 m/s2; omega 1.0 rad/s, alpha 1.0 rad/s2; lateral 0.5 m/s2; reaction 0.3 s; margin 0.10 m (negative: none = 0);
// creep below 0.5 m clearance at 0.3 m/s; pose timeout 0.2 s, obstacles 0.3 s; mass 500 kg; rolling resistance 0.015;
// idle 50 W; efficiency 0.8.
// AISLE_ERR_DATA: *why (MALFORMED with id = index of the member counted as in vehicle_t, or the vertex) if the footprint is
// not valid (aisle_convex_is_valid), anything is negative (but margin), v_max > 20, outer radius > 20 m, efficiency > 1,
// creep_speed > v_max is clamped to v_max, num_links != 0 is accepted and ignored for driving. *out unchanged then.
aisle_status aisle_vehicle_from_msg(const aisle_vehicle_msg *msg, aisle_vehicle *out, aisle_refusal *why);

// The footprint placed at pose: writes its points to out[AISLE_SHAPE_VERTICES_MAX] and returns a view on them with radius
// `radius` + grow.
aisle_convex aisle_vehicle_place(const aisle_vehicle *self, aisle_pose2 pose, double grow, aisle_vec2 *out);

// True if every heading covers the same ground (a disc about the origin).
bool aisle_vehicle_is_disc(const aisle_vehicle *self);
#endif
