#include "algo/astar.h" // first: proves that the header stands alone

#include "base/check.h"
#include "base/crc32.h"
#include "base/rng.h"
#include "unity.h"

#include <setjmp.h>
#include <stdlib.h>
#include <string.h>

enum { CELLS = 90000, OPEN_NODES = 20000, BYTES = CELLS * 2 + OPEN_NODES * 8 + 16384, SMALL = 26 * 26 };
static const int step_x[8] = {1, 0, -1, 0, 1, -1, -1, 1}, step_y[8] = {0, 1, 0, -1, 1, 1, -1, -1};

static unsigned char room[BYTES + 64];
static aisle_astar search;
static aisle_astar_config cfg;
static uint32_t path[CELLS], length;
static jmp_buf refused;

// The world the inlet tells about: cells barred, moves barred and factors by a hash of the move.
static struct {
    uint8_t barred[CELLS];
    uint32_t barred_moves;       // of 256
    uint32_t factor_max;         // factors are in [16, factor_max]
    bool corners;                // diagonal steps need both neighbours free
    uint64_t seed;               // of the factors
    uint32_t asked[CELLS];       // how often the search asked about entering a cell
    uint32_t told_barred[CELLS]; // how often it was told that the cell is barred
    uint32_t calls;
} world;

void aisle_assert_failed(const char *file, int line, const char *condition) {
    (void)file;
    (void)line;
    (void)condition;
    longjmp(refused, 1);
}

static uint32_t move_hash(uint32_t from, uint8_t dir) {
    aisle_rng rng = aisle_rng_seed(world.seed ^ ((uint64_t)from << 3 | dir));
    return aisle_rng_next(&rng);
}

// Factor of a move in sixteenths, 0 if not allowed. Judges the search as well as the Dijkstra below.
static uint32_t factor_of(uint32_t from, uint32_t to, uint8_t dir) {
    const uint32_t hash = move_hash(from, dir);
    if (world.barred[to] != 0 || (hash & 255U) < world.barred_moves) {
        return 0;
    }
    if (world.corners && dir >= 4) {
        const uint32_t beside = (uint32_t)((int)from + step_x[dir]);
        const uint32_t above = (uint32_t)((int)from + step_y[dir] * (int)cfg.w);
        if (world.barred[beside] != 0 || world.barred[above] != 0) {
            return 0;
        }
    }
    return 16 + (hash >> 8) % (world.factor_max - 15);
}

static uint32_t enter(void *ctx, uint32_t from, uint32_t to, uint8_t dir) {
    TEST_ASSERT_EQUAL_PTR(&world, ctx);
    const uint32_t cells = cfg.w * cfg.h;
    TEST_ASSERT_TRUE(from < cells && to < cells && dir < 8 && to != cfg.start);
    TEST_ASSERT_EQUAL_INT(step_x[dir], (int)(to % cfg.w) - (int)(from % cfg.w)); // round no border
    TEST_ASSERT_EQUAL_INT(step_y[dir], (int)(to / cfg.w) - (int)(from / cfg.w));
    TEST_ASSERT_TRUE(++world.asked[to] <= 8 && world.told_barred[to] == 0);
    TEST_ASSERT_TRUE(aisle_astar_reached(&search, from) && !aisle_astar_reached(&search, to));
    world.calls++;
    if (world.barred[to] != 0) {
        world.told_barred[to]++;
        return AISLE_ASTAR_BARRED_CELL;
    }
    return factor_of(from, to, dir); // 0 = AISLE_ASTAR_BARRED
}

static void carve(uint32_t cells, uint32_t open_nodes) {
    const uintptr_t past = (uintptr_t)room % AISLE_ARENA_ALIGN;
    aisle_arena arena = aisle_arena_over(room + (past == 0 ? 0 : AISLE_ARENA_ALIGN - past), BYTES);
    aisle_astar_carve(&search, &arena, cells, open_nodes);
    TEST_ASSERT_FALSE(arena.overflow);
    memset((unsigned char *)search.cell, 0xC3, (size_t)cells * 2); // start() must not rely on zeros
}

static void empty_world(uint32_t w, uint32_t h) {
    memset(&world, 0, sizeof world);
    world.factor_max = 16;
    cfg = (aisle_astar_config){.enter = enter, .ctx = &world, .w = w, .h = h, .start = 0, .goal = w * h - 1};
}

// A small world of any shape; every kind of map has its share of the seeds.
static void random_world(uint64_t seed) {
    aisle_rng rng = aisle_rng_seed(seed);
    const uint32_t w = 1 + aisle_rng_below(&rng, 26);
    const uint32_t h = 1 + aisle_rng_below(&rng, 26);
    empty_world(w, h);
    const uint32_t density[5] = {0, 10, 25, 35, 45};
    const uint32_t percent = density[aisle_rng_below(&rng, 5)];
    for (uint32_t i = 0; i < w * h; i++) {
        world.barred[i] = aisle_rng_below(&rng, 100) < percent;
    }
    const uint32_t factors[4] = {16, 17, 40, 256};
    world.factor_max = factors[aisle_rng_below(&rng, 4)];
    world.barred_moves = aisle_rng_below(&rng, 3) * 30;
    world.corners = aisle_rng_below(&rng, 2) == 0;
    world.seed = seed;
    cfg.start = aisle_rng_below(&rng, w * h);
    cfg.goal = aisle_rng_below(&rng, w * h);
}

static aisle_status run_in_steps_of(uint32_t slice) {
    memset(world.asked, 0, sizeof world.asked);
    memset(world.told_barred, 0, sizeof world.told_barred);
    world.calls = 0;
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_astar_start(&search, &cfg));
    aisle_status st = AISLE_BUSY;
    while (st == AISLE_BUSY) {
        const uint32_t before = search.expanded;
        st = aisle_astar_step(&search, slice);
        TEST_ASSERT_TRUE(search.expanded - before <= slice);
    }
    length = 0;
    if (st == AISLE_OK) {
        TEST_ASSERT_EQUAL(AISLE_OK, aisle_astar_path(&search, path, CELLS, &length));
    }
    TEST_ASSERT_EQUAL_UINT32(world.calls, search.asked);
    return st;
}

// Cheapest costs from the start, by relaxing every move until nothing changes (Bellman & Ford): slow and plain.
static uint64_t cheapest[SMALL];

static bool relax_all(void) {
    bool changed = false;
    for (uint32_t from = 0; from < cfg.w * cfg.h; from++) {
        for (uint8_t dir = 0; dir < 8 && cheapest[from] != UINT64_MAX; dir++) {
            const int x = (int)(from % cfg.w) + step_x[dir];
            const int y = (int)(from / cfg.w) + step_y[dir];
            if (x < 0 || y < 0 || x >= (int)cfg.w || y >= (int)cfg.h) {
                continue;
            }
            const uint32_t to = (uint32_t)y * cfg.w + (uint32_t)x;
            const uint32_t factor = factor_of(from, to, dir);
            const uint64_t cost = cheapest[from] + (dir < 4 ? 70U : 99U) * (uint64_t)factor / 16U;
            if (factor != 0 && cost < cheapest[to]) {
                cheapest[to] = cost;
                changed = true;
            }
        }
    }
    return changed;
}

static void find_cheapest(void) {
    memset(cheapest, 0xFF, sizeof cheapest);
    cheapest[cfg.start] = 0;
    while (relax_all()) {
    }
}

static uint8_t dir_between(uint32_t from, uint32_t to) {
    for (uint8_t dir = 0; dir < 8; dir++) {
        if ((int)(from % cfg.w) + step_x[dir] == (int)(to % cfg.w) &&
            (int)(from / cfg.w) + step_y[dir] == (int)(to / cfg.w)) {
            return dir;
        }
    }
    TEST_FAIL_MESSAGE("the path jumps");
    return 8;
}

static void check_path(void) {
    TEST_ASSERT_TRUE(path[0] == cfg.start && path[length - 1] == cfg.goal);
    uint64_t cost = 0;
    for (uint32_t i = 1; i < length; i++) {
        const uint8_t dir = dir_between(path[i - 1], path[i]);
        const uint32_t factor = factor_of(path[i - 1], path[i], dir);
        TEST_ASSERT_TRUE(factor != 0);
        cost += (dir < 4 ? 70U : 99U) * factor / 16U;
    }
    TEST_ASSERT_EQUAL_UINT64(aisle_astar_cost(&search), cost);
}

// The path found last, kept beside the one found next.
static uint32_t kept_path[CELLS], kept_length;

static void keep_path(void) {
    kept_length = length;
    memcpy(kept_path, path, length * sizeof path[0]);
}

static void expect_kept_path(void) {
    TEST_ASSERT_EQUAL_UINT32(kept_length, length);
    TEST_ASSERT_TRUE(memcmp(kept_path, path, length * sizeof path[0]) == 0);
}

void setUp(void) {
    carve(CELLS, OPEN_NODES);
    empty_world(10, 10);
}
void tearDown(void) {}

static void test_cost_is_the_least_for_3000_of_3000_seeds(void) {
    uint32_t found = 0;
    for (uint64_t seed = 0; seed < 3000; seed++) {
        random_world(seed);
        find_cheapest();
        const aisle_status st = run_in_steps_of(UINT32_MAX);
        TEST_ASSERT_EQUAL(cheapest[cfg.goal] == UINT64_MAX ? AISLE_PARTIAL : AISLE_OK, st);
        TEST_ASSERT_EQUAL_UINT64(cheapest[cfg.goal], aisle_astar_cost(&search));
        if (st == AISLE_OK) {
            check_path();
            found++;
        }
    }
    TEST_ASSERT_TRUE(found > 1200 && found < 2700); // both ends are well tested
}

static void test_reached_after_partial_is_the_component_for_2000_of_2000_seeds(void) {
    for (uint64_t seed = 0; seed < 2000; seed++) {
        random_world(seed);
        const uint32_t cells = cfg.w * cfg.h;
        if (cfg.goal == cfg.start) {
            continue;
        }
        world.barred[cfg.goal] = 1;
        find_cheapest();
        TEST_ASSERT_EQUAL(AISLE_PARTIAL, run_in_steps_of(UINT32_MAX));
        uint32_t reached = 0;
        for (uint32_t cell = 0; cell < cells; cell++) {
            TEST_ASSERT_EQUAL(cheapest[cell] != UINT64_MAX, aisle_astar_reached(&search, cell));
            reached += cheapest[cell] != UINT64_MAX;
        }
        TEST_ASSERT_EQUAL_UINT32(reached, search.expanded);
        TEST_ASSERT_FALSE(aisle_astar_reached(&search, cells) || aisle_astar_reached(&search, UINT32_MAX));
    }
}

static void test_any_slicing_gives_the_same_bits_and_keeps_the_invariants(void) {
    for (uint64_t seed = 0; seed < 60; seed++) {
        random_world(seed);
        const aisle_status st = run_in_steps_of(UINT32_MAX);
        const uint32_t expanded = search.expanded;
        keep_path();
        for (uint32_t slice = 1; slice < 40; slice += 3) {
            TEST_ASSERT_EQUAL(st, run_in_steps_of(slice));
            TEST_ASSERT_EQUAL_UINT32(expanded, search.expanded);
            expect_kept_path();
        }
    }
}

static void test_invariants_hold_after_every_step(void) {
    for (uint64_t seed = 100; seed < 140; seed++) {
        random_world(seed);
        TEST_ASSERT_EQUAL(AISLE_OK, aisle_astar_start(&search, &cfg));
        memset(world.asked, 0, sizeof world.asked);
        memset(world.told_barred, 0, sizeof world.told_barred);
        do {
            TEST_ASSERT_TRUE(aisle_astar_invariants_hold(&search));
        } while (aisle_astar_step(&search, 1) == AISLE_BUSY);
        TEST_ASSERT_TRUE(aisle_astar_invariants_hold(&search));
    }
}

// Any capacity gives either the same bits or no answer, and an eighth more than what is open at once is enough.
static void test_a_small_open_list_gives_the_same_path_or_no_answer(void) {
    uint32_t refusals = 0;
    for (uint64_t seed = 0; seed < 60; seed++) {
        random_world(seed);
        const aisle_status st = run_in_steps_of(UINT32_MAX);
        keep_path();
        for (uint32_t open_nodes = 1; open_nodes < 120; open_nodes += 1 + open_nodes / 8) {
            carve(SMALL, open_nodes);
            const aisle_status got = run_in_steps_of(1);
            TEST_ASSERT_TRUE(got == st || got == AISLE_ERR_CAPACITY);
            TEST_ASSERT_TRUE(search.open_used_max <= open_nodes && aisle_astar_invariants_hold(&search));
            if (got == AISLE_OK) {
                expect_kept_path();
            }
            refusals += got == AISLE_ERR_CAPACITY;
        }
        carve(CELLS, OPEN_NODES);
    }
    TEST_ASSERT_TRUE(refusals > 100);
}

static void test_a_full_open_list_stays_full_and_asks_no_more(void) {
    carve(SMALL, 5);
    empty_world(20, 20);
    TEST_ASSERT_EQUAL(AISLE_ERR_CAPACITY, run_in_steps_of(UINT32_MAX));
    const uint32_t calls = world.calls;
    TEST_ASSERT_EQUAL(AISLE_ERR_CAPACITY, aisle_astar_step(&search, 100));
    TEST_ASSERT_EQUAL_UINT32(calls, world.calls);
    TEST_ASSERT_EQUAL_UINT64(UINT64_MAX, aisle_astar_cost(&search));
    TEST_ASSERT_EQUAL(AISLE_ERR_ARG, aisle_astar_path(&search, path, CELLS, &length));
}

static void test_stale_entries_do_not_fill_the_list_on_open_ground(void) {
    carve(CELLS, 2000);
    empty_world(300, 300);
    cfg.goal = 200U * 300U + 299U;
    for (uint32_t x = 10; x < 300; x++) {
        world.barred[150U * 300U + x] = 1;
    }
    TEST_ASSERT_EQUAL(AISLE_OK, run_in_steps_of(50));
    TEST_ASSERT_TRUE(search.collected > 5);
    TEST_ASSERT_TRUE(search.expanded > 20000);
    check_path();
}

static void test_a_cleaned_ring_gives_the_same_path_as_an_untouched_one(void) {
    uint32_t collected = 0;
    for (uint64_t seed = 0; seed < 8; seed++) {
        carve(CELLS, OPEN_NODES);
        empty_world(100, 100);
        world.seed = seed;
        world.factor_max = 20 + (uint32_t)seed * 30;
        cfg.start = 5050;
        cfg.goal = 0;
        TEST_ASSERT_EQUAL(AISLE_OK, run_in_steps_of(UINT32_MAX));
        TEST_ASSERT_EQUAL_UINT32(0, search.collected);
        keep_path();
        carve(CELLS, 700);
        TEST_ASSERT_EQUAL(AISLE_OK, run_in_steps_of(7));
        collected += search.collected;
        expect_kept_path();
    }
    TEST_ASSERT_TRUE(collected > 4);
}

static void test_high_water_mark_is_kept_over_runs_and_the_second_run_equals_the_first(void) {
    random_world(3);
    empty_world(25, 25);
    TEST_ASSERT_EQUAL(AISLE_OK, run_in_steps_of(3));
    const uint32_t crc = aisle_crc32(0, path, length * sizeof path[0]);
    const uint32_t mark = search.open_used_max;
    TEST_ASSERT_TRUE(mark > 10);
    TEST_ASSERT_EQUAL(AISLE_OK, run_in_steps_of(3));
    TEST_ASSERT_EQUAL_HEX32(crc, aisle_crc32(0, path, length * sizeof path[0]));
    TEST_ASSERT_EQUAL_UINT32(mark, search.open_used_max);
    empty_world(2, 1);
    TEST_ASSERT_EQUAL(AISLE_OK, run_in_steps_of(3));
    TEST_ASSERT_EQUAL_UINT32(mark, search.open_used_max);
}

static void test_costs_far_beyond_the_ring_are_exact(void) {
    empty_world(30000, 3); // two walls with one end open each: there, back and there again, at sixteen times the price
    world.factor_max = 256;
    TEST_ASSERT_EQUAL(AISLE_OK, run_in_steps_of(UINT32_MAX));
    check_path();
    empty_world(45, 45);
    for (uint32_t y = 1; y < 45; y += 2) {
        for (uint32_t x = 0; x < 45; x++) {
            world.barred[y * 45 + x] = x != (y % 4 == 1 ? 44U : 0U);
        }
    }
    world.corners = true;
    TEST_ASSERT_EQUAL(AISLE_OK, run_in_steps_of(UINT32_MAX));
    check_path();
    TEST_ASSERT_EQUAL_UINT64(70U * (23U * 44U + 44U), aisle_astar_cost(&search));
}

static void test_an_empty_grid_costs_the_octile_distance(void) {
    for (uint32_t goal = 0; goal < 35; goal++) {
        empty_world(7, 5);
        cfg.start = 17; // (3, 2)
        cfg.goal = goal;
        TEST_ASSERT_EQUAL(AISLE_OK, run_in_steps_of(UINT32_MAX));
        const uint32_t dx = (uint32_t)abs((int)(goal % 7) - 3);
        const uint32_t dy = (uint32_t)abs((int)(goal / 7) - 2);
        const uint32_t diagonal = dx < dy ? dx : dy;
        TEST_ASSERT_EQUAL_UINT64(99U * diagonal + 70U * (dx + dy - 2 * diagonal), aisle_astar_cost(&search));
        TEST_ASSERT_EQUAL_UINT32(1 + dx + dy - diagonal, length);
    }
}

static void test_start_at_the_goal_is_a_path_of_one_cell_without_asking(void) {
    cfg.start = cfg.goal = 42;
    TEST_ASSERT_EQUAL(AISLE_OK, run_in_steps_of(1));
    TEST_ASSERT_EQUAL_UINT32(1, length);
    TEST_ASSERT_EQUAL_UINT32(42, path[0]);
    TEST_ASSERT_EQUAL_UINT64(0, aisle_astar_cost(&search));
    TEST_ASSERT_EQUAL_UINT32(0, world.calls);
}

static void test_a_grid_of_one_cell_works(void) {
    carve(1, 1);
    empty_world(1, 1);
    TEST_ASSERT_EQUAL(AISLE_OK, run_in_steps_of(1));
    TEST_ASSERT_EQUAL_UINT32(1, length);
}

static uint8_t order[64];
static uint32_t order_count;

static uint32_t note_order(void *ctx, uint32_t from, uint32_t to, uint8_t dir) {
    (void)ctx;
    (void)from;
    (void)to;
    order[order_count++ % 64] = dir;
    return AISLE_ASTAR_BARRED;
}

static void test_neighbours_are_asked_about_in_the_stated_order(void) {
    static const uint8_t want[8] = {0, 1, 2, 3, 4, 5, 6, 7};
    order_count = 0;
    cfg = (aisle_astar_config){note_order, NULL, 3, 3, 4, 8};
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_astar_start(&search, &cfg));
    TEST_ASSERT_EQUAL(AISLE_PARTIAL, aisle_astar_step(&search, 10));
    TEST_ASSERT_EQUAL_UINT32(8, order_count);
    TEST_ASSERT_EQUAL_MEMORY(want, order, 8);
}

static void test_a_corner_of_the_grid_has_three_neighbours(void) {
    const uint32_t corners[4] = {0, 3, 12, 15};
    static const uint8_t want[4][3] = {{0, 1, 4}, {1, 2, 5}, {0, 3, 7}, {2, 3, 6}};
    for (int i = 0; i < 4; i++) {
        order_count = 0;
        cfg = (aisle_astar_config){note_order, NULL, 4, 4, corners[i], 5};
        TEST_ASSERT_EQUAL(AISLE_OK, aisle_astar_start(&search, &cfg));
        TEST_ASSERT_EQUAL(AISLE_PARTIAL, aisle_astar_step(&search, 10));
        TEST_ASSERT_EQUAL_UINT32(3, order_count);
        TEST_ASSERT_EQUAL_MEMORY(want[i], order, 3);
    }
}

static void expect_refusal(aisle_status want, const aisle_astar_config *bad) {
    static aisle_astar before;
    memcpy(&before, &search, sizeof search);
    TEST_ASSERT_EQUAL(want, aisle_astar_start(&search, bad));
    TEST_ASSERT_EQUAL_MEMORY(&before, &search, sizeof search);
}

static void test_start_refuses_every_bad_field_and_leaves_self_alone(void) {
    TEST_ASSERT_EQUAL(AISLE_OK, run_in_steps_of(9));
    const aisle_astar_config good = cfg;
#define REFUSE(status, field, value)                                                                                   \
    cfg = good;                                                                                                        \
    cfg.field = (value);                                                                                               \
    expect_refusal(status, &cfg)
    REFUSE(AISLE_ERR_ARG, w, 0);
    REFUSE(AISLE_ERR_ARG, h, 0);
    REFUSE(AISLE_ERR_ARG, start, 100);
    REFUSE(AISLE_ERR_ARG, goal, 100);
    REFUSE(AISLE_ERR_ARG, enter, NULL);
    REFUSE(AISLE_ERR_CAPACITY, w, CELLS / 10 + 1);
    REFUSE(AISLE_ERR_CAPACITY, h, UINT32_MAX);
    cfg.w = cfg.h = 65536; // the product wraps to 0 in 32 bits
    expect_refusal(AISLE_ERR_CAPACITY, &cfg);
    cfg.w = cfg.h = 0x80000001U; // and here to 1
    expect_refusal(AISLE_ERR_CAPACITY, &cfg);
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_astar_step(&search, 1)); // the old answer still stands
}

static void test_a_search_never_started_answers_so(void) {
    TEST_ASSERT_EQUAL(AISLE_ERR_ARG, aisle_astar_step(&search, 1));
    TEST_ASSERT_EQUAL(AISLE_ERR_ARG, aisle_astar_path(&search, path, CELLS, &length));
    TEST_ASSERT_EQUAL_UINT64(UINT64_MAX, aisle_astar_cost(&search));
    TEST_ASSERT_FALSE(aisle_astar_reached(&search, 0));
    TEST_ASSERT_TRUE(aisle_astar_invariants_hold(&search));
}

static void test_a_path_one_cell_too_long_writes_nothing_and_tells_the_need(void) {
    TEST_ASSERT_EQUAL(AISLE_OK, run_in_steps_of(9));
    const uint32_t need = length;
    memset(path, 0x77, sizeof path);
    TEST_ASSERT_EQUAL(AISLE_ERR_CAPACITY, aisle_astar_path(&search, path, need - 1, &length));
    TEST_ASSERT_EQUAL_UINT32(need, length);
    TEST_ASSERT_EQUAL_HEX32(0x77777777, path[0]);
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_astar_path(&search, path, need, &length));
    TEST_ASSERT_EQUAL_HEX32(0x77777777, path[need]);
}

static void test_no_path_is_told_while_busy(void) {
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_astar_start(&search, &cfg));
    TEST_ASSERT_EQUAL(AISLE_BUSY, aisle_astar_step(&search, 0));
    TEST_ASSERT_EQUAL_UINT32(0, search.expanded);
    TEST_ASSERT_EQUAL(AISLE_BUSY, aisle_astar_step(&search, 2));
    TEST_ASSERT_EQUAL_UINT32(2, search.expanded);
    TEST_ASSERT_EQUAL(AISLE_ERR_ARG, aisle_astar_path(&search, path, CELLS, &length));
    TEST_ASSERT_EQUAL_UINT64(UINT64_MAX, aisle_astar_cost(&search));
}

static void test_memory_is_the_stated_sum(void) {
    aisle_arena arena = aisle_arena_measure();
    aisle_astar measured;
    aisle_astar_carve(&measured, &arena, 6400, 800);
    TEST_ASSERT_EQUAL_size_t(6400 * 2 + 800 * 8 + 8192, arena.used);
}

static uint32_t wrong_answer;

static uint32_t answer_wrongly(void *ctx, uint32_t from, uint32_t to, uint8_t dir) {
    (void)ctx;
    (void)from;
    (void)dir;
    return to == 5 ? wrong_answer : 16;
}

static uint32_t bar_a_cell_already_entered(void *ctx, uint32_t from, uint32_t to, uint8_t dir) {
    (void)ctx;
    (void)dir;
    return to == 6 && from != 0 ? AISLE_ASTAR_BARRED_CELL : 160;
}

static void expect_broken_by(aisle_astar_enter_fn inlet, const char *what) {
    cfg = (aisle_astar_config){inlet, NULL, 5, 5, 0, 24};
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_astar_start(&search, &cfg));
    if (setjmp(refused) == 0) {
        (void)aisle_astar_step(&search, 100);
        TEST_FAIL_MESSAGE(what);
    }
}

static void test_answers_the_inlet_must_not_give_are_broken_invariants(void) {
    const uint32_t wrong[] = {1, 15, 257, UINT32_MAX - 1};
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        wrong_answer = wrong[i];
        expect_broken_by(answer_wrongly, "a factor out of range was accepted");
    }
    expect_broken_by(bar_a_cell_already_entered, "a cell was barred after it had been entered");
}

static void test_invariants_notice_spoilt_fields(void) {
    empty_world(20, 20);
    world.factor_max = 256;
    cfg.start = 210;
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_astar_start(&search, &cfg));
    // until some entries are stale and one was returned
    while (search.open_used < search.live + 3 || search.free_head == AISLE_ASTAR_NONE) {
        TEST_ASSERT_EQUAL(AISLE_BUSY, aisle_astar_step(&search, 1));
    }
    TEST_ASSERT_TRUE(aisle_astar_invariants_hold(&search));
    uint32_t bucket = 0;
    while (search.bucket[bucket] == AISLE_ASTAR_NONE) {
        bucket++;
    }
    const uint32_t at = search.bucket[bucket];
    uint64_t kept;
#define SPOIL(field, value)                                                                                            \
    memcpy(&kept, &search.field, sizeof search.field);                                                                 \
    search.field = (value);                                                                                            \
    TEST_ASSERT_FALSE_MESSAGE(aisle_astar_invariants_hold(&search), #field " = " #value);                              \
    memcpy(&search.field, &kept, sizeof search.field)
    SPOIL(open_used, search.open_used + 1);
    SPOIL(open_used, search.open_used - 1);
    SPOIL(open_used_max, 1);
    SPOIL(open_used_max, OPEN_NODES + 1);
    SPOIL(open_capacity, 3);
    SPOIL(capacity, 399);
    SPOIL(untouched, OPEN_NODES + 1);
    SPOIL(untouched, search.untouched + 1);
    SPOIL(live, search.live + 1);
    SPOIL(expanded, search.expanded + 1);
    SPOIL(free_head, AISLE_ASTAR_NONE);
    SPOIL(free_head, OPEN_NODES);
    SPOIL(filled[bucket / 64], 0);
    SPOIL(bucket[bucket], AISLE_ASTAR_NONE);
    SPOIL(bucket[bucket], OPEN_NODES);
    SPOIL(open[at].cell, 400);
    SPOIL(open[at].next, at);
    SPOIL(open[search.free_head].next, search.free_head);
    SPOIL(cell[210], 0);
    SPOIL(cell[399], 1);
    TEST_ASSERT_TRUE(aisle_astar_invariants_hold(&search));
}

// Recorded once: any other compiler, option or board must give the same paths.
static void test_bits_are_those_of_every_other_board(void) {
    uint32_t crc = 0;
    for (uint64_t seed = 5000; seed < 5300; seed++) {
        random_world(seed);
        (void)run_in_steps_of(17);
        for (uint32_t i = 0; i < length; i++) {
            const uint8_t bytes[2] = {(uint8_t)path[i], (uint8_t)(path[i] >> 8)};
            crc = aisle_crc32(crc, bytes, sizeof bytes);
        }
    }
    TEST_ASSERT_EQUAL_HEX32(0xCC4A2601, crc);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_cost_is_the_least_for_3000_of_3000_seeds);
    RUN_TEST(test_reached_after_partial_is_the_component_for_2000_of_2000_seeds);
    RUN_TEST(test_any_slicing_gives_the_same_bits_and_keeps_the_invariants);
    RUN_TEST(test_invariants_hold_after_every_step);
    RUN_TEST(test_a_small_open_list_gives_the_same_path_or_no_answer);
    RUN_TEST(test_a_full_open_list_stays_full_and_asks_no_more);
    RUN_TEST(test_stale_entries_do_not_fill_the_list_on_open_ground);
    RUN_TEST(test_a_cleaned_ring_gives_the_same_path_as_an_untouched_one);
    RUN_TEST(test_high_water_mark_is_kept_over_runs_and_the_second_run_equals_the_first);
    RUN_TEST(test_costs_far_beyond_the_ring_are_exact);
    RUN_TEST(test_an_empty_grid_costs_the_octile_distance);
    RUN_TEST(test_start_at_the_goal_is_a_path_of_one_cell_without_asking);
    RUN_TEST(test_a_grid_of_one_cell_works);
    RUN_TEST(test_neighbours_are_asked_about_in_the_stated_order);
    RUN_TEST(test_a_corner_of_the_grid_has_three_neighbours);
    RUN_TEST(test_start_refuses_every_bad_field_and_leaves_self_alone);
    RUN_TEST(test_a_search_never_started_answers_so);
    RUN_TEST(test_a_path_one_cell_too_long_writes_nothing_and_tells_the_need);
    RUN_TEST(test_no_path_is_told_while_busy);
    RUN_TEST(test_memory_is_the_stated_sum);
    RUN_TEST(test_answers_the_inlet_must_not_give_are_broken_invariants);
    RUN_TEST(test_invariants_notice_spoilt_fields);
    RUN_TEST(test_bits_are_those_of_every_other_board);
    return UNITY_END();
}
