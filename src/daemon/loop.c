#include "daemon/loop.h"

#include "base/check.h"
#include "base/vec.h"
#include "daemon/report.h"

#include <inttypes.h>
#include <poll.h>
#include <stdio.h>
#include <string.h>

#define FEED_MAX 256  // messages handed to the planner in one turn
#define FEED_US 2000  // or as many as this takes
#define SLICE_MIN 64U // work units
#define SLICE_MAX 1000000U
#define SLICE_FIRST 512U
#define SLICE_FADES (1.0 / 32) // of what the slowest work took a unit, with each slice
#define WAIT_MAX_US 1000000

static int64_t now(const aisle_loop *self) {
    return aisle_clock_monotonic(self->parts.clock);
}

static int64_t period_us(float hz) {
    return (int64_t)(1e6F / hz);
}

void aisle_loop_init(aisle_loop *self, const aisle_loop_parts *parts) {
    memset(self, 0, sizeof *self);
    self->parts = *parts;
    uint32_t fixed = parts->settings->work_units_per_slice;
    self->slice = fixed != 0 ? fixed : SLICE_FIRST;
    self->next_status_us = self->next_diag_us = now(self);
    self->fault_told_us = now(self) - AISLE_LOOP_FAULT_US;
    self->path_seen.revision = -1;
}

// ---- faults found before the planner

static void note_fault(aisle_loop *self, int16_t cause, int id, aisle_channel channel, const char *what,
                       const aisle_msg_fault *fault) {
    int64_t at = now(self);
    self->fault_cause = cause;
    self->fault_id = id + (int)channel;
    self->fault_us = at;
    if (at - self->fault_told_us < AISLE_LOOP_FAULT_US) {
        return;
    }
    self->fault_told_us = at;
    const char *field = fault == NULL ? "" : fault->field;
    (void)fprintf(stderr, "aisled: %s: %s%s%s", self->parts.bus->names[channel], what, *field == '\0' ? "" : ": ",
                  field);
    if (fault != NULL && fault->value != 0) {
        (void)fprintf(stderr, " %" PRId64, fault->value);
    }
    (void)fprintf(stderr, " (%s)\n", aisle_cause_name(cause));
}

static void note_decode_fault(aisle_loop *self, aisle_channel channel) {
    static const char *const what[] = {
        [AISLE_MSG_FAULT_NONE] = "refused",
        [AISLE_MSG_FAULT_FINGERPRINT] = "refused, message of another type or version",
        [AISLE_MSG_FAULT_TRUNCATED] = "refused, message cut off",
        [AISLE_MSG_FAULT_TRAILING] = "refused, bytes left over",
        [AISLE_MSG_FAULT_NEGATIVE_COUNT] = "refused, negative count",
        [AISLE_MSG_FAULT_OVER_BOUND] = "refused, count over its bound",
        [AISLE_MSG_FAULT_OVERSIZE] = "refused, too long",
        [AISLE_MSG_FAULT_NOT_FINITE] = "refused, not a finite number",
        [AISLE_MSG_FAULT_BAD_BOOLEAN] = "refused, neither true nor false",
    };
    const aisle_msg_fault *fault = &self->feed.fault;
    int16_t cause = aisle_msg_fault_cause(fault);
    self->over_limit += cause == AISLE_STATUS_LIMIT ? 1 : 0;
    self->malformed += cause == AISLE_STATUS_LIMIT ? 0 : 1;
    note_fault(self, cause, AISLE_CAUSE_ID_MESSAGE, channel, what[fault->kind], fault);
}

static void note_bus_faults(aisle_loop *self) {
    const aisle_bus *bus = self->parts.bus;
    if (bus->fault_count == self->bus_faults_seen) {
        return;
    }
    self->bus_faults_seen = bus->fault_count;
    switch (bus->fault) {
    case AISLE_BUS_OVERSIZE:
        note_fault(self, AISLE_STATUS_LIMIT, AISLE_CAUSE_ID_MESSAGE, bus->fault_channel, "refused, too long", NULL);
        break;
    case AISLE_BUS_FULL:
        note_fault(self, AISLE_STATUS_LIMIT, AISLE_CAUSE_ID_QUEUE, bus->fault_channel,
                   "dropped, too many messages wait for the planner", NULL);
        break;
    case AISLE_BUS_FLOODED:
    default:
        note_fault(self, AISLE_STATUS_LIMIT, AISLE_CAUSE_ID_BUS, bus->fault_channel,
                   "messages came faster than the bus keeps them, some may be lost", NULL);
        break;
    }
}

// ---- out

static void publish(aisle_loop *self, aisle_channel channel, const void *bytes, size_t size) {
    int64_t start = now(self);
    (void)aisle_bus_publish(self->parts.bus, channel, bytes, size);
    aisle_histogram_add(&self->timers[AISLE_TIMER_PUBLISH], now(self) - start);
}

// The planning time of an answer; a renewal of the last path keeps its own.
static float planning_time(aisle_loop *self, bool path, bool renewal) {
    if (renewal) {
        return self->path_planning_time;
    }
    float seconds = (float)self->planning_us * 1e-6F;
    aisle_histogram_add(&self->timers[AISLE_TIMER_REQUEST], self->planning_us);
    self->planning_us = 0;
    if (path) {
        self->path_planning_time = seconds;
    }
    return seconds;
}

// answered: by the cycle that this step has ended; NULL: none, or it had nothing to answer.
static void send_events(aisle_loop *self, int64_t utime, const aisle_loop_asked *answered) {
    aisle_event event;
    while (aisle_planner_next_event(self->parts.planner, &event)) {
        const aisle_channel channel = aisle_channel_of_event(event.kind);
        AISLE_ASSERT(event.size <= sizeof self->out);
        memcpy(self->out, event.bytes, event.size);
        const bool path = event.kind == AISLE_EVENT_PATH;
        const bool renewal = path && aisle_path_is_renewal(&self->path_seen, event.bytes);
        const float seconds = planning_time(self, path, renewal);
        if (aisle_channel_type(channel) == AISLE_MSG_PATH) {
            AISLE_ASSERT(event.size > aisle_path_offset("num_waypoints"));
            aisle_path_put_float(self->out, "planning_time", seconds);
        }
        publish(self, channel, self->out, event.size);
        if (answered != NULL && path && !renewal) {
            aisle_histogram_add(&self->timers[AISLE_TIMER_ANSWER], now(self) - answered->at_us);
            aisle_histogram_add(&self->timers[AISLE_TIMER_ANSWER_WORK], answered->processor_us);
        }
        aisle_record_message(self->parts.record, utime, channel, self->out, event.size);
        self->progress = true;
    }
}

static void send_status(aisle_loop *self, int64_t at, aisle_status_msg *status) {
    size_t size = 0;
    status->seq = ++self->seq;
    self->status = *status;
    self->last_status_us = at;
    if (aisle_msg_encode(AISLE_MSG_STATUS, status, self->out, sizeof self->out, &size) == AISLE_OK) {
        publish(self, AISLE_CHANNEL_STATUS, self->out, size);
    }
}

static void send_diag(aisle_loop *self, int64_t at) {
    size_t size = 0;
    aisle_report_diag(self, at, &self->diag);
    if (aisle_msg_encode(AISLE_MSG_DIAG, &self->diag, self->out, sizeof self->out, &size) == AISLE_OK) {
        publish(self, AISLE_CHANNEL_DIAG, self->out, size);
    }
}

// True once per period; missed ones are not made up for.
static bool due(int64_t *next, int64_t at, int64_t period) {
    if (at < *next) {
        return false;
    }
    *next = at - *next < period ? *next + period : at + period;
    return true;
}

static void send_heartbeat(aisle_loop *self) {
    const aisle_settings *settings = self->parts.settings;
    int64_t at = now(self);
    aisle_status_msg status;
    bool beat = due(&self->next_status_us, at, period_us(settings->status_hz));
    if (beat) {
        (void)aisle_clock_check(self->parts.clock);
    }
    aisle_report_status(self, at, &status);
    bool changed =
        at - self->last_status_us >= AISLE_LOOP_STATUS_GAP_US && aisle_report_status_differs(&status, &self->status);
    if (beat || changed) {
        send_status(self, at, &status);
    }
    if (due(&self->next_diag_us, at, period_us(settings->diag_hz))) {
        send_diag(self, at);
    }
}

// ---- in

static bool is_layout(aisle_channel channel) {
    return channel == AISLE_CHANNEL_LAYOUT || channel == AISLE_CHANNEL_LAYOUT_PATCH || channel == AISLE_CHANNEL_GRID;
}

static int64_t count(const aisle_loop *self, aisle_counter which) {
    return aisle_planner_counters(self->parts.planner)[which];
}

static void note_asked(aisle_loop *self, int64_t received_us) {
    if (!self->asked.waits && received_us != 0) {
        const int64_t at = aisle_clock_monotonic_of(self->parts.clock, received_us);
        self->asked = (aisle_loop_asked){.waits = true, .at_us = at, .processor_us = 0};
    }
}

// Hands one message to the planner; AISLE_BUSY: it stays where it is.
static aisle_status take(aisle_loop *self, const aisle_inbox_message *message) {
    aisle_inbox *inbox = self->parts.bus->inbox;
    int64_t start = now(self);
    aisle_status status = aisle_feed_load(&self->feed, message->channel, message->bytes, message->size);
    aisle_histogram_add(&self->timers[AISLE_TIMER_DECODE], now(self) - start);
    if (status != AISLE_OK) {
        note_decode_fault(self, message->channel);
        aisle_inbox_pop(inbox, message);
        return AISLE_ERR_DATA;
    }
    const int64_t utime = aisle_clock_utime(self->parts.clock, now(self));
    const int64_t cycle_inputs = count(self, AISLE_COUNTER_CYCLE_INPUTS);
    status = aisle_feed_submit(&self->feed, self->parts.planner, utime);
    if (count(self, AISLE_COUNTER_CYCLE_INPUTS) > cycle_inputs) {
        note_asked(self, message->at_us);
    }
    if (status != AISLE_BUSY) {
        aisle_record_message(self->parts.record, utime, message->channel, message->bytes, message->size);
    }
    if (status == AISLE_BUSY && self->idle) { // would wait for ever
        self->stuck++;
        note_fault(self, AISLE_STATUS_INTERNAL, AISLE_CAUSE_ID_PLANNER, message->channel,
                   "dropped, the planner does not take it", NULL);
        status = AISLE_ERR_DATA;
    }
    if (status != AISLE_BUSY) {
        aisle_inbox_pop(inbox, message);
        self->progress = true;
    }
    self->idle = self->idle && status < 0;
    if (status >= 0 && status != AISLE_BUSY && is_layout(message->channel)) {
        self->settling = true;
        self->layouts_seen = count(self, AISLE_COUNTER_LAYOUTS);
    }
    return status;
}

// True while a message must wait for the layout that is taking effect: what is planned anew then starts from the pose
// held.
static bool waits_for_layout(aisle_loop *self, aisle_channel channel) {
    self->settling = self->settling && !self->idle && count(self, AISLE_COUNTER_LAYOUTS) == self->layouts_seen;
    return self->settling && channel != AISLE_CHANNEL_COMMAND && channel != AISLE_CHANNEL_OBSTACLES;
}

// A pose or obstacles past a message that must wait.
static bool feed_overtaking(aisle_loop *self) {
    aisle_inbox_message message;
    return !self->settling && aisle_inbox_peek_overtaking(self->parts.bus->inbox, &message) &&
           take(self, &message) != AISLE_BUSY;
}

// False: nothing can be taken now.
static bool feed_one(aisle_loop *self) {
    aisle_inbox_message message;
    if (!aisle_inbox_peek(self->parts.bus->inbox, &message)) {
        return false;
    }
    bool waits = waits_for_layout(self, message.channel) || (!self->idle && aisle_feed_waits_for_idle(message.channel));
    return (!waits && take(self, &message) != AISLE_BUSY) || feed_overtaking(self);
}

static void feed(aisle_loop *self) {
    int64_t until = now(self) + FEED_US;
    for (int i = 0; i < FEED_MAX && now(self) < until && feed_one(self); i++) {
    }
}

// ---- planning

// A slice follows the slowest work of late, for kinds of work differ tenfold and the next one may be any. Slices that ended
// early say little of a unit, unless they took too long.
static void choose_slice(aisle_loop *self, int64_t took_us, int64_t spent) {
    const bool tells = spent >= self->slice / 2U || (took_us > AISLE_LOOP_SLICE_US && spent >= SLICE_MIN);
    if (self->parts.settings->work_units_per_slice != 0 || !tells) {
        return;
    }
    const double unit_us = (double)took_us / (double)spent, before = self->unit_us * (1.0 - SLICE_FADES);
    self->unit_us = unit_us > before ? unit_us : before;
    const double most =
        aisle_min(2.0 * (double)self->slice, SLICE_MAX); // one that was too quick to be timed says little
    const double units = self->unit_us * most > AISLE_LOOP_SLICE_US ? AISLE_LOOP_SLICE_US / self->unit_us : most;
    self->slice = units > SLICE_MIN ? (uint32_t)units : SLICE_MIN;
}

// What came before a cycle began is answered when it ends. An idle planner has nothing to answer.
static bool note_answered(aisle_loop *self, int64_t cycles, aisle_loop_asked *answered) {
    const bool ended = self->asked.waits && count(self, AISLE_COUNTER_CYCLES) > cycles;
    *answered = self->asked;
    if (ended) {
        aisle_histogram_add(&self->timers[AISLE_TIMER_CYCLE], now(self) - answered->at_us);
    }
    self->asked.waits = self->asked.waits && !ended && !self->idle;
    return ended;
}

static void step(aisle_loop *self) {
    int64_t start = now(self), utime = aisle_clock_utime(self->parts.clock, start);
    if (self->idle && utime < aisle_planner_next_deadline(self->parts.planner)) {
        return;
    }
    aisle_record_step(self->parts.record, utime, self->slice);
    const int64_t units = count(self, AISLE_COUNTER_WORK_UNITS), cycles = count(self, AISLE_COUNTER_CYCLES);
    const int64_t processor = aisle_clock_processor(self->parts.clock);
    aisle_status status = aisle_planner_step(self->parts.planner, utime, self->slice);
    int64_t took = now(self) - start, worked = aisle_clock_processor(self->parts.clock) - processor;
    int64_t spent = count(self, AISLE_COUNTER_WORK_UNITS) - units;
    aisle_histogram_add(&self->timers[AISLE_TIMER_STEP], took);
    self->planning_us += took;
    self->idle = status != AISLE_BUSY;
    self->progress = self->progress || spent > 0;
    self->asked.processor_us += worked;
    choose_slice(self, worked, spent);
    aisle_loop_asked answered;
    bool answers = note_answered(self, cycles, &answered);
    send_events(self, utime, answers ? &answered : NULL);
}

// ---- turns

static int64_t least(int64_t a, int64_t b) {
    return a < b ? a : b;
}

// Microseconds until there is something to do without new messages.
static int64_t time_to_wait(const aisle_loop *self) {
    aisle_inbox_message message;
    if (!self->idle || aisle_inbox_peek(self->parts.bus->inbox, &message)) {
        return 0;
    }
    int64_t at = now(self), deadline = aisle_planner_next_deadline(self->parts.planner);
    int64_t wait = least(self->next_status_us - at, self->next_diag_us - at);
    if (deadline != INT64_MAX) {
        wait = least(wait, deadline - aisle_clock_utime(self->parts.clock, at));
    }
    if (self->parts.notify->period_us != 0) {
        wait = least(wait, self->parts.notify->next_us - at);
    }
    return wait > 0 ? wait : 0;
}

// True: stop was asked for. Whole milliseconds, rounded up: a turn too early would find nothing due and come again.
static bool wait_for_input(const aisle_loop *self, int64_t wait_us) {
    struct pollfd p[2] = {{.fd = aisle_bus_fd(self->parts.bus), .events = POLLIN, .revents = 0},
                          {.fd = self->parts.stop_fd, .events = POLLIN, .revents = 0}};
    int ready = poll(p, 2, (int)((least(wait_us, WAIT_MAX_US) + 999) / 1000));
    return ready > 0 && p[1].revents != 0;
}

aisle_loop_end aisle_loop_turn(aisle_loop *self, int64_t wait_max_us) {
    if (wait_for_input(self, least(time_to_wait(self), wait_max_us))) {
        return AISLE_LOOP_STOPPED;
    }
    if (aisle_bus_drain(self->parts.bus) < 0) {
        return AISLE_LOOP_BUS_BROKEN;
    }
    note_bus_faults(self);
    feed(self);
    step(self);
    send_heartbeat(self);
    if (aisle_notify_ping(self->parts.notify, now(self), self->progress || self->idle)) {
        self->progress = false;
    }
    return AISLE_LOOP_GOES_ON;
}

aisle_loop_end aisle_loop_run(aisle_loop *self) {
    aisle_loop_end end = aisle_loop_turn(self, 0); // so that the first heartbeat is out before READY
    (void)aisle_notify_send(self->parts.notify, "READY=1");
    while (end == AISLE_LOOP_GOES_ON) {
        end = aisle_loop_turn(self, WAIT_MAX_US);
    }
    (void)aisle_notify_send(self->parts.notify, "STOPPING=1");
    aisle_status_msg status;
    int64_t at = now(self);
    aisle_report_status(self, at, &status);
    send_status(self, at, &status);
    return end;
}
