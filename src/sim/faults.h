// faults.h - things that go wrong at a told time, and how soon the planner answers them. Level 5.
//
//     pose_silent       no pose is told
//     unlocalized       poses say localized = false
//     pose_jump         the localiser is off by `amount` m (along x)
//     obstacles_silent  no source tells of anything
//     paths_lost        no path arrives at the vehicle
//     push              the vehicle is shoved `amount` m to its left at once
//     slow              the vehicle drives at `amount` of the speeds told, as when its scanner slows it down (0..1)
//     hold              COMMAND HOLD, RESUME when it is over
//
// The answer to a fault is the first path message of status STOP or NONE from its beginning on.
// Memory: the structs. Time: O(faults).
#ifndef AISLE_SIM_FAULTS_H
#define AISLE_SIM_FAULTS_H

#include "base/rng.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define AISLE_SIM_FAULTS_MAX 8

typedef enum aisle_sim_fault_kind {
    AISLE_SIM_POSE_SILENT,
    AISLE_SIM_UNLOCALIZED,
    AISLE_SIM_POSE_JUMP,
    AISLE_SIM_OBSTACLES_SILENT,
    AISLE_SIM_PATHS_LOST,
    AISLE_SIM_PUSH,
    AISLE_SIM_SLOW,
    AISLE_SIM_HOLD,
    AISLE_SIM_FAULT_COUNT
} aisle_sim_fault_kind;

typedef struct aisle_sim_fault {
    aisle_sim_fault_kind kind;
    double at, lasts, amount; // s, s, m
    bool begun, ended;        // the episode has seen it
    double answered, rested;  // s after `at`; below 0: not yet
    int8_t status;            // of the answer
    int16_t cause;
} aisle_sim_fault;

typedef struct aisle_sim_faults {
    aisle_sim_fault fault[AISLE_SIM_FAULTS_MAX];
    uint32_t count;
} aisle_sim_faults;

const char *aisle_sim_fault_name(aisle_sim_fault_kind kind);

// Reads KIND:AT:LASTS[:AMOUNT],...; amounts are 0.5 by default. False: not such a list.
bool aisle_sim_faults_read(aisle_sim_faults *self, const char *text);

// Adds `count` (at most so many as fit) at any time of the first `span` seconds, 0.2 to 3 s long; no jumps of the pose
// and no pushes, after which nobody knows where the vehicle is.
void aisle_sim_faults_draw(aisle_sim_faults *self, aisle_rng *rng, uint32_t count, double span);

// The fault of this kind that is on at `now` (s); NULL: none.
const aisle_sim_fault *aisle_sim_faults_active(const aisle_sim_faults *self, aisle_sim_fault_kind kind, double now);

// A path message of this status was sent at `now`; the vehicle stands at `now`.
void aisle_sim_faults_note_path(aisle_sim_faults *self, double now, int8_t status, int16_t cause);
void aisle_sim_faults_note_rest(aisle_sim_faults *self, double now);
#endif
