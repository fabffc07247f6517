// A failed invariant ends the test program.
#include "base/check.h"

#include <stdio.h>
#include <stdlib.h>

void aisle_assert_failed(const char *file, int line, const char *condition) {
    (void)fprintf(stderr, "%s:%d: invariant does not hold: %s\n", file, line, condition);
    abort();
}
