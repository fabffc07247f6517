#include "replay/check.h" // first: proves that the header stands alone

#include "messages.h"
#include "unity.h"

#include <stdlib.h>
#include <string.h>

static aisle_check check;
static FILE *report;
static char told[4096];

void setUp(void) {
    report = tmpfile();
    TEST_ASSERT_NOT_NULL(report);
    aisle_check_init(&check, report);
}
void tearDown(void) {
    (void)aisle_check_finish(&check);
    (void)fclose(report);
}

static void made(aisle_channel channel, const test_message *m) {
    TEST_ASSERT_TRUE(aisle_check_made(&check, channel, m->bytes, m->size));
}
static void recorded(aisle_channel channel, const test_message *m) {
    aisle_check_recorded(&check, channel, m->bytes, m->size);
}
static void expect(int64_t equal, int64_t different, int64_t missing, int64_t extra) {
    TEST_ASSERT_EQUAL(different + missing + extra == 0 && equal > 0, aisle_check_finish(&check));
    TEST_ASSERT_EQUAL_INT64(equal, check.equal);
    TEST_ASSERT_EQUAL_INT64(different, check.different);
    TEST_ASSERT_EQUAL_INT64(missing, check.missing);
    TEST_ASSERT_EQUAL_INT64(extra, check.extra);
}
static const char *report_text(void) {
    rewind(report);
    told[fread(told, 1, sizeof told - 1, report)] = '\0';
    return told;
}
// The path of that query with the bytes of one field turned over.
static const test_message *spoilt(int32_t query_id, const char *field) {
    static test_message m;
    m = *make_path(query_id, 0, 1);
    m.bytes[aisle_path_offset(field)] ^= 0x01U;
    return &m;
}

static void test_equal_paths_are_counted_whatever_their_order(void) {
    made(AISLE_CHANNEL_REPLY, make_path(1, 0, 10));
    made(AISLE_CHANNEL_REPLY, make_path(2, 0, 20));
    made(AISLE_CHANNEL_REPLY, make_path(3, 0, 30));
    recorded(AISLE_CHANNEL_REPLY, make_path(3, 0, 30));
    recorded(AISLE_CHANNEL_REPLY, make_path(1, 0, 10));
    made(AISLE_CHANNEL_REPLY, make_path(4, 0, 40));
    recorded(AISLE_CHANNEL_REPLY, make_path(2, 0, 20));
    recorded(AISLE_CHANNEL_REPLY, make_path(4, 0, 40));
    expect(4, 0, 0, 0);
}
static void test_fields_of_the_hosts_clock_may_differ_and_no_others(void) {
    static const char *const clock[] = {"utime", "boot_id", "t0_utime", "valid_until_utime", "planning_time"};
    static const char *const others[] = {"pose_utime", "obstacles_utime", "map_id",     "map_revision", "status",
                                         "cause",      "length",          "work_units", "certificate",  "num_base"};
    for (size_t i = 0; i < sizeof clock / sizeof clock[0]; i++) {
        made(AISLE_CHANNEL_REPLY, make_path(5, 0, 1));
        recorded(AISLE_CHANNEL_REPLY, spoilt(5, clock[i]));
    }
    for (size_t i = 0; i < sizeof others / sizeof others[0]; i++) {
        made(AISLE_CHANNEL_REPLY, make_path(5, 0, 1));
        recorded(AISLE_CHANNEL_REPLY, spoilt(5, others[i]));
        char want[64];
        (void)snprintf(want, sizeof want, "REPLY query 5: differs in %s (byte ", others[i]);
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(report_text(), want), told);
    }
    expect(5, 10, 0, 0);
}
static void test_difference_in_a_waypoint_names_it(void) {
    test_message m = *make_path(5, 0, 1);
    made(AISLE_CHANNEL_REPLY, &m);
    m.bytes[m.size - 1] ^= 0x01U;
    recorded(AISLE_CHANNEL_REPLY, &m);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(report_text(), "differs in waypoint 1 (byte "), told);
    expect(0, 1, 0, 0);
}
static void test_what_has_no_partner_is_missing_or_extra(void) {
    made(AISLE_CHANNEL_REPLY, make_path(1, 0, 1));
    recorded(AISLE_CHANNEL_REPLY, make_path(2, 0, 1));
    recorded(AISLE_CHANNEL_PATH, make_path(1, 0, 1)); // another channel is no partner
    expect(0, 0, 2, 1);
    TEST_ASSERT_NOT_NULL(strstr(report_text(), "query 2: recorded, but not made again"));
    TEST_ASSERT_NOT_NULL(strstr(told, "query 1: made, but not recorded"));
}
static void test_renewals_in_the_record_are_left_out(void) {
    made(AISLE_CHANNEL_PATH, make_path(0, 1, 1));
    made(AISLE_CHANNEL_PATH, make_path(0, 2, 1));
    recorded(AISLE_CHANNEL_PATH, make_path(0, 1, 1));
    recorded(AISLE_CHANNEL_PATH, make_path(0, 1, 500001));
    recorded(AISLE_CHANNEL_PATH, make_path(0, 2, 600001));
    recorded(AISLE_CHANNEL_PATH, make_path(0, 2, 1100001));
    expect(2, 0, 0, 0);
}
static void test_record_that_is_no_path_is_a_difference(void) {
    aisle_check_recorded(&check, AISLE_CHANNEL_REPLY, (const uint8_t *)"junk", 4);
    expect(0, 1, 0, 0);
}
static void test_nothing_compared_is_no_success(void) {
    expect(0, 0, 0, 0);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_equal_paths_are_counted_whatever_their_order);
    RUN_TEST(test_fields_of_the_hosts_clock_may_differ_and_no_others);
    RUN_TEST(test_difference_in_a_waypoint_names_it);
    RUN_TEST(test_what_has_no_partner_is_missing_or_extra);
    RUN_TEST(test_renewals_in_the_record_are_left_out);
    RUN_TEST(test_record_that_is_no_path_is_a_difference);
    RUN_TEST(test_nothing_compared_is_no_success);
    return UNITY_END();
}
