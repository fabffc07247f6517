// messages.h - small valid messages, encoded, for tests of the daemon.
#ifndef AISLE_TESTS_MESSAGES_H
#define AISLE_TESTS_MESSAGES_H

#include "daemon/channel.h"

#include <stddef.h>
#include <stdint.h>

typedef struct test_message {
    uint8_t bytes[65000];
    size_t size;
} test_message;

// A message for an input channel whose id (as the fake planner reads it) is `id`; ends the test if it cannot be
// encoded.
const test_message *make_message(aisle_channel channel, int32_t id);

// Obstacles with a source.
const test_message *make_obstacles(int32_t source, int32_t seq);

// An encoded path_t of two waypoints.
const test_message *make_path(int32_t query_id, int32_t path_revision, int64_t utime);
#endif
