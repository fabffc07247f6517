#include "world/layout_update.h"

#include "base/check.h"
#include "world/grid_raster.h"
#include "world/layout_internal.h"
#include "world/layout_mark.h"

#define ANY_FREE UINT32_MAX
#define BAND_SPARE 4096 // cells a band's box may hold beyond twice its polygon's

void aisle_layout_update_begin(aisle_layout_update *self) {
    self->band = (aisle_cells){0};
    self->change = 0;
    self->next_row = 0;
    self->owed = 0;
    self->is_removing = false;
    self->is_window = false;
    self->cells = 0;
}

// ---- pieces

// The polygon in hand: of the active store if it came, of the one before if it left.
static void raster_in_hand(const aisle_layout *layout, aisle_raster *out) {
    const aisle_layout_change *change = &layout->diff.change[layout->update.change];
    const aisle_layout_store *store = &layout->store[change->is_added ? layout->active : 1U - layout->active];
    const aisle_zone *zone = &store->zones[change->index];
    const aisle_convex shape = {&store->vertices[zone->first], zone->n, 0.0};
    aisle_raster_of(out, &layout->grid.lattice, &shape);
}

static void take_in(aisle_cells *box, int32_t y, int32_t x0, int32_t x1) { // box empty: x0 >= x1
    const bool is_empty = box->x0 >= box->x1;
    box->x0 = is_empty || x0 < box->x0 ? x0 : box->x0;
    box->x1 = is_empty || x1 > box->x1 ? x1 : box->x1;
    box->y0 = is_empty ? y : box->y0;
    box->y1 = y + 1;
}

// Rows from `row` on until the box around the polygon's part in them holds too much else.
static aisle_cells band_from(const aisle_raster *raster, uint32_t row) {
    aisle_cells band = {0};
    int32_t sum = 0;
    for (uint32_t y = row; y < raster->end_row && y - row < AISLE_WINDOW_PIECE; y++) {
        uint32_t first;
        uint32_t end;
        aisle_raster_row(raster, y, &first, &end);
        if (first >= end) {
            continue; // beside the lattice
        }
        aisle_cells more = band;
        take_in(&more, (int32_t)y, (int32_t)first, (int32_t)end);
        sum += (int32_t)(end - first);
        if (band.x0 < band.x1 && (more.x1 - more.x0) * (more.y1 - more.y0) > 2 * sum + BAND_SPARE) {
            break;
        }
        band = more;
    }
    return band;
}

static bool is_to_do(const aisle_layout *layout) {
    const aisle_layout_change *change = &layout->diff.change[layout->update.change];
    return change->is_added != layout->update.is_removing &&
           (change->kind == AISLE_POLYGON_OBSTACLE || change->kind == AISLE_POLYGON_KEEPOUT);
}

// The next band, of this change or of the next one that matters. False: all is done.
static bool next_band(aisle_layout *layout, aisle_raster *raster) {
    aisle_layout_update *self = &layout->update;
    for (;;) {
        if (self->change == layout->diff.count) {
            if (self->is_removing) {
                return false;
            }
            self->is_removing = true;
            self->change = 0;
            continue;
        }
        if (is_to_do(layout)) {
            raster_in_hand(layout, raster);
            const uint32_t row = self->next_row > raster->first_row ? self->next_row : raster->first_row;
            self->band = band_from(raster, row);
            if (self->band.x0 < self->band.x1) {
                self->next_row = (uint32_t)self->band.y1;
                return true;
            }
        }
        self->change++;
        self->next_row = 0;
    }
}

// ---- what changes in a piece

static void row_in(const aisle_raster *raster, aisle_cells piece, int32_t y, int32_t *x0, int32_t *x1) {
    uint32_t first;
    uint32_t end;
    aisle_raster_row(raster, (uint32_t)y, &first, &end);
    *x0 = (int32_t)first > piece.x0 ? (int32_t)first : piece.x0;
    *x1 = (int32_t)end < piece.x1 ? (int32_t)end : piece.x1;
}

// Cells of the polygon that hold `from` hold `to` then; the box around them.
static aisle_cells replace(aisle_layout *layout, const aisle_raster *raster, aisle_cells piece, uint32_t from,
                           uint16_t to) {
    aisle_cells changed = {0};
    for (int32_t y = piece.y0; y < piece.y1; y++) {
        int32_t x0;
        int32_t x1;
        row_in(raster, piece, y, &x0, &x1);
        uint16_t *row = &layout->grid.field[(uint32_t)y * layout->grid.lattice.w];
        for (int32_t x = x0; x < x1; x++) {
            if (from == ANY_FREE ? row[x] != 0 : row[x] == from) {
                row[x] = to;
                take_in(&changed, y, x, x + 1);
            }
        }
    }
    return changed;
}

// All of the polygon is freed, then what the layout still occupies is marked again.
static aisle_cells vacate(aisle_layout *layout, const aisle_raster *raster, aisle_cells piece) {
    const aisle_cells freed = replace(layout, raster, piece, 0, AISLE_WINDOW_FREED);
    if (freed.x0 >= freed.x1) {
        return freed;
    }
    aisle_layout_mark_all(layout, freed);
    return replace(layout, raster, piece, AISLE_WINDOW_FREED, AISLE_WINDOW_FREED);
}

// Does the band's next piece up to the window, if there is one. False: dearer than the whole.
static bool do_piece(aisle_layout *layout, const aisle_raster *raster) {
    aisle_layout_update *self = &layout->update;
    aisle_cells piece = self->band;
    const int32_t most = piece.x0 + (int32_t)AISLE_WINDOW_PIECE;
    piece.x1 = piece.x1 < most ? piece.x1 : most;
    self->band.x0 = piece.x1;
    self->owed += (uint32_t)(piece.y1 - piece.y0);
    const aisle_cells changed =
        self->is_removing ? vacate(layout, raster, piece) : replace(layout, raster, piece, ANY_FREE, 0);
    if (changed.x0 >= changed.x1) {
        return true;
    }
    aisle_grid_window_find(&self->window, &layout->grid, changed, self->is_removing);
    self->is_window = true;
    const aisle_lattice *l = &layout->grid.lattice;
    self->cells +=
        (uint64_t)aisle_grid_window_width(&self->window) * (uint32_t)(self->window.box.y1 - self->window.box.y0);
    return 2U * self->cells <= (uint64_t)l->w * l->h;
}

aisle_status aisle_layout_update_step(aisle_layout *layout, uint32_t *units) {
    aisle_layout_update *self = &layout->update;
    while (*units > 0) {
        if (self->owed > 0) {
            const uint32_t paid = self->owed < *units ? self->owed : *units;
            self->owed -= paid;
            *units -= paid;
            continue;
        }
        if (self->is_window) {
            self->is_window = aisle_grid_window_step(&self->window, &layout->grid, units) == AISLE_BUSY;
            continue;
        }
        aisle_raster raster;
        if (self->band.x0 < self->band.x1) {
            raster_in_hand(layout, &raster);
        } else if (!next_band(layout, &raster)) {
            return AISLE_OK;
        }
        if (!do_piece(layout, &raster)) {
            return AISLE_ERR_CAPACITY;
        }
    }
    return AISLE_BUSY;
}
