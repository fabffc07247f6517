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

static uint32_t bucket_count(aisle_bucket_range r) {
    return (r.x1 - r.x0 + 1U) * (r.y1 - r.y0 + 1U);
}

static void set_side(aisle_layout_index *self, aisle_aabb bounds, double side) {
    self->lo = bounds.lo;
    self->size = aisle_vec2_sub(bounds.hi, bounds.lo);
    self->side = side;
    self->per_metre = 1.0 / side;
    self->nx = (uint32_t)(self->size.x / side) + 1U;
    self->ny = (uint32_t)(self->size.y / side) + 1U;
}

static bool do_buckets_fit(const aisle_layout_index *self) {
    return (uint64_t)self->nx * self->ny <= self->bucket_capacity;
}

static uint64_t count_entries(const aisle_layout_index *self, const aisle_layout_blocks *blocks) {
    uint64_t entries = 0;
    for (uint32_t i = 0; i < aisle_layout_blocks_count(blocks); i++) {
        entries += bucket_count(aisle_layout_index_range(self, aisle_layout_blocks_box(blocks, i)));
    }
    return entries;
}

// Ends: a single bucket lists every zone once. The finer the side the more buckets and entries, so the first that fits
// is the one half of which does not.
static void choose_side(aisle_layout_index *self, const aisle_layout_blocks *blocks, double side) {
    self->is_finer_known = false;
    for (;; side *= 2.0) {
        set_side(self, blocks->store->header.bounds, side);
        if (do_buckets_fit(self)) {
            const uint64_t entries = count_entries(self, blocks);
            if (entries <= self->entry_capacity) {
                return;
            }
            self->finer = entries;
            self->is_finer_known = true;
        }
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
    for (uint32_t i = 0; i < aisle_layout_blocks_count(blocks); i++) {
        count_block(self, aisle_layout_index_range(self, aisle_layout_blocks_box(blocks, i)));
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

// ---- one block more or less

// The index half as wide: for counts only.
static aisle_layout_index halved(const aisle_layout_index *self) {
    aisle_layout_index half = *self;
    set_side(&half, (aisle_aabb){self->lo, aisle_vec2_add(self->lo, self->size)}, 0.5 * self->side);
    return half;
}

static void count_finer(aisle_layout_index *self, aisle_aabb box, bool is_more) {
    if (self->is_finer_known) {
        const aisle_layout_index half = halved(self);
        const uint32_t entries = bucket_count(aisle_layout_index_range(&half, box));
        self->finer = is_more ? self->finer + entries : self->finer - entries;
    }
}

// Lists behind the first n buckets of the range begin n entries later, or sooner.
static void shift_starts(aisle_layout_index *self, aisle_bucket_range r, bool is_later) {
    const uint32_t buckets = self->nx * self->ny;
    uint32_t shift = 0;
    uint32_t at = 0;
    for (uint32_t y = r.y0; y <= r.y1; y++) {
        for (uint32_t x = r.x0; x <= r.x1; x++) {
            for (; at <= y * self->nx + x; at++) {
                self->starts[at] += shift;
            }
            shift += is_later ? 1U : UINT32_MAX; // modulo 2^32
        }
    }
    for (; at <= buckets; at++) {
        self->starts[at] += shift;
    }
}

static void move_entries(aisle_layout_index *self, uint32_t to, uint32_t from, uint32_t end) {
    memmove(&self->entries[to], &self->entries[from], (end - from) * sizeof *self->entries);
}

void aisle_layout_index_take_out(aisle_layout_index *self, uint32_t block, aisle_aabb box) {
    const aisle_bucket_range r = aisle_layout_index_range(self, box);
    const uint32_t entries = self->starts[self->nx * self->ny];
    uint32_t to = 0;
    uint32_t from = 0;
    for (uint32_t y = r.y0; y <= r.y1; y++) {
        for (uint32_t x = r.x0; x <= r.x1; x++) {
            uint32_t at = self->starts[y * self->nx + x];
            while (self->entries[at] != block) {
                at++;
            }
            AISLE_ASSERT(at < self->starts[y * self->nx + x + 1U]);
            move_entries(self, to, from, at);
            to += at - from;
            from = at + 1U;
        }
    }
    move_entries(self, to, from, entries);
    shift_starts(self, r, false);
    for (uint32_t i = 0; i < entries - bucket_count(r); i++) { // no branch, so that it becomes vector code
        self->entries[i] = (uint16_t)(self->entries[i] - (self->entries[i] > block ? 1U : 0U));
    }
    count_finer(self, box, false);
}

bool aisle_layout_index_put_in(aisle_layout_index *self, uint32_t block, aisle_aabb box) {
    const aisle_bucket_range r = aisle_layout_index_range(self, box);
    uint32_t end = self->starts[self->nx * self->ny];
    uint32_t shift = bucket_count(r);
    if (shift > self->entry_capacity - end) {
        return false;
    }
    for (uint32_t i = 0; i < end; i++) {
        self->entries[i] = (uint16_t)(self->entries[i] + (self->entries[i] >= block ? 1U : 0U));
    }
    for (uint32_t y = r.y1 + 1U; y-- > r.y0;) {
        for (uint32_t x = r.x1 + 1U; x-- > r.x0;) {
            uint32_t at = self->starts[y * self->nx + x + 1U];
            while (at > self->starts[y * self->nx + x] && self->entries[at - 1U] > block) {
                at--;
            }
            move_entries(self, at + shift, at, end);
            end = at;
            shift--;
            self->entries[at + shift] = (uint16_t)block;
        }
    }
    shift_starts(self, r, true);
    count_finer(self, box, true);
    return true;
}

bool aisle_layout_index_is_as_built(const aisle_layout_index *self, double side) {
    if (self->side <= side) {
        return self->side >= side;
    }
    const aisle_layout_index half = halved(self);
    return !do_buckets_fit(&half) || (self->is_finer_known && self->finer > self->entry_capacity);
}
