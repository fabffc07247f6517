#include "daemon/record.h"

#include "daemon/log.h"

#include <string.h>

static void step_name(const char *prefix, char name[AISLE_CHANNEL_NAME_LEN]) {
    (void)snprintf(name, AISLE_CHANNEL_NAME_LEN, "%.32s_%s", prefix, AISLE_RECORD_STEP);
}

static void write_event(aisle_record *self, int64_t now_us, const char *channel, const void *bytes, size_t size) {
    const aisle_log_event event = {.number = self->number++,
                                   .utime = now_us,
                                   .channel = channel,
                                   .channel_length = strlen(channel),
                                   .bytes = bytes,
                                   .size = size};
    if (!aisle_log_write(self->file, &event)) {
        self->failed = true;
        aisle_record_close(self);
    }
}

bool aisle_record_open(aisle_record *self, const char *path, const char *prefix, int64_t now_us) {
    memset(self, 0, sizeof *self);
    if (path == NULL) {
        return true;
    }
    step_name(prefix, self->step);
    for (int i = 0; i < (int)AISLE_CHANNEL_COUNT; i++) {
        aisle_channel_name(prefix, (aisle_channel)i, self->names[i]);
    }
    self->file = fopen(path, "wb");
    aisle_record_step(self, now_us, 0);
    return self->file != NULL;
}

void aisle_record_close(aisle_record *self) {
    if (self->file != NULL && fclose(self->file) != 0) {
        self->failed = true;
    }
    self->file = NULL;
}

void aisle_record_message(aisle_record *self, int64_t now_us, aisle_channel channel, const void *bytes, size_t size) {
    if (self != NULL && self->file != NULL) {
        write_event(self, now_us, self->names[channel], bytes, size);
    }
}

void aisle_record_step(aisle_record *self, int64_t now_us, uint32_t units) {
    const uint8_t bytes[AISLE_RECORD_STEP_BYTES] = {(uint8_t)(units >> 24), (uint8_t)(units >> 16),
                                                    (uint8_t)(units >> 8), (uint8_t)units};
    if (self != NULL && self->file != NULL) {
        write_event(self, now_us, self->step, bytes, sizeof bytes);
    }
}

bool aisle_record_is_step(const char *prefix, const char *channel, size_t length, const uint8_t *bytes, size_t size,
                          uint32_t *units) {
    char name[AISLE_CHANNEL_NAME_LEN];
    step_name(prefix, name);
    if (length != strlen(name) || memcmp(channel, name, length) != 0 || size != AISLE_RECORD_STEP_BYTES) {
        return false;
    }
    *units = (uint32_t)bytes[0] << 24 | (uint32_t)bytes[1] << 16 | (uint32_t)bytes[2] << 8 | bytes[3];
    return true;
}
