#include "base/digest.h"

#include <string.h>

#define FACTOR 0xBF58476D1CE4E5B9U
#define OFFSET 0xCBF29CE484222325U // FNV's

static uint64_t step(uint64_t digest, uint64_t word) {
    digest = (digest ^ word) * FACTOR;
    return digest ^ (digest >> 32);
}

uint64_t aisle_digest(uint64_t digest, const void *bytes, size_t size) {
    const uint8_t *at = bytes;
    digest = step(digest ^ OFFSET, (uint64_t)size);
    for (; size >= 8; size -= 8, at += 8) {
        uint64_t word;
        memcpy(&word, at, sizeof word);
        digest = step(digest, word);
    }
    if (size > 0) {
        uint64_t word = 0;
        memcpy(&word, at, size);
        digest = step(digest, word);
    }
    return digest;
}
