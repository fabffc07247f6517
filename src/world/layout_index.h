// layout_index.h - bucket index over the blocks of a layout: which ones may lie near a box? Level 1; part of layout.
//
// Blocks are the zones, and behind them, where asked for, the rectangles of the scan.
//
// Square buckets over the bounds; what lies outside belongs to the outermost ones. CSR lists of block indices; the side
// starts where the caller wishes and is doubled until buckets and lists fit what was carved.
// Memory: 4 bytes a bucket, 2 an entry. Time: build O(doublings * blocks + entries), a walk O(buckets + entries met).
#ifndef AISLE_WORLD_LAYOUT_INDEX_H
#define AISLE_WORLD_LAYOUT_INDEX_H

#include "base/arena.h"
#include "world/layout_rects.h"

typedef struct aisle_layout_index {
    aisle_vec2 lo;
    aisle_vec2 size;   // m, of the bounds
    double side;       // m, a power of two
    double per_metre;  // buckets: 1 / side, exactly
    uint32_t nx, ny;   // 0: empty
    uint32_t *starts;  // [bucket_capacity + 1] bucket b lists entries [starts[b], starts[b+1])
    uint16_t *entries; // [entry_capacity] block indices, rising in a bucket
    uint32_t bucket_capacity, entry_capacity;
    uint64_t finer;      // entries half the side would need
    bool is_finer_known; // it was tried and they were too many
} aisle_layout_index;

typedef struct aisle_bucket_range { // buckets [x0, x1] by [y0, y1], ends included
    uint32_t x0, y0, x1, y1;
} aisle_bucket_range;

typedef struct aisle_layout_blocks {
    const aisle_layout_store *store; // its zones
    const aisle_layout_rects *rects; // and these; NULL: none
} aisle_layout_blocks;

uint32_t aisle_layout_blocks_count(const aisle_layout_blocks *self);
aisle_aabb aisle_layout_blocks_box(const aisle_layout_blocks *self, uint32_t index);

// 4 * blocks + 4096 buckets, 8 * blocks + 4096 entries; blocks <= 65535.
void aisle_layout_index_carve(aisle_layout_index *self, aisle_arena *arena, uint32_t blocks);

// Over the store's bounds, which are not empty and finite; at most as many blocks as were carved for; side (m), a power of two, of
// the buckets if they fit.
void aisle_layout_index_build(aisle_layout_index *self, const aisle_layout_blocks *blocks, double side);

// A block less, or one more at this place of the order: those behind it move up or down by one. box: the block's. False:
// there is no room, and the index is worth nothing until built. O(entries + buckets), a few us.
void aisle_layout_index_take_out(aisle_layout_index *self, uint32_t block, aisle_aabb box);
bool aisle_layout_index_put_in(aisle_layout_index *self, uint32_t block, aisle_aabb box);
// After such edits: the index is, to the last entry, what build() would make with this side. If not, build it. O(1).
bool aisle_layout_index_is_as_built(const aisle_layout_index *self, double side);

// Bucket a place belongs to; index not empty, p finite.
void aisle_layout_index_bucket(const aisle_layout_index *self, aisle_vec2 p, uint32_t *x, uint32_t *y);

// Buckets a box belongs to; index not empty, box finite.
aisle_bucket_range aisle_layout_index_range(const aisle_layout_index *self, aisle_aabb box);
#endif
