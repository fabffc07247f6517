#include "plan/arm_join.h" // first: proves that the header stands alone

#include "arm_hall.h"

enum { SEEDS = 60, FINE = 4000 };

static const double never = (double)INFINITY;

static aisle_arm_join join;
static aisle_arm_search search;
static aisle_arm_plan plan, straight;
static aisle_arm_dynamics dynamics;

void setUp(void) {
    arm_hall_begin();
}
void tearDown(void) {}

static void open_hall(int8_t objective) {
    static const double nowhere[3] = {0.0, 0.0, 0.0};
    const aisle_options_msg options = {.objective = objective};
    aisle_arena arena = arm_hall_open(64U);
    aisle_arm_search_carve(&search, &arena);
    aisle_arm_join_carve(&join, &arena);
    TEST_ASSERT_FALSE(arena.overflow);
    aisle_arm_dynamics_begin(&dynamics, &arm, world.base.theta);
    aisle_arm_search_start(&search, &world, nowhere, nowhere, &options);
}

// A path of so many straight pieces, each free; what is drawn and is not is drawn again.
static void draw_path(aisle_rng *rng, uint32_t count) {
    double from[3] = {0.0, 0.0, 0.0}, to[3];
    uint32_t joint, units = 0;
    straight.count = 0;
    while (straight.count < count) {
        for (uint32_t j = 0; j < 3U; j++) {
            to[j] = aisle_clamp(from[j] + uniform(rng, -0.7, 0.7), 0.9 * arm.min[j], 0.9 * arm.max[j]);
        }
        if (aisle_arm_free_line(&world, from, to, &units)) {
            aisle_arm_piece_of(3U, from, to, NULL, &straight.piece[straight.count++]);
            memcpy(from, to, sizeof from);
        }
    }
    TEST_ASSERT_TRUE(aisle_arm_plan_time(&straight, &arm, &dynamics, &joint));
    plan = straight;
}

static void run(uint32_t units, uint32_t *spent) {
    aisle_arm_join_start(&join, &world, &dynamics, &search, &plan, spent);
    while (aisle_arm_join_step(&join, units, spent) == AISLE_BUSY) {
    }
}

static double sum_of(const aisle_arm_plan *of) {
    double sum = 0.0;
    for (uint32_t k = 0; k < of->count; k++) {
        sum += of->duration[k];
    }
    return sum;
}

static double travel_of(const aisle_arm_plan *of) {
    double sum = 0.0, before[3], q[3];
    for (uint32_t k = 0; k < of->count; k++) {
        aisle_arm_piece_at(&of->piece[k], 0.0, 0, before);
        for (int i = 1; i <= FINE; i++) {
            aisle_arm_piece_at(&of->piece[k], (double)i / FINE, 0, q);
            sum += fabs(q[0] - before[0]) + fabs(q[1] - before[1]) + fabs(q[2] - before[2]);
            memcpy(before, q, sizeof q);
        }
    }
    return sum;
}

static double nearest_to(const double *point) { // of the plan, rad
    double least = never, q[3];
    for (uint32_t k = 0; k < plan.count; k++) {
        for (int i = 0; i <= FINE; i++) {
            aisle_arm_piece_at(&plan.piece[k], (double)i / FINE, 0, q);
            least = fmin(least, hypot(hypot(q[0] - point[0], q[1] - point[1]), q[2] - point[2]));
        }
    }
    return least;
}

static void test_what_is_joined_runs_through_every_via_point_and_is_free_and_faster(void) {
    int joined = 0, kept = 0;
    hall_add(6.1, 5.1, 6.3, 5.3);
    hall_add(6.0, 4.5, 6.2, 4.6);
    open_hall(AISLE_OPTIONS_SHORTEST);
    for (uint64_t seed = 0; seed < SEEDS; seed++) {
        aisle_rng rng = aisle_rng_seed(seed);
        uint32_t spent = 0;
        double q[3];
        draw_path(&rng, 3U + (uint32_t)(seed % 3U));
        run(1000, &spent);
        joined += (int)(straight.count - plan.count);
        kept += (int)plan.count - 1;
        TEST_ASSERT_TRUE(plan.count == straight.count || sum_of(&plan) < sum_of(&straight));
        TEST_ASSERT_TRUE(travel_of(&plan) <= (1.0 + AISLE_ARM_JOIN_SLACK + 2e-3) * travel_of(&straight));
        for (uint32_t k = 0; k < straight.count; k++) {
            aisle_arm_piece_at(&straight.piece[k], 1.0, 0, q);
            TEST_ASSERT_TRUE(nearest_to(q) < 2e-3); // as fine as the walk is
        }
        for (uint32_t k = 0; k < plan.count; k++) {
            aisle_arm_timing timing;
            aisle_arm_least_duration(&arm, &dynamics, &plan.piece[k], AISLE_ARM_TIMING_PANELS, &timing);
            TEST_ASSERT_DOUBLE_WITHIN(1e-9, timing.duration, plan.duration[k]);
            for (int i = 0; i <= 100; i++) {
                aisle_arm_piece_at(&plan.piece[k], i / 100.0, 0, q);
                TEST_ASSERT_TRUE(arm_judged(q) > 0.0);
                TEST_ASSERT_EQUAL_UINT32(0, aisle_arm_joint_out(&arm, q, 1e-6));
            }
        }
    }
    TEST_ASSERT_TRUE(joined > SEEDS / 4 && kept > SEEDS / 4);
}

// ---- every cover there is

static double step_at(double r) { // 10 r^3 - 15 r^4 + 6 r^5
    return 10.0 * pow(r, 3.0) - 15.0 * pow(r, 4.0) + 6.0 * pow(r, 5.0);
}

static double place_with(double share) { // by Newton's steps from the middle
    double r = 0.5;
    for (int i = 0; i < 200; i++) {
        r = fmin(0.999, fmax(0.001, r - (step_at(r) - share) / fmax(30.0 * r * r * (1.0 - r) * (1.0 - r), 0.05)));
    }
    return r;
}

// Least duration of one bent piece over straight ones first to first + span - 1; INFINITY: none may be used.
static double bent(uint32_t first, uint32_t span) {
    double point[4][3], way[4] = {0.0}, r[2], bend[6], value = 0.0;
    aisle_arm_piece piece;
    aisle_arm_timing timing;
    for (uint32_t k = 0; k <= span; k++) {
        aisle_arm_piece_at(&straight.piece[k < span ? first + k : first + k - 1U], k < span ? 0.0 : 1.0, 0, point[k]);
        way[k] = k > 0U ? way[k - 1U] + hypot(hypot(point[k][0] - point[k - 1U][0], point[k][1] - point[k - 1U][1]),
                                              point[k][2] - point[k - 1U][2])
                        : 0.0;
        value += k < span ? (double)aisle_arm_search_cost(&search, &straight.piece[first + k]).value : 0.0;
    }
    r[0] = place_with(way[1] / way[span]);
    r[1] = span == 3U ? place_with(way[2] / way[span]) : 1.0;
    if (r[0] < 0.05 || r[1] - r[0] < 0.05 || (span == 3U && r[1] > 0.95) || r[0] > 0.95) {
        return never;
    }
    for (int j = 0; j < 3; j++) { // two equations b0 + b1 (r - 1/2) = ..., by Cramer's rule
        double f[2] = {0.0, 0.0};
        for (uint32_t k = 0; k + 1U < span; k++) {
            f[k] = (point[k + 1U][j] - point[0][j] - (point[span][j] - point[0][j]) * step_at(r[k])) /
                   pow(r[k] * (1.0 - r[k]), 3.0);
        }
        bend[2 * j] = span == 2U ? f[0] : (f[0] * (r[1] - 0.5) - f[1] * (r[0] - 0.5)) / (r[1] - r[0]);
        bend[2 * j + 1] = span == 2U ? 0.0 : (f[1] - f[0]) / (r[1] - r[0]);
    }
    aisle_arm_piece_of(3U, point[0], point[span], bend, &piece);
    const aisle_cost_pair cost = aisle_arm_search_cost(&search, &piece);
    aisle_arm_least_duration(&arm, &dynamics, &piece, AISLE_ARM_TIMING_PANELS, &timing);
    return cost.violation > 0.0F || (double)cost.value > (1.0 + AISLE_ARM_JOIN_SLACK) * value ? never : timing.duration;
}

static void test_of_all_covers_the_fastest_is_taken(void) {
    int better = 0;
    hall_add(6.1, 5.1, 6.3, 5.3);
    open_hall(AISLE_OPTIONS_SAFEST);
    for (uint64_t seed = 0; seed < SEEDS; seed++) {
        enum { COUNT = 5 };
        aisle_rng rng = aisle_rng_seed(seed);
        uint32_t spent = 0;
        double piece[COUNT][4], least = never;
        draw_path(&rng, COUNT);
        for (uint32_t first = 0; first < COUNT; first++) {
            for (uint32_t span = 1; span <= 3U && first + span <= COUNT; span++) {
                piece[first][span] = span == 1U ? straight.duration[first] : bent(first, span);
            }
        }
        for (int code = 0; code < 243; code++) { // five spans of 1 to 3, as far as they are needed
            double sum = 0.0;
            uint32_t at = 0;
            for (int rest = code, i = 0; i < COUNT && at < COUNT; i++, rest /= 3) {
                const uint32_t span = (uint32_t)(rest % 3) + 1U;
                sum += at + span <= COUNT ? piece[at][span] : never;
                at += span;
            }
            least = fmin(least, at == COUNT ? sum : never);
        }
        run(1000, &spent);
        TEST_ASSERT_DOUBLE_WITHIN(1e-6, least, sum_of(&plan));
        better += least < 0.99 * sum_of(&straight) ? 1 : 0;
    }
    TEST_ASSERT_GREATER_THAN_INT(SEEDS / 4, better);
}
static void test_a_message_that_would_be_too_long_is_left_as_it_was(void) {
    uint32_t spent = 0, joint;
    open_hall(AISLE_OPTIONS_SHORTEST);
    straight.count = AISLE_ARM_PIECES;
    for (uint32_t k = 0; k < straight.count; k++) { // one way in small steps: all could be joined
        const double from[3] = {-0.6 + 0.02 * k, 0.0, 0.0}, to[3] = {-0.6 + 0.02 * (k + 1.0), 0.0, 0.0};
        aisle_arm_piece_of(3U, from, to, NULL, &straight.piece[k]);
    }
    TEST_ASSERT_TRUE(aisle_arm_plan_time(&straight, &arm, &dynamics, &joint));
    plan = straight;
    run(1000, &spent);
    TEST_ASSERT_EQUAL_MEMORY(&straight, &plan, sizeof plan);
    straight.count = plan.count = 42U;
    run(1000, &spent);
    TEST_ASSERT_EQUAL_UINT32(14U, plan.count);
}
static void test_any_cut_of_the_work_joins_the_same(void) {
    uint32_t spent[2] = {0, 0};
    open_hall(AISLE_OPTIONS_SAFEST);
    for (uint64_t seed = 0; seed < 5; seed++) {
        static aisle_arm_plan first;
        aisle_rng rng = aisle_rng_seed(seed);
        draw_path(&rng, 6U);
        run(1, &spent[0]);
        first = plan;
        plan = straight;
        run(UINT32_MAX, &spent[1]);
        TEST_ASSERT_EQUAL_MEMORY(&first, &plan, sizeof plan);
        TEST_ASSERT_EQUAL_UINT32(spent[0], spent[1]);
    }
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_what_is_joined_runs_through_every_via_point_and_is_free_and_faster);
    RUN_TEST(test_of_all_covers_the_fastest_is_taken);
    RUN_TEST(test_a_message_that_would_be_too_long_is_left_as_it_was);
    RUN_TEST(test_any_cut_of_the_work_joins_the_same);
    return UNITY_END();
}
