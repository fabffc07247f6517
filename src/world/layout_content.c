#include "world/layout_content.h"

#include <string.h>

#define SALT_POLYGON UINT64_C(0x9E3779B97F4A7C15) // any numbers, so that things of different sorts differ
#define SALT_RUN UINT64_C(0xC2B2AE3D27D4EB4F)
#define SALT_AREA UINT64_C(0x165667B19E3779F9)

static uint64_t take(uint64_t hash, uint64_t word) {
    uint64_t z = (hash ^ word) + SALT_POLYGON;
    z = (z ^ (z >> 30)) * UINT64_C(0xBF58476D1CE4E5B9);
    z = (z ^ (z >> 27)) * UINT64_C(0x94D049BB133111EB);
    return z ^ (z >> 31);
}

static uint64_t take_double(uint64_t hash, double value) {
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    return take(hash, bits);
}

static uint64_t pair(uint32_t high, uint32_t low) {
    return (uint64_t)high << 32U | low;
}

static uint32_t bits_of(float value) {
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

uint64_t aisle_content_of_polygon(int32_t id, int8_t kind, float value, float direction, const aisle_vec2 *v,
                                  uint32_t n) {
    uint64_t hash = take(SALT_POLYGON, pair((uint32_t)id, (uint32_t)kind));
    hash = take(hash, pair(bits_of(value), bits_of(direction)));
    for (uint32_t i = 0; i < n; i++) {
        hash = take_double(take_double(hash, v[i].x), v[i].y);
    }
    return hash;
}

uint64_t aisle_content_of_run(uint32_t iy, uint32_t x0, uint32_t end) {
    return take(take(SALT_RUN, iy), pair(x0, end));
}

uint64_t aisle_content_of_area(aisle_aabb bounds, const aisle_lattice *lattice, bool has_scan) {
    uint64_t hash = take_double(take_double(SALT_AREA, bounds.lo.x), bounds.lo.y);
    hash = take_double(take_double(hash, bounds.hi.x), bounds.hi.y);
    hash = take_double(take_double(hash, lattice->x0), lattice->y0);
    hash = take(take_double(hash, lattice->res), pair(lattice->w, lattice->h));
    return take(hash, has_scan ? 1U : 0U);
}
