#include "plan/opening.h"

#include "base/check.h"

#include <math.h>
#include <string.h>

#define BY_START 1U    // label, where 0 is none, of the start's flood
#define CLOSED 2U      // and of the closed cells next to it
#define BY_GOAL 3U     // of the goal's
#define FIRST_LABEL 5U // of what follows, two labels a flood
#define LAST_LABEL 65530U
#define MARK_START 1U // of polygons: borders the start's flood
#define MARK_GOAL 2U
#define MARK_SHIFT 2U // above: label of the flood it borders
#define HALF_DIAGONAL 0.70710678118654752
#define CELLS_A_UNIT 64U
#define JOIN_CELLS 2 // cells about start and goal that the proof may begin and end with

// ---- memory borrowed

static uint16_t *labels(const aisle_opening *self) {
    return self->seed->search.cell;
}

static uint32_t *marks(const aisle_opening *self) {
    return self->seed->cells;
}

static void push(aisle_opening *self, uint32_t cell) {
    uint32_t next = (self->tail + 1U) % self->seed->search.open_capacity;
    self->overflow = self->overflow || next == self->head;
    if (!self->overflow) {
        self->seed->search.open[self->tail].cell = cell;
        self->tail = next;
    }
}

static const aisle_lattice *lattice_of(const aisle_opening *self) {
    return &self->space->grid->lattice;
}

// ---- cells

// May a polygon left out be what the distance field knows near p?
static bool is_near_removed(const aisle_opening *self, aisle_vec2 p) {
    double reach = self->reach + 2.0 * lattice_of(self)->res;
    const uint32_t zones[AISLE_LAYOUT_WITHOUT_MAX] = {self->first, self->second};
    for (uint32_t i = 0; i < self->without.count; i++) {
        const aisle_zone *zone = aisle_layout_zone(self->space->layout, zones[i]);
        if (aisle_aabb_gap((aisle_aabb){p, p}, zone->box) <= reach) {
            return true;
        }
    }
    return false;
}

// Has the cell's middle room for every step to another such? Both ends sqrt(r^2 + step^2 / 4) from a point keep it r
// from the step, sqrt 2 cells at most.
static double sure_reach(const aisle_opening *self) {
    double r = self->reach + AISLE_SPACE_SLACK;
    double res = lattice_of(self)->res;
    return sqrt(r * r + 0.5 * res * res);
}

static bool is_open(aisle_opening *self, uint32_t cell) {
    const aisle_space *space = self->space;
    const aisle_lattice *lattice = lattice_of(self);
    double reach = self->sure ? sure_reach(self) : self->reach;
    double spare = lattice->res * HALF_DIAGONAL;
    uint32_t field = space->grid->field[cell];
    double gap = sqrt((double)field) * lattice->res;
    if (gap - spare >= reach) {
        return true;
    }
    aisle_vec2 centre = aisle_lattice_centre(lattice, cell);
    // Away from what is left out the field bounds the gap from above, too, and the exact gap is had faster.
    const aisle_layout_without *without = is_near_removed(self, centre) ? &self->without : NULL;
    if (gap + space->beyond + spare < reach && field < AISLE_FIELD_SQ_MAX && without == NULL) {
        return false;
    }
    if (!self->sure) {
        return aisle_space_square_holds(space, without, centre, reach, self->depth, &self->spent);
    }
    self->spent++;
    aisle_convex middle = {&centre, 1U, 0.0};
    return aisle_layout_gap_without(space->layout, without, &middle, reach, NULL) >= reach;
}

// Marks the polygons that come within reach of a closed cell.
static void mark_borders(aisle_opening *self, uint32_t cell) {
    const aisle_layout *layout = self->space->layout;
    const aisle_zone *first = aisle_layout_zone(layout, 0);
    aisle_vec2 centre = aisle_lattice_centre(lattice_of(self), cell);
    double reach = self->reach + HALF_DIAGONAL * lattice_of(self)->res;
    aisle_layout_walk walk = aisle_layout_walk_over(layout, aisle_aabb_grow((aisle_aabb){centre, centre}, reach));
    const aisle_zone *zone;
    self->spent++;
    while (aisle_layout_walk_next(&walk, &zone)) {
        aisle_convex shape = aisle_layout_zone_shape(layout, zone);
        if (!aisle_zone_is_obstacle(zone) || aisle_convex_point_gap(&shape, centre) > reach) {
            continue;
        }
        uint32_t *mark = &marks(self)[zone - first];
        if (self->label == BY_START || self->label == BY_GOAL) {
            *mark |= self->label == BY_START ? MARK_START : MARK_GOAL;
        } else {
            *mark = (*mark & (MARK_START | MARK_GOAL)) | ((uint32_t)self->label << MARK_SHIFT);
        }
    }
}

// ---- a flood

// Is the straight way between the middle of a cell and a place free for sure?
static bool joins(aisle_opening *self, uint32_t cell, aisle_vec2 place) {
    aisle_vec2 ends[2] = {aisle_lattice_centre(lattice_of(self), cell), place};
    aisle_convex way = {ends, 2U, self->reach + AISLE_SPACE_SLACK * 0.5};
    self->spent++;
    return aisle_layout_gap_without(self->space->layout, &self->without, &way, lattice_of(self)->res, NULL) > 0.0;
}

static bool is_next_to(const aisle_opening *self, uint32_t cell, aisle_vec2 place) {
    aisle_vec2 centre = aisle_lattice_centre(lattice_of(self), cell);
    double most = (JOIN_CELLS + 0.5) * lattice_of(self)->res;
    return fabs(centre.x - place.x) <= most && fabs(centre.y - place.y) <= most;
}

static bool meets_goal(aisle_opening *self, uint32_t cell) {
    if (self->sure) {
        return is_next_to(self, cell, self->goal) && joins(self, cell, self->goal);
    }
    return cell == aisle_lattice_cell(lattice_of(self), self->goal, NULL);
}

// Floods begun anew keep bits of their own: the labels of the others are wanted again.
static void label_cell(aisle_opening *self, uint32_t cell, uint16_t label) {
    if (self->anew) {
        aisle_space_note(self->space, cell);
    } else {
        labels(self)[cell] = label;
    }
}

static void enter(aisle_opening *self, uint32_t cell) {
    label_cell(self, cell, self->label);
    push(self, cell);
    if (self->label != BY_GOAL && meets_goal(self, cell)) {
        self->connected = true;
    }
}

static bool is_visited(const aisle_opening *self, uint32_t cell) {
    if (self->anew) {
        return aisle_space_is_noted(self->space, cell);
    }
    uint16_t label = labels(self)[cell];
    return label == self->label || label == self->label + 1U || (label == BY_START && self->label != BY_GOAL);
}

static void visit(aisle_opening *self, uint32_t cell) {
    if (is_visited(self, cell)) {
        return;
    }
    uint16_t label = labels(self)[cell];
    if (!self->anew && label == BY_GOAL) {
        self->connected = true;
        return;
    }
    bool known_closed = self->label == BY_GOAL && label == CLOSED;
    if (!known_closed && is_open(self, cell)) {
        enter(self, cell);
        return;
    }
    label_cell(self, cell, (uint16_t)(self->label + 1U));
    if (self->stage <= AISLE_OPENING_GOAL || self->stage == AISLE_OPENING_FIRST) {
        mark_borders(self, cell);
    }
}

static void visit_neighbours(aisle_opening *self, uint32_t cell) {
    uint32_t w = lattice_of(self)->w;
    uint32_t x = cell % w;
    uint32_t y = cell / w;
    for (uint32_t ny = y > 0U ? y - 1U : 0U; ny <= y + 1U && ny < lattice_of(self)->h; ny++) {
        for (uint32_t nx = x > 0U ? x - 1U : 0U; nx <= x + 1U && nx < w; nx++) {
            if (nx != x || ny != y) {
                visit(self, ny * w + nx);
            }
        }
    }
}

static void begin_flood(aisle_opening *self, aisle_opening_stage stage, uint16_t label, bool anew) {
    self->stage = stage;
    self->label = label;
    self->anew = anew;
    if (anew) {
        aisle_space_forget(self->space);
    }
    self->sure = stage == AISLE_OPENING_PROVE;
    self->connected = false;
    self->head = self->tail = 0;
    for (uint32_t i = 0; i < AISLE_LAYOUT_WITHOUT_MAX; i++) {
        self->row[i] = anew || i >= self->without.count ? UINT32_MAX : 0U;
    }
}

static uint16_t next_label(aisle_opening *self) {
    uint16_t label = self->label < FIRST_LABEL ? FIRST_LABEL : (uint16_t)(self->label + 2U);
    self->overflow = self->overflow || label >= LAST_LABEL;
    return label;
}

// Every cell about a place that it can be driven to straight.
static void begin_proof_at(aisle_opening *self, aisle_vec2 place) {
    const aisle_lattice *lattice = lattice_of(self);
    uint32_t home = aisle_lattice_cell(lattice, place, NULL);
    int32_t x = (int32_t)(home % lattice->w);
    int32_t y = (int32_t)(home / lattice->w);
    for (int32_t k = 0; k < (2 * JOIN_CELLS + 1) * (2 * JOIN_CELLS + 1); k++) {
        int32_t nx = x + k % (2 * JOIN_CELLS + 1) - JOIN_CELLS;
        int32_t ny = y + k / (2 * JOIN_CELLS + 1) - JOIN_CELLS;
        if (nx < 0 || ny < 0 || nx >= (int32_t)lattice->w || ny >= (int32_t)lattice->h) {
            continue;
        }
        uint32_t cell = (uint32_t)ny * lattice->w + (uint32_t)nx;
        if (is_open(self, cell) && joins(self, cell, place)) {
            enter(self, cell);
        }
    }
}

// Cells of the start's flood about a polygon left out, one row of them: where the flood goes on. False: no row left.
static bool seed_row(aisle_opening *self, uint32_t i) {
    const aisle_lattice *lattice = lattice_of(self);
    if (self->row[i] == UINT32_MAX) {
        return false;
    }
    const aisle_zone *zone = aisle_layout_zone(self->space->layout, i == 0U ? self->first : self->second);
    aisle_aabb box = aisle_aabb_grow(zone->box, self->reach + 3.0 * lattice->res);
    uint32_t lo = aisle_lattice_cell(lattice, box.lo, NULL);
    uint32_t hi = aisle_lattice_cell(lattice, box.hi, NULL);
    uint32_t y = lo / lattice->w + self->row[i];
    if (y > hi / lattice->w) {
        self->row[i] = UINT32_MAX;
        return false;
    }
    for (uint32_t cell = y * lattice->w + lo % lattice->w; cell <= y * lattice->w + hi % lattice->w; cell++) {
        if (labels(self)[cell] == BY_START) {
            visit_neighbours(self, cell);
        }
    }
    self->spent += 1U + (hi % lattice->w - lo % lattice->w) / CELLS_A_UNIT;
    self->row[i]++;
    return true;
}

// A little of the flood. False: it has ended.
static bool go_on(aisle_opening *self) {
    if (self->overflow || self->connected) {
        return false;
    }
    if (seed_row(self, 0) || seed_row(self, 1)) {
        return true;
    }
    if (self->head == self->tail) {
        return false;
    }
    uint32_t cell = self->seed->search.open[self->head].cell;
    self->head = (self->head + 1U) % self->seed->search.open_capacity;
    self->spent++;
    visit_neighbours(self, cell);
    return true;
}

// ---- which sets are tried

static void leave_out(aisle_opening *self, uint32_t count) {
    self->without.count = count;
    self->without.id[0] = aisle_layout_zone(self->space->layout, self->first)->id;
    if (count > 1U) {
        self->without.id[1] = aisle_layout_zone(self->space->layout, self->second)->id;
    }
}

static void end(aisle_opening *self, bool found) {
    self->found = found;
    self->stage = AISLE_OPENING_END;
}

static uint32_t zone_count(const aisle_opening *self) {
    return aisle_layout_zone_count(self->space->layout);
}

// The next polygon of those that border the start's flood to be the first of a pair, from `first` on.
static void next_first(aisle_opening *self) {
    for (; self->first < zone_count(self); self->first++) {
        if ((marks(self)[self->first] & MARK_START) != 0U) {
            self->second = 0;
            leave_out(self, 1U);
            begin_flood(self, AISLE_OPENING_FIRST, next_label(self), false);
            return;
        }
    }
    end(self, false);
}

static void next_single(aisle_opening *self) {
    const uint32_t both = MARK_START | MARK_GOAL;
    for (; self->first < zone_count(self); self->first++) {
        if ((marks(self)[self->first] & both) == both) {
            leave_out(self, 1U);
            begin_flood(self, AISLE_OPENING_SINGLE, next_label(self), false);
            return;
        }
    }
    if (self->doubt) {
        end(self, false);
        return;
    }
    self->first = 0;
    next_first(self);
}

// The next polygon that the flood without the first one borders, from `second` on.
static void next_second(aisle_opening *self) {
    uint32_t by_goal = marks(self)[self->first] & MARK_GOAL;
    for (; self->second < zone_count(self); self->second++) {
        uint32_t mark = marks(self)[self->second];
        if (self->second != self->first && mark >> MARK_SHIFT == self->bordered &&
            ((mark | by_goal) & MARK_GOAL) != 0U) {
            leave_out(self, 2U);
            begin_flood(self, AISLE_OPENING_PAIR, next_label(self), false);
            return;
        }
    }
    self->first++;
    next_first(self);
}

static void next_set(aisle_opening *self) {
    if (self->tried == AISLE_OPENING_PAIR) {
        self->second++;
        next_second(self);
    } else {
        self->first++;
        next_single(self);
    }
}

static void begin_proof(aisle_opening *self, aisle_opening_stage tried) {
    self->tried = tried;
    begin_flood(self, AISLE_OPENING_PROVE, self->label, true);
    begin_proof_at(self, self->start);
}

// ---- all together

static void enter_at(aisle_opening *self, aisle_vec2 place) {
    enter(self, aisle_lattice_cell(lattice_of(self), place, NULL));
}

static void begin(aisle_opening *self) {
    const aisle_lattice *lattice = lattice_of(self);
    memset(labels(self), 0, (size_t)lattice->w * lattice->h * sizeof(uint16_t));
    memset(marks(self), 0, zone_count(self) * sizeof(uint32_t));
    self->without.count = 0;
    self->first = 0;
    begin_flood(self, AISLE_OPENING_START, BY_START, false);
    enter_at(self, self->start);
}

// The end of an attempt to prove a set. What the optimistic grid opened wrongly, perhaps, it may have taken for part of
// the goal's flood, too: once more then, as closely as can be.
static void judge_proof(aisle_opening *self) {
    bool single = self->tried == AISLE_OPENING_SINGLE;
    if (self->connected) {
        end(self, true);
    } else if (single && self->depth < AISLE_SPACE_DEPTH_MAX) {
        self->depth = AISLE_SPACE_DEPTH_MAX;
        begin(self);
    } else {
        self->doubt = self->doubt || single;
        next_set(self);
    }
}

static void judge(aisle_opening *self) {
    switch (self->stage) {
    case AISLE_OPENING_START:
        if (self->connected) { // it was said not to be
            end(self, false);
            return;
        }
        begin_flood(self, AISLE_OPENING_GOAL, BY_GOAL, false);
        enter_at(self, self->goal);
        break;
    case AISLE_OPENING_GOAL:
        next_single(self);
        break;
    case AISLE_OPENING_FIRST:
        self->bordered = self->label;
        next_second(self);
        break;
    case AISLE_OPENING_SINGLE:
    case AISLE_OPENING_PAIR:
        self->tried = self->stage;
        if (self->connected) {
            begin_proof(self, self->stage);
        } else {
            next_set(self);
        }
        break;
    default:
        judge_proof(self);
        break;
    }
}

void aisle_opening_start(aisle_opening *self, aisle_seed *seed, aisle_space *space, aisle_vec2 start, aisle_vec2 goal,
                         uint32_t depth, uint32_t limit) {
    *self = (aisle_opening){.seed = seed, .space = space, .start = start, .goal = goal, .depth = depth, .limit = limit};
    self->reach = space->vehicle->inner_radius + space->vehicle->margin;
    AISLE_ASSERT(space->grid->lattice.w * space->grid->lattice.h <= seed->search.capacity);
    AISLE_ASSERT(zone_count(self) <= AISLE_SEED_CELLS_MAX);
    if (zone_count(self) == 0U) {
        end(self, false);
        return;
    }
    begin(self);
}

aisle_status aisle_opening_step(aisle_opening *self, uint32_t units, uint32_t *spent) {
    uint32_t before = self->spent;
    while (self->stage != AISLE_OPENING_END && self->spent - before < units) {
        if (!go_on(self)) {
            self->spent++;
            judge(self);
        }
        if (self->overflow || (self->spent >= self->limit && self->stage != AISLE_OPENING_END)) {
            end(self, false);
        }
    }
    *spent += self->spent - before;
    if (self->stage != AISLE_OPENING_END) {
        return AISLE_BUSY;
    }
    return self->found ? AISLE_OK : AISLE_PARTIAL;
}
