// feed.h - from bytes on an input channel to the planner: the one place that does it, for aisled and aisle-replay.
// Level 5.
//
// Memory: the struct (about 240 kB, the largest message decoded). Time: O(bytes). Threads: one.
#ifndef AISLE_DAEMON_FEED_H
#define AISLE_DAEMON_FEED_H

#include "daemon/channel.h"
#include "wire/codec.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct aisle_feed {
    aisle_input_kind kind; // of the message held
    bool full;             // a decoded message is held
    aisle_msg_fault fault; // of the last load
    union {
        aisle_layout_msg layout;
        aisle_layout_patch_msg layout_patch;
        aisle_grid_chunk_msg grid;
        aisle_vehicle_msg vehicle;
        aisle_pose_msg pose;
        aisle_goal_list_msg goals;
        aisle_query_msg query;
        aisle_obstacles_msg obstacles;
        aisle_command_msg command;
        aisle_arm_goal_msg arm_goal;
    } message;
} aisle_feed;

// Decodes a message and holds it, in place of one held before. AISLE_ERR_DATA: refused whole, self->fault says why,
// nothing is held.
aisle_status aisle_feed_load(aisle_feed *self, aisle_channel channel, const void *bytes, size_t size);

// Hands the held message to the planner; it stays held on AISLE_BUSY alone. As aisle_planner_submit().
aisle_status aisle_feed_submit(aisle_feed *self, aisle_planner *planner, int64_t now_us);

// True if a message of this kind must wait until the planner is idle, so that requests before it are answered with what
// was in force when they arrived. The others may be submitted while it works.
bool aisle_feed_waits_for_idle(aisle_channel channel);
#endif
