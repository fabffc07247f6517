#include "world/layout_rects.h"

#include "base/check.h"

void aisle_layout_rects_carve(aisle_layout_rects *self, aisle_arena *arena, uint32_t cells) {
    uint32_t capacity = cells / 64U < AISLE_LAYOUT_RECTS_MAX ? cells / 64U : AISLE_LAYOUT_RECTS_MAX;
    uint32_t columns = cells < AISLE_GRID_SIDE_MAX ? cells : AISLE_GRID_SIDE_MAX;
    *self = (aisle_layout_rects){.capacity = capacity};
    self->rect = (aisle_layout_rect *)aisle_arena_take(arena, capacity, sizeof *self->rect);
    self->real = (uint8_t *)aisle_arena_take(arena, capacity, 1U);
    self->open = (uint16_t *)aisle_arena_take(arena, columns, sizeof *self->open);
}

void aisle_layout_rects_clear(aisle_layout_rects *self) {
    self->count = 0;
    self->overflow = false;
}

// The rectangle of the row below that a run goes on, if there is one. open[] may be of any age: the rectangle tells.
static aisle_layout_rect *below(aisle_layout_rects *self, uint32_t iy, uint32_t x0, uint32_t end) {
    uint32_t i = self->open[x0];
    if (i >= self->count) {
        return NULL;
    }
    aisle_layout_rect *rect = &self->rect[i];
    return rect->x0 == x0 && rect->x1 == end && rect->y1 == iy ? rect : NULL;
}

void aisle_layout_rects_add_row(aisle_layout_rects *self, const aisle_layout_store *store, uint32_t iy) {
    uint32_t end;
    for (uint32_t x0 = 0; aisle_layout_store_run(store, iy, &x0, store->lattice.w, &end); x0 = end) {
        aisle_layout_rect *rect = below(self, iy, x0, end);
        if (rect != NULL) {
            rect->y1++;
            continue;
        }
        if (self->count == self->capacity) {
            self->overflow = true;
            return;
        }
        self->open[x0] = (uint16_t)self->count;
        self->rect[self->count++] = (aisle_layout_rect){(uint16_t)x0, (uint16_t)iy, (uint16_t)end, (uint16_t)(iy + 1U)};
    }
}

static bool is_free(const aisle_layout_store *store, int64_t x, int64_t y) {
    if (x < 0 || y < 0 || x >= (int64_t)store->lattice.w || y >= (int64_t)store->lattice.h) {
        return false;
    }
    uint32_t ix = (uint32_t)x;
    uint32_t end;
    return !aisle_layout_store_run(store, (uint32_t)y, &ix, ix + 1U, &end);
}

void aisle_layout_rects_find_corners(aisle_layout_rects *self, const aisle_layout_store *store) {
    for (uint32_t i = 0; i < self->count; i++) {
        const aisle_layout_rect *rect = &self->rect[i];
        const int64_t x[4] = {rect->x0, rect->x1 - 1, rect->x1 - 1, rect->x0}; // the cell in each corner
        const int64_t y[4] = {rect->y0, rect->y0, rect->y1 - 1, rect->y1 - 1};
        uint32_t real = 0;
        for (uint32_t k = 0; k < 4U; k++) {
            const int64_t aside = k == 0U || k == 3U ? x[k] - 1 : x[k] + 1;
            const int64_t beyond = k < 2U ? y[k] - 1 : y[k] + 1;
            real |= is_free(store, aside, y[k]) && is_free(store, x[k], beyond) ? 1U << k : 0U;
        }
        self->real[i] = (uint8_t)real;
    }
}
