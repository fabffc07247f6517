// bus.h - the LCM side of the daemon: subscribed inputs go to an inbox, outputs are published. Level 5.
//
// Works with liblcm 1.3.1 and 1.5.x and any of its providers (udpm://, tcpq://, memq:// within one process). Messages
// are taken raw; their size is looked at before anything else, for liblcm hands on what the network says.
//
// liblcm keeps a queue per subscription and silently drops the newest when it is full. We ask for AISLE_BUS_QUEUE
// messages and drain it often; when as many as that came in without a pause some may be lost, which is counted in
// `flooded` and told. UDP itself may lose messages unnoticed: senders send again until _STATUS says what the daemon
// holds.
//
// Memory: the struct; liblcm allocates on its own account (its receive buffers, 2 per message of more than one
// datagram) and runs one receive thread, with all signals masked.
#ifndef AISLE_DAEMON_BUS_H
#define AISLE_DAEMON_BUS_H

#include "aisle/status.h"
#include "daemon/inbox.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define AISLE_BUS_QUEUE 512      // messages per subscription in liblcm
#define AISLE_BUS_DRAIN_MAX 1024 // messages taken in one call

typedef struct aisle_bus aisle_bus;

// A message the bus itself could not keep.
typedef enum aisle_bus_fault_kind { AISLE_BUS_OVERSIZE, AISLE_BUS_FULL, AISLE_BUS_FLOODED } aisle_bus_fault_kind;

typedef struct aisle_bus_subscription {
    aisle_bus *bus;
    aisle_channel channel;
    int burst; // messages since the bus was last found empty
} aisle_bus_subscription;

struct aisle_bus {
    void *lcm; // lcm_t
    int fd;
    aisle_inbox *inbox;
    aisle_bus_subscription subscriptions[AISLE_CHANNEL_INPUTS];
    char names[AISLE_CHANNEL_COUNT][AISLE_CHANNEL_NAME_LEN];
    int64_t flooded;   // times liblcm's queue may have overflowed
    int64_t published; // messages sent
    int64_t failed;    // messages that could not be sent
    // The last fault; fault_count tells a new one from an old one.
    int64_t fault_count;
    aisle_bus_fault_kind fault;
    aisle_channel fault_channel;
};

// Joins the bus and subscribes to every input. url: as lcm_create() takes it, "" = LCM's default. AISLE_ERR_ARG: liblcm
// refuses (no such network, no multicast route); it has said why on stderr. May take up to 10 s where multicast does
// not come back.
aisle_status aisle_bus_open(aisle_bus *self, const char *url, const char *prefix, aisle_inbox *inbox);

// Readable when messages wait; for poll().
int aisle_bus_fd(const aisle_bus *self);

// Moves waiting messages to the inbox, at most AISLE_BUS_DRAIN_MAX. Returns how many; below 0: the bus is broken. Never
// waits.
int aisle_bus_drain(aisle_bus *self);

// Sends at once. AISLE_ERR_DATA: liblcm could not (counted).
aisle_status aisle_bus_publish(aisle_bus *self, aisle_channel channel, const void *bytes, size_t size);

void aisle_bus_close(aisle_bus *self);
#endif
