#include "plan/verify_arm.h" // first: proves that the header stands alone

#include "arm_door.h"
#include "base/digest.h"

// aisle_release_arm(): what bytes may leave. Bytes and their stamps are made here; that a stamp stands for a proof is
// test_verify_arm.c's.

static aisle_event event;
static aisle_stamp stamp;

void setUp(void) {
    memset(&door_path, 0, sizeof door_path);
    memset(&event, 0, sizeof event);
    door_path.arm_goal_id = 7;
    door_path.status = AISLE_PATH_OK;
    door_path.num_waypoints = 3;
    door_path.waypoints[1].t = 1.0F;
    door_path.waypoints[2].t = 2.0F;
}
void tearDown(void) {}

static void encode(void) {
    TEST_ASSERT_EQUAL(AISLE_OK,
                      aisle_msg_encode(AISLE_MSG_ARM_PATH, &door_path, door_bytes, sizeof door_bytes, &door_size));
    stamp = (aisle_stamp){.digest = aisle_digest(0, door_bytes, door_size), .size = (uint32_t)door_size};
}

static void assert_kept(const aisle_stamp *shown) {
    TEST_ASSERT_EQUAL(AISLE_ERR_ARG, aisle_release_arm(door_bytes, door_size, shown, &event));
    TEST_ASSERT_NULL(event.bytes);
    TEST_ASSERT_EQUAL_size_t(0, event.size);
}

static void test_stamped_bytes_leave_as_they_are(void) {
    encode();
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_release_arm(door_bytes, door_size, &stamp, &event));
    TEST_ASSERT_EQUAL(AISLE_EVENT_ARM_PATH, event.kind);
    TEST_ASSERT_TRUE(event.bytes == door_bytes);
    TEST_ASSERT_EQUAL_size_t(door_size, event.size);
}
static void test_no_byte_may_differ_from_what_was_stamped(void) {
    encode();
    for (size_t i = 0; i < door_size; i++) {
        door_bytes[i] ^= 1U;
        assert_kept(&stamp);
        door_bytes[i] ^= 1U;
    }
    door_size--;
    assert_kept(&stamp);
}
static void test_a_stamp_of_nothing_is_none(void) {
    encode();
    assert_kept(NULL);
    assert_kept(&(aisle_stamp){.digest = stamp.digest, .size = 0});
    assert_kept(&(aisle_stamp){.digest = 0, .size = stamp.size});
    door_size = 0;
    assert_kept(&(aisle_stamp){.digest = aisle_digest(0, door_bytes, 0), .size = 0});
}
static void test_a_refusal_needs_no_stamp_if_it_moves_nothing(void) {
    door_path.status = AISLE_PATH_NONE;
    encode();
    assert_kept(NULL); // waypoints
    door_path.num_waypoints = 0;
    encode();
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_release_arm(door_bytes, door_size, NULL, &event));
    memset(&event, 0, sizeof event);
    door_path.status = AISLE_PATH_OK; // "OK" that moves nothing is no refusal
    encode();
    assert_kept(NULL);
}
static void test_what_is_no_arm_path_is_no_refusal(void) {
    static aisle_status_msg other;
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_msg_encode(AISLE_MSG_STATUS, &other, door_bytes, sizeof door_bytes, &door_size));
    assert_kept(NULL);
    door_path.status = AISLE_PATH_NONE;
    door_path.num_waypoints = 0;
    encode();
    door_size--; // cut off
    assert_kept(NULL);
    TEST_ASSERT_EQUAL(AISLE_ERR_ARG, aisle_release_arm(NULL, door_size, &stamp, &event));
    TEST_ASSERT_EQUAL(AISLE_ERR_ARG, aisle_release_arm(door_bytes, door_size + 1U, NULL, NULL));
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_stamped_bytes_leave_as_they_are);
    RUN_TEST(test_no_byte_may_differ_from_what_was_stamped);
    RUN_TEST(test_a_stamp_of_nothing_is_none);
    RUN_TEST(test_a_refusal_needs_no_stamp_if_it_moves_nothing);
    RUN_TEST(test_what_is_no_arm_path_is_no_refusal);
    return UNITY_END();
}
