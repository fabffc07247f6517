// movers.h - obstacles that walk: how they move, what they tell of themselves, and that they keep to it. Level 5.
//
//     constant     constant velocity, turned back by what stands still
//     jumps        the random jumps of the second paper (PAPERS 2): every turn a way within (-1, 1) m in x and in y,
//                  walked at an even speed in the time in which the longest one takes v_bound. Ours, not the paper's: no
//                  mover leaves one place and appears at another, for then it would have no bound
//     agv          a rectangle on a straight lane, to and fro, with a rest at the ends
//     person       to a goal of its own and on to the next, at its own pace, with rests
//     adversarial  a ghost that heads for the vehicle at v_bound, through walls if they are in its way: for its place, for
//                  the place ahead where both meet, to lie in wait and dash when it comes near, or to turn away and back.
//                  A while after it has met the vehicle it goes to hide, beside its way as likely as not, and begins anew
//     track        a recorded way (tracks.h). One that would appear so near that no vehicle could mind it any more stays
//                  away until it is farther off: within its reach while the vehicle notices and stops
//
// No mover ever exceeds its v_bound, and none appears out of nothing, but tracks where their recording begins.
// Rectangles keep their heading.
// Memory: the struct. Time: a step O(movers * solids of the scene).
#ifndef AISLE_SIM_MOVERS_H
#define AISLE_SIM_MOVERS_H

#include "aisle/messages.h"
#include "sim/noise.h"
#include "sim/scene.h"
#include "sim/tracks.h"

#define AISLE_SIM_MOVERS_MAX 1024 // tracks that are not there count, too; a source tells of 256 at most

typedef enum aisle_sim_kind {
    AISLE_SIM_CONSTANT,
    AISLE_SIM_JUMPS,
    AISLE_SIM_AGV,
    AISLE_SIM_PERSON,
    AISLE_SIM_ADVERSARIAL,
    AISLE_SIM_TRACK,
    AISLE_SIM_KIND_COUNT
} aisle_sim_kind;

// "constant" and so on; AISLE_SIM_KIND_COUNT: none of that name.
aisle_sim_kind aisle_sim_kind_of(const char *name);
const char *aisle_sim_kind_name(aisle_sim_kind kind);

typedef enum aisle_sim_tactic { // of an adversary
    AISLE_SIM_CHASE,
    AISLE_SIM_INTERCEPT,
    AISLE_SIM_AMBUSH,
    AISLE_SIM_FEINT,
    AISLE_SIM_TACTIC_COUNT
} aisle_sim_tactic;

typedef struct aisle_sim_mover {
    aisle_sim_kind kind;
    int32_t id;
    int8_t told_kind; // AISLE_OBSTACLE_*
    aisle_sim_outline body;
    double reach;        // m, of the body from its origin
    aisle_pose2 pose;    // the truth
    aisle_vec2 velocity; // m/s
    double v_bound;      // m/s, kept always
    float told_v_bound;  // as told: the same, or 0 where the kind says so
    double speed;        // m/s, of its own choice, <= v_bound
    aisle_vec2 from, to; // lane, jump or way to the goal
    double until;        // s, of the world: rests or walks until then
    aisle_sim_tactic tactic;
    bool is_set_off, has_met, hides; // an adversary: the vehicle is near enough; it has met it; it walks to `to`
    double trigger, away_until;      // m from the vehicle where it sets off; s
    uint32_t track;                  // index in tracks
    bool is_there;                   // tracks come and go
} aisle_sim_mover;

typedef struct aisle_sim_prey { // what movers can see of the vehicle
    aisle_vec2 at, velocity;    // m, m/s
    double reach;               // m
    double stop_time, stop_way; // s, m until it could stand if it had to
} aisle_sim_prey;

typedef struct aisle_sim_movers {
    const aisle_sim_scene *scene;
    const aisle_sim_tracks *tracks; // may be NULL
    aisle_rng rng;
    double now; // s
    uint32_t count;
    int32_t next_id;
    aisle_sim_mover mover[AISLE_SIM_MOVERS_MAX];
} aisle_sim_movers;

void aisle_sim_movers_start(aisle_sim_movers *self, const aisle_sim_scene *scene, uint64_t seed);

// Adds one that keeps `room` m from the vehicle at first. v_bound 0: the kind's own (constant, jumps, agv,
// adversarial 2.0 or less, drawn; person 1.6). False: no place found in 1000 draws, or too many.
bool aisle_sim_movers_add(aisle_sim_movers *self, aisle_sim_kind kind, double v_bound, const aisle_sim_prey *prey,
                          double room);

// One at a place, for tests and scenes of one's own: constant velocity, a disc.
aisle_sim_mover *aisle_sim_movers_place(aisle_sim_movers *self, aisle_vec2 at, aisle_vec2 velocity, double radius);

// Adds every recorded way.
bool aisle_sim_movers_add_tracks(aisle_sim_movers *self, const aisle_sim_tracks *tracks);

void aisle_sim_movers_step(aisle_sim_movers *self, double dt, const aisle_sim_prey *prey);
#endif
