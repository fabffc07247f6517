#include "plan/roadmap_keep.h"

#include "base/check.h"
#include "base/digest.h"
#include "plan/cache.h"
#include "plan/zones.h"

#include <string.h>

#define SPARE 5e-3 // m, more than any test of a motion looks beyond what the body keeps

void aisle_roadmap_keep_carve(aisle_roadmap_keep *self, aisle_arena *arena, uint32_t draws) {
    *self = (aisle_roadmap_keep){.is_begun = false};
    aisle_roadmap_carve(&self->map, arena, AISLE_ROADMAP_KEEP_DIM, draws, AISLE_ROADMAP_KEEP_K);
}

// ---- changes

static bool matters(int8_t kind) {
    return kind == AISLE_POLYGON_OBSTACLE || kind == AISLE_POLYGON_KEEPOUT || kind == AISLE_POLYGON_DIRECTED;
}

// False: there are too many.
static bool add_changes(aisle_roadmap_changes *self, const aisle_layout_diff *diff) {
    for (uint32_t i = 0; i < diff->count; i++) {
        if (matters(diff->change[i].kind)) {
            if (self->count == AISLE_ROADMAP_KEEP_CHANGES) {
                return false;
            }
            self->box[self->count++] = diff->change[i].box;
        }
    }
    return true;
}

void aisle_roadmap_keep_note(aisle_roadmap_keep *self, const aisle_layout *layout) {
    const uint64_t content = aisle_layout_content(layout);
    const int32_t map_id = aisle_layout_map_id(layout);
    const bool is_news = content != self->now || map_id != self->map_id_now;
    self->now = content;
    self->map_id_now = map_id;
    if (!self->is_begun || !is_news) {
        return;
    }
    if (self->is_repairing) { // half way from one layout to another
        self->is_begun = false;
    } else if (content == self->content && map_id == self->map_id) {
        self->changes.count = 0;
        self->is_lost = false;
    } else {
        const aisle_layout_diff *diff = aisle_layout_changes(layout);
        self->is_lost = self->is_lost || diff->everything || self->map.phase != AISLE_ROADMAP_READY ||
                        !add_changes(&self->changes, diff);
    }
}

static bool is_line_touched(aisle_aabb box, aisle_pose2 from, aisle_pose2 to) {
    return aisle_aabb_meets(box, aisle_vec2_of(from.x, from.y), aisle_vec2_of(to.x, to.y));
}

// Do the moves from a to b, or may the arcs among them, lead through the box? On an arc everything is nearer to one of its
// ends than half its length.
static bool are_moves_touched(const aisle_vehicle_space *configurations, aisle_aabb box, const double *a,
                              const double *b) {
    aisle_move moves[AISLE_REEDS_SHEPP_MOVES];
    const uint32_t count = aisle_vehicle_space_moves(configurations, a, b, moves);
    aisle_pose2 from = aisle_vehicle_space_pose(configurations, a);
    for (uint32_t i = 0; i < count; i++) {
        const aisle_pose2 to = aisle_move_end(from, moves[i]);
        const double stray = fabs(moves[i].turn) > 0.0 ? 0.5 * fabs(moves[i].length) : 0.0;
        if (is_line_touched(aisle_aabb_grow(box, stray), from, to)) {
            return true;
        }
        from = to;
    }
    return count == 0U && is_line_touched(box, from, from);
}

static bool is_motion_touched(const aisle_vehicle_space *configurations, aisle_aabb box, const double *a,
                              const double *b) {
    const aisle_vec2 from = {a[0], a[1]}, to = {b[0], b[1]};
    if (configurations->kind == AISLE_VEHICLE_SPACE_PLACE) {
        return aisle_aabb_meets(box, from, to);
    }
    const double longest = aisle_vehicle_space_longest(configurations, aisle_vec2_distance(from, to));
    return aisle_cache_detour(box, from, to) <= longest &&
           (are_moves_touched(configurations, box, a, b) || are_moves_touched(configurations, box, b, a));
}

bool aisle_roadmap_keep_touches(void *context, const double *a, const double *b) {
    const aisle_roadmap_changes *self = (const aisle_roadmap_changes *)context;
    double stray = 0.0; // of a motion from the box of its ends, at most: the lesser half axis of the ellipse about them
    if (self->configurations->kind == AISLE_VEHICLE_SPACE_POSE) {
        const double apart = aisle_vec2_distance(aisle_vec2_of(a[0], a[1]), aisle_vec2_of(b[0], b[1]));
        const double longest = aisle_vehicle_space_longest(self->configurations, apart);
        stray = 0.5 * sqrt((longest - apart) * (longest + apart));
    }
    const aisle_aabb ends = {{aisle_min(a[0], b[0]) - stray, aisle_min(a[1], b[1]) - stray},
                             {aisle_max(a[0], b[0]) + stray, aisle_max(a[1], b[1]) + stray}};
    for (uint32_t i = 0; i < self->count; i++) {
        if (aisle_aabb_overlap(self->box[i], ends) && is_motion_touched(self->configurations, self->box[i], a, b)) {
            return true;
        }
    }
    return false;
}

// ---- what is kept

// All that motions, draws and their order hang on but for the layout.
static uint64_t key_of(const aisle_roadmap_wish *wish) {
    const aisle_vehicle_space *configurations = wish->configurations;
    const aisle_vehicle *vehicle = configurations->space->vehicle;
    const double numbers[5] = {vehicle->radius, vehicle->margin, vehicle->curvature_max, vehicle->outer_radius,
                               configurations->space->zone_room};
    const uint64_t words[6] = {vehicle->n,           (uint64_t)configurations->kind,
                               wish->config.samples, wish->config.seed,
                               wish->config.eager,   wish->config.one_way};
    uint64_t digest = aisle_digest(0, numbers, sizeof numbers);
    digest = aisle_digest(digest, words, sizeof words);
    return aisle_digest(digest, vehicle->footprint, vehicle->n * sizeof vehicle->footprint[0]);
}

bool aisle_roadmap_keep_serves(const aisle_roadmap_keep *self, const aisle_roadmap_wish *wish) {
    return self->is_begun && !self->is_lost && self->key == key_of(wish);
}

void aisle_roadmap_keep_begin(aisle_roadmap_keep *self, const aisle_roadmap_wish *wish) {
    if (aisle_roadmap_keep_serves(self, wish)) {
        return;
    }
    const aisle_status st = aisle_roadmap_start(&self->map, &wish->configurations->cspace, &wish->config);
    AISLE_ASSERT(st == AISLE_OK);
    self->begun++;
    self->is_begun = true;
    self->is_lost = self->is_repairing = false;
    self->key = key_of(wish);
    self->changes.count = 0;
    self->content = self->now = aisle_layout_content(wish->layout);
    self->map_id = self->map_id_now = aisle_layout_map_id(wish->layout);
}

void aisle_roadmap_keep_begin_from(aisle_roadmap_keep *self, const aisle_roadmap_keep *other,
                                   const aisle_roadmap_wish *wish) {
    const bool is_whole = other->map.phase == AISLE_ROADMAP_READY && !other->is_repairing;
    if (!is_whole || !aisle_roadmap_keep_serves(other, wish)) {
        aisle_roadmap_keep_begin(self, wish);
        return;
    }
    aisle_roadmap_copy(&self->map, &other->map, &wish->configurations->cspace);
    self->is_begun = true;
    self->is_lost = self->is_repairing = false;
    self->key = other->key;
    self->changes = other->changes;
    self->content = other->content;
    self->now = other->now;
    self->map_id = other->map_id;
    self->map_id_now = other->map_id_now;
}

// From here on the boxes are those that no origin may come into for a motion to be as it was.
static void begin_changes(aisle_roadmap_changes *self, const aisle_vehicle_space *configurations) {
    const aisle_vehicle *vehicle = configurations->space->vehicle;
    const double reach = vehicle->outer_radius + vehicle->margin + AISLE_ZONES_ROOM + SPARE;
    self->configurations = configurations;
    for (uint32_t i = 0; i < self->count; i++) {
        self->box[i] = aisle_aabb_grow(self->box[i], reach);
    }
}

aisle_status aisle_roadmap_keep_step(aisle_roadmap_keep *self, const aisle_vehicle_space *configurations,
                                     uint32_t units, uint32_t *spent) {
    const aisle_status st = aisle_roadmap_step(&self->map, units, spent);
    if (st != AISLE_OK) {
        return st;
    }
    if (!self->is_repairing && self->changes.count > 0U) {
        begin_changes(&self->changes, configurations);
        self->is_repairing = true;
        self->repairs++;
        aisle_roadmap_repair(&self->map, aisle_roadmap_keep_touches, &self->changes);
        return AISLE_BUSY;
    }
    self->is_repairing = false;
    self->changes.count = 0;
    self->content = self->now;
    self->map_id = self->map_id_now;
    return AISLE_OK;
}
