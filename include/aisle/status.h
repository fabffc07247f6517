// status.h - what every Aisle function answers. Level: public.
//
// Below 0: the caller did something wrong, nothing was changed. 0 and above: how it ended.
// "No path" is an answer (a path message with a cause), not an error.
#ifndef AISLE_STATUS_H
#define AISLE_STATUS_H

#ifdef __cplusplus
extern "C" {
#endif

typedef enum aisle_status {
    AISLE_OK = 0,            // done
    AISLE_BUSY = 1,          // not done yet: call again
    AISLE_PARTIAL = 2,       // ended early with a usable result, or accepted and more parts are wanted
    AISLE_ERR_ARG = -1,      // an argument breaks a rule stated in the header
    AISLE_ERR_CAPACITY = -2, // a pool, buffer or block is too small
    AISLE_ERR_DATA = -3      // a message was refused; its cause says why
} aisle_status;

// Supplied by the program that links the library (a firmware resets, a daemon says where and aborts); must not
// return. Called
// when an invariant of the library does not hold, never because of input.
void aisle_assert_failed(const char *file, int line, const char *condition);

#ifdef __cplusplus
}
#endif
#endif
