// replay.h - inputs of a log through the planner, with the log's times as the clock. Level 5.
//
// Every input is planned to its end before the next one, as aisled's order makes it look (daemon/inbox.h). What the
// planner does by itself (lease, stale pose) it does at its deadline, in log time. Nothing depends on the host's clock.
// A log of the flight recorder (daemon/record.h) tells how the work was cut into steps: from its first one on only its
// steps are made, so the planner is at every message what it was.
#ifndef AISLE_REPLAY_REPLAY_H
#define AISLE_REPLAY_REPLAY_H

#include "daemon/channel.h"
#include "daemon/feed.h"
#include "daemon/log.h"
#include "daemon/path_bytes.h"

#include <stdbool.h>
#include <stdint.h>

// One output of the planner, pulled while an input is being worked on. Valid during the call.
typedef struct aisle_replay_output {
    aisle_channel channel; // PATH, REPLY or ARM_PATH
    int64_t utime;         // log time
    bool renewal;          // the last path again, its lease renewed
    const uint8_t *bytes;
    size_t size;
} aisle_replay_output;

typedef void (*aisle_replay_sink)(void *ctx, const aisle_replay_output *output);

typedef struct aisle_replay {
    aisle_planner *planner;
    aisle_replay_sink sink;
    void *ctx;
    int64_t now;                        // log time, never backwards
    bool is_stepped;                    // the log tells the steps
    aisle_path_seen seen;               // the last path
    int64_t inputs, malformed, refused; // fed; refused by the decoder; refused by the planner
    aisle_feed feed;
} aisle_replay;

// planner: just made. Both live as long as the replay.
void aisle_replay_init(aisle_replay *self, aisle_planner *planner, aisle_replay_sink sink, void *ctx);

// Feeds one input message at its log time.
void aisle_replay_input(aisle_replay *self, int64_t utime, aisle_channel channel, const void *bytes, size_t size);

// A step as recorded; the first one, of 0 units, only says that the log tells them.
void aisle_replay_step(aisle_replay *self, int64_t utime, uint32_t units);

// Lets time pass: everything due up to utime happens. Nothing of a log that tells its steps.
void aisle_replay_advance(aisle_replay *self, int64_t utime);
#endif
