#include "world/shape.h"

#include "base/angle.h"
#include "base/check.h"

#include <float.h>

#define AREA_MIN 1e-8        // m2
#define EDGE_SQ_MIN 1e-30    // m2; a shorter edge is read as its first vertex
#define WOUND_TWICE 1.5      // shoelace area over the hull's: 1 if wound once, 2 if twice
#define SHAPE_POINTS_MAX 32U // of any shape

static double shoelace(const aisle_vec2 *v, uint32_t n) {
    double twice = 0.0;
    for (uint32_t i = 1; i + 1U < n; i++) { // about v[0]: keeps digits far from the origin
        twice += aisle_vec2_cross(aisle_vec2_sub(v[i], v[0]), aisle_vec2_sub(v[i + 1U], v[0]));
    }
    return 0.5 * twice;
}

static bool all_in_range(const aisle_vec2 *v, uint32_t n) {
    for (uint32_t i = 0; i < n; i++) { // written so that NaN fails
        if (!(fabs(v[i].x) <= AISLE_SHAPE_COORD_MAX && fabs(v[i].y) <= AISLE_SHAPE_COORD_MAX)) {
            return false;
        }
    }
    return true;
}

// No vertex to the right of the edge from v[i] by more than the dents could explain.
static bool all_left_of_edge(const aisle_vec2 *v, uint32_t n, uint32_t i) {
    const aisle_vec2 edge = aisle_vec2_sub(v[(i + 1U) % n], v[i]);
    const double length = aisle_vec2_length(edge);
    for (uint32_t k = 0; k < n; k++) {
        const aisle_vec2 to = aisle_vec2_sub(v[k], v[i]);
        if (aisle_vec2_cross(edge, to) < -AISLE_SHAPE_DENT * (length + aisle_vec2_length(to))) {
            return false;
        }
    }
    return true;
}

bool aisle_convex_is_valid(const aisle_vec2 *v, uint32_t n, uint32_t max_n) {
    AISLE_ASSERT(max_n <= SHAPE_POINTS_MAX);
    if (n < 3U || n > max_n || !all_in_range(v, n)) {
        return false;
    }
    const double area = shoelace(v, n);
    if (area <= AREA_MIN) {
        return false;
    }
    for (uint32_t i = 0; i < n; i++) {
        if (!all_left_of_edge(v, n, i)) {
            return false;
        }
    }
    aisle_vec2 hull[SHAPE_POINTS_MAX];
    return area < WOUND_TWICE * shoelace(hull, aisle_convex_hull(v, n, hull));
}

aisle_aabb aisle_convex_aabb(const aisle_convex *shape) {
    AISLE_ASSERT(shape->n >= 1U && shape->n <= SHAPE_POINTS_MAX);
    aisle_aabb box = {shape->v[0], shape->v[0]};
    for (uint32_t i = 1; i < shape->n; i++) {
        box.lo.x = aisle_min(box.lo.x, shape->v[i].x);
        box.lo.y = aisle_min(box.lo.y, shape->v[i].y);
        box.hi.x = aisle_max(box.hi.x, shape->v[i].x);
        box.hi.y = aisle_max(box.hi.y, shape->v[i].y);
    }
    return aisle_aabb_grow(box, shape->radius);
}

double aisle_aabb_gap(aisle_aabb a, aisle_aabb b) {
    const double dx = aisle_max(0.0, aisle_max(a.lo.x - b.hi.x, b.lo.x - a.hi.x));
    const double dy = aisle_max(0.0, aisle_max(a.lo.y - b.hi.y, b.lo.y - a.hi.y));
    return sqrt(dx * dx + dy * dy);
}

bool aisle_aabb_meets(aisle_aabb box, aisle_vec2 a, aisle_vec2 b) {
    const aisle_vec2 d = aisle_vec2_sub(b, a), n = aisle_vec2_of(-d.y, d.x);
    const aisle_aabb way = {{aisle_min(a.x, b.x), aisle_min(a.y, b.y)}, {aisle_max(a.x, b.x), aisle_max(a.y, b.y)}};
    const aisle_vec2 corner[4] = {box.lo, {box.hi.x, box.lo.y}, box.hi, {box.lo.x, box.hi.y}};
    bool left = false, right = false;
    for (uint32_t i = 0; i < 4U; i++) {
        const double side = aisle_vec2_dot(aisle_vec2_sub(corner[i], a), n);
        left = left || side >= 0.0;
        right = right || side <= 0.0;
    }
    return left && right && aisle_aabb_overlap(box, way);
}

static double inverse_or_zero(double length_sq) {
    return length_sq > EDGE_SQ_MIN ? 1.0 / length_sq : 0.0;
}

// Squared distance from the tip of `to` to the segment from 0 to `edge`.
static double point_segment_sq(aisle_vec2 to, aisle_vec2 edge, double inverse_sq) {
    const double t = aisle_clamp(aisle_vec2_dot(to, edge) * inverse_sq, 0.0, 1.0);
    const aisle_vec2 d = aisle_vec2_sub(to, aisle_vec2_scale(edge, t));
    return aisle_vec2_dot(d, d);
}

// All of a further left of the line through `edge` at v than `most_left` (a cross product): asked of a's own edge
// because the short edges around a dent may point anywhere, and then have a's inside on their right.
static bool is_all_left_of(const aisle_convex *a, aisle_vec2 v, aisle_vec2 edge, double most_left) {
    for (uint32_t k = 0; k < a->n; k++) {
        if (aisle_vec2_cross(edge, aisle_vec2_sub(a->v[k], v)) <= most_left) {
            return false;
        }
    }
    return true;
}

// Lowers *best_sq to the least squared distance from b's vertices to the edge of a from v; *left: how far left of the
// edge's line they reach, as cross products.
static void measure_edge(const aisle_convex *b, aisle_vec2 v, aisle_vec2 edge, double *best_sq, double left[2]) {
    const double inverse_sq = inverse_or_zero(aisle_vec2_dot(edge, edge));
    left[0] = DBL_MAX;
    left[1] = -DBL_MAX;
    for (uint32_t k = 0; k < b->n; k++) {
        const aisle_vec2 to = aisle_vec2_sub(b->v[k], v);
        const double cross = aisle_vec2_cross(edge, to);
        left[0] = aisle_min(left[0], cross);
        left[1] = aisle_max(left[1], cross);
        *best_sq = aisle_min(*best_sq, point_segment_sq(to, edge, inverse_sq));
    }
}

// Lowers *best_sq to the least squared distance from b's vertices to a's edges; true if one of a's edges separates
// them. A lone point has no edge, and its distance is found from b's side; two points have one edge with two sides.
static bool sweep_edges(const aisle_convex *a, const aisle_convex *b, double *best_sq) {
    bool apart = false;
    double left[2];
    if (a->n == 2U) {
        measure_edge(b, a->v[0], aisle_vec2_sub(a->v[1], a->v[0]), best_sq, left);
        return left[0] > 0.0 || left[1] < 0.0;
    }
    for (uint32_t i = 0; a->n > 2U && i < a->n; i++) {
        const aisle_vec2 edge = aisle_vec2_sub(a->v[i + 1U < a->n ? i + 1U : 0U], a->v[i]);
        measure_edge(b, a->v[i], edge, best_sq, left);
        apart = apart || (left[1] < 0.0 && is_all_left_of(a, a->v[i], edge, left[1]));
    }
    return apart;
}

static double hull_gap(const aisle_convex *a, const aisle_convex *b) {
    if (a->n <= 2U && b->n <= 2U) { // no inside: normals of edges alone need not separate them
        return aisle_segment_gap(a->v[0], a->v[a->n - 1U], b->v[0], b->v[b->n - 1U]);
    }
    double best_sq = DBL_MAX;
    const bool by_a = sweep_edges(a, b, &best_sq);
    const bool by_b = sweep_edges(b, a, &best_sq);
    return (by_a || by_b) ? sqrt(best_sq) : 0.0;
}

double aisle_convex_gap(const aisle_convex *a, const aisle_convex *b) {
    AISLE_ASSERT(a->n >= 1U && a->n <= SHAPE_POINTS_MAX && b->n >= 1U && b->n <= SHAPE_POINTS_MAX);
    return aisle_max(0.0, hull_gap(a, b) - a->radius - b->radius);
}

double aisle_convex_point_gap(const aisle_convex *shape, aisle_vec2 p) {
    const aisle_convex point = {&p, 1U, 0.0};
    return aisle_convex_gap(shape, &point);
}

// Strictly on different sides of the line through a0 and a1.
static bool splits(aisle_vec2 a0, aisle_vec2 a1, aisle_vec2 b0, aisle_vec2 b1) {
    const aisle_vec2 edge = aisle_vec2_sub(a1, a0);
    const double s0 = aisle_vec2_cross(edge, aisle_vec2_sub(b0, a0));
    const double s1 = aisle_vec2_cross(edge, aisle_vec2_sub(b1, a0));
    return (s0 < 0.0 && s1 > 0.0) || (s0 > 0.0 && s1 < 0.0);
}

double aisle_segment_gap(aisle_vec2 a0, aisle_vec2 a1, aisle_vec2 b0, aisle_vec2 b1) {
    if (splits(a0, a1, b0, b1) && splits(b0, b1, a0, a1)) {
        return 0.0;
    }
    const aisle_vec2 a = aisle_vec2_sub(a1, a0);
    const aisle_vec2 b = aisle_vec2_sub(b1, b0);
    const double ia = inverse_or_zero(aisle_vec2_dot(a, a));
    const double ib = inverse_or_zero(aisle_vec2_dot(b, b));
    const double from_b =
        aisle_min(point_segment_sq(aisle_vec2_sub(b0, a0), a, ia), point_segment_sq(aisle_vec2_sub(b1, a0), a, ia));
    const double from_a =
        aisle_min(point_segment_sq(aisle_vec2_sub(a0, b0), b, ib), point_segment_sq(aisle_vec2_sub(a1, b0), b, ib));
    return sqrt(aisle_min(from_a, from_b));
}

void aisle_convex_place(const aisle_vec2 *v, uint32_t n, aisle_pose2 pose, aisle_vec2 *out) {
    double sine;
    double cosine;
    aisle_sincos(pose.theta, &sine, &cosine);
    for (uint32_t i = 0; i < n; i++) {
        const aisle_vec2 p = v[i];
        out[i] = aisle_vec2_of(pose.x + (cosine * p.x - sine * p.y), pose.y + (sine * p.x + cosine * p.y));
    }
}

static bool is_before(aisle_vec2 a, aisle_vec2 b) {
    return a.x < b.x || (!(b.x < a.x) && a.y < b.y);
}

static void sift_down(aisle_vec2 *p, uint32_t root, uint32_t n) {
    for (uint32_t child = 2U * root + 1U; child < n; child = 2U * root + 1U) {
        if (child + 1U < n && is_before(p[child], p[child + 1U])) {
            child++;
        }
        if (!is_before(p[root], p[child])) {
            return;
        }
        const aisle_vec2 swap = p[root];
        p[root] = p[child];
        p[child] = swap;
        root = child;
    }
}

static void heap_sort(aisle_vec2 *p, uint32_t n) {
    for (uint32_t root = n / 2U; root-- > 0U;) {
        sift_down(p, root, n);
    }
    for (uint32_t last = n; last-- > 1U;) {
        const aisle_vec2 swap = p[0];
        p[0] = p[last];
        p[last] = swap;
        sift_down(p, 0, last);
    }
}

// Adds p to the chain that starts at chain[first], dropping what would not be a left turn; returns the new size.
static uint32_t chain_add(aisle_vec2 *chain, uint32_t first, uint32_t size, aisle_vec2 p) {
    while (size >= first + 2U && aisle_vec2_cross(aisle_vec2_sub(chain[size - 1U], chain[size - 2U]),
                                                  aisle_vec2_sub(p, chain[size - 2U])) <= 0.0) {
        size--;
    }
    chain[size] = p;
    return size + 1U;
}

static uint32_t drop_repeated(aisle_vec2 *p, uint32_t n) { // p sorted
    uint32_t kept = 1;
    for (uint32_t i = 1; i < n; i++) {
        if (is_before(p[kept - 1U], p[i])) {
            p[kept] = p[i];
            kept++;
        }
    }
    return kept;
}

uint32_t aisle_convex_hull(const aisle_vec2 *points, uint32_t n, aisle_vec2 *out) {
    AISLE_ASSERT(n >= 1U && n <= AISLE_HULL_POINTS_MAX);
    aisle_vec2 sorted[AISLE_HULL_POINTS_MAX];
    aisle_vec2 chain[AISLE_HULL_POINTS_MAX + 1U]; // the upper chain ends on the first point again
    for (uint32_t i = 0; i < n; i++) {
        sorted[i] = points[i];
    }
    heap_sort(sorted, n);
    const uint32_t distinct = drop_repeated(sorted, n);
    uint32_t size = 0;
    for (uint32_t i = 0; i < distinct; i++) { // lower chain, rightwards
        size = chain_add(chain, 0, size, sorted[i]);
    }
    const uint32_t upper = size - 1U;
    for (uint32_t i = distinct - 1U; i-- > 0U;) { // upper chain, back
        size = chain_add(chain, upper, size, sorted[i]);
    }
    size = size > 1U ? size - 1U : size;
    for (uint32_t i = 0; i < size; i++) {
        out[i] = chain[i];
    }
    return size;
}
