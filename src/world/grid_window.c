#include "world/grid_window.h"

#include "base/check.h"
#include "world/grid_field.h"

enum { PHASE_BEGIN, PHASE_DOWN, PHASE_UP, PHASE_ROWS, PHASE_DONE };

#define REACH AISLE_FIELD_REACH
#define FAR (REACH + 1) // rows or columns off: of no matter

void aisle_grid_window_carve(aisle_grid_window *self, aisle_arena *arena) {
    *self = (aisle_grid_window){.phase = PHASE_DONE};
    self->left.column = aisle_arena_take(arena, FAR, sizeof *self->left.column);
    self->right.column = aisle_arena_take(arena, FAR, sizeof *self->right.column);
    self->top = aisle_arena_take(arena, AISLE_WINDOW_SIDE, sizeof *self->top);
    self->bottom = aisle_arena_take(arena, AISLE_WINDOW_SIDE, sizeof *self->bottom);
    self->beside = aisle_arena_take(arena, 2U * FAR, sizeof *self->beside);
}

static const uint16_t *cell_at(const aisle_grid *grid, int32_t x, int32_t y) {
    return &grid->field[(uint32_t)y * grid->lattice.w + (uint32_t)x];
}

static int32_t root_down(uint32_t sq) {
    return (int32_t)sqrt((double)sq); // exact for squares
}
static int32_t root_up(uint32_t sq) {
    const int32_t root = root_down(sq);
    return (uint32_t)(root * root) < sq ? root + 1 : root;
}

// ---- the window

static int32_t off(int32_t at, int32_t lo, int32_t end) { // from [lo, end)
    return at < lo ? lo - at : (at >= end ? at - end + 1 : 0);
}

// sqrt(sq) <= sqrt(q) + 1, in integers.
static bool is_within(int32_t sq, uint16_t q) {
    const int32_t more = sq - (int32_t)q - 1;
    return more <= 0 || (more <= 2 * FAR && more * more <= 4 * (int32_t)q);
}

static bool is_row_within(const aisle_grid *grid, aisle_cells changed, int32_t y, int32_t x0, int32_t x1) {
    const int32_t dy = off(y, changed.y0, changed.y1);
    const uint16_t *row = cell_at(grid, 0, y);
    for (int32_t x = x0; x < x1; x++) {
        const int32_t dx = off(x, changed.x0, changed.x1);
        if (is_within(dx * dx + dy * dy, row[x])) {
            return true;
        }
    }
    return false;
}

static bool is_column_within(const aisle_grid *grid, aisle_cells changed, int32_t x, int32_t y0, int32_t y1) {
    const int32_t dx = off(x, changed.x0, changed.x1);
    for (int32_t y = y0; y < y1; y++) {
        const int32_t dy = off(y, changed.y0, changed.y1);
        if (is_within(dx * dx + dy * dy, *cell_at(grid, x, y))) {
            return true;
        }
    }
    return false;
}

static int32_t most(int32_t a, int32_t b) {
    return a > b ? a : b;
}
static int32_t least(int32_t a, int32_t b) {
    return a < b ? a : b;
}

typedef struct growth {
    const aisle_grid *grid;
    aisle_cells changed, limit;
    aisle_cells *box;
} growth;

// The frame with its corners, as far as the lattice has them.
static aisle_cells frame_of(const growth *g) {
    const aisle_lattice *l = &g->grid->lattice;
    return (aisle_cells){most(g->box->x0 - 1, 0), most(g->box->y0 - 1, 0), least(g->box->x1 + 1, (int32_t)l->w),
                         least(g->box->y1 + 1, (int32_t)l->h)};
}

static bool grow_level(const growth *g) {
    aisle_cells *box = g->box;
    bool is_grown = false;
    const aisle_cells frame = frame_of(g);
    while (box->y0 > g->limit.y0 && is_row_within(g->grid, g->changed, box->y0 - 1, frame.x0, frame.x1)) {
        box->y0--;
        is_grown = true;
    }
    while (box->y1 < g->limit.y1 && is_row_within(g->grid, g->changed, box->y1, frame.x0, frame.x1)) {
        box->y1++;
        is_grown = true;
    }
    return is_grown;
}

static bool grow_upright(const growth *g) {
    aisle_cells *box = g->box;
    bool is_grown = false;
    const aisle_cells frame = frame_of(g);
    while (box->x0 > g->limit.x0 && is_column_within(g->grid, g->changed, box->x0 - 1, frame.y0, frame.y1)) {
        box->x0--;
        is_grown = true;
    }
    while (box->x1 < g->limit.x1 && is_column_within(g->grid, g->changed, box->x1, frame.y0, frame.y1)) {
        box->x1++;
        is_grown = true;
    }
    return is_grown;
}

// ---- how far beside it matters

static uint32_t field_at(const aisle_grid *grid, int32_t x, int32_t y) { // outside is occupied
    return x < 0 || x >= (int32_t)grid->lattice.w ? 0U : *cell_at(grid, x, y);
}

static uint32_t reach_of(const aisle_grid *grid, int32_t frame, int32_t y) {
    return (uint32_t)root_down(field_at(grid, frame, y)) + 1U; // the frame's own column counts
}

static aisle_window_side side_of(const aisle_grid *grid, const aisle_cells *box, aisle_column *column, bool is_left) {
    aisle_window_side side = {.column = column, .frame = is_left ? box->x0 - 1 : box->x1};
    for (int32_t y = box->y0; y < box->y1; y++) {
        const uint32_t reach = reach_of(grid, side.frame, y);
        side.n = reach > side.n ? reach : side.n;
    }
    side.first = is_left ? box->x0 - (int32_t)side.n : box->x1;
    return side;
}

void aisle_grid_window_find(aisle_grid_window *self, const aisle_grid *grid, aisle_cells changed) {
    const int32_t w = (int32_t)grid->lattice.w;
    const int32_t h = (int32_t)grid->lattice.h;
    AISLE_ASSERT(changed.x0 >= 0 && changed.x0 < changed.x1 && changed.x1 <= w && changed.y0 >= 0 &&
                 changed.y0 < changed.y1 && changed.y1 <= h);
    AISLE_ASSERT(changed.x1 - changed.x0 <= (int32_t)AISLE_WINDOW_PIECE &&
                 changed.y1 - changed.y0 <= (int32_t)AISLE_WINDOW_PIECE);
    const aisle_cells limit = {most(changed.x0 - REACH, 0), most(changed.y0 - REACH, 0), least(changed.x1 + REACH, w),
                               least(changed.y1 + REACH, h)};
    self->box = changed;
    const growth g = {grid, changed, limit, &self->box};
    bool is_grown = true;
    while (is_grown) { // a side that grows makes the others longer
        is_grown = grow_level(&g);
        is_grown = grow_upright(&g) || is_grown;
    }
    self->left = side_of(grid, &self->box, self->left.column, true);
    self->right = side_of(grid, &self->box, self->right.column, false);
    self->phase = PHASE_BEGIN;
    self->next_row = 0;
}

uint32_t aisle_grid_window_width(const aisle_grid_window *self) {
    return (uint32_t)(self->box.x1 - self->box.x0) + self->left.n + self->right.n;
}

uint32_t aisle_grid_window_rows(const aisle_grid_window *self) {
    return 3U * (uint32_t)(self->box.y1 - self->box.y0);
}

// ---- columns

// Row of the nearest occupied cell of column x at y or after it, outside the window; `end` if there is none before.
static int32_t next_down(const aisle_grid *grid, int32_t x, int32_t y, int32_t end) {
    const int32_t h = (int32_t)grid->lattice.h;
    const int32_t stop = least(end, h); // row h is occupied, and no step leads past it
    while (y < stop) {
        const uint32_t q = field_at(grid, x, y);
        if (q == 0) {
            return y;
        }
        y += root_up(q);
    }
    return stop;
}

static int32_t next_up(const aisle_grid *grid, int32_t x, int32_t y, int32_t end) { // the same, at y or before it
    const int32_t stop = most(end, -1);
    while (y > stop) {
        const uint32_t q = field_at(grid, x, y);
        if (q == 0) {
            return y;
        }
        y -= root_up(q);
    }
    return stop;
}

static void take_column(aisle_column *column, const aisle_grid *grid, const aisle_cells *box, int32_t x, int32_t y) {
    column->below = next_down(grid, x, y, box->y1 + FAR);
    column->above = column->below == y ? y : next_up(grid, x, y, box->y0 - FAR);
}

static void begin_columns(aisle_grid_window *self, const aisle_grid *grid) {
    const aisle_cells *box = &self->box;
    for (int32_t x = box->x0; x < box->x1; x++) {
        const int32_t above = next_up(grid, x, box->y0 - 1, box->y0 - 1 - FAR);
        const int32_t below = next_down(grid, x, box->y1, box->y1 + FAR);
        self->top[x - box->x0] = (uint16_t)(box->y0 - 1 - above);
        self->bottom[x - box->x0] = (uint16_t)(below - box->y1);
    }
    for (uint32_t i = 0; i < self->left.n; i++) {
        take_column(&self->left.column[i], grid, box, self->left.first + (int32_t)i, box->y0);
    }
    for (uint32_t i = 0; i < self->right.n; i++) {
        take_column(&self->right.column[i], grid, box, self->right.first + (int32_t)i, box->y0);
    }
}

// Column distances of a row's columns beside that matter: none further from the frame's cell than the field says there.
static aisle_field_beside take_beside(const aisle_window_side *side, const aisle_grid *grid, const aisle_cells *box,
                                      int32_t y, uint16_t *out) {
    const uint32_t n = reach_of(grid, side->frame, y);
    const uint32_t from = side->frame < box->x0 ? side->n - n : 0U;
    for (uint32_t i = from; i < from + n; i++) {
        aisle_column *column = &side->column[i];
        if (column->below < y) { // and perhaps more passed since this column was asked
            take_column(column, grid, box, side->first + (int32_t)i, y);
        }
        column->above = column->below == y ? y : column->above;
        out[i - from] = (uint16_t)least(least(y - column->above, column->below - y), FAR);
    }
    return (aisle_field_beside){out, n};
}

// ---- the transform inside

static void forget_row(uint16_t *row, uint32_t w) { // all but what is occupied
    for (uint32_t x = 0; x < w; x++) {
        row[x] = row[x] == 0 ? 0U : AISLE_FIELD_COLUMN_MAX;
    }
}

static void do_row(aisle_grid_window *self, aisle_grid *grid, int32_t i) {
    const aisle_cells *box = &self->box;
    const uint32_t w = (uint32_t)(box->x1 - box->x0);
    const int32_t y = self->phase == PHASE_UP ? box->y1 - 1 - i : box->y0 + i;
    const uint32_t stride = grid->lattice.w;
    uint16_t *row = &grid->field[(uint32_t)y * stride + (uint32_t)box->x0];
    if (self->phase == PHASE_DOWN) {
        forget_row(row, w);
        aisle_field_lower(row, i == 0 ? self->top : row - stride, w);
    } else if (self->phase == PHASE_UP) {
        aisle_field_lower(row, i == 0 ? self->bottom : row + stride, w);
    } else {
        const aisle_field_beside left = take_beside(&self->left, grid, box, y, self->beside);
        const aisle_field_beside right = take_beside(&self->right, grid, box, y, self->beside + FAR);
        aisle_field_transform(grid->scratch, row, (int32_t)w, left, right);
    }
}

aisle_status aisle_grid_window_step(aisle_grid_window *self, aisle_grid *grid, uint32_t *rows) {
    if (self->phase == PHASE_BEGIN && *rows > 0) {
        begin_columns(self, grid);
        self->phase = PHASE_DOWN;
    }
    const int32_t h = self->box.y1 - self->box.y0;
    for (; *rows > 0 && self->phase != PHASE_DONE; (*rows)--) {
        do_row(self, grid, self->next_row);
        self->next_row++;
        if (self->next_row == h) {
            self->next_row = 0;
            self->phase++;
        }
    }
    return self->phase == PHASE_DONE ? AISLE_OK : AISLE_BUSY;
}
