#include "plan/arm_world.h"

#include "base/check.h"
#include "plan/arm_gap.h"

#include <string.h>

void aisle_arm_world_carve(aisle_arm_world *self, aisle_arena *arena, uint32_t blocks) {
    void *block = aisle_arena_take(arena, blocks, sizeof(aisle_arm_block));
    if (self != NULL) {
        memset(self, 0, sizeof *self);
        self->block = (aisle_arm_block *)block;
        self->capacity = blocks;
    }
}

// ---- gathering

double aisle_arm_mount(const aisle_arm *arm, const aisle_vehicle *vehicle) {
    const aisle_convex hull = {vehicle->footprint, vehicle->n, 0.0};
    const aisle_vec2 base = {arm->base.x, arm->base.y};
    const double gap = aisle_convex_point_gap(&hull, base);
    double depth = vehicle->radius - gap;
    if (gap <= 0.0) {
        double rim = AISLE_SHAPE_COORD_MAX;
        for (uint32_t i = 0; i < vehicle->n; i++) {
            const aisle_vec2 next = vehicle->footprint[(i + 1U) % vehicle->n];
            rim = aisle_min(rim, aisle_segment_gap(base, base, vehicle->footprint[i], next));
        }
        depth = rim + vehicle->radius;
    }
    return aisle_max(depth, 0.0) + 2.0 * arm->radius[0];
}

static bool add(aisle_arm_world *self, const aisle_convex *shape, int32_t id) {
    if (self->count == self->capacity) {
        return false;
    }
    aisle_arm_block *block = &self->block[self->count++];
    *block = (aisle_arm_block){
        .shape = *shape, .box = aisle_convex_aabb(shape), .id = id, .plain = aisle_arm_gap_is_plain(shape)};
    return true;
}

static bool gather_zones(aisle_arm_world *self, const aisle_layout *layout, aisle_aabb reach) {
    const aisle_zone *zone;
    for (aisle_layout_walk walk = aisle_layout_walk_over(layout, reach); aisle_layout_walk_next(&walk, &zone);) {
        const aisle_convex shape = aisle_layout_zone_shape(layout, zone);
        if (aisle_zone_is_obstacle(zone) && !add(self, &shape, zone->id)) {
            return false;
        }
    }
    return true;
}

static bool same_columns(aisle_aabb a, aisle_aabb b) { // both were made by the same sums
    return !(a.lo.x < b.lo.x) && !(b.lo.x < a.lo.x) && !(a.hi.x < b.hi.x) && !(b.hi.x < a.hi.x);
}

// A run of cells: it grows the rectangle of the row before if that has the same columns.
static bool add_run(aisle_arm_world *self, aisle_aabb box, uint32_t row_before, uint32_t row) {
    for (uint32_t i = row_before; i < row; i++) {
        aisle_arm_block *block = &self->block[i];
        if (same_columns(block->box, box) && block->box.hi.y >= box.lo.y && block->box.hi.y < box.hi.y) {
            block->box.hi.y = block->own[2].y = block->own[3].y = box.hi.y;
            return true;
        }
    }
    const aisle_vec2 corner[4] = {box.lo, {box.hi.x, box.lo.y}, box.hi, {box.lo.x, box.hi.y}};
    const aisle_convex shape = {corner, 4U, 0.0};
    if (!add(self, &shape, AISLE_LAYOUT_ID_SCAN)) {
        return false;
    }
    aisle_arm_block *block = &self->block[self->count - 1U];
    memcpy(block->own, corner, sizeof corner);
    block->shape.v = block->own;
    return true;
}

static bool gather_scan(aisle_arm_world *self, const aisle_layout *layout, aisle_aabb reach) {
    const aisle_lattice *lattice = &aisle_layout_grid(layout)->lattice;
    const uint32_t lo = aisle_lattice_cell(lattice, reach.lo, NULL), hi = aisle_lattice_cell(lattice, reach.hi, NULL);
    const uint32_t first = self->count, last_column = hi % lattice->w + 1U;
    for (uint32_t iy = lo / lattice->w; iy <= hi / lattice->w; iy++) {
        uint32_t end, row = self->count;
        for (uint32_t ix = lo % lattice->w; aisle_layout_scan_run(layout, iy, &ix, last_column, &end); ix = end) {
            const aisle_aabb box = {
                {lattice->x0 + lattice->res * (double)ix, lattice->y0 + lattice->res * (double)iy},
                {lattice->x0 + lattice->res * (double)end, lattice->y0 + lattice->res * ((double)iy + 1.0)}};
            if (!add_run(self, box, first, row)) {
                return false;
            }
        }
    }
    return true;
}

aisle_status aisle_arm_world_begin(aisle_arm_world *self, const aisle_layout *layout, const aisle_vehicle *vehicle,
                                   const aisle_arm *arm, aisle_pose2 pose) {
    AISLE_ASSERT(arm->links >= 1U && arm->links <= AISLE_ARM_LINKS);
    self->arm = arm;
    self->base = aisle_arm_base(arm, pose);
    self->count = 0;
    self->bounds = aisle_layout_bounds(layout);
    self->body = aisle_vehicle_place(vehicle, pose, 0.0, self->outline);
    self->body_box = aisle_convex_aabb(&self->body);
    self->body_plain = aisle_arm_gap_is_plain(&self->body);
    self->exempt = aisle_arm_mount(arm, vehicle);
    double wide = 0.0;
    for (uint32_t i = 0; i < arm->links; i++) {
        wide = aisle_max(wide, arm->radius[i]);
    }
    const aisle_vec2 at = {self->base.x, self->base.y};
    const double far = aisle_arm_reach(arm, 0U, arm->links - 1U) + wide + AISLE_ARM_SIGHT;
    const aisle_aabb reach = aisle_aabb_grow((aisle_aabb){at, at}, far);
    const bool fits =
        gather_zones(self, layout, reach) && (!aisle_layout_has_scan(layout) || gather_scan(self, layout, reach));
    return fits ? AISLE_OK : AISLE_ERR_CAPACITY;
}

// ---- links

typedef struct limb { // a link's axis, or what of it is not exempt
    aisle_vec2 axis[2];
    aisle_aabb box; // of the axis
    double radius;
} limb;

static limb link_between(aisle_vec2 from, aisle_vec2 to, double radius) {
    return (limb){
        .axis = {from, to},
        .box = {{aisle_min(from.x, to.x), aisle_min(from.y, to.y)}, {aisle_max(from.x, to.x), aisle_max(from.y, to.y)}},
        .radius = radius};
}

// All links at q in the map frame; own[i] is what of link i keeps off the body, radius negative: nothing.
static void place(const aisle_arm_world *self, const double *q, limb *links, limb *own) {
    aisle_vec2 points[AISLE_ARM_LINKS + 1U];
    (void)aisle_arm_place(self->arm, self->base, q, points);
    for (uint32_t i = 0; i < self->arm->links; i++) {
        links[i] = link_between(points[i], points[i + 1U], self->arm->radius[i]);
        own[i] = links[i];
    }
    const double share = self->exempt / self->arm->length[0];
    own[0] = share < 1.0 ? link_between(aisle_vec2_lerp(points[0], points[1], share), points[1], links[0].radius)
                         : link_between(points[1], points[1], -1.0);
}

static double bounds_gap(const aisle_arm_world *self, const limb *link) {
    const aisle_aabb b = self->bounds;
    return aisle_min(aisle_min(link->box.lo.x - b.lo.x, b.hi.x - link->box.hi.x),
                     aisle_min(link->box.lo.y - b.lo.y, b.hi.y - link->box.hi.y)) -
           link->radius;
}

// ---- gaps

typedef struct least {
    double gap;
    int32_t id;
} least;

static void lower(least *self, double gap, int32_t id) {
    if (gap < self->gap) {
        *self = (least){aisle_max(gap, 0.0), id};
    }
}

// What is this far off cannot lower the gap: two boxes, radii beside them.
static bool is_out_of_sight(const least *self, aisle_aabb a, aisle_aabb b, double radii) {
    const double dx = aisle_max(0.0, aisle_max(a.lo.x - b.hi.x, b.lo.x - a.hi.x));
    const double dy = aisle_max(0.0, aisle_max(a.lo.y - b.hi.y, b.lo.y - a.hi.y)), sight = self->gap + radii;
    return dx * dx + dy * dy >= sight * sight;
}

static void lower_by_hull(least *self, const limb *link, const aisle_convex *hull, bool plain, int32_t id) {
    const double radii = link->radius + hull->radius;
    lower(self, aisle_arm_axis_gap(hull, plain, link->axis[0], link->axis[1], self->gap + radii) - radii, id);
}

// To all but the arm itself, within best->gap.
static void lower_by_world(const aisle_arm_world *self, const limb *links, const limb *own, uint32_t i, least *best) {
    lower(best, bounds_gap(self, &links[i]), AISLE_LAYOUT_ID_BOUNDS);
    for (uint32_t k = 0; k < self->count && best->gap > 0.0; k++) {
        const aisle_arm_block *block = &self->block[k];
        if (!is_out_of_sight(best, links[i].box, block->box, links[i].radius)) {
            lower_by_hull(best, &links[i], &block->shape, block->plain, block->id);
        }
    }
    if (own[i].radius >= 0.0 && !is_out_of_sight(best, own[i].box, self->body_box, own[i].radius)) {
        lower_by_hull(best, &own[i], &self->body, self->body_plain, AISLE_ARM_ID_BODY);
    }
}

// Of three links, the last one to the first.
static void lower_by_arm(const limb *links, least *best) {
    const double radii = links[0].radius + links[2].radius;
    if (!is_out_of_sight(best, links[2].box, links[0].box, radii)) {
        const double apart = aisle_segment_gap(links[2].axis[0], links[2].axis[1], links[0].axis[0], links[0].axis[1]);
        lower(best, apart - radii, AISLE_ARM_ID_ARM);
    }
}

double aisle_arm_world_gap(const aisle_arm_world *self, const double *q, double cap, double *gaps, int32_t *id) {
    limb links[AISLE_ARM_LINKS], own[AISLE_ARM_LINKS];
    least best = {cap, 0};
    place(self, q, links, own);
    for (uint32_t i = 0; i < self->arm->links; i++) {
        least mine = {cap, 0};
        lower_by_world(self, links, own, i, &mine);
        if (i == 2U) {
            lower_by_arm(links, &mine);
        }
        lower(&best, mine.gap, mine.id);
        if (gaps != NULL) {
            gaps[i] = mine.gap;
        }
    }
    if (id != NULL) {
        *id = best.id;
    }
    return best.gap;
}

// ---- depth

// Length of the axis within the plain hull (Cyrus & Beck 1978): cut by one edge after the other.
static double length_inside(const limb *link, const aisle_convex *shape) {
    const aisle_vec2 d = aisle_vec2_sub(link->axis[1], link->axis[0]);
    double from = 0.0, to = 1.0;
    for (uint32_t i = 0; shape->n > 2U && i < shape->n && from < to; i++) {
        const aisle_vec2 a = shape->v[i], edge = aisle_vec2_sub(shape->v[(i + 1U) % shape->n], a);
        const double at = aisle_vec2_cross(edge, aisle_vec2_sub(link->axis[0], a)), rate = aisle_vec2_cross(edge, d);
        if (rate > 0.0) {
            from = aisle_max(from, -at / rate);
        } else if (rate < 0.0) {
            to = aisle_min(to, -at / rate);
        } else if (at < 0.0) {
            to = from;
        }
    }
    return shape->n > 2U && to > from ? (to - from) * aisle_vec2_length(d) : 0.0;
}

static double depth_in(const limb *link, const aisle_convex *shape, bool plain) {
    const double want = link->radius + shape->radius + AISLE_ARM_KEEP;
    const double gap = aisle_arm_axis_gap(shape, plain, link->axis[0], link->axis[1], want);
    return gap > 0.0 ? want - gap : want + length_inside(link, shape);
}

static double link_depth(const aisle_arm_world *self, const limb *links, const limb *own, uint32_t i) {
    const double want = links[i].radius + AISLE_ARM_KEEP;
    double sum = aisle_max(0.0, AISLE_ARM_KEEP - bounds_gap(self, &links[i]));
    for (uint32_t k = 0; k < self->count; k++) {
        if (aisle_aabb_gap(links[i].box, self->block[k].box) < want) {
            sum += depth_in(&links[i], &self->block[k].shape, self->block[k].plain);
        }
    }
    if (own[i].radius >= 0.0 && aisle_aabb_gap(own[i].box, self->body_box) < want) {
        sum += depth_in(&own[i], &self->body, self->body_plain);
    }
    if (i == 2U) {
        const aisle_convex first = {links[0].axis, 2U, links[0].radius};
        sum += depth_in(&links[2], &first, false);
    }
    return sum;
}

double aisle_arm_world_depth(const aisle_arm_world *self, const double *q) {
    limb links[AISLE_ARM_LINKS], own[AISLE_ARM_LINKS];
    double sum = 0.0;
    place(self, q, links, own);
    for (uint32_t i = 0; i < self->arm->links; i++) {
        sum += link_depth(self, links, own, i);
    }
    return sum;
}

// ---- room

// Lowers *h to how far the parameter may run to either side while what moves by slope * h + bend * h^2 at most stays free.
static void lower_step(double slope, double bend, double gap, double *h) {
    const double room = gap - 0.5 * AISLE_ARM_KEEP, below = slope + sqrt(slope * slope + 4.0 * bend * room);
    if (below * *h > 2.0 * room) {
        *h = 2.0 * room / below;
    }
}

bool aisle_arm_world_room(const aisle_arm_world *self, const double *q, const aisle_arm_pace *pace, double *h) {
    limb links[AISLE_ARM_LINKS], own[AISLE_ARM_LINKS];
    const uint32_t count = self->arm->links;
    place(self, q, links, own);
    for (uint32_t i = count + (count == 3U ? 1U : 0U); i-- > 0U;) { // from the end: it moves most
        const double need = pace->slope[i] * *h + pace->bend[i] * *h * *h + 0.5 * AISLE_ARM_KEEP;
        least best = {aisle_max(need, AISLE_ARM_KEEP), 0};
        if (i < count) {
            lower_by_world(self, links, own, i, &best);
        } else {
            lower_by_arm(links, &best);
        }
        if (best.gap < AISLE_ARM_KEEP) {
            return false;
        }
        lower_step(pace->slope[i], pace->bend[i], best.gap, h);
    }
    return true;
}
