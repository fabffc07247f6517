// id_map.h - small numbers by positive id: open addressing, linear probing. Level 1.
//
// Memory: the caller's arena, 8 bytes a slot, at least 2 slots an entry, so probes stay short. Time: O(1) on average;
// ids chosen to collide cost O(entries). No removal: clear and fill again.
#ifndef AISLE_WORLD_ID_MAP_H
#define AISLE_WORLD_ID_MAP_H

#include "base/arena.h"

#include <stdbool.h>
#include <stdint.h>

typedef struct aisle_id_slot {
    int32_t id; // 0: free
    uint32_t value;
} aisle_id_slot;

typedef struct aisle_id_map {
    aisle_id_slot *slots; // [mask + 1]
    uint32_t mask;        // slots - 1, a power of two less one
    uint32_t shift;       // 32 - log2(slots): the hash is the top bits
    uint32_t count, capacity;
} aisle_id_map;

// Room for `entries` in [1, 2^30] ids.
void aisle_id_map_carve(aisle_id_map *self, aisle_arena *arena, uint32_t entries);
void aisle_id_map_clear(aisle_id_map *self); // O(slots)

// The value of id > 0, to read or change; NULL if it is not in. Valid until clear.
uint32_t *aisle_id_map_find(const aisle_id_map *self, int32_t id);

// Adds id > 0; false if it is in already (nothing changes) or the map is full.
bool aisle_id_map_add(aisle_id_map *self, int32_t id, uint32_t value);
#endif
