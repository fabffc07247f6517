// path_bytes.h - single fields of an encoded path_t, without decoding it. Level 5.
//
// bytes: a valid encoded path_t. field: a member before the waypoints, as in path_t.lcm; another name is our own
// mistake and ends the program. Memory: none. Time: O(members).
#ifndef AISLE_DAEMON_PATH_BYTES_H
#define AISLE_DAEMON_PATH_BYTES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

size_t aisle_path_offset(const char *field);
int32_t aisle_path_int32(const uint8_t *bytes, const char *field);
void aisle_path_put_float(uint8_t *bytes, const char *field, float value);

// The last path of a stream, to tell the renewal of its lease from a new one: same path_revision and status.
// Start with {.revision = -1}.
typedef struct aisle_path_seen {
    int32_t revision;
    int8_t status;
} aisle_path_seen;

// True: a renewal of the path seen before. Remembers this one.
bool aisle_path_is_renewal(aisle_path_seen *self, const uint8_t *bytes);
#endif
