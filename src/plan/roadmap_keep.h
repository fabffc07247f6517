// roadmap_keep.h - the roadmap of planner PRM, kept from query to query and repaired where the layout has changed. Level 4.
//
// One roadmap (algo/roadmap.h) is kept: of one layout's content, one body (footprint, margin, least radius), one seed. What
// patches change is noted as boxes, and before the next query a repair puts only those draws and edges in doubt whose
// motion comes so near to one of them that it may matter: their body's, margin and room before DIRECTED zones. Polygons of
// kinds that no motion hangs on are left out. Built anew where another layout, body or seed is asked for, or where more
// has changed than AISLE_ROADMAP_KEEP_CHANGES boxes; a layout that comes back as it was (a door) needs no repair.
// What is learnt of edges stays, so answers, and what they cost in work, hang on the queries before: on the order of inputs
// alone. A goal list may be given up at a moment that a replay does not know, so lists work on a copy (route_roadmap.c).
//
// Memory: draws * (32 + 66 + 7 k) bytes, k = AISLE_ROADMAP_KEEP_K: 168 a draw (32 of it what roadmap.h says with three
// numbers each, 66 their index, 7 an edge). Time: note() O(changes); touches() O(boxes), where headings matter and a box is
// near a few microseconds for a car.
#ifndef AISLE_PLAN_ROADMAP_KEEP_H
#define AISLE_PLAN_ROADMAP_KEEP_H

#include "algo/roadmap.h"
#include "plan/vehicle_space.h"

#define AISLE_ROADMAP_KEEP_K 10U
#define AISLE_ROADMAP_KEEP_DIM 3U
#define AISLE_ROADMAP_KEEP_CHANGES 64U

typedef struct aisle_roadmap_wish { // which roadmap a request wants
    const aisle_layout *layout;
    const aisle_vehicle_space *configurations; // begun
    aisle_roadmap_config config;               // samples: to begin with
} aisle_roadmap_wish;

typedef struct aisle_roadmap_changes { // where the layout has changed, as a repair looks at it
    const aisle_vehicle_space *configurations;
    uint32_t count;
    aisle_aabb box[AISLE_ROADMAP_KEEP_CHANGES]; // m
} aisle_roadmap_changes;

typedef struct aisle_roadmap_keep {
    aisle_roadmap map;
    bool is_begun;
    bool is_repairing; // for the changes
    bool is_lost;      // the layout is another one, until it comes back
    uint64_t key;      // digest of what the map is for, but the layout
    uint64_t content;  // of the layout that the map knows,
    uint64_t now;      // and of the one in force
    int32_t map_id, map_id_now;
    aisle_roadmap_changes changes; // from the one to the other
    int64_t begun, repairs;        // counters: from nothing; repairs
} aisle_roadmap_keep;

void aisle_roadmap_keep_carve(aisle_roadmap_keep *self, aisle_arena *arena, uint32_t draws);

// Another layout is in force; every one must be told.
void aisle_roadmap_keep_note(aisle_roadmap_keep *self, const aisle_layout *layout);

// Is what is kept, its changes repaired, what is wished for?
bool aisle_roadmap_keep_serves(const aisle_roadmap_keep *self, const aisle_roadmap_wish *wish);

// Begins anew unless what is kept serves.
void aisle_roadmap_keep_begin(aisle_roadmap_keep *self, const aisle_roadmap_wish *wish);

// The same, of another one that serves as it stands, with its changes; one that is half built does not. Not while it is
// being stepped.
void aisle_roadmap_keep_begin_from(aisle_roadmap_keep *self, const aisle_roadmap_keep *other,
                                   const aisle_roadmap_wish *wish);

// Goes on with what is to be built or repaired; as aisle_roadmap_step().
aisle_status aisle_roadmap_keep_step(aisle_roadmap_keep *self, const aisle_vehicle_space *configurations,
                                     uint32_t units, uint32_t *spent);

// For aisle_roadmap_repair(), context: aisle_roadmap_changes.
bool aisle_roadmap_keep_touches(void *context, const double *a, const double *b);
#endif
