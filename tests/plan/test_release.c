#include "test_verify_fixture.h"

static aisle_event event;
static aisle_moving_stamp moving;
static const aisle_event untouched = {AISLE_EVENT_REPLY, NULL, 77};

static void proved_path(void) {
    path_begin(0.0, 0.0, 0.0);
    path_line(1.0);
    path_arc(0.5, 1.0);
    path_end();
    TEST_ASSERT_EQUAL(AISLE_VERIFY_NONE, verified());
    moving = (aisle_moving_stamp){stamp.digest, stamp.size, 2000, 0.0F}; // the lease of the fixture
}

static aisle_status release(void) {
    event = untouched;
    return aisle_release(AISLE_EVENT_PATH, path_bytes, path_size, &stamp, &moving, &event);
}

static void assert_refused(void) {
    TEST_ASSERT_EQUAL(AISLE_ERR_ARG, release());
    TEST_ASSERT_EQUAL_MEMORY(&untouched, &event, sizeof event);
}

void setUp(void) {
    world_begin(-20.0, -20.0, 20.0, 20.0, 0.5F);
    world_build();
    vehicle_disc(0.3);
    proved_path();
}
void tearDown(void) {}

static void test_the_bytes_that_were_proved_leave(void) {
    TEST_ASSERT_EQUAL(AISLE_OK, release());
    TEST_ASSERT_EQUAL(AISLE_EVENT_PATH, event.kind);
    TEST_ASSERT_EQUAL_PTR(path_bytes, event.bytes);
    TEST_ASSERT_EQUAL_size_t(path_size, event.size);
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_release(AISLE_EVENT_REPLY, path_bytes, path_size, &stamp, NULL, &event));
    TEST_ASSERT_EQUAL(AISLE_EVENT_REPLY, event.kind);
}

static void test_a_path_to_drive_needs_the_proof_of_its_lease(void) {
    const aisle_moving_stamp right = moving;
    const int8_t status[2] = {AISLE_PATH_OK, AISLE_PATH_PARTIAL};
    for (int i = 0; i < 2; i++) {
        path.status = status[i];
        path_seal();
        TEST_ASSERT_EQUAL(AISLE_VERIFY_NONE, verified());
        moving = (aisle_moving_stamp){stamp.digest, right.size, right.until_us, 0.0F};
        TEST_ASSERT_EQUAL(AISLE_OK, release());
        moving.digest ^= 1U;
        assert_refused();
        moving = (aisle_moving_stamp){stamp.digest, right.size - 1U, right.until_us, 0.0F};
        assert_refused();
        moving = (aisle_moving_stamp){0, 0, 0, 0.0F};
        assert_refused();
        event = untouched;
        TEST_ASSERT_EQUAL(AISLE_ERR_ARG, aisle_release(AISLE_EVENT_PATH, path_bytes, path_size, &stamp, NULL, &event));
        TEST_ASSERT_EQUAL_MEMORY(&untouched, &event, sizeof event);
        TEST_ASSERT_EQUAL(AISLE_OK, aisle_release(AISLE_EVENT_REPLY, path_bytes, path_size, &stamp, NULL, &event));
    }
}

static void test_no_lease_ends_later_than_the_proved_one(void) {
    const int64_t ends[5] = {moving.until_us, 0, -1, INT64_MIN, INT64_MAX};
    for (int i = 0; i < 5; i++) {
        aisle_msg_put_int64(path_bytes + AISLE_PATH_AT_VALID_UNTIL_UTIME, ends[i]);
        moving.until_us = ends[i];
        TEST_ASSERT_EQUAL(AISLE_OK, release());
        if (ends[i] > INT64_MIN) {
            moving.until_us = ends[i] - 1;
            assert_refused();
        }
    }
}

static void test_no_more_clearance_from_movers_is_told_than_was_proved(void) {
    const float told[7] = {0.0F, 0.3F, 0.30001F, -0.1F, NAN, INFINITY, 1e-30F};
    const bool may_leave[7] = {true, true, false, false, false, false, true};
    moving.clearance = 0.3F;
    for (int i = 0; i < 7; i++) {
        aisle_msg_put_float(path_bytes + AISLE_PATH_AT_CLEARANCE_MOVING, told[i]);
        TEST_ASSERT_EQUAL(may_leave[i] ? AISLE_OK : AISLE_ERR_ARG, release());
        TEST_ASSERT_EQUAL(i == 0 ? AISLE_OK : AISLE_ERR_ARG, // a reply has no lease
                          aisle_release(AISLE_EVENT_REPLY, path_bytes, path_size, &stamp, &moving, &event));
    }
    size_t offset = 0;
    TEST_ASSERT_TRUE(aisle_msg_field_offset(AISLE_MSG_PATH, "clearance_moving_min", &offset));
    TEST_ASSERT_EQUAL_size_t(AISLE_PATH_AT_CLEARANCE_MOVING, offset);
}

static void test_a_path_that_only_brakes_needs_no_lease(void) {
    path_begin(0.0, 0.0, 0.0);
    path_turn(0.1);
    path_end();
    path.status = AISLE_PATH_STOP;
    path_seal();
    TEST_ASSERT_EQUAL(AISLE_VERIFY_NONE, verified());
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_release(AISLE_EVENT_PATH, path_bytes, path_size, &stamp, NULL, &event));
    aisle_msg_put_float(path_bytes + AISLE_PATH_AT_CLEARANCE_MOVING, 0.1F);
    TEST_ASSERT_EQUAL(AISLE_ERR_ARG, aisle_release(AISLE_EVENT_PATH, path_bytes, path_size, &stamp, NULL, &event));
    aisle_msg_put_float(path_bytes + AISLE_PATH_AT_CLEARANCE_MOVING, 0.0F);
    stamp.digest ^= 1U;
    TEST_ASSERT_EQUAL(AISLE_ERR_ARG, aisle_release(AISLE_EVENT_PATH, path_bytes, path_size, &stamp, NULL, &event));
}

static void test_a_renewed_lease_leaves(void) {
    moving.until_us = INT64_MAX;
    const char *names[2] = {"utime", "valid_until_utime"};
    for (int i = 0; i < 2; i++) {
        size_t offset = 0;
        TEST_ASSERT_TRUE(aisle_msg_field_offset(AISLE_MSG_PATH, names[i], &offset));
        aisle_msg_put_int64(path_bytes + offset, 1234567890123456789);
        TEST_ASSERT_EQUAL(AISLE_OK, release());
    }
}

static void test_any_other_byte_changed_stays(void) {
    size_t utime = 0, until = 0, units = 0;
    TEST_ASSERT_TRUE(aisle_msg_field_offset(AISLE_MSG_PATH, "utime", &utime));
    TEST_ASSERT_TRUE(aisle_msg_field_offset(AISLE_MSG_PATH, "valid_until_utime", &until));
    TEST_ASSERT_TRUE(aisle_msg_field_offset(AISLE_MSG_PATH, "work_units", &units));
    moving.until_us = INT64_MAX;
    for (size_t i = 0; i < path_size; i++) {
        bool lease = (i >= utime && i < utime + 8) || (i >= until && i < until + 8) || (i >= units && i < units + 4);
        path_bytes[i] ^= 0x10U;
        TEST_ASSERT_EQUAL(lease ? AISLE_OK : AISLE_ERR_ARG, release());
        path_bytes[i] ^= 0x10U;
    }
}

static void test_other_sizes_stay(void) {
    size_t whole = path_size;
    for (path_size = 0; path_size < whole; path_size++) {
        assert_refused();
    }
    path_bytes[whole] = 0;
    path_size = whole + 1;
    assert_refused();
}

static void test_without_a_stamp_nothing_to_drive_leaves(void) {
    aisle_stamp right = stamp;
    stamp = (aisle_stamp){0, 0};
    assert_refused();
    stamp = (aisle_stamp){right.digest, 0};
    assert_refused();
    stamp = (aisle_stamp){right.digest ^ 1U, right.size};
    assert_refused();
    stamp = (aisle_stamp){right.digest, right.size + 1U};
    assert_refused();
    event = untouched;
    TEST_ASSERT_EQUAL(AISLE_ERR_ARG, aisle_release(AISLE_EVENT_PATH, path_bytes, path_size, NULL, &moving, &event));
    TEST_ASSERT_EQUAL_MEMORY(&untouched, &event, sizeof event);
    TEST_ASSERT_EQUAL(AISLE_ERR_ARG, aisle_release(AISLE_EVENT_PATH, NULL, path_size, &right, &moving, &event));
}

static void test_a_refused_path_gets_no_stamp_that_releases_it(void) {
    path.waypoints[1].v = 5.0F;
    path_seal();
    TEST_ASSERT_NOT_EQUAL(AISLE_VERIFY_NONE, verified());
    assert_refused();
}

static void test_a_revocation_needs_no_stamp(void) {
    memset(&path, 0, sizeof path);
    path.status = AISLE_PATH_NONE;
    path.cause = AISLE_STATUS_NO_PATH;
    path_seal();
    event = untouched;
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_release(AISLE_EVENT_PATH, path_bytes, path_size, NULL, &moving, &event));
    TEST_ASSERT_EQUAL_size_t(path_size, event.size);
    stamp = (aisle_stamp){0, 0};
    TEST_ASSERT_EQUAL(AISLE_OK, release());
    path_bytes[0] ^= 1U; // not a path_t
    assert_refused();
}

static void test_status_none_with_a_way_and_ok_without_stay(void) {
    stamp = (aisle_stamp){0, 0};
    path.status = AISLE_PATH_NONE;
    path.num_waypoints = 9;
    path_seal();
    assert_refused();
    path.num_waypoints = 8; // places of the cause
    path_seal();
    TEST_ASSERT_EQUAL(AISLE_OK, release());
    path.num_waypoints = 0;
    for (int8_t status = AISLE_PATH_OK; status < AISLE_PATH_NONE; status++) {
        path.status = status;
        path_seal();
        assert_refused();
    }
}

static void test_the_certificate_is_the_crc_of_encoded_waypoints_and_revisions(void) {
    const int32_t numbers[7] = {21, 22, 23, 24, world_msg.map_id, world_msg.map_revision, vehicle.revision};
    size_t offset = 0;
    TEST_ASSERT_TRUE(aisle_msg_field_offset(AISLE_MSG_PATH, "waypoints", &offset));
    uint32_t crc = aisle_crc32(0, path_bytes + offset, path_size - offset);
    for (int i = 0; i < 7; i++) {
        const uint8_t bytes[4] = {0, 0, 0, (uint8_t)numbers[i]};
        crc = aisle_crc32(crc, bytes, 4);
    }
    TEST_ASSERT_EQUAL_HEX32(crc, aisle_path_certificate(&path));
    uint8_t bytes[4096];
    size_t size = 0;
    path.certificate = 0;
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_path_encode(&path, bytes, sizeof bytes, &size));
    TEST_ASSERT_EQUAL_HEX32(crc, path.certificate);
    TEST_ASSERT_EQUAL_size_t(path_size, size);
    TEST_ASSERT_EQUAL_MEMORY(path_bytes, bytes, size);
    TEST_ASSERT_EQUAL(AISLE_ERR_CAPACITY, aisle_path_encode(&path, bytes, path_size - 1, &size));
}

static void test_places_in_the_bytes_are_the_codec_s(void) {
    static const struct {
        const char *name;
        size_t at;
    } places[] = {{"utime", AISLE_PATH_AT_UTIME},
                  {"path_revision", AISLE_PATH_AT_REVISION},
                  {"map_id", AISLE_PATH_AT_MAP_ID},
                  {"map_revision", AISLE_PATH_AT_MAP_ID + 4},
                  {"vehicle_revision", AISLE_PATH_AT_MAP_ID + 8},
                  {"pose_utime", AISLE_PATH_AT_POSE_UTIME},
                  {"valid_until_utime", AISLE_PATH_AT_VALID_UNTIL_UTIME},
                  {"status", AISLE_PATH_AT_STATUS},
                  {"cached", AISLE_PATH_AT_CACHED},
                  {"work_units", AISLE_PATH_AT_WORK_UNITS},
                  {"certificate", AISLE_PATH_AT_CERTIFICATE},
                  {"num_waypoints", AISLE_PATH_AT_NUM_WAYPOINTS},
                  {"waypoints", AISLE_PATH_AT_WAYPOINTS}};
    for (size_t i = 0; i < sizeof places / sizeof places[0]; i++) {
        size_t offset = 0;
        TEST_ASSERT_TRUE(aisle_msg_field_offset(AISLE_MSG_PATH, places[i].name, &offset));
        TEST_ASSERT_EQUAL_size_t(offset, places[i].at);
    }
}

static void test_a_new_head_is_all_that_differs(void) {
    static aisle_path_msg other;
    other = path;
    other.utime = -1;
    other.boot_id = 2;
    other.path_revision = 3;
    other.query_id = 4;
    other.goal_list_id = 5;
    other.goal_list_revision = 6;
    other.map_id = 7;
    other.map_revision = 8;
    other.vehicle_revision = 9;
    other.pose_utime = 10;
    other.obstacles_utime = 11;
    other.t0_utime = 12;
    other.valid_until_utime = 13;
    other.cached = 1;
    other.work_units = 14;
    const uint32_t waypoints =
        aisle_crc32(0, path_bytes + AISLE_PATH_AT_WAYPOINTS, path_size - AISLE_PATH_AT_WAYPOINTS);
    aisle_path_rehead(path_bytes, &other, waypoints);
    uint8_t bytes[4096];
    size_t size = 0;
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_path_encode(&other, bytes, sizeof bytes, &size));
    TEST_ASSERT_EQUAL_size_t(size, path_size);
    TEST_ASSERT_EQUAL_MEMORY(bytes, path_bytes, size);
    assert_refused(); // its stamp was for the old head
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_places_in_the_bytes_are_the_codec_s);
    RUN_TEST(test_a_new_head_is_all_that_differs);
    RUN_TEST(test_the_bytes_that_were_proved_leave);
    RUN_TEST(test_a_path_to_drive_needs_the_proof_of_its_lease);
    RUN_TEST(test_no_lease_ends_later_than_the_proved_one);
    RUN_TEST(test_no_more_clearance_from_movers_is_told_than_was_proved);
    RUN_TEST(test_a_path_that_only_brakes_needs_no_lease);
    RUN_TEST(test_a_renewed_lease_leaves);
    RUN_TEST(test_any_other_byte_changed_stays);
    RUN_TEST(test_other_sizes_stay);
    RUN_TEST(test_without_a_stamp_nothing_to_drive_leaves);
    RUN_TEST(test_a_refused_path_gets_no_stamp_that_releases_it);
    RUN_TEST(test_a_revocation_needs_no_stamp);
    RUN_TEST(test_status_none_with_a_way_and_ok_without_stay);
    RUN_TEST(test_the_certificate_is_the_crc_of_encoded_waypoints_and_revisions);
    return UNITY_END();
}
