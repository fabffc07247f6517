#include "plan/why.h"

#include "base/check.h"

#include <math.h>

#define WINDOW 8U        // path cells looked at on either side of the narrowest one
#define ACROSS 40        // tries on either side of a cell
#define ACROSS_CELLS 2.0 // how far to either side, in cells

static void search_from(aisle_why *self, uint32_t open_from) {
    aisle_seed_start_width(self->seed, self->space, self->start, self->goal, self->stride, open_from);
}

void aisle_why_start(aisle_why *self, aisle_seed *seed, aisle_space *space, aisle_vec2 start, aisle_vec2 goal,
                     uint32_t stride) {
    *self = (aisle_why){.seed = seed, .space = space, .start = start, .goal = goal, .stride = stride};
    double reach = space->vehicle->inner_radius + space->vehicle->margin;
    aisle_seed_start_proof(seed, space, start, goal, reach);
    double cells = reach / space->grid->lattice.res + 2.0;
    self->hi = (uint32_t)aisle_min(cells * cells, (double)AISLE_FIELD_SQ_MAX);
}

// Largest exact gap of a point on the line across the path at p; where and to what.
static double best_across(const aisle_why *self, aisle_vec2 p, aisle_vec2 across, aisle_vec2 *at, int32_t *id) {
    double best = -1.0;
    double step = ACROSS_CELLS * self->space->grid->lattice.res / ACROSS;
    for (int k = -ACROSS; k <= ACROSS; k++) {
        aisle_vec2 q = aisle_vec2_add(p, aisle_vec2_scale(across, step * k));
        aisle_convex point = {&q, 1U, 0.0};
        int32_t near;
        double gap = aisle_layout_gap(self->space->layout, &point, AISLE_CLEARANCE_CAP, &near);
        if (gap > best) {
            best = gap;
            *at = q;
            *id = near;
        }
    }
    return best;
}

static uint32_t narrowest_cell(const aisle_seed *seed) {
    uint32_t best = 0;
    for (uint32_t i = 1; i < seed->cell_count; i++) {
        if (seed->space->grid->field[seed->cells[i]] < seed->space->grid->field[seed->cells[best]]) {
            best = i;
        }
    }
    return best;
}

static void measure_gap(aisle_why *self) {
    const aisle_seed *seed = self->seed;
    const aisle_lattice *lattice = &self->space->grid->lattice;
    uint32_t middle = narrowest_cell(seed);
    uint32_t first = middle > WINDOW ? middle - WINDOW : 0U;
    uint32_t last = middle + WINDOW < seed->cell_count ? middle + WINDOW : seed->cell_count - 1U;
    double least = AISLE_CLEARANCE_CAP;
    self->place = aisle_lattice_centre(lattice, seed->cells[middle]);
    for (uint32_t i = first; i <= last; i++) {
        uint32_t before = i > 2U ? i - 2U : 0U;
        uint32_t after = i + 2U < seed->cell_count ? i + 2U : seed->cell_count - 1U;
        aisle_vec2 a = aisle_lattice_centre(lattice, seed->cells[before]);
        aisle_vec2 b = aisle_lattice_centre(lattice, seed->cells[after]);
        double length = aisle_vec2_distance(a, b);
        aisle_vec2 along =
            length > 0.0 ? aisle_vec2_scale(aisle_vec2_sub(b, a), 1.0 / length) : aisle_vec2_of(1.0, 0.0);
        aisle_vec2 at = self->place;
        int32_t id = 0;
        double gap = best_across(self, aisle_lattice_centre(lattice, seed->cells[i]), aisle_vec2_of(-along.y, along.x),
                                 &at, &id);
        if (gap < least) {
            least = gap;
            self->place = at;
            self->id = id;
        }
    }
    self->width = 2.0 * least;
}

static void halve_doubt(aisle_why *self) {
    bool settled = self->hi - self->lo <= 1U || sqrt((double)self->hi) - sqrt((double)self->lo) < 0.5;
    self->stage = settled ? AISLE_WHY_WIDEST : AISLE_WHY_BISECT;
    search_from(self, settled ? self->lo : self->lo + (self->hi - self->lo) / 2U);
}

static aisle_status measure_widest(aisle_why *self) {
    aisle_seed *seed = self->seed;
    aisle_status st = aisle_seed_refusal_path(seed);
    if (st == AISLE_OK) {
        measure_gap(self);
    }
    return st;
}

// Takes the end of one search; starts the next one (AISLE_BUSY, AISLE_PARTIAL after the first) or ends.
static aisle_status next_search(aisle_why *self, bool found) {
    switch (self->stage) {
    case AISLE_WHY_PROVE:
        self->proved = !found;
        self->stage = AISLE_WHY_ANY;
        search_from(self, 1U);
        return AISLE_PARTIAL;
    case AISLE_WHY_ANY:
        if (!found && self->stride > 1U) {
            self->stride = 1U;
            search_from(self, 1U);
            return AISLE_BUSY;
        }
        self->connected = found;
        self->lo = 1U;
        break;
    case AISLE_WHY_BISECT:
        *(found ? &self->lo : &self->hi) = self->seed->open_from;
        break;
    default:
        return measure_widest(self);
    }
    if (!self->connected) {
        return AISLE_OK;
    }
    halve_doubt(self);
    return AISLE_BUSY;
}

aisle_status aisle_why_step(aisle_why *self, uint32_t units, uint32_t *spent) {
    aisle_status st = aisle_seed_step_refusal(self->seed, units, spent);
    if (st == AISLE_BUSY || st == AISLE_ERR_CAPACITY) {
        return st;
    }
    return next_search(self, st == AISLE_OK);
}
