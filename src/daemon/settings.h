// settings.h - what aisled may be told: an .ini file over built-in defaults. Level 5.
//
// Sections and keys, their ranges and defaults are listed with comments in packaging/aisled.ini. Each key may stand
// once; sections may be repeated. A line that starts with a blank goes on with the value above it (useful for
// `footprint`). A 0 for a vehicle value means its default, as in vehicle_t.
//
// Memory: the caller's struct; reading uses stack only. Trust: the file is the operator's, but every value is checked.
#ifndef AISLE_DAEMON_SETTINGS_H
#define AISLE_DAEMON_SETTINGS_H

#include "aisle/planner.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define AISLE_SETTINGS_URL_MAX 255
#define AISLE_SETTINGS_PREFIX_MAX 32 // with the longest suffix below LCM's 63 characters of a channel name
#define AISLE_SETTINGS_MESSAGE_LEN 512

typedef struct aisle_settings {
    char url[AISLE_SETTINGS_URL_MAX + 1]; // "" = LCM's own default (LCM_DEFAULT_URL, else 239.255.76.67:7667, ttl 0)
    char prefix[AISLE_SETTINGS_PREFIX_MAX + 1]; // of every channel
    uint32_t queue_bytes;                       // of messages that must not be lost and wait for the planner
    int32_t work_units;                         // budget of a request that names none
    uint32_t work_units_per_slice;              // 0 = as many as take about 1 ms, measured as it goes
    bool remember;                              // answers: else every request is planned anew
    bool skip_unreachable;                      // goals of a list that are proved to be out of reach, if others are not
    float shortest_lease;                       // s, of a path among moving obstacles; 0 = AISLE_LEASE_SHORTEST
    aisle_limits limits;                        // 0 = default, as in limits.h
    aisle_vehicle_msg vehicle;                  // the vehicle until a message brings one
    float status_hz, diag_hz;
    bool mlock; // keep the process in RAM
} aisle_settings;

// The documented defaults, which need no file.
void aisle_settings_defaults(aisle_settings *self);

// Reads the file over what *self holds. AISLE_ERR_DATA: the first thing wrong is told in
// message[AISLE_SETTINGS_MESSAGE_LEN] as one line "FILE:LINE: what is wrong, what is allowed", without a line number
// when the file cannot be read at all; *self is unchanged then.
aisle_status aisle_settings_read(aisle_settings *self, const char *path, char *message);

// Sets the value of one key as the file would ("bus", "prefix", "AISLE"): for the command line. AISLE_ERR_DATA: as
// above, the message has no place in front.
aisle_status aisle_settings_set(aisle_settings *self, const char *section, const char *name, const char *value,
                                char *message);
#endif
