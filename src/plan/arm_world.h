// arm_world.h - where an arm on a vehicle at rest may be: the search's own test of contact. Level 4.
//
// Obstacles: the layout's (polygons of kind OBSTACLE and KEEPOUT, scanned cells, the outside of the bounds) as far as the arm
// reaches, gathered once; the vehicle's own body; and of three links the first for the last. Neighbouring links may overlap, as
// joints do: their limits keep them apart. The body is the footprint without margin. The first link may lie on it as far as
// AISLE_ARM_MOUNT says: its part within
//     (depth of the base inside the body) + 2 * its radius
// of the base is exempt; the rest of it, and every other link, keeps off the body. So a base on the rim leaves the first link
// 60 degrees to either side of straight out; one that stands out of the body by the link's radius may fold along it.
// The vehicle's margin is not kept by links: what the arm is to keep off obstacles belongs to link_radius.
// Motions: arm_free.h. Shares no code with the proof of what leaves (verify_arm.h).
// Memory: the caller's arena, 128 bytes an obstacle. Time: begin O(zones and scan rows in reach); a gap O(obstacles near a
// link). Units: AISLE_ARM_UNITS a configuration looked at.
#ifndef AISLE_PLAN_ARM_WORLD_H
#define AISLE_PLAN_ARM_WORLD_H

#include "robot/arm_motion.h"
#include "robot/vehicle.h"
#include "world/layout.h"

#define AISLE_ARM_ID_BODY (-3) // "obstacle id" of the vehicle's own body; -1 the scan, -2 the bounds
#define AISLE_ARM_ID_ARM (-4)  // and of the arm's own first link
#define AISLE_ARM_KEEP 1e-3    // m, that every motion keeps off everything
#define AISLE_ARM_BLOCKS 1024U // obstacles in reach
#define AISLE_ARM_UNITS 10U    // work units, of a configuration looked at: less than a microsecond

typedef struct aisle_arm_block {
    aisle_convex shape; // its vertices are own or the layout's
    aisle_vec2 own[4];
    aisle_aabb box;
    int32_t id;
    bool plain; // arm_gap.h
} aisle_arm_block;

typedef struct aisle_arm_world {
    const aisle_arm *arm;
    aisle_pose2 base; // map frame
    aisle_arm_block *block;
    uint32_t count, capacity;
    aisle_aabb bounds;
    aisle_vec2 outline[AISLE_SHAPE_VERTICES_MAX];
    aisle_convex body;
    aisle_aabb body_box;
    bool body_plain;
    double exempt; // m, of the first link from the base on
} aisle_arm_world;

// self NULL: to measure only.
void aisle_arm_world_carve(aisle_arm_world *self, aisle_arena *arena, uint32_t blocks);

// How far from the base the first link may lie on the body. O(vertices).
double aisle_arm_mount(const aisle_arm *arm, const aisle_vehicle *vehicle);

// Gathers what is in reach; arm, vehicle and layout stay as they are until the next begin(). AISLE_ERR_CAPACITY: more than fits.
aisle_status aisle_arm_world_begin(aisle_arm_world *self, const aisle_layout *layout, const aisle_vehicle *vehicle,
                                   const aisle_arm *arm, aisle_pose2 pose);

// Gap (m) of each link to what it may not touch, at most cap, 0 in contact: gaps[links] (may be NULL). Returns the least,
// *id (may be NULL) whose it is, 0 if none is within cap.
double aisle_arm_world_gap(const aisle_arm_world *self, const double *q, double cap, double *gaps, int32_t *id);

// How deep links are where they may not be, keep included, m: over links and obstacles the sum of what is missing to keep, and
// where a link's axis crosses an obstacle of that and the axis' length inside it. 0: the configuration is free. Grows
// steadily with the depth, so that searches find their way out.
double aisle_arm_world_depth(const aisle_arm_world *self, const double *q);

#define AISLE_ARM_SIGHT 0.3 // m, gaps are told up to

// How fast the arm moves about a configuration, as its parameter runs: no point of link i gets farther than slope[i] * h + bend[i]
// * h^2 within h of it; [AISLE_ARM_LINKS]: no point of the last of three links, seen from the first one.
typedef struct aisle_arm_pace {
    double slope[AISLE_ARM_LINKS + 1U], bend[AISLE_ARM_LINKS + 1U];
} aisle_arm_pace;

// Is q free, by keep, and how far may the motion through it run? *h, in: as far as is asked for; out: lowered to where half of keep
// is left at least, to either side. False: q keeps less than keep.
bool aisle_arm_world_room(const aisle_arm_world *self, const double *q, const aisle_arm_pace *pace, double *h);
#endif
