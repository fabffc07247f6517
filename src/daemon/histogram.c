#include "daemon/histogram.h"

#include "base/check.h"

// 0..7 us have a bucket each; above, the octave and the three bits after its leading one.
static uint32_t bucket_of(uint64_t us) {
    uint32_t octave = 0;
    while ((us >> octave) >= 16U) {
        octave++;
    }
    uint32_t index = us < 8U ? (uint32_t)us : 8U * (octave + 1U) + (uint32_t)(us >> octave) - 8U;
    return index < AISLE_HISTOGRAM_BUCKETS ? index : AISLE_HISTOGRAM_BUCKETS - 1U;
}

// Largest duration that falls into the bucket.
static int64_t edge_of(uint32_t index) {
    if (index < 8U) {
        return (int64_t)index;
    }
    uint32_t octave = index / 8U - 1U;
    return (((int64_t)(index % 8U) + 9) << octave) - 1;
}

void aisle_histogram_add(aisle_histogram *self, int64_t us) {
    uint64_t value = us > 0 ? (uint64_t)us : 0U;
    self->bucket[bucket_of(value)]++;
    self->count++;
    self->max_us = us > self->max_us ? us : self->max_us;
}

int64_t aisle_histogram_percentile(const aisle_histogram *self, double share) {
    AISLE_ASSERT(share >= 0.0 && share <= 1.0);
    double wanted = share * (double)self->count;
    int64_t seen = 0;
    for (uint32_t i = 0; i < AISLE_HISTOGRAM_BUCKETS; i++) {
        seen += self->bucket[i];
        if (self->bucket[i] != 0 && (double)seen >= wanted) {
            return edge_of(i) < self->max_us ? edge_of(i) : self->max_us;
        }
    }
    return self->max_us;
}
