// Convergence of the paper's swarm: a hall on standard input, one JSON object on standard output.
//
//     paper-swarm INTERPOLATION SAMPLES SEED BETA SKIP < hall
//
// INTERPOLATION as in options_t, SKIP 1 leaves the first leg unsampled as the paper did; the hall as hall.h says.
// Figures of the best particle after each iteration; those of an infeasible one have violation > 0.
#include "hall.h"
#include "plan/paper_swarm.h"

#include <stdio.h>
#include <stdlib.h>

enum { BLOCK = 96 << 20, CELLS = 1 << 20 };

static hall scene;
static aisle_space space;
static aisle_paper_swarm swarm;

static void print_trace(void) {
    aisle_paper_figures f = {0};
    uint32_t spent = 0;
    (void)printf("{\"trace\": [");
    for (uint32_t i = 0; i < AISLE_PAPER_ITERATIONS; i++) {
        while (swarm.pso.evals < (i + 1U) * AISLE_PAPER_PARTICLES &&
               aisle_paper_swarm_step(&swarm, 1U, &spent) == AISLE_BUSY) {
        }
        (void)aisle_paper_swarm_figures(&swarm, &f);
        (void)printf("%s[%.9g, %.9g, %.9g, %.9g]", i > 0U ? ", " : "", f.fitness, f.length, f.oa, f.violation);
    }
    aisle_vec2 points[AISLE_PAPER_VIAS + 2U];
    uint32_t n = aisle_paper_swarm_best(&swarm, points);
    (void)printf("],\n \"units\": %u, \"points\": [", (unsigned)spent);
    for (uint32_t i = 0; i < n; i++) {
        (void)printf("%s[%.9g, %.9g]", i > 0U ? ", " : "", points[i].x, points[i].y);
    }
    swarm.skip_first = false; // the same way, sampled from its very start
    (void)aisle_paper_swarm_figures(&swarm, &f);
    (void)printf("],\n \"whole\": [%.9g, %.9g, %.9g, %.9g]}\n", f.fitness, f.length, f.oa, f.violation);
}

int main(int argc, char **argv) {
    if (argc != 6) {
        hall_fail("usage: paper-swarm INTERPOLATION SAMPLES SEED BETA SKIP < hall");
    }
    aisle_arena arena = hall_arena(BLOCK);
    aisle_space_carve(&space, &arena, CELLS);
    aisle_paper_swarm_carve(&swarm, &arena);
    hall_read(&scene, &arena, CELLS);
    aisle_space_begin(&space, &scene.layout, &scene.vehicle, AISLE_SPACE_FREE_TURN);
    aisle_options_msg options = {.planner = AISLE_OPTIONS_PSO, .objective = AISLE_OPTIONS_PAPER};
    options.interpolation = (int8_t)strtol(argv[1], NULL, 10);
    options.num_samples = (int16_t)strtol(argv[2], NULL, 10);
    options.seed = (int32_t)strtol(argv[3], NULL, 10);
    options.risk_weight = strtof(argv[4], NULL);
    if (aisle_paper_swarm_start(&swarm, &space, &options, scene.start, scene.goal) != AISLE_OK) {
        hall_fail("the swarm cannot start");
    }
    swarm.skip_first = strtol(argv[5], NULL, 10) != 0;
    print_trace();
    return 0;
}
