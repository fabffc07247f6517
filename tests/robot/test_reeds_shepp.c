// Every word is driven in long double; no drive of arcs and lines drawn at random is shorter than the shortest word.
#include "robot/reeds_shepp.h"

#include "base/rng.h"
#include "unity.h"

#include <math.h>

enum { SEEDS = 20000 };

#define RADIUS 1.5

void setUp(void) {}
void tearDown(void) {}

static double uniform(aisle_rng *rng, double lo, double hi) {
    return lo + (hi - lo) * (double)aisle_rng_float(rng);
}

typedef struct place {
    long double x, y, theta;
} place;

// An arc by its centre, in long double: nothing of move.c.
static place drive(place p, long double length, long double turn) {
    if (fabsl(turn) <= 0.0L) {
        return (place){p.x + length * cosl(p.theta), p.y + length * sinl(p.theta), p.theta};
    }
    long double radius = length / turn; // signed: the centre on the left if positive
    long double cx = p.x - radius * sinl(p.theta), cy = p.y + radius * cosl(p.theta);
    long double theta = p.theta + turn;
    return (place){cx + radius * sinl(theta), cy - radius * cosl(theta), theta};
}

static double length_of(const aisle_reeds_shepp_word *word) {
    double sum = 0.0;
    for (uint32_t i = 0; i < word->count; i++) {
        sum += fabs(word->move[i].length);
    }
    return sum;
}

static void judge(const aisle_reeds_shepp_word *word, aisle_pose2 from, place to) {
    place p = {(long double)from.x, (long double)from.y, (long double)from.theta};
    for (uint32_t i = 0; i < word->count; i++) {
        double turn = fabs(word->move[i].turn), length = fabs(word->move[i].length);
        TEST_ASSERT_TRUE(turn <= 0.0 || fabs(length / turn - RADIUS) < 1e-9);
        p = drive(p, (long double)word->move[i].length, (long double)word->move[i].turn);
    }
    TEST_ASSERT_DOUBLE_WITHIN(1e-7, (double)to.x, (double)p.x);
    TEST_ASSERT_DOUBLE_WITHIN(1e-7, (double)to.y, (double)p.y);
    TEST_ASSERT_DOUBLE_WITHIN(1e-7, 0.0, (double)remainderl(to.theta - p.theta, 2.0L * acosl(-1.0L)));
}

// Shortest of all words, each judged; INFINITY: none.
static double shortest(aisle_pose2 from, place to) {
    aisle_pose2 end = {(double)to.x, (double)to.y, (double)remainderl(to.theta, 2.0L * acosl(-1.0L))};
    double best = (double)INFINITY;
    const aisle_reeds_shepp between = aisle_reeds_shepp_between(from, end, RADIUS);
    for (uint32_t n = 0; n < AISLE_REEDS_SHEPP_WORDS; n++) {
        aisle_reeds_shepp_word word;
        if (aisle_reeds_shepp_word_of(&between, n, (double)INFINITY, &word)) {
            judge(&word, from, to);
            best = fmin(best, length_of(&word));
        }
    }
    return best;
}

static void test_no_drive_is_shorter_than_the_shortest_word_and_every_word_leads_there(void) {
    for (uint64_t s = 0; s < SEEDS; s++) {
        aisle_rng rng = aisle_rng_seed(s);
        aisle_pose2 from = {3.0, -2.0, uniform(&rng, -3.0, 3.0)};
        place p = {(long double)from.x, (long double)from.y, (long double)from.theta};
        double driven = 0.0;
        for (uint64_t i = 0; i <= s % 5U; i++) {
            double length = uniform(&rng, -4.5, 4.5);
            double bend = (double)aisle_rng_below(&rng, 3U) - 1.0;
            driven += fabs(length);
            p = drive(p, (long double)length, (long double)(length * bend / RADIUS));
        }
        TEST_ASSERT_TRUE(shortest(from, p) <= driven + 1e-6);
    }
}

static void test_every_word_exists_somewhere(void) {
    int found[AISLE_REEDS_SHEPP_WORDS] = {0};
    for (uint64_t s = 0; s < 2000; s++) {
        aisle_rng rng = aisle_rng_seed(s);
        aisle_pose2 from = {0.0, 0.0, 0.0}, to;
        to.x = uniform(&rng, -8.0, 8.0);
        to.y = uniform(&rng, -8.0, 8.0);
        to.theta = uniform(&rng, -3.1, 3.1);
        const aisle_reeds_shepp between = aisle_reeds_shepp_between(from, to, RADIUS);
        for (uint32_t n = 0; n < AISLE_REEDS_SHEPP_WORDS; n++) {
            aisle_reeds_shepp_word word;
            found[n] += aisle_reeds_shepp_word_of(&between, n, (double)INFINITY, &word) ? 1 : 0;
        }
    }
    for (uint32_t n = 0; n < AISLE_REEDS_SHEPP_WORDS; n++) {
        TEST_ASSERT_TRUE(found[n] >= 20);
    }
}

static void test_both_ways_are_as_long(void) {
    for (uint64_t s = 0; s < 500; s++) {
        aisle_rng rng = aisle_rng_seed(s);
        double x = uniform(&rng, -6.0, 6.0), y = uniform(&rng, -6.0, 6.0), theta = uniform(&rng, -3.0, 3.0);
        aisle_pose2 a = {0.0, 0.0, 0.0}, b = {x, y, theta};
        double there = shortest(a, (place){(long double)x, (long double)y, (long double)theta});
        double back = shortest(b, (place){0.0L, 0.0L, 0.0L});
        TEST_ASSERT_DOUBLE_WITHIN(1e-7, there, back);
        TEST_ASSERT_TRUE(there >= hypot(x, y) - 1e-9);
    }
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_no_drive_is_shorter_than_the_shortest_word_and_every_word_leads_there);
    RUN_TEST(test_every_word_exists_somewhere);
    RUN_TEST(test_both_ways_are_as_long);
    return UNITY_END();
}
