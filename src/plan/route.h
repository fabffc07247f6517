// route.h - one request from start to proved path or reason: the AUTO pipeline. Level 4.
//
// Stages: CHECK start and goals exactly - per leg SEED (grid search, turning disc first, the exact body along the
// motion if that finds nothing) and TAUT - BUILD and VERIFY the seed path - per leg SWARM - BUILD and VERIFY the better
// legs - END. WHY instead, when no seed is found. The seed's proved path is ready (AISLE_PARTIAL) before the swarm
// begins; the final one is never worse by the objective's own measure, else the seed's path stays. Planner by name:
// AUTO keeps the better of both; ASTAR ends with the seed path; PSO takes the swarm's path wherever it is proved.
// PSO with objective PAPER is the paper's own method alone: CHECK, per leg its swarm (PAPER), BUILD, VERIFY, END; its
// path or a refusal (BUDGET: it found none, which proves nothing), never a seed's path.
// Attempts at a seed, until one finds a way: the turning disc, with AISLE_ROUTE_STRIDE between search cells, then with
// every cell. Then the proof of why.h is asked: no way for the disc the footprint holds, no further search. Then discs
// try every cell at its roomiest point (slits narrower than a cell), other bodies their exact footprint along the
// motion, with a stride and without. For pure length the disc starts with every cell: a narrow passage is worth more.
// Budget: work units of everything together; spent before a first proof: cause BUDGET; spent later: the first path is
// the answer. If the verifier turns the seed path down it is built again with stops in all corners; if that fails too,
// the cause is KINEMATIC (a way for the body exists, the turns it needs were not proved) or VERIFY_FAILED.
// Memory: from the arena, about 0.6 MiB and the searches' cells. Time: at most the budget plus one indivisible piece
// of each stage.
#ifndef AISLE_PLAN_ROUTE_H
#define AISLE_PLAN_ROUTE_H

#include "plan/compose.h"
#include "plan/leg.h"
#include "plan/paper_swarm.h"
#include "plan/seed.h"
#include "plan/swarm.h"
#include "plan/taut.h"
#include "plan/verify.h"
#include "plan/why.h"
#include "wire/codec.h"

#define AISLE_ROUTE_POINTS 2048U // of all legs' seed polylines
#define AISLE_ROUTE_STRIDE 0.1   // m
#define AISLE_ROUTE_BYTES 60000U // of an encoded path_t: 54 a waypoint and the head

typedef struct aisle_request { // a query, or a goal list with the pose it starts from
    bool is_query;
    int32_t query_id, goal_list_id, goal_list_revision, map_id;
    int64_t pose_utime;
    aisle_goal_msg start; // of a goal list: the pose, heading fixed
    aisle_options_msg options;
    int16_t num_goals;
    aisle_goal_msg goals[AISLE_GOAL_LIST_MAX_GOALS];
} aisle_request;

typedef struct aisle_proof { // an encoded path and what it is worth
    uint8_t *bytes;          // [AISLE_ROUTE_BYTES]
    size_t size;
    aisle_stamp stamp;
    double value; // by the objective, less is better
    bool ready;
} aisle_proof;

typedef enum aisle_route_stage {
    AISLE_ROUTE_IDLE,
    AISLE_ROUTE_CHECK,
    AISLE_ROUTE_SEED,
    AISLE_ROUTE_TAUT,
    AISLE_ROUTE_BUILD,
    AISLE_ROUTE_VERIFY,
    AISLE_ROUTE_SWARM,
    AISLE_ROUTE_PAPER,
    AISLE_ROUTE_WHY,
    AISLE_ROUTE_END
} aisle_route_stage;

typedef struct aisle_route {
    const aisle_layout *layout;
    const aisle_vehicle *vehicle;
    aisle_request request;
    aisle_objective objective;
    aisle_space space;
    aisle_seed seed;
    aisle_taut taut;
    aisle_swarm swarm;
    aisle_paper_swarm paper;
    aisle_compose compose;
    aisle_verify verify;
    aisle_why why;
    aisle_vec2 *points; // [AISLE_ROUTE_POINTS]
    uint32_t point_count;
    aisle_leg *legs;           // [AISLE_GOAL_LIST_MAX_GOALS]
    uint32_t leg;              // under way
    aisle_path_msg *path;      // being composed
    aisle_path_msg *decoded;   // the verifier's
    aisle_proof first, better; // the answer is better if ready, else first if ready
    aisle_proof *trial;        // where the path being verified goes
    aisle_route_stage stage;
    bool stops;                          // build with a stop in every corner
    bool announced;                      // AISLE_PARTIAL was told
    uint32_t spent, budget, proof_units; // work units; what the first build and proof took
    uint32_t budget_default;
    int64_t swarm_evals, nodes, verify_failed, intervals; // counters of this request
    aisle_collide_count collide;
    aisle_refusal cause; // with no path
    aisle_vec2 place;    // where the cause is, if has_place
    bool has_place;
} aisle_route;

void aisle_route_carve(aisle_route *self, aisle_arena *arena, const aisle_limits *limits);

// Begins. `head` holds the ids and times of the answer (boot_id, revisions, t0_utime, ...); its waypoints are not read.
// path_revision of the first path is head's, of the improved one the next.
void aisle_route_start(aisle_route *self, const aisle_layout *layout, const aisle_vehicle *vehicle,
                       const aisle_request *request, const aisle_path_msg *head);

// Spends about `units`. AISLE_BUSY; AISLE_PARTIAL: `first` has just become ready, a better one may follow (told once);
// AISLE_OK: ended: aisle_route_answer() or cause.
aisle_status aisle_route_step(aisle_route *self, uint32_t units);

// The proved path, NULL if there is none.
const aisle_proof *aisle_route_answer(const aisle_route *self);
#endif
