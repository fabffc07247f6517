// arena.h - carves one block into aligned pieces, or measures what they would need. Level 0.
//
// Measure and carve are one walk: the same function takes all pieces from an arena that either counts
// (base NULL: every take answers NULL) or hands out zeroed memory, so the two can never disagree.
// Memory: none of its own. Time: O(1) a take. No free: pieces live as long as the block.
#ifndef AISLE_BASE_ARENA_H
#define AISLE_BASE_ARENA_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define AISLE_ARENA_ALIGN 64U // of every piece: one cache line

typedef struct aisle_arena {
    unsigned char *base; // NULL: measuring
    size_t size;         // of the block; SIZE_MAX when measuring
    size_t used;         // so far, padding included: a multiple of AISLE_ARENA_ALIGN
    bool overflow;       // a take did not fit, or its size was not representable
} aisle_arena;

// An arena that only counts.
aisle_arena aisle_arena_measure(void);

// An arena over `memory`, which must be aligned to AISLE_ARENA_ALIGN; zeroed here, once.
aisle_arena aisle_arena_over(void *memory, size_t size);

// count * size bytes, zeroed, aligned and padded to AISLE_ARENA_ALIGN. NULL when measuring or when it does
// not fit (then overflow is set and stays, and all later takes answer NULL). A count or size of 0 takes
// nothing and answers NULL. After the same takes, `used` of a measuring and of a carving arena are equal.
void *aisle_arena_take(aisle_arena *self, size_t count, size_t size);
#endif
