#include "sim/tracks.h" // first: proves that the header stands alone

#include "unity.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define PI 3.14159265358979323846

static aisle_sim_tracks tracks;
static char message[AISLE_SIM_TRACKS_MESSAGE_LEN];
static char name[] = "/tmp/aisle_tracks_XXXXXX";

void setUp(void) {}
void tearDown(void) {
    aisle_sim_tracks_free(&tracks);
}

static bool read_text(const char *text) {
    memcpy(name + sizeof name - 7, "XXXXXX", 6);
    int fd = mkstemp(name);
    FILE *file = fdopen(fd, "w");
    (void)fputs(text, file);
    (void)fclose(file);
    bool good = aisle_sim_tracks_read(&tracks, name, message);
    (void)unlink(name);
    return good;
}

#define HEADER "t_s,id,kind,x_m,y_m,heading_rad\n"

static void test_between_samples_it_moves_evenly_and_is_gone_outside(void) {
    TEST_ASSERT_TRUE(read_text(HEADER
                               "1.0,a,ped,0.0,0.0,\n1.0,b,veh,5,5,0.5\n2.0,a,ped,1.0,0.5,0.1\n2.0,b,veh,5,6,1.0\n"
                               "4.0,a,ped,1.0,2.5,\n"));
    TEST_ASSERT_EQUAL_UINT32(2, tracks.num_tracks);
    TEST_ASSERT_EQUAL_DOUBLE(4.0, tracks.duration);
    aisle_vec2 at, v;
    TEST_ASSERT_FALSE(aisle_sim_tracks_at(&tracks, 0, 0.99, &at, &v));
    TEST_ASSERT_TRUE(aisle_sim_tracks_at(&tracks, 0, 1.25, &at, &v));
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0.25, at.x);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0.125, at.y);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 1.0, v.x);
    TEST_ASSERT_TRUE(aisle_sim_tracks_at(&tracks, 0, 4.0, &at, &v));
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 2.5, at.y);
    TEST_ASSERT_FALSE(aisle_sim_tracks_at(&tracks, 0, 4.01, &at, &v));
    TEST_ASSERT_FALSE(aisle_sim_tracks_at(&tracks, 1, 2.5, &at, &v));
    TEST_ASSERT_TRUE(tracks.track[1].is_vehicle && !tracks.track[0].is_vehicle);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, sqrt(1.25), tracks.track[0].v_max);
}

static void test_an_outlier_ends_a_track_and_begins_another(void) {
    TEST_ASSERT_TRUE(read_text(HEADER "0,a,ped,0,0,\n1,a,ped,1,0,\n2,a,ped,9,0,\n3,a,ped,10,0,\n"));
    TEST_ASSERT_EQUAL_UINT32(2, tracks.num_tracks);
    TEST_ASSERT_EQUAL_UINT32(2, tracks.track[0].count);
    TEST_ASSERT_EQUAL_DOUBLE(1.0, tracks.track[1].v_max);
}

static void test_mapping_keeps_speeds(void) {
    aisle_vec2 at, v;
    TEST_ASSERT_TRUE(read_text(HEADER "0,a,ped,0,0,\n2,a,ped,2,0,\n"));
    aisle_sim_tracks_map(&tracks, aisle_vec2_of(10.0, 20.0), 0.5 * PI, 0.5);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 1.0, tracks.duration);
    TEST_ASSERT_TRUE(aisle_sim_tracks_at(&tracks, 0, 1.0, &at, &v));
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 10.0, at.x);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 20.5, at.y);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 1.0, v.y);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0.0, v.x);
}

static void test_bad_files_are_refused_by_line(void) {
    static const char *const bad[] = {HEADER "0,a,ped,0\n", HEADER "0,a,cat,0,0,\n", HEADER "0,a,ped,nan,0,\n",
                                      HEADER "0,,ped,0,0,\n", HEADER "zero,a,ped,0,0,\n"};
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        TEST_ASSERT_FALSE(read_text(bad[i]));
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(message, ":2: not t_s"), bad[i]);
        TEST_ASSERT_NULL(tracks.sample);
    }
    TEST_ASSERT_FALSE(read_text(HEADER "1,a,ped,0,0,\n0,a,ped,0,0,\n"));
    TEST_ASSERT_NOT_NULL(strstr(message, ":3: not sorted"));
    TEST_ASSERT_FALSE(read_text(HEADER));
    TEST_ASSERT_NOT_NULL(strstr(message, "no samples"));
    TEST_ASSERT_FALSE(aisle_sim_tracks_read(&tracks, "/nonexistent/x.csv", message));
    TEST_ASSERT_NOT_NULL(strstr(message, "No such file"));
}

static void test_recordings_read_whole(void) {
    static const struct {
        const char *file;
        uint32_t samples, ids;
        double seconds;
    } known[] = {{AISLE_TEST_DATA "/tracks/ucy_zara01.csv", 5153, 148, 360.0},
                 {AISLE_TEST_DATA "/tracks/thor_exp1_run2.csv", 2180, 87, 255.0}};
    for (size_t i = 0; i < 2; i++) {
        TEST_ASSERT_TRUE_MESSAGE(aisle_sim_tracks_read(&tracks, known[i].file, message), message);
        TEST_ASSERT_EQUAL_UINT32(known[i].samples, tracks.num_samples);
        TEST_ASSERT_TRUE(tracks.num_tracks >= known[i].ids && tracks.num_tracks < known[i].ids + 5);
        TEST_ASSERT_DOUBLE_WITHIN(2.0, known[i].seconds, tracks.duration);
        for (uint32_t k = 0; k < tracks.num_tracks; k++) {
            TEST_ASSERT_TRUE(tracks.track[k].v_max <= AISLE_SIM_TRACK_SPEED_MAX);
        }
        aisle_sim_tracks_free(&tracks);
    }
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_between_samples_it_moves_evenly_and_is_gone_outside);
    RUN_TEST(test_an_outlier_ends_a_track_and_begins_another);
    RUN_TEST(test_mapping_keeps_speeds);
    RUN_TEST(test_bad_files_are_refused_by_line);
    RUN_TEST(test_recordings_read_whole);
    return UNITY_END();
}
