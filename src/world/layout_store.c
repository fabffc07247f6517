#include "world/layout_store.h"

#include "base/angle.h"
#include "base/check.h"
#include "base/crc32.h"
#include "wire/codec.h"
#include "world/layout_content.h"

#include <float.h>
#include <string.h>

#define WORD_BITS 64U

void aisle_layout_store_carve(aisle_layout_store *self, aisle_arena *arena, uint32_t zones, uint32_t vertices,
                              uint32_t cells) {
    *self = (aisle_layout_store){.zone_capacity = zones, .vertex_capacity = vertices, .cell_capacity = cells};
    self->zones = aisle_arena_take(arena, zones, sizeof *self->zones);
    self->vertices = aisle_arena_take(arena, vertices, sizeof *self->vertices);
    self->scan = aisle_arena_take(arena, cells / WORD_BITS + 1U, sizeof *self->scan);
}

// ---- polygons

static bool is_value_valid(const aisle_polygon_msg *polygon) {
    const double value = (double)polygon->value; // comparisons are written so that NaN fails
    switch (polygon->kind) {
    case AISLE_POLYGON_SPEED_LIMIT:
        return value > 0.0 && value <= (double)FLT_MAX;
    case AISLE_POLYGON_PENALTY:
        return value >= 0.0 && value <= 1.0;
    case AISLE_POLYGON_OBSTACLE:
    case AISLE_POLYGON_KEEPOUT:
    case AISLE_POLYGON_DIRECTED:
        return fabs(value) <= (double)FLT_MAX;
    default:
        return false;
    }
}

static void take_vertices(const aisle_polygon_msg *polygon, aisle_vec2 *out) {
    for (int16_t i = 0; i < polygon->num_vertices; i++) {
        out[i] = aisle_vec2_of(polygon->vertices[i][0], polygon->vertices[i][1]);
    }
}

bool aisle_polygon_is_valid(const aisle_polygon_msg *polygon) {
    if (polygon->id <= 0 || polygon->num_vertices < 3 || polygon->num_vertices > AISLE_POLYGON_MAX_VERTICES ||
        !is_value_valid(polygon) || !(fabs((double)polygon->direction) <= AISLE_ANGLE_MAX)) {
        return false;
    }
    aisle_vec2 v[AISLE_POLYGON_MAX_VERTICES];
    take_vertices(polygon, v);
    return aisle_convex_is_valid(v, (uint32_t)polygon->num_vertices, AISLE_POLYGON_MAX_VERTICES);
}

static aisle_zone *new_zone(aisle_layout_store *self, uint32_t n) {
    AISLE_ASSERT(self->zone_count < self->zone_capacity && n <= self->vertex_capacity - self->vertex_count);
    aisle_zone *zone = &self->zones[self->zone_count];
    *zone = (aisle_zone){.first = self->vertex_count, .n = (uint8_t)n};
    self->zone_count++;
    self->vertex_count += n;
    return zone;
}

void aisle_layout_store_add(aisle_layout_store *self, const aisle_polygon_msg *polygon) {
    aisle_zone *zone = new_zone(self, (uint32_t)polygon->num_vertices);
    aisle_vec2 *v = &self->vertices[zone->first];
    take_vertices(polygon, v);
    zone->id = polygon->id;
    zone->kind = polygon->kind;
    zone->value = polygon->value;
    zone->direction = polygon->direction;
    zone->box = aisle_convex_aabb(&(aisle_convex){v, zone->n, 0.0});
    self->of_kind[zone->kind]++;
    self->zones_content += aisle_layout_store_content(self, zone);
}

// Zones that came in order have their vertices in one row; others are copied one by one.
static bool are_vertices_in_row(const aisle_zone *zones, uint32_t count) {
    bool is_row = true;
    for (uint32_t i = 1; i < count; i++) {
        is_row = is_row && zones[i].first == zones[i - 1U].first + zones[i - 1U].n;
    }
    return is_row;
}

void aisle_layout_store_add_zones(aisle_layout_store *self, const aisle_layout_store *from, uint32_t first,
                                  uint32_t end) {
    AISLE_ASSERT(first < end && end <= from->zone_count && end - first <= self->zone_capacity - self->zone_count);
    const aisle_zone *old = &from->zones[first];
    aisle_zone *zones = &self->zones[self->zone_count];
    const uint32_t count = end - first;
    const uint32_t begin = self->vertex_count;
    const bool is_row = are_vertices_in_row(old, count);
    memcpy(zones, old, count * sizeof *zones);
    for (uint32_t i = 0; i < count; i++) {
        zones[i].first = self->vertex_count;
        self->vertex_count += zones[i].n;
        self->of_kind[zones[i].kind]++;
        AISLE_ASSERT(self->vertex_count <= self->vertex_capacity);
        if (!is_row) {
            memcpy(&self->vertices[zones[i].first], &from->vertices[old[i].first], zones[i].n * sizeof *self->vertices);
        }
    }
    if (is_row) {
        memcpy(&self->vertices[begin], &from->vertices[old->first],
               (self->vertex_count - begin) * sizeof *self->vertices);
    }
    self->zone_count += count;
}

uint64_t aisle_layout_store_content(const aisle_layout_store *self, const aisle_zone *zone) {
    return aisle_content_of_polygon(zone->id, zone->kind, zone->value, zone->direction, &self->vertices[zone->first],
                                    zone->n);
}

void aisle_layout_store_polygon(const aisle_layout_store *self, const aisle_zone *zone, aisle_polygon_msg *out) {
    out->id = zone->id;
    out->kind = zone->kind;
    out->value = zone->value;
    out->direction = zone->direction;
    out->num_vertices = zone->n;
    for (uint32_t i = 0; i < zone->n; i++) {
        const aisle_vec2 v = self->vertices[zone->first + i];
        out->vertices[i][0] = v.x;
        out->vertices[i][1] = v.y;
    }
}

bool aisle_layout_store_is_same(const aisle_layout_store *self, const aisle_zone *zone,
                                const aisle_polygon_msg *polygon) {
    aisle_polygon_msg held;
    aisle_layout_store_polygon(self, zone, &held);
    return held.id == polygon->id && held.kind == polygon->kind && held.num_vertices == polygon->num_vertices &&
           memcmp(&held.value, &polygon->value, sizeof held.value) == 0 &&
           memcmp(&held.direction, &polygon->direction, sizeof held.direction) == 0 &&
           memcmp(held.vertices, polygon->vertices, zone->n * sizeof held.vertices[0]) == 0;
}

uint32_t aisle_layout_store_crc(const aisle_layout_store *self) {
    uint32_t crc = 0;
    for (uint32_t i = 0; i < self->zone_count; i++) {
        aisle_polygon_msg polygon;
        uint8_t bytes[sizeof polygon];
        size_t size = 0;
        aisle_layout_store_polygon(self, &self->zones[i], &polygon);
        const aisle_status status = aisle_msg_encode_body(AISLE_MSG_POLYGON, &polygon, bytes, sizeof bytes, &size);
        AISLE_ASSERT(status == AISLE_OK); // valid when it was stored
        crc = aisle_crc32(crc, bytes, size);
    }
    return crc;
}

void aisle_layout_store_settle_crc(aisle_layout_store *self) {
    if (self->is_crc_due) {
        self->header.crc32 = aisle_layout_store_crc(self);
        self->is_crc_due = false;
    }
}

void aisle_layout_store_reorder(aisle_layout_store *self, uint16_t *to) {
    for (uint32_t i = 0; i < self->zone_count; i++) {
        while (to[i] != i) { // every swap brings one zone home
            const uint16_t home = to[i];
            const aisle_zone swap = self->zones[home];
            self->zones[home] = self->zones[i];
            self->zones[i] = swap;
            to[i] = to[home];
            to[home] = home;
        }
    }
}

// ---- scanned cells

void aisle_layout_store_fill_scan(aisle_layout_store *self) {
    const uint32_t cells = self->lattice.w * self->lattice.h;
    AISLE_ASSERT(cells <= self->cell_capacity);
    memset(self->scan, 0xFF, (cells / WORD_BITS + 1U) * sizeof *self->scan);
}

void aisle_layout_store_free_run(aisle_layout_store *self, uint32_t iy, uint32_t ix0, uint32_t end) {
    AISLE_ASSERT(iy < self->lattice.h && ix0 <= end && end <= self->lattice.w);
    const uint32_t row = iy * self->lattice.w;
    for (uint32_t bit = row + ix0; bit < row + end;) {
        const uint32_t shift = bit % WORD_BITS;
        const uint32_t left = row + end - bit;
        const uint32_t n = left < WORD_BITS - shift ? left : WORD_BITS - shift;
        self->scan[bit / WORD_BITS] &= ~((UINT64_MAX >> (WORD_BITS - n)) << shift);
        bit += n;
    }
}

static uint32_t trailing_zeros(uint64_t word) { // of a word that is not 0
    uint32_t n = 0;
    for (uint32_t half = WORD_BITS / 2U; half > 0; half /= 2U) {
        if ((word & (UINT64_MAX >> (WORD_BITS - half))) == 0) {
            word >>= half;
            n += half;
        }
    }
    return n;
}

// First bit in [from, end) that is set, or clear where flip is all ones; `end` if there is none.
static uint32_t next_bit(const uint64_t *words, uint32_t from, uint32_t end, uint64_t flip) {
    while (from < end) {
        const uint32_t shift = from % WORD_BITS;
        const uint64_t word = (words[from / WORD_BITS] ^ flip) >> shift;
        if (word != 0) {
            const uint32_t at = from + trailing_zeros(word);
            return at < end ? at : end;
        }
        from += WORD_BITS - shift;
    }
    return end;
}

bool aisle_layout_store_run(const aisle_layout_store *self, uint32_t iy, uint32_t *ix0, uint32_t ix1, uint32_t *end) {
    AISLE_ASSERT(iy < self->lattice.h && ix1 <= self->lattice.w);
    if (*ix0 >= ix1) {
        return false;
    }
    const uint32_t row = iy * self->lattice.w;
    const uint32_t first = next_bit(self->scan, row + *ix0, row + ix1, 0);
    *ix0 = first - row;
    *end = next_bit(self->scan, first, row + ix1, UINT64_MAX) - row;
    return *ix0 < ix1;
}
