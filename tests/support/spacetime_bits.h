// spacetime_bits.h - sets of lattice cells as bits, row by row; of the space-time oracle alone.
//
// A row has a word of zeros at either end, so that sets can be moved by up to 63 cells without a thought of borders.
// What is moved out of the lattice sideways may end up in those words or in the spare bits of a row: intersect with a
// set that has none there. Memory: heap. Time: O(words of the rows that hold anything).
#ifndef SPACETIME_BITS_H
#define SPACETIME_BITS_H

#include <stdbool.h>
#include <stdint.h>

typedef struct spacetime_bits {
    int nx, ny, words; // cells, cells, words of a row
    int lo, hi;        // rows that may hold anything: lo..hi - 1
    uint64_t *word;    // [ny * words]
} spacetime_bits;

bool spacetime_bits_begin(spacetime_bits *self, int nx, int ny); // empty; false: no memory
void spacetime_bits_end(spacetime_bits *self);

void spacetime_bits_clear(spacetime_bits *self);
void spacetime_bits_copy(spacetime_bits *self, const spacetime_bits *from); // of one size
bool spacetime_bits_has(const spacetime_bits *self, int x, int y);          // outside: no
void spacetime_bits_put(spacetime_bits *self, int x, int y);
bool spacetime_bits_is_empty(const spacetime_bits *self); // by looking
bool spacetime_bits_meet(const spacetime_bits *a, const spacetime_bits *b);

void spacetime_bits_and(spacetime_bits *self, const spacetime_bits *with);
void spacetime_bits_or(spacetime_bits *self, const spacetime_bits *with);

// Adds `from` moved by (dx, dy), each within -63..63.
void spacetime_bits_or_moved(spacetime_bits *self, const spacetime_bits *from, int dx, int dy);

// Keeps cells whose neighbour at (dx, dy) is in `with`.
void spacetime_bits_and_at(spacetime_bits *self, const spacetime_bits *with, int dx, int dy);

// Takes out cells x0..x1 of row y; what is outside does not matter.
void spacetime_bits_take_out(spacetime_bits *self, int y, int x0, int x1);
#endif
