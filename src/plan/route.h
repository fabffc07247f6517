// route.h - one request from start to proved path or reason: the AUTO pipeline. Level 4.
//
// RECALL an answer to the same question (cache.h), give it this request's head and REPROVE it: the answer, flag `cached`
// set. Spoiled or disproved it is forgotten and the request planned anew. Every answer to a query is remembered.
// REPAIR, where none is but one that an obstacle stands on by now (cache.h): of each leg the free pieces before and
// behind what is blocked are kept, between them the shortest way of the turning disc is searched, with the creep
// clearance to spare where that is possible (but for SHORTEST), or, for a tree by name, a tree of its kind grows; BUILD,
// VERIFY; taken if it is worth as much as cache.h says, else all is planned anew. AUTO and ASTAR (no car's paths, no
// disc's SHORTEST ones, planned with less work), and trees of places (not PAPER's); no paths with reversals; a quarter of
// the budget at most.
// CHECK start and goals exactly (NEAREST where a stop is occupied: how far to move); ORDER the goals if they may come
// in any (those behind the ones kept): by the lengths of the exact ways of the disc inside the footprint (tour.h),
// whatever the objective, with half of the budget at most; what is the best by then is flagged by cause BUDGET beside
// the path. A goal that no way leads to comes first and is refused like that of a first leg. Then one way after the
// other, as route_ways.c lists them for the objective; the best proved path by the objective's own measure is the
// answer:
//     SHORTEST   length                            SHORT
//     SAFEST     risk, to 1e-4, then length        SHORT, CLEAR; long bodies also the two GRID ways below
//     FASTEST    duration                          SHORT, CLEAR, GRID for duration, GRID for energy
//     LEAST_ENERGY  energy                         the same ones
// A way: per leg TANGENT (tangent.h; the first way's search also gives the bound), where the body cannot follow what that
// finds MANOEUVRE (manoeuvre.h, first way alone: it serves every objective), led by the tightest way found and, if that
// fails, by the widest one; where that is not the way's kind or finds none SEED (seed.h) and TAUT; BUILD, VERIFY; per leg
// SWARM where it may gain something, BUILD, VERIFY. A later way that fails is given up; an answer is told early
// (AISLE_PARTIAL, once) when what follows takes long.
// Planner by name: ASTAR leaves the swarm out; PSO is the objective's GRID way alone and takes the swarm's path wherever
// it is proved; PSO with objective PAPER is the paper's own swarm (PAPER) alone, its path or a refusal (BUDGET: it found
// none, which proves nothing).
// RRT, RRT_ADAPTIVE, RRT_STAR, RRT_STAR_ADAPTIVE: per leg SAMPLE (rrt.h) in place of all searches, then TAUT where heading
// does not matter, else the moves shortened; objective PAPER: the paper's plain form. With half of the budget for all legs'
// trees; a star that this ends before its samples is flagged by cause BUDGET beside the path. No way: WHY, for a proof, else
// BUDGET. AUTO asks RRT_ADAPTIVE in the place of a KINEMATIC or BUDGET refusal by WHY: where nothing else found a way and none
// was proved away.
// PRM: the same with a roadmap (roadmap.h), asked for each leg, by A*; its edges are tested when a search comes to
// them. It begins with AISLE_ROUTE_ROADMAP_FIRST uniform draws, or options.num_samples, in blocks, and where it does not
// join a leg's ends doubles them, up to what fits, the later ones moved off what they touch. A query's stays
// (roadmap_keep.h): the next one only asks, after a repair where patches have changed the layout. A goal list works on a
// copy and leaves nothing. Objective PAPER: the paper's form, of AISLE_ROUTE_ROADMAP_PLAIN draws or
// options.num_samples, all edges tested first, Dijkstra's search, and no more draws where it fails.
// GA is the exact way for SHORTEST, else the objective's GRID way alone; each leg's seed is bred (barrier.h), pulled taut and
// built in its place; disproved, all is planned again without. With objective PAPER it is the paper's own form alone, in
// place of all searches: its path or a refusal as of a sampling planner.
// PSO_LOCAL is the local swarm's way alone (local.h), with movers if aisle_route_go_round() gave some; its failure proves
// nothing (BLOCKED_BY the mover nearest to where it got to, else BUDGET).
// Zones (zones.h): tangent ways must obey DIRECTED ones, else the leg is the grid's; PENALTY zones add what they cost to
// every measure (SAFEST: as risk), and a GRID way of the objective's own to SHORT and CLEAR. Where zones are directed and
// no way was found, ONE_WAY asks for a proof that they shut every way (one_way.h): NO_PATH, and if a way was found that
// only disobeys, the zone it is first against.
// No way at all: WHY, and OPENING after it if that is certain (opening.h). The tangent search's proof for the disc inside
// the footprint goes straight there; the grid is a second opinion: where it sees a doubt the dear attempts are made all
// the same.
// Attempts at a seed, until one finds a way: the turning disc, with AISLE_ROUTE_STRIDE between search cells, then with
// every cell. In the first way the proof of why.h is asked then: no way for the disc the footprint holds, no further
// search. Then discs try every cell at its roomiest point (in later ways: their shortest way is the seed), other bodies
// their exact footprint along the motion, with a stride and without. For pure length the disc starts with every cell.
// Budget: work units of everything together; spent before a first proof: cause BUDGET, or the cause if one is certain
// by then; spent later: the best so far is the answer. If the verifier turns a long body's tight ways down they are
// planned again for the disc in which it turns; if it turns the seed path down it is built again with stops in all
// corners; if that fails too, the cause is KINEMATIC (a way for the body exists, the turns it needs were
// not proved) or VERIFY_FAILED.
// Memory: from the arena, about 0.6 MiB, one bit a cell and the searches' memory, at least 0.4 MiB. Time: at most the
// budget plus one indivisible piece of each stage.
#ifndef AISLE_PLAN_ROUTE_H
#define AISLE_PLAN_ROUTE_H

#include "algo/rrt.h"
#include "plan/barrier.h"
#include "plan/cache.h"
#include "plan/compose.h"
#include "plan/leg.h"
#include "plan/local.h"
#include "plan/manoeuvre.h"
#include "plan/nearest.h"
#include "plan/one_way.h"
#include "plan/opening.h"
#include "plan/paper_swarm.h"
#include "plan/roadmap_keep.h"
#include "plan/seed.h"
#include "plan/swarm.h"
#include "plan/tangent.h"
#include "plan/taut.h"
#include "plan/tour.h"
#include "plan/vehicle_space.h"
#include "plan/verify.h"
#include "plan/why.h"
#include "wire/codec.h"

#define AISLE_ROUTE_POINTS 2048U        // of all legs' seed polylines
#define AISLE_ROUTE_PIECES 768U         // waypoints of all legs' manoeuvres
#define AISLE_ROUTE_SAMPLE_NODES 32768U // of a tree, at most,
#define AISLE_ROUTE_SAMPLE_CELLS 64U    // and of the planning grid by which they are counted
#define AISLE_ROUTE_SAMPLE_DIM 3U
#define AISLE_ROUTE_ROADMAP_DRAWS 3584U // of a roadmap, at most, counted by cells likewise
#define AISLE_ROUTE_ROADMAP_FIRST 448U
#define AISLE_ROUTE_ROADMAP_PLAIN 1000U
#define AISLE_ROUTE_ROADMAP_BLOCK 28U  // draws of its first block
#define AISLE_ROUTE_ROUND_UNITS 60000U // work units of a way round; who finds none by then waits
#define AISLE_ROUTE_NONE UINT32_MAX
#define AISLE_ROUTE_CREEP_SPARE 2e-3 // m, what is told of a clearance may be lower than the truth by less
#define AISLE_ROUTE_STRIDE 0.1       // m
#define AISLE_ROUTE_TOLD_MAX ((uint32_t)AISLE_RELEASE_TOLD_MAX) // waypoints of a refusal
#define AISLE_ROUTE_BYTES AISLE_CACHE_PATH_MAX                  // of an encoded path_t: 54 a waypoint and the head

typedef struct aisle_request { // a query, or a goal list with the pose it starts from
    bool is_query;
    int32_t query_id, goal_list_id, goal_list_revision, map_id;
    int64_t pose_utime;
    aisle_goal_msg start; // of a goal list: the pose, heading fixed
    aisle_options_msg options;
    int8_t ordering; // AISLE_GOAL_LIST_*
    int16_t num_goals;
    aisle_goal_msg goals[AISLE_GOAL_LIST_MAX_GOALS];
    int16_t kept;    // of goals in any order: the first so many keep their place
    uint32_t serial; // of the mission, which knows by it what is out of date
    bool is_arm;     // an arm's goal instead: of all the others only pose_utime counts
    aisle_arm_goal_msg arm_goal;
    aisle_pose2 arm_pose; // of the vehicle, when that was submitted
    int16_t arm_cause;    // why it cannot be planned from there; 0: it can
    int32_t arm_cause_id;
} aisle_request;

typedef struct aisle_proof { // an encoded path and what it is worth
    uint8_t *bytes;          // [AISLE_ROUTE_BYTES]
    size_t size;
    aisle_stamp stamp;
    aisle_proof_basis basis;
    double value; // by the request's objective, less is better
    bool ready;
    bool told; // announced before the end
} aisle_proof;

// A way to plan a request; an objective may try several and keep the best by its own measure (route_ways.c).
typedef enum aisle_way_kind {
    AISLE_WAY_SHORT,   // exactly, by the tangent search, at the margin
    AISLE_WAY_CLEAR,   // the same at the creep clearance, where that is possible; else as GRID
    AISLE_WAY_GRID,    // by the grid's search
    AISLE_WAY_PAPER,   // by the paper's own swarm
    AISLE_WAY_REPAIR,  // of the free pieces of a remembered answer
    AISLE_WAY_LOCAL,   // by the local swarm
    AISLE_WAY_SAMPLE,  // by the sampling planner that is named
    AISLE_WAY_GA_PAPER // by the genetic paper's own form
} aisle_way_kind;

typedef struct aisle_way {
    aisle_way_kind kind;
    int8_t objective; // whose density the grid, the taut string and the swarm go by
} aisle_way;

typedef enum aisle_route_stage {
    AISLE_ROUTE_IDLE,
    AISLE_ROUTE_RECALL,
    AISLE_ROUTE_REPROVE, // what was recalled
    AISLE_ROUTE_REPAIR,  // a remembered answer that is blocked by now
    AISLE_ROUTE_CHECK,
    AISLE_ROUTE_ORDER,
    AISLE_ROUTE_TANGENT,
    AISLE_ROUTE_MANOEUVRE,
    AISLE_ROUTE_NEAREST,
    AISLE_ROUTE_SEED,
    AISLE_ROUTE_TAUT,
    AISLE_ROUTE_BUILD,
    AISLE_ROUTE_VERIFY,
    AISLE_ROUTE_SWARM,
    AISLE_ROUTE_PAPER,
    AISLE_ROUTE_LOCAL,
    AISLE_ROUTE_SAMPLE,
    AISLE_ROUTE_GA,
    AISLE_ROUTE_ONE_WAY, // do zones shut every way?
    AISLE_ROUTE_WHY,
    AISLE_ROUTE_NEXT, // the way under way is done with
    AISLE_ROUTE_DROP, // or leads nowhere
    AISLE_ROUTE_OPENING,
    AISLE_ROUTE_SIDES, // the same by the tangent search, for a gap too little too narrow for the grid
    AISLE_ROUTE_END
} aisle_route_stage;

typedef struct aisle_route_guide { // a way that is none for the body as it is; it leads the search for a manoeuvre
    aisle_vec2 *points;            // [AISLE_SEED_POINTS_MAX]
    uint32_t count;                // 0: there is none
    double radius;                 // m, its corners'
    double reach;                  // m, the disc's that it is a way for, with what it keeps
} aisle_route_guide;

typedef enum aisle_route_repair_phase {
    AISLE_ROUTE_REPAIR_LOOK,
    AISLE_ROUTE_REPAIR_SEARCH,
    AISLE_ROUTE_REPAIR_TREE // in its place
} aisle_route_repair_phase;

typedef struct aisle_route_repair { // of the answer in `decoded`
    aisle_route_repair_phase phase;
    double worth, bound;         // of it
    double radius;               // m, of the disc whose way is searched
    uint32_t at;                 // waypoint: the piece that ends there is looked at next
    uint32_t leg_start, leg_end; // waypoints, of the leg under way
    uint32_t first, last;        // of the piece of it that is planned anew; last 0: none is blocked
    uint32_t tries;              // of its search
    bool is_done;                // it is the answer
} aisle_route_repair;

typedef enum aisle_route_sample_phase {
    AISLE_ROUTE_SAMPLE_TREE,   // grows
    AISLE_ROUTE_SAMPLE_MAP,    // a roadmap is built, or repaired, or grows
    AISLE_ROUTE_SAMPLE_ASK,    // and asked
    AISLE_ROUTE_SAMPLE_PULL,   // places on its path that are seen from earlier ones are left out
    AISLE_ROUTE_SAMPLE_SHORTEN // the same of moves
} aisle_route_sample_phase;

typedef struct aisle_route_sample { // a leg's search by sampling
    aisle_rrt tree;
    aisle_vehicle_space configurations;
    aisle_route_sample_phase phase;
    uint32_t *path;          // [capacity of the tree + 1] nodes
    aisle_roadmap_keep copy; // a goal list's, for its legs
    aisle_roadmap_search ask;
    double start[AISLE_CSPACE_DIM_MAX], goal[AISLE_CSPACE_DIM_MAX]; // of the leg
    double *way;             // [(capacity of the roadmap + 2) * dim] configurations
    uint32_t path_count, at; // of the path or the way
    uint32_t limit;          // of the request's units, that this leg's search ends at
    bool is_spare; // tried because nothing else found a way: the reason for that is told if this finds none, too
} aisle_route_sample;

typedef struct aisle_route {
    const aisle_layout *layout;
    const aisle_vehicle *vehicle;
    aisle_request request;                           // its goals in the order planned
    aisle_goal_msg asked[AISLE_GOAL_LIST_MAX_GOALS]; // and as they came
    const aisle_way *way;                            // under way
    uint32_t way_index;
    aisle_objective objective; // of the way
    double room;               // m, that its tangent searches keep to obstacles
    aisle_cache cache;
    uint32_t recalled; // entry of it; AISLE_CACHE_NONE: planned anew
    bool forgetful;    // the cache is not asked
    aisle_route_repair repair;
    aisle_space space;
    aisle_tangent tangent;
    uint32_t tangent_search; // which one, see route_tangent.c
    uint32_t tangent_units;  // spent there
    aisle_manoeuvre manoeuvre;
    aisle_route_guide guide[2]; // of the leg under way: the tightest way and the widest one found
    bool other_guide;           // the second one leads
    aisle_waypoint_msg *pieces; // [AISLE_ROUTE_PIECES]
    uint32_t piece_count;
    aisle_tour tour;
    aisle_seed seed;
    aisle_taut taut;
    aisle_swarm swarm;
    aisle_paper_swarm paper;
    aisle_local local;
    aisle_route_sample sample;
    aisle_roadmap_keep keep;
    aisle_barrier barrier;
    uint32_t breed_limit;       // of the request's units, that this leg's genetic search ends at
    const aisle_movers *movers; // to go round, or NULL; the vehicle is at the start
    int64_t movers_us;          // then,
    bool in_motion;             // and does not stop there
    aisle_vec2 bend;            // from where on the leg's way may bend
    bool local_is_there;        // nothing to search: the leg begins at its goal
    aisle_compose compose;
    aisle_verify verify;
    aisle_verify_known *known; // of the path under way, for pieces of goal lists' plans; NULL: not kept
    aisle_one_way one_way;
    bool is_one_way_asked;  // for the leg under way
    uint32_t opposed_zones; // DIRECTED ones that a way of the leg is against which is none for that alone
    aisle_opposed opposed;  // the first of them
    aisle_why why;
    aisle_nearest nearest;
    aisle_opening opening;
    aisle_vec2 *points; // [AISLE_ROUTE_POINTS]
    uint32_t point_count;
    aisle_leg *legs;         // [AISLE_GOAL_LIST_MAX_GOALS]
    uint32_t leg;            // under way
    aisle_path_msg *path;    // being composed
    aisle_path_msg *decoded; // the verifier's
    aisle_proof best;        // of the ways so far
    aisle_proof spare;       // what is tried against it
    int32_t revision;        // of the first path told
    aisle_route_stage stage;
    bool stops;                          // build with a stop in every corner
    uint32_t side;                       // of the gap, left out under way
    bool no_way;                         // proved for the leg under way, exactly, by the tangent search
    bool is_wide;                        // tight ways (route_tangent.c) failed
    bool is_unbred;                      // what the genetic search made of the seeds failed: they are the ways
    bool announced;                      // AISLE_PARTIAL was told
    bool is_cut;                         // the order is not what it would be without a limit of work
    uint32_t spent, budget, proof_units; // work units; what the first build and proof took
    uint32_t budget_default;
    int64_t swarm_evals, nodes, verify_failed, intervals; // counters of this request
    aisle_collide_count collide;
    aisle_refusal cause; // with no path; while running: what will be told if the budget ends here, if not 0
    aisle_waypoint_msg told[AISLE_ROUTE_TOLD_MAX]; // a refusal's places, as path_t tells them
    uint32_t told_count;
    uint32_t named; // a refusal's goal, by index in request.goals; AISLE_ROUTE_NONE: it names none
} aisle_route;

// `self` may be NULL, to measure only: then no pointer is kept, and no struct of this size is needed.
void aisle_route_carve(aisle_route *self, aisle_arena *arena, const aisle_limits *limits);
// The same, and at least `bytes` (a multiple of AISLE_ARENA_ALIGN) of what the searches take are lent to who works only while
// no request is under way and needs nothing of it afterwards: *lent is an arena that begins there. lent NULL: nobody.
void aisle_route_carve_lending(aisle_route *self, aisle_arena *arena, const aisle_limits *limits, size_t bytes,
                               aisle_arena *lent);
void aisle_route_carve_cache(aisle_route *self, aisle_arena *arena, const aisle_limits *limits);
void aisle_route_carve_roadmap(aisle_route *self, aisle_arena *arena, const aisle_limits *limits);

// Begins. `head` holds the ids and times of the answer (boot_id, revisions, t0_utime, ...); its waypoints are not read.
// path_revision of the first path told is head's, of the improved one the next.
void aisle_route_start(aisle_route *self, const aisle_layout *layout, const aisle_vehicle *vehicle,
                       const aisle_request *request, const aisle_path_msg *head);

// After start(): the way is to be the local swarm's, round the movers. from_us: when the vehicle is at the start; in_motion: it
// does not stop there, so that its way begins straight ahead. It has AISLE_ROUTE_ROUND_UNITS at most.
void aisle_route_go_round(aisle_route *self, const aisle_movers *movers, int64_t from_us, bool in_motion);

// Spends about `units`. AISLE_BUSY; AISLE_PARTIAL: there is an answer already, and what may better it takes long (told
// once);
// AISLE_OK: ended: aisle_route_answer() or cause.
aisle_status aisle_route_step(aisle_route *self, uint32_t units);

// The layout in force is another one: the answers remembered are held against it. Not while a request runs. AISLE_BUSY,
// then AISLE_OK.
void aisle_route_layout_changed(aisle_route *self, const aisle_layout *layout);
aisle_status aisle_route_step_change(aisle_route *self, uint32_t units);

// The proved path, NULL if there is none.
const aisle_proof *aisle_route_answer(const aisle_route *self);
#endif
