#include "plan/opening.h"

#include "hall.h"

// The judge floods a grid of its own, 4 cm, by brute force over hall.h's boxes: a set of boxes left out is open if
// cells connect that keep 6 cm more than the reach, and shut if not even cells do that keep 6 cm less.

#define CELL 0.04
#define SPARE 0.06
#define SIDE_MAX 256
#define JUDGE_CELLS (SIDE_MAX * SIDE_MAX)

static aisle_space space;
static aisle_seed seed;
static aisle_opening opening;
static uint32_t spent;

static uint64_t near_mask[2][JUDGE_CELLS]; // boxes within reach - SPARE and reach + SPARE of the cell; bit 63: a wall
static bool seen[JUDGE_CELLS];
static int queue[JUDGE_CELLS];
static int judge_w, judge_h;

static void open_hall(float resolution) {
    aisle_arena arena = hall_arena(24U << 20);
    memset(&space, 0, sizeof space);
    memset(&seed, 0, sizeof seed);
    aisle_space_carve(&space, &arena, hall_limits.cells);
    aisle_seed_carve(&seed, &arena, &hall_limits);
    hall_open(&arena, resolution);
    aisle_space_begin(&space, &hall_layout, &hall_vehicle, AISLE_SPACE_FREE_TURN);
}

static aisle_status run_on(aisle_vec2 start, aisle_vec2 goal, uint32_t depth, uint32_t slice, uint32_t limit) {
    aisle_status st;
    spent = 0;
    aisle_opening_start(&opening, &seed, &space, start, goal, depth, limit);
    do {
        uint32_t before = spent;
        st = aisle_opening_step(&opening, slice, &spent);
        TEST_ASSERT_TRUE(slice > 1000000U || spent - before <= slice + 4096U);
    } while (st == AISLE_BUSY);
    return st;
}

static aisle_status run(aisle_vec2 start, aisle_vec2 goal) {
    return run_on(start, goal, 0, 1000, AISLE_OPENING_UNITS);
}

// ---- judge

static void judge_measure(double reach) {
    judge_w = (int)(hall_width / CELL);
    judge_h = (int)(hall_height / CELL);
    TEST_ASSERT_TRUE(judge_w * judge_h <= JUDGE_CELLS);
    for (int k = 0; k < 2; k++) {
        long double most = (long double)(k == 0 ? reach - SPARE : reach + SPARE);
        for (int i = 0; i < judge_w * judge_h; i++) {
            long double x = (long double)((i % judge_w + 0.5) * CELL);
            long double y = (long double)((i / judge_w + 0.5) * CELL);
            uint64_t mask = 0;
            for (int b = 0; b < hall_count; b++) {
                mask |= hall_point_box(x, y, &hall_boxes[b]) < most ? 1ULL << b : 0U;
            }
            long double wall = fminl(fminl(x, (long double)hall_width - x), fminl(y, (long double)hall_height - y));
            near_mask[k][i] = mask | (wall < most ? 1ULL << 63 : 0U);
        }
    }
}

static bool judge_connects(int k, uint64_t removed, aisle_vec2 start, aisle_vec2 goal) {
    int head = 0;
    int tail = 0;
    int end = (int)(goal.y / CELL) * judge_w + (int)(goal.x / CELL);
    memset(seen, 0, sizeof seen);
    queue[tail++] = (int)(start.y / CELL) * judge_w + (int)(start.x / CELL);
    seen[queue[0]] = true;
    while (head < tail) {
        int at = queue[head++];
        if (at == end) {
            return true;
        }
        for (int n = 0; n < 9; n++) {
            int x = at % judge_w + n % 3 - 1;
            int y = at / judge_w + n / 3 - 1;
            int next = y * judge_w + x;
            if (x >= 0 && y >= 0 && x < judge_w && y < judge_h && !seen[next] &&
                (near_mask[k][next] & ~removed) == 0U) {
                seen[next] = true;
                queue[tail++] = next;
            }
        }
    }
    return false;
}

static uint64_t bit_of(int32_t id) {
    return 1ULL << (id - 1);
}

// Is some set of `size` boxes open for sure?
static bool judge_some(uint32_t size, aisle_vec2 start, aisle_vec2 goal) {
    for (int a = 0; a < hall_count; a++) {
        for (int b = size == 1U ? a : 0; b < (size == 1U ? a + 1 : a); b++) {
            if (judge_connects(1, 1ULL << a | 1ULL << b, start, goal)) {
                return true;
            }
        }
    }
    return false;
}

// A wall of boxes across the hall, some overlapping, some leaving doors.
static void add_wall(aisle_rng *rng, double x, double widest) {
    double y = 0.0;
    while (y < hall_height) {
        double next = fmin(y + uniform(rng, 0.4, 2.5), hall_height);
        double left = x + uniform(rng, -0.2, 0.2);
        hall_add(left, fmax(y - uniform(rng, 0.0, 0.3), 0.0), left + uniform(rng, 0.2, 0.6), next);
        y = next + uniform(rng, -0.1, widest);
    }
}

void setUp(void) {
    hall_disc(0.35, 0.1F);
}
void tearDown(void) {}

// ---- tests

static const aisle_vec2 left = {1.0, 2.5};
static const aisle_vec2 right = {7.0, 2.5};

static void test_in_random_halls_the_set_is_open_and_no_smaller_one_is(void) {
    int sizes[3] = {0, 0, 0};
    for (uint64_t s = 0; s < 60; s++) {
        aisle_rng rng = aisle_rng_seed(s);
        hall_begin(8.0, 5.0);
        add_wall(&rng, 2.7, s % 4U == 0U ? 0.1 : 0.85);
        if (s % 3U != 0U) {
            add_wall(&rng, 2.7 + uniform(&rng, 0.2, 2.3), 0.85);
        }
        open_hall(s % 2U == 0U ? 0.05F : 0.1F);
        judge_measure(0.45);
        if (judge_connects(0, 0, left, right)) {
            continue; // not shut for sure
        }
        aisle_status st = run(left, right);
        uint32_t size = st == AISLE_OK ? opening.without.count : 0U;
        sizes[size]++;
        if (size > 0U) {
            uint64_t removed = bit_of(opening.without.id[0]) | (size > 1U ? bit_of(opening.without.id[1]) : 0U);
            TEST_ASSERT_TRUE(judge_connects(0, removed, left, right));
        }
        if (size != 1U) {
            TEST_ASSERT_FALSE(judge_some(1, left, right));
        }
        if (size == 0U) {
            TEST_ASSERT_FALSE(!opening.doubt && judge_some(2, left, right));
        }
    }
    TEST_ASSERT_TRUE(sizes[1] >= 10 && sizes[2] >= 10);
}

static void test_a_wall_with_a_second_wall_behind_it_takes_both(void) {
    hall_begin(8.0, 5.0);
    hall_add(3.0, 0.0, 3.2, 5.0);
    hall_add(5.0, 0.0, 5.2, 5.0);
    hall_add(6.0, 0.2, 6.2, 0.4); // in nobody's way
    open_hall(0.05F);
    TEST_ASSERT_EQUAL(AISLE_OK, run(left, right));
    TEST_ASSERT_EQUAL_UINT32(2, opening.without.count);
    TEST_ASSERT_EQUAL_INT32(3, opening.without.id[0] + opening.without.id[1]);
}

static void test_two_that_close_the_same_place_both_have_to_go(void) {
    hall_begin(8.0, 5.0);
    hall_add(2.9, 2.3, 3.3, 2.9); // one on the other in a door of 1.2 m
    hall_add(2.95, 2.2, 3.25, 3.0);
    for (int i = 0; i < 3; i++) { // and walls of three
        hall_add(3.0, 0.0, 3.2, 2.0);
        hall_add(3.0, 3.2, 3.2, 5.0);
    }
    open_hall(0.05F);
    TEST_ASSERT_EQUAL(AISLE_OK, run(left, right));
    TEST_ASSERT_EQUAL_UINT32(2, opening.without.count);
    TEST_ASSERT_EQUAL_INT32(3, opening.without.id[0] + opening.without.id[1]);
}

static void test_three_walls_are_too_many(void) {
    hall_begin(8.0, 5.0);
    for (int i = 0; i < 3; i++) {
        hall_add(2.5 + 1.3 * i, 0.0, 2.7 + 1.3 * i, 5.0);
    }
    open_hall(0.05F);
    TEST_ASSERT_EQUAL(AISLE_PARTIAL, run(left, right));
    TEST_ASSERT_FALSE(opening.doubt);
}

static void test_a_way_too_narrow_by_a_hair_is_neither_proved_nor_called_shut(void) {
    hall_begin(8.0, 5.0);
    hall_add(3.0, 0.0, 3.2, 5.0); // this one gone, a door is left
    hall_add(5.0, 0.0, 5.2, 2.0);
    hall_add(5.0, 2.8999, 5.2, 5.0); // 0.1 mm too narrow
    open_hall(0.05F);
    TEST_ASSERT_EQUAL(AISLE_PARTIAL, run(left, right));
    TEST_ASSERT_TRUE(opening.doubt);
    hall_boxes[2].y0 = 2.85; // 5 cm: seen at an eighth of a cell, so the first wall alone is excluded
    open_hall(0.05F);
    TEST_ASSERT_EQUAL(AISLE_OK, run(left, right));
    TEST_ASSERT_EQUAL_UINT32(2, opening.without.count);
    hall_boxes[2].y0 = 3.1; // wide enough
    open_hall(0.05F);
    TEST_ASSERT_EQUAL(AISLE_OK, run(left, right));
    TEST_ASSERT_EQUAL_UINT32(1, opening.without.count);
    TEST_ASSERT_EQUAL_INT32(1, opening.without.id[0]);
}

static void test_without_polygons_or_work_nothing_is_told(void) {
    hall_begin(8.0, 5.0);
    open_hall(0.05F);
    TEST_ASSERT_EQUAL(AISLE_PARTIAL, run(left, right));
    hall_add(3.0, 0.0, 3.2, 5.0);
    open_hall(0.05F);
    TEST_ASSERT_EQUAL(AISLE_OK, run(left, right));
    uint32_t all = spent;
    TEST_ASSERT_EQUAL(AISLE_PARTIAL, run_on(left, right, 0, 1000, all / 2U));
    TEST_ASSERT_TRUE(spent <= all / 2U + 4096U);
}

static void test_any_slicing_tells_the_same_for_the_same_units(void) {
    static const uint32_t slices[] = {1, 13, 5000};
    hall_begin(8.0, 5.0);
    hall_add(3.0, 0.0, 3.2, 5.0);
    hall_add(5.0, 0.0, 5.2, 5.0);
    open_hall(0.05F);
    TEST_ASSERT_EQUAL(AISLE_OK, run_on(left, right, 0, UINT32_MAX, AISLE_OPENING_UNITS));
    aisle_opening whole = opening;
    uint32_t units = spent;
    for (int i = 0; i < 3; i++) {
        TEST_ASSERT_EQUAL(AISLE_OK, run_on(left, right, 0, slices[i], AISLE_OPENING_UNITS));
        TEST_ASSERT_EQUAL_UINT32(units, spent);
        TEST_ASSERT_EQUAL_MEMORY(&whole, &opening, sizeof opening);
    }
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_in_random_halls_the_set_is_open_and_no_smaller_one_is);
    RUN_TEST(test_a_wall_with_a_second_wall_behind_it_takes_both);
    RUN_TEST(test_two_that_close_the_same_place_both_have_to_go);
    RUN_TEST(test_three_walls_are_too_many);
    RUN_TEST(test_a_way_too_narrow_by_a_hair_is_neither_proved_nor_called_shut);
    RUN_TEST(test_without_polygons_or_work_nothing_is_told);
    RUN_TEST(test_any_slicing_tells_the_same_for_the_same_units);
    return UNITY_END();
}
