// The whole daemon on liblcm's in-process bus, the client speaking through lcm-gen's own C code: layout, query and
// goal list in;
// answers, path with its lease, status and diag out.
#include "daemon/loop.h"

#include "unity.h"

#include <lcm/lcm.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <aisle_diag_t.h>
#include <aisle_goal_list_t.h>
#include <aisle_layout_t.h>
#include <aisle_path_t.h>
#include <aisle_pose_t.h>
#include <aisle_query_t.h>
#include <aisle_status_t.h>

enum { RING = 1 << 20 };

static uint64_t ring[RING / 8];
static aisle_settings settings;
static aisle_inbox inbox;
static aisle_bus bus;
static aisle_clock host_clock;
static aisle_notify notify;
static aisle_loop loop;
static void *block;
static int64_t monotonic;

static int num_status, num_diag, num_paths, num_replies;
static aisle_status_t status;
static aisle_path_t path, reply; // decoded by lcm-gen's code; owned until the next one

static int64_t read_monotonic(void *ctx) {
    (void)ctx;
    return monotonic++;
}
static int64_t read_real(void *ctx) {
    (void)ctx;
    return 1700000000000000 + monotonic;
}

static void take_path(const lcm_recv_buf_t *r, aisle_path_t *into) {
    (void)aisle_path_t_decode_cleanup(into);
    memset(into, 0, sizeof *into);
    TEST_ASSERT_EQUAL((int)r->data_size, aisle_path_t_decode(r->data, 0, (int)r->data_size, into));
}
static void on_path(const lcm_recv_buf_t *r, const char *channel, void *user) {
    (void)channel, (void)user;
    take_path(r, &path);
    num_paths++;
}
static void on_reply(const lcm_recv_buf_t *r, const char *channel, void *user) {
    (void)channel, (void)user;
    take_path(r, &reply);
    num_replies++;
}
static void on_status(const lcm_recv_buf_t *r, const char *channel, void *user) {
    (void)channel, (void)user;
    TEST_ASSERT_EQUAL((int)r->data_size, aisle_status_t_decode(r->data, 0, (int)r->data_size, &status));
    num_status++;
}
static void on_diag(const lcm_recv_buf_t *r, const char *channel, void *user) {
    (void)r, (void)channel, (void)user;
    num_diag++;
}

static void open_bus(void) {
    aisle_inbox_init(&inbox, ring, sizeof ring);
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_bus_open(&bus, "memq://", "AISLE", &inbox));
    (void)lcm_subscribe(bus.lcm, "AISLE_PATH", on_path, NULL);
    (void)lcm_subscribe(bus.lcm, "AISLE_REPLY", on_reply, NULL);
    (void)lcm_subscribe(bus.lcm, "AISLE_STATUS", on_status, NULL);
    (void)lcm_subscribe(bus.lcm, "AISLE_DIAG", on_diag, NULL);
}

void setUp(void) {
    aisle_settings_defaults(&settings);
    aisle_config config = {
        .limits = {.cells = 262144, .polygons = 64, .vertices = 512, .open_nodes = 32768, .requests = 4},
        .boot_id = 42,
        .vehicle = {.footprint_radius = 0.3F, .margin = 0.1F},
        .has_vehicle = true};
    size_t size = aisle_planner_memsize(&config.limits);
    TEST_ASSERT_EQUAL(0, posix_memalign(&block, AISLE_PLANNER_ALIGN, size));
    aisle_planner *planner;
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_planner_init(block, size, &config, &planner));
    open_bus();
    monotonic = 1000000;
    num_status = num_diag = num_paths = num_replies = 0;
    aisle_clock_start(&host_clock, (aisle_clock_source){read_monotonic, read_real, read_monotonic, NULL});
    (void)aisle_notify_open(&notify, NULL, NULL, NULL);
    aisle_loop_init(&loop, &(aisle_loop_parts){.settings = &settings,
                                               .planner = planner,
                                               .arena_bytes = size,
                                               .bus = &bus,
                                               .clock = &host_clock,
                                               .notify = &notify,
                                               .stop_fd = -1});
}
void tearDown(void) {
    aisle_bus_close(&bus);
    (void)aisle_path_t_decode_cleanup(&path);
    (void)aisle_path_t_decode_cleanup(&reply);
    memset(&path, 0, sizeof path);
    memset(&reply, 0, sizeof reply);
    free(block);
}

static void turn_ms(int milliseconds) {
    for (int i = 0; i < milliseconds; i++) {
        monotonic += 1000;
        TEST_ASSERT_EQUAL(AISLE_LOOP_GOES_ON, aisle_loop_turn(&loop, 0));
    }
}

#define SEND(type, channel, msg)                                                                                       \
    do {                                                                                                               \
        static uint8_t bytes_[65000];                                                                                  \
        int size_ = type##_encode(bytes_, 0, (int)sizeof bytes_, msg);                                                 \
        TEST_ASSERT_TRUE(size_ > 0);                                                                                   \
        TEST_ASSERT_EQUAL(0, lcm_publish(bus.lcm, channel, bytes_, (unsigned int)size_));                              \
    } while (0)

// A hall of 10 x 6 m, empty.
static void send_layout(void) {
    aisle_layout_t layout = {.map_id = 1, .map_revision = 1, .num_parts = 1, .x_max = 10.0, .y_max = 6.0};
    SEND(aisle_layout_t, "AISLE_LAYOUT", &layout);
    turn_ms(50);
    TEST_ASSERT_EQUAL_INT32(1, status.map_id);
    TEST_ASSERT_EQUAL_INT8(AISLE_STATUS_T_IDLE, status.state);
}

static void send_pose(double x, double y) {
    static int32_t seq;
    aisle_pose_t pose = {
        .utime = 1700000000000000 + monotonic, .seq = ++seq, .map_id = 1, .x = x, .y = y, .localized = 1};
    SEND(aisle_pose_t, "AISLE_POSE", &pose);
}

static aisle_goal_t place(int32_t id, double x, double y) {
    return (aisle_goal_t){.id = id, .x = x, .y = y, .tolerance_theta = 4.0F};
}

static void test_a_query_is_answered_once_with_a_path_between_its_ends(void) {
    send_layout();
    aisle_goal_t goal = place(1, 9.0, 5.0);
    aisle_query_t query = {.query_id = 7, .map_id = 1, .start = place(0, 1.0, 1.0), .num_goals = 1, .goals = &goal};
    SEND(aisle_query_t, "AISLE_QUERY", &query);
    turn_ms(100);
    TEST_ASSERT_EQUAL_INT(1, num_replies);
    TEST_ASSERT_EQUAL_INT32(7, reply.query_id);
    TEST_ASSERT_EQUAL_INT8(AISLE_PATH_T_OK, reply.status);
    const aisle_waypoint_t *last = &reply.waypoints[reply.num_waypoints - 1];
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 9.0, last->x);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 5.0, last->y);
    TEST_ASSERT_FLOAT_WITHIN(0.01F, (float)hypot(8.0, 4.0), reply.length); // nothing in the way
}

static void test_a_goal_outside_is_refused_with_its_cause(void) {
    send_layout();
    aisle_goal_t goal = place(3, 12.0, 5.0);
    aisle_query_t query = {.query_id = 8, .map_id = 1, .start = place(0, 1.0, 1.0), .num_goals = 1, .goals = &goal};
    SEND(aisle_query_t, "AISLE_QUERY", &query);
    turn_ms(20);
    TEST_ASSERT_EQUAL_INT8(AISLE_PATH_T_NONE, reply.status);
    TEST_ASSERT_EQUAL_INT16(AISLE_STATUS_T_GOAL_OUTSIDE, reply.cause);
    TEST_ASSERT_EQUAL_INT32(3, reply.cause_id);
}

static void test_a_goal_list_is_driven_under_a_lease_that_ends_with_the_poses(void) {
    send_layout();
    send_pose(1.0, 1.0);
    turn_ms(2);
    aisle_goal_t goal = place(1, 9.0, 5.0);
    aisle_goal_list_t goals = {.goal_list_id = 5, .goal_list_revision = 1, .map_id = 1, .num_goals = 1, .goals = &goal};
    SEND(aisle_goal_list_t, "AISLE_GOALS", &goals);
    for (int i = 0; i < 30; i++) { // three seconds of poses at 10 Hz
        turn_ms(100);
        send_pose(1.0, 1.0);
    }
    TEST_ASSERT_EQUAL_INT8(AISLE_PATH_T_OK, path.status);
    TEST_ASSERT_EQUAL_INT32(5, path.goal_list_id);
    TEST_ASSERT_EQUAL_INT8(AISLE_STATUS_T_ACTIVE, status.state);
    TEST_ASSERT_TRUE(num_paths >= 6 && num_paths <= 9); // every half second, and the improvement
    TEST_ASSERT_EQUAL_INT64(1000000, path.valid_until_utime - path.utime);
    TEST_ASSERT_TRUE(num_status >= 15 && num_diag >= 3);
    turn_ms(300); // the poses end
    int sent = num_paths;
    turn_ms(2000);
    TEST_ASSERT_EQUAL_INT(sent, num_paths);
    TEST_ASSERT_EQUAL_INT8(AISLE_STATUS_T_BLOCKED, status.state);
    TEST_ASSERT_EQUAL_INT16(AISLE_STATUS_T_POSE_STALE, status.cause);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_a_query_is_answered_once_with_a_path_between_its_ends);
    RUN_TEST(test_a_goal_outside_is_refused_with_its_cause);
    RUN_TEST(test_a_goal_list_is_driven_under_a_lease_that_ends_with_the_poses);
    return UNITY_END();
}
