// Each arm goal of an LCM log, planned and timed: bench-arm LOG OUT; run by arm_table.py. The answers go to the log OUT, a line a goal
// with its id and the milliseconds of the processor to stdout.
#include "daemon/channel.h"
#include "daemon/engine.h"
#include "daemon/feed.h"
#include "daemon/log.h"
#include "daemon/settings.h"

#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { SLICE = 100000 };

static aisle_settings settings;
static aisle_engine engine;
static aisle_log_reader reader;
static aisle_feed feed;
static FILE *out;

void aisle_assert_failed(const char *file, int line, const char *condition) {
    (void)fprintf(stderr, "%s:%d: %s\n", file, line, condition);
    abort();
}

static double milliseconds(void) {
    struct timespec t;
    (void)clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return 1e3 * (double)t.tv_sec + 1e-6 * (double)t.tv_nsec;
}

static void settle(int64_t utime) {
    static const char name[] = "AISLE_ARM_PATH";
    aisle_event event;
    aisle_status status;
    do {
        status = aisle_planner_step(engine.planner, utime, SLICE);
        while (aisle_planner_next_event(engine.planner, &event)) {
            const aisle_log_event told = {.utime = utime,
                                          .channel = name,
                                          .channel_length = sizeof name - 1U,
                                          .bytes = event.bytes,
                                          .size = event.size};
            if (event.kind == AISLE_EVENT_ARM_PATH && !aisle_log_write(out, &told)) {
                abort();
            }
        }
    } while (status == AISLE_BUSY);
}

static void handle(const aisle_log_event *event) {
    const aisle_channel channel = aisle_channel_find("AISLE", event->channel, event->channel_length);
    if ((int)channel >= AISLE_CHANNEL_INPUTS ||
        aisle_feed_load(&feed, channel, event->bytes, event->size) != AISLE_OK) {
        return;
    }
    const double from = milliseconds();
    (void)aisle_feed_submit(&feed, engine.planner, event->utime);
    settle(event->utime);
    if (channel == AISLE_CHANNEL_ARM_GOAL) {
        (void)printf("%ld %.4f\n", (long)feed.message.arm_goal.arm_goal_id, milliseconds() - from);
    }
}

int main(int argc, char **argv) {
    char message[AISLE_SETTINGS_MESSAGE_LEN];
    FILE *file = argc == 3 ? fopen(argv[1], "rb") : NULL;
    out = argc == 3 ? fopen(argv[2], "wb") : NULL;
    if (file == NULL || out == NULL || !aisle_log_open(&reader, file)) {
        (void)fprintf(stderr, "bench-arm LOG OUT\n");
        return 2;
    }
    aisle_settings_defaults(&settings);
    if (aisle_engine_start(&engine, &settings, 1, 64, message) != AISLE_OK) {
        (void)fprintf(stderr, "%s\n", message);
        return 2;
    }
    aisle_log_event event;
    while (aisle_log_next(&reader, &event)) {
        handle(&event);
    }
    aisle_engine_stop(&engine);
    (void)fclose(file);
    return fclose(out) == 0 ? 0 : 2;
}
