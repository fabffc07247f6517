// check.h - asserts that stay on in every build. Level 0.
//
// AISLE_ASSERT states an invariant of our own code, never a property of input: input is refused with a
// status. A failed assert calls aisle_assert_failed(), which does not return; the daemon ends with a
// line that says where and its watchdog restarts it, a firmware supplies its own.
#ifndef AISLE_BASE_CHECK_H
#define AISLE_BASE_CHECK_H

#include "aisle/status.h" // aisle_assert_failed()

#define AISLE_ASSERT(condition) ((condition) ? (void)0 : aisle_assert_failed(__FILE__, __LINE__, #condition))

#endif
