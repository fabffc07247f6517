#include "sim/drawn.h" // first: proves that the header stands alone

#include "unity.h"

#include <string.h>

static aisle_sim_drawn drawn, again;

void setUp(void) {}
void tearDown(void) {}

static void test_every_stop_has_room_and_stops_are_apart_for_300_of_300_seeds(void) {
    for (uint64_t seed = 0; seed < 300; seed++) {
        aisle_sim_scene scene;
        aisle_vehicle vehicle;
        aisle_refusal why;
        memset(&scene, 0, sizeof scene);
        aisle_sim_draw(&drawn, seed, AISLE_SIM_PERSON, 0);
        TEST_ASSERT_EQUAL(AISLE_OK, aisle_vehicle_from_msg(&drawn.vehicle, &vehicle, &why));
        TEST_ASSERT_TRUE(aisle_sim_scene_take_layout(&scene, &drawn.layout));
        aisle_vec2 before = {drawn.start.x, drawn.start.y};
        TEST_ASSERT_TRUE(aisle_sim_scene_has_room(&scene, before, vehicle.outer_radius + vehicle.margin));
        TEST_ASSERT_TRUE(drawn.goals.num_goals >= 1 && drawn.goals.num_goals <= 3);
        for (int16_t i = 0; i < drawn.goals.num_goals; i++) {
            aisle_vec2 at = {drawn.goals.goals[i].x, drawn.goals.goals[i].y};
            TEST_ASSERT_TRUE(aisle_sim_scene_has_room(&scene, at, vehicle.outer_radius + vehicle.margin));
            TEST_ASSERT_TRUE(aisle_vec2_distance(at, before) >= 5.0);
            before = at;
        }
        aisle_sim_scene_free(&scene);
    }
}

static void test_the_core_takes_every_hall_and_vehicle(void) {
    static aisle_sim_host host;
    static aisle_sim_episode episode;
    char message[AISLE_SETTINGS_MESSAGE_LEN];
    aisle_settings settings;
    aisle_settings_defaults(&settings);
    for (uint64_t seed = 0; seed < 60; seed++) {
        aisle_sim_draw(&drawn, seed, AISLE_SIM_KIND_COUNT, 0);
        TEST_ASSERT_EQUAL(AISLE_OK,
                          aisle_sim_host_start_core(&host, &settings, NULL, aisle_sim_episode_hear, &episode, message));
        aisle_sim_episode_start(&episode, &drawn.setup, &host);
        TEST_ASSERT_TRUE(aisle_sim_drawn_prepare(&drawn, &episode));
        aisle_sim_episode_wait(&episode, 0.5);
        TEST_ASSERT_TRUE(aisle_sim_episode_is_held(&episode));
        TEST_ASSERT_EQUAL_INT64(0, host.replay.refused);
        aisle_sim_host_stop(&host);
        aisle_sim_episode_end(&episode);
    }
}

static void test_a_seed_draws_the_same_and_others_differ(void) {
    aisle_sim_draw(&drawn, 5, AISLE_SIM_JUMPS, 0);
    aisle_sim_draw(&again, 5, AISLE_SIM_JUMPS, 0);
    TEST_ASSERT_EQUAL_INT32(drawn.layout.crc32, again.layout.crc32);
    TEST_ASSERT_EQUAL_MEMORY(&drawn.start, &again.start, sizeof drawn.start);
    TEST_ASSERT_EQUAL_FLOAT(drawn.vehicle.v_max, again.vehicle.v_max);
    aisle_sim_draw(&again, 6, AISLE_SIM_JUMPS, 0);
    TEST_ASSERT_TRUE(drawn.layout.crc32 != again.layout.crc32);
}

static void test_kinds_and_counts_are_as_asked(void) {
    aisle_sim_draw(&drawn, 5, AISLE_SIM_AGV, 7);
    TEST_ASSERT_EQUAL_UINT32(1, drawn.setup.num_groups);
    TEST_ASSERT_EQUAL(AISLE_SIM_AGV, drawn.setup.group[0].kind);
    TEST_ASSERT_EQUAL_UINT32(7, drawn.setup.group[0].count);
    aisle_sim_draw(&drawn, 5, AISLE_SIM_KIND_COUNT, 2);
    TEST_ASSERT_EQUAL_UINT32(AISLE_SIM_TRACK, drawn.setup.num_groups);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_every_stop_has_room_and_stops_are_apart_for_300_of_300_seeds);
    RUN_TEST(test_the_core_takes_every_hall_and_vehicle);
    RUN_TEST(test_a_seed_draws_the_same_and_others_differ);
    RUN_TEST(test_kinds_and_counts_are_as_asked);
    return UNITY_END();
}
