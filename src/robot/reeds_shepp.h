// reeds_shepp.h - the ways of a car that drives forwards and backwards, no obstacle in sight. Level 3.
//
// Reeds & Shepp (1990), "Optimal paths for a car that goes both forwards and backwards", Pacific Journal of Mathematics
// 145(2): the shortest way between two configurations is one of 48 words of at most five pieces, arcs of the least
// radius and lines (C C C, C C C C, C S C, C C S C, C S C C, C C S C C). Given are the words that exist for a pair, the
// shortest or not: which one is free is the caller's question. Ours: a word is given only if its moves, one after the
// other, lead there within AISLE_REEDS_SHEPP_OFF radii, so that no formula is trusted.
// Memory: the caller's. Time: O(1), about 44 short formulas.
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

// The n-th word from one configuration to another for arcs of this radius (m, > 0), n below AISLE_REEDS_SHEPP_WORDS.
// False: the word does not exist there. Moves of no length are left out.
bool aisle_reeds_shepp(aisle_pose2 from, aisle_pose2 to, double radius, uint32_t n, aisle_reeds_shepp_word *word);
#endif
