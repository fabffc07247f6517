// Times of the parts, as DESIGN.md tells them: build/release/bench-parts [LOG...]. Each figure is the best of seven
// rounds. Of a log, the layout in it is loaded (tools/bench/load_table.py makes such logs).
//
// Peer of the load: the bare distance transform of the very same grid, two passes after Meijster, Roerdink & Hesselink
// 2000, in 32 bits, in one go; its values must be the field's.
#include "algo/astar.h"
#include "base/angle.h"
#include "base/crc32.h"
#include "base/rng.h"
#include "daemon/channel.h"
#include "daemon/log.h"
#include "plan/pace.h"
#include "plan/pace_predict.h"
#include "plan/verify_moving.h"
#include "wire/codec.h"
#include "world/collide.h"
#include "world/layout.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { ROUNDS = 7, SIDE = 2048, CELLS = 1 << 24, BLOCK = 384 << 20 };

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

// ---- the peer

static uint8_t *occupied; // [cells]
static int32_t *bare;     // [cells] squared distances
static int32_t *at,
    *from_col; // [w + 2] columns of the parabolas that make the envelope of a row, and where each begins

static void pass_columns(int32_t w, int32_t h) {
    for (int32_t y = 0; y < h; y++) {
        int32_t *row = bare + (ptrdiff_t)y * w;
        const uint8_t *cells = occupied + (ptrdiff_t)y * w;
        for (int32_t x = 0; x < w; x++) {
            int32_t above = y > 0 ? row[x - w] : 0; // the outside is occupied
            row[x] = cells[x] != 0 ? 0 : above + 1;
        }
    }
    for (int32_t y = h - 1; y >= 0; y--) {
        int32_t *row = bare + (ptrdiff_t)y * w;
        for (int32_t x = 0; x < w; x++) {
            int32_t below = (y + 1 < h ? row[x + w] : 0) + 1;
            row[x] = below < row[x] ? below : row[x];
        }
    }
}

static int32_t column_sq(const int32_t *row, int32_t w, int32_t x) {
    return x < 0 || x >= w ? 0 : row[x] * row[x];
}

static int32_t floor_div(int32_t n, int32_t d) {
    return n >= 0 ? n / d : -((-n + d - 1) / d);
}

// Lower envelope of the parabolas of one row's columns, the two outside ones counted: the left one has no
// rival that could drop it. copy: the row before. 32 bits do for sides up to 30000.
static void pass_row(int32_t *row, const int32_t *copy, int32_t w) {
    int32_t n = 0;
    at[0] = -1;
    from_col[0] = -1;
    for (int32_t u = 0; u <= w; u++) {
        int32_t sq = column_sq(copy, w, u), begin = 0;
        for (; n >= 0; n--) {
            int32_t s = at[n], d = u - s;
            begin = floor_div(u * u - s * s + sq - column_sq(copy, w, s), 2 * d) + 1;
            if (begin > from_col[n]) {
                break;
            }
        }
        if (begin < w) {
            n++;
            at[n] = u;
            from_col[n] = begin;
        }
    }
    for (int32_t x = w - 1; x >= 0; x--) {
        while (from_col[n] > x) {
            n--;
        }
        row[x] = (x - at[n]) * (x - at[n]) + column_sq(copy, w, at[n]);
    }
}

static void bare_transform(uint32_t i) {
    (void)i;
    static int32_t copy[AISLE_GRID_SIDE_MAX];
    const int32_t w = (int32_t)layout.grid.lattice.w, h = (int32_t)layout.grid.lattice.h;
    pass_columns(w, h);
    for (int32_t y = 0; y < h; y++) {
        int32_t *row = bare + (ptrdiff_t)y * w;
        memcpy(copy, row, (size_t)w * sizeof *copy);
        pass_row(row, copy, w);
    }
}

// ---- loads

static void commit_and_build(uint32_t i) {
    (void)i;
    aisle_layout_commit(&layout);
    while (aisle_layout_build(&layout, 1U << 20) == AISLE_BUSY) {
    }
}

// Times a load beside the peer on its grid. `send` stages the layout once more, as a new revision.
static void print_load(const char *name, void (*send)(void)) {
    double taken = 1e9, built = 1e9;
    for (int round = 0; round < ROUNDS; round++) {
        double from = seconds();
        send();
        double sent = seconds();
        commit_and_build(0);
        double end = seconds();
        taken = sent - from < taken ? sent - from : taken;
        built = end - sent < built ? end - sent : built;
    }
    const uint32_t cells = layout.grid.lattice.w * layout.grid.lattice.h;
    for (uint32_t c = 0; c < cells; c++) {
        occupied[c] = layout.grid.field[c] == 0;
    }
    double peer = best_of(bare_transform, 1);
    for (uint32_t c = 0; c < cells; c++) {
        if ((uint32_t)layout.grid.field[c] !=
            ((uint32_t)bare[c] < AISLE_FIELD_SQ_MAX ? (uint32_t)bare[c] : AISLE_FIELD_SQ_MAX)) {
            (void)fprintf(stderr, "%s: cell %u: field %u, bare transform %d\n", name, (unsigned)c,
                          (unsigned)layout.grid.field[c], (int)bare[c]);
            abort();
        }
    }
    (void)printf(
        "load %-28s %5u x %-5u  %7.2f ms, %4.1f ns a cell; bare transform %7.2f ms, ratio %.2f; parts %6.2f ms\n", name,
        (unsigned)layout.grid.lattice.w, (unsigned)layout.grid.lattice.h, 1e3 * built, 1e9 * built / (double)cells,
        1e3 * peer, built / peer, 1e3 * taken);
}

static void send_shelves(void) {
    aisle_refusal why;
    part.map_revision++;
    if (aisle_layout_take_part(&layout, &part, &why) != AISLE_OK) {
        abort();
    }
}

static FILE *log_file;
static int32_t log_revision;

// Every part and tile in the log; all of them together complete the layout.
static void send_log(void) {
    static aisle_log_reader reader;
    static aisle_layout_msg a_part;
    static aisle_grid_chunk_msg a_tile;
    aisle_log_event event;
    aisle_refusal why;
    aisle_status st = AISLE_PARTIAL;
    log_revision++;
    if (!aisle_log_open(&reader, log_file)) {
        abort();
    }
    while (aisle_log_next(&reader, &event)) {
        aisle_channel channel = aisle_channel_find("AISLE", event.channel, event.channel_length);
        if (channel == AISLE_CHANNEL_LAYOUT &&
            aisle_msg_decode(AISLE_MSG_LAYOUT, event.bytes, event.size, &a_part, NULL) == AISLE_OK) {
            a_part.map_id = 2;
            a_part.map_revision = log_revision;
            st = aisle_layout_take_part(&layout, &a_part, &why);
        } else if (channel == AISLE_CHANNEL_GRID &&
                   aisle_msg_decode(AISLE_MSG_GRID_CHUNK, event.bytes, event.size, &a_tile, NULL) == AISLE_OK) {
            a_tile.map_id = 2;
            a_tile.map_revision = log_revision;
            st = aisle_layout_take_tile(&layout, &a_tile, &why);
        }
    }
    if (st != AISLE_OK || !aisle_layout_is_staged(&layout)) {
        (void)fprintf(stderr, "no whole layout in the log: %d\n", (int)st);
        exit(1);
    }
}

static void print_loads(int count, char **logs) {
    print_load("300 shelves", send_shelves);
    for (int i = 0; i < count; i++) {
        log_file = fopen(logs[i], "rb");
        if (log_file == NULL) {
            (void)fprintf(stderr, "%s: cannot be read\n", logs[i]);
            exit(1);
        }
        const char *slash = strrchr(logs[i], '/');
        print_load(slash != NULL ? slash + 1 : logs[i], send_log);
        (void)fclose(log_file);
    }
}

// ---- the rest

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

// ---- speeds among movers

enum { WAY = 60, HALLS = 16 };
static aisle_vehicle vehicle;
static aisle_waypoint_msg way[WAY + 1]; // a metre a piece, bent to and fro
static aisle_mover walkers[HALLS][AISLE_OBSTACLES_MAX_OBSTACLES];
static aisle_movers seen;
static aisle_pace pace;
static aisle_pace_predict predict;
static aisle_path_msg paced;
static uint32_t slowed;

static void make_way(void) {
    static const aisle_vehicle_msg usual;
    aisle_refusal why;
    aisle_profile_sum sum;
    if (aisle_vehicle_from_msg(&usual, &vehicle, &why) != AISLE_OK) {
        abort();
    }
    for (int i = 1; i <= WAY; i++) {
        const double bend = i % 20 < 10 ? 0.1 : -0.1, dir = way[i - 1].theta + 0.5 * bend;
        double sine, cosine;
        aisle_sincos(dir, &sine, &cosine);
        way[i] = (aisle_waypoint_msg){.x = way[i - 1].x + cosine,
                                      .y = way[i - 1].y + sine,
                                      .theta = way[i - 1].theta + bend,
                                      .curvature = (float)bend,
                                      .clearance = 2.0F};
    }
    if (aisle_profile_fill(&vehicle, NULL, way, WAY + 1, NULL, &sum) != AISLE_OK) {
        abort();
    }
}

// Persons anywhere within 40 m of the vehicle, one for every 20 m2 if there are 256.
static void make_walkers(void) {
    aisle_rng rng = aisle_rng_seed(1);
    for (int hall = 0; hall < HALLS; hall++) {
        for (int i = 0; i < AISLE_OBSTACLES_MAX_OBSTACLES; i++) {
            walkers[hall][i] = (aisle_mover){.id = i,
                                             .at = {way[10].x + 80.0 * (double)aisle_rng_float(&rng) - 40.0,
                                                    way[10].y + 80.0 * (double)aisle_rng_float(&rng) - 40.0},
                                             .velocity = {(double)aisle_rng_float(&rng) - 0.5, 0.3},
                                             .radius = 0.3,
                                             .sigma = 0.05,
                                             .v_bound = 1.6};
        }
    }
}

static void one_pace(uint32_t i) {
    const aisle_pace_request request = {.vehicle = &vehicle,
                                        .movers = &seen,
                                        .w = way,
                                        .n = WAY + 1,
                                        .at = {10, 0.5},
                                        .v = (double)way[10].v,
                                        .lease = 1.0};
    uint32_t spent = 0;
    seen.mover = walkers[i % HALLS];
    aisle_pace_start(&pace, &request, &paced);
    (void)aisle_pace_step(&pace, UINT32_MAX, &spent);
    slowed += pace.level > 0 ? 1U : 0U;
}

static void one_prediction(uint32_t i) {
    const aisle_pace_predict_request request = {.vehicle = &vehicle,
                                                .movers = &seen,
                                                .w = way,
                                                .n = WAY + 1,
                                                .at = {10, 0.5},
                                                .v = (double)way[10].v,
                                                .until = WAY,
                                                .lease = 0.25};
    uint32_t spent = 0;
    seen.mover = walkers[i % HALLS];
    aisle_pace_predict_start(&predict, &request);
    (void)aisle_pace_predict_step(&predict, UINT32_MAX, &spent);
}

static aisle_path_msg driven;
static size_t driven_size;
static aisle_verify_moving proof;
static uint32_t proof_units, refused;

static void make_driven(void) {
    memcpy(driven.waypoints, way, sizeof way);
    driven.num_waypoints = WAY + 1;
    if (aisle_path_encode(&driven, bytes, sizeof bytes, &driven_size) != AISLE_OK) {
        abort();
    }
}

static void one_moving_proof(uint32_t i) {
    seen.mover = walkers[i % HALLS];
    const aisle_moving_request request = {.vehicle = &vehicle,
                                          .movers = &seen,
                                          .bytes = bytes,
                                          .size = driven_size,
                                          .path = &driven,
                                          .at_piece = 10,
                                          .at_u = 0.5,
                                          .v = (double)way[10].v,
                                          .lease = 1.0};
    aisle_moving_stamp stamp;
    aisle_verify_moving_start(&proof, &request);
    refused += aisle_verify_moving_step(&proof, UINT32_MAX, &proof_units, &stamp) == AISLE_OK ? 0U : 1U;
}

static void print_moving_proofs(void) {
    make_driven();
    for (uint32_t count = 1; count <= AISLE_OBSTACLES_MAX_OBSTACLES; count *= 4U) {
        seen.count = count;
        refused = proof_units = 0;
        const double one = best_of(one_moving_proof, 160);
        (void)printf("proof of a lease of 1 s among %3u movers    %7.1f us (%u units, refused in %2u of %d halls)\n",
                     (unsigned)count, 1e6 * one, (unsigned)(proof_units / (ROUNDS * 160U)),
                     (unsigned)(refused / (ROUNDS * 10U)), HALLS);
    }
}

static void print_paces(void) {
    make_way();
    make_walkers();
    for (uint32_t count = 1; count <= AISLE_OBSTACLES_MAX_OBSTACLES; count *= 4U) {
        seen.count = count;
        slowed = 0;
        const double one = best_of(one_pace, 160);
        (void)printf("speeds among %3u movers within 40 m         %7.1f us (slowed in %2u of %d halls)\n",
                     (unsigned)count, 1e6 * one, (unsigned)(slowed / (ROUNDS * 10U)), HALLS);
        (void)printf("how long 50 m will take among them         %7.2f ms\n", 1e3 * best_of(one_prediction, HALLS));
    }
}

int main(int argc, char **argv) {
    void *block;
    if (posix_memalign(&block, AISLE_ARENA_ALIGN, BLOCK) != 0) {
        return 1;
    }
    occupied = malloc((size_t)CELLS * sizeof *occupied);
    bare = malloc((size_t)CELLS * sizeof *bare);
    at = malloc((AISLE_GRID_SIDE_MAX + 2U) * sizeof *at);
    from_col = malloc((AISLE_GRID_SIDE_MAX + 2U) * sizeof *from_col);
    if (occupied == NULL || bare == NULL || at == NULL || from_col == NULL) {
        return 1;
    }
    aisle_arena arena = aisle_arena_over(block, BLOCK);
    const aisle_limits limits = {
        .cells = CELLS, .polygons = 4096, .vertices = 32768, .open_nodes = 131072, .requests = 1};
    aisle_layout_carve(&layout, &arena, &limits);
    aisle_astar_carve(&search, &arena, SIDE * SIDE, limits.open_nodes);
    aisle_pace_carve(&pace, &arena);
    aisle_pace_predict_carve(&predict, &arena);
    make_shelves();
    print_loads(argc - 1, argv + 1);
    send_shelves();
    commit_and_build(0);
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
    print_paces();
    print_moving_proofs();
    free(block);
    free(occupied);
    free(bare);
    free(at);
    free(from_col);
    return turned > 1e12 ? 1 : 0;
}
