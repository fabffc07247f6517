#include "arm_door.h"

void setUp(void) {
    door_prepare();
}
void tearDown(void) {}

static void test_a_library_without_the_arm_answers_so(void) {
    door_open();
    door_assert_cause(AISLE_STATUS_NO_ARM, 0);
    door_assert_cause(AISLE_STATUS_NO_ARM, 0);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_a_library_without_the_arm_answers_so);
    return UNITY_END();
}
