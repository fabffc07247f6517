#include "daemon/path_bytes.h"

#include "base/check.h"
#include "wire/codec.h"

#include <string.h>

size_t aisle_path_offset(const char *field) {
    size_t offset = 0;
    bool found = aisle_msg_field_offset(AISLE_MSG_PATH, field, &offset);
    AISLE_ASSERT(found);
    return offset;
}

int32_t aisle_path_int32(const uint8_t *bytes, const char *field) {
    const uint8_t *at = bytes + aisle_path_offset(field);
    uint32_t bits = (uint32_t)at[0] << 24 | (uint32_t)at[1] << 16 | (uint32_t)at[2] << 8 | (uint32_t)at[3];
    int32_t value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

void aisle_path_put_float(uint8_t *bytes, const char *field, float value) {
    uint8_t *at = bytes + aisle_path_offset(field);
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    for (int i = 0; i < 4; i++) {
        at[i] = (uint8_t)(bits >> (24 - 8 * i));
    }
}

bool aisle_path_is_renewal(aisle_path_seen *self, const uint8_t *bytes) {
    int32_t revision = aisle_path_int32(bytes, "path_revision");
    uint8_t code = bytes[aisle_path_offset("status")];
    int8_t status;
    memcpy(&status, &code, sizeof status);
    bool same = revision == self->revision && status == self->status;
    *self = (aisle_path_seen){.revision = revision, .status = status};
    return same;
}
