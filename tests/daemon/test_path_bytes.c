#include "daemon/path_bytes.h" // first: proves that the header stands alone

#include "messages.h"
#include "unity.h"
#include "wire/codec.h"

#include <string.h>

static aisle_path_msg path;

void setUp(void) {}
void tearDown(void) {}

static void test_fields_are_read_where_the_decoder_finds_them(void) {
    const test_message *m = make_path(-77, 0x01020304, 5);
    TEST_ASSERT_EQUAL_INT32(-77, aisle_path_int32(m->bytes, "query_id"));
    TEST_ASSERT_EQUAL_INT32(0x01020304, aisle_path_int32(m->bytes, "path_revision"));
    TEST_ASSERT_EQUAL(8, aisle_path_offset("utime"));
}
static void test_float_is_written_into_its_field_alone(void) {
    test_message m = *make_path(3, 4, 5), before = m;
    aisle_path_put_float(m.bytes, "planning_time", -0.15625F);
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_msg_decode(AISLE_MSG_PATH, m.bytes, m.size, &path, NULL));
    TEST_ASSERT_EQUAL_FLOAT(-0.15625F, path.planning_time);
    memset(m.bytes + aisle_path_offset("planning_time"), 0, 4);
    TEST_ASSERT_EQUAL_MEMORY(before.bytes, m.bytes, m.size);
}
static void test_renewal_is_the_same_revision_and_status_again(void) {
    aisle_path_seen seen = {.revision = -1, .status = 0};
    TEST_ASSERT_FALSE(aisle_path_is_renewal(&seen, make_path(0, 1, 5)->bytes));
    TEST_ASSERT_TRUE(aisle_path_is_renewal(&seen, make_path(0, 1, 6)->bytes));
    TEST_ASSERT_FALSE(aisle_path_is_renewal(&seen, make_path(0, 2, 7)->bytes));
    test_message revoked = *make_path(0, 2, 8);
    revoked.bytes[aisle_path_offset("status")] = AISLE_PATH_NONE;
    TEST_ASSERT_FALSE(aisle_path_is_renewal(&seen, revoked.bytes));
    TEST_ASSERT_TRUE(aisle_path_is_renewal(&seen, revoked.bytes));
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_fields_are_read_where_the_decoder_finds_them);
    RUN_TEST(test_float_is_written_into_its_field_alone);
    RUN_TEST(test_renewal_is_the_same_revision_and_status_again);
    return UNITY_END();
}
