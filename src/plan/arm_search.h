// arm_search.h - how each joint must bend for an arm to get by: a search over the free coefficients of a piece. Level 4.
//
// Variables: b0 and b1 of each joint (arm_motion.h). Costs are pairs, feasibility first:
//     violation  the mean over AISLE_ARM_SAMPLES configurations of how deep links are where they may not be (m) and joints out of
//                their limits (rad); where none of them is, what the proof of the whole motion says; 0: it is proved free
//     value      by objective: SHORTEST the joint angle travelled (rad, Simpson's rule, the paper's F1); SAFEST that times
//                1 + risk_weight * mean of max(1 - gap / AISLE_ARM_CREEP, 0); FASTEST the least duration (s); LEAST_ENERGY the
//                motors' work at the least duration, the integral of |torque * rate| (J)
// GA (algo/ga.h) with a population of 24, PSO (algo/pso.h) with 24 particles: tries of 25 generations, one, or up to eight if asked for
// by name, until a motion is free and 200 more candidates have brought no better one. The first try starts at the motion without a
// bend, so what comes out is never worse; later ones look everywhere.
// PAPER is the paper's own search (Machmudah et al. 2012): 20 points, 100 generations, selection 0.5, mutation
// 0.3, its coefficients a6 and a7 in [-100, 100], value as SHORTEST, and the death penalty: whoever collides is not allowed at
// all, and until one that does not was seen each population is drawn anew. The proof of the whole motion is ours there, too.
// Memory: the caller's arena, a few KiB. Time: AISLE_ARM_SAMPLES configurations a candidate, and of one that is free there those
// of the proof.
#ifndef AISLE_PLAN_ARM_SEARCH_H
#define AISLE_PLAN_ARM_SEARCH_H

#include "algo/ga.h"
#include "algo/pso.h"
#include "plan/arm_free.h"

#define AISLE_ARM_SAMPLES 24U
#define AISLE_ARM_CREEP 0.05 // m, gaps below it are risk
#define AISLE_ARM_GENES (2U * AISLE_ARM_LINKS)
#define AISLE_ARM_POPULATION 24U

typedef struct aisle_arm_search {
    aisle_ga ga;
    aisle_pso pso;
    aisle_pso_config pso_config;
    float *pso_work;
    float lo[AISLE_ARM_GENES], hi[AISLE_ARM_GENES], guess[AISLE_ARM_GENES];
    const aisle_arm_world *world;
    aisle_arm_dynamics dynamics;
    double from[AISLE_ARM_LINKS], to[AISLE_ARM_LINKS];
    int8_t objective;
    double risk_weight;
    bool swarm;     // PSO, else GA
    bool paper;     // the paper's own
    uint32_t tries; // left
    uint64_t seed;  // of the next one
    uint32_t units; // of the step under way
    uint32_t evals; // candidates looked at since start
    uint32_t first; // of them, that was proved free; 0: none yet
} aisle_arm_search;

// self NULL: to measure only.
void aisle_arm_search_carve(aisle_arm_search *self, aisle_arena *arena);

// Begins; world stays as it is until the end. objective: AISLE_OPTIONS_SAFEST to PAPER; planner: AISLE_OPTIONS_PSO or any other,
// which is GA. risk_weight 0: 1.
void aisle_arm_search_start(aisle_arm_search *self, const aisle_arm_world *world, const double *from, const double *to,
                            const aisle_options_msg *options);

// Looks at candidates until about `units` are spent, adds them to *spent. AISLE_BUSY; AISLE_OK: done, and there is a motion that
// is proved free; AISLE_PARTIAL: done without.
aisle_status aisle_arm_search_step(aisle_arm_search *self, uint32_t units, uint32_t *spent);

// The best motion so far; false: none is proved free yet.
bool aisle_arm_search_best(const aisle_arm_search *self, aisle_arm_piece *out);

// The value, and the whole cost, of a motion by this search's objective.
aisle_cost_pair aisle_arm_search_cost(aisle_arm_search *self, const aisle_arm_piece *piece);
#endif
