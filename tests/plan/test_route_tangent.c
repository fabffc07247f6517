// SHORTEST by the tangent search: lengths and bounds against the brute-force oracle of tests/support/optimum.h.
#include "plan/route.h"

#include "asked_route.h"
#include "optimum.h"

enum { HALLS = 40 };

static void open_hall(void) {
    hall_open_route(&route, &hall_limits, 1000000U);
}

static void random_hall(aisle_rng *rng) {
    hall_begin(12.0, 8.0);
    for (int i = 0; i < 9; i++) {
        double x = uniform(rng, 1.5, 9.0);
        double y = uniform(rng, 0.5, 6.5);
        aisle_vec2 size = uniform_point(rng, aisle_vec2_of(0.3, 0.3), aisle_vec2_of(1.5, 1.5));
        hall_add(x, y, x + size.x, y + size.y);
    }
    open_hall();
}

void setUp(void) {}
void tearDown(void) {}

static void ask(int8_t objective, double x0, double y0, double x1, double y1) {
    route_ask(AISLE_OPTIONS_AUTO, x0, y0, x1, y1);
    request.options.objective = objective;
}

// True: answered by a path, which is judged.
static bool plan(uint32_t slice) {
    route_begin();
    route_finish(slice);
    if (aisle_route_answer(&route) == NULL) {
        return false;
    }
    (void)route_proof();
    return true;
}

// INFINITY: no way.
static double optimum(double radius, const aisle_request *asked) {
    static optimum_point corners[HALL_BOXES_MAX * 4];
    static optimum_polygon shapes[HALL_BOXES_MAX];
    for (int i = 0; i < hall_count; i++) {
        const hall_box *b = &hall_boxes[i];
        const optimum_point box[4] = {{b->x0, b->y0}, {b->x1, b->y0}, {b->x1, b->y1}, {b->x0, b->y1}};
        memcpy(&corners[4 * i], box, sizeof box);
        shapes[i] = (optimum_polygon){&corners[4 * i], 4};
    }
    const double bounds[4] = {radius, radius, hall_width - radius, hall_height - radius};
    optimum_world *world = optimum_polygons(radius, bounds, shapes, (size_t)hall_count);
    optimum_path path = optimum_shortest(world, (optimum_point){asked->start.x, asked->start.y},
                                         (optimum_point){asked->goals[0].x, asked->goals[0].y}, INFINITY);
    double length = path.length;
    optimum_path_free(&path);
    optimum_free(world);
    return length;
}

static void test_a_discs_shortest_path_is_the_optimum_and_its_bound_lies_just_below(void) {
    int solved = 0;
    hall_disc(0.3, 0.05F);
    double radius = hall_vehicle.outer_radius + hall_vehicle.margin;
    for (uint64_t s = 0; s < HALLS; s++) {
        aisle_rng rng = aisle_rng_seed(900U + s);
        random_hall(&rng);
        aisle_vec2 ends = uniform_point(&rng, aisle_vec2_of(1.0, 1.0), aisle_vec2_of(7.0, 7.0));
        ask(AISLE_OPTIONS_SHORTEST, 0.8, ends.x, 11.2, ends.y);
        double best = optimum(radius, &request);
        if (!plan(1000)) {
            TEST_ASSERT_TRUE(isinf(best) || isinf(optimum(radius + AISLE_SPACE_SLACK, &request)));
            continue;
        }
        solved++;
        TEST_ASSERT_TRUE((double)answer.length < best * 1.0005);
        TEST_ASSERT_TRUE((double)answer.length_bound <= best);
        TEST_ASSERT_TRUE((double)answer.length_bound > best * (1.0 - 1e-5));
    }
    TEST_ASSERT_TRUE(solved > HALLS / 2);
}

static void test_every_objective_tells_the_same_bound(void) {
    hall_disc(0.3, 0.05F);
    aisle_rng rng = aisle_rng_seed(950U);
    random_hall(&rng);
    ask(AISLE_OPTIONS_SHORTEST, 0.8, 4.0, 11.2, 4.0);
    TEST_ASSERT_TRUE(plan(1000));
    float bound = answer.length_bound;
    for (int8_t objective = AISLE_OPTIONS_SAFEST; objective <= AISLE_OPTIONS_LEAST_ENERGY; objective++) {
        request.options.objective = objective;
        TEST_ASSERT_TRUE(plan(1000));
        TEST_ASSERT_EQUAL_FLOAT(bound, answer.length_bound);
    }
}

static void test_a_long_bodys_path_lies_between_the_optima_of_its_inner_and_its_outer_disc(void) {
    int solved = 0;
    int tight = 0;
    hall_rectangle(1.0, 0.6, 0.05F);
    double inner = hall_vehicle.inner_radius + hall_vehicle.margin;
    double outer = hall_vehicle.outer_radius + hall_vehicle.margin + AISLE_SPACE_SLACK;
    for (uint64_t s = 0; s < HALLS; s++) {
        aisle_rng rng = aisle_rng_seed(900U + s);
        random_hall(&rng);
        aisle_vec2 ends = uniform_point(&rng, aisle_vec2_of(1.0, 1.0), aisle_vec2_of(7.0, 7.0));
        ask(AISLE_OPTIONS_SHORTEST, 0.8, ends.x, 11.2, ends.y);
        if (!plan(1000)) {
            TEST_ASSERT_TRUE(isinf(optimum(outer, &request))); // where it can turn all along it finds a way
            continue;
        }
        solved++;
        double least = optimum(inner, &request);
        TEST_ASSERT_TRUE((double)answer.length_bound <= least && (double)answer.length_bound > least * (1.0 - 1e-5));
        TEST_ASSERT_TRUE((double)answer.length <= optimum(outer, &request) * 1.0005);
        tight += (double)answer.length < 1.01 * least ? 1 : 0;
    }
    printf("long body: %d of %d halls solved, %d within 1 %% of the inner disc's optimum\n", solved, HALLS, tight);
    TEST_ASSERT_TRUE(solved > HALLS / 2 && 4 * tight >= 3 * solved);
}

// A bend between walls 1.1 m apart: the disc in which the body turns needs 1.32 m.
static void test_a_body_drives_round_a_bend_in_which_it_cannot_turn(void) {
    hall_rectangle(1.0, 0.7, 0.05F);
    hall_begin(8.0, 8.0);
    hall_add(-1.0, 2.1, 4.9, 9.0); // above the way in, left of the way out
    hall_add(-1.0, -1.0, 9.0, 1.0);
    hall_add(6.0, 1.0, 9.0, 9.0);
    open_hall();
    ask(AISLE_OPTIONS_SHORTEST, 0.8, 1.55, 5.45, 7.2);
    TEST_ASSERT_TRUE(plan(1000));
    TEST_ASSERT_TRUE((double)answer.length < 1.02 * (double)answer.length_bound);
    for (int i = 0; i + 1 < answer.num_waypoints; i++) {
        TEST_ASSERT_EQUAL_INT16(0, answer.waypoints[i].flags & AISLE_WAYPOINT_TURN_IN_PLACE);
    }
}

static void test_a_tight_way_that_cannot_be_entered_gives_way_to_one_the_body_can_turn_on(void) {
    hall_rectangle(1.0, 0.7, 0.05F);
    hall_begin(10.0, 8.0);
    hall_add(3.0, -1.0, 3.2, 5.0);
    open_hall();
    ask(AISLE_OPTIONS_SHORTEST, 2.55, 1.0, 6.0, 1.0); // beside the wall, heading along it: no room to turn there
    request.start.theta = 1.5707963267948966;
    request.start.tolerance_theta = 0.05F;
    if (plan(1000)) { // judged free all along, the first turn included
        TEST_ASSERT_TRUE(answer.length >= answer.length_bound);
    } else {
        TEST_ASSERT_EQUAL_INT16(AISLE_STATUS_KINEMATIC, route.cause.cause);
    }
}

static void test_a_door_too_narrow_by_a_hair_is_proved_and_told_with_what_would_open_it(void) {
    hall_disc(0.4, 0.05F);
    hall_begin(8.0, 5.0);
    hall_add(4.0, -1.0, 4.2, 2.0);
    hall_add(4.0, 2.8999, 4.2, 6.0); // 0.1 mm too narrow for 0.9 m
    open_hall();
    ask(AISLE_OPTIONS_SHORTEST, 1.0, 2.5, 7.0, 2.5);
    TEST_ASSERT_FALSE(plan(1000));
    TEST_ASSERT_EQUAL_INT16(AISLE_STATUS_TOO_NARROW, route.cause.cause);
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, 0.8999, (double)route.cause.value);
    TEST_ASSERT_EQUAL_UINT32(4, route.told_count); // the place, both sides, the one that may go
    TEST_ASSERT_EQUAL_INT32(3, route.told[1].goal_id + route.told[2].goal_id);
    TEST_ASSERT_EQUAL_INT16(AISLE_WAYPOINT_GOAL, route.told[3].flags);
    TEST_ASSERT_TRUE(route.told[3].goal_id == 1 || route.told[3].goal_id == 2);
    hall_boxes[1].y0 = 2.9021; // and 2.1 mm wider than that it is a way
    open_hall();
    TEST_ASSERT_TRUE(plan(1000));
}

static void test_any_slicing_gives_the_same_bytes(void) {
    static uint8_t whole[AISLE_ROUTE_BYTES];
    hall_rectangle(1.0, 0.6, 0.05F);
    aisle_rng rng = aisle_rng_seed(903U);
    random_hall(&rng);
    ask(AISLE_OPTIONS_SHORTEST, 0.8, 4.0, 11.2, 4.0);
    TEST_ASSERT_TRUE(plan(UINT32_MAX));
    size_t size = aisle_route_answer(&route)->size;
    memcpy(whole, aisle_route_answer(&route)->bytes, size);
    uint32_t spent = route.spent;
    for (uint32_t slice = 1; slice < 3000U; slice = 3U * slice + 1U) {
        TEST_ASSERT_TRUE(plan(slice));
        TEST_ASSERT_EQUAL_UINT32(spent, route.spent);
        TEST_ASSERT_EQUAL_size_t(size, aisle_route_answer(&route)->size);
        TEST_ASSERT_EQUAL_MEMORY(whole, aisle_route_answer(&route)->bytes, size);
    }
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_a_discs_shortest_path_is_the_optimum_and_its_bound_lies_just_below);
    RUN_TEST(test_every_objective_tells_the_same_bound);
    RUN_TEST(test_a_long_bodys_path_lies_between_the_optima_of_its_inner_and_its_outer_disc);
    RUN_TEST(test_a_body_drives_round_a_bend_in_which_it_cannot_turn);
    RUN_TEST(test_a_tight_way_that_cannot_be_entered_gives_way_to_one_the_body_can_turn_on);
    RUN_TEST(test_a_door_too_narrow_by_a_hair_is_proved_and_told_with_what_would_open_it);
    RUN_TEST(test_any_slicing_gives_the_same_bytes);
    return UNITY_END();
}
