// astar.h - best-first search over an 8-connected grid with integer costs. Level 2: knows no robots or maps.
//
// Method: A* (Hart, Nilsson, Raphael 1968, doi:10.1109/TSSC.1968.300136) with the octile distance, in integers: a
// straight step costs 70, a diagonal one 99 (99/70 = sqrt 2 plus 7e-5), each times a factor in [1, 16] that the
// caller's inlet gives in sixteenths, rounded down. h = 70 max + 29 min of the distances in x and y changes by at most
// 70 over a straight step and 99 over a diagonal one, and no factor is below 1: h is consistent, so a cell is expanded
// once and its parent is final.
// Ours: all f values in the open list lie within 16 * 99 + 99 = 1683 of the current one, so a cell stores only 11 bits
// of its f and the open list is a ring of 2048 buckets (Dial 1969, doi:10.1145/363269.363610): O(1) push and pop, 2
// bytes a cell. A cell whose f falls is pushed again; its older entry is thrown away when it comes up, or before that
// when the list is full or mostly stale (it would be, on open ground: 40 stale entries for one open cell).
// Ties: within a bucket last in, first out; neighbours in the fixed order E N W S NE NW SW SE.
// Whether a diagonal step may cut a corner is the inlet's decision.
//
// Cells are numbered iy * w + ix, x to the east, y to the north.
// Memory: cells * 2 bytes + open_nodes * 8 bytes + 8 KiB, from the arena. Time: start O(w * h) (clears), a step
// O(nodes * 8 inlet calls), one in many also O(open_nodes) to clean the list up, O(1) a push on the whole; 30 ns a cell
// on open ground, 50 to 80 among noise (3 GHz x86-64, trivial inlet). No recursion. Objects share nothing.
// Determinism: integers only; the same bits however the run is cut into steps.
#ifndef AISLE_ALGO_ASTAR_H
#define AISLE_ALGO_ASTAR_H

#include "aisle/status.h"
#include "base/arena.h"

#include <stdbool.h>
#include <stdint.h>

#define AISLE_ASTAR_CELLS_MAX 16777216U // of carve: h then fits 31 bits
#define AISLE_ASTAR_STRAIGHT 70U
#define AISLE_ASTAR_DIAGONAL 99U
#define AISLE_ASTAR_FACTOR_ONE 16U         // inlet's answer for factor 1
#define AISLE_ASTAR_FACTOR_MAX 256U        // and for factor 16
#define AISLE_ASTAR_BARRED 0U              // this move is not allowed (another one into the cell may be)
#define AISLE_ASTAR_BARRED_CELL UINT32_MAX // nothing may enter this cell, do not ask again
#define AISLE_ASTAR_RING 2048U             // buckets
#define AISLE_ASTAR_NONE UINT32_MAX

// May the search move from one cell to its neighbour, and at what factor? dir: 0..7 = E N W S NE NW SW SE. Asked at
// most 8 times per cell entered, never outside the grid, never about entering the start, a barred or an expanded cell,
// nor about a move that could not improve on what is known. Must answer the same for the same move, in [FACTOR_ONE,
// FACTOR_MAX] or one of the two BARRED.
typedef uint32_t (*aisle_astar_enter_fn)(void *ctx, uint32_t from, uint32_t to, uint8_t dir);

typedef struct aisle_astar_config {
    aisle_astar_enter_fn enter;
    void *ctx;            // passed through, may be NULL
    uint32_t w, h;        // cells; w * h <= capacity
    uint32_t start, goal; // cells; enter() is not asked about the start itself
} aisle_astar_config;

typedef struct aisle_astar_node { // one entry of the open list, or of the chain of free ones
    uint32_t cell;
    uint32_t next; // AISLE_ASTAR_NONE: last
} aisle_astar_node;

// Public so that it can be a static variable. Read the counters; write nothing.
typedef struct aisle_astar {
    aisle_astar_config cfg;
    uint16_t *cell;         // [capacity] 0 = untouched; bits 15..14 state, 13..11 direction of entry, 10..0 of f
    aisle_astar_node *open; // [open_capacity]
    uint32_t *bucket;       // [AISLE_ASTAR_RING] newest entry with these low bits of f, or AISLE_ASTAR_NONE
    uint64_t filled[AISLE_ASTAR_RING / 64]; // bit b: bucket b is not empty
    uint64_t f;                             // of the last entry taken
    uint32_t capacity, open_capacity;
    uint32_t free_head, untouched;       // returned entries; entries from here on were never used
    uint32_t open_used, open_used_max;   // entries in the ring, stale ones too; high-water mark since carve
    uint32_t live;                       // entries that are not stale: cells in state open
    uint32_t collect_at;                 // clean the ring up when open_used gets here
    uint32_t expanded, asked, collected; // cells, calls of enter(), clean-ups of the ring; since start
    int32_t offset[8];                   // from a cell to its neighbour, by direction
    int32_t goal_x, goal_y;
    aisle_status ended; // AISLE_BUSY while running, AISLE_ERR_ARG before the first start
} aisle_astar;

// cells in [1, AISLE_ASTAR_CELLS_MAX], open_nodes >= 1. Usable unless arena->overflow or measuring.
void aisle_astar_carve(aisle_astar *self, aisle_arena *arena, uint32_t cells, uint32_t open_nodes);

// Copies cfg. AISLE_ERR_ARG: w or h is 0, start or goal outside, enter NULL. AISLE_ERR_CAPACITY: w * h > capacity.
// On error self is unchanged. Asks nothing; whether start and goal are free is the caller's to check.
aisle_status aisle_astar_start(aisle_astar *self, const aisle_astar_config *cfg);

// Takes at most `nodes` entries from the open list and expands their cells (a stale entry counts, too). AISLE_BUSY:
// call again. AISLE_OK: goal reached. AISLE_PARTIAL: the open list ran empty: everything reachable was expanded, the
// goal is not. AISLE_ERR_CAPACITY: the open list is full, seven eighths of it with open cells (no answer).
// AISLE_ERR_ARG: never started. Further calls repeat the answer and cost nothing.
aisle_status aisle_astar_step(aisle_astar *self, uint32_t nodes);

// After AISLE_OK: cost of the path in units of 1/70 cell; else UINT64_MAX.
uint64_t aisle_astar_cost(const aisle_astar *self);

// After AISLE_OK: cells from start to goal, both included; start = goal is one cell. AISLE_ERR_CAPACITY: longer than
// capacity, nothing written, *count is the need. AISLE_ERR_ARG: there is no path, nothing written. O(length).
aisle_status aisle_astar_path(const aisle_astar *self, uint32_t *cells, uint32_t capacity, uint32_t *count);

// Was the cell expanded (reached)? Valid after any end: with AISLE_PARTIAL it tells the start's connected component.
// False for cells outside the grid. O(1).
bool aisle_astar_reached(const aisle_astar *self, uint32_t cell);

// O(w * h + open_capacity): true unless memory was overwritten. For asserts and tests.
bool aisle_astar_invariants_hold(const aisle_astar *self);
#endif
