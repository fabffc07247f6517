// What each stage makes of a leg: the grid's seed, the taut seed, the swarm; one JSON object on standard output.
//
//     bench-stages < hall
//
// The hall as hall.h says. By objective the integral of its density (m, least is best), by exact gaps every 5 cm, of the
// grid search's polyline, of the same pulled taut, and of the swarm's best spline; null where a stage gives none.
#include "base/angle.h"
#include "hall.h"
#include "plan/seed.h"
#include "plan/swarm.h"
#include "plan/taut.h"

#include <math.h>
#include <stdio.h>

enum { BLOCK = 160 << 20, CELLS = 1 << 22, POINTS = AISLE_SEED_POINTS_MAX, STRIDE = 2 };
#define SPACING 0.05 // m, of the judge

static hall scene;
static aisle_space space;
static aisle_seed seed;
static aisle_taut taut;
static aisle_swarm swarm;
static aisle_objective objective;
static aisle_spline spline;
static aisle_vec2 points[POINTS];

static double density_at(aisle_vec2 p, aisle_vec2 along, double curvature) {
    aisle_pose2 pose = {p.x, p.y, aisle_atan2(along.y, along.x)};
    return aisle_objective_density(&objective, aisle_space_gap(&space, pose, AISLE_CLEARANCE_CAP, NULL), curvature);
}

static double cost_of_polyline(uint32_t count) {
    double sum = 0.0;
    for (uint32_t i = 0; i + 1U < count; i++) {
        aisle_vec2 along = aisle_vec2_sub(points[i + 1U], points[i]);
        double length = aisle_vec2_length(along);
        double n = floor(length / SPACING) + 1.0;
        for (double k = 0.5; k < n; k += 1.0) {
            sum += length / n * density_at(aisle_vec2_lerp(points[i], points[i + 1U], k / n), along, 0.0);
        }
    }
    return sum;
}

static double cost_of_spline(const aisle_vec2 *vias, uint32_t count) {
    if (aisle_spline_fit(&spline, AISLE_SPLINE_CUBIC, vias, count) != AISLE_OK) {
        return (double)INFINITY;
    }
    double end = spline.u[spline.n - 1U];
    double n = floor(end / SPACING) + 1.0;
    double sum = 0.0;
    for (double k = 0.5; k < n; k += 1.0) {
        aisle_spline_sample at = aisle_spline_at(&spline, end * k / n);
        sum += end / n * aisle_vec2_length(at.d1) * density_at(at.p, at.d1, aisle_spline_curvature(&at));
    }
    return sum;
}

// The grid's polyline, with a stride and else without. 0: none.
static uint32_t find_seed(void) {
    uint32_t spent = 0;
    for (uint32_t stride = STRIDE; stride > 0U; stride--) {
        aisle_space_begin(&space, &scene.layout, &scene.vehicle, AISLE_SPACE_FREE_TURN);
        if (aisle_seed_start(&seed, &space, &objective, stride, scene.start, scene.goal, points) != AISLE_OK) {
            continue;
        }
        aisle_status st = AISLE_BUSY;
        while (st == AISLE_BUSY) {
            st = aisle_seed_step(&seed, UINT32_MAX, &spent);
        }
        if (st == AISLE_OK) {
            return seed.point_count;
        }
    }
    return 0;
}

static double pull(uint32_t count) {
    uint32_t spent = 0;
    double arc = scene.vehicle.outer_radius + scene.vehicle.margin;
    aisle_taut_start(&taut, &space, &objective, arc, points, count, POINTS);
    while (aisle_taut_step(&taut, UINT32_MAX, &spent) == AISLE_BUSY) {
    }
    return cost_of_polyline(taut.count);
}

static double fly(void) {
    uint32_t spent = 0;
    aisle_vec2 vias[AISLE_SWARM_VIAS + 2U];
    const aisle_options_msg options = {.planner = AISLE_OPTIONS_PSO};
    if (aisle_swarm_start(&swarm, &space, &objective, &options, points, taut.count) != AISLE_OK) {
        return (double)INFINITY;
    }
    while (aisle_swarm_step(&swarm, UINT32_MAX, &spent) == AISLE_BUSY) {
    }
    uint32_t n = aisle_swarm_best(&swarm, vias);
    return n > 0U ? cost_of_spline(vias, n) : (double)INFINITY;
}

static void print(const char *name, double value) {
    if (isfinite(value)) {
        (void)printf("\"%s\": %.6g", name, value);
    } else {
        (void)printf("\"%s\": null", name);
    }
}

int main(void) {
    static const char *const names[] = {"safest", "shortest", "fastest", "least_energy"};
    const aisle_limits limits = {.cells = CELLS, .open_nodes = AISLE_LIMITS_OPEN_NODES_DEFAULT};
    aisle_arena arena = hall_arena(BLOCK);
    aisle_space_carve(&space, &arena, CELLS);
    aisle_seed_carve(&seed, &arena, &limits);
    aisle_swarm_carve(&swarm, &arena);
    hall_read(&scene, &arena, CELLS);
    (void)printf("{");
    for (int8_t kind = 0; kind < 4; kind++) {
        const aisle_options_msg options = {.objective = kind};
        (void)aisle_objective_of(&options, &scene.vehicle, &objective);
        uint32_t count = find_seed();
        (void)printf("%s\"%s\": {", kind > 0 ? ", " : "", names[kind]);
        print("seed", count > 0U ? cost_of_polyline(count) : (double)INFINITY);
        (void)printf(", ");
        print("taut", count > 0U ? pull(count) : (double)INFINITY);
        (void)printf(", ");
        print("swarm", count > 0U ? fly() : (double)INFINITY);
        (void)printf("}");
    }
    (void)printf("}\n");
    return 0;
}
