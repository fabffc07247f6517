// histogram.h - durations in fixed memory, for percentiles. Level 5.
//
// Buckets are eight to an octave from 1 us to 2^40 us: a percentile is told as its bucket's upper edge, at most 12.5 %
// too high and never too low. Memory: 1.3 kB. Time: add O(1), percentile O(buckets).
#ifndef AISLE_DAEMON_HISTOGRAM_H
#define AISLE_DAEMON_HISTOGRAM_H

#include <stdint.h>

#define AISLE_HISTOGRAM_BUCKETS (8U * 39U)

typedef struct aisle_histogram {
    uint32_t bucket[AISLE_HISTOGRAM_BUCKETS];
    int64_t count, max_us;
} aisle_histogram;

// Negative counts as 0. Start with a zeroed struct.
void aisle_histogram_add(aisle_histogram *self, int64_t us);

// The least edge that at least `share` (0..1) of the durations do not exceed, at most the longest one; 0 if there are
// none. us.
int64_t aisle_histogram_percentile(const aisle_histogram *self, double share);
#endif
