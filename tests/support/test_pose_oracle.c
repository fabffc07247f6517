// What the oracle of poses must know: gaps, turns and corners whose limits are known in closed form, and that what one
// half of it joins the other half does not part.
#include "cases.h"
#include "pose_oracle.h"
#include "unity.h"

#include <math.h>
#include <stdlib.h>

#define PI 3.14159265358979323846

void setUp(void) {}
void tearDown(void) {}

static pose_oracle oracle;

static void box(double x0, double y0, double x1, double y1) {
    const double v[4][2] = {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}};
    pose_oracle_add(&oracle, v, 4);
}

static void body(double length, double width, double margin, double radius_min) {
    const double l = 0.5 * length, w = 0.5 * width;
    const double v[4][2] = {{-l, -w}, {l, -w}, {l, w}, {-l, w}};
    pose_oracle_body(&oracle, v, 4, margin, radius_min);
}

static bool asked(bool (*fill)(pose_oracle *), double x0, double y0, double t0, double x1, double y1, double t1) {
    const double from[3] = {x0, y0, t0}, to[3] = {x1, y1, t1};
    TEST_ASSERT_TRUE(fill(&oracle));
    bool joined = pose_oracle_joined(&oracle, from, to);
    pose_oracle_end(&oracle);
    return joined;
}

static void gaps_are_those_of_the_outlines(void) {
    pose_oracle_begin(&oracle, 10.0, 10.0);
    box(6.0, 4.0, 7.0, 6.0);
    body(2.0, 1.0, 0.0, 0.0);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 1.0, pose_oracle_gap(&oracle, 4.0, 5.0, 0.0));
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 1.5, pose_oracle_gap(&oracle, 4.0, 5.0, 0.5 * PI));
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 2.0 - 1.5 * sqrt(0.5), pose_oracle_gap(&oracle, 4.0, 5.0, 0.25 * PI));
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0.25, pose_oracle_gap(&oracle, 1.25, 5.0, PI)); // the bounds
    TEST_ASSERT_TRUE(pose_oracle_gap(&oracle, 5.5, 5.0, 0.0) < 0.0);
    TEST_ASSERT_TRUE(pose_oracle_gap(&oracle, 0.5, 5.0, 0.0) < 0.0);
}

static double drawn(uint32_t *state, double below) {
    *state = *state * 1664525U + 1013904223U;
    return below * (double)(*state >> 8) / 16777216.0;
}

#define SAMPLES 400 // of each side

static void sample(const double v[4][2], int i, double out[2]) {
    const double t = (double)(i % SAMPLES) / SAMPLES;
    const double *a = v[i / SAMPLES], *b = v[(i / SAMPLES + 1) % 4];
    out[0] = a[0] + t * (b[0] - a[0]);
    out[1] = a[1] + t * (b[1] - a[1]);
}

// From points of one outline to the sides of the other box, which lie along the axes.
static double sampled_gap(const double placed[4][2], const double b[4], bool *overlap) {
    double least = HUGE_VAL;
    for (int i = 0; i < 4 * SAMPLES; i++) {
        double p[2];
        sample(placed, i, p);
        const double dx = fmax(fmax(b[0] - p[0], p[0] - b[2]), 0.0), dy = fmax(fmax(b[1] - p[1], p[1] - b[3]), 0.0);
        least = fmin(least, hypot(dx, dy));
    }
    *overlap = least <= 0.0;
    return least;
}

static void gaps_are_those_of_sampled_outlines(void) {
    uint32_t state = 5;
    int apart = 0, met = 0;
    for (int i = 0; i < CASES(300); i++) {
        const double x = 3.0 + drawn(&state, 4.0), y = 3.0 + drawn(&state, 4.0), theta = drawn(&state, 2.0 * PI);
        const double b[4] = {5.0, 5.0, 5.1 + drawn(&state, 1.0), 5.1 + drawn(&state, 1.0)};
        double placed[4][2];
        bool overlap;
        pose_oracle_begin(&oracle, 10.0, 10.0);
        box(b[0], b[1], b[2], b[3]);
        body(1.8, 0.9, 0.0, 0.0);
        for (int k = 0; k < 4; k++) {
            const double bx = oracle.body.v[k][0], by = oracle.body.v[k][1];
            placed[k][0] = x + cos(theta) * bx - sin(theta) * by;
            placed[k][1] = y + sin(theta) * bx + cos(theta) * by;
        }
        const double seen = sampled_gap((const double(*)[2])placed, b, &overlap);
        const double told = pose_oracle_gap(&oracle, x, y, theta);
        const double centre_x = 0.5 * (b[0] + b[2]) - x, centre_y = 0.5 * (b[1] + b[3]) - y; // of a box within the body
        overlap = overlap || (fabs(cos(theta) * centre_x + sin(theta) * centre_y) < 0.9 &&
                              fabs(cos(theta) * centre_y - sin(theta) * centre_x) < 0.45);
        if (overlap) {
            TEST_ASSERT_TRUE(told < 0.0);
        } else if (told >= 0.0) {
            TEST_ASSERT_DOUBLE_WITHIN(1.8 / SAMPLES, seen, told);
        } else {
            TEST_ASSERT_TRUE(seen < 1.8 / SAMPLES); // a corner between two samples
        }
        apart += told > 0.0;
        met += told < 0.0;
    }
    TEST_ASSERT_GREATER_THAN_INT(CASES(50), apart);
    TEST_ASSERT_GREATER_THAN_INT(CASES(50), met);
}

// A corridor of 1 m leaves 5 cm on either side of a body of 0.9 m. What "enclose" takes off the body is at most a step's
// half diagonal and the body's half diagonal times half a step of its headings.
static void a_corridor_is_told_from_one_too_narrow(void) {
    const double off = POSE_ORACLE_STEP * sqrt(0.5) + hypot(0.9, 0.45) * PI / (4.0 * POSE_ORACLE_HEADINGS);
    const double margins[4] = {0.046, 0.0501, 0.05 + 0.9 * off, 0.05 + 1.1 * off};
    const bool connected[4] = {true, false, false, false}, enclosed[4] = {true, true, true, false};
    for (int car = 0; car < 2; car++) {
        for (int i = 0; i < 4; i++) {
            pose_oracle_begin(&oracle, 6.0, 1.0);
            body(1.8, 0.9, margins[i], car ? 1.5 : 0.0);
            TEST_ASSERT_EQUAL(connected[i], asked(pose_oracle_connect, 1.5, 0.5, 0.0, 4.5, 0.5, 0.0));
            TEST_ASSERT_EQUAL(enclosed[i], asked(pose_oracle_enclose, 1.5, 0.5, 0.0, 4.5, 0.5, 0.0));
        }
    }
}

// To turn round in a corridor as wide as W, a rectangle's diagonal and two margins must fit into W.
static void a_body_turns_where_its_diagonal_fits(void) {
    const double margin = 0.5 * (2.2 - hypot(1.8, 0.9)); // that just fits
    for (int car = 0; car < 2; car++) {
        pose_oracle_begin(&oracle, 6.0, 2.2);
        body(1.8, 0.9, margin + 1e-4, car ? 1.5 : 0.0);
        TEST_ASSERT_FALSE(asked(pose_oracle_connect, 3.0, 1.1, 0.0, 3.0, 1.1, PI));
        TEST_ASSERT_TRUE(asked(pose_oracle_connect, 2.0, 1.1, 0.0, 4.0, 1.1, 0.0));
        body(1.8, 0.9, margin + 0.1, car ? 1.5 : 0.0);
        TEST_ASSERT_FALSE(asked(pose_oracle_enclose, 3.0, 1.1, 0.0, 3.0, 1.1, PI));
        TEST_ASSERT_TRUE(asked(pose_oracle_enclose, 2.0, 1.1, 0.0, 4.0, 1.1, 0.0));
    }
    body(1.8, 0.9, margin - 0.005, 0.0);
    TEST_ASSERT_TRUE(asked(pose_oracle_connect, 3.0, 1.1, 0.0, 3.0, 1.1, PI));
    body(1.8, 0.9, margin - 1e-4, 0.0);
    TEST_ASSERT_TRUE(asked(pose_oracle_enclose, 3.0, 1.1, 0.0, 3.0, 1.1, PI));
}

// Round the corner of two corridors, both as wide as A: L <= 2 sqrt(2) A - 2 W, the rectangle at 45 degrees.
static void a_body_gets_round_a_corner_up_to_its_known_length(void) {
    const double longest = 2.0 * sqrt(2.0) * 2.0 - 2.0 * 0.9;
    pose_oracle_begin(&oracle, 5.0, 5.0);
    box(2.0, 2.0, 5.0, 5.0);
    body(longest - 0.35, 0.9, 0.0, 0.0);
    TEST_ASSERT_TRUE(asked(pose_oracle_connect, 1.0, 2.6, -0.5 * PI, 2.6, 1.0, 0.0));
    body(longest - 0.01, 0.9, 0.0, 0.0);
    TEST_ASSERT_TRUE(asked(pose_oracle_enclose, 1.0, 2.6, -0.5 * PI, 2.6, 1.0, 0.0));
    body(longest + 0.01, 0.9, 0.0, 0.0);
    TEST_ASSERT_FALSE(asked(pose_oracle_connect, 1.0, 2.6, -0.5 * PI, 2.6, 1.0, 0.0));
    body(longest + 0.75, 0.9, 0.0, 0.0);
    TEST_ASSERT_FALSE(asked(pose_oracle_enclose, 1.0, 2.6, -0.5 * PI, 2.6, 1.0, 0.0));
}

static void a_car_turns_round_by_reversing_where_it_has_room(void) {
    pose_oracle_begin(&oracle, 5.0, 5.0);
    body(1.8, 0.9, 0.05, 1.5);
    TEST_ASSERT_TRUE(asked(pose_oracle_connect, 2.5, 2.5, 0.0, 2.5, 2.5, PI));
    TEST_ASSERT_TRUE(asked(pose_oracle_connect, 2.5, 2.5, 0.0, 2.5, 2.0, 0.0)); // sideways
}

// A bend of 1.1 m round which a car just gets forwards, to the left and to the right, and backwards the other way.
static void a_car_takes_bends_to_either_side(void) {
    for (int right = 0; right < 2; right++) {
        const double y = right ? 1.0 : 3.0, heading = right ? 0.5 * PI : -0.5 * PI; // in the arm along the x axis
        pose_oracle_begin(&oracle, 4.0, 4.0);
        box(1.1, right ? 0.0 : 1.1, 4.0, right ? 2.9 : 4.0);
        body(1.2, 0.6, 0.05, 1.0);
        TEST_ASSERT_TRUE(asked(pose_oracle_connect, 0.55, y, heading, 3.0, right ? 3.45 : 0.55, 0.0));
        TEST_ASSERT_TRUE(asked(pose_oracle_connect, 0.55, y, -heading, 3.0, right ? 3.45 : 0.55, PI));
        TEST_ASSERT_FALSE(asked(pose_oracle_connect, 0.55, y, heading, 3.0, right ? 3.45 : 0.55, PI));
    }
}

// In 5 m a body of 1.8 m goes 3.1 m ahead. An arc to the next heading takes twice its radius times the tangent of half the
// angle, which is 11.3 degrees from the axes: 2.4 m at a radius of 12 m, 4 m at 20 m.
static void arcs_are_no_tighter_than_the_car(void) {
    const double radii[2] = {12.0, 20.0};
    for (int car = 0; car < 2; car++) {
        int reached = 0;
        pose_oracle_begin(&oracle, 5.0, 5.0);
        body(1.8, 0.9, 0.05, radii[car]);
        TEST_ASSERT_TRUE(pose_oracle_connect(&oracle));
        for (int i = 0; i < oracle.nx * oracle.ny; i++) {
            const double from[3] = {2.5, 2.5, 0.0};
            for (int k = -1; k <= 1; k += 2) {
                const double to[3] = {i % oracle.nx * POSE_ORACLE_STEP, i / oracle.nx * POSE_ORACLE_STEP,
                                      pose_oracle_heading(k)};
                reached += pose_oracle_joined(&oracle, from, to);
            }
        }
        pose_oracle_end(&oracle);
        TEST_ASSERT_TRUE(car == 0 ? reached > 0 : reached == 0);
    }
}

static void a_car_cannot_turn_where_a_body_turns_on_the_spot(void) {
    for (int car = 0; car < 2; car++) {
        pose_oracle_begin(&oracle, 2.2, 2.2);
        body(1.8, 0.9, 0.05, car ? 1.5 : 0.0);
        TEST_ASSERT_EQUAL(car == 0, asked(pose_oracle_connect, 1.1, 1.1, 0.0, 1.1, 1.1, PI));
    }
}

// The dead end leads upwards from a room; in it nobody turns.
static void a_dead_end_is_left_backwards(void) {
    for (int car = 0; car < 2; car++) {
        const double north = 0.5 * PI, south = -0.5 * PI;
        pose_oracle_begin(&oracle, 5.0, 8.0);
        box(0.0, 5.0, 1.9, 8.0);
        box(3.1, 5.0, 5.0, 8.0);
        body(1.8, 0.9, 0.05, car ? 1.5 : 0.0);
        TEST_ASSERT_TRUE(asked(pose_oracle_connect, 2.5, 7.0, north, 2.5, 2.5, north));
        TEST_ASSERT_TRUE(asked(pose_oracle_connect, 2.5, 7.0, north, 2.5, 7.0, south)); // out, round, in again
        box(0.0, 0.0, 1.9, 5.0);                                                        // now it is an alley all along
        box(3.1, 0.0, 5.0, 5.0);
        TEST_ASSERT_TRUE(asked(pose_oracle_connect, 2.5, 7.0, north, 2.5, 2.5, north));
        TEST_ASSERT_FALSE(asked(pose_oracle_connect, 2.5, 7.0, north, 2.5, 7.0, south));
        TEST_ASSERT_FALSE(asked(pose_oracle_enclose, 2.5, 7.0, north, 2.5, 7.0, south));
        TEST_ASSERT_TRUE(asked(pose_oracle_connect, 2.5, 7.0, north, 2.5, 2.5, (double)NAN));
        TEST_ASSERT_TRUE(asked(pose_oracle_connect, 2.5, 7.0, (double)NAN, 2.5, 2.5, south));
    }
}

static void walls_part_whatever_the_heading(void) {
    pose_oracle_begin(&oracle, 8.0, 4.0);
    box(3.9, 0.0, 4.1, 4.0);
    body(1.8, 0.9, 0.05, 0.0);
    TEST_ASSERT_FALSE(asked(pose_oracle_connect, 2.0, 2.0, 0.0, 6.0, 2.0, (double)NAN));
    TEST_ASSERT_FALSE(asked(pose_oracle_enclose, 2.0, 2.0, 0.0, 6.0, 2.0, (double)NAN));
    TEST_ASSERT_TRUE(asked(pose_oracle_connect, 2.0, 2.0, 0.0, 1.5, 2.0, (double)NAN));
    TEST_ASSERT_FALSE(asked(pose_oracle_connect, 2.0, 2.0, 0.0, 4.0, 2.0, (double)NAN)); // in the wall
}

#define STOPS 200

static void what_is_connected_is_not_parted(void) {
    int joined = 0, parted = 0;
    for (uint32_t seed = 1; seed <= CASES(4); seed++) {
        uint32_t state = seed;
        double at[STOPS][3];
        bool connected[STOPS];
        pose_oracle_begin(&oracle, 6.0, 5.0);
        for (int i = 0; i < 6; i++) {
            double x = drawn(&state, 5.5), y = drawn(&state, 4.5);
            box(x, y, x + 0.2 + drawn(&state, 0.8), y + 0.2 + drawn(&state, 0.8));
        }
        body(1.2, 0.6, 0.05, seed % 2U == 0 ? 0.8 : 0.0);
        for (int i = 0; i < STOPS; i++) {
            at[i][0] = floor(drawn(&state, 120.0)) * POSE_ORACLE_STEP;
            at[i][1] = floor(drawn(&state, 100.0)) * POSE_ORACLE_STEP;
            at[i][2] = pose_oracle_heading((int)drawn(&state, POSE_ORACLE_HEADINGS));
        }
        TEST_ASSERT_TRUE(pose_oracle_connect(&oracle));
        for (int i = 1; i < STOPS; i++) {
            connected[i] = pose_oracle_joined(&oracle, at[i - 1], at[i]);
        }
        pose_oracle_end(&oracle);
        TEST_ASSERT_TRUE(pose_oracle_enclose(&oracle));
        for (int i = 1; i < STOPS; i++) {
            bool enclosed = pose_oracle_joined(&oracle, at[i - 1], at[i]);
            TEST_ASSERT_TRUE(enclosed || !connected[i]);
            joined += connected[i];
            parted += !enclosed;
        }
        pose_oracle_end(&oracle);
    }
    TEST_ASSERT_GREATER_THAN_INT(CASES(30), joined);
    TEST_ASSERT_GREATER_THAN_INT(CASES(30), parted);
}

#define SIDE 4.0 // m

// Mirrored about x = SIDE / 2 (1), about the diagonal (2), or both.
static void mirror(int how, double p[3]) {
    if (how & 1) {
        p[0] = SIDE - p[0];
        p[2] = PI - p[2];
    }
    if (how & 2) {
        const double x = p[0];
        p[0] = p[1];
        p[1] = x;
        p[2] = 0.5 * PI - p[2];
    }
}

static void draw_mirrored(uint32_t seed, int how, double at[STOPS][3]) {
    uint32_t state = seed;
    pose_oracle_begin(&oracle, SIDE, SIDE);
    for (int i = 0; i < 4; i++) {
        double a[3] = {drawn(&state, 3.5), drawn(&state, 3.5), 0.0}, b[3] = {a[0] + 0.3, a[1] + 0.2, 0.0};
        mirror(how, a);
        mirror(how, b);
        box(fmin(a[0], b[0]), fmin(a[1], b[1]), fmax(a[0], b[0]), fmax(a[1], b[1]));
    }
    body(1.2, 0.6, 0.05, seed % 2U == 0 ? 0.7 : 0.0);
    for (int i = 0; i < STOPS; i++) {
        at[i][0] = floor(drawn(&state, SIDE / POSE_ORACLE_STEP)) * POSE_ORACLE_STEP;
        at[i][1] = floor(drawn(&state, SIDE / POSE_ORACLE_STEP)) * POSE_ORACLE_STEP;
        at[i][2] = pose_oracle_heading((int)drawn(&state, POSE_ORACLE_HEADINGS));
        mirror(how, at[i]);
    }
}

static void a_mirrored_hall_has_the_same_ways(void) {
    int joined = 0;
    for (uint32_t seed = 1; seed <= CASES(3); seed++) {
        bool straight[STOPS] = {false};
        for (int how = 0; how < 4; how++) {
            double at[STOPS][3];
            draw_mirrored(seed, how, at);
            TEST_ASSERT_TRUE(pose_oracle_connect(&oracle));
            for (int i = 1; i < STOPS; i++) {
                const bool way = pose_oracle_joined(&oracle, at[i - 1], at[i]);
                straight[i] = how == 0 ? way : straight[i];
                TEST_ASSERT_EQUAL(straight[i], way);
                joined += way;
            }
            pose_oracle_end(&oracle);
        }
    }
    TEST_ASSERT_GREATER_THAN_INT(CASES(30), joined);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(gaps_are_those_of_the_outlines);
    RUN_TEST(gaps_are_those_of_sampled_outlines);
    RUN_TEST(a_corridor_is_told_from_one_too_narrow);
    RUN_TEST(a_body_turns_where_its_diagonal_fits);
    RUN_TEST(a_body_gets_round_a_corner_up_to_its_known_length);
    RUN_TEST(a_car_turns_round_by_reversing_where_it_has_room);
    RUN_TEST(a_car_takes_bends_to_either_side);
    RUN_TEST(arcs_are_no_tighter_than_the_car);
    RUN_TEST(a_car_cannot_turn_where_a_body_turns_on_the_spot);
    RUN_TEST(a_dead_end_is_left_backwards);
    RUN_TEST(walls_part_whatever_the_heading);
    RUN_TEST(what_is_connected_is_not_parted);
    RUN_TEST(a_mirrored_hall_has_the_same_ways);
    return UNITY_END();
}
