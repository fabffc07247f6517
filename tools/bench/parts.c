// Times of the parts, as DESIGN.md tells them: build/release/bench-parts. Each figure is the best of five rounds.
#include "algo/astar.h"
#include "base/angle.h"
#include "base/crc32.h"
#include "base/rng.h"
#include "wire/codec.h"
#include "world/collide.h"
#include "world/layout.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { ROUNDS = 5, SIDE = 2048, BLOCK = 96 << 20 };

static aisle_layout layout;
static aisle_layout_msg part;
static uint8_t bytes[AISLE_MSG_DATAGRAM_MAX];
static aisle_astar search;

void aisle_assert_failed(const char *file, int line, const char *condition) {
    (void)fprintf(stderr, "%s:%d: %s\n", file, line, condition);
    abort();
}

static double seconds(void) {
    struct timespec t;
    (void)clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

// Best time of one call out of ROUNDS rounds of `calls`.
static double best_of(void (*call)(uint32_t i), uint32_t calls) {
    double best = 1e9;
    for (int round = 0; round < ROUNDS; round++) {
        double from = seconds();
        for (uint32_t i = 0; i < calls; i++) {
            call(i);
        }
        double took = (seconds() - from) / (double)calls;
        best = took < best ? took : best;
    }
    return best;
}

// A hall of 102.4 m with shelves of 6 x 1 m every 8 x 4 m, on 5 cm cells: SIDE x SIDE of them.
static void make_shelves(void) {
    part = (aisle_layout_msg){.map_id = 1, .num_parts = 1, .x_max = 102.4, .y_max = 102.4};
    for (int16_t i = 0; i < 300; i++) {
        double x = 2.0 + 8.0 * (i % 12);
        double y = 2.0 + 4.0 * (i / 12);
        const double v[4][2] = {{x, y}, {x + 6.0, y}, {x + 6.0, y + 1.0}, {x, y + 1.0}};
        aisle_polygon_msg *polygon = &part.polygons[part.num_polygons++];
        polygon->id = i + 1;
        polygon->num_vertices = 4;
        memcpy(polygon->vertices, v, sizeof v);
        size_t size = 0;
        (void)aisle_msg_encode_body(AISLE_MSG_POLYGON, polygon, bytes, sizeof bytes, &size);
        part.crc32 = (int32_t)aisle_crc32((uint32_t)part.crc32, bytes, size);
    }
    part.total_polygons = part.num_polygons;
}

static void build_layout(uint32_t i) {
    (void)i;
    aisle_refusal why;
    part.map_revision++;
    if (aisle_layout_take_part(&layout, &part, &why) != AISLE_OK) {
        abort();
    }
    aisle_layout_commit(&layout);
    while (aisle_layout_build(&layout, 1U << 20) == AISLE_BUSY) {
    }
}

static void one_gap(uint32_t i) {
    double x = 1.0 + 0.01 * (double)(i % 9000U);
    const aisle_vec2 v[4] = {{x, 3.3}, {x + 1.0, 3.3}, {x + 1.0, 4.0}, {x, 4.0}};
    (void)aisle_layout_gap(&layout, &(aisle_convex){v, 4, 0.0}, 0.5, NULL);
}

static void one_contact(uint32_t i) {
    double x = 1.0 + 0.0001 * (double)(i % 9000U);
    const aisle_vec2 a[4] = {{0.0, 0.0}, {1.0, 0.0}, {1.0, 0.7}, {0.0, 0.7}};
    const aisle_vec2 b[4] = {{x, 0.3}, {x + 2.0, 0.1}, {x + 2.1, 1.0}, {x, 1.2}};
    aisle_collide_count count = {0};
    (void)aisle_collide(&(aisle_collide_body){a, NULL, 4, 0.1}, &(aisle_collide_body){b, NULL, 4, 0.0}, &count);
}

static uint32_t enter(void *ctx, uint32_t from, uint32_t to, uint8_t dir) {
    (void)ctx, (void)from, (void)dir;
    return to % SIDE == SIDE / 2U && to / SIDE > 64U ? AISLE_ASTAR_BARRED_CELL : AISLE_ASTAR_FACTOR_ONE;
}

static void one_search(uint32_t i) {
    (void)i;
    aisle_astar_config cfg = {
        .enter = enter, .w = SIDE, .h = SIDE, .start = SIDE * 1000U + 10U, .goal = SIDE * 1000U + 2000U};
    (void)aisle_astar_start(&search, &cfg);
    while (aisle_astar_step(&search, 1U << 20) == AISLE_BUSY) {
    }
}

static size_t encoded;
static void one_decode(uint32_t i) {
    (void)i;
    if (aisle_msg_decode(AISLE_MSG_LAYOUT, bytes, encoded, &part, NULL) != AISLE_OK) {
        abort();
    }
}

static double turned; // so that no compiler leaves the work out
static void one_sincos(uint32_t i) {
    double s, c;
    aisle_sincos(0.001 * (double)i, &s, &c);
    turned += s + c;
}

int main(void) {
    void *block;
    if (posix_memalign(&block, AISLE_ARENA_ALIGN, BLOCK) != 0) {
        return 1;
    }
    aisle_arena arena = aisle_arena_over(block, BLOCK);
    const aisle_limits limits = {
        .cells = SIDE * SIDE, .polygons = 4096, .vertices = 32768, .open_nodes = 131072, .requests = 1};
    aisle_layout_carve(&layout, &arena, &limits);
    aisle_astar_carve(&search, &arena, limits.cells, limits.open_nodes);
    make_shelves();
    double load = best_of(build_layout, 3);
    (void)printf("layout load, 300 shelves, %d x %d cells  %7.2f ms, %.1f ns a cell\n", SIDE, SIDE, 1e3 * load,
                 1e9 * load / ((double)SIDE * (double)SIDE));
    (void)printf("exact gap of a footprint, cap 0.5 m        %7.2f us\n", 1e6 * best_of(one_gap, 100000));
    (void)printf("narrow-phase test                          %7.2f us\n", 1e6 * best_of(one_contact, 100000));
    double found = best_of(one_search, 1);
    (void)printf("grid search, %8u nodes                %7.1f ns a node\n", (unsigned)search.expanded,
                 1e9 * found / (double)search.expanded);
    if (aisle_msg_encode(AISLE_MSG_LAYOUT, &part, bytes, sizeof bytes, &encoded) != AISLE_OK) {
        return 1;
    }
    (void)printf("decoding a layout_t of %6zu bytes         %7.1f us\n", encoded, 1e6 * best_of(one_decode, 1000));
    (void)printf("sine and cosine                            %7.1f ns\n", 1e9 * best_of(one_sincos, 1000000));
    free(block);
    return turned > 1e12 ? 1 : 0;
}
