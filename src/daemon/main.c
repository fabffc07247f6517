// aisled - the daemon: settings, one block of memory, the bus, the loop, and a clean end.
#include "aisle/version.h"
#include "base/check.h"
#include "daemon/engine.h"
#include "daemon/loop.h"
#include "daemon/options.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

enum { EXIT_OK = 0, EXIT_TROUBLE = 1, EXIT_USAGE = 2 };

static const char help[] =
    "aisled plans motion for an automated guided vehicle: LCM messages in, proved paths out.\n"
    "usage: aisled [--config FILE] [--lcm-url URL] [--prefix NAME] [--record FILE]\n"
    "  --config FILE    settings (see aisled.ini); without it all is at its default\n"
    "  --lcm-url URL    the bus, e.g. udpm://239.255.76.67:7667?ttl=1; goes before [bus] url\n"
    "  --prefix NAME    of every channel, AISLE by default; goes before [bus] prefix\n"
    "  --record FILE    a log of all that is taken and answered; aisle-replay gives the same bytes from it\n"
    "  --check-config   say whether the settings are good, and end\n"
    "  --memory         print the bytes of every pool with these settings, and end\n"
    "  --version        print the version, and end\n"
    "  --help           print this, and end\n"
    "Ends with 0 when stopped by SIGTERM or SIGINT, 1 on trouble, 2 on wrong options or settings.\n";

typedef struct arguments {
    const char *config, *url, *prefix, *record;
    bool check_config, memory, version, help;
} arguments;

// Everything aisled holds besides the engine's block.
static struct {
    aisle_settings settings;
    aisle_engine engine;
    aisle_inbox inbox;
    aisle_bus bus;
    aisle_clock clock;
    aisle_notify notify;
    aisle_record record;
    aisle_loop loop;
} daemon_state;

static int stop_pipe[2] = {-1, -1};

void aisle_assert_failed(const char *file, int line, const char *condition) {
    (void)fprintf(stderr, "aisled: %s:%d: invariant does not hold: %s\n", file, line, condition);
    abort();
}

static void on_stop(int signal_number) {
    int saved = errno;
    (void)signal_number;
    if (write(stop_pipe[1], "", 1) < 0) { // full: stop was asked for already
    }
    errno = saved;
}

// SIGTERM and SIGINT make stop_pipe[0] readable. A peer that goes away must not end us.
static bool catch_signals(void) {
    struct sigaction stop = {.sa_handler = on_stop, .sa_flags = SA_RESTART}, ignore = {.sa_handler = SIG_IGN};
    (void)sigemptyset(&stop.sa_mask);
    (void)sigemptyset(&ignore.sa_mask);
    return pipe(stop_pipe) == 0 && fcntl(stop_pipe[0], F_SETFD, FD_CLOEXEC) == 0 &&
           fcntl(stop_pipe[1], F_SETFD, FD_CLOEXEC) == 0 && fcntl(stop_pipe[1], F_SETFL, O_NONBLOCK) == 0 &&
           sigaction(SIGTERM, &stop, NULL) == 0 && sigaction(SIGINT, &stop, NULL) == 0 &&
           sigaction(SIGPIPE, &ignore, NULL) == 0;
}

static int complain(int code, const char *what) {
    (void)fprintf(stderr, "aisled: %s\n", what);
    return code;
}

static bool parse(arguments *out, int argc, char **argv, char *message) {
    const aisle_option options[] = {
        {"--config", NULL, &out->config}, {"--lcm-url", NULL, &out->url},
        {"--prefix", NULL, &out->prefix}, {"--check-config", &out->check_config, NULL},
        {"--memory", &out->memory, NULL}, {"--version", &out->version, NULL},
        {"--record", NULL, &out->record}, {"--help", &out->help, NULL},
    };
    size_t plain = 0;
    return aisle_options_parse(options, sizeof options / sizeof options[0], argc, argv, NULL, 0, &plain, message);
}

// Defaults, file, command line; 0 or the exit code after a line on stderr.
static int read_settings(const arguments *given, aisle_settings *out) {
    char message[AISLE_SETTINGS_MESSAGE_LEN];
    aisle_settings_defaults(out);
    if (given->config != NULL && aisle_settings_read(out, given->config, message) != AISLE_OK) {
        (void)fprintf(stderr, "%s\n", message);
        return EXIT_USAGE;
    }
    if ((given->url != NULL && aisle_settings_set(out, "bus", "url", given->url, message) != AISLE_OK) ||
        (given->prefix != NULL && aisle_settings_set(out, "bus", "prefix", given->prefix, message) != AISLE_OK)) {
        return complain(EXIT_USAGE, message);
    }
    return EXIT_OK;
}

// Keeps what is in RAM there; pages not used yet are locked when they are.
static bool lock_memory(void) {
#ifdef MCL_ONFAULT
    return mlockall(MCL_CURRENT | MCL_FUTURE | MCL_ONFAULT) == 0;
#else
    return mlockall(MCL_CURRENT | MCL_FUTURE) == 0;
#endif
}

static int64_t utime_now(void) {
    return aisle_clock_utime(&daemon_state.clock, aisle_clock_monotonic(&daemon_state.clock));
}

static int run(const char *record) {
    const aisle_settings *settings = &daemon_state.settings;
    if (!catch_signals()) {
        return complain(EXIT_TROUBLE, "signals cannot be caught");
    }
    if (settings->mlock && !lock_memory()) {
        return complain(EXIT_TROUBLE, "[daemon] mlock: memory cannot be locked; raise LimitMEMLOCK= or ulimit -l");
    }
    aisle_inbox_init(&daemon_state.inbox, daemon_state.engine.extra, daemon_state.engine.extra_bytes);
    aisle_clock_start(&daemon_state.clock, aisle_clock_of_host());
    (void)aisle_notify_open(&daemon_state.notify, getenv("NOTIFY_SOCKET"), getenv("WATCHDOG_USEC"),
                            getenv("WATCHDOG_PID"));
    if (!aisle_record_open(&daemon_state.record, record, settings->prefix, utime_now())) {
        return complain(EXIT_TROUBLE, "--record: the file cannot be written");
    }
    if (aisle_bus_open(&daemon_state.bus, settings->url, settings->prefix, &daemon_state.inbox) != AISLE_OK) {
        return complain(EXIT_TROUBLE, "the bus cannot be joined; is there a multicast route? see --lcm-url");
    }
    aisle_loop_init(&daemon_state.loop, &(aisle_loop_parts){.settings = settings,
                                                            .planner = daemon_state.engine.planner,
                                                            .arena_bytes = daemon_state.engine.planner_bytes,
                                                            .bus = &daemon_state.bus,
                                                            .clock = &daemon_state.clock,
                                                            .notify = &daemon_state.notify,
                                                            .record = &daemon_state.record,
                                                            .stop_fd = stop_pipe[0]});
    aisle_loop_end end = aisle_loop_run(&daemon_state.loop);
    aisle_bus_close(&daemon_state.bus);
    aisle_notify_close(&daemon_state.notify);
    aisle_record_close(&daemon_state.record);
    return end == AISLE_LOOP_STOPPED ? EXIT_OK : complain(EXIT_TROUBLE, "the bus broke");
}

static int start(const arguments *given) {
    char message[AISLE_SETTINGS_MESSAGE_LEN];
    aisle_settings *settings = &daemon_state.settings;
    int code = read_settings(given, settings);
    if (code != EXIT_OK) {
        return code;
    }
    aisle_status status =
        aisle_engine_start(&daemon_state.engine, settings, aisle_engine_boot_id(), settings->queue_bytes, message);
    if (status != AISLE_OK) {
        return complain(status == AISLE_ERR_ARG ? EXIT_USAGE : EXIT_TROUBLE, message);
    }
    if (given->check_config) {
        (void)printf("%s: good\n", given->config == NULL ? "defaults" : given->config);
    } else if (given->memory) {
        code = aisle_engine_print_memory(&daemon_state.engine, sizeof daemon_state, stdout) ? EXIT_OK : EXIT_TROUBLE;
    } else {
        code = run(given->record);
    }
    aisle_engine_stop(&daemon_state.engine);
    return code;
}

int main(int argc, char **argv) {
    arguments given = {0};
    char message[AISLE_OPTIONS_MESSAGE_LEN];
    if (!parse(&given, argc, argv, message)) {
        return complain(EXIT_USAGE, message);
    }
    if (given.help || given.version) {
        (void)printf("%s", given.help ? help : "aisled " AISLE_VERSION "\n");
        return EXIT_OK;
    }
    return start(&given);
}
