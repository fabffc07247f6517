#include "daemon/loop.h" // first: proves that the header stands alone

#include "fake_planner.h"
#include "messages.h"
#include "unity.h"

#include <lcm/lcm.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

static uint64_t ring[1000000 / 8], block[FAKE_MEMSIZE / 8];
static aisle_settings settings;
static aisle_inbox inbox;
static aisle_bus bus;
static aisle_clock host_clock;
static aisle_notify notify;
static aisle_loop loop;
static aisle_planner *planner;
static int64_t monotonic, real_offset, processor;

// What came out.
static aisle_status_msg status;
static aisle_diag_msg diag;
static aisle_path_msg paths[200];
static bool is_reply[200];
static int num_status, num_diag, num_paths;

static int64_t read_monotonic(void *ctx) {
    (void)ctx;
    return monotonic++; // every look takes a microsecond
}
static int64_t read_real(void *ctx) {
    (void)ctx;
    return 1700000000000000 + monotonic + real_offset;
}
static int64_t read_processor(void *ctx) {
    (void)ctx;
    return processor;
}
static void on_status(const lcm_recv_buf_t *r, const char *channel, void *user) {
    (void)channel, (void)user;
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_msg_decode(AISLE_MSG_STATUS, r->data, r->data_size, &status, NULL));
    num_status++;
}
static void on_diag(const lcm_recv_buf_t *r, const char *channel, void *user) {
    (void)channel, (void)user;
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_msg_decode(AISLE_MSG_DIAG, r->data, r->data_size, &diag, NULL));
    num_diag++;
}
static void on_path(const lcm_recv_buf_t *r, const char *channel, void *user) {
    (void)user;
    TEST_ASSERT_TRUE(num_paths < 200);
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_msg_decode(AISLE_MSG_PATH, r->data, r->data_size, &paths[num_paths], NULL));
    is_reply[num_paths++] = strcmp(channel, "T_REPLY") == 0;
}

// Each work unit takes a microsecond.
static void work_takes_time(uint32_t units) {
    monotonic += units;
    processor += units;
}

void setUp(void) {
    fake_reset();
    fake.give_paths = true;
    fake.on_step = work_takes_time;
    aisle_settings_defaults(&settings);
    aisle_config config = {.boot_id = 42};
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_planner_init(block, sizeof block, &config, &planner));
    aisle_inbox_init(&inbox, ring, sizeof ring);
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_bus_open(&bus, "memq://", "T", &inbox));
    lcm_subscription_t *s[] = {lcm_subscribe(bus.lcm, "T_STATUS", on_status, NULL),
                               lcm_subscribe(bus.lcm, "T_DIAG", on_diag, NULL),
                               lcm_subscribe(bus.lcm, "T_(PATH|REPLY)", on_path, NULL)};
    for (int i = 0; i < 3; i++) {
        TEST_ASSERT_EQUAL(0, lcm_subscription_set_queue_capacity(s[i], 0));
    }
    monotonic = 1000000;
    real_offset = 0;
    num_status = num_diag = num_paths = 0;
    aisle_clock_start(&host_clock, (aisle_clock_source){read_monotonic, read_real, read_processor, NULL});
    (void)aisle_notify_open(&notify, NULL, NULL, NULL);
    aisle_loop_init(&loop, &(aisle_loop_parts){.settings = &settings,
                                               .planner = planner,
                                               .arena_bytes = FAKE_MEMSIZE,
                                               .bus = &bus,
                                               .clock = &host_clock,
                                               .notify = &notify,
                                               .stop_fd = -1});
    TEST_ASSERT_EQUAL(AISLE_LOOP_GOES_ON, aisle_loop_turn(&loop, 0));
}
void tearDown(void) {
    aisle_bus_close(&bus);
}

static void send_to(aisle_channel channel, int32_t id) {
    const test_message *m = make_message(channel, id);
    TEST_ASSERT_EQUAL(0, lcm_publish(bus.lcm, bus.names[channel], m->bytes, (unsigned int)m->size));
}
static void send_junk(aisle_channel channel) {
    TEST_ASSERT_EQUAL(0, lcm_publish(bus.lcm, bus.names[channel], "junk", 4));
}
static void turn(int times) {
    for (int i = 0; i < times; i++) {
        TEST_ASSERT_EQUAL(AISLE_LOOP_GOES_ON, aisle_loop_turn(&loop, 0));
    }
}
// Turns with the clock running a millisecond each.
static void turn_ms(int milliseconds) {
    for (int i = 0; i < milliseconds; i++) {
        monotonic += 1000;
        turn(1);
    }
}
static int64_t counter(int id) {
    for (int i = 0; i < diag.num_counters; i++) {
        if (diag.counter_id[i] == id) {
            return diag.counter[i];
        }
    }
    TEST_FAIL_MESSAGE("no such counter");
    return -1;
}

static void test_first_turn_sends_status_and_diag(void) {
    turn(1); // hears them
    TEST_ASSERT_EQUAL(1, num_status);
    TEST_ASSERT_EQUAL(1, num_diag);
    TEST_ASSERT_EQUAL_INT64(42, status.boot_id);
    TEST_ASSERT_EQUAL_INT32(1, status.seq);
    TEST_ASSERT_EQUAL_INT64(42, diag.boot_id);
}
static void test_status_and_diag_keep_their_rates(void) {
    turn_ms(10000);
    TEST_ASSERT_INT_WITHIN(1, 51, num_status);
    TEST_ASSERT_INT_WITHIN(1, 11, num_diag);
    TEST_ASSERT_EQUAL_INT32(num_status, status.seq);
    TEST_ASSERT_INT64_WITHIN(300000, 10000000, status.uptime);
}
static void test_status_keeps_its_rate_while_planning(void) {
    fake.units_per_request = 10000000; // ten seconds of work
    send_to(AISLE_CHANNEL_QUERY, 1);
    int64_t start = monotonic;
    while (num_paths == 0) {
        turn(1);
    }
    int64_t took = monotonic - start;
    TEST_ASSERT_TRUE(took >= 10000000 && took < 11000000);
    TEST_ASSERT_INT_WITHIN(2, 51, num_status);
    TEST_ASSERT_INT_WITHIN(2, 11, num_diag);
    TEST_ASSERT_TRUE(loop.slice >= 500 && loop.slice <= 1000); // about 1 ms at a unit per microsecond
}
static uint32_t units_per_us, us_per_unit;
static void work_takes_its_time(uint32_t units) {
    monotonic += units * us_per_unit / units_per_us;
    processor += units * us_per_unit / units_per_us;
}
static void pass_turns_at(uint32_t units, uint32_t us, int turns) {
    fake.on_step = work_takes_its_time;
    units_per_us = units;
    us_per_unit = us;
    turn(turns);
}
static void test_slice_follows_the_speed_of_the_host_both_ways(void) {
    static const uint32_t speeds[][2] = {{1, 10}, {50, 1}, {1, 1}}; // units per us, us per unit
    static const uint32_t bounds[][2] = {{80, 100}, {40000, 51000}, {900, 1000}};
    fake.units_per_request = 1000000000;
    send_to(AISLE_CHANNEL_QUERY, 1);
    for (int i = 0; i < 3; i++) {
        pass_turns_at(speeds[i][0], speeds[i][1], 250);
        TEST_ASSERT_TRUE(loop.slice >= bounds[i][0] && loop.slice <= bounds[i][1]);
    }
}
static void test_slices_that_end_early_do_not_stretch_the_next(void) {
    fake.units_per_request = 20;
    fake.on_step = NULL; // so quick that they take no time at all
    for (int32_t i = 0; i < 100; i++) {
        send_to(AISLE_CHANNEL_QUERY, i);
        turn(3);
    }
    TEST_ASSERT_EQUAL(100, num_paths);
    TEST_ASSERT_TRUE(loop.slice <= 512);
}
static void test_slice_goes_by_the_slowest_work_of_late(void) {
    fake.units_per_request = 1000000000;
    send_to(AISLE_CHANNEL_QUERY, 1);
    pass_turns_at(10, 1, 200);
    TEST_ASSERT_TRUE(loop.slice >= 9000);
    pass_turns_at(1, 1, 1); // one slice may be too long, the next is not
    TEST_ASSERT_TRUE(loop.slice <= 1000);
    pass_turns_at(10, 1, 5); // quicker work: not trusted at once
    TEST_ASSERT_TRUE(loop.slice <= 1250);
}
static void others_have_the_processor(uint32_t units) {
    monotonic += units * 10U;
    processor += units;
}
static void test_slice_is_not_cut_short_by_what_others_do_on_the_host(void) {
    fake.units_per_request = 1000000000;
    fake.on_step = others_have_the_processor;
    send_to(AISLE_CHANNEL_QUERY, 1);
    turn(50);
    TEST_ASSERT_TRUE(loop.slice >= 900);
}
static void test_fixed_slice_stays_as_set(void) {
    settings.work_units_per_slice = 77;
    aisle_loop_parts parts = loop.parts;
    aisle_loop_init(&loop, &parts);
    fake.units_per_request = 770;
    send_to(AISLE_CHANNEL_QUERY, 1);
    uint32_t before = fake.steps;
    while (num_paths == 0) {
        turn(1);
    }
    TEST_ASSERT_INT_WITHIN(2, 11, (int)(fake.steps - before));
}
static void test_status_is_sent_on_change_but_not_in_a_burst(void) {
    turn_ms(1100); // between two heartbeats
    int before = num_status;
    fake.status.state = AISLE_STATUS_PLANNING;
    turn_ms(3);
    TEST_ASSERT_EQUAL(before + 1, num_status);
    TEST_ASSERT_EQUAL(AISLE_STATUS_PLANNING, status.state);
    for (int i = 0; i < 100; i++) { // changes every millisecond
        fake.status.map_revision++;
        turn_ms(1);
    }
    TEST_ASSERT_TRUE(num_status - before <= 8);
}
static void test_messages_reach_the_planner_in_order_and_outputs_their_channels(void) {
    send_to(AISLE_CHANNEL_LAYOUT, 0);
    send_to(AISLE_CHANNEL_QUERY, 11);
    send_to(AISLE_CHANNEL_GOALS, 12);
    send_to(AISLE_CHANNEL_COMMAND, 13);
    send_to(AISLE_CHANNEL_QUERY, 14);
    turn_ms(20);
    static const int32_t ids[] = {0, 11, 12, 13, 14};
    TEST_ASSERT_EQUAL_UINT32(5, fake.num_taken);
    for (int i = 0; i < 5; i++) {
        TEST_ASSERT_EQUAL_INT32(ids[i], fake.taken[i].id);
    }
    TEST_ASSERT_EQUAL(3, num_paths);
    TEST_ASSERT_TRUE(is_reply[0] && !is_reply[1] && is_reply[2]);
    TEST_ASSERT_EQUAL_INT32(11, paths[0].query_id);
    TEST_ASSERT_EQUAL_INT32(12, paths[1].goal_list_id);
    TEST_ASSERT_EQUAL_INT32(14 * 7, paths[2].certificate);
    TEST_ASSERT_EQUAL(2, paths[2].num_waypoints);
}
static void test_busy_planner_loses_no_request_and_keeps_their_order(void) {
    fake.requests_max = 2;
    fake.units_per_request = 5000;
    for (int32_t i = 0; i < 50; i++) {
        send_to(AISLE_CHANNEL_QUERY, i);
    }
    turn_ms(1000);
    TEST_ASSERT_EQUAL(50, num_paths);
    for (int32_t i = 0; i < 50; i++) {
        TEST_ASSERT_EQUAL_INT32(i, paths[i].query_id);
    }
}
static void test_layout_waits_for_the_requests_before_it(void) {
    fake.units_per_request = 10000;
    send_to(AISLE_CHANNEL_QUERY, 1);
    send_to(AISLE_CHANNEL_QUERY, 2);
    send_to(AISLE_CHANNEL_LAYOUT, 3);
    send_to(AISLE_CHANNEL_QUERY, 4);
    turn_ms(200);
    TEST_ASSERT_EQUAL(3, num_paths);
    TEST_ASSERT_EQUAL_UINT32(4, fake.num_taken);
    TEST_ASSERT_EQUAL(AISLE_INPUT_LAYOUT, fake.taken[2].kind);
    // Taken after both queries were answered: two requests of 10000 us of work lie between.
    TEST_ASSERT_TRUE(fake.taken[2].now_us - fake.taken[1].now_us >= 19000);
}
static void test_layout_that_takes_effect_holds_up_what_starts_from_the_pose_but_no_command(void) {
    fake.units_per_layout = 50000;
    send_to(AISLE_CHANNEL_LAYOUT, 1);
    turn(2);
    send_to(AISLE_CHANNEL_COMMAND, 2);
    send_to(AISLE_CHANNEL_POSE, 3);
    send_to(AISLE_CHANNEL_GOALS, 4);
    send_to(AISLE_CHANNEL_LAYOUT, 5);
    turn(3);
    TEST_ASSERT_EQUAL_UINT32(2, fake.num_taken);
    TEST_ASSERT_EQUAL(AISLE_INPUT_COMMAND, fake.taken[1].kind);
    turn_ms(100);
    TEST_ASSERT_EQUAL_UINT32(5, fake.num_taken);
    for (int32_t i = 2; i < 5; i++) {
        TEST_ASSERT_EQUAL_INT32(i + 1, fake.taken[i].id);
    }
    TEST_ASSERT_TRUE(fake.taken[2].now_us - fake.taken[0].now_us >= 45000);
}
static void test_fresh_pose_is_not_held_up_by_waiting_queries(void) {
    fake.requests_max = 1;
    fake.units_per_request = 1000000;
    for (int32_t i = 0; i < 5; i++) {
        send_to(AISLE_CHANNEL_QUERY, i);
    }
    turn(3);
    send_to(AISLE_CHANNEL_POSE, 900);
    turn(3);
    TEST_ASSERT_EQUAL(0, num_paths);
    TEST_ASSERT_EQUAL_UINT32(2, fake.num_taken);
    TEST_ASSERT_EQUAL(AISLE_INPUT_POSE, fake.taken[1].kind);
}
static void test_planning_time_is_the_work_of_that_answer_and_stays_in_renewals(void) {
    fake.units_per_request = 30000;
    fake.lease_us = 500000;
    send_to(AISLE_CHANNEL_QUERY, 1);
    send_to(AISLE_CHANNEL_GOALS, 2);
    turn_ms(1200);
    TEST_ASSERT_TRUE(num_paths >= 4);
    TEST_ASSERT_FLOAT_WITHIN(0.004F, 0.030F, paths[0].planning_time);
    TEST_ASSERT_FLOAT_WITHIN(0.004F, 0.030F, paths[1].planning_time);
    for (int i = 2; i < num_paths; i++) {
        TEST_ASSERT_FLOAT_WITHIN(1e-9F, paths[1].planning_time, paths[i].planning_time);
        TEST_ASSERT_EQUAL_INT32(paths[1].path_revision, paths[i].path_revision);
        TEST_ASSERT_INT64_WITHIN(5000, 500000, paths[i].utime - paths[i - 1].utime);
    }
}
// A pose while a long search is in hand; the host received it so many ms ago.
static void ask_for_a_cycle(int32_t seq, int64_t ms_ago) {
    send_to(AISLE_CHANNEL_POSE, seq);
    struct timespec t;
    TEST_ASSERT_EQUAL(0, clock_gettime(CLOCK_REALTIME, &t));
    real_offset = (int64_t)t.tv_sec * 1000000 + t.tv_nsec / 1000 + 1000 * ms_ago - 1700000000000000 - monotonic;
}
static float timer_ms(const float *of, aisle_timer which) {
    return 1000.0F * of[which];
}
static void half_the_processor_is_ours(uint32_t units) {
    monotonic += 2U * units;
    processor += units;
}
static void test_cycles_and_answers_are_timed_from_when_the_host_had_the_message(void) {
    fake.units_per_request = 1000000000;
    fake.units_per_cycle = 2000;
    fake.on_step = half_the_processor_is_ours;
    send_to(AISLE_CHANNEL_GOALS, 1);
    turn(20);
    for (int i = 0; i < 9; i++) { // keep the path
        ask_for_a_cycle(i, 1);
        turn(10);
    }
    fake.cycle_changes = true;
    ask_for_a_cycle(90, 50); // was long on its way
    turn(10);
    fake.cycle_changes = false;
    fake.cycle_renews = true;
    ask_for_a_cycle(100, 1);
    turn(10);
    turn_ms(1100);
    TEST_ASSERT_EQUAL(2, num_paths);
    TEST_ASSERT_EQUAL(11, diag.timer_count[AISLE_TIMER_CYCLE]);
    TEST_ASSERT_EQUAL(1, diag.timer_count[AISLE_TIMER_ANSWER]);
    TEST_ASSERT_EQUAL(1, diag.timer_count[AISLE_TIMER_ANSWER_WORK]);
    // A cycle is two slices of 2 ms, and the search in hand gives way at once.
    TEST_ASSERT_FLOAT_WITHIN(1.0F, 5.5F, timer_ms(diag.timer_p50, AISLE_TIMER_CYCLE));
    TEST_ASSERT_FLOAT_WITHIN(1.0F, 54.5F, timer_ms(diag.timer_max, AISLE_TIMER_ANSWER));
    TEST_ASSERT_TRUE(timer_ms(diag.timer_max, AISLE_TIMER_CYCLE) <= timer_ms(diag.timer_max, AISLE_TIMER_ANSWER));
    TEST_ASSERT_FLOAT_WITHIN(0.2F, 2.0F, timer_ms(diag.timer_max, AISLE_TIMER_ANSWER_WORK));
}
static void test_renewals_and_answers_to_requests_are_no_answers_to_a_pose(void) {
    fake.lease_us = 200000;
    send_to(AISLE_CHANNEL_GOALS, 1);
    send_to(AISLE_CHANNEL_POSE, 5); // asks for no cycle
    turn_ms(1200);
    TEST_ASSERT_TRUE(num_paths >= 5);
    TEST_ASSERT_EQUAL(0, diag.timer_count[AISLE_TIMER_CYCLE]);
    TEST_ASSERT_EQUAL(0, diag.timer_count[AISLE_TIMER_ANSWER]);
}
static void test_renewals_come_while_nothing_else_happens(void) {
    fake.lease_us = 500000;
    send_to(AISLE_CHANNEL_GOALS, 2);
    turn_ms(5250);
    TEST_ASSERT_INT_WITHIN(1, 11, num_paths);
}
static void test_malformed_message_is_counted_and_told_for_a_second(void) {
    fake.status.cause = AISLE_STATUS_NO_POSE;
    fake.status.num_rejected = 7;
    send_junk(AISLE_CHANNEL_GOALS);
    turn_ms(210);
    TEST_ASSERT_EQUAL_INT16(AISLE_STATUS_MALFORMED, status.cause);
    TEST_ASSERT_EQUAL_INT32(AISLE_CAUSE_ID_MESSAGE + AISLE_CHANNEL_GOALS, status.cause_id);
    TEST_ASSERT_EQUAL_INT32(8, status.num_rejected);
    turn_ms(1200);
    TEST_ASSERT_EQUAL_INT16(AISLE_STATUS_NO_POSE, status.cause);
    TEST_ASSERT_EQUAL_INT64(1, counter(AISLE_DAEMON_MALFORMED));
    TEST_ASSERT_EQUAL_UINT32(0, fake.num_taken);
}
static void test_count_over_its_bound_is_a_limit(void) {
    test_message m = *make_message(AISLE_CHANNEL_GOALS, 1);
    m.bytes[m.size - 1] = 65; // num_goals
    TEST_ASSERT_EQUAL(0, lcm_publish(bus.lcm, "T_GOALS", m.bytes, (unsigned int)m.size));
    turn_ms(1100);
    TEST_ASSERT_EQUAL_INT64(1, counter(AISLE_DAEMON_OVER_LIMIT));
    TEST_ASSERT_EQUAL_INT16(AISLE_STATUS_LIMIT, loop.fault_cause);
    TEST_ASSERT_EQUAL_INT32(AISLE_CAUSE_ID_MESSAGE + AISLE_CHANNEL_GOALS, loop.fault_id);
}
static void test_overflow_of_the_queue_is_told_and_counted(void) {
    static uint8_t big[60000];
    for (int i = 0; i < 40; i++) {
        TEST_ASSERT_EQUAL(0, lcm_publish(bus.lcm, "T_GRID", big, sizeof big));
    }
    turn_ms(210);
    TEST_ASSERT_EQUAL_INT16(AISLE_STATUS_MALFORMED, status.cause); // the later fault: what came in was junk
    TEST_ASSERT_EQUAL_INT32(40, status.num_rejected);
    turn_ms(1000);
    TEST_ASSERT_TRUE(counter(AISLE_DAEMON_DROPPED) > 0);
    TEST_ASSERT_EQUAL_INT64(40, counter(AISLE_DAEMON_DROPPED) + counter(AISLE_DAEMON_MALFORMED));
    TEST_ASSERT_EQUAL_INT64(40, counter(AISLE_DAEMON_RECEIVED));
    TEST_ASSERT_TRUE(counter(AISLE_DAEMON_QUEUE_MAX) > 900000);
}
static void test_full_queue_shows_as_limit_while_requests_wait(void) {
    static uint8_t big[60000];
    fake.units_per_request = 100000000;
    send_to(AISLE_CHANNEL_QUERY, 1);
    for (int i = 0; i < 40; i++) {
        TEST_ASSERT_EQUAL(0, lcm_publish(bus.lcm, "T_GRID", big, sizeof big));
    }
    turn_ms(210);
    TEST_ASSERT_EQUAL_INT16(AISLE_STATUS_LIMIT, status.cause);
    TEST_ASSERT_EQUAL_INT32(AISLE_CAUSE_ID_QUEUE + AISLE_CHANNEL_GRID, status.cause_id);
}
static void test_planner_that_never_takes_a_message_does_not_hang_the_loop(void) {
    fake.busy_always = true;
    send_to(AISLE_CHANNEL_QUERY, 1);
    send_to(AISLE_CHANNEL_LAYOUT, 1);
    turn_ms(10);
    TEST_ASSERT_EQUAL_INT16(AISLE_STATUS_INTERNAL, loop.fault_cause);
    TEST_ASSERT_EQUAL_INT64(2, loop.stuck);
    fake.busy_always = false;
    send_to(AISLE_CHANNEL_QUERY, 2);
    turn_ms(10);
    TEST_ASSERT_EQUAL(1, num_paths);
}
static void test_clock_set_back_is_counted_and_told_and_utime_goes_on(void) {
    turn_ms(300);
    int64_t before = status.utime;
    real_offset = -3600000000;
    turn_ms(1500);
    TEST_ASSERT_EQUAL_INT16(AISLE_STATUS_CLOCK_JUMP, status.cause);
    TEST_ASSERT_TRUE(status.utime > before && status.utime - before < 2000000);
    TEST_ASSERT_EQUAL_INT64(1, counter(AISLE_DAEMON_CLOCK_JUMPS));
}
static void test_diag_tells_timers_memory_and_all_counters(void) {
    fake.units_per_request = 5000;
    send_to(AISLE_CHANNEL_QUERY, 1);
    turn_ms(1100);
    TEST_ASSERT_EQUAL(AISLE_TIMER_COUNT, diag.num_timers);
    TEST_ASSERT_EQUAL(1, diag.timer_count[AISLE_TIMER_REQUEST]);
    TEST_ASSERT_FLOAT_WITHIN(0.003F, 0.005F, diag.timer_max[AISLE_TIMER_REQUEST]);
    for (int i = 0; i < diag.num_timers; i++) {
        TEST_ASSERT_TRUE(diag.timer_p50[i] <= diag.timer_p99[i] && diag.timer_p99[i] <= diag.timer_max[i]);
    }
    TEST_ASSERT_EQUAL(AISLE_COUNTER_COUNT + AISLE_DAEMON_COUNTER_END - AISLE_DAEMON_RECEIVED, diag.num_counters);
    TEST_ASSERT_EQUAL_INT64(1, counter(AISLE_COUNTER_INPUTS));
    TEST_ASSERT_EQUAL_INT64(5000, counter(AISLE_COUNTER_WORK_UNITS));
    TEST_ASSERT_EQUAL_INT64(FAKE_MEMSIZE, diag.arena_bytes);
    TEST_ASSERT_EQUAL_INT64(100 + 192, diag.arena_used_max);
    TEST_ASSERT_TRUE(diag.rss_bytes > 1000000 && diag.rss_bytes < 2000000000);
}

// ---- watchdog and stop, with a real socket and a real pipe

static int listen_as_systemd(char *name, size_t size) {
    struct sockaddr_un address = {.sun_family = AF_UNIX};
    int n = snprintf(name, size, "@aisle_test_loop_%ld", (long)getpid());
    memcpy(address.sun_path + 1, name + 1, (size_t)n - 1);
    int fd = socket(AF_UNIX, SOCK_DGRAM, 0);
    socklen_t length = (socklen_t)(offsetof(struct sockaddr_un, sun_path) + (size_t)n);
    TEST_ASSERT_EQUAL(0, bind(fd, (const struct sockaddr *)&address, length));
    return fd;
}
static int count_received(int fd, const char *text) {
    char got[64];
    int count = 0;
    for (ssize_t n = 0; (n = recv(fd, got, sizeof got - 1, MSG_DONTWAIT)) > 0;) {
        got[n] = '\0';
        count += strcmp(got, text) == 0 ? 1 : 0;
    }
    return count;
}
static void test_watchdog_is_pinged_while_idle_and_while_planning_but_not_when_hung(void) {
    char name[64];
    int fd = listen_as_systemd(name, sizeof name);
    TEST_ASSERT_TRUE(aisle_notify_open(&notify, name, "1000000", NULL));
    turn_ms(2000);
    TEST_ASSERT_INT_WITHIN(1, 4, count_received(fd, "WATCHDOG=1"));
    fake.units_per_request = 100000000;
    send_to(AISLE_CHANNEL_QUERY, 1);
    turn_ms(1000);
    TEST_ASSERT_TRUE(count_received(fd, "WATCHDOG=1") > 1);
    fake.hang = true;
    turn_ms(600);
    (void)count_received(fd, "WATCHDOG=1");
    turn_ms(3000);
    TEST_ASSERT_EQUAL(0, count_received(fd, "WATCHDOG=1"));
    aisle_notify_close(&notify);
    (void)close(fd);
}
static void test_stop_ends_with_a_last_status_and_tells_systemd(void) {
    char name[64];
    int fd = listen_as_systemd(name, sizeof name), stop[2];
    TEST_ASSERT_EQUAL(0, pipe(stop));
    TEST_ASSERT_TRUE(aisle_notify_open(&notify, name, NULL, NULL));
    loop.parts.stop_fd = stop[0];
    TEST_ASSERT_EQUAL(1, write(stop[1], "", 1));
    fake.status.map_id = 77;
    TEST_ASSERT_EQUAL(AISLE_LOOP_STOPPED, aisle_loop_run(&loop));
    char got[2][32];
    for (int i = 0; i < 2; i++) {
        ssize_t n = recv(fd, got[i], sizeof got[i] - 1, MSG_DONTWAIT);
        got[i][n > 0 ? n : 0] = '\0';
    }
    TEST_ASSERT_EQUAL_STRING("READY=1", got[0]);
    TEST_ASSERT_EQUAL_STRING("STOPPING=1", got[1]);
    TEST_ASSERT_TRUE(aisle_bus_drain(&bus) > 0);
    TEST_ASSERT_EQUAL_INT32(77, status.map_id);
    aisle_notify_close(&notify);
    (void)close(fd);
    (void)close(stop[0]);
    (void)close(stop[1]);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_first_turn_sends_status_and_diag);
    RUN_TEST(test_status_and_diag_keep_their_rates);
    RUN_TEST(test_status_keeps_its_rate_while_planning);
    RUN_TEST(test_slice_follows_the_speed_of_the_host_both_ways);
    RUN_TEST(test_slices_that_end_early_do_not_stretch_the_next);
    RUN_TEST(test_slice_goes_by_the_slowest_work_of_late);
    RUN_TEST(test_slice_is_not_cut_short_by_what_others_do_on_the_host);
    RUN_TEST(test_fixed_slice_stays_as_set);
    RUN_TEST(test_status_is_sent_on_change_but_not_in_a_burst);
    RUN_TEST(test_messages_reach_the_planner_in_order_and_outputs_their_channels);
    RUN_TEST(test_busy_planner_loses_no_request_and_keeps_their_order);
    RUN_TEST(test_layout_waits_for_the_requests_before_it);
    RUN_TEST(test_layout_that_takes_effect_holds_up_what_starts_from_the_pose_but_no_command);
    RUN_TEST(test_fresh_pose_is_not_held_up_by_waiting_queries);
    RUN_TEST(test_planning_time_is_the_work_of_that_answer_and_stays_in_renewals);
    RUN_TEST(test_cycles_and_answers_are_timed_from_when_the_host_had_the_message);
    RUN_TEST(test_renewals_and_answers_to_requests_are_no_answers_to_a_pose);
    RUN_TEST(test_renewals_come_while_nothing_else_happens);
    RUN_TEST(test_malformed_message_is_counted_and_told_for_a_second);
    RUN_TEST(test_count_over_its_bound_is_a_limit);
    RUN_TEST(test_overflow_of_the_queue_is_told_and_counted);
    RUN_TEST(test_full_queue_shows_as_limit_while_requests_wait);
    RUN_TEST(test_planner_that_never_takes_a_message_does_not_hang_the_loop);
    RUN_TEST(test_clock_set_back_is_counted_and_told_and_utime_goes_on);
    RUN_TEST(test_diag_tells_timers_memory_and_all_counters);
    RUN_TEST(test_watchdog_is_pinged_while_idle_and_while_planning_but_not_when_hung);
    RUN_TEST(test_stop_ends_with_a_last_status_and_tells_systemd);
    return UNITY_END();
}
