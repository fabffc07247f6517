#include "base/pool.h"

#include "base/check.h"

#include <string.h>

static uint32_t link_of(const aisle_pool *self, uint32_t index) {
    uint32_t next;
    memcpy(&next, self->records + (size_t)index * self->stride, sizeof next);
    return next;
}

void aisle_pool_carve(aisle_pool *self, aisle_arena *arena, uint32_t capacity, uint32_t stride) {
    AISLE_ASSERT(capacity < AISLE_POOL_NONE && stride >= sizeof(uint32_t));
    *self = (aisle_pool){.stride = stride, .capacity = capacity, .free_head = AISLE_POOL_NONE};
    self->records = aisle_arena_take(arena, capacity, stride);
}

void aisle_pool_clear(aisle_pool *self) {
    self->used = 0;
    self->free_head = AISLE_POOL_NONE;
    self->untouched = 0;
}

uint32_t aisle_pool_take(aisle_pool *self) {
    uint32_t index = self->free_head;
    if (index != AISLE_POOL_NONE) {
        AISLE_ASSERT(index < self->untouched);
        self->free_head = link_of(self, index);
    } else if (self->untouched < self->capacity) {
        index = self->untouched++;
    } else {
        return AISLE_POOL_NONE;
    }
    self->used++;
    self->used_max = self->used > self->used_max ? self->used : self->used_max;
    return index;
}

void aisle_pool_give(aisle_pool *self, uint32_t index) {
    AISLE_ASSERT(index < self->untouched && self->used > 0);
    memcpy(self->records + (size_t)index * self->stride, &self->free_head, sizeof self->free_head);
    self->free_head = index;
    self->used--;
}

void *aisle_pool_at(const aisle_pool *self, uint32_t index) {
    AISLE_ASSERT(index < self->untouched);
    return self->records + (size_t)index * self->stride;
}

bool aisle_pool_invariants_hold(const aisle_pool *self) {
    if (self->stride < sizeof(uint32_t) || self->untouched > self->capacity || self->used > self->untouched ||
        self->used > self->used_max || self->used_max > self->capacity) {
        return false;
    }
    // used + free = untouched; a loop would make the chain longer than that.
    uint32_t chained = 0;
    for (uint32_t at = self->free_head; at != AISLE_POOL_NONE; at = link_of(self, at)) {
        chained++;
        if (at >= self->untouched || chained > self->untouched - self->used) {
            return false;
        }
    }
    return chained == self->untouched - self->used;
}
