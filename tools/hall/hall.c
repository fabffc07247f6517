#include "hall.h"

#include "base/crc32.h"
#include "wire/codec.h"

#include <stdio.h>
#include <stdlib.h>

enum { POLYGONS = 4096, PER_PART = 200 };

static aisle_polygon_msg polygons[POLYGONS];
static aisle_layout_msg part;

void aisle_assert_failed(const char *file, int line, const char *condition) {
    (void)fprintf(stderr, "%s:%d: %s\n", file, line, condition);
    abort();
}

void hall_fail(const char *what) {
    (void)fprintf(stderr, "hall: %s\n", what);
    exit(2);
}

aisle_arena hall_arena(size_t bytes) {
    void *block = NULL;
    if (posix_memalign(&block, AISLE_ARENA_ALIGN, bytes) != 0) {
        hall_fail("no memory");
    }
    return aisle_arena_over(block, bytes);
}

static double number(void) {
    char word[64];
    char *end = word;
    if (scanf("%63s", word) != 1) {
        hall_fail("it ends too early");
    }
    double value = strtod(word, &end);
    if (end == word || *end != '\0') {
        hall_fail("not a number");
    }
    return value;
}

static uint32_t count(double most) {
    double value = number();
    if (!(value >= 0.0 && value <= most)) {
        hall_fail("a count is out of range");
    }
    return (uint32_t)value;
}

static uint32_t read_points(double (*out)[2]) {
    uint32_t n = count(16.0);
    for (uint32_t k = 0; k < n; k++) {
        out[k][0] = number();
        out[k][1] = number();
    }
    return n;
}

// The crc32 that every part carries, over all polygons.
static uint32_t read_polygons(uint32_t n) {
    uint32_t crc = 0;
    for (uint32_t i = 0; i < n; i++) {
        polygons[i].id = (int32_t)i + 1;
        polygons[i].num_vertices = (int16_t)read_points(polygons[i].vertices);
        uint8_t bytes[1024];
        size_t size = 0;
        if (aisle_msg_encode_body(AISLE_MSG_POLYGON, &polygons[i], bytes, sizeof bytes, &size) != AISLE_OK) {
            hall_fail("a polygon cannot be encoded");
        }
        crc = aisle_crc32(crc, bytes, size);
    }
    return crc;
}

static void take_layout(hall *self, uint32_t n) {
    aisle_refusal why;
    part.num_parts = (int16_t)(n / PER_PART + 1U);
    part.total_polygons = (int32_t)n;
    for (part.part = 0; part.part < part.num_parts; part.part++) {
        uint32_t first = (uint32_t)part.part * PER_PART;
        uint32_t here = n - first < PER_PART ? n - first : PER_PART;
        part.num_polygons = (int16_t)here;
        for (uint32_t i = 0; i < here; i++) {
            part.polygons[i] = polygons[first + i];
        }
        if (aisle_layout_take_part(&self->layout, &part, &why) < 0) {
            hall_fail("the layout is refused");
        }
    }
    aisle_layout_commit(&self->layout);
    while (aisle_layout_build(&self->layout, 1U << 20) == AISLE_BUSY) {
    }
}

void hall_read(hall *self, aisle_arena *arena, uint32_t cells) {
    const aisle_limits limits = {.cells = cells};
    aisle_layout_carve(&self->layout, arena, &limits);
    if (arena->overflow) {
        hall_fail("no memory");
    }
    part = (aisle_layout_msg){.map_id = 1, .map_revision = 1};
    part.x_min = number();
    part.y_min = number();
    part.x_max = number();
    part.y_max = number();
    aisle_vehicle_msg msg = {.vehicle_revision = 1};
    msg.footprint_radius = (float)number();
    msg.margin = (float)number();
    msg.num_vertices = (int16_t)read_points(msg.footprint);
    self->start.x = number();
    self->start.y = number();
    self->goal.x = number();
    self->goal.y = number();
    uint32_t n = count((double)POLYGONS);
    part.crc32 = (int32_t)read_polygons(n);
    aisle_refusal why;
    if (aisle_vehicle_from_msg(&msg, &self->vehicle, &why) != AISLE_OK) {
        hall_fail("the vehicle is refused");
    }
    take_layout(self, n);
}
