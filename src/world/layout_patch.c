#include "base/check.h"
#include "world/layout_internal.h"

#include <string.h>

// What the message says of one id, as the value in staging.message: index + 1 of the polygon put, or 0, and flags.
#define EDIT_PUT 0xFFFFU
#define EDIT_REMOVED 0x10000U
#define EDIT_FOUND 0x20000U // in the active layout
#define EDIT_SAME 0x40000U  // and put again as it was

typedef struct totals {
    uint32_t zones, vertices;
} totals;

// ---- the edits

static bool are_counts_valid(const aisle_layout_patch_msg *msg) {
    return msg->num_removed >= 0 && msg->num_removed <= AISLE_LAYOUT_PATCH_MAX_REMOVED && msg->num_polygons >= 0 &&
           msg->num_polygons <= AISLE_LAYOUT_PATCH_MAX_POLYGONS;
}

static bool add_removal(aisle_id_map *edits, int32_t id) { // false: not an id, or removed twice
    if (id <= 0) {
        return false;
    }
    uint32_t *edit = aisle_id_map_find(edits, id);
    if (edit == NULL) {
        return aisle_id_map_add(edits, id, EDIT_REMOVED);
    }
    const bool is_twice = (*edit & EDIT_REMOVED) != 0;
    *edit |= EDIT_REMOVED;
    return !is_twice;
}

static bool gather_edits(aisle_layout *self, const aisle_layout_patch_msg *msg, aisle_refusal *why) {
    aisle_id_map *edits = &self->staging.message;
    if (!aisle_layout_check_polygons(self, msg->polygons, (uint32_t)msg->num_polygons, why)) {
        return false;
    }
    for (int16_t i = 0; i < msg->num_polygons; i++) {
        *aisle_id_map_find(edits, msg->polygons[i].id) = (uint32_t)(i + 1);
    }
    for (int16_t i = 0; i < msg->num_removed; i++) {
        if (!add_removal(edits, msg->removed[i])) {
            (void)aisle_layout_refuse(why, AISLE_STATUS_CONFLICT, msg->removed[i], 0.0);
            return false;
        }
    }
    return true;
}

static uint32_t edit_of(const aisle_id_map *edits, int32_t id) {
    const uint32_t *edit = aisle_id_map_find(edits, id);
    return edit == NULL ? 0U : *edit;
}

// Lists the zones of the active layout that are named, in staging.order, marks their edits, and counts the others.
static totals find_edits(aisle_layout *self) {
    const aisle_layout_store *active = aisle_layout_active(self);
    aisle_layout_staging *staging = &self->staging;
    totals kept = {active->zone_count, active->vertex_count};
    staging->named = 0;
    for (uint32_t i = 0; i < active->zone_count; i++) {
        uint32_t *edit = aisle_id_map_find(&staging->message, active->zones[i].id);
        if (edit != NULL) {
            *edit |= EDIT_FOUND;
            staging->order[staging->named] = (uint16_t)i;
            staging->named++;
            kept.zones--;
            kept.vertices -= active->zones[i].n;
        }
    }
    return kept;
}

static bool check_edits(aisle_layout *self, const aisle_layout_patch_msg *msg, aisle_refusal *why) {
    const totals kept = find_edits(self);
    const aisle_layout_store *store = aisle_layout_staged(self);
    for (int16_t i = 0; i < msg->num_removed; i++) {
        if ((edit_of(&self->staging.message, msg->removed[i]) & EDIT_FOUND) == 0) {
            (void)aisle_layout_refuse(why, AISLE_STATUS_CONFLICT, msg->removed[i], 0.0);
            return false;
        }
    }
    const uint32_t put = (uint32_t)msg->num_polygons;
    const uint32_t zones = kept.zones + put;
    const uint32_t vertices = kept.vertices + aisle_layout_count_vertices(msg->polygons, put);
    if (zones > store->zone_capacity) {
        (void)aisle_layout_refuse(why, AISLE_STATUS_LIMIT, AISLE_LAYOUT_LIMIT_POLYGONS, (double)zones);
        return false;
    }
    if (vertices > store->vertex_capacity) {
        (void)aisle_layout_refuse(why, AISLE_STATUS_LIMIT, AISLE_LAYOUT_LIMIT_VERTICES, (double)vertices);
        return false;
    }
    return true;
}

// ---- the result

static void note_change(aisle_layout *self, const aisle_layout_store *store, uint32_t index, bool is_added) {
    const aisle_zone *zone = &store->zones[index];
    AISLE_ASSERT(self->diff.count < AISLE_LAYOUT_CHANGES_MAX);
    self->diff.change[self->diff.count] =
        (aisle_layout_change){zone->box, zone->id, zone->kind, is_added, (uint16_t)index};
    self->diff.count++;
}

static void put_polygon(aisle_layout *self, const aisle_polygon_msg *polygon, bool is_as_it_was) {
    aisle_layout_store *store = aisle_layout_staged(self);
    aisle_layout_store_add(store, polygon);
    if (!is_as_it_was) {
        note_change(self, store, store->zone_count - 1U, true);
    }
}

// A zone of the active layout that the message names. Says whether it is put again as it was.
static bool lift_zone(aisle_layout *self, uint32_t i, const aisle_polygon_msg *put_again) {
    const aisle_layout_store *active = aisle_layout_active(self);
    aisle_layout_staged(self)->zones_content -= aisle_layout_store_content(active, &active->zones[i]);
    if (put_again != NULL && aisle_layout_store_is_same(active, &active->zones[i], put_again)) {
        return true;
    }
    note_change(self, active, i, false);
    return false;
}

static void edit_zone(aisle_layout *self, const aisle_layout_patch_msg *msg, uint32_t i) {
    uint32_t *edit = aisle_id_map_find(&self->staging.message, aisle_layout_active(self)->zones[i].id);
    AISLE_ASSERT(edit != NULL);
    const uint32_t number = *edit & EDIT_PUT;
    const aisle_polygon_msg *put_again = number == 0 ? NULL : &msg->polygons[number - 1U];
    const bool is_same = lift_zone(self, i, put_again);
    *edit |= is_same ? EDIT_SAME : 0U;
    if ((*edit & EDIT_REMOVED) == 0) { // changed in place
        put_polygon(self, put_again, is_same);
    } else if (is_same) {
        self->diff.is_reordered = true;
    }
}

// The active layout's zones with those named changed or left out, then what is new.
static void stage_edited(aisle_layout *self, const aisle_layout_patch_msg *msg) {
    const aisle_layout_store *active = aisle_layout_active(self);
    const aisle_layout_staging *staging = &self->staging;
    uint32_t next = 0;
    for (uint32_t k = 0; k <= staging->named; k++) {
        const uint32_t stop = k < staging->named ? staging->order[k] : active->zone_count;
        if (next < stop) {
            aisle_layout_store_add_zones(aisle_layout_staged(self), active, next, stop);
        }
        if (k < staging->named) {
            edit_zone(self, msg, stop);
        }
        next = stop + 1U;
    }
    for (int16_t i = 0; i < msg->num_polygons; i++) {
        const uint32_t edit = edit_of(&staging->message, msg->polygons[i].id);
        if ((edit & EDIT_FOUND) == 0 || (edit & EDIT_REMOVED) != 0) {
            put_polygon(self, &msg->polygons[i], (edit & EDIT_SAME) != 0);
        }
    }
}

static void stage_patch(aisle_layout *self, const aisle_layout_patch_msg *msg) {
    const aisle_layout_store *active = aisle_layout_active(self);
    aisle_layout_store *store = aisle_layout_staged(self);
    aisle_layout_stage_begin(self, &active->header, &active->lattice);
    store->zones_content = active->zones_content;
    self->diff.everything = false;
    self->diff.is_reordered = false;
    self->diff.count = 0;
    stage_edited(self, msg);
    store->header.map_revision = msg->map_revision;
    store->header.polygons = store->zone_count;
    store->is_crc_due = true; // for a repeat as a whole layout, which may never come
    store->scan_content = active->scan_content;
    self->staging.is_patch = true;
    self->staging.stage = AISLE_STAGE_COMPLETE;
}

// The active layout is what this patch would have made of its base.
static bool is_applied(aisle_layout *self, const aisle_layout_patch_msg *msg) {
    const aisle_layout_store *active = aisle_layout_active(self);
    uint32_t same = 0;
    for (uint32_t i = 0; i < active->zone_count; i++) {
        const uint32_t edit = edit_of(&self->staging.message, active->zones[i].id);
        const uint32_t put = edit & EDIT_PUT;
        if (edit != 0 &&
            (put == 0 || !aisle_layout_store_is_same(active, &active->zones[i], &msg->polygons[put - 1U]))) {
            return false;
        }
        same += put != 0 ? 1U : 0U;
    }
    return same == (uint32_t)msg->num_polygons;
}

static aisle_status judge_active(aisle_layout *self, const aisle_layout_patch_msg *msg, aisle_refusal *why) {
    const aisle_layout_header *active = &aisle_layout_active(self)->header;
    if (!self->has_active) {
        return aisle_layout_refuse(why, AISLE_STATUS_NO_LAYOUT, 0, 0.0);
    }
    if (msg->map_id != active->map_id) {
        return aisle_layout_refuse(why, AISLE_STATUS_MAP_MISMATCH, active->map_id, 0.0);
    }
    if (!are_counts_valid(msg) || msg->map_revision <= msg->base_revision) {
        return aisle_layout_refuse(why, AISLE_STATUS_MALFORMED, 0, 0.0);
    }
    if (msg->map_revision < active->map_revision) {
        return aisle_layout_refuse(why, AISLE_STATUS_OUTDATED, active->map_revision, 0.0);
    }
    if (msg->map_revision > active->map_revision && msg->base_revision != active->map_revision) {
        return aisle_layout_refuse(why, AISLE_STATUS_REVISION_GAP, active->map_revision, 0.0);
    }
    return AISLE_OK;
}

// Something is being staged: does the patch wait, come too late or go before it?
static aisle_status judge_staged(aisle_layout *self, const aisle_layout_patch_msg *msg, aisle_refusal *why) {
    const aisle_layout_header *staged = &aisle_layout_staged(self)->header;
    if (self->staging.stage == AISLE_STAGE_COMPLETE) {
        return AISLE_BUSY;
    }
    if (self->staging.stage == AISLE_STAGE_FILLING && staged->map_id == msg->map_id &&
        msg->map_revision < staged->map_revision) {
        return aisle_layout_refuse(why, AISLE_STATUS_OUTDATED, staged->map_revision, 0.0);
    }
    return AISLE_OK;
}

aisle_status aisle_layout_take_patch(aisle_layout *self, const aisle_layout_patch_msg *msg, aisle_refusal *why) {
    *why = (aisle_refusal){0};
    aisle_status status = judge_active(self, msg, why);
    if (status != AISLE_OK) {
        return status;
    }
    if (msg->map_revision == aisle_layout_map_revision(self)) {
        if (!gather_edits(self, msg, why)) {
            return AISLE_ERR_DATA;
        }
        return is_applied(self, msg) ? AISLE_OK : aisle_layout_refuse(why, AISLE_STATUS_CONFLICT, 0, 0.0);
    }
    status = judge_staged(self, msg, why);
    if (status != AISLE_OK) {
        return status;
    }
    if (!gather_edits(self, msg, why) || !check_edits(self, msg, why)) {
        return AISLE_ERR_DATA;
    }
    stage_patch(self, msg);
    return AISLE_OK;
}
