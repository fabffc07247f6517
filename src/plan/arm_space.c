#include "plan/arm_space.h"

#define STEP 0.5 // rad
#define SAMPLES 200000U
#define MORE 150U // of a star, after the first path
#define HALVINGS 6U
#define GOAL_BIAS 0.05

static void draw_anywhere(void *context, aisle_rng *rng, double *q) {
    const aisle_cspace *space = &((const aisle_arm_space *)context)->cspace;
    for (uint32_t d = 0; d < space->dim; d++) {
        q[d] = space->lo[d] + (space->hi[d] - space->lo[d]) * (double)aisle_rng_float(rng);
    }
}

static void go_straight(void *context, const double *a, const double *b, double part, double *q) {
    const aisle_cspace *space = &((const aisle_arm_space *)context)->cspace;
    for (uint32_t d = 0; d < space->dim; d++) {
        q[d] = part < 1.0 ? a[d] + part * (b[d] - a[d]) : b[d];
    }
}

static bool is_straight_free(void *context, const double *a, const double *b, uint32_t *units) {
    const aisle_arm_space *self = (const aisle_arm_space *)context;
    return aisle_arm_free_line(self->world, a, b, units);
}

void aisle_arm_space_begin(aisle_arm_space *self, const aisle_arm_world *world) {
    const aisle_arm *arm = world->arm;
    *self = (aisle_arm_space){.world = world};
    self->cspace = (aisle_cspace){
        .dim = arm->links, .context = self, .sample = draw_anywhere, .steer = go_straight, .is_free = is_straight_free};
    for (uint32_t d = 0; d < arm->links; d++) {
        self->cspace.lo[d] = arm->min[d];
        self->cspace.hi[d] = arm->max[d];
        self->cspace.weight[d] = 1.0;
    }
}

aisle_rrt_config aisle_arm_space_rrt(const aisle_arm_space *self, bool star, bool adaptive, double step) {
    return (aisle_rrt_config){.space = &self->cspace,
                              .step = step > 0.0 ? step : STEP,
                              .halvings = adaptive ? HALVINGS : 0U,
                              .star = star,
                              .informed = star,
                              .goal_bias = GOAL_BIAS,
                              .reach = (double)INFINITY,
                              .samples = SAMPLES,
                              .more = MORE};
}
