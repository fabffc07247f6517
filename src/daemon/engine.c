#include "daemon/engine.h"

#include <stdlib.h>
#include <string.h>
#include <sys/random.h>
#include <time.h>

#define ALIGNMENT 64U
enum { ROWS_MAX = 64 };

static size_t rounded_up(size_t size) {
    return (size + (ALIGNMENT - 1U)) & ~(size_t)(ALIGNMENT - 1U);
}

static aisle_status refuse(aisle_engine *self, aisle_status status, char *message, const char *text) {
    (void)snprintf(message, AISLE_SETTINGS_MESSAGE_LEN, "%s", text);
    aisle_engine_stop(self);
    return status;
}

aisle_status aisle_engine_start(aisle_engine *self, const aisle_settings *settings, int64_t boot_id, size_t extra,
                                char *message) {
    memset(self, 0, sizeof *self);
    aisle_config config = {.limits = settings->limits,
                           .boot_id = boot_id,
                           .work_units = settings->work_units,
                           .vehicle = settings->vehicle,
                           .has_vehicle = true,
                           .skip_unreachable = settings->skip_unreachable,
                           .shortest_lease = settings->shortest_lease,
                           .forgetful = !settings->remember};
    self->planner_bytes = aisle_planner_memsize(&config.limits);
    self->extra_bytes = extra;
    if (self->planner_bytes == 0) {
        return refuse(self, AISLE_ERR_ARG, message, "the planner refuses these [limits]");
    }
    size_t front = rounded_up(self->planner_bytes);
    void *block = NULL;
    if (posix_memalign(&block, ALIGNMENT, front + rounded_up(extra)) != 0) {
        return refuse(self, AISLE_ERR_CAPACITY, message, "not enough memory; lower [limits] or [bus] queue_bytes");
    }
    self->block = block;
    self->extra = (unsigned char *)block + front;
    memset(self->extra, 0, extra); // touched now, not in the loop
    if (aisle_planner_init(self->block, self->planner_bytes, &config, &self->planner) != AISLE_OK) {
        return refuse(self, AISLE_ERR_ARG, message, "the planner refuses this [vehicle] or these [limits]");
    }
    return AISLE_OK;
}

void aisle_engine_stop(aisle_engine *self) {
    free(self->block);
    self->block = NULL;
    self->planner = NULL;
}

int64_t aisle_engine_boot_id(void) {
    uint64_t bits = 0;
    if (getrandom(&bits, sizeof bits, GRND_NONBLOCK) != (ssize_t)sizeof bits) {
        struct timespec t = {0, 0};
        (void)clock_gettime(CLOCK_REALTIME, &t);
        bits = (uint64_t)t.tv_sec * 1000000000U + (uint64_t)t.tv_nsec;
    }
    bits &= (uint64_t)INT64_MAX;
    return bits == 0 ? 1 : (int64_t)bits;
}

bool aisle_engine_print_memory(const aisle_engine *self, size_t daemon_bytes, FILE *file) {
    aisle_memory_row rows[ROWS_MAX];
    size_t count = aisle_planner_memory(self->planner, rows, ROWS_MAX), sum = 0;
    bool ok = fprintf(file, "%-32s %12s\n", "planner, one block", "bytes") > 0;
    for (size_t i = 0; i < count && i < ROWS_MAX; i++) {
        sum += rows[i].bytes;
        ok = ok && fprintf(file, "  %-30s %12zu\n", rows[i].name, rows[i].bytes) > 0;
    }
    ok = ok && fprintf(file, "%-32s %12zu\n", "planner, sum", sum) > 0;
    ok = ok && fprintf(file, "%-32s %12zu\n", "daemon, queue", self->extra_bytes) > 0;
    ok = ok && fprintf(file, "%-32s %12zu\n", "daemon, static", daemon_bytes) > 0;
    ok = ok && fprintf(file, "%-32s %12d\n", "heap of the core after start", 0) > 0;
#ifdef AISLE_STACK_BOUND
    ok = ok && fprintf(file, "%-32s %12lu\n", "stack of the core, at most", (unsigned long)(AISLE_STACK_BOUND)) > 0;
#else
    ok = ok && fprintf(file, "%-32s %12s\n", "stack of the core, at most", "not measured") > 0;
#endif
    return ok && sum == self->planner_bytes;
}
