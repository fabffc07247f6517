// log.h - LCM event logs, read and written without LCM. Level 5.
//
// Format, all big-endian: sync word 0xEDA1DA01, event number (8 bytes), time (8, us since the epoch), length of the
// channel name (4), length of the data (4), channel name without an end, data.
//
// Memory: the struct. Reading survives anything: garbage is skipped up to the next sync word that begins a plausible
// event, an event cut off by the end of the file is left out, one too long to be ours is stepped over; all are counted.
#ifndef AISLE_DAEMON_LOG_H
#define AISLE_DAEMON_LOG_H

#include "wire/codec.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#define AISLE_LOG_CHANNEL_MAX 63U      // characters, LCM's limit
#define AISLE_LOG_DATA_MAX (1U << 28U) // bytes, LCM's limit; more is not plausible

typedef struct aisle_log_event {
    int64_t number, utime;
    const char *channel; // not ended by a zero
    size_t channel_length;
    const uint8_t *bytes;
    size_t size;
} aisle_log_event;

typedef struct aisle_log_reader {
    FILE *file;                                       // the caller's, seekable
    int64_t end;                                      // its length, bytes
    int64_t at;                                       // of the next event
    int64_t events, oversize, cut_off, garbage_bytes; // read; too long to be ours; cut off by the end; skipped
    char channel[AISLE_LOG_CHANNEL_MAX];
    uint8_t bytes[AISLE_MSG_DATAGRAM_MAX];
} aisle_log_reader;

// False: the file cannot be measured.
bool aisle_log_open(aisle_log_reader *self, FILE *file);

// The next event, valid until the next call. False: the end.
bool aisle_log_next(aisle_log_reader *self, aisle_log_event *out);

// Appends an event. channel: at most AISLE_LOG_CHANNEL_MAX characters. False: the file would not take it.
bool aisle_log_write(FILE *file, const aisle_log_event *event);
#endif
