// engine.h - the one block of memory, taken at start, and the planner in it. Level 5.
//
// Everything we allocate in the life of aisled is here, once, before the loop: the planner's block and the daemon's
// queue.
#ifndef AISLE_DAEMON_ENGINE_H
#define AISLE_DAEMON_ENGINE_H

#include "daemon/settings.h"

#include <stdio.h>

typedef struct aisle_engine {
    void *block;
    size_t planner_bytes; // of the block, from its start
    size_t extra_bytes;   // behind it
    void *extra;          // aligned to 64
    aisle_planner *planner;
} aisle_engine;

// Allocates and inits. extra: bytes for the caller. AISLE_ERR_ARG: the planner refuses the limits or the vehicle;
// AISLE_ERR_CAPACITY: no memory. message[AISLE_SETTINGS_MESSAGE_LEN] says so in one line.
aisle_status aisle_engine_start(aisle_engine *self, const aisle_settings *settings, int64_t boot_id, size_t extra,
                                char *message);

void aisle_engine_stop(aisle_engine *self);

// Something that differs from start to start, > 0.
int64_t aisle_engine_boot_id(void);

// The table of aisled --memory: bytes per pool and their sum, the daemon's own, heap and stack of the core.
// False: the file would not take it.
bool aisle_engine_print_memory(const aisle_engine *self, size_t daemon_bytes, FILE *file);
#endif
