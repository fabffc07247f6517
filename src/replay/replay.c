#include "replay/replay.h"

#include "base/check.h"

#include <string.h>

#define SLICE 100000U // work units; any number gives the same bytes

void aisle_replay_init(aisle_replay *self, aisle_planner *planner, aisle_replay_sink sink, void *ctx) {
    memset(self, 0, sizeof *self);
    self->planner = planner;
    self->sink = sink;
    self->ctx = ctx;
    self->now = INT64_MIN;
    self->seen.revision = -1;
}

static void pull(aisle_replay *self) {
    aisle_event event;
    while (aisle_planner_next_event(self->planner, &event)) {
        bool path = event.kind == AISLE_EVENT_PATH;
        aisle_replay_output output = {.channel = aisle_channel_of_event(event.kind),
                                      .utime = self->now,
                                      .renewal = path && aisle_path_is_renewal(&self->seen, event.bytes),
                                      .bytes = event.bytes,
                                      .size = event.size};
        self->sink(self->ctx, &output);
    }
}

static void settle(aisle_replay *self) {
    aisle_status status;
    do {
        status = aisle_planner_step(self->planner, self->now, SLICE);
        pull(self);
    } while (status == AISLE_BUSY);
}

void aisle_replay_advance(aisle_replay *self, int64_t utime) {
    int64_t deadline = self->is_stepped ? INT64_MAX : aisle_planner_next_deadline(self->planner);
    while (deadline <= utime) {
        self->now = deadline > self->now ? deadline : self->now;
        settle(self);
        int64_t next = aisle_planner_next_deadline(self->planner);
        AISLE_ASSERT(next > deadline); // or time would stand still
        deadline = next;
    }
    self->now = utime > self->now ? utime : self->now;
}

void aisle_replay_step(aisle_replay *self, int64_t utime, uint32_t units) {
    self->is_stepped = true;
    self->now = utime > self->now ? utime : self->now;
    if (units > 0U) {
        (void)aisle_planner_step(self->planner, self->now, units);
        pull(self);
    }
}

void aisle_replay_input(aisle_replay *self, int64_t utime, aisle_channel channel, const void *bytes, size_t size) {
    aisle_replay_advance(self, utime);
    self->inputs++;
    if (aisle_feed_load(&self->feed, channel, bytes, size) != AISLE_OK) {
        self->malformed++;
        return;
    }
    aisle_status status = aisle_feed_submit(&self->feed, self->planner, self->now);
    if (status == AISLE_BUSY && !self->is_stepped) { // an idle planner takes everything
        settle(self);
        status = aisle_feed_submit(&self->feed, self->planner, self->now);
    }
    self->refused += status < 0 || status == AISLE_BUSY ? 1 : 0;
    if (!self->is_stepped) {
        settle(self);
    }
}
