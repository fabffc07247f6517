#include "daemon/log.h"

#include "base/check.h"

#include <string.h>
#include <sys/types.h>

#define SYNC 0xEDA1DA01U
#define HEADER 28U

static uint32_t get32(const uint8_t *at) {
    return (uint32_t)at[0] << 24 | (uint32_t)at[1] << 16 | (uint32_t)at[2] << 8 | (uint32_t)at[3];
}

static int64_t get64(const uint8_t *at) {
    uint64_t bits = (uint64_t)get32(at) << 32 | get32(at + 4);
    int64_t value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static void put32(uint8_t *at, uint32_t value) {
    for (int i = 0; i < 4; i++) {
        at[i] = (uint8_t)(value >> (24 - 8 * i));
    }
}

static void put64(uint8_t *at, int64_t value) {
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    put32(at, (uint32_t)(bits >> 32));
    put32(at + 4, (uint32_t)bits);
}

static bool read_at(aisle_log_reader *self, int64_t at, void *out, size_t size) {
    return fseeko(self->file, (off_t)at, SEEK_SET) == 0 && fread(out, 1, size, self->file) == size;
}

bool aisle_log_open(aisle_log_reader *self, FILE *file) {
    memset(self, 0, sizeof *self);
    self->file = file;
    if (fseeko(file, 0, SEEK_END) != 0) {
        return false;
    }
    self->end = (int64_t)ftello(file);
    return self->end >= 0 && fseeko(file, 0, SEEK_SET) == 0;
}

// Puts `at` on the next sync word behind it, or on the end.
static void resync(aisle_log_reader *self) {
    int64_t from = self->at++;
    uint32_t window = 0;
    if (fseeko(self->file, (off_t)self->at, SEEK_SET) != 0) {
        self->at = self->end;
    }
    for (int64_t position = self->at; self->at < self->end; position++) {
        int c = getc(self->file);
        if (c == EOF) {
            self->at = self->end;
            break;
        }
        window = window << 8 | (uint32_t)c;
        if (window == SYNC && position - from >= 4) {
            self->at = position - 3;
            break;
        }
    }
    self->garbage_bytes += self->at - from;
}

typedef enum verdict { EVENT, LONG_EVENT, CUT_OFF, GARBAGE } verdict;

// Judges the event at self->at by its header; *next is where the one behind it begins.
static verdict judge(aisle_log_reader *self, uint8_t header[HEADER], int64_t *next) {
    size_t left = (uint64_t)(self->end - self->at) < HEADER ? (size_t)(self->end - self->at) : HEADER;
    memset(header, 0, HEADER);
    if (!read_at(self, self->at, header, left) || get32(header) != SYNC) {
        return GARBAGE;
    }
    if (left < HEADER) {
        return CUT_OFF;
    }
    uint32_t name = get32(header + 20), data = get32(header + 24);
    if (name == 0 || name > AISLE_LOG_CHANNEL_MAX || data > AISLE_LOG_DATA_MAX) {
        return GARBAGE;
    }
    *next = self->at + (int64_t)HEADER + (int64_t)name + (int64_t)data;
    if (*next > self->end) {
        return CUT_OFF;
    }
    return data > AISLE_MSG_DATAGRAM_MAX ? LONG_EVENT : EVENT;
}

static bool read_event(aisle_log_reader *self, const uint8_t header[HEADER], aisle_log_event *out) {
    *out = (aisle_log_event){.number = get64(header + 4),
                             .utime = get64(header + 12),
                             .channel = self->channel,
                             .channel_length = get32(header + 20),
                             .bytes = self->bytes,
                             .size = get32(header + 24)};
    return read_at(self, self->at + (int64_t)HEADER, self->channel, out->channel_length) &&
           fread(self->bytes, 1, out->size, self->file) == out->size;
}

bool aisle_log_next(aisle_log_reader *self, aisle_log_event *out) {
    while (self->at < self->end) {
        uint8_t header[HEADER];
        int64_t next = self->end;
        verdict v = judge(self, header, &next);
        if (v == EVENT && read_event(self, header, out)) {
            self->at = next;
            self->events++;
            return true;
        }
        if (v == LONG_EVENT) {
            self->oversize++;
            self->at = next;
        } else {
            self->cut_off += v == CUT_OFF ? 1 : 0;
            resync(self);
        }
    }
    return false;
}

bool aisle_log_write(FILE *file, const aisle_log_event *event) {
    AISLE_ASSERT(event->channel_length > 0 && event->channel_length <= AISLE_LOG_CHANNEL_MAX);
    uint8_t header[HEADER];
    put32(header, SYNC);
    put64(header + 4, event->number);
    put64(header + 12, event->utime);
    put32(header + 20, (uint32_t)event->channel_length);
    put32(header + 24, (uint32_t)event->size);
    return fwrite(header, 1, sizeof header, file) == sizeof header &&
           fwrite(event->channel, 1, event->channel_length, file) == event->channel_length &&
           fwrite(event->bytes, 1, event->size, file) == event->size;
}
