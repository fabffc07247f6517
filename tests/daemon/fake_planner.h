// fake_planner.h - a planner of a few lines behind include/aisle/planner.h, for tests of the daemon alone.
//
// Requests take `units_per_request` work units each and are answered in order by a path_t with one waypoint-free NONE
// or, with `give_paths`, a path of two waypoints. All knobs are global: one planner per program.
#ifndef AISLE_TESTS_FAKE_PLANNER_H
#define AISLE_TESTS_FAKE_PLANNER_H

#include "aisle/planner.h"

#define FAKE_LOG_MAX 4096
#define FAKE_MEMSIZE 8192U

typedef struct fake_taken {
    aisle_input_kind kind;
    int32_t id; // of the message: query_id, goal_list_id, part, seq, revision, ...
    int64_t now_us;
} fake_taken;

typedef struct fake_planner {
    // Knobs.
    uint32_t units_per_request; // 0 = 10
    uint32_t units_per_layout;  // 0 = at once
    uint32_t requests_max;      // waiting requests before BUSY; 0 = 4
    bool give_paths;
    bool refuse_all;                 // submit() answers AISLE_ERR_DATA
    bool busy_always;                // submit() answers AISLE_BUSY even when idle
    bool hang;                       // step() stays BUSY and does no work
    uint32_t units_per_cycle;        // > 0: poses and obstacles are cycles, which go before requests
    bool cycle_changes;              // each of which sends another path,
    bool cycle_renews;               // or the same one again
    int64_t lease_us;                // > 0: the last path is renewed this often
    void (*on_step)(uint32_t units); // called by step(), e.g. to let a test clock run
    // What happened.
    fake_taken taken[FAKE_LOG_MAX];
    uint32_t num_taken;
    uint32_t answered;
    uint32_t steps;
    aisle_config config;
    aisle_status_msg status; // as status() answers; boot_id and utime are filled in
} fake_planner;

extern fake_planner fake;

// All knobs and records to zero; the planner starts anew at init().
void fake_reset(void);
#endif
