#include "plan/verify_moving.h"

#include "cases.h"
#include "test_verify_fixture.h"

// usage: test_verify_moving [number of random cases]
static int random_cases = CASES(1000);

static aisle_mover mover[AISLE_MOVERS_MAX];
static aisle_movers movers;
static aisle_goal_msg goals[8];
static aisle_moving_request asked;
static aisle_verify_moving moving;
static aisle_moving_stamp moving_stamp;

enum { NOW = 1000000000 };

static void empty_world(void) {
    world_begin(-90.0, -90.0, 90.0, 90.0, 1.0F);
    world_build();
}

static aisle_mover *add_mover(double x, double y, double radius, double v_bound) {
    aisle_mover *m = &mover[movers.count++];
    *m = (aisle_mover){
        .id = 500 + (int32_t)movers.count, .at = {x, y}, .radius = radius, .v_bound = v_bound, .utime = NOW};
    movers.mover = mover;
    return m;
}

// The path goes out; the vehicle is at its start, at rest.
static void ask(double lease) {
    asked = (aisle_moving_request){.vehicle = &vehicle,
                                   .movers = &movers,
                                   .bytes = path_bytes,
                                   .size = path_size,
                                   .path = &path,
                                   .at_piece = path.num_waypoints > 1 ? 1 : 0,
                                   .goals = goals,
                                   .num_goals = 1,
                                   .now_us = NOW,
                                   .lease = lease};
    goals[0] = path_goal;
}

static aisle_status prove_in_steps_of(uint32_t units) {
    aisle_status status;
    spent = 0;
    aisle_verify_moving_start(&moving, &asked);
    do {
        const uint32_t before = spent;
        moving_stamp = (aisle_moving_stamp){1, 1, 1, 1.0F};
        status = aisle_verify_moving_step(&moving, units, &spent, &moving_stamp);
        TEST_ASSERT_TRUE(status == AISLE_BUSY ? spent - before == units : spent - before <= units);
        const bool given = moving_stamp.size > 0 && moving_stamp.digest != 0 && moving_stamp.until_us != 0;
        const bool none = moving_stamp.size == 0 && moving_stamp.digest == 0 && moving_stamp.until_us == 0;
        TEST_ASSERT_TRUE(status == AISLE_OK ? given : none);
    } while (status == AISLE_BUSY);
    return status;
}

static aisle_status prove(void) {
    return prove_in_steps_of(UINT32_MAX);
}

static void assert_proved(void) {
    TEST_ASSERT_EQUAL(AISLE_OK, prove());
}

static void assert_refused(void) {
    TEST_ASSERT_EQUAL(AISLE_ERR_DATA, prove());
    TEST_ASSERT_FALSE(moving.is_unfit);
}

static void assert_unfit(void) {
    TEST_ASSERT_EQUAL(AISLE_ERR_DATA, prove());
    TEST_ASSERT_TRUE(moving.is_unfit);
}

static void drive(double v) {
    path_end();
    path_drive_gently(v);
    TEST_ASSERT_EQUAL(AISLE_VERIFY_NONE, verified());
}

// 20 m straight on, 0.8 m/s from (2, 0) to (18, 0).
static void straight_path(void) {
    path_begin(0.0, 0.0, 0.0);
    for (int i = 0; i < 10; i++) {
        path_line(2.0);
    }
    drive(0.8);
}

void setUp(void) {
    static bool built;
    if (!built) {
        empty_world();
        built = true;
    }
    vehicle_box(0.5, 0.6, 0.7, 0.05);
    vehicle.margin = 0.1;
    memset(&movers, 0, sizeof movers);
    straight_path();
    ask(1.0);
}
void tearDown(void) {}

// ---- the judge: braking from every instant, step by step, in long double

typedef struct tick { // of the motion along the path; between two of them the acceleration is constant
    long double t, u, v;
    int piece;
    bool turns;
} tick;

enum { CELLS = 250, TICKS = 40 * (CELLS + 4) };
static tick ticks[TICKS];
static int tick_count;

static void push_tick(long double t, int piece, long double u, long double v, bool turns) {
    TEST_ASSERT_LESS_THAN(TICKS, tick_count);
    ticks[tick_count++] = (tick){t, u, v, piece, turns};
}

static long double dwell_before(int i) { // s at waypoint i - 1
    int k = 0;
    for (int j = 0; j < i - 1; j++) {
        k += (path.waypoints[j].flags & AISLE_WAYPOINT_GOAL) != 0 ? 1 : 0;
    }
    return (path.waypoints[i - 1].flags & AISLE_WAYPOINT_GOAL) != 0 ? (long double)goals[k].dwell : 0.0L;
}

typedef struct course_of { // how a piece is driven
    long double length, square0, square1, peak, up, down;
    bool rests;
} course_of;

static long double square_at(const course_of *c, long double s) {
    if (!c->rests) {
        return c->square0 + (c->square1 - c->square0) * s / c->length;
    }
    return fminl(c->peak * c->peak, 2.0L * fminl(c->up * s, c->down * (c->length - s)));
}

static long double duration(const course_of *c) {
    if (!c->rests) {
        return 2.0L * c->length / (sqrtl(c->square0) + sqrtl(c->square1));
    }
    return (long double)trapezoid_seconds((double)c->length, (double)c->peak, (double)c->up, (double)c->down);
}

static course_of course_at(int i, const stretch *s, bool turns) {
    const aisle_waypoint_msg *a = &path.waypoints[i - 1], *b = &path.waypoints[i];
    course_of c = {.length = turns ? fabsl(s->turn) : s->length,
                   .square0 = (long double)a->v * (long double)a->v,
                   .square1 = (long double)b->v * (long double)b->v,
                   .peak = (long double)vehicle.omega_max,
                   .up = (long double)(turns ? vehicle.alpha_max : vehicle.a_max),
                   .down = (long double)(turns ? vehicle.alpha_max : vehicle.d_max)};
    c.rests = turns || (!(a->v > 0.0F) && !(b->v > 0.0F));
    if (c.rests && !turns) {
        const long double time = (long double)b->t - (long double)a->t - dwell_before(i),
                          q = 0.5L / c.up + 0.5L / c.down;
        c.peak = (time - sqrtl(fmaxl(time * time - 4.0L * q * c.length, 0.0L))) / (2.0L * q);
    }
    return c;
}

// Ticks of piece i from u on; *real: square of the real speed, pulled towards the path's.
static long double drive_piece(int i, long double u, long double clock, long double *real, int pull) {
    const stretch s = stretch_at(i);
    const bool turns = turns_at(i - 1);
    const course_of c = course_at(i, &s, turns);
    for (int k = 0; k <= CELLS; k++) {
        const long double part = u + (1.0L - u) * k / CELLS, told = fmaxl(square_at(&c, part * c.length), 0.0L);
        const long double ds = k > 0 ? (1.0L - u) * c.length / CELLS : 0.0L, before = sqrtl(fmaxl(*real, 0.0L));
        *real = k == 0 && pull == 0 ? told : *real + 2.0L * (pull > 0 ? c.up : -c.down) * ds;
        *real = pull == 0 ? told : (pull > 0 ? fminl(*real, told) : fmaxl(*real, told));
        const long double v = sqrtl(*real);
        clock += k > 0 && ds > 0.0L ? 2.0L * ds / (before + v) : 0.0L;
        push_tick(clock, i, part, v, turns);
    }
    return clock;
}

// The whole motion from the vehicle's place; pull: -1 its real speed is above the path's, 1 below, 0 as the path's.
static void drive_on(int pull) {
    long double clock = 0.0L, real = (long double)asked.v * (long double)asked.v;
    pull = turns_at((int)asked.at_piece - 1) ? 0 : pull;
    tick_count = 0;
    for (int i = (int)asked.at_piece; i < path.num_waypoints; i++) {
        const bool first = i == (int)asked.at_piece, turns = turns_at(i - 1);
        const stretch s = stretch_at(i);
        const long double slot = (long double)path.waypoints[i].t - (long double)path.waypoints[i - 1].t;
        const long double u = first ? (long double)asked.at_u : 0.0L;
        if (turns && fabsl(s.turn) <= 5e-7L) {
            push_tick(first ? 0.0L : clock, i, u, 0.0L, true);
            clock += first ? (1.0L - u) * slot : slot;
            push_tick(clock, i, 1.0L, 0.0L, true);
            real = 0.0L;
            pull = 0;
            continue;
        }
        const course_of c = course_at(i, &s, turns);
        if (!first && (c.rests || !(c.square0 > 0.0L))) {
            push_tick(clock, i, 0.0L, 0.0L, turns);
            clock += c.rests && !turns ? dwell_before(i) : fmaxl(slot - duration(&c), 0.0L);
        }
        clock = drive_piece(i, u, clock, &real, pull);
        if (turns || !(path.waypoints[i].v > 0.0F)) {
            push_tick(clock, i, 1.0L, 0.0L, turns); // if it was too fast to rest there
            real = 0.0L;
            pull = 0;
        }
    }
}

static tick nominal_at(long double t) {
    int lo = 0, hi = tick_count - 1;
    if (t <= ticks[0].t) {
        return ticks[0];
    }
    if (t >= ticks[hi].t) {
        return ticks[hi];
    }
    while (hi - lo > 1) {
        const int middle = (lo + hi) / 2;
        *(ticks[middle].t <= t ? &lo : &hi) = middle;
    }
    const tick *a = &ticks[lo], *b = &ticks[hi];
    if (a->piece != b->piece) {
        return *b;
    }
    const long double time = b->t - a->t, part = time > 0.0L ? (t - a->t) / time : 0.0L;
    const long double v = a->v + (b->v - a->v) * part, mean = a->v + b->v;
    tick at = *a;
    at.u += mean > 0.0L ? (b->u - a->u) * part * (a->v + v) / mean : 0.0L; // of a wait it stays
    at.v = v;
    return at;
}

static bool overshot; // it would have gone on beyond where the path rests

// x m (rad) further on, no farther than where it rests next.
static tick moved_by(tick at, long double x) {
    overshot = false;
    for (;;) {
        const stretch s = stretch_at(at.piece);
        const long double length = at.turns ? fabsl(s.turn) : s.length, left = (1.0L - at.u) * length;
        if (x <= left) {
            at.u += length > 0.0L ? x / length : 0.0L;
            return at;
        }
        if (at.turns || at.piece + 1 >= path.num_waypoints || !(path.waypoints[at.piece].v > 0.0F)) {
            at.u = 1.0L;
            overshot = x > left + 1e-9L;
            return at;
        }
        x -= left;
        at.piece++;
        at.u = 0.0L;
    }
}

static long double point_to_footprint(const long double *pose, const long double *p) {
    const long double c = cosl(pose[2]), s = sinl(pose[2]), dx = p[0] - pose[0], dy = p[1] - pose[1];
    const long double at[2] = {c * dx + s * dy, c * dy - s * dx}; // in the vehicle's frame
    long double v[16][2], square = 1e18L;
    const int n = (int)vehicle.n;
    for (int i = 0; i < n; i++) {
        v[i][0] = (long double)vehicle.footprint[i].x;
        v[i][1] = (long double)vehicle.footprint[i].y;
    }
    if (holds_point(v, n, at)) {
        return -(long double)vehicle.radius;
    }
    for (int i = 0; i < n; i++) {
        square = fminl(square, point_to_segment(at, v[i], v[(i + 1) % n]));
    }
    return sqrtl(square) - (long double)vehicle.radius;
}

static long double reach_at(const aisle_mover *m, long double t) {
    const long double age = (long double)(asked.now_us - m->utime) * 1e-6L + t;
    return (long double)m->radius + 3.0L * (long double)m->sigma + (long double)m->v_bound * fmaxl(age, 0.0L);
}

// Lowers *least to the distance from the footprint to the nearest reach, at t, `lag` late.
static void look_around(tick at, long double t, long double lag, long double *least) {
    long double pose[3];
    const stretch s = stretch_at(at.piece);
    stretch_pose(&s, at.u, pose);
    const long double arm = lever_arm() + (long double)vehicle.radius;
    for (uint32_t i = 0; i < movers.count; i++) {
        const long double p[2] = {(long double)mover[i].at.x, (long double)mover[i].at.y};
        const long double reach = reach_at(&mover[i], t + lag), far = hypotl(p[0] - pose[0], p[1] - pose[1]);
        if (far - arm - reach < *least) {
            *least = fminl(*least, point_to_footprint(pose, p) - reach);
        }
    }
}

// Brakes from `begin` on; while it moves nobody may come near.
static void brake_from(long double begin, long double lag, long double *least) {
    const tick at = nominal_at(begin);
    const long double down = (long double)(at.turns ? vehicle.alpha_max : vehicle.d_max);
    for (long double t = 0.0L; t * down < at.v; t += 0.005L) {
        const tick then = moved_by(at, at.v * t - 0.5L * down * t * t);
        if (overshot) {
            return;
        }
        look_around(then, begin + t, lag, least);
    }
}

// Least distance (m) to a reach over all motions that may be, `lag` late.
static long double judge(int pull, long double lag) {
    long double least = 1e9L;
    const long double first = (long double)vehicle.reaction_time, last = first + (long double)asked.lease;
    drive_on(pull);
    for (long double t = 0.0L; t <= last; t += 0.005L) {
        const tick at = nominal_at(t);
        if (at.v > 0.0L) {
            look_around(at, t, lag, &least);
        }
    }
    for (long double begin = first; begin < last; begin += 0.01L) {
        brake_from(begin, lag, &least);
    }
    brake_from(last, lag, &least);
    return least;
}

// ---- what needs no proof

static void test_without_movers_the_stamp_is_given_at_once_for_the_whole_lease(void) {
    assert_proved();
    TEST_ASSERT_EQUAL_UINT32(1, spent);
    TEST_ASSERT_EQUAL_INT64(NOW + 1000000, moving_stamp.until_us);
    TEST_ASSERT_EQUAL(AISLE_VERIFY_NONE, verified());
    TEST_ASSERT_EQUAL_UINT64(stamp.digest, moving_stamp.digest);
    TEST_ASSERT_EQUAL_UINT32(stamp.size, moving_stamp.size);
    TEST_ASSERT_EQUAL_DOUBLE(AISLE_MOVING_CLEARANCE_MAX, moving.clearance);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, moving_stamp.clearance); // more is not told
    asked.lease = 0.25;
    assert_proved();
    TEST_ASSERT_EQUAL_INT64(NOW + 250000, moving_stamp.until_us);
}

static void test_a_path_of_one_waypoint_is_always_proved(void) {
    path_begin(1.0, 1.0, 0.0);
    path_end();
    (void)add_mover(1.0, 1.0, 1.0, 2.0);
    ask(1.0);
    assert_proved();
}

static void test_at_the_end_of_the_path_all_is_proved(void) {
    (void)add_mover(20.0, 0.0, 1.0, 2.0);
    asked.at_piece = 10;
    asked.at_u = 1.0;
    assert_proved();
    asked.at_u = 0.99;
    assert_refused();
}

// ---- by hand

static void test_what_stands_beside_the_way_is_kept_off_by_the_margin(void) {
    const double sides[2] = {1.0, -1.0};
    for (int i = 0; i < 2; i++) {
        movers.count = 0;
        aisle_mover *m = add_mover(3.0, 0.0, 0.3, 0.0);
        asked.at_piece = 2;
        asked.v = 0.8;
        m->at.y = sides[i] * (0.35 + 0.05 + 0.3 + 0.1 - 1e-4);
        assert_refused();
        m->at.y = sides[i] * (0.35 + 0.05 + 0.3 + 0.1 + 1e-4);
        assert_proved();
        m->sigma = 0.01; // 3 cm
        assert_refused();
        m->at.y = sides[i] * (0.35 + 0.05 + 0.3 + 0.1 + 0.03 + 1e-4);
        assert_proved();
        TEST_ASSERT_DOUBLE_WITHIN(0.05, 0.1, moving.clearance);
        TEST_ASSERT_TRUE((double)moving_stamp.clearance <= moving.clearance && moving_stamp.clearance > 0.05F);
        vehicle.margin = 0.2;
        assert_refused();
        vehicle.margin = 0.1;
    }
}

// 0.8 m/s at (2, 0): at rest at the latest after (0.3 + L) 0.8 + 0.64 m, and 0.3 + L + 1.6 s.
static void test_what_comes_towards_it_is_off_where_and_when_it_rests_last(void) {
    const double leases[3] = {1.0, 0.5, 0.25};
    for (int i = 0; i < 3; i++) {
        const double front = 2.0 + (0.3 + leases[i]) * 0.8 + 0.64 + 0.6 + 0.05 + 0.1;
        const double reach = 0.3 + 1.6 * (0.3 + leases[i] + 1.6 + AISLE_DRIVE_LAG);
        movers.count = 0;
        aisle_mover *m = add_mover(front + reach - 0.001, 0.0, 0.3, 1.6);
        asked.at_piece = 2;
        asked.v = 0.8;
        asked.lease = leases[i];
        assert_refused();
        TEST_ASSERT_EQUAL_INT32(m->id, moving.blocker);
        TEST_ASSERT_DOUBLE_WITHIN(0.02, (0.3 + leases[i]) * 0.8 + 0.64, moving.blocked_way);
        TEST_ASSERT_DOUBLE_WITHIN(0.02, 2.0 + (0.3 + leases[i]) * 0.8 + 0.64, moving.blocked_at.x);
        TEST_ASSERT_DOUBLE_WITHIN(0.05, leases[i] + 2.0, (double)(moving.blocked_us - NOW) * 1e-6);
        m->at.x = front + reach + 0.002;
        assert_proved();
    }
}

// A reach that grows fast is asked at the right instant.
static void test_a_fast_mover_is_told_to_a_millimetre(void) {
    const double q = 2.0 + 1.3 * 0.8 + 0.64, reach = 0.3 + 20.0 * (1.3 + 1.6 + AISLE_DRIVE_LAG);
    aisle_mover *m = add_mover(q + 0.65 + 0.1 + reach - 0.001, 0.0, 0.3, 20.0);
    asked.at_piece = 2;
    asked.v = 0.8;
    assert_refused();
    m->at.x += 0.003;
    assert_proved();
}

// As far as it gets at 3 m/s, over many pieces.
static void test_nobody_at_the_far_end_of_what_can_be_driven_is_overlooked(void) {
    const double q = 15.0 + 1.3 * 3.0 + 9.0; // in motion at full speed
    vehicle.v_max = 3.0;
    path_begin(0.0, 0.0, 0.0);
    for (int i = 0; i < 160; i++) {
        path_line(0.5);
    }
    path_end();
    path_drive_gently(3.0);
    ask(1.0);
    asked.at_piece = 31;
    asked.v = 3.0;
    aisle_mover *m = add_mover(q + 0.65 + 0.1 + 0.3 - 0.001, 0.0, 0.3, 0.0);
    assert_refused();
    m->at.x += 0.003;
    assert_proved();
}

static void test_a_bulge_of_an_arc_is_not_overlooked(void) {
    vehicle_disc(0.2);
    vehicle.margin = 0.0;
    for (int i = 0; i < 2; i++) {
        const double k = i == 0 ? 1.0 : 0.15, out = 1.0 / k + 0.2 + 0.05; // to the middle of a mover outside the arc
        movers.count = 0;
        path_begin(0.0, -1.0 / k, 0.0);
        path_arc(k, 3.0);
        drive(i == 0 ? 0.3 : 0.8);
        ask(1.0);
        asked.at_u = 0.5 - 0.1 * k;
        asked.v = i == 0 ? 0.3 : 0.8;
        aisle_mover *m = add_mover((out - 1e-3) * sin(1.5), -(out - 1e-3) * cos(1.5), 0.05, 0.0);
        assert_refused();
        m->at = aisle_vec2_of((out + 1e-3) * sin(1.5), -(out + 1e-3) * cos(1.5));
        assert_proved();
    }
}

static void test_the_end_of_a_piece_is_the_beginning_of_the_next(void) {
    for (int i = 0; i < 200; i++) {
        dice = aisle_rng_seed((uint64_t)i);
        movers.count = 0;
        (void)add_mover(uniform(3.0, 9.0), uniform(-2.0, 2.0), 0.3, uniform(0.0, 1.0));
        asked.at_piece = 2;
        asked.at_u = 1.0;
        asked.v = 0.8;
        const aisle_status end = prove();
        const double clearance = moving.clearance, way = moving.blocked_way;
        asked.at_piece = 3;
        asked.at_u = 0.0;
        TEST_ASSERT_EQUAL(end, prove());
        TEST_ASSERT_DOUBLE_WITHIN(1e-4, clearance, moving.clearance);
        TEST_ASSERT_DOUBLE_WITHIN(1e-4, way, moving.blocked_way);
    }
}

// One behind it may come as near as it likes once the vehicle has left: at its place only the present counts.
static void test_what_follows_may_be_close(void) {
    asked.at_piece = 2;
    asked.v = 0.8;
    (void)add_mover(2.0 - 0.5 - 0.05 - 0.1 - 0.3 - 1.6 * AISLE_DRIVE_LAG - 0.2, 0.0, 0.3, 0.4);
    assert_proved();
    mover[0].v_bound = 1.6; // faster than the vehicle, it catches up before that rests
    assert_refused();
}

static void test_old_data_reach_farther(void) {
    asked.at_piece = 2;
    asked.v = 0.8;
    aisle_mover *m = add_mover(10.0, 0.0, 0.3, 1.6);
    assert_proved();
    m->utime = NOW - 200000;
    assert_proved();
    m->utime = NOW - 2000000;
    assert_refused();
    m->utime = NOW + 500000; // from the future: it cannot have moved before
    assert_proved();
}

static void test_a_shorter_lease_asks_less(void) {
    asked.at_piece = 2;
    asked.v = 0.8;
    (void)add_mover(8.2, 0.0, 0.3, 1.6);
    assert_refused();
    asked.lease = 0.5;
    assert_refused();
    asked.lease = 0.25;
    assert_proved();
}

static void test_a_longer_reaction_or_softer_brakes_ask_more(void) {
    asked.at_piece = 2;
    asked.v = 0.8;
    (void)add_mover(9.7, 0.0, 0.3, 1.6);
    assert_proved();
    vehicle.reaction_time = 0.6;
    assert_refused();
    vehicle.reaction_time = 0.3;
    vehicle.d_max = 0.4;
    assert_refused();
}

static void test_a_real_speed_above_the_path_s_asks_more(void) {
    asked.at_piece = 2;
    asked.v = 0.8;
    (void)add_mover(9.58, 0.0, 0.3, 1.6);
    assert_proved();
    asked.v = 1.1;
    assert_refused();
}

// It comes to rest where the path does, though it is too fast for it, and sets out from rest again.
static void test_a_speed_that_is_too_much_ends_where_the_path_rests(void) {
    path_begin(0.0, 0.0, 0.0);
    path_line(1.0);
    path_line(3.0);
    path_end();
    path.waypoints[1].flags |= AISLE_WAYPOINT_STOP;
    path_drive_gently(0.8);
    path.waypoints[1].v = 0.0F;
    path_retime(0.3);
    path_seal();
    TEST_ASSERT_EQUAL(AISLE_VERIFY_NONE, verified());
    ask(1.0);
    asked.at_u = 0.97;
    asked.v = 0.6;
    (void)add_mover(1.0 + 0.65 + 0.1 + 0.3 + 0.6, 0.0, 0.3, 0.0);
    assert_proved();
    mover[0].at.x -= 0.5;
    assert_refused();
}

// Too slow, it is later where others come.
static void test_a_real_speed_below_the_path_s_is_later(void) {
    asked.at_piece = 2;
    asked.v = 0.8;
    (void)add_mover(1.0, -1.0, 0.3, 0.45);
    assert_proved();
    asked.v = 0.76; // within the lag
    assert_proved();
    asked.v = 0.0;
    assert_refused();
}

static void test_a_wait_ahead_is_waited(void) {
    path_begin(0.0, 0.0, 0.0);
    path_line(1.0);
    path_turn(0.0);
    path_line(3.0);
    path_end();
    path_drive_gently(0.8);
    for (int i = 2; i < path.num_waypoints; i++) {
        path.waypoints[i].t += 30.0F;
    }
    path.duration += 30.0F;
    path_seal();
    TEST_ASSERT_EQUAL(AISLE_VERIFY_NONE, verified());
    ask(1.0);
    (void)add_mover(2.3, 0.0, 0.3, 0.0); // in the way behind the wait
    asked.at_piece = 2;
    assert_proved();
    asked.at_u = 0.9; // 3 s left
    assert_proved();
    asked.at_u = 1.0;
    assert_refused();
    asked.at_piece = 1;
    asked.at_u = 1.0;
    assert_proved();
}

static void test_a_turn_needs_room_for_its_corners(void) {
    path_begin(0.0, 0.0, 0.0);
    path_turn(1.5);
    path_line(1.0);
    drive(0.4);
    ask(1.0);
    const double corner = hypot(0.6, 0.35) + 0.05, at = 0.9; // where it passes within the lease
    aisle_mover *m = add_mover(0.0, 0.0, 0.2, 0.0);
    m->at = aisle_vec2_of((corner + 0.3 - 1e-3) * cos(at), (corner + 0.3 - 1e-3) * sin(at));
    assert_refused();
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 0.0, moving.blocked_way);
    TEST_ASSERT_DOUBLE_WITHIN(0.1, at - atan2(0.35, 0.6), moving.blocked_at.theta);
    m->at = aisle_vec2_of((corner + 0.3 + 1e-3) * cos(at), (corner + 0.3 + 1e-3) * sin(at));
    assert_proved();
}

// m, how near a mover of 1 m/s may stand ahead of a turn that has begun, by the path at rest, for 0.2 s of lease.
static double nearest_beside_turn(double omega) {
    double near = 0.0, far = 10.0;
    while (far - near > 1e-4) {
        const double half = 0.5 * (near + far);
        path_begin(0.0, 0.0, 0.0);
        path_turn(2.5);
        path_line(1.0);
        drive(0.0);
        ask(0.2);
        asked.omega = omega;
        movers.count = 0;
        (void)add_mover(half, 0.0, 0.2, 1.0);
        if (prove() == AISLE_OK) {
            far = half;
        } else {
            near = half;
        }
    }
    return far;
}

// A path that is made anew in a turn begins it at rest; the vehicle does not.
static void test_a_turn_that_is_faster_than_its_path_says_takes_as_long_to_brake(void) {
    const double rest = nearest_beside_turn(0.0), fast = nearest_beside_turn(0.9);
    const double gain = vehicle.alpha_max * (0.2 + vehicle.reaction_time); // until it begins to brake at the latest
    const double more = fmin(vehicle.omega_max, 0.9 + gain) - fmin(vehicle.omega_max, gain);
    const double longer = more / vehicle.alpha_max; // s, in which the mover comes as many metres nearer
    TEST_ASSERT_TRUE(longer > 0.3);
    TEST_ASSERT_DOUBLE_WITHIN(0.1, rest + longer, fast);
}

static void test_half_a_turn_is_proved_both_ways_round(void) {
    for (int i = 0; i < 2; i++) {
        path_begin(0.0, 0.0, 0.0);
        path_turn(acos(-1.0));
        path_line(1.0);
        drive(0.4);
        ask(1.0);
        movers.count = 0;
        (void)add_mover(0.55, i == 0 ? 0.65 : -0.65, 0.1, 0.0);
        assert_refused();
    }
    path_begin(0.0, 0.0, 0.0);
    path_turn(3.1);
    path_line(1.0);
    drive(0.4);
    ask(1.0);
    assert_proved(); // to the left only, the mover being on the right
}

static void test_backwards_it_is_the_rear_that_counts(void) {
    path_begin(0.0, 0.0, 0.0);
    pen_flags = AISLE_WAYPOINT_REVERSE;
    path_line(3.0);
    drive(0.2);
    ask(1.0);
    (void)add_mover(1.3, 0.0, 0.3, 0.0);
    assert_proved();
    movers.count = 0;
    (void)add_mover(-1.0, 0.0, 0.3, 0.0);
    assert_refused();
}

static void test_the_dwell_at_its_place_is_what_the_request_says(void) {
    path_begin(0.0, 0.0, 0.0);
    path_line(1.0);
    path_line(3.0);
    path_end();
    path.waypoints[1].flags |= AISLE_WAYPOINT_GOAL | AISLE_WAYPOINT_STOP;
    path.waypoints[1].goal_id = 3;
    ask(1.0);
    goals[1] = path_goal;
    goals[0] = (aisle_goal_msg){.id = 3, .x = 1.0, .dwell = 20.0F};
    asked.num_goals = 2;
    path.waypoints[2].t += 20.0F;
    path.duration += 20.0F;
    path_seal();
    asked.size = path_size;
    (void)add_mover(2.1, 0.0, 0.3, 0.0); // behind the goal
    asked.at_u = 0.97;                   // 3 cm before it
    asked.v = 0.1;
    assert_proved(); // 20 s away
    asked.v = 0.0;
    assert_refused(); // it stands there: may be over
    asked.at_u = 0.9;
    assert_proved();
    asked.at_piece = 2;
    asked.at_u = 0.0;
    assert_refused();
    asked.at_piece = 1;
    asked.at_u = 1.0;
    assert_refused();
    asked.v = 0.1; // at the very place, whatever its speed
    assert_refused();
}

static void test_each_goal_has_its_own_dwell(void) {
    path_begin(0.0, 0.0, 0.0);
    path_line(1.0);
    path_line(1.0);
    path_line(2.0);
    path_end();
    for (int i = 1; i < 3; i++) {
        path.waypoints[i].flags |= AISLE_WAYPOINT_GOAL | AISLE_WAYPOINT_STOP;
        path.waypoints[i].goal_id = i;
    }
    ask(1.0);
    goals[2] = path_goal;
    asked.num_goals = 3;
    (void)add_mover(3.1, 0.0, 0.3, 0.0); // behind the second
    for (int i = 0; i < 2; i++) {
        const aisle_path_msg was = path;
        goals[0] = (aisle_goal_msg){.id = 1, .x = 1.0, .dwell = i == 0 ? 20.0F : 0.0F};
        goals[1] = (aisle_goal_msg){.id = 2, .x = 2.0, .dwell = i == 0 ? 0.0F : 20.0F};
        for (int k = 2 + i; k < path.num_waypoints; k++) {
            path.waypoints[k].t += 20.0F;
        }
        path.duration += 20.0F;
        path_seal();
        asked.size = path_size;
        asked.at_piece = 2;
        asked.at_u = 0.97;
        asked.v = 0.1;
        TEST_ASSERT_EQUAL(i == 0 ? AISLE_ERR_DATA : AISLE_OK, prove());
        path = was;
    }
}

// What a turn has more time than the fastest is rest before it.
static void test_a_turn_with_time_to_spare_comes_last(void) {
    path_begin(0.0, 0.0, 0.0);
    path_line(1.0);
    path_turn(1.5);
    path_line(2.0);
    drive(0.4);
    for (int i = 2; i < path.num_waypoints; i++) {
        path.waypoints[i].t += 30.0F;
    }
    path.duration += 30.0F;
    path_seal();
    TEST_ASSERT_EQUAL(AISLE_VERIFY_NONE, verified());
    ask(1.0);
    const double corner = hypot(0.6, 0.35) + 0.05 + 0.1 + 0.1 - 0.02;
    (void)add_mover(1.0 + corner * cos(0.9), corner * sin(0.9), 0.1, 0.0);
    asked.at_u = 0.99;
    assert_proved();
    asked.at_piece = 2;
    asked.at_u = 0.0;
    assert_refused();
    asked.at_u = 0.1;
    assert_refused();
}

// As much more time than the speeds say as verify.h allows, 1 ms on each of many short pieces.
static void test_times_longer_than_the_speeds_make_late(void) {
    for (int i = 0; i < 2; i++) {
        path_begin(0.0, 0.0, 0.0);
        for (int k = 0; k < 200; k++) {
            path_line(0.05);
        }
        path_end();
        path_drive_gently(0.8);
        for (int k = 1; i == 1 && k < path.num_waypoints; k++) {
            path.waypoints[k].t += 1e-3F * (float)k;
        }
        path.duration = path.waypoints[200].t;
        path_seal();
        TEST_ASSERT_EQUAL(AISLE_VERIFY_NONE, verified());
        ask(1.0);
        asked.at_piece = 41;
        asked.v = 0.8;
        movers.count = 0;
        const double q = 2.0 + 1.3 * 0.8 + 0.64, reach = 0.3 + 20.0 * (1.3 + 1.6 + AISLE_DRIVE_LAG);
        (void)add_mover(q + 0.65 + 0.1 + reach + 0.3, 0.0, 0.3, 20.0); // 21 pieces are 0.42 m
        TEST_ASSERT_EQUAL(i == 0 ? AISLE_OK : AISLE_ERR_DATA, prove());
        mover[0].at.x += 0.15;
        assert_proved();
    }
}

// ---- what does not fit

static void test_bytes_or_movers_that_change_end_the_proof(void) {
    (void)add_mover(10.0, 0.0, 0.3, 1.6);
    for (int i = 0; i < 2; i++) {
        spent = 0;
        aisle_verify_moving_start(&moving, &asked);
        TEST_ASSERT_EQUAL(AISLE_BUSY, aisle_verify_moving_step(&moving, 3, &spent, &moving_stamp));
        path_bytes[path_size - 1] ^= i == 0 ? 1U : 0U;
        movers.revision += i == 1 ? 1U : 0U;
        TEST_ASSERT_EQUAL(AISLE_ERR_DATA, aisle_verify_moving_step(&moving, UINT32_MAX, &spent, &moving_stamp));
        TEST_ASSERT_TRUE(moving.is_unfit);
        path_bytes[path_size - 1] ^= i == 0 ? 1U : 0U;
    }
}

static void test_a_path_that_is_not_in_the_bytes_is_refused(void) {
    (void)add_mover(30.0, 0.0, 0.3, 1.6);
    (void)add_mover(2.5, 2.0, 0.3, 0.0);
    asked.at_piece = 2;
    asked.v = 0.8;
    assert_proved();
    for (int i = 1; i < 4; i++) {
        aisle_waypoint_msg *w = &path.waypoints[i];
        const aisle_waypoint_msg was = *w;
        for (int k = 0; k < 8; k++) {
            w->x += k == 0 ? 1e-12 : 0.0;
            w->y += k == 1 ? 1e-12 : 0.0;
            w->theta += k == 2 ? 1e-12 : 0.0;
            w->t += k == 3 ? 1e-5F : 0.0F;
            w->curvature += k == 4 ? 1e-9F : 0.0F;
            w->v *= k == 5 ? 1.000001F : 1.0F;
            w->flags ^= (int16_t)(k == 6 ? AISLE_WAYPOINT_GOAL : 0);
            w->goal_id += k == 7;
            assert_unfit();
            *w = was;
        }
    }
    asked.at_piece = 10;
    path.waypoints[10].theta += 1e-12; // the last one
    (void)add_mover(19.0, 2.0, 0.3, 0.0);
    assert_unfit();
    path.waypoints[10].theta -= 1e-12;
    path.num_waypoints--;
    asked.at_piece = 2;
    assert_unfit();
    path.num_waypoints++;
    asked.size = 100;
    assert_unfit();
}

// No path of verify.h: a piece in motion that takes far longer than its speeds say.
static void test_times_that_fit_no_speeds_are_unfit(void) {
    (void)add_mover(100.0, 0.0, 0.3, 2.0); // too far away to count within the time there is
    (void)add_mover(4.0, 2.0, 0.3, 0.0);
    asked.at_piece = 2;
    asked.v = 0.8;
    assert_proved();
    for (int i = 2; i < path.num_waypoints; i++) {
        path.waypoints[i].t += 20.0F;
    }
    path_seal();
    asked.size = path_size;
    assert_unfit();
}

// Whatever the bytes are, an answer comes: they should have been proved before, but may not have been.
static void test_any_waypoints_at_all_are_answered(void) {
    int fit = 0;
    for (uint64_t seed = 0; seed < CASES(3000); seed++) {
        dice = aisle_rng_seed(seed);
        straight_path();
        movers.count = 0;
        (void)add_mover(uniform(-3.0, 20.0), uniform(-4.0, 4.0), 0.3, uniform(0.0, 2.0));
        ask(1.0);
        for (int i = 0; i < 3; i++) {
            aisle_waypoint_msg *w = &path.waypoints[below(5)];
            const int kind = below(7);
            const double odd[6] = {0.0, -1.0, 1e-9, 1e4, 0.3, -1e-3};
            const double value = odd[below(6)];
            *(kind == 0 ? &w->x : (kind == 1 ? &w->y : &w->theta)) += kind < 3 ? value : 0.0;
            w->v = kind == 3 ? (float)value : w->v;
            w->t = kind == 4 ? (float)value : w->t;
            w->curvature = kind == 5 ? (float)value : w->curvature;
            w->flags = kind == 6 ? (int16_t)below(16) : w->flags;
        }
        path_seal();
        asked.size = path_size;
        asked.at_piece = 1U + (uint32_t)below(4);
        asked.at_u = uniform(0.0, 1.0);
        asked.v = below(2) == 0 ? 0.0 : uniform(0.0, 2.0);
        (void)prove();
        fit += moving.is_unfit ? 0 : 1;
    }
    TEST_ASSERT_GREATER_THAN(CASES(500), fit);
    TEST_ASSERT_LESS_THAN(CASES(2900), fit);
}

static void test_the_answer_does_not_depend_on_the_steps(void) {
    for (int i = 0; i < 40; i++) {
        movers.count = 0;
        dice = aisle_rng_seed((uint64_t)i);
        for (int k = 0; k < 100; k++) {
            (void)add_mover(uniform(-4.0, 30.0), uniform(2.0, 9.0) * (below(2) == 0 ? 1.0 : -1.0), 0.2,
                            i < 20 ? 0.4 : 1.0);
        }
        asked.at_piece = 3;
        asked.v = 0.8;
        const aisle_status whole = prove();
        const aisle_verify_moving then = moving;
        const uint32_t work = spent;
        TEST_ASSERT_EQUAL(whole, prove_in_steps_of(1U + (uint32_t)i % 7U));
        TEST_ASSERT_EQUAL_UINT32(work, spent);
        TEST_ASSERT_EQUAL_DOUBLE(then.clearance, moving.clearance);
        TEST_ASSERT_EQUAL_INT32(then.blocker, moving.blocker);
        TEST_ASSERT_EQUAL(whole, aisle_verify_moving_step(&moving, 5, &spent, &moving_stamp)); // again, at no cost
        TEST_ASSERT_EQUAL_UINT32(work, spent);
    }
}

static void test_as_many_movers_as_there_can_be(void) {
    dice = aisle_rng_seed(1);
    while (movers.count < AISLE_MOVERS_MAX) {
        (void)add_mover(uniform(0.0, 8.0), uniform(4.2, 5.0) * (below(2) == 0 ? 1.0 : -1.0), 0.2, 1.0);
    }
    asked.at_piece = 2;
    asked.v = 0.8;
    assert_proved();
    TEST_ASSERT_EQUAL_UINT32(AISLE_MOVERS_MAX, moving.near_count);
    mover[AISLE_MOVERS_MAX - 1].at.y = 2.0;
    assert_refused();
    TEST_ASSERT_EQUAL_INT32(mover[AISLE_MOVERS_MAX - 1].id, moving.blocker);
}

// ---- against the judge

static void vehicle_triangle(void) {
    static aisle_vehicle_msg msg;
    memset(&msg, 0, sizeof msg);
    const double v[3][2] = {{uniform(-0.9, -0.2), uniform(-0.5, 0.0)},
                            {uniform(0.2, 1.0), uniform(-0.4, 0.4)},
                            {uniform(-0.9, 0.1), uniform(0.5, 0.8)}};
    memcpy(msg.footprint, v, sizeof v);
    msg.num_vertices = 3;
    vehicle_from(&msg);
}

static void random_vehicle(void) {
    const int kind = below(4);
    if (kind == 0) {
        vehicle_disc(uniform(0.1, 0.5));
    } else if (kind == 1) {
        vehicle_box(uniform(0.1, 0.9), uniform(0.1, 0.9), uniform(0.2, 0.8), below(2) == 0 ? 0.0 : 0.1);
    } else if (kind == 2) {
        vehicle_box(-0.1, uniform(0.3, 1.2), uniform(0.2, 0.6), 0.0);
    } else {
        vehicle_triangle();
    }
    vehicle.margin = below(3) == 0 ? 0.0 : uniform(0.0, 0.2);
    vehicle.reaction_time = uniform(0.1, 0.5);
    vehicle.d_max = uniform(0.45, 1.0);
    vehicle.alpha_max = uniform(0.5, 1.5);
}

static void random_path(void) {
    const int pieces = 2 + below(5);
    path_begin(uniform(-2.0, 2.0), uniform(-2.0, 2.0), uniform(-3.1, 3.1));
    for (int i = 0; i < pieces; i++) {
        const int kind = below(8);
        pen_flags = below(6) == 0 ? (int16_t)(pen_flags ^ AISLE_WAYPOINT_REVERSE) : pen_flags;
        if (kind < 3) {
            path_line(uniform(0.1, 3.0));
        } else if (kind < 6) {
            path_arc(below(2) == 0 ? uniform(0.1, 0.7) : -uniform(0.1, 0.7), uniform(0.1, 1.5));
        } else {
            path_turn(kind == 6 ? uniform(-3.0, 3.0) : 0.0);
            path_line(uniform(0.1, 1.0));
        }
    }
    path_end();
    if (below(3) > 0) { // else from rest to rest
        path_drive_gently(uniform(0.1, 0.7));
    }
    TEST_ASSERT_EQUAL(AISLE_VERIFY_NONE, verified());
}

static void random_movers(int n) {
    movers.count = 0;
    for (int i = 0; i < n; i++) {
        const aisle_waypoint_msg *w = &path.waypoints[below(path.num_waypoints)];
        const double far = uniform(0.2, 6.0), round = uniform(-3.1, 3.1);
        aisle_mover *m = add_mover(w->x + far * cos(round), w->y + far * sin(round), uniform(0.05, 0.4),
                                   below(5) == 0 ? 0.0 : uniform(0.1, 2.0));
        m->sigma = below(2) == 0 ? 0.0 : uniform(0.0, 0.1);
        m->utime = NOW - below(400) * 1000;
    }
}

static void random_place(void) {
    asked.at_piece = 1U + (uint32_t)below(path.num_waypoints - 1);
    asked.at_u = below(4) == 0 ? 0.0 : uniform(0.0, 1.0);
    asked.lease = 0.25 * (1 << below(3));
    drive_on(0);
    asked.v = ticks[0].turns ? 0.0 : (double)ticks[0].v;
}

typedef struct tally {
    int proved, refused, sharp;
    long double worst; // m, of refusals, beyond the margin
} tally;

static void judge_one(uint64_t seed, int pull, tally *out) {
    char why[160];
    const long double slack = pull == 0 ? 1e-6L : 1e-3L; // the judge's steps where two speeds meet
    const aisle_status status = prove();
    const long double least = judge(pull, (long double)AISLE_DRIVE_LAG), margin = (long double)vehicle.margin;
    (void)snprintf(why, sizeof why, "seed %d, piece %d, u %.6f, margin %.4f, least %.6f, told %.6f", (int)seed,
                   (int)asked.at_piece, asked.at_u, vehicle.margin, (double)least, moving.clearance);
    TEST_ASSERT_FALSE_MESSAGE(moving.is_unfit, why);
    if (status == AISLE_OK) {
        out->proved++;
        TEST_ASSERT_TRUE_MESSAGE(least >= margin - slack, why);
        TEST_ASSERT_TRUE_MESSAGE(moving.clearance <= (double)(least + slack), why);
        const double told = fmin((double)least, AISLE_MOVING_CLEARANCE_MAX) - AISLE_MOVING_CLEARANCE_OFF;
        TEST_ASSERT_TRUE_MESSAGE(moving.clearance >= told - 0.03, why); // by samples it is more
        return;
    }
    out->refused++;
    out->worst = fmaxl(out->worst, least - margin);
    out->sharp += least < margin + 0.02L ? 1 : 0;
    TEST_ASSERT_TRUE_MESSAGE(least < margin + 0.045L, why); // samples are 5 and 10 ms apart
}

static void tell(const tally *out) {
    char text[120];
    (void)snprintf(text, sizeof text, "%d proved, %d refused, %d of them within 2 cm, all within %.4f m", out->proved,
                   out->refused, out->sharp, (double)out->worst);
    TEST_MESSAGE(text);
}

static void test_what_is_proved_is_never_touched_and_what_is_refused_nearly(void) {
    tally out = {0, 0, 0, -1.0L};
    for (int seed = 0; seed < random_cases; seed++) {
        dice = aisle_rng_seed((uint64_t)seed);
        random_vehicle();
        random_path();
        ask(1.0);
        random_movers(1 + below(4));
        random_place();
        judge_one((uint64_t)seed, 0, &out);
    }
    tell(&out);
    TEST_ASSERT_GREATER_THAN(random_cases / 4, out.proved);
    TEST_ASSERT_GREATER_THAN(random_cases / 5, out.refused);
    TEST_ASSERT_GREATER_THAN(out.refused * 9 / 10, out.sharp);
}

// The real speed is not the path's.
static void test_other_speeds_than_the_path_s_are_proved_from_what_they_are(void) {
    tally out = {0, 0, 0, -1.0L};
    int slow = 0;
    for (int seed = 0; seed < random_cases / 2; seed++) {
        dice = aisle_rng_seed(100000U + (uint64_t)seed);
        random_vehicle();
        random_path();
        ask(1.0);
        random_movers(1 + below(4));
        random_place();
        const double told = asked.v;
        asked.v = below(2) == 0 ? told + uniform(0.0, 0.3) : told * uniform(0.0, 1.0);
        if (ticks[0].turns || !(told > 0.0)) {
            continue;
        }
        if (asked.v > told) {
            judge_one(100000U + (uint64_t)seed, -1, &out);
        } else if (prove() == AISLE_OK && told - asked.v > vehicle.a_max * AISLE_DRIVE_LAG) {
            slow++;
            TEST_ASSERT_TRUE(judge(1, (long double)AISLE_DRIVE_LAG) >= (long double)vehicle.margin - 1e-3L);
            TEST_ASSERT_TRUE(judge(0, (long double)AISLE_DRIVE_LAG) >= (long double)vehicle.margin - 1e-6L);
        } else if (moving_stamp.size > 0) { // what it is late is within the lag
            TEST_ASSERT_TRUE(judge(1, 0.0L) >= (long double)vehicle.margin - 1e-3L);
        }
    }
    tell(&out);
    TEST_ASSERT_GREATER_THAN(random_cases / 16, out.proved);
    TEST_ASSERT_GREATER_THAN(random_cases / 20, slow);
}

// ---- driven

// Movers that run for the vehicle as fast as they can; leases of 1, 1/2 or 1/4 s, asked for every 0.2 s; where none is
// given it brakes when the last one ends. `late` s behind its path at every place.
static int encounter(long double late, bool *arrived) {
    aisle_vec2 at[4];
    long double until = 0.0L, brakes_at = 1e9L;
    const aisle_moving_request start = asked;
    for (uint32_t i = 0; i < movers.count; i++) {
        at[i] = mover[i].at;
    }
    *arrived = false;
    drive_on(0);
    for (int k = 0; k < 6000; k++) {
        const long double t = 0.01L * k;
        tick now = nominal_at(fminl(fmaxl(t - late, 0.0L), brakes_at));
        const long double braked = fmaxl(t - late - brakes_at, 0.0L);
        const long double down = (long double)(now.turns ? vehicle.alpha_max : vehicle.d_max);
        const long double time = fminl(braked, now.v / down);
        const bool moves = braked * down < now.v && t > 0.0L;
        const long double speed = now.v - down * time;
        now = moved_by(now, now.v * time - 0.5L * down * time * time);
        long double pose[3];
        const stretch s = stretch_at(now.piece);
        stretch_pose(&s, now.u, pose);
        for (uint32_t i = 0; i < movers.count; i++) {
            const double dx = (double)pose[0] - at[i].x, dy = (double)pose[1] - at[i].y, far = hypot(dx, dy);
            const double step = fmin(mover[i].v_bound * 0.01, far);
            at[i].x += k > 0 && far > 0.0 ? dx / far * step : 0.0;
            at[i].y += k > 0 && far > 0.0 ? dy / far * step : 0.0;
            const long double p[2] = {(long double)at[i].x, (long double)at[i].y};
            if (moves && point_to_footprint(pose, p) - (long double)mover[i].radius < 0.0L) {
                return 1;
            }
        }
        if (brakes_at < 1e8L && !moves) {
            return 0;
        }
        if (t - late >= ticks[tick_count - 1].t) {
            *arrived = true;
            return 0;
        }
        if (k % 20 == 0 && brakes_at > 1e8L) { // seen 0.1 s ago
            const aisle_movers told = movers;
            aisle_mover kept[4];
            memcpy(kept, mover, sizeof kept);
            for (uint32_t i = 0; i < movers.count; i++) {
                mover[i].at = at[i];
                mover[i].utime = NOW + (int64_t)(t * 1e6L);
            }
            asked = start;
            asked.now_us = NOW + (int64_t)(t * 1e6L);
            asked.at_piece = (uint32_t)now.piece;
            asked.at_u = (double)fminl(now.u, 1.0L);
            asked.v = now.turns ? 0.0 : (double)speed;
            for (asked.lease = 1.0; asked.lease >= 0.25; asked.lease *= 0.5) {
                if (prove() == AISLE_OK) {
                    until = fmaxl(until, (long double)(moving_stamp.until_us - NOW) * 1e-6L);
                    break;
                }
            }
            memcpy(mover, kept, sizeof kept);
            movers = told;
        }
        if (t >= until && brakes_at > 1e8L) {
            if (k == 0) {
                return 0; // never sets out
            }
            brakes_at = fmaxl(t + (long double)vehicle.reaction_time - late, 0.0L);
        }
    }
    return 0;
}

static void test_who_obeys_its_leases_is_never_touched_while_moving(void) {
    int arrivals = 0, drives = 0;
    for (int seed = 0; seed < random_cases; seed++) {
        char why[60];
        bool arrived;
        dice = aisle_rng_seed(200000U + (uint64_t)seed);
        random_vehicle();
        random_path();
        ask(1.0);
        random_movers(1 + below(2));
        for (uint32_t i = 0; i < movers.count; i++) {
            mover[i].sigma = 0.0;
            mover[i].utime = NOW;
            mover[i].v_bound = uniform(0.1, 1.2);
            mover[i].at.x += mover[i].at.x > path.waypoints[0].x ? 4.0 : -4.0;
        }
        (void)snprintf(why, sizeof why, "seed %d", seed);
        TEST_ASSERT_EQUAL_MESSAGE(0, encounter(below(2) == 0 ? 0.0L : 0.09L, &arrived), why);
        arrivals += arrived ? 1 : 0;
        drives++;
    }
    char text[80];
    (void)snprintf(text, sizeof text, "%d drives, %d to the end", drives, arrivals);
    TEST_MESSAGE(text);
    TEST_ASSERT_GREATER_THAN(random_cases / 50, arrivals);
}

int main(int argc, char **argv) {
    random_cases = argc > 1 ? atoi(argv[1]) : random_cases;
    UNITY_BEGIN();
    RUN_TEST(test_without_movers_the_stamp_is_given_at_once_for_the_whole_lease);
    RUN_TEST(test_a_path_of_one_waypoint_is_always_proved);
    RUN_TEST(test_at_the_end_of_the_path_all_is_proved);
    RUN_TEST(test_what_stands_beside_the_way_is_kept_off_by_the_margin);
    RUN_TEST(test_what_comes_towards_it_is_off_where_and_when_it_rests_last);
    RUN_TEST(test_a_fast_mover_is_told_to_a_millimetre);
    RUN_TEST(test_nobody_at_the_far_end_of_what_can_be_driven_is_overlooked);
    RUN_TEST(test_a_bulge_of_an_arc_is_not_overlooked);
    RUN_TEST(test_the_end_of_a_piece_is_the_beginning_of_the_next);
    RUN_TEST(test_what_follows_may_be_close);
    RUN_TEST(test_old_data_reach_farther);
    RUN_TEST(test_a_shorter_lease_asks_less);
    RUN_TEST(test_a_longer_reaction_or_softer_brakes_ask_more);
    RUN_TEST(test_a_real_speed_above_the_path_s_asks_more);
    RUN_TEST(test_a_speed_that_is_too_much_ends_where_the_path_rests);
    RUN_TEST(test_a_real_speed_below_the_path_s_is_later);
    RUN_TEST(test_a_wait_ahead_is_waited);
    RUN_TEST(test_a_turn_needs_room_for_its_corners);
    RUN_TEST(test_a_turn_that_is_faster_than_its_path_says_takes_as_long_to_brake);
    RUN_TEST(test_half_a_turn_is_proved_both_ways_round);
    RUN_TEST(test_backwards_it_is_the_rear_that_counts);
    RUN_TEST(test_the_dwell_at_its_place_is_what_the_request_says);
    RUN_TEST(test_each_goal_has_its_own_dwell);
    RUN_TEST(test_a_turn_with_time_to_spare_comes_last);
    RUN_TEST(test_times_longer_than_the_speeds_make_late);
    RUN_TEST(test_bytes_or_movers_that_change_end_the_proof);
    RUN_TEST(test_a_path_that_is_not_in_the_bytes_is_refused);
    RUN_TEST(test_times_that_fit_no_speeds_are_unfit);
    RUN_TEST(test_any_waypoints_at_all_are_answered);
    RUN_TEST(test_the_answer_does_not_depend_on_the_steps);
    RUN_TEST(test_as_many_movers_as_there_can_be);
    RUN_TEST(test_what_is_proved_is_never_touched_and_what_is_refused_nearly);
    RUN_TEST(test_other_speeds_than_the_path_s_are_proved_from_what_they_are);
    RUN_TEST(test_who_obeys_its_leases_is_never_touched_while_moving);
    return UNITY_END();
}
