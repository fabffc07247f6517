#include "base/check.h"
#include "world/layout_content.h"
#include "world/layout_internal.h"
#include "world/layout_mark.h"

enum {
    PHASE_NONE,
    PHASE_RECTS,
    PHASE_CORNERS,
    PHASE_INDEX, // a patch begins here
    PHASE_WIDE,
    PHASE_UPDATE, // and ends here
    PHASE_CLEAR,
    PHASE_ZONES,
    PHASE_SCAN,
    PHASE_BORDER,
    PHASE_FIELD,
    PHASE_DONE
};

bool aisle_layout_is_in_force(const aisle_layout *self) {
    return self->phase == PHASE_DONE;
}

void aisle_layout_forget_base(aisle_layout *self) {
    self->has_base = false;
}

// A patch does not touch the scan: it goes to the new store, and the old one may keep the other's bits.
static void hand_over_scan(aisle_layout *self) {
    uint64_t *scan = self->store[0].scan;
    self->store[0].scan = self->store[1].scan;
    self->store[1].scan = scan;
}

void aisle_layout_commit(aisle_layout *self) {
    AISLE_ASSERT(self->staging.stage == AISLE_STAGE_COMPLETE);
    self->has_base = self->staging.is_patch && self->phase == PHASE_DONE;
    if (self->staging.is_patch) {
        hand_over_scan(self);
    }
    if (!self->has_base) {
        self->diff.everything = true;
        self->diff.count = 0;
        aisle_layout_rects_clear(&self->rects);
    }
    self->active = (uint8_t)(1U - self->active);
    self->has_active = true;
    self->staging.stage = AISLE_STAGE_EMPTY;
    self->phase = self->has_base ? PHASE_INDEX : PHASE_RECTS;
    self->next = 0;
    self->work = 0;
    self->is_whole = false;
    aisle_layout_update_begin(&self->update);
}

static aisle_cells row_of(const aisle_layout *self, uint32_t iy) {
    return (aisle_cells){0, (int32_t)iy, (int32_t)self->grid.lattice.w, (int32_t)iy + 1};
}

static void take_scan_row(aisle_layout *self, uint32_t iy) {
    const uint32_t w = self->grid.lattice.w;
    uint32_t end;
    for (uint32_t ix = 0; aisle_layout_scan_run(self, iy, &ix, w, &end); ix = end) {
        aisle_layout_active(self)->scan_content += aisle_content_of_run(iy, ix, end);
    }
    aisle_layout_mark_scan(self, row_of(self, iy));
}

// Puts a patch's changes into an index of the layout before; false: it has to be built. Those that left go from the last
// on, those that came from the first on, so that every place is the one in its own layout.
static bool edit_index(const aisle_layout *self, aisle_layout_index *index, double side) {
    enum { EDITS_MAX = 16 }; // above, building is as cheap
    const aisle_layout_diff *diff = &self->diff;
    if (!self->has_base || diff->is_reordered || diff->count > EDITS_MAX) {
        return false;
    }
    for (uint32_t i = diff->count; i-- > 0U;) {
        if (!diff->change[i].is_added) {
            aisle_layout_index_take_out(index, diff->change[i].index, diff->change[i].box);
        }
    }
    for (uint32_t i = 0; i < diff->count; i++) {
        if (diff->change[i].is_added && !aisle_layout_index_put_in(index, diff->change[i].index, diff->change[i].box)) {
            return false;
        }
    }
    return aisle_layout_index_is_as_built(index, side);
}

static void build_index(aisle_layout *self) {
    const aisle_layout_blocks zones = {aisle_layout_held(self), NULL};
    if (!edit_index(self, &self->index, AISLE_LAYOUT_BUCKET)) {
        aisle_layout_index_build(&self->index, &zones, AISLE_LAYOUT_BUCKET);
    }
}

static void build_wide(aisle_layout *self) {
    const aisle_layout_store *store = aisle_layout_held(self);
    const aisle_layout_blocks blocks = {store, aisle_layout_has_scan(self) ? &self->rects : NULL};
    const aisle_vec2 size = aisle_vec2_sub(store->header.bounds.hi, store->header.bounds.lo);
    const double share = sqrt(size.x * size.y / (double)(aisle_layout_blocks_count(&blocks) + 1U));
    double side = AISLE_LAYOUT_BUCKET_WIDE;
    while (2.0 * side <= share) {
        side *= 2.0;
    }
    if (!edit_index(self, &self->wide, side)) {
        aisle_layout_index_build(&self->wide, &blocks, side);
    }
}

static void clear_grid(aisle_layout *self) {
    self->is_whole = true;
    aisle_layout_active(self)->scan_content = 0;
    const aisle_status status = aisle_grid_begin(&self->grid, &aisle_layout_held(self)->lattice);
    AISLE_ASSERT(status == AISLE_OK); // checked when the layout came
}

// Items of one unit each in a phase.
static uint32_t phase_items(const aisle_layout *self) {
    switch (self->phase) {
    case PHASE_ZONES:
        return aisle_layout_zone_count(self);
    case PHASE_RECTS:
    case PHASE_SCAN:
        return aisle_layout_has_scan(self) ? aisle_layout_held(self)->lattice.h : 0U;
    default:
        return 1U;
    }
}

static void do_item(aisle_layout *self) {
    switch (self->phase) {
    case PHASE_RECTS:
        aisle_layout_rects_add_row(&self->rects, aisle_layout_active(self), self->next);
        break;
    case PHASE_CORNERS:
        aisle_layout_rects_find_corners(&self->rects, aisle_layout_active(self));
        break;
    case PHASE_INDEX:
        build_index(self);
        break;
    case PHASE_WIDE:
        build_wide(self);
        break;
    case PHASE_CLEAR:
        clear_grid(self);
        break;
    case PHASE_ZONES:
        aisle_layout_mark_zone(self, aisle_layout_zone(self, self->next), aisle_lattice_cells(&self->grid.lattice));
        break;
    case PHASE_SCAN:
        take_scan_row(self, self->next);
        break;
    default:
        aisle_layout_mark_border(self, aisle_lattice_cells(&self->grid.lattice));
        break;
    }
}

// Phases up to `end` in items of one unit each; whether they are done.
static bool do_items(aisle_layout *self, uint8_t end, uint32_t *units) {
    while (self->phase < end) {
        if (self->next == phase_items(self)) {
            self->next = 0;
            self->phase++;
            continue;
        }
        if (*units == 0) {
            return false;
        }
        do_item(self);
        self->next++;
        (*units)--;
    }
    return true;
}

static void update(aisle_layout *self, uint32_t *units) {
    const aisle_status status = self->has_base ? aisle_layout_update_step(self, units) : AISLE_ERR_CAPACITY;
    if (status != AISLE_BUSY) {
        self->phase = status == AISLE_OK ? PHASE_DONE : PHASE_CLEAR;
    }
}

aisle_status aisle_layout_build(aisle_layout *self, uint32_t units) {
    if (self->phase == PHASE_NONE) {
        return AISLE_ERR_ARG;
    }
    uint32_t left = units;
    if (do_items(self, PHASE_UPDATE, &left) && self->phase == PHASE_UPDATE) {
        update(self, &left);
    }
    const bool is_marked = self->phase > PHASE_UPDATE && do_items(self, PHASE_FIELD, &left);
    self->work += units - left;
    if (is_marked && self->phase == PHASE_FIELD && aisle_grid_build(&self->grid, left) == AISLE_OK) {
        self->phase = PHASE_DONE;
    }
    return self->phase == PHASE_DONE ? AISLE_OK : AISLE_BUSY;
}

uint32_t aisle_layout_work(const aisle_layout *self) {
    return self->work + (self->is_whole ? aisle_grid_rows_done(&self->grid) : 0U);
}
