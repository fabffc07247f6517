// vehicle.h - the vehicle's body and limits, checked and with every default filled in. Level 3.
//
// Units: m, s, rad, kg, W.
// Memory: the caller's struct, nothing else. Time: O(vertices). Objects share nothing.
#ifndef AISLE_ROBOT_VEHICLE_H
#define AISLE_ROBOT_VEHICLE_H

#include "aisle/messages.h"
#include "aisle/status.h"
#include "base/vec.h"
#include "world/layout.h" // aisle_refusal
#include "world/shape.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define AISLE_VEHICLE_SPEED_MAX 20.0  // m/s, forwards and backwards
#define AISLE_VEHICLE_RADIUS_MAX 20.0 // m, of the outer radius
#define AISLE_VEHICLE_VALUE_MAX 1e6   // of every other number, in its unit

typedef struct aisle_vehicle {
    int32_t revision;
    int8_t drive;                                   // AISLE_VEHICLE_DIFFERENTIAL, TRICYCLE or OMNI
    aisle_vec2 footprint[AISLE_SHAPE_VERTICES_MAX]; // vehicle frame, counter-clockwise; a disc is the one point (0, 0)
    uint32_t n;                                     // 1 or 3..16
    double radius;                                  // rounds the footprint, >= 0; of a disc > 0
    double
        inner_radius; // of the largest disc about the origin inside the rounded footprint; 0 if the origin is outside
    double outer_radius; // of the least disc about the origin around it
    double v_max, v_reverse_max, a_max, d_max, omega_max, alpha_max, lateral_a_max; // all > 0
    double curvature_max;                                                           // 1/m; 0 = turns on the spot
    double reaction_time, margin, creep_clearance, creep_speed, pose_timeout,
        obstacles_timeout;                                         // margin >= 0, else > 0
    double mass, rolling_resistance, idle_power, drive_efficiency; // all > 0
} aisle_vehicle;

// Takes a vehicle_t. A value of 0 means its default:
//
//     footprint        1.00 x 0.70 m about the origin (if no vertices and no radius)
//     v_max            1.5 m/s       v_reverse_max    0.3 m/s, or v_max if that is less
//     a_max, d_max     0.5 m/s2      omega_max        1.0 rad/s      alpha_max  1.0 rad/s2   lateral_a_max 0.5 m/s2
//     reaction_time    0.3 s         margin           0.10 m (negative: none)
//     creep_clearance  0.5 m         creep_speed      0.3 m/s
//     pose_timeout     0.2 s         obstacles_timeout 0.3 s
//     mass             500 kg        rolling_resistance 0.015        idle_power 50 W         drive_efficiency 0.8
//
// footprint_radius 0 and curvature_max 0 mean 0. Vertices 0 with a radius: a disc about the origin. A creep_speed above
// v_max is lowered to v_max. A member given its default's value (as float) and one left 0 give the same bits. The arm
// (num_links and what follows) is not looked at.
//
// AISLE_ERR_DATA, *out unchanged: *why has cause MALFORMED, the place of the first member at fault in vehicle_t as its
// id (utime is 0, footprint 4, drive_efficiency 23) and the value found. At fault is a number that is not finite,
// negative (but margin) or too large (above the limits at the top; drive_efficiency above 1); a drive unknown; a count
// of vertices not 0 or 3..16; a footprint that is not valid (aisle_convex_is_valid), value then the index of the first
// vertex that is not finite or out of range, -1 if it is the outline (not convex, clockwise, no area). An outer radius
// above its limit is the fault of footprint, or of footprint_radius if the vertices alone stay below; value is the
// outer radius.
aisle_status aisle_vehicle_from_msg(const aisle_vehicle_msg *msg, aisle_vehicle *out, aisle_refusal *why);

// The footprint placed at pose: writes its n points to out[AISLE_SHAPE_VERTICES_MAX] and returns a view on them with
// radius `radius` + grow; grow >= -radius (m). For |theta| <= AISLE_ANGLE_MAX a coordinate's error is at most 4e-15 *
// (|x| + |y| + outer_radius) m. The view lives as long as out. O(n).
aisle_convex aisle_vehicle_place(const aisle_vehicle *self, aisle_pose2 pose, double grow, aisle_vec2 *out);

// What a vehicle is but for its revision, as bytes: equal for equal bodies and limits, whatever padding holds. Writes at
// most AISLE_VEHICLE_CONTENT_BYTES and returns how many. O(n).
#define AISLE_VEHICLE_CONTENT_BYTES sizeof(aisle_vehicle)
size_t aisle_vehicle_content(const aisle_vehicle *self, uint8_t *out);

// True if every heading covers the same ground (a disc about the origin).
bool aisle_vehicle_is_disc(const aisle_vehicle *self);
#endif
