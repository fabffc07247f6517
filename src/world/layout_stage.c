#include "base/check.h"
#include "world/layout_internal.h"

#include <string.h>

aisle_status aisle_layout_refuse(aisle_refusal *why, int16_t cause, int32_t id, double value) {
    *why = (aisle_refusal){cause, id, (float)value};
    return AISLE_ERR_DATA;
}

// ---- revisions

static bool is_of(const aisle_layout_header *header, int32_t map_id) {
    return header->map_id == map_id;
}

aisle_layout_relation aisle_layout_relate(aisle_layout *self, int32_t map_id, int32_t map_revision) {
    const aisle_layout_header *staged = &aisle_layout_staged(self)->header;
    const aisle_layout_header *active = &aisle_layout_active(self)->header;
    const bool same_as_staged = self->staging.stage != AISLE_STAGE_EMPTY && is_of(staged, map_id);
    const bool same_as_active = self->has_active && is_of(active, map_id);
    if (same_as_staged && staged->map_revision == map_revision) {
        return AISLE_RELATION_STAGED;
    }
    if (same_as_active && active->map_revision == map_revision) {
        return AISLE_RELATION_ACTIVE;
    }
    const bool is_older = (same_as_staged && map_revision < staged->map_revision) ||
                          (same_as_active && map_revision < active->map_revision);
    return is_older ? AISLE_RELATION_OUTDATED : AISLE_RELATION_NEW;
}

int32_t aisle_layout_newest(aisle_layout *self, int32_t map_id) {
    const aisle_layout_header *staged = &aisle_layout_staged(self)->header;
    if (self->staging.stage != AISLE_STAGE_EMPTY && is_of(staged, map_id)) {
        return staged->map_revision; // taken only if newer than the active one
    }
    return aisle_layout_map_revision(self);
}

// ---- the header

static bool is_near(double a, double b) {
    return fabs(a - b) <= 1e-9;
}

bool aisle_layout_read_resolution(float wire, double *out) {
    const double as_is = (double)wire;
    if (!(as_is >= 0.5 * AISLE_LAYOUT_RESOLUTION_MIN && as_is <= 2.0 * AISLE_LAYOUT_RESOLUTION_MAX)) {
        return false;
    }
    const double rounded = floor(as_is * 1e6 + 0.5) / 1e6;
    *out = fabs(rounded - as_is) <= as_is * 6e-8 ? rounded : as_is; // half an ulp of a float is 5.96e-8 at most
    return *out >= AISLE_LAYOUT_RESOLUTION_MIN && *out <= AISLE_LAYOUT_RESOLUTION_MAX;
}

static bool are_bounds_valid(const aisle_layout_msg *msg) { // written so that NaN fails
    return msg->x_min < msg->x_max && msg->y_min < msg->y_max && msg->x_min >= -AISLE_SHAPE_COORD_MAX &&
           msg->y_min >= -AISLE_SHAPE_COORD_MAX && msg->x_max <= AISLE_SHAPE_COORD_MAX &&
           msg->y_max <= AISLE_SHAPE_COORD_MAX;
}

static bool are_counts_valid(const aisle_layout_msg *msg) {
    return msg->num_parts >= 1 && msg->num_parts <= AISLE_LAYOUT_MAX_PARTS && msg->part >= 0 &&
           msg->part < msg->num_parts && msg->num_polygons >= 0 && msg->num_polygons <= AISLE_LAYOUT_MAX_POLYGONS &&
           msg->total_polygons >= msg->num_polygons && msg->num_grid_chunks >= 0;
}

static bool read_header(const aisle_layout_msg *msg, aisle_layout_header *out) {
    double resolution = 0.0;
    const bool is_given = msg->resolution < 0.0F || msg->resolution > 0.0F || isnan(msg->resolution);
    if (!are_counts_valid(msg) || !are_bounds_valid(msg) ||
        (is_given && !aisle_layout_read_resolution(msg->resolution, &resolution))) {
        return false;
    }
    *out = (aisle_layout_header){.map_id = msg->map_id,
                                 .map_revision = msg->map_revision,
                                 .crc32 = (uint32_t)msg->crc32,
                                 .parts = (uint32_t)msg->num_parts,
                                 .tiles = (uint32_t)msg->num_grid_chunks,
                                 .polygons = (uint32_t)msg->total_polygons,
                                 .bounds = {{msg->x_min, msg->y_min}, {msg->x_max, msg->y_max}},
                                 .resolution = resolution};
    return true;
}

static bool is_same_content(aisle_layout_store *store, const aisle_layout_header *b) {
    aisle_layout_store_settle_crc(store);
    const aisle_layout_header *a = &store->header;
    return a->crc32 == b->crc32 && a->tiles == b->tiles && a->polygons == b->polygons &&
           memcmp(&a->bounds, &b->bounds, sizeof a->bounds) == 0 && is_near(a->resolution, b->resolution);
}

bool aisle_layout_check_lattice(const aisle_layout *self, const aisle_lattice *lattice, aisle_refusal *why) {
    const uint32_t side = lattice->w > lattice->h ? lattice->w : lattice->h;
    const double cells = (double)lattice->w * (double)lattice->h;
    if (cells > (double)self->grid.capacity) {
        (void)aisle_layout_refuse(why, AISLE_STATUS_LIMIT, AISLE_LAYOUT_LIMIT_CELLS, cells);
        return false;
    }
    if (side > AISLE_GRID_SIDE_MAX) {
        (void)aisle_layout_refuse(why, AISLE_STATUS_LIMIT, AISLE_LAYOUT_LIMIT_SIDE, (double)side);
        return false;
    }
    return true;
}

// The lattice of a layout without a scan; with one it is known with the first tile. False: *why.
static bool choose_lattice(const aisle_layout *self, const aisle_layout_header *header, aisle_lattice *out,
                           aisle_refusal *why) {
    *out = (aisle_lattice){0};
    if (header->tiles > 0) {
        return true;
    }
    const bool is_given = header->resolution > 0.0;
    double res = is_given ? header->resolution : AISLE_LAYOUT_RESOLUTION_DEFAULT;
    (void)aisle_lattice_over(header->bounds.lo, header->bounds.hi, res, out);
    while (!is_given && !aisle_layout_check_lattice(self, out, why)) { // ends: at last one cell holds the bounds
        res *= 2.0;
        (void)aisle_lattice_over(header->bounds.lo, header->bounds.hi, res, out);
    }
    *why = (aisle_refusal){0};
    return aisle_layout_check_lattice(self, out, why);
}

static bool check_limits(const aisle_layout *self, const aisle_layout_header *header, aisle_lattice *lattice,
                         aisle_refusal *why) {
    const aisle_layout_store *store = aisle_layout_held(self);
    if (header->polygons > store->zone_capacity) {
        (void)aisle_layout_refuse(why, AISLE_STATUS_LIMIT, AISLE_LAYOUT_LIMIT_POLYGONS, (double)header->polygons);
        return false;
    }
    if (header->tiles > AISLE_LAYOUT_TILES_MAX) {
        (void)aisle_layout_refuse(why, AISLE_STATUS_LIMIT, AISLE_LAYOUT_LIMIT_TILES, (double)header->tiles);
        return false;
    }
    return choose_lattice(self, header, lattice, why);
}

// ---- parts

void aisle_layout_stage_begin(aisle_layout *self, const aisle_layout_header *header, const aisle_lattice *lattice) {
    aisle_layout_store *store = aisle_layout_staged(self);
    aisle_layout_staging *staging = &self->staging;
    aisle_layout_forget_base(self);
    store->header = *header;
    store->is_crc_due = false;
    store->lattice = *lattice;
    store->zone_count = 0;
    store->vertex_count = 0;
    store->zones_content = 0;
    memset(store->of_kind, 0, sizeof store->of_kind);
    staging->stage = AISLE_STAGE_FILLING;
    staging->is_patch = false;
    staging->parts = 0;
    staging->tiles = 0;
    memset(staging->tile, 0, header->tiles * sizeof *staging->tile);
    aisle_id_map_clear(&staging->ids);
}

bool aisle_layout_check_polygons(aisle_layout *self, const aisle_polygon_msg *polygons, uint32_t count,
                                 aisle_refusal *why) {
    aisle_id_map_clear(&self->staging.message);
    for (uint32_t i = 0; i < count; i++) {
        if (!aisle_polygon_is_valid(&polygons[i]) || !aisle_id_map_add(&self->staging.message, polygons[i].id, i)) {
            (void)aisle_layout_refuse(why, AISLE_STATUS_MALFORMED, polygons[i].id, 0.0);
            return false;
        }
    }
    return true;
}

uint32_t aisle_layout_count_vertices(const aisle_polygon_msg *polygons, uint32_t count) {
    uint32_t sum = 0;
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t n = (uint32_t)polygons[i].num_vertices;
        sum += n;
    }
    return sum;
}

// Room for the part, and no id that is in already.
static bool check_room(aisle_layout *self, const aisle_layout_msg *msg, bool is_fresh, aisle_refusal *why) {
    const aisle_layout_store *store = aisle_layout_staged(self);
    const uint32_t count = (uint32_t)msg->num_polygons;
    const uint32_t zones = count + (is_fresh ? 0U : store->zone_count);
    const uint32_t vertices = aisle_layout_count_vertices(msg->polygons, count) + (is_fresh ? 0U : store->vertex_count);
    if (vertices > store->vertex_capacity) {
        (void)aisle_layout_refuse(why, AISLE_STATUS_LIMIT, AISLE_LAYOUT_LIMIT_VERTICES, (double)vertices);
        return false;
    }
    if (zones > (uint32_t)msg->total_polygons) {
        (void)aisle_layout_refuse(why, AISLE_STATUS_MALFORMED, 0, (double)zones);
        return false;
    }
    for (uint32_t i = 0; i < count && !is_fresh; i++) {
        if (aisle_id_map_find(&self->staging.ids, msg->polygons[i].id) != NULL) {
            (void)aisle_layout_refuse(why, AISLE_STATUS_MALFORMED, msg->polygons[i].id, 0.0);
            return false;
        }
    }
    return true;
}

static void add_part(aisle_layout *self, const aisle_layout_msg *msg) {
    aisle_layout_store *store = aisle_layout_staged(self);
    aisle_layout_staging *staging = &self->staging;
    staging->parts |= UINT64_C(1) << msg->part;
    staging->part_first[msg->part] = (uint16_t)store->zone_count;
    staging->part_count[msg->part] = (uint16_t)msg->num_polygons;
    for (int16_t i = 0; i < msg->num_polygons; i++) {
        const bool is_new = aisle_id_map_add(&staging->ids, msg->polygons[i].id, store->zone_count);
        AISLE_ASSERT(is_new);
        aisle_layout_store_add(store, &msg->polygons[i]);
    }
}

static bool is_part_same(aisle_layout *self, const aisle_layout_msg *msg) {
    const aisle_layout_store *store = aisle_layout_staged(self);
    const uint32_t first = self->staging.part_first[msg->part];
    const uint32_t count = self->staging.part_count[msg->part];
    if ((uint32_t)msg->num_polygons != count) {
        return false;
    }
    for (uint32_t i = 0; i < count; i++) {
        if (!aisle_layout_store_is_same(store, &store->zones[first + i], &msg->polygons[i])) {
            return false;
        }
    }
    return true;
}

static bool are_parts_in(aisle_layout *self) {
    const uint32_t parts = aisle_layout_staged(self)->header.parts;
    return self->staging.parts == UINT64_MAX >> (AISLE_LAYOUT_MAX_PARTS - parts);
}

// Zones into the order of the parts, so that the order of arrival leaves no trace.
static void order_by_part(aisle_layout *self) {
    aisle_layout_staging *staging = &self->staging;
    uint16_t place = 0;
    for (uint32_t part = 0; part < aisle_layout_staged(self)->header.parts; part++) {
        const uint16_t first = staging->part_first[part];
        staging->part_first[part] = place;
        for (uint32_t i = 0; i < staging->part_count[part]; i++) {
            staging->order[first + i] = place;
            place++;
        }
    }
    aisle_layout_store_reorder(aisle_layout_staged(self), staging->order);
}

aisle_status aisle_layout_stage_settle(aisle_layout *self) {
    if (!are_parts_in(self) || self->staging.tiles < aisle_layout_staged(self)->header.tiles) {
        return AISLE_PARTIAL;
    }
    self->staging.stage = AISLE_STAGE_COMPLETE;
    return AISLE_OK;
}

static aisle_status settle_part(aisle_layout *self, aisle_refusal *why) {
    if (!are_parts_in(self)) {
        return AISLE_PARTIAL;
    }
    const aisle_layout_store *store = aisle_layout_staged(self);
    order_by_part(self);
    if (store->zone_count != store->header.polygons || aisle_layout_store_crc(store) != store->header.crc32) {
        self->staging.stage = AISLE_STAGE_EMPTY;
        return aisle_layout_refuse(why, AISLE_STATUS_MALFORMED, 0, (double)store->zone_count);
    }
    return aisle_layout_stage_settle(self);
}

// A part of the revision that is being staged: is it known, does it fit?
static aisle_status judge_known(aisle_layout *self, const aisle_layout_msg *msg, const aisle_layout_header *header,
                                bool *is_in, aisle_refusal *why) {
    aisle_layout_store *staged = aisle_layout_staged(self);
    *is_in = self->staging.stage == AISLE_STAGE_COMPLETE; // a patched one has no parts to compare
    if (!is_same_content(staged, header) || (!*is_in && staged->header.parts != header->parts)) {
        return aisle_layout_refuse(why, AISLE_STATUS_CONFLICT, 0, 0.0);
    }
    if (!*is_in && (self->staging.parts >> msg->part & 1U) != 0) {
        *is_in = true;
        return is_part_same(self, msg) ? AISLE_PARTIAL : aisle_layout_refuse(why, AISLE_STATUS_CONFLICT, 0, 0.0);
    }
    return AISLE_OK;
}

aisle_status aisle_layout_take_part(aisle_layout *self, const aisle_layout_msg *msg, aisle_refusal *why) {
    *why = (aisle_refusal){0};
    aisle_layout_header header;
    if (!read_header(msg, &header)) {
        return aisle_layout_refuse(why, AISLE_STATUS_MALFORMED, 0, 0.0);
    }
    const aisle_layout_relation relation = aisle_layout_relate(self, header.map_id, header.map_revision);
    if (relation == AISLE_RELATION_OUTDATED) {
        return aisle_layout_refuse(why, AISLE_STATUS_OUTDATED, aisle_layout_newest(self, header.map_id), 0.0);
    }
    if (relation == AISLE_RELATION_ACTIVE) {
        return is_same_content(aisle_layout_active(self), &header)
                   ? AISLE_OK
                   : aisle_layout_refuse(why, AISLE_STATUS_CONFLICT, 0, 0.0);
    }
    const bool is_fresh = relation == AISLE_RELATION_NEW;
    if (is_fresh && self->staging.stage == AISLE_STAGE_COMPLETE) {
        return AISLE_BUSY;
    }
    if (!is_fresh) {
        bool is_in;
        const aisle_status status = judge_known(self, msg, &header, &is_in, why);
        if (status != AISLE_OK || is_in) {
            return status;
        }
    }
    aisle_lattice lattice;
    if (!check_limits(self, &header, &lattice, why) ||
        !aisle_layout_check_polygons(self, msg->polygons, (uint32_t)msg->num_polygons, why) ||
        !check_room(self, msg, is_fresh, why)) {
        return AISLE_ERR_DATA;
    }
    if (is_fresh) {
        aisle_layout_stage_begin(self, &header, &lattice);
    }
    add_part(self, msg);
    return settle_part(self, why);
}
