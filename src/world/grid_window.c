#include "world/grid_window.h"

#include "base/check.h"
#include "world/grid_field.h"

#include <string.h>

enum { PHASE_NEARER, PHASE_ABOVE, PHASE_BELOW, PHASE_AHEAD, PHASE_DOWN, PHASE_UP, PHASE_ROWS, PHASE_DONE };

#define REACH AISLE_FIELD_REACH
#define FAR (REACH + 1)                         // rows or columns off: of no matter
#define MARGIN ((uint32_t)FAR)                  // columns beside the window, on one side
#define WIDTH (AISLE_WINDOW_SIDE + 2U * MARGIN) // the window and both
#define BLOCK 32U                               // rows whose distances ahead are held at a time

// ---- memory

void aisle_grid_window_carve(aisle_grid_window *self, aisle_arena *arena) {
    *self = (aisle_grid_window){.phase = PHASE_DONE};
    self->nearest = aisle_arena_take(arena, AISLE_WINDOW_PIECE, sizeof *self->nearest);
    self->above = aisle_arena_take(arena, WIDTH, sizeof *self->above);
    self->below = aisle_arena_take(arena, WIDTH, sizeof *self->below);
    self->saved = aisle_arena_take(arena, (AISLE_WINDOW_SIDE / BLOCK + 1U) * 2U * MARGIN, sizeof *self->saved);
    self->ahead = aisle_arena_take(arena, BLOCK * 2U * MARGIN, sizeof *self->ahead);
}

// ---- the window

static const uint16_t *cell_at(const aisle_grid *grid, int32_t x, int32_t y) {
    return &grid->field[(uint32_t)y * grid->lattice.w + (uint32_t)x];
}

static int32_t off(int32_t at, int32_t lo, int32_t end) { // from [lo, end)
    return at < lo ? lo - at : (at >= end ? at - end + 1 : 0);
}

// sqrt(sq) <= sqrt(q) + 1, in integers.
static bool is_within(int32_t sq, uint16_t q) {
    const int32_t more = sq - (int32_t)q - 1;
    return more <= 0 || (more <= 2 * FAR && more * more <= 4 * (int32_t)q);
}

// Most likely right across from what changed: looked at first.
static bool is_row_within(const aisle_grid *grid, aisle_cells changed, int32_t y, int32_t x0, int32_t x1) {
    const int32_t dy = off(y, changed.y0, changed.y1);
    const uint16_t *row = cell_at(grid, 0, y);
    if (is_within(dy * dy, row[(changed.x0 + changed.x1) / 2])) {
        return true;
    }
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
    if (is_within(dx * dx, *cell_at(grid, x, (changed.y0 + changed.y1) / 2))) {
        return true;
    }
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

// ---- how far around it matters

static uint32_t field_at(const aisle_grid *grid, int32_t x, int32_t y) { // outside is occupied
    const bool is_in = x >= 0 && y >= 0 && x < (int32_t)grid->lattice.w && y < (int32_t)grid->lattice.h;
    return is_in ? *cell_at(grid, x, y) : 0U;
}

static int32_t reach_of(const aisle_grid *grid, int32_t x, int32_t y) { // cells from this one on, itself counted
    return (int32_t)sqrt((double)field_at(grid, x, y)) + 1;             // exact for squares
}

// Of a row of the window no column further out than the reach of the frame's cell in that row, and so of columns.
static void look_around(aisle_grid_window *self, const aisle_grid *grid) {
    const aisle_cells *box = &self->box;
    int32_t reach[4] = {0, 0, 0, 0}; // left, right, before, behind
    for (int32_t y = box->y0; y < box->y1; y++) {
        reach[0] = most(reach[0], reach_of(grid, box->x0 - 1, y));
        reach[1] = most(reach[1], reach_of(grid, box->x1, y));
    }
    for (int32_t x = box->x0; x < box->x1; x++) {
        reach[2] = most(reach[2], reach_of(grid, x, box->y0 - 1));
        reach[3] = most(reach[3], reach_of(grid, x, box->y1));
    }
    self->left = (uint32_t)reach[0];
    self->right = (uint32_t)reach[1];
    self->rows0 = box->y0 - reach[2];
    self->rows1 = box->y1 + reach[3];
}

static uint32_t width_of(const aisle_grid_window *self) {
    return (uint32_t)(self->box.x1 - self->box.x0);
}

uint32_t aisle_grid_window_width(const aisle_grid_window *self) {
    return self->left + width_of(self) + self->right;
}

// Distances before the first row that counts: outside the lattice is occupied, elsewhere nothing is of matter.
static void begin_counts(aisle_grid_window *self, const aisle_grid *grid) {
    const uint32_t width = aisle_grid_window_width(self);
    const uint16_t above = self->rows0 <= 0 ? 0U : (uint16_t)FAR;
    const uint16_t below = self->rows1 >= (int32_t)grid->lattice.h ? 0U : (uint16_t)FAR;
    for (uint32_t i = 0; i < width; i++) {
        const int32_t x = self->box.x0 - (int32_t)self->left + (int32_t)i;
        const bool is_in = x >= 0 && x < (int32_t)grid->lattice.w; // the columns outside hold 0 all along
        self->above[i] = is_in ? above : 0U;
        self->below[i] = is_in ? below : 0U;
    }
    self->rows0 = most(self->rows0, 0);
    self->rows1 = least(self->rows1, (int32_t)grid->lattice.h);
}

static void begin_nearer(aisle_grid_window *self, const aisle_grid *grid);

void aisle_grid_window_find(aisle_grid_window *self, const aisle_grid *grid, aisle_cells changed, bool has_freed) {
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
    self->changed = changed;
    self->next_row = 0;
    self->left = 0;
    self->right = 0;
    if (has_freed) {
        look_around(self, grid);
        begin_counts(self, grid);
        self->phase = PHASE_ABOVE;
    } else {
        begin_nearer(self, grid);
        self->phase = PHASE_NEARER;
    }
}

static int32_t rows_of(const aisle_grid_window *self, uint8_t phase) {
    switch (phase) {
    case PHASE_ABOVE:
        return self->box.y0 - self->rows0;
    case PHASE_BELOW:
        return self->rows1 - self->box.y1;
    default:
        return self->box.y1 - self->box.y0;
    }
}

uint32_t aisle_grid_window_rows(const aisle_grid_window *self) {
    if (self->phase == PHASE_NEARER) {
        return (uint32_t)rows_of(self, PHASE_NEARER);
    }
    int32_t rows = 0;
    for (uint8_t phase = PHASE_ABOVE; phase < PHASE_DONE; phase++) {
        rows += rows_of(self, phase);
    }
    return (uint32_t)rows;
}

// ---- column distances around

// Distances, in the column, to the nearest occupied cell, from those in the row before.
static void count_cells(uint16_t *restrict count, const uint16_t *restrict row, uint32_t n) {
    for (uint32_t i = 0; i < n; i++) { // no branch, so that it becomes vector code
        const uint16_t next = (uint16_t)(count[i] + 1U);
        const uint16_t capped = next < AISLE_FIELD_COLUMN_MAX ? next : AISLE_FIELD_COLUMN_MAX;
        count[i] = row[i] == 0 ? 0U : capped;
    }
}

// Of the columns [i, end) counted from the first one beside on the left, as far as the lattice has them.
static void count_columns(const aisle_grid_window *self, const aisle_grid *grid, uint16_t *count, int32_t y, uint32_t i,
                          uint32_t end) {
    const int32_t first = self->box.x0 - (int32_t)self->left;
    const uint32_t from = first < 0 && i == 0 ? 1U : i;
    const int32_t w = (int32_t)grid->lattice.w;
    const uint32_t to = first + (int32_t)end > w ? end - 1U : end; // at most one column is outside on either side
    count_cells(&count[from], cell_at(grid, first + (int32_t)from, y), to - from);
}

static void count_beside(const aisle_grid_window *self, const aisle_grid *grid, uint16_t *count, int32_t y) {
    const uint32_t w = width_of(self);
    count_columns(self, grid, count, y, 0, self->left);
    count_columns(self, grid, count, y, self->left + w, self->left + w + self->right);
}

static void copy_beside(const aisle_grid_window *self, uint16_t *to, const uint16_t *from) { // packed: left, right
    memcpy(to, from, self->left * sizeof *to);
    memcpy(to + self->left, from + self->left + width_of(self), self->right * sizeof *to);
}

static void spread_beside(const aisle_grid_window *self, uint16_t *to, const uint16_t *from) { // and back
    memcpy(to, from, self->left * sizeof *to);
    memcpy(to + self->left + width_of(self), from + self->left, self->right * sizeof *to);
}

// From the last row up; where a block of rows ends, what is below it is saved.
static void count_ahead(aisle_grid_window *self, const aisle_grid *grid, uint32_t row, uint32_t rows) {
    if (row + 1U == rows || (row + 1U) % BLOCK == 0) {
        copy_beside(self, &self->saved[row / BLOCK * 2U * MARGIN], self->below);
    }
    count_beside(self, grid, self->below, self->box.y0 + (int32_t)row);
}

// The distances to what is below, for each row of a block.
static void fill_block(aisle_grid_window *self, const aisle_grid *grid, uint32_t block, uint32_t rows) {
    const uint32_t end = (block + 1U) * BLOCK < rows ? (block + 1U) * BLOCK : rows;
    spread_beside(self, self->below, &self->saved[block * 2U * MARGIN]);
    for (uint32_t row = end; row-- > block * BLOCK;) {
        count_beside(self, grid, self->below, self->box.y0 + (int32_t)row);
        copy_beside(self, &self->ahead[row % BLOCK * 2U * MARGIN], self->below);
    }
}

// ---- cells that became occupied only

// Row of the next occupied cell of column x among the changed cells, from y on; far off if there is none.
static int32_t next_changed(const aisle_grid *grid, const aisle_cells *changed, int32_t x, int32_t y) {
    while (y < changed->y1 && *cell_at(grid, x, y) != 0) {
        y++;
    }
    return y < changed->y1 ? y : changed->y1 + 2 * FAR;
}

static void begin_nearer(aisle_grid_window *self, const aisle_grid *grid) {
    const aisle_cells *changed = &self->changed;
    for (int32_t x = changed->x0; x < changed->x1; x++) {
        self->nearest[x - changed->x0] =
            (aisle_window_column){changed->y0 - 2 * FAR, next_changed(grid, changed, x, changed->y0)};
    }
}

// Squared distances to what is occupied among the changed cells, where they are less than the field.
static void take_nearer(aisle_grid_window *self, const aisle_grid *grid, int32_t y, uint16_t *row, uint32_t w) {
    const aisle_cells *changed = &self->changed;
    uint16_t *nearer = self->above;
    for (uint32_t x = 0; x < w; x++) {
        nearer[x] = AISLE_FIELD_COLUMN_MAX;
    }
    for (int32_t x = changed->x0; x < changed->x1; x++) {
        aisle_window_column *column = &self->nearest[x - changed->x0];
        if (column->below < y) {
            column->below = next_changed(grid, changed, x, y);
        }
        column->above = column->below == y ? y : column->above;
        nearer[x - self->box.x0] = (uint16_t)least(least(y - column->above, column->below - y), FAR);
    }
    const aisle_field_beside none = {NULL, 0};
    aisle_field_transform(grid->scratch, nearer, (int32_t)w, none, none);
    for (uint32_t x = 0; x < w; x++) {
        row[x] = nearer[x] < row[x] ? nearer[x] : row[x];
    }
}

// ---- the transform inside

static void forget_row(uint16_t *row, uint32_t w) { // all but what is occupied
    for (uint32_t x = 0; x < w; x++) {
        row[x] = row[x] == 0 ? 0U : AISLE_FIELD_COLUMN_MAX;
    }
}

// The columns beside that matter: none further from the frame's cell than the field says there.
static void take_row(aisle_grid_window *self, const aisle_grid *grid, uint32_t i, uint16_t *row) {
    const int32_t y = self->box.y0 + (int32_t)i;
    const uint32_t w = width_of(self);
    if (i % BLOCK == 0) {
        fill_block(self, grid, i / BLOCK, (uint32_t)rows_of(self, PHASE_ROWS));
    }
    uint16_t *beside = &self->ahead[i % BLOCK * 2U * MARGIN];
    count_beside(self, grid, self->above, y);
    for (uint32_t k = 0; k < self->left; k++) {
        beside[k] = self->above[k] < beside[k] ? self->above[k] : beside[k];
    }
    for (uint32_t k = self->left; k < self->left + self->right; k++) {
        beside[k] = self->above[k + w] < beside[k] ? self->above[k + w] : beside[k];
    }
    const uint32_t left = (uint32_t)reach_of(grid, self->box.x0 - 1, y);
    const uint32_t right = (uint32_t)reach_of(grid, self->box.x1, y);
    aisle_field_transform(grid->scratch, row, (int32_t)w, (aisle_field_beside){beside + self->left - left, left},
                          (aisle_field_beside){beside + self->left, right});
}

static void do_row(aisle_grid_window *self, aisle_grid *grid, int32_t i) {
    const aisle_cells *box = &self->box;
    const uint32_t w = width_of(self);
    const uint32_t stride = grid->lattice.w;
    const int32_t last = box->y1 - 1;
    const int32_t y = self->phase == PHASE_UP ? last - i : box->y0 + i;
    uint16_t *row = &grid->field[(uint32_t)y * stride + (uint32_t)box->x0];
    switch (self->phase) {
    case PHASE_NEARER:
        take_nearer(self, grid, y, row, w);
        break;
    case PHASE_ABOVE:
        count_columns(self, grid, self->above, self->rows0 + i, 0, aisle_grid_window_width(self));
        break;
    case PHASE_BELOW:
        count_columns(self, grid, self->below, self->rows1 - 1 - i, 0, aisle_grid_window_width(self));
        break;
    case PHASE_AHEAD:
        count_ahead(self, grid, (uint32_t)(last - box->y0 - i), (uint32_t)(box->y1 - box->y0));
        break;
    case PHASE_DOWN:
        forget_row(row, w);
        aisle_field_lower(row, i == 0 ? self->above + self->left : row - stride, w);
        break;
    case PHASE_UP:
        aisle_field_lower(row, i == 0 ? self->below + self->left : row + stride, w);
        break;
    default:
        take_row(self, grid, (uint32_t)i, row);
        break;
    }
}

aisle_status aisle_grid_window_step(aisle_grid_window *self, aisle_grid *grid, uint32_t *rows) {
    while (self->phase != PHASE_DONE) {
        if (self->next_row == rows_of(self, self->phase)) {
            self->next_row = 0;
            self->phase = self->phase == PHASE_NEARER ? (uint8_t)PHASE_DONE : (uint8_t)(self->phase + 1U);
            continue;
        }
        if (*rows == 0) {
            return AISLE_BUSY;
        }
        do_row(self, grid, self->next_row);
        self->next_row++;
        (*rows)--;
    }
    return AISLE_OK;
}
