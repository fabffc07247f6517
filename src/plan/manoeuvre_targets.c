#include "base/angle.h"
#include "base/check.h"
#include "plan/manoeuvre_parts.h"

#include <math.h>

#define LANE_STEP 0.5     // m, between configurations in line with the goal
#define LANE_STEPS 12U    // to either side
#define SPACING 2.0       // m, between targets on one leg of the way
#define SHORTEST_LEG 0.05 // m, of the way that gives a target
#define END_SHARE 0.02    // of a leg, how far from its ends the first and last target are
#define SHIFT 0.16        // m, first step across the way when it looks for room
#define SHIFT_LAST 0.002  // m, and the last one
#define TILT 0.08         // rad, of heading, for SHIFT
#define GOAL_HEADINGS 16U // of a car at a goal of any heading
#define SEEN 2.0          // m, room beyond it is as good

typedef enum part { GOALS = 0, LANES = 32, WAY = 96 } part; // what next_target means from each on

void aisle_manoeuvre_add_target(aisle_manoeuvre *self, aisle_pose2 pose, double togo, uint32_t node) {
    if (self->target_count < AISLE_MANOEUVRE_TARGETS && togo < (double)INFINITY) {
        pose.theta = aisle_angle_wrap(pose.theta);
        self->target[self->target_count++] = (aisle_manoeuvre_target){.pose = pose, .togo = togo, .node = node};
    }
}

// At most half of all are made here: the rest is for the tree.
static void add(aisle_manoeuvre *self, aisle_pose2 pose, bool is_goal) {
    double about = aisle_max(aisle_togo_at(&self->togo, aisle_pose_place(pose)), 1e-3);
    if (self->target_count < AISLE_MANOEUVRE_TARGETS / 2U) {
        aisle_manoeuvre_add_target(self, pose, is_goal ? 0.0 : about, AISLE_HEAP_NONE);
    }
}

void aisle_manoeuvre_begin_targets(aisle_manoeuvre *self) {
    self->target_count = 0;
    self->next_target = GOALS;
}

// ---- the goal

// A vehicle that turns on the spot comes to a goal of any heading by any: two targets, their headings made to order.
static void add_goal(aisle_manoeuvre *self, uint32_t n) {
    aisle_pose2 goal = self->request.goal;
    bool car = self->rule.radius_min > 0.0;
    if (!self->request.goal_is_free) {
        if (n == 0U) {
            add(self, goal, true);
        }
    } else if (!car) {
        if (n < 2U) {
            add(self, goal, true);
        }
    } else if (n < GOAL_HEADINGS) {
        goal.theta = 2.0 * AISLE_PI * (double)n / (double)GOAL_HEADINGS;
        if (aisle_manoeuvre_pose_free(self, goal)) {
            add(self, goal, true);
        }
    }
}

// In line with the goal, before it (even n) and behind it, as far as the way between is free.
static bool add_lane(aisle_manoeuvre *self, uint32_t n) {
    if (self->request.goal_is_free || n >= 2U * LANE_STEPS) {
        return false;
    }
    aisle_pose2 goal = self->request.goal;
    double way = n % 2U == 0U ? -1.0 : 1.0;
    aisle_move move = {way * LANE_STEP * (double)(n / 2U + 1U), 0.0};
    if (aisle_manoeuvre_moves_free(self, goal, &move, 1)) {
        add(self, aisle_move_end(goal, move), false);
    }
    return true;
}

// ---- along the way

// The middle line of the body, as long as discs in it reach its sides: room about it is what centres the body.
static aisle_convex spine_at(const aisle_vehicle *vehicle, aisle_pose2 pose, aisle_vec2 ends[2]) {
    aisle_aabb box = aisle_convex_aabb(&(aisle_convex){vehicle->footprint, vehicle->n, 0.0});
    double half = 0.5 * (box.hi.y - box.lo.y);
    double middle = 0.5 * (box.lo.x + box.hi.x);
    double reach = aisle_max(0.5 * (box.hi.x - box.lo.x) - half, 0.0);
    double side = 0.5 * (box.lo.y + box.hi.y);
    const aisle_vec2 own[2] = {{middle - reach, side}, {middle + reach, side}};
    aisle_convex_place(own, 2, pose, ends);
    return (aisle_convex){ends, 2U, 0.0};
}

static double room_at(aisle_manoeuvre *self, aisle_pose2 pose) {
    aisle_vec2 ends[2];
    aisle_convex spine = spine_at(self->request.space->vehicle, pose, ends);
    self->units += 1U;
    return aisle_layout_gap(self->request.space->layout, &spine, SEEN, NULL);
}

static aisle_pose2 beside(aisle_pose2 pose, double shift, double tilt) {
    double sine, cosine;
    aisle_sincos(pose.theta, &sine, &cosine);
    return (aisle_pose2){pose.x - shift * sine, pose.y + shift * cosine, pose.theta + tilt};
}

// To where the body has most room across the way and by its heading, a pattern search. False: it is not free there.
static bool centre(aisle_manoeuvre *self, aisle_pose2 *pose) {
    static const double tried[6][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, -1}, {-1, 1}};
    double best = room_at(self, *pose);
    for (double step = SHIFT; step > SHIFT_LAST;) {
        aisle_pose2 from = *pose;
        bool better = false;
        for (uint32_t i = 0; i < sizeof tried / sizeof tried[0]; i++) {
            aisle_pose2 p = beside(from, step * tried[i][0], step / SHIFT * TILT * tried[i][1]);
            double room = room_at(self, p);
            if (room > best + 1e-6) {
                best = room;
                *pose = p;
                better = true;
            }
        }
        step = better ? step : 0.5 * step;
    }
    return aisle_manoeuvre_pose_free(self, *pose);
}

// A configuration on the way and the one that faces back: as it is where that is free, and in the middle of the room.
static void add_both(aisle_manoeuvre *self, aisle_pose2 pose) {
    for (int back = 0; back < 2; back++) {
        aisle_pose2 p = {pose.x, pose.y, pose.theta + (back != 0 ? AISLE_PI : 0.0)};
        if (aisle_manoeuvre_pose_free(self, p)) {
            add(self, p, false);
        }
        if (room_at(self, p) < SEEN && centre(self, &p)) {
            add(self, p, false);
        }
    }
}

// How far from corner i of the way its rounding begins, m.
static double cut_at(const aisle_manoeuvre *self, uint32_t i) {
    const aisle_vec2 *p = self->request.way;
    if (i == 0U || i + 1U >= self->request.way_count) {
        return 0.0;
    }
    aisle_vec2 u = aisle_vec2_sub(p[i], p[i - 1U]), v = aisle_vec2_sub(p[i + 1U], p[i]);
    double cross = fabs(aisle_vec2_cross(u, v)), dot = aisle_vec2_dot(u, v);
    double product = aisle_vec2_length(u) * aisle_vec2_length(v);
    return product + dot > 1e-9 ? self->request.way_radius * cross / (product + dot) : 0.0;
}

// The targets on the leg of the way after point i.
static void add_leg(aisle_manoeuvre *self, uint32_t i) {
    const aisle_vec2 *p = self->request.way;
    aisle_vec2 way = aisle_vec2_sub(p[i + 1U], p[i]);
    double whole = aisle_vec2_length(way);
    double from = cut_at(self, i), to = whole - cut_at(self, i + 1U);
    if (to - from < SHORTEST_LEG) {
        return;
    }
    double parts = floor((to - from) / SPACING) + 1.0;
    double theta = aisle_atan2(way.y, way.x);
    for (double k = 0.0; k <= parts; k += 1.0) {
        double f = aisle_clamp(k / parts, END_SHARE, 1.0 - END_SHARE);
        aisle_vec2 at = aisle_vec2_lerp(p[i], p[i + 1U], (from + f * (to - from)) / whole);
        add_both(self, (aisle_pose2){at.x, at.y, theta});
    }
}

bool aisle_manoeuvre_make_target(aisle_manoeuvre *self) {
    uint32_t n = self->next_target++;
    if (n < LANES) {
        add_goal(self, n);
    } else if (n < WAY) {
        if (!add_lane(self, n - LANES)) {
            self->next_target = WAY;
        }
    } else {
        uint32_t i = n - WAY;
        if (i + 1U >= self->request.way_count) {
            return false;
        }
        add_leg(self, i);
    }
    return true;
}
