#include "plan/one_way.h"

#include "base/angle.h"
#include "base/check.h"

#include <float.h>
#include <math.h>

#define BATCH 3U // nodes: their inlet may spend a thousand units
#define DEPTH 3U // halvings of a cell, see seed.h

typedef enum overlap { APART, PARTLY, WHOLLY } overlap;

// The square of side 2 * half about c, and a convex outline. PARTLY may be APART in truth, near a corner.
static overlap overlap_of(const aisle_convex *outline, aisle_vec2 c, double half) {
    overlap found = WHOLLY;
    for (uint32_t i = 0; i < outline->n; i++) {
        const aisle_vec2 v = outline->v[i];
        const aisle_vec2 edge = aisle_vec2_sub(outline->v[i + 1U < outline->n ? i + 1U : 0U], v);
        const double at = aisle_vec2_cross(edge, aisle_vec2_sub(c, v)); // inside: above 0
        const double reach = half * (fabs(edge.x) + fabs(edge.y));      // of the square's corners
        if (at < -reach) {
            return APART;
        }
        found = at > reach ? found : PARTLY;
    }
    return found;
}

static double along(const aisle_one_way_zone *zone, aisle_vec2 p) {
    return aisle_vec2_dot(zone->along, p);
}

static bool overlaps(aisle_aabb box, aisle_vec2 c, double half) {
    return box.lo.x <= c.x + half && box.hi.x >= c.x - half && box.lo.y <= c.y + half && box.hi.y >= c.y - half;
}

// Is the cell open to the zone? One with a part of its border is, and may be where it is come into.
static bool passes(const aisle_one_way *self, aisle_one_way_zone *zone, aisle_vec2 c, double half) {
    const aisle_layout *layout = self->space->layout;
    const aisle_zone *polygon = aisle_layout_zone(layout, zone->index);
    if (!overlaps(polygon->box, c, half)) {
        return true;
    }
    const aisle_convex outline = aisle_layout_zone_shape(layout, polygon);
    const double reach = half * (fabs(zone->along.x) + fabs(zone->along.y)) + 1e-9;
    switch (overlap_of(&outline, c, half)) {
    case APART:
        return true;
    case PARTLY:
        zone->least_next = aisle_min(zone->least_next, along(zone, c) - reach);
        return true;
    case WHOLLY:
        break;
    }
    return along(zone, c) + reach >= zone->least;
}

static bool all_pass(aisle_one_way *self, uint32_t cell) {
    const aisle_lattice *lattice = &self->space->grid->lattice;
    const aisle_vec2 c = aisle_lattice_centre(lattice, cell);
    bool open = true;
    for (uint32_t i = 0; i < self->count; i++) { // each one, for it may be come into
        open = passes(self, &self->zone[i], c, 0.5 * lattice->res) && open;
    }
    return open;
}

static uint32_t enter(void *ctx, uint32_t from, uint32_t to, uint8_t dir) {
    aisle_one_way *self = (aisle_one_way *)ctx;
    (void)from;
    (void)dir;
    if (!aisle_space_cell_holds(self->space, to, self->reach, DEPTH, &self->seed->units)) {
        return AISLE_ASTAR_BARRED_CELL;
    }
    return all_pass(self, to) ? AISLE_ASTAR_FACTOR_ONE : AISLE_ASTAR_BARRED_CELL;
}

static void begin_flood(aisle_one_way *self) {
    const aisle_lattice *lattice = &self->space->grid->lattice;
    const aisle_astar_config cfg = {
        .enter = enter, .ctx = self, .w = lattice->w, .h = lattice->h, .start = self->start, .goal = self->goal};
    self->floods++;
    (void)all_pass(self, self->start);
    aisle_status st = aisle_astar_start(&self->seed->search, &cfg);
    AISLE_ASSERT(st == AISLE_OK);
}

static void take_zones(aisle_one_way *self, aisle_vec2 start) {
    const aisle_layout *layout = self->space->layout;
    for (uint32_t i = 0; i < aisle_layout_zone_count(layout) && self->count < AISLE_ONE_WAY_ZONES; i++) {
        const aisle_zone *polygon = aisle_layout_zone(layout, i);
        if (polygon->kind != AISLE_POLYGON_DIRECTED) {
            continue;
        }
        aisle_one_way_zone *zone = &self->zone[self->count++];
        double sine, cosine;
        aisle_sincos((double)polygon->direction, &sine, &cosine);
        *zone = (aisle_one_way_zone){.index = i, .along = {cosine, sine}, .least = DBL_MAX};
        const aisle_convex outline = aisle_layout_zone_shape(layout, polygon);
        if (overlap_of(&outline, start, 0.0) != APART) {
            zone->least = along(zone, start) - 1e-9;
        }
        zone->least_next = zone->least;
    }
}

void aisle_one_way_start(aisle_one_way *self, aisle_seed *seed, aisle_space *space, aisle_vec2 start, aisle_vec2 goal,
                         double reach) {
    bool inside;
    self->seed = seed;
    self->space = space;
    self->reach = reach;
    self->count = self->floods = 0;
    self->start = aisle_lattice_cell(&space->grid->lattice, start, &inside);
    self->goal = aisle_lattice_cell(&space->grid->lattice, goal, &inside);
    take_zones(self, start);
    aisle_space_forget(space);
    begin_flood(self);
}

// A flood has ended without the goal. Did it find lower places to come in?
static aisle_status next_flood(aisle_one_way *self) {
    bool is_lower = false;
    for (uint32_t i = 0; i < self->count; i++) {
        is_lower = is_lower || self->zone[i].least_next < self->zone[i].least;
        self->zone[i].least = self->zone[i].least_next;
    }
    if (!is_lower) {
        return AISLE_OK;
    }
    if (self->floods == AISLE_ONE_WAY_FLOODS) {
        return AISLE_PARTIAL;
    }
    begin_flood(self);
    return AISLE_BUSY;
}

aisle_status aisle_one_way_step(aisle_one_way *self, uint32_t units, uint32_t *spent) {
    aisle_astar *search = &self->seed->search;
    aisle_status st = AISLE_BUSY;
    self->seed->units = 0;
    while (st == AISLE_BUSY && self->seed->units < units) {
        const uint32_t before = search->expanded;
        const aisle_status found = aisle_astar_step(search, BATCH);
        self->seed->units += search->expanded - before + 1U;
        if (found == AISLE_OK || found == AISLE_ERR_CAPACITY) {
            st = AISLE_PARTIAL;
        } else if (found == AISLE_PARTIAL) {
            st = next_flood(self);
        }
    }
    *spent += self->seed->units;
    self->seed->units = 0;
    return st;
}
