// inbox.h - received messages until the planner takes them, in fixed memory. Level 5; knows no LCM.
//
// Two kinds of channels. Ordered ones (layout, patch, grid, goals, query, command, arm goal) go into a ring of bytes and come out
// as they went in; when the ring is full the message is refused and counted. Snapshots (vehicle, pose, obstacles of a
// source) have one slot each, in which a newer one replaces an older one.
//
// Order: what comes out is what went in, but for replaced snapshots and what may overtake. A snapshot that an ordered
// message behind it rests on is no longer replaced: it moves into the ring, in front of that message. Goals, the arm's too, rest on
// all of them, the others on the vehicle alone. Commands concern goals alone, so they overtake everything else. So the
// answers are those of a planner that saw every message in the order of arrival, and a log of the bus can be replayed.
//
// Memory: the struct (about 450 kB of slots) and the caller's ring. Time: put and take O(size of the message).
// Threads: one.
#ifndef AISLE_DAEMON_INBOX_H
#define AISLE_DAEMON_INBOX_H

#include "daemon/channel.h"
#include "wire/codec.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum {
    AISLE_INBOX_IN_RING = -1,
    AISLE_INBOX_IN_COMMANDS = -2,
    AISLE_INBOX_SLOT_VEHICLE = 0,
    AISLE_INBOX_SLOT_POSE,
    AISLE_INBOX_SLOT_OBSTACLES, // one per source and one for sources there should not be: the decoder refuses them
    AISLE_INBOX_SLOTS = AISLE_INBOX_SLOT_OBSTACLES + AISLE_OBSTACLES_MAX_SOURCES + 1
};

#define AISLE_INBOX_COMMANDS 32     // that may overtake; more go into the ring
#define AISLE_INBOX_COMMAND_SIZE 64 // bytes, more than a command_t has

typedef struct aisle_inbox_command {
    uint32_t size;
    uint8_t bytes[AISLE_INBOX_COMMAND_SIZE];
} aisle_inbox_command;

typedef struct aisle_inbox_slot {
    uint64_t order; // of arrival; 0 = empty
    int64_t at_us;  // likewise
    uint32_t size;
    uint8_t bytes[AISLE_MSG_DATAGRAM_MAX];
} aisle_inbox_slot;

// Read the counters, write nothing. They never decrease.
typedef struct aisle_inbox {
    uint8_t *ring;
    size_t capacity, head, used; // bytes; used counts padding
    uint32_t waiting;            // messages in the ring
    uint32_t waiting_firm;       // of them: goals, and commands behind goals; nothing overtakes these
    uint32_t command_head, command_count;
    aisle_inbox_command commands[AISLE_INBOX_COMMANDS];
    uint64_t order; // of the last arrival
    aisle_inbox_slot slots[AISLE_INBOX_SLOTS];
    int64_t received;                      // put() calls
    int64_t replaced;                      // snapshots replaced by a newer one
    int64_t oversize;                      // refused: longer than any message may be
    int64_t dropped[AISLE_CHANNEL_INPUTS]; // refused: the ring was full, or a pinned snapshot found no place in it
    size_t used_max;                       // high-water mark of used
} aisle_inbox;

typedef struct aisle_inbox_message {
    aisle_channel channel;
    const uint8_t *bytes; // until the next put() or pop()
    size_t size;
    int64_t at_us; // of its arrival, of a snapshot in its slot; else 0
    int slot;      // where it lies: AISLE_INBOX_SLOT_..., AISLE_INBOX_IN_RING or AISLE_INBOX_IN_COMMANDS
} aisle_inbox_message;

// ring: aligned to 8, at least 2 * AISLE_MSG_DATAGRAM_MAX bytes; the caller's as long as the inbox.
void aisle_inbox_init(aisle_inbox *self, void *ring, size_t capacity);

// Takes a copy. channel: an input. at_us: when it arrived, by any clock; kept for the caller. AISLE_ERR_DATA: longer than
// AISLE_MSG_DATAGRAM_MAX (bytes are not looked at). AISLE_ERR_CAPACITY: no room, counted in dropped.
aisle_status aisle_inbox_put(aisle_inbox *self, aisle_channel channel, int64_t at_us, const void *bytes, size_t size);

// The next message in order, which stays until pop(). False: empty.
bool aisle_inbox_peek(const aisle_inbox *self, aisle_inbox_message *out);

// When the next message must wait: the oldest pose or obstacles that may overtake it, because no goals wait in front of
// them. A layout or vehicle that takes effect later then plans a mission anew from the newer pose. False: none.
bool aisle_inbox_peek_overtaking(const aisle_inbox *self, aisle_inbox_message *out);

// Removes a message just peeked at.
void aisle_inbox_pop(aisle_inbox *self, const aisle_inbox_message *message);

// O(messages): true unless memory was overwritten. For asserts and tests.
bool aisle_inbox_invariants_hold(const aisle_inbox *self);
#endif
