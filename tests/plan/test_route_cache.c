#include "plan/planner_state.h"

#include "cases.h"
#include "door.h"

#include <stdio.h>
#include <stdlib.h>

enum { BOXES = 14, QUESTIONS = 12, OTHER = 1 };

static aisle_pose_msg here;
static aisle_path_msg first;
static aisle_layout_patch_msg patch;
static int32_t revision;

static int64_t count(aisle_counter counter) {
    return aisle_planner_counters(door)[counter];
}

// 30 x 20 m with one pillar in the middle, id 1.
void setUp(void) {
    door_config = (aisle_config){
        .limits = {.cells = 65536U, .requests = 4U, .cached_paths = 16U}, .boot_id = 77, .has_vehicle = true};
    hall_rectangle(1.0, 0.7, 0.1F);
    hall_begin(30.0, 20.0);
    hall_add(14.0, 9.0, 16.0, 11.0);
    door_open(0);
    revision = 1;
    TEST_ASSERT_EQUAL(AISLE_OK, door_submit(AISLE_INPUT_LAYOUT, hall_message(1, 0.1F)));
    door_settle();
}
void tearDown(void) {}

static aisle_query_msg question(int32_t id) {
    aisle_query_msg query = door_query(id, 10.0, 10.0, 20.0, 10.0);
    query.options.planner = AISLE_OPTIONS_AUTO;
    return query;
}

// Adds, or moves, box i, of id i + 1.
static void begin_patch(void) {
    memset(&patch, 0, sizeof patch);
    patch.map_id = 1;
    patch.base_revision = revision;
    patch.map_revision = ++revision;
}

static void put_box(int32_t id, hall_box b) {
    const double v[4][2] = {{b.x0, b.y0}, {b.x1, b.y0}, {b.x1, b.y1}, {b.x0, b.y1}};
    aisle_polygon_msg *polygon = &patch.polygons[patch.num_polygons++];
    polygon->id = id;
    polygon->num_vertices = 4;
    memcpy(polygon->vertices, v, sizeof v);
}

static void send_patch(void) {
    TEST_ASSERT_EQUAL(AISLE_OK, door_submit(AISLE_INPUT_LAYOUT_PATCH, &patch));
    door_settle();
}

static void assert_same_way(const aisle_path_msg *a, const aisle_path_msg *b) {
    TEST_ASSERT_EQUAL_INT16(a->num_waypoints, b->num_waypoints);
    for (int16_t i = 0; i < a->num_waypoints; i++) {
        TEST_ASSERT_EQUAL_MEMORY(&a->waypoints[i].x, &b->waypoints[i].x, 3 * sizeof(double));
        TEST_ASSERT_EQUAL_MEMORY(&a->waypoints[i].s, &b->waypoints[i].s, 6 * sizeof(float));
        TEST_ASSERT_EQUAL_INT16(a->waypoints[i].flags, b->waypoints[i].flags);
        TEST_ASSERT_EQUAL_INT32(a->waypoints[i].goal_id, b->waypoints[i].goal_id);
    }
    TEST_ASSERT_EQUAL_FLOAT(a->length, b->length);
    TEST_ASSERT_EQUAL_FLOAT(a->length_bound, b->length_bound);
    TEST_ASSERT_EQUAL_FLOAT(a->duration, b->duration);
    TEST_ASSERT_EQUAL_FLOAT(a->energy, b->energy);
    TEST_ASSERT_EQUAL_FLOAT(a->risk, b->risk);
    TEST_ASSERT_EQUAL_FLOAT(a->clearance_min, b->clearance_min);
    TEST_ASSERT_EQUAL_INT8(a->planner, b->planner);
}

// ---- hits

static void test_a_question_asked_again_is_answered_from_memory(void) {
    aisle_query_msg query = question(5);
    first = *door_ask(&query);
    TEST_ASSERT_EQUAL_INT8(0, first.cached);
    query.query_id = 6;
    door_now += 3000000;
    const aisle_path_msg *again = door_ask(&query);
    TEST_ASSERT_EQUAL_INT8(1, again->cached);
    assert_same_way(&first, again);
    TEST_ASSERT_EQUAL_INT32(6, again->query_id);
    TEST_ASSERT_EQUAL_INT64(door_now, again->utime);
    TEST_ASSERT_EQUAL_INT64(door_now, again->t0_utime);
    TEST_ASSERT_EQUAL_INT64(door_now + AISLE_LEASE_US, again->valid_until_utime);
    TEST_ASSERT_EQUAL_INT32((int32_t)aisle_path_certificate(again), again->certificate);
    TEST_ASSERT_LESS_THAN_INT32(first.work_units / 100, again->work_units);
    TEST_ASSERT_EQUAL_INT64(1, count(AISLE_COUNTER_CACHE_HITS));
    TEST_ASSERT_EQUAL_INT64(1, count(AISLE_COUNTER_CACHE_MISSES));
    TEST_ASSERT_EQUAL_INT64(2, count(AISLE_COUNTER_PATHS));
    (void)door_judge(again);
}

// A bred way is remembered as any other, under its own question.
static void test_the_genetic_search_s_answer_is_remembered_until_its_ground_changes(void) {
    aisle_query_msg query = question(5);
    query.options.planner = AISLE_OPTIONS_GA;
    query.options.step = 0.5F;
    first = *door_ask(&query);
    TEST_ASSERT_EQUAL_INT8(0, first.cached);
    TEST_ASSERT_EQUAL_INT8(AISLE_OPTIONS_GA, first.planner);
    const aisle_path_msg *again = door_ask(&query);
    TEST_ASSERT_EQUAL_INT8(1, again->cached);
    assert_same_way(&first, again);
    aisle_query_msg other = query; // not the same question
    other.options.step = 0.8F;
    TEST_ASSERT_EQUAL_INT8(0, door_ask(&other)->cached);
    other = query;
    other.options.seed = 9;
    TEST_ASSERT_EQUAL_INT8(0, door_ask(&other)->cached);
    other = query;
    other.options.planner = AISLE_OPTIONS_AUTO;
    TEST_ASSERT_EQUAL_INT8(0, door_ask(&other)->cached);
    begin_patch();
    const aisle_waypoint_msg *middle = &first.waypoints[first.num_waypoints / 2];
    put_box(2, (hall_box){middle->x - 0.3, middle->y - 0.3, middle->x + 0.3, middle->y + 0.3});
    hall_add(middle->x - 0.3, middle->y - 0.3, middle->x + 0.3, middle->y + 0.3);
    send_patch();
    const aisle_path_msg *anew = door_ask(&query);
    TEST_ASSERT_EQUAL_INT8(0, anew->cached);
    TEST_ASSERT_EQUAL_INT8(AISLE_OPTIONS_GA, anew->planner);
    (void)door_judge(anew);
}

// But for what names it and its flag the answer is what a planner without memory would send.
static void test_a_remembered_answer_has_the_head_of_a_fresh_one(void) {
    aisle_query_msg query = question(5);
    (void)door_ask(&query);
    query.query_id = 6;
    (void)door_ask(&query);
    static uint8_t remembered[65536];
    aisle_path_msg again = door_reply;
    again.cached = 0;
    again.work_units = 0;
    size_t size = 0, fresh_size = 0;
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_path_encode(&again, remembered, sizeof remembered, &size));
    door_config.forgetful = true;
    door_open(OTHER);
    TEST_ASSERT_EQUAL(AISLE_OK, door_submit(AISLE_INPUT_LAYOUT, hall_message(1, 0.1F)));
    door_settle();
    static uint8_t fresh[65536];
    aisle_path_msg other = *door_ask(&query);
    TEST_ASSERT_EQUAL_INT8(0, other.cached);
    other.work_units = 0;
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_path_encode(&other, fresh, sizeof fresh, &fresh_size));
    TEST_ASSERT_EQUAL_size_t(fresh_size, size);
    TEST_ASSERT_EQUAL_MEMORY(fresh, remembered, size);
}

// The best order is found once: remembered, it is taken as it was, whatever order the goals are told in is another question.
static void test_goals_in_any_order_are_remembered_with_their_order(void) {
    aisle_query_msg query = question(5);
    const double x[4] = {25.0, 12.0, 20.0, 5.0};
    query.ordering = AISLE_GOAL_LIST_ANY_ORDER;
    query.num_goals = 4;
    for (int16_t i = 0; i < 4; i++) {
        query.goals[i] = (aisle_goal_msg){.id = 20 + i, .x = x[i], .y = 5.0 + i, .tolerance_theta = 4.0F};
    }
    first = *door_ask(&query);
    TEST_ASSERT_EQUAL_INT8(0, first.cached);
    TEST_ASSERT_EQUAL_INT8(1, door_ask(&query)->cached);
    assert_same_way(&first, &door_reply);
    TEST_ASSERT_EQUAL_INT64(0, count(AISLE_COUNTER_CACHE_SPOILED));
    query.ordering = AISLE_GOAL_LIST_ORDERED;
    TEST_ASSERT_EQUAL_INT8(0, door_ask(&query)->cached);
    TEST_ASSERT_TRUE(door_reply.length > first.length);
    query.ordering = AISLE_GOAL_LIST_ANY_ORDER;
    aisle_goal_msg swap = query.goals[0];
    query.goals[0] = query.goals[1];
    query.goals[1] = swap;
    TEST_ASSERT_EQUAL_INT8(0, door_ask(&query)->cached);
    TEST_ASSERT_FLOAT_WITHIN(1e-3F, first.length, door_reply.length);
}

static void test_a_query_s_answer_serves_a_goal_list(void) {
    here = door_pose(10.0, 10.0, 0.5);
    TEST_ASSERT_EQUAL(AISLE_OK, door_submit(AISLE_INPUT_POSE, &here));
    aisle_goal_list_msg goals = door_goals(1, 20.0, 10.0);
    aisle_query_msg query = question(5);
    query.options = goals.options;
    query.start = (aisle_goal_msg){.x = 10.0, .y = 10.0, .theta = 0.5};
    first = *door_ask(&query);
    TEST_ASSERT_EQUAL(AISLE_OK, door_submit(AISLE_INPUT_GOALS, &goals));
    door_settle();
    TEST_ASSERT_EQUAL_INT8(1, door_path.cached);
    TEST_ASSERT_EQUAL_INT32(0, door_path.query_id);
    TEST_ASSERT_EQUAL_INT32(goals.goal_list_id, door_path.goal_list_id);
    TEST_ASSERT_EQUAL_INT32(1, door_path.path_revision);
    TEST_ASSERT_EQUAL_INT64(here.utime, door_path.pose_utime);
    assert_same_way(&first, &door_path);
    door_wait(600000, &here); // its lease is renewed like any other's
    TEST_ASSERT_EQUAL_INT32(1, door_path.path_revision);
    TEST_ASSERT_GREATER_THAN_INT(1, door_paths);
}

// Whether a list was planned to its end or given up before is a matter of time alone: later answers show none of it.
static void test_a_goal_list_leaves_nothing_that_later_answers_show(void) {
    int32_t units[2][2];
    for (int given_up = 0; given_up < 2; given_up++) {
        setUp();
        here = door_pose(10.0, 10.0, 0.5);
        TEST_ASSERT_EQUAL(AISLE_OK, door_submit(AISLE_INPUT_POSE, &here));
        aisle_goal_list_msg goals = door_goals(1, 20.0, 10.0);
        aisle_query_msg query = question(5);
        query.options = goals.options;
        query.start = (aisle_goal_msg){.x = 10.0, .y = 10.0, .theta = 0.5};
        TEST_ASSERT_EQUAL(AISLE_OK, door_submit(AISLE_INPUT_GOALS, &goals));
        if (given_up == 0) {
            door_settle();
        }
        aisle_command_msg cancel = {.command = AISLE_COMMAND_CANCEL, .command_id = 3};
        TEST_ASSERT_EQUAL(AISLE_OK, door_submit(AISLE_INPUT_COMMAND, &cancel));
        door_settle();
        door_forget();
        for (int i = 0; i < 2; i++) {
            TEST_ASSERT_EQUAL_INT8(i, door_ask(&query)->cached);
            units[given_up][i] = door_reply.work_units;
        }
    }
    TEST_ASSERT_EQUAL_INT32_ARRAY(units[0], units[1], 2);
}

static void test_answers_without_a_path_are_planned_every_time(void) {
    aisle_query_msg query = question(5);
    query.goals[0].x = 15.0; // in the pillar
    for (int i = 0; i < 3; i++) {
        TEST_ASSERT_EQUAL_INT16(AISLE_STATUS_GOAL_OCCUPIED, door_ask(&query)->cause);
    }
    TEST_ASSERT_EQUAL_INT64(0, count(AISLE_COUNTER_CACHE_HITS));
    TEST_ASSERT_EQUAL_INT64(3, count(AISLE_COUNTER_CACHE_MISSES));
}

static void test_a_forgetful_planner_remembers_nothing(void) {
    door_config.forgetful = true;
    door_open(0);
    TEST_ASSERT_EQUAL(AISLE_OK, door_submit(AISLE_INPUT_LAYOUT, hall_message(1, 0.1F)));
    door_settle();
    aisle_query_msg query = question(5);
    (void)door_ask(&query);
    TEST_ASSERT_EQUAL_INT8(0, door_ask(&query)->cached);
    TEST_ASSERT_EQUAL_INT64(0, count(AISLE_COUNTER_CACHE_HITS) + count(AISLE_COUNTER_CACHE_MISSES));
}

static void test_another_vehicle_is_asked_for_anew_and_the_old_one_remembered(void) {
    aisle_query_msg query = question(5);
    aisle_vehicle_msg wide = {.vehicle_revision = 2, .footprint_radius = 0.8F}, old = {.vehicle_revision = 3};
    first = *door_ask(&query);
    TEST_ASSERT_EQUAL(AISLE_OK, door_submit(AISLE_INPUT_VEHICLE, &wide));
    TEST_ASSERT_EQUAL_INT8(0, door_ask(&query)->cached);
    TEST_ASSERT_EQUAL(AISLE_OK, door_submit(AISLE_INPUT_VEHICLE, &old)); // the default one, as at the start
    TEST_ASSERT_EQUAL_INT8(1, door_ask(&query)->cached);
    TEST_ASSERT_EQUAL_INT32(3, door_reply.vehicle_revision);
    assert_same_way(&first, &door_reply);
}

// ---- spoiled memory

// Bytes all over the waypoints changed: never sent, and the answer is what it was.
static void test_spoiled_waypoints_are_caught_and_planned_anew(void) {
    aisle_query_msg query = question(5);
    first = *door_ask(&query);
    const aisle_cache *cache = &door->route->cache;
    const uint32_t step = 19; // a prime, so that every field has its turn
    int64_t spoiled = 0;
    for (uint32_t i = AISLE_PATH_AT_WAYPOINTS; i < cache->entries[0].path_size; i += step) {
        const aisle_cache_entry *entry = &cache->entries[0];
        aisle_cache_block *block = aisle_pool_at(&cache->blocks, entry->first);
        size_t byte = entry->key_size + i;
        for (; byte >= AISLE_CACHE_BLOCK; byte -= AISLE_CACHE_BLOCK) {
            block = aisle_pool_at(&cache->blocks, block->next);
        }
        block->bytes[byte] ^= (uint8_t)(1U << (i % 8U));
        const aisle_path_msg *again = door_ask(&query);
        TEST_ASSERT_EQUAL_INT8(0, again->cached);
        assert_same_way(&first, again);
        TEST_ASSERT_EQUAL_INT64(++spoiled, count(AISLE_COUNTER_CACHE_SPOILED));
        TEST_ASSERT_EQUAL_INT64(0, count(AISLE_COUNTER_CACHE_HITS));
    }
    TEST_ASSERT_GREATER_THAN_INT64(20, spoiled);
    TEST_ASSERT_EQUAL_INT8(1, door_ask(&query)->cached);
}

// A basis that does not fit leads to the whole proof, not to a refusal.
static void test_a_lost_basis_costs_the_whole_proof(void) {
    aisle_query_msg query = question(5);
    (void)door_ask(&query);
    int32_t quick = door_ask(&query)->work_units;
    door->route->cache.entries[0].basis.given ^= 1U;
    const aisle_path_msg *again = door_ask(&query);
    TEST_ASSERT_EQUAL_INT8(1, again->cached);
    TEST_ASSERT_GREATER_THAN_INT32(quick + again->num_waypoints, again->work_units);
    TEST_ASSERT_EQUAL_INT32(quick, door_ask(&query)->work_units); // by the new proof's basis
}

// ---- layouts

static void test_a_patch_far_away_keeps_the_answer_and_has_it_proved(void) {
    aisle_query_msg query = question(5);
    first = *door_ask(&query);
    begin_patch();
    put_box(2, (hall_box){2.0, 2.0, 3.0, 3.0});
    send_patch();
    int64_t looked = count(AISLE_COUNTER_VERIFY_INTERVALS);
    const aisle_path_msg *again = door_ask(&query);
    TEST_ASSERT_EQUAL_INT8(1, again->cached);
    TEST_ASSERT_EQUAL_INT32(2, again->map_revision);
    TEST_ASSERT_GREATER_THAN_INT64(looked, count(AISLE_COUNTER_VERIFY_INTERVALS));
    assert_same_way(&first, again);
    TEST_ASSERT_EQUAL_INT64(1, count(AISLE_COUNTER_CACHE_KEPT));
    looked = count(AISLE_COUNTER_VERIFY_INTERVALS);
    TEST_ASSERT_EQUAL_INT8(1, door_ask(&query)->cached);
    TEST_ASSERT_EQUAL_INT64(looked, count(AISLE_COUNTER_VERIFY_INTERVALS));
}

static void test_a_patch_on_the_path_has_it_planned_anew(void) {
    aisle_query_msg query = question(5);
    first = *door_ask(&query);
    aisle_waypoint_msg *middle = &first.waypoints[first.num_waypoints / 2];
    begin_patch();
    put_box(2, (hall_box){middle->x - 0.2, middle->y - 0.2, middle->x + 0.2, middle->y + 0.2});
    hall_boxes[hall_count++] = (hall_box){middle->x - 0.2, middle->y - 0.2, middle->x + 0.2, middle->y + 0.2};
    send_patch();
    TEST_ASSERT_EQUAL_INT64(1, count(AISLE_COUNTER_CACHE_DROPPED));
    TEST_ASSERT_EQUAL_INT8(0, door_ask(&query)->cached);
    (void)door_judge(&door_reply);
}

// Were the cache to take an answer over that the new layout does not allow, the proof would not.
static void test_a_path_kept_wrongly_is_not_sent(void) {
    aisle_query_msg query = question(5);
    first = *door_ask(&query);
    aisle_waypoint_msg *middle = &first.waypoints[first.num_waypoints / 2];
    begin_patch();
    put_box(2, (hall_box){middle->x - 0.2, middle->y - 0.2, middle->x + 0.2, middle->y + 0.2});
    hall_boxes[hall_count++] = (hall_box){middle->x - 0.2, middle->y - 0.2, middle->x + 0.2, middle->y + 0.2};
    send_patch();
    door->route->cache.entries[0].content = aisle_layout_content(door->layout);
    TEST_ASSERT_EQUAL_INT8(0, door_ask(&query)->cached);
    TEST_ASSERT_EQUAL_INT64(1, count(AISLE_COUNTER_CACHE_SPOILED));
    (void)door_judge(&door_reply);
}

static void test_slices_do_not_change_what_is_remembered(void) {
    static uint8_t whole[DOOR_LOG];
    size_t size = 0;
    for (int run = 0; run < 3; run++) {
        setUp();
        door_units = run == 0 ? UINT32_MAX : run == 1 ? 1U : 97U;
        for (int32_t i = 0; i < 3; i++) {
            aisle_query_msg query = question(i + 1);
            query.start.y = 3.0 + i;
            (void)door_ask(&query);
            (void)door_ask(&query);
        }
        begin_patch();
        put_box(2, (hall_box){25.0, 2.0, 26.0, 3.0});
        send_patch();
        for (int32_t i = 0; i < 3; i++) {
            aisle_query_msg query = question(i + 10);
            query.start.y = 3.0 + i;
            (void)door_ask(&query);
        }
        if (run == 0) {
            size = door_log_size;
            memcpy(whole, door_log, size);
        }
        TEST_ASSERT_EQUAL_size_t(size, door_log_size);
        TEST_ASSERT_EQUAL_MEMORY(whole, door_log, size);
    }
    TEST_ASSERT_GREATER_THAN_INT64(3, count(AISLE_COUNTER_CACHE_HITS));
}

// ---- a vehicle that changes while its path is out

static void go(void) {
    here = door_pose(10.0, 10.0, 0.0);
    TEST_ASSERT_EQUAL(AISLE_OK, door_submit(AISLE_INPUT_POSE, &here));
    aisle_goal_list_msg goals = door_goals(1, 20.0, 10.0);
    TEST_ASSERT_EQUAL(AISLE_OK, door_submit(AISLE_INPUT_GOALS, &goals));
    door_settle();
    TEST_ASSERT_EQUAL(AISLE_PATH_OK, door_path.status);
    first = door_path;
}

static void test_a_vehicle_that_only_counts_on_keeps_its_path(void) {
    go();
    int paths = door_paths;
    aisle_vehicle_msg same = {.vehicle_revision = 2};
    TEST_ASSERT_EQUAL(AISLE_OK, door_submit(AISLE_INPUT_VEHICLE, &same));
    door_settle();
    TEST_ASSERT_EQUAL_INT(paths + 1, door_paths); // neither a refusal nor another plan
    TEST_ASSERT_EQUAL(AISLE_PATH_OK, door_path.status);
    TEST_ASSERT_EQUAL_INT32(2, door_path.vehicle_revision);
    TEST_ASSERT_EQUAL_INT32(first.path_revision + 1, door_path.path_revision);
    TEST_ASSERT_EQUAL_INT32((int32_t)aisle_path_certificate(&door_path), door_path.certificate);
    assert_same_way(&first, &door_path);
}

static void test_a_vehicle_of_another_body_has_its_path_withdrawn_and_planned_anew(void) {
    go();
    int paths = door_paths;
    aisle_vehicle_msg wide = {.vehicle_revision = 2, .footprint_radius = 0.9F};
    TEST_ASSERT_EQUAL(AISLE_OK, door_submit(AISLE_INPUT_VEHICLE, &wide));
    door_pull_events();
    TEST_ASSERT_EQUAL_INT(paths + 1, door_paths);
    TEST_ASSERT_EQUAL(AISLE_PATH_NONE, door_path.status);
    TEST_ASSERT_EQUAL_INT16(AISLE_STATUS_CONFLICT, door_path.cause);
    TEST_ASSERT_EQUAL_INT32(2, door_path.cause_id);
    hall_disc(0.9, 0.1F);
    door_settle();
    TEST_ASSERT_EQUAL(AISLE_PATH_OK, door_path.status);
    TEST_ASSERT_EQUAL_INT8(0, door_path.cached);
    (void)door_judge(&door_path);
}

static void test_a_vehicle_too_wide_for_its_way_is_told_why(void) {
    hall_begin(30.0, 20.0);
    hall_add(14.0, 0.0, 16.0, 9.0);
    hall_add(14.0, 10.5, 16.0, 20.0); // a door of 1.5 m
    TEST_ASSERT_EQUAL(AISLE_OK, door_submit(AISLE_INPUT_LAYOUT, hall_message(2, 0.1F)));
    door_settle();
    go();
    aisle_vehicle_msg wide = {.vehicle_revision = 2, .footprint_radius = 0.9F};
    TEST_ASSERT_EQUAL(AISLE_OK, door_submit(AISLE_INPUT_VEHICLE, &wide));
    door_settle();
    TEST_ASSERT_EQUAL(AISLE_PATH_NONE, door_path.status);
    TEST_ASSERT_EQUAL_INT16(AISLE_STATUS_TOO_NARROW, door_path.cause);
    TEST_ASSERT_FLOAT_WITHIN(1e-3F, 1.5F, door_path.cause_value);
    int paths = door_paths;
    door_wait(3000000, &here);
    TEST_ASSERT_EQUAL_INT(paths, door_paths); // the old one is not sent any more
}

// ---- patches at random, beside a planner without memory

static aisle_planner *with_memory, *without;
static hall_box box[BOXES];
static bool stands[BOXES];
static aisle_query_msg asked[QUESTIONS];

static void random_box(aisle_rng *rng, int i) {
    aisle_vec2 lo = uniform_point(rng, aisle_vec2_of(1.0, 1.0), aisle_vec2_of(26.0, 16.0));
    aisle_vec2 side = uniform_point(rng, aisle_vec2_of(0.3, 0.3), aisle_vec2_of(4.0, 4.0));
    box[i] = (hall_box){lo.x, lo.y, fmin(lo.x + side.x, 29.0), fmin(lo.y + side.y, 19.0)};
    stands[i] = true;
}

static void lay_boxes(void) {
    hall_begin(30.0, 20.0);
    for (int i = 0; i < BOXES; i++) {
        if (stands[i]) {
            hall_boxes[hall_count++] = box[i];
        }
    }
}

static void both(aisle_input_kind kind, const void *msg) {
    aisle_planner *planners[2] = {without, with_memory};
    for (int i = 0; i < 2; i++) {
        door = planners[i];
        TEST_ASSERT_EQUAL(AISLE_OK, door_submit(kind, msg));
        door_settle();
    }
}

static void random_patch(aisle_rng *rng) {
    begin_patch();
    for (uint32_t left = 1U + aisle_rng_below(rng, 2); left > 0; left--) {
        int i = (int)aisle_rng_below(rng, BOXES);
        for (int16_t k = 0; k < patch.num_polygons + patch.num_removed; k++) {
            if ((k < patch.num_polygons && patch.polygons[k].id == i + 1) ||
                (k < patch.num_removed && patch.removed[k] == i + 1)) {
                i = -1; // had its turn
                break;
            }
        }
        if (i >= 0 && stands[i] && aisle_rng_below(rng, 2) == 0) {
            stands[i] = false;
            patch.removed[patch.num_removed++] = i + 1;
        } else if (i >= 0) {
            random_box(rng, i);
            put_box(i + 1, box[i]);
        }
    }
    lay_boxes();
    both(AISLE_INPUT_LAYOUT_PATCH, &patch);
}

static void open_both(const aisle_vehicle_msg *vehicle, uint64_t seed, int8_t objective) {
    aisle_rng rng = aisle_rng_seed(seed);
    aisle_refusal why;
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_vehicle_from_msg(vehicle, &hall_vehicle, &why));
    memset(stands, 0, sizeof stands);
    for (int i = 0; i < BOXES / 2; i++) {
        random_box(&rng, i);
    }
    lay_boxes();
    door_config.vehicle = *vehicle;
    door_config.forgetful = true;
    door_open(OTHER);
    without = door;
    door_config.forgetful = false;
    door_open(0);
    with_memory = door;
    revision = 1;
    aisle_layout_msg *msg = &hall_msg;
    (void)hall_message(1, 0.1F);
    uint32_t crc = 0;
    for (int i = 0; i < BOXES / 2; i++) {
        msg->polygons[i].id = i + 1;
    }
    crc = aisle_layout_crc32(0, msg);
    msg->crc32 = (int32_t)crc;
    both(AISLE_INPUT_LAYOUT, msg);
    for (int q = 0; q < QUESTIONS; q++) {
        aisle_vec2 a = uniform_point(&rng, aisle_vec2_of(1.0, 1.0), aisle_vec2_of(29.0, 19.0));
        aisle_vec2 b = uniform_point(&rng, aisle_vec2_of(1.0, 1.0), aisle_vec2_of(29.0, 19.0));
        asked[q] = door_query(q + 1, a.x, a.y, b.x, b.y);
        asked[q].options.planner = AISLE_OPTIONS_AUTO;
        asked[q].options.objective = objective;
        if (q % 4 == 3) {
            b = uniform_point(&rng, aisle_vec2_of(1.0, 1.0), aisle_vec2_of(29.0, 19.0));
            asked[q].num_goals = 2;
            asked[q].goals[1] = (aisle_goal_msg){.id = 12, .x = b.x, .y = b.y, .tolerance_theta = 4.0F, .dwell = 1.0F};
            asked[q].goals[0].dwell = 2.0F;
        }
        for (int16_t i = 1; q % 4 == 1 && i < 4; i++) {
            b = uniform_point(&rng, aisle_vec2_of(1.0, 1.0), aisle_vec2_of(29.0, 19.0));
            asked[q].ordering = AISLE_GOAL_LIST_ANY_ORDER;
            asked[q].num_goals = (int16_t)(i + 1);
            asked[q].goals[i] = (aisle_goal_msg){.id = 11 + i, .x = b.x, .y = b.y, .tolerance_theta = 4.0F};
        }
    }
}

typedef struct tally {
    int hits, worse, paths, repaired;
    double worst, worst_repair;
    double units_repair, units_fresh; // of repaired answers, and of planning the same anew
} tally;

static double worth(const aisle_path_msg *path, int8_t objective) {
    switch (objective) {
    case AISLE_OPTIONS_FASTEST:
        return (double)path->duration;
    case AISLE_OPTIONS_LEAST_ENERGY:
        return (double)path->energy;
    default:
        return (double)path->length;
    }
}

// The same question to both. What comes from memory is judged by hand on the boxes as they are now.
static void ask_both(aisle_query_msg *query, tally *sum) {
    aisle_path_msg *fresh = &first;
    query->query_id++;
    door = without;
    *fresh = *door_ask(query);
    door = with_memory;
    const int64_t before = count(AISLE_COUNTER_CACHE_REPAIRED);
    const aisle_path_msg *answer = door_ask(query);
    const bool is_repaired = count(AISLE_COUNTER_CACHE_REPAIRED) > before;
    TEST_ASSERT_EQUAL(fresh->status, answer->status);
    TEST_ASSERT_EQUAL_INT8(0, fresh->cached);
    sum->paths += answer->status == AISLE_PATH_OK ? 1 : 0;
    if (answer->cached == 0 && !is_repaired) {
        return;
    }
    int8_t objective = query->options.objective;
    sum->hits += answer->cached;
    sum->repaired += is_repaired ? 1 : 0;
    (void)door_judge(answer);
    TEST_ASSERT_EQUAL_INT32(revision, answer->map_revision);
    TEST_ASSERT_TRUE((double)answer->length_bound <= (double)fresh->length * (1.0 + 1e-6));
    double ratio = worth(answer, objective) / worth(fresh, objective);
    if (objective == AISLE_OPTIONS_SAFEST) {
        const double slack = AISLE_CACHE_REPAIR * (double)fresh->risk + 1e-4; // of repairs, and what is kept of them
        TEST_ASSERT_TRUE((double)answer->risk <= (double)fresh->risk + 1.01e-4 + slack);
        ratio = (double)answer->risk > (double)fresh->risk - 1e-4 ? ratio : 1.0;
    }
    if (is_repaired) {
        sum->worst_repair = fmax(sum->worst_repair, ratio);
        sum->units_repair += (double)answer->work_units;
        sum->units_fresh += (double)fresh->work_units;
        return;
    }
    sum->worse += ratio > 1.0 + 1e-3 ? 1 : 0;
    sum->worst = fmax(sum->worst, ratio);
}

static tally run(const aisle_vehicle_msg *vehicle, uint64_t seed, int8_t objective, int patches) {
    tally sum = {0, 0, 0, 0, 0.0, 0.0, 0.0, 0.0};
    open_both(vehicle, seed, objective);
    aisle_rng rng = aisle_rng_seed(seed + 1000);
    for (int i = 0; i < CASES(patches); i++) {
        if (i > 0) {
            random_patch(&rng);
        }
        for (int q = 0; q < 2; q++) {
            door_forget();
            ask_both(&asked[aisle_rng_below(&rng, QUESTIONS)], &sum);
        }
    }
    door = with_memory;
    printf("seed %2d objective %d: %d paths, %d hits, %d worse by a thousandth, worst %.5f; kept %d, dropped %d; "
           "%d repaired, worst %.5f, work / planned anew %.2f\n",
           (int)seed, objective, sum.paths, sum.hits, sum.worse, sum.worst, (int)count(AISLE_COUNTER_CACHE_KEPT),
           (int)count(AISLE_COUNTER_CACHE_DROPPED), sum.repaired, sum.worst_repair,
           sum.units_repair / fmax(sum.units_fresh, 1.0));
    return sum;
}

static void test_repaired_answers_are_proved_and_within_their_slack_of_planned_ones(void) {
    const aisle_vehicle_msg disc = {.vehicle_revision = 1, .footprint_radius = 0.4F, .margin = 0.1F};
    const aisle_vehicle_msg body = {
        .vehicle_revision = 1, .num_vertices = 4, .footprint = {{-1.2, -0.5}, {1.2, -0.5}, {1.2, 0.5}, {-1.2, 0.5}}};
    tally sum = run(&body, 7, AISLE_OPTIONS_SHORTEST, 120);
    TEST_ASSERT_GREATER_OR_EQUAL_INT(LEAST(6), sum.repaired);
    TEST_ASSERT_TRUE(sum.worst_repair <= 1.0 + AISLE_CACHE_REPAIR + 1e-3);
    sum = run(&disc, 8, AISLE_OPTIONS_SAFEST, 60);
    TEST_ASSERT_GREATER_OR_EQUAL_INT(LEAST(4), sum.repaired);
    TEST_ASSERT_TRUE(sum.units_repair < sum.units_fresh);
}

// A box on a straight way: what is free of it stays, waypoint for waypoint in place, and the rest goes round.
static void test_a_box_on_a_long_way_is_gone_round_and_the_rest_kept(void) {
    aisle_query_msg query = door_query(1, 2.0, 3.0, 28.0, 3.0);
    query.options.planner = AISLE_OPTIONS_AUTO;
    query.options.objective = AISLE_OPTIONS_SHORTEST;
    first = *door_ask(&query);
    begin_patch();
    put_box(2, (hall_box){14.8, 2.6, 15.2, 2.9});
    hall_boxes[hall_count++] = (hall_box){14.8, 2.6, 15.2, 2.9};
    send_patch();
    const aisle_path_msg *answer = door_ask(&query);
    TEST_ASSERT_EQUAL_INT8(0, answer->cached);
    TEST_ASSERT_EQUAL_INT64(1, count(AISLE_COUNTER_CACHE_REPAIRED));
    TEST_ASSERT_EQUAL_INT64(2, count(AISLE_COUNTER_CACHE_MISSES));
    (void)door_judge(answer);
    TEST_ASSERT_TRUE(answer->length > first.length && answer->length <= first.length * 1.01F);
    TEST_ASSERT_TRUE(answer->length_bound <= first.length_bound &&
                     answer->length_bound >= first.length_bound - 1.1e-3F);
    TEST_ASSERT_EQUAL_INT8(1, door_ask(&query)->cached); // and is remembered by now
    begin_patch();
    patch.removed[patch.num_removed++] = 2;
    hall_count--;
    send_patch();
    TEST_ASSERT_EQUAL_INT8(1, door_ask(&query)->cached); // the first one serves again
    assert_same_way(&first, &door_reply);
}

// What would be worse by more than the slack is planned anew, and so is what a removal may have bettered meanwhile.
static void test_a_long_detour_or_freed_ground_is_planned_anew(void) {
    aisle_query_msg query = door_query(1, 2.0, 3.0, 28.0, 3.0);
    query.options.planner = AISLE_OPTIONS_AUTO;
    query.options.objective = AISLE_OPTIONS_SHORTEST;
    (void)door_ask(&query);
    begin_patch();
    put_box(2, (hall_box){14.8, 0.0, 15.2, 7.0});
    hall_boxes[hall_count++] = (hall_box){14.8, 0.0, 15.2, 7.0};
    send_patch();
    (void)door_judge(door_ask(&query));
    TEST_ASSERT_EQUAL_INT64(0, count(AISLE_COUNTER_CACHE_REPAIRED));
    setUp();
    query = question(5); // round the pillar
    query.options.objective = AISLE_OPTIONS_SHORTEST;
    first = *door_ask(&query);
    begin_patch();
    put_box(3, (hall_box){18.0, 9.9, 18.2, 10.1});
    hall_boxes[0] = (hall_box){18.0, 9.9, 18.2, 10.1};
    patch.removed[patch.num_removed++] = 1; // the pillar
    send_patch();
    (void)door_judge(door_ask(&query));
    TEST_ASSERT_EQUAL_INT64(0, count(AISLE_COUNTER_CACHE_REPAIRED));
    TEST_ASSERT_TRUE(door_reply.length < first.length);
}

static void test_kept_answers_of_a_disc_are_as_short_as_planned_ones(void) {
    const aisle_vehicle_msg disc = {.vehicle_revision = 1, .footprint_radius = 0.4F, .margin = 0.1F};
    tally sum = run(&disc, 1, AISLE_OPTIONS_SHORTEST, 400);
    TEST_ASSERT_GREATER_THAN_INT(LEAST(60), sum.hits);
    TEST_ASSERT_TRUE(sum.worst <= 1.0 + 1e-3);
}

static void test_kept_answers_of_other_bodies_and_objectives_are_proved_and_good(void) {
    const aisle_vehicle_msg disc = {.vehicle_revision = 1, .footprint_radius = 0.3F};
    const aisle_vehicle_msg body = {.vehicle_revision = 1};
    static const int8_t objectives[] = {AISLE_OPTIONS_SAFEST, AISLE_OPTIONS_FASTEST, AISLE_OPTIONS_LEAST_ENERGY};
    tally sum = run(&body, 2, AISLE_OPTIONS_SHORTEST, 100);
    TEST_ASSERT_GREATER_THAN_INT(LEAST(12), sum.hits);
    for (uint64_t i = 0; i < 3; i++) {
        sum = run(&disc, 3 + i, objectives[i], 60);
        TEST_ASSERT_GREATER_THAN_INT(LEAST(4), sum.hits);
    }
}

// The same at length, by hand: test_route_cache SEEDS.
static void sweep(uint64_t seeds) {
    const aisle_vehicle_msg bodies[] = {
        {.vehicle_revision = 1, .footprint_radius = 0.4F, .margin = 0.1F},
        {.vehicle_revision = 1, .footprint_radius = 0.8F, .margin = 0.1F},
        {.vehicle_revision = 1},
        {.vehicle_revision = 1, .num_vertices = 4, .footprint = {{-1.2, -0.5}, {1.2, -0.5}, {1.2, 0.5}, {-1.2, 0.5}}}};
    setUp();
    for (uint64_t seed = 100; seed < 100U + seeds; seed++) {
        for (int8_t objective = AISLE_OPTIONS_SAFEST; objective <= AISLE_OPTIONS_LEAST_ENERGY; objective++) {
            for (size_t i = 0; i < sizeof bodies / sizeof bodies[0]; i++) {
                (void)run(&bodies[i], seed, objective, objective == AISLE_OPTIONS_SHORTEST ? 1000 : 100);
            }
        }
    }
}

int main(int argc, char **argv) {
    UNITY_BEGIN();
    if (argc > 1) {
        sweep(strtoul(argv[1], NULL, 10));
        return UNITY_END();
    }
    RUN_TEST(test_a_question_asked_again_is_answered_from_memory);
    RUN_TEST(test_the_genetic_search_s_answer_is_remembered_until_its_ground_changes);
    RUN_TEST(test_a_remembered_answer_has_the_head_of_a_fresh_one);
    RUN_TEST(test_goals_in_any_order_are_remembered_with_their_order);
    RUN_TEST(test_a_query_s_answer_serves_a_goal_list);
    RUN_TEST(test_a_goal_list_leaves_nothing_that_later_answers_show);
    RUN_TEST(test_answers_without_a_path_are_planned_every_time);
    RUN_TEST(test_a_forgetful_planner_remembers_nothing);
    RUN_TEST(test_another_vehicle_is_asked_for_anew_and_the_old_one_remembered);
    RUN_TEST(test_spoiled_waypoints_are_caught_and_planned_anew);
    RUN_TEST(test_a_lost_basis_costs_the_whole_proof);
    RUN_TEST(test_a_patch_far_away_keeps_the_answer_and_has_it_proved);
    RUN_TEST(test_a_patch_on_the_path_has_it_planned_anew);
    RUN_TEST(test_a_path_kept_wrongly_is_not_sent);
    RUN_TEST(test_slices_do_not_change_what_is_remembered);
    RUN_TEST(test_a_vehicle_that_only_counts_on_keeps_its_path);
    RUN_TEST(test_a_vehicle_of_another_body_has_its_path_withdrawn_and_planned_anew);
    RUN_TEST(test_a_vehicle_too_wide_for_its_way_is_told_why);
    RUN_TEST(test_a_box_on_a_long_way_is_gone_round_and_the_rest_kept);
    RUN_TEST(test_a_long_detour_or_freed_ground_is_planned_anew);
    RUN_TEST(test_repaired_answers_are_proved_and_within_their_slack_of_planned_ones);
    RUN_TEST(test_kept_answers_of_a_disc_are_as_short_as_planned_ones);
    RUN_TEST(test_kept_answers_of_other_bodies_and_objectives_are_proved_and_good);
    return UNITY_END();
}
