#include "base/arena.h"

#include "base/check.h"

#include <string.h>

aisle_arena aisle_arena_measure(void) {
    return (aisle_arena){.base = NULL, .size = SIZE_MAX, .used = 0, .overflow = false};
}

aisle_arena aisle_arena_over(void *memory, size_t size) {
    AISLE_ASSERT(memory != NULL && (uintptr_t)memory % AISLE_ARENA_ALIGN == 0);
    memset(memory, 0, size);
    return (aisle_arena){.base = memory, .size = size, .used = 0, .overflow = false};
}

void *aisle_arena_take(aisle_arena *self, size_t count, size_t size) {
    AISLE_ASSERT(self->used <= self->size && self->used % AISLE_ARENA_ALIGN == 0);
    if (count == 0 || size == 0 || self->overflow) {
        return NULL;
    }
    // The tail is padded, not the head: used is a multiple of the alignment before and after.
    const size_t room = self->size - self->used;
    if (count > (SIZE_MAX - (AISLE_ARENA_ALIGN - 1U)) / size) {
        self->overflow = true;
        return NULL;
    }
    const size_t padded = (count * size + (AISLE_ARENA_ALIGN - 1U)) / AISLE_ARENA_ALIGN * AISLE_ARENA_ALIGN;
    if (padded > room) {
        self->overflow = true;
        return NULL;
    }
    unsigned char *piece = self->base == NULL ? NULL : self->base + self->used;
    self->used += padded;
    return piece;
}
