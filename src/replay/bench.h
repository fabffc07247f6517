// bench.h - each query of a log, many times on the layout in force: milliseconds and work units. Level 5.
//
// With `again` a patch that changes nothing but the revision goes before every run, unmeasured, so that an answer
// remembered needs its whole proof.
// A run is submit() to the pulled answer on an otherwise idle planner. Each run has a query_id of its own, for a
// planner may leave out a query it has answered. Memory: the samples, on the heap. Durations are the host's monotonic
// clock.
#ifndef AISLE_REPLAY_BENCH_H
#define AISLE_REPLAY_BENCH_H

#include "replay/replay.h"

#include <stdio.h>

typedef struct aisle_bench {
    uint32_t repeat; // runs of each query
    bool again;
    double *samples; // [queries * repeat] ms
    size_t count, capacity;
    int64_t queries, failed; // failed: runs that gave no reply
    FILE *text, *json;       // json may be NULL
    aisle_query_msg query;   // the one being run
    aisle_path_msg reply;    // the last one
    uint8_t bytes[AISLE_MSG_DATAGRAM_MAX];
    size_t size; // of its bytes; 0: none
    bool answered;
} aisle_bench;

void aisle_bench_init(aisle_bench *self, uint32_t repeat, FILE *text, FILE *json);

// The sink of the replay that runs the bench.
void aisle_bench_sink(void *ctx, const aisle_replay_output *output);

// Runs one recorded query and prints its row. False: no memory.
bool aisle_bench_query(aisle_bench *self, aisle_replay *replay, int64_t utime, const uint8_t *bytes, size_t size);

// The row over all runs; frees the samples.
void aisle_bench_finish(aisle_bench *self);

// Nearest-rank percentile of count sorted values: the least one that at least `share` (0..1) of them do not exceed; 0
// if count is 0.
double aisle_bench_percentile(const double *sorted, size_t count, double share);
#endif
