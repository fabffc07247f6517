// The fourth paper's planners: a hall on standard input, one JSON object per seed on standard output.
//
//     paper-sampling PLANNER PLAIN STEP FIRST_SEED SEEDS SAMPLES MORE NEIGHBOURS DRAWN < hall
//
// The hall as hall.h says; configurations are places. PLANNER: as options_t has it, RRT to RRT_STAR_ADAPTIVE or PRM. PLAIN 1:
// the paper's form, a roadmap with every edge tested while it is built; 0: ours. STEP: m, of the trees, 0: chosen by the
// hall. SAMPLES: drawn at most, of PRM all drawn. MORE: of a star, drawn after the first path. NEIGHBOURS: of PRM, each
// node's nearest. Of the first DRAWN seeds the tree or roadmap is told, too.
// Times are the processor's, ms. "first_ms": to the first path, of PRM to the roadmap's first answer; "ms": until the
// planner ends; "query_ms": of that the search on the roadmap alone. Lengths in m; null: there is no path.
#include "aisle/messages.h"
#include "algo/roadmap.h"
#include "algo/rrt.h"
#include "hall.h"
#include "plan/vehicle_space.h"

#include <stdio.h>
#include <stdlib.h>
#include <time.h>

enum { BLOCK = 48 << 20, CELLS = 1 << 17, NODES = 65000, UNITS = 64 };

typedef struct settings {
    int planner;
    bool is_plain;
    double step;
    uint32_t samples, more, neighbours;
} settings;

static hall scene;
static aisle_space space;
static aisle_vehicle_space places;
static aisle_rrt tree;
static aisle_roadmap roadmap;
static aisle_roadmap_search search;
static uint32_t path[NODES + 1];
static double way[2 * (NODES + 2)];

static double ms_now(void) {
    struct timespec t;
    (void)clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return 1e3 * (double)t.tv_sec + 1e-6 * (double)t.tv_nsec;
}

static void print_number(const char *name, double value) {
    if (value < (double)INFINITY) {
        (void)printf(", \"%s\": %.6f", name, value);
    } else {
        (void)printf(", \"%s\": null", name);
    }
}

static void print_edge(bool is_first, const double *a, const double *b) {
    (void)printf("%s[%.5f, %.5f, %.5f, %.5f]", is_first ? "" : ", ", a[0], a[1], b[0], b[1]);
}

static void print_way(const double *q, uint32_t count) {
    (void)printf(", \"path\": [");
    for (uint32_t i = 0; i < count; i++) {
        (void)printf("%s[%.17g, %.17g]", i > 0U ? ", " : "", q[2U * i], q[2U * i + 1U]);
    }
    (void)printf("]");
}

// ---- trees

static aisle_rrt_config tree_config(const settings *s, uint64_t seed) {
    const bool star = s->planner >= AISLE_OPTIONS_RRT_STAR;
    const bool adaptive = s->planner == AISLE_OPTIONS_RRT_ADAPTIVE || s->planner == AISLE_OPTIONS_RRT_STAR_ADAPTIVE;
    aisle_rrt_config cfg = aisle_vehicle_space_rrt(&places, star, adaptive, s->is_plain, s->step);
    cfg.start[0] = scene.start.x;
    cfg.start[1] = scene.start.y;
    cfg.goal[0] = scene.goal.x;
    cfg.goal[1] = scene.goal.y;
    cfg.samples = s->samples;
    cfg.more = s->more;
    cfg.seed = seed;
    return cfg;
}

static uint32_t tree_way(void) {
    const uint32_t count = aisle_rrt_path(&tree, path, NODES + 1);
    for (uint32_t i = 0; i < count; i++) {
        const double *q = aisle_rrt_at(&tree, path[i]);
        way[2U * i] = q[0];
        way[2U * i + 1U] = q[1];
    }
    return count;
}

static void print_tree(void) {
    (void)printf(", \"edges\": [");
    for (uint32_t n = 1; n < tree.near.count; n++) {
        print_edge(n == 1U, aisle_rrt_at(&tree, tree.node[n].parent), aisle_rrt_at(&tree, n));
    }
    (void)printf("]");
}

static void grow(const settings *s, uint64_t seed, bool is_drawn) {
    const aisle_rrt_config cfg = tree_config(s, seed);
    const double began = ms_now();
    double first = (double)INFINITY;
    uint32_t units = 0;
    if (aisle_rrt_start(&tree, &cfg) != AISLE_OK) {
        hall_fail("these numbers make no tree");
    }
    for (aisle_status st = AISLE_BUSY; st == AISLE_BUSY;) {
        st = aisle_rrt_step(&tree, UNITS, &units);
        if (first > 1e300 && aisle_rrt_cost(&tree) < (double)INFINITY) {
            first = ms_now() - began;
        }
    }
    const double all = ms_now() - began;
    (void)printf("{\"seed\": %u, \"nodes\": %u, \"samples\": %u, \"kept\": %u, \"rewired\": %u", (unsigned)seed,
                 (unsigned)tree.near.count, (unsigned)tree.samples, (unsigned)tree.kept, (unsigned)tree.rewired);
    print_number("ms", all);
    print_number("first_ms", first);
    print_number("first_length", tree.first_cost);
    print_number("length", aisle_rrt_cost(&tree));
    print_way(way, tree_way());
    if (is_drawn) {
        print_tree();
    }
    (void)printf("}\n");
}

// ---- the roadmap

static void print_roadmap(void) {
    bool is_first = true;
    (void)printf(", \"edges\": [");
    for (uint32_t a = 0; a < roadmap.count; a++) {
        for (uint32_t b = 0; b < a && aisle_roadmap_is_node(&roadmap, a); b++) {
            if (aisle_roadmap_is_node(&roadmap, b) && aisle_roadmap_edge(&roadmap, a, b) == AISLE_ROADMAP_FREE) {
                print_edge(is_first, &roadmap.q[2U * a], &roadmap.q[2U * b]);
                is_first = false;
            }
        }
    }
    (void)printf("]");
}

static aisle_status ask(void) {
    const double from[2] = {scene.start.x, scene.start.y}, to[2] = {scene.goal.x, scene.goal.y};
    uint32_t units = 0;
    aisle_status st;
    aisle_roadmap_ask(&search, &roadmap, AISLE_ROADMAP_DIJKSTRA, from, to, &units);
    while ((st = aisle_roadmap_search_step(&search, 1U << 20, &units)) == AISLE_BUSY) {
    }
    return st;
}

static void build(const settings *s, uint64_t seed, bool is_drawn) {
    const aisle_roadmap_config cfg = {.samples = s->samples, .seed = seed, .eager = s->is_plain};
    const double began = ms_now();
    uint32_t units = 0;
    if (aisle_roadmap_start(&roadmap, &places.cspace, &cfg) != AISLE_OK) {
        hall_fail("these numbers make no roadmap");
    }
    while (aisle_roadmap_step(&roadmap, 1U << 20, &units) == AISLE_BUSY) {
    }
    const double built = ms_now() - began;
    const bool found = ask() == AISLE_OK;
    const double all = ms_now() - began;
    const double length = found ? aisle_roadmap_cost(&search) : (double)INFINITY;
    (void)printf("{\"seed\": %u, \"nodes\": %u, \"samples\": %u", (unsigned)seed, (unsigned)roadmap.free_count,
                 (unsigned)roadmap.count);
    print_number("ms", all);
    print_number("query_ms", all - built);
    print_number("first_ms", found ? all : (double)INFINITY);
    print_number("first_length", length);
    print_number("length", length);
    print_way(way, found ? aisle_roadmap_way(&search, way, NODES + 2) : 0U);
    if (is_drawn) {
        print_roadmap();
    }
    (void)printf("}\n");
}

static settings settings_of(char **argv) {
    const settings s = {.planner = (int)strtol(argv[1], NULL, 10),
                        .is_plain = strtol(argv[2], NULL, 10) != 0,
                        .step = strtod(argv[3], NULL),
                        .samples = (uint32_t)strtoul(argv[6], NULL, 10),
                        .more = (uint32_t)strtoul(argv[7], NULL, 10),
                        .neighbours = (uint32_t)strtoul(argv[8], NULL, 10)};
    const bool is_tree = s.planner >= AISLE_OPTIONS_RRT && s.planner <= AISLE_OPTIONS_RRT_STAR_ADAPTIVE;
    if ((!is_tree && s.planner != AISLE_OPTIONS_PRM) || s.neighbours < 1U || s.neighbours > AISLE_ROADMAP_K_MAX) {
        hall_fail("no such planner, or too many neighbours");
    }
    return s;
}

int main(int argc, char **argv) {
    if (argc != 10) {
        hall_fail("usage: paper-sampling PLANNER PLAIN STEP FIRST_SEED SEEDS SAMPLES MORE NEIGHBOURS DRAWN < hall");
    }
    const settings s = settings_of(argv);
    aisle_arena arena = hall_arena(BLOCK);
    hall_read(&scene, &arena, CELLS);
    aisle_space_carve(&space, &arena, CELLS);
    aisle_space_begin(&space, &scene.layout, &scene.vehicle, AISLE_SPACE_FREE_TURN);
    aisle_vehicle_space_begin(&places, &space, AISLE_VEHICLE_SPACE_PLACE);
    if (s.planner == AISLE_OPTIONS_PRM) {
        aisle_roadmap_carve(&roadmap, &arena, 2U, NODES, s.neighbours);
        aisle_roadmap_search_carve(&search, &arena, NODES);
    } else {
        aisle_rrt_carve(&tree, &arena, NODES, 2U);
    }
    if (arena.overflow) {
        hall_fail("no memory");
    }
    const unsigned long first = strtoul(argv[4], NULL, 10), seeds = strtoul(argv[5], NULL, 10);
    const unsigned long drawn = strtoul(argv[9], NULL, 10);
    for (unsigned long i = 0; i < seeds; i++) {
        (s.planner == AISLE_OPTIONS_PRM ? build : grow)(&s, (uint64_t)(first + i), i < drawn);
    }
    return 0;
}
