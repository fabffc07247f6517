#include "plan/route.h"

#include "asked_route.h"
#include "cases.h"

enum { SEEDS = CASES(10) };

static void open_with(const aisle_limits *limits) {
    hall_open_route(&route, limits, 1000000U);
}

static void open_hall(void) {
    open_with(&hall_limits);
}

// Steps to the end; returns how often a first path was announced. No step overdraws by more than a piece.
static int finish(uint32_t slice) {
    int announced = 0;
    aisle_status st;
    do {
        uint32_t before = route.spent;
        st = aisle_route_step(&route, slice);
        TEST_ASSERT_TRUE(slice > UINT32_MAX - 4096U || route.spent - before <= slice + 4096U);
        if (st == AISLE_PARTIAL) {
            TEST_ASSERT_NOT_NULL(aisle_route_answer(&route));
            announced += 1;
        }
    } while (st != AISLE_OK);
    return announced;
}

static int plan(uint32_t slice) {
    route_begin();
    return finish(slice);
}

static void pillar_hall(void) {
    hall_begin(12.0, 8.0);
    hall_add(5.0, 3.0, 7.0, 5.0);
    open_hall();
}

void setUp(void) {
    hall_rectangle(1.0, 0.7, 0.1F);
    pillar_hall();
}
void tearDown(void) {}

static void random_hall(aisle_rng *rng) {
    hall_begin(12.0, 8.0);
    for (int i = 0; i < 6; i++) {
        double x = uniform(rng, 1.5, 9.0);
        double y = uniform(rng, 0.5, 6.5);
        aisle_vec2 size = uniform_point(rng, aisle_vec2_of(0.3, 0.3), aisle_vec2_of(1.5, 1.5));
        hall_add(x, y, x + size.x, y + size.y);
    }
    open_hall();
}

// ---- tests

static void test_auto_is_never_worse_than_the_seed_nor_than_astar_and_every_answer_is_free(void) {
    int better = 0;
    int ways = 0;
    for (uint64_t s = 0; s < SEEDS; s++) {
        aisle_rng rng = aisle_rng_seed(s);
        random_hall(&rng);
        int8_t objective = (int8_t)(s % 4U);
        aisle_vec2 ends = uniform_point(&rng, aisle_vec2_of(1.0, 1.0), aisle_vec2_of(7.0, 7.0));
        route_ask(AISLE_OPTIONS_ASTAR, 0.8, ends.x, 11.2, ends.y);
        request.options.objective = objective;
        request.options.interpolation = s < SEEDS / 2 ? AISLE_OPTIONS_SPLINE : AISLE_OPTIONS_LINEAR;
        (void)plan(1000);
        if (aisle_route_answer(&route) == NULL) {
            continue;
        }
        double seed = route_proof()->value;
        TEST_ASSERT_EQUAL_INT8(AISLE_OPTIONS_ASTAR, answer.planner);
        request.options.planner = AISLE_OPTIONS_AUTO;
        (void)plan(1000);
        const aisle_proof *best = route_proof();
        TEST_ASSERT_TRUE(best->value <= seed * (1.0 + 1e-9));
        if (objective == AISLE_OPTIONS_FASTEST) {
            TEST_ASSERT_DOUBLE_WITHIN(1e-6, (double)answer.duration, best->value);
        }
        TEST_ASSERT_EQUAL_INT32(route.announced && !best->told ? 9 : 8, answer.path_revision);
        better += best->value < 0.99 * seed;
        ways += 1;
    }
    TEST_ASSERT_TRUE(ways >= CASES(7) && better >= SEEDS / 5);
}

static void test_the_first_proof_is_announced_once_before_the_end(void) {
    route_ask(AISLE_OPTIONS_AUTO, 2.0, 4.0, 10.0, 4.0);
    request.options.objective = AISLE_OPTIONS_FASTEST;
    TEST_ASSERT_EQUAL_INT(1, plan(500));
    (void)route_proof();
    TEST_ASSERT_TRUE(route.swarm_evals > 0);
    route_ask(AISLE_OPTIONS_ASTAR, 2.0, 4.0, 10.0, 4.0);
    TEST_ASSERT_EQUAL_INT(0, plan(500)); // nothing takes long
    TEST_ASSERT_EQUAL_INT64(0, route.swarm_evals);
}

static void test_pso_by_name_takes_the_swarms_path_in_both_interpolations(void) {
    for (int8_t interpolation = 0; interpolation < 2; interpolation++) {
        route_ask(AISLE_OPTIONS_PSO, 2.0, 4.0, 10.0, 4.0);
        request.options.interpolation = interpolation;
        (void)plan(500);
        TEST_ASSERT_FALSE(route_proof()->told);
        TEST_ASSERT_EQUAL_INT8(AISLE_OPTIONS_PSO, answer.planner);
    }
}

static void test_a_disc_on_shortest_comes_within_a_thousandth_of_the_tangents_and_arcs(void) {
    hall_disc(0.4, 0.1F);
    pillar_hall();
    for (int8_t planner = 0; planner < 2; planner++) {
        route_ask(planner == 0 ? AISLE_OPTIONS_AUTO : AISLE_OPTIONS_ASTAR, 2.0, 4.0, 10.0, 4.2);
        request.options.objective = AISLE_OPTIONS_SHORTEST;
        (void)plan(1000);
        (void)route_proof();
        double r = 0.5;
        double a = hypot(3.0, 1.0); // start to the upper left corner, upper right one to the goal
        double b = hypot(3.0, 0.8);
        double rise = asin(1.0 / a) + asin(r / a);
        double fall = asin(0.8 / b) + asin(r / b);
        double truth = sqrt(a * a - r * r) + sqrt(b * b - r * r) + 2.0 + r * (rise + fall);
        TEST_ASSERT_DOUBLE_WITHIN(2e-3 * truth, truth, (double)answer.length);
    }
}

// A fixed heading that the first leg all but has is turned to, not taken for it.
static void test_a_start_heading_just_off_the_first_leg_is_kept(void) {
    const double off[] = {0.0, 1e-8, 1e-6, 1e-5, 5e-4, -5e-4, 2e-3};
    for (size_t i = 0; i < sizeof off / sizeof off[0]; i++) {
        route_ask(AISLE_OPTIONS_AUTO, 1.0, 1.0, 10.0, 1.0);
        request.options.objective = AISLE_OPTIONS_SHORTEST;
        request.start.tolerance_theta = 0.0F;
        request.start.theta = off[i];
        (void)plan(1000);
        (void)route_proof();
        TEST_ASSERT_DOUBLE_WITHIN(1e-6, off[i], answer.waypoints[0].theta);
    }
}

static void test_stops_build_the_path_without_arcs(void) {
    route_ask(AISLE_OPTIONS_AUTO, 2.0, 4.0, 10.0, 4.0);
    request.options.objective = AISLE_OPTIONS_SHORTEST;
    head = (aisle_path_msg){.boot_id = 3, .path_revision = 8};
    aisle_route_start(&route, &hall_layout, &hall_vehicle, &request, &head);
    route.stops = true; // as if the verifier had turned the arcs down
    TEST_ASSERT_EQUAL_INT(0, finish(1000));
    (void)route_proof();
    int turns = 0;
    for (int16_t i = 0; i < answer.num_waypoints; i++) {
        TEST_ASSERT_TRUE(fabs((double)answer.waypoints[i].curvature) <= 0.0);
        turns += (answer.waypoints[i].flags & AISLE_WAYPOINT_TURN_IN_PLACE) != 0;
    }
    TEST_ASSERT_TRUE(turns >= 1);
}

static void test_budgets_end_with_budget_before_the_first_proof_and_with_it_after(void) {
    int refused = 0;
    int first = 0;
    route_ask(AISLE_OPTIONS_PSO, 2.0, 4.0, 10.0, 4.0);
    for (int32_t budget = 200; budget < 60000; budget += budget / 4) {
        request.options.work_units = budget;
        (void)plan(700);
        TEST_ASSERT_TRUE(route.spent <= (uint32_t)budget + 4096U);
        if (aisle_route_answer(&route) == NULL) {
            route_refused(AISLE_STATUS_BUDGET);
            TEST_ASSERT_EQUAL_INT(0, first); // more budget never proves less
            refused += 1;
        } else {
            (void)route_proof();
            first += answer.planner == AISLE_OPTIONS_ASTAR;
        }
    }
    TEST_ASSERT_TRUE(refused >= 3 && first >= 1);
    TEST_ASSERT_EQUAL_INT8(AISLE_OPTIONS_PSO, answer.planner);
}

static void test_a_swarm_cut_short_leaves_enough_to_prove_its_path(void) {
    route_ask(AISLE_OPTIONS_PSO, 2.0, 4.0, 10.0, 4.0);
    request.options.work_units = 14000;
    (void)plan(700);
    int64_t some = route.swarm_evals;
    TEST_ASSERT_FALSE(route_proof()->told);
    TEST_ASSERT_TRUE(route.spent <= 14000);
    request.options.work_units = 0;
    (void)plan(700);
    TEST_ASSERT_TRUE(some > 0 && some < route.swarm_evals);
}

static void test_any_slicing_gives_the_same_bytes_and_units(void) {
    static uint8_t whole[AISLE_ROUTE_BYTES];
    static const uint32_t slices[] = {1, 33, 2500};
    route_ask(AISLE_OPTIONS_AUTO, 2.0, 4.0, 10.0, 4.0);
    request.goals[1] = (aisle_goal_msg){.id = 12, .x = 6.0, .y = 7.0, .theta = 1.0};
    request.num_goals = 2;
    (void)plan(UINT32_MAX);
    size_t size = route_proof()->size;
    uint32_t units = route.spent;
    memcpy(whole, aisle_route_answer(&route)->bytes, size);
    for (int i = 0; i < 3; i++) {
        TEST_ASSERT_EQUAL_INT(1, plan(slices[i]));
        TEST_ASSERT_EQUAL_size_t(size, route_proof()->size);
        TEST_ASSERT_EQUAL_MEMORY(whole, aisle_route_answer(&route)->bytes, size);
        TEST_ASSERT_EQUAL_UINT32(units, route.spent);
    }
}

// A wall with a slit wider than the disc and its margins by `spare`, at any place between the cells' centres.
static int slits_found(double spare) {
    int found = 0;
    for (int k = 0; k < 10; k++) {
        double low = 3.0 + 0.0051 * k;
        hall_begin(10.0, 6.0);
        hall_add(4.75, -1.0, 5.25, low);
        hall_add(4.75, low + 0.8 + spare, 5.25, 7.0);
        hall_disc(0.3, 0.1F);
        open_hall();
        route_ask(AISLE_OPTIONS_AUTO, 1.0, 1.0, 9.0, 1.0);
        request.options.objective = AISLE_OPTIONS_SHORTEST;
        (void)plan(1000);
        if (aisle_route_answer(&route) != NULL) {
            (void)route_proof();
            found++;
        }
    }
    return found;
}

static void test_slits_far_narrower_than_a_cell_are_found_wherever_they_lie(void) {
    TEST_ASSERT_EQUAL(10, slits_found(0.06));
    TEST_ASSERT_EQUAL(10, slits_found(0.018));
    TEST_ASSERT_EQUAL(10, slits_found(0.002)); // half a millimetre on either side is the proof's
}

static void test_a_long_body_takes_an_aisle_narrower_than_its_diagonal_along_it(void) {
    hall_rectangle(1.6, 0.5, 0.05F);
    hall_begin(12.0, 8.0);
    hall_add(3.0, 0.0, 9.0, 3.6); // an aisle of 0.8 m; the diagonal is 1.68 m
    hall_add(3.0, 4.4, 9.0, 8.0);
    open_hall();
    for (int k = 0; k < 8; k++) {
        route_ask(k % 2 == 0 ? AISLE_OPTIONS_AUTO : AISLE_OPTIONS_ASTAR, 1.5, 2.0 + 0.5 * k, 10.5, 6.0 - 0.4 * k);
        request.options.objective = k % 4 < 2 ? AISLE_OPTIONS_SAFEST : AISLE_OPTIONS_SHORTEST;
        (void)plan(1000);
        (void)route_proof(); // it turns before and behind the aisle, where there is room
        TEST_ASSERT_EQUAL(AISLE_SPACE_ALONG, route.legs[0].mode);
    }
}

static void test_a_bend_no_body_can_take_is_kinematic_with_its_place(void) {
    hall_rectangle(1.6, 0.5, 0.05F);
    hall_begin(12.0, 8.0);
    hall_add(0.0, 0.0, 5.0, 3.6); // aisles of 0.8 m with a right angle
    hall_add(5.8, 0.0, 12.0, 8.0);
    hall_add(0.0, 4.4, 5.8, 8.0);
    open_hall();
    route_ask(AISLE_OPTIONS_AUTO, 1.5, 4.0, 5.4, 1.5);
    (void)plan(1000);
    route_refused(AISLE_STATUS_KINEMATIC);
    TEST_ASSERT_EQUAL_UINT32(1, route.told_count);
    const aisle_waypoint_msg *at = &route.told[0];
    TEST_ASSERT_TRUE(at->x > 1.0 && at->x < 5.8 && at->y > 1.0 && at->y < 4.4);
}

static void test_curves_a_vehicle_cannot_drive_are_kinematic(void) {
    hall_vehicle.curvature_max = 0.5; // 2 m; an aisle of 1 m about a block leaves the body 5 cm to either side
    hall_begin(6.0, 4.0);
    hall_add(1.0, 1.0, 5.0, 3.0);
    open_hall();
    route_ask(AISLE_OPTIONS_AUTO, 0.5, 2.0, 5.5, 2.0);
    (void)plan(1000);
    route_refused(AISLE_STATUS_KINEMATIC);
}

static void test_a_turn_there_is_no_room_for_is_kinematic_at_its_goal(void) {
    hall_vehicle.curvature_max = 0.5;
    hall_begin(6.0, 4.0);
    hall_add(1.0, 1.0, 5.0, 3.0);
    open_hall();
    route_ask(AISLE_OPTIONS_AUTO, 0.5, 2.0, 0.5, 2.0);
    request.start = (aisle_goal_msg){.x = 0.5, .y = 2.0, .theta = 1.5707963};
    request.goals[0] = (aisle_goal_msg){.id = 11, .x = 0.5, .y = 2.0, .theta = -1.5707963};
    (void)plan(1000);
    route_refused(AISLE_STATUS_KINEMATIC);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 0.5, route.told[0].x);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 2.0, route.told[0].y);
    request.goals[0].theta = 1.5707963F; // nothing to do
    (void)plan(1000);
    (void)route_proof();
    TEST_ASSERT_TRUE(answer.length <= 0.0F);
}

static void test_headings_that_leave_no_room_to_turn_are_reached_by_turning_elsewhere(void) {
    hall_rectangle(1.6, 0.5, 0.05F);
    hall_begin(12.0, 8.0);
    hall_add(3.0, 0.0, 9.0, 3.6); // an aisle of 0.8 m; the diagonal is 1.68 m
    hall_add(3.0, 4.4, 9.0, 8.0);
    open_hall();
    for (int k = 0; k < 4; k++) { // the place in the aisle is the goal or the start, faced either way
        double theta = k % 2 == 0 ? 0.0 : 3.14159265;
        route_ask(AISLE_OPTIONS_AUTO, 1.5, 4.0, 6.0, 4.0);
        request.options.objective = AISLE_OPTIONS_SHORTEST;
        request.start.tolerance_theta = request.goals[0].tolerance_theta = 0.0F;
        request.goals[0].theta = theta;
        if (k >= 2) {
            aisle_goal_msg swap = request.start;
            request.start = request.goals[0];
            request.goals[0] = swap;
        }
        (void)plan(1000);
        (void)route_proof();
        TEST_ASSERT_TRUE(answer.length <= (k % 2 == 0 ? 9.0F : 12.0F));
        TEST_ASSERT_EQUAL_INT64(0, route.verify_failed); // it saw so itself
    }
}

static void test_legs_go_on_with_the_heading_they_end_with(void) {
    hall_rectangle(1.6, 0.5, 0.05F);
    hall_begin(12.0, 8.0);
    hall_add(3.0, 0.0, 9.0, 3.6); // an aisle of 0.8 m; the diagonal is 1.68 m
    hall_add(3.0, 4.4, 9.0, 8.0);
    open_hall();
    route_ask(AISLE_OPTIONS_AUTO, 1.5, 4.0, 6.0, 4.0); // into the aisle, and back out of it: backwards
    request.goals[1] = (aisle_goal_msg){.id = 12, .x = 1.5, .y = 4.0, .tolerance_theta = 4.0F};
    request.num_goals = 2;
    request.options.objective = AISLE_OPTIONS_SHORTEST;
    (void)plan(1000);
    (void)route_proof();
    TEST_ASSERT_TRUE(answer.length <= 9.01F);
    TEST_ASSERT_TRUE((answer.waypoints[answer.num_waypoints - 1].flags & AISLE_WAYPOINT_REVERSE) != 0);
}

// Cars that have to manoeuvre at both ends, round a block with room enough to keep off it and off the walls.
static void test_a_cars_safest_and_fastest_ways_keep_off_what_its_shortest_one_brushes(void) {
    hall_rectangle(2.0, 0.9, 0.05F);
    hall_vehicle.curvature_max = 0.66;
    hall_begin(18.0, 14.0);
    hall_add(6.0, 5.0, 12.0, 9.0);
    open_hall();
    for (int k = 0; k < 4; k++) {
        float risk[3] = {0}, duration[3] = {0};
        static const int8_t objectives[3] = {AISLE_OPTIONS_SHORTEST, AISLE_OPTIONS_SAFEST, AISLE_OPTIONS_FASTEST};
        for (int i = 0; i < 3; i++) {
            route_ask(AISLE_OPTIONS_AUTO, 4.0, 7.0, 14.0, 6.0 + 0.5 * k);
            request.options.objective = objectives[i];
            request.start.tolerance_theta = request.goals[0].tolerance_theta = 0.0F;
            request.start.theta = k % 2 == 0 ? 3.0 : -1.5;
            request.goals[0].theta = k < 2 ? 1.6 : 3.1;
            (void)plan(1000);
            (void)route_proof();
            TEST_ASSERT_DOUBLE_WITHIN(1e-6, request.goals[0].theta, answer.waypoints[answer.num_waypoints - 1].theta);
            risk[i] = answer.risk;
            duration[i] = answer.duration;
        }
        TEST_ASSERT_TRUE(risk[1] < 0.5F * risk[0]);
        TEST_ASSERT_TRUE(duration[2] < 0.97F * duration[0]);
    }
}

static void test_a_curve_wide_enough_is_driven_without_turns_on_the_spot(void) {
    hall_vehicle.curvature_max = 0.8;
    hall_begin(20.0, 16.0);
    hall_add(8.0, 6.0, 10.0, 10.0);
    open_hall();
    route_ask(AISLE_OPTIONS_AUTO, 2.0, 8.0, 18.0, 8.0);
    (void)plan(1000);
    (void)route_proof();
    for (int16_t i = 0; i < answer.num_waypoints; i++) {
        TEST_ASSERT_TRUE(fabs((double)answer.waypoints[i].curvature) <= 0.8 + 1e-6);
        TEST_ASSERT_EQUAL_INT16(0, answer.waypoints[i].flags & AISLE_WAYPOINT_TURN_IN_PLACE);
    }
}

static void test_the_second_leg_is_named_where_it_fails(void) {
    hall_add(9.0, 0.0, 9.2, 8.0);
    open_hall();
    route_ask(AISLE_OPTIONS_AUTO, 2.0, 4.0, 2.0, 7.0);
    request.goals[1] = (aisle_goal_msg){.id = 12, .x = 10.5, .y = 4.0, .tolerance_theta = 4.0F};
    request.num_goals = 2;
    (void)plan(1000);
    route_refused(AISLE_STATUS_NO_PATH);
    TEST_ASSERT_EQUAL_INT32(12, route.cause.id);
}

static void test_a_full_open_list_is_a_limit(void) {
    aisle_limits limits = hall_limits;
    limits.open_nodes = 16;
    open_with(&limits);
    route_ask(AISLE_OPTIONS_PSO, 2.0, 4.0, 10.0, 4.0);
    (void)plan(1000);
    route_refused(AISLE_STATUS_LIMIT);
}

static void test_the_answer_carries_the_ids_it_was_asked_with(void) {
    route_ask(AISLE_OPTIONS_AUTO, 2.0, 4.0, 10.0, 4.0);
    (void)plan(1000);
    (void)route_proof();
    TEST_ASSERT_EQUAL_INT64(3, answer.boot_id);
    TEST_ASSERT_EQUAL_INT32(5, answer.query_id);
    TEST_ASSERT_EQUAL_INT32(1, answer.map_id);
    TEST_ASSERT_EQUAL_INT32(hall_vehicle.revision, answer.vehicle_revision);
    TEST_ASSERT_EQUAL_INT64(100, answer.t0_utime);
    TEST_ASSERT_TRUE(answer.work_units > 0 && answer.work_units <= (int32_t)route.spent);
    TEST_ASSERT_TRUE(answer.length_bound >= 7.99F);
}

static void test_memory_is_about_what_the_header_says(void) {
    aisle_arena arena = aisle_arena_measure();
    aisle_limits least = {4096U, 1U, 3U, 1024U, 1U, 1U};
    static aisle_route measured;
    aisle_route_carve(&measured, &arena, &least);
    TEST_ASSERT_TRUE(arena.used < 1300U << 10);
}

static void test_the_papers_method_gives_a_proved_path_of_its_own_or_a_plain_refusal(void) {
    int paths = 0;
    hall_disc(0.3, 0.1F);
    hall_begin(10.0, 8.0);
    hall_add(3.0, 3.0, 4.0, 5.2);
    hall_add(6.0, 2.0, 7.5, 4.5);
    open_hall();
    for (int32_t seed = 1; seed <= SEEDS; seed++) {
        for (int8_t kind = AISLE_OPTIONS_SPLINE; kind <= AISLE_OPTIONS_LINEAR; kind++) {
            route_ask(AISLE_OPTIONS_PSO, 1.0, 4.0, 9.0, 4.0);
            request.options.objective = AISLE_OPTIONS_PAPER;
            request.options.interpolation = kind;
            request.options.seed = seed;
            TEST_ASSERT_EQUAL_INT(0, plan(1000)); // no path of another method goes before
            if (aisle_route_answer(&route) == NULL) {
                TEST_ASSERT_NOT_EQUAL_INT16(0, route.cause.cause);
                continue;
            }
            (void)route_proof();
            TEST_ASSERT_EQUAL_INT8(AISLE_OPTIONS_PSO, answer.planner);
            paths++;
        }
    }
    TEST_ASSERT_GREATER_OR_EQUAL_INT(SEEDS, paths);
}

static void test_the_papers_method_does_not_call_its_failure_a_proof(void) {
    hall_disc(0.3, 0.1F);
    hall_begin(10.0, 8.0);
    hall_add(4.0, 0.0, 5.0, 8.0);
    open_hall();
    route_ask(AISLE_OPTIONS_PSO, 1.0, 4.0, 9.0, 4.0);
    request.options.objective = AISLE_OPTIONS_PAPER;
    TEST_ASSERT_EQUAL_INT(0, plan(5000));
    TEST_ASSERT_NULL(aisle_route_answer(&route));
    TEST_ASSERT_EQUAL_INT16(AISLE_STATUS_BUDGET, route.cause.cause);
}

static void test_the_papers_objective_belongs_to_its_planner_alone(void) {
    const int8_t planners[] = {AISLE_OPTIONS_AUTO, AISLE_OPTIONS_ASTAR};
    open_hall();
    for (int i = 0; i < 2; i++) {
        route_ask(planners[i], 1.0, 4.0, 9.0, 4.0);
        request.options.objective = AISLE_OPTIONS_PAPER;
        (void)plan(5000);
        TEST_ASSERT_EQUAL_INT16(AISLE_STATUS_MALFORMED, route.cause.cause);
    }
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_auto_is_never_worse_than_the_seed_nor_than_astar_and_every_answer_is_free);
    RUN_TEST(test_the_first_proof_is_announced_once_before_the_end);
    RUN_TEST(test_pso_by_name_takes_the_swarms_path_in_both_interpolations);
    RUN_TEST(test_a_disc_on_shortest_comes_within_a_thousandth_of_the_tangents_and_arcs);
    RUN_TEST(test_a_start_heading_just_off_the_first_leg_is_kept);
    RUN_TEST(test_stops_build_the_path_without_arcs);
    RUN_TEST(test_budgets_end_with_budget_before_the_first_proof_and_with_it_after);
    RUN_TEST(test_a_swarm_cut_short_leaves_enough_to_prove_its_path);
    RUN_TEST(test_any_slicing_gives_the_same_bytes_and_units);
    RUN_TEST(test_slits_far_narrower_than_a_cell_are_found_wherever_they_lie);
    RUN_TEST(test_a_long_body_takes_an_aisle_narrower_than_its_diagonal_along_it);
    RUN_TEST(test_a_bend_no_body_can_take_is_kinematic_with_its_place);
    RUN_TEST(test_curves_a_vehicle_cannot_drive_are_kinematic);
    RUN_TEST(test_a_turn_there_is_no_room_for_is_kinematic_at_its_goal);
    RUN_TEST(test_headings_that_leave_no_room_to_turn_are_reached_by_turning_elsewhere);
    RUN_TEST(test_legs_go_on_with_the_heading_they_end_with);
    RUN_TEST(test_a_cars_safest_and_fastest_ways_keep_off_what_its_shortest_one_brushes);
    RUN_TEST(test_a_curve_wide_enough_is_driven_without_turns_on_the_spot);
    RUN_TEST(test_the_second_leg_is_named_where_it_fails);
    RUN_TEST(test_a_full_open_list_is_a_limit);
    RUN_TEST(test_the_answer_carries_the_ids_it_was_asked_with);
    RUN_TEST(test_memory_is_about_what_the_header_says);
    RUN_TEST(test_the_papers_method_gives_a_proved_path_of_its_own_or_a_plain_refusal);
    RUN_TEST(test_the_papers_method_does_not_call_its_failure_a_proof);
    RUN_TEST(test_the_papers_objective_belongs_to_its_planner_alone);
    return UNITY_END();
}
