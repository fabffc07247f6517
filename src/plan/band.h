// band.h - where a vehicle can still be moving, and until when, if it may be told to brake at any time of a lease. Level 4.
//
// The vehicle drives on along a path (aisle_band_motion). Told to brake at tau in [0, lease] it goes on for reaction_time
// and then brakes along the path with d_max (turns on the spot: alpha_max) until it rests. One braking motion begins at
// each place b that it passes at t(b) in [reaction_time, lease + reaction_time]; it rests v(b)^2 / (2 d) further on, at
// t(b) + v(b) / d. Of all motions that pass a place q the one that begins to brake first is there last: the one that rests at
// q, for a later one has left it by then, and an earlier one does not get there. Before the first rest it is the first motion.
// So with a disc that grows, one time for each place is all that has to be looked at.
// The square of the speed is linear in the way between the knots of the path, and so is the place of rest in b: each
// place's b is found without search. A path never brakes harder than d_max, so no motion rests beyond where the path does;
// between two rests (a run: driven, or a turn) places are `spacing` apart, the last one where the last motion rests.
//
// Memory: the caller's struct. Time: O(places + pieces of the path within).
#ifndef AISLE_PLAN_BAND_H
#define AISLE_PLAN_BAND_H

#include "robot/motion.h"
#include "robot/vehicle.h"

#define AISLE_BAND_MAX 320U

typedef struct aisle_band_place {
    aisle_pose2 pose;
    double until;  // s from now, when it may be moving there last
    double travel; // m, at most, of any point of the body since the place before; 0 where a run begins
} aisle_band_place;

typedef struct aisle_band {
    aisle_band_place at[AISLE_BAND_MAX];
    uint32_t n;     // 0: it does not move within the lease
    bool overflow;  // there are more places: nothing is known
    double peak;    // m/s, greatest speed on the way
    double widest;  // m, greatest travel
    aisle_aabb box; // of the origins
} aisle_band;

// How it drives on from a place: as the path says, but no faster than cap nor than a_max allows from v; a speed v above
// either is braked down with d_max. A turn that is at a rate omega above the path's goes on from that, as fast as it can.
typedef struct aisle_band_motion {
    const aisle_vehicle *vehicle;
    const aisle_waypoint_msg *w; // [n] with speeds and times
    uint32_t n;
    const float *dwell; // [n] or NULL
    aisle_place at;
    double v, cap;  // m/s
    double omega;   // rad/s, of a turn on the spot that it is in; 0: as the path says
    double rested;  // s, that it has been at rest where it is, of the rest before the piece it is to begin (u = 0)
    double lease;   // s
    double late;    // s >= 0, that it may be behind its times; at most until the last one has braked
    double spacing; // m, of places
} aisle_band_motion;

// A part of the way over which the square of the speed (m/s; rad/s in a turn) is linear.
typedef struct aisle_band_part {
    double x0, x1; // m or rad, from where the run begins
    double q0, q1; // squares of the speed
    double t0, t1; // s from now
} aisle_band_part;

// Walks along the motion part by part; turns and rests are passed. For band.c and who simulates.
typedef struct aisle_band_walk {
    aisle_band_motion motion;
    uint32_t piece; // in hand
    aisle_motion_leg leg;
    uint32_t phase;
    double way;         // behind, of the phase; of a wait its share
    double natural;     // s the phases of the piece take by themselves
    double x, t;        // m or rad of the run, s
    double from_square; // of the speed where the run begins
    bool stands;        // it has braked to a cap of 0
} aisle_band_walk;

// Begins at motion->at; false: it does not move on from there (the path's end).
bool aisle_band_walk_begin(aisle_band_walk *self, const aisle_band_motion *motion);

// The next part of the run; false: the run has ended.
bool aisle_band_walk_next(aisle_band_walk *self, aisle_band_part *part);

// The next run; false: the path has ended, or it stands.
bool aisle_band_walk_run(aisle_band_walk *self);

// When it is at x of a part, and where it is at t.
double aisle_band_part_time(const aisle_band_part *part, double x);
double aisle_band_part_at(const aisle_band_part *part, double t);

// Square of its speed at x of a part; and what place x of the part last got is.
double aisle_band_part_square(const aisle_band_part *part, double x);
aisle_place aisle_band_walk_place(const aisle_band_walk *self, const aisle_band_part *part, double x);

// Fills the band.
void aisle_band_make(aisle_band *self, const aisle_band_motion *motion);

// A disc that grows: its radius is reach + bound * t at t s from now.
typedef struct aisle_band_disc {
    aisle_vec2 centre;
    double reach, bound; // m, m/s, >= 0
} aisle_band_disc;

// Is the footprint, grown by `growth` (m), off the disc at every place of the band and between, `lag` s later than until?
// If not, *where is a place it may not be (index). *looked: places measured, added to. O(n) at most; mostly O(1).
bool aisle_band_is_clear(const aisle_band *self, const aisle_vehicle *vehicle, const aisle_band_disc *disc,
                         double growth, double lag, uint32_t *where, uint32_t *looked);
#endif
