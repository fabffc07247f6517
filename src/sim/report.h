// report.h - what came of a drive, as text and as JSON. Level 5.
#ifndef AISLE_SIM_REPORT_H
#define AISLE_SIM_REPORT_H

#include "sim/episode.h"

#include <stdio.h>

// A few lines: the verdict, contacts, gaps, times, paths, work.
void aisle_sim_report_text(const aisle_sim_episode *episode, FILE *out);

// One JSON object with the same figures; lengths in m, times in s, work in ms. What is not known is null.
void aisle_sim_report_json(const aisle_sim_episode *episode, FILE *out);
#endif
