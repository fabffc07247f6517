#include "plan/pace.h" // first: proves that the header stands alone

#include "base/arena.h"
#include "cases.h"
#include "driven.h"
#include "plan/verify.h"
#include "plan/verify_moving.h"
#include "unity.h"

enum { BLOCK = 16 << 20, MOVERS = 6 };

static unsigned char block[2][BLOCK + AISLE_ARENA_ALIGN];
static aisle_layout hall;
static aisle_pace pace;
static aisle_path_msg out, other;
static aisle_mover mover[MOVERS];
static aisle_movers movers;
static const int64_t NOW = 5000000;

static aisle_arena arena_over(int which) {
    unsigned char *start = block[which];
    start += (AISLE_ARENA_ALIGN - (uintptr_t)start % AISLE_ARENA_ALIGN) % AISLE_ARENA_ALIGN;
    return aisle_arena_over(start, BLOCK);
}

// An empty hall of 400 m.
static void build_hall(void) {
    static aisle_layout_msg msg = {.map_id = 3, .map_revision = 5, .num_parts = 1};
    const aisle_limits limits = {.cells = 65536, .polygons = 16, .vertices = 256, .open_nodes = 1024, .requests = 1};
    aisle_arena arena = arena_over(0);
    aisle_refusal why;
    memset(&hall, 0, sizeof hall);
    aisle_layout_carve(&hall, &arena, &limits);
    msg.x_min = msg.y_min = -200.0;
    msg.x_max = msg.y_max = 200.0;

    TEST_ASSERT_EQUAL_INT(AISLE_OK, aisle_layout_take_part(&hall, &msg, &why));
    aisle_layout_commit(&hall);
    while (aisle_layout_build(&hall, 1000) == AISLE_BUSY) {
    }
    TEST_ASSERT_TRUE(aisle_layout_is_in_force(&hall));
}

void setUp(void) {
    static const aisle_vehicle_msg usual;
    if (!aisle_layout_is_in_force(&hall)) {
        build_hall();
        aisle_arena arena = arena_over(1);
        aisle_pace_carve(&pace, &arena);
        TEST_ASSERT_FALSE(arena.overflow);
    }
    set_vehicle(&usual);
    memset(dwell, 0, sizeof dwell);
    memset(mover, 0, sizeof mover);
    movers = (aisle_movers){.mover = mover};
    count = 0;
}
void tearDown(void) {}

static void put_mover(double x, double y, double radius, double v_bound) {
    TEST_ASSERT_LESS_THAN_UINT32(MOVERS, movers.count);
    mover[movers.count] = (aisle_mover){.id = 100 + (int32_t)movers.count,
                                        .source = 1,
                                        .at = {x, y},
                                        .radius = radius,
                                        .sigma = 0.05,
                                        .v_bound = v_bound,
                                        .utime = NOW - 100000};
    movers.count++;
}

static aisle_pace_request request_at(aisle_place at, double v) {
    return (aisle_pace_request){.layout = &hall,
                                .vehicle = &vehicle,
                                .movers = &movers,
                                .w = path,
                                .n = count,
                                .dwell = dwell,
                                .at = at,
                                .v = v,
                                .now_us = NOW,
                                .lease = 1.0,
                                .current = 0};
}

static aisle_status run(const aisle_pace_request *request, aisle_path_msg *to) {
    uint32_t spent = 0;
    aisle_status st;
    aisle_pace_start(&pace, request, to);
    do {
        st = aisle_pace_step(&pace, 100, &spent);
    } while (st == AISLE_BUSY);
    return st;
}

// Every braking motion of a path that was made: how much the body keeps off every mover's reach beyond the margin.
static real slack_of(const aisle_path_msg *made, double v, double lease) {
    const uint32_t n = (uint32_t)(uint16_t)made->num_waypoints;
    const aisle_place start = {0, 1.0}; // what rest there is at the first waypoint is ahead
    real worst = 1e9L;
    drive_all(made->waypoints, n, pace.dwell, start, wide(v), wide(lease), 0.004L, 8);
    for (uint32_t i = 0; i < movers.count; i++) {
        const aisle_mover *m = &mover[i];
        const real reach = wide(m->radius) + 3.0L * wide(m->sigma) + wide(m->v_bound) * (real)(NOW - m->utime) * 1e-6L;
        worst = fminl(worst, worst_slack(wide(m->at.x), wide(m->at.y), reach, wide(m->v_bound), 0.1L));
    }
    return worst - wide(vehicle.margin);
}

static aisle_pace_request random_request(uint64_t seed, uint32_t how_many) {
    aisle_rng rng = aisle_rng_seed(seed);
    setUp();
    some_vehicle(seed);
    way_piece_max = seed % 4 == 1 ? 8.0 : 3.0;
    random_way(seed, 14, true);
    const aisle_place at = random_place(&rng);
    double v = aisle_motion_speed(&vehicle, path, count, dwell, at);
    v *= seed % 4 == 0 ? uniform(&rng, 0.3, 1.0) : 1.0;
    const aisle_place ahead = aisle_motion_advance(path, count, at, uniform(&rng, 0.0, 5.0));
    const aisle_pose2 about = aisle_motion_pose(path, count, ahead);
    for (uint32_t i = 0; i < how_many; i++) {
        put_mover(about.x + uniform(&rng, -4.0, 4.0), about.y + uniform(&rng, -4.0, 4.0), uniform(&rng, 0.2, 0.5),
                  aisle_rng_below(&rng, 4) == 0 ? 0.0 : uniform(&rng, 0.0, 2.0));
    }
    aisle_pace_request request = request_at(at, v);
    request.lease = seed % 2 == 0 ? 1.0 : 0.5;
    return request;
}

static void test_what_it_takes_is_safe_for_2000_of_2000_cases(void) {
    uint32_t levels[AISLE_PACE_LEVELS] = {0}, tight = 0;
    for (uint64_t seed = 0; seed < CASES(2000); seed++) {
        const aisle_pace_request request = random_request(seed, 1 + (uint32_t)(seed % 3));
        const aisle_status st = run(&request, &out);
        TEST_ASSERT_EQUAL_INT(pace.level == AISLE_PACE_STOP ? AISLE_PARTIAL : AISLE_OK, st);
        levels[pace.level]++;
        if (st == AISLE_OK) {
            const real slack = slack_of(&out, request.v, request.lease);
            TEST_ASSERT_TRUE(slack > 0.0L);
            tight += slack < 0.3L ? 1U : 0U;
        }
    }
    TEST_ASSERT_GREATER_THAN_UINT32(CASES(300), levels[0]);
    TEST_ASSERT_GREATER_THAN_UINT32(CASES(300), levels[AISLE_PACE_STOP]);
    TEST_ASSERT_GREATER_THAN_UINT32(CASES(100), levels[1] + levels[2] + levels[3] + levels[4] + levels[5] + levels[6]);
    TEST_ASSERT_GREATER_THAN_UINT32(CASES(100), tight);
}

// The fastest levels that brute force finds safe: at[0] at all, at[1] with so much to spare.
static void brute_levels(const aisle_pace_request *request, real spare, uint32_t at[2]) {
    aisle_pace_request alone = *request;
    const aisle_movers none = {.mover = mover};
    alone.movers = &none;
    at[0] = at[1] = AISLE_PACE_STOP;
    for (uint32_t level = 0; level < AISLE_PACE_STOP && at[1] == AISLE_PACE_STOP; level++) {
        alone.first = level;
        TEST_ASSERT_EQUAL_INT(AISLE_OK, run(&alone, &other));
        const real slack = slack_of(&other, request->v, request->lease);
        at[0] = at[0] == AISLE_PACE_STOP && slack > 0.0L ? level : at[0];
        at[1] = slack > spare ? level : at[1];
    }
}

static void test_it_takes_the_fastest_level_that_brute_force_allows(void) {
    uint32_t same = 0, cases = 0;
    for (uint64_t seed = 5000; seed < 5000 + CASES(300); seed++) {
        const aisle_pace_request request = random_request(seed, 2);
        (void)run(&request, &out);
        const uint32_t taken = pace.level;
        uint32_t brute[2];
        // Its spare is 1 cm and 20 ms, places are some 3 cm apart: never slower than with 10 cm and 0.2 s more, and the
        // same as brute force in most cases.
        brute_levels(&request, 0.1L + 0.2L * 2.0L, brute);
        TEST_ASSERT_TRUE(taken >= brute[0] && taken <= brute[1]);
        same += taken == brute[0] ? 1U : 0U;
        cases++;
    }
    TEST_ASSERT_GREATER_THAN_UINT32(cases * 9U / 10U, same);
}

// ---- what comes out is a path

static void prove(const aisle_path_msg *made, const aisle_verify_base *base, double v) {
    static aisle_path_msg copy, decoded;
    static uint8_t bytes[65536];
    static aisle_verify verify;
    size_t size = 0;
    uint32_t spent = 0;
    aisle_stamp stamp;
    memcpy(&copy, made, sizeof copy);
    copy.status = AISLE_PATH_PARTIAL;
    copy.map_id = 3;
    copy.map_revision = 5;
    copy.vehicle_revision = vehicle.revision;
    TEST_ASSERT_EQUAL_INT(AISLE_OK, aisle_path_encode(&copy, bytes, sizeof bytes, &size));
    const aisle_waypoint_msg *w = made->waypoints;
    const aisle_verify_request request = {.layout = &hall,
                                          .vehicle = &vehicle,
                                          .bytes = bytes,
                                          .size = size,
                                          .start = {w[0].x, w[0].y, w[0].theta},
                                          .v_start = v,
                                          .base = base};
    aisle_verify_start(&verify, &request, &decoded);
    aisle_status st;
    do {
        st = aisle_verify_step(&verify, 10000, &spent, &stamp);
    } while (st == AISLE_BUSY);
    TEST_ASSERT_EQUAL_INT_MESSAGE(AISLE_VERIFY_NONE, verify.fault, "the proof finds a fault");
    TEST_ASSERT_EQUAL_INT(AISLE_OK, st);
}

// The proof knows of no rest but goals'.
static aisle_pace_request random_request_without_rests(uint64_t seed) {
    aisle_pace_request request = random_request(seed, 0);
    memset(dwell, 0, sizeof dwell);
    fill_way();
    return request;
}

static void test_its_paths_are_proved_at_every_level(void) {
    for (uint64_t seed = 0; seed < CASES(250); seed++) {
        aisle_pace_request request = random_request_without_rests(seed);
        for (request.first = 0; request.first < AISLE_PACE_LEVELS; request.first++) {
            (void)run(&request, &out);
            TEST_ASSERT_EQUAL_UINT32(request.first, pace.level);
            prove(&out, NULL, request.v);
            const aisle_waypoint_msg *w = out.waypoints;
            const aisle_pose2 at = aisle_motion_pose(path, count, request.at);
            TEST_ASSERT_DOUBLE_WITHIN(3e-6, 0.0, hypot(at.x - w[0].x, at.y - w[0].y));
            TEST_ASSERT_EQUAL_INT(0, out.num_base);
        }
    }
}

// The moving proof, by an author of its own, of a path that was taken.
static aisle_status prove_moving(const aisle_path_msg *made, double v, double lease) {
    static aisle_path_msg copy;
    static uint8_t bytes[65536];
    static aisle_verify_moving moving;
    size_t size = 0;
    uint32_t spent = 0;
    aisle_moving_stamp stamp;
    memcpy(&copy, made, sizeof copy);
    copy.status = AISLE_PATH_PARTIAL;
    TEST_ASSERT_EQUAL_INT(AISLE_OK, aisle_path_encode(&copy, bytes, sizeof bytes, &size));
    const aisle_moving_request request = {.vehicle = &vehicle,
                                          .movers = &movers,
                                          .bytes = bytes,
                                          .size = size,
                                          .path = &copy,
                                          .at_piece = made->num_waypoints > 1 ? 1U : 0U,
                                          .v = v,
                                          .now_us = NOW,
                                          .lease = lease};
    aisle_verify_moving_start(&moving, &request);
    aisle_status st;
    do {
        st = aisle_verify_moving_step(&moving, 10000, &spent, &stamp);
    } while (st == AISLE_BUSY);
    TEST_ASSERT_FALSE(moving.is_unfit);
    return st;
}

static void test_what_it_takes_is_proved_for_1500_of_1500_cases(void) {
    uint32_t taken = 0, agreed = 0, slower = 0;
    for (uint64_t seed = 10000; seed < 10000 + CASES(1500); seed++) {
        aisle_pace_request request = random_request(seed, 1 + (uint32_t)(seed % 3));
        memset(dwell, 0, sizeof dwell);
        fill_way();
        if (run(&request, &out) == AISLE_OK) {
            taken++;
            TEST_ASSERT_EQUAL_INT(AISLE_OK, prove_moving(&out, request.v, request.lease));
        }
        if (pace.level > 0) { // is the level before it refused by the proof, too?
            const uint32_t level = pace.level;
            const aisle_movers none = {.mover = mover};
            request.movers = &none;
            request.first = level - 1U;
            TEST_ASSERT_EQUAL_INT(AISLE_OK, run(&request, &other));
            slower++;
            agreed += prove_moving(&other, request.v, request.lease) == AISLE_ERR_DATA ? 1U : 0U;
        }
    }
    TEST_ASSERT_GREATER_THAN_UINT32(CASES(500), taken);
    TEST_ASSERT_GREATER_THAN_UINT32(CASES(500), slower);
    TEST_ASSERT_GREATER_THAN_UINT32(slower * 9U / 10U, agreed);
}

// What is under way on `out`, whose waypoints are first copied away.
static aisle_waypoint_msg under_way[AISLE_PATH_MAX_WAYPOINTS];
static float under_way_dwell[AISLE_PATH_MAX_WAYPOINTS];

static aisle_verify_base base_at(double after, double *v, aisle_place *at) {
    const uint32_t n = (uint32_t)(uint16_t)out.num_waypoints;
    memcpy(under_way, out.waypoints, sizeof under_way);
    memcpy(under_way_dwell, pace.dwell, sizeof under_way_dwell);
    *at = aisle_motion_at_time(&vehicle, under_way, n, under_way_dwell, after);
    if (n > 1 && at->piece > 1 && at->u <= 0.0) {
        *at = (aisle_place){at->piece - 1, 1.0};
    }
    *v = aisle_motion_speed(&vehicle, under_way, n, under_way_dwell, *at);
    const aisle_place rest =
        aisle_motion_rest(&vehicle, under_way, n, under_way_dwell, *at, *v, vehicle.reaction_time + 0.1);
    return (aisle_verify_base){.w = under_way,
                               .n = n,
                               .dwell = under_way_dwell,
                               .piece = at->piece,
                               .u = at->u,
                               .reach = aisle_motion_length_to(under_way, n, rest) -
                                        aisle_motion_length_to(under_way, n, *at),
                               .turn = n > 1 && at->u > 0.0 && at->u < 1.0 && spot(under_way, at->piece)};
}

static void test_paths_under_way_are_taken_over_on_their_base_however_the_level_changes(void) {
    uint32_t moving = 0, faster = 0;
    for (uint64_t seed = 0; seed < CASES(150); seed++) {
        aisle_rng rng = aisle_rng_seed(seed + 99U);
        aisle_pace_request request = random_request_without_rests(seed);
        request.first = aisle_rng_below(&rng, AISLE_PACE_LEVELS);
        (void)run(&request, &out);
        for (int i = 0; i < 8; i++) {
            double v;
            aisle_place at;
            const double after = uniform(&rng, 0.05, 0.6);
            const aisle_verify_base base = base_at(after, &v, &at);
            const uint32_t n = base.n;
            const aisle_pose2 pose = aisle_motion_pose(under_way, n, at);
            const double made = aisle_motion_length_to(under_way, n, at);
            aisle_off off;
            const double before = aisle_motion_length_to(path, count, request.at);
            request.at = aisle_motion_project(path, count, request.at, 0.0, made + 0.01, pose, &off);
            if (off.lateral > 1e-6 || fabs(off.heading) > 1e-6 ||
                fabs(aisle_motion_length_to(path, count, request.at) - before - made) > 1e-6) {
                break; // back over its own track within the window
            }
            if (v > 0.0 && v < AISLE_PACE_RESTING) {
                break; // so slow is at rest, and nothing is under way then
            }
            request.v = v;
            request.base = &base;
            request.first = aisle_rng_below(&rng, AISLE_PACE_LEVELS);
            const uint32_t slower = pace.level;
            const aisle_status st = run(&request, &out);
            TEST_ASSERT_TRUE(st == AISLE_OK || st == AISLE_PARTIAL);
            prove(&out, &base, v);
            moving += v > 0.0 ? 1U : 0U;
            faster += v > 0.0 && pace.level < slower ? 1U : 0U;
        }
        request.base = NULL;
    }
    TEST_ASSERT_GREATER_THAN_UINT32(CASES(400), moving);
    TEST_ASSERT_GREATER_THAN_UINT32(CASES(100), faster);
}

// Its pose may still tell a rate of turning, so that something is under way, and what that has left is as good as rest.
static void test_one_nearly_at_rest_before_the_end_of_what_is_under_way_goes_on_or_rests_there(void) {
    uint32_t looked = 0;
    for (uint64_t seed = 0; seed < CASES(400); seed++) {
        aisle_pace_request request = random_request_without_rests(seed);
        request.first = AISLE_PACE_STOP;
        if (run(&request, &out) != AISLE_PARTIAL || out.num_waypoints < 2) {
            continue;
        }
        double v;
        aisle_place at;
        const aisle_verify_base base = base_at((double)out.duration * (1.0 - 0.0005 * (double)seed), &v, &at);
        request.at = aisle_motion_advance(path, count, request.at, aisle_motion_length_to(under_way, base.n, at));
        request.base = &base;
        request.v = 0.005;
        request.first = (uint32_t)(seed % AISLE_PACE_STOP);
        const aisle_status st = run(&request, &out);
        TEST_ASSERT_TRUE(st == AISLE_OK || st == AISLE_PARTIAL);
        request.base = NULL;
        looked++;
    }
    TEST_ASSERT_GREATER_THAN_UINT32(CASES(100), looked);
}

static void test_from_a_stop_it_gets_up_to_speed_though_each_path_keeps_the_base_of_the_one_before(void) {
    (void)add(0.0, 0.0, 0.0);
    add_line(60.0, 2.0);
    fill_way();
    aisle_pace_request request = request_at((aisle_place){1, 0.0}, 0.0);
    (void)run(&request, &out);
    double x = 0.0, v = 0.0;
    for (int i = 0; i < 20; i++) { // a new path every 0.3 s, the slow ones first
        aisle_place at;
        const aisle_verify_base base = base_at(0.3, &v, &at);
        x += aisle_motion_length_to(under_way, base.n, at);
        request.at = aisle_motion_advance(path, count, (aisle_place){1, 0.0}, x);
        request.v = v;
        request.base = &base;
        request.first = i < 5 ? 5 : 0;
        (void)run(&request, &out);
        TEST_ASSERT_TRUE(i < 2 || i >= 5 || v <= 0.17 * 1.5 + 1e-6);
        prove(&out, &base, v);
    }
    TEST_ASSERT_DOUBLE_WITHIN(1e-3, 1.5, v); // 0.25 m/s, then 4.5 s at 0.5 m/s2 at most
}

// ---- levels

static void test_caps_fall_from_level_to_level(void) {
    TEST_ASSERT_TRUE(aisle_pace_cap(&vehicle, 0) > 1e9);
    for (uint32_t level = 1; level < AISLE_PACE_LEVELS; level++) {
        TEST_ASSERT_TRUE(aisle_pace_cap(&vehicle, level) < aisle_pace_cap(&vehicle, level - 1));
    }
    TEST_ASSERT_TRUE(aisle_pace_cap(&vehicle, AISLE_PACE_STOP) <= 0.0);
}

static void test_a_capped_path_is_slow_as_far_as_the_lease_reaches_and_fast_behind(void) {
    (void)add(0.0, 0.0, 0.0);
    add_line(40.0, 1.0);
    fill_way();
    aisle_pace_request request = request_at((aisle_place){10, 0.5}, 1.5);
    request.first = 3; // 0.525 m/s
    TEST_ASSERT_EQUAL_INT(AISLE_OK, run(&request, &out));
    double fastest = 0.0;
    for (int16_t i = 0; i < out.num_waypoints; i++) {
        const double s = (double)out.waypoints[i].s, v = (double)out.waypoints[i].v;
        const double braked = sqrt(fmax(2.25 - s, 0.0));
        TEST_ASSERT_TRUE(s > 1.974 + 1.4 * 0.525 + 0.276 || v <= fmax(braked, 0.525) + 1e-5);
        fastest = s > 10.0 ? fmax(fastest, v) : fastest;
    }
    TEST_ASSERT_DOUBLE_WITHIN(1e-3, 1.5, fastest);
}

static void test_a_stop_ends_where_the_brakes_end_it(void) {
    (void)add(0.0, 0.0, 0.0);
    add_line(40.0, 1.0);
    fill_way();
    aisle_pace_request request = request_at((aisle_place){10, 0.5}, 1.5);
    request.first = AISLE_PACE_STOP;
    TEST_ASSERT_EQUAL_INT(AISLE_PARTIAL, run(&request, &out));
    TEST_ASSERT_FLOAT_WITHIN(1e-4F, 0.15F + 2.25F, out.length);
    TEST_ASSERT_FLOAT_WITHIN(1e-3F, 0.1F + 3.0F, out.duration);
    TEST_ASSERT_DOUBLE_WITHIN(1e-4, 9.5 + 2.4, out.waypoints[out.num_waypoints - 1].x);
    request.v = 0.0;
    TEST_ASSERT_EQUAL_INT(AISLE_PARTIAL, run(&request, &out));
    TEST_ASSERT_EQUAL_INT(1, out.num_waypoints);
}

static void test_a_turn_that_is_stopped_ends_within_the_turn(void) {
    set_flag(add(0.0, 0.0, 0.0), AISLE_WAYPOINT_TURN_IN_PLACE | AISLE_WAYPOINT_STOP);
    (void)add(0.0, 0.0, 3.0);
    (void)add(-1.0, 0.0, 3.0);
    fill_way();
    set_flag(&path[1],
             AISLE_WAYPOINT_STOP | AISLE_WAYPOINT_GOAL); // which it is not to be told to be at, half way there
    path[1].goal_id = 7;
    aisle_pace_request request = request_at((aisle_place){1, 0.5}, 0.0); // 1 rad/s
    request.first = AISLE_PACE_STOP;
    TEST_ASSERT_EQUAL_INT(AISLE_PARTIAL, run(&request, &out));
    TEST_ASSERT_EQUAL_INT(2, out.num_waypoints);
    TEST_ASSERT_DOUBLE_WITHIN(1e-3, 1.5 + 0.1 + 0.5, out.waypoints[1].theta);
    TEST_ASSERT_EQUAL_INT16(0, out.waypoints[1].flags & AISLE_WAYPOINT_GOAL);
    TEST_ASSERT_EQUAL_INT32(0, out.waypoints[1].goal_id);
    prove(&out, NULL, 0.0);
}

static void test_one_that_has_not_quite_come_to_rest_where_a_turn_begins_goes_on(void) {
    (void)add(0.0, 0.0, 0.0);
    set_flag(add(2.0, 0.0, 0.0), AISLE_WAYPOINT_TURN_IN_PLACE);
    (void)add(2.0, 0.0, 1.5);
    (void)add(2.0, 3.0, 1.5);
    fill_way();
    for (uint32_t level = 0; level < AISLE_PACE_LEVELS; level++) {
        aisle_pace_request request = request_at((aisle_place){1, 1.0}, 0.03); // m/s, of a vehicle that lags behind
        request.first = level;
        TEST_ASSERT_EQUAL_INT(level < AISLE_PACE_STOP ? AISLE_OK : AISLE_PARTIAL, run(&request, &out));
        TEST_ASSERT_TRUE(out.num_waypoints >= 1 && out.waypoints[0].v <= 0.0F);
    }
}

// A long piece with one slow end would be driven slowly all along.
static void test_from_rest_a_slow_level_is_at_its_speed_as_soon_as_it_can_be(void) {
    (void)add(0.0, 0.0, 0.0);
    (void)add(4.0, 0.0, 0.0);
    (void)add(60.0, 0.0, 0.0);
    fill_way();
    for (uint32_t level = 1; level < AISLE_PACE_STOP; level++) {
        aisle_pace_request request = request_at((aisle_place){1, 0.0}, 0.0);
        request.first = level;
        TEST_ASSERT_EQUAL_INT(AISLE_OK, run(&request, &out));
        const double cap = aisle_pace_cap(&vehicle, level), up = cap * cap / (2.0 * vehicle.a_max);
        TEST_ASSERT_TRUE(out.num_waypoints > 2);
        TEST_ASSERT_DOUBLE_WITHIN(1e-4, cap, out.waypoints[1].v);
        TEST_ASSERT_DOUBLE_WITHIN(1e-4, up, out.waypoints[1].s);
        TEST_ASSERT_DOUBLE_WITHIN(2e-3, cap / vehicle.a_max, out.waypoints[1].t);
    }
}

static void test_a_faster_level_than_the_present_one_must_hold_longer(void) {
    (void)add(0.0, 0.0, 0.0);
    add_line(60.0, 1.0);
    fill_way();
    uint32_t held_back = 0;
    for (int i = 0; i < 400; i++) {
        movers.count = 0;
        put_mover(11.0 + 0.02 * i, 0.0, 0.3, 1.0);
        aisle_pace_request request = request_at((aisle_place){10, 0.5}, 0.7);
        request.lease = 0.2;
        (void)run(&request, &out);
        const uint32_t fresh = pace.level;
        request.current = AISLE_PACE_STOP;
        (void)run(&request, &out);
        TEST_ASSERT_TRUE(pace.level >= fresh);
        held_back += pace.level > fresh ? 1U : 0U;
        request.current = pace.level;
        const uint32_t kept = pace.level;
        (void)run(&request, &out);
        TEST_ASSERT_TRUE(pace.level <= kept); // and what is under way is not taken back by it
    }
    TEST_ASSERT_GREATER_THAN_UINT32(5, held_back);
    TEST_ASSERT_LESS_THAN_UINT32(100, held_back);
}

static void test_it_names_the_mover_that_slows_it_and_none_if_none_does(void) {
    (void)add(0.0, 0.0, 0.0);
    add_line(60.0, 1.0);
    fill_way();
    put_mover(30.0, 30.0, 0.3, 1.0);
    put_mover(13.5, 0.0, 0.3, 0.5);
    put_mover(9.5, -8.0, 0.3, 0.5);
    const aisle_pace_request request = request_at((aisle_place){10, 0.5}, 0.5);
    (void)run(&request, &out);
    TEST_ASSERT_TRUE(pace.level > 0 && pace.limit.is_known);
    TEST_ASSERT_EQUAL_INT32(101, pace.limit.id);
    TEST_ASSERT_EQUAL_UINT8(1, pace.limit.source);
    TEST_ASSERT_TRUE(pace.limit.place.x > 9.4 && pace.limit.place.x < 13.5 && pace.limit.time > 0.0);
    movers.count = 1;
    (void)run(&request, &out);
    TEST_ASSERT_TRUE(pace.level == 0 && !pace.limit.is_known);
}

static void test_a_vehicle_at_rest_beside_a_mover_stays_whatever_is_left_of_its_wait(void) {
    (void)add(0.0, 0.0, 0.0);
    add_line(10.0, 1.0);
    dwell[0] = 4.0F;
    fill_way();
    put_mover(0.9, 0.0, 0.3, 1.0);
    aisle_pace_request request = request_at((aisle_place){1, 0.0}, 0.0);
    TEST_ASSERT_EQUAL_INT(AISLE_PARTIAL, run(&request, &out)); // of (1, 0) the rest is behind
    TEST_ASSERT_EQUAL_INT(1, out.num_waypoints);
    set_flag(&path[5], AISLE_WAYPOINT_STOP | AISLE_WAYPOINT_GOAL);
    dwell[5] = 4.0F;
    fill_way();
    movers.count = 0;
    put_mover(5.9, 0.0, 0.3, 1.0);
    request.at = (aisle_place){5, 1.0};
    TEST_ASSERT_EQUAL_INT(AISLE_PARTIAL, run(&request, &out));
    TEST_ASSERT_EQUAL_INT(1, out.num_waypoints);
    movers.count = 0;
    put_mover(-9.0, 0.0, 0.3, 1.0);
    TEST_ASSERT_EQUAL_INT(AISLE_OK, run(&request, &out));
    TEST_ASSERT_EQUAL_UINT32(0, pace.level);
}

// ---- the manner of working

static void test_any_slicing_gives_the_same_path_and_units(void) {
    for (uint64_t seed = 300; seed < 300 + CASES(30); seed++) {
        const aisle_pace_request request = random_request(seed, 3);
        uint32_t spent = 0, sliced = 0;
        aisle_pace_start(&pace, &request, &out);
        const aisle_status whole = aisle_pace_step(&pace, UINT32_MAX, &spent);
        const uint32_t level = pace.level;
        aisle_pace_start(&pace, &request, &other);
        aisle_status st;
        while ((st = aisle_pace_step(&pace, 1, &sliced)) == AISLE_BUSY) {
        }
        TEST_ASSERT_EQUAL_INT(whole, st);
        TEST_ASSERT_EQUAL_UINT32(level, pace.level);
        TEST_ASSERT_EQUAL_UINT32(spent, sliced);
        TEST_ASSERT_EQUAL_INT(out.num_waypoints, other.num_waypoints);
        TEST_ASSERT_EQUAL_MEMORY(out.waypoints, other.waypoints,
                                 sizeof out.waypoints[0] * (size_t)(uint16_t)out.num_waypoints);
        TEST_ASSERT_EQUAL_INT(whole, aisle_pace_step(&pace, 100, &sliced));
        TEST_ASSERT_EQUAL_UINT32(spent, sliced);
    }
}

static void test_without_room_for_a_change_of_speed_it_says_so(void) {
    (void)add(0.0, 0.0, 0.0);
    for (uint32_t i = 1; i < AISLE_PATH_MAX_WAYPOINTS; i++) {
        (void)add(0.05 * i, 0.0, 0.0);
    }
    fill_way();
    aisle_pace_request request = request_at((aisle_place){1, 0.0}, 0.0);
    request.first = 3;
    TEST_ASSERT_EQUAL_INT(AISLE_OK, run(&request, &out)); // from rest none is needed
    TEST_ASSERT_EQUAL_INT(AISLE_PATH_MAX_WAYPOINTS, out.num_waypoints);
    request.at = (aisle_place){1, 0.5};
    request.v = aisle_motion_speed(&vehicle, path, count, dwell, request.at);
    request.first = AISLE_PACE_STOP;
    TEST_ASSERT_EQUAL_INT(AISLE_ERR_CAPACITY, run(&request, &out));
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_what_it_takes_is_safe_for_2000_of_2000_cases);
    RUN_TEST(test_it_takes_the_fastest_level_that_brute_force_allows);
    RUN_TEST(test_its_paths_are_proved_at_every_level);
    RUN_TEST(test_what_it_takes_is_proved_for_1500_of_1500_cases);
    RUN_TEST(test_paths_under_way_are_taken_over_on_their_base_however_the_level_changes);
    RUN_TEST(test_one_nearly_at_rest_before_the_end_of_what_is_under_way_goes_on_or_rests_there);
    RUN_TEST(test_from_a_stop_it_gets_up_to_speed_though_each_path_keeps_the_base_of_the_one_before);
    RUN_TEST(test_caps_fall_from_level_to_level);
    RUN_TEST(test_a_capped_path_is_slow_as_far_as_the_lease_reaches_and_fast_behind);
    RUN_TEST(test_a_stop_ends_where_the_brakes_end_it);
    RUN_TEST(test_a_turn_that_is_stopped_ends_within_the_turn);
    RUN_TEST(test_one_that_has_not_quite_come_to_rest_where_a_turn_begins_goes_on);
    RUN_TEST(test_from_rest_a_slow_level_is_at_its_speed_as_soon_as_it_can_be);
    RUN_TEST(test_a_faster_level_than_the_present_one_must_hold_longer);
    RUN_TEST(test_it_names_the_mover_that_slows_it_and_none_if_none_does);
    RUN_TEST(test_a_vehicle_at_rest_beside_a_mover_stays_whatever_is_left_of_its_wait);
    RUN_TEST(test_any_slicing_gives_the_same_path_and_units);
    RUN_TEST(test_without_room_for_a_change_of_speed_it_says_so);
    return UNITY_END();
}
