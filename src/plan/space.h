// space.h - where the vehicle may be: the search's own collision test. Level 4.
//
// Two ways to stand for the body that is driven straight. FREE_TURN: the disc about the origin that holds the footprint
// at every heading; what it sweeps can be driven with any turns. ALONG: the exact footprint with its heading along the
// motion; used where the disc does not fit. Both keep margin + AISLE_SPACE_SLACK from obstacles; the slack is what the
// verifier needs for its sagittas. Pieces and moves, which may bend and turn, are tested as the footprint with their
// own headings, whatever the mode, and keep what is asked. Order of tests: bounds from the distance field first, the
// exact gap only where they leave a doubt (near contours). The verifier shares none of this.
// Memory: one bit a cell and 16 KiB. Time: O(1) from the field; O(obstacles near) for an exact test. What is given
// `units` adds its work to it.
#ifndef AISLE_PLAN_SPACE_H
#define AISLE_PLAN_SPACE_H

#include "base/arena.h"
#include "robot/move.h"
#include "robot/vehicle.h"
#include "world/layout.h"

#define AISLE_SPACE_SLACK 5e-4 // m
#define AISLE_SPACE_DEPTH_MAX 5U
#define AISLE_SPACE_PIECE 0.5   // m, longest sweep given to one exact test
#define AISLE_SPACE_ROOTS 4096U // field values whose square root is tabulated
#define AISLE_CLEARANCE_CAP 2.0 // m, a larger clearance is told as this

typedef enum aisle_space_mode { AISLE_SPACE_FREE_TURN, AISLE_SPACE_ALONG } aisle_space_mode;

typedef struct aisle_space {
    const aisle_layout *layout;
    const aisle_grid *grid;
    const aisle_vehicle *vehicle;
    aisle_space_mode mode;
    double keep;         // margin + slack, m
    double reach;        // FREE_TURN: outer radius + keep; ALONG: inner radius + keep (necessary, not sufficient)
    float *root;         // [AISLE_SPACE_ROOTS] by field value
    double per_metre;    // cells
    uint64_t *cell_free; // [cells / 64 + 1] bits: an exact test of this cell said yes
    uint32_t cells;
    uint32_t known_from, known_end; // words of cell_free outside [known_from, known_end) are 0
    uint32_t far_field;             // a cell of this field value or more is far: nothing there depends on the clearance
    double far_clearance;           // m, what is told of far places
    uint32_t covered_below;         // a place in a cell of a lower field value is covered,
    uint32_t covered_until; // in one of this value or more it is not; between them it hangs on where in the cell it is
    double beyond; // m, what an obstacle may lie beyond the centre of its occupied cell; negative where cells are solid
    double lever;  // m, farthest footprint point from the origin, its rounding left out
    double zone_room; // m, that sweeps keep off DIRECTED zones they are against (zones.h); begin() leaves it alone
    // ALONG: discs on the body's x axis that hold the footprint, for a quick yes
    double disc_x[4], disc_radius;
} aisle_space;

void aisle_space_carve(aisle_space *self, aisle_arena *arena, uint32_t cells);

// Turns to a layout in force and a vehicle. O(words of cell_free that were written since the last time).
void aisle_space_begin(aisle_space *self, const aisle_layout *layout, const aisle_vehicle *vehicle,
                       aisle_space_mode mode);

// FREE_TURN: may the disc stand in the cell's centre so that every move of `step` (m, straight; diagonal sqrt(2) of
// it) to another such centre is free? (Both ends at least sqrt(reach^2 + step^2 / 2) from a point keep the segment at
// least reach from it.) Remembered: within one begin() step must not grow.
bool aisle_space_cell_free(aisle_space *self, uint32_t cell, double step, uint32_t *units);

// The roomiest point of a cell, climbed to from its centre by a pattern search (8 directions, halving down to 1/256
// of a cell): a local maximum of the exact gap, deterministic. *gap: there, m, at most reach + a cell. About 60 exact
// gaps.
aisle_vec2 aisle_space_roomiest(const aisle_space *self, uint32_t cell, double *gap, uint32_t *units);

// Is the straight way from a to b free for the exact footprint with its heading along it, whatever the mode, and
// against no DIRECTED zone? a = b: false.
bool aisle_space_body_sweep_free(const aisle_space *self, aisle_vec2 a, aisle_vec2 b, uint32_t *units);

// Can the body turn to any heading at p?
bool aisle_space_turn_free(const aisle_space *self, aisle_vec2 p, uint32_t *units);

// Does the cell hold a point `reach` (m) or more from every obstacle? Branch and bound on the exact gap, `depth`
// halvings deep, at most AISLE_SPACE_DEPTH_MAX: "no" is a proof; "yes" may be wrong by 2^-depth of a cell's half
// diagonal. A yes is remembered until forget(), so reach and depth stay the same meanwhile.
bool aisle_space_cell_holds(aisle_space *self, uint32_t cell, double reach, uint32_t depth, uint32_t *units);

// The same of a cell's square about `centre`, the exact part alone, with some polygons left out (NULL: none).
bool aisle_space_square_holds(const aisle_space *self, const aisle_layout_without *without, aisle_vec2 centre,
                              double reach, uint32_t depth, uint32_t *units);
void aisle_space_forget(aisle_space *self); // O(words written)

// The bits that the tests above remember by, for others between forget() and forget().
void aisle_space_note(aisle_space *self, uint32_t cell);
bool aisle_space_is_noted(const aisle_space *self, uint32_t cell);

// Is the straight way from a to b free, heading along it (ALONG) or any (FREE_TURN), and against no DIRECTED zone?
// a = b: the place alone.
bool aisle_space_sweep_free(const aisle_space *self, aisle_vec2 a, aisle_vec2 b, uint32_t *units);

// Gap between the footprint at pose and the nearest obstacle (exact), at most cap; *id that obstacle.
double aisle_space_gap(const aisle_space *self, aisle_pose2 pose, double cap, int32_t *id);

// Is p so far from everything that the margin is kept at every heading and no objective cares? One look at the field.
bool aisle_space_is_far(const aisle_space *self, aisle_vec2 p);

// Is p surely so near to an obstacle that its centre may not be there (FREE_TURN: that the disc may not, ALONG: that no
// body may)? One look at the field: "yes" is a proof, "no" says nothing.
bool aisle_space_is_covered(const aisle_space *self, aisle_vec2 p);

// About the clearance of the footprint driven through p: the field, interpolated, less the inner radius; far_clearance
// where far. Cheap; for costs, but never above the truth by as much as a cell's side: the four centres' distances are
// told right, and p lies within half a diagonal of their weighted mean as an obstacle does of its cell's centre.
double aisle_space_clearance_about(const aisle_space *self, aisle_vec2 p);

// Least gap of the footprint over the whole piece between two waypoints, at most AISLE_CLEARANCE_CAP: a lower bound, at
// most 2 mm below the truth for discs and straight pieces, 6 mm where a polygon turns (the hull of two placements
// reaches beyond the sweep by up to half the turn times the lever). Where nothing hangs on it, it may be told too
// little by more: by a sixteenth from creep_clearance on, by 25 mm where `rough` and surely below that. The piece is
// halved only where the bound of a part may lower the answer. O(parts * obstacles near), a unit for each exact gap.
double aisle_space_piece_clearance(const aisle_space *self, const aisle_waypoint_msg *from,
                                   const aisle_waypoint_msg *to, bool rough, uint32_t *units);

// Is that gap `need` (m, > 0) or more? "Yes" is sure; "no" may be wrong within 0.2 mm of need for discs and straight
// pieces, 5 mm where a polygon turns. Ends with the first placement that is too near. Units as above.
bool aisle_space_piece_free(const aisle_space *self, const aisle_waypoint_msg *from, const aisle_waypoint_msg *to,
                            double need, uint32_t *units);

// The same all along these moves from a configuration on, one after the other, and against no DIRECTED zone. backwards
// in time: they are driven the other way round, from their end to `from`.
bool aisle_space_moves_free(const aisle_space *self, aisle_pose2 from, const aisle_move *moves, uint32_t count,
                            double need, bool backwards, uint32_t *units);
#endif
