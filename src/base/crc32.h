// crc32.h - CRC-32 as in zlib and Ethernet (polynomial 0xEDB88320, reflected). Level 0.
//
// Memory: 8 KiB of constant tables. Time: O(size), eight bytes a round; bytes of any alignment.
#ifndef AISLE_BASE_CRC32_H
#define AISLE_BASE_CRC32_H

#include <stddef.h>
#include <stdint.h>

// CRC of the bytes so far followed by these; start with crc = 0. crc32(0, "123456789", 9) = 0xCBF43926.
// size 0 changes nothing (bytes may then be NULL).
uint32_t aisle_crc32(uint32_t crc, const void *bytes, size_t size);
#endif
