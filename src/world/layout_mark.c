#include "world/layout_mark.h"

#include "world/layout_internal.h"

void aisle_layout_mark_zone(aisle_layout *self, const aisle_zone *zone, aisle_cells in) {
    if (aisle_zone_is_obstacle(zone)) {
        const aisle_convex shape = aisle_layout_zone_shape(self, zone);
        aisle_grid_mark_convex_in(&self->grid, &shape, in);
    }
}

void aisle_layout_mark_scan(aisle_layout *self, aisle_cells in) {
    if (!aisle_layout_has_scan(self)) {
        return;
    }
    for (uint32_t iy = (uint32_t)in.y0; iy < (uint32_t)in.y1; iy++) {
        uint32_t end;
        for (uint32_t ix = (uint32_t)in.x0; aisle_layout_scan_run(self, iy, &ix, (uint32_t)in.x1, &end); ix = end) {
            aisle_grid_mark_run(&self->grid, iy, ix, end);
        }
    }
}

// Cells of the outermost rows and columns that stick out of the bounds are partly outside, hence occupied.
void aisle_layout_mark_border(aisle_layout *self, aisle_cells in) {
    const aisle_lattice *l = &self->grid.lattice;
    const aisle_aabb bounds = aisle_layout_bounds(self);
    const double slack = AISLE_GRID_SLACK * l->res;
    const bool left = in.x0 == 0 && l->x0 < bounds.lo.x - slack;
    const bool right = in.x1 == (int32_t)l->w && l->x0 + (double)l->w * l->res > bounds.hi.x + slack;
    const bool bottom = l->y0 < bounds.lo.y - slack;
    const bool top = l->y0 + (double)l->h * l->res > bounds.hi.y + slack;
    for (uint32_t iy = (uint32_t)in.y0; iy < (uint32_t)in.y1; iy++) {
        if ((bottom && iy == 0) || (top && iy == l->h - 1U)) {
            aisle_grid_mark_run(&self->grid, iy, (uint32_t)in.x0, (uint32_t)in.x1);
        }
        aisle_grid_mark_run(&self->grid, iy, 0, left ? 1U : 0U);
        aisle_grid_mark_run(&self->grid, iy, right ? l->w - 1U : l->w, l->w);
    }
}

void aisle_layout_mark_all(aisle_layout *self, aisle_cells in) {
    const aisle_lattice *l = &self->grid.lattice; // a cell more to each side: marks have slack
    const aisle_aabb box = {{l->x0 + (in.x0 - 1) * l->res, l->y0 + (in.y0 - 1) * l->res},
                            {l->x0 + (in.x1 + 1) * l->res, l->y0 + (in.y1 + 1) * l->res}};
    const aisle_zone *zone;
    for (aisle_layout_walk walk = aisle_layout_walk_over(self, box); aisle_layout_walk_next(&walk, &zone);) {
        aisle_layout_mark_zone(self, zone, in);
    }
    aisle_layout_mark_scan(self, in);
    aisle_layout_mark_border(self, in);
}
