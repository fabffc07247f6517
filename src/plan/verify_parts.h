// verify_parts.h - what the verifier's files ask of each other; nobody else's. Level 4.
#ifndef AISLE_PLAN_VERIFY_PARTS_H
#define AISLE_PLAN_VERIFY_PARTS_H

#include "plan/verify.h"

#include <float.h>

#define VERIFY_TOLERANCE 1e-3       // relative, of limits
#define VERIFY_REST 1e-6            // m/s; slower is at rest
#define VERIFY_SAME_PLACE 1e-9      // m
#define VERIFY_TIE 1e-6             // rad, how near half a turn both ways are proved
#define VERIFY_HEADING 2e-3         // rad, heading off the direction of motion
#define VERIFY_TIME_STEP_MAX 1.1e-3 // s, what a time may be later for being 1 ms after the one before

// ---- verify_piece.c
// Change of heading from a to b, both in [-pi, pi], the short way.
double aisle_verify_turn(double a, double b);

// The curve from one waypoint to the next. False: they define none. time and peak stay 0.
bool aisle_verify_piece_between(const aisle_waypoint_msg *from, const aisle_waypoint_msg *to, aisle_verify_piece *out);

// A vehicle that stands at w.
aisle_verify_piece aisle_verify_piece_standing(const aisle_waypoint_msg *w);

// The origin at u in [0, 1] of the piece; exact at the ends but for rounding.
aisle_vec2 aisle_verify_piece_origin(const aisle_verify_piece *piece, double u);

// Direction the origin moves in at the first (end false) or last point, rad, not wrapped.
double aisle_verify_piece_direction(const aisle_verify_piece *piece, bool end);

// ---- verify.c
// Takes the next piece in hand; there must be one.
void aisle_verify_next_piece(aisle_verify *self);

// ---- verify_limits.c
// Fills time and peak of the piece between two waypoints; dwell (s) is spent at rest before it. What their times may be
// off as floats counts towards the least peak, or with `most` towards the greatest.
void aisle_verify_time_piece(const aisle_vehicle *vehicle, const aisle_waypoint_msg *from, const aisle_waypoint_msg *to,
                             double dwell, bool most, aisle_verify_piece *piece);

// How fast a timed piece is driven. A turn is the fastest there is.
aisle_verify_speeds aisle_verify_speeds_of(const aisle_vehicle *vehicle, const aisle_waypoint_msg *from,
                                           const aisle_waypoint_msg *to, const aisle_verify_piece *piece);

// Square of the speed `way` behind the first end.
double aisle_verify_speed_square(const aisle_verify_speeds *speeds, double way);

// Up to where (from the first end, > way if that is not the last one) that square is linear.
double aisle_verify_speed_bend(const aisle_verify_speeds *speeds, double way);

// s it takes from end to end, times as they are not asked.
double aisle_verify_speed_time(const aisle_verify_speeds *speeds);

// What is wrong with waypoint i taken alone.
aisle_verify_fault aisle_verify_waypoint_fault(const aisle_verify *self, uint32_t i);

// What is wrong with piece i (self->piece), self->s and self->along being those before it.
aisle_verify_fault aisle_verify_piece_fault(const aisle_verify *self, uint32_t i);

// ---- verify_zones.c
// Does self->piece move against a DIRECTED zone inside it? fault_id and fault_at say where.
aisle_verify_fault aisle_verify_direction_fault(aisle_verify *self);

// ---- verify_base.c
// Stands both walkers at the place where the new path begins, its first piece in hand.
void aisle_verify_base_begin(aisle_verify *self);

// One step along the base. AISLE_OK: it is kept; AISLE_BUSY; AISLE_ERR_DATA: it is not, self->at and fault_at say where.
aisle_status aisle_verify_base_step(aisle_verify *self);

// Digest of all that a base is.
uint64_t aisle_verify_base_digest(uint64_t digest, const aisle_verify_base *base);

// ---- verify_motion.c
// Takes the whole of self->piece in hand.
void aisle_verify_motion_begin(aisle_verify *self);

// Looks at one interval. AISLE_OK: the piece is proved; AISLE_BUSY; AISLE_ERR_DATA: fault, fault_id and fault_at are
// set.
aisle_status aisle_verify_motion_step(aisle_verify *self);

// ---- release.c
// Digests of an encoded path_t, as aisle_stamp and as aisle_proof_basis.path have them (NULL: not wanted). One pass. False:
// too short for a path_t.
bool aisle_release_digest(const uint8_t *bytes, size_t size, uint64_t *stamp, uint64_t *path);

// The certificate for the ids in these bytes and waypoints with this crc32.
uint32_t aisle_release_certificate(uint32_t waypoints, const uint8_t *bytes);
#endif
