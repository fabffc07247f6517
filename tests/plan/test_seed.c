#include "plan/seed.h"

#include "hall.h"

enum { SEEDS = 12, FINE_MAX = 700 * 500 };

static aisle_space space;
static aisle_seed seed;
static aisle_objective objective;
static aisle_vec2 points[AISLE_SEED_POINTS_MAX];
static uint32_t spent;

// Walls every which way: about half of the pairs of places do not connect.
static void random_hall(aisle_rng *rng) {
    hall_begin(6.0, 4.5);
    for (int i = 0; i < 12; i++) {
        double x = uniform(rng, 0.0, 5.5);
        double y = uniform(rng, 0.0, 4.0);
        double length = uniform(rng, 0.4, 2.2);
        double thickness = uniform(rng, 0.02, 0.2);
        hall_add(x, y, x + (i % 2 == 0 ? length : thickness), y + (i % 2 == 0 ? thickness : length));
    }
}

static void open_with(float resolution, uint32_t open_nodes) {
    aisle_arena arena = hall_arena(24U << 20);
    aisle_limits limits = hall_limits;
    limits.open_nodes = open_nodes;
    memset(&space, 0, sizeof space);
    memset(&seed, 0, sizeof seed);
    aisle_space_carve(&space, &arena, limits.cells);
    aisle_seed_carve(&seed, &arena, &limits);
    hall_open(&arena, resolution);
    spent = 0;
}

static void open_hall(void) {
    open_with(0.05F, hall_limits.open_nodes);
}

static void wish(int8_t kind) {
    aisle_options_msg options = {.objective = kind};
    TEST_ASSERT_TRUE(aisle_objective_of(&options, &hall_vehicle, &objective));
}

void setUp(void) {
    hall_disc(0.25, 0.05F);
    wish(AISLE_OPTIONS_SHORTEST);
}
void tearDown(void) {}

static aisle_status run(aisle_space_mode mode, uint32_t stride, aisle_vec2 start, aisle_vec2 goal, uint32_t slice) {
    aisle_space_begin(&space, &hall_layout, &hall_vehicle, mode);
    spent = 0;
    aisle_status st = aisle_seed_start(&seed, &space, &objective, stride, start, goal, points);
    if (st == AISLE_OK) {
        do {
            uint32_t before = spent;
            st = aisle_seed_step(&seed, slice, &spent);
            TEST_ASSERT_TRUE(slice > UINT32_MAX - 4096U || spent - before <= slice + 4096U);
        } while (st == AISLE_BUSY);
    }
    return st;
}

// ---- judges

static double leg_gap(aisle_vec2 a, aisle_vec2 b, bool disc) {
    double theta = atan2(b.y - a.y, b.x - a.x);
    int steps = 1 + (int)(aisle_vec2_distance(a, b) / 0.005);
    double least = 1e9;
    for (int i = 0; i <= steps; i++) {
        aisle_vec2 p = aisle_vec2_lerp(a, b, (double)i / steps);
        double gap = disc ? (double)hall_disc_gap(p.x, p.y, hall_vehicle.outer_radius)
                          : hall_body_gap((aisle_pose2){p.x, p.y, theta});
        least = fmin(least, gap);
    }
    return least;
}

// Ends right, every leg free by the judge; the first and last for the body alone.
static void polyline_is_free(bool disc, aisle_vec2 start, aisle_vec2 goal) {
    uint32_t n = seed.point_count;
    TEST_ASSERT_TRUE(n >= 2 && n <= AISLE_SEED_POINTS_MAX);
    TEST_ASSERT_EQUAL_MEMORY(&start, &points[0], sizeof start);
    TEST_ASSERT_EQUAL_MEMORY(&goal, &points[n - 1U], sizeof goal);
    for (uint32_t i = 0; i + 1U < n; i++) {
        bool inner = i > 0 && i + 2U < n;
        TEST_ASSERT_TRUE(leg_gap(points[i], points[i + 1U], disc && inner) >= hall_vehicle.margin + 4e-4);
    }
}

static double polyline_length(void) {
    double length = 0.0;
    for (uint32_t i = 0; i + 1U < seed.point_count; i++) {
        length += aisle_vec2_distance(points[i], points[i + 1U]);
    }
    return length;
}

// Flood on a lattice of its own, h m wide, over exact gaps of a point; gaps are measured once a hall.
static double fine_gap[FINE_MAX];
static bool fine_in[FINE_MAX];
static int fine_w, fine_h;
static double fine_step;

static void measure_fine(double h) {
    fine_step = h;
    fine_w = (int)(hall_width / h);
    fine_h = (int)(hall_height / h);
    TEST_ASSERT_TRUE(fine_w * fine_h <= FINE_MAX);
    for (int i = 0; i < fine_w * fine_h; i++) {
        double x = (i % fine_w + 0.5) * h;
        double y = (i / fine_w + 0.5) * h;
        double gap = fmin(fmin(x, y), fmin(hall_width - x, hall_height - y));
        for (int k = 0; k < hall_count; k++) {
            const hall_box *b = &hall_boxes[k];
            double dx = fmax(fmax(b->x0 - x, x - b->x1), 0.0);
            double dy = fmax(fmax(b->y0 - y, y - b->y1), 0.0);
            gap = fmin(gap, sqrt(dx * dx + dy * dy));
        }
        fine_gap[i] = gap;
    }
}

static int fine_cell(aisle_vec2 p) {
    return (int)(p.y / fine_step) * fine_w + (int)(p.x / fine_step);
}

static bool fine_connects(aisle_vec2 a, aisle_vec2 b, double need) {
    static int stack[FINE_MAX];
    int n = 0;
    memset(fine_in, 0, sizeof fine_in);
    stack[n++] = fine_cell(a);
    fine_in[stack[0]] = true;
    while (n > 0) {
        int at = stack[--n];
        for (int k = 0; k < 9; k++) {
            int x = at % fine_w + k % 3 - 1;
            int y = at / fine_w + k / 3 - 1;
            if (x < 0 || y < 0 || x >= fine_w || y >= fine_h) {
                continue;
            }
            int to = y * fine_w + x;
            if (!fine_in[to] && fine_gap[to] >= need) {
                fine_in[to] = true;
                stack[n++] = to;
            }
        }
    }
    return fine_in[fine_cell(b)];
}

static aisle_vec2 random_free(aisle_rng *rng, double need) {
    aisle_vec2 p;
    do {
        p = uniform_point(rng, aisle_vec2_of(0.3, 0.3), aisle_vec2_of(5.7, 4.2));
    } while ((double)hall_disc_gap(p.x, p.y, 0.0) < need);
    return p;
}

// ---- tests

static void test_a_disc_finds_a_way_just_where_an_independent_flood_does_and_it_is_free(void) {
    int ways = 0;
    int none = 0;
    double res = 0.05;
    for (uint64_t s = 0; s < SEEDS; s++) {
        aisle_rng rng = aisle_rng_seed(s);
        random_hall(&rng);
        open_hall();
        measure_fine(0.02);
        for (int k = 0; k < 4; k++) {
            double reach = hall_vehicle.outer_radius + hall_vehicle.margin + AISLE_SPACE_SLACK;
            aisle_vec2 start = random_free(&rng, reach + 0.1);
            aisle_vec2 goal = random_free(&rng, reach + 0.1);
            wish((int8_t)k);
            aisle_status st = run(AISLE_SPACE_FREE_TURN, 1, start, goal, 1000);
            bool sure = fine_connects(start, goal, reach + 1.5 * res);
            bool possible = fine_connects(start, goal, reach - 0.015);
            TEST_ASSERT_TRUE(st == AISLE_OK || st == AISLE_PARTIAL);
            TEST_ASSERT_FALSE(sure && st != AISLE_OK);
            TEST_ASSERT_FALSE(!possible && st == AISLE_OK);
            TEST_ASSERT_TRUE(spent >= seed.search.expanded);
            if (st == AISLE_OK) {
                polyline_is_free(true, start, goal);
                ways += 1;
            } else {
                none += 1;
            }
        }
    }
    TEST_ASSERT_TRUE(ways > SEEDS && none > 5);
}

static void test_a_body_finds_free_ways_along_its_motion_where_the_disc_finds_none(void) {
    int ways = 0;
    hall_rectangle(0.7, 0.3, 0.05F);
    for (uint64_t s = 0; s < SEEDS; s++) {
        aisle_rng rng = aisle_rng_seed(s);
        random_hall(&rng);
        open_hall();
        for (int k = 0; k < 3; k++) {
            aisle_vec2 start = random_free(&rng, 0.4);
            aisle_vec2 goal = random_free(&rng, 0.4);
            aisle_status turning = run(AISLE_SPACE_FREE_TURN, 1, start, goal, 1000);
            aisle_status along = run(AISLE_SPACE_ALONG, 1, start, goal, 1000);
            if (along == AISLE_OK) {
                polyline_is_free(false, start, goal);
                ways += turning != AISLE_OK;
            }
        }
    }
    TEST_ASSERT_GREATER_THAN_INT(2, ways);
}

static void test_a_tight_station_is_joined_by_the_body_alone(void) {
    hall_rectangle(1.0, 0.4, 0.05F);
    hall_begin(6.0, 4.0);
    hall_add(0.0, 0.0, 1.5, 1.7); // a bay of 0.6 m: room for the body, none for its turning disc
    hall_add(0.0, 2.3, 1.5, 4.0);
    open_hall();
    aisle_vec2 start = {0.7, 2.0};
    aisle_vec2 goal = {4.0, 1.0};
    TEST_ASSERT_EQUAL(AISLE_OK, run(AISLE_SPACE_FREE_TURN, 1, start, goal, 1000));
    polyline_is_free(true, start, goal);
    TEST_ASSERT_EQUAL(AISLE_OK, run(AISLE_SPACE_FREE_TURN, 2, goal, start, 1000));
    polyline_is_free(true, goal, start);
}

static void test_ends_that_nothing_joins_are_told_before_any_search(void) {
    hall_begin(6.0, 4.0);
    hall_add(1.0, 1.0, 2.0, 1.1); // a cell of 1 m with walls: room for the disc in the middle at most
    hall_add(1.0, 1.9, 2.0, 2.0);
    hall_add(1.0, 1.0, 1.1, 2.0);
    hall_add(1.9, 1.0, 2.0, 2.0);
    hall_disc(0.38, 0.05F);
    open_hall();
    aisle_vec2 inside = {1.5, 1.5};
    aisle_vec2 outside = {4.0, 2.0};
    TEST_ASSERT_EQUAL(AISLE_PARTIAL, run(AISLE_SPACE_FREE_TURN, 1, inside, outside, 1000));
    TEST_ASSERT_EQUAL(AISLE_PARTIAL, run(AISLE_SPACE_FREE_TURN, 1, outside, inside, 1000));
    TEST_ASSERT_EQUAL(AISLE_SEED_IDLE, seed.phase);
}

static void test_the_polyline_is_no_longer_than_the_cells_way(void) {
    for (uint64_t s = 0; s < SEEDS; s++) {
        aisle_rng rng = aisle_rng_seed(s);
        random_hall(&rng);
        open_hall();
        aisle_vec2 start = random_free(&rng, 0.4);
        aisle_vec2 goal = random_free(&rng, 0.4);
        for (uint32_t stride = 1; stride <= 3; stride++) {
            if (run(AISLE_SPACE_FREE_TURN, stride, start, goal, 1000) == AISLE_OK) {
                double cells = (double)aisle_astar_cost(&seed.search) / 70.0 * 0.05 * stride;
                TEST_ASSERT_TRUE(polyline_length() <= cells + 0.15 * stride);
                TEST_ASSERT_TRUE(seed.point_count < 30);
            }
        }
    }
}

static void test_safest_goes_round_by_the_wide_door_and_shortest_through_the_narrow_one(void) {
    hall_begin(8.0, 8.0);
    hall_add(3.8, 0.0, 4.2, 3.5); // 0.7 m of door at y = 3.85, 2.8 m of it at y = 6.6
    hall_add(3.8, 4.2, 4.2, 5.2);
    open_hall();
    aisle_vec2 start = {1.0, 3.85};
    aisle_vec2 goal = {7.0, 3.85};
    TEST_ASSERT_EQUAL(AISLE_OK, run(AISLE_SPACE_FREE_TURN, 1, start, goal, 1000));
    TEST_ASSERT_DOUBLE_WITHIN(1e-2, 6.0, polyline_length());
    wish(AISLE_OPTIONS_SAFEST);
    TEST_ASSERT_EQUAL(AISLE_OK, run(AISLE_SPACE_FREE_TURN, 1, start, goal, 1000));
    double top = 0.0;
    for (uint32_t i = 0; i < seed.point_count; i++) {
        top = fmax(top, points[i].y);
    }
    TEST_ASSERT_TRUE(top > 5.4);
    polyline_is_free(true, start, goal);
}

static void test_a_passage_wider_by_what_the_header_says_is_never_lost_to_the_stride(void) {
    double reach = hall_vehicle.outer_radius + hall_vehicle.margin + AISLE_SPACE_SLACK;
    for (uint32_t stride = 1; stride <= 3; stride++) {
        for (int k = 0; k < 12; k++) {
            double width = 2.0 * reach + 1.25 * 0.05 * stride;
            double low = 1.0 + 0.0137 * k;
            hall_begin(6.0, 4.0);
            hall_add(2.8, 0.0, 3.3, low);
            hall_add(2.8, low + width, 3.3, 4.0);
            open_hall();
            aisle_vec2 start = {1.0, 2.0};
            aisle_vec2 goal = {5.0, 2.0};
            TEST_ASSERT_EQUAL(AISLE_OK, run(AISLE_SPACE_FREE_TURN, stride, start, goal, 1000));
        }
    }
}

static void test_any_slicing_gives_the_same_polyline_for_the_same_units(void) {
    static aisle_vec2 whole[AISLE_SEED_POINTS_MAX];
    static const uint32_t slices[] = {1, 7, 1000};
    aisle_rng rng = aisle_rng_seed(3);
    random_hall(&rng);
    hall_rectangle(0.5, 0.3, 0.05F);
    wish(AISLE_OPTIONS_SAFEST);
    open_hall();
    aisle_vec2 start = random_free(&rng, 0.4);
    aisle_vec2 goal = random_free(&rng, 0.4);
    for (int mode = 0; mode < 2; mode++) {
        aisle_status st = run((aisle_space_mode)mode, 1, start, goal, UINT32_MAX);
        uint32_t count = seed.point_count;
        uint32_t units = spent;
        memcpy(whole, points, count * sizeof whole[0]);
        TEST_ASSERT_EQUAL(AISLE_OK, st);
        for (int i = 0; i < 3; i++) {
            TEST_ASSERT_EQUAL(st, run((aisle_space_mode)mode, 1, start, goal, slices[i]));
            TEST_ASSERT_EQUAL_UINT32(units, spent);
            TEST_ASSERT_EQUAL_UINT32(count, seed.point_count);
            TEST_ASSERT_EQUAL_MEMORY(whole, points, count * sizeof whole[0]);
        }
    }
}

static void test_a_full_open_list_is_told(void) {
    hall_begin(12.0, 12.0);
    hall_add(6.0, 1.0, 6.2, 12.0);
    open_with(0.05F, 16);
    TEST_ASSERT_EQUAL(AISLE_ERR_CAPACITY,
                      run(AISLE_SPACE_FREE_TURN, 1, aisle_vec2_of(2.0, 10.0), aisle_vec2_of(10.0, 10.0), 1000));
}

// ---- PROOF and WIDTH

static bool refusal_search(void) {
    aisle_status st;
    do {
        uint32_t before = spent;
        st = aisle_seed_step_refusal(&seed, 100, &spent);
        TEST_ASSERT_TRUE(spent - before <= 100U + 4096U);
    } while (st == AISLE_BUSY);
    TEST_ASSERT_TRUE(st == AISLE_OK || st == AISLE_PARTIAL);
    return st == AISLE_OK;
}

static bool proof_connects(aisle_vec2 a, aisle_vec2 b, double reach, uint32_t depth) {
    aisle_space_begin(&space, &hall_layout, &hall_vehicle, AISLE_SPACE_FREE_TURN);
    aisle_seed_start_proof(&seed, &space, a, b, reach, depth);
    return refusal_search();
}

static void test_the_proof_never_says_no_way_where_a_fine_flood_of_exact_gaps_finds_one(void) {
    int ways = 0;
    int proofs = 0;
    for (uint64_t s = 0; s < SEEDS; s++) {
        aisle_rng rng = aisle_rng_seed(s + 100);
        random_hall(&rng);
        double low = uniform(&rng, 0.5, 3.0);
        hall_add(2.9, 0.0, 3.1, low); // a wall with a door of 0.1 to 0.7 m besides
        hall_add(2.9, low + 0.1 + 0.05 * (double)s, 3.1, 4.5);
        open_with(0.1F, hall_limits.open_nodes);
        measure_fine(0.01);
        for (int k = 0; k < 6; k++) {
            double reach = 0.03 + 0.07 * k;
            aisle_vec2 a = random_free(&rng, reach + 0.01);
            aisle_vec2 b = random_free(&rng, reach + 0.01);
            bool way = fine_connects(a, b, reach);
            bool rough = proof_connects(a, b, reach, 0);
            bool told = proof_connects(a, b, reach, AISLE_SPACE_DEPTH_MAX);
            TEST_ASSERT_FALSE(way && !told);
            TEST_ASSERT_FALSE(told && !rough);
            ways += way;
            proofs += !told;
        }
    }
    TEST_ASSERT_TRUE(ways > SEEDS && proofs > SEEDS);
}

static void test_the_proof_tells_a_door_from_one_a_seventh_of_a_cell_narrower(void) {
    for (int k = 0; k < 8; k++) {
        double width = 0.4 + 0.0337 * k;
        double low = 1.7 + 0.021 * k;
        hall_begin(6.0, 4.0);
        hall_add(2.9, 0.0, 3.1, low);
        hall_add(2.9, low + width, 3.1, 4.0);
        open_hall();
        aisle_vec2 a = {1.0, 2.0};
        aisle_vec2 b = {5.0, 2.0};
        TEST_ASSERT_TRUE(proof_connects(a, b, width / 2.0 - 1e-4, AISLE_SPACE_DEPTH_MAX));
        TEST_ASSERT_FALSE(proof_connects(a, b, width / 2.0 + 0.05 / 7.0, AISLE_SPACE_DEPTH_MAX));
        TEST_ASSERT_FALSE(proof_connects(a, b, width / 2.0 + 0.05, 0));
    }
}

static void test_width_connects_just_where_cells_of_that_field_value_do(void) {
    int connected = 0;
    for (uint64_t s = 0; s < SEEDS; s++) {
        aisle_rng rng = aisle_rng_seed(s);
        random_hall(&rng);
        open_hall();
        measure_fine(0.05);
        const aisle_grid *grid = aisle_layout_grid(&hall_layout);
        TEST_ASSERT_EQUAL_INT(fine_w, (int)grid->lattice.w);
        for (int i = 0; i < fine_w * fine_h; i++) {
            fine_gap[i] = (double)grid->field[i];
        }
        aisle_vec2 a = random_free(&rng, 0.3);
        aisle_vec2 b = random_free(&rng, 0.3);
        for (uint32_t from = 1; from < 60; from += 7) {
            aisle_space_begin(&space, &hall_layout, &hall_vehicle, AISLE_SPACE_FREE_TURN);
            aisle_seed_start_width(&seed, &space, a, b, 1, from);
            bool told = refusal_search();
            TEST_ASSERT_EQUAL(fine_connects(a, b, (double)from), told);
            connected += told;
        }
    }
    TEST_ASSERT_GREATER_THAN_INT(SEEDS, connected);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_a_disc_finds_a_way_just_where_an_independent_flood_does_and_it_is_free);
    RUN_TEST(test_a_body_finds_free_ways_along_its_motion_where_the_disc_finds_none);
    RUN_TEST(test_a_tight_station_is_joined_by_the_body_alone);
    RUN_TEST(test_ends_that_nothing_joins_are_told_before_any_search);
    RUN_TEST(test_the_polyline_is_no_longer_than_the_cells_way);
    RUN_TEST(test_safest_goes_round_by_the_wide_door_and_shortest_through_the_narrow_one);
    RUN_TEST(test_a_passage_wider_by_what_the_header_says_is_never_lost_to_the_stride);
    RUN_TEST(test_any_slicing_gives_the_same_polyline_for_the_same_units);
    RUN_TEST(test_a_full_open_list_is_told);
    RUN_TEST(test_the_proof_never_says_no_way_where_a_fine_flood_of_exact_gaps_finds_one);
    RUN_TEST(test_the_proof_tells_a_door_from_one_a_seventh_of_a_cell_narrower);
    RUN_TEST(test_width_connects_just_where_cells_of_that_field_value_do);
    return UNITY_END();
}
