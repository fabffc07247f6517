#include "layout_fixture.h"

static aisle_layout_store store;

void setUp(void) {
    unsigned char *aligned = fix_memory + (64U - (uintptr_t)fix_memory % 64U) % 64U;
    aisle_arena arena = aisle_arena_over(aligned, sizeof fix_memory - 64U);
    aisle_layout_store_carve(&store, &arena, FIX_POLYGONS, FIX_VERTICES, FIX_CELLS);
    TEST_ASSERT_FALSE(arena.overflow);
}
void tearDown(void) {}

static fix_scene scene;

static aisle_polygon_msg polygon_of_kind(int8_t kind, float value) {
    const aisle_vec2 v[3] = {{0, 0}, {1, 0}, {0, 1}};
    aisle_polygon_msg p;
    fix_set_polygon(&p, 1, kind, v, 3);
    p.value = value;
    return p;
}

static bool is_valid(int8_t kind, float value) {
    const aisle_polygon_msg p = polygon_of_kind(kind, value);
    return aisle_polygon_is_valid(&p);
}

static void test_values_are_checked_by_kind(void) {
    TEST_ASSERT_TRUE(is_valid(AISLE_POLYGON_OBSTACLE, 0.0F));
    TEST_ASSERT_TRUE(is_valid(AISLE_POLYGON_KEEPOUT, 0.0F));
    TEST_ASSERT_TRUE(is_valid(AISLE_POLYGON_DIRECTED, 0.0F));
    TEST_ASSERT_TRUE(is_valid(AISLE_POLYGON_SPEED_LIMIT, 0.3F));
    TEST_ASSERT_FALSE(is_valid(AISLE_POLYGON_SPEED_LIMIT, 0.0F));
    TEST_ASSERT_FALSE(is_valid(AISLE_POLYGON_SPEED_LIMIT, -1.0F));
    TEST_ASSERT_TRUE(is_valid(AISLE_POLYGON_PENALTY, 0.0F));
    TEST_ASSERT_TRUE(is_valid(AISLE_POLYGON_PENALTY, 1.0F));
    TEST_ASSERT_FALSE(is_valid(AISLE_POLYGON_PENALTY, 1.01F));
    TEST_ASSERT_FALSE(is_valid(AISLE_POLYGON_PENALTY, -0.01F));
    TEST_ASSERT_FALSE(is_valid(5, 0.0F));
    TEST_ASSERT_FALSE(is_valid(-1, 0.0F));
    for (int8_t kind = 0; kind < 5; kind++) {
        TEST_ASSERT_FALSE(is_valid(kind, NAN));
        TEST_ASSERT_FALSE(is_valid(kind, INFINITY));
    }
}

static void test_id_direction_count_and_shape_are_checked(void) {
    aisle_polygon_msg p = polygon_of_kind(AISLE_POLYGON_DIRECTED, 0.0F);
    p.id = 0;
    TEST_ASSERT_FALSE(aisle_polygon_is_valid(&p));
    p.id = -4;
    TEST_ASSERT_FALSE(aisle_polygon_is_valid(&p));
    p.id = 4;
    p.direction = NAN;
    TEST_ASSERT_FALSE(aisle_polygon_is_valid(&p));
    p.direction = 3.0F;
    TEST_ASSERT_TRUE(aisle_polygon_is_valid(&p));
    p.num_vertices = 2;
    TEST_ASSERT_FALSE(aisle_polygon_is_valid(&p));
    p.num_vertices = 17;
    TEST_ASSERT_FALSE(aisle_polygon_is_valid(&p));
    p.num_vertices = -1;
    TEST_ASSERT_FALSE(aisle_polygon_is_valid(&p));
    p.num_vertices = 3;
    p.vertices[1][0] = -1.0; // clockwise
    TEST_ASSERT_FALSE(aisle_polygon_is_valid(&p));
}

static void fill(uint64_t seed, uint32_t count) {
    aisle_rng rng = aisle_rng_seed(seed);
    fix_random_scene(&scene, &rng, count, 1);
    for (uint32_t i = 0; i < count; i++) {
        scene.polygons[i].direction = (float)gen_in(&rng, -3, 3);
        aisle_layout_store_add(&store, &scene.polygons[i]);
    }
}

static void test_a_stored_polygon_comes_back_bit_for_bit(void) {
    fill(101, 100);
    for (uint32_t i = 0; i < 100U; i++) {
        aisle_polygon_msg p;
        memset(&p, 0, sizeof p);
        aisle_layout_store_polygon(&store, &store.zones[i], &p);
        TEST_ASSERT_EQUAL_INT32(scene.polygons[i].id, p.id);
        TEST_ASSERT_EQUAL_MEMORY(scene.polygons[i].vertices, p.vertices, sizeof p.vertices);
        TEST_ASSERT_TRUE(aisle_layout_store_is_same(&store, &store.zones[i], &scene.polygons[i]));
    }
}

static void test_any_difference_is_seen(void) {
    fill(102, 1);
    for (uint32_t what = 0; what < 6U; what++) {
        aisle_polygon_msg p = scene.polygons[0];
        p.id += what == 0U ? 1 : 0;
        p.kind = (int8_t)(what == 1U ? (p.kind + 1) % 5 : p.kind);
        p.value += what == 2U ? 0.25F : 0.0F;
        p.direction += what == 3U ? 0.25F : 0.0F;
        p.num_vertices = (int16_t)(what == 4U ? p.num_vertices - 1 : p.num_vertices);
        p.vertices[p.num_vertices - 1][1] += what == 5U ? 1e-9 : 0.0;
        TEST_ASSERT_FALSE(aisle_layout_store_is_same(&store, &store.zones[0], &p));
    }
}

static void test_checksum_is_crc32_of_the_encoded_polygons(void) {
    TEST_ASSERT_EQUAL_HEX32(0, aisle_layout_store_crc(&store));
    fill(103, 57);
    TEST_ASSERT_EQUAL_HEX32((uint32_t)fix_crc(scene.polygons, 57), aisle_layout_store_crc(&store));
}

static void test_reorder_moves_every_zone_with_its_vertices(void) {
    fill(104, 120);
    aisle_rng rng = aisle_rng_seed(105);
    for (uint32_t trial = 0; trial < 50U; trial++) {
        static uint16_t to[120];
        static int32_t ids[120];
        for (uint16_t i = 0; i < 120U; i++) {
            to[i] = i;
        }
        for (uint32_t i = 120; i > 1U; i--) { // shuffle
            const uint32_t k = aisle_rng_below(&rng, i);
            const uint16_t swap = to[k];
            to[k] = to[i - 1U];
            to[i - 1U] = swap;
        }
        for (uint32_t i = 0; i < 120U; i++) {
            ids[to[i]] = store.zones[i].id;
        }
        aisle_layout_store_reorder(&store, to);
        for (uint32_t i = 0; i < 120U; i++) {
            TEST_ASSERT_EQUAL_INT32(ids[i], store.zones[i].id);
            for (uint32_t s = 0; s < 120U; s++) {
                if (scene.polygons[s].id == ids[i]) {
                    TEST_ASSERT_TRUE(aisle_layout_store_is_same(&store, &store.zones[i], &scene.polygons[s]));
                }
            }
        }
    }
}

static void test_freed_runs_and_runs_found_agree_with_plain_cells(void) {
    static bool occupied[FIX_CELLS];
    static const uint32_t sides[][2] = {{1, 1}, {63, 9}, {64, 9}, {65, 9}, {200, 200}, {1, 500}, {777, 3}};
    aisle_rng rng = aisle_rng_seed(106);
    for (uint32_t s = 0; s < 7U; s++) {
        const uint32_t w = sides[s][0];
        const uint32_t h = sides[s][1];
        store.lattice = (aisle_lattice){0, 0, 1, w, h};
        aisle_layout_store_fill_scan(&store);
        memset(occupied, 1, sizeof occupied);
        for (uint32_t k = 0; k < 4U * h; k++) {
            const uint32_t iy = aisle_rng_below(&rng, h);
            const uint32_t from = aisle_rng_below(&rng, w + 1U);
            const uint32_t end = from + aisle_rng_below(&rng, w - from + 1U);
            aisle_layout_store_free_run(&store, iy, from, end);
            memset(&occupied[iy * w + from], 0, end - from);
        }
        for (uint32_t iy = 0; iy < h; iy++) {
            const uint32_t from = aisle_rng_below(&rng, w);
            const uint32_t stop = from + aisle_rng_below(&rng, w - from + 1U);
            uint32_t seen = from;
            uint32_t end;
            for (uint32_t ix = from; aisle_layout_store_run(&store, iy, &ix, stop, &end); ix = end) {
                TEST_ASSERT_TRUE(ix >= seen && end > ix && end <= stop);
                for (; seen < end; seen++) {
                    TEST_ASSERT_EQUAL(seen >= ix, occupied[iy * w + seen]);
                }
            }
            for (; seen < stop; seen++) {
                TEST_ASSERT_FALSE(occupied[iy * w + seen]);
            }
        }
    }
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_values_are_checked_by_kind);
    RUN_TEST(test_id_direction_count_and_shape_are_checked);
    RUN_TEST(test_a_stored_polygon_comes_back_bit_for_bit);
    RUN_TEST(test_any_difference_is_seen);
    RUN_TEST(test_checksum_is_crc32_of_the_encoded_polygons);
    RUN_TEST(test_reorder_moves_every_zone_with_its_vertices);
    RUN_TEST(test_freed_runs_and_runs_found_agree_with_plain_cells);
    return UNITY_END();
}
