#include "base/check.h"
#include "world/layout_internal.h"

#define LEB_BYTES_MAX 5U // of 32 bits

typedef struct tile {
    uint32_t x0, y0, w, h; // cells
    const uint8_t *bytes;
    uint32_t size;
} tile;

// ---- where it lies

static bool read_lattice(const aisle_layout_store *store, const aisle_grid_chunk_msg *msg, aisle_lattice *out) {
    *out = (aisle_lattice){msg->origin_x, msg->origin_y, 0.0, 0, 0};
    if (!(fabs(msg->origin_x) <= AISLE_SHAPE_COORD_MAX && fabs(msg->origin_y) <= AISLE_SHAPE_COORD_MAX) ||
        !aisle_layout_read_resolution(msg->resolution, &out->res)) {
        return false;
    }
    const aisle_vec2 hi = store->header.bounds.hi;
    const double w = floor((hi.x - out->x0) / out->res + 0.5); // below 2e5 / 0.005
    const double h = floor((hi.y - out->y0) / out->res + 0.5);
    out->w = w >= 1.0 ? (uint32_t)w : 0U;
    out->h = h >= 1.0 ? (uint32_t)h : 0U;
    return true;
}

// The scan lies as the layout's bounds and resolution say, and as the tiles before said.
static bool is_lattice_agreed(const aisle_layout_store *store, const aisle_lattice *lattice) {
    enum { EXACT_PER_M = 1000000000 }; // origins agree to 1 nm
    const aisle_layout_header *header = &store->header;
    const double tolerance = 0.5 * lattice->res + 1.0 / EXACT_PER_M;
    if (store->lattice.w != 0) {
        return fabs(store->lattice.x0 - lattice->x0) <= 1.0 / EXACT_PER_M &&
               fabs(store->lattice.y0 - lattice->y0) <= 1.0 / EXACT_PER_M &&
               fabs(store->lattice.res - lattice->res) <= 1.0 / EXACT_PER_M;
    }
    return lattice->w > 0 && lattice->h > 0 && fabs(header->bounds.lo.x - lattice->x0) <= tolerance &&
           fabs(header->bounds.lo.y - lattice->y0) <= tolerance &&
           (header->resolution <= 0.0 || fabs(header->resolution - lattice->res) <= 1.0 / EXACT_PER_M);
}

static bool read_place(const aisle_lattice *lattice, const aisle_grid_chunk_msg *msg, tile *out) {
    const int64_t end_x = (int64_t)msg->x0 + msg->width;
    const int64_t end_y = (int64_t)msg->y0 + msg->height;
    if (msg->x0 < 0 || msg->y0 < 0 || msg->width < 1 || msg->height < 1 || end_x > (int64_t)lattice->w ||
        end_y > (int64_t)lattice->h || msg->num_bytes < 0 || msg->num_bytes > AISLE_GRID_CHUNK_MAX_BYTES) {
        return false;
    }
    *out = (tile){(uint32_t)msg->x0,     (uint32_t)msg->y0, (uint32_t)msg->width,
                  (uint32_t)msg->height, msg->data,         (uint32_t)msg->num_bytes};
    return true;
}

static bool is_overlap(const aisle_layout_tile *a, const tile *b) {
    return a->w > 0 && a->x0 < b->x0 + b->w && b->x0 < (uint32_t)a->x0 + a->w && a->y0 < b->y0 + b->h &&
           b->y0 < (uint32_t)a->y0 + a->h;
}

static bool overlaps_any(const aisle_layout *self, uint32_t tiles, const tile *t) {
    for (uint32_t i = 0; i < tiles; i++) {
        if (is_overlap(&self->staging.tile[i], t)) {
            return true;
        }
    }
    return false;
}

// ---- what it says

// Unsigned LEB128 of at most 32 bits, in as few bytes as it can be. False: it is not, or the bytes end.
static bool read_leb(const tile *t, uint32_t *at, uint32_t *value) {
    uint64_t sum = 0;
    for (uint32_t i = 0; i < LEB_BYTES_MAX && *at < t->size; i++) {
        const uint8_t byte = t->bytes[*at];
        (*at)++;
        sum |= (uint64_t)(byte & 0x7FU) << (7U * i);
        if (byte < 0x80U) {
            *value = (uint32_t)sum;
            return sum <= UINT32_MAX && (byte != 0 || i == 0);
        }
    }
    return false;
}

static bool is_rle_whole(const tile *t) {
    uint64_t sum = 0;
    uint32_t at = 0;
    while (at < t->size) {
        uint32_t run;
        if (!read_leb(t, &at, &run)) {
            return false;
        }
        sum += run; // at most 60000 runs of 32 bits
    }
    return sum == (uint64_t)t->w * t->h;
}

static bool is_content_valid(int8_t encoding, const tile *t) {
    switch (encoding) {
    case AISLE_GRID_CHUNK_BITS:
        return (uint64_t)t->size == (uint64_t)((t->w + 7U) / 8U) * t->h;
    case AISLE_GRID_CHUNK_RLE:
        return is_rle_whole(t);
    default:
        return false;
    }
}

// Frees `run` cells of the tile read as one row, from cell `at` on.
static void free_in_tile(aisle_layout_store *store, const tile *t, uint32_t at, uint32_t run) {
    while (run > 0) {
        const uint32_t column = at % t->w;
        const uint32_t n = run < t->w - column ? run : t->w - column;
        aisle_layout_store_free_run(store, t->y0 + at / t->w, t->x0 + column, t->x0 + column + n);
        at += n;
        run -= n;
    }
}

static void paint_rle(aisle_layout_store *store, const tile *t) {
    uint32_t at = 0;
    uint32_t cell = 0;
    for (bool is_free = true; at < t->size; is_free = !is_free) {
        uint32_t run = 0;
        const bool is_read = read_leb(t, &at, &run);
        AISLE_ASSERT(is_read); // checked before
        if (is_free) {
            free_in_tile(store, t, cell, run);
        }
        cell += run;
    }
}

static void paint_bits(aisle_layout_store *store, const tile *t) {
    const uint32_t stride = (t->w + 7U) / 8U;
    for (uint32_t y = 0; y < t->h; y++) {
        const uint8_t *row = &t->bytes[y * stride];
        uint32_t first = 0; // of the free cells before x
        for (uint32_t x = 0; x < t->w; x++) {
            const uint32_t byte = row[x / 8U];
            if ((byte >> (x % 8U) & 1U) != 0) {
                aisle_layout_store_free_run(store, t->y0 + y, t->x0 + first, t->x0 + x);
                first = x + 1U;
            }
        }
        aisle_layout_store_free_run(store, t->y0 + y, t->x0 + first, t->x0 + t->w);
    }
}

// ---- taking it

static aisle_status judge_revision(aisle_layout *self, const aisle_grid_chunk_msg *msg, bool *is_wanted,
                                   aisle_refusal *why) {
    *is_wanted = false;
    const aisle_layout_relation relation = aisle_layout_relate(self, msg->map_id, msg->map_revision);
    if (relation == AISLE_RELATION_OUTDATED) {
        return aisle_layout_refuse(why, AISLE_STATUS_OUTDATED, aisle_layout_newest(self, msg->map_id), 0.0);
    }
    if (relation == AISLE_RELATION_NEW) {
        return self->staging.stage == AISLE_STAGE_COMPLETE ? AISLE_BUSY
                                                           : aisle_layout_refuse(why, AISLE_STATUS_NO_LAYOUT, 0, 0.0);
    }
    const aisle_layout_store *store =
        relation == AISLE_RELATION_ACTIVE ? aisle_layout_active(self) : aisle_layout_staged(self);
    if ((int64_t)msg->num_parts != (int64_t)store->header.tiles) {
        return aisle_layout_refuse(why, AISLE_STATUS_CONFLICT, msg->part, 0.0);
    }
    if (msg->part < 0 || msg->part >= msg->num_parts) {
        return aisle_layout_refuse(why, AISLE_STATUS_MALFORMED, msg->part, 0.0);
    }
    *is_wanted = relation == AISLE_RELATION_STAGED && self->staging.stage == AISLE_STAGE_FILLING;
    return AISLE_OK;
}

static aisle_status judge_tile(aisle_layout *self, const aisle_grid_chunk_msg *msg, aisle_lattice *lattice, tile *t,
                               aisle_refusal *why) {
    const aisle_layout_store *store = aisle_layout_staged(self);
    if (!read_lattice(store, msg, lattice)) {
        return aisle_layout_refuse(why, AISLE_STATUS_MALFORMED, msg->part, 0.0);
    }
    if (!is_lattice_agreed(store, lattice)) {
        return aisle_layout_refuse(why, AISLE_STATUS_CONFLICT, msg->part, 0.0);
    }
    if (store->lattice.w != 0) {
        *lattice = store->lattice; // the first tile's, to the last digit
    }
    if (!aisle_layout_check_lattice(self, lattice, why)) {
        return AISLE_ERR_DATA;
    }
    if (!read_place(lattice, msg, t) || !is_content_valid(msg->encoding, t)) {
        return aisle_layout_refuse(why, AISLE_STATUS_MALFORMED, msg->part, 0.0);
    }
    const aisle_layout_tile *held = &self->staging.tile[msg->part];
    if (held->w > 0) {
        const bool is_same = held->x0 == t->x0 && held->y0 == t->y0 && held->w == t->w && held->h == t->h;
        return is_same ? AISLE_PARTIAL : aisle_layout_refuse(why, AISLE_STATUS_CONFLICT, msg->part, 0.0);
    }
    return overlaps_any(self, store->header.tiles, t) ? aisle_layout_refuse(why, AISLE_STATUS_CONFLICT, msg->part, 0.0)
                                                      : AISLE_OK;
}

aisle_status aisle_layout_take_tile(aisle_layout *self, const aisle_grid_chunk_msg *msg, aisle_refusal *why) {
    *why = (aisle_refusal){0};
    bool is_wanted;
    aisle_status status = judge_revision(self, msg, &is_wanted, why);
    if (!is_wanted) {
        return status;
    }
    aisle_lattice lattice;
    tile t = {0};
    status = judge_tile(self, msg, &lattice, &t, why);
    if (status != AISLE_OK) {
        return status;
    }
    aisle_layout_store *store = aisle_layout_staged(self);
    if (store->lattice.w == 0) {
        store->lattice = lattice;
        aisle_layout_store_fill_scan(store);
    }
    if (msg->encoding == AISLE_GRID_CHUNK_BITS) {
        paint_bits(store, &t);
    } else {
        paint_rle(store, &t);
    }
    self->staging.tile[msg->part] = (aisle_layout_tile){(uint16_t)t.x0, (uint16_t)t.y0, (uint16_t)t.w, (uint16_t)t.h};
    self->staging.tiles++;
    return aisle_layout_stage_settle(self);
}
