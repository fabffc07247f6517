// aisle-replay - an LCM log of inputs through the planner, without any bus: prints, compares, measures.
#include "aisle/version.h"
#include "base/check.h"
#include "daemon/engine.h"
#include "daemon/options.h"
#include "daemon/record.h"
#include "replay/bench.h"
#include "replay/check.h"
#include "replay/report.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { EXIT_GOOD = 0, EXIT_TROUBLE = 1, EXIT_USAGE = 2 };

#define REPEAT_DEFAULT 200U
#define REPEAT_MAX 1000000

static const char help[] =
    "aisle-replay runs the inputs of an LCM log through the planner and prints each path.\n"
    "usage: aisle-replay LOG [--prefix NAME] [--config FILE] [--check] [--out FILE] [--json FILE]\n"
    "       aisle-replay LOG --bench [--cached [--proofs]] [--repeat N] [--prefix NAME] [--config FILE] [--json FILE]\n"
    "  --prefix NAME   of the channels in the log; AISLE by default\n"
    "  --config FILE   settings of aisled: limits, vehicle and budget must be those of the recording\n"
    "  --check         compare with the paths recorded in the log, byte for byte but for the host's clock\n"
    "  --out FILE      write inputs and outputs as a new log\n"
    "  --json FILE     write the results as JSON\n"
    "  --bench         run each query many times on the layout in force and print milliseconds\n"
    "  --cached        with answers remembered: all runs but the first are hits (else none is)\n"
    "  --proofs        and each hit is proved as a whole, under a revision of its own\n"
    "  --repeat N      that many times, 200 by default\n"
    "Ends with 0, or 1 on trouble or when --check finds a difference, or 2 on wrong options or settings.\n";

typedef struct arguments {
    const char *log, *prefix, *config, *out, *json, *repeat;
    bool check, bench, cached, proofs, version, help;
} arguments;

// Everything the tool holds besides the engine's block.
static struct {
    arguments given;
    aisle_settings settings;
    aisle_engine engine;
    FILE *in, *out, *json;
    aisle_log_reader log;
    aisle_replay replay;
    aisle_replay_sums sums;
    aisle_check check;
    aisle_bench bench;
    int64_t written; // events of the new log
    bool failed;     // memory or a file gave out
} tool;

void aisle_assert_failed(const char *file, int line, const char *condition) {
    (void)fprintf(stderr, "aisle-replay: %s:%d: invariant does not hold: %s\n", file, line, condition);
    abort();
}

static int complain(int code, const char *what, const char *name) {
    (void)fprintf(stderr, "aisle-replay: %s%s%s\n", name == NULL ? "" : name, name == NULL ? "" : ": ", what);
    return code;
}

static bool parse(arguments *out, int argc, char **argv, char *message) {
    const aisle_option options[] = {
        {"--prefix", NULL, &out->prefix}, {"--config", NULL, &out->config},   {"--out", NULL, &out->out},
        {"--json", NULL, &out->json},     {"--repeat", NULL, &out->repeat},   {"--check", &out->check, NULL},
        {"--bench", &out->bench, NULL},   {"--version", &out->version, NULL}, {"--help", &out->help, NULL},
        {"--cached", &out->cached, NULL}, {"--proofs", &out->proofs, NULL},
    };
    size_t plain = 0;
    return aisle_options_parse(options, sizeof options / sizeof options[0], argc, argv, &out->log, 1, &plain, message);
}

static double seconds_now(void) {
    struct timespec t = {0, 0};
    (void)clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + (double)t.tv_nsec * 1e-9;
}

static void write_event(int64_t utime, const char *channel, size_t length, const uint8_t *bytes, size_t size) {
    if (tool.out == NULL) {
        return;
    }
    aisle_log_event event = {.number = tool.written++,
                             .utime = utime,
                             .channel = channel,
                             .channel_length = length,
                             .bytes = bytes,
                             .size = size};
    tool.failed = !aisle_log_write(tool.out, &event) || tool.failed;
}

static void on_output(void *ctx, const aisle_replay_output *output) {
    char name[AISLE_CHANNEL_NAME_LEN];
    (void)ctx;
    aisle_report_path(output, &tool.sums, stdout, tool.json);
    aisle_channel_name(tool.settings.prefix, output->channel, name);
    write_event(output->utime, name, strlen(name), output->bytes, output->size);
    if (tool.given.check && !output->renewal) {
        tool.failed = !aisle_check_made(&tool.check, output->channel, output->bytes, output->size) || tool.failed;
    }
}

static void handle(const aisle_log_event *event) {
    uint32_t units;
    if (aisle_record_is_step(tool.settings.prefix, event->channel, event->channel_length, event->bytes, event->size,
                             &units)) {
        write_event(event->utime, event->channel, event->channel_length, event->bytes, event->size);
        aisle_replay_step(&tool.replay, event->utime, units);
        return;
    }
    aisle_channel channel = aisle_channel_find(tool.settings.prefix, event->channel, event->channel_length);
    if (channel == AISLE_CHANNEL_COUNT) {
        return;
    }
    if ((int)channel >= AISLE_CHANNEL_INPUTS) { // recorded: what the planner did by itself until then is due as well
        aisle_replay_advance(&tool.replay, event->utime);
        if (tool.given.check && aisle_check_covers(channel)) {
            aisle_check_recorded(&tool.check, channel, event->bytes, event->size);
        }
        return;
    }
    write_event(event->utime, event->channel, event->channel_length, event->bytes, event->size);
    if (tool.given.bench && channel == AISLE_CHANNEL_QUERY) {
        tool.failed =
            !aisle_bench_query(&tool.bench, &tool.replay, event->utime, event->bytes, event->size) || tool.failed;
    } else {
        aisle_replay_input(&tool.replay, event->utime, channel, event->bytes, event->size);
    }
}

// The whole log. Returns the exit code.
static int replay_log(void) {
    bool bench = tool.given.bench;
    aisle_replay_init(&tool.replay, tool.engine.planner, bench ? aisle_bench_sink : on_output, &tool.bench);
    double start = seconds_now();
    aisle_log_event event;
    while (!tool.failed && aisle_log_next(&tool.log, &event)) {
        handle(&event);
    }
    bool good = !tool.given.check || aisle_check_finish(&tool.check);
    aisle_replay_summary summary = {.log_name = tool.given.log,
                                    .log = &tool.log,
                                    .replay = &tool.replay,
                                    .sums = &tool.sums,
                                    .check = tool.given.check ? &tool.check : NULL,
                                    .seconds = seconds_now() - start};
    if (bench) {
        aisle_bench_finish(&tool.bench);
    } else {
        aisle_report_summary(&summary, stdout);
    }
    if (tool.json != NULL) {
        (void)fprintf(tool.json, bench ? "" : "\n  ]");
        aisle_report_json_summary(&summary, tool.json);
        (void)fprintf(tool.json, "\n}\n");
    }
    if (tool.failed) {
        return complain(EXIT_TROUBLE, "memory or disk gave out", NULL);
    }
    return good ? EXIT_GOOD : complain(EXIT_TROUBLE, "the replay differs from the record", tool.given.log);
}

static bool open_file(const char *name, const char *mode, FILE **file) {
    *file = name == NULL ? NULL : fopen(name, mode);
    return name == NULL || *file != NULL;
}

static bool close_file(FILE *file) {
    bool bad = file != NULL && ferror(file) != 0;
    return file == NULL || (fclose(file) == 0 && !bad);
}

static int run_files(uint32_t repeat) {
    const arguments *given = &tool.given;
    if (!open_file(given->log, "rb", &tool.in)) {
        return complain(EXIT_TROUBLE, strerror(errno), given->log);
    }
    if (!aisle_log_open(&tool.log, tool.in)) {
        return complain(EXIT_TROUBLE, "not a file that can be read twice", given->log);
    }
    if (!open_file(given->out, "wb", &tool.out)) {
        return complain(EXIT_TROUBLE, strerror(errno), given->out);
    }
    if (!open_file(given->json, "w", &tool.json)) {
        return complain(EXIT_TROUBLE, strerror(errno), given->json);
    }
    if (tool.json != NULL) {
        (void)fprintf(tool.json, "{\n  \"%s\": [", given->bench ? "queries" : "paths");
    }
    aisle_check_init(&tool.check, stdout);
    if (given->bench) {
        aisle_bench_init(&tool.bench, repeat, stdout, tool.json);
        tool.bench.again = given->proofs;
    }
    int code = replay_log();
    (void)close_file(tool.in);
    if (!close_file(tool.out) || !close_file(tool.json)) {
        code = complain(EXIT_TROUBLE, "the disk gave out", NULL);
    }
    return code;
}

static bool parse_repeat(const char *text, uint32_t *out) {
    char *end = NULL;
    *out = REPEAT_DEFAULT;
    if (text == NULL) {
        return true;
    }
    errno = 0;
    long value = strtol(text, &end, 10);
    if (errno != 0 || end == text || *end != '\0' || value < 1 || value > REPEAT_MAX) {
        return false;
    }
    *out = (uint32_t)value;
    return true;
}

static int start(void) {
    const arguments *given = &tool.given;
    char message[AISLE_SETTINGS_MESSAGE_LEN];
    uint32_t repeat = 0;
    if (!parse_repeat(given->repeat, &repeat)) {
        return complain(EXIT_USAGE, "not a number of times; allowed: 1 to 1000000", "--repeat");
    }
    if (given->bench && (given->check || given->out != NULL)) {
        return complain(EXIT_USAGE, "--bench goes without --check and --out; see --help", NULL);
    }
    if ((given->cached && !given->bench) || (given->proofs && !given->cached)) {
        return complain(EXIT_USAGE, "--cached goes with --bench, --proofs with --cached; see --help", NULL);
    }
    aisle_settings_defaults(&tool.settings);
    if (given->config != NULL && aisle_settings_read(&tool.settings, given->config, message) != AISLE_OK) {
        (void)fprintf(stderr, "%s\n", message);
        return EXIT_USAGE;
    }
    if (given->prefix != NULL &&
        aisle_settings_set(&tool.settings, "bus", "prefix", given->prefix, message) != AISLE_OK) {
        return complain(EXIT_USAGE, message, NULL);
    }
    tool.settings.remember = tool.settings.remember && (!given->bench || given->cached);
    aisle_status status = aisle_engine_start(&tool.engine, &tool.settings, 1, 0, message);
    if (status != AISLE_OK) {
        return complain(status == AISLE_ERR_ARG ? EXIT_USAGE : EXIT_TROUBLE, message, NULL);
    }
    int code = run_files(repeat);
    aisle_engine_stop(&tool.engine);
    return code;
}

int main(int argc, char **argv) {
    char message[AISLE_OPTIONS_MESSAGE_LEN];
    if (!parse(&tool.given, argc, argv, message)) {
        return complain(EXIT_USAGE, message, NULL);
    }
    if (tool.given.help || tool.given.version) {
        (void)printf("%s", tool.given.help ? help : "aisle-replay " AISLE_VERSION "\n");
        return EXIT_GOOD;
    }
    if (tool.given.log == NULL) {
        return complain(EXIT_USAGE, "a log is missing; see --help", NULL);
    }
    return start();
}
