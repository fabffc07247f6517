// layout.h - the static layout: polygons and a scanned map, taken in parts, in force at once. Level 1.
//
// Two stores, staged and active. Parts of layout_t and tiles of grid_chunk_t fill the staged one in any order;
// when all of one revision are in and the crc32 is right, commit() swaps the stores and a build (bucket
// index, rasterised grid, distance field) runs in slices. Until then the active one stays untouched.
// Obstacles are the polygons of kind OBSTACLE and KEEPOUT, the scan's occupied cells (closed squares; cells no tile
// covers are occupied) and everything outside the bounds.
// Where there is a scan, the planning grid is the scan's lattice: layout_t.resolution must be 0 or the scan's, and
// the bounds must lie within half a cell of the scan's extent. Without one, resolution 0 means 0.05 m, doubled until
// the grid fits the limit. A scanned cell marks itself alone, not the neighbours its border touches (the bounds of
// grid.h hold all the same); cells the bounds cut are occupied.
// A resolution is a float on the wire; one that is the float nearest to a whole number of micrometres is read as that
// (0.05F as 0.05).
// Bucket index: square buckets, CSR lists of polygon indices, side doubled until the lists fit. Two of them: a narrow
// one (from AISLE_LAYOUT_BUCKET on) of the polygons near a place, a wide one (about one a bucket) of all blocks.
//
// Revisions rise strictly for one map_id; another map_id is another map and may have any. A part of a newer revision,
// or of another map, ends the staging of an older one. Order of zones: as in the parts in order, whatever the order
// they came in. A patch keeps the order: removed ones leave, changed ones stay in place, new ones (and removed ones put
// again) come last in the message's order; so a full layout_t sent later for the same revision is a duplicate if its
// sender does alike.
//
// Files: layout_store (what a layout is), layout_content, layout_stage (parts), layout_tile (tiles), layout_patch,
// layout_index, layout_build (index and grid), layout_mark (what is occupied), layout_update (the grid after a patch),
// layout_gap, layout_facing, layout (questions).
//
// Memory: carved once from limits; 11.7 MiB with the default ones, 8.0 of them the grid, 1.2 each store. Time: part
// O(polygons * vertices^2), the last one O(all of them); tile O(cells + tiles); patch O(its polygons * vertices^2 + all
// polygons); commit O(1); build O(cells), of a patch on a layout in force O(all blocks + cells around what changed).
#ifndef AISLE_WORLD_LAYOUT_H
#define AISLE_WORLD_LAYOUT_H

#include "aisle/limits.h"
#include "aisle/messages.h"
#include "aisle/status.h"
#include "base/arena.h"
#include "world/grid.h"
#include "world/id_map.h"
#include "world/layout_index.h"
#include "world/layout_store.h"
#include "world/layout_update.h"
#include "world/shape.h"

#define AISLE_LAYOUT_RESOLUTION_DEFAULT 0.05 // m
#define AISLE_LAYOUT_RESOLUTION_MIN 0.005    // m, of those that are given
#define AISLE_LAYOUT_RESOLUTION_MAX 1.0      // m
#define AISLE_LAYOUT_TILES_MAX 4096U         // of one revision
#define AISLE_LAYOUT_BUCKET 0.5              // m, least side of the narrow index's buckets
#define AISLE_LAYOUT_BUCKET_WIDE 1.0         // m, and of the wide one's
#define AISLE_LAYOUT_ID_SCAN (-1)            // "obstacle id" of a scanned cell
#define AISLE_LAYOUT_ID_BOUNDS (-2)          // and of the outside

// Which limit a refusal with AISLE_STATUS_LIMIT means, in its id; value says how much would be needed.
typedef enum aisle_layout_limit {
    AISLE_LAYOUT_LIMIT_CELLS = 1,    // aisle_limits.cells
    AISLE_LAYOUT_LIMIT_POLYGONS = 2, // aisle_limits.polygons
    AISLE_LAYOUT_LIMIT_VERTICES = 3, // aisle_limits.vertices
    AISLE_LAYOUT_LIMIT_SIDE = 4,     // AISLE_GRID_SIDE_MAX
    AISLE_LAYOUT_LIMIT_TILES = 5     // AISLE_LAYOUT_TILES_MAX
} aisle_layout_limit;

// Why a message was refused: an AISLE_STATUS_* cause, the id meant, the number needed or found. All 0 if it was not.
//   LIMIT         id: aisle_layout_limit, value: needed
//   MALFORMED     id: the polygon's, or 0 for the rest of a layout_t or patch; the tile's part for a tile
//                 value for a wrong checksum or number of polygons: the number of polygons that came
//   OUTDATED, REVISION_GAP  id: the revision held (or being taken)
//   MAP_MISMATCH  id: the map held
//   CONFLICT      id: the polygon's or tile's where one is meant, else 0
//   NO_LAYOUT     a tile or patch whose layout_t is not known; send that first
typedef struct aisle_refusal {
    int16_t cause;
    int32_t id;
    float value;
} aisle_refusal;

// The parts below are the layout's own; others go through the functions.

typedef struct aisle_layout_tile {
    uint16_t x0, y0, w, h; // cells; w = 0: not in yet
} aisle_layout_tile;

typedef enum aisle_layout_stage { AISLE_STAGE_EMPTY, AISLE_STAGE_FILLING, AISLE_STAGE_COMPLETE } aisle_layout_stage;

// What the last commit changed: everything, or these polygons. One that moved or says something else has left and come;
// one that came as it was, perhaps in another place of the order, is not listed.
#define AISLE_LAYOUT_CHANGES_MAX (AISLE_LAYOUT_PATCH_MAX_REMOVED + 2U * AISLE_LAYOUT_PATCH_MAX_POLYGONS)
typedef struct aisle_layout_change {
    aisle_aabb box; // m
    int32_t id;
    int8_t kind;    // AISLE_POLYGON_*
    bool is_added;  // it came; else it left
    uint16_t index; // of the zone, in the layout now or in the one before
} aisle_layout_change;
typedef struct aisle_layout_diff {
    bool everything;   // another layout, or a patch on one that was not in force yet; the list is empty
    bool is_reordered; // some that came as they were come later in the order now
    uint32_t count;
    aisle_layout_change *change; // [AISLE_LAYOUT_CHANGES_MAX]
} aisle_layout_diff;

typedef struct aisle_layout_staging { // what is known of the staged store
    aisle_layout_stage stage;
    bool is_patch;                                                                   // made of the active one
    uint64_t parts;                                                                  // bit p set: part p is in
    uint32_t tiles;                                                                  // in
    uint16_t part_first[AISLE_LAYOUT_MAX_PARTS], part_count[AISLE_LAYOUT_MAX_PARTS]; // zones of a part
    aisle_layout_tile *tile;                                                         // [AISLE_LAYOUT_TILES_MAX]
    aisle_id_map ids;                                                                // of the staged zones
    aisle_id_map message;                                                            // of the polygons of one message
    uint16_t *order;                                                                 // [polygons] scratch
    uint32_t named; // zones of the active store that a patch names, listed there
} aisle_layout_staging;

typedef struct aisle_layout {
    aisle_layout_store store[2];
    uint8_t active; // which one; the other is staged
    bool has_active;
    uint8_t phase; // of the build
    uint32_t next; // build progress in the phase
    uint32_t work; // units since the commit, but for those of the whole field
    aisle_layout_staging staging;
    aisle_layout_diff diff;
    aisle_layout_index index; // of the active store
    aisle_layout_index wide;  // of its blocks
    aisle_layout_rects rects; // of its scan
    aisle_grid grid;          // of the active store
    bool is_whole;            // the grid is or was built from the start, not updated
    bool has_base;            // the staged store is still the one before, and grid was its
    aisle_layout_update update;
} aisle_layout;

// A 0 in limits is its default. self is usable unless arena->overflow or measuring.
void aisle_layout_carve(aisle_layout *self, aisle_arena *arena, const aisle_limits *limits);

// Takes one part. AISLE_PARTIAL: more wanted. AISLE_OK: staged is complete (commit it), or a duplicate of what is held
// (aisle_layout_is_staged() tells which). AISLE_BUSY: a complete staged layout waits for commit, send again.
// AISLE_ERR_DATA: refused, nothing has changed, *why says why; only when the last part makes the checksum or the number
// of polygons wrong, staging starts anew.
aisle_status aisle_layout_take_part(aisle_layout *self, const aisle_layout_msg *msg, aisle_refusal *why);
// The same for a tile. A tile tells its place but not the size of the whole, so it is refused (NO_LAYOUT) until a part
// of its revision is in. Tiles must not overlap: their order would matter.
aisle_status aisle_layout_take_tile(aisle_layout *self, const aisle_grid_chunk_msg *msg, aisle_refusal *why);
// Stages active with the edits applied, ready to commit: AISLE_OK, also for the patch that led to the active revision.
// A layout_t of the same or an older revision that is being staged is given up.
aisle_status aisle_layout_take_patch(aisle_layout *self, const aisle_layout_patch_msg *msg, aisle_refusal *why);

bool aisle_layout_is_staged(const aisle_layout *self);   // complete and waiting for commit
bool aisle_layout_is_in_force(const aisle_layout *self); // committed and built
int32_t aisle_layout_map_id(const aisle_layout *self);   // of the active one; 0 if none
int32_t aisle_layout_map_revision(const aisle_layout *self);

// Swaps; not in force until build() says AISLE_OK. Only when is_staged().
void aisle_layout_commit(aisle_layout *self);
// About `units` rows or polygons of work; each index and clearing the grid are one unit each (O(blocks), O(cells)).
// Grid, field and indices come out the same bit for bit whether a patch or a whole layout led to them, and however it was
// cut. AISLE_BUSY, then AISLE_OK. AISLE_ERR_ARG: nothing was committed.
aisle_status aisle_layout_build(aisle_layout *self, uint32_t units);
// Units the build has taken since the commit. O(1).
uint32_t aisle_layout_work(const aisle_layout *self);

// What the last commit changed; everything before the first. Valid until the next commit or patch taken. O(1).
const aisle_layout_diff *aisle_layout_changes(const aisle_layout *self);
// What the layout in force says, as one number (layout_content.h): bounds, cells, polygons, scan; not map_id, revision,
// order of the polygons nor the parts it came in. After any patches the same as of a whole layout that says so. O(1).
uint64_t aisle_layout_content(const aisle_layout *self);

// ---- the layout in force
const aisle_grid *aisle_layout_grid(const aisle_layout *self);
aisle_aabb aisle_layout_bounds(const aisle_layout *self); // with a scan: what they have in common with its extent
uint32_t aisle_layout_zone_count(const aisle_layout *self);
const aisle_zone *aisle_layout_zone(const aisle_layout *self, uint32_t index);
aisle_convex aisle_layout_zone_shape(const aisle_layout *self, const aisle_zone *zone);
bool aisle_layout_has_kind(const aisle_layout *self, int8_t kind); // a zone of this AISLE_POLYGON_* kind

// Blocks: the layout as convex things alone. The zones, by index, then the rectangles that cover the scan's cells; not
// all that are there if has_blocks() is false (AISLE_LAYOUT_RECTS_MAX).
typedef struct aisle_layout_block {
    aisle_vec2 v[4];    // of a rectangle
    aisle_convex shape; // points into v or the layout
    uint32_t corner;    // number of its first corner, of all blocks' corners; below corner_count()
    uint32_t real;      // bit i: at vertex i obstacles are convex (layout_rects.h)
    bool is_obstacle;
} aisle_layout_block;
bool aisle_layout_has_blocks(const aisle_layout *self);
uint32_t aisle_layout_block_count(const aisle_layout *self);
uint32_t aisle_layout_corner_count(const aisle_layout *self);
aisle_aabb aisle_layout_block_box(const aisle_layout *self, uint32_t index);
void aisle_layout_block_at(const aisle_layout *self, uint32_t index, aisle_layout_block *out);
const aisle_layout_index *aisle_layout_wide(const aisle_layout *self); // over the blocks
static inline bool aisle_zone_is_obstacle(const aisle_zone *zone) {
    return zone->kind == AISLE_POLYGON_OBSTACLE || zone->kind == AISLE_POLYGON_KEEPOUT;
}

// Walks the zones whose box overlaps `box` (finite), each once, in no promised but a fixed order: by the buckets the box
// meets, or by the list of all zones where that is shorter. O(the lesser of zones and buckets, and entries met):
//     for (aisle_layout_walk w = aisle_layout_walk_over(layout, box); aisle_layout_walk_next(&w, &zone);) ...
typedef struct aisle_layout_walk {
    const aisle_layout *layout;
    aisle_aabb box;
    uint32_t bx0, by0, bx1, by1, bx, by, at, end;
    bool whole; // at and end are places in the list of all zones
} aisle_layout_walk;
aisle_layout_walk aisle_layout_walk_over(const aisle_layout *self, aisle_aabb box);
bool aisle_layout_walk_next(aisle_layout_walk *walk, const aisle_zone **zone);

// Next run of occupied scan cells in row iy at or after column *ix0 and before ix1: [*ix0, *end). False: none. Only
// where has_scan(); columns and row within the lattice of aisle_layout_grid().
bool aisle_layout_scan_run(const aisle_layout *self, uint32_t iy, uint32_t *ix0, uint32_t ix1, uint32_t *end);
bool aisle_layout_has_scan(const aisle_layout *self);

// Exact gap (m) between a shape in the map frame and the nearest obstacle, at most `cap`; 0 = contact. *id (may be
// NULL): that obstacle, a polygon's id or AISLE_LAYOUT_ID_*; 0 if none within cap. Equal gaps: the least id. A shape
// that is not finite: contact with the bounds. O(zones and scan rows within cap).
double aisle_layout_gap(const aisle_layout *self, const aisle_convex *shape, double cap, int32_t *id);

// The same as if the polygons named were not there; ids that name none change nothing. NULL in place of them: as above.
#define AISLE_LAYOUT_WITHOUT_MAX 2U
typedef struct aisle_layout_without {
    int32_t id[AISLE_LAYOUT_WITHOUT_MAX];
    uint32_t count;
} aisle_layout_without;
double aisle_layout_gap_without(const aisle_layout *self, const aisle_layout_without *without,
                                const aisle_convex *shape, double cap, int32_t *id);
#endif
