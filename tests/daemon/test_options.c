#include "daemon/options.h" // first: proves that the header stands alone

#include "unity.h"

#include <string.h>

static bool flag;
static const char *value;
static const aisle_option options[] = {{"--flag", &flag, NULL}, {"--value", NULL, &value}};
static const char *plain[1];
static size_t plain_count;
static char message[AISLE_OPTIONS_MESSAGE_LEN];

void setUp(void) {
    flag = false;
    value = NULL;
    message[0] = '\0';
}
void tearDown(void) {}

static bool parse(const char *a, const char *b, const char *c) {
    static char words[4][64];
    char *argv[5] = {words[0], words[1], words[2], words[3], NULL};
    const char *given[] = {"program", a, b, c};
    int argc = 0;
    for (int i = 0; i < 4 && given[i] != NULL; i++, argc++) {
        strcpy(words[i], given[i]);
    }
    return aisle_options_parse(options, 2, argc, argv, plain, 1, &plain_count, message);
}

static void test_nothing_given_is_fine(void) {
    TEST_ASSERT_TRUE(parse(NULL, NULL, NULL));
    TEST_ASSERT_FALSE(flag);
    TEST_ASSERT_EQUAL(0, plain_count);
}
static void test_flags_values_and_plain_arguments_are_read_in_any_order(void) {
    TEST_ASSERT_TRUE(parse("--value", "v", "--flag"));
    TEST_ASSERT_TRUE(flag);
    TEST_ASSERT_EQUAL_STRING("v", value);
    TEST_ASSERT_TRUE(parse("file", "--value=a=b", NULL));
    TEST_ASSERT_EQUAL_STRING("a=b", value);
    TEST_ASSERT_EQUAL(1, plain_count);
    TEST_ASSERT_EQUAL_STRING("file", plain[0]);
    TEST_ASSERT_TRUE(parse("--value=", NULL, NULL));
    TEST_ASSERT_EQUAL_STRING("", value);
    TEST_ASSERT_TRUE(parse("--value", "--flag", NULL)); // the word behind is the value, whatever it is
    TEST_ASSERT_EQUAL_STRING("--flag", value);
}
static void test_faults_are_told_in_one_line(void) {
    TEST_ASSERT_FALSE(parse("--nonsense", NULL, NULL));
    TEST_ASSERT_EQUAL_STRING("unknown option \"--nonsense\"; see --help", message);
    TEST_ASSERT_FALSE(parse("--val", "x", NULL));
    TEST_ASSERT_FALSE(parse("-f", NULL, NULL));
    TEST_ASSERT_FALSE(parse("--value", NULL, NULL));
    TEST_ASSERT_EQUAL_STRING("a value is missing for \"--value\"; see --help", message);
    TEST_ASSERT_FALSE(parse("--flag=yes", NULL, NULL));
    TEST_ASSERT_EQUAL_STRING("no value is allowed for \"--flag\"; see --help", message);
    TEST_ASSERT_FALSE(parse("one", "two", NULL));
    TEST_ASSERT_EQUAL_STRING("unexpected argument \"two\"; see --help", message);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_nothing_given_is_fine);
    RUN_TEST(test_flags_values_and_plain_arguments_are_read_in_any_order);
    RUN_TEST(test_faults_are_told_in_one_line);
    return UNITY_END();
}
