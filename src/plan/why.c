#include "plan/why.h"

#include "base/check.h"
#include "world/layout_facing.h"

#include <math.h>

#define WINDOW 8U        // path cells looked at on either side of the narrowest one
#define ACROSS_CELLS 2.0 // how far to either side, in cells
#define ACROSS 16        // tries on either side of a cell, then as many again around the best
#define FACINGS 8        // tries at the two sides of the gap
#define FACING_UNITS 8U  // work units of one
#define FACING_SAME 1e-7 // m
#define ALONG 16         // places looked at to either side of the best cell, up to its neighbours

static void search_from(aisle_why *self, uint32_t open_from) {
    aisle_seed_start_width(self->seed, self->space, self->start, self->goal, self->stride, open_from);
}

void aisle_why_start(aisle_why *self, aisle_seed *seed, aisle_space *space, aisle_vec2 start, aisle_vec2 goal,
                     uint32_t stride) {
    *self = (aisle_why){.seed = seed, .space = space, .start = start, .goal = goal, .stride = stride};
    self->reach = space->vehicle->inner_radius + space->vehicle->margin;
    aisle_seed_start_proof(seed, space, start, goal, self->reach, 0);
    double cells = self->reach / space->grid->lattice.res + 2.0;
    self->hi = (uint32_t)aisle_min(cells * cells, (double)AISLE_FIELD_SQ_MAX);
}

typedef struct place {
    aisle_vec2 at;
    double gap; // m
    int32_t id; // of what is nearest
} place;

// The place of the largest exact gap among those `step` apart on a line about p.
static place widest_on_line(aisle_why *self, aisle_vec2 p, aisle_vec2 direction, double step) {
    place best = {.gap = -1.0};
    for (int k = -ACROSS; k <= ACROSS; k++) {
        place here = {.at = aisle_vec2_add(p, aisle_vec2_scale(direction, step * k))};
        aisle_convex point = {&here.at, 1U, 0.0};
        here.gap = aisle_layout_gap(self->space->layout, &point, AISLE_CLEARANCE_CAP, &here.id);
        best = here.gap > best.gap ? here : best;
    }
    self->seed->units += 2U * ACROSS + 1U;
    return best;
}

// Where a point on the way at p may pass with the largest gap, moved across the way.
static place best_across(aisle_why *self, aisle_vec2 p, aisle_vec2 along) {
    aisle_vec2 across = {-along.y, along.x};
    double step = ACROSS_CELLS * self->space->grid->lattice.res / ACROSS;
    place coarse = widest_on_line(self, p, across, step);
    return widest_on_line(self, coarse.at, across, step / ACROSS);
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

// Direction of the way about its cell i.
static aisle_vec2 direction_at(const aisle_seed *seed, uint32_t i) {
    const aisle_lattice *lattice = &seed->space->grid->lattice;
    aisle_vec2 a = aisle_lattice_centre(lattice, seed->cells[i > 2U ? i - 2U : 0U]);
    aisle_vec2 b =
        aisle_lattice_centre(lattice, seed->cells[i + 2U < seed->cell_count ? i + 2U : seed->cell_count - 1U]);
    double length = aisle_vec2_distance(a, b);
    return length > 0.0 ? aisle_vec2_scale(aisle_vec2_sub(b, a), 1.0 / length) : aisle_vec2_of(1.0, 0.0);
}

// Takes the two obstacles about *p, where nothing comes nearer to the middle between them, for the gap's sides; else
// moves *p to that middle. False: nothing lies across.
static bool face(aisle_why *self, aisle_vec2 *p) {
    const aisle_layout *layout = self->space->layout;
    aisle_piece a, b;
    self->seed->units += 3U * FACING_UNITS;
    if (!aisle_layout_piece_near(layout, *p, AISLE_CLEARANCE_CAP, aisle_vec2_of(0.0, 0.0), &a) || a.gap <= 0.0) {
        return false;
    }
    aisle_vec2 across = aisle_vec2_scale(aisle_vec2_sub(*p, a.nearest), 1.0 / a.gap);
    if (!aisle_layout_piece_near(layout, *p, 2.0 * AISLE_CLEARANCE_CAP, across, &b)) {
        return false;
    }
    aisle_vec2 on_a, on_b;
    double width = aisle_piece_gap(&a, &b, *p, &on_a, &on_b);
    *p = aisle_vec2_lerp(on_a, on_b, 0.5);
    aisle_convex middle = {p, 1U, 0.0};
    if (aisle_layout_gap(layout, &middle, 0.5 * width, NULL) < 0.5 * width - FACING_SAME) {
        return true;
    }
    self->place = *p;
    self->width = width;
    self->sides = 2U;
    self->id[0] = a.id;
    self->id[1] = b.id;
    self->side[0] = on_a;
    self->side[1] = on_b;
    return true;
}

static void measure_gap(aisle_why *self) {
    const aisle_seed *seed = self->seed;
    const aisle_lattice *lattice = &self->space->grid->lattice;
    uint32_t middle = narrowest_cell(seed);
    uint32_t first = middle > WINDOW ? middle - WINDOW : 0U;
    uint32_t last = middle + WINDOW < seed->cell_count ? middle + WINDOW : seed->cell_count - 1U;
    place least = {.at = aisle_lattice_centre(lattice, seed->cells[middle]), .gap = AISLE_CLEARANCE_CAP};
    for (uint32_t i = first; i <= last; i++) {
        place here = best_across(self, aisle_lattice_centre(lattice, seed->cells[i]), direction_at(seed, i));
        middle = here.gap < least.gap ? i : middle;
        least = here.gap < least.gap ? here : least;
    }
    aisle_vec2 centre = aisle_lattice_centre(lattice, seed->cells[middle]);
    aisle_vec2 along = direction_at(seed, middle);
    double step = (double)self->stride * lattice->res / ALONG;
    for (int k = -ALONG; k <= ALONG; k++) { // thin walls lie between the cells' centres
        place here = best_across(self, aisle_vec2_add(centre, aisle_vec2_scale(along, step * k)), along);
        least = here.gap < least.gap ? here : least;
    }
    self->place = least.at;
    self->sides = 1U;
    self->id[0] = least.id;
    self->side[0] = least.at;
    self->width = 2.0 * least.gap;
    for (int k = 0; k < FACINGS && self->sides < 2U && face(self, &least.at); k++) {
    }
}

static void halve_doubt(aisle_why *self) {
    if (self->hi - self->lo <= 1U || sqrt((double)self->hi) - sqrt((double)self->lo) < 0.5) {
        self->stage = AISLE_WHY_WIDEST;
        aisle_seed_start_widest(self->seed, self->space, self->start, self->goal, self->stride, self->lo);
        return;
    }
    self->stage = AISLE_WHY_BISECT;
    search_from(self, self->lo + (self->hi - self->lo) / 2U);
}

static aisle_status measure_widest(aisle_why *self) {
    aisle_seed *seed = self->seed;
    aisle_status st = aisle_seed_refusal_path(seed);
    if (st == AISLE_OK) {
        measure_gap(self);
    }
    return st;
}

static aisle_status begin_widths(aisle_why *self, bool proved) {
    self->proved = proved;
    self->stage = AISLE_WHY_ANY;
    search_from(self, 1U);
    return AISLE_PARTIAL;
}

// Takes the end of one search; starts the next one (AISLE_BUSY, AISLE_PARTIAL after the proof) or ends.
static aisle_status next_search(aisle_why *self, bool found) {
    switch (self->stage) {
    case AISLE_WHY_ROUGH:
        if (found) {
            self->stage = AISLE_WHY_PROVE;
            self->depth = AISLE_SPACE_DEPTH_MAX;
            aisle_seed_start_proof(self->seed, self->space, self->start, self->goal, self->reach,
                                   AISLE_SPACE_DEPTH_MAX);
            return AISLE_BUSY;
        }
        return begin_widths(self, true);
    case AISLE_WHY_PROVE:
        return begin_widths(self, !found);
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
    st = next_search(self, st == AISLE_OK);
    *spent += self->seed->units; // for measuring the gap
    self->seed->units = 0;
    return st;
}
