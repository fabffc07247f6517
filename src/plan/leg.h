// leg.h - one leg of a request: the way from one stop to the next goal, as planned so far. Level 4.
#ifndef AISLE_PLAN_LEG_H
#define AISLE_PLAN_LEG_H

#include "aisle/messages.h"
#include "base/vec.h"
#include "plan/swarm.h"

typedef struct aisle_leg {
    uint32_t first, count; // of its seed polyline in the route's points
    uint32_t via_count;    // points of the swarm's best, start and goal included; 0 = none
    bool use_swarm;        // build from the swarm's best, else from the seed
    aisle_space_mode mode; // the body the seed was found with
    double tangent_radius; // m, the seed is the shortest way of such a disc (tangent.h), its corners arcs; 0: not
    bool is_slit;          // the grid saw no way: the seed is the shortest one
    bool is_clear;         // of obstacles by the creep clearance: no swarm makes it safer
    double bound;          // m, no way of this leg is shorter
    uint32_t attempt;      // at its seed
    uint32_t piece_first;  // of the manoeuvre that stands for its polyline, in the route's pieces
    uint32_t piece_count;  // waypoints of it, where the leg begins included; 0: there is none
    bool searched;         // for a manoeuvre
    bool is_eased;         // and for one that keeps clear where that is cheaper
    bool is_sampled;       // a sampling planner found the way
    bool is_bred;          // the genetic search did
    bool heading_is_free;  // where the leg begins
    double heading;        // rad, there, else
    double seed_value, swarm_value; // measured cost of either way of building it; negative = not measured
    aisle_vec2 via[AISLE_SWARM_VIAS + 2U];
} aisle_leg;
#endif
