#include "plan/cache.h"

#include "base/check.h"
#include "base/crc32.h"
#include "base/digest.h"
#include "plan/objective.h"
#include "wire/codec.h"

#include <string.h>

// Of a key: 40 bytes a stop, 27 of the options, two counts, the vehicle.
#define KEY_MAX ((AISLE_QUERY_MAX_GOALS + 1U) * 40U + 27U + 2U + AISLE_VEHICLE_CONTENT_BYTES)
#define BLOCKS_MIN ((AISLE_CACHE_PATH_MAX + KEY_MAX) / AISLE_CACHE_BLOCK + 1U) // so that every path fits
#define TOUCH_SPARE 1e-3 // m, nearer than this to what is told is as near
#define DETOUR_SPARE 1e-3
#define REACH_SPARE 5e-3          // m, above all that a planner keeps beyond margin and creep clearance
#define GRAVITY_LEAST 9.8         // m/s2, not above the one that energy goes by
#define VALUE_NO_LENGTH 1048576.0 // from here on the safest path's worth counts risk before length
#define LOOKS_A_UNIT 16U

void aisle_cache_carve(aisle_cache *self, aisle_arena *arena, const aisle_limits *limits) {
    const uint32_t paths = limits->cached_paths;
    const uint32_t blocks = paths * (AISLE_CACHE_PATH_BYTES / (uint32_t)sizeof(aisle_cache_block));
    *self = (aisle_cache){.capacity = paths};
    self->entries = (aisle_cache_entry *)aisle_arena_take(arena, paths, sizeof(aisle_cache_entry));
    aisle_pool_carve(&self->blocks, arena, blocks > BLOCKS_MIN ? blocks : (uint32_t)BLOCKS_MIN,
                     (uint32_t)sizeof(aisle_cache_block));
    self->key = (uint8_t *)aisle_arena_take(arena, KEY_MAX, 1U);
}

// ---- bytes of an entry

static aisle_cache_block *block_at(const aisle_cache *self, uint32_t index) {
    return (aisle_cache_block *)aisle_pool_at(&self->blocks, index);
}

typedef struct cursor { // a place in an entry's bytes
    const aisle_cache *cache;
    aisle_cache_block *block;
    uint32_t at; // of it
} cursor;

static cursor cursor_at(const aisle_cache *self, uint32_t first) {
    return (cursor){self, block_at(self, first), 0};
}

// The next stretch of at most `size` bytes; goes past it.
static uint8_t *stretch(cursor *c, size_t size, size_t *length) {
    if (c->at == AISLE_CACHE_BLOCK) {
        c->block = block_at(c->cache, c->block->next);
        c->at = 0;
    }
    const size_t left = AISLE_CACHE_BLOCK - c->at;
    uint8_t *from = c->block->bytes + c->at;
    *length = size < left ? size : left;
    c->at += (uint32_t)*length;
    return from;
}

static void put_bytes(cursor *c, const uint8_t *bytes, size_t size) {
    size_t length;
    for (size_t at = 0; at < size; at += length) {
        uint8_t *to = stretch(c, size - at, &length);
        memcpy(to, bytes + at, length);
    }
}

static void get_bytes(cursor *c, uint8_t *bytes, size_t size) {
    size_t length;
    for (size_t at = 0; at < size; at += length) {
        const uint8_t *from = stretch(c, size - at, &length);
        memcpy(bytes + at, from, length);
    }
}

// Goes past them if they are the same.
static bool are_bytes(cursor *c, const uint8_t *bytes, size_t size) {
    size_t length;
    for (size_t at = 0; at < size; at += length) {
        const uint8_t *here = stretch(c, size - at, &length);
        if (memcmp(here, bytes + at, length) != 0) {
            return false;
        }
    }
    return true;
}

// ---- entries

static void drop(aisle_cache *self, aisle_cache_entry *entry) {
    for (uint32_t at = entry->first; at != AISLE_POOL_NONE;) {
        const uint32_t next = block_at(self, at)->next;
        aisle_pool_give(&self->blocks, at);
        at = next;
    }
    entry->in_use = false;
}

static aisle_cache_entry *least_recent(const aisle_cache *self) {
    aisle_cache_entry *least = NULL;
    for (uint32_t i = 0; i < self->capacity; i++) {
        aisle_cache_entry *entry = &self->entries[i];
        if (entry->in_use && (least == NULL || entry->used < least->used)) {
            least = entry;
        }
    }
    return least;
}

static uint32_t blocks_free(const aisle_cache *self) {
    return self->blocks.capacity - self->blocks.used;
}

// An entry that is not in use, with as many blocks free.
static aisle_cache_entry *make_room(aisle_cache *self, uint32_t blocks) {
    while (blocks_free(self) < blocks) {
        drop(self, least_recent(self));
    }
    for (uint32_t i = 0; i < self->capacity; i++) {
        if (!self->entries[i].in_use) {
            return &self->entries[i];
        }
    }
    aisle_cache_entry *entry = least_recent(self);
    drop(self, entry);
    return entry;
}

static uint32_t take_blocks(aisle_cache *self, uint32_t count) {
    uint32_t first = AISLE_POOL_NONE;
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t at = aisle_pool_take(&self->blocks);
        AISLE_ASSERT(at != AISLE_POOL_NONE);
        block_at(self, at)->next = first;
        first = at;
    }
    return first;
}

// ---- questions

static void add(aisle_cache *self, const void *bytes, size_t size) {
    AISLE_ASSERT(self->key_size + size <= KEY_MAX);
    memcpy(self->key + self->key_size, bytes, size);
    self->key_size += (uint32_t)size;
}

// Member by member: padding is no part of a question.
static void add_stop(aisle_cache *self, const aisle_goal_msg *stop) {
    const double place[3] = {stop->x, stop->y, stop->theta};
    const float rest[3] = {stop->tolerance_xy, stop->tolerance_theta, stop->dwell};
    add(self, &stop->id, sizeof stop->id);
    add(self, place, sizeof place);
    add(self, rest, sizeof rest);
}

static void add_options(aisle_cache *self, const aisle_options_msg *options) {
    const int8_t kinds[3] = {options->planner, options->objective, options->interpolation};
    const int32_t counts[3] = {options->num_samples, options->seed, options->work_units};
    const float numbers[3] = {options->risk_weight, options->step, options->zone};
    add(self, kinds, sizeof kinds);
    add(self, counts, sizeof counts);
    add(self, numbers, sizeof numbers);
}

static void make_key(aisle_cache *self, const aisle_cache_question *question) {
    const uint8_t first[2] = {(uint8_t)question->num_goals, (uint8_t)question->ordering};
    AISLE_ASSERT(question->num_goals <= AISLE_QUERY_MAX_GOALS);
    self->key_size = 0;
    add(self, first, sizeof first);
    add_options(self, question->options);
    add_stop(self, question->start);
    for (uint32_t i = 0; i < question->num_goals; i++) {
        add_stop(self, &question->goals[i]);
    }
    AISLE_ASSERT(self->key_size + AISLE_VEHICLE_CONTENT_BYTES <= KEY_MAX);
    self->key_size += (uint32_t)aisle_vehicle_content(question->vehicle, self->key + self->key_size);
    self->hash = aisle_digest(0, self->key, self->key_size);
}

static uint64_t digest_of_head(const aisle_cache_entry *entry, const uint8_t *path) {
    const uint64_t order = aisle_digest(0, entry->order, sizeof entry->order);
    return aisle_digest(order, path, AISLE_PATH_AT_WAYPOINTS);
}

static bool is_of(const aisle_cache_entry *entry, int32_t map_id, uint64_t content) {
    return entry->map_id == map_id && entry->content == content;
}

// Is it of that layout; to be repaired: may it be on that layout?
static bool serves(const aisle_cache_entry *entry, int32_t map_id, uint64_t content, bool to_repair) {
    return to_repair ? entry->can_repair && entry->map_id == map_id && entry->repair_content == content
                     : is_of(entry, map_id, content);
}

// The most recently used entry of the question in hand; its path is where *c stands.
static uint32_t look_up(const aisle_cache *self, const aisle_layout *layout, bool to_repair, cursor *c) {
    const int32_t map_id = aisle_layout_map_id(layout);
    const uint64_t content = aisle_layout_content(layout);
    uint32_t found = AISLE_CACHE_NONE;
    for (uint32_t i = 0; i < self->capacity; i++) {
        const aisle_cache_entry *entry = &self->entries[i];
        if (!entry->in_use || entry->hash != self->hash || entry->key_size != self->key_size ||
            !serves(entry, map_id, content, to_repair)) {
            continue;
        }
        cursor here = cursor_at(self, entry->first);
        const bool newer = found == AISLE_CACHE_NONE || entry->used > self->entries[found].used;
        if (newer && are_bytes(&here, self->key, self->key_size)) {
            found = i;
            *c = here;
        }
    }
    return found;
}

static aisle_cache_found found_in(const aisle_cache_entry *entry) {
    return (aisle_cache_found){entry->path_size, entry->theta, entry->order, entry->worth, entry->basis};
}

// Are these the bytes that were put in?
static bool is_as_put(const aisle_cache_entry *entry, const uint8_t *path) {
    return digest_of_head(entry, path) == entry->head &&
           aisle_crc32(0, path + AISLE_PATH_AT_WAYPOINTS, entry->path_size - AISLE_PATH_AT_WAYPOINTS) ==
               entry->basis.waypoints;
}

uint32_t aisle_cache_find(aisle_cache *self, const aisle_cache_question *question, uint8_t *bytes,
                          aisle_cache_found *found) {
    cursor c;
    make_key(self, question);
    const uint32_t at = look_up(self, question->layout, false, &c);
    if (at == AISLE_CACHE_NONE) {
        self->misses++;
        return AISLE_CACHE_NONE;
    }
    aisle_cache_entry *entry = &self->entries[at];
    get_bytes(&c, bytes, entry->path_size);
    if (digest_of_head(entry, bytes) != entry->head) {
        aisle_cache_disprove(self, at);
        return AISLE_CACHE_NONE;
    }
    if (!question->readonly) {
        entry->used = ++self->tick;
    }
    *found = found_in(entry);
    return at;
}

uint32_t aisle_cache_find_repairable(aisle_cache *self, const aisle_cache_question *question, uint8_t *bytes,
                                     aisle_cache_found *found) {
    cursor c;
    make_key(self, question);
    const uint32_t at = look_up(self, question->layout, true, &c);
    if (at == AISLE_CACHE_NONE) {
        return AISLE_CACHE_NONE;
    }
    aisle_cache_entry *entry = &self->entries[at];
    get_bytes(&c, bytes, entry->path_size);
    if (!is_as_put(entry, bytes)) {
        drop(self, entry);
        self->spoiled++;
        return AISLE_CACHE_NONE;
    }
    *found = found_in(entry);
    return at;
}

void aisle_cache_confirm(aisle_cache *self, uint32_t entry, const aisle_proof_basis *basis) {
    AISLE_ASSERT(entry < self->capacity && self->entries[entry].in_use);
    if (basis != NULL) {
        self->entries[entry].basis = *basis;
    }
    self->hits++;
}

void aisle_cache_disprove(aisle_cache *self, uint32_t entry) {
    AISLE_ASSERT(entry < self->capacity && self->entries[entry].in_use);
    drop(self, &self->entries[entry]);
    self->spoiled++;
    self->misses++;
}

// ---- worth

// s of standing at goals on the way; of goals in any order the longest stand may be the last, which is not on the way.
static double dwell_of(const aisle_cache_question *question) {
    const bool any_order = question->ordering == AISLE_GOAL_LIST_ANY_ORDER;
    double sum = 0.0;
    double most = 0.0;
    for (uint32_t i = 0; i < question->num_goals; i++) {
        double dwell = aisle_max((double)question->goals[i].dwell, 0.0);
        most = any_order ? aisle_max(most, dwell) : dwell;
        sum += dwell;
    }
    return sum - most;
}

// D of cache.h.
static double excess_of(const aisle_cache_question *question, const aisle_cache_answer *answer) {
    const aisle_vehicle *vehicle = question->vehicle;
    const double length = (double)answer->path->length;
    const double dwell = dwell_of(question), fastest = aisle_max(vehicle->v_max, vehicle->v_reverse_max);
    double metres = answer->value;
    switch (question->options->objective) {
    case AISLE_OPTIONS_SHORTEST:
        break;
    case AISLE_OPTIONS_SAFEST:
        if (!(metres < VALUE_NO_LENGTH)) {
            return -1.0;
        }
        break;
    case AISLE_OPTIONS_FASTEST:
        metres = (metres - dwell) * fastest;
        break;
    case AISLE_OPTIONS_LEAST_ENERGY:
        metres = (metres - dwell * vehicle->idle_power) /
                 (vehicle->mass * GRAVITY_LEAST * vehicle->rolling_resistance / vehicle->drive_efficiency +
                  vehicle->idle_power / fastest);
        break;
    default:
        return -1.0;
    }
    return aisle_max(metres - length, 0.0);
}

static bool is_same_stop(const aisle_goal_msg *a, const aisle_goal_msg *b) {
    return a->id == b->id && memcmp(&a->x, &b->x, 3U * sizeof(double)) == 0 &&
           memcmp(&a->tolerance_xy, &b->tolerance_xy, 3U * sizeof(float)) == 0;
}

// Which of the question's goals each of the path's is, each taken once.
static void note_order(aisle_cache_entry *entry, const aisle_cache_question *question,
                       const aisle_cache_answer *answer) {
    uint64_t taken = 0;
    for (uint32_t i = 0; i < question->num_goals; i++) {
        uint32_t at = 0;
        while (at < question->num_goals &&
               ((taken >> at & 1U) != 0U || !is_same_stop(&answer->goals[i], &question->goals[at]))) {
            at++;
        }
        AISLE_ASSERT(at < question->num_goals);
        taken |= (uint64_t)1U << at;
        entry->order[i] = (uint8_t)at;
    }
}

void aisle_cache_put(aisle_cache *self, const aisle_cache_question *question, const aisle_cache_answer *answer) {
    const aisle_vehicle *vehicle = question->vehicle;
    make_key(self, question);
    const uint32_t size = (uint32_t)answer->size;
    const uint32_t blocks = (self->key_size + size + AISLE_CACHE_BLOCK - 1U) / AISLE_CACHE_BLOCK;
    AISLE_ASSERT(size >= AISLE_PATH_AT_WAYPOINTS && size <= AISLE_CACHE_PATH_MAX && blocks <= self->blocks.capacity);
    cursor c;
    const uint32_t old = look_up(self, question->layout, false, &c);
    if (old != AISLE_CACHE_NONE) {
        drop(self, &self->entries[old]);
    }
    aisle_cache_entry *entry = make_room(self, blocks);
    *entry = (aisle_cache_entry){.in_use = true,
                                 .any_order = question->ordering == AISLE_GOAL_LIST_ANY_ORDER,
                                 .map_id = aisle_layout_map_id(question->layout),
                                 .content = aisle_layout_content(question->layout),
                                 .used = ++self->tick,
                                 .hash = self->hash,
                                 .first = take_blocks(self, blocks),
                                 .key_size = self->key_size,
                                 .path_size = size,
                                 .basis = answer->basis,
                                 .theta = answer->path->waypoints[0].theta,
                                 .reach = aisle_max(vehicle->creep_clearance, vehicle->margin) + REACH_SPARE,
                                 .radius = vehicle->outer_radius,
                                 .excess = excess_of(question, answer),
                                 .worth = answer->worth};
    note_order(entry, question, answer);
    entry->head = digest_of_head(entry, answer->bytes);
    c = cursor_at(self, entry->first);
    put_bytes(&c, self->key, self->key_size);
    put_bytes(&c, answer->bytes, size);
}

// ---- a changed layout

void aisle_cache_change_begin(aisle_cache *self, const aisle_layout *layout, aisle_path_msg *path, uint8_t *bytes) {
    self->change = (aisle_cache_change){.layout = layout,
                                        .diff = aisle_layout_changes(layout),
                                        .path = path,
                                        .bytes = bytes,
                                        .content = aisle_layout_content(layout),
                                        .map_id = aisle_layout_map_id(layout)};
}

// Where a piece may run: its chord's box, grown by the arc's height, (c / 2) tan(phi / 2) <= (c / 2) sin(phi).
static aisle_aabb piece_box(const aisle_waypoint_msg *from, const aisle_waypoint_msg *to) {
    const double half = 0.5 * aisle_vec2_distance(aisle_vec2_of(from->x, from->y), aisle_vec2_of(to->x, to->y));
    const double sine = aisle_min(fabs((double)to->curvature) * half, 1.0);
    const aisle_aabb chord = {{aisle_min(from->x, to->x), aisle_min(from->y, to->y)},
                              {aisle_max(from->x, to->x), aisle_max(from->y, to->y)}};
    return aisle_aabb_grow(chord, half * sine);
}

// Does a polygon that came or left matter to the piece that ends at waypoint `at`?
static bool is_piece_touched(const aisle_cache *self, const aisle_cache_entry *entry, uint32_t at) {
    const aisle_cache_change *change = &self->change;
    const aisle_waypoint_msg *to = &change->path->waypoints[at];
    const double near = entry->radius + aisle_max(entry->reach, (double)to->clearance) + TOUCH_SPARE;
    const aisle_aabb box = aisle_aabb_grow(piece_box(at > 0U ? to - 1 : to, to), near);
    for (uint32_t i = 0; i < change->diff->count; i++) {
        if (aisle_aabb_overlap(change->diff->change[i].box, box)) {
            return true;
        }
    }
    return false;
}

// Least |a - p| + |p - b| for p on the line y = 0 within [lo, hi]: where the straight way from a to b, one of them
// mirrored to the other side, crosses; the sum is convex, so the nearer end does where that is outside.
static double detour_by_edge(aisle_vec2 a, aisle_vec2 b, double lo, double hi) {
    const double up = fabs(a.y), down = fabs(b.y), sum = up + down;
    const double cross = sum > 0.0 ? a.x + (b.x - a.x) * (up / sum) : a.x;
    const aisle_vec2 p = aisle_vec2_of(aisle_clamp(cross, lo, hi), 0.0);
    return aisle_vec2_distance(a, p) + aisle_vec2_distance(p, b);
}

double aisle_cache_detour(aisle_aabb box, aisle_vec2 a, aisle_vec2 b) {
    if (aisle_aabb_meets(box, a, b)) {
        return aisle_vec2_distance(a, b);
    }
    double least =
        detour_by_edge(aisle_vec2_of(a.x, a.y - box.lo.y), aisle_vec2_of(b.x, b.y - box.lo.y), box.lo.x, box.hi.x);
    least = aisle_min(least, detour_by_edge(aisle_vec2_of(a.x, a.y - box.hi.y), aisle_vec2_of(b.x, b.y - box.hi.y),
                                            box.lo.x, box.hi.x));
    least = aisle_min(least, detour_by_edge(aisle_vec2_of(a.y, a.x - box.lo.x), aisle_vec2_of(b.y, b.x - box.lo.x),
                                            box.lo.y, box.hi.y));
    return aisle_min(least, detour_by_edge(aisle_vec2_of(a.y, a.x - box.hi.x), aisle_vec2_of(b.y, b.x - box.hi.x),
                                           box.lo.y, box.hi.y));
}

// Does something that left open a way from waypoint `from` to waypoint `to` that may be better than `length`?
static bool is_way_opened(const aisle_cache *self, const aisle_cache_entry *entry, uint32_t from, uint32_t to,
                          double length) {
    const aisle_cache_change *change = &self->change;
    const aisle_waypoint_msg *a = &change->path->waypoints[from], *b = &change->path->waypoints[to];
    for (uint32_t i = 0; i < change->diff->count; i++) {
        const aisle_layout_change *polygon = &change->diff->change[i];
        const aisle_aabb opened = aisle_aabb_grow(polygon->box, entry->radius + entry->reach);
        if (!polygon->is_added &&
            (entry->excess < 0.0 || aisle_cache_detour(opened, aisle_vec2_of(a->x, a->y), aisle_vec2_of(b->x, b->y)) <
                                        length + entry->excess - DETOUR_SPARE)) {
            return true;
        }
    }
    return false;
}

// Looks at the piece that ends at change.at. True: the path can neither stay nor be repaired.
static bool is_lost(aisle_cache *self, const aisle_cache_entry *entry) {
    aisle_cache_change *change = &self->change;
    const aisle_waypoint_msg *w = change->path->waypoints;
    change->touched = change->touched || is_piece_touched(self, entry, change->at);
    if ((w[change->at].flags & AISLE_WAYPOINT_GOAL) == 0) {
        return false;
    }
    const uint32_t from = change->leg_start;
    change->leg_start = change->at;
    return entry->any_order ? is_way_opened(self, entry, 0, change->at, (double)change->path->length)
                            : is_way_opened(self, entry, from, change->at, (double)w[change->at].s - (double)w[from].s);
}

// The entry in hand is of the layout there was: takes its path in hand. False: it is spoiled.
static bool load(aisle_cache *self, const aisle_cache_entry *entry) {
    aisle_cache_change *change = &self->change;
    cursor c = cursor_at(self, entry->first);
    for (size_t left = entry->key_size, length; left > 0; left -= length) {
        (void)stretch(&c, left, &length);
    }
    get_bytes(&c, change->bytes, entry->path_size);
    change->at = change->leg_start = 0;
    change->touched = false;
    change->loaded = is_as_put(entry, change->bytes) &&
                     aisle_msg_decode(AISLE_MSG_PATH, change->bytes, entry->path_size, change->path, NULL) == AISLE_OK;
    return change->loaded;
}

static void next_entry(aisle_cache *self) {
    self->change.entry++;
    self->change.loaded = false;
}

static void keep(aisle_cache *self, aisle_cache_entry *entry) {
    entry->content = self->change.content;
    entry->can_repair = false;
    self->kept++;
    next_entry(self);
}

// It stays with its layout. One that was in force counts.
static void leave(aisle_cache *self, aisle_cache_entry *entry, bool can_repair) {
    self->dropped += is_of(entry, self->map_id, self->content) ? 1 : 0;
    entry->can_repair = can_repair;
    entry->repair_content = self->change.content;
    next_entry(self);
}

// Returns the looks it took.
static uint32_t step_entry(aisle_cache *self) {
    aisle_cache_change *change = &self->change;
    aisle_cache_entry *entry = &self->entries[change->entry];
    const bool is_now = is_of(entry, self->map_id, self->content);
    if (!entry->in_use || !(is_now || serves(entry, self->map_id, self->content, true))) {
        next_entry(self);
        return 1;
    }
    if (change->map_id == self->map_id && change->content == self->content) { // the same said again
        if (is_now) {
            keep(self, entry);
        } else {
            next_entry(self);
        }
        return 1;
    }
    if (change->diff->everything) {
        leave(self, entry, false);
        return 1;
    }
    if (!change->loaded) {
        if (!load(self, entry)) {
            drop(self, entry);
            self->spoiled++;
            next_entry(self);
        }
        return 1U + entry->path_size / LOOKS_A_UNIT;
    }
    if (is_lost(self, entry)) {
        leave(self, entry, false);
    } else if (++change->at == (uint32_t)change->path->num_waypoints) {
        if (is_now && !change->touched) {
            keep(self, entry);
        } else {
            leave(self, entry, true);
        }
    }
    return 1U + change->diff->count;
}

aisle_status aisle_cache_change_step(aisle_cache *self, uint32_t units) {
    aisle_cache_change *change = &self->change;
    uint64_t left = (uint64_t)units * LOOKS_A_UNIT;
    while (change->entry < self->capacity && left > 0) {
        const uint32_t looks = step_entry(self);
        left = left > looks ? left - looks : 0;
    }
    if (change->entry < self->capacity) {
        return AISLE_BUSY;
    }
    self->content = change->content;
    self->map_id = change->map_id;
    return AISLE_OK;
}

// ---- for tests

uint32_t aisle_cache_count(const aisle_cache *self) {
    uint32_t count = 0;
    for (uint32_t i = 0; i < self->capacity; i++) {
        count += self->entries[i].in_use ? 1U : 0U;
    }
    return count;
}

bool aisle_cache_invariants_hold(const aisle_cache *self) {
    uint32_t blocks = 0;
    for (uint32_t i = 0; i < self->capacity; i++) {
        const aisle_cache_entry *entry = &self->entries[i];
        uint32_t length = 0;
        for (uint32_t at = entry->first; entry->in_use && at != AISLE_POOL_NONE; at = block_at(self, at)->next) {
            if (++length > self->blocks.capacity) {
                return false;
            }
        }
        blocks += length;
        if (entry->in_use && (length - 1U) * AISLE_CACHE_BLOCK >= entry->key_size + entry->path_size) {
            return false;
        }
    }
    return blocks == self->blocks.used && aisle_pool_invariants_hold(&self->blocks);
}
