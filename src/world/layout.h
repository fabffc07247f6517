// layout.h - the static layout: polygons and a scanned map, taken in parts, in force at once. Level 1.
//
// Two stores, staged and active. Parts of layout_t and tiles of grid_chunk_t fill the staged one in any order;
// when all of one revision are in and the crc32 is right, commit() swaps the stores and a build (bucket
// index, rasterised grid, distance field) runs in slices. Until then the active one stays untouched.
// Obstacles are the polygons of kind OBSTACLE and KEEPOUT, the scan's occupied cells (closed squares; cells no tile
// covers are occupied) and everything outside the bounds.
// Where there is a scan, the planning grid is the scan's lattice: layout_t.resolution must be 0 or the scan's, and
// the bounds must lie within half a cell of the scan's extent. Without one, resolution 0 means 0.05 m, doubled until
// the grid fits the limit.
// Bucket index: square buckets, CSR lists of polygon indices, side doubled until the lists fit.
// Memory: carved once from limits. Time: part O(polygons * vertices); tile O(cells); commit O(polygons); build O(cells).
#ifndef AISLE_WORLD_LAYOUT_H
#define AISLE_WORLD_LAYOUT_H

#include "aisle/limits.h"
#include "aisle/messages.h"
#include "aisle/status.h"
#include "base/arena.h"
#include "world/grid.h"
#include "world/shape.h"

#define AISLE_LAYOUT_RESOLUTION_DEFAULT 0.05 // m
#define AISLE_LAYOUT_ID_SCAN (-1)            // "obstacle id" of a scanned cell
#define AISLE_LAYOUT_ID_BOUNDS (-2)          // and of the outside

// Why a message was refused: an AISLE_STATUS_* cause, the id meant, the number needed or found.
typedef struct aisle_refusal {
    int16_t cause;
    int32_t id;
    float value;
} aisle_refusal;

typedef struct aisle_zone { // one polygon of the layout
    aisle_aabb box;
    uint32_t first; // of its vertices in the store
    int32_t id;
    float value, direction;
    uint8_t n;   // 3..16
    int8_t kind; // AISLE_POLYGON_*
} aisle_zone;

// The parts below are the layout's own; others go through the functions.
typedef struct aisle_layout aisle_layout; // struct completed by the implementer further down

void aisle_layout_carve(aisle_layout *self, aisle_arena *arena, const aisle_limits *limits);

// Takes one part. AISLE_PARTIAL: more wanted. AISLE_OK: staged is complete (commit it), or a duplicate of what is held
// (aisle_layout_is_staged() tells which). AISLE_BUSY: a complete staged layout waits for commit. AISLE_ERR_DATA: *why.
aisle_status aisle_layout_take_part(aisle_layout *self, const aisle_layout_msg *msg, aisle_refusal *why);
aisle_status aisle_layout_take_tile(aisle_layout *self, const aisle_grid_chunk_msg *msg, aisle_refusal *why);
// Stages active with the edits applied, ready to commit.
aisle_status aisle_layout_take_patch(aisle_layout *self, const aisle_layout_patch_msg *msg, aisle_refusal *why);

bool aisle_layout_is_staged(const aisle_layout *self);   // complete and waiting for commit
bool aisle_layout_is_in_force(const aisle_layout *self); // committed and built
int32_t aisle_layout_map_id(const aisle_layout *self);   // of the active one; 0 if none
int32_t aisle_layout_map_revision(const aisle_layout *self);

void aisle_layout_commit(aisle_layout *self); // swaps; not in force until build() says AISLE_OK
// About `units` rows or polygons of work. AISLE_BUSY, then AISLE_OK.
aisle_status aisle_layout_build(aisle_layout *self, uint32_t units);

// ---- the layout in force
const aisle_grid *aisle_layout_grid(const aisle_layout *self);
aisle_aabb aisle_layout_bounds(const aisle_layout *self);
const aisle_zone *aisle_layout_zone(const aisle_layout *self, uint32_t index);
aisle_convex aisle_layout_zone_shape(const aisle_layout *self, const aisle_zone *zone);

// Walks the zones whose box overlaps `box`, each once, in no promised but a fixed order:
//     for (aisle_layout_walk w = aisle_layout_walk_over(layout, box); aisle_layout_walk_next(&w, &zone);) ...
typedef struct aisle_layout_walk {
    const aisle_layout *layout;
    aisle_aabb box;
    uint32_t bx0, bx1, by1, bx, by, at, end;
} aisle_layout_walk;
aisle_layout_walk aisle_layout_walk_over(const aisle_layout *self, aisle_aabb box);
bool aisle_layout_walk_next(aisle_layout_walk *walk, const aisle_zone **zone);

// Next run of occupied scan cells in row iy at or after column *ix0 and before ix1: [*ix0, *end). False: none.
bool aisle_layout_scan_run(const aisle_layout *self, uint32_t iy, uint32_t *ix0, uint32_t ix1, uint32_t *end);
bool aisle_layout_has_scan(const aisle_layout *self);

// Exact gap (m) between a shape in the map frame and the nearest obstacle, at most `cap`; 0 = contact. *id (may be
// NULL): that obstacle, a polygon's id or AISLE_LAYOUT_ID_*; 0 if none within cap. Equal gaps: the least id.
double aisle_layout_gap(const aisle_layout *self, const aisle_convex *shape, double cap, int32_t *id);
#endif
