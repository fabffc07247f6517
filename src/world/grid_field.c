#include "world/grid_field.h"

#include "base/check.h"

#include <string.h>

#define REACH AISLE_FIELD_REACH
#define CHUNK 256 // columns taken between two emissions

void aisle_field_lower(uint16_t *restrict row, const uint16_t *restrict neighbours, uint32_t w) {
    for (uint32_t x = 0; x < w; x++) { // no branch, so that it becomes vector code
        const uint16_t by = (uint16_t)(neighbours[x] + 1U);
        row[x] = by < row[x] ? by : row[x];
    }
}

void aisle_field_lower_to_one(uint16_t *row, uint32_t w) {
    for (uint32_t x = 0; x < w; x++) {
        row[x] = row[x] < 1U ? row[x] : 1U;
    }
}

// A row's parabolas that still matter: p[0..n), by rising `from` and `at`.
typedef struct envelope {
    aisle_parabola *p;
    uint32_t n;
} envelope;

// First column where the parabola at `at` lies below q (never before at - REACH, where it is saturated anyway).
// With d = at - q->at: floor((d^2 + sq - q->sq) / 2d) + 1 from q->at, written from at - REACH so that nothing is
// negative. For d > 2 REACH no column is in reach of both.
static int32_t overtakes(const aisle_parabola *q, int32_t at, int32_t sq) {
    const int32_t d = at - q->at;
    if (d > 2 * REACH) {
        return at - REACH;
    }
    const int32_t above = d * (2 * REACH - d) + sq - q->sq;
    return above < 0 ? at - REACH : at - REACH + (int32_t)((uint32_t)above / (uint32_t)(2 * d)) + 1;
}

static void envelope_add(envelope *e, int32_t at, int32_t sq) {
    int32_t from = at - REACH;
    while (e->n > 0) {
        from = overtakes(&e->p[e->n - 1U], at, sq);
        if (from > e->p[e->n - 1U].from) {
            break;
        }
        e->n--;
        from = at - REACH;
    }
    if (from <= at + REACH) {
        AISLE_ASSERT(e->n < AISLE_GRID_WINDOW);
        e->p[e->n] = (aisle_parabola){from, at, sq};
        e->n++;
    }
}

static uint16_t parabola_at(const aisle_parabola *p, int32_t x) {
    const int32_t d = x > p->at ? x - p->at : p->at - x;
    const int32_t sq = d > REACH ? (int32_t)AISLE_FIELD_SQ_MAX : d * d + p->sq;
    return (uint16_t)(sq < (int32_t)AISLE_FIELD_SQ_MAX ? sq : (int32_t)AISLE_FIELD_SQ_MAX);
}

// Writes columns [x, end) and drops the parabolas that end before `end`.
static void envelope_emit(envelope *e, uint16_t *row, int32_t x, int32_t end) {
    AISLE_ASSERT(e->n > 0);
    uint32_t at = 0;
    for (; x < end; at++) {
        const int32_t next = at + 1U < e->n ? e->p[at + 1U].from : INT32_MAX;
        const int32_t stop = next < end ? next : end;
        for (; x < stop; x++) {
            row[x] = parabola_at(&e->p[at], x);
        }
        if (next > end) {
            break;
        }
    }
    e->n -= at;
    memmove(e->p, &e->p[at], e->n * sizeof *e->p);
}

static void add_beside(envelope *e, aisle_field_beside beside, int32_t x) {
    for (uint32_t i = 0; i < beside.n; i++, x++) {
        if (beside.at[i] < AISLE_FIELD_COLUMN_MAX) {
            envelope_add(e, x, beside.at[i] * beside.at[i]);
        }
    }
}

// In place: a column is written when every column up to REACH further on has been read. Window: parabolas lie in
// rising `at` with `from` within REACH of it, so between emissions at most 1 + 2 REACH + 1 + CHUNK of them matter. The
// first parabola is out of every column's reach and makes them saturate where there is no other.
void aisle_field_transform(aisle_parabola *scratch, uint16_t *row, int32_t w, aisle_field_beside left,
                           aisle_field_beside right) {
    envelope e = {scratch, 0};
    int32_t written = 0;
    AISLE_ASSERT(left.n <= REACH + 1 && right.n <= REACH + 1);
    envelope_add(&e, -REACH - 2, 0);
    add_beside(&e, left, -(int32_t)left.n);
    for (int32_t x = 0; x < w;) {
        const int32_t stop = w - x < CHUNK ? w : x + CHUNK;
        for (; x < stop; x++) {
            if (row[x] < AISLE_FIELD_COLUMN_MAX) {
                envelope_add(&e, x, row[x] * row[x]);
            }
        }
        if (x - REACH > written) {
            envelope_emit(&e, row, written, x - REACH);
            written = x - REACH;
        }
    }
    add_beside(&e, right, w);
    envelope_emit(&e, row, written, w);
}
