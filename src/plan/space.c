#include "plan/space.h"

#include "base/angle.h"
#include "base/check.h"
#include "robot/curve.h"
#include "robot/profile.h"

#include <math.h>
#include <string.h>

#define STRAY_STEP 1e-3     // m, of piece_clearance's subdivision: from straight ways
#define OVERREACH_STEP 4e-3 // m, and of the hull beyond the sweep of a body that turns
#define SUBDIVISIONS_MAX 4096U
#define HALF_DIAGONAL 0.70710678118654752 // of a square of side 1

void aisle_space_carve(aisle_space *self, aisle_arena *arena, uint32_t cells) {
    self->cell_free = (uint64_t *)aisle_arena_take(arena, (size_t)cells / 64U + 1U, sizeof(uint64_t));
    self->cells = cells;
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

void aisle_space_begin(aisle_space *self, const aisle_layout *layout, const aisle_vehicle *vehicle,
                       aisle_space_mode mode) {
    self->layout = layout;
    self->grid = aisle_layout_grid(layout);
    self->vehicle = vehicle;
    self->mode = mode;
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
    aisle_space_forget(self);
}

void aisle_space_forget(aisle_space *self) {
    uint32_t cells = self->grid->lattice.w * self->grid->lattice.h;
    AISLE_ASSERT(cells <= self->cells);
    memset(self->cell_free, 0, ((size_t)cells / 64U + 1U) * sizeof(uint64_t));
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
    uint64_t bit = 1ULL << (cell % 64U);
    if ((self->cell_free[cell / 64U] & bit) != 0U) {
        return true;
    }
    *units += 1U;
    aisle_vec2 centre = aisle_lattice_centre(&self->grid->lattice, cell);
    if (!capsule_free(self, centre, centre, need)) {
        return false;
    }
    self->cell_free[cell / 64U] |= bit;
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
    uint64_t bit = 1ULL << (cell % 64U);
    if ((self->cell_free[cell / 64U] & bit) != 0U) {
        return true;
    }
    if (!aisle_space_square_holds(self, NULL, aisle_lattice_centre(&self->grid->lattice, cell), reach, depth, units)) {
        return false;
    }
    self->cell_free[cell / 64U] |= bit;
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
        way.theta = aisle_atan2(way_to.y, way_to.x);
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

// Distance from p to occupied cells, interpolated between the four centres around p.
double aisle_space_clearance_about(const aisle_space *self, aisle_vec2 p) {
    if (aisle_space_is_far(self, p)) {
        return self->far_clearance;
    }
    const aisle_lattice *lattice = &self->grid->lattice;
    double fx = aisle_clamp((p.x - lattice->x0) / lattice->res - 0.5, 0.0, (double)(lattice->w - 1U));
    double fy = aisle_clamp((p.y - lattice->y0) / lattice->res - 0.5, 0.0, (double)(lattice->h - 1U));
    uint32_t ix = (uint32_t)fx;
    uint32_t iy = (uint32_t)fy;
    uint32_t right = ix + 1U < lattice->w ? 1U : 0U;
    uint32_t up = iy + 1U < lattice->h ? lattice->w : 0U;
    const uint16_t *at = self->grid->field + (size_t)iy * lattice->w + ix;
    double tx = fx - (double)ix;
    double ty = fy - (double)iy;
    double low = sqrt((double)at[0]) * (1.0 - tx) + sqrt((double)at[right]) * tx;
    double high = sqrt((double)at[up]) * (1.0 - tx) + sqrt((double)at[up + right]) * tx;
    double cells = low * (1.0 - ty) + high * ty;
    return (cells - 0.5) * lattice->res - self->vehicle->inner_radius;
}

// Least gap over the part [f0, f1] of a piece, given how far body points may stray from the hull of its ends.
static double part_clearance(const aisle_space *self, aisle_pose2 from, aisle_pose2 to, double stray, double cap) {
    aisle_vec2 both[2 * AISLE_SHAPE_VERTICES_MAX];
    aisle_vec2 hull[2 * AISLE_SHAPE_VERTICES_MAX];
    const aisle_vehicle *vehicle = self->vehicle;
    aisle_convex_place(vehicle->footprint, vehicle->n, from, both);
    aisle_convex_place(vehicle->footprint, vehicle->n, to, both + vehicle->n);
    aisle_convex swept = {hull, aisle_convex_hull(both, 2U * vehicle->n, hull), vehicle->radius};
    double gap = aisle_layout_gap(self->layout, &swept, cap + stray, NULL);
    return aisle_max(gap - stray, 0.0);
}

double aisle_space_piece_clearance(const aisle_space *self, const aisle_waypoint_msg *from,
                                   const aisle_waypoint_msg *to, uint32_t *units) {
    double length = aisle_piece_length(from, to);
    double turn = aisle_piece_turn(from, to);
    aisle_pose2 middle = aisle_piece_at(from, to, 0.5);
    double around = aisle_grid_gap_lower(self->grid, aisle_vec2_of(middle.x, middle.y));
    *units += 1U;
    if (around - self->vehicle->outer_radius - 0.5 * length >= AISLE_CLEARANCE_CAP) {
        return AISLE_CLEARANCE_CAP;
    }
    double stray = 0.125 * (fabs((double)to->curvature) * length * length + self->lever * turn * turn);
    double wanted = floor(aisle_max(sqrt(stray / STRAY_STEP), 0.5 * self->lever * fabs(turn) / OVERREACH_STEP)) + 1.0;
    uint32_t parts = wanted < (double)SUBDIVISIONS_MAX ? (uint32_t)wanted : SUBDIVISIONS_MAX;
    double clearance = AISLE_CLEARANCE_CAP;
    aisle_pose2 begin = {from->x, from->y, from->theta};
    for (uint32_t i = 1; i <= parts; i++) {
        aisle_pose2 end = aisle_piece_at(from, to, (double)i / (double)parts);
        clearance = part_clearance(self, begin, end, stray / ((double)parts * (double)parts), clearance);
        begin = end;
        *units += 1U;
    }
    return clearance;
}
