// report.h - the messages the loop sends by itself: _STATUS and _DIAG. Level 5.
//
// Memory: none but the loop's; the resident set is read from /proc without allocating.
#ifndef AISLE_DAEMON_REPORT_H
#define AISLE_DAEMON_REPORT_H

#include "daemon/loop.h"

// The planner's status with the daemon's faults and refusals in it; seq is that of the last one sent.
void aisle_report_status(const aisle_loop *loop, int64_t now_monotonic_us, aisle_status_msg *out);

// True if a receiver should hear of it before the next heartbeat: state, cause, or a revision held.
bool aisle_report_status_differs(const aisle_status_msg *a, const aisle_status_msg *b);

// Timers (s, since start), memory and counters.
void aisle_report_diag(const aisle_loop *loop, int64_t now_monotonic_us, aisle_diag_msg *out);

// Bytes of this process in RAM; 0 where /proc does not tell.
int64_t aisle_report_rss(void);
#endif
