#include "world/id_map.h"

#include "base/check.h"

#include <string.h>

#define ID_ENTRIES_MAX (UINT32_C(1) << 30U)

void aisle_id_map_carve(aisle_id_map *self, aisle_arena *arena, uint32_t entries) {
    AISLE_ASSERT(entries >= 1U && entries <= ID_ENTRIES_MAX);
    uint32_t slots = 2;
    uint32_t shift = 31;
    while (slots < 2U * entries) {
        slots *= 2U;
        shift--;
    }
    *self = (aisle_id_map){.mask = slots - 1U, .shift = shift, .capacity = entries};
    self->slots = aisle_arena_take(arena, slots, sizeof *self->slots);
}

void aisle_id_map_clear(aisle_id_map *self) {
    memset(self->slots, 0, (self->mask + 1U) * sizeof *self->slots);
    self->count = 0;
}

// Slot that holds id, or the free one where it belongs. Ends: at least half of the slots are free.
static aisle_id_slot *slot_of(const aisle_id_map *self, int32_t id) {
    AISLE_ASSERT(id > 0);
    uint32_t at = ((uint32_t)id * UINT32_C(2654435769)) >> self->shift; // Fibonacci hashing: runs of ids spread
    while (self->slots[at].id != 0 && self->slots[at].id != id) {
        at = (at + 1U) & self->mask;
    }
    return &self->slots[at];
}

uint32_t *aisle_id_map_find(const aisle_id_map *self, int32_t id) {
    aisle_id_slot *slot = slot_of(self, id);
    return slot->id == id ? &slot->value : NULL;
}

bool aisle_id_map_add(aisle_id_map *self, int32_t id, uint32_t value) {
    aisle_id_slot *slot = slot_of(self, id);
    if (slot->id == id || self->count == self->capacity) {
        return false;
    }
    *slot = (aisle_id_slot){id, value};
    self->count++;
    return true;
}
