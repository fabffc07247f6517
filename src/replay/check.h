// check.h - outputs of a replay against those recorded in the log, byte for byte. Level 5.
//
// A replayed output waits for its record, which stands later in the log. Partners are found by what they answer:
// query_id for replies; goal_list_id, goal_list_revision and path_revision for paths; arm_goal_id and path_revision for the arm's. The fields that depend on the
// recording host's clock (utime, boot_id, t0_utime, valid_until_utime, planning_time) are taken over from the record
// before comparing. Renewals of a lease are left out on both sides.
//
// Memory: the outputs that wait are on the heap. Time: O(waiting) per record.
#ifndef AISLE_REPLAY_CHECK_H
#define AISLE_REPLAY_CHECK_H

#include "replay/replay.h"

#include <stdio.h>

typedef struct aisle_check_waiting aisle_check_waiting;

typedef struct aisle_check {
    FILE *report; // each difference is told here, one line
    aisle_check_waiting *first, *last;
    int64_t equal, different;
    int64_t missing;      // recorded, but the replay did not make it
    int64_t extra;        // made, but not recorded; counted by aisle_check_finish()
    aisle_path_seen seen; // the last recorded path
} aisle_check;

void aisle_check_init(aisle_check *self, FILE *report);

// One output of the replay. False: no memory.
bool aisle_check_made(aisle_check *self, aisle_channel channel, const uint8_t *bytes, size_t size);

// Is what is recorded on this channel compared? PATH, REPLY and ARM_PATH.
bool aisle_check_covers(aisle_channel channel);

// One message recorded on such a channel.
void aisle_check_recorded(aisle_check *self, aisle_channel channel, const uint8_t *bytes, size_t size);

// Counts what is left as extra and frees it. True: all equal, nothing missing or extra, and at least one compared.
bool aisle_check_finish(aisle_check *self);
#endif
