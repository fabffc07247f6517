#include "robot/profile.h" // first: proves that the header stands alone

#include "base/angle.h"
#include "base/arena.h"
#include "base/crc32.h"
#include "base/rng.h"
#include "random_path.h"
#include "robot/motion.h"
#include "unity.h"
#include "wire/codec.h"

#include <float.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

static aisle_profile_sum sum;
static float most[CAPACITY];
static aisle_profile_start begin; // at rest and unbounded, if not said otherwise

void setUp(void) {
    static const aisle_vehicle_msg usual;
    set_vehicle(&usual);
    memset(path, 0xA5, sizeof path); // what fill() writes must not depend on what was there
    memset(dwell, 0, sizeof dwell);
    memset(&sum, 0, sizeof sum);
    count = 0;
    begin = (aisle_profile_start){0.0, NULL};
}
void tearDown(void) {
    const aisle_waypoint_msg *canary = &path[CAPACITY];
    for (size_t i = 0; i < sizeof *canary; i++) {
        TEST_ASSERT_EQUAL_HEX8(0xA5, ((const uint8_t *)canary)[i]);
    }
}

static void fill(void) {
    TEST_ASSERT_EQUAL_INT(AISLE_OK, aisle_profile_fill(&vehicle, NULL, path, count, dwell, &sum));
}

static aisle_status fill_moving(void) {
    return aisle_profile_fill_moving(&vehicle, NULL, path, count, dwell, &begin, &sum);
}

// ---- the judge: rules of the header again, in long double, from the floats as they stand

static long double ld(double x) {
    return (long double)x;
}
static long double lf(float x) {
    return (long double)x;
}
static bool flagged(uint32_t i, int flag) {
    return (path[i].flags & flag) != 0;
}
static bool turning(uint32_t i) {
    return flagged(i - 1, AISLE_WAYPOINT_TURN_IN_PLACE);
} // piece i

static long double length_between(const aisle_waypoint_msg *from, const aisle_waypoint_msg *to) {
    const long double chord = hypotl(ld(to->x) - ld(from->x), ld(to->y) - ld(from->y));
    const long double curvature = fabsl(lf(to->curvature));
    if ((from->flags & AISLE_WAYPOINT_TURN_IN_PLACE) != 0) {
        return 0.0L;
    }
    return curvature * chord < 1e-9L ? chord : 2.0L * asinl(fminl(1.0L, 0.5L * curvature * chord)) / curvature;
}
static long double turn_between(const aisle_waypoint_msg *from, const aisle_waypoint_msg *to) {
    return remainderl(ld(to->theta) - ld(from->theta), 2.0L * acosl(-1.0L));
}

static long double judge_length(uint32_t i) {
    return length_between(&path[i - 1], &path[i]);
}
static long double judge_turn(uint32_t i) {
    return fabsl(turn_between(&path[i - 1], &path[i]));
}

static bool judge_rest(uint32_t i) {
    if (i == 0 || i + 1 == count) {
        return i > 0 || !(begin.v > 0.0);
    }
    const bool stop = flagged(i, AISLE_WAYPOINT_STOP), turn = turning(i) || turning(i + 1);
    return stop || turn || flagged(i, AISLE_WAYPOINT_REVERSE) != flagged(i + 1, AISLE_WAYPOINT_REVERSE);
}

typedef enum cause {
    V_MAX,
    REVERSE,
    LATERAL,
    OMEGA,
    CREEP,
    UP,
    DOWN,
    REST,
    AT_REST_BOTH,
    SHORTEST_TIME,
    CAUSES, // of paths from rest
    MOST = CAUSES,
    BRAKED,
    ALL_CAUSES
} cause;
static uint32_t hits[ALL_CAUSES];

static long double judge_limit(uint32_t i, cause *why) { // of piece i, zones aside
    const long double curvature = fabsl(lf(path[i].curvature)), turn = judge_turn(i), length = judge_length(i);
    const bool back = flagged(i, AISLE_WAYPOINT_REVERSE);
    long double limit = ld(back ? vehicle.v_reverse_max : vehicle.v_max);
    *why = back ? REVERSE : V_MAX;
    if (curvature > 0.0L && sqrtl(ld(vehicle.lateral_a_max) / curvature) < limit) {
        limit = sqrtl(ld(vehicle.lateral_a_max) / curvature);
        *why = LATERAL;
    }
    if (turn > 0.0L && ld(vehicle.omega_max) * length / turn < limit) {
        limit = ld(vehicle.omega_max) * length / turn;
        *why = OMEGA;
    }
    if (ld((double)path[i].clearance) < ld(vehicle.creep_clearance) && ld(vehicle.creep_speed) < limit) {
        limit = ld(vehicle.creep_speed);
        *why = CREEP;
    }
    return limit;
}

static long double judge_behind(uint32_t i) { // length up to waypoint i
    long double s = 0.0L;
    for (uint32_t k = 1; k <= i; k++) {
        s += judge_length(k);
    }
    return s;
}

// What `most` or braking at once allows of waypoint i; greater than any speed without bounds.
static long double judge_most(uint32_t i, cause *why) {
    const long double v2 = ld(begin.v) * ld(begin.v) - 2.0L * ld(vehicle.d_max) * judge_behind(i);
    const long double braked = sqrtl(fmaxl(v2, 0.0L));
    if (begin.most == NULL) {
        *why = MOST;
        return 1e9L;
    }
    *why = braked > lf(most[i]) ? BRAKED : MOST;
    return fmaxl(lf(most[i]), braked);
}

// The limit of piece i, bounds counted.
static long double judge_bounded(uint32_t i) {
    cause why;
    const long double limit = judge_limit(i, &why);
    return begin.most == NULL ? limit : fminl(limit, fmaxl(lf(most[i - 1]), lf(most[i])));
}

static long double trapezoid(long double way, long double top, long double up, long double down, long double *peak) {
    const long double way_up = top * top / (2.0L * up), way_down = top * top / (2.0L * down);
    if (way_up + way_down <= way) {
        *peak = top;
        return top / up + top / down + (way - way_up - way_down) / top;
    }
    *peak = sqrtl(2.0L * way / (1.0L / up + 1.0L / down));
    return *peak / up + *peak / down;
}

// No speed breaks a rule, and none could be raised alone: it stands at a limit or at what a neighbour allows. Since
// such chains end at a limit, no other speeds that keep the rules are higher anywhere.
static void judge_speed(uint32_t i) {
    const long double v = lf(path[i].v);
    TEST_ASSERT_TRUE(path[i].v >= 0.0F);
    if (judge_rest(i)) {
        TEST_ASSERT_TRUE(path[i].v <= 0.0F);
        hits[REST]++;
        return;
    }
    if (i == 0) { // of a path under way
        TEST_ASSERT_TRUE(v <= ld(begin.v) && v >= ld(begin.v) * (1.0L - 1.1e-6L));
        return;
    }
    cause why[3];
    const long double allowed[5] = {
        judge_limit(i, &why[0]), judge_limit(i + 1, &why[1]),
        sqrtl(lf(path[i - 1].v) * lf(path[i - 1].v) + 2.0L * ld(vehicle.a_max) * judge_length(i)),
        sqrtl(lf(path[i + 1].v) * lf(path[i + 1].v) + 2.0L * ld(vehicle.d_max) * judge_length(i + 1)),
        judge_most(i, &why[2])};
    const cause of[5] = {why[0], why[1], UP, DOWN, why[2]};
    int least = 0;
    for (int k = 0; k < 5; k++) {
        TEST_ASSERT_TRUE(v <= allowed[k] * (1.0L + 1e-12L) + (k < 4 ? 0.0L : 5e-6L)); // s is a sum of floats
        least = allowed[k] < allowed[least] ? k : least;
    }
    TEST_ASSERT_TRUE(v >= allowed[least] * (1.0L - 3e-7L) - (least < 4 ? 0.0L : 5e-6L));
    hits[of[least]]++;
}

static long double judge_duration(uint32_t i, long double *work) { // of piece i from its speeds
    const long double v0 = lf(path[i - 1].v), v1 = lf(path[i].v), length = judge_length(i), turn = judge_turn(i);
    const long double weight = ld(vehicle.mass) * 9.80665L * ld(vehicle.rolling_resistance);
    long double peak;
    if (turning(i)) {
        *work = weight * ld(vehicle.outer_radius) * turn;
        return trapezoid(turn, ld(vehicle.omega_max), ld(vehicle.alpha_max), ld(vehicle.alpha_max), &peak);
    }
    *work = weight * length;
    if (v0 + v1 > 0.0L) {
        *work += v1 > v0 ? 0.5L * ld(vehicle.mass) * (v1 * v1 - v0 * v0) : 0.0L;
        return 2.0L * length / (v0 + v1);
    }
    hits[AT_REST_BOTH]++;
    const long double t = trapezoid(length, judge_bounded(i), ld(vehicle.a_max), ld(vehicle.d_max), &peak);
    *work += 0.5L * ld(vehicle.mass) * peak * peak;
    return t;
}

static long double judge_piece(uint32_t i) { // returns the work of piece i
    long double work;
    const long double needed = judge_duration(i, &work), length = judge_length(i);
    const long double dt = lf(path[i].t) - lf(path[i - 1].t), rest = lf(dwell[i - 1]);
    const long double step = lf(nextafterf(path[i].t, INFINITY)) - lf(path[i].t);
    TEST_ASSERT_TRUE(dt >= 0.001L * (1.0L - 1e-9L));
    TEST_ASSERT_TRUE(dt >= rest + needed * (1.0L - 1e-9L) - 1e-12L);
    TEST_ASSERT_TRUE(dt <= rest + fmaxl(needed * (1.0L + 1.2e-7L), 0.001L) + step + 1e-12L);
    hits[SHORTEST_TIME] += needed < 0.001L ? 1U : 0U;
    const long double v0 = lf(path[i - 1].v), v1 = lf(path[i].v), a = lf(path[i].a);
    TEST_ASSERT_TRUE(a <= ld(vehicle.a_max) && a >= -ld(vehicle.d_max));
    const long double exact = turning(i) ? 0.0L : (v1 * v1 - v0 * v0) / (2.0L * length);
    TEST_ASSERT_TRUE(fabsl(a - exact) <= 1.2e-7L * fabsl(exact) + 1e-30L);
    return work;
}

// Everything about a filled path; returns its duration.
static long double judge_path(void) {
    long double length = 0.0L, work = 0.0L, risk = 0.0L;
    TEST_ASSERT_TRUE(path[0].s <= 0.0F && path[0].t <= 0.0F && path[0].s >= 0.0F && path[0].t >= 0.0F);
    TEST_ASSERT_TRUE(path[0].a <= 0.0F && path[0].a >= 0.0F);
    for (uint32_t i = 0; i < count; i++) {
        judge_speed(i);
        if (i > 0) {
            work += judge_piece(i);
            length += judge_length(i);
            risk += judge_length(i) * fmaxl(0.0L, 1.0L - lf(path[i].clearance) / ld(vehicle.creep_clearance));
            TEST_ASSERT_TRUE(fabsl(lf(path[i].s) - length) <= 6.1e-8L * length + 1e-12L);
            TEST_ASSERT_TRUE(path[i].s >= path[i - 1].s && path[i].t > path[i - 1].t);
        }
    }
    const long double duration = lf(path[count - 1].t);
    const long double energy = work / ld(vehicle.drive_efficiency) + ld(vehicle.idle_power) * duration;
    TEST_ASSERT_TRUE(fabsl(ld(sum.length) - length) <= 1e-11L * length);
    TEST_ASSERT_TRUE(fabsl(ld(sum.duration) - duration) <= 0.0L);
    TEST_ASSERT_TRUE(fabsl(ld(sum.energy) - energy) <= 3e-7L * energy);
    TEST_ASSERT_TRUE(fabsl(ld(sum.risk) - (length > 0.0L ? risk / length : 0.0L)) <= 1e-11L);
    return duration;
}

static void test_every_rule_holds_and_no_speed_could_be_higher_for_200_of_200_paths(void) {
    memset(hits, 0, sizeof hits);
    for (uint64_t seed = 0; seed < 200; seed++) {
        setUp();
        if (seed % 2 == 1) {
            random_vehicle(seed);
        }
        random_path(seed, 2 + (uint32_t)seed * 2);
        fill();
        (void)judge_path();
    }
    for (int i = 0; i < CAUSES; i++) { // the seeds meet every case
        TEST_ASSERT_GREATER_THAN_UINT32_MESSAGE(50, hits[i], "a case hardly met");
    }
}

// ---- under way

// A random path from a place in the middle of a piece on, begin.v being its speed there.
static bool cut_random_path(uint64_t seed) {
    static aisle_waypoint_msg whole[CAPACITY];
    aisle_rng rng = aisle_rng_seed(seed);
    setUp();
    if (seed % 2 == 1) {
        random_vehicle(seed);
    }
    random_path(seed, 20 + (uint32_t)seed);
    fill();
    const uint32_t piece = 1 + aisle_rng_below(&rng, count - 1);
    const aisle_place at = {piece, uniform(&rng, 0.05, 0.95)};
    begin.v = aisle_motion_speed(&vehicle, path, count, dwell, at);
    memcpy(whole, path, sizeof whole);
    const uint32_t n = aisle_motion_cut(&vehicle, whole, count, dwell, at, path, CAPACITY);
    TEST_ASSERT_GREATER_THAN_UINT32(1, n);
    for (uint32_t i = 0; i < n; i++) {
        const uint32_t old = count - n + i; // n may be greater: of a trapezoid, which has no dwell between
        dwell[i] = n <= count && i > 0 ? dwell[old] : 0.0F;
    }
    count = n;
    return n <= CAPACITY && begin.v > 1e-3;
}

static void test_every_rule_holds_of_paths_under_way_for_400_of_400(void) {
    uint32_t moving = 0;
    memset(hits, 0, sizeof hits);
    for (uint64_t seed = 0; seed < 400; seed++) {
        aisle_rng rng = aisle_rng_seed(seed + 1000U);
        moving += cut_random_path(seed) ? 1U : 0U;
        float bound = (float)vehicle.v_max;
        for (uint32_t i = 0; i < count; i++) {
            bound = aisle_rng_below(&rng, 10) == 0 ? (float)uniform(&rng, 0.05, 1.2 * vehicle.v_max) : bound;
            most[i] = i > count / 2 ? INFINITY : bound;
        }
        begin.most = seed % 4 != 0 ? most : NULL;
        const aisle_status st = fill_moving();
        TEST_ASSERT_EQUAL_INT(AISLE_OK, st);
        (void)judge_path();
    }
    TEST_ASSERT_GREATER_THAN_UINT32(250, moving);
    TEST_ASSERT_GREATER_THAN_UINT32(500, hits[MOST]);
    TEST_ASSERT_GREATER_THAN_UINT32(10, hits[BRAKED]);
}

static void test_unbounded_a_path_goes_on_with_the_speeds_it_had(void) {
    static aisle_waypoint_msg before[CAPACITY];
    for (uint64_t seed = 0; seed < 100; seed++) {
        (void)cut_random_path(seed);
        memcpy(before, path, sizeof before);
        TEST_ASSERT_EQUAL_INT(AISLE_OK, fill_moving());
        for (uint32_t i = 0; i < count; i++) {
            TEST_ASSERT_FLOAT_WITHIN(1e-5F * before[i].v + 1e-6F, before[i].v, path[i].v);
        }
    }
}

static void test_at_rest_and_unbounded_it_is_the_plain_fill(void) {
    static aisle_waypoint_msg plain[CAPACITY];
    for (uint64_t seed = 0; seed < 20; seed++) {
        setUp();
        random_path(seed, 200);
        fill();
        memcpy(plain, path, sizeof plain);
        const aisle_profile_sum once = sum;
        for (uint32_t i = 0; i < count; i++) {
            most[i] = INFINITY;
        }
        begin.most = most;
        TEST_ASSERT_EQUAL_INT(AISLE_OK, fill_moving());
        TEST_ASSERT_EQUAL_MEMORY(plain, path, sizeof plain);
        TEST_ASSERT_EQUAL_MEMORY(&once, &sum, sizeof sum);
    }
}

// ---- with ramps

// path as it was, its `count`; then with ramps: count is theirs.
static aisle_waypoint_msg whole[CAPACITY];
static uint32_t whole_count;

static aisle_status fill_ramps(uint32_t capacity) {
    memcpy(whole, path, sizeof whole);
    whole_count = count;
    aisle_profile_path way = {path, dwell, count, capacity, 0, 0};
    const aisle_status st = aisle_profile_fill_ramps(&vehicle, NULL, &way, &begin, &sum);
    count = way.n;
    return st;
}

// s of a piece, its ends' speeds and limit as they are, if it is driven as fast as can be; at rest at both ends, too.
static long double judge_fastest(uint32_t i) {
    const long double v0 = lf(path[i - 1].v), v1 = lf(path[i].v), up = ld(vehicle.a_max), down = ld(vehicle.d_max);
    const long double limit = judge_bounded(i), length = judge_length(i);
    long double lo = fmaxl(v0, v1), hi = limit; // the peak, by bisection of the way it takes
    if (hi <= lo) {
        return 2.0L * length / (v0 + v1);
    }
    for (int k = 0; k < 200; k++) {
        const long double peak = 0.5L * (lo + hi);
        const long double ways = (peak * peak - v0 * v0) / (2.0L * up) + (peak * peak - v1 * v1) / (2.0L * down);
        *(ways <= length ? &lo : &hi) = peak;
    }
    const long double ways = (lo * lo - v0 * v0) / (2.0L * up) + (lo * lo - v1 * v1) / (2.0L * down);
    return (lo - v0) / up + (lo - v1) / down + fmaxl(length - ways, 0.0L) / lo;
}

// m, from w to the line or the circle of the piece between two waypoints.
static long double off_piece(const aisle_waypoint_msg *from, const aisle_waypoint_msg *to,
                             const aisle_waypoint_msg *w) {
    const long double dx = ld(to->x) - ld(from->x), dy = ld(to->y) - ld(from->y), chord = hypotl(dx, dy);
    const long double x = ld(w->x) - ld(from->x), y = ld(w->y) - ld(from->y), curvature = lf(to->curvature);
    const long double along = (x * dx + y * dy) / chord, left = (dx * y - dy * x) / chord;
    if (fabsl(curvature) * chord < 1e-9L) {
        return fabsl(left);
    }
    const long double radius = 1.0L / fabsl(curvature); // of a left turn the centre is to the left
    const long double middle = sqrtl(fmaxl(radius * radius - 0.25L * chord * chord, 0.0L));
    return fabsl(hypotl(along - 0.5L * chord, left - copysignl(middle, curvature)) - radius);
}

// Waypoint i, new, is on the piece to whole[old]; `length` and `turn` from where that begins are in proportion.
static void judge_new(uint32_t i, uint32_t old, long double length, long double turn) {
    TEST_ASSERT_TRUE(i > 0 && old > 0);
    const aisle_waypoint_msg *from = &whole[old - 1], *to = &whole[old];
    const long double all = length_between(from, to);
    TEST_ASSERT_TRUE(judge_length(i) > 4.9e-6L && length < all);
    TEST_ASSERT_TRUE(off_piece(from, to, &path[i]) <= 1e-9L);
    TEST_ASSERT_TRUE(fabsl(turn - turn_between(from, to) * length / all) <= 1e-9L);
    TEST_ASSERT_FALSE(path[i].curvature != to->curvature || path[i].clearance != to->clearance || dwell[i] > 0.0F);
    TEST_ASSERT_EQUAL_INT(to->flags & AISLE_WAYPOINT_REVERSE, path[i].flags);
}

// The parts of the piece to whole[old] add up to it.
static void judge_sums(uint32_t old, long double length, long double turn) {
    const aisle_waypoint_msg *from = &whole[old - 1], *to = &whole[old];
    TEST_ASSERT_TRUE(fabsl(length - length_between(from, to)) <= 1e-9L);
    TEST_ASSERT_TRUE(fabsl(turn - turn_between(from, to)) <= 1e-9L);
}

// Every waypoint there was is there yet, in this order, with its speed by `plain` and its dwell by `rests`; what is new
// is on its piece. Gives every new one a bound for the judge. bounds: of the path as it was.
static void judge_kept(const aisle_waypoint_msg *plain, const float *bounds, const float *rests) {
    uint32_t old = 0;
    long double length = 0.0L, turn = 0.0L; // since the last waypoint there was
    for (uint32_t i = 0; i < count; i++) {
        const aisle_waypoint_msg *w = &whole[old];
        const bool same = !(path[i].x != w->x) && !(path[i].y != w->y) && !(path[i].theta != w->theta) &&
                          path[i].flags == w->flags && path[i].goal_id == w->goal_id;
        length += i > 0 ? judge_length(i) : 0.0L;
        turn += i > 0 ? turn_between(&path[i - 1], &path[i]) : 0.0L;
        most[i] = bounds[old];
        if (same && (old == 0 || !(path[i].curvature != w->curvature || path[i].clearance != w->clearance))) {
            TEST_ASSERT_FLOAT_WITHIN(2e-6F * plain[old].v, plain[old].v, path[i].v);
            TEST_ASSERT_EQUAL_MEMORY(&rests[old], &dwell[i], sizeof dwell[i]);
            if (old > 0) {
                judge_sums(old, length, turn);
            }
            length = turn = 0.0L;
            old++;
        } else {
            judge_new(i, old, length, turn);
        }
    }
    TEST_ASSERT_EQUAL_UINT32(whole_count, old);
}

static void test_with_ramps_every_rule_holds_and_no_piece_could_be_driven_faster_for_400_of_400(void) {
    static aisle_waypoint_msg plain[CAPACITY];
    static float bounds[CAPACITY], rests[CAPACITY];
    uint32_t more = 0;
    for (uint64_t seed = 0; seed < 400; seed++) {
        aisle_rng rng = aisle_rng_seed(seed + 2000U);
        (void)cut_random_path(seed);
        count = count < 300 ? count : 300;
        dwell[count - 1] = 0.0F;
        float bound = (float)vehicle.v_max;
        for (uint32_t i = 0; i < count; i++) {
            bound = aisle_rng_below(&rng, 10) == 0 ? (float)uniform(&rng, 0.05, 1.2 * vehicle.v_max) : bound;
            bounds[i] = most[i] = i > count / 2 ? INFINITY : bound;
        }
        begin.most = seed % 4 != 0 ? most : NULL;
        memcpy(rests, dwell, sizeof rests);
        const aisle_status st = fill_moving();
        memcpy(plain, path, sizeof plain);
        const double duration = sum.duration;
        TEST_ASSERT_EQUAL_INT(st, fill_ramps(CAPACITY));
        judge_kept(plain, bounds, rests);
        (void)judge_path();
        TEST_ASSERT_TRUE(sum.duration <= duration + 1e-3);
        for (uint32_t i = 1; i < count; i++) {
            const long double dt = lf(path[i].t) - lf(path[i - 1].t) - lf(dwell[i - 1]);
            const bool even = begin.most == NULL || !(most[i - 1] != most[i]) || isinf(most[i]);
            if (!turning(i) && even) {
                TEST_ASSERT_TRUE(dt <= judge_fastest(i) + 1.1L * (long double)AISLE_PROFILE_RAMP_GAIN);
            }
        }
        more += count - whole_count;
    }
    TEST_ASSERT_GREATER_THAN_UINT32(2000, more);
}

static void test_a_line_from_a_start_in_motion_gets_both_its_ramps(void) {
    (void)add(0.0, 0.0, 0.0);
    add_line(10.0, 10.0);
    begin.v = 0.5;
    TEST_ASSERT_EQUAL_INT(AISLE_OK, fill_ramps(CAPACITY)); // 0.5 to 1.5 m/s at 0.5 m/s2: 2 m; back to 0: 2.25 m
    TEST_ASSERT_EQUAL_UINT32(4, count);
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, 2.0, path[1].x);
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, 7.75, path[2].x);
    TEST_ASSERT_DOUBLE_WITHIN(1e-3, 2.0 + 5.75 / 1.5 + 3.0, sum.duration);
}

static void test_without_room_for_ramps_it_is_the_plain_fill_and_the_first_pieces_get_what_there_is(void) {
    static aisle_waypoint_msg plain[CAPACITY];
    (void)add(0.0, 0.0, 0.0);
    for (int i = 0; i < 3; i++) {
        add_line(8.0, 4.0);
        set_flag(&path[count - 1], AISLE_WAYPOINT_STOP);
    }
    TEST_ASSERT_EQUAL_INT(AISLE_OK, fill_moving());
    memcpy(plain, path, sizeof plain);
    TEST_ASSERT_EQUAL_INT(AISLE_OK, fill_ramps(count));
    TEST_ASSERT_EQUAL_MEMORY(plain, path, sizeof plain);
    const double slow = sum.duration;
    TEST_ASSERT_EQUAL_INT(AISLE_OK, fill_ramps(9)); // of six pieces with a waypoint each, two
    TEST_ASSERT_EQUAL_UINT32(9, count);
    (void)judge_path();
    const double gain = 4.0 / 0.75 - (1.5 / 0.5 + 1.75 / 1.5); // of each ramp
    TEST_ASSERT_DOUBLE_WITHIN(1e-3, slow - 2.0 * gain, sum.duration);
    count--;
    aisle_profile_path none = {path, dwell, count, count - 1, 0, 0};
    TEST_ASSERT_EQUAL_INT(AISLE_ERR_ARG, aisle_profile_fill_ramps(&vehicle, NULL, &none, &begin, &sum));
    TEST_ASSERT_EQUAL_INT(AISLE_ERR_ARG, aisle_profile_fill_ramps(&vehicle, NULL, NULL, &begin, &sum));
}

static void test_a_waypoint_is_found_again_behind_the_ramps_put_before_it(void) {
    for (uint32_t mark = 0; mark < 7; mark++) {
        setUp();
        (void)add(0.0, 0.0, 0.0);
        for (int i = 0; i < 3; i++) {
            add_line(8.0, 4.0);
            set_flag(&path[count - 1], AISLE_WAYPOINT_STOP);
        }
        aisle_profile_path way = {path, NULL, count, CAPACITY, mark, 0};
        TEST_ASSERT_EQUAL_INT(AISLE_OK, aisle_profile_fill_ramps(&vehicle, NULL, &way, &begin, &sum));
        TEST_ASSERT_EQUAL_UINT32(13, way.n);
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, 4.0 * mark, path[way.mark].x);
    }
}

static void test_the_first_pieces_are_left_whole_if_they_are_to_be(void) {
    static aisle_waypoint_msg plain[CAPACITY];
    (void)add(0.0, 0.0, 0.0);
    add_line(8.0, 4.0);
    begin.v = 0.3;
    TEST_ASSERT_EQUAL_INT(AISLE_OK, fill_moving());
    memcpy(plain, path, sizeof plain);
    for (uint32_t first = 0; first < 3; first++) {
        memcpy(path, plain, sizeof plain);
        aisle_profile_path way = {path, dwell, count, CAPACITY, 0, first};
        TEST_ASSERT_EQUAL_INT(AISLE_OK, aisle_profile_fill_ramps(&vehicle, NULL, &way, &begin, &sum));
        TEST_ASSERT_EQUAL_UINT32(5 - first, way.n); // each wants one
        TEST_ASSERT_EQUAL_MEMORY(&plain[first], &path[first], sizeof plain[0]);
    }
}

static void test_bounds_slow_the_first_metres_alone(void) {
    (void)add(0.0, 0.0, 0.0);
    add_line(10.0, 0.25);
    begin = (aisle_profile_start){1.0, most}; // 1 m/s to 0.5 m/s at 0.5 m/s2: 0.75 m
    for (uint32_t i = 0; i < count; i++) {
        most[i] = i <= 13 ? 0.5F : INFINITY;
    }
    TEST_ASSERT_EQUAL_INT(AISLE_OK, fill_moving());
    for (uint32_t i = 0; i < count; i++) {
        const double s = 0.25 * i;
        const double braked = sqrt(fmax(1.0 - s, 0.25)), up = sqrt(0.25 + fmax(s - 3.25, 0.0)), down = sqrt(10.0 - s);
        const double wanted = s < 3.3 ? braked : fmin(fmin(up, down), 1.5);
        TEST_ASSERT_DOUBLE_WITHIN(1e-6, wanted, (double)path[i].v);
    }
    const double first = (1.0 - 0.5) / 0.5; // s of braking
    TEST_ASSERT_DOUBLE_WITHIN(1e-4, first, (double)path[3].t);
    TEST_ASSERT_DOUBLE_WITHIN(1e-4, first + 2.5 / 0.5, (double)path[13].t);
}

static void test_a_start_too_fast_for_what_follows_is_told_and_begins_as_fast_as_brakes_allow(void) {
    static aisle_waypoint_msg before[CAPACITY];
    (void)add(0.0, 0.0, 0.0);
    add_line(1.0, 0.25); // at 0.5 m/s2: 1 m/s just stops
    begin.v = 1.0;
    TEST_ASSERT_EQUAL_INT(AISLE_OK, fill_moving());
    memcpy(before, path, sizeof before);
    begin.v = 1.3;
    TEST_ASSERT_EQUAL_INT(AISLE_PARTIAL, fill_moving());
    for (uint32_t i = 0; i < count; i++) {
        TEST_ASSERT_FLOAT_WITHIN(1e-6F, before[i].v, path[i].v);
        TEST_ASSERT_FLOAT_WITHIN(1e-5F, before[i].t, path[i].t);
    }
    begin.v = 0.4;
    path[1].clearance = 0.1F; // creep from the start on
    TEST_ASSERT_EQUAL_INT(AISLE_PARTIAL, fill_moving());
    TEST_ASSERT_FLOAT_WITHIN(1e-6F, 0.3F, path[0].v);
    begin.v = 0.3;
    (void)fill_moving();
    (void)judge_path();
}

static void test_a_start_that_makes_no_sense_is_refused_and_changes_nothing(void) {
    static aisle_waypoint_msg before[CAPACITY];
    (void)add(0.0, 0.0, 0.0);
    add_line(8.0, 0.25);
    fill();
    memcpy(before, path, sizeof before);
    const double wrong[] = {-0.1, (double)NAN, 20.1, (double)INFINITY};
    for (int i = 0; i < 4; i++) {
        begin.v = wrong[i];
        TEST_ASSERT_EQUAL_INT(AISLE_ERR_ARG, fill_moving());
    }
    begin.v = 1.0;
    begin.most = most;
    const float no_bound[] = {-0.1F, NAN};
    for (int i = 0; i < 2; i++) {
        memset(most, 0, sizeof most);
        most[7] = no_bound[i];
        TEST_ASSERT_EQUAL_INT(AISLE_ERR_ARG, fill_moving());
    }
    TEST_ASSERT_EQUAL_INT(AISLE_ERR_ARG, aisle_profile_fill_moving(&vehicle, NULL, path, count, dwell, NULL, &sum));
    TEST_ASSERT_EQUAL_MEMORY(before, path, sizeof before);
}

static void test_where_it_must_rest_it_cannot_begin_in_motion(void) {
    (void)add(0.0, 0.0, 0.0);
    add_line(8.0, 0.25);
    begin.v = 1.0;
    for (int what = 0; what < 3; what++) {
        const int16_t flags[3] = {AISLE_WAYPOINT_STOP, 0, 0};
        path[0].flags = flags[what];
        dwell[0] = what == 1 ? 1.0F : 0.0F;
        const uint32_t all = count;
        count = what == 2 ? 1 : count;
        TEST_ASSERT_EQUAL_INT(AISLE_ERR_ARG, fill_moving());
        begin.v = 0.0;
        TEST_ASSERT_EQUAL_INT(AISLE_OK, fill_moving());
        begin.v = 1.0;
        count = all;
    }
    path[0].flags = AISLE_WAYPOINT_TURN_IN_PLACE;
    path[1] = path[0];
    path[1].flags = 0;
    path[1].theta = 0.5;
    TEST_ASSERT_EQUAL_INT(AISLE_ERR_ARG, fill_moving());
}

static void test_a_path_of_1024_waypoints_and_3000_seconds_keeps_every_rule_as_float(void) {
    for (uint64_t seed = 1; seed <= 4; seed++) {
        setUp();
        random_path(4 * seed, CAPACITY);
        for (uint32_t i = 0; i < count; i++) {
            path[i].clearance = i % 2 == 0 ? 0.1F : 3.0F;
        }
        dwell[0] = 2500.0F;
        fill();
        TEST_ASSERT_TRUE(judge_path() > 3000.0L);
    }
}

static void test_micrometre_pieces_stay_a_millisecond_apart_however_late(void) {
    const float late[] = {0.0F, 3000.0F, 9000.0F, 16370.0F};
    for (int k = 0; k < 4; k++) {
        setUp();
        (void)add(0.0, 0.0, 0.0);
        add_line(2.0, 0.25);
        add_line(1e-4, 1e-6);
        add_line(2.0, 0.25);
        dwell[0] = late[k];
        fill();
        (void)judge_path();
        for (uint32_t i = 1; i < count; i++) {
            TEST_ASSERT_TRUE((double)path[i].t - (double)path[i - 1].t >= 1e-3 - 1e-12);
        }
    }
}

// ---- closed forms

static void test_a_long_line_is_driven_as_a_trapezoid(void) {
    (void)add(0.0, 0.0, 0.0);
    add_line(10.0, 0.25); // 1.5 m/s is reached after 2.25 m, left 2.25 m before the end
    fill();
    for (uint32_t i = 0; i < count; i++) {
        const double x = fmin(0.25 * i, 10.0 - 0.25 * i);
        TEST_ASSERT_FLOAT_WITHIN(1e-5F, fminf(1.5F, sqrtf((float)x)), path[i].v); // v^2 = 2 * 0.5 * x
        const float a = i == 0 || (i > 9 && i <= 31) ? 0.0F : (i <= 9 ? 0.5F : -0.5F);
        TEST_ASSERT_FLOAT_WITHIN(2e-5F, a, path[i].a);
    }
    const double duration = 3.0 + 5.5 / 1.5 + 3.0;
    TEST_ASSERT_DOUBLE_WITHIN(5e-5, duration, sum.duration);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 10.0, sum.length);
    const double energy = (500.0 * 9.80665 * 0.015 * 10.0 + 0.5 * 500.0 * 1.5 * 1.5) / 0.8 + 50.0 * duration;
    TEST_ASSERT_DOUBLE_WITHIN(1e-5 * energy, energy, sum.energy);
}

static void test_a_short_line_is_driven_as_a_triangle(void) {
    const aisle_vehicle_msg msg = {.a_max = 0.5F, .d_max = 1.0F};
    set_vehicle(&msg);
    (void)add(0.0, 0.0, 0.0);
    add_line(3.0, 0.25); // up to sqrt(2) m/s at 2 m
    fill();
    TEST_ASSERT_FLOAT_WITHIN(1e-5F, sqrtf(2.0F), path[8].v);
    TEST_ASSERT_DOUBLE_WITHIN(2e-5, sqrt(2.0) / 0.5 + sqrt(2.0) / 1.0, sum.duration);
}

static void test_one_piece_from_rest_to_rest_lasts_as_long_as_when_it_is_split(void) {
    const double length[3] = {10.0, 4.5, 2.0}; // trapezoid, just a triangle, triangle
    for (int i = 0; i < 3; i++) {
        setUp();
        (void)add(0.0, 0.0, 0.0);
        add_line(length[i], 0.25);
        fill();
        const aisle_profile_sum split = sum;
        count = 0;
        (void)add(0.0, 0.0, 0.0);
        (void)add(length[i], 0.0, 0.0);
        fill();
        TEST_ASSERT_DOUBLE_WITHIN(1e-4, split.duration, sum.duration);
        TEST_ASSERT_DOUBLE_WITHIN(1e-5 * split.energy, split.energy, sum.energy);
        TEST_ASSERT_FALSE(path[0].v > 0.0F || path[1].v > 0.0F || path[1].a > 0.0F || path[1].a < 0.0F);
    }
}

static void test_one_piece_from_rest_to_rest_keeps_to_its_limit(void) {
    (void)add(0.0, 0.0, 0.0);
    add(3.0, 0.0, 0.0)->clearance = 0.4F; // creep: 0.3 m/s
    fill();
    TEST_ASSERT_DOUBLE_WITHIN(1e-5, 0.6 + 0.6 + (3.0 - 0.18) / 0.3, sum.duration);
}

static void test_a_turn_on_the_spot_is_a_trapezoid_of_the_turn_rate(void) {
    const double turn[4] = {0.5 * AISLE_PI, -2.5, 0.5, -0.01};
    for (int i = 0; i < 4; i++) {
        count = 0;
        set_flag(add(0.0, 0.0, 0.3), AISLE_WAYPOINT_TURN_IN_PLACE);
        (void)add(0.0, 0.0, aisle_angle_wrap(0.3 + turn[i]));
        fill();
        const double b = fabs(turn[i]), duration = b > 1.0 ? b + 1.0 : 2.0 * sqrt(b);
        TEST_ASSERT_DOUBLE_WITHIN(1e-6, duration, sum.duration);
        const double around = sqrt(0.5 * 0.5 + 0.35 * 0.35) * b;
        TEST_ASSERT_DOUBLE_WITHIN(1e-4, 500.0 * 9.80665 * 0.015 * around / 0.8 + 50.0 * duration, sum.energy);
        TEST_ASSERT_FALSE(sum.length > 0.0 || sum.risk > 0.0 || path[1].s > 0.0F || path[1].v > 0.0F);
    }
}

static void test_braking_feeds_nothing_back(void) { // two ramps up are paid twice
    (void)add(0.0, 0.0, 0.0);
    add_line(2.0, 0.25);
    fill();
    const aisle_profile_sum once = sum;
    set_flag(&path[count - 1], AISLE_WAYPOINT_STOP);
    add_line(2.0, 0.25);
    fill();
    TEST_ASSERT_DOUBLE_WITHIN(1e-4, 2.0 * once.duration, sum.duration);
    TEST_ASSERT_DOUBLE_WITHIN(1e-2, 2.0 * once.energy, sum.energy);
}

static void test_risk_is_the_mean_over_the_length(void) {
    (void)add(0.0, 0.0, 0.0);
    add_line(4.0, 0.5);
    path[1].clearance = 0.25F; // half the creep clearance, over 0.5 m of 4 m
    path[2].clearance = 0.0F;  // contact
    path[3].clearance = 0.5F;  // just enough
    fill();
    TEST_ASSERT_DOUBLE_WITHIN(1e-7, (0.5 * 0.5 + 0.5 * 1.0) / 4.0, sum.risk);
}

// ---- limits one by one

// Greatest speed on a long line of quarter metres whose pieces were changed by `change`.
static float top_speed(void (*change)(uint32_t i)) {
    count = 0;
    (void)add(0.0, 0.0, 0.0);
    add_line(20.0, 0.25);
    float top = 0.0F;
    for (uint32_t i = 1; i < count; i++) {
        change(i);
    }
    fill();
    for (uint32_t i = 0; i < count; i++) {
        top = fmaxf(top, path[i].v);
    }
    (void)judge_path();
    return top;
}

static void leave(uint32_t i) {
    (void)i;
}
static void reverse(uint32_t i) {
    set_flag(&path[i], AISLE_WAYPOINT_REVERSE);
}
static void bend(uint32_t i) {
    path[i].curvature = i % 2 == 0 ? 0.5F : -0.5F;
}
static void spin(uint32_t i) {
    path[i].theta = aisle_angle_wrap(0.5 * i);
}
static void come_close(uint32_t i) {
    path[i].clearance = 0.49999F;
}
static void keep_just_off(uint32_t i) {
    path[i].clearance = 0.5F;
}

static void test_each_limit_holds_alone(void) {
    TEST_ASSERT_FLOAT_WITHIN(1e-6F, 1.5F, top_speed(leave));
    TEST_ASSERT_FLOAT_WITHIN(1e-6F, 0.3F, top_speed(reverse));
    TEST_ASSERT_FLOAT_WITHIN(1e-6F, 1.0F, top_speed(bend));         // sqrt(0.5 / 0.5)
    TEST_ASSERT_FLOAT_WITHIN(1e-6F, 0.25F / 0.5F, top_speed(spin)); // 1 rad/s
    TEST_ASSERT_FLOAT_WITHIN(1e-6F, 0.3F, top_speed(come_close));
    TEST_ASSERT_FLOAT_WITHIN(1e-6F, 1.5F, top_speed(keep_just_off)); // not below the creep clearance
}

static void test_a_slow_piece_slows_both_its_ends_and_braking_begins_before_it(void) {
    (void)add(0.0, 0.0, 0.0);
    add_line(10.0, 0.25);
    path[20].clearance = 0.1F;
    fill();
    TEST_ASSERT_FLOAT_WITHIN(1e-6F, 0.3F, path[19].v);
    TEST_ASSERT_FLOAT_WITHIN(1e-6F, 0.3F, path[20].v);
    TEST_ASSERT_FLOAT_WITHIN(1e-6F, sqrtf(0.09F + 0.25F), path[18].v);
    TEST_ASSERT_FLOAT_WITHIN(1e-6F, sqrtf(0.09F + 0.25F), path[21].v);
}

static void test_it_rests_at_stops_turns_and_where_reverse_begins_or_ends(void) {
    (void)add(0.0, 0.0, 0.0);
    add_line(10.0, 0.25);
    set_flag(&path[8], AISLE_WAYPOINT_STOP);
    set_flag(&path[16], AISLE_WAYPOINT_TURN_IN_PLACE);
    path[17].x = path[16].x;
    set_flag(&path[26], AISLE_WAYPOINT_REVERSE);
    set_flag(&path[27], AISLE_WAYPOINT_REVERSE);
    fill();
    for (uint32_t i = 0; i < count; i++) {
        const bool rests = i == 0 || i == 8 || i == 16 || i == 17 || i == 25 || i == 27 || i == 40;
        TEST_ASSERT_TRUE(rests ? path[i].v <= 0.0F : path[i].v > 0.0F);
    }
    (void)judge_path();
}

static void test_dwell_delays_what_follows_and_counts_for_nothing_at_the_end(void) {
    (void)add(0.0, 0.0, 0.0);
    add_line(8.0, 0.25);
    set_flag(&path[16], AISLE_WAYPOINT_STOP | AISLE_WAYPOINT_GOAL);
    fill();
    const aisle_profile_sum straight_on = sum;
    const double reached = (double)path[16].t;
    dwell[0] = 2.0F;
    dwell[16] = 7.5F;
    dwell[32] = 100.0F;
    fill();
    TEST_ASSERT_DOUBLE_WITHIN(1e-5, 2.0 + reached, (double)path[16].t);
    TEST_ASSERT_DOUBLE_WITHIN(1e-4, 9.5 + straight_on.duration, sum.duration);
    TEST_ASSERT_DOUBLE_WITHIN(1e-2, 50.0 * 9.5 + straight_on.energy, sum.energy);
    (void)judge_path();
}

static void test_it_may_dwell_before_and_after_a_turn(void) {
    (void)add(0.0, 0.0, 0.0);
    add_line(2.0, 0.25);
    set_flag(&path[count - 1], AISLE_WAYPOINT_TURN_IN_PLACE);
    (void)add(path[count - 1].x, 0.0, 1.0);
    path[count - 1].theta = 0.0;
    add_line(2.0, 0.25);
    dwell[8] = 3.0F;
    dwell[9] = 5.0F;
    fill();
    (void)judge_path();
}

static void test_no_dwells_and_zero_dwells_are_the_same(void) {
    static aisle_waypoint_msg other[CAPACITY];
    random_path(3, 100);
    memset(dwell, 0, sizeof dwell);
    fill();
    memcpy(other, path, sizeof other);
    TEST_ASSERT_EQUAL_INT(AISLE_OK, aisle_profile_fill(&vehicle, NULL, path, count, NULL, &sum));
    TEST_ASSERT_EQUAL_MEMORY(other, path, sizeof other);
}

static void test_a_single_waypoint_is_a_path_without_length(void) {
    (void)add(1.0, 2.0, 3.0);
    sum.risk = 9.0;
    fill();
    TEST_ASSERT_FALSE(path[0].s > 0.0F || path[0].t > 0.0F || path[0].v > 0.0F || path[0].a > 0.0F);
    const aisle_profile_sum nothing = {0.0, 0.0, 0.0, 0.0};
    TEST_ASSERT_EQUAL_MEMORY(&nothing, &sum, sizeof sum);
}

static void test_filling_twice_gives_the_same_bits_and_reads_no_output(void) {
    static aisle_waypoint_msg first[CAPACITY];
    random_path(12, 300);
    fill();
    memcpy(first, path, sizeof first);
    const aisle_profile_sum once = sum;
    for (uint32_t i = 0; i < count; i++) {
        path[i].s = path[i].t = path[i].v = path[i].a = NAN;
    }
    path[0].curvature = path[0].clearance = NAN; // no piece ends there
    fill();
    path[0].curvature = first[0].curvature;
    path[0].clearance = first[0].clearance;
    TEST_ASSERT_EQUAL_MEMORY(first, path, sizeof first);
    TEST_ASSERT_EQUAL_MEMORY(&once, &sum, sizeof sum);
}

static void test_what_is_not_speed_or_time_is_left_alone(void) {
    static aisle_waypoint_msg before[CAPACITY];
    random_path(15, 200);
    for (uint32_t i = 0; i < count; i++) {
        path[i].goal_id = (int32_t)i;
        set_flag(&path[i], AISLE_WAYPOINT_GOAL | 64);
    }
    memcpy(before, path, sizeof before);
    fill();
    for (uint32_t i = 0; i < count; i++) {
        before[i].s = path[i].s;
        before[i].t = path[i].t;
        before[i].v = path[i].v;
        before[i].a = path[i].a;
    }
    TEST_ASSERT_EQUAL_MEMORY(before, path, sizeof before);
}

// ---- geometry

static void test_length_of_an_arc_is_right_for_every_curvature(void) {
    aisle_rng rng = aisle_rng_seed(17);
    for (int trial = 0; trial < 20000; trial++) {
        count = 0;
        const double chord = pow(10.0, uniform(&rng, -6.0, 3.0)), angle = uniform(&rng, -3.0, 3.0);
        (void)add(uniform(&rng, -10.0, 10.0), uniform(&rng, -10.0, 10.0), 0.0);
        aisle_waypoint_msg *w = add(path[0].x + chord * cos(angle), path[0].y + chord * sin(angle), 0.0);
        const double sine = trial % 4 == 0 ? uniform(&rng, 0.005, 0.9999) : pow(10.0, uniform(&rng, -12.0, -0.01));
        w->curvature = (float)(2.0 * sine / chord * (trial % 2 == 0 ? 1.0 : -1.0));
        const long double length = judge_length(1), found = ld(aisle_piece_length(&path[0], w));
        TEST_ASSERT_TRUE(fabsl(found - length) <= 1e-12L * length);
    }
}

static void test_length_of_lines_half_circles_and_turns(void) {
    (void)add(1.0, 1.0, 0.0);
    aisle_waypoint_msg *w = add(4.0, 5.0, 0.0);
    TEST_ASSERT_DOUBLE_WITHIN(1e-15, 5.0, aisle_piece_length(&path[0], w));
    w->curvature = 1e-38F;
    TEST_ASSERT_DOUBLE_WITHIN(1e-15, 5.0, aisle_piece_length(&path[0], w));
    w->curvature = -0.4F; // float 0.4 is a little above: the chord is longer than the diameter
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, 2.5 * AISLE_PI, aisle_piece_length(&path[0], w));
    set_flag(&path[0], AISLE_WAYPOINT_TURN_IN_PLACE);
    TEST_ASSERT_FALSE(aisle_piece_length(&path[0], w) > 0.0);
}

static void test_turn_goes_the_short_way(void) {
    (void)add(0.0, 0.0, 3.0);
    (void)add(0.0, 0.0, -3.0);
    TEST_ASSERT_DOUBLE_WITHIN(1e-15, 2.0 * AISLE_PI - 6.0, aisle_piece_turn(&path[0], &path[1]));
    TEST_ASSERT_DOUBLE_WITHIN(1e-15, 6.0 - 2.0 * AISLE_PI, aisle_piece_turn(&path[1], &path[0]));
}

// ---- refusals

static void assert_refused(void) { // nothing is changed
    static aisle_waypoint_msg before[CAPACITY + 1];
    memcpy(before, path, sizeof before);
    const aisle_profile_sum old = sum;
    TEST_ASSERT_EQUAL_INT(AISLE_ERR_ARG, aisle_profile_fill(&vehicle, NULL, path, count, dwell, &sum));
    TEST_ASSERT_EQUAL_MEMORY(before, path, sizeof before);
    TEST_ASSERT_EQUAL_MEMORY(&old, &sum, sizeof sum);
}

static void start_line(void) {
    setUp();
    sum.energy = 42.0;
    (void)add(0.0, 0.0, 0.0);
    add_line(4.0, 0.5);
}

static void test_missing_arguments_are_refused(void) {
    start_line();
    TEST_ASSERT_EQUAL_INT(AISLE_ERR_ARG, aisle_profile_fill(NULL, NULL, path, count, NULL, &sum));
    TEST_ASSERT_EQUAL_INT(AISLE_ERR_ARG, aisle_profile_fill(&vehicle, NULL, NULL, count, NULL, &sum));
    TEST_ASSERT_EQUAL_INT(AISLE_ERR_ARG, aisle_profile_fill(&vehicle, NULL, path, count, NULL, NULL));
    count = 0;
    assert_refused();
}

static void test_numbers_not_finite_or_out_of_range_are_refused_wherever_they_are(void) {
    const double wild[] = {(double)NAN, (double)INFINITY, -(double)INFINITY, 1.0001e5, -1e300};
    for (uint32_t i = 0; i < 9; i += 4) {
        for (int k = 0; k < 15; k++) {
            start_line();
            double *const member[3] = {&path[i].x, &path[i].y, &path[i].theta};
            *member[k / 5] = wild[k % 5];
            assert_refused();
        }
        const float bad[] = {NAN, INFINITY, -INFINITY};
        for (int k = 0; k < 6 && i > 0; k++) {
            start_line();
            float *const member[2] = {&path[i].curvature, &path[i].clearance};
            *member[k / 3] = bad[k % 3];
            assert_refused();
        }
    }
}

static void test_curvature_and_clearance_of_a_turn_must_be_finite_too(void) {
    for (int k = 0; k < 2; k++) {
        start_line();
        set_flag(&path[2], AISLE_WAYPOINT_TURN_IN_PLACE);
        path[3].x = path[2].x;
        *(k == 0 ? &path[3].curvature : &path[3].clearance) = NAN;
        assert_refused();
    }
}

static void test_a_negative_clearance_is_refused(void) {
    start_line();
    path[3].clearance = -0.001F;
    assert_refused();
}

static void test_a_piece_without_length_is_refused_unless_it_turns(void) {
    start_line();
    path[3].x = path[2].x;
    assert_refused();
    path[3].x = path[2].x + 0.9e-9;
    assert_refused();
    set_flag(&path[2], AISLE_WAYPOINT_TURN_IN_PLACE);
    fill();
    start_line();
    path[3].x = path[2].x + 1.1e-9;
    fill();
    (void)judge_path();
}

static void test_a_turn_that_moves_is_refused(void) {
    start_line();
    set_flag(&path[2], AISLE_WAYPOINT_TURN_IN_PLACE);
    assert_refused();
    path[3].x = path[2].x - 1.1e-9;
    assert_refused();
}

static void test_an_arc_with_a_chord_longer_than_its_diameter_is_refused(void) {
    start_line();
    path[3].curvature = 4.00001F;
    assert_refused();
    path[3].curvature = -4.1F;
    assert_refused();
    path[3].curvature = 4.000001F; // within what float can tell
    fill();
    path[3].curvature = -4.0F;
    fill();
}

static void test_dwells_that_are_negative_or_not_finite_or_on_the_move_are_refused(void) {
    const float bad[] = {-1.0F, NAN, INFINITY, -INFINITY};
    for (uint32_t i = 0; i < 9; i += 4) {
        for (int k = 0; k < 4; k++) {
            start_line();
            set_flag(&path[4], AISLE_WAYPOINT_STOP);
            dwell[i] = bad[k];
            assert_refused();
        }
    }
    start_line();
    dwell[4] = 1.0F;
    assert_refused();
}

static void test_more_time_than_float_can_tell_is_refused_and_the_geometry_stays(void) {
    start_line();
    dwell[0] = 16370.0F;
    fill();
    const aisle_profile_sum old = sum;
    dwell[0] = 16384.0F;
    TEST_ASSERT_EQUAL_INT(AISLE_ERR_CAPACITY, aisle_profile_fill(&vehicle, NULL, path, count, dwell, &sum));
    TEST_ASSERT_EQUAL_MEMORY(&old, &sum, sizeof sum);
    for (uint32_t i = 0; i < count; i++) {
        TEST_ASSERT_EQUAL_DOUBLE(0.5 * i, path[i].x);
    }
}

static void test_a_vehicle_slow_beyond_reason_is_refused_not_divided_by(void) {
    const float slow[] = {1e-20F, FLT_MIN};
    for (int i = 0; i < 6; i++) {
        start_line();
        path[2].theta = 3.0;
        set_flag(&path[4], AISLE_WAYPOINT_STOP);
        const float v = slow[i % 2];
        const aisle_vehicle_msg msg = {
            .v_max = i / 2 == 0 ? v : 0.0F, .a_max = i / 2 == 1 ? v : 0.0F, .omega_max = i / 2 == 2 ? v : 0.0F};
        set_vehicle(&msg);
        const aisle_status status = aisle_profile_fill(&vehicle, NULL, path, count, NULL, &sum);
        TEST_ASSERT_EQUAL_INT(AISLE_ERR_CAPACITY, status);
    }
}

// ---- speed-limit zones

enum { BLOCK = 1 << 20 };
static aisle_layout layout;
static aisle_layout_msg layout_msg;

static void clear_zones(void) {
    memset(&layout_msg, 0, sizeof layout_msg);
    layout_msg.map_id = 1;
    layout_msg.map_revision = 1;
    layout_msg.num_parts = 1;
    layout_msg.x_min = layout_msg.y_min = -20.0;
    layout_msg.x_max = layout_msg.y_max = 20.0;
    layout_msg.resolution = 1.0F;
}

static aisle_polygon_msg *add_zone(float value, double (*v)[2], int16_t n) {
    aisle_polygon_msg *zone = &layout_msg.polygons[layout_msg.num_polygons++];
    zone->id = layout_msg.num_polygons;
    zone->kind = AISLE_POLYGON_SPEED_LIMIT;
    zone->value = value;
    zone->num_vertices = n;
    memcpy(zone->vertices, v, (size_t)n * sizeof *v);
    return zone;
}

static aisle_polygon_msg *add_box(float value, double x0, double y0, double x1, double y1) {
    double box[4][2] = {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}};
    return add_zone(value, box, 4);
}

static void take_zones(void) { // layout_msg as the layout in force
    static unsigned char block[BLOCK + AISLE_ARENA_ALIGN];
    const aisle_limits limits = {.cells = 4096, .polygons = 16, .vertices = 256, .open_nodes = 1024, .requests = 1};
    unsigned char *start = block;
    start += (AISLE_ARENA_ALIGN - (uintptr_t)block % AISLE_ARENA_ALIGN) % AISLE_ARENA_ALIGN;
    aisle_arena arena = aisle_arena_over(start, BLOCK);
    memset(&layout, 0, sizeof layout);
    aisle_layout_carve(&layout, &arena, &limits);
    TEST_ASSERT_FALSE(arena.overflow);
    uint32_t crc = 0;
    for (int16_t i = 0; i < layout_msg.num_polygons; i++) {
        uint8_t bytes[512];
        size_t size;
        TEST_ASSERT_EQUAL_INT(
            AISLE_OK, aisle_msg_encode_body(AISLE_MSG_POLYGON, &layout_msg.polygons[i], bytes, sizeof bytes, &size));
        crc = aisle_crc32(crc, bytes, size);
    }
    layout_msg.crc32 = (int32_t)crc;
    layout_msg.total_polygons = layout_msg.num_polygons;
    aisle_refusal why;
    TEST_ASSERT_EQUAL_INT(AISLE_OK, aisle_layout_take_part(&layout, &layout_msg, &why));
    aisle_layout_commit(&layout);
    while (aisle_layout_build(&layout, 1000) == AISLE_BUSY) {
    }
    TEST_ASSERT_TRUE(aisle_layout_is_in_force(&layout));
}

static void fill_with_zones(void) {
    TEST_ASSERT_EQUAL_INT(AISLE_OK, aisle_profile_fill(&vehicle, &layout, path, count, dwell, &sum));
}

// Quarter metres along x from 0 to 10 at y = 0; footprint 1.0 x 0.7 m.
static void drive_line(void) {
    take_zones();
    count = 0;
    (void)add(0.0, 0.0, 0.0);
    add_line(10.0, 0.25);
    fill_with_zones();
}

static bool is_slow(uint32_t i, float value) {
    return path[i].v <= value;
}

static void test_a_zone_holds_wherever_the_footprint_touches_it_and_nowhere_else(void) {
    clear_zones();
    (void)add_box(0.4F, 5.05, 0.3, 5.35, 3.0); // beside the origin's way, under the footprint's flank
    drive_line();
    for (uint32_t i = 4; i < count - 4; i++) { // pieces from x - 0.5 = 5.35 back to x + 0.5 = 5.05: 4.55 to 5.85
        TEST_ASSERT_EQUAL_INT(i >= 18 && i <= 24, is_slow(i, 0.4F));
    }
    TEST_ASSERT_FLOAT_WITHIN(1e-6F, 0.4F, path[21].v);
}

static void test_a_zone_a_hand_away_does_nothing(void) {
    clear_zones();
    (void)add_box(0.4F, 5.05, 0.36, 5.35, 3.0);
    drive_line();
    TEST_ASSERT_FLOAT_WITHIN(1e-6F, 1.5F, path[20].v);
}

static void test_a_zone_that_is_just_touched_holds(void) {
    clear_zones();
    (void)add_box(0.4F, 5.05, 0.35, 5.35, 3.0);
    drive_line();
    TEST_ASSERT_TRUE(is_slow(20, 0.4F));
}

static void test_the_lowest_of_all_limits_holds(void) {
    clear_zones();
    (void)add_box(0.8F, 2.0, -1.0, 8.0, 1.0);
    (void)add_box(0.4F, 5.0, -1.0, 5.2, 1.0);
    (void)add_box(0.6F, 4.0, -1.0, 6.0, 1.0);
    (void)add_box(9.0F, -19.0, -19.0, 19.0, 19.0); // above v_max: no licence
    drive_line();
    TEST_ASSERT_FLOAT_WITHIN(1e-6F, 0.4F, path[20].v);
    for (uint32_t i = 0; i < count; i++) {
        TEST_ASSERT_TRUE(path[i].v <= 1.5F && (i < 6 || i > 34 || is_slow(i, 0.8F)));
    }
}

static void test_other_kinds_of_areas_set_no_limit(void) {
    clear_zones();
    add_box(0.0F, 4.0, -1.0, 6.0, 1.0)->kind = AISLE_POLYGON_DIRECTED;
    add_box(0.4F, 4.0, -1.0, 6.0, 1.0)->kind = AISLE_POLYGON_PENALTY;
    drive_line();
    TEST_ASSERT_FLOAT_WITHIN(1e-6F, 1.5F, path[20].v);
}

static void test_a_turn_on_the_spot_in_a_zone_takes_its_time_as_ever(void) {
    clear_zones();
    (void)add_box(0.01F, -2.0, -2.0, 2.0, 2.0);
    take_zones();
    set_flag(add(0.0, 0.0, 0.0), AISLE_WAYPOINT_TURN_IN_PLACE);
    (void)add(0.0, 0.0, 1.0);
    fill_with_zones();
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, 2.0, sum.duration);
}

static void test_a_layout_not_in_force_is_refused(void) {
    static unsigned char block[BLOCK + AISLE_ARENA_ALIGN];
    const aisle_limits limits = {.cells = 4096, .polygons = 16, .vertices = 256, .open_nodes = 1024, .requests = 1};
    unsigned char *start = block;
    start += (AISLE_ARENA_ALIGN - (uintptr_t)block % AISLE_ARENA_ALIGN) % AISLE_ARENA_ALIGN;
    aisle_arena arena = aisle_arena_over(start, BLOCK);
    memset(&layout, 0, sizeof layout);
    aisle_layout_carve(&layout, &arena, &limits);
    start_line();
    TEST_ASSERT_EQUAL_INT(AISLE_ERR_ARG, aisle_profile_fill(&vehicle, &layout, path, count, dwell, &sum));
}

// A needle whose tip is at (x, y), pointing down.
static void add_needle(float value, double x, double y) {
    double v[3][2] = {{x, y}, {x + 0.05, y + 1.0}, {x - 0.05, y + 1.0}};
    (void)add_zone(value, v, 3);
}

// Is the one piece of the path slowed by the zones?
static bool is_held(void) {
    take_zones();
    fill();
    const double without = sum.duration;
    fill_with_zones();
    return sum.duration > 1.01 * without;
}

static void test_a_zone_under_the_bulge_of_an_arc_between_its_ends_holds(void) {
    const aisle_vehicle_msg disc = {.footprint_radius = 0.3F};
    set_vehicle(&disc);
    const double bulge = 10.0 - sqrt(100.0 - 0.49 * 0.49); // of a right turn, 12 mm over the chord
    for (int i = 0; i < 2; i++) {
        clear_zones();
        add_needle(1e-3F, 0.49, 0.3 + bulge + (i == 0 ? -1e-4 : 0.0501));
        count = 0;
        (void)add(0.0, 0.0, 0.0);
        add(0.98, 0.0, 0.0)->curvature = -0.1F;
        TEST_ASSERT_EQUAL_INT(i == 0, is_held());
    }
}

static void test_a_zone_under_the_round_of_a_corner_that_turns_holds(void) {
    const double r = sqrt(0.5 * 0.5 + 0.35 * 0.35), corner = atan2(0.35, 0.5), b = 0.08;
    clear_zones();
    add_needle(1e-6F, 0.0, r - 1e-4); // the chord of the corner's way stays 0.49 mm below r
    (void)add(0.0, 0.0, 0.5 * AISLE_PI - corner - 0.5 * b);
    (void)add(1e-6, 0.0, 0.5 * AISLE_PI - corner + 0.5 * b);
    TEST_ASSERT_TRUE(is_held());
}

static void test_a_zone_over_the_dip_between_corners_that_turn_does_not_hold(void) {
    clear_zones();
    add_needle(1e-6F, 0.0, 0.35 / cos(0.195) + 0.051); // the hull of both ends would reach 32 mm beyond
    (void)add(0.0, 0.0, -0.195);
    (void)add(1e-6, 0.0, 0.195);
    TEST_ASSERT_FALSE(is_held());
}

static double brute_segment_point(aisle_vec2 a, aisle_vec2 b, aisle_vec2 p) {
    const double sx = b.x - a.x, sy = b.y - a.y, square = sx * sx + sy * sy;
    const double along = square > 0.0 ? fmin(1.0, fmax(0.0, ((p.x - a.x) * sx + (p.y - a.y) * sy) / square)) : 0.0;
    return hypot(p.x - a.x - along * sx, p.y - a.y - along * sy);
}

static bool brute_inside(const aisle_vec2 *v, uint32_t n, aisle_vec2 p) {
    bool inside = n >= 3;
    for (uint32_t i = 0; i < n; i++) {
        const aisle_vec2 a = v[i], b = v[(i + 1) % n];
        inside = inside && (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x) >= 0.0;
    }
    return inside;
}

// Gap between two polygons: 0 if a corner of one lies in the other (crossings without such are met between other
// samples).
static double brute_gap(const aisle_vec2 *a, uint32_t n, const aisle_vec2 *b, uint32_t m) {
    double gap = 1e9;
    for (uint32_t i = 0; i < n; i++) {
        for (uint32_t k = 0; k < m; k++) {
            gap = fmin(gap, brute_segment_point(a[i], a[(i + 1) % n], b[k]));
            gap = fmin(gap, brute_segment_point(b[k], b[(k + 1) % m], a[i]));
        }
    }
    for (uint32_t i = 0; i < n || i < m; i++) {
        const bool in = brute_inside(b, m, a[i % n]) || brute_inside(a, n, b[i % m]);
        gap = in ? 0.0 : gap;
    }
    return gap;
}

enum { SAMPLES = 400 };

// Least gap between the footprint and the zone at SAMPLES + 1 poses of the one piece of the path.
static double brute_least_gap(const aisle_vec2 *zone, uint32_t m) {
    const aisle_waypoint_msg *from = &path[0], *to = &path[1];
    const double k = (double)to->curvature, length = (double)judge_length(1);
    const double turn = remainder(to->theta - from->theta, 2.0 * AISLE_PI);
    const double dir = atan2(to->y - from->y, to->x - from->x) - 0.5 * k * length; // tangent at the start
    double least = 1e9;
    for (int i = 0; i <= SAMPLES; i++) {
        const double u = (double)i / SAMPLES, l = u * length, angle = dir + k * l, theta = from->theta + u * turn;
        const double x = fabs(k) > 1e-6 ? (sin(angle) - sin(dir)) / k : l * cos(dir);
        const double y = fabs(k) > 1e-6 ? (cos(dir) - cos(angle)) / k : l * sin(dir);
        aisle_vec2 body[AISLE_SHAPE_VERTICES_MAX];
        for (uint32_t j = 0; j < vehicle.n; j++) {
            const aisle_vec2 p = vehicle.footprint[j];
            body[j] = aisle_vec2_of(from->x + x + p.x * cos(theta) - p.y * sin(theta),
                                    from->y + y + p.x * sin(theta) + p.y * cos(theta));
        }
        least = fmin(least, brute_gap(body, vehicle.n, zone, m) - vehicle.radius);
    }
    return least;
}

static void random_zone(aisle_rng *rng, aisle_vec2 *zone, double (*v)[2], int16_t n) {
    const double x = uniform(rng, -4.0, 4.0), y = uniform(rng, -4.0, 4.0), r = uniform(rng, 0.02, 1.5);
    for (int16_t i = 0; i < n; i++) {
        const double angle = 2.0 * AISLE_PI * (i + 0.7 * (double)aisle_rng_float(rng)) / n;
        v[i][0] = x + r * cos(angle);
        v[i][1] = y + r * sin(angle);
        zone[i] = aisle_vec2_of(v[i][0], v[i][1]);
    }
}

// Footprints: the usual one, a rounded wedge about a far origin, a disc.
static void set_body(uint64_t seed) {
    aisle_vehicle_msg msg;
    memset(&msg, 0, sizeof msg);
    if (seed % 3 == 1) {
        const double wedge[3][2] = {{-0.1, -0.4}, {1.4, 0.0}, {-0.1, 0.4}};
        msg.num_vertices = 3;
        memcpy(msg.footprint, wedge, sizeof wedge);
    }
    msg.footprint_radius = seed % 3 == 0 ? 0.0F : 0.2F;
    set_vehicle(&msg);
}

static void test_zones_agree_with_brute_force_for_2000_of_2000_pieces(void) {
    static const style how = {.piece_max = 4.0, .radius_min = 0.5, .free_heading = true, .tight = false};
    uint32_t held = 0, free_of_it = 0;
    for (uint64_t seed = 0; seed < 2000; seed++) {
        aisle_rng rng = aisle_rng_seed(seed);
        setUp();
        set_body(seed);
        clear_zones();
        aisle_vec2 zone[8];
        double v[8][2];
        const int16_t n = (int16_t)(3 + aisle_rng_below(&rng, 6));
        random_zone(&rng, zone, v, n);
        (void)add_zone(0.01F, v, n);
        take_zones();
        (void)add(uniform(&rng, -2.0, 2.0), uniform(&rng, -2.0, 2.0), uniform(&rng, -3.0, 3.0));
        add_piece(&rng, &how, seed % 5 == 0);
        fill();
        const double without = sum.duration, gap = brute_least_gap(zone, (uint32_t)n);
        const double spacing = 2.0 * (sum.length + 3.2 * vehicle.outer_radius) / SAMPLES; // travel between samples
        fill_with_zones();
        if (gap <= 0.0) {
            held++;
            TEST_ASSERT_TRUE(sum.duration > (sum.length - 0.001) / 0.01);
        } else if (gap > 0.05 + 1e-5 + spacing) {
            free_of_it++;
            TEST_ASSERT_EQUAL_DOUBLE(without, sum.duration);
        }
    }
    TEST_ASSERT_GREATER_THAN_UINT32(200, held);
    TEST_ASSERT_GREATER_THAN_UINT32(300, free_of_it);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_every_rule_holds_and_no_speed_could_be_higher_for_200_of_200_paths);
    RUN_TEST(test_every_rule_holds_of_paths_under_way_for_400_of_400);
    RUN_TEST(test_unbounded_a_path_goes_on_with_the_speeds_it_had);
    RUN_TEST(test_at_rest_and_unbounded_it_is_the_plain_fill);
    RUN_TEST(test_with_ramps_every_rule_holds_and_no_piece_could_be_driven_faster_for_400_of_400);
    RUN_TEST(test_a_line_from_a_start_in_motion_gets_both_its_ramps);
    RUN_TEST(test_without_room_for_ramps_it_is_the_plain_fill_and_the_first_pieces_get_what_there_is);
    RUN_TEST(test_a_waypoint_is_found_again_behind_the_ramps_put_before_it);
    RUN_TEST(test_the_first_pieces_are_left_whole_if_they_are_to_be);
    RUN_TEST(test_bounds_slow_the_first_metres_alone);
    RUN_TEST(test_a_start_too_fast_for_what_follows_is_told_and_begins_as_fast_as_brakes_allow);
    RUN_TEST(test_a_start_that_makes_no_sense_is_refused_and_changes_nothing);
    RUN_TEST(test_where_it_must_rest_it_cannot_begin_in_motion);
    RUN_TEST(test_a_path_of_1024_waypoints_and_3000_seconds_keeps_every_rule_as_float);
    RUN_TEST(test_micrometre_pieces_stay_a_millisecond_apart_however_late);
    RUN_TEST(test_a_long_line_is_driven_as_a_trapezoid);
    RUN_TEST(test_a_short_line_is_driven_as_a_triangle);
    RUN_TEST(test_one_piece_from_rest_to_rest_lasts_as_long_as_when_it_is_split);
    RUN_TEST(test_one_piece_from_rest_to_rest_keeps_to_its_limit);
    RUN_TEST(test_a_turn_on_the_spot_is_a_trapezoid_of_the_turn_rate);
    RUN_TEST(test_braking_feeds_nothing_back);
    RUN_TEST(test_risk_is_the_mean_over_the_length);
    RUN_TEST(test_each_limit_holds_alone);
    RUN_TEST(test_a_slow_piece_slows_both_its_ends_and_braking_begins_before_it);
    RUN_TEST(test_it_rests_at_stops_turns_and_where_reverse_begins_or_ends);
    RUN_TEST(test_dwell_delays_what_follows_and_counts_for_nothing_at_the_end);
    RUN_TEST(test_it_may_dwell_before_and_after_a_turn);
    RUN_TEST(test_no_dwells_and_zero_dwells_are_the_same);
    RUN_TEST(test_a_single_waypoint_is_a_path_without_length);
    RUN_TEST(test_filling_twice_gives_the_same_bits_and_reads_no_output);
    RUN_TEST(test_what_is_not_speed_or_time_is_left_alone);
    RUN_TEST(test_length_of_an_arc_is_right_for_every_curvature);
    RUN_TEST(test_length_of_lines_half_circles_and_turns);
    RUN_TEST(test_turn_goes_the_short_way);
    RUN_TEST(test_missing_arguments_are_refused);
    RUN_TEST(test_numbers_not_finite_or_out_of_range_are_refused_wherever_they_are);
    RUN_TEST(test_curvature_and_clearance_of_a_turn_must_be_finite_too);
    RUN_TEST(test_a_negative_clearance_is_refused);
    RUN_TEST(test_a_piece_without_length_is_refused_unless_it_turns);
    RUN_TEST(test_a_turn_that_moves_is_refused);
    RUN_TEST(test_an_arc_with_a_chord_longer_than_its_diameter_is_refused);
    RUN_TEST(test_dwells_that_are_negative_or_not_finite_or_on_the_move_are_refused);
    RUN_TEST(test_more_time_than_float_can_tell_is_refused_and_the_geometry_stays);
    RUN_TEST(test_a_vehicle_slow_beyond_reason_is_refused_not_divided_by);
    RUN_TEST(test_a_zone_holds_wherever_the_footprint_touches_it_and_nowhere_else);
    RUN_TEST(test_a_zone_a_hand_away_does_nothing);
    RUN_TEST(test_a_zone_that_is_just_touched_holds);
    RUN_TEST(test_the_lowest_of_all_limits_holds);
    RUN_TEST(test_other_kinds_of_areas_set_no_limit);
    RUN_TEST(test_a_turn_on_the_spot_in_a_zone_takes_its_time_as_ever);
    RUN_TEST(test_a_layout_not_in_force_is_refused);
    RUN_TEST(test_a_zone_under_the_bulge_of_an_arc_between_its_ends_holds);
    RUN_TEST(test_a_zone_under_the_round_of_a_corner_that_turns_holds);
    RUN_TEST(test_a_zone_over_the_dip_between_corners_that_turn_does_not_hold);
    RUN_TEST(test_zones_agree_with_brute_force_for_2000_of_2000_pieces);
    return UNITY_END();
}
