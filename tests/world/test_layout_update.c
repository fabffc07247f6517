#include "cases.h"
#include "layout_fixture.h"

#include <stdlib.h>

// Two layouts in memory of their own: fix_layout takes the patches, `fresh` is loaded whole each time.
enum { BIG_CELLS = 1300000, BLOCK = 8 << 20 };
static unsigned char *memory[2];
static aisle_layout fresh;
static fix_scene scene; // what the layout should be now
static aisle_layout_patch_msg patch;
static uint32_t updates; // builds that went on from the one before
static uint32_t wholes;  // and that did not

static void start(aisle_layout *layout, uint32_t which) {
    unsigned char *aligned = memory[which] + (64U - (uintptr_t)memory[which] % 64U) % 64U;
    aisle_arena arena = aisle_arena_over(aligned, BLOCK - 64U);
    const aisle_limits limits = {.cells = BIG_CELLS, .polygons = FIX_POLYGONS, .vertices = FIX_VERTICES};
    aisle_layout_carve(layout, &arena, &limits);
    TEST_ASSERT_FALSE(arena.overflow);
}

void setUp(void) {
    start(&fix_layout, 0);
    updates = 0;
    wholes = 0;
}
void tearDown(void) {}

static void swap_layouts(void) {
    const aisle_layout swap = fix_layout;
    fix_layout = fresh;
    fresh = swap;
}

static void expect_same_index(const aisle_layout_index *want, const aisle_layout_index *index) {
    TEST_ASSERT_EQUAL_UINT32(want->nx, index->nx);
    TEST_ASSERT_EQUAL_UINT32(want->ny, index->ny);
    TEST_ASSERT_EQUAL_DOUBLE(want->side, index->side);
    TEST_ASSERT_EQUAL_DOUBLE(want->per_metre, index->per_metre);
    const uint32_t buckets = want->nx * want->ny;
    TEST_ASSERT_EQUAL_MEMORY(want->starts, index->starts, (buckets + 1U) * sizeof *want->starts);
    if (want->starts[buckets] > 0) {
        TEST_ASSERT_EQUAL_MEMORY(want->entries, index->entries, want->starts[buckets] * sizeof *want->entries);
    }
}

static void expect_same_rects(const aisle_layout_rects *want, const aisle_layout_rects *rects) {
    TEST_ASSERT_EQUAL_UINT32(want->count, rects->count);
    TEST_ASSERT_EQUAL(want->overflow, rects->overflow);
    if (want->count > 0) {
        TEST_ASSERT_EQUAL_MEMORY(want->rect, rects->rect, want->count * sizeof *want->rect);
        TEST_ASSERT_EQUAL_MEMORY(want->real, rects->real, want->count);
    }
}

// Grid, field, indices, rectangles, zones and content are those of a layout loaded whole that says the same.
static void expect_as_fresh(void) {
    start(&fresh, 1);
    swap_layouts();
    fix_load(&scene);
    swap_layouts();
    const aisle_lattice *l = &fresh.grid.lattice;
    TEST_ASSERT_EQUAL_MEMORY(l, &fix_layout.grid.lattice, sizeof *l);
    TEST_ASSERT_EQUAL_MEMORY(fresh.grid.field, fix_layout.grid.field, l->w * l->h * sizeof *fresh.grid.field);
    expect_same_index(&fresh.index, &fix_layout.index);
    expect_same_index(&fresh.wide, &fix_layout.wide);
    if (scene.tiles > 0) {
        expect_same_rects(&fresh.rects, &fix_layout.rects);
    }
    for (int8_t kind = 0; kind < AISLE_LAYOUT_KINDS; kind++) {
        TEST_ASSERT_EQUAL(aisle_layout_has_kind(&fresh, kind), aisle_layout_has_kind(&fix_layout, kind));
    }
    TEST_ASSERT_EQUAL_HEX64(aisle_layout_content(&fresh), aisle_layout_content(&fix_layout));
    TEST_ASSERT_EQUAL_UINT32(scene.count, aisle_layout_zone_count(&fix_layout));
    for (uint32_t i = 0; i < scene.count; i++) {
        TEST_ASSERT_TRUE(aisle_layout_store_is_same(&fix_layout.store[fix_layout.active],
                                                    aisle_layout_zone(&fix_layout, i), &scene.polygons[i]));
    }
    for (int16_t i = 0; i < scene.parts; i++) { // the checksum is the whole layout's
        TEST_ASSERT_EQUAL(AISLE_OK, fix_send_part(&scene, i));
    }
    TEST_ASSERT_FALSE(aisle_layout_is_staged(&fix_layout));
}

// ---- edits, of the patch and of the scene alike

static void new_patch(void) {
    memset(&patch, 0, sizeof patch);
    patch.map_id = scene.map_id;
    patch.base_revision = scene.map_revision;
    patch.map_revision = ++scene.map_revision;
}

static void put(const aisle_polygon_msg *polygon) {
    patch.polygons[patch.num_polygons] = *polygon;
    patch.num_polygons++;
}

static void add(const aisle_polygon_msg *polygon) {
    put(polygon);
    scene.polygons[scene.count] = *polygon;
    scene.count++;
}

static void take_away(uint32_t i) {
    patch.removed[patch.num_removed] = scene.polygons[i].id;
    patch.num_removed++;
    memmove(&scene.polygons[i], &scene.polygons[i + 1U], (scene.count - i - 1U) * sizeof scene.polygons[0]);
    scene.count--;
}

static void shift(aisle_polygon_msg *p, double dx, double dy) {
    for (int32_t i = 0; i < p->num_vertices; i++) {
        p->vertices[i][0] += dx;
        p->vertices[i][1] += dy;
    }
}

static void random_polygon(aisle_rng *rng, aisle_polygon_msg *p, int32_t id) {
    aisle_vec2 v[8];
    const uint32_t n = 3U + aisle_rng_below(rng, 6);
    const aisle_vec2 centre = {gen_in(rng, scene.x_min - 0.5, scene.x_max + 0.5),
                               gen_in(rng, scene.y_min - 0.5, scene.y_max + 0.5)};
    gen_polygon(rng, centre, gen_in(rng, 0.02, 0.9), gen_in(rng, 0.02, 0.5), n, v);
    fix_set_polygon(p, id, (int8_t)aisle_rng_below(rng, 5), v, n);
}

static void random_edit(aisle_rng *rng, uint32_t i) {
    aisle_polygon_msg *p = &scene.polygons[i];
    switch (aisle_rng_below(rng, 6)) {
    case 0:
        take_away(i);
        break;
    case 1: // a little aside
        shift(p, gen_in(rng, -0.2, 0.2), gen_in(rng, -0.2, 0.2));
        put(p);
        break;
    case 2: // somewhere else, something else
        random_polygon(rng, p, p->id);
        put(p);
        break;
    case 3: // an obstacle no more, or one now
        p->kind = p->kind <= AISLE_POLYGON_KEEPOUT ? AISLE_POLYGON_DIRECTED : AISLE_POLYGON_KEEPOUT;
        put(p);
        break;
    case 4: // as it was
        put(p);
        break;
    default: { // as it was, but last
        const aisle_polygon_msg same = *p;
        take_away(i);
        add(&same);
        break;
    }
    }
}

// One patch: a few edits and a few new polygons.
static void random_patch(aisle_rng *rng, int32_t first_id) {
    new_patch();
    const uint32_t edits = aisle_rng_below(rng, 4);
    const uint32_t count = scene.count;
    for (uint32_t k = 0; k < edits && count > 8U; k++) { // from the end, each in its own part of the list
        random_edit(rng, count - 1U - (count / 4U) * k - aisle_rng_below(rng, count / 4U));
    }
    for (uint32_t k = aisle_rng_below(rng, 3); k > 0U && scene.count < 60U; k--) {
        aisle_polygon_msg p;
        random_polygon(rng, &p, first_id + (int32_t)k);
        add(&p);
    }
}

static void enforce(uint32_t units) {
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_layout_take_patch(&fix_layout, &patch, &fix_why));
    aisle_layout_commit(&fix_layout);
    while (aisle_layout_build(&fix_layout, units) == AISLE_BUSY) {
    }
    const aisle_lattice *l = &fix_layout.grid.lattice;
    const bool is_update = fix_layout.has_base && 2U * fix_layout.update.cells <= (uint64_t)l->w * l->h;
    updates += is_update ? 1U : 0U;
    wholes += is_update ? 0U : 1U;
}

static void check_scripts(uint64_t seed, uint32_t scripts, uint32_t units) {
    aisle_rng rng = aisle_rng_seed(seed);
    fix_load(&scene);
    for (uint32_t i = 0; i < CASES(scripts); i++) {
        random_patch(&rng, (int32_t)(2000000U + 10U * i));
        enforce(units);
        expect_as_fresh();
    }
}

// ---- tests

static void test_any_patch_gives_what_a_fresh_load_gives(void) {
    for (uint32_t map = 0; map < 12U; map++) {
        start(&fix_layout, 0);
        aisle_rng rng = aisle_rng_seed(501U + map);
        fix_random_scene(&scene, &rng, map % 3U == 0U ? 0U : 40U, 2);
        fix_set_bounds(&scene, 0.0, 0.0, map % 2U == 0U ? 10.0 : 10.03, map % 2U == 0U ? 8.0 : 7.98);
        check_scripts(520U + map, 60, UINT32_MAX);
    }
    TEST_ASSERT_TRUE(updates > LEAST(400U) && wholes > LEAST(8U)); // both ways are tried
}

static void test_any_patch_on_a_scan_does(void) {
    for (uint32_t map = 0; map < 8U; map++) {
        start(&fix_layout, 0);
        aisle_rng rng = aisle_rng_seed(540U + map);
        fix_random_scene(&scene, &rng, 12, 1);
        fix_random_scan(&scene, &rng, 150, 120, map % 2U == 0U ? 9U : 700U, 2);
        if (map >= 4U) { // the bounds cut the outer cells
            fix_set_bounds(&scene, 1.03, 2.03, 15.98, 13.97);
        }
        check_scripts(560U + map, 60, UINT32_MAX);
    }
    TEST_ASSERT_TRUE(updates > LEAST(300U));
}

static void test_walls_longer_than_a_piece_come_move_and_go(void) {
    memset(&scene, 0, sizeof scene);
    scene.map_id = 7;
    scene.map_revision = 1;
    scene.parts = 1;
    fix_set_bounds(&scene, 0, 0, 60, 50);
    aisle_rng rng = aisle_rng_seed(580);
    for (uint32_t i = 0; i < 120U; i++) { // pillars
        const double x = gen_in(&rng, 0, 60);
        const double y = gen_in(&rng, 0, 50);
        fix_add_box(&scene, (int32_t)(i + 1U), x, y, x + 0.3, y + 0.3);
    }
    fix_load(&scene);
    for (uint32_t i = 0; i < 16U; i++) {
        new_patch();
        const double angle = gen_in(&rng, 0, 6.28);
        const double c = cos(angle);
        const double s = sin(angle);
        const double length = i % 4U == 3U ? 11.0 : gen_in(&rng, 7, 20); // half, m
        const double width = i % 4U == 3U ? 8.0 : 0.15;
        const aisle_vec2 v[4] = {{30 - c * length + s * width, 25 - s * length - c * width},
                                 {30 + c * length + s * width, 25 + s * length - c * width},
                                 {30 + c * length - s * width, 25 + s * length + c * width},
                                 {30 - c * length - s * width, 25 - s * length + c * width}};
        aisle_polygon_msg wall;
        fix_set_polygon(&wall, 1000, (int8_t)(i % 2U), v, 4);
        if (i == 0U) {
            add(&wall);
        } else {
            scene.polygons[120] = wall;
            put(&wall);
        }
        enforce(UINT32_MAX);
        expect_as_fresh();
    }
    new_patch();
    take_away(120);
    enforce(UINT32_MAX);
    expect_as_fresh();
    TEST_ASSERT_TRUE(updates >= 7U && wholes >= 3U); // both ways are tried
}

static void test_any_slicing_of_a_patch_gives_the_same(void) {
    for (uint32_t units = 1; units < 4000U; units = units * 3U + 2U) {
        start(&fix_layout, 0);
        aisle_rng rng = aisle_rng_seed(600);
        fix_random_scene(&scene, &rng, 40, 2);
        check_scripts(601, 8, units);
    }
}

static uint32_t units_of_build(uint32_t slice) {
    uint32_t spent = 0;
    while (aisle_layout_build(&fix_layout, slice) == AISLE_BUSY) {
        spent += slice;
    }
    return spent;
}

// A patch costs what is around it: the same hall with ten times the area beside it costs the same.
static void test_the_work_does_not_grow_with_the_map(void) {
    uint32_t units[2];
    for (uint32_t map = 0; map < 2U; map++) {
        start(&fix_layout, 0);
        memset(&scene, 0, sizeof scene);
        scene.map_id = 7;
        scene.map_revision = 1;
        scene.parts = 1;
        fix_set_bounds(&scene, 0, 0, map == 0U ? 20 : 60, map == 0U ? 8 : 50);
        for (uint32_t i = 0; i < 20U; i++) {
            const double x = 1.0 + 2.0 * (i % 10U);
            const double y = 1.0 + 4.0 * (i / 10U);
            fix_add_box(&scene, (int32_t)(i + 1U), x, y, x + 1.0, y + 2.0);
        }
        fix_load(&scene);
        new_patch();
        shift(&scene.polygons[3], 0.2, 0.1);
        put(&scene.polygons[3]);
        TEST_ASSERT_EQUAL(AISLE_OK, aisle_layout_take_patch(&fix_layout, &patch, &fix_why));
        aisle_layout_commit(&fix_layout);
        units[map] = units_of_build(1);
        TEST_ASSERT_UINT32_WITHIN(200, units[map] + 1U, aisle_layout_work(&fix_layout));
        expect_as_fresh();
    }
    TEST_ASSERT_EQUAL_UINT32(units[0], units[1]);
    TEST_ASSERT_TRUE(units[0] < 1200U);
}

static void test_work_is_what_was_done_however_it_was_cut(void) {
    for (uint32_t units = 1; units < 4000U; units = units * 5U + 1U) {
        start(&fix_layout, 0);
        aisle_rng rng = aisle_rng_seed(605);
        fix_random_scene(&scene, &rng, 40, 2);
        fix_send(&scene);
        aisle_layout_commit(&fix_layout);
        (void)units_of_build(units);
        TEST_ASSERT_EQUAL_UINT32(4U + 40U + 1U + 3U * 160U, aisle_layout_work(&fix_layout)); // 200 x 160 cells, no scan
        new_patch();
        shift(&scene.polygons[3], 0.1, 0.0);
        scene.polygons[3].kind = AISLE_POLYGON_OBSTACLE;
        put(&scene.polygons[3]);
        TEST_ASSERT_EQUAL(AISLE_OK, aisle_layout_take_patch(&fix_layout, &patch, &fix_why));
        aisle_layout_commit(&fix_layout);
        TEST_ASSERT_EQUAL_UINT32(0, aisle_layout_work(&fix_layout));
        (void)units_of_build(units);
        static uint32_t want;
        want = units == 1U ? aisle_layout_work(&fix_layout) : want;
        TEST_ASSERT_EQUAL_UINT32(want, aisle_layout_work(&fix_layout));
    }
}

static void test_polygons_that_change_no_cell_are_gone_through_and_no_more(void) {
    aisle_rng rng = aisle_rng_seed(606);
    fix_random_scene(&scene, &rng, 0, 1);
    fix_add_box(&scene, 1, 2.0, 2.0, 6.0, 6.0);
    fix_load(&scene);
    new_patch();
    fix_add_box(&scene, 2, 3.01, 3.01, 3.99, 3.99); // 20 rows, inside
    put(&scene.polygons[1]);
    enforce(UINT32_MAX);
    TEST_ASSERT_EQUAL_UINT32(22, aisle_layout_work(&fix_layout)); // and the indices
    expect_as_fresh();
    new_patch();
    take_away(1);
    enforce(UINT32_MAX);
    TEST_ASSERT_EQUAL_UINT32(22, aisle_layout_work(&fix_layout));
    expect_as_fresh();
}

static void test_zones_that_are_no_obstacles_cost_no_rows(void) {
    aisle_rng rng = aisle_rng_seed(610);
    fix_random_scene(&scene, &rng, 40, 2);
    fix_load(&scene);
    new_patch();
    aisle_polygon_msg p;
    random_polygon(&rng, &p, 77);
    p.kind = AISLE_POLYGON_PENALTY;
    p.value = 0.5F;
    add(&p);
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_layout_take_patch(&fix_layout, &patch, &fix_why));
    aisle_layout_commit(&fix_layout);
    TEST_ASSERT_TRUE(units_of_build(1) <= 3U);
    expect_as_fresh();
}

// A layout that comes in while a patch is built takes the store the update reads: it builds the whole then.
static void test_a_part_that_comes_during_the_update_does_no_harm(void) {
    for (uint32_t units = 1; units < 300U; units += 37U) {
        start(&fix_layout, 0);
        aisle_rng rng = aisle_rng_seed(620);
        fix_random_scene(&scene, &rng, 40, 2);
        fix_load(&scene);
        new_patch();
        for (uint32_t i = 0; i < 5U; i++) {
            shift(&scene.polygons[i], 0.3, 0.1);
            put(&scene.polygons[i]);
        }
        TEST_ASSERT_EQUAL(AISLE_OK, aisle_layout_take_patch(&fix_layout, &patch, &fix_why));
        aisle_layout_commit(&fix_layout);
        (void)aisle_layout_build(&fix_layout, units);
        static fix_scene other;
        fix_random_scene(&other, &rng, 60, 2);
        other.map_revision = 9;
        TEST_ASSERT_EQUAL(AISLE_PARTIAL, fix_send_part(&other, 0));
        TEST_ASSERT_EQUAL(AISLE_OK, aisle_layout_build(&fix_layout, UINT32_MAX));
        const aisle_lattice *l = &fix_layout.grid.lattice;
        start(&fresh, 1);
        swap_layouts();
        fix_load(&scene);
        swap_layouts();
        TEST_ASSERT_EQUAL_MEMORY(fresh.grid.field, fix_layout.grid.field, l->w * l->h * sizeof *fresh.grid.field);
        TEST_ASSERT_EQUAL(AISLE_OK, fix_send_part(&other, 1));
        scene = other;
        fix_enforce();
        expect_as_fresh();
    }
}

// ---- refusals

static void spoil(aisle_rng *rng, uint32_t how) {
    switch (how) {
    case 0: // not there
        patch.removed[patch.num_removed++] = 5555;
        break;
    case 1: // twice
        patch.removed[patch.num_removed] = scene.polygons[0].id;
        patch.removed[patch.num_removed + 1] = scene.polygons[0].id;
        patch.num_removed = (int16_t)(patch.num_removed + 2);
        break;
    case 2: // two of one id
        random_polygon(rng, &patch.polygons[0], 9);
        random_polygon(rng, &patch.polygons[1], 9);
        patch.num_polygons = 2;
        break;
    case 3:
        random_polygon(rng, &patch.polygons[0], 9);
        patch.polygons[0].vertices[1][1] = (double)NAN;
        patch.num_polygons = 1;
        break;
    case 4:
        random_polygon(rng, &patch.polygons[0], 9);
        patch.polygons[0].value = INFINITY;
        patch.num_polygons = 1;
        break;
    case 5: // another base
        patch.base_revision--;
        break;
    case 6: // another map
        patch.map_id++;
        break;
    case 7:
        patch.num_polygons = AISLE_LAYOUT_PATCH_MAX_POLYGONS + 1;
        break;
    case 8: // more than there is room for
        for (int16_t i = 0; i < AISLE_LAYOUT_PATCH_MAX_POLYGONS; i++) {
            random_polygon(rng, &patch.polygons[i], 3000000 + i);
        }
        patch.num_polygons = AISLE_LAYOUT_PATCH_MAX_POLYGONS;
        break;
    default: // back in time
        patch.map_revision = patch.base_revision;
        break;
    }
}

static void test_refused_patches_leave_all_as_it_was(void) {
    aisle_rng rng = aisle_rng_seed(630);
    fix_random_scene(&scene, &rng, 40, 2);
    fix_load(&scene);
    for (uint32_t i = 0; i < 60U; i++) {
        const fix_scene was = scene;
        random_patch(&rng, (int32_t)(4000000U + 10U * i));
        spoil(&rng, i % 10U);
        scene = was;
        fix_why.cause = 0;
        TEST_ASSERT_EQUAL(AISLE_ERR_DATA, aisle_layout_take_patch(&fix_layout, &patch, &fix_why));
        TEST_ASSERT_TRUE(fix_why.cause != 0);
        TEST_ASSERT_FALSE(aisle_layout_is_staged(&fix_layout));
        TEST_ASSERT_TRUE(aisle_layout_is_in_force(&fix_layout));
        expect_as_fresh();
        random_patch(&rng, (int32_t)(5000000U + 10U * i)); // and the next good one is taken
        enforce(UINT32_MAX);
        expect_as_fresh();
    }
}

int main(void) {
    memory[0] = malloc(BLOCK);
    memory[1] = malloc(BLOCK);
    UNITY_BEGIN();
    RUN_TEST(test_any_patch_gives_what_a_fresh_load_gives);
    RUN_TEST(test_any_patch_on_a_scan_does);
    RUN_TEST(test_walls_longer_than_a_piece_come_move_and_go);
    RUN_TEST(test_any_slicing_of_a_patch_gives_the_same);
    RUN_TEST(test_the_work_does_not_grow_with_the_map);
    RUN_TEST(test_work_is_what_was_done_however_it_was_cut);
    RUN_TEST(test_polygons_that_change_no_cell_are_gone_through_and_no_more);
    RUN_TEST(test_zones_that_are_no_obstacles_cost_no_rows);
    RUN_TEST(test_a_part_that_comes_during_the_update_does_no_harm);
    RUN_TEST(test_refused_patches_leave_all_as_it_was);
    const int failures = UNITY_END();
    free(memory[0]);
    free(memory[1]);
    return failures;
}
