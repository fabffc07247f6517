// channel.h - the bus' channels: one table of name, message type and planner input. Level 5.
//
// A channel is called <PREFIX>_<SUFFIX>, e.g. AISLE_QUERY. Memory: none. Time: O(channels).
#ifndef AISLE_DAEMON_CHANNEL_H
#define AISLE_DAEMON_CHANNEL_H

#include "aisle/planner.h"

#include <stdbool.h>
#include <stddef.h>

// Inputs first, in the order of aisle_input_kind: an input channel and its kind are the same number.
typedef enum aisle_channel {
    AISLE_CHANNEL_LAYOUT = AISLE_INPUT_LAYOUT,
    AISLE_CHANNEL_LAYOUT_PATCH = AISLE_INPUT_LAYOUT_PATCH,
    AISLE_CHANNEL_GRID = AISLE_INPUT_GRID,
    AISLE_CHANNEL_VEHICLE = AISLE_INPUT_VEHICLE,
    AISLE_CHANNEL_POSE = AISLE_INPUT_POSE,
    AISLE_CHANNEL_GOALS = AISLE_INPUT_GOALS,
    AISLE_CHANNEL_QUERY = AISLE_INPUT_QUERY,
    AISLE_CHANNEL_OBSTACLES = AISLE_INPUT_OBSTACLES,
    AISLE_CHANNEL_COMMAND = AISLE_INPUT_COMMAND,
    AISLE_CHANNEL_ARM_GOAL = AISLE_INPUT_ARM_GOAL,
    AISLE_CHANNEL_PATH,
    AISLE_CHANNEL_REPLY,
    AISLE_CHANNEL_ARM_PATH,
    AISLE_CHANNEL_STATUS,
    AISLE_CHANNEL_DIAG,
    AISLE_CHANNEL_COUNT
} aisle_channel;

#define AISLE_CHANNEL_INPUTS ((int)AISLE_CHANNEL_PATH)
#define AISLE_CHANNEL_NAME_LEN 64 // LCM's longest name and its end

// "QUERY"; of the message on it.
const char *aisle_channel_suffix(aisle_channel channel);
aisle_msg_type aisle_channel_type(aisle_channel channel);

// Where an event of this kind goes.
aisle_channel aisle_channel_of_event(aisle_event_kind kind);

// True for the channels on which only the newest message counts (pose, vehicle, obstacles of one source).
bool aisle_channel_is_snapshot(aisle_channel channel);

// Writes "<prefix>_<suffix>". prefix: at most AISLE_SETTINGS_PREFIX_MAX characters.
void aisle_channel_name(const char *prefix, aisle_channel channel, char name[AISLE_CHANNEL_NAME_LEN]);

// The channel of that name; AISLE_CHANNEL_COUNT: none of ours. name is not ended by a zero.
aisle_channel aisle_channel_find(const char *prefix, const char *name, size_t length);
#endif
