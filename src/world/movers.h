// movers.h - moving obstacles as their sources last told them, and where they can be. Level 1.
//
// A source's message is a full snapshot: it replaces all that the source told before, and an id that is absent is gone.
// A message is taken whole or refused whole. Nothing is moved on or dropped with time: who asks says when.
//
// Where a mover can be (reach): the disc about its measured place with the radius
//     r + 3 sigma + v_bound * (T - utime)                                   at time T, not before utime
// r: of the disc about its place that holds the body however it turns (its farthest vertex + radius). sigma: root of the
// larger eigenvalue of cov_xy. A mover's bound is never below the speed it reports. Reaches grow with time only.
// Where it is likely to be (predicted): moves on at constant velocity; sigma^2 + (sigma_v * (T - utime))^2. For quality,
// never for safety.
//
// Memory: carved, about 100 bytes for each of 4 * 256. Time: as stated. Threads: one at a time.
#ifndef AISLE_WORLD_MOVERS_H
#define AISLE_WORLD_MOVERS_H

#include "aisle/messages.h"
#include "aisle/status.h"
#include "base/arena.h"
#include "base/vec.h"
#include "world/layout.h" // aisle_refusal
#include "world/shape.h"

#include <stdbool.h>
#include <stdint.h>

#define AISLE_MOVERS_SOURCES ((uint32_t)AISLE_OBSTACLES_MAX_SOURCES)
#define AISLE_MOVERS_MAX (AISLE_MOVERS_SOURCES * (uint32_t)AISLE_OBSTACLES_MAX_OBSTACLES)
#define AISLE_MOVERS_SIGMA 0.05       // m, where a message says 0
#define AISLE_MOVERS_SIGMA_V 0.2      // m/s, likewise
#define AISLE_MOVERS_SIGMAS 3.0       // of the place, counted into the reach
#define AISLE_MOVERS_SPEED_MAX 50.0   // m/s, and of v_bound
#define AISLE_MOVERS_RADIUS_MAX 50.0  // m, of a body
#define AISLE_MOVERS_AHEAD_US 1000000 // a message from farther in the future is refused

typedef struct aisle_mover {
    int32_t id;
    uint8_t source;
    int8_t kind;           // AISLE_OBSTACLE_*
    aisle_vec2 at;         // m, at utime
    aisle_vec2 velocity;   // m/s
    double radius;         // m, r above
    double sigma, sigma_v; // m, m/s
    double v_bound;        // m/s, resolved
    int64_t utime;         // us, of measurement
} aisle_mover;

typedef struct aisle_movers_source {
    bool known;       // has spoken
    int64_t utime;    // of its newest message
    int64_t taken_us; // when that was taken
    int32_t seq;
    uint32_t first, count; // its movers
} aisle_movers_source;

typedef struct aisle_movers {
    aisle_mover *mover; // [AISLE_MOVERS_MAX], by source, then as sent
    uint32_t count;     // of all sources
    aisle_movers_source source[AISLE_OBSTACLES_MAX_SOURCES];
    uint32_t revision; // rises with every message taken
} aisle_movers;

void aisle_movers_carve(aisle_movers *self, aisle_arena *arena);

// Takes a message at now_us. map_id: of the layout in force, 0 = none. AISLE_OK: taken. AISLE_PARTIAL: the very message
// held (utime and seq), ignored. AISLE_ERR_DATA, nothing changed, *why (id):
//   LIMIT         source not in 0..3 (source), count above the bound (count)
//   MALFORMED     the id of the first obstacle with a number that is not finite or out of range (place beyond
//                 AISLE_SHAPE_COORD_MAX, negative variance, radius, v_bound or sigma_v; above the limits at the top), a kind
//                 there is not, a number of vertices not 0 or 3..8, an outline that is not convex and counter-clockwise,
//                 a disc without radius; 0: the count is negative
//   CONFLICT      the id two obstacles share
//   OUTDATED      older than the message held (seq)
//   CLOCK_JUMP    measured more than AISLE_MOVERS_AHEAD_US after now_us (source)
//   MAP_MISMATCH  for another map (its map_id; 0 = not told, taken)
// O(obstacles^2, movers held); 1 KiB of stack.
aisle_status aisle_movers_take(aisle_movers *self, const aisle_obstacles_msg *msg, int64_t now_us, int32_t map_id,
                               aisle_refusal *why);

// Radius of the reach at at_us, m. O(1).
double aisle_mover_reach(const aisle_mover *self, int64_t at_us);

// Likely place at at_us, and its standard deviation (may be NULL), m. O(1).
aisle_vec2 aisle_mover_predicted(const aisle_mover *self, int64_t at_us, double *sigma);

// A source that spoke once must keep speaking: the first one whose newest message was measured, or taken, more than
// timeout_s before now_us. False: none. O(1).
bool aisle_movers_stale(const aisle_movers *self, int64_t now_us, double timeout_s, int32_t *source);

// When the next source turns stale, us; INT64_MAX: never. O(1).
int64_t aisle_movers_stale_at(const aisle_movers *self, double timeout_s);

// utime of the newest message of all; 0: none. O(1).
int64_t aisle_movers_utime(const aisle_movers *self);
#endif
