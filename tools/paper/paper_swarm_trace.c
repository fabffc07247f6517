// Convergence of the paper's swarm: a hall on standard input, one JSON object on standard output.
//
//     paper-swarm INTERPOLATION SAMPLES SEED BETA SKIP < hall
//
// INTERPOLATION as in options_t, SKIP 1 leaves the first leg unsampled as the paper did. The hall, numbers in m:
//     x_min y_min x_max y_max  radius margin  start_x start_y  goal_x goal_y  polygons  { vertices  x y ... } ...
// Figures of the best particle after each iteration; those of an infeasible one have violation > 0.
#include "base/crc32.h"
#include "plan/paper_swarm.h"
#include "wire/codec.h"

#include <stdio.h>
#include <stdlib.h>

enum { BLOCK = 64 << 20 };

static aisle_layout layout;
static aisle_layout_msg part;
static aisle_vehicle vehicle;
static aisle_space space;
static aisle_paper_swarm swarm;
static aisle_vec2 start, goal;

void aisle_assert_failed(const char *file, int line, const char *condition) {
    (void)fprintf(stderr, "%s:%d: %s\n", file, line, condition);
    abort();
}

static void fail(const char *what) {
    (void)fprintf(stderr, "paper-swarm: %s\n", what);
    exit(2);
}

static double number(void) {
    char word[64];
    char *end = word;
    if (scanf("%63s", word) != 1) {
        fail("the hall ends too early");
    }
    double value = strtod(word, &end);
    if (end == word || *end != '\0') {
        fail("not a number");
    }
    return value;
}

static uint32_t count(double most) {
    double value = number();
    if (!(value >= 0.0 && value <= most)) {
        fail("a count is out of range");
    }
    return (uint32_t)value;
}

static void read_polygons(void) {
    part.num_polygons = (int16_t)count(256.0);
    for (int16_t i = 0; i < part.num_polygons; i++) {
        aisle_polygon_msg *polygon = &part.polygons[i];
        polygon->id = i + 1;
        polygon->num_vertices = (int16_t)count(16.0);
        for (int16_t k = 0; k < polygon->num_vertices; k++) {
            polygon->vertices[k][0] = number();
            polygon->vertices[k][1] = number();
        }
        uint8_t bytes[1024];
        size_t size = 0;
        if (aisle_msg_encode_body(AISLE_MSG_POLYGON, polygon, bytes, sizeof bytes, &size) != AISLE_OK) {
            fail("a polygon cannot be encoded");
        }
        part.crc32 = (int32_t)aisle_crc32((uint32_t)part.crc32, bytes, size);
    }
    part.total_polygons = part.num_polygons;
}

static void read_hall(void) {
    part = (aisle_layout_msg){.map_id = 1, .map_revision = 1, .num_parts = 1};
    part.x_min = number();
    part.y_min = number();
    part.x_max = number();
    part.y_max = number();
    aisle_vehicle_msg msg = {.vehicle_revision = 1};
    msg.footprint_radius = (float)number();
    msg.margin = (float)number();
    start.x = number();
    start.y = number();
    goal.x = number();
    goal.y = number();
    read_polygons();
    aisle_refusal why;
    if (aisle_vehicle_from_msg(&msg, &vehicle, &why) != AISLE_OK) {
        fail("the vehicle is refused");
    }
    if (aisle_layout_take_part(&layout, &part, &why) != AISLE_OK) {
        fail("the layout is refused");
    }
    aisle_layout_commit(&layout);
    while (aisle_layout_build(&layout, 1U << 20) == AISLE_BUSY) {
    }
}

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
    void *block;
    if (argc != 6 || posix_memalign(&block, AISLE_ARENA_ALIGN, BLOCK) != 0) {
        fail("usage: paper-swarm INTERPOLATION SAMPLES SEED BETA SKIP < hall");
    }
    aisle_arena arena = aisle_arena_over(block, BLOCK);
    const aisle_limits limits = {
        .cells = 1U << 20, .polygons = 256, .vertices = 4096, .open_nodes = 1024, .requests = 1};
    aisle_layout_carve(&layout, &arena, &limits);
    aisle_space_carve(&space, &arena, limits.cells);
    aisle_paper_swarm_carve(&swarm, &arena);
    read_hall();
    aisle_space_begin(&space, &layout, &vehicle, AISLE_SPACE_FREE_TURN);
    aisle_options_msg options = {.planner = AISLE_OPTIONS_PSO, .objective = AISLE_OPTIONS_PAPER};
    options.interpolation = (int8_t)strtol(argv[1], NULL, 10);
    options.num_samples = (int16_t)strtol(argv[2], NULL, 10);
    options.seed = (int32_t)strtol(argv[3], NULL, 10);
    options.risk_weight = strtof(argv[4], NULL);
    if (aisle_paper_swarm_start(&swarm, &space, &options, start, goal) != AISLE_OK) {
        fail("the swarm cannot start");
    }
    swarm.skip_first = strtol(argv[5], NULL, 10) != 0;
    print_trace();
    free(block);
    return 0;
}
