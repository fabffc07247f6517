#include "layout_fixture.h"

static fix_scene scene;
static fix_scene want; // what the patch should make of it
static aisle_layout_patch_msg patch;

static aisle_status send(void) {
    return aisle_layout_take_patch(&fix_layout, &patch, &fix_why);
}

static void new_patch(void) {
    memset(&patch, 0, sizeof patch);
    patch.map_id = 7;
    patch.base_revision = 1;
    patch.map_revision = 2;
}

void setUp(void) {
    fix_start();
    aisle_rng rng = aisle_rng_seed(131);
    fix_random_scene(&scene, &rng, 30, 2);
    want = scene;
    want.map_revision = 2;
    new_patch();
}
void tearDown(void) {}

static void put(const aisle_polygon_msg *polygon) {
    patch.polygons[patch.num_polygons] = *polygon;
    patch.num_polygons++;
}

static void put_box(int32_t id, double x) {
    aisle_vec2 v[4];
    gen_box(aisle_vec2_of(x, 1), aisle_vec2_of(x + 1.0, 2), v);
    aisle_polygon_msg polygon;
    fix_set_polygon(&polygon, id, AISLE_POLYGON_OBSTACLE, v, 4);
    put(&polygon);
}

static void remove_id(int32_t id) {
    patch.removed[patch.num_removed] = id;
    patch.num_removed++;
}

static void drop_wanted(uint32_t i) {
    memmove(&want.polygons[i], &want.polygons[i + 1U], (want.count - i - 1U) * sizeof want.polygons[0]);
    want.count--;
}

static void expect_wanted(void) {
    TEST_ASSERT_EQUAL_UINT32(want.count, aisle_layout_zone_count(&fix_layout));
    for (uint32_t i = 0; i < want.count; i++) {
        TEST_ASSERT_TRUE(aisle_layout_store_is_same(&fix_layout.store[fix_layout.active],
                                                    aisle_layout_zone(&fix_layout, i), &want.polygons[i]));
    }
}

static void test_a_patch_removes_changes_and_appends_in_order(void) {
    fix_load(&scene);
    remove_id(scene.polygons[3].id);
    remove_id(scene.polygons[11].id); // and put again: comes last
    put_box(scene.polygons[20].id, 2.0);
    put_box(scene.polygons[11].id, 4.0);
    put_box(999999, 6.0);
    TEST_ASSERT_EQUAL(AISLE_OK, send());
    TEST_ASSERT_TRUE(aisle_layout_is_staged(&fix_layout));
    TEST_ASSERT_EQUAL_INT32(1, aisle_layout_map_revision(&fix_layout));
    fix_enforce();
    want.polygons[20] = patch.polygons[0];
    drop_wanted(11);
    drop_wanted(3);
    want.polygons[want.count++] = patch.polygons[1];
    want.polygons[want.count++] = patch.polygons[2];
    expect_wanted();
    TEST_ASSERT_EQUAL_INT32(2, aisle_layout_map_revision(&fix_layout));
    for (int16_t i = 0; i < want.parts; i++) { // the full layout of that revision is a repeat
        TEST_ASSERT_EQUAL(AISLE_OK, fix_send_part(&want, i));
        TEST_ASSERT_FALSE(aisle_layout_is_staged(&fix_layout));
    }
}

static void expect_change(uint32_t i, const aisle_polygon_msg *polygon, bool is_added) {
    const aisle_layout_change *change = &aisle_layout_changes(&fix_layout)->change[i];
    aisle_vec2 v[16];
    const aisle_convex shape = fix_shape(polygon, v);
    const aisle_aabb box = aisle_convex_aabb(&shape);
    TEST_ASSERT_EQUAL_INT32(polygon->id, change->id);
    TEST_ASSERT_EQUAL_INT8(polygon->kind, change->kind);
    TEST_ASSERT_EQUAL(is_added, change->is_added);
    TEST_ASSERT_EQUAL_MEMORY(&box, &change->box, sizeof box);
}

static void test_changes_list_what_left_and_what_came(void) {
    TEST_ASSERT_TRUE(aisle_layout_changes(&fix_layout)->everything);
    fix_load(&scene);
    TEST_ASSERT_TRUE(aisle_layout_changes(&fix_layout)->everything);
    remove_id(scene.polygons[3].id);
    remove_id(scene.polygons[11].id); // put again as it was: not listed, though it comes last now
    remove_id(scene.polygons[12].id); // put again elsewhere
    put_box(scene.polygons[12].id, 2.0);
    put(&scene.polygons[11]);
    put(&scene.polygons[20]); // as it is
    patch.polygons[3] = scene.polygons[21];
    patch.polygons[3].direction = 0.5F; // says something else
    patch.num_polygons = 4;
    put_box(999999, 6.0);
    TEST_ASSERT_EQUAL(AISLE_OK, send());
    fix_enforce();
    const aisle_layout_diff *diff = aisle_layout_changes(&fix_layout);
    TEST_ASSERT_FALSE(diff->everything);
    TEST_ASSERT_EQUAL_UINT32(6, diff->count);
    expect_change(0, &scene.polygons[3], false);
    expect_change(1, &scene.polygons[12], false);
    expect_change(2, &scene.polygons[21], false);
    expect_change(3, &patch.polygons[3], true);
    expect_change(4, &patch.polygons[0], true);
    expect_change(5, &patch.polygons[4], true);
    TEST_ASSERT_EQUAL(AISLE_OK, send()); // a repeat, and what is refused, change nothing
    patch.map_revision = 9;
    fix_expect_refusal(send(), AISLE_STATUS_REVISION_GAP, 2);
    TEST_ASSERT_EQUAL_UINT32(6, diff->count);
    want.map_revision = 3;
    want.map_id = 7;
    (void)fix_send_part(&want, 0); // begun only
    TEST_ASSERT_FALSE(diff->everything);
    (void)fix_send_part(&want, 1);
    fix_enforce();
    TEST_ASSERT_TRUE(diff->everything);
    TEST_ASSERT_EQUAL_UINT32(0, diff->count);
}

static void test_a_patch_on_an_unfinished_layout_changes_everything(void) {
    fix_send(&scene);
    aisle_layout_commit(&fix_layout);
    put_box(1, 1.0);
    TEST_ASSERT_EQUAL(AISLE_OK, send());
    fix_enforce();
    TEST_ASSERT_TRUE(aisle_layout_changes(&fix_layout)->everything);
}

static void test_random_patches_one_after_another_keep_to_the_model(void) {
    aisle_rng rng = aisle_rng_seed(132);
    fix_load(&scene);
    for (int32_t revision = 1; revision < 60; revision++) {
        new_patch();
        patch.base_revision = revision;
        patch.map_revision = revision + 1;
        for (uint32_t i = want.count; i-- > 0U;) {
            const uint32_t dice = aisle_rng_below(&rng, 12);
            if (dice == 0U) {
                remove_id(want.polygons[i].id);
                drop_wanted(i);
            } else if (dice == 1U) {
                put_box(want.polygons[i].id, gen_in(&rng, 0, 8));
                want.polygons[i] = patch.polygons[patch.num_polygons - 1];
            }
        }
        for (uint32_t k = aisle_rng_below(&rng, 6); k > 0U; k--) {
            put_box(500000 + revision * 10 + (int32_t)k, gen_in(&rng, 0, 8));
            want.polygons[want.count++] = patch.polygons[patch.num_polygons - 1];
        }
        TEST_ASSERT_EQUAL(AISLE_OK, send());
        fix_enforce();
        expect_wanted();
        TEST_ASSERT_EQUAL(AISLE_OK, send()); // once more: a repeat
        TEST_ASSERT_FALSE(aisle_layout_is_staged(&fix_layout));
    }
}

static void test_a_patch_keeps_the_scan(void) {
    aisle_rng rng = aisle_rng_seed(133);
    fix_random_scan(&scene, &rng, 61, 47, 3, 2);
    fix_load(&scene);
    put_box(999999, 6.0);
    TEST_ASSERT_EQUAL(AISLE_OK, send());
    fix_enforce();
    for (uint32_t i = 0; i < scene.w * scene.h; i++) {
        uint32_t ix = i % scene.w;
        uint32_t end;
        TEST_ASSERT_EQUAL(scene.occupied[i], aisle_layout_scan_run(&fix_layout, i / scene.w, &ix, ix + 1U, &end));
    }
    scene.map_revision = 2;
    TEST_ASSERT_EQUAL(AISLE_OK, fix_send_tile(&scene, 1)); // a repeat too
}

static void test_patches_on_nothing_another_map_or_another_base_are_refused(void) {
    fix_expect_refusal(send(), AISLE_STATUS_NO_LAYOUT, 0);
    fix_load(&scene);
    patch.map_id = 8;
    fix_expect_refusal(send(), AISLE_STATUS_MAP_MISMATCH, 7);
    patch.map_id = 7;
    patch.base_revision = 2;
    patch.map_revision = 3;
    fix_expect_refusal(send(), AISLE_STATUS_REVISION_GAP, 1);
    patch.base_revision = 0;
    patch.map_revision = 2;
    fix_expect_refusal(send(), AISLE_STATUS_REVISION_GAP, 1);
    patch.base_revision = -1;
    patch.map_revision = 0;
    fix_expect_refusal(send(), AISLE_STATUS_OUTDATED, 1);
    patch.base_revision = 1;
    patch.map_revision = 1;
    fix_expect_refusal(send(), AISLE_STATUS_MALFORMED, 0);
}

static void test_bad_edits_are_refused_by_id_and_change_nothing(void) {
    fix_load(&scene);
    remove_id(4711);
    fix_expect_refusal(send(), AISLE_STATUS_CONFLICT, 4711);
    new_patch();
    remove_id(scene.polygons[1].id);
    remove_id(scene.polygons[1].id);
    fix_expect_refusal(send(), AISLE_STATUS_CONFLICT, scene.polygons[1].id);
    new_patch();
    remove_id(-1);
    fix_expect_refusal(send(), AISLE_STATUS_CONFLICT, -1);
    new_patch();
    put_box(5, 1.0);
    put_box(5, 2.0);
    fix_expect_refusal(send(), AISLE_STATUS_MALFORMED, 5);
    new_patch();
    put_box(5, 1e6);
    fix_expect_refusal(send(), AISLE_STATUS_MALFORMED, 5);
    new_patch();
    patch.num_removed = 257;
    fix_expect_refusal(send(), AISLE_STATUS_MALFORMED, 0);
    patch.num_removed = 0;
    patch.num_polygons = -1;
    fix_expect_refusal(send(), AISLE_STATUS_MALFORMED, 0);
    TEST_ASSERT_FALSE(aisle_layout_is_staged(&fix_layout));
    want.map_revision = 1;
    expect_wanted();
}

static void test_patches_over_the_limits_are_refused_with_the_number_needed(void) {
    fix_start_with((aisle_limits){.cells = FIX_CELLS, .polygons = 31, .vertices = FIX_VERTICES});
    fix_load(&scene);
    put_box(1, 1.0);
    put_box(2, 2.0);
    fix_expect_refusal(send(), AISLE_STATUS_LIMIT, AISLE_LAYOUT_LIMIT_POLYGONS);
    TEST_ASSERT_EQUAL_FLOAT(32.0F, fix_why.value);
    remove_id(scene.polygons[0].id);
    TEST_ASSERT_EQUAL(AISLE_OK, send());
    uint32_t vertices = 4;
    for (uint32_t i = 0; i < 30U; i++) {
        const uint32_t n = (uint32_t)scene.polygons[i].num_vertices;
        vertices += n;
    }
    fix_start_with((aisle_limits){.cells = FIX_CELLS, .polygons = 60, .vertices = vertices - 1U});
    fix_load(&scene);
    new_patch();
    put_box(1, 1.0);
    fix_expect_refusal(send(), AISLE_STATUS_LIMIT, AISLE_LAYOUT_LIMIT_VERTICES);
    TEST_ASSERT_EQUAL_FLOAT((float)vertices, fix_why.value);
}

static void test_another_patch_to_the_active_revision_is_a_conflict(void) {
    fix_load(&scene);
    put_box(1, 1.0);
    remove_id(scene.polygons[0].id);
    TEST_ASSERT_EQUAL(AISLE_OK, send());
    fix_enforce();
    patch.polygons[0].vertices[0][0] += 0.01;
    fix_expect_refusal(send(), AISLE_STATUS_CONFLICT, 0);
    patch.polygons[0].vertices[0][0] -= 0.01;
    patch.removed[0] = scene.polygons[1].id;
    fix_expect_refusal(send(), AISLE_STATUS_CONFLICT, 0);
    patch.num_removed = 0;
    put_box(2, 1.0);
    fix_expect_refusal(send(), AISLE_STATUS_CONFLICT, 0);
}

static void test_a_patch_waits_for_commit_and_gives_way_to_newer_layouts_only(void) {
    fix_load(&scene);
    want.map_revision = 5;
    (void)fix_send_part(&want, 0);
    put_box(1, 1.0);
    fix_expect_refusal(send(), AISLE_STATUS_OUTDATED, 5);
    TEST_ASSERT_EQUAL(AISLE_OK, fix_send_part(&want, 1)); // undisturbed
    TEST_ASSERT_EQUAL(AISLE_BUSY, send());
    fix_start();
    fix_load(&scene);
    want.map_revision = 2;
    (void)fix_send_part(&want, 0);
    TEST_ASSERT_EQUAL(AISLE_OK, send()); // takes the place of the unfinished layout of that revision
    TEST_ASSERT_TRUE(aisle_layout_is_staged(&fix_layout));
    TEST_ASSERT_EQUAL(AISLE_BUSY, (patch.map_revision = 3, send()));
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_a_patch_removes_changes_and_appends_in_order);
    RUN_TEST(test_changes_list_what_left_and_what_came);
    RUN_TEST(test_a_patch_on_an_unfinished_layout_changes_everything);
    RUN_TEST(test_random_patches_one_after_another_keep_to_the_model);
    RUN_TEST(test_a_patch_keeps_the_scan);
    RUN_TEST(test_patches_on_nothing_another_map_or_another_base_are_refused);
    RUN_TEST(test_bad_edits_are_refused_by_id_and_change_nothing);
    RUN_TEST(test_patches_over_the_limits_are_refused_with_the_number_needed);
    RUN_TEST(test_another_patch_to_the_active_revision_is_a_conflict);
    RUN_TEST(test_a_patch_waits_for_commit_and_gives_way_to_newer_layouts_only);
    return UNITY_END();
}
