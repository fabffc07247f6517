// The space-time oracle against closed forms in corridors, strategies simulated here, and its own ways looked at every
// 10 ms with the true body.
#include "cases.h"
#include "spacetime_oracle.h"

#include "unity.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define PI 3.14159265358979323846
#define LATE 2.5 // steps of time that rounding may cost

static spacetime_problem problem;
static spacetime_oracle oracle;
static double sample[SPACETIME_MOVERS][4][3];

void setUp(void) {
    memset(&problem, 0, sizeof problem);
}

void tearDown(void) {}

// ---- building

static void begin_hall(double width, double height) {
    problem.x_max = width;
    problem.y_max = height;
    problem.t_end = 120.0;
    problem.vehicle = (spacetime_vehicle){.radius = 0.3,
                                          .margin = 0.1,
                                          .v_max = 1.0,
                                          .a_max = 0.5,
                                          .d_max = 0.5,
                                          .omega_max = 1.0,
                                          .alpha_max = 1.0,
                                          .reaction_time = 0.3,
                                          .creep_clearance = 0.01,
                                          .creep_speed = 0.3};
}

static void begin_corridor(double length) {
    begin_hall(length, 1.2);
    problem.start[0] = 1.0;
    problem.start[1] = 0.6;
    problem.goals = 1;
    problem.goal[0] = (spacetime_goal){length - 1.0, 0.6, 0.05, 0.0, 4.0, 0.0};
}

static void add_box(double x0, double y0, double x1, double y1) {
    problem.polygon[problem.polygons++] = (spacetime_polygon){{{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}}, 4};
}

// Goes evenly from a to b between t0 and t1; is not there before and after.
static void add_mover(double t0, const double a[2], double t1, const double b[2], double radius, double v_bound) {
    double(*s)[3] = sample[problem.movers];
    s[0][0] = t0;
    s[1][0] = t1;
    for (int k = 0; k < 2; k++) {
        s[0][1 + k] = a[k];
        s[1][1 + k] = b[k];
    }
    problem.mover[problem.movers++] =
        (spacetime_mover){.radius = radius, .v_bound = v_bound, .sample = (const double(*)[3])s, .count = 2};
}

static spacetime_verdict solve(double *done) {
    TEST_ASSERT_TRUE(spacetime_begin(&oracle, &problem));
    spacetime_verdict verdict = spacetime_run(&oracle, done, NULL);
    return verdict;
}

// The time found, and that it is between `least` and `most` but for what rounding to steps costs.
static double check_time(double least, double most) {
    double done = -1.0;
    spacetime_verdict verdict = solve(&done);
    double step = oracle.dt;
    spacetime_end(&oracle);
    TEST_ASSERT_EQUAL_INT(SPACETIME_FOUND, verdict);
    TEST_ASSERT_TRUE_MESSAGE(done >= least - 0.1, "earlier than can be");
    TEST_ASSERT_TRUE_MESSAGE(done <= most + LATE * step, "later than need be");
    return done;
}

static void check_none(void) {
    double done;
    spacetime_verdict verdict = solve(&done);
    spacetime_end(&oracle);
    TEST_ASSERT_EQUAL_INT(SPACETIME_NONE, verdict);
}

// ---- without movers

// From speed v to rest `way` metres on, at best.
static double best_time(double way, double v) {
    const spacetime_vehicle *car = &problem.vehicle;
    double up = (car->v_max * car->v_max - v * v) / (2.0 * car->a_max);
    double down = car->v_max * car->v_max / (2.0 * car->d_max);
    TEST_ASSERT_TRUE(way >= up + down);
    return (car->v_max - v) / car->a_max + (way - up - down) / car->v_max + car->v_max / car->d_max;
}

static void test_a_clear_corridor_takes_the_time_of_a_trapezoid(void) {
    static const double speeds[] = {0.6, 1.0, 1.5, 2.0};
    for (int i = 0; i < 4; i++) {
        for (int k = 0; k < 3; k++) {
            setUp();
            begin_corridor(30.0);
            problem.vehicle.v_max = speeds[i];
            problem.vehicle.a_max = 0.4 + 0.5 * k;
            problem.vehicle.d_max = 1.2 - 0.3 * k;
            double best = best_time(27.95, 0.0);
            (void)check_time(best, 1.08 * best); // places of the lattice: up to a cell a step is lost
        }
    }
}

static void test_creep_speed_holds_near_things(void) {
    begin_corridor(20.0);
    problem.vehicle.creep_clearance = 0.5; // 0.3 m to either side
    double best = 18.0 / 0.3;
    (void)check_time(best - 1.0, 1.05 * best);
}

static void test_a_gap_narrower_than_the_body_is_closed(void) {
    begin_hall(10.0, 6.0);
    problem.start[0] = 2.0;
    problem.start[1] = 3.0;
    problem.goals = 1;
    problem.goal[0] = (spacetime_goal){8.0, 3.0, 0.1, 0.0, 4.0, 0.0};
    add_box(5.0, 0.0, 5.2, 2.62);
    add_box(5.0, 3.38, 5.2, 6.0);
    check_none();
    problem.polygon[0] = problem.polygon[1];
    problem.polygons = 1;
    add_box(5.0, 0.0, 5.2, 2.3);
    (void)check_time(best_time(5.9, 0.0), 1.4 * best_time(6.0, 0.0));
}

static void test_goals_are_visited_in_order_with_their_dwells(void) {
    double done = 0.0, arrival[2];
    begin_corridor(20.0);
    problem.goals = 2;
    problem.goal[0] = (spacetime_goal){10.0, 0.6, 0.05, 0.0, 4.0, 3.0};
    problem.goal[1] = (spacetime_goal){19.0, 0.6, 0.05, 0.0, 4.0, 0.0};
    TEST_ASSERT_TRUE(spacetime_begin(&oracle, &problem));
    TEST_ASSERT_EQUAL_INT(SPACETIME_FOUND, spacetime_run(&oracle, &done, arrival));
    double step = oracle.dt;
    spacetime_end(&oracle);
    TEST_ASSERT_DOUBLE_WITHIN(LATE * step + 0.4, best_time(9.0, 0.0) + 3.0, arrival[0]);
    TEST_ASSERT_DOUBLE_WITHIN(LATE * step + 0.4, arrival[0] + best_time(9.0, 0.0), arrival[1]);
    TEST_ASSERT_EQUAL_DOUBLE(arrival[1], done);
}

static void test_turning_round_takes_its_time(void) {
    begin_hall(10.0, 4.0);
    problem.start[0] = 2.0;
    problem.start[1] = 2.0;
    problem.goals = 1;
    problem.goal[0] = (spacetime_goal){8.0, 2.0, 0.05, PI, 0.1, 0.0};
    double best = best_time(5.95, 0.0) + PI / problem.vehicle.omega_max;
    (void)check_time(best, 1.1 * best + 1.5); // eight turns of one step each, each longer than its turn takes
}

// ---- movers with known answers

// A mover stands in the way and is gone at t_gone. The vehicle does best to be as near and as fast then as it safely
// can: so far before the mover that it can be at rest before the disc, grown until then, reaches it.
static double best_behind(double at, double radius, double v_bound, double t_gone, double way) {
    const spacetime_vehicle *car = &problem.vehicle;
    double best = HUGE_VAL;
    for (double v = 0.0; v <= car->v_max; v += 0.01) {
        double rest = car->reaction_time + v / car->d_max;
        double x = at - radius - car->radius - car->margin - v_bound * rest - v * car->reaction_time -
                   0.5 * v * v / car->d_max;
        best = fmin(best, t_gone + best_time(way - x, v));
    }
    return best;
}

static void test_a_mover_that_goes_is_passed_as_soon_as_passive_safety_allows(void) {
    static const double bounds[] = {0.0, 0.5, 1.0, 2.0};
    for (int i = 0; i < 4; i++) {
        setUp();
        begin_corridor(24.0);
        add_mover(0.0, (double[]){12.0, 0.6}, 30.0, (double[]){12.0, 0.6}, 0.4, bounds[i]);
        double best = best_behind(11.0, 0.4, bounds[i], 30.0, 21.95);
        (void)check_time(best, best + 0.3);
    }
}

static void test_a_mover_that_stays_closes_a_corridor(void) {
    begin_corridor(24.0);
    add_mover(0.0, (double[]){12.0, 0.6}, 200.0, (double[]){12.0, 0.6}, 0.4, 0.5);
    check_none();
}

// Is it passively safe all the way to leave the place `from` at t0 at full acceleration, along the corridor?
static bool is_safe_from(double from, double to, double t0) {
    const spacetime_vehicle *car = &problem.vehicle;
    double x = from, v = 0.0, mx, my;
    for (double t = t0; x < to - v * v / (2.0 * car->d_max); t += 0.01) {
        for (int m = 0; m < problem.movers; m++) {
            double rest = car->reaction_time + v / car->d_max;
            for (double tau = 0.0; tau <= rest && spacetime_mover_at(&problem.mover[m], t, &mx, &my); tau += 0.01) {
                double late = fmax(tau - car->reaction_time, 0.0);
                double p = 1.0 + x + v * tau - 0.5 * car->d_max * late * late;
                double apart = hypot(p - mx, 0.6 - my);
                if (apart < car->radius + car->margin + problem.mover[m].radius + problem.mover[m].v_bound * tau) {
                    return false;
                }
            }
        }
        v = fmin(v + 0.01 * car->a_max, car->v_max);
        x += 0.01 * v;
    }
    return true;
}

// At rest at `from` until leaving is safe; when it is there then.
static double time_of_waiting(double from, double way) {
    double t = best_time(from, 0.0);
    while (!is_safe_from(from, way, t)) {
        t += 0.05;
    }
    return t + best_time(way - from, 0.0);
}

static void test_a_mover_that_crosses_is_waited_for(void) {
    static const double speeds[] = {0.3, 0.5, 0.8};
    for (int i = 0; i < 3; i++) {
        setUp();
        begin_corridor(26.0);
        double w = speeds[i], meet = best_time(14.0, 0.0) - 2.0; // at x = 13 when the vehicle would be
        add_mover(0.0, (double[]){13.0, 0.6 - w * meet}, 100.0, (double[]){13.0, 0.6 + w * (100.0 - meet)}, 0.5, w);
        TEST_ASSERT_FALSE(is_safe_from(0.0, 24.0, 0.0));
        double most = HUGE_VAL;
        for (double from = 6.0; from <= 11.0; from += 0.5) {
            most = fmin(most, time_of_waiting(from, 23.95));
        }
        double touching = 0.5 + 0.3 + 0.1, clear = meet + touching / w; // the way's middle is free of it then
        double least = clear + best_time(23.95 - (12.0 - touching) - 1.0, problem.vehicle.v_max) - 1.0;
        double done = check_time(fmax(least - 2.0, best_time(23.95, 0.0)), most);
        TEST_ASSERT_TRUE(done > best_time(23.95, 0.0) + 2.0);
    }
}

static double follow_slow_mover(double height) {
    begin_corridor(30.0);
    problem.y_max = height;
    add_mover(0.0, (double[]){6.0, 0.6}, 60.0, (double[]){30.0, 0.6}, 0.4, 0.4); // 0.4 m/s, out of the hall at 60 s
    double done = 0.0;
    spacetime_verdict verdict = solve(&done);
    spacetime_end(&oracle);
    TEST_ASSERT_EQUAL_INT(SPACETIME_FOUND, verdict);
    return done;
}

static void test_a_slow_mover_is_overtaken_only_where_there_is_room(void) {
    double narrow = follow_slow_mover(1.2);
    TEST_ASSERT_TRUE(narrow >= (29.0 - 6.0) / 0.4 - 0.5); // its goal is free of it no sooner
    setUp();
    double wide = follow_slow_mover(8.0);
    setUp();
    begin_corridor(30.0);
    TEST_ASSERT_TRUE(wide <= 1.2 * best_time(28.0, 0.0));
}

static void test_reach_and_not_only_contact_keeps_the_vehicle_away(void) {
    // A mover beside the way, 1.5 m off: at 1 m/s the vehicle needs 2.3 s to be at rest, a mover of 0.6 m/s is there.
    begin_corridor(20.0);
    add_mover(0.0, (double[]){10.0, 2.1}, 200.0, (double[]){10.0, 2.1}, 0.3, 0.0);
    (void)check_time(best_time(17.95, 0.0), 1.05 * best_time(18.0, 0.0));
    problem.mover[0].v_bound = 0.6;
    double slower = check_time(best_time(17.95, 0.0) + 1.0, 60.0);
    TEST_ASSERT_TRUE(slower > 1.05 * best_time(18.0, 0.0));
    problem.mover[0].v_bound = 3.0; // even when creeping it is within reach
    check_none();
}

// ---- ways looked at closely

static uint64_t rng_state;

static double draw(double lo, double hi) { // xorshift
    rng_state ^= rng_state << 13;
    rng_state ^= rng_state >> 7;
    rng_state ^= rng_state << 17;
    return lo + (hi - lo) * (double)(rng_state >> 11) / 9007199254740992.0;
}

static void begin_drawn(uint64_t seed) {
    setUp();
    rng_state = 88172645463325252U + seed * 7919U;
    begin_hall(12.0, 10.0);
    problem.vehicle.radius = 0.0;
    problem.vehicle.body = (spacetime_polygon){{{-0.5, -0.3}, {0.7, -0.3}, {0.7, 0.3}, {-0.5, 0.3}}, 4};
    problem.vehicle.v_max = draw(0.6, 1.6);
    problem.vehicle.a_max = draw(0.4, 1.2);
    problem.vehicle.d_max = draw(0.5, 1.5);
    problem.vehicle.creep_clearance = 0.3;
    problem.start[0] = problem.start[1] = 1.5;
    problem.start[2] = 0.25 * PI;
    problem.goals = 1;
    problem.goal[0] = (spacetime_goal){10.5, 8.5, 0.1, 0.0, 4.0, 0.0};
    for (int i = 0; i < 3; i++) {
        double x = draw(3.0, 8.0), y = draw(2.0, 7.0);
        add_box(x, y, x + draw(0.3, 1.0), y + draw(0.3, 1.0));
    }
    for (int i = 0; i < 4; i++) {
        double a[2] = {draw(0.0, 12.0), draw(3.0, 10.0)}, b[2] = {draw(0.0, 12.0), draw(0.0, 10.0)};
        double t = draw(15.0, 60.0), v = hypot(b[0] - a[0], b[1] - a[1]) / t;
        add_mover(0.0, a, t, b, draw(0.2, 0.5), fmax(v, draw(0.3, 1.6)));
    }
}

// Of a point to the body at a pose; 0 inside.
static double body_gap(double x, double y, double theta, double px, double py) {
    double c = cos(theta), s = sin(theta), bx = c * (px - x) + s * (py - y), by = c * (py - y) - s * (px - x);
    double dx = fmax(fmax(-0.5 - bx, bx - 0.7), 0.0), dy = fmax(fabs(by) - 0.3, 0.0);
    return hypot(dx, dy);
}

// The least spare of passive safety when moving from (x, y) at speed v towards theta at time t.
static double spare_at(double t, double x, double y, double theta, double v) {
    const spacetime_vehicle *car = &problem.vehicle;
    double rest = car->reaction_time + v / car->d_max, least = HUGE_VAL, mx, my;
    for (int m = 0; m < problem.movers; m++) {
        const spacetime_mover *mover = &problem.mover[m];
        for (double tau = 0.0; tau <= rest && spacetime_mover_at(mover, t, &mx, &my); tau += 0.02) {
            double late = fmax(tau - car->reaction_time, 0.0), s = v * tau - 0.5 * car->d_max * late * late;
            double gap = body_gap(x + s * cos(theta), y + s * sin(theta), theta, mx, my);
            least = fmin(least, gap - car->margin - mover->radius - mover->v_bound * tau);
        }
    }
    return least;
}

// The gap to what stands still, from points all around the boxes and bounds.
static double still_gap(double x, double y, double theta) {
    double least = HUGE_VAL;
    for (int i = 0; i < problem.polygons; i++) {
        const double *lo = problem.polygon[i].v[0], *hi = problem.polygon[i].v[2];
        for (int k = 0; k <= 20; k++) {
            double u = lo[0] + (hi[0] - lo[0]) * k / 20.0, w = lo[1] + (hi[1] - lo[1]) * k / 20.0;
            least = fmin(least, fmin(body_gap(x, y, theta, u, lo[1]), body_gap(x, y, theta, u, hi[1])));
            least = fmin(least, fmin(body_gap(x, y, theta, lo[0], w), body_gap(x, y, theta, hi[0], w)));
        }
    }
    for (int k = 0; k <= 100; k++) {
        double u = 0.12 * k, w = 0.1 * k;
        least = fmin(least, fmin(body_gap(x, y, theta, u, 0.0), body_gap(x, y, theta, u, 10.0)));
        least = fmin(least, fmin(body_gap(x, y, theta, 0.0, w), body_gap(x, y, theta, 12.0, w)));
    }
    return least;
}

static void look_at_step(double t, const spacetime_state *a, const spacetime_state *b) {
    int dx = b->x - a->x, dy = b->y - a->y;
    double x = problem.start[0] + (a->x + oracle.x0) * oracle.h, y = problem.start[1] + (a->y + oracle.y0) * oracle.h;
    if (dx == 0 && dy == 0) {
        TEST_ASSERT_EQUAL_INT(0, a->level);
        TEST_ASSERT_EQUAL_INT(0, b->level);
        int turn = abs(a->dir - b->dir);
        TEST_ASSERT_TRUE(turn <= 1 || turn == SPACETIME_DIRS - 1);
        return;
    }
    double theta = 2.0 * PI / SPACETIME_DIRS * b->dir, v,
           whole = spacetime_gone(&oracle, a->level, b->level, oracle.dt, &v);
    TEST_ASSERT_TRUE(hypot(dx, dy) * oracle.h <= whole + 1e-6);
    double change = oracle.speed[b->level] - oracle.speed[a->level];
    TEST_ASSERT_TRUE(change <= problem.vehicle.a_max * oracle.dt + 1e-6);
    TEST_ASSERT_TRUE(-change <= problem.vehicle.d_max * oracle.dt + 1e-6);
    for (double tau = 0.0; tau < oracle.dt; tau += 0.01) {
        double share = spacetime_gone(&oracle, a->level, b->level, tau, &v) / whole;
        double px = x + share * dx * oracle.h, py = y + share * dy * oracle.h;
        TEST_ASSERT_TRUE_MESSAGE(spare_at(t + tau, px, py, theta, v) > -0.02, "not passively safe");
        TEST_ASSERT_TRUE_MESSAGE(still_gap(px, py, theta) >= problem.vehicle.margin - 0.01,
                                 "touches what stands still");
    }
}

enum { HALLS = CASES(12) };

static void test_ways_found_are_passively_safe_at_every_instant(void) {
    static spacetime_state way[1000];
    int found = 0, late = 0;
    for (uint64_t seed = 1; seed <= HALLS; seed++) {
        double done, blind;
        begin_drawn(seed);
        TEST_ASSERT_TRUE(spacetime_begin(&oracle, &problem));
        oracle.blind = true;
        spacetime_verdict verdict = spacetime_run(&oracle, &blind, NULL);
        oracle.blind = false;
        oracle.keep = true;
        if (verdict == SPACETIME_FOUND && spacetime_run(&oracle, &done, NULL) == SPACETIME_FOUND) {
            int count = spacetime_trace(&oracle, way, 1000);
            TEST_ASSERT_TRUE(count > 0);
            TEST_ASSERT_DOUBLE_WITHIN(1e-6, done, (count - 1) * oracle.dt);
            for (int k = 1; k < count; k++) {
                look_at_step((k - 1) * oracle.dt, &way[k - 1], &way[k]);
            }
            found++;
            late += done > blind ? 1 : 0;
            TEST_ASSERT_TRUE(done >= blind);
        }
        spacetime_end(&oracle);
    }
    printf("ways: %d of %d halls, %d of them later for the movers\n", found, HALLS, late);
    TEST_ASSERT_TRUE(found >= CASES(10));
    TEST_ASSERT_TRUE(late >= HALLS / 4);
}

// ---- sets of cells

static void fill(spacetime_bits *bits, bool cell[20][150]) {
    for (int y = 0; y < 20; y++) {
        for (int x = 0; x < 150; x++) {
            cell[y][x] = draw(0.0, 1.0) < 0.4;
            if (cell[y][x]) {
                spacetime_bits_put(bits, x, y);
            }
        }
    }
}

static bool in(bool cell[20][150], int x, int y) {
    return x >= 0 && y >= 0 && x < 150 && y < 20 && cell[y][x];
}

static void compare_moved(int dx, int dy) {
    static bool a[20][150], b[20][150];
    spacetime_bits p, q, r;
    TEST_ASSERT_TRUE(spacetime_bits_begin(&p, 150, 20) && spacetime_bits_begin(&q, 150, 20));
    TEST_ASSERT_TRUE(spacetime_bits_begin(&r, 150, 20));
    fill(&p, a);
    fill(&q, b);
    spacetime_bits_copy(&r, &p);
    spacetime_bits_or_moved(&r, &q, dx, dy);
    spacetime_bits_and_at(&p, &q, dx, dy);
    int first = (int)draw(-20.0, 100.0), last = (int)draw(0.0, 200.0), row = (int)draw(0.0, 20.0);
    spacetime_bits_take_out(&q, row, first, last);
    for (int y = 0; y < 20; y++) {
        for (int x = 0; x < 150; x++) {
            TEST_ASSERT_EQUAL(in(a, x, y) || in(b, x - dx, y - dy), spacetime_bits_has(&r, x, y));
            TEST_ASSERT_EQUAL(in(a, x, y) && in(b, x + dx, y + dy), spacetime_bits_has(&p, x, y));
            bool out = y == row && x >= first && x <= last;
            TEST_ASSERT_EQUAL(in(b, x, y) && !out, spacetime_bits_has(&q, x, y));
        }
    }
    spacetime_bits_end(&p);
    spacetime_bits_end(&q);
    spacetime_bits_end(&r);
}

static void test_sets_moved_as_a_whole_are_as_moved_one_by_one(void) {
    rng_state = 1234567;
    for (int dy = -25; dy <= 25; dy += 5) {
        for (int dx = -63; dx <= 63; dx += 7) {
            compare_moved(dx, dy);
        }
    }
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_a_clear_corridor_takes_the_time_of_a_trapezoid);
    RUN_TEST(test_creep_speed_holds_near_things);
    RUN_TEST(test_a_gap_narrower_than_the_body_is_closed);
    RUN_TEST(test_goals_are_visited_in_order_with_their_dwells);
    RUN_TEST(test_turning_round_takes_its_time);
    RUN_TEST(test_a_mover_that_goes_is_passed_as_soon_as_passive_safety_allows);
    RUN_TEST(test_a_mover_that_stays_closes_a_corridor);
    RUN_TEST(test_a_mover_that_crosses_is_waited_for);
    RUN_TEST(test_a_slow_mover_is_overtaken_only_where_there_is_room);
    RUN_TEST(test_reach_and_not_only_contact_keeps_the_vehicle_away);
    RUN_TEST(test_ways_found_are_passively_safe_at_every_instant);
    RUN_TEST(test_sets_moved_as_a_whole_are_as_moved_one_by_one);
    return UNITY_END();
}
