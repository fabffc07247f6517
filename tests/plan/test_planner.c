#include "aisle/planner.h"

#include "door.h"

static aisle_pose_msg here;
static aisle_vehicle_msg body;

// 12 x 8 m with one pillar, id 1, in the middle; the default vehicle (1.0 x 0.7 m, margin 0.1 m).
static void pillar_hall(void) {
    hall_begin(12.0, 8.0);
    hall_add(5.0, 3.0, 7.0, 5.0);
}

static void open_door(void) {
    door_config = (aisle_config){.limits = {.cells = 65536U, .requests = 4U}, .boot_id = 77, .has_vehicle = true};
    hall_rectangle(1.0, 0.7, 0.1F);
    pillar_hall();
    door_open(0);
}

static void take_hall(void) {
    TEST_ASSERT_EQUAL(AISLE_OK, door_layout(1));
    door_settle();
}

// At (2, 4), and a goal list to (10, 4) under way or done.
static void stand_and_go(void) {
    here = door_pose(2.0, 4.0, 0.0);
    TEST_ASSERT_EQUAL(AISLE_OK, door_submit(AISLE_INPUT_POSE, &here));
    aisle_goal_list_msg goals = door_goals(1, 10.0, 4.0);
    TEST_ASSERT_EQUAL(AISLE_OK, door_submit(AISLE_INPUT_GOALS, &goals));
    door_settle();
}

void setUp(void) {
    open_door();
}
void tearDown(void) {}

static aisle_status_msg status_now(void) {
    aisle_status_msg status;
    aisle_planner_status(door, door_now, &status);
    return status;
}

static int64_t count(aisle_counter which) {
    return aisle_planner_counters(door)[which];
}

// ---- memory

static void test_memsize_is_0_for_limits_out_of_range(void) {
    const aisle_limits bad[] = {{.cells = 4095U},         {.cells = AISLE_LIMITS_CELLS_MAX + 1U},
                                {.polygons = 4097U},      {.vertices = 2U},
                                {.vertices = 65537U},     {.open_nodes = 1023U},
                                {.open_nodes = 4194305U}, {.requests = 65U},
                                {.cached_paths = 1025U}};
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        TEST_ASSERT_EQUAL_size_t(0, aisle_planner_memsize(&bad[i]));
    }
    TEST_ASSERT_EQUAL_size_t(0, aisle_planner_memsize(NULL));
}

static void test_memsize_with_default_limits_is_below_24_mib(void) {
    const aisle_limits zero = {0};
    const aisle_limits told = {AISLE_LIMITS_CELLS_DEFAULT,    AISLE_LIMITS_POLYGONS_DEFAULT,
                               AISLE_LIMITS_VERTICES_DEFAULT, AISLE_LIMITS_OPEN_NODES_DEFAULT,
                               AISLE_LIMITS_REQUESTS_DEFAULT, AISLE_LIMITS_CACHED_PATHS_DEFAULT};
    size_t size = aisle_planner_memsize(&zero);
    TEST_ASSERT_TRUE(size > 0 && size < (size_t)(24U << 20));
    TEST_ASSERT_EQUAL_size_t(size, aisle_planner_memsize(&told));
}

static void test_every_limit_at_its_ends_has_a_size(void) {
    const aisle_limits least = {4096U, 1U, 3U, 1024U, 1U, 1U};
    const aisle_limits most = {AISLE_LIMITS_CELLS_MAX, 4096U, 65536U, 4194304U, 64U, 1024U};
    size_t small = aisle_planner_memsize(&least);
    TEST_ASSERT_TRUE(small > 0 && small < aisle_planner_memsize(&most));
}

static void test_init_refuses_a_byte_less_and_leaves_the_block_alone(void) {
    static unsigned char copy[64];
    size_t need = aisle_planner_memsize(&door_config.limits);
    unsigned char *at = door_block[1] + (64U - (uintptr_t)door_block[1] % 64U) % 64U;
    aisle_planner *none = NULL;
    memset(at, 0xA5, need + 64U);
    memset(copy, 0xA5, sizeof copy);
    TEST_ASSERT_EQUAL(AISLE_ERR_CAPACITY, aisle_planner_init(at, need - 1U, &door_config, &none));
    TEST_ASSERT_NULL(none);
    TEST_ASSERT_EQUAL_MEMORY(copy, at, sizeof copy);
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_planner_init(at, need, &door_config, &none));
    TEST_ASSERT_EQUAL_MEMORY(copy, at + need, sizeof copy); // and writes not a byte behind
}

static void test_init_refuses_what_breaks_its_rules(void) {
    unsigned char *at = door_block[1] + (64U - (uintptr_t)door_block[1] % 64U) % 64U;
    size_t size = sizeof door_block[1] - 64U;
    aisle_planner *none = NULL;
    TEST_ASSERT_EQUAL(AISLE_ERR_ARG, aisle_planner_init(NULL, size, &door_config, &none));
    TEST_ASSERT_EQUAL(AISLE_ERR_ARG, aisle_planner_init(at, size, NULL, &none));
    TEST_ASSERT_EQUAL(AISLE_ERR_ARG, aisle_planner_init(at, size, &door_config, NULL));
    TEST_ASSERT_EQUAL(AISLE_ERR_ARG, aisle_planner_init(at + 1, size, &door_config, &none));
    aisle_config bad = door_config;
    bad.limits.cells = 1U;
    TEST_ASSERT_EQUAL(AISLE_ERR_ARG, aisle_planner_init(at, size, &bad, &none));
    bad = door_config;
    bad.vehicle.v_max = -1.0F;
    TEST_ASSERT_EQUAL(AISLE_ERR_ARG, aisle_planner_init(at, size, &bad, &none));
    bad = door_config;
    bad.work_units = -1;
    TEST_ASSERT_EQUAL(AISLE_ERR_ARG, aisle_planner_init(at, size, &bad, &none));
    TEST_ASSERT_NULL(none);
}

static void test_the_shortest_lease_is_within_its_bounds_or_zero(void) {
    unsigned char *at = door_block[1] + (64U - (uintptr_t)door_block[1] % 64U) % 64U;
    const size_t size = sizeof door_block[1] - 64U;
    static const float bad[] = {0.0499F, 1.0001F, -0.125F, -1e-9F, 1e-9F, NAN, INFINITY, -INFINITY};
    static const float good[] = {0.0F, -0.0F, 0.05F, 0.125F, 0.3F, 1.0F};
    aisle_config config = door_config;
    aisle_planner *planner = NULL;
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        config.shortest_lease = bad[i];
        TEST_ASSERT_EQUAL(AISLE_ERR_ARG, aisle_planner_init(at, size, &config, &planner));
        TEST_ASSERT_NULL(planner);
    }
    for (size_t i = 0; i < sizeof good / sizeof good[0]; i++) {
        config.shortest_lease = good[i];
        TEST_ASSERT_EQUAL(AISLE_OK, aisle_planner_init(at, size, &config, &planner));
    }
}

static void test_memory_rows_sum_up_to_memsize(void) {
    aisle_memory_row rows[32];
    size_t n = aisle_planner_memory(door, rows, 32);
    size_t sum = 0;
    TEST_ASSERT_TRUE(n > 0 && n <= 32);
    for (size_t i = 0; i < n; i++) {
        TEST_ASSERT_NOT_NULL(rows[i].name);
        sum += rows[i].bytes;
    }
    TEST_ASSERT_EQUAL_size_t(aisle_planner_memsize(&door_config.limits), sum);
    TEST_ASSERT_EQUAL_size_t(n, aisle_planner_memory(door, rows, 1)); // the count, whatever fits
}

// ---- layouts and queries

static void test_a_query_is_answered_by_a_path_that_keeps_the_margin(void) {
    take_hall();
    aisle_query_msg query = door_query(5, 2.0, 4.0, 10.0, 4.0);
    query.options.planner = AISLE_OPTIONS_AUTO;
    const aisle_path_msg *path = door_ask(&query);
    door_judge(path);
    TEST_ASSERT_EQUAL_INT64(77, path->boot_id);
    TEST_ASSERT_EQUAL_INT32(1, path->map_id);
    TEST_ASSERT_EQUAL_INT32(1, path->map_revision);
    TEST_ASSERT_EQUAL_INT32(0, path->goal_list_id);
    TEST_ASSERT_TRUE(path->length > 8.0F && path->length < 11.0F);
    TEST_ASSERT_TRUE(path->length_bound > 8.0F && path->length_bound <= path->length); // round the pillar
    const aisle_waypoint_msg *end = &path->waypoints[path->num_waypoints - 1];
    TEST_ASSERT_DOUBLE_WITHIN(0.05, 10.0, end->x);
    TEST_ASSERT_EQUAL_INT32(11, end->goal_id);
    TEST_ASSERT_TRUE((end->flags & AISLE_WAYPOINT_GOAL) != 0);
    TEST_ASSERT_EQUAL_INT64(1, count(AISLE_COUNTER_QUERIES));
    TEST_ASSERT_EQUAL_INT64(1, count(AISLE_COUNTER_PATHS));
    TEST_ASSERT_TRUE(path->work_units > 0 && path->work_units <= count(AISLE_COUNTER_WORK_UNITS));
    query.query_id = 6; // along obstacles, by the grid and the swarm, so that every part is asked
    query.options.objective = AISLE_OPTIONS_FASTEST;
    door_judge(door_ask(&query));
    TEST_ASSERT_TRUE(count(AISLE_COUNTER_NODES) > 0 && count(AISLE_COUNTER_SWARM_EVALS) > 0 &&
                     count(AISLE_COUNTER_VERIFY_INTERVALS) > 0 && count(AISLE_COUNTER_OPEN_NODES_MAX) > 0);
}

static void test_work_is_counted_as_it_is_spent(void) {
    take_hall();
    aisle_query_msg query = door_query(6, 2.0, 4.0, 10.0, 4.0);
    query.options.objective = AISLE_OPTIONS_FASTEST;
    query.options.planner = AISLE_OPTIONS_AUTO;
    const int64_t start = count(AISLE_COUNTER_WORK_UNITS);
    int64_t before = start;
    int busy = 0, counted = 0;
    TEST_ASSERT_EQUAL(AISLE_OK, door_submit(AISLE_INPUT_QUERY, &query));
    for (; door_replies == 0; busy++) {
        (void)aisle_planner_step(door, door_now, 300);
        const int64_t spent = count(AISLE_COUNTER_WORK_UNITS) - before;
        TEST_ASSERT_TRUE(spent <= 300 + 4096); // of one step, not of all since the request began
        counted += spent > 0 ? 1 : 0;
        before += spent;
        door_pull_events();
    }
    TEST_ASSERT_TRUE(counted > 20 && counted >= busy - 2); // all but the one that begins it
    TEST_ASSERT_EQUAL_INT64(door_reply.work_units, before - start);
}

static void test_a_layout_in_parts_is_in_force_when_the_last_one_is_in(void) {
    static aisle_layout_msg part[2];
    hall_add(1.0, 1.0, 2.0, 2.0);
    part[0] = *hall_message(3, 0.0F);
    part[1] = part[0];
    for (int i = 0; i < 2; i++) {
        part[i].part = (int16_t)i;
        part[i].num_parts = 2;
        part[i].num_polygons = 1;
    }
    part[1].polygons[0] = part[0].polygons[1];
    TEST_ASSERT_EQUAL(AISLE_PARTIAL, door_submit(AISLE_INPUT_LAYOUT, &part[1]));
    TEST_ASSERT_EQUAL_INT32(0, status_now().map_revision);
    TEST_ASSERT_EQUAL(AISLE_OK, door_submit(AISLE_INPUT_LAYOUT, &part[0]));
    door_settle();
    TEST_ASSERT_EQUAL_INT32(3, status_now().map_revision);
    TEST_ASSERT_EQUAL_INT64(1, count(AISLE_COUNTER_LAYOUTS));
    TEST_ASSERT_EQUAL(AISLE_STATUS_IDLE, status_now().state);
    aisle_query_msg query = door_query(5, 1.0, 0.5, 1.5, 1.5);
    TEST_ASSERT_EQUAL_INT16(AISLE_STATUS_GOAL_OCCUPIED, door_ask(&query)->cause);
    TEST_ASSERT_EQUAL_INT32(2, door_reply.cause_id);
}

// A scanned room of 6 x 6 m in 0.1 m cells, its left half a wall at 2.0..2.1 m but for y above 4 m.
static const aisle_grid_chunk_msg *scan(int32_t revision) {
    static aisle_grid_chunk_msg chunk;
    memset(&chunk, 0, sizeof chunk);
    chunk.map_id = 1;
    chunk.map_revision = revision;
    chunk.num_parts = 1;
    chunk.resolution = 0.1F;
    chunk.width = chunk.height = 60;
    chunk.num_bytes = 60 * 8;
    for (int y = 0; y < 40; y++) {
        chunk.data[y * 8 + 2] = 1U << 4;
    }
    return &chunk;
}

static void test_a_scanned_map_in_tiles_is_planned_on(void) {
    hall_begin(6.0, 6.0);
    static aisle_layout_msg msg;
    msg = *hall_message(1, 0.0F);
    msg.num_grid_chunks = 1;
    TEST_ASSERT_EQUAL(AISLE_PARTIAL, door_submit(AISLE_INPUT_LAYOUT, &msg));
    TEST_ASSERT_EQUAL(AISLE_OK, door_submit(AISLE_INPUT_GRID, scan(1)));
    door_settle();
    hall_add(2.0, 0.0, 2.1, 4.0); // the judge's view of the scan
    aisle_query_msg query = door_query(1, 1.0, 1.0, 4.0, 1.0);
    const aisle_path_msg *path = door_ask(&query);
    door_judge(path);
    TEST_ASSERT_TRUE(path->length > 7.0F);
}

static void test_a_patch_moves_a_polygon_and_a_gap_in_revisions_is_refused(void) {
    static aisle_layout_patch_msg patch;
    take_hall();
    memset(&patch, 0, sizeof patch);
    patch = (aisle_layout_patch_msg){.map_id = 1, .base_revision = 1, .map_revision = 2, .num_polygons = 1};
    patch.polygons[0] =
        (aisle_polygon_msg){.id = 1, .num_vertices = 4, .vertices = {{9.0, 3.0}, {11.0, 3.0}, {11.0, 5.0}, {9.0, 5.0}}};
    TEST_ASSERT_EQUAL(AISLE_OK, door_submit(AISLE_INPUT_LAYOUT_PATCH, &patch));
    door_settle();
    aisle_query_msg query = door_query(1, 2.0, 4.0, 10.0, 4.0);
    TEST_ASSERT_EQUAL_INT16(AISLE_STATUS_GOAL_OCCUPIED, door_ask(&query)->cause);
    TEST_ASSERT_EQUAL_INT32(2, door_reply.map_revision);
    patch.base_revision = 5;
    patch.map_revision = 6;
    TEST_ASSERT_EQUAL(AISLE_ERR_DATA, door_submit(AISLE_INPUT_LAYOUT_PATCH, &patch));
    TEST_ASSERT_EQUAL_INT16(AISLE_STATUS_REVISION_GAP, status_now().cause);
    TEST_ASSERT_EQUAL_INT32(2, status_now().map_revision);
}

static void test_layouts_held_are_duplicates_and_older_ones_outdated(void) {
    TEST_ASSERT_EQUAL(AISLE_OK, door_layout(3));
    TEST_ASSERT_EQUAL(AISLE_BUSY, door_layout(4)); // until the one before is built
    door_settle();
    TEST_ASSERT_EQUAL(AISLE_OK, door_layout(3));
    TEST_ASSERT_EQUAL_INT64(1, count(AISLE_COUNTER_DUPLICATES));
    TEST_ASSERT_EQUAL(AISLE_ERR_DATA, door_layout(2));
    TEST_ASSERT_EQUAL_INT16(AISLE_STATUS_OUTDATED, status_now().cause);
    TEST_ASSERT_EQUAL_INT64(1, count(AISLE_COUNTER_REJECTED));
    TEST_ASSERT_EQUAL_INT32(1, status_now().num_rejected);
    TEST_ASSERT_EQUAL_INT64(1, count(AISLE_COUNTER_LAYOUTS));
}

// ---- the same bytes

// A scenario with a bit of everything; returns the size of its log.
static size_t scenario(int which, uint32_t slice) {
    door_open(which);
    door_units = slice;
    pillar_hall();
    take_hall();
    aisle_query_msg query = door_query(1, 2.0, 4.0, 10.0, 4.0);
    query.options.planner = AISLE_OPTIONS_AUTO;
    query.goals[1] = (aisle_goal_msg){.id = 12, .x = 6.0, .y = 7.0, .theta = 1.0};
    query.num_goals = 2;
    (void)door_ask(&query);
    query.options.planner = AISLE_OPTIONS_PSO;
    query.options.work_units = 20000; // spent in the middle of the swarm
    query.options.num_samples = 200;
    (void)door_ask(&query);
    query.options.work_units = 3000; // and of the search
    (void)door_ask(&query);
    stand_and_go();
    door_wait(600000, &here);
    pillar_hall();
    hall_add(0.0, 5.0, 5.5, 5.2); // a wall to the pillar, and one from there down: too narrow
    hall_add(5.5, 0.5, 6.0, 3.0);
    TEST_ASSERT_EQUAL(AISLE_OK, door_layout(2));
    door_settle();
    return door_log_size;
}

static void test_any_slicing_gives_the_same_bytes(void) {
    static uint8_t whole[DOOR_LOG];
    static const uint32_t slices[] = {1, 7, 100, 5000};
    size_t size = scenario(0, UINT32_MAX);
    memcpy(whole, door_log, size);
    TEST_ASSERT_GREATER_THAN_size_t(4000, size);
    for (size_t i = 0; i < sizeof slices / sizeof slices[0]; i++) {
        TEST_ASSERT_EQUAL_size_t(size, scenario(0, slices[i]));
        TEST_ASSERT_EQUAL_MEMORY(whole, door_log, size);
    }
}

static void test_two_planners_give_the_same_bytes_whatever_was_in_their_memory(void) {
    static uint8_t first[DOOR_LOG];
    size_t size = scenario(0, 1000);
    memcpy(first, door_log, size);
    memset(door_block[1], 0xFF, sizeof door_block[1]);
    TEST_ASSERT_EQUAL_size_t(size, scenario(1, 1000));
    TEST_ASSERT_EQUAL_MEMORY(first, door_log, size);
}

static void test_a_request_answers_the_same_after_others_as_before(void) {
    static uint8_t first[DOOR_LOG];
    door_config.forgetful = true; // else it would be a remembered answer
    door_open(0);
    take_hall();
    aisle_query_msg query = door_query(1, 2.0, 4.0, 10.0, 4.0);
    query.options.planner = AISLE_OPTIONS_AUTO;
    (void)door_ask(&query);
    size_t size = door_log_size;
    memcpy(first, door_log, size);
    aisle_query_msg other = door_query(2, 1.0, 1.0, 11.0, 7.0);
    other.options.seed = 99;
    (void)door_ask(&other);
    door_forget();
    (void)door_ask(&query);
    TEST_ASSERT_EQUAL_size_t(size, door_log_size);
    TEST_ASSERT_EQUAL_MEMORY(first, door_log, size);
}

// ---- order

static void test_requests_queue_in_order_and_each_is_answered_once(void) {
    take_hall();
    for (int32_t id = 1; id <= 4; id++) {
        aisle_query_msg query = door_query(id, 2.0, 4.0, 10.0, 4.0);
        TEST_ASSERT_EQUAL(AISLE_OK, door_submit(AISLE_INPUT_QUERY, &query));
    }
    aisle_query_msg more = door_query(5, 2.0, 4.0, 10.0, 4.0);
    int64_t inputs = count(AISLE_COUNTER_INPUTS);
    TEST_ASSERT_EQUAL(AISLE_BUSY, door_submit(AISLE_INPUT_QUERY, &more));
    TEST_ASSERT_EQUAL(AISLE_BUSY, door_layout(2));
    TEST_ASSERT_EQUAL(AISLE_BUSY, door_submit(AISLE_INPUT_VEHICLE, &body));
    TEST_ASSERT_EQUAL_INT64(inputs, count(AISLE_COUNTER_INPUTS));
    int32_t next = 1;
    while (aisle_planner_step(door, door_now, 1000) == AISLE_BUSY) {
        int before = door_replies;
        door_pull_events();
        if (door_replies > before) {
            TEST_ASSERT_EQUAL_INT(before + 1, door_replies);
            TEST_ASSERT_EQUAL_INT32(next, door_reply.query_id);
            next += 1;
        }
    }
    TEST_ASSERT_EQUAL_INT(4, door_replies);
    TEST_ASSERT_EQUAL_INT64(4, count(AISLE_COUNTER_QUERIES));
    TEST_ASSERT_EQUAL(AISLE_OK, door_submit(AISLE_INPUT_QUERY, &more));
}

static void test_nothing_moves_on_while_an_event_waits(void) {
    take_hall();
    aisle_query_msg query = door_query(1, 2.0, 4.0, 10.0, 4.0);
    TEST_ASSERT_EQUAL(AISLE_OK, door_submit(AISLE_INPUT_QUERY, &query));
    query.query_id = 2;
    TEST_ASSERT_EQUAL(AISLE_OK, door_submit(AISLE_INPUT_QUERY, &query));
    for (int i = 0; i < 2000; i++) {
        TEST_ASSERT_EQUAL(AISLE_BUSY, aisle_planner_step(door, door_now, 5000));
    }
    door_pull_events();
    TEST_ASSERT_EQUAL_INT(1, door_replies);
    TEST_ASSERT_EQUAL_INT32(1, door_reply.query_id);
    door_settle();
    TEST_ASSERT_EQUAL_INT32(2, door_reply.query_id);
}

// ---- causes

static int16_t cause_of(const aisle_query_msg *query) {
    const aisle_path_msg *reply = door_ask(query);
    TEST_ASSERT_EQUAL_INT8(AISLE_PATH_NONE, reply->status);
    TEST_ASSERT_TRUE(reply->num_waypoints <= 8);
    return reply->cause;
}

static void place_is(double x, double y) {
    TEST_ASSERT_TRUE(door_reply.num_waypoints >= 1);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, x, door_reply.waypoints[0].x);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, y, door_reply.waypoints[0].y);
}

static void test_no_layout_no_vehicle_and_another_map_are_told(void) {
    door_config.has_vehicle = false;
    door_open(0);
    aisle_query_msg query = door_query(1, 2.0, 4.0, 10.0, 4.0);
    TEST_ASSERT_EQUAL(AISLE_STATUS_NO_VEHICLE, status_now().cause);
    TEST_ASSERT_EQUAL_INT16(AISLE_STATUS_NO_LAYOUT, cause_of(&query));
    TEST_ASSERT_EQUAL(AISLE_STATUS_WAITING, status_now().state);
    take_hall();
    TEST_ASSERT_EQUAL_INT16(AISLE_STATUS_NO_VEHICLE, cause_of(&query));
    TEST_ASSERT_EQUAL(AISLE_STATUS_WAITING, status_now().state);
    body = (aisle_vehicle_msg){.utime = 1, .vehicle_revision = 1};
    TEST_ASSERT_EQUAL(AISLE_OK, door_submit(AISLE_INPUT_VEHICLE, &body));
    door_judge(door_ask(&query));
    query.map_id = 2;
    TEST_ASSERT_EQUAL_INT16(AISLE_STATUS_MAP_MISMATCH, cause_of(&query));
    TEST_ASSERT_EQUAL_INT32(1, door_reply.cause_id);
}

static void test_an_occupied_start_or_goal_is_told_with_what_is_in_the_way_and_where(void) {
    take_hall();
    aisle_query_msg query = door_query(1, 4.75, 4.0, 10.0, 4.0);
    TEST_ASSERT_EQUAL_INT16(AISLE_STATUS_START_OCCUPIED, cause_of(&query));
    TEST_ASSERT_EQUAL_INT32(1, door_reply.cause_id);
    place_is(4.75, 4.0);
    query = door_query(2, 2.0, 4.0, 6.0, 3.5);
    TEST_ASSERT_EQUAL_INT16(AISLE_STATUS_GOAL_OCCUPIED, cause_of(&query));
    TEST_ASSERT_EQUAL_INT32(1, door_reply.cause_id);
    place_is(6.0, 3.5);
    query = door_query(3, 2.0, 4.0, 11.8, 4.0); // too near to the bounds
    TEST_ASSERT_EQUAL_INT16(AISLE_STATUS_GOAL_OCCUPIED, cause_of(&query));
    TEST_ASSERT_EQUAL_INT32(-2, door_reply.cause_id);
    query = door_query(4, 11.45, 4.0, 9.0, 4.0); // free across, not along
    query.start.tolerance_theta = 0.0F;
    TEST_ASSERT_EQUAL_INT16(AISLE_STATUS_START_OCCUPIED, cause_of(&query));
    TEST_ASSERT_EQUAL_INT16(2, door_reply.num_waypoints);
    TEST_ASSERT_DOUBLE_WITHIN(2.5e-3, 0.05, (double)door_reply.cause_value); // slack and spare on top
    TEST_ASSERT_DOUBLE_WITHIN(1e-3, 11.45 - (double)door_reply.cause_value, door_reply.waypoints[1].x);
    TEST_ASSERT_DOUBLE_WITHIN(0.02, 4.0, door_reply.waypoints[1].y); // a circle touches a line
    query.start.theta = 1.5707963;
    TEST_ASSERT_NOT_EQUAL_INT16(AISLE_STATUS_START_OCCUPIED, door_ask(&query)->cause);
}

static void test_a_start_or_goal_outside_is_told(void) {
    take_hall();
    aisle_query_msg query = door_query(1, -1.0, 4.0, 10.0, 4.0);
    TEST_ASSERT_EQUAL_INT16(AISLE_STATUS_POSE_OUTSIDE, cause_of(&query));
    place_is(-1.0, 4.0);
    query = door_query(2, 2.0, 4.0, 10.0, 8.5);
    TEST_ASSERT_EQUAL_INT16(AISLE_STATUS_GOAL_OUTSIDE, cause_of(&query));
    TEST_ASSERT_EQUAL_INT32(11, door_reply.cause_id);
    place_is(10.0, 8.5);
}

static void test_who_moves_as_far_as_told_has_moved_enough(void) {
    take_hall();
    for (int i = 0; i < 40; i++) {
        aisle_query_msg query = door_query(1, 4.6 + 0.013 * i, 4.0 + 0.007 * i, 10.0, 4.0);
        TEST_ASSERT_EQUAL_INT16(AISLE_STATUS_START_OCCUPIED, cause_of(&query));
        aisle_vec2 to = {door_reply.waypoints[1].x - query.start.x, door_reply.waypoints[1].y - query.start.y};
        double told = (double)door_reply.cause_value;
        TEST_ASSERT_TRUE(told >= hypot(to.x, to.y));
        told = ceil(told * 1e3) / 1e3 / hypot(to.x, to.y);
        query = door_query(2, query.start.x + told * to.x, query.start.y + told * to.y, 10.0, 4.0);
        TEST_ASSERT_NOT_EQUAL_INT16(AISLE_STATUS_START_OCCUPIED, door_ask(&query)->cause);
    }
}

static void test_a_goal_walled_in_is_proved_to_have_no_path(void) {
    hall_begin(12.0, 8.0);
    hall_add(5.0, 0.0, 5.2, 8.0);
    take_hall();
    aisle_query_msg query = door_query(1, 2.0, 4.0, 10.0, 4.0);
    TEST_ASSERT_EQUAL_INT16(AISLE_STATUS_NO_PATH, cause_of(&query));
    TEST_ASSERT_EQUAL_INT32(11, door_reply.cause_id);
    place_is(10.0, 4.0);
    TEST_ASSERT_EQUAL_INT16(2, door_reply.num_waypoints); // without the wall there would be a way
    const aisle_waypoint_msg *wall = &door_reply.waypoints[1];
    TEST_ASSERT_EQUAL_INT16(AISLE_WAYPOINT_GOAL, wall->flags);
    TEST_ASSERT_EQUAL_INT32(1, wall->goal_id);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 5.1, wall->x);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 4.0, wall->y);
}

static void test_what_is_proved_when_the_budget_ends_is_told(void) {
    hall_begin(12.0, 8.0);
    hall_add(5.0, 0.0, 5.2, 8.0);
    take_hall();
    aisle_query_msg query = door_query(1, 2.0, 4.0, 10.0, 4.0);
    const int32_t all = door_ask(&query)->work_units;
    bool proved = false; // from some budget on
    for (int32_t budget = 1; budget < all; budget += all / 40) {
        query.options.work_units = budget;
        int16_t cause = cause_of(&query);
        TEST_ASSERT_TRUE(cause == AISLE_STATUS_BUDGET || cause == AISLE_STATUS_NO_PATH);
        TEST_ASSERT_TRUE(!proved || cause == AISLE_STATUS_NO_PATH);
        proved = cause == AISLE_STATUS_NO_PATH;
    }
    TEST_ASSERT_TRUE(proved);
}

static void test_a_door_too_narrow_is_told_with_its_width_and_wall(void) {
    for (int i = 0; i < 4; i++) {
        double width = 0.3 + 0.137 * i; // the disc in the body needs 0.9
        hall_begin(12.0, 8.0);
        hall_add(5.0, 0.0, 5.3, 3.31);
        hall_add(5.0, 3.31 + width, 5.3, 8.0);
        TEST_ASSERT_EQUAL(AISLE_OK, door_layout(1 + i));
        door_settle();
        aisle_query_msg query = door_query(1, 2.0, 4.0, 10.0, 4.0);
        TEST_ASSERT_EQUAL_INT16(AISLE_STATUS_TOO_NARROW, cause_of(&query));
        TEST_ASSERT_DOUBLE_WITHIN(1e-6, width, (double)door_reply.cause_value);
        TEST_ASSERT_TRUE(door_reply.cause_id == 1 || door_reply.cause_id == 2);
        TEST_ASSERT_EQUAL_INT16(4, door_reply.num_waypoints); // place, both sides, the first that may go
        const aisle_waypoint_msg *side = &door_reply.waypoints[1];
        TEST_ASSERT_EQUAL_INT32(door_reply.cause_id, side[0].goal_id);
        TEST_ASSERT_EQUAL_INT32(3, side[0].goal_id + side[1].goal_id);
        TEST_ASSERT_EQUAL_INT16(0, side[0].flags | side[1].flags);
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, side[0].goal_id == 1 ? 3.31 : 3.31 + width, side[0].y);
        TEST_ASSERT_EQUAL_INT16(AISLE_WAYPOINT_GOAL, side[2].flags);
        TEST_ASSERT_EQUAL_INT32(1, side[2].goal_id);
        TEST_ASSERT_DOUBLE_WITHIN(0.4, 5.15, door_reply.waypoints[0].x);
        TEST_ASSERT_DOUBLE_WITHIN(width, 3.31 + width / 2.0, door_reply.waypoints[0].y);
    }
}

static void test_a_small_budget_is_told_and_never_overdrawn_by_more_than_a_piece(void) {
    take_hall();
    aisle_query_msg query = door_query(1, 2.0, 4.0, 10.0, 4.0);
    query.options.planner = AISLE_OPTIONS_AUTO;
    int spent_up = 0;
    for (int32_t budget = 1; budget < 2000000; budget += budget / 2 + 1) {
        query.options.work_units = budget;
        const aisle_path_msg *reply = door_ask(&query);
        TEST_ASSERT_TRUE(reply->work_units <= budget + 4096);
        if (reply->status == AISLE_PATH_NONE) {
            TEST_ASSERT_EQUAL_INT16(AISLE_STATUS_BUDGET, reply->cause);
            spent_up++;
        } else {
            door_judge(reply);
        }
    }
    TEST_ASSERT_TRUE(spent_up > 5 && door_reply.status == AISLE_PATH_OK);
}

static void test_the_configured_budget_holds_where_a_request_names_none(void) {
    door_config.work_units = 50;
    door_open(0);
    take_hall();
    aisle_query_msg query = door_query(1, 2.0, 4.0, 10.0, 4.0);
    TEST_ASSERT_EQUAL_INT16(AISLE_STATUS_BUDGET, cause_of(&query));
    query.options.work_units = 1000000;
    door_judge(door_ask(&query));
}

static void test_unknown_options_are_told_as_malformed(void) {
    take_hall();
    const aisle_options_msg bad[] = {{.planner = 50},      {.planner = AISLE_OPTIONS_ASTAR + 1},
                                     {.objective = 50},    {.objective = -1},
                                     {.interpolation = 2}, {.risk_weight = -1.0F},
                                     {.num_samples = -1},  {.work_units = -1},
                                     {.planner = -1},      {.objective = AISLE_OPTIONS_PAPER}};
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        aisle_query_msg query = door_query(1, 2.0, 4.0, 10.0, 4.0);
        query.options = bad[i];
        TEST_ASSERT_EQUAL_INT16(AISLE_STATUS_MALFORMED, cause_of(&query));
    }
}

static void test_numbers_no_vehicle_can_mean_are_answered_and_change_nothing(void) {
    take_hall();
    aisle_query_msg good = door_query(1, 2.0, 4.0, 10.0, 4.0);
    aisle_query_msg bad[16];
    int n = 0;
    for (int i = 0; i < 16; i++) {
        bad[i] = good;
    }
    bad[n++].start.theta = 1e300;
    bad[n++].start.theta = -2e4;
    bad[n++].start.tolerance_theta = -1.0F;
    bad[n++].start.tolerance_xy = -1.0F;
    bad[n++].goals[0].theta = 1e9;
    bad[n++].goals[0].tolerance_theta = -1e-3F;
    bad[n++].goals[0].tolerance_xy = -1.0F;
    bad[n++].goals[0].dwell = -1.0F;
    bad[n++].goals[0].dwell = 1e30F;
    bad[n++].num_goals = 0;
    for (int i = 0; i < n; i++) {
        TEST_ASSERT_EQUAL_INT16(AISLE_STATUS_MALFORMED, cause_of(&bad[i]));
    }
    bad[n].start.x = 1e300;
    TEST_ASSERT_EQUAL_INT16(AISLE_STATUS_POSE_OUTSIDE, cause_of(&bad[n]));
    bad[n + 1].goals[0].y = -1e300;
    TEST_ASSERT_EQUAL_INT16(AISLE_STATUS_GOAL_OUTSIDE, cause_of(&bad[n + 1]));
    door_judge(door_ask(&good));
}

static void test_more_goals_than_a_list_holds_are_refused_whole(void) {
    take_hall();
    stand_and_go();
    int paths = door_paths;
    static const int16_t bad[] = {-1, 65, 32767, -32768};
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        aisle_query_msg query = door_query(1, 2.0, 4.0, 10.0, 4.0);
        aisle_goal_list_msg goals = door_goals(2, 10.0, 4.0);
        query.num_goals = goals.num_goals = bad[i];
        TEST_ASSERT_EQUAL(AISLE_ERR_DATA, door_submit(AISLE_INPUT_QUERY, &query));
        TEST_ASSERT_EQUAL(AISLE_ERR_DATA, door_submit(AISLE_INPUT_GOALS, &goals));
        TEST_ASSERT_EQUAL_INT16(AISLE_STATUS_LIMIT, status_now().cause);
    }
    door_settle();
    TEST_ASSERT_EQUAL_INT(0, door_replies);
    TEST_ASSERT_EQUAL_INT(paths, door_paths);
    TEST_ASSERT_EQUAL_INT32(1, status_now().goal_list_revision);
}

static void test_inputs_that_are_none_are_errors_of_the_caller(void) {
    aisle_input input = {.kind = AISLE_INPUT_QUERY};
    TEST_ASSERT_EQUAL(AISLE_ERR_ARG, aisle_planner_submit(door, 1, NULL));
    TEST_ASSERT_EQUAL(AISLE_ERR_ARG, aisle_planner_submit(door, 1, &input));
    aisle_query_msg query = door_query(1, 2.0, 4.0, 10.0, 4.0);
    TEST_ASSERT_EQUAL(AISLE_ERR_ARG, door_submit((aisle_input_kind)99, &query));
}

static void test_every_cause_has_a_name_and_others_a_question_mark(void) {
    TEST_ASSERT_EQUAL_STRING("NONE", aisle_cause_name(0));
    TEST_ASSERT_EQUAL_STRING("NO_PATH", aisle_cause_name(AISLE_STATUS_NO_PATH));
    TEST_ASSERT_EQUAL_STRING("TOO_NARROW", aisle_cause_name(AISLE_STATUS_TOO_NARROW));
    TEST_ASSERT_EQUAL_STRING("INTERNAL", aisle_cause_name(AISLE_STATUS_INTERNAL));
    TEST_ASSERT_EQUAL_STRING("?", aisle_cause_name(99));
    TEST_ASSERT_EQUAL_STRING("?", aisle_cause_name(-1));
    int known = 0;
    for (int16_t cause = 100; cause < 600; cause++) {
        known += aisle_cause_name(cause)[0] != '?';
    }
    TEST_ASSERT_EQUAL_INT(31, known);
}

// ---- goals of a query

static void test_start_equal_to_goal_is_a_path_that_stands(void) {
    take_hall();
    aisle_query_msg query = door_query(1, 2.0, 4.0, 2.0, 4.0);
    const aisle_path_msg *path = door_ask(&query);
    door_judge(path);
    TEST_ASSERT_TRUE(path->length < 1e-6F);
    TEST_ASSERT_TRUE((path->waypoints[path->num_waypoints - 1].flags & AISLE_WAYPOINT_GOAL) != 0);
    query.goals[0].tolerance_theta = query.start.tolerance_theta = 0.0F;
    query.goals[0].theta = 2.0;
    door_judge(door_ask(&query)); // turns on the spot
    TEST_ASSERT_DOUBLE_WITHIN(0.05, 2.0, door_reply.waypoints[door_reply.num_waypoints - 1].theta);
}

// Ids of the waypoints flagged GOAL, in order.
static int goals_passed(const aisle_path_msg *path, int32_t *ids) {
    int n = 0;
    for (int16_t i = 0; i < path->num_waypoints; i++) {
        if ((path->waypoints[i].flags & AISLE_WAYPOINT_GOAL) != 0) {
            ids[n++] = path->waypoints[i].goal_id;
        }
    }
    return n;
}

static void test_64_goals_are_passed_in_their_order(void) {
    take_hall();
    aisle_query_msg query = door_query(1, 1.0, 1.0, 0.0, 0.0);
    query.num_goals = 64;
    for (int i = 0; i < 64; i++) {
        double angle = 0.7 * i;
        query.goals[i] = (aisle_goal_msg){
            .id = 100 + i, .x = 6.0 + 4.5 * cos(angle), .y = 4.0 + 2.5 * sin(angle), .tolerance_theta = 4.0F};
    }
    int32_t ids[64];
    door_judge(door_ask(&query));
    TEST_ASSERT_EQUAL_INT(64, goals_passed(&door_reply, ids));
    for (int i = 0; i < 64; i++) {
        TEST_ASSERT_EQUAL_INT32(100 + i, ids[i]);
    }
}

static void test_several_goals_in_one_place_are_all_passed(void) {
    take_hall();
    aisle_query_msg query = door_query(1, 2.0, 4.0, 10.0, 4.0);
    for (int i = 0; i < 5; i++) {
        query.goals[i] = (aisle_goal_msg){.id = 20 + i, .x = 10.0, .y = 4.0, .theta = i < 2 ? 0.5 : -2.0};
    }
    query.num_goals = 5;
    int32_t ids[64];
    door_judge(door_ask(&query));
    TEST_ASSERT_EQUAL_INT(5, goals_passed(&door_reply, ids));
    for (int i = 0; i < 5; i++) {
        TEST_ASSERT_EQUAL_INT32(20 + i, ids[i]);
    }
}

static void test_fixed_headings_are_kept_at_start_and_goal(void) {
    take_hall();
    for (int i = 0; i < 12; i++) {
        aisle_query_msg query = door_query(1, 2.0, 4.0, 10.0, 4.0);
        query.options.planner = i % 2 == 0 ? AISLE_OPTIONS_AUTO : AISLE_OPTIONS_ASTAR;
        query.start.tolerance_theta = query.goals[0].tolerance_theta = 0.0F;
        query.start.theta = remainder(0.55 * i, 2.0 * DOOR_PI);
        query.goals[0].theta = remainder(-0.85 * i, 2.0 * DOOR_PI);
        query.goals[0].tolerance_theta = i % 3 == 0 ? 0.01F : 0.0F;
        const aisle_path_msg *path = door_ask(&query);
        door_judge(path);
        double end = path->waypoints[path->num_waypoints - 1].theta;
        TEST_ASSERT_DOUBLE_WITHIN(1e-6, 0.0, remainder(path->waypoints[0].theta - query.start.theta, 2.0 * DOOR_PI));
        TEST_ASSERT_DOUBLE_WITHIN(i % 3 == 0 ? 0.01 : 0.05, 0.0, remainder(end - query.goals[0].theta, 2.0 * DOOR_PI));
    }
}

static void test_dwell_adds_its_time(void) {
    take_hall();
    aisle_query_msg query = door_query(1, 2.0, 4.0, 2.0, 6.5);
    query.goals[1] = (aisle_goal_msg){.id = 12, .x = 10.0, .y = 4.0, .tolerance_theta = 4.0F};
    query.num_goals = 2;
    float plain = door_ask(&query)->duration;
    query.goals[0].dwell = 12.5F;
    TEST_ASSERT_DOUBLE_WITHIN(0.02, (double)plain + 12.5, (double)door_ask(&query)->duration);
    door_judge(&door_reply);
}

static void test_any_order_takes_the_nearest_goal_first(void) {
    take_hall();
    aisle_query_msg query = door_query(1, 1.0, 1.0, 11.0, 7.0);
    query.ordering = AISLE_GOAL_LIST_ANY_ORDER;
    query.goals[1] = (aisle_goal_msg){.id = 12, .x = 2.0, .y = 2.0, .tolerance_theta = 4.0F};
    query.goals[2] = (aisle_goal_msg){.id = 13, .x = 6.0, .y = 1.5, .tolerance_theta = 4.0F};
    query.num_goals = 3;
    int32_t ids[64];
    door_judge(door_ask(&query));
    TEST_ASSERT_EQUAL_INT(3, goals_passed(&door_reply, ids));
    TEST_ASSERT_EQUAL_INT32(12, ids[0]);
    TEST_ASSERT_EQUAL_INT32(13, ids[1]);
    TEST_ASSERT_EQUAL_INT32(11, ids[2]);
}

// ---- goal lists

// Along the path up to waypoint `end`, a step of at most 0.3 m and 0.15 rad at a time; passing goals it does not rest.
static void drive_along(int16_t end) {
    static aisle_path_msg path;
    path = door_path;
    for (int16_t i = 1; i <= end; i++) {
        const door_piece piece = door_piece_of(&path.waypoints[i - 1], &path.waypoints[i]);
        const int steps = 1 + (int)fmax(piece.length / 0.3, fabs(piece.turn) / 0.15);
        for (int k = 1; k <= steps; k++) {
            const aisle_pose2 pose = door_piece_at(&piece, (double)k / steps);
            here.x = pose.x;
            here.y = pose.y;
            here.theta = pose.theta;
            here.vx = 0.2F;
            door_wait(50000, &here);
        }
    }
}

static void test_a_goal_list_is_answered_by_a_leased_path_from_the_pose(void) {
    take_hall();
    stand_and_go();
    TEST_ASSERT_EQUAL_INT(1, door_paths);
    TEST_ASSERT_EQUAL_INT(0, door_replies);
    door_judge(&door_path);
    TEST_ASSERT_EQUAL_INT32(4, door_path.goal_list_id);
    TEST_ASSERT_EQUAL_INT32(1, door_path.goal_list_revision);
    TEST_ASSERT_EQUAL_INT32(0, door_path.query_id);
    TEST_ASSERT_EQUAL_INT64(here.utime, door_path.pose_utime);
    TEST_ASSERT_EQUAL_INT64(door_now, door_path.utime);
    TEST_ASSERT_EQUAL_INT64(door_now + AISLE_LEASE_US, door_path.valid_until_utime);
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, 2.0, door_path.waypoints[0].x);
    aisle_status_msg status = status_now();
    TEST_ASSERT_EQUAL(AISLE_STATUS_ACTIVE, status.state);
    TEST_ASSERT_EQUAL_INT32(4, status.goal_list_id);
    TEST_ASSERT_EQUAL_INT32(1, status.goal_list_revision);
    TEST_ASSERT_EQUAL_INT32(11, status.goal_id);
    TEST_ASSERT_EQUAL_INT32(door_path.path_revision, status.path_revision);
    TEST_ASSERT_EQUAL_FLOAT(door_path.length, status.distance_remaining);
    TEST_ASSERT_EQUAL_FLOAT(door_path.duration, status.time_remaining);
    TEST_ASSERT_EQUAL_INT64(1, count(AISLE_COUNTER_GOAL_LISTS));
}

static void test_auto_sends_the_first_proof_and_then_the_better_path_as_the_next_revision(void) {
    take_hall();
    here = door_pose(2.0, 4.0, 0.0);
    TEST_ASSERT_EQUAL(AISLE_OK, door_submit(AISLE_INPUT_POSE, &here));
    aisle_goal_list_msg goals = door_goals(1, 10.0, 4.0);
    goals.options.planner = AISLE_OPTIONS_PSO; // the swarm's path whatever it is worth
    TEST_ASSERT_EQUAL(AISLE_OK, door_submit(AISLE_INPUT_GOALS, &goals));
    int32_t revision = 0;
    while (aisle_planner_step(door, door_now, 1000) == AISLE_BUSY) {
        int before = door_paths;
        door_pull_events();
        if (door_paths > before) {
            door_judge(&door_path);
            TEST_ASSERT_EQUAL_INT32(revision + 1, door_path.path_revision);
            revision = door_path.path_revision;
        }
    }
    TEST_ASSERT_EQUAL_INT(2, door_paths);
    TEST_ASSERT_EQUAL_INT8(AISLE_OPTIONS_PSO, door_path.planner);
    TEST_ASSERT_EQUAL_INT64(1, count(AISLE_COUNTER_GOAL_LISTS));
    TEST_ASSERT_EQUAL_INT64(2, count(AISLE_COUNTER_PATHS));
}

static void test_auto_sends_no_path_twice_where_the_first_one_stays(void) {
    int kept = 0;
    take_hall();
    here = door_pose(2.0, 4.0, 0.0);
    TEST_ASSERT_EQUAL(AISLE_OK, door_submit(AISLE_INPUT_POSE, &here));
    for (int32_t i = 0; i < 8; i++) {
        int before = door_paths;
        aisle_goal_list_msg goals = door_goals(1 + i, 10.0, 2.0 + 0.5 * i);
        goals.options.planner = AISLE_OPTIONS_AUTO;
        goals.options.objective = (int8_t)(i % 4);
        TEST_ASSERT_EQUAL(AISLE_OK, door_submit(AISLE_INPUT_GOALS, &goals));
        door_settle();
        bool improved = door_path.planner == AISLE_OPTIONS_PSO;
        TEST_ASSERT_EQUAL_INT(before + (improved ? 2 : 1), door_paths);
        kept += !improved;
    }
    TEST_ASSERT_GREATER_THAN_INT(0, kept);
}

// The last two PATH events differ in utime and valid_until_utime alone.
static void renewed_only(void) {
    size_t utime = 0;
    size_t valid = 0;
    TEST_ASSERT_TRUE(aisle_msg_field_offset(AISLE_MSG_PATH, "utime", &utime));
    TEST_ASSERT_TRUE(aisle_msg_field_offset(AISLE_MSG_PATH, "valid_until_utime", &valid));
    TEST_ASSERT_EQUAL_size_t(door_path_before_size, door_path_size);
    TEST_ASSERT_TRUE(memcmp(door_path_before, door_path_bytes, door_path_size) != 0);
    memcpy(door_path_before + utime, door_path_bytes + utime, 8);
    memcpy(door_path_before + valid, door_path_bytes + valid, 8);
    TEST_ASSERT_EQUAL_MEMORY(door_path_before, door_path_bytes, door_path_size);
    TEST_ASSERT_EQUAL_INT64(door_path.utime + AISLE_LEASE_US, door_path.valid_until_utime);
}

static void test_the_lease_is_renewed_every_half_second_and_nothing_else_changes(void) {
    take_hall();
    stand_and_go();
    for (int i = 0; i < 4; i++) {
        int before = door_paths;
        int64_t due = aisle_planner_next_deadline(door);
        TEST_ASSERT_EQUAL_INT64(door_path.utime + AISLE_LEASE_RESEND_US, due);
        door_wait(AISLE_LEASE_RESEND_US - 50000, &here);
        TEST_ASSERT_EQUAL_INT(before, door_paths);
        door_wait(50000, &here);
        TEST_ASSERT_EQUAL_INT(before + 1, door_paths);
        TEST_ASSERT_EQUAL_INT64(door_now, door_path.utime);
        renewed_only();
    }
    TEST_ASSERT_EQUAL_INT64(1, count(AISLE_COUNTER_PATHS));
}

static void test_the_lease_runs_out_with_a_stale_pose_and_goes_on_with_a_fresh_one(void) {
    take_hall();
    stand_and_go();
    int before = door_paths;
    door_wait(3000000, NULL);
    TEST_ASSERT_EQUAL_INT(before, door_paths);
    TEST_ASSERT_EQUAL(AISLE_STATUS_BLOCKED, status_now().state);
    TEST_ASSERT_EQUAL_INT16(AISLE_STATUS_POSE_STALE, status_now().cause);
    TEST_ASSERT_EQUAL_INT64(INT64_MAX, aisle_planner_next_deadline(door));
    door_wait(50000, &here);
    TEST_ASSERT_EQUAL_INT(before + 1, door_paths);
    renewed_only();
    TEST_ASSERT_EQUAL(AISLE_STATUS_ACTIVE, status_now().state);
}

static void test_the_lease_runs_out_while_the_pose_is_not_localized(void) {
    take_hall();
    stand_and_go();
    int before = door_paths;
    here.localized = 0;
    door_wait(2000000, &here);
    TEST_ASSERT_EQUAL_INT(before, door_paths);
    TEST_ASSERT_EQUAL_INT16(AISLE_STATUS_NOT_LOCALIZED, status_now().cause);
    here.localized = 1;
    door_wait(50000, &here);
    TEST_ASSERT_EQUAL_INT(before + 1, door_paths);
}

static void test_a_pose_on_another_map_drives_nobody(void) {
    take_hall();
    stand_and_go();
    int before = door_paths;
    here.map_id = 2;
    door_wait(1000000, &here);
    TEST_ASSERT_EQUAL_INT(before, door_paths);
    TEST_ASSERT_EQUAL_INT16(AISLE_STATUS_MAP_MISMATCH, status_now().cause);
    TEST_ASSERT_EQUAL_INT32(2, status_now().cause_id);
    aisle_goal_list_msg goals = door_goals(2, 10.0, 5.0);
    TEST_ASSERT_EQUAL(AISLE_OK, door_submit(AISLE_INPUT_GOALS, &goals));
    door_settle();
    TEST_ASSERT_EQUAL_INT8(AISLE_PATH_NONE, door_path.status);
    TEST_ASSERT_EQUAL_INT16(AISLE_STATUS_MAP_MISMATCH, door_path.cause);
    here.map_id = 1;
    door_wait(50000, &here);
    door_judge(&door_path);
    TEST_ASSERT_EQUAL_INT32(2, door_path.goal_list_revision);
}

static aisle_status command(int8_t which, int32_t id) {
    aisle_command_msg msg = {.command = which, .command_id = id};
    return door_submit(AISLE_INPUT_COMMAND, &msg);
}

static void test_hold_stops_the_lease_and_resume_renews_it_at_once(void) {
    take_hall();
    stand_and_go();
    int before = door_paths;
    TEST_ASSERT_EQUAL(AISLE_OK, command(AISLE_COMMAND_HOLD, 31));
    door_wait(2000000, &here);
    TEST_ASSERT_EQUAL_INT(before, door_paths);
    TEST_ASSERT_EQUAL(AISLE_STATUS_HELD, status_now().state);
    TEST_ASSERT_EQUAL_INT32(31, status_now().command_id);
    TEST_ASSERT_EQUAL_INT64(INT64_MAX, aisle_planner_next_deadline(door));
    TEST_ASSERT_EQUAL(AISLE_OK, command(AISLE_COMMAND_RESUME, 32));
    door_settle();
    TEST_ASSERT_EQUAL_INT(before + 1, door_paths);
    renewed_only();
    TEST_ASSERT_EQUAL(AISLE_STATUS_ACTIVE, status_now().state);
}

static void test_resume_after_a_short_hold_does_not_wait_for_the_next_turn(void) {
    take_hall();
    stand_and_go();
    TEST_ASSERT_EQUAL(AISLE_OK, command(AISLE_COMMAND_HOLD, 1));
    door_wait(100000, &here);
    TEST_ASSERT_EQUAL(AISLE_OK, command(AISLE_COMMAND_RESUME, 2));
    door_settle();
    TEST_ASSERT_EQUAL_INT(2, door_paths);
    TEST_ASSERT_EQUAL_INT64(door_now, door_path.utime);
}

static void test_no_path_leaves_while_held_not_even_a_new_one(void) {
    take_hall();
    TEST_ASSERT_EQUAL(AISLE_OK, command(AISLE_COMMAND_HOLD, 1));
    stand_and_go();
    TEST_ASSERT_EQUAL_INT(0, door_paths);
    TEST_ASSERT_EQUAL(AISLE_OK, command(AISLE_COMMAND_RESUME, 2));
    door_settle();
    TEST_ASSERT_EQUAL_INT(1, door_paths);
    door_judge(&door_path);
    TEST_ASSERT_EQUAL_INT64(door_now + AISLE_LEASE_US, door_path.valid_until_utime);
}

static void test_no_path_leaves_on_a_stale_pose_not_even_a_new_one(void) {
    take_hall();
    here = door_pose(2.0, 4.0, 0.0);
    TEST_ASSERT_EQUAL(AISLE_OK, door_submit(AISLE_INPUT_POSE, &here));
    door_wait(1000000, NULL);
    aisle_goal_list_msg goals = door_goals(1, 10.0, 4.0);
    TEST_ASSERT_EQUAL(AISLE_OK, door_submit(AISLE_INPUT_GOALS, &goals));
    door_settle();
    TEST_ASSERT_EQUAL_INT(0, door_paths);
    TEST_ASSERT_EQUAL_INT16(AISLE_STATUS_POSE_STALE, status_now().cause);
    door_wait(50000, &here);
    TEST_ASSERT_EQUAL_INT(1, door_paths);
    door_judge(&door_path);
}

static void test_resend_sends_the_path_at_once(void) {
    take_hall();
    stand_and_go();
    door_wait(100000, &here);
    int before = door_paths;
    TEST_ASSERT_EQUAL(AISLE_OK, command(AISLE_COMMAND_RESEND, 1));
    door_settle();
    TEST_ASSERT_EQUAL_INT(before + 1, door_paths);
    renewed_only();
}

static void revoked_with(int16_t cause, int32_t id) {
    TEST_ASSERT_EQUAL_INT8(AISLE_PATH_NONE, door_path.status);
    TEST_ASSERT_EQUAL_INT16(cause, door_path.cause);
    TEST_ASSERT_EQUAL_INT32(id, door_path.cause_id);
    TEST_ASSERT_TRUE(door_path.num_waypoints <= 1);
}

static void test_cancel_and_an_empty_list_revoke_the_path(void) {
    take_hall();
    for (int i = 0; i < 2; i++) {
        here = door_pose(2.0, 4.0, 0.0);
        TEST_ASSERT_EQUAL(AISLE_OK, door_submit(AISLE_INPUT_POSE, &here));
        aisle_goal_list_msg goals = door_goals(2 * i + 1, 10.0, 4.0);
        TEST_ASSERT_EQUAL(AISLE_OK, door_submit(AISLE_INPUT_GOALS, &goals));
        door_settle();
        int before = door_paths;
        int32_t revision = door_path.path_revision;
        goals = door_goals(2 * i + 2, 0.0, 0.0);
        goals.num_goals = 0;
        TEST_ASSERT_EQUAL(AISLE_OK, i == 0 ? command(AISLE_COMMAND_CANCEL, 9) : door_submit(AISLE_INPUT_GOALS, &goals));
        door_settle();
        TEST_ASSERT_EQUAL_INT(before + 1, door_paths);
        revoked_with(0, 0);
        TEST_ASSERT_EQUAL_INT32(revision + 1, door_path.path_revision);
        TEST_ASSERT_EQUAL(AISLE_STATUS_IDLE, status_now().state);
        TEST_ASSERT_EQUAL_INT32(0, status_now().goal_list_id);
        door_wait(1000000, &here);
        TEST_ASSERT_EQUAL_INT(before + 1, door_paths);
    }
}

static void test_cancel_ends_a_plan_under_way_without_an_event(void) {
    take_hall();
    here = door_pose(2.0, 4.0, 0.0);
    TEST_ASSERT_EQUAL(AISLE_OK, door_submit(AISLE_INPUT_POSE, &here));
    aisle_goal_list_msg goals = door_goals(1, 10.0, 4.0);
    TEST_ASSERT_EQUAL(AISLE_OK, door_submit(AISLE_INPUT_GOALS, &goals));
    for (int i = 0; i < 5; i++) {
        TEST_ASSERT_EQUAL(AISLE_BUSY, aisle_planner_step(door, door_now, 10));
    }
    TEST_ASSERT_EQUAL(AISLE_STATUS_PLANNING, status_now().state);
    TEST_ASSERT_EQUAL(AISLE_OK, command(AISLE_COMMAND_CANCEL, 1));
    door_settle();
    TEST_ASSERT_EQUAL_INT(0, door_paths);
    TEST_ASSERT_EQUAL(AISLE_STATUS_IDLE, status_now().state);
}

static void test_a_list_cancelled_before_its_turn_is_not_even_refused(void) {
    aisle_goal_list_msg goals = door_goals(1, 10.0, 4.0);
    TEST_ASSERT_EQUAL(AISLE_OK, door_submit(AISLE_INPUT_GOALS, &goals)); // there is no layout
    TEST_ASSERT_EQUAL(AISLE_OK, command(AISLE_COMMAND_CANCEL, 1));
    door_settle();
    TEST_ASSERT_EQUAL_INT(0, door_paths);
    TEST_ASSERT_EQUAL_INT64(0, count(AISLE_COUNTER_GOAL_LISTS));
}

static void test_unknown_commands_are_refused(void) {
    TEST_ASSERT_EQUAL(AISLE_OK, command(AISLE_COMMAND_HOLD, 5));
    TEST_ASSERT_EQUAL(AISLE_ERR_DATA, command(4, 6));
    TEST_ASSERT_EQUAL(AISLE_ERR_DATA, command(-1, 7));
    TEST_ASSERT_EQUAL_INT32(5, status_now().command_id);
    TEST_ASSERT_EQUAL_INT16(AISLE_STATUS_MALFORMED, status_now().cause);
}

// A source's snapshot: nothing, or a person so near ahead of (2, 4) that nobody may start.
static aisle_status obstacles(int32_t source, int16_t n, int32_t id) {
    static aisle_obstacles_msg msg;
    static int32_t seq;
    memset(&msg, 0, sizeof msg);
    msg.utime = door_now;
    msg.seq = ++seq;
    msg.source = source;
    msg.num_obstacles = n;
    msg.obstacles[0] =
        (aisle_obstacle_msg){.id = id, .kind = AISLE_OBSTACLE_PERSON, .x = 2.95, .y = 4.0, .radius = 0.3F};
    return door_submit(AISLE_INPUT_OBSTACLES, &msg);
}

static void test_no_path_is_out_while_a_moving_obstacle_is_too_near(void) {
    take_hall();
    stand_and_go();
    TEST_ASSERT_EQUAL(AISLE_OK, obstacles(0, 0, 0));
    door_settle();
    TEST_ASSERT_EQUAL_INT(1, door_paths);
    TEST_ASSERT_EQUAL(AISLE_OK, obstacles(1, 1, 42));
    door_settle();
    TEST_ASSERT_EQUAL_INT(2, door_paths);
    revoked_with(AISLE_STATUS_YIELDING, 42);
    TEST_ASSERT_EQUAL(AISLE_OK, obstacles(0, 0, 0)); // another source sees nothing
    door_settle();
    TEST_ASSERT_EQUAL_INT(2, door_paths);
    TEST_ASSERT_EQUAL(AISLE_STATUS_BLOCKED, status_now().state);
    TEST_ASSERT_EQUAL_INT16(AISLE_STATUS_YIELDING, status_now().cause);
    TEST_ASSERT_EQUAL_INT32(42, status_now().cause_id);
    door_wait(1000000, &here);
    TEST_ASSERT_EQUAL_INT(2, door_paths);
    TEST_ASSERT_EQUAL_INT16(AISLE_STATUS_OBSTACLES_STALE, status_now().cause); // who spoke once must keep speaking
    TEST_ASSERT_EQUAL_INT32(0, status_now().cause_id);
    TEST_ASSERT_EQUAL(AISLE_ERR_DATA, obstacles(4, 0, 0));
    TEST_ASSERT_EQUAL(AISLE_ERR_DATA, obstacles(-1, 0, 0));
}

static void test_the_way_goes_on_when_the_moving_obstacle_is_gone(void) {
    take_hall();
    stand_and_go();
    TEST_ASSERT_EQUAL(AISLE_OK, obstacles(1, 1, 42));
    door_settle();
    TEST_ASSERT_EQUAL_INT(2, door_paths);
    TEST_ASSERT_EQUAL(AISLE_OK, obstacles(1, 0, 0));
    door_settle();
    TEST_ASSERT_EQUAL_INT(3, door_paths);
    door_judge(&door_path);
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, 2.0, door_path.waypoints[0].x);
    TEST_ASSERT_EQUAL(AISLE_STATUS_ACTIVE, status_now().state);
}

static void test_goals_that_come_while_a_moving_obstacle_is_too_near_wait_for_it(void) {
    take_hall();
    TEST_ASSERT_EQUAL(AISLE_OK, obstacles(2, 1, 43));
    stand_and_go();
    TEST_ASSERT_EQUAL_INT(1, door_paths);
    revoked_with(AISLE_STATUS_YIELDING, 43);
    TEST_ASSERT_EQUAL(AISLE_OK, obstacles(2, 0, 0));
    door_settle();
    TEST_ASSERT_EQUAL_INT(2, door_paths);
    door_judge(&door_path);
}

static void test_a_moving_obstacle_that_appears_while_planning_keeps_the_path_back(void) {
    take_hall();
    here = door_pose(2.0, 4.0, 0.0);
    TEST_ASSERT_EQUAL(AISLE_OK, door_submit(AISLE_INPUT_POSE, &here));
    aisle_goal_list_msg goals = door_goals(1, 10.0, 4.0);
    TEST_ASSERT_EQUAL(AISLE_OK, door_submit(AISLE_INPUT_GOALS, &goals));
    TEST_ASSERT_EQUAL(AISLE_BUSY, aisle_planner_step(door, door_now, 10));
    TEST_ASSERT_EQUAL(AISLE_BUSY, aisle_planner_step(door, door_now, 10));
    TEST_ASSERT_EQUAL(AISLE_OK, obstacles(0, 1, 44));
    door_settle();
    TEST_ASSERT_EQUAL_INT(1, door_paths);
    revoked_with(AISLE_STATUS_YIELDING, 44);
    TEST_ASSERT_EQUAL(AISLE_OK, obstacles(0, 0, 0));
    door_settle();
    TEST_ASSERT_EQUAL(AISLE_STATUS_ACTIVE, status_now().state);
    door_judge(&door_path);
}

static void test_without_a_pose_the_goals_wait_for_one(void) {
    take_hall();
    aisle_goal_list_msg goals = door_goals(1, 10.0, 4.0);
    TEST_ASSERT_EQUAL(AISLE_OK, door_submit(AISLE_INPUT_GOALS, &goals));
    door_settle();
    TEST_ASSERT_EQUAL_INT(1, door_paths);
    revoked_with(AISLE_STATUS_NO_POSE, 0);
    TEST_ASSERT_EQUAL(AISLE_STATUS_BLOCKED, status_now().state);
    TEST_ASSERT_EQUAL_INT16(AISLE_STATUS_NO_POSE, status_now().cause);
    here = door_pose(2.0, 4.0, 0.0);
    here.localized = 0;
    here.seq = 5;
    door_wait(50000, &here);
    revoked_with(AISLE_STATUS_NOT_LOCALIZED, 6);
    here.localized = 1;
    door_wait(50000, &here);
    door_judge(&door_path);
    TEST_ASSERT_EQUAL(AISLE_STATUS_ACTIVE, status_now().state);
}

static void test_goal_lists_held_are_duplicates_older_ones_outdated_other_ones_conflicts(void) {
    take_hall();
    here = door_pose(2.0, 4.0, 0.0);
    TEST_ASSERT_EQUAL(AISLE_OK, door_submit(AISLE_INPUT_POSE, &here));
    aisle_goal_list_msg goals = door_goals(5, 10.0, 4.0);
    goals.ordering = AISLE_GOAL_LIST_ANY_ORDER;
    goals.num_goals = 2;
    goals.goals[1] = (aisle_goal_msg){.id = 12, .x = 3.0, .y = 4.0, .tolerance_theta = 4.0F};
    TEST_ASSERT_EQUAL(AISLE_OK, door_submit(AISLE_INPUT_GOALS, &goals));
    door_settle();
    here.x = 9.0; // the order by distance would be another one from here
    door_wait(50000, &here);
    int before = door_paths;
    goals.utime = 12345;
    TEST_ASSERT_EQUAL(AISLE_OK, door_submit(AISLE_INPUT_GOALS, &goals));
    TEST_ASSERT_EQUAL_INT64(1, count(AISLE_COUNTER_DUPLICATES));
    goals.options.objective = AISLE_OPTIONS_SHORTEST;
    TEST_ASSERT_EQUAL(AISLE_ERR_DATA, door_submit(AISLE_INPUT_GOALS, &goals));
    TEST_ASSERT_EQUAL_INT16(AISLE_STATUS_CONFLICT, status_now().cause);
    goals.options.objective = AISLE_OPTIONS_SAFEST;
    goals.ordering = AISLE_GOAL_LIST_ORDERED;
    TEST_ASSERT_EQUAL(AISLE_ERR_DATA, door_submit(AISLE_INPUT_GOALS, &goals));
    goals.ordering = AISLE_GOAL_LIST_ANY_ORDER;
    goals.map_id = 0;
    TEST_ASSERT_EQUAL(AISLE_ERR_DATA, door_submit(AISLE_INPUT_GOALS, &goals));
    goals.map_id = 1;
    goals.goals[1].x = 3.5;
    TEST_ASSERT_EQUAL(AISLE_ERR_DATA, door_submit(AISLE_INPUT_GOALS, &goals));
    TEST_ASSERT_EQUAL_INT16(AISLE_STATUS_CONFLICT, status_now().cause);
    goals = door_goals(4, 10.0, 4.0);
    TEST_ASSERT_EQUAL(AISLE_ERR_DATA, door_submit(AISLE_INPUT_GOALS, &goals));
    TEST_ASSERT_EQUAL_INT16(AISLE_STATUS_OUTDATED, status_now().cause);
    door_settle();
    TEST_ASSERT_EQUAL_INT(before, door_paths);
    TEST_ASSERT_EQUAL_INT64(5, count(AISLE_COUNTER_REJECTED));
}

static void test_a_list_sent_again_after_it_was_cancelled_or_reached_moves_nobody(void) {
    take_hall();
    stand_and_go();
    TEST_ASSERT_EQUAL(AISLE_OK, command(AISLE_COMMAND_CANCEL, 1));
    door_settle();
    int before = door_paths;
    aisle_goal_list_msg goals = door_goals(1, 10.0, 4.0);
    TEST_ASSERT_EQUAL(AISLE_OK, door_submit(AISLE_INPUT_GOALS, &goals));
    door_wait(1000000, &here);
    TEST_ASSERT_EQUAL_INT(before, door_paths);
    TEST_ASSERT_EQUAL_INT64(1, count(AISLE_COUNTER_DUPLICATES));
    TEST_ASSERT_EQUAL(AISLE_STATUS_IDLE, status_now().state);
    goals.goal_list_revision = 2;
    TEST_ASSERT_EQUAL(AISLE_OK, door_submit(AISLE_INPUT_GOALS, &goals));
    door_settle();
    door_judge(&door_path);
}

static void test_a_newer_list_takes_over_from_one_not_yet_planned(void) {
    take_hall();
    here = door_pose(2.0, 4.0, 0.0);
    TEST_ASSERT_EQUAL(AISLE_OK, door_submit(AISLE_INPUT_POSE, &here));
    for (int32_t revision = 1; revision <= 3; revision++) {
        aisle_goal_list_msg goals = door_goals(revision, 10.0, 3.0 + revision);
        TEST_ASSERT_EQUAL(AISLE_OK, door_submit(AISLE_INPUT_GOALS, &goals));
        (void)aisle_planner_step(door, door_now, 10);
    }
    door_settle();
    TEST_ASSERT_EQUAL_INT(1, door_paths);
    TEST_ASSERT_EQUAL_INT32(3, door_path.goal_list_revision);
    door_judge(&door_path);
}

static void test_a_goal_reached_at_rest_ends_the_mission(void) {
    take_hall();
    stand_and_go();
    drive_along((int16_t)(door_path.num_waypoints - 1));
    here.vx = 0.2F; // passing through is not reaching
    door_wait(50000, &here);
    TEST_ASSERT_EQUAL(AISLE_STATUS_ACTIVE, status_now().state);
    TEST_ASSERT_FLOAT_WITHIN(0.01F, 0.0F, status_now().distance_remaining);
    TEST_ASSERT_FLOAT_WITHIN(0.01F, 0.0F, status_now().time_remaining);
    here.vx = 0.0F;
    here.x = 10.06; // nor is stopping beside it
    door_wait(50000, &here);
    TEST_ASSERT_EQUAL(AISLE_STATUS_ACTIVE, status_now().state);
    here.x = 10.04;
    door_wait(50000, &here);
    TEST_ASSERT_EQUAL(AISLE_STATUS_IDLE, status_now().state);
    int before = door_paths;
    door_wait(2000000, &here);
    TEST_ASSERT_EQUAL_INT(before, door_paths);
    TEST_ASSERT_EQUAL_INT32(0, status_now().goal_id);
}

static void test_a_new_list_while_standing_on_its_goal_is_answered_all_the_same(void) {
    take_hall();
    stand_and_go();
    aisle_goal_list_msg goals = door_goals(2, here.x, here.y);
    TEST_ASSERT_EQUAL(AISLE_OK, door_submit(AISLE_INPUT_POSE, &here));
    int before = door_paths;
    TEST_ASSERT_EQUAL(AISLE_OK, door_submit(AISLE_INPUT_GOALS, &goals));
    here.utime += 1;
    TEST_ASSERT_EQUAL(AISLE_OK, door_submit(AISLE_INPUT_POSE, &here)); // before the plan begins
    door_settle();
    TEST_ASSERT_EQUAL_INT(before + 1, door_paths);
    TEST_ASSERT_EQUAL_INT32(2, door_path.goal_list_revision);
}

static void test_status_names_the_next_goal_of_several(void) {
    take_hall();
    here = door_pose(2.0, 4.0, 0.0);
    TEST_ASSERT_EQUAL(AISLE_OK, door_submit(AISLE_INPUT_POSE, &here));
    aisle_goal_list_msg goals = door_goals(1, 3.0, 6.0);
    goals.goals[1] = (aisle_goal_msg){.id = 12, .x = 10.0, .y = 4.0, .tolerance_theta = 4.0F};
    goals.num_goals = 2;
    TEST_ASSERT_EQUAL(AISLE_OK, door_submit(AISLE_INPUT_GOALS, &goals));
    door_settle();
    TEST_ASSERT_EQUAL_INT32(11, status_now().goal_id);
    here.x = 3.0;
    here.y = 6.0;
    door_wait(50000, &here);
    TEST_ASSERT_EQUAL_INT32(12, status_now().goal_id);
    TEST_ASSERT_EQUAL(AISLE_OK, door_layout(2)); // replans the goals that are left
    door_settle();
    int32_t ids[64];
    door_judge(&door_path);
    TEST_ASSERT_EQUAL_INT(1, goals_passed(&door_path, ids));
    TEST_ASSERT_EQUAL_INT32(12, ids[0]);
    TEST_ASSERT_EQUAL(AISLE_OK, door_submit(AISLE_INPUT_GOALS, &goals)); // still a duplicate
    TEST_ASSERT_EQUAL_INT64(1, count(AISLE_COUNTER_DUPLICATES));
}

static void test_a_new_layout_revokes_the_path_and_plans_again_from_the_present_pose(void) {
    take_hall();
    stand_and_go();
    drive_along(2);
    here.vx = 0.0F;
    door_wait(50000, &here);
    TEST_ASSERT_TRUE(here.x > 2.1);
    int32_t revision = door_path.path_revision;
    const int before = door_paths;
    hall_add(2.0, 6.0, 4.0, 7.5);
    TEST_ASSERT_EQUAL(AISLE_OK, door_layout(2));
    door_pull_events();
    TEST_ASSERT_EQUAL_INT(before + 1, door_paths);
    revoked_with(AISLE_STATUS_MAP_MISMATCH, 2);
    door_settle();
    TEST_ASSERT_EQUAL_INT(before + 2, door_paths);
    door_judge(&door_path);
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, here.x, door_path.waypoints[0].x);
    TEST_ASSERT_EQUAL_INT32(2, door_path.map_revision);
    TEST_ASSERT_EQUAL_INT32(revision + 2, door_path.path_revision);
}

static void test_requests_that_fill_the_queue_while_a_layout_is_built_do_not_hurt_the_mission(void) {
    take_hall();
    stand_and_go();
    TEST_ASSERT_EQUAL(AISLE_OK, door_layout(2));
    int32_t id = 0;
    aisle_query_msg query;
    do {
        query = door_query(++id, 2.0, 4.0, 10.0, 4.0);
    } while (door_submit(AISLE_INPUT_QUERY, &query) == AISLE_OK);
    TEST_ASSERT_EQUAL_INT32(5, id);
    door_settle();
    TEST_ASSERT_EQUAL_INT(4, door_replies);
    TEST_ASSERT_EQUAL_INT(3, door_paths);
    door_judge(&door_path);
}

static void test_goals_that_come_while_a_layout_is_built_are_planned_once(void) {
    take_hall();
    stand_and_go();
    TEST_ASSERT_EQUAL(AISLE_OK, door_layout(2));
    door_pull_events();
    aisle_goal_list_msg goals = door_goals(2, 10.0, 5.0);
    TEST_ASSERT_EQUAL(AISLE_OK, door_submit(AISLE_INPUT_GOALS, &goals));
    door_settle();
    TEST_ASSERT_EQUAL_INT(3, door_paths);
    TEST_ASSERT_EQUAL_INT64(2, count(AISLE_COUNTER_GOAL_LISTS));
    TEST_ASSERT_EQUAL_INT32(2, door_path.goal_list_revision);
}

static void test_a_new_vehicle_revokes_and_plans_again(void) {
    take_hall();
    body = (aisle_vehicle_msg){.vehicle_revision = 3, .footprint_radius = 0.3F};
    TEST_ASSERT_EQUAL(AISLE_OK, door_submit(AISLE_INPUT_VEHICLE, &body)); // the settings' one gives way
    TEST_ASSERT_EQUAL_INT32(3, status_now().vehicle_revision);
    stand_and_go();
    TEST_ASSERT_EQUAL_INT32(3, door_path.vehicle_revision);
    body.utime = 99;
    TEST_ASSERT_EQUAL(AISLE_OK, door_submit(AISLE_INPUT_VEHICLE, &body));
    TEST_ASSERT_EQUAL_INT64(1, count(AISLE_COUNTER_DUPLICATES));
    body.v_max = 1.0F;
    TEST_ASSERT_EQUAL(AISLE_ERR_DATA, door_submit(AISLE_INPUT_VEHICLE, &body));
    TEST_ASSERT_EQUAL_INT16(AISLE_STATUS_CONFLICT, status_now().cause);
    body.vehicle_revision = 2;
    TEST_ASSERT_EQUAL(AISLE_ERR_DATA, door_submit(AISLE_INPUT_VEHICLE, &body));
    TEST_ASSERT_EQUAL_INT16(AISLE_STATUS_OUTDATED, status_now().cause);
    body.vehicle_revision = 4;
    body.a_max = -1.0F;
    TEST_ASSERT_EQUAL(AISLE_ERR_DATA, door_submit(AISLE_INPUT_VEHICLE, &body));
    TEST_ASSERT_EQUAL_INT16(AISLE_STATUS_MALFORMED, status_now().cause);
    TEST_ASSERT_EQUAL_INT(1, door_paths);
    body.a_max = 0.0F;
    TEST_ASSERT_EQUAL(AISLE_OK, door_submit(AISLE_INPUT_VEHICLE, &body));
    door_pull_events();
    revoked_with(AISLE_STATUS_CONFLICT, 4);
    door_settle();
    TEST_ASSERT_EQUAL_INT(3, door_paths);
    TEST_ASSERT_EQUAL_INT32(4, door_path.vehicle_revision);
    hall_disc((double)body.footprint_radius, 0.1F);
    door_judge(&door_path);
}

static void test_poses_out_of_order_or_range_are_refused(void) {
    here = door_pose(2.0, 4.0, 0.0);
    here.seq = 9;
    TEST_ASSERT_EQUAL(AISLE_OK, door_submit(AISLE_INPUT_POSE, &here));
    TEST_ASSERT_EQUAL(AISLE_OK, door_submit(AISLE_INPUT_POSE, &here));
    TEST_ASSERT_EQUAL_INT64(1, count(AISLE_COUNTER_DUPLICATES));
    here.utime -= 1;
    TEST_ASSERT_EQUAL(AISLE_ERR_DATA, door_submit(AISLE_INPUT_POSE, &here));
    TEST_ASSERT_EQUAL_INT16(AISLE_STATUS_OUTDATED, status_now().cause);
    TEST_ASSERT_EQUAL_INT32(9, status_now().cause_id);
    const double huge[3][3] = {{1e300, 0.0, 0.0}, {0.0, -1e300, 0.0}, {0.0, 0.0, 1e300}};
    for (int i = 0; i < 3; i++) {
        aisle_pose_msg bad = door_pose(huge[i][0], huge[i][1], huge[i][2]);
        bad.utime += 10;
        TEST_ASSERT_EQUAL(AISLE_ERR_DATA, door_submit(AISLE_INPUT_POSE, &bad));
        TEST_ASSERT_EQUAL_INT16(AISLE_STATUS_MALFORMED, status_now().cause);
    }
    aisle_pose_msg bad = door_pose(2.0, 4.0, 0.0);
    float *rate[3] = {&bad.vx, &bad.vy, &bad.omega};
    for (int i = 0; i < 3; i++) {
        bad.utime += 10;
        *rate[i] = -1e30F;
        TEST_ASSERT_EQUAL(AISLE_ERR_DATA, door_submit(AISLE_INPUT_POSE, &bad));
        TEST_ASSERT_EQUAL_INT16(AISLE_STATUS_MALFORMED, status_now().cause);
        *rate[i] = 0.0F;
    }
}

static void test_status_tells_ages_and_identity_at_the_time_asked(void) {
    TEST_ASSERT_EQUAL_FLOAT(-1.0F, status_now().pose_age);
    here = door_pose(2.0, 4.0, 0.0);
    TEST_ASSERT_EQUAL(AISLE_OK, door_submit(AISLE_INPUT_POSE, &here));
    aisle_status_msg status;
    aisle_planner_status(door, door_now + 1500000, &status);
    TEST_ASSERT_FLOAT_WITHIN(1e-4F, 1.5F, status.pose_age);
    TEST_ASSERT_EQUAL_INT64(door_now + 1500000, status.utime);
    TEST_ASSERT_EQUAL_INT64(77, status.boot_id);
    TEST_ASSERT_EQUAL_INT16(AISLE_PROTOCOL, status.protocol);
    TEST_ASSERT_EQUAL(AISLE_STATUS_WAITING, status.state);
    TEST_ASSERT_EQUAL_INT16(AISLE_STATUS_NO_LAYOUT, status.cause);
    take_hall();
    stand_and_go();
    aisle_planner_status(door, door_now + 150000, &status);
    TEST_ASSERT_EQUAL(AISLE_STATUS_ACTIVE, status.state);
    aisle_planner_status(door, door_now + 250000, &status); // no step in between
    TEST_ASSERT_EQUAL(AISLE_STATUS_BLOCKED, status.state);
    TEST_ASSERT_EQUAL_INT16(AISLE_STATUS_POSE_STALE, status.cause);
}

static void test_a_clock_that_goes_back_reads_as_standing_still(void) {
    take_hall();
    stand_and_go();
    int before = door_paths;
    int64_t now = door_now;
    for (int i = 0; i < 20; i++) {
        TEST_ASSERT_EQUAL(AISLE_OK, aisle_planner_step(door, now - 1000000 * i, 1000));
    }
    TEST_ASSERT_EQUAL_INT(before, door_paths);
    TEST_ASSERT_EQUAL_INT64(now + AISLE_LEASE_RESEND_US, aisle_planner_next_deadline(door));
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_memsize_is_0_for_limits_out_of_range);
    RUN_TEST(test_memsize_with_default_limits_is_below_24_mib);
    RUN_TEST(test_every_limit_at_its_ends_has_a_size);
    RUN_TEST(test_init_refuses_a_byte_less_and_leaves_the_block_alone);
    RUN_TEST(test_init_refuses_what_breaks_its_rules);
    RUN_TEST(test_the_shortest_lease_is_within_its_bounds_or_zero);
    RUN_TEST(test_memory_rows_sum_up_to_memsize);
    RUN_TEST(test_a_query_is_answered_by_a_path_that_keeps_the_margin);
    RUN_TEST(test_work_is_counted_as_it_is_spent);
    RUN_TEST(test_a_layout_in_parts_is_in_force_when_the_last_one_is_in);
    RUN_TEST(test_a_scanned_map_in_tiles_is_planned_on);
    RUN_TEST(test_a_patch_moves_a_polygon_and_a_gap_in_revisions_is_refused);
    RUN_TEST(test_layouts_held_are_duplicates_and_older_ones_outdated);
    RUN_TEST(test_any_slicing_gives_the_same_bytes);
    RUN_TEST(test_two_planners_give_the_same_bytes_whatever_was_in_their_memory);
    RUN_TEST(test_a_request_answers_the_same_after_others_as_before);
    RUN_TEST(test_requests_queue_in_order_and_each_is_answered_once);
    RUN_TEST(test_nothing_moves_on_while_an_event_waits);
    RUN_TEST(test_no_layout_no_vehicle_and_another_map_are_told);
    RUN_TEST(test_an_occupied_start_or_goal_is_told_with_what_is_in_the_way_and_where);
    RUN_TEST(test_a_start_or_goal_outside_is_told);
    RUN_TEST(test_who_moves_as_far_as_told_has_moved_enough);
    RUN_TEST(test_a_goal_walled_in_is_proved_to_have_no_path);
    RUN_TEST(test_what_is_proved_when_the_budget_ends_is_told);
    RUN_TEST(test_a_door_too_narrow_is_told_with_its_width_and_wall);
    RUN_TEST(test_a_small_budget_is_told_and_never_overdrawn_by_more_than_a_piece);
    RUN_TEST(test_the_configured_budget_holds_where_a_request_names_none);
    RUN_TEST(test_unknown_options_are_told_as_malformed);
    RUN_TEST(test_numbers_no_vehicle_can_mean_are_answered_and_change_nothing);
    RUN_TEST(test_more_goals_than_a_list_holds_are_refused_whole);
    RUN_TEST(test_inputs_that_are_none_are_errors_of_the_caller);
    RUN_TEST(test_every_cause_has_a_name_and_others_a_question_mark);
    RUN_TEST(test_start_equal_to_goal_is_a_path_that_stands);
    RUN_TEST(test_64_goals_are_passed_in_their_order);
    RUN_TEST(test_several_goals_in_one_place_are_all_passed);
    RUN_TEST(test_fixed_headings_are_kept_at_start_and_goal);
    RUN_TEST(test_dwell_adds_its_time);
    RUN_TEST(test_any_order_takes_the_nearest_goal_first);
    RUN_TEST(test_a_goal_list_is_answered_by_a_leased_path_from_the_pose);
    RUN_TEST(test_auto_sends_the_first_proof_and_then_the_better_path_as_the_next_revision);
    RUN_TEST(test_auto_sends_no_path_twice_where_the_first_one_stays);
    RUN_TEST(test_the_lease_is_renewed_every_half_second_and_nothing_else_changes);
    RUN_TEST(test_the_lease_runs_out_with_a_stale_pose_and_goes_on_with_a_fresh_one);
    RUN_TEST(test_the_lease_runs_out_while_the_pose_is_not_localized);
    RUN_TEST(test_a_pose_on_another_map_drives_nobody);
    RUN_TEST(test_hold_stops_the_lease_and_resume_renews_it_at_once);
    RUN_TEST(test_resume_after_a_short_hold_does_not_wait_for_the_next_turn);
    RUN_TEST(test_no_path_leaves_while_held_not_even_a_new_one);
    RUN_TEST(test_no_path_leaves_on_a_stale_pose_not_even_a_new_one);
    RUN_TEST(test_resend_sends_the_path_at_once);
    RUN_TEST(test_cancel_and_an_empty_list_revoke_the_path);
    RUN_TEST(test_cancel_ends_a_plan_under_way_without_an_event);
    RUN_TEST(test_a_list_cancelled_before_its_turn_is_not_even_refused);
    RUN_TEST(test_unknown_commands_are_refused);
    RUN_TEST(test_no_path_is_out_while_a_moving_obstacle_is_too_near);
    RUN_TEST(test_the_way_goes_on_when_the_moving_obstacle_is_gone);
    RUN_TEST(test_goals_that_come_while_a_moving_obstacle_is_too_near_wait_for_it);
    RUN_TEST(test_a_moving_obstacle_that_appears_while_planning_keeps_the_path_back);
    RUN_TEST(test_without_a_pose_the_goals_wait_for_one);
    RUN_TEST(test_goal_lists_held_are_duplicates_older_ones_outdated_other_ones_conflicts);
    RUN_TEST(test_a_list_sent_again_after_it_was_cancelled_or_reached_moves_nobody);
    RUN_TEST(test_a_newer_list_takes_over_from_one_not_yet_planned);
    RUN_TEST(test_a_goal_reached_at_rest_ends_the_mission);
    RUN_TEST(test_a_new_list_while_standing_on_its_goal_is_answered_all_the_same);
    RUN_TEST(test_status_names_the_next_goal_of_several);
    RUN_TEST(test_a_new_layout_revokes_the_path_and_plans_again_from_the_present_pose);
    RUN_TEST(test_requests_that_fill_the_queue_while_a_layout_is_built_do_not_hurt_the_mission);
    RUN_TEST(test_goals_that_come_while_a_layout_is_built_are_planned_once);
    RUN_TEST(test_a_new_vehicle_revokes_and_plans_again);
    RUN_TEST(test_poses_out_of_order_or_range_are_refused);
    RUN_TEST(test_status_tells_ages_and_identity_at_the_time_asked);
    RUN_TEST(test_a_clock_that_goes_back_reads_as_standing_still);
    return UNITY_END();
}
