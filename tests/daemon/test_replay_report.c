#include "replay/report.h" // first: proves that the header stands alone

#include "fake_planner.h"
#include "unity.h"

#include <string.h>

static FILE *file;
static char said[4096];
static aisle_replay_sums sums;
static aisle_path_msg path;
static uint8_t bytes[AISLE_MSG_DATAGRAM_MAX];

void setUp(void) {
    fake_reset();
    file = tmpfile();
    TEST_ASSERT_NOT_NULL(file);
    memset(&sums, 0, sizeof sums);
    memset(&path, 0, sizeof path);
}
void tearDown(void) {
    (void)fclose(file);
}

static const char *content(void) {
    rewind(file);
    said[fread(said, 1, sizeof said - 1, file)] = '\0';
    return said;
}
static aisle_replay_output encoded(aisle_channel channel, bool renewal) {
    aisle_replay_output output = {.channel = channel, .renewal = renewal, .bytes = bytes};
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_msg_encode(AISLE_MSG_PATH, &path, bytes, sizeof bytes, &output.size));
    return output;
}

static void test_line_of_a_reply_tells_all_that_matters(void) {
    path = (aisle_path_msg){.query_id = 12,
                            .length = 3.5F,
                            .length_bound = 3.25F,
                            .clearance_min = 0.5F,
                            .duration = 7.0F,
                            .work_units = 4321,
                            .num_waypoints = 2,
                            .certificate = (int32_t)0x89ABCDEF};
    aisle_replay_output output = encoded(AISLE_CHANNEL_REPLY, false);
    aisle_report_path(&output, &sums, file, NULL);
    TEST_ASSERT_EQUAL_STRING(
        "reply query 12       OK      -              length    3.500 bound    3.250 clearance  0.500 "
        "duration    7.00 work     4321 waypoints    2 certificate 89abcdef\n",
        content());
    TEST_ASSERT_EQUAL_INT64(1, sums.replies);
    TEST_ASSERT_EQUAL_INT64(1, sums.proved);
    TEST_ASSERT_EQUAL_INT64(4321, sums.work_units);
}
static void test_line_of_a_refusal_tells_its_cause(void) {
    path = (aisle_path_msg){.goal_list_id = 3,
                            .goal_list_revision = 4,
                            .path_revision = 5,
                            .status = AISLE_PATH_NONE,
                            .cause = AISLE_STATUS_NO_LAYOUT,
                            .cause_id = 9,
                            .cause_value = 0.625F};
    aisle_replay_output output = encoded(AISLE_CHANNEL_PATH, false);
    aisle_report_path(&output, &sums, file, NULL);
    TEST_ASSERT_NOT_NULL(strstr(content(), "path  goals 3.4 revision 5 NONE    NO_LAYOUT "));
    TEST_ASSERT_NOT_NULL(strstr(said, " cause_id 9 cause_value 0.625\n"));
    TEST_ASSERT_EQUAL_INT64(1, sums.paths);
    TEST_ASSERT_EQUAL_INT64(1, sums.none);
}
static void test_renewals_are_counted_and_not_printed(void) {
    aisle_replay_output output = encoded(AISLE_CHANNEL_PATH, true);
    aisle_report_path(&output, &sums, file, file);
    TEST_ASSERT_EQUAL_STRING("", content());
    TEST_ASSERT_EQUAL_INT64(1, sums.renewals);
    TEST_ASSERT_EQUAL_INT64(0, sums.paths);
}
static void test_objects_are_parted_by_commas(void) {
    aisle_replay_output output = encoded(AISLE_CHANNEL_REPLY, false);
    aisle_report_path(&output, &sums, NULL, file);
    aisle_report_path(&output, &sums, NULL, file);
    const char *second = strchr(content() + 1, '\n');
    TEST_ASSERT_EQUAL('\n', said[0]);
    TEST_ASSERT_NOT_NULL(second);
    TEST_ASSERT_EQUAL(',', second[-1]);
}
static void test_strings_are_escaped(void) {
    aisle_report_json_string("a\"b\\c\n\xC3\xA9", file);
    TEST_ASSERT_EQUAL_STRING("\"a\\\"b\\\\c\\u000a\xC3\xA9\"", content());
}
static void test_unknown_path_status_has_a_text(void) {
    TEST_ASSERT_EQUAL_STRING("PARTIAL", aisle_report_path_status(AISLE_PATH_PARTIAL));
    TEST_ASSERT_EQUAL_STRING("?", aisle_report_path_status(-1));
    TEST_ASSERT_EQUAL_STRING("?", aisle_report_path_status(4));
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_line_of_a_reply_tells_all_that_matters);
    RUN_TEST(test_line_of_a_refusal_tells_its_cause);
    RUN_TEST(test_renewals_are_counted_and_not_printed);
    RUN_TEST(test_objects_are_parted_by_commas);
    RUN_TEST(test_strings_are_escaped);
    RUN_TEST(test_unknown_path_status_has_a_text);
    return UNITY_END();
}
