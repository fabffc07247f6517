// host.h - who plans for the simulated vehicle: the core alone, or a daemon on a bus. Level 5.
//
// A host takes the simulation's messages, lets time pass and hands back what the planner sends. Both take and give the
// very bytes of the bus and may write them all, in their order, to an LCM log.
//
//     core   the planner in this process on the simulation's clock, fed by the same code as aisle-replay's (replay.h):
//            each input acts at its time, what the planner does by itself at its deadline; planning takes no time on
//            that clock. So a log replays to the same bytes by construction, and a seed gives the same log.
//            Or at so many work units a millisecond (aisle_sim_host_slice()): then planning takes time, inputs wait
//            for it as aisled's do, and the log is the flight recorder's (daemon/record.h), which replays, too.
//     bus    aisled over LCM in real time: letting time pass waits for the computer's clock. aisled's own record
//            (daemon/record.h) replays to the same bytes; this log holds what was on the bus.
//
// Memory: the struct. Threads: one, and liblcm's.
#ifndef AISLE_SIM_HOST_H
#define AISLE_SIM_HOST_H

#include "daemon/engine.h"
#include "daemon/histogram.h"
#include "daemon/log.h"
#include "daemon/record.h"
#include "replay/replay.h"
#include "sim/post.h"

// One message of the planner's: PATH, REPLY, STATUS. Valid during the call.
typedef void (*aisle_sim_heard)(void *ctx, aisle_channel channel, int64_t utime, const uint8_t *bytes, size_t size);

#define AISLE_SIM_EPOCH_US 1600000000000000 // of a core host

typedef struct aisle_sim_host {
    const char *prefix; // of the channels
    aisle_sim_heard heard;
    void *ctx;
    FILE *log; // NULL: none is written
    int64_t events;
    bool failed;      // a file, the bus or memory gave out
    int64_t epoch_us; // when the simulation's time begins
    // core
    aisle_engine engine;
    aisle_replay replay;
    int64_t next_status_us;
    int32_t status_seq;
    int64_t heard_paths, heard_changes; // on PATH, and those that are no renewals
    aisle_histogram work;               // us of the computer's time for each input and each deadline, or each step
    // core at a speed
    uint32_t units_per_ms; // 0: planning takes no time
    aisle_record record;
    aisle_sim_post waiting;    // inputs that the planner does not take yet
    int64_t spent_us;          // of processor time, since the last path
    int64_t clock_us, free_us; // how far it is worked; when the step under way ends
    bool idle;
    // bus
    void *lcm; // NULL: a core host
    int fd;
    int64_t start_us;    // of the monotonic clock at the epoch
    uint32_t burst;      // messages sent without a pause
    aisle_diag_msg told; // the daemon's last one: its timers say what this drive has taken it (daemon/loop.h)
    // core: us of the work that brought a path, also the same one again with its lease renewed; at a speed: of the steps since
    // the last one, in processor time
    aisle_histogram answers;
    aisle_histogram answers_cpu; // in processor time, which others on the machine do not stretch
    aisle_histogram changes_cpu; // of them that brought another path, at once
} aisle_sim_host;

// The planner in this process, its output to `heard`. settings, log: as long as the host. AISLE_ERR_*: as
// aisle_engine_start(), message likewise.
aisle_status aisle_sim_host_start_core(aisle_sim_host *self, const aisle_settings *settings, FILE *log,
                                       aisle_sim_heard heard, void *ctx, char *message);

// From now on planning takes time: this many work units (1..1000000) a millisecond. record: a new file for the flight
// record, NULL: none. False: it cannot be written.
bool aisle_sim_host_slice(aisle_sim_host *self, uint32_t units_per_ms, const char *record);

// A daemon on this bus ("": LCM's default). AISLE_ERR_ARG: it cannot be joined; message says so.
aisle_status aisle_sim_host_start_bus(aisle_sim_host *self, const char *url, const char *prefix, FILE *log,
                                      aisle_sim_heard heard, void *ctx, char *message);

// Sends one input at its time, not before the last one's.
void aisle_sim_host_send(aisle_sim_host *self, int64_t utime, aisle_channel channel, const uint8_t *bytes, size_t size);

// Lets time pass until utime.
void aisle_sim_host_advance(aisle_sim_host *self, int64_t utime);

// Files of this module alone.
int64_t aisle_sim_host_wall_us(void); // of the computer, monotonic
int64_t aisle_sim_host_cpu_us(void);  // processor time of this thread
void aisle_sim_host_write_log(aisle_sim_host *self, int64_t utime, aisle_channel channel, const uint8_t *bytes,
                              size_t size);
void aisle_sim_host_bus_send(aisle_sim_host *self, int64_t utime, aisle_channel channel, const uint8_t *bytes,
                             size_t size);
void aisle_sim_host_bus_advance(aisle_sim_host *self, int64_t utime);
void aisle_sim_host_bus_stop(aisle_sim_host *self);
void aisle_sim_host_slow_send(aisle_sim_host *self, int64_t utime, aisle_channel channel, const uint8_t *bytes,
                              size_t size);
void aisle_sim_host_slow_advance(aisle_sim_host *self, int64_t utime);

void aisle_sim_host_stop(aisle_sim_host *self);
#endif
