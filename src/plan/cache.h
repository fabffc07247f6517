// cache.h - answers remembered: proved paths by what was asked, kept where a changed layout does not touch them. Level 4.
//
// Key: start, goals in their order with tolerances and dwell, ordering, options, the vehicle's content, the layout's map
// and content (aisle_layout_content()); no ids or times of messages, so a query's answer serves a goal list, too. All but
// the layout's is compared byte by byte behind the hash. Nothing here is trusted: what find() hands out is given a new
// head and goes to the verifier like any other path (verify.h; with the basis of its last proof), and bytes that are not
// those put in are dropped and counted as spoiled.
//
// A goal list may be given up while it is planned, at a moment that a replay of the same inputs does not know. So what is
// remembered must not hang on it: lists find what queries have left (readonly) and leave nothing themselves.
//
// Layout changes. An entry is of one layout's content. What a patch changes is known as boxes: an entry of the layout
// before is taken over to the new one (kept) if
// 1. no piece of its path comes nearer to a changed polygon's box than the outer radius and, of creep clearance, margin
//    and the clearance told for the piece, the largest. So what is told of clearance, risk, speeds and energy stays
//    true, and the path still is what the planner would make of the same way;
// 2. a removed polygon's box opens no better way. A way through it has to come as near as above, so with b that box
//    grown by outer radius and the larger of creep clearance and margin (and 5 mm), it is no shorter than
//        E(b) = min over p in b of |from - p| + |p - to|,    from, to the leg's ends,
//    and the path stays if on each leg E(b) >= L + D, L the leg's length and D what the whole path is worth beyond its
//    length by the objective's measure, as the length of a way without any hindrance:
//        SHORTEST      0
//        SAFEST        risk_weight * risk * length; without a risk_weight 0 where the risk is none, else no path stays
//        FASTEST       (duration - dwell) * v_max - length
//        LEAST_ENERGY  (energy - idle_power * dwell) / (m g c / efficiency + idle_power / v_max) - length
//    For ANY_ORDER the way to each goal is measured against the whole path. PAPER's own answers never stay.
// So it is promised of a path kept that it is proved on the new layout before it leaves, that its length_bound is still
// one, and that no way over ground that was freed since it was planned is better by more than what 1 mm is worth. It is as
// good, then, as when it was planned; a fresh search may still come out otherwise, better too, on ground that was free
// all the time, where the planner is not exact.
// What is not taken over (dropped) stays with the layout it is of, and serves when that comes back (a door that opens
// and shuts), until it is the least recently used.
//
// Repairs. An entry that is lost by 1. alone can be repaired as long as 2. holds for all changes since, so that ground was
// taken away and none given that could better it. Then its length_bound, less the 1 mm a leg that 2. leaves open, still is
// one, and nothing is worth more than the path was. So an answer made of its free pieces (route_repair.c) is taken if
//     SHORTEST      it is longer than that bound by at most AISLE_CACHE_REPAIR of it: surely no way is shorter by more
//     others        it is worse by at most that part of what the path was worth when it was planned, whatever repairs came
//                   between: the most that planning anew could win if the path was the best there was
// or, of a tree's answer, whose gap is closed by a tree again, if it is worse than what the path was worth by at most
// AISLE_CACHE_REPAIR_TREE of that: 10 %, since such answers differ by more from seed to seed, and none is told to be the best.
// 1 %, since SHORTEST answers are held to 1.01 times the optimum at worst. A longer detour may mean that another way round
// is the best one by now, which the free pieces do not tell.
//
// Zones of every kind are treated alike. After a change of everything nothing is taken over or repaired unless the new
// layout says the same.
//
// Memory: AISLE_CACHE_PATH_BYTES for each of cached_paths, which a longer path takes several of; at least one of any
// size fits. Least recently used leaves first. Time: find and put O(entries + bytes); a change O(waypoints * changed
// polygons), sliced.
#ifndef AISLE_PLAN_CACHE_H
#define AISLE_PLAN_CACHE_H

#include "aisle/limits.h"
#include "base/arena.h"
#include "base/pool.h"
#include "plan/verify.h"

#define AISLE_CACHE_PATH_BYTES 8192U // of key and path, on average
#define AISLE_CACHE_BLOCK 508U       // bytes of them in one block
#define AISLE_CACHE_NONE UINT32_MAX
#define AISLE_CACHE_REPAIR 0.01     // part of its worth that a repaired answer may be worse by
#define AISLE_CACHE_REPAIR_TREE 0.1 // of an answer of planner RRT to RRT_STAR_ADAPTIVE

typedef struct aisle_cache_question {
    const aisle_goal_msg *start, *goals; // goals[num_goals] as they were asked
    uint32_t num_goals;
    int8_t ordering; // AISLE_GOAL_LIST_*
    const aisle_options_msg *options;
    const aisle_vehicle *vehicle;
    const aisle_layout *layout;
    bool readonly; // what is remembered, and what was used last, stay as they are, but for what is spoiled
} aisle_cache_question;

typedef struct aisle_cache_block {
    uint32_t next; // AISLE_POOL_NONE at the end
    uint8_t bytes[AISLE_CACHE_BLOCK];
} aisle_cache_block;

typedef struct aisle_cache_entry {
    bool in_use, any_order;
    int32_t map_id;
    uint64_t content;                    // of the layout it is of
    bool can_repair;                     // it is lost on another one, but may be repaired there:
    uint64_t repair_content;             // of that
    double worth;                        // when it was planned: what repairs are held against
    uint64_t used;                       // when last, counted in finds and puts
    uint64_t hash;                       // of the key
    uint64_t head;                       // digest of the path's bytes before its waypoints; the basis tells of the rest
    uint32_t first, key_size, path_size; // bytes, one behind the other from block `first` on
    aisle_proof_basis basis;
    uint8_t order[AISLE_QUERY_MAX_GOALS];
    double theta;  // rad, of the path's first waypoint
    double reach;  // m, from the vehicle's origin to what may matter to it
    double radius; // m, outer
    double excess; // m, D above; < 0: not to be kept when something is removed
} aisle_cache_entry;

typedef struct aisle_cache_change { // of the layout, being taken in
    const aisle_layout *layout;
    const aisle_layout_diff *diff;
    aisle_path_msg *path; // of the entry in hand
    uint8_t *bytes;
    bool loaded;
    uint32_t entry, at; // in hand: its piece that ends at waypoint `at`
    uint32_t leg_start; // waypoint
    bool touched;       // it is lost, unless repaired
    uint64_t content;   // the layout's now
    int32_t map_id;
} aisle_cache_change;

typedef struct aisle_cache {
    aisle_cache_entry *entries; // [capacity]
    uint32_t capacity;
    aisle_pool blocks;
    uint8_t *key; // [AISLE_CACHE_KEY_MAX] of the question in hand
    uint32_t key_size;
    uint64_t hash;          // of it
    uint64_t tick, content; // content: of the layout that was in force last
    int32_t map_id;
    aisle_cache_change change;
    int64_t hits, misses, kept, dropped, spoiled, repaired; // spoiled and repaired: among the misses
} aisle_cache;

void aisle_cache_carve(aisle_cache *self, aisle_arena *arena, const aisle_limits *limits);

#define AISLE_CACHE_PATH_MAX 60000U // bytes

typedef struct aisle_cache_found {
    size_t size;          // of the path
    double theta;         // rad, of its first waypoint
    const uint8_t *order; // [num_goals] in which it visits them: indices of the question's goals
    double worth;         // when it was planned, as of an answer
    aisle_proof_basis basis;
} aisle_cache_found;

// Looks the question up; the path is copied to bytes[AISLE_CACHE_PATH_MAX]. Returns the entry, AISLE_CACHE_NONE if there
// is none (a miss, counted).
uint32_t aisle_cache_find(aisle_cache *self, const aisle_cache_question *question, uint8_t *bytes,
                          aisle_cache_found *found);
// After a miss: the newest answer to the same question that may be repaired on its layout. It is of another one and not to
// be sent. Returns the entry, AISLE_CACHE_NONE if there is none; a spoiled one is dropped.
uint32_t aisle_cache_find_repairable(aisle_cache *self, const aisle_cache_question *question, uint8_t *bytes,
                                     aisle_cache_found *found);
// What find() gave was proved (a hit), on this basis from now on if not NULL; or it was not: it is dropped.
void aisle_cache_confirm(aisle_cache *self, uint32_t entry, const aisle_proof_basis *basis);
void aisle_cache_disprove(aisle_cache *self, uint32_t entry);

typedef struct aisle_cache_answer { // a proved path
    const uint8_t *bytes;           // of at most AISLE_CACHE_PATH_MAX
    size_t size;
    const aisle_path_msg *path;  // the same, decoded
    const aisle_goal_msg *goals; // the question's, in the order in which it visits them
    double value;                // what it is worth by the question's objective, as aisle_route_measure() has it
    double worth;                // the same, or of a repaired one what it was before all repairs
    aisle_proof_basis basis;
} aisle_cache_answer;

// Remembers an answer in place of what is remembered for the same question.
void aisle_cache_put(aisle_cache *self, const aisle_cache_question *question, const aisle_cache_answer *answer);

// The layout in force has changed: begins to take that in. layout, path and bytes[AISLE_CACHE_PATH_MAX] (scratch) stay in
// use until step() says AISLE_OK; no other call in between.
void aisle_cache_change_begin(aisle_cache *self, const aisle_layout *layout, aisle_path_msg *path, uint8_t *bytes);
// AISLE_BUSY, then AISLE_OK. A unit: 16 pieces or polygons looked at.
aisle_status aisle_cache_change_step(aisle_cache *self, uint32_t units);

// Least way (m) from a to b over a place of the box: E above. O(1).
double aisle_cache_detour(aisle_aabb box, aisle_vec2 a, aisle_vec2 b);

// Entries in use; for tests: false if blocks are lost or shared.
uint32_t aisle_cache_count(const aisle_cache *self);
bool aisle_cache_invariants_hold(const aisle_cache *self);
#endif
