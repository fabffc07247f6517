// The genetic paper's own form: a hall on standard input, one JSON object on standard output.
//
//     paper-ga SEED STEP GENERATIONS... < hall
//
// STEP in metres, 0 the paper's; GENERATIONS ascending; the hall as hall.h says. For each of them the best way by then: its
// length (m), the pieces of it that cross an obstacle, its points, and the processor's seconds so far.
#include "hall.h"
#include "plan/barrier.h"

#include <stdio.h>
#include <stdlib.h>
#include <time.h>

enum { BLOCK = 96 << 20, CELLS = 1 << 20 };

static hall scene;
static aisle_space space;
static aisle_barrier barrier;

static double now(void) {
    return (double)clock() / (double)CLOCKS_PER_SEC;
}

static void print_mark(long generations, double seconds, bool is_first) {
    aisle_barrier_figures f = {0.0, 0};
    (void)aisle_barrier_figures_of(&barrier, &f); // lays the way
    (void)printf("%s{\"generations\": %ld, \"length\": %.9g, \"crossing\": %u, \"evals\": %u, \"seconds\": %.6f,\n  "
                 "\"points\": [",
                 is_first ? "" : ",\n ", generations, f.length, (unsigned)f.crossing, (unsigned)barrier.ga.evals,
                 seconds);
    for (uint32_t i = 0; i < barrier.count; i++) {
        (void)printf("%s[%.9g, %.9g]", i > 0U ? ", " : "", barrier.way[i].x, barrier.way[i].y);
    }
    (void)printf("]}");
}

static void print_run(int marks, char **mark) {
    const double since = now();
    (void)printf("[");
    for (int i = 0; i < marks; i++) {
        const long generations = strtol(mark[i], NULL, 10);
        aisle_ga_config until = barrier.ga.cfg;
        until.generation_max = (uint32_t)generations;
        uint32_t spent = 0;
        while (barrier.ga.evals < aisle_ga_evals_max(&until)) {
            (void)aisle_barrier_step(&barrier, 1U, &spent); // one evaluation
        }
        print_mark(generations, now() - since, i == 0);
    }
    (void)printf("]\n");
}

int main(int argc, char **argv) {
    if (argc < 4) {
        hall_fail("usage: paper-ga SEED STEP GENERATIONS... < hall");
    }
    aisle_arena arena = hall_arena(BLOCK);
    aisle_space_carve(&space, &arena, CELLS);
    aisle_barrier_carve(&barrier, &arena);
    hall_read(&scene, &arena, CELLS);
    aisle_space_begin(&space, &scene.layout, &scene.vehicle, AISLE_SPACE_FREE_TURN);
    aisle_options_msg options = {.planner = AISLE_OPTIONS_GA, .objective = AISLE_OPTIONS_PAPER};
    options.seed = (int32_t)strtol(argv[1], NULL, 10);
    options.step = strtof(argv[2], NULL);
    options.num_samples = (int16_t)strtol(argv[argc - 1], NULL, 10);
    if (aisle_barrier_start_paper(&barrier, &space, &options, scene.start, scene.goal) != AISLE_OK) {
        hall_fail("the search cannot start");
    }
    print_run(argc - 3, argv + 3);
    return 0;
}
