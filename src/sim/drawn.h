// drawn.h - drives drawn from a seed: a hall, a vehicle, goals and movers, to run by the thousand. Level 5.
//
// Halls of 14 to 24 m: open ones with some boxes, clutter of convex polygons, rack aisles, rooms with doors. Vehicles:
// discs, AGVs that turn on the spot, forklifts with their origin at the rear axle, tricycles that cannot turn on the
// spot; speeds of 0.6 to 2 m/s, braking 0.4 to 2 m/s2; drives that are as late as their reaction time allows. One to three goals, some with a heading or a dwell. Every stop has
// room for the turning body. What is drawn is a function of seed and kind alone.
// Memory: the struct. Time: below a millisecond.
#ifndef AISLE_SIM_DRAWN_H
#define AISLE_SIM_DRAWN_H

#include "sim/episode.h"

#define AISLE_SIM_DRAWN_POLYGONS 64

typedef struct aisle_sim_drawn {
    aisle_layout_msg layout;
    aisle_vehicle_msg vehicle;
    aisle_pose_msg start;
    aisle_goal_list_msg goals;
    aisle_sim_setup setup; // movers of the kind and sensors
} aisle_sim_drawn;

// kind: of all movers; AISLE_SIM_KIND_COUNT: of all kinds but tracks. num_movers 0: 2 to 8.
void aisle_sim_draw(aisle_sim_drawn *self, uint64_t seed, aisle_sim_kind kind, uint32_t num_movers);

// Adds one to four faults, drawn from its seed, too.
void aisle_sim_draw_faults(aisle_sim_drawn *self);

// Prepares an episode that has been started. False: no memory.
bool aisle_sim_drawn_prepare(const aisle_sim_drawn *self, aisle_sim_episode *episode);
#endif
