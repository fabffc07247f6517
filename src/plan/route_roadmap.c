#include "base/check.h"
#include "plan/route_stages.h"

#include <math.h>

static bool is_plain(const aisle_route *self) {
    return self->request.options.objective == AISLE_OPTIONS_PAPER;
}

// Queries ask what is kept; a goal list leaves nothing.
static aisle_roadmap_keep *roadmap_of(aisle_route *self) {
    return self->request.is_query ? &self->keep : &self->sample.copy;
}

static aisle_roadmap_wish wish_of(const aisle_route *self) {
    const aisle_options_msg *options = &self->request.options;
    const aisle_vehicle_space *configurations = &self->sample.configurations;
    const uint32_t capacity = self->keep.map.capacity;
    uint32_t draws = is_plain(self) ? AISLE_ROUTE_ROADMAP_PLAIN : AISLE_ROUTE_ROADMAP_FIRST;
    draws = options->num_samples > 0 ? (uint32_t)options->num_samples : draws;
    return (aisle_roadmap_wish){.layout = self->layout,
                                .configurations = configurations,
                                .config = {.samples = draws < capacity ? draws : capacity,
                                           .seed = (uint64_t)(uint32_t)options->seed,
                                           .first = is_plain(self) ? 0U : AISLE_ROUTE_ROADMAP_BLOCK,
                                           .uniform = is_plain(self) ? 0U : draws,
                                           .eager = is_plain(self),
                                           .one_way = configurations->kind == AISLE_VEHICLE_SPACE_POSE ||
                                                      aisle_zones_any_directed(self->layout)}};
}

void aisle_route_begin_roadmap(aisle_route *self) {
    const aisle_roadmap_wish wish = wish_of(self);
    self->sample.phase = AISLE_ROUTE_SAMPLE_MAP;
    if (self->request.is_query) {
        aisle_roadmap_keep_begin(&self->keep, &wish);
    } else if (!aisle_roadmap_keep_serves(&self->sample.copy, &wish)) {
        aisle_roadmap_keep_begin_from(&self->sample.copy, &self->keep, &wish);
    }
}

// What of `units` this leg may still spend.
static uint32_t left_of(const aisle_route *self, uint32_t units) {
    const uint32_t left = self->sample.limit > self->spent ? self->sample.limit - self->spent : 0U;
    return units < left ? units : left;
}

aisle_status aisle_route_step_roadmap(aisle_route *self, uint32_t units) {
    aisle_route_sample *sample = &self->sample;
    aisle_roadmap_keep *keep = roadmap_of(self);
    const uint32_t left = left_of(self, units);
    if (left == 0U) {
        return aisle_route_no_sampled_way(self);
    }
    if (aisle_roadmap_keep_step(keep, &sample->configurations, left, &self->spent) == AISLE_OK) {
        const aisle_roadmap_search_kind kind = is_plain(self) ? AISLE_ROADMAP_DIJKSTRA : AISLE_ROADMAP_ASTAR;
        aisle_roadmap_ask(&sample->ask, &keep->map, kind, sample->start, sample->goal, &self->spent);
        sample->phase = AISLE_ROUTE_SAMPLE_ASK;
    }
    return AISLE_BUSY;
}

// The roadmap does not join the ends: more draws, where it may have them.
static aisle_status ask_more(aisle_route *self) {
    aisle_roadmap *map = &roadmap_of(self)->map;
    const uint32_t twice = map->count > map->capacity / 2U ? map->capacity : 2U * map->count;
    if (is_plain(self) || aisle_roadmap_grow(map, twice) != AISLE_OK) {
        return aisle_route_no_sampled_way(self);
    }
    self->sample.phase = AISLE_ROUTE_SAMPLE_MAP;
    return AISLE_BUSY;
}

aisle_status aisle_route_step_ask(aisle_route *self, uint32_t units) {
    aisle_route_sample *sample = &self->sample;
    const uint32_t left = left_of(self, units);
    if (left == 0U) {
        return aisle_route_no_sampled_way(self);
    }
    const aisle_status st = aisle_roadmap_search_step(&sample->ask, left, &self->spent);
    if (st == AISLE_BUSY) {
        return AISLE_BUSY;
    }
    self->nodes += sample->ask.expanded;
    if (st != AISLE_OK) {
        return ask_more(self);
    }
    sample->path_count = aisle_roadmap_way(&sample->ask, sample->way, sample->ask.capacity + 2U);
    return aisle_route_take_sampled_way(self);
}
