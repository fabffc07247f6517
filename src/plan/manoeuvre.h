// manoeuvre.h - a way for the exact body with its heading, turns and reversals: search over configurations. Level 4.
//
// For legs whose shortest way the body cannot simply follow: narrow aisles, headings given where it cannot turn, cars.
// Search: weighted A* over configurations (x, y, theta), f = cost + AISLE_MANOEUVRE_WEIGHT * cost-to-go (togo.h). A
// configuration's cell (place, heading, direction of motion) is closed by the first that comes up; the configurations
// themselves are exact, not on a lattice (hybrid A*: Dolgov et al. 2010, doi:10.1177/0278364909359210). Successors: a
// step straight on or back, longer in the open; steps of arcs; a turn on the spot to the next heading where the vehicle
// does that (curvature_max 0); and links (steer.h) to targets: the goal, configurations in line with it, and such along
// the shortest way of the disc inside, moved to the middle of the room they find. Ours: the end of a step is tested when
// it is made, the motion when it comes up, since most never do; the links.
// First a few nodes in coarse cells; then, where these do not come to the goal, with a tree of some nodes from the goal
// backwards for targets, too (what can be driven one way can be driven the other), in coarse cells, in finer ones, and,
// where the tree or the search ended by itself, in still finer ones (manoeuvre.c: a hall is too large for these; coarse
// cells with exact configurations in them find nearly all). Then the chain is shortened: from each
// configuration on it the ways of steer.h to later ones are tried and taken where they cost less.
// No motion is against a DIRECTED zone (zones.h); tolls are not minded.
// Cost: metres, more for one backwards, and what cusps and turns add (vehicle_space.h); where request.dear is above 1, so many
// times a metre that comes nearer than request.clear to something, by gaps at most PART of manoeuvre_free.c apart. Not an
// optimum, and no proof where it finds none.
// Files: manoeuvre.c (attempts, phases), manoeuvre_targets.c, manoeuvre_open.c (open list), manoeuvre_expand.c (successors),
// manoeuvre_free.c (tests), manoeuvre_chain.c (the way found), manoeuvre_shorten.c.
// Memory: 80 bytes a node and two slots of 16, nodes by the limit of cells; togo.h; 80 KiB. Time: AISLE_MANOEUVRE_UNITS
// at most, sliced; a unit is an exact gap.
#ifndef AISLE_PLAN_MANOEUVRE_H
#define AISLE_PLAN_MANOEUVRE_H

#include "aisle/limits.h"
#include "base/heap.h"
#include "plan/space.h"
#include "plan/togo.h"
#include "robot/steer.h"

#define AISLE_MANOEUVRE_WEIGHT 2.0
#define AISLE_MANOEUVRE_TARGETS 512U   // configurations that are linked to
#define AISLE_MANOEUVRE_CHAIN 512U     // moves of a way
#define AISLE_MANOEUVRE_NODES 65536U   // at most
#define AISLE_MANOEUVRE_UNITS 1500000U // spent on one search

typedef struct aisle_manoeuvre_request {
    const aisle_space *space; // its layout and vehicle; the mode does not matter
    aisle_pose2 start, goal;
    bool start_is_free, goal_is_free; // any heading will do
    const aisle_vec2 *way;            // [way_count] a polyline from start to goal, the caller's until the end; its
    uint32_t way_count;               // corners are rounded by way_radius (m); 0: none is known
    double way_radius;
    double reach;   // m, of the disc whose cost-to-go leads: inner radius and margin, or more
    double clear;   // m, of the body's gap: nearer ...
    uint32_t dear;  // ... a metre costs so many times as much, at most AISLE_TOGO_DEAR_MAX; 0, 1: all metres are alike
    uint32_t units; // that may be spent on the search; 0: AISLE_MANOEUVRE_UNITS
} aisle_manoeuvre_request;

typedef struct aisle_manoeuvre_node {
    aisle_pose2 pose;
    float cost;         // m, from the start
    float length, turn; // of the step that led here
    uint32_t parent;
    uint16_t target;  // that a link led to; AISLE_MANOEUVRE_TARGETS: a step led here
    uint8_t way;      // of the link, which of steer's
    int8_t direction; // of the last move that has a length: 1, -1; 0: none yet
    bool is_weighed;  // a link whose motion is known to be free, and its cost what it is
} aisle_manoeuvre_node;

typedef struct aisle_manoeuvre_slot { // what is known of a cell of configurations
    uint64_t key;                     // 0: empty
    float least;                      // cost of what is open
    uint8_t open;                     // nodes in it that have not come up
    bool closed;
} aisle_manoeuvre_slot;

typedef struct aisle_manoeuvre_target {
    aisle_pose2 pose;
    double togo;   // m, cost from there to the goal, of a tree's node known, else about
    uint32_t node; // of the tree from the goal; AISLE_HEAP_NONE: none
    bool closed;
} aisle_manoeuvre_target;

typedef enum aisle_manoeuvre_phase {
    AISLE_MANOEUVRE_FIELD,  // cost-to-go
    AISLE_MANOEUVRE_TARGET, // targets are made
    AISLE_MANOEUVRE_TREE,   // from the goal backwards
    AISLE_MANOEUVRE_SEARCH,
    AISLE_MANOEUVRE_FOUND, // elsewhere
    AISLE_MANOEUVRE_SHORTEN,
    AISLE_MANOEUVRE_DONE,
    AISLE_MANOEUVRE_FAILED
} aisle_manoeuvre_phase;

typedef struct aisle_manoeuvre {
    aisle_manoeuvre_request request;
    aisle_steer_rule rule;
    aisle_togo togo;
    aisle_manoeuvre_phase phase;
    aisle_manoeuvre_node *node; // [node_capacity]
    uint32_t *spare;            // [node_capacity] nodes given back
    uint32_t node_count, spare_count, node_capacity;
    aisle_heap open;
    aisle_manoeuvre_slot *slot; // [slot_capacity], a power of two
    uint32_t slot_capacity, slots;
    aisle_manoeuvre_target *target; // [AISLE_MANOEUVRE_TARGETS]
    uint32_t target_count, next_target;
    uint32_t tree_target;  // targets from here on are nodes of the tree
    uint32_t tree_count;   // nodes of the tree: the first ones
    uint32_t attempt;      // see manoeuvre.c
    bool trapped;          // the tree ended by itself
    bool full;             // a node found no room: what is not found may be there all the same
    double side;           // 1: from the start, -1: from the goal, everything driven the other way
    double cell, step;     // m
    uint32_t headings;     // in a full turn
    double need;           // m, that the body keeps
    uint32_t expanded;     // nodes, in this attempt
    uint32_t link_next;    // links are made again when so many are expanded
    uint32_t link_fails;   // links that came to nothing, one after the other
    aisle_move *move;      // [AISLE_MANOEUVRE_CHAIN] the way found
    float *near;           // [AISLE_MANOEUVRE_CHAIN] m, of each move, what it costs beyond that
    aisle_pose2 *junction; // [AISLE_MANOEUVRE_CHAIN + 1] before each move and at the end
    uint32_t moves;
    uint32_t at, pass; // of shortening
    uint32_t units;    // spent in this step
    uint32_t spent;    // in all
} aisle_manoeuvre;

// The way found lies apart from what only the search needs.
void aisle_manoeuvre_carve(aisle_manoeuvre *self, aisle_arena *arena, const aisle_limits *limits);
void aisle_manoeuvre_carve_way(aisle_manoeuvre *self, aisle_arena *arena);

// Begins. The start and the goal, where its heading is given, are known to be free.
void aisle_manoeuvre_start(aisle_manoeuvre *self, const aisle_manoeuvre_request *request);

// AISLE_BUSY; AISLE_OK: there is a way; AISLE_PARTIAL: none was found. Spends about `units`, adds them to *spent.
aisle_status aisle_manoeuvre_step(aisle_manoeuvre *self, uint32_t units, uint32_t *spent);

// Instead of start(): a way found elsewhere, only to be shortened by step(); of `request` its space and start are read.
// add(): moves from where it ends by now to `to`; false: there is no room.
void aisle_manoeuvre_begin_way(aisle_manoeuvre *self, const aisle_manoeuvre_request *request);
bool aisle_manoeuvre_add(aisle_manoeuvre *self, const aisle_move *moves, uint32_t count, aisle_pose2 to);

// After AISLE_OK: the way's waypoints as aisle_move_lay() makes them, the start first: w[capacity]; how many, 0: they do
// not fit.
uint32_t aisle_manoeuvre_lay(const aisle_manoeuvre *self, aisle_waypoint_msg *w, uint32_t capacity);
#endif
