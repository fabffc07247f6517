// Zones and limits nobody should send, through the public door: a clear cause, what was there before stays, and nothing
// unproved leaves.
#include "door.h"

static aisle_layout_msg layout;
static aisle_query_msg query;
static aisle_vehicle_msg vehicle;

static void world(double width, double height) {
    static int32_t revision;
    memset(&layout, 0, sizeof layout);
    layout =
        (aisle_layout_msg){.map_id = 1, .map_revision = ++revision, .num_parts = 1, .x_max = width, .y_max = height};
    hall_begin(width, height);
}

static aisle_polygon_msg *add(int8_t kind, double x0, double y0, double x1, double y1) {
    const double v[4][2] = {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}};
    aisle_polygon_msg *p = &layout.polygons[layout.num_polygons++];
    *p = (aisle_polygon_msg){.id = 40 + layout.num_polygons, .kind = kind, .num_vertices = 4};
    memcpy(p->vertices, v, sizeof v);
    return p;
}

static aisle_status send_world(void) {
    layout.total_polygons = layout.num_polygons;
    layout.crc32 = (int32_t)aisle_layout_crc32(0, &layout);
    aisle_status st = door_submit(AISLE_INPUT_LAYOUT, &layout);
    door_settle();
    return st;
}

static const aisle_path_msg *ask(double x0, double y0, double x1, double y1) {
    static int32_t id;
    query = door_query(++id, x0, y0, x1, y1);
    query.options.objective = AISLE_OPTIONS_SHORTEST;
    return door_ask(&query);
}

static void expect_path(double x0, double y0, double x1, double y1) {
    (void)door_judge(ask(x0, y0, x1, y1));
}

static void expect_cause(int16_t cause, int32_t id, double x0, double y0, double x1, double y1) {
    const aisle_path_msg *path = ask(x0, y0, x1, y1);
    TEST_ASSERT_EQUAL(AISLE_PATH_NONE, path->status);
    TEST_ASSERT_EQUAL_INT16(cause, path->cause);
    TEST_ASSERT_EQUAL_INT32(id, path->cause_id);
}

static aisle_status_msg status_now(void) {
    aisle_status_msg status;
    aisle_planner_status(door, door_now, &status);
    return status;
}

void setUp(void) {
    vehicle = (aisle_vehicle_msg){.vehicle_revision = 1, .footprint_radius = 0.4F, .margin = 0.1F};
    hall_disc(0.4, 0.1F);
    door_config = (aisle_config){.limits = {.requests = 2U}, .has_vehicle = true, .vehicle = vehicle};
    door_open(0);
    world(20.0, 3.0);
    TEST_ASSERT_EQUAL(AISLE_OK, send_world());
}
void tearDown(void) {}

// ---- zones

static void test_zones_with_values_that_are_none_are_refused_by_id_and_the_old_hall_stays(void) {
    const struct {
        int8_t kind;
        float value, direction;
    } bad[] = {{AISLE_POLYGON_SPEED_LIMIT, 0.0F, 0.0F},
               {AISLE_POLYGON_SPEED_LIMIT, -1.0F, 0.0F},
               {AISLE_POLYGON_SPEED_LIMIT, (float)NAN, 0.0F},
               {AISLE_POLYGON_SPEED_LIMIT, (float)INFINITY, 0.0F},
               {AISLE_POLYGON_PENALTY, 1.5F, 0.0F},
               {AISLE_POLYGON_PENALTY, -0.1F, 0.0F},
               {AISLE_POLYGON_PENALTY, (float)NAN, 0.0F},
               {AISLE_POLYGON_DIRECTED, 0.0F, (float)NAN},
               {AISLE_POLYGON_DIRECTED, 0.0F, (float)INFINITY},
               {5, 0.0F, 0.0F},
               {-1, 0.0F, 0.0F}};
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        int32_t held = status_now().map_revision;
        world(20.0, 3.0);
        aisle_polygon_msg *p = add(bad[i].kind, 8.0, -1.0, 12.0, 4.0);
        p->value = bad[i].value;
        p->direction = bad[i].direction;
        TEST_ASSERT_EQUAL(AISLE_ERR_DATA, send_world());
        TEST_ASSERT_EQUAL_INT16(AISLE_STATUS_MALFORMED, status_now().cause);
        TEST_ASSERT_EQUAL_INT32(41, status_now().cause_id);
        TEST_ASSERT_EQUAL_INT32(held, status_now().map_revision);
        expect_path(2.0, 1.5, 18.0, 1.5);
    }
}

static void test_zones_that_contradict_each_other_are_taken_and_told_as_the_cause(void) {
    world(20.0, 3.0);
    (void)add(AISLE_POLYGON_DIRECTED, 6.0, -1.0, 12.0, 4.0);
    add(AISLE_POLYGON_DIRECTED, 8.0, -1.0, 14.0, 4.0)->direction = (float)DOOR_PI;
    TEST_ASSERT_EQUAL(AISLE_OK, send_world());
    expect_cause(AISLE_STATUS_NO_PATH, 42, 2.0, 1.5, 18.0, 1.5);
    expect_cause(AISLE_STATUS_NO_PATH, 41, 18.0, 1.5, 2.0, 1.5);
    expect_path(2.0, 1.5, 7.0, 1.5);
}

static void test_the_slowest_of_contradicting_limits_holds(void) {
    world(20.0, 3.0);
    add(AISLE_POLYGON_SPEED_LIMIT, 6.0, -1.0, 14.0, 4.0)->value = 1.0F;
    add(AISLE_POLYGON_SPEED_LIMIT, 6.0, -1.0, 14.0, 4.0)->value = 0.2F;
    TEST_ASSERT_EQUAL(AISLE_OK, send_world());
    expect_path(2.0, 1.5, 18.0, 1.5);
    TEST_ASSERT_TRUE(door_reply.duration > 8.0F / 0.2F);
}

static void test_a_keepout_over_a_stop_is_told_by_id(void) {
    world(20.0, 3.0);
    (void)add(AISLE_POLYGON_KEEPOUT, 1.0, 0.5, 3.0, 2.5);
    TEST_ASSERT_EQUAL(AISLE_OK, send_world());
    expect_cause(AISLE_STATUS_START_OCCUPIED, 41, 2.0, 1.5, 18.0, 1.5);
    expect_cause(AISLE_STATUS_GOAL_OCCUPIED, 41, 18.0, 1.5, 2.0, 1.5);
    expect_path(5.0, 1.5, 18.0, 1.5);
}

static void test_a_zone_so_slow_that_a_path_would_last_too_long_is_a_limit(void) {
    world(20.0, 3.0);
    add(AISLE_POLYGON_SPEED_LIMIT, 6.0, -1.0, 14.0, 4.0)->value = 1e-6F;
    TEST_ASSERT_EQUAL(AISLE_OK, send_world());
    expect_cause(AISLE_STATUS_LIMIT, 0, 2.0, 1.5, 18.0, 1.5);
    expect_path(15.0, 1.5, 18.0, 1.5);
}

static void test_a_mission_under_way_is_withdrawn_when_a_zone_turns_against_it(void) {
    aisle_goal_list_msg goals = door_goals(1, 18.0, 1.5);
    aisle_pose_msg pose = door_pose(2.0, 1.5, 0.0);
    TEST_ASSERT_EQUAL(AISLE_OK, door_submit(AISLE_INPUT_POSE, &pose));
    TEST_ASSERT_EQUAL(AISLE_OK, door_submit(AISLE_INPUT_GOALS, &goals));
    door_settle();
    TEST_ASSERT_EQUAL(AISLE_PATH_OK, door_path.status);
    world(20.0, 3.0);
    add(AISLE_POLYGON_DIRECTED, 6.0, -1.0, 14.0, 4.0)->direction = (float)DOOR_PI;
    TEST_ASSERT_EQUAL(AISLE_OK, send_world());
    door_wait(200000, &pose);
    TEST_ASSERT_EQUAL(AISLE_PATH_NONE, door_path.status);
    TEST_ASSERT_EQUAL_INT16(AISLE_STATUS_NO_PATH, door_path.cause);
    TEST_ASSERT_EQUAL_INT32(41, door_path.cause_id);
    world(20.0, 3.0); // and goes on when it is gone
    TEST_ASSERT_EQUAL(AISLE_OK, send_world());
    door_wait(200000, &pose);
    TEST_ASSERT_EQUAL(AISLE_PATH_OK, door_path.status);
}

// ---- limits

static float *limit_of(aisle_vehicle_msg *msg, int i) {
    float *const members[] = {&msg->v_max,       &msg->v_reverse_max,   &msg->a_max,         &msg->d_max,
                              &msg->omega_max,   &msg->alpha_max,       &msg->lateral_a_max, &msg->curvature_max,
                              &msg->creep_speed, &msg->creep_clearance, &msg->mass,          &msg->rolling_resistance,
                              &msg->idle_power,  &msg->drive_efficiency};
    return members[i];
}

enum { LIMITS = 14 };

static void test_limits_that_are_none_are_refused_and_the_old_vehicle_drives_on(void) {
    const float bad[] = {-1.0F, (float)NAN, (float)INFINITY, -(float)INFINITY, 1e9F};
    for (int i = 0; i < LIMITS; i++) {
        for (size_t k = 0; k < sizeof bad / sizeof bad[0]; k++) {
            aisle_vehicle_msg msg = vehicle;
            msg.vehicle_revision = 2;
            *limit_of(&msg, i) = bad[k];
            TEST_ASSERT_EQUAL(AISLE_ERR_DATA, door_submit(AISLE_INPUT_VEHICLE, &msg));
            TEST_ASSERT_EQUAL_INT16(AISLE_STATUS_MALFORMED, status_now().cause);
            TEST_ASSERT_EQUAL_INT32(1, status_now().vehicle_revision);
        }
    }
    expect_path(2.0, 1.5, 18.0, 1.5);
}

static void test_a_limit_of_zero_is_its_default(void) {
    expect_path(2.0, 1.5, 18.0, 1.5);
    const float duration = door_reply.duration;
    aisle_vehicle_msg msg = vehicle;
    msg.vehicle_revision = 2;
    msg.v_max = 1.5F;
    msg.a_max = msg.d_max = 0.5F;
    TEST_ASSERT_EQUAL(AISLE_OK, door_submit(AISLE_INPUT_VEHICLE, &msg));
    door_settle();
    expect_path(2.0, 1.5, 18.0, 1.5);
    TEST_ASSERT_TRUE(door_reply.duration >= duration && door_reply.duration <= duration);
}

// Each limit so small that nothing can move, or so large that it is none: a right path or a cause that is not the
// planner's failure.
static void test_the_least_and_largest_limits_give_a_right_path_or_a_cause(void) {
    const float extreme[] = {1e-30F, 1e-9F, 1e-4F, 19.0F, 1e6F};
    for (int i = 0; i < LIMITS; i++) {
        for (size_t k = 0; k < sizeof extreme / sizeof extreme[0]; k++) {
            aisle_vehicle_msg msg = vehicle;
            static int32_t revision = 2;
            msg.vehicle_revision = ++revision;
            *limit_of(&msg, i) = extreme[k];
            if (door_submit(AISLE_INPUT_VEHICLE, &msg) != AISLE_OK) {
                TEST_ASSERT_EQUAL_INT16(AISLE_STATUS_MALFORMED, status_now().cause);
                continue;
            }
            door_settle();
            const aisle_path_msg *path = ask(2.0, 1.0, 18.0, 2.0);
            if (path->status == AISLE_PATH_OK) {
                (void)door_judge(path);
            } else {
                TEST_ASSERT_NOT_EQUAL(AISLE_STATUS_INTERNAL, path->cause);
                TEST_ASSERT_NOT_EQUAL(AISLE_STATUS_VERIFY_FAILED, path->cause);
                TEST_ASSERT_NOT_EQUAL(0, path->cause);
            }
        }
    }
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_zones_with_values_that_are_none_are_refused_by_id_and_the_old_hall_stays);
    RUN_TEST(test_zones_that_contradict_each_other_are_taken_and_told_as_the_cause);
    RUN_TEST(test_the_slowest_of_contradicting_limits_holds);
    RUN_TEST(test_a_keepout_over_a_stop_is_told_by_id);
    RUN_TEST(test_a_zone_so_slow_that_a_path_would_last_too_long_is_a_limit);
    RUN_TEST(test_a_mission_under_way_is_withdrawn_when_a_zone_turns_against_it);
    RUN_TEST(test_limits_that_are_none_are_refused_and_the_old_vehicle_drives_on);
    RUN_TEST(test_a_limit_of_zero_is_its_default);
    RUN_TEST(test_the_least_and_largest_limits_give_a_right_path_or_a_cause);
    return UNITY_END();
}
