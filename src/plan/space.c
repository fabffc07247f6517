#include "plan/space.h"

#include "base/angle.h"
#include "base/check.h"
#include "plan/zones.h"
#include "robot/curve.h"
#include "robot/profile.h"

#include <math.h>
#include <string.h>

#define STRAY_STEP 1e-3                   // m, of piece_clearance: from straight ways
#define STRAY_STEP_FREE 1e-4              // m, of piece_free
#define OVERREACH_STEP 4e-3               // m, and of the hull beyond the sweep of a body that turns
#define ROUGH 0.0625                      // share of a gap that may be told too little where nothing hangs on it
#define ROUGH_BELOW 0.025                 // m, the same below the creep clearance
#define PARTS_DEPTH_MAX 13U               // halvings of a piece, at most 4096 parts
#define HALF_DIAGONAL 0.70710678118654752 // of a square of side 1

void aisle_space_carve(aisle_space *self, aisle_arena *arena, uint32_t cells) {
    self->cell_free = (uint64_t *)aisle_arena_take(arena, (size_t)cells / 64U + 1U, sizeof(uint64_t));
    self->cells = cells;
    self->known_from = cells / 64U + 1U; // an arena's memory is 0
    self->known_end = 0;
    self->root = (float *)aisle_arena_take(arena, AISLE_SPACE_ROOTS, sizeof(float));
    for (uint32_t q = 0; self->root != NULL && q < AISLE_SPACE_ROOTS; q++) {
        self->root[q] = (float)sqrt((double)q);
    }
}

// The lever, and discs of equal radius along the body's x axis that together hold the footprint's box.
static void measure_body(aisle_space *self) {
    const aisle_vehicle *vehicle = self->vehicle;
    aisle_aabb box = aisle_convex_aabb(&(aisle_convex){vehicle->footprint, vehicle->n, 0.0});
    for (uint32_t i = 0; i < vehicle->n; i++) {
        self->lever = aisle_max(self->lever, aisle_vec2_length(vehicle->footprint[i]));
    }
    double half = (box.hi.x - box.lo.x) / 8.0; // of one disc's share
    double side = aisle_max(-box.lo.y, box.hi.y);
    for (int i = 0; i < 4; i++) {
        self->disc_x[i] = box.lo.x + half * (2.0 * i + 1.0);
    }
    self->disc_radius = sqrt(half * half + side * side) + vehicle->radius;
}

// Squared cells, rounded down, above 0.
static uint32_t squared(double cells) {
    return cells > 0.0 ? (uint32_t)aisle_min(cells * cells, (double)AISLE_FIELD_SQ_MAX) : 0U;
}

// By the bounds of grid.h, for a place in a corner of its cell and for one in the middle.
static void measure_cover(aisle_space *self) {
    const double cells = self->reach / self->grid->lattice.res, spare = 2.0 * AISLE_GRID_SLACK;
    self->covered_below = squared(cells - 2.0 * HALF_DIAGONAL - spare);
    self->covered_until = squared(cells - HALF_DIAGONAL) + (cells > HALF_DIAGONAL ? 1U : 0U);
}

void aisle_space_begin(aisle_space *self, const aisle_layout *layout, const aisle_vehicle *vehicle,
                       aisle_space_mode mode) {
    self->layout = layout;
    self->grid = aisle_layout_grid(layout);
    self->vehicle = vehicle;
    self->mode = mode;
    self->per_metre = 1.0 / self->grid->lattice.res;
    self->keep = vehicle->margin + AISLE_SPACE_SLACK;
    self->reach = self->keep + (mode == AISLE_SPACE_FREE_TURN ? vehicle->outer_radius : vehicle->inner_radius);
    // A scanned cell is an obstacle all over and holds a disc of half its side; a cell some polygon touches may be
    // all but free.
    bool solid = aisle_layout_has_scan(layout) && aisle_layout_zone_count(layout) == 0U;
    self->beyond = self->grid->lattice.res * (solid ? -0.5 : HALF_DIAGONAL);
    self->lever = 0.0;
    measure_body(self);
    double res = self->grid->lattice.res;
    self->far_clearance = aisle_max(vehicle->creep_clearance, vehicle->outer_radius + self->keep);
    double cells =
        (self->far_clearance + vehicle->outer_radius) / res + 2.0; // 2: to the cell's rim, and from its centre
    self->far_field = (uint32_t)aisle_min(cells * cells, (double)AISLE_FIELD_SQ_MAX);
    measure_cover(self);
    aisle_space_forget(self);
}

void aisle_space_forget(aisle_space *self) {
    AISLE_ASSERT(self->grid->lattice.w * self->grid->lattice.h <= self->cells);
    if (self->known_from < self->known_end) {
        memset(self->cell_free + self->known_from, 0, (self->known_end - self->known_from) * sizeof(uint64_t));
    }
    self->known_from = self->cells / 64U + 1U;
    self->known_end = 0;
}

bool aisle_space_is_noted(const aisle_space *self, uint32_t cell) {
    return (self->cell_free[cell / 64U] >> (cell % 64U) & 1U) != 0U;
}

void aisle_space_note(aisle_space *self, uint32_t cell) {
    const uint32_t word = cell / 64U;
    self->cell_free[word] |= 1ULL << (cell % 64U);
    self->known_from = word < self->known_from ? word : self->known_from;
    self->known_end = word >= self->known_end ? word + 1U : self->known_end;
}

// Is the disc of radius r about the way from a to b free? Exact.
static bool capsule_free(const aisle_space *self, aisle_vec2 a, aisle_vec2 b, double r) {
    aisle_vec2 ends[2] = {a, b};
    aisle_convex capsule = {ends, 2U, r};
    return aisle_layout_gap(self->layout, &capsule, self->grid->lattice.res, NULL) > 0.0;
}

bool aisle_space_cell_free(aisle_space *self, uint32_t cell, double step, uint32_t *units) {
    double res = self->grid->lattice.res;
    double need = sqrt(self->reach * self->reach + 0.5 * step * step);
    double centre_gap = sqrt((double)self->grid->field[cell]) * res;
    double half_diagonal = res * HALF_DIAGONAL;
    if (centre_gap - half_diagonal >= need) {
        return true;
    }
    if (centre_gap + self->beyond < need) {
        return false;
    }
    if (aisle_space_is_noted(self, cell)) {
        return true;
    }
    *units += 1U;
    aisle_vec2 centre = aisle_lattice_centre(&self->grid->lattice, cell);
    if (!capsule_free(self, centre, centre, need)) {
        return false;
    }
    aisle_space_note(self, cell);
    return true;
}

// Gap of a bare point, at most cap.
static double point_gap(const aisle_space *self, aisle_vec2 p, double cap) {
    aisle_convex point = {&p, 1U, 0.0};
    return aisle_layout_gap(self->layout, &point, cap, NULL);
}

// Branch and bound over the squares of a cell, depth first.
bool aisle_space_square_holds(const aisle_space *self, const aisle_layout_without *without, aisle_vec2 centre,
                              double reach, uint32_t depth_max, uint32_t *units) {
    aisle_vec2 open[3U * AISLE_SPACE_DEPTH_MAX + 1U]; // centres of squares in doubt; their depths beside them
    uint32_t depth[3U * AISLE_SPACE_DEPTH_MAX + 1U];
    uint32_t count = 1;
    open[0] = centre;
    depth[0] = 0;
    while (count > 0U) {
        count--;
        aisle_vec2 c = open[count];
        uint32_t d = depth[count];
        double half = 0.5 * self->grid->lattice.res / (double)(1U << d);
        aisle_convex point = {&c, 1U, 0.0};
        double gap = aisle_layout_gap_without(self->layout, without, &point, reach, NULL);
        double best = gap + 2.0 * half * HALF_DIAGONAL; // of any point of the square
        *units += 1U;
        if (best < reach) {
            continue;
        }
        if (d == depth_max || best >= reach + 2.0 * half * HALF_DIAGONAL) {
            return true;
        }
        for (int k = 0; k < 4; k++) {
            double dx = (k & 1) != 0 ? 0.5 * half : -0.5 * half;
            double dy = (k & 2) != 0 ? 0.5 * half : -0.5 * half;
            open[count] = aisle_vec2_of(c.x + dx, c.y + dy);
            depth[count++] = d + 1U;
        }
    }
    return false;
}

bool aisle_space_cell_holds(aisle_space *self, uint32_t cell, double reach, uint32_t depth, uint32_t *units) {
    AISLE_ASSERT(depth <= AISLE_SPACE_DEPTH_MAX);
    double side = self->grid->lattice.res;
    double centre_gap = sqrt((double)self->grid->field[cell]) * side;
    if (centre_gap - side * HALF_DIAGONAL >= reach) {
        return true;
    }
    if (centre_gap + self->beyond + side * HALF_DIAGONAL < reach) {
        return false;
    }
    if (aisle_space_is_noted(self, cell)) {
        return true;
    }
    if (!aisle_space_square_holds(self, NULL, aisle_lattice_centre(&self->grid->lattice, cell), reach, depth, units)) {
        return false;
    }
    aisle_space_note(self, cell);
    return true;
}

aisle_vec2 aisle_space_roomiest(const aisle_space *self, uint32_t cell, double *gap, uint32_t *units) {
    static const double direction[8][2] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}, {1, 1}, {-1, 1}, {-1, -1}, {1, -1}};
    double res = self->grid->lattice.res;
    double cap = self->reach + res;
    aisle_vec2 centre = aisle_lattice_centre(&self->grid->lattice, cell);
    aisle_vec2 best = centre;
    *gap = point_gap(self, best, cap);
    for (double step = 0.25 * res; step > res / 512.0; step *= 0.5) {
        aisle_vec2 from = best;
        for (int k = 0; k < 8; k++) {
            aisle_vec2 p = aisle_vec2_of(from.x + step * direction[k][0], from.y + step * direction[k][1]);
            double here = point_gap(self, p, cap);
            if (here > *gap) {
                *gap = here;
                best = p;
            }
        }
        *units += 8U;
    }
    return best; // the steps sum up to less than half a cell: never outside
}

// The exact footprint driven straight from a to b, heading along it.
static bool body_free(const aisle_space *self, aisle_vec2 a, aisle_vec2 b, double theta) {
    aisle_vec2 both[2 * AISLE_SHAPE_VERTICES_MAX];
    aisle_vec2 hull[2 * AISLE_SHAPE_VERTICES_MAX];
    const aisle_vehicle *vehicle = self->vehicle;
    aisle_convex_place(vehicle->footprint, vehicle->n, (aisle_pose2){a.x, a.y, theta}, both);
    aisle_convex_place(vehicle->footprint, vehicle->n, (aisle_pose2){b.x, b.y, theta}, both + vehicle->n);
    aisle_convex swept = {hull, aisle_convex_hull(both, 2U * vehicle->n, hull), vehicle->radius + self->keep};
    return aisle_layout_gap(self->layout, &swept, self->grid->lattice.res, NULL) > 0.0;
}

// Do the covering discs, by the field alone, say that the body within `around` of p is free?
static bool discs_free(const aisle_space *self, aisle_vec2 p, aisle_vec2 heading, double around) {
    for (int i = 0; i < 4; i++) {
        aisle_vec2 centre = aisle_vec2_add(p, aisle_vec2_scale(heading, self->disc_x[i]));
        if (aisle_grid_gap_lower(self->grid, centre) < self->disc_radius + self->keep + around) {
            return false;
        }
    }
    return true;
}

typedef struct sweep {
    aisle_vec2 a, b, heading;
    double length, theta;
} sweep;

// Free way from a + s on, by the field alone; not above 0: in doubt.
static double free_ahead(const aisle_space *self, const sweep *way, double s) {
    aisle_vec2 p = aisle_vec2_add(way->a, aisle_vec2_scale(way->heading, s));
    double around = aisle_grid_gap_lower(self->grid, p) - self->keep;
    if (around > self->vehicle->outer_radius) {
        return around - self->vehicle->outer_radius;
    }
    return 0.0;
}

static bool piece_free(const aisle_space *self, const sweep *way, double s0, double s1, aisle_space_mode mode) {
    aisle_vec2 p0 = aisle_vec2_add(way->a, aisle_vec2_scale(way->heading, s0));
    aisle_vec2 p1 = s1 >= way->length ? way->b : aisle_vec2_add(way->a, aisle_vec2_scale(way->heading, s1));
    if (mode == AISLE_SPACE_FREE_TURN) {
        return capsule_free(self, p0, p1, self->reach);
    }
    return discs_free(self, aisle_vec2_lerp(p0, p1, 0.5), way->heading, 0.5 * (s1 - s0)) ||
           body_free(self, p0, p1, way->theta);
}

static bool sweep_free(const aisle_space *self, aisle_vec2 a, aisle_vec2 b, aisle_space_mode mode, uint32_t *units) {
    aisle_vec2 way_to = aisle_vec2_sub(b, a);
    sweep way = {a, b, {1.0, 0.0}, aisle_vec2_length(way_to), 0.0};
    if (way.length > 1e-9) {
        way.heading = aisle_vec2_scale(way_to, 1.0 / way.length);
        way.theta = mode == AISLE_SPACE_ALONG ? aisle_atan2(way_to.y, way_to.x) : 0.0;
    }
    if (!aisle_zones_allow(self->layout, a, b, self->zone_room, NULL)) {
        return false;
    }
    double s = 0.0;
    double least = 0.5 * self->grid->lattice.res; // a shorter step is not worth a look at the field
    do {
        *units += 1U;
        double ahead = free_ahead(self, &way, s);
        if (ahead < least) {
            ahead = aisle_min(AISLE_SPACE_PIECE, way.length - s);
            if (!piece_free(self, &way, s, s + ahead, mode)) {
                return false;
            }
            ahead = aisle_max(ahead, least);
        }
        s += ahead;
    } while (s < way.length);
    return true;
}

bool aisle_space_sweep_free(const aisle_space *self, aisle_vec2 a, aisle_vec2 b, uint32_t *units) {
    return sweep_free(self, a, b, self->mode, units);
}

bool aisle_space_body_sweep_free(const aisle_space *self, aisle_vec2 a, aisle_vec2 b, uint32_t *units) {
    return aisle_vec2_distance(a, b) > 1e-9 && sweep_free(self, a, b, AISLE_SPACE_ALONG, units);
}

bool aisle_space_turn_free(const aisle_space *self, aisle_vec2 p, uint32_t *units) {
    double need = self->vehicle->outer_radius + self->keep;
    *units += 1U;
    return aisle_grid_gap_lower(self->grid, p) >= need || capsule_free(self, p, p, need);
}

double aisle_space_gap(const aisle_space *self, aisle_pose2 pose, double cap, int32_t *id) {
    aisle_vec2 points[AISLE_SHAPE_VERTICES_MAX];
    aisle_convex body = aisle_vehicle_place(self->vehicle, pose, 0.0, points);
    return aisle_layout_gap(self->layout, &body, cap, id);
}

bool aisle_space_is_far(const aisle_space *self, aisle_vec2 p) {
    bool inside;
    return self->grid->field[aisle_lattice_cell(&self->grid->lattice, p, &inside)] >= self->far_field && inside;
}

bool aisle_space_is_covered(const aisle_space *self, aisle_vec2 p) {
    bool inside;
    const uint32_t field = self->grid->field[aisle_lattice_cell(&self->grid->lattice, p, &inside)];
    if (!inside || field >= self->covered_until) {
        return false;
    }
    return field < self->covered_below || aisle_grid_gap_upper(self->grid, p) < self->reach;
}

static double root_of(const aisle_space *self, uint16_t field) {
    return field < AISLE_SPACE_ROOTS ? (double)self->root[field] : sqrt((double)field);
}

// Distance from p to occupied cells, interpolated between the four centres around p.
double aisle_space_clearance_about(const aisle_space *self, aisle_vec2 p) {
    const aisle_lattice *lattice = &self->grid->lattice;
    const uint16_t *field = self->grid->field;
    double w = (double)lattice->w;
    double h = (double)lattice->h;
    double x = (p.x - lattice->x0) * self->per_metre;
    double y = (p.y - lattice->y0) * self->per_metre;
    if (x >= 0.0 && x < w && y >= 0.0 && y < h &&
        field[(size_t)(uint32_t)y * lattice->w + (uint32_t)x] >= self->far_field) {
        return self->far_clearance;
    }
    double fx = aisle_clamp(x - 0.5, 0.0, w - 1.0);
    double fy = aisle_clamp(y - 0.5, 0.0, h - 1.0);
    uint32_t ix = (uint32_t)fx;
    uint32_t iy = (uint32_t)fy;
    uint32_t right = ix + 1U < lattice->w ? 1U : 0U;
    uint32_t up = iy + 1U < lattice->h ? lattice->w : 0U;
    const uint16_t *at = field + (size_t)iy * lattice->w + ix;
    double tx = fx - (double)ix;
    double ty = fy - (double)iy;
    double low = root_of(self, at[0]) * (1.0 - tx) + root_of(self, at[right]) * tx;
    double high = root_of(self, at[up]) * (1.0 - tx) + root_of(self, at[up + right]) * tx;
    double cells = low * (1.0 - ty) + high * ty;
    return (cells - 0.5) * lattice->res - self->vehicle->inner_radius;
}

// ---- clearance of pieces

typedef struct piece {
    const aisle_waypoint_msg *from, *to;
    double length; // m
    double stray;  // m, of any body point from the straight way between its ends, over the whole piece
    double beyond; // m, what the hull of the body at both ends reaches beyond the sweep, likewise
    double least;  // m, no smaller gap is known to lie on it
    double most;   // m, the least gap of a placement looked at: the answer is not above it
    bool rough;    // which side of the creep clearance it is on matters, not where
} piece;

static aisle_pose2 pose_at(const piece *p, double f) {
    return f > 0.0 ? aisle_piece_at(p->from, p->to, f) : (aisle_pose2){p->from->x, p->from->y, p->from->theta};
}

// Gap of the body's hull over the part [f0, f1], less its stray: a lower bound, at most `cap`.
static double part_clearance(const aisle_space *self, const piece *p, double f0, double f1, double cap) {
    aisle_vec2 both[2 * AISLE_SHAPE_VERTICES_MAX];
    aisle_vec2 hull[2 * AISLE_SHAPE_VERTICES_MAX];
    const aisle_vehicle *vehicle = self->vehicle;
    const aisle_pose2 from = pose_at(p, f0), to = pose_at(p, f1);
    const double stray = p->stray * (f1 - f0) * (f1 - f0);
    aisle_convex swept = {hull, 2U, vehicle->radius};
    if (aisle_vehicle_is_disc(vehicle)) {
        hull[0] = aisle_vec2_of(from.x, from.y);
        hull[1] = aisle_vec2_of(to.x, to.y);
    } else {
        aisle_convex_place(vehicle->footprint, vehicle->n, from, both);
        aisle_convex_place(vehicle->footprint, vehicle->n, to, both + vehicle->n);
        swept.n = aisle_convex_hull(both, 2U * vehicle->n, hull);
    }
    return aisle_max(aisle_layout_gap(self->layout, &swept, cap + stray, NULL) - stray, 0.0);
}

static bool is_fine(const piece *p, double size, double stray_step) {
    return p->stray * size * size <= stray_step && p->beyond * size <= OVERREACH_STEP;
}

static piece piece_between(const aisle_space *self, const aisle_waypoint_msg *from, const aisle_waypoint_msg *to,
                           double cap) {
    const double length = aisle_piece_length(from, to), turn = aisle_piece_turn(from, to);
    return (piece){.from = from,
                   .to = to,
                   .length = length,
                   .stray = 0.125 * (fabs((double)to->curvature) * length * length + self->lever * turn * turn),
                   .beyond = 0.5 * self->lever * fabs(turn),
                   .least = cap,
                   .most = cap};
}

// Does the field alone say that the body keeps `gap` all along?
static bool is_known_clear(const aisle_space *self, const piece *p, double gap) {
    const aisle_pose2 middle = pose_at(p, 0.5);
    const double around = aisle_grid_gap_lower(self->grid, aisle_vec2_of(middle.x, middle.y));
    return around - self->vehicle->outer_radius - 0.5 * p->length >= gap;
}

static void place_at(const aisle_space *self, piece *p, double f, uint32_t *units) {
    p->most = aisle_min(p->most, aisle_space_gap(self, pose_at(p, f), p->most, NULL));
    *units += 1U;
}

// No objective asks for more than a rough number from the creep clearance on, and but for SAFEST none below it.
static bool is_rough_enough(const piece *p, double gap, double creep) {
    return (gap >= creep && gap >= (1.0 - ROUGH) * p->most) ||
           (p->rough && p->most < creep && gap >= p->most - ROUGH_BELOW);
}

// Is there nothing more to be learnt from a part of this size and bound?
static bool is_settled(const piece *p, double gap, double size, double creep) {
    const double spare = STRAY_STEP + (p->beyond > 0.0 ? OVERREACH_STEP : 0.0);
    return gap >= p->least || gap >= p->most - spare || is_rough_enough(p, gap, creep) || is_fine(p, size, STRAY_STEP);
}

// Branch and bound, halves in order: a part whose lower bound is not below what is known already, or near enough to the
// gap of a true placement, is not cut. The placements are the ends of the parts: mostly the nearest lies at one.
static double least_over_parts(const aisle_space *self, piece *p, uint32_t *units) {
    double f0 = 0.0, ends[PARTS_DEPTH_MAX]; // of the parts ahead, the next on top
    uint32_t depth = 1;
    bool placed = false;
    ends[0] = 1.0;
    while (depth > 0U) {
        const double f1 = ends[depth - 1U];
        const double gap = part_clearance(self, p, f0, f1, p->least);
        *units += 1U;
        bool settled = depth == PARTS_DEPTH_MAX || is_settled(p, gap, f1 - f0, self->vehicle->creep_clearance);
        if (!settled && !placed) {
            place_at(self, p, 0.0, units);
            place_at(self, p, 1.0, units);
            placed = true;
            settled = is_settled(p, gap, f1 - f0, self->vehicle->creep_clearance);
        }
        if (settled) {
            p->least = aisle_min(p->least, gap);
            f0 = f1;
            depth--;
        } else {
            ends[depth++] = 0.5 * (f0 + f1);
            place_at(self, p, ends[depth - 1U], units);
        }
    }
    return p->least;
}

double aisle_space_piece_clearance(const aisle_space *self, const aisle_waypoint_msg *from,
                                   const aisle_waypoint_msg *to, bool rough, uint32_t *units) {
    piece p = piece_between(self, from, to, AISLE_CLEARANCE_CAP);
    p.rough = rough;
    *units += 1U;
    return is_known_clear(self, &p, AISLE_CLEARANCE_CAP) ? AISLE_CLEARANCE_CAP : least_over_parts(self, &p, units);
}

bool aisle_space_piece_free(const aisle_space *self, const aisle_waypoint_msg *from, const aisle_waypoint_msg *to,
                            double need, uint32_t *units) {
    const piece p = piece_between(self, from, to, need);
    double f0 = 0.0, ends[PARTS_DEPTH_MAX];
    uint32_t depth = 1;
    ends[0] = 1.0;
    *units += 1U;
    if (is_known_clear(self, &p, need)) {
        return true;
    }
    while (depth > 0U) {
        const double f1 = ends[depth - 1U], middle = 0.5 * (f0 + f1);
        *units += 1U;
        if (part_clearance(self, &p, f0, f1, need) >= need * (1.0 - 1e-12)) { // it has gone up and down by the stray
            f0 = f1;
            depth--;
            continue;
        }
        *units += 1U;
        if (depth == PARTS_DEPTH_MAX || is_fine(&p, f1 - f0, STRAY_STEP_FREE) ||
            aisle_space_gap(self, pose_at(&p, middle), need, NULL) < need) {
            return false;
        }
        ends[depth++] = middle;
    }
    return true;
}

// Is it against no DIRECTED zone?
static bool obeys(const aisle_space *self, const aisle_waypoint_msg *from, const aisle_waypoint_msg *to,
                  bool backwards) {
    if (!backwards || !aisle_zones_any_directed(self->layout)) {
        return aisle_zones_allow_piece(self->layout, from, to, NULL);
    }
    aisle_waypoint_msg last = *from;
    last.curvature = -to->curvature;
    return aisle_zones_allow_piece(self->layout, to, &last, NULL);
}

bool aisle_space_moves_free(const aisle_space *self, aisle_pose2 from, const aisle_move *moves, uint32_t count,
                            double need, bool backwards, uint32_t *units) {
    aisle_waypoint_msg w[AISLE_MOVE_WAYPOINTS + 1U];
    w[0] = (aisle_waypoint_msg){.x = from.x, .y = from.y, .theta = from.theta};
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t n = aisle_move_lay(moves[i], w);
        for (uint32_t k = 1; k <= n; k++) {
            if (!aisle_space_piece_free(self, &w[k - 1U], &w[k], need, units) ||
                !obeys(self, &w[k - 1U], &w[k], backwards)) {
                return false;
            }
        }
        w[0] = w[n];
        w[0].flags = 0;
    }
    return true;
}
