// layout_index.h - bucket index over the zones of a layout: which zones may lie near a box? Level 1; part of layout.
//
// Square buckets over the bounds; what lies outside belongs to the outermost ones. CSR lists of zone indices; the side
// starts at AISLE_INDEX_SIDE_MIN and is doubled until buckets and lists fit what was carved.
// Memory: 4 bytes a bucket, 2 an entry. Time: build O(doublings * zones + entries), a walk O(buckets + entries met).
#ifndef AISLE_WORLD_LAYOUT_INDEX_H
#define AISLE_WORLD_LAYOUT_INDEX_H

#include "base/arena.h"
#include "world/layout_store.h"

#define AISLE_INDEX_SIDE_MIN 0.5 // m

typedef struct aisle_layout_index {
    aisle_vec2 lo;
    double side;           // m, a power of two
    double per_metre;      // buckets: 1 / side, exactly
    uint32_t nx, ny;       // 0: empty
    bool has_speed_limits; // some zone is of kind SPEED_LIMIT
    uint32_t *starts;      // [bucket_capacity + 1] bucket b lists entries [starts[b], starts[b+1])
    uint16_t *entries;     // [entry_capacity] zone indices, rising in a bucket
    uint32_t bucket_capacity, entry_capacity;
} aisle_layout_index;

typedef struct aisle_bucket_range { // buckets [x0, x1] by [y0, y1], ends included
    uint32_t x0, y0, x1, y1;
} aisle_bucket_range;

// 4 * zones + 4096 buckets, 8 * zones + 4096 entries; zones <= 65535.
void aisle_layout_index_carve(aisle_layout_index *self, aisle_arena *arena, uint32_t zones);

// Bounds not empty and finite; at most as many zones as were carved for.
void aisle_layout_index_build(aisle_layout_index *self, const aisle_layout_store *store);

// Bucket a place belongs to; index not empty, p finite.
void aisle_layout_index_bucket(const aisle_layout_index *self, aisle_vec2 p, uint32_t *x, uint32_t *y);

// Buckets a box belongs to; index not empty, box finite.
aisle_bucket_range aisle_layout_index_range(const aisle_layout_index *self, aisle_aabb box);
#endif
