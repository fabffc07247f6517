#include "replay/bench.h" // first: proves that the header stands alone

#include "fake_planner.h"
#include "messages.h"
#include "unity.h"

#include <string.h>

static aisle_bench bench;
static aisle_replay replay;
static aisle_planner *planner;
static uint64_t block[FAKE_MEMSIZE / 8];
static FILE *text, *json;
static char said[4096];

void setUp(void) {
    fake_reset();
    fake.give_paths = true;
    text = tmpfile();
    json = tmpfile();
    aisle_config config = {.boot_id = 1};
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_planner_init(block, sizeof block, &config, &planner));
    aisle_bench_init(&bench, 30, text, json);
    aisle_replay_init(&replay, planner, aisle_bench_sink, &bench);
}
void tearDown(void) {
    (void)fclose(text);
    (void)fclose(json);
}
static const char *content(FILE *file) {
    rewind(file);
    said[fread(said, 1, sizeof said - 1, file)] = '\0';
    return said;
}

static void test_every_query_runs_as_often_as_asked_under_ids_of_its_own(void) {
    for (int32_t id = 100; id < 103; id++) {
        const test_message *m = make_message(AISLE_CHANNEL_QUERY, id);
        TEST_ASSERT_TRUE(aisle_bench_query(&bench, &replay, 1000, m->bytes, m->size));
    }
    TEST_ASSERT_EQUAL_UINT32(90, fake.answered);
    for (uint32_t i = 0; i < 90; i++) {
        for (uint32_t j = 0; j < i; j++) {
            TEST_ASSERT_TRUE(fake.taken[i].id != fake.taken[j].id && fake.taken[i].id >= 0);
        }
    }
    aisle_bench_finish(&bench);
    TEST_ASSERT_EQUAL_INT64(0, bench.failed);
    TEST_ASSERT_NOT_NULL(strstr(content(text), "all: 3 queries, 30 runs each, median "));
    TEST_ASSERT_NOT_NULL(strstr(said, "       101 OK      -                  3.000"));
    TEST_ASSERT_NOT_NULL(strstr(content(json), "{\"query_id\": 102, \"status\": \"OK\""));
    TEST_ASSERT_NOT_NULL(strstr(said, "\"overall\": {\"ms_median\": "));
}
static void test_runs_without_a_reply_are_counted(void) {
    const test_message *m = make_message(AISLE_CHANNEL_QUERY, 1);
    fake.refuse_all = true;
    TEST_ASSERT_TRUE(aisle_bench_query(&bench, &replay, 1000, m->bytes, m->size));
    TEST_ASSERT_TRUE(aisle_bench_query(&bench, &replay, 1000, (const uint8_t *)"junk", 4));
    aisle_bench_finish(&bench);
    TEST_ASSERT_EQUAL_INT64(30, bench.failed);
    TEST_ASSERT_EQUAL_INT64(1, bench.queries);
}
static void test_percentile_is_the_nearest_rank(void) {
    const double five[] = {1, 2, 3, 4, 5};
    double hundred[100];
    for (int i = 0; i < 100; i++) {
        hundred[i] = i + 1;
    }
    TEST_ASSERT_EQUAL_DOUBLE(3, aisle_bench_percentile(five, 5, 0.5));
    TEST_ASSERT_EQUAL_DOUBLE(5, aisle_bench_percentile(five, 5, 0.99));
    TEST_ASSERT_EQUAL_DOUBLE(1, aisle_bench_percentile(five, 5, 0.0));
    TEST_ASSERT_EQUAL_DOUBLE(50, aisle_bench_percentile(hundred, 100, 0.5));
    TEST_ASSERT_EQUAL_DOUBLE(99, aisle_bench_percentile(hundred, 100, 0.99));
    TEST_ASSERT_EQUAL_DOUBLE(0, aisle_bench_percentile(five, 0, 0.5));
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_every_query_runs_as_often_as_asked_under_ids_of_its_own);
    RUN_TEST(test_runs_without_a_reply_are_counted);
    RUN_TEST(test_percentile_is_the_nearest_rank);
    return UNITY_END();
}
