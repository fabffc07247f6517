#include "plan/verify_parts.h"

#include "base/check.h"
#include "base/crc32.h"
#include "base/digest.h"
#include "wire/codec.h"

#include <string.h>

// ---- certificate

#define WAYPOINT_BYTES 64 // above what one takes

static uint32_t crc_number(uint32_t crc, int32_t number) {
    uint32_t bits = (uint32_t)number;
    uint8_t bytes[4] = {(uint8_t)(bits >> 24), (uint8_t)(bits >> 16), (uint8_t)(bits >> 8), (uint8_t)bits};
    return aisle_crc32(crc, bytes, sizeof bytes);
}

uint32_t aisle_path_certificate(const aisle_path_msg *path) {
    uint32_t crc = 0;
    AISLE_ASSERT(path->num_waypoints >= 0 && path->num_waypoints <= AISLE_PATH_MAX_WAYPOINTS);
    for (int32_t i = 0; i < path->num_waypoints; i++) {
        uint8_t bytes[WAYPOINT_BYTES];
        size_t size = 0;
        if (aisle_msg_encode_body(AISLE_MSG_WAYPOINT, &path->waypoints[i], bytes, sizeof bytes, &size) != AISLE_OK) {
            return 0; // a number in it is not finite: no encoder will take it
        }
        crc = aisle_crc32(crc, bytes, size);
    }
    const int32_t numbers[] = {path->path_revision, path->query_id,     path->goal_list_id,    path->goal_list_revision,
                               path->map_id,        path->map_revision, path->vehicle_revision};
    for (size_t i = 0; i < sizeof numbers / sizeof numbers[0]; i++) {
        crc = crc_number(crc, numbers[i]);
    }
    return crc;
}

uint32_t aisle_release_certificate(uint32_t waypoints, const uint8_t *bytes) {
    return aisle_crc32(waypoints, bytes + AISLE_PATH_AT_REVISION, AISLE_PATH_AT_POSE_UTIME - AISLE_PATH_AT_REVISION);
}

aisle_status aisle_path_encode(aisle_path_msg *path, uint8_t *bytes, size_t capacity, size_t *size) {
    aisle_status st = aisle_msg_encode(AISLE_MSG_PATH, path, bytes, capacity, size);
    if (st == AISLE_OK) {
        AISLE_ASSERT(*size >= AISLE_PATH_AT_WAYPOINTS);
        uint32_t waypoints = aisle_crc32(0, bytes + AISLE_PATH_AT_WAYPOINTS, *size - AISLE_PATH_AT_WAYPOINTS);
        path->certificate = (int32_t)aisle_release_certificate(waypoints, bytes);
        aisle_msg_put_int32(bytes + AISLE_PATH_AT_CERTIFICATE, path->certificate);
    }
    return st;
}

void aisle_path_rehead(uint8_t *bytes, const aisle_path_msg *head, uint32_t waypoints) {
    const int64_t first[] = {head->utime, head->boot_id};
    const int32_t ids[] = {head->path_revision, head->query_id,     head->goal_list_id,    head->goal_list_revision,
                           head->map_id,        head->map_revision, head->vehicle_revision};
    const int64_t times[] = {head->pose_utime, head->obstacles_utime, head->t0_utime, head->valid_until_utime};
    uint8_t *at = bytes + AISLE_PATH_AT_UTIME;
    for (size_t i = 0; i < sizeof first / sizeof first[0]; i++, at += 8) {
        aisle_msg_put_int64(at, first[i]);
    }
    for (size_t i = 0; i < sizeof ids / sizeof ids[0]; i++, at += 4) {
        aisle_msg_put_int32(at, ids[i]);
    }
    for (size_t i = 0; i < sizeof times / sizeof times[0]; i++, at += 8) {
        aisle_msg_put_int64(at, times[i]);
    }
    AISLE_ASSERT(at == bytes + AISLE_PATH_AT_STATUS);
    bytes[AISLE_PATH_AT_CACHED] = head->cached != 0 ? 1U : 0U;
    aisle_msg_put_int32(bytes + AISLE_PATH_AT_WORK_UNITS, head->work_units);
    aisle_msg_put_int32(bytes + AISLE_PATH_AT_CERTIFICATE, (int32_t)aisle_release_certificate(waypoints, bytes));
}

// ---- digests

bool aisle_release_digest(const uint8_t *bytes, size_t size, uint64_t *stamp, uint64_t *path) {
    uint8_t head[AISLE_PATH_AT_WAYPOINTS];
    if (bytes == NULL || size < sizeof head) {
        return false;
    }
    const uint64_t waypoints = aisle_digest(0, bytes + sizeof head, size - sizeof head);
    memcpy(head, bytes, sizeof head);
    memset(head + AISLE_PATH_AT_UTIME, 0, 8);
    memset(head + AISLE_PATH_AT_VALID_UNTIL_UTIME, 0, 8);
    memset(head + AISLE_PATH_AT_WORK_UNITS, 0, 4);
    memset(head + AISLE_PATH_AT_CLEARANCE_MOVING, 0, 4);
    *stamp = aisle_digest(waypoints, head, sizeof head);
    if (path != NULL) {
        memcpy(head + AISLE_PATH_AT_CLEARANCE_MOVING, bytes + AISLE_PATH_AT_CLEARANCE_MOVING, 4);
        head[AISLE_PATH_AT_CACHED] = 0;
        memset(head + AISLE_PATH_AT_CERTIFICATE, 0, 4);
        *path = aisle_digest(waypoints, head + AISLE_PATH_AT_STATUS, sizeof head - AISLE_PATH_AT_STATUS);
    }
    return true;
}

// ---- the way out

static bool is_proved(const uint8_t *bytes, size_t size, const aisle_stamp *stamp) {
    uint64_t digest;
    if (stamp == NULL || stamp->size == 0 || (size_t)stamp->size != size) {
        return false;
    }
    return aisle_release_digest(bytes, size, &digest, NULL) && digest == stamp->digest;
}

// A path_t of status NONE: nothing to drive; its few waypoints tell the reason.
static bool is_revocation(const uint8_t *bytes, size_t size) {
    const size_t status = AISLE_PATH_AT_STATUS, count = AISLE_PATH_AT_NUM_WAYPOINTS;
    if (bytes == NULL || aisle_msg_check(AISLE_MSG_PATH, bytes, size, NULL) != AISLE_OK) {
        return false;
    }
    AISLE_ASSERT(count + 2 <= size);
    return bytes[status] == AISLE_PATH_NONE && bytes[count] == 0 && bytes[count + 1] <= AISLE_RELEASE_TOLD_MAX;
}

static uint64_t number_at(const uint8_t *bytes, size_t at, size_t size) {
    uint64_t value = 0;
    for (size_t i = 0; i < size; i++) {
        value = value << 8 | bytes[at + i];
    }
    return value;
}

// No clearance from movers is told but what was proved.
static bool is_clearance_proved(const uint8_t *bytes, float proved) {
    const uint32_t bits = (uint32_t)number_at(bytes, AISLE_PATH_AT_CLEARANCE_MOVING, 4);
    float told;
    memcpy(&told, &bits, sizeof told);
    return told >= 0.0F && told <= proved; // false for NaN
}

// May these bytes, proved on the layout, be driven until the lease in them ends?
static bool is_lease_proved(const uint8_t *bytes, const aisle_stamp *stamp, const aisle_moving_stamp *moving) {
    if (bytes[AISLE_PATH_AT_STATUS] == AISLE_PATH_STOP) {
        return is_clearance_proved(bytes, 0.0F);
    }
    return moving != NULL && moving->size == stamp->size && moving->digest == stamp->digest &&
           (int64_t)number_at(bytes, AISLE_PATH_AT_VALID_UNTIL_UTIME, 8) <= moving->until_us &&
           is_clearance_proved(bytes, moving->clearance);
}

aisle_status aisle_release(aisle_event_kind kind, const uint8_t *bytes, size_t size, const aisle_stamp *stamp,
                           const aisle_moving_stamp *moving, aisle_event *event) {
    if (event == NULL || (kind != AISLE_EVENT_PATH && kind != AISLE_EVENT_REPLY)) {
        return AISLE_ERR_ARG;
    }
    const bool may_leave =
        is_proved(bytes, size, stamp)
            ? (kind == AISLE_EVENT_REPLY ? is_clearance_proved(bytes, 0.0F) : is_lease_proved(bytes, stamp, moving))
            : is_revocation(bytes, size);
    if (!may_leave) {
        return AISLE_ERR_ARG;
    }
    *event = (aisle_event){.kind = kind, .bytes = bytes, .size = size};
    return AISLE_OK;
}
