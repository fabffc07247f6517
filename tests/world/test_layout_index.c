#include "layout_fixture.h"

#define SIDE 0.5 // m

static fix_scene scene;
static aisle_layout_store store;
static aisle_layout_index bucket_index;

void setUp(void) {
    unsigned char *aligned = fix_memory + (64U - (uintptr_t)fix_memory % 64U) % 64U;
    aisle_arena arena = aisle_arena_over(aligned, sizeof fix_memory - 64U);
    aisle_layout_store_carve(&store, &arena, FIX_POLYGONS, FIX_VERTICES, FIX_CELLS);
    aisle_layout_index_carve(&bucket_index, &arena, FIX_POLYGONS);
    TEST_ASSERT_FALSE(arena.overflow);
}
void tearDown(void) {}

static void build(uint32_t count, double width, double height) {
    for (uint32_t i = 0; i < count; i++) {
        aisle_layout_store_add(&store, &scene.polygons[i]);
    }
    store.header.bounds = (aisle_aabb){{0, 0}, {width, height}};
    const aisle_layout_blocks blocks = {&store, NULL};
    aisle_layout_index_build(&bucket_index, &blocks, SIDE);
}

// Every zone is listed, once and in rising order, in exactly the buckets its box reaches into.
static void expect_sound(void) {
    const aisle_layout_index *x = &bucket_index;
    TEST_ASSERT_TRUE(x->nx * x->ny <= x->bucket_capacity && x->starts[x->nx * x->ny] <= x->entry_capacity);
    for (uint32_t b = 0; b < x->nx * x->ny; b++) {
        uint32_t at = x->starts[b];
        for (uint32_t i = 0; i < store.zone_count; i++) {
            const aisle_bucket_range r = aisle_layout_index_range(x, store.zones[i].box);
            const bool is_in = b % x->nx >= r.x0 && b % x->nx <= r.x1 && b / x->nx >= r.y0 && b / x->nx <= r.y1;
            if (is_in) {
                TEST_ASSERT_TRUE(at < x->starts[b + 1U]);
                TEST_ASSERT_EQUAL_UINT16(i, x->entries[at]);
                at++;
            }
        }
        TEST_ASSERT_EQUAL_UINT32(x->starts[b + 1U], at);
    }
}

static void test_lists_hold_what_reaches_into_their_bucket(void) {
    aisle_rng rng = aisle_rng_seed(151);
    fix_random_scene(&scene, &rng, 200, 1);
    build(200, 10.0, 8.0);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, SIDE, bucket_index.side);
    TEST_ASSERT_EQUAL_UINT32(21, bucket_index.nx);
    TEST_ASSERT_EQUAL_UINT32(17, bucket_index.ny);
    expect_sound();
}

static void test_the_side_is_doubled_until_buckets_fit(void) {
    aisle_rng rng = aisle_rng_seed(152);
    fix_random_scene(&scene, &rng, 20, 1);
    build(20, 2e5, 2e5);
    TEST_ASSERT_TRUE(bucket_index.side > SIDE);
    TEST_ASSERT_TRUE(4U * bucket_index.nx * bucket_index.ny > bucket_index.bucket_capacity / 2U); // no more than needed
    expect_sound();
}

static void test_the_side_is_doubled_until_lists_fit(void) {
    aisle_rng rng = aisle_rng_seed(153);
    fix_random_scene(&scene, &rng, 200, 1);
    for (uint32_t i = 0; i < 200U; i++) { // each covers everything
        aisle_vec2 v[4];
        gen_box(aisle_vec2_of(0, 0), aisle_vec2_of(30, 20), v);
        fix_set_polygon(&scene.polygons[i], (int32_t)i + 1, AISLE_POLYGON_OBSTACLE, v, 4);
    }
    build(200, 30.0, 20.0);
    TEST_ASSERT_TRUE(bucket_index.side > 4.0);
    expect_sound();
}

static void test_boxes_outside_belong_to_the_outermost_buckets(void) {
    build(0, 10.0, 8.0);
    const aisle_bucket_range r = aisle_layout_index_range(&bucket_index, (aisle_aabb){{-1e9, -5}, {1e9, -4}});
    TEST_ASSERT_EQUAL_UINT32(0, r.x0);
    TEST_ASSERT_EQUAL_UINT32(20, r.x1);
    TEST_ASSERT_EQUAL_UINT32(0, r.y0);
    TEST_ASSERT_EQUAL_UINT32(0, r.y1);
    expect_sound();
}

// Edits one by one beside an index built anew: the same to the last entry, or it says that it has to be built.
static void test_edits_leave_what_a_build_makes_or_say_so(void) {
    static unsigned char memory[2][1U << 20U];
    aisle_layout_index fresh;
    aisle_layout_index small;
    uint32_t as_built = 0;
    uint32_t to_build = 0;
    aisle_rng rng = aisle_rng_seed(154);
    for (uint32_t trial = 0; trial < 60U; trial++) {
        for (uint32_t i = 0; i < 2U; i++) {
            aisle_arena arena =
                aisle_arena_over(memory[i] + (64U - (uintptr_t)memory[i] % 64U) % 64U, (1U << 20U) - 64U);
            aisle_layout_index_carve(i == 0U ? &small : &fresh, &arena, 60);
        }
        fix_random_scene(&scene, &rng, 60, 1);
        setUp();
        store.header.bounds = (aisle_aabb){{0, 0}, {8, 4}};
        const aisle_layout_blocks blocks = {&store, NULL};
        double side = 0.125 * (1U << aisle_rng_below(&rng, 3));
        aisle_layout_index_build(&small, &blocks, side);
        for (uint32_t edit = 0; edit < 80U; edit++) {
            const bool is_more = store.zone_count == 0U || (store.zone_count < 60U && aisle_rng_below(&rng, 5) < 3U);
            const uint32_t at = aisle_rng_below(&rng, store.zone_count + (is_more ? 1U : 0U));
            aisle_zone zone = {.id = 1};
            if (is_more) {
                const double size =
                    aisle_rng_below(&rng, 5) < trial % 4U ? 9.0 : 1.0; // the large ones make the lists long
                const aisle_vec2 lo = {gen_in(&rng, -1, 8), gen_in(&rng, -1, 4)};
                zone.box = (aisle_aabb){lo, {lo.x + gen_in(&rng, 0, size), lo.y + gen_in(&rng, 0, size)}};
                memmove(&store.zones[at + 1U], &store.zones[at], (store.zone_count - at) * sizeof zone);
                store.zones[at] = zone;
                store.zone_count++;
            } else {
                zone = store.zones[at];
                store.zone_count--;
                memmove(&store.zones[at], &store.zones[at + 1U], (store.zone_count - at) * sizeof zone);
            }
            bool is_sound = true;
            if (is_more) {
                is_sound = aisle_layout_index_put_in(&small, at, zone.box);
            } else {
                aisle_layout_index_take_out(&small, at, zone.box);
            }
            side = aisle_rng_below(&rng, 10) == 0U ? 0.125 * (1U << aisle_rng_below(&rng, 3)) : side;
            aisle_layout_index_build(&fresh, &blocks, side);
            if (is_sound && aisle_layout_index_is_as_built(&small, side)) {
                as_built++;
                TEST_ASSERT_EQUAL_DOUBLE(fresh.side, small.side);
                const uint32_t buckets = fresh.nx * fresh.ny;
                TEST_ASSERT_EQUAL_MEMORY(fresh.starts, small.starts, (buckets + 1U) * sizeof *fresh.starts);
                TEST_ASSERT_EQUAL_UINT32(fresh.nx, small.nx);
                for (uint32_t i = 0; i < fresh.starts[buckets]; i++) {
                    TEST_ASSERT_EQUAL_UINT16(fresh.entries[i], small.entries[i]);
                }
            } else {
                to_build++;
                aisle_layout_index_build(&small, &blocks, side);
            }
        }
    }
    TEST_ASSERT_TRUE(as_built > 2000U && to_build > 100U && to_build < 2000U);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_lists_hold_what_reaches_into_their_bucket);
    RUN_TEST(test_the_side_is_doubled_until_buckets_fit);
    RUN_TEST(test_the_side_is_doubled_until_lists_fit);
    RUN_TEST(test_boxes_outside_belong_to_the_outermost_buckets);
    RUN_TEST(test_edits_leave_what_a_build_makes_or_say_so);
    return UNITY_END();
}
