// PRM by name: proved paths, the roadmap kept from query to query, lists that leave nothing, refusals.
#include "plan/planner_state.h"

#include "asked_route.h"

enum { SEEDS = 5, OTHER = 1 };

static aisle_pose_msg here;
static aisle_layout_patch_msg patch;

static void open_hall(void) {
    hall_open_route(&route, &hall_limits, 2000000U);
}

static void open_slit_hall(double gap) {
    slit_hall(gap);
    open_hall();
}

static void ask(void) {
    route_ask(AISLE_OPTIONS_PRM, 1.0, 1.0, 9.0, 1.0);
    request.options.objective = AISLE_OPTIONS_SHORTEST;
}

static void plan(uint32_t slice) {
    route_begin_anew();
    route_finish(slice);
}

static const aisle_proof *proof(void) {
    const aisle_proof *proof = route_proof();
    TEST_ASSERT_EQUAL_INT8(AISLE_OPTIONS_PRM, answer.planner);
    return proof;
}

void setUp(void) {
    hall_disc(0.3, 0.05F);
}
void tearDown(void) {}

// ---- paths

static void test_every_objective_gets_a_proved_path_from_one_roadmap(void) {
    open_slit_hall(0.9);
    for (int8_t objective = AISLE_OPTIONS_SAFEST; objective <= AISLE_OPTIONS_LEAST_ENERGY; objective++) {
        ask();
        request.options.objective = objective;
        plan(1000);
        (void)proof();
        TEST_ASSERT_TRUE(route.nodes > 0);
    }
    TEST_ASSERT_EQUAL_INT64(1, route.keep.begun);
    TEST_ASSERT_TRUE(aisle_roadmap_invariants_hold(&route.keep.map));
}

static void test_bodies_with_a_heading_and_cars_are_driven_as_they_can(void) {
    for (int car = 0; car < 2; car++) {
        hall_rectangle(1.0, 0.6, 0.05F);
        hall_vehicle.curvature_max = car != 0 ? 1.0 : 0.0;
        open_slit_hall(1.6);
        ask();
        request.start.tolerance_theta = request.goals[0].tolerance_theta = 0.1F;
        request.goals[0].theta = -1.5;
        plan(1000);
        (void)proof();
        TEST_ASSERT_DOUBLE_WITHIN(0.1, -1.5, answer.waypoints[answer.num_waypoints - 1].theta);
    }
}

static void test_draws_are_doubled_where_they_do_not_join_the_ends(void) { // 5 of 5 seeds
    open_slit_hall(0.8);
    for (int32_t seed = 1; seed <= SEEDS; seed++) {
        ask();
        request.options.seed = seed;
        request.options.num_samples = 20;
        plan(1000);
        (void)proof();
        uint32_t draws = 20;
        while (draws < route.keep.map.count) {
            draws *= 2U;
        }
        TEST_ASSERT_TRUE(draws > 20U);
        TEST_ASSERT_TRUE(route.keep.map.count == draws || route.keep.map.count == route.keep.map.capacity);
    }
}

static void test_the_papers_form_tests_every_edge_and_draws_no_more(void) {
    open_slit_hall(1.2);
    ask();
    request.options.objective = AISLE_OPTIONS_PAPER;
    request.options.num_samples = 600;
    plan(1000);
    (void)proof();
    const aisle_roadmap *map = &route.keep.map;
    TEST_ASSERT_EQUAL_UINT32(600, map->count);
    TEST_ASSERT_EQUAL(AISLE_ROADMAP_DIJKSTRA, route.sample.ask.kind);
    for (uint32_t i = 0; i < map->count; i++) {
        for (uint32_t k = 0; k < map->degree[i]; k++) {
            TEST_ASSERT_TRUE(aisle_roadmap_edge(map, i, map->list[i * map->k + k]) != AISLE_ROADMAP_UNKNOWN);
        }
    }
    request.options.num_samples = 20;
    plan(1000);
    route_refused(AISLE_STATUS_BUDGET);
    TEST_ASSERT_EQUAL_UINT32(20, map->count);
}

static void test_the_same_seed_gives_the_same_bytes_however_it_is_cut(void) {
    static uint8_t bytes[AISLE_ROUTE_BYTES];
    const uint32_t slices[3] = {UINT32_MAX / 2U, 7, 1};
    size_t size = 0;
    for (int i = 0; i < 4; i++) {
        open_slit_hall(0.9);
        ask();
        request.options.num_samples = 30; // grows
        request.options.seed = i < 3 ? 0 : 77;
        plan(i < 3 ? slices[i] : 1000U);
        const aisle_proof *whole = proof();
        const bool is_same = whole->size == size && memcmp(bytes, whole->bytes, size) == 0;
        TEST_ASSERT_TRUE(i == 0 || is_same == (i < 3));
        size = whole->size;
        memcpy(bytes, whole->bytes, size);
    }
}

// ---- goal lists

static void test_a_list_has_one_roadmap_for_its_legs_and_leaves_nothing(void) {
    open_slit_hall(0.9);
    ask();
    request.num_goals = 4;
    for (int16_t i = 1; i < 4; i++) {
        request.goals[i] =
            (aisle_goal_msg){.id = 11 + i, .x = i % 2 != 0 ? 1.0 : 9.0, .y = 1.0 + i, .tolerance_theta = 4.0F};
    }
    plan(1000);
    (void)proof();
    static uint8_t bytes[AISLE_ROUTE_BYTES];
    const size_t size = route.best.size;
    memcpy(bytes, route.best.bytes, size);
    request.is_query = false;
    route.keep.is_begun = false;
    plan(1000);
    (void)proof();
    TEST_ASSERT_FALSE(route.keep.is_begun);
    TEST_ASSERT_EQUAL_INT64(1, route.sample.copy.begun);
    TEST_ASSERT_EQUAL_size_t(size, route.best.size);
    TEST_ASSERT_EQUAL_MEMORY(bytes, route.best.bytes, size);
}

static void test_a_list_begins_with_what_queries_have_left(void) {
    open_slit_hall(0.9);
    ask();
    plan(1000);
    const int32_t units = (int32_t)route.spent;
    request.is_query = false;
    plan(1000);
    (void)proof();
    TEST_ASSERT_EQUAL_INT64(0, route.sample.copy.begun);
    TEST_ASSERT_LESS_THAN_INT32(units, (int32_t)route.spent);
}

// ---- refusals

static void test_closed_halls_are_refused_with_a_proof(void) {
    hall_begin(10.0, 6.0);
    hall_add(4.75, 0.0, 5.25, 6.0);
    open_hall();
    ask();
    plan(10000);
    route_refused(AISLE_STATUS_NO_PATH);
    open_slit_hall(0.65);
    plan(10000);
    route_refused(AISLE_STATUS_TOO_NARROW);
}

static void test_a_slit_that_no_draw_gets_through_is_no_proof(void) {
    open_slit_hall(0.702);
    ask();
    plan(10000);
    route_refused(AISLE_STATUS_BUDGET);
    TEST_ASSERT_EQUAL_UINT32(route.keep.map.capacity, route.keep.map.count);
    TEST_ASSERT_EQUAL_INT32(11, request.goals[route.named].id);
}

// The budget is held, whatever stage it ends in; the next query goes on where this one ended, to the same answer.
static void test_a_roadmap_half_built_by_the_budget_is_gone_on_with(void) {
    open_slit_hall(0.9);
    ask();
    plan(1000);
    const float length = (proof(), answer.length);
    bool found = false;
    open_slit_hall(0.9);
    for (int i = 0; i < 40 && !found; i++) {
        request.options.work_units = 500;
        plan(50);
        TEST_ASSERT_LESS_OR_EQUAL_UINT32(600, route.spent);
        found = aisle_route_answer(&route) != NULL;
        TEST_ASSERT_TRUE(found || route.cause.cause == AISLE_STATUS_BUDGET);
    }
    request.options.work_units = 0;
    plan(1000);
    (void)proof();
    TEST_ASSERT_EQUAL_FLOAT(length, answer.length);
    TEST_ASSERT_EQUAL_INT64(1, route.keep.begun);
}

// ---- behind the door

static int64_t count(aisle_counter counter) {
    return aisle_planner_counters(door)[counter];
}

// 20 x 12 m with a shelf, id 1.
static void open_door(int which, bool forgetful) {
    door_config = (aisle_config){.limits = {.cells = 65536U, .requests = 4U, .cached_paths = 16U},
                                 .boot_id = 77,
                                 .has_vehicle = true,
                                 .forgetful = forgetful};
    hall_rectangle(0.8, 0.6, 0.05F);
    door_config.vehicle = (aisle_vehicle_msg){.footprint_radius = 0.3F, .margin = 0.05F};
    hall_disc(0.3, 0.05F);
    hall_begin(20.0, 12.0);
    hall_add(9.0, 3.0, 11.0, 9.0);
    door_open(which);
    TEST_ASSERT_EQUAL(AISLE_OK, door_submit(AISLE_INPUT_LAYOUT, hall_message(1, 0.1F)));
    door_settle();
}

static aisle_query_msg question(double x0, double y0, double x1, double y1) {
    aisle_query_msg query = door_query(5, x0, y0, x1, y1);
    query.options.planner = AISLE_OPTIONS_PRM;
    query.options.objective = AISLE_OPTIONS_SHORTEST;
    return query;
}

static void send_box(int32_t revision, hall_box b) {
    const double v[4][2] = {{b.x0, b.y0}, {b.x1, b.y0}, {b.x1, b.y1}, {b.x0, b.y1}};
    memset(&patch, 0, sizeof patch);
    patch.map_id = 1;
    patch.base_revision = revision;
    patch.map_revision = revision + 1;
    patch.num_polygons = 1;
    patch.polygons[0].id = 40 + revision;
    patch.polygons[0].num_vertices = 4;
    memcpy(patch.polygons[0].vertices, v, sizeof v);
    TEST_ASSERT_EQUAL(AISLE_OK, door_submit(AISLE_INPUT_LAYOUT_PATCH, &patch));
    door_settle();
    hall_add(b.x0, b.y0, b.x1, b.y1);
}

static void test_a_patch_between_two_queries_repairs_the_roadmap(void) {
    open_door(0, false);
    aisle_query_msg query = question(3.0, 6.0, 17.0, 6.0);
    (void)door_judge(door_ask(&query));
    const float before = door_reply.length;
    const double y = door_reply.waypoints[1].y < 6.0 ? 0.0 : 9.0; // where the path goes by the shelf
    send_box(1, (hall_box){9.5, y, 10.5, y + 3.0});
    const aisle_path_msg *again = door_ask(&query);
    (void)door_judge(again);
    TEST_ASSERT_EQUAL_INT8(0, again->cached);
    TEST_ASSERT_TRUE(again->length > before - 1e-3F);
    TEST_ASSERT_EQUAL_INT64(1, count(AISLE_COUNTER_ROADMAPS));
    TEST_ASSERT_EQUAL_INT64(1, count(AISLE_COUNTER_ROADMAP_REPAIRS));
    TEST_ASSERT_EQUAL_INT16(AISLE_PATH_OK, again->status);
}

static void test_answers_are_remembered_and_one_roadmap_serves_all_questions(void) {
    open_door(0, false);
    for (int again = 0; again < 2; again++) {
        for (int i = 0; i < 6; i++) {
            aisle_query_msg query = question(3.0, 1.0 + 1.5 * i, 17.0, 11.0 - 1.5 * i);
            TEST_ASSERT_EQUAL_INT8(again, door_ask(&query)->cached);
            TEST_ASSERT_EQUAL_INT8(AISLE_OPTIONS_PRM, door_reply.planner);
            (void)door_judge(&door_reply);
        }
    }
    TEST_ASSERT_EQUAL_INT64(6, count(AISLE_COUNTER_CACHE_HITS));
    TEST_ASSERT_EQUAL_INT64(6, count(AISLE_COUNTER_CACHE_MISSES));
    TEST_ASSERT_EQUAL_INT64(1, count(AISLE_COUNTER_ROADMAPS));
}

static void test_trees_by_name_are_remembered_too_and_kept_where_a_patch_does_not_touch_them(void) {
    open_door(0, false);
    for (int8_t planner = AISLE_OPTIONS_RRT; planner <= AISLE_OPTIONS_PRM; planner++) {
        aisle_query_msg query = question(3.0, 10.5, 17.0, 10.5);
        query.options.planner = planner;
        TEST_ASSERT_EQUAL_INT8(0, door_ask(&query)->cached);
        TEST_ASSERT_EQUAL_INT8(1, door_ask(&query)->cached);
        TEST_ASSERT_EQUAL_INT8(planner, door_reply.planner);
    }
    send_box(1, (hall_box){9.5, 0.2, 10.5, 1.2});
    TEST_ASSERT_EQUAL_INT64(5, count(AISLE_COUNTER_CACHE_KEPT));
    send_box(2, (hall_box){9.5, 10.0, 10.5, 11.8});
    TEST_ASSERT_EQUAL_INT64(5, count(AISLE_COUNTER_CACHE_DROPPED));
    for (int8_t planner = AISLE_OPTIONS_RRT; planner <= AISLE_OPTIONS_PRM; planner++) {
        aisle_query_msg query = question(3.0, 10.5, 17.0, 10.5);
        query.options.planner = planner;
        TEST_ASSERT_EQUAL_INT8(0, door_ask(&query)->cached);
        (void)door_judge(&door_reply);
        TEST_ASSERT_EQUAL_INT8(planner, door_reply.planner);
        TEST_ASSERT_TRUE(planner == AISLE_OPTIONS_PRM ||
                         door_reply.length <= 14.0F * (1.0F + (float)AISLE_CACHE_REPAIR_TREE)); // it was straight
    }
    TEST_ASSERT_EQUAL_INT64(4, count(AISLE_COUNTER_CACHE_REPAIRED)); // the trees'; PRM's roadmap is
    TEST_ASSERT_EQUAL_INT64(1, count(AISLE_COUNTER_ROADMAP_REPAIRS));
}

static void test_a_trees_answer_that_cannot_be_joined_well_is_planned_anew(void) {
    open_door(0, false);
    aisle_query_msg query = question(3.0, 10.5, 17.0, 10.5);
    query.options.planner = AISLE_OPTIONS_RRT_ADAPTIVE;
    (void)door_judge(door_ask(&query));
    send_box(1, (hall_box){9.5, 9.0, 10.5, 12.0}); // round the shelf, far more than a tenth longer
    TEST_ASSERT_EQUAL_INT8(0, door_ask(&query)->cached);
    (void)door_judge(&door_reply);
    TEST_ASSERT_EQUAL_INT8(AISLE_OPTIONS_RRT_ADAPTIVE, door_reply.planner);
    TEST_ASSERT_EQUAL_INT64(0, count(AISLE_COUNTER_CACHE_REPAIRED));
}

// Whether a list was planned to its end, given up half way or never begun is a matter of time alone.
static void test_a_list_given_up_leaves_nothing_that_later_answers_show(void) {
    static uint8_t bytes[3][2][65536];
    size_t size[3][2];
    for (int kind = 0; kind < 3; kind++) {
        open_door(0, false);
        here = door_pose(3.0, 6.0, 0.0);
        TEST_ASSERT_EQUAL(AISLE_OK, door_submit(AISLE_INPUT_POSE, &here));
        aisle_goal_list_msg goals = door_goals(1, 17.0, 6.0);
        goals.options.planner = AISLE_OPTIONS_PRM;
        TEST_ASSERT_EQUAL(AISLE_OK, door_submit(AISLE_INPUT_GOALS, &goals));
        for (int i = 0; kind == 1 && i < 200; i++) {
            (void)aisle_planner_step(door, door_now, 4);
        }
        if (kind == 2) {
            door_settle();
        }
        const aisle_command_msg cancel = {.command = AISLE_COMMAND_CANCEL, .command_id = 3};
        TEST_ASSERT_EQUAL(AISLE_OK, door_submit(AISLE_INPUT_COMMAND, &cancel));
        door_settle();
        send_box(1, (hall_box){9.5, 0.2, 10.5, 1.2});
        for (int i = 0; i < 2; i++) {
            aisle_query_msg query = question(3.0, 2.0 + i, 17.0, 8.0);
            (void)door_ask(&query);
            TEST_ASSERT_EQUAL_INT16(AISLE_PATH_OK, door_reply.status);
            door_reply.path_revision = 0; // counts the list's paths, too
            TEST_ASSERT_EQUAL(AISLE_OK,
                              aisle_path_encode(&door_reply, bytes[kind][i], sizeof bytes[kind][i], &size[kind][i]));
        }
    }
    for (int i = 0; i < 4; i++) {
        const int kind = 1 + i / 2;
        TEST_ASSERT_EQUAL_size_t(size[0][i % 2], size[kind][i % 2]);
        TEST_ASSERT_EQUAL_MEMORY(bytes[0][i % 2], bytes[kind][i % 2], size[0][i % 2]);
    }
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_every_objective_gets_a_proved_path_from_one_roadmap);
    RUN_TEST(test_bodies_with_a_heading_and_cars_are_driven_as_they_can);
    RUN_TEST(test_draws_are_doubled_where_they_do_not_join_the_ends);
    RUN_TEST(test_the_papers_form_tests_every_edge_and_draws_no_more);
    RUN_TEST(test_the_same_seed_gives_the_same_bytes_however_it_is_cut);
    RUN_TEST(test_a_list_has_one_roadmap_for_its_legs_and_leaves_nothing);
    RUN_TEST(test_a_list_begins_with_what_queries_have_left);
    RUN_TEST(test_closed_halls_are_refused_with_a_proof);
    RUN_TEST(test_a_slit_that_no_draw_gets_through_is_no_proof);
    RUN_TEST(test_a_roadmap_half_built_by_the_budget_is_gone_on_with);
    RUN_TEST(test_a_patch_between_two_queries_repairs_the_roadmap);
    RUN_TEST(test_answers_are_remembered_and_one_roadmap_serves_all_questions);
    RUN_TEST(test_trees_by_name_are_remembered_too_and_kept_where_a_patch_does_not_touch_them);
    RUN_TEST(test_a_trees_answer_that_cannot_be_joined_well_is_planned_anew);
    RUN_TEST(test_a_list_given_up_leaves_nothing_that_later_answers_show);
    return UNITY_END();
}
