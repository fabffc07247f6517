// limits.h - the ceilings from which every byte of a planner is sized. Level: public.
//
// Zero in any field means its default. Fields may be lowered or raised up to the ranges below;
// aisle_planner_memsize() turns them into one number of bytes. With the defaults it is below 24 MiB.
#ifndef AISLE_LIMITS_H
#define AISLE_LIMITS_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct aisle_limits {
    uint32_t cells;        // cells of the planning grid, any shape; default 4194304, [4096, 16777216]
    uint32_t polygons;     // polygons of a layout; default 4096, [1, 4096]
    uint32_t vertices;     // vertices of all its polygons; default 32768, [3, 65536]
    uint32_t open_nodes;   // entries of the grid search's open list; default 131072, [1024, 4194304]
    uint32_t requests;     // goal lists and queries waiting; default 16, [1, 64]
    uint32_t cached_paths; // answers remembered, 8 KiB each (long ones take several); default 64, [1, 1024]
} aisle_limits;

#define AISLE_LIMITS_CELLS_DEFAULT 4194304U
#define AISLE_LIMITS_CELLS_MAX 16777216U
#define AISLE_LIMITS_POLYGONS_DEFAULT 4096U
#define AISLE_LIMITS_VERTICES_DEFAULT 32768U
#define AISLE_LIMITS_OPEN_NODES_DEFAULT 131072U
#define AISLE_LIMITS_REQUESTS_DEFAULT 16U
#define AISLE_LIMITS_CACHED_PATHS_DEFAULT 64U

#ifdef __cplusplus
}
#endif
#endif
