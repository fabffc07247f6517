// The same from C++: the headers compile, the names link, a planner starts in memory of the program's own.
#include <aisle/planner.h>
#include <aisle/version.h>

#include <cstdio>
#include <cstdlib>
#include <memory>

extern "C" void aisle_assert_failed(const char *, int, const char *) {
    std::abort();
}

int main() {
    aisle_config config = {};
    const std::size_t size = aisle_planner_memsize(&config.limits);
    const std::size_t whole = (size + AISLE_PLANNER_ALIGN - 1) / AISLE_PLANNER_ALIGN * AISLE_PLANNER_ALIGN;
    std::unique_ptr<void, decltype(&std::free)> block(std::aligned_alloc(AISLE_PLANNER_ALIGN, whole), &std::free);
    aisle_planner *planner = nullptr;
    const aisle_status status = aisle_planner_init(block.get(), size, &config, &planner);
    std::printf("aisle %s: %zu bytes, init %d\n", AISLE_VERSION, size, static_cast<int>(status));
    return status == AISLE_OK ? 0 : 1;
}
