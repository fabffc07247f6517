#include "sim/faults.h" // first: proves that the header stands alone

#include "aisle/messages.h"
#include "unity.h"

static aisle_sim_faults faults;

void setUp(void) {}
void tearDown(void) {}

static void test_lists_are_read(void) {
    TEST_ASSERT_TRUE(aisle_sim_faults_read(&faults, "pose_silent:5:1.5,push:7:0:-0.3"));
    TEST_ASSERT_EQUAL_UINT32(2, faults.count);
    TEST_ASSERT_EQUAL(AISLE_SIM_POSE_SILENT, faults.fault[0].kind);
    TEST_ASSERT_EQUAL_DOUBLE(1.5, faults.fault[0].lasts);
    TEST_ASSERT_EQUAL_DOUBLE(0.5, faults.fault[0].amount);
    TEST_ASSERT_EQUAL_DOUBLE(-0.3, faults.fault[1].amount);
    TEST_ASSERT_TRUE(aisle_sim_faults_read(&faults, ""));
    TEST_ASSERT_EQUAL_UINT32(0, faults.count);
}

static void test_every_kind_can_be_named(void) {
    for (int kind = 0; kind < (int)AISLE_SIM_FAULT_COUNT; kind++) {
        char text[64];
        (void)snprintf(text, sizeof text, "%s:1:2", aisle_sim_fault_name((aisle_sim_fault_kind)kind));
        TEST_ASSERT_TRUE(aisle_sim_faults_read(&faults, text));
        TEST_ASSERT_EQUAL(kind, faults.fault[0].kind);
    }
}

static void test_bad_lists_are_refused(void) {
    static const char *const bad[] = {
        "pose_silent",  "pose_silent:1",
        "pose:1:1",     "push:1:1:x",
        "push:-1:1",    "push:1:1,,",
        "push:1:nan",   "push:1:1:1000",
        "push:1:1:1:1", "hold:1:1,hold:1:1,hold:1:1,hold:1:1,hold:1:1,hold:1:1,hold:1:1,hold:1:1,hold:1:1"};
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        TEST_ASSERT_FALSE_MESSAGE(aisle_sim_faults_read(&faults, bad[i]), bad[i]);
    }
}

static void test_a_fault_is_on_from_its_beginning_until_it_is_over(void) {
    TEST_ASSERT_TRUE(aisle_sim_faults_read(&faults, "hold:2:1"));
    TEST_ASSERT_NULL(aisle_sim_faults_active(&faults, AISLE_SIM_HOLD, 1.99));
    TEST_ASSERT_NOT_NULL(aisle_sim_faults_active(&faults, AISLE_SIM_HOLD, 2.0));
    TEST_ASSERT_NOT_NULL(aisle_sim_faults_active(&faults, AISLE_SIM_HOLD, 2.99));
    TEST_ASSERT_NULL(aisle_sim_faults_active(&faults, AISLE_SIM_HOLD, 3.0));
    TEST_ASSERT_NULL(aisle_sim_faults_active(&faults, AISLE_SIM_PUSH, 2.5));
}

static void test_the_first_stop_or_none_answers(void) {
    TEST_ASSERT_TRUE(aisle_sim_faults_read(&faults, "hold:2:1"));
    aisle_sim_faults_note_path(&faults, 1.5, AISLE_PATH_NONE, 7);
    aisle_sim_faults_note_path(&faults, 2.1, AISLE_PATH_OK, 0);
    TEST_ASSERT_TRUE(faults.fault[0].answered < 0.0);
    aisle_sim_faults_note_path(&faults, 2.25, AISLE_PATH_STOP, AISLE_STATUS_POSE_STALE);
    aisle_sim_faults_note_path(&faults, 2.5, AISLE_PATH_NONE, 9);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0.25, faults.fault[0].answered);
    TEST_ASSERT_EQUAL_INT16(AISLE_STATUS_POSE_STALE, faults.fault[0].cause);
    aisle_sim_faults_note_rest(&faults, 1.0);
    aisle_sim_faults_note_rest(&faults, 4.0);
    aisle_sim_faults_note_rest(&faults, 5.0);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 2.0, faults.fault[0].rested);
}

static void test_drawn_ones_leave_the_place_known(void) {
    for (uint64_t seed = 0; seed < 100; seed++) {
        aisle_rng rng = aisle_rng_seed(seed);
        faults.count = 0;
        aisle_sim_faults_draw(&faults, &rng, 20, 30.0);
        TEST_ASSERT_EQUAL_UINT32(AISLE_SIM_FAULTS_MAX, faults.count);
        for (uint32_t i = 0; i < faults.count; i++) {
            const aisle_sim_fault *f = &faults.fault[i];
            TEST_ASSERT_TRUE(f->kind != AISLE_SIM_PUSH && f->kind != AISLE_SIM_POSE_JUMP);
            TEST_ASSERT_TRUE(f->at >= 1.0 && f->at < 30.0 && f->lasts >= 0.2 && f->lasts < 3.0 && f->answered < 0.0);
        }
    }
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_lists_are_read);
    RUN_TEST(test_every_kind_can_be_named);
    RUN_TEST(test_bad_lists_are_refused);
    RUN_TEST(test_a_fault_is_on_from_its_beginning_until_it_is_over);
    RUN_TEST(test_the_first_stop_or_none_answers);
    RUN_TEST(test_drawn_ones_leave_the_place_known);
    return UNITY_END();
}
