// Sampling planners alone on a hall: one JSON object on standard output; with a file name the first seed's tree goes there.
//
//     bench-sampling PLANNER STEP PLAIN FIRST_SEED SEEDS SAMPLES MS [TREE] < hall
//
// The hall as hall.h says; headings are left out (configurations are places). PLANNER: as options_t has it. STEP: m. PLAIN 0:
// what the library makes of it; 1: the paper's form. SAMPLES: at most, 0: as the library. MS: a star goes on for so long (of process
// time), 0: until its samples end. Per seed: ms and samples to the first path and its length, nodes, lengths at 1, 5, 20 and
// 100 ms; null where there is none. TREE: lines "x y parent_x parent_y", then "path x y ...".
#include "aisle/messages.h"
#include "algo/rrt.h"
#include "hall.h"
#include "plan/vehicle_space.h"

#include <stdio.h>
#include <stdlib.h>
#include <time.h>

enum { BLOCK = 160 << 20, CELLS = 1 << 22, NODES = 32768, UNITS = 64, MARKS = 4 };

static const double marks[MARKS] = {1.0, 5.0, 20.0, 100.0}; // ms
static hall scene;
static aisle_space space;
static aisle_vehicle_space places;
static aisle_rrt tree;
static uint32_t path[NODES + 1];

static double ms_now(void) {
    struct timespec t;
    (void)clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return 1e3 * (double)t.tv_sec + 1e-6 * (double)t.tv_nsec;
}

static void print_number(const char *name, double value) {
    if (value < (double)INFINITY) {
        printf(", \"%s\": %.6f", name, value);
    } else {
        printf(", \"%s\": null", name);
    }
}

static void run(const aisle_rrt_config *cfg, double most) {
    double first = (double)INFINITY, at[MARKS];
    uint32_t mark = 0, units = 0;
    const double began = ms_now();
    if (aisle_rrt_start(&tree, cfg) != AISLE_OK) {
        hall_fail("these numbers make no tree");
    }
    aisle_status st = AISLE_BUSY;
    for (double now = 0.0; st == AISLE_BUSY && (most <= 0.0 || now < most || first > now);) {
        const double before = aisle_rrt_cost(&tree);
        st = aisle_rrt_step(&tree, UNITS, &units);
        now = ms_now() - began;
        first = before > 1e300 && aisle_rrt_cost(&tree) < 1e300 ? now : first;
        for (; mark < MARKS && now > marks[mark]; mark++) {
            at[mark] = before;
        }
        if (most > 0.0 && now > 60.0 * most) {
            break;
        }
    }
    const double all = ms_now() - began;
    for (; mark < MARKS; mark++) {
        at[mark] = aisle_rrt_cost(&tree);
    }
    printf("{\"seed\": %llu, \"nodes\": %u, \"units\": %u", (unsigned long long)cfg->seed, tree.near.count, units);
    print_number("ms", all);
    print_number("first_ms", first);
    print_number("first_samples", tree.first_sample == AISLE_RRT_NONE ? (double)INFINITY : (double)tree.first_sample);
    print_number("first", tree.first_cost);
    printf(", \"at\": [");
    for (mark = 0; mark < MARKS; mark++) {
        if (at[mark] < (double)INFINITY) {
            printf("%s%.6f", mark > 0U ? ", " : "", at[mark]);
        } else {
            printf("%snull", mark > 0U ? ", " : "");
        }
    }
    printf("]}");
}

static void write_tree(const char *name) {
    FILE *out = fopen(name, "w");
    if (out == NULL) {
        hall_fail("the tree's file cannot be written");
    }
    for (uint32_t n = 1; n < tree.near.count; n++) {
        const double *q = aisle_rrt_at(&tree, n), *p = aisle_rrt_at(&tree, tree.node[n].parent);
        fprintf(out, "%.6f %.6f %.6f %.6f\n", q[0], q[1], p[0], p[1]);
    }
    fprintf(out, "path");
    const uint32_t count = aisle_rrt_path(&tree, path, NODES + 1);
    for (uint32_t i = 0; i < count; i++) {
        const double *q = aisle_rrt_at(&tree, path[i]);
        fprintf(out, " %.6f %.6f", q[0], q[1]);
    }
    fprintf(out, "\n");
    fclose(out);
}

int main(int argc, char **argv) {
    if (argc < 8 || argc > 9) {
        hall_fail("bench-sampling PLANNER STEP PLAIN FIRST_SEED SEEDS SAMPLES MS [TREE] < hall");
    }
    const int planner = atoi(argv[1]);
    const bool plain = atoi(argv[3]) != 0;
    const long first_seed = atol(argv[4]), seeds = atol(argv[5]);
    aisle_arena arena = hall_arena(BLOCK);
    hall_read(&scene, &arena, CELLS);
    aisle_space_carve(&space, &arena, CELLS);
    aisle_space_begin(&space, &scene.layout, &scene.vehicle, AISLE_SPACE_FREE_TURN);
    aisle_rrt_carve(&tree, &arena, NODES, 2U);
    if (arena.overflow || planner < AISLE_OPTIONS_RRT || planner > AISLE_OPTIONS_RRT_STAR_ADAPTIVE) {
        hall_fail("no such planner");
    }
    aisle_vehicle_space_begin(&places, &space, AISLE_VEHICLE_SPACE_PLACE);
    const bool star = planner >= AISLE_OPTIONS_RRT_STAR;
    const bool adaptive = planner == AISLE_OPTIONS_RRT_ADAPTIVE || planner == AISLE_OPTIONS_RRT_STAR_ADAPTIVE;
    aisle_rrt_config cfg = aisle_vehicle_space_rrt(&places, star, adaptive, plain, atof(argv[2]));
    cfg.start[0] = scene.start.x;
    cfg.start[1] = scene.start.y;
    cfg.goal[0] = scene.goal.x;
    cfg.goal[1] = scene.goal.y;
    if (atol(argv[6]) > 0) {
        cfg.samples = (uint32_t)atol(argv[6]);
    }
    cfg.more = atof(argv[7]) > 0.0 ? UINT32_MAX : cfg.more;
    printf("[");
    for (long i = 0; i < seeds; i++) {
        cfg.seed = (uint64_t)(first_seed + i);
        printf(i > 0 ? ",\n" : "");
        run(&cfg, atof(argv[7]));
        if (i == 0 && argc == 9) {
            write_tree(argv[8]);
        }
    }
    printf("]\n");
    return 0;
}
