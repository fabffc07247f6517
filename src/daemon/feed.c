#include "daemon/feed.h"

#include "base/check.h"

aisle_status aisle_feed_load(aisle_feed *self, aisle_channel channel, const void *bytes, size_t size) {
    AISLE_ASSERT((int)channel < AISLE_CHANNEL_INPUTS);
    self->kind = (aisle_input_kind)channel;
    aisle_status status = aisle_msg_decode(aisle_channel_type(channel), bytes, size, &self->message, &self->fault);
    self->full = status == AISLE_OK;
    return status;
}

static aisle_input input_of(const aisle_feed *self) {
    aisle_input input = {.kind = self->kind};
    switch (self->kind) {
    case AISLE_INPUT_LAYOUT:
        input.as.layout = &self->message.layout;
        break;
    case AISLE_INPUT_LAYOUT_PATCH:
        input.as.layout_patch = &self->message.layout_patch;
        break;
    case AISLE_INPUT_GRID:
        input.as.grid = &self->message.grid;
        break;
    case AISLE_INPUT_VEHICLE:
        input.as.vehicle = &self->message.vehicle;
        break;
    case AISLE_INPUT_POSE:
        input.as.pose = &self->message.pose;
        break;
    case AISLE_INPUT_GOALS:
        input.as.goals = &self->message.goals;
        break;
    case AISLE_INPUT_QUERY:
        input.as.query = &self->message.query;
        break;
    case AISLE_INPUT_OBSTACLES:
        input.as.obstacles = &self->message.obstacles;
        break;
    case AISLE_INPUT_ARM_GOAL:
        input.as.arm_goal = &self->message.arm_goal;
        break;
    case AISLE_INPUT_COMMAND:
    default:
        input.as.command = &self->message.command;
        break;
    }
    return input;
}

aisle_status aisle_feed_submit(aisle_feed *self, aisle_planner *planner, int64_t now_us) {
    AISLE_ASSERT(self->full);
    aisle_input input = input_of(self);
    aisle_status status = aisle_planner_submit(planner, now_us, &input);
    self->full = status == AISLE_BUSY;
    return status;
}

bool aisle_feed_waits_for_idle(aisle_channel channel) {
    return channel == AISLE_CHANNEL_LAYOUT || channel == AISLE_CHANNEL_LAYOUT_PATCH || channel == AISLE_CHANNEL_GRID ||
           channel == AISLE_CHANNEL_VEHICLE;
}
