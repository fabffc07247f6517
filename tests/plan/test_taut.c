#include "plan/taut.h"

#include "hall.h"

#include "plan/cost.h"
#include "plan/seed.h"

enum { SEEDS = 16, CAPACITY = AISLE_SEED_POINTS_MAX };

static aisle_space space;
static aisle_seed seed;
static aisle_taut taut;
static aisle_objective objective;
static aisle_vec2 points[CAPACITY];
static uint32_t spent;

static void random_hall(aisle_rng *rng) {
    hall_begin(12.0, 9.0);
    for (int i = 0; i < 12; i++) {
        double x = uniform(rng, 0.5, 10.0);
        double y = uniform(rng, 0.5, 7.5);
        aisle_vec2 size = uniform_point(rng, aisle_vec2_of(0.2, 0.2), aisle_vec2_of(2.0, 1.5));
        hall_add(x, y, x + size.x, y + size.y);
    }
}

static void wish(int8_t kind) {
    aisle_options_msg options = {.objective = kind};
    TEST_ASSERT_TRUE(aisle_objective_of(&options, &hall_vehicle, &objective));
}

static void open_hall(aisle_space_mode mode) {
    aisle_arena arena = hall_arena(24U << 20);
    memset(&space, 0, sizeof space);
    memset(&seed, 0, sizeof seed);
    aisle_space_carve(&space, &arena, hall_limits.cells);
    aisle_seed_carve(&seed, &arena, &hall_limits);
    hall_open(&arena, 0.05F);
    aisle_space_begin(&space, &hall_layout, &hall_vehicle, mode);
}

void setUp(void) {
    hall_disc(0.3, 0.1F);
    wish(AISLE_OPTIONS_SHORTEST);
}
void tearDown(void) {}

static double arc_radius(void) {
    return hall_vehicle.outer_radius + hall_vehicle.margin;
}

static uint32_t pull(uint32_t count, uint32_t capacity, uint32_t slice) {
    aisle_taut_start(&taut, &space, &objective, arc_radius(), points, count, capacity);
    spent = 0;
    aisle_status st;
    do {
        st = aisle_taut_step(&taut, slice, &spent);
    } while (st == AISLE_BUSY);
    TEST_ASSERT_EQUAL(AISLE_OK, st);
    TEST_ASSERT_TRUE(taut.count >= 2 && taut.count <= capacity);
    return taut.count;
}

// Cost by the objective's density along the legs, less what arcs save, as the header says it.
static double cost_of(uint32_t n) {
    double sum = 0.0;
    uint32_t units = 0;
    for (uint32_t i = 0; i + 1U < n; i++) {
        sum += aisle_leg_cost(&space, &objective, points[i], points[i + 1U], &units);
    }
    for (uint32_t i = 1; i + 1U < n; i++) {
        aisle_vec2 u = aisle_vec2_sub(points[i], points[i - 1U]);
        aisle_vec2 v = aisle_vec2_sub(points[i + 1U], points[i]);
        double turn = fabs(atan2(aisle_vec2_cross(u, v), aisle_vec2_dot(u, v)));
        if (turn > 1e-6 && turn < 3.0) {
            double tangent =
                fmin(arc_radius() * tan(turn / 2.0), 0.5 * fmin(aisle_vec2_length(u), aisle_vec2_length(v)));
            sum -= 2.0 * tangent - tangent / tan(turn / 2.0) * turn;
        }
    }
    return sum;
}

static double disc_leg_gap(aisle_vec2 a, aisle_vec2 b) {
    int steps = 1 + (int)(aisle_vec2_distance(a, b) / 0.005);
    double least = 1e9;
    for (int i = 0; i <= steps; i++) {
        aisle_vec2 p = aisle_vec2_lerp(a, b, (double)i / steps);
        least = fmin(least, (double)hall_disc_gap(p.x, p.y, hall_vehicle.outer_radius));
    }
    return least;
}

// The same of the legs alone, clearances by the judge.
static double judged_cost(uint32_t n) {
    double sum = 0.0;
    for (uint32_t i = 0; i + 1U < n; i++) {
        double length = aisle_vec2_distance(points[i], points[i + 1U]);
        int steps = 1 + (int)(length / 0.05);
        for (int k = 0; k < steps; k++) {
            aisle_vec2 p = aisle_vec2_lerp(points[i], points[i + 1U], (k + 0.5) / steps);
            double clearance = (double)hall_disc_gap(p.x, p.y, hall_vehicle.inner_radius);
            sum += length / steps * aisle_objective_density(&objective, clearance, 0.0);
        }
    }
    return sum;
}

// A seed between two places; 0: there is none.
static uint32_t random_seed(aisle_rng *rng) {
    aisle_vec2 end[2];
    for (int i = 0; i < 2; i++) {
        do {
            end[i] = uniform_point(rng, aisle_vec2_of(0.5, 0.5), aisle_vec2_of(11.5, 8.5));
        } while ((double)hall_disc_gap(end[i].x, end[i].y, hall_vehicle.outer_radius) < 0.15);
    }
    if (aisle_seed_start(&seed, &space, &objective, 1, end[0], end[1], points) != AISLE_OK) {
        return 0;
    }
    aisle_status st;
    do {
        st = aisle_seed_step(&seed, 10000, &spent);
    } while (st == AISLE_BUSY);
    return st == AISLE_OK ? seed.point_count : 0;
}

static void test_every_objective_gets_no_costlier_and_no_less_free_for_every_seed(void) {
    int pulled = 0;
    int dearer = 0;
    for (uint64_t s = 0; s < SEEDS; s++) {
        aisle_rng rng = aisle_rng_seed(s);
        random_hall(&rng);
        open_hall(AISLE_SPACE_FREE_TURN);
        for (int8_t kind = 0; kind < 4; kind++) {
            wish(kind);
            uint32_t n = random_seed(&rng);
            if (n < 2) {
                continue;
            }
            aisle_vec2 first = points[0];
            aisle_vec2 last = points[n - 1U];
            double before = cost_of(n);
            double judged = judged_cost(n);
            uint32_t after = pull(n, CAPACITY, 1000);
            if (aisle_objective_is_length(&objective)) {
                TEST_ASSERT_TRUE(cost_of(after) <= before * (1.0 + 1e-9));
            } else { // pulled by the field, then by exact gaps every 0.4 m
                bool is_smooth = objective.kind == AISLE_OPTIONS_SAFEST; // others leap at the creep clearance
                TEST_ASSERT_TRUE(judged_cost(after) <= judged * (is_smooth ? 1.01 : 1.2));
                dearer += judged_cost(after) > judged * 1.001;
            }
            TEST_ASSERT_EQUAL_MEMORY(&first, &points[0], sizeof first);
            TEST_ASSERT_EQUAL_MEMORY(&last, &points[after - 1U], sizeof last);
            for (uint32_t i = 0; i + 1U < after; i++) {
                TEST_ASSERT_TRUE(disc_leg_gap(points[i], points[i + 1U]) >= hall_vehicle.margin + 4e-4);
            }
            pulled += cost_of(after) < before - 1e-3;
        }
    }
    TEST_ASSERT_GREATER_THAN_INT(SEEDS, pulled);
    TEST_ASSERT_TRUE(2 * dearer < 3 * SEEDS); // less than half of them all
}

// Length of the shortest way of a disc's centre from a to b round the corner c at distance r: tangents and an arc.
static double round_corner(aisle_vec2 a, aisle_vec2 b, aisle_vec2 c, double r) {
    double da = aisle_vec2_distance(a, c);
    double db = aisle_vec2_distance(b, c);
    aisle_vec2 u = aisle_vec2_sub(a, c);
    aisle_vec2 v = aisle_vec2_sub(b, c);
    double between = atan2(u.y, u.x) - atan2(v.y, v.x); // counter-clockwise from b to a, outside the box
    between += between < 0.0 ? 2.0 * acos(-1.0) : 0.0;
    double arc = between - acos(r / da) - acos(r / db);
    TEST_ASSERT_TRUE(arc > 0.0);
    return sqrt(da * da - r * r) + sqrt(db * db - r * r) + arc * r;
}

// Length of the polyline with every corner replaced by its arc of radius r.
static double rounded_length(uint32_t n) {
    wish(AISLE_OPTIONS_SHORTEST);
    return cost_of(n);
}

static void test_round_one_corner_the_length_is_that_of_tangents_and_arc_within_a_thousandth(void) {
    hall_begin(10.0, 10.0);
    hall_add(3.0, 0.0, 5.0, 5.0);
    open_hall(AISLE_SPACE_FREE_TURN);
    double r = arc_radius() + AISLE_SPACE_SLACK;
    aisle_vec2 corner = {3.0, 5.0};
    for (int k = 0; k < 20; k++) {
        points[0] = aisle_vec2_of(1.0 + 0.05 * k, 1.0 + 0.1 * k);
        points[1] = aisle_vec2_of(1.5, 6.5 + 0.1 * k);
        points[2] = aisle_vec2_of(4.0 - 0.02 * k, 7.0 - 0.03 * k);
        points[3] = aisle_vec2_of(4.2 + 0.02 * k, 5.45 + 0.1 * k);
        double truth = round_corner(points[0], points[3], corner, r);
        uint32_t n = pull(4, CAPACITY, 1000);
        double told = rounded_length(n);
        TEST_ASSERT_TRUE(told >= truth - 1e-4);
        TEST_ASSERT_DOUBLE_WITHIN(1e-3 * truth, truth, told);
        TEST_ASSERT_TRUE(n <= 8);
    }
}

static void test_points_in_the_open_are_removed(void) {
    hall_begin(10.0, 10.0);
    open_hall(AISLE_SPACE_FREE_TURN);
    for (int8_t kind = 0; kind < 4; kind++) {
        wish(kind);
        for (uint32_t i = 0; i < 40; i++) {
            points[i] = aisle_vec2_of(1.0 + 0.2 * i, 5.0 + 2.0 * sin(1.7 * i));
        }
        TEST_ASSERT_EQUAL_UINT32(2, pull(40, CAPACITY, 1000));
    }
}

static void test_two_points_stay_as_they_are(void) {
    hall_begin(10.0, 10.0);
    open_hall(AISLE_SPACE_FREE_TURN);
    points[0] = aisle_vec2_of(1.0, 1.0);
    points[1] = aisle_vec2_of(9.0, 4.0);
    TEST_ASSERT_EQUAL_UINT32(2, pull(2, 2, 1));
}

static void test_no_more_points_than_there_is_room_for(void) {
    hall_begin(10.0, 10.0);
    hall_add(3.0, 0.0, 5.0, 5.0);
    open_hall(AISLE_SPACE_FREE_TURN);
    aisle_vec2 canary = {-7.0, -7.0};
    points[0] = aisle_vec2_of(1.0, 1.0);
    points[1] = aisle_vec2_of(1.2, 8.0);
    points[2] = aisle_vec2_of(8.0, 8.0);
    points[3] = canary;
    uint32_t n = pull(3, 3, 1000);
    TEST_ASSERT_EQUAL_UINT32(3, n);
    TEST_ASSERT_EQUAL_MEMORY(&canary, &points[3], sizeof canary);
    TEST_ASSERT_TRUE(disc_leg_gap(points[0], points[1]) >= 0.1 && disc_leg_gap(points[1], points[2]) >= 0.1);
}

static void test_any_slicing_gives_the_same_points_for_the_same_units(void) {
    static aisle_vec2 begun[CAPACITY], whole[CAPACITY];
    static const uint32_t slices[] = {1, 17, 900};
    aisle_rng rng = aisle_rng_seed(5);
    random_hall(&rng);
    open_hall(AISLE_SPACE_FREE_TURN);
    for (int8_t kind = 0; kind < 2; kind++) {
        wish(kind);
        uint32_t n;
        do {
            n = random_seed(&rng);
        } while (n < 4);
        memcpy(begun, points, sizeof points);
        uint32_t count = pull(n, CAPACITY, UINT32_MAX);
        uint32_t units = spent;
        memcpy(whole, points, sizeof points);
        for (int i = 0; i < 3; i++) {
            memcpy(points, begun, sizeof points);
            TEST_ASSERT_EQUAL_UINT32(count, pull(n, CAPACITY, slices[i]));
            TEST_ASSERT_EQUAL_UINT32(units, spent);
            TEST_ASSERT_EQUAL_MEMORY(whole, points, count * sizeof points[0]);
        }
    }
}

static void test_the_body_itself_is_kept_free_along_its_motion(void) {
    hall_rectangle(1.2, 0.4, 0.05F);
    int pulled = 0;
    for (uint64_t s = 0; s < SEEDS; s++) {
        aisle_rng rng = aisle_rng_seed(s);
        random_hall(&rng);
        open_hall(AISLE_SPACE_ALONG);
        uint32_t n = random_seed(&rng);
        if (n < 3) {
            continue;
        }
        n = pull(n, CAPACITY, 1000);
        pulled += 1;
        for (uint32_t i = 0; i + 1U < n; i++) {
            double theta = atan2(points[i + 1U].y - points[i].y, points[i + 1U].x - points[i].x);
            int steps = 1 + (int)(aisle_vec2_distance(points[i], points[i + 1U]) / 0.01);
            for (int k = 0; k <= steps; k++) {
                aisle_vec2 p = aisle_vec2_lerp(points[i], points[i + 1U], (double)k / steps);
                TEST_ASSERT_TRUE(hall_body_gap((aisle_pose2){p.x, p.y, theta}) >= hall_vehicle.margin + 4e-4);
            }
        }
    }
    TEST_ASSERT_GREATER_THAN_INT(SEEDS / 4, pulled);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_every_objective_gets_no_costlier_and_no_less_free_for_every_seed);
    RUN_TEST(test_round_one_corner_the_length_is_that_of_tangents_and_arc_within_a_thousandth);
    RUN_TEST(test_points_in_the_open_are_removed);
    RUN_TEST(test_two_points_stay_as_they_are);
    RUN_TEST(test_no_more_points_than_there_is_room_for);
    RUN_TEST(test_any_slicing_gives_the_same_points_for_the_same_units);
    RUN_TEST(test_the_body_itself_is_kept_free_along_its_motion);
    return UNITY_END();
}
