// libFuzzer over every decoder: the first byte picks the type, the others are the message. What is accepted must encode
// to the very same bytes and fit the size promised; what is refused must say why. Asserts of the codec end the run as
// well.
#include "wire/codec.h"

#include <stdlib.h>
#include <string.h>

static union {
    aisle_layout_msg layout; // the largest
    uint64_t words[1];
} msg;
static uint8_t again[AISLE_MSG_DATAGRAM_MAX + 1];

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void must(int holds) {
    if (!holds) {
        abort();
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    if (size == 0) {
        return 0;
    }
    aisle_msg_type type = (aisle_msg_type)(data[0] % AISLE_MSG_COUNT);
    aisle_msg_fault fault;
    size_t written = 0;
    must(aisle_msg_struct_size(type) <= sizeof msg);
    if (aisle_msg_decode(type, data + 1, size - 1, &msg, &fault) != AISLE_OK) {
        must(fault.kind != AISLE_MSG_FAULT_NONE && fault.field != NULL && aisle_msg_fault_cause(&fault) != 0);
        return 0;
    }
    must(fault.kind == AISLE_MSG_FAULT_NONE && size - 1 <= aisle_msg_max_size(type));
    must(aisle_msg_encode(type, &msg, again, size - 1, &written) == AISLE_OK);
    must(written == size - 1 && memcmp(data + 1, again, written) == 0);
    return 0;
}
