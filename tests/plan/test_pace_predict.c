#include "plan/pace_predict.h" // first: proves that the header stands alone

#include "base/arena.h"
#include "cases.h"
#include "driven.h"
#include "unity.h"

enum { BLOCK = 1 << 20, MOVERS = 4 };

static unsigned char block[BLOCK + AISLE_ARENA_ALIGN];
static aisle_pace_predict predict;
static aisle_mover mover[MOVERS];
static aisle_movers movers;
static bool carved;
static const int64_t NOW = 9000000;

void setUp(void) {
    static const aisle_vehicle_msg usual;
    if (!carved) {
        unsigned char *start = block;
        start += (AISLE_ARENA_ALIGN - (uintptr_t)start % AISLE_ARENA_ALIGN) % AISLE_ARENA_ALIGN;
        aisle_arena arena = aisle_arena_over(start, BLOCK);
        aisle_pace_predict_carve(&predict, &arena);
        TEST_ASSERT_FALSE(arena.overflow);
        carved = true;
    }
    set_vehicle(&usual);
    memset(dwell, 0, sizeof dwell);
    memset(mover, 0, sizeof mover);
    movers = (aisle_movers){.mover = mover};
    count = 0;
}
void tearDown(void) {}

static void put_mover(aisle_vec2 at, aisle_vec2 velocity, double v_bound) {
    TEST_ASSERT_LESS_THAN_UINT32(MOVERS, movers.count);
    mover[movers.count++] = (aisle_mover){
        .id = 1, .at = at, .velocity = velocity, .radius = 0.3, .sigma = 0.05, .v_bound = v_bound, .utime = NOW};
}

static aisle_pace_predict_request request_from(aisle_place at, double v) {
    return (aisle_pace_predict_request){.vehicle = &vehicle,
                                        .movers = &movers,
                                        .w = path,
                                        .n = count,
                                        .dwell = dwell,
                                        .at = at,
                                        .v = v,
                                        .until = count - 1,
                                        .now_us = NOW,
                                        .lease = 1.0};
}

static aisle_status run(const aisle_pace_predict_request *request) {
    uint32_t spent = 0;
    aisle_status st;
    aisle_pace_predict_start(&predict, request);
    do {
        st = aisle_pace_predict_step(&predict, 1000, &spent);
    } while (st == AISLE_BUSY);
    return st;
}

// ---- without movers: the path's own time

// As plans are: with ramps.
static void put_ramps(void) {
    aisle_profile_path way = {.w = path, .dwell = dwell, .n = count, .capacity = CAPACITY};
    static const aisle_profile_start at_rest = {0.0, NULL};
    TEST_ASSERT_EQUAL_INT(AISLE_OK, aisle_profile_fill_ramps(&vehicle, NULL, &way, &at_rest, &way_sum));
    count = way.n;
}

static void test_unhindered_it_takes_as_long_as_the_path_says(void) {
    for (uint64_t seed = 0; seed < CASES(200); seed++) {
        aisle_rng rng = aisle_rng_seed(seed);
        setUp();
        some_vehicle(seed);
        random_way(seed, 12, true);
        put_ramps();
        const aisle_place at = random_place(&rng);
        const double v = aisle_motion_speed(&vehicle, path, count, dwell, at);
        aisle_pace_predict_request request = request_from(at, v);
        request.until = at.piece + aisle_rng_below(&rng, count - at.piece);
        TEST_ASSERT_EQUAL_INT(AISLE_OK, run(&request));
        const double wanted = (double)path[request.until].t - aisle_motion_time(&vehicle, path, count, dwell, at);
        // A turn that is cut begins anew, and creeping pieces end up to half a step late.
        const double late = spot(path, at.piece) ? 2.0 : 0.05;
        TEST_ASSERT_TRUE(predict.seconds > wanted - 0.05 && predict.seconds < 1.01 * wanted + late);
        TEST_ASSERT_DOUBLE_WITHIN(0.0, 0.0, predict.waited);
        TEST_ASSERT_TRUE(predict.slowest > 1e9);
    }
}

static void test_rest_on_the_way_is_no_standing_however_long(void) {
    (void)add(0.0, 0.0, 0.0);
    add_line(6.0, 1.0);
    set_flag(&path[3], AISLE_WAYPOINT_STOP | AISLE_WAYPOINT_GOAL);
    dwell[3] = 100.0F;
    put_ramps();
    const aisle_pace_predict_request request = request_from((aisle_place){1, 0.0}, 0.0);
    TEST_ASSERT_EQUAL_INT(AISLE_OK, run(&request));
    TEST_ASSERT_DOUBLE_WITHIN(0.05, (double)path[count - 1].t, predict.seconds);
    TEST_ASSERT_DOUBLE_WITHIN(0.0, 0.0, predict.waited);
}

static void test_one_not_quite_at_rest_where_a_turn_begins_is_taken_to_rest(void) {
    (void)add(0.0, 0.0, 0.0);
    set_flag(add(2.0, 0.0, 0.0), AISLE_WAYPOINT_TURN_IN_PLACE);
    (void)add(2.0, 0.0, 1.5);
    (void)add(2.0, 3.0, 1.5);
    fill_way();
    const aisle_pace_predict_request request = request_from((aisle_place){1, 1.0}, 0.03);
    TEST_ASSERT_EQUAL_INT(AISLE_OK, run(&request));
    TEST_ASSERT_DOUBLE_WITHIN(0.05, (double)path[3].t - (double)path[1].t, predict.seconds);
}

static void test_where_it_is_already_it_takes_no_time(void) {
    random_way(3, 12, false);
    aisle_pace_predict_request request = request_from((aisle_place){4, 1.0}, 0.0);
    request.until = 4;
    TEST_ASSERT_EQUAL_INT(AISLE_OK, run(&request));
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0.0, predict.seconds);
    request = request_from((aisle_place){count - 1, 1.0}, 0.0);
    TEST_ASSERT_EQUAL_INT(AISLE_OK, run(&request));
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0.0, predict.seconds);
}

// ---- with movers: a fine simulation of a disc on a line, in long double

typedef struct runner { // along x
    real x, v;
} runner;

// The greatest speed of the path there: it rests at `end`.
static real path_speed(real x, real end) {
    return fminl(wide(vehicle.v_max), sqrtl(fmaxl(2.0L * wide(vehicle.d_max) * (end - x), 0.0L)));
}

static void move(runner *it, real cap, real end, real dt) {
    const real wanted = fminl(cap, path_speed(it->x, end));
    const real v = wanted > it->v ? fminl(it->v + wide(vehicle.a_max) * dt, wanted)
                                  : fmaxl(it->v - wide(vehicle.d_max) * dt, wanted);
    it->x += 0.5L * (it->v + v) * dt;
    it->v = v;
}

static bool touched(const runner *it, real now, real later) {
    for (uint32_t i = 0; i < movers.count; i++) {
        const aisle_mover *m = &mover[i];
        const real mx = wide(m->at.x) + wide(m->velocity.x) * now, my = wide(m->at.y) + wide(m->velocity.y) * now;
        const real reach = wide(m->radius) + 0.15L + wide(m->v_bound) * (0.1L + later + 0.12L);
        if (hypotl(mx - it->x, my) < reach + wide(vehicle.radius) + wide(vehicle.margin) + 0.01L) {
            return true;
        }
    }
    return false;
}

static bool is_safe(runner it, real cap, real end, real now, real lease) {
    const real dt = 0.04L, reaction = wide(vehicle.reaction_time);
    for (real t = 0.0L; t <= lease + reaction + 1e-9L; t += dt) {
        if (it.v > 0.0L && touched(&it, now, t)) {
            return false;
        }
        runner braking = it;
        for (real later = t; t >= reaction - 1e-9L && braking.v > 0.0L; later += dt) {
            if (touched(&braking, now, later)) {
                return false;
            }
            move(&braking, 0.0L, end, dt);
        }
        move(&it, cap, end, dt);
    }
    return true;
}

// Seconds to the end; gives up after 60 s in which it does not make 0.3 m.
static real simulate(real x, real v, real end, real lease) {
    const real dt = 0.05L;
    runner it = {x, v};
    real since = 0.0L, from = x, t = 0.0L;
    while (it.x < end - 0.01L && t - since < 60.0L) {
        real cap = 0.0L;
        for (uint32_t level = 0; level < AISLE_PACE_STOP; level++) {
            const real tried = fminl(wide(aisle_pace_cap(&vehicle, level)), wide(vehicle.v_max));
            if (is_safe(it, tried, end, t, lease)) {
                cap = tried;
                break;
            }
        }
        move(&it, cap, end, dt);
        t += dt;
        if (it.x > from + 0.3L) {
            since = t;
            from = it.x;
        }
    }
    return t;
}

static void test_it_agrees_with_a_fine_simulation_of_crossing_movers(void) {
    uint32_t near = 0, hindered = 0, cases = 0;
    for (uint64_t seed = 0; seed < CASES(40); seed++) {
        aisle_rng rng = aisle_rng_seed(seed);
        setUp();
        const aisle_vehicle_msg disc = {.footprint_radius = 0.4F};
        set_vehicle(&disc);
        (void)add(0.0, 0.0, 0.0);
        add_line(20.0, 0.5);
        fill_way();
        for (uint32_t i = 0; i < 1 + seed % 2; i++) {
            const double x = uniform(&rng, 4.0, 18.0), v = uniform(&rng, 0.3, 1.4), side = i == 0 ? 1.0 : -1.0;
            put_mover(aisle_vec2_of(x, -side * v * uniform(&rng, 2.0, 14.0)),
                      aisle_vec2_of(uniform(&rng, -0.4, 0.4), side * v), 1.6);
        }
        aisle_pace_predict_request request = request_from((aisle_place){1, 0.0}, 0.0);
        request.lease = seed % 2 == 0 ? 1.0 : 0.25;
        TEST_ASSERT_EQUAL_INT(AISLE_OK, run(&request));
        const double fine = (double)simulate(0.0L, 0.0L, 20.0L, wide(request.lease));
        TEST_ASSERT_TRUE(predict.seconds > (double)path[count - 1].t - 0.1);
        near += fabs(predict.seconds - fine) < 0.05 * fine + 0.5 ? 1U : 0U;
        TEST_ASSERT_DOUBLE_WITHIN(0.35 * fine, fine, predict.seconds);
        hindered += fine > (double)path[count - 1].t + 1.0 ? 1U : 0U;
        cases++;
    }
    TEST_ASSERT_GREATER_THAN_UINT32(cases / 3, hindered);
    TEST_ASSERT_GREATER_OR_EQUAL_UINT32(cases * 9 / 10, near);
}

static void test_a_standing_blocker_costs_what_it_takes_to_get_there_and_a_minute(void) {
    const aisle_vehicle_msg disc = {.footprint_radius = 0.4F};
    set_vehicle(&disc);
    (void)add(0.0, 0.0, 0.0);
    add_line(20.0, 0.5);
    fill_way();
    put_mover(aisle_vec2_of(12.0, 0.1), aisle_vec2_of(0.0, 0.0), 1.6);
    aisle_pace_predict_request request = request_from((aisle_place){1, 0.0}, 0.0);
    TEST_ASSERT_EQUAL_INT(AISLE_PARTIAL, run(&request));
    const double fine = (double)simulate(0.0L, 0.0L, 20.0L, wide(request.lease));
    TEST_ASSERT_DOUBLE_WITHIN(0.1 * (fine - 60.0) + 2.0, fine, predict.seconds);
    TEST_ASSERT_TRUE(predict.waited > 40.0 && predict.waited <= 60.0);
    TEST_ASSERT_DOUBLE_WITHIN(0.0, 0.0, predict.slowest);
    request.until = 8; // 4 m on it is not in the way
    TEST_ASSERT_EQUAL_INT(AISLE_OK, run(&request));
    TEST_ASSERT_TRUE(predict.seconds < 10.0);
}

static void test_a_blocker_that_leaves_is_waited_for_and_the_wait_is_told(void) {
    const aisle_vehicle_msg disc = {.footprint_radius = 0.4F};
    set_vehicle(&disc);
    (void)add(0.0, 0.0, 0.0);
    add_line(20.0, 0.5);
    fill_way();
    put_mover(aisle_vec2_of(3.0, 0.0), aisle_vec2_of(0.0, 0.2), 1.6); // some 3 m aside after 15 s
    const aisle_pace_predict_request request = request_from((aisle_place){1, 0.0}, 0.0);
    TEST_ASSERT_EQUAL_INT(AISLE_OK, run(&request));
    const double fine = (double)simulate(0.0L, 0.0L, 20.0L, wide(request.lease));
    TEST_ASSERT_DOUBLE_WITHIN(0.05 * fine + 0.5, fine, predict.seconds);
    TEST_ASSERT_TRUE(predict.waited > 3.0 && predict.waited < predict.seconds - (double)path[count - 1].t + 3.0);
}

static void test_a_mover_far_away_costs_nothing_and_one_beside_the_way_slows(void) {
    (void)add(0.0, 0.0, 0.0);
    add_line(20.0, 0.5);
    fill_way();
    aisle_pace_predict_request request = request_from((aisle_place){1, 0.0}, 0.0);
    request.lease = 0.25;
    TEST_ASSERT_EQUAL_INT(AISLE_OK, run(&request));
    const double alone = predict.seconds;
    put_mover(aisle_vec2_of(10.0, 30.0), aisle_vec2_of(0.0, 0.0), 1.6);
    TEST_ASSERT_EQUAL_INT(AISLE_OK, run(&request));
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, alone, predict.seconds);
    put_mover(aisle_vec2_of(10.0, 3.0), aisle_vec2_of(0.0, 0.0), 1.6);
    TEST_ASSERT_EQUAL_INT(AISLE_OK, run(&request));
    TEST_ASSERT_TRUE(predict.seconds > alone + 1.0 && predict.seconds < 3.0 * alone);
    TEST_ASSERT_TRUE(predict.slowest > 0.0 && predict.slowest < 1.5);
}

// ---- the manner of working

static void test_any_slicing_gives_the_same_answer_and_units_and_work_is_bounded(void) {
    for (uint64_t seed = 0; seed < CASES(20); seed++) {
        aisle_rng rng = aisle_rng_seed(seed);
        setUp();
        random_way(seed, 12, true);
        for (int i = 0; i < 3; i++) {
            put_mover(aisle_vec2_of(path[6].x + uniform(&rng, -4.0, 4.0), path[6].y + uniform(&rng, -4.0, 4.0)),
                      aisle_vec2_of(uniform(&rng, -0.5, 0.5), uniform(&rng, -0.5, 0.5)), 1.6);
        }
        const aisle_pace_predict_request request = request_from((aisle_place){1, 0.0}, 0.0);
        uint32_t whole = 0, sliced = 0;
        aisle_pace_predict_start(&predict, &request);
        const aisle_status st = aisle_pace_predict_step(&predict, UINT32_MAX, &whole);
        const double seconds = predict.seconds;
        TEST_ASSERT_TRUE(predict.steps <= AISLE_PREDICT_STEPS + 1U);
        aisle_pace_predict_start(&predict, &request);
        while (aisle_pace_predict_step(&predict, 1, &sliced) == AISLE_BUSY) {
        }
        TEST_ASSERT_EQUAL_INT(st, predict.outcome);
        TEST_ASSERT_EQUAL_UINT32(whole, sliced);
        TEST_ASSERT_EQUAL_DOUBLE(seconds, predict.seconds);
        TEST_ASSERT_EQUAL_INT(st, aisle_pace_predict_step(&predict, 1, &sliced));
        TEST_ASSERT_EQUAL_UINT32(whole, sliced);
    }
}

static void test_a_way_of_hours_ends_with_its_own_time(void) {
    const aisle_vehicle_msg slow = {.v_max = 0.05F};
    set_vehicle(&slow);
    (void)add(0.0, 0.0, 0.0);
    add_line(100.0, 0.5); // 2000 s
    put_ramps();
    const aisle_pace_predict_request request = request_from((aisle_place){1, 0.0}, 0.0);
    TEST_ASSERT_EQUAL_INT(AISLE_OK, run(&request));
    TEST_ASSERT_DOUBLE_WITHIN(1.0, (double)path[count - 1].t, predict.seconds);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_unhindered_it_takes_as_long_as_the_path_says);
    RUN_TEST(test_rest_on_the_way_is_no_standing_however_long);
    RUN_TEST(test_one_not_quite_at_rest_where_a_turn_begins_is_taken_to_rest);
    RUN_TEST(test_where_it_is_already_it_takes_no_time);
    RUN_TEST(test_it_agrees_with_a_fine_simulation_of_crossing_movers);
    RUN_TEST(test_a_standing_blocker_costs_what_it_takes_to_get_there_and_a_minute);
    RUN_TEST(test_a_blocker_that_leaves_is_waited_for_and_the_wait_is_told);
    RUN_TEST(test_a_mover_far_away_costs_nothing_and_one_beside_the_way_slows);
    RUN_TEST(test_any_slicing_gives_the_same_answer_and_units_and_work_is_bounded);
    RUN_TEST(test_a_way_of_hours_ends_with_its_own_time);
    return UNITY_END();
}
