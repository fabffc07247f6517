// pool.h - fixed-size records behind 32-bit indices, with a free list and a high-water mark. Level 0.
//
// No pointers inside: an index stays good when the block is copied or moved. Free records chain through
// their own first 4 bytes. Time: O(1). Memory: the caller's, capacity * stride bytes.
#ifndef AISLE_BASE_POOL_H
#define AISLE_BASE_POOL_H

#include "base/arena.h"

#include <stdbool.h>
#include <stdint.h>

#define AISLE_POOL_NONE UINT32_MAX

typedef struct aisle_pool {
    unsigned char *records;
    uint32_t stride;    // bytes of a record, >= 4 and a multiple of its alignment
    uint32_t capacity;  // < AISLE_POOL_NONE
    uint32_t used;      // records out now
    uint32_t used_max;  // high-water mark since carve
    uint32_t free_head; // chain of returned records
    uint32_t untouched; // records from here on were never taken
} aisle_pool;

// Takes capacity * stride bytes from the arena (self is usable unless arena->overflow or measuring). The
// first record is aligned to AISLE_ARENA_ALIGN.
void aisle_pool_carve(aisle_pool *self, aisle_arena *arena, uint32_t capacity, uint32_t stride);

// Empties it; used_max stays.
void aisle_pool_clear(aisle_pool *self);

// Index of a record whose content is undefined; AISLE_POOL_NONE when full.
uint32_t aisle_pool_take(aisle_pool *self);

// Returns a taken record: it is the next one to be taken again. Giving one twice is the caller's error;
// invariants_hold() finds it.
void aisle_pool_give(aisle_pool *self, uint32_t index);

// The record of a taken index.
void *aisle_pool_at(const aisle_pool *self, uint32_t index);

// O(capacity): counters in order, free chain in range, no loop, its length right.
bool aisle_pool_invariants_hold(const aisle_pool *self);
#endif
