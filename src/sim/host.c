#include "sim/host.h"

#include <string.h>
#include <time.h>

#define STATUS_US 200000 // as aisled's heartbeat

void aisle_sim_host_write_log(aisle_sim_host *self, int64_t utime, aisle_channel channel, const uint8_t *bytes,
                              size_t size) {
    char name[AISLE_CHANNEL_NAME_LEN];
    aisle_channel_name(self->prefix, channel, name);
    aisle_log_event event = {.number = self->events++,
                             .utime = utime,
                             .channel = name,
                             .channel_length = strlen(name),
                             .bytes = bytes,
                             .size = size};
    if (self->log != NULL && !aisle_log_write(self->log, &event)) {
        self->failed = true;
    }
}

static void on_output(void *ctx, const aisle_replay_output *output) {
    aisle_sim_host *self = ctx;
    self->heard_paths += output->channel == AISLE_CHANNEL_PATH ? 1 : 0;
    self->heard_changes += output->channel == AISLE_CHANNEL_PATH && !output->renewal ? 1 : 0;
    aisle_sim_host_write_log(self, output->utime, output->channel, output->bytes, output->size);
    self->heard(self->ctx, output->channel, output->utime, output->bytes, output->size);
}

aisle_status aisle_sim_host_start_core(aisle_sim_host *self, const aisle_settings *settings, FILE *log,
                                       aisle_sim_heard heard, void *ctx, char *message) {
    memset(self, 0, sizeof *self);
    self->prefix = settings->prefix;
    self->log = log;
    self->heard = heard;
    self->ctx = ctx;
    self->epoch_us = AISLE_SIM_EPOCH_US;
    aisle_status status = aisle_engine_start(&self->engine, settings, 1, 0, message);
    if (status == AISLE_OK) {
        aisle_replay_init(&self->replay, self->engine.planner, on_output, self);
    }
    return status;
}

static int64_t clock_us(clockid_t clock) {
    struct timespec t = {0, 0};
    (void)clock_gettime(clock, &t);
    return (int64_t)t.tv_sec * 1000000 + t.tv_nsec / 1000;
}

int64_t aisle_sim_host_wall_us(void) {
    return clock_us(CLOCK_MONOTONIC);
}

int64_t aisle_sim_host_cpu_us(void) {
    return clock_us(CLOCK_THREAD_CPUTIME_ID);
}

typedef struct stopwatch {
    int64_t wall_us, cpu_us, paths, changes;
} stopwatch;

static stopwatch start_watch(const aisle_sim_host *self) {
    return (stopwatch){aisle_sim_host_wall_us(), aisle_sim_host_cpu_us(), self->heard_paths, self->heard_changes};
}

static void stop_watch(aisle_sim_host *self, const stopwatch *from) {
    int64_t wall = aisle_sim_host_wall_us() - from->wall_us, cpu = aisle_sim_host_cpu_us() - from->cpu_us;
    aisle_histogram_add(&self->work, wall);
    if (self->heard_paths > from->paths) {
        aisle_histogram_add(&self->answers, wall);
        aisle_histogram_add(&self->answers_cpu, cpu);
    }
    if (self->heard_changes > from->changes) {
        aisle_histogram_add(&self->changes_cpu, cpu);
    }
}

static void tell_status(aisle_sim_host *self, int64_t utime) {
    aisle_status_msg status;
    uint8_t bytes[512];
    size_t size = 0;
    aisle_planner_status(self->engine.planner, utime, &status);
    status.seq = ++self->status_seq;
    if (aisle_msg_encode(AISLE_MSG_STATUS, &status, bytes, sizeof bytes, &size) == AISLE_OK) {
        aisle_sim_host_write_log(self, utime, AISLE_CHANNEL_STATUS, bytes, size);
        self->heard(self->ctx, AISLE_CHANNEL_STATUS, utime, bytes, size);
    }
}

void aisle_sim_host_advance(aisle_sim_host *self, int64_t utime) {
    if (self->lcm != NULL) {
        aisle_sim_host_bus_advance(self, utime);
        return;
    }
    if (self->units_per_ms > 0) {
        aisle_sim_host_slow_advance(self, utime);
    } else if (aisle_planner_next_deadline(self->engine.planner) <= utime) {
        stopwatch watch = start_watch(self);
        aisle_replay_advance(&self->replay, utime);
        stop_watch(self, &watch);
    }
    if (utime >= self->next_status_us) {
        tell_status(self, utime);
        self->next_status_us = utime + STATUS_US;
    }
}

void aisle_sim_host_send(aisle_sim_host *self, int64_t utime, aisle_channel channel, const uint8_t *bytes,
                         size_t size) {
    if (self->lcm != NULL) {
        aisle_sim_host_bus_send(self, utime, channel, bytes, size);
        return;
    }
    aisle_sim_host_advance(self, utime);
    if (self->units_per_ms > 0) {
        aisle_sim_host_slow_send(self, utime, channel, bytes, size);
        return;
    }
    aisle_sim_host_write_log(self, utime, channel, bytes, size);
    stopwatch watch = start_watch(self);
    aisle_replay_input(&self->replay, utime, channel, bytes, size);
    stop_watch(self, &watch);
}

void aisle_sim_host_stop(aisle_sim_host *self) {
    aisle_sim_host_bus_stop(self);
    aisle_record_close(&self->record);
    aisle_sim_post_free(&self->waiting);
    aisle_engine_stop(&self->engine);
}
