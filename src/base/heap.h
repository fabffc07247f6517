// heap.h - binary min-heap of item indices with decrease-key. Level 0.
//
// Keys are uint64 (compose cost and tie-break: equal keys leave in order of item index). Memory: the
// caller's, three arrays of `capacity`. Time: O(log n) push, pop, decrease; O(1) contains.
#ifndef AISLE_BASE_HEAP_H
#define AISLE_BASE_HEAP_H

#include "aisle/status.h"
#include "base/arena.h"

#include <stdbool.h>
#include <stdint.h>

#define AISLE_HEAP_NONE UINT32_MAX

typedef struct aisle_heap {
    uint64_t *key;   // [capacity] by item
    uint32_t *slot;  // [capacity] by item: where it stands in order[], or AISLE_HEAP_NONE
    uint32_t *order; // [capacity] the heap
    uint32_t capacity, count, count_max;
} aisle_heap;

void aisle_heap_carve(aisle_heap *self, aisle_arena *arena, uint32_t capacity);
void aisle_heap_clear(aisle_heap *self); // O(capacity)

// Adds an item, or lowers the key of one that is in; a key not below the present one changes nothing.
// AISLE_ERR_ARG: item >= capacity.
aisle_status aisle_heap_push(aisle_heap *self, uint32_t item, uint64_t key);

// Removes and returns the item of least key; AISLE_HEAP_NONE when empty.
uint32_t aisle_heap_pop(aisle_heap *self);

bool aisle_heap_contains(const aisle_heap *self, uint32_t item);
bool aisle_heap_invariants_hold(const aisle_heap *self); // O(capacity)
#endif
