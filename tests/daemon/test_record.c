#include "daemon/record.h" // first: proves that the header stands alone

#include "daemon/log.h"
#include "unity.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static aisle_record record;
static char path[] = "/tmp/aisle-record-XXXXXX";

void setUp(void) {
    memcpy(path + sizeof path - 7, "XXXXXX", 6);
    int fd = mkstemp(path);
    TEST_ASSERT_TRUE(fd >= 0);
    (void)close(fd);
}
void tearDown(void) {
    aisle_record_close(&record);
    (void)unlink(path);
}

static void test_a_recording_is_a_log_that_begins_by_saying_what_it_is(void) {
    static aisle_log_reader reader;
    aisle_log_event event;
    uint32_t units = 1;
    TEST_ASSERT_TRUE(aisle_record_open(&record, path, "AGV7", 1000));
    aisle_record_message(&record, 2000, AISLE_CHANNEL_POSE, "pose", 4);
    aisle_record_step(&record, 3000, 0x01020304U);
    aisle_record_message(&record, 3000, AISLE_CHANNEL_PATH, "path!", 5);
    aisle_record_close(&record);
    TEST_ASSERT_FALSE(record.failed);
    FILE *file = fopen(path, "rb");
    TEST_ASSERT_TRUE(aisle_log_open(&reader, file));
    TEST_ASSERT_TRUE(aisle_log_next(&reader, &event));
    TEST_ASSERT_TRUE(
        aisle_record_is_step("AGV7", event.channel, event.channel_length, event.bytes, event.size, &units));
    TEST_ASSERT_EQUAL_UINT32(0, units);
    TEST_ASSERT_EQUAL_INT64(1000, event.utime);
    TEST_ASSERT_TRUE(aisle_log_next(&reader, &event));
    TEST_ASSERT_EQUAL_STRING_LEN("AGV7_POSE", event.channel, event.channel_length);
    TEST_ASSERT_EQUAL_MEMORY("pose", event.bytes, 4);
    TEST_ASSERT_FALSE(
        aisle_record_is_step("AGV7", event.channel, event.channel_length, event.bytes, event.size, &units));
    TEST_ASSERT_TRUE(aisle_log_next(&reader, &event));
    TEST_ASSERT_TRUE(
        aisle_record_is_step("AGV7", event.channel, event.channel_length, event.bytes, event.size, &units));
    TEST_ASSERT_EQUAL_HEX32(0x01020304U, units);
    TEST_ASSERT_FALSE(
        aisle_record_is_step("AGV8", event.channel, event.channel_length, event.bytes, event.size, &units));
    TEST_ASSERT_TRUE(aisle_log_next(&reader, &event));
    TEST_ASSERT_EQUAL_STRING_LEN("AGV7_PATH", event.channel, event.channel_length);
    TEST_ASSERT_EQUAL_INT64(3, event.number);
    TEST_ASSERT_FALSE(aisle_log_next(&reader, &event));
    (void)fclose(file);
}

static void test_a_step_of_another_length_is_none(void) {
    uint32_t units = 7;
    TEST_ASSERT_FALSE(aisle_record_is_step("A", "A_STEP", 6, (const uint8_t *)"12345", 5, &units));
    TEST_ASSERT_FALSE(aisle_record_is_step("A", "A_STEP", 6, (const uint8_t *)"123", 3, &units));
    TEST_ASSERT_EQUAL_UINT32(7, units);
}

static void test_nothing_is_recorded_without_a_file(void) {
    TEST_ASSERT_TRUE(aisle_record_open(&record, NULL, "AISLE", 0));
    aisle_record_step(&record, 1, 1);
    aisle_record_message(&record, 1, AISLE_CHANNEL_POSE, "pose", 4);
    aisle_record_step(NULL, 1, 1);
    aisle_record_message(NULL, 1, AISLE_CHANNEL_POSE, "pose", 4);
    TEST_ASSERT_EQUAL_INT64(0, record.number);
}

static void test_a_file_that_cannot_be_written_is_told(void) {
    TEST_ASSERT_FALSE(aisle_record_open(&record, "/nowhere/to/be/found", "AISLE", 0));
    aisle_record_step(&record, 1, 1);
    TEST_ASSERT_EQUAL_INT64(0, record.number);
}

static void test_a_full_disk_ends_the_recording_and_is_remembered(void) {
    static uint8_t much[1U << 20];
    if (!aisle_record_open(&record, "/dev/full", "AISLE", 0)) {
        TEST_IGNORE_MESSAGE("no /dev/full here");
    }
    aisle_record_message(&record, 1, AISLE_CHANNEL_LAYOUT, much, sizeof much);
    aisle_record_message(&record, 2, AISLE_CHANNEL_LAYOUT, much, sizeof much);
    TEST_ASSERT_TRUE(record.failed);
    TEST_ASSERT_NULL(record.file);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_a_recording_is_a_log_that_begins_by_saying_what_it_is);
    RUN_TEST(test_a_step_of_another_length_is_none);
    RUN_TEST(test_nothing_is_recorded_without_a_file);
    RUN_TEST(test_a_file_that_cannot_be_written_is_told);
    RUN_TEST(test_a_full_disk_ends_the_recording_and_is_remembered);
    return UNITY_END();
}
