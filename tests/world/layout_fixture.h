// layout_fixture.h - scenes as messages for the tests of layout: polygons, a scan, and how to cut and send them.
// The checksum is computed here from LCM's documented encoding, byte by byte, not by the code under test.
#ifndef AISLE_TESTS_WORLD_LAYOUT_FIXTURE_H
#define AISLE_TESTS_WORLD_LAYOUT_FIXTURE_H

#include "gen.h"
#include "unity.h"
#include "world/layout.h"

#include <string.h>

enum { FIX_POLYGONS = 200, FIX_VERTICES = 1600, FIX_CELLS = 40000 };

typedef struct fix_scene {
    int32_t map_id, map_revision;
    uint32_t count; // polygons
    aisle_polygon_msg polygons[FIX_POLYGONS + 8];
    double x_min, y_min, x_max, y_max;
    float resolution;
    int16_t parts;
    int16_t tiles; // 0: no scan
    uint32_t w, h; // of the scan
    double origin_x, origin_y;
    float scan_resolution;
    bool occupied[FIX_CELLS];
} fix_scene;

static unsigned char fix_memory[4U << 20U];
static aisle_layout fix_layout;
static aisle_refusal fix_why;
static aisle_layout_msg fix_part;
static aisle_grid_chunk_msg fix_tile;

static inline void fix_start_with(aisle_limits limits) {
    unsigned char *aligned = fix_memory + (64U - (uintptr_t)fix_memory % 64U) % 64U;
    aisle_arena arena = aisle_arena_over(aligned, sizeof fix_memory - 64U);
    aisle_layout_carve(&fix_layout, &arena, &limits);
    TEST_ASSERT_FALSE(arena.overflow);
}

static inline void fix_start(void) {
    fix_start_with((aisle_limits){.cells = FIX_CELLS, .polygons = FIX_POLYGONS, .vertices = FIX_VERTICES});
}

// ---- checksum

static inline uint32_t fix_crc_byte(uint32_t crc, uint32_t byte) {
    crc ^= byte;
    for (uint32_t k = 0; k < 8U; k++) {
        crc = (crc & 1U) != 0 ? (crc >> 1U) ^ UINT32_C(0xEDB88320) : crc >> 1U;
    }
    return crc;
}

static inline uint32_t fix_crc_value(uint32_t crc, uint64_t value, uint32_t bytes) { // big-endian
    while (bytes-- > 0U) {
        crc = fix_crc_byte(crc, (uint32_t)(value >> (8U * bytes)) & 0xFFU);
    }
    return crc;
}

static inline uint32_t fix_crc_float(uint32_t crc, float value) {
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    return fix_crc_value(crc, bits, 4);
}

static inline int32_t fix_crc(const aisle_polygon_msg *polygons, uint32_t count) {
    uint32_t crc = UINT32_MAX;
    for (uint32_t i = 0; i < count; i++) {
        const aisle_polygon_msg *p = &polygons[i];
        crc = fix_crc_value(crc, (uint64_t)(int64_t)p->id, 4);
        crc = fix_crc_value(crc, (uint64_t)(int64_t)p->kind, 1);
        crc = fix_crc_float(crc, p->value);
        crc = fix_crc_float(crc, p->direction);
        crc = fix_crc_value(crc, (uint64_t)(int64_t)p->num_vertices, 2);
        for (int32_t k = 0; k < 2 * p->num_vertices; k++) {
            uint64_t bits;
            memcpy(&bits, &p->vertices[k / 2][k % 2], sizeof bits);
            crc = fix_crc_value(crc, bits, 8);
        }
    }
    return (int32_t)~crc;
}

// ---- scenes

static inline void fix_set_polygon(aisle_polygon_msg *p, int32_t id, int8_t kind, const aisle_vec2 *v, uint32_t n) {
    memset(p, 0, sizeof *p);
    p->id = id;
    p->kind = kind;
    p->value = kind == AISLE_POLYGON_SPEED_LIMIT || kind == AISLE_POLYGON_PENALTY ? 0.5F : 0.0F;
    p->num_vertices = (int16_t)n;
    for (uint32_t i = 0; i < n; i++) {
        p->vertices[i][0] = v[i].x;
        p->vertices[i][1] = v[i].y;
    }
}

static inline void fix_add_box(fix_scene *scene, int32_t id, double x0, double y0, double x1, double y1) {
    aisle_vec2 v[4];
    gen_box(aisle_vec2_of(x0, y0), aisle_vec2_of(x1, y1), v);
    fix_set_polygon(&scene->polygons[scene->count], id, AISLE_POLYGON_OBSTACLE, v, 4);
    scene->count++;
}

static inline aisle_convex fix_shape(const aisle_polygon_msg *p, aisle_vec2 out[16]) {
    for (int32_t i = 0; i < p->num_vertices; i++) {
        out[i] = aisle_vec2_of(p->vertices[i][0], p->vertices[i][1]);
    }
    return (aisle_convex){out, (uint32_t)p->num_vertices, 0.0};
}

static inline void fix_set_bounds(fix_scene *scene, double x_min, double y_min, double x_max, double y_max) {
    scene->x_min = x_min;
    scene->y_min = y_min;
    scene->x_max = x_max;
    scene->y_max = y_max;
}

// Random polygons of all kinds, some reaching over the bounds (0, 0) to (10, 8), in `parts` parts.
static inline void fix_random_scene(fix_scene *scene, aisle_rng *rng, uint32_t count, int16_t parts) {
    memset(scene, 0, sizeof *scene);
    scene->map_id = 7;
    scene->map_revision = 1;
    scene->parts = parts;
    scene->count = count;
    fix_set_bounds(scene, 0.0, 0.0, 10.0, 8.0);
    for (uint32_t i = 0; i < count; i++) {
        aisle_vec2 v[8];
        const uint32_t n = 3U + aisle_rng_below(rng, 6);
        const aisle_vec2 centre = {gen_in(rng, -0.5, 10.5), gen_in(rng, -0.5, 8.5)};
        gen_polygon(rng, centre, gen_in(rng, 0.02, 0.9), gen_in(rng, 0.02, 0.5), n, v);
        const int32_t id = (int32_t)(1000U + (i * 7919U) % 1000003U);
        fix_set_polygon(&scene->polygons[i], id, (int8_t)aisle_rng_below(rng, 5), v, n);
    }
}

// A scan of w x h cells of 0.1 m with its corner at (1, 2), one cell in `one_in` occupied, in tiles * tiles tiles.
static inline void fix_random_scan(fix_scene *scene, aisle_rng *rng, uint32_t w, uint32_t h, uint32_t one_in,
                                   int16_t tiles) {
    scene->w = w;
    scene->h = h;
    scene->tiles = (int16_t)(tiles * tiles);
    scene->origin_x = 1.0;
    scene->origin_y = 2.0;
    scene->scan_resolution = 0.1F;
    fix_set_bounds(scene, 1.0, 2.0, 1.0 + 0.1 * w, 2.0 + 0.1 * h);
    for (uint32_t i = 0; i < w * h; i++) {
        scene->occupied[i] = aisle_rng_below(rng, one_in) == 0U;
    }
}

// ---- messages

static inline uint32_t fix_cut(uint32_t total, uint32_t parts, uint32_t part) {
    return total * part / parts;
}

static inline const aisle_layout_msg *fix_make_part(const fix_scene *scene, int16_t part) {
    const uint32_t first = fix_cut(scene->count, (uint32_t)scene->parts, (uint32_t)part);
    const uint32_t end = fix_cut(scene->count, (uint32_t)scene->parts, (uint32_t)part + 1U);
    memset(&fix_part, 0, sizeof fix_part);
    fix_part.map_id = scene->map_id;
    fix_part.map_revision = scene->map_revision;
    fix_part.part = part;
    fix_part.num_parts = scene->parts;
    fix_part.num_grid_chunks = scene->tiles;
    fix_part.total_polygons = (int32_t)scene->count;
    fix_part.crc32 = fix_crc(scene->polygons, scene->count);
    fix_part.x_min = scene->x_min;
    fix_part.y_min = scene->y_min;
    fix_part.x_max = scene->x_max;
    fix_part.y_max = scene->y_max;
    fix_part.resolution = scene->resolution;
    fix_part.num_polygons = (int16_t)(end - first);
    memcpy(fix_part.polygons, &scene->polygons[first], (end - first) * sizeof scene->polygons[0]);
    return &fix_part;
}

static inline void fix_put_leb(uint32_t value) {
    do {
        fix_tile.data[fix_tile.num_bytes] = (uint8_t)((value & 0x7FU) | (value > 0x7FU ? 0x80U : 0U));
        fix_tile.num_bytes++;
        value >>= 7U;
    } while (value != 0U);
}

static inline bool fix_cell(const fix_scene *scene, uint32_t i) { // i-th cell of fix_tile read as one row
    const uint32_t width = (uint32_t)fix_tile.width;
    return scene->occupied[((uint32_t)fix_tile.y0 + i / width) * scene->w + (uint32_t)fix_tile.x0 + i % width];
}

static inline void fix_encode_tile(const fix_scene *scene) {
    const uint32_t width = (uint32_t)fix_tile.width;
    const uint32_t cells = width * (uint32_t)fix_tile.height;
    if (fix_tile.encoding == AISLE_GRID_CHUNK_BITS) {
        const uint32_t stride = (width + 7U) / 8U;
        for (uint32_t i = 0; i < cells; i++) {
            const uint32_t bit = fix_cell(scene, i) ? 1U << (i % width % 8U) : 0U;
            fix_tile.data[i / width * stride + i % width / 8U] |= (uint8_t)bit;
        }
        fix_tile.num_bytes = (int32_t)(stride * (uint32_t)fix_tile.height);
        return;
    }
    bool is_occupied = false;
    uint32_t run = 0;
    for (uint32_t i = 0; i < cells; i++) {
        if (fix_cell(scene, i) != is_occupied) {
            fix_put_leb(run);
            run = 0;
            is_occupied = !is_occupied;
        }
        run++;
    }
    fix_put_leb(run);
}

// Tile `part` of a square number of tiles; odd ones run-length encoded.
static inline const aisle_grid_chunk_msg *fix_make_tile(const fix_scene *scene, int16_t part) {
    uint32_t side = 1;
    while (side * side < (uint32_t)scene->tiles) {
        side++;
    }
    const uint32_t tx = (uint32_t)part % side;
    const uint32_t ty = (uint32_t)part / side;
    memset(&fix_tile, 0, sizeof fix_tile);
    fix_tile.map_id = scene->map_id;
    fix_tile.map_revision = scene->map_revision;
    fix_tile.part = part;
    fix_tile.num_parts = scene->tiles;
    fix_tile.origin_x = scene->origin_x;
    fix_tile.origin_y = scene->origin_y;
    fix_tile.resolution = scene->scan_resolution;
    fix_tile.x0 = (int32_t)fix_cut(scene->w, side, tx);
    fix_tile.y0 = (int32_t)fix_cut(scene->h, side, ty);
    fix_tile.width = (int32_t)fix_cut(scene->w, side, tx + 1U) - fix_tile.x0;
    fix_tile.height = (int32_t)fix_cut(scene->h, side, ty + 1U) - fix_tile.y0;
    fix_tile.encoding = part % 2 == 0 ? AISLE_GRID_CHUNK_BITS : AISLE_GRID_CHUNK_RLE;
    fix_encode_tile(scene);
    return &fix_tile;
}

static inline aisle_status fix_send_part(const fix_scene *scene, int16_t part) {
    return aisle_layout_take_part(&fix_layout, fix_make_part(scene, part), &fix_why);
}
static inline aisle_status fix_send_tile(const fix_scene *scene, int16_t part) {
    return aisle_layout_take_tile(&fix_layout, fix_make_tile(scene, part), &fix_why);
}

// All parts, then all tiles, in order; staged after that.
static inline void fix_send(const fix_scene *scene) {
    for (int16_t i = 0; i < scene->parts; i++) {
        const aisle_status status = fix_send_part(scene, i);
        TEST_ASSERT_EQUAL(i + 1 == scene->parts && scene->tiles == 0 ? AISLE_OK : AISLE_PARTIAL, status);
    }
    for (int16_t i = 0; i < scene->tiles; i++) {
        TEST_ASSERT_EQUAL(i + 1 == scene->tiles ? AISLE_OK : AISLE_PARTIAL, fix_send_tile(scene, i));
    }
    TEST_ASSERT_TRUE(aisle_layout_is_staged(&fix_layout));
}

static inline void fix_enforce(void) {
    aisle_layout_commit(&fix_layout);
    TEST_ASSERT_FALSE(aisle_layout_is_in_force(&fix_layout));
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_layout_build(&fix_layout, UINT32_MAX));
    TEST_ASSERT_TRUE(aisle_layout_is_in_force(&fix_layout));
}

static inline void fix_load(const fix_scene *scene) {
    fix_send(scene);
    fix_enforce();
}

static inline void fix_expect_refusal(aisle_status status, int16_t cause, int32_t id) {
    TEST_ASSERT_EQUAL(AISLE_ERR_DATA, status);
    TEST_ASSERT_EQUAL(cause, fix_why.cause);
    TEST_ASSERT_EQUAL(id, fix_why.id);
}
#endif
