// aisle-sim - drives a simulated vehicle through a hall of moving obstacles, planned for by the core in this process.
#include "aisle/version.h"
#include "daemon/options.h"
#include "sim/batch.h"
#include "sim/report.h"

#include <errno.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#define ATTEMPTS 5 // to have the set-up taken

enum { EXIT_GOOD = 0, EXIT_TROUBLE = 1, EXIT_USAGE = 2 };

static const char help[] =
    "aisle-sim drives a simulated vehicle and says what came of it.\n"
    "usage: aisle-sim LOG [options]\n"
    "       aisle-sim --drawn SEED [--kind KIND] [--count N] [options]\n"
    "       aisle-sim --batch N [--kind KIND] [--count N] [--seed N] [--drives N] [--told] [--json FILE]\n"
    "LOG is an LCM log with layout, vehicle, the pose to start from and the goals (aisle map, vehicle, goal --log).\n"
    "--drawn draws hall, vehicle, goals and movers from the seed, --batch runs drawn drives until N encounters are "
    "done.\n"
    "  --kind KIND     of the movers drawn; all kinds by default. --count N: so many of each\n"
    "  --drives N      at most so many in a batch; --told names those that did not arrive, too\n"
    "  --blind         nobody tells of the movers: what would happen without care\n"
    "  --movers LIST   KIND:COUNT[:V_BOUND],...; kinds: constant, jumps, agv, person, adversarial\n"
    "  --tracks FILE   recorded ways, CSV; --place X,Y,TURN,SCALE puts their middle there (m, m, rad, 1)\n"
    "  --seed N        of everything drawn; 1 by default\n"
    "  --time S        ends then; by default after ten times the way without movers and a minute\n"
    "  --room M        between vehicle and movers at first, 2 by default\n"
    "  --sources N     1 to 4 sources share the movers\n"
    "  --faults LIST   KIND:AT:LASTS[:AMOUNT],...; kinds: pose_silent, unlocalized, pose_jump, obstacles_silent, "
    "paths_lost,\n"
    "                  push, slow, hold. With --drawn and --batch: any word, and they are drawn\n"
    "  --script LOG    goal lists, commands, layouts and patches for later: an event's time after the log's first one "
    "is\n"
    "                  its time after the goals\n"
    "  --late S        paths are so much longer under way to the vehicle, beside 10 to 20 ms\n"
    "  --units-per-ms N  planning takes time: so many work units a millisecond; 4000 are about a desktop core\n"
    "  --bus URL       aisled on this LCM bus plans, in real time; \"\" is LCM's default\n"
    "  --out FILE      an LCM log of all that went in and came out, for aisle-replay --check\n"
    "  --json FILE     the figures as JSON\n"
    "  --truth FILE    where everything truly was, CSV\n"
    "  --prefix NAME   of the channels; AISLE by default\n"
    "  --config FILE   settings of aisled\n"
    "Ends with 0: arrived without a collision; 1: not so, or trouble; 2: wrong options or settings.\n";

typedef struct arguments {
    const char *script, *units, *late, *faults, *bus, *drawn, *batch, *kind, *count, *drives;
    bool told, blind;
    const char *log, *movers, *tracks, *place, *seed, *time, *room, *sources, *out, *json, *truth, *prefix, *config;
    bool version, help;
} arguments;

static struct {
    arguments given;
    aisle_settings settings;
    aisle_sim_setup setup;
    aisle_sim_tracks tracks;
    aisle_sim_drawn drawn;
    aisle_sim_batch batch;
    aisle_sim_host host;
    aisle_sim_episode episode;
    aisle_log_reader log;
    FILE *in, *out, *json;
    uint64_t units; // a millisecond; 0: planning takes no time
} tool;

void aisle_assert_failed(const char *file, int line, const char *condition) {
    (void)fprintf(stderr, "aisle-sim: %s:%d: invariant does not hold: %s\n", file, line, condition);
    abort();
}

static int complain(int code, const char *what, const char *name) {
    (void)fprintf(stderr, "aisle-sim: %s%s%s\n", name == NULL ? "" : name, name == NULL ? "" : ": ", what);
    return code;
}

static bool parse(arguments *out, int argc, char **argv, char *message) {
    const aisle_option options[] = {
        {"--movers", NULL, &out->movers},   {"--tracks", NULL, &out->tracks},
        {"--place", NULL, &out->place},     {"--seed", NULL, &out->seed},
        {"--time", NULL, &out->time},       {"--room", NULL, &out->room},
        {"--sources", NULL, &out->sources}, {"--out", NULL, &out->out},
        {"--json", NULL, &out->json},       {"--truth", NULL, &out->truth},
        {"--prefix", NULL, &out->prefix},   {"--config", NULL, &out->config},
        {"--drawn", NULL, &out->drawn},     {"--batch", NULL, &out->batch},
        {"--kind", NULL, &out->kind},       {"--count", NULL, &out->count},
        {"--drives", NULL, &out->drives},   {"--bus", NULL, &out->bus},
        {"--script", NULL, &out->script},   {"--units-per-ms", NULL, &out->units},
        {"--late", NULL, &out->late},       {"--faults", NULL, &out->faults},
        {"--told", &out->told, NULL},       {"--blind", &out->blind, NULL},
        {"--version", &out->version, NULL}, {"--help", &out->help, NULL},
    };
    size_t plain = 0;
    return aisle_options_parse(options, sizeof options / sizeof options[0], argc, argv, &out->log, 1, &plain, message);
}

// ---- options

static bool read_number(const char *text, double lo, double hi, double *out) {
    char *end = NULL;
    if (text == NULL) {
        return true;
    }
    *out = strtod(text, &end);
    return end != text && *end == '\0' && *out >= lo && *out <= hi;
}

// One KIND:COUNT[:V_BOUND] up to the comma.
static bool read_group(const char *text, size_t length, aisle_sim_group *out) {
    char copy[64], kind[16];
    unsigned count = 0;
    double v_bound = 0.0;
    int end = 0;
    if (length >= sizeof copy) {
        return false;
    }
    memcpy(copy, text, length);
    copy[length] = '\0';
    bool good = (sscanf(copy, "%15[a-z]:%u%n", kind, &count, &end) == 2 && (size_t)end == length) ||
                (sscanf(copy, "%15[a-z]:%u:%lf%n", kind, &count, &v_bound, &end) == 3 && (size_t)end == length);
    *out = (aisle_sim_group){.kind = aisle_sim_kind_of(good ? kind : ""), .count = count, .v_bound = v_bound};
    return good && out->kind < AISLE_SIM_TRACK && count <= AISLE_OBSTACLES_MAX_OBSTACLES && v_bound >= 0.0 &&
           v_bound <= 10.0;
}

static bool read_movers(const char *text, aisle_sim_setup *setup) {
    while (text != NULL && *text != '\0') {
        size_t length = strcspn(text, ",");
        if (setup->num_groups == AISLE_SIM_GROUPS_MAX ||
            !read_group(text, length, &setup->group[setup->num_groups++])) {
            return false;
        }
        text += length + (text[length] == ',' ? 1 : 0);
    }
    return true;
}

static int read_tracks(const arguments *given) {
    char message[AISLE_SIM_TRACKS_MESSAGE_LEN];
    double x, y, turn, scale;
    int end = 0;
    if (given->tracks == NULL) {
        return EXIT_GOOD;
    }
    if (!aisle_sim_tracks_read(&tool.tracks, given->tracks, message)) {
        return complain(EXIT_TROUBLE, message, NULL);
    }
    if (given->place != NULL) {
        if (sscanf(given->place, "%lf,%lf,%lf,%lf%n", &x, &y, &turn, &scale, &end) != 4 || given->place[end] != '\0' ||
            !(scale > 0.0 && scale <= 100.0 && fabs(turn) <= 10.0)) {
            return complain(EXIT_USAGE, "not X,Y,TURN,SCALE", "--place");
        }
        aisle_sim_tracks_map(&tool.tracks, aisle_vec2_of(x, y), turn, scale);
    }
    tool.setup.tracks = &tool.tracks;
    return EXIT_GOOD;
}

static bool read_whole(const char *text, uint64_t *out) {
    double value = (double)*out;
    bool good = read_number(text, 0.0, 9007199254740992.0, &value) && floor(value) == value;
    *out = good ? (uint64_t)value : 0;
    return good;
}

// What the drawn drives of one kind have in common.
static int read_kind(const arguments *given, aisle_sim_kind *kind, uint64_t *count) {
    *kind =
        given->kind == NULL || strcmp(given->kind, "all") == 0 ? AISLE_SIM_KIND_COUNT : aisle_sim_kind_of(given->kind);
    if (given->kind != NULL && strcmp(given->kind, "all") != 0 && *kind >= AISLE_SIM_TRACK) {
        return complain(EXIT_USAGE, "no such kind; see --help", "--kind");
    }
    *count = 0;
    if (!read_whole(given->count, count) || *count > 51) {
        return complain(EXIT_USAGE, "not a number of movers; allowed: 0 to 51", "--count");
    }
    return EXIT_GOOD;
}

static int draw_one(const arguments *given) {
    uint64_t seed = 0, count;
    aisle_sim_kind kind;
    if (!read_whole(given->drawn, &seed)) {
        return complain(EXIT_USAGE, "not a whole number from 0 on", "--drawn");
    }
    int code = read_kind(given, &kind, &count);
    if (code == EXIT_GOOD) {
        aisle_sim_draw(&tool.drawn, seed, kind, (uint32_t)count);
        if (given->faults != NULL) {
            aisle_sim_draw_faults(&tool.drawn);
        }
        tool.setup = tool.drawn.setup;
        tool.setup.num_sources = given->blind ? 0 : tool.setup.num_sources;
    }
    return code;
}

static int read_setup(const arguments *given) {
    double sources = 1.0, late = 0.0;
    uint64_t seed = 1;
    if (given->drawn != NULL) {
        return draw_one(given);
    }
    if (!read_whole(given->seed, &seed)) {
        return complain(EXIT_USAGE, "not a whole number from 0 on", "--seed");
    }
    tool.setup = aisle_sim_setup_usual(seed);
    if (!read_number(given->time, 0.0, 1e5, &tool.setup.time_limit) ||
        !read_number(given->room, 0.0, 1e3, &tool.setup.room) || !read_number(given->sources, 1.0, 4.0, &sources) ||
        !read_number(given->late, 0.0, 1.0, &late)) {
        return complain(EXIT_USAGE, "--time, --room, --sources or --late is out of range; see --help", NULL);
    }
    tool.setup.path_delay.least += late;
    tool.setup.path_delay.most += late;
    tool.setup.num_sources = given->blind ? 0 : (int32_t)sources;
    if (!read_movers(given->movers, &tool.setup)) {
        return complain(EXIT_USAGE, "not KIND:COUNT[:V_BOUND],...; see --help", "--movers");
    }
    if (given->faults != NULL && !aisle_sim_faults_read(&tool.setup.faults, given->faults)) {
        return complain(EXIT_USAGE, "not KIND:AT:LASTS[:AMOUNT],...; see --help", "--faults");
    }
    return read_tracks(given);
}

// ---- running

static bool open_file(const char *name, const char *mode, FILE **file) {
    *file = name == NULL ? NULL : fopen(name, mode);
    return name == NULL || *file != NULL || complain(EXIT_TROUBLE, strerror(errno), name) == EXIT_GOOD;
}

static bool close_file(FILE *file) {
    bool bad = file != NULL && ferror(file) != 0;
    return file == NULL || (fclose(file) == 0 && !bad);
}

// Feeds the set-up, drawn or of the log.
static bool prepare(void) {
    aisle_log_event event;
    if (tool.given.drawn != NULL) {
        return aisle_sim_drawn_prepare(&tool.drawn, &tool.episode);
    }
    while (aisle_log_next(&tool.log, &event)) {
        aisle_channel channel = aisle_channel_find(tool.settings.prefix, event.channel, event.channel_length);
        if ((int)channel < AISLE_CHANNEL_INPUTS &&
            !aisle_sim_episode_prepare(&tool.episode, channel, event.bytes, event.size)) {
            return false;
        }
    }
    return true;
}

// Hands over the messages for later.
static bool read_script(const char *name) {
    FILE *file = NULL;
    aisle_log_event event;
    int64_t first = 0;
    if (name == NULL || !open_file(name, "rb", &file)) {
        return name == NULL;
    }
    bool good = aisle_log_open(&tool.log, file);
    while (good && aisle_log_next(&tool.log, &event)) {
        first = tool.log.events == 1 ? event.utime : first;
        aisle_channel channel = aisle_channel_find(tool.settings.prefix, event.channel, event.channel_length);
        good = (int)channel >= AISLE_CHANNEL_INPUTS ||
               aisle_sim_episode_script(&tool.episode, (double)(event.utime - first) * 1e-6, channel, event.bytes,
                                        event.size);
    }
    (void)close_file(file);
    return good || complain(EXIT_TROUBLE, "a message of the script cannot be used", name) == EXIT_GOOD;
}

// On a bus again and again until the daemon holds it.
static bool prepare_held(void) {
    for (int attempt = 0; attempt < ATTEMPTS; attempt++) {
        aisle_sim_episode_forget(&tool.episode);
        if (!prepare()) {
            return complain(EXIT_TROUBLE, "a message of the set-up cannot be used", tool.given.log) == EXIT_GOOD;
        }
        if (tool.host.lcm == NULL) {
            return true;
        }
        for (int i = 0; i < 20 && !aisle_sim_episode_is_held(&tool.episode); i++) {
            aisle_sim_episode_wait(&tool.episode, 0.1);
        }
        if (aisle_sim_episode_is_held(&tool.episode)) {
            return true;
        }
    }
    return complain(EXIT_TROUBLE, "the daemon does not take layout and vehicle", NULL) == EXIT_GOOD;
}

static aisle_status start_host(char *message) {
    if (tool.given.bus != NULL) {
        return aisle_sim_host_start_bus(&tool.host, tool.given.bus, tool.settings.prefix, tool.out,
                                        aisle_sim_episode_hear, &tool.episode, message);
    }
    aisle_status status =
        aisle_sim_host_start_core(&tool.host, &tool.settings, tool.out, aisle_sim_episode_hear, &tool.episode, message);
    if (status == AISLE_OK && tool.units > 0 &&
        !aisle_sim_host_slice(&tool.host, (uint32_t)tool.units, tool.given.out)) {
        (void)snprintf(message, AISLE_SETTINGS_MESSAGE_LEN, "%s: %s", tool.given.out, strerror(errno));
        return AISLE_ERR_CAPACITY;
    }
    return status;
}

static int run(void) {
    char message[AISLE_SETTINGS_MESSAGE_LEN];
    aisle_status status = start_host(message);
    if (status != AISLE_OK) {
        return complain(status == AISLE_ERR_ARG ? EXIT_USAGE : EXIT_TROUBLE, message, NULL);
    }
    aisle_sim_episode_start(&tool.episode, &tool.setup, &tool.host);
    if (!prepare_held() || !read_script(tool.given.script)) {
        return EXIT_TROUBLE;
    }
    if (!aisle_sim_episode_run(&tool.episode, message)) {
        return complain(EXIT_TROUBLE, message, tool.given.log);
    }
    aisle_sim_report_text(&tool.episode, stdout);
    if (tool.json != NULL) {
        aisle_sim_report_json(&tool.episode, tool.json);
    }
    const aisle_sim_judge *judge = &tool.episode.judge;
    return tool.episode.arrived && judge->collisions + judge->static_collisions == 0 ? EXIT_GOOD : EXIT_TROUBLE;
}

static int run_files(void) {
    const arguments *given = &tool.given;
    if (!open_file(given->log, "rb", &tool.in) || !open_file(tool.units > 0 ? NULL : given->out, "wb", &tool.out) ||
        !open_file(given->json, "w", &tool.json) || !open_file(given->truth, "w", &tool.setup.truth)) {
        return EXIT_TROUBLE;
    }
    if (tool.in != NULL && !aisle_log_open(&tool.log, tool.in)) {
        return complain(EXIT_TROUBLE, "not a file that can be read twice", given->log);
    }
    int code = run();
    aisle_sim_episode_end(&tool.episode);
    aisle_sim_host_stop(&tool.host);
    aisle_sim_tracks_free(&tool.tracks);
    if (!close_file(tool.in) || !close_file(tool.out) || !close_file(tool.json) || !close_file(tool.setup.truth)) {
        code = complain(EXIT_TROUBLE, "the disk gave out", NULL);
    }
    return code;
}

static double seconds_now(void) {
    struct timespec t = {0, 0};
    (void)clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + (double)t.tv_nsec * 1e-9;
}

static int run_batch(const arguments *given) {
    uint64_t first = 1, encounters = 0, count, drives = INT64_MAX / 2;
    aisle_sim_kind kind;
    if (!read_whole(given->batch, &encounters) || !read_whole(given->seed, &first)) {
        return complain(EXIT_USAGE, "--batch and --seed are whole numbers from 0 on", NULL);
    }
    if (given->drives != NULL && !read_whole(given->drives, &drives)) {
        return complain(EXIT_USAGE, "not a whole number from 0 on", "--drives");
    }
    int code = read_kind(given, &kind, &count);
    if (code != EXIT_GOOD || !open_file(given->json, "w", &tool.json)) {
        return code != EXIT_GOOD ? code : EXIT_TROUBLE;
    }
    aisle_sim_batch *batch = &tool.batch;
    aisle_sim_batch_start(batch, kind, first);
    batch->settings = tool.settings;
    batch->num_movers = (uint32_t)count;
    batch->encounters = (int64_t)encounters;
    batch->episodes = (int64_t)drives;
    batch->told = given->told;
    batch->blind = given->blind;
    batch->faults = given->faults != NULL;
    batch->units_per_ms = (uint32_t)tool.units;
    double start = seconds_now();
    if (!aisle_sim_batch_run(batch, stdout)) {
        return complain(EXIT_TROUBLE, "memory gave out", NULL);
    }
    aisle_sim_batch_report(batch, seconds_now() - start, stdout);
    if (tool.json != NULL) {
        aisle_sim_batch_json(batch, seconds_now() - start, tool.json);
    }
    if (!close_file(tool.json)) {
        return complain(EXIT_TROUBLE, "the disk gave out", NULL);
    }
    return batch->with_collision == 0 ? EXIT_GOOD : EXIT_TROUBLE;
}

static int start(void) {
    char message[AISLE_SETTINGS_MESSAGE_LEN];
    const arguments *given = &tool.given;
    aisle_settings_defaults(&tool.settings);
    if (given->config != NULL && aisle_settings_read(&tool.settings, given->config, message) != AISLE_OK) {
        (void)fprintf(stderr, "%s\n", message);
        return EXIT_USAGE;
    }
    if (given->prefix != NULL &&
        aisle_settings_set(&tool.settings, "bus", "prefix", given->prefix, message) != AISLE_OK) {
        return complain(EXIT_USAGE, message, NULL);
    }
    if (!read_whole(given->units, &tool.units) || tool.units > 1000000) {
        return complain(EXIT_USAGE, "not a whole number from 0 to 1000000", "--units-per-ms");
    }
    if (given->batch != NULL) {
        return run_batch(given);
    }
    int code = read_setup(given);
    return code == EXIT_GOOD ? run_files() : code;
}

int main(int argc, char **argv) {
    char message[AISLE_OPTIONS_MESSAGE_LEN];
    if (!parse(&tool.given, argc, argv, message)) {
        return complain(EXIT_USAGE, message, NULL);
    }
    if (tool.given.help || tool.given.version) {
        (void)printf("%s", tool.given.help ? help : "aisle-sim " AISLE_VERSION "\n");
        return EXIT_GOOD;
    }
    const arguments *given = &tool.given;
    if ((given->log != NULL) + (given->drawn != NULL) + (given->batch != NULL) != 1) {
        return complain(EXIT_USAGE, "one of LOG, --drawn and --batch; see --help", NULL);
    }
    return start();
}
