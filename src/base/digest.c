#include "base/digest.h"

#include <string.h>

#define FACTOR 0xBF58476D1CE4E5B9U
#define LANES 4
#define LANES_BYTES (8U * LANES)
#define OFFSET 0xCBF29CE484222325U // FNV's

static uint64_t step(uint64_t digest, uint64_t word) {
    digest = (digest ^ word) * FACTOR;
    return digest ^ (digest >> 32);
}

static uint64_t word_at(const uint8_t *at) {
    uint64_t word;
    memcpy(&word, at, sizeof word);
    return word;
}

// Of size / LANES_BYTES * LANES_BYTES bytes: each lane's steps wait for its own last one alone.
static uint64_t digest_lanes(uint64_t digest, const uint8_t *at, size_t size) {
    uint64_t lane[LANES] = {digest, step(digest, 1), step(digest, 2), step(digest, 3)};
    for (; size >= LANES_BYTES; size -= LANES_BYTES, at += LANES_BYTES) {
        for (size_t i = 0; i < LANES; i++) {
            lane[i] = step(lane[i], word_at(at + 8 * i));
        }
    }
    for (size_t i = 1; i < LANES;
         i++) { // one step between: the top bits of two lanes' last words would undo each other
        lane[0] = step(step(lane[0], i), lane[i]);
    }
    return lane[0];
}

uint64_t aisle_digest(uint64_t digest, const void *bytes, size_t size) {
    const uint8_t *at = bytes;
    digest = step(digest ^ OFFSET, (uint64_t)size);
    if (size >= 2 * LANES_BYTES) {
        digest = digest_lanes(digest, at, size);
        at += size - size % LANES_BYTES;
        size %= LANES_BYTES;
    }
    for (; size >= 8; size -= 8, at += 8) {
        digest = step(digest, word_at(at));
    }
    if (size > 0) {
        uint64_t word = 0;
        memcpy(&word, at, size);
        digest = step(digest, word);
    }
    return digest;
}
