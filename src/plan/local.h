// local.h - PSO_LOCAL: going round what has come into the way, by a local particle swarm. Level 4.
//
// Method (Islam, Tajmiruzzaman, Muftee, Hossain 2013, "Autonomous robot path planning using PSO in dynamic environment
// with mobile obstacles & multiple target"): particles are places within sensing range of the present position; one
// whose straight line from there meets an obstacle is RELOCATED (drawn anew, algo/pso.h), not penalised; the best is
// the next position; until the goal is within range and in line of sight. w from 0.9 to 0.4 over 100 iterations,
// c1 = c2 = 2.
// Ours, so that it can be depended on:
//   - F = 0.9 * distance to the place + cost-to-go there (togo.h, of the body's disc, movers that stand closed), where
//     the paper has the distance to the goal (eq. 4, `beeline`): a concave pocket is no trap. 0.9: of places on one
//     shortest way the farther is the better one.
//   - the first particle begins at the farthest place in sight down the cost-to-go, so a step never hangs on luck;
//   - each position is nearer to the goal (by F's second term) than the one before: no cycles, and an end;
//   - it is looked for over places that surely are wide enough first, then over all that may be (AISLE_LOCAL_SURE);
//   - where no step leads on, what hindered it is closed in the cost-to-go (a mover with the way it is believed to
//     take; else the coarse cells that are narrower than they look) and all begins anew, AISLE_LOCAL_ROUNDS times;
//   - the rest of the old way is rejoined at its farthest place within range and in line of sight whose rest is free of
//     movers' discs, unless that is clearly longer than the cost-to-go;
//   - at the end points are left out and pulled in where the lines stay free;
//   - a swarm that has not improved for AISLE_LOCAL_STALL rounds of its particles ends.
// Movers: a line is free if the body, driven along it at `speed`, keeps radius + 3 sigma + margin + `safety` off each
// mover's predicted place at each instant: the motion of one relative to the other is a straight line too, so the test
// is exact. A mover is believed to keep its velocity for `drift` metres of its way (one that stands: for ever), then it is
// left out. One that is nearer than that at the very beginning may be left, but not approached. Body: with its
// heading along the line (ALONG), or its turning disc (FREE_TURN). Prediction is quality, not safety: the moving
// proof stands by itself. ALONG: points lie only where the body can turn, so it takes
// no aisle too narrow for that and longer than the range; the first line leads on straight (AISLE_LOCAL_STRAIGHT) unless
// it can turn at `from`.
// A host that wants the paper's world, where an obstacle may jump anywhere within 1 m in x and y at each iteration,
// tells each one with that jump added to its radius and velocity 0, and takes the first line only: then a vehicle under
// way is off every place the obstacle can reach meanwhile (passive safety); tools/paper/paper_local.c does so.
// Memory: aisle_togo's and about 90 KiB, carved. Time: a round is O(cells reached) + steps * particles * iterations
// lines at most, sliced; a unit for each line and for what space.h and togo.h count.
// Determinism: the same request gives the same bits however it is cut into steps.
// Hits of seeds (tests/plan/test_local.c): U, spiral and dead-end aisle, 40 of 40 each; with the paper's F 0 of 40.
#ifndef AISLE_PLAN_LOCAL_H
#define AISLE_PLAN_LOCAL_H

#include "algo/pso.h"
#include "plan/space.h"
#include "plan/togo.h"
#include "world/movers.h"

#define AISLE_LOCAL_RANGE 5.0 // m
#define AISLE_LOCAL_RANGE_MAX 100.0
#define AISLE_LOCAL_DRIFT 6.0    // m
#define AISLE_LOCAL_STANDING 0.1 // m/s, a slower mover is closed in the cost-to-go from the beginning
#define AISLE_LOCAL_PARTICLES 30U
#define AISLE_LOCAL_ITERATIONS 100U
#define AISLE_LOCAL_STALL 8U
#define AISLE_LOCAL_RELOCATE 8U // times a particle is drawn anew in a row
#define AISLE_LOCAL_STEPS 160U  // positions in a round
#define AISLE_LOCAL_ROUNDS 24U
#define AISLE_LOCAL_SURE 6U       // of them over sure places, at most
#define AISLE_LOCAL_WAY_MAX 1024U // points of the old way
#define AISLE_LOCAL_POINTS_MAX (AISLE_LOCAL_STEPS + AISLE_LOCAL_WAY_MAX + 4U)
#define AISLE_LOCAL_STRAIGHT 0.02 // rad

typedef struct aisle_local_request {
    const aisle_space *space;   // begun on the layout, vehicle and mode
    const aisle_movers *movers; // NULL: none
    aisle_vec2 from;            // m
    double heading;             // rad, of the vehicle there
    int64_t from_us;            // when it is there
    const aisle_vec2 *way;      // rest of the old way, its last point the goal; NULL: none
    uint32_t way_count;         // <= AISLE_LOCAL_WAY_MAX
    aisle_vec2 goal;            // m
    double speed;               // m/s, > 0, by which is told when it is where
    double range;               // m, of sensing; 0: AISLE_LOCAL_RANGE; at most AISLE_LOCAL_RANGE_MAX
    double safety;              // m, >= 0
    double drift;               // m; 0: AISLE_LOCAL_DRIFT
    double longest;      // m, a way whose cost-to-go is more than 8 % and a cell above it is not looked for; 0: any
    double lattice;      // m, places are multiples of it (the paper: 1); 0: any. Points are not pulled then
    bool beeline;        // the paper's F; no cost-to-go, no rounds
    uint64_t seed;       // any
    uint32_t particles;  // 0: AISLE_LOCAL_PARTICLES; 2 to AISLE_PSO_PARTICLES_MAX
    uint32_t iterations; // 0: AISLE_LOCAL_ITERATIONS; at most 10000
} aisle_local_request;

typedef enum aisle_local_end {
    AISLE_LOCAL_GOAL,     // by new points alone
    AISLE_LOCAL_REJOINED, // the old way
    AISLE_LOCAL_CLOSED,   // the cost-to-go knows no way among what stands: none for the disc, movers where told
    AISLE_LOCAL_LONG,     // one longer than asked for may be there
    AISLE_LOCAL_STUCK     // none found; not a proof
} aisle_local_end;

typedef struct aisle_local_mover { // as lines see one
    aisle_vec2 at, velocity;       // predicted at from_us
    double keep;                   // m, between its place and the body
    double until;                  // s after from_us, believed
    int32_t id;
    bool closed; // in the cost-to-go
} aisle_local_mover;

typedef struct aisle_local_bar { // a place closed since no line led through it
    aisle_vec2 at;
    double radius;
} aisle_local_bar;

typedef struct aisle_local {
    aisle_local_request request;
    aisle_togo togo;
    aisle_pso pso;
    aisle_pso_config config;
    float *work; // [AISLE_PSO_WORK_LEN(2, AISLE_PSO_PARTICLES_MAX)]
    float lo[2], hi[2], guess[2];
    aisle_local_mover *mover; // [AISLE_MOVERS_MAX]
    uint16_t *near;           // [AISLE_MOVERS_MAX] those that can matter from the present position
    uint32_t movers, nears;
    double believed; // s after from_us, no moving mover is believed later
    aisle_local_bar bar[AISLE_LOCAL_ROUNDS];
    uint32_t bars, round, phase;
    bool sure;                   // this round's cost-to-go leads over sure places alone
    aisle_vec2 *points;          // [AISLE_LOCAL_POINTS_MAX] the answer
    uint32_t count;              // of points; 0 where there is none
    uint32_t fresh;              // how many of them are new: the last of these lies on the old way, or is the goal
    uint32_t rejoin;             // REJOINED: points[fresh] is way[rejoin]
    double length;               // m, of the answer
    aisle_local_end end;         // when step() is done
    int32_t blocker;             // id of the last mover that hindered; 0: none did
    uint32_t lines, relocations; // looked at; particles
    double level;                // m, F's second term at the present position
    double here_s;               // s, since from_us, at the present position
    uint32_t at, pass;           // of the tidying up
    bool changed, turns_at_from;
    uint32_t units;
} aisle_local;

void aisle_local_carve(aisle_local *self, aisle_arena *arena, uint32_t cells);

// Begins. What the request points at lives until the end. AISLE_ERR_ARG, nothing changed: a number not finite or out of
// its range, `from` and `goal` less than 1e-6 m apart, a way that does not end at the goal (1e-6 m). O(movers).
aisle_status aisle_local_start(aisle_local *self, const aisle_local_request *request);

// Spends about `units`, adds what it took to *spent. AISLE_BUSY; AISLE_OK: points[count] leads from `from` to the goal;
// AISLE_PARTIAL: no way round, `end` says how sure that is. Further calls repeat the answer.
aisle_status aisle_local_step(aisle_local *self, uint32_t units, uint32_t *spent);
#endif
