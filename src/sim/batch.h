// batch.h - drawn drives by the thousand, and what came of all of them. Level 5.
//
// Drive i of a batch is that of seed first + i (drawn.h), on a planner of its own, so each can be run again alone.
// Memory: heap, of one drive at a time.
#ifndef AISLE_SIM_BATCH_H
#define AISLE_SIM_BATCH_H

#include "sim/drawn.h"

#include <stdio.h>

typedef struct aisle_sim_batch {
    aisle_sim_kind kind;
    uint32_t num_movers;   // of each kind; 0: drawn
    uint64_t first;        // seed
    int64_t encounters;    // wanted
    int64_t episodes;      // at most
    bool told;             // one line for each drive that did not arrive, too
    uint32_t units_per_ms; // planning takes time; 0: none
    bool faults;           // some are drawn for each drive
    bool blind;            // nobody tells of the movers
    aisle_settings settings;
    // What came of it.
    int64_t done, met, arrived, unreachable, with_collision, collisions, hall_collisions, contacts_at_rest;
    int64_t revisions, stops;
    double seconds, way, separation_moving; // s of all drives, m, m
    double late;                            // sum of time over the way without movers, of those that arrived
    aisle_histogram work, answers_cpu;
} aisle_sim_batch;

void aisle_sim_batch_start(aisle_sim_batch *self, aisle_sim_kind kind, uint64_t first);

// Runs until enough encounters or drives are done; a line to `out` for each drive with a collision. False: memory gave
// out.
bool aisle_sim_batch_run(aisle_sim_batch *self, FILE *out);

const char *aisle_sim_batch_kind(const aisle_sim_batch *self); // "all" for AISLE_SIM_KIND_COUNT

// The sums, as text and as JSON.
void aisle_sim_batch_report(const aisle_sim_batch *self, double host_seconds, FILE *out);
void aisle_sim_batch_json(const aisle_sim_batch *self, double host_seconds, FILE *out);
#endif
