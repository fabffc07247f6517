// layout_index.h - bucket index over the zones of a layout: which zones may lie near a box? Level 1; part of layout.
//
// Square buckets over the bounds; what lies outside belongs to the outermost ones. CSR lists of zone indices; the side
// starts where the caller wishes and is doubled until buckets and lists fit what was carved.
// Memory: 4 bytes a bucket, 2 an entry. Time: build O(doublings * zones + entries), a walk O(buckets + entries met).
#ifndef AISLE_WORLD_LAYOUT_INDEX_H
#define AISLE_WORLD_LAYOUT_INDEX_H

#include "base/arena.h"
#include "world/layout_store.h"

typedef struct aisle_layout_index {
    aisle_vec2 lo;
    double side;       // m
    uint32_t nx, ny;   // 0: empty
    uint32_t *starts;  // [bucket_capacity + 1] bucket b lists entries [starts[b], starts[b+1])
    uint16_t *entries; // [entry_capacity] zone indices, rising in a bucket
    uint32_t bucket_capacity, entry_capacity;
} aisle_layout_index;

typedef struct aisle_bucket_range { // buckets [x0, x1] by [y0, y1], ends included
    uint32_t x0, y0, x1, y1;
} aisle_bucket_range;

// 4 * zones + 4096 buckets, 8 * zones + 4096 entries; zones <= 65535.
void aisle_layout_index_carve(aisle_layout_index *self, aisle_arena *arena, uint32_t zones);

// Bounds not empty and finite; at most as many zones as were carved for; side (m) > 0, of the buckets if they fit.
void aisle_layout_index_build(aisle_layout_index *self, const aisle_layout_store *store, double side);

// Buckets a box belongs to; index not empty, box finite.
aisle_bucket_range aisle_layout_index_range(const aisle_layout_index *self, aisle_aabb box);
#endif
