// local_parts.h - what local*.c share. Level 4.
#ifndef AISLE_PLAN_LOCAL_PARTS_H
#define AISLE_PLAN_LOCAL_PARTS_H

#include "plan/local.h"

#define AISLE_LOCAL_NOBODY UINT32_MAX // no mover

// Takes the movers over as they will be at from_us.
void aisle_local_take_movers(aisle_local *self);
// Lists those that a line from p at `when` (s), no longer than the range, can meet.
void aisle_local_list_near(aisle_local *self, aisle_vec2 p, double when);
// Does the body from a at `when` to b meet a mover's disc? Which; NOBODY: none. `listed`: among those near alone.
uint32_t aisle_local_meets(const aisle_local *self, aisle_vec2 a, aisle_vec2 b, double when, bool listed);
// Is the line free of everything? a at `when`.
bool aisle_local_line_free(aisle_local *self, aisle_vec2 a, aisle_vec2 b, double when, bool listed);
// The rest of the old way behind `c`, from way[first] on, c at `when`: the first of its pieces that meets a mover, by
// the index of its end; way_count: none does.
uint32_t aisle_local_way_meets(const aisle_local *self, aisle_vec2 c, uint32_t first, double when);
// Farthest place of the old way in range, in sight of p (at `when`), its rest free. False: none. *first: way's next.
bool aisle_local_find_rejoin(aisle_local *self, aisle_vec2 p, double when, aisle_vec2 *at, uint32_t *first);
// One attempt to shorten the new points. False: nothing left to do.
bool aisle_local_tidy(aisle_local *self);
#endif
