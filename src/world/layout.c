#include "world/layout.h"

#include "base/check.h"
#include "world/layout_content.h"
#include "world/layout_internal.h"

static uint32_t or_default(uint32_t value, uint32_t fallback) {
    return value == 0 ? fallback : value;
}

void aisle_layout_carve(aisle_layout *self, aisle_arena *arena, const aisle_limits *limits) {
    enum { PATCH_IDS = AISLE_LAYOUT_PATCH_MAX_REMOVED + AISLE_LAYOUT_PATCH_MAX_POLYGONS };
    const uint32_t cells = or_default(limits->cells, AISLE_LIMITS_CELLS_DEFAULT);
    const uint32_t zones = or_default(limits->polygons, AISLE_LIMITS_POLYGONS_DEFAULT);
    const uint32_t vertices = or_default(limits->vertices, AISLE_LIMITS_VERTICES_DEFAULT);
    *self = (aisle_layout){0};
    for (uint32_t i = 0; i < 2U; i++) {
        aisle_layout_store_carve(&self->store[i], arena, zones, vertices, cells);
    }
    aisle_layout_staging *staging = &self->staging;
    staging->tile = aisle_arena_take(arena, AISLE_LAYOUT_TILES_MAX, sizeof *staging->tile);
    staging->order = aisle_arena_take(arena, zones, sizeof *staging->order);
    aisle_id_map_carve(&staging->ids, arena, zones);
    AISLE_ASSERT(PATCH_IDS <= AISLE_LAYOUT_MAX_POLYGONS); // one map does for either message
    aisle_id_map_carve(&staging->message, arena, AISLE_LAYOUT_MAX_POLYGONS);
    self->diff.change = aisle_arena_take(arena, AISLE_LAYOUT_CHANGES_MAX, sizeof *self->diff.change);
    self->diff.everything = true;
    aisle_layout_index_carve(&self->index, arena, zones);
    aisle_layout_rects_carve(&self->rects, arena, cells);
    aisle_layout_index_carve(&self->wide, arena, zones + self->rects.capacity);
    aisle_grid_carve(&self->grid, arena, cells);
    aisle_grid_window_carve(&self->update.window, arena);
}

// ---- what is held

bool aisle_layout_is_staged(const aisle_layout *self) {
    return self->staging.stage == AISLE_STAGE_COMPLETE;
}

int32_t aisle_layout_map_id(const aisle_layout *self) {
    return self->has_active ? aisle_layout_held(self)->header.map_id : 0;
}

int32_t aisle_layout_map_revision(const aisle_layout *self) {
    return self->has_active ? aisle_layout_held(self)->header.map_revision : 0;
}

const aisle_layout_diff *aisle_layout_changes(const aisle_layout *self) {
    return &self->diff;
}

uint64_t aisle_layout_content(const aisle_layout *self) {
    AISLE_ASSERT(aisle_layout_is_in_force(self));
    const aisle_layout_store *store = aisle_layout_held(self);
    const bool has_scan = store->header.tiles > 0;
    return aisle_content_of_area(store->header.bounds, &store->lattice, has_scan) + store->zones_content +
           (has_scan ? store->scan_content : 0U);
}

const aisle_grid *aisle_layout_grid(const aisle_layout *self) {
    return &self->grid;
}

aisle_aabb aisle_layout_bounds(const aisle_layout *self) {
    const aisle_layout_store *store = aisle_layout_held(self);
    aisle_aabb area = store->header.bounds;
    if (store->header.tiles > 0) { // what lies within the bounds but off the scan is not known to be free
        const aisle_lattice *l = &store->lattice;
        area.lo = aisle_vec2_of(aisle_max(area.lo.x, l->x0), aisle_max(area.lo.y, l->y0));
        area.hi.x = aisle_min(area.hi.x, l->x0 + (double)l->w * l->res);
        area.hi.y = aisle_min(area.hi.y, l->y0 + (double)l->h * l->res);
    }
    return area;
}

uint32_t aisle_layout_zone_count(const aisle_layout *self) {
    return aisle_layout_held(self)->zone_count;
}

const aisle_zone *aisle_layout_zone(const aisle_layout *self, uint32_t index) {
    AISLE_ASSERT(index < aisle_layout_held(self)->zone_count);
    return &aisle_layout_held(self)->zones[index];
}

aisle_convex aisle_layout_zone_shape(const aisle_layout *self, const aisle_zone *zone) {
    return (aisle_convex){&aisle_layout_held(self)->vertices[zone->first], zone->n, 0.0};
}

bool aisle_layout_has_kind(const aisle_layout *self, int8_t kind) {
    AISLE_ASSERT(kind >= 0 && kind < AISLE_LAYOUT_KINDS);
    return aisle_layout_held(self)->of_kind[kind] > 0U;
}

bool aisle_layout_has_scan(const aisle_layout *self) {
    return self->has_active && aisle_layout_held(self)->header.tiles > 0;
}

bool aisle_layout_scan_run(const aisle_layout *self, uint32_t iy, uint32_t *ix0, uint32_t ix1, uint32_t *end) {
    AISLE_ASSERT(aisle_layout_has_scan(self));
    return aisle_layout_store_run(aisle_layout_held(self), iy, ix0, ix1, end);
}

// ---- blocks

static aisle_layout_blocks blocks_of(const aisle_layout *self) {
    return (aisle_layout_blocks){aisle_layout_held(self), aisle_layout_has_scan(self) ? &self->rects : NULL};
}

bool aisle_layout_has_blocks(const aisle_layout *self) {
    return !(aisle_layout_has_scan(self) && self->rects.overflow);
}

uint32_t aisle_layout_block_count(const aisle_layout *self) {
    const aisle_layout_blocks blocks = blocks_of(self);
    return aisle_layout_blocks_count(&blocks);
}

uint32_t aisle_layout_corner_count(const aisle_layout *self) {
    const aisle_layout_store *store = aisle_layout_held(self);
    return store->vertex_count + (aisle_layout_has_scan(self) ? 4U * self->rects.count : 0U);
}

aisle_aabb aisle_layout_block_box(const aisle_layout *self, uint32_t index) {
    const aisle_layout_blocks blocks = blocks_of(self);
    return aisle_layout_blocks_box(&blocks, index);
}

void aisle_layout_block_at(const aisle_layout *self, uint32_t index, aisle_layout_block *out) {
    const aisle_layout_store *store = aisle_layout_held(self);
    if (index < store->zone_count) {
        const aisle_zone *zone = &store->zones[index];
        out->shape = aisle_layout_zone_shape(self, zone);
        out->corner = zone->first;
        out->real = UINT32_MAX;
        out->is_obstacle = aisle_zone_is_obstacle(zone);
        return;
    }
    const uint32_t i = index - store->zone_count;
    const aisle_aabb box = aisle_layout_block_box(self, index);
    out->v[0] = box.lo;
    out->v[1] = aisle_vec2_of(box.hi.x, box.lo.y);
    out->v[2] = box.hi;
    out->v[3] = aisle_vec2_of(box.lo.x, box.hi.y);
    out->shape = (aisle_convex){out->v, 4U, 0.0};
    out->corner = store->vertex_count + 4U * i;
    out->real = self->rects.real[i];
    out->is_obstacle = true;
}

const aisle_layout_index *aisle_layout_wide(const aisle_layout *self) {
    return &self->wide;
}

// ---- walk

static void enter_bucket(aisle_layout_walk *walk) {
    const aisle_layout_index *index = &walk->layout->index;
    const uint32_t bucket = walk->by * index->nx + walk->bx;
    walk->at = index->starts[bucket];
    walk->end = index->starts[bucket + 1U];
}

// A walk by the list of all zones: as one bucket that holds them all.
static aisle_layout_walk walk_list(aisle_layout_walk walk) {
    walk.by = 0;
    walk.whole = true;
    walk.end = aisle_layout_held(walk.layout)->zone_count;
    return walk;
}

// Looking at a zone's box is about half as much work as entering a bucket.
static bool is_list_shorter(const aisle_layout *self, aisle_bucket_range r) {
    const uint64_t buckets = (uint64_t)(r.x1 - r.x0 + 1U) * (r.y1 - r.y0 + 1U);
    return aisle_layout_held(self)->zone_count <= 2U * buckets;
}

aisle_layout_walk aisle_layout_walk_over(const aisle_layout *self, aisle_aabb box) {
    enum { SHORT_LIST = 16 };                                       // as cheap as to ask for the buckets
    aisle_layout_walk walk = {.layout = self, .box = box, .by = 1}; // past by1: nothing to walk
    if (self->index.nx == 0 || !(box.lo.x <= box.hi.x && box.lo.y <= box.hi.y)) {
        return walk;
    }
    if (aisle_layout_held(self)->zone_count <= SHORT_LIST) {
        return walk_list(walk);
    }
    const aisle_bucket_range r = aisle_layout_index_range(&self->index, box);
    if (is_list_shorter(self, r)) {
        return walk_list(walk);
    }
    walk.bx0 = walk.bx = r.x0;
    walk.by0 = walk.by = r.y0;
    walk.bx1 = r.x1;
    walk.by1 = r.y1;
    enter_bucket(&walk);
    return walk;
}

// A zone lies in several buckets: it is reported in the first one that its range and the walk's have in common.
static bool is_first_meeting(const aisle_layout_walk *walk, const aisle_zone *zone) {
    if (walk->whole) {
        return true;
    }
    uint32_t x0, y0;
    aisle_layout_index_bucket(&walk->layout->index, zone->box.lo, &x0, &y0);
    return walk->bx == (x0 > walk->bx0 ? x0 : walk->bx0) && walk->by == (y0 > walk->by0 ? y0 : walk->by0);
}

bool aisle_layout_walk_next(aisle_layout_walk *walk, const aisle_zone **zone) {
    const aisle_zone *zones = aisle_layout_held(walk->layout)->zones;
    const uint16_t *entries = walk->whole ? NULL : walk->layout->index.entries;
    while (walk->by <= walk->by1) {
        while (walk->at < walk->end) {
            const aisle_zone *candidate = &zones[entries == NULL ? walk->at : entries[walk->at]];
            walk->at++;
            if (aisle_aabb_overlap(candidate->box, walk->box) && is_first_meeting(walk, candidate)) {
                *zone = candidate;
                return true;
            }
        }
        walk->bx = walk->bx < walk->bx1 ? walk->bx + 1U : walk->bx0;
        walk->by += walk->bx == walk->bx0 ? 1U : 0U;
        if (walk->by <= walk->by1) {
            enter_bucket(walk);
        }
    }
    return false;
}
