// clock.h - the daemon's time: monotonic for intervals, and an epoch time that never jumps. Level 5.
//
// utime = real time at start + monotonic progress since. If the host's real time departs from that by more than a
// second (someone set the clock), it is counted and told, and utime goes on as before: paths and ages stay right, and
// the operator restarts the daemon when the clocks of the site are right.
#ifndef AISLE_DAEMON_CLOCK_H
#define AISLE_DAEMON_CLOCK_H

#include <stdbool.h>
#include <stdint.h>

#define AISLE_CLOCK_DEPARTURE_US 1000000 // more than this is a jump
#define AISLE_CLOCK_PAST_US 10000000

// Where time comes from, microseconds; tests bring their own.
typedef struct aisle_clock_source {
    int64_t (*monotonic_us)(void *ctx);
    int64_t (*real_us)(void *ctx);
    int64_t (*processor_us)(void *ctx);
    void *ctx;
} aisle_clock_source;

typedef struct aisle_clock {
    aisle_clock_source source;
    int64_t start_monotonic, start_real; // us
    int64_t departure;                   // of real time from utime at the last check, us
    int64_t jumps;                       // counted since start
} aisle_clock;

// The host's CLOCK_MONOTONIC and CLOCK_REALTIME, and what the calling thread has had of a processor.
aisle_clock_source aisle_clock_of_host(void);

void aisle_clock_start(aisle_clock *self, aisle_clock_source source);

// Now, us.
int64_t aisle_clock_monotonic(const aisle_clock *self);

// The epoch time of a monotonic time, us.
int64_t aisle_clock_utime(const aisle_clock *self, int64_t monotonic_us);

// Processor time of this thread, us: what others on the host do does not stretch it.
int64_t aisle_clock_processor(const aisle_clock *self);

// The monotonic time of a moment of the host's real time just past, as liblcm tells it, us. Now if that is to come or longer
// ago than AISLE_CLOCK_PAST_US: someone set the clock.
int64_t aisle_clock_monotonic_of(const aisle_clock *self, int64_t real_us);

// Compares with real time; call it now and then. True: it has jumped since the last call.
bool aisle_clock_check(aisle_clock *self);

// True while real time and utime disagree by more than AISLE_CLOCK_DEPARTURE_US, as of the last check.
bool aisle_clock_departed(const aisle_clock *self);
#endif
