// Random halls, bodies, stops and options through the public door: every query is answered within its budget, for a cause
// that is the world's or the request's and never the planner's, and every path is judged clear.
#include "door.h"

enum { SEEDS = 150, QUERIES = 3 };

static aisle_rng rng;

static double drawn(double lo, double hi) {
    return uniform(&rng, lo, hi);
}
static bool one_in(uint32_t n) {
    return aisle_rng_below(&rng, n) == 0;
}

static void draw_hall(void) {
    double width = drawn(2.0, 20.0);
    hall_begin(width, drawn(2.0, 15.0));
    for (uint32_t n = aisle_rng_below(&rng, 14U); n > 0; n--) {
        aisle_vec2 at = uniform_point(&rng, aisle_vec2_of(-1.0, -1.0), aisle_vec2_of(hall_width, hall_height));
        aisle_vec2 size =
            uniform_point(&rng, aisle_vec2_of(0.05, 0.05), aisle_vec2_of(hall_width / 3.0, hall_height / 3.0));
        hall_add(at.x, at.y, at.x + size.x, at.y + (one_in(3) ? 0.02 : size.y));
    }
}

static aisle_vehicle_msg draw_vehicle(void) {
    aisle_vehicle_msg msg = {.vehicle_revision = 1, .utime = 1};
    msg.margin = one_in(3) ? -1.0F : (float)drawn(0.01, 0.2);
    if (one_in(2)) {
        msg.footprint_radius = (float)drawn(0.02, 0.5);
    } else {
        double length = drawn(0.3, 1.4);
        double half = 0.5 * drawn(0.2, 0.8);
        double rear = -length * drawn(0.2, 0.8);
        const double v[4][2] = {{rear, -half}, {rear + length, -half}, {rear + length, half}, {rear, half}};
        memcpy(msg.footprint, v, sizeof v);
        msg.num_vertices = 4;
    }
    msg.curvature_max = one_in(6) ? (float)drawn(0.3, 3.0) : 0.0F;
    msg.creep_clearance = one_in(3) ? (float)drawn(0.05, 1.0) : 0.0F;
    msg.drive = (int8_t)(one_in(4) ? AISLE_VEHICLE_OMNI : AISLE_VEHICLE_DIFFERENTIAL);
    return msg;
}

static aisle_goal_msg draw_stop(int32_t id) {
    aisle_vec2 at = uniform_point(&rng, aisle_vec2_of(0.0, 0.0), aisle_vec2_of(hall_width, hall_height));
    aisle_goal_msg stop = {.id = id, .x = at.x, .y = at.y};
    stop.theta = drawn(-4.0, 4.0);
    stop.tolerance_theta = one_in(3) ? 0.0F : 4.0F;
    stop.dwell = one_in(5) ? 2.0F : 0.0F;
    return stop;
}

static aisle_query_msg draw_query(int32_t id) {
    static const int8_t planners[] = {AISLE_OPTIONS_AUTO, AISLE_OPTIONS_AUTO, AISLE_OPTIONS_PSO, AISLE_OPTIONS_ASTAR};
    aisle_query_msg query = {.query_id = id, .map_id = 1, .start = draw_stop(0)};
    query.num_goals = (int16_t)(one_in(3) ? 1U + aisle_rng_below(&rng, 4U) : 1U);
    for (int16_t i = 0; i < query.num_goals; i++) {
        query.goals[i] = one_in(8) ? query.start : draw_stop(i + 1);
        query.goals[i].id = i + 1;
    }
    query.ordering = (int8_t)aisle_rng_below(&rng, 2U);
    query.options.planner = planners[aisle_rng_below(&rng, 4U)];
    query.options.objective = (int8_t)aisle_rng_below(&rng, 4U);
    query.options.interpolation = (int8_t)aisle_rng_below(&rng, 2U);
    query.options.zone = one_in(3) ? (float)drawn(-0.5, 1.0) : 0.0F;
    query.options.work_units = one_in(4) ? (int32_t)(1U + aisle_rng_below(&rng, 20000U)) : 200000;
    return query;
}

// A cause of the world or the request; not a failure of the planner, not a limit.
static bool is_fair(const aisle_path_msg *reply) {
    int16_t c = reply->cause;
    return c == AISLE_STATUS_START_OCCUPIED || c == AISLE_STATUS_GOAL_OCCUPIED || c == AISLE_STATUS_NO_PATH ||
           c == AISLE_STATUS_TOO_NARROW || c == AISLE_STATUS_KINEMATIC || c == AISLE_STATUS_BUDGET;
}

// Where an occupied stop is told to move to, the body keeps its margin.
static void judge_move(const aisle_query_msg *query, const aisle_path_msg *reply) {
    const aisle_waypoint_msg *w = reply->waypoints;
    const aisle_goal_msg *stop = reply->cause == AISLE_STATUS_START_OCCUPIED ? &query->start : NULL;
    for (int16_t i = 0; stop == NULL && i < query->num_goals; i++) {
        bool here = fabs(query->goals[i].x - w[0].x) < 1e-9 && fabs(query->goals[i].y - w[0].y) < 1e-9;
        stop = here ? &query->goals[i] : NULL;
    }
    TEST_ASSERT_NOT_NULL(stop);
    if (reply->num_waypoints < 2) {
        TEST_ASSERT_TRUE((double)reply->cause_value <= 0.0);
        return;
    }
    double gap = (double)stop->tolerance_theta >= 3.14159
                     ? (double)hall_disc_gap(w[1].x, w[1].y, hall_vehicle.inner_radius)
                     : hall_body_gap((aisle_pose2){w[1].x, w[1].y, stop->theta});
    TEST_ASSERT_TRUE(gap >= hall_vehicle.margin + 1.4e-3);
    double way = hypot(w[1].x - w[0].x, w[1].y - w[0].y);
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, way, (double)reply->cause_value);
    TEST_ASSERT_TRUE((double)reply->cause_value >= way);
}

static void test_every_query_in_random_worlds_is_answered_fairly_and_every_path_is_clear(void) {
    int paths = 0;
    int refusals = 0;
    for (uint64_t seed = 0; seed < SEEDS; seed++) {
        rng = aisle_rng_seed(seed);
        draw_hall();
        aisle_vehicle_msg vehicle = draw_vehicle();
        aisle_refusal why;
        TEST_ASSERT_EQUAL(AISLE_OK, aisle_vehicle_from_msg(&vehicle, &hall_vehicle, &why)); // the judge's
        door_open(0);
        TEST_ASSERT_EQUAL(AISLE_OK, door_submit(AISLE_INPUT_LAYOUT, hall_message(1, one_in(2) ? 0.0F : 0.1F)));
        door_settle();
        TEST_ASSERT_EQUAL(AISLE_OK, door_submit(AISLE_INPUT_VEHICLE, &vehicle));
        for (int32_t q = 1; q <= QUERIES; q++) {
            aisle_query_msg query = draw_query(q);
            door_units = 1U + aisle_rng_below(&rng, 5000U);
            const aisle_path_msg *reply = door_ask(&query);
            TEST_ASSERT_TRUE(reply->work_units <= query.options.work_units + 2 * 4096);
            if (reply->status == AISLE_PATH_OK) {
                (void)door_judge(reply);
                paths++;
            } else {
                TEST_ASSERT_TRUE(is_fair(reply));
                if (reply->cause == AISLE_STATUS_START_OCCUPIED || reply->cause == AISLE_STATUS_GOAL_OCCUPIED) {
                    judge_move(&query, reply);
                }
                refusals++;
            }
        }
    }
    TEST_ASSERT_TRUE(paths > 100 && refusals > 100);
}

void setUp(void) {
    door_config = (aisle_config){
        .limits = {.cells = 250000, .polygons = 64, .vertices = 512, .open_nodes = 65536, .requests = 2}, .boot_id = 1};
}
void tearDown(void) {}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_every_query_in_random_worlds_is_answered_fairly_and_every_path_is_clear);
    return UNITY_END();
}
