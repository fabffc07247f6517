// reeds_shepp.h - the ways of a car that drives forwards and backwards, no obstacle in sight. Level 3.
//
// Reeds & Shepp (1990), "Optimal paths for a car that goes both forwards and backwards", Pacific Journal of Mathematics
// 145(2): the shortest way between two configurations is one of 48 words of at most five pieces, arcs of the least
// radius and lines (C C C, C C C C, C S C, C C S C, C S C C, C C S C C). Given are the words that exist for a pair, the
// shortest or not: which one is free is the caller's question. Ours: a word is given only if its moves, one after the
// other, lead there within AISLE_REEDS_SHEPP_OFF radii, so that no formula is trusted.
// Memory: the caller's. Time: O(1), about 44 short formulas, 3 us.
#ifndef AISLE_ROBOT_REEDS_SHEPP_H
#define AISLE_ROBOT_REEDS_SHEPP_H

#include "robot/move.h"

#define AISLE_REEDS_SHEPP_MOVES 5U
#define AISLE_REEDS_SHEPP_WORDS 44U
#define AISLE_REEDS_SHEPP_OFF 1e-9 // radii and rad

typedef struct aisle_reeds_shepp_word {
    aisle_move move[AISLE_REEDS_SHEPP_MOVES];
    uint32_t count;
} aisle_reeds_shepp_word;

typedef struct aisle_reeds_shepp { // one configuration seen from another, and the other way round; lengths in radii
    struct aisle_reeds_shepp_target {
        double x, y, phi, sine, cosine; // of phi
    } forth, back;
    double radius;
} aisle_reeds_shepp;

// For arcs of this radius, m, > 0.
aisle_reeds_shepp aisle_reeds_shepp_between(aisle_pose2 from, aisle_pose2 to, double radius);

// The n-th word, n below AISLE_REEDS_SHEPP_WORDS. False: it does not exist there, or is longer than `longest` (m). Moves
// of no length are left out.
bool aisle_reeds_shepp_word_of(const aisle_reeds_shepp *self, uint32_t n, double longest, aisle_reeds_shepp_word *word);
#endif
