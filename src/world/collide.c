#include "world/collide.h"

#include <ccd/ccd.h>
#include <stddef.h>

#define TOLERANCE 9e-10 // m, MPR's
#define GROWTH 5e-10    // m, of each shape: together more than what MPR may stop short by
#define HALF_HEIGHT 0.5 // m, of the prisms
#define SKEW_FIRST 0.31 // m, heights of the two centres: must differ
#define SKEW_SECOND -0.17

typedef struct prism {
    const aisle_collide_body *body;
    aisle_vec2 origin; // subtracted from every point
    double skew;
    uint32_t *calls; // support calls of the query, both prisms together
} prism;

static double along(aisle_vec2 p, aisle_vec2 direction) {
    return aisle_vec2_dot(p, direction);
}

static aisle_vec2 farthest(const prism *self, aisle_vec2 direction) {
    const aisle_collide_body *body = self->body;
    const aisle_vec2 *sets[2] = {body->a, body->b};
    aisle_vec2 best = aisle_vec2_sub(body->a[0], self->origin);
    for (uint32_t set = 0; set < 2U && sets[set] != NULL; set++) {
        for (uint32_t i = 0; i < body->n; i++) {
            const aisle_vec2 p = aisle_vec2_sub(sets[set][i], self->origin);
            best = along(p, direction) > along(best, direction) ? p : best;
        }
    }
    return best;
}

// libccd's support function. MPR has no cap of its own: past the limit it is fed NaN, which ends its loops.
static void support(const void *object, const ccd_vec3_t *direction, ccd_vec3_t *out) {
    const prism *self = object;
    (*self->calls)++;
    if (*self->calls > AISLE_COLLIDE_SUPPORT_MAX) {
        ccdVec3Set(out, (double)NAN, (double)NAN, (double)NAN);
        return;
    }
    const aisle_vec2 level = {ccdVec3X(direction), ccdVec3Y(direction)};
    aisle_vec2 p = farthest(self, level);
    const double length = aisle_vec2_length(level);
    if (length > 0.0) {
        p = aisle_vec2_add(p, aisle_vec2_scale(level, (self->body->radius + GROWTH) / length));
    }
    ccdVec3Set(out, p.x, p.y, ccdVec3Z(direction) < 0.0 ? -HALF_HEIGHT : HALF_HEIGHT);
}

static void centre(const void *object, ccd_vec3_t *out) {
    const prism *self = object;
    const aisle_collide_body *body = self->body;
    aisle_vec2 sum = {0.0, 0.0};
    for (uint32_t i = 0; i < body->n; i++) {
        const aisle_vec2 b = body->b == NULL ? body->a[i] : body->b[i];
        sum = aisle_vec2_add(sum, aisle_vec2_sub(body->a[i], self->origin));
        sum = aisle_vec2_add(sum, aisle_vec2_sub(b, self->origin));
    }
    const aisle_vec2 mean = aisle_vec2_scale(sum, 0.5 / (double)body->n);
    ccdVec3Set(out, mean.x, mean.y, self->skew);
}

static bool are_in_range(const aisle_vec2 *points, uint32_t n) { // written so that NaN fails
    for (uint32_t i = 0; i < n; i++) {
        if (!(fabs(points[i].x) <= AISLE_COLLIDE_COORD_MAX && fabs(points[i].y) <= AISLE_COLLIDE_COORD_MAX)) {
            return false;
        }
    }
    return true;
}

static bool is_fit(const aisle_collide_body *body) {
    return body->n >= 1U && body->n <= AISLE_COLLIDE_POINTS_MAX && body->radius >= 0.0 &&
           body->radius <= AISLE_COLLIDE_COORD_MAX && are_in_range(body->a, body->n) &&
           (body->b == NULL || are_in_range(body->b, body->n));
}

static bool intersect(const aisle_collide_body *first, const aisle_collide_body *second, uint32_t *calls) {
    const prism p = {first, first->a[0], SKEW_FIRST, calls};
    const prism q = {second, first->a[0], SKEW_SECOND, calls};
    const ccd_t ccd = {.first_dir = NULL, // of no use to MPR
                       .support1 = support,
                       .support2 = support,
                       .center1 = centre,
                       .center2 = centre,
                       .max_iterations = AISLE_COLLIDE_SUPPORT_MAX,
                       .mpr_tolerance = TOLERANCE};
    return ccdMPRIntersect(&p, &q, &ccd) != 0;
}

bool aisle_collide(const aisle_collide_body *first, const aisle_collide_body *second, aisle_collide_count *count) {
    uint32_t calls = 0;
    bool is_judged = is_fit(first) && is_fit(second);
    const bool touch = is_judged && intersect(first, second, &calls);
    is_judged = is_judged && calls <= AISLE_COLLIDE_SUPPORT_MAX;
    if (count != NULL) {
        count->calls++;
        count->unfit += is_judged ? 0 : 1;
        count->support_max = calls > count->support_max ? calls : count->support_max;
    }
    return touch || !is_judged;
}
