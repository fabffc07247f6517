#include "layout_fixture.h"

static fix_scene scene;

void setUp(void) {
    fix_start();
    aisle_rng rng = aisle_rng_seed(121);
    fix_random_scene(&scene, &rng, 3, 1);
    fix_random_scan(&scene, &rng, 61, 47, 3, 3);
}
void tearDown(void) {}

static aisle_status send(const aisle_grid_chunk_msg *msg) {
    return aisle_layout_take_tile(&fix_layout, msg, &fix_why);
}

static void expect_scan_of(const fix_scene *s) {
    TEST_ASSERT_TRUE(aisle_layout_has_scan(&fix_layout));
    TEST_ASSERT_EQUAL_UINT32(s->w, aisle_layout_grid(&fix_layout)->lattice.w);
    TEST_ASSERT_EQUAL_UINT32(s->h, aisle_layout_grid(&fix_layout)->lattice.h);
    for (uint32_t i = 0; i < s->w * s->h; i++) {
        uint32_t ix = i % s->w;
        uint32_t end;
        TEST_ASSERT_EQUAL(s->occupied[i], aisle_layout_scan_run(&fix_layout, i / s->w, &ix, ix + 1U, &end));
    }
}

static void test_tiles_in_any_order_with_repeats_and_both_encodings_give_the_scan(void) {
    aisle_rng rng = aisle_rng_seed(122);
    for (uint32_t trial = 0; trial < 40U; trial++) {
        fix_start();
        TEST_ASSERT_EQUAL(AISLE_PARTIAL, fix_send_part(&scene, 0));
        for (uint32_t in = 0; in != 511U;) {
            const uint32_t tile = aisle_rng_below(&rng, 9);
            in |= 1U << tile;
            (void)fix_make_tile(&scene, (int16_t)tile);
            if (trial % 2U == 1U) { // the other encoding
                fix_tile.encoding = (int8_t)(1 - fix_tile.encoding);
                memset(fix_tile.data, 0, sizeof fix_tile.data);
                fix_tile.num_bytes = 0;
                fix_encode_tile(&scene);
            }
            TEST_ASSERT_EQUAL(in == 511U ? AISLE_OK : AISLE_PARTIAL, send(&fix_tile));
        }
        fix_enforce();
        expect_scan_of(&scene);
    }
}

static void test_parts_may_end_after_the_tiles(void) {
    scene.parts = 2;
    TEST_ASSERT_EQUAL(AISLE_PARTIAL, fix_send_part(&scene, 1));
    for (int16_t i = 0; i < 9; i++) {
        TEST_ASSERT_EQUAL(AISLE_PARTIAL, fix_send_tile(&scene, i));
    }
    TEST_ASSERT_EQUAL(AISLE_OK, fix_send_part(&scene, 0));
    fix_enforce();
    expect_scan_of(&scene);
}

static void test_cells_no_tile_covers_are_occupied(void) {
    memset(scene.occupied, 0, sizeof scene.occupied);
    scene.tiles = 1;
    (void)fix_send_part(&scene, 0);
    (void)fix_make_tile(&scene, 0);
    fix_tile.x0 = 5;
    fix_tile.y0 = 6;
    fix_tile.width = 20;
    fix_tile.height = 10;
    fix_tile.num_bytes = 30;
    TEST_ASSERT_EQUAL(AISLE_OK, send(&fix_tile));
    fix_enforce();
    for (uint32_t i = 0; i < scene.w * scene.h; i++) {
        const uint32_t ix = i % scene.w;
        const uint32_t iy = i / scene.w;
        scene.occupied[i] = !(ix >= 5U && ix < 25U && iy >= 6U && iy < 16U);
    }
    expect_scan_of(&scene);
}

static void test_a_tile_without_its_layout_is_refused(void) {
    fix_expect_refusal(fix_send_tile(&scene, 0), AISLE_STATUS_NO_LAYOUT, 0);
    (void)fix_send_part(&scene, 0);
    scene.map_revision = 2;
    fix_expect_refusal(fix_send_tile(&scene, 0), AISLE_STATUS_NO_LAYOUT, 0);
    scene.map_revision = 0;
    fix_expect_refusal(fix_send_tile(&scene, 0), AISLE_STATUS_OUTDATED, 1);
    scene.map_revision = 1;
    scene.map_id = 8;
    fix_expect_refusal(fix_send_tile(&scene, 0), AISLE_STATUS_NO_LAYOUT, 0);
}

static void test_repeats_are_ok_when_complete_or_active_and_others_wait(void) {
    fix_send(&scene);
    TEST_ASSERT_EQUAL(AISLE_OK, fix_send_tile(&scene, 4));
    scene.map_revision = 2;
    TEST_ASSERT_EQUAL(AISLE_BUSY, fix_send_tile(&scene, 4));
    scene.map_revision = 1;
    fix_enforce();
    TEST_ASSERT_EQUAL(AISLE_OK, fix_send_tile(&scene, 4));
    TEST_ASSERT_FALSE(aisle_layout_is_staged(&fix_layout));
    scene.tiles = 4;
    fix_expect_refusal(fix_send_tile(&scene, 0), AISLE_STATUS_CONFLICT, 0);
}

static void expect_spoiled(int16_t cause, const char *what) {
    TEST_ASSERT_EQUAL_MESSAGE(AISLE_ERR_DATA, send(&fix_tile), what);
    TEST_ASSERT_EQUAL_MESSAGE(cause, fix_why.cause, what);
    TEST_ASSERT_EQUAL_MESSAGE(fix_tile.part, fix_why.id, what);
}

#define SPOIL(part, cause, change)                                                                                     \
    do {                                                                                                               \
        (void)fix_make_tile(&scene, part);                                                                             \
        fix_tile.change;                                                                                               \
        expect_spoiled(cause, #change);                                                                                \
    } while (0)

static void spoil_every_field(void) {
    SPOIL(2, AISLE_STATUS_CONFLICT, num_parts = 8);
    SPOIL(2, AISLE_STATUS_MALFORMED, part = 9);
    SPOIL(2, AISLE_STATUS_MALFORMED, part = -1);
    SPOIL(2, AISLE_STATUS_MALFORMED, origin_x = (double)NAN);
    SPOIL(2, AISLE_STATUS_MALFORMED, origin_y = 1e6);
    SPOIL(2, AISLE_STATUS_CONFLICT, origin_x += 0.06);
    SPOIL(2, AISLE_STATUS_CONFLICT, origin_y -= 0.06);
    SPOIL(2, AISLE_STATUS_MALFORMED, resolution = 0.004F);
    SPOIL(2, AISLE_STATUS_MALFORMED, resolution = 2.0F);
    SPOIL(2, AISLE_STATUS_MALFORMED, resolution = NAN);
    SPOIL(2, AISLE_STATUS_MALFORMED, x0 = -1);
    SPOIL(2, AISLE_STATUS_MALFORMED, y0 = INT32_MIN);
    SPOIL(2, AISLE_STATUS_MALFORMED, x0 = 42);
    SPOIL(2, AISLE_STATUS_MALFORMED, x0 = INT32_MAX);
    SPOIL(2, AISLE_STATUS_MALFORMED, width = 0);
    SPOIL(2, AISLE_STATUS_MALFORMED, height = -5);
    SPOIL(2, AISLE_STATUS_MALFORMED, width = INT32_MAX);
    SPOIL(2, AISLE_STATUS_MALFORMED, height = 48);
    SPOIL(2, AISLE_STATUS_MALFORMED, num_bytes -= 1);
    SPOIL(2, AISLE_STATUS_MALFORMED, num_bytes += 1);
    SPOIL(2, AISLE_STATUS_MALFORMED, num_bytes = -1);
    SPOIL(2, AISLE_STATUS_MALFORMED, num_bytes = 60001);
    SPOIL(2, AISLE_STATUS_MALFORMED, encoding = 2);
    SPOIL(2, AISLE_STATUS_MALFORMED, encoding = -1);
    SPOIL(3, AISLE_STATUS_MALFORMED, num_bytes -= 1);
    SPOIL(3, AISLE_STATUS_MALFORMED, width -= 1);
}

static void test_bad_tiles_are_refused_and_change_nothing(void) {
    (void)fix_send_part(&scene, 0);
    spoil_every_field(); // as the first tile, and when some are in
    for (int16_t i = 0; i < 2; i++) {
        TEST_ASSERT_EQUAL(AISLE_PARTIAL, fix_send_tile(&scene, i));
    }
    spoil_every_field();
    for (int16_t i = 2; i < 9; i++) {
        TEST_ASSERT_EQUAL(i == 8 ? AISLE_OK : AISLE_PARTIAL, fix_send_tile(&scene, i));
    }
    fix_enforce();
    expect_scan_of(&scene);
}

static void test_tiles_that_disagree_with_the_first_or_overlap_are_a_conflict(void) {
    (void)fix_send_part(&scene, 0);
    (void)fix_send_tile(&scene, 4);
    SPOIL(2, AISLE_STATUS_CONFLICT, origin_x += 0.001);
    SPOIL(2, AISLE_STATUS_CONFLICT, origin_y -= 0.001);
    SPOIL(2, AISLE_STATUS_CONFLICT, resolution = 0.1001F);
    SPOIL(4, AISLE_STATUS_CONFLICT, x0 -= 1);
    (void)fix_make_tile(&scene, 4);
    fix_tile.part = 5; // the same place under another number
    expect_spoiled(AISLE_STATUS_CONFLICT, "overlap");
    (void)fix_make_tile(&scene, 0);
    fix_tile.x0 = 1; // one column and row into tile 4's
    fix_tile.y0 = 1;
    expect_spoiled(AISLE_STATUS_CONFLICT, "overlap by a corner");
    fix_tile.x0 = 0;
    TEST_ASSERT_EQUAL(AISLE_PARTIAL, send(&fix_tile)); // beside it
}

static void test_layout_resolution_must_be_zero_or_the_scans(void) {
    scene.resolution = 0.05F;
    (void)fix_send_part(&scene, 0);
    fix_expect_refusal(fix_send_tile(&scene, 0), AISLE_STATUS_CONFLICT, 0);
    scene.resolution = 0.1F;
    scene.map_revision = 2;
    fix_load(&scene);
}

static void test_bounds_may_be_off_the_scans_extent_by_half_a_cell_at_most(void) {
    for (uint32_t i = 0; i < 4U; i++) {
        fix_start();
        const double off = i % 2U == 0U ? 0.049 : -0.049;
        fix_set_bounds(&scene, 1.0 + off, 2.0 - off, 1.0 + 6.1 - off, 2.0 + 4.7 + off);
        fix_load(&scene);
        expect_scan_of(&scene);
        const aisle_aabb area = aisle_layout_bounds(&fix_layout); // what both have in common
        TEST_ASSERT_DOUBLE_WITHIN(1e-12, fmax(1.0, 1.0 + off), area.lo.x);
        TEST_ASSERT_DOUBLE_WITHIN(1e-12, fmax(2.0, 2.0 - off), area.lo.y);
        TEST_ASSERT_DOUBLE_WITHIN(1e-12, fmin(7.1, 7.1 - off), area.hi.x);
        TEST_ASSERT_DOUBLE_WITHIN(1e-12, fmin(6.7, 6.7 + off), area.hi.y);
    }
    fix_start();
    fix_set_bounds(&scene, 1.0, 2.0, 1.0 + 6.151, 2.0 + 4.7); // one column more than the tiles say
    (void)fix_send_part(&scene, 0);
    TEST_ASSERT_EQUAL(AISLE_PARTIAL, fix_send_tile(&scene, 0)); // cannot be told from a scan one column wider
    fix_set_bounds(&scene, 0.949, 2.0, 1.0 + 6.1, 2.0 + 4.7);
    scene.map_revision = 2;
    (void)fix_send_part(&scene, 0);
    fix_expect_refusal(fix_send_tile(&scene, 0), AISLE_STATUS_CONFLICT, 0);
}

static void test_a_scan_of_too_many_cells_is_refused_with_the_number_needed(void) {
    fix_set_bounds(&scene, 1.0, 2.0, 1.0 + 30.0, 2.0 + 20.0);
    (void)fix_send_part(&scene, 0);
    fix_expect_refusal(fix_send_tile(&scene, 0), AISLE_STATUS_LIMIT, AISLE_LAYOUT_LIMIT_CELLS);
    TEST_ASSERT_EQUAL_FLOAT(60000.0F, fix_why.value);
}

// ---- run lengths

static aisle_status send_rle(const uint8_t *bytes, int32_t n, int32_t width, int32_t height) {
    fix_start();
    (void)fix_send_part(&scene, 0);
    (void)fix_make_tile(&scene, 1);
    fix_tile.x0 = 0;
    fix_tile.y0 = 0;
    fix_tile.width = width;
    fix_tile.height = height;
    memcpy(fix_tile.data, bytes, (size_t)n);
    fix_tile.num_bytes = n;
    return send(&fix_tile);
}

static void test_runs_must_sum_to_the_tile_and_be_as_short_as_they_can(void) {
    const uint8_t whole[] = {0xC8, 0x01};
    const uint8_t split[] = {0, 100, 100};
    const uint8_t zeros[] = {100, 0, 0, 0, 100};
    TEST_ASSERT_EQUAL(AISLE_PARTIAL, send_rle(whole, 2, 20, 10));
    TEST_ASSERT_EQUAL(AISLE_PARTIAL, send_rle(split, 3, 20, 10));
    TEST_ASSERT_EQUAL(AISLE_PARTIAL, send_rle(zeros, 5, 20, 10));
    const uint8_t overlong[] = {0xE4, 0x00, 100};
    const uint8_t cut_off[] = {100, 0xE4};
    const uint8_t too_many[] = {100, 101};
    const uint8_t too_few[] = {100, 99};
    const uint8_t long_leb[] = {0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0x01};
    const uint8_t over_32[] = {0xFF, 0xFF, 0xFF, 0xFF, 0x1F};
    const uint8_t wraps[] = {0xFF, 0xFF, 0xFF, 0xFF, 0x0F, 0xC9, 0x01}; // 2^32 - 1 + 201 = 200 mod 2^32
    fix_expect_refusal(send_rle(overlong, 3, 20, 10), AISLE_STATUS_MALFORMED, 1);
    fix_expect_refusal(send_rle(cut_off, 2, 20, 10), AISLE_STATUS_MALFORMED, 1);
    fix_expect_refusal(send_rle(too_many, 2, 20, 10), AISLE_STATUS_MALFORMED, 1);
    fix_expect_refusal(send_rle(too_few, 2, 20, 10), AISLE_STATUS_MALFORMED, 1);
    fix_expect_refusal(send_rle(long_leb, 6, 20, 10), AISLE_STATUS_MALFORMED, 1);
    fix_expect_refusal(send_rle(over_32, 5, 20, 10), AISLE_STATUS_MALFORMED, 1);
    const uint8_t wraps_alone[] = {0xC8, 0x81, 0x80, 0x80, 0x10}; // 2^32 + 200
    fix_expect_refusal(send_rle(wraps, 7, 20, 10), AISLE_STATUS_MALFORMED, 1);
    fix_expect_refusal(send_rle(wraps_alone, 5, 20, 10), AISLE_STATUS_MALFORMED, 1);
    fix_expect_refusal(send_rle(whole, 0, 20, 10), AISLE_STATUS_MALFORMED, 1);
}

static void test_random_bytes_never_break_anything(void) {
    aisle_rng rng = aisle_rng_seed(123);
    fix_start();
    (void)fix_send_part(&scene, 0);
    for (uint32_t trial = 0; trial < 3000U; trial++) {
        (void)fix_make_tile(&scene, (int16_t)(aisle_rng_below(&rng, 8)));
        for (int32_t i = 0; i < fix_tile.num_bytes; i++) {
            fix_tile.data[i] = (uint8_t)aisle_rng_below(&rng, 256);
        }
        fix_tile.x0 += (int32_t)aisle_rng_below(&rng, 5) - 2;
        fix_tile.width += (int32_t)aisle_rng_below(&rng, 5) - 2;
        fix_tile.num_bytes = (int32_t)aisle_rng_below(&rng, (uint32_t)fix_tile.num_bytes + 3U);
        const aisle_status status = send(&fix_tile);
        TEST_ASSERT_TRUE(status == AISLE_PARTIAL || (status == AISLE_ERR_DATA && fix_why.cause != 0));
    }
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_tiles_in_any_order_with_repeats_and_both_encodings_give_the_scan);
    RUN_TEST(test_parts_may_end_after_the_tiles);
    RUN_TEST(test_cells_no_tile_covers_are_occupied);
    RUN_TEST(test_a_tile_without_its_layout_is_refused);
    RUN_TEST(test_repeats_are_ok_when_complete_or_active_and_others_wait);
    RUN_TEST(test_bad_tiles_are_refused_and_change_nothing);
    RUN_TEST(test_tiles_that_disagree_with_the_first_or_overlap_are_a_conflict);
    RUN_TEST(test_layout_resolution_must_be_zero_or_the_scans);
    RUN_TEST(test_bounds_may_be_off_the_scans_extent_by_half_a_cell_at_most);
    RUN_TEST(test_a_scan_of_too_many_cells_is_refused_with_the_number_needed);
    RUN_TEST(test_runs_must_sum_to_the_tile_and_be_as_short_as_they_can);
    RUN_TEST(test_random_bytes_never_break_anything);
    return UNITY_END();
}
