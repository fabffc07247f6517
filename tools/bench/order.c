// What ordering costs: goals drawn in a hall, the order found, and the true lengths between all of them; one JSON object
// on standard output.
//
//     bench-order GOALS SEED < hall
//
// The hall as hall.h says; its start and goal are not used. Goals and start are drawn where the disc inside the vehicle
// has its margin and from where the start can be reached. ms: of the order alone, best of three runs.
#include "base/rng.h"
#include "hall.h"
#include "plan/tour.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { BLOCK = 160 << 20, CELLS = 1 << 22, ROUNDS = 3 };

static hall scene;
static aisle_tour tour;
static aisle_tangent tangent;
static aisle_vec2 place[AISLE_ORDER_MAX + 1U];
static double radius;

static double seconds(void) {
    struct timespec t;
    (void)clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static double length_between(aisle_vec2 from, aisle_vec2 to) {
    uint32_t spent = 0;
    aisle_tangent_start(&tangent, &scene.layout, radius, from, to);
    aisle_status st;
    do {
        st = aisle_tangent_step(&tangent, UINT32_MAX / 16U, &spent);
    } while (st == AISLE_BUSY);
    return st == AISLE_OK ? tangent.bound : -1.0;
}

static aisle_vec2 draw(aisle_rng *rng) {
    aisle_aabb bounds = aisle_layout_bounds(&scene.layout);
    double x = bounds.lo.x + (bounds.hi.x - bounds.lo.x) * (double)aisle_rng_float(rng);
    double y = bounds.lo.y + (bounds.hi.y - bounds.lo.y) * (double)aisle_rng_float(rng);
    return aisle_vec2_of(x, y);
}

static bool is_free(aisle_vec2 p) {
    aisle_convex disc = {&p, 1U, scene.vehicle.outer_radius};
    int32_t id;
    return aisle_layout_gap(&scene.layout, &disc, 10.0, &id) > scene.vehicle.margin + 1e-3;
}

static void draw_places(uint32_t n, uint64_t seed) {
    aisle_rng rng = aisle_rng_seed(seed);
    do {
        place[n] = draw(&rng);
    } while (!is_free(place[n]));
    for (uint32_t i = 0; i < n; i++) {
        do {
            place[i] = draw(&rng);
        } while (!is_free(place[i]) || length_between(place[n], place[i]) < 0.0);
    }
}

static uint32_t run(uint32_t n) {
    uint32_t units = 0;
    aisle_tour_start(&tour, &tangent, &scene.layout, radius, place[n], place, n);
    aisle_status st;
    do {
        st = aisle_tour_step(&tour, 1000U, &units);
    } while (st == AISLE_BUSY);
    if (st != AISLE_OK) {
        hall_fail("no order");
    }
    return units;
}

int main(int argc, char **argv) {
    if (argc != 3) {
        hall_fail("bench-order GOALS SEED < hall");
    }
    uint32_t n = (uint32_t)strtoul(argv[1], NULL, 10);
    aisle_arena arena = hall_arena(BLOCK);
    const aisle_limits limits = {.cells = CELLS};
    hall_read(&scene, &arena, CELLS);
    aisle_arena shared = arena;
    aisle_tangent_carve(&tangent, &arena, &limits);
    aisle_tour_carve_shared(&tour, &shared);
    aisle_tour_carve(&tour, &arena);
    if (arena.overflow || n < 1U || n > AISLE_ORDER_MAX) {
        hall_fail("no memory, or no such number of goals");
    }
    radius = scene.vehicle.inner_radius + scene.vehicle.margin;
    draw_places(n, strtoull(argv[2], NULL, 10));
    uint32_t units = 0;
    double best = 1e9;
    for (int i = 0; i < ROUNDS; i++) {
        double from = seconds();
        units = run(n);
        double took = seconds() - from;
        best = took < best ? took : best;
    }
    (void)printf("{\"ms\": %.3f, \"units\": %u, \"searches\": %u, \"rounds\": %u, \"length\": %.9f, \"order\": [",
                 1e3 * best, units, tour.searches, tour.rounds, tour.search.value);
    for (uint32_t i = 0; i < n; i++) {
        (void)printf("%s%u", i > 0U ? ", " : "", tour.order[i]);
    }
    (void)printf("], \"cost\": [");
    for (uint32_t i = 0; i <= n; i++) {
        for (uint32_t j = 0; j < n; j++) {
            (void)printf("%s%.9f", i + j > 0U ? ", " : "", i == j ? 0.0 : length_between(place[i], place[j]));
        }
    }
    (void)printf("], \"beeline\": [");
    for (uint32_t i = 0; i <= n; i++) {
        for (uint32_t j = 0; j < n; j++) {
            (void)printf("%s%.9f", i + j > 0U ? ", " : "", aisle_vec2_distance(place[i], place[j]));
        }
    }
    (void)printf("], \"places\": [");
    for (uint32_t i = 0; i <= n; i++) { // the start last
        (void)printf("%s[%.9f, %.9f]", i > 0U ? ", " : "", place[i].x, place[i].y);
    }
    (void)printf("]}\n");
    return 0;
}
