// arm_join.h - pieces through via-points instead of a stop at each. Level 4.
//
// A path of straight pieces rests at every via-point. A bent piece (arm_motion.h) has two free numbers a joint, so it
// can run through one via-point or two: at r with s(r) = the share of the way behind it, s the smooth step of the piece
// without a bend,
//     b0 + b1 (r - 1/2) = (via - from - (to - from) s(r)) / (r^3 (1 - r)^3),
// b1 = 0 for one. Each such piece from a via-point to the next but one, or to the one after it, takes the place of the
// straight ones if it is proved free, is faster, and by the objective costs more by at most AISLE_ARM_JOIN_SLACK of
// what they cost. Of all ways to cover the path so the one of the least duration is taken (dynamic programming over
// via-points), unless it needs more waypoints than a message holds.
// Memory: the caller's arena, 3 KiB. Time: two candidates a via-point at most, each a search's candidate and a least
// duration.
#ifndef AISLE_PLAN_ARM_JOIN_H
#define AISLE_PLAN_ARM_JOIN_H

#include "plan/arm_compose.h"
#include "plan/arm_search.h"

#define AISLE_ARM_JOIN_SPAN 3U    // straight pieces that one bent one takes the place of, at most
#define AISLE_ARM_JOIN_SLACK 0.05 // of the objective's value

typedef struct aisle_arm_join {
    const aisle_arm_world *world;
    const aisle_arm_dynamics *dynamics;
    aisle_arm_search *search;
    aisle_arm_plan *plan;
    double (*point)[AISLE_ARM_LINKS]; // [AISLE_ARM_PIECES + 1] of the straight path
    double *value;                    // [AISLE_ARM_PIECES] of straight pieces, by the objective
    double *least;                    // [AISLE_ARM_PIECES + 1] duration from the start to there, s
    uint8_t *span;                    // [AISLE_ARM_PIECES + 1] straight pieces that the last one to there covers
    uint32_t count;                   // straight pieces
    uint32_t at, from;                // candidate under way: to this point, covering so many
} aisle_arm_join;

// self NULL: to measure only.
void aisle_arm_join_carve(aisle_arm_join *self, aisle_arena *arena);

// Begins with the plan's straight pieces, their durations known. search says what the objective is
// (aisle_arm_search_start()); all stays until the end. Adds to *spent what straight pieces take to value.
void aisle_arm_join_start(aisle_arm_join *self, const aisle_arm_world *world, const aisle_arm_dynamics *dynamics,
                          aisle_arm_search *search, aisle_arm_plan *plan, uint32_t *spent);

// Looks at candidates until about `units` are spent, adds them to *spent. AISLE_BUSY; AISLE_OK: done, the plan is what
// it is to be, its durations known.
aisle_status aisle_arm_join_step(aisle_arm_join *self, uint32_t units, uint32_t *spent);
#endif
