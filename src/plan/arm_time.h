// arm_time.h - how long a motion of the arm takes, by the paper's second search. Level 4.
//
// Machmudah et al. 2012: a genetic algorithm over T in [0, 100] s, 20 points, 1000 generations, selection 0.5, mutation 0.3, for the least T
// in which every joint's velocity, acceleration, jerk and torque holds its limits at places along the piece; a T in which one does not
// is not allowed at all. A mutation moves T by ga.h's steps of many sizes (drawn anew from the whole box the search ends up to 3 % above
// the least one). Planners ask it with objective PAPER alone: arm_motion.h has the least T exactly, for a thousandth of the
// work. Of 200 drawn pieces of drawn arms it ends within 2.5e-4 of that one (tests/plan/test_arm_time.c holds 1e-3).
// Memory: the caller's arena, 10 KiB. Time: start O(places), a candidate O(places) at most, 19,020 of them.
#ifndef AISLE_PLAN_ARM_TIME_H
#define AISLE_PLAN_ARM_TIME_H

#include "algo/ga.h"
#include "robot/arm_motion.h"

#define AISLE_ARM_TIME_MOST 100.0  // s
#define AISLE_ARM_TIME_PLACES 129U // along a piece, ends included
#define AISLE_ARM_TIME_UNITS 10U   // work units of some candidates: about a microsecond

typedef struct aisle_arm_time_place {    // shares of limits when run in a second
    double velocity, acceleration, jerk; // the worst joint's
    double inertia[AISLE_ARM_LINKS], gravity[AISLE_ARM_LINKS];
} aisle_arm_time_place;

typedef struct aisle_arm_time {
    aisle_ga ga;
    aisle_arm_time_place *place; // [AISLE_ARM_TIME_PLACES]
    uint32_t links;
    float lo, hi;
} aisle_arm_time;

// Ours as it stands in the paper, but for cost, box, genes and seed: 20 points, each gene of them drawn anew with probability 0.3, the
// better half breeds.
#define AISLE_ARM_TIME_POPULATION 20U
aisle_ga_config aisle_arm_paper_ga(uint32_t generations);

// self NULL: to measure only.
void aisle_arm_time_carve(aisle_arm_time *self, aisle_arena *arena);

// Begins; nothing of what is given is needed later on.
void aisle_arm_time_start(aisle_arm_time *self, const aisle_arm *arm, const aisle_arm_dynamics *dynamics,
                          const aisle_arm_piece *piece, uint64_t seed);

// Looks at candidates until about `units` are spent, adds them to *spent. AISLE_BUSY; AISLE_OK: done, *duration is the least found;
// AISLE_PARTIAL: done, none was allowed, *duration is as it was.
aisle_status aisle_arm_time_step(aisle_arm_time *self, uint32_t units, uint32_t *spent, double *duration);
#endif
