// The same from C++: the headers compile and the names link.
#include <aisle/planner.h>
#include <aisle/version.h>

#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <vector>

extern "C" void aisle_assert_failed(const char *, int, const char *) {
    std::abort();
}

int main() {
    aisle_config config = {};
    std::vector<std::max_align_t> block(aisle_planner_memsize(&config.limits) / sizeof(std::max_align_t) + 64);
    aisle_planner *planner = nullptr;
    const aisle_status status = aisle_planner_init(block.data(), block.size() * sizeof block[0], &config, &planner);
    std::printf("aisle %s: init %d\n", AISLE_VERSION, static_cast<int>(status));
    return status == AISLE_OK ? 0 : 1;
}
