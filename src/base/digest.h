// digest.h - 64 bits that tell whether bytes in memory are still the same. Level 0.
//
// FNV-1a (Fowler, Noll, Vo; http://www.isthe.com/chongo/tech/comp/fnv/) taken eight bytes at a time, with the multiplier
// of SplitMix64's finaliser (Steele, Lea, Flood 2014, doi:10.1145/2714064.2660195) and a shift that brings the high bits
// down, so that every step is a bijection of the state and of the word: a change within one aligned word is always seen,
// any other but for a chance of 2^-64. From 64 bytes on four of them go on side by side, words in
// turn, and are put together in the end. Many times as fast as crc32.h. Not for forgers and not for the wire: it depends
// on the machine's byte order.
// Memory: none. Time: O(size).
#ifndef AISLE_BASE_DIGEST_H
#define AISLE_BASE_DIGEST_H

#include <stddef.h>
#include <stdint.h>

// Goes on with a digest; start with 0. Other cuts of the same bytes give other digests.
uint64_t aisle_digest(uint64_t digest, const void *bytes, size_t size);
#endif
