#include "plan/one_way.h"

#include "hall.h"

enum { SEEDS = 200 };

static aisle_layout_msg layout;
static aisle_seed seed;
static aisle_space space;
static aisle_one_way one_way;
static const double PI = 3.14159265358979323846;

static void begin(double width, double height) {
    hall_begin(width, height);
}

static void open_zones(void) {
    layout = *hall_message(1, 0.1F);
}

static void add(double direction, double x0, double y0, double x1, double y1) {
    const double v[4][2] = {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}};
    aisle_polygon_msg *p = &layout.polygons[layout.num_polygons++];
    *p = (aisle_polygon_msg){.id = 100 + layout.num_polygons,
                             .kind = AISLE_POLYGON_DIRECTED,
                             .direction = (float)direction,
                             .num_vertices = 4};
    memcpy(p->vertices, v, sizeof v);
}

static void build(void) {
    aisle_arena arena = hall_arena(24U << 20);
    hall_seal(&layout);
    hall_open_message(&arena, &layout);
    aisle_seed_carve(&seed, &arena, &hall_limits);
    aisle_space_carve(&space, &arena, hall_limits.cells);
    TEST_ASSERT_FALSE(arena.overflow);
    aisle_space_begin(&space, &hall_layout, &hall_vehicle, AISLE_SPACE_FREE_TURN);
}

static uint32_t spent;

static bool shut_by(double x0, double y0, double x1, double y1, uint32_t slice) {
    aisle_status st;
    spent = 0;
    aisle_one_way_start(&one_way, &seed, &space, aisle_vec2_of(x0, y0), aisle_vec2_of(x1, y1),
                        hall_vehicle.inner_radius + hall_vehicle.margin);
    do {
        st = aisle_one_way_step(&one_way, slice, &spent);
    } while (st == AISLE_BUSY);
    return st == AISLE_OK;
}

static bool shut(double x0, double y0, double x1, double y1) {
    return shut_by(x0, y0, x1, y1, 1000);
}

void setUp(void) {
    hall_disc(0.4, 0.1F);
}
void tearDown(void) {}

static void test_a_zone_across_an_aisle_shuts_it_one_way_alone(void) {
    begin(20.0, 3.0);
    open_zones();
    add(0.3, 6.0, -1.0, 14.0, 4.0);
    build();
    TEST_ASSERT_FALSE(shut(2.0, 1.5, 18.0, 1.5));
    TEST_ASSERT_TRUE(shut(18.0, 1.5, 2.0, 1.5));
    TEST_ASSERT_TRUE(shut(10.0, 1.5, 2.0, 1.5)); // from inside
    TEST_ASSERT_FALSE(shut(10.0, 1.5, 18.0, 1.5));
    TEST_ASSERT_TRUE(shut(18.0, 1.5, 10.0, 1.5)); // to the inside, but not to its border
    TEST_ASSERT_FALSE(shut(2.0, 1.5, 10.0, 1.5));
}

static void test_a_way_beside_a_zone_is_no_proof(void) {
    begin(20.0, 8.0);
    hall_add(4.0, 3.0, 16.0, 5.0);
    open_zones();
    add(0.0, 6.0, -1.0, 14.0, 4.0);
    build();
    TEST_ASSERT_FALSE(shut(18.0, 1.5, 2.0, 1.5));
}

static void test_a_way_that_comes_in_lower_by_another_zone_is_found(void) {
    begin(20.0, 8.0);
    hall_add(4.0, 3.0, 16.0, 5.0);
    open_zones();
    add(0.0, 6.0, -1.0, 14.0, 4.0); // lower aisle to the east
    add(PI, 6.0, 4.0, 14.0, 9.0);   // upper one to the west
    build();
    TEST_ASSERT_FALSE(shut(18.0, 1.5, 7.5, 1.5)); // by the upper one into the lower one's beginning
    TEST_ASSERT_TRUE(one_way.floods >= 2U);
    begin(20.0, 8.0);
    hall_add(4.0, 3.0, 16.0, 5.0);
    open_zones();
    add(0.0, 6.0, -1.0, 14.0, 4.0);
    add(0.0, 6.0, 4.0, 14.0, 9.0);
    build();
    TEST_ASSERT_TRUE(shut(18.0, 1.5, 7.5, 1.5));
}

static void test_a_zone_of_less_than_three_cells_shuts_nothing(void) {
    begin(20.0, 3.0);
    open_zones();
    add(0.0, 9.93, -1.0, 10.07, 4.0);
    build();
    TEST_ASSERT_FALSE(shut(18.0, 1.5, 2.0, 1.5));
}

// A box in a frame at `at`, turned by `angle`.
static void add_turned(int8_t kind, double direction, aisle_vec2 at, double angle, aisle_aabb box) {
    const double c = cos(angle), s = sin(angle);
    const double x[4] = {box.lo.x, box.hi.x, box.hi.x, box.lo.x}, y[4] = {box.lo.y, box.lo.y, box.hi.y, box.hi.y};
    add(direction, 0.0, 0.0, 0.0, 0.0);
    aisle_polygon_msg *p = &layout.polygons[layout.num_polygons - 1];
    p->kind = kind;
    for (int i = 0; i < 4; i++) {
        p->vertices[i][0] = at.x + c * x[i] - s * y[i];
        p->vertices[i][1] = at.y + s * x[i] + c * y[i];
    }
}

// A corridor with 2 mm to spare, oblique to the grid, across a zone: nothing is lost on the way, whatever cells it meets.
static void test_ways_at_a_right_angle_to_a_zone_are_not_shut_and_those_against_it_are(void) {
    const aisle_vec2 at = {2.0, 4.0};
    for (double angle = 0.05; angle < 0.65; angle += 0.043) {
        for (int against = 0; against < 2; against++) {
            const double direction = against != 0 ? angle + 0.5 * PI + 0.1 : angle + 0.5 * PI - 1e-5;
            begin(20.0, 20.0);
            open_zones();
            add_turned(AISLE_POLYGON_OBSTACLE, 0.0, at, angle, (aisle_aabb){{2.0, 0.501}, {14.0, 30.0}});
            add_turned(AISLE_POLYGON_OBSTACLE, 0.0, at, angle, (aisle_aabb){{2.0, -30.0}, {14.0, -0.501}});
            add_turned(AISLE_POLYGON_DIRECTED, direction, at, angle, (aisle_aabb){{4.0, -2.0}, {12.0, 2.0}});
            build();
            TEST_ASSERT_EQUAL_INT(against, shut(at.x, at.y, at.x + 16.0 * cos(angle), at.y + 16.0 * sin(angle)));
        }
    }
}

// Where a polyline of random points obeys every zone, nothing is shut: the proof is never wrong about it.
static bool obeys(const aisle_vec2 *p, int n) {
    for (int i = 0; i + 1 < n; i++) {
        for (int k = 0; k <= 400; k++) {
            double x = p[i].x + (p[i + 1].x - p[i].x) * k / 400.0, y = p[i].y + (p[i + 1].y - p[i].y) * k / 400.0;
            if (hall_disc_gap(x, y, 0.5) < 1e-3L) {
                return false;
            }
            for (int z = 0; z < layout.num_polygons; z++) {
                const aisle_polygon_msg *q = &layout.polygons[z];
                double along = (p[i + 1].x - p[i].x) * cos((double)q->direction) +
                               (p[i + 1].y - p[i].y) * sin((double)q->direction);
                bool in =
                    x > q->vertices[0][0] && x < q->vertices[2][0] && y > q->vertices[0][1] && y < q->vertices[2][1];
                if (q->kind == AISLE_POLYGON_DIRECTED && in && along < 0.0) {
                    return false;
                }
            }
        }
    }
    return true;
}

static void test_what_is_shut_has_no_way_among_random_polylines_for_every_seed(void) {
    int proofs = 0, ways = 0;
    for (uint64_t s = 0; s < SEEDS; s++) {
        aisle_rng rng = aisle_rng_seed(s);
        begin(8.0, 4.0);
        open_zones();
        for (int i = 0; i < 3; i++) {
            double x = uniform(&rng, 1.5, 5.0), y = uniform(&rng, -0.5, 1.5);
            aisle_vec2 size = uniform_point(&rng, aisle_vec2_of(0.8, 2.0), aisle_vec2_of(2.0, 4.0));
            double direction = uniform(&rng, -3.1, 3.1);
            add(direction, x, y, x + size.x, y + size.y);
        }
        build();
        bool is_shut = shut(7.3, 2.0, 0.7, 2.0), way = false;
        for (int k = 0; k < 300 && !way; k++) {
            aisle_vec2 p[5] = {{7.3, 2.0}, {0.0, 0.0}, {0.0, 0.0}, {0.0, 0.0}, {0.7, 2.0}};
            for (int i = 1; i < 4; i++) {
                p[i] = uniform_point(&rng, aisle_vec2_of(0.6, 0.6), aisle_vec2_of(7.4, 3.4));
            }
            way = obeys(p, 5);
        }
        TEST_ASSERT_FALSE(is_shut && way);
        proofs += is_shut ? 1 : 0;
        ways += way ? 1 : 0;
    }
    TEST_ASSERT_GREATER_THAN(2, proofs);
    TEST_ASSERT_GREATER_THAN(2, ways);
}

static void test_any_slicing_spends_and_answers_the_same(void) {
    begin(20.0, 3.0);
    open_zones();
    add(0.3, 6.0, -1.0, 14.0, 4.0);
    build();
    TEST_ASSERT_TRUE(shut_by(18.0, 1.5, 2.0, 1.5, UINT32_MAX));
    const uint32_t whole = spent;
    TEST_ASSERT_TRUE(shut_by(18.0, 1.5, 2.0, 1.5, 1));
    TEST_ASSERT_EQUAL_UINT32(whole, spent);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_a_zone_across_an_aisle_shuts_it_one_way_alone);
    RUN_TEST(test_a_way_beside_a_zone_is_no_proof);
    RUN_TEST(test_a_way_that_comes_in_lower_by_another_zone_is_found);
    RUN_TEST(test_a_zone_of_less_than_three_cells_shuts_nothing);
    RUN_TEST(test_ways_at_a_right_angle_to_a_zone_are_not_shut_and_those_against_it_are);
    RUN_TEST(test_what_is_shut_has_no_way_among_random_polylines_for_every_seed);
    RUN_TEST(test_any_slicing_spends_and_answers_the_same);
    return UNITY_END();
}
