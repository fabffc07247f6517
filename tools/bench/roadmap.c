// The roadmap of PRM alone on a hall: one JSON object on standard output.
//
//     bench-roadmap DRAWS EAGER PAIRS PATCHES BOX SEED < hall
//
// The hall as hall.h says; configurations are places for a disc, poses for others. A roadmap of DRAWS (1: every edge tested
// first; 0: when a search comes to it) is built, then asked by A* for PAIRS pairs of free configurations drawn at random, twice:
// cold_us and warm_us. Then PATCHES times a box of side BOX (m) comes at a random place or the last one goes: us of the repair
// and of the next 10 queries, and the same of a roadmap built anew. Medians, p99 of the queries; of process time.
#include "hall.h"
#include "plan/roadmap_keep.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { BLOCK = 160 << 20, CELLS = 1 << 22, PAIRS_MAX = 4096, AFTER = 10, BOX_ID = 2000000 };

static hall scene;
static aisle_space space;
static aisle_vehicle_space configurations;
static aisle_roadmap_keep kept, fresh;
static aisle_roadmap_search search;
static aisle_roadmap_wish wish;
static aisle_layout_patch_msg patch;
static double pair[PAIRS_MAX][2][AISLE_CSPACE_DIM_MAX], us[4][PAIRS_MAX];
static aisle_rng rng;

static double us_now(void) {
    struct timespec t;
    (void)clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return 1e6 * (double)t.tv_sec + 1e-3 * (double)t.tv_nsec;
}

static int compare(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return x < y ? -1 : x > y;
}

static void print_times(const char *name, double *values, uint32_t n) {
    if (n == 0U) {
        return;
    }
    qsort(values, n, sizeof values[0], compare);
    printf(", \"%s\": [%.1f, %.1f]", name, values[n / 2U], values[(99U * n) / 100U]);
}

static double build(aisle_roadmap_keep *self) {
    uint32_t spent = 0;
    const double from = us_now();
    aisle_roadmap_keep_begin(self, &wish);
    while (aisle_roadmap_keep_step(self, &configurations, UINT32_MAX, &spent) == AISLE_BUSY) {
    }
    return us_now() - from;
}

static bool ask(aisle_roadmap_keep *self, uint32_t n, double *took) {
    uint32_t spent = 0;
    aisle_status st;
    const double from = us_now();
    aisle_roadmap_ask(&search, &self->map, AISLE_ROADMAP_ASTAR, pair[n][0], pair[n][1], &spent);
    while ((st = aisle_roadmap_search_step(&search, UINT32_MAX, &spent)) == AISLE_BUSY) {
    }
    *took = us_now() - from;
    return st == AISLE_OK;
}

static void begin_spaces(void) {
    const bool is_disc = aisle_vehicle_is_disc(&scene.vehicle);
    aisle_space_begin(&space, &scene.layout, &scene.vehicle, is_disc ? AISLE_SPACE_FREE_TURN : AISLE_SPACE_ALONG);
    aisle_vehicle_space_begin(&configurations, &space, is_disc ? AISLE_VEHICLE_SPACE_PLACE : AISLE_VEHICLE_SPACE_POSE);
}

static void draw_free(double *q) {
    const aisle_cspace *c = &configurations.cspace;
    uint32_t spent = 0;
    do {
        c->sample(c->context, &rng, q);
    } while (!c->is_free(c->context, q, q, &spent));
}

static void put_box(double side) {
    const double *lo = configurations.cspace.lo, *hi = configurations.cspace.hi;
    const double x = lo[0] + (hi[0] - lo[0]) * (double)aisle_rng_float(&rng);
    const double y = lo[1] + (hi[1] - lo[1]) * (double)aisle_rng_float(&rng);
    const aisle_aabb bounds = aisle_layout_bounds(&scene.layout);
    const double x1 = aisle_min(x + side, bounds.hi.x), y1 = aisle_min(y + side, bounds.hi.y);
    const double v[4][2] = {{x, y}, {x1, y}, {x1, y1}, {x, y1}};
    patch.num_polygons = 1;
    patch.polygons[0].id = BOX_ID;
    patch.polygons[0].num_vertices = 4;
    memcpy(patch.polygons[0].vertices, v, sizeof v);
}

static void send_patch(bool comes, double side) {
    aisle_refusal why;
    memset(&patch, 0, sizeof patch);
    patch.map_id = aisle_layout_map_id(&scene.layout);
    patch.base_revision = aisle_layout_map_revision(&scene.layout);
    patch.map_revision = patch.base_revision + 1;
    if (comes) {
        put_box(side);
    } else {
        patch.num_removed = 1;
        patch.removed[0] = BOX_ID;
    }
    if (aisle_layout_take_patch(&scene.layout, &patch, &why) != AISLE_OK) {
        hall_fail("the patch was refused");
    }
    aisle_layout_commit(&scene.layout);
    while (aisle_layout_build(&scene.layout, UINT32_MAX) == AISLE_BUSY) {
    }
    aisle_roadmap_keep_note(&kept, &scene.layout);
    begin_spaces();
}

// The next questions, of pairs that may be covered by now.
static double ask_after(aisle_roadmap_keep *self, uint32_t pairs) {
    double sum = 0.0, took;
    for (uint32_t i = 0; i < AFTER && i < pairs; i++) {
        (void)ask(self, i, &took);
        sum += took;
    }
    return sum;
}

static void run_queries(uint32_t pairs) {
    uint32_t found = 0;
    for (uint32_t i = 0; i < pairs; i++) {
        draw_free(pair[i][0]);
        draw_free(pair[i][1]);
        found += ask(&kept, i, &us[0][i]) ? 1U : 0U;
    }
    const uint32_t tested = kept.map.edge_tests;
    for (uint32_t i = 0; i < pairs; i++) {
        (void)ask(&kept, i, &us[1][i]);
    }
    printf(", \"pairs\": %u, \"found\": %u, \"edge_tests\": %u", pairs, found, tested);
    print_times("cold_us", us[0], pairs);
    print_times("warm_us", us[1], pairs);
}

static void run_patches(uint32_t patches, uint32_t pairs, double side) {
    const uint32_t retested = kept.map.retested;
    for (uint32_t i = 0; i < patches; i++) {
        send_patch(i % 2U == 0U, side);
        us[0][i] = build(&kept);
        us[1][i] = ask_after(&kept, pairs);
        fresh.is_begun = false;
        us[2][i] = build(&fresh);
        us[3][i] = ask_after(&fresh, pairs);
    }
    printf(", \"patches\": %u, \"retested\": %.1f", patches,
           patches > 0U ? (double)(kept.map.retested - retested) / patches : 0.0);
    print_times("repair_us", us[0], patches);
    print_times("after_repair_us", us[1], patches);
    print_times("rebuild_us", us[2], patches);
    print_times("after_rebuild_us", us[3], patches);
}

int main(int argc, char **argv) {
    if (argc != 7) {
        hall_fail("bench-roadmap DRAWS EAGER PAIRS PATCHES BOX SEED < hall");
    }
    const uint32_t draws = (uint32_t)atol(argv[1]), pairs = (uint32_t)atol(argv[3]), patches = (uint32_t)atol(argv[4]);
    if (draws < 1U || draws > AISLE_ROADMAP_SAMPLES_MAX || pairs > PAIRS_MAX || patches > PAIRS_MAX) {
        hall_fail("a number is out of range");
    }
    aisle_arena arena = hall_arena(BLOCK);
    hall_read(&scene, &arena, CELLS);
    aisle_space_carve(&space, &arena, CELLS);
    aisle_roadmap_keep_carve(&kept, &arena, draws);
    aisle_roadmap_keep_carve(&fresh, &arena, draws);
    aisle_roadmap_search_carve(&search, &arena, draws);
    if (arena.overflow) {
        hall_fail("too many draws");
    }
    begin_spaces();
    rng = aisle_rng_seed((uint64_t)atol(argv[6]));
    const bool is_pose = configurations.kind == AISLE_VEHICLE_SPACE_POSE;
    wish =
        (aisle_roadmap_wish){.layout = &scene.layout,
                             .configurations = &configurations,
                             .config = {.samples = draws, .seed = 1, .eager = atoi(argv[2]) != 0, .one_way = is_pose}};
    const double built = build(&kept);
    printf("{\"draws\": %u, \"nodes\": %u, \"build_us\": %.1f", draws, kept.map.free_count, built);
    run_queries(pairs);
    run_patches(patches, pairs, atof(argv[5]));
    printf("}\n");
    return 0;
}
