#include "plan/seed.h"

#include "base/check.h"
#include "plan/cost.h"
#include "plan/zones.h"

#include <math.h>

#define SEARCH_BATCH 32U // nodes
#define DEAR_BATCH 3U    // nodes whose inlet may spend a thousand units
#define CORNER_STEPS 32  // places tried along a leg
#define WIDEST_ROOM 0.5  // m beyond the least clearance from which on the widest way does not care

void aisle_seed_carve(aisle_seed *self, aisle_arena *arena, const aisle_limits *limits) {
    aisle_astar_carve(&self->search, arena, limits->cells, limits->open_nodes);
    self->cells = (uint32_t *)aisle_arena_take(arena, AISLE_SEED_CELLS_MAX, sizeof(uint32_t));
    self->factor = (uint16_t *)aisle_arena_take(arena, AISLE_SEED_TABLE, sizeof(uint16_t));
}

// The grid cell a search cell stands for: the middle one of its block, so that every search cell has one.
static uint32_t grid_cell(const aisle_seed *self, uint32_t at) {
    uint32_t w = self->search.cfg.w;
    uint32_t ix = (at % w) * self->stride + self->stride / 2U;
    uint32_t iy = (at / w) * self->stride + self->stride / 2U;
    return iy * self->space->grid->lattice.w + ix;
}

static double step_length(const aisle_seed *self) {
    return self->stride * self->space->grid->lattice.res;
}

static uint16_t factor_at(const aisle_seed *self, uint32_t field) {
    double clearance =
        (sqrt((double)field) - 0.5) * self->space->grid->lattice.res - self->space->vehicle->inner_radius;
    double density = aisle_objective_density(self->objective, clearance, 0.0);
    return (uint16_t)(density * (double)AISLE_ASTAR_FACTOR_ONE + 0.5);
}

static void tabulate(aisle_seed *self) {
    for (uint32_t q = 0; q < AISLE_SEED_TABLE; q++) {
        self->factor[q] = factor_at(self, q);
    }
}

static uint32_t factor_of(const aisle_seed *self, uint32_t cell) {
    uint32_t field = self->space->grid->field[cell];
    uint32_t factor = field < AISLE_SEED_TABLE ? self->factor[field] : factor_at(self, field);
    if (self->objective->has_tolls) {
        aisle_vec2 p = aisle_lattice_centre(&self->space->grid->lattice, cell);
        double toll = aisle_zones_toll_at(self->space->layout, self->objective, p);
        factor += (uint32_t)(aisle_min(toll, AISLE_OBJECTIVE_DENSITY_MAX) * (double)AISLE_ASTAR_FACTOR_ONE + 0.5);
    }
    return factor < AISLE_ASTAR_FACTOR_MAX ? factor : AISLE_ASTAR_FACTOR_MAX;
}

// Are the zones for the step?
static bool is_allowed(const aisle_seed *self, uint32_t from, uint32_t to) {
    const aisle_space *space = self->space;
    const aisle_lattice *lattice = &space->grid->lattice;
    return !aisle_zones_any_directed(space->layout) ||
           aisle_zones_allow(space->layout, aisle_lattice_centre(lattice, grid_cell(self, from)),
                             aisle_lattice_centre(lattice, grid_cell(self, to)), space->zone_room, NULL);
}

static uint32_t enter_free_turn(void *ctx, uint32_t from, uint32_t to, uint8_t dir) {
    aisle_seed *self = (aisle_seed *)ctx;
    (void)dir;
    uint32_t cell = grid_cell(self, to);
    if (!aisle_space_cell_free(self->space, cell, step_length(self), &self->units)) {
        return AISLE_ASTAR_BARRED_CELL;
    }
    return is_allowed(self, from, to) ? factor_of(self, cell) : AISLE_ASTAR_BARRED;
}

// Where a cell of the ROOMIEST search stands. *sure: in its centre, with room for every step to another such. False:
// nowhere.
static bool stand(aisle_seed *self, uint32_t cell, aisle_vec2 *at, bool *sure) {
    aisle_space *space = self->space;
    const aisle_lattice *lattice = &space->grid->lattice;
    *at = aisle_lattice_centre(lattice, cell);
    *sure = aisle_space_cell_free(space, cell, lattice->res, &self->units);
    if (*sure) {
        return true;
    }
    double most =
        (sqrt((double)space->grid->field[cell]) + 0.7072) * lattice->res + space->beyond; // of any point of it
    if (most < space->reach) {
        return false;
    }
    double gap;
    *at = aisle_space_roomiest(space, cell, &gap, &self->units);
    return gap >= space->reach;
}

static uint32_t enter_roomiest(void *ctx, uint32_t from, uint32_t to, uint8_t dir) {
    aisle_seed *self = (aisle_seed *)ctx;
    (void)dir;
    aisle_vec2 a, b;
    bool a_sure, b_sure;
    if (!stand(self, to, &b, &b_sure)) {
        return AISLE_ASTAR_BARRED_CELL;
    }
    bool free = stand(self, from, &a, &a_sure) && ((a_sure && b_sure && is_allowed(self, from, to)) ||
                                                   aisle_space_sweep_free(self->space, a, b, &self->units));
    return free ? factor_of(self, to) : AISLE_ASTAR_BARRED;
}

static uint32_t enter_along(void *ctx, uint32_t from, uint32_t to, uint8_t dir) {
    aisle_seed *self = (aisle_seed *)ctx;
    (void)dir;
    const aisle_grid *grid = self->space->grid;
    uint32_t cell = grid_cell(self, to);
    if (sqrt((double)grid->field[cell]) * grid->lattice.res + self->space->beyond < self->space->reach) {
        return AISLE_ASTAR_BARRED_CELL;
    }
    aisle_vec2 a = aisle_lattice_centre(&grid->lattice, grid_cell(self, from));
    aisle_vec2 b = aisle_lattice_centre(&grid->lattice, cell);
    return aisle_space_sweep_free(self->space, a, b, &self->units) ? factor_of(self, cell) : AISLE_ASTAR_BARRED;
}

static uint32_t enter_width(void *ctx, uint32_t from, uint32_t to, uint8_t dir) {
    const aisle_seed *self = (const aisle_seed *)ctx;
    (void)from;
    (void)dir;
    return self->space->grid->field[grid_cell(self, to)] >= self->open_from ? AISLE_ASTAR_FACTOR_ONE
                                                                            : AISLE_ASTAR_BARRED_CELL;
}

// Cells a bar runs through: no path of neighbours gets past them.
static bool is_barred(const aisle_seed *self, uint32_t cell) {
    aisle_vec2 p = aisle_lattice_centre(&self->space->grid->lattice, cell);
    for (uint32_t i = 0; i < self->bar_count; i++) {
        if (aisle_segment_gap(self->bars[i][0], self->bars[i][1], p, p) <= 0.75 * step_length(self)) {
            return true;
        }
    }
    return false;
}

// As enter_width, but dear near the least clearance: the way keeps to the middle wherever there is more room, so that
// only true narrow places are left on it.
static uint32_t enter_widest(void *ctx, uint32_t from, uint32_t to, uint8_t dir) {
    const aisle_seed *self = (const aisle_seed *)ctx;
    (void)from;
    (void)dir;
    const aisle_grid *grid = self->space->grid;
    uint32_t field = grid->field[grid_cell(self, to)];
    if (field < self->open_from) {
        return AISLE_ASTAR_BARRED_CELL;
    }
    if (self->bar_count > 0U && is_barred(self, grid_cell(self, to))) {
        return AISLE_ASTAR_BARRED_CELL;
    }
    double spare = (sqrt((double)field) - sqrt((double)self->open_from)) * grid->lattice.res / WIDEST_ROOM;
    double near = spare < 1.0 ? 1.0 - spare : 0.0;
    double span = (double)(AISLE_ASTAR_FACTOR_MAX - AISLE_ASTAR_FACTOR_ONE);
    return AISLE_ASTAR_FACTOR_ONE + (uint32_t)(span * near * near);
}

static uint32_t enter_proof(void *ctx, uint32_t from, uint32_t to, uint8_t dir) {
    aisle_seed *self = (aisle_seed *)ctx;
    (void)from;
    (void)dir;
    bool open = aisle_space_cell_holds(self->space, to, self->proof_reach, self->proof_depth, &self->units);
    return open ? AISLE_ASTAR_FACTOR_ONE : AISLE_ASTAR_BARRED_CELL;
}

static bool may_stand(aisle_seed *self, uint32_t cell) {
    return self->space->mode == AISLE_SPACE_ALONG ||
           aisle_space_cell_free(self->space, cell, step_length(self), &self->units);
}

typedef struct joint {
    aisle_vec2 p;  // the station
    bool outbound; // driven from it
    int32_t x, y;  // search cell it lies in
    uint32_t cell; // the best so far
    double away;   // m, of it
} joint;

static void try_joint(aisle_seed *self, const aisle_astar_config *cfg, joint *j, int32_t x, int32_t y) {
    if (x < 0 || y < 0 || x >= (int32_t)cfg->w || y >= (int32_t)cfg->h) {
        return;
    }
    uint32_t at = (uint32_t)y * cfg->w + (uint32_t)x;
    uint32_t cell = grid_cell(self, at);
    aisle_vec2 centre = aisle_lattice_centre(&self->space->grid->lattice, cell);
    double away = aisle_vec2_distance(j->p, centre);
    if (away >= j->away || !may_stand(self, cell)) {
        return;
    }
    aisle_vec2 from = j->outbound ? j->p : centre;
    aisle_vec2 to = j->outbound ? centre : j->p;
    if (away < 1e-9 || aisle_space_body_sweep_free(self->space, from, to, &self->units)) {
        j->away = away;
        j->cell = at;
    }
}

// Nearest search cell that is free and that the footprint reaches straight; square rings outward until one holds some.
static bool join(aisle_seed *self, const aisle_astar_config *cfg, aisle_vec2 p, bool outbound, uint32_t *cell) {
    const aisle_lattice *lattice = &self->space->grid->lattice;
    double nowhere = 2.0 * AISLE_SEED_JOIN;
    joint j = {.p = p, .outbound = outbound, .away = nowhere};
    j.x = (int32_t)floor((p.x - lattice->x0) / step_length(self));
    j.y = (int32_t)floor((p.y - lattice->y0) / step_length(self));
    int32_t rings = (int32_t)(AISLE_SEED_JOIN / step_length(self)) + 1;
    for (int32_t r = 0; r <= rings && j.away >= nowhere; r++) {
        for (int32_t k = -r; k <= r; k++) {
            try_joint(self, cfg, &j, j.x + k, j.y - r);
            try_joint(self, cfg, &j, j.x + k, j.y + r);
            try_joint(self, cfg, &j, j.x - r, j.y + k);
            try_joint(self, cfg, &j, j.x + r, j.y + k);
        }
    }
    *cell = j.cell;
    return j.away < nowhere;
}

static aisle_astar_config search_config(aisle_seed *self, aisle_astar_enter_fn enter) {
    const aisle_lattice *lattice = &self->space->grid->lattice;
    uint32_t k = self->stride; // columns are those whose middle cell the grid has
    return (aisle_astar_config){.enter = enter,
                                .ctx = self,
                                .w = (lattice->w - 1U - k / 2U) / k + 1U,
                                .h = (lattice->h - 1U - k / 2U) / k + 1U};
}

aisle_status aisle_seed_start(aisle_seed *self, aisle_space *space, const aisle_objective *objective, uint32_t stride,
                              aisle_vec2 start, aisle_vec2 goal, aisle_vec2 *points) {
    self->roomiest = stride == AISLE_SEED_ROOMIEST;
    stride = self->roomiest ? 1U : stride;
    AISLE_ASSERT(!self->roomiest || space->mode == AISLE_SPACE_FREE_TURN);
    uint32_t least = space->grid->lattice.w < space->grid->lattice.h ? space->grid->lattice.w : space->grid->lattice.h;
    self->stride = stride <= least ? stride : least;
    self->space = space;
    self->objective = objective;
    self->start = start;
    self->goal = goal;
    self->points = points;
    self->point_count = 0;
    self->units = 0;
    self->for_refusal = false;
    tabulate(self);
    aisle_astar_enter_fn enter = space->mode == AISLE_SPACE_FREE_TURN ? enter_free_turn : enter_along;
    aisle_astar_config cfg = search_config(self, self->roomiest ? enter_roomiest : enter);
    self->search.cfg.w = cfg.w; // grid_cell() needs it before the search has begun
    if (!join(self, &cfg, start, true, &cfg.start) || !join(self, &cfg, goal, false, &cfg.goal)) {
        self->phase = AISLE_SEED_IDLE;
        return AISLE_PARTIAL;
    }
    aisle_status st = aisle_astar_start(&self->search, &cfg);
    AISLE_ASSERT(st == AISLE_OK);
    self->phase = AISLE_SEED_SEARCH;
    return AISLE_OK;
}

static aisle_vec2 path_point(aisle_seed *self, uint32_t i) {
    if (i == 0) {
        return self->start;
    }
    if (i > self->cell_count) {
        return self->goal;
    }
    aisle_vec2 at = aisle_lattice_centre(&self->space->grid->lattice, self->cells[i - 1U]);
    bool sure;
    if (self->roomiest) {
        (void)stand(self, self->cells[i - 1U], &at, &sure);
    }
    return at;
}

// Cost of the way along the path's points from i to j.
static double chain_cost(aisle_seed *self, uint32_t i, uint32_t j) {
    double sum = 0.0;
    for (uint32_t k = i; k < j; k++) {
        aisle_vec2 a = path_point(self, k);
        aisle_vec2 b = path_point(self, k + 1U);
        double clearance = aisle_space_clearance_about(self->space, aisle_vec2_lerp(a, b, 0.5));
        sum += aisle_vec2_distance(a, b) * aisle_objective_density(self->objective, clearance, 0.0) +
               aisle_zones_toll(self->space->layout, self->objective, a, b);
    }
    self->units += (j - i) / 4U;
    return sum;
}

static bool may_cut(aisle_seed *self, uint32_t i, uint32_t j) {
    aisle_vec2 a = path_point(self, i);
    aisle_vec2 b = path_point(self, j);
    if (!aisle_space_sweep_free(self->space, a, b, &self->units)) {
        return false;
    }
    return aisle_objective_is_length(self->objective) ||
           aisle_leg_cost(self->space, self->objective, a, b, &self->units) <= chain_cost(self, i, j) * (1.0 + 1e-3);
}

// Index of the point to go to straight from point i: doubling while it works, then halving the doubt.
static uint32_t farthest_from(aisle_seed *self, uint32_t i) {
    uint32_t end = self->cell_count + 1U;
    uint32_t good = i + 1U;
    uint32_t step = 2U;
    uint32_t bad = end + 1U;
    while (good < end) {
        uint32_t probe = good + step < end ? good + step : end;
        if (!may_cut(self, i, probe)) {
            bad = probe;
            break;
        }
        good = probe;
        step *= 2U;
    }
    while (bad - good > 1U && bad <= end) {
        uint32_t probe = good + (bad - good) / 2U;
        if (may_cut(self, i, probe)) {
            good = probe;
        } else {
            bad = probe;
        }
    }
    return good;
}

// Appends points until `units` are spent or the goal is reached.
static aisle_status straighten(aisle_seed *self, uint32_t units) {
    uint32_t end = self->cell_count + 1U;
    while (self->at < end && self->units < units) {
        if (self->point_count + 1U >= AISLE_SEED_POINTS_MAX) {
            return AISLE_ERR_CAPACITY;
        }
        self->at = farthest_from(self, self->at);
        aisle_vec2 p = path_point(self, self->at);
        if (aisle_vec2_distance(p, self->points[self->point_count - 1U]) > 1e-6 || self->at == end) {
            self->points[self->point_count++] = p;
        }
    }
    return self->at < end ? AISLE_BUSY : AISLE_OK;
}

// ---- corners

// Puts corner i at p if the ways to and from it are free, a neighbour left out if need be. False: they are not.
static bool put_corner(aisle_seed *self, uint32_t i, aisle_vec2 p) {
    static const uint32_t left_out[][2] = {{0, 0}, {1, 0}, {0, 1}};
    for (int k = 0; k < 3; k++) {
        uint32_t before = left_out[k][0];
        uint32_t after = left_out[k][1];
        if (i < 1U + before || i + 1U + after >= self->point_count ||
            !aisle_space_sweep_free(self->space, self->points[i - 1U - before], p, &self->units) ||
            !aisle_space_sweep_free(self->space, p, self->points[i + 1U + after], &self->units)) {
            continue;
        }
        self->points[i - before] = p;
        self->point_count -= before + after;
        for (uint32_t to = i - before + 1U; before + after > 0U && to < self->point_count; to++) {
            self->points[to] = self->points[to + 1U];
        }
        self->at = i - before + 1U;
        return true;
    }
    return false;
}

// Moves corner i along the line from `along` through it, beyond it, to where the body can turn. False: nowhere.
static bool move_corner(aisle_seed *self, uint32_t i, aisle_vec2 along) {
    aisle_vec2 b = self->points[i];
    double length = aisle_vec2_distance(along, b);
    if (length < 1e-6) {
        return false;
    }
    aisle_vec2 unit = aisle_vec2_scale(aisle_vec2_sub(b, along), 1.0 / length);
    double reach = 2.0 * self->space->vehicle->outer_radius;
    for (int k = 1; k <= CORNER_STEPS; k++) {
        aisle_vec2 p = aisle_vec2_add(b, aisle_vec2_scale(unit, reach * k / CORNER_STEPS));
        if (aisle_space_turn_free(self->space, p, &self->units) && put_corner(self, i, p)) {
            return true;
        }
    }
    return false;
}

static aisle_status widen_corners(aisle_seed *self, uint32_t units) {
    while (self->at + 1U < self->point_count && self->units < units) {
        uint32_t i = self->at++;
        if (!aisle_space_turn_free(self->space, self->points[i], &self->units) &&
            !move_corner(self, i, self->points[i + 1U])) {
            (void)move_corner(self, i, self->points[i - 1U]);
        }
    }
    return self->at + 1U < self->point_count ? AISLE_BUSY : AISLE_OK;
}

// Expands nodes until `units` are spent: in small batches, since the inlets spend too, and always the same ones, so
// that
// the slices make no difference.
static aisle_status search(aisle_seed *self, uint32_t units) {
    aisle_status st = AISLE_BUSY;
    bool dear = self->roomiest || (self->for_refusal && self->search.cfg.enter == enter_proof);
    uint32_t batch = dear ? DEAR_BATCH : SEARCH_BATCH;
    while (st == AISLE_BUSY && self->units < units) {
        uint32_t before = self->search.expanded;
        st = aisle_astar_step(&self->search, batch);
        self->units += self->search.expanded - before + 1U; // 1: a batch of stale entries is work too
    }
    return st;
}

// The path found, as cells of the grid.
static aisle_status fetch_path(aisle_seed *self) {
    aisle_status st = aisle_astar_path(&self->search, self->cells, AISLE_SEED_CELLS_MAX, &self->cell_count);
    for (uint32_t i = 0; st == AISLE_OK && i < self->cell_count; i++) {
        self->cells[i] = grid_cell(self, self->cells[i]);
    }
    return st;
}

static aisle_status begin_straightening(aisle_seed *self) {
    aisle_status st = fetch_path(self);
    if (st != AISLE_OK) {
        return st;
    }
    self->at = 0;
    self->points[0] = self->start;
    self->point_count = 1;
    self->phase = AISLE_SEED_STRAIGHTEN;
    return AISLE_BUSY;
}

aisle_status aisle_seed_step(aisle_seed *self, uint32_t units, uint32_t *spent) {
    AISLE_ASSERT(self->phase > AISLE_SEED_IDLE && self->phase < AISLE_SEED_DONE);
    aisle_status st = AISLE_BUSY;
    if (self->phase == AISLE_SEED_SEARCH) {
        st = search(self, units);
        if (st == AISLE_OK) {
            st = begin_straightening(self);
        }
    } else if (self->phase == AISLE_SEED_STRAIGHTEN) {
        st = straighten(self, units);
        if (st == AISLE_OK && self->space->mode == AISLE_SPACE_ALONG) {
            self->phase = AISLE_SEED_CORNERS;
            self->at = 1;
            st = AISLE_BUSY;
        }
    } else {
        st = widen_corners(self, units);
    }
    if (st == AISLE_OK) {
        self->phase = AISLE_SEED_DONE;
    }
    *spent += self->units;
    self->units = 0;
    return st;
}

static uint32_t search_cell(const aisle_seed *self, const aisle_astar_config *cfg, aisle_vec2 p) {
    const aisle_lattice *lattice = &self->space->grid->lattice;
    double x = aisle_clamp((p.x - lattice->x0) / step_length(self), 0.0, (double)(cfg->w - 1U));
    double y = aisle_clamp((p.y - lattice->y0) / step_length(self), 0.0, (double)(cfg->h - 1U));
    return (uint32_t)y * cfg->w + (uint32_t)x;
}

static void start_for_refusal(aisle_seed *self, aisle_space *space, aisle_vec2 start, aisle_vec2 goal, uint32_t stride,
                              aisle_astar_enter_fn enter) {
    self->space = space;
    self->for_refusal = true;
    self->bar_count = 0;
    self->roomiest = false;
    self->stride = stride;
    self->units = 0;
    self->phase = AISLE_SEED_SEARCH;
    aisle_astar_config cfg = search_config(self, enter);
    cfg.start = search_cell(self, &cfg, start);
    cfg.goal = search_cell(self, &cfg, goal);
    aisle_status st = aisle_astar_start(&self->search, &cfg);
    AISLE_ASSERT(st == AISLE_OK);
}

void aisle_seed_start_proof(aisle_seed *self, aisle_space *space, aisle_vec2 start, aisle_vec2 goal, double reach,
                            uint32_t depth) {
    aisle_space_forget(space);
    self->proof_depth = depth;
    self->proof_reach = reach;
    start_for_refusal(self, space, start, goal, 1U, enter_proof);
}

void aisle_seed_start_width(aisle_seed *self, aisle_space *space, aisle_vec2 start, aisle_vec2 goal, uint32_t stride,
                            uint32_t open_from) {
    self->open_from = open_from;
    start_for_refusal(self, space, start, goal, stride, enter_width);
}

void aisle_seed_start_widest(aisle_seed *self, aisle_space *space, aisle_vec2 start, aisle_vec2 goal, uint32_t stride,
                             uint32_t open_from) {
    self->open_from = open_from;
    start_for_refusal(self, space, start, goal, stride, enter_widest);
}

aisle_status aisle_seed_step_refusal(aisle_seed *self, uint32_t units, uint32_t *spent) {
    AISLE_ASSERT(self->for_refusal && self->phase == AISLE_SEED_SEARCH);
    aisle_status st = search(self, units);
    *spent += self->units;
    self->units = 0;
    return st;
}

aisle_status aisle_seed_refusal_path(aisle_seed *self) {
    return fetch_path(self);
}
