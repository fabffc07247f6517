// compose.h - from planned legs to a complete path_t: pieces, clearances, speeds, sums. Level 4.
//
// Geometry: seed legs become lines with the widest corner arc that is free, swarm legs the spline as biarcs (or lines
// with arcs), manoeuvres are taken as they are; a turn on the spot where headings do not meet; a stop with GOAL at each leg's end. Pieces are halved
// down to AISLE_COMPOSE_PIECE (more on long paths, so that the waypoints suffice) so that clearance, creep speed and
// zones follow the place; straight ones that keep the creep clearance only down to AISLE_COMPOSE_JOIN, and those that
// keep it nowhere only to half of that, unless the objective is SAFEST: no other asks by how much. Straight neighbours
// of the same speed class are joined again. Clearance: space.h's lower bound. Speeds: profile.h.
// Memory: the caller's buffers. Time: O(waypoints * obstacles near), sliced by piece.
#ifndef AISLE_PLAN_COMPOSE_H
#define AISLE_PLAN_COMPOSE_H

#include "plan/leg.h"
#include "plan/objective.h"
#include "plan/space.h"
#include "robot/curve.h"

#define AISLE_COMPOSE_PIECE 0.5   // m
#define AISLE_COMPOSE_PIECES 400U // a path is cut into about so many pieces at most
#define AISLE_COMPOSE_JOIN 2.0    // m, longest joined piece
#define AISLE_COMPOSE_DEPTH 24U   // of halvings of one piece

typedef struct aisle_compose_request {
    const aisle_space *space;
    const aisle_objective *objective;
    const aisle_options_msg *options;
    const aisle_vec2 *points;         // seed polylines of all legs
    const aisle_waypoint_msg *pieces; // and their manoeuvres
    aisle_leg *legs;                  // their seed_value or swarm_value is written
    uint32_t leg_count;
    const aisle_goal_msg *start; // heading free if tolerance_theta >= pi
    const aisle_goal_msg *goals; // [leg_count]
    bool stops;                  // stop and turn in every corner, no arcs
} aisle_compose_request;

typedef struct aisle_compose {
    aisle_compose_request request;
    aisle_path_msg *path;    // its waypoints and sums are written
    aisle_waypoint_msg *raw; // [AISLE_PATH_MAX_WAYPOINTS]
    float *dwell;            // [AISLE_PATH_MAX_WAYPOINTS]
    aisle_spline *spline;
    aisle_spline_sample *sample;      // [AISLE_SWARM_SAMPLES_MAX]
    uint32_t raw_count, at;           // at: the piece in hand ends there
    double done;                      // share of it that is in the path
    double ends[AISLE_COMPOSE_DEPTH]; // of its parts not yet in the path, the next on top
    uint32_t depth;                   // of ends
    double longest;                   // m, a part near obstacles
    uint32_t leg;                     // being laid, later: whose value is being summed up
    double value;                     // of the leg so far
    double risk;                      // m, of the path so far: length times risk
    double penalty;                   // m, what PENALTY zones add to the path so far
    uint32_t units;
} aisle_compose;

void aisle_compose_carve(aisle_compose *self, aisle_arena *arena);

// Does the body keep `need` (m) on the seed of leg i, its corners arcs of its tangent_radius, its heading along the way? "Yes"
// is sure but for what comes before and after the leg. Between a start() and the last step() it spoils the path. Adds
// its work to *units: O(pieces * obstacles near), not sliced.
bool aisle_compose_way_free(aisle_compose *self, const aisle_compose_request *request, uint32_t i, double need,
                            uint32_t *units);

typedef struct aisle_opposed { // a DIRECTED zone that a way is against
    int32_t id;
    aisle_vec2 place; // m, on the way
} aisle_opposed;

// The seed of leg i laid likewise: is it against DIRECTED zones? How many there are, at least (0: none); the first in
// *out. It, too, spoils the path.
uint32_t aisle_compose_way_opposed(aisle_compose *self, const aisle_compose_request *request, uint32_t i,
                                   aisle_opposed *out);

// Begins: lays the geometry. AISLE_ERR_CAPACITY: more waypoints than a path_t holds.
aisle_status aisle_compose_start(aisle_compose *self, const aisle_compose_request *request, aisle_path_msg *path);

// Cuts pieces and measures clearances (a unit for each exact gap); at the end fills speeds and sums (a unit a waypoint).
// AISLE_BUSY, then AISLE_OK; AISLE_ERR_ARG: degenerate geometry.
aisle_status aisle_compose_step(aisle_compose *self, uint32_t units, uint32_t *spent);

// Rest (s) at each of w[n] before going on, dwell[n]: what the goals told there, in this order, ask for. O(n).
void aisle_goal_dwells(const aisle_waypoint_msg *w, uint32_t n, const aisle_goal_msg *goals, uint32_t num_goals,
                       float *dwell);
// Any heading will do?
bool aisle_goal_heading_is_free(const aisle_goal_msg *goal);
// Arriving with this heading (rad), must the body turn there? Half the goal's tolerance is kept for the way's end.
bool aisle_goal_wants_turn(const aisle_goal_msg *goal, double theta);
#endif
