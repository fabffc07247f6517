#include "world/layout_rects.h" // first: proves that the header stands alone

#include "layout_fixture.h"

enum { W = 61, H = 47 };

static aisle_layout_store store;
static aisle_layout_rects rects;
static bool occupied[W * H];

static void carve(uint32_t cells) {
    unsigned char *aligned = fix_memory + (64U - (uintptr_t)fix_memory % 64U) % 64U;
    aisle_arena arena = aisle_arena_over(aligned, sizeof fix_memory - 64U);
    aisle_layout_store_carve(&store, &arena, FIX_POLYGONS, FIX_VERTICES, FIX_CELLS);
    aisle_layout_rects_carve(&rects, &arena, cells);
    TEST_ASSERT_FALSE(arena.overflow);
    store.lattice = (aisle_lattice){0.0, 0.0, 0.1, W, H};
}

void setUp(void) {
    carve(FIX_CELLS);
}
void tearDown(void) {}

static void draw(aisle_rng *rng, uint32_t one_in) {
    aisle_layout_store_fill_scan(&store);
    for (uint32_t i = 0; i < W * H; i++) {
        occupied[i] = aisle_rng_below(rng, one_in) == 0U || (i % W > 20U && i % W < 30U && i / W > 9U && i / W < 40U);
        if (!occupied[i]) {
            aisle_layout_store_free_run(&store, i / W, i % W, i % W + 1U);
        }
    }
}

static void build(void) {
    aisle_layout_rects_clear(&rects);
    for (uint32_t iy = 0; iy < H; iy++) {
        aisle_layout_rects_add_row(&rects, &store, iy);
    }
    aisle_layout_rects_find_corners(&rects, &store);
}

static void test_rectangles_cover_the_occupied_cells_each_once(void) {
    aisle_rng rng = aisle_rng_seed(41);
    for (uint32_t one_in = 8; one_in < 400U; one_in = one_in * 3U / 2U) {
        draw(&rng, one_in);
        build(); // over the remains of the one before
        uint8_t covered[W * H] = {0};
        TEST_ASSERT_FALSE(rects.overflow);
        for (uint32_t i = 0; i < rects.count; i++) {
            const aisle_layout_rect *r = &rects.rect[i];
            TEST_ASSERT_TRUE(r->x0 < r->x1 && r->y0 < r->y1 && r->x1 <= W && r->y1 <= H);
            for (uint32_t y = r->y0; y < r->y1; y++) {
                for (uint32_t x = r->x0; x < r->x1; x++) {
                    covered[y * W + x]++;
                }
            }
        }
        for (uint32_t i = 0; i < W * H; i++) {
            TEST_ASSERT_EQUAL_UINT8(occupied[i] ? 1U : 0U, covered[i]);
        }
    }
}

static void test_a_block_with_no_noise_is_one_rectangle_with_four_real_corners(void) {
    aisle_rng rng = aisle_rng_seed(42);
    draw(&rng, UINT32_MAX);
    build();
    TEST_ASSERT_EQUAL_UINT32(1, rects.count);
    const aisle_layout_rect whole = {21, 10, 30, 40};
    TEST_ASSERT_EQUAL_MEMORY(&whole, &rects.rect[0], sizeof whole);
    TEST_ASSERT_EQUAL_UINT8(15, rects.real[0]);
}

static bool is_occupied(int x, int y) { // what is outside is
    return x < 0 || y < 0 || x >= W || y >= H || occupied[y * W + x];
}

// Points of the lattice about which the occupied ground has a convex corner, counted cell by cell.
static uint32_t convex_corners(void) {
    uint32_t count = 0;
    for (int y = 0; y < H; y++) {
        for (int x = 0; x < W; x++) {
            for (int k = 0; k < 4; k++) {
                int dx = k % 2 == 0 ? -1 : 1;
                int dy = k < 2 ? -1 : 1;
                count += is_occupied(x, y) && !is_occupied(x + dx, y) && !is_occupied(x, y + dy) ? 1U : 0U;
            }
        }
    }
    return count;
}

static void test_real_corners_are_the_convex_ones(void) {
    aisle_rng rng = aisle_rng_seed(43);
    for (uint32_t one_in = 8; one_in < 100U; one_in *= 2U) {
        draw(&rng, one_in);
        build();
        uint32_t real = 0;
        for (uint32_t i = 0; i < rects.count; i++) {
            const aisle_layout_rect *r = &rects.rect[i];
            const int x[4] = {r->x0, r->x1 - 1, r->x1 - 1, r->x0};
            const int y[4] = {r->y0, r->y0, r->y1 - 1, r->y1 - 1};
            for (int k = 0; k < 4; k++) {
                if ((rects.real[i] >> k & 1) != 0) {
                    real++;
                    TEST_ASSERT_FALSE(is_occupied(k == 1 || k == 2 ? x[k] + 1 : x[k] - 1, y[k]));
                    TEST_ASSERT_FALSE(is_occupied(x[k], k < 2 ? y[k] - 1 : y[k] + 1));
                }
            }
        }
        TEST_ASSERT_EQUAL_UINT32(convex_corners(), real);
    }
}

static void test_too_many_rectangles_are_told(void) {
    carve(64U * 20U);
    aisle_rng rng = aisle_rng_seed(44);
    draw(&rng, 8);
    build();
    TEST_ASSERT_TRUE(rects.overflow);
    TEST_ASSERT_EQUAL_UINT32(20, rects.count);
    draw(&rng, UINT32_MAX);
    build();
    TEST_ASSERT_FALSE(rects.overflow);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_rectangles_cover_the_occupied_cells_each_once);
    RUN_TEST(test_a_block_with_no_noise_is_one_rectangle_with_four_real_corners);
    RUN_TEST(test_real_corners_are_the_convex_ones);
    RUN_TEST(test_too_many_rectangles_are_told);
    return UNITY_END();
}
