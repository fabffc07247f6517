#include "daemon/channel.h"

#include "base/check.h"

#include <stdio.h>
#include <string.h>

typedef struct row {
    const char *suffix;
    aisle_msg_type type;
    bool snapshot;
} row;

static const row rows[AISLE_CHANNEL_COUNT] = {
    [AISLE_CHANNEL_LAYOUT] = {"LAYOUT", AISLE_MSG_LAYOUT, false},
    [AISLE_CHANNEL_LAYOUT_PATCH] = {"LAYOUT_PATCH", AISLE_MSG_LAYOUT_PATCH, false},
    [AISLE_CHANNEL_GRID] = {"GRID", AISLE_MSG_GRID_CHUNK, false},
    [AISLE_CHANNEL_VEHICLE] = {"VEHICLE", AISLE_MSG_VEHICLE, true},
    [AISLE_CHANNEL_POSE] = {"POSE", AISLE_MSG_POSE, true},
    [AISLE_CHANNEL_GOALS] = {"GOALS", AISLE_MSG_GOAL_LIST, false},
    [AISLE_CHANNEL_QUERY] = {"QUERY", AISLE_MSG_QUERY, false},
    [AISLE_CHANNEL_OBSTACLES] = {"OBSTACLES", AISLE_MSG_OBSTACLES, true},
    [AISLE_CHANNEL_COMMAND] = {"COMMAND", AISLE_MSG_COMMAND, false},
    [AISLE_CHANNEL_ARM_GOAL] = {"ARM_GOAL", AISLE_MSG_ARM_GOAL, false},
    [AISLE_CHANNEL_PATH] = {"PATH", AISLE_MSG_PATH, false},
    [AISLE_CHANNEL_REPLY] = {"REPLY", AISLE_MSG_PATH, false},
    [AISLE_CHANNEL_ARM_PATH] = {"ARM_PATH", AISLE_MSG_ARM_PATH, false},
    [AISLE_CHANNEL_STATUS] = {"STATUS", AISLE_MSG_STATUS, false},
    [AISLE_CHANNEL_DIAG] = {"DIAG", AISLE_MSG_DIAG, false},
};

static const row *row_of(aisle_channel channel) {
    AISLE_ASSERT((int)channel >= 0 && channel < AISLE_CHANNEL_COUNT);
    return &rows[channel];
}

const char *aisle_channel_suffix(aisle_channel channel) {
    return row_of(channel)->suffix;
}

aisle_msg_type aisle_channel_type(aisle_channel channel) {
    return row_of(channel)->type;
}

aisle_channel aisle_channel_of_event(aisle_event_kind kind) {
    if (kind == AISLE_EVENT_ARM_PATH) {
        return AISLE_CHANNEL_ARM_PATH;
    }
    return kind == AISLE_EVENT_PATH ? AISLE_CHANNEL_PATH : AISLE_CHANNEL_REPLY;
}

bool aisle_channel_is_snapshot(aisle_channel channel) {
    return row_of(channel)->snapshot;
}

void aisle_channel_name(const char *prefix, aisle_channel channel, char name[AISLE_CHANNEL_NAME_LEN]) {
    int length = snprintf(name, AISLE_CHANNEL_NAME_LEN, "%s_%s", prefix, row_of(channel)->suffix);
    AISLE_ASSERT(length > 0 && length < AISLE_CHANNEL_NAME_LEN);
}

aisle_channel aisle_channel_find(const char *prefix, const char *name, size_t length) {
    size_t front = strlen(prefix);
    if (length <= front + 1 || memcmp(name, prefix, front) != 0 || name[front] != '_') {
        return AISLE_CHANNEL_COUNT;
    }
    const char *suffix = name + front + 1;
    size_t rest = length - front - 1;
    for (int i = 0; i < (int)AISLE_CHANNEL_COUNT; i++) {
        if (strlen(rows[i].suffix) == rest && memcmp(rows[i].suffix, suffix, rest) == 0) {
            return (aisle_channel)i;
        }
    }
    return AISLE_CHANNEL_COUNT;
}
