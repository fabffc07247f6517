// energy.h - what each piece of a path takes from the battery, from its waypoints. Level: public.
//
// path_t tells the sum alone; this splits it by piece and by cause, for the same vehicle and goals. With m, c, eff, P the
// vehicle's mass, rolling resistance, drive efficiency and idle power, L, v0, v1 a piece's length and the speeds of its
// waypoints, t the time between them:
//     rolling       m g c L / eff
//     acceleration  m (v1^2 - v0^2) / 2 / eff where positive; from rest to rest m p^2 / 2 / eff, with p the peak of the
//                   trapezoid with a_max and d_max that takes the time (dwell taken off)
//     turning       m g c * outer radius of the footprint * |turn| / eff, of a turn on the spot
//     idle          P t, dwell included
// Braking gives nothing back. g = 9.80665 m/s2. The sum is the path's `energy` but for rounding: below 1e-3 of it
// (the peak of a piece from rest to rest is told by its time alone).
#ifndef AISLE_ENERGY_H
#define AISLE_ENERGY_H

#include "aisle/messages.h"
#include "aisle/status.h"

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct aisle_energy { // J
    float rolling, acceleration, turning, idle;
} aisle_energy;

// each[path->num_waypoints] (may be NULL): of the piece that ends at waypoint i; of waypoint 0 nothing. *sum: of all.
// goals[num_goals] in the order reached, for their dwell; NULL: none. O(waypoints).
// AISLE_ERR_ARG, nothing written: NULL, no waypoint or too many, a number in them that is not finite or out of range, times
// that fall. AISLE_ERR_DATA: the vehicle is refused.
aisle_status aisle_path_energy(const aisle_path_msg *path, const aisle_vehicle_msg *vehicle,
                               const aisle_goal_msg *goals, uint32_t num_goals, aisle_energy *each, aisle_energy *sum);

#ifdef __cplusplus
}
#endif
#endif
