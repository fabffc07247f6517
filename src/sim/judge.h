// judge.h - looks at what truly happened: contacts, gaps, goals. Level 5.
//
// Independent of the planner: shares no line with the core but vectors; reads the vehicle_t and goals for itself. It is
// shown the true world at every tick and takes all bodies to move evenly between ticks. Where bodies come near, the
// time between two ticks is cut so that nothing moves by more than AISLE_SIM_JUDGE_STEP between two looks.
//
// Moving: the fastest body point does more than AISLE_SIM_JUDGE_MOVING. A contact is one with one body from touch to
// parting; it is a collision if the vehicle was moving at any time of it, else a contact at rest.
// Encounter: while the vehicle drives (above 0.05 m/s), a mover's reach meets its way: the mover's body grown by
// v_bound * T, T = reaction time + 0.1 s + v_max / d_max, meets the way that the vehicle would cover until rest if it
// went on at v_max, taken as straight and as wide as its body. So it does not hang on how far the planner has slowed the
// vehicle down already. The same mover counts again after AISLE_SIM_JUDGE_APART seconds without.
// A goal is visited when the vehicle has rested within its tolerance (and the slack of localisation and stopping below)
// for its dwell; in the list's order, or in any if it says so.
// Memory: the struct. Time: O(movers + solids near) a tick.
#ifndef AISLE_SIM_JUDGE_H
#define AISLE_SIM_JUDGE_H

#include "sim/movers.h"
#include "sim/scene.h"

#define AISLE_SIM_JUDGE_STEP 1e-3     // m
#define AISLE_SIM_JUDGE_MOVING 0.01   // m/s
#define AISLE_SIM_JUDGE_APART 3.0     // s
#define AISLE_SIM_JUDGE_SLACK 0.05    // m
#define AISLE_SIM_JUDGE_SLACK_TH 0.03 // rad
#define AISLE_SIM_JUDGE_SHOWN 32      // contacts kept for the report

typedef struct aisle_sim_contact {
    double t;       // s, of the first touch
    int32_t id;     // of the mover, or of the polygon, scan, bounds
    bool is_static; // with what stands still
    bool moving;
    double speed; // m/s, the greatest seen in it
    aisle_pose2 pose;
} aisle_sim_contact;

typedef struct aisle_sim_watch { // of one mover
    aisle_pose2 pose;            // at the last tick
    bool was_there, touches, counted_moving;
    uint32_t contact;  // index in contacts; >= SHOWN: not kept
    double near_until; // s, of its encounter; < 0: none yet
} aisle_sim_watch;

typedef struct aisle_sim_judge {
    const aisle_sim_scene *scene;
    aisle_sim_outline body;
    double reach;                            // m, of the body
    double stop_delay, v_max, v_back, d_max; // s, m/s2
    aisle_goal_list_msg goals;
    bool visited[AISLE_GOAL_LIST_MAX_GOALS];
    int16_t num_visited;
    double rests_since; // s, at the goal now at hand; < 0: does not
    double t;           // s, of the last tick; < 0: none yet
    aisle_pose2 pose;
    aisle_sim_watch watch[AISLE_SIM_MOVERS_MAX], still;
    aisle_sim_contact contact[AISLE_SIM_JUDGE_SHOWN];
    uint32_t num_contacts;
    int64_t collisions, contacts_at_rest, static_collisions, encounters;
    double separation;        // m, the least of all, from movers
    double separation_moving; // m, while moving
    double static_gap;        // m
    double way, moving_time;  // m, s
    double arrival;           // s, when the last goal was visited; < 0: not yet
} aisle_sim_judge;

// vehicle: as sent; zeros mean the defaults told in vehicle_t.
void aisle_sim_judge_start(aisle_sim_judge *self, const aisle_sim_scene *scene, const aisle_vehicle_msg *vehicle);

// What is to be visited from now on.
void aisle_sim_judge_take_goals(aisle_sim_judge *self, const aisle_goal_list_msg *goals);

// The true world at time t (s); speed: of the fastest body point; v: of the origin, signed, along the heading.
void aisle_sim_judge_look(aisle_sim_judge *self, double t, aisle_pose2 pose, double v, double speed,
                          const aisle_sim_movers *movers);
#endif
