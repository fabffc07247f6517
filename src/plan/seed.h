// seed.h - connectivity: a grid search for one leg and its path as a short polyline. Level 4.
//
// Search: A* over the planning grid (algo/astar.h), the cost of a cell being the objective's density at its clearance,
// so that the homotopy class already suits the objective. FREE_TURN bars cells where the turning disc does not fit
// (exactly, where the field leaves a doubt); ALONG bars moves the footprint cannot make with its heading along them.
// Stride: the search may look at every k-th cell only. A straight passage 1.25 strides wider than the turning disc with
// its margin (of a radius of two strides or more) is never lost by that; the caller tries stride 1 when a larger one
// finds nothing.
// ROOMIEST, for discs: every cell, and one whose centre has not the room stands at the roomiest point found in it,
// the moves
// there tested exactly: finds slits narrower than a cell without a finer grid, at some 60 exact gaps a cell along
// contours.
// Ends: start and goal are joined to the nearest free cell centre that the exact footprint reaches straight, heading
// along the way, within AISLE_SEED_JOIN m: a station may be too tight to turn in.
// Straightening: from each kept point the farthest cell along the path that a free straight way reaches (galloping,
// then halving) at no higher cost than the cells' own way.
// Corners (ALONG): one where the body cannot turn is moved outwards along one of its legs, within the turning disc's
// diameter, to where it can, a neighbour left out if need be; one that finds no such place stays.
//
// Two more searches serve refusals (why.h) and give no polyline. PROOF: a cell is open if any point of it may keep
// `reach` from every obstacle (exactly, down to 2^-depth of a cell); if such cells do not connect, no way of that width
// exists. WIDTH: a cell is open from a field value on.
//
// Memory: search 2 bytes a cell, path 4 bytes * AISLE_SEED_CELLS_MAX, table. Time: O(cells expanded), sliced.
#ifndef AISLE_PLAN_SEED_H
#define AISLE_PLAN_SEED_H

#include "algo/astar.h"
#include "plan/objective.h"
#include "plan/space.h"

#define AISLE_SEED_CELLS_MAX 65536U // cells of a path
#define AISLE_SEED_POINTS_MAX 256U  // points of a leg's polyline
#define AISLE_SEED_JOIN 1.5         // m
#define AISLE_SEED_ROOMIEST 0U      // a stride: see above
#define AISLE_SEED_TABLE 16384U     // field values with a tabulated factor

typedef enum aisle_seed_phase {
    AISLE_SEED_IDLE,
    AISLE_SEED_SEARCH,
    AISLE_SEED_STRAIGHTEN,
    AISLE_SEED_CORNERS,
    AISLE_SEED_DONE
} aisle_seed_phase;

typedef struct aisle_seed {
    aisle_space *space;
    const aisle_objective *objective;
    aisle_astar search;
    aisle_vec2 start, goal;
    uint32_t stride; // cells between neighbours of the search
    bool roomiest;
    uint32_t *cells; // [AISLE_SEED_CELLS_MAX]
    uint32_t cell_count, at;
    uint16_t *factor;      // [AISLE_SEED_TABLE] by field value
    uint32_t open_from;    // WIDTH: least field value of an open cell
    aisle_vec2 (*bars)[2]; // WIDTH, the widest way: segments it must not cross; the caller's
    uint32_t bar_count;
    double proof_reach; // PROOF: m
    uint32_t proof_depth;
    bool for_refusal; // PROOF or WIDTH
    uint32_t units;   // spent inside callbacks since the last step
    aisle_seed_phase phase;
    aisle_vec2 *points; // the polyline under way; the caller's [AISLE_SEED_POINTS_MAX]
    uint32_t point_count;
} aisle_seed;

void aisle_seed_carve(aisle_seed *self, aisle_arena *arena, const aisle_limits *limits);

// Begins the search of a leg; stride >= 1 or AISLE_SEED_ROOMIEST. AISLE_OK, or AISLE_PARTIAL: no free cell near start
// or goal can be joined
// (nothing begun).
aisle_status aisle_seed_start(aisle_seed *self, aisle_space *space, const aisle_objective *objective, uint32_t stride,
                              aisle_vec2 start, aisle_vec2 goal, aisle_vec2 *points);

// AISLE_BUSY; AISLE_OK: points[0..point_count) lead from start to goal; AISLE_PARTIAL: the grid has no way;
// AISLE_ERR_CAPACITY: the open list, the path or the polyline is full. Spends about `units`, adds what it spent to
// *spent.
aisle_status aisle_seed_step(aisle_seed *self, uint32_t units, uint32_t *spent);

// Whether start and goal connect: step_refusal() answers as step() does. stride as above, [1, sides of the grid].
void aisle_seed_start_proof(aisle_seed *self, aisle_space *space, aisle_vec2 start, aisle_vec2 goal, double reach,
                            uint32_t depth);
void aisle_seed_start_width(aisle_seed *self, aisle_space *space, aisle_vec2 start, aisle_vec2 goal, uint32_t stride,
                            uint32_t open_from);
// The same cells, but the way keeps off the least clearance where it can; bars, if any, are set after this.
void aisle_seed_start_widest(aisle_seed *self, aisle_space *space, aisle_vec2 start, aisle_vec2 goal, uint32_t stride,
                             uint32_t open_from);
aisle_status aisle_seed_step_refusal(aisle_seed *self, uint32_t units, uint32_t *spent);

// After step_refusal() said AISLE_OK: cells[0..cell_count) of the grid, from start to goal. AISLE_ERR_CAPACITY: too
// many.
aisle_status aisle_seed_refusal_path(aisle_seed *self);
#endif
