#include "world/layout_index.h"

#include "base/check.h"

#include <string.h>

void aisle_layout_index_carve(aisle_layout_index *self, aisle_arena *arena, uint32_t zones) {
    AISLE_ASSERT(zones <= UINT16_MAX);
    *self = (aisle_layout_index){.bucket_capacity = 4U * zones + 4096U, .entry_capacity = 8U * zones + 4096U};
    self->starts = aisle_arena_take(arena, self->bucket_capacity + 1U, sizeof *self->starts);
    self->entries = aisle_arena_take(arena, self->entry_capacity, sizeof *self->entries);
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

static bool do_lists_fit(const aisle_layout_index *self, const aisle_layout_store *store) {
    uint64_t entries = 0;
    for (uint32_t i = 0; i < store->zone_count; i++) {
        const aisle_bucket_range r = aisle_layout_index_range(self, store->zones[i].box);
        entries += (uint64_t)(r.x1 - r.x0 + 1U) * (r.y1 - r.y0 + 1U);
    }
    return entries <= self->entry_capacity;
}

// Ends: a single bucket lists every zone once.
static void choose_side(aisle_layout_index *self, const aisle_layout_store *store) {
    const aisle_aabb bounds = store->header.bounds;
    self->lo = bounds.lo;
    self->side = AISLE_INDEX_SIDE_MIN;
    for (;;) {
        self->per_metre = 1.0 / self->side;
        self->nx = (uint32_t)((bounds.hi.x - bounds.lo.x) / self->side) + 1U;
        self->ny = (uint32_t)((bounds.hi.y - bounds.lo.y) / self->side) + 1U;
        if ((uint64_t)self->nx * self->ny <= self->bucket_capacity && do_lists_fit(self, store)) {
            return;
        }
        self->side *= 2.0;
    }
}

static void count_zone(aisle_layout_index *self, aisle_bucket_range r) {
    for (uint32_t y = r.y0; y <= r.y1; y++) {
        for (uint32_t x = r.x0; x <= r.x1; x++) {
            self->starts[y * self->nx + x]++;
        }
    }
}

static void list_zone(aisle_layout_index *self, aisle_bucket_range r, uint16_t zone) {
    for (uint32_t y = r.y0; y <= r.y1; y++) {
        for (uint32_t x = r.x0; x <= r.x1; x++) {
            uint32_t *start = &self->starts[y * self->nx + x];
            (*start)--;
            self->entries[*start] = zone;
        }
    }
}

void aisle_layout_index_build(aisle_layout_index *self, const aisle_layout_store *store) {
    AISLE_ASSERT(self->entry_capacity >= store->zone_count);
    choose_side(self, store);
    const uint32_t buckets = self->nx * self->ny;
    memset(self->starts, 0, (buckets + 1U) * sizeof *self->starts);
    self->has_speed_limits = false;
    for (uint32_t i = 0; i < store->zone_count; i++) {
        count_zone(self, aisle_layout_index_range(self, store->zones[i].box));
        self->has_speed_limits = self->has_speed_limits || store->zones[i].kind == AISLE_POLYGON_SPEED_LIMIT;
    }
    for (uint32_t b = 1; b <= buckets;
         b++) { // now starts[b] is where b ends, and filling backwards moves it to its start
        self->starts[b] += self->starts[b - 1U];
    }
    for (uint32_t i = store->zone_count; i-- > 0U;) {
        list_zone(self, aisle_layout_index_range(self, store->zones[i].box), (uint16_t)i);
    }
    AISLE_ASSERT(self->starts[0] == 0 && self->starts[buckets] <= self->entry_capacity);
}
