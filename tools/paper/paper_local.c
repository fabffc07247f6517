// Episodes of the second paper's local swarm: a hall on standard input, one JSON object per seed on standard output.
//
//     paper-local FIRST_SEED SEEDS PARTICLES LATTICE BEELINE ORDER < hall
//
// The hall as hall.h says (its goal is not used), then, numbers all: targets { x y ... } blocks { x0 y0 x1 y1 ... }.
// Blocks are moving obstacles: after each iteration each one jumps within (-1, 1) in x and in y. LATTICE: m, of the
// places (0: any); BEELINE 1: the paper's F; ORDER 1: the targets in the order that is shortest as the field is at first.
// An iteration: plan, drive the first line as far as the sensing range (on a lattice to a place of it), then all blocks
// jump. What is driven keeps off every place a block can reach by that jump, whenever it comes (passive safety), so
// each block is told as nine discs that cover it grown by 1 m each way, and the line is looked at again against the
// grown block itself. Where there is no such line the vehicle waits. Without blocks the whole way is driven.
#define _POSIX_C_SOURCE 200809L
#include "hall.h"
#include "plan/local.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { BLOCK = 96 << 20, CELLS = 1 << 20, TARGETS = 8, BLOCKS = 64, ITERATIONS = 5000, SIDE = 3 };

#define JUMP 1.0 // m
#define CONTACT 1e-6
#define PATIENT 1.15
#define PATIENCE 30U

typedef struct episode {
    aisle_vec2 at, target[TARGETS];
    aisle_aabb block[BLOCKS];
    uint32_t reached, iterations, waits, patience;
    double length, seconds;
    bool stuck;
} episode;

static hall scene;
static aisle_space space;
static aisle_local local;
static aisle_mover mover[BLOCKS * SIDE * SIDE];
static aisle_movers movers = {.mover = mover};
static aisle_vec2 targets[TARGETS];
static aisle_aabb blocks[BLOCKS];
static uint32_t target_count, block_count;
static aisle_local_request request;

static double number(void) {
    double value = 0.0;
    if (scanf("%lf", &value) != 1) {
        hall_fail("targets or blocks end too early");
    }
    return value;
}

static void read_more(void) {
    target_count = (uint32_t)number();
    if (target_count < 1U || target_count > TARGETS) {
        hall_fail("too many targets or none");
    }
    for (uint32_t i = 0; i < target_count; i++) {
        targets[i].x = number();
        targets[i].y = number();
    }
    block_count = (uint32_t)number();
    if (block_count > BLOCKS) {
        hall_fail("too many blocks");
    }
    for (uint32_t i = 0; i < block_count; i++) {
        blocks[i].lo.x = number();
        blocks[i].lo.y = number();
        blocks[i].hi.x = number();
        blocks[i].hi.y = number();
    }
}

// ---- blocks

static void tell_block(aisle_aabb grown, int32_t id) {
    const double w = (grown.hi.x - grown.lo.x) / SIDE, h = (grown.hi.y - grown.lo.y) / SIDE;
    for (uint32_t k = 0; k < SIDE * SIDE; k++) {
        mover[movers.count++] = (aisle_mover){
            .id = id,
            .at = {grown.lo.x + w * ((double)(k % SIDE) + 0.5), grown.lo.y + h * ((double)(k / SIDE) + 0.5)},
            .radius = 0.5 * sqrt(w * w + h * h)};
    }
}

static void tell_blocks(const episode *e) {
    movers.count = 0;
    for (uint32_t i = 0; i < block_count; i++) {
        tell_block(aisle_aabb_grow(e->block[i], JUMP), (int32_t)i + 1);
    }
}

// Within the hall's bounds: a jump beyond them is cut short.
static double jump(aisle_rng *rng, double lo, double hi, double least, double most) {
    const double by = JUMP * (2.0 * (double)aisle_rng_float(rng) - 1.0);
    return aisle_clamp(by, aisle_min(least - lo, 0.0), aisle_max(most - hi, 0.0));
}

static void jump_all(episode *e, aisle_rng *rng) {
    const aisle_aabb bounds = aisle_layout_bounds(&scene.layout);
    for (uint32_t i = 0; i < block_count; i++) {
        aisle_aabb *b = &e->block[i];
        const double x = jump(rng, b->lo.x, b->hi.x, bounds.lo.x, bounds.hi.x);
        const double y = jump(rng, b->lo.y, b->hi.y, bounds.lo.y, bounds.hi.y);
        *b = (aisle_aabb){{b->lo.x + x, b->lo.y + y}, {b->hi.x + x, b->hi.y + y}};
    }
}

static bool meets_a_block(const episode *e, aisle_vec2 a, aisle_vec2 b) {
    const aisle_vec2 ends[2] = {a, b};
    const aisle_convex line = {ends, 2U, scene.vehicle.outer_radius};
    for (uint32_t i = 0; i < block_count; i++) {
        const aisle_aabb g = aisle_aabb_grow(e->block[i], JUMP);
        const aisle_vec2 corner[4] = {g.lo, {g.hi.x, g.lo.y}, g.hi, {g.lo.x, g.hi.y}};
        if (aisle_convex_gap(&line, &(aisle_convex){corner, 4U, 0.0}) < CONTACT) {
            return true;
        }
    }
    return false;
}

// ---- planning

static double seconds_now(void) {
    struct timespec t;
    (void)clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static bool plan(episode *e, aisle_vec2 from, aisle_vec2 goal) {
    const double before = seconds_now();
    uint32_t spent = 0;
    request.from = from;
    request.goal = goal;
    request.longest = e->patience > 0U && block_count > 0U ? PATIENT * aisle_vec2_distance(from, goal) : 0.0;
    request.seed++;
    if (aisle_local_start(&local, &request) != AISLE_OK) {
        hall_fail("a request is refused");
    }
    aisle_status st;
    while ((st = aisle_local_step(&local, 1U << 20, &spent)) == AISLE_BUSY) {
    }
    e->seconds += seconds_now() - before;
    return st == AISLE_OK;
}

static double length_in_order(episode *e, const uint32_t *order) {
    double sum = 0.0;
    aisle_vec2 at = scene.start;
    for (uint32_t i = 0; i < target_count; i++) {
        const aisle_vec2 to = targets[order[i]];
        sum += plan(e, at, to) ? local.length : 1.5 * aisle_vec2_distance(at, to);
        at = to;
    }
    return sum;
}

// Two at most: the paper's.
static void order_targets(episode *e, bool best) {
    static const uint32_t given[2] = {0, 1}, turned[2] = {1, 0};
    memcpy(e->target, targets, sizeof targets);
    tell_blocks(e);
    if (best && target_count == 2U && length_in_order(e, turned) < length_in_order(e, given)) {
        e->target[0] = targets[1];
        e->target[1] = targets[0];
    }
}

// ---- driving

static uint32_t steps_of(aisle_vec2 way, double lattice) { // whole places on a line between two of them
    uint32_t a = (uint32_t)(fabs(way.x) / lattice + 0.5), b = (uint32_t)(fabs(way.y) / lattice + 0.5);
    while (b > 0U) {
        const uint32_t rest = a % b;
        a = b;
        b = rest;
    }
    return a;
}

// As far along the line as the range, on a lattice to one of its places: the first of them where none is in range.
static aisle_vec2 cut_line(aisle_vec2 a, aisle_vec2 b) {
    const double length = aisle_vec2_distance(a, b);
    if (length <= request.range) {
        return b;
    }
    if (request.lattice <= 0.0) {
        return aisle_vec2_lerp(a, b, request.range / length);
    }
    const double steps = (double)steps_of(aisle_vec2_sub(b, a), request.lattice);
    const double taken = aisle_max(floor(steps * request.range / length), 1.0);
    return aisle_vec2_lerp(a, b, taken / steps);
}

static void drive(episode *e, aisle_vec2 to) {
    (void)printf("%s[%u, %.9g, %.9g, %.9g, %.9g]", e->length > 0.0 ? ", " : "", (unsigned)e->iterations, e->at.x,
                 e->at.y, to.x, to.y);
    e->length += aisle_vec2_distance(e->at, to);
    e->at = to;
}

static bool is_worth_it(const episode *e, aisle_vec2 goal) {
    return e->patience == 0U || local.length <= PATIENT * aisle_vec2_distance(e->at, goal);
}

static void iterate(episode *e) {
    const aisle_vec2 goal = e->target[e->reached];
    tell_blocks(e);
    const bool found = plan(e, e->at, goal);
    if (block_count == 0U) {
        e->stuck = !found;
        for (uint32_t i = 1; i < local.count; i++) {
            drive(e, local.points[i]);
        }
    } else {
        const aisle_vec2 to = found ? cut_line(e->at, local.points[1]) : e->at;
        if (found && !meets_a_block(e, e->at, to) && is_worth_it(e, goal)) {
            drive(e, to);
        } else {
            e->waits++;
            e->patience -= e->patience > 0U ? 1U : 0U;
        }
    }
    if (aisle_vec2_distance(e->at, goal) < 1e-6) {
        e->reached++;
        e->patience = PATIENCE;
    }
}

static void print_blocks(const episode *e) {
    (void)printf("%s[", e->iterations > 0U ? ", " : "");
    for (uint32_t i = 0; i < block_count; i++) {
        (void)printf("%s%.9g, %.9g", i > 0U ? ", " : "", e->block[i].lo.x, e->block[i].lo.y);
    }
    (void)printf("]");
}

typedef struct trail { // where the blocks were at each iteration, printed behind the lines
    aisle_aabb block[BLOCKS];
} trail;

static trail trails[ITERATIONS + 1];

static void run(uint64_t seed, bool best) {
    static episode e;
    aisle_rng rng = aisle_rng_seed(seed);
    e = (episode){.at = scene.start, .patience = PATIENCE};
    memcpy(e.block, blocks, sizeof blocks);
    request.seed = seed << 20;
    (void)printf("{\"seed\": %u, \"lines\": [", (unsigned)seed);
    order_targets(&e, best);
    for (; e.reached < target_count && e.iterations < ITERATIONS && !e.stuck; e.iterations++) {
        memcpy(trails[e.iterations].block, e.block, sizeof blocks);
        iterate(&e);
        jump_all(&e, &rng);
    }
    memcpy(trails[e.iterations].block, e.block, sizeof blocks);
    (void)printf("], \"reached\": %u, \"length\": %.9g, \"iterations\": %u, \"waits\": %u, \"ms\": %.4f, \"blocks\": [",
                 (unsigned)e.reached, e.length, (unsigned)e.iterations, (unsigned)e.waits, 1e3 * e.seconds);
    const uint32_t iterations = e.iterations;
    for (e.iterations = 0; block_count > 0U && e.iterations <= iterations; e.iterations++) {
        memcpy(e.block, trails[e.iterations].block, sizeof blocks);
        print_blocks(&e);
    }
    (void)printf("]}\n");
}

int main(int argc, char **argv) {
    if (argc != 7) {
        hall_fail("usage: paper-local FIRST_SEED SEEDS PARTICLES LATTICE BEELINE ORDER < hall");
    }
    aisle_arena arena = hall_arena(BLOCK);
    aisle_space_carve(&space, &arena, CELLS);
    aisle_local_carve(&local, &arena, CELLS);
    hall_read(&scene, &arena, CELLS);
    read_more();
    aisle_space_begin(&space, &scene.layout, &scene.vehicle, AISLE_SPACE_FREE_TURN);
    request = (aisle_local_request){.space = &space,
                                    .movers = &movers,
                                    .speed = 1.0,
                                    .range = AISLE_LOCAL_RANGE,
                                    .particles = (uint32_t)strtoul(argv[3], NULL, 10),
                                    .lattice = strtod(argv[4], NULL),
                                    .beeline = strtol(argv[5], NULL, 10) != 0};
    const unsigned long first = strtoul(argv[1], NULL, 10), seeds = strtoul(argv[2], NULL, 10);
    for (unsigned long s = first; s < first + seeds; s++) {
        run((uint64_t)s, strtol(argv[6], NULL, 10) != 0);
    }
    return 0;
}
