// record.h - the flight recorder: everything the planner was given and answered, as an LCM log. Level 5.
//
// A log of the bus holds what was sent; this holds what the planner was given, when, in which order, and how its work was cut
// into steps, which on a live bus hangs on the machine's load. Played back (aisle-replay finds out by itself) it gives every
// path byte for byte, whatever the times were.
// Events, with the time handed to the planner: each input that it took, as it came; on <PREFIX>_STEP each step, 4 bytes, its
// work units, big-endian (the first one, of 0 units, says what kind of log this is and is no step); each answer as sent.
//
// Memory: the struct. Threads: one. A disk that gives out ends the recording, not the daemon.
#ifndef AISLE_DAEMON_RECORD_H
#define AISLE_DAEMON_RECORD_H

#include "daemon/channel.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#define AISLE_RECORD_STEP "STEP"  // suffix of its channel
#define AISLE_RECORD_STEP_BYTES 4 // of an event on it

typedef struct aisle_record {
    FILE *file; // NULL: nothing is recorded
    int64_t number;
    char step[AISLE_CHANNEL_NAME_LEN];
    char names[AISLE_CHANNEL_COUNT][AISLE_CHANNEL_NAME_LEN];
    bool failed; // the disk gave out; told by the caller
} aisle_record;

// Begins a recording into a new file. path NULL: of nothing. False: the file cannot be written; nothing is recorded.
bool aisle_record_open(aisle_record *self, const char *path, const char *prefix, int64_t now_us);
void aisle_record_close(aisle_record *self);

// A message the planner took, or an answer of its.
void aisle_record_message(aisle_record *self, int64_t now_us, aisle_channel channel, const void *bytes, size_t size);

// A step of the planner.
void aisle_record_step(aisle_record *self, int64_t now_us, uint32_t units);

// Is this event a step of such a log with this prefix? *units: of it.
bool aisle_record_is_step(const char *prefix, const char *channel, size_t length, const uint8_t *bytes, size_t size,
                          uint32_t *units);
#endif
