// hall.h - a hall as text, for the host programs that run single modules of the core on it.
//
// Numbers in m, separated by white space:
//     x_min y_min x_max y_max  radius margin  vertices { x y ... }  start_x start_y  goal_x goal_y
//     polygons  { vertices  x y ... } ...
// vertices 0 and a radius: a disc. Everything else is the vehicle's default. tools/aisle_tools/hall.py writes it.
#ifndef AISLE_TOOLS_HALL_H
#define AISLE_TOOLS_HALL_H

#include "robot/vehicle.h"
#include "world/layout.h"

typedef struct hall {
    aisle_layout layout; // in force
    aisle_vehicle vehicle;
    aisle_vec2 start, goal;
} hall;

// An arena of `bytes` on the heap, for the whole life of the program; hall_fail() without memory.
aisle_arena hall_arena(size_t bytes);

// Reads standard input; carves the layout, up to 4096 polygons, from the arena. hall_fail() if it is not a hall.
void hall_read(hall *self, aisle_arena *arena, uint32_t cells);

// Prints `what` and ends the program with 2.
void hall_fail(const char *what);
#endif
