// verify_moving.h - proves that a path may be driven on for a while among moving obstacles: the moving half of the gate
// between planning and sending. Level 4.
//
// Works on the encoded path, after verify.h has proved it on the layout, and shares the verifier's curve and speeds
// (verify_piece.c, verify_limits.c) and none of the planner's code; where movers can be is world/movers.h's.
//
// Proved is passive safety (Macek, Vasquez, Fraichard and Siegwart 2009, "Towards safe vehicle navigation in dynamic urban
// scenarios") for a lease L: for every tau in [0, L] let the vehicle, from its place on the path, follow it until tau +
// reaction_time and then brake along it with d_max (a turn on the spot with alpha_max) to rest. While it moves, its
// footprint grown by margin is off every mover's reach at that instant. A vehicle that stands may be touched: that is the
// other's doing. Nothing is claimed beyond the lease: a reach grows without bound; each renewal is a new proof.
// Ours: one sweep over the path instead of one over the instants. A reach grows with time only, so of all these motions
// the one counts that is at a place last while it still moves. Speeds at one place rise with tau, for the path itself brakes
// with d_max at most. So the last one at q is the motion that comes to rest at q. With v, s, t, a of the path (acceleration
// a) at the instant that this one begins to brake, D = d_max:
//     q = s + v^2 / 2D,  theta = t + v / D;   from q:  v^2 = (v0^2 + 2 a (q - s0)) D / (a + D)
// or, where none rests, before the first of these places, the one with tau = 0. The sweep covers the path up to
// the last place of rest and asks each place at theta + AISLE_DRIVE_LAG, and later by `late` as far as braking does not begin after the last of them.
// Intervals of the sweep, as in verify.h: the hull of the footprint at both ends, grown by margin, the sagittas of arc and
// turn and AISLE_VERIFY_EPSILON, is proved off the reaches at the last instant of the interval. A direction in which they are
// apart is enough. What is not proved is halved, for the movers left alone, until each point of the body moves by less than
// 1 mm. The end of an interval is a place and an instant of the sweep, so refused is only what comes nearer there than the
// margin and 1 mm.
//
// The motion. Speeds as in verify.h: linear in the square between moving ends, the trapezoid that fills the time (a goal's
// dwell taken off) between resting ones. A turn is the fastest trapezoid that omega_max and alpha_max let it; what is left
// of its time, and of that of a piece that begins at rest, is rest before it. A turn of at most 5e-7 rad is a wait. Time that
// moving pieces have beyond their speeds' (verify.h allows 1.1 ms each and 0.1 %) makes all that is behind them late.
// A turn that is faster than by the path (a path made anew in it begins it at rest) is one that began earlier.
// A real speed above the path's is braked down to it with d_max first (at rest where the path is, at the latest). One below it by more than a_max * AISLE_DRIVE_LAG is
// proved twice: as if it were the path's, and catching up with a_max.
// Rest before the vehicle goes on from its place: what is left of a wait it is in. A dwell that is behind, or ahead by no more
// than its goal's tolerance while the vehicle stands (0.02 m/s), counts as begun, and one that has begun as over: a controller
// counts its time for itself. What may be left of it is the caller's to add to `late`.
//
// Memory: the caller's struct, 6 KiB. Time: O(waypoints) once, O(movers), then O(intervals * movers near), sliced.
#ifndef AISLE_PLAN_VERIFY_MOVING_H
#define AISLE_PLAN_VERIFY_MOVING_H

#include "plan/verify.h"
#include "world/movers.h"

#define AISLE_DRIVE_LAG 0.1             // s, a vehicle may be later than its path says
#define AISLE_MOVING_CLEARANCE_MAX 2.0  // m, more is not told
#define AISLE_MOVING_CLEARANCE_OFF 0.05 // m, the clearance told may be below the true one

typedef struct aisle_moving_request {
    const aisle_vehicle *vehicle;
    const aisle_movers *movers; // must not change until the end
    const uint8_t *bytes;       // encoded path_t, stays put until the end
    size_t size;
    const aisle_path_msg *path; // decoded from these bytes
    uint32_t at_piece;          // where the vehicle is: index of the piece's later waypoint, [1, n-1] (n = 1: 0),
    double at_u;  // and the part of it behind, [0, 1]; of the turn in a turn on the spot, of the time in a wait
    double v;     // m/s >= 0, how fast it is
    double omega; // rad/s >= 0, how fast it turns; counts where it is in a turn on the spot
    const aisle_goal_msg *goals; // [num_goals], those of the path in order, for their dwell and tolerance
    uint32_t num_goals;
    int64_t now_us;
    double lease; // s, [0, 60]
    double
        late; // s >= 0, that the vehicle may be behind its path's times beyond AISLE_DRIVE_LAG: who may take the whole
              // reaction_time to set out, or to obey a path that is slower than the one before, is late by so much
} aisle_moving_request;

// ---- the verifier's own

typedef struct aisle_moving_motion { // along the path; verify_moving_motion.c
    uint32_t piece;                  // in hand
    double done;                     // m, rad in a turn, of it behind
    aisle_verify_speeds speeds;      // of it
    bool turns;                      // on the spot
    double extra;                    // rad, of the first piece: done and the length of its speeds are so much more
    double rest;                     // s, before it goes on
    double clock;                    // s from now
    double late;                     // s that it may be later
    double square;                   // of its speed
    int pull;                        // 1: catching up with the path's speed, -1: braking down to it, 0: at it
    double run;                      // m or rad from the first end of the piece in which it left rest last
    double way;                      // m from the place it began at
    uint32_t goals;                  // at or before the first end of the piece
    bool spares_dwell;               // the next goal's, if it is near
    bool leaves_rest;                // the next phase is the first of a run
} aisle_moving_motion;

typedef struct aisle_moving_phase { // of it, at constant acceleration
    double from, to;                // m or rad of the run
    double v0, v1, a;
    double begins, late; // s
} aisle_moving_phase;

typedef struct aisle_moving_stretch { // of the sweep: places of a run, and when the last motion is there
    double from, to;                  // m or rad of the run
    aisle_moving_phase phase;
    double down; // > 0: theta, of the motions that brake so from the phase; 0: of the phase itself
} aisle_moving_stretch;

typedef struct aisle_moving_sweep {                                      // the interval in hand
    aisle_vec2 a[AISLE_SHAPE_VERTICES_MAX], b[AISLE_SHAPE_VERTICES_MAX]; // footprint at both ends
    aisle_vec2 origin_a, origin_b;
    double sagitta, travel; // m, and m of every body point
    int64_t at_us;          // end of the interval
} aisle_moving_sweep;

typedef enum aisle_moving_stage {
    AISLE_MOVING_START,
    AISLE_MOVING_WINDOW, // box around all ground that can be covered
    AISLE_MOVING_NEAR,   // movers that can come near it
    AISLE_MOVING_FOLLOW, // tau = 0, up to where it begins to brake
    AISLE_MOVING_BRAKE,  // and to where it rests
    AISLE_MOVING_REST,   // places of rest of the others
    AISLE_MOVING_DONE
} aisle_moving_stage;

typedef struct aisle_verify_moving {
    aisle_moving_request request;

    // Proved: least distance (m) from the footprint to a reach in the whole sweep, at most AISLE_MOVING_CLEARANCE_OFF too
    // small; AISLE_MOVING_CLEARANCE_MAX: that or more.
    double clearance;
    // Refused: the mover, and the first place of the sweep where it cannot be excluded.
    int32_t blocker; // its id
    uint8_t blocker_source;
    aisle_pose2 blocked_at;
    double blocked_way; // m from the vehicle's place
    int64_t blocked_us; // when the reach is asked there
    // Refused, no mover to blame: the bytes or movers changed, path is not what is in the bytes or no path that verify.h
    // proves.
    bool is_unfit;
    uint32_t intervals; // looked at

    aisle_moving_stage stage;
    bool has_second_pass, is_second_pass; // the one that catches up
    aisle_status answer;
    uint64_t digest; // of the bytes at the start
    bool unbroken;   // and no step has ended since: nobody can have changed them
    uint32_t movers_revision;
    double lever;  // m, farthest footprint point from the origin
    double window; // m of path that can be driven, then what is left of it
    aisle_aabb box;
    double last;                     // s from now, no place is asked later
    uint16_t near[AISLE_MOVERS_MAX]; // movers, those not proved off the interval in hand in front
    uint32_t near_count, scanned;
    double least; // m, of distances met
    aisle_moving_motion motion;
    aisle_moving_stretch stretch;
    // The piece that is swept, and the part of it in hand.
    uint32_t piece;
    aisle_verify_piece curve;
    double turn;                        // way round in hand
    double origin;                      // of its first end in the run
    double behind;                      // m of runs before
    double swept;                       // of the run, up to which the stretch is proved
    double portion;                     // and will be after the part in hand
    double lo, hi[AISLE_VERIFY_DEPTH];  // part of the piece, as in aisle_verify_motion
    uint32_t count[AISLE_VERIFY_DEPTH]; // movers in front that are to be looked at in it
    uint32_t depth, next, kept;         // next: mover to look at; kept: of those before, not proved off
    aisle_moving_sweep sweep;
} aisle_verify_moving;

// Begins. O(1).
void aisle_verify_moving_start(aisle_verify_moving *self, const aisle_moving_request *request);

// Looks at no more than `units`: one for 16 movers against an interval, for 64 movers against the box, for a piece or a
// phase of the motion, and one for the rest. AISLE_BUSY; AISLE_OK: proved, *stamp written; AISLE_ERR_DATA: refused, *stamp
// zeroed (as with AISLE_BUSY). *spent is added to. Further calls repeat the answer and cost nothing. However cut into
// steps, answer and counts are the same. A path of one waypoint, and one without movers, is always proved.
aisle_status aisle_verify_moving_step(aisle_verify_moving *self, uint32_t units, uint32_t *spent,
                                      aisle_moving_stamp *stamp);
#endif
