// layout_update.h - the grid after a patch, where it changed alone. Level 1; part of layout.
//
// Polygons that came are marked first, then those that left are freed but for what else is there; so one that moved a
// little hides much of what it left. A polygon is done in pieces: bands of rows whose box it fills by half, cut to
// AISLE_WINDOW_PIECE columns; after each the window (grid_window.h) makes the field exact again.
// Where all the windows together would be dearer than building the whole (half of its cells, which leaves room for what
// a window costs beside), the update gives up and the caller builds the whole.
// Memory: AISLE_WINDOW's. Time: O(cells of the windows, and the zones that overlap the pieces).
#ifndef AISLE_WORLD_LAYOUT_UPDATE_H
#define AISLE_WORLD_LAYOUT_UPDATE_H

#include "world/grid_window.h"

struct aisle_layout; // this is a part of it

typedef struct aisle_layout_update {
    aisle_grid_window window;
    aisle_cells band;  // in hand; its columns from band.x0 on are still to do
    uint32_t change;   // in hand, of aisle_layout_changes()
    uint32_t next_row; // of its polygon
    uint32_t owed;     // rows of work done in one go and not counted yet
    bool is_removing;  // what came is in
    bool is_window;    // begun and not done
    uint64_t cells;    // of all windows so far
} aisle_layout_update;

void aisle_layout_update_begin(aisle_layout_update *self);

// About *units rows of work; takes off what was done. The active store's index is built, the grid is that of the store
// before, which still is there. AISLE_BUSY, then AISLE_OK; AISLE_ERR_CAPACITY: dearer than the whole, and the grid is
// spoiled.
aisle_status aisle_layout_update_step(struct aisle_layout *layout, uint32_t *units);
#endif
