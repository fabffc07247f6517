#include "replay/bench.h"

#include "replay/report.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

static double now_ms(void) {
    struct timespec t = {0, 0};
    (void)clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec * 1e3 + (double)t.tv_nsec * 1e-6;
}

static int compare(const void *a, const void *b) {
    const double *x = a, *y = b;
    return (*x > *y) - (*x < *y);
}

double aisle_bench_percentile(const double *sorted, size_t count, double share) {
    if (count == 0) {
        return 0.0;
    }
    size_t rank = (size_t)ceil(share * (double)count);
    return sorted[rank == 0 ? 0 : rank - 1];
}

void aisle_bench_init(aisle_bench *self, uint32_t repeat, FILE *text, FILE *json) {
    memset(self, 0, sizeof *self);
    self->repeat = repeat;
    self->text = text;
    self->json = json;
    (void)fprintf(text, "%10s %-7s %-14s %9s %9s %10s %10s %10s\n", "query", "status", "cause", "length", "work",
                  "median ms", "p99 ms", "max ms");
}

void aisle_bench_sink(void *ctx, const aisle_replay_output *output) {
    aisle_bench *self = ctx;
    if (output->channel == AISLE_CHANNEL_REPLY) { // read when the time is taken
        memcpy(self->bytes, output->bytes, output->size);
        self->size = output->size;
    }
}

static bool make_room(aisle_bench *self) {
    if (self->count + self->repeat <= self->capacity) {
        return true;
    }
    size_t capacity = 2U * self->capacity + self->repeat;
    double *samples = realloc(self->samples, capacity * sizeof *samples);
    if (samples == NULL) {
        return false;
    }
    self->samples = samples;
    self->capacity = capacity;
    return true;
}

static void print_row(const aisle_bench *self, const double *sorted) {
    const aisle_path_msg *reply = &self->reply;
    size_t n = self->repeat;
    const char *status = self->answered ? aisle_report_path_status(reply->status) : "none";
    const char *cause = reply->cause == 0 ? "-" : aisle_cause_name(reply->cause);
    double median = aisle_bench_percentile(sorted, n, 0.5), p99 = aisle_bench_percentile(sorted, n, 0.99);
    (void)fprintf(self->text, "%10" PRId32 " %-7s %-14s %9.3f %9" PRId32 " %10.4f %10.4f %10.4f\n",
                  self->query.query_id, status, cause, (double)reply->length, reply->work_units, median, p99,
                  sorted[n - 1]);
    if (self->json != NULL) {
        (void)fprintf(self->json,
                      "%s\n    {\"query_id\": %" PRId32 ", \"status\": \"%s\", \"cause\": %d, \"length\": %.9g, "
                      "\"work_units\": %" PRId32 ", \"ms_median\": %.6f, \"ms_p99\": %.6f, \"ms_max\": %.6f}",
                      self->queries == 1 ? "" : ",", self->query.query_id, status, reply->cause, (double)reply->length,
                      reply->work_units, median, p99, sorted[n - 1]);
    }
}

// The layout in force under its next revision.
static void count_layout_on(aisle_replay *replay, int64_t utime) {
    static aisle_layout_patch_msg patch; // large
    static uint8_t bytes[64];
    aisle_status_msg status;
    size_t size = 0;
    aisle_planner_status(replay->planner, utime, &status);
    patch.map_id = status.map_id;
    patch.base_revision = status.map_revision;
    patch.map_revision = status.map_revision + 1;
    if (aisle_msg_encode(AISLE_MSG_LAYOUT_PATCH, &patch, bytes, sizeof bytes, &size) == AISLE_OK) {
        aisle_replay_input(replay, utime, AISLE_CHANNEL_LAYOUT_PATCH, bytes, size);
    }
}

bool aisle_bench_query(aisle_bench *self, aisle_replay *replay, int64_t utime, const uint8_t *bytes, size_t size) {
    static uint8_t again[AISLE_MSG_DATAGRAM_MAX];
    if (aisle_msg_decode(AISLE_MSG_QUERY, bytes, size, &self->query, NULL) != AISLE_OK) {
        return true; // counted by no one: a bench measures queries
    }
    if (!make_room(self)) {
        return false;
    }
    self->queries++;
    aisle_query_msg run = self->query;
    double *samples = self->samples + self->count;
    for (uint32_t i = 0; i < self->repeat; i++) {
        size_t length = 0;
        if (self->again) {
            count_layout_on(replay, utime);
        }
        run.query_id = (int32_t)(((uint32_t)self->query.query_id + i * 1000003U) & (uint32_t)INT32_MAX);
        self->size = 0;
        samples[i] = 0.0;
        if (aisle_msg_encode(AISLE_MSG_QUERY, &run, again, sizeof again, &length) == AISLE_OK) {
            double start = now_ms();
            aisle_replay_input(replay, utime, AISLE_CHANNEL_QUERY, again, length);
            samples[i] = now_ms() - start;
        }
        self->failed += self->size > 0 ? 0 : 1;
    }
    self->count += self->repeat;
    self->answered = aisle_msg_decode(AISLE_MSG_PATH, self->bytes, self->size, &self->reply, NULL) == AISLE_OK;
    // A sorted copy is not needed: the order of the runs means nothing.
    qsort(samples, self->repeat, sizeof *samples, compare);
    print_row(self, samples);
    return true;
}

void aisle_bench_finish(aisle_bench *self) {
    if (self->count > 0) {
        qsort(self->samples, self->count, sizeof *self->samples, compare);
    }
    double median = aisle_bench_percentile(self->samples, self->count, 0.5);
    double p99 = aisle_bench_percentile(self->samples, self->count, 0.99);
    double worst = self->count == 0 ? 0.0 : self->samples[self->count - 1];
    (void)fprintf(self->text,
                  "all: %" PRId64 " queries, %" PRIu32 " runs each, median %.4f ms, p99 %.4f ms, max %.4f ms",
                  self->queries, self->repeat, median, p99, worst);
    (void)fprintf(self->text, ", runs without a reply %" PRId64 "\n", self->failed);
    if (self->json != NULL) {
        (void)fprintf(self->json,
                      "],\n  \"repeat\": %" PRIu32 ", \"failed\": %" PRId64
                      ", \"overall\": {\"ms_median\": %.6f, \"ms_p99\": %.6f, \"ms_max\": %.6f}",
                      self->repeat, self->failed, median, p99, worst);
    }
    free(self->samples);
    self->samples = NULL;
}
