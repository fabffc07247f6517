// tracks.h - recorded ways of people and vehicles, mapped into a hall. Level 5.
//
// Read from CSV with the columns t_s,id,kind,x_m,y_m,heading_rad (kind ped or veh; heading may be empty), sorted by time.
// Between two samples of an id it moves evenly; before its first and after its last one it is not there. Where a
// recording has an outlier faster than AISLE_SIM_TRACK_SPEED_MAX the id ends and comes back as another one.
// Mapped by a similarity: turned, scaled, moved. The time is scaled as the length, so speeds stay what they were.
// Memory: heap, freed by aisle_sim_tracks_free(). Time: at() O(log samples).
#ifndef AISLE_SIM_TRACKS_H
#define AISLE_SIM_TRACKS_H

#include "base/vec.h"

#include <stdbool.h>
#include <stdint.h>

#define AISLE_SIM_TRACK_SPEED_MAX 3.0 // m/s of recorded walks; faster is an error of the recording
#define AISLE_SIM_TRACKS_MESSAGE_LEN 256

typedef struct aisle_sim_sample {
    double t; // s
    aisle_vec2 at;
} aisle_sim_sample;

typedef struct aisle_sim_track {
    uint32_t first, count; // samples
    bool is_vehicle;
    double v_max; // m/s, between samples
} aisle_sim_track;

typedef struct aisle_sim_tracks {
    aisle_sim_sample *sample;
    aisle_sim_track *track;
    uint32_t num_samples, num_tracks;
    aisle_vec2 lo, hi; // of all samples
    double duration;   // s
} aisle_sim_tracks;

// False: message[AISLE_SIM_TRACKS_MESSAGE_LEN] says "FILE:LINE: what is wrong"; nothing is held then.
bool aisle_sim_tracks_read(aisle_sim_tracks *self, const char *path, char *message);

// x -> scale * R(turn) * (x - centre of the samples) + to; t -> scale * t.
void aisle_sim_tracks_map(aisle_sim_tracks *self, aisle_vec2 to, double turn, double scale);

// Where track i is at t; false: not there.
bool aisle_sim_tracks_at(const aisle_sim_tracks *self, uint32_t i, double t, aisle_vec2 *at, aisle_vec2 *velocity);

void aisle_sim_tracks_free(aisle_sim_tracks *self);
#endif
