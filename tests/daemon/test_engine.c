#include "daemon/engine.h" // first: proves that the header stands alone

#include "fake_planner.h"
#include "unity.h"

#include <string.h>

static aisle_settings settings;
static aisle_engine engine;
static char message[AISLE_SETTINGS_MESSAGE_LEN];

void setUp(void) {
    fake_reset();
    aisle_settings_defaults(&settings);
}
void tearDown(void) {
    aisle_engine_stop(&engine);
}

static void test_block_is_aligned_and_settings_reach_the_planner(void) {
    settings.limits.cells = 5000;
    settings.work_units = 1234;
    settings.shortest_lease = 0.375F;
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_engine_start(&engine, &settings, 99, 1000, message));
    TEST_ASSERT_EQUAL(0, (uintptr_t)engine.block % 64U);
    TEST_ASSERT_EQUAL(0, (uintptr_t)engine.extra % 64U);
    TEST_ASSERT_TRUE((unsigned char *)engine.extra >= (unsigned char *)engine.block + FAKE_MEMSIZE);
    memset(engine.extra, 1, 1000); // for the sanitizer
    TEST_ASSERT_EQUAL_INT64(99, fake.config.boot_id);
    TEST_ASSERT_EQUAL_UINT32(5000, fake.config.limits.cells);
    TEST_ASSERT_EQUAL_INT32(1234, fake.config.work_units);
    TEST_ASSERT_EQUAL_FLOAT(0.375F, fake.config.shortest_lease);
    TEST_ASSERT_TRUE(fake.config.has_vehicle);
    TEST_ASSERT_EQUAL_MEMORY(&settings.vehicle, &fake.config.vehicle, sizeof settings.vehicle);
}
static void test_refusals_of_the_planner_are_told(void) {
    settings.limits.requests = 65;
    TEST_ASSERT_EQUAL(AISLE_ERR_ARG, aisle_engine_start(&engine, &settings, 1, 0, message));
    TEST_ASSERT_NOT_NULL(strstr(message, "[limits]"));
    TEST_ASSERT_NULL(engine.block);
    settings.limits.requests = 0;
    settings.vehicle.drive = AISLE_VEHICLE_OMNI; // the fake does not like it
    TEST_ASSERT_EQUAL(AISLE_ERR_ARG, aisle_engine_start(&engine, &settings, 1, 0, message));
    TEST_ASSERT_NOT_NULL(strstr(message, "[vehicle]"));
    TEST_ASSERT_NULL(engine.block);
}
static void test_memory_that_is_not_there_is_told(void) {
    TEST_ASSERT_EQUAL(AISLE_ERR_CAPACITY, aisle_engine_start(&engine, &settings, 1, SIZE_MAX / 4, message));
    TEST_ASSERT_NOT_NULL(strstr(message, "memory"));
}
static void test_boot_ids_are_positive_and_differ(void) {
    int64_t first = aisle_engine_boot_id(), second = aisle_engine_boot_id();
    TEST_ASSERT_TRUE(first > 0 && second > 0 && first != second);
}
static void test_memory_table_names_pools_and_adds_them_up(void) {
    char text[2048] = "";
    FILE *file = tmpfile();
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_engine_start(&engine, &settings, 1, 4096, message));
    TEST_ASSERT_TRUE(aisle_engine_print_memory(&engine, 777, file));
    rewind(file);
    text[fread(text, 1, sizeof text - 1, file)] = '\0';
    (void)fclose(file);
    TEST_ASSERT_NOT_NULL(strstr(text, "grid                                   8000\n"));
    TEST_ASSERT_NOT_NULL(strstr(text, "planner, sum                             8192\n"));
    TEST_ASSERT_NOT_NULL(strstr(text, "daemon, queue                            4096\n"));
    TEST_ASSERT_NOT_NULL(strstr(text, "daemon, static                            777\n"));
    TEST_ASSERT_NOT_NULL(strstr(text, "heap of the core after start                0\n"));
    TEST_ASSERT_NOT_NULL(strstr(text, "stack of the core, at most"));
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_block_is_aligned_and_settings_reach_the_planner);
    RUN_TEST(test_refusals_of_the_planner_are_told);
    RUN_TEST(test_memory_that_is_not_there_is_told);
    RUN_TEST(test_boot_ids_are_positive_and_differ);
    RUN_TEST(test_memory_table_names_pools_and_adds_them_up);
    return UNITY_END();
}
