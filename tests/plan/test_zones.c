#include "plan/zones.h"

#include "hall.h"

enum { SEEDS = 200 };

static aisle_layout_msg layout;
static const double PI = 3.14159265358979323846;

static void begin(void) {
    hall_begin(20.0, 10.0);
    layout = *hall_message(1, 0.1F);
}

static void add(int8_t kind, float value, double direction, int n, double (*v)[2]) {
    aisle_polygon_msg *p = &layout.polygons[layout.num_polygons++];
    *p = (aisle_polygon_msg){.id = 100 + layout.num_polygons,
                             .kind = kind,
                             .value = value,
                             .direction = (float)direction,
                             .num_vertices = (int16_t)n};
    memcpy(p->vertices, v, sizeof(double[2]) * (size_t)n);
}

static void add_box(int8_t kind, float value, double direction, double x0, double y0, double x1, double y1) {
    double v[4][2] = {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}};
    add(kind, value, direction, 4, v);
}

static void build(void) {
    aisle_arena arena = hall_arena(24U << 20);
    hall_seal(&layout);
    hall_open_message(&arena, &layout);
}

static aisle_objective objective_of(int8_t kind) {
    aisle_options_msg options = {.objective = kind};
    aisle_objective out;
    TEST_ASSERT_TRUE(aisle_objective_of(&options, &hall_vehicle, &out));
    TEST_ASSERT_FALSE(out.has_tolls);
    out.has_tolls = aisle_zones_any_toll(&hall_layout, kind);
    return out;
}

static bool allow(double x0, double y0, double x1, double y1, double room, int32_t *id) {
    return aisle_zones_allow(&hall_layout, aisle_vec2_of(x0, y0), aisle_vec2_of(x1, y1), room, id);
}

void setUp(void) {
    hall_disc(0.3, 0.1F);
    begin();
}
void tearDown(void) {}

static void test_without_zones_everything_is_allowed_and_free(void) {
    build();
    aisle_objective shortest = objective_of(AISLE_OPTIONS_SHORTEST);
    TEST_ASSERT_FALSE(aisle_zones_any_directed(&hall_layout));
    TEST_ASSERT_FALSE(shortest.has_tolls);
    TEST_ASSERT_TRUE(aisle_objective_is_length(&shortest));
    TEST_ASSERT_TRUE(allow(1.0, 1.0, 9.0, 9.0, 0.1, NULL));
    TEST_ASSERT_TRUE(aisle_zones_toll(&hall_layout, &shortest, aisle_vec2_of(1, 1), aisle_vec2_of(9, 9)) <= 0.0);
}

static void test_a_way_is_allowed_up_to_a_right_angle_and_a_milliradian(void) {
    add_box(AISLE_POLYGON_DIRECTED, 0.0F, 0.5 * PI, 4.0, 4.0, 8.0, 6.0); // to the north
    build();
    int32_t id = 0;
    TEST_ASSERT_TRUE(allow(6.0, 1.0, 6.0, 9.0, 0.0, NULL));
    TEST_ASSERT_FALSE(allow(6.0, 9.0, 6.0, 1.0, 0.0, &id));
    TEST_ASSERT_EQUAL_INT32(101, id);
    TEST_ASSERT_TRUE(allow(1.0, 5.0, 11.0, 5.0, 0.0, NULL));
    TEST_ASSERT_TRUE(allow(1.0, 5.0, 11.0, 5.0 - 0.009, 0.0, NULL));
    TEST_ASSERT_FALSE(allow(1.0, 5.0, 11.0, 5.0 - 0.011, 0.0, NULL));
    TEST_ASSERT_TRUE(allow(6.0, 5.0, 6.0, 5.0, 0.0, NULL)); // nowhere
}

static void test_only_what_is_inside_counts_and_room_makes_it_wider(void) {
    add_box(AISLE_POLYGON_DIRECTED, 0.0F, 0.5 * PI, 4.0, 4.0, 8.0, 6.0);
    build();
    TEST_ASSERT_TRUE(allow(8.05, 9.0, 8.05, 1.0, 0.0, NULL));
    TEST_ASSERT_FALSE(allow(8.05, 9.0, 8.05, 1.0, 0.1, NULL));
    TEST_ASSERT_TRUE(allow(8.15, 9.0, 8.15, 1.0, 0.1, NULL));
    TEST_ASSERT_TRUE(allow(6.0, 9.0, 6.0, 6.0, 0.0, NULL)); // ends on its border
    TEST_ASSERT_TRUE(aisle_zones_is_near_directed(&hall_layout, aisle_vec2_of(8.05, 5.0), 0.1));
    TEST_ASSERT_FALSE(aisle_zones_is_near_directed(&hall_layout, aisle_vec2_of(8.15, 5.0), 0.1));
    TEST_ASSERT_TRUE(aisle_zones_is_near_directed(&hall_layout, aisle_vec2_of(5.0, 5.0), 0.1));
}

// An arc from (x, y) by heading, curvature and length; libm.
static void arc(double x, double y, double heading, double k, double length, aisle_waypoint_msg *w) {
    w[0] = (aisle_waypoint_msg){.x = x, .y = y, .theta = heading};
    double kf = (double)(float)k;
    w[1] = (aisle_waypoint_msg){.x = x + (sin(heading + kf * length) - sin(heading)) / kf,
                                .y = y - (cos(heading + kf * length) - cos(heading)) / kf,
                                .theta = remainder(heading + kf * length, 2.0 * PI),
                                .curvature = (float)k};
}

static void test_arcs_allowed_are_so_at_every_sample_and_few_others_are_refused_for_every_seed(void) {
    int allowed = 0, refused = 0, hard = 0;
    const double dx = cos(0.7), dy = sin(0.7);
    add_box(AISLE_POLYGON_DIRECTED, 0.0F, 0.7, 4.0, 4.0, 8.0, 6.0);
    build();
    for (uint64_t s = 0; s < SEEDS; s++) {
        aisle_rng rng = aisle_rng_seed(s);
        aisle_waypoint_msg w[2];
        double heading = uniform(&rng, -3.1, 3.1), k = uniform(&rng, 0.2, 2.0) * (s % 2U == 0U ? 1.0 : -1.0);
        double length = uniform(&rng, 0.2, 2.5 / fabs(k)), x = uniform(&rng, 3.0, 9.0), y = uniform(&rng, 3.0, 7.0);
        arc(x, y, heading, k, length, w);
        bool says = aisle_zones_allow_piece(&hall_layout, &w[0], &w[1], NULL), against = false;
        for (int i = 0; i <= 500; i++) {
            double h = heading + k * length * i / 500.0;
            double px = x + (sin(h) - sin(heading)) / k, py = y - (cos(h) - cos(heading)) / k;
            against = against || (px > 4.0 && px < 8.0 && py > 4.0 && py < 6.0 && cos(h) * dx + sin(h) * dy < -2e-3);
        }
        TEST_ASSERT_FALSE(says && against);
        allowed += says ? 1 : 0;
        refused += !says && against ? 1 : 0;
        hard += !says && !against ? 1 : 0;
    }
    TEST_ASSERT_GREATER_THAN(SEEDS / 4, allowed);
    TEST_ASSERT_GREATER_THAN(SEEDS / 8, refused);
    TEST_ASSERT_LESS_THAN(SEEDS / 20, hard);
}

static void test_the_end_of_a_tight_arc_counts_and_not_its_chord_alone(void) {
    add_box(AISLE_POLYGON_DIRECTED, 0.0F, 0.0, 4.0, 4.0, 8.0, 6.0);
    build();
    aisle_waypoint_msg w[2];
    arc(5.0, 5.0, 1.2, 20.0, 0.04, w); // from 69 to 115 degrees, its chord at 92
    TEST_ASSERT_FALSE(aisle_zones_allow_piece(&hall_layout, &w[0], &w[1], NULL));
    arc(5.0, 5.0, 1.0, 20.0, 0.04, w); // to 103, its chord at 80
    TEST_ASSERT_FALSE(aisle_zones_allow_piece(&hall_layout, &w[0], &w[1], NULL));
    arc(5.0, 5.0, 0.2, 20.0, 0.04, w); // to 57
    TEST_ASSERT_TRUE(aisle_zones_allow_piece(&hall_layout, &w[0], &w[1], NULL));
}

static void test_the_arc_counts_where_it_bulges_in_and_its_chord_is_outside(void) {
    add_box(AISLE_POLYGON_DIRECTED, 0.0F, PI, 4.0, 4.0, 8.0, 6.0);
    build();
    aisle_waypoint_msg w[2];
    arc(5.0, 6.0005, -0.0735, 3.0, 0.049, w); // 0.9 mm below its chord
    TEST_ASSERT_FALSE(aisle_zones_allow_piece(&hall_layout, &w[0], &w[1], NULL));
    arc(5.0, 6.0011, -0.0735, 3.0, 0.049, w);
    TEST_ASSERT_TRUE(aisle_zones_allow_piece(&hall_layout, &w[0], &w[1], NULL));
}

static void test_a_turn_on_the_spot_is_no_way(void) {
    add_box(AISLE_POLYGON_DIRECTED, 0.0F, 0.0, 4.0, 4.0, 8.0, 6.0);
    build();
    aisle_waypoint_msg w[2] = {{.x = 5.0, .y = 5.0, .flags = AISLE_WAYPOINT_TURN_IN_PLACE},
                               {.x = 5.0, .y = 5.0, .theta = 3.0}};
    TEST_ASSERT_TRUE(aisle_zones_allow_piece(&hall_layout, &w[0], &w[1], NULL));
}

static void test_penalties_cost_their_value_by_length_and_add_up_for_every_objective(void) {
    add_box(AISLE_POLYGON_PENALTY, 0.4F, 0.0, 4.0, 4.0, 8.0, 6.0);
    add_box(AISLE_POLYGON_PENALTY, 0.1F, 0.0, 6.0, 4.0, 8.0, 6.0);
    add_box(AISLE_POLYGON_OBSTACLE, 0.5F, 0.0, 6.0, 4.0, 8.0, 6.0);
    build();
    const double want = AISLE_PENALTY_WEIGHT * (0.4 * 4.0 + 0.1 * 2.0);
    for (int8_t kind = AISLE_OPTIONS_SAFEST; kind <= AISLE_OPTIONS_LEAST_ENERGY; kind++) {
        aisle_objective objective = objective_of(kind);
        TEST_ASSERT_TRUE(objective.has_tolls);
        TEST_ASSERT_FALSE(aisle_objective_is_length(&objective));
        TEST_ASSERT_DOUBLE_WITHIN(
            1e-6, want, aisle_zones_toll(&hall_layout, &objective, aisle_vec2_of(1, 5), aisle_vec2_of(15, 5)));
        TEST_ASSERT_DOUBLE_WITHIN(1e-6, 7.5, aisle_zones_toll_at(&hall_layout, &objective, aisle_vec2_of(7, 5)));
        TEST_ASSERT_DOUBLE_WITHIN(1e-6, 0.0, aisle_zones_toll_at(&hall_layout, &objective, aisle_vec2_of(3, 5)));
    }
}

static void test_a_pieces_toll_is_the_integral_along_the_arc_for_every_seed(void) {
    double tri[3][2] = {{4.0, 4.0}, {8.0, 4.5}, {5.0, 7.0}};
    add(AISLE_POLYGON_PENALTY, 1.0F, 0.0, 3, tri);
    build();
    aisle_objective objective = objective_of(AISLE_OPTIONS_SHORTEST);
    for (uint64_t s = 0; s < SEEDS / 4; s++) {
        aisle_rng rng = aisle_rng_seed(s);
        aisle_waypoint_msg w[2];
        double heading = uniform(&rng, -3.1, 3.1), k = uniform(&rng, 0.2, 1.0), length = uniform(&rng, 0.5, 2.5 / k);
        double x = uniform(&rng, 4.0, 7.0), y = uniform(&rng, 4.0, 6.0), sum = 0.0;
        arc(x, y, heading, k, length, w);
        for (int i = 0; i < 4000; i++) {
            double h = heading + k * length * (i + 0.5) / 4000.0;
            double px = x + (sin(h) - sin(heading)) / k, py = y - (cos(h) - cos(heading)) / k;
            bool in = true;
            for (int e = 0; e < 3; e++) {
                const double *a = tri[e], *b = tri[(e + 1) % 3];
                in = in && (b[0] - a[0]) * (py - a[1]) - (b[1] - a[1]) * (px - a[0]) >= 0.0;
            }
            sum += in ? length / 4000.0 : 0.0;
        }
        TEST_ASSERT_DOUBLE_WITHIN(0.15, 15.0 * sum, aisle_zones_toll_piece(&hall_layout, &objective, &w[0], &w[1]));
        TEST_ASSERT_DOUBLE_WITHIN(0.15, 15.0 * sum, aisle_zones_penalty_piece(&hall_layout, &w[0], &w[1]));
    }
}

static void test_slow_zones_cost_time_and_energy_alone(void) {
    add_box(AISLE_POLYGON_SPEED_LIMIT, 0.5F, 0.0, 4.0, 4.0, 8.0, 6.0); // of 1.5 m/s
    add_box(AISLE_POLYGON_SPEED_LIMIT, 9.0F, 0.0, 4.0, 4.0, 8.0, 6.0); // slows nobody
    build();
    aisle_objective fastest = objective_of(AISLE_OPTIONS_FASTEST), least = objective_of(AISLE_OPTIONS_LEAST_ENERGY);
    aisle_objective shortest = objective_of(AISLE_OPTIONS_SHORTEST), safest = objective_of(AISLE_OPTIONS_SAFEST);
    aisle_vec2 a = {1.0, 5.0}, b = {15.0, 5.0};
    TEST_ASSERT_TRUE(aisle_objective_is_length(&shortest));
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, 2.0 * 4.0, aisle_zones_toll(&hall_layout, &fastest, a, b)); // thrice the time
    // idle power at 0.5 and 1.5 m/s, as a share of all it takes at 1.5 m/s
    double rolling = 500.0 * 9.81 * 0.015 / 0.8, extra = 50.0 / 0.5 - 50.0 / 1.5;
    TEST_ASSERT_DOUBLE_WITHIN(1e-4, 4.0 * extra / (rolling + 50.0 / 1.5), aisle_zones_toll(&hall_layout, &least, a, b));
    TEST_ASSERT_TRUE(aisle_zones_toll(&hall_layout, &safest, a, b) <= 0.0);
    aisle_waypoint_msg w[2] = {{.x = 1.0, .y = 5.0}, {.x = 15.0, .y = 5.0}};
    TEST_ASSERT_TRUE(aisle_zones_penalty_piece(&hall_layout, &w[0], &w[1]) <= 0.0);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_without_zones_everything_is_allowed_and_free);
    RUN_TEST(test_a_way_is_allowed_up_to_a_right_angle_and_a_milliradian);
    RUN_TEST(test_only_what_is_inside_counts_and_room_makes_it_wider);
    RUN_TEST(test_arcs_allowed_are_so_at_every_sample_and_few_others_are_refused_for_every_seed);
    RUN_TEST(test_the_end_of_a_tight_arc_counts_and_not_its_chord_alone);
    RUN_TEST(test_the_arc_counts_where_it_bulges_in_and_its_chord_is_outside);
    RUN_TEST(test_a_turn_on_the_spot_is_no_way);
    RUN_TEST(test_penalties_cost_their_value_by_length_and_add_up_for_every_objective);
    RUN_TEST(test_a_pieces_toll_is_the_integral_along_the_arc_for_every_seed);
    RUN_TEST(test_slow_zones_cost_time_and_energy_alone);
    return UNITY_END();
}
