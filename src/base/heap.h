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
#define AISLE_HEAP_CAPACITY_MAX 0x7FFFFFFFU

typedef struct aisle_heap {
    uint64_t *key;   // [capacity] by item
    uint32_t *slot;  // [capacity] by item: where it stands in order[], or AISLE_HEAP_NONE
    uint32_t *order; // [capacity] the heap
    uint32_t capacity, count;
    uint32_t count_max; // high-water mark since carve
} aisle_heap;

// Takes the three arrays (16 bytes an item, each padded) and empties the heap. Items are 0 .. capacity - 1;
// capacity <= AISLE_HEAP_CAPACITY_MAX. Usable unless arena->overflow or measuring.
void aisle_heap_carve(aisle_heap *self, aisle_arena *arena, uint32_t capacity);

// Empties it; count_max stays. O(items in it).
void aisle_heap_clear(aisle_heap *self);

// Adds an item, or lowers the key of one that is in; a key not below the present one changes nothing.
// An item that was popped may come back with any key. AISLE_ERR_ARG: item >= capacity.
aisle_status aisle_heap_push(aisle_heap *self, uint32_t item, uint64_t key);

// The same for an item that is known not to be in, which push() looks up: the only one that may follow forget().
aisle_status aisle_heap_add(aisle_heap *self, uint32_t item, uint64_t key);

// Empties a heap whose arrays others have written to; what is in is then only what add() brought. O(1).
void aisle_heap_forget(aisle_heap *self);

// Removes and returns the item of least key; AISLE_HEAP_NONE when empty.
uint32_t aisle_heap_pop(aisle_heap *self);

// False for items beyond capacity, too.
bool aisle_heap_contains(const aisle_heap *self, uint32_t item);

// O(capacity): heap order, ties included, and slot[] the inverse of order[].
bool aisle_heap_invariants_hold(const aisle_heap *self);
#endif
