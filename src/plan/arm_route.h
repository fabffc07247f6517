// arm_route.h - one arm goal from start to proved motion or reason. Level 4.
//
// CHECK start and goals exactly; a goal of a place has up to AISLE_ARM_SOLUTIONS_MAX configurations, those that are free in the order of the
// joint angle between. DIRECT: the motion along the straight line of joint angles, to each of them; the first that is free has the
// least joint angle travelled of all to that one. Where none is free, or the objective may gain something, SEARCH (arm_search.h) over
// one bent piece, to each of the nearest AISLE_ARM_TRIES; where that finds none TREE, RRT_STAR_ADAPTIVE over joint angles
// (arm_space.h), its path PULLed taut. TIME each piece (arm_motion.h; with PAPER
// arm_time.h, but a piece that its 100 s are too short for keeps the exact one). JOIN pieces of a tree's path (arm_join.h; not with
// PAPER): it rests at those via-points alone where no bent piece gets by. BUILD (arm_compose.h), VERIFY
// (verify_arm.h): where the quintics on the wire are over a limit by what rounding took, all is run slower by AISLE_ARM_STRETCH and proved
// again, AISLE_ARM_STRETCHES times at most.
// By objective: SHORTEST and SAFEST take a straight motion as it is (SAFEST one that keeps AISLE_ARM_CREEP); FASTEST, LEAST_ENERGY and
// SAFEST else search beyond it. PAPER: the paper's searches alone (arm_search.h, arm_time.h).
// By planner: AUTO all of the above; GA and PSO no tree; RRT, RRT_ADAPTIVE, RRT_STAR, RRT_STAR_ADAPTIVE the tree alone; others as AUTO.
// Causes: JOINT_LIMIT (id: the joint, from 1) start, goal or every way to it is out of a joint's limits; OUT_OF_REACH (value: by how
// much, m); START_OCCUPIED, GOAL_OCCUPIED (id: the obstacle, of arm_world.h; of several configurations the nearest one's);
// NO_ARM; KINEMATIC (id: the joint) a motor does not hold the arm; MALFORMED a number no arm can mean; LIMIT (id 1: obstacles in reach,
// 2: waypoints of the message); BUDGET no motion was found, which proves nothing; VERIFY_FAILED.
// Budget: units of all together; half of it for SEARCH.
// Memory: the caller's arena: about 0.3 MiB and 98 bytes a node of the tree. Time: the budget and a piece of a stage.
#ifndef AISLE_PLAN_ARM_ROUTE_H
#define AISLE_PLAN_ARM_ROUTE_H

#include "plan/arm_compose.h"
#include "plan/arm_join.h"
#include "plan/arm_search.h"
#include "plan/arm_space.h"
#include "plan/arm_time.h"
#include "plan/verify_arm.h"

#define AISLE_ARM_TRIES 4U
#define AISLE_ARM_STRETCH 1.001
#define AISLE_ARM_STRETCHES 24U
#define AISLE_ARM_NODES 16384U // of a tree, at most

typedef struct aisle_arm_request {
    aisle_arm_goal_msg goal;
    aisle_pose2 pose; // of the vehicle, at rest
} aisle_arm_request;

typedef enum aisle_arm_stage {
    AISLE_ARM_STAGE_IDLE,
    AISLE_ARM_STAGE_CHECK,
    AISLE_ARM_STAGE_DIRECT,
    AISLE_ARM_STAGE_SEARCH,
    AISLE_ARM_STAGE_TREE,
    AISLE_ARM_STAGE_PULL,
    AISLE_ARM_STAGE_TIME,
    AISLE_ARM_STAGE_JOIN,
    AISLE_ARM_STAGE_BUILD,
    AISLE_ARM_STAGE_VERIFY,
    AISLE_ARM_STAGE_END
} aisle_arm_stage;

typedef struct aisle_arm_route {
    const aisle_layout *layout;
    const aisle_vehicle *vehicle;
    aisle_arm arm;
    aisle_arm_request request;
    aisle_arm_stage stage;
    aisle_arm_world world;
    aisle_arm_dynamics dynamics;
    aisle_arm_search search;
    aisle_arm_space space;
    aisle_rrt tree;
    aisle_arm_time *time; // of PAPER
    aisle_arm_join *join;
    aisle_arm_solutions *goals; // free ones
    aisle_arm_plan *plan;
    aisle_arm_path_msg *path;    // being composed; its head is the caller's
    aisle_arm_path_msg *decoded; // the verifier's
    uint32_t *nodes;             // [capacity of the tree + 1] of its path
    uint8_t *bytes;              // [AISLE_ARM_PATH_BYTES]
    size_t size;
    aisle_stamp stamp;
    aisle_verify_arm verify;
    double start[AISLE_ARM_LINKS];
    uint32_t at; // goal under way
    uint32_t node_count, node_at,
        node_to;    // of the tree's path: how many, where the pulled one is, what is tried from there
    uint32_t timed; // piece under way in TIME
    double stretch;
    uint32_t stretches;
    uint32_t spent, budget;
    bool has_direct;     // a straight motion is free; SEARCH only betters it
    aisle_refusal cause; // with no path
    int64_t verify_failed, intervals;
    aisle_collide_count collide;
} aisle_arm_route;

// self NULL: to measure only. nodes: of the tree.
void aisle_arm_route_carve(aisle_arm_route *self, aisle_arena *arena, uint32_t nodes);

// Begins; the arm is vehicle_msg's (NO_ARM, or MALFORMED with the member's place). self->path holds ids and times of the answer.
// budget: of a goal that names none. layout and vehicle stay until the end; the request is copied.
void aisle_arm_route_start(aisle_arm_route *self, const aisle_layout *layout, const aisle_vehicle *vehicle,
                           const aisle_vehicle_msg *vehicle_msg, const aisle_arm_request *request, uint32_t budget);

// AISLE_BUSY; AISLE_OK: done: size > 0 and bytes, stamp are the proved answer, or size is 0 and cause says why.
aisle_status aisle_arm_route_step(aisle_arm_route *self, uint32_t units);
#endif
