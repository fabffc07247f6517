#include "plan/local.h"

#include "base/angle.h"
#include "base/check.h"
#include "plan/local_parts.h"

#include <math.h>

#define PULL 0.9      // of the distance to a place, in F
#define BAR_NEAR 1.0  // m, bars nearer than this grow
#define LONGER 1.08   // cost-to-go is told so much too long, at most
#define LONGER_BY 0.5 // m, and what rejoining may cost beside
#define COORD_MAX 1e5 // m

typedef enum phase { TOGO, POSITION, SWARM, TIDY, ENDED } phase;

void aisle_local_carve(aisle_local *self, aisle_arena *arena, uint32_t cells) {
    aisle_togo_carve(&self->togo, arena, cells);
    self->work = (float *)aisle_arena_take(arena, AISLE_PSO_WORK_LEN(2, AISLE_PSO_PARTICLES_MAX), sizeof(float));
    self->mover = (aisle_local_mover *)aisle_arena_take(arena, AISLE_MOVERS_MAX, sizeof(aisle_local_mover));
    self->near = (uint16_t *)aisle_arena_take(arena, AISLE_MOVERS_MAX, sizeof(uint16_t));
    self->points = (aisle_vec2 *)aisle_arena_take(arena, AISLE_LOCAL_POINTS_MAX, sizeof(aisle_vec2));
    self->phase = ENDED;
    self->end = AISLE_LOCAL_STUCK;
}

// ---- begin

static bool is_within(double x, double lo, double hi) {
    return x >= lo && x <= hi; // false for NaN
}

static bool is_place(aisle_vec2 p) {
    return is_within(p.x, -COORD_MAX, COORD_MAX) && is_within(p.y, -COORD_MAX, COORD_MAX);
}

static bool way_is_good(const aisle_local_request *r) {
    if (r->way_count > AISLE_LOCAL_WAY_MAX || (r->way_count > 0U && r->way == NULL)) {
        return false;
    }
    for (uint32_t i = 0; i < r->way_count; i++) {
        if (!is_place(r->way[i])) {
            return false;
        }
    }
    return r->way_count == 0U || aisle_vec2_distance(r->way[r->way_count - 1U], r->goal) <= 1e-6;
}

static bool request_is_good(const aisle_local_request *r) {
    return r->space != NULL && is_place(r->from) && is_place(r->goal) &&
           is_within(r->heading, -AISLE_ANGLE_MAX, AISLE_ANGLE_MAX) && is_within(r->speed, 1e-3, 1e3) &&
           is_within(r->range, 0.0, AISLE_LOCAL_RANGE_MAX) && is_within(r->safety, 0.0, COORD_MAX) &&
           is_within(r->drift, 0.0, COORD_MAX) && is_within(r->longest, 0.0, COORD_MAX) &&
           is_within(r->lattice, 0.0, AISLE_LOCAL_RANGE_MAX) && r->particles != 1U &&
           r->particles <= AISLE_PSO_PARTICLES_MAX && r->iterations <= 10000U &&
           aisle_vec2_distance(r->from, r->goal) >= 1e-6 && way_is_good(r);
}

static double togo_at(const aisle_local *self, aisle_vec2 p) {
    return self->request.beeline ? aisle_vec2_distance(p, self->request.goal) : aisle_togo_at(&self->togo, p);
}

// A mover or bar, as far as it leaves the start's cell an open side.
static void close_place(aisle_local *self, aisle_vec2 a, aisle_vec2 b, double radius) {
    const aisle_vec2 from = self->request.from;
    aisle_togo_close(&self->togo, a, b, aisle_min(radius, aisle_segment_gap(a, b, from, from)));
}

static void close_mover(aisle_local *self, const aisle_local_mover *m) {
    const aisle_space *space = self->request.space;
    const bool along = space->mode == AISLE_SPACE_ALONG;
    const double body = along ? space->vehicle->inner_radius : space->vehicle->outer_radius;
    const double lasts = m->until < (double)INFINITY ? m->until : 0.0;
    close_place(self, m->at, aisle_vec2_add(m->at, aisle_vec2_scale(m->velocity, lasts)), m->keep + body);
}

// With the cost-to-go as far as it is known.
static void begin_round(aisle_local *self) {
    self->points[0] = self->request.from;
    self->count = 1;
    self->here_s = 0.0;
    self->phase = self->request.beeline ? POSITION : TOGO;
    if (self->request.beeline) {
        self->level = togo_at(self, self->request.from);
    }
}

// With nothing known.
static void begin_anew(aisle_local *self) {
    const aisle_local_request *r = &self->request;
    self->bars = 0;
    if (!r->beeline) {
        aisle_togo_start(&self->togo, r->space->grid, r->space->reach, r->from, r->goal);
        aisle_togo_end_at_start(&self->togo); // each position is nearer to the goal than the one before
        if (self->sure) {
            aisle_togo_insist(&self->togo, r->space->reach);
        }
        for (uint32_t i = 0; i < self->movers; i++) {
            if (self->mover[i].closed) {
                close_mover(self, &self->mover[i]);
            }
        }
    }
    begin_round(self);
}

aisle_status aisle_local_start(aisle_local *self, const aisle_local_request *request) {
    if (request == NULL || !request_is_good(request)) {
        return AISLE_ERR_ARG;
    }
    self->request = *request;
    const float range = (float)(request->range > 0.0 ? request->range : AISLE_LOCAL_RANGE);
    self->lo[0] = self->lo[1] = -range;
    self->hi[0] = self->hi[1] = range;
    self->round = self->lines = self->relocations = self->units = 0;
    self->blocker = 0;
    self->sure = true;
    self->fresh = self->rejoin = 0;
    self->end = AISLE_LOCAL_STUCK;
    aisle_local_take_movers(self);
    self->turns_at_from = request->space->mode == AISLE_SPACE_FREE_TURN ||
                          aisle_space_turn_free(request->space, request->from, &self->units);
    begin_anew(self);
    return AISLE_OK;
}

// ---- one position

static aisle_vec2 here_of(const aisle_local *self) {
    return self->points[self->count - 1U];
}

// The place a particle stands for.
static aisle_vec2 place_of(const aisle_local *self, const float *x) {
    const double step = self->request.lattice;
    const aisle_vec2 p = aisle_vec2_add(here_of(self), aisle_vec2_of((double)x[0], (double)x[1]));
    return step > 0.0 ? aisle_vec2_of(floor(p.x / step + 0.5) * step, floor(p.y / step + 0.5) * step) : p;
}

static aisle_cost_pair cost(void *ctx, const float *x) {
    static const aisle_cost_pair not_allowed = {INFINITY, INFINITY};
    aisle_local *self = (aisle_local *)ctx;
    const aisle_vec2 here = here_of(self), p = place_of(self, x);
    const double far = aisle_vec2_distance(here, p), togo = togo_at(self, p);
    const double least = self->request.lattice > 0.0 ? 0.5 * self->request.lattice : 0.02;
    self->units += 1U;
    if (far > (double)self->hi[0] || far < least || !(togo < (double)INFINITY) ||
        !aisle_local_line_free(self, here, p, self->here_s, true)) {
        return not_allowed;
    }
    const bool turns = self->request.space->mode == AISLE_SPACE_ALONG;
    if (turns && !aisle_space_turn_free(self->request.space, p, &self->units)) {
        return not_allowed;
    }
    return (aisle_cost_pair){0.0F, (float)(togo + (self->request.beeline ? 0.0 : PULL * far))};
}

// Down the cost-to-go from `here`, cells in range. Returns how many.
#define DOWN_MAX 128U
static uint32_t walk_down(const aisle_local *self, aisle_vec2 here, aisle_vec2 *down) {
    uint32_t n = 0;
    aisle_vec2 p = here;
    while (n < DOWN_MAX && aisle_togo_next(&self->togo, p, &p) && aisle_vec2_distance(here, p) <= (double)self->hi[0]) {
        down[n++] = p;
    }
    return n;
}

// The farthest of these in sight, as the first particle's place.
static bool guess_from(aisle_local *self, aisle_vec2 here) {
    aisle_vec2 down[DOWN_MAX];
    for (uint32_t n = self->request.beeline ? 0U : walk_down(self, here, down); n-- > 0U;) {
        const aisle_vec2 by = aisle_vec2_sub(down[n], here);
        self->guess[0] = (float)by.x;
        self->guess[1] = (float)by.y;
        if (cost(self, self->guess).value < INFINITY) {
            return true;
        }
    }
    return false;
}

static uint64_t seed_of(const aisle_local *self) {
    return self->request.seed * 0x9E3779B97F4A7C15ULL + (uint64_t)self->round * 4099U + self->count;
}

static void begin_swarm(aisle_local *self) {
    const aisle_local_request *r = &self->request;
    const uint32_t particles = r->particles > 0U ? r->particles : AISLE_LOCAL_PARTICLES;
    const uint32_t iterations = r->iterations > 0U ? r->iterations : AISLE_LOCAL_ITERATIONS;
    const bool guessed = guess_from(self, here_of(self));
    self->config = (aisle_pso_config){.cost = cost,
                                      .cost_ctx = self,
                                      .lo = self->lo,
                                      .hi = self->hi,
                                      .guess = guessed ? self->guess : NULL,
                                      .inertia = AISLE_PSO_FALLING,
                                      .seed = seed_of(self),
                                      .eval_max = particles * iterations,
                                      .stall_max = particles * AISLE_LOCAL_STALL,
                                      .value_goal = -INFINITY,
                                      .dim = 2,
                                      .particles = (uint16_t)particles,
                                      .relocate = AISLE_LOCAL_RELOCATE};
    const aisle_status st =
        aisle_pso_start(&self->pso, &self->config, self->work, AISLE_PSO_WORK_LEN(2, AISLE_PSO_PARTICLES_MAX));
    AISLE_ASSERT(st == AISLE_OK);
    self->phase = SWARM;
}

static double length_of(const aisle_vec2 *points, uint32_t from, uint32_t count) {
    double sum = 0.0;
    for (uint32_t i = from + 1U; i < count; i++) {
        sum += aisle_vec2_distance(points[i - 1U], points[i]);
    }
    return sum;
}

static void finish(aisle_local *self, aisle_local_end end) {
    self->end = end;
    self->phase = end > AISLE_LOCAL_REJOINED ? ENDED : TIDY;
    self->at = 1U;
    self->pass = 0;
    self->changed = false;
    if (self->phase == ENDED) {
        self->count = self->fresh = 0;
    }
}

static bool rejoins(aisle_local *self, aisle_vec2 here) {
    const aisle_local_request *r = &self->request;
    aisle_vec2 at;
    uint32_t first;
    if (r->way_count < 2U || !aisle_local_find_rejoin(self, here, self->here_s, &at, &first)) {
        return false;
    }
    const double rest = aisle_vec2_distance(at, r->way[first]) + length_of(r->way, first, r->way_count);
    if (aisle_vec2_distance(here, at) + rest > LONGER * self->level + LONGER_BY) {
        return false;
    }
    self->points[self->count++] = at;
    self->fresh = self->count;
    first += aisle_vec2_distance(at, r->way[first]) < 1e-6 ? 1U : 0U;
    self->rejoin = first;
    for (uint32_t i = first; i < r->way_count; i++) {
        self->points[self->count++] = r->way[i];
    }
    finish(self, AISLE_LOCAL_REJOINED);
    return true;
}

static void look_around(aisle_local *self) {
    const aisle_vec2 here = here_of(self), goal = self->request.goal;
    aisle_local_list_near(self, here, self->here_s);
    if (aisle_vec2_distance(here, goal) <= (double)self->hi[0] &&
        aisle_local_line_free(self, here, goal, self->here_s, true)) {
        self->points[self->count++] = goal;
        self->fresh = self->count;
        finish(self, AISLE_LOCAL_GOAL);
    } else if (!rejoins(self, here)) {
        begin_swarm(self);
    }
}

// ---- where it goes no farther

static void bar_place(aisle_local *self, aisle_vec2 p) {
    double radius = 0.6 * self->togo.size;
    for (uint32_t i = 0; i < self->bars; i++) {
        radius += aisle_vec2_distance(self->bar[i].at, p) < BAR_NEAR ? 0.5 * self->togo.size : 0.0;
    }
    self->bar[self->bars++] = (aisle_local_bar){p, radius};
    close_place(self, p, p, radius);
}

// What hinders the line to the nearest place down the cost-to-go that is not in sight is closed. False: nothing does.
static bool close_hindrance(aisle_local *self) {
    aisle_vec2 down[DOWN_MAX];
    const aisle_vec2 here = here_of(self);
    const uint32_t n = walk_down(self, here, down);
    for (uint32_t i = 0; i < n; i++) {
        const uint32_t k = aisle_local_meets(self, here, down[i], self->here_s, true);
        if (k != AISLE_LOCAL_NOBODY) {
            self->blocker = self->mover[k].id;
        }
        if (k != AISLE_LOCAL_NOBODY && !self->mover[k].closed) {
            self->mover[k].closed = true;
            close_mover(self, &self->mover[k]);
            return true;
        }
        if (k != AISLE_LOCAL_NOBODY || !aisle_local_line_free(self, here, down[i], self->here_s, true)) {
            bar_place(self, down[i]);
            return true;
        }
    }
    return false;
}

static void stop_being_sure(aisle_local *self) {
    self->sure = false;
    begin_anew(self);
}

static void give_up_round(aisle_local *self) {
    if (!self->request.beeline && self->sure && self->round + 1U >= AISLE_LOCAL_SURE) {
        self->round++;
        stop_being_sure(self);
    } else if (self->request.beeline || ++self->round >= AISLE_LOCAL_ROUNDS || !close_hindrance(self)) {
        finish(self, AISLE_LOCAL_STUCK);
    } else {
        begin_round(self);
    }
}

static void move_on(aisle_local *self) {
    const float *best = aisle_pso_best(&self->pso);
    self->relocations += self->pso.relocations;
    if (best == NULL || self->count > AISLE_LOCAL_STEPS) {
        give_up_round(self);
        return;
    }
    const aisle_vec2 here = here_of(self), p = place_of(self, best);
    const double level = togo_at(self, p);
    if (!(level < self->level)) {
        give_up_round(self);
        return;
    }
    self->level = level;
    self->here_s += aisle_vec2_distance(here, p) / self->request.speed;
    self->points[self->count++] = p;
    self->phase = POSITION;
}

// Of the movers closed, the nearest one.
static void name_blocker(aisle_local *self) {
    double least = (double)INFINITY;
    for (uint32_t i = 0; i < self->movers; i++) {
        const double far = aisle_vec2_distance(self->mover[i].at, self->request.from);
        if (self->mover[i].closed && far < least) {
            least = far;
            self->blocker = self->mover[i].id;
        }
    }
}

static void search_togo(aisle_local *self, uint32_t units) {
    uint32_t spent = 0;
    const aisle_status st = aisle_togo_step(&self->togo, units, &spent);
    self->units += spent;
    if (st == AISLE_OK) {
        self->level = togo_at(self, self->request.from);
        self->phase = POSITION;
        if (self->request.longest > 0.0 && self->level > LONGER * self->request.longest + self->togo.size) {
            finish(self, AISLE_LOCAL_LONG);
        }
    } else if (st == AISLE_PARTIAL && self->sure) {
        stop_being_sure(self);
    } else if (st == AISLE_PARTIAL) {
        name_blocker(self);
        finish(self, self->bars > 0U ? AISLE_LOCAL_STUCK : AISLE_LOCAL_CLOSED);
    }
}

aisle_status aisle_local_step(aisle_local *self, uint32_t units, uint32_t *spent) {
    while (self->phase != ENDED && self->units < units) {
        switch ((phase)self->phase) {
        case TOGO:
            search_togo(self, units - self->units);
            break;
        case POSITION:
            look_around(self);
            break;
        case SWARM:
            if (aisle_pso_step(&self->pso, 1U) != AISLE_BUSY) {
                move_on(self);
            }
            break;
        default:
            if (!aisle_local_tidy(self)) {
                self->length = length_of(self->points, 0U, self->count);
                self->phase = ENDED;
            }
            break;
        }
    }
    *spent += self->units;
    self->units = 0;
    if (self->phase != ENDED) {
        return AISLE_BUSY;
    }
    return self->end <= AISLE_LOCAL_REJOINED ? AISLE_OK : AISLE_PARTIAL;
}
