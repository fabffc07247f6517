// scene.h - the hall that stands still, as the simulated world has it: polygons, scanned cells, bounds. Level 5.
//
// Read from the same messages the planner gets (LAYOUT, GRID, LAYOUT_PATCH), by code of its own. What the planner takes
// for occupied is so here: polygons of kind OBSTACLE and KEEPOUT, occupied cells, cells that no tile covers, all outside
// the bounds.
// Memory: heap, grown as messages need it; freed by aisle_sim_scene_free(). Time: questions O(polygons + cells near).
#ifndef AISLE_SIM_SCENE_H
#define AISLE_SIM_SCENE_H

#include "aisle/messages.h"
#include "sim/outline.h"

#include <stdbool.h>

enum { AISLE_SIM_ID_SCAN = -1, AISLE_SIM_ID_BOUNDS = -2 }; // ids of what is no polygon, as the messages have them

typedef struct aisle_sim_solid { // a polygon that bars the way
    int32_t id;
    aisle_sim_outline outline;
    aisle_vec2 centre; // of a disc around it
    double reach;      // and its radius
} aisle_sim_solid;

typedef struct aisle_sim_scene {
    int32_t map_id, map_revision; // of the newest layout message
    double x_min, y_min, x_max, y_max;
    aisle_sim_solid *solid; // [capacity]
    uint32_t count, capacity;
    bool has_scan;
    double origin_x, origin_y, resolution;
    int32_t width, height; // cells
    uint8_t *occupied;     // [width * height]
} aisle_sim_scene;

// Start with a zeroed struct. False: no memory, or a grid that cannot be (resolution or size out of range).
bool aisle_sim_scene_take_layout(aisle_sim_scene *self, const aisle_layout_msg *part);
bool aisle_sim_scene_take_tile(aisle_sim_scene *self, const aisle_grid_chunk_msg *tile); // after its layout_t
bool aisle_sim_scene_take_patch(aisle_sim_scene *self, const aisle_layout_patch_msg *patch);
void aisle_sim_scene_free(aisle_sim_scene *self);

// The gap of a body to what stands still, `most` if there is nothing within it; *id (may be NULL) says what is nearest.
double aisle_sim_scene_gap(const aisle_sim_scene *self, const aisle_sim_outline *body, double most, int32_t *id);

// Does a disc have this place to itself?
bool aisle_sim_scene_has_room(const aisle_sim_scene *self, aisle_vec2 at, double radius);

// May a disc move straight from a to b? Looked at every third of its radius, at least every 0.05 m.
bool aisle_sim_scene_sees(const aisle_sim_scene *self, aisle_vec2 a, aisle_vec2 b, double radius);
#endif
