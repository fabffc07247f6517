// Sampling planners alone on a hall: one JSON object on standard output; with a file name the first seed's tree goes there.
//
//     bench-sampling PLANNER STEP PLAIN FIRST_SEED SEEDS SAMPLES MS [TREE] < hall
//
// The hall as hall.h says; headings are left out (configurations are places). PLANNER: as options_t has it, RRT to PRM. STEP:
// m. PLAIN 0: what the library makes of it; 1: the paper's form. SAMPLES: at most, 0: as the library. MS: a star goes on for so
// long (of process time), 0: until its samples end, below 0: until it has a path. Per seed: ms and samples to the first path and its length, nodes, lengths
// at 1, 5, 20 and 100 ms, the last path; null where there is none. TREE: lines "x y parent_x parent_y", then "path x y ...".
// PRM: lazy, FIRST_DRAWS draws and twice as many whenever they do not join the ends or, with MS, as long as there is time;
// STEP and PLAIN mean nothing to it.
#include "aisle/messages.h"
#include "algo/roadmap.h"
#include "algo/rrt.h"
#include "hall.h"
#include "plan/vehicle_space.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { BLOCK = 160 << 20, CELLS = 1 << 22, NODES = 32768, UNITS = 64, UNITS_FIRST = 64, MARKS = 4 };
enum { FIRST_DRAWS = 8, UNIFORM = 448, LINKS = 10 }; // the latter two as by name

static const double marks[MARKS] = {1.0, 5.0, 20.0, 100.0}; // ms
static hall scene;
static aisle_space space;
static aisle_vehicle_space places;
static aisle_rrt tree;
static uint32_t path[NODES + 1];
static aisle_roadmap roadmap;
static aisle_roadmap_search search;
static double way[2 * (NODES + 1)], best_way[2 * (NODES + 1)];
static double cap; // ms, 0: none

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

typedef struct outcome {
    double began, first, at[MARKS], best; // ms; ms since then; lengths
    double first_length;
    uint32_t mark, units;
} outcome;

static outcome begin(void) {
    outcome o = {.first = (double)INFINITY, .best = (double)INFINITY, .first_length = (double)INFINITY};
    o.began = ms_now();
    return o;
}

// What is known by now; up to now it was o->best. ms since it began.
static double note(outcome *o, double length) {
    const double now = ms_now() - o->began;
    for (; o->mark < MARKS && now > marks[o->mark]; o->mark++) {
        o->at[o->mark] = o->best;
    }
    if (length < o->best && o->best > 1e300) {
        o->first = now;
        o->first_length = length;
    }
    o->best = length < o->best ? length : o->best;
    return now;
}

static void print_length(double length, const char *before) {
    if (length < (double)INFINITY) {
        printf("%s%.6f", before, length);
    } else {
        printf("%snull", before);
    }
}

static void print_outcome(outcome *o, uint64_t seed, uint32_t nodes, double samples, uint32_t way_count) {
    const double all = ms_now() - o->began;
    for (; o->mark < MARKS; o->mark++) {
        o->at[o->mark] = o->best;
    }
    printf("{\"seed\": %llu, \"nodes\": %u, \"units\": %u", (unsigned long long)seed, nodes, o->units);
    print_number("ms", all);
    print_number("first_ms", o->first);
    print_number("first_samples", samples);
    print_number("first", o->first_length);
    printf(", \"at\": [");
    for (uint32_t mark = 0; mark < MARKS; mark++) {
        print_length(o->at[mark], mark > 0U ? ", " : "");
    }
    printf("], \"path\": [");
    for (uint32_t i = 0; i < way_count; i++) {
        printf("%s[%.9f, %.9f]", i > 0U ? ", " : "", way[2U * i], way[2U * i + 1U]);
    }
    printf("]}");
}

static void grow_tree(const aisle_rrt_config *cfg) {
    outcome o = begin();
    if (aisle_rrt_start(&tree, cfg) != AISLE_OK) {
        hall_fail("these numbers make no tree");
    }
    aisle_status st = AISLE_BUSY;
    double now = note(&o, aisle_rrt_cost(&tree));
    while (st == AISLE_BUSY && (cap <= 0.0 || now < cap || (o.first > now && now < 60.0 * cap))) {
        st = aisle_rrt_step(&tree, o.first < now ? UNITS : UNITS_FIRST, &o.units);
        now = note(&o, aisle_rrt_cost(&tree));
    }
    const uint32_t count = aisle_rrt_path(&tree, path, NODES + 1);
    for (uint32_t i = 0; i < count; i++) {
        way[2U * i] = aisle_rrt_at(&tree, path[i])[0];
        way[2U * i + 1U] = aisle_rrt_at(&tree, path[i])[1];
    }
    const bool found = tree.first_sample != AISLE_RRT_NONE;
    print_outcome(&o, cfg->seed, tree.near.count, found ? (double)tree.first_sample : (double)INFINITY, count);
}

// Leaves out of the way what it can, as route_sample.c does; how many are left.
static uint32_t cut_way(const aisle_cspace *within, uint32_t count, uint32_t *units) {
    uint32_t kept = count > 0U ? 1U : 0U;
    for (uint32_t at = 1; at < count; at++) {
        if (at + 1U == count ||
            !within->is_free(within->context, way + 2U * (kept - 1U), way + 2U * (at + 1U), units)) {
            way[2U * kept] = way[2U * at];
            way[2U * kept + 1U] = way[2U * at + 1U];
            kept++;
        }
    }
    return kept;
}

static double length_of_way(const aisle_cspace *within, uint32_t count) {
    double length = 0.0;
    for (uint32_t i = 1; i < count; i++) {
        length += aisle_cspace_distance(within, way + 2U * i - 2U, way + 2U * i);
    }
    return length;
}

// The shortest way through the roadmap as it is, cut; what is the best so far is kept in best_way.
static double ask(const aisle_rrt_config *cfg, double best, uint32_t *best_count, uint32_t *units) {
    aisle_roadmap_ask(&search, &roadmap, AISLE_ROADMAP_ASTAR, cfg->start, cfg->goal, units);
    while (aisle_roadmap_search_step(&search, UNITS, units) == AISLE_BUSY) {
    }
    const uint32_t count = cut_way(cfg->space, aisle_roadmap_way(&search, way, NODES + 1), units);
    const double length = count > 0U ? length_of_way(cfg->space, count) : (double)INFINITY;
    if (length < best) {
        memcpy(best_way, way, 2U * count * sizeof way[0]);
        *best_count = count;
    }
    return length;
}

static void grow_roadmap(const aisle_rrt_config *cfg) {
    const aisle_roadmap_config draws = {.samples = FIRST_DRAWS, .uniform = UNIFORM, .seed = cfg->seed};
    outcome o = begin();
    uint32_t first_draws = 0, count = 0;
    (void)aisle_roadmap_start(&roadmap, cfg->space, &draws);
    for (double now = 0.0;;) {
        while (aisle_roadmap_step(&roadmap, UNITS, &o.units) == AISLE_BUSY) {
        }
        now = note(&o, ask(cfg, o.best, &count, &o.units));
        first_draws = first_draws == 0U && o.best < 1e300 ? roadmap.count : first_draws;
        if ((o.best < 1e300 && now >= cap) || (cap > 0.0 && now > 60.0 * cap) ||
            aisle_roadmap_grow(&roadmap, 2U * roadmap.count) != AISLE_OK) {
            break;
        }
    }
    memcpy(way, best_way, 2U * count * sizeof way[0]);
    print_outcome(&o, cfg->seed, roadmap.free_count, first_draws > 0U ? (double)first_draws : (double)INFINITY, count);
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
    aisle_roadmap_carve(&roadmap, &arena, 2U, NODES, LINKS);
    aisle_roadmap_search_carve(&search, &arena, NODES);
    if (arena.overflow || planner < AISLE_OPTIONS_RRT || planner > AISLE_OPTIONS_PRM) {
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
    cap = atof(argv[7]);
    cfg.more = cap > 0.0 ? UINT32_MAX : cap < 0.0 ? 0U : cfg.more;
    printf("[");
    for (long i = 0; i < seeds; i++) {
        cfg.seed = (uint64_t)(first_seed + i);
        printf(i > 0 ? ",\n" : "");
        if (planner == AISLE_OPTIONS_PRM) {
            grow_roadmap(&cfg);
        } else {
            grow_tree(&cfg);
        }
        if (i == 0 && argc == 9 && planner != AISLE_OPTIONS_PRM) {
            write_tree(argv[8]);
        }
    }
    printf("]\n");
    return 0;
}
