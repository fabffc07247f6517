// spacetime_oracle.h - when can a vehicle be at its goals among movers whose whole future is known? Exhaustive, shares
// nothing with src/.
//
// Searches all of a lattice of places x 16 headings x speeds x time, layer by layer of time: sets of cells as bits, moved
// as a whole. Waiting is always possible. The vehicle knows where every mover ever will be, but is bound by the same rule
// of passive safety as Aisle: at every instant at which it moves it could go on for its reaction time, brake with d_max,
// straight ahead, and be at rest before body and margin meet any disc that grows with v_bound from the mover's true place
// at that instant. (A mover that runs into a standing vehicle does not count.)
//
// On the safe side, so that a way found is one: the body is taken as a row of discs that cover it (up to 6 % wider), all
// rounding to the lattice is added to what is kept clear, steps are no longer than speeds and accelerations allow, speeds
// are a few levels, one of them creep_speed.
// On the other side: instants are looked at every 0.2 s at most; headings change by 22.5 degrees at once between steps,
// whatever lateral_a_max and curvature_max say, and turns on the spot take 22.5 degrees / omega_max without ramps.
// Vehicles do not drive backwards. Times are whole steps of 0.5 to 1 s. So a found way is sound for passive safety, its
// time is within a few per cent of the best one on either side; compare it with a run without movers (`blind`), which
// has the same errors.
// Brake paths are straight. Aisle brakes along its way, which may be bent: rarely, it can go where the oracle cannot.
//
// Obstacles are convex polygons and the bounds; double. Memory: heap, some 50 MB for a hall of 24 x 24 m.
#ifndef SPACETIME_ORACLE_H
#define SPACETIME_ORACLE_H

#include "spacetime_bits.h"

#define SPACETIME_DIRS 16
#define SPACETIME_LEVELS 9 // rest and up to eight speeds
#define SPACETIME_VERTICES 16
#define SPACETIME_POLYGONS 512
#define SPACETIME_MOVERS 256
#define SPACETIME_GOALS 64
#define SPACETIME_DISCS 24 // of the body

typedef struct spacetime_polygon {
    double v[SPACETIME_VERTICES][2]; // convex, counter-clockwise
    int n;
} spacetime_polygon;

typedef struct spacetime_vehicle { // all > 0, but radius or the polygon may be left out
    spacetime_polygon body;        // about its origin, forwards is x
    double radius, margin, v_max, a_max, d_max, omega_max, alpha_max, reaction_time, creep_clearance, creep_speed;
} spacetime_vehicle;

typedef struct spacetime_mover {
    double radius, v_bound;    // a disc
    const double (*sample)[3]; // t, x, y; t grows; even motion in between, not there before and after
    int count;
} spacetime_mover;

typedef struct spacetime_goal {
    double x, y, tolerance, theta, tolerance_theta, dwell; // tolerance_theta >= pi: any heading
} spacetime_goal;

typedef struct spacetime_problem {
    double x_min, y_min, x_max, y_max;
    spacetime_polygon polygon[SPACETIME_POLYGONS];
    int polygons;
    spacetime_vehicle vehicle;
    spacetime_mover mover[SPACETIME_MOVERS];
    int movers;
    double start[3], t_start; // at rest
    spacetime_goal goal[SPACETIME_GOALS];
    int goals;
    double t_end; // later is not looked at
} spacetime_problem;

typedef enum spacetime_verdict {
    SPACETIME_FOUND,
    SPACETIME_NONE,       // not by t_end
    SPACETIME_NOT_DECIDED // the start is not free for the covered body, or no memory
} spacetime_verdict;

typedef struct spacetime_state { // of a way, after each step of dt
    int x, y, dir, level;
} spacetime_state;

typedef struct spacetime_oracle {
    const spacetime_problem *problem;
    double h, dt;                              // m, s
    int nx, ny, x0, y0;                        // cells; cell (0, 0) is x0, y0 cells from the start
    double speed[SPACETIME_LEVELS];            // [0] = 0, [1] = creep_speed or v_max
    int levels, subs;                          // looks in a step
    double disc[SPACETIME_DISCS], disc_radius; // m, the body's cover along its axis
    int discs;
    double outer; // m, of a disc about the origin around the body
    double *clearance;
    spacetime_bits free_to_turn;
    struct spacetime_step *step;       // [SPACETIME_DIRS * levels * levels]
    struct spacetime_template *shadow; // [movers * SPACETIME_DIRS * (levels + 1)], made when needed
    spacetime_bits *now, *next;        // [SPACETIME_DIRS * levels]
    spacetime_bits from, step_from, goal;
    bool blind; // movers are left out
    // Of the last run if `keep` was set before: every layer, to trace a way back.
    bool keep;
    spacetime_bits *layer; // [layers * SPACETIME_DIRS * levels]
    int layers, layers_capacity;
} spacetime_oracle;

// problem: as long as the oracle. False: no memory.
bool spacetime_begin(spacetime_oracle *self, const spacetime_problem *problem);
void spacetime_end(spacetime_oracle *self);

// Earliest time at which all goals are visited in their order (dwells included); goals' own arrivals in
// arrival[problem->goals], may be NULL.
spacetime_verdict spacetime_run(spacetime_oracle *self, double *done, double *arrival);

// After a run with `keep` and one goal that found a way: its states, one per layer; how many. 0: more than capacity.
int spacetime_trace(spacetime_oracle *self, spacetime_state *way, int capacity);

// Metres gone and speed `tau` seconds into a step between levels; the step's length is `length`.
double spacetime_gone(const spacetime_oracle *self, int from, int to, double tau, double *speed);
void spacetime_move(const spacetime_oracle *self, int dir, int from, int to, int *dx, int *dy); // cells of a step

// Where a mover is; false: not there.
bool spacetime_mover_at(const spacetime_mover *mover, double t, double *x, double *y);
#endif
