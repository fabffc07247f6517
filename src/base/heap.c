#include "base/heap.h"

#include "base/check.h"

static bool before(const aisle_heap *self, uint32_t a, uint32_t b) {
    return self->key[a] < self->key[b] || (self->key[a] == self->key[b] && a < b);
}

static void put(aisle_heap *self, uint32_t at, uint32_t item) {
    self->order[at] = item;
    self->slot[item] = at;
}

// Moves the item up from an empty place to where it belongs.
static void sift_up(aisle_heap *self, uint32_t at, uint32_t item) {
    while (at > 0) {
        const uint32_t parent = (at - 1) / 2;
        if (!before(self, item, self->order[parent])) {
            break;
        }
        put(self, at, self->order[parent]);
        at = parent;
    }
    put(self, at, item);
}

// Moves the item down from an empty place to where it belongs. Below 2^31 places 2 at + 1 cannot wrap.
static void sift_down(aisle_heap *self, uint32_t at, uint32_t item) {
    for (;;) {
        uint32_t child = 2 * at + 1;
        if (child >= self->count) {
            break;
        }
        if (child + 1 < self->count && before(self, self->order[child + 1], self->order[child])) {
            child++;
        }
        if (!before(self, self->order[child], item)) {
            break;
        }
        put(self, at, self->order[child]);
        at = child;
    }
    put(self, at, item);
}

void aisle_heap_carve(aisle_heap *self, aisle_arena *arena, uint32_t capacity) {
    AISLE_ASSERT(capacity <= AISLE_HEAP_CAPACITY_MAX);
    *self = (aisle_heap){.capacity = capacity};
    self->key = aisle_arena_take(arena, capacity, sizeof *self->key);
    self->slot = aisle_arena_take(arena, capacity, sizeof *self->slot);
    self->order = aisle_arena_take(arena, capacity, sizeof *self->order);
    for (uint32_t item = 0; self->order != NULL && item < capacity; item++) {
        self->slot[item] = AISLE_HEAP_NONE;
    }
}

void aisle_heap_clear(aisle_heap *self) {
    for (uint32_t at = 0; at < self->count; at++) {
        self->slot[self->order[at]] = AISLE_HEAP_NONE;
    }
    self->count = 0;
}

void aisle_heap_forget(aisle_heap *self) {
    self->count = 0;
}

aisle_status aisle_heap_add(aisle_heap *self, uint32_t item, uint64_t key) {
    if (item >= self->capacity) {
        return AISLE_ERR_ARG;
    }
    AISLE_ASSERT(self->count < self->capacity);
    self->key[item] = key;
    sift_up(self, self->count++, item);
    self->count_max = self->count > self->count_max ? self->count : self->count_max;
    return AISLE_OK;
}

aisle_status aisle_heap_push(aisle_heap *self, uint32_t item, uint64_t key) {
    if (item >= self->capacity) {
        return AISLE_ERR_ARG;
    }
    if (self->slot[item] == AISLE_HEAP_NONE) {
        AISLE_ASSERT(self->count < self->capacity);
        self->key[item] = key;
        self->count++;
        self->count_max = self->count > self->count_max ? self->count : self->count_max;
        sift_up(self, self->count - 1, item);
    } else if (key < self->key[item]) {
        self->key[item] = key;
        sift_up(self, self->slot[item], item);
    }
    return AISLE_OK;
}

uint32_t aisle_heap_pop(aisle_heap *self) {
    if (self->count == 0) {
        return AISLE_HEAP_NONE;
    }
    const uint32_t top = self->order[0];
    const uint32_t last = self->order[--self->count];
    AISLE_ASSERT(top < self->capacity && last < self->capacity);
    if (self->count > 0) {
        sift_down(self, 0, last);
    }
    self->slot[top] = AISLE_HEAP_NONE;
    return top;
}

bool aisle_heap_contains(const aisle_heap *self, uint32_t item) {
    return item < self->capacity && self->slot[item] != AISLE_HEAP_NONE;
}

bool aisle_heap_invariants_hold(const aisle_heap *self) {
    if (self->count > self->capacity || self->count > self->count_max || self->count_max > self->capacity) {
        return false;
    }
    for (uint32_t at = 0; at < self->count; at++) {
        const uint32_t item = self->order[at];
        if (item >= self->capacity || self->slot[item] != at) {
            return false;
        }
        if (at > 0 && before(self, item, self->order[(at - 1) / 2])) {
            return false;
        }
    }
    uint32_t in = 0; // no item outside the heap claims a place in it
    for (uint32_t item = 0; item < self->capacity; item++) {
        in += self->slot[item] != AISLE_HEAP_NONE;
    }
    return in == self->count;
}
