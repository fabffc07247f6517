#include "layout_fixture.h"

static fix_scene scene;
static fix_scene other;

void setUp(void) {
    fix_start();
    aisle_rng rng = aisle_rng_seed(111);
    fix_random_scene(&scene, &rng, 37, 4);
    other = scene;
}
void tearDown(void) {}

static void expect_zones_of(const fix_scene *s) {
    TEST_ASSERT_EQUAL_UINT32(s->count, aisle_layout_zone_count(&fix_layout));
    for (uint32_t i = 0; i < s->count; i++) {
        TEST_ASSERT_TRUE(aisle_layout_store_is_same(&fix_layout.store[fix_layout.active],
                                                    aisle_layout_zone(&fix_layout, i), &s->polygons[i]));
    }
}

static aisle_status send(const aisle_layout_msg *msg) {
    return aisle_layout_take_part(&fix_layout, msg, &fix_why);
}

// ---- completing

static void test_nothing_is_held_at_first(void) {
    TEST_ASSERT_FALSE(aisle_layout_is_staged(&fix_layout));
    TEST_ASSERT_FALSE(aisle_layout_is_in_force(&fix_layout));
    TEST_ASSERT_EQUAL_INT32(0, aisle_layout_map_id(&fix_layout));
    TEST_ASSERT_EQUAL_INT32(0, aisle_layout_map_revision(&fix_layout));
    TEST_ASSERT_EQUAL(AISLE_ERR_ARG, aisle_layout_build(&fix_layout, 10));
}

static void test_parts_in_any_order_with_repeats_give_the_same_zones_in_part_order(void) {
    aisle_rng rng = aisle_rng_seed(112);
    for (uint32_t trial = 0; trial < 60U; trial++) {
        fix_start();
        uint32_t in = 0;
        while (in != 15U) {
            const uint32_t part = aisle_rng_below(&rng, 4);
            const aisle_status status = fix_send_part(&scene, (int16_t)part);
            in |= 1U << part;
            TEST_ASSERT_EQUAL(in == 15U ? AISLE_OK : AISLE_PARTIAL, status);
            TEST_ASSERT_EQUAL(in == 15U, aisle_layout_is_staged(&fix_layout));
            TEST_ASSERT_EQUAL_INT32(0, aisle_layout_map_revision(&fix_layout));
        }
        fix_enforce();
        TEST_ASSERT_EQUAL_INT32(7, aisle_layout_map_id(&fix_layout));
        TEST_ASSERT_EQUAL_INT32(1, aisle_layout_map_revision(&fix_layout));
        expect_zones_of(&scene);
    }
}

static void test_64_parts_some_empty_complete_a_layout(void) {
    scene.parts = 64;
    fix_load(&scene);
    expect_zones_of(&scene);
}

static void test_a_layout_without_polygons_is_one_empty_part(void) {
    scene.parts = 1;
    scene.count = 0;
    fix_load(&scene);
    TEST_ASSERT_EQUAL_UINT32(0, aisle_layout_zone_count(&fix_layout));
    TEST_ASSERT_EQUAL_DOUBLE(8.0, aisle_layout_bounds(&fix_layout).hi.y);
}

static void test_active_stays_untouched_until_commit(void) {
    fix_load(&scene);
    other.map_revision = 2;
    other.count = 20;
    for (int16_t i = 0; i < 4; i++) {
        (void)fix_send_part(&other, i);
        TEST_ASSERT_TRUE(aisle_layout_is_in_force(&fix_layout));
        expect_zones_of(&scene);
    }
    fix_enforce();
    expect_zones_of(&other);
    TEST_ASSERT_EQUAL_INT32(2, aisle_layout_map_revision(&fix_layout));
}

// ---- repeats, revisions, maps

static void test_repeats_of_what_is_staged_or_active_are_ok_and_change_nothing(void) {
    fix_send(&scene);
    TEST_ASSERT_EQUAL(AISLE_OK, fix_send_part(&scene, 2));
    TEST_ASSERT_TRUE(aisle_layout_is_staged(&fix_layout));
    fix_enforce();
    TEST_ASSERT_EQUAL(AISLE_OK, fix_send_part(&scene, 0));
    TEST_ASSERT_FALSE(aisle_layout_is_staged(&fix_layout));
    TEST_ASSERT_TRUE(aisle_layout_is_in_force(&fix_layout));
    scene.parts = 2; // cut otherwise: still the same content
    TEST_ASSERT_EQUAL(AISLE_OK, fix_send_part(&scene, 0));
}

static void test_older_revisions_are_outdated_whether_staged_or_active_is_newer(void) {
    scene.map_revision = 5;
    other.map_revision = 4;
    (void)fix_send_part(&scene, 0);
    fix_expect_refusal(fix_send_part(&other, 0), AISLE_STATUS_OUTDATED, 5);
    fix_load(&scene);
    fix_expect_refusal(fix_send_part(&other, 0), AISLE_STATUS_OUTDATED, 5);
    other.map_revision = 9;
    (void)fix_send_part(&other, 0);
    other.map_revision = 7;
    fix_expect_refusal(fix_send_part(&other, 0), AISLE_STATUS_OUTDATED, 9);
    TEST_ASSERT_EQUAL(AISLE_OK, fix_send_part(&scene, 0)); // the active one's repeats stay welcome
}

static void test_a_newer_revision_restarts_staging(void) {
    (void)fix_send_part(&scene, 0);
    (void)fix_send_part(&scene, 1);
    other.map_revision = 2;
    other.count = 21;
    for (int16_t i = 3; i >= 0; i--) {
        TEST_ASSERT_EQUAL(i == 0 ? AISLE_OK : AISLE_PARTIAL, fix_send_part(&other, i));
    }
    fix_enforce();
    expect_zones_of(&other);
}

static void test_another_map_may_have_any_revision_and_replaces_the_first(void) {
    scene.map_revision = 100;
    fix_load(&scene);
    other.map_id = 8;
    other.map_revision = -3;
    fix_load(&other);
    TEST_ASSERT_EQUAL_INT32(8, aisle_layout_map_id(&fix_layout));
    TEST_ASSERT_EQUAL_INT32(-3, aisle_layout_map_revision(&fix_layout));
}

static void test_a_complete_staged_layout_makes_others_wait(void) {
    fix_send(&scene);
    other.map_revision = 2;
    TEST_ASSERT_EQUAL(AISLE_BUSY, fix_send_part(&other, 0));
    TEST_ASSERT_EQUAL_INT16(0, fix_why.cause);
    other.map_id = 99;
    TEST_ASSERT_EQUAL(AISLE_BUSY, fix_send_part(&other, 0));
    other.map_id = 7;
    other.map_revision = 0;
    fix_expect_refusal(fix_send_part(&other, 0), AISLE_STATUS_OUTDATED, 1);
    fix_enforce();
    expect_zones_of(&scene);
}

static void test_the_same_revision_with_other_content_is_a_conflict(void) {
    for (uint32_t held = 0; held < 3U; held++) { // being staged, complete, active
        fix_start();
        if (held == 0U) {
            (void)fix_send_part(&scene, 0);
        } else {
            fix_send(&scene);
        }
        if (held == 2U) {
            fix_enforce();
        }
        for (uint32_t what = 0; what < 7U; what++) {
            aisle_layout_msg *msg = &fix_part;
            (void)fix_make_part(&scene, 1);
            msg->crc32 += what == 0U ? 1 : 0;
            msg->total_polygons += what == 1U ? 1 : 0;
            msg->num_grid_chunks = (int16_t)(what == 2U ? 1 : 0);
            msg->x_min -= what == 3U ? 1e-9 : 0.0;
            msg->y_max += what == 4U ? 1.0 : 0.0;
            msg->resolution = what == 5U ? 0.1F : 0.0F;
            msg->num_parts = (int16_t)(what == 6U && held == 0U ? 5 : 4);
            if (what < 6U || held == 0U) {
                fix_expect_refusal(send(msg), AISLE_STATUS_CONFLICT, 0);
            }
        }
    }
}

static void test_a_part_that_came_before_with_other_polygons_is_a_conflict(void) {
    (void)fix_send_part(&scene, 1);
    (void)fix_make_part(&scene, 1);
    fix_part.polygons[2].vertices[0][0] += 1e-9;
    fix_expect_refusal(send(&fix_part), AISLE_STATUS_CONFLICT, 0);
    (void)fix_make_part(&scene, 1);
    fix_part.num_polygons--;
    fix_expect_refusal(send(&fix_part), AISLE_STATUS_CONFLICT, 0);
    fix_send_part(&scene, 0);
    fix_send_part(&scene, 2);
    TEST_ASSERT_EQUAL(AISLE_OK, fix_send_part(&scene, 3));
}

// ---- malformed

typedef void (*spoil_fn)(aisle_layout_msg *msg);
static void spoil_part_low(aisle_layout_msg *m) {
    m->part = -1;
}
static void spoil_part_high(aisle_layout_msg *m) {
    m->part = 4;
}
static void spoil_parts_low(aisle_layout_msg *m) {
    m->num_parts = 0;
}
static void spoil_parts_high(aisle_layout_msg *m) {
    m->num_parts = 65;
}
static void spoil_polygons_low(aisle_layout_msg *m) {
    m->num_polygons = -1;
}
static void spoil_polygons_high(aisle_layout_msg *m) {
    m->num_polygons = 829;
}
static void spoil_total_low(aisle_layout_msg *m) {
    m->total_polygons = m->num_polygons - 1;
}
static void spoil_tiles(aisle_layout_msg *m) {
    m->num_grid_chunks = -1;
}
static void spoil_bounds_nan(aisle_layout_msg *m) {
    m->y_min = (double)NAN;
}
static void spoil_bounds_infinite(aisle_layout_msg *m) {
    m->x_max = (double)INFINITY;
}
static void spoil_bounds_far(aisle_layout_msg *m) {
    m->y_max = 1.1e5;
}
static void spoil_bounds_far_low(aisle_layout_msg *m) {
    m->x_min = -1.1e5;
}
static void spoil_bounds_empty(aisle_layout_msg *m) {
    m->x_max = m->x_min;
}
static void spoil_bounds_turned(aisle_layout_msg *m) {
    m->y_max = m->y_min - 1.0;
}
static void spoil_resolution_fine(aisle_layout_msg *m) {
    m->resolution = 0.0049F;
}
static void spoil_resolution_coarse(aisle_layout_msg *m) {
    m->resolution = 1.01F;
}
static void spoil_resolution_negative(aisle_layout_msg *m) {
    m->resolution = -0.05F;
}
static void spoil_resolution_nan(aisle_layout_msg *m) {
    m->resolution = NAN;
}

static void test_malformed_headers_are_refused_and_change_nothing(void) {
    static const spoil_fn spoils[] = {spoil_part_low,
                                      spoil_part_high,
                                      spoil_parts_low,
                                      spoil_parts_high,
                                      spoil_polygons_low,
                                      spoil_polygons_high,
                                      spoil_total_low,
                                      spoil_tiles,
                                      spoil_bounds_nan,
                                      spoil_bounds_infinite,
                                      spoil_bounds_far,
                                      spoil_bounds_far_low,
                                      spoil_bounds_empty,
                                      spoil_bounds_turned,
                                      spoil_resolution_fine,
                                      spoil_resolution_coarse,
                                      spoil_resolution_negative,
                                      spoil_resolution_nan};
    for (uint32_t i = 0; i < sizeof spoils / sizeof *spoils; i++) {
        fix_start();
        (void)fix_send_part(&scene, 0);
        (void)fix_make_part(&scene, 1);
        fix_part.map_revision = 2;
        spoils[i](&fix_part);
        fix_expect_refusal(send(&fix_part), AISLE_STATUS_MALFORMED, 0);
        for (int16_t k = 1; k < 4; k++) { // what was being staged goes on
            TEST_ASSERT_EQUAL(k == 3 ? AISLE_OK : AISLE_PARTIAL, fix_send_part(&scene, k));
        }
    }
}

static void test_resolutions_at_the_ends_are_taken_as_meant(void) {
    static const float wire[] = {0.005F, 0.05F, 0.1F, 0.3F, 1.0F};
    static const double meant[] = {0.005, 0.05, 0.1, 0.3, 1.0};
    for (uint32_t i = 0; i < 5U; i++) {
        fix_start();
        scene.parts = 1;
        scene.resolution = wire[i];
        fix_set_bounds(&scene, 0, 0, 200 * meant[i], 100 * meant[i]);
        fix_load(&scene);
        const aisle_lattice *l = &aisle_layout_grid(&fix_layout)->lattice;
        TEST_ASSERT_DOUBLE_WITHIN(1e-15, meant[i], l->res);
        TEST_ASSERT_EQUAL_UINT32(200, l->w);
        TEST_ASSERT_EQUAL_UINT32(100, l->h);
    }
}

static void test_a_bad_polygon_is_refused_by_its_id_and_changes_nothing(void) {
    (void)fix_send_part(&scene, 0);
    for (uint32_t k = 0; k < 9U; k++) {
        (void)fix_make_part(&scene, 1);
        fix_part.map_revision = k % 2U == 0U ? 1 : 2; // also when it would restart staging
        fix_part.polygons[k].vertices[1][0] = 1e9;
        fix_expect_refusal(send(&fix_part), AISLE_STATUS_MALFORMED, scene.polygons[fix_cut(37, 4, 1) + k].id);
    }
    for (int16_t k = 1; k < 4; k++) {
        TEST_ASSERT_EQUAL(k == 3 ? AISLE_OK : AISLE_PARTIAL, fix_send_part(&scene, k));
    }
}

static void test_an_id_twice_is_refused_within_a_part_and_across_parts(void) {
    (void)fix_make_part(&scene, 0);
    fix_part.polygons[5].id = fix_part.polygons[1].id;
    fix_expect_refusal(send(&fix_part), AISLE_STATUS_MALFORMED, scene.polygons[1].id);
    TEST_ASSERT_EQUAL(AISLE_PARTIAL, fix_send_part(&scene, 0));
    (void)fix_make_part(&scene, 2);
    fix_part.polygons[3].id = scene.polygons[4].id;
    fix_expect_refusal(send(&fix_part), AISLE_STATUS_MALFORMED, scene.polygons[4].id);
    TEST_ASSERT_EQUAL(AISLE_PARTIAL, fix_send_part(&scene, 2));
}

static void test_a_wrong_checksum_drops_the_staging_and_leaves_active(void) {
    fix_load(&scene);
    other.map_revision = 2;
    for (int16_t i = 0; i < 4; i++) {
        (void)fix_make_part(&other, i);
        fix_part.crc32 ^= 1;
        const aisle_status status = send(&fix_part);
        if (i < 3) {
            TEST_ASSERT_EQUAL(AISLE_PARTIAL, status);
        } else {
            fix_expect_refusal(status, AISLE_STATUS_MALFORMED, 0);
        }
    }
    TEST_ASSERT_FALSE(aisle_layout_is_staged(&fix_layout));
    TEST_ASSERT_TRUE(aisle_layout_is_in_force(&fix_layout));
    expect_zones_of(&scene);
    fix_load(&other); // and the right one may follow
}

static void test_a_wrong_number_of_polygons_is_refused(void) {
    scene.parts = 2;
    for (int16_t i = 0; i < 2; i++) { // one fewer than said
        (void)fix_make_part(&scene, i);
        fix_part.total_polygons = 38;
        const aisle_status status = send(&fix_part);
        TEST_ASSERT_EQUAL(i == 0 ? AISLE_PARTIAL : AISLE_ERR_DATA, status);
    }
    TEST_ASSERT_EQUAL_INT16(AISLE_STATUS_MALFORMED, fix_why.cause);
    TEST_ASSERT_EQUAL_FLOAT(37.0F, fix_why.value);
    for (int16_t i = 0; i < 2; i++) { // one more
        (void)fix_make_part(&scene, i);
        fix_part.total_polygons = 36;
        const aisle_status status = send(&fix_part);
        TEST_ASSERT_EQUAL(i == 0 ? AISLE_PARTIAL : AISLE_ERR_DATA, status);
    }
    TEST_ASSERT_EQUAL_FLOAT(37.0F, fix_why.value);
}

// ---- limits

static void expect_limit(aisle_status status, int32_t id, float needed) {
    fix_expect_refusal(status, AISLE_STATUS_LIMIT, id);
    TEST_ASSERT_EQUAL_FLOAT(needed, fix_why.value);
}

static void test_limits_are_named_with_the_number_needed(void) {
    (void)fix_make_part(&scene, 0);
    fix_part.total_polygons = FIX_POLYGONS + 1;
    expect_limit(send(&fix_part), AISLE_LAYOUT_LIMIT_POLYGONS, FIX_POLYGONS + 1.0F);
    (void)fix_make_part(&scene, 0);
    fix_part.num_grid_chunks = 4097;
    expect_limit(send(&fix_part), AISLE_LAYOUT_LIMIT_TILES, 4097.0F);
    (void)fix_make_part(&scene, 0);
    fix_part.resolution = 0.01F;
    expect_limit(send(&fix_part), AISLE_LAYOUT_LIMIT_CELLS, 800000.0F);
    (void)fix_make_part(&scene, 0);
    fix_part.resolution = 0.005F;
    fix_part.y_max = 0.001;
    fix_part.x_max = 350.0;
    expect_limit(send(&fix_part), AISLE_LAYOUT_LIMIT_CELLS, 70000.0F); // both are exceeded: cells first
    fix_start_with((aisle_limits){.cells = 1U << 17U, .polygons = FIX_POLYGONS, .vertices = FIX_VERTICES});
    expect_limit(send(&fix_part), AISLE_LAYOUT_LIMIT_SIDE, 70000.0F);
}

static void test_too_many_vertices_are_refused_in_the_part_that_exceeds_them(void) {
    fix_start_with((aisle_limits){.cells = FIX_CELLS, .polygons = FIX_POLYGONS, .vertices = 60});
    scene.count = 20;
    scene.parts = 2;
    for (uint32_t i = 0; i < 20U; i++) {
        fix_set_polygon(&scene.polygons[i], (int32_t)i + 1, AISLE_POLYGON_OBSTACLE,
                        (const aisle_vec2[4]){{0, 0}, {1, 0}, {1, 1}, {0, 1}}, 4);
    }
    TEST_ASSERT_EQUAL(AISLE_PARTIAL, fix_send_part(&scene, 0));
    expect_limit(fix_send_part(&scene, 1), AISLE_LAYOUT_LIMIT_VERTICES, 80.0F);
    scene.map_revision = 2;
    scene.parts = 1;
    scene.count = 15; // exactly full
    TEST_ASSERT_EQUAL(AISLE_OK, fix_send_part(&scene, 0));
}

static void test_resolution_zero_is_the_default_doubled_until_the_grid_fits(void) {
    static const double sides[] = {1.0, 10.0, 10.1, 20.0, 1000.0, 2e5};
    for (uint32_t i = 0; i < 6U; i++) {
        fix_start();
        scene.parts = 1;
        scene.count = 0;
        fix_set_bounds(&scene, -0.5 * sides[i], -0.5 * sides[i], 0.5 * sides[i], 0.5 * sides[i]);
        fix_load(&scene);
        const aisle_lattice *l = &aisle_layout_grid(&fix_layout)->lattice;
        double want = 0.05;
        while (ceil(sides[i] / want - 1e-6) * ceil(sides[i] / want - 1e-6) > FIX_CELLS) {
            want *= 2.0;
        }
        TEST_ASSERT_DOUBLE_WITHIN(1e-12, want, l->res);
    }
}

static void test_zeros_in_limits_are_the_defaults(void) {
    aisle_arena zero = aisle_arena_measure();
    aisle_arena named = aisle_arena_measure();
    aisle_layout layout;
    aisle_layout_carve(&layout, &zero, &(aisle_limits){0});
    aisle_layout_carve(&layout, &named,
                       &(aisle_limits){.cells = AISLE_LIMITS_CELLS_DEFAULT,
                                       .polygons = AISLE_LIMITS_POLYGONS_DEFAULT,
                                       .vertices = AISLE_LIMITS_VERTICES_DEFAULT});
    TEST_ASSERT_EQUAL_UINT64(named.used, zero.used);
    TEST_ASSERT_TRUE(zero.used < 12U << 20U); // as the header says
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_nothing_is_held_at_first);
    RUN_TEST(test_parts_in_any_order_with_repeats_give_the_same_zones_in_part_order);
    RUN_TEST(test_64_parts_some_empty_complete_a_layout);
    RUN_TEST(test_a_layout_without_polygons_is_one_empty_part);
    RUN_TEST(test_active_stays_untouched_until_commit);
    RUN_TEST(test_repeats_of_what_is_staged_or_active_are_ok_and_change_nothing);
    RUN_TEST(test_older_revisions_are_outdated_whether_staged_or_active_is_newer);
    RUN_TEST(test_a_newer_revision_restarts_staging);
    RUN_TEST(test_another_map_may_have_any_revision_and_replaces_the_first);
    RUN_TEST(test_a_complete_staged_layout_makes_others_wait);
    RUN_TEST(test_the_same_revision_with_other_content_is_a_conflict);
    RUN_TEST(test_a_part_that_came_before_with_other_polygons_is_a_conflict);
    RUN_TEST(test_malformed_headers_are_refused_and_change_nothing);
    RUN_TEST(test_resolutions_at_the_ends_are_taken_as_meant);
    RUN_TEST(test_a_bad_polygon_is_refused_by_its_id_and_changes_nothing);
    RUN_TEST(test_an_id_twice_is_refused_within_a_part_and_across_parts);
    RUN_TEST(test_a_wrong_checksum_drops_the_staging_and_leaves_active);
    RUN_TEST(test_a_wrong_number_of_polygons_is_refused);
    RUN_TEST(test_limits_are_named_with_the_number_needed);
    RUN_TEST(test_too_many_vertices_are_refused_in_the_part_that_exceeds_them);
    RUN_TEST(test_resolution_zero_is_the_default_doubled_until_the_grid_fits);
    RUN_TEST(test_zeros_in_limits_are_the_defaults);
    return UNITY_END();
}
