// opening.h - the smallest set of obstacles, of at most two, whose removal would open a way that is proved shut. Level
// 4.
//
// Members are polygons of kind OBSTACLE or KEEPOUT, never the scan or the bounds. "A way" is one for a disc of `reach`
// (the one the footprint holds, with its margin), as in the proof of why.h.
// Method: the optimistic grid of that proof (a cell is open if any point of it may have the room) is flooded from the
// start and from the goal; a polygon that comes within reach of a closed cell next to a flood borders it. To open the
// way alone a polygon must border both floods: the way leaves the start's through what it alone closes and enters the
// goal's likewise. Each of these is left out in turn and the start's flood goes on where it closed cells. Of a pair,
// the one crossed first after the way's last step in the start's flood borders it; its removal alone lets the flood go
// on to where the other one borders; and one of both borders the goal's flood: all such pairs are tried, in the
// layout's order. What the optimistic grid opens is then proved, or not, by a flood of cells whose middles have all
// the room that a step needs. If that fails for one polygon all begins anew with the optimistic grid at its finest.
// Answer: AISLE_OK, `without` is a set whose removal is proved to connect, no smaller one does (every smaller one was
// excluded by the optimistic grid, hence for certain). AISLE_PARTIAL, none is told: no set of two does, or one of one
// may and could not be proved (a way within a cell of too narrow), or the work or the queue did not suffice.
// Memory: that of the seed's search (labels, queue) and path (marks of polygons) and of the space (bits), which it
// overwrites. Time: a unit a
// cell flooded and one an exact gap; two floods of the grid, then what each removal opens, then a flood to prove it;
// sliced, at most `limit` units.
#ifndef AISLE_PLAN_OPENING_H
#define AISLE_PLAN_OPENING_H

#include "plan/seed.h"

#define AISLE_OPENING_UNITS 1000000U // work units it may spend at most

typedef enum aisle_opening_stage {
    AISLE_OPENING_START,  // the start's flood
    AISLE_OPENING_GOAL,   // the goal's
    AISLE_OPENING_SINGLE, // one polygon left out
    AISLE_OPENING_FIRST,  // the same for what it borders then
    AISLE_OPENING_PAIR,   // two left out
    AISLE_OPENING_PROVE,  // does it connect for sure?
    AISLE_OPENING_END
} aisle_opening_stage;

typedef struct aisle_opening {
    aisle_seed *seed;
    aisle_space *space;
    aisle_vec2 start, goal;
    double reach;   // m
    uint32_t depth; // halvings of a cell in doubt
    uint32_t limit, spent;
    aisle_opening_stage stage, tried; // tried: what is being proved
    aisle_layout_without without;
    uint32_t first, second; // zones left out, by index
    uint16_t bordered;      // label of the flood without the first one: marks what it borders
    bool doubt;             // a set of one may connect
    bool found;
    // the flood under way
    uint16_t label;                         // of its open cells; of closed ones the next
    bool anew;                              // from the start alone, not from the start's flood
    bool sure;                              // cells with room for every step, not those that may have room
    bool connected;                         // it met the goal, or the goal's flood
    bool overflow;                          // of the queue
    uint32_t head, tail;                    // of the queue, a ring
    uint32_t row[AISLE_LAYOUT_WITHOUT_MAX]; // next row of a polygon's surroundings to begin from
} aisle_opening;

// depth: at which the optimistic grid does not connect. limit: work units, at most
// AISLE_OPENING_UNITS.
void aisle_opening_start(aisle_opening *self, aisle_seed *seed, aisle_space *space, aisle_vec2 start, aisle_vec2 goal,
                         uint32_t depth, uint32_t limit);

// Spends about `units`, adds what it spent to *spent. AISLE_BUSY, AISLE_OK, AISLE_PARTIAL: see above.
aisle_status aisle_opening_step(aisle_opening *self, uint32_t units, uint32_t *spent);
#endif
