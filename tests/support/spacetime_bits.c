#include "spacetime_bits.h"

#include <stdlib.h>
#include <string.h>

static uint64_t *row_of(const spacetime_bits *self, int y) {
    return self->word + (size_t)y * (size_t)self->words + 1;
}

bool spacetime_bits_begin(spacetime_bits *self, int nx, int ny) {
    self->nx = nx;
    self->ny = ny;
    self->words = (nx + 63) / 64 + 2;
    self->lo = self->hi = 0;
    self->word = calloc((size_t)self->words * (size_t)ny, sizeof *self->word);
    return self->word != NULL;
}

void spacetime_bits_end(spacetime_bits *self) {
    free(self->word);
    memset(self, 0, sizeof *self);
}

static void clear_rows(spacetime_bits *self, int lo, int hi) {
    if (hi > lo) {
        size_t width = (size_t)self->words * sizeof *self->word;
        memset(row_of(self, lo) - 1, 0, (size_t)(hi - lo) * width);
    }
}

void spacetime_bits_clear(spacetime_bits *self) {
    clear_rows(self, self->lo, self->hi);
    self->lo = self->hi = 0;
}

void spacetime_bits_copy(spacetime_bits *self, const spacetime_bits *from) {
    spacetime_bits_clear(self);
    self->lo = from->lo;
    self->hi = from->hi;
    if (from->hi > from->lo) {
        size_t width = (size_t)self->words * sizeof *self->word;
        memcpy(row_of(self, self->lo) - 1, row_of(from, from->lo) - 1, (size_t)(from->hi - from->lo) * width);
    }
}

bool spacetime_bits_has(const spacetime_bits *self, int x, int y) {
    return x >= 0 && y >= 0 && x < self->nx && y < self->ny && ((row_of(self, y)[x / 64] >> (x % 64)) & 1U) != 0;
}

static void widen(spacetime_bits *self, int lo, int hi) {
    if (lo < hi) {
        bool none = self->lo >= self->hi;
        self->lo = none || lo < self->lo ? lo : self->lo;
        self->hi = none || hi > self->hi ? hi : self->hi;
    }
}

void spacetime_bits_put(spacetime_bits *self, int x, int y) {
    row_of(self, y)[x / 64] |= UINT64_C(1) << (x % 64);
    widen(self, y, y + 1);
}

bool spacetime_bits_is_empty(const spacetime_bits *self) {
    const uint64_t *word = row_of(self, self->lo) - 1;
    for (size_t i = 0; self->hi > self->lo && i < (size_t)(self->hi - self->lo) * (size_t)self->words; i++) {
        if (word[i] != 0) {
            return false;
        }
    }
    return true;
}

static int larger(int a, int b) {
    return a > b ? a : b;
}

static int lesser(int a, int b) {
    return a < b ? a : b;
}

bool spacetime_bits_meet(const spacetime_bits *a, const spacetime_bits *b) {
    for (int y = larger(a->lo, b->lo); y < lesser(a->hi, b->hi); y++) {
        const uint64_t *p = row_of(a, y), *q = row_of(b, y);
        for (int i = 0; i < a->words - 2; i++) {
            if ((p[i] & q[i]) != 0) {
                return true;
            }
        }
    }
    return false;
}

void spacetime_bits_and(spacetime_bits *self, const spacetime_bits *with) {
    spacetime_bits_and_at(self, with, 0, 0);
}

void spacetime_bits_or(spacetime_bits *self, const spacetime_bits *with) {
    spacetime_bits_or_moved(self, with, 0, 0);
}

void spacetime_bits_or_moved(spacetime_bits *self, const spacetime_bits *from, int dx, int dy) {
    int lo = larger(from->lo, -dy), hi = lesser(from->hi, from->ny - dy), count = self->words - 2;
    for (int y = lo; y < hi; y++) {
        const uint64_t *p = row_of(from, y);
        uint64_t *q = row_of(self, y + dy);
        for (int i = 0; i < count && dx == 0; i++) {
            q[i] |= p[i];
        }
        for (int i = 0; i < count && dx > 0; i++) {
            q[i] |= p[i] << dx | p[i - 1] >> (64 - dx);
        }
        for (int i = 0; i < count && dx < 0; i++) {
            q[i] |= p[i] >> -dx | p[i + 1] << (64 + dx);
        }
    }
    widen(self, lo + dy, hi + dy);
}

void spacetime_bits_and_at(spacetime_bits *self, const spacetime_bits *with, int dx, int dy) {
    int lo = larger(self->lo, -dy), hi = lesser(self->hi, with->ny - dy), count = self->words - 2;
    clear_rows(self, self->lo, lesser(lo, self->hi));
    clear_rows(self, larger(hi, self->lo), self->hi);
    for (int y = lo; y < hi; y++) {
        const uint64_t *p = row_of(with, y + dy);
        uint64_t *q = row_of(self, y);
        for (int i = 0; i < count && dx == 0; i++) {
            q[i] &= p[i];
        }
        for (int i = 0; i < count && dx > 0; i++) {
            q[i] &= p[i] >> dx | p[i + 1] << (64 - dx);
        }
        for (int i = 0; i < count && dx < 0; i++) {
            q[i] &= p[i] << -dx | p[i - 1] >> (64 + dx);
        }
    }
    self->lo = lo < hi ? lo : 0;
    self->hi = lo < hi ? hi : 0;
}

void spacetime_bits_take_out(spacetime_bits *self, int y, int x0, int x1) {
    if (y < self->lo || y >= self->hi) {
        return;
    }
    uint64_t *row = row_of(self, y);
    x0 = larger(x0, 0);
    x1 = lesser(x1, 64 * (self->words - 2) - 1);
    for (int i = x0 / 64; i <= x1 / 64 && x0 <= x1; i++) {
        uint64_t from = i == x0 / 64 ? ~UINT64_C(0) << (x0 % 64) : ~UINT64_C(0);
        uint64_t to = i == x1 / 64 ? ~UINT64_C(0) >> (63 - x1 % 64) : ~UINT64_C(0);
        row[i] &= ~(from & to);
    }
}
