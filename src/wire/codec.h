// codec.h - messages to bytes and back, bounded. Level 1.
//
// The bytes are LCM's: the type's fingerprint (8 bytes), then the members in order, big-endian, arrays without padding,
// nested structs without a fingerprint of their own. lcm-gen's decoders allocate from counts on the wire; these walk
// generated tables (wire/tables.h) instead and take hostile bytes: every length and count is checked before it is used.
//
// What a valid message is, in both directions: counts within [0, bound], every float and double finite, booleans 0 or
// 1, right fingerprint, no byte missing or left over, at most AISLE_MSG_DATAGRAM_MAX bytes. A message that decodes
// encodes to the very same bytes. Ranges of the other fields (ids, kinds, shapes) are for those who use them.
//
// Memory: none but the caller's; below 1 KiB of stack; no allocation, no recursion. Any alignment of bytes.
// Time: O(bytes), independent of what they say; decode reads them twice. Threads: no state, all functions re-entrant.
// Needs IEEE 754 floats with the byte order of integers; any byte order.
#ifndef AISLE_WIRE_CODEC_H
#define AISLE_WIRE_CODEC_H

#include "aisle/messages.h"
#include "aisle/status.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

// Largest message, fingerprint included: with channel name and LCM's header it still is one datagram (LCM sends up to
// 65499 bytes of channel name, its end and payload in one). layout_t (224464 bytes with 828 polygons of 16 vertices)
// and layout_patch_t (70432) can ask for more: fill their arrays until encoding says AISLE_ERR_CAPACITY.
#define AISLE_MSG_DATAGRAM_MAX 65000U
#define AISLE_MSG_FINGERPRINT_SIZE 8U

typedef enum aisle_msg_fault_kind {
    AISLE_MSG_FAULT_NONE,
    AISLE_MSG_FAULT_FINGERPRINT,    // another type, or another version of it; shorter than a fingerprint: TRUNCATED
    AISLE_MSG_FAULT_TRUNCATED,      // ends within `field`
    AISLE_MSG_FAULT_TRAILING,       // value: bytes left over
    AISLE_MSG_FAULT_NEGATIVE_COUNT, // field, value: the count
    AISLE_MSG_FAULT_OVER_BOUND,     // field, value: the count
    AISLE_MSG_FAULT_OVERSIZE,       // value: bytes, above AISLE_MSG_DATAGRAM_MAX; INT32_MAX: or more
    AISLE_MSG_FAULT_NOT_FINITE,     // field: NaN or infinite
    AISLE_MSG_FAULT_BAD_BOOLEAN     // field, value: neither 0 nor 1
} aisle_msg_fault_kind;

typedef struct aisle_msg_fault {
    aisle_msg_fault_kind kind;
    const char *field; // static text: its name in the innermost struct; "" where no field is to blame
    int64_t value;     // see the kinds; else 0
} aisle_msg_fault;

// AISLE_STATUS_LIMIT for OVER_BOUND and OVERSIZE, 0 for NONE, AISLE_STATUS_MALFORMED for the others.
int16_t aisle_msg_fault_cause(const aisle_msg_fault *fault);

// Reads `size` bytes into *msg, the C struct of `type` (aisle_path_msg for AISLE_MSG_PATH). AISLE_ERR_DATA: refused,
// *fault (may be NULL) says why, *msg is untouched. AISLE_ERR_ARG: no such type, or NULL. On AISLE_OK *fault is
// NONE; array entries behind their count, and padding, keep what they held. bytes must not overlap *msg.
aisle_status aisle_msg_decode(aisle_msg_type type, const void *bytes, size_t size, void *msg, aisle_msg_fault *fault);

// The same checks without writing anything.
aisle_status aisle_msg_check(aisle_msg_type type, const void *bytes, size_t size, aisle_msg_fault *fault);

// Writes *msg to out and its length to *size. AISLE_ERR_DATA: not a valid message (see above). AISLE_ERR_CAPACITY:
// longer than `capacity` or AISLE_MSG_DATAGRAM_MAX. AISLE_ERR_ARG: no such type, or NULL. On error *size is unchanged
// and out[0..capacity) undefined. out must not overlap *msg. Reads array entries up to their count only.
aisle_status aisle_msg_encode(aisle_msg_type type, const void *msg, void *out, size_t capacity, size_t *size);

// As nested in another message: without the fingerprint. For checksums over polygons or waypoints as encoded.
aisle_status aisle_msg_encode_body(aisle_msg_type type, const void *msg, void *out, size_t capacity, size_t *size);

// Where a member lies in the encoded message, fingerprint counted. False: no such member in the outermost struct, or a
// variable array before it. O(members).
bool aisle_msg_field_offset(aisle_msg_type type, const char *name, size_t *offset);

// Overwrite an encoded number, e.g. a utime found by aisle_msg_field_offset().
void aisle_msg_put_int64(void *at, int64_t value);
void aisle_msg_put_int32(void *at, int32_t value);
void aisle_msg_put_float(void *at, float value);

// Of a type; 0 or "?" for none. name: as in its .lcm file ("path_t"). max_size: a buffer of so many bytes never is
// too small for what encode or decode accepts. struct_size: sizeof of the C struct. fingerprint: as lcm-gen has it.
const char *aisle_msg_name(aisle_msg_type type);
size_t aisle_msg_max_size(aisle_msg_type type);
size_t aisle_msg_struct_size(aisle_msg_type type);
uint64_t aisle_msg_fingerprint(aisle_msg_type type);
#endif
