// Zones through a whole request: paths obey them, costs mind them, refusals name them.
#include "plan/route.h"
#include "plan/zones.h"

#include "asked_route.h"

enum { SEEDS = 24 };

static aisle_polygon_msg zones[8];
static int zone_count;

static aisle_polygon_msg *zone(int8_t kind, double x0, double y0, double x1, double y1) {
    const double v[4][2] = {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}};
    aisle_polygon_msg *p = &zones[zone_count++];
    *p = (aisle_polygon_msg){.id = 100 + zone_count, .kind = kind, .num_vertices = 4};
    memcpy(p->vertices, v, sizeof v);
    return p;
}

static int32_t directed(double direction, double x0, double y0, double x1, double y1) {
    aisle_polygon_msg *p = zone(AISLE_POLYGON_DIRECTED, x0, y0, x1, y1);
    p->direction = (float)direction;
    return p->id;
}

static int32_t valued(int8_t kind, float value, double x0, double y0, double x1, double y1) {
    aisle_polygon_msg *p = zone(kind, x0, y0, x1, y1);
    p->value = value;
    return p->id;
}

static aisle_layout_msg layout;

// The hall's boxes and the zones in force.
static void open_hall(void) {
    aisle_arena arena = hall_arena(24U << 20);
    memset(&route, 0, sizeof route);
    aisle_route_carve(&route, &arena, &hall_limits);
    route.budget_default = 3000000U;
    layout = *hall_message(1, 0.05F);
    for (int i = 0; i < zone_count; i++) {
        layout.polygons[layout.num_polygons++] = zones[i];
    }
    hall_seal(&layout);
    hall_open_message(&arena, &layout);
}

static int8_t planner = AISLE_OPTIONS_AUTO;

static void plan_by(int8_t objective, double x0, double y0, double x1, double y1, uint32_t slice) {
    route_ask(planner, x0, y0, x1, y1);
    request.options.objective = objective;
    route_begin();
    route_finish(slice);
}

static void plan(double x0, double y0, double x1, double y1) {
    plan_by(AISLE_OPTIONS_SHORTEST, x0, y0, x1, y1, 5000);
}

// Origin's length inside a zone, and the longest stretch of it against the zone, both by samples of 2 mm; speed of the
// body where its box is over the zone is not looked at here.
static double inside(const aisle_polygon_msg *p, bool against) {
    double sum = 0.0;
    for (int16_t i = 1; i < answer.num_waypoints; i++) {
        door_piece piece = door_piece_of(&answer.waypoints[i - 1], &answer.waypoints[i]);
        int steps = 1 + (int)(piece.length / 0.002);
        for (int k = 0; k < steps; k++) {
            aisle_pose2 a = door_piece_at(&piece, (double)k / steps), b = door_piece_at(&piece, (k + 1.0) / steps);
            double x = 0.5 * (a.x + b.x), y = 0.5 * (a.y + b.y), step = hypot(b.x - a.x, b.y - a.y);
            double along = (b.x - a.x) * cos((double)p->direction) + (b.y - a.y) * sin((double)p->direction);
            bool is_in =
                x > p->vertices[0][0] && x < p->vertices[2][0] && y > p->vertices[0][1] && y < p->vertices[2][1];
            sum += is_in && (!against || along < -2e-3 * step) ? step : 0.0;
        }
    }
    return sum;
}

static void take_answer(void) {
    (void)route_proof();
    for (int i = 0; i < zone_count; i++) {
        if (zones[i].kind == AISLE_POLYGON_DIRECTED) {
            TEST_ASSERT_TRUE(inside(&zones[i], true) <= 1e-9);
        }
    }
}

static void refused_with(int16_t cause, int32_t id) {
    route_refused(cause);
    TEST_ASSERT_EQUAL_INT32(id, route.cause.id);
}

// Two aisles of 3 m side by side, joined at both ends: upper y 5..8, lower y 0..3.
static void two_aisles(void) {
    hall_begin(20.0, 8.0);
    hall_add(4.0, 3.0, 16.0, 5.0);
}

void setUp(void) {
    zone_count = 0;
    planner = AISLE_OPTIONS_AUTO;
    hall_disc(0.4, 0.1F);
    two_aisles();
}
void tearDown(void) {}

// ---- one way

static void test_a_one_way_aisle_is_driven_along_and_gone_round_the_other_way(void) {
    (void)directed(0.0, 6.0, 0.0, 14.0, 3.0); // the lower aisle to the east
    open_hall();
    plan(2.0, 1.5, 18.0, 1.5);
    take_answer();
    TEST_ASSERT_DOUBLE_WITHIN(0.01, 16.0, (double)answer.length);
    plan(18.0, 1.5, 2.0, 1.5);
    take_answer();
    TEST_ASSERT_TRUE((double)answer.length > 19.0 && (double)answer.length < 22.0); // by the upper one
}

static void test_all_objectives_and_bodies_obey(void) {
    for (int body = 0; body < 2; body++) {
        for (int8_t objective = AISLE_OPTIONS_SAFEST; objective <= AISLE_OPTIONS_LEAST_ENERGY; objective++) {
            if (body == 1) {
                hall_rectangle(1.6, 0.8, 0.05F);
            }
            (void)directed(0.0, 6.0, 0.0, 14.0, 3.0);
            open_hall();
            plan_by(objective, 18.0, 1.5, 2.0, 1.5, 5000);
            take_answer();
            zone_count = 0;
        }
    }
}

// Narrow enough for the search to reach across it: a way that cuts its corner would be the shorter one.
static void test_the_genetic_search_obeys(void) {
    planner = AISLE_OPTIONS_GA;
    hall_begin(20.0, 8.0);
    (void)directed(0.0, 6.0, 3.2, 14.0, 4.8);
    for (int8_t objective = AISLE_OPTIONS_SAFEST; objective <= AISLE_OPTIONS_PAPER; objective++) {
        open_hall();
        plan_by(objective, 18.0, 4.1, 2.0, 4.1, 5000);
        take_answer();
        TEST_ASSERT_TRUE(route.space.zone_room > 0.0);            // for what corners are blended by
        TEST_ASSERT_EQUAL_INT8(AISLE_OPTIONS_GA, answer.planner); // not its seed, where its own was disproved
        TEST_ASSERT_TRUE((double)answer.length > 16.05);
    }
}

static void test_a_directed_zone_against_the_only_way_is_the_cause_by_name_and_place(void) {
    hall_begin(20.0, 3.0);
    int32_t id = directed(0.0, 6.0, -1.0, 14.0, 4.0);
    open_hall();
    plan(18.0, 1.5, 2.0, 1.5);
    refused_with(AISLE_STATUS_NO_PATH, id);
    TEST_ASSERT_EQUAL_UINT32(2, route.told_count);
    TEST_ASSERT_EQUAL_INT32(11, route.told[0].goal_id);
    TEST_ASSERT_TRUE(route.told[0].x >= 5.9 && route.told[0].x <= 18.0);
    TEST_ASSERT_EQUAL_INT32(id, route.told[1].goal_id);
    TEST_ASSERT_EQUAL_INT16(AISLE_WAYPOINT_GOAL, route.told[1].flags);
    plan(2.0, 1.5, 18.0, 1.5); // the other way it is open
    take_answer();
}

static void test_the_zone_is_named_for_long_bodies_too(void) {
    hall_rectangle(1.6, 0.8, 0.05F);
    hall_begin(20.0, 3.0);
    int32_t id = directed(0.0, 6.0, -1.0, 14.0, 4.0);
    open_hall();
    plan(18.0, 1.5, 2.0, 1.5);
    refused_with(AISLE_STATUS_NO_PATH, id);
}

static void test_one_way_aisles_that_lead_to_each_other_are_both_the_cause_and_the_first_is_named(void) {
    (void)directed(0.0, 6.0, -1.0, 14.0, 3.5);
    (void)directed(0.0, 6.0, 4.5, 14.0, 9.0);
    open_hall();
    plan(18.0, 1.5, 2.0, 1.5);
    refused_with(AISLE_STATUS_NO_PATH, 101); // the shortest way without it is the lower one
}

static void test_zones_that_contradict_each_other_shut_the_aisle(void) {
    hall_begin(20.0, 3.0);
    int32_t east = directed(0.0, 6.0, -1.0, 12.0, 4.0);
    int32_t west = directed(DOOR_PI, 8.0, -1.0, 14.0, 4.0);
    open_hall();
    plan(2.0, 1.5, 18.0, 1.5);
    refused_with(AISLE_STATUS_NO_PATH, west);
    plan(18.0, 1.5, 2.0, 1.5);
    refused_with(AISLE_STATUS_NO_PATH, east);
}

// The corners of a way round a zone are arcs that stay out of it, not stops.
static void test_a_zones_corners_are_rounded_outside_of_it(void) {
    hall_begin(20.0, 8.0);
    (void)directed(0.0, 7.0, -1.0, 13.0, 5.0);
    open_hall();
    for (int tricycle = 0; tricycle < 2; tricycle++) {
        hall_vehicle.curvature_max = tricycle == 1 ? 4.0 : 0.0;
        plan(13.6, 1.0, 6.4, 1.0); // right angles, or nearly
        take_answer();
        int arcs = 0;
        for (int16_t i = 1; i < answer.num_waypoints; i++) {
            TEST_ASSERT_EQUAL_INT16(0, answer.waypoints[i - 1].flags &
                                           (AISLE_WAYPOINT_STOP | AISLE_WAYPOINT_TURN_IN_PLACE));
            arcs += fabs((double)answer.waypoints[i].curvature) > 0.0 ? 1 : 0;
        }
        TEST_ASSERT_GREATER_THAN(1, arcs);
    }
}

static void test_a_wall_stays_the_cause_where_zones_are_not(void) {
    hall_begin(20.0, 3.0);
    hall_add(4.0, 0.0, 4.5, 3.0);
    (void)directed(0.0, 6.0, -1.0, 14.0, 4.0);
    open_hall();
    plan(18.0, 1.5, 2.0, 1.5);
    TEST_ASSERT_NULL(aisle_route_answer(&route));
    TEST_ASSERT_TRUE(route.cause.id != 101);
}

static void test_a_start_or_goal_inside_leaves_or_comes_by_the_direction(void) {
    hall_begin(20.0, 8.0);
    (void)directed(0.0, 6.0, 2.0, 14.0, 6.0);
    open_hall();
    plan(10.0, 4.0, 2.0, 4.0); // has to leave eastwards or across
    take_answer();
    TEST_ASSERT_TRUE((double)answer.length > 8.0);
    plan(18.0, 4.0, 10.0, 4.0); // has to come from the west or across
    take_answer();
    plan(2.0, 4.0, 10.0, 4.0);
    take_answer();
    TEST_ASSERT_DOUBLE_WITHIN(0.01, 8.0, (double)answer.length);
}

// A directed zone with random outline among random boxes: the answer obeys, or the refusal is confirmed by a flood that
// knows the rule in its own way.
static void test_random_halls_are_obeyed_for_every_seed(void) {
    int ways = 0;
    for (uint64_t s = 0; s < SEEDS; s++) {
        aisle_rng rng = aisle_rng_seed(s);
        hall_begin(12.0, 8.0);
        zone_count = 0;
        for (int i = 0; i < 4; i++) {
            aisle_vec2 at = uniform_point(&rng, aisle_vec2_of(2.0, 0.5), aisle_vec2_of(9.0, 6.5));
            hall_add(at.x, at.y, at.x + 1.0, at.y + 1.0);
        }
        for (int i = 0; i < 3; i++) {
            aisle_vec2 at = uniform_point(&rng, aisle_vec2_of(2.0, 0.5), aisle_vec2_of(8.0, 5.5));
            (void)directed(uniform(&rng, -3.1, 3.1), at.x, at.y, at.x + 2.0, at.y + 2.0);
        }
        open_hall();
        plan_by((int8_t)(s % 4U), 11.2, 4.0, 0.8, 4.0, 5000);
        if (aisle_route_answer(&route) != NULL) {
            take_answer();
            ways++;
        } else {
            TEST_ASSERT_NOT_EQUAL(AISLE_STATUS_VERIFY_FAILED, route.cause.cause);
        }
    }
    TEST_ASSERT_GREATER_THAN(SEEDS * 3 / 4, ways);
}

// ---- tolls

static void test_a_penalty_is_gone_round_where_that_is_cheaper_and_driven_through_where_not(void) {
    (void)valued(AISLE_POLYGON_PENALTY, 1.0F, 6.0, 0.0, 14.0, 3.0); // 8 m more by 15 each
    open_hall();
    for (int8_t objective = AISLE_OPTIONS_SAFEST; objective <= AISLE_OPTIONS_LEAST_ENERGY; objective++) {
        plan_by(objective, 2.0, 1.5, 18.0, 1.5, 5000);
        take_answer();
        TEST_ASSERT_TRUE(inside(&zones[0], false) < 1e-3);
    }
    zone_count = 0;
    (void)valued(AISLE_POLYGON_PENALTY, 0.01F, 6.0, 0.0, 14.0, 3.0); // 1.2 m more in all: less than the way round
    open_hall();
    plan(2.0, 1.5, 18.0, 1.5);
    take_answer();
    TEST_ASSERT_DOUBLE_WITHIN(0.01, 16.0, (double)answer.length);
}

// The cheapest way through a penalty strip that spans the hall is bent at its borders as light is; the planner's may be
// straight.
static void test_a_penalty_that_cannot_be_gone_round_is_crossed_at_nearly_the_least_cost(void) {
    hall_begin(20.0, 8.0);
    (void)valued(AISLE_POLYGON_PENALTY, 0.5F, 9.0, -1.0, 11.0, 9.0);
    open_hall();
    plan(2.0, 1.0, 18.0, 7.0);
    take_answer();
    // By Snell: sin inside = sin outside / 8.5; the best crossing is all but straight across.
    double best = 1e9;
    for (double dy = 0.0; dy < 3.0; dy += 0.001) {
        double cost = 8.5 * hypot(2.0, dy) + hypot(14.0, 6.0 - dy);
        best = fmin(best, cost);
    }
    double cost = (double)answer.length + 7.5 * inside(&zones[0], false);
    TEST_ASSERT_TRUE(cost >= best - 0.02);
    TEST_ASSERT_TRUE(cost <= best * 1.04);
}

static void test_the_measure_of_an_answer_holds_its_penalties(void) {
    hall_begin(20.0, 8.0);
    (void)valued(AISLE_POLYGON_PENALTY, 0.25F, 9.0, -1.0, 11.0, 9.0);
    (void)valued(AISLE_POLYGON_PENALTY, 0.5F, 9.0, -1.0, 10.0, 9.0); // they add up
    open_hall();
    plan(2.0, 4.0, 18.0, 4.0);
    take_answer();
    double value = aisle_route_answer(&route)->value;
    TEST_ASSERT_DOUBLE_WITHIN(0.05, 16.0 + 15.0 * (0.25 * 2.0 + 0.5 * 1.0), value);
}

static void test_fastest_avoids_a_slow_zone_and_shortest_does_not(void) {
    int32_t id = valued(AISLE_POLYGON_SPEED_LIMIT, 0.3F, 6.0, 0.0, 14.0, 3.0);
    TEST_ASSERT_EQUAL_INT32(101, id);
    open_hall();
    plan_by(AISLE_OPTIONS_FASTEST, 2.0, 1.5, 18.0, 1.5, 5000);
    take_answer();
    TEST_ASSERT_TRUE(inside(&zones[0], false) < 1e-3);
    double fast = (double)answer.duration;
    plan(2.0, 1.5, 18.0, 1.5);
    take_answer();
    TEST_ASSERT_DOUBLE_WITHIN(0.01, 16.0, (double)answer.length);
    TEST_ASSERT_TRUE((double)answer.duration > fast + 5.0);
}

static void test_any_slicing_gives_the_same_bytes(void) {
    static uint8_t bytes[AISLE_ROUTE_BYTES];
    (void)directed(0.0, 6.0, 0.0, 14.0, 3.0);
    (void)valued(AISLE_POLYGON_PENALTY, 0.7F, 7.0, 5.0, 12.0, 6.5);
    open_hall();
    size_t size = 0;
    static const uint32_t slices[] = {1U, 77U, 1000U, UINT32_MAX};
    for (uint32_t i = 0; i < 4U; i++) {
        plan_by(AISLE_OPTIONS_SHORTEST, 18.0, 1.5, 2.0, 1.5, slices[i]);
        const aisle_proof *proof = aisle_route_answer(&route);
        TEST_ASSERT_NOT_NULL(proof);
        TEST_ASSERT_TRUE(i == 0U || (proof->size == size && memcmp(proof->bytes, bytes, size) == 0));
        size = proof->size;
        memcpy(bytes, proof->bytes, size);
    }
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_a_one_way_aisle_is_driven_along_and_gone_round_the_other_way);
    RUN_TEST(test_all_objectives_and_bodies_obey);
    RUN_TEST(test_the_genetic_search_obeys);
    RUN_TEST(test_a_directed_zone_against_the_only_way_is_the_cause_by_name_and_place);
    RUN_TEST(test_the_zone_is_named_for_long_bodies_too);
    RUN_TEST(test_one_way_aisles_that_lead_to_each_other_are_both_the_cause_and_the_first_is_named);
    RUN_TEST(test_zones_that_contradict_each_other_shut_the_aisle);
    RUN_TEST(test_a_zones_corners_are_rounded_outside_of_it);
    RUN_TEST(test_a_wall_stays_the_cause_where_zones_are_not);
    RUN_TEST(test_a_start_or_goal_inside_leaves_or_comes_by_the_direction);
    RUN_TEST(test_random_halls_are_obeyed_for_every_seed);
    RUN_TEST(test_a_penalty_is_gone_round_where_that_is_cheaper_and_driven_through_where_not);
    RUN_TEST(test_a_penalty_that_cannot_be_gone_round_is_crossed_at_nearly_the_least_cost);
    RUN_TEST(test_the_measure_of_an_answer_holds_its_penalties);
    RUN_TEST(test_fastest_avoids_a_slow_zone_and_shortest_does_not);
    RUN_TEST(test_any_slicing_gives_the_same_bytes);
    return UNITY_END();
}
