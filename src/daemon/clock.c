#include "daemon/clock.h"

#include "base/check.h"

#include <stddef.h>
#include <time.h>

static int64_t read_us(clockid_t id) {
    struct timespec t;
    int failed = clock_gettime(id, &t);
    AISLE_ASSERT(failed == 0);
    return (int64_t)t.tv_sec * 1000000 + (int64_t)t.tv_nsec / 1000;
}

static int64_t host_monotonic(void *ctx) {
    (void)ctx;
    return read_us(CLOCK_MONOTONIC);
}

static int64_t host_real(void *ctx) {
    (void)ctx;
    return read_us(CLOCK_REALTIME);
}

static int64_t host_processor(void *ctx) {
    (void)ctx;
    return read_us(CLOCK_THREAD_CPUTIME_ID);
}

aisle_clock_source aisle_clock_of_host(void) {
    return (aisle_clock_source){
        .monotonic_us = host_monotonic, .real_us = host_real, .processor_us = host_processor, .ctx = NULL};
}

void aisle_clock_start(aisle_clock *self, aisle_clock_source source) {
    *self = (aisle_clock){.source = source};
    self->start_monotonic = source.monotonic_us(source.ctx);
    self->start_real = source.real_us(source.ctx);
}

int64_t aisle_clock_monotonic(const aisle_clock *self) {
    return self->source.monotonic_us(self->source.ctx);
}

int64_t aisle_clock_utime(const aisle_clock *self, int64_t monotonic_us) {
    return self->start_real + (monotonic_us - self->start_monotonic);
}

int64_t aisle_clock_processor(const aisle_clock *self) {
    return self->source.processor_us(self->source.ctx);
}

int64_t aisle_clock_monotonic_of(const aisle_clock *self, int64_t real_us) {
    const int64_t age = self->source.real_us(self->source.ctx) - real_us;
    return aisle_clock_monotonic(self) - (age > 0 && age <= AISLE_CLOCK_PAST_US ? age : 0);
}

static bool is_far(int64_t us) {
    return us > AISLE_CLOCK_DEPARTURE_US || us < -AISLE_CLOCK_DEPARTURE_US;
}

bool aisle_clock_check(aisle_clock *self) {
    int64_t departure = self->source.real_us(self->source.ctx) - aisle_clock_utime(self, aisle_clock_monotonic(self));
    bool jumped = is_far(departure - self->departure);
    // Small departures are not taken over, or a clock that creeps away would never be noticed.
    if (jumped || (is_far(departure) != is_far(self->departure))) {
        self->jumps++;
        self->departure = departure;
        return true;
    }
    return false;
}

bool aisle_clock_departed(const aisle_clock *self) {
    return is_far(self->departure);
}
