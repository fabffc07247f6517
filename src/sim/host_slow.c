#include "sim/host.h"

#include <stdlib.h>

#define SLICE_US 500 // of a step, by the simulation's clock

bool aisle_sim_host_slice(aisle_sim_host *self, uint32_t units_per_ms, const char *record) {
    self->units_per_ms = units_per_ms;
    self->clock_us = self->free_us = self->epoch_us;
    self->idle = true;
    return aisle_record_open(&self->record, record, self->prefix, self->epoch_us);
}

// What the step that ends at `utime` has brought.
static void pull(aisle_sim_host *self, int64_t utime) {
    aisle_event event;
    while (aisle_planner_next_event(self->engine.planner, &event)) {
        aisle_channel channel = aisle_channel_of_event(event.kind);
        if (channel == AISLE_CHANNEL_PATH) {
            aisle_histogram_add(&self->answers, self->spent_us);
            aisle_histogram_add(&self->answers_cpu, self->spent_us);
            self->spent_us = 0;
        }
        aisle_record_message(&self->record, utime, channel, event.bytes, event.size);
        self->heard(self->ctx, channel, utime, event.bytes, event.size);
    }
}

// Hands over the first input that waits. False: none, or it must wait.
static bool feed(aisle_sim_host *self) {
    aisle_sim_letter *first = aisle_sim_post_first(&self->waiting);
    if (first == NULL || (aisle_feed_waits_for_idle(first->channel) && !self->idle)) {
        return false;
    }
    if (aisle_feed_load(&self->replay.feed, first->channel, first->bytes, first->size) == AISLE_OK) {
        aisle_status status = aisle_feed_submit(&self->replay.feed, self->engine.planner, self->clock_us);
        if (status == AISLE_BUSY && !self->idle) {
            return false;
        }
        aisle_record_message(&self->record, self->clock_us, first->channel, first->bytes, first->size);
        self->idle = self->idle && status < 0;
    }
    aisle_sim_letter done;
    (void)aisle_sim_post_take(&self->waiting, INT64_MAX, &done);
    free(done.bytes);
    return true;
}

// One step at the clock's time; its answers come when it is done.
static void step(aisle_sim_host *self) {
    uint32_t units = self->units_per_ms * SLICE_US / 1000U;
    units = units > 0 ? units : 1U;
    aisle_record_step(&self->record, self->clock_us, units);
    int64_t start = aisle_sim_host_cpu_us();
    self->idle = aisle_planner_step(self->engine.planner, self->clock_us, units) == AISLE_OK;
    int64_t took = aisle_sim_host_cpu_us() - start;
    self->spent_us += took;
    aisle_histogram_add(&self->work, took);
    self->free_us = self->clock_us + SLICE_US;
    pull(self, self->free_us);
}

void aisle_sim_host_slow_advance(aisle_sim_host *self, int64_t utime) {
    for (;;) {
        int64_t due = self->idle && self->waiting.count == 0 ? aisle_planner_next_deadline(self->engine.planner) : 0;
        int64_t next = due > self->free_us ? due : self->free_us;
        if (next > utime) {
            break;
        }
        self->clock_us = next > self->clock_us ? next : self->clock_us;
        while (feed(self)) {
        }
        step(self);
    }
    self->clock_us = utime > self->clock_us ? utime : self->clock_us;
    self->failed = self->failed || self->record.failed;
}

void aisle_sim_host_slow_send(aisle_sim_host *self, int64_t utime, aisle_channel channel, const uint8_t *bytes,
                              size_t size) {
    self->failed = !aisle_sim_post_send(&self->waiting, utime, channel, bytes, size) || self->failed;
    self->free_us = self->free_us > utime ? self->free_us : utime;
    aisle_sim_host_slow_advance(self, utime);
}
