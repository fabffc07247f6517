#include "messages.h"

#include "unity.h"
#include "wire/codec.h"

#include <string.h>

static test_message made;

static const test_message *encode(aisle_msg_type type, const void *msg) {
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_msg_encode(type, msg, made.bytes, sizeof made.bytes, &made.size));
    return &made;
}

const test_message *make_obstacles(int32_t source, int32_t seq) {
    static aisle_obstacles_msg msg;
    msg = (aisle_obstacles_msg){.seq = seq, .source = source};
    return encode(AISLE_MSG_OBSTACLES, &msg);
}

const test_message *make_path(int32_t query_id, int32_t path_revision, int64_t utime) {
    static aisle_path_msg msg;
    memset(&msg, 0, sizeof msg);
    msg.utime = utime;
    msg.query_id = query_id;
    msg.path_revision = path_revision;
    msg.length = 2.5F;
    msg.num_waypoints = 2;
    msg.waypoints[1].x = 2.5;
    return encode(AISLE_MSG_PATH, &msg);
}

const test_message *make_message(aisle_channel channel, int32_t id) {
    static union {
        aisle_layout_msg layout;
        aisle_layout_patch_msg patch;
        aisle_grid_chunk_msg grid;
        aisle_vehicle_msg vehicle;
        aisle_pose_msg pose;
        aisle_goal_list_msg goals;
        aisle_query_msg query;
        aisle_command_msg command;
        aisle_arm_goal_msg arm_goal;
    } msg;
    memset(&msg, 0, sizeof msg);
    switch (channel) {
    case AISLE_CHANNEL_LAYOUT:
        msg.layout.part = (int16_t)id;
        break;
    case AISLE_CHANNEL_LAYOUT_PATCH:
        msg.patch.map_revision = id;
        break;
    case AISLE_CHANNEL_GRID:
        msg.grid.part = (int16_t)id;
        break;
    case AISLE_CHANNEL_VEHICLE:
        msg.vehicle.vehicle_revision = id;
        break;
    case AISLE_CHANNEL_POSE:
        msg.pose.seq = id;
        break;
    case AISLE_CHANNEL_GOALS:
        msg.goals.goal_list_id = id;
        break;
    case AISLE_CHANNEL_QUERY:
        msg.query.query_id = id;
        break;
    case AISLE_CHANNEL_COMMAND:
        msg.command.command_id = id;
        break;
    case AISLE_CHANNEL_ARM_GOAL:
        msg.arm_goal.arm_goal_id = id;
        break;
    default:
        return make_obstacles(0, id);
    }
    return encode(aisle_channel_type(channel), &msg);
}
