#include "daemon/inbox.h"

#include "base/check.h"

#include <string.h>

// In front of each message in the ring. size = WRAP: the rest up to the end is unused.
typedef struct entry {
    uint32_t size;
    uint32_t channel;
} entry;
#define WRAP UINT32_MAX
#define SOURCE_OFFSET 20U // of obstacles_msg.source: fingerprint, utime, seq

static size_t padded(size_t size) {
    return (sizeof(entry) + size + 7U) & ~(size_t)7U;
}

static entry entry_at(const aisle_inbox *self, size_t at) {
    entry e;
    memcpy(&e, self->ring + at, sizeof e);
    return e;
}

void aisle_inbox_init(aisle_inbox *self, void *ring, size_t capacity) {
    AISLE_ASSERT(ring != NULL && (uintptr_t)ring % 8U == 0 && capacity >= 2U * AISLE_MSG_DATAGRAM_MAX);
    memset(self, 0, sizeof *self);
    self->ring = ring;
    self->capacity = capacity & ~(size_t)7U;
}

static bool is_firm(aisle_channel channel) {
    return channel == AISLE_CHANNEL_GOALS || channel == AISLE_CHANNEL_COMMAND;
}

// Appends to the ring; an entry never straddles its end.
static aisle_status push(aisle_inbox *self, aisle_channel channel, const void *bytes, size_t size) {
    size_t need = padded(size), tail = (self->head + self->used) % self->capacity;
    size_t to_end = self->capacity - tail, skip = need > to_end ? to_end : 0;
    if (self->used + skip + need > self->capacity) {
        self->dropped[channel]++;
        return AISLE_ERR_CAPACITY;
    }
    if (skip != 0) {
        entry wrap = {.size = WRAP, .channel = 0};
        memcpy(self->ring + tail, &wrap, sizeof wrap);
        tail = 0;
    }
    entry e = {.size = (uint32_t)size, .channel = (uint32_t)channel};
    memcpy(self->ring + tail, &e, sizeof e);
    memcpy(self->ring + tail + sizeof e, bytes, size);
    self->used += skip + need;
    self->used_max = self->used > self->used_max ? self->used : self->used_max;
    self->waiting++;
    self->waiting_firm += is_firm(channel) ? 1U : 0U;
    return AISLE_OK;
}

static aisle_channel channel_of_slot(int slot) {
    return slot == AISLE_INBOX_SLOT_VEHICLE ? AISLE_CHANNEL_VEHICLE
           : slot == AISLE_INBOX_SLOT_POSE  ? AISLE_CHANNEL_POSE
                                            : AISLE_CHANNEL_OBSTACLES;
}

static int slot_of(aisle_channel channel, const uint8_t *bytes, size_t size) {
    if (channel == AISLE_CHANNEL_VEHICLE) {
        return AISLE_INBOX_SLOT_VEHICLE;
    }
    if (channel == AISLE_CHANNEL_POSE) {
        return AISLE_INBOX_SLOT_POSE;
    }
    bool small = size >= SOURCE_OFFSET + 4U && bytes[SOURCE_OFFSET] == 0 && bytes[SOURCE_OFFSET + 1] == 0 &&
                 bytes[SOURCE_OFFSET + 2] == 0 && bytes[SOURCE_OFFSET + 3] < AISLE_OBSTACLES_MAX_SOURCES;
    return AISLE_INBOX_SLOT_OBSTACLES + (small ? bytes[SOURCE_OFFSET + 3] : AISLE_OBSTACLES_MAX_SOURCES);
}

// The oldest full slot from `first` on, or -1.
static int oldest_slot(const aisle_inbox *self, int first) {
    int best = -1;
    for (int i = first; i < AISLE_INBOX_SLOTS; i++) {
        if (self->slots[i].order != 0 && (best < 0 || self->slots[i].order < self->slots[best].order)) {
            best = i;
        }
    }
    return best;
}

// Moves the snapshots an ordered message may rest on in front of it. A lost one is like one lost on the bus.
static void pin_snapshots(aisle_inbox *self, aisle_channel channel) {
    if (channel != AISLE_CHANNEL_GOALS && channel != AISLE_CHANNEL_ARM_GOAL) {
        aisle_inbox_slot *vehicle = &self->slots[AISLE_INBOX_SLOT_VEHICLE];
        if (vehicle->order != 0) {
            (void)push(self, AISLE_CHANNEL_VEHICLE, vehicle->bytes, vehicle->size);
            vehicle->order = 0;
        }
        return;
    }
    for (int i = oldest_slot(self, 0); i >= 0; i = oldest_slot(self, 0)) {
        (void)push(self, channel_of_slot(i), self->slots[i].bytes, self->slots[i].size);
        self->slots[i].order = 0;
    }
}

// True: the command may overtake, for neither goals nor commands wait in the ring, and there is room.
static bool push_command(aisle_inbox *self, const void *bytes, size_t size) {
    if (self->waiting_firm > 0 || size > AISLE_INBOX_COMMAND_SIZE || self->command_count == AISLE_INBOX_COMMANDS) {
        return false;
    }
    aisle_inbox_command *command = &self->commands[(self->command_head + self->command_count) % AISLE_INBOX_COMMANDS];
    command->size = (uint32_t)size;
    memcpy(command->bytes, bytes, size);
    self->command_count++;
    return true;
}

aisle_status aisle_inbox_put(aisle_inbox *self, aisle_channel channel, int64_t at_us, const void *bytes, size_t size) {
    AISLE_ASSERT((int)channel < AISLE_CHANNEL_INPUTS);
    self->received++;
    if (size > AISLE_MSG_DATAGRAM_MAX) {
        self->oversize++;
        return AISLE_ERR_DATA;
    }
    if (channel == AISLE_CHANNEL_COMMAND && push_command(self, bytes, size)) {
        return AISLE_OK;
    }
    if (!aisle_channel_is_snapshot(channel)) {
        pin_snapshots(self, channel);
        return push(self, channel, bytes, size);
    }
    aisle_inbox_slot *slot = &self->slots[slot_of(channel, bytes, size)];
    self->replaced += slot->order != 0 ? 1 : 0;
    slot->order = ++self->order;
    slot->at_us = at_us;
    slot->size = (uint32_t)size;
    memcpy(slot->bytes, bytes, size);
    return AISLE_OK;
}

static bool peek_slot(const aisle_inbox *self, int slot, aisle_inbox_message *out) {
    if (slot < 0) {
        return false;
    }
    const aisle_inbox_slot *s = &self->slots[slot];
    *out = (aisle_inbox_message){
        .channel = channel_of_slot(slot), .bytes = s->bytes, .size = s->size, .at_us = s->at_us, .slot = slot};
    return true;
}

// Where the oldest entry of a ring that is not empty begins.
static size_t head_of(const aisle_inbox *self) {
    return entry_at(self, self->head).size == WRAP ? 0 : self->head;
}

bool aisle_inbox_peek(const aisle_inbox *self, aisle_inbox_message *out) {
    if (self->command_count > 0) {
        const aisle_inbox_command *command = &self->commands[self->command_head];
        *out = (aisle_inbox_message){.channel = AISLE_CHANNEL_COMMAND,
                                     .bytes = command->bytes,
                                     .size = command->size,
                                     .slot = AISLE_INBOX_IN_COMMANDS};
        return true;
    }
    if (self->waiting == 0) {
        return peek_slot(self, oldest_slot(self, 0), out);
    }
    size_t at = head_of(self);
    entry e = entry_at(self, at);
    *out = (aisle_inbox_message){.channel = (aisle_channel)e.channel,
                                 .bytes = self->ring + at + sizeof e,
                                 .size = e.size,
                                 .slot = AISLE_INBOX_IN_RING};
    return true;
}

bool aisle_inbox_peek_overtaking(const aisle_inbox *self, aisle_inbox_message *out) {
    return self->waiting_firm == 0 && peek_slot(self, oldest_slot(self, AISLE_INBOX_SLOT_POSE), out);
}

void aisle_inbox_pop(aisle_inbox *self, const aisle_inbox_message *message) {
    if (message->slot >= 0) {
        self->slots[message->slot].order = 0;
        return;
    }
    if (message->slot == AISLE_INBOX_IN_COMMANDS) {
        AISLE_ASSERT(self->command_count > 0);
        self->command_head = (self->command_head + 1U) % AISLE_INBOX_COMMANDS;
        self->command_count--;
        return;
    }
    AISLE_ASSERT(self->waiting > 0);
    size_t at = head_of(self), skipped = at == self->head ? 0 : self->capacity - self->head;
    size_t length = padded(message->size);
    self->waiting--;
    self->waiting_firm -= is_firm(message->channel) ? 1U : 0U;
    self->used -= skipped + length;
    self->head = self->waiting == 0 ? 0 : (at + length) % self->capacity;
    AISLE_ASSERT(self->waiting != 0 || self->used == 0);
}

bool aisle_inbox_invariants_hold(const aisle_inbox *self) {
    size_t at = self->head, sum = 0;
    uint32_t firm = 0;
    for (uint32_t i = 0; i < self->waiting; i++) {
        if (at % 8U != 0 || at >= self->capacity) {
            return false;
        }
        entry e = entry_at(self, at);
        if (e.size == WRAP) {
            sum += self->capacity - at;
            at = 0;
            e = entry_at(self, 0);
        }
        if (e.size > AISLE_MSG_DATAGRAM_MAX || e.channel >= (uint32_t)AISLE_CHANNEL_INPUTS) {
            return false;
        }
        sum += padded(e.size);
        firm += is_firm((aisle_channel)e.channel) ? 1U : 0U;
        at = (at + padded(e.size)) % self->capacity;
    }
    return sum == self->used && firm == self->waiting_firm && self->used <= self->capacity &&
           self->command_count <= AISLE_INBOX_COMMANDS && self->command_head < AISLE_INBOX_COMMANDS;
}
