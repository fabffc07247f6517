#include "daemon/report.h"

#include "base/check.h"

#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { MEMORY_ROWS_MAX = 64 };

static int64_t dropped(const aisle_inbox *inbox) {
    int64_t sum = 0;
    for (int i = 0; i < AISLE_CHANNEL_INPUTS; i++) {
        sum += inbox->dropped[i];
    }
    return sum;
}

// Messages refused before the planner saw them.
static int64_t refused(const aisle_loop *loop) {
    const aisle_inbox *inbox = loop->parts.bus->inbox;
    return loop->malformed + loop->over_limit + loop->stuck + inbox->oversize + dropped(inbox);
}

void aisle_report_status(const aisle_loop *loop, int64_t now_monotonic_us, aisle_status_msg *out) {
    aisle_planner_status(loop->parts.planner, aisle_clock_utime(loop->parts.clock, now_monotonic_us), out);
    int64_t rejected = out->num_rejected + refused(loop);
    out->num_rejected = rejected < INT32_MAX ? (int32_t)rejected : INT32_MAX;
    out->uptime = now_monotonic_us - loop->parts.clock->start_monotonic;
    out->seq = loop->seq;
    bool fresh = loop->fault_cause != 0 && now_monotonic_us - loop->fault_us < AISLE_LOOP_FAULT_US;
    if (fresh) {
        out->cause = loop->fault_cause;
        out->cause_id = loop->fault_id;
    } else if (out->cause == 0 && aisle_clock_departed(loop->parts.clock)) {
        out->cause = AISLE_STATUS_CLOCK_JUMP;
    }
}

bool aisle_report_status_differs(const aisle_status_msg *a, const aisle_status_msg *b) {
    return a->state != b->state || a->cause != b->cause || a->cause_id != b->cause_id || a->map_id != b->map_id ||
           a->map_revision != b->map_revision || a->vehicle_revision != b->vehicle_revision ||
           a->goal_list_id != b->goal_list_id || a->goal_list_revision != b->goal_list_revision ||
           a->goal_id != b->goal_id || a->path_revision != b->path_revision || a->command_id != b->command_id;
}

int64_t aisle_report_rss(void) {
    char text[128] = "";
    int fd = open("/proc/self/statm", O_RDONLY | O_CLOEXEC);
    if (fd < 0) {
        return 0;
    }
    ssize_t length = read(fd, text, sizeof text - 1);
    (void)close(fd);
    const char *second = length > 0 ? strchr(text, ' ') : NULL;
    long page = sysconf(_SC_PAGESIZE);
    return second == NULL || page <= 0 ? 0 : (int64_t)strtoll(second, NULL, 10) * (int64_t)page;
}

static void put_counter(aisle_diag_msg *out, int id, int64_t value) {
    AISLE_ASSERT(out->num_counters < AISLE_DIAG_MAX_COUNTERS);
    out->counter_id[out->num_counters] = (int16_t)id;
    out->counter[out->num_counters] = value;
    out->num_counters++;
}

static void put_counters(const aisle_loop *loop, aisle_diag_msg *out) {
    const int64_t *planner = aisle_planner_counters(loop->parts.planner);
    for (int i = 0; i < (int)AISLE_COUNTER_COUNT; i++) {
        put_counter(out, i, planner[i]);
    }
    const aisle_bus *bus = loop->parts.bus;
    put_counter(out, AISLE_DAEMON_RECEIVED, bus->inbox->received);
    put_counter(out, AISLE_DAEMON_REPLACED, bus->inbox->replaced);
    put_counter(out, AISLE_DAEMON_OVERSIZE, bus->inbox->oversize);
    put_counter(out, AISLE_DAEMON_DROPPED, dropped(bus->inbox));
    put_counter(out, AISLE_DAEMON_FLOODED, bus->flooded);
    put_counter(out, AISLE_DAEMON_MALFORMED, loop->malformed);
    put_counter(out, AISLE_DAEMON_OVER_LIMIT, loop->over_limit);
    put_counter(out, AISLE_DAEMON_PUBLISHED, bus->published);
    put_counter(out, AISLE_DAEMON_PUBLISH_FAILED, bus->failed);
    put_counter(out, AISLE_DAEMON_CLOCK_JUMPS, loop->parts.clock->jumps);
    put_counter(out, AISLE_DAEMON_QUEUE_MAX, (int64_t)bus->inbox->used_max);
}

static void put_timers(const aisle_loop *loop, aisle_diag_msg *out) {
    for (int i = 0; i < (int)AISLE_TIMER_COUNT; i++) {
        const aisle_histogram *timer = &loop->timers[i];
        out->timer_id[i] = (int8_t)i;
        out->timer_count[i] = timer->count < INT32_MAX ? (int32_t)timer->count : INT32_MAX;
        out->timer_p50[i] = (float)aisle_histogram_percentile(timer, 0.50) * 1e-6F;
        out->timer_p99[i] = (float)aisle_histogram_percentile(timer, 0.99) * 1e-6F;
        out->timer_max[i] = (float)timer->max_us * 1e-6F;
    }
    out->num_timers = (int16_t)AISLE_TIMER_COUNT;
}

// Pools without a mark of their own are used whole.
static int64_t arena_used(const aisle_planner *planner) {
    aisle_memory_row rows[MEMORY_ROWS_MAX];
    size_t count = aisle_planner_memory(planner, rows, MEMORY_ROWS_MAX), used = 0;
    for (size_t i = 0; i < count && i < MEMORY_ROWS_MAX; i++) {
        used += rows[i].used_max != 0 ? rows[i].used_max : rows[i].bytes;
    }
    return (int64_t)used;
}

void aisle_report_diag(const aisle_loop *loop, int64_t now_monotonic_us, aisle_diag_msg *out) {
    out->utime = aisle_clock_utime(loop->parts.clock, now_monotonic_us);
    out->boot_id = loop->status.boot_id;
    out->arena_bytes = (int64_t)loop->parts.arena_bytes;
    out->arena_used_max = arena_used(loop->parts.planner);
    out->rss_bytes = aisle_report_rss();
    out->num_counters = 0;
    put_timers(loop, out);
    put_counters(loop, out);
}
