#include "world/layout_index.h"

#include "base/check.h"

#include <string.h>

void aisle_layout_index_carve(aisle_layout_index *self, aisle_arena *arena, uint32_t blocks) {
    AISLE_ASSERT(blocks <= UINT16_MAX);
    *self = (aisle_layout_index){.bucket_capacity = 4U * blocks + 4096U, .entry_capacity = 8U * blocks + 4096U};
    self->starts = aisle_arena_take(arena, self->bucket_capacity + 1U, sizeof *self->starts);
    self->entries = aisle_arena_take(arena, self->entry_capacity, sizeof *self->entries);
}

uint32_t aisle_layout_blocks_count(const aisle_layout_blocks *self) {
    return self->store->zone_count + (self->rects != NULL ? self->rects->count : 0U);
}

aisle_aabb aisle_layout_blocks_box(const aisle_layout_blocks *self, uint32_t index) {
    if (index < self->store->zone_count) {
        return self->store->zones[index].box;
    }
    const aisle_lattice *l = &self->store->lattice;
    const aisle_layout_rect *r = &self->rects->rect[index - self->store->zone_count];
    return (aisle_aabb){{l->x0 + r->x0 * l->res, l->y0 + r->y0 * l->res},
                        {l->x0 + r->x1 * l->res, l->y0 + r->y1 * l->res}};
}

static uint32_t bucket_along(double offset, double per_metre, uint32_t n) {
    const double at = offset * per_metre;
    if (!(at > 0.0)) {
        return 0;
    }
    return at < (double)n ? (uint32_t)at : n - 1U;
}

void aisle_layout_index_bucket(const aisle_layout_index *self, aisle_vec2 p, uint32_t *x, uint32_t *y) {
    AISLE_ASSERT(self->nx > 0);
    *x = bucket_along(p.x - self->lo.x, self->per_metre, self->nx);
    *y = bucket_along(p.y - self->lo.y, self->per_metre, self->ny);
}

aisle_bucket_range aisle_layout_index_range(const aisle_layout_index *self, aisle_aabb box) {
    aisle_bucket_range r;
    aisle_layout_index_bucket(self, box.lo, &r.x0, &r.y0);
    aisle_layout_index_bucket(self, box.hi, &r.x1, &r.y1);
    return r;
}

static bool do_lists_fit(const aisle_layout_index *self, const aisle_layout_blocks *blocks) {
    uint64_t entries = 0;
    for (uint32_t i = 0; i < aisle_layout_blocks_count(blocks); i++) {
        const aisle_bucket_range r = aisle_layout_index_range(self, aisle_layout_blocks_box(blocks, i));
        entries += (uint64_t)(r.x1 - r.x0 + 1U) * (r.y1 - r.y0 + 1U);
    }
    return entries <= self->entry_capacity;
}

// Ends: a single bucket lists every zone once.
static void choose_side(aisle_layout_index *self, const aisle_layout_blocks *blocks, double side) {
    const aisle_aabb bounds = blocks->store->header.bounds;
    self->lo = bounds.lo;
    self->side = side;
    for (;;) {
        self->per_metre = 1.0 / self->side;
        self->nx = (uint32_t)((bounds.hi.x - bounds.lo.x) / self->side) + 1U;
        self->ny = (uint32_t)((bounds.hi.y - bounds.lo.y) / self->side) + 1U;
        if ((uint64_t)self->nx * self->ny <= self->bucket_capacity && do_lists_fit(self, blocks)) {
            return;
        }
        self->side *= 2.0;
    }
}

static void count_block(aisle_layout_index *self, aisle_bucket_range r) {
    for (uint32_t y = r.y0; y <= r.y1; y++) {
        for (uint32_t x = r.x0; x <= r.x1; x++) {
            self->starts[y * self->nx + x]++;
        }
    }
}

static void list_block(aisle_layout_index *self, aisle_bucket_range r, uint16_t block) {
    for (uint32_t y = r.y0; y <= r.y1; y++) {
        for (uint32_t x = r.x0; x <= r.x1; x++) {
            uint32_t *start = &self->starts[y * self->nx + x];
            (*start)--;
            self->entries[*start] = block;
        }
    }
}

void aisle_layout_index_build(aisle_layout_index *self, const aisle_layout_blocks *blocks, double side) {
    AISLE_ASSERT(self->entry_capacity >= aisle_layout_blocks_count(blocks));
    choose_side(self, blocks, side);
    const uint32_t buckets = self->nx * self->ny;
    memset(self->starts, 0, (buckets + 1U) * sizeof *self->starts);
    self->has_speed_limits = false;
    for (uint32_t i = 0; i < aisle_layout_blocks_count(blocks); i++) {
        count_block(self, aisle_layout_index_range(self, aisle_layout_blocks_box(blocks, i)));
    }
    for (uint32_t i = 0; i < blocks->store->zone_count; i++) {
        self->has_speed_limits = self->has_speed_limits || blocks->store->zones[i].kind == AISLE_POLYGON_SPEED_LIMIT;
    }
    for (uint32_t b = 1; b <= buckets;
         b++) { // now starts[b] is where b ends, and filling backwards moves it to its start
        self->starts[b] += self->starts[b - 1U];
    }
    for (uint32_t i = aisle_layout_blocks_count(blocks); i-- > 0U;) {
        list_block(self, aisle_layout_index_range(self, aisle_layout_blocks_box(blocks, i)), (uint16_t)i);
    }
    AISLE_ASSERT(self->starts[0] == 0 && self->starts[buckets] <= self->entry_capacity);
}
