// Roadmaps repaired against roadmaps built anew on the layout as it is now; layouts that come back, other bodies and seeds.
#include "plan/roadmap_keep.h" // first: proves that the header stands alone

#include "hall.h"

enum { DRAWS = 300, HALLS = 4, PATCHES = 6, BOXES = 10 };

static aisle_space space;
static aisle_vehicle_space configurations;
static aisle_roadmap_keep kept, other;
static aisle_layout_patch_msg patch;
static aisle_roadmap_wish wish;

// 14 x 9 m with boxes 1 to BOXES drawn at random.
static hall_box draw_box(aisle_rng *rng) {
    const aisle_vec2 p = uniform_point(rng, aisle_vec2_of(0.5, 0.5), aisle_vec2_of(12.0, 7.5));
    const double w = uniform(rng, 0.3, 1.5), h = uniform(rng, 0.3, 1.5);
    return (hall_box){p.x, p.y, p.x + w, p.y + h};
}

static void begin_spaces(void) {
    aisle_space_begin(&space, &hall_layout, &hall_vehicle, AISLE_SPACE_FREE_TURN);
    aisle_vehicle_space_begin(&configurations, &space,
                              aisle_vehicle_is_disc(&hall_vehicle) ? AISLE_VEHICLE_SPACE_PLACE
                                                                   : AISLE_VEHICLE_SPACE_POSE);
    wish = (aisle_roadmap_wish){
        .layout = &hall_layout,
        .configurations = &configurations,
        .config = {.samples = DRAWS, .seed = 3, .eager = true, .one_way = !aisle_vehicle_is_disc(&hall_vehicle)}};
}

static void open_hall(void) {
    aisle_arena arena = hall_arena(24U << 20);
    memset(&kept, 0, sizeof kept);
    memset(&other, 0, sizeof other);
    aisle_roadmap_keep_carve(&kept, &arena, DRAWS);
    aisle_roadmap_keep_carve(&other, &arena, DRAWS);
    aisle_space_carve(&space, &arena, hall_limits.cells);
    hall_open(&arena, 0.05F);
    TEST_ASSERT_FALSE(arena.overflow);
    aisle_roadmap_keep_note(&kept, &hall_layout);
    aisle_roadmap_keep_note(&other, &hall_layout);
    begin_spaces();
}

static void random_hall(aisle_rng *rng) {
    hall_begin(14.0, 9.0);
    for (int i = 0; i < BOXES; i++) {
        const hall_box b = draw_box(rng);
        hall_add(b.x0, b.y0, b.x1, b.y1);
    }
    open_hall();
}

static aisle_status build_in(aisle_roadmap_keep *self, uint32_t slice) {
    uint32_t spent = 0;
    aisle_status st = AISLE_BUSY;
    while ((st = aisle_roadmap_keep_step(self, &configurations, slice, &spent)) == AISLE_BUSY) {
        TEST_ASSERT_LESS_THAN_UINT32(100000000U, spent);
    }
    return st;
}

static void ask(aisle_roadmap_keep *self) {
    aisle_roadmap_keep_begin(self, &wish);
    TEST_ASSERT_EQUAL(AISLE_OK, build_in(self, 1000));
    TEST_ASSERT_TRUE(aisle_roadmap_invariants_hold(&self->map));
}

// ---- patches

static void begin_patch(void) {
    memset(&patch, 0, sizeof patch);
    patch.map_id = 1;
    patch.base_revision = aisle_layout_map_revision(&hall_layout);
    patch.map_revision = patch.base_revision + 1;
}

static aisle_polygon_msg *put_box(int32_t id, hall_box b) {
    const double v[4][2] = {{b.x0, b.y0}, {b.x1, b.y0}, {b.x1, b.y1}, {b.x0, b.y1}};
    aisle_polygon_msg *polygon = &patch.polygons[patch.num_polygons++];
    polygon->id = id;
    polygon->num_vertices = 4;
    memcpy(polygon->vertices, v, sizeof v);
    return polygon;
}

static void commit(void) {
    aisle_layout_commit(&hall_layout);
    while (aisle_layout_build(&hall_layout, 100000) == AISLE_BUSY) {
    }
    aisle_roadmap_keep_note(&kept, &hall_layout);
    aisle_roadmap_keep_note(&other, &hall_layout);
    begin_spaces();
}

static void send_patch(void) {
    aisle_refusal why;
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_layout_take_patch(&hall_layout, &patch, &why));
    commit();
}

// A box of the hall goes, comes or moves.
static void random_patch(aisle_rng *rng, bool *is_there) {
    const int i = (int)uniform(rng, 0.0, (double)BOXES - 1e-9);
    begin_patch();
    if (is_there[i] && aisle_rng_float(rng) < 0.5F) {
        patch.removed[patch.num_removed++] = i + 1;
        is_there[i] = false;
    } else {
        (void)put_box(i + 1, draw_box(rng));
        is_there[i] = true;
    }
    send_patch();
}

// ---- repairs

static void assert_same_map(const aisle_roadmap *a, const aisle_roadmap *b) {
    TEST_ASSERT_EQUAL_UINT32(b->count, a->count);
    TEST_ASSERT_EQUAL_MEMORY(b->kind, a->kind, a->count);
    TEST_ASSERT_EQUAL_MEMORY(b->degree, a->degree, a->count);
    for (uint32_t i = 0; i < a->count; i++) {
        const size_t row = (size_t)i * a->k;
        TEST_ASSERT_EQUAL_INT(0, memcmp(b->list + row, a->list + row, a->degree[i] * sizeof a->list[0]));
        TEST_ASSERT_EQUAL_INT(0, memcmp(b->known + row, a->known + row, a->degree[i]));
    }
}

// The share of motions that repairs tested again.
static double judge_repairs(uint64_t seed, int most) { // boxes changed between two questions
    aisle_rng rng = aisle_rng_seed(seed);
    bool is_there[BOXES];
    memset(is_there, true, sizeof is_there);
    random_hall(&rng);
    ask(&kept);
    const uint32_t all = kept.map.edge_tests;
    for (int i = 0; i < PATCHES; i++) {
        for (int n = 0; n < most; n++) {
            random_patch(&rng, is_there);
        }
        ask(&kept);
        other.is_begun = false;
        ask(&other);
        assert_same_map(&kept.map, &other.map);
    }
    TEST_ASSERT_EQUAL_INT64(1, kept.begun);
    TEST_ASSERT_EQUAL_INT64(PATCHES, kept.repairs);
    return (double)(kept.map.edge_tests - all) / ((double)all * PATCHES);
}

static void judge_bodies(int which, double most) { // HALLS of HALLS halls
    double share = 0.0;
    for (uint64_t seed = 1; seed <= HALLS; seed++) {
        which == 0 ? hall_disc(0.3, 0.05F) : hall_rectangle(0.9, 0.5, 0.05F);
        hall_vehicle.curvature_max = which == 2 ? 1.2 : 0.0;
        share += judge_repairs(seed, 1) / HALLS;
    }
    TEST_ASSERT_TRUE(share < most);
}

static void test_a_repaired_roadmap_says_what_one_built_anew_says(void) {
    judge_bodies(0, 0.25);
}

static void test_so_do_those_of_bodies_with_a_heading_and_test_less(void) {
    judge_bodies(1, 0.5);
}

static void test_so_do_those_of_cars(void) {
    judge_bodies(2, 1.0);
}

static void test_patches_add_up_until_the_next_question(void) {
    hall_disc(0.3, 0.05F);
    (void)judge_repairs(9, 4);
}

static void test_a_repair_is_the_same_however_it_is_cut(void) {
    hall_disc(0.3, 0.05F);
    aisle_rng rng = aisle_rng_seed(4);
    bool is_there[BOXES];
    memset(is_there, true, sizeof is_there);
    random_hall(&rng);
    ask(&kept);
    ask(&other);
    random_patch(&rng, is_there);
    aisle_roadmap_keep_begin(&kept, &wish);
    aisle_roadmap_keep_begin(&other, &wish);
    TEST_ASSERT_EQUAL(AISLE_OK, build_in(&kept, 1));
    TEST_ASSERT_EQUAL(AISLE_OK, build_in(&other, 1U << 30));
    assert_same_map(&kept.map, &other.map);
    TEST_ASSERT_EQUAL_UINT32(other.map.edge_tests, kept.map.edge_tests);
}

// ---- what it is of

static void small_hall(void) {
    hall_disc(0.3, 0.05F);
    hall_begin(14.0, 9.0);
    hall_add(6.0, 3.0, 8.0, 6.0);
    open_hall();
    ask(&kept);
    TEST_ASSERT_TRUE(aisle_roadmap_keep_serves(&kept, &wish));
}

static void test_a_layout_that_comes_back_needs_no_repair(void) {
    small_hall();
    begin_patch();
    (void)put_box(7, (hall_box){2.0, 2.0, 3.0, 3.0});
    send_patch();
    TEST_ASSERT_EQUAL_UINT32(1, kept.changes.count);
    begin_patch();
    patch.removed[patch.num_removed++] = 7;
    send_patch();
    TEST_ASSERT_EQUAL_UINT32(0, kept.changes.count);
    ask(&kept);
    TEST_ASSERT_EQUAL_INT64(0, kept.repairs);
    TEST_ASSERT_EQUAL_INT64(1, kept.begun);
}

static void test_another_layout_begins_anew_unless_the_first_one_comes_back_before(void) {
    small_hall();
    aisle_refusal why;
    hall_add(10.0, 1.0, 11.0, 2.0);
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_layout_take_part(&hall_layout, hall_message(2, 0.05F), &why));
    commit();
    TEST_ASSERT_FALSE(aisle_roadmap_keep_serves(&kept, &wish));
    hall_count--;
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_layout_take_part(&hall_layout, hall_message(3, 0.05F), &why));
    commit();
    TEST_ASSERT_TRUE(aisle_roadmap_keep_serves(&kept, &wish));
    hall_count++;
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_layout_take_part(&hall_layout, hall_message(4, 0.05F), &why));
    commit();
    ask(&kept);
    TEST_ASSERT_EQUAL_INT64(2, kept.begun);
    TEST_ASSERT_EQUAL_INT64(0, kept.repairs);
}

static void test_zones_that_close_no_ground_need_no_repair(void) {
    small_hall();
    begin_patch();
    aisle_polygon_msg *zone = put_box(7, (hall_box){2.0, 2.0, 3.0, 3.0});
    zone->kind = AISLE_POLYGON_PENALTY;
    zone->value = 0.5F;
    send_patch();
    ask(&kept);
    TEST_ASSERT_EQUAL_INT64(0, kept.repairs);
    TEST_ASSERT_EQUAL_INT64(1, kept.begun);
}

static void test_more_changes_than_are_noted_begin_anew(void) {
    small_hall();
    for (uint32_t i = 0; i <= AISLE_ROADMAP_KEEP_CHANGES; i++) {
        begin_patch();
        (void)put_box(7 + (int32_t)i, (hall_box){0.1 * i, 0.0, 0.1 * i + 0.05, 0.1});
        send_patch();
    }
    ask(&kept);
    TEST_ASSERT_EQUAL_INT64(2, kept.begun);
    ask(&other);
    assert_same_map(&kept.map, &other.map);
}

static void test_another_body_seed_or_count_begins_anew_and_other_limits_do_not(void) {
    small_hall();
    hall_vehicle.v_max *= 0.5;
    hall_vehicle.mass += 10.0;
    TEST_ASSERT_TRUE(aisle_roadmap_keep_serves(&kept, &wish));
    aisle_roadmap_wish asked = wish;
    asked.config.seed++;
    TEST_ASSERT_FALSE(aisle_roadmap_keep_serves(&kept, &asked));
    asked = wish;
    asked.config.samples--;
    TEST_ASSERT_FALSE(aisle_roadmap_keep_serves(&kept, &asked));
    asked = wish;
    asked.config.eager = false;
    TEST_ASSERT_FALSE(aisle_roadmap_keep_serves(&kept, &asked));
    asked = wish;
    asked.config.one_way = true;
    TEST_ASSERT_FALSE(aisle_roadmap_keep_serves(&kept, &asked));
    space.zone_room += 0.1;
    TEST_ASSERT_FALSE(aisle_roadmap_keep_serves(&kept, &wish));
    space.zone_room -= 0.1;
    hall_vehicle.margin += 0.01;
    TEST_ASSERT_FALSE(aisle_roadmap_keep_serves(&kept, &wish));
    hall_rectangle(0.9, 0.5, 0.05F);
    begin_spaces();
    ask(&kept);
    TEST_ASSERT_EQUAL_INT64(2, kept.begun);
    hall_vehicle.footprint[0].x -= 0.01;
    TEST_ASSERT_FALSE(aisle_roadmap_keep_serves(&kept, &wish));
}

// ---- half done

static void test_what_is_half_built_goes_on_and_another_layout_ends_it(void) {
    small_hall();
    uint32_t spent = 0;
    aisle_roadmap_keep_begin(&other, &wish);
    TEST_ASSERT_EQUAL(AISLE_BUSY, aisle_roadmap_keep_step(&other, &configurations, 100, &spent));
    aisle_roadmap_keep_begin(&other, &wish);
    TEST_ASSERT_EQUAL(AISLE_OK, build_in(&other, 1000));
    assert_same_map(&kept.map, &other.map);
    TEST_ASSERT_EQUAL_INT64(1, other.begun);
    wish.config.seed = 8;
    aisle_roadmap_keep_begin(&other, &wish);
    TEST_ASSERT_EQUAL(AISLE_BUSY, aisle_roadmap_keep_step(&other, &configurations, 100, &spent));
    begin_patch();
    (void)put_box(7, (hall_box){2.0, 2.0, 3.0, 3.0});
    send_patch();
    wish.config.seed = 8;
    ask(&other);
    TEST_ASSERT_EQUAL_INT64(3, other.begun);
}

static void test_a_repair_half_done_when_the_layout_changes_again_begins_anew(void) {
    small_hall();
    uint32_t spent = 0;
    begin_patch();
    (void)put_box(7, (hall_box){2.0, 2.0, 3.0, 3.0});
    send_patch();
    aisle_roadmap_keep_begin(&kept, &wish);
    TEST_ASSERT_EQUAL(AISLE_BUSY, aisle_roadmap_keep_step(&kept, &configurations, 5, &spent));
    begin_patch();
    patch.removed[patch.num_removed++] = 7; // as it was, but for what is half done
    send_patch();
    ask(&kept);
    TEST_ASSERT_EQUAL_INT64(2, kept.begun);
    ask(&other);
    assert_same_map(&kept.map, &other.map);
}

// ---- copies

static void test_a_copy_takes_what_is_known_and_what_has_changed(void) {
    small_hall();
    begin_patch();
    (void)put_box(7, (hall_box){2.0, 2.0, 3.0, 3.0});
    send_patch();
    aisle_roadmap_keep_begin_from(&other, &kept, &wish);
    TEST_ASSERT_EQUAL(AISLE_OK, build_in(&other, 1000));
    TEST_ASSERT_EQUAL_INT64(0, other.begun);
    TEST_ASSERT_EQUAL_INT64(1, other.repairs);
    TEST_ASSERT_EQUAL_UINT32(1, kept.changes.count); // it is as it was
    ask(&kept);
    assert_same_map(&kept.map, &other.map);
}

static void test_nothing_is_copied_of_what_is_half_built(void) {
    small_hall();
    uint32_t spent = 0;
    kept.is_begun = false;
    aisle_roadmap_keep_begin(&kept, &wish);
    TEST_ASSERT_EQUAL(AISLE_BUSY, aisle_roadmap_keep_step(&kept, &configurations, 100, &spent));
    aisle_roadmap_keep_begin_from(&other, &kept, &wish);
    TEST_ASSERT_EQUAL(AISLE_OK, build_in(&other, 1000));
    TEST_ASSERT_EQUAL_INT64(1, other.begun);
}

void setUp(void) {}
void tearDown(void) {}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_a_repaired_roadmap_says_what_one_built_anew_says);
    RUN_TEST(test_so_do_those_of_bodies_with_a_heading_and_test_less);
    RUN_TEST(test_so_do_those_of_cars);
    RUN_TEST(test_patches_add_up_until_the_next_question);
    RUN_TEST(test_a_repair_is_the_same_however_it_is_cut);
    RUN_TEST(test_a_layout_that_comes_back_needs_no_repair);
    RUN_TEST(test_another_layout_begins_anew_unless_the_first_one_comes_back_before);
    RUN_TEST(test_zones_that_close_no_ground_need_no_repair);
    RUN_TEST(test_more_changes_than_are_noted_begin_anew);
    RUN_TEST(test_another_body_seed_or_count_begins_anew_and_other_limits_do_not);
    RUN_TEST(test_what_is_half_built_goes_on_and_another_layout_ends_it);
    RUN_TEST(test_a_repair_half_done_when_the_layout_changes_again_begins_anew);
    RUN_TEST(test_a_copy_takes_what_is_known_and_what_has_changed);
    RUN_TEST(test_nothing_is_copied_of_what_is_half_built);
    return UNITY_END();
}
