#include "base/check.h"
#include "world/layout_content.h"
#include "world/layout_internal.h"

enum {
    PHASE_NONE,
    PHASE_RECTS,
    PHASE_INDEX,
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

void aisle_layout_commit(aisle_layout *self) {
    AISLE_ASSERT(self->staging.stage == AISLE_STAGE_COMPLETE);
    if (!(self->staging.is_patch && self->phase == PHASE_DONE)) {
        self->diff.everything = true;
        self->diff.count = 0;
    }
    self->active = (uint8_t)(1U - self->active);
    self->has_active = true;
    self->staging.stage = AISLE_STAGE_EMPTY;
    self->phase = PHASE_RECTS;
    aisle_layout_rects_clear(&self->rects);
    self->next = 0;
}

static void mark_zone(aisle_layout *self, uint32_t i) {
    const aisle_zone *zone = aisle_layout_zone(self, i);
    if (aisle_zone_is_obstacle(zone)) {
        const aisle_convex shape = aisle_layout_zone_shape(self, zone);
        aisle_grid_mark_convex(&self->grid, &shape);
    }
}

static void mark_scan_row(aisle_layout *self, uint32_t iy) {
    const uint32_t w = self->grid.lattice.w;
    uint32_t end;
    for (uint32_t ix = 0; aisle_layout_scan_run(self, iy, &ix, w, &end); ix = end) {
        aisle_layout_active(self)->scan_content += aisle_content_of_run(iy, ix, end);
        aisle_grid_mark_run(&self->grid, iy, ix, end);
    }
}

// Cells of the outermost rows and columns that stick out of the bounds are partly outside, hence occupied.
static void mark_border(aisle_layout *self) {
    const aisle_lattice *l = &self->grid.lattice;
    const aisle_aabb bounds = aisle_layout_bounds(self);
    const double slack = AISLE_GRID_SLACK * l->res;
    const bool left = l->x0 < bounds.lo.x - slack;
    const bool right = l->x0 + (double)l->w * l->res > bounds.hi.x + slack;
    if (l->y0 < bounds.lo.y - slack) {
        aisle_grid_mark_run(&self->grid, 0, 0, l->w);
    }
    if (l->y0 + (double)l->h * l->res > bounds.hi.y + slack) {
        aisle_grid_mark_run(&self->grid, l->h - 1U, 0, l->w);
    }
    for (uint32_t iy = 0; iy < l->h; iy++) {
        aisle_grid_mark_run(&self->grid, iy, 0, left ? 1U : 0U);
        aisle_grid_mark_run(&self->grid, iy, right ? l->w - 1U : l->w, l->w);
    }
}

static void build_indices(aisle_layout *self) {
    const aisle_layout_store *store = aisle_layout_active(self);
    const aisle_layout_blocks zones = {store, NULL};
    const aisle_layout_blocks blocks = {store, aisle_layout_has_scan(self) ? &self->rects : NULL};
    const aisle_vec2 size = aisle_vec2_sub(store->header.bounds.hi, store->header.bounds.lo);
    const double share = sqrt(size.x * size.y / (double)(aisle_layout_blocks_count(&blocks) + 1U));
    aisle_layout_rects_find_corners(&self->rects, store);
    aisle_layout_index_build(&self->index, &zones, AISLE_LAYOUT_BUCKET);
    double side = AISLE_LAYOUT_BUCKET_WIDE;
    while (2.0 * side <= share) {
        side *= 2.0;
    }
    aisle_layout_index_build(&self->wide, &blocks, side);
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
    aisle_status status = AISLE_OK;
    switch (self->phase) {
    case PHASE_RECTS:
        aisle_layout_rects_add_row(&self->rects, aisle_layout_active(self), self->next);
        break;
    case PHASE_INDEX:
        build_indices(self);
        break;
    case PHASE_CLEAR:
        aisle_layout_active(self)->scan_content = 0;
        status = aisle_grid_begin(&self->grid, &aisle_layout_active(self)->lattice);
        AISLE_ASSERT(status == AISLE_OK); // checked when the layout came
        break;
    case PHASE_ZONES:
        mark_zone(self, self->next);
        break;
    case PHASE_SCAN:
        mark_scan_row(self, self->next);
        break;
    default:
        mark_border(self);
        break;
    }
}

aisle_status aisle_layout_build(aisle_layout *self, uint32_t units) {
    if (self->phase == PHASE_NONE) {
        return AISLE_ERR_ARG;
    }
    while (self->phase < PHASE_FIELD) {
        if (self->next == phase_items(self)) {
            self->next = 0;
            self->phase++;
            continue;
        }
        if (units == 0) {
            return AISLE_BUSY;
        }
        do_item(self);
        self->next++;
        units--;
    }
    if (self->phase == PHASE_FIELD && aisle_grid_build(&self->grid, units) == AISLE_OK) {
        self->phase = PHASE_DONE;
    }
    return self->phase == PHASE_DONE ? AISLE_OK : AISLE_BUSY;
}
