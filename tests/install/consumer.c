// The smallest C program on the installed library: how much memory does a small planner want?
#include <aisle/planner.h>
#include <aisle/version.h>

#include <stdio.h>
#include <stdlib.h>

void aisle_assert_failed(const char *file, int line, const char *condition) {
    (void)fprintf(stderr, "%s:%d: %s\n", file, line, condition);
    abort();
}

int main(void) {
    const aisle_limits limits = {.cells = 4096, .polygons = 16, .vertices = 64};
    const size_t size = aisle_planner_memsize(&limits);
    (void)printf("aisle %s: %zu bytes, cause %s\n", AISLE_VERSION, size, aisle_cause_name(AISLE_STATUS_NO_PATH));
    return size > 0 ? 0 : 1;
}
