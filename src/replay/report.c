#include "replay/report.h"

#include "base/check.h"

#include <inttypes.h>

const char *aisle_report_path_status(int8_t status) {
    static const char *const names[] = {"OK", "PARTIAL", "STOP", "NONE"};
    return status >= 0 && status < 4 ? names[status] : "?";
}

static const char *channel_word(aisle_channel channel) {
    return channel == AISLE_CHANNEL_REPLY ? "reply" : "path";
}

static void print_text(aisle_channel channel, const aisle_path_msg *path, FILE *text) {
    if (channel == AISLE_CHANNEL_REPLY) {
        (void)fprintf(text, "reply query %-8" PRId32, path->query_id);
    } else {
        (void)fprintf(text, "path  goals %" PRId32 ".%" PRId32 " revision %" PRId32, path->goal_list_id,
                      path->goal_list_revision, path->path_revision);
    }
    (void)fprintf(text,
                  " %-7s %-14s length %8.3f bound %8.3f clearance %6.3f duration %7.2f work %8" PRId32
                  " waypoints %4d certificate %08" PRIx32,
                  aisle_report_path_status(path->status), path->cause == 0 ? "-" : aisle_cause_name(path->cause),
                  (double)path->length, (double)path->length_bound, (double)path->clearance_min, (double)path->duration,
                  path->work_units, path->num_waypoints, (uint32_t)path->certificate);
    if (path->cause != 0) {
        (void)fprintf(text, " cause_id %" PRId32 " cause_value %.3f", path->cause_id, (double)path->cause_value);
    }
    (void)fputc('\n', text);
}

static void print_json(aisle_channel channel, const aisle_path_msg *path, bool first, FILE *json) {
    (void)fprintf(json, "%s\n    {\"channel\": \"%s\", \"query_id\": %" PRId32 ", \"goal_list_id\": %" PRId32,
                  first ? "" : ",", channel_word(channel), path->query_id, path->goal_list_id);
    (void)fprintf(json, ", \"goal_list_revision\": %" PRId32 ", \"path_revision\": %" PRId32, path->goal_list_revision,
                  path->path_revision);
    (void)fprintf(json, ", \"status\": \"%s\", \"cause\": %d, \"cause_name\": \"%s\"",
                  aisle_report_path_status(path->status), path->cause,
                  path->cause == 0 ? "" : aisle_cause_name(path->cause));
    (void)fprintf(json, ", \"cause_id\": %" PRId32 ", \"cause_value\": %.9g", path->cause_id,
                  (double)path->cause_value);
    (void)fprintf(json, ", \"length\": %.9g, \"length_bound\": %.9g, \"clearance_min\": %.9g, \"duration\": %.9g",
                  (double)path->length, (double)path->length_bound, (double)path->clearance_min,
                  (double)path->duration);
    (void)fprintf(json, ", \"work_units\": %" PRId32 ", \"waypoints\": %d, \"certificate\": \"%08" PRIx32 "\"}",
                  path->work_units, path->num_waypoints, (uint32_t)path->certificate);
}

static void report_arm(const aisle_replay_output *output, bool first, aisle_replay_sums *sums, FILE *text, FILE *json) {
    static aisle_arm_path_msg path; // large; the tool has one thread
    const aisle_status status = aisle_msg_decode(AISLE_MSG_ARM_PATH, output->bytes, output->size, &path, NULL);
    AISLE_ASSERT(status == AISLE_OK); // the planner's own bytes
    const char *cause = path.cause == 0 ? "-" : aisle_cause_name(path.cause);
    sums->arms++;
    sums->arms_proved += path.status != AISLE_PATH_NONE ? 1 : 0;
    sums->work_units += path.work_units;
    if (text != NULL) {
        (void)fprintf(text,
                      "arm   goal %-8" PRId32 " %-7s %-14s duration %7.3f travel %7.3f clearance %6.4f work %8" PRId32
                      " waypoints %4d cause_id %" PRId32 "\n",
                      path.arm_goal_id, aisle_report_path_status(path.status), cause, (double)path.duration,
                      (double)path.travel, (double)path.clearance_min, path.work_units, path.num_waypoints,
                      path.cause_id);
    }
    if (json != NULL) {
        (void)fprintf(json,
                      "%s\n    {\"channel\": \"arm_path\", \"arm_goal_id\": %" PRId32
                      ", \"status\": \"%s\", \"cause\": %d, \"cause_id\": %" PRId32
                      ", \"duration\": %.9g, \"travel\": %.9g, \"clearance_min\": %.9g, \"work_units\": %" PRId32
                      ", \"waypoints\": %d}",
                      first ? "" : ",", path.arm_goal_id, aisle_report_path_status(path.status), path.cause,
                      path.cause_id, (double)path.duration, (double)path.travel, (double)path.clearance_min,
                      path.work_units, path.num_waypoints);
    }
}

void aisle_report_path(const aisle_replay_output *output, aisle_replay_sums *sums, FILE *text, FILE *json) {
    static aisle_path_msg path; // large; the tool has one thread
    if (output->channel == AISLE_CHANNEL_ARM_PATH) {
        report_arm(output, sums->replies + sums->paths + sums->arms == 0, sums, text, json);
        return;
    }
    aisle_status status = aisle_msg_decode(AISLE_MSG_PATH, output->bytes, output->size, &path, NULL);
    AISLE_ASSERT(status == AISLE_OK); // the planner's own bytes
    if (output->renewal) {
        sums->renewals++;
        return;
    }
    bool first = sums->replies + sums->paths + sums->arms == 0, proved = path.status != AISLE_PATH_NONE;
    sums->replies += output->channel == AISLE_CHANNEL_REPLY ? 1 : 0;
    sums->paths += output->channel == AISLE_CHANNEL_PATH ? 1 : 0;
    sums->proved += proved ? 1 : 0;
    sums->none += proved ? 0 : 1;
    sums->work_units += path.work_units;
    sums->waypoints += path.num_waypoints;
    sums->length += proved ? (double)path.length : 0.0;
    if (text != NULL) {
        print_text(output->channel, &path, text);
    }
    if (json != NULL) {
        print_json(output->channel, &path, first, json);
    }
}

void aisle_report_summary(const aisle_replay_summary *s, FILE *text) {
    const int64_t *counters = aisle_planner_counters(s->replay->planner);
    (void)fprintf(text,
                  "events %" PRId64 ", inputs %" PRId64 " (malformed %" PRId64 ", refused %" PRId64
                  "), cut off %" PRId64 ", garbage %" PRId64 " bytes\n",
                  s->log->events, s->replay->inputs, s->replay->malformed, s->replay->refused, s->log->cut_off,
                  s->log->garbage_bytes);
    (void)fprintf(text,
                  "replies %" PRId64 ", paths %" PRId64 ", renewals %" PRId64 "; proved %" PRId64 " (%.1f m, %" PRId64
                  " waypoints), without a path %" PRId64 "\n",
                  s->sums->replies, s->sums->paths, s->sums->renewals, s->sums->proved, s->sums->length,
                  s->sums->waypoints, s->sums->none);
    (void)fprintf(text,
                  "motions of the arm %" PRId64 ", proved %" PRId64 "; work units %" PRId64 ", grid nodes %" PRId64
                  ", swarm evaluations %" PRId64 ", verifier intervals %" PRId64 ", verifier refusals %" PRId64 "\n",
                  s->sums->arms, s->sums->arms_proved, counters[AISLE_COUNTER_WORK_UNITS],
                  counters[AISLE_COUNTER_NODES], counters[AISLE_COUNTER_SWARM_EVALS],
                  counters[AISLE_COUNTER_VERIFY_INTERVALS], counters[AISLE_COUNTER_VERIFY_FAILED]);
    (void)fprintf(text, "time %.3f s\n", s->seconds);
    if (s->check != NULL) {
        (void)fprintf(
            text, "check: equal %" PRId64 ", different %" PRId64 ", missing %" PRId64 ", not recorded %" PRId64 "\n",
            s->check->equal, s->check->different, s->check->missing, s->check->extra);
    }
}

void aisle_report_json_string(const char *text, FILE *json) {
    (void)fputc('"', json);
    for (const char *c = text; *c != '\0'; c++) {
        unsigned char byte = (unsigned char)*c;
        if (byte < 0x20U) {
            (void)fprintf(json, "\\u%04x", byte);
        } else {
            (void)fprintf(json, "%s%c", byte == '"' || byte == '\\' ? "\\" : "", byte);
        }
    }
    (void)fputc('"', json);
}

void aisle_report_json_summary(const aisle_replay_summary *s, FILE *json) {
    (void)fprintf(json, ",\n  \"log\": ");
    aisle_report_json_string(s->log_name, json);
    (void)fprintf(json, ",\n  \"events\": %" PRId64 ", \"inputs\": %" PRId64 ", \"malformed\": %" PRId64,
                  s->log->events, s->replay->inputs, s->replay->malformed);
    (void)fprintf(json, ", \"refused\": %" PRId64 ", \"cut_off\": %" PRId64 ", \"garbage_bytes\": %" PRId64,
                  s->replay->refused, s->log->cut_off, s->log->garbage_bytes);
    (void)fprintf(json, ",\n  \"replies\": %" PRId64 ", \"path_count\": %" PRId64 ", \"renewals\": %" PRId64,
                  s->sums->replies, s->sums->paths, s->sums->renewals);
    (void)fprintf(json, ", \"proved\": %" PRId64 ", \"none\": %" PRId64 ", \"work_units\": %" PRId64, s->sums->proved,
                  s->sums->none, s->sums->work_units);
    if (s->check != NULL) {
        (void)fprintf(json,
                      ",\n  \"check\": {\"equal\": %" PRId64 ", \"different\": %" PRId64 ", \"missing\": %" PRId64
                      ", \"not_recorded\": %" PRId64 "}",
                      s->check->equal, s->check->different, s->check->missing, s->check->extra);
    }
    (void)fprintf(json, ",\n  \"seconds\": %.6f", s->seconds);
}
