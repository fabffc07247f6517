// togo.h - cost-to-go: about how far it is from every place to a goal for the disc inside the body. Level 4.
//
// Cells of AISLE_TOGO_SIDE (whole planning cells, more where the map is large), open if any planning cell in it may
// hold the disc (optimistic, so that no place the body can be in is closed), steps of 5 and 7 to the side and diagonally
// (Borgefors 1986, the chamfer 5-7-11 without its last step): at most 8 % too long. Dijkstra's search with a ring of
// buckets (Dial 1969), outwards from the goal until the start is reached and as far beyond as is asked for.
// Cells where the disc comes near to something may be made dearer, so that what is led keeps off walls where that is cheaper.
// Places may be closed besides what the grid says (movers that stand in the way): cells whose centre is in them.
// A guide for searches: neither a bound nor a proof.
// Memory: 2 bytes a cell of its own, one for 16 planning cells, and 0.5 MiB. Time: O(cells reached), sliced.
#ifndef AISLE_PLAN_TOGO_H
#define AISLE_PLAN_TOGO_H

#include "plan/space.h"

#define AISLE_TOGO_SIDE 0.2    // m
#define AISLE_TOGO_SHARE 16U   // planning cells for one of its cells
#define AISLE_TOGO_DEAR_MAX 9U // times as dear a cell may be
#define AISLE_TOGO_RING 64U    // buckets: more than the dearest step
#define AISLE_TOGO_QUEUE 2048U // cells in one of them, at most

typedef struct aisle_togo {
    const aisle_grid *grid;
    uint16_t *cost;  // [capacity], 5 a cell; AISLE_TOGO_NONE: not reached; 0: the goal's, or closed
    uint32_t *queue; // [AISLE_TOGO_RING * room]
    uint32_t room;   // cells in one of its buckets
    uint32_t count[AISLE_TOGO_RING];
    uint32_t capacity, stride, w, h; // stride: planning cells along one of its own
    double size;                     // m, side of a cell
    bool insists, ends_at_start;     // see below
    uint32_t open_from;              // least field value of an open planning cell
    uint32_t clear_from, dear;       // below that field value a step is so many times as dear
    uint32_t at, limit, start, goal; // cost under way; where it ends; the cells of start and goal
    uint32_t since; // least cost of a cell that was closed after it was reached; AISLE_TOGO_NONE: none was
    uint32_t cells; // looked at
} aisle_togo;

#define AISLE_TOGO_NONE UINT16_MAX

// `cells`: of the planning grid, the limit.
void aisle_togo_carve(aisle_togo *self, aisle_arena *arena, uint32_t cells);

// Begins; reach: m, radius of the disc and its margin.
void aisle_togo_start(aisle_togo *self, const aisle_grid *grid, double reach, aisle_vec2 start, aisle_vec2 goal);

// After start(): ends as soon as all is known that is no farther from the goal than the start; else it goes on to half as far
// again and 10 m.
void aisle_togo_end_at_start(aisle_togo *self);

// After start(): steps to cells where a disc of `clear` (m) finds no room are `dear` times as dear, in
// [1, AISLE_TOGO_DEAR_MAX]. Costs are then metres of clear way.
void aisle_togo_keep_clear(aisle_togo *self, double clear, uint32_t dear);

// After start(): only cells are open in whose centre the disc has room enough to go straight to the neighbours' centres,
// surely, and the start's own. What such cells connect is connected; narrower ways are not seen.
void aisle_togo_insist(aisle_togo *self, double reach);

// Between start() and the first step(), or when the search has ended: closes all that is less than `radius` (m) from the
// segment a b, but for the start's own cell. The goal's cell closed: nothing is reached. A search that has ended is gone on
// with by step(): nothing hangs on what is farther from the goal, so only what is no nearer than the cells now closed is
// searched anew. O(cells of the segment's box).
void aisle_togo_close(aisle_togo *self, aisle_vec2 a, aisle_vec2 b, double radius);

// AISLE_BUSY; AISLE_OK: the start is reached; AISLE_PARTIAL: it is not. A unit for 32 cells.
aisle_status aisle_togo_step(aisle_togo *self, uint32_t units, uint32_t *spent);

// About the way from p to the goal, m; INFINITY where the search did not come.
double aisle_togo_at(const aisle_togo *self, aisle_vec2 p);

// Centre of the neighbouring cell that is nearest to the goal, if any is nearer than p's own; false: none. O(1).
bool aisle_togo_next(const aisle_togo *self, aisle_vec2 p, aisle_vec2 *next);
#endif
