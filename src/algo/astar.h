// astar.h - best-first search over an 8-connected grid with integer costs. Level 2: knows no robots or maps.
//
// Method: A* (Hart, Nilsson, Raphael 1968) with the octile distance, in integers: a straight step costs 70, a diagonal one
// 99 (99/70 = sqrt 2 less 5e-5), each times a factor in [1, 16] that the caller's inlet gives. The heuristic is
// consistent, so a cell is expanded once and its parent is final.
// Ours: all f values in the open list lie within one step of the current one, so a cell stores only 11 bits of its f and
// the open list is a ring of buckets (Dial 1969): O(1) push and pop, 2 bytes a cell.
// Ties: within a bucket last in, first out; neighbours in the fixed order E N W S NE NW SW SE.
// Memory: cells * 2 bytes + open_nodes * 8 bytes + 8 KiB, from the arena. Time: start O(cells) (clears), a step
// O(expansions * 8 inlet calls).
#ifndef AISLE_ALGO_ASTAR_H
#define AISLE_ALGO_ASTAR_H

#include "aisle/status.h"
#include "base/arena.h"

#include <stdbool.h>
#include <stdint.h>

#define AISLE_ASTAR_STRAIGHT 70U
#define AISLE_ASTAR_DIAGONAL 99U
#define AISLE_ASTAR_FACTOR_ONE 16U  // inlet's answer for factor 1
#define AISLE_ASTAR_FACTOR_MAX 256U // and for factor 16
#define AISLE_ASTAR_BARRED 0U       // this move is not allowed (another one into the cell may be)
#define AISLE_ASTAR_BARRED_CELL UINT32_MAX // nothing may enter this cell, do not ask again

// dir: 0..7 = E N W S NE NW SW SE. Asked at most 8 times per cell. Must answer the same for the same move.
typedef uint32_t (*aisle_astar_enter_fn)(void *ctx, uint32_t from, uint32_t to, uint8_t dir);

typedef struct aisle_astar_config {
    aisle_astar_enter_fn enter;
    void *ctx;
    uint32_t w, h;        // cells; w * h <= capacity
    uint32_t start, goal; // cells; enter() is not asked about the start itself
} aisle_astar_config;

typedef struct aisle_astar {
    aisle_astar_config cfg;
    uint16_t *cell; // [capacity] 0 = untouched; else state, parent direction, low bits of f
    // (open list and the rest: the implementer's)
    uint32_t capacity, open_capacity;
    uint32_t open_used, open_used_max; // high-water mark since carve
    uint32_t expanded;                 // since start
} aisle_astar;

void aisle_astar_carve(aisle_astar *self, aisle_arena *arena, uint32_t cells, uint32_t open_nodes);

// AISLE_ERR_ARG: w or h is 0, start or goal outside, enter NULL. AISLE_ERR_CAPACITY: w * h > capacity.
aisle_status aisle_astar_start(aisle_astar *self, const aisle_astar_config *cfg);

// Expands at most `nodes` cells. AISLE_BUSY: call again. AISLE_OK: goal reached. AISLE_PARTIAL: the open list ran
// empty: everything reachable was expanded, the goal is not. AISLE_ERR_CAPACITY: the open list is full (no answer).
aisle_status aisle_astar_step(aisle_astar *self, uint32_t nodes);

// After AISLE_OK: cost of the path in units of 1/70 cell.
uint64_t aisle_astar_cost(const aisle_astar *self);

// After AISLE_OK: cells from start to goal. AISLE_ERR_CAPACITY: longer than capacity, nothing written.
aisle_status aisle_astar_path(const aisle_astar *self, uint32_t *cells, uint32_t capacity, uint32_t *count);

// Was the cell expanded (reached)? Valid after any end: with AISLE_PARTIAL it tells the start's connected component.
bool aisle_astar_reached(const aisle_astar *self, uint32_t cell);
#endif
