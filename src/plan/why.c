#include "plan/why.h"

#include "base/check.h"
#include "world/layout_facing.h"

#include <math.h>

#define WINDOW 8U        // path cells looked at on either side of the narrowest one
#define ACROSS_CELLS 2.0 // how far to either side, in cells
#define ACROSS 16        // tries on either side of a cell, then as many again around the best
#define FACINGS 8        // tries at the two sides of a gap
#define FACING_UNITS 8U  // work units of one
#define FACING_SAME 1e-7 // m
#define GAP_CELLS 2.5    // search cells from the way that a gap's middle may lie
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

static double step_of(const aisle_why *self) {
    return (double)self->stride * self->space->grid->lattice.res;
}

// Finds the two obstacles about *p, nothing nearer to the middle between them than they are; moves *p to that middle.
// False: nothing lies across, or nothing near enough.
static bool face(aisle_why *self, aisle_vec2 *p, double around, aisle_gap *gap) {
    const aisle_layout *layout = self->space->layout;
    aisle_piece a, b;
    self->seed->units += FACING_UNITS;
    double upper = aisle_min(aisle_grid_gap_upper(self->space->grid, *p), AISLE_CLEARANCE_CAP);
    if (!aisle_layout_piece_near(layout, *p, upper, aisle_vec2_of(0.0, 0.0), &a) || a.gap <= 0.0) {
        return false;
    }
    aisle_vec2 across = aisle_vec2_scale(aisle_vec2_sub(*p, a.nearest), 1.0 / a.gap);
    if (!aisle_layout_piece_near(layout, *p, a.gap + 2.0 * around, across, &b)) {
        return false;
    }
    aisle_vec2 on_a, on_b;
    double width = aisle_piece_gap(&a, &b, *p, &on_a, &on_b);
    *p = aisle_vec2_lerp(on_a, on_b, 0.5);
    aisle_convex middle = {p, 1U, 0.0};
    gap->sides = 0U;
    if (aisle_layout_gap(layout, &middle, 0.5 * width, NULL) >= 0.5 * width - FACING_SAME) {
        *gap = (aisle_gap){width, *p, 2U, {a.id, b.id}, {on_a, on_b}};
    }
    return true;
}

// The gap within some cells of p, where two obstacles form one.
static bool gap_near(aisle_why *self, aisle_vec2 p, aisle_gap *gap) {
    double around = GAP_CELLS * step_of(self);
    aisle_vec2 at = p;
    gap->sides = 0U;
    for (int k = 0; k < FACINGS && gap->sides == 0U; k++) {
        if (!face(self, &at, around, gap) || aisle_vec2_distance(at, p) > around) {
            return false;
        }
    }
    return gap->sides == 2U;
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
    if (!gap_near(self, least.at, &self->way)) {
        self->way = (aisle_gap){2.0 * least.gap, least.at, 1U, {least.id, 0}, {least.at, least.at}};
    }
}

// The way for the field value, past the gaps measured already.
static void search_widest(aisle_why *self, uint32_t open_from) {
    self->stage = AISLE_WHY_WIDEST;
    aisle_seed_start_widest(self->seed, self->space, self->start, self->goal, self->stride, open_from);
    self->seed->bars = self->bars;
    self->seed->bar_count = self->bar_count;
}

static void halve_doubt(aisle_why *self) {
    if (self->hi <= self->lo + 1U || sqrt((double)self->hi) - sqrt((double)self->lo) < 0.5) {
        search_widest(self, self->lo);
        return;
    }
    self->stage = AISLE_WHY_BISECT;
    search_from(self, self->lo + (self->hi - self->lo) / 2U);
}

static aisle_status begin_measure(aisle_why *self) {
    const aisle_seed *seed = self->seed;
    aisle_status st = aisle_seed_refusal_path(self->seed);
    if (st != AISLE_OK) {
        return st;
    }
    self->stage = AISLE_WHY_MEASURE;
    self->at = 0;
    self->way.sides = 0U;
    // The cell next to a gap's middle has a field value no higher than this.
    double least = sqrt((double)self->space->grid->field[seed->cells[narrowest_cell(seed)]]);
    double most = least + 0.71 * (double)self->stride + 1.5;
    self->narrow_to = (uint32_t)(most * most);
    return AISLE_BUSY;
}

// Does the way pass through the gap, near the cell under way, and not beside it?
static bool is_crossed(const aisle_why *self, const aisle_gap *gap) {
    const aisle_seed *seed = self->seed;
    const aisle_lattice *lattice = &self->space->grid->lattice;
    uint32_t first = self->at > WINDOW ? self->at - WINDOW : 0U;
    uint32_t last = self->at + WINDOW < seed->cell_count ? self->at + WINDOW : seed->cell_count - 1U;
    for (uint32_t i = first; i < last; i++) {
        aisle_vec2 a = aisle_lattice_centre(lattice, seed->cells[i]);
        aisle_vec2 b = aisle_lattice_centre(lattice, seed->cells[i + 1U]);
        if (aisle_segment_gap(a, b, gap->side[0], gap->side[1]) <= 0.0) {
            return true;
        }
    }
    return false;
}

// Looks at some more of the way's narrow cells. AISLE_BUSY; AISLE_OK: the way has been measured.
static aisle_status measure(aisle_why *self, uint32_t units) {
    const aisle_seed *seed = self->seed;
    while (self->at < seed->cell_count && self->seed->units < units) {
        uint32_t cell = seed->cells[self->at++];
        aisle_gap gap;
        if (self->space->grid->field[cell] <= self->narrow_to &&
            gap_near(self, aisle_lattice_centre(&self->space->grid->lattice, cell), &gap) &&
            (self->way.sides == 0U || gap.width < self->way.width) && is_crossed(self, &gap)) {
            self->way = gap;
        }
        self->seed->units += self->at % 8U == 0U ? 1U : 0U;
    }
    if (self->at < seed->cell_count) {
        return AISLE_BUSY;
    }
    if (self->way.sides == 0U) {
        measure_gap(self);
    }
    return AISLE_OK;
}

// Keeps the way's gap if it is the widest so far and looks for a way past it. AISLE_OK: there need be none.
static aisle_status next_way(aisle_why *self) {
    if (self->gap.sides == 0U || (self->way.sides == 2U && self->way.width > self->gap.width)) {
        self->gap = self->way;
    }
    if (self->way.sides != 2U || self->bar_count >= AISLE_WHY_WAYS) {
        return AISLE_OK;
    }
    self->bars[self->bar_count][0] = self->way.side[0];
    self->bars[self->bar_count++][1] = self->way.side[1];
    // As low as the field on the searched cells of a way that is wider can be.
    double least = sqrt((double)self->lo) - 0.71 * (double)self->stride - 1.5;
    self->stride = least < (double)self->stride ? 1U : self->stride; // see lowest()
    search_widest(self, least > 1.0 ? (uint32_t)(least * least) : 1U);
    return AISLE_BUSY;
}

// Least field value searched for. A longer step than to the next cell could lead across a thin wall; not so between
// cells that keep a whole stride.
static uint32_t lowest(const aisle_why *self) {
    return self->stride * self->stride;
}

static aisle_status begin_widths(aisle_why *self, bool proved) {
    self->proved = proved;
    self->stage = AISLE_WHY_ANY;
    search_from(self, lowest(self));
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
            search_from(self, lowest(self));
            return AISLE_BUSY;
        }
        self->connected = found;
        self->lo = lowest(self);
        break;
    case AISLE_WHY_BISECT:
        *(found ? &self->lo : &self->hi) = self->seed->open_from;
        break;
    default:
        return found ? begin_measure(self) : AISLE_OK;
    }
    if (!self->connected) {
        return AISLE_OK;
    }
    halve_doubt(self);
    return AISLE_BUSY;
}

aisle_status aisle_why_step(aisle_why *self, uint32_t units, uint32_t *spent) {
    aisle_status st;
    if (self->stage == AISLE_WHY_MEASURE) {
        st = measure(self, units);
        *spent += self->seed->units; // a search that begins would forget them
        self->seed->units = 0;
        return st == AISLE_OK ? next_way(self) : st;
    }
    st = aisle_seed_step_refusal(self->seed, units, spent);
    return st == AISLE_BUSY || st == AISLE_ERR_CAPACITY ? st : next_search(self, st == AISLE_OK);
}
