#include "daemon/log.h" // first: proves that the header stands alone

#include "unity.h"

#include <stdlib.h>
#include <string.h>

static FILE *file;
static aisle_log_reader reader;
static uint8_t data[200000];

void setUp(void) {
    file = tmpfile();
    TEST_ASSERT_NOT_NULL(file);
}
void tearDown(void) {
    (void)fclose(file);
}

static void append(int64_t number, const char *channel, size_t size) {
    for (size_t i = 0; i < size; i++) {
        data[i] = (uint8_t)(number + (int64_t)i);
    }
    aisle_log_event e = {number, 1000 * number, channel, strlen(channel), data, size};
    TEST_ASSERT_TRUE(aisle_log_write(file, &e));
}
static void append_raw(const void *bytes, size_t size) {
    TEST_ASSERT_EQUAL(size, fwrite(bytes, 1, size, file));
}
static void start(void) {
    TEST_ASSERT_EQUAL(0, fflush(file));
    TEST_ASSERT_TRUE(aisle_log_open(&reader, file));
}
static void expect(int64_t number, const char *channel, size_t size) {
    aisle_log_event e;
    TEST_ASSERT_TRUE(aisle_log_next(&reader, &e));
    TEST_ASSERT_EQUAL_INT64(number, e.number);
    TEST_ASSERT_EQUAL_INT64(1000 * number, e.utime);
    TEST_ASSERT_EQUAL(strlen(channel), e.channel_length);
    TEST_ASSERT_EQUAL_STRING_LEN(channel, e.channel, e.channel_length);
    TEST_ASSERT_EQUAL(size, e.size);
    for (size_t i = 0; i < size; i++) {
        TEST_ASSERT_EQUAL_HEX8((uint8_t)(number + (int64_t)i), e.bytes[i]);
    }
}
static void expect_end(void) {
    aisle_log_event e;
    TEST_ASSERT_FALSE(aisle_log_next(&reader, &e));
    TEST_ASSERT_FALSE(aisle_log_next(&reader, &e));
}

static void test_bytes_are_those_of_the_format(void) {
    static const uint8_t want[] = {0xED, 0xA1, 0xDA, 0x01, 0, 0, 0, 0, 0, 0, 0, 2,   0,   0, 0, 0, 0,
                                   0,    7,    0xD0, 0,    0, 0, 2, 0, 0, 0, 3, 'A', 'B', 2, 3, 4};
    uint8_t got[64];
    append(2, "AB", 3);
    rewind(file);
    TEST_ASSERT_EQUAL(sizeof want, fread(got, 1, sizeof got, file));
    TEST_ASSERT_EQUAL_HEX8_ARRAY(want, got, sizeof want);
}
static void test_events_come_back_as_written(void) {
    append(0, "A", 0);
    append(1, "AISLE_QUERY", 300);
    append(-5, "012345678901234567890123456789012345678901234567890123456789012", AISLE_MSG_DATAGRAM_MAX);
    start();
    expect(0, "A", 0);
    expect(1, "AISLE_QUERY", 300);
    expect(-5, "012345678901234567890123456789012345678901234567890123456789012", AISLE_MSG_DATAGRAM_MAX);
    expect_end();
    TEST_ASSERT_EQUAL_INT64(3, reader.events);
    TEST_ASSERT_EQUAL_INT64(0, reader.garbage_bytes + reader.cut_off + reader.oversize);
}
static void test_empty_file_has_no_events(void) {
    start();
    expect_end();
}
static void test_every_truncation_leaves_whole_events_alone_and_is_counted(void) {
    append(1, "AB", 10);
    append(2, "CD", 10);
    static uint8_t all[80];
    rewind(file);
    TEST_ASSERT_EQUAL(80, fread(all, 1, sizeof all, file)); // 2 * (28 + 2 + 10)
    for (size_t length = 0; length < 80; length++) {
        tearDown();
        setUp();
        append_raw(all, length);
        start();
        if (length >= 40) {
            expect(1, "AB", 10);
        }
        expect_end();
        bool whole = length % 40 == 0, header = length % 40 >= 4;
        TEST_ASSERT_EQUAL_INT64(!whole && header ? 1 : 0, reader.cut_off);
        TEST_ASSERT_EQUAL_INT64(length % 40, reader.garbage_bytes);
    }
}
static void test_garbage_between_events_is_skipped_and_counted(void) {
    append_raw("noise", 5);
    append(1, "AB", 4);
    append_raw("\xED\xA1\xDA", 3); // nearly a sync word
    append(2, "CD", 4);
    append_raw("\xED\xED\xA1\xDA\xED\xA1", 6);
    append(3, "EF", 4);
    append_raw("x", 1);
    append(4, "GH", 4);
    append_raw("end", 3);
    start();
    expect(1, "AB", 4);
    expect(2, "CD", 4);
    expect(3, "EF", 4);
    expect(4, "GH", 4);
    expect_end();
    TEST_ASSERT_EQUAL_INT64(18, reader.garbage_bytes);
}
static void test_implausible_lengths_are_garbage(void) {
    static const uint32_t lengths[][2] = {{0, 4}, {64, 4}, {0xFFFFFFFFU, 4}, {2, (1U << 28U) + 1U}, {2, 0xFFFFFFFFU}};
    for (size_t i = 0; i < sizeof lengths / sizeof lengths[0]; i++) {
        uint8_t header[28] = {0xED, 0xA1, 0xDA, 0x01};
        for (size_t j = 0; j < 4; j++) {
            header[20 + j] = (uint8_t)(lengths[i][0] >> (24 - 8 * j));
            header[24 + j] = (uint8_t)(lengths[i][1] >> (24 - 8 * j));
        }
        append_raw(header, sizeof header);
        append((int64_t)i, "AB", 4);
    }
    start();
    for (size_t i = 0; i < sizeof lengths / sizeof lengths[0]; i++) {
        expect((int64_t)i, "AB", 4);
    }
    expect_end();
    TEST_ASSERT_EQUAL_INT64(28 * 5, reader.garbage_bytes);
}
static void test_header_that_promises_more_than_the_file_does_not_swallow_the_events_behind(void) {
    uint8_t header[28] = {0xED, 0xA1, 0xDA, 0x01};
    header[23] = 2;
    header[25] = 0x10; // a megabyte of data
    append_raw(header, sizeof header);
    append(1, "AB", 4);
    start();
    expect(1, "AB", 4);
    expect_end();
    TEST_ASSERT_EQUAL_INT64(1, reader.cut_off);
}
static void test_event_too_long_to_be_ours_is_stepped_over(void) {
    append(1, "CAMERA", 150000);
    append(2, "AB", 4);
    start();
    expect(2, "AB", 4);
    expect_end();
    TEST_ASSERT_EQUAL_INT64(1, reader.oversize);
    TEST_ASSERT_EQUAL_INT64(0, reader.garbage_bytes);
}
static void test_random_damage_never_crashes_and_reading_goes_on_behind_it(void) {
    uint32_t seed = 7;
    for (int round = 0; round < 200; round++) {
        tearDown();
        setUp();
        for (int64_t i = 0; i < 20; i++) {
            append(i, "AB", 50);
        }
        for (int hits = 0; hits < 3; hits++) {
            seed = seed * 1664525U + 1013904223U;
            TEST_ASSERT_EQUAL(0, fseek(file, (long)((seed >> 8) % (19U * 80U)), SEEK_SET));
            (void)fputc((int)(seed >> 24), file);
        }
        start();
        aisle_log_event e;
        int64_t count = 0, last = -1;
        while (aisle_log_next(&reader, &e)) {
            count++;
            last = e.number;
        }
        TEST_ASSERT_TRUE(count >= 17);
        TEST_ASSERT_EQUAL_INT64(19, last);
    }
}
static void test_pipe_is_refused(void) {
    FILE *pipe_file = popen("true", "r");
    TEST_ASSERT_NOT_NULL(pipe_file);
    TEST_ASSERT_FALSE(aisle_log_open(&reader, pipe_file));
    (void)pclose(pipe_file);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_bytes_are_those_of_the_format);
    RUN_TEST(test_events_come_back_as_written);
    RUN_TEST(test_empty_file_has_no_events);
    RUN_TEST(test_every_truncation_leaves_whole_events_alone_and_is_counted);
    RUN_TEST(test_garbage_between_events_is_skipped_and_counted);
    RUN_TEST(test_implausible_lengths_are_garbage);
    RUN_TEST(test_header_that_promises_more_than_the_file_does_not_swallow_the_events_behind);
    RUN_TEST(test_event_too_long_to_be_ours_is_stepped_over);
    RUN_TEST(test_random_damage_never_crashes_and_reading_goes_on_behind_it);
    RUN_TEST(test_pipe_is_refused);
    return UNITY_END();
}
