// loop.h - the daemon's event loop: bus in, planner in slices, bus out, heartbeat. Level 5.
//
// One turn: wait for the bus, a signal or the next thing due; drain the bus; hand messages to the planner in order;
// step it for about 1 ms; send what it answers; send _STATUS (at its rate and on change) and _DIAG when due; tell the
// watchdog if something moved. Planning never holds up the bus or the heartbeat by more than one slice.
//
// A slice is as many work units as take AISLE_LOOP_SLICE_US of processor time at the slowest work of late; a search in hand
// holds up a pose or obstacles by that, for the planner puts their cycle before it. Kinds of work differ tenfold by the unit,
// so a slice may now and then be longer once. How long messages wait in all is timed: AISLE_TIMER_CYCLE and below.
//
// A message the planner cannot take yet stays first in line. Layout, patch, grid and vehicle also wait until the
// planner is idle (feed.h), and while a layout is taking effect all but commands and obstacles wait. So the answers
// depend on the order of the messages alone, and a log replays to the same bytes. Exceptions, for the sake of prompt
// reactions: a goal list or command ends the planning of the goal list before it, which a replay has answered by then;
// and a mission under way is planned anew for a new layout or vehicle from the newest pose, though it came later.
//
// Of a path's bytes the daemon writes one field, planning_time, which the certificate does not cover: the time spent in
// step() since the answer before it. The renewal of a lease carries the time of the path it renews.
//
// Faults found before the planner sees a message are shown in _STATUS for AISLE_LOOP_FAULT_US as cause MALFORMED or
// LIMIT, with cause_id as below, and told on stderr at most once a second; num_rejected counts them with the planner's
// own.
//
// Memory: the struct (about 330 kB); nothing is allocated. Threads: one.
#ifndef AISLE_DAEMON_LOOP_H
#define AISLE_DAEMON_LOOP_H

#include "daemon/bus.h"
#include "daemon/clock.h"
#include "daemon/feed.h"
#include "daemon/histogram.h"
#include "daemon/notify.h"
#include "daemon/path_bytes.h"
#include "daemon/record.h"
#include "daemon/settings.h"

#define AISLE_LOOP_SLICE_US 1000       // of processor time, aimed at by the chosen slice
#define AISLE_LOOP_FAULT_US 1000000    // a fault is shown this long
#define AISLE_LOOP_STATUS_GAP_US 20000 // at least, between two _STATUS

// cause_id of the daemon's own faults: one of these + the number of the channel (channel.h).
#define AISLE_CAUSE_ID_MESSAGE 1000 // LIMIT: a count or the length; MALFORMED: anything else wrong in a message
#define AISLE_CAUSE_ID_QUEUE 1100   // LIMIT: the queue of waiting messages was full, one was dropped
#define AISLE_CAUSE_ID_BUS 1200     // LIMIT: liblcm's queue was full, some may be lost
#define AISLE_CAUSE_ID_PLANNER 1300 // INTERNAL: the planner would not take it even when idle

// timer_id in _DIAG.
typedef enum aisle_timer {
    AISLE_TIMER_STEP,    // one slice of planning
    AISLE_TIMER_REQUEST, // planning of one answer, over all its slices
    AISLE_TIMER_DECODE,  // decoding one message
    AISLE_TIMER_PUBLISH, // sending one message
    AISLE_TIMER_CYCLE, // from the host's receiving a pose or obstacles, the oldest if several, to the cycle's verdict on it
    AISLE_TIMER_ANSWER,      // the same of those that changed the path, until that was sent
    AISLE_TIMER_ANSWER_WORK, // the planner's processor time in it
    AISLE_TIMER_COUNT
} aisle_timer;

// counter_id in _DIAG: those of the planner (aisle_counter) from 0, the daemon's own from 100. All but the mark never
// decrease.
typedef enum aisle_daemon_counter {
    AISLE_DAEMON_RECEIVED = 100, // messages received on our channels
    AISLE_DAEMON_REPLACED,       // snapshots replaced by a newer one before the planner saw them
    AISLE_DAEMON_OVERSIZE,       // refused: longer than any message may be
    AISLE_DAEMON_DROPPED,        // refused: no room in the queue of waiting messages
    AISLE_DAEMON_FLOODED,        // times liblcm's queue may have overflowed
    AISLE_DAEMON_MALFORMED,      // refused by the decoder
    AISLE_DAEMON_OVER_LIMIT,     // refused by the decoder: a count over its bound
    AISLE_DAEMON_PUBLISHED,      // messages sent
    AISLE_DAEMON_PUBLISH_FAILED, // messages liblcm would not send
    AISLE_DAEMON_CLOCK_JUMPS,    // times real time departed by more than a second
    AISLE_DAEMON_QUEUE_MAX,      // bytes, high-water mark of the queue of waiting messages
    AISLE_DAEMON_COUNTER_END
} aisle_daemon_counter;

// What a loop works with; all the caller's, and alive as long as the loop.
typedef struct aisle_loop_parts {
    const aisle_settings *settings;
    aisle_planner *planner; // just made
    size_t arena_bytes;     // of its block
    aisle_bus *bus;         // open
    aisle_clock *clock;     // started
    aisle_notify *notify;   // open, or of fd -1
    aisle_record *record;   // open, or NULL
    int stop_fd;            // readable = stop; -1 = never
} aisle_loop_parts;

// A pose or obstacles that the planner has taken and a cycle is to answer.
typedef struct aisle_loop_asked {
    bool waits;
    int64_t at_us;        // monotonic, when the host received the first of them
    int64_t processor_us; // of the planner's steps since
} aisle_loop_asked;

typedef struct aisle_loop {
    aisle_loop_parts parts;
    aisle_feed feed;
    bool idle;            // the planner has nothing to do before its deadline
    bool settling;        // a layout is taking effect
    int64_t layouts_seen; // AISLE_COUNTER_LAYOUTS when it was taken
    bool progress;        // something moved since the last watchdog ping
    uint32_t slice;       // work units of the next slice
    double unit_us;       // of processor time, of the slowest work of late; 0: not known
    int64_t planning_us;  // spent in step() since the last answer
    aisle_loop_asked asked;
    aisle_path_seen path_seen;            // the last path sent
    float path_planning_time;             // likewise, s
    int64_t malformed, over_limit, stuck; // messages refused: by the decoder, over a bound, by an idle planner
    int64_t bus_faults_seen;
    int16_t fault_cause; // of the last fault
    int32_t fault_id;
    int64_t fault_us;                                     // monotonic time of it
    int64_t fault_told_us;                                // of the last line on stderr
    int64_t next_status_us, next_diag_us, last_status_us; // monotonic
    int32_t seq;                                          // of the last _STATUS
    aisle_status_msg status;                              // as last sent
    aisle_diag_msg diag;
    aisle_histogram timers[AISLE_TIMER_COUNT];
    uint8_t out[AISLE_MSG_DATAGRAM_MAX];
} aisle_loop;

typedef enum aisle_loop_end { AISLE_LOOP_GOES_ON, AISLE_LOOP_STOPPED, AISLE_LOOP_BUS_BROKEN } aisle_loop_end;

void aisle_loop_init(aisle_loop *self, const aisle_loop_parts *parts);

// One turn; waits at most wait_max_us for something to do.
aisle_loop_end aisle_loop_turn(aisle_loop *self, int64_t wait_max_us);

// Turns until stopped: says READY first, STOPPING and a last _STATUS at the end. Paths are not revoked: their leases
// run out.
aisle_loop_end aisle_loop_run(aisle_loop *self);
#endif
