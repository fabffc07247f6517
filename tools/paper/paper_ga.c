// The genetic paper's own form: a hall on standard input, one JSON object on standard output.
//
//     paper-ga GENERATIONS SEED STEP < hall
//
// STEP in metres, 0 the paper's; the hall as hall.h says. `trace`: generation, length (m) and crossing pieces of the best
// way whenever it is better; `points`: the last one, `seconds` of the processor for all.
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

static void print_run(void) {
    aisle_barrier_figures f = {0.0, 0};
    uint32_t spent = 0, updates = 0;
    const double since = now();
    aisle_status st = AISLE_BUSY;
    (void)printf("{\"trace\": [");
    while (st == AISLE_BUSY) {
        st = aisle_barrier_step(&barrier, 1U, &spent);
        if (barrier.ga.best_updates > updates && aisle_barrier_figures_of(&barrier, &f)) {
            (void)printf("%s[%u, %.9g, %u]", updates > 0U ? ", " : "", (unsigned)barrier.ga.generation, f.length,
                         (unsigned)f.crossing);
            updates = barrier.ga.best_updates;
        }
    }
    (void)printf("],\n \"units\": %u, \"evals\": %u, \"seconds\": %.6f, \"points\": [", (unsigned)spent,
                 (unsigned)barrier.ga.evals, now() - since);
    for (uint32_t i = 0; i < barrier.count; i++) {
        (void)printf("%s[%.9g, %.9g]", i > 0U ? ", " : "", barrier.way[i].x, barrier.way[i].y);
    }
    (void)printf("]}\n");
}

int main(int argc, char **argv) {
    if (argc != 4) {
        hall_fail("usage: paper-ga GENERATIONS SEED STEP < hall");
    }
    aisle_arena arena = hall_arena(BLOCK);
    aisle_space_carve(&space, &arena, CELLS);
    aisle_barrier_carve(&barrier, &arena);
    hall_read(&scene, &arena, CELLS);
    aisle_space_begin(&space, &scene.layout, &scene.vehicle, AISLE_SPACE_FREE_TURN);
    aisle_options_msg options = {.planner = AISLE_OPTIONS_GA, .objective = AISLE_OPTIONS_PAPER};
    options.num_samples = (int16_t)strtol(argv[1], NULL, 10);
    options.seed = (int32_t)strtol(argv[2], NULL, 10);
    options.step = strtof(argv[3], NULL);
    if (aisle_barrier_start_paper(&barrier, &space, &options, scene.start, scene.goal) != AISLE_OK) {
        hall_fail("the search cannot start");
    }
    print_run();
    return 0;
}
