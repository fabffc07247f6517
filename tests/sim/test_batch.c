#include "sim/batch.h" // first: proves that the header stands alone

#include "cases.h"
#include "unity.h"

#include <string.h>

static aisle_sim_batch batch, again;

void setUp(void) {}
void tearDown(void) {}

static void run(aisle_sim_batch *self, aisle_sim_kind kind, uint64_t first, int64_t drives, bool blind) {
    aisle_sim_batch_start(self, kind, first);
    self->encounters = INT64_MAX;
    self->episodes = drives;
    self->blind = blind;
    FILE *out = tmpfile();
    TEST_ASSERT_TRUE(aisle_sim_batch_run(self, out));
    (void)fclose(out);
}

static void test_without_care_movers_are_hit_and_the_hall_is_not(void) {
    run(&batch, AISLE_SIM_PERSON, 1, CASES(20), true);
    TEST_ASSERT_EQUAL_INT64(CASES(20), batch.done);
    TEST_ASSERT_TRUE(batch.met > CASES(50) && batch.collisions > CASES(10) && batch.with_collision > CASES(5));
    TEST_ASSERT_EQUAL_INT64(0, batch.hall_collisions);
    TEST_ASSERT_TRUE(batch.arrived >= CASES(15));
}

static void test_with_care_none_is(void) {
    run(&batch, AISLE_SIM_PERSON, 1, CASES(20), false); // the same drives
    TEST_ASSERT_EQUAL_INT64(0, batch.collisions + batch.hall_collisions);
    TEST_ASSERT_TRUE(batch.met > CASES(50) && batch.arrived >= CASES(5) && batch.revisions > CASES(100));
}

static void test_nor_when_things_go_wrong_and_planning_takes_time(void) {
    aisle_sim_batch_start(&batch, AISLE_SIM_KIND_COUNT, 100);
    batch.encounters = INT64_MAX;
    batch.episodes = CASES(10);
    batch.faults = true;
    batch.units_per_ms = 500;
    FILE *out = tmpfile();
    TEST_ASSERT_TRUE(aisle_sim_batch_run(&batch, out));
    (void)fclose(out);
    TEST_ASSERT_EQUAL_INT64(0, batch.collisions + batch.hall_collisions);
    TEST_ASSERT_TRUE(batch.met > CASES(10));
}

static void test_parts_of_a_batch_add_up_to_the_whole(void) {
    run(&batch, AISLE_SIM_CONSTANT, 3, 6, true);
    int64_t met = 0, hits = 0;
    double way = 0.0;
    for (uint64_t i = 0; i < 6; i++) {
        run(&again, AISLE_SIM_CONSTANT, 3 + i, 1, true);
        met += again.met;
        hits += again.collisions;
        way += again.way;
    }
    TEST_ASSERT_EQUAL_INT64(batch.met, met);
    TEST_ASSERT_EQUAL_INT64(batch.collisions, hits);
    TEST_ASSERT_EQUAL_DOUBLE(batch.way, way);
}

static void test_it_ends_with_the_encounters_wanted(void) {
    aisle_sim_batch_start(&batch, AISLE_SIM_PERSON, 1);
    batch.encounters = 5;
    batch.blind = true;
    FILE *out = tmpfile();
    TEST_ASSERT_TRUE(aisle_sim_batch_run(&batch, out));
    TEST_ASSERT_TRUE(batch.met >= 5 && batch.done < 10);
    aisle_sim_batch_report(&batch, 1.0, out);
    aisle_sim_batch_json(&batch, 1.0, out);
    (void)fseek(out, 0, SEEK_SET);
    static char text[8192];
    size_t size = fread(text, 1, sizeof text - 1, out);
    text[size] = '\0';
    TEST_ASSERT_NOT_NULL(strstr(text, "kind person, seeds 1 to "));
    TEST_ASSERT_NOT_NULL(strstr(text, "\"kind\": \"person\""));
    (void)fclose(out);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_without_care_movers_are_hit_and_the_hall_is_not);
    RUN_TEST(test_with_care_none_is);
    RUN_TEST(test_nor_when_things_go_wrong_and_planning_takes_time);
    RUN_TEST(test_parts_of_a_batch_add_up_to_the_whole);
    RUN_TEST(test_it_ends_with_the_encounters_wanted);
    return UNITY_END();
}
