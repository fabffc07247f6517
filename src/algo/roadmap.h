// roadmap.h - probabilistic roadmap: built once for a space, repaired where it changes, asked many times. Level 2.
//
// Method: PRM (Kavraki, Svestka, Latombe, Overmars 1996, doi:10.1109/70.508439), as in Sampling-Based Path Planning
// Algorithm for a Plug & Produce Environment (2023, doi:10.3390/app132212114, algorithms 3 and 4): configurations are
// drawn, the free ones are nodes, each is joined to its k nearest by the space's own motion where that is free, and a
// query joins its ends likewise and finds the best way by Dijkstra's algorithm or A* (h: the space's bound()).
// Ours, not theirs:
//     samples are the draws, not the nodes: the paper draws until so many are free. So the same draws serve whatever is
//         free, and those that are not are kept: they become nodes when what covered them leaves;
//     lazy (Bohlin & Kavraki 2000, doi:10.1109/ROBOT.2000.844107), unless config.eager, the paper's: an edge is tested
//         when a search first comes to its end by it, as in lazy weighted A* (Cohen, Phillips, Likhachev 2014,
//         doi:10.15607/RSS.2014.X.034): if it is blocked the node goes on by the next best edge from a node that is
//         done with. Each edge is tested once, and the way found is the same as with all tested before;
//     blocks: draws come in blocks (config.first, then grow()); the nodes of one are joined to their k nearest of all
//         so far, and earlier ones' lists stay, as in the paper where each node is joined to those before it: long
//         motions of when nodes were few stay, by which a roadmap hangs together sooner;
//     moved draws: later ones may be moved off what they touch (config.uniform), so that slits get draws;
//     repair: a change of the space, told as which motions it may touch, tests only the draws and edges it touches
//         again, and only lists of neighbours with a draw in them that came or left are made anew. Repaired and built
//         anew have the same nodes, lists and free edges if all draws are uniform; moved ones stay where they are,
//         where one built anew moves them otherwise.
// An edge is in the list of either of its ends, or both. Where is_free() may differ from a to b and from b to a
// (config.one_way) both are tested and kept apart.
//
// Memory: for each draw 8 dim + 8 bytes, 7 for each of its k edges, and the index (near.h); a search 31 a draw, which
// others may use between queries. Nothing is allocated. Time: building O(n (k^2 + log n)) and, eager, up to 2 n k
// tests; a query O(nodes seen * (degree + log n)) and its tests; a repair O(n (k touches() + draws that came)) and its
// tests. Each in slices.
// Determinism: same space, config and changes give the same bits however cut into steps; ties by index.
#ifndef AISLE_ALGO_ROADMAP_H
#define AISLE_ALGO_ROADMAP_H

#include "aisle/status.h"
#include "algo/cspace.h"
#include "algo/near.h"
#include "base/heap.h"

#define AISLE_ROADMAP_SAMPLES_MAX 65000U
#define AISLE_ROADMAP_K_MAX 32U
#define AISLE_ROADMAP_BLOCKS 16U // that draws come in, at most
#define AISLE_ROADMAP_NONE UINT32_MAX

// Does what has changed matter to the motion from a to b (a = b: to this configuration)? May say yes where it does not.
typedef bool (*aisle_roadmap_touch_fn)(void *context, const double *a, const double *b);

typedef enum aisle_roadmap_known { // of a motion
    AISLE_ROADMAP_UNKNOWN,
    AISLE_ROADMAP_FREE,
    AISLE_ROADMAP_BLOCKED
} aisle_roadmap_known;

typedef struct aisle_roadmap_config {
    uint32_t samples; // draws, [1, capacity]
    uint64_t seed;
    uint32_t first;   // of them, that the first block holds, the next ones doubling them; 0: there is one block
    uint32_t uniform; // of them; later ones are moved off what they touch when they are drawn (cspace.h); 0: all are
    bool eager;       // test every edge while building
    bool one_way;     // is_free() hangs on the direction
} aisle_roadmap_config;

typedef enum aisle_roadmap_phase {
    AISLE_ROADMAP_EMPTY,
    AISLE_ROADMAP_DRAW,
    AISLE_ROADMAP_TOUCH, // a repair: which draws have come or left,
    AISLE_ROADMAP_JUDGE, // and whose neighbours change by that
    AISLE_ROADMAP_INDEX,
    AISLE_ROADMAP_CONNECT,
    AISLE_ROADMAP_REVERSE,
    AISLE_ROADMAP_DOUBT, // a repair: which edges are touched
    AISLE_ROADMAP_TEST,
    AISLE_ROADMAP_READY
} aisle_roadmap_phase;

typedef enum aisle_roadmap_work {
    AISLE_ROADMAP_BUILDS,
    AISLE_ROADMAP_REPAIRS,
    AISLE_ROADMAP_COPIES
} aisle_roadmap_work;

// Public so that it can be part of others. Read what is commented, write nothing.
typedef struct aisle_roadmap {
    const aisle_cspace *space;
    aisle_roadmap_config config;
    uint32_t capacity, k, dim, dim_max; // dim: the space's
    uint32_t count;                     // draws
    uint32_t free_count;                // of them nodes
    double *q;                          // [(capacity + 2) * dim] draws, then the ends of the query under way
    uint8_t *kind;                      // [capacity] aisle_roadmap_known of each draw, and whether a repair changed it
    uint8_t *degree;                    // [capacity + 2] of its list
    uint16_t *list;                     // [(capacity + 2) * k] neighbours, nearest first
    uint8_t *known;    // [(capacity + 2) * k] of the edge, bits 0 and 1 from the list's node, 2 and 3 to it
    uint32_t *from;    // [capacity + 1] where a node's entries in back[] begin
    uint32_t *back;    // [capacity * k] places in list[] that name the node, but for those it names itself
    uint16_t *node_of; // [capacity] by number in the index; during a repair the draws that have come
    aisle_near near;   // of the nodes
    aisle_rng rng;
    aisle_roadmap_touch_fn touches;
    void *touch_context;
    aisle_roadmap_phase phase;
    uint32_t end[AISLE_ROADMAP_BLOCKS]; // draws up to the end of each block
    uint32_t blocks, block;             // how many; whose neighbours are looked for
    uint32_t at;                        // in the phase
    uint32_t came, left;                // draws, by the repair under way
    aisle_roadmap_work work;            // under way or done last
    uint32_t edge_tests;                // calls of is_free() for edges of the roadmap
    uint32_t retested;                  // draws and edges that repairs have put in doubt
    uint32_t lists_renewed;             // by repairs
} aisle_roadmap;

// For `samples` draws in [1, AISLE_ROADMAP_SAMPLES_MAX] of `dim` numbers and k in [1, AISLE_ROADMAP_K_MAX] nearest.
// Usable unless arena->overflow or measuring.
void aisle_roadmap_carve(aisle_roadmap *self, aisle_arena *arena, uint32_t dim, uint32_t samples, uint32_t k);

// Begins to build from nothing. The space must stay as it is, but for changes told to repair(). AISLE_ERR_ARG: config
// is out of range or the space has more dimensions; self is unchanged.
aisle_status aisle_roadmap_start(aisle_roadmap *self, const aisle_cspace *space, const aisle_roadmap_config *config);

// When it is ready: goes on to so many draws, more than there are. AISLE_ERR_ARG, nothing changed: they are not more,
// too many, or there are AISLE_ROADMAP_BLOCKS blocks.
aisle_status aisle_roadmap_grow(aisle_roadmap *self, uint32_t samples);

// When it is ready: the space has changed where `touches` says so; begins to repair. context lives until it is ready.
void aisle_roadmap_repair(aisle_roadmap *self, aisle_roadmap_touch_fn touches, void *context);

// Builds or repairs by about `units`, which it adds to *spent: what is_free() takes, and one for each list. AISLE_BUSY,
// then AISLE_OK: ready. AISLE_ERR_ARG: nothing was started.
aisle_status aisle_roadmap_step(aisle_roadmap *self, uint32_t units, uint32_t *spent);

// Takes all that another one knows, of the same capacity and k, which is ready; `space` says the same as its one.
// step() then makes the index anew.
void aisle_roadmap_copy(aisle_roadmap *self, const aisle_roadmap *other, const aisle_cspace *space);

// ---- the query phase

typedef enum aisle_roadmap_search_kind { AISLE_ROADMAP_DIJKSTRA, AISLE_ROADMAP_ASTAR } aisle_roadmap_search_kind;

typedef struct aisle_roadmap_search {
    aisle_roadmap *roadmap;
    aisle_roadmap_search_kind kind;
    aisle_heap open;    // of nodes
    double *cost;       // [capacity + 2] from the start
    uint32_t *parent;   // [capacity + 2] link by which
    uint8_t *is_done;   // [capacity + 2]
    uint8_t *end_place; // [2 * capacity] by node: place + 1 in the start's list, then in the goal's; 0: it is not there
    uint32_t capacity;
    uint32_t expanded, tests; // nodes, motions tested; since start
    aisle_status ended;       // AISLE_BUSY while running
} aisle_roadmap_search;

void aisle_roadmap_search_carve(aisle_roadmap_search *self, aisle_arena *arena, uint32_t samples);

// Begins a query on a roadmap that is ready; from[dim], to[dim] within the space's bounds. The motion from end to end
// is tried first. What is learnt of edges stays in the roadmap.
void aisle_roadmap_ask(aisle_roadmap_search *self, aisle_roadmap *roadmap, aisle_roadmap_search_kind kind,
                       const double *from, const double *to, uint32_t *spent);

// About `units`. AISLE_BUSY; AISLE_OK: found; AISLE_PARTIAL: the roadmap does not join the ends, which proves nothing.
aisle_status aisle_roadmap_search_step(aisle_roadmap_search *self, uint32_t units, uint32_t *spent);

// After AISLE_OK: cost of the way, and its configurations, ends included, to q[capacity * dim]; returns how many there
// are, 0 if they do not fit. Between ask() and the next ask(), repair(), grow() or copy() of the roadmap.
double aisle_roadmap_cost(const aisle_roadmap_search *self);
uint32_t aisle_roadmap_way(const aisle_roadmap_search *self, double *q, uint32_t capacity);

// ---- for pictures and tests

// What is known of the motion from node a to node b; AISLE_ROADMAP_BLOCKED too where there is no edge. O(k).
aisle_roadmap_known aisle_roadmap_edge(const aisle_roadmap *self, uint32_t a, uint32_t b);
bool aisle_roadmap_is_node(const aisle_roadmap *self, uint32_t draw);
// O(n k^2), ready: lists in order and within range, back[] what the lists say, both ends of an edge agree.
bool aisle_roadmap_invariants_hold(const aisle_roadmap *self);
#endif
