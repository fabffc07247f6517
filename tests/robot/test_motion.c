#include "robot/motion.h" // first: proves that the header stands alone

#include "base/angle.h"
#include "base/rng.h"
#include "cases.h"
#include "motion_oracle.h"
#include "robot/profile.h"
#include "unity.h"

#include <string.h>

enum { SEEDS = CASES(120) };

static aisle_waypoint_msg rest[CAPACITY + AISLE_MOTION_CUT_EXTRA + 1];
static uint32_t left; // waypoints in rest
static aisle_profile_sum sum;

void setUp(void) {
    static const aisle_vehicle_msg usual;
    set_vehicle(&usual);
    memset(path, 0xA5, sizeof path);
    memset(rest, 0xA5, sizeof rest);
    memset(dwell, 0, sizeof dwell);
    count = 0;
}
void tearDown(void) {
    static uint8_t untouched[sizeof *rest];
    memset(untouched, 0xA5, sizeof untouched);
    TEST_ASSERT_EQUAL_MEMORY(untouched, &rest[CAPACITY + AISLE_MOTION_CUT_EXTRA], sizeof untouched);
    TEST_ASSERT_EQUAL_MEMORY(untouched, &path[CAPACITY], sizeof untouched);
}

static void fill(void) {
    TEST_ASSERT_EQUAL_INT(AISLE_OK, aisle_profile_fill(&vehicle, NULL, path, count, dwell, &sum));
}

static void make_random(uint64_t seed) {
    setUp();
    if (seed % 2 == 1) {
        random_vehicle(seed);
    }
    random_path(seed, 2 + (uint32_t)seed);
    if (seed % 3 == 1) { // waits that last
        for (uint32_t i = 0; i < count; i++) {
            dwell[i] = i + 1 < count && (path[i].flags & AISLE_WAYPOINT_TURN_IN_PLACE) != 0 ? 1.5F : dwell[i];
        }
    }
    fill();
}

static aisle_place random_place(aisle_rng *rng) {
    const uint32_t piece = 1 + aisle_rng_below(rng, count - 1);
    const uint32_t what = aisle_rng_below(rng, 8);
    return (aisle_place){piece, what == 0 ? 0.0 : (what == 1 ? 1.0 : uniform(rng, 0.0, 1.0))};
}

// ---- lengths, poses, advancing

static void test_lengths_and_poses_are_those_of_the_curve(void) {
    for (uint64_t seed = 0; seed < SEEDS; seed++) {
        aisle_rng rng = aisle_rng_seed(seed);
        make_random(seed);
        for (int i = 0; i < 60; i++) {
            const aisle_place p = random_place(&rng);
            const aisle_pose2 pose = aisle_motion_pose(path, count, p);
            real wanted[3];
            oracle_pose(path, p, wanted);
            TEST_ASSERT_TRUE(fabsl(wide(aisle_motion_length_to(path, count, p)) - oracle_length(path, p)) <=
                             1e-11L * (1.0L + oracle_length(path, p)));
            TEST_ASSERT_TRUE(hypotl(wide(pose.x) - wanted[0], wide(pose.y) - wanted[1]) < 1e-9L);
            TEST_ASSERT_TRUE(fabsl(remainderl(wide(pose.theta) - wanted[2], 2.0L * acosl(-1.0L))) < 1e-12L);
            TEST_ASSERT_TRUE(pose.theta > -AISLE_PI && pose.theta <= AISLE_PI);
        }
    }
}

static void test_advancing_goes_the_metres_asked_for_or_to_the_end(void) {
    for (uint64_t seed = 0; seed < SEEDS; seed++) {
        aisle_rng rng = aisle_rng_seed(seed);
        make_random(seed);
        const double length = aisle_motion_length_to(path, count, (aisle_place){count - 1, 1.0});
        for (int i = 0; i < 60; i++) {
            const aisle_place p = random_place(&rng);
            const double metres = uniform(&rng, -1.0, 1.0) * (i % 5 == 0 ? 1.5 * length : 0.5);
            const aisle_place q = aisle_motion_advance(path, count, p, metres);
            TEST_ASSERT_TRUE(aisle_place_exists(count, q));
            const double wanted = fmin(fmax(aisle_motion_length_to(path, count, p) + metres, 0.0), length);
            TEST_ASSERT_DOUBLE_WITHIN(1e-10 * (1.0 + length), wanted, aisle_motion_length_to(path, count, q));
        }
    }
}

static void test_advancing_by_nothing_stays_and_turns_at_its_end_are_not_passed(void) {
    (void)add(0.0, 0.0, 0.0);
    (void)add(1.0, 0.0, 0.0);
    set_flag(&path[1], AISLE_WAYPOINT_TURN_IN_PLACE);
    (void)add(1.0, 0.0, 1.0);
    (void)add(1.0 + cos(1.0), sin(1.0), 1.0);
    fill();
    const struct {
        aisle_place from;
        double metres;
        aisle_place to;
    } cases[] = {{{2, 0.25}, 0.0, {2, 0.25}}, {{1, 0.5}, 0.5, {1, 1.0}},  {{1, 0.5}, 0.75, {3, 0.25}},
                 {{3, 0.5}, -0.5, {3, 0.0}},  {{3, 0.5}, -1.0, {1, 0.5}}, {{2, 0.25}, 0.5, {3, 0.5}},
                 {{2, 0.25}, -0.5, {1, 0.5}}, {{1, 0.5}, -9.0, {1, 0.0}}, {{1, 0.5}, 9.0, {3, 1.0}}};
    for (uint32_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const aisle_place q = aisle_motion_advance(path, count, cases[i].from, cases[i].metres);
        TEST_ASSERT_EQUAL_UINT32(cases[i].to.piece, q.piece);
        TEST_ASSERT_DOUBLE_WITHIN(1e-12, cases[i].to.u, q.u);
    }
}

// ---- speeds and times

static void test_speeds_are_what_the_contract_says_on_every_kind_of_piece(void) {
    uint32_t from_rest_to_rest = 0;
    for (uint64_t seed = 0; seed < SEEDS; seed++) {
        aisle_rng rng = aisle_rng_seed(seed);
        make_random(seed);
        for (int i = 0; i < 60; i++) {
            const aisle_place p = random_place(&rng);
            const double v = aisle_motion_speed(&vehicle, path, count, dwell, p);
            const real wanted = spot(path, p.piece) ? 0.0L : oracle_speed(path, dwell, p.piece, wide(p.u));
            TEST_ASSERT_TRUE(fabsl(wide(v) - wanted) <= 1e-6L + 2e-3L * wanted);
            const bool moves = path[p.piece - 1].v > 1e-6F || path[p.piece].v > 1e-6F;
            TEST_ASSERT_TRUE(!moves || fabsl(wide(v) - wanted) <= 1e-9L);
            from_rest_to_rest += !moves && !spot(path, p.piece) ? 1U : 0U;
        }
    }
    TEST_ASSERT_GREATER_THAN_UINT32(CASES(100), from_rest_to_rest);
}

// Time from u0 to u1 of piece i: the integral of du way / v, by the midpoints of v^2 steps fine enough for the ends at rest.
static real integrate(uint32_t i, real u0, real u1) {
    const int steps = 4000;
    real time = 0.0L;
    for (int k = 0; k < steps; k++) { // u = u0 + (u1 - u0) (3 x^2 - 2 x^3): dense at both ends
        const real x = ((real)k + 0.5L) / (real)steps, u = u0 + (u1 - u0) * x * x * (3.0L - 2.0L * x);
        const real v = oracle_speed(path, dwell, i, u);
        time += (u1 - u0) * 6.0L * x * (1.0L - x) / (real)steps * way_of(path, i) / v;
    }
    return time;
}

static void test_times_are_the_integral_of_the_speeds(void) {
    for (uint64_t seed = 0; seed < CASES(40); seed++) {
        aisle_rng rng = aisle_rng_seed(seed);
        make_random(seed);
        for (int k = 0; k < 12; k++) {
            const aisle_place p = random_place(&rng);
            const double t = aisle_motion_time(&vehicle, path, count, dwell, p);
            real moves;
            const real rests = oracle_rest(path, dwell, p.piece, &moves);
            const real done =
                waits(path, p.piece) ? wide(p.u) * moves : (p.u > 0.0 ? integrate(p.piece, 0.0L, wide(p.u)) : 0.0L);
            const real wanted = p.u >= 1.0 ? (real)path[p.piece].t : (real)path[p.piece - 1].t + rests + done;
            TEST_ASSERT_TRUE(fabsl(wide(t) - wanted) < 1.2e-3L + 1e-3L * done); // pieces last 1 ms at least
            TEST_ASSERT_TRUE(moves < 0.02L || fabsl(wide(t) - wanted) < 2e-5L + 1e-3L * done);
        }
    }
}

static void test_time_rises_along_the_path_and_meets_every_waypoint(void) {
    for (uint64_t seed = 0; seed < SEEDS; seed++) {
        make_random(seed);
        double before = -1.0;
        for (uint32_t i = 1; i < count; i++) {
            for (int k = 0; k <= 16; k++) {
                const double t = aisle_motion_time(&vehicle, path, count, dwell, (aisle_place){i, k / 16.0});
                TEST_ASSERT_TRUE(k == 0 ? t >= before : t > before);
                before = t;
            }
            TEST_ASSERT_DOUBLE_WITHIN(0.0, (double)path[i].t, before);
        }
    }
}

static void test_place_at_a_time_is_the_inverse_of_the_time_at_a_place(void) {
    for (uint64_t seed = 0; seed < SEEDS; seed++) {
        aisle_rng rng = aisle_rng_seed(seed);
        make_random(seed);
        for (int i = 0; i < 100; i++) {
            const double t = uniform(&rng, 0.0, (double)path[count - 1].t);
            const aisle_place p = aisle_motion_at_time(&vehicle, path, count, dwell, t);
            TEST_ASSERT_TRUE(aisle_place_exists(count, p));
            const double there = aisle_motion_time(&vehicle, path, count, dwell, p);
            const bool rests = p.u >= 1.0 && p.piece + 1 < count &&
                               t <= aisle_motion_time(&vehicle, path, count, dwell, (aisle_place){p.piece + 1, 0.0});
            const bool begins = p.piece == 1 && p.u <= 0.0; // or rests at the first one
            TEST_ASSERT_TRUE(rests ? there <= t + 1e-9 : (begins ? there >= t : fabs(there - t) < 1e-7));
        }
        for (int i = 0; i < 100; i++) {
            const aisle_place p = random_place(&rng);
            const double t = aisle_motion_time(&vehicle, path, count, dwell, p);
            const aisle_place q = aisle_motion_at_time(&vehicle, path, count, dwell, t);
            const double gone = oracle_speed(path, dwell, p.piece, wide(p.u)) > 0.01L ? 1e-9 : 1e-6;
            TEST_ASSERT_DOUBLE_WITHIN(gone * 10.0, aisle_motion_length_to(path, count, p),
                                      aisle_motion_length_to(path, count, q));
        }
    }
}

static void test_times_before_and_behind_the_path_give_its_ends(void) {
    make_random(7);
    aisle_place p = aisle_motion_at_time(&vehicle, path, count, dwell, -5.0);
    TEST_ASSERT_TRUE(p.piece == 1 && p.u <= 0.0);
    p = aisle_motion_at_time(&vehicle, path, count, dwell, (double)path[count - 1].t + 1.0);
    TEST_ASSERT_TRUE(p.piece == count - 1 && p.u >= 1.0);
}

static void test_a_rest_before_moving_on_is_told_apart_without_being_told(void) {
    (void)add(0.0, 0.0, 0.0);
    add_line(1.0, 0.5);
    set_flag(&path[2], AISLE_WAYPOINT_TURN_IN_PLACE | AISLE_WAYPOINT_STOP | AISLE_WAYPOINT_GOAL);
    (void)add(1.0, 0.0, 1.0);
    set_flag(&path[3], AISLE_WAYPOINT_STOP | AISLE_WAYPOINT_GOAL);
    (void)add(1.0 + 0.5 * cos(1.0), 0.5 * sin(1.0), 1.0);
    (void)add(1.0 + cos(1.0), sin(1.0), 1.0);
    dwell[2] = 3.0F;
    dwell[3] = 4.0F;
    fill();
    for (uint32_t i = 2; i <= 3; i++) {
        const aisle_place leaves = {i + 1, 0.0};
        const double told = aisle_motion_time(&vehicle, path, count, dwell, leaves);
        TEST_ASSERT_DOUBLE_WITHIN(1.1e-3, (double)path[i].t + (double)dwell[i], told);
        TEST_ASSERT_DOUBLE_WITHIN(1e-12, told, aisle_motion_time(&vehicle, path, count, NULL, leaves));
        const aisle_place p = aisle_motion_at_time(&vehicle, path, count, NULL, (double)path[i].t + 2.9);
        TEST_ASSERT_TRUE(p.piece == i && p.u >= 1.0);
    }
}

static void test_a_rest_before_a_piece_from_rest_to_rest_is_told_by_dwell_alone(void) {
    (void)add(0.0, 0.0, 0.0);
    (void)add(1.0, 0.0, 0.0);
    dwell[0] = 5.0F;
    fill();
    const aisle_place middle = {1, 0.5};
    TEST_ASSERT_DOUBLE_WITHIN(1e-3, sqrt(0.5), aisle_motion_speed(&vehicle, path, count, dwell, middle));
    TEST_ASSERT_DOUBLE_WITHIN(1e-3, 5.0 + sqrt(2.0), aisle_motion_time(&vehicle, path, count, dwell, middle));
    TEST_ASSERT_TRUE(aisle_motion_speed(&vehicle, path, count, NULL, middle) < 0.15); // fills its 7.8 s
}

static void test_a_dwell_that_does_not_fit_leaves_the_motion_its_least_time(void) { // goals change under a path
    (void)add(0.0, 0.0, 0.0);
    (void)add(1.0, 0.0, 0.0);
    fill();
    dwell[0] = 100.0F;
    TEST_ASSERT_DOUBLE_WITHIN(1e-3, sqrt(0.5), aisle_motion_speed(&vehicle, path, count, dwell, (aisle_place){1, 0.5}));
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, 0.0, aisle_motion_time(&vehicle, path, count, dwell, (aisle_place){1, 0.0}));
}

static void test_a_path_of_one_waypoint_has_one_place(void) {
    (void)add(1.0, 2.0, 3.0);
    fill();
    const aisle_place only = {0, 0.0};
    TEST_ASSERT_TRUE(aisle_place_exists(1, only));
    TEST_ASSERT_FALSE(aisle_place_exists(1, (aisle_place){1, 0.0}));
    TEST_ASSERT_FALSE(aisle_place_exists(3, (aisle_place){0, 0.0}));
    TEST_ASSERT_FALSE(aisle_place_exists(3, (aisle_place){3, 0.0}));
    TEST_ASSERT_FALSE(aisle_place_exists(3, (aisle_place){2, 1.5}));
    TEST_ASSERT_FALSE(aisle_place_exists(3, (aisle_place){2, (double)NAN}));
    const aisle_pose2 pose = {1.5, 2.0, 2.5};
    aisle_off off;
    TEST_ASSERT_EQUAL_UINT32(0, aisle_motion_project(path, 1, only, 1.0, 1.0, pose, &off).piece);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0.5, off.lateral);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, -0.5, off.heading);
    TEST_ASSERT_EQUAL_UINT32(0, aisle_motion_at_time(&vehicle, path, 1, NULL, 3.0).piece);
    TEST_ASSERT_EQUAL_UINT32(0, aisle_motion_rest(&vehicle, path, 1, NULL, only, 1.0, 1.0).piece);
    TEST_ASSERT_EQUAL_UINT32(1, aisle_motion_cut(&vehicle, path, 1, NULL, only, rest, 1));
    TEST_ASSERT_DOUBLE_WITHIN(0.0, 0.0, aisle_motion_time(&vehicle, path, 1, NULL, only));
    TEST_ASSERT_DOUBLE_WITHIN(0.0, 0.0, aisle_motion_speed(&vehicle, path, 1, NULL, only));
    TEST_ASSERT_DOUBLE_WITHIN(0.0, 0.0, aisle_motion_length_to(path, 1, only));
    TEST_ASSERT_DOUBLE_WITHIN(0.0, 1.0, aisle_motion_pose(path, 1, only).x);
}

// ---- projection

static bool reverses_between(aisle_place a, aisle_place b) {
    for (uint32_t i = a.piece; i < b.piece; i++) {
        if (((path[i].flags ^ path[i + 1].flags) & AISLE_WAYPOINT_REVERSE) != 0) {
            return true;
        }
    }
    return false;
}

static void test_a_pose_on_the_path_is_found_again(void) {
    uint32_t looked = 0;
    for (uint64_t seed = 0; seed < SEEDS; seed++) {
        aisle_rng rng = aisle_rng_seed(seed);
        make_random(seed);
        for (int i = 0; i < 60; i++) {
            const aisle_place p = random_place(&rng);
            const aisle_place from = aisle_motion_advance(path, count, p, uniform(&rng, -0.2, 0.0));
            const aisle_pose2 pose = aisle_motion_pose(path, count, p);
            aisle_off off;
            const aisle_place q = aisle_motion_project(path, count, from, 0.3, 0.5, pose, &off);
            const aisle_pose2 found = aisle_motion_pose(path, count, q);
            TEST_ASSERT_DOUBLE_WITHIN(1e-9, hypot(found.x - pose.x, found.y - pose.y), off.lateral);
            TEST_ASSERT_DOUBLE_WITHIN(
                1e-9, 0.0, aisle_angle_difference(aisle_angle_difference(found.theta, pose.theta), off.heading));
            if (reverses_between(from, p) || reverses_between(p, from) || from.piece > p.piece) {
                continue; // over its own track either branch will do, and a vehicle does not go back
            }
            looked++;
            const double length = aisle_motion_length_to(path, count, p);
            TEST_ASSERT_DOUBLE_WITHIN(1e-6, length, aisle_motion_length_to(path, count, q));
            TEST_ASSERT_TRUE(off.lateral < 1e-6 && fabs(off.heading) < 1e-6);
        }
    }
    TEST_ASSERT_GREATER_THAN_UINT32(CASES(5000), looked);
}

static void test_a_pose_off_a_smooth_path_is_projected_to_its_nearest_place(void) {
    for (uint64_t seed = 0; seed < CASES(40); seed++) {
        aisle_rng rng = aisle_rng_seed(seed);
        setUp();
        (void)add(0.0, 0.0, uniform(&rng, -3.0, 3.0));
        const style gentle = {.piece_max = 0.7, .radius_min = 1.5};
        while (count < 60) {
            add_piece(&rng, &gentle, false);
        }
        fill();
        for (int i = 0; i < 20; i++) {
            const aisle_place p = random_place(&rng);
            const aisle_place from = aisle_motion_advance(path, count, p, uniform(&rng, -0.2, 0.0));
            aisle_pose2 pose = aisle_motion_pose(path, count, p);
            pose.x += uniform(&rng, -0.1, 0.1);
            pose.y += uniform(&rng, -0.1, 0.1);
            aisle_off off;
            (void)aisle_motion_project(path, count, from, 0.3, 0.5, pose, &off);
            double least = 1e9;
            for (int k = 0; k <= 8000; k++) {
                const aisle_pose2 at =
                    aisle_motion_pose(path, count, aisle_motion_advance(path, count, from, -0.3 + 1e-4 * k));
                least = fmin(least, hypot(at.x - pose.x, at.y - pose.y));
            }
            TEST_ASSERT_TRUE(off.lateral <
                             least + 0.04); // of two pieces the better heading may win: 0.1 m turn by 0.07
        }
    }
}

static void test_the_window_bounds_the_place(void) {
    (void)add(0.0, 0.0, 0.0);
    add_line(4.0, 0.5);
    fill();
    for (int i = -20; i <= 60; i++) {
        const aisle_pose2 pose = {2.1 + 0.1 * i, 0.2, 0.0};
        aisle_off off;
        const aisle_place q = aisle_motion_project(path, count, (aisle_place){5, 0.2}, 0.25, 0.75, pose, &off);
        const double wanted = fmin(fmax(pose.x, 1.85), 2.85), x = aisle_motion_pose(path, count, q).x;
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, wanted, x);
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, hypot(pose.x - x, 0.2), off.lateral);
    }
}

static void test_it_is_not_left_for_another_branch_where_the_path_crosses_itself(void) {
    // A loop of radius 0.5 m: the path crosses itself at right angles in (0, 0).
    (void)add(-3.0, 0.0, 0.0);
    (void)add(0.5, 0.0, 0.0);
    const double arc = 1.5 * AISLE_PI / 8.0;
    for (int i = 1; i <= 8; i++) {
        add(0.5 + 0.5 * sin(i * arc), 0.5 - 0.5 * cos(i * arc), aisle_angle_wrap(i * arc))->curvature = 2.0F;
    }
    (void)add(0.0, -3.0, -0.5 * AISLE_PI);
    fill();
    for (int side = -1; side <= 1; side++) {
        for (double x = -1.0; x < 0.5; x += 0.05) {
            const aisle_pose2 pose = {x, 0.08 * side, 0.1 * side};
            const aisle_place from = {1, (x - 0.1 + 3.0) / 3.5};
            const aisle_place q = aisle_motion_project(path, count, from, 0.5, 5.0, pose, NULL);
            TEST_ASSERT_EQUAL_UINT32(1, q.piece);
            TEST_ASSERT_DOUBLE_WITHIN(1e-9, x, -3.0 + 3.5 * q.u);
        }
        for (double y = 0.4; y > -1.0; y -= 0.05) {
            const aisle_pose2 pose = {0.08 * side, y, -0.5 * AISLE_PI + 0.1 * side};
            const aisle_place from = {10, (0.45 - y) / 3.5};
            const aisle_place q = aisle_motion_project(path, count, from, 5.0, 0.5, pose, NULL);
            TEST_ASSERT_EQUAL_UINT32(10, q.piece);
            TEST_ASSERT_DOUBLE_WITHIN(1e-9, y, 0.5 - 3.5 * q.u);
        }
    }
}

// Forwards to x = 2 and back over the very track.
static void make_cusp(void) {
    (void)add(0.0, 0.0, 0.0);
    (void)add(2.0, 0.0, 0.0);
    set_flag(add(0.0, 0.0, 0.0), AISLE_WAYPOINT_REVERSE);
    fill();
}

static void test_a_track_driven_both_ways_is_followed_in_order(void) {
    for (int noise = 0; noise < 5; noise++) {
        setUp();
        make_cusp();
        aisle_rng rng = aisle_rng_seed((uint64_t)noise);
        const double turns_at = 2.0 - 0.03 * noise; // it need not come all the way
        aisle_place furthest = {1, 0.0};
        for (double way = 0.0; way < turns_at + 1.9; way += 0.01) {
            const double x = way < turns_at ? way : 2.0 * turns_at - way;
            const aisle_pose2 pose = {x + uniform(&rng, -0.005, 0.005), uniform(&rng, -0.02, 0.02), 0.0};
            const aisle_place q = aisle_motion_project(path, count, furthest, 0.5, 0.7, pose, NULL);
            if (aisle_motion_length_to(path, count, q) > aisle_motion_length_to(path, count, furthest)) {
                furthest = q;
            }
            TEST_ASSERT_TRUE(way > turns_at || furthest.piece == 1);
            TEST_ASSERT_TRUE(way < turns_at + 0.2 || furthest.piece == 2);
        }
        TEST_ASSERT_DOUBLE_WITHIN(0.05, 2.0 + 1.9 + 0.03 * noise, aisle_motion_length_to(path, count, furthest));
    }
}

static void test_behind_a_high_barrier_nothing_is_looked_at(void) {
    make_cusp();
    const aisle_place from = {1, 0.5}; // a metre before the change of direction; the pose jumps back
    const aisle_place q = aisle_motion_project(path, count, from, 0.5, 3.0, (aisle_pose2){0.55, 0.0, 0.0}, NULL);
    TEST_ASSERT_TRUE(q.piece == 1 && fabs(q.u - 0.275) < 1e-9);
}

static void test_turns_on_the_spot_are_matched_by_heading(void) {
    const double turns[] = {0.5 * AISLE_PI, -3.1, 3.1, 0.3};
    for (int k = 0; k < 4; k++) {
        setUp();
        (void)add(0.0, 0.0, 2.0);
        (void)add(cos(2.0), sin(2.0), 2.0);
        set_flag(&path[1], AISLE_WAYPOINT_TURN_IN_PLACE);
        const double after = 2.0 + turns[k];
        (void)add(path[1].x, path[1].y, aisle_angle_wrap(after));
        (void)add(path[1].x + cos(after), path[1].y + sin(after), aisle_angle_wrap(after));
        fill();
        for (int i = -2; i <= 22; i++) {
            const aisle_pose2 pose = {path[1].x + 0.01, path[1].y - 0.01, aisle_angle_wrap(2.0 + 0.05 * i * turns[k])};
            const aisle_place q = aisle_motion_project(path, count, (aisle_place){2, 0.0}, 0.0, 0.0, pose, NULL);
            const double share = fmin(fmax(0.05 * i, 0.0), 1.0);
            TEST_ASSERT_DOUBLE_WITHIN(1e-6, 0.0, i > 0 && i < 20 ? (double)q.piece - 2.0 + q.u - share : 0.0);
            const aisle_pose2 at = aisle_motion_pose(path, count, q);
            TEST_ASSERT_DOUBLE_WITHIN(1e-9, 0.0, aisle_angle_difference(2.0 + share * turns[k], at.theta));
        }
    }
}

static void test_a_wait_stays_where_it_is_until_the_vehicle_drives_on(void) {
    (void)add(0.0, 0.0, 0.0);
    (void)add(1.0, 0.0, 0.0);
    set_flag(&path[1], AISLE_WAYPOINT_TURN_IN_PLACE | AISLE_WAYPOINT_STOP | AISLE_WAYPOINT_GOAL);
    (void)add(1.0, 0.0, 0.0);
    (void)add(2.0, 0.0, 0.0);
    dwell[1] = 2.0F;
    fill();
    const aisle_place in = {2, 0.6};
    aisle_place q = aisle_motion_project(path, count, in, 0.5, 0.5, (aisle_pose2){1.0, 0.01, 0.0}, NULL);
    TEST_ASSERT_TRUE(q.piece == 2 && q.u <= 0.6 && q.u >= 0.6);
    q = aisle_motion_project(path, count, in, 0.5, 0.5, (aisle_pose2){1.2, 0.0, 0.0}, NULL);
    TEST_ASSERT_TRUE(q.piece == 3 && fabs(q.u - 0.2) < 1e-9);
}

// ---- cutting

static float rest_dwell[CAPACITY + AISLE_MOTION_CUT_EXTRA];

static void cut_at(aisle_place p) {
    left = aisle_motion_cut(&vehicle, path, count, dwell, p, rest, CAPACITY + AISLE_MOTION_CUT_EXTRA);
    TEST_ASSERT_GREATER_THAN_UINT32(0, left);
    TEST_ASSERT_TRUE(left <= count - p.piece + AISLE_MOTION_CUT_EXTRA);
    aisle_motion_cut_dwell(dwell, count, p, left, rest_dwell);
    for (uint32_t i = 0; i < left; i++) {
        const bool is_new = i + count < left + p.piece;
        TEST_ASSERT_EQUAL_FLOAT(is_new ? 0.0F : dwell[i + count - left], rest_dwell[i]);
    }
}

static void test_a_cut_path_is_the_old_one_from_there_on(void) {
    uint32_t trapezoids = 0;
    for (uint64_t seed = 0; seed < SEEDS; seed++) {
        aisle_rng rng = aisle_rng_seed(seed);
        make_random(seed);
        for (int i = 0; i < 30; i++) {
            const aisle_place p = random_place(&rng);
            cut_at(p);
            const double behind = aisle_motion_length_to(path, count, p),
                         all = aisle_motion_length_to(path, count, (aisle_place){count - 1, 1.0});
            const aisle_pose2 at = aisle_motion_pose(path, count, p);
            TEST_ASSERT_DOUBLE_WITHIN(2.1e-6, at.x, rest[0].x);
            TEST_ASSERT_DOUBLE_WITHIN(2.1e-6, at.y, rest[0].y);
            TEST_ASSERT_DOUBLE_WITHIN(1e-4, 0.0, aisle_angle_difference(at.theta, rest[0].theta));
            TEST_ASSERT_DOUBLE_WITHIN(
                2.1e-6, all - behind,
                aisle_motion_length_to(rest, left, (aisle_place){left - 1, left > 1 ? 1.0 : 0.0}));
            trapezoids += left > count - p.piece + 1 ? 1U : 0U;
            for (int k = 0; left > 1 && k < 20; k++) { // places by the length still ahead
                const double ahead = uniform(&rng, 0.0, all - behind);
                const aisle_place old = aisle_motion_advance(path, count, (aisle_place){count - 1, 1.0}, -ahead);
                const aisle_place now = aisle_motion_advance(rest, left, (aisle_place){left - 1, 1.0}, -ahead);
                const aisle_pose2 a = aisle_motion_pose(path, count, old), b = aisle_motion_pose(rest, left, now);
                const bool at_start = all - behind - ahead < 3e-6;
                TEST_ASSERT_DOUBLE_WITHIN(at_start ? 3e-6 : 1e-9, 0.0, hypot(a.x - b.x, a.y - b.y));
                const double v = aisle_motion_speed(&vehicle, path, count, dwell, old);
                TEST_ASSERT_DOUBLE_WITHIN(2e-3 * v + 2e-3, v,
                                          aisle_motion_speed(&vehicle, rest, left, rest_dwell, now));
            }
        }
    }
    TEST_ASSERT_GREATER_THAN_UINT32(CASES(20), trapezoids);
}

static void test_a_cut_path_has_the_old_times_less_the_times_of_the_cut(void) {
    for (uint64_t seed = 0; seed < SEEDS; seed++) {
        aisle_rng rng = aisle_rng_seed(seed);
        make_random(seed);
        for (int i = 0; i < 30; i++) {
            const aisle_place p = random_place(&rng);
            cut_at(p);
            const double t0 = aisle_motion_time(&vehicle, path, count, dwell, p);
            double later = 0.0;
            if (spot(path, p.piece) && !waits(path, p.piece) && p.u > 0.0 && p.u < 1.0) {
                const real anew =
                    fmaxl(trapezoid_time(way_of(path, p.piece) * (1.0L - wide(p.u)), wide(vehicle.omega_max),
                                         wide(vehicle.alpha_max), wide(vehicle.alpha_max)),
                          1e-3L);
                later = (double)(anew - (wide((double)path[p.piece].t) - wide(t0)));
            }
            TEST_ASSERT_TRUE(rest[0].t <= 0.0F && rest[0].t >= 0.0F && rest[0].s <= 0.0F && rest[0].s >= 0.0F);
            for (uint32_t k = p.piece + (p.u >= 1.0 ? 1U : 0U); k < count; k++) {
                const aisle_waypoint_msg *w = &rest[left - (count - k)];
                const double wanted = (double)path[k].t - t0 + later;
                const double spent = waits(path, p.piece) ? 1e-3 : 0.0; // what is left of a wait
                TEST_ASSERT_DOUBLE_WITHIN(1e-5 + 2e-7 * wanted + spent, wanted, (double)w->t);
                TEST_ASSERT_TRUE(w == rest || (w->t > (w - 1)->t && w->s >= (w - 1)->s));
                TEST_ASSERT_EQUAL_MEMORY(&path[k].v, &w->v, sizeof w->v);
            }
        }
    }
}

static void test_a_cut_keeps_flags_goals_and_figures_behind_the_first_waypoint(void) {
    for (uint64_t seed = 0; seed < CASES(30); seed++) {
        aisle_rng rng = aisle_rng_seed(seed);
        make_random(seed + 3);
        for (uint32_t i = 1; i < count; i++) {
            path[i].goal_id = (int32_t)i;
        }
        const aisle_place p = {1 + aisle_rng_below(&rng, count - 1), 0.5};
        cut_at(p);
        for (uint32_t k = p.piece; k < count; k++) {
            aisle_waypoint_msg w = rest[left - (count - k)];
            w.s = path[k].s;
            w.t = path[k].t;
            w.a = k == p.piece ? path[k].a : w.a;
            TEST_ASSERT_EQUAL_MEMORY(&path[k], &w, sizeof w);
        }
        TEST_ASSERT_TRUE(rest[0].a <= 0.0F && rest[0].a >= 0.0F && rest[0].curvature <= 0.0F &&
                         rest[0].curvature >= 0.0F);
        TEST_ASSERT_EQUAL_INT(0, rest[0].goal_id);
        TEST_ASSERT_EQUAL_FLOAT(path[p.piece].clearance, rest[0].clearance);
        TEST_ASSERT_EQUAL_INT(spot(path, p.piece) ? AISLE_WAYPOINT_TURN_IN_PLACE | AISLE_WAYPOINT_STOP
                                                  : path[p.piece].flags & AISLE_WAYPOINT_REVERSE,
                              rest[0].flags);
    }
}

static void test_a_trapezoid_cut_in_motion_is_driven_on_as_it_was(void) {
    (void)add(0.0, 0.0, 0.0);
    (void)add(6.0, 0.0, 0.0); // 2.25 m up, 1.5 m level, 2.25 m down
    fill();
    const double cuts[] = {1.0, 3.0, 5.0};
    for (int i = 0; i < 3; i++) {
        cut_at((aisle_place){1, cuts[i] / 6.0});
        TEST_ASSERT_EQUAL_UINT32(4U - (uint32_t)i, left);
        TEST_ASSERT_FLOAT_WITHIN(1e-4F, i == 1 ? 1.5F : 1.0F, rest[0].v);
        const float a[] = {0.5F, 0.0F, -0.5F};
        for (uint32_t k = 1; k < left; k++) {
            TEST_ASSERT_FLOAT_WITHIN(1e-3F, a[k - 1U + (uint32_t)i], rest[k].a);
        }
    }
}

static void test_the_last_of_a_turn_takes_its_millisecond(void) {
    set_flag(add(0.0, 0.0, 0.0), AISLE_WAYPOINT_TURN_IN_PLACE);
    (void)add(0.0, 0.0, 1.0);
    fill();
    cut_at((aisle_place){1, 1.0 - 2e-7});
    TEST_ASSERT_EQUAL_UINT32(2, left);
    TEST_ASSERT_TRUE((double)rest[1].t >= 1e-3);
}

static void test_a_goal_is_told_until_its_waypoint_is_left(void) {
    (void)add(0.0, 0.0, 0.0);
    add_line(1.0, 0.5);
    set_flag(&path[2], AISLE_WAYPOINT_GOAL | AISLE_WAYPOINT_STOP);
    path[2].goal_id = 77;
    set_flag(add(0.5, 0.0, 0.0), AISLE_WAYPOINT_REVERSE);
    set_flag(add(0.0, 0.0, 0.0), AISLE_WAYPOINT_REVERSE);
    dwell[2] = 3.0F;
    fill();
    cut_at((aisle_place){2, 1.0});
    TEST_ASSERT_EQUAL_INT(AISLE_WAYPOINT_GOAL | AISLE_WAYPOINT_STOP | AISLE_WAYPOINT_REVERSE, rest[0].flags);
    TEST_ASSERT_EQUAL_INT(77, rest[0].goal_id);
    const double drives = (double)path[3].t - (double)path[2].t - 3.0;
    TEST_ASSERT_DOUBLE_WITHIN(1e-5, 3.0 + drives, (double)rest[1].t); // the dwell is ahead
    cut_at((aisle_place){2, 1.0 - 1e-7});
    TEST_ASSERT_EQUAL_INT(77, rest[0].goal_id);
    TEST_ASSERT_EQUAL_UINT32(3, left);
    cut_at((aisle_place){3, 0.0});
    TEST_ASSERT_EQUAL_INT(AISLE_WAYPOINT_REVERSE, rest[0].flags);
    TEST_ASSERT_EQUAL_INT(0, rest[0].goal_id);
    TEST_ASSERT_DOUBLE_WITHIN(1e-5, drives, (double)rest[1].t); // and behind
}

static void test_without_room_a_cut_says_so_and_writes_no_more_than_there_is(void) {
    make_random(20);
    const aisle_place p = {3, 0.5};
    cut_at(p);
    const uint32_t needed = left;
    for (uint32_t room = 0; room <= needed; room++) {
        memset(rest, 0xA5, sizeof rest);
        const uint32_t n = aisle_motion_cut(&vehicle, path, count, dwell, p, rest, room);
        TEST_ASSERT_EQUAL_UINT32(room < needed ? 0 : needed, n);
        for (size_t k = 0; k < sizeof *rest; k++) {
            TEST_ASSERT_EQUAL_HEX8(0xA5, ((const uint8_t *)&rest[room])[k]);
        }
    }
}

// ---- braking

// Goes on for `delay` s from place p at v, then brakes: where it comes to rest.
static aisle_place drive(aisle_place p, real v, real delay) {
    const real dt = 1e-4L;
    driver it = driver_at(path, count, dwell, p, v);
    for (real t = 0.0L; t < delay; t += dt) {
        driver_follow(&it, dt);
    }
    while (driver_brake(&it, dt)) {
    }
    return driver_place(&it);
}

static void test_it_rests_where_a_fine_simulation_does(void) {
    for (uint64_t seed = 0; seed < CASES(60); seed++) {
        aisle_rng rng = aisle_rng_seed(seed);
        make_random(seed);
        for (uint32_t i = 1; i < count; i++) { // pieces so short that they last their millisecond are another story
            path[i].clearance = 3.0F;
        }
        for (int k = 0; k < 10; k++) {
            const aisle_place p = random_place(&rng);
            const double own = aisle_motion_speed(&vehicle, path, count, dwell, p);
            const double v = k % 3 == 0 && !spot(path, p.piece) ? own + uniform(&rng, 0.0, 0.3) : own,
                         delay = uniform(&rng, 0.0, 1.5);
            const aisle_place q = aisle_motion_rest(&vehicle, path, count, dwell, p, v, delay);
            TEST_ASSERT_TRUE(aisle_place_exists(count, q));
            const aisle_place wanted = drive(p, wide(v), wide(delay));
            const double a = aisle_motion_length_to(path, count, q), b = aisle_motion_length_to(path, count, wanted);
            TEST_ASSERT_DOUBLE_WITHIN(0.01, b, a);
            if (spot(path, q.piece) && q.piece == wanted.piece && !waits(path, q.piece)) {
                TEST_ASSERT_DOUBLE_WITHIN(0.01, wanted.u * (double)way_of(path, q.piece),
                                          q.u * (double)way_of(path, q.piece));
            }
        }
    }
}

static void test_a_rest_on_the_way_takes_its_time_before_it_brakes(void) {
    (void)add(0.0, 0.0, 0.0);
    add_line(4.0, 1.0);
    set_flag(&path[2], AISLE_WAYPOINT_STOP);
    dwell[2] = 0.5F;
    fill();
    const aisle_place q = aisle_motion_rest(&vehicle, path, count, dwell, (aisle_place){2, 1.0}, 0.0, 1.5);
    // 1 s at 0.5 m/s2, and as long again to brake
    TEST_ASSERT_DOUBLE_WITHIN(1e-3, 2.0 + 0.25 + 0.25, aisle_motion_length_to(path, count, q));
    const aisle_place stays = aisle_motion_rest(&vehicle, path, count, dwell, (aisle_place){2, 1.0}, 0.0, 0.4);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 2.0, aisle_motion_length_to(path, count, stays));
}

static void test_braking_never_leads_beyond_where_the_path_rests(void) {
    make_cusp();
    const aisle_place p = {1, 0.9};
    const aisle_place q = aisle_motion_rest(&vehicle, path, count, dwell, p, 1.4, 0.0);
    TEST_ASSERT_TRUE(q.piece == 1 && q.u >= 1.0);
}

static void test_too_fast_a_vehicle_brakes_at_once_down_to_the_path(void) {
    (void)add(0.0, 0.0, 0.0);
    add_line(8.0, 0.25);
    for (uint32_t i = 1; i < count; i++) {
        path[i].clearance = 0.1F; // creep, 0.3 m/s
    }
    fill();
    const aisle_place p = {9, 0.0}; // 2 m
    // 1.1 m/s to 0.3 m/s in 1.6 s over 1.12 m, then 0.4 s at 0.3 m/s, then 0.09 m
    const aisle_place q = aisle_motion_rest(&vehicle, path, count, dwell, p, 1.1, 2.0);
    TEST_ASSERT_DOUBLE_WITHIN(1e-4, 2.0 + 1.12 + 0.12 + 0.09, aisle_motion_length_to(path, count, q));
    const aisle_place half = aisle_motion_rest(&vehicle, path, count, dwell, p, 1.1, 0.8);
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, 2.0 + 1.21, aisle_motion_length_to(path, count, half));
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_lengths_and_poses_are_those_of_the_curve);
    RUN_TEST(test_advancing_goes_the_metres_asked_for_or_to_the_end);
    RUN_TEST(test_advancing_by_nothing_stays_and_turns_at_its_end_are_not_passed);
    RUN_TEST(test_speeds_are_what_the_contract_says_on_every_kind_of_piece);
    RUN_TEST(test_times_are_the_integral_of_the_speeds);
    RUN_TEST(test_time_rises_along_the_path_and_meets_every_waypoint);
    RUN_TEST(test_place_at_a_time_is_the_inverse_of_the_time_at_a_place);
    RUN_TEST(test_times_before_and_behind_the_path_give_its_ends);
    RUN_TEST(test_a_rest_before_moving_on_is_told_apart_without_being_told);
    RUN_TEST(test_a_rest_before_a_piece_from_rest_to_rest_is_told_by_dwell_alone);
    RUN_TEST(test_a_dwell_that_does_not_fit_leaves_the_motion_its_least_time);
    RUN_TEST(test_a_path_of_one_waypoint_has_one_place);
    RUN_TEST(test_a_pose_on_the_path_is_found_again);
    RUN_TEST(test_a_pose_off_a_smooth_path_is_projected_to_its_nearest_place);
    RUN_TEST(test_the_window_bounds_the_place);
    RUN_TEST(test_it_is_not_left_for_another_branch_where_the_path_crosses_itself);
    RUN_TEST(test_a_track_driven_both_ways_is_followed_in_order);
    RUN_TEST(test_behind_a_high_barrier_nothing_is_looked_at);
    RUN_TEST(test_turns_on_the_spot_are_matched_by_heading);
    RUN_TEST(test_a_wait_stays_where_it_is_until_the_vehicle_drives_on);
    RUN_TEST(test_a_cut_path_is_the_old_one_from_there_on);
    RUN_TEST(test_a_cut_path_has_the_old_times_less_the_times_of_the_cut);
    RUN_TEST(test_a_cut_keeps_flags_goals_and_figures_behind_the_first_waypoint);
    RUN_TEST(test_a_trapezoid_cut_in_motion_is_driven_on_as_it_was);
    RUN_TEST(test_the_last_of_a_turn_takes_its_millisecond);
    RUN_TEST(test_a_goal_is_told_until_its_waypoint_is_left);
    RUN_TEST(test_without_room_a_cut_says_so_and_writes_no_more_than_there_is);
    RUN_TEST(test_it_rests_where_a_fine_simulation_does);
    RUN_TEST(test_a_rest_on_the_way_takes_its_time_before_it_brakes);
    RUN_TEST(test_braking_never_leads_beyond_where_the_path_rests);
    RUN_TEST(test_too_fast_a_vehicle_brakes_at_once_down_to_the_path);
    return UNITY_END();
}
