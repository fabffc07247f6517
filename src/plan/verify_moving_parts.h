// verify_moving_parts.h - what the files of the moving proof ask of each other; nobody else's. Level 4.
#ifndef AISLE_PLAN_VERIFY_MOVING_PARTS_H
#define AISLE_PLAN_VERIFY_MOVING_PARTS_H

#include "plan/verify_moving.h"
#include "plan/verify_parts.h"

#define MOVING_WAIT 5e-7 // rad, a turn by no more is a wait

// ---- verify_moving_motion.c
typedef enum aisle_moving_move {
    AISLE_MOVING_PHASE,  // *phase is the next one
    AISLE_MOVING_PIECE,  // the next piece is in hand: again
    AISLE_MOVING_DUE,    // the time is up
    AISLE_MOVING_END,    // the path is
    AISLE_MOVING_STRANGE // no path that verify.h proves, or not the one in the bytes
} aisle_moving_move;

// Stands at the vehicle's place. False: as STRANGE.
bool aisle_moving_motion_begin(aisle_verify_moving *self);

// Goes on by one phase, to no later than `until` (s from now).
aisle_moving_move aisle_moving_motion_next(aisle_verify_moving *self, double until, aisle_moving_phase *phase);

// The curve of piece i, as the bytes have it. False: as STRANGE.
bool aisle_moving_piece(const aisle_verify_moving *self, uint32_t i, aisle_verify_piece *out);

// Does the piece only wait?
bool aisle_moving_waits(const aisle_verify_piece *piece);

// m, of a turn in rad.
double aisle_moving_size(const aisle_verify_piece *piece);

// ---- verify_moving_gap.c
// The footprint at both ends of an interval of a piece that turns by `turn`.
void aisle_moving_sweep_over(const aisle_verify_moving *self, double lo, double hi, aisle_moving_sweep *out);

// A lower bound (m) of the distance of the footprint from p over the interval, or of that of its discs about both
// origins where this is at least `enough`.
double aisle_moving_gap(const aisle_verify_moving *self, aisle_vec2 p, double enough);

// The distance (m) of the footprint from p at the end of the interval; less if p is inside.
double aisle_moving_end_gap(const aisle_verify_moving *self, aisle_vec2 p);
#endif
