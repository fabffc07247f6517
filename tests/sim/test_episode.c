#include "sim/episode.h" // first: proves that the header stands alone

#include "hall.h"
#include "replay/check.h"
#include "sim/report.h"

#include <stdlib.h>

static aisle_settings settings;
static aisle_sim_host host;
static aisle_sim_episode episode;
static aisle_vehicle_msg vehicle;
static aisle_goal_list_msg goals;
static aisle_pose_msg pose;
static char message[AISLE_SETTINGS_MESSAGE_LEN];

void setUp(void) {
    aisle_settings_defaults(&settings);
    settings.limits = (aisle_limits){.cells = 262144, .polygons = 64, .vertices = 512, .open_nodes = 65536};
    hall_begin(12.0, 10.0);
    hall_add(5.0, 0.0, 6.0, 6.0);
    hall_layout.crc32 = (int32_t)aisle_layout_crc32(0, &hall_layout);
    vehicle = (aisle_vehicle_msg){.vehicle_revision = 1};
    pose = (aisle_pose_msg){.map_id = 1, .x = 2.0, .y = 2.0, .localized = 1};
    goals = (aisle_goal_list_msg){.goal_list_id = 1,
                                  .goal_list_revision = 1,
                                  .map_id = 1,
                                  .num_goals = 1,
                                  .goals = {{.id = 5, .x = 9.0, .y = 2.0, .tolerance_theta = 4.0F}}};
}
void tearDown(void) {}

static void prepare(aisle_channel channel, const void *msg) {
    static uint8_t bytes[AISLE_MSG_DATAGRAM_MAX];
    size_t size = 0;
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_msg_encode(aisle_channel_type(channel), msg, bytes, sizeof bytes, &size));
    TEST_ASSERT_TRUE(aisle_sim_episode_prepare(&episode, channel, bytes, size));
}

static void start(const aisle_sim_setup *setup, FILE *log) {
    TEST_ASSERT_EQUAL(AISLE_OK,
                      aisle_sim_host_start_core(&host, &settings, log, aisle_sim_episode_hear, &episode, message));
    aisle_sim_episode_start(&episode, setup, &host);
}

static void run(const aisle_sim_setup *setup, FILE *log) {
    start(setup, log);
    prepare(AISLE_CHANNEL_LAYOUT, &hall_layout);
    prepare(AISLE_CHANNEL_VEHICLE, &vehicle);
    prepare(AISLE_CHANNEL_POSE, &pose);
    prepare(AISLE_CHANNEL_GOALS, &goals);
    TEST_ASSERT_TRUE_MESSAGE(aisle_sim_episode_run(&episode, message), message);
    aisle_sim_host_stop(&host);
    aisle_sim_episode_end(&episode);
}

static void test_an_empty_hall_is_crossed_on_time_for_20_of_20_seeds(void) {
    for (uint64_t seed = 0; seed < 20; seed++) {
        aisle_sim_setup setup = aisle_sim_setup_usual(seed);
        run(&setup, NULL);
        const aisle_sim_judge *judge = &episode.judge;
        TEST_ASSERT_TRUE(episode.arrived);
        TEST_ASSERT_EQUAL_INT64(0, judge->collisions + judge->static_collisions + judge->contacts_at_rest);
        TEST_ASSERT_EQUAL_INT64(0, episode.stops);
        TEST_ASSERT_TRUE(judge->static_gap > 0.02); // of a margin of 0.1 m, which noise may use
        double late = (judge->arrival - episode.goals_at) / episode.optimum;
        TEST_ASSERT_TRUE(late > 0.98 && late < 1.15);
    }
}

static size_t slurp(FILE *file, uint8_t **bytes) {
    long size = (fseek(file, 0, SEEK_END), ftell(file));
    *bytes = malloc((size_t)size);
    rewind(file);
    TEST_ASSERT_EQUAL_size_t((size_t)size, fread(*bytes, 1, (size_t)size, file));
    return (size_t)size;
}

static aisle_sim_setup crowd(uint64_t seed) {
    aisle_sim_setup setup = aisle_sim_setup_usual(seed);
    setup.num_groups = 2;
    setup.group[0] = (aisle_sim_group){.kind = AISLE_SIM_PERSON, .count = 3};
    setup.group[1] = (aisle_sim_group){.kind = AISLE_SIM_ADVERSARIAL, .count = 2};
    setup.time_limit = 20.0;
    setup.num_sources = 2;
    return setup;
}

static void test_a_seed_gives_the_same_log_and_another_one_another(void) {
    uint8_t *bytes[3];
    size_t size[3];
    for (int i = 0; i < 3; i++) {
        aisle_sim_setup setup = crowd(i < 2 ? 7 : 8);
        FILE *log = tmpfile();
        run(&setup, log);
        size[i] = slurp(log, &bytes[i]);
        (void)fclose(log);
    }
    TEST_ASSERT_EQUAL_size_t(size[0], size[1]);
    TEST_ASSERT_EQUAL_MEMORY(bytes[0], bytes[1], size[0]);
    TEST_ASSERT_TRUE(size[0] != size[2] || memcmp(bytes[0], bytes[2], size[0]) != 0);
    for (int i = 0; i < 3; i++) {
        free(bytes[i]);
    }
}

// ---- the log replays

static aisle_check check;

static void on_replayed(void *ctx, const aisle_replay_output *output) {
    (void)ctx;
    TEST_ASSERT_TRUE(output->renewal || aisle_check_made(&check, output->channel, output->bytes, output->size));
}

static void replay_event(aisle_replay *replay, const aisle_log_event *event) {
    aisle_channel channel = aisle_channel_find(settings.prefix, event->channel, event->channel_length);
    if ((int)channel < AISLE_CHANNEL_INPUTS) {
        aisle_replay_input(replay, event->utime, channel, event->bytes, event->size);
        return;
    }
    aisle_replay_advance(replay, event->utime);
    if (channel != AISLE_CHANNEL_STATUS) {
        aisle_check_recorded(&check, channel, event->bytes, event->size);
    }
}

static void test_the_log_replays_byte_for_byte(void) {
    static aisle_replay replay;
    static aisle_log_reader reader;
    aisle_engine engine;
    aisle_log_event event;
    aisle_sim_setup setup = crowd(3);
    FILE *log = tmpfile();
    run(&setup, log);
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_engine_start(&engine, &settings, 2, 0, message));
    aisle_replay_init(&replay, engine.planner, on_replayed, NULL);
    aisle_check_init(&check, stdout);
    TEST_ASSERT_TRUE(aisle_log_open(&reader, log));
    while (aisle_log_next(&reader, &event)) {
        replay_event(&replay, &event);
    }
    TEST_ASSERT_TRUE(aisle_check_finish(&check));
    aisle_engine_stop(&engine);
    (void)fclose(log);
}

// ---- faults

static double drive_with(const char *faults) {
    aisle_sim_setup setup = aisle_sim_setup_usual(2);
    TEST_ASSERT_TRUE(aisle_sim_faults_read(&setup.faults, faults));
    run(&setup, NULL);
    TEST_ASSERT_EQUAL_INT64(0, episode.judge.static_collisions);
    return episode.arrived ? episode.judge.arrival : 0.0;
}

static void test_lost_paths_stop_the_vehicle_until_they_come_again(void) {
    double plain = drive_with(""), late = drive_with("paths_lost:5:6");
    TEST_ASSERT_EQUAL_INT64(1, episode.stops);
    const aisle_sim_fault *f = &episode.setup.faults.fault[0];
    TEST_ASSERT_TRUE(f->answered < 0.0);                        // the planner cannot know
    TEST_ASSERT_TRUE(f->rested > 0.5 && f->rested < 1.0 + 4.0); // lease and braking
    TEST_ASSERT_TRUE(late > plain + 2.0 && late < plain + 7.0);
}

static void test_hold_stops_and_resume_goes_on(void) {
    double plain = drive_with(""), late = drive_with("hold:5:6");
    TEST_ASSERT_TRUE(episode.setup.faults.fault[0].rested < 1.0 + 4.0);
    TEST_ASSERT_TRUE(late > plain + 2.0);
}

static void test_a_silent_localiser_ends_the_lease(void) {
    double plain = drive_with(""), late = drive_with("pose_silent:5:6");
    TEST_ASSERT_TRUE(episode.setup.faults.fault[0].rested < 1.3 + 4.0);
    TEST_ASSERT_TRUE(late > plain + 2.0);
}

static void test_a_push_is_steered_away(void) {
    TEST_ASSERT_TRUE(drive_with("push:6:0:0.05") > 0.0);
    TEST_ASSERT_TRUE(episode.judge.static_gap > 0.0);
}

static void test_every_fault_reaches_the_drive(void) {
    double plain = drive_with(""), way = episode.judge.way;
    static const char *const faults[] = {"pose_silent:5:3", "unlocalized:5:3",     "pose_jump:5:3:0.3",
                                         "paths_lost:5:3",  "push:5:0:0.1",        "hold:5:3",
                                         "slow:5:3:0.4",    "obstacles_silent:1:9"};
    for (size_t i = 0; i < sizeof faults / sizeof faults[0]; i++) {
        double late = drive_with(faults[i]);
        bool counts = strncmp(faults[i], "obstacles", 9) != 0; // without movers nobody need mind that
        TEST_ASSERT_TRUE_MESSAGE(!counts || late != plain || episode.judge.way != way, faults[i]);
    }
}

// ---- messages for later

static void later(double at, aisle_channel channel, const void *msg, bool good) {
    static uint8_t bytes[AISLE_MSG_DATAGRAM_MAX];
    size_t size = 0;
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_msg_encode(aisle_channel_type(channel), msg, bytes, sizeof bytes, &size));
    TEST_ASSERT_EQUAL(good, aisle_sim_episode_script(&episode, at, channel, bytes, size));
}

static void begin_script(void) {
    aisle_sim_setup setup = aisle_sim_setup_usual(2);
    start(&setup, NULL);
    prepare(AISLE_CHANNEL_LAYOUT, &hall_layout);
    prepare(AISLE_CHANNEL_VEHICLE, &vehicle);
    prepare(AISLE_CHANNEL_POSE, &pose);
    prepare(AISLE_CHANNEL_GOALS, &goals);
}

static void end_script(void) {
    TEST_ASSERT_TRUE_MESSAGE(aisle_sim_episode_run(&episode, message), message);
    aisle_sim_host_stop(&host);
    aisle_sim_episode_end(&episode);
}

static void test_a_list_that_replaces_another_under_way_is_driven(void) {
    begin_script();
    aisle_goal_list_msg other = goals;
    other.goal_list_id = 2;
    other.goals[0].x = 2.0;
    other.goals[0].y = 8.0;
    later(5.0, AISLE_CHANNEL_GOALS, &other, true);
    end_script();
    TEST_ASSERT_TRUE(episode.arrived);
    TEST_ASSERT_DOUBLE_WITHIN(0.1, 8.0, episode.judge.pose.y);
    TEST_ASSERT_DOUBLE_WITHIN(0.1, 2.0, episode.judge.pose.x);
    TEST_ASSERT_EQUAL_INT32(2, episode.driver.path.goal_list_id);
}

static void test_a_patch_changes_planner_and_hall(void) {
    static aisle_layout_patch_msg patch;
    begin_script();
    patch = (aisle_layout_patch_msg){.map_id = 1, .base_revision = 1, .map_revision = 2, .num_polygons = 1};
    patch.polygons[0] = hall_layout.polygons[0];
    patch.polygons[0].id = 7;
    for (int i = 0; i < 4; i++) {
        patch.polygons[0].vertices[i][0] += 4.5; // in front of the goal's right, from 9.5 on
    }
    later(3.0, AISLE_CHANNEL_LAYOUT_PATCH, &patch, true);
    TEST_ASSERT_EQUAL_UINT32(1, episode.scene.count);
    TEST_ASSERT_TRUE_MESSAGE(aisle_sim_episode_run(&episode, message), message);
    TEST_ASSERT_EQUAL_UINT32(2, episode.scene.count);
    TEST_ASSERT_EQUAL_INT32(2, episode.status.map_revision);
    TEST_ASSERT_EQUAL_INT64(0, episode.judge.static_collisions);
    aisle_sim_host_stop(&host);
    aisle_sim_episode_end(&episode);
}

static void test_only_what_the_world_can_follow_is_scripted(void) {
    begin_script();
    later(5.0, AISLE_CHANNEL_VEHICLE, &vehicle, false);
    later(5.0, AISLE_CHANNEL_POSE, &pose, false);
    later(-1.0, AISLE_CHANNEL_GOALS, &goals, false);
    uint8_t nonsense[4] = {1, 2, 3, 4};
    TEST_ASSERT_FALSE(aisle_sim_episode_script(&episode, 1.0, AISLE_CHANNEL_GOALS, nonsense, sizeof nonsense));
    TEST_ASSERT_EQUAL_UINT32(0, episode.script.count);
    aisle_sim_host_stop(&host);
    aisle_sim_episode_end(&episode);
}

static void test_what_a_setup_lacks_is_named(void) {
    aisle_sim_setup setup = aisle_sim_setup_usual(1);
    start(&setup, NULL);
    TEST_ASSERT_FALSE(aisle_sim_episode_run(&episode, message));
    TEST_ASSERT_EQUAL_STRING("the set-up lacks a layout", message);
    prepare(AISLE_CHANNEL_LAYOUT, &hall_layout);
    TEST_ASSERT_FALSE(aisle_sim_episode_run(&episode, message));
    TEST_ASSERT_EQUAL_STRING("the set-up lacks a vehicle", message);
    prepare(AISLE_CHANNEL_VEHICLE, &vehicle);
    TEST_ASSERT_FALSE(aisle_sim_episode_run(&episode, message));
    TEST_ASSERT_EQUAL_STRING("the set-up lacks a pose to start from", message);
    prepare(AISLE_CHANNEL_POSE, &pose);
    TEST_ASSERT_FALSE(aisle_sim_episode_run(&episode, message));
    TEST_ASSERT_EQUAL_STRING("the set-up lacks goals", message);
    uint8_t nonsense[4] = {1, 2, 3, 4};
    TEST_ASSERT_FALSE(aisle_sim_episode_prepare(&episode, AISLE_CHANNEL_GOALS, nonsense, sizeof nonsense));
    aisle_sim_host_stop(&host);
    aisle_sim_episode_end(&episode);
}

static void test_reports_name_the_figures(void) {
    aisle_sim_setup setup = aisle_sim_setup_usual(4);
    run(&setup, NULL);
    FILE *out = tmpfile();
    char *text;
    aisle_sim_report_text(&episode, out);
    aisle_sim_report_json(&episode, out);
    (void)fputc('\0', out);
    (void)slurp(out, (uint8_t **)&text);
    static const char *const words[] = {"seed 4: arrived, 1 of 1 goals",
                                        "collisions while moving 0",
                                        "OK 1",
                                        "\"arrived\": true",
                                        "\"separation\": null",
                                        "\"optimum\": "};
    for (size_t i = 0; i < sizeof words / sizeof words[0]; i++) {
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(text, words[i]), words[i]);
    }
    free(text);
    (void)fclose(out);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_an_empty_hall_is_crossed_on_time_for_20_of_20_seeds);
    RUN_TEST(test_a_seed_gives_the_same_log_and_another_one_another);
    RUN_TEST(test_the_log_replays_byte_for_byte);
    RUN_TEST(test_lost_paths_stop_the_vehicle_until_they_come_again);
    RUN_TEST(test_hold_stops_and_resume_goes_on);
    RUN_TEST(test_a_silent_localiser_ends_the_lease);
    RUN_TEST(test_a_push_is_steered_away);
    RUN_TEST(test_every_fault_reaches_the_drive);
    RUN_TEST(test_a_list_that_replaces_another_under_way_is_driven);
    RUN_TEST(test_a_patch_changes_planner_and_hall);
    RUN_TEST(test_only_what_the_world_can_follow_is_scripted);
    RUN_TEST(test_what_a_setup_lacks_is_named);
    RUN_TEST(test_reports_name_the_figures);
    return UNITY_END();
}
