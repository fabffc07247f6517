// arm_free.h - is a whole motion of the arm free? Level 4.
//
// Configuration by configuration (Schwarzer, Saha & Latombe 2005, "Adaptive dynamic collision checking"): what is free around the middle
// of an interval is compared with how far a link can move to its ends, and what that leaves open on both sides is looked at likewise.
// A point of link i moves by no more than
//     sum over k <= i of |d phi_k| * length_k,     phi_k = the direction of link k,
// and for the last of three links, seen from the first, that of directions less phi_1; |d phi| over h is at most |phi'| h + max |phi''|
// h^2 / 2. Gaps are looked for as far as they count, so that most obstacles are out of sight of most looks. Continuous: true means
// that every configuration on the motion keeps half of AISLE_ARM_KEEP, false that one keeps less than it. Joint limits are not
// looked at. Shares no code with the proof of what leaves (verify_arm.h).
// Memory: 1 KiB of stack. Time: O(looks * obstacles near); AISLE_ARM_UNITS a look, added to *units.
#ifndef AISLE_PLAN_ARM_FREE_H
#define AISLE_PLAN_ARM_FREE_H

#include "plan/arm_world.h"

#define AISLE_ARM_STEP_MIN 1e-7 // of a motion: where less is free to either side nothing is

// Along a piece, from its beginning on. *until (may be NULL): [0, 1], as far as it is known to be free.
bool aisle_arm_free_piece(const aisle_arm_world *world, const aisle_arm_piece *piece, uint32_t *units, double *until);

// Along the straight line of joint angles.
bool aisle_arm_free_line(const aisle_arm_world *world, const double *from, const double *to, uint32_t *units);
#endif
