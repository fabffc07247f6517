#include "plan/arm_free.h" // first: proves that the header stands alone

#include "arm_hall.h"

enum { SEEDS = 90, FINE = 1200, COARSE = 40 };

void setUp(void) {
    arm_hall_begin();
}
void tearDown(void) {}

static void open_hall(uint32_t links) {
    arm_msg.num_links = (int8_t)links;
    hall_add(6.1, 5.1, 6.3, 5.3);
    hall_add(5.9, 4.4, 6.2, 4.6);
    (void)arm_hall_open(64U);
}

// Least gap on the piece up to `until`, at FINE places by the world's gap (test_arm_world.c judges that), at COARSE by the judge.
static double least_gap(const aisle_arm_piece *piece, double until) {
    double least = INFINITY, q[3];
    for (int i = 0; i <= FINE; i++) {
        aisle_arm_piece_at(piece, until * (double)i / FINE, 0, q);
        least = fmin(least, aisle_arm_world_gap(&world, q, 0.3, NULL, NULL));
        if (arm.links == 3U && i % (FINE / COARSE) == 0) {
            TEST_ASSERT_TRUE(least < AISLE_ARM_KEEP || arm_judged(q) > 0.0);
        }
    }
    return least;
}

static void draw_ends(uint64_t seed, double *from, double *to, double *bend) {
    aisle_rng rng = aisle_rng_seed(seed);
    const double part = seed % 3U == 0U ? 0.1 : 1.0; // a short way, too
    arm_draw(&rng, from);
    arm_draw(&rng, to);
    for (uint32_t j = 0; j < 3U; j++) {
        to[j] = from[j] + part * (to[j] - from[j]);
    }
    for (int i = 0; i < 6; i++) {
        bend[i] = part * 40.0 * ((double)aisle_rng_float(&rng) - 0.5);
    }
}

static void test_a_piece_called_free_keeps_its_distance_everywhere_and_others_touch(void) {
    for (uint32_t links = 1; links <= 3U; links++) {
        int free_ones = 0, blocked = 0;
        arm_hall_begin();
        open_hall(links);
        for (uint64_t seed = 0; seed < SEEDS; seed++) {
            double from[3], to[3], bend[6], until;
            aisle_arm_piece piece;
            uint32_t units = 0;
            draw_ends(seed, from, to, bend);
            aisle_arm_piece_of(links, from, to, bend, &piece);
            const bool is_free = aisle_arm_free_piece(&world, &piece, &units, &until);
            TEST_ASSERT_TRUE(until <= 0.0 || least_gap(&piece, until) >= 0.5 * AISLE_ARM_KEEP);
            TEST_ASSERT_TRUE(is_free ? until >= 1.0 : least_gap(&piece, 1.0) < 1.1 * AISLE_ARM_KEEP);
            TEST_ASSERT_TRUE(units > 0U && units % AISLE_ARM_UNITS == 0U);
            free_ones += is_free ? 1 : 0;
            blocked += is_free ? 0 : 1;
        }
        TEST_ASSERT_TRUE(free_ones > 5 && (links == 1U || blocked > 5));
    }
}
static void test_a_line_called_free_keeps_its_distance_everywhere_and_others_touch(void) {
    for (uint32_t links = 1; links <= 3U; links++) {
        int free_ones = 0, blocked = 0;
        arm_hall_begin();
        open_hall(links);
        for (uint64_t seed = 0; seed < SEEDS; seed++) {
            double from[3], to[3], bend[6];
            aisle_arm_piece piece;
            uint32_t units = 0;
            draw_ends(seed, from, to, bend);
            aisle_arm_piece_of(links, from, to, NULL, &piece);
            const bool is_free = aisle_arm_free_line(&world, from, to, &units);
            const double least = least_gap(&piece, 1.0);
            TEST_ASSERT_TRUE(is_free ? least >= 0.5 * AISLE_ARM_KEEP : least < 1.1 * AISLE_ARM_KEEP);
            free_ones += is_free ? 1 : 0;
            blocked += is_free ? 0 : 1;
        }
        TEST_ASSERT_TRUE(free_ones > 5 && (links == 1U || blocked > 5));
    }
}
static void test_posts_that_are_thin_are_not_jumped_over(void) {
    int free_ones = 0, blocked = 0;
    for (int i = 0; i < 10; i++) { // 3 mm each, all about the base
        const double angle = 2.399963 * i, x = 5.5 + 0.36 * sqrt(i + 1.0) * cos(angle) + 0.3;
        const double y = 5.0 + 0.36 * sqrt(i + 1.0) * sin(angle);
        if (x > 5.6) {
            hall_add(x, y, x + 0.003, y + 0.003);
        }
    }
    (void)arm_hall_open(64U);
    for (uint64_t seed = 0; seed < SEEDS; seed++) {
        aisle_rng rng = aisle_rng_seed(seed);
        double from[3], to[3], bend[6];
        aisle_arm_piece piece;
        uint32_t units = 0;
        for (uint32_t j = 0; j < 3U; j++) { // joints that turn the same way, which adds up
            from[j] = uniform(&rng, j == 0U ? -0.8 : -1.2, j == 0U ? 0.5 : 0.9);
            to[j] = from[j] + (j > 0U ? 0.35 : 0.25);
            bend[2U * j] = seed % 2U == 0U ? 0.0 : 60.0;
            bend[2U * j + 1U] = seed % 2U == 0U ? 0.0 : uniform(&rng, -100.0, 100.0);
        }
        aisle_arm_piece_of(3U, from, to, bend, &piece);
        const bool is_free = seed % 2U == 0U ? aisle_arm_free_line(&world, from, to, &units)
                                             : aisle_arm_free_piece(&world, &piece, &units, NULL);
        const double least = least_gap(&piece, 1.0);
        TEST_ASSERT_TRUE(is_free ? least >= 0.5 * AISLE_ARM_KEEP : least < 1.1 * AISLE_ARM_KEEP);
        free_ones += is_free ? 1 : 0;
        blocked += is_free ? 0 : 1;
    }
    TEST_ASSERT_TRUE(free_ones > 5 && blocked > 5);
}
static void test_a_link_that_swings_through_the_first_one_is_found(void) {
    static const double from[3] = {0.0, 2.5, -2.0}, to[3] = {0.0, 2.5, 4.5}; // free at both ends and in the middle
    aisle_arm_piece piece;
    uint32_t units = 0;
    arm_msg.arm_base[0] = 2.0; // nothing else near
    arm_msg.joint_max[2] = 4.6F;
    (void)arm_hall_open(64U);
    aisle_arm_piece_of(3U, from, to, NULL, &piece);
    TEST_ASSERT_FALSE(aisle_arm_free_line(&world, from, to, &units));
    TEST_ASSERT_FALSE(aisle_arm_free_piece(&world, &piece, &units, NULL));
}
static void test_the_last_link_is_kept_off_the_first_one(void) {
    int by_arm = 0;
    (void)arm_hall_open(64U);
    for (uint64_t seed = 0; seed < SEEDS; seed++) { // away from the body, folded up
        aisle_rng rng = aisle_rng_seed(seed);
        double from[3] = {uniform(&rng, -1.0, 1.0), uniform(&rng, 2.2, 2.7), uniform(&rng, 1.6, 2.8)};
        double to[3] = {uniform(&rng, -1.0, 1.0), uniform(&rng, 2.2, 2.7), uniform(&rng, 1.6, 2.8)};
        aisle_arm_piece piece;
        uint32_t units = 0;
        int32_t id;
        aisle_arm_piece_of(3U, from, to, NULL, &piece);
        const bool is_free = aisle_arm_free_line(&world, from, to, &units);
        TEST_ASSERT_EQUAL(is_free, aisle_arm_free_piece(&world, &piece, &units, NULL));
        TEST_ASSERT_TRUE(is_free == (least_gap(&piece, 1.0) >= AISLE_ARM_KEEP));
        by_arm += aisle_arm_world_gap(&world, from, 0.3, NULL, &id) <= 0.0 && id == AISLE_ARM_ID_ARM ? 1 : 0;
    }
    TEST_ASSERT_GREATER_THAN_INT(5, by_arm);
}
static void test_in_the_open_few_looks_do(void) {
    static const double from[3] = {-0.5, 0.0, 0.0}, to[3] = {0.5, 0.3, 0.3};
    uint32_t units = 0;
    (void)arm_hall_open(64U);
    TEST_ASSERT_TRUE(aisle_arm_free_line(&world, from, to, &units));
    TEST_ASSERT_LESS_OR_EQUAL_UINT32(20U * AISLE_ARM_UNITS, units);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_a_piece_called_free_keeps_its_distance_everywhere_and_others_touch);
    RUN_TEST(test_a_line_called_free_keeps_its_distance_everywhere_and_others_touch);
    RUN_TEST(test_posts_that_are_thin_are_not_jumped_over);
    RUN_TEST(test_a_link_that_swings_through_the_first_one_is_found);
    RUN_TEST(test_the_last_link_is_kept_off_the_first_one);
    RUN_TEST(test_in_the_open_few_looks_do);
    return UNITY_END();
}
