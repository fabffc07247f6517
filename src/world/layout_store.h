// layout_store.h - one layout at rest: header, zones, vertices, scanned cells. Level 1; part of layout.
//
// Knows what a valid polygon is, how polygons are stored and encoded for the checksum, and the bits of the scan; knows
// nothing of parts, revisions or grids. Memory: carved once. Time: O(what is touched).
#ifndef AISLE_WORLD_LAYOUT_STORE_H
#define AISLE_WORLD_LAYOUT_STORE_H

#include "aisle/messages.h"
#include "base/arena.h"
#include "world/grid.h"
#include "world/shape.h"

#include <stdbool.h>
#include <stdint.h>

#define AISLE_LAYOUT_KINDS 5 // of polygons

typedef struct aisle_zone { // one polygon of the layout
    aisle_aabb box;
    uint32_t first; // of its vertices in the store
    int32_t id;
    float value, direction;
    uint8_t n;   // 3..16
    int8_t kind; // AISLE_POLYGON_*
} aisle_zone;

typedef struct aisle_layout_header { // what every part of one revision says alike
    int32_t map_id, map_revision;
    uint32_t crc32; // of the polygons in order
    uint32_t parts, tiles, polygons;
    aisle_aabb bounds;
    double resolution; // m a cell; 0: not said
} aisle_layout_header;

typedef struct aisle_layout_store {
    aisle_layout_header header;
    aisle_lattice lattice;  // of the planning grid; w = 0: not known yet
    aisle_zone *zones;      // [zone_capacity]
    aisle_vec2 *vertices;   // [vertex_capacity]
    uint64_t *scan;         // bit iy * w + ix of the lattice set: cell occupied; meaningful if header.tiles > 0
    bool is_crc_due;        // header.crc32 was not computed yet
    uint64_t zones_content; // layout_content.h: of the zones
    uint64_t scan_content;  // and of the scan; known when the layout is built
    uint32_t zone_count, zone_capacity;
    uint32_t vertex_count, vertex_capacity;
    uint32_t of_kind[AISLE_LAYOUT_KINDS]; // zones of each AISLE_POLYGON_* kind
    uint32_t cell_capacity;
} aisle_layout_store;

void aisle_layout_store_carve(aisle_layout_store *self, aisle_arena *arena, uint32_t zones, uint32_t vertices,
                              uint32_t cells);

// A polygon one may store: id > 0, kind known, 3..16 vertices, convex, value and direction finite and in range.
bool aisle_polygon_is_valid(const aisle_polygon_msg *polygon);

// Appends a valid polygon; there must be room. O(vertices).
void aisle_layout_store_add(aisle_layout_store *self, const aisle_polygon_msg *polygon);
// Appends zones [first, end) of another store; zones_content is left to the caller.
void aisle_layout_store_add_zones(aisle_layout_store *self, const aisle_layout_store *from, uint32_t first,
                                  uint32_t end);
// Its part of zones_content. O(vertices).
uint64_t aisle_layout_store_content(const aisle_layout_store *self, const aisle_zone *zone);
// The zone as a message again, and whether it says the same as a valid polygon, bit for bit.
void aisle_layout_store_polygon(const aisle_layout_store *self, const aisle_zone *zone, aisle_polygon_msg *out);
bool aisle_layout_store_is_same(const aisle_layout_store *self, const aisle_zone *zone,
                                const aisle_polygon_msg *polygon);

// crc32 of all zones in order, as polygon_t's are encoded. O(vertices of all).
uint32_t aisle_layout_store_crc(const aisle_layout_store *self);
void aisle_layout_store_settle_crc(aisle_layout_store *self); // the header's, if it is due

// Moves zone i to place to[i], a permutation of [0, zone_count); spoils to[].
void aisle_layout_store_reorder(aisle_layout_store *self, uint16_t *to);

// All cells of the lattice occupied. O(w * h / 64).
void aisle_layout_store_fill_scan(aisle_layout_store *self);
// Frees cells [ix0, end) of row iy.
void aisle_layout_store_free_run(aisle_layout_store *self, uint32_t iy, uint32_t ix0, uint32_t end);
// Next run of occupied cells in row iy at or after *ix0 and before ix1: [*ix0, *end). False: none.
bool aisle_layout_store_run(const aisle_layout_store *self, uint32_t iy, uint32_t *ix0, uint32_t ix1, uint32_t *end);
#endif
