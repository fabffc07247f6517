#include "replay/check.h"

#include "base/check.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

struct aisle_check_waiting {
    aisle_check_waiting *next;
    aisle_channel channel;
    size_t size;
    uint8_t bytes[]; // [size]
};

// Fields before the waypoints, in their order.
static const char *const path_fields[] = {
    "utime",
    "boot_id",
    "path_revision",
    "query_id",
    "goal_list_id",
    "goal_list_revision",
    "map_id",
    "map_revision",
    "vehicle_revision",
    "pose_utime",
    "obstacles_utime",
    "t0_utime",
    "valid_until_utime",
    "status",
    "cause",
    "cause_id",
    "cause_value",
    "planner",
    "cached",
    "work_units",
    "num_base",
    "length",
    "length_bound",
    "duration",
    "energy",
    "risk",
    "clearance_min",
    "clearance_moving_min",
    "planning_time",
    "certificate",
    "num_waypoints",
};
enum { PATH_FIELDS = sizeof path_fields / sizeof path_fields[0] };

static const char *const arm_fields[] = {
    "utime",        "boot_id",          "path_revision", "arm_goal_id",       "map_id",
    "map_revision", "vehicle_revision", "t0_utime",      "valid_until_utime", "status",
    "cause",        "cause_id",         "planner",       "work_units",        "clearance_min",
    "duration",     "travel",           "num_waypoints",
};
enum { ARM_FIELDS = sizeof arm_fields / sizeof arm_fields[0] };

bool aisle_check_covers(aisle_channel channel) {
    return channel == AISLE_CHANNEL_PATH || channel == AISLE_CHANNEL_REPLY || channel == AISLE_CHANNEL_ARM_PATH;
}

static size_t offset_of(aisle_channel channel, const char *field) {
    size_t offset = 0;
    const bool is_known = aisle_msg_field_offset(aisle_channel_type(channel), field, &offset);
    AISLE_ASSERT(is_known);
    return offset;
}

static int32_t int32_of(aisle_channel channel, const uint8_t *bytes, const char *field) {
    const uint8_t *at = bytes + offset_of(channel, field);
    return (int32_t)((uint32_t)at[0] << 24 | (uint32_t)at[1] << 16 | (uint32_t)at[2] << 8 | (uint32_t)at[3]);
}

void aisle_check_init(aisle_check *self, FILE *report) {
    memset(self, 0, sizeof *self);
    self->report = report;
    self->seen.revision = -1;
}

bool aisle_check_made(aisle_check *self, aisle_channel channel, const uint8_t *bytes, size_t size) {
    aisle_check_waiting *item = malloc(sizeof *item + size);
    if (item == NULL) {
        return false;
    }
    item->next = NULL;
    item->channel = channel;
    item->size = size;
    memcpy(item->bytes, bytes, size);
    if (self->last == NULL) {
        self->first = item;
    } else {
        self->last->next = item;
    }
    self->last = item;
    return true;
}

static bool same_field(aisle_channel channel, const uint8_t *a, const uint8_t *b, const char *field) {
    return int32_of(channel, a, field) == int32_of(channel, b, field);
}

static bool are_partners(const aisle_check_waiting *item, aisle_channel channel, const uint8_t *bytes) {
    if (item->channel != channel) {
        return false;
    }
    if (channel == AISLE_CHANNEL_REPLY) {
        return same_field(channel, item->bytes, bytes, "query_id");
    }
    if (channel == AISLE_CHANNEL_ARM_PATH) {
        return same_field(channel, item->bytes, bytes, "arm_goal_id") &&
               same_field(channel, item->bytes, bytes, "path_revision");
    }
    return same_field(channel, item->bytes, bytes, "goal_list_id") &&
           same_field(channel, item->bytes, bytes, "goal_list_revision") &&
           same_field(channel, item->bytes, bytes, "path_revision");
}

static aisle_check_waiting *take_partner(aisle_check *self, aisle_channel channel, const uint8_t *bytes) {
    aisle_check_waiting *before = NULL;
    for (aisle_check_waiting *item = self->first; item != NULL; before = item, item = item->next) {
        if (!are_partners(item, channel, bytes)) {
            continue;
        }
        if (before == NULL) {
            self->first = item->next;
        } else {
            before->next = item->next;
        }
        self->last = self->last == item ? before : self->last;
        return item;
    }
    return NULL;
}

static void take_over_clock(aisle_channel channel, uint8_t *to, const uint8_t *from) {
    static const char *const fields[] = {"utime", "boot_id", "t0_utime", "valid_until_utime"};
    for (size_t i = 0; i < sizeof fields / sizeof fields[0]; i++) {
        const size_t at = offset_of(channel, fields[i]);
        memcpy(to + at, from + at, sizeof(int64_t));
    }
    if (channel != AISLE_CHANNEL_ARM_PATH) {
        const size_t at = offset_of(channel, "planning_time");
        memcpy(to + at, from + at, sizeof(float));
    }
}

static void tell(const aisle_check *self, aisle_channel channel, const uint8_t *path, const char *what) {
    if (channel == AISLE_CHANNEL_REPLY) {
        (void)fprintf(self->report, "REPLY query %" PRId32 ": %s\n", aisle_path_int32(path, "query_id"), what);
    } else if (channel == AISLE_CHANNEL_ARM_PATH) {
        (void)fprintf(self->report, "ARM_PATH goal %" PRId32 " revision %" PRId32 ": %s\n",
                      int32_of(channel, path, "arm_goal_id"), int32_of(channel, path, "path_revision"), what);
    } else {
        (void)fprintf(self->report, "PATH goals %" PRId32 ".%" PRId32 " revision %" PRId32 ": %s\n",
                      aisle_path_int32(path, "goal_list_id"), aisle_path_int32(path, "goal_list_revision"),
                      aisle_path_int32(path, "path_revision"), what);
    }
}

// Says where two paths of any sizes part.
static void tell_difference(const aisle_check *self, const aisle_check_waiting *made, const uint8_t *bytes,
                            size_t size) {
    size_t both = made->size < size ? made->size : size, at = 0;
    while (at < both && made->bytes[at] == bytes[at]) {
        at++;
    }
    const bool is_arm = made->channel == AISLE_CHANNEL_ARM_PATH;
    const char *const *fields = is_arm ? arm_fields : path_fields;
    const char *field = "fingerprint";
    const size_t waypoints = offset_of(made->channel, "num_waypoints") + sizeof(int16_t);
    for (int i = 0; i < (is_arm ? (int)ARM_FIELDS : (int)PATH_FIELDS); i++) {
        field = offset_of(made->channel, fields[i]) <= at ? fields[i] : field;
    }
    char what[160];
    const size_t each =
        aisle_msg_max_size(is_arm ? AISLE_MSG_ARM_WAYPOINT : AISLE_MSG_WAYPOINT) - AISLE_MSG_FINGERPRINT_SIZE;
    if (at < waypoints) {
        (void)snprintf(what, sizeof what, "differs in %s (byte %zu)", field, at);
    } else {
        (void)snprintf(what, sizeof what, "differs in waypoint %zu (byte %zu)", (at - waypoints) / each, at);
    }
    tell(self, made->channel, bytes, what);
}

void aisle_check_recorded(aisle_check *self, aisle_channel channel, const uint8_t *bytes, size_t size) {
    const aisle_msg_type type = aisle_channel_type(channel);
    if (aisle_msg_check(type, bytes, size, NULL) != AISLE_OK) {
        self->different++;
        (void)fprintf(self->report, "%s: the record is not a %s\n", aisle_channel_suffix(channel),
                      aisle_msg_name(type));
        return;
    }
    if (channel == AISLE_CHANNEL_PATH && aisle_path_is_renewal(&self->seen, bytes)) {
        return;
    }
    aisle_check_waiting *made = take_partner(self, channel, bytes);
    if (made == NULL) {
        self->missing++;
        tell(self, channel, bytes, "recorded, but not made again");
        return;
    }
    take_over_clock(channel, made->bytes, bytes);
    if (made->size == size && memcmp(made->bytes, bytes, size) == 0) {
        self->equal++;
    } else {
        self->different++;
        tell_difference(self, made, bytes, size);
    }
    free(made);
}

bool aisle_check_finish(aisle_check *self) {
    while (self->first != NULL) {
        aisle_check_waiting *item = self->first;
        self->extra++;
        tell(self, item->channel, item->bytes, "made, but not recorded");
        self->first = item->next;
        free(item);
    }
    self->last = NULL;
    return self->equal > 0 && self->different == 0 && self->missing == 0 && self->extra == 0;
}
