// pace_predict.h - how long driving on along a way will take, if movers go on as they do: slow down, wait or go round? Level 4.
//
// Drives on in steps of AISLE_PREDICT_STEP, at each with the fastest level of pace.h that is passively safe then, faster than
// the last one by one at most; at rest it stays there if the slowest is not. Movers go on at constant velocity; at each
// step they are taken as measured anew, AISLE_PREDICT_AGE old, so that their reach is no
// larger than the vehicle would find it. A prediction, for comparing ways with one another, not for safety: so waiting
// for a mover and going round it are measured alike, each on its own way.
//
// Memory: carved, one path's waypoints; the struct, 16 KiB. Time: sliced; a step is at most AISLE_PACE_LEVELS times O(pieces
// and places of a band + movers); at most AISLE_PREDICT_STEPS. Units as in pace.h. Objects share nothing.
#ifndef AISLE_PLAN_PACE_PREDICT_H
#define AISLE_PLAN_PACE_PREDICT_H

#include "plan/pace.h"

#define AISLE_PREDICT_STEP 0.2   // s
#define AISLE_PREDICT_AGE 0.1    // s
#define AISLE_PREDICT_STAND 60.0 // s in which it does not make AISLE_PREDICT_GAIN, after which it is given up
#define AISLE_PREDICT_GAIN 0.3   // m, or rad of turns
#define AISLE_PREDICT_STEPS 2000U

typedef struct aisle_pace_predict_request {
    const aisle_layout *layout; // for zones; NULL: none
    const aisle_vehicle *vehicle;
    const aisle_movers *movers;
    const aisle_waypoint_msg *w; // [n] the way; its speeds and times are not used but in turns
    uint32_t n;
    const float *dwell; // [n] s of rest at each; NULL: none
    aisle_place at;     // the vehicle's
    double v;           // m/s >= 0
    uint32_t until;     // the waypoint it is to get to, not before `at`; rest there does not count
    int64_t now_us;
    double late;  // as in pace.h
    double lease; // s > 0, that its speeds are to be safe for: the shortest one that is used; it lets pass most
} aisle_pace_predict_request;

typedef struct aisle_pace_predict {
    aisle_pace_predict_request request;
    double seconds; // from now; see below
    double waited;  // of them at rest for movers
    double slowest; // m/s, the least cap that was asked for on the way; INFINITY: no mover mattered

    // Its own.
    aisle_waypoint_msg *w; // [AISLE_PATH_MAX_WAYPOINTS] from `at` on
    float *dwell;          // likewise
    uint32_t n, until, steps, level;
    aisle_place at;
    double v, rested;     // m/s; s of the rest before the next piece that are over
    double stood, gained; // s without AISLE_PREDICT_GAIN; what it made in them
    bool movers_move;
    aisle_status outcome;
    aisle_band band;
} aisle_pace_predict;

// self NULL: only measures.
void aisle_pace_predict_carve(aisle_pace_predict *self, aisle_arena *arena);

// Begins. What the request points to stays put until the end. O(n).
void aisle_pace_predict_start(aisle_pace_predict *self, const aisle_pace_predict_request *request);

// Spends about `units`; adds to *spent. AISLE_BUSY, then, for ever:
// AISLE_OK       it gets there after `seconds`
// AISLE_PARTIAL  it stands, or nearly, for AISLE_PREDICT_STAND s before it does; `seconds` is when it has. Behind AISLE_PREDICT_STEPS steps the
//                rest of the way is counted as if there were no movers
// AISLE_ERR_CAPACITY  the way from here on has no room in a path, or lasts longer than a path may
aisle_status aisle_pace_predict_step(aisle_pace_predict *self, uint32_t units, uint32_t *spent);
#endif
