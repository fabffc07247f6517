#include "daemon/notify.h" // first: proves that the header stands alone

#include "unity.h"

#include <errno.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

static aisle_notify self;
static int listener;
static char name[108], got[64];

// Listens as systemd does. The socket's place is `name`, '@' in front meaning abstract.
static void listen_at(const char *where) {
    struct sockaddr_un address = {.sun_family = AF_UNIX};
    size_t length = strlen(where);
    memcpy(address.sun_path, where, length);
    if (where[0] == '@') {
        address.sun_path[0] = '\0';
    }
    listener = socket(AF_UNIX, SOCK_DGRAM, 0);
    TEST_ASSERT_TRUE(listener >= 0);
    socklen_t size = (socklen_t)(offsetof(struct sockaddr_un, sun_path) + length);
    TEST_ASSERT_EQUAL_MESSAGE(0, bind(listener, (const struct sockaddr *)&address, size), strerror(errno));
}
static const char *receive(void) {
    ssize_t n = recv(listener, got, sizeof got - 1, MSG_DONTWAIT);
    got[n > 0 ? n : 0] = '\0';
    return got;
}
void setUp(void) {
    (void)snprintf(name, sizeof name, "@aisle_test_notify_%ld", (long)getpid());
    listener = -1;
}
void tearDown(void) {
    aisle_notify_close(&self);
    if (listener >= 0) {
        (void)close(listener);
    }
}

static void test_without_a_socket_all_calls_do_nothing(void) {
    static const char *const bad[] = {NULL, "", "@", "/", "relative/path", "vsock:2:1"};
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        TEST_ASSERT_FALSE(aisle_notify_open(&self, bad[i], "1000", NULL));
        TEST_ASSERT_FALSE(aisle_notify_send(&self, "READY=1"));
        TEST_ASSERT_FALSE(aisle_notify_ping(&self, 1, true));
    }
}
static void test_name_too_long_for_a_socket_is_refused(void) {
    char longest[200];
    memset(longest, 'x', sizeof longest);
    longest[0] = '/';
    longest[sizeof longest - 1] = '\0';
    TEST_ASSERT_FALSE(aisle_notify_open(&self, longest, NULL, NULL));
}
static void test_ready_arrives_at_an_abstract_socket(void) {
    listen_at(name);
    TEST_ASSERT_TRUE(aisle_notify_open(&self, name, NULL, NULL));
    TEST_ASSERT_TRUE(aisle_notify_send(&self, "READY=1"));
    TEST_ASSERT_EQUAL_STRING("READY=1", receive());
    TEST_ASSERT_EQUAL_STRING("", receive());
}
static void test_ready_arrives_at_a_path(void) {
    (void)snprintf(name, sizeof name, "/tmp/aisle_test_notify_%ld", (long)getpid());
    (void)unlink(name);
    listen_at(name);
    TEST_ASSERT_TRUE(aisle_notify_open(&self, name, NULL, NULL));
    TEST_ASSERT_TRUE(aisle_notify_send(&self, "STOPPING=1"));
    TEST_ASSERT_EQUAL_STRING("STOPPING=1", receive());
    (void)unlink(name);
}
static void test_watchdog_is_pinged_every_half_period_and_only_on_progress(void) {
    listen_at(name);
    TEST_ASSERT_TRUE(aisle_notify_open(&self, name, "2000000", NULL));
    TEST_ASSERT_EQUAL_INT64(1000000, self.period_us);
    TEST_ASSERT_TRUE(aisle_notify_ping(&self, 5000000, true));
    TEST_ASSERT_EQUAL_STRING("WATCHDOG=1", receive());
    TEST_ASSERT_FALSE(aisle_notify_ping(&self, 5999999, true));
    TEST_ASSERT_FALSE(aisle_notify_ping(&self, 9000000, false));
    TEST_ASSERT_EQUAL_STRING("", receive());
    TEST_ASSERT_TRUE(aisle_notify_ping(&self, 9000001, true));
    TEST_ASSERT_EQUAL_STRING("WATCHDOG=1", receive());
}
static void test_watchdog_of_another_process_or_no_number_is_not_served(void) {
    char own[32];
    (void)snprintf(own, sizeof own, "%ld", (long)getpid());
    TEST_ASSERT_TRUE(aisle_notify_open(&self, name, "2000000", "1"));
    TEST_ASSERT_EQUAL_INT64(0, self.period_us);
    aisle_notify_close(&self);
    TEST_ASSERT_TRUE(aisle_notify_open(&self, name, "2000000", own));
    TEST_ASSERT_EQUAL_INT64(1000000, self.period_us);
    static const char *const bad[] = {"", "-5", "2s", "99999999999999999999"};
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        aisle_notify_close(&self);
        TEST_ASSERT_TRUE(aisle_notify_open(&self, name, bad[i], NULL));
        TEST_ASSERT_EQUAL_INT64(0, self.period_us);
    }
}
static void test_listener_that_is_gone_or_full_does_not_hold_us_up(void) {
    TEST_ASSERT_TRUE(aisle_notify_open(&self, name, NULL, NULL));
    TEST_ASSERT_FALSE(aisle_notify_send(&self, "READY=1")); // nobody there
    listen_at(name);
    int sent = 0;
    while (sent < 100000 && aisle_notify_send(&self, "WATCHDOG=1")) {
        sent++;
    }
    TEST_ASSERT_TRUE(sent > 0 && sent < 100000); // full: answers instead of waiting
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_without_a_socket_all_calls_do_nothing);
    RUN_TEST(test_name_too_long_for_a_socket_is_refused);
    RUN_TEST(test_ready_arrives_at_an_abstract_socket);
    RUN_TEST(test_ready_arrives_at_a_path);
    RUN_TEST(test_watchdog_is_pinged_every_half_period_and_only_on_progress);
    RUN_TEST(test_watchdog_of_another_process_or_no_number_is_not_served);
    RUN_TEST(test_listener_that_is_gone_or_full_does_not_hold_us_up);
    return UNITY_END();
}
