#include "plan/local.h"

#include "cases.h"
#include "hall.h"
#include "optimum.h"

enum { SEEDS = CASES(40) };

static aisle_space space;
static aisle_local local;
static aisle_movers movers;
static aisle_mover mover[64];
static aisle_local_request request;
static uint32_t spent;

static void open_as(aisle_space_mode mode) {
    aisle_arena arena = hall_arena(HALL_BLOCK);
    memset(&space, 0, sizeof space);
    memset(&local, 0, sizeof local);
    aisle_space_carve(&space, &arena, hall_limits.cells);
    aisle_local_carve(&local, &arena, hall_limits.cells);
    hall_open(&arena, 0.05F);
    TEST_ASSERT_FALSE(arena.overflow);
    aisle_space_begin(&space, &hall_layout, &hall_vehicle, mode);
}

static void ask(double x0, double y0, double x1, double y1) {
    request = (aisle_local_request){
        .space = &space, .movers = &movers, .from = {x0, y0}, .goal = {x1, y1}, .speed = 1.0, .safety = 0.1};
}

void setUp(void) {
    hall_disc(0.3, 0.05F);
    hall_begin(20.0, 12.0);
    memset(&movers, 0, sizeof movers);
    movers.mover = mover;
}
void tearDown(void) {}

static void add_mover(double x, double y, double vx, double vy, double radius) {
    mover[movers.count++] = (aisle_mover){.id = (int32_t)movers.count + 100,
                                          .at = {x, y},
                                          .velocity = {vx, vy},
                                          .radius = radius,
                                          .sigma = 0.02,
                                          .v_bound = 2.0};
}

static aisle_status run(uint32_t slice) {
    aisle_status st;
    spent = 0;
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_local_start(&local, &request));
    while ((st = aisle_local_step(&local, slice, &spent)) == AISLE_BUSY) {
    }
    return st;
}

// ---- judge: the way sampled every 5 mm, movers where they are then, in long double

static bool mover_is_off(uint32_t k, aisle_vec2 p, long double t, long double need) {
    const aisle_mover *m = &mover[k];
    const long double speed = hypotl((long double)m->velocity.x, (long double)m->velocity.y);
    if (speed > 0.0L && t * speed > (long double)AISLE_LOCAL_DRIFT) {
        return true;
    }
    const long double x = (long double)m->at.x + (long double)m->velocity.x * t;
    const long double y = (long double)m->at.y + (long double)m->velocity.y * t;
    return hypotl((long double)p.x - x, (long double)p.y - y) >= need;
}

static double expect_free(void) {
    const double keep = hall_vehicle.margin + request.safety;
    double length = 0.0;
    TEST_ASSERT_TRUE(local.count >= 2U);
    TEST_ASSERT_TRUE(aisle_vec2_distance(local.points[0], request.from) <= 0.0);
    TEST_ASSERT_TRUE(aisle_vec2_distance(local.points[local.count - 1U], request.goal) <= 1e-6);
    for (uint32_t i = 1; i < local.count; i++) {
        const aisle_vec2 a = local.points[i - 1U], b = local.points[i];
        const double piece = aisle_vec2_distance(a, b);
        for (double s = 0.0; s <= piece; s += 0.005) {
            const aisle_vec2 p = piece > 0.0 ? aisle_vec2_lerp(a, b, s / piece) : a;
            TEST_ASSERT_TRUE(hall_disc_gap(p.x, p.y, 0.3) >= (long double)hall_vehicle.margin);
            for (uint32_t k = 0; k < movers.count; k++) {
                const double need = 0.3 + mover[k].radius + 3.0 * mover[k].sigma + keep - 1e-6;
                TEST_ASSERT_TRUE(mover_is_off(k, p, (long double)((length + s) / request.speed), (long double)need));
            }
        }
        length += piece;
    }
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, length, local.length);
    return length;
}

// Hits of seeds, each way judged; none longer than `longest`.
static uint32_t hits(double longest) {
    uint32_t n = 0;
    for (uint64_t s = 1; s <= SEEDS; s++) {
        request.seed = s;
        if (run(1000) == AISLE_OK) {
            TEST_ASSERT_TRUE(expect_free() <= longest);
            n++;
        }
    }
    return n;
}

// The exact shortest way of the disc with its margin, no movers.
static double optimum(void) {
    optimum_point corner[HALL_BOXES_MAX][4];
    optimum_polygon polygon[HALL_BOXES_MAX];
    const double r = 0.3 + hall_vehicle.margin, bounds[4] = {r, r, hall_width - r, hall_height - r};
    for (int i = 0; i < hall_count; i++) {
        const hall_box *b = &hall_boxes[i];
        const optimum_point at[4] = {{b->x0, b->y0}, {b->x1, b->y0}, {b->x1, b->y1}, {b->x0, b->y1}};
        memcpy(corner[i], at, sizeof at);
        polygon[i] = (optimum_polygon){corner[i], 4};
    }
    optimum_world *world = optimum_polygons(r, bounds, polygon, (size_t)hall_count);
    optimum_path path = optimum_shortest(world, (optimum_point){request.from.x, request.from.y},
                                         (optimum_point){request.goal.x, request.goal.y}, (double)INFINITY);
    const double length = path.length;
    optimum_path_free(&path);
    optimum_free(world);
    return length;
}

// ---- tests

static void test_an_open_hall_is_crossed_straight(void) {
    open_as(AISLE_SPACE_FREE_TURN);
    ask(2.0, 2.0, 18.0, 9.0);
    TEST_ASSERT_EQUAL_UINT32(SEEDS, hits(hypot(16.0, 7.0) * 1.0001));
    TEST_ASSERT_EQUAL(AISLE_LOCAL_GOAL, local.end);
}

static void u_pocket(void) {
    hall_add(5.0, 3.0, 12.0, 3.5);
    hall_add(5.0, 8.5, 12.0, 9.0);
    hall_add(11.5, 3.5, 12.0, 8.5);
}

static void spiral(void) {
    hall_add(4.0, 1.5, 16.0, 2.0);
    hall_add(15.5, 2.0, 16.0, 10.0);
    hall_add(6.0, 9.5, 15.5, 10.0);
    hall_add(6.0, 4.0, 6.5, 9.5);
    hall_add(6.5, 4.0, 13.5, 4.5);
    hall_add(13.0, 4.5, 13.5, 7.5);
}

static void dead_end(void) {
    hall_add(3.0, 0.0, 14.0, 4.8);
    hall_add(3.0, 6.2, 14.0, 10.5);
    hall_add(13.8, 4.8, 14.0, 6.2);
}

static void test_a_pocket_is_left_in_all_seeds_and_the_papers_own_cost_stays_in_it(void) {
    u_pocket();
    open_as(AISLE_SPACE_FREE_TURN);
    ask(10.0, 6.0, 17.0, 6.0);
    TEST_ASSERT_EQUAL_UINT32(SEEDS, hits(1.03 * optimum()));
    request.beeline = true;
    TEST_ASSERT_EQUAL_UINT32(0, hits(99.0));
    TEST_ASSERT_EQUAL(AISLE_LOCAL_STUCK, local.end);
}

static void test_a_spiral_is_left_in_all_seeds_and_the_papers_own_cost_stays_in_it(void) {
    spiral();
    open_as(AISLE_SPACE_FREE_TURN);
    ask(9.0, 7.0, 18.0, 6.0);
    TEST_ASSERT_EQUAL_UINT32(SEEDS, hits(1.03 * optimum()));
    request.beeline = true;
    TEST_ASSERT_EQUAL_UINT32(0, hits(99.0));
}

static void test_a_dead_end_aisle_is_left_in_all_seeds_and_the_papers_own_cost_stays_in_it(void) {
    dead_end();
    open_as(AISLE_SPACE_FREE_TURN);
    ask(10.0, 5.5, 18.0, 5.5);
    TEST_ASSERT_EQUAL_UINT32(SEEDS, hits(1.03 * optimum()));
    request.beeline = true;
    TEST_ASSERT_EQUAL_UINT32(0, hits(99.0));
}

static void aisles(void) {
    for (int i = 0; i < 3; i++) {
        hall_add(4.0, 2.0 + 3.0 * i, 16.0, 3.5 + 3.0 * i);
    }
}

static void test_an_aisle_a_mover_stands_in_is_left_for_another(void) {
    aisles();
    open_as(AISLE_SPACE_FREE_TURN);
    add_mover(14.0, 4.25, 0.0, 0.0, 0.3);
    ask(8.0, 4.25, 18.0, 4.25);
    TEST_ASSERT_EQUAL_UINT32(SEEDS, hits(22.5));
    TEST_ASSERT_TRUE(local.points[1].x < 8.0); // it turned back
}

static void test_one_that_comes_along_an_aisle_makes_it_turn_back(void) {
    aisles();
    open_as(AISLE_SPACE_FREE_TURN);
    add_mover(14.0, 4.25, -1.0, 0.0, 0.3);
    ask(4.5, 4.25, 18.0, 4.25);
    TEST_ASSERT_EQUAL_UINT32(SEEDS, hits(25.0));
    TEST_ASSERT_EQUAL_INT32(101, local.blocker);
}

static void test_the_old_way_is_rejoined_behind_what_stands_on_it(void) {
    const aisle_vec2 way[4] = {{2.0, 6.0}, {12.0, 6.0}, {15.0, 6.0}, {18.0, 8.0}};
    open_as(AISLE_SPACE_FREE_TURN);
    add_mover(6.0, 6.1, 0.0, 0.0, 0.4);
    ask(2.0, 6.0, 18.0, 8.0);
    request.way = way;
    request.way_count = 4;
    TEST_ASSERT_EQUAL_UINT32(SEEDS, hits(17.5));
    TEST_ASSERT_EQUAL(AISLE_LOCAL_REJOINED, local.end);
    const aisle_vec2 joint = local.points[local.fresh - 1U];
    TEST_ASSERT_TRUE(joint.x > 6.0 && joint.x <= 12.0);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 6.0, joint.y);
    TEST_ASSERT_EQUAL_UINT32(local.count, local.fresh + 4U - local.rejoin);
    TEST_ASSERT_EQUAL_MEMORY(way + local.rejoin, local.points + local.fresh, (4U - local.rejoin) * sizeof way[0]);
}

static void test_all_closed_is_told_with_who_closes_it(void) {
    hall_add(9.0, 0.0, 10.0, 5.0);
    hall_add(9.0, 6.5, 10.0, 12.0);
    open_as(AISLE_SPACE_FREE_TURN);
    add_mover(9.5, 5.7, 0.0, 0.0, 0.3);
    ask(2.0, 6.0, 18.0, 6.0);
    TEST_ASSERT_EQUAL(AISLE_PARTIAL, run(1000));
    TEST_ASSERT_EQUAL(AISLE_LOCAL_CLOSED, local.end);
    TEST_ASSERT_EQUAL_INT32(101, local.blocker);
    TEST_ASSERT_EQUAL_UINT32(0, local.count);
    movers.count = 0;
    TEST_ASSERT_EQUAL(AISLE_OK, run(1000));
}

static void test_drawn_halls_with_movers_have_no_line_that_meets_anything(void) {
    uint32_t found = 0, asked = 0;
    for (uint64_t s = 0; s < 60; s++) {
        aisle_rng rng = aisle_rng_seed(s);
        hall_begin(20.0, 12.0);
        movers.count = 0;
        for (int i = 0; i < 10; i++) {
            const aisle_vec2 p = uniform_point(&rng, aisle_vec2_of(3.0, 0.5), aisle_vec2_of(16.0, 10.0));
            hall_add(p.x, p.y, p.x + 1.2, p.y + 1.0);
        }
        open_as(AISLE_SPACE_FREE_TURN);
        for (int i = 0; i < 12; i++) {
            const aisle_vec2 p = uniform_point(&rng, aisle_vec2_of(3.0, 0.0), aisle_vec2_of(17.0, 12.0));
            const aisle_vec2 v = uniform_point(&rng, aisle_vec2_of(-1.0, -1.0), aisle_vec2_of(1.0, 1.0));
            add_mover(p.x, p.y, i % 3 == 0 ? 0.0 : v.x, i % 3 == 0 ? 0.0 : v.y, 0.3);
        }
        ask(1.0, 6.0, 19.0, 6.0);
        request.seed = s;
        const aisle_status st = run(1000);
        asked++;
        if (st == AISLE_OK) {
            (void)expect_free();
            found++;
        }
    }
    TEST_ASSERT_TRUE(found >= 55U && asked == 60U);
}

static void test_a_way_longer_than_asked_for_is_not_looked_for(void) {
    u_pocket();
    open_as(AISLE_SPACE_FREE_TURN);
    ask(10.0, 6.0, 17.0, 6.0);
    request.longest = 12.0;
    TEST_ASSERT_EQUAL(AISLE_PARTIAL, run(1000));
    TEST_ASSERT_EQUAL(AISLE_LOCAL_LONG, local.end);
    TEST_ASSERT_EQUAL_UINT32(0, local.count);
    request.longest = optimum();
    TEST_ASSERT_EQUAL(AISLE_OK, run(1000));
}

static void test_slices_change_nothing(void) {
    static aisle_vec2 whole[AISLE_LOCAL_POINTS_MAX];
    spiral();
    open_as(AISLE_SPACE_FREE_TURN);
    add_mover(8.0, 8.0, 0.2, -0.1, 0.3);
    ask(9.0, 7.0, 18.0, 6.0);
    TEST_ASSERT_EQUAL(AISLE_OK, run(UINT32_MAX));
    const uint32_t count = local.count, units = spent;
    memcpy(whole, local.points, count * sizeof whole[0]);
    TEST_ASSERT_EQUAL(AISLE_OK, run(1));
    TEST_ASSERT_EQUAL_UINT32(count, local.count);
    TEST_ASSERT_EQUAL_UINT32(units, spent);
    TEST_ASSERT_EQUAL_MEMORY(whole, local.points, count * sizeof whole[0]);
}

static void test_places_are_whole_numbers_in_the_papers_field(void) {
    u_pocket();
    open_as(AISLE_SPACE_FREE_TURN);
    ask(10.0, 6.0, 17.0, 6.0);
    request.lattice = 1.0;
    TEST_ASSERT_EQUAL_UINT32(SEEDS, hits(1.1 * optimum()));
    for (uint32_t i = 0; i < local.count; i++) {
        TEST_ASSERT_TRUE(local.points[i].x == floor(local.points[i].x)); // NOLINT: exactly
        TEST_ASSERT_TRUE(local.points[i].y == floor(local.points[i].y));
    }
}

static void test_one_that_is_too_near_already_may_be_left(void) {
    open_as(AISLE_SPACE_FREE_TURN);
    add_mover(2.7, 6.0, 0.0, 0.0, 0.3); // 0.1 m off
    ask(2.0, 6.0, 18.0, 6.0);
    TEST_ASSERT_EQUAL(AISLE_OK, run(1000));
    for (uint32_t i = 1; i < local.count; i++) {
        TEST_ASSERT_TRUE(hall_point_segment(mover[0].at, local.points[i - 1U], local.points[i]) >= 0.7 - 1e-6);
    }
}

static void test_a_long_body_goes_round_with_its_heading_along(void) {
    hall_rectangle(1.8, 0.6, 0.05F);
    open_as(AISLE_SPACE_ALONG);
    add_mover(8.0, 6.0, 0.0, 0.0, 0.3);
    ask(2.0, 6.0, 18.0, 6.0);
    TEST_ASSERT_EQUAL(AISLE_OK, run(1000));
    TEST_ASSERT_TRUE(local.length < 16.3);
    for (uint32_t i = 1; i < local.count; i++) { // the side of the body, not its end
        TEST_ASSERT_TRUE(hall_point_segment(mover[0].at, local.points[i - 1U], local.points[i]) >=
                         0.3 + 0.3 + 0.06 + 0.15 - 1e-6);
    }
}

// As in the paper's field: a point among blocks, its ways along their very faces.
static void test_a_point_passes_corners_for_all_seeds_with_little_work(void) {
    static const double at[8][4] = {
        {6.36, 6.48, 7.65, 8.46},  {11.87, 8.37, 14.49, 10.95}, {9.91, 2.66, 12.74, 4.53},   {3.18, 2.02, 4.80, 4.71},
        {9.03, 8.91, 10.69, 10.6}, {15.62, 4.45, 17.39, 6.74},  {16.89, 9.62, 17.95, 11.22}, {12.41, 6.0, 14.49, 7.12}};
    hall_disc(0.001, -1.0F);
    for (int i = 0; i < 8; i++) {
        hall_add(at[i][0], at[i][1], at[i][2], at[i][3]);
    }
    open_as(AISLE_SPACE_FREE_TURN);
    ask(1.0, 1.0, 19.0, 11.0);
    for (uint64_t seed = 1; seed <= SEEDS; seed++) {
        request.seed = seed;
        TEST_ASSERT_EQUAL(AISLE_OK, run(1000));
        TEST_ASSERT_TRUE(spent < 20000U && local.round == 0U);
    }
}

static void test_a_step_hangs_on_no_luck(void) {
    spiral();
    open_as(AISLE_SPACE_FREE_TURN);
    ask(9.0, 7.0, 18.0, 6.0);
    request.particles = 2;
    request.iterations = 1;
    TEST_ASSERT_EQUAL_UINT32(SEEDS, hits(1.1 * optimum()));
}

static void test_other_seeds_are_other_runs(void) {
    u_pocket();
    open_as(AISLE_SPACE_FREE_TURN);
    ask(10.0, 6.0, 17.0, 6.0);
    request.seed = 1;
    TEST_ASSERT_EQUAL(AISLE_OK, run(1000));
    const uint32_t first = spent;
    request.seed = 2;
    TEST_ASSERT_EQUAL(AISLE_OK, run(1000));
    TEST_ASSERT_TRUE(first != spent);
}

static void test_an_old_way_that_is_clearly_longer_is_not_rejoined(void) {
    const aisle_vec2 way[4] = {{2.0, 6.0}, {3.0, 11.0}, {17.0, 11.0}, {10.0, 6.0}};
    open_as(AISLE_SPACE_FREE_TURN);
    ask(2.0, 6.0, 10.0, 6.0);
    request.way = way;
    request.way_count = 4;
    TEST_ASSERT_EQUAL(AISLE_OK, run(1000));
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, 8.0, local.length);
}

// A long body: each place of each line with its heading along, and the turning disc at each point between.
static void expect_driven_along(void) {
    const double margin = hall_vehicle.margin;
    for (uint32_t i = 1; i < local.count; i++) {
        const aisle_vec2 a = local.points[i - 1U], b = local.points[i];
        const double length = aisle_vec2_distance(a, b), theta = atan2(b.y - a.y, b.x - a.x);
        for (double s = 0.0; s <= length; s += 0.01) {
            const aisle_vec2 p = aisle_vec2_lerp(a, b, s / length);
            TEST_ASSERT_TRUE(hall_body_gap((aisle_pose2){p.x, p.y, theta}) >= margin);
        }
        if (i + 1U < local.count) {
            TEST_ASSERT_TRUE((double)hall_disc_gap(b.x, b.y, hall_vehicle.outer_radius) >= margin);
        }
    }
}

static void test_a_long_body_turns_only_where_it_has_the_room(void) {
    uint32_t found = 0;
    hall_rectangle(1.8, 0.6, 0.05F);
    for (uint64_t s = 0; s < 40; s++) {
        aisle_rng rng = aisle_rng_seed(s);
        hall_begin(20.0, 12.0);
        movers.count = 0;
        for (int i = 0; i < 9; i++) {
            const aisle_vec2 p = uniform_point(&rng, aisle_vec2_of(3.5, 0.0), aisle_vec2_of(15.0, 10.5));
            hall_add(p.x, p.y, p.x + 1.5, p.y + 1.5);
        }
        open_as(AISLE_SPACE_ALONG);
        ask(1.5, 6.0, 18.5, 6.0);
        request.seed = s;
        if (run(1000) == AISLE_OK) {
            found++;
            expect_driven_along();
        }
    }
    TEST_ASSERT_TRUE(found >= 34U);
}

static void test_without_room_to_turn_it_leaves_straight_ahead(void) {
    hall_rectangle(1.8, 0.6, 0.05F);
    hall_add(0.0, 0.0, 8.0, 5.4);
    hall_add(0.0, 6.6, 8.0, 12.0); // an aisle of 1.2 m
    open_as(AISLE_SPACE_ALONG);
    ask(5.0, 6.0, 14.0, 10.0);
    TEST_ASSERT_EQUAL(AISLE_OK, run(1000));
    TEST_ASSERT_DOUBLE_WITHIN(AISLE_LOCAL_STRAIGHT, 0.0, atan2(local.points[1].y - 6.0, local.points[1].x - 5.0));
    expect_driven_along();
    request.heading = 1.5; // it can neither turn nor leave
    TEST_ASSERT_EQUAL(AISLE_PARTIAL, run(1000));
    TEST_ASSERT_EQUAL(AISLE_LOCAL_STUCK, local.end);
}

// The paper's world: squares of 1.4 m jump within (-1, 1) m; told as discs about all they can reach.
static bool is_off_all(const aisle_vec2 *square, aisle_vec2 p, double need) {
    for (int i = 0; i < 8; i++) {
        if (fabs(p.x - square[i].x) < 0.7 + need && fabs(p.y - square[i].y) < 0.7 + need) {
            return false;
        }
    }
    return true;
}

static uint32_t drive_among_jumps(uint64_t seed) {
    aisle_rng rng = aisle_rng_seed(seed);
    aisle_vec2 square[8], at = {1.0, 6.0};
    uint32_t steps = 0;
    for (int i = 0; i < 8; i++) {
        square[i] = uniform_point(&rng, aisle_vec2_of(4.0, 1.0), aisle_vec2_of(16.0, 11.0));
    }
    for (; steps < 400U && at.x < 18.9; steps++) {
        movers.count = 0;
        for (int i = 0; i < 8; i++) {
            add_mover(square[i].x, square[i].y, 0.0, 0.0, hypot(1.7, 1.7));
        }
        ask(at.x, at.y, 19.0, 6.0);
        request.seed = seed * 1000U + steps;
        const bool waits = run(1000) != AISLE_OK || !is_off_all(square, at, 1.7);
        const double far = waits ? 0.0 : fmin(aisle_vec2_distance(at, local.points[1]), 5.0);
        for (double s = 0.0; !waits && s <= far; s += 0.01) {
            const aisle_vec2 p = aisle_vec2_lerp(at, local.points[1], s / aisle_vec2_distance(at, local.points[1]));
            TEST_ASSERT_TRUE(is_off_all(square, p, 1.0 + 0.3)); // the body, wherever they jump
        }
        at = waits ? at : aisle_vec2_lerp(at, local.points[1], far / aisle_vec2_distance(at, local.points[1]));
        for (int i = 0; i < 8; i++) {
            const aisle_vec2 by = uniform_point(&rng, aisle_vec2_of(-1.0, -1.0), aisle_vec2_of(1.0, 1.0));
            square[i].x = fmin(fmax(square[i].x + by.x, 1.0), 19.0);
            square[i].y = fmin(fmax(square[i].y + by.y, 1.0), 11.0);
        }
    }
    return steps;
}

static void test_among_blocks_that_jump_each_line_is_off_all_they_can_reach(void) {
    open_as(AISLE_SPACE_FREE_TURN);
    for (uint64_t seed = 0; seed < CASES(20); seed++) {
        TEST_ASSERT_TRUE(drive_among_jumps(seed) < 400U); // it arrives
    }
}

static void refuse(aisle_local_request bad) {
    const aisle_local before = local;
    TEST_ASSERT_EQUAL(AISLE_ERR_ARG, aisle_local_start(&local, &bad));
    TEST_ASSERT_EQUAL_MEMORY(&before, &local, sizeof local);
}

static void test_bad_requests_change_nothing(void) {
    static const double bad[] = {(double)NAN, (double)INFINITY, -1.0};
    const aisle_vec2 way[2] = {{2.0, 6.0}, {17.0, 6.0}};
    open_as(AISLE_SPACE_FREE_TURN);
    ask(2.0, 6.0, 18.0, 6.0);
    aisle_local_request r = request;
    for (int i = 0; i < 3; i++) {
        r = request, r.speed = bad[i], refuse(r);
        r = request, r.range = bad[i], refuse(r);
        r = request, r.safety = bad[i], refuse(r);
        r = request, r.drift = bad[i], refuse(r);
        r = request, r.lattice = bad[i], refuse(r);
        r = request, r.longest = bad[i], refuse(r);
    }
    r = request, r.from.x = (double)NAN, refuse(r);
    r = request, r.goal.y = 1e9, refuse(r);
    r = request, r.heading = (double)NAN, refuse(r);
    r = request, r.goal = r.from, refuse(r);
    r = request, r.particles = 1, refuse(r);
    r = request, r.particles = AISLE_PSO_PARTICLES_MAX + 1U, refuse(r);
    r = request, r.iterations = 10001, refuse(r);
    r = request, r.space = NULL, refuse(r);
    r = request, r.way_count = 2, refuse(r);
    r = request, r.way = way, r.way_count = 2, refuse(r); // ends elsewhere
    r = request, r.way = way, r.way_count = AISLE_LOCAL_WAY_MAX + 1U, refuse(r);
    TEST_ASSERT_EQUAL(AISLE_ERR_ARG, aisle_local_start(&local, NULL));
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_an_open_hall_is_crossed_straight);
    RUN_TEST(test_a_pocket_is_left_in_all_seeds_and_the_papers_own_cost_stays_in_it);
    RUN_TEST(test_a_spiral_is_left_in_all_seeds_and_the_papers_own_cost_stays_in_it);
    RUN_TEST(test_a_dead_end_aisle_is_left_in_all_seeds_and_the_papers_own_cost_stays_in_it);
    RUN_TEST(test_an_aisle_a_mover_stands_in_is_left_for_another);
    RUN_TEST(test_one_that_comes_along_an_aisle_makes_it_turn_back);
    RUN_TEST(test_the_old_way_is_rejoined_behind_what_stands_on_it);
    RUN_TEST(test_all_closed_is_told_with_who_closes_it);
    RUN_TEST(test_drawn_halls_with_movers_have_no_line_that_meets_anything);
    RUN_TEST(test_a_way_longer_than_asked_for_is_not_looked_for);
    RUN_TEST(test_slices_change_nothing);
    RUN_TEST(test_places_are_whole_numbers_in_the_papers_field);
    RUN_TEST(test_one_that_is_too_near_already_may_be_left);
    RUN_TEST(test_a_long_body_goes_round_with_its_heading_along);
    RUN_TEST(test_a_point_passes_corners_for_all_seeds_with_little_work);
    RUN_TEST(test_a_step_hangs_on_no_luck);
    RUN_TEST(test_other_seeds_are_other_runs);
    RUN_TEST(test_an_old_way_that_is_clearly_longer_is_not_rejoined);
    RUN_TEST(test_a_long_body_turns_only_where_it_has_the_room);
    RUN_TEST(test_without_room_to_turn_it_leaves_straight_ahead);
    RUN_TEST(test_among_blocks_that_jump_each_line_is_off_all_they_can_reach);
    RUN_TEST(test_bad_requests_change_nothing);
    return UNITY_END();
}
