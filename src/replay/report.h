// report.h - what aisle-replay prints: one line per path, a summary, and the same as JSON. Level 5.
#ifndef AISLE_REPLAY_REPORT_H
#define AISLE_REPLAY_REPORT_H

#include "replay/check.h"
#include "replay/replay.h"

#include <stdio.h>

// Sums over the outputs of a replay.
typedef struct aisle_replay_sums {
    int64_t replies, paths, renewals; // outputs by channel; a renewal is not counted as a path
    int64_t proved, none;             // of replies and paths: with waypoints, and without
    int64_t work_units, waypoints;
    double length;             // m, of all proved ones
    int64_t arms, arms_proved; // the arm's; not among the others
} aisle_replay_sums;

// "OK", "PARTIAL", "STOP", "NONE" or "?".
const char *aisle_report_path_status(int8_t status);

// Decodes the output (of the arm, too) and prints its line to text and, one JSON object with a comma in front unless first, to json (each
// may be NULL); adds to *sums. A renewal is counted only.
void aisle_report_path(const aisle_replay_output *output, aisle_replay_sums *sums, FILE *text, FILE *json);

typedef struct aisle_replay_summary {
    const char *log_name;
    const aisle_log_reader *log;
    const aisle_replay *replay;
    const aisle_replay_sums *sums;
    const aisle_check *check; // NULL: not compared
    double seconds;           // of the host, for the whole replay
} aisle_replay_summary;

void aisle_report_summary(const aisle_replay_summary *summary, FILE *text);

// The members that close the JSON object opened by aisle_report_json_open().
void aisle_report_json_summary(const aisle_replay_summary *summary, FILE *json);

// A JSON string in quotes.
void aisle_report_json_string(const char *text, FILE *json);
#endif
