#include "plan/cache.h" // first: proves that the header stands alone

#include "hall.h"

enum { PATHS = 8 };

static aisle_cache cache;
static aisle_goal_msg start, goals[AISLE_QUERY_MAX_GOALS];
static aisle_options_msg options;
static aisle_cache_question question;
static aisle_cache_found found;
static aisle_path_msg path, scratch;
static uint8_t bytes[AISLE_MSG_DATAGRAM_MAX], out[AISLE_CACHE_PATH_MAX];
static size_t size;
static const aisle_goal_msg *visited; // the goals in the path's order

// 40 x 30 m, id 1 a pillar in the middle.
void setUp(void) {
    static aisle_limits limits;
    limits = (aisle_limits){.cells = 65536U, .polygons = 64U, .vertices = 512U, .cached_paths = PATHS};
    aisle_arena arena = hall_arena(24U << 20);
    aisle_cache_carve(&cache, &arena, &limits);
    TEST_ASSERT_FALSE(arena.overflow);
    hall_begin(40.0, 30.0);
    hall_add(19.0, 14.0, 21.0, 16.0);
    hall_open(&arena, 0.2F);
    hall_disc(0.5, 0.1F);
    memset(goals, 0, sizeof goals);
    start = (aisle_goal_msg){.x = 2.0, .y = 2.0, .tolerance_theta = 4.0F};
    goals[0] = (aisle_goal_msg){.id = 11, .x = 12.0, .y = 2.0, .tolerance_theta = 4.0F};
    options = (aisle_options_msg){.objective = AISLE_OPTIONS_SHORTEST};
    visited = goals;
    question = (aisle_cache_question){.start = &start,
                                      .goals = goals,
                                      .num_goals = 1,
                                      .options = &options,
                                      .vehicle = &hall_vehicle,
                                      .layout = &hall_layout};
}
void tearDown(void) {
    TEST_ASSERT_TRUE(aisle_cache_invariants_hold(&cache));
}

// ---- helpers

// A path of n waypoints on the straight way to the first goal, 1 m of clearance all along.
static void make_path(int16_t n) {
    memset(&path, 0, sizeof path);
    path.map_id = 1;
    path.map_revision = aisle_layout_map_revision(&hall_layout);
    path.num_waypoints = n;
    for (int16_t i = 0; i < n; i++) {
        double f = (double)i / (n - 1);
        aisle_waypoint_msg *w = &path.waypoints[i];
        w->x = start.x + f * (goals[0].x - start.x);
        w->y = start.y + f * (goals[0].y - start.y);
        w->s = (float)hypot(w->x - start.x, w->y - start.y);
        w->clearance = 1.0F;
    }
    path.waypoints[n - 1].flags = AISLE_WAYPOINT_GOAL;
    path.waypoints[n - 1].goal_id = 11;
    path.length = path.waypoints[n - 1].s;
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_path_encode(&path, bytes, sizeof bytes, &size));
}

static void put_worth(double value) {
    aisle_cache_answer answer = {.bytes = bytes, .size = size, .path = &path, .goals = visited, .value = value};
    answer.basis.waypoints = aisle_crc32(0, bytes + AISLE_PATH_AT_WAYPOINTS, size - AISLE_PATH_AT_WAYPOINTS);
    answer.basis.size = (uint32_t)size;
    aisle_cache_put(&cache, &question, &answer);
    TEST_ASSERT_TRUE(aisle_cache_invariants_hold(&cache));
}

static void put(int16_t n) {
    make_path(n);
    put_worth((double)path.length);
}

static uint32_t find(void) {
    memset(out, 0, sizeof out);
    return aisle_cache_find(&cache, &question, out, &found);
}

static bool is_known(void) {
    return find() != AISLE_CACHE_NONE;
}

// Puts the boxes as they stand now, with these ids, in the place of all polygons.
static void change(const int32_t *ids) {
    static aisle_layout_patch_msg patch;
    memset(&patch, 0, sizeof patch);
    patch.map_id = 1;
    patch.base_revision = aisle_layout_map_revision(&hall_layout);
    patch.map_revision = patch.base_revision + 1;
    const aisle_layout_msg *msg = hall_message(1, 0.2F);
    for (uint32_t i = 0; i < aisle_layout_zone_count(&hall_layout); i++) {
        int32_t id = aisle_layout_zone(&hall_layout, i)->id;
        bool stays = false;
        for (int k = 0; k < hall_count; k++) {
            stays = stays || ids[k] == id;
        }
        if (!stays) {
            patch.removed[patch.num_removed++] = id;
        }
    }
    for (int k = 0; k < hall_count; k++) {
        patch.polygons[patch.num_polygons] = msg->polygons[k];
        patch.polygons[patch.num_polygons++].id = ids[k];
    }
    aisle_refusal why;
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_layout_take_patch(&hall_layout, &patch, &why));
    aisle_layout_commit(&hall_layout);
    while (aisle_layout_build(&hall_layout, 1000) == AISLE_BUSY) {
    }
}

static void take_in(uint32_t units) {
    int64_t before = cache.kept + cache.dropped + cache.spoiled;
    aisle_cache_change_begin(&cache, &hall_layout, &scratch, out);
    while (aisle_cache_change_step(&cache, units) == AISLE_BUSY) {
    }
    TEST_ASSERT_LESS_OR_EQUAL_INT64(before + PATHS, cache.kept + cache.dropped + cache.spoiled);
}

// The layout the entries are of is known to the cache.
static void know_layout(void) {
    take_in(1000);
    cache.kept = cache.dropped = 0;
}

// ---- questions

static void test_what_was_put_is_found_byte_for_byte(void) {
    TEST_ASSERT_FALSE(is_known());
    put(50);
    uint32_t at = find();
    TEST_ASSERT_NOT_EQUAL(AISLE_CACHE_NONE, at);
    TEST_ASSERT_EQUAL_size_t(size, found.size);
    TEST_ASSERT_EQUAL_MEMORY(bytes, out, size);
    TEST_ASSERT_EQUAL_UINT32(size, found.basis.size);
    TEST_ASSERT_EQUAL_INT64(1, cache.misses);
    TEST_ASSERT_EQUAL_INT64(0, cache.hits); // not before it is proved
    aisle_cache_confirm(&cache, at, &found.basis);
    TEST_ASSERT_EQUAL_INT64(1, cache.hits);
}

static void test_every_size_of_path_comes_back_whole(void) {
    for (int16_t n = 2; n <= AISLE_PATH_MAX_WAYPOINTS; n = (int16_t)(n < 40 ? n + 1 : n + 61)) {
        put(n);
        TEST_ASSERT_TRUE(is_known());
        TEST_ASSERT_EQUAL_size_t(size, found.size);
        TEST_ASSERT_EQUAL_MEMORY(bytes, out, size);
        TEST_ASSERT_EQUAL_UINT32(1, aisle_cache_count(&cache));
    }
    put(AISLE_PATH_MAX_WAYPOINTS);
    TEST_ASSERT_TRUE(is_known());
}

static void test_stops_are_part_of_the_question(void) {
    question.num_goals = 2;
    put(10);
    aisle_goal_msg *stops[3] = {&start, &goals[0], &goals[1]};
    for (int i = 0; i < 3; i++) {
        aisle_goal_msg was = *stops[i];
        for (int field = 0; field < 7; field++) {
            stops[i]->id += field == 0 ? 1 : 0;
            stops[i]->x += field == 1 ? 1e-9 : 0.0;
            stops[i]->y += field == 2 ? 1e-9 : 0.0;
            stops[i]->theta += field == 3 ? 1e-9 : 0.0;
            stops[i]->tolerance_xy += field == 4 ? 0.001F : 0.0F;
            stops[i]->tolerance_theta += field == 5 ? 0.001F : 0.0F;
            stops[i]->dwell += field == 6 ? 0.001F : 0.0F;
            TEST_ASSERT_FALSE(is_known());
            *stops[i] = was;
            TEST_ASSERT_TRUE(is_known());
        }
    }
    question.num_goals = 1;
    TEST_ASSERT_FALSE(is_known());
    question.num_goals = 2;
    goals[1] = goals[0];
    TEST_ASSERT_FALSE(is_known());
}

static void test_options_and_ordering_are_part_of_the_question(void) {
    put(10);
    for (int field = 0; field < 10; field++) {
        aisle_options_msg was = options;
        options.planner = (int8_t)(options.planner + (field == 0));
        options.objective = (int8_t)(options.objective + (field == 1));
        options.interpolation = (int8_t)(options.interpolation + (field == 2));
        options.num_samples = (int16_t)(options.num_samples + (field == 3));
        options.seed += field == 4;
        options.work_units += field == 5;
        options.risk_weight += field == 6 ? 1.0F : 0.0F;
        options.step += field == 7 ? 1.0F : 0.0F;
        options.zone += field == 8 ? 1.0F : 0.0F;
        question.ordering = (int8_t)(field == 9 ? AISLE_GOAL_LIST_ANY_ORDER : AISLE_GOAL_LIST_ORDERED);
        TEST_ASSERT_FALSE(is_known());
        options = was;
        question.ordering = AISLE_GOAL_LIST_ORDERED;
        TEST_ASSERT_TRUE(is_known());
    }
}

static void test_the_vehicle_is_part_of_the_question_but_not_its_revision(void) {
    hall_rectangle(1.0, 0.7, 0.1F);
    put(10);
    aisle_vehicle was = hall_vehicle;
    double *numbers[] = {&hall_vehicle.radius,
                         &hall_vehicle.v_max,
                         &hall_vehicle.v_reverse_max,
                         &hall_vehicle.a_max,
                         &hall_vehicle.d_max,
                         &hall_vehicle.omega_max,
                         &hall_vehicle.alpha_max,
                         &hall_vehicle.lateral_a_max,
                         &hall_vehicle.curvature_max,
                         &hall_vehicle.reaction_time,
                         &hall_vehicle.margin,
                         &hall_vehicle.creep_clearance,
                         &hall_vehicle.creep_speed,
                         &hall_vehicle.mass,
                         &hall_vehicle.rolling_resistance,
                         &hall_vehicle.idle_power,
                         &hall_vehicle.drive_efficiency};
    for (size_t i = 0; i < sizeof numbers / sizeof numbers[0]; i++) {
        *numbers[i] += 1e-9;
        TEST_ASSERT_FALSE(is_known());
        hall_vehicle = was;
    }
    for (int i = 0; i < 4; i++) {
        hall_vehicle.footprint[i].y += 1e-9;
        TEST_ASSERT_FALSE(is_known());
        hall_vehicle = was;
    }
    hall_vehicle.drive = AISLE_VEHICLE_OMNI;
    TEST_ASSERT_FALSE(is_known());
    hall_vehicle = was;
    hall_vehicle.revision++;
    TEST_ASSERT_TRUE(is_known());
}

static void test_the_order_of_the_goals_comes_back_with_the_path(void) {
    static aisle_goal_msg other[4];
    question.num_goals = 4;
    question.ordering = AISLE_GOAL_LIST_ANY_ORDER;
    goals[1] = goals[3] = (aisle_goal_msg){.id = 12, .x = 3.0}; // twice the same
    goals[2] = (aisle_goal_msg){.id = 13, .x = 4.0, .dwell = 1.0F};
    const uint8_t order[4] = {2, 1, 0, 3};
    for (int i = 0; i < 4; i++) {
        other[i] = goals[order[i]];
    }
    visited = other;
    put(10);
    uint32_t at = find();
    TEST_ASSERT_EQUAL_MEMORY(order, found.order, 4);
    cache.entries[at].order[1] = 3;
    TEST_ASSERT_FALSE(is_known());
    TEST_ASSERT_EQUAL_INT64(1, cache.spoiled);
}

static void test_an_equal_hash_alone_is_no_hit(void) {
    put(10);
    goals[0].x += 1.0;
    TEST_ASSERT_FALSE(is_known()); // the key in hand is the other question's now
    for (int i = 0; i < PATHS; i++) {
        cache.entries[i].hash = cache.hash;
    }
    TEST_ASSERT_FALSE(is_known());
}

static void test_padding_of_messages_is_no_part_of_the_question(void) {
    put(10);
    aisle_goal_msg other;
    memset(&other, 0xA5, sizeof other);
    other.id = goals[0].id;
    other.x = goals[0].x;
    other.y = goals[0].y;
    other.theta = goals[0].theta;
    other.tolerance_xy = goals[0].tolerance_xy;
    other.tolerance_theta = goals[0].tolerance_theta;
    other.dwell = goals[0].dwell;
    memcpy(&goals[0], &other, sizeof other);
    TEST_ASSERT_TRUE(is_known());
}

// ---- room

static void ask_number(int i) {
    goals[0].id = 100 + i;
}

static void test_the_least_recently_used_answer_leaves(void) {
    for (int i = 0; i < PATHS; i++) {
        ask_number(i);
        put(10);
    }
    ask_number(0);
    TEST_ASSERT_TRUE(is_known()); // used again
    ask_number(PATHS);
    put(10);
    for (int i = 0; i <= PATHS; i++) {
        ask_number(i);
        TEST_ASSERT_EQUAL(i != 1, is_known());
    }
}

static void test_a_readonly_question_finds_and_leaves_no_trace(void) {
    for (int i = 0; i < PATHS; i++) {
        ask_number(i);
        put(10);
    }
    ask_number(0);
    question.readonly = true;
    uint32_t at = find();
    TEST_ASSERT_NOT_EQUAL(AISLE_CACHE_NONE, at);
    aisle_cache_confirm(&cache, at, NULL);
    TEST_ASSERT_EQUAL_UINT32(size, cache.entries[at].basis.size);
    TEST_ASSERT_EQUAL_INT64(1, cache.hits);
    question.readonly = false;
    ask_number(PATHS);
    put(10);
    ask_number(0);
    TEST_ASSERT_FALSE(is_known()); // was the least recently used all the same
}

static void test_the_same_question_takes_the_place_of_the_old_answer(void) {
    put(10);
    put(20);
    TEST_ASSERT_EQUAL_UINT32(1, aisle_cache_count(&cache));
    TEST_ASSERT_TRUE(is_known());
    TEST_ASSERT_EQUAL_size_t(size, found.size);
}

static void test_a_long_path_takes_the_place_of_several(void) {
    for (int i = 0; i < PATHS; i++) {
        ask_number(i);
        put(140); // 7.7 kB: all the room there is, nearly
    }
    uint32_t before = aisle_cache_count(&cache);
    ask_number(PATHS);
    put(AISLE_PATH_MAX_WAYPOINTS);
    TEST_ASSERT_TRUE(is_known());
    TEST_ASSERT_LESS_THAN_UINT32(before, aisle_cache_count(&cache));
}

static void test_blocks_are_neither_lost_nor_shared(void) {
    aisle_rng rng = aisle_rng_seed(7);
    for (int i = 0; i < 5000; i++) {
        ask_number((int)(aisle_rng_next(&rng) % 20U));
        if (aisle_rng_next(&rng) % 3U == 0U) {
            put((int16_t)(2U + aisle_rng_next(&rng) % (i % 10 == 0 ? 1000U : 200U)));
        } else if (is_known() && aisle_rng_next(&rng) % 4U == 0U) {
            aisle_cache_disprove(&cache, find());
        }
        TEST_ASSERT_TRUE(aisle_cache_invariants_hold(&cache));
    }
    TEST_ASSERT_GREATER_THAN_INT64(0, cache.spoiled);
}

static void test_spoiled_bytes_before_the_waypoints_are_seen(void) {
    for (size_t i = 0; i < AISLE_PATH_AT_WAYPOINTS; i++) {
        put(10);
        uint32_t at = find();
        aisle_cache_block *block = aisle_pool_at(&cache.blocks, cache.entries[at].first);
        size_t byte = cache.entries[at].key_size + i; // of the entry
        for (; byte >= AISLE_CACHE_BLOCK; byte -= AISLE_CACHE_BLOCK) {
            block = aisle_pool_at(&cache.blocks, block->next);
        }
        block->bytes[byte] ^= (uint8_t)(1U << (i % 8U));
        int64_t misses = cache.misses;
        TEST_ASSERT_FALSE(is_known());
        TEST_ASSERT_EQUAL_INT64((int64_t)i + 1, cache.spoiled);
        TEST_ASSERT_EQUAL_INT64(misses + 1, cache.misses);
        TEST_ASSERT_EQUAL_UINT32(0, aisle_cache_count(&cache));
    }
}

// ---- detours

static void test_a_detour_is_the_shortest_way_over_a_place_of_the_box(void) {
    aisle_rng rng = aisle_rng_seed(3);
    for (int i = 0; i < 3000; i++) {
        aisle_vec2 lo = {-10.0, -10.0}, hi = {10.0, 10.0};
        aisle_vec2 p = uniform_point(&rng, lo, hi), a = uniform_point(&rng, lo, hi), b = uniform_point(&rng, lo, hi);
        aisle_vec2 side = uniform_point(&rng, aisle_vec2_of(0.0, 0.0), aisle_vec2_of(6.0, 6.0));
        b = i % 10 == 0 ? a : b;
        b.y = i % 7 == 0 ? a.y : b.y;
        aisle_aabb box = {p, aisle_vec2_add(p, side)};
        double least = 1e9;
        for (int u = 0; u <= 100; u++) {
            for (int v = 0; v <= 100; v++) {
                double x = p.x + side.x * u / 100.0, y = p.y + side.y * v / 100.0;
                least = fmin(least, hypot(x - a.x, y - a.y) + hypot(x - b.x, y - b.y));
            }
        }
        double told = aisle_cache_detour(box, a, b);
        TEST_ASSERT_TRUE(told <= least + 1e-12);
        TEST_ASSERT_DOUBLE_WITHIN(0.09, least, told);
        TEST_ASSERT_TRUE(told >= hypot(a.x - b.x, a.y - b.y) - 1e-12);
    }
}

// ---- layouts

static void test_a_polygon_that_comes_keeps_what_it_does_not_come_near(void) {
    static const int32_t ids[] = {1, 2};
    know_layout();
    put(30);
    hall_add(6.0, 3.51, 8.0, 4.5); // 0.01 m beyond the outer radius and the clearance told, 1 m
    change(ids);
    TEST_ASSERT_FALSE(is_known());
    take_in(1);
    TEST_ASSERT_EQUAL_INT64(1, cache.kept);
    TEST_ASSERT_TRUE(is_known());
    TEST_ASSERT_EQUAL_MEMORY(bytes, out, size);
}

static void test_a_polygon_that_comes_too_near_drops_what_it_touches(void) {
    static const int32_t ids[] = {1, 2};
    know_layout();
    put(30);
    hall_add(6.0, 3.49, 8.0, 4.5);
    change(ids);
    take_in(1);
    TEST_ASSERT_EQUAL_INT64(0, cache.kept);
    TEST_ASSERT_EQUAL_INT64(1, cache.dropped);
    TEST_ASSERT_FALSE(is_known());
}

// Half a circle of 5 m above the chord: its top is at y = 7.
static void test_an_arc_is_touched_where_it_runs_not_where_its_chord_does(void) {
    static const int32_t ids[] = {1, 2};
    for (int near = 0; near < 2; near++) {
        setUp();
        know_layout();
        make_path(2);
        path.waypoints[1].curvature = -0.2F;
        TEST_ASSERT_EQUAL(AISLE_OK, aisle_path_encode(&path, bytes, sizeof bytes, &size));
        put_worth(15.7);
        double y = near != 0 ? 8.49 : 8.51;
        hall_add(6.9, y, 7.1, y + 0.5);
        change(ids);
        take_in(1000);
        TEST_ASSERT_EQUAL(near == 0, is_known());
    }
}

static void test_what_was_dropped_serves_when_its_layout_comes_back(void) {
    static const int32_t ids[] = {1, 2};
    know_layout();
    put(30);
    hall_add(6.0, 1.0, 8.0, 3.0); // a door that shuts
    change(ids);
    take_in(1000);
    TEST_ASSERT_FALSE(is_known());
    hall_count--; // and opens
    change(ids);
    take_in(1000);
    TEST_ASSERT_TRUE(is_known());
    TEST_ASSERT_EQUAL_MEMORY(bytes, out, size);
}

// Remembers the way from (2, 2) to (12, 2) as 14 m long, removes a box at a distance of `away` beyond it.
static bool is_kept_when_removed(int8_t objective, double away, double worth) {
    static const int32_t ids[] = {1, 2};
    setUp();
    options.objective = objective;
    know_layout();
    hall_add(6.0, 2.0 + away, 8.0, 2.5 + away);
    change(ids);
    take_in(1000);
    make_path(30);
    path.length = path.waypoints[29].s = 14.0F; // a way round something
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_path_encode(&path, bytes, sizeof bytes, &size));
    put_worth(worth);
    hall_count--;
    change(ids);
    take_in(7);
    TEST_ASSERT_EQUAL_INT64(1, cache.kept + cache.dropped);
    return is_known();
}

// Ellipse: foci 10 m apart, 14 m round: half axis sqrt(7^2 - 5^2) = 4.899; a way passes the box at outer radius + creep
// clearance, 1 m.
static void test_a_polygon_that_leaves_keeps_what_no_way_through_its_place_can_better(void) {
    TEST_ASSERT_TRUE(is_kept_when_removed(AISLE_OPTIONS_SHORTEST, 5.95, 14.0));
    TEST_ASSERT_FALSE(is_kept_when_removed(AISLE_OPTIONS_SHORTEST, 5.85, 14.0));
}

// Worth 18 m of its objective: sqrt(9^2 - 5^2) = 7.483.
static void test_a_path_worse_than_its_length_may_be_bettered_from_farther_away(void) {
    TEST_ASSERT_FALSE(is_kept_when_removed(AISLE_OPTIONS_SAFEST, 8.4, 18.0));
    TEST_ASSERT_TRUE(is_kept_when_removed(AISLE_OPTIONS_SAFEST, 8.6, 18.0));
}

// Of a way with less risk nothing is known: it may come from anywhere.
static void test_a_path_with_risk_stays_only_where_nothing_leaves(void) {
    static const int32_t ids[] = {1, 2};
    TEST_ASSERT_TRUE(is_kept_when_removed(AISLE_OPTIONS_SAFEST, 20.0, 14.0));
    TEST_ASSERT_FALSE(is_kept_when_removed(AISLE_OPTIONS_SAFEST, 20.0, 3.0 * 1048576.0 + 14.0));
    TEST_ASSERT_FALSE(is_kept_when_removed(AISLE_OPTIONS_PAPER, 20.0, 14.0));
    put(30);
    hall_add(6.0, 22.0, 8.0, 22.5);
    change(ids);
    take_in(1000);
    TEST_ASSERT_TRUE(is_known());
}

static void is_objective_worth(int8_t objective, double value, double metres) {
    know_layout();
    options.objective = objective;
    put(30);
    make_path(30);
    put_worth(value);
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, metres < 0.0 ? -1.0 : metres - 10.0, cache.entries[0].excess);
    setUp();
}

static void test_worth_is_counted_in_metres_of_unhindered_way(void) {
    hall_disc(0.5, 0.1F); // v 1.5 m/s, 500 kg, 0.015, 50 W, 0.8
    is_objective_worth(AISLE_OPTIONS_SHORTEST, 10.0, 10.0);
    is_objective_worth(AISLE_OPTIONS_SAFEST, 13.0, 13.0);
    is_objective_worth(AISLE_OPTIONS_SAFEST, 1048576.0 + 10.0,
                       -1.0); // any risk: nothing is known of a safer way's length
    is_objective_worth(AISLE_OPTIONS_FASTEST, 10.0, 15.0);
    is_objective_worth(AISLE_OPTIONS_PAPER, 10.0, -1.0);
    aisle_vehicle v = hall_vehicle;
    double rate = v.mass * 9.8 * v.rolling_resistance / v.drive_efficiency + v.idle_power / v.v_max;
    is_objective_worth(AISLE_OPTIONS_LEAST_ENERGY, 20.0 * rate, 20.0);
    question.num_goals = 2;
    goals[0].dwell = 4.0F;
    goals[1].dwell = 100.0F; // after the arrival
    options.objective = AISLE_OPTIONS_FASTEST;
    make_path(30);
    put_worth(14.0);
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, 5.0, cache.entries[0].excess);
}

static void test_in_any_order_the_whole_path_counts(void) {
    static const int32_t ids[] = {1, 2};
    for (int any = 0; any < 2; any++) {
        setUp();
        know_layout();
        hall_add(6.0, 12.0, 8.0, 12.5); // a way over its place is no shorter than 2 * hypot(5, 9) = 20.6 m
        change(ids);
        take_in(1000);
        question.num_goals = 2;
        question.ordering = (int8_t)any;
        goals[1] = (aisle_goal_msg){.id = 12, .x = 12.0, .y = 2.0};
        make_path(31);
        path.waypoints[15].flags = AISLE_WAYPOINT_GOAL; // two legs of 15 m, 30 in all
        path.waypoints[15].s = 15.0F;
        path.length = path.waypoints[30].s = 30.0F;
        TEST_ASSERT_EQUAL(AISLE_OK, aisle_path_encode(&path, bytes, sizeof bytes, &size));
        put_worth(30.0);
        hall_count--;
        change(ids);
        take_in(1000);
        TEST_ASSERT_EQUAL(any == 0, is_known());
    }
}

// Lost to a box that came: to be repaired on that layout, with its worth, until something leaves that may better it.
static void test_what_a_polygon_has_blocked_can_be_repaired_until_ground_is_freed(void) {
    know_layout();
    make_path(40);
    aisle_cache_answer answer = {
        .bytes = bytes, .size = size, .path = &path, .goals = visited, .value = 12.0, .worth = 9.5};
    answer.basis.waypoints = aisle_crc32(0, bytes + AISLE_PATH_AT_WAYPOINTS, size - AISLE_PATH_AT_WAYPOINTS);
    aisle_cache_put(&cache, &question, &answer);
    TEST_ASSERT_EQUAL(AISLE_CACHE_NONE, aisle_cache_find_repairable(&cache, &question, out, &found)); // it is good
    hall_add(6.9, 1.9, 7.1, 2.1);
    change((const int32_t[]){1, 2});
    take_in(1);
    TEST_ASSERT_FALSE(is_known());
    TEST_ASSERT_NOT_EQUAL(AISLE_CACHE_NONE, aisle_cache_find_repairable(&cache, &question, out, &found));
    TEST_ASSERT_EQUAL_size_t(size, found.size);
    TEST_ASSERT_EQUAL_MEMORY(bytes, out, size);
    TEST_ASSERT_TRUE(found.worth >= 9.5 && found.worth <= 9.5);
    hall_add(34.0, 24.0, 35.0, 25.0); // far away
    change((const int32_t[]){1, 2, 3});
    take_in(1);
    TEST_ASSERT_NOT_EQUAL(AISLE_CACHE_NONE, aisle_cache_find_repairable(&cache, &question, out, &found));
    options.objective = AISLE_OPTIONS_FASTEST; // another question
    TEST_ASSERT_EQUAL(AISLE_CACHE_NONE, aisle_cache_find_repairable(&cache, &question, out, &found));
    options.objective = AISLE_OPTIONS_SHORTEST;
    hall_boxes[1] = hall_boxes[2]; // id 2 goes
    hall_count = 2;
    change((const int32_t[]){1, 3});
    take_in(1);
    TEST_ASSERT_EQUAL(AISLE_CACHE_NONE, aisle_cache_find_repairable(&cache, &question, out, &found));
    TEST_ASSERT_EQUAL_INT64(1, cache.dropped);
}

static void test_the_same_layout_said_again_keeps_everything(void) {
    aisle_refusal why;
    know_layout();
    put(30);
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_layout_take_part(&hall_layout, hall_message(9, 0.2F), &why));
    aisle_layout_commit(&hall_layout);
    while (aisle_layout_build(&hall_layout, 1000) == AISLE_BUSY) {
    }
    take_in(1);
    TEST_ASSERT_EQUAL_INT64(1, cache.kept);
    TEST_ASSERT_TRUE(is_known());
}

static void test_another_layout_keeps_nothing(void) {
    aisle_refusal why;
    know_layout();
    put(30);
    hall_add(30.0, 25.0, 31.0, 26.0);
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_layout_take_part(&hall_layout, hall_message(9, 0.2F), &why));
    aisle_layout_commit(&hall_layout);
    while (aisle_layout_build(&hall_layout, 1000) == AISLE_BUSY) {
    }
    take_in(1);
    TEST_ASSERT_EQUAL_INT64(1, cache.dropped);
    TEST_ASSERT_FALSE(is_known());
}

static void test_a_path_spoiled_before_a_change_is_not_taken_over(void) {
    static const int32_t ids[] = {1, 2};
    know_layout();
    put(30);
    aisle_cache_block *block = aisle_pool_at(&cache.blocks, cache.entries[0].first);
    block = aisle_pool_at(&cache.blocks, block->next);
    block->bytes[400] ^= 4U;
    hall_add(30.0, 25.0, 31.0, 26.0);
    change(ids);
    take_in(1000);
    TEST_ASSERT_EQUAL_INT64(1, cache.spoiled);
    TEST_ASSERT_EQUAL_UINT32(0, aisle_cache_count(&cache));
}

static void test_a_change_taken_in_any_slices_keeps_the_same(void) {
    static const uint32_t slices[] = {1, 3, 50, UINT32_MAX};
    static const int32_t ids[] = {1, 2, 3};
    int64_t kept[4], dropped[4];
    for (int i = 0; i < 4; i++) {
        setUp();
        know_layout();
        for (int q = 0; q < PATHS; q++) {
            ask_number(q);
            goals[0].y = 2.0 + 3.0 * q;
            put(40);
        }
        hall_add(6.0, 10.0, 8.0, 12.0);
        hall_add(10.0, 12.0, 12.0, 14.0);
        change(ids);
        take_in(slices[i]);
        kept[i] = cache.kept;
        dropped[i] = cache.dropped;
        TEST_ASSERT_EQUAL_INT64(kept[0], kept[i]);
        TEST_ASSERT_EQUAL_INT64(dropped[0], dropped[i]);
    }
    TEST_ASSERT_GREATER_THAN_INT64(0, kept[0]);
    TEST_ASSERT_GREATER_THAN_INT64(0, dropped[0]);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_what_was_put_is_found_byte_for_byte);
    RUN_TEST(test_every_size_of_path_comes_back_whole);
    RUN_TEST(test_stops_are_part_of_the_question);
    RUN_TEST(test_options_and_ordering_are_part_of_the_question);
    RUN_TEST(test_the_vehicle_is_part_of_the_question_but_not_its_revision);
    RUN_TEST(test_the_order_of_the_goals_comes_back_with_the_path);
    RUN_TEST(test_an_equal_hash_alone_is_no_hit);
    RUN_TEST(test_padding_of_messages_is_no_part_of_the_question);
    RUN_TEST(test_the_least_recently_used_answer_leaves);
    RUN_TEST(test_a_readonly_question_finds_and_leaves_no_trace);
    RUN_TEST(test_the_same_question_takes_the_place_of_the_old_answer);
    RUN_TEST(test_a_long_path_takes_the_place_of_several);
    RUN_TEST(test_blocks_are_neither_lost_nor_shared);
    RUN_TEST(test_spoiled_bytes_before_the_waypoints_are_seen);
    RUN_TEST(test_a_detour_is_the_shortest_way_over_a_place_of_the_box);
    RUN_TEST(test_a_polygon_that_comes_keeps_what_it_does_not_come_near);
    RUN_TEST(test_a_polygon_that_comes_too_near_drops_what_it_touches);
    RUN_TEST(test_an_arc_is_touched_where_it_runs_not_where_its_chord_does);
    RUN_TEST(test_what_was_dropped_serves_when_its_layout_comes_back);
    RUN_TEST(test_a_polygon_that_leaves_keeps_what_no_way_through_its_place_can_better);
    RUN_TEST(test_a_path_worse_than_its_length_may_be_bettered_from_farther_away);
    RUN_TEST(test_a_path_with_risk_stays_only_where_nothing_leaves);
    RUN_TEST(test_worth_is_counted_in_metres_of_unhindered_way);
    RUN_TEST(test_in_any_order_the_whole_path_counts);
    RUN_TEST(test_what_a_polygon_has_blocked_can_be_repaired_until_ground_is_freed);
    RUN_TEST(test_the_same_layout_said_again_keeps_everything);
    RUN_TEST(test_another_layout_keeps_nothing);
    RUN_TEST(test_a_path_spoiled_before_a_change_is_not_taken_over);
    RUN_TEST(test_a_change_taken_in_any_slices_keeps_the_same);
    return UNITY_END();
}
