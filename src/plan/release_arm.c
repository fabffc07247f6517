#include "plan/verify_arm.h"

#include "base/digest.h"
#include "wire/codec.h"

static bool is_refusal(const uint8_t *bytes, size_t size) {
    size_t status, count;
    if (bytes == NULL || aisle_msg_check(AISLE_MSG_ARM_PATH, bytes, size, NULL) != AISLE_OK ||
        !aisle_msg_field_offset(AISLE_MSG_ARM_PATH, "status", &status) ||
        !aisle_msg_field_offset(AISLE_MSG_ARM_PATH, "num_waypoints", &count)) {
        return false;
    }
    return bytes[status] == AISLE_PATH_NONE && bytes[count] == 0 && bytes[count + 1U] == 0;
}

aisle_status aisle_release_arm(const uint8_t *bytes, size_t size, const aisle_stamp *stamp, aisle_event *event) {
    const bool is_proved = bytes != NULL && stamp != NULL && stamp->size != 0U && (size_t)stamp->size == size &&
                           aisle_digest(0, bytes, size) == stamp->digest;
    if (event == NULL || (!is_proved && !is_refusal(bytes, size))) {
        return AISLE_ERR_ARG;
    }
    *event = (aisle_event){.kind = AISLE_EVENT_ARM_PATH, .bytes = bytes, .size = size};
    return AISLE_OK;
}
