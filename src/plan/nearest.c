#include "plan/nearest.h"

#include "base/check.h"

#include <math.h>

#define DIAGONAL 1.4142135623730951 // of a square of half side 1, halved
#define CELLS_A_UNIT 16

// A disc the body holds whatever the place: about the origin, or, as a body need not hold its origin, about the mean of
// its corners.
static void measure_middle(aisle_nearest *self) {
    const aisle_vehicle *vehicle = self->space->vehicle;
    self->middle = aisle_vec2_of(0.0, 0.0);
    self->middle_radius = vehicle->inner_radius;
    if (self->any_heading || vehicle->n < 3U) {
        return;
    }
    aisle_vec2 v[AISLE_SHAPE_VERTICES_MAX];
    aisle_convex body = aisle_vehicle_place(vehicle, (aisle_pose2){0.0, 0.0, self->stop.theta}, 0.0, v);
    for (uint32_t i = 0; i < body.n; i++) {
        self->middle = aisle_vec2_add(self->middle, aisle_vec2_scale(v[i], 1.0 / body.n));
    }
    double least = (double)INFINITY;
    for (uint32_t i = 0; i < body.n; i++) {
        aisle_vec2 edge[2] = {v[i], v[(i + 1U) % body.n]};
        least = aisle_min(least, aisle_convex_point_gap(&(aisle_convex){edge, 2U, 0.0}, self->middle));
    }
    self->middle_radius = least + body.radius;
}

void aisle_nearest_start(aisle_nearest *self, const aisle_space *space, aisle_pose2 stop, bool any_heading) {
    *self = (aisle_nearest){.space = space, .stop = stop, .any_heading = any_heading, .distance = AISLE_NEAREST_FAR};
    self->need = space->keep + AISLE_NEAREST_SPARE;
    self->rings = (int32_t)(AISLE_NEAREST_FAR / space->grid->lattice.res) + 1;
    measure_middle(self);
}

// Exact gap of the body with its origin at p, at most cap.
static double body_gap(aisle_nearest *self, aisle_vec2 p, double cap) {
    const aisle_space *space = self->space;
    self->units++;
    if (!self->any_heading) {
        return aisle_space_gap(space, (aisle_pose2){p.x, p.y, self->stop.theta}, cap, NULL);
    }
    aisle_convex disc = {&p, 1U, space->vehicle->inner_radius};
    return aisle_layout_gap(space->layout, &disc, cap, NULL);
}

// Gap of the disc that the body holds, at most cap: not less than the body's, and below 0 where that has no more to tell
// than contact.
static double middle_gap(aisle_nearest *self, aisle_vec2 p, double cap) {
    aisle_vec2 middle = aisle_vec2_add(p, self->middle);
    self->units++;
    return aisle_layout_gap(self->space->layout, &(aisle_convex){&middle, 1U, 0.0}, cap + self->middle_radius, NULL) -
           self->middle_radius;
}

static double away(const aisle_nearest *self, aisle_vec2 p) {
    return aisle_vec2_distance(p, aisle_vec2_of(self->stop.x, self->stop.y));
}

// The point of a square nearest to the stop.
static aisle_vec2 nearest_of(const aisle_nearest *self, const aisle_nearest_square *s) {
    return aisle_vec2_of(aisle_clamp(self->stop.x, s->centre.x - s->half, s->centre.x + s->half),
                         aisle_clamp(self->stop.y, s->centre.y - s->half, s->centre.y + s->half));
}

static void propose(aisle_nearest *self, aisle_vec2 p) {
    double distance = away(self, p);
    if (distance < self->distance && body_gap(self, p, self->need + 1.0) >= self->need) {
        self->distance = distance;
        self->place = p;
        self->found = true;
    }
}

// Where a free middle with `spare` m of gap too much may be moved to, straight at the stop.
static aisle_vec2 moved_at_stop(const aisle_nearest *self, aisle_vec2 p, double spare) {
    double distance = away(self, p);
    double step = aisle_min(spare, distance);
    aisle_vec2 stop = aisle_vec2_of(self->stop.x, self->stop.y);
    return distance > 0.0 ? aisle_vec2_lerp(p, stop, step / distance) : p;
}

static void halve(aisle_nearest *self, const aisle_nearest_square *s) {
    // The quarter on the stop's side comes last and so is taken first.
    double x = self->stop.x < s->centre.x ? 0.5 : -0.5;
    double y = self->stop.y < s->centre.y ? 0.5 : -0.5;
    const double sides[4][2] = {{x, y}, {-x, y}, {x, -y}, {-x, -y}};
    AISLE_ASSERT(self->open_count + 4U <= sizeof self->open / sizeof self->open[0]);
    for (int k = 0; k < 4; k++) {
        aisle_vec2 c = {s->centre.x + s->half * sides[k][0], s->centre.y + s->half * sides[k][1]};
        self->open[self->open_count++] = (aisle_nearest_square){c, 0.5 * s->half};
    }
}

static void judge(aisle_nearest *self, const aisle_nearest_square *s) {
    if (away(self, nearest_of(self, s)) >= self->distance - AISLE_NEAREST_GRAIN) {
        return;
    }
    double reach = DIAGONAL * s->half;
    if (middle_gap(self, s->centre, self->need + reach) + reach < self->need) {
        return;
    }
    double gap = body_gap(self, s->centre, self->need + 2.0 * reach);
    if (gap + reach < self->need) {
        return;
    }
    if (gap >= self->need + reach) {
        propose(self, nearest_of(self, s));
        return;
    }
    if (gap >= self->need) {
        propose(self, moved_at_stop(self, s->centre, gap - self->need));
        propose(self, s->centre); // rounding may have cost the moved one its last bit
    }
    if (2.0 * s->half > AISLE_NEAREST_GRAIN) {
        halve(self, s);
    }
}

// May the cell hold a place, by the field alone?
static bool is_hopeful(const aisle_nearest *self, aisle_vec2 centre) {
    double reach = DIAGONAL * 0.5 * self->space->grid->lattice.res;
    double most = aisle_grid_gap_upper(self->space->grid, aisle_vec2_add(centre, self->middle));
    return most - self->middle_radius + reach >= self->need;
}

// Cell `at` of the ring, counted round it; the ring has 8 * ring cells, the first one 1.
static void cell_of_ring(const aisle_nearest *self, int32_t *x, int32_t *y) {
    int32_t r = self->ring;
    int32_t side = r > 0 ? self->at / (2 * r) : 0;
    int32_t k = r > 0 ? self->at % (2 * r) : 0;
    *x = side == 0 ? k - r : (side == 1 ? r : (side == 2 ? r - k : -r));
    *y = side == 0 ? -r : (side == 1 ? k - r : (side == 2 ? r : r - k));
}

// Looks at the cell under way and turns to the next one.
static void open_cell(aisle_nearest *self) {
    const aisle_lattice *lattice = &self->space->grid->lattice;
    uint32_t home = aisle_lattice_cell(lattice, aisle_vec2_of(self->stop.x, self->stop.y), NULL);
    int32_t x, y;
    cell_of_ring(self, &x, &y);
    x += (int32_t)(home % lattice->w);
    y += (int32_t)(home / lattice->w);
    self->units += self->at % CELLS_A_UNIT == 0 ? 1U : 0U;
    if (x >= 0 && y >= 0 && x < (int32_t)lattice->w && y < (int32_t)lattice->h) {
        aisle_vec2 centre = aisle_lattice_centre(lattice, (uint32_t)y * lattice->w + (uint32_t)x);
        if (is_hopeful(self, centre)) {
            self->open[self->open_count++] = (aisle_nearest_square){centre, 0.5 * lattice->res};
        }
    }
    self->at++;
    if (self->at >= 8 * self->ring) {
        self->ring++;
        self->at = 0;
    }
}

// Nothing of this ring or later ones can be nearer than what was found.
static bool is_over(const aisle_nearest *self) {
    return self->ring > self->rings || (self->ring - 1) * self->space->grid->lattice.res >= self->distance;
}

aisle_status aisle_nearest_step(aisle_nearest *self, uint32_t units, uint32_t *spent) {
    uint32_t before = self->units;
    aisle_status st = AISLE_BUSY;
    while (st == AISLE_BUSY && self->units - before < units) {
        if (self->open_count > 0U) {
            aisle_nearest_square square = self->open[--self->open_count];
            judge(self, &square);
        } else if (is_over(self)) {
            st = self->found ? AISLE_OK : AISLE_PARTIAL;
        } else {
            open_cell(self);
        }
        st = st == AISLE_BUSY && self->units >= AISLE_NEAREST_UNITS ? AISLE_PARTIAL : st;
    }
    *spent += self->units - before;
    return st;
}
