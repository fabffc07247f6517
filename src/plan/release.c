#include "plan/verify_parts.h"

#include "base/check.h"
#include "base/crc32.h"
#include "wire/codec.h"

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

// ---- places in the bytes

static size_t offset_of(const char *name) {
    size_t offset = 0;
    bool known = aisle_msg_field_offset(AISLE_MSG_PATH, name, &offset);
    AISLE_ASSERT(known);
    return offset;
}

// The seven revisions and ids follow one another in path_t, and the waypoints are all that comes behind their number.
uint32_t aisle_release_certificate(const uint8_t *bytes, size_t size) {
    const size_t ids = offset_of("path_revision"), ids_end = offset_of("pose_utime");
    const size_t waypoints = offset_of("num_waypoints") + 2U;
    AISLE_ASSERT(ids_end - ids == 7U * 4U && size >= waypoints);
    return aisle_crc32(aisle_crc32(0, bytes + waypoints, size - waypoints), bytes + ids, ids_end - ids);
}

aisle_status aisle_path_encode(aisle_path_msg *path, uint8_t *bytes, size_t capacity, size_t *size) {
    aisle_status st = aisle_msg_encode(AISLE_MSG_PATH, path, bytes, capacity, size);
    if (st == AISLE_OK) {
        path->certificate = (int32_t)aisle_release_certificate(bytes, *size);
        aisle_msg_put_int32(bytes + offset_of("certificate"), path->certificate);
    }
    return st;
}

// ---- crc of what is proved

bool aisle_release_crc(const uint8_t *bytes, size_t size, uint32_t *crc) {
    static const uint8_t zeros[8] = {0};
    static const struct {
        const char *name; // in the order of path_t
        size_t size;
    } open[] = {{"utime", 8}, {"valid_until_utime", 8}, {"work_units", 4}};
    size_t at = 0;
    *crc = 0;
    for (size_t i = 0; i < sizeof open / sizeof open[0]; i++) {
        size_t from = offset_of(open[i].name);
        AISLE_ASSERT(from >= at);
        if (bytes == NULL || size < from + open[i].size) {
            return false;
        }
        *crc = aisle_crc32(*crc, bytes + at, from - at);
        *crc = aisle_crc32(*crc, zeros, open[i].size);
        at = from + open[i].size;
    }
    *crc = aisle_crc32(*crc, bytes + at, size - at);
    return true;
}

// ---- the way out

static bool is_proved(const uint8_t *bytes, size_t size, const aisle_stamp *stamp) {
    uint32_t crc;
    if (stamp == NULL || stamp->size == 0 || (size_t)stamp->size != size) {
        return false;
    }
    return aisle_release_crc(bytes, size, &crc) && crc == stamp->crc;
}

// A path_t of status NONE: nothing to drive; its few waypoints tell the reason.
static bool is_revocation(const uint8_t *bytes, size_t size) {
    size_t status = offset_of("status"), count = offset_of("num_waypoints");
    if (bytes == NULL || aisle_msg_check(AISLE_MSG_PATH, bytes, size, NULL) != AISLE_OK) {
        return false;
    }
    AISLE_ASSERT(count + 2 <= size);
    return bytes[status] == AISLE_PATH_NONE && bytes[count] == 0 && bytes[count + 1] <= AISLE_RELEASE_TOLD_MAX;
}

aisle_status aisle_release(aisle_event_kind kind, const uint8_t *bytes, size_t size, const aisle_stamp *stamp,
                           aisle_event *event) {
    if (event == NULL || (kind != AISLE_EVENT_PATH && kind != AISLE_EVENT_REPLY)) {
        return AISLE_ERR_ARG;
    }
    if (!is_proved(bytes, size, stamp) && !is_revocation(bytes, size)) {
        return AISLE_ERR_ARG;
    }
    *event = (aisle_event){.kind = kind, .bytes = bytes, .size = size};
    return AISLE_OK;
}
