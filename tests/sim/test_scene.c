#include "sim/scene.h" // first: proves that the header stands alone

#include "base/rng.h"
#include "hall.h"

static aisle_sim_scene scene;
static aisle_grid_chunk_msg tile;

void setUp(void) {
    hall_begin(10.0, 8.0);
}
void tearDown(void) {
    aisle_sim_scene_free(&scene);
}

static double gap(double x, double y, double radius, int32_t *id) {
    aisle_sim_outline disc = aisle_sim_disc(aisle_vec2_of(x, y), radius);
    return aisle_sim_scene_gap(&scene, &disc, 5.0, id);
}

static void test_gaps_to_polygons_and_bounds_name_what_is_nearest(void) {
    int32_t id;
    hall_add(4.0, 3.0, 5.0, 4.0);
    hall_open(&scene);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0.75, gap(3.0, 3.5, 0.25, &id));
    TEST_ASSERT_EQUAL_INT32(1, id);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0.5, gap(9.0, 4.0, 0.5, &id));
    TEST_ASSERT_EQUAL_INT32(AISLE_SIM_ID_BOUNDS, id);
    TEST_ASSERT_EQUAL_DOUBLE(0.0, gap(4.5, 3.5, 0.1, &id));
    TEST_ASSERT_EQUAL_DOUBLE(0.0, gap(-1.0, 3.5, 0.1, &id));
    TEST_ASSERT_EQUAL_INT32(AISLE_SIM_ID_BOUNDS, id);
}

static void test_only_obstacles_and_keepouts_bar_the_way(void) {
    hall_add(1.0, 1.0, 2.0, 2.0);
    hall_add(4.0, 1.0, 5.0, 2.0);
    hall_add(7.0, 1.0, 8.0, 2.0);
    hall_layout.polygons[1].kind = AISLE_POLYGON_KEEPOUT;
    hall_layout.polygons[2].kind = AISLE_POLYGON_SPEED_LIMIT;
    hall_open(&scene);
    TEST_ASSERT_FALSE(aisle_sim_scene_has_room(&scene, aisle_vec2_of(1.5, 1.5), 0.1));
    TEST_ASSERT_FALSE(aisle_sim_scene_has_room(&scene, aisle_vec2_of(4.5, 1.5), 0.1));
    TEST_ASSERT_TRUE(aisle_sim_scene_has_room(&scene, aisle_vec2_of(7.5, 1.5), 0.1));
}

static void test_a_patch_removes_moves_and_adds(void) {
    hall_add(1.0, 1.0, 2.0, 2.0);
    hall_add(4.0, 1.0, 5.0, 2.0);
    hall_open(&scene);
    static aisle_layout_patch_msg patch;
    patch =
        (aisle_layout_patch_msg){.map_id = 1, .base_revision = 1, .map_revision = 2, .num_removed = 1, .removed = {1}};
    patch.num_polygons = 2;
    patch.polygons[0] = hall_layout.polygons[1];
    patch.polygons[1] = hall_layout.polygons[1];
    patch.polygons[1].id = 9;
    for (int i = 0; i < 4; i++) {
        patch.polygons[0].vertices[i][1] += 4.0; // 2 moves up
        patch.polygons[1].vertices[i][0] += 3.0; // 9 is new
    }
    TEST_ASSERT_TRUE(aisle_sim_scene_take_patch(&scene, &patch));
    TEST_ASSERT_TRUE(aisle_sim_scene_has_room(&scene, aisle_vec2_of(1.5, 1.5), 0.1));
    TEST_ASSERT_TRUE(aisle_sim_scene_has_room(&scene, aisle_vec2_of(4.5, 1.5), 0.1));
    TEST_ASSERT_FALSE(aisle_sim_scene_has_room(&scene, aisle_vec2_of(4.5, 5.5), 0.1));
    TEST_ASSERT_FALSE(aisle_sim_scene_has_room(&scene, aisle_vec2_of(7.5, 1.5), 0.1));
}

static void test_another_revision_replaces_the_hall(void) {
    hall_add(1.0, 1.0, 2.0, 2.0);
    hall_open(&scene);
    hall_begin(10.0, 8.0);
    hall_layout.map_revision = 2;
    hall_open(&scene);
    TEST_ASSERT_TRUE(aisle_sim_scene_has_room(&scene, aisle_vec2_of(1.5, 1.5), 0.1));
}

static void put_tile(int8_t encoding, const uint8_t *data, int32_t bytes, int32_t x0, int32_t y0, int32_t w,
                     int32_t h) {
    tile = (aisle_grid_chunk_msg){.map_id = 1,
                                  .map_revision = 1,
                                  .num_parts = 1,
                                  .resolution = 0.5F,
                                  .x0 = x0,
                                  .y0 = y0,
                                  .width = w,
                                  .height = h,
                                  .encoding = encoding,
                                  .num_bytes = bytes};
    memcpy(tile.data, data, (size_t)bytes);
    TEST_ASSERT_TRUE(aisle_sim_scene_take_tile(&scene, &tile));
}

static void test_bits_and_runs_of_a_scan_read_as_told(void) {
    // 20 x 16 cells of 0.5 m, all free but cell (3, 2); by bits the lower half, by runs the upper one.
    uint8_t bits[8 * 3] = {0};
    bits[2 * 3] = 1U << 3U;
    hall_open(&scene);
    put_tile(AISLE_GRID_CHUNK_BITS, bits, sizeof bits, 0, 0, 20, 8);
    const uint8_t runs[] = {0xA0, 0x01}; // 160 free cells
    put_tile(AISLE_GRID_CHUNK_RLE, runs, sizeof runs, 0, 8, 20, 8);
    TEST_ASSERT_FALSE(aisle_sim_scene_has_room(&scene, aisle_vec2_of(1.75, 1.25), 0.05));
    int32_t id;
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 0.4, gap(2.5, 1.25, 0.1, &id));
    TEST_ASSERT_EQUAL_INT32(AISLE_SIM_ID_SCAN, id);
    TEST_ASSERT_TRUE(aisle_sim_scene_has_room(&scene, aisle_vec2_of(5.0, 6.0), 0.5));
    const uint8_t island[] = {45, 2, 113}; // cells 5 and 6 of the third row up from y0 are occupied
    put_tile(AISLE_GRID_CHUNK_RLE, island, sizeof island, 0, 8, 20, 8);
    TEST_ASSERT_FALSE(aisle_sim_scene_has_room(&scene, aisle_vec2_of(2.75, 5.25), 0.05));
    TEST_ASSERT_FALSE(aisle_sim_scene_has_room(&scene, aisle_vec2_of(3.25, 5.25), 0.05));
    TEST_ASSERT_TRUE(aisle_sim_scene_has_room(&scene, aisle_vec2_of(3.75, 5.25), 0.05));
}

static void test_cells_that_no_tile_covers_are_occupied(void) {
    const uint8_t runs[] = {4};
    hall_open(&scene);
    put_tile(AISLE_GRID_CHUNK_RLE, runs, sizeof runs, 4, 4, 2, 2);
    TEST_ASSERT_TRUE(aisle_sim_scene_has_room(&scene, aisle_vec2_of(2.5, 2.5), 0.4));
    TEST_ASSERT_FALSE(aisle_sim_scene_has_room(&scene, aisle_vec2_of(2.5, 2.5), 0.6));
    TEST_ASSERT_FALSE(aisle_sim_scene_has_room(&scene, aisle_vec2_of(6.0, 6.0), 0.1));
}

static void test_broken_tiles_are_refused(void) {
    hall_open(&scene);
    tile = (aisle_grid_chunk_msg){.width = -1, .height = 4, .resolution = 0.5F};
    TEST_ASSERT_FALSE(aisle_sim_scene_take_tile(&scene, &tile));
    tile = (aisle_grid_chunk_msg){.width = 4, .height = 4, .resolution = 0.0F};
    TEST_ASSERT_FALSE(aisle_sim_scene_take_tile(&scene, &tile));
    tile = (aisle_grid_chunk_msg){.width = 4, .height = 4, .resolution = 0.5F, .origin_x = -1e9};
    TEST_ASSERT_FALSE(aisle_sim_scene_take_tile(&scene, &tile));
}

static void test_sight_ends_at_walls(void) {
    hall_add(5.0, 0.0, 5.2, 6.0);
    hall_open(&scene);
    TEST_ASSERT_FALSE(aisle_sim_scene_sees(&scene, aisle_vec2_of(2.0, 3.0), aisle_vec2_of(8.0, 3.0), 0.3));
    TEST_ASSERT_TRUE(aisle_sim_scene_sees(&scene, aisle_vec2_of(2.0, 7.0), aisle_vec2_of(8.0, 7.0), 0.3));
    TEST_ASSERT_FALSE(aisle_sim_scene_sees(&scene, aisle_vec2_of(2.0, 6.2), aisle_vec2_of(8.0, 6.2), 0.3));
    TEST_ASSERT_TRUE(aisle_sim_scene_sees(&scene, aisle_vec2_of(2.0, 3.0), aisle_vec2_of(2.0, 3.0), 0.3));
}

// The gap to a scan against all its cells, one by one.
static void test_gap_to_a_scan_is_that_to_its_cells_for_50_of_50_seeds(void) {
    for (uint64_t seed = 0; seed < 50; seed++) {
        aisle_rng rng = aisle_rng_seed(seed);
        uint8_t bits[16 * 3];
        for (size_t i = 0; i < sizeof bits; i++) {
            bits[i] = (uint8_t)(aisle_rng_next(&rng) & aisle_rng_next(&rng) & aisle_rng_next(&rng));
        }
        aisle_sim_scene_free(&scene);
        hall_begin(10.0, 8.0);
        hall_open(&scene);
        put_tile(AISLE_GRID_CHUNK_BITS, bits, sizeof bits, 0, 0, 20, 16);
        aisle_sim_outline body = aisle_sim_box(-0.3, -0.2, 0.3, 0.2);
        double x = 2.0 + 6.0 * (double)aisle_rng_float(&rng), y = 2.0 + 4.0 * (double)aisle_rng_float(&rng);
        body = aisle_sim_outline_at(&body, (aisle_pose2){x, y, 6.0 * (double)aisle_rng_float(&rng)});
        double least = 1.5;
        for (int k = 0; k < 20 * 16; k++) {
            double cx = 0.5 * (k % 20), cy = 0.5 * (k / 20); // NOLINT: whole cells
            aisle_sim_outline cell = aisle_sim_box(cx, cy, cx + 0.5, cy + 0.5);
            if ((bits[k / 20 * 3 + k % 20 / 8] >> (k % 20 % 8) & 1) != 0) {
                least = fmin(least, aisle_sim_gap(&body, &cell));
            }
        }
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, least, aisle_sim_scene_gap(&scene, &body, 1.5, NULL));
    }
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_gaps_to_polygons_and_bounds_name_what_is_nearest);
    RUN_TEST(test_only_obstacles_and_keepouts_bar_the_way);
    RUN_TEST(test_a_patch_removes_moves_and_adds);
    RUN_TEST(test_another_revision_replaces_the_hall);
    RUN_TEST(test_bits_and_runs_of_a_scan_read_as_told);
    RUN_TEST(test_cells_that_no_tile_covers_are_occupied);
    RUN_TEST(test_broken_tiles_are_refused);
    RUN_TEST(test_sight_ends_at_walls);
    RUN_TEST(test_gap_to_a_scan_is_that_to_its_cells_for_50_of_50_seeds);
    return UNITY_END();
}
