// What a layout patch costs: build/release/bench-patches [--quick]; a line of JSON for each hall, size and edit.
//
// Halls of 5 cm cells, an obstacle of 0.6 to 1.4 m per 10 m2 (at most 4000) or none at all. A box of so many cells a side
// comes at a random place, moves by half its side and goes, as three patches; the medians of all places. take_us:
// aisle_layout_take_patch(); index_us: both indices; field_us: the grid. window_cells: of all windows of a patch, with
// the columns beside; floor_us: reading and writing once as many cells (a square) at a random place of the field, the
// traffic no update can do without. load_us: the same hall loaded whole, the parts' messages not counted, the best of three.
#include "base/crc32.h"
#include "base/rng.h"
#include "wire/codec.h"
#include "world/layout.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { CELLS = 1 << 24, BLOCK = 96 << 20, PLACES_MAX = 101, PARTS = 8, OBSTACLES_MAX = 4000, BOX_ID = 1000000 };
enum { OBSTACLES_A_PART = OBSTACLES_MAX / PARTS };

#define RES 0.05

typedef struct cost {
    double take, index, field, floor;
    double cells;
} cost;

typedef struct setting {
    uint32_t side; // of the hall, cells
    uint32_t box;  // of the box, cells
    bool is_open;
    uint32_t places;
} setting;

static aisle_layout layout;
static aisle_layout_msg parts[PARTS];
static aisle_layout_patch_msg patch;
static uint16_t *copy;

void aisle_assert_failed(const char *file, int line, const char *condition) {
    (void)fprintf(stderr, "%s:%d: %s\n", file, line, condition);
    abort();
}

static double seconds(void) { // of the processor: other programs matter less
    struct timespec t;
    (void)clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static double in(aisle_rng *rng, double lo, double hi) {
    return lo + (hi - lo) * ((double)aisle_rng_next(rng) / 4294967296.0);
}

static void set_box(aisle_polygon_msg *p, int32_t id, double x, double y, double side) {
    const double v[4][2] = {{x, y}, {x + side, y}, {x + side, y + side}, {x, y + side}};
    *p = (aisle_polygon_msg){.id = id, .num_vertices = 4};
    memcpy(p->vertices, v, sizeof v);
}

// ---- the hall

static uint32_t make_hall(const setting *s, aisle_rng *rng) {
    const double side = (double)s->side * RES;
    const double wanted = side * side / 10.0;
    uint32_t count = s->is_open ? 0U : (uint32_t)wanted;
    count = count < OBSTACLES_MAX ? count : OBSTACLES_MAX;
    const uint32_t columns = (uint32_t)ceil(sqrt((double)count));
    uint32_t crc = 0;
    for (uint32_t i = 0; i < PARTS; i++) {
        parts[i].map_id = 1;
        parts[i].part = (int16_t)i;
        parts[i].num_parts = PARTS;
        parts[i].total_polygons = (int32_t)count;
        parts[i].x_max = parts[i].y_max = side;
        parts[i].num_polygons = 0;
    }
    for (uint32_t i = 0; i < count; i++) {
        const double slot = side / columns;
        const double size = in(rng, 0.6, 1.4);
        aisle_layout_msg *part = &parts[i / OBSTACLES_A_PART];
        aisle_polygon_msg *p = &part->polygons[part->num_polygons++];
        set_box(p, (int32_t)i + 1, slot * (i % columns) + in(rng, 0.0, slot - size),
                slot * (i / columns) + in(rng, 0.0, slot - size), size);
        uint8_t bytes[512];
        size_t n = 0;
        (void)aisle_msg_encode_body(AISLE_MSG_POLYGON, p, bytes, sizeof bytes, &n);
        crc = aisle_crc32(crc, bytes, n);
    }
    for (uint32_t i = 0; i < PARTS; i++) {
        parts[i].crc32 = (int32_t)crc;
    }
    return count;
}

static double load_once(void) {
    aisle_refusal why;
    for (uint32_t i = 0; i < PARTS; i++) {
        parts[i].map_revision = aisle_layout_map_revision(&layout) + 1;
        if (aisle_layout_take_part(&layout, &parts[i], &why) == AISLE_ERR_DATA) {
            (void)fprintf(stderr, "refused: %d %d\n", (int)why.cause, (int)why.id);
            exit(1);
        }
    }
    const double from = seconds();
    aisle_layout_commit(&layout);
    while (aisle_layout_build(&layout, UINT32_MAX) == AISLE_BUSY) {
    }
    return seconds() - from;
}

static double load(const setting *s) { // the best of three
    double best = load_once();
    for (uint32_t i = 0; i < 2U; i++) {
        const double again = load_once();
        best = again < best ? again : best;
    }
    if (layout.grid.lattice.w != s->side) {
        abort();
    }
    return best;
}

// ---- a patch

static void new_patch(void) {
    patch.map_id = 1;
    patch.base_revision = aisle_layout_map_revision(&layout);
    patch.map_revision = patch.base_revision + 1;
    patch.num_polygons = 0;
    patch.num_removed = 0;
}

static double floor_of(double cells, aisle_rng *rng) {
    const uint32_t w = layout.grid.lattice.w;
    uint32_t side = (uint32_t)sqrt(cells);
    side = side < w ? side : w;
    if (side == 0) {
        return 0.0;
    }
    const uint32_t x0 = aisle_rng_below(rng, w - side + 1U);
    const uint32_t y0 = aisle_rng_below(rng, w - side + 1U);
    const double from = seconds();
    for (uint32_t y = y0; y < y0 + side; y++) {
        uint16_t *row = &copy[y * w + x0];
        for (uint32_t x = 0; x < side; x++) {
            row[x] = (uint16_t)(row[x] + 1U);
        }
    }
    return seconds() - from;
}

static cost apply(aisle_rng *rng) {
    aisle_refusal why;
    const double from = seconds();
    if (aisle_layout_take_patch(&layout, &patch, &why) != AISLE_OK) {
        abort();
    }
    const double taken = seconds();
    aisle_layout_commit(&layout);
    (void)aisle_layout_build(&layout, 2); // the indices
    const double indexed = seconds();
    while (aisle_layout_build(&layout, UINT32_MAX) == AISLE_BUSY) {
    }
    const double built = seconds();
    const double cells = (double)layout.update.cells;
    return (cost){taken - from, indexed - taken, built - indexed, floor_of(cells, rng), cells};
}

// ---- medians

static int compare(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return x < y ? -1 : x > y;
}

static double median(const cost *costs, uint32_t n, size_t member) {
    double values[PLACES_MAX];
    for (uint32_t i = 0; i < n; i++) {
        memcpy(&values[i], (const char *)&costs[i] + member, sizeof values[i]);
    }
    qsort(values, n, sizeof values[0], compare);
    return values[n / 2U];
}

static void print(const setting *s, const char *edit, uint32_t obstacles, const cost *costs, double load_s) {
    (void)printf("{\"map_cells\": %.0f, \"hall\": \"%s\", \"obstacles\": %u, \"box\": %u, \"edit\": \"%s\", "
                 "\"take_us\": %.1f, \"index_us\": %.1f, \"field_us\": %.1f, \"window_cells\": %.0f, "
                 "\"floor_us\": %.2f, \"load_us\": %.0f}\n",
                 (double)s->side * s->side, s->is_open ? "open" : "full", (unsigned)obstacles, (unsigned)s->box, edit,
                 1e6 * median(costs, s->places, offsetof(cost, take)),
                 1e6 * median(costs, s->places, offsetof(cost, index)),
                 1e6 * median(costs, s->places, offsetof(cost, field)), median(costs, s->places, offsetof(cost, cells)),
                 1e6 * median(costs, s->places, offsetof(cost, floor)), 1e6 * load_s);
    (void)fflush(stdout);
}

static void run(const setting *s) {
    static cost came[PLACES_MAX], moved[PLACES_MAX], went[PLACES_MAX];
    aisle_rng rng = aisle_rng_seed(s->side);
    const uint32_t obstacles = make_hall(s, &rng);
    const double load_s = load(s);
    const double side = (double)s->side * RES;
    const double box = (double)s->box * RES - 0.01; // so many cells, wherever the box begins in one
    for (uint32_t i = 0; i < s->places; i++) {
        const double x = in(&rng, 0.0, side - 1.5 * box), y = in(&rng, 0.0, side - 1.5 * box);
        new_patch();
        patch.num_polygons = 1;
        set_box(&patch.polygons[0], BOX_ID, x, y, box);
        came[i] = apply(&rng);
        new_patch();
        patch.num_polygons = 1;
        set_box(&patch.polygons[0], BOX_ID, x + 0.5 * box, y + 0.5 * box, box);
        moved[i] = apply(&rng);
        new_patch();
        patch.num_removed = 1;
        patch.removed[0] = BOX_ID;
        went[i] = apply(&rng);
    }
    print(s, "came", obstacles, came, load_s);
    print(s, "moved", obstacles, moved, load_s);
    print(s, "went", obstacles, went, load_s);
}

int main(int argc, char **argv) {
    static const uint32_t boxes[] = {2, 5, 10, 20, 40, 80, 160, 320, 640, 1000};
    static const uint32_t sides[] = {316, 560, 1000, 1414, 2000, 2828, 4096};
    const bool is_quick = argc > 1 && strcmp(argv[1], "--quick") == 0;
    void *block;
    if (posix_memalign(&block, AISLE_ARENA_ALIGN, BLOCK) != 0) {
        return 1;
    }
    copy = calloc(CELLS, sizeof *copy);
    if (copy == NULL) {
        return 1;
    }
    memset(copy, 1, CELLS * sizeof *copy);
    aisle_arena arena = aisle_arena_over(block, BLOCK);
    const aisle_limits limits = {.cells = CELLS, .polygons = 4096, .vertices = 32768};
    aisle_layout_carve(&layout, &arena, &limits);
    if (arena.overflow) {
        return 1;
    }
    for (uint32_t open = 0; open < 2U; open++) {
        for (uint32_t i = 0; i < sizeof boxes / sizeof boxes[0]; i++) {
            const uint32_t places = is_quick ? 5U : (boxes[i] > 100U ? 21U : PLACES_MAX);
            run(&(setting){4096, boxes[i], open == 1U, places});
        }
        for (uint32_t i = 0; i < sizeof sides / sizeof sides[0]; i++) {
            run(&(setting){sides[i], 20, open == 1U, is_quick ? 5U : PLACES_MAX});
        }
    }
    free(copy);
    free(block);
    return 0;
}
