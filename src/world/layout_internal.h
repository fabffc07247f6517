// layout_internal.h - what the files of layout share with each other and with nobody else. Level 1.
#ifndef AISLE_WORLD_LAYOUT_INTERNAL_H
#define AISLE_WORLD_LAYOUT_INTERNAL_H

#include "world/layout.h"

static inline aisle_layout_store *aisle_layout_active(aisle_layout *self) {
    return &self->store[self->active];
}
static inline const aisle_layout_store *aisle_layout_held(const aisle_layout *self) {
    return &self->store[self->active];
}
static inline aisle_layout_store *aisle_layout_staged(aisle_layout *self) {
    return &self->store[1U - self->active];
}

// Fills *why and answers AISLE_ERR_DATA.
aisle_status aisle_layout_refuse(aisle_refusal *why, int16_t cause, int32_t id, double value);

// How a message's map and revision stand to what is held.
typedef enum aisle_layout_relation {
    AISLE_RELATION_STAGED,   // the very revision being staged, complete or not
    AISLE_RELATION_ACTIVE,   // the very revision active
    AISLE_RELATION_OUTDATED, // older than one of them
    AISLE_RELATION_NEW
} aisle_layout_relation;
aisle_layout_relation aisle_layout_relate(aisle_layout *self, int32_t map_id, int32_t map_revision);
// The revision an outdated one of map_id is older than.
int32_t aisle_layout_newest(aisle_layout *self, int32_t map_id);

// The store before the active one is about to be overwritten: a build that goes on from it builds the whole.
void aisle_layout_forget_base(aisle_layout *self);

// Empties the staged store for what follows.
void aisle_layout_stage_begin(aisle_layout *self, const aisle_layout_header *header, const aisle_lattice *lattice);
// AISLE_OK and complete if all parts and tiles are in, else AISLE_PARTIAL.
aisle_status aisle_layout_stage_settle(aisle_layout *self);

// Every polygon of a message valid and no id twice; fills staging.message with their ids, value = index. False: *why.
bool aisle_layout_check_polygons(aisle_layout *self, const aisle_polygon_msg *polygons, uint32_t count,
                                 aisle_refusal *why);

uint32_t aisle_layout_count_vertices(const aisle_polygon_msg *polygons, uint32_t count);

// Lattice sides and cells within the limits. False: *why.
bool aisle_layout_check_lattice(const aisle_layout *self, const aisle_lattice *lattice, aisle_refusal *why);

// A resolution as meant; false if it is not one that may be given.
bool aisle_layout_read_resolution(float wire, double *out);
#endif
